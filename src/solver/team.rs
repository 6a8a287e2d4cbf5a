//! Threads that march in step.
//!
//! A step has two phases, each a few microseconds long for a small bed: too short for a task queue. The team's members
//! run the whole stretch of steps each, on their own ranges, and meet at a spinning barrier between phases.

use std::hint::spin_loop;
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Threads for one solver, never the global pool.
pub struct Team {
    pool: Option<rayon::ThreadPool>,
    size: usize,
}

impl Team {
    /// A team of `size` members, at least one; as many as the system gives.
    pub fn new(size: usize) -> Self {
        let size = size.max(1);
        let pool = (size > 1)
            .then(|| {
                rayon::ThreadPoolBuilder::new()
                    .num_threads(size)
                    .thread_name(|i| format!("solver {i}"))
                    .build()
            })
            .and_then(Result::ok);
        Self {
            size: if pool.is_some() { size } else { 1 },
            pool,
        }
    }

    /// Number of members.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Runs `work(member)` on every member at once and returns when all are done.
    pub fn run(&self, work: impl Fn(usize) + Sync) {
        match &self.pool {
            Some(pool) => {
                pool.broadcast(|context| work(context.index()));
            }
            None => work(0),
        }
    }
}

/// The part of `count` items that is `member`'s, of `size` members.
pub fn share(count: usize, member: usize, size: usize) -> Range<usize> {
    count * member / size..count * (member + 1) / size
}

/// Where a team's members wait for each other.
pub struct Barrier {
    size: usize,
    waiting: AtomicUsize,
    round: AtomicUsize,
}

impl Barrier {
    /// A barrier for `size` members.
    pub fn new(size: usize) -> Self {
        Self {
            size,
            waiting: AtomicUsize::new(0),
            round: AtomicUsize::new(0),
        }
    }

    /// Returns when every member has called it.
    pub fn wait(&self) {
        if self.size == 1 {
            return;
        }
        let round = self.round.load(Ordering::Acquire);
        if self.waiting.fetch_add(1, Ordering::AcqRel) + 1 == self.size {
            self.waiting.store(0, Ordering::Relaxed);
            self.round.store(round + 1, Ordering::Release);
            return;
        }
        let mut spins = 0_u32;
        while self.round.load(Ordering::Acquire) == round {
            spins += 1;
            // A member that has lost its core would otherwise be waited for at full heat.
            if spins.is_multiple_of(4096) {
                std::thread::yield_now();
            } else {
                spin_loop();
            }
        }
    }
}

/// A slice that members write in ranges of their own during one phase and read whole in the next.
pub struct Shared<'a, T> {
    start: *mut T,
    len: usize,
    slice: PhantomData<&'a mut [T]>,
}

#[expect(
    unsafe_code,
    reason = "members touch disjoint ranges, see the contracts of `range_mut` and `all`"
)]
// SAFETY: sharing hands out `&T` and `&mut T` across threads under those contracts; both need no more than `T: Send + Sync`.
unsafe impl<T: Send + Sync> Sync for Shared<'_, T> {}

#[expect(
    unsafe_code,
    reason = "two barriers a step are all that a phase can afford; locks and atomics per row are not"
)]
impl<'a, T> Shared<'a, T> {
    /// Lends `slice` to a team.
    pub fn new(slice: &'a mut [T]) -> Self {
        Self {
            start: slice.as_mut_ptr(),
            len: slice.len(),
            slice: PhantomData,
        }
    }

    /// The caller's own range.
    ///
    /// # Safety
    /// Until the next barrier no other member may call `all`, nor `range_mut` with a range that meets this one.
    #[expect(
        clippy::mut_from_ref,
        reason = "the contract replaces the borrow checker between two barriers"
    )]
    pub unsafe fn range_mut(&self, range: Range<usize>) -> &mut [T] {
        assert!(
            range.start <= range.end && range.end <= self.len,
            "a member's range lies within the slice"
        );
        // SAFETY: in bounds by the assertion, unaliased by the caller's promise.
        unsafe { std::slice::from_raw_parts_mut(self.start.add(range.start), range.len()) }
    }

    /// The whole slice.
    ///
    /// # Safety
    /// Until the next barrier no member may call `range_mut`.
    pub unsafe fn all(&self) -> &[T] {
        // SAFETY: the slice given to `new`, not written by the caller's promise.
        unsafe { std::slice::from_raw_parts(self.start, self.len) }
    }
}
