//! The command line: what to open, what to change, and whether a window is wanted.
//!
//! Exit codes: 0 done, 1 files could not be written, 2 bad input, 3 physical fault, 4 another state
//! than a file states, 5 another program writes to the output folder, 130 interrupted.

use grainfall::engines::MpiEngine;
use grainfall::lab::Kept;
use grainfall::lesson::Lesson;
use grainfall::parameters::Settings;
#[cfg(feature = "desktop")]
use grainfall::recording::Recording;
#[cfg(feature = "desktop")]
use grainfall::run::opening;
use grainfall::run::{Estimate, ScriptedCommand, available_threads};
#[cfg(feature = "desktop")]
use grainfall::runner::compared_value;
use grainfall::runner::{Job, RunnerError, apply_settings, exit, read_commands};
use grainfall::scene::{Scene, built_in};
#[cfg(feature = "desktop")]
use grainfall_app::headless::command_line::PictureArguments;
use grainfall_app::headless::command_line::{Arguments, Task, What};
use grainfall_app::headless::terminal::{say, tell};
use grainfall_app::headless::{
    self, Allowed, PaperTask, Report, SweepTask, check_threads, interruption, misspelt_command,
    named_scene, short_name,
};
#[cfg(feature = "desktop")]
use grainfall_app::window::{FilmJob, Opened, film_recording, film_run};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// That of the GNU C library keeps what a thread left in pieces when the thread is gone; every run has
/// threads of its own, so that a window that opens run after run would grow. Other systems' give back.
#[cfg(all(feature = "desktop", target_os = "linux", target_env = "gnu"))]
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

fn main() -> ExitCode {
    let arguments = Arguments::of_the_process();
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
    if let Some(task) = arguments.task {
        return carry_out_task(task, &allowed);
    }
    let what = arguments.what;
    let name = what.scene.clone().unwrap_or_else(first_scene);
    #[cfg(feature = "desktop")]
    if opens_on_its_way(&what, &arguments.picture, arguments.no_render)
        && !Kept::is_at(&name)
        && let Some(session) = opening(&name)
    {
        let shipped = Opened::Shipped(session.into());
        return open_window(name, shipped, what.threads, Vec::new(), arguments.picture);
    }
    #[cfg(feature = "desktop")]
    if Kept::is_at(&name) && !arguments.no_render {
        let opened = unchanged(&name, &what)?;
        return open_window(name, opened, what.threads, Vec::new(), arguments.picture);
    }
    let report = arguments.said.report();
    #[cfg(feature = "desktop")]
    let film = film_job(arguments.record, &arguments.picture);
    #[cfg(not(feature = "desktop"))]
    if arguments.record.is_some() {
        return Err(RunnerError::Input(NO_FILM.into()));
    }
    if Kept::is_at(&name) {
        #[cfg(feature = "desktop")]
        if let Some(film) = film.as_ref().filter(|_| Recording::is_at(&name)) {
            return film_folder(&name, &what, film, report);
        }
        return Err(RunnerError::Input(kept_says(&name)));
    }
    if Lesson::is_at(&name) {
        #[cfg(feature = "desktop")]
        if !arguments.no_render {
            return open_lesson(name, &what, &allowed, arguments.picture);
        }
        return Err(RunnerError::Input(format!(
            "{name} is a lesson: it opens in a window"
        )));
    }
    let (scene, script) = changed_scene(&name, &what)?;
    if !arguments.no_render {
        #[cfg(feature = "desktop")]
        allowed.memory(&Estimate::of_start(&scene))?;
        #[cfg(feature = "desktop")]
        return open_window(name, scene.into(), what.threads, script, arguments.picture);
        #[cfg(not(feature = "desktop"))]
        return Err(RunnerError::Input(NO_WINDOW.into()));
    }
    let name = short_name(&name);
    let out = arguments.out.unwrap_or(Path::new("out").join(&name));
    let job = Job {
        threads: checked_threads(what.threads, report)?,
        script,
        checkpoints: true,
        restart: arguments.restart,
        ..Job::new(name, scene, out)
    };
    allowed.begin(&Estimate::of(&job.scene), &job.out, report)?;
    #[cfg(feature = "desktop")]
    if let Some(film) = film {
        let ending = film_run(&job, &film, report, &*interruption()?)?;
        return Ok(ending.exit_code());
    }
    Ok(headless::run(&job, report, &*interruption()?)?.exit_code())
}

