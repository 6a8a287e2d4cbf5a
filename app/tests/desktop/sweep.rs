//! Claims about parameter sweeps in the window: asked for beside a parameter, run in the background,
//! looked at as they go, stopped and gone on with.

use crate::window_of_panels::{Window, asked, friction, prepared, press, set, type_number};
use crate::windowless::{app, ask, until};
use bevy::prelude::*;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use grainfall::measure::{Measure, ResultKey};
use grainfall::output::CHECKPOINT;
use grainfall::parameters::Parameter;
use grainfall::run::{BedStore, RunRecord};
use grainfall::runner::{Part, Verdict};
use grainfall::sweep::{self, CaseResult, Question, StatedSweep, Sweep, SweepEnding, ValueRange};
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{Dock, Request, SweepAct, SweepDesk, SweepSeen};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Waits until the sweep on `desk` has ended.
fn ended(desk: &SweepDesk) -> SweepSeen {
    for _ in 0..60_000 {
        match desk.seen() {
            Some(seen) if !seen.is_running() => return seen,
            _ => std::thread::sleep(Duration::from_millis(2)),
        }
    }
    panic!("the sweep goes on for ever");
}

/// Three values of the friction of three grains that fall for 50 ms.
fn question() -> Question {
    Question {
        scene: prepared().scene().clone(),
        changed: vec![(Parameter::Gravity, 5.0.into())],
        parameter: friction(),
        values: ValueRange {
            from: 0.1,
            to: 0.3,
            count: 3,
            by_powers: false,
        },
        seeds: 1,
        duration: 0.05,
    }
}

/// Every number that the cases came to, as bits, with their last states.
fn bits(outcomes: &[CaseResult]) -> Vec<(String, String, Vec<Option<u64>>)> {
    let of = |own: &CaseResult| {
        let numbers = ResultKey::all().map(|key| own.result(key).map(f64::to_bits));
        (own.case.name.clone(), own.hash.clone(), numbers.collect())
    };
    let mut all: Vec<_> = outcomes.iter().map(of).collect();
    all.sort();
    all
}

/// What the same sweep comes to without a window, in the folder `out`.
fn headless(sweep: &Sweep, out: &Path) -> Vec<Vec<String>> {
    let sweep = Sweep {
        out: out.to_owned(),
        ..sweep.clone()
    };
    let never = AtomicBool::new(false);
    let swept = sweep::run(&sweep, &never, &mut ()).unwrap();
    assert_eq!(swept.ending, SweepEnding::Done);
    table(out)
}

/// The rows of a sweep's table, its head first.
fn table(out: &Path) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_path(out.join("table.csv"))
        .unwrap();
    let rows = reader.records().map(Result::unwrap);
    rows.map(|row| row.iter().map(str::to_owned).collect())
        .collect()
}

fn open_panel(harness: &mut Harness<'_, Window>, parameter: &Parameter) {
    harness.state_mut().dock.ask_sweep(Some(parameter));
    harness.run_steps(30);
}

#[test]
fn a_sweep_is_asked_for_beside_a_parameter_and_answers_as_it_does_without_a_window() {
    let folder = tempfile::tempdir().unwrap();
    let mut simulation = prepared();
    simulation.send(set(Parameter::Gravity, 5.0));
    let mut harness = Window::of(simulation);
    press(&mut harness, "Run over values of friction glass – glass…");
    assert_eq!(
        asked(&mut harness),
        [Request::Sweep(SweepAct::Ask(Some(friction())))]
    );
    harness
        .state_mut()
        .dock
        .sweeps
        .settle_in(folder.path().into());
    open_panel(&mut harness, &friction());
    type_number(&mut harness, "first value", "0.1");
    type_number(&mut harness, "last value", "0.3");
    type_number(&mut harness, "number of values", "3");
    type_number(&mut harness, "duration of each run", "0.05");
    harness.get_by_label("0.1, 0.2, 0.3");
    harness.get_by_label_contains("3 runs, ");
    press(&mut harness, "Start the sweep");
    let wanted = Request::Sweep(SweepAct::Start(Box::new(question())));
    assert_eq!(asked(&mut harness), [wanted], "as the scene is now");

    let desk = harness.state().dock.sweeps.clone();
    desk.start(question(), BedStore::none());
    let seen = ended(&desk);
    assert_eq!(seen.standing.ending, Some(Ok(SweepEnding::Done)));
    let outcomes = &seen.standing.outcomes;
    assert_eq!(outcomes.len(), 3);
    let expected = headless(&seen.sweep, &folder.path().join("headless"));
    assert_eq!(table(&seen.sweep.out), expected, "to the last digit");

    // The curve shows what the table holds.
    harness.run_steps(8);
    harness.get_by_label("Every run is done.");
    let angle = ResultKey::from(Measure::SurfaceAngle);
    let keys = sweep::numbers(outcomes);
    let first = keys.contains(&angle).then_some(angle);
    let key = first.unwrap_or(Measure::MeanSpeed.into());
    let curve = sweep::curve(&seen.sweep, outcomes, key).unwrap();
    let column = expected[0]
        .iter()
        .position(|head| head.starts_with(&format!("{} [", key.name())));
    let factor = key.quantity().unit.shown.factor;
    for ((x, y), row) in curve.lines[0].points.iter().zip(&expected[1..]) {
        let stated: f64 = row[column.unwrap()].parse().unwrap();
        assert_eq!(
            (row[0].as_str(), y.to_bits()),
            (x.to_string().as_str(), (stated * factor).to_bits())
        );
    }
    harness.get_by_label_contains(&format!("{}: ", curve.title));
}

