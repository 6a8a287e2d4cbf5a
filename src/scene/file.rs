//! The keys of a scene file, with their defaults and units.
//!
//! In: RON. Out: a [`Scene`] whose values are not yet checked. This is the only place that knows how a file spells
//! things; [`super::check`] is the only one that knows which values make sense.
//!
//! What the keys mean stands in `scenes/README.md`.

use super::check::{check_container, fraction, volume};
use super::error::Problem;
use super::shape::rotation;
use super::{
    BridgeLaw, ContactLaw, FeatureRule, LiquidCase, PAPER_VOLUME, PairOverride, Scene,
    SceneCellSpecies, SceneCells, SceneContainer, SceneGrain, SceneGrains, SceneLiquid,
    SceneMaterial, ScenePlane, SceneShape, SceneSpecies, SceneTube, StoredCells, TimeStep,
};
use glam::{DQuat, DVec3};
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::f64::consts::PI;
use std::fmt;
use std::path::{Path, PathBuf};

/// A whole file.
#[derive(Deserialize)]
#[serde(rename = "Scene", deny_unknown_fields)]
pub(super) struct SceneFile {
    title: String,
    #[serde(default)]
    look_for: String,
    #[serde(default)]
    source: String,
    materials: NamedMaterials,
    #[serde(default)]
    pairs: Vec<PairOverride>,
    container: ContainerFile,
    grains: GrainsFile,
    #[serde(default)]
    liquid: Option<LiquidFile>,
    #[serde(default = "earth_gravity")]
    gravity: DVec3,
    law: Option<ContactLaw>,
    #[serde(default)]
    time_step: TimeStep,
    #[serde(default = "paper_duration")]
    duration: f64,
    #[serde(default = "paper_output_interval")]
    output_interval: f64,
    #[serde(default = "first_seed")]
    seed: u64,
}

fn earth_gravity() -> DVec3 {
    DVec3::new(0.0, -9.81, 0.0)
}

fn paper_duration() -> f64 {
    50.0
}

fn paper_output_interval() -> f64 {
    0.1
}

fn first_seed() -> u64 {
    1
}

/// A material. What it leaves out is the spheres' dry glass of Kasper et al. 2021, or the polyhedra of Man et al. 2023.
#[derive(Deserialize)]
#[serde(rename = "Material", default, deny_unknown_fields)]
#[derive(Default)]
struct MaterialFile {
    youngs_modulus: Option<f64>,
    poisson_ratio: Option<f64>,
    density: Option<f64>,
    restitution: Option<f64>,
    friction: Option<f64>,
    wet_friction: Option<f64>,
    rolling_friction: Option<f64>,
}

/// What materials leave out.
struct MaterialDefaults {
    density: f64,
    restitution: f64,
    friction: f64,
    rolling_friction: f64,
}

const GLASS: MaterialDefaults = MaterialDefaults {
    density: 2500.0,
    restitution: 0.95,
    friction: 0.40,
    rolling_friction: 0.01,
};
const POLYHEDRA: MaterialDefaults = MaterialDefaults {
    density: 2650.0,
    restitution: 0.1,
    friction: 0.40,
    rolling_friction: 0.0,
};
/// Springs of Man et al. 2023.
const POLYHEDRA_LAW: ContactLaw = ContactLaw::Hooke {
    normal_stiffness: 4000.0,
    tangential_stiffness: 2000.0,
    features: FeatureRule::Full,
};
/// Rounding of Man et al. 2023 [m].
const ROUNDING: f64 = 1e-4;

/// Materials in the order of the file, which is the order of their indices.
struct NamedMaterials(Vec<(String, MaterialFile)>);

impl<'de> Deserialize<'de> for NamedMaterials {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(InOrder)
    }
}

struct InOrder;

impl<'de> Visitor<'de> for InOrder {
    type Value = NamedMaterials;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map from names to materials")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut materials = Vec::new();
        while let Some(entry) = map.next_entry()? {
            materials.push(entry);
        }
        Ok(NamedMaterials(materials))
    }
}

