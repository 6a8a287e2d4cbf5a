//! A second picture of the same worlds, off screen: of any size, whatever the window is.
//!
//! In: how it is to look, and the window's settings and camera, which it follows. Out: settings and
//! a camera of its own, by which marks are drawn into it. Its cameras are the second rig's business, the
//! image that they draw into is the window's.

use crate::view::camera::OrbitCamera;
use crate::view::cut_out::Ground;
use crate::view::view_settings::ViewSettings;
use bevy::math::UVec2;
use bevy::prelude::*;

/// How the second picture is to look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondLook {
    /// Width and height [pixels].
    pub size: UVec2,
    /// What is behind the grains.
    pub ground: Ground,
    /// Whether scale bar, clock, legend and what is measured are written into it.
    pub has_marks: bool,
    /// Whether panels stand round it.
    pub has_panels: bool,
    /// Pixels of a point of text; as suits a window of this size where none are given.
    pub pixels_per_point: Option<f32>,
}

/// The second picture.
#[derive(Resource, Default)]
pub struct SecondPicture {
    look: Option<SecondLook>,
    /// As the window's, but for what belongs to a picture of its size.
    pub settings: ViewSettings,
    /// Where it is seen from: as the window's picture, in its own shape.
    pub camera: OrbitCamera,
}

/// Marks the camera that writes into the second picture.
#[derive(Component)]
pub struct SecondOverlay;

impl SecondPicture {
    /// How it looks, while it is drawn.
    pub fn look(&self) -> Option<&SecondLook> {
        self.look.as_ref()
    }

    /// Draws it from now on, or no longer.
    pub fn draw(&mut self, look: Option<SecondLook>) {
        if look.is_some() && look != self.look {
            (self.settings.free_rect, self.settings.margin) = (None, 0.0);
            self.settings.pixels_per_point = 1.0;
        }
        self.look = look;
    }
}
