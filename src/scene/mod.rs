//! What was asked for: a scene read from a RON file, every value checked.
//!
//! In: the text of a scene file. Out: a [`Scene`] in SI units, or a [`SceneError`] that names file, line, key, value and
//! what was expected. Nothing here places a grain: [`crate::world::build`] does.
//!
#![doc = include_str!("../../scenes/README.md")]

mod built_in;
mod check;
mod container;
mod error;
mod file;
mod grains;
mod lattice;
mod mixture;
mod outline;
mod packing;
mod shape;
mod syntax;

pub use built_in::{BuiltIn, built_in};
pub use container::{SceneContainer, ScenePlane, SceneTube};
pub use error::SceneError;
pub(crate) use error::{Problem, one_of, suggestion};
pub(crate) use file::count_of;
pub use grains::{SceneCellSpecies, SceneCells, SceneGrain, SceneGrains, SceneSpecies};
pub use lattice::Lattice;
pub use mixture::{SizeClass, size_classes, species_counts};
pub use packing::{HeldCells, PackingError, StoredCells};
pub use shape::{SceneBody, SceneShape};

use crate::physics::{ContactLaw, Liquid};
use file::SceneFile;
use glam::DVec3;
use ron::extensions::Extensions;
use serde::{Deserialize, Serialize};
use std::io::Read;
use std::path::Path;

/// Largest scene file that is read [bytes]: room for about half a million listed grains.
const LARGEST_FILE: u64 = 64 << 20;

/// A checked scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Title, one line.
    pub title: String,
    /// What to look for, a sentence or two.
    pub look_for: String,
    /// Where the numbers come from.
    pub source: String,
    /// Materials in the order of their index in a world.
    pub materials: Vec<SceneMaterial>,
    /// Properties of pairs that differ from the mixing rule.
    pub pairs: Vec<PairOverride>,
    /// The walls.
    pub container: SceneContainer,
    /// The grains.
    pub grains: SceneGrains,
    /// The liquid between them, if any.
    pub liquid: Option<Liquid>,
    /// Gravitational acceleration [m/s²].
    pub gravity: DVec3,
    /// Which contact law acts.
    pub law: ContactLaw,
    /// How the time step is chosen.
    pub time_step: TimeStep,
    /// Simulated time of a headless run [s].
    pub duration: f64,
    /// Simulated time between two written states [s].
    pub output_interval: f64,
    /// Seed of everything random.
    pub seed: u64,
}

/// How the time step is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum TimeStep {
    /// The largest stable step at the start. It stays as it is; a change that makes it too long is
    /// told.
    #[default]
    Automatic,
    /// This step [s].
    Given(f64),
    /// The largest stable step at any time: a change that moves the limit changes the step too, as a
    /// command of its own.
    Following,
}

/// A material as a scene states it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneMaterial {
    /// What the scene calls it.
    pub name: String,
    /// Young's modulus E [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio ν.
    pub poisson_ratio: f64,
    /// Density ρ [kg/m³].
    pub density: f64,
    /// Restitution of two bodies of this material.
    pub restitution: f64,
    /// Sliding friction of two bodies of this material.
    pub friction: f64,
    /// Sliding friction where there is liquid, where that differs.
    pub wet_friction: Option<f64>,
    /// Rolling friction of two bodies of this material.
    pub rolling_friction: f64,
}

/// What differs from the mixing rule (the harmonic mean of both materials' values, Eq. 3.7 of Man et al. 2023) when two
/// materials meet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Pair", deny_unknown_fields)]
pub struct PairOverride {
    /// The two materials' names.
    pub between: (String, String),
    /// Restitution, where it differs.
    pub restitution: Option<f64>,
    /// Sliding friction, where it differs.
    pub friction: Option<f64>,
    /// Sliding friction where there is liquid, where that differs from both.
    pub wet_friction: Option<f64>,
    /// Rolling friction, where it differs.
    pub rolling_friction: Option<f64>,
}

