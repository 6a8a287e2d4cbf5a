//! Claims about a time step that a change makes too long: it is told, shortened by a recorded
//! command, taken back and computed again to the bit.

use crate::runs::{prepared, set};
use crate::timeline::{arrive, change, go_on, hash};
use grainfall::lab::{DriverKind, Half, Lab, LabCommand, Options, Status};
use grainfall::physics::{LIQUID_CASES, LiquidCase};
use grainfall::run::{
    BedStore, Changed, Command, CommandError, Parameter, Run, RunRecord, Script, ScriptedCommand,
    Session, StepTimes, Timeline,
};
use grainfall::runner::Verdict;
use grainfall::scene::{Scene, TimeStep};
use grainfall::solver::advise;
use std::time::Duration;

const PLENTY: usize = 1 << 28;

/// Three of the paper's finest grains in a drum with its liquid of this number.
fn drum(case: u8, time_step: TimeStep) -> Scene {
    let text = format!(
        r#"(
        title: "Three wet grains",
        materials: {{
            "glass": (youngs_modulus: 63e6, poisson_ratio: 0.21, density: 2500),
            "drum": (youngs_modulus: 12e6, poisson_ratio: 0.35),
        }},
        container: Drum(radius_mm: 15, width_mm: 9, speed_rpm: 5, material: "drum"),
        grains: List([
            (position: (0, -0.01, 0), radius_mm: 1.25, material: "glass"),
            (position: (0.0026, -0.01, 0), radius_mm: 1.25, material: "glass"),
            (position: (-0.0026, -0.0101, 0), radius_mm: 1.25, material: "glass"),
        ]),
        liquid: (case: {case}, volume_ml: 0.0005),
    )"#
    );
    let mut scene = Scene::parse("three wet grains", &text).unwrap();
    scene.time_step = time_step;
    scene
}

fn run(time_step: TimeStep) -> Run {
    prepared(&drum(1, time_step), 1, BedStore::none()).0
}

fn step_of(timeline: &Timeline) -> f64 {
    timeline.run().world().clock.time_step
}

fn case(number: u8) -> &'static LiquidCase {
    LIQUID_CASES
        .iter()
        .find(|case| case.number == number)
        .unwrap()
}

/// What makes the liquid one of the paper's.
fn liquid(number: u8) -> [Command; 3] {
    let case = case(number);
    [
        set(Parameter::Viscosity, case.viscosity),
        set(Parameter::SurfaceTension, case.surface_tension()),
        set(Parameter::ContactAngle, case.contact_angle()),
    ]
}

/// The steps [s] of the same drum that has water or glycerol from the start.
fn steps() -> (f64, f64) {
    let [water, glycerol] = [1, 7].map(|case| advise(&drum(case, TimeStep::Automatic)).time_step);
    assert!((water / 8.45e-6 - 1.0).abs() < 1e-3 && (glycerol / 6.567e-6 - 1.0).abs() < 1e-3);
    (water, glycerol)
}

