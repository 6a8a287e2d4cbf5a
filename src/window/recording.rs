//! Takes the pictures of a film: the run holds at regular simulated times until the picture there is taken, so that the
//! film runs smoothly however slow the machine is.
//!
//! In: the recorder's orders. Out: pictures of the scene, without panels, to the thread that writes the film.

use super::picture::{Canvas, screenshot};
use crate::simulation::{Provenance, Simulation};
use crate::ui::{Desk, FilmOrder, FilmState, Recorder, said};
use crate::view::{FILM_RATE, Film, FilmKind, ViewSettings};
use bevy::math::URect;
use bevy::prelude::*;
use bevy::render::view::screenshot::ScreenshotCaptured;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// Frames from a state that is reached to one that is surely drawn: panels, then the renderer a frame behind.
const FRAMES_UNTIL_DRAWN: u32 = 2;

/// Records films when the [`Recorder`] is told to.
pub struct RecordingPlugin;

impl Plugin for RecordingPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Recorder>().add_systems(Update, record);
    }
}

/// A picture that has been taken.
type Inbox = Arc<Mutex<Option<Image>>>;

/// A film on its way.
struct Running {
    film: Film,
    path: PathBuf,
    stage: Stage,
    pictures: usize,
    /// Steps from picture to picture.
    stride: u64,
    /// The step of the next one.
    next: u64,
    time_step: f64,
    inbox: Inbox,
}

#[derive(Clone, Copy, PartialEq)]
enum Stage {
    /// The run is on its way to the next picture.
    Waiting,
    /// It is there; so many frames until it is surely drawn.
    Drawing(u32),
    /// The picture is being taken.
    Taking,
    /// All are taken.
    Ending,
}

/// Brings the film one frame further.
fn record(
    mut recorder: ResMut<Recorder>,
    mut running: Local<Option<Running>>,
    simulation: Option<ResMut<Simulation>>,
    settings: Res<ViewSettings>,
    canvas: Option<Res<Canvas>>,
    mut desk: Option<ResMut<Desk>>,
    mut commands: Commands,
) {
    let Some(mut simulation) = simulation else {
        return;
    };
    let mut say = |text: String| {
        if let Some(desk) = &mut desk {
            desk.notify(text);
        }
    };
    match recorder.order.take() {
        Some(FilmOrder::Begin(path)) if running.is_none() => match begin(path, &mut simulation) {
            Ok(begun) => *running = Some(begun),
            Err(reason) => say(format!("No film is recorded: {reason}")),
        },
        Some(FilmOrder::End) => end(&mut running, &mut simulation),
        Some(FilmOrder::Cancel) => {
            if let Some(running) = &mut *running {
                running.film.cancel();
            }
            end(&mut running, &mut simulation);
        }
        Some(FilmOrder::Begin(_)) => say("A film is being recorded already".to_owned()),
        None => {}
    }
    let Some(film) = &mut *running else {
        return;
    };
    // Another scene is another film.
    if simulation.is_added() && film.pictures > 0 || film.film.has_ended() {
        end(&mut running, &mut simulation);
    }
    let Some(film) = &mut *running else {
        return;
    };
    film.go_on(&mut simulation, &settings, canvas.as_deref(), &mut commands);
    recorder.state = film.state();
    if film.stage == Stage::Ending && film.film.has_ended() {
        let outcome = film.film.outcome();
        say(said("The film", &film.path, outcome));
        *running = None;
        recorder.state = FilmState::Idle;
    }
}

/// A film from the state shown on.
fn begin(path: PathBuf, simulation: &mut Simulation) -> Result<Running, String> {
    let world = simulation.world().ok_or("there is no run yet")?;
    let kind = FilmKind::of(&path)?;
    let speed = simulation.speed();
    let speed = if speed.is_finite() { speed } else { 1.0 };
    let (step, time_step) = (world.clock.step, world.clock.time_step);
    let stride = (speed / (f64::from(FILM_RATE) * time_step))
        .round()
        .max(1.0) as u64;
    let from = Provenance::of_scene(simulation.scene());
    let film = Film::begin(path.clone(), kind, from)
        .map_err(|reason| format!("{}: {reason}", path.display()))?;
    simulation.hold_at(Some(step));
    Ok(Running {
        film,
        path,
        stage: Stage::Waiting,
        pictures: 0,
        stride,
        next: step,
        time_step,
        inbox: Inbox::default(),
    })
}

/// Takes no further picture and lets the run go.
fn end(running: &mut Option<Running>, simulation: &mut Simulation) {
    if let Some(running) = running {
        running.film.finish();
        running.stage = Stage::Ending;
        simulation.hold_at(None);
    }
}

impl Running {
    fn state(&self) -> FilmState {
        if self.stage == Stage::Ending {
            return FilmState::Writing(self.film.waiting());
        }
        let steps = self.stride * self.pictures.saturating_sub(1) as u64;
        FilmState::Recording {
            pictures: self.pictures,
            time: steps as f64 * self.time_step,
        }
    }

    fn go_on(
        &mut self,
        simulation: &mut Simulation,
        settings: &ViewSettings,
        canvas: Option<&Canvas>,
        commands: &mut Commands,
    ) {
        let Some(step) = simulation.world().map(|world| world.clock.step) else {
            return;
        };
        self.stage = match self.stage {
            Stage::Waiting => {
                let sought = simulation.step();
                if sought + self.stride < self.next || sought > self.next + self.stride {
                    // Somebody went to another moment: the film goes on from there.
                    self.aim_at(sought, simulation);
                }
                if step >= self.next && self.film.has_room() {
                    Stage::Drawing(FRAMES_UNTIL_DRAWN)
                } else {
                    Stage::Waiting
                }
            }
            Stage::Drawing(0) => {
                self.take_picture(canvas, commands);
                Stage::Taking
            }
            Stage::Drawing(frames) => Stage::Drawing(frames - 1),
            Stage::Taking => {
                let taken = self
                    .inbox
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .take();
                if let Some(image) = taken {
                    let area = area(&image, settings);
                    self.film.add(image, area);
                    self.pictures += 1;
                    self.aim_at(step + self.stride, simulation);
                    Stage::Waiting
                } else {
                    Stage::Taking
                }
            }
            Stage::Ending => Stage::Ending,
        };
    }

    /// The next picture is that of `step`; the run goes no further until it is taken.
    fn aim_at(&mut self, step: u64, simulation: &mut Simulation) {
        self.next = step;
        simulation.hold_at(Some(step));
    }

    fn take_picture(&self, canvas: Option<&Canvas>, commands: &mut Commands) {
        let inbox = self.inbox.clone();
        commands
            .spawn(screenshot(canvas))
            .observe(move |captured: On<ScreenshotCaptured>| {
                let mut inbox = inbox.lock().unwrap_or_else(PoisonError::into_inner);
                *inbox = Some(captured.image.clone());
            });
    }
}

/// The part of a picture of the window that the panels leave free.
fn area(image: &Image, settings: &ViewSettings) -> URect {
    let size = image.size();
    let whole = URect::from_corners(UVec2::ZERO, size);
    let Some(free) = settings.free_rect else {
        return whole;
    };
    let pixel = |at: bevy_egui::egui::Pos2| {
        (Vec2::new(at.x, at.y) * settings.pixels_per_point)
            .round()
            .max(Vec2::ZERO)
            .as_uvec2()
            .min(size)
    };
    URect::from_corners(pixel(free.min), pixel(free.max))
}