impl Scene {
    /// The scene in the file at `path`.
    ///
    /// # Errors
    /// When the file cannot be read, is no scene, or states something impossible.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        Self::parse(&name, &read(path, &name)?)
    }

    /// The grains that come from a file in place of being cut.
    pub fn stored_cells(&self) -> Option<&StoredCells> {
        match &self.grains {
            SceneGrains::Voronoi(cells) => cells.packing.as_ref(),
            _ => None,
        }
    }

    /// The scene that a person calls `name`: the file at that path, or else a built-in scene of that name or path.
    ///
    /// # Errors
    /// As [`Scene::load`], and when there is neither such a file nor such a scene.
    pub fn open(name: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = name.as_ref();
        if path.exists() {
            return Self::load(path);
        }
        let name = path.display().to_string();
        let wanted = name.strip_suffix(".ron").unwrap_or(&name);
        let mut known = built_in().iter();
        if let Some(scene) = known.find(|scene| scene.name == wanted || scene.path == name) {
            return Self::parse(scene.path, scene.text);
        }
        let names: Vec<&str> = built_in().iter().map(|scene| scene.name).collect();
        Err(SceneError::unreadable(
            &name,
            "there is no such file, nor a built-in scene of that name",
            &format!("a file, or {}", error::one_of(&names)),
        )
        .advise(error::suggestion(wanted, &names)))
    }

    /// The scene that `text` states; `file` is what errors call it, and names of files in it are relative to its folder.
    ///
    /// # Errors
    /// When the text is no scene, or states something impossible.
    pub fn parse(file: &str, text: &str) -> Result<Self, SceneError> {
        let text = text.trim_start_matches('\u{feff}');
        if text.trim().is_empty() {
            return Err(SceneError::unreadable(
                file,
                "the file is empty",
                "a scene `(title: …, …)`",
            ));
        }
        let refuse = |problem| SceneError::from_problem(file, text, problem);
        let scene = ron::Options::default()
            .with_default_extension(
                Extensions::IMPLICIT_SOME
                    | Extensions::UNWRAP_NEWTYPES
                    | Extensions::UNWRAP_VARIANT_NEWTYPES,
            )
            .from_str::<SceneFile>(text)
            .map_err(|error| syntax::explain(file, text, &error))?
            .into_scene(folder_of(file))
            .map_err(refuse)?;
        scene.problem().map_err(refuse)?;
        Ok(scene)
    }

    /// Whether every value makes sense and all fit together, as a scene made by a program may not. Parsed scenes do.
    ///
    /// # Errors
    /// When a value does not.
    pub fn check(&self) -> Result<(), SceneError> {
        self.problem()
            .map_err(|problem| SceneError::outside_of_files(&self.title, problem))
    }

    /// The material called `name`, with its index in a world.
    pub fn material(&self, name: &str) -> Option<(usize, &SceneMaterial)> {
        let mut materials = self.materials.iter().enumerate();
        materials.find(|(_, material)| material.name == name)
    }

    /// Whether its grains are rounded polyhedra. Spheres among them are polyhedra of one corner.
    pub fn is_polyhedral(&self) -> bool {
        match &self.grains {
            SceneGrains::Fill { .. } => false,
            SceneGrains::Voronoi(_) => true,
            SceneGrains::List(list) => list.iter().any(|grain| !grain.shape.is_sphere()),
        }
    }

    /// Number of its grains. Voronoi cells that are all to be grains can be a few more or less: which cells have their
    /// centroid in a column is known when they are made.
    pub fn grain_count(&self) -> usize {
        match &self.grains {
            SceneGrains::Fill { count, .. } => *count,
            SceneGrains::Voronoi(cells) => cells.grain_count(&self.container),
            SceneGrains::List(list) => list.len(),
        }
    }

    /// Name and material of each species of a filling in its order; none for listed grains.
    pub fn species(&self) -> Vec<(&str, &str)> {
        match &self.grains {
            SceneGrains::Fill { species, .. } => {
                let names = species
                    .iter()
                    .map(|s| (s.name.as_str(), s.material.as_str()));
                names.collect()
            }
            SceneGrains::Voronoi(cells) => {
                let names = cells.species.iter();
                names
                    .map(|s| (s.name.as_str(), s.material.as_str()))
                    .collect()
            }
            SceneGrains::List(_) => Vec::new(),
        }
    }

    /// Share by number of the species at `index` of a filling; zero for listed grains.
    pub fn share(&self, index: usize) -> f64 {
        let share = match &self.grains {
            SceneGrains::Fill { species, .. } => species.get(index).map(|s| s.share),
            SceneGrains::Voronoi(cells) => cells.species.get(index).map(|s| s.share),
            SceneGrains::List(_) => None,
        };
        share.unwrap_or(0.0)
    }

    /// Whether any of its grains is made of the material called `name`.
    pub fn has_grains_of(&self, name: &str) -> bool {
        match &self.grains {
            SceneGrains::List(list) => list.iter().any(|grain| grain.material == name),
            _ => self.species().iter().any(|species| species.1 == name),
        }
    }

    /// Whether walls are made of the material called `name`.
    pub fn has_walls_of(&self, name: &str) -> bool {
        match &self.container {
            SceneContainer::Nothing => false,
            SceneContainer::Drum { material, .. } | SceneContainer::Box { material, .. } => {
                material == name
            }
            SceneContainer::Column { material, tube, .. } => {
                material == name || tube.as_ref().is_some_and(|tube| tube.material == name)
            }
            SceneContainer::Planes(planes) => planes.iter().any(|plane| plane.material == name),
        }
    }

    /// Indices of the species whose grains the one at `index` can change places with while a run goes on, itself included:
    /// those of its radius, or all species of Voronoi cells. Empty for listed grains.
    pub fn interchangeable_species(&self, index: usize) -> Vec<usize> {
        match &self.grains {
            SceneGrains::Fill { species, .. } => {
                let radius = species.get(index).map(|kind| kind.radius);
                let alike = |other: &usize| Some(species[*other].radius) == radius;
                (0..species.len()).filter(alike).collect()
            }
            SceneGrains::Voronoi(cells) if index < cells.species.len() => {
                (0..cells.species.len()).collect()
            }
            SceneGrains::Voronoi(_) | SceneGrains::List(_) => Vec::new(),
        }
    }
}

