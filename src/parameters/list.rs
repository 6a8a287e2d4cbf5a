//! The parameters of a scene, each with what values it can take there.
//!
//! In: a scene, and its world at time zero. Out: a list of [`ParameterInfo`], one per parameter, in
//! the order of the registry.

use super::parameter::{Entry, NameKind, Parameter, entries};
use super::parameter_row::{Names, PanelSection, ParameterRow, Preset};
use super::value::{Choice, Value};
use crate::physics::limits;
use crate::scene::{Scene, SceneMaterial};
use crate::world::World;
use std::ops::RangeInclusive;

/// The material that several named values are called after.
const GLASS: &str = "glass";

/// A parameter of a scene, and all that a field or a slider needs to know of it.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterInfo {
    /// Which one.
    pub parameter: Parameter,
    /// What people call it: `friction glass – drum`.
    pub label: String,
    /// What it can be.
    pub values: Values,
    /// The scene's value.
    pub default: Value,
    /// Whether it does anything in the scene. What does nothing is not offered, but records in
    /// which it was set are read.
    pub acts: bool,
}

/// What a parameter can be in a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// A number or a count in this range [SI unit].
    Range(RangeInclusive<f64>),
    /// One of these.
    Choices(&'static [Choice]),
}

impl ParameterInfo {
    /// What is known of it in all scenes.
    pub fn row(&self) -> &'static ParameterRow {
        self.parameter.row()
    }

    /// Its named values in `scene`: for the friction of grains of several materials that of each of
    /// these, and nothing that is called after glass where there is none.
    pub fn presets<'a>(&self, scene: &'a Scene) -> Vec<Preset<'a>> {
        let common = self.row().presets.iter().copied();
        let Some((a, b)) = self.parameter.pair() else {
            return common.collect();
        };
        let of_grains: Vec<&SceneMaterial> = (scene.materials.iter())
            .filter(|material| scene.has_grains_of(&material.name))
            .collect();
        let is_friction = matches!(self.parameter, Parameter::Friction(..));
        if is_friction && of_grains.len() > 1 {
            let own = of_grains.iter().map(|material| Preset {
                name: &material.name,
                value: material.friction,
            });
            return common
                .filter(|preset| preset.value == 0.0)
                .chain(own)
                .collect();
        }
        let is_glass = [a, b].iter().any(|name| name.contains(GLASS));
        common
            .filter(|preset| is_glass || !preset.name.contains(GLASS))
            .collect()
    }

    /// The range of its numbers; of choices that of the numbers that stand for them.
    pub fn range(&self) -> RangeInclusive<f64> {
        match &self.values {
            Values::Range(range) => range.clone(),
            Values::Choices(choices) => {
                let numbers = choices.iter().map(|choice| choice.number);
                let most = numbers.clone().fold(f64::NEG_INFINITY, f64::max);
                numbers.fold(f64::INFINITY, f64::min)..=most
            }
        }
    }
}

impl Parameter {
    /// Its present value in `world`; `None` where that has no such parameter, or it cannot change
    /// while a run goes on.
    pub fn read(&self, world: &World) -> Option<Value> {
        let own = self.row().in_world.as_ref()?;
        (own.read)(world, self.names())
    }

    /// Gives `world`, a world of `scene`, the `value` for it. A world that does not have it is left
    /// alone.
    pub fn write(&self, value: Value, scene: &Scene, world: &mut World) {
        if let Some(own) = &self.row().in_world {
            (own.write)(world, scene, self.names(), value);
        }
    }
}

/// The parameters of `scene` that can change while a run goes on, whose world at time zero is
/// `world`.
pub fn live_parameters(scene: &Scene, world: &World) -> Vec<ParameterInfo> {
    let live = |row: &ParameterRow| row.is_live();
    let info = |parameter: Parameter| {
        let default = parameter.read(world)?;
        Some(info(parameter, default, scene))
    };
    parameters_of(scene, live).filter_map(info).collect()
}

