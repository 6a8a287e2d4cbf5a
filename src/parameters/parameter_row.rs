//! A row of the registry: all that is known of one parameter.
//!
//! In: nothing. Out: the types of which `rows` is made. A row says what its parameter is called,
//! what it takes, what it does, and how it is read from and written to a scene or a world. Panels,
//! command lines, scripts and documents take what they show and accept from it.

use super::value::{Choice, Value};
use crate::physics::Unit;
use crate::physics::limits::Limits;
use crate::scene::Scene;
use crate::world::World;
use std::ops::RangeInclusive;

/// The names that a parameter is about; empty ones where there are fewer.
pub type Names<'a> = [&'a str; 2];

/// All that is known of a parameter.
pub struct ParameterRow {
    /// The key of `--set` and of command lists, without the names it is about.
    pub key: &'static str,
    /// What people call it in a scene, without the names it is about.
    pub name: fn(&Scene) -> &'static str,
    /// What stands beside it under a heading that says the rest; empty where that is its name.
    pub short_name: &'static str,
    /// The papers' symbol, empty where there is none.
    pub symbol: &'static str,
    /// What values it takes, and in which unit.
    pub kind: Kind,
    /// What `--set` takes before a run, in words; empty where that follows from `kind`.
    pub expected: &'static str,
    /// The values that validation accepts; none where a scene's check has no row of limits for it.
    pub limits: Option<&'static Limits>,
    /// What a slider offers, and a run accepts, where the scene's own value is given: it is within
    /// the limits in any case.
    pub slider: fn(f64, &Scene, Names) -> RangeInclusive<f64>,
    /// How a slider goes through that range.
    pub scale: Scale,
    /// Values that have a name.
    pub presets: &'static [Preset<'static>],
    /// One sentence: what it does.
    pub description: &'static str,
    /// Where it stands in the equations of the papers, in the contact law of a scene; empty where
    /// it does not.
    pub equation: fn(&Scene) -> &'static str,
    /// Where panels show it.
    pub section: PanelSection,
    /// Whether it is one of the few that matter most in a scene.
    pub is_basic: fn(&Scene, Names) -> bool,
    /// How soon it is proposed where two runs are to be compared: 0 is first, among those that
    /// matter most.
    pub rank: u8,
    /// Whether it says nothing about a dry scene: a sweep from dry to wet sets it where it has a
    /// meaning.
    pub is_of_liquid: bool,
    /// Whether a scene has it.
    pub exists: fn(&Scene, Names) -> bool,
    /// Whether it does anything in a scene that has it: where it does not, it is not offered, but
    /// records in which it was set are read.
    pub acts: fn(&Scene, Names) -> bool,
    /// How it is read from a scene and written to it, where `--set` does so before a run.
    pub in_scene: Option<InScene>,
    /// The value in effect, where that need not be the one that a scene states: the step that
    /// `automatic` chooses.
    pub in_effect: Option<fn(&Scene) -> Value>,
    /// How it is read from a world and written to it, where it can change while a run goes on.
    pub in_world: Option<InWorld>,
}

/// How a parameter is read from a scene and written to it. The scene is checked after it was
/// written.
pub struct InScene {
    /// Its value; `None` where the scene has no such parameter, or it does not act there.
    pub read: fn(&Scene, Names) -> Option<Value>,
    /// Puts a value in place; `None` where the scene has no room for it.
    pub write: fn(&mut Scene, Names, Value) -> Option<()>,
}

/// How a parameter is read from a world and written to it.
pub struct InWorld {
    /// Its value; `None` where the world has no such parameter.
    pub read: fn(&World, Names) -> Option<Value>,
    /// Puts a value in place, in a world of this scene; a world without the parameter is left
    /// alone.
    pub write: fn(&mut World, &Scene, Names, Value),
}

/// What values a parameter takes.
#[derive(Debug, PartialEq)]
pub enum Kind {
    /// A number in this unit.
    Number(&'static Unit),
    /// A number in this unit, or the choice that leaves it to the program.
    NumberOr(&'static Unit, &'static [Choice]),
    /// How many.
    Count,
    /// One of these.
    Choice(&'static [Choice]),
}

/// How a slider goes through its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Even,
    /// By powers of ten.
    PowersOfTen,
    /// By powers of ten where the range spans more than a factor of twenty.
    AsTheRangeAsks,
}

/// Where panels show a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PanelSection {
    /// Among what a liquid is.
    Liquid,
    /// Among how bodies meet, under the names of their materials.
    Contact,
    /// With the drum.
    Drum,
    /// With gravity.
    Gravity,
    /// With the mixture.
    Mixture,
    /// Among what acts from the next start on.
    Start,
    /// Nowhere: it is for command lines.
    Nowhere,
}

