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
use crate::ui::{Dock, FilmState, PictureOf, ScreenshotOrder, ScreenshotOrders, said};
use crate::view::{GrainBuffer, Ground, Meshing, ViewSettings};
use crate::window::canvas::{Canvas, screenshot};
use crate::window::opening_comparison::{OpeningComparison, begin_comparison};
use crate::window::screenshot_subject::{
    Before, FilmReel, Following, ScreenshotSubject, SinglePicture,
};
use crate::window::window_job::{PictureJob, WindowError};
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::render::view::screenshot::ScreenshotCaptured;
use grainfall::lab::Status;
use std::num::NonZero;
use std::sync::{Arc, Mutex, PoisonError};

/// Takes the pictures that [`ScreenshotOrders`] ask for.
pub struct ScreenshotPlugin;

impl Plugin for ScreenshotPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ScreenshotOrders>()
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
        let subject = SinglePicture::at(picture.path.clone(), picture.of, picture.at);
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
    settings: ResMut<'w, ViewSettings>,
    ground: Option<ResMut<'w, Ground>>,
    canvas: Option<Res<'w, Canvas>>,
    comparison: Option<Res<'w, OpeningComparison>>,
    meshing: Option<Res<'w, Meshing>>,
    grains: Option<Res<'w, GrainBuffer>>,
    dock: Option<ResMut<'w, Dock>>,
    cameras: Query<'w, 's, &'static mut Camera>,
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

    /// Puts away what does not belong into the picture of `subject`.
    fn arrange(&mut self, subject: &mut ScreenshotSubject) {
        let ScreenshotSubject::Picture(picture) = subject else {
            return;
        };
        let Some(wanted) = picture.ground() else {
            return;
        };
        let is_hidden = self.dock.as_ref().is_some_and(|dock| dock.is_hidden);
        picture.before.get_or_insert(Before {
            is_hidden,
            show_overlay: self.settings.show_overlay,
            show_measured: self.settings.show_measured,
        });
        (self.settings.show_overlay, self.settings.show_measured) = (false, false);
        if let Some(dock) = &mut self.dock {
            dock.is_hidden = true;
        }
        if let Some(ground) = &mut self.ground {
            **ground = wanted;
        }
    }

    /// Puts back what was put away for the picture of `subject`.
    fn put_back(&mut self, subject: &mut ScreenshotSubject) {
        let ScreenshotSubject::Picture(picture) = subject else {
            return;
        };
        let Some(before) = picture.before.take() else {
            return;
        };
        self.settings.show_overlay = before.show_overlay;
        self.settings.show_measured = before.show_measured;
        if let Some(dock) = &mut self.dock {
            dock.is_hidden = before.is_hidden;
        }
        if let Some(ground) = &mut self.ground {
            **ground = Ground::Chosen;
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
        end_film(reel, stage, &mut simulation);
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
        Some((reel, _)) => {
            let (pictures, time) = reel.length();
            FilmState::Recording { pictures, time }
        }
    };
    jobs.rest_cameras(&mut studio);
}

/// Takes no further picture and lets the run go.
fn end_film(reel: &mut FilmReel, stage: &mut JobStage, simulation: &mut Simulation) {
    reel.finish(simulation);
    *stage = JobStage::Ending;
}

impl ScreenshotJobs {
    fn obey(&mut self, order: ScreenshotOrder, simulation: &mut Simulation, studio: &mut Studio) {
        match order {
            ScreenshotOrder::Picture(_, PictureOf::Grains | PictureOf::CutOut)
                if self.film().is_some() =>
            {
                studio.say("A film is being recorded: stop it first".to_owned());
            }
            ScreenshotOrder::Picture(path, of) => {
                let subject = ScreenshotSubject::Picture(SinglePicture::now(path, of));
                self.0.push(ScreenshotJob::of(subject));
            }
            ScreenshotOrder::Film(_) if self.film().is_some() => {
                studio.say("A film is being recorded already".to_owned());
            }
            ScreenshotOrder::Film(path) => match FilmReel::begin(path, simulation) {
                Ok(reel) => self
                    .0
                    .push(ScreenshotJob::of(ScreenshotSubject::Film(reel))),
                Err(reason) => studio.say(format!("No film is recorded: {reason}")),
            },
            ScreenshotOrder::EndFilm | ScreenshotOrder::CancelFilm => {
                if let Some((reel, stage)) = self.film() {
                    if order == ScreenshotOrder::CancelFilm {
                        reel.cancel();
                    }
                    end_film(reel, stage, simulation);
                }
            }
        }
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
        self.stage = match self.stage {
            JobStage::Drawing(_) if !self.subject.is_settled(simulation, studio.is_whole()) => {
                JobStage::Drawing(frames)
            }
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

    /// Asks the renderer for a picture of the window, or of the canvas where there is one.
    fn take_picture(&self, studio: &mut Studio) {
        let inbox = self.inbox.clone();
        let picture = screenshot(studio.canvas.as_deref());
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
        match self.subject.put_away(image, &studio.settings, simulation) {
            Following::Next => JobStage::Waiting,
            Following::End => {
                studio.put_back(&mut self.subject);
                JobStage::Ending
            }
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
