//! How a file spells the grains: a filling, Voronoi cells, or a list.
//!
//! In: the keys of `grains` and the container, whose volume a bulk fraction is of. Out:
//! [`SceneGrains`]. Whether the values make sense is for [`crate::scene`]'s checks.

use super::keys::{either, metres, missing_length};
use crate::geometry::spheres_volume;
use crate::scene::check::{check_container, fraction};
use crate::scene::container::volume;
use crate::scene::error::Problem;
use crate::scene::shape::rotation;
use crate::scene::{
    SceneCellSpecies, SceneCells, SceneContainer, SceneGrain, SceneGrains, SceneShape,
    SceneSpecies, StoredCells,
};
use glam::{DQuat, DVec3};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Sphero-radius of the grains of Man et al. 2023 [m].
const SPHERO_RADIUS: f64 = 1e-4;

#[derive(Deserialize)]
#[serde(rename = "Grains", deny_unknown_fields)]
pub(super) enum GrainsFile {
    Fill {
        count: Option<u64>,
        bulk_fraction: Option<f64>,
        packing: Option<f64>,
        species: Vec<SpeciesFile>,
    },
    Voronoi(CellsFile),
    List(Vec<GrainFile>),
}

#[derive(Deserialize)]
#[serde(rename = "Voronoi", deny_unknown_fields)]
pub(super) struct CellsFile {
    cell: Option<f64>,
    cell_mm: Option<f64>,
    rounding: Option<f64>,
    rounding_mm: Option<f64>,
    solid_fraction: Option<f64>,
    bulk_fraction: Option<f64>,
    packing: Option<PathBuf>,
    species: Vec<CellSpeciesFile>,
}

#[derive(Deserialize)]
#[serde(rename = "Species", deny_unknown_fields)]
struct CellSpeciesFile {
    name: Option<String>,
    material: String,
    share: Option<f64>,
}

#[derive(Deserialize)]
#[serde(rename = "Species", deny_unknown_fields)]
pub(super) struct SpeciesFile {
    name: Option<String>,
    radius: Option<f64>,
    radius_mm: Option<f64>,
    material: String,
    share: Option<f64>,
}

#[derive(Deserialize)]
#[serde(rename = "Grain", deny_unknown_fields)]
pub(super) struct GrainFile {
    position: DVec3,
    #[serde(default)]
    velocity: DVec3,
    #[serde(default)]
    spin: DVec3,
    radius: Option<f64>,
    radius_mm: Option<f64>,
    shape: Option<ShapeFile>,
    rounding: Option<f64>,
    rounding_mm: Option<f64>,
    #[serde(default)]
    orientation: OrientationFile,
    material: String,
    film: Option<f64>,
}

#[derive(Deserialize)]
#[serde(rename = "Shape", deny_unknown_fields)]
enum ShapeFile {
    Sphere,
    Box {
        size: DVec3,
    },
    Tetrahedron {
        edge: f64,
    },
    Prism {
        sides: u32,
        edge: f64,
        height: f64,
    },
    Hull {
        points: Vec<DVec3>,
    },
    Core {
        corners: Vec<DVec3>,
        faces: Vec<Vec<u16>>,
        volume: f64,
        gyration: DVec3,
    },
}

#[derive(Default, Deserialize)]
#[serde(rename = "Orientation", deny_unknown_fields)]
enum OrientationFile {
    #[default]
    Upright,
    Turned {
        axis: DVec3,
        angle: Option<f64>,
        angle_deg: Option<f64>,
    },
    Quaternion {
        x: f64,
        y: f64,
        z: f64,
        w: f64,
    },
}

impl GrainsFile {
    pub(super) fn into_grains(
        self,
        container: &SceneContainer,
        folder: &Path,
    ) -> Result<SceneGrains, Problem> {
        match self {
            Self::Fill {
                count,
                bulk_fraction,
                packing,
                species,
            } => {
                let alone = species.len() == 1;
                let species = species
                    .into_iter()
                    .enumerate()
                    .map(|(index, species)| species.into_species(index, alone))
                    .collect::<Result<Vec<_>, _>>()?;
                let solid_volume = match count {
                    Some(_) => None,
                    None => Some(solid_volume(
                        container,
                        bulk_fraction.unwrap_or(0.35),
                        packing.unwrap_or(0.60),
                    )?),
                };
                let count = match count {
                    Some(count) => given_count(count, bulk_fraction, packing)?,
                    None => count_of(solid_volume.unwrap_or_default(), &species),
                };
                Ok(SceneGrains::Fill {
                    count,
                    solid_volume,
                    species,
                })
            }
            Self::Voronoi(cells) => Ok(SceneGrains::Voronoi(cells.into_cells(container, folder)?)),
            Self::List(grains) => Ok(SceneGrains::List(
                grains
                    .into_iter()
                    .enumerate()
                    .map(|(index, grain)| grain.into_grain(index))
                    .collect::<Result<_, _>>()?,
            )),
        }
    }
}

