//! The runs of a lab, one or two, each with its timeline; two are kept at the same step.
//!
//! In: what is to be done in all of them or in one. Out: their states, all of the same step. Each
//! run goes the way, to the bit, that it would go alone: the same change is made in both before the
//! same step, and a change of one of them is noted in the other, so that undo and redo lead both to
//! the same moment, and so does a branch.
//!
//! Two runs advance at the same time, each on its own threads, piece by piece to a common step. On
//! the way to another moment each goes as fast as its keyframes let it; where one stops short,
//! because of a fault or because it was told to, the one that is ahead goes back to it.

use super::Half;
use super::clock::LabClock;
use super::update::{RunNews, RunsNews};
use crate::run::{
    Branch, Command, CommandError, KeptMemory, Parameter, Run, Session, Stored, Timeline, Turned,
    Value,
};
use crate::scene::Scene;
use crate::solver::{Fault, Profile};
use crate::world::{self, World};
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Why two time steps are not compared.
pub const ONE_STEP: &str = "Two runs side by side have the same time step";

/// Wall-clock time from one sharing of the samples to the next, per sample. The first sample that
/// is taken after they were shared copies those before it, about 300 bytes each. Copying takes 0.2
/// ms for a minute's samples and 3 ms for those of ten minutes: so it takes two parts in a hundred
/// of the time at most.
const TIME_PER_SAMPLE: Duration = Duration::from_micros(15);
/// Wall-clock time from one look at what a run keeps in memory to the next.
const TIME_PER_LOOK: Duration = Duration::from_secs(1);

/// The runs of a lab, one at least.
pub struct Runs {
    list: Vec<LabRun>,
    /// What the two differ in, where there are two.
    comparison: Option<Parameter>,
    /// Whether another state is to be shown as soon as all are at the same step.
    is_news: bool,
}

/// A run and what of it is shown.
struct LabRun {
    timeline: Timeline,
    fault: Option<Fault>,
    profile: Profile,
    shown: Arc<World>,
    /// How far its spheres have turned.
    turned: Option<Turned>,
    /// Steps and commands carried out in the state shown.
    shown_at: (u64, usize),
    /// The branch as it is shared with the outside, and since when.
    branch: Arc<Branch>,
    shared_at: Instant,
    /// What the run keeps in memory, and when that was looked at.
    memory: KeptMemory,
    looked_at: Option<Instant>,
}

/// What came of a piece of work.
#[derive(Clone, Copy, Debug, Default)]
pub struct Piece {
    /// The most steps that a run took.
    pub steps: u64,
    /// Whether all runs came to the moment that was asked for.
    pub arrived: bool,
}

impl LabRun {
    fn new(mut timeline: Timeline) -> Self {
        timeline.follow_orientations();
        Self {
            turned: timeline.run().orientations(),
            shown: Arc::new(timeline.run().world().clone()),
            shown_at: timeline.steps_and_commands(),
            branch: Arc::new(timeline.branch().clone()),
            shared_at: Instant::now(),
            memory: KeptMemory::default(),
            looked_at: None,
            timeline,
            fault: None,
            profile: Profile::default(),
        }
    }

    fn step(&self) -> u64 {
        self.timeline.run().world().clock.step
    }

    fn news(&mut self, is_renewed: bool, rests: bool) -> RunNews {
        if is_renewed {
            self.shown = Arc::new(self.timeline.run().world().clone());
            self.turned = self.timeline.run().orientations();
            self.shown_at = self.timeline.steps_and_commands();
        }
        self.share_branch(rests);
        self.look_at_memory();
        RunNews {
            world: self.shown.clone(),
            reached: self.shown.clock.step,
            start: self.timeline.run().bed().clone(),
            turned: self.turned.clone(),
            parameters: self.timeline.run().parameters().clone(),
            branch: self.branch.clone(),
            latest: self.timeline.branch().series.last(),
            sampling: self.timeline.run().sampling(),
            past: self.timeline.past(),
            memory: self.memory,
            flow: None,
            fault: self.fault.clone(),
            profile: self.profile.clone(),
        }
    }

