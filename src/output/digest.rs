//! Digests of files, as records state them: BLAKE3 of all bytes, in hexadecimal.
//!
//! In: what is written to a file, or a file. Out: its digest. A digest tells a file from every
//! other; that it is the right one says the record that states it.

use crate::files::open_regular;
use std::io::{self, Write};
use std::path::Path;

/// A file whose digest is taken while it is written.
pub struct Digested<'a> {
    file: &'a mut dyn Write,
    hasher: blake3::Hasher,
}

impl<'a> Digested<'a> {
    /// `file`, to which nothing is written yet.
    pub fn new(file: &'a mut dyn Write) -> Self {
        Self {
            file,
            hasher: blake3::Hasher::new(),
        }
    }

    /// The digest of what was written.
    pub fn digest(&self) -> String {
        self.hasher.finalize().to_hex().to_string()
    }
}

impl Write for Digested<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// The digest of `bytes`.
pub fn digest_of(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

/// The digest of the file at `path`.
///
/// # Errors
/// When it cannot be read.
pub fn digest_of_file(path: &Path) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(open_regular(path)?)?;
    Ok(hasher.finalize().to_hex().to_string())
}