#[test]
fn what_a_sweep_in_the_window_leaves_is_confirmed() {
    let folder = tempfile::tempdir().unwrap();
    let desk = SweepDesk::default();
    desk.settle_in(folder.path().into());
    desk.start(question(), BedStore::none());
    let out = ended(&desk).sweep.out.clone();
    let stated = StatedSweep::read(&StatedSweep::at(&out).unwrap()).unwrap();
    assert_eq!(stated.cases.len(), 3);
    for (name, _) in &stated.cases {
        let record = RunRecord::read(&stated.summary(name)).unwrap();
        assert_eq!(stated.difference(name, &record), None);
        let verdict = record.verify(1, BedStore::none(), &mut (), &|| false);
        assert_eq!(verdict.unwrap(), Verdict::Same, "{name}");
    }
    let files = stated.check_files();
    assert!(files.same > 3 && files.altered.is_empty() && files.missing.is_empty());
}

#[test]
fn a_sweep_that_was_stopped_goes_on_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let longer = || Question {
        duration: 0.4,
        ..question()
    };
    let desk = SweepDesk::default();
    desk.settle_in(folder.path().join("parts"));
    desk.start(longer(), BedStore::none());
    // Long before its end.
    desk.stop();
    let seen = ended(&desk);
    assert_eq!(seen.standing.ending, Some(Ok(SweepEnding::Interrupted)));
    assert!(seen.standing.outcomes.len() < 3);
    desk.start(longer(), BedStore::none());
    let parts = ended(&desk);
    assert_eq!(parts.standing.ending, Some(Ok(SweepEnding::Done)));
    let whole = SweepDesk::default();
    whole.settle_in(folder.path().join("whole"));
    whole.start(longer(), BedStore::none());
    let whole = ended(&whole);
    assert_eq!(
        bits(&parts.standing.outcomes),
        bits(&whole.standing.outcomes)
    );
}

#[test]
fn why_a_sweep_cannot_be_is_said_in_the_panel() {
    let mut harness = Window::of(prepared());
    open_panel(&mut harness, &friction());
    type_number(&mut harness, "duration of each run", "1e9");
    harness.get_by_label_contains("at most 1e6 s");
    let button = harness.get_by_label("Start the sweep");
    assert!(button.accesskit_node().is_disabled());

    let folder = tempfile::tempdir().unwrap();
    let desk = harness.state().dock.sweeps.clone();
    desk.settle_in(folder.path().into());
    let sweep = question()
        .sweep(folder.path(), 1, BedStore::none())
        .unwrap();
    std::fs::create_dir(&sweep.out).unwrap();
    std::fs::write(sweep.out.join("mine.txt"), "mine").unwrap();
    desk.start(question(), BedStore::none());
    ended(&desk);
    harness.run_steps(8);
    harness.get_by_label_contains("holds files that are not a sweep's");
    assert_eq!(std::fs::read(sweep.out.join("mine.txt")).unwrap(), b"mine");
}

fn desk(app: &App) -> SweepDesk {
    app.world().resource::<Dock>().sweeps.clone()
}

#[test]
fn a_sweep_outlives_its_scene_and_each_of_its_runs_opens() {
    let folder = tempfile::tempdir().unwrap();
    let mut app = app();
    ask(
        &mut app,
        Request::Sweep(SweepAct::Folder(folder.path().into())),
    );
    ask(
        &mut app,
        Request::Sweep(SweepAct::Start(Box::new(question()))),
    );
    ask(&mut app, Request::Open("bouncing-grain".into()));
    let seen = ended(&desk(&app));
    assert_eq!(seen.standing.ending, Some(Ok(SweepEnding::Done)));
    let case = seen.standing.outcomes[1].case.clone();
    let friction_there = case.values[0].parse::<f64>().unwrap();
    ask(
        &mut app,
        Request::Sweep(SweepAct::Open(Box::new(case.clone()))),
    );
    until(&mut app, |app| {
        let simulation = app.world().resource::<Simulation>();
        *simulation.scene() == case.scene
            && simulation
                .value(&friction())
                .is_some_and(|own| own == friction_there)
            && simulation
                .value(&Parameter::Gravity)
                .is_some_and(|own| own == 5.0)
    });
}

#[test]
fn leaving_while_a_sweep_runs_is_asked_about_and_keeps_its_checkpoints() {
    let folder = tempfile::tempdir().unwrap();
    let mut app = app();
    ask(
        &mut app,
        Request::Sweep(SweepAct::Folder(folder.path().into())),
    );
    let long = Question {
        duration: 600.0,
        ..question()
    };
    ask(&mut app, Request::Sweep(SweepAct::Start(Box::new(long))));
    until(&mut app, |app| {
        let begun = |part: &Part| matches!(part, Part::Running(_));
        desk(app)
            .seen()
            .is_some_and(|seen| seen.standing.parts.iter().any(begun))
    });
    ask(&mut app, Request::Quit);
    assert!(app.should_exit().is_none(), "it is asked first");
    assert!(desk(&app).progress().is_some(), "and goes on meanwhile");
    ask(&mut app, Request::Anyway(Box::new(Request::Quit)));
    assert!(app.should_exit().is_some());
    let seen = desk(&app).seen().unwrap();
    assert_eq!(seen.standing.ending, Some(Ok(SweepEnding::Interrupted)));
    let cases = std::fs::read_dir(&seen.sweep.out)
        .unwrap()
        .map(Result::unwrap);
    let checkpoints = cases.filter(|entry| entry.path().join(CHECKPOINT).is_file());
    assert!(checkpoints.count() > 0, "one has begun");
}
