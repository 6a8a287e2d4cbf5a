//! Which grain a point of the picture shows.
//!
//! In: the world shown, the camera, what is cut away, a point of the picture. Out: the nearest
//! grain on the ray of sight. A polyhedron counts as the solid between the planes of its faces, a
//! little larger than its rounded self at edges.

use crate::view::camera::OrbitCamera;
use crate::view::grain_buffer::polyhedron;
use crate::view::view_settings::{Cut, ProjectionKind, ViewSettings};
use bevy::math::Vec2;
use glam::{DQuat, DVec3};
use grainfall::world::{Polyhedron, World};

/// A ray of sight.
#[derive(Clone, Copy, Debug)]
struct Ray {
    origin: DVec3,
    /// A unit vector.
    direction: DVec3,
}

/// Where a ray enters and leaves something: distances along it [m].
type Chord = (f64, f64);

/// The grain of `world` at the point `at` of the picture, counted from its upper left corner.
pub(super) fn pick(
    world: &World,
    camera: &OrbitCamera,
    settings: &ViewSettings,
    at: Vec2,
) -> Option<usize> {
    let ray = Ray::through(camera, at);
    let hidden = settings.cut.and_then(|cut| ray.within(cut));
    let size = f64::from(settings.grain_size);
    let hits = (0..world.grains.len()).filter_map(|i| {
        let chord = ray.grain(world, i, size)?;
        Some((i, first_seen(chord, hidden)?))
    });
    let nearest = hits.min_by(|(_, a), (_, b)| a.total_cmp(b));
    nearest.map(|(i, _)| i)
}

/// The place [m] that the point `at` of the picture shows in the plane through the camera's focus
/// that faces the viewer.
pub(super) fn point_in_focus(camera: &OrbitCamera, at: Vec2) -> DVec3 {
    let from_middle = (at - camera.viewport / 2.0) * camera.metres_per_point();
    let across = bevy::math::Vec3::new(from_middle.x, -from_middle.y, 0.0);
    (camera.focus + camera.rotation() * across).as_dvec3()
}

/// The first point of `chord` that is not `hidden`.
fn first_seen((enter, leave): Chord, hidden: Option<Chord>) -> Option<f64> {
    match hidden {
        Some((from, to)) if (from..=to).contains(&enter) => (to < leave).then_some(to),
        _ => Some(enter),
    }
}

impl Ray {
    fn through(camera: &OrbitCamera, at: Vec2) -> Self {
        let point = point_in_focus(camera, at);
        let eye = camera.eye().as_dvec3();
        match camera.projection {
            ProjectionKind::Perspective => Self {
                origin: eye,
                direction: (point - eye).normalize(),
            },
            ProjectionKind::Orthographic => {
                let towards = camera.focus.as_dvec3() - eye;
                Self {
                    origin: point - towards,
                    direction: towards.normalize(),
                }
            }
        }
    }

    /// The part of the ray in what `cut` takes away.
    fn within(&self, cut: Cut) -> Option<Chord> {
        let planes: Vec<(DVec3, f64)> = match cut {
            Cut::Beyond { axis, position } => vec![(axis.unit(), position)],
            Cut::Quarter { x, z } => vec![(DVec3::X, x), (DVec3::Z, z)],
        };
        // Beyond a plane is below the same plane turned round.
        self.below(planes.into_iter().map(|(normal, at)| (-normal, -at)))
    }

    /// The part of the ray below all planes (normal, distance from the origin).
    fn below(&self, planes: impl Iterator<Item = (DVec3, f64)>) -> Option<Chord> {
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for (normal, at) in planes {
            let (height, climb) = (normal.dot(self.origin) - at, normal.dot(self.direction));
            if climb < 0.0 {
                enter = enter.max(-height / climb);
            } else if climb > 0.0 {
                leave = leave.min(-height / climb);
            } else if height > 0.0 {
                return None;
            }
        }
        (enter < leave).then_some((enter, leave))
    }

    fn sphere(&self, centre: DVec3, radius: f64) -> Option<Chord> {
        let away = self.origin - centre;
        let middle = -away.dot(self.direction);
        let square = radius * radius - (away + middle * self.direction).length_squared();
        (square > 0.0 && middle > 0.0).then(|| (middle - square.sqrt(), middle + square.sqrt()))
    }

