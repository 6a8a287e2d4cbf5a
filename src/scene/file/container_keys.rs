//! How a file spells the container.
//!
//! In: the keys of `container`. Out: a [`SceneContainer`] with the papers' values where a key is
//! left out. Whether the values make sense is for [`crate::scene`]'s checks.

use super::keys::{either, metres, missing_length, per_second};
use crate::physics::limits;
use crate::scene::check::within;
use crate::scene::error::Problem;
use crate::scene::{MeshMotion, SceneContainer, SceneMesh, ScenePlane, SceneTube};
use glam::DVec3;
use serde::Deserialize;
use std::path::{Path, PathBuf};

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
    Mesh {
        file: Option<PathBuf>,
        scale: Option<f64>,
        triangles: Option<Vec<[DVec3; 3]>>,
        material: String,
        #[serde(default)]
        motion: MotionFile,
        room: Option<RoomFile>,
    },
}

#[derive(Deserialize, Default)]
#[serde(rename = "Motion", deny_unknown_fields)]
pub(super) enum MotionFile {
    #[default]
    Fixed,
    Turning {
        #[serde(default)]
        through: DVec3,
        axis: DVec3,
        speed: Option<f64>,
        speed_rpm: Option<f64>,
    },
    Moving {
        velocity: DVec3,
    },
}

#[derive(Deserialize)]
#[serde(rename = "Room", deny_unknown_fields)]
pub(super) struct RoomFile {
    min: DVec3,
    max: DVec3,
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
    /// The container; `folder` is the one that the scene stands in.
    pub(super) fn into_container(self, folder: &Path) -> Result<SceneContainer, Problem> {
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
            Self::Mesh {
                file,
                scale,
                triangles,
                material,
                motion,
                room,
            } => SceneContainer::Mesh {
                surface: surface(file.as_deref(), scale, triangles, folder)?,
                material,
                motion: motion.into_motion()?,
                room: room.map(|room| (room.min, room.max)),
            },
        })
    }
}

/// The mesh in a file, or of triangles that are given.
fn surface(
    file: Option<&Path>,
    scale: Option<f64>,
    triangles: Option<Vec<[DVec3; 3]>>,
    folder: &Path,
) -> Result<SceneMesh, Problem> {
    match (file, triangles) {
        (Some(file), None) => {
            let scale = scale.unwrap_or(1.0);
            within(&limits::MESH_SCALE, scale, || "container.scale".to_owned())?;
            SceneMesh::beside(folder, file, scale).map_err(|error| {
                Problem::new(
                    "container.file",
                    format!("names {}, which {error}", file.display()),
                    "an STL file, in text or binary; its name is relative to the scene's folder",
                )
            })
        }
        (None, Some(triangles)) if scale.is_none() => SceneMesh::new(triangles).map_err(|flaw| {
            Problem::new(
                "container.triangles",
                format!("are no surface for grains: {flaw}"),
                "triangles of three corners each, in m",
            )
        }),
        (None, Some(_)) => Err(Problem::new(
            "container.scale",
            "is that of a file, but the `triangles` are given, in m",
            "no `scale`",
        )),
        (Some(_), Some(_)) => Err(Problem::new(
            "container.triangles",
            "contradicts `file`, which is given too",
            "one of the two",
        )),
        (None, None) => Err(Problem::new(
            "container",
            "has no `file`",
            "the name of an STL file in the scene's folder, in double quotes",
        )),
    }
}

impl MotionFile {
    fn into_motion(self) -> Result<MeshMotion, Problem> {
        Ok(match self {
            Self::Fixed => MeshMotion::Fixed,
            Self::Moving { velocity } => MeshMotion::Moving { velocity },
            Self::Turning {
                through,
                axis,
                speed,
                speed_rpm,
            } => {
                let turns = speed_rpm.map(per_second);
                let speed = either("container.motion.speed", speed, "_rpm", turns)?;
                MeshMotion::Turning {
                    through,
                    axis: axis.try_normalize().unwrap_or(axis),
                    speed: speed.ok_or_else(|| {
                        Problem::new(
                            "container.motion",
                            "has no `speed`",
                            "rad/s, or turns per minute as `speed_rpm`",
                        )
                    })?,
                }
            }
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
