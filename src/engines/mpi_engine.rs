//! The engines that a scene can be handed to.

use std::fmt;
use std::str::FromStr;

/// An engine that computes grains on many machines, by MPI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MpiEngine {
    /// LIGGGHTS 3.8, with which Kasper et al. 2021 ran their drum.
    Liggghts,
    /// LAMMPS with its package GRANULAR, from 2023 on.
    Lammps,
}

impl MpiEngine {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Liggghts, Self::Lammps];

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Liggghts => "LIGGGHTS",
            Self::Lammps => "LAMMPS",
        }
    }

    /// Its word in options and files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Liggghts => "liggghts",
            Self::Lammps => "lammps",
        }
    }

    /// The program, as it is called where it is installed.
    pub fn program(self) -> &'static str {
        match self {
            Self::Liggghts => "liggghts",
            Self::Lammps => "lmp",
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
        known.ok_or_else(|| "expected `liggghts` or `lammps`".to_owned())
    }
}
