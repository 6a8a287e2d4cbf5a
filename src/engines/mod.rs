//! Scenes for engines that run on many machines, and what they computed.
//!
//! In: a scene and its world at time zero. Out: a folder that LIGGGHTS, LAMMPS or, of polyhedra,
//! exaDEM runs under MPI.
//! What the engine does not have is refused, what it does otherwise is said. And back: files of these
//! engines as grains at an instant.
//!
//! Each row of the table uses only rows below it.
//!
//! | file | holds |
//! |---|---|
//! | `started_scene` | a scene that begins with a state |
//! | `import` | what an engine computed, measured as a run of ours |
//! | `imported_state` | a frame as a state of a scene |
//! | `export` | the folder that an engine runs |
//! | `liggghts_deck`, `lammps_deck`, `exadem_deck` | the engines' scripts |
//! | `liggghts_walls` | walls in the words of LIGGGHTS |
//! | `deck`, `liggghts_model` | what both have in common; contact laws in the words of LIGGGHTS |
//! | `atoms_file`, `wall_mesh` | the grains as a data file, walls as triangles |
//! | `rockable_files` | polyhedra as shapes and bodies |
//! | `frames` | what engines wrote, read back: instant by instant |
//! | `dump_file`, `data_file`, `xyz_file` | dumps, data files, extended XYZ |
//! | `dump_box` | the box of a dump, and where grains stand in it |
//! | `lines` | a file line by line |
//! | `atom_frame` | grains at an instant, as a file states them |
//! | `atom_types` | what an engine's coefficients belong to |
//! | `mpi_engine` | the engines |

mod atom_frame;
mod atom_types;
mod atoms_file;
mod data_file;
mod deck;
mod dump_box;
mod dump_file;
mod exadem_deck;
mod export;
mod frames;
mod import;
mod imported_state;
mod lammps_deck;
mod liggghts_deck;
mod liggghts_model;
mod liggghts_walls;
mod lines;
mod mpi_engine;
mod rockable_files;
mod started_scene;
mod wall_mesh;
mod xyz_file;

pub use atom_frame::{Atom, AtomFrame, FrameError};
pub use atom_types::{AtomTypes, GrainType};
pub use atoms_file::{DomainBox, write_atoms};
pub use deck::Steps;
pub use export::{Export, ExportError, ExportRecord, Exported, export};
pub use frames::{FrameFile, read_frames};
pub use import::{ImportError, ImportSource, Imported, import, named_files};
pub use mpi_engine::MpiEngine;
pub use started_scene::{scene_from, sound_scene_from};
pub use wall_mesh::WallMesh;
