//! The solver's threads: a pool of workers, the phases in which they work, and the memory they
//! write side by side.
//!
//! In: a share of the work for each worker. Out: what each of them returns. Every `unsafe` of the
//! solver but that of the lanes is in this file; what it hands out is safe to use in any way that
//! compiles.
//!
//! # Threading model
//!
//! Phases alternate, each a few microseconds long for a small bed: too short for a task queue.
//! Every worker runs a whole [`Batch`] of steps, on ranges of its own, and all meet at a spinning
//! barrier after each phase. Of polyhedra a step has two phases:
//!
//! | phase | every worker reads all of | each worker writes its own ranges of |
//! |---|---|---|
//! | [`ForcePhase`] | bodies, vertices and planes of faces | what pairs do to their sides |
//! | [`MotionPhase`] | what pairs do to their sides | bodies, vertices and planes of faces |
//!
//! Of spheres each phase is a step: in one every worker reads the first copy of bodies and films and
//! writes its own of the second, in the other it goes back.
//!
//! Between batches the caller goes on alone, but for what of a large bed is worth sharing: lists that
//! are made anew, the way from a world's columns to rows and back. [`WorkerPool::map`] gives each
//! worker a share of it to own, and puts what comes of them one behind the other: ordinary borrows,
//! and the same whatever the number of workers.
//!
//! What only one worker ever touches (springs, bridges, lists of features, sums of forces) is cut
//! into ranges by [`super::ranges::split`] and is an ordinary `&mut` slice. What one phase writes
//! and the other reads is a [`Column`], of which each worker holds the part that is its own.
//!
//! Why that is sound: the parts of a column are disjoint, which is checked when the batch is
//! prepared. A worker gets at a column only with an [`InPhase`], the proof that all workers of the
//! batch are in one phase: `&mut` to its own ranges with the proof of the phase that writes them,
//! `&` to all with the proof of the other phase. Proofs are made at the start of a batch, one for
//! each worker, and [`InPhase::meet`] turns one into that of the next phase after all workers have
//! given theirs up; what was borrowed with it has ended by then, and the barrier's release and
//! acquire make what was written visible. A proof neither leaves its thread nor outlives the batch,
//! and it opens only columns of its own batch, which is checked at each use.

use super::barrier::{Barrier, OwnLine, PATIENCE, wait_until};
use super::ranges::{in_order, range_of};
use std::cell::UnsafeCell;
use std::hint::spin_loop;
use std::marker::PhantomData;
use std::ops::Range;
use std::ptr::NonNull;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Threads for one solver, never the global pool.
pub struct WorkerPool {
    /// Where they find their work.
    board: Arc<Board>,
    threads: Vec<JoinHandle<()>>,
}

/// Fewer grains or pairs than this are gone through before other workers are awake.
const WORTH_SHARING: usize = 4096;

/// Work for the workers, by number.
type RoundWork = dyn Fn(usize) + Sync;

/// Where the workers find their work.
struct Board {
    /// What to do in the present round; valid until every thread has finished that round.
    job: UnsafeCell<Option<NonNull<RoundWork>>>,
    /// How many pieces of work there have been.
    round: OwnLine<AtomicUsize>,
    /// The last round that each thread has finished.
    finished: Box<[OwnLine<AtomicUsize>]>,
    dismissed: AtomicBool,
}

#[expect(
    unsafe_code,
    reason = "a job is lent to the threads for one round, and `WorkerPool::run_job` outlives the round"
)]
// SAFETY: `job` is written only between rounds, by the one caller of `run_job`, and read only
// within one.
unsafe impl Sync for Board {}
#[expect(unsafe_code, reason = "see above")]
// SAFETY: likewise; the job itself is `Sync`.
unsafe impl Send for Board {}

impl WorkerPool {
    /// A pool of `size` workers, at least one; as many as the system gives.
    pub fn new(size: usize) -> Self {
        let board = Arc::new(Board {
            job: UnsafeCell::new(None),
            round: OwnLine::default(),
            finished: (1..size).map(|_| OwnLine::default()).collect(),
            dismissed: AtomicBool::new(false),
        });
        let threads = (1..size)
            .map_while(|worker| {
                let board = Arc::clone(&board);
                std::thread::Builder::new()
                    .name(format!("solver {worker}"))
                    .spawn(move || board.serve(worker))
                    .ok()
            })
            .collect();
        Self { board, threads }
    }

    /// Number of workers: the threads and whoever calls [`WorkerPool::run`].
    pub fn size(&self) -> usize {
        self.threads.len() + 1
    }

