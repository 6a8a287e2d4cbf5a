//! Takes pictures: one for the command line, one that a person asks for, the many of a film. All of
//! them go the same way.
//!
//! ```text
//! Waiting ──▶ Drawing ──▶ Taking ──▶ Ending
//!    ▲                      │
//!    └──── another one ◀────┘
//! ```
//! The run is on its way to the state; the state is drawn; the picture comes from the renderer; the
//! file is written.
//!
//! In: orders of a person, or a [`PictureJob`] of the command line. Out: files; a notice for the
//! person, the end of the app for the command line. Which states are due and what becomes of a
//! picture is the [`ScreenshotSubject`]'s business.

use crate::simulation::Simulation;
use crate::ui::{
    Dock, FilmState, PictureOf, PictureOrder, ScreenshotOrder, ScreenshotOrders, said,
};
use crate::view::{GrainBuffer, Meshing, SecondCamera, SecondOverlay, ViewSettings};
use crate::window::canvas::{Canvas, screenshot};
use crate::window::film_reel::FilmReel;
use crate::window::opening_comparison::{OpeningComparison, begin_comparison};
use crate::window::screenshot_subject::{Following, ScreenshotSubject, SinglePicture};
use crate::window::second_set::{self, SecondSet};
use crate::window::seen::Seen;
use crate::window::window_job::{PictureJob, WindowError};
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::render::view::screenshot::ScreenshotCaptured;
use bevy::window::PrimaryWindow;
use grainfall::lab::Status;
use std::num::NonZero;
use std::sync::{Arc, Mutex, PoisonError};

/// Frames for which the renderer is waited for at most: what it lacks then it will not have.
const MOST_FRAMES_WAITED: u32 = 600;

/// Takes the pictures that [`ScreenshotOrders`] ask for.
pub struct ScreenshotPlugin;

impl Plugin for ScreenshotPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(second_set::plugin)
            .init_resource::<ScreenshotOrders>()
            .init_resource::<ScreenshotJobs>()
            .add_systems(Update, take_screenshots.after(begin_comparison));
    }
}

/// The jobs that are not done yet.
#[derive(Resource, Default)]
pub(super) struct ScreenshotJobs(Vec<ScreenshotJob>);

impl ScreenshotJobs {
    /// One picture for the command line, after which the app ends; why there is none is told to
    /// `failure`.
    pub(super) fn add_for_command_line(&mut self, picture: &PictureJob, failure: Failure) {
        let order = PictureOrder {
            path: picture.path.clone(),
            of: picture.of,
            size: (picture.of != PictureOf::Window).then_some(picture.size),
        };
        let subject = SinglePicture::at(order, picture.at);
        let mut job = ScreenshotJob::of(ScreenshotSubject::Picture(subject));
        job.ends_app = Some(failure);
        self.0.push(job);
    }

    /// The film that is being recorded or written.
    fn film(&mut self) -> Option<(&mut FilmReel, &mut JobStage)> {
        self.0.iter_mut().find_map(|job| match &mut job.subject {
            ScreenshotSubject::Film(reel) => Some((reel, &mut job.stage)),
            ScreenshotSubject::Picture(_) => None,
        })
    }
}

/// Why there is no picture, for whom started the app.
#[derive(Clone, Default)]
pub(super) struct Failure(Arc<Mutex<Option<WindowError>>>);

impl Failure {
    /// The error, if there should be a picture and is none.
    pub(super) fn result(&self) -> Result<(), WindowError> {
        let failure = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        failure.map_or(Ok(()), Err)
    }

    fn tell(&self, error: WindowError) -> AppExit {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
        AppExit::Error(NonZero::<u8>::MIN)
    }
}

/// A picture that has been taken and is not put away yet.
type Inbox = Arc<Mutex<Option<Image>>>;