impl PairOverride {
    /// Whether it says how `a` and `b`, in either order, meet.
    pub fn is_between(&self, a: &str, b: &str) -> bool {
        let (first, second) = (self.between.0.as_str(), self.between.1.as_str());
        (first, second) == (a, b) || (first, second) == (b, a)
    }
}

fn folder_of(file: &str) -> &Path {
    Path::new(file).parent().unwrap_or(Path::new(""))
}

/// Text of the file at `path`, which errors call `name`.
fn read(path: &Path, name: &str) -> Result<String, SceneError> {
    let refuse = |fault: String| SceneError::unreadable(name, fault, "a scene file in RON");
    if path.is_dir() {
        return Err(refuse("this is a folder".to_owned()));
    }
    let unreadable = |error: std::io::Error| refuse(format!("cannot be read: {error}"));
    let file = std::fs::File::open(path).map_err(unreadable)?;
    let mut bytes = Vec::new();
    // One byte more than allowed tells a file that is too large, even where its size is not known beforehand.
    let read = file.take(LARGEST_FILE + 1).read_to_end(&mut bytes);
    if read.map_err(unreadable)? as u64 > LARGEST_FILE {
        return Err(refuse("is larger than 64 MiB".to_owned()));
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = error.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(&error.as_bytes()[..good]).into_owned();
        refuse("is not UTF-8 text".to_owned()).at_line(&text, good)
    })
}
