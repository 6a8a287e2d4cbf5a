//! What the program remembers of one person from start to start: files opened, how much the
//! controls show, how large and on which background, where panels stand, how large pictures are and how
//! films pass, how fast each scene ran on this machine.
//!
//! In: a small JSON file of the user's. Out: the same file, written whenever something changes. A
//! file that is damaged or cannot be written is reported once; then less is remembered, and nothing
//! else is lost. Scenes and sessions are not kept here.

use crate::ui::arrangement::Arrangement;
use crate::ui::capture_choice::CaptureChoice;
use crate::ui::detail::Detail;
use crate::ui::screenshot_orders::ScreenshotOrder;
use crate::ui::text_size::SCALES;
use crate::view::Background;
use bevy::log::warn;
use grainfall::files::{read_whole, write_whole};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Largest file that is read [bytes].
const LARGEST: u64 = 1 << 20;
/// Recent files kept.
const RECENT: usize = 8;
/// A speed that exceeds the one known by less than this share of it is not news.
const NEWS: f64 = 0.3;

/// What is remembered, and where.
#[derive(Debug, Default)]
pub struct UserMemory {
    file: Option<PathBuf>,
    kept: Remembered,
    /// Whether nobody has asked yet how everything looked the last time.
    is_new: bool,
}

/// How everything looks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Look {
    /// Size of text and controls over their usual one; none where the window's size decides.
    pub scale: Option<f32>,
    /// Behind picture and panels.
    pub background: Background,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            scale: None,
            background: Background::Dark,
        }
    }
}

#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
struct Remembered {
    recent: Vec<String>,
    lab: bool,
    look: Look,
    panels: Arrangement,
    capture: CaptureChoice,
    speeds: BTreeMap<String, f64>,
}

impl UserMemory {
    /// The user's own.
    pub fn user() -> Self {
        directories::ProjectDirs::from("", "", "grainfall").map_or_else(Self::default, |folders| {
            Self::at(folders.data_local_dir().join("remembered.json"))
        })
    }

    /// What the file at `path` holds, and from now on what is to be remembered. A symbolic link is
    /// followed: it is the user's own.
    pub fn at(path: PathBuf) -> Self {
        let path = fs::canonicalize(&path).unwrap_or(path);
        let kept = read(&path).unwrap_or_else(|reason| {
            warn!("{} is not read: {reason}", path.display());
            Remembered::default()
        });
        Self {
            kept,
            file: Some(path),
            is_new: true,
        }
    }

    /// Scenes and sessions opened, the newest first.
    pub fn recent(&self) -> &[String] {
        &self.kept.recent
    }

    /// How much the controls show.
    pub fn detail(&self) -> Detail {
        if self.kept.lab {
            Detail::Lab
        } else {
            Detail::Basics
        }
    }

    /// How everything looks, at a scale in [`SCALES`].
    pub fn look(&self) -> Look {
        let Look { scale, background } = self.kept.look;
        let scale = scale.filter(|scale| SCALES.contains(scale));
        Look { scale, background }
    }

    /// Where panels stand.
    pub fn panels(&self) -> &Arrangement {
        &self.kept.panels
    }

    /// Remembers where panels stand.
    pub fn keep_panels(&mut self, panels: Arrangement) {
        if panels != self.kept.panels {
            self.kept.panels = panels;
            self.write();
        }
    }

    /// What was chosen of pictures and films.
    pub fn capture(&self) -> &CaptureChoice {
        &self.kept.capture
    }

    /// Remembers what `order` chose.
    pub fn keep_capture(&mut self, order: &ScreenshotOrder) {
        let chosen = self.kept.capture.after(order);
        if chosen != self.kept.capture {
            self.kept.capture = chosen;
            self.write();
        }
    }

    /// How fast each scene ran here, in simulated seconds per second.
    pub fn speeds(&self) -> &BTreeMap<String, f64> {
        &self.kept.speeds
    }

    /// Remembers that `name` was opened.
    pub fn opened(&mut self, name: &str) {
        // Files by their whole path: the program may start elsewhere the next time.
        let name =
            fs::canonicalize(name).map_or(name.to_owned(), |path| path.display().to_string());
        self.kept.recent.retain(|recent| *recent != name);
        self.kept.recent.insert(0, name);
        self.kept.recent.truncate(RECENT);
        self.write();
    }

