//! The file that keeps a paper's results where its folders may be lost: a line for each case.
//!
//! In: the path of a file, which need not be there, and lines to put into it. Out: its lines, or
//! the number of the one that is wrong and what to do; the file with the new lines, written whole,
//! by the names of their cases, so that a line more is a line more to whoever compares versions.
//! Lines are put in under a lock and read anew then: several programs, and several papers with runs
//! in common, may keep results in one file.

use super::kept_line::{Identity, KeptLine};
use crate::files::{FolderLock, LockError, make_folder, read_whole, write_whole};
use crate::output::OutputError;
use crate::runner::RunnerError;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Largest such file that is read [bytes].
const LARGEST: u64 = 16 << 20;
/// Looks for the lock, and the time between two of them: others hold it for moments.
const LOOKS: usize = 600;
const LOOK_TIME: Duration = Duration::from_millis(50);

/// The lines of a file.
pub struct KeptFile {
    path: PathBuf,
    /// Each with its number in the file, from 1 on; 0 of one that is not there yet.
    lines: Vec<(usize, KeptLine)>,
}

impl KeptFile {
    /// The file at `path`; where there is none, one without lines.
    ///
    /// # Errors
    /// When it cannot be read, or a line is damaged, or two say different things of one case.
    pub fn read(path: &Path) -> Result<Self, RunnerError> {
        let mut file = Self {
            path: path.to_owned(),
            lines: Vec::new(),
        };
        let bytes = match read_whole(path, LARGEST) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(file),
            Err(source) => {
                let path = path.to_owned();
                return Err(OutputError::Read { path, source }.into());
            }
        };
        for (number, bytes) in (1..).zip(bytes.split(|byte| *byte == b'\n')) {
            let text =
                std::str::from_utf8(bytes).map_err(|_| file.damaged(number, "it is no text"))?;
            if text.trim().is_empty() {
                continue;
            }
            let line = KeptLine::read(text.trim());
            file.add(
                number,
                line.map_err(|reason| file.damaged(number, &reason))?,
            )?;
        }
        Ok(file)
    }

    /// Adds what stands at line `number`; the same once more, as when two versions of the file were
    /// joined, is passed over.
    fn add(&mut self, number: usize, line: KeptLine) -> Result<(), RunnerError> {
        if let Some((other, known)) = self.find(&line.identity) {
            if known.state == line.state {
                return Ok(());
            }
            let reason = format!(
                "of {} it states another last state than line {other}, by the same method",
                line.identity.case
            );
            return Err(self.damaged(number, &reason));
        }
        self.lines.push((number, line));
        Ok(())
    }

    /// The line of this `identity`, with its number.
    pub fn find(&self, identity: &Identity) -> Option<&(usize, KeptLine)> {
        let mut lines = self.lines.iter();
        lines.find(|(_, line)| line.identity.is_same_run(identity))
    }

    /// Why lines of the case that `identity` names are not used, if there are any and none is its
    /// own: computed by another method, or with other values.
    pub fn why_unused(&self, identity: &Identity) -> Option<String> {
        let of_case = |line: &&KeptLine| line.identity.case == identity.case;
        let lines = || self.lines.iter().map(|(_, line)| line).filter(of_case);
        let path = self.path.display();
        let of_scene = lines().find(|line| line.identity.scene == identity.scene);
        if let Some(line) = of_scene {
            let method = &line.identity.method;
            return Some(format!(
                "{path} has it computed by another method, {method}"
            ));
        }
        let other = lines().next()?;
        Some(format!(
            "{path} has it computed with other values of its scene (fingerprint {}, here {})",
            other.identity.scene, identity.scene
        ))
    }

    /// That line `number` is damaged, for this `reason`, and what to do.
    pub fn damaged(&self, number: usize, reason: &str) -> RunnerError {
        RunnerError::Input(format!(
            "{}, line {number}: {reason}. Bring the line back from an earlier version of the file, or \
             take it out: its case is then computed again",
            self.path.display()
        ))
    }

    /// Puts `line` in. Of a line that is there already it says whether the state is the same; it
    /// stays as it is unless `replace`.
    fn put(&mut self, line: KeptLine, replace: bool) -> Result<(), RunnerError> {
        let own = self.lines.iter_mut();
        let mut own = own.filter(|(_, known)| known.identity.is_same_run(&line.identity));
        match own.next() {
            Some((_, known)) if replace => *known = line,
            Some((number, known)) if known.state != line.state => {
                return Err(RunnerError::Input(format!(
                    "{}: its folder ends with state {}, and {}, line {number}, states {}, both by \
                     method {}: one of them is not what this program computes. --restart --only {} \
                     computes it anew and replaces both",
                    line.identity.case,
                    line.state,
                    self.path.display(),
                    known.state,
                    line.identity.method,
                    line.identity.case,
                )));
            }
            Some(_) => {}
            None => self.lines.push((0, line)),
        }
        Ok(())
    }

    /// The text of the file, its lines by the names of their cases.
    fn text(&mut self) -> String {
        self.lines.sort_by_cached_key(|(_, line)| {
            let own = line.identity.clone();
            (own.case, own.scene, own.method)
        });
        let lines = self.lines.iter();
        lines.map(|(_, line)| line.text.clone() + "\n").collect()
    }
}

/// Puts these `lines` into the file at `path`; of a run that is in it already the line stays as it
/// is unless `replace`.
///
/// # Errors
/// When the file is damaged, cannot be read or written, or states another last state of a case.
pub fn put(path: &Path, lines: Vec<KeptLine>, replace: bool) -> Result<(), RunnerError> {
    if lines.is_empty() {
        return Ok(());
    }
    let _lock = lock(path)?;
    let mut file = KeptFile::read(path)?;
    let before = file.lines.iter().map(|(_, line)| line.text.clone());
    let before: Vec<String> = before.collect();
    for line in lines {
        file.put(line, replace)?;
    }
    let text = file.text();
    if text.lines().eq(before.iter().map(String::as_str)) {
        return Ok(());
    }
    write_whole(path, |file| file.write_all(text.as_bytes()))
        .map_err(|source| OutputError::write(path, source))?;
    Ok(())
}

/// Keeps other programs from writing to the folder of the file at `path`, waiting for them first.
fn lock(path: &Path) -> Result<FolderLock, RunnerError> {
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let folder = folder.unwrap_or(Path::new("."));
    let failed = |source| OutputError::write(path, source);
    make_folder(folder).map_err(failed)?;
    let mut holder = String::new();
    for _ in 0..LOOKS {
        match FolderLock::of(folder) {
            Ok(lock) => return Ok(lock),
            Err(LockError::Unwritten(source)) => return Err(failed(source).into()),
            Err(LockError::Taken(other)) => holder = other,
        }
        std::thread::sleep(LOOK_TIME);
    }
    Err(RunnerError::System(format!(
        "{} cannot be written: its folder is in use by {holder}; the case is done in its own folder, \
         and the same command keeps it",
        path.display()
    )))
}
