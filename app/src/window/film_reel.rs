//! The pictures of a film: of a run that goes on, or of what is recorded of it.
//!
//! In: the simulation, which holds at each picture until that is taken, so that a film passes evenly
//! however slow the machine is. Out: whether a picture is due, and the film. After what is recorded
//! the run stands, or goes on, where it was before.

use crate::simulation::Simulation;
use crate::ui::{FilmOrder, FilmSpan, FilmState, PictureOf};
use crate::view::{Drawn, FilmKind, FilmWriter, Ground, SecondLook};
use crate::window::seen::Seen;
use bevy::prelude::*;
use grainfall::lab::{LabCommand, Status};
use grainfall::run::{Command, Provenance};
use std::io;
use std::path::Path;

/// The pictures of a film.
pub(super) struct FilmReel {
    film: FilmWriter,
    order: FilmOrder,
    pictures: usize,
    /// When the next one is due [s], and the step of that time.
    due: f64,
    next: u64,
    course: Course,
    look: Option<SecondLook>,
    /// The picture on black, where the one on white is still to come.
    on_black: Option<Image>,
}

/// How the run comes to its next picture.
enum Course {
    /// It goes on.
    GoesOn,
    /// It is taken back to it.
    IsTaken(Journey),
}

/// Through what is recorded and back.
struct Journey {
    /// Number of all pictures.
    all: usize,
    /// Whether the state of the next picture was asked for.
    is_asked: bool,
    /// The step that was shown before, and whether the run went on from there.
    back: (u64, bool),
}

impl FilmReel {
    /// The film that `order` asks for.
    ///
    /// # Errors
    /// In words, where there is no state, or no such film can be written there.
    pub(super) fn begin(mut order: FilmOrder, simulation: &mut Simulation) -> Result<Self, String> {
        let world = simulation.world().ok_or("there is no run yet")?;
        let (step, time) = (world.clock.step, world.time());
        let kind = FilmKind::of(&order.path)?;
        order.pace.rate = kind.rate(order.pace.rate);
        let from = Provenance::of_scene(simulation.scene());
        let film = FilmWriter::begin(order.path.clone(), kind, order.pace.rate, from)
            .map_err(|reason| format!("{}: {reason}", order.path.display()))?;
        let (due, course) = match order.span {
            FilmSpan::FromNow => {
                simulation.send(LabCommand::Hold(Some(step)));
                (time, Course::GoesOn)
            }
            FilmSpan::Recorded { from, to } => {
                let plays = *simulation.status() == Status::Running;
                let journey = Journey {
                    all: order.pace.frames(from, to),
                    is_asked: false,
                    back: (simulation.step(), plays),
                };
                (from, Course::IsTaken(journey))
            }
        };
        Ok(Self {
            film,
            order,
            pictures: 0,
            due,
            next: step,
            course,
            look: None,
            on_black: None,
        })
    }

    /// How its next shot is to look, in a window in which pictures are `seen` so: all as large as the
    /// first.
    pub(super) fn look(&mut self, seen: &Seen) -> SecondLook {
        let ground = self.ground();
        let FilmOrder { of, size, .. } = self.order;
        let look = *(self.look).get_or_insert_with(|| seen.look(of, size, ground));
        SecondLook { ground, ..look }
    }

    /// Where the file goes.
    pub(super) fn path(&self) -> &Path {
        &self.order.path
    }

    /// On which ground its next shot is taken.
    fn ground(&self) -> Ground {
        match (self.order.of, &self.on_black) {
            (PictureOf::CutOut, None) => Ground::Black,
            (PictureOf::CutOut, Some(_)) => Ground::White,
            _ => Ground::Chosen,
        }
    }

    /// Whether no shot of it was taken yet.
    pub(super) fn is_new(&self) -> bool {
        self.pictures == 0
    }

