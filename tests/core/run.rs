//! Claims about runs: what slices, drivers, snapshots and commands do to a trajectory.

use glam::DVec3;
use grainfall::lab::{DriverKind, Lab, LabCommand, Options, Status};
use grainfall::measure::EnergyLedger;
use grainfall::physics::LIQUID_CASES;
use grainfall::run::{
    BedStore, Command, CommandError, Parameter, Preparation, Prepared, Run, SAMPLE_INTERVAL,
    Script, ScriptError, ScriptedCommand, Value,
};
use grainfall::scene::{Scene, SceneContainer, SceneGrain, SceneGrains, TimeStep};
use grainfall::solver::advise;
use grainfall::world::World;
use std::sync::Arc;
use std::time::Duration;

use crate::runs::{bits, friction, prepared, set, shared_beds};

const TICK: Duration = Duration::from_micros(15_625);

fn scene(name: &str) -> Scene {
    Scene::open(name).unwrap()
}

fn run_of(scene: &Scene) -> Run {
    prepared(scene, 1, shared_beds()).0
}

#[test]
fn slices_do_not_show_in_a_run() {
    let scene = scene("small-drum");
    let [mut fine, mut coarse] = [run_of(&scene), run_of(&scene)];
    let (change, end) = (701, 2500);
    for step in 1..=change {
        fine.advance_to(step).unwrap();
    }
    fine.apply(friction(0.1)).unwrap();
    for step in (change..end).step_by(7) {
        fine.advance_to(step).unwrap();
    }
    fine.advance_to(end).unwrap();
    coarse.advance_to(change).unwrap();
    coarse.apply(friction(0.1)).unwrap();
    coarse.advance_to(end).unwrap();
    assert_eq!(fine.world().hash(), coarse.world().hash());
    assert_eq!(bits(fine.series()), bits(coarse.series()));
}

#[test]
fn samples_are_taken_at_the_first_step_of_each_interval() {
    let mut run = run_of(&scene("small-drum"));
    let clock = run.world().clock;
    run.advance_to(clock.step_at(0.5)).unwrap();
    let expected: Vec<u64> = (0..=25)
        .map(|sample| clock.step_at(f64::from(sample) * SAMPLE_INTERVAL))
        .collect();
    assert_eq!(run.series().steps(), expected);
}

#[test]
fn restored_run_continues_bit_for_bit() {
    let mut run = run_of(&scene("small-drum"));
    run.advance_to(900).unwrap();
    run.apply(friction(0.2)).unwrap();
    let snapshot = run.snapshot();
    run.advance_to(1500).unwrap();
    run.apply(set(Parameter::DrumSpeed, 0.5)).unwrap();
    run.advance_to(2000).unwrap();
    let (hash, samples, commands) = (
        run.world().hash(),
        bits(run.series()),
        run.commands().to_vec(),
    );
    run.restore(&snapshot);
    assert_eq!(run.commands().len(), 1, "later commands are forgotten");
    run.advance_to(1500).unwrap();
    run.apply(set(Parameter::DrumSpeed, 0.5)).unwrap();
    run.advance_to(2000).unwrap();
    assert_eq!(run.world().hash(), hash);
    assert_eq!(bits(run.series()), samples);
    assert_eq!(run.commands(), commands);
}

#[test]
fn recorded_commands_play_again_to_the_bit() {
    let scene = scene("small-drum");
    let mut played = run_of(&scene);
    played.apply(set(Parameter::Gravity, 5.0)).unwrap();
    for (step, value) in [(300, 0.1), (301, 0.7), (900, 0.3)] {
        played.advance_to(step).unwrap();
        played.apply(friction(value)).unwrap();
    }
    played.advance_to(1500).unwrap();
    let list: Vec<ScriptedCommand> = played.commands().iter().map(Into::into).collect();
    let mut again = run_of(&scene);
    let script = Script::new(&list, &again.world().clock).unwrap();
    again.schedule(script).unwrap();
    again.advance_to(1500).unwrap();
    assert_eq!(again.world().hash(), played.world().hash());
    assert_eq!(again.commands(), played.commands());
}

