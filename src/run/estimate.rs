//! What a scene asks of a machine, before any work is done.
//!
//! In: a scene that was checked. Out: an [`Estimate`] from counts alone (grains, cells, steps,
//! samples, outputs), in words for people, and whether the machine's memory and disk hold it. Times
//! are those of the machine that `benches/README.md` tells of, a factor of a few from any other's.

use super::machine::{free_disk, free_memory};
use super::settling::settling_step;
use crate::measure::Measure;
use crate::physics::Integrator;
use crate::scene::SAMPLE_INTERVAL;
use crate::scene::{Scene, SceneContainer, SceneGrains};
use crate::solver::advise;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

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
    time: 60e-9,
};
/// Spheres with a liquid between them.
const WET_SPHERE: Cost = Cost {
    memory: 3e3,
    file: 600.0,
    time: 80e-9,
};
/// Rounded Voronoi cells, and listed polyhedra.
const POLYHEDRON: Cost = Cost {
    memory: 21e3,
    file: 800.0,
    time: 2e-6,
};
/// The same with springs and dashpots of all of them taken implicitly.
const IMPLICIT_POLYHEDRON: Cost = Cost {
    time: 5e-6,
    ..POLYHEDRON
};
/// Beds of so many spheres take twice as long a grain, the largest ones three times: what a step reads
/// and writes of them is more than caches hold.
const BEYOND_CACHES: f64 = 5e4;
/// Memory that the points of a lattice take while its cells are cut, for each [bytes].
const LATTICE_POINT: f64 = 500.0;
/// Files that state a triangle of a mesh: records as text, checkpoints [bytes].
const TRIANGLE: f64 = 1e3;
/// Memory of the program itself [bytes].
const PROGRAM: f64 = 20e6;
/// A number of `series.csv` [bytes].
const TABLE_CELL: f64 = 14.0;
/// Simulated time that settling takes, about, in `√(r/g)` of the mean radius.
const SETTLING: f64 = 80.0;
/// Settling from which on people are told how long it takes [s].
const LONG_SETTLING: f64 = 60.0;
/// Settling before which a window asks whether that is meant [s].
const LONGEST_UNASKED: f64 = 900.0;
/// What makes a bed settle sooner.
const SETTLES_SOONER: &str = "fewer, larger or softer small grains settle sooner";
/// Part of the memory, or of the disk, that is free which a run may take.
const SHARE: f64 = 0.9;

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
    /// What of these is grains and contacts at each output [bytes].
    frames: f64,
    /// Time of one thread, a settling where there is one included [s].
    pub time: f64,
    /// What of it is settling [s].
    pub settling: f64,
}

/// More than the machine has.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BeyondMachine {
    /// More memory than there is.
    #[error(
        "it asks for {} of memory, and {} are free here: {asked}. Take fewer grains, a shorter duration or larger \
         cells, or start it all the same with --beyond-memory",
        bytes(.asked.memory), bytes(*.free)
    )]
    Memory {
        /// What is asked for.
        asked: Box<Estimate>,
        /// Memory that is free [bytes].
        free: f64,
    },
    /// More files than the disk has room for.
    #[error(
        "its files will take {} or so, and the disk of {} has room for {}: {asked}. Take a longer --output-interval, \
         fewer grains, a shorter duration or another --out, or start it all the same with --beyond-disk",
        bytes(.asked.files), .out.display(), bytes(*.free)
    )]
    Disk {
        /// What is asked for.
        asked: Box<Estimate>,
        /// Where the files go.
        out: PathBuf,
        /// What is free there, or taken by files of this run [bytes].
        free: f64,
    },
}

impl BeyondMachine {
    /// The same for a person in a window, where there are no options.
    pub fn in_a_window(&self) -> String {
        match self {
            Self::Memory { asked, free } => format!(
                "These runs ask for {} of memory at the same time, and {} are free: take fewer grains or shorter runs.",
                bytes(asked.memory),
                bytes(*free)
            ),
            Self::Disk { asked, out, free } => format!(
                "Their files will take {} or so, and the disk of {} has room for {}: take fewer or shorter runs, or \
                 another folder.",
                bytes(asked.files),
                out.display(),
                bytes(*free)
            ),
        }
    }
}

