//! Walls in the words of LIGGGHTS 3.8.
//!
//! In: the walls of a world. Out: their lines in an input script, and meshes of those that turn or
//! move: walls at rest along the axes are primitives. The parts of a mesh are one mesh there, whose
//! edges the program tells apart itself.

use super::atom_types::AtomTypes;
use super::deck::{wall_name, words};
use super::liggghts_model::ContactModel;
use super::wall_mesh::WallMesh;
use crate::world::{MeshWall, Shape, Surface, Wall, World};
use glam::DVec3;
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Flat facets of a rim that turns.
pub const FACETS: usize = 360;

/// What the mesh of a container that is one is called.
pub const MESH: &str = "mesh";
/// Angle up to which an edge of a mesh is smooth, as in [`crate::geometry::smooth_parts`] [deg]. The
/// program takes it of meshes with sharper triangles where it is told to be tolerant.
const SMOOTH: f64 = 20.0;

/// The walls of a script.
pub struct Walls {
    /// Their lines.
    pub script: String,
    /// Those that turn or move.
    pub meshes: Vec<WallMesh>,
    /// How far meshes reach from the origin [m].
    pub reach: DVec3,
    /// Velocity of a mesh that moves straight on [m/s].
    pub way: DVec3,
    /// Whether one is a rim.
    pub has_rim: bool,
    /// Endless planes that became squares, with their edges [m].
    pub squares: Vec<(String, f64)>,
}

impl Walls {
    /// The walls of `world`; squares in the place of endless planes reach `half_edge` [m] from
    /// their middles.
    pub fn of(world: &World, types: &AtomTypes, half_edge: f64) -> Self {
        let ContactModel { models, settings } = ContactModel::of(world, false);
        let mut walls = Self {
            script: String::new(),
            meshes: Vec::new(),
            reach: DVec3::ZERO,
            way: DVec3::ZERO,
            has_rim: false,
            squares: Vec::new(),
        };
        let mut meshes = Vec::new();
        meshes.extend(walls.whole_mesh(world, types));
        for (index, wall) in world.container.walls.iter().enumerate() {
            let name = wall_name(wall, index);
            let kind = types.of_wall(wall.material);
            if let Some(primitive) = primitive(wall) {
                let _ = writeln!(
                    walls.script,
                    "fix {name} all wall/gran {models} primitive type {kind} {primitive}{settings}"
                );
            } else if let Some(mesh) = walls.mesh(world, wall, &name, half_edge) {
                let belt = belt(wall);
                let _ = writeln!(
                    walls.script,
                    "fix {name} all mesh/surface file {name}.stl type {kind} curvature 2{belt}"
                );
                walls.turn(wall, &name);
                walls.meshes.push(mesh);
                meshes.push(name);
            }
        }
        if !meshes.is_empty() {
            let _ = writeln!(
                walls.script,
                "fix walls all wall/gran {models} mesh n_meshes {} meshes {}{settings}",
                meshes.len(),
                meshes.join(" ")
            );
        }
        walls
    }

    /// The mesh of a wall.
    fn mesh(&mut self, world: &World, wall: &Wall, name: &str, half_edge: f64) -> Option<WallMesh> {
        let mesh = match wall.surface {
            Surface::Cylinder { radius } => {
                let half_width = half_width(world) * 1.001;
                self.has_rim = true;
                WallMesh::rim(name, radius, half_width, FACETS)
            }
            Surface::Plane { point, normal } if wall.motion.spin != DVec3::ZERO => {
                // A plate that turns with a rim: a square round it.
                let radius = rim_radius(world).unwrap_or(half_edge);
                WallMesh::square(name, point, normal, 1.01 * radius)
            }
            Surface::Plane { point, normal } => {
                self.squares.push((wall.name.clone(), 2.0 * half_edge));
                WallMesh::square(name, point, normal, half_edge)
            }
            Surface::Tube { .. } | Surface::Mesh(_) => return None,
        };
        let turns = wall.motion.spin != DVec3::ZERO;
        for corner in mesh.triangles().iter().flatten() {
            let mut far = corner.abs();
            if turns {
                let from_axis = far.x.hypot(far.y);
                (far.x, far.y) = (from_axis, from_axis);
            }
            self.reach = self.reach.max(1.01 * far);
        }
        Some(mesh)
    }

