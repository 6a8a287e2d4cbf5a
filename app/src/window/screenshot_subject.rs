//! What screenshots are of: one picture, now or at a moment of the run, or the pictures of a film.
//!
//! In: the simulation, which is asked to hold where a picture is due. Out: whether a picture is
//! due, and what becomes of it once it is taken: a PNG file, or the next picture of a film. When
//! the picture is taken is the job's business.

use crate::simulation::Simulation;
use crate::ui::PictureOf;
use crate::view::{FILM_RATE, FilmKind, FilmWriter, Ground, ViewSettings, save_cut_out, save_png};
use crate::window::canvas::WARM_UP;
use bevy::math::URect;
use bevy::prelude::*;
use grainfall::lab::{Half, LabCommand, RunView, Status};
use grainfall::run::{Command, Provenance};
use std::io;
use std::path::{Path, PathBuf};

/// Frames from a state that is reached to one that is surely drawn: panels, then the renderer a
/// frame behind.
pub(super) const UNTIL_DRAWN: u32 = 2;

/// What screenshots are taken of.
pub(super) enum ScreenshotSubject {
    /// The window, or the grains alone, once.
    Picture(SinglePicture),
    /// The part of it that panels leave free, at regular simulated times.
    Film(FilmReel),
}

/// One picture.
pub(super) struct SinglePicture {
    path: PathBuf,
    of: PictureOf,
    moment: PictureMoment,
    /// Whether the run was told to hold for it.
    holds: bool,
    /// How the window looked before what does not belong into it was put away.
    pub(super) before: Option<Before>,
    /// The picture on black, where another one on white is still to come.
    on_black: Option<Box<Image>>,
    from: Option<Provenance>,
    saved: Option<io::Result<()>>,
}

/// What is put away for a picture, as it was before.
pub(super) struct Before {
    pub(super) is_hidden: bool,
    pub(super) show_overlay: bool,
    pub(super) show_measured: bool,
}

/// Which moment a picture shows.
enum PictureMoment {
    /// Whatever is in the window.
    Now,
    /// A simulated time [s], and its step once the run has begun.
    At(f64, Option<u64>),
}

/// The pictures of a film: the run holds at each until it is taken, so that the film runs smoothly
/// however slow the machine is.
pub(super) struct FilmReel {
    film: FilmWriter,
    path: PathBuf,
    pictures: usize,
    /// Simulated time from picture to picture: so many steps, as many as they are at the time [s].
    interval: f64,
    /// When the next one is due [s], and the step of that time.
    due: f64,
    next: u64,
}

/// What follows a picture that has been taken.
pub(super) enum Following {
    /// Another one.
    Next,
    /// None.
    End,
}

impl ScreenshotSubject {
    /// Whether the state that is to be drawn has come. `awaits_pair`: a second run beside the first
    /// is still to begin.
    pub(super) fn has_come(&mut self, simulation: &mut Simulation, awaits_pair: bool) -> bool {
        match self {
            Self::Picture(picture) => !awaits_pair && picture.has_come(simulation),
            Self::Film(reel) => reel.has_come(simulation),
        }
    }

    /// Frames to draw from that state on before the picture is taken.
    pub(super) fn frames(&self) -> u32 {
        match self {
            Self::Picture(picture) => match picture.moment {
                PictureMoment::Now if picture.of == PictureOf::Window => 0,
                PictureMoment::Now | PictureMoment::At(..) => WARM_UP,
            },
            Self::Film(_) => UNTIL_DRAWN,
        }
    }

    /// Whether nothing of the picture is on its way any more. `is_whole`: all meshes and shadows
    /// fit the state shown.
    pub(super) fn is_settled(&self, simulation: &Simulation, is_whole: bool) -> bool {
        match self {
            Self::Picture(SinglePicture {
                moment: PictureMoment::At(..),
                ..
            }) => {
                let holds = simulation.has_answered() && *simulation.status() == Status::Paused;
                holds && is_whole
            }
            Self::Picture(picture) => is_whole || picture.of == PictureOf::Window,
            Self::Film(_) => true,
        }
    }

