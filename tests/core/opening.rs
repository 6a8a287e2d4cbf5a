//! Claims about the moments at which scenes open in a window: each is of this program, of a run that
//! began at time zero, and what the scene promises comes before somebody stops waiting for it.

use glam::DVec2;
use grainfall::measure::{Measure, NON_RIGID_TEMPERATURE};
use grainfall::run::{Opening, Timeline, method, opening, openings};
use grainfall::scene::{Scene, SceneContainer, built_in};
use grainfall::world::World;
use std::thread;

/// How to make what a test misses.
const MAKE: &str = "`grainfall opening --out assets/openings` makes it anew";
/// So long somebody waits for what a scene promises [s].
const PATIENCE: f64 = 5.0;
/// How often somebody looks in that time whether it came.
const LOOKS: u32 = 10;
/// What a grain costs in a step on one core [s]: a quarter more than wet grains take
/// (benches/README.md).
const COST: f64 = 100e-9;
/// A surface that falls by more within a quarter of a second slides [°]; one that creeps falls by two
/// degrees within a second at most.
const SLIDES: f64 = 1.25;
/// Room for all files [bytes]: the library as a package has a megabyte beside them.
const ROOM: usize = 5 << 20;

/// What a scene promises, and what is to be seen of it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Promise {
    /// The surface falls.
    Avalanche,
    /// The bed flows all the time, and its surface keeps its slope.
    Creep,
    /// Small grains gather in the core of the bed, large ones at its rim.
    Sorts,
    /// They stay mixed.
    StaysMixed,
}

const PROMISES: [(&str, Promise); 8] = [
    ("dry-r3", Promise::Avalanche),
    ("dry-r2", Promise::Avalanche),
    ("wet", Promise::Avalanche),
    ("water-drum", Promise::Avalanche),
    ("two-frictions-drum", Promise::Avalanche),
    ("honey-drum", Promise::Creep),
    ("two-sizes-drum", Promise::Sorts),
    ("two-sizes-wet-drum", Promise::StaysMixed),
];

/// Drums that begin at time zero, and why.
const FROM_THE_START: [(&str, &str); 2] = [
    ("small-drum", "turns so fast that it slides within 3 s"),
    (
        "dry-r1.25",
        "takes a minute for each second; its text says so",
    ),
];

/// The run at the moment at which its scene opens.
fn opened(opening: &Opening) -> Timeline {
    let session = opening.session();
    let session = session.unwrap_or_else(|| panic!("{}: {MAKE}", opening.scene));
    session.into_timeline(1, 0)
}

/// Simulated time that is computed while somebody waits [s]: no more than passes on the clock.
fn within_patience(world: &World) -> f64 {
    let per_step = COST * world.grains.len() as f64;
    PATIENCE.min(PATIENCE / per_step * world.clock.time_step)
}

/// How far grains of the small kind are from the middle of the bed's section, over how far those of
/// the large kind are.
fn core_share(world: &World) -> f64 {
    let places = world.grains.position.iter().map(|x| DVec2::new(x.x, x.y));
    let places: Vec<DVec2> = places.collect();
    let middle = places.iter().sum::<DVec2>() / places.len() as f64;
    let kinds = world.grains.species.iter().map(|kind| usize::from(kind.0));
    let (mut sums, mut counts) = ([0.0; 2], [0.0; 2]);
    for (place, kind) in places.iter().zip(kinds) {
        sums[kind] += place.distance(middle);
        counts[kind] += 1.0;
    }
    let small = usize::from(world.species[1].name == "small");
    (sums[small] / counts[small]) / (sums[1 - small] / counts[1 - small])
}

/// Most that the surface falls within a quarter of a second [°]: an avalanche, no creep.
fn fastest_drop(time: &[f64], angles: &[f64]) -> f64 {
    let drop = |i: usize| {
        let next = time.partition_point(|t| *t <= time[i] + 0.25);
        let lowest = angles[i..next].iter().copied().fold(f64::MAX, f64::min);
        angles[i] - lowest
    };
    (0..time.len()).map(drop).fold(0.0, f64::max).to_degrees()
}

/// The fastest drop since a time [s], and the least granular temperature.
fn fall_and_coldest(timeline: &Timeline, since: f64) -> (f64, f64) {
    let series = timeline.run().series();
    let from = series.first_at(since);
    let column = |measure| &series.column(measure)[from..];
    let drop = fastest_drop(&series.time()[from..], column(Measure::SurfaceAngle));
    let temperatures = column(Measure::GranularTemperature).iter().copied();
    (drop, temperatures.fold(f64::MAX, f64::min))
}

