//! Takes the pictures of a film without a window.
//!
//! In: an app that draws on a canvas and holds a simulation, which the caller moves from picture to
//! picture. Out: the film, whole or not at all. Between two pictures the cameras rest.

use crate::simulation::Simulation;
use crate::ui::{Dock, FilmState, ScreenshotOrders, first_speed};
use crate::view::{Drawn, FilmKind, FilmWriter, GrainBuffer, Meshing, Pace};
use crate::window::app::{add_laboratory, log, quietly};
use crate::window::canvas::{
    Canvas, CanvasPlugin, WARM_UP, make_ready, offscreen_plugins, screenshot,
};
use crate::window::environment::{Missing, adapters};
use crate::window::pipelines::Pipelines;
use crate::window::screenshot_subject::UNTIL_DRAWN;
use crate::window::window_job::FilmJob;
use bevy::prelude::*;
use bevy::render::view::screenshot::ScreenshotCaptured;
use bevy::time::TimeUpdateStrategy;
use grainfall::lab::Options;
use grainfall::run::Provenance;
use grainfall::runner::RunnerError;
use grainfall::scene::Scene as GranularScene;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How long the thread that writes is waited for at a time.
const WAIT: Duration = Duration::from_millis(2);
/// Frames after which a picture that has not come will not come.
const MOST_FRAMES: u32 = 2000;

/// Refuses a film that cannot be, before anything is computed: of another kind, in the place of a
/// file, or where nothing can be drawn. Returns what it is written as.
///
/// # Errors
/// Which of them it is, and what to do.
pub(super) fn check(job: &FilmJob) -> Result<FilmKind, RunnerError> {
    let path = job.path.display();
    let input = |reason: String| RunnerError::Input(format!("no film is recorded: {reason}"));
    let kind = FilmKind::of(&job.path).map_err(|reason| input(format!("{path}: {reason}")))?;
    if job.path.symlink_metadata().is_ok() {
        return Err(input(format!(
            "{path} exists already: name another file, or take it away first"
        )));
    }
    if adapters().is_empty() {
        return Err(RunnerError::System(Missing::Driver.to_string()));
    }
    Ok(kind)
}

/// The app that a film is drawn in, without a simulation.
///
/// # Errors
/// When the graphics libraries do not do their work.
pub(super) fn studio(job: &FilmJob, options: &Options) -> Result<App, RunnerError> {
    let build = || {
        let mut app = App::new();
        app.add_plugins((offscreen_plugins().set(log()), CanvasPlugin(job.size)));
        add_laboratory(&mut app, job.plain, true, options.clone());
        app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
        app.world_mut().resource_mut::<Dock>().is_hidden = true;
        app.add_systems(Startup, rest_cameras);
        make_ready(&mut app);
        app
    };
    quietly(build).map_err(|reason| RunnerError::System(Missing::Libraries(reason).to_string()))
}

fn rest_cameras(mut cameras: Query<&mut Camera>) {
    for mut camera in &mut cameras {
        camera.is_active = false;
    }
}

/// A film on its way.
pub(super) struct Film {
    writer: FilmWriter,
    path: PathBuf,
    pictures: usize,
    pace: Pace,
    /// Time of the first picture [s].
    from: f64,
    /// Why there is none.
    failure: Option<io::Error>,
}

impl Film {
    /// The film that `job` asks for of a run of `scene`, written as `kind`; its first picture is at
    /// the time `from` [s], where the job asks for none later.
    ///
    /// # Errors
    /// When it cannot be written there.
    pub(super) fn begin(
        job: &FilmJob,
        kind: FilmKind,
        scene: &GranularScene,
        from: f64,
    ) -> Result<Self, RunnerError> {
        let speed = job.speed.unwrap_or_else(|| first_speed(scene.duration));
        let (path, rate) = (job.path.clone(), kind.rate(job.rate));
        let writer = FilmWriter::begin(path.clone(), kind, rate, Provenance::of_scene(scene));
        Ok(Self {
            writer: writer.map_err(|error| unwritten(&path, &error))?,
            path,
            pictures: 0,
            pace: Pace { rate, speed },
            from: from.max(job.at),
            failure: None,
        })
    }

    /// Simulated time of its next picture [s].
    pub(super) fn due(&self) -> f64 {
        self.from + self.pictures as f64 * self.pace.interval()
    }

