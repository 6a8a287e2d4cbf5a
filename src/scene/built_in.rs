//! The scenes that come with the program, so that it can open them wherever it runs.

use std::path::Path;

/// A scene that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuiltIn {
    /// What to call it: `dry-r3`.
    pub name: &'static str,
    /// Its file in the repository: `scenes/papers/kasper2021/dry-r3.ron`.
    pub path: &'static str,
    /// The file's text.
    pub text: &'static str,
}

macro_rules! built_in {
    ($($name:literal in $folder:literal),+ $(,)?) => {
        &[$(BuiltIn {
            name: $name,
            path: concat!("scenes/", $folder, "/", $name, ".ron"),
            text: include_str!(concat!("../../scenes/", $folder, "/", $name, ".ron")),
        }),+]
    };
}

const SCENES: &[BuiltIn] = built_in![
    "dry-r3" in "papers/kasper2021",
    "dry-r2" in "papers/kasper2021",
    "dry-r1.25" in "papers/kasper2021",
    "wet" in "papers/kasper2021",
    "column" in "papers/man2023",
    "column-7-3" in "papers/man2023",
    "column-1-1" in "papers/man2023",
    "small-drum" in "gallery",
    "two-frictions-drum" in "gallery",
    "water-drum" in "gallery",
    "honey-drum" in "gallery",
    "two-sizes-drum" in "gallery",
    "two-sizes-wet-drum" in "gallery",
    "bouncing-grain" in "gallery",
    "small-column" in "gallery",
    "two-grains" in "gallery",
    "grain-chain" in "gallery",
    "slide-to-roll" in "gallery",
];

/// Every scene that comes with the program; the first is the one to open when none is asked for.
pub fn built_in() -> &'static [BuiltIn] {
    SCENES
}

/// The scene that comes with the program and that a person calls `name`, by its name or its path;
/// none where there is a file of that name. A folder of a scene's name is where its results are.
pub fn built_in_called(name: &str) -> Option<&'static BuiltIn> {
    let wanted = name.strip_suffix(".ron").unwrap_or(name);
    let mut known = built_in().iter();
    known
        .find(|scene| scene.name == wanted || scene.path == name)
        .filter(|_| !Path::new(name).is_file())
}
