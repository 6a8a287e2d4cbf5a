//! What the scene is, what to look for, where its numbers come from.

use crate::simulation::Simulation;
use crate::ui::panel::Panel;
use crate::ui::request::Request;
use crate::ui::words::names::{title_in_words, value_in_words};
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText};
use grainfall::parameters::Parameter;
use grainfall::scene::Scene;

/// The panel about the scene.
#[derive(Default)]
pub struct AboutScene;

impl Panel for AboutScene {
    fn title(&self) -> &'static str {
        "Scene"
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        _view: &mut ViewSettings,
        _out: &mut Vec<Request>,
    ) {
        let scene = simulation.scene();
        ui.label(RichText::new(title_in_words(simulation)).strong());
        if !scene.look_for.is_empty() {
            ui.label(&scene.look_for);
        }
        if !scene.source.is_empty() {
            ui.label(RichText::new(&scene.source).small().weak());
        }
        ui.label(RichText::new(outline(scene)).small().weak());
    }
}

/// Grains, law and seed in one line, the seed as the registry of parameters has it.
fn outline(scene: &Scene) -> String {
    let grains = scene.grain_count();
    let law = scene.law.words().name;
    let noun = if grains == 1 { "grain" } else { "grains" };
    let seed = Parameter::Seed;
    let name = (seed.row().name)(scene);
    let value = (seed.stated(scene)).map_or_else(String::new, |value| value_in_words(&seed, value));
    format!("{grains} {noun} · {law} · {name} {value}")
}
