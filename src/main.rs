//! The command line: what to open, what to change, and whether a window is wanted.
//!
//! Exit codes: 0 done, 1 files could not be written, 2 bad input, 3 physical fault, 4 another state
//! than a file states, 5 another program writes to the output folder, 130 interrupted.

use clap::{Args, Parser, Subcommand};
use grainfall::engines::MpiEngine;
use grainfall::headless::terminal::{say, tell};
use grainfall::headless::{
    self, Allowed, ImportTask, PaperTask, Report, Said, SweepTask, check_threads, interruption,
};
use grainfall::parameters::Settings;
#[cfg(feature = "desktop")]
use grainfall::physics::units::seconds;
#[cfg(feature = "desktop")]
use grainfall::runner::compared_value;
use grainfall::runner::{Job, RunnerError, apply_settings, available_threads, exit, read_commands};
use grainfall::scene::{Scene, built_in};
use grainfall::simulation::{Estimate, Kept, ScriptedCommand};
#[cfg(feature = "desktop")]
use grainfall::simulation::{OPENING_SCENE, Options, Session, opening};
#[cfg(feature = "desktop")]
use grainfall::window::Opened;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// An interactive laboratory for granular matter.
///
/// Opens a scene in a window, or runs it without one and writes its numbers to files.
#[derive(Parser)]
#[command(version, args_conflicts_with_subcommands = true, args_override_self = true, after_help = EXIT_CODES)]
struct Arguments {
    #[command(flatten)]
    what: What,
    /// Run without a window, as fast as the machine can, and write files
    #[arg(long)]
    no_render: bool,
    /// Folder for the files of a run without a window [default: out/<scene>]. The same command goes
    /// on there where it was stopped
    #[arg(long, value_name = "DIR", requires = "no_render")]
    out: Option<PathBuf>,
    #[command(flatten)]
    allowed: Allowed,
    /// Begin anew, in the place of the run that the folder holds
    #[arg(long, requires = "no_render")]
    restart: bool,
    #[command(flatten)]
    said: Said,
    #[cfg(feature = "desktop")]
    #[command(flatten)]
    picture: PictureArguments,
    #[command(subcommand)]
    task: Option<Task>,
}

/// A picture that the program takes by itself.
#[cfg(feature = "desktop")]
#[derive(Args)]
struct PictureArguments {
    /// Open with two runs side by side, the right one with this value of a live parameter:
    /// viscosity=1.41
    #[arg(long, value_name = "KEY=VALUE", conflicts_with = "no_render")]
    compare: Option<String>,
    /// Take a picture of the window and end
    #[arg(long, value_name = "FILE.png", conflicts_with = "no_render")]
    screenshot: Option<PathBuf>,
    /// Simulated time at which the picture is taken: 13s, 500ms
    #[arg(long, value_name = "TIME", default_value = "0s", requires = "screenshot", value_parser = moment)]
    at: f64,
    /// Take the picture without a display
    #[arg(long, requires = "screenshot")]
    offscreen: bool,
    /// Take the picture of the grains alone, without panels
    #[arg(long, requires = "screenshot")]
    plain: bool,
    /// Width and height of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "1440x860", requires = "screenshot", value_parser = size)]
    size: (u32, u32),
}

/// `13s`.
#[cfg(feature = "desktop")]
fn moment(text: &str) -> Result<f64, String> {
    seconds(text)
        .filter(|time| *time >= 0.0)
        .ok_or_else(|| "expected a time such as `13s`, `500ms` or `2min`".to_owned())
}

/// `1280x720`.
#[cfg(feature = "desktop")]
fn size(text: &str) -> Result<(u32, u32), String> {
    let side = |text: &str| text.parse().ok().filter(|side| (64..=8192).contains(side));
    text.split_once('x')
        .and_then(|(width, height)| Some((side(width)?, side(height)?)))
        .ok_or_else(|| "expected WIDTHxHEIGHT, each 64 to 8192, such as 1280x720".to_owned())
}

