//! The trajectory of a scene: its world, the commands carried out and the samples taken.
//!
//! In: a scene and its settled bed, then commands and step numbers to advance to. Out: the world at that step and a
//! [`Sample`] every [`SAMPLE_INTERVAL`] of simulated time. Nothing here knows of wall-clock time, ticks or threads:
//! however a run is sliced, the same scene, seed and commands give the same bits.

use super::parameter::{self, ParameterInfo};
use super::script::Script;
use super::{Command, Parameter, StampedCommand};
use crate::measure::{FlowHistory, Series, sample_and_surface};
use crate::scene::{Scene, TimeStep};
use crate::solver::{Extremes, Fault, Profile, Solver, TimeStepAdvice};
use crate::world::World;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Simulated time between two samples [s].
pub const SAMPLE_INTERVAL: f64 = 0.02;

/// A run from time zero to now.
pub struct Run {
    scene: Arc<Scene>,
    parameters: Arc<[ParameterInfo]>,
    bed: Arc<World>,
    world: World,
    solver: Solver,
    commands: Vec<StampedCommand>,
    script: Script,
    /// How many of the script's commands are those of a record, which says what the step became.
    recorded: usize,
    extremes: Extremes,
    series: Series,
    flow: Arc<FlowHistory>,
    next_sample: u64,
}

/// Where a run stood: all it takes to go on from there, together with the run's commands and samples until then.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Snapshot {
    world: World,
    commands: usize,
    samples: usize,
    #[serde(with = "super::shared")]
    flow: Arc<FlowHistory>,
    next_sample: u64,
}

impl Snapshot {
    /// Steps taken then.
    pub fn step(&self) -> u64 {
        self.world.clock.step
    }

    /// Commands carried out until then.
    pub fn commands(&self) -> usize {
        self.commands
    }

    /// The state then.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The same with the shapes of polyhedra that `shapes_of` has.
    pub(crate) fn sharing(mut self, shapes_of: Option<&World>) -> Self {
        let shapes = shapes_of.and_then(|world| Some(world.polyhedra.as_ref()?.shapes.clone()));
        if let Some(polyhedra) = &mut self.world.polyhedra {
            polyhedra.shapes = shapes.unwrap_or_else(|| Arc::new([]));
        }
        self
    }

    /// Memory that it takes [bytes].
    pub fn memory(&self) -> usize {
        self.world.memory() + self.flow.memory()
    }
}

/// A run as a file can keep it: all it takes to go on in another process, to the same bits.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Checkpoint {
    world: World,
    commands: Vec<StampedCommand>,
    series: Series,
    flow: FlowHistory,
    next_sample: u64,
}

/// Why a command was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CommandError {
    /// The scene has no such live parameter.
    #[error("the scene has no parameter `{parameter}`; it has {}", .known.join(", "))]
    Unknown {
        /// The key that was given.
        parameter: String,
        /// The keys there are.
        known: Vec<String>,
    },
    /// The value lies outside the parameter's range.
    #[error("`{parameter}` cannot be {value} {unit}; expected {low} … {high} {unit}")]
    OutOfRange {
        /// Which parameter.
        parameter: Parameter,
        /// The value asked for.
        value: f64,
        /// Smallest value it can take.
        low: f64,
        /// Largest value it can take.
        high: f64,
        /// SI unit of the three.
        unit: &'static str,
    },
}

