//! What a scene asks of a machine, before any work is done.
//!
//! In: a scene that was checked. Out: an [`Estimate`] from counts alone (grains, cells, steps,
//! samples, outputs), in words for people, and whether the machine's memory holds it. Times are
//! those of the machine that `benches/README.md` tells of, a factor of a few from any other's.

use crate::files::read_whole;
use crate::measure::Measure;
use crate::scene::SAMPLE_INTERVAL;
use crate::scene::{Scene, SceneGrains};
use crate::solver::advise;
use std::fmt;
use std::path::Path;

/// What a kind of grains takes.
struct Cost {
    /// Of memory, for a grain of a running world with its solver and output [bytes].
    memory: f64,
    /// Of the files of an output, grains and contacts, for each grain [bytes].
    file: f64,
    /// Of one thread's time, for each step of a grain [s].
    time: f64,
}

/// Spheres, dry.
const SPHERE: Cost = Cost {
    memory: 2e3,
    file: 500.0,
    time: 45e-9,
};
/// Spheres with a liquid between them.
const WET_SPHERE: Cost = Cost {
    memory: 3e3,
    file: 600.0,
    time: 60e-9,
};
/// Rounded Voronoi cells, and listed polyhedra.
const POLYHEDRON: Cost = Cost {
    memory: 21e3,
    file: 800.0,
    time: 2e-6,
};
/// Memory that the points of a lattice take while its cells are cut, for each [bytes].
const LATTICE_POINT: f64 = 500.0;
/// Memory of the program itself [bytes].
const PROGRAM: f64 = 20e6;
/// A number of `series.csv` [bytes].
const TABLE_CELL: f64 = 14.0;
/// Simulated time that settling takes, about, in `√(r/g)` of the mean radius.
const SETTLING: f64 = 80.0;
/// Part of the memory that is free which a run may take.
const SHARE_OF_MEMORY: f64 = 0.9;

/// What a run of a scene takes, about.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Grains.
    pub grains: usize,
    /// Steps of the run.
    pub steps: f64,
    /// Memory at its peak [bytes].
    pub memory: f64,
    /// Files of a run without a window [bytes].
    pub files: f64,
    /// Time of one thread, a settling where there is one included [s].
    pub time: f64,
}

/// More memory than there is.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "it asks for {} of memory, and {} are free here: {asked}. Take fewer grains, a shorter duration or larger cells, \
     or start it all the same with --beyond-memory",
    bytes(.asked.memory), bytes(*.free)
)]
pub struct BeyondMemory {
    asked: Box<Estimate>,
    /// Memory that is free [bytes].
    free: f64,
}

impl Estimate {
    /// What a run of `scene` takes.
    pub fn of(scene: &Scene) -> Self {
        let cost = match scene {
            _ if scene.is_polyhedral() => &POLYHEDRON,
            _ if scene.liquid.is_some() => &WET_SPHERE,
            _ => &SPHERE,
        };
        let grains = scene.grain_count();
        let points = match &scene.grains {
            SceneGrains::Voronoi(cells) if cells.packing.is_none() => {
                cells.lattice_size(&scene.container)
            }
            _ => 0.0,
        };
        let time_step = advise(scene).time_step;
        let steps = (scene.duration / time_step).ceil();
        let apart = scene.sample_interval.unwrap_or(SAMPLE_INTERVAL);
        let samples = scene.duration / apart + 1.0;
        let columns = Measure::COUNT as f64 + 2.0;
        let outputs = scene.duration / scene.output_interval + 1.0;
        let settling = settling_time(scene) / time_step;
        let grain = grains as f64;
        Self {
            grains,
            steps,
            // The samples of a run are kept, in vectors that double.
            memory: PROGRAM
                + grain * cost.memory
                + points * LATTICE_POINT
                + 1.5 * 8.0 * columns * samples,
            files: outputs * (grain * cost.file + 2e3) + samples * columns * TABLE_CELL,
            time: (steps + settling) * grain * cost.time,
        }
    }

    /// Whether the memory that is free now holds it; where that is not known, it does.
    ///
    /// # Errors
    /// What it asks for and what there is.
    pub fn fits_into_memory(&self) -> Result<(), BeyondMemory> {
        self.fits_into(free_memory())
    }

