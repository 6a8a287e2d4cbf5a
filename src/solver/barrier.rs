//! Where workers wait for each other: a barrier that spins.
//!
//! In: the arrivals of a fixed number of workers. Out: nobody goes on before all have arrived. Each
//! worker counts its own arrivals on cache lines of its own, which it alone writes and all others
//! read; so an arrival is one store, and waiting is reading a line that stays in the waiting core's
//! cache until its writer arrives. A store releases what the worker wrote before it, a load that
//! sees it acquires that: what one phase wrote the next one reads.
//!
//! Not here: what the workers may touch between two meetings ([`super::workers`]).

use std::hint::spin_loop;
use std::sync::atomic::{AtomicUsize, Ordering};

/// On cache lines of its own: what one thread writes and others read again and again.
#[derive(Default)]
#[repr(align(128))]
pub struct OwnLine<T>(pub T);

/// Where workers wait for each other.
pub struct Barrier {
    /// How often each worker has arrived.
    arrivals: Box<[OwnLine<AtomicUsize>]>,
}

impl Barrier {
    /// A barrier for `size` workers.
    pub fn new(size: usize) -> Self {
        Self {
            arrivals: (0..size).map(|_| OwnLine::default()).collect(),
        }
    }

    /// Number of workers that meet at it.
    pub fn size(&self) -> usize {
        self.arrivals.len()
    }

    /// Returns when every worker has called it as often as `worker` has.
    #[inline]
    pub fn wait(&self, worker: usize) {
        if self.arrivals.len() == 1 {
            return;
        }
        let own = &self.arrivals[worker].0;
        let round = own.load(Ordering::Relaxed) + 1;
        own.store(round, Ordering::Release);
        for OwnLine(arrival) in &self.arrivals {
            wait_until(|| arrival.load(Ordering::Acquire) >= round);
        }
    }
}

/// Spins, and after a while gives its core to others at every turn, until `done`.
pub fn wait_until(done: impl Fn() -> bool) {
    let mut turns = 0;
    while !done() {
        if turns < PATIENCE {
            turns += 1;
            spin_loop();
        } else {
            std::thread::yield_now();
        }
    }
}

/// Turns of a spinning wait before the core is offered to others at every turn: a few microseconds,
/// longer than workers that have a core each wait, far shorter than a worker without one would
/// take.
pub const PATIENCE: u32 = 64;