    /// Counts what is kept in memory, once a second.
    fn look_at_memory(&mut self) {
        if (self.looked_at).is_none_or(|looked| looked.elapsed() >= TIME_PER_LOOK) {
            self.memory = self.timeline.kept_memory(&self.branch);
            self.looked_at = Some(Instant::now());
        }
    }

    /// Shares the branch with the outside again, where that costs nothing or is due.
    fn share_branch(&mut self, rests: bool) {
        let branch = self.timeline.branch();
        let samples = branch.series.len();
        let list = |branch: &Branch| (branch.number, branch.history.commands().len());
        let costs_nothing = samples == self.branch.series.len();
        let is_due = self.shared_at.elapsed() >= TIME_PER_SAMPLE.saturating_mul(samples as u32);
        if rests || costs_nothing || is_due || list(branch) != list(&self.branch) {
            self.branch = Arc::new(branch.clone());
            self.shared_at = Instant::now();
        }
    }
}

impl Runs {
    /// One run, with its `timeline`.
    pub fn new(timeline: Timeline) -> Self {
        Self {
            list: vec![LabRun::new(timeline)],
            comparison: None,
            is_news: true,
        }
    }

    /// The left one, which is all there is without a comparison.
    fn first(&self) -> &LabRun {
        &self.list[0]
    }

    fn timelines(&mut self) -> impl Iterator<Item = &mut Timeline> {
        self.list.iter_mut().map(|run| &mut run.timeline)
    }

    /// Whether there are two.
    pub fn is_pair(&self) -> bool {
        self.list.len() > 1
    }

    /// Steps taken and time step; of two runs on the way to a moment, of the left one.
    pub fn now(&self) -> world::Clock {
        self.first().timeline.run().world().clock
    }

    /// Whether all stand at the same step.
    pub fn are_in_step(&self) -> bool {
        let step = self.first().step();
        self.list.iter().all(|run| run.step() == step)
    }

    /// Whether one of them is on the way to a moment that was asked for.
    pub fn are_on_the_way(&self) -> bool {
        (self.list.iter()).any(|run| run.timeline.destination().is_some())
    }

    /// How much of that way is done by the one that is last, 0 … 1.
    pub fn progress(&self) -> f32 {
        let ways = self.list.iter().map(|run| run.timeline.progress());
        ways.fold(1.0, f32::min)
    }

    /// The first fault that stopped one of them.
    pub fn fault(&self) -> Option<&Fault> {
        self.list.iter().find_map(|run| run.fault.as_ref())
    }

    /// Forgets what stopped them.
    pub fn forget_faults(&mut self) {
        for run in &mut self.list {
            run.fault = None;
        }
    }

    /// The step that `run` is to come to before the next command. While one is on the way to a
    /// moment, the others wait.
    fn goal(&self, run: &LabRun, clock: &LabClock) -> u64 {
        let destination = run.timeline.destination();
        if destination.is_none() && self.are_on_the_way() {
            return run.step();
        }
        clock.goal(destination)
    }

    /// Whether one of them is to go further.
    pub fn have_work(&self, clock: &LabClock) -> bool {
        (self.list.iter()).any(|run| run.step() < self.goal(run, clock))
    }

    /// Lets each go at most `steps` steps towards its goal, all at the same time.
    pub fn advance(&mut self, clock: &mut LabClock, steps: u64) -> Piece {
        let was_on_the_way = self.are_on_the_way();
        let goals: Vec<u64> = (self.list.iter())
            .map(|run| self.goal(run, clock).min(run.step().saturating_add(steps)))
            .collect();
        let ways = self.list.iter().zip(&goals);
        let steps = ways.map(|(run, goal)| goal.saturating_sub(run.step()));
        let steps = steps.max().unwrap_or(0);
        if advance_all(&mut self.list, &goals) {
            clock.stop();
            self.align();
        } else if !was_on_the_way {
            clock.reach(goals[0]);
        }
        Piece {
            steps,
            arrived: was_on_the_way && !self.are_on_the_way(),
        }
    }

