//! The walls of a scene.

use super::error::Problem;
use super::mesh::{MeshMotion, SceneMesh};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The walls of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SceneContainer {
    /// No walls at all.
    Nothing,
    /// A drum about the z axis, rim and both end plates turning as one body.
    Drum {
        /// Inner radius [m].
        radius: f64,
        /// Inner width [m].
        width: f64,
        /// Angular speed, positive anticlockwise seen from +z [rad/s].
        speed: f64,
        /// Name of its material.
        material: String,
    },
    /// A closed box along the axes.
    Box {
        /// Lower corner [m].
        min: DVec3,
        /// Upper corner [m].
        max: DVec3,
        /// Name of its material.
        material: String,
    },
    /// An unbounded floor at y = 0 for a column about the y axis.
    Column {
        /// Radius of the column, `R_i` [m].
        radius: f64,
        /// Height of the column, `H_i` [m].
        height: f64,
        /// Name of the floor's material.
        material: String,
        /// What holds the column at the start; nothing where it is let go at once.
        tube: Option<SceneTube>,
    },
    /// Unbounded planes.
    Planes(Vec<ScenePlane>),
    /// A surface of triangles.
    Mesh {
        /// The triangles.
        surface: SceneMesh,
        /// Name of its material.
        material: String,
        /// How it moves.
        motion: MeshMotion,
        /// Lower and upper corner of the box in which a filling is placed [m]; the inside of the
        /// surface where there is none.
        room: Option<(DVec3, DVec3)>,
    },
}

/// A thin upright tube round a column, pulled up from time zero on, unbounded above.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneTube {
    /// Its speed upwards [m/s].
    pub speed: f64,
    /// Name of its material.
    pub material: String,
    /// Height of its lower rim at time zero [m].
    #[serde(default)]
    pub rim: f64,
}

/// An unbounded plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScenePlane {
    /// What people call it.
    pub name: String,
    /// Any point of it [m].
    pub point: DVec3,
    /// Normal towards the grains (made a unit vector when read).
    pub normal: DVec3,
    /// Velocity of its surface, along the plane as that of a belt [m/s].
    pub velocity: DVec3,
    /// Name of its material.
    pub material: String,
}

impl SceneContainer {
    /// Whether it is one that turns.
    pub fn turns(&self) -> bool {
        let motion = match self {
            Self::Mesh { motion, .. } => motion,
            _ => &MeshMotion::Fixed,
        };
        matches!(self, Self::Drum { .. }) || matches!(motion, MeshMotion::Turning { .. })
    }

    /// Whether it has a curved wall at the start, into which Voronoi cells are cut to fit.
    pub fn cuts_cells(&self) -> bool {
        matches!(self, Self::Drum { .. } | Self::Column { tube: Some(_), .. })
    }

    /// Lower and upper corner of the box whose lattice the Voronoi cells of a bed in it come from
    /// [m]; none of an open container.
    pub fn cells_box(&self) -> Option<(DVec3, DVec3)> {
        match *self {
            Self::Column { radius, height, .. } => Some((
                DVec3::new(-radius, 0.0, -radius),
                DVec3::new(radius, height, radius),
            )),
            Self::Drum { radius, width, .. } => {
                let corner = DVec3::new(radius, radius, 0.5 * width);
                Some((-corner, corner))
            }
            Self::Box { min, max, .. } => Some((min, max)),
            Self::Nothing | Self::Planes(_) | Self::Mesh { .. } => None,
        }
    }
}

/// Volume of a container that can be filled [m³].
pub(super) fn volume(container: &SceneContainer) -> Result<f64, Problem> {
    match container {
        SceneContainer::Drum { radius, width, .. } => Ok(PI * radius * radius * width),
        SceneContainer::Box { min, max, .. }
        | SceneContainer::Mesh {
            room: Some((min, max)),
            ..
        } => Ok((*max - *min).element_product()),
        SceneContainer::Mesh { surface, .. } => match surface.open_edges() {
            0 => Ok(surface.volume()),
            edges => Err(Problem::new(
                "grains",
                format!(
                    "is a `Fill`, but the mesh of the container is open: it ends at {edges} of its edges"
                ),
                "a closed surface, whose inside is filled; `room: (min: …, max: …)` in the container, a box to fill; or \
                 the grains as a `List`",
            )),
        },
        SceneContainer::Nothing | SceneContainer::Column { .. } | SceneContainer::Planes(_) => {
            Err(Problem::new(
                "grains",
                "is a `Fill`, but the container is open",
                "a `Drum` or a `Box` to fill, or a closed `Mesh`, or the grains as a `List`",
            ))
        }
    }
}
