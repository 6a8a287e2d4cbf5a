//! Claims about the list of events: what happened in a run is in it, when it happened, and nothing
//! else is.

use crate::runs::{friction, prepared, set, shared_beds};
use crate::timeline::{arrive, change, go_on};
use grainfall::measure::{Measure, SMALLEST_DROP, Sample, Series, avalanches};
use grainfall::output::RunSoFar;
use grainfall::parameters::Value;
use grainfall::recording::Recording;
use grainfall::run::{
    BedStore, Command, Event, EventKind, Happening, Parameter, Run, Script, ScriptedCommand,
    Session, Timeline, events,
};
use grainfall::runner::{self, Job};
use grainfall::scene::Scene;
use grainfall::solver::{Solver, advise};
use grainfall::world::{self, Partner};
use std::fs;
use std::path::Path;

const PLENTY: usize = 1 << 28;
const DEGREE: f64 = std::f64::consts::PI / 180.0;

fn bouncing() -> Scene {
    let mut scene = Scene::open("bouncing-grain").unwrap();
    // An impact in some seventy steps, so that it keeps its share of energy to half a percent.
    scene.set("time-step", "5us").unwrap();
    scene
}

fn whole_run(scene: &Scene) -> Run {
    let mut run = prepared(scene, 1, shared_beds()).0;
    let end = run.world().clock.step_at(scene.duration);
    run.advance_to(end).unwrap();
    run
}

fn events_of(run: &Run) -> Vec<Event> {
    RunSoFar::of(run).events()
}

/// Times [s] and speeds [m/s] of the impacts.
fn impacts(events: &[Event]) -> Vec<(f64, f64)> {
    let impacts = events.iter().filter_map(|event| match event.what {
        Happening::Impact { speed, .. } => Some((event.time, speed)),
        _ => None,
    });
    impacts.collect()
}

/// Times [s] of the ends of contacts, and how long these lasted [s].
fn partings(events: &[Event]) -> Vec<(f64, f64)> {
    let partings = events.iter().filter_map(|event| match event.what {
        Happening::Parting { duration, .. } => Some((event.time, duration?)),
        _ => None,
    });
    partings.collect()
}

/// A grain that falls 5 cm meets the floor after √(2h/g) with √(2gh); it leaves it with 0.8 of the
/// speed, and flies for twice that over g.
#[test]
fn impacts_of_a_bouncing_grain_come_when_and_as_fast_as_in_closed_form() {
    let scene = bouncing();
    let run = whole_run(&scene);
    let (events, step) = (events_of(&run), run.world().clock.time_step);
    let (impacts, partings) = (impacts(&events), partings(&events));
    let gravity = run.world().gravity.length();
    let (first, speed) = impacts[0];
    let fall = (2.0 * 0.05 / gravity).sqrt();
    // It is seen after the first step in which the two touch; the fall itself is exact.
    assert!((0.0..=1.001 * step).contains(&(first - fall)), "{first}");
    assert!((speed / (gravity * fall) - 1.0).abs() < 1e-3, "{speed}");
    for (bounce, pair) in impacts[..6].windows(2).enumerate() {
        let [(_, before), (time, after)] = pair else {
            unreachable!()
        };
        // Half a percent of energy is a quarter of a percent of speed.
        assert!((after / before / 0.8 - 1.0).abs() < 0.0025, "{bounce}");
        let (parted, lasted) = partings[bounce];
        assert!(lasted > 20.0 * step && lasted < 1e-3, "{lasted}");
        let flight = 2.0 * after / gravity;
        // The grain parts at rest with the floor where it touches it: a free flight.
        assert!(((time - parted) / flight - 1.0).abs() < 1e-3, "{bounce}");
    }
    let is_floor = |event: &Event| match event.what {
        Happening::Impact { pair, .. } | Happening::Parting { pair, .. } => {
            (pair.grain, pair.partner) == (0, Partner::Wall(0))
        }
        _ => false,
    };
    assert!(events.iter().all(is_floor));
}

