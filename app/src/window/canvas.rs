//! Pictures with a window or without one.
//!
//! In: an app whose cameras draw. Out: an image of given size that they draw into
//! ([`CanvasPlugin`]), and the request for a picture of it or of the window. When a picture is
//! taken is not decided here.

use crate::view::OfSecondPicture;
use crate::window::pipelines::Pipelines;
use bevy::app::{PluginGroupBuilder, PluginsState};
use bevy::asset::RenderAssetUsages;
use bevy::camera::RenderTarget;
use bevy::math::UVec2;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::render::settings::{MemoryHints, WgpuSettings};
use bevy::render::view::screenshot::Screenshot;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;

/// Frames to draw before a picture is whole: textures and panels' sizes need a few, pipelines may
/// need more ([`Pipelines`]).
pub const WARM_UP: u32 = 6;

/// Bevy's plugins for drawing where there is no display.
pub fn offscreen_plugins() -> PluginGroupBuilder {
    DefaultPlugins
        .build()
        .disable::<WinitPlugin>()
        .disable::<PipelinedRenderingPlugin>()
        .set(WindowPlugin {
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(renderer(true))
}

/// Blocks in which the renderer takes memory of the graphics device [bytes]. What does not fit has a
/// block of its own, which goes when it goes; of 128 MiB, the default, a film of the window begins
/// another that stays.
const DEVICE_BLOCK: u64 = 8 << 20;

/// The renderer. `waits` where no pipeline may be missing in a picture.
pub fn renderer(waits: bool) -> RenderPlugin {
    let settings = WgpuSettings {
        memory_hints: MemoryHints::Manual {
            suballocated_device_memory_block_size: DEVICE_BLOCK..DEVICE_BLOCK,
        },
        ..default()
    };
    RenderPlugin {
        render_creation: settings.into(),
        synchronous_pipeline_compilation: waits,
        ..default()
    }
}

/// Finishes the plugins of an app that is updated by hand: the graphics device takes a moment.
pub fn make_ready(app: &mut App) {
    while app.plugins_state() == PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    app.finish();
    app.cleanup();
}

/// Lets every camera draw into one image of this size [pixels]; add it after [`offscreen_plugins`].
pub struct CanvasPlugin(pub UVec2);

/// The image that cameras draw into.
#[derive(Resource, Clone)]
pub struct Canvas(Handle<Image>);

impl Canvas {
    /// The image.
    pub fn image(&self) -> &Handle<Image> {
        &self.0
    }
}

impl Plugin for CanvasPlugin {
    fn build(&self, app: &mut App) {
        let image = target_image(self.0);
        let image = app.world_mut().resource_mut::<Assets<Image>>().add(image);
        app.insert_resource(Canvas(image)).add_observer(redirect);
        Pipelines::count_in(app);
    }
}

/// An image of this `size` [pixels] that cameras can draw into and that can be taken a picture of.
pub(super) fn target_image(size: UVec2) -> Image {
    let mut image = Image::new_target_texture(size.x, size.y, TextureFormat::Rgba8UnormSrgb, None);
    image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    image.asset_usage = RenderAssetUsages::default();
    image
}

/// A camera that is added draws into the canvas, but one that has an image of its own.
fn redirect(
    added: On<Add, Camera>,
    canvas: Res<Canvas>,
    second: Query<(), OfSecondPicture>,
    mut commands: Commands,
) {
    if second.contains(added.entity) {
        return;
    }
    commands
        .entity(added.entity)
        .insert(RenderTarget::Image(canvas.0.clone().into()));
}

/// Asks for a picture of the canvas where there is one, of the window otherwise; observe
/// [`ScreenshotCaptured`](bevy::render::view::screenshot::ScreenshotCaptured) on the entity it is
/// spawned on.
pub fn screenshot(canvas: Option<&Canvas>) -> Screenshot {
    canvas.map_or_else(Screenshot::primary_window, |canvas| {
        Screenshot::image(canvas.0.clone())
    })
}
