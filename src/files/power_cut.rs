//! What is left of a folder when the program or the power stops, at any call about a file; for
//! tests.
//!
//! In: each call before it is made, and what was made durable. Out: every folder that may be left
//! ([`PowerCuts::left`]). A program that stops leaves all that it did. A power cut leaves those
//! bytes of a file that were made durable, and of the names in a folder all, or those that were.
//! File systems keep more than that; POSIX promises no more.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

static WATCHED: Mutex<Vec<Disk>> = Mutex::new(Vec::new());

/// The bytes of each file below a folder, by its path from there; each folder with none.
pub type Left = BTreeMap<PathBuf, Option<Vec<u8>>>;

/// What stops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stop {
    /// The program: what it did stays.
    Program,
    /// The power: what was not made durable may go.
    Power,
}

/// What may be left of a folder is noted until this is dropped.
pub struct PowerCuts {
    folder: PathBuf,
}

/// What is known of the files below a folder.
struct Disk {
    folder: PathBuf,
    /// The files that are there, by the numbers that the system gives them.
    files: HashMap<u64, Durable>,
    /// The durable names.
    names: Names,
    left: BTreeSet<(Stop, Left)>,
}

/// The durable bytes of a file, whatever it is called.
type Durable = Arc<Mutex<Vec<u8>>>;
/// What is in each folder, by whole paths: files, and folders as none.
type Names = BTreeMap<PathBuf, BTreeMap<PathBuf, Option<Durable>>>;

impl PowerCuts {
    /// Notes what may be left of `folder`; what is in it now is durable.
    pub fn of(folder: &Path) -> Self {
        let mut disk = Disk {
            folder: folder.to_owned(),
            files: HashMap::new(),
            names: Names::new(),
            left: BTreeSet::new(),
        };
        disk.names = disk.look();
        for (path, file) in disk.names.values().flatten() {
            if let Some(file) = file {
                *locked(file) = fs::read(path).unwrap();
            }
        }
        locked(&WATCHED).push(disk);
        Self {
            folder: folder.to_owned(),
        }
    }

    /// All that may have been left until now.
    pub fn left(&self) -> BTreeSet<(Stop, Left)> {
        self.ask(|disk| {
            disk.note();
            disk.left.clone()
        })
    }

    /// What is there now, and what of it is durable.
    pub fn now(&self) -> [Left; 2] {
        self.ask(|disk| {
            let there = disk.look();
            [
                disk.left_of(&there, |path, _| fs::read(path).unwrap()),
                disk.left_of(&disk.names, |_, durable| durable.clone()),
            ]
        })
    }

    fn ask<T>(&self, ask: impl FnOnce(&mut Disk) -> T) -> T {
        let mut watched = locked(&WATCHED);
        let own = watched.iter_mut().find(|disk| disk.folder == self.folder);
        ask(own.unwrap())
    }
}

impl Drop for PowerCuts {
    fn drop(&mut self) {
        locked(&WATCHED).retain(|disk| disk.folder != self.folder);
    }
}

/// Notes that a call about `path` comes next.
pub fn before_call(path: &Path) {
    let mut watched = locked(&WATCHED);
    let concerned = |disk: &&mut Disk| path.starts_with(&disk.folder);
    watched.iter_mut().filter(concerned).for_each(Disk::note);
}

/// Notes that the bytes of the file, or the names in the folder, at `path` are durable from now on.
pub fn became_durable(path: &Path) {
    let mut watched = locked(&WATCHED);
    for disk in watched
        .iter_mut()
        .filter(|disk| path.starts_with(&disk.folder))
    {
        let mut there = disk.look();
        if let Some(names) = there.remove(path) {
            disk.names.insert(path.to_owned(), names);
        } else {
            let file = disk.files.entry(number_of(path)).or_default();
            *locked(file) = fs::read(path).unwrap();
        }
    }
}

impl Disk {
    /// What is there now.
    fn look(&mut self) -> Names {
        let (mut there, mut files) = (Names::new(), HashMap::new());
        let mut folders = vec![self.folder.clone()];
        while let Some(folder) = folders.pop() {
            let mut names = BTreeMap::new();
            for entry in fs::read_dir(&folder).unwrap() {
                let path = entry.unwrap().path();
                let file = if path.is_dir() {
                    folders.push(path.clone());
                    None
                } else {
                    let known = self
                        .files
                        .get(&number_of(&path))
                        .cloned()
                        .unwrap_or_default();
                    files.insert(number_of(&path), known.clone());
                    Some(known)
                };
                names.insert(path, file);
            }
            there.insert(folder, names);
        }
        // A number is given anew once its file is gone.
        self.files = files;
        there
    }

    /// Notes what may be left now.
    fn note(&mut self) {
        let there = self.look();
        let stopped = self.left_of(&there, |path, _| fs::read(path).unwrap());
        let cut = [&there, &self.names].map(|names| self.left_of(names, |_, own| own.clone()));
        self.left.insert((Stop::Program, stopped));
        self.left.extend(cut.map(|left| (Stop::Power, left)));
    }

    /// What is left by these `names`, with such `bytes` of each file.
    fn left_of(&self, names: &Names, bytes: impl Fn(&Path, &Vec<u8>) -> Vec<u8>) -> Left {
        let mut left = Left::new();
        let mut folders = vec![&self.folder];
        while let Some(folder) = folders.pop() {
            for (path, file) in names.get(folder).into_iter().flatten() {
                let short = path.strip_prefix(&self.folder).unwrap().to_owned();
                let bytes = file.as_ref().map(|file| bytes(path, &locked(file)));
                left.insert(short, bytes);
                if file.is_none() {
                    folders.push(path);
                }
            }
        }
        left
    }
}

fn number_of(path: &Path) -> u64 {
    fs::symlink_metadata(path).unwrap().ino()
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}
