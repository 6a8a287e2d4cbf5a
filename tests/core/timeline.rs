//! Claims about going back in time: the same bits on every way to a moment, whatever was changed,
//! taken back or forgotten.

use crate::runs::{bits, friction, prepared, set, shared_beds};
use grainfall::measure::{Measure, NON_RIGID_TEMPERATURE, Series};
use grainfall::physics::LIQUID_CASES;
use grainfall::run::{
    BedStore, Changed, Command, Parameter, Run, Script, ScriptedCommand, Timeline,
};
use grainfall::scene::{Scene, SceneContainer};
use grainfall::world::StateHash;

/// Memory for a handful of keyframes of the scenes here, and for all that could be wanted [bytes].
const LITTLE: usize = 1 << 20;
const PLENTY: usize = 1 << 28;

/// The small drum with 60 % glycerol, so fast that the bed slides down within a tenth of a second.
fn wet() -> Scene {
    let mut scene = Scene::open("small-drum").unwrap();
    if let SceneContainer::Drum { speed, .. } = &mut scene.container {
        *speed = 4.0;
    }
    scene.liquid = Some(LIQUID_CASES[3].liquid());
    scene
}

/// A scene to explore: how far apart the places are that are looked at, and what is changed at some
/// of them.
pub struct Explored {
    pub scene: Scene,
    pub beds: BedStore,
    /// Steps from one place to the next.
    pub unit: u64,
    changes: [(u64, Command); 3],
}

/// The wet drum, looked at every 30 ms.
pub fn wet_lab() -> Explored {
    Explored {
        scene: wet(),
        beds: shared_beds(),
        unit: unit(),
        changes: [
            (3, set(Parameter::Viscosity, 0.2)),
            (6, wet_friction(0.2)),
            (7, set(Parameter::LiquidVolume, 2e-6)),
        ],
    }
}

/// A column of about a hundred Voronoi grains that falls, looked at every 8 ms: within a tenth of a
/// second it has spread.
pub fn column_lab() -> Explored {
    let mut scene = Scene::open("small-column").unwrap();
    scene.set("radius", "12mm").unwrap();
    scene.set("height", "18mm").unwrap();
    let friction = |value| {
        let pair = Parameter::Friction("smooth".into(), "rough".into());
        set(pair, value)
    };
    let beds = BedStore::none();
    let run = prepared(&scene, 1, beds.clone()).0;
    Explored {
        unit: run.world().clock.step_at(8e-3),
        scene,
        beds,
        changes: [
            (3, friction(0.02)),
            (6, set(Parameter::Gravity, 12.0)),
            (7, friction(0.9)),
        ],
    }
}

impl Explored {
    fn run(&self) -> Run {
        prepared(&self.scene, 1, self.beds.clone()).0
    }

    /// The change at place 7.
    pub fn last_change(&self) -> Command {
        self.changes[2].1.clone()
    }

    /// Goes to a place.
    pub fn seek(&self, timeline: &mut Timeline, index: usize) {
        seek(timeline, self.unit * index as u64);
    }

    /// A run to place 12 that is changed on the way, with the hash at each place.
    pub fn recorded(&self, memory: usize) -> (Timeline, Vec<StateHash>) {
        self.recorded_to(12, memory)
    }

    /// The same to the `last` place.
    pub fn recorded_to(&self, last: u64, memory: usize) -> (Timeline, Vec<StateHash>) {
        let mut timeline = Timeline::new(self.run(), memory);
        let mut hashes = vec![hash(&timeline)];
        for index in 1..=last {
            go_on(&mut timeline, self.unit * index);
            let due = self.changes.iter().filter(|(place, _)| *place == index);
            for (_, command) in due {
                change(&mut timeline, command.clone());
            }
            hashes.push(hash(&timeline));
        }
        (timeline, hashes)
    }
}

fn run() -> Run {
    prepared(&wet(), 1, shared_beds()).0
}

fn timeline(memory: usize) -> Timeline {
    Timeline::new(run(), memory)
}

/// Steps in 30 ms.
fn unit() -> u64 {
    run().world().clock.step_at(0.03)
}

fn wet_friction(value: f64) -> Command {
    set(
        Parameter::WetFriction("glass".into(), "glass".into()),
        value,
    )
}

pub fn hash(timeline: &Timeline) -> StateHash {
    timeline.run().world().hash()
}

/// Goes on by pieces, as an engine would, until `step`.
pub fn go_on(timeline: &mut Timeline, step: u64) {
    while timeline.run().world().clock.step < step {
        let next = timeline.run().world().clock.step + 397;
        timeline.advance_to(next.min(step)).unwrap();
    }
}

