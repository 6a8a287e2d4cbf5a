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

/// What is kept of the files of an instant, which are called by its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Simulated time of the state in them [s].
    time: f64,
    /// The digests of their bytes, by their kinds.
    digests: [[u8; blake3::OUT_LEN]; FRAMES.len()],
}

impl Frame {
    /// Bytes that it takes in a file.
    pub const SIZE: usize = size_of::<f64>() + FRAMES.len() * blake3::OUT_LEN;

    /// Its bytes.
    pub fn to_bytes(self) -> Vec<u8> {
        let digests = self.digests.as_flattened().iter().copied();
        self.time.to_le_bytes().into_iter().chain(digests).collect()
    }

    /// The frame that these [`Frame::SIZE`] bytes hold.
    pub fn from_bytes(bytes: &[u8; Self::SIZE]) -> Self {
        let (mut time, mut digests) = ([0; size_of::<f64>()], [[0; blake3::OUT_LEN]; FRAMES.len()]);
        let (first, rest) = bytes.split_at(time.len());
        time.copy_from_slice(first);
        digests.as_flattened_mut().copy_from_slice(rest);
        Self {
            time: f64::from_le_bytes(time),
            digests,
        }
    }
}

/// The files that were written. What stands in a run's log of frames may be forgotten.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WrittenFrames {
    /// Instants that are forgotten.
    forgotten: usize,
    /// Those after them.
    frames: Vec<Frame>,
    /// Files that hold for the whole run.
    lasting: Vec<CollectedFile>,
}

impl WrittenFrames {
    /// The first of the files that `folder` does not hold.
    pub fn missing(&self, folder: &Path) -> Option<String> {
        let mut names = self.files().map(|frame| frame.name);
        names.find(|name| !folder.join(name).is_file())
    }

    /// Those of a run with these `lasting` files, all of whose `frames` are known.
    pub fn new(frames: Vec<Frame>, lasting: Vec<CollectedFile>) -> Self {
        Self {
            forgotten: 0,
            frames,
            lasting,
        }
    }

    /// Files that hold for the whole run.
    pub fn lasting(&self) -> &[CollectedFile] {
        &self.lasting
    }

    /// Instants of which files were written.
    pub fn count(&self) -> usize {
        self.forgotten + self.frames.len()
    }

    /// What is kept from instant number `from` on, which is not forgotten.
    pub fn since(&self, from: usize) -> &[Frame] {
        &self.frames[from.saturating_sub(self.forgotten)..]
    }

    /// Forgets the first instants, so many, but for the last of all.
    pub fn forget(&mut self, first: usize) {
        let new = first.min(self.count().saturating_sub(1));
        let new = new.saturating_sub(self.forgotten);
        self.frames.drain(..new);
        self.frames.shrink_to(2 * self.frames.len());
        self.forgotten += new;
    }

    /// Takes what was forgotten from `all` instants, the first of the run on.
    pub fn remember(&mut self, all: &[Frame]) {
        self.frames
            .splice(..0, all[..self.forgotten].iter().copied());
        self.forgotten = 0;
    }

    /// Every file, where nothing is forgotten.
    pub fn files(&self) -> impl Iterator<Item = CollectedFile> {
        let kinds = 0..FRAMES.len();
        let frames = kinds.flat_map(|kind| self.of_kind(kind));
        frames.chain(self.lasting.iter().cloned())
    }

    /// Those of each instant that are of the kind at this index of [`KINDS`].
    fn of_kind(&self, kind: usize) -> impl Iterator<Item = CollectedFile> {
        let frames = self.frames.iter().enumerate();
        frames.map(move |(index, frame)| CollectedFile {
            time: frame.time,
            name: OutputFolder::frame_name(FRAMES[kind], index),
            digest: blake3::Hash::from(frame.digests[kind]).to_hex().to_string(),
        })
    }

    /// Simulated time of the last [s].
    pub fn last_time(&self) -> Option<f64> {
        self.frames.last().map(|frame| frame.time)
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

    /// The same, to forget or remember some of it.
    pub fn written_mut(&mut self) -> &mut WrittenFrames {
        &mut self.written
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
        let (time, number) = (world.time(), self.written.count());
        if number == 0 {
            self.write_lasting(folder, world, from)?;
        }
        let mut digests = [[0; blake3::OUT_LEN]; FRAMES.len()];
        let kinds = FRAMES.iter().zip(&KINDS).zip(&mut self.lists);
        for (((name, kind), list), kept) in kinds.zip(&mut digests) {
            let name = OutputFolder::frame_name(name, number);
            let digest = folder.write_unsynced(&name, |file| (kind.write)(world, from, file))?;
            self.unsynced.push(name.clone());
            let digest = blake3::Hash::from_hex(digest).map_err(io::Error::other);
            *kept = folder.named(&name, digest)?.into();
            let digest = String::new();
            list.add(folder, &CollectedFile { time, name, digest })?;
        }
        self.written.frames.push(Frame { time, digests });
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

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(number: u8) -> Frame {
        Frame {
            time: f64::from(number),
            digests: [[number; blake3::OUT_LEN], [!number; blake3::OUT_LEN]],
        }
    }

    /// Each output took 80 bytes of memory for as long as a run went on.
    #[test]
    fn frames_that_stand_in_a_log_are_forgotten_but_counted_and_remembered() {
        let all: Vec<Frame> = (0..9).map(frame).collect();
        let log: Vec<u8> = all.iter().flat_map(|frame| frame.to_bytes()).collect();
        let whole = WrittenFrames::new(all.clone(), Vec::new());
        let mut part = whole.clone();
        part.forget(6);
        part.forget(2);
        assert_eq!((part.count(), part.frames.len()), (9, 3));
        assert_eq!(part.since(7), &all[7..]);
        part.forget(9);
        assert_eq!((part.count(), part.last_time()), (9, Some(8.0)));
        assert!(part.since(9).is_empty());
        let (read, rest) = log.as_chunks();
        let read: Vec<Frame> = read.iter().map(Frame::from_bytes).collect();
        assert!(rest.is_empty());
        part.remember(&read);
        assert!(part == whole && part.files().eq(whole.files()));
    }
}