/// The steps after which each pair begins and ends to touch, found step by step.
#[test]
fn every_contact_of_few_grains_is_listed_at_its_step() {
    for name in ["two-grains", "grain-chain"] {
        let scene = Scene::open(name).unwrap();
        let mut world = world::build(&scene, advise(&scene).time_step);
        let mut solver = Solver::new(1);
        let mut expected = Vec::new();
        let touching = |world: &world::World| -> Vec<(u32, Partner)> {
            let touching = world.contacts.iter().filter(|contact| contact.touching);
            touching
                .map(|contact| (contact.grain, contact.partner))
                .collect()
        };
        while world.time() < scene.duration {
            let before = touching(&world);
            solver.advance(&mut world, 1).unwrap();
            let now = touching(&world);
            let step = world.clock.step;
            let begun = now.iter().filter(|pair| !before.contains(pair));
            expected.extend(begun.map(|pair| (step, true, *pair)));
            let ended = before.iter().filter(|pair| !now.contains(pair));
            expected.extend(ended.map(|pair| (step, false, *pair)));
        }
        let run = whole_run(&scene);
        let listed = events_of(&run).into_iter().filter_map(|event| {
            let step = (event.time / run.world().clock.time_step).round() as u64;
            match event.what {
                Happening::Impact { pair, .. } => Some((step, true, (pair.grain, pair.partner))),
                Happening::Parting { pair, .. } => Some((step, false, (pair.grain, pair.partner))),
                _ => None,
            }
        });
        let listed: Vec<_> = listed.collect();
        assert!(!expected.is_empty(), "{name}");
        assert_eq!(listed, expected, "{name}");
    }
}

const MEET_AND_PART: &str = r#"(
        title: "Two wet grains that meet and part",
        materials: {"glass": (friction: 0.4, wet_friction: 0.1)},
        container: Nothing,
        gravity: (0, 0, 0),
        grains: List([
            (position: (0, 0, 0), radius_mm: 3, material: "glass"),
            (position: (0.0061, 0, 0), velocity: (-0.5, 0, 0), radius_mm: 3, material: "glass"),
        ]),
        liquid: (surface_tension: 0.064, contact_angle_deg: 60, viscosity: 0.001, volume: 1.7e-8,
            law: Choices(volume: ShadedCap, angle: Mean, viscous_gap: OfEffectiveRadius(0.01),
            capillary_gap: Open, rupture: AtRuptureGap)),
        duration: 0.02,
    )"#;

#[test]
fn a_bridge_forms_at_the_first_touch_and_ruptures_at_its_rupture_gap() {
    let scene = Scene::parse("meet and part", MEET_AND_PART).unwrap();
    let mut run = prepared(&scene, 1, BedStore::none()).0;
    let mut volume = f64::NAN;
    let rupture = loop {
        let bridge = run.world().contacts.first().and_then(|c| c.bridge.clone());
        volume = bridge.map_or(volume, |bridge| bridge.volume);
        let [first, second] = [0, 1].map(|i| run.world().grains.position[i]);
        let gap = first.distance(second) - 6e-3;
        let step = run.world().clock.step;
        run.advance_to(step + 1).unwrap();
        let ruptures = events_of(&run);
        let rupture = ruptures.iter().find_map(|event| match event.what {
            Happening::BridgeRuptures { duration, .. } => Some((event.time, duration)),
            _ => None,
        });
        if let Some(rupture) = rupture {
            // (1 + θ/2) V^(1/3), passed in the step that was just taken.
            let longest = (1.0 + 0.5 * 60.0 * DEGREE) * volume.cbrt();
            let [first, second] = [0, 1].map(|i| run.world().grains.position[i]);
            let now = first.distance(second) - 6e-3;
            assert!(gap <= longest && longest < now, "{gap} {longest} {now}");
            break rupture;
        }
        assert!(run.world().time() < scene.duration, "it never ruptures");
    };
    let (time, duration) = rupture;
    assert_eq!(time, run.world().time());
    let list = events_of(&run);
    let formed = |event: &&Event| matches!(event.what, Happening::BridgeForms { .. });
    let formed = list.iter().find(formed).unwrap().time;
    // Where they touch first.
    assert_eq!(impacts(&list), [(formed, impacts(&list)[0].1)]);
    assert_eq!(duration, Some(time - formed));
}