#[test]
fn liquids_changed_while_it_runs_play_again_to_the_bit() {
    let mut scene = scene("small-drum");
    scene.liquid = Some(LIQUID_CASES[3].liquid());
    let mut played = run_of(&scene);
    let glycerol = &LIQUID_CASES[6];
    let as_coded = Parameter::BridgeLaw.row().parse("as-coded").unwrap();
    let wet_friction = Parameter::WetFriction("glass".into(), "glass".into());
    for (step, parameter, value) in [
        (300, Parameter::Viscosity, glycerol.viscosity.into()),
        (
            400,
            Parameter::SurfaceTension,
            glycerol.surface_tension().into(),
        ),
        (500, Parameter::ContactAngle, 0.2.into()),
        (600, Parameter::LiquidVolume, 2e-6.into()),
        (700, Parameter::BridgeLaw, as_coded),
        (800, Parameter::LiquidVolume, 0.0.into()),
        (900, Parameter::LiquidVolume, 3e-6.into()),
        (1000, wet_friction, Value::Number(0.05)),
    ] {
        played.advance_to(step).unwrap();
        let mut unchanged = prepared(&scene, 1, shared_beds()).0;
        unchanged.resume(played.checkpoint());
        played.apply(set(parameter.clone(), value)).unwrap();
        assert_eq!(parameter.read(played.world()), Some(value));
        played.advance_to(step + 50).unwrap();
        unchanged.advance_to(step + 50).unwrap();
        let bits = |run: &Run| (run.world().hash(), run.world().grains.force.clone());
        assert_ne!(bits(&played), bits(&unchanged), "{parameter} acts at once");
    }
    played.advance_to(1500).unwrap();
    let list: Vec<ScriptedCommand> = played.commands().iter().map(Into::into).collect();
    let mut again = prepared(&scene, 2, shared_beds()).0;
    let script = Script::new(&list, &again.world().clock).unwrap();
    again.schedule(script).unwrap();
    again.advance_to(1500).unwrap();
    assert_eq!(again.world().hash(), played.world().hash());
}

#[test]
fn a_value_is_kept_as_what_it_is_accepted_for() {
    let mut scene = scene("small-drum");
    scene.liquid = Some(LIQUID_CASES[3].liquid());
    let as_coded = Parameter::BridgeLaw.row().parse("as-coded").unwrap();
    let pair = |a: &str, b: &str| Parameter::Friction(a.into(), b.into());
    // A choice by the number that stands for it, a pair by its other name.
    let given = [
        set(Parameter::BridgeLaw, as_coded.number()),
        set(pair("drum", "glass"), 0.2),
    ];
    let accepted = [
        set(Parameter::BridgeLaw, as_coded),
        set(pair("glass", "drum"), 0.2),
    ];
    let kept = |run: &Run| -> Vec<Command> {
        let commands = run.commands().iter();
        commands.map(|stamped| stamped.command.clone()).collect()
    };
    let mut applied = run_of(&scene);
    for command in &given {
        applied.apply(command.clone()).unwrap();
    }
    assert_eq!(kept(&applied), accepted);
    let mut scheduled = run_of(&scene);
    let list = given.map(|command| ScriptedCommand {
        step: Some(0),
        time: None,
        command,
    });
    let script = Script::new(&list, &scheduled.world().clock).unwrap();
    scheduled.schedule(script).unwrap();
    assert_eq!(kept(&scheduled), accepted);
    let before = applied.world().hash();
    let refused = applied.apply(set(pair("glass", "drum"), Value::Count(1)));
    assert!(
        matches!(refused, Err(CommandError::Unsuited(_))),
        "{refused:?}"
    );
    assert_eq!(applied.world().hash(), before);
}

#[test]
fn reset_starts_the_command_list_with_the_present_values() {
    let mut run = run_of(&scene("small-drum"));
    let start = run.world().clone();
    run.advance_to(500).unwrap();
    run.apply(friction(0.1)).unwrap();
    run.apply(Command::Pause).unwrap();
    run.advance_to(600).unwrap();
    run.apply(Command::Reset).unwrap();
    let commands: Vec<_> = run
        .commands()
        .iter()
        .map(|c| (c.step, &c.command))
        .collect();
    assert_eq!(commands, [(0, &friction(0.1))]);
    let world = run.world();
    assert_eq!(world.grains, start.grains, "the bed is as it was");
    assert_eq!(
        (&world.contacts, world.clock),
        (&start.contacts, start.clock)
    );
    assert_ne!(world.hash(), start.hash(), "with another friction");
    assert_eq!(run.series().len(), 1, "only the sample at time zero");
}