/// What to open and what to change about it.
#[derive(Args)]
struct What {
    /// A scene file, a session saved in the window, the folder of a run, or the name of a built-in scene
    scene: Option<String>,
    /// Simulated time of a run without a window: 10s, 500ms
    #[arg(long, allow_hyphen_values = true, value_name = "TIME")]
    duration: Option<String>,
    /// Simulated time between two written states: 0.1s, 20ms
    #[arg(long, allow_hyphen_values = true, value_name = "TIME")]
    output_interval: Option<String>,
    /// Simulated time between two samples: 1ms, 10us [default: 20 ms, and less while a column falls or few grains
    /// meet]
    #[arg(long, allow_hyphen_values = true, value_name = "TIME")]
    sample_interval: Option<String>,
    /// Length of a step: automatic, 10us
    #[arg(long, allow_hyphen_values = true, value_name = "TIME")]
    time_step: Option<String>,
    /// Seed of everything random
    #[arg(long, allow_hyphen_values = true, value_name = "N")]
    seed: Option<String>,
    /// Change a value: friction.glass.glass=0.3, drum-speed=1rpm, count=200 (may be repeated)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Threads the solver works on [default: all cores, one less with a window]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=512))]
    threads: Option<u16>,
    /// Commands to carry out when their time comes: a list in RON or JSON, a run's summary.json, or
    /// a session
    #[arg(long, value_name = "FILE")]
    commands: Option<PathBuf>,
}

#[derive(Subcommand)]
enum Task {
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
        /// A run's summary.json, or a session or a list of changes saved in the window
        file: PathBuf,
        /// Threads the solver works on [default: all cores]
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=512))]
        threads: Option<u16>,
    },
    /// List what can be set in a scene: key, value, range, when it acts, what it does
    Settings {
        /// A scene file, or the name of a built-in scene
        scene: String,
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
    /// Write what another engine takes to run a scene of spheres on many machines, by MPI
    ///
    /// A folder with script, data file of the settled bed, meshes and DEVIATIONS.txt, which says
    /// what the engine does otherwise. What it does not have is refused.
    Export {
        #[command(flatten)]
        what: What,
        /// The engine: liggghts or lammps
        #[arg(long, value_name = "ENGINE")]
        to: MpiEngine,
        /// The folder
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// Leave it to the engine to settle the bed: for more grains than settle here
        #[arg(long)]
        unsettled: bool,
        #[command(flatten)]
        said: Said,
    },
    /// Measure what another engine computed and write it as a run's folder
    ///
    /// Dumps and data files of LIGGGHTS and LAMMPS become series.csv, summary.json, grains.pvd …; what
    /// takes forces or the memory of contacts is left out.
    Import(ImportTask),
    /// Settle a scene's bed and write it to a file
    #[command(hide = true)]
    Bed {
        /// A scene file, or the name of a built-in scene
        scene: String,
        /// The file
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
    /// Compute the run that the window opens with and write it to a file
    #[command(hide = true)]
    Opening {
        /// The file
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
}

const EXIT_CODES: &str = "Exit codes: 0 done, 1 files could not be written or the machine gives too little, 2 bad input, \
                          3 physical fault, 4 another state than a file states, 5 another program writes to the \
                          output folder, 130 interrupted";

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match carry_out(arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            print_chain(&error);
            ExitCode::from(error.exit_code())
        }
    }
}

