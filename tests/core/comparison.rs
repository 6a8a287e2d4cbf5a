//! Claims about two runs side by side: always shown at the same step, each the run that it would be
//! by itself.

use crate::runs::{bits, prepared, set};
use crate::timeline::{Explored, column_lab, wet_lab};
use grainfall::lab::{DriverKind, Half, Lab, LabCommand, Options, RunView, Status};
use grainfall::run::{BedStore, Command, Parameter, Session, StampedCommand};
use grainfall::scene::{Scene, TimeStep};
use grainfall::world::World;
use std::sync::Arc;
use std::time::Duration;

const TICK: Duration = Duration::from_micros(15_625);

fn opened(lab: &Explored, driver: DriverKind) -> Lab {
    open(lab.scene.clone(), lab.beds.clone(), driver)
}

fn open(scene: Scene, beds: BedStore, driver: DriverKind) -> Lab {
    let options = Options {
        driver,
        threads: 2,
        autoplay: false,
        speed: f64::INFINITY,
        beds,
        shows_settling: false,
        script: Vec::new(),
        memory: 1 << 28,
    };
    let mut simulation = Lab::open(scene, options);
    until(&mut simulation, |s| *s.status() == Status::Paused);
    simulation
}

/// Ticks until `done`; what is shown of both runs is of the same step all the way.
fn until(simulation: &mut Lab, done: impl Fn(&Lab) -> bool) {
    for _ in 0..60_000 {
        simulation.tick(TICK);
        let right = (simulation.comparison()).and_then(|pair| pair.right.world().map(step_of));
        if let Some(right) = right {
            assert_eq!(simulation.world().map(step_of), Some(right));
        }
        if done(simulation) {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("still {:?} after a minute", simulation.status());
}

fn step_of(world: &Arc<World>) -> u64 {
    world.clock.step
}

fn carry_out(simulation: &mut Lab, command: impl Into<LabCommand>) {
    simulation.send(command);
    until(simulation, |s| {
        s.has_answered() && *s.status() == Status::Paused
    });
}

fn compare(parameter: &Parameter, value: f64) -> LabCommand {
    LabCommand::Compare {
        parameter: parameter.clone(),
        value: value.into(),
    }
}

/// Another value for the right run.
fn set_right(parameter: &Parameter, value: f64) -> LabCommand {
    LabCommand::SetIn {
        half: Half::Right,
        parameter: parameter.clone(),
        value: value.into(),
    }
}

fn start(simulation: &mut Lab, parameter: &Parameter, value: f64) {
    simulation
        .check_comparison(parameter, value.into())
        .unwrap();
    simulation.send(compare(parameter, value));
    until(simulation, |s| {
        s.comparison().is_some() && *s.status() == Status::Paused
    });
    assert_eq!(simulation.world().map(step_of), Some(0));
}

/// What was changed, but for the parameter that is compared.
fn common(commands: &[StampedCommand], parameter: &Parameter) -> Vec<(u64, Command)> {
    let others = commands
        .iter()
        .filter(|c| !matches!(&c.command, Command::Set { parameter: own, .. } if own == parameter));
    others.map(|c| (c.step, c.command.clone())).collect()
}

/// Claims that `simulation` is what a run by itself becomes that has these `values` at its start
/// and is changed as it was.
fn is_a_lone_run(simulation: &RunView, lab: &Explored, values: &[Command]) {
    let world = simulation.world().unwrap();
    let mut alone = prepared(&lab.scene, 1, lab.beds.clone()).0;
    for value in values {
        alone.apply(value.clone()).unwrap();
    }
    for change in simulation.commands().iter().filter(|c| c.step > 0) {
        alone.advance_to(change.step).unwrap();
        alone.apply(change.command.clone()).unwrap();
    }
    alone.advance_to(step_of(world)).unwrap();
    assert_eq!(alone.world().hash(), world.hash());
    assert_eq!(bits(alone.series()), bits(simulation.series()));
}

/// Both halves of a pair that runs, is changed on the way, goes back and branches.
fn goes_its_own_way(
    lab: &Explored,
    parameter: &Parameter,
    values: [f64; 2],
    change: &Command,
    driver: DriverKind,
) {
    let mut simulation = opened(lab, driver);
    // What came before is left behind; its values are taken along.
    carry_out(&mut simulation, Command::Step(3 * lab.unit));
    simulation.send(set(Parameter::Gravity, 9.0));
    carry_out(&mut simulation, set(parameter.clone(), values[0]));
    start(&mut simulation, parameter, values[1]);
    assert_eq!(simulation.value(parameter), Some(values[0].into()));
    assert_eq!(
        simulation.half(Half::Right).value(parameter),
        Some(values[1].into())
    );

    // Changed while both go on, at a step that nobody chose.
    simulation.send(LabCommand::Hold(Some(12 * lab.unit)));
    simulation.send(Command::Play);
    until(&mut simulation, |s| {
        s.world().is_some_and(|w| step_of(w) > 4 * lab.unit)
    });
    simulation.send(change.clone());
    until(&mut simulation, |s| {
        s.world().map(step_of) == Some(12 * lab.unit)
    });
    carry_out(&mut simulation, Command::Pause);
    let right = simulation.half(Half::Right);
    let changes = common(simulation.commands(), parameter);
    assert_eq!(changes, common(right.commands(), parameter));
    assert!(changes.last().unwrap().0 > 4 * lab.unit, "{changes:?}");
    let at_the_start = |value| [set(Parameter::Gravity, 9.0), set(parameter.clone(), value)];
    is_a_lone_run(&simulation, lab, &at_the_start(values[0]));
    is_a_lone_run(right, lab, &at_the_start(values[1]));
    assert_ne!(
        simulation.world().map(|w| w.hash()),
        right.world().map(|w| w.hash())
    );

    // Back, and another way on from there; the ways that were left stay beside both.
    simulation.send(LabCommand::Hold(None));
    carry_out(&mut simulation, Command::Seek(2 * lab.unit));
    carry_out(&mut simulation, set(Parameter::Gravity, 12.0));
    simulation.send(set_right(parameter, 0.5 * (values[0] + values[1])));
    carry_out(&mut simulation, Command::Step(3 * lab.unit));
    assert_eq!(simulation.world().map(step_of), Some(5 * lab.unit));
    let right = simulation.half(Half::Right);
    is_a_lone_run(&simulation, lab, &at_the_start(values[0]));
    is_a_lone_run(right, lab, &at_the_start(values[1]));
    assert_eq!(
        right.value(parameter),
        Some((0.5 * (values[0] + values[1])).into())
    );
    assert_eq!(simulation.value(parameter), Some(values[0].into()));
    assert_eq!(right.past().kept.len(), 1);
    assert_eq!(right.past().kept[0].end.step, 12 * lab.unit);
}

#[test]
fn wet_halves_are_the_runs_that_they_would_be_alone() {
    for driver in [DriverKind::Inline, DriverKind::Thread] {
        let friction = Parameter::WetFriction("glass".into(), "glass".into());
        let change = set(friction, 0.2);
        goes_its_own_way(
            &wet_lab(),
            &Parameter::Viscosity,
            [1.01e-3, 1.41],
            &change,
            driver,
        );
    }
}

#[test]
fn halves_of_polyhedra_are_the_runs_that_they_would_be_alone() {
    let friction = Parameter::Friction("smooth".into(), "rough".into());
    let change = set(Parameter::Gravity, 11.0);
    goes_its_own_way(
        &column_lab(),
        &friction,
        [0.1, 0.7],
        &change,
        DriverKind::Thread,
    );
}

/// Hashes of both states.
fn hashes(simulation: &Lab) -> [String; 2] {
    Half::ALL.map(|half| {
        let world = simulation.half(half).world();
        world.unwrap().hash().to_string()
    })
}

/// A change of both halves and one of each alone, taken back one after the other and brought back
/// again.
fn is_taken_back_in_both(lab: &Explored, parameter: &Parameter, values: [f64; 4]) {
    let mut simulation = opened(lab, DriverKind::Thread);
    carry_out(&mut simulation, Command::Step(lab.unit));
    carry_out(&mut simulation, set(parameter.clone(), values[0]));
    start(&mut simulation, parameter, values[1]);
    assert_eq!(
        simulation.undo_and_redo(),
        [None; 2],
        "the pair begins with nothing"
    );
    let after_a_while = |simulation: &mut Lab| {
        carry_out(simulation, Command::Step(2 * lab.unit));
        hashes(simulation)
    };
    let mut states = vec![after_a_while(&mut simulation)];
    let changes: [&dyn Fn(&mut Lab); 3] = [
        &|simulation| simulation.send(set(Parameter::Gravity, 11.0)),
        &|simulation| simulation.send(set(parameter.clone(), values[2])),
        &|simulation| simulation.send(set_right(parameter, values[3])),
    ];
    for change in changes {
        change(&mut simulation);
        states.push(after_a_while(&mut simulation));
    }
    let end = states.pop().unwrap();
    for state in states.iter().rev() {
        assert!(simulation.undo_and_redo()[0].is_some());
        carry_out(&mut simulation, Command::Undo);
        assert_eq!(hashes(&simulation), *state);
    }
    assert_eq!(simulation.undo_and_redo()[0], None);
    carry_out(&mut simulation, Command::Undo);
    assert_eq!(hashes(&simulation), states[0], "nothing more to undo");
    assert_eq!(simulation.value(parameter), Some(values[0].into()));

    // Undone after two units of its own each, so each redo leads there.
    let ends = states[1..].iter().chain([&end]);
    for state in ends {
        carry_out(&mut simulation, Command::Redo);
        assert_eq!(hashes(&simulation), *state);
    }
    assert_eq!(simulation.undo_and_redo()[1], None);
    assert_eq!(
        simulation.half(Half::Right).value(parameter),
        Some(values[3].into())
    );
    let start = |value| [set(parameter.clone(), value)];
    is_a_lone_run(&simulation, lab, &start(values[0]));
    is_a_lone_run(simulation.half(Half::Right), lab, &start(values[1]));
}

#[test]
fn undo_and_redo_take_changes_back_in_both_halves() {
    let friction = Parameter::Friction("smooth".into(), "rough".into());
    is_taken_back_in_both(&column_lab(), &friction, [0.1, 0.7, 0.2, 0.5]);
    is_taken_back_in_both(&wet_lab(), &Parameter::Viscosity, [1.01e-3, 1.41, 0.1, 0.5]);
}

#[test]
fn a_change_of_one_half_in_the_past_begins_another_run_in_both() {
    let lab = wet_lab();
    let mut simulation = opened(&lab, DriverKind::Thread);
    start(&mut simulation, &Parameter::Viscosity, 1.41);
    carry_out(&mut simulation, Command::Step(2 * lab.unit));
    carry_out(&mut simulation, set(Parameter::Gravity, 11.0));
    carry_out(&mut simulation, Command::Step(2 * lab.unit));
    let left_behind = hashes(&simulation);
    carry_out(&mut simulation, Command::Seek(lab.unit));
    simulation.send(set_right(&Parameter::Viscosity, 0.5));
    carry_out(&mut simulation, Command::Step(3 * lab.unit));
    // What came after in one of them alone would be a second difference.
    for half in Half::ALL {
        assert_eq!(
            simulation.half(half).value(&Parameter::Gravity),
            Some(9.81.into())
        );
        assert_eq!(simulation.half(half).past().end.step, 4 * lab.unit);
    }
    is_a_lone_run(&simulation, &lab, &[]);
    is_a_lone_run(
        simulation.half(Half::Right),
        &lab,
        &[set(Parameter::Viscosity, 1.41)],
    );
    carry_out(&mut simulation, Command::Undo);
    assert_eq!(simulation.world().map(step_of), Some(lab.unit));
    carry_out(&mut simulation, Command::Seek(4 * lab.unit));
    assert_eq!(hashes(&simulation), left_behind);
}

#[test]
fn values_that_are_set_in_one_drag_are_one_change_of_both() {
    let lab = wet_lab();
    let mut simulation = opened(&lab, DriverKind::Thread);
    start(&mut simulation, &Parameter::Viscosity, 1.41);
    carry_out(&mut simulation, Command::Step(lab.unit));
    let before = hashes(&simulation);
    simulation.send(LabCommand::OpenChange);
    for gravity in [9.0, 8.0, 7.0] {
        simulation.send(set(Parameter::Gravity, gravity));
        simulation.send(set_right(&Parameter::Viscosity, 0.1 * gravity));
    }
    // What is refused changes nothing, in neither of them.
    simulation.send(set(Parameter::Gravity, -1.0));
    simulation.send(set_right(&Parameter::Viscosity, f64::NAN));
    simulation.send(LabCommand::CloseChange);
    carry_out(&mut simulation, Command::Step(lab.unit));
    assert_eq!(simulation.value(&Parameter::Gravity), Some(7.0.into()));
    carry_out(&mut simulation, Command::Undo);
    assert_eq!(hashes(&simulation), before);
    assert_eq!(simulation.undo_and_redo()[0], None);
}

#[test]
fn a_half_that_meets_a_fault_stops_the_other_where_it_stands() {
    let mut scene = Scene::open("bouncing-grain").unwrap();
    // A tenth of a radius a step: the falling grain is too fast after 30 ms, one without weight never.
    scene.time_step = TimeStep::Given(1e-3);
    let mut simulation = open(scene, BedStore::none(), DriverKind::Thread);
    start(&mut simulation, &Parameter::Gravity, 0.0);
    simulation.send(Command::Play);
    until(&mut simulation, |s| {
        matches!(s.status(), Status::Faulted(_))
    });
    until(&mut simulation, grainfall::lab::Lab::has_answered);
    let steps = Half::ALL.map(|half| simulation.half(half).world().map(step_of));
    assert_eq!(steps[0], steps[1]);
    carry_out(&mut simulation, Command::Seek(5));
    assert_eq!(simulation.half(Half::Right).world().map(step_of), Some(5));
}

#[test]
fn stopping_on_the_way_to_a_moment_stops_both_at_one() {
    let lab = wet_lab();
    let mut simulation = opened(&lab, DriverKind::Thread);
    start(&mut simulation, &Parameter::Viscosity, 1.41);
    carry_out(&mut simulation, Command::Step(10 * lab.unit));
    carry_out(&mut simulation, Command::Seek(0));
    simulation.send(Command::Seek(10 * lab.unit));
    until(&mut simulation, |s| {
        matches!(s.status(), Status::Seeking { .. }) || s.has_answered()
    });
    carry_out(&mut simulation, Command::Pause);
    let steps = Half::ALL.map(|half| simulation.half(half).world().map(step_of));
    assert_eq!(steps[0], steps[1]);
    is_a_lone_run_so_far(&simulation, &lab);
}

/// The same of a pair that does not show the end of what was recorded.
fn is_a_lone_run_so_far(simulation: &RunView, lab: &Explored) {
    let world = simulation.world().unwrap();
    let mut alone = prepared(&lab.scene, 1, lab.beds.clone()).0;
    alone.advance_to(step_of(world)).unwrap();
    assert_eq!(alone.world().hash(), world.hash());
}

#[test]
fn the_half_that_is_not_gone_on_with_stays_beside_the_other() {
    let lab = wet_lab();
    for keep in Half::ALL {
        let mut simulation = opened(&lab, DriverKind::Thread);
        start(&mut simulation, &Parameter::Viscosity, 1.41);
        carry_out(&mut simulation, Command::Step(4 * lab.unit));
        let hashes = Half::ALL.map(|half| simulation.half(half).world().unwrap().hash());
        simulation.send(LabCommand::EndComparison { keep });
        until(&mut simulation, |s| {
            s.has_answered() && s.past().kept.len() == 1 && *s.status() == Status::Paused
        });
        assert!(simulation.comparison().is_none());
        let state = |s: &Lab| s.world().unwrap().hash();
        assert_eq!(state(&simulation), hashes[keep.index()]);
        // The other one can be taken up again, and both go on as ever.
        carry_out(&mut simulation, Command::Return(0));
        assert_eq!(state(&simulation), hashes[1 - keep.index()]);
        carry_out(&mut simulation, Command::Step(lab.unit));
        let value = if keep == Half::Left {
            vec![set(Parameter::Viscosity, 1.41)]
        } else {
            vec![]
        };
        is_a_lone_run(&simulation, &lab, &value);
    }
}

#[test]
fn the_branches_of_both_halves_stay_when_a_comparison_ends() {
    let lab = wet_lab();
    let mut simulation = opened(&lab, DriverKind::Thread);
    start(&mut simulation, &Parameter::Viscosity, 1.41);
    carry_out(&mut simulation, Command::Step(2 * lab.unit));
    let left_behind = hashes(&simulation);
    carry_out(&mut simulation, Command::Seek(lab.unit));
    simulation.send(set(Parameter::Gravity, 11.0));
    carry_out(&mut simulation, Command::Step(2 * lab.unit));
    let present = hashes(&simulation);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pair.grainfall");
    simulation.send(LabCommand::Save {
        path: path.clone(),
        look: String::new(),
    });
    until(&mut simulation, |s| !s.is_saving() && s.has_answered());
    simulation.send(LabCommand::EndComparison { keep: Half::Left });
    // The left run's own other branch, then the right run's, then the right run.
    until(&mut simulation, |s| {
        s.has_answered() && s.past().kept.len() == 3
    });
    let resumed = Lab::resume(
        Session::read(&path).unwrap(),
        Options {
            autoplay: false,
            speed: f64::INFINITY,
            ..Options::default()
        },
    );
    for mut simulation in [simulation, resumed] {
        until(&mut simulation, |s| *s.status() == Status::Paused);
        assert_eq!(simulation.past().kept.len(), 3);
        let expected = [&left_behind[0], &left_behind[1], &present[1]];
        for (index, hash) in expected.into_iter().enumerate() {
            // What is left for another branch goes to the end of the list.
            carry_out(&mut simulation, Command::Return(0));
            assert_eq!(hashes(&simulation)[0], *hash, "{index}");
        }
    }
}

#[test]
fn a_session_saved_in_a_comparison_holds_both_runs() {
    let lab = wet_lab();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pair.grainfall");
    let mut simulation = opened(&lab, DriverKind::Thread);
    start(&mut simulation, &Parameter::Viscosity, 1.41);
    carry_out(&mut simulation, Command::Step(4 * lab.unit));
    for _ in 0..2 {
        simulation.send(LabCommand::Save {
            path: path.clone(),
            look: String::new(),
        });
        until(&mut simulation, |s| !s.is_saving());
    }
    assert!(
        simulation
            .take_saved()
            .iter()
            .all(|file| file.outcome.is_ok())
    );
    assert!(simulation.past().kept.is_empty(), "the pair is as it was");
    let mut timeline = Session::read(&path).unwrap().into_timeline(1, 1 << 28);
    let hashes = Half::ALL.map(|half| simulation.half(half).world().unwrap().hash());
    assert_eq!(timeline.run().world().hash(), hashes[0]);
    assert_eq!(timeline.kept().len(), 1);
    timeline.take_up(0);
    assert_eq!(timeline.destination(), None, "its end is in the file");
    assert_eq!(timeline.run().world().hash(), hashes[1]);
}

#[test]
fn what_a_pair_cannot_do_is_refused_in_words() {
    let lab = wet_lab();
    let mut simulation = opened(&lab, DriverKind::Inline);
    let viscosity = Parameter::Viscosity;
    let refused = simulation
        .check_comparison(&viscosity, 1e9.into())
        .unwrap_err();
    assert!(refused.contains("viscosity"), "{refused}");
    let before = simulation.warnings().len();
    carry_out(&mut simulation, compare(&viscosity, 1e9));
    assert_eq!(simulation.warnings()[before], refused);
    assert!(simulation.comparison().is_none());
    start(&mut simulation, &viscosity, 1.41);
    let refused = simulation
        .check_comparison(&viscosity, 0.5.into())
        .unwrap_err();
    carry_out(&mut simulation, compare(&viscosity, 0.5));
    assert_eq!(simulation.warnings()[before + 1], refused);
    carry_out(&mut simulation, Command::Return(0));
    assert!(simulation.warnings()[before + 2].contains("end the comparison"));
    let preparing = Options {
        driver: DriverKind::Inline,
        beds: BedStore::none(),
        ..Options::window()
    };
    let early = Lab::open(lab.scene.clone(), preparing);
    assert!(early.check_comparison(&viscosity, 1.41.into()).is_err());
}

#[test]
fn a_pair_goes_no_faster_than_asked() {
    let lab = wet_lab();
    let mut simulation = opened(&lab, DriverKind::Inline);
    simulation.send(Command::Speed(0.01));
    start(&mut simulation, &Parameter::Viscosity, 1.41);
    simulation.send(Command::Play);
    for _ in 0..64 {
        simulation.tick(TICK);
    }
    let time = simulation.world().unwrap().time();
    // A second at a hundredth of real time; the first tick or two hand nothing out.
    assert!((0.008..=0.0101).contains(&time), "{time}");
}