#[test]
fn impossible_commands_are_refused_and_change_nothing() {
    let mut run = run_of(&scene("small-drum"));
    let unknown = set(Parameter::Friction("glass".into(), "gold".into()), 0.1);
    let message = run.apply(unknown).unwrap_err().to_string();
    assert!(message.contains("friction.glass.gold") && message.contains("friction.glass.drum"));
    for value in [-0.1, 7.0, f64::NAN, f64::INFINITY] {
        let refused = run.apply(friction(value)).unwrap_err();
        assert!(
            matches!(refused, CommandError::OutOfRange { .. }),
            "{refused}"
        );
    }
    assert!(run.commands().is_empty());
}

#[test]
fn a_pair_has_one_parameter_whatever_the_order_of_its_names() {
    let mut run = run_of(&scene("small-drum"));
    let swapped = Parameter::Friction("drum".into(), "glass".into());
    run.apply(set(swapped, 0.11)).unwrap();
    let kept = Parameter::Friction("glass".into(), "drum".into());
    assert_eq!(run.commands()[0].command, set(kept, 0.11));
}

#[test]
fn scripts_that_cannot_be_played_are_refused() {
    let run = run_of(&scene("small-drum"));
    let entry = |step, time, command| ScriptedCommand {
        step,
        time,
        command,
    };
    let clock = &run.world().clock;
    let refused = |list: &[ScriptedCommand]| Script::new(list, clock).unwrap_err();
    let good = entry(Some(3), None, Command::Play);
    assert_eq!(
        refused(&[good.clone(), entry(None, None, Command::Play)]),
        ScriptError::NoTime(2)
    );
    assert_eq!(
        refused(&[entry(None, Some(-1.0), Command::Play)]),
        ScriptError::BadTime(1, -1.0)
    );
    assert_eq!(
        refused(&[entry(Some(0), None, Command::Reset)]),
        ScriptError::NoChange(1, "Reset")
    );
}

#[test]
fn every_parameter_reads_back_what_was_set_and_the_ledger_stays_closed() {
    let mut run = run_of(&scene("two-frictions-drum"));
    run.advance_to(500).unwrap();
    for info in run.parameters().clone().iter() {
        let range = info.range();
        let value = 0.25 * range.start() + 0.75 * range.end();
        let before = EnergyLedger::of(run.world());
        run.apply(set(info.parameter.clone(), value)).unwrap();
        let after = EnergyLedger::of(run.world());
        // Shares are as near as whole grains allow; everything else is stored as it was given.
        let tolerance = match info.parameter {
            Parameter::Share(_) => 0.51 / run.world().grains.len() as f64,
            _ => 1e-12 * value.abs(),
        };
        let found = info.parameter.read(run.world()).unwrap().number();
        assert!(
            (found - value).abs() <= tolerance,
            "{}: {found} for {value}",
            info.parameter
        );
        // A command takes no time: what it changes of stored energy is its own work. Rounding of sums of the ledger's terms.
        let turnover = before.gravity_work.abs() + before.kinetic + before.elastic + after.initial;
        let jump = (after.residual() - before.residual()).abs();
        assert!(
            jump <= 1e-12 * turnover.max(1e-6),
            "{}: residual jumps by {jump} J",
            info.parameter
        );
    }
}

#[test]
fn settled_bed_rests() {
    let mut scene = scene("small-drum");
    if let SceneContainer::Drum { speed, .. } = &mut scene.container {
        *speed = 0.0;
    }
    let mut run = run_of(&scene);
    let start = run.world().clone();
    run.advance_to(start.clock.step_at(0.5)).unwrap();
    let moved = start
        .grains
        .position
        .iter()
        .zip(&run.world().grains.position);
    let furthest = moved.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    // Creep of a bed whose kinetic energy settled below 1e-9 m g r: far below the overlaps of about 1e-5 m.
    assert!(
        furthest < 1e-6,
        "some grain crept {furthest:e} m in half a second"
    );
}

