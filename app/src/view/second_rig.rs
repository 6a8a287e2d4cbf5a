//! The cameras of the second picture, which follow the window's.
//!
//! In: what the window shows, how the second picture is to look. Out: cameras that draw while it is
//! wanted, and rest else.

use crate::simulation::DrawnIn;
use crate::view::camera::OrbitCamera;
use crate::view::rig::{Framed, Placed, place, world_camera};
use crate::view::second_picture::{SecondOverlay, SecondPicture};
use crate::view::shown_worlds::ShownWorlds;
use crate::view::view_settings::ViewSettings;
use bevy::prelude::*;
use grainfall::lab::Half;

/// Marks the cameras that show the worlds in the second picture.
#[derive(Component)]
pub struct SecondCamera;

/// Every camera of the second picture, that of its panels among them.
pub type OfSecondPicture = Or<(With<SecondCamera>, With<SecondOverlay>)>;

/// The camera of the second picture in `half`, which draws nothing yet.
pub fn second_camera(half: Half) -> impl Bundle {
    (SecondCamera, world_camera(half, false), Msaa::Sample4)
}

/// Takes over what the window shows.
pub(super) fn follow_window(
    mut second: ResMut<SecondPicture>,
    (settings, camera): (Res<ViewSettings>, Res<OrbitCamera>),
    framed: Res<Framed>,
) {
    let Some(look) = second.look().copied() else {
        return;
    };
    let own = &second.settings;
    let has_marks = look.has_marks || look.has_panels;
    second.settings = ViewSettings {
        free_rect: own.free_rect,
        margin: own.margin,
        margin_is_free: own.margin_is_free,
        pixels_per_point: own.pixels_per_point,
        show_overlay: has_marks && settings.show_overlay,
        show_measured: has_marks && settings.show_measured,
        lit_by_plot: None,
        lit_by_picture: None,
        ..settings.clone()
    };
    let shape = second.camera.viewport;
    second.camera = camera.clone();
    second.camera.reshape(shape, framed.outline());
}

/// Moves the cameras to where the second picture is seen from, and lets them draw while it is
/// wanted.
pub(super) fn follow(
    mut second: ResMut<SecondPicture>,
    shown: Res<ShownWorlds>,
    mut cameras: Query<Placed, With<SecondCamera>>,
    mut overlays: Query<&mut Camera, (With<SecondOverlay>, Without<SecondCamera>)>,
) {
    let look = second.look().copied();
    for mut overlay in &mut overlays {
        overlay.is_active = look.is_some();
    }
    let count = if shown.is_pair() { 2 } else { 1 };
    let SecondPicture {
        settings, camera, ..
    } = &mut *second;
    for (&DrawnIn(half), mut own, transform, projection) in &mut cameras {
        own.is_active = look.is_some();
        if let Some(look) = look {
            let placed = (half, own, transform, projection);
            place(placed, count, (&*settings, look.ground), camera, true);
        }
    }
}
