//! Settled beds kept in files, so that opening a scene again takes no time.
//!
//! A bed is what settling adds to a built world: positions, forces and contact histories at rest. It is looked up by a key
//! over everything that determines it, first among the beds shipped with the program, then in a folder of the user's. A
//! bed that is stale, damaged or does not fit is no bed: settling makes it anew. Keeping one may fail, a run never does.

use super::settling::{motions, standing, start};
use crate::files::write_whole;
use crate::world::{Contact, Partner, World};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::PathBuf;

/// Raised whenever the file's layout, the settling or the solver's arithmetic changes: older beds are then stale.
const FORMAT: u32 = 1;
const MAGIC: &[u8; 12] = b"grainfallbed";
/// Bytes before the contents: magic, format, key, checksum.
const HEADER: usize = MAGIC.len() + 4 + 2 * blake3::OUT_LEN;

/// Beds that come with the program.
static SHIPPED: &[&[u8]] = &[];

/// Identity of a bed: a hash of everything that determines it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BedKey(blake3::Hash);

/// Where beds are looked for and kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BedStore {
    shipped: bool,
    folder: Option<PathBuf>,
}

/// What settling adds to a built world.
#[derive(Serialize, Deserialize)]
struct Bed {
    position: Vec<DVec3>,
    force: Vec<DVec3>,
    torque: Vec<DVec3>,
    rolling_torque: Vec<DVec3>,
    contact_count: Vec<u32>,
    contacts: Vec<Contact>,
}

/// Why a file is not the bed that was looked for.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
enum Unfit {
    #[error("it is no bed of this version")]
    Header,
    #[error("it belongs to another scene")]
    Key,
    #[error("it is damaged")]
    Checksum,
    #[error("its contents do not fit the scene")]
    Contents,
}

impl BedKey {
    /// The key of the bed that `built`, a scene's world before settling, settles to. How its walls will move does not
    /// matter.
    pub fn of(built: &World) -> Self {
        Self(blake3::hash(&bytes_of(&(FORMAT, standing(built.clone())))))
    }

    fn file_name(self) -> String {
        format!("{}.bed", &self.0.to_hex()[..32])
    }
}

impl BedStore {
    /// The shipped beds and the user's cache folder.
    pub fn user() -> Self {
        let folder = directories::ProjectDirs::from("", "", "grainfall")
            .map(|folders| folders.cache_dir().join("beds"));
        Self {
            shipped: true,
            folder,
        }
    }

    /// The beds in `folder` alone.
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self {
            shipped: false,
            folder: Some(folder.into()),
        }
    }

    /// No beds: each is settled anew and none is kept.
    pub fn none() -> Self {
        Self {
            shipped: false,
            folder: None,
        }
    }

    /// The settled world that belongs to `key`, where one is kept. `built` is the scene's world before settling.
    pub fn find(&self, key: BedKey, built: &World) -> Option<World> {
        let shipped = SHIPPED.iter().filter(|_| self.shipped);
        let kept = self.path(key).and_then(|path| fs::read(path).ok());
        shipped
            .copied()
            .chain(kept.as_deref())
            .find_map(|bytes| decode(bytes, key, built).ok())
    }

    /// Keeps `settled` under `key`.
    ///
    /// # Errors
    /// What went wrong and where, for people; nothing is kept then.
    pub fn keep(&self, key: BedKey, settled: &World) -> Result<(), String> {
        let Some(path) = self.path(key) else {
            return Ok(());
        };
        write_whole(&path, |file| file.write_all(&encode(key, settled)))
            .map_err(|error| format!("cannot keep the settled bed in {}: {error}", path.display()))
    }

    fn path(&self, key: BedKey) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(key.file_name()))
    }
}

/// The bytes of a file that holds the bed of `settled`: magic, format, key, checksum, contents.
pub fn encode(key: BedKey, settled: &World) -> Vec<u8> {
    let contents = bytes_of(&Bed::of(settled));
    let mut bytes = Vec::with_capacity(HEADER + contents.len());
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&FORMAT.to_le_bytes());
    bytes.extend_from_slice(key.0.as_bytes());
    bytes.extend_from_slice(blake3::hash(&contents).as_bytes());
    bytes.extend_from_slice(&contents);
    bytes
}

/// `value` as bytes; empty, which no bed ever is, where it cannot be written.
fn bytes_of(value: &impl Serialize) -> Vec<u8> {
    postcard::to_stdvec(value).unwrap_or_default()
}

/// The settled world that `bytes` hold, if they are the bed that `key` names and fit `built`.
fn decode(bytes: &[u8], key: BedKey, built: &World) -> Result<World, Unfit> {
    let (header, contents) = bytes.split_at_checked(HEADER).ok_or(Unfit::Header)?;
    let (identity, sums) = header.split_at(MAGIC.len() + 4);
    let (found, checksum) = sums.split_at(blake3::OUT_LEN);
    if identity[..MAGIC.len()] != MAGIC[..] || identity[MAGIC.len()..] != FORMAT.to_le_bytes() {
        return Err(Unfit::Header);
    }
    if found != key.0.as_bytes() {
        return Err(Unfit::Key);
    }
    if checksum != blake3::hash(contents).as_bytes() {
        return Err(Unfit::Checksum);
    }
    let bed: Bed = postcard::from_bytes(contents).map_err(|_| Unfit::Contents)?;
    if !bed.fits(built) {
        return Err(Unfit::Contents);
    }
    Ok(bed.laid_into(built))
}

impl Bed {
    fn of(settled: &World) -> Self {
        let grains = &settled.grains;
        Self {
            position: grains.position.clone(),
            force: grains.force.clone(),
            torque: grains.torque.clone(),
            rolling_torque: grains.rolling_torque.clone(),
            contact_count: grains.contact_count.clone(),
            contacts: settled.contacts.clone(),
        }
    }

    /// One finite entry per grain in each column, and contacts only between grains and walls that exist.
    fn fits(&self, built: &World) -> bool {
        let count = built.grains.len();
        let columns = [
            &self.position,
            &self.force,
            &self.torque,
            &self.rolling_torque,
        ];
        let whole =
            |column: &Vec<DVec3>| column.len() == count && column.iter().all(|v| v.is_finite());
        let exists = |contact: &Contact| {
            let partner = match contact.partner {
                Partner::Grain(j) => (j as usize) < count,
                Partner::Wall(w) => (w as usize) < built.container.walls.len(),
            };
            partner && (contact.grain as usize) < count && contact.spring.is_finite()
        };
        columns.into_iter().all(whole)
            && self.contact_count.len() == count
            && self.contacts.iter().all(exists)
    }

    fn laid_into(self, built: &World) -> World {
        let mut world = built.clone();
        world.grains.position = self.position;
        world.grains.force = self.force;
        world.grains.torque = self.torque;
        world.grains.rolling_torque = self.rolling_torque;
        world.grains.contact_count = self.contact_count;
        world.contacts = self.contacts;
        start(world, &motions(built))
    }
}