/// θ rises from 24° to 28° in 1.8 s and falls back in 0.2 s, again and again, sampled each 20 ms.
fn sawtooth(teeth: u64) -> Series {
    let mut series = Series::default();
    for step in 0..=100 * teeth {
        let (time, phase) = (step as f64 * 0.02, (step % 100) as f64 * 0.02);
        let angle = if phase <= 1.8 {
            24.0 + 4.0 * phase / 1.8
        } else {
            28.0 - 4.0 * (phase - 1.8) / 0.2
        };
        let mut values = [f64::NAN; Measure::COUNT];
        values[Measure::SurfaceAngle as usize] = angle * DEGREE;
        series.push(Sample { step, time, values });
    }
    series
}

#[test]
fn avalanches_of_a_known_series_begin_and_end_where_they_do() {
    let series = sawtooth(5);
    let angle = series.column(Measure::SurfaceAngle);
    let found = avalanches(series.time(), angle, SMALLEST_DROP);
    let list = events(&series, &found, &[], [].chunks(1));
    // The last one has not ended for certain.
    assert_eq!(list.len(), 8);
    for (tooth, pair) in list.chunks(2).enumerate() {
        let from = 2.0 * tooth as f64;
        let [begin, end] = pair else { unreachable!() };
        let (Happening::AvalancheBegins(of), Happening::AvalancheEnds(same)) =
            (&begin.what, &end.what)
        else {
            panic!("{pair:?}");
        };
        assert_eq!(of, same);
        // The mean over 0.1 s moves an extremum towards its gentler side and takes from it.
        assert!((begin.time - (from + 1.8)).abs() < 0.05, "{}", begin.time);
        assert!((end.time - (from + 2.0)).abs() < 0.05, "{}", end.time);
        assert!((3.0..4.0).contains(&(of.drop() / DEGREE)), "{of:?}");
    }
}

#[test]
fn the_front_of_a_column_stops_when_it_is_at_rest() {
    let mut series = Series::default();
    for step in 0..=50_u64 {
        let time = step as f64 * 0.02;
        let energy = if time < 0.2 {
            time
        } else {
            0.2 * (-(time - 0.2) / 0.05).exp()
        };
        let mut values = [f64::NAN; Measure::COUNT];
        values[Measure::TranslationalEnergy as usize] = energy;
        values[Measure::RotationalEnergy as usize] = 0.0;
        values[Measure::FrontRadius as usize] = 0.02 + 0.1 * time.min(0.3);
        values[Measure::DepositHeight as usize] = 0.01;
        series.push(Sample { step, time, values });
    }
    let list = events(&series, &[], &[], [].chunks(1));
    // A hundredth of the peak, 0.05 s · ln 100 = 0.23 s after it.
    let [Event { time, what }] = list.as_slice() else {
        panic!("{list:?}");
    };
    assert!((time - 0.44).abs() < 1e-12, "{time}");
    assert_eq!(*what, Happening::FrontStops { radius: 0.05 });
}

#[test]
fn changes_of_a_script_are_listed_with_the_values_before() {
    let scene = Scene::open("two-grains").unwrap();
    let mut run = prepared(&scene, 1, BedStore::none()).0;
    let at = |step: u64, value: f64| ScriptedCommand {
        step: Some(step),
        time: None,
        command: friction(value),
    };
    let script = Script::new(&[at(100, 0.25), at(300, 0.5)], &run.world().clock).unwrap();
    run.schedule(script).unwrap();
    run.advance_to(400).unwrap();
    let list = events_of(&run);
    let changes = list.iter().filter_map(|event| match &event.what {
        Happening::Changed(change) => Some((change.step, event.time, change.set.clone())),
        _ => None,
    });
    let changes: Vec<_> = changes.collect();
    let dt = run.world().clock.time_step;
    let parameter = Parameter::Friction("glass".into(), "glass".into());
    assert_eq!(changes.len(), 2);
    for ((step, time, set), (expected, before, value)) in changes
        .iter()
        .zip([(100, None, 0.25), (300, Some(0.25), 0.5)])
    {
        assert_eq!((*step, *time), (expected, expected as f64 * dt));
        assert_eq!(set.len(), 1);
        assert_eq!(set[0].parameter, parameter);
        assert_eq!(set[0].before, before.map(Value::from));
        assert_eq!(set[0].value, Value::from(value));
    }
}

