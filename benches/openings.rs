//! How long somebody waits for what a scene promises, from Play on: the moments at which drums open
//! in a window are computed on, on one core, and the clock is read when the promise comes. A window
//! shows no more simulated time than passes on the clock.
//!
//! `cargo bench --bench openings`, see `benches/README.md`.

use grainfall::run::{Opening, openings};
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

fn main() {
    println!("| scene | opens in | promise after, simulated | computed in | one waits |");
    println!("|---|---|---|---|---|");
    for opening in openings() {
        let promised = PROMISES.iter().find(|known| known.0 == opening.scene);
        let (name, promise) = *promised.expect("what it promises");
        let simulated = promise - opening.moment;
        let (read, computed) = waits(opening, promise);
        let waits = read + computed.max(simulated);
        println!("| `{name}` | {read:.2} s | {simulated:.2} s | {computed:.2} s | {waits:.1} s |");
    }
}
