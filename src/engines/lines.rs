//! A text file line by line, however long it is.
//!
//! In: a regular file. Out: its lines, each bounded in length, with their numbers; read one at a
//! time, so that files larger than memory can be read.

use super::atom_frame::FrameError;
use crate::files::open_regular;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Longest line that is read [bytes].
const LONGEST: u64 = 1 << 14;

/// The lines of a file.
pub struct Lines {
    path: PathBuf,
    file: BufReader<File>,
    bytes: Vec<u8>,
    number: u64,
    /// Bytes of the file that were read.
    taken: u64,
    /// Whether the present line is to be read again.
    is_kept: bool,
}

impl Lines {
    /// Of the file at `path`.
    ///
    /// # Errors
    /// When it cannot be opened, or is no regular file.
    pub fn open(path: &Path) -> Result<Self, FrameError> {
        let file = open_regular(path)
            .map_err(|error| FrameError::of_file(path, format!("cannot be read: {error}")))?;
        Ok(Self {
            path: path.to_owned(),
            file: BufReader::with_capacity(1 << 16, file),
            bytes: Vec::new(),
            number: 0,
            taken: 0,
            is_kept: false,
        })
    }

    /// Goes to the next line; none at the end.
    ///
    /// # Errors
    /// When it cannot be read, is too long or no text.
    pub fn next_line(&mut self) -> Result<Option<&str>, FrameError> {
        if self.is_kept {
            self.is_kept = false;
        } else {
            self.bytes.clear();
            let read = (&mut self.file)
                .take(LONGEST)
                .read_until(b'\n', &mut self.bytes);
            let read = read.map_err(|error| {
                FrameError::of_file(&self.path, format!("cannot be read: {error}"))
            })?;
            if read == 0 {
                return Ok(None);
            }
            self.number += 1;
            self.taken += read as u64;
            if read as u64 == LONGEST && self.bytes.last() != Some(&b'\n') {
                return Err(self.wrong(format!("a line of more than {LONGEST} bytes")));
            }
        }
        match std::str::from_utf8(&self.bytes) {
            Ok(text) => Ok(Some(text.trim_end_matches(['\n', '\r']))),
            Err(_) => Err(FrameError::at_line(
                &self.path,
                self.number,
                "is no text: a binary or compressed file is not read",
            )),
        }
    }

    /// The next line, which has to be there; `expected` says what it holds.
    ///
    /// # Errors
    /// When the file ends before.
    pub fn line(&mut self, expected: &str) -> Result<&str, FrameError> {
        if self.next_line()?.is_none() {
            return Err(self.wrong(format!("the file ends; expected {expected}")));
        }
        Ok(std::str::from_utf8(&self.bytes).unwrap_or_default().trim())
    }

    /// The next line as one number.
    ///
    /// # Errors
    /// When it is none.
    pub fn number<T: FromStr>(&mut self, expected: &str) -> Result<T, FrameError> {
        let text = self.line(expected)?.to_owned();
        text.parse()
            .map_err(|_| self.wrong(format!("`{}`; expected {expected}", shortened(&text))))
    }

    /// Lets the present line be read again.
    pub fn keep(&mut self) {
        self.is_kept = self.number > 0;
    }

    /// That something is wrong with the present line.
    pub fn wrong(&self, reason: impl Into<String>) -> FrameError {
        FrameError::at_line(&self.path, self.number, reason)
    }

    /// Bytes of the file that were read.
    pub fn taken(&self) -> u64 {
        self.taken
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// `text`, cut where it is long.
pub fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    if text.chars().count() <= MOST {
        return text.escape_default().to_string();
    }
    let start: String = text.chars().take(MOST).collect();
    format!("{}…", start.escape_default())
}
