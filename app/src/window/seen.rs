//! How pictures are seen in the window, which those taken off screen follow.
//!
//! In: what a picture is to show, and its size where one is given. Out: how it is to look.

use crate::ui::PictureOf;
use crate::view::{Ground, SecondLook};
use bevy::math::UVec2;

/// How pictures are seen in the window.
pub(super) struct Seen {
    /// Size of the window, and of the part that panels leave free [pixels].
    pub(super) window: UVec2,
    pub(super) free: UVec2,
    pub(super) pixels_per_point: f32,
}

impl Seen {
    /// A picture of this, of this `size` [pixels], or as it is seen.
    pub(super) fn look(&self, of: PictureOf, size: Option<UVec2>, ground: Ground) -> SecondLook {
        let seen = if of == PictureOf::Window {
            self.window
        } else {
            self.free
        };
        SecondLook {
            size: size.unwrap_or(seen).max(UVec2::ONE),
            ground,
            has_marks: of == PictureOf::Picture,
            has_panels: of == PictureOf::Window,
            pixels_per_point: size.is_none().then_some(self.pixels_per_point),
        }
    }
}
