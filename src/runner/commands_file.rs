//! `--commands FILE`: commands to carry out when their time comes.
//!
//! In: a RON or JSON file with a list of `(time or step, command)`, or the `summary.json` of an
//! earlier run or a list or a session saved in the window, whose commands are then carried out
//! again. Out: the list, or an error that says where it is wrong.

use super::RunnerError;
use crate::files::read_whole;
use crate::run::{ScriptedCommand, Session};
use ron::extensions::Extensions;
use serde::Deserialize;
use std::io;
use std::path::Path;

/// Largest file that is read [bytes]: a record may be one.
const LARGEST_FILE: u64 = 256 << 20;

/// What a JSON file may be.
#[derive(Deserialize)]
struct Recorded {
    commands: Vec<ScriptedCommand>,
}

/// The commands in the file at `path`: a session where it says so, JSON where its name ends so, RON
/// otherwise.
///
/// # Errors
/// When the file cannot be read or is no such list.
pub fn read_commands(path: &Path) -> Result<Vec<ScriptedCommand>, RunnerError> {
    let name = path.display();
    let refuse = |reason: String| {
        RunnerError::Input(format!(
            "{name}: {reason}; expected a list of commands such as \
             [(time: 2.5, command: Set(parameter: \"drum-speed\", value: 0.1))], or a run's summary.json"
        ))
    };
    if Session::is_at(path) {
        let session = Session::read(path).map_err(|e| RunnerError::Input(e.to_string()))?;
        return Ok(session.into_record().commands);
    }
    let text = read_whole(path, LARGEST_FILE)
        .and_then(|bytes| String::from_utf8(bytes).map_err(io::Error::other))
        .map_err(|error| refuse(format!("cannot be read: {error}")))?;
    let json = path
        .extension()
        .is_some_and(|extension| extension == "json");
    if !json {
        return ron::Options::default()
            .with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_NEWTYPES)
            .from_str(&text)
            .map_err(|error| refuse(error.to_string()));
    }
    let parsed = if text.trim_start().starts_with('[') {
        serde_json::from_str(&text)
    } else {
        serde_json::from_str::<Recorded>(&text).map(|file| file.commands)
    };
    parsed.map_err(|error| refuse(error.to_string()))
}