impl Run {
    /// A run of `scene` that starts from `bed`, its world at time zero, on `threads` threads.
    pub fn new(scene: Arc<Scene>, bed: impl Into<Arc<World>>, threads: usize) -> Self {
        let bed = bed.into();
        let mut run = Self {
            parameters: parameter::live_parameters(&scene, &bed).into(),
            extremes: Extremes::of(&scene),
            scene,
            world: (*bed).clone(),
            bed,
            solver: Solver::new(threads),
            commands: Vec::new(),
            script: Script::default(),
            recorded: 0,
            series: Series::default(),
            flow: Arc::default(),
            next_sample: 0,
        };
        run.take_due_sample();
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

    /// The samples so far.
    pub fn series(&self) -> &Series {
        &self.series
    }

    /// The flowing layer so far.
    pub fn flow(&self) -> &Arc<FlowHistory> {
        &self.flow
    }

    /// The commands carried out since time zero.
    pub fn commands(&self) -> &[StampedCommand] {
        &self.commands
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

    /// Where the solver's time went since this was last called.
    pub fn take_profile(&mut self) -> Profile {
        self.solver.take_profile()
    }

    /// Commands to carry out by themselves when their steps come, in order of their steps.
    ///
    /// # Errors
    /// A [`CommandError`] when one of them cannot be carried out in this scene; none is taken then.
    pub fn schedule(&mut self, script: Script) -> Result<(), CommandError> {
        self.check_all(&script)?;
        self.follow(script, 0);
        Ok(())
    }

    /// The same for all the commands of a recorded run: no step follows a limit but by a command.
    ///
    /// # Errors
    /// As [`Run::schedule`].
    pub fn replay(&mut self, script: Script) -> Result<(), CommandError> {
        self.check_all(&script)?;
        self.follow(script, usize::MAX);
        Ok(())
    }

    fn check_all(&self, script: &Script) -> Result<(), CommandError> {
        let mut commands = script.commands();
        commands.try_for_each(|command| check(&self.parameters, &self.world, command))
    }

    /// Carries out `script`, which was checked, from here on instead of what was scheduled. Its first
    /// `recorded` commands are those of a record.
    pub(crate) fn follow(&mut self, script: Script, recorded: usize) {
        self.script = script;
        self.recorded = recorded;
        self.carry_out_due();
    }

    /// Carries out `command` now and keeps it. What concerns the player alone (play, pause, step, seek …) is passed over.
    /// Where the scene's step follows its limit and the command moves that, a command about the step comes after it.
    ///
    /// # Errors
    /// A [`CommandError`] when the scene has no such parameter or the value is out of its range; nothing changes then.
    pub fn apply(&mut self, command: Command) -> Result<(), CommandError> {
        self.check(&command)?;
        self.followed(|run| run.carry_out(command));
        Ok(())
    }

    /// The same, and the step stays: for one of two runs that keep one time.
    ///
    /// # Errors
    /// As [`Run::apply`].
    pub(crate) fn apply_at_this_step(&mut self, command: Command) -> Result<(), CommandError> {
        self.check(&command)?;
        self.carry_out(command);
        Ok(())
    }

    /// Whether `command` can be carried out.
    ///
    /// # Errors
    /// The [`CommandError`] that [`Run::apply`] would answer with.
    pub fn check(&self, command: &Command) -> Result<(), CommandError> {
        check(&self.parameters, &self.world, command)
    }

    /// Advances to `step`, sampling on the way; does nothing when that step is past.
    ///
    /// # Errors
    /// The solver's [`Fault`]; the world is then a good state some steps before the fault.
    pub fn advance_to(&mut self, step: u64) -> Result<(), Fault> {
        while self.world.clock.step < step {
            let sample_step = sample_step(&self.world, self.next_sample);
            let script_step = self.script.next_step().unwrap_or(u64::MAX);
            let stop = step.min(sample_step).min(script_step);
            let steps = stop - self.world.clock.step;
            self.solver.advance(&mut self.world, steps)?;
            self.take_due_sample();
            self.carry_out_due();
        }
        Ok(())
    }

    /// All it takes to go on from here in another process.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            world: self.world.clone(),
            commands: self.commands.clone(),
            series: self.series.clone(),
            flow: (*self.flow).clone(),
            next_sample: self.next_sample,
        }
    }

    /// Goes on from a `checkpoint` of a run of the same scene and script. Commands of the script that were carried out
    /// before it are not carried out again.
    pub fn resume(&mut self, checkpoint: Checkpoint) {
        self.world = checkpoint.world;
        self.commands = checkpoint.commands;
        self.series = checkpoint.series;
        self.flow = Arc::new(checkpoint.flow);
        self.next_sample = checkpoint.next_sample;
        while self.script.take_due(self.world.clock.step).is_some() {}
    }