/// That what is called `name` takes a window.
fn kept_says(name: &str) -> String {
    format!(
        "{name} holds what was computed: it opens in a window, and `grainfall verify` computes it again without one"
    )
}

/// The film that is asked for.
#[cfg(feature = "desktop")]
fn film_job(path: Option<PathBuf>, picture: &PictureArguments) -> Option<FilmJob> {
    Some(FilmJob {
        path: path?,
        at: picture.at,
        speed: picture.speed,
        rate: picture.frame_rate,
        size: picture.size,
        plain: picture.plain,
    })
}

/// Makes a film of the recording called `name`. Returns the exit code.
#[cfg(feature = "desktop")]
fn film_folder(name: &str, what: &What, film: &FilmJob, report: Report) -> Result<u8, RunnerError> {
    match unchanged(name, what)? {
        Opened::Recording(recording) => film_recording(*recording, film, report, &*interruption()?),
        _ => Err(RunnerError::Input(format!("{name} is no folder of a run"))),
    }
}

/// Does what is to be done instead of opening a scene. Returns the exit code.
fn carry_out_task(task: Task, allowed: &Allowed) -> Result<u8, RunnerError> {
    match task {
        Task::Bed { scene, out } => headless::write_bed(&scene, allowed, &out),
        Task::Opening { out } => headless::write_openings(&out),
        Task::Verify { file, threads } => {
            let threads = checked_threads(threads, Report::Text)?;
            headless::confirm(&file, threads, allowed, &*interruption()?)
        }
        Task::Scenes { json } => list_scenes(json),
        Task::Completions { shell } => {
            headless::print_completions(shell);
            Ok(exit::DONE)
        }
        Task::Man { folder } => {
            headless::write_manual(&folder)?;
            Ok(exit::DONE)
        }
        Task::Settings { scene, json } => list_settings(&scene, json),
        Task::TimeSteps { scene, set, json } => headless::list_time_steps(&scene, &set, json),
        Task::Pack { scene, set, out } => headless::write_packing(&scene, &set, allowed, &out),
        Task::Sweep(task) => run_sweep(&task, allowed),
        Task::Import(task) => task.carry_out(),
        Task::Export {
            what,
            to,
            out,
            unsettled,
            said,
        } => export_scene(&what, to, (out, !unsettled), (allowed, said.report())),
        Task::Paper(task) => run_paper(&task, allowed),
    }
}

/// Opens the lesson called `name`, as it is, in a window. Returns the exit code.
#[cfg(feature = "desktop")]
fn open_lesson(
    name: String,
    what: &What,
    allowed: &Allowed,
    picture: PictureArguments,
) -> Result<u8, RunnerError> {
    if is_changed(what) {
        return Err(RunnerError::Input(format!(
            "{name} is a lesson, which sets its values itself: leave the options out, or write them into its `settings`"
        )));
    }
    let lesson = Lesson::open(&name);
    let (lesson, scene) = lesson.map_err(|error| RunnerError::Input(error.to_string()))?;
    allowed.memory(&Estimate::of_start(&scene))?;
    let opened = Opened::Lesson(Box::new(lesson), Box::new(scene));
    open_window(name, opened, what.threads, Vec::new(), picture)
}