/// The time step of a run whose first one is `step` [s]. It is none of the [`live_parameters`],
/// which are physics; a run takes commands about it all the same.
pub fn time_step(step: f64) -> ParameterInfo {
    let parameter = Parameter::TimeStep;
    let steps = &limits::TIME_STEP;
    ParameterInfo {
        label: "time step".to_owned(),
        values: Values::Range(steps.least..=steps.most),
        default: step.into(),
        acts: true,
        parameter,
    }
}

/// The parameters of `scene` that act from the next start on and that panels show.
pub fn start_parameters(scene: &Scene) -> Vec<ParameterInfo> {
    let all = stated_parameters(scene).into_iter();
    all.filter(|info| info.row().section == PanelSection::Start && info.acts)
        .collect()
}

/// The parameters of `scene` that act from the next start on.
pub fn stated_parameters(scene: &Scene) -> Vec<ParameterInfo> {
    let at_start = |row: &ParameterRow| !row.is_live();
    let info = |parameter: Parameter| {
        let default = parameter.in_effect(scene)?;
        Some(info(parameter, default, scene))
    };
    parameters_of(scene, at_start).filter_map(info).collect()
}

fn info(parameter: Parameter, default: Value, scene: &Scene) -> ParameterInfo {
    let row = parameter.row();
    let values = match default {
        Value::Choice(_) => Values::Choices(row.kind.choices()),
        number => Values::Range(row.range(number.number(), scene, parameter.names())),
    };
    ParameterInfo {
        label: label(&parameter, scene),
        values,
        default,
        acts: (row.acts)(scene, parameter.names()),
        parameter,
    }
}

/// What people call `parameter` in `scene`: `friction glass – drum`.
pub fn label(parameter: &Parameter, scene: &Scene) -> String {
    let name = (parameter.row().name)(scene);
    let [a, b] = parameter.names();
    match parameter.name_kind() {
        NameKind::None => name.to_owned(),
        NameKind::Material | NameKind::Species => format!("{name} {a}"),
        NameKind::Pair => format!("{name} {a} – {b}"),
    }
}

/// The parameters that `scene` has, of rows that are `wanted`. Those about the same names stand
/// together.
fn parameters_of(
    scene: &Scene,
    wanted: impl Fn(&ParameterRow) -> bool,
) -> impl Iterator<Item = Parameter> {
    let alike = |one: &Entry, other: &Entry| one.name_kind == other.name_kind;
    let mut all = Vec::new();
    for group in entries().chunk_by(alike) {
        let names = group.first().map(|entry| names_in(scene, entry.name_kind));
        for names in names.unwrap_or_default() {
            let own = group.iter().filter(|entry| wanted(entry.row));
            let own = own.filter(|entry| (entry.row.exists)(scene, names));
            all.extend(own.map(|entry| (entry.of)(names)));
        }
    }
    all.into_iter()
}

/// All names that parameters of `scene` can be about.
fn names_in(scene: &Scene, name_kind: NameKind) -> Vec<Names<'_>> {
    let materials = || {
        scene
            .materials
            .iter()
            .map(|material| material.name.as_str())
    };
    match name_kind {
        NameKind::None => vec![["", ""]],
        NameKind::Material => materials().map(|name| [name, ""]).collect(),
        NameKind::Species => scene.species().iter().map(|s| [s.0, ""]).collect(),
        NameKind::Pair => {
            let pairs = materials().enumerate().flat_map(|(index, a)| {
                let others = materials().skip(index);
                others.map(move |b| [a, b])
            });
            pairs.filter(|pair| is_of_grains(scene, *pair)).collect()
        }
    }
}

/// Whether grains are made of one of the two materials, and grains or walls of the other.
fn is_of_grains(scene: &Scene, [a, b]: Names) -> bool {
    let is_body = |name| scene.has_grains_of(name) || scene.has_walls_of(name);
    let has_grains = scene.has_grains_of(a) || scene.has_grains_of(b);
    has_grains && is_body(a) && is_body(b)
}
