//! Files that are read whole or not at all.
//!
//! In: a path and how much to read at most. Out: the bytes. Only regular files are read: a device
//! never ends, and a pipe may wait for ever.

use super::attempt::attempt;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// The bytes of the regular file at `path`, `most` of them at most.
///
/// # Errors
/// When there is no such file, it is no regular file, is larger, or cannot be read; the words
/// suit "`path` cannot be read: …".
pub fn read_whole(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open_regular(path)?;
    let mut bytes = Vec::new();
    // One byte more than allowed tells a file that grew since.
    file.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 <= most {
        return Ok(bytes);
    }
    let size = if most < 1 << 20 {
        format!("{} kB", most >> 10)
    } else {
        format!("{} MiB", most >> 20)
    };
    Err(io::Error::new(
        ErrorKind::FileTooLarge,
        format!("it is larger than {size}, more than such a file holds"),
    ))
}

/// The regular file at `path`, open for reading. What is something else is not opened at all: to
/// open a pipe is to wait for its other end.
///
/// # Errors
/// When there is none, or it cannot be opened.
pub fn open_regular(path: &Path) -> io::Result<File> {
    let is_regular = |found: fs::Metadata| {
        if found.is_file() {
            return Ok(());
        }
        let what = if found.is_dir() {
            "this is a folder"
        } else {
            "this is a device, a pipe or a socket"
        };
        Err(io::Error::new(
            ErrorKind::InvalidInput,
            format!("{what}, and only regular files are read"),
        ))
    };
    attempt(path)?;
    is_regular(fs::metadata(path)?)?;
    let file = File::open(path)?;
    is_regular(file.metadata()?)?;
    Ok(file)
}