    /// Sends those that are ahead back to the one that is last.
    fn align(&mut self) {
        let Some(last) = self.list.iter().map(LabRun::step).min() else {
            return;
        };
        for run in self.list.iter_mut().filter(|run| run.step() > last) {
            run.timeline.seek(last);
        }
    }

    /// Shows what is recorded already up to `step` faster than it can be computed. Two runs have
    /// keyframes at different steps, so they compute it.
    pub fn skip_towards(&mut self, step: u64) {
        if !self.is_pair() && !self.are_on_the_way() {
            self.timelines()
                .for_each(|timeline| timeline.skip_towards(step));
        }
    }

    /// Stays where they are on the way to a moment; two of them where the one is that is last.
    pub fn stop(&mut self) {
        self.timelines().for_each(Timeline::stop);
        self.align();
    }

    /// Goes to `step` in all, at most to the end of what is recorded.
    pub fn seek(&mut self, step: u64) {
        self.timelines().for_each(|timeline| timeline.seek(step));
    }

    /// Starts all afresh at time zero with their present values.
    pub fn reset(&mut self) {
        self.timelines().for_each(Timeline::reset);
    }

    /// Takes the last change back in all. What was changed before a comparison began is the left
    /// run's alone and stays.
    pub fn undo(&mut self) {
        if self
            .list
            .iter()
            .all(|run| run.timeline.past().undo.is_some())
        {
            self.timelines().for_each(Timeline::undo);
        }
    }

    /// Brings the change that was taken back last to all again.
    pub fn redo(&mut self) {
        if self
            .list
            .iter()
            .all(|run| run.timeline.past().redo.is_some())
        {
            self.timelines().for_each(Timeline::redo);
        }
    }

    /// Shows the branch of this index again.
    pub fn take_up(&mut self, index: usize) {
        self.list[0].timeline.take_up(index);
    }

    /// Forgets what is `stored` in files of what was measured, where there is one run.
    pub fn forget_measured(&mut self, stored: Stored) {
        if !self.is_pair() {
            self.list[0].timeline.forget_measured(stored);
        }
    }

    /// Keeps the branch of this index no longer.
    pub fn forget(&mut self, index: usize) {
        self.list[0].timeline.forget(index);
    }

    /// Calls the branch of this `number` of the run in `half` by `name`.
    pub fn name_branch(&mut self, half: Half, number: u32, name: &str) {
        if let Some(run) = self.list.get_mut(half.index()) {
            run.timeline.name_branch(number, name);
        }
    }

    /// Works on `threads` threads in all from now on.
    pub fn use_threads(&mut self, threads: usize) {
        let share = (threads / self.list.len()).max(1);
        self.timelines()
            .for_each(|timeline| timeline.use_threads(share));
    }

    /// Makes `change` in all runs, or in one `half`: by itself where it is what the two differ in,
    /// in the left one. It is part of the change before it where it `joins`.
    ///
    /// # Errors
    /// As [`Run::apply`]; nothing is changed in any of them then.
    pub fn change(
        &mut self,
        change: &Command,
        half: Option<Half>,
        joins: bool,
    ) -> Result<(), CommandError> {
        // Both have the same parameters and time step: what one accepts the other does too.
        let change = &self.first().timeline.run().accept(change)?;
        let differs = matches!(
            (change, &self.comparison),
            (Command::Set { parameter, .. }, Some(own)) if parameter == own
        );
        let half = half.or(differs.then_some(Half::Left));
        for (index, timeline) in self.timelines().enumerate() {
            if half.is_none_or(|half| half.index() == index) {
                timeline.change(change.clone(), joins)?;
            } else {
                timeline.note_beside(change, joins)?;
            }
        }
        Ok(())
    }

