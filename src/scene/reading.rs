//! From a file, a built-in scene or a text to a checked [`Scene`].

use super::built_in::{built_in, built_in_called};
use super::description::Scene;
use super::error::{self, SceneError};
use super::file::{KIND, SceneFile};
use super::syntax::read_ron;
use crate::files::read_whole;
use std::io::{self, Read};
use std::path::Path;

/// Largest scene file that is read [bytes]: room for about half a million listed grains.
const LARGEST_FILE: u64 = 64 << 20;
/// What is read here.
const A_SCENE: &str = "a scene file in RON";

impl Scene {
    /// The scene in the file at `path`.
    ///
    /// # Errors
    /// When the file cannot be read, is no scene, or states something impossible.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        Self::parse(&name, &read_text(path, &name, LARGEST_FILE, A_SCENE)?)
    }

    /// The scene that comes from `source`, which errors call `name`; names of files in it are
    /// relative to the present folder.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn read(source: impl Read, name: &str) -> Result<Self, SceneError> {
        let mut bytes = Vec::new();
        let read = source.take(LARGEST_FILE).read_to_end(&mut bytes);
        read.map_err(|error| unreadable(name, error, A_SCENE))?;
        Self::parse(name, &text_of(bytes, name, A_SCENE)?)
    }

    /// The scene that a person calls `name`: the file at that path, or else a built-in scene of
    /// that name or path.
    ///
    /// ```
    /// use grainfall::scene::Scene;
    ///
    /// let mut scene = Scene::open("small-drum")?;
    /// scene.set("seed", "7")?;
    /// assert_eq!((scene.seed, scene.grain_count()), (7, 100));
    ///
    /// // What cannot be used is refused with where, what was expected, and what to do.
    /// let error = Scene::open("smal-drum").unwrap_err();
    /// assert!(error.to_string().contains("Did you mean `small-drum`?"));
    /// # Ok::<(), grainfall::scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Scene::load`], and when there is neither such a file nor such a scene.
    pub fn open(name: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = name.as_ref();
        let name = path.display().to_string();
        if let Some(scene) = built_in_called(&name) {
            return Self::parse(scene.path, scene.text);
        }
        if path.exists() {
            return Self::load(path);
        }
        let wanted = name.strip_suffix(".ron").unwrap_or(&name);
        let names: Vec<&str> = built_in().iter().map(|scene| scene.name).collect();
        Err(SceneError::unreadable(
            &name,
            "there is no such file, nor a built-in scene of that name",
            &format!("a file, or {}", error::one_of(&names)),
        )
        .advise(error::suggestion(wanted, &names)))
    }

    /// The scene that `text` states; `file` is what errors call it, and names of files in it are
    /// relative to its folder.
    ///
    /// # Errors
    /// When the text is no scene, or states something impossible.
    pub fn parse(file: &str, text: &str) -> Result<Self, SceneError> {
        let text = text.trim_start_matches('\u{feff}');
        let refuse = |problem| SceneError::from_problem(file, text, problem);
        let scene = read_ron::<SceneFile>(&KIND, file, text)?
            .into_scene(folder_of(file))
            .map_err(refuse)?;
        scene.problem().map_err(refuse)?;
        Ok(scene)
    }

    /// Whether every value makes sense and all fit together, as a scene made by a program may not.
    /// Parsed scenes do.
    ///
    /// # Errors
    /// When a value does not.
    pub fn check(&self) -> Result<(), SceneError> {
        self.problem()
            .map_err(|problem| SceneError::outside_of_files(&self.title, problem))
    }
}

/// The folder that the file called `file` stands in.
pub(crate) fn folder_of(file: &str) -> &Path {
    Path::new(file).parent().unwrap_or(Path::new(""))
}

/// Text of the file at `path`, which errors call `name`; it has at most `most` bytes and is `expected`
/// to be something.
pub(crate) fn read_text(
    path: &Path,
    name: &str,
    most: u64,
    expected: &str,
) -> Result<String, SceneError> {
    let bytes = read_whole(path, most).map_err(|error| unreadable(name, error, expected))?;
    text_of(bytes, name, expected)
}

/// `bytes` as text.
fn text_of(bytes: Vec<u8>, name: &str, expected: &str) -> Result<String, SceneError> {
    String::from_utf8(bytes).map_err(|error| {
        let good = error.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(&error.as_bytes()[..good]).into_owned();
        SceneError::unreadable(name, "is not UTF-8 text", expected).at_line(&text, good)
    })
}

fn unreadable(name: &str, error: io::Error, expected: &str) -> SceneError {
    SceneError::unreadable(name, format!("cannot be read: {error}"), expected)
}
