//! One program at a time in a folder.
//!
//! In: a folder. Out: a lock that holds until it is dropped or its process ends, however it ends;
//! or who holds it. The lock is the system's own on the file [`LOCK`], which stays in the folder
//! and says who locked it last: the file by itself means nothing.

use super::attempt::attempt;
use super::reading::open_regular;
use super::target::check_target;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Write};
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

/// The file in a folder that is locked.
pub const LOCK: &str = ".grainfall.lock";
/// Most of that file that is read.
const LONGEST: u64 = 200;
/// After this a folder that is taken is looked at once more: who only asks whether it is
/// ([`FolderLock::is_held`]) takes it for microseconds.
const ONCE_MORE: Duration = Duration::from_millis(20);

/// A folder that nobody else writes to as long as this is there.
#[derive(Debug)]
pub struct FolderLock {
    /// Closed, and so unlocked, when this is dropped; none where the file system has no locks.
    file: Option<File>,
}

/// Why a folder cannot be locked.
#[derive(Debug)]
pub enum LockError {
    /// Somebody else holds it: who, as far as that is known.
    Taken(String),
    /// The file cannot be made.
    Unwritten(io::Error),
}

impl FolderLock {
    /// Locks `folder`, which is there.
    ///
    /// # Errors
    /// A [`LockError`] where it is locked already or cannot be written.
    pub fn of(folder: &Path) -> Result<Self, LockError> {
        let path = folder.join(LOCK);
        let mut file = open(&path).map_err(LockError::Unwritten)?;
        let locked = match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                sleep(ONCE_MORE);
                file.try_lock()
            }
            locked => locked,
        };
        match locked {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(LockError::Taken(holder(&mut file))),
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {
                return Ok(Self { file: None });
            }
            Err(TryLockError::Error(error)) => return Err(LockError::Unwritten(error)),
        }
        let noted = file
            .set_len(0)
            .and_then(|()| file.write_all(own_name().as_bytes()));
        noted.map_err(LockError::Unwritten)?;
        Ok(Self { file: Some(file) })
    }

    /// Whether somebody holds `folder` now; nothing is written, and nobody who holds it notices.
    /// Where the file system has no locks, nobody does.
    pub fn is_held(folder: &Path) -> bool {
        let file = open_regular(&folder.join(LOCK));
        let shared = file.map(|file| file.try_lock_shared());
        matches!(shared, Ok(Err(TryLockError::WouldBlock)))
    }

    /// Whether the lock keeps others out: some network file systems have none.
    pub fn holds(&self) -> bool {
        self.file.is_some()
    }
}

fn open(path: &Path) -> io::Result<File> {
    check_target(path)?;
    attempt(path)?;
    OpenOptions::new()
        .read(true)
        .write(true)
        .create(true)
        .truncate(false)
        .open(path)
}

/// `process 4711 on boltzmann`.
fn own_name() -> String {
    let process = std::process::id();
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    match host.trim() {
        "" => format!("process {process}"),
        host => format!("process {process} on {host}"),
    }
}

/// Who wrote `file`.
fn holder(file: &mut File) -> String {
    let mut text = String::new();
    let read = file.take(LONGEST).read_to_string(&mut text);
    match (read, text.trim()) {
        (Ok(_), name) if name.starts_with("process ") => name.to_owned(),
        // It is being written this moment, or the system keeps it from being read.
        _ => "another process".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn second_lock_says_who_holds_the_first_until_that_is_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let first = FolderLock::of(folder.path()).unwrap();
        let Err(LockError::Taken(holder)) = FolderLock::of(folder.path()) else {
            panic!("the folder is locked");
        };
        assert!(holder.contains(&std::process::id().to_string()), "{holder}");
        assert!(FolderLock::is_held(folder.path()));
        drop(first);
        assert!(!FolderLock::is_held(folder.path()));
        assert!(FolderLock::of(folder.path()).unwrap().holds());
    }
}
