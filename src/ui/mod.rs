//! The egui panels.
//!
//! In: the [`Simulation`], read only, and the [`ViewSettings`]. Out: [`Request`]s, fulfilled in one place
//! ([`carry_out`]), and what is left free for the picture. A panel is one file, one
//! struct and one function `ui`; it needs neither Bevy nor a GPU, and every control has an accessible label.
//!
//! | file | holds |
//! |---|---|
//! | `desk` | the register of panels, where they stand, what lies over them |
//! | `request`, `carry_out` | what panels ask for, and how it is fulfilled |
//! | `shortcuts`, `keyboard` | what each key does; what was held with it |
//! | `menu`, `transport`, `scrub` | menu bar, bar under the picture, the timeline in it |
//! | `gallery`, `memory` | scenes with their pictures; what is remembered from start to start |
//! | `badge` | whether the run can be trusted, and why |
//! | `about_scene`, `parameters`, `changes`, `picture`, `profile` | panels on the left |
//! | `microscope` | one grain, its contacts, every term of their forces |
//! | `compare` | two runs side by side that differ in one parameter |
//! | `detail`, `start_values`, `value` | of the parameters: how many are shown, which act later, the row of one |
//! | `plots`, `velocity`, `beside_paper`, `results` | panels on the right; of columns, `collapse_plots` and `column_beside_paper` |
//! | `explorer`, `energy` | any quantity over time or another, the energy ledger as a stack |
//! | `recording` | what is asked of a film and how far it has come |
//! | `averages` | averages over a run that goes on |
//! | `sheets`, `path_dialog` | windows over the rest |
//! | `theme` | every colour, size and font |
//! | `field` | a number to type, and what is said of wrong text |
//! | `number`, `symbol`, `table`, `decimate` | numbers and symbols in text, tables, fewer points for the same picture |

mod about_scene;
mod averages;
mod badge;
mod beside_paper;
mod carry_out;
mod changes;
mod collapse_plots;
mod column_beside_paper;
mod compare;
mod decimate;
mod desk;
mod detail;
mod energy;
mod explorer;
mod field;
mod gallery;
mod keyboard;
mod memory;
mod menu;
mod microscope;
mod number;
mod parameters;
mod path_dialog;
mod picture;
mod plots;
mod profile;
mod recording;
mod request;
mod results;
mod scrub;
mod sheets;
mod shortcuts;
mod start_values;
mod symbol;
mod table;
pub mod theme;
mod transport;
mod value;
mod velocity;

pub use about_scene::AboutScene;
pub use badge::{Check, Level, checks};
pub(crate) use carry_out::said;
pub use collapse_plots::CollapsePlots;
pub use column_beside_paper::ColumnBesidePaper;
pub use compare::Compare;
use compare::half_title;
pub use desk::Desk;
pub use detail::Detail;
pub use energy::Energy;
pub use explorer::{Explorer, Export};
pub use memory::{Look, Memory};
pub use microscope::Microscope;
pub use parameters::{Parameters, parameter_ui};
pub use path_dialog::{PathDialog, Purpose};
pub use picture::Picture;
pub use plots::{Curves, Ghost, Plots};
pub use profile::{SolverProfile, advice_ui, profile_ui};
pub use recording::{FilmOrder, FilmState, Recorder, recording_ui};
pub use request::{Request, Sheet};
pub use results::Results;
pub use sheets::{open_error_ui, sheet_ui, unsaved_ui};
pub(crate) use transport::first_speed;
pub use transport::{Transport, status_ui};
pub use velocity::Velocity;

use crate::measure::Measure;
use crate::simulation::{Half, Options, Parameter, Simulation};
use crate::view::{Caption, OrbitCamera, ViewSettings, viewport_ui};
use crate::world::{Shape, World};
use bevy::asset::AssetEventSystems;
use bevy::prelude::*;
use bevy::window::{FileDragAndDrop, WindowCloseRequested};
use bevy_egui::{EguiContexts, EguiPostUpdateSet, EguiPreUpdateSet, EguiPrimaryContextPass, egui};

/// A part of the window: one file, one struct, one function.
pub trait Panel: Send + Sync + 'static {
    /// What stands over it.
    fn title(&self) -> &'static str;

    /// Whether it has anything to say of this simulation; it is left out where it has not.
    fn concerns(&self, _simulation: &Simulation) -> bool {
        true
    }

    /// Whether it is among what one looks at first in this simulation, so that it is open until a person closes it.
    fn comes_first(&self, _simulation: &Simulation) -> bool {
        false
    }

    /// Whether it should open now, though a person has not opened it.
    fn summons(&mut self, _view: &ViewSettings) -> bool {
        false
    }

    /// Whether it describes one run only, and knows nothing of a twin.
    fn describes_one_run(&self) -> bool {
        false
    }

    /// Lets it be about `parameter`, where it is about one.
    fn take_up(&mut self, _parameter: &Parameter) {}

    /// Draws it; what is asked for goes into `out`.
    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    );
}

/// Whether a column collapses in this simulation.
fn is_column(simulation: &Simulation) -> bool {
    let column = |world: &World| matches!(world.container.shape, Shape::Column { .. });
    simulation.world().is_some_and(|world| column(world))
}

/// Whether grains lie in a bed, whose surface is measured.
fn has_bed(simulation: &Simulation) -> bool {
    let world = simulation.world();
    world.is_some_and(|world| Measure::SurfaceAngle.concerns(world))
}