/// Goes where it was asked to go.
pub fn arrive(timeline: &mut Timeline) {
    while let Some(step) = timeline.destination() {
        go_on(timeline, step);
    }
}

fn seek(timeline: &mut Timeline, step: u64) {
    timeline.seek(step);
    arrive(timeline);
    assert_eq!(timeline.run().world().clock.step, step);
}

fn undo(timeline: &mut Timeline) {
    timeline.undo();
    arrive(timeline);
}

fn redo(timeline: &mut Timeline) {
    timeline.redo();
    arrive(timeline);
}

pub fn change(timeline: &mut Timeline, command: Command) {
    timeline.change(command, false).unwrap();
}

/// Speed of the fastest grain [m/s].
fn top_speed(timeline: &Timeline) -> f64 {
    let velocities = timeline.run().world().grains.velocity.iter();
    velocities.map(|v| v.length()).fold(0.0, f64::max)
}

/// Steps of samples at which the bed flows.
fn flowing(series: &Series) -> Vec<u64> {
    let temperature = series.column(Measure::GranularTemperature);
    let steps = series.steps().iter().zip(temperature);
    steps
        .filter(|(_, temperature)| **temperature > NON_RIGID_TEMPERATURE)
        .map(|(step, _)| *step)
        .collect()
}

/// A run of 360 ms whose liquid and friction change on the way, with the hash of every twelfth of
/// it.
fn recorded(memory: usize) -> (Timeline, Vec<StateHash>) {
    wet_lab().recorded(memory)
}

#[test]
fn scrub_lands_on_the_same_bits_mid_avalanche_with_liquid() {
    for memory in [0, LITTLE, PLENTY] {
        let (mut timeline, hashes) = recorded(memory);
        let series = bits(&timeline.branch().series);
        let flows = flowing(&timeline.branch().series).len();
        assert!(
            flows >= 12,
            "it flows for two thirds of the time: {flows} samples"
        );
        let places: &[usize] = match memory {
            0 => &[11, 3, 12],
            _ => &[12, 3, 11, 4, 5, 0, 7, 6, 6, 1, 12],
        };
        for &index in places {
            seek(&mut timeline, unit() * index as u64);
            assert_eq!(hash(&timeline), hashes[index], "place {index}");
        }
        assert_eq!(bits(&timeline.branch().series), series);
        assert_eq!(bits(timeline.run().series()), series);
        assert!(timeline.past().memory <= memory);
        // What was seen again goes on as if nobody had gone back.
        let (mut straight, _) = recorded(0);
        seek(&mut timeline, 10 * unit());
        go_on(&mut timeline, 13 * unit());
        go_on(&mut straight, 13 * unit());
        assert_eq!(hash(&timeline), hash(&straight));
        assert_eq!(
            bits(&timeline.branch().series),
            bits(&straight.branch().series)
        );
        assert_eq!(timeline.run().flow(), straight.run().flow());
        assert!(timeline.kept().is_empty() && timeline.past().redo.is_none());
    }
}

#[test]
fn scrub_that_is_turned_round_on_the_way_lands_all_the_same() {
    let (mut timeline, hashes) = recorded(0);
    timeline.seek(8 * unit());
    timeline.advance_to(777).unwrap();
    timeline.seek(10 * unit());
    timeline.advance_to(3 * unit() + 1).unwrap();
    seek(&mut timeline, 3 * unit());
    assert_eq!(hash(&timeline), hashes[3]);
    seek(&mut timeline, 5 * unit());
    assert_eq!(hash(&timeline), hashes[5]);
}

#[test]
fn branch_is_a_run_of_its_own_and_keeps_the_one_that_is_left() {
    let (mut timeline, hashes) = recorded(PLENTY);
    let left = bits(&timeline.branch().series);
    let flowing = flowing(&timeline.branch().series);
    let at = flowing[flowing.len() / 2];
    seek(&mut timeline, at);
    change(&mut timeline, wet_friction(0.9));
    assert_eq!(
        timeline.branch().end.step,
        at,
        "what came later is another run"
    );
    go_on(&mut timeline, 12 * unit());
    let branch = hash(&timeline);
    assert_ne!(branch, hashes[12]);

    // The same changes in a run that never went back.
    let mut straight = run();
    let list: Vec<ScriptedCommand> = timeline.run().commands().iter().map(Into::into).collect();
    let script = Script::new(&list, &straight.world().clock).unwrap();
    straight.schedule(script).unwrap();
    straight.advance_to(12 * unit()).unwrap();
    assert_eq!(straight.world().hash(), branch);
    assert_eq!(bits(straight.series()), bits(&timeline.branch().series));

    assert_eq!(timeline.kept().len(), 1);
    assert_eq!(bits(&timeline.kept()[0].series), left);
    timeline.take_up(0);
    arrive(&mut timeline);
    assert_eq!(hash(&timeline), hashes[12]);
    assert_eq!(bits(timeline.run().series()), left);
    assert_eq!(timeline.kept().len(), 1, "now the branch is kept");
    undo(&mut timeline);
    assert_eq!(hash(&timeline), branch);
}

