//! The trajectory of a scene: its world, the commands carried out and the samples taken.
//!
//! In: a scene and its settled bed, then commands and step numbers to advance to. Out: the world at
//! that step and its samples (see [`super::sampling`]). Nothing here knows of
//! wall-clock time, ticks or threads: however a run is sliced, the same scene, seed and commands
//! give the same bits.

use super::branch::Branch;
use super::check::accept;
use super::history::Moment;
use super::measured::{Measured, Stored};
use super::meetings::{MOST_MEETINGS, Meeting, meetings};
use super::orientations::{Orientations, Turned};
use super::sampling::{Pace, Sampling};
use super::script::Script;
use super::snapshot::{Checkpoint, Snapshot};
use super::{Command, CommandError, StampedCommand};
use crate::measure::{FlowHistory, Sample, Series, sample, sample_and_surface};
use crate::parameters::{Parameter, ParameterInfo, Value, live_parameters};
use crate::scene::{Scene, TimeStep};
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

    /// Commands to carry out by themselves when their steps come, in order of their steps.
    ///
    /// # Errors
    /// A [`CommandError`] when one of them cannot be carried out in this scene; none is taken then.
    pub fn schedule(&mut self, script: Script) -> Result<(), CommandError> {
        self.follow(script, 0)
    }

    /// The same for all the commands of a recorded run: no time step follows a limit but by a
    /// command.
    ///
    /// # Errors
    /// As [`Run::schedule`].
    pub fn replay(&mut self, script: Script) -> Result<(), CommandError> {
        self.follow(script, usize::MAX)
    }

    fn follow(&mut self, script: Script, recorded: usize) -> Result<(), CommandError> {
        let script = script.accepted(|command| self.accept(command))?;
        self.branch.plan = script.clone();
        (self.script, self.recorded) = (script, recorded);
        self.apply_due(true);
        Ok(())
    }

    /// Goes on as the branch says and, after its end, as was planned.
    pub(crate) fn follow_branch(&mut self) {
        (self.script, self.recorded) = self.branch.rest(self.commands);
        self.apply_due(false);
    }

    /// Carries out `command` now and keeps it. What concerns the clock alone (play, pause, step,
    /// seek …) is passed over. Where the scene's time step follows its limit and the command moves
    /// that limit, a command about the time step is carried out after it.
    ///
    /// # Errors
    /// A [`CommandError`] when the scene has no such parameter or the value is out of its range;
    /// nothing changes then.
    pub fn apply(&mut self, command: Command) -> Result<(), CommandError> {
        let command = self.accept(&command)?;
        self.followed(|run| run.execute(command, false));
        Ok(())
    }

    /// Gives a `parameter` the `value`, both as [`Run::accept`] has them, as [`Run::apply`] does;
    /// it is part of the change before it where it `joins`.
    pub(crate) fn change(&mut self, parameter: Parameter, value: Value, joins: bool) {
        self.followed(|run| run.set(parameter, value, joins));
    }

    /// Whether the time step stays from now on where the scene lets it follow its limit: two runs
    /// side by side keep one time.
    pub(crate) fn keep_step(&mut self, keeps: bool) {
        self.keeps_step = keeps;
    }

    /// The `command` as this run carries it out: its parameter by the one name that it has, its
    /// value of the kind that this takes.
    ///
    /// # Errors
    /// The [`CommandError`] that [`Run::apply`] would answer with.
    pub fn accept(&self, command: &Command) -> Result<Command, CommandError> {
        accept(&self.parameters, &self.world, command)
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

    /// All it takes to go on from here in another process.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            world: self.world.clone(),
            commands: self.commands().to_vec(),
            series: self.branch.series.clone(),
            flow: self.flow().clone(),
            meetings: self.branch.meetings.clone(),
            sampling: self.sampling,
        }
    }

    /// Goes on from a `checkpoint` of a run of the same scene and script. Commands of the script
    /// that were carried out before it are not carried out again.
    pub fn resume(&mut self, checkpoint: Checkpoint) {
        self.world = checkpoint.world;
        self.script.forget_past(&self.world.clock);
        self.commands = checkpoint.commands.len();
        self.samples = checkpoint.series.taken();
        self.branch = Branch {
            history: Arc::new(checkpoint.commands.into_iter().collect()),
            series: checkpoint.series,
            flow: checkpoint.flow,
            meetings: checkpoint.meetings,
            end: Moment::of(&self.world),
            plan: self.script.clone(),
            number: self.branch.number,
        };
        self.flow = None;
        self.sampling = checkpoint.sampling;
    }

    /// All it takes to come back to this moment.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            world: self.world.clone(),
            commands: self.commands,
            samples: self.samples,
            flow: self.flow().clone(),
            sampling: self.sampling,
            turned: self.orientations(),
        }
    }

    /// Goes back to a `snapshot` of this run and forgets what followed it.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        let end = Moment::of(&snapshot.world);
        self.branch = (self.branch).until(snapshot.commands, end, self.branch.number);
        self.show(snapshot);
    }

    /// Goes to a `snapshot` of the present branch; what followed it there stays known.
    pub(crate) fn show(&mut self, snapshot: &Snapshot) {
        self.world.clone_from(&snapshot.world);
        self.commands = snapshot.commands.min(self.branch.history.commands().len());
        self.samples = snapshot.samples.min(self.branch.series.taken());
        self.flow = Some(snapshot.flow.clone());
        self.sampling = snapshot.sampling;
        (self.orientations).jump(&self.world, snapshot.turned.as_deref());
        self.forget_script();
        self.note_end();
    }

    /// Goes to time zero, before any command of the present branch; what followed there stays
    /// known.
    pub(crate) fn rewind(&mut self) {
        self.world.clone_from(&self.bed);
        (self.commands, self.samples) = (0, 0);
        self.orientations.jump(&self.world, None);
        self.sampling = Sampling::default();
        self.flow = Some(Arc::default());
        self.forget_script();
        self.take_due_sample();
        self.note_end();
    }

    /// Is about `branch` from now on, of which the state need not be one, and returns the branch
    /// that is left. The caller goes to a state of it next.
    pub(crate) fn replace_branch(&mut self, branch: Branch) -> Branch {
        std::mem::replace(&mut self.branch, branch)
    }

    /// Ends the present branch at the state, which becomes the beginning of one of this `number`;
    /// returns the branch that is left.
    pub(crate) fn begin_branch(&mut self, number: u32) -> Branch {
        let end = Moment::of(&self.world);
        let branch = self.branch.until(self.commands, end, number);
        let left = self.replace_branch(branch);
        self.note_end();
        left
    }

    /// Goes to time zero and begins a branch of this `number` there. Those of the `values` that
    /// differ from the bed's become commands at step zero, all of them one change. Returns the
    /// branch that is left.
    pub(crate) fn start_afresh(&mut self, values: &[(Parameter, Value)], number: u32) -> Branch {
        let left = self.replace_branch(Branch::begin(number));
        self.rewind();
        for (parameter, value) in values {
            if parameter.read(&self.world).is_some_and(|own| own != *value) {
                self.set(parameter.clone(), *value, true);
            }
        }
        left
    }

    fn forget_script(&mut self) {
        self.script = Script::default();
        self.recorded = 0;
    }

    fn apply_due(&mut self, joins: bool) {
        let step = self.world.clock.step;
        while self.recorded > 0
            && let Some(command) = self.script.take_due(step)
        {
            self.recorded -= 1;
            self.execute(command, joins);
        }
        if self.script.next_step().is_some_and(|due| due <= step) {
            self.followed(|run| {
                while let Some(command) = run.script.take_due(step) {
                    run.execute(command, joins);
                }
            });
        }
    }

    /// Makes a change; where the time step follows its limit and that has moved, takes the largest
    /// stable time step from here on, as part of the change.
    fn followed(&mut self, change: impl FnOnce(&mut Self)) {
        if self.keeps_step || self.scene.time_step != TimeStep::Following {
            return change(self);
        }
        let before = self.advice().largest();
        change(self);
        let advice = self.advice();
        let largest = advice.largest();
        if largest != before && largest != advice.time_step {
            self.set(Parameter::TimeStep, largest.into(), true);
        }
    }

    fn execute(&mut self, command: Command, joins: bool) {
        match command {
            Command::Reset => {
                self.start_afresh(&self.values(), self.branch.number);
            }
            Command::Set { parameter, value } => self.set(parameter, value, joins),
            _ => {}
        }
    }

    /// Gives a `parameter` the `value`, both as [`Run::accept`] has them, and notes it in the
    /// branch.
    fn set(&mut self, parameter: Parameter, value: Value, joins: bool) {
        parameter.write(value, &self.scene, &mut self.world);
        // On the way to a later moment of the branch the command is in it already.
        if self.commands == self.branch.history.commands().len() {
            if parameter == Parameter::TimeStep {
                self.script.keep_times(&self.world.clock);
            }
            let command = StampedCommand {
                step: self.world.clock.step,
                time: self.world.time(),
                command: Command::Set { parameter, value },
            };
            Arc::make_mut(&mut self.branch.history).push(command, joins);
        }
        self.commands += 1;
    }

    /// Present values of the parameters and of the time step.
    pub(crate) fn values(&self) -> Vec<(Parameter, Value)> {
        let parameters = self.parameters.iter().map(|info| info.parameter.clone());
        let parameters = parameters.chain([Parameter::TimeStep]);
        let values = parameters.filter_map(|parameter| {
            let value = parameter.read(&self.world)?;
            Some((parameter, value))
        });
        values.collect()
    }

    fn take_due_sample(&mut self) {
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
    fn note_end(&mut self) {
        if self.is_at_end() {
            self.branch.end = Moment::of(&self.world);
            self.branch.plan.keep_times(&self.world.clock);
            if let Some(flow) = self.flow.take() {
                self.branch.flow = flow;
            }
        }
    }
}
