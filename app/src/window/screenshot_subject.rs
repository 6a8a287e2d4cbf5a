//! What screenshots are of: one picture, now or at a moment of the run, or the pictures of a film.
//!
//! In: the simulation, which is asked to hold where a picture is due. Out: whether a picture is
//! due, and what becomes of it once it is taken: a PNG file, or the next picture of a film. When
//! the picture is taken is the job's business.

use crate::simulation::Simulation;
use crate::ui::{PictureOf, PictureOrder};
use crate::view::{Ground, SecondLook, save_cut_out, save_png};
use crate::window::canvas::WARM_UP;
use crate::window::film_reel::FilmReel;
use crate::window::seen::Seen;
use bevy::prelude::*;
use grainfall::lab::{Half, LabCommand, RunView, Status};
use grainfall::run::{Command, Provenance};
use std::io;
use std::path::Path;

/// Frames from a state that is reached to one that is surely drawn: panels, then the renderer a
/// frame behind.
pub(super) const UNTIL_DRAWN: u32 = 2;

/// What screenshots are taken of.
#[expect(
    clippy::large_enum_variant,
    reason = "there is one, or a few, in a program"
)]
pub(super) enum ScreenshotSubject {
    /// One picture.
    Picture(SinglePicture),
    /// Many, at regular simulated times.
    Film(FilmReel),
}

/// One picture.
pub(super) struct SinglePicture {
    order: PictureOrder,
    moment: PictureMoment,
    /// Whether the run was told to hold for it.
    holds: bool,
    /// The picture on black, where another one on white is still to come.
    on_black: Option<Box<Image>>,
    from: Option<Provenance>,
    saved: Option<io::Result<()>>,
}

/// Which moment a picture shows.
enum PictureMoment {
    /// Whatever is in the window.
    Now,
    /// A simulated time [s], and its step once the run has begun.
    At(f64, Option<u64>),
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
                PictureMoment::Now if picture.is_of_window() => 0,
                PictureMoment::Now | PictureMoment::At(..) => WARM_UP,
            },
            Self::Film(reel) if reel.is_new() => WARM_UP,
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
            Self::Picture(picture) => is_whole || picture.is_of_window(),
            Self::Film(_) => is_whole,
        }
    }

    /// How its next shot is to look, in a window in which pictures are `seen` so; none of the window
    /// as it is.
    pub(super) fn look(&mut self, seen: &Seen) -> Option<SecondLook> {
        match self {
            Self::Picture(picture) if picture.is_of_window() => None,
            Self::Picture(picture) => {
                let PictureOrder { of, size, .. } = picture.order;
                Some(seen.look(of, size, picture.ground()))
            }
            Self::Film(reel) => Some(reel.look(seen)),
        }
    }

    /// The picture is taken now: notes what it shows.
    pub(super) fn note(&mut self, simulation: &Simulation) {
        if let Self::Picture(picture) = self {
            picture.from = simulation.provenance();
        }
    }

    /// Puts away the `image` that was taken.
    pub(super) fn put_away(&mut self, image: Image, simulation: &mut Simulation) -> Following {
        match self {
            Self::Picture(picture) => picture.put_away(image, simulation),
            Self::Film(reel) => {
                // The run holds: it shows what was drawn.
                let from = simulation.provenance();
                reel.add(image, from, simulation);
                Following::Next
            }
        }
    }

    /// Where the file goes.
    pub(super) fn path(&self) -> &Path {
        match self {
            Self::Picture(picture) => &picture.order.path,
            Self::Film(reel) => reel.path(),
        }
    }

    /// What became of the file, once that is known.
    pub(super) fn outcome(&mut self) -> Option<io::Result<()>> {
        match self {
            Self::Picture(picture) => picture.saved.take(),
            Self::Film(reel) => reel.outcome(),
        }
    }
}

impl SinglePicture {
    /// A picture as it is now.
    pub(super) fn now(order: PictureOrder) -> Self {
        Self::new(order, PictureMoment::Now)
    }

    /// A picture when the run is at `time` [s].
    pub(super) fn at(order: PictureOrder, time: f64) -> Self {
        Self::new(order, PictureMoment::At(time, None))
    }

    fn new(order: PictureOrder, moment: PictureMoment) -> Self {
        Self {
            order,
            moment,
            holds: false,
            on_black: None,
            from: None,
            saved: None,
        }
    }

    /// Whether it is taken of the window itself, as that is.
    pub(super) fn is_of_window(&self) -> bool {
        self.order.of == PictureOf::Window && self.order.size.is_none()
    }

    /// On which ground its next shot is taken.
    fn ground(&self) -> Ground {
        match (self.order.of, &self.on_black) {
            (PictureOf::CutOut, None) => Ground::Black,
            (PictureOf::CutOut, Some(_)) => Ground::White,
            _ => Ground::Chosen,
        }
    }

    /// Saves the `image`, or waits for the one on the other ground.
    fn put_away(&mut self, image: Image, simulation: &mut Simulation) -> Following {
        let from = self.from.as_ref();
        let path = &self.order.path;
        self.saved = match (self.order.of, self.on_black.take()) {
            (PictureOf::CutOut, None) => {
                self.on_black = Some(Box::new(image));
                return Following::Next;
            }
            (PictureOf::CutOut, Some(black)) => Some(save_cut_out([&black, &image], from, path)),
            _ => Some(save_png(&image, from, path)),
        };
        if std::mem::take(&mut self.holds) {
            simulation.send(LabCommand::Hold(None));
        }
        Following::End
    }

    /// Lets a run that goes on hold where it is, so that all shots are of one state; whether it
    /// does.
    fn is_held(&mut self, simulation: &mut Simulation) -> bool {
        if !std::mem::replace(&mut self.holds, true) {
            let step = simulation.world().map_or(0, |world| world.clock.step);
            simulation.send(LabCommand::Hold(Some(step)));
            return false;
        }
        simulation.has_answered()
    }

    fn has_come(&mut self, simulation: &mut Simulation) -> bool {
        if matches!(self.moment, PictureMoment::Now) {
            return self.is_of_window() || self.is_held(simulation);
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
