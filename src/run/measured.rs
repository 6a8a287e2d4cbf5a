//! What was measured of a run, and how much of it stands in files.
//!
//! In: samples and profiles as a run takes them. Out: the same, as those who write files and those
//! who let a run forget tell each other. A run without a window writes what it measures as it goes:
//! were all of it kept in memory too, that would grow for as long as the run.

use crate::measure::{FlowHistory, Series};
use std::sync::Arc;

/// How much of what was measured stands in files, so that a run may forget it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stored {
    /// Samples, from the first on.
    pub samples: usize,
    /// Seconds of the flowing layer, from time zero on.
    pub seconds: usize,
}

/// All that was measured of a run.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// The samples.
    pub series: Arc<Series>,
    /// The flowing layer.
    pub flow: Arc<FlowHistory>,
}