/// A flat box of as many grains as make a large bed, soft ones that allow long steps.
#[test]
fn settled_large_bed_rests() {
    let text = "(title: \"Flat box\", materials: {\"gel\": (youngs_modulus: 1e6, friction: 0.4, rolling_friction: 0.01)}, \
                container: Box(min: (0, 0, 0), max: (0.25, 0.03, 0.25), material: \"gel\"), \
                grains: Fill(count: 10000, species: [(radius_mm: 1.5, material: \"gel\")]))";
    let scene = Scene::parse("flat-box.ron", text).unwrap();
    let (mut run, _) = prepared(&scene, 2, BedStore::none());
    let start = run.world().clone();
    run.advance_to(start.clock.step_at(0.02)).unwrap();
    let places = start.grains.position.iter();
    let mut moved: Vec<f64> = (places.zip(&run.world().grains.position))
        .map(|(a, b)| a.distance(*b))
        .collect();
    moved.sort_by(f64::total_cmp);
    // All but the one that is not waited for: as far as grains creep at the kinetic energy of a bed at rest, 1e-9 m g r.
    let crept = moved[moved.len() - 2];
    assert!(crept < 1e-5, "a grain crept {crept:e} m in 20 ms");
}

#[test]
fn threads_do_not_show_in_a_bed() {
    let scene = scene("small-drum");
    let settled = |threads| prepared(&scene, threads, BedStore::none()).0.world().hash();
    let one = settled(1);
    assert_eq!(settled(2), one);
    assert_eq!(settled(3), one);
}

#[test]
fn kept_bed_is_the_settled_bed_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene("small-drum");
    let beds = BedStore::at(folder.path());
    let (settled, warnings) = prepared(&scene, 2, beds.clone());
    assert_eq!(warnings, [""; 0]);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    let (kept, _) = prepared(&scene, 1, beds);
    assert_eq!(kept.world(), settled.world());
}

#[test]
fn paper_scenes_open_on_shipped_beds() {
    for name in ["dry-r3", "dry-r2", "dry-r1.25"] {
        let scene = Arc::new(scene(name));
        let time_step = advise(&scene).time_step;
        let mut preparation = Preparation::new(scene, time_step, 1, BedStore::shipped());
        assert!(
            matches!(preparation.advance(), Ok(Prepared::Ready(_))),
            "the bed of {name} is stale: make it anew with `cargo run --release -- bed {name} --out assets/beds/{name}.bed`"
        );
    }
}

#[test]
fn shipped_bed_is_the_settled_bed_to_the_bit() {
    let scene = scene("dry-r3");
    let (shipped, _) = prepared(&scene, 1, BedStore::shipped());
    let (settled, _) = prepared(&scene, 2, BedStore::none());
    assert_eq!(
        shipped.world().hash(),
        settled.world().hash(),
        "settling or the solver's arithmetic changed: raise the beds' format and make the files in assets/beds anew"
    );
}

#[test]
fn damaged_bed_is_settled_anew() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene("small-drum");
    let beds = BedStore::at(folder.path());
    let (settled, _) = prepared(&scene, 1, beds.clone());
    let path = std::fs::read_dir(folder.path())
        .unwrap()
        .next()
        .unwrap()
        .unwrap()
        .path();
    let whole = std::fs::read(&path).unwrap();
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 1;
    for damaged in [&flipped[..], &whole[..whole.len() / 2], &whole[..10], &[]] {
        std::fs::write(&path, damaged).unwrap();
        let (again, _) = prepared(&scene, 1, beds.clone());
        assert_eq!(again.world(), settled.world());
        assert_eq!(
            std::fs::read(&path).unwrap(),
            whole,
            "the bed is kept whole again"
        );
    }
}

#[test]
fn bed_belongs_to_its_scene_alone() {
    let folder = tempfile::tempdir().unwrap();
    let beds = BedStore::at(folder.path());
    let mut scene = scene("small-drum");
    prepared(&scene, 1, beds.clone());
    scene.seed += 1;
    prepared(&scene, 1, beds.clone());
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        2,
        "another seed, another bed"
    );
    if let SceneContainer::Drum { speed, .. } = &mut scene.container {
        *speed *= 2.0;
    }
    prepared(&scene, 1, beds);
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        2,
        "drums settle at rest"
    );
}

#[test]
fn bed_that_cannot_be_kept_is_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "in the way").unwrap();
    let (run, warnings) = prepared(&scene("small-drum"), 1, BedStore::at(file.join("beds")));
    assert!(
        warnings[0].contains("cannot keep the settled bed"),
        "{warnings:?}"
    );
    assert_eq!(run.world().clock.step, 0);
}

fn opened(scene: Scene, driver: DriverKind) -> Lab {
    let options = Options {
        driver,
        threads: 1,
        autoplay: true,
        speed: f64::INFINITY,
        beds: shared_beds(),
        shows_settling: false,
        script: Vec::new(),
        memory: 0,
    };
    Lab::open(scene, options)
}

