//! What is written of the state at each output: a file of the grains and one of their contacts, each
//! with its list; and once, at the first, what holds for the whole run: shapes and container.
//!
//! In: a world at each output time. Out: the files. When that is, `recorder` says.

use super::collection_file::{CollectedFile, CollectionFile, write_collection};
use super::contacts_file::write_contacts;
use super::container_file::write_container;
use super::folder::FRAMES;
use super::grains_file::write_grains;
use super::shapes_file::{SHAPES, write_shapes};
use super::{OutputError, OutputFolder};
use crate::run::Provenance;
use crate::world::World;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use std::path::Path;

/// What they lie in.
const CONTAINER: &str = "container.vtp";

/// A kind of file of which there is one for each output.
struct Kind {
    /// Its list.
    list: &'static str,
    write: fn(&World, &Provenance, &mut dyn Write) -> io::Result<()>,
}

/// What is written of each of [`FRAMES`].
const KINDS: [Kind; FRAMES.len()] = [
    Kind {
        list: "grains.pvd",
        write: write_grains,
    },
    Kind {
        list: "contacts.pvd",
        write: write_contacts,
    },
];

/// The lists of the files.
pub const LISTS: [&str; 2] = [KINDS[0].list, KINDS[1].list];
/// All that is not in those folders.
pub const OTHERS: [&str; 4] = [KINDS[0].list, KINDS[1].list, SHAPES, CONTAINER];

/// What is kept of a file of an instant: it is called by its number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Frame {
    /// Simulated time of the state in it [s].
    time: f64,
    /// The digest of its bytes.
    digest: [u8; blake3::OUT_LEN],
}

/// The files that were written.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WrittenFrames {
    /// Those of each instant, by their kinds.
    frames: [Vec<Frame>; FRAMES.len()],
    /// Those that hold for the whole run.
    lasting: Vec<CollectedFile>,
}

impl WrittenFrames {
    /// The first of the files that `folder` does not hold.
    pub fn missing(&self, folder: &Path) -> Option<String> {
        let mut names = self.files().map(|frame| frame.name);
        names.find(|name| !folder.join(name).is_file())
    }

    /// Every file.
    pub fn files(&self) -> impl Iterator<Item = CollectedFile> {
        let kinds = 0..FRAMES.len();
        let frames = kinds.flat_map(|kind| self.of_kind(kind));
        frames.chain(self.lasting.iter().cloned())
    }

    /// Those of each instant that are of the kind at this index of [`KINDS`].
    fn of_kind(&self, kind: usize) -> impl Iterator<Item = CollectedFile> {
        let frames = self.frames[kind].iter().enumerate();
        frames.map(move |(index, frame)| CollectedFile {
            time: frame.time,
            name: OutputFolder::frame_name(FRAMES[kind], index),
            digest: blake3::Hash::from(frame.digest).to_hex().to_string(),
        })
    }

    /// Simulated time of the last [s].
    pub fn last_time(&self) -> Option<f64> {
        self.frames[0].last().map(|frame| frame.time)
    }
}

/// Writes the files.
pub struct FrameFiles {
    written: WrittenFrames,
    lists: Vec<CollectionFile>,
    /// Files that are not durable yet.
    unsynced: Vec<String>,
}

impl FrameFiles {
    /// Begins in `folder` behind what was `written`, all `from` one run.
    ///
    /// # Errors
    /// When a list cannot be written.
    pub fn begin(
        folder: &OutputFolder,
        written: WrittenFrames,
        from: &Provenance,
    ) -> Result<Self, OutputError> {
        let lists = KINDS.iter().enumerate().map(|(index, kind)| {
            CollectionFile::begin(folder, kind.list, written.of_kind(index), from)
        });
        let lists = lists.collect::<Result<_, _>>()?;
        Ok(Self {
            written,
            lists,
            unsynced: Vec::new(),
        })
    }

    /// What was written so far.
    pub fn written(&self) -> &WrittenFrames {
        &self.written
    }

    /// Writes the state of `world`, which comes `from` there.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(
        &mut self,
        folder: &OutputFolder,
        world: &World,
        from: &Provenance,
    ) -> Result<(), OutputError> {
        if self.written.frames[0].is_empty() {
            self.write_lasting(folder, world, from)?;
        }
        let lists = self.lists.iter_mut().zip(&mut self.written.frames);
        for ((name, kind), (list, frames)) in FRAMES.iter().zip(&KINDS).zip(lists) {
            let name = OutputFolder::frame_name(name, frames.len());
            let digest = folder.write_unsynced(&name, |file| (kind.write)(world, from, file))?;
            self.unsynced.push(name.clone());
            let time = world.time();
            let kept = blake3::Hash::from_hex(&digest).map_err(io::Error::other);
            let frame = Frame {
                time,
                digest: folder.named(&name, kept)?.into(),
            };
            let digest = String::new();
            list.add(folder, &CollectedFile { time, name, digest })?;
            frames.push(frame);
        }
        Ok(())
    }

    /// Writes what holds for the whole run.
    fn write_lasting(
        &mut self,
        folder: &OutputFolder,
        world: &World,
        from: &Provenance,
    ) -> Result<(), OutputError> {
        self.written.lasting.clear();
        let mut add = |name: &str, digest| {
            self.written.lasting.push(CollectedFile {
                time: world.time(),
                name: name.into(),
                digest,
            });
        };
        if let Some(polyhedra) = &world.polyhedra {
            let digest = folder.write(SHAPES, |file| write_shapes(world, polyhedra, from, file))?;
            add(SHAPES, digest);
        }
        if !world.container.walls.is_empty() {
            let digest = folder.write(CONTAINER, |file| write_container(world, from, file))?;
            add(CONTAINER, digest);
        }
        Ok(())
    }

    /// Makes all of them durable.
    ///
    /// # Errors
    /// When the disk fails.
    pub fn sync(&mut self, folder: &OutputFolder) -> Result<(), OutputError> {
        folder.sync(&self.unsynced)?;
        self.unsynced.clear();
        self.lists.iter().try_for_each(|list| list.sync(folder))
    }

    /// Writes the lists of a run that is over, `from` its last state, and returns the names and
    /// digests of all files.
    ///
    /// # Errors
    /// When a list cannot be written.
    pub fn finish(
        &self,
        folder: &OutputFolder,
        from: &Provenance,
    ) -> Result<Vec<(String, String)>, OutputError> {
        let files = self.written.files();
        let mut files: Vec<_> = files.map(|frame| (frame.name, frame.digest)).collect();
        for (index, kind) in KINDS.iter().enumerate() {
            let frames = self.written.of_kind(index);
            let digest = write_collection(folder, kind.list, frames, from)?;
            files.push((kind.list.into(), digest));
        }
        Ok(files)
    }
}
