//! The way of the selected grain through the picture.
//!
//! In: the world shown, which grain is selected. Out: its places in order of time, in the view's settings.

use super::{Shown, ViewSettings};
use bevy::prelude::*;

/// Places kept: at sixty a second, a minute.
const LONGEST: usize = 3600;

/// Adds the place of the selected grain. Places after the moment shown are forgotten: the run may take another way.
pub(super) fn follow(
    shown: Res<Shown>,
    mut settings: ResMut<ViewSettings>,
    mut last: Local<Option<usize>>,
) {
    let selected = settings.selected.filter(|_| settings.show_trail);
    let another = *last != selected;
    let moved = shown.is_changed() && selected.is_some();
    if !another && !moved {
        return;
    }
    *last = selected;
    if another {
        settings.trail.clear();
    }
    let (Some(world), Some(grain)) = (shown.world(), selected) else {
        return;
    };
    let Some(place) = world.grains.position.get(grain) else {
        settings.trail.clear();
        return;
    };
    let time = world.time();
    settings.trail.retain(|(then, _)| *then < time);
    if settings.trail.len() >= LONGEST {
        settings.trail.remove(0);
    }
    settings.trail.push((time, place.as_vec3()));
}
