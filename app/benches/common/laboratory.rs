//! The whole window as benches drive it: no window system, with a graphics device or without one.

use bevy::camera::ClearColorConfig;
use bevy::camera::visibility::RenderLayers;
use bevy::math::UVec2;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::settings::WgpuSettings;
use bevy_egui::{EguiGlobalSettings, EguiPlugin, PrimaryEguiContext};
use grainfall::lab::{Options, Status};
use grainfall::scene::Scene;
use grainfall_app::simulation::{Simulation, SimulationPlugin};
use grainfall_app::ui::UiPlugin;
use grainfall_app::view::{GrainBuffer, Meshing, ViewPlugin};
use grainfall_app::window::canvas::{CanvasPlugin, make_ready, offscreen_plugins};
use grainfall_app::window::one_by_one::OneByOnePlugin;

/// An app without a window; `draws` on a graphics device, or has none.
pub fn app(draws: bool) -> App {
    let mut app = App::new();
    let plugins = offscreen_plugins().disable::<bevy::log::LogPlugin>();
    if draws {
        app.add_plugins(plugins);
    } else {
        let settings = WgpuSettings {
            backends: None,
            ..default()
        };
        app.add_plugins(plugins.set(RenderPlugin {
            render_creation: settings.into(),
            ..default()
        }));
    }
    app
}

/// Adds simulation, view and panels to `app`, in the size in which a window opens, with a run of
/// `scene`.
pub fn add(app: &mut App, scene: Scene, options: Options) {
    app.add_plugins(EguiPlugin::default())
        .insert_resource(EguiGlobalSettings {
            auto_create_primary_context: false,
            ..default()
        })
        .add_plugins((
            CanvasPlugin(UVec2::new(1440, 860)),
            SimulationPlugin,
            ViewPlugin,
            UiPlugin {
                options: options.clone(),
            },
            OneByOnePlugin,
        ))
        .insert_resource(Simulation::open(scene, options));
    app.world_mut().spawn((
        PrimaryEguiContext,
        Camera2d,
        RenderLayers::none(),
        Camera {
            order: 2,
            clear_color: ClearColorConfig::Custom(Color::NONE),
            ..default()
        },
    ));
    make_ready(app);
}

/// Updates `app` until its run stands at time zero and all of it is shown.
pub fn prepare(app: &mut App) {
    let is_ready = |app: &App| {
        let standing = *app.world().resource::<Simulation>().status() == Status::Paused;
        let (meshing, grains) = (
            app.world().resource::<Meshing>(),
            app.world().resource::<GrainBuffer>(),
        );
        standing && meshing.is_whole() && grains.is_whole()
    };
    while !is_ready(app) {
        app.update();
    }
}
