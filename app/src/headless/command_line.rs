//! The command line: every command, option and word of help.
//!
//! In: words. Out: what is asked for, or why it cannot be, in words; manual pages and what shells
//! complete come from the same.

use super::{Allowed, ImportTask, PaperTask, Said, SweepTask};
#[cfg(feature = "desktop")]
use crate::picture_size;
#[cfg(feature = "desktop")]
use bevy::math::UVec2;
use clap::{Args, Parser, Subcommand};
use grainfall::engines::MpiEngine;
#[cfg(feature = "desktop")]
use grainfall::physics::units::seconds;
use std::path::PathBuf;

/// An interactive laboratory for granular matter.
///
/// Opens a scene in a window, or runs it without one and writes its numbers to files.
#[derive(Parser)]
#[command(version, args_conflicts_with_subcommands = true, args_override_self = true, after_help = EXIT_CODES)]
#[cfg_attr(feature = "desktop", command(group(clap::ArgGroup::new("pictured").args(["screenshot", "record"]))))]
pub struct Arguments {
    /// What to open.
    #[command(flatten)]
    pub what: What,
    /// Run without a window, as fast as the machine can, and write files
    #[arg(long)]
    pub no_render: bool,
    /// Folder for the files of a run without a window [default: out/SCENE]. The same command goes
    /// on there where it was stopped
    #[arg(long, value_name = "DIR", requires = "no_render")]
    pub out: Option<PathBuf>,
    /// What a person allows.
    #[command(flatten)]
    pub allowed: Allowed,
    /// Begin anew, in the place of the run that the folder holds
    #[arg(long, requires = "no_render")]
    pub restart: bool,
    /// What is said at the end.
    #[command(flatten)]
    pub said: Said,
    /// Make a film of a run without a window, or of the folder of a run: FILE.gif, FILE.mp4, FILE.webm or
    /// FILE.mov (with ffmpeg), or a folder of PNG files. No display is needed, but a Vulkan driver, which may be a software one
    #[arg(long, value_name = "FILE", requires = "no_render")]
    pub record: Option<PathBuf>,
    /// A picture to take.
    #[cfg(feature = "desktop")]
    #[command(flatten)]
    pub picture: PictureArguments,
    /// What to do instead of opening a scene.
    #[command(subcommand)]
    pub task: Option<Task>,
}

/// A picture that the program takes by itself.
#[cfg(feature = "desktop")]
#[derive(Args)]
pub struct PictureArguments {
    /// Open with two runs side by side, the right one with this value of a live parameter:
    /// viscosity=1.41
    #[arg(long, value_name = "KEY=VALUE", conflicts_with = "no_render")]
    pub compare: Option<String>,
    /// Take a picture of the window and end
    #[arg(long, value_name = "FILE.png", conflicts_with = "no_render")]
    pub screenshot: Option<PathBuf>,
    /// Simulated time at which the picture is taken, or the film begins: 13s, 500ms
    #[arg(long, value_name = "TIME", default_value = "0s", requires = "pictured", value_parser = moment)]
    pub at: f64,
    /// Take the picture without a display
    #[arg(long, requires = "screenshot")]
    pub offscreen: bool,
    /// Take the picture, or the film, of the grains alone, without panels, clock and scale bar
    #[arg(long, requires = "pictured")]
    pub plain: bool,
    /// Take the picture of the grains alone and without a background: a PNG file with an alpha channel
    #[arg(long, requires = "screenshot")]
    pub transparent: bool,
    /// Width and height of the picture, or of the film, in pixels
    #[arg(long, value_name = "WxH", default_value = "1440x860", requires = "pictured", value_parser = picture_size::read)]
    pub size: UVec2,
    /// Simulated seconds for each second of the film [default: 1, less where the scene lasts less than
    /// 5 s]
    #[arg(long, value_name = "FACTOR", requires = "record", value_parser = speed)]
    pub speed: Option<f64>,
    /// Frames for each second of the film
    #[arg(long, value_name = "FRAMES", default_value = "25", requires = "record", value_parser = frame_rate)]
    pub frame_rate: f64,
}

/// `30`.
#[cfg(feature = "desktop")]
fn frame_rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate| (1.0..=60.0).contains(rate));
    rate.ok_or_else(|| "expected frames a second from 1 to 60, such as 30".to_owned())
}

/// `0.25`.
#[cfg(feature = "desktop")]
fn speed(text: &str) -> Result<f64, String> {
    let factor = text
        .parse()
        .ok()
        .filter(|factor| (1e-6..=1e6).contains(factor));
    factor.ok_or_else(|| "expected a factor from 0.000001 to 1000000, such as 0.25".to_owned())
}

/// `13s`.
#[cfg(feature = "desktop")]
fn moment(text: &str) -> Result<f64, String> {
    seconds(text)
        .filter(|time| *time >= 0.0)
        .ok_or_else(|| "expected a time such as `13s`, `500ms` or `2min`".to_owned())
}

