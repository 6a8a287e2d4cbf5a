//! How long somebody waits for what a scene promises, from Play on: the moments at which drums open
//! in a window, and scenes that begin at time zero, are computed on, on one core, and the clock is
//! read when the promise comes. A window shows no more simulated time than passes on the clock,
//! less in slow motion.
//!
//! `cargo bench --bench openings`, see `benches/README.md`.

use grainfall::run::{BedStore, Opening, Preparation, Prepared, Run, openings};
use grainfall::scene::Scene;
use grainfall::solver::advise;
use std::time::Instant;

/// What scenes promise, and when it comes [s] (`benches/README.md`, by `events.csv` and
/// `series.csv`).
const PROMISES: [(&str, f64); 8] = [
    ("dry-r3", 9.9),
    ("dry-r2", 10.65),
    ("wet", 13.0),
    ("water-drum", 8.3),
    ("honey-drum", 11.0),
    ("two-frictions-drum", 10.0),
    ("two-sizes-drum", 3.4),
    ("two-sizes-wet-drum", 3.4),
];

/// The same of scenes that begin at time zero, and at what speed a window shows them at first.
const BEGINNINGS: [(&str, f64, f64); 6] = [
    ("small-drum", 2.7, 1.0),
    ("bouncing-grain", 0.18, 0.25),
    ("two-grains", 0.07, 0.05),
    ("grain-chain", 0.06, 0.05),
    ("slide-to-roll", 0.29, 0.1),
    ("small-column", 0.28, 0.1),
];

/// Time on the clock [s]: until the file is read, and from then until the run has come to `promise`
/// [s].
fn waits(opening: &Opening, promise: f64) -> (f64, f64) {
    let begun = Instant::now();
    let session = opening.session().expect("a moment of this program");
    let mut timeline = session.into_timeline(1, 0);
    let read = begun.elapsed().as_secs_f64();
    let clock = timeline.run().world().clock;
    let computing = Instant::now();
    timeline
        .advance_to(clock.step_at(promise))
        .expect("a run that goes on");
    (read, computing.elapsed().as_secs_f64())
}

/// The built-in scene called `name` at time zero, on one thread, with the beds that are shipped.
fn beginning(name: &str) -> Run {
    let scene = Scene::open(name).expect("a built-in scene");
    let step = advise(&scene).time_step;
    let mut preparation = Preparation::new(scene.into(), step, 1, BedStore::shipped());
    loop {
        if let Prepared::Ready(run) = preparation.advance().expect("a bed") {
            return *run;
        }
    }
}

/// Time on the clock [s]: until the scene called `name` stands at time zero, and from then until it
/// has come to `promise` [s].
fn waits_from_zero(name: &str, promise: f64) -> (f64, f64) {
    let begun = Instant::now();
    let mut run = beginning(name);
    let opened = begun.elapsed().as_secs_f64();
    let clock = run.world().clock;
    let computing = Instant::now();
    run.advance_to(clock.step_at(promise))
        .expect("a run that goes on");
    (opened, computing.elapsed().as_secs_f64())
}

/// Prints a row: `simulated` time [s] is shown at `speed`.
fn tell(name: &str, (opened, computed): (f64, f64), simulated: f64, speed: f64) {
    let waits = opened + computed.max(simulated / speed);
    println!("| `{name}` | {opened:.2} s | {simulated:.2} s | {computed:.2} s | {waits:.1} s |");
}

fn main() {
    println!("| scene | opens in | promise after, simulated | computed in | one waits |");
    println!("|---|---|---|---|---|");
    for opening in openings() {
        let promised = PROMISES.iter().find(|known| known.0 == opening.scene);
        let (name, promise) = *promised.expect("what it promises");
        tell(name, waits(opening, promise), promise - opening.moment, 1.0);
    }
    for (name, promise, speed) in BEGINNINGS {
        tell(name, waits_from_zero(name, promise), promise, speed);
    }
}
