//! Grainfall: an interactive laboratory for granular matter.
//!
//! ```text
//!  scenes/*.ron
//!      │ parse, validate (the only place that knows the file's keys)
//!      ▼
//!   scene ──build──▶ world ◀──step── solver          the solver is the only writer of a world
//!                      │ &World
//!                      ▼
//!                   measure ──▶ named numbers with units
//!                      │
//!               simulation   Bevy plugin: owns a Run (world + solver), steps it in FixedUpdate,
//!                      │     takes Commands (the only road back), publishes measures
//!         ┌────────────┴───────────────┐
//!         ▼                            ▼
//!     headless                  view (3D)  ui (egui panels)
//!     MinimalPlugins            DefaultPlugins
//!     + SimulationPlugin        + the same SimulationPlugin
//! ```
//!
//! A module names only modules above it. `geometry`, `scene`, `world`, `solver` and `measure` know nothing of Bevy; `view` and `ui`
//! stand behind the Cargo feature `desktop`, on by default.
//!
//! | module | holds |
//! |---|---|
//! | [`geometry`] | convex solids: cutting, integrals, hulls |
//! | [`scene`] | what was asked for: scene files, defaults, validation |
//! | [`world`] | state at one instant, in columns; snapshot, restore, hash |
//! | [`solver`] | how the state advances: time step, neighbours, force laws, integration, faults |
//! | [`measure`] | read-only numbers from a world |
//! | [`simulation`] | the run (world, solver, commands, samples) and the Bevy plugin that steps it |
//! | [`headless`] | the windowless runner and its output files |
//! | [`sweep`] | variations of a scene side by side: cases, checkpoints, table, plots |
//! | [`files`] | files that appear whole or not at all |
//! | `view` | a world as pixels: grains, container, camera, colours |
//! | `ui` | the egui panels |
//! | `window` | the app that opens them in a window, or draws them into a picture |
//!
//! # Conventions
//! SI units everywhere in state, files and output; other units only in panels and in scene keys that name their unit.
//! The frame is right-handed with x to the right, **y up** and z towards the viewer; a drum's axis is z, and a positive
//! drum speed turns anticlockwise as the viewer sees it. A contact's normal points from grain `i` to its partner `j`.
//! State and forces are `f64`; `f32` only on the way to the screen.

pub mod files;
pub mod geometry;
pub mod headless;
pub mod measure;
pub mod scene;
pub mod simulation;
pub mod solver;
pub mod sweep;
#[cfg(feature = "desktop")]
pub mod ui;
#[cfg(feature = "desktop")]
pub mod view;
#[cfg(feature = "desktop")]
pub mod window;
pub mod world;
