//! Choosing a file: the system's own dialog, and a field to type a path into where there is none.
//!
//! In: what a path is wanted for. Out: the request that was waiting for the path. Nothing is read
//! or written here.
//!
//! The system's dialog runs on a thread of its own and may fail to appear (no D-Bus session, no
//! portal). Then the field appears, and also when the person asks again before the dialog has
//! answered. Nothing here waits.

use crate::ui::request::{Request, SweepAct};
use crate::ui::screenshot_orders::{PictureOf, ScreenshotOrder};
use crate::ui::theme::Palette;
use crate::ui::widgets::button::button_unless_ui;
use bevy::tasks::futures::check_ready;
use bevy::tasks::{IoTaskPool, Task};
use bevy_egui::egui::text::{CCursor, CCursorRange};
use bevy_egui::egui::{self, Id, Key, Modal};
use grainfall::run::SESSION_EXTENSION;
use rfd::{AsyncFileDialog, FileHandle};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A dialog that ends sooner than this without a file probably never appeared.
const SHORTEST_CHOICE: Duration = Duration::from_secs(2);
/// Why the field stands where a dialog is expected.
const NO_DIALOG: &str =
    "The system offers no file dialog here (it needs a D-Bus session and xdg-desktop-portal).";

/// What a path is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A scene or a session to open.
    Open,
    /// Where the whole session goes.
    Session,
    /// Where a picture goes, and of what it is.
    Picture(PictureOf),
    /// Where the list of changes goes.
    Changes,
    /// Where a plot goes.
    Plot,
    /// Where a film goes.
    Film,
    /// The folder of parameter sweeps.
    SweepFolder,
}

impl Purpose {
    /// How the name of a file for it ends.
    fn extension(self) -> &'static str {
        match self {
            Self::Open => "ron",
            Self::Session => SESSION_EXTENSION,
            Self::Picture(_) => "png",
            Self::Changes => "json",
            Self::Plot => "svg",
            Self::Film => "gif",
            Self::SweepFolder => "",
        }
    }
}

/// A choice of a file, if one is being made.
#[derive(Default)]
pub struct PathDialog {
    asked: Option<SystemDialog>,
    typed: Option<TypedPath>,
}

/// A system dialog that has not answered yet.
struct SystemDialog {
    purpose: Purpose,
    answer: Task<DialogAnswer>,
}

/// The answer of a system dialog, and how long it was open.
struct DialogAnswer {
    file: Option<FileHandle>,
    after: Duration,
}

/// The field to type a path into.
struct TypedPath {
    purpose: Purpose,
    text: String,
    /// Why it appeared.
    reason: &'static str,
    fresh: bool,
}

