//! The keys of a scene file, with their defaults and units.
//!
//! In: RON. Out: a [`Scene`] whose values are not yet checked. This is the only place that knows
//! how a file spells things; the scene's checks are the only ones that know which values make
//! sense.
//!
//! What the keys mean stands in `scenes/README.md`.

mod container_keys;
mod grains_keys;
mod keys;
mod liquid_keys;

pub(crate) use grains_keys::count_of;

use super::error::Problem;
use super::syntax::FileKind;
use super::{PairOverride, Scene, SceneMaterial, TimeStep, Until};
use crate::physics::{ContactLaw, FeatureRule, Integrator};
use container_keys::ContainerFile;
use glam::DVec3;
use grains_keys::GrainsFile;
use liquid_keys::LiquidFile;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::path::Path;

/// What a scene's file is, in words.
pub(super) const KIND: FileKind = FileKind {
    noun: "scene",
    begins: "`(title: …, …)`",
    meaning,
};

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
    integrator: Integrator,
    #[serde(default)]
    time_step: TimeStep,
    #[serde(default = "paper_duration")]
    duration: f64,
    #[serde(default)]
    until: Until,
    #[serde(default = "paper_output_interval")]
    output_interval: f64,
    #[serde(default)]
    sample_interval: Option<f64>,
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

/// A material. What it leaves out is the spheres' dry glass of Kasper et al. 2021, or the polyhedra
/// of Man et al. 2023.
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

impl SceneFile {
    /// The scene it states; `folder` is the one it stands in. Numbers are as the file gives them,
    /// sensible or not.
    pub fn into_scene(self, folder: &Path) -> Result<Scene, Problem> {
        let container = self.container.into_container(folder)?;
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
            integrator: self.integrator,
            time_step: self.time_step,
            duration: self.duration,
            until: self.until,
            output_interval: self.output_interval,
            sample_interval: self.sample_interval,
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

/// What a key holds, for those who left it out or gave something else.
fn meaning(key: &str) -> &'static str {
    match key {
        "title" => "one line that names the scene",
        "materials" => "the materials by name: `{\"glass\": (density: 2500), …}`",
        "container" => "`Drum(…)`, `Box(…)`, `Column(…)`, `Planes([…])`, `Mesh(…)` or `Nothing`",
        "grains" => "`Fill(…)`, `Voronoi(…)` or `List([…])`",
        "species" => "the kinds of grain, `[(radius: 0.003, material: \"glass\")]`",
        "material" => "the name of one of the scene's materials",
        "radius" => "a length in m, or in mm as `radius_mm`",
        "height" => "a length in m, or in mm as `height_mm`",
        "cell" | "rounding" => "a length in m, or in mm under a key that ends in `_mm`",
        "shape" => {
            "`Box(size: …)`, `Tetrahedron(edge: …)`, `Prism(…)`, `Hull(points: […])` or `Sphere`"
        }
        "orientation" => "`Turned(axis: …, angle_deg: …)`, `Quaternion(…)` or `Upright`",
        "motion" => "`Fixed`, `Turning(axis: …, speed: …)` or `Moving(velocity: …)`",
        "file" => "the name of an STL file in the scene's folder, in double quotes",
        "room" => "the box that is filled, `(min: …, max: …)` in m",
        "scale" => "the file's unit of length in m, 0.001 for millimetres",
        "tube" => "`(speed: …)` in m/s",
        "width" => "a length in m, or in mm as `width_mm`",
        "speed" => "rad/s, or turns per minute as `speed_rpm`",
        "position" | "point" | "min" | "max" => "a point `(x, y, z)` in m",
        "velocity" => "`(x, y, z)` in m/s",
        "spin" => "`(x, y, z)` in rad/s",
        "gravity" => "`(x, y, z)` in m/s²",
        "normal" => "the direction `(x, y, z)` towards the grains",
        "between" => "two materials, `(\"glass\", \"drum\")`",
        "normal_stiffness" | "tangential_stiffness" => "a spring's stiffness in N/m",
        "law" => ContactLaw::FORMS,
        "integrator" => "`Explicit` or `Implicit`",
        "time_step" => {
            "`Automatic`, `Following`, `Reference`, `Fast` or `Given(…)` with a time in s"
        }
        "until" => "`Duration` or `Rest`",
        "duration" | "output_interval" | "sample_interval" => "a time in s",
        _ => "",
    }
}
