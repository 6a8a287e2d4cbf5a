//! Threads that march in step.
//!
//! A step has two phases, each a few microseconds long for a small bed: too short for a task queue. The team's members
//! run the whole stretch of steps each, on their own ranges, and meet at a spinning barrier between phases.

use std::cell::UnsafeCell;
use std::hint::spin_loop;
use std::marker::PhantomData;
use std::ops::Range;
use std::ptr::NonNull;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Threads for one solver, never the global pool.
pub struct Team {
    board: Arc<Board>,
    threads: Vec<JoinHandle<()>>,
}

/// Work for the members, by number.
type Job = dyn Fn(usize) + Sync;

/// Where the members find their work.
struct Board {
    /// What to do in the present round; valid until every thread has finished that round.
    job: UnsafeCell<Option<NonNull<Job>>>,
    /// How many pieces of work there have been.
    round: OwnLine<AtomicUsize>,
    /// The last round that each thread has finished.
    finished: Box<[OwnLine<AtomicUsize>]>,
    dismissed: AtomicBool,
}

/// On cache lines of its own: what one thread writes and others read again and again.
#[derive(Default)]
#[repr(align(128))]
struct OwnLine<T>(T);

#[expect(
    unsafe_code,
    reason = "a job is lent to the threads for one round, and `Team::run` outlives the round"
)]
// SAFETY: `job` is written only between rounds, by the one caller of `Team::run`, and read only within one.
unsafe impl Sync for Board {}
#[expect(unsafe_code, reason = "see above")]
// SAFETY: likewise; the job itself is `Sync`.
unsafe impl Send for Board {}

impl Team {
    /// A team of `size` members, at least one; as many as the system gives.
    pub fn new(size: usize) -> Self {
        let board = Arc::new(Board {
            job: UnsafeCell::new(None),
            round: OwnLine::default(),
            finished: (1..size).map(|_| OwnLine::default()).collect(),
            dismissed: AtomicBool::new(false),
        });
        let threads = (1..size)
            .map_while(|member| {
                let board = Arc::clone(&board);
                std::thread::Builder::new()
                    .name(format!("solver {member}"))
                    .spawn(move || board.serve(member))
                    .ok()
            })
            .collect();
        Self { board, threads }
    }

    /// Number of members: the threads and whoever calls [`Team::run`].
    pub fn size(&self) -> usize {
        self.threads.len() + 1
    }

    /// Runs `work(member)` on every member at once and returns when all are done. A panic in it ends the program: the other
    /// members would wait for ever.
    #[expect(unsafe_code, reason = "see `Board`")]
    pub fn run<'a>(&mut self, work: impl Fn(usize) + Sync + 'a) {
        if self.threads.is_empty() {
            return work(0);
        }
        let job: NonNull<dyn Fn(usize) + Sync + 'a> = NonNull::from(&work);
        // SAFETY: only the lifetime changes; `work` goes out of scope after every thread has finished the round.
        let job =
            unsafe { std::mem::transmute::<NonNull<dyn Fn(usize) + Sync + 'a>, NonNull<Job>>(job) };
        // SAFETY: no round is under way: `self` is borrowed mutably, and the last call waited for its own.
        unsafe { *self.board.job.get() = Some(job) };
        self.board.round.0.fetch_add(1, Ordering::Release);
        self.threads
            .iter()
            .for_each(|thread| thread.thread().unpark());
        work_or_abort(&work, 0);
        let round = self.board.round.0.load(Ordering::Relaxed);
        for OwnLine(finished) in &self.board.finished[..self.threads.len()] {
            wait_until(|| finished.load(Ordering::Acquire) == round);
        }
    }
}

/// Does a member's work; a panic ends the program.
fn work_or_abort(work: &(dyn Fn(usize) + Sync), member: usize) {
    struct Abort;
    impl Drop for Abort {
        fn drop(&mut self) {
            std::process::abort();
        }
    }
    let abort = Abort;
    work(member);
    std::mem::forget(abort);
}

impl Drop for Team {
    fn drop(&mut self) {
        self.board.dismissed.store(true, Ordering::Release);
        for thread in self.threads.drain(..) {
            thread.thread().unpark();
            // It has nothing to say: a panic in its work was passed on by `run`.
            let _ = thread.join();
        }
    }
}

impl Board {
    /// A thread's life: work when there is some, a wide-awake wait for more, then sleep.
    #[expect(unsafe_code, reason = "see `Board`")]
    fn serve(&self, member: usize) {
        let mut round = 0;
        while self.next_round(round) {
            round += 1;
            // SAFETY: `run` wrote the job before this round began and keeps it alive until it is finished.
            if let Some(work) = unsafe { (*self.job.get()).map(|job| job.as_ref()) } {
                work_or_abort(work, member);
            }
            self.finished[member - 1].0.store(round, Ordering::Release);
        }
    }

    /// Returns when there is another round than `round`, or false when there will be none.
    fn next_round(&self, round: usize) -> bool {
        let asleep_after = Instant::now() + WAKEFULNESS;
        loop {
            if self.dismissed.load(Ordering::Acquire) {
                return false;
            }
            for _ in 0..PATIENCE {
                if self.round.0.load(Ordering::Acquire) != round {
                    return true;
                }
                spin_loop();
            }
            if Instant::now() < asleep_after {
                std::thread::yield_now();
            } else {
                std::thread::park();
            }
        }
    }
}

/// Spins, and after a while gives its core to others at every turn, until `done`.
fn wait_until(done: impl Fn() -> bool) {
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

/// Turns of a spinning wait before the core is offered to others at every turn: a few microseconds, longer than members
/// that have a core each wait, far shorter than a member without one would take.
const PATIENCE: u32 = 64;

/// How long a thread without work stays awake: longer than lists take to build, so that it is there for the next stretch.
const WAKEFULNESS: Duration = Duration::from_micros(300);

/// The part of `count` items that is `member`'s, of `size` members.
pub fn share(count: usize, member: usize, size: usize) -> Range<usize> {
    count * member / size..count * (member + 1) / size
}

/// Where a team's members wait for each other.
pub struct Barrier {
    /// How often each member has arrived.
    arrivals: Box<[OwnLine<AtomicUsize>]>,
}

impl Barrier {
    /// A barrier for `size` members.
    pub fn new(size: usize) -> Self {
        Self {
            arrivals: (0..size).map(|_| OwnLine::default()).collect(),
        }
    }

    /// Returns when every member has called it as often as `member` has.
    pub fn wait(&self, member: usize) {
        if self.arrivals.len() == 1 {
            return;
        }
        let own = &self.arrivals[member].0;
        let round = own.load(Ordering::Relaxed) + 1;
        own.store(round, Ordering::Release);
        for OwnLine(arrival) in &self.arrivals {
            wait_until(|| arrival.load(Ordering::Acquire) >= round);
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
