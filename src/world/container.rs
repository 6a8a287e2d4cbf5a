//! Walls: analytic surfaces, and meshes, that move as rigid bodies.

use super::mesh_wall::MeshWall;
use super::motion::WallMotion;
use crate::lanes::{Lanes, One, dot, minus, plus, splat_vector, times};
use crate::physics::MaterialId;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The walls round the grains and the shape they make together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Container {
    /// What it is, for drawing and for measures.
    pub shape: Shape,
    /// Its surfaces, the partners of the grains.
    pub walls: Vec<Wall>,
    /// Angle through which a drum, or a mesh, has turned since the start [rad].
    pub angle: f64,
}

/// The shape of a container.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Shape {
    /// Nothing but what `walls` lists, each an unbounded plane.
    Planes,
    /// A box along the axes.
    Box {
        /// Lower corner [m].
        min: DVec3,
        /// Upper corner [m].
        max: DVec3,
    },
    /// A drum about the z axis, centred on the origin. Its walls are the rim, the back plate and
    /// the front plate.
    Drum {
        /// Inner radius [m].
        radius: f64,
        /// Inner width along z [m].
        width: f64,
    },
    /// An unbounded floor at y = 0 on which a column about the y axis stands at the start. Its
    /// walls are the floor and, where a tube holds the column, that tube.
    Column {
        /// Radius of the column at the start [m].
        radius: f64,
        /// Its height at the start [m].
        height: f64,
    },
    /// A surface of triangles; each smooth part of it is a wall.
    Mesh {
        /// Lower corner of the box round it at the start [m].
        min: DVec3,
        /// Upper corner [m].
        max: DVec3,
    },
}

/// One wall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wall {
    /// What people call it: `rim`, `front plate`, `floor` …
    pub name: String,
    /// Where it is.
    pub surface: Surface,
    /// What it is made of.
    pub material: MaterialId,
    /// How it moves.
    pub motion: WallMotion,
}

/// Where a wall is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Surface {
    /// An unbounded plane.
    Plane {
        /// Any point of it [m].
        point: DVec3,
        /// Unit normal towards the grains.
        normal: DVec3,
    },
    /// The inside of an unbounded circular cylinder about the z axis.
    Cylinder {
        /// Inner radius [m].
        radius: f64,
    },
    /// A thin upright tube about the y axis, unbounded above; it acts inside, outside and at its
    /// rim.
    Tube {
        /// Radius [m].
        radius: f64,
        /// Height of its lower rim [m].
        rim: f64,
    },
    /// A smooth part of a mesh; both of its sides act.
    Mesh(MeshWall),
}

impl Container {
    /// Drum speed about z [rad/s]; zero of what is no drum.
    pub fn drum_speed(&self) -> f64 {
        match self.shape {
            Shape::Drum { .. } => self.spin().z,
            _ => 0.0,
        }
    }

    /// Angular velocity of a drum or a mesh [rad/s]; zero where nothing turns.
    pub fn spin(&self) -> DVec3 {
        let first = self.walls.first();
        first.map_or(DVec3::ZERO, |wall| wall.motion.spin)
    }

    /// Speed at which a drum turns about z, or a mesh about its own axis [rad/s]; zero where nothing
    /// turns.
    pub fn turning_speed(&self) -> f64 {
        match self.walls.first().map(|wall| &wall.surface) {
            Some(Surface::Mesh(mesh)) => {
                let axis = mesh.pose().axis();
                axis.map_or(0.0, |(_, axis)| self.spin().dot(axis))
            }
            _ => self.drum_speed(),
        }
    }

    /// How far from `origin` a ray along the unit vector `direction` first hits a mesh [m]; none
    /// where it hits none.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let hits = self.walls.iter().filter_map(|wall| match &wall.surface {
            Surface::Mesh(mesh) => mesh.first_hit(origin, direction),
            _ => None,
        });
        hits.min_by(f64::total_cmp)
    }

    /// Lets the walls move on for `time` [s] as they do now: for states that another program, or
    /// another run, came to. A solver moves them step by step, to other last bits.
    pub fn carry(&mut self, time: f64) {
        self.angle += self.turning_speed() * time;
        for wall in &mut self.walls {
            let way = wall.motion.velocity * time;
            match &mut wall.surface {
                Surface::Plane { point, .. } => *point += way,
                Surface::Tube { rim, .. } => *rim += way.y,
                Surface::Cylinder { .. } => {}
                Surface::Mesh(mesh) => mesh.advance(&wall.motion, time),
            }
        }
    }

    /// Turns all walls as one body at `speed` [rad/s]: of a drum about z, of a mesh about its axis.
    pub fn set_drum_speed(&mut self, speed: f64) {
        for wall in &mut self.walls {
            match &wall.surface {
                Surface::Mesh(mesh) => wall.motion = mesh.turning(speed),
                _ => wall.motion.spin = DVec3::new(0.0, 0.0, speed),
            }
        }
    }
}