#[test]
fn glycerol_set_live_is_told_and_the_shorter_step_is_recorded_undone_and_verified() {
    let (water, glycerol) = steps();
    let mut timeline = Timeline::new(run(TimeStep::Automatic), PLENTY);
    go_on(&mut timeline, 400);
    assert_eq!(timeline.run().advice().warning, None);
    for (index, command) in liquid(7).into_iter().enumerate() {
        timeline.change(command, index > 0).unwrap();
    }
    let advice = timeline.run().advice();
    assert_eq!(
        advice.time_step, water,
        "nothing changes the step by itself"
    );
    assert_eq!(advice.limits[0].name, "lubrication");
    assert_eq!(advice.largest().to_bits(), glycerol.to_bits());
    assert!((advice.excess().unwrap() - (water / glycerol - 1.0)).abs() < 1e-12);

    change(&mut timeline, set(Parameter::TimeStep, advice.largest()));
    assert_eq!(timeline.run().advice().warning, None);
    let changed_at = timeline.run().world().time();
    assert_eq!(changed_at, 400.0 * water);
    go_on(&mut timeline, 900);
    let end = hash(&timeline);
    let time = timeline.run().world().time();
    assert!((time - (400.0 * water + 500.0 * glycerol)).abs() < 1e-12);
    let times = StepTimes::new(water, timeline.run().commands());
    assert_eq!(times.time_at(900), time);
    assert_eq!((times.step_at(time), times.step_at(changed_at)), (900, 400));
    assert_eq!(times.step_at(0.5 * changed_at), 200);

    timeline.seek(500);
    arrive(&mut timeline);
    assert_eq!(step_of(&timeline), glycerol);
    timeline.seek(300);
    arrive(&mut timeline);
    assert_eq!(step_of(&timeline), water);
    timeline.seek(900);
    arrive(&mut timeline);
    assert_eq!(hash(&timeline), end);

    let what = Some(Changed::Parameter(Parameter::TimeStep));
    assert_eq!(timeline.past().undo, what);
    timeline.undo();
    arrive(&mut timeline);
    assert_eq!(step_of(&timeline), water);
    assert!(timeline.run().advice().excess().is_some());
    timeline.redo();
    arrive(&mut timeline);
    assert_eq!(hash(&timeline), end);

    is_verified(&timeline);
    timeline.reset();
    assert_eq!(step_of(&timeline), glycerol, "a reset keeps what was set");
    assert_eq!(timeline.run().world().time(), 0.0);
    go_on(&mut timeline, 100);
    is_verified(&timeline);
}

/// Saves the timeline, opens it again and computes it again.
fn is_verified(timeline: &Timeline) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("kept.grainfall");
    Session::of("wet", timeline).write(&path).unwrap();
    let same = Session::read(&path).unwrap().into_timeline(1, PLENTY);
    assert_eq!(hash(&same), hash(timeline));
    let record = RunRecord::read(&path).unwrap();
    let verdict = record
        .verify(2, BedStore::none(), &mut (), &|| false)
        .unwrap();
    assert_eq!(verdict, Verdict::Same);
}

#[test]
fn step_that_follows_its_limit_changes_with_it_and_is_recorded() {
    let (water, glycerol) = steps();
    let mut timeline = Timeline::new(run(TimeStep::Following), PLENTY);
    assert_eq!(step_of(&timeline), water);
    go_on(&mut timeline, 300);
    change(&mut timeline, set(Parameter::Gravity, 5.0));
    assert_eq!(timeline.run().commands().len(), 1, "no limit moved");
    go_on(&mut timeline, 400);
    change(&mut timeline, set(Parameter::Viscosity, 1.41));
    let commands = timeline.run().commands();
    assert_eq!(commands[2].command, set(Parameter::TimeStep, glycerol));
    assert_eq!((commands[2].step, commands.len()), (400, 3));
    assert_eq!(
        timeline.branch().history.changes(),
        [0, 1],
        "both are one change"
    );
    go_on(&mut timeline, 700);
    change(&mut timeline, set(Parameter::Viscosity, 1.01e-3));
    assert_eq!(step_of(&timeline), water, "and back");
    go_on(&mut timeline, 900);
    let end = hash(&timeline);
    for expected in [glycerol, water] {
        timeline.undo();
        arrive(&mut timeline);
        assert_eq!(step_of(&timeline), expected);
    }
    for _ in 0..2 {
        timeline.redo();
        arrive(&mut timeline);
    }
    assert_eq!(hash(&timeline), end);
    for step in [350, 650, 900] {
        timeline.seek(step);
        arrive(&mut timeline);
    }
    assert_eq!(hash(&timeline), end);
    assert_eq!(timeline.run().commands().len(), 5, "nothing is said twice");
    is_verified(&timeline);

    // The list of commands says all: a run whose step follows nothing comes to the same bits.
    let list: Vec<ScriptedCommand> = timeline.run().commands().iter().map(Into::into).collect();
    for time_step in [TimeStep::Automatic, TimeStep::Following] {
        let mut again = run(time_step);
        let script = Script::new(&list, &again.world().clock).unwrap();
        again.schedule(script).unwrap();
        again.advance_to(900).unwrap();
        assert_eq!(again.world().hash(), end);
        assert_eq!(again.commands(), timeline.run().commands());
    }
}