    fn grain(&self, world: &World, i: usize, size: f64) -> Option<Chord> {
        let (centre, radius) = (world.grains.position[i], size * world.grains.radius[i]);
        let chord = self.sphere(centre, radius)?;
        match (&world.polyhedra, polyhedron(world.polyhedra.as_deref(), i)) {
            (Some(polyhedra), Some(shape)) => {
                self.polyhedron(centre, polyhedra.orientation[i], shape, size)
            }
            _ => Some(chord),
        }
    }

    fn polyhedron(
        &self,
        centre: DVec3,
        turn: DQuat,
        shape: &Polyhedron,
        size: f64,
    ) -> Option<Chord> {
        let back = turn.conjugate();
        let own = Self {
            origin: back * (self.origin - centre),
            direction: back * self.direction,
        };
        let plane = |face: &Vec<u16>| {
            let vertex = |k: usize| shape.vertices[usize::from(face[k % face.len()])];
            let area: DVec3 = (0..face.len())
                .map(|k| vertex(k).cross(vertex(k + 1)))
                .sum();
            let normal = area.normalize_or_zero();
            (normal, size * (normal.dot(vertex(0)) + shape.rounding))
        };
        own.below(shape.faces.iter().map(plane))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::CoordinateAxis;
    use crate::view::test_worlds::grains_in_a_row;

    /// Three spheres of radius 1 mm behind each other along z, the first nearest to the viewer.
    fn behind_each_other() -> World {
        let mut world = grains_in_a_row(3);
        for (i, x) in world.grains.position.iter_mut().enumerate() {
            *x = DVec3::new(0.0, 0.0, -0.004 * i as f64);
        }
        world.grains.radius.fill(1e-3);
        world
    }

    fn camera(projection: ProjectionKind) -> OrbitCamera {
        let mut camera = OrbitCamera::default();
        (camera.yaw, camera.pitch, camera.height) = (0.0, 0.0, 0.02);
        camera.projection = projection;
        camera.viewport = Vec2::new(400.0, 200.0);
        camera
    }

    #[test]
    fn the_nearest_grain_that_is_not_cut_away_is_picked() {
        let world = behind_each_other();
        let beyond = |position| {
            Some(Cut::Beyond {
                axis: CoordinateAxis::Z,
                position,
            })
        };
        for projection in [ProjectionKind::Perspective, ProjectionKind::Orthographic] {
            let camera = camera(projection);
            let mut settings = ViewSettings::default();
            let at = |x: f32, settings: &ViewSettings| {
                pick(&world, &camera, settings, Vec2::new(200.0 + x, 100.0))
            };
            assert_eq!(at(0.0, &settings), Some(0));
            // A radius is ten points.
            assert_eq!(at(9.5, &settings), Some(0));
            assert_eq!(at(30.0, &settings), None);
            settings.cut = beyond(0.0);
            assert_eq!(at(0.0, &settings), Some(0), "its section");
            settings.cut = beyond(-0.002);
            assert_eq!(at(0.0, &settings), Some(1));
            settings.cut = beyond(-1.0);
            assert_eq!(at(0.0, &settings), None);
            settings.cut = Some(Cut::Quarter {
                x: -0.01,
                z: -0.002,
            });
            assert_eq!(at(0.0, &settings), Some(1));
            settings.cut = None;
            settings.grain_size = 0.5;
            assert_eq!(at(8.0, &settings), None);
        }
    }

    #[test]
    fn a_place_in_the_picture_shows_the_grain_that_lands_there() {
        let world = grains_in_a_row(30);
        let mut camera = camera(ProjectionKind::Perspective);
        (camera.yaw, camera.pitch, camera.height) = (0.4, 0.3, 0.3);
        camera.focus = world.grains.position[12].as_vec3();
        for i in 8..16 {
            let (at, _) = camera.project(world.grains.position[i].as_vec3()).unwrap();
            let found = pick(&world, &camera, &ViewSettings::default(), at);
            assert_eq!(found, Some(i));
        }
    }
}
