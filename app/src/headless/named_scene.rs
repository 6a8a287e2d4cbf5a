//! The scene that a person names on the command line.

use grainfall::scene::{Scene, SceneError};
use std::io;
use std::path::Path;

/// What stands for a scene on standard input.
const STANDARD_INPUT: &str = "-";

/// The scene called `name`: on standard input, in a file, or built in.
///
/// # Errors
/// When there is none, or it is wrong.
pub fn named_scene(name: &str) -> Result<Scene, SceneError> {
    if name == STANDARD_INPUT {
        return Scene::read(io::stdin().lock(), "standard input");
    }
    Scene::open(name)
}

/// What files of the scene called `name` are called: `scenes/papers/kasper2021/dry-r3.ron` is
/// `dry-r3`, and what comes on standard input `scene`.
pub fn short_name(name: &str) -> String {
    let file = name.strip_suffix(".ron").unwrap_or(name);
    let file = Path::new(file).file_name();
    file.filter(|_| name != STANDARD_INPUT).map_or_else(
        || "scene".into(),
        |file| file.to_string_lossy().into_owned(),
    )
}
