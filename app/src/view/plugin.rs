//! The view as a Bevy plugin: what is set up, and what runs in which order.
//!
//! In: Bevy's app. Out: its systems.

use crate::view::camera::OrbitCamera;
use crate::view::second_picture::SecondPicture;
use crate::view::shown_worlds::{ShownWorlds, ViewSystems, free, take_newest};
use crate::view::view_settings::ViewSettings;
use crate::view::{
    container_walls, ghosts, grain_buffer, links, polyhedron_meshes, rig, second_rig, spheres,
    trace,
};
use bevy::asset::{load_internal_asset, uuid_handle};
use bevy::camera::CameraUpdateSystems;
use bevy::prelude::*;
use bevy_egui::EguiPostUpdateSet;

const LIGHT: Handle<Shader> = uuid_handle!("0b7c4df4-9d2e-4b0d-93b4-0e3f5a1c7a10");

/// Draws the world of [`ShownWorlds`] as [`ViewSettings`] and [`OrbitCamera`] say.
pub struct ViewPlugin;

impl Plugin for ViewPlugin {
    fn build(&self, app: &mut App) {
        load_internal_asset!(
            app,
            LIGHT,
            "../../assets/shaders/light.wgsl",
            Shader::from_wgsl
        );
        app.init_resource::<ViewSettings>()
            .init_resource::<OrbitCamera>()
            .init_resource::<SecondPicture>()
            .init_resource::<rig::Framed>()
            .init_resource::<ShownWorlds>()
            .configure_sets(
                Update,
                (ViewSystems::Take, ViewSystems::Fill, ViewSystems::Draw).chain(),
            )
            .add_plugins((
                grain_buffer::plugin,
                spheres::plugin,
                polyhedron_meshes::plugin,
                container_walls::plugin,
                links::plugin,
                ghosts::plugin,
            ))
            .add_systems(Startup, (rig::look_for_no_lamps, rig::spawn))
            .add_systems(
                Update,
                (take_newest, (trace::follow, trace::measure))
                    .chain()
                    .in_set(ViewSystems::Take),
            )
            .add_systems(Last, free)
            .add_systems(Update, second_rig::follow_window.after(ViewSystems::Draw))
            .add_systems(
                PostUpdate,
                (rig::steer, rig::follow, second_rig::follow)
                    .chain()
                    .after(EguiPostUpdateSet::EndPass)
                    .before(CameraUpdateSystems)
                    .before(TransformSystems::Propagate),
            );
    }
}