    /// Runs `work` on every worker at once, each with the share of its number and the proof that
    /// all begin in the force phase, and returns what they return when all are done. A panic in it
    /// ends the program: the other workers would wait for ever.
    ///
    /// # Panics
    /// When `batch` or `shares` are for another number of workers, or the batch is under way.
    pub fn run<S: Send, R: Send>(
        &mut self,
        batch: &Batch,
        shares: Vec<S>,
        work: impl Fn(S, InPhase<'_, ForcePhase>) -> R + Sync,
    ) -> Vec<R> {
        let size = self.size();
        assert!(
            batch.size() == size && shares.len() == size,
            "one share for each worker"
        );
        let under_way = batch.under_way.swap(true, Ordering::Acquire);
        assert!(!under_way, "a batch runs once at a time");
        let results = self.hand_out(shares, |worker, share| {
            work(share, InPhase::begin(batch, worker))
        });
        batch.under_way.store(false, Ordering::Release);
        results
    }

    /// Cuts `count` things, of which `together` at a time stay together, into ranges to be worked on at
    /// once: into one where there are too few to be worth it.
    pub fn ranges(&self, count: usize, together: usize) -> Vec<Range<usize>> {
        let size = if count < WORTH_SHARING {
            1
        } else {
            self.size()
        };
        let pieces = count.div_ceil(together);
        let range = |worker| {
            let range = range_of(pieces, worker, size);
            (together * range.start).min(count)..(together * range.end).min(count)
        };
        (0..size).map(range).collect()
    }

    /// Runs `work` on each of the `shares`, by as many workers as there are of them, and returns what
    /// comes of each, in their order. A single one is worked on by the caller.
    ///
    /// # Panics
    /// When there are more shares than workers.
    pub fn map<S: Send, R: Send>(
        &mut self,
        shares: Vec<S>,
        work: impl Fn(S) -> R + Sync,
    ) -> Vec<R> {
        assert!(shares.len() <= self.size(), "a worker for each share");
        if shares.len() <= 1 {
            return shares.into_iter().map(work).collect();
        }
        self.hand_out(shares, |_, share| work(share))
    }

    /// Runs `work(worker, share)` with each worker's share, where it has one.
    fn hand_out<S: Send, R: Send>(
        &mut self,
        shares: Vec<S>,
        work: impl Fn(usize, S) -> R + Sync,
    ) -> Vec<R> {
        let slot = |share| Mutex::new((Some(share), None));
        let slots: Vec<Mutex<(Option<S>, Option<R>)>> = shares.into_iter().map(slot).collect();
        self.run_job(|worker| {
            let share = slots
                .get(worker)
                .and_then(|slot| slot.lock().ok()?.0.take());
            if let Some(share) = share {
                let result = work(worker, share);
                if let Ok(mut slot) = slots[worker].lock() {
                    slot.1 = Some(result);
                }
            }
        });
        let results = slots.into_iter().filter_map(|slot| {
            let (_, result) = slot.into_inner().unwrap_or_else(PoisonError::into_inner);
            result
        });
        results.collect()
    }

    /// Runs `work(worker)` on every worker at once and returns when all are done.
    #[expect(unsafe_code, reason = "see `Board`")]
    fn run_job<'a>(&mut self, work: impl Fn(usize) + Sync + 'a) {
        if self.threads.is_empty() {
            return work(0);
        }
        let job: NonNull<dyn Fn(usize) + Sync + 'a> = NonNull::from(&work);
        // SAFETY: only the lifetime changes; `work` goes out of scope after every thread has
        // finished the round.
        let job = unsafe {
            std::mem::transmute::<NonNull<dyn Fn(usize) + Sync + 'a>, NonNull<RoundWork>>(job)
        };
        // SAFETY: no round is under way: `self` is borrowed mutably, and the last call waited for
        // its own.
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

/// Does a worker's work; a panic ends the program.
fn work_or_abort(work: &(dyn Fn(usize) + Sync), worker: usize) {
    struct Abort;
    impl Drop for Abort {
        fn drop(&mut self) {
            std::process::abort();
        }
    }
    let abort = Abort;
    work(worker);
    std::mem::forget(abort);
}

impl Drop for WorkerPool {
    fn drop(&mut self) {
        self.board.dismissed.store(true, Ordering::Release);
        for thread in self.threads.drain(..) {
            thread.thread().unpark();
            // It has nothing to say: a panic in its work has ended the program.
            let _ = thread.join();
        }
    }
}

impl Board {
    /// A thread's life: work when there is some, a wide-awake wait for more, then sleep.
    #[expect(unsafe_code, reason = "see `Board`")]
    fn serve(&self, worker: usize) {
        let mut round = 0;
        while self.next_round(round) {
            round += 1;
            // SAFETY: `run_job` wrote the job before this round began and keeps it alive until it
            // is finished.
            if let Some(work) = unsafe { (*self.job.get()).map(|job| job.as_ref()) } {
                work_or_abort(work, worker);
            }
            self.finished[worker - 1].0.store(round, Ordering::Release);
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

/// How long a thread without work stays awake: longer than lists take to build, so that it is there
/// for the next batch.
const WAKEFULNESS: Duration = Duration::from_micros(300);

/// Steps that a pool's workers take together, from one meeting to the next.
pub struct Batch {
    barrier: Barrier,
    under_way: AtomicBool,
}

impl Batch {
    /// A batch for `size` workers.
    pub fn new(size: usize) -> Self {
        Self {
            barrier: Barrier::new(size),
            under_way: AtomicBool::new(false),
        }
    }

    /// Number of its workers.
    pub fn size(&self) -> usize {
        self.barrier.size()
    }

    /// Lends `column`, which phase `P` writes and the other reads, to the workers: to each the part
    /// that consists of its own of the `ranges`, given worker by worker.
    ///
    /// # Panics
    /// When ranges overlap or do not lie within the column.
    pub fn lend<'a, T, P: Phase>(
        &'a self,
        column: &'a mut [T],
        ranges: impl IntoIterator<Item = Vec<Range<usize>>>,
    ) -> Vec<Column<'a, T, P>> {
        let ranges: Vec<Vec<Range<usize>>> = ranges.into_iter().collect();
        let mut end = 0;
        for (range, _) in in_order(&ranges) {
            assert!(
                end <= range.start && range.start <= range.end && range.end <= column.len(),
                "workers' ranges are disjoint"
            );
            end = range.end;
        }
        let (start, len) = (NonNull::from(&mut *column).cast(), column.len());
        let lent = ranges.into_iter().map(|own| Column {
            start,
            len,
            own,
            batch: self,
            marker: PhantomData,
        });
        lent.collect()
    }
}

impl Batch {
    /// Lends `column` to workers of which each has one range: see [`Batch::lend`].
    pub fn lend_ranges<'a, T, P: Phase>(
        &'a self,
        column: &'a mut [T],
        ranges: impl Iterator<Item = Range<usize>>,
    ) -> impl Iterator<Item = Column<'a, T, P>> {
        self.lend(column, ranges.map(|range| vec![range]))
            .into_iter()
    }
}

/// A phase of a step.
pub trait Phase {
    /// The other one.
    type Other: Phase;
}

/// The phase in which workers compute forces pair by pair.
pub enum ForcePhase {}

/// The phase in which workers sum the forces on each grain and move it.
pub enum MotionPhase {}

impl Phase for ForcePhase {
    type Other = MotionPhase;
}

impl Phase for MotionPhase {
    type Other = ForcePhase;
}

/// Proof that all workers of a batch are in phase `P`.
pub struct InPhase<'a, P> {
    batch: &'a Batch,
    worker: usize,
    /// It stays on its worker's thread.
    marker: PhantomData<(P, *const ())>,
}