/// Draws the panels and fulfils what they ask for. Needs Bevy's default plugins, `EguiPlugin` and the view's plugin.
#[derive(Clone, Debug, Default)]
pub struct UiPlugin {
    /// How scenes are opened.
    pub options: Options,
}

/// How scenes that a person opens are run.
#[derive(Resource, Clone, Debug)]
struct OpenWith(Options);

/// What has been asked for and not yet fulfilled.
#[derive(Resource, Default)]
pub struct Requests(Vec<Request>);

impl Requests {
    /// Asks for `request`, as a panel would.
    pub fn ask(&mut self, request: Request) {
        self.0.push(request);
    }
}

impl Plugin for UiPlugin {
    fn build(&self, app: &mut App) {
        let options = self.options.clone();
        app.add_plugins(DeskPlugin { options })
            .add_systems(EguiPrimaryContextPass, (install_theme, draw_panels).chain())
            .add_systems(
                PreUpdate,
                keyboard::tell_modifiers
                    .after(EguiPreUpdateSet::ProcessInput)
                    .before(EguiPreUpdateSet::BeginPass),
            )
            // Else letters that were not drawn before are missing for a frame.
            .configure_sets(
                PostUpdate,
                EguiPostUpdateSet::PostProcessOutput.before(AssetEventSystems),
            );
    }
}

/// Fulfils what is asked for, by panels or by [`Requests::ask`]; draws nothing.
#[derive(Clone, Debug, Default)]
pub struct DeskPlugin {
    /// How scenes are opened.
    pub options: Options,
}

impl Plugin for DeskPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(OpenWith(self.options.clone()))
            .init_resource::<Requests>()
            .init_resource::<carry_out::Opening>()
            .init_resource::<Desk>()
            .init_resource::<Recorder>()
            .init_resource::<ViewSettings>()
            .add_message::<FileDragAndDrop>()
            .add_message::<WindowCloseRequested>()
            .add_systems(
                Update,
                (
                    take_dropped_files,
                    ask_before_closing,
                    carry_out::fulfil_requests,
                    carry_out::finish_opening,
                )
                    .chain(),
            );
    }
}

/// Gives a new window its look.
fn install_theme(mut contexts: EguiContexts, mut installed: Local<bool>) -> Result {
    if !*installed {
        theme::install(contexts.ctx_mut()?);
        *installed = true;
    }
    Ok(())
}

/// Draws everything round the picture, writes into the picture, and lets the pointer over the rest move the camera.
fn draw_panels(
    mut contexts: EguiContexts,
    mut desk: ResMut<Desk>,
    mut view: ResMut<ViewSettings>,
    mut camera: ResMut<OrbitCamera>,
    mut requests: ResMut<Requests>,
    recorder: Res<Recorder>,
    simulation: Option<Res<Simulation>>,
) -> Result {
    let ctx = contexts.ctx_mut()?.clone();
    let builder = egui::UiBuilder::new()
        .layer_id(egui::LayerId::background())
        .max_rect(ctx.viewport_rect());
    let mut root = egui::Ui::new(ctx, "root".into(), builder);
    let simulation = simulation.as_deref();
    if !desk.is_hidden {
        desk.ui(&mut root, simulation, &mut view, &mut requests.0);
        recording_ui(&mut root, &recorder, &mut requests.0);
    }
    // A film runs at its own speed, however long its pictures take.
    let is_filmed = recorder.state != FilmState::Idle;
    let captions = captions(simulation, is_filmed);
    viewport_ui(&mut root, &captions, &mut view, &mut camera);
    if !desk.is_hidden {
        desk.over_picture_ui(&root, simulation);
    }
    Ok(())
}

/// What stands in the picture: once, or in each of its halves; how fast it goes, only where it is not filmed.
fn captions(simulation: Option<&Simulation>, is_filmed: bool) -> Vec<Caption<'_>> {
    let factor = match simulation {
        Some(simulation) if !is_filmed => simulation.real_time_factor(),
        _ => 0.0,
    };
    let is_pair = |simulation: &&Simulation| {
        (simulation.twin()).is_some_and(|twin| twin.run().world().is_some())
    };
    match simulation.filter(is_pair) {
        None => vec![caption(simulation, factor, None)],
        Some(pair) => Half::ALL
            .map(|half| caption(Some(pair.half(half)), factor, Some(half_title(pair, half))))
            .into(),
    }
}

fn caption(run: Option<&Simulation>, factor: f64, title: Option<String>) -> Caption<'_> {
    Caption {
        world: run.and_then(|run| run.world().map(AsRef::as_ref)),
        real_time_factor: (factor > 0.0).then_some(factor),
        title,
    }
}

/// Asks to end the program when the window is to be closed.
fn ask_before_closing(
    mut closing: MessageReader<WindowCloseRequested>,
    mut requests: ResMut<Requests>,
) {
    if closing.read().count() > 0 {
        requests.0.push(Request::Quit);
    }
}

/// Asks to open what is dropped on the window.
fn take_dropped_files(
    mut files: MessageReader<FileDragAndDrop>,
    mut desk: ResMut<Desk>,
    mut requests: ResMut<Requests>,
) {
    for file in files.read() {
        desk.file_hovers = matches!(file, FileDragAndDrop::HoveredFile { .. });
        if let FileDragAndDrop::DroppedFile { path_buf, .. } = file {
            requests
                .0
                .push(Request::Open(path_buf.display().to_string()));
        }
    }
}
