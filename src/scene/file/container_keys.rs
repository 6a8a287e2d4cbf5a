//! How a file spells the container.
//!
//! In: the keys of `container`. Out: a [`SceneContainer`] with the papers' values where a key is
//! left out. Whether the values make sense is for [`crate::scene`]'s checks.

use super::keys::{either, metres, missing_length, per_second};
use crate::scene::error::Problem;
use crate::scene::{SceneContainer, ScenePlane, SceneTube};
use glam::DVec3;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(rename = "Container", deny_unknown_fields)]
pub(super) enum ContainerFile {
    Nothing,
    Drum {
        radius: Option<f64>,
        radius_mm: Option<f64>,
        width: Option<f64>,
        width_mm: Option<f64>,
        speed: Option<f64>,
        speed_rpm: Option<f64>,
        material: String,
    },
    Box {
        min: DVec3,
        max: DVec3,
        material: String,
    },
    Column {
        radius: Option<f64>,
        radius_mm: Option<f64>,
        height: Option<f64>,
        height_mm: Option<f64>,
        material: String,
        tube: Option<TubeFile>,
    },
    Planes(Vec<PlaneFile>),
}

#[derive(Deserialize)]
#[serde(rename = "Tube", deny_unknown_fields)]
pub(super) struct TubeFile {
    speed: f64,
    material: Option<String>,
    #[serde(default)]
    rim: f64,
}

#[derive(Deserialize)]
#[serde(rename = "Plane", deny_unknown_fields)]
pub(super) struct PlaneFile {
    name: Option<String>,
    point: DVec3,
    normal: DVec3,
    #[serde(default)]
    velocity: DVec3,
    material: String,
}

impl ContainerFile {
    pub(super) fn into_container(self) -> Result<SceneContainer, Problem> {
        Ok(match self {
            Self::Nothing => SceneContainer::Nothing,
            Self::Drum {
                radius,
                radius_mm,
                width,
                width_mm,
                speed,
                speed_rpm,
                material,
            } => SceneContainer::Drum {
                radius: either("container.radius", radius, "_mm", radius_mm.map(metres))?
                    .unwrap_or(0.0605),
                width: either("container.width", width, "_mm", width_mm.map(metres))?
                    .unwrap_or(0.022),
                speed: either("container.speed", speed, "_rpm", speed_rpm.map(per_second))?
                    .unwrap_or(per_second(0.5)),
                material,
            },
            Self::Box { min, max, material } => SceneContainer::Box { min, max, material },
            Self::Column {
                radius,
                radius_mm,
                height,
                height_mm,
                material,
                tube,
            } => SceneContainer::Column {
                radius: either("container.radius", radius, "_mm", radius_mm.map(metres))?
                    .unwrap_or(0.025),
                height: either("container.height", height, "_mm", height_mm.map(metres))?
                    .ok_or_else(|| missing_length("container", "height"))?,
                tube: tube.map(|tube| SceneTube {
                    speed: tube.speed,
                    rim: tube.rim,
                    material: tube.material.unwrap_or_else(|| material.clone()),
                }),
                material,
            },
            Self::Planes(planes) => SceneContainer::Planes(
                planes
                    .into_iter()
                    .enumerate()
                    .map(|(index, plane)| plane.into_plane(index))
                    .collect(),
            ),
        })
    }
}

impl PlaneFile {
    fn into_plane(self, index: usize) -> ScenePlane {
        ScenePlane {
            name: self.name.unwrap_or_else(|| format!("plane-{}", index + 1)),
            point: self.point,
            normal: self.normal.try_normalize().unwrap_or(self.normal),
            velocity: self.velocity,
            material: self.material,
        }
    }
}
