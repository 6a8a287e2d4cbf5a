//! Files that appear whole or not at all.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use tempfile::{Builder, NamedTempFile, TempDir};

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
