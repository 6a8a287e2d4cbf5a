//! Grains at one instant, as an engine's file states them, before they are believed.
//!
//! In: rows of a dump or a data file. Out: an [`AtomFrame`] in SI units, grains in order of their
//! numbers, or a [`FrameError`] that says what is wrong and where.

use crate::physics::limits::{self, Limits};
use glam::{DQuat, DVec3};
use std::fmt;
use std::path::{Path, PathBuf};

/// One grain of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Atom {
    /// Its number.
    pub id: u64,
    /// Its type, from 1 on.
    pub kind: u32,
    /// Centre [m].
    pub position: DVec3,
    /// Velocity [m/s].
    pub velocity: DVec3,
    /// Angular velocity [rad/s].
    pub spin: DVec3,
    /// Radius; of a polyhedron the distance of its farthest point from its centroid [m].
    pub radius: f64,
    /// Rotation from body axes to the world's, of polyhedra.
    pub orientation: Option<DQuat>,
    /// Density [kg/m³], where the file states it.
    pub density: Option<f64>,
    /// Force, weight included [N], where the file states it.
    pub force: Option<DVec3>,
}

/// Grains at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct AtomFrame {
    /// Steps that the engine had taken.
    pub step: u64,
    /// Its time [s], where the file states it.
    pub time: Option<f64>,
    /// The grains, in order of their numbers.
    pub atoms: Vec<Atom>,
}

/// What is wrong with an engine's file, and where.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub struct FrameError {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1 on; none where it is about the file.
    pub line: Option<u64>,
    /// What is wrong, and what was expected.
    pub reason: String,
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", self.reason)
    }
}

impl FrameError {
    /// About the file at `path`.
    pub fn of_file(path: &Path, reason: impl Into<String>) -> Self {
        Self {
            path: path.to_owned(),
            line: None,
            reason: reason.into(),
        }
    }

    /// About a line of it.
    pub fn at_line(path: &Path, line: u64, reason: impl Into<String>) -> Self {
        Self {
            line: Some(line),
            ..Self::of_file(path, reason)
        }
    }
}

impl Atom {
    /// Refuses numbers that no grain has.
    ///
    /// # Errors
    /// What is wrong, for people.
    pub fn check(&self) -> Result<(), String> {
        within(&limits::RADIUS, self.radius, "radius")?;
        if let Some(density) = self.density {
            within(&limits::DENSITY, density, "density")?;
        }
        let vectors = [
            (self.position, "position"),
            (self.velocity, "velocity"),
            (self.spin, "angular velocity"),
            (self.force.unwrap_or(DVec3::ZERO), "force"),
        ];
        match vectors.into_iter().find(|(vector, _)| !vector.is_finite()) {
            Some((vector, what)) => Err(format!(
                "the {what} of grain {} is {vector}; expected numbers",
                self.id
            )),
            None => Ok(()),
        }
    }
}

fn within(limits: &Limits, value: f64, what: &str) -> Result<(), String> {
    if limits.accept(value) {
        return Ok(());
    }
    Err(format!(
        "a {what} is {value:?}; expected {}",
        limits.expected
    ))
}

impl AtomFrame {
    /// It with its grains in order; refuses numbers that occur twice, and grains that are none.
    ///
    /// # Errors
    /// What is wrong, for people.
    pub fn ordered(mut self) -> Result<Self, String> {
        self.atoms.sort_unstable_by_key(|atom| atom.id);
        if let Some(pair) = self.atoms.windows(2).find(|pair| pair[0].id == pair[1].id) {
            return Err(format!("grain {} occurs twice", pair[0].id));
        }
        self.atoms.iter().try_for_each(Atom::check)?;
        Ok(self)
    }
}
