//! The panels as Bevy plugins: when they are drawn, and when what they ask for is fulfilled.
//!
//! In: Bevy's app. Out: its systems. What is drawn is the dock's business, what a request does is
//! `dispatch`'s.

use crate::simulation::Simulation;
use crate::ui::bars::film_bar::film_bar_ui;
use crate::ui::captions::captions;
use crate::ui::dispatch::fulfil_requests;
use crate::ui::dock::Dock;
use crate::ui::opener::{OpenWith, Opening, finish_opening};
use crate::ui::request::{Request, Requests};
use crate::ui::screenshot_orders::{FilmState, ScreenshotOrders};
use crate::ui::second_pass::{SecondPicturePass, draw_second_picture};
use crate::ui::{keyboard, pointer, theme};
use crate::view::{OrbitCamera, ViewSettings, viewport_ui};
use bevy::asset::AssetEventSystems;
use bevy::prelude::*;
use bevy::window::{FileDragAndDrop, PrimaryWindow, WindowCloseRequested, WindowMode};
use bevy_egui::{
    EguiContexts, EguiPostUpdateSet, EguiPreUpdateSet, EguiPrimaryContextPass, PrimaryEguiContext,
    egui,
};
use grainfall::lab::{Options, Status};

/// Draws the panels and fulfils what they ask for. Needs Bevy's default plugins, `EguiPlugin` and
/// the view's plugin.
#[derive(Clone, Debug, Default)]
pub struct UiPlugin {
    /// How scenes are opened.
    pub options: Options,
}

impl Plugin for UiPlugin {
    fn build(&self, app: &mut App) {
        let options = self.options.clone();
        app.add_plugins(DockPlugin { options })
            .add_systems(EguiPrimaryContextPass, (install_theme, draw_panels).chain())
            .add_systems(SecondPicturePass, draw_second_picture)
            .add_systems(Update, follow_full_screen)
            .add_systems(
                PreUpdate,
                (keyboard::tell_modifiers, pointer::end_drags_where_they_end)
                    .chain()
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
pub struct DockPlugin {
    /// How scenes are opened.
    pub options: Options,
}

impl Plugin for DockPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(OpenWith(self.options.clone()))
            .init_resource::<Requests>()
            .init_resource::<Opening>()
            .init_resource::<Dock>()
            .init_resource::<ScreenshotOrders>()
            .init_resource::<ViewSettings>()
            .add_message::<FileDragAndDrop>()
            .add_message::<WindowCloseRequested>()
            .add_systems(
                Update,
                (
                    take_dropped_files,
                    ask_before_closing,
                    fulfil_requests,
                    finish_opening,
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

/// Draws everything round the picture, writes into the picture, and lets the pointer over the rest
/// move the camera.
fn draw_panels(
    mut contexts: EguiContexts,
    mut dock: ResMut<Dock>,
    mut view: ResMut<ViewSettings>,
    mut camera: ResMut<OrbitCamera>,
    mut requests: ResMut<Requests>,
    (orders, simulation): (Res<ScreenshotOrders>, Option<Res<Simulation>>),
    window: Option<Single<&Camera, With<PrimaryEguiContext>>>,
) -> Result {
    let size = window.and_then(|camera| camera.logical_target_size());
    dock.window = size.map(|size| egui::vec2(size.x, size.y));
    let ctx = contexts.ctx_mut()?.clone();
    let builder = egui::UiBuilder::new()
        .layer_id(egui::LayerId::background())
        .max_rect(ctx.viewport_rect());
    let mut root = egui::Ui::new(ctx, "root".into(), builder);
    let simulation = simulation.as_deref();
    if !dock.is_hidden {
        dock.is_photographed = orders.is_taking || !orders.asked.is_empty();
        dock.ui(&mut root, simulation, &mut view, &mut requests.0);
        let stands_still = simulation.is_some_and(|run| *run.status() == Status::Paused);
        film_bar_ui(&mut root, orders.film, stands_still, &mut requests.0);
    }
    // A film runs at its own speed, however long its pictures take.
    let is_filmed = orders.film != FilmState::Idle;
    let has_clock = !dock.shows_time();
    let factor = simulation
        .filter(|_| !is_filmed)
        .map_or(0.0, |run| run.real_time_factor());
    let mut captions = captions(simulation, has_clock, factor);
    for caption in &mut captions {
        caption.is_for_afar = dock.is_presenting && !dock.is_hidden;
    }
    viewport_ui(&mut root, &captions, &mut view, &mut camera);
    if !dock.is_hidden {
        dock.over_picture_ui(&root, simulation);
    }
    Ok(())
}

/// Lets the window fill the screen, or not, where that was asked for.
fn follow_full_screen(
    dock: Res<Dock>,
    mut was: Local<bool>,
    window: Option<Single<&mut Window, With<PrimaryWindow>>>,
) {
    if let Some(mut window) = window.filter(|_| dock.is_full_screen != *was) {
        *was = dock.is_full_screen;
        window.mode = if *was {
            WindowMode::BorderlessFullscreen(MonitorSelection::Current)
        } else {
            WindowMode::Windowed
        };
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
    mut dock: ResMut<Dock>,
    mut requests: ResMut<Requests>,
) {
    for file in files.read() {
        dock.file_hovers = matches!(file, FileDragAndDrop::HoveredFile { .. });
        if let FileDragAndDrop::DroppedFile { path_buf, .. } = file {
            requests
                .0
                .push(Request::Open(path_buf.display().to_string()));
        }
    }
}