impl Purpose {
    fn title(self) -> &'static str {
        match self {
            Self::Open => "Open a scene, a lesson, a session or a recording",
            Self::Session => "Save the session",
            Self::Picture(PictureOf::Window) => "Save a picture of the window",
            Self::Picture(PictureOf::Grains) => "Save a picture of the grains",
            Self::Picture(PictureOf::CutOut) => "Save the grains without a background",
            Self::Changes => "Save the list of changes",
            Self::Plot => "Export the plot",
            Self::Film => "Record a film of the picture",
            Self::SweepFolder => "Choose a folder for parameter sweeps",
        }
    }

    fn field(self) -> &'static str {
        match self {
            Self::Open => {
                "Path of a file or of a run's folder, or name of a built-in scene or lesson"
            }
            Self::Session => "Path of the session's file",
            Self::Picture(_) => "Path of the PNG file",
            Self::Changes => "Path of the JSON file",
            Self::Plot => "Path; it ends in .svg or .png for a picture, in .csv for all samples",
            Self::Film => {
                "Path; it ends in .gif, or in .mp4 where ffmpeg is installed; without an ending, a folder of PNG pictures"
            }
            Self::SweepFolder => "Path of a folder, in which each sweep has one of its own",
        }
    }

    fn suggestion(self) -> String {
        match self {
            Self::Open | Self::SweepFolder => String::new(),
            Self::Session => free_name("session", self.extension()),
            Self::Picture(_) => free_name("grainfall", self.extension()),
            Self::Changes => free_name("changes", self.extension()),
            Self::Plot => free_name("plot", self.extension()),
            Self::Film => free_name("film", self.extension()),
        }
    }

    /// The file for `path`: with the purpose's ending where there is only one, or where `path` has
    /// none.
    fn file(self, path: &Path) -> PathBuf {
        let ended = || path.with_extension(self.extension());
        match self {
            Self::Open | Self::Film | Self::SweepFolder => path.to_owned(),
            Self::Plot if path.extension().is_some() => path.to_owned(),
            Self::Session | Self::Picture(_) | Self::Changes | Self::Plot => ended(),
        }
    }

    fn request(self, path: &Path) -> Request {
        let file = self.file(path);
        match self {
            Self::Open => Request::Open(file.display().to_string()),
            Self::Session => Request::SaveSession(file),
            Self::Picture(of) => Request::Screenshot(ScreenshotOrder::Picture(file, of)),
            Self::Changes => Request::SaveChanges(file),
            Self::Plot => Request::SavePlot(file),
            Self::Film => Request::Screenshot(ScreenshotOrder::Film(file)),
            Self::SweepFolder => Request::Sweep(SweepAct::Folder(file)),
        }
    }

    /// What will happen to the file for `path`, in words, or why it cannot be used.
    fn outlook(self, path: &Path) -> Result<String, String> {
        let file = self.file(path);
        let whole = std::path::absolute(&file).unwrap_or(file);
        let shown = whole.display();
        if self == Self::Open || path.as_os_str().is_empty() {
            Ok(String::new())
        } else if self == Self::SweepFolder && whole.is_dir() {
            Ok(format!("Each sweep has a folder of its own in {shown}"))
        } else if whole.is_dir() {
            Err(format!(
                "There is a folder {shown} already: choose another name."
            ))
        } else if let Some(folder) = missing_folder(&whole) {
            let folder = folder.display();
            Err(format!(
                "There is no folder {folder}: make it first, or choose another."
            ))
        } else if self == Self::SweepFolder && whole.exists() {
            Err(format!("{shown} is no folder: choose another."))
        } else if whole.exists() {
            Ok(format!("Replaces {shown}"))
        } else {
            Ok(format!("Goes to {shown}"))
        }
    }
}

/// The folder that the file `whole` is to lie in, where there is none.
fn missing_folder(whole: &Path) -> Option<&Path> {
    whole.parent().filter(|folder| !folder.is_dir())
}

impl PathDialog {
    /// Asks for a path with the system's dialog; with the field where that has been asked for and
    /// has not answered.
    pub fn ask(&mut self, purpose: Purpose) {
        if self.asked.take().is_some() {
            self.type_path(purpose, "The system's file dialog has not answered.");
        } else if self.typed.is_none() && !dialogs_are_there() {
            self.type_path(purpose, NO_DIALOG);
        } else if self.typed.is_none() {
            let answer = IoTaskPool::get().spawn(ask_system(purpose));
            self.asked = Some(SystemDialog { purpose, answer });
        }
    }

    /// Asks for a path with the field.
    pub fn type_path(&mut self, purpose: Purpose, reason: &'static str) {
        self.typed = Some(TypedPath {
            purpose,
            text: purpose.suggestion(),
            reason,
            fresh: true,
        });
    }

    /// Whether a file is being chosen.
    pub fn is_open(&self) -> bool {
        self.asked.is_some() || self.typed.is_some()
    }

    /// Whether the system's dialog has not answered yet.
    pub fn is_waiting(&self) -> bool {
        self.asked.is_some()
    }

    /// Takes the system dialog's answer, or draws the field; what was chosen goes into `out`.
    pub fn ui(&mut self, ctx: &egui::Context, out: &mut Vec<Request>) {
        self.take_answer(out);
        if let Some(typed) = &mut self.typed {
            match typed_ui(ctx, typed) {
                Some(FieldAnswer::Path(path)) => {
                    out.push(typed.purpose.request(&path));
                    self.typed = None;
                }
                Some(FieldAnswer::Nothing) => self.typed = None,
                None => {}
            }
        }
    }

    fn take_answer(&mut self, out: &mut Vec<Request>) {
        let Some(asked) = &mut self.asked else {
            return;
        };
        let Some(answer) = check_ready(&mut asked.answer) else {
            return;
        };
        let purpose = asked.purpose;
        self.asked = None;
        match answer.file {
            Some(file) => out.push(purpose.request(file.path())),
            None if answer.after < SHORTEST_CHOICE => self.type_path(purpose, NO_DIALOG),
            None => {}
        }
    }
}

/// Whether a dialog can appear at all: on Linux it needs a D-Bus session. Trying to open one could
/// take seconds.
fn dialogs_are_there() -> bool {
    let bus = || {
        let folder = std::env::var_os("XDG_RUNTIME_DIR")?;
        Path::new(&folder).join("bus").exists().then_some(())
    };
    !cfg!(target_os = "linux")
        || std::env::var_os("DBUS_SESSION_BUS_ADDRESS").is_some()
        || bus().is_some()
}

