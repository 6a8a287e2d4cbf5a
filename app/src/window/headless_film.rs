//! `--no-render --record FILE`: a film of a run that is computed, or of a recording, without a
//! window and without a display.
//!
//! In: a run's job, or a recording, and what the film is to be like. Out: the film, whole or not at
//! all, and of a run its files, as without a film. The run holds at each picture until that is
//! taken, which shows in none of its bits.

use crate::headless::terminal::say;
use crate::headless::{Progress, Report, RunInApp, finish};
use crate::simulation::Simulation;
use crate::window::film_studio::{Film, check, simulation, studio};
use crate::window::window_job::FilmJob;
use bevy::app::App;
use grainfall::lab::{DriverKind, LabCommand, Options, Status};
use grainfall::output::Ending;
use grainfall::recording::Recording;
use grainfall::run::{Command, Measured, Stored};
use grainfall::runner::{
    Advance, At, Halt, Job, Runner, RunnerError, Standing, Watch, exit, standing,
};
use std::sync::atomic::{AtomicBool, Ordering};

/// Runs `job` as [`crate::headless::run`] does and makes the `film` of it, from time zero to its end.
/// A run that is interrupted leaves none.
///
/// # Errors
/// When either cannot be; where the folder of the run holds a part of it, which has no film.
pub fn film_run(
    job: &Job,
    film: &FilmJob,
    report: Report,
    interrupted: &AtomicBool,
) -> Result<Ending, RunnerError> {
    job.check()?;
    let kind = check(film)?;
    if !job.restart {
        refuse_part(job)?;
    }
    let app = studio(film, &options())?;
    let runner = Runner::open(job)?;
    let mut filmed = FilmedRun {
        run: RunInApp::of(app, job, None),
        film: Film::begin(film, kind, &job.scene, 0.0)?,
    };
    let ending = finish(runner, &mut filmed, job, report, interrupted)?;
    if ending == Ending::Interrupted {
        filmed.film.cancel();
        report.note("there is no film of a run that was interrupted");
        return Ok(ending);
    }
    filmed.take_due();
    end(filmed.film, report)?;
    Ok(ending)
}

/// Refuses a run that its folder holds in part or whole: what was computed before is not filmed.
fn refuse_part(job: &Job) -> Result<(), RunnerError> {
    let found = standing(job)?;
    if found == Standing::Nothing {
        return Ok(());
    }
    let folder = job.out.display();
    Err(RunnerError::Input(format!(
        "no film is recorded: the run in {folder} is {found}, and a film begins at its start. Add --restart to compute it anew, or \
         name another folder with --out; `grainfall {folder} --no-render --record FILE` makes a film of the states that are there"
    )))
}

/// Makes the `film` of the states of `recording`; nothing is computed. Returns the exit code.
///
/// # Errors
/// When it cannot be made.
pub fn film_recording(
    recording: Recording,
    film: &FilmJob,
    report: Report,
    interrupted: &AtomicBool,
) -> Result<u8, RunnerError> {
    let kind = check(film)?;
    let mut app = studio(film, &options())?;
    let [first, last] = [recording.moments().first(), recording.moments().last()]
        .map(|moment| moment.map_or(0.0, |moment| moment.time));
    let scene = recording.scene().clone();
    app.insert_resource(Simulation::play_back(recording, options()));
    let mut reel = Film::begin(film, kind, &scene, first)?;
    let mut progress = Progress::of(report);
    loop {
        let time = reel.due();
        if interrupted.load(Ordering::Relaxed) {
            progress.finish();
            reel.cancel();
            return Ok(exit::INTERRUPTED);
        }
        go_to(&mut app, time)?;
        reel.shoot(&mut app);
        progress.running(time / last, &|| format!("t = {time:.3} s of {last:.3} s"));
        if reel.due() > last * (1.0 + f64::EPSILON) {
            break;
        }
    }
    progress.finish();
    end(reel, report)?;
    Ok(exit::DONE)
}

/// Lets the recording that `app` plays come to `time` [s].
fn go_to(app: &mut App, time: f64) -> Result<(), RunnerError> {
    let mut is_sent = false;
    loop {
        app.update();
        let Some(mut simulation) = simulation(app) else {
            continue;
        };
        if let Status::Failed(reason) = simulation.status() {
            return Err(RunnerError::Input(reason.clone()));
        }
        let Some(times) = simulation.step_times() else {
            continue;
        };
        // A state is written at the first step at or after its time.
        let half_step = simulation.world().map_or(0.0, |w| 0.5 * w.clock.time_step);
        let step = times.step_at(time + half_step);
        let step = step.min(simulation.past().end.step);
        if simulation.reached() >= step {
            return Ok(());
        }
        if !is_sent {
            is_sent = true;
            simulation.send(LabCommand::Hold(Some(step)));
            simulation.send(Command::Play);
        }
    }
}

/// How scenes are opened where nobody opens any.
fn options() -> Options {
    Options {
        driver: DriverKind::Inline,
        autoplay: false,
        ..Options::headless()
    }
}

/// Waits for `film` to be written and says what there is.
fn end(film: Film, report: Report) -> Result<(), RunnerError> {
    let mut progress = Progress::of(report);
    let mut watch = |left: usize| {
        progress.tell(1.0, || format!("writing the film: {left} pictures left"));
    };
    let said = film.finish(&mut watch);
    progress.finish();
    let said = said?;
    if report == Report::Text {
        say(&said);
    }
    Ok(())
}

/// A run that holds at each picture of a film until that is taken.
struct FilmedRun {
    run: RunInApp,
    film: Film,
}

impl FilmedRun {
    /// Takes the pictures that are due at the present state. Returns the step of the next one; none
    /// before there is a state.
    fn take_due(&mut self) -> Option<u64> {
        loop {
            let clock = self.run.at().state()?.world.clock;
            let next = clock.step_at(self.film.due());
            if next > clock.step {
                return Some(next);
            }
            let app = self.run.app();
            if let Some(mut simulation) = simulation(app) {
                simulation.send(LabCommand::Hold(Some(clock.step)));
            }
            self.film.shoot(app);
        }
    }
}

impl Advance for FilmedRun {
    fn at(&self) -> At<'_> {
        self.run.at()
    }

    fn advance(&mut self, goal: u64) -> Result<(), Halt> {
        let goal = self.take_due().map_or(goal, |next| next.min(goal));
        self.run.advance(goal)
    }

    fn warnings(&self) -> Vec<String> {
        self.run.warnings()
    }

    fn forget(&mut self, stored: Stored) {
        self.run.forget(stored);
    }

    fn remember(&mut self, measured: Measured) {
        self.run.remember(measured);
    }
}