impl<'a, P: Phase> InPhase<'a, P> {
    /// Only the start of a batch and [`InPhase::meet`] make proofs.
    fn begin(batch: &'a Batch, worker: usize) -> Self {
        Self {
            batch,
            worker,
            marker: PhantomData,
        }
    }

    /// The worker's number.
    pub fn worker(&self) -> usize {
        self.worker
    }

    /// Waits until all workers are done with this phase: the next begins.
    #[inline]
    pub fn meet(self) -> InPhase<'a, P::Other> {
        self.batch.barrier.wait(self.worker);
        InPhase::begin(self.batch, self.worker)
    }
}

/// One worker's part of a slice that all workers write in phase `P`, each its own ranges, and read
/// whole in the other.
pub struct Column<'a, T, P> {
    /// The whole slice.
    start: NonNull<T>,
    len: usize,
    /// The worker's ranges of it.
    own: Vec<Range<usize>>,
    /// The batch whose proofs open it.
    batch: &'a Batch,
    marker: PhantomData<(&'a mut [T], P)>,
}

#[expect(
    unsafe_code,
    reason = "workers touch disjoint ranges in one phase and only read in the other"
)]
// SAFETY: the parts hand out `&mut T` to disjoint ranges and `&T` across threads; both need no more
// than `T: Send + Sync`.
unsafe impl<T: Send + Sync, P> Send for Column<'_, T, P> {}

