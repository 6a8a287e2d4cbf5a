//! Folders, and files that another program writes, that appear whole or not at all.
//!
//! In: a path and what makes it. Out: the folder or file under that path, and nothing of it where
//! that fails. It is made under a name of its own beside it, made durable and then renamed.

use super::attempt::attempt;
use super::target::check_target;
use super::whole::{above, folder_beside, sync_file, sync_folder};
use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

/// Makes the folder at `path` with the files that `fill` writes into the one it is given. What is
/// at `path` already stays.
///
/// # Errors
/// When it cannot be made, or something is at `path`; nothing is left behind then.
pub fn make_whole_folder(
    path: &Path,
    fill: impl FnOnce(&Path) -> io::Result<()>,
) -> io::Result<()> {
    if fs::symlink_metadata(path).is_ok() {
        let reason = "it exists already; choose another name";
        return Err(io::Error::new(ErrorKind::AlreadyExists, reason));
    }
    let folder = folder_beside(path)?;
    fill(folder.path())?;
    for entry in fs::read_dir(folder.path())? {
        sync_file(&entry?.path())?;
    }
    sync_folder(folder.path())?;
    attempt(path)?;
    fs::rename(folder.path(), path)?;
    sync_folder(above(path))
}

/// Has the file at `path` made by `make`, which is given where to, a path with the same extension:
/// for files that another program writes.
///
/// # Errors
/// When it is not made, or what is at `path` is no regular file; nothing is left behind then.
pub fn make_whole_file(path: &Path, make: impl FnOnce(&Path) -> io::Result<()>) -> io::Result<()> {
    check_target(path)?;
    let folder = folder_beside(path)?;
    let name = Path::new("made").with_extension(path.extension().unwrap_or_default());
    let made = folder.path().join(name);
    make(&made)?;
    sync_file(&made)?;
    // What became of the target meanwhile.
    check_target(path)?;
    attempt(path)?;
    fs::rename(made, path)?;
    sync_folder(above(path))
}

#[cfg(test)]
mod tests {
    use super::super::FailingCalls;
    use super::*;
    use crate::files::write_whole;

    fn pictures(home: &Path) -> io::Result<()> {
        make_whole_folder(&home.join("film"), |folder| {
            write_whole(&folder.join("00000.png"), |file| file.write_all(b"one"))?;
            write_whole(&folder.join("00001.png"), |file| file.write_all(b"two"))
        })
    }

    fn video(home: &Path) -> io::Result<()> {
        make_whole_file(&home.join("film.mp4"), |made| {
            assert_eq!(made.extension(), Some("mp4".as_ref()));
            fs::write(made, b"moving")
        })
    }

    /// The names in `folder`.
    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names.collect()
    }

    /// What `act` comes to in a folder of its own where the n-th call fails: its result, the names
    /// that are left, and how many calls there were.
    fn failing(act: fn(&Path) -> io::Result<()>, n: u64) -> (io::Result<()>, Vec<String>, u64) {
        let home = tempfile::tempdir().unwrap();
        let failing = FailingCalls::below(home.path(), move |call| call == n);
        let done = act(home.path());
        (done, names(home.path()), failing.calls())
    }

    /// Lets the n-th call of `act` fail for every n; returns how many there are.
    fn fail_each(act: fn(&Path) -> io::Result<()>, name: &str) -> u64 {
        let (done, left, calls) = failing(act, u64::MAX);
        done.unwrap();
        assert_eq!(left, [name]);
        for n in 0..calls {
            let (done, left, _) = failing(act, n);
            assert!(done.is_err(), "call {n} failed, and nobody said so");
            // The last call is about the durability of the name: what it names is whole.
            assert_eq!(
                left.len(),
                usize::from(n + 1 == calls),
                "call {n}: {left:?}"
            );
        }
        calls
    }

    #[test]
    fn any_call_about_a_film_may_fail_and_leaves_a_whole_one_or_none() {
        assert!(fail_each(pictures, "film") > 10);
        assert!(fail_each(video, "film.mp4") > 3);
    }

    #[test]
    fn what_is_there_is_not_written_over_but_for_a_file() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path();
        fs::create_dir(path.join("film")).unwrap();
        assert!(pictures(path).unwrap_err().to_string().contains("exists"));
        fs::create_dir(path.join("film.mp4")).unwrap();
        assert!(video(path).unwrap_err().to_string().contains("folder"));
        fs::remove_dir(path.join("film.mp4")).unwrap();
        fs::write(path.join("film.mp4"), b"old").unwrap();
        video(path).unwrap();
        assert_eq!(fs::read(path.join("film.mp4")).unwrap(), b"moving");
        assert!(
            make_whole_file(&path.join("a.mp4"), |_| Ok(())).is_err(),
            "nothing was made"
        );
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(path.join("film.mp4"), path.join("link.mp4")).unwrap();
            let linked = make_whole_file(&path.join("link.mp4"), |made| fs::write(made, b"x"));
            assert!(linked.unwrap_err().to_string().contains("symbolic link"));
        }
        assert_eq!(fs::read(path.join("film.mp4")).unwrap(), b"moving");
    }
}
