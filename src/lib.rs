//! The library of Grainfall, an interactive laboratory for granular matter: scenes, worlds, the solver, measures, runs. It knows of
//! no window and no app: the program, its Bevy systems and panels are the package in `app`.
//!
//! ```text
//!  scenes/*.ron
//!      │ parse, validate (the only place that knows the file's keys)
//!      ▼
//!   physics ◀── scene ──build──▶ world ◀──step── solver     the solver is the only writer of a world
//!                                  │ &World
//!                                  ▼
//!                               measure ──▶ named numbers with units
//!                                  │
//!                                 run     world + solver + commands + samples; branches; the record that verifies
//!                                  ├──▶ runner, sweep, paper    to the end: files, checkpoints, many cases
//!                                 lab     one or two runs, one clock, one command enum: what the program's systems step
//! ```
//!
//! A module names only modules above it in this table.
//!
//! | module | holds |
//! |---|---|
//! | [`files`] | files that appear whole or not at all, that grow, and folders that are locked |
//! | [`geometry`] | convex solids: cutting, integrals, hulls |
//! | [`lanes`] | numbers side by side: one vocabulary for every width of the processor, and its plain twin |
//! | [`physics`] | force laws and their choices, materials and how two meet, liquids, units and hard limits |
//! | [`scene`] | what was asked for: scene files, defaults, validation |
//! | [`world`] | state at one instant, in columns; snapshot, restore, hash |
//! | [`solver`] | how the state advances: time step, neighbours, integration, faults |
//! | [`measure`] | read-only numbers from a world |
//! | [`parameters`] | the registry of what people can change: keys, units, ranges, what it does, how it is written |
//! | [`run`] | the trajectory (world, solver, commands, samples), its branches, beds, sessions, records |
//! | [`output`] | the files that a run leaves behind |
//! | [`runner`] | a scene run to its end: the one loop that advances, records, keeps checkpoints, stops |
//! | [`engines`] | scenes for engines that run under MPI, and what they computed |
//! | [`recording`] | a run's folder read back: its states one by one, without computing them again |
//! | [`sweep`] | variations of a scene side by side: cases, table, plots |
//! | [`paper`] | a paper's cases in one command: what they are, their tables in files and documents |
//! | [`lesson`] | lessons: steps of text, predictions, what a run answers |
//! | [`lab`] | one run or two side by side, moved on by a driver, as panels and scripts see them |
//!
//! # Conventions
//! SI units everywhere in state, files and output; other units only in panels and in scene keys
//! that name their unit. The frame is right-handed with x to the right, **y up** and z towards the
//! viewer; a drum's axis is z, and a positive drum speed turns anticlockwise as the viewer sees it.
//! A contact's normal points from grain `i` to its partner `j`. State and forces are `f64`; `f32`
//! only on the way to the screen.

#![cfg_attr(
    test,
    allow(
        clippy::disallowed_methods,
        reason = "tests compare with the platform's own functions"
    )
)]

// What tests of this package share with those inside it names the package as those outside do.
#[cfg(test)]
extern crate self as grainfall;

#[allow(
    clippy::disallowed_methods,
    reason = "what it computes reaches no trajectory"
)]
pub mod engines;
pub mod files;
pub mod geometry;
pub mod lab;
pub mod lanes;
#[allow(
    clippy::disallowed_methods,
    reason = "what it computes reaches no trajectory"
)]
pub mod lesson;
#[allow(
    clippy::disallowed_methods,
    reason = "what it computes reaches no trajectory"
)]
pub mod measure;
#[allow(
    clippy::disallowed_methods,
    reason = "what it computes reaches no trajectory"
)]
pub mod output;
#[allow(
    clippy::disallowed_methods,
    reason = "what it computes reaches no trajectory"
)]
pub mod paper;
pub mod parameters;
pub mod physics;
#[allow(
    clippy::disallowed_methods,
    reason = "what it computes reaches no trajectory"
)]
pub mod recording;
pub mod run;
pub mod runner;
pub mod scene;
pub mod solver;
#[allow(
    clippy::disallowed_methods,
    reason = "what it computes reaches no trajectory"
)]
pub mod sweep;
pub mod world;
