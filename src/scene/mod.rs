//! What was asked for: a scene read from a RON file, every value checked.
//!
//! In: the text of a scene file. Out: a [`Scene`] in SI units, or a [`SceneError`] that names file,
//! line, key, value and what was expected. Nothing here places a grain: [`crate::world::build`]
//! does.
//!
#![doc = include_str!("../../scenes/README.md")]

mod built_in;
mod check;
mod container;
mod description;
mod error;
mod file;
mod grains;
mod lattice;
mod materials;
mod mesh;
mod outline;
mod reading;
mod shape;
mod size_classes;
mod stored_cells;
mod syntax;
mod text;

pub use built_in::{BuiltIn, built_in, built_in_called};
pub use container::{SceneContainer, ScenePlane, SceneTube};
pub use description::{SAMPLE_INTERVAL, Scene, TimeStep, Until};
pub(crate) use error::{Problem, one_of, suggestion};
pub use error::{SceneError, nearest};
pub(crate) use file::count_of;
pub(crate) use grains::lattice_counts;
pub use grains::{SceneCellSpecies, SceneCells, SceneGrain, SceneGrains, SceneSpecies};
pub use lattice::Lattice;
pub use materials::{PairOverride, SceneMaterial};
pub use mesh::{MeshError, MeshMotion, SceneMesh};
pub(crate) use outline::first_word;
pub(crate) use reading::{folder_of, read_text};
pub use shape::{SceneBody, SceneShape};
pub use size_classes::{SizeClass, size_classes, species_counts};
pub(crate) use stored_cells::lies_in;
pub use stored_cells::{
    HeldCells, PackingError, StoredCells, take_packings_from_anywhere, within_folders,
};
pub(crate) use syntax::{FileKind, read_ron};