fn carry_out(arguments: Arguments) -> Result<u8, RunnerError> {
    let allowed = arguments.allowed;
    allowed.take_effect();
    match arguments.task {
        Some(Task::Bed { scene, out }) => return headless::write_bed(&scene, &allowed, &out),
        Some(Task::Opening { out }) => return headless::write_opening(&out),
        Some(Task::Verify { file, threads }) => {
            let threads = checked_threads(threads, Report::Text)?;
            return headless::confirm(&file, threads, &allowed, &*interruption()?);
        }
        Some(Task::Settings { scene, json }) => return list_settings(&scene, json),
        Some(Task::Pack { scene, set, out }) => {
            return headless::write_packing(&scene, &set, &allowed, &out);
        }
        Some(Task::Sweep(task)) => return run_sweep(&task, &allowed),
        Some(Task::Import(task)) => return task.carry_out(),
        Some(Task::Export {
            what,
            to,
            out,
            unsettled,
            said,
        }) => return export_scene(&what, to, (out, !unsettled), (&allowed, said.report())),
        Some(Task::Paper(task)) => return run_paper(&task, &allowed),
        None => {}
    }
    let what = arguments.what;
    #[cfg(feature = "desktop")]
    if let Some(session) = opening_session(&what, &arguments.picture, arguments.no_render) {
        let options = window_options(&what, Vec::new());
        let name = OPENING_SCENE.to_owned();
        return open_window(
            name,
            Opened::Shipped(session.into()),
            options,
            arguments.picture,
        );
    }
    let name = what.scene.clone().unwrap_or_else(first_scene);
    #[cfg(feature = "desktop")]
    if Kept::is_at(&name) && !arguments.no_render {
        let opened = unchanged(&name, &what)?;
        let options = window_options(&what, Vec::new());
        return open_window(name, opened, options, arguments.picture);
    }
    if Kept::is_at(&name) {
        return Err(RunnerError::Input(format!(
            "{name} holds what was computed: it opens in a window, and `grainfall verify` computes it again without one"
        )));
    }
    let (scene, script) = changed_scene(&name, &what)?;
    if !arguments.no_render {
        #[cfg(feature = "desktop")]
        allowed.memory(&Estimate::of_start(&scene))?;
        #[cfg(feature = "desktop")]
        return open_window(
            name,
            scene.into(),
            window_options(&what, script),
            arguments.picture,
        );
        #[cfg(not(feature = "desktop"))]
        return Err(RunnerError::Input(NO_WINDOW.into()));
    }
    let name = short_name(&name);
    let out = arguments.out.unwrap_or(Path::new("out").join(&name));
    let report = arguments.said.report();
    let interruption = interruption()?;
    let job = Job {
        threads: checked_threads(what.threads, report)?,
        script,
        checkpoints: true,
        restart: arguments.restart,
        ..Job::new(name, scene, out)
    };
    allowed.begin(&Estimate::of(&job.scene), &job.out, report)?;
    let ending = headless::run(&job, report, &interruption)?;
    Ok(ending.exit_code())
}

/// The threads asked for, or as many as there are cores; says where they are more.
///
/// # Errors
/// When the machine does not give so many.
fn checked_threads(asked: Option<u16>, report: Report) -> Result<usize, RunnerError> {
    let cores = available_threads();
    let threads = asked.map_or(cores, usize::from);
    if threads > cores {
        report.note(&format!(
            "{threads} threads share {cores} cores, which is slower than {cores} threads"
        ));
    }
    check_threads(threads)?;
    Ok(threads)
}

/// The built-in scene to open when none is asked for.
fn first_scene() -> String {
    built_in()
        .first()
        .map_or(String::new(), |scene| scene.name.to_owned())
}

/// The scene called `name` with the changes asked for, and the commands to carry out while it runs.
fn changed_scene(name: &str, what: &What) -> Result<(Scene, Vec<ScriptedCommand>), RunnerError> {
    let mut scene = Scene::open(name)?;
    let options = [
        ("duration", &what.duration),
        ("output-interval", &what.output_interval),
        ("sample-interval", &what.sample_interval),
        ("time-step", &what.time_step),
        ("seed", &what.seed),
    ];
    let options = options
        .into_iter()
        .filter_map(|(key, value)| Some(format!("{key}={}", value.as_ref()?)));
    let settings: Vec<String> = options.chain(what.set.iter().cloned()).collect();
    let mut script = apply_settings(&mut scene, &settings)?;
    if let Some(path) = &what.commands {
        script.extend(read_commands(path)?);
    }
    Ok((scene, script))
}

/// The run that the window opens with where nothing is asked for but a window.
#[cfg(feature = "desktop")]
fn opening_session(what: &What, picture: &PictureArguments, no_render: bool) -> Option<Session> {
    let values = [
        &what.scene,
        &what.duration,
        &what.output_interval,
        &what.sample_interval,
        &what.time_step,
        &what.seed,
        &picture.compare,
    ];
    let asks = values.into_iter().any(Option::is_some) || !what.set.is_empty();
    let takes_files = what.commands.is_some() || picture.screenshot.is_some();
    (!asks && !takes_files && !no_render).then(opening)?
}

/// The session or the recording called `name`, which opens as it was.
#[cfg(feature = "desktop")]
fn unchanged(name: &str, what: &What) -> Result<Opened, RunnerError> {
    let refuse = |reason: String| Err(RunnerError::Input(reason));
    let given = [
        &what.duration,
        &what.output_interval,
        &what.time_step,
        &what.seed,
    ];
    if given.iter().any(|option| option.is_some())
        || !what.set.is_empty()
        || what.commands.is_some()
    {
        return refuse(format!(
            "{name} opens as it was saved: leave the options out and change it in the window, or give a scene the changes of a \
             session or a summary.json with --commands"
        ));
    }
    Kept::read(Path::new(name)).map_or_else(refuse, |kept| Ok(kept.into()))
}