/// What is to be taken, and how far it has come.
struct ScreenshotJob {
    subject: ScreenshotSubject,
    stage: JobStage,
    inbox: Inbox,
    /// Frames for which the renderer was waited for.
    frames_waited: u32,
    /// The app ends with it, for the command line.
    ends_app: Option<Failure>,
}

/// How far a job has come.
#[derive(Clone, Copy, Debug, PartialEq)]
enum JobStage {
    /// The run is on its way to the next picture.
    Waiting,
    /// It is there; so many frames until it is surely drawn.
    Drawing(u32),
    /// The picture is being taken.
    Taking,
    /// All are taken; the file is written.
    Ending,
}

/// What it takes to take a picture.
#[derive(SystemParam)]
struct Studio<'w, 's> {
    settings: Res<'w, ViewSettings>,
    second: SecondSet<'w, 's>,
    window: Query<'w, 's, &'static Window, With<PrimaryWindow>>,
    canvas: Option<Res<'w, Canvas>>,
    comparison: Option<Res<'w, OpeningComparison>>,
    meshing: Option<Res<'w, Meshing>>,
    grains: Option<Res<'w, GrainBuffer>>,
    dock: Option<ResMut<'w, Dock>>,
    cameras: Query<'w, 's, &'static mut Camera, (Without<SecondCamera>, Without<SecondOverlay>)>,
    exit: MessageWriter<'w, AppExit>,
    commands: Commands<'w, 's>,
}

impl Studio<'_, '_> {
    fn say(&mut self, text: String) {
        if let Some(dock) = &mut self.dock {
            dock.notify(text);
        }
    }

    /// Whether a second run beside the first is still to begin.
    fn awaits_pair(&self) -> bool {
        (self.comparison.as_ref()).is_some_and(|comparison| comparison.wanted.is_some())
    }

    /// Whether all meshes and shadows fit the state shown.
    fn is_whole(&self) -> bool {
        self.meshing
            .as_ref()
            .is_none_or(|meshing| meshing.is_whole())
            && self.grains.as_ref().is_none_or(|grains| grains.is_whole())
    }

    /// How pictures are seen in the window.
    fn seen(&self) -> Seen {
        let canvas = self.canvas.as_ref();
        let canvas = canvas.and_then(|canvas| self.second.size_of(canvas.image()));
        let window = self.window.iter().next().map(Window::physical_size);
        let window = canvas.or(window).unwrap_or(UVec2::ONE);
        let settings = &self.settings;
        let free = settings.free_rect.map_or(window, |free| {
            let size = Vec2::new(free.width(), free.height()) * settings.pixels_per_point;
            size.round().max(Vec2::ONE).as_uvec2().min(window)
        });
        Seen {
            window,
            free,
            pixels_per_point: settings.pixels_per_point,
        }
    }

    /// Draws what the picture of `subject` is taken of, where that is not the window.
    fn arrange(&mut self, subject: &mut ScreenshotSubject) {
        if let Some(look) = subject.look(&self.seen()) {
            self.second.show(look);
        }
    }

    /// Why the state of a picture will never come, where that is so.
    fn obstacle(&self, simulation: &Simulation) -> Option<WindowError> {
        let refused = self
            .comparison
            .as_ref()
            .and_then(|comparison| comparison.refused.clone());
        match simulation.status() {
            Status::Failed(reason) => Some(WindowError::Picture(reason.clone())),
            Status::Faulted(fault) => Some(WindowError::Fault(fault.to_string())),
            _ => refused.map(WindowError::Picture),
        }
    }
}