    /// Adds the mesh that the container is, where it is one, as it stands now; says what it is
    /// called.
    fn whole_mesh(&mut self, world: &World, types: &AtomTypes) -> Option<String> {
        let first = world.container.walls.first()?;
        let pose = first.mesh()?.pose();
        let parts = world.container.walls.iter().filter_map(Wall::mesh);
        let triangles: Vec<_> = parts.flat_map(MeshWall::triangles).collect();
        let corners = || triangles.iter().flatten();
        let name = MESH.to_owned();
        let kind = types.of_wall(first.material);
        let _ = writeln!(
            self.script,
            "fix {name} all mesh/surface file {name}.stl type {kind} curvature {SMOOTH} curvature_tolerant yes"
        );
        let (spin, velocity) = (first.motion.spin, first.motion.velocity);
        let far = if let Some((through, axis)) = pose.axis().filter(|_| spin != DVec3::ZERO) {
            let _ = writeln!(
                self.script,
                "fix turn_{name} all move/mesh mesh {name} rotate origin {} axis {} period {:e}",
                words(through),
                words(spin.normalize()),
                2.0 * PI / spin.length()
            );
            let from_axis = |x: &DVec3| axis.cross(*x - through).length();
            let along = |x: &DVec3| (*x - through).length();
            let most = corners().map(|x| from_axis(x).max(along(x)));
            through.abs() + most.fold(0.0, f64::max)
        } else {
            if velocity != DVec3::ZERO {
                self.way = velocity;
                let _ = writeln!(
                    self.script,
                    "fix move_{name} all move/mesh mesh {name} linear {}",
                    words(velocity)
                );
            }
            corners().fold(DVec3::ZERO, |far, x| far.max(x.abs()))
        };
        self.reach = self.reach.max(1.01 * far);
        let mesh = WallMesh::of_triangles(&name, triangles);
        self.meshes.push(mesh);
        Some(name)
    }

    /// Lets the mesh of `wall` turn.
    fn turn(&mut self, wall: &Wall, name: &str) {
        let spin = wall.motion.spin;
        if spin == DVec3::ZERO {
            return;
        }
        let _ = writeln!(
            self.script,
            "fix turn_{name} all move/mesh mesh {name} rotate origin 0 0 0 axis {} period {:e}",
            words(spin.normalize()),
            2.0 * PI / spin.length()
        );
    }
}

/// A wall at rest along the axes, as scripts have it.
fn primitive(wall: &Wall) -> Option<String> {
    if wall.motion.spin != DVec3::ZERO || wall.motion.velocity != DVec3::ZERO {
        return None;
    }
    match wall.surface {
        Surface::Cylinder { radius } => Some(format!("zcylinder {radius:e} 0 0")),
        Surface::Plane { point, normal } => {
            let axes = [
                ("xplane", DVec3::X),
                ("yplane", DVec3::Y),
                ("zplane", DVec3::Z),
            ];
            let found = axes.into_iter().find(|(_, axis)| normal.abs() == *axis);
            found.map(|(word, axis)| format!("{word} {:e}", point.dot(axis)))
        }
        Surface::Tube { .. } | Surface::Mesh(_) => None,
    }
}

/// The words for a surface that moves along itself, as a belt does.
fn belt(wall: &Wall) -> String {
    if wall.motion.velocity == DVec3::ZERO {
        return String::new();
    }
    format!(" surface_vel {}", words(wall.motion.velocity))
}

/// Radius of the drum's rim [m], where there is one.
pub fn rim_radius(world: &World) -> Option<f64> {
    let mut walls = world.container.walls.iter();
    walls.find_map(|wall| match wall.surface {
        Surface::Cylinder { radius } => Some(radius),
        _ => None,
    })
}

fn half_width(world: &World) -> f64 {
    match world.container.shape {
        Shape::Drum { width, .. } => 0.5 * width,
        _ => 1.0,
    }
}
