//! The rows, by what they are about.

use super::row::{ANY, Place, Row, Scale};

pub mod contact;
pub mod liquid;
pub mod materials;
pub mod motion;
pub mod run;
pub mod sizes;

/// What rows of parameters that act from the next start on have in common.
const AT_START: Row = Row {
    place: Place::Start,
    scale: Scale::AsTheRangeAsks,
    ..ANY
};