/// Begins what was asked for and brings every job one frame further.
fn take_screenshots(
    mut orders: ResMut<ScreenshotOrders>,
    mut jobs: ResMut<ScreenshotJobs>,
    simulation: Option<ResMut<Simulation>>,
    mut studio: Studio,
) {
    let Some(mut simulation) = simulation else {
        return;
    };
    for order in std::mem::take(&mut orders.asked) {
        jobs.obey(order, &mut simulation, &mut studio);
    }
    // Another scene is another film.
    let is_another_run = simulation.is_added();
    if let Some((reel, stage)) = jobs.film()
        && *stage != JobStage::Ending
        && (reel.is_cut_off(is_another_run) || reel.is_over(&simulation))
    {
        reel.finish(&mut simulation, is_another_run);
        *stage = JobStage::Ending;
    }
    let mut is_free = jobs.0.iter().all(|job| job.stage != JobStage::Taking);
    jobs.0.retain_mut(|job| {
        if let (Some(failure), Some(error)) = (&job.ends_app, studio.obstacle(&simulation)) {
            studio.exit.write(failure.tell(error));
            return false;
        }
        job.go_on(&mut simulation, &mut studio, &mut is_free);
        !job.is_done(&mut studio)
    });
    let is_picture = |job: &ScreenshotJob| matches!(job.subject, ScreenshotSubject::Picture(_));
    orders.is_taking = jobs.0.iter().any(is_picture);
    orders.film = match jobs.film() {
        None => FilmState::Idle,
        Some((reel, JobStage::Ending)) => FilmState::Writing(reel.unwritten()),
        Some((reel, _)) => reel.state(),
    };
    if jobs.0.iter().all(|job| job.stage == JobStage::Ending) {
        studio.second.put_away();
    }
    jobs.rest_cameras(&mut studio);
}

impl ScreenshotJobs {
    fn obey(&mut self, order: ScreenshotOrder, simulation: &mut Simulation, studio: &mut Studio) {
        match order {
            ScreenshotOrder::Picture(order) => {
                let picture = SinglePicture::now(order);
                match self
                    .why_not_off_screen()
                    .filter(|_| !picture.is_of_window())
                {
                    Some(reason) => studio.say(format!("No picture is taken: {reason}")),
                    None => self.push(ScreenshotSubject::Picture(picture)),
                }
            }
            ScreenshotOrder::Film(order) => {
                let reel = match self.why_not_off_screen() {
                    None => FilmReel::begin(order, simulation),
                    Some(reason) => Err(reason.to_owned()),
                };
                match reel {
                    Ok(reel) => self.push(ScreenshotSubject::Film(reel)),
                    Err(reason) => studio.say(format!("No film is recorded: {reason}")),
                }
            }
            ScreenshotOrder::EndFilm | ScreenshotOrder::CancelFilm => {
                let Some((reel, stage)) = self.film() else {
                    return;
                };
                if order == ScreenshotOrder::CancelFilm {
                    reel.cancel();
                }
                if std::mem::replace(stage, JobStage::Ending) != JobStage::Ending {
                    reel.finish(simulation, false);
                }
            }
        }
    }

    fn push(&mut self, subject: ScreenshotSubject) {
        self.0.push(ScreenshotJob::of(subject));
    }

    /// Why nothing else can be drawn off screen now, where that is so.
    fn why_not_off_screen(&self) -> Option<&'static str> {
        (self.0.iter()).find_map(|job| match &job.subject {
            ScreenshotSubject::Film(_) => Some("a film is being recorded: stop it first"),
            ScreenshotSubject::Picture(picture) if picture.is_of_window() => None,
            ScreenshotSubject::Picture(_) => {
                Some("a picture is being taken: ask again in a moment")
            }
        })
    }

    /// Nobody watches without a display: until the moment of the picture comes the cores belong to
    /// the solver.
    fn rest_cameras(&self, studio: &mut Studio) {
        let Some(job) = self.0.iter().find(|job| job.ends_app.is_some()) else {
            return;
        };
        let rests = studio.canvas.is_some() && job.stage == JobStage::Waiting;
        for mut camera in &mut studio.cameras {
            camera.is_active = !rests;
        }
    }
}