/// `scenes/papers/kasper2021/dry-r3.ron` is called `dry-r3`.
fn short_name(name: &str) -> String {
    let file = name.strip_suffix(".ron").unwrap_or(name);
    Path::new(file).file_name().map_or_else(
        || "scene".into(),
        |file| file.to_string_lossy().into_owned(),
    )
}

#[cfg(feature = "desktop")]
fn window_options(what: &What, script: Vec<ScriptedCommand>) -> Options {
    let options = Options::window();
    Options {
        threads: what.threads.map_or(options.threads, usize::from),
        script,
        ..options
    }
}

/// Opens the laboratory; what went wrong is said here. Returns the exit code.
#[cfg(feature = "desktop")]
fn open_window(
    name: String,
    opened: Opened,
    options: Options,
    picture: PictureArguments,
) -> Result<u8, RunnerError> {
    use grainfall::window::{PictureJob, WindowJob, run};
    let compared = picture.compare.as_deref().map(compared_value).transpose()?;
    let picture = picture.screenshot.map(|path| PictureJob {
        path,
        at: picture.at,
        size: picture.size.into(),
        offscreen: picture.offscreen,
        plain: picture.plain,
    });
    let job = WindowJob {
        name,
        opened,
        options,
        compared,
        picture,
    };
    Ok(run(job).map_or_else(
        |error| {
            print_chain(&error);
            error.exit_code()
        },
        |()| 0,
    ))
}

#[cfg(not(feature = "desktop"))]
const NO_WINDOW: &str = "this grainfall was built without a window: add --no-render, or build it with the feature \
                         `desktop`";

/// Hands a scene to another engine. Returns the exit code.
fn export_scene(
    what: &What,
    engine: MpiEngine,
    (out, settles): (PathBuf, bool),
    (allowed, report): (&Allowed, Report),
) -> Result<u8, RunnerError> {
    let name = what.scene.clone().unwrap_or_else(first_scene);
    let (scene, script) = changed_scene(&name, what)?;
    let job = Job {
        threads: checked_threads(what.threads, report)?,
        script,
        ..Job::new(short_name(&name), scene, out)
    };
    allowed.begin(&Estimate::of_start(&job.scene), &job.out, report)?;
    let is_done = headless::hand_over(&job, engine, settles, report, &*interruption()?)?;
    Ok(if is_done {
        exit::DONE
    } else {
        exit::INTERRUPTED
    })
}

fn run_sweep(task: &SweepTask, allowed: &Allowed) -> Result<u8, RunnerError> {
    let report = task.report();
    let jobs = checked_threads(task.jobs, report)?;
    let sweep = task.sweep(&short_name(&task.scene), jobs)?;
    if let Some(at_once) = task.runs_at_once(jobs) {
        allowed.begin(&task.estimate(&sweep, at_once)?, &sweep.out, report)?;
    }
    task.carry_out(&sweep, &*interruption()?)
}

fn run_paper(task: &PaperTask, allowed: &Allowed) -> Result<u8, RunnerError> {
    let at_once = checked_threads(task.threads, task.report())?;
    let job = task.job(at_once)?;
    if task.computes() {
        let estimate = job.estimate(at_once);
        allowed.begin(&estimate, &job.sweep().out, Report::Quiet)?;
    }
    task.carry_out(&job, &*interruption()?)
}

/// Prints what can be set in the scene called `name`. Returns the exit code.
fn list_settings(name: &str, json: bool) -> Result<u8, RunnerError> {
    let settings = Settings::of(&Scene::open(name)?);
    let text = if json {
        let list = serde_json::to_string_pretty(settings.list());
        list.map_err(|error| RunnerError::Input(error.to_string()))?
    } else {
        settings.to_string()
    };
    say(text.trim_end());
    Ok(0)
}

/// Prints `error` and what led to it, once, for people.
fn print_chain(error: &dyn Error) {
    tell(&format!("error: {error}"));
    let mut cause = error.source();
    while let Some(error) = cause {
        tell(&format!("  because: {error}"));
        cause = error.source();
    }
}