    /// Starts a second run beside the first, with keyframes in `memory` bytes: both at time zero,
    /// with the present values of all parameters but `parameter`, which has this `value` in the
    /// right one.
    ///
    /// # Errors
    /// Why there can be no second run now, in a sentence.
    pub fn compare(
        &mut self,
        parameter: Parameter,
        value: Value,
        memory: usize,
    ) -> Result<(), String> {
        if self.is_pair() {
            return Err("Two runs are compared already: end that comparison first".into());
        }
        if self.fault().is_some() {
            return Err("Two runs start side by side only while the run stands or goes on".into());
        }
        if parameter == Parameter::TimeStep {
            return Err(ONE_STEP.into());
        }
        let first = &mut self.list[0].timeline;
        let run = first.run();
        let change = Command::Set {
            parameter: parameter.clone(),
            value,
        };
        let accepted = run.accept(&change).map_err(|refusal| refusal.to_string())?;
        let Command::Set { parameter, value } = accepted else {
            return Err(format!("`{parameter}` cannot differ between two runs"));
        };
        let mut values = run.values();
        let second = Run::new(run.scene().clone(), run.bed().clone(), 1);
        first.restart(&values);
        for (own, present) in &mut values {
            if *own == parameter {
                *present = value;
            }
        }
        let mut second = Timeline::new(second, memory);
        second.restart(&values);
        self.list.push(LabRun::new(second));
        // Two runs have one time: their step follows no limit of one of them.
        self.timelines()
            .for_each(|timeline| timeline.keep_step(true));
        self.comparison = Some(parameter);
        self.is_news = true;
        Ok(())
    }

    /// Goes on with one of two runs and keeps the other, and its branches, as branches.
    pub fn end_comparison(&mut self, keep: Half) {
        let Some(second) = self.list.drain(1..).next() else {
            return;
        };
        self.comparison = None;
        let first = &mut self.list[0].timeline;
        first.keep_step(false);
        let newest = first.adopt_all(&second.timeline);
        if keep == Half::Right {
            first.take_up(newest);
        }
        self.is_news = true;
    }

    /// Writes the session of a scene that was opened as `original`, in a window of this `look`, to
    /// `path`; of two runs, the right one and its branches as branches.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn save(&mut self, path: &Path, original: &Scene, look: String) -> io::Result<()> {
        let (first, others) = self.list.split_at_mut(1);
        let timeline = &mut first[0].timeline;
        let kept = timeline.kept().to_vec();
        for other in others {
            timeline.adopt_all(&other.timeline);
        }
        let title = &timeline.run().scene().title;
        let session = Session::of(title, timeline)
            .of_original(original)
            .looking(look);
        timeline.keep_only(kept);
        session.write(path)
    }

    /// Takes what the solvers' time was spent on since this was last called.
    pub fn renew_profiles(&mut self) {
        for run in &mut self.list {
            let profile = run.timeline.take_profile();
            if profile.steps > 0 {
                run.profile = profile;
            }
        }
    }

    /// All runs as they are to be shown, where all are at the same step.
    pub fn news(&mut self, clock: &LabClock) -> Option<RunsNews> {
        for run in &mut self.list {
            let news = run.timeline.take_news();
            self.is_news |= news.switched || news.arrived;
        }
        if !self.are_in_step() {
            return None;
        }
        let moved = (self.list.iter()).any(|run| run.shown_at != run.timeline.steps_and_commands());
        let is_renewed = self.is_news || (moved && !self.are_on_the_way());
        self.is_news = false;
        let rests = !self.have_work(clock);
        Some(RunsNews {
            comparison: self.comparison.clone(),
            runs: (self.list.iter_mut())
                .map(|run| run.news(is_renewed, rests))
                .collect(),
        })
    }
}

/// Lets each of the `runs` come to its goal: the first on this thread, others on threads of their
/// own. Whether one of them met a fault on the way.
fn advance_all(runs: &mut [LabRun], goals: &[u64]) -> bool {
    let advance = |run: &mut LabRun, goal: u64| {
        if run.step() >= goal {
            return false;
        }
        run.fault = run.timeline.advance_to(goal).err();
        run.fault.is_some()
    };
    let mut work = runs.iter_mut().zip(goals.iter().copied());
    let Some((first, goal)) = work.next() else {
        return false;
    };
    std::thread::scope(|scope| {
        let others: Vec<_> = work
            .map(|(run, goal)| scope.spawn(move || advance(run, goal)))
            .collect();
        let mut is_faulted = advance(first, goal);
        for other in others {
            match other.join() {
                Ok(other) => is_faulted |= other,
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        is_faulted
    })
}
