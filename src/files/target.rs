//! What is never written over: a device, a pipe, a folder, and what a symbolic link points to.
//!
//! In: the path of a file that is to be written. Out: leave, or why not and what to do.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

/// Whether a file may be put in the place of what is at `path`.
///
/// # Errors
/// When something is there that is no regular file, or it cannot be told.
pub fn check_target(path: &Path) -> io::Result<()> {
    let metadata = match fs::symlink_metadata(path) {
        Ok(metadata) => metadata,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(error),
    };
    let kind = metadata.file_type();
    let reason = if kind.is_file() {
        return Ok(());
    } else if kind.is_symlink() {
        let aim = fs::read_link(path).map_or_else(
            |_| "another place".to_owned(),
            |aim| aim.display().to_string(),
        );
        format!("it is a symbolic link to {aim}; give that path itself, or remove the link")
    } else if kind.is_dir() {
        "it is a folder; choose another name".to_owned()
    } else {
        "it is a device, a pipe or a socket, which a file must not replace; choose another name"
            .to_owned()
    };
    Err(io::Error::new(ErrorKind::AlreadyExists, reason))
}
