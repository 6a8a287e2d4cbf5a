//! A picture taken by the program itself: the run goes to a moment and holds, the picture is taken, the program ends.
//!
//! In: a [`PictureJob`] and the simulation. Out: the file and an [`Outcome`].

use super::picture::{Canvas, WARM_UP, screenshot};
use super::{Comparison, PictureJob, WindowError};
use crate::simulation::{Command, Half, Provenance, Simulation, Status};
use crate::view::{GrainBuffer, Meshing, save_png};
use bevy::prelude::*;
use bevy::render::view::screenshot::ScreenshotCaptured;
use std::num::NonZero;
use std::sync::{Arc, Mutex, PoisonError};

/// What became of the picture, for whom started the app.
#[derive(Clone, Default)]
pub(super) struct Outcome(Arc<Mutex<Option<WindowError>>>);

impl Outcome {
    /// Why there is no picture, if there should be one and is none.
    pub(super) fn result(&self) -> Result<(), WindowError> {
        let failure = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        failure.map_or(Ok(()), Err)
    }

    fn fail(&self, error: WindowError) -> AppExit {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
        AppExit::Error(NonZero::<u8>::MIN)
    }
}

/// A picture that was asked for.
#[derive(Resource)]
pub(super) struct Commission {
    picture: PictureJob,
    outcome: Outcome,
    stage: Stage,
}

impl Commission {
    /// The picture `picture`; what becomes of it is told to `outcome`.
    pub(super) fn new(picture: PictureJob, outcome: Outcome) -> Self {
        Self {
            picture,
            outcome,
            stage: Stage::Preparing,
        }
    }
}

/// How far the picture has come.
#[derive(Clone, Copy)]
enum Stage {
    /// The run has not begun.
    Preparing,
    /// The run goes on until this step.
    Running(u64),
    /// It is there; so many frames are still drawn, so that all is in place.
    Drawing(u32),
    /// The picture is being taken.
    Taking,
}

/// Brings the picture one frame further.
pub(super) fn carry_out(
    mut commission: ResMut<Commission>,
    mut simulation: ResMut<Simulation>,
    canvas: Option<Res<Canvas>>,
    (meshing, grains, comparison): (Res<Meshing>, Res<GrainBuffer>, Res<Comparison>),
    mut cameras: Query<&mut Camera>,
    mut exit: MessageWriter<AppExit>,
    mut commands: Commands,
) {
    match simulation.status() {
        Status::Failed(reason) => {
            exit.write(
                commission
                    .outcome
                    .fail(WindowError::Picture(reason.clone())),
            );
        }
        Status::Faulted(fault) => {
            exit.write(
                commission
                    .outcome
                    .fail(WindowError::Fault(fault.to_string())),
            );
        }
        _ => {}
    }
    if let Some(reason) = &comparison.refused {
        exit.write(
            commission
                .outcome
                .fail(WindowError::Picture(reason.clone())),
        );
    }
    commission.stage = match commission.stage {
        Stage::Preparing if comparison.wanted.is_some() => Stage::Preparing,
        Stage::Preparing => {
            let step = (simulation.world()).map(|world| world.clock.step_at(commission.picture.at));
            simulation.hold_at(step.or(Some(0)));
            step.map_or(Stage::Preparing, Stage::Running)
        }
        Stage::Running(step) => {
            let has_come = |run: &Simulation| run.world().is_some_and(|w| w.clock.step >= step);
            let reached = Half::ALL
                .into_iter()
                .all(|half| has_come(simulation.half(half)));
            if reached {
                // How fast it came here, on the way to a picture, is nothing to show.
                simulation.send(Command::Pause);
                Stage::Drawing(WARM_UP)
            } else {
                Stage::Running(step)
            }
        }
        Stage::Drawing(_) if !(holds(&simulation) && meshing.is_whole() && grains.is_whole()) => {
            Stage::Drawing(WARM_UP)
        }
        Stage::Drawing(0) => {
            let from = simulation.provenance();
            take(&commission, from, canvas.as_deref(), &mut commands);
            Stage::Taking
        }
        Stage::Drawing(frames) => Stage::Drawing(frames - 1),
        Stage::Taking => Stage::Taking,
    };
    // Nobody watches without a display: until the moment comes the cores belong to the solver.
    let rests =
        canvas.is_some() && matches!(commission.stage, Stage::Preparing | Stage::Running(_));
    for mut camera in &mut cameras {
        camera.is_active = !rests;
    }
}

fn holds(simulation: &Simulation) -> bool {
    simulation.has_answered() && *simulation.status() == Status::Paused
}

/// Takes the picture, writes it and ends the app.
fn take(
    commission: &Commission,
    from: Option<Provenance>,
    canvas: Option<&Canvas>,
    commands: &mut Commands,
) {
    let path = commission.picture.path.clone();
    let outcome = commission.outcome.clone();
    commands.spawn(screenshot(canvas)).observe(
        move |captured: On<ScreenshotCaptured>, mut exit: MessageWriter<AppExit>| {
            exit.write(match save_png(&captured.image, from.as_ref(), &path) {
                Ok(()) => AppExit::Success,
                Err(error) => outcome.fail(WindowError::Picture(format!(
                    "{} cannot be written: {error}",
                    path.display()
                ))),
            });
        },
    );
}