    /// Remembers how much the controls show.
    pub fn show(&mut self, detail: Detail) {
        if detail != self.detail() {
            self.kept.lab = detail == Detail::Lab;
            self.write();
        }
    }

    /// How everything looked the last time: once, at the start. From then on the present look
    /// counts.
    pub fn last_look(&mut self) -> Option<Look> {
        std::mem::take(&mut self.is_new).then(|| self.look())
    }

    /// Remembers `look` as the present one.
    pub fn keep_look(&mut self, look: Look) {
        if look != self.look() {
            self.kept.look = look;
            self.write();
        }
    }

    /// Remembers that the scene called `name` runs at `speed` times real time: the fastest it ever
    /// ran, as other programs only ever make it slower.
    pub fn ran(&mut self, name: &str, speed: f64) {
        let known = self.kept.speeds.get(name).copied().unwrap_or(0.0);
        if speed.is_finite() && speed > (1.0 + NEWS) * known {
            self.kept.speeds.insert(name.to_owned(), speed);
            self.write();
        }
    }

    /// Writes the file. One that cannot be written is said to be once and left alone from then on:
    /// nothing that a person does depends on it.
    fn write(&mut self) {
        let Some(path) = &self.file else {
            return;
        };
        let text = serde_json::to_string_pretty(&self.kept).map_err(io::Error::other);
        let written =
            text.and_then(|text| write_whole(path, |file| file.write_all(text.as_bytes())));
        if let Err(reason) = written {
            warn!("{} is not written: {reason}", path.display());
            self.file = None;
        }
    }
}

/// What the file at `path` holds; nothing where there is none yet.
///
/// # Errors
/// Where it cannot be read or holds something else.
fn read(path: &Path) -> io::Result<Remembered> {
    match read_whole(path, LARGEST) {
        Ok(text) => serde_json::from_slice(&text).map_err(io::Error::other),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Remembered::default()),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_remembered_is_there_at_the_next_start() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("grainfall/remembered.json");
        let mut memory = UserMemory::at(path.clone());
        assert_eq!(
            (memory.recent().len(), memory.detail()),
            (0, Detail::Basics)
        );
        for index in 0..10 {
            memory.opened(&format!("scene {index}"));
        }
        memory.opened("scene 7");
        memory.show(Detail::Lab);
        let look = Look {
            scale: Some(1.5),
            background: Background::Light,
        };
        memory.keep_look(look);
        let panels = Arrangement {
            closed: vec!["Solver".into()],
            ..Arrangement::default()
        };
        memory.keep_panels(panels);
        memory.ran("dry-r3", 2.0);
        memory.ran("dry-r3", 2.1);
        memory.ran("dry-r3", 2e-5);
        let again = UserMemory::at(path.clone());
        assert_eq!(again.kept, memory.kept);
        assert_eq!(again.look(), look);
        assert!(again.panels().is_closed("Solver"));
        assert_eq!(again.recent()[..2], ["scene 7", "scene 9"]);
        assert_eq!(again.recent().len(), RECENT);
        assert_eq!(
            again.speeds()["dry-r3"],
            2.0,
            "a little faster is no news, nor a busy machine"
        );
        fs::write(&path, "{\"look\": {\"scale\": 0.0}}").unwrap();
        assert_eq!(UserMemory::at(path.clone()).look(), Look::default());
        fs::write(&path, "{\"recent\": 3").unwrap();
        assert_eq!(UserMemory::at(path).kept, Remembered::default());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_what_is_remembered_stays_one_and_a_device_is_neither_read_nor_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let [path, link] = ["kept.json", "link.json"].map(|name| folder.path().join(name));
        UserMemory::at(path.clone()).opened("first");
        std::os::unix::fs::symlink(&path, &link).unwrap();
        UserMemory::at(link.clone()).opened("second");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(UserMemory::at(path).recent(), ["second", "first"]);
        let mut memory = UserMemory::at("/dev/zero".into());
        memory.opened("third");
        assert_eq!(memory.file, None, "it is said once and left alone");
    }
}