impl SpeciesFile {
    fn into_species(self, index: usize, alone: bool) -> Result<SceneSpecies, Problem> {
        let path = format!("grains.species[{index}]");
        let radius = required_radius(&path, self.radius, self.radius_mm)?;
        Ok(SceneSpecies {
            name: self.name.unwrap_or_else(|| self.material.clone()),
            radius,
            material: self.material,
            share: required_share(path, self.share, alone)?,
        })
    }
}

impl CellsFile {
    fn into_cells(self, container: &SceneContainer, folder: &Path) -> Result<SceneCells, Problem> {
        if let Some(file) = &self.packing {
            let packing = StoredCells::beside(folder, file).map_err(|error| {
                Problem::new(
                    "grains.packing",
                    format!("names {}, which {error}", file.display()),
                    "a file that `grainfall pack SCENE --out FILE` wrote; its name is relative to the scene's folder",
                )
            })?;
            return self.with_packing(packing);
        }
        let whole = match container {
            SceneContainer::Drum { .. } => 0.35,
            _ => 1.0,
        };
        let cell = either("grains.cell", self.cell, "_mm", self.cell_mm.map(metres))?;
        let rounding = self.rounding_mm.map(metres);
        let rounding = either("grains.rounding", self.rounding, "_mm", rounding)?;
        Ok(SceneCells {
            cell: cell.unwrap_or(0.002),
            rounding: rounding.unwrap_or(SPHERO_RADIUS),
            solid_fraction: self.solid_fraction.unwrap_or(0.8),
            bulk_fraction: self.bulk_fraction.unwrap_or(whole),
            packing: None,
            species: cell_species(self.species)?,
        })
    }

    fn with_packing(self, packing: StoredCells) -> Result<SceneCells, Problem> {
        for (key, value) in [
            ("cell", self.cell.or(self.cell_mm)),
            ("rounding", self.rounding.or(self.rounding_mm)),
            ("solid_fraction", self.solid_fraction),
            ("bulk_fraction", self.bulk_fraction),
        ] {
            if value.is_some() {
                return Err(Problem::new(
                    format!("grains.{key}"),
                    "contradicts `packing`, which is given too",
                    "either a `packing` or what the grains are cut from",
                ));
            }
        }
        let roundings = packing.grains().iter().map(|grain| grain.shape.rounding);
        Ok(SceneCells {
            cell: libm::cbrt(packing.solid_volume() / packing.grains().len() as f64),
            rounding: roundings.fold(f64::INFINITY, f64::min),
            solid_fraction: 1.0,
            bulk_fraction: 1.0,
            packing: Some(packing),
            species: cell_species(self.species)?,
        })
    }
}

fn cell_species(species: Vec<CellSpeciesFile>) -> Result<Vec<SceneCellSpecies>, Problem> {
    let alone = species.len() == 1;
    let each = species.into_iter().enumerate();
    each.map(|(index, species)| species.into_species(index, alone))
        .collect()
}

impl CellSpeciesFile {
    fn into_species(self, index: usize, alone: bool) -> Result<SceneCellSpecies, Problem> {
        let path = format!("grains.species[{index}]");
        Ok(SceneCellSpecies {
            name: self.name.unwrap_or_else(|| self.material.clone()),
            material: self.material,
            share: required_share(path, self.share, alone)?,
        })
    }
}

/// The share that a species states, all of the grains where it stands `alone`.
fn required_share(species: String, share: Option<f64>, alone: bool) -> Result<f64, Problem> {
    share.or(alone.then_some(1.0)).ok_or_else(|| {
        Problem::new(
            species,
            "has no `share`",
            "its share of the grains by number, 0 to 1, as there are several species",
        )
    })
}

