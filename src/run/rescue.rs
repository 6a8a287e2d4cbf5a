//! What a window was about, kept for the case that it ends without being asked to: killed, a
//! display that goes, power that fails.
//!
//! In: a folder of the user's. Out: the path of a session that is this process's own as long as it
//! runs, and the sessions that others left which run no more. Whose a session is says a lock of
//! the system's, which ends with its process. Writing the session, and when, is for others.

use crate::files::{FolderLock, LockError, make_folder, remove_file};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// What a session is called in its folder.
const NAME: &str = "rescued.grainfall";
/// Most windows whose work is kept at once.
const MOST: usize = 32;

/// Where this process keeps its session.
#[derive(Debug)]
pub struct Rescue {
    folder: PathBuf,
    _lock: FolderLock,
}

impl Rescue {
    /// The folder of the user that all of them lie in; none where the system has no such place.
    pub fn home() -> Option<PathBuf> {
        let folders = directories::ProjectDirs::from("", "", "grainfall")?;
        Some(folders.cache_dir().join("rescued"))
    }

    /// Takes a place below `home` that nobody has and in which nobody left anything.
    ///
    /// # Errors
    /// When `home` cannot be written, has no locks, or all places are taken.
    pub fn begin(home: &Path) -> io::Result<Self> {
        for number in 0..MOST {
            let folder = home.join(number.to_string());
            make_folder(&folder)?;
            match FolderLock::of(&folder) {
                Ok(lock) if !lock.holds() => {
                    let reason = "the file system has no locks";
                    return Err(io::Error::new(ErrorKind::Unsupported, reason));
                }
                Ok(lock) if !folder.join(NAME).exists() => {
                    return Ok(Self {
                        folder,
                        _lock: lock,
                    });
                }
                Ok(_) | Err(LockError::Taken(_)) => {}
                Err(LockError::Unwritten(error)) => return Err(error),
            }
        }
        let reason = format!("{MOST} windows' work is kept in {}", home.display());
        Err(io::Error::new(ErrorKind::QuotaExceeded, reason))
    }

    /// The session's path.
    pub fn path(&self) -> PathBuf {
        self.folder.join(NAME)
    }

    /// Removes the session: its work is saved, or not wanted.
    ///
    /// # Errors
    /// When it cannot be removed.
    pub fn clear(&self) -> io::Result<()> {
        remove_file(&self.path())
    }

    /// The sessions below `home` whose processes run no more. Whoever opens one removes it when
    /// its work is saved or discarded.
    pub fn left(home: &Path) -> Vec<PathBuf> {
        let folders = (0..MOST).map(|number| home.join(number.to_string()));
        let left = folders.filter(|folder| {
            let is_there = folder.join(NAME).is_file();
            is_there && FolderLock::of(folder).is_ok_and(|lock| lock.holds())
        });
        left.map(|folder| folder.join(NAME)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn what_a_process_left_is_found_and_what_it_works_on_is_not() {
        let home = tempfile::tempdir().unwrap();
        let home = home.path();
        assert_eq!(Rescue::left(home), Vec::<PathBuf>::new());
        let [first, second] = [(); 2].map(|()| Rescue::begin(home).unwrap());
        assert_ne!(first.path(), second.path());
        fs::write(first.path(), "work").unwrap();
        fs::write(second.path(), "work").unwrap();
        assert_eq!(
            Rescue::left(home),
            Vec::<PathBuf>::new(),
            "both are at work"
        );
        let path = first.path();
        drop(first);
        assert_eq!(Rescue::left(home), std::slice::from_ref(&path));
        // A new one does not write over it.
        let third = Rescue::begin(home).unwrap();
        assert_ne!(third.path(), path);
        second.clear().unwrap();
        drop(second);
        fs::remove_file(&path).unwrap();
        assert_eq!(Rescue::left(home), Vec::<PathBuf>::new());
    }

    #[test]
    fn places_have_an_end_and_a_home_that_is_none_is_said() {
        let home = tempfile::tempdir().unwrap();
        let taken: Vec<Rescue> = (0..MOST)
            .map(|_| Rescue::begin(home.path()).unwrap())
            .collect();
        let message = Rescue::begin(home.path()).unwrap_err().to_string();
        assert!(message.contains("32 windows"), "{message}");
        drop(taken);
        fs::write(home.path().join("file"), "").unwrap();
        assert!(Rescue::begin(&home.path().join("file")).is_err());
    }
}