impl Estimate {
    /// What a run of `scene` takes.
    pub fn of(scene: &Scene) -> Self {
        let cost = match scene {
            _ if scene.is_polyhedral() && scene.integrator == Integrator::Implicit => {
                &IMPLICIT_POLYHEDRON
            }
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
        let settling = settling_time(scene) / settling_step(scene);
        let grain = grains as f64;
        let slower = if scene.is_polyhedral() {
            1.0
        } else {
            1.0 + 2.0 * grain / (grain + BEYOND_CACHES)
        };
        let step = grain * slower * cost.time;
        let series = samples * columns;
        let frames = outputs * (grain * cost.file + 2e3);
        let (mesh, triangles) = match &scene.container {
            SceneContainer::Mesh { surface, .. } => {
                (surface.memory() as f64, surface.triangles().len() as f64)
            }
            _ => (0.0, 0.0),
        };
        // A checkpoint is replaced by one that lies beside it until it is whole.
        let checkpoints = 2.0 * grain * cost.file + 8.0 * series;
        Self {
            grains,
            steps,
            // A run has all its samples at its end, in vectors that double.
            memory: PROGRAM
                + mesh
                + grain * cost.memory
                + points * LATTICE_POINT
                + 1.5 * 8.0 * series,
            files: frames + checkpoints + series * TABLE_CELL + triangles * TRIANGLE,
            frames,
            time: (steps + settling) * step,
            settling: settling * step,
        }
    }

    /// What it takes to come to the first state of `scene` and to write it: nothing is run.
    pub fn of_start(scene: &Scene) -> Self {
        Self::of(&Scene {
            duration: 0.0,
            ..scene.clone()
        })
    }

    /// The same where the grains stay as they are placed: nothing settles.
    #[must_use]
    pub fn unsettled(self) -> Self {
        Self {
            time: self.time - self.settling,
            settling: 0.0,
            ..self
        }
    }

    /// What a window asks before it opens what this is the start of ([`Estimate::of_start`]); none
    /// where nothing speaks against it.
    pub fn question(&self) -> Option<String> {
        self.question_with(free_memory())
    }

    fn question_with(&self, free: Option<f64>) -> Option<String> {
        let mut said = Vec::new();
        if let Err(BeyondMachine::Memory { free, .. }) = self.fits_into(free) {
            let (asked, free) = (bytes(self.memory), bytes(free));
            said.push(format!(
                "This scene asks for {asked} of memory, and {free} are free: the machine may come to a halt. Fewer \
                 grains or larger cells take less."
            ));
        }
        if self.settling > LONGEST_UNASKED {
            let settling = duration(self.settling);
            said.push(format!(
                "Its bed takes some {settling} of one thread to settle before its run begins; {SETTLES_SOONER}."
            ));
        }
        (!said.is_empty()).then(|| said.join(" ") + " Open it all the same?")
    }

    /// Whether the memory that is free now holds it; where that is not known, it does.
    ///
    /// # Errors
    /// What it asks for and what there is.
    pub fn fits_into_memory(&self) -> Result<(), BeyondMachine> {
        self.fits_into(free_memory())
    }

    fn fits_into(&self, free: Option<f64>) -> Result<(), BeyondMachine> {
        match free {
            Some(free) if self.memory > SHARE * free => Err(BeyondMachine::Memory {
                asked: Box::new(self.clone()),
                free,
            }),
            _ => Ok(()),
        }
    }

    /// Whether there is room for its files in the folder `out`; where that is not known, there is.
    /// What lies in the folder already is a part of them, or gives way to them.
    ///
    /// # Errors
    /// What it asks for and what there is.
    pub fn fits_onto_disk(&self, out: &Path) -> Result<(), BeyondMachine> {
        self.fits_onto(free_disk(out), out)
    }

    fn fits_onto(&self, free: Option<f64>, out: &Path) -> Result<(), BeyondMachine> {
        let Some(free) = free.filter(|free| self.files > SHARE * free) else {
            return Ok(());
        };
        let free = free + taken(out);
        if self.files <= SHARE * free {
            return Ok(());
        }
        Err(BeyondMachine::Disk {
            asked: Box::new(self.clone()),
            out: out.to_owned(),
            free,
        })
    }

    /// What runs of these `scenes` take together, `at_once` of them at the same time, without the
    /// grains at each output.
    pub fn of_cases<'a>(scenes: impl IntoIterator<Item = &'a Scene>, at_once: usize) -> Self {
        let all: Vec<Self> = scenes.into_iter().map(Self::of).collect();
        let sum = |of: fn(&Self) -> f64| all.iter().map(of).sum::<f64>();
        let mut memory: Vec<f64> = all.iter().map(|case| case.memory).collect();
        memory.sort_by(|a, b| b.total_cmp(a));
        Self {
            grains: all.iter().map(|case| case.grains).max().unwrap_or(0),
            steps: sum(|case| case.steps),
            memory: memory.iter().take(at_once).sum(),
            files: sum(|case| case.files - case.frames),
            frames: 0.0,
            time: sum(|case| case.time),
            settling: sum(|case| case.settling),
        }
    }
}