    /// The picture is taken now: notes what it shows.
    pub(super) fn note(&mut self, simulation: &Simulation) {
        if let Self::Picture(picture) = self {
            picture.from = simulation.provenance();
        }
    }

    /// Puts away the `image` of the window.
    pub(super) fn put_away(
        &mut self,
        image: Image,
        settings: &ViewSettings,
        simulation: &mut Simulation,
    ) -> Following {
        match self {
            Self::Picture(picture) => picture.put_away(image, simulation),
            Self::Film(reel) => {
                reel.add(image, settings, simulation);
                Following::Next
            }
        }
    }

    /// Where the file goes.
    pub(super) fn path(&self) -> &Path {
        match self {
            Self::Picture(picture) => &picture.path,
            Self::Film(reel) => &reel.path,
        }
    }

    /// What became of the file, once that is known.
    pub(super) fn outcome(&mut self) -> Option<io::Result<()>> {
        match self {
            Self::Picture(picture) => picture.saved.take(),
            Self::Film(reel) => reel.film.has_ended().then(|| reel.film.outcome()),
        }
    }
}

impl SinglePicture {
    /// A picture as it is now.
    pub(super) fn now(path: PathBuf, of: PictureOf) -> Self {
        Self::new(path, of, PictureMoment::Now)
    }

    /// A picture when the run is at `time` [s].
    pub(super) fn at(path: PathBuf, of: PictureOf, time: f64) -> Self {
        Self::new(path, of, PictureMoment::At(time, None))
    }

    fn new(path: PathBuf, of: PictureOf, moment: PictureMoment) -> Self {
        Self {
            path,
            of,
            moment,
            holds: false,
            before: None,
            on_black: None,
            from: None,
            saved: None,
        }
    }

    /// On which ground its next shot is taken; none of the window as it is.
    pub(super) fn ground(&self) -> Option<Ground> {
        match self.of {
            PictureOf::Window => None,
            PictureOf::Grains => Some(Ground::Chosen),
            PictureOf::CutOut if self.on_black.is_none() => Some(Ground::Black),
            PictureOf::CutOut => Some(Ground::White),
        }
    }

    /// Saves the `image`, or waits for the one on the other ground.
    fn put_away(&mut self, image: Image, simulation: &mut Simulation) -> Following {
        let from = self.from.as_ref();
        self.saved = match (self.of, self.on_black.take()) {
            (PictureOf::CutOut, None) => {
                self.on_black = Some(Box::new(image));
                return Following::Next;
            }
            (PictureOf::CutOut, Some(black)) => {
                Some(save_cut_out([&black, &image], from, &self.path))
            }
            (PictureOf::Window | PictureOf::Grains, _) => Some(save_png(&image, from, &self.path)),
        };
        if std::mem::take(&mut self.holds) {
            simulation.send(LabCommand::Hold(None));
        }
        Following::End
    }

    /// Lets a run that goes on hold where it is, so that all shots are of one state; whether it
    /// does.
    fn is_held(&mut self, simulation: &mut Simulation) -> bool {
        if self.of == PictureOf::CutOut && !std::mem::replace(&mut self.holds, true) {
            let step = simulation.world().map_or(0, |world| world.clock.step);
            simulation.send(LabCommand::Hold(Some(step)));
            return false;
        }
        simulation.has_answered()
    }

    fn has_come(&mut self, simulation: &mut Simulation) -> bool {
        if matches!(self.moment, PictureMoment::Now) {
            return self.of != PictureOf::CutOut || self.is_held(simulation);
        }
        let PictureMoment::At(time, aim) = &mut self.moment else {
            return true;
        };
        let Some(step) = *aim else {
            let step = (simulation.world()).map(|world| world.clock.step_at(*time));
            // A recording goes no further than its last state.
            let end = simulation.past().end.step;
            let is_over = |step: &u64| simulation.recording().is_some() && *step > end;
            *aim = step.map(|step| if is_over(&step) { end } else { step });
            // Until there is a run it holds where it begins.
            simulation.send(LabCommand::Hold(aim.or(Some(0))));
            return false;
        };
        // A comparison that was asked for starts both runs afresh.
        if !simulation.has_answered() {
            return false;
        }
        let is_there = |run: &RunView| run.world().is_some() && run.reached() >= step;
        let are_there = (Half::ALL.into_iter()).all(|half| is_there(simulation.half(half)));
        if are_there {
            // How fast it came here, on the way to a picture, is nothing to show.
            simulation.send(Command::Pause);
        }
        are_there
    }
}

