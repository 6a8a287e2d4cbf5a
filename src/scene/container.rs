//! The walls of a scene.

use super::error::Problem;
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
            Self::Nothing | Self::Planes(_) => None,
        }
    }
}

/// Volume of a container that can be filled [m³].
pub(super) fn volume(container: &SceneContainer) -> Result<f64, Problem> {
    match container {
        SceneContainer::Drum { radius, width, .. } => Ok(PI * radius * radius * width),
        SceneContainer::Box { min, max, .. } => Ok((*max - *min).element_product()),
        SceneContainer::Nothing | SceneContainer::Column { .. } | SceneContainer::Planes(_) => {
            Err(Problem::new(
                "grains",
                "is a `Fill`, but the container is open",
                "a `Drum` or a `Box` to fill, or the grains as a `List`",
            ))
        }
    }
}
