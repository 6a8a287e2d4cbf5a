//! The engines that a scene can be handed to.

use std::fmt;
use std::str::FromStr;

/// Millimetres, in which exaDEM is told of grains and tells of them.
pub const PER_METRE: f64 = 1e3;

/// An engine that computes grains on many machines, by MPI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MpiEngine {
    /// LIGGGHTS 3.8, with which Kasper et al. 2021 ran their drum.
    Liggghts,
    /// LAMMPS with its package GRANULAR, from 2023 on.
    Lammps,
    /// exaDEM, later than 1.2.2: the one with rounded polyhedra.
    Exadem,
}

impl MpiEngine {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Liggghts, Self::Lammps, Self::Exadem];

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Liggghts => "LIGGGHTS",
            Self::Lammps => "LAMMPS",
            Self::Exadem => "exaDEM",
        }
    }

    /// Its word in options and files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Liggghts => "liggghts",
            Self::Lammps => "lammps",
            Self::Exadem => "exadem",
        }
    }

    /// The program, as it is called where it is installed.
    pub fn program(self) -> &'static str {
        match self {
            Self::Liggghts => "liggghts",
            Self::Lammps => "lmp",
            Self::Exadem => "exaDEM",
        }
    }

    /// The variable by which its export's script is told of another program.
    pub fn variable(self) -> &'static str {
        match self {
            Self::Liggghts => "LIGGGHTS",
            Self::Lammps => "LAMMPS",
            Self::Exadem => "EXADEM",
        }
    }
}

impl fmt::Display for MpiEngine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for MpiEngine {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|engine| engine.word() == word);
        known.ok_or_else(|| "expected `liggghts`, `lammps` or `exadem`".to_owned())
    }
}
