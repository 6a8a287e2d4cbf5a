//! Files that appear whole or not at all, and files that are read whole or not at all.
//!
//! In: a path and what to write, or how much to read at most. Out: a file, or its bytes. Only
//! regular files are read: a device never ends, and a pipe may wait for ever.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Read, Write};
use std::path::Path;
use tempfile::{Builder, NamedTempFile, TempDir};

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
    is_regular(fs::metadata(path)?)?;
    let file = File::open(path)?;
    is_regular(file.metadata()?)?;
    Ok(file)
}

/// Writes the file at `path` with what `fill` writes, whole or not at all; missing folders are
/// made.
///
/// # Errors
/// When it cannot be written; nothing is left behind then.
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut buffer = BufWriter::new(new_file_in(folder_of(path)?)?);
    fill(&mut buffer)?;
    let file = buffer
        .into_inner()
        .map_err(io::IntoInnerError::into_error)?;
    file.persist(path)?;
    Ok(())
}

/// An empty folder under a name of its own beside `path`, in which to make what is then given that
/// name as a whole; it goes away with what is in it when it is dropped. Missing folders above are
/// made.
///
/// # Errors
/// When it cannot be made.
pub fn folder_beside(path: &Path) -> io::Result<TempDir> {
    let folder = folder_of(path)?;
    let mut builder = Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o777));
    }
    builder.prefix(".grainfall-").tempdir_in(folder)
}

/// The folder that `path` is in, made where it is missing.
fn folder_of(path: &Path) -> io::Result<&Path> {
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let folder = folder.unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    Ok(folder)
}

/// A file under a name of its own, readable for whom the user's mask allows.
fn new_file_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.prefix(".grainfall-").tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_of_a_bounded_size_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("four");
        fs::write(&path, "four").unwrap();
        assert_eq!(read_whole(&path, 4).unwrap(), b"four");
        let refused = |path: &Path, most| read_whole(path, most).unwrap_err().to_string();
        assert!(refused(&path, 3).contains("larger than"));
        assert!(refused(folder.path(), 4).contains("this is a folder"));
    }

    #[cfg(unix)]
    #[test]
    fn devices_and_pipes_are_not_opened() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        for path in [&pipe, Path::new("/dev/zero")] {
            let error = read_whole(path, 1 << 20).unwrap_err().to_string();
            assert!(error.contains("only regular files"), "{error}");
        }
    }
}
