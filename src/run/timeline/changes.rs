//! What a person changes in a run at the moment shown, and takes back: a change at an earlier moment
//! begins another branch.
//!
//! In: commands, undo and redo. Out: the run at the moment that they lead to, and the entry that
//! leads back.

use super::Timeline;
use crate::parameters::{Parameter, Value};
use crate::run::history::Moment;
use crate::run::undo::{Changed, Destination, UndoEntry};
use crate::run::{Command, CommandError};

impl Timeline {
    /// Carries out `command` at the moment shown. At an earlier moment this begins another branch
    /// and keeps the one that is left. It is part of the change before it where it `joins`.
    ///
    /// # Errors
    /// As [`Run::apply`].
    pub fn change(&mut self, command: Command, joins: bool) -> Result<(), CommandError> {
        if let Command::Set { parameter, value } = self.run.accept(&command)? {
            let joins = self.begin_change(&parameter, joins);
            self.run.change(parameter, value, joins);
        }
        Ok(())
    }

    /// Whether the time step stays from now on, as it does in each of two runs that keep one time.
    pub(crate) fn keep_step(&mut self, keeps: bool) {
        self.run.keep_step(keeps);
    }

    /// Notes that `command` was carried out in the run beside this one and not here: an undo takes
    /// it back in both, and where it was made at an earlier moment both go on from there.
    ///
    /// # Errors
    /// As [`Timeline::change`].
    pub(crate) fn note_beside(
        &mut self,
        command: &Command,
        joins: bool,
    ) -> Result<(), CommandError> {
        if let Command::Set { parameter, .. } = self.run.accept(command)? {
            self.begin_change(&parameter, joins);
        }
        Ok(())
    }

    /// Makes a new value of `parameter` a change that can be taken back; whether it is part of the
    /// one before it.
    fn begin_change(&mut self, parameter: &Parameter, joins: bool) -> bool {
        self.stop();
        let what = Changed::Parameter(parameter.clone());
        let moment = Moment::of(self.run.world());
        let joins = joins && self.run.is_at_end() && self.changes.can_join();
        if joins {
            self.changes.join(what);
            return true;
        }
        self.keep_end();
        let destination = if self.run.is_at_end() {
            let commands = self.run.commands().len();
            Destination::Earlier { commands, moment }
        } else {
            Destination::Other {
                branch: self.begin_branch(),
                step: moment.step,
            }
        };
        self.changes.note(UndoEntry { what, destination });
        false
    }

    /// Starts afresh at time zero with the present values, keeping the branch that is left.
    pub fn reset(&mut self) {
        self.restart(&self.run.values());
    }

    /// Starts afresh at time zero with these `values`, keeping the branch that is left.
    pub(crate) fn restart(&mut self, values: &[(Parameter, Value)]) {
        self.stop();
        self.keep_end();
        let step = self.step();
        let number = self.next_number();
        let left = self.run.start_afresh(values, number);
        let left = self.keep_left(left);
        // A branch that had only just begun is nothing to come back to.
        if !left.is_fresh() {
            let destination = Destination::Other { branch: left, step };
            self.changes.note(UndoEntry {
                what: Changed::Start,
                destination,
            });
        }
    }

    /// Takes the last change back: goes to its moment, as if it had not been made.
    pub fn undo(&mut self) {
        if let Some(entry) = self.changes.undo.pop() {
            let back = self.go(entry);
            self.changes.redo.push(back);
        }
    }

    /// Brings the last change that was taken back to where it was.
    pub fn redo(&mut self) {
        if let Some(entry) = self.changes.redo.pop() {
            let back = self.go(entry);
            self.changes.undo.push(back);
        }
    }

    /// Shows the end of the kept branch of `index`, if there is one, and keeps the present branch.
    pub fn take_up(&mut self, index: usize) {
        if let Some(branch) = self.kept.get(index).cloned() {
            let step = branch.end.step;
            let back = self.go(UndoEntry {
                what: Changed::Run,
                destination: Destination::Other { branch, step },
            });
            self.changes.note(back);
        }
    }

    /// Goes where `entry` leads; returns the entry that leads back.
    fn go(&mut self, entry: UndoEntry) -> UndoEntry {
        let here = self.position();
        self.keep_end();
        let (branch, step) = match entry.destination {
            Destination::Earlier { commands, moment } => {
                let number = self.next_number();
                (self.branch().until(commands, moment, number), moment.step)
            }
            Destination::Other { branch, step } => ((*branch).clone(), step),
        };
        let left = self.run.replace_branch(branch);
        let left = self.keep_left(left);
        self.travel(here, step);
        UndoEntry {
            what: entry.what,
            destination: Destination::Other {
                branch: left,
                step: here.step(),
            },
        }
    }
}