impl GrainFile {
    fn into_grain(self, index: usize) -> Result<SceneGrain, Problem> {
        let path = format!("grains[{index}]");
        let rounding = either(
            &format!("{path}.rounding"),
            self.rounding,
            "_mm",
            self.rounding_mm.map(metres),
        )?;
        let shape = self.shape.map_or(SceneShape::Sphere, |shape| {
            shape.into_shape(rounding.unwrap_or(SPHERO_RADIUS))
        });
        let radius = if shape.is_sphere() {
            if rounding.is_some() {
                return Err(Problem::new(
                    format!("{path}.rounding"),
                    "is given for a sphere, which has no edges",
                    "a `shape` such as `Box(size: (0.01, 0.01, 0.01))` beside it",
                ));
            }
            required_radius(&path, self.radius, self.radius_mm)?
        } else {
            if self.radius.or(self.radius_mm).is_some() {
                return Err(Problem::new(
                    format!("{path}.radius"),
                    "is given beside a `shape`, which has a size of its own",
                    "a `radius` for a sphere or a `shape` for a polyhedron",
                ));
            }
            shape.radius()
        };
        Ok(SceneGrain {
            position: self.position,
            velocity: self.velocity,
            spin: self.spin,
            radius,
            shape,
            orientation: self.orientation.into_rotation(&path)?,
            material: self.material,
            film: self.film,
        })
    }
}

impl ShapeFile {
    fn into_shape(self, rounding: f64) -> SceneShape {
        match self {
            Self::Sphere => SceneShape::Sphere,
            Self::Box { size } => SceneShape::Box { size, rounding },
            Self::Tetrahedron { edge } => SceneShape::Tetrahedron { edge, rounding },
            Self::Prism {
                sides,
                edge,
                height,
            } => SceneShape::Prism {
                sides,
                edge,
                height,
                rounding,
            },
            Self::Hull { points } => SceneShape::Hull { points, rounding },
            Self::Core {
                corners,
                faces,
                volume,
                gyration,
            } => SceneShape::Core {
                corners,
                faces,
                rounding,
                volume,
                gyration,
            },
        }
    }
}

impl OrientationFile {
    fn into_rotation(self, grain: &str) -> Result<DQuat, Problem> {
        let refuse = |expected| {
            let path = format!("{grain}.orientation");
            Problem::new(path, "says no direction", expected)
        };
        match self {
            Self::Upright => Ok(DQuat::IDENTITY),
            Self::Turned {
                axis,
                angle,
                angle_deg,
            } => {
                let path = format!("{grain}.orientation.angle");
                let degrees = angle_deg.map(f64::to_radians);
                let angle = either(&path, angle, "_deg", degrees)?.unwrap_or(0.0);
                let axis = axis.try_normalize().filter(|_| angle.is_finite());
                axis.map(|axis| rotation(axis, angle)).ok_or_else(|| {
                    refuse("an axis `(x, y, z)` that is not zero and an angle in rad, or in degrees as `angle_deg`")
                })
            }
            Self::Quaternion { x, y, z, w } => {
                let length = (x * x + y * y + z * z + w * w).sqrt();
                let turn = DQuat::from_xyzw(x / length, y / length, z / length, w / length);
                Some(turn)
                    .filter(|turn| turn.is_normalized())
                    .ok_or_else(|| refuse("a quaternion `x`, `y`, `z`, `w` that is not zero"))
            }
        }
    }
}

fn required_radius(holder: &str, si: Option<f64>, mm: Option<f64>) -> Result<f64, Problem> {
    either(&format!("{holder}.radius"), si, "_mm", mm.map(metres))?
        .ok_or_else(|| missing_length(holder, "radius"))
}

fn given_count(
    count: u64,
    bulk_fraction: Option<f64>,
    packing: Option<f64>,
) -> Result<usize, Problem> {
    for (key, value) in [("bulk_fraction", bulk_fraction), ("packing", packing)] {
        if value.is_some() {
            return Err(Problem::new(
                format!("grains.{key}"),
                "contradicts `count`, which is given too",
                "either `count`, or `bulk_fraction` and `packing`",
            ));
        }
    }
    Ok(usize::try_from(count).unwrap_or(usize::MAX))
}

/// Volume of the grains of a bed that takes `bulk_fraction` of the container's volume, packed at
/// `packing` [m³].
fn solid_volume(
    container: &SceneContainer,
    bulk_fraction: f64,
    packing: f64,
) -> Result<f64, Problem> {
    check_container(container)?;
    fraction("grains.bulk_fraction", bulk_fraction)?;
    fraction("grains.packing", packing)?;
    Ok(volume(container)? * bulk_fraction * packing)
}

/// Number of grains of these species that fill `solid_volume` [m³].
pub(crate) fn count_of(solid_volume: f64, species: &[SceneSpecies]) -> usize {
    let grain_volume: f64 = species
        .iter()
        .map(|s| spheres_volume(s.share, s.radius))
        .sum();
    let count = solid_volume / grain_volume;
    // A nonsensical radius or share gives a nonsensical number here; their own checks say so.
    if count.is_finite() {
        count.round().max(0.0) as usize
    } else {
        1
    }
}
