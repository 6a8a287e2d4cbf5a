//! Whether what a file kept of a run is what a run can be.
//!
//! In: a scene that was checked, and a [`Checkpoint`] or an [`Archive`] of its run. Out: nothing,
//! or what is wrong, a phrase for people. States themselves are looked at by [`World::check`]; here
//! is looked at whether they are of this scene, and whether commands, samples and branches fit
//! together.

use super::archive::{Archive, ArchivedDestination, ArchivedEntry, ArchivedState};
use super::branch::Branch;
use super::check::accept;
use super::history::Moment;
use super::meetings::{MOST_MEETINGS, Meeting};
use super::{Checkpoint, Command, RunRecord};
use crate::measure::{FlowHistory, Series};
use crate::parameters::{ParameterInfo, live_parameters};
use crate::scene::{Scene, SceneGrains};
use crate::world::{MOST_STEPS, World};

/// Most branches that a file holds, kept ones and those that changes lead back to.
const MOST_BRANCHES: usize = 4096;
/// Most branches that were ever begun: their numbers go on from there.
const MOST_BEGUN: u32 = 1 << 30;

/// Longest time of a run, beyond what scenes may ask for because a window goes on [s].
const LONGEST: f64 = 2e6;

fn require(is_so: bool, what: &str) -> Result<(), String> {
    if is_so { Ok(()) } else { Err(what.to_owned()) }
}

impl Checkpoint {
    /// Whether a run of `scene` can go on from it.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self, scene: &Scene) -> Result<(), String> {
        self.world.check().map_err(|error| error.to_string())?;
        is_of_scene(&self.world, scene)?;
        check_measured(&self.series, &self.flow)?;
        check_meetings(&self.meetings, &self.world)?;
        let parameters = live_parameters(scene, &self.world);
        let commands = self.commands.iter();
        let commands = commands.map(|stamped| (stamped.step, stamped.time, &stamped.command));
        check_commands(commands, &parameters, &self.world)
    }
}

impl RunRecord {
    /// Whether it is one that can be computed again: a scene that can be run, a moment that a run
    /// can come to.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self) -> Result<(), String> {
        let scene = self.scene.check();
        scene.map_err(|error| format!("it states a scene that cannot be run: {error}"))?;
        let is_moment = self.steps <= MOST_STEPS && (0.0..=LONGEST).contains(&self.time);
        if is_moment {
            return Ok(());
        }
        Err(format!(
            "it states a state after step {} at {:?} s, to which no run comes",
            self.steps, self.time
        ))
    }
}

impl Archive {
    /// Whether it is one of runs of `scene`.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self, scene: &Scene) -> Result<(), String> {
        let is_bounded = self.branches.len() <= MOST_BRANCHES && self.begun < MOST_BEGUN;
        require(self.is_whole() && is_bounded, "it lacks a branch")?;
        self.bed.check().map_err(|error| error.to_string())?;
        is_of_scene(&self.bed, scene)?;
        require(self.bed.clock.step == 0, "its bed is not at time zero")?;
        let parameters = live_parameters(scene, &self.bed);
        for branch in &self.branches {
            check_branch(branch, &parameters, &self.bed)?;
        }
        for state in &self.states {
            self.check_state(state)?;
        }
        let mut entries = self.undo.iter().chain(&self.redo);
        require(entries.all(leads_somewhere), "a change in it leads nowhere")
    }

    fn check_state(&self, state: &ArchivedState) -> Result<(), String> {
        let shared = state.snapshot.clone().sharing(Some(&self.bed));
        shared.world().check().map_err(|error| error.to_string())?;
        require(
            are_alike(shared.world(), &self.bed) && shared.flow.is_whole(),
            "a state in it is one of another scene",
        )
    }
}

/// Whether a change can be taken back or brought back. Where it leads may lie beyond the present
/// branch: others are taken back before it.
fn leads_somewhere(entry: &ArchivedEntry) -> bool {
    match entry.destination {
        ArchivedDestination::Earlier { moment, .. } => is_moment(moment),
        ArchivedDestination::Other { step, .. } => step <= MOST_STEPS,
    }
}

fn is_moment(moment: Moment) -> bool {
    moment.step <= MOST_STEPS && (0.0..=LONGEST).contains(&moment.time)
}

/// Whether `world` is a state of a run of `scene`, as far as that can be told without making one.
fn is_of_scene(world: &World, scene: &Scene) -> Result<(), String> {
    let materials = world.materials.list().iter().map(|material| &material.name);
    let species = world.species.iter().map(|species| species.name.as_str());
    let stated = scene.species();
    let is_cut = matches!(&scene.grains, SceneGrains::Voronoi(cells) if cells.packing.is_none());
    let is_so = materials.eq(scene.materials.iter().map(|material| &material.name))
        && (stated.is_empty() || species.eq(stated.iter().map(|species| species.0)))
        // How many cells lie in a drum is known when they are cut.
        && (is_cut || world.grains.len() == scene.grain_count())
        && world.polyhedra.is_some() == scene.is_polyhedral()
        && world.liquid.is_some() == scene.liquid.is_some();
    require(is_so, "a state in it is one of another scene")
}

/// Whether two states can be of one run.
fn are_alike(world: &World, bed: &World) -> bool {
    world.grains.len() == bed.grains.len()
        && world.species == bed.species
        && world.materials.list().len() == bed.materials.list().len()
        && world.container.walls.len() == bed.container.walls.len()
        && world.container.shape == bed.container.shape
        && world.polyhedra.is_some() == bed.polyhedra.is_some()
        && world.liquid.is_some() == bed.liquid.is_some()
}

fn check_branch(branch: &Branch, parameters: &[ParameterInfo], bed: &World) -> Result<(), String> {
    require(
        is_moment(branch.end) && branch.number <= MOST_BEGUN,
        "a branch in it ends nowhere",
    )?;
    check_measured(&branch.series, &branch.flow)?;
    check_meetings(&branch.meetings, bed)?;
    let commands = branch.history.commands().iter();
    let commands = commands.map(|stamped| (stamped.step, stamped.time, &stamped.command));
    check_commands(commands, parameters, bed)?;
    let planned = branch.plan.clone();
    let planned = planned.accepted(|command| accept(parameters, bed, command));
    (planned.map(drop)).map_err(|error| format!("a planned change in it: {error}"))
}

fn check_measured(series: &Series, flow: &FlowHistory) -> Result<(), String> {
    require(
        series.is_whole() && flow.is_whole(),
        "its samples do not fit together",
    )
}

/// Whether the `meetings` are in order, and between grains and walls that there are in `world`.
fn check_meetings(meetings: &[Meeting], world: &World) -> Result<(), String> {
    let (grains, walls) = (world.grains.len(), world.container.walls.len());
    let are_sound = (meetings.iter()).all(|meeting| meeting.is_sound(grains, walls))
        && meetings.is_sorted_by_key(|meeting| meeting.step)
        && meetings.len() <= 2 * MOST_MEETINGS;
    require(are_sound, "its meetings of grains do not fit together")
}

/// Whether commands that were carried out are in order, and such as a run carries out.
fn check_commands<'a>(
    commands: impl Iterator<Item = (u64, f64, &'a Command)>,
    parameters: &[ParameterInfo],
    world: &World,
) -> Result<(), String> {
    let mut last = (0, 0.0);
    for (step, time, command) in commands {
        require(
            last.0 <= step && last.1 <= time && time.is_finite(),
            "the changes in it are not in order",
        )?;
        accept(parameters, world, command).map_err(|error| format!("a change in it: {error}"))?;
        last = (step, time);
    }
    Ok(())
}
