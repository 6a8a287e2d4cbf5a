//! The system's allocator, counting: for tests and benchmarks, of which each is a binary of its own.

#![allow(dead_code, reason = "each binary asks for a part of what is counted")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Bytes that are allocated now.
static IN_USE: AtomicUsize = AtomicUsize::new(0);
/// The most since it was last set.
static PEAK: AtomicUsize = AtomicUsize::new(0);

/// How often anything was allocated.
static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);
/// How many bytes were, in all.
static ALLOCATED: AtomicUsize = AtomicUsize::new(0);

struct Counting;

#[expect(unsafe_code, reason = "an allocator that counts is an unsafe trait")]
// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = IN_USE.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        PEAK.fetch_max(now, Ordering::Relaxed);
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        ALLOCATED.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        IN_USE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Bytes that are allocated now.
pub fn in_use() -> usize {
    IN_USE.load(Ordering::Relaxed)
}

/// How often anything was allocated so far, and how many bytes in all.
pub fn allocated() -> [usize; 2] {
    [&ALLOCATIONS, &ALLOCATED].map(|count| count.load(Ordering::Relaxed))
}

/// What `work` returns, and the most bytes that were allocated at once meanwhile.
pub fn with_peak<T>(work: impl FnOnce() -> T) -> (T, usize) {
    PEAK.store(in_use(), Ordering::Relaxed);
    let done = work();
    (done, PEAK.load(Ordering::Relaxed))
}