impl ScreenshotJob {
    fn of(subject: ScreenshotSubject) -> Self {
        Self {
            subject,
            stage: JobStage::Waiting,
            inbox: Inbox::default(),
            frames_waited: 0,
            ends_app: None,
        }
    }

    /// One frame further. The renderer takes one picture at a time and drops a second one: a
    /// picture waits until the renderer `is_free`.
    fn go_on(&mut self, simulation: &mut Simulation, studio: &mut Studio, is_free: &mut bool) {
        let frames = self.subject.frames();
        if self.stage == JobStage::Waiting
            && self.subject.has_come(simulation, studio.awaits_pair())
        {
            self.stage = JobStage::Drawing(frames);
            studio.arrange(&mut self.subject);
            if frames > 0 {
                return;
            }
        }
        let is_drawing = matches!(self.stage, JobStage::Drawing(_));
        let is_ready = self.subject.is_settled(simulation, studio.is_whole())
            && (!is_drawing || self.has_pipelines(studio));
        self.stage = match self.stage {
            JobStage::Drawing(_) if !is_ready => JobStage::Drawing(frames),
            JobStage::Drawing(0) if !*is_free => JobStage::Drawing(0),
            JobStage::Drawing(0) => {
                *is_free = false;
                self.subject.note(simulation);
                self.take_picture(studio);
                JobStage::Taking
            }
            JobStage::Drawing(left) => JobStage::Drawing(left - 1),
            JobStage::Taking => self.put_away(simulation, studio),
            stage @ (JobStage::Waiting | JobStage::Ending) => stage,
        };
    }

    /// Whether the renderer has all that it draws with, or has not made it for long.
    fn has_pipelines(&mut self, studio: &Studio) -> bool {
        let is_ready = studio.second.is_ready() || self.frames_waited >= MOST_FRAMES_WAITED;
        self.frames_waited += u32::from(!is_ready);
        is_ready
    }

    /// Asks the renderer for the second picture where one is drawn, else for the window, or the
    /// canvas where there is one.
    fn take_picture(&self, studio: &mut Studio) {
        let inbox = self.inbox.clone();
        let second = match &self.subject {
            ScreenshotSubject::Picture(picture) if picture.is_of_window() => None,
            _ => studio.second.screenshot(),
        };
        let picture = second.unwrap_or_else(|| screenshot(studio.canvas.as_deref()));
        studio
            .commands
            .spawn(picture)
            .observe(move |captured: On<ScreenshotCaptured>| {
                let mut inbox = inbox.lock().unwrap_or_else(PoisonError::into_inner);
                *inbox = Some(captured.image.clone());
            });
    }

    /// Puts the picture away if it has come.
    fn put_away(&mut self, simulation: &mut Simulation, studio: &mut Studio) -> JobStage {
        let mut inbox = self.inbox.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(image) = inbox.take() else {
            return JobStage::Taking;
        };
        drop(inbox);
        match self.subject.put_away(image, simulation) {
            Following::Next => {
                studio.second.rest();
                JobStage::Waiting
            }
            Following::End => JobStage::Ending,
        }
    }

    /// Whether all is over; says what became of it.
    fn is_done(&mut self, studio: &mut Studio) -> bool {
        if self.stage != JobStage::Ending {
            return false;
        }
        let Some(outcome) = self.subject.outcome() else {
            return false;
        };
        let path = self.subject.path();
        match (&self.ends_app, outcome) {
            (Some(_), Ok(())) => {
                studio.exit.write(AppExit::Success);
            }
            (Some(failure), Err(error)) => {
                let text = format!("{} cannot be written: {error}", path.display());
                studio.exit.write(failure.tell(WindowError::Picture(text)));
            }
            (None, outcome) => {
                let what = match self.subject {
                    ScreenshotSubject::Picture(_) => "The picture",
                    ScreenshotSubject::Film(_) => "The film",
                };
                let text = said(what, path, outcome);
                studio.say(text);
            }
        }
        true
    }
}
