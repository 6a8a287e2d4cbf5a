//! Files of an engine, whichever of the kinds they are.
//!
//! In: paths. Out: the instants that they hold, one at a time, in order of their steps.

use super::atom_frame::{AtomFrame, FrameError};
use super::data_file::read_data_file;
use super::dump_file::next_frame;
use super::lines::Lines;
use super::xyz_file::read_xyz_file;
use std::path::Path;

/// How names of dumps end.
pub const DUMP: &str = "dump";
/// How names of extended XYZ end.
pub const XYZ: &str = "xyz";

/// A file that is being read.
pub enum FrameFile {
    /// A dump.
    Dump(Box<Lines>),
    /// A data file or extended XYZ, which hold one instant; none once it was taken.
    One(Option<AtomFrame>),
}

impl FrameFile {
    /// The file at `path`: a dump where it begins with `ITEM:`, extended XYZ where it is called so,
    /// else a data file.
    ///
    /// # Errors
    /// When it cannot be read, or is neither.
    pub fn open(path: &Path) -> Result<Self, FrameError> {
        let mut lines = Lines::open(path)?;
        let is_dump = match lines.next_line()? {
            None => return Err(FrameError::of_file(path, "is empty")),
            Some(line) => line.trim_start().starts_with("ITEM:"),
        };
        lines.keep();
        if is_dump {
            return Ok(Self::Dump(Box::new(lines)));
        }
        let frame = if path.extension().is_some_and(|word| word == XYZ) {
            read_xyz_file(&mut lines)?
        } else {
            read_data_file(&mut lines)?
        };
        Ok(Self::One(Some(frame)))
    }

    /// The next instant; none at the end.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn next_frame(&mut self) -> Result<Option<AtomFrame>, FrameError> {
        match self {
            Self::Dump(lines) => next_frame(lines),
            Self::One(frame) => Ok(frame.take()),
        }
    }

    /// Bytes of a dump that were read until now; other files are read as a whole.
    pub fn taken(&self) -> u64 {
        match self {
            Self::Dump(lines) => lines.taken(),
            Self::One(_) => 0,
        }
    }
}

/// All instants in the file at `path`.
///
/// # Errors
/// What is wrong with it, and where.
pub fn read_frames(path: &Path) -> Result<Vec<AtomFrame>, FrameError> {
    let mut file = FrameFile::open(path)?;
    let mut frames = Vec::new();
    while let Some(frame) = file.next_frame()? {
        frames.push(frame);
    }
    Ok(frames)
}
