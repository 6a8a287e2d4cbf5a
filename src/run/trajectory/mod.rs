//! The trajectory of a scene: its world, the commands carried out and the samples taken.
//!
//! In: a scene and its settled bed, then commands and step numbers to advance to. Out: the world at
//! that step and its samples (see [`super::sampling`]). Nothing here knows of
//! wall-clock time, ticks or threads: however a run is sliced, the same scene, seed and commands
//! give the same bits. Here it advances and is measured; `commands` holds what changes it,
//! `moments` how it comes to another of its moments and to another branch.

mod commands;
mod moments;

use super::StampedCommand;
use super::branch::Branch;
use super::history::Moment;
use super::measured::{Measured, Stored};
use super::meetings::{MOST_MEETINGS, Meeting, meetings};
use super::orientations::{Orientations, Turned};
use super::sampling::{Pace, Sampling};
use super::script::Script;
use crate::measure::{FlowHistory, Sample, Series, sample, sample_and_surface};
use crate::parameters::{ParameterInfo, live_parameters};
use crate::scene::Scene;
use crate::solver::{Extremes, Fault, Profile, Solver, TimeStepAdvice};
use crate::world::World;
use std::sync::Arc;

/// A run from time zero to now.
///
/// ```
/// use grainfall::run::{Command, Parameter, Run};
/// use grainfall::{scene::Scene, solver, world};
///
/// let scene = Scene::open("bouncing-grain")?;
/// // Nothing has to settle here; where it has, `run::Preparation` makes the bed.
/// let bed = world::build(&scene, solver::advise(&scene).time_step);
/// let mut run = Run::new(scene.into(), bed, 1);
/// run.advance_to(500)?;
/// run.apply(Command::Set {
///     parameter: Parameter::Gravity,
///     value: 1.62.into(),
/// })?;
/// run.advance_to(1000)?;
/// assert_eq!(run.commands()[0].step, 500);
/// assert_eq!(run.world().gravity.length(), 1.62);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Run {
    scene: Arc<Scene>,
    parameters: Arc<[ParameterInfo]>,
    bed: Arc<World>,
    world: World,
    solver: Solver,
    /// What was changed and measured, up to its end; the state may be an earlier one of it.
    branch: Branch,
    /// Commands of the branch that were carried out before the state.
    commands: usize,
    /// Samples of the branch that were taken until the state.
    samples: usize,
    /// The flowing layer up to the state, where that is not the branch's end.
    flow: Option<Arc<FlowHistory>>,
    pace: Pace,
    sampling: Sampling,
    /// The state a step ago, where single contacts are followed.
    before: Option<World>,
    script: Script,
    /// How many of the script's commands are recorded already, with what the time step became.
    recorded: usize,
    orientations: Orientations,
    /// Whether the time step stays where the scene lets it follow its limit.
    keeps_step: bool,
    extremes: Extremes,
}

impl Run {
    /// A run of `scene` that starts from `bed`, its world at time zero, on `threads` threads.
    pub fn new(scene: Arc<Scene>, bed: impl Into<Arc<World>>, threads: usize) -> Self {
        let bed = bed.into();
        let pace = Pace::of(&scene, &bed);
        let mut run = Self {
            parameters: live_parameters(&scene, &bed).into(),
            extremes: Extremes::of(&scene),
            pace,
            before: pace.follows_contacts().then(|| (*bed).clone()),
            scene,
            world: (*bed).clone(),
            bed,
            solver: Solver::new(threads),
            branch: Branch::begin(1),
            commands: 0,
            samples: 0,
            flow: None,
            sampling: Sampling::default(),
            script: Script::default(),
            recorded: 0,
            orientations: Orientations::default(),
            keeps_step: false,
        };
        run.take_due_sample();
        run.note_end();
        run
    }

    /// What was asked for.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The state now.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The state at time zero, before any command.
    pub fn bed(&self) -> &Arc<World> {
        &self.bed
    }

    /// The samples of the run; where the state is an earlier one, those after it too.
    pub fn series(&self) -> &Series {
        &self.branch.series
    }

    /// The flowing layer up to the state.
    pub fn flow(&self) -> &Arc<FlowHistory> {
        self.flow.as_ref().unwrap_or(&self.branch.flow)
    }

    /// Contacts and bridges of few grains that began and ended; where the state is an earlier one of
    /// the run, those after it too.
    pub fn meetings(&self) -> &Arc<Vec<Meeting>> {
        &self.branch.meetings
    }

    /// The commands carried out from time zero up to the state.
    pub fn commands(&self) -> &[StampedCommand] {
        &self.branch.history.commands()[..self.commands]
    }

    /// Which samples were taken until the state, and what the next one depends on.
    pub fn sampling(&self) -> Sampling {
        self.sampling
    }

    /// What was changed and measured up to the end, wherever the state is.
    pub(crate) fn branch(&self) -> &Branch {
        &self.branch
    }

    /// Whether the state is the last of its branch, so that going on from it adds to the branch.
    pub(crate) fn is_at_end(&self) -> bool {
        self.world.clock.step >= self.branch.end.step
            && self.commands >= self.branch.history.commands().len()
    }