    /// All it takes to come back to this moment.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            world: self.world.clone(),
            commands: self.commands.len(),
            samples: self.series.len(),
            flow: self.flow.clone(),
            next_sample: self.next_sample,
        }
    }

    /// Goes to a `snapshot` of a run of the same scene that had these `commands` and this `series` then or later; what
    /// it forgets after them is up to the caller to schedule.
    pub fn restore(&mut self, snapshot: &Snapshot, commands: &[StampedCommand], series: &Series) {
        self.world.clone_from(&snapshot.world);
        self.commands.clear();
        let kept = snapshot.commands.min(commands.len());
        self.commands.extend_from_slice(&commands[..kept]);
        self.series.copy_first(series, snapshot.samples);
        self.forget_script();
        self.flow.clone_from(&snapshot.flow);
        self.next_sample = snapshot.next_sample;
    }

    /// Goes to time zero, before any command.
    pub fn restart(&mut self) {
        self.world.clone_from(&self.bed);
        self.commands.clear();
        self.forget_script();
        self.series.truncate(0);
        self.flow = Arc::default();
        self.next_sample = 0;
        self.take_due_sample();
    }

    fn forget_script(&mut self) {
        self.script = Script::default();
        self.recorded = 0;
    }

    fn carry_out_due(&mut self) {
        let step = self.world.clock.step;
        while self.recorded > 0
            && let Some(command) = self.script.take_due(step)
        {
            self.recorded -= 1;
            self.carry_out(command);
        }
        if self.script.next_step().is_some_and(|due| due <= step) {
            self.followed(|run| {
                while let Some(command) = run.script.take_due(step) {
                    run.carry_out(command);
                }
            });
        }
    }

    /// Makes a change; where the step follows its limit and that has moved, takes the largest stable
    /// step from here on.
    fn followed(&mut self, change: impl FnOnce(&mut Self)) {
        if self.scene.time_step != TimeStep::Following {
            return change(self);
        }
        let before = self.advice().largest();
        change(self);
        let advice = self.advice();
        let largest = advice.largest();
        if largest != before && largest != advice.time_step {
            self.set(&Parameter::TimeStep, largest);
        }
    }

    fn carry_out(&mut self, command: Command) {
        match command {
            Command::Reset => self.reset(),
            Command::Set { parameter, value } => self.set(&parameter, value),
            _ => {}
        }
    }

    fn set(&mut self, parameter: &Parameter, value: f64) {
        let parameter = parameter::canonical(parameter, &self.world.materials);
        parameter::write(&parameter, value, &self.scene, &mut self.world);
        if parameter == Parameter::TimeStep {
            self.script.keep_times(&self.world.clock);
        }
        self.commands.push(StampedCommand {
            step: self.world.clock.step,
            time: self.world.time(),
            command: Command::Set { parameter, value },
        });
    }

    /// Present values of the parameters and of the time step.
    pub(crate) fn values(&self) -> Vec<(Parameter, f64)> {
        let parameters = self.parameters.iter().map(|info| info.parameter.clone());
        let parameters = parameters.chain([Parameter::TimeStep]);
        let values = parameters.filter_map(|parameter| {
            let value = parameter.read(&self.world)?;
            Some((parameter, value))
        });
        values.collect()
    }

    /// Back to the bed with the present values.
    pub(crate) fn reset(&mut self) {
        self.restart_with(&self.values());
    }

    /// Back to the bed. Those of the `values` that differ from the bed's become commands at step zero.
    pub(crate) fn restart_with(&mut self, values: &[(Parameter, f64)]) {
        self.restart();
        for (parameter, value) in values {
            if parameter.read(&self.world).is_some_and(|own| own != *value) {
                self.set(parameter, *value);
            }
        }
    }

    fn take_due_sample(&mut self) {
        if sample_step(&self.world, self.next_sample) > self.world.clock.step {
            return;
        }
        let (sample, surface) = sample_and_surface(&self.world);
        if let Some(line) = surface {
            Arc::make_mut(&mut self.flow).add(&self.world, &sample, &line);
        }
        self.series.push(sample);
        while sample_step(&self.world, self.next_sample) <= self.world.clock.step {
            self.next_sample += 1;
        }
    }
}

/// The step after which the sample of this index is taken.
fn sample_step(world: &World, sample: u64) -> u64 {
    world.clock.step_at(sample as f64 * SAMPLE_INTERVAL)
}

/// Refuses a command that cannot be carried out in `world`.
pub(crate) fn check(
    parameters: &[ParameterInfo],
    world: &World,
    command: &Command,
) -> Result<(), CommandError> {
    let Command::Set { parameter, value } = command else {
        return Ok(());
    };
    let parameter = parameter::canonical(parameter, &world.materials);
    let step = parameter::time_step(world.clock.time_step);
    let known = || parameters.iter().chain([&step]);
    let Some(info) = known().find(|info| info.parameter == parameter) else {
        return Err(CommandError::Unknown {
            parameter: parameter.to_string(),
            known: known().map(|info| info.parameter.to_string()).collect(),
        });
    };
    if info.range.contains(value) {
        return Ok(());
    }
    Err(CommandError::OutOfRange {
        low: *info.range.start(),
        high: *info.range.end(),
        unit: info.unit,
        value: *value,
        parameter,
    })
}
