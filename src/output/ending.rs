//! How a run ended, as files say it.

use crate::solver::Fault;

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// It reached its duration, or the rest that ends it.
    Done,
    /// Somebody stopped it; its files are whole.
    Interrupted,
    /// The solver met an absurd state; the files hold all up to the last good one.
    Faulted(Fault),
}

impl Ending {
    /// The word that files have for it.
    pub fn status(&self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Interrupted => "interrupted",
            Self::Faulted(_) => "fault",
        }
    }

    /// What made the solver stop, if anything.
    pub fn fault(&self) -> Option<&Fault> {
        match self {
            Self::Faulted(fault) => Some(fault),
            Self::Done | Self::Interrupted => None,
        }
    }
}