#[test]
fn commands_for_a_time_keep_it_when_the_step_follows_its_limit() {
    let at = |time: f64, command| ScriptedCommand {
        step: None,
        time: Some(time),
        command,
    };
    let list = [
        at(2e-3, set(Parameter::Viscosity, 1.41)),
        at(4e-3, set(Parameter::Gravity, 5.0)),
        at(6e-3, set(Parameter::Gravity, 9.0)),
    ];
    let run = run(TimeStep::Following);
    let script = Script::new(&list, &run.world().clock).unwrap();
    let mut timeline = Timeline::new(run, PLENTY);
    timeline.schedule(script).unwrap();
    go_on(&mut timeline, 1000);
    let end = hash(&timeline);
    let gravity: Vec<f64> = timeline
        .run()
        .commands()
        .iter()
        .filter(|stamped| matches!(&stamped.command, Command::Set { parameter, .. } if *parameter == Parameter::Gravity))
        .map(|stamped| stamped.time)
        .collect();
    let step = step_of(&timeline);
    assert_eq!(step, steps().1);
    for (found, wanted) in gravity.iter().zip([4e-3, 6e-3]) {
        assert!((wanted - 1e-12..wanted + step).contains(found), "{found}");
    }
    assert_eq!(gravity.len(), 2);
    timeline.seek(100);
    arrive(&mut timeline);
    timeline.seek(1000);
    arrive(&mut timeline);
    assert_eq!(hash(&timeline), end);
    is_verified(&timeline);
}

#[test]
fn step_that_is_none_is_refused() {
    let mut run = run(TimeStep::Automatic);
    for value in [0.0, -1e-6, f64::NAN, f64::INFINITY] {
        let refused = run.apply(set(Parameter::TimeStep, value)).unwrap_err();
        assert!(
            matches!(refused, CommandError::OutOfRange { .. }),
            "{refused}"
        );
    }
    assert_eq!(
        Parameter::try_from("time-step".to_owned()),
        Ok(Parameter::TimeStep)
    );
}

#[test]
fn two_runs_side_by_side_keep_one_step_and_one_time() {
    let (water, glycerol) = steps();
    let options = Options {
        driver: DriverKind::Inline,
        threads: 1,
        autoplay: false,
        speed: f64::INFINITY,
        beds: BedStore::none(),
        shows_settling: false,
        script: Vec::new(),
        memory: PLENTY,
    };
    let mut pair = Lab::open(drum(1, TimeStep::Following), options);
    stand(&mut pair);
    let refused = pair.check_comparison(&Parameter::TimeStep, 1e-6.into());
    assert!(refused.unwrap_err().contains("same time step"));
    pair.send(LabCommand::Compare {
        parameter: Parameter::Gravity,
        value: 5.0.into(),
    });
    stand(&mut pair);
    assert!(pair.comparison().is_some());
    for command in [
        Command::Step(100),
        set(Parameter::Viscosity, 1.41),
        Command::Step(100),
    ] {
        pair.send(command);
        stand(&mut pair);
    }
    let clocks = |pair: &Lab| Half::ALL.map(|half| pair.half(half).world().unwrap().clock);
    let [left, right] = clocks(&pair);
    assert_eq!((left, left.time_step), (right, water));
    for half in Half::ALL {
        assert!(pair.half(half).advice().excess().is_some());
        assert!(
            pair.half(half)
                .warnings()
                .iter()
                .any(|warning| warning.contains("lubrication"))
        );
    }
    pair.send(set(Parameter::TimeStep, glycerol));
    pair.send(Command::Step(100));
    stand(&mut pair);
    let [left, right] = clocks(&pair);
    assert_eq!((left, left.time_step, left.step), (right, glycerol, 300));
    assert!(
        Half::ALL
            .iter()
            .all(|half| pair.half(*half).advice().excess().is_none())
    );
}

/// Lets a simulation come to a stand.
fn stand(simulation: &mut Lab) {
    for _ in 0..10_000 {
        simulation.tick(Duration::from_millis(16));
        if simulation.has_answered() && *simulation.status() == Status::Paused {
            return;
        }
    }
    panic!("still {:?}", simulation.status());
}