/// What to open and what to change about it.
#[derive(Args)]
pub struct What {
    /// A scene file, a session saved in the window, the folder of a run, the name of a built-in
    /// scene, or - for a scene on standard input
    pub scene: Option<String>,
    /// Simulated time of a run without a window: 10s, 500ms
    #[arg(long, allow_hyphen_values = true, value_name = "TIME")]
    pub duration: Option<String>,
    /// Simulated time between two written states: 0.1s, 20ms
    #[arg(long, allow_hyphen_values = true, value_name = "TIME")]
    pub output_interval: Option<String>,
    /// Simulated time between two samples: 1ms, 10us [default: 20 ms, and less while a column falls or few grains
    /// meet]
    #[arg(long, allow_hyphen_values = true, value_name = "TIME")]
    pub sample_interval: Option<String>,
    /// Length of a step: automatic, reference, fast, 10us
    #[arg(long, allow_hyphen_values = true, value_name = "TIME")]
    pub time_step: Option<String>,
    /// Seed of everything random
    #[arg(long, allow_hyphen_values = true, value_name = "N")]
    pub seed: Option<String>,
    /// Change a value: friction.glass.glass=0.3, drum-speed=1rpm, count=200 (may be repeated)
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Threads the solver works on [default: all cores, one less with a window]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=512))]
    pub threads: Option<u16>,
    /// Commands to carry out when their time comes: a list in RON or JSON, a run's summary.json, or
    /// a session
    #[arg(long, value_name = "FILE")]
    pub commands: Option<PathBuf>,
}

#[derive(Subcommand)]
#[expect(missing_docs, reason = "it would be printed as the program's own help")]
pub enum Task {
    /// Run a scene's variations side by side and set their results beside each other
    ///
    /// Stopped with Ctrl-C or killed, it goes on where it was when it is called again; called twice
    /// at the same time, both share the cases. On a cluster each job runs one of them, see --count,
    /// --case and --merge. Results: table.csv, table.md and plots.
    Sweep(SweepTask),
    /// Run a paper's cases, or go on with them, and make its tables and figures
    ///
    /// Stopped with Ctrl-C or killed, it goes on where it was when it is called again; the cases that
    /// tell most come first. Results: tables.md, statements.md, ensembles.csv, table.csv and plots.
    Paper(PaperTask),
    /// Compute a run again and confirm that it comes to the same state, to the bit
    Verify {
        /// A run's summary.json, a session or a list of changes saved in the window, or the folder of
        /// a sweep
        file: PathBuf,
        /// Threads the solver works on [default: all cores]
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=512))]
        threads: Option<u16>,
    },
    /// List the scenes that come with the program
    Scenes {
        /// As JSON
        #[arg(long)]
        json: bool,
    },
    /// List what can be set in a scene: key, value, range, when it acts, what it does
    Settings {
        /// A scene file, or the name of a built-in scene
        scene: String,
        /// As JSON, in SI units
        #[arg(long)]
        json: bool,
    },
    /// Say what limits a scene's time step, and what longer and shorter ones cost in accuracy
    ///
    /// Of the steps `reference`, `standard` (`automatic`) and `fast`, and of the one that the scene gives: how an impact of two
    /// of its smallest grains comes out, computed with each.
    TimeSteps {
        /// A scene file, or the name of a built-in scene
        scene: String,
        /// Change a value, as in a single run: friction.glass.glass=0.3, integrator=implicit
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// As JSON, in SI units
        #[arg(long)]
        json: bool,
    },
    /// Cut a scene's Voronoi cells to grains and write them to a file, for `packing` in scenes
    Pack {
        /// A scene file, or the name of a built-in scene
        scene: String,
        /// Change a value, as in a single run: height=10cm, solid-fraction=0.55
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// The file
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
    /// Write what another engine takes to run a scene on many machines, by MPI: spheres, columns of polyhedra
    ///
    /// A folder with script, data file of the settled bed, meshes and DEVIATIONS.txt, which says
    /// what the engine does otherwise. What it does not have is refused.
    Export {
        /// The scene.
        #[command(flatten)]
        what: What,
        /// The engine: liggghts, lammps or exadem
        #[arg(long, value_name = "ENGINE")]
        to: MpiEngine,
        /// The folder
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// Leave it to the engine to settle the bed: for more grains than settle here
        #[arg(long)]
        unsettled: bool,
        /// What is said at the end.
        #[command(flatten)]
        said: Said,
    },
    /// Measure what another engine computed and write it as a run's folder
    ///
    /// Dumps and data files of LIGGGHTS and LAMMPS and XYZ of exaDEM become series.csv, summary.json, grains.pvd …; what
    /// takes forces or the memory of contacts is left out.
    Import(ImportTask),
    /// Print what a shell needs to complete commands and options
    ///
    /// For bash: grainfall completions bash > ~/.local/share/bash-completion/completions/grainfall
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Write manual pages, one for each command: grainfall.1, grainfall-sweep.1 …
    Man {
        /// The folder
        folder: PathBuf,
    },
    /// Settle a scene's bed and write it to a file
    #[command(hide = true)]
    Bed {
        /// A scene file, or the name of a built-in scene
        scene: String,
        /// The file
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
    /// Compute the moments at which scenes open in a window, each into a file of its own
    #[command(hide = true)]
    Opening {
        /// The folder; what is in it and is what this program makes stays
        #[arg(long, value_name = "FOLDER")]
        out: PathBuf,
    },
}

const EXIT_CODES: &str = "Exit codes: 0 done, 1 files could not be written or the machine gives too little, 2 bad input, \
                          3 physical fault, 4 another state than a file states, 5 another program writes to the \
                          output folder, 130 interrupted";