/// Whether options ask for other values than what is opened has.
#[cfg(feature = "desktop")]
fn is_changed(what: &What) -> bool {
    let given = [
        &what.duration,
        &what.output_interval,
        &what.time_step,
        &what.seed,
    ];
    given.iter().any(|option| option.is_some()) || !what.set.is_empty() || what.commands.is_some()
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
    let mut scene = named_scene(name).map_err(|error| match misspelt_command(name) {
        Some(problem) => RunnerError::Input(problem),
        None => error.into(),
    })?;
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

/// Whether a scene opens at the moment that is shipped, if one is: in a window, and where nothing is
/// asked of its run.
#[cfg(feature = "desktop")]
fn opens_on_its_way(what: &What, picture: &PictureArguments, no_render: bool) -> bool {
    let is_asked = is_changed(what) || what.sample_interval.is_some();
    let takes_pictures = picture.compare.is_some() || picture.screenshot.is_some();
    !is_asked && !takes_pictures && !no_render
}

/// The session or the recording called `name`, which opens as it was.
#[cfg(feature = "desktop")]
fn unchanged(name: &str, what: &What) -> Result<Opened, RunnerError> {
    let refuse = |reason: String| Err(RunnerError::Input(reason));
    if is_changed(what) {
        return refuse(format!(
            "{name} opens as it was saved: leave the options out and change it in the window, or give a scene the changes of a \
             session or a summary.json with --commands"
        ));
    }
    Kept::read(Path::new(name)).map_or_else(refuse, |kept| Ok(kept.into()))
}

/// Opens the laboratory; what went wrong is said here. Returns the exit code.
#[cfg(feature = "desktop")]
fn open_window(
    name: String,
    opened: Opened,
    threads: Option<u16>,
    script: Vec<ScriptedCommand>,
    picture: PictureArguments,
) -> Result<u8, RunnerError> {
    use grainfall_app::ui::PictureOf;
    use grainfall_app::window::{PictureJob, WindowJob, run};
    let compared = picture.compare.as_deref().map(compared_value).transpose()?;
    let picture = picture.screenshot.map(|path| PictureJob {
        path,
        at: picture.at,
        size: picture.size,
        offscreen: picture.offscreen,
        of: match (picture.transparent, picture.plain) {
            (true, _) => PictureOf::CutOut,
            (false, true) => PictureOf::Grains,
            (false, false) => PictureOf::Window,
        },
    });
    let job = WindowJob {
        name,
        opened,
        threads: threads.map(usize::from),
        script,
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
const NO_FILM: &str = "this grainfall was built without pictures: leave --record out, or build it with the feature \
                       `desktop`";

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
    let estimate = Estimate::of_start(&job.scene);
    let estimate = if settles {
        estimate
    } else {
        estimate.unsettled()
    };
    allowed.begin(&estimate, &job.out, report)?;
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
        let estimate = job.estimate(at_once)?;
        allowed.begin(&estimate, &job.sweep().out, Report::Quiet)?;
    }
    task.carry_out(&job, &*interruption()?)
}

/// Prints the scenes that come with the program. Returns the exit code.
fn list_scenes(json: bool) -> Result<u8, RunnerError> {
    let mut list = Vec::new();
    for scene in built_in() {
        list.push((scene, Scene::parse(scene.path, scene.text)?.title));
    }
    if json {
        let list: Vec<_> = (list.iter())
            .map(|(scene, title)| serde_json::json!({"name": scene.name, "title": title, "path": scene.path}))
            .collect();
        say(&format!("{:#}", serde_json::Value::from(list)));
    } else {
        for (scene, title) in list {
            say(&format!("{:<20} {title}", scene.name));
        }
    }
    Ok(exit::DONE)
}

/// Prints what can be set in the scene called `name`. Returns the exit code.
fn list_settings(name: &str, json: bool) -> Result<u8, RunnerError> {
    let settings = Settings::of(&named_scene(name)?);
    let text = if json {
        let list = serde_json::to_string_pretty(settings.list());
        list.map_err(|error| RunnerError::Input(error.to_string()))?
    } else {
        settings.to_string()
    };
    say(text.trim_end());
    Ok(exit::DONE)
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
