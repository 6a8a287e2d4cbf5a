//! What changes a run on its way: commands given now, those that come by themselves at their steps,
//! and the time step that follows its limit.
//!
//! In: commands. Out: each carried out, stamped with its step and kept in the branch; refused ones
//! change nothing. When their steps come is [`Run::advance_to`]'s business.

use super::Run;
use crate::parameters::{Parameter, Value};
use crate::run::check::accept;
use crate::run::{Command, CommandError, Script, StampedCommand};
use crate::scene::TimeStep;
use std::sync::Arc;

impl Run {
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

    pub(super) fn forget_script(&mut self) {
        self.script = Script::default();
        self.recorded = 0;
    }

    pub(super) fn apply_due(&mut self, joins: bool) {
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
    pub(super) fn set(&mut self, parameter: Parameter, value: Value, joins: bool) {
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
}
