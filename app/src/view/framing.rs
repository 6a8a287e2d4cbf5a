//! What of a scene a picture should hold.
//!
//! In: a world. Out: the points that must be in view, and lengths that follow from its container.

use crate::view::colour::round_up;
use bevy::math::DVec3;
use bevy::prelude::*;
use grainfall::world::{Shape, Surface, Wall, World};
use std::f32::consts::TAU;

/// Breadth of a drum's hoops in its radius.
pub(super) const HOOP_BREADTH: f32 = 0.045;
/// Grains in flight are kept in the picture for at most this many times the size of the group, so
/// that they stay large enough to see.
const FARTHEST: f64 = 30.0;
/// Grains that fly further than this, in sizes of their group, are so small in a picture of their
/// whole way that one does not see them turn: the picture goes with them instead.
const FAR: f64 = 8.0;
/// Room round a group that the picture goes with, in its size.
const ROOM: f64 = 7.0;
/// Room beside a straight path for grains that swerve, as a share of its length.
const SWERVE: f64 = 0.12;

/// Points that a picture of `world` should hold: its container's, or, where that is unbounded,
/// those of its grains and of their way in the next `watched` seconds, unless the picture is to go
/// with them.
pub fn outline(world: &World, watched: f64) -> Vec<Vec3> {
    match world.container.shape {
        Shape::Drum { radius, width } => {
            let radius = radius as f32 * (1.0 + HOOP_BREADTH);
            let half = width as f32 / 2.0;
            (0..64)
                .flat_map(|i| {
                    let (sin, cos) = (TAU * i as f32 / 64.0).sin_cos();
                    [-half, half].map(|z| Vec3::new(radius * cos, radius * sin, z))
                })
                .collect()
        }
        Shape::Box { min, max } | Shape::Mesh { min, max } => {
            corners(min.as_vec3(), max.as_vec3()).to_vec()
        }
        Shape::Column { radius, height } => column_outline(radius, height),
        Shape::Planes => {
            let around = match group_on_its_way(world, watched) {
                Some((middle, size)) => Some((middle - ROOM * size, middle + ROOM * size)),
                None => surroundings(world, watched),
            };
            around.map_or_else(Vec::new, |(min, max)| {
                corners(min.as_vec3(), max.as_vec3()).to_vec()
            })
        }
    }
}

/// Middle and half size [m] of the grains of `world`, where they slide or roll in the open, together,
/// on a way of which a picture would show them too small.
pub fn group_on_its_way(world: &World, watched: f64) -> Option<(DVec3, f64)> {
    if !matches!(world.container.shape, Shape::Planes) {
        return None;
    }
    let (min, max) = grain_box(world)?;
    let size = 0.5 * (max - min).max_element();
    let velocities = &world.grains.velocity;
    let speeds = velocities.iter().map(|v| v.length());
    // All of them, that is: one that leaves the others is no group with them.
    let slowest = speeds.fold(f64::INFINITY, f64::min);
    let middle = 0.5 * (min + max);
    let along = |normal: DVec3| {
        velocities
            .iter()
            .all(|v| v.dot(normal).abs() < 0.2 * v.length())
    };
    let slides_on = |wall: &Wall| match wall.surface {
        Surface::Plane { point, normal } => {
            (middle - point).dot(normal).abs() < 2.0 * size && along(normal)
        }
        _ => false,
    };
    let goes_far = watched * slowest > 2.0 * FAR * size;
    (goes_far && world.container.walls.iter().any(slides_on)).then_some((middle, size))
}

/// The column as it stands and the floor that it will spread over, with some room for grains that
/// roll on alone.
fn column_outline(radius: f64, height: f64) -> Vec<Vec3> {
    let front = 1.2 * expected_front(radius, height) as f32;
    let circle = |radius: f32, y: f32| {
        (0..64).map(move |i| {
            let (sin, cos) = (TAU * i as f32 / 64.0).sin_cos();
            Vec3::new(radius * cos, y, radius * sin)
        })
    };
    circle(front, 0.0)
        .chain(circle(radius as f32, height as f32))
        .collect()
}

/// Radius to which a column on a floor spreads [m], to a fifth or so: run-out over the radius is
/// `α^1.35` for a height of α radii, and grows with the root of α above 3.5 (after Man et al.
/// 2023).
pub(super) fn expected_front(radius: f64, height: f64) -> f64 {
    let aspect = height / radius;
    let low = aspect.min(3.5);
    radius * (1.0 + low.powf(1.35) * (aspect / low).sqrt())
}

/// Distance between the rings on the floor round a column of this `radius` [m].
pub(super) fn ring_distance(radius: f64) -> f64 {
    round_up(radius / 4.0)
}

/// The box round all grains, their paths in the next `watched` seconds with room to swerve, and the
/// planes below them.
pub(super) fn surroundings(world: &World, watched: f64) -> Option<(DVec3, DVec3)> {
    let (mut min, mut max) = grain_box(world)?;
    let grains = &world.grains;
    let largest = grains.radius.iter().copied().fold(0.0, f64::max);
    let farthest = FARTHEST * (max - min).max_element();
    let mut longest: f64 = 0.0;
    for (position, velocity) in grains.position.iter().zip(&grains.velocity) {
        let way = (watched * *velocity).clamp_length_max(farthest);
        (min, max) = (min.min(position + way), max.max(position + way));
        longest = longest.max(way.length());
    }
    let room = 2.0 * largest + SWERVE * longest;
    let (mut low, mut high) = (min - room, max + room);
    let middle = (min + max) / 2.0;
    let size = (high - low).max_element();
    for wall in &world.container.walls {
        if let Surface::Plane { point, normal } = wall.surface {
            let distance = (middle - point).dot(normal);
            if distance.abs() < 4.0 * size {
                let foot = middle - distance * normal;
                (low, high) = (low.min(foot), high.max(foot));
            }
        }
    }
    Some((low, high))
}

/// The box round all grains.
pub(super) fn grain_box(world: &World) -> Option<(DVec3, DVec3)> {
    let grains = &world.grains;
    let reach = |i: usize| DVec3::splat(grains.radius[i]);
    (!grains.is_empty()).then(|| {
        (0..grains.len()).fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), i| {
            let x = grains.position[i];
            (min.min(x - reach(i)), max.max(x + reach(i)))
        })
    })
}

pub(super) fn corners(min: Vec3, max: Vec3) -> [Vec3; 8] {
    std::array::from_fn(|i| {
        let pick = |axis: usize| {
            if i >> axis & 1 == 0 {
                min[axis]
            } else {
                max[axis]
            }
        };
        Vec3::new(pick(0), pick(1), pick(2))
    })
}
