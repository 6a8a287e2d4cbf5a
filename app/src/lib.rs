//! The program of Grainfall: the app that steps a lab, with a window or without one.
//!
//! ```text
//!  grainfall::lab     one or two runs, one clock, one command enum
//!      │
//!  simulation         Bevy plugin: steps the lab in FixedUpdate
//!      ├───────────────────────────┐
//!      ▼                           ▼
//!  headless                     view (3D)  ui (egui panels)
//!  MinimalPlugins               DefaultPlugins
//!  + SimulationPlugin           + the same SimulationPlugin
//! ```
//!
//! Both step the same systems. All that is computed is the library's, [`grainfall`]; without the feature `desktop` there is no
//! window. A module names only modules above it in this table.
//!
//! | module | holds |
//! |---|---|
//! | [`simulation`] | the Bevy plugin that lets a lab go on |
//! | `picture_size` | how large pictures may be |
//! | [`headless`] | the program without a window: the app, progress, what is printed |
//! | `view` | a world as pixels: grains, container, camera, colours |
//! | `ui` | the egui panels |
//! | `window` | the app that opens them in a window, or draws them into a picture |

#![allow(
    clippy::disallowed_methods,
    reason = "what it computes reaches no trajectory"
)]

pub mod headless;
#[cfg(feature = "desktop")]
pub mod picture_size;
pub mod simulation;
#[cfg(feature = "desktop")]
pub mod ui;
#[cfg(feature = "desktop")]
pub mod view;
#[cfg(feature = "desktop")]
pub mod window;
