//! Walls: analytic surfaces that move as rigid bodies.

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
    /// Angle through which a drum has turned since the start [rad].
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
}

/// The velocity field of a rigid body: `velocity + spin × x`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WallMotion {
    /// Velocity at the origin [m/s].
    pub velocity: DVec3,
    /// Angular velocity about the origin [rad/s].
    pub spin: DVec3,
}

impl WallMotion {
    /// Velocity at the point `x` [m/s].
    pub fn velocity_at(&self, x: DVec3) -> DVec3 {
        self.velocity + self.spin.cross(x)
    }
}

impl Container {
    /// Drum speed about z [rad/s]; zero where nothing turns.
    pub fn drum_speed(&self) -> f64 {
        self.walls.first().map_or(0.0, |wall| wall.motion.spin.z)
    }

    /// Turns all walls of a drum as one body at `speed` [rad/s] about z.
    pub fn set_drum_speed(&mut self, speed: f64) {
        for wall in &mut self.walls {
            wall.motion.spin = DVec3::new(0.0, 0.0, speed);
        }
    }
}

impl Surface {
    /// Distance of the point `x` from the wall, positive on the grains' side [m], and the unit
    /// vector from `x` towards the wall.
    pub fn distance(&self, x: DVec3) -> (f64, DVec3) {
        match *self {
            Self::Plane { point, normal } => ((x - point).dot(normal), -normal),
            Self::Cylinder { radius } => {
                let rho = (x.x * x.x + x.y * x.y).sqrt();
                let outward = if rho > 0.0 {
                    DVec3::new(x.x / rho, x.y / rho, 0.0)
                } else {
                    DVec3::X
                };
                (radius - rho, outward)
            }
            Self::Tube { radius, rim } => {
                let rho = (x.x * x.x + x.z * x.z).sqrt();
                let outward = if rho > 0.0 {
                    DVec3::new(x.x / rho, 0.0, x.z / rho)
                } else {
                    DVec3::X
                };
                let below = (rim - x.y).max(0.0);
                let nearest = (radius - rho) * outward + DVec3::new(0.0, below, 0.0);
                let distance = nearest.length();
                let direction = if distance > 0.0 {
                    nearest / distance
                } else {
                    outward
                };
                (distance, direction)
            }
        }
    }
}
