//! The lessons that come with the program, each with the scene that it brings.

use crate::scene::{Scene, SceneError};

/// A lesson that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuiltInLesson {
    /// What to call it: `why-honey-creeps`.
    pub name: &'static str,
    /// Its file in the repository: `scenes/lessons/why-honey-creeps.ron`.
    pub path: &'static str,
    /// The file's text.
    pub text: &'static str,
    /// Whose picture stands for it: a built-in scene's.
    pub picture: &'static str,
    /// Name and text of the scene in its folder, where it has one there.
    scene: Option<(&'static str, &'static str)>,
}

impl BuiltInLesson {
    /// The scene in the `file` of its folder.
    ///
    /// # Errors
    /// When there is none, or it is wrong; a test opens each.
    pub(super) fn scene_in(&self, file: &str) -> Result<Scene, SceneError> {
        match self.scene.filter(|(name, _)| *name == file) {
            Some((name, text)) => Scene::parse(name, text),
            None => Err(SceneError::unreadable(file, "is not in the program", "")),
        }
    }
}

macro_rules! lesson {
    ($name:literal, $picture:literal, $scene:expr) => {
        BuiltInLesson {
            name: $name,
            path: concat!("scenes/lessons/", $name, ".ron"),
            text: include_str!(concat!("../../scenes/lessons/", $name, ".ron")),
            picture: $picture,
            scene: $scene,
        }
    };
}

const LESSONS: &[BuiltInLesson] = &[
    lesson!("why-slopes-have-an-angle", "small-drum", None),
    lesson!(
        "why-honey-creeps",
        "honey-drum",
        Some((
            "small-wet-drum.ron",
            include_str!("../../scenes/lessons/small-wet-drum.ron")
        ))
    ),
    lesson!(
        "why-smooth-grains-run-farther",
        "small-column",
        Some((
            "column-of-one-kind.ron",
            include_str!("../../scenes/lessons/column-of-one-kind.ron")
        ))
    ),
];

/// Every lesson that comes with the program, in the order in which they build on each other.
pub fn built_in_lessons() -> &'static [BuiltInLesson] {
    LESSONS
}