/// What a run knew of its impacts is in a session, is not listed twice when they are seen again, and
/// goes with the part of a run that another run leaves.
#[test]
fn impacts_are_kept_in_a_session_and_listed_once_however_often_they_are_seen() {
    let scene = bouncing();
    let run = prepared(&scene, 1, shared_beds()).0;
    let mut timeline = Timeline::new(run, PLENTY);
    go_on(&mut timeline, 120_000);
    let all = events_of(timeline.run());
    assert!(impacts(&all).len() >= 3, "{all:?}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("kept.grainfall");
    Session::of("bouncing", &timeline).write(&path).unwrap();
    let mut same = Session::read(&path).unwrap().into_timeline(1, PLENTY);
    assert_eq!(events_of(same.run()), all);
    for timeline in [&mut timeline, &mut same] {
        timeline.seek(10_000);
        arrive(timeline);
        go_on(timeline, 120_000);
        assert_eq!(events_of(timeline.run()), all);
        timeline.seek(30_000);
        arrive(timeline);
        change(timeline, set(Parameter::Gravity, 5.0));
        let past = events_of(timeline.run());
        let is_past = |event: &&Event| event.time <= timeline.run().world().time();
        let expected = impacts(&all.iter().filter(is_past).cloned().collect::<Vec<_>>());
        assert_eq!(impacts(&past), expected);
        go_on(timeline, 90_000);
        assert!(impacts(&events_of(timeline.run())).len() > expected.len());
    }
}

fn job(out: &Path, duration: &str) -> Job {
    let mut scene = bouncing();
    let values = [("duration", duration), ("output-interval", "50ms")];
    scene.set_all(&values).unwrap();
    Job {
        threads: 1,
        beds: BedStore::none(),
        checkpoints: true,
        script: vec![ScriptedCommand {
            step: None,
            time: Some(0.15),
            command: Command::Set {
                parameter: Parameter::Gravity,
                value: 5.0.into(),
            },
        }],
        ..Job::new("bounce", scene, out)
    }
}

/// A run that goes on from its checkpoint writes the same list.
#[test]
fn events_of_a_run_without_a_window_are_in_its_folder_when_it_went_on_from_a_checkpoint() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| job(&home.path().join(name), "400ms");
    runner::run(&at("whole"), &mut (), &|| false).unwrap();
    let written = |job: &Job| fs::read_to_string(job.out.join("events.csv")).unwrap();
    let whole = written(&at("whole"));
    let mut table = csv::Reader::from_reader(whole.as_bytes());
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let of = |kind: &'static str| rows.iter().filter(move |row| &row[1] == kind);
    assert!(of("impact").count() >= 2 && of("parting").count() >= 2);
    let fall: f64 = of("impact").next().unwrap()[0].parse().unwrap();
    assert!(
        (fall - (2.0 * 0.05_f64 / 9.81).sqrt()).abs() < 2e-4,
        "{fall}"
    );
    assert!(of("impact").all(|row| row[2] == *"0" && row[3] == *"floor"));
    let change = of("change").next().unwrap();
    assert_eq!((&change[9], &change[10]), ("gravity", "5.0"));
    assert_eq!(rows.len(), of("impact").count() + of("parting").count() + 1);

    // Through one impact and no further, then on to the same end.
    let (first, run) = runner::run(
        &job(&home.path().join("stopped"), "200ms"),
        &mut (),
        &|| false,
    )
    .unwrap();
    assert_eq!(first.ending.status(), "done");
    assert!(run.run().unwrap().world().time() > fall);
    let (second, _) = runner::run(&at("stopped"), &mut (), &|| false).unwrap();
    assert!(!second.was_done);
    assert_eq!(written(&at("stopped")), whole);
    let summary = fs::read_to_string(at("stopped").out.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let digest = grainfall::output::digest_of_file(&at("stopped").out.join("events.csv")).unwrap();
    assert_eq!(summary["files"]["events.csv"], digest);
}

/// What the recording in `folder` shows of what happened, and what is said of its files.
fn recorded(folder: &Path) -> (Vec<Event>, String) {
    let recording = Recording::open(folder).unwrap();
    let branch = recording.branch();
    let angle = branch.series.column(Measure::SurfaceAngle);
    let avalanches = avalanches(branch.series.time(), angle, SMALLEST_DROP);
    let changes = branch.history.each_change();
    let events = events(&branch.series, &avalanches, &branch.meetings, changes);
    (events, recording.notes().join("; "))
}

#[test]
fn a_recording_shows_what_happened_in_its_run() {
    let home = tempfile::tempdir().unwrap();
    let job = job(&home.path().join("bounce"), "400ms");
    let (_, run) = runner::run(&job, &mut (), &|| false).unwrap();
    let all = events_of(run.run().unwrap());
    assert!(impacts(&all).len() >= 2 && partings(&all).len() >= 2);
    assert_eq!(recorded(&job.out), (all.clone(), String::new()));
    // Of grains that touch each other, and that a bridge holds.
    let bridged = Scene::parse("meet and part", MEET_AND_PART).unwrap();
    for (name, mut scene) in [
        ("bridged", bridged),
        ("chain", Scene::open("grain-chain").unwrap()),
    ] {
        scene.set("output-interval", "5ms").unwrap();
        let job = Job {
            threads: 1,
            beds: shared_beds(),
            ..Job::new(name, scene, home.path().join(name))
        };
        let (_, run) = runner::run(&job, &mut (), &|| false).unwrap();
        let (events, said) = recorded(&job.out);
        assert!(
            events
                .iter()
                .any(|event| matches!(event.what, Happening::Impact { .. }))
        );
        assert_eq!(events, events_of(run.run().unwrap()), "{name}");
        assert_eq!(said, "");
    }
}

#[test]
fn wrong_lines_of_a_recorded_list_of_events_are_told_with_file_and_line() {
    let home = tempfile::tempdir().unwrap();
    let job = job(&home.path().join("bounce"), "400ms");
    runner::run(&job, &mut (), &|| false).unwrap();
    let path = job.out.join("events.csv");
    let whole = fs::read_to_string(&path).unwrap();
    let all = impacts(&recorded(&job.out).0);
    let lines: Vec<&str> = whole.lines().collect();
    // The second impact, after the first and the parting.
    let third = lines
        .iter()
        .rposition(|line| line.contains("impact"))
        .unwrap();
    for (from, to, reason) in [
        ("impact", "embrace", "has \"embrace\" where an event stands"),
        (
            "floor",
            "ceiling",
            "has \"0\" and \"ceiling\" where a grain",
        ),
        (
            ",0,floor",
            ",0,1",
            "is of grains, or of a step, that no run has",
        ),
        (
            ",0,floor",
            ",1,floor",
            "is of grains, or of a step, that no run has",
        ),
        (",0,floor", ",1,0", "has \"1\" and \"0\" where a grain"),
        (",floor,", ",floor,NaN", "where a number stands"),
        ("0.", "-0.", "where a time stands"),
        (
            "0.",
            "1000000000000000.",
            "is of grains, or of a step, that no run has",
        ),
        ("0.", "0.0000000", "is earlier than the one before"),
        (",impact", "", "is no row of a table"),
    ] {
        let wrong = lines[third].replacen(from, to, 1);
        assert_ne!(wrong, lines[third], "{from}");
        let mut damaged = lines.clone();
        damaged[third] = &wrong;
        fs::write(&path, damaged.join("\n")).unwrap();
        let (events, said) = recorded(&job.out);
        let line = format!("events.csv: line {} {reason}", third + 1);
        let told = format!("events.csv: line {}", third + 1);
        assert!(
            said.contains(&told) && said.contains(reason),
            "{line}: {said}"
        );
        assert!(
            said.contains("events.csv is not as it was written"),
            "{said}"
        );
        assert_eq!(impacts(&events), all[..all.len() - 1], "{reason}");
    }
    fs::write(&path, whole.replacen("time", "when", 1)).unwrap();
    let (events, said) = recorded(&job.out);
    assert!(
        said.contains("There are no impacts: ") && said.contains("`time [s]`"),
        "{said}"
    );
    // Changes are known without it.
    assert!(impacts(&events).is_empty() && events.len() == 1);
    fs::remove_file(&path).unwrap();
    assert_eq!(recorded(&job.out).1, "");
}

#[test]
fn every_kind_of_event_has_a_name_of_its_own() {
    let names = EventKind::ALL.map(EventKind::name);
    for (index, name) in names.iter().enumerate() {
        assert_eq!(names.iter().position(|other| other == name), Some(index));
        assert_eq!(EventKind::ALL[index] as usize, index);
    }
}
