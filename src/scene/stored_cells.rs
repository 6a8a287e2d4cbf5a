//! Voronoi cells kept in a file, so that several scenes can have the very same grains without
//! cutting them anew.
//!
//! In: the grains that [`crate::world::Packing`] made, or the bytes of a file. Out: the file's
//! bytes, or the grains. A file that is damaged, of another version or holds absurd grains is
//! refused. A scene that was kept names file and checksum; where the file is gone, the same grains
//! are taken from [`HeldCells`].

use crate::geometry::Rounded;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

/// Raised whenever the file's layout changes.
const FORMAT: u32 = 1;
const MAGIC: &[u8; 12] = b"grainfallpac";
/// Bytes before the contents: magic, format, checksum.
const HEADER: usize = MAGIC.len() + 4 + blake3::OUT_LEN;

/// Grains that a file holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Reference", into = "Reference")]
pub struct StoredCells {
    reference: Reference,
    grains: Arc<[Rounded]>,
}

/// Which file, and what was in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Reference {
    file: PathBuf,
    checksum: String,
}

/// Why a file does not hold grains.
#[derive(Debug, thiserror::Error)]
pub enum PackingError {
    /// It cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// It is something else.
    #[error("is no packing of this version")]
    Other,
    /// Its contents are not what was written.
    #[error("is damaged")]
    Damaged,
    /// Its contents are not those that a scene was read with.
    #[error("holds other grains than before")]
    Changed,
}

impl StoredCells {
    /// The grains in the file at `path`.
    ///
    /// # Errors
    /// When it cannot be read or is no whole packing.
    pub fn read(path: &Path) -> Result<Self, PackingError> {
        let bytes = std::fs::read(path)?;
        let (header, contents) = bytes.split_at_checked(HEADER).ok_or(PackingError::Other)?;
        let (identity, checksum) = header.split_at(MAGIC.len() + 4);
        if identity != [&MAGIC[..], &FORMAT.to_le_bytes()[..]].concat() {
            return Err(PackingError::Other);
        }
        if checksum != blake3::hash(contents).as_bytes() {
            return Err(PackingError::Damaged);
        }
        let grains: Vec<Rounded> =
            postcard::from_bytes(contents).map_err(|_| PackingError::Damaged)?;
        if !are_sound(&grains) {
            return Err(PackingError::Damaged);
        }
        Ok(Self {
            reference: Reference {
                file: path.to_owned(),
                checksum: named(contents),
            },
            grains: grains.into(),
        })
    }

    /// The bytes of a file that holds `grains`: magic, format, checksum, contents.
    pub fn encode(grains: &[Rounded]) -> Vec<u8> {
        // Writing into memory cannot fail; if it did, reading would find the file empty.
        let contents = postcard::to_stdvec(grains).unwrap_or_default();
        let mut bytes = Vec::with_capacity(HEADER + contents.len());
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&FORMAT.to_le_bytes());
        bytes.extend_from_slice(blake3::hash(&contents).as_bytes());
        bytes.extend_from_slice(&contents);
        bytes
    }

    /// The grains.
    pub fn grains(&self) -> &[Rounded] {
        &self.grains
    }

    /// Volume of all grains [m³].
    pub fn solid_volume(&self) -> f64 {
        self.grains.iter().map(|grain| grain.shape.volume).sum()
    }
}

/// Whether a scene can be made of `grains`.
fn are_sound(grains: &[Rounded]) -> bool {
    !grains.is_empty() && grains.iter().all(Rounded::is_sound)
}

/// The checksum of a file's `contents`, as scenes name it.
fn named(contents: &[u8]) -> String {
    blake3::hash(contents).to_hex()[..32].to_owned()
}

/// Grains at hand by their checksum, for as long as they are held.
static HELD: Mutex<BTreeMap<String, Weak<[Rounded]>>> = Mutex::new(BTreeMap::new());

fn held() -> MutexGuard<'static, BTreeMap<String, Weak<[Rounded]>>> {
    HELD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Grains that came with a scene: while this lives, the scene can be made though the file that it
/// names is gone.
pub struct HeldCells {
    checksum: String,
    grains: Arc<[Rounded]>,
}

impl HeldCells {
    /// Holds `grains`; none where no scene can be made of them.
    pub fn hold(grains: Vec<Rounded>) -> Option<Self> {
        if !are_sound(&grains) {
            return None;
        }
        let checksum = named(&postcard::to_stdvec(&grains).ok()?);
        let grains: Arc<[Rounded]> = grains.into();
        held().insert(checksum.clone(), Arc::downgrade(&grains));
        Some(Self { checksum, grains })
    }
}

impl Drop for HeldCells {
    fn drop(&mut self) {
        // The same grains may have come with another scene since.
        let own = Arc::downgrade(&self.grains);
        let mut held = held();
        if (held.get(&self.checksum)).is_some_and(|grains| grains.ptr_eq(&own)) {
            held.remove(&self.checksum);
        }
    }
}

/// Why the grains of a scene that was kept are not there any more.
#[derive(Debug, thiserror::Error)]
#[error("its grains are in {}, which {reason}", .file.display())]
struct Lost {
    file: PathBuf,
    reason: PackingError,
}

impl TryFrom<Reference> for StoredCells {
    type Error = Lost;

    fn try_from(reference: Reference) -> Result<Self, Lost> {
        let lost = |reason| Lost {
            // Where it was looked for, in full.
            file: std::path::absolute(&reference.file).unwrap_or(reference.file.clone()),
            reason,
        };
        let reason = match Self::read(&reference.file) {
            Ok(stored) if stored.reference.checksum == reference.checksum => return Ok(stored),
            Ok(_) => PackingError::Changed,
            Err(error) => error,
        };
        let at_hand = held().get(&reference.checksum).and_then(Weak::upgrade);
        match at_hand {
            Some(grains) => Ok(Self { reference, grains }),
            None => Err(lost(reason)),
        }
    }
}

impl From<StoredCells> for Reference {
    fn from(stored: StoredCells) -> Self {
        stored.reference
    }
}