impl Surface {
    /// Distance of the point `x` from the wall, positive on the grains' side [m] and on both of a
    /// mesh, and the unit vector from `x` towards the wall.
    pub fn distance(&self, x: DVec3) -> (f64, DVec3) {
        let x = x.to_array().map(|x| One::splat((), x));
        let (distance, direction) = self.distance_in_lanes((), x);
        (distance.get(), DVec3::from_array(direction.map(One::get)))
    }

    /// The same for points side by side, as far as they are centres of grains that touch it: a
    /// part of a mesh is far from a grain that touches another part at the edge between them.
    #[inline(always)]
    pub fn contact_in_lanes<N: Lanes>(
        &self,
        processor: N::Processor,
        position: [N; 3],
    ) -> (N, [N; 3]) {
        match self {
            Self::Mesh(mesh) => of_mesh(mesh, processor, position, true),
            _ => self.distance_in_lanes(processor, position),
        }
    }

    /// [`Surface::distance`] for points side by side.
    ///
    /// With the distance `ρ` of a point from the axis, a cylinder is `R − ρ` away, radially; the
    /// nearest point of a tube stands at `R − ρ` radially and, below its rim, at that height. On
    /// the axis itself any direction is radial, and x is taken.
    #[inline(always)]
    pub fn distance_in_lanes<N: Lanes>(
        &self,
        processor: N::Processor,
        position: [N; 3],
    ) -> (N, [N; 3]) {
        let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
        let [x, y, z] = position;
        match self {
            Self::Mesh(mesh) => of_mesh(mesh, processor, position, false),
            &Self::Plane { point, normal } => {
                let inward = splat_vector(processor, normal.to_array());
                let away = minus(position, splat_vector(processor, point.to_array()));
                (dot(away, inward), [-inward[0], -inward[1], -inward[2]])
            }
            &Self::Cylinder { radius } => {
                let rho = (x * x + y * y).sqrt();
                let off_axis = rho.exceeds(zero);
                let outward = [
                    N::choose(off_axis, x / rho, one),
                    N::choose(off_axis, y / rho, zero),
                    zero,
                ];
                (N::splat(processor, radius) - rho, outward)
            }
            &Self::Tube { radius, rim } => {
                let rho = (x * x + z * z).sqrt();
                let off_axis = rho.exceeds(zero);
                let outward = [
                    N::choose(off_axis, x / rho, one),
                    zero,
                    N::choose(off_axis, z / rho, zero),
                ];
                let below = N::splat(processor, rim) - y;
                let below = N::choose(below.exceeds(zero), below, zero);
                let across = times(outward, N::splat(processor, radius) - rho);
                let nearest = plus(across, [zero, below, zero]);
                let distance = dot(nearest, nearest).sqrt();
                let apart = distance.exceeds(zero);
                let direction = [
                    N::choose(apart, nearest[0] / distance, outward[0]),
                    N::choose(apart, nearest[1] / distance, outward[1]),
                    N::choose(apart, nearest[2] / distance, outward[2]),
                ];
                (distance, direction)
            }
        }
    }
}

/// Distances from a mesh and directions towards it, of `contacts` alone or of all points.
#[inline(always)]
fn of_mesh<N: Lanes>(
    mesh: &MeshWall,
    processor: N::Processor,
    position: [N; 3],
    contacts: bool,
) -> (N, [N; 3]) {
    let found = mesh.side_by_side(position.map(N::numbers), N::COUNT, contacts);
    let [distance, x, y, z] = [0, 1, 2, 3].map(|k| N::load(processor, &found[k]));
    (distance, [x, y, z])
}
