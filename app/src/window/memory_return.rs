//! Gives memory that is free back to the system, while a window is open.
//!
//! In: wall-clock time. Out: nothing; less memory of this program.
//!
//! The GNU C library keeps what a thread allocated and freed in the lists of that thread's arena,
//! also when the thread has ended: every run has threads of its own, so that a window that opens
//! run after run would hold what each of them left. Other allocators give back by themselves.

use bevy::prelude::{App, IntoScheduleConfigs, Plugin, Update};
use bevy::tasks::IoTaskPool;
use bevy::time::common_conditions::on_real_timer;
use std::time::Duration;

/// Wall-clock time from one time to the next. Looking through the free lists takes some
/// milliseconds, and what is used again at once must be had from the system anew.
const INTERVAL: Duration = Duration::from_secs(30);

/// Gives back.
pub(super) struct MemoryReturnPlugin;

impl Plugin for MemoryReturnPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Update, begin.run_if(on_real_timer(INTERVAL)));
    }
}

/// No frame waits for it.
fn begin() {
    IoTaskPool::get().spawn(async { give_back() }).detach();
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[expect(
    unsafe_code,
    reason = "the standard library has no way to have free memory given back"
)]
fn give_back() {
    use std::ffi::c_int;

    // SAFETY: the GNU C library's own declaration; it may be called at any time, by any thread.
    unsafe extern "C" {
        safe fn malloc_trim(pad: usize) -> c_int;
    }

    malloc_trim(0);
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn give_back() {}

#[cfg(all(test, target_os = "linux", target_env = "gnu"))]
mod tests {
    use super::give_back;
    use grainfall::run::resident_memory;

    #[test]
    fn what_a_thread_that_has_ended_had_freed_goes_back_to_the_system() {
        const PIECE: usize = 4000;
        const PIECES: usize = 1 << 16;
        // A few stay in use, between all that is free.
        let thread = std::thread::spawn(|| {
            let pieces: Vec<Vec<u8>> = (0..PIECES).map(|_| vec![1; PIECE]).collect();
            pieces.into_iter().step_by(1000).collect::<Vec<_>>()
        });
        let left = thread.join().unwrap();
        let held = resident_memory().unwrap();
        give_back();
        let after = resident_memory().unwrap();
        // Other tests allocate meanwhile.
        let returned = held.saturating_sub(after);
        assert!(
            returned > (PIECE * PIECES / 2) as u64,
            "{returned} bytes of {held}"
        );
        assert_eq!(left.len(), PIECES.div_ceil(1000));
    }
}
