//! Packing fraction φ of the bed, by one method for every container.
//!
//! The bed is cut by a plane parallel to the surface line, two mean radii below it, and φ is the
//! volume of the grains below the plane over the volume of the container below the plane. Grains
//! that the plane cuts count with the exact volume of their cap (a polyhedron with that of the
//! sphere of its volume), so φ is smooth in time; the loose layer at the surface stays outside. The
//! layers at the walls, where grains pack less densely, are included: in narrow drums φ falls as
//! the grains grow. Volumes shared by overlapping grains count twice (a relative error of about
//! 1e-5 in a bed at rest).

use super::column::volume;
use super::surface::{SurfaceLine, mean_radius};
use crate::world::{Shape, World};
use glam::DVec2;
use std::f64::consts::PI;

/// Depth of the cutting plane below the surface line, in mean radii.
const DEPTH: f64 = 2.0;

/// Packing fraction of the bed of `world` below `surface`; NaN where the container has no inside or
/// the bed is too shallow.
pub fn packing_fraction(world: &World, surface: &SurfaceLine) -> f64 {
    let normal = surface.normal();
    let height = surface.midpoint.dot(normal) - DEPTH * mean_radius(&world.grains);
    let space = container_below(world.container.shape, normal, height);
    if space <= 0.0 {
        return f64::NAN;
    }
    let grains = &world.grains;
    let filled: f64 = grains
        .position
        .iter()
        .enumerate()
        .map(|(i, x)| sphere_below(radius(world, i), height - x.truncate().dot(normal)))
        .sum();
    filled / space
}

/// Radius of grain `i`, of a polyhedron that of the sphere of its volume [m].
fn radius(world: &World, i: usize) -> f64 {
    match world.polyhedra {
        Some(_) => (0.75 / PI * volume(world, i)).cbrt(),
        None => world.grains.radius[i],
    }
}

/// Volume of the part of a sphere of radius `r` that lies below a plane `height` above its centre
/// [m³].
fn sphere_below(r: f64, height: f64) -> f64 {
    let depth = (r + height).clamp(0.0, 2.0 * r);
    PI * depth * depth * (r - depth / 3.0)
}

/// Volume of the container below the plane `normal · x = height` [m³]; NaN for a shape without an
/// inside.
fn container_below(shape: Shape, normal: DVec2, height: f64) -> f64 {
    match shape {
        Shape::Planes | Shape::Column { .. } | Shape::Mesh { .. } => f64::NAN,
        Shape::Drum { radius, width } => width * segment_area(radius, height),
        Shape::Box { min, max } => {
            let corners = [
                DVec2::new(min.x, min.y),
                DVec2::new(max.x, min.y),
                DVec2::new(max.x, max.y),
                DVec2::new(min.x, max.y),
            ];
            (max.z - min.z) * area(&below(&corners, normal, height))
        }
    }
}

/// Area of the part of a disc that lies below a chord at signed distance `height` from its centre
/// [m²].
fn segment_area(radius: f64, height: f64) -> f64 {
    let h = height.clamp(-radius, radius);
    radius * radius * (-h / radius).acos() + h * (radius * radius - h * h).sqrt()
}

/// The part of a convex polygon below the line `normal · x = height`.
fn below(corners: &[DVec2], normal: DVec2, height: f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (above_a, above_b) = (a.dot(normal) - height, b.dot(normal) - height);
        if above_a <= 0.0 {
            kept.push(a);
        }
        if (above_a <= 0.0) != (above_b <= 0.0) {
            kept.push(a.lerp(b, above_a / (above_a - above_b)));
        }
    }
    kept
}

/// Area of a polygon whose corners run anticlockwise [m²].
fn area(corners: &[DVec2]) -> f64 {
    let twice: f64 = corners
        .iter()
        .enumerate()
        .map(|(i, a)| a.perp_dot(corners[(i + 1) % corners.len()]))
        .sum();
    0.5 * twice
}
