//! The register of panels: which stand on which side at first, and which of them are open.
//!
//! In: the desk that parameter sweeps are asked at. Out: every panel in its place.

use crate::ui::panels::about_scene::AboutScene;
use crate::ui::panels::avalanche_plots::AvalanchePlots;
use crate::ui::panels::beside_paper::BesidePaper;
use crate::ui::panels::changes::ChangeList;
use crate::ui::panels::collapse_plots::CollapsePlots;
use crate::ui::panels::column_beside_paper::ColumnBesidePaper;
use crate::ui::panels::compare::Compare;
use crate::ui::panels::energy_stack::EnergyStack;
use crate::ui::panels::events::Events;
use crate::ui::panels::explorer::Explorer;
use crate::ui::panels::flow_over_depth::FlowOverDepth;
use crate::ui::panels::grains::Grains;
use crate::ui::panels::mean_velocities::MeanVelocities;
use crate::ui::panels::microscope::Microscope;
use crate::ui::panels::parameter_sweep::ParameterSweep;
use crate::ui::panels::parameters::Parameters;
use crate::ui::panels::picture_settings::PictureSettings;
use crate::ui::panels::results::Results;
use crate::ui::panels::solver_profile::SolverProfile;
use crate::ui::sections::{Section, section};
use crate::ui::sweep_desk::SweepDesk;

/// The panels on the left and on the right, from top to bottom, and whether each is open at first.
pub fn register(sweeps: &SweepDesk) -> [Vec<Section>; 2] {
    [left(sweeps), right()]
}

fn left(sweeps: &SweepDesk) -> Vec<Section> {
    vec![
        section(AboutScene, true),
        section(Parameters::default(), true),
        section(Compare::default(), false),
        section(ParameterSweep::of(sweeps), false),
        section(ChangeList::default(), true),
        section(PictureSettings, false),
        section(SolverProfile, false),
    ]
}

fn right() -> Vec<Section> {
    vec![
        section(Microscope::default(), false),
        section(AvalanchePlots::default(), true),
        section(CollapsePlots::default(), true),
        section(Events::default(), false),
        section(Explorer::default(), false),
        section(Grains::default(), false),
        section(EnergyStack, false),
        section(MeanVelocities::default(), false),
        section(FlowOverDepth::default(), false),
        section(BesidePaper::default(), true),
        section(ColumnBesidePaper, true),
        section(Results::default(), true),
    ]
}