/// Goes on for as long as somebody waits, and looks.
fn keeps(promise: Promise, name: &str, mut timeline: Timeline) {
    let world = timeline.run().world();
    let (start, clock, waits) = (world.time(), world.clock, within_patience(world));
    if matches!(promise, Promise::Sorts | Promise::StaysMixed) {
        let share = |timeline: &Timeline| core_share(timeline.run().world());
        let before = share(&timeline);
        timeline.advance_to(clock.step_at(start + waits)).unwrap();
        let after = share(&timeline);
        println!("{name}: {before:.3} becomes {after:.3} in {waits:.2} s");
        assert!(before > 0.78, "{name}: {before}");
        let expected = if promise == Promise::Sorts {
            0.0..0.72
        } else {
            0.78..1.0
        };
        return assert!(expected.contains(&after), "{name}: {after}");
    }
    let mut seen = (0.0, f64::MAX);
    for look in 1..=LOOKS {
        let until = start + waits * f64::from(look) / f64::from(LOOKS);
        timeline.advance_to(clock.step_at(until)).unwrap();
        seen = fall_and_coldest(&timeline, start - 0.5);
        if seen.0 > SLIDES {
            break;
        }
    }
    let (drop, coldest) = seen;
    println!("{name}: falls by {drop:.2}° in {waits:.2} s at most, coldest {coldest:.2e}");
    let falls = drop > SLIDES;
    assert_eq!(falls, promise == Promise::Avalanche, "{name}: {drop}°");
    assert!(
        promise != Promise::Creep || coldest > NON_RIGID_TEMPERATURE,
        "{name}: {coldest}"
    );
}

#[test]
fn what_a_scene_promises_comes_within_five_seconds_of_the_moment_at_which_it_opens() {
    thread::scope(|scope| {
        for opening in openings() {
            let known = PROMISES.iter().find(|known| known.0 == opening.scene);
            let (name, promise) = *known.expect("what it promises");
            scope.spawn(move || keeps(promise, name, opened(opening)));
        }
    });
}

#[test]
fn each_moment_is_of_this_program_and_of_a_run_that_began_at_time_zero() {
    for own in openings() {
        let session = own.session();
        let session = session.unwrap_or_else(|| panic!("{}: {MAKE}", own.scene));
        assert_eq!(
            session.look(),
            format!("method {}", method(&session.record().scene)),
            "{MAKE}"
        );
        let record = session.record().clone();
        assert_eq!(record.scene, Scene::open(own.scene).unwrap(), "{MAKE}");
        assert!(record.commands.is_empty());
        // A step: no scene takes a tenth of a millisecond.
        assert!((record.time - own.moment).abs() < 1e-4);
        let timeline = session.into_timeline(1, 0);
        let run = timeline.run();
        // Its samples are those of the whole run.
        assert_eq!((run.series().time()[0], run.bed().clock.step), (0.0, 0));
        assert!(run.series().len() as f64 > 45.0 * own.moment);
        assert!(run.orientations().is_some(), "they are stored with it");
    }
}

/// The bits of the whole way are confirmed by `grainfall verify assets/openings/dry-r3.grainfall`.
#[test]
fn the_first_scene_opens_with_a_bed_that_turned_and_has_not_slid_yet() {
    let session = opening("dry-r3").expect(MAKE);
    let timeline = session.into_timeline(1, 0);
    let run = timeline.run();
    let turned = run.orientations().unwrap();
    let angle = turned.iter().map(|turn| 2.0 * turn.w.abs().min(1.0).acos());
    let mean = f64::from(angle.sum::<f32>()) / turned.len() as f64;
    // As the bed has turned with the drum by 27°, grains that rolled by more.
    assert!((0.4..1.2).contains(&mean), "{mean}");
    // A second before the first avalanche the bed is steep and has not slid yet.
    let angles = run.series().column(Measure::SurfaceAngle);
    let steepest = angles.iter().copied().fold(0.0, f64::max);
    let last = *angles.last().unwrap();
    assert!(last.to_degrees() > 25.0 && last > steepest - 0.01);
}

#[test]
fn every_drum_opens_at_a_moment_or_is_known_to_need_none() {
    for scene in built_in() {
        let opened = Scene::parse(scene.path, scene.text).unwrap();
        let is_drum = matches!(opened.container, SceneContainer::Drum { .. });
        let from_the_start = FROM_THE_START.iter().any(|known| known.0 == scene.name);
        let has_moment = openings().iter().any(|own| own.scene == scene.name);
        assert_eq!(has_moment, is_drum && !from_the_start, "{}", scene.name);
        assert_eq!(opening(scene.name).is_some(), has_moment, "{MAKE}");
        assert_eq!(
            opening(scene.path).is_some(),
            has_moment && !at_hand(scene.path)
        );
    }
    assert!(opening("no-such-scene").is_none());
}

/// Whether the tests run beside the scene's file: then that is meant.
fn at_hand(path: &str) -> bool {
    std::path::Path::new(path).is_file()
}

#[test]
fn all_moments_together_are_small() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/openings");
    let sizes = openings().iter().map(|own| {
        let path = folder.join(own.file_name());
        std::fs::metadata(path).unwrap().len() as usize
    });
    let all: usize = sizes.sum();
    assert!(all < ROOM, "{all} bytes");
}