    /// The parameters that can change while the run goes on.
    pub fn parameters(&self) -> &Arc<[ParameterInfo]> {
        &self.parameters
    }

    /// The time step now, and the limits that the present state sets.
    pub fn advice(&self) -> TimeStepAdvice {
        self.extremes.advise(&self.world)
    }

    /// Goes on with `threads` threads, to the same bits.
    pub(crate) fn use_threads(&mut self, threads: usize) {
        self.solver = Solver::new(threads);
    }

    /// How far each sphere has turned since time zero, from [`Run::follow_orientations`] on.
    pub fn orientations(&self) -> Option<Turned> {
        self.orientations.shared()
    }

    pub(crate) fn follow_orientations(&mut self) {
        self.orientations.begin(&self.world);
    }

    /// Where the solver's time went since this was last called.
    pub fn take_profile(&mut self) -> Profile {
        self.solver.take_profile()
    }

    /// Advances to `step`, sampling on the way; does nothing when that step is past.
    ///
    /// # Errors
    /// The solver's [`Fault`]; the world is then a good state some steps before the fault.
    pub fn advance_to(&mut self, step: u64) -> Result<(), Fault> {
        let outcome = self.advance_and_sample(step);
        self.note_end();
        outcome
    }

    fn advance_and_sample(&mut self, step: u64) -> Result<(), Fault> {
        while self.world.clock.step < step {
            let sample_step = self.sampling.due(&self.pace, &self.world.clock);
            let script_step = self.script.next_step().unwrap_or(u64::MAX);
            let now = self.world.clock.step;
            let due = sample_step.max(now + 1).min(script_step);
            let stop = (self.orientations).before(step.min(due), &self.world);
            if self.before.is_some() {
                self.step_and_look()?;
            } else {
                self.solver.advance(&mut self.world, stop - now)?;
            }
            self.orientations.follow(&self.world);
            self.take_due_sample();
            self.apply_due(false);
        }
        Ok(())
    }

    /// Takes one step; where grains meet or part in it, samples the state before it, too.
    fn step_and_look(&mut self) -> Result<(), Fault> {
        let Some(mut before) = self.before.take() else {
            return Ok(());
        };
        before.clone_from(&self.world);
        let outcome = self.solver.advance(&mut self.world, 1);
        if outcome.is_ok() {
            self.keep_meetings(&before);
        }
        if outcome.is_ok() && self.sampling.heed(&before, &self.world) {
            if self.sampling.note_before(&before.clock) {
                self.keep_sample(&sample(&before));
            }
            self.take_sample();
        }
        self.before = Some(before);
        outcome
    }

    /// Forgets what is `stored` in files of what was measured, but for the last sample and second:
    /// the run goes on as it would, and [`Run::series`] and [`Run::flow`] are parts from then on.
    /// For a run at its end, to which nobody goes back.
    pub fn forget(&mut self, stored: Stored) {
        Arc::make_mut(&mut self.branch.series).forget(stored.samples);
        let flow = self.flow.as_mut().unwrap_or(&mut self.branch.flow);
        Arc::make_mut(flow).forget(stored.seconds);
    }

    /// Has all that was `measured` again, after some of it was forgotten.
    pub fn remember(&mut self, measured: Measured) {
        self.branch.series = measured.series;
        self.branch.flow = measured.flow;
        self.flow = None;
    }

    pub(super) fn take_due_sample(&mut self) {
        if self.sampling.due(&self.pace, &self.world.clock) <= self.world.clock.step {
            self.take_sample();
        }
    }

    fn take_sample(&mut self) {
        let (sample, surface) = sample_and_surface(&self.world);
        if let Some(line) = surface {
            let flow = self.flow.as_mut().unwrap_or(&mut self.branch.flow);
            Arc::make_mut(flow).add(&self.world, &sample, &line);
        }
        self.keep_sample(&sample);
        self.sampling.note(&self.pace, &self.world.clock);
    }

    fn keep_sample(&mut self, sample: &Sample) {
        // On the way to a later moment of the branch the sample is in it already.
        let known = self.branch.series.steps().last();
        if known.is_none_or(|last| *last < sample.step) {
            Arc::make_mut(&mut self.branch.series).push(*sample);
        }
        self.samples = self.branch.series.taken_until(sample.step);
    }

    /// Keeps who met and parted in the step from the state `before`, as long as there is room.
    fn keep_meetings(&mut self, before: &World) {
        let known = &self.branch.meetings;
        // On the way to a later moment of the branch they are in it already.
        let last = known.last().map_or(0, |last| last.step);
        let new = meetings(before, &self.world);
        if !new.is_empty() && last < self.world.clock.step && known.len() < MOST_MEETINGS {
            Arc::make_mut(&mut self.branch.meetings).extend(new);
        }
    }

    /// Notes the state as the branch's end, where it is at or beyond it.
    pub(super) fn note_end(&mut self) {
        if self.is_at_end() {
            self.branch.end = Moment::of(&self.world);
            self.branch.plan.keep_times(&self.world.clock);
            if let Some(flow) = self.flow.take() {
                self.branch.flow = flow;
            }
        }
    }
}