    /// Takes its next picture: that of the state which the simulation of `app` holds. Where that
    /// cannot be, the run goes on without a film, and why is told at the end.
    pub(super) fn shoot(&mut self, app: &mut App) {
        if self.failure.is_none() {
            self.failure = self.take(app).err();
        }
        self.pictures += 1;
    }

    fn take(&mut self, app: &mut App) -> io::Result<()> {
        while !self.writer.has_room() && !self.writer.has_ended() {
            std::thread::sleep(WAIT);
        }
        if self.writer.has_ended() {
            return Ok(());
        }
        let (pictures, time) = (self.pictures, self.due() - self.from);
        if let Some(mut orders) = app.world_mut().get_resource_mut::<ScreenshotOrders>() {
            orders.film = FilmState::Recording { pictures, time };
        }
        use_cameras(app, true);
        let image = photographed(app, if pictures == 0 { WARM_UP } else { UNTIL_DRAWN });
        use_cameras(app, false);
        let image = image.ok_or_else(|| io::Error::other("the renderer gives no picture"))?;
        let shown = simulation(app).and_then(|simulation| simulation.provenance());
        self.writer.add(Drawn::Whole(image), shown);
        Ok(())
    }

    /// Leaves nothing behind.
    pub(super) fn cancel(mut self) {
        self.writer.cancel();
    }

    /// There is no further picture: waits until all are written; `watch` hears how many are left.
    /// Returns what there is, in words.
    ///
    /// # Errors
    /// Why there is no film.
    pub(super) fn finish(mut self, watch: &mut dyn FnMut(usize)) -> Result<String, RunnerError> {
        let outcome = if let Some(failure) = self.failure.take() {
            Err(failure)
        } else {
            self.writer.finish();
            while !self.writer.has_ended() {
                watch(self.writer.waiting());
                std::thread::sleep(WAIT);
            }
            self.writer.outcome()
        };
        outcome.map_err(|error| unwritten(&self.path, &error))?;
        let time = self.pictures.saturating_sub(1) as f64 * self.pace.interval();
        Ok(format!(
            "film in {}: {} pictures, {time:.3} s of simulated time; {}",
            self.path.display(),
            self.pictures,
            self.pace.in_words()
        ))
    }
}

fn unwritten(path: &Path, error: &io::Error) -> RunnerError {
    RunnerError::System(format!("{} cannot be written: {error}", path.display()))
}

/// Lets the cameras of `app` draw, or rest.
fn use_cameras(app: &mut App, is_active: bool) {
    let world = app.world_mut();
    let mut cameras = world.query::<&mut Camera>();
    for mut camera in cameras.iter_mut(world) {
        camera.is_active = is_active;
    }
}

/// The picture of the state shown, after so many `frames` and when nothing of it is on its way any
/// more; none where it does not come.
fn photographed(app: &mut App, frames: u32) -> Option<Image> {
    let mut left = MOST_FRAMES;
    for _ in 0..frames {
        app.update();
    }
    while !is_whole(app) && left > 0 {
        app.update();
        left -= 1;
    }
    let taken: Arc<Mutex<Option<Image>>> = Arc::default();
    let slot = taken.clone();
    let picture = screenshot(app.world().get_resource::<Canvas>());
    app.world_mut()
        .spawn(picture)
        .observe(move |captured: On<ScreenshotCaptured>| {
            let mut slot = slot.lock().unwrap_or_else(PoisonError::into_inner);
            *slot = Some(captured.image.clone());
        });
    while left > 0 {
        app.update();
        left -= 1;
        let image = taken.lock().unwrap_or_else(PoisonError::into_inner).take();
        if image.is_some() {
            return image;
        }
    }
    None
}

/// Whether all meshes and shadows fit the state shown, and the renderer has all that it draws with.
fn is_whole(app: &App) -> bool {
    let world = app.world();
    let pipelines = world.get_resource::<Pipelines>();
    let meshes = world.get_resource::<Meshing>();
    let grains = world.get_resource::<GrainBuffer>();
    meshes.is_none_or(Meshing::is_whole)
        && grains.is_none_or(GrainBuffer::is_whole)
        && pipelines.is_none_or(Pipelines::are_made)
}

/// The simulation of `app`.
pub(super) fn simulation(app: &mut App) -> Option<Mut<'_, Simulation>> {
    app.world_mut().get_resource_mut()
}
