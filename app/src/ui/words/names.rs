//! What people call a scene, a parameter and a value of it.
//!
//! In: the simulation. Out: text for panels, plots and the picture.

use crate::simulation::Simulation;
use crate::ui::words::number;
use grainfall::lab::RunView;
use grainfall::parameters::{Parameter, Value};
use grainfall::physics::{Liquid, LiquidCase};
use grainfall::run::Setting;

/// What people call `parameter`.
pub fn parameter_name(parameter: &Parameter, simulation: &RunView) -> String {
    let info = simulation.info_of(parameter);
    info.map_or_else(|| parameter.to_string(), |info| info.label)
}

/// A value of `parameter` with the unit that people think in.
pub fn value_in_words(parameter: &Parameter, value: Value) -> String {
    let unit = parameter.row().kind.unit().shown.name;
    let space = if unit.is_empty() { "" } else { " " };
    format!("{}{space}{unit}", bare_value(parameter, value))
}

/// The title of the scene, which may name its liquid; where there is another liquid now than the
/// scene stated when it was opened, or none, with that.
pub fn title_in_words(simulation: &Simulation) -> String {
    let title = &simulation.scene().title;
    let stated = simulation.original().liquid;
    let now = match simulation.world() {
        Some(world) => world.wetting().copied(),
        None => simulation.scene().liquid,
    };
    let stated = stated.filter(|liquid| liquid.volume > 0.0);
    let changed = match (stated, now.filter(|liquid| liquid.volume > 0.0)) {
        (None, None) => return title.clone(),
        (Some(stated), Some(now)) if stated.is_same_substance(&now) => return title.clone(),
        (_, None) => "dry".to_owned(),
        (_, Some(now)) => liquid_in_words(&now),
    };
    format!("{title} · now {changed}")
}

/// The name that `liquid` has in Table 1 of the paper, or else its viscosity.
fn liquid_in_words(liquid: &Liquid) -> String {
    if let Some(case) = LiquidCase::of_liquid(liquid) {
        return case.name.to_owned();
    }
    let viscosity = Value::Number(liquid.viscosity);
    format!("η = {}", value_in_words(&Parameter::Viscosity, viscosity))
}

/// `friction glass – glass 0.4 → 0.2`; from the scene's value where it had not been changed before.
pub fn setting_in_words(setting: &Setting, simulation: &RunView) -> String {
    let parameter = &setting.parameter;
    let info = simulation.info_of(parameter);
    let from = setting.before.or(info.map(|info| info.default));
    let from = from.map_or(String::new(), |from| bare_value(parameter, from));
    let to = value_in_words(parameter, setting.value);
    format!("{} {from} → {to}", parameter_name(parameter, simulation))
}

/// A value of `parameter` in the unit that people think in, without that unit.
pub fn bare_value(parameter: &Parameter, value: Value) -> String {
    match value {
        Value::Choice(choice) => choice.name.to_owned(),
        Value::Number(_) | Value::Count(_) => {
            number::trimmed(value.number() * parameter.row().kind.unit().shown.factor)
        }
    }
}
