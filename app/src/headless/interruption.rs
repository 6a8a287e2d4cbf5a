//! Hearing that somebody wants the program to end.
//!
//! In: the system's signals: Ctrl-C, a request to end, a terminal that is closed. Out: a flag,
//! which runs look at between two pieces of work. Signals that whoever started the program has it
//! ignore, as `nohup` does with closed terminals, stay ignored.

use super::terminal::tell;
use grainfall::runner::{RunnerError, exit};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Signals that follow each other sooner are one: tools such as `timeout` send theirs to a process
/// and to its whole group.
const ONE_SIGNAL: Duration = Duration::from_millis(500);

/// Becomes true when somebody asks the program to end; a second time ends it at once.
///
/// # Errors
/// When the system gives no thread to listen on.
pub fn interruption() -> Result<Arc<AtomicBool>, RunnerError> {
    heard(|| tell("stopping: what is computed is being written; once more stops at once"))
}

/// As [`interruption`]; `said` is called at the first time.
///
/// # Errors
/// As [`interruption`].
pub fn heard(said: impl Fn() + Send + 'static) -> Result<Arc<AtomicBool>, RunnerError> {
    let flag = Arc::new(AtomicBool::new(false));
    let shared = flag.clone();
    let mut first = None;
    let ignored = ignored::signals();
    let listening = ctrlc::set_handler(move || {
        let is_first = first.is_none();
        let first: Instant = *first.get_or_insert_with(Instant::now);
        if is_first {
            shared.store(true, Ordering::Relaxed);
            said();
        } else if first.elapsed() > ONE_SIGNAL {
            std::process::exit(exit::INTERRUPTED.into());
        }
    });
    listening.map_err(|error| RunnerError::System(no_thread(&error.to_string())))?;
    ignored::ignore(&ignored);
    Ok(flag)
}

/// Refuses to begin where the system does not give `count` threads more.
///
/// # Errors
/// How many it gives, and what to do.
pub fn check_threads(count: usize) -> Result<(), RunnerError> {
    let release = AtomicBool::new(false);
    let mut begun = 0;
    let failed = std::thread::scope(|scope| {
        let mut failed = None;
        while begun < count && failed.is_none() {
            let wait = || {
                while !release.load(Ordering::Relaxed) {
                    std::thread::park_timeout(Duration::from_millis(1));
                }
            };
            match std::thread::Builder::new().spawn_scoped(scope, wait) {
                Ok(_) => begun += 1,
                Err(error) => failed = Some(error),
            }
        }
        release.store(true, Ordering::Relaxed);
        failed
    });
    failed.map_or(Ok(()), |error| {
        Err(RunnerError::System(format!(
            "{}; it gives {begun} of the {count} that were asked for",
            no_thread(&error.to_string())
        )))
    })
}

fn no_thread(reason: &str) -> String {
    format!(
        "the system gives no thread ({reason}): the limit of this user's processes or of memory is \
         reached. End other programs, raise the limit (`ulimit -u`), or ask for fewer threads"
    )
}

/// The signals that the program was started with being told to ignore.
#[cfg(unix)]
#[expect(
    unsafe_code,
    reason = "the standard library has no way to ask for or to set what a signal does"
)]
mod ignored {
    use std::ffi::c_int;

    /// As POSIX numbers them, on every system alike.
    const HANG_UP: c_int = 1;
    const INTERRUPT: c_int = 2;
    const TERMINATE: c_int = 15;
    /// `SIG_IGN`.
    const IGNORE: usize = 1;

    // SAFETY: C's own declaration; a handler is passed as the address that it is.
    unsafe extern "C" {
        safe fn signal(number: c_int, handler: usize) -> usize;
    }

    /// Those that are ignored now. For a moment all are.
    pub fn signals() -> Vec<c_int> {
        let all = [HANG_UP, INTERRUPT, TERMINATE].into_iter();
        all.filter(|number| {
            let before = signal(*number, IGNORE);
            if before != IGNORE {
                signal(*number, before);
            }
            before == IGNORE
        })
        .collect()
    }

    /// Ignores them again.
    pub fn ignore(signals: &[c_int]) {
        for number in signals {
            signal(*number, IGNORE);
        }
    }
}

#[cfg(not(unix))]
mod ignored {
    pub fn signals() -> Vec<i32> {
        Vec::new()
    }

    pub fn ignore(_signals: &[i32]) {}
}
