//! Settled beds kept in files, so that opening a scene again takes no time.
//!
//! In: a built world. Out: the world that it settles to, where that is kept. A bed is what settling
//! adds to a built world: positions, forces and contact histories at rest. It is looked up by a key
//! over everything that determines it, first among the beds shipped with the program, then in a
//! folder of the user's. A bed that is stale, damaged or does not fit is no bed: settling makes it
//! anew. Keeping one may fail, a run never does.

use super::settling::{standing, start};
use crate::files::{read_whole, write_whole};
use crate::world::{Contact, Partner, World};
use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::PathBuf;

/// Raised whenever the file's layout, the settling or the solver's arithmetic changes: older beds
/// are then stale.
const FORMAT: u32 = 7;
const MAGIC: &[u8; 12] = b"grainfallbed";
/// Largest file that is read [bytes]: the bed of as many grains as a scene may have.
const LARGEST_FILE: u64 = 1 << 30;
/// Bytes before the contents: magic, format, key, checksum.
const HEADER: usize = MAGIC.len() + 4 + 2 * blake3::OUT_LEN;

/// Beds that come with the program, those of the paper's scenes; `grainfall bed SCENE --out FILE`
/// makes them.
static SHIPPED: [&[u8]; 3] = [
    include_bytes!("../../assets/beds/dry-r3.bed"),
    include_bytes!("../../assets/beds/dry-r2.bed"),
    include_bytes!("../../assets/beds/dry-r1.25.bed"),
];

/// Identity of a bed: a hash of everything that determines it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BedKey(blake3::Hash);

/// Where beds are looked for and kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BedStore {
    shipped: bool,
    folder: Option<PathBuf>,
}

/// What settling adds to a built world. Beds have forces and springs in single precision
/// ([`start`]).
#[derive(Serialize, Deserialize)]
struct Bed {
    position: Vec<DVec3>,
    force: Vec<Vec3>,
    torque: Vec<Vec3>,
    rolling_torque: Vec<Vec3>,
    contact_count: Vec<u32>,
    contacts: Vec<BedContact>,
}

#[derive(Serialize, Deserialize)]
struct BedContact {
    grain: u32,
    partner: Partner,
    spring: Vec3,
    stiffness: f32,
    rolling: Vec3,
    force: Vec3,
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
    /// The key of the bed that `built`, a scene's world before settling, settles to with steps of
    /// `time_step` [s]. How its walls will move does not matter, nor does its liquid.
    ///
    /// # Errors
    /// When the world cannot be written as bytes, of which the key is a hash.
    pub fn of(built: &World, time_step: f64) -> Result<Self, postcard::Error> {
        let all = postcard::to_stdvec(&(FORMAT, standing(built, time_step)))?;
        Ok(Self(blake3::hash(&all)))
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

    /// The shipped beds alone; none is kept.
    pub fn shipped() -> Self {
        Self {
            shipped: true,
            folder: None,
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

    /// The settled world that belongs to `key`, where one is kept that can be read. `built` is the
    /// scene's world before settling.
    pub fn find(&self, key: BedKey, built: &World) -> Option<World> {
        let shipped = SHIPPED.iter().filter(|_| self.shipped);
        let kept = self
            .path(key)
            .and_then(|path| read_whole(&path, LARGEST_FILE).ok());
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
        let encoded = encode(key, settled).map_err(io::Error::other);
        let kept = encoded.and_then(|bytes| write_whole(&path, |file| file.write_all(&bytes)));
        kept.map_err(|error| format!("cannot keep the settled bed in {}: {error}", path.display()))
    }

    fn path(&self, key: BedKey) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(key.file_name()))
    }
}

/// The bytes of a file that holds the bed of `settled`: magic, format, key, checksum, contents.
///
/// # Errors
/// When the bed cannot be written as bytes.
pub fn encode(key: BedKey, settled: &World) -> Result<Vec<u8>, postcard::Error> {
    let contents = postcard::to_stdvec(&Bed::of(settled))?;
    let mut bytes = Vec::with_capacity(HEADER + contents.len());
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&FORMAT.to_le_bytes());
    bytes.extend_from_slice(key.0.as_bytes());
    bytes.extend_from_slice(blake3::hash(&contents).as_bytes());
    bytes.extend_from_slice(&contents);
    Ok(bytes)
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
    let world = bed.laid_into(built);
    world.check().map_err(|_| Unfit::Contents)?;
    Ok(world)
}

impl Bed {
    fn of(settled: &World) -> Self {
        let grains = &settled.grains;
        Self {
            position: grains.position.to_vec(),
            force: single(&grains.force),
            torque: single(&grains.torque),
            rolling_torque: single(&grains.rolling_torque),
            contact_count: grains.contact_count.to_vec(),
            contacts: settled.contacts.iter().map(BedContact::of).collect(),
        }
    }

    /// One finite entry per grain in each column, and contacts only between grains and walls that
    /// exist.
    fn fits(&self, built: &World) -> bool {
        let count = built.grains.len();
        let walls = built.container.walls.len();
        let whole =
            |column: &Vec<Vec3>| column.len() == count && column.iter().all(|v| v.is_finite());
        self.position.len() == count
            && self.position.iter().all(|x| x.is_finite())
            && [&self.force, &self.torque, &self.rolling_torque]
                .into_iter()
                .all(whole)
            && self.contact_count.len() == count
            && self
                .contacts
                .iter()
                .all(|contact| contact.is_between(count, walls))
    }

    fn laid_into(self, built: &World) -> World {
        let mut world = built.clone();
        world.grains.position.set(self.position);
        world.grains.force.set(double(&self.force));
        world.grains.torque.set(double(&self.torque));
        let rolling_torque = double(&self.rolling_torque);
        world.grains.rolling_torque.set(rolling_torque);
        world.grains.contact_count.set(self.contact_count);
        world.contacts = self.contacts.iter().map(BedContact::laid).collect();
        start(world, built)
    }
}

impl BedContact {
    fn of(contact: &Contact) -> Self {
        Self {
            grain: contact.grain,
            partner: contact.partner,
            spring: contact.spring.as_vec3(),
            stiffness: contact.stiffness as f32,
            rolling: contact.rolling.as_vec3(),
            force: contact.force.as_vec3(),
        }
    }

    fn laid(&self) -> Contact {
        Contact {
            grain: self.grain,
            partner: self.partner,
            spring: self.spring.as_dvec3(),
            stiffness: self.stiffness.into(),
            rolling: self.rolling.as_dvec3(),
            force: self.force.as_dvec3(),
            touching: true,
            bridge: None,
        }
    }

    /// Whether it is a finite contact of one of `grains` grains with another or with one of `walls`
    /// walls.
    fn is_between(&self, grains: usize, walls: usize) -> bool {
        let partner = match self.partner {
            Partner::Grain(other) => (other as usize) < grains,
            Partner::Wall(wall) => (wall as usize) < walls,
        };
        partner
            && (self.grain as usize) < grains
            && self.spring.is_finite()
            && self.stiffness.is_finite()
            && self.rolling.is_finite()
            && self.force.is_finite()
    }
}

fn single(column: &[DVec3]) -> Vec<Vec3> {
    column.iter().map(|v| v.as_vec3()).collect()
}

fn double(column: &[Vec3]) -> Vec<DVec3> {
    column.iter().map(|v| v.as_dvec3()).collect()
}