/// A value with a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset<'a> {
    /// What people call it.
    pub name: &'a str,
    /// The value in SI units.
    pub value: f64,
}

/// A preset.
pub(super) const fn preset(name: &'static str, value: f64) -> Preset<'static> {
    Preset { name, value }
}

/// What rows have in common: they take this from here and say what is their own.
pub(super) const ANY: ParameterRow = ParameterRow {
    key: "",
    name: |_| "",
    short_name: "",
    symbol: "",
    kind: Kind::Number(&crate::physics::units::PURE),
    expected: "",
    limits: None,
    slider: |value, _, _| value..=value,
    scale: Scale::Even,
    presets: &[],
    description: "",
    equation: |_| "",
    section: PanelSection::Nowhere,
    is_basic: |_, _| false,
    rank: 3,
    is_of_liquid: false,
    exists: |_, _| true,
    acts: |_, _| true,
    in_scene: None,
    in_effect: None,
    in_world: None,
};

impl ParameterRow {
    /// Whether it acts at once, also while a run goes on, and is shown so; others act from the next
    /// start on. The time step is shown among these, though a command can change it on the way.
    pub fn is_live(&self) -> bool {
        self.in_world.is_some() && self.section != PanelSection::Start
    }

    /// What `--set` takes before a run, in words.
    pub fn expected(&self) -> String {
        if self.expected.is_empty() {
            self.kind.expected()
        } else {
            self.expected.to_owned()
        }
    }

    /// The value that `text` states: of a choice its word or the number that stands for it.
    pub fn parse(&self, text: &str) -> Option<Value> {
        let text = text.trim();
        let choices = self.kind.choices();
        let is_named = |choice: &&Choice| choice.key == text || text.parse() == Ok(choice.number);
        match &self.kind {
            Kind::Number(unit) => unit.parse(text).map(Value::Number),
            Kind::Count => text.parse().ok().map(Value::Count),
            Kind::Choice(_) => choices.iter().find(is_named).map(Value::Choice),
            Kind::NumberOr(unit, _) => {
                let word = choices.iter().find(|choice| choice.key == text);
                let number = || unit.parse(text).map(Value::Number);
                word.map(Value::Choice).or_else(number)
            }
        }
    }

    /// The value for `number`, which a field or a slider shows in SI units.
    pub fn value(&self, number: f64) -> Value {
        match &self.kind {
            Kind::Number(_) | Kind::NumberOr(..) => Value::Number(number),
            Kind::Count => Value::Count(number.round() as u64),
            Kind::Choice(choices) => {
                let own = choices.iter().find(|choice| choice.number == number);
                own.map_or(Value::Number(number), Value::Choice)
            }
        }
    }

    /// The range that is offered where the scene's own value is `default`.
    pub fn range(&self, default: f64, scene: &Scene, names: Names) -> RangeInclusive<f64> {
        let (low, high) = (self.slider)(default, scene, names).into_inner();
        let Some(limits) = self.limits else {
            return low..=high;
        };
        low.max(limits.least)..=high.min(limits.most)
    }

    /// Whether a slider over `range` goes by powers of ten.
    pub fn is_logarithmic(&self, range: &RangeInclusive<f64>) -> bool {
        match self.scale {
            Scale::Even => false,
            Scale::PowersOfTen => true,
            Scale::AsTheRangeAsks => *range.start() > 0.0 && range.end() / range.start() > 20.0,
        }
    }
}

impl Kind {
    /// The units of its numbers; those of a pure number where it is a count or a choice.
    pub fn unit(&self) -> &'static Unit {
        match self {
            Self::Number(unit) | Self::NumberOr(unit, _) => unit,
            Self::Count | Self::Choice(_) => &crate::physics::units::PURE,
        }
    }

    /// Its choices, if it has any.
    pub fn choices(&self) -> &'static [Choice] {
        match self {
            Self::Choice(choices) | Self::NumberOr(_, choices) => choices,
            Self::Number(_) | Self::Count => &[],
        }
    }

    /// What it takes, in words.
    pub fn expected(&self) -> String {
        let words: Vec<String> = (self.choices().iter())
            .map(|choice| format!("`{}`", choice.key))
            .collect();
        let words = words.join(" or ");
        match self {
            Self::Number(unit) | Self::NumberOr(unit, _) => {
                let (si, shown) = (unit.si, unit.shown.name);
                let number = format!("a number in SI units ({si}), or one with its unit {shown}");
                match words.as_str() {
                    "" => number,
                    words => format!("{words}, or {number}"),
                }
            }
            Self::Count => "a whole number of at least 0".to_owned(),
            Self::Choice(_) => words,
        }
    }
}
