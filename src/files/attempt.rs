//! The one place that every call about a file passes before it is made, so that tests can let the
//! n-th of them fail, and see what is left where the program or the power stops there.
//!
//! In: the path that the call is about, and what was made durable. Out: leave to make it; always,
//! but in tests.

#[cfg(not(test))]
use std::io;
use std::path::Path;

/// Leave to make the next call about `path`.
///
/// # Errors
/// In tests alone, where the call is to fail.
#[cfg(not(test))]
#[expect(clippy::unnecessary_wraps, reason = "in tests it fails")]
#[inline]
pub fn attempt(_path: &Path) -> io::Result<()> {
    Ok(())
}

/// Says that the bytes of the file, or the names in the folder, at `path` survive a power cut.
pub fn became_durable(path: &Path) {
    #[cfg(all(test, unix))]
    super::power_cut::became_durable(path);
    let _ = path;
}

#[cfg(test)]
pub use failing::{FailingCalls, attempt};

#[cfg(test)]
mod failing {
    use std::io::{self, ErrorKind};
    use std::path::{Path, PathBuf};
    use std::sync::{Mutex, PoisonError};

    static PLANS: Mutex<Vec<Plan>> = Mutex::new(Vec::new());

    struct Plan {
        folder: PathBuf,
        calls: u64,
        fails: Box<dyn Fn(u64) -> bool + Send>,
    }

    /// Calls about files below a folder are counted from 0, and those fail that `fails` names,
    /// until this is dropped.
    pub struct FailingCalls {
        folder: PathBuf,
    }

    impl FailingCalls {
        pub fn below(folder: &Path, fails: impl Fn(u64) -> bool + Send + 'static) -> Self {
            let plan = Plan {
                folder: folder.to_owned(),
                calls: 0,
                fails: Box::new(fails),
            };
            plans().push(plan);
            Self {
                folder: folder.to_owned(),
            }
        }

        /// Calls made so far.
        pub fn calls(&self) -> u64 {
            let plans = plans();
            let own = plans.iter().find(|plan| plan.folder == self.folder);
            own.map_or(0, |plan| plan.calls)
        }
    }

    impl Drop for FailingCalls {
        fn drop(&mut self) {
            plans().retain(|plan| plan.folder != self.folder);
        }
    }

    fn plans() -> std::sync::MutexGuard<'static, Vec<Plan>> {
        PLANS.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn attempt(path: &Path) -> io::Result<()> {
        #[cfg(unix)]
        super::super::power_cut::before_call(path);
        for plan in plans().iter_mut() {
            if path.starts_with(&plan.folder) {
                let call = plan.calls;
                plan.calls += 1;
                if (plan.fails)(call) {
                    return Err(ErrorKind::StorageFull.into());
                }
            }
        }
        Ok(())
    }
}
