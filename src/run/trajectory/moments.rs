//! Where a run stands among its moments: what it takes to come back to one, in memory or in another
//! process, and the branches that begin at one.
//!
//! In: snapshots, checkpoints, branches. Out: the run at that moment; what followed it stays known
//! or is forgotten, as each function says.

use super::Run;
use crate::parameters::{Parameter, Value};
use crate::run::branch::Branch;
use crate::run::history::Moment;
use crate::run::sampling::Sampling;
use crate::run::snapshot::{Checkpoint, Snapshot};
use std::sync::Arc;

impl Run {
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
}
