//! The scene that a person names on the command line.

use super::shell::misspelt_command;
use crate::runner::RunnerError;
use crate::scene::Scene;
use std::io;

/// What stands for a scene on standard input.
const STANDARD_INPUT: &str = "-";

/// The scene called `name`: on standard input, in a file, or built in.
///
/// # Errors
/// When there is none, or it is wrong; of a word that is almost a command it says so.
pub fn named_scene(name: &str) -> Result<Scene, RunnerError> {
    if name == STANDARD_INPUT {
        return Ok(Scene::read(io::stdin().lock(), "standard input")?);
    }
    Scene::open(name).map_err(|error| match misspelt_command(name) {
        Some(problem) => RunnerError::Input(problem),
        None => error.into(),
    })
}

/// What files of the scene called `name` are called: `scenes/papers/kasper2021/dry-r3.ron` is
/// `dry-r3`, and what comes on standard input `scene`.
pub fn short_name(name: &str) -> String {
    let file = name.strip_suffix(".ron").unwrap_or(name);
    let file = std::path::Path::new(file).file_name();
    file.filter(|_| name != STANDARD_INPUT).map_or_else(
        || "scene".into(),
        |file| file.to_string_lossy().into_owned(),
    )
}
