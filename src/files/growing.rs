//! Files that grow at their end.
//!
//! In: what a file begins with, then additions to it, and what stands behind the newest one. Out: a
//! file that is whole after each addition and costs what is added, not what is there. Where an
//! addition fails, the file is as it was before it.

use super::attempt::{attempt, became_durable};
use super::target::check_target;
use super::whole::write_whole;
use std::fs::{File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A file that grows at its end.
#[derive(Debug)]
pub struct GrowingFile {
    path: PathBuf,
    file: File,
    /// Bytes of it that stay.
    length: u64,
    /// What stands behind them, and is written anew behind each addition.
    tail: &'static [u8],
}

impl GrowingFile {
    /// Writes the file at `path` with `head` and `tail`, whole or not at all, in the place of an
    /// earlier one.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn begin(path: &Path, head: &[u8], tail: &'static [u8]) -> io::Result<Self> {
        write_whole(path, |file| {
            file.write_all(head)?;
            file.write_all(tail)
        })?;
        Self::open(path, head.len() as u64, tail)
    }

    /// Goes on with the file at `path` behind its first `length` bytes; what follows them is
    /// forgotten.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn go_on(path: &Path, length: u64) -> io::Result<Self> {
        let file = Self::open(path, length, b"")?;
        attempt(path)?;
        file.file.set_len(length)?;
        Ok(file)
    }

    fn open(path: &Path, length: u64, tail: &'static [u8]) -> io::Result<Self> {
        check_target(path)?;
        attempt(path)?;
        Ok(Self {
            file: OpenOptions::new().write(true).open(path)?,
            path: path.to_owned(),
            length,
            tail,
        })
    }

    /// Puts `bytes` at its end, before the tail.
    ///
    /// # Errors
    /// When they cannot be written; the file is then as it was.
    pub fn add(&mut self, bytes: &[u8]) -> io::Result<()> {
        let both = [bytes, self.tail].concat();
        let added = attempt(&self.path).and_then(|()| self.put(&both));
        if added.is_ok() {
            self.length += bytes.len() as u64;
            return added;
        }
        // What was there fits on the disk: it was there. Should even this fail, readers find rows
        // that are whole up to the one that was cut off, and the first error is the one to tell.
        let restored = self
            .file
            .set_len(self.length)
            .and_then(|()| self.put(self.tail));
        added.map_err(|error| match restored {
            Ok(()) => error,
            Err(second) => io::Error::new(
                error.kind(),
                format!("{error}; its end could not be taken back either: {second}"),
            ),
        })
    }

    /// Bytes that it has before its tail.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// Makes what was added durable.
    ///
    /// # Errors
    /// When the disk fails.
    pub fn sync(&self) -> io::Result<()> {
        attempt(&self.path)?;
        self.file.sync_data()?;
        became_durable(&self.path);
        Ok(())
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.seek(SeekFrom::Start(self.length))?;
        self.file.write_all(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::super::FailingCalls;
    use super::*;
    use std::fs;

    #[test]
    fn file_is_whole_after_each_addition_and_as_before_where_one_fails() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("list");
        let mut file = GrowingFile::begin(&path, b"<a>", b"</a>").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"<a></a>");
        file.add(b"1").unwrap();
        {
            let _failing = FailingCalls::below(folder.path(), |_| true);
            assert!(file.add(b"2").is_err());
        }
        assert_eq!(fs::read(&path).unwrap(), b"<a>1</a>");
        file.add(b"34").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"<a>134</a>");
        let mut file = GrowingFile::go_on(&path, 4).unwrap();
        file.add(b"5").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"<a>15");
    }
}