impl FilmReel {
    /// A film into `path`, from the state shown on.
    ///
    /// # Errors
    /// In words, where there is no state, or no such film can be written there.
    pub(super) fn begin(path: PathBuf, simulation: &mut Simulation) -> Result<Self, String> {
        let world = simulation.world().ok_or("there is no run yet")?;
        let kind = FilmKind::of(&path)?;
        let speed = simulation.speed();
        let speed = if speed.is_finite() { speed } else { 1.0 };
        let (step, due) = (world.clock.step, world.time());
        let interval = speed / f64::from(FILM_RATE);
        let from = Provenance::of_scene(simulation.scene());
        let film = FilmWriter::begin(path.clone(), kind, from)
            .map_err(|reason| format!("{}: {reason}", path.display()))?;
        simulation.send(LabCommand::Hold(Some(step)));
        Ok(Self {
            film,
            path,
            pictures: 0,
            interval,
            due,
            next: step,
        })
    }

    /// How many pictures there are so far, and the simulated time that they span [s].
    pub(super) fn length(&self) -> (usize, f64) {
        let intervals = self.pictures.saturating_sub(1) as f64;
        (self.pictures, intervals * self.interval)
    }

    /// Pictures that are not written yet.
    pub(super) fn unwritten(&self) -> usize {
        self.film.waiting()
    }

    /// Whether it cannot go on: what it shows is another run, or its file cannot be written.
    pub(super) fn is_cut_off(&self, is_another_run: bool) -> bool {
        is_another_run && self.pictures > 0 || self.film.has_ended()
    }

    /// Whether the recording that it shows ends before its next picture.
    pub(super) fn is_over(&self, simulation: &Simulation) -> bool {
        let ends = self.next > simulation.past().end.step;
        self.pictures > 0 && ends && simulation.recording().is_some()
    }

    /// There is no further picture: the run may go on.
    pub(super) fn finish(&mut self, simulation: &mut Simulation) {
        self.film.finish();
        simulation.send(LabCommand::Hold(None));
    }

    /// Leaves nothing behind.
    pub(super) fn cancel(&mut self) {
        self.film.cancel();
    }

    fn has_come(&mut self, simulation: &mut Simulation) -> bool {
        let (Some(times), Some(world)) = (simulation.step_times(), simulation.world()) else {
            return false;
        };
        // Between two states of a recording the last one is shown.
        let sought = times.time_at(simulation.step().max(simulation.reached()));
        if (sought - self.due).abs() > 1.5 * self.interval.max(world.clock.time_step) {
            // Somebody went to another moment: the film goes on from there.
            self.due = sought;
        }
        // A time step that was changed meanwhile has another step there.
        self.aim_at(times.step_at(self.due), simulation);
        simulation.reached() >= self.next && self.film.has_room()
    }

    /// The next picture is that of `step`; the run goes no further until it is taken.
    fn aim_at(&mut self, step: u64, simulation: &mut Simulation) {
        if step != self.next {
            self.next = step;
            simulation.send(LabCommand::Hold(Some(step)));
        }
    }

    fn add(&mut self, image: Image, settings: &ViewSettings, simulation: &mut Simulation) {
        let area = free_area(&image, settings);
        self.film.add(image, area);
        self.pictures += 1;
        self.due += self.interval;
        if let Some(times) = simulation.step_times() {
            self.aim_at(times.step_at(self.due), simulation);
        }
    }
}

/// The part of a picture of the window that the panels leave free.
pub(super) fn free_area(image: &Image, settings: &ViewSettings) -> URect {
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