    fn fits_into(&self, free: Option<f64>) -> Result<(), BeyondMemory> {
        match free {
            Some(free) if self.memory > SHARE_OF_MEMORY * free => Err(BeyondMemory {
                asked: Box::new(self.clone()),
                free,
            }),
            _ => Ok(()),
        }
    }

    /// What `at_once` runs of it at the same time take at their peak.
    #[must_use]
    pub fn side_by_side(self, at_once: usize) -> Self {
        Self {
            memory: at_once as f64 * self.memory,
            ..self
        }
    }
}

impl fmt::Display for Estimate {
    /// `470 grains, 1.2 million steps: some 21 MB of memory, 14 MB of files, 25 s on one thread`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} grains, {} steps: some {} of memory, {} of files, {} on one thread",
            self.grains,
            many(self.steps),
            bytes(self.memory),
            bytes(self.files),
            duration(self.time)
        )
    }
}

/// Simulated time that the bed of `scene` takes to settle [s], none where none does.
fn settling_time(scene: &Scene) -> f64 {
    let gravity = scene.gravity.length();
    match &scene.grains {
        SceneGrains::Fill { species, .. } if gravity > 0.0 => {
            let mean: f64 = species.iter().map(|kind| kind.share * kind.radius).sum();
            SETTLING * (mean / gravity).sqrt()
        }
        _ => 0.0,
    }
}

fn many(number: f64) -> String {
    match number {
        n if n < 1e4 => format!("{n:.0}"),
        n if n < 1e6 => format!("{:.0} thousand", n / 1e3),
        n if n < 1e9 => format!("{:.1} million", n / 1e6),
        n => format!("{n:.1e}"),
    }
}

fn bytes(number: f64) -> String {
    match number {
        n if n < 1e6 => format!("{:.0} kB", n / 1e3),
        n if n < 1e9 => format!("{:.0} MB", n / 1e6),
        n if n < 1e12 => format!("{:.1} GB", n / 1e9),
        n => format!("{:.1} TB", n / 1e12),
    }
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "a second".to_owned(),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} h", s / 3600.0),
        s if s < 1e9 => format!("{:.0} days", s / 86_400.0),
        s => format!("{:.0} years", s / 31_557_600.0),
    }
}

/// Memory that a program can have now [bytes]; none where the system does not say.
fn free_memory() -> Option<f64> {
    let read = |path: &str| {
        // A system without such a file says nothing.
        let bytes = read_whole(Path::new(path), 1 << 20).ok()?;
        String::from_utf8(bytes).ok()
    };
    let available = available(&read("/proc/meminfo")?)?;
    let of_group = read("/sys/fs/cgroup/memory.max").and_then(|text| text.trim().parse().ok());
    Some(of_group.map_or(available, |most: f64| available.min(most)))
}

/// What `/proc/meminfo` says is available [bytes].
fn available(text: &str) -> Option<f64> {
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * kilobytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_system_says_is_read() {
        let text = "MemTotal:       24103000 kB\nMemAvailable:    1000000 kB\nBuffers: 1 kB\n";
        assert_eq!(available(text), Some(1.024e9));
        assert_eq!(available("nothing"), None);
    }

    #[test]
    fn a_run_that_asks_for_more_than_there_is_is_refused_and_told_why() {
        let mut scene = Scene::open("small-drum").unwrap();
        let estimate = Estimate::of(&scene);
        assert!(estimate.memory < 3e7, "{estimate}");
        assert_eq!(estimate.fits_into(Some(1e9)), Ok(()));
        assert_eq!(estimate.fits_into(None), Ok(()));
        scene.set("output-interval", "100s").unwrap();
        scene.set("duration", "1000000s").unwrap();
        let long = Estimate::of(&scene);
        assert!(long.memory > 1e10, "{long}");
        let refusal = long.fits_into(Some(8e9)).unwrap_err().to_string();
        assert!(
            refusal.contains("--beyond-memory") && refusal.contains("8.0 GB"),
            "{refusal}"
        );
    }
}
