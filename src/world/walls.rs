//! The walls of a scene.
//!
//! In: a checked scene. Out: its container at time zero.

use super::{Container, MeshPose, MeshWall, Shape, Surface, Wall, WallMotion};
use crate::geometry::MeshPart;
use crate::physics::MaterialId;
use crate::scene::{MeshMotion, Scene, SceneContainer, SceneMesh, ScenePlane, SceneTube};
use glam::DVec3;

/// The index of the material called `name`.
pub fn material_id(scene: &Scene, name: &str) -> MaterialId {
    let index = scene.material(name).map_or(0, |(index, _)| index);
    MaterialId(index as u16)
}

/// The walls of `scene` and the shape that they make, as they stand at time zero.
pub fn container(scene: &Scene) -> Container {
    let (shape, walls) = match &scene.container {
        SceneContainer::Nothing => (Shape::Planes, Vec::new()),
        SceneContainer::Drum {
            radius,
            width,
            speed,
            material,
        } => (
            Shape::Drum {
                radius: *radius,
                width: *width,
            },
            drum_walls(*radius, *width, *speed, material_id(scene, material)),
        ),
        SceneContainer::Box { min, max, material } => (
            Shape::Box {
                min: *min,
                max: *max,
            },
            box_walls(*min, *max, material_id(scene, material)),
        ),
        SceneContainer::Column {
            radius,
            height,
            material,
            tube,
        } => (
            Shape::Column {
                radius: *radius,
                height: *height,
            },
            column_walls(scene, *radius, material, tube.as_ref()),
        ),
        SceneContainer::Mesh {
            surface,
            material,
            motion,
            ..
        } => {
            let (min, max) = surface.bounds();
            let material = material_id(scene, material);
            (
                Shape::Mesh { min, max },
                mesh_walls(surface, *motion, material),
            )
        }
        SceneContainer::Planes(planes) => (
            Shape::Planes,
            planes.iter().map(|plane| wall(scene, plane)).collect(),
        ),
    };
    Container {
        shape,
        walls,
        angle: 0.0,
    }
}

/// Rim, back plate and front plate, turning as one body.
fn drum_walls(radius: f64, width: f64, speed: f64, material: MaterialId) -> Vec<Wall> {
    let plate = |normal: DVec3| Surface::Plane {
        point: -0.5 * width * normal,
        normal,
    };
    [
        ("rim", Surface::Cylinder { radius }),
        ("back plate", plate(DVec3::Z)),
        ("front plate", plate(DVec3::NEG_Z)),
    ]
    .map(|(name, surface)| Wall {
        name: name.to_owned(),
        surface,
        material,
        motion: WallMotion {
            velocity: DVec3::ZERO,
            spin: DVec3::new(0.0, 0.0, speed),
        },
    })
    .into()
}

/// The floor and, where there is one, the tube that stands on it and rises.
fn column_walls(scene: &Scene, radius: f64, floor: &str, tube: Option<&SceneTube>) -> Vec<Wall> {
    let floor = Wall {
        name: "floor".to_owned(),
        surface: Surface::Plane {
            point: DVec3::ZERO,
            normal: DVec3::Y,
        },
        material: material_id(scene, floor),
        motion: WallMotion::default(),
    };
    let tube = tube.map(|tube| Wall {
        name: "tube".to_owned(),
        surface: Surface::Tube {
            radius,
            rim: tube.rim,
        },
        material: material_id(scene, &tube.material),
        motion: WallMotion {
            velocity: tube.speed * DVec3::Y,
            spin: DVec3::ZERO,
        },
    });
    [floor].into_iter().chain(tube).collect()
}

fn box_walls(min: DVec3, max: DVec3, material: MaterialId) -> Vec<Wall> {
    [
        ("left", min, DVec3::X),
        ("right", max, DVec3::NEG_X),
        ("floor", min, DVec3::Y),
        ("ceiling", max, DVec3::NEG_Y),
        ("back", min, DVec3::Z),
        ("front", max, DVec3::NEG_Z),
    ]
    .map(|(name, point, normal)| Wall {
        name: name.to_owned(),
        surface: Surface::Plane { point, normal },
        material,
        motion: WallMotion::default(),
    })
    .into()
}

/// A wall for each smooth part of a mesh, moving as one body.
fn mesh_walls(surface: &SceneMesh, motion: MeshMotion, material: MaterialId) -> Vec<Wall> {
    let pose = match motion {
        MeshMotion::Turning { through, axis, .. } => MeshPose::about(through, axis),
        MeshMotion::Fixed | MeshMotion::Moving { .. } => MeshPose::resting(),
    };
    let parts = surface.parts();
    let wall = |(index, part): (usize, &MeshPart)| {
        let mesh = MeshWall::new(part.clone(), pose);
        let motion = match motion {
            MeshMotion::Fixed => WallMotion::default(),
            MeshMotion::Turning { speed, .. } => mesh.turning(speed),
            MeshMotion::Moving { velocity } => WallMotion {
                velocity,
                spin: DVec3::ZERO,
            },
        };
        Wall {
            name: match parts.len() {
                1 => "mesh".to_owned(),
                _ => format!("mesh {}", index + 1),
            },
            surface: Surface::Mesh(mesh),
            material,
            motion,
        }
    };
    parts.iter().enumerate().map(wall).collect()
}

fn wall(scene: &Scene, plane: &ScenePlane) -> Wall {
    Wall {
        name: plane.name.clone(),
        surface: Surface::Plane {
            point: plane.point,
            normal: plane.normal,
        },
        material: material_id(scene, &plane.material),
        motion: WallMotion {
            velocity: plane.velocity,
            spin: DVec3::ZERO,
        },
    }
}