/// What the files below `folder` take [bytes]; what cannot be read takes nothing.
fn taken(folder: &Path) -> f64 {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let sizes = entries.map(|entry| match entry.metadata() {
        Ok(found) if found.is_dir() => taken(&entry.path()),
        Ok(found) => found.len() as f64,
        Err(_) => 0.0,
    });
    sizes.sum()
}

impl fmt::Display for Estimate {
    /// `470 grains, 1.2 million steps: some 21 MB of memory, 14 MB of files, 25 s on one thread`,
    /// and how much of that is settling where it is long.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} grains", self.grains)?;
        if self.steps > 0.0 {
            write!(f, ", {} steps", many(self.steps))?;
        }
        write!(
            f,
            ": some {} of memory, {} of files, {} on one thread",
            bytes(self.memory),
            bytes(self.files),
            duration(self.time)
        )?;
        if self.settling <= LONG_SETTLING {
            return Ok(());
        }
        write!(f, ", {} of these to settle", duration(self.settling))?;
        if self.settling > LONGEST_UNASKED {
            write!(f, " ({SETTLES_SOONER})")?;
        }
        Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;

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

    /// Twenty thousand grains, the small ones a thousand times smaller: a step of nanoseconds.
    #[test]
    fn settling_that_takes_hours_is_told_with_the_way_out_and_asked_about() {
        let text = "(title: \"dust\", materials: {\"m\": ()}, container: Box(min: (0, 0, 0), max: (0.02, 0.1, 0.02), \
                    material: \"m\"), grains: Fill(count: 20000, species: [(name: \"large\", radius_mm: 5, \
                    material: \"m\", share: 0.0001), (name: \"small\", radius_mm: 0.005, material: \"m\", share: 0.9999)]))";
        let scene = Scene::parse("dust.ron", text).unwrap();
        let start = Estimate::of_start(&scene);
        assert!(start.settling > LONGEST_UNASKED, "{start}");
        assert_eq!(start.time, start.settling);
        let said = start.to_string();
        assert!(
            said.contains("to settle") && said.contains(SETTLES_SOONER),
            "{said}"
        );
        let asked = start.question_with(None).unwrap();
        assert!(
            asked.contains(SETTLES_SOONER) && asked.ends_with('?'),
            "{asked}"
        );
        let placed = start.unsettled();
        assert_eq!(
            (placed.settling, placed.time, placed.question_with(None)),
            (0.0, 0.0, None)
        );
        let small = Estimate::of_start(&Scene::open("small-drum").unwrap());
        assert_eq!(small.question_with(Some(1e9)), None);
        assert!(!small.to_string().contains("settle"), "{small}");
        let asked = small.question_with(Some(1e6)).unwrap();
        assert!(
            asked.contains("1 MB are free") || asked.contains("1000 kB"),
            "{asked}"
        );
        assert!(
            !asked.contains("--beyond"),
            "a window has no options: {asked}"
        );
    }

    #[test]
    fn files_that_no_disk_holds_are_refused_but_for_those_that_are_there() {
        let folder = tempfile::tempdir().unwrap();
        let estimate = Estimate::of(&Scene::open("small-drum").unwrap());
        let fits = |free| estimate.fits_onto(Some(free), folder.path());
        assert_eq!(fits(2.0 * estimate.files), Ok(()));
        let refusal = fits(0.5 * estimate.files).unwrap_err().to_string();
        assert!(
            refusal.contains("--beyond-disk") && refusal.contains("--output-interval"),
            "{refusal}"
        );
        let whole = vec![0; estimate.files as usize];
        std::fs::create_dir(folder.path().join("grains")).unwrap();
        std::fs::write(folder.path().join("grains/a.vtp"), whole).unwrap();
        assert_eq!(fits(0.5 * estimate.files), Ok(()));
        let scene = Scene::open("small-drum").unwrap();
        let cases = Estimate::of_cases(&vec![scene; 10], 4);
        assert!(cases.files < 10.0 * estimate.files && cases.memory == 4.0 * estimate.memory);
    }
}