#[expect(
    unsafe_code,
    reason = "a barrier is all that a phase can afford; locks and atomics per row are not"
)]
impl<T, P: Phase> Column<'_, T, P> {
    /// The worker's own ranges, one after the other.
    ///
    /// # Panics
    /// With the proof of another batch.
    #[inline]
    pub fn write<'s>(
        &'s mut self,
        phase: &'s InPhase<'_, P>,
    ) -> impl Iterator<Item = &'s mut [T]> + use<'s, T, P> {
        assert!(std::ptr::eq(self.batch, phase.batch), "a batch's own proof");
        let start = self.start;
        // SAFETY: `lend` has checked that the ranges lie within the slice and meet no other range,
        // of this worker or another. Until all workers have given up their proofs of phase `P`,
        // none can call `read`. The slice is borrowed mutably as long as this part lives, and this
        // part as long as what is handed out.
        self.own.iter().map(move |range| unsafe {
            std::slice::from_raw_parts_mut(start.add(range.start).as_ptr(), range.len())
        })
    }

    /// The worker's first range: the only one, as a rule; empty where it has none.
    #[inline]
    pub fn write_first<'s>(&'s mut self, phase: &'s InPhase<'_, P>) -> &'s mut [T] {
        self.write(phase).next().unwrap_or_default()
    }

    /// The whole slice.
    ///
    /// # Panics
    /// With the proof of another batch.
    #[inline]
    pub fn read<'s>(&'s self, phase: &'s InPhase<'_, P::Other>) -> &'s [T] {
        assert!(std::ptr::eq(self.batch, phase.batch), "a batch's own proof");
        // SAFETY: this is the slice given to `lend`. Until all workers have given up their proofs
        // of this phase, none can call `write`.
        unsafe { std::slice::from_raw_parts(self.start.as_ptr(), self.len) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::ranges::range_of;
    use super::*;

    /// Sums over neighbours, `steps` times: what one phase writes the other reads.
    fn smoothed(size: usize, steps: usize) -> Vec<u64> {
        let (mut values, mut sums): (Vec<u64>, Vec<u64>) = ((0..100).collect(), vec![0; 100]);
        let mut pool = WorkerPool::new(size);
        let batch = Batch::new(pool.size());
        let own = |worker| vec![range_of(100, worker, size)];
        let columns = batch.lend::<_, MotionPhase>(&mut values, (0..size).map(own));
        let others = batch.lend::<_, ForcePhase>(&mut sums, (0..size).map(own));
        let shares = columns.into_iter().zip(others).collect();
        let begins = pool.run(&batch, shares, |(mut values, mut sums), mut forces| {
            let begin = range_of(100, forces.worker(), size).start;
            for _ in 0..steps {
                let all = values.read(&forces);
                for (i, sum) in (begin..).zip(sums.write_first(&forces)) {
                    *sum = all[i] + all[(i + 1) % 100] + all[(i + 99) % 100];
                }
                let moving = forces.meet();
                let all = sums.read(&moving);
                for (i, value) in (begin..).zip(values.write_first(&moving)) {
                    *value = all[99 - i] % 1_000_003;
                }
                forces = moving.meet();
            }
            begin
        });
        assert_eq!(begins.len(), size);
        values
    }

    #[test]
    fn phases_give_the_same_numbers_for_any_number_of_workers() {
        // An interpreter takes seconds for what takes a processor microseconds.
        let steps = if cfg!(miri) { 8 } else { 200 };
        let alone = smoothed(1, steps);
        for size in [2, 3, 8] {
            assert_eq!(smoothed(size, steps), alone, "{size} workers");
        }
    }

    #[test]
    fn ranges_to_be_shared_are_whole_and_what_comes_of_them_is_in_their_order() {
        for size in [1, 2, 3, 8] {
            let mut pool = WorkerPool::new(size);
            for (count, together) in [(0, 8), (3, 1), (5000, 1), (5000, 8), (4096, 8)] {
                let ranges = pool.ranges(count, together);
                assert_eq!(ranges.len(), if count < WORTH_SHARING { 1 } else { size });
                let inner = &ranges[..ranges.len() - 1];
                assert!(inner.iter().all(|range| range.end % together == 0));
                let found = pool.map(ranges, Iterator::collect::<Vec<usize>>);
                assert_eq!(found.concat(), (0..count).collect::<Vec<usize>>());
            }
        }
    }

    #[test]
    #[should_panic(expected = "disjoint")]
    fn ranges_that_overlap_are_refused() {
        let batch = Batch::new(2);
        let ranges = [[0..3, 6..8].to_vec(), std::iter::once(4..7).collect()];
        batch.lend::<_, ForcePhase>(&mut [0; 10], ranges);
    }

    #[test]
    #[should_panic(expected = "own proof")]
    fn proof_of_another_batch_is_refused() {
        let mut numbers = [0; 4];
        let (batch, other) = (Batch::new(1), Batch::new(1));
        let lent = other.lend::<_, ForcePhase>(&mut numbers, [std::iter::once(0..4).collect()]);
        let read = |mut column: Column<'_, i32, ForcePhase>, phase: InPhase<'_, ForcePhase>| {
            column.write_first(&phase).len()
        };
        WorkerPool::new(1).run(&batch, lent, read);
    }
}