/// Ticks until `done`, a minute of ticks at most.
fn tick_until(simulation: &mut Lab, done: impl Fn(&Lab) -> bool) {
    for _ in 0..60_000 {
        if done(simulation) {
            return;
        }
        simulation.tick(TICK);
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("still {:?} after a minute", simulation.status());
}

fn step(simulation: &Lab) -> Option<u64> {
    simulation.world().map(|world| world.clock.step)
}

fn held_at(simulation: &mut Lab, at: u64) {
    simulation.send(LabCommand::Hold(Some(at)));
    tick_until(simulation, |simulation| step(simulation) == Some(at));
}

#[test]
fn drivers_do_not_show_in_a_run() {
    let outcome = |driver| {
        let mut simulation = opened(scene("small-drum"), driver);
        held_at(&mut simulation, 400);
        simulation.send(friction(0.1));
        held_at(&mut simulation, 1300);
        (
            simulation.world().unwrap().hash(),
            simulation.commands().to_vec(),
            bits(simulation.series()),
        )
    };
    assert_eq!(outcome(DriverKind::Inline), outcome(DriverKind::Thread));
}

#[test]
fn player_pauses_steps_and_goes_on() {
    for driver in [DriverKind::Inline, DriverKind::Thread] {
        let mut simulation = opened(scene("small-drum"), driver);
        held_at(&mut simulation, 10);
        simulation.send(Command::Pause);
        simulation.send(LabCommand::Hold(None));
        tick_until(&mut simulation, |s| *s.status() == Status::Paused);
        let held = step(&simulation).unwrap();
        simulation.send(Command::Step(3));
        tick_until(&mut simulation, |s| {
            step(s) == Some(held + 3) && *s.status() == Status::Paused
        });
        simulation.send(Command::Play);
        tick_until(&mut simulation, |s| step(s) > Some(held + 100));
        assert_eq!(*simulation.status(), Status::Running);
    }
}

#[test]
fn value_asked_for_shows_before_it_is_carried_out() {
    let mut simulation = opened(scene("small-drum"), DriverKind::Inline);
    held_at(&mut simulation, 5);
    let parameter = Parameter::Friction("glass".into(), "drum".into());
    assert_eq!(simulation.value(&parameter), Some(0.30.into()));
    simulation.send(set(parameter.clone(), 0.1));
    assert_eq!(simulation.value(&parameter), Some(0.1.into()));
    tick_until(&mut simulation, |s| !s.commands().is_empty());
    assert_eq!(simulation.value(&parameter), Some(0.1.into()));
    assert_eq!(simulation.value(&Parameter::Share("nobody".into())), None);
}

#[test]
fn simulated_time_follows_the_clock_at_the_speed_asked_for() {
    let mut simulation = opened(scene("small-drum"), DriverKind::Inline);
    held_at(&mut simulation, 0);
    simulation.send(Command::Speed(0.5));
    simulation.send(LabCommand::Hold(None));
    let ticks = 20;
    for _ in 0..ticks {
        simulation.tick(TICK);
    }
    let time = simulation.world().unwrap().time();
    let asked = 0.5 * TICK.as_secs_f64() * f64::from(ticks);
    // Whole steps: less than one is owed. A tick that a loaded machine cuts short may leave more undone, never less.
    assert!(time <= asked && time > 0.0, "{time} s for {asked} s");
}

#[test]
fn absurd_state_is_a_fault_and_the_last_good_state_stays() {
    let mut scene = scene("bouncing-grain");
    scene.time_step = TimeStep::Given(1e-3);
    if let SceneGrains::List(grains) = &mut scene.grains {
        let fast: &mut SceneGrain = &mut grains[0];
        fast.velocity.y = -1000.0;
    }
    let mut simulation = opened(scene, DriverKind::Inline);
    tick_until(&mut simulation, |s| {
        matches!(s.status(), Status::Faulted(_))
    });
    let world = simulation.world().unwrap();
    assert!(world.grains.position.iter().all(|x| x.is_finite()));
    simulation.send(Command::Reset);
    tick_until(&mut simulation, |s| *s.status() == Status::Paused);
    assert_eq!(step(&simulation), Some(0));
}

#[test]
fn grains_that_overlap_at_the_start_push_from_the_start() {
    let mut scene = scene("two-grains");
    scene.gravity = DVec3::ZERO;
    let SceneGrains::List(grains) = &mut scene.grains else {
        panic!("no list");
    };
    grains.truncate(2);
    let radius = grains[0].radius;
    for (grain, side) in grains.iter_mut().zip([-1.0, 1.0]) {
        grain.position = DVec3::X * side * 0.99 * radius;
        grain.velocity = DVec3::ZERO;
        grain.spin = DVec3::ZERO;
    }
    let name = grains[0].material.clone();
    let material = scene.material(&name).unwrap().1.clone();
    let run = run_of(&scene);
    // Hertz with E* = E / 2 (1 - ν²) and r* = r / 2, exact to rounding.
    let modulus = material.youngs_modulus / (2.0 * (1.0 - material.poisson_ratio.powi(2)));
    let (reduced, overlap) = (radius / 2.0, 0.02 * radius);
    let force = 4.0 / 3.0 * modulus * reduced.sqrt() * overlap.powf(1.5);
    assert!((run.world().grains.force[1].x / force - 1.0).abs() < 1e-9);
    let ledger = EnergyLedger::of(run.world());
    assert_eq!(ledger.initial, ledger.elastic);
    assert!((ledger.elastic / (0.4 * force * overlap) - 1.0).abs() < 1e-9);
}

#[test]
fn closing_ends_a_thread_that_is_still_settling() {
    let mut scene = scene("dry-r1.25");
    scene.seed += 1;
    drop(opened(scene, DriverKind::Thread));
}

#[test]
fn a_bed_that_settles_is_seen_to_fall() {
    let mut scene = scene("small-drum");
    scene.seed += 1;
    let step = advise(&scene).time_step;
    let mut preparation = Preparation::new(Arc::new(scene), step, 1, BedStore::none());
    let mut heights = Vec::new();
    let bed = loop {
        if let Prepared::Ready(run) = preparation.advance().unwrap() {
            break run;
        }
        heights.extend(preparation.settling().map(mean_height));
    };
    let rest = mean_height(bed.world());
    assert!(heights[0] - rest > 0.005, "{} {rest}", heights[0]);
    assert!((heights.last().unwrap() - rest).abs() < 1e-6);
}

fn mean_height(world: &World) -> f64 {
    let heights = world.grains.position.iter().map(|x| x.y);
    heights.sum::<f64>() / world.grains.len() as f64
}

#[test]
fn a_bed_that_settles_can_be_watched() {
    let mut scene = scene("dry-r1.25");
    scene.seed += 1;
    let count = scene.grain_count();
    let mut lab = Lab::open(scene, settling_options(true));
    let world = loop {
        lab.tick(TICK);
        assert!(lab.world().is_none(), "at rest before it was seen");
        if let Some(world) = lab.settling() {
            break world;
        }
    };
    assert!(matches!(lab.status(), Status::Preparing { .. }));
    assert!(world.contacts.is_empty());
    assert_eq!(world.grains.len(), count);
}

#[test]
fn looking_at_a_bed_that_settles_changes_nothing() {
    let mut scene = scene("small-drum");
    scene.seed += 1;
    let hash = |shown: bool| {
        let mut lab = Lab::open(scene.clone(), settling_options(shown));
        while lab.world().is_none() {
            lab.tick(TICK);
            assert!(shown || lab.settling().is_none());
        }
        assert!(lab.settling().is_none(), "the run takes its place");
        lab.world().unwrap().hash()
    };
    assert_eq!(hash(true), hash(false));
}

fn settling_options(shows_settling: bool) -> Options {
    Options {
        driver: DriverKind::Inline,
        threads: 1,
        beds: BedStore::none(),
        shows_settling,
        ..Options::window()
    }
}

#[test]
fn a_minute_of_running_is_worth_a_question_even_without_a_change() {
    let mut simulation = Lab::open(
        scene("bouncing-grain"),
        Options {
            driver: DriverKind::Inline,
            threads: 1,
            autoplay: false,
            speed: 0.01,
            beds: BedStore::none(),
            shows_settling: false,
            script: Vec::new(),
            memory: 0,
        },
    );
    while simulation.world().is_none() {
        simulation.tick(TICK);
    }
    simulation.send(LabCommand::Hold(Some(10)));
    simulation.send(Command::Play);
    simulation.tick(TICK);
    assert!(!simulation.is_unsaved());
    simulation.tick(Duration::from_secs(61));
    assert!(simulation.is_unsaved());
}
