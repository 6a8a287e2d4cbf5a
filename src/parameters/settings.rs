//! The parameters of a scene as a table, for people and for programs.
//!
//! In: a scene. Out: a row for each parameter that does something there, with its value, what
//! values it takes, when it acts and what it does. A second table lists the keys of all scenes, as
//! `scenes/README.md` shows it.

use super::list::{ParameterInfo, Values, live_parameters, stated_parameters};
use super::parameter::entries;
use super::value::Value;
use crate::physics::Unit;
use crate::scene::Scene;
use crate::solver::advise;
use crate::world::build;
use serde::Serialize;
use std::fmt::{self, Write};
use std::ops::RangeInclusive;

/// All parameters of a scene.
pub struct Settings {
    list: Vec<Setting>,
}

/// A parameter of a scene, numbers in SI units.
#[derive(Clone, Debug, Serialize)]
pub struct Setting {
    /// What `--set` and command lists call it.
    pub key: String,
    /// What people call it.
    pub label: String,
    /// The papers' symbol, empty where there is none.
    pub symbol: &'static str,
    /// The scene's value.
    pub value: Value,
    /// SI unit of value and range, `1` for a pure number.
    pub unit: &'static str,
    /// Its value in the unit that people think in.
    pub shown: String,
    /// Smallest and largest value that sliders offer and a run accepts, where it is a number.
    pub range: Option<RangeInclusive<f64>>,
    /// What it takes, in words.
    pub takes: String,
    /// Whether it acts at once; else from the next start on.
    pub is_live: bool,
    /// What it does.
    pub description: &'static str,
}

impl Settings {
    /// Those of `scene`. It is built for that, but not settled.
    pub fn of(scene: &Scene) -> Self {
        let world = build(scene, advise(scene).time_step);
        let live = live_parameters(scene, &world).into_iter();
        let all = live.chain(stated_parameters(scene));
        Self {
            list: all.filter(|info| info.acts).map(Setting::of).collect(),
        }
    }

    /// They, in the order of the registry, those that act at once first.
    pub fn list(&self) -> &[Setting] {
        &self.list
    }
}

impl Setting {
    fn of(info: ParameterInfo) -> Self {
        let row = info.row();
        let unit = row.kind.unit();
        let (range, takes) = match &info.values {
            Values::Range(range) => {
                let [low, high] = [range.start(), range.end()].map(|end| digits(*end, unit));
                let name = with_space(unit.shown.name);
                (Some(range.clone()), format!("{low} to {high}{name}"))
            }
            Values::Choices(_) => (None, row.kind.expected()),
        };
        Self {
            key: info.parameter.to_string(),
            symbol: row.symbol,
            value: info.default,
            unit: unit.si,
            shown: shown(info.default, unit),
            range,
            takes,
            is_live: row.is_live(),
            description: row.description,
            label: info.label,
        }
    }
}

impl fmt::Display for Settings {
    /// A table of aligned columns.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = self.list.iter().map(|setting| {
            let acts = if setting.is_live {
                "at once"
            } else {
                "at the next start"
            };
            let (key, shown, takes) = (&*setting.key, &*setting.shown, &*setting.takes);
            [key, setting.symbol, shown, takes, acts, setting.description].map(ToOwned::to_owned)
        });
        let head = ["key", "symbol", "value", "takes", "acts", "what it does"];
        let rows: Vec<_> = [head.map(ToOwned::to_owned)]
            .into_iter()
            .chain(rows)
            .collect();
        let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
        let widths: [usize; 6] = std::array::from_fn(|column| width(column).unwrap_or(0));
        for row in &rows {
            let mut line = String::new();
            for (text, width) in row.iter().zip(widths) {
                write!(line, "{text:width$}  ")?;
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// The table of all keys in Markdown, as `scenes/README.md` holds it.
pub fn table_of_keys() -> String {
    let mut table =
        String::from("| key | symbol | unit | acts | what it does |\n|---|---|---|---|---|\n");
    for entry in entries() {
        let (row, unit) = (entry.row, entry.row.kind.unit());
        let units = match (unit.si, unit.shown.name) {
            ("1", name) => name.to_owned(),
            (si, name) if si == name => si.to_owned(),
            (si, name) => format!("{si} or {name}"),
        };
        let takes = match row.kind.choices() {
            [] => units,
            _ if unit.si == "1" => row.kind.expected(),
            [choice, ..] => format!("{units} or `{}`", choice.key),
        };
        let acts = if row.is_live() {
            "at once"
        } else {
            "at the next start"
        };
        let (key, symbol, what) = (entry.key(), row.symbol, row.description);
        table += &[
            "| `", &key, "` | ", symbol, " | ", &takes, " | ", acts, " | ", what, " |\n",
        ]
        .concat();
    }
    table
}

/// `value` with the unit that people think in.
fn shown(value: Value, unit: &Unit) -> String {
    match value {
        Value::Number(number) => {
            format!("{}{}", digits(number, unit), with_space(unit.shown.name))
        }
        Value::Count(count) => count.to_string(),
        Value::Choice(choice) => choice.key.to_owned(),
    }
}

/// `number` [SI unit] in the unit shown, with six digits at most.
fn digits(number: f64, unit: &Unit) -> String {
    let shown = number * unit.shown.factor;
    let rounded: f64 = format!("{shown:.5e}").parse().unwrap_or(shown);
    rounded.to_string()
}

fn with_space(unit: &str) -> String {
    if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    }
}
