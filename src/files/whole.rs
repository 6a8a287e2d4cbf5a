//! Files that appear whole or not at all.
//!
//! In: a path and what to write. Out: the file under that path as it was, or as it is to be, and
//! nothing between, whenever the program or the machine stops.

use super::attempt::{attempt, became_durable};
use super::target::check_target;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile, TempDir};

/// What the names of files begin with that are not whole yet.
const TEMPORARY: &str = ".grainfall-";

/// Writes the file at `path` with what `fill` writes, whole or not at all; missing folders are
/// made. It is on the disk when this returns.
///
/// # Errors
/// When it cannot be written, or what is at `path` is no regular file; nothing is left behind then.
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let file = fill_beside(path, fill)?;
    attempt(path)?;
    file.as_file().sync_all()?;
    became_durable(file.path());
    attempt(path)?;
    file.persist(path)?;
    sync_folder(above(path))
}

/// The same, and the system may keep it in memory for a while: whoever stops the program cannot
/// lose it, a failing machine can until [`sync_file`] was called.
///
/// # Errors
/// As [`write_whole`].
pub fn write_whole_unsynced(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let file = fill_beside(path, fill)?;
    attempt(path)?;
    file.persist(path)?;
    Ok(())
}

/// Makes the file at `path` durable, without its name in its folder.
///
/// # Errors
/// When the disk fails.
pub fn sync_file(path: &Path) -> io::Result<()> {
    attempt(path)?;
    File::open(path)?.sync_all()?;
    became_durable(path);
    Ok(())
}

/// A file that is to become the one at `path`, with what `fill` writes.
fn fill_beside(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<NamedTempFile> {
    check_target(path)?;
    let folder = folder_of(path)?;
    let file = Attempted {
        file: new_file_in(folder)?,
        path: path.to_owned(),
    };
    let mut buffer = BufWriter::new(file);
    fill(&mut buffer)?;
    let whole = buffer
        .into_inner()
        .map_err(io::IntoInnerError::into_error)?;
    Ok(whole.file)
}

/// Removes the file at `path`, if there is one.
///
/// # Errors
/// When it cannot be removed, or is no regular file.
pub fn remove_file(path: &Path) -> io::Result<()> {
    check_target(path)?;
    attempt(path)?;
    match fs::remove_file(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        outcome => outcome,
    }
}

/// Makes the names in `folder` durable, where the system has a way to.
///
/// # Errors
/// When the disk fails.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    attempt(folder)?;
    if cfg!(unix) {
        let synced = File::open(folder).and_then(|folder| folder.sync_all());
        // Some network file systems know no such thing, and of a folder that may not be read
        // nobody can ask it.
        let cannot = [
            ErrorKind::Unsupported,
            ErrorKind::InvalidInput,
            ErrorKind::PermissionDenied,
        ];
        synced.or_else(|error| cannot.contains(&error.kind()).then_some(()).ok_or(error))?;
    }
    became_durable(folder);
    Ok(())
}

/// Whether a file or folder of this name is one that was not whole yet when the program stopped.
pub fn is_temporary(name: &str) -> bool {
    name.starts_with(TEMPORARY)
}

/// Whether `folder` is there and holds anything, beside what was not whole yet when a program
/// stopped.
///
/// # Errors
/// When it cannot be read.
pub fn holds_files(folder: &Path) -> io::Result<bool> {
    if !folder.exists() {
        return Ok(false);
    }
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name();
        if !name.to_str().is_some_and(is_temporary) {
            return Ok(true);
        }
    }
    Ok(false)
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
    attempt(folder)?;
    builder.prefix(TEMPORARY).tempdir_in(folder)
}

/// The folder that `path` is in, made where it is missing.
fn folder_of(path: &Path) -> io::Result<&Path> {
    let folder = above(path);
    make_folder(folder)?;
    Ok(folder)
}

/// The folder that `path` is in.
pub(super) fn above(path: &Path) -> &Path {
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    folder.unwrap_or(Path::new("."))
}

/// Makes the folder at `path` and those above it where they are missing, their names durable.
///
/// # Errors
/// When one of them cannot be made.
pub fn make_folder(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        return Ok(());
    }
    make_folder(above(path))?;
    attempt(path)?;
    match fs::create_dir(path) {
        Err(_) if path.is_dir() => {}
        outcome => outcome?,
    }
    sync_folder(above(path))
}

/// A file under a name of its own, readable for whom the user's mask allows.
fn new_file_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    attempt(folder)?;
    builder.prefix(TEMPORARY).tempfile_in(folder)
}

/// A file that is to become the one at `path`.
struct Attempted {
    file: NamedTempFile,
    path: PathBuf,
}

impl Write for Attempted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        attempt(&self.path)?;
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