#[test]
fn undo_and_redo_walk_through_the_changes_bit_for_bit() {
    // The states that a change began from: the values that it sets are part of a state.
    let (mut unchanged, _) = recorded(PLENTY);
    let before = [7, 6, 3].map(|index| {
        seek(&mut unchanged, index * unit() - 1);
        (index, one_step_on(&unchanged))
    });
    for memory in [0, LITTLE, PLENTY] {
        let (mut timeline, hashes) = recorded(memory);
        assert_eq!(
            timeline.past().undo,
            Some(Changed::Parameter(Parameter::LiquidVolume))
        );
        for (index, before) in before {
            undo(&mut timeline);
            assert_eq!(timeline.run().world().clock.step, index * unit());
            assert_eq!(hash(&timeline), before);
            assert_eq!(timeline.branch().end.step, index * unit());
        }
        assert_eq!(timeline.past().undo, None);
        undo(&mut timeline);
        assert_eq!(hash(&timeline), before[2].1, "nothing more to undo");
        for index in [6, 7, 12] {
            redo(&mut timeline);
            assert_eq!(timeline.run().world().clock.step, index * unit());
        }
        assert_eq!(hash(&timeline), hashes[12]);
        assert!(timeline.kept().is_empty());
        assert!(timeline.past().memory <= memory);
    }
}

/// Hash of the state one step after the one shown, before any change there.
fn one_step_on(timeline: &Timeline) -> StateHash {
    let mut run = run();
    run.resume(timeline.run().checkpoint());
    run.advance_to(timeline.run().world().clock.step + 1)
        .unwrap();
    run.world().hash()
}

#[test]
fn undone_value_is_the_one_before() {
    let mut timeline = timeline(PLENTY);
    let parameter = Parameter::Viscosity;
    let value = |timeline: &Timeline| Parameter::Viscosity.read(timeline.run().world()).unwrap();
    let first = value(&timeline);
    go_on(&mut timeline, 300);
    change(&mut timeline, set(parameter.clone(), 0.1));
    go_on(&mut timeline, 600);
    change(&mut timeline, set(parameter, 0.9));
    go_on(&mut timeline, 900);
    undo(&mut timeline);
    assert_eq!(value(&timeline), 0.1);
    undo(&mut timeline);
    assert_eq!(value(&timeline), first);
    redo(&mut timeline);
    assert_eq!(value(&timeline), 0.1);
    change(&mut timeline, friction(0.3));
    assert_eq!(
        timeline.past().redo,
        None,
        "a new change ends what could be redone"
    );
}

#[test]
fn drag_is_one_change() {
    let mut timeline = timeline(PLENTY);
    go_on(&mut timeline, 200);
    let before = hash(&timeline);
    for (index, value) in [0.3, 0.25, 0.2, 0.1].into_iter().enumerate() {
        timeline.change(friction(value), index > 0).unwrap();
        go_on(&mut timeline, 210 + 10 * index as u64);
    }
    let (step, end) = (timeline.run().world().clock.step, hash(&timeline));
    assert_eq!(timeline.branch().history.changes(), [0]);
    undo(&mut timeline);
    assert_eq!(
        (hash(&timeline), timeline.run().commands().len()),
        (before, 0)
    );
    redo(&mut timeline);
    assert_eq!(timeline.run().world().clock.step, step);
    assert_eq!(hash(&timeline), end);
    let values = timeline.run().commands().len();
    assert_eq!(values, 4);
}

#[test]
fn start_afresh_can_be_taken_back() {
    let (mut timeline, hashes) = recorded(PLENTY);
    timeline.reset();
    assert_eq!(timeline.run().world().clock.step, 0);
    assert_eq!(timeline.run().commands().len(), 3, "present values stay");
    go_on(&mut timeline, 100);
    undo(&mut timeline);
    assert_eq!(hash(&timeline), hashes[12]);
    redo(&mut timeline);
    assert_eq!(timeline.run().world().clock.step, 100);
}

#[test]
fn plan_goes_on_after_a_branch() {
    let planned = ScriptedCommand {
        step: Some(800),
        time: None,
        command: friction(0.15),
    };
    let mut timeline = timeline(PLENTY);
    let script = Script::new(&[planned], &timeline.run().world().clock).unwrap();
    timeline.schedule(script).unwrap();
    go_on(&mut timeline, 1000);
    assert_eq!(timeline.run().commands().len(), 1);
    seek(&mut timeline, 400);
    assert!(timeline.run().commands().is_empty());
    change(&mut timeline, set(Parameter::Gravity, 5.0));
    go_on(&mut timeline, 1000);
    let steps: Vec<u64> = timeline.run().commands().iter().map(|c| c.step).collect();
    assert_eq!(steps, [400, 800]);
}

