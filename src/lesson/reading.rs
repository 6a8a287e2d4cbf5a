//! Lessons from files and from the program: the one door.
//!
//! In: what a person names, or a text. Out: a checked [`Lesson`] with its scene, or a
//! [`LessonError`]. A lesson that somebody else made may name a scene of the program, or one in its
//! own folder or below, wherever links lead; it opens nothing else.

use super::built_in::{BuiltInLesson, built_in_lessons};
use super::description::Lesson;
use super::file::{KIND, LessonFile};
use crate::files::open_regular;
use crate::scene::{
    Problem, Scene, SceneError, built_in, first_word, folder_of, lies_in, read_ron, read_text,
};
use std::io::Read;
use std::path::Path;

/// Largest file that is read [bytes].
const LARGEST_FILE: u64 = 256 << 10;
/// What a file begins with, after white space and comments.
const MARK: &str = "Lesson";
/// What is read here.
const A_LESSON: &str = "a lesson's file in RON";

/// A lesson that cannot be used: where, what was found, what was expected, what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LessonError {
    /// The lesson itself is wrong.
    #[error(transparent)]
    Lesson(#[from] SceneError),
    /// Its scene is.
    #[error("{lesson}: `scene` cannot be opened: {error}")]
    Scene {
        /// What the lesson is called.
        lesson: String,
        /// What is wrong with the scene.
        error: SceneError,
    },
}

impl Lesson {
    /// Whether what is called `name` is to be opened as a lesson: a file that begins as one, or a
    /// built-in lesson's name.
    pub fn is_at(name: &str) -> bool {
        let path = Path::new(name);
        if path.is_file() {
            return begins_as_lesson(path);
        }
        known(name).is_some() && !path.exists()
    }

    /// The lesson that a person calls `name`, and its scene.
    ///
    /// ```
    /// use grainfall::lesson::Lesson;
    ///
    /// let (lesson, scene) = Lesson::open("why-slopes-have-an-angle")?;
    /// assert!(lesson.steps.iter().any(|step| step.question.is_some()));
    /// assert!(scene.grain_count() < 1000);
    /// # Ok::<(), grainfall::lesson::LessonError>(())
    /// ```
    ///
    /// # Errors
    /// When there is none, it is no lesson, it states something impossible, or its scene does.
    pub fn open(name: &str) -> Result<(Self, Scene), LessonError> {
        let path = Path::new(name);
        match known(name) {
            Some(own) if !path.is_file() => {
                let lesson = Self::parse(own.path, own.text)?;
                let scene = lesson.scene_with(|file| own.scene_in(file))?;
                Ok((lesson, scene))
            }
            _ => {
                let text = read_text(path, name, LARGEST_FILE, A_LESSON)?;
                let lesson = Self::parse(name, &text)?;
                let scene = lesson.scene_with(|file| beside(name, file))?;
                Ok((lesson, scene))
            }
        }
    }

    /// The lesson that `text` states; `name` is what errors call it. Its scene is not looked at:
    /// see [`Lesson::check_in`].
    ///
    /// # Errors
    /// When the text is no lesson, or states something impossible.
    pub fn parse(name: &str, text: &str) -> Result<Self, LessonError> {
        if text.len() as u64 > LARGEST_FILE {
            let fault = format!("has {} kB", text.len() >> 10);
            let expected = format!("at most {} kB", LARGEST_FILE >> 10);
            return Err(SceneError::unreadable(name, fault, &expected).into());
        }
        let text = text.trim_start_matches('\u{feff}');
        let refuse = |problem| SceneError::from_problem(name, text, problem);
        let file: LessonFile = read_ron(&KIND, name, text)?;
        let lesson = file.into_lesson(name, text).map_err(refuse)?;
        lesson.problem().map_err(refuse)?;
        Ok(lesson)
    }

    /// Whether it can be played in `scene`.
    ///
    /// # Errors
    /// When a step sets, touches or asks for what is not there.
    pub fn check_in(&self, scene: &Scene) -> Result<(), LessonError> {
        let refuse = |problem| SceneError::from_problem(&self.name, &self.text, problem);
        Ok(self.problem_in(scene).map_err(refuse)?)
    }

    /// Its scene with its settings, checked with it; `file` opens one that it names as a file.
    fn scene_with(
        &self,
        file: impl FnOnce(&str) -> Result<Scene, SceneError>,
    ) -> Result<Scene, LessonError> {
        let refuse = |problem| SceneError::from_problem(&self.name, &self.text, problem);
        let opened = if is_file(&self.scene) {
            file(&self.scene)
        } else if built_in().iter().any(|scene| scene.name == self.scene) {
            Scene::open(&self.scene)
        } else {
            let known = built_in().iter().map(|scene| scene.name);
            let mut problem = Problem::unknown_name("scene", "a scene", &self.scene, known);
            problem.expected += ", or a file in the lesson's folder whose name ends in `.ron`";
            return Err(refuse(problem).into());
        };
        let mut scene = opened.map_err(|error| LessonError::Scene {
            lesson: self.name.clone(),
            error,
        })?;
        for (key, text) in &self.settings {
            scene.set(key, text).map_err(|error| {
                let path = format!("settings.{key}");
                refuse(Problem::new(
                    path,
                    "cannot be set",
                    error.expected().to_owned(),
                ))
            })?;
        }
        self.check_in(&scene)?;
        Ok(scene)
    }
}

/// Whether `scene` names a file rather than a scene of the program.
fn is_file(scene: &str) -> bool {
    Path::new(scene)
        .extension()
        .is_some_and(|extension| extension == "ron")
}

fn known(name: &str) -> Option<&'static BuiltInLesson> {
    let wanted = name.strip_suffix(".ron").unwrap_or(name);
    let mut lessons = built_in_lessons().iter();
    lessons.find(|lesson| lesson.name == wanted || lesson.path == name)
}

/// Whether the file at `path` begins as a lesson.
fn begins_as_lesson(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = open_regular(path).and_then(|file| file.take(LARGEST_FILE).read_to_end(&mut head));
    let text = String::from_utf8_lossy(&head);
    read.is_ok() && first_word(text.trim_start_matches('\u{feff}')) == Some(MARK)
}

/// The scene in the file that `lesson` names, in its own folder or below.
fn beside(lesson: &str, file: &str) -> Result<Scene, SceneError> {
    let folder = folder_of(lesson);
    let path = folder.join(file);
    if path.exists() && !lies_in(folder, &path) {
        let name = path.display().to_string();
        let expected = "a file in the lesson's folder or below it";
        return Err(SceneError::unreadable(
            &name,
            "is not opened: it lies elsewhere",
            expected,
        ));
    }
    Scene::load(&path)
}
