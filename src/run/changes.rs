//! The changes of a run one by one: which parameters got which values.
//!
//! In: the commands carried out, a slice for each change. Out: a [`Change`] for each of them, with the values before it. A
//! drag or a button may take several commands.

use super::{Command, StampedCommand};
use crate::parameters::{Parameter, Value};
use std::collections::BTreeMap;

/// A change that was made to a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Steps taken when it began.
    pub step: u64,
    /// Simulated time then [s].
    pub time: f64,
    /// What it set, at least one.
    pub set: Vec<Setting>,
}

/// A parameter that was given a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Which one.
    pub parameter: Parameter,
    /// Its value before; none where it had not been changed.
    pub before: Option<Value>,
    /// Its value from then on; that at the end of the change.
    pub value: Value,
}

/// The changes whose commands these are, in order.
pub fn changes<'a>(commands: impl Iterator<Item = &'a [StampedCommand]>) -> Vec<Change> {
    let mut values = BTreeMap::new();
    let changes = commands.filter_map(|commands| {
        let first = commands.first()?;
        let set = settings(commands, &mut values);
        (!set.is_empty()).then_some(Change {
            step: first.step,
            time: first.time,
            set,
        })
    });
    changes.collect()
}

/// What the `commands` of one change set, in the order of the parameters; all `values` so far
/// follow.
fn settings<'a>(
    commands: &'a [StampedCommand],
    values: &mut BTreeMap<&'a Parameter, Value>,
) -> Vec<Setting> {
    let mut set: BTreeMap<&Parameter, (Option<Value>, Value)> = BTreeMap::new();
    for stamped in commands {
        if let Command::Set { parameter, value } = &stamped.command {
            let before = values.insert(parameter, *value);
            set.entry(parameter).or_insert((before, *value)).1 = *value;
        }
    }
    let settings = set.into_iter().map(|(parameter, (before, value))| Setting {
        parameter: parameter.clone(),
        before,
        value,
    });
    settings.collect()
}
