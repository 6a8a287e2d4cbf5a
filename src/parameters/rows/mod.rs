//! The rows, by what they are about.

use super::parameter_row::{ANY, PanelSection, ParameterRow, Scale};

pub mod bridge_choices;
pub mod driving;
pub mod liquid_and_bridges;
pub mod material_pairs;
pub mod material_properties;
pub mod run;
pub mod sizes;

/// What rows of parameters that act from the next start on have in common.
const AT_START: ParameterRow = ParameterRow {
    section: PanelSection::Start,
    scale: Scale::AsTheRangeAsks,
    ..ANY
};