#[test]
fn refused_change_leaves_the_future_alone() {
    let (mut timeline, _) = recorded(PLENTY);
    seek(&mut timeline, 1000);
    timeline.change(friction(7.0), false).unwrap_err();
    assert_eq!(timeline.branch().end.step, 12 * unit());
    assert!(timeline.kept().is_empty());
}

#[test]
fn kept_runs_can_be_forgotten_and_one_without_a_step_of_its_own_is_not_kept() {
    let (mut timeline, _) = recorded(PLENTY);
    seek(&mut timeline, 1000);
    change(&mut timeline, friction(0.7));
    undo(&mut timeline);
    assert!(timeline.kept().is_empty(), "the branch took no step");
    change(&mut timeline, friction(0.6));
    assert_eq!(timeline.kept().len(), 1);
    timeline.forget(0);
    timeline.forget(7);
    assert!(timeline.kept().is_empty());
}

#[test]
fn what_was_recorded_is_seen_again_faster_by_its_keyframes() {
    let (mut timeline, hashes) = recorded(PLENTY);
    seek(&mut timeline, 0);
    timeline.skip_towards(u64::MAX);
    assert_eq!(
        timeline.run().world().clock.step,
        12 * unit(),
        "the end was kept"
    );
    assert_eq!(hash(&timeline), hashes[12]);
}

#[test]
fn scrub_lands_on_the_same_bits_mid_collapse_with_polyhedra() {
    let lab = column_lab();
    let mut fastest = 0.0_f64;
    for memory in [0, PLENTY] {
        let (mut timeline, hashes) = lab.recorded(memory);
        let series = bits(&timeline.branch().series);
        let places: &[usize] = match memory {
            0 => &[9, 4],
            _ => &[12, 3, 11, 5, 0, 7, 6, 6, 12],
        };
        for &index in places {
            lab.seek(&mut timeline, index);
            assert_eq!(hash(&timeline), hashes[index], "place {index}");
            fastest = fastest.max(top_speed(&timeline));
        }
        assert_eq!(bits(&timeline.branch().series), series);
        let (mut straight, _) = lab.recorded(0);
        lab.seek(&mut timeline, 10);
        for timeline in [&mut timeline, &mut straight] {
            go_on(timeline, 13 * lab.unit);
        }
        assert_eq!(hash(&timeline), hash(&straight));
        assert!(timeline.kept().is_empty());
    }
    // Half of what a free fall from the column's height ends with.
    assert!(
        fastest > 0.5 * (2.0 * 9.81 * 0.018_f64).sqrt(),
        "{fastest} m/s"
    );
}

#[test]
fn branch_undo_and_redo_of_polyhedra_are_the_same_to_the_bit() {
    let lab = column_lab();
    let (mut timeline, hashes) = lab.recorded(PLENTY);
    lab.seek(&mut timeline, 5);
    change(&mut timeline, set(Parameter::Gravity, 3.0));
    go_on(&mut timeline, 9 * lab.unit);
    let branch = hash(&timeline);
    assert_ne!(branch, hashes[9]);
    let mut straight = lab.run();
    let list: Vec<ScriptedCommand> = timeline.run().commands().iter().map(Into::into).collect();
    let script = Script::new(&list, &straight.world().clock).unwrap();
    straight.schedule(script).unwrap();
    straight.advance_to(9 * lab.unit).unwrap();
    assert_eq!(straight.world().hash(), branch);

    undo(&mut timeline);
    assert_eq!(timeline.run().world().clock.step, 5 * lab.unit);
    assert_eq!(hash(&timeline), hashes[5]);
    redo(&mut timeline);
    assert_eq!(hash(&timeline), branch);
    timeline.take_up(0);
    arrive(&mut timeline);
    assert_eq!(hash(&timeline), hashes[12], "the run that was left");
    undo(&mut timeline);
    assert_eq!(hash(&timeline), branch);
}

#[test]
fn world_says_what_memory_it_takes() {
    let world = run().world().clone();
    let count = world.grains.len();
    let contacts = size_of::<grainfall::world::Contact>() * world.contacts.len();
    let per_grain = (world.memory() - contacts) as f64 / count as f64;
    // Six vectors, ten numbers and four small ones: 6 · 24 + 10 · 8 + 2 · 4 + 2 bytes, and the world's own fields.
    assert!((234.0..260.0).contains(&per_grain), "{per_grain}");
}
