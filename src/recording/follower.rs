//! Follows a run under way: takes up what it writes.
//!
//! In: a recording whose run is not over, and wall-clock time that passes. Out: the recording with
//! the states and samples that came, and whether the run goes on. Files are only read, and only
//! where they have changed; what is half written is looked at again. Looking takes a twentieth of
//! the time at most.

use super::recorded_run::Recording;
use super::stated::RunProgress;
use crate::files::FolderLock;
use crate::output::{LISTS, SERIES, SUMMARY};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant, SystemTime};

/// Least time between two looks.
const LOOK_TIME: Duration = Duration::from_secs(1);
/// Most of the time that looking may take, as one part in so many.
const SHARE_OF_TIME: u32 = 20;

/// Looks after which a run that was begun anew in the folder is given up.
const MOST_FAILURES: u32 = 60;

/// How a file is known to be the one that was read: its length and when it was written.
type Mark = Option<(u64, SystemTime)>;

/// Follows a run under way.
pub struct Follower {
    summary: Mark,
    growing: Vec<Mark>,
    /// Looks at which another summary was there and no states.
    failures: u32,
    /// Wall-clock time since the last look.
    waited: Duration,
    /// Wall-clock time from one look to the next.
    pause: Duration,
}

/// What has become of a run since it was last looked at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RunNews {
    /// States or samples were added.
    Grown,
    /// It was begun, gone on with or ended: all of it was read anew.
    ReadAnew,
    /// Its program ended without finishing it, or it is computed again.
    Progress,
    /// It can be followed no longer, for the reason given.
    Lost(String),
}

impl Follower {
    /// Follows the run of `recording`; none where that is over.
    pub fn of(recording: &Recording) -> Option<Self> {
        (recording.progress() != RunProgress::Over).then(|| Self {
            summary: mark(&recording.folder().join(SUMMARY)),
            growing: Vec::new(),
            failures: 0,
            waited: Duration::ZERO,
            pause: LOOK_TIME,
        })
    }

    /// Lets `passed` wall-clock time pass; where a look is due, takes up into `recording` what is
    /// new.
    pub fn tick(&mut self, passed: Duration, recording: &mut Recording) -> Option<RunNews> {
        self.waited += passed;
        if self.waited < self.pause {
            return None;
        }
        self.waited = Duration::ZERO;
        let started = Instant::now();
        let news = self.look(recording);
        self.pause = LOOK_TIME.max(SHARE_OF_TIME * started.elapsed());
        news
    }

    fn look(&mut self, recording: &mut Recording) -> Option<RunNews> {
        let folder = recording.folder().to_owned();
        // Asked first: who ends a run writes its summary, then lets the folder go.
        let is_held = FolderLock::is_held(&folder);
        let summary = mark(&folder.join(SUMMARY));
        if summary != self.summary {
            return self.read_anew(summary, recording);
        }
        let files = LISTS.into_iter().chain([SERIES]);
        let growing: Vec<Mark> = files.map(|name| mark(&folder.join(name))).collect();
        if growing != self.growing {
            match recording.grow() {
                Ok(true) => {
                    self.growing = growing;
                    return Some(RunNews::Grown);
                }
                Ok(false) => self.growing = growing,
                // A list that is being written this moment is whole at the next look.
                Err(_) => {}
            }
        }
        let progress = if is_held {
            RunProgress::UnderWay
        } else {
            RunProgress::Stopped
        };
        let is_new = progress != recording.progress();
        recording.set_progress(progress);
        is_new.then_some(RunNews::Progress)
    }

    /// The summary is another: the run has ended, or is gone on with.
    fn read_anew(&mut self, summary: Mark, recording: &mut Recording) -> Option<RunNews> {
        match recording.again() {
            Ok(again) => {
                *recording = again;
                (self.summary, self.growing, self.failures) = (summary, Vec::new(), 0);
                Some(RunNews::ReadAnew)
            }
            // It was begun anew, and has not come to its first state yet, or it is another run.
            Err(error) => {
                self.failures += 1;
                (self.failures > MOST_FAILURES).then(|| RunNews::Lost(error.to_string()))
            }
        }
    }
}

/// How the file at `path` is known.
fn mark(path: &Path) -> Mark {
    let found = fs::metadata(path).ok()?;
    Some((found.len(), found.modified().ok()?))
}