    /// How far it has come, while pictures are taken.
    pub(super) fn state(&self) -> FilmState {
        let pictures = self.pictures;
        match &self.course {
            Course::IsTaken(journey) => FilmState::Replaying {
                pictures,
                all: journey.all,
            },
            Course::GoesOn => FilmState::Recording {
                pictures,
                time: pictures.saturating_sub(1) as f64 * self.order.pace.interval(),
            },
        }
    }

    /// Pictures that are not written yet.
    pub(super) fn unwritten(&self) -> usize {
        self.film.waiting()
    }

    /// Whether it cannot go on: what it shows is another run, or its file cannot be written.
    pub(super) fn is_cut_off(&self, is_another_run: bool) -> bool {
        let was_begun = self.pictures > 0 || matches!(self.course, Course::IsTaken(_));
        is_another_run && was_begun || self.film.has_ended()
    }

    /// Whether it has its last picture.
    pub(super) fn is_over(&self, simulation: &Simulation) -> bool {
        match &self.course {
            Course::IsTaken(journey) => self.pictures >= journey.all,
            // A recording ends.
            Course::GoesOn => {
                let ends = self.next > simulation.past().end.step;
                self.pictures > 0 && ends && simulation.recording().is_some()
            }
        }
    }

    /// There is no further picture: the run may go on, or goes back to where it was, unless it
    /// `is_another_run` by now.
    pub(super) fn finish(&mut self, simulation: &mut Simulation, is_another_run: bool) {
        self.film.finish();
        match &self.course {
            Course::GoesOn => simulation.send(LabCommand::Hold(None)),
            Course::IsTaken(_) if is_another_run => {}
            Course::IsTaken(journey) => {
                let (step, plays) = journey.back;
                simulation.send(Command::Seek(step));
                if plays {
                    simulation.send(Command::Play);
                }
            }
        }
    }

    /// Leaves nothing behind.
    pub(super) fn cancel(&mut self) {
        self.film.cancel();
    }

    /// What became of the file, once that is known.
    pub(super) fn outcome(&mut self) -> Option<io::Result<()>> {
        self.film.has_ended().then(|| self.film.outcome())
    }

    /// Whether the state of its next picture has come.
    pub(super) fn has_come(&mut self, simulation: &mut Simulation) -> bool {
        let (Some(times), Some(world)) = (simulation.step_times(), simulation.world()) else {
            return false;
        };
        if let Course::IsTaken(journey) = &mut self.course {
            if !std::mem::replace(&mut journey.is_asked, true) {
                let step = times.step_at(self.due).min(simulation.past().end.step);
                simulation.send(Command::Seek(step));
            }
            let is_there = simulation.has_answered() && *simulation.status() == Status::Paused;
            return is_there && self.film.has_room();
        }
        // Between two states of a recording the last one is shown.
        let sought = times.time_at(simulation.step().max(simulation.reached()));
        let interval = self.order.pace.interval();
        if (sought - self.due).abs() > 1.5 * interval.max(world.clock.time_step) {
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

    /// Adds what was drawn of the state `from`, or waits for the same on the other ground.
    pub(super) fn add(
        &mut self,
        image: Image,
        from: Option<Provenance>,
        simulation: &mut Simulation,
    ) {
        let drawn = match (self.order.of, self.on_black.take()) {
            (PictureOf::CutOut, None) => {
                self.on_black = Some(image);
                return;
            }
            (PictureOf::CutOut, Some(black)) => Drawn::CutOut([black, image]),
            _ => Drawn::Whole(image),
        };
        self.film.add(drawn, from);
        self.pictures += 1;
        match &mut self.course {
            Course::IsTaken(journey) => {
                let FilmSpan::Recorded { from, .. } = self.order.span else {
                    return;
                };
                journey.is_asked = false;
                self.due = from + self.pictures as f64 * self.order.pace.interval();
            }
            Course::GoesOn => {
                self.due += self.order.pace.interval();
                if let Some(times) = simulation.step_times() {
                    self.aim_at(times.step_at(self.due), simulation);
                }
            }
        }
    }
}
