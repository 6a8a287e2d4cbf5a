//! What a run measured, in a file that grows at its end.
//!
//! In: records one behind the other. Out: the file, and how much of it belongs to a checkpoint.

use crate::files::{GrowingFile, read_whole};
use crate::output::OutputError;
use serde::{Deserialize, Serialize};
use std::io::{self, ErrorKind};
use std::path::PathBuf;

/// Largest file that is read [bytes].
const LARGEST: u64 = 16 << 30;

/// How much of a log belongs to a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LogPart {
    records: u64,
    /// Bytes that they take.
    length: u64,
    /// Of these.
    digest: [u8; blake3::OUT_LEN],
}

/// A log.
pub struct Log {
    path: PathBuf,
    /// None before the first record.
    file: Option<GrowingFile>,
    records: usize,
    digest: blake3::Hasher,
}

impl Log {
    /// The log in the file at `path`, which begins with the first record.
    pub fn new(path: PathBuf) -> Self {
        Self {
            path,
            file: None,
            records: 0,
            digest: blake3::Hasher::new(),
        }
    }

    /// Records that are in it.
    pub fn records(&self) -> usize {
        self.records
    }

    /// What is in it.
    pub fn part(&self) -> LogPart {
        LogPart {
            records: self.records as u64,
            length: self.length(),
            digest: *self.digest.finalize().as_bytes(),
        }
    }

    fn length(&self) -> u64 {
        self.file.as_ref().map_or(0, GrowingFile::length)
    }

    /// Goes on behind this `part` of the file, whose bytes are returned; what follows them is
    /// forgotten.
    ///
    /// # Errors
    /// When the file does not hold that part, in words that name it.
    pub fn go_on(&mut self, part: LogPart) -> io::Result<Vec<u8>> {
        if part.length == 0 {
            return Ok(Vec::new());
        }
        let name = self.path.file_name().unwrap_or_default().display();
        let named = |error: io::Error| io::Error::new(error.kind(), format!("{name}: {error}"));
        let bytes = self.bytes(part.length).map_err(named)?;
        self.digest.update(&bytes);
        if *self.digest.finalize().as_bytes() != part.digest {
            let reason = format!("the digest of {name} does not fit");
            return Err(io::Error::new(ErrorKind::InvalidData, reason));
        }
        self.file = Some(GrowingFile::go_on(&self.path, part.length).map_err(named)?);
        self.records = part.records as usize;
        Ok(bytes)
    }

    /// Adds `bytes` durably, with which it has so many `records`.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn add(&mut self, bytes: &[u8], records: usize) -> Result<(), OutputError> {
        if bytes.is_empty() {
            return Ok(());
        }
        let added = match &mut self.file {
            Some(file) => file.add(bytes).and_then(|()| file.sync()),
            None => GrowingFile::begin(&self.path, bytes, b"").map(|file| self.file = Some(file)),
        };
        added.map_err(|source| OutputError::write(&self.path, source))?;
        self.digest.update(bytes);
        self.records = records;
        Ok(())
    }

    /// All that is in it.
    ///
    /// # Errors
    /// When it cannot be read, or is not what was written.
    pub fn read(&self) -> Result<Vec<u8>, OutputError> {
        if self.file.is_none() {
            return Ok(Vec::new());
        }
        let bytes = self.bytes(self.length());
        let bytes = bytes.map_err(|source| self.unreadable(source))?;
        if blake3::hash(&bytes) != self.digest.finalize() {
            let reason = "it is not as it was written";
            return Err(self.unreadable(io::Error::new(ErrorKind::InvalidData, reason)));
        }
        Ok(bytes)
    }

    /// That it cannot be read because of `source`.
    pub fn unreadable(&self, source: io::Error) -> OutputError {
        OutputError::Read {
            path: self.path.clone(),
            source,
        }
    }

    /// The first bytes of the file, so many.
    fn bytes(&self, length: u64) -> io::Result<Vec<u8>> {
        let mut bytes = read_whole(&self.path, LARGEST)?;
        if (bytes.len() as u64) < length {
            return Err(io::Error::new(ErrorKind::UnexpectedEof, "it was cut off"));
        }
        bytes.truncate(length as usize);
        Ok(bytes)
    }
}
