//! How much of a scene the controls show: the few numbers that matter, or all of them.
//!
//! Which ones matter stands in the rows of [`grainfall::parameters`].

use bevy_egui::egui::{self, Id};
use grainfall::parameters::ParameterInfo;
use grainfall::scene::Scene;

/// How much the controls show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Detail {
    /// The few that matter for the scene, with named values.
    #[default]
    Basics,
    /// Every one, with range, default and equation.
    Lab,
}

impl Detail {
    /// What was chosen last, if anything was.
    pub fn chosen(ctx: &egui::Context) -> Option<Self> {
        ctx.data(|data| data.get_temp(Id::new("detail")))
    }

    /// What is shown.
    pub fn of(ctx: &egui::Context) -> Self {
        Self::chosen(ctx).unwrap_or_default()
    }

    /// Chooses it, for all panels from now on.
    pub fn choose(self, ctx: &egui::Context) {
        ctx.data_mut(|data| data.insert_temp(Id::new("detail"), self));
    }

    /// Draws the choice.
    pub fn ui(ui: &mut egui::Ui) -> Self {
        let mut chosen = Self::of(ui.ctx());
        ui.horizontal(|ui| {
            ui.selectable_value(&mut chosen, Self::Basics, "Basics")
                .on_hover_text("The few values that matter most here");
            ui.selectable_value(&mut chosen, Self::Lab, "Lab")
                .on_hover_text("Every value, with its range and its equation");
        });
        chosen.choose(ui.ctx());
        chosen
    }
}

/// Whether the parameter of `info` is one of the few that matter for `scene`.
pub fn is_basic(info: &ParameterInfo, scene: &Scene) -> bool {
    (info.row().is_basic)(scene, info.parameter.names())
}
