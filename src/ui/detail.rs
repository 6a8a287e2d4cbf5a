//! How much of a scene the controls show: the few numbers that matter, or all of them.

use crate::scene::{Scene, SceneContainer, SceneGrains};
use crate::simulation::{Parameter, ParameterInfo};
use crate::ui::widgets::value_row::Landmark;
use bevy_egui::egui::{self, Id};

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
    let is_listed = matches!(scene.grains, SceneGrains::List(_));
    let is_wet = scene.liquid.is_some();
    // Grains of one kind among each other; a few listed grains also on what they fall or roll on.
    let of_note = |a: &str, b: &str| is_listed || (a == b && scene.has_grains_of(a));
    match &info.parameter {
        Parameter::DrumSpeed | Parameter::Viscosity | Parameter::LiquidVolume => true,
        Parameter::Gravity => !matches!(scene.container, SceneContainer::Drum { .. }),
        Parameter::Share(species) => scene.species().last().is_some_and(|last| last.0 == species),
        Parameter::Friction(a, b) => !is_wet && of_note(a, b),
        Parameter::WetFriction(a, b) => of_note(a, b),
        Parameter::Restitution(..) => is_listed,
        Parameter::RollingFriction(..)
        | Parameter::SurfaceTension
        | Parameter::ContactAngle
        | Parameter::BridgeLaw
        | Parameter::TimeStep => false,
    }
}

const fn named(name: &'static str, value: f64) -> Landmark {
    Landmark { name, value }
}

const ROUND: f64 = 30.0 / std::f64::consts::PI;

/// Values of `parameter` that have a name. Those of liquids are buttons of their own.
pub fn landmarks(parameter: &Parameter) -> &'static [Landmark] {
    match parameter {
        Parameter::Friction(..) => {
            &const {
                [
                    named("none", 0.0),
                    named("smooth", 0.1),
                    named("dry glass", 0.4),
                    named("rough", 0.8),
                ]
            }
        }
        Parameter::WetFriction(..) => {
            &const {
                [
                    named("none", 0.0),
                    named("wet glass", 0.1),
                    named("dry glass", 0.4),
                ]
            }
        }
        Parameter::RollingFriction(..) => &const { [named("none", 0.0), named("glass", 0.01)] },
        Parameter::Restitution(..) => {
            &const {
                [
                    named("dull", 0.1),
                    named("glass on the drum", 0.72),
                    named("glass", 0.95),
                    named("no loss", 1.0),
                ]
            }
        }
        Parameter::Gravity => {
            &const {
                [
                    named("none", 0.0),
                    named("Moon", 1.62),
                    named("Mars", 3.71),
                    named("Earth", 9.81),
                ]
            }
        }
        Parameter::DrumSpeed => {
            &const {
                [
                    named("still", 0.0),
                    named("the paper's", 0.5 / ROUND),
                    named("ten times", 5.0 / ROUND),
                ]
            }
        }
        Parameter::Share(_) => {
            &const { [named("none", 0.0), named("half", 0.5), named("all", 1.0)] }
        }
        Parameter::LiquidVolume => &const { [named("as in the paper", 4e-6)] },
        Parameter::SurfaceTension => {
            &const { [named("glycerol", 63.4e-3), named("water", 72.8e-3)] }
        }
        Parameter::Viscosity
        | Parameter::ContactAngle
        | Parameter::BridgeLaw
        | Parameter::TimeStep => &[],
    }
}