#[derive(Deserialize)]
#[serde(rename = "Container", deny_unknown_fields)]
enum ContainerFile {
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
struct TubeFile {
    speed: f64,
    material: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename = "Plane", deny_unknown_fields)]
struct PlaneFile {
    name: Option<String>,
    point: DVec3,
    normal: DVec3,
    #[serde(default)]
    velocity: DVec3,
    material: String,
}

#[derive(Deserialize)]
#[serde(rename = "Grains", deny_unknown_fields)]
enum GrainsFile {
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
struct CellsFile {
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
struct SpeciesFile {
    name: Option<String>,
    radius: Option<f64>,
    radius_mm: Option<f64>,
    material: String,
    share: Option<f64>,
}

#[derive(Deserialize)]
#[serde(rename = "Grain", deny_unknown_fields)]
struct GrainFile {
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
    Box { size: DVec3 },
    Tetrahedron { edge: f64 },
    Prism { sides: u32, edge: f64, height: f64 },
    Hull { points: Vec<DVec3> },
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

/// A liquid: a case of the paper's Table 1, whose values others may replace, or all of them.
#[derive(Deserialize)]
#[serde(rename = "Liquid", deny_unknown_fields)]
struct LiquidFile {
    case: Option<u8>,
    surface_tension: Option<f64>,
    contact_angle: Option<f64>,
    contact_angle_deg: Option<f64>,
    viscosity: Option<f64>,
    viscosity_mpas: Option<f64>,
    volume: Option<f64>,
    volume_ml: Option<f64>,
    #[serde(default)]
    law: BridgeLawFile,
}

#[derive(Default, Deserialize)]
#[serde(rename = "BridgeLaw")]
enum BridgeLawFile {
    #[default]
    AsPrinted,
    AsCoded,
    Choices(BridgeLaw),
}

impl SceneFile {
    /// The scene it states; `folder` is the one it stands in. Numbers are as the file gives them, sensible or not.
    pub fn into_scene(self, folder: &Path) -> Result<Scene, Problem> {
        let container = self.container.into_container()?;
        let grains = self.grains.into_grains(&container, folder)?;
        let mut scene = Scene {
            title: self.title,
            look_for: self.look_for,
            source: self.source,
            materials: Vec::new(),
            pairs: self.pairs,
            container,
            grains,
            liquid: self.liquid.map(LiquidFile::into_liquid).transpose()?,
            gravity: self.gravity,
            law: ContactLaw::default(),
            time_step: self.time_step,
            duration: self.duration,
            output_interval: self.output_interval,
            seed: self.seed,
        };
        let (defaults, law) = if scene.is_polyhedral() {
            (POLYHEDRA, POLYHEDRA_LAW)
        } else {
            (GLASS, ContactLaw::default())
        };
        scene.materials = self.materials.into_list(&defaults);
        scene.law = self.law.unwrap_or(law);
        Ok(scene)
    }
}

impl NamedMaterials {
    fn into_list(self, defaults: &MaterialDefaults) -> Vec<SceneMaterial> {
        let with_name = |(name, file): (String, MaterialFile)| SceneMaterial {
            name,
            youngs_modulus: file.youngs_modulus.unwrap_or(63e6),
            poisson_ratio: file.poisson_ratio.unwrap_or(0.21),
            density: file.density.unwrap_or(defaults.density),
            restitution: file.restitution.unwrap_or(defaults.restitution),
            friction: file.friction.unwrap_or(defaults.friction),
            wet_friction: file.wet_friction,
            rolling_friction: file.rolling_friction.unwrap_or(defaults.rolling_friction),
        };
        self.0.into_iter().map(with_name).collect()
    }
}

impl ContainerFile {
    fn into_container(self) -> Result<SceneContainer, Problem> {
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

impl GrainsFile {
    fn into_grains(
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
            let packing = StoredCells::read(&folder.join(file)).map_err(|error| {
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
            rounding: rounding.unwrap_or(ROUNDING),
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
            shape.into_shape(rounding.unwrap_or(ROUNDING))
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

impl LiquidFile {
    fn into_liquid(self) -> Result<SceneLiquid, Problem> {
        let base = self.case.map(liquid_case).transpose()?;
        let missing = |key: &str| {
            Problem::new(
                "liquid",
                format!("has neither `case` nor `{key}`"),
                "a `case` of the paper's Table 1, 1 to 7, or `viscosity`, `surface_tension` and `contact_angle`",
            )
        };
        let of_case = |value: fn(&SceneLiquid) -> f64| base.as_ref().map(value);
        let angle = self.contact_angle_deg.map(f64::to_radians);
        let angle = either("liquid.contact_angle", self.contact_angle, "_deg", angle)?;
        let viscosity = self.viscosity_mpas.map(|mpas| mpas / 1000.0);
        let viscosity = either("liquid.viscosity", self.viscosity, "_mpas", viscosity)?;
        let volume = self.volume_ml.map(|ml| ml * 1e-6);
        let volume = either("liquid.volume", self.volume, "_ml", volume)?;
        Ok(SceneLiquid {
            surface_tension: self
                .surface_tension
                .or(of_case(|l| l.surface_tension))
                .ok_or_else(|| missing("surface_tension"))?,
            contact_angle: angle
                .or(of_case(|l| l.contact_angle))
                .ok_or_else(|| missing("contact_angle"))?,
            viscosity: viscosity
                .or(of_case(|l| l.viscosity))
                .ok_or_else(|| missing("viscosity"))?,
            volume: volume.unwrap_or(PAPER_VOLUME),
            law: match self.law {
                BridgeLawFile::AsPrinted => BridgeLaw::AS_PRINTED,
                BridgeLawFile::AsCoded => BridgeLaw::AS_CODED,
                BridgeLawFile::Choices(law) => law,
            },
        })
    }
}

fn liquid_case(number: u8) -> Result<SceneLiquid, Problem> {
    LiquidCase::of(number).map(LiquidCase::liquid).ok_or_else(|| {
        Problem::value(
            "liquid.case",
            number.to_string(),
            "a liquid of the paper's Table 1, 1 (water) to 7 (glycerol); a dry scene has no `liquid`",
        )
    })
}

fn metres(millimetres: f64) -> f64 {
    millimetres / 1000.0
}

/// [rad/s]
fn per_second(turns_per_minute: f64) -> f64 {
    turns_per_minute * 2.0 * PI / 60.0
}

/// The value that one of two keys gives, in SI units.
fn either(
    path: &str,
    si: Option<f64>,
    suffix: &str,
    converted: Option<f64>,
) -> Result<Option<f64>, Problem> {
    if si.is_some() && converted.is_some() {
        let key = path.rsplit('.').next().unwrap_or(path);
        return Err(Problem::new(
            path,
            format!("is given twice, as `{key}` and as `{key}{suffix}`"),
            "one of the two",
        ));
    }
    Ok(si.or(converted))
}

fn required_radius(holder: &str, si: Option<f64>, mm: Option<f64>) -> Result<f64, Problem> {
    either(&format!("{holder}.radius"), si, "_mm", mm.map(metres))?
        .ok_or_else(|| missing_length(holder, "radius"))
}

fn missing_length(holder: &str, key: &str) -> Problem {
    Problem::new(
        holder,
        format!("has no `{key}`"),
        format!("a length in m, or in mm as `{key}_mm`"),
    )
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

/// Volume of the grains of a bed that takes `bulk_fraction` of the container's volume, packed at `packing` [m³].
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
pub(super) fn count_of(solid_volume: f64, species: &[SceneSpecies]) -> usize {
    let grain_volume: f64 = species
        .iter()
        .map(|s| s.share * 4.0 / 3.0 * PI * s.radius.powi(3))
        .sum();
    let count = solid_volume / grain_volume;
    // A nonsensical radius or share gives a nonsensical number here; their own checks say so.
    if count.is_finite() {
        count.round().max(0.0) as usize
    } else {
        1
    }
}
