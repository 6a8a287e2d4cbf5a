//! The ways of chosen grains through the picture.
//!
//! In: the worlds shown, which grains are traced. Out: their places in order of time, in the view's settings.

use super::{Shown, ViewSettings};
use crate::simulation::Half;
use bevy::prelude::*;
use std::collections::VecDeque;

/// Places kept: at sixty a second, a minute.
const LONGEST: usize = 3600;

/// The way of a grain in one half of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Trail {
    /// Which grain.
    pub grain: usize,
    /// In which half.
    pub half: Half,
    /// Times [s] and places [m], in order of time.
    pub places: VecDeque<(f64, Vec3)>,
}

impl Trail {
    /// Adds where the grain is at `time` [s]. Places after that are forgotten: the run may take another way.
    fn add(&mut self, time: f64, place: Vec3) {
        let kept = self.places.partition_point(|(then, _)| *then < time);
        self.places.truncate(kept);
        if self.places.len() >= LONGEST {
            self.places.pop_front();
        }
        self.places.push_back((time, place));
    }
}

/// Adds the places of the grains that are traced.
pub(super) fn follow(shown: Res<Shown>, mut settings: ResMut<ViewSettings>) {
    let is_traced = |trail: &Trail, traced: &[usize]| {
        shown.half(trail.half).is_some() && traced.contains(&trail.grain)
    };
    let wanted = shown.worlds().count() * settings.traced.len();
    let are_there = settings.trails.len() == wanted
        && (settings.trails.iter()).all(|trail| is_traced(trail, &settings.traced));
    if are_there && (wanted == 0 || !shown.is_changed()) {
        return;
    }
    let ViewSettings { traced, trails, .. } = &mut *settings;
    trails.retain(|trail| is_traced(trail, traced));
    for (half, grain) in Half::ALL
        .into_iter()
        .flat_map(|half| traced.iter().map(move |i| (half, *i)))
    {
        let Some(world) = shown.half(half) else {
            continue;
        };
        let Some(place) = world.grains.position.get(grain) else {
            continue;
        };
        let own = (trails.iter()).position(|trail| (trail.half, trail.grain) == (half, grain));
        let own = own.unwrap_or_else(|| {
            trails.push(Trail {
                grain,
                half,
                places: VecDeque::new(),
            });
            trails.len() - 1
        });
        trails[own].add(world.time(), place.as_vec3());
    }
}
