//! The registry of parameters: every value of a scene that people can change, once.
//!
//! In: a scene, a world, a key, a value as text. Out: what parameters there are, what each is
//! called, what it takes and does, and the scene or the world with another value. Command lines
//! (`--set`, `--vary`), scripts, panels, help, lists of changes and documents all read from here.
//! Hard limits and units are rows of [`crate::physics`], which validation of scenes reads too. How
//! commands are stamped, kept and repeated is not here: [`crate::run`] does that.
//!
//! | file | holds |
//! |---|---|
//! | `parameter` | the list of parameters: each with its names and its row; their keys |
//! | `parameter_row` | what a row says |
//! | `rows` | the rows, by what they are about |
//! | `value`, `stored` | numbers, counts and choices; how files hold them |
//! | `list` | the parameters of one scene, with their ranges |
//! | `set` | another value for a scene, before a run |
//! | `settings` | all of them as a table |
//! | `relabel` | mixing ratios by the species' names |
//!
//! **To add a parameter**, write its row in a file of `rows` and its line in the list of
//! [`Parameter`].

mod list;
mod parameter;
mod parameter_row;
mod relabel;
mod rows;
mod set;
mod settings;
mod stored;
mod value;

pub use list::{
    ParameterInfo, Values, label, live_parameters, start_parameters, stated_parameters, time_step,
};
pub use parameter::{Entry, NameKind, Parameter, Unsuited, entries};
pub use parameter_row::{InScene, InWorld, Kind, Names, PanelSection, ParameterRow, Preset, Scale};
pub use settings::{Setting, Settings, table_of_keys};
pub use value::{Choice, Value};
