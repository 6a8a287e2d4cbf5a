//! Voronoi cells kept in a file, so that several scenes can have the very same grains without
//! cutting them anew.
//!
//! In: the grains that [`crate::world::Packing`] made, or the bytes of a file. Out: the file's
//! bytes, or the grains. A file that is damaged, of another version or holds absurd grains is
//! refused. A scene that was kept names file and checksum; where the file is gone, the same grains
//! are taken from [`HeldCells`].
//!
//! Which files are opened is not for a file to say: a scene's packing lies in the scene's folder
//! or below it, and a record's in the folders that its reader names ([`within_folders`]), unless
//! the person at the machine said otherwise ([`take_packings_from_anywhere`]).

use crate::files::read_whole;
use crate::geometry::Rounded;
use crate::physics::limits::MOST_POLYHEDRA;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

/// Raised whenever the file's layout changes.
const FORMAT: u32 = 1;
const MAGIC: &[u8; 12] = b"grainfallpac";
/// Bytes before the contents: magic, format, checksum.
const HEADER: usize = MAGIC.len() + 4 + blake3::OUT_LEN;

/// Largest file that is read [bytes]: room for as many polyhedra as a scene may have.
const LARGEST_FILE: u64 = 512 << 20;

/// Whether packings are taken from anywhere.
static ANYWHERE: AtomicBool = AtomicBool::new(false);

thread_local! {
    /// The folders that packings may lie in while a record is read; none where it does not matter.
    static FOLDERS: RefCell<Option<Vec<PathBuf>>> = const { RefCell::new(None) };
}

/// From now on packings are taken from wherever a scene or a record says they are: for a person
/// who asked for it on the command line.
pub fn take_packings_from_anywhere() {
    ANYWHERE.store(true, Ordering::Relaxed);
}

/// Does `read`, which reads a scene that somebody else may have written: the packing that it names
/// is then opened only where it lies in one of these `folders` or below; where there are none, it
/// has to be at hand.
pub fn within_folders<T>(folders: &[&Path], read: impl FnOnce() -> T) -> T {
    let folders = folders.iter().map(|folder| (*folder).to_owned()).collect();
    let before = FOLDERS.replace(Some(folders));
    let done = read();
    FOLDERS.set(before);
    done
}

/// Whether the file at `path` lies in `folder` or below it, wherever links lead.
pub(crate) fn lies_in(folder: &Path, path: &Path) -> bool {
    let here = Path::new(".");
    let folder = Some(folder).filter(|folder| *folder != Path::new(""));
    let folder = folder.unwrap_or(here).canonicalize();
    // What is not there lies nowhere; reading it says so.
    matches!((folder, path.canonicalize()), (Ok(folder), Ok(path)) if path.starts_with(&folder))
}

/// Where the file is that a scene in `folder` calls `name`; refused where it lies elsewhere.
fn path_beside(folder: &Path, name: &Path) -> Result<PathBuf, PackingError> {
    let path = folder.join(name);
    let is_allowed = ANYWHERE.load(Ordering::Relaxed) || lies_in(folder, &path);
    if path.exists() && !is_allowed {
        return Err(PackingError::Elsewhere);
    }
    Ok(path)
}

/// The bytes, `most` of them at most, of the file that a scene in `folder` calls `name`.
///
/// # Errors
/// When it lies elsewhere than in that folder or below it, or cannot be read.
pub(super) fn open_beside(folder: &Path, name: &Path, most: u64) -> Result<Vec<u8>, PackingError> {
    Ok(read_whole(&path_beside(folder, name)?, most)?)
}

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
    Unreadable(#[from] io::Error),
    /// It is something else.
    #[error("is no packing of this version")]
    Other,
    /// Its contents are not what was written.
    #[error("is damaged")]
    Damaged,
    /// It lies elsewhere than the files that a scene may name.
    #[error(
        "is not opened: it does not lie in the folder of the file that names it. Move it there, or allow it \
             with --packings-anywhere"
    )]
    Elsewhere,
    /// Its contents are not those that a scene was read with.
    #[error("holds other grains than before")]
    Changed,
}

impl StoredCells {
    /// The grains in the file that a scene in `folder` calls `name`.
    ///
    /// # Errors
    /// As [`StoredCells::read`], and when it lies elsewhere than in that folder or below it.
    pub fn beside(folder: &Path, name: &Path) -> Result<Self, PackingError> {
        Self::read(&path_beside(folder, name)?)
    }

    /// The grains in the file at `path`.
    ///
    /// # Errors
    /// When it cannot be read or is no whole packing.
    pub fn read(path: &Path) -> Result<Self, PackingError> {
        let bytes = read_whole(path, LARGEST_FILE)?;
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
    ///
    /// # Errors
    /// When they cannot be written in this format.
    pub fn encode(grains: &[Rounded]) -> io::Result<Vec<u8>> {
        let contents = postcard::to_stdvec(grains).map_err(io::Error::other)?;
        let mut bytes = Vec::with_capacity(HEADER + contents.len());
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&FORMAT.to_le_bytes());
        bytes.extend_from_slice(blake3::hash(&contents).as_bytes());
        bytes.extend_from_slice(&contents);
        Ok(bytes)
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
    (1..=MOST_POLYHEDRA).contains(&grains.len()) && grains.iter().all(Rounded::is_sound)
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

/// Whether the file at `path` may be opened for what is being read.
fn is_within_reach(path: &Path) -> bool {
    ANYWHERE.load(Ordering::Relaxed)
        || FOLDERS.with_borrow(|folders| {
            (folders.as_ref()).is_none_or(|folders| {
                // What is not there is told as such, where some folder could have held it.
                let is_missing = !folders.is_empty() && !path.exists();
                is_missing || folders.iter().any(|folder| lies_in(folder, path))
            })
        })
}

impl TryFrom<Reference> for StoredCells {
    type Error = Lost;

    fn try_from(reference: Reference) -> Result<Self, Lost> {
        let lost = |reason| Lost {
            // Where it was looked for, in full.
            file: std::path::absolute(&reference.file).unwrap_or(reference.file.clone()),
            reason,
        };
        let at_hand = held().get(&reference.checksum).and_then(Weak::upgrade);
        if let Some(grains) = at_hand {
            return Ok(Self { reference, grains });
        }
        if !is_within_reach(&reference.file) {
            return Err(lost(PackingError::Elsewhere));
        }
        match Self::read(&reference.file) {
            Ok(stored) if stored.reference.checksum == reference.checksum => Ok(stored),
            Ok(_) => Err(lost(PackingError::Changed)),
            Err(error) => Err(lost(error)),
        }
    }
}

impl From<StoredCells> for Reference {
    fn from(stored: StoredCells) -> Self {
        stored.reference
    }
}