async fn ask_system(purpose: Purpose) -> DialogAnswer {
    let since = Instant::now();
    let dialog = AsyncFileDialog::new().set_title(purpose.title());
    let file = match purpose {
        Purpose::Open => {
            let kinds = ["ron", SESSION_EXTENSION, "pvd", "json"];
            let dialog = dialog.add_filter("Scenes, lessons, sessions and recordings", &kinds);
            dialog.pick_file().await
        }
        Purpose::Session => {
            let dialog = dialog.add_filter("Sessions", &[SESSION_EXTENSION]);
            let name = format!("session.{SESSION_EXTENSION}");
            dialog.set_file_name(name).save_file().await
        }
        Purpose::Picture(_) => {
            let dialog = dialog.add_filter("Pictures", &["png"]);
            dialog.set_file_name("grainfall.png").save_file().await
        }
        Purpose::Plot => {
            let dialog = dialog.add_filter("Plots and their samples", &["svg", "png", "csv"]);
            dialog.set_file_name("plot.svg").save_file().await
        }
        Purpose::Film => {
            let dialog = dialog.add_filter("Films", &["gif", "mp4"]);
            dialog.set_file_name("film.gif").save_file().await
        }
        Purpose::SweepFolder => dialog.pick_folder().await,
        Purpose::Changes => {
            let dialog = dialog.add_filter("Lists of changes", &["json"]);
            dialog.set_file_name("changes.json").save_file().await
        }
    };
    DialogAnswer {
        file,
        after: since.elapsed(),
    }
}

/// How the field was left.
enum FieldAnswer {
    Path(PathBuf),
    Nothing,
}

fn typed_ui(ctx: &egui::Context, typed: &mut TypedPath) -> Option<FieldAnswer> {
    let frame = egui::Frame::window(&ctx.style_of(ctx.theme()));
    let modal = Modal::new(Id::new("path")).frame(frame).show(ctx, |ui| {
        ui.set_width(560.0_f32.min(0.9 * ui.ctx().content_rect().width()));
        ui.heading(typed.purpose.title());
        ui.weak(typed.reason);
        let label = ui.label(typed.purpose.field());
        let field = egui::TextEdit::singleline(&mut typed.text).desired_width(f32::INFINITY);
        let mut drawn = field.show(ui);
        let field = drawn.response.response.clone().labelled_by(label.id);
        if std::mem::take(&mut typed.fresh) {
            field.request_focus();
            // What is typed takes the place of what is suggested.
            let all = CCursorRange::two(CCursor::new(0), CCursor::new(typed.text.chars().count()));
            drawn.state.cursor.set_char_range(Some(all));
            drawn.state.store(ui.ctx(), field.id);
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let path = PathBuf::from(typed.text.trim());
        let outlook = typed.purpose.outlook(&path);
        match &outlook {
            Ok(text) => ui.weak(text),
            Err(reason) => ui.colored_label(Palette::of(ui.visuals()).warning, reason),
        };
        let why_not = match outlook {
            Ok(_) if path.as_os_str().is_empty() => Some("There is no path yet.".to_owned()),
            outlook => outlook.err(),
        };
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            let verb = match typed.purpose {
                Purpose::Open => "Open",
                Purpose::Session | Purpose::Picture(_) | Purpose::Changes | Purpose::Plot => "Save",
                Purpose::Film => "Record",
                Purpose::SweepFolder => "Choose",
            };
            let possible = why_not.is_none();
            let button = egui::Button::new(verb);
            let done = button_unless_ui(ui, why_not.as_deref(), button).clicked();
            let left = ui.button("Cancel").clicked();
            match (done || (entered && possible), left) {
                (true, _) => Some(FieldAnswer::Path(path)),
                (false, true) => Some(FieldAnswer::Nothing),
                (false, false) => None,
            }
        })
        .inner
    });
    let closed = modal.should_close().then_some(FieldAnswer::Nothing);
    modal.inner.or(closed)
}

/// `grainfall-1.png` in the working folder, or the next number that is free.
fn free_name(name: &str, extension: &str) -> String {
    let numbered = |number| format!("{name}-{number}.{extension}");
    let free = (1..1000)
        .map(numbered)
        .find(|name| !Path::new(name).exists());
    free.unwrap_or_else(|| numbered(1000))
}
