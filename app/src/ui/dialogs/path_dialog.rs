//! Choosing a file: the system's own dialog, and a field to type a path into where there is none.
//!
//! In: what a path is wanted for. Out: the request that was waiting for the path. Nothing is read
//! or written here.
//!
//! The system's dialog runs on a thread of its own and may fail to appear (no D-Bus session, no
//! portal). Then the field appears, and also when the person asks again before the dialog has
//! answered. Nothing here waits.

use crate::ui::dialogs::capture_form::CaptureForm;
use crate::ui::dialogs::dialog::dialog_ui;
use crate::ui::request::{Request, SweepAct};
use crate::ui::theme::Palette;
use crate::ui::widgets::button::button_unless_ui;
use crate::ui::widgets::focus::{begin_to_type, is_entered};
use bevy::tasks::futures::check_ready;
use bevy::tasks::{IoTaskPool, Task};
use bevy_egui::egui;
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
    /// Where a picture goes.
    Picture,
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
            Self::Picture => "png",
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
    /// Whether paths are typed even where the system has a dialog.
    pub is_always_typed: bool,
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
    /// What is asked beside the path.
    form: CaptureForm,
}

impl Purpose {
    fn title(self) -> &'static str {
        match self {
            Self::Open => "Open a scene, a lesson, a session or a recording",
            Self::Session => "Save the session",
            Self::Picture => "Save a picture",
            Self::Changes => "Save the list of changes",
            Self::Plot => "Export the plot",
            Self::Film => "Record a film",
            Self::SweepFolder => "Choose a folder for parameter sweeps",
        }
    }

    fn field(self) -> &'static str {
        match self {
            Self::Open => {
                "Path of a file or of a run's folder, or name of a built-in scene or lesson"
            }
            Self::Session => "Path of the session's file",
            Self::Picture => "Path of the PNG file",
            Self::Changes => "Path of the JSON file",
            Self::Plot => "Path; it ends in .svg or .png for a picture, in .csv for all samples",
            Self::Film => {
                "Path; it ends in .gif, or with ffmpeg in .mp4, .webm or .mov; without an ending, a folder of PNG pictures"
            }
            Self::SweepFolder => "Path of a folder, in which each sweep has one of its own",
        }
    }

    fn suggestion(self) -> String {
        match self {
            Self::Open | Self::SweepFolder => String::new(),
            Self::Session => free_name("session", self.extension()),
            Self::Picture => free_name("grainfall", self.extension()),
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
            Self::Session | Self::Picture | Self::Changes | Self::Plot => ended(),
        }
    }

    /// What is asked for with `path`; none where more must be known.
    fn request(self, path: &Path) -> Option<Request> {
        let file = self.file(path);
        match self {
            Self::Open => Some(Request::Open(file.display().to_string())),
            Self::Session => Some(Request::SaveSession(file)),
            Self::Changes => Some(Request::SaveChanges(file)),
            Self::Plot => Some(Request::SavePlot(file)),
            Self::SweepFolder => Some(Request::Sweep(SweepAct::Folder(file))),
            Self::Picture | Self::Film => None,
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
        } else if self.typed.is_none() && (self.is_always_typed || !dialogs_are_there()) {
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
            form: CaptureForm::default(),
        });
    }

    /// Asks where a picture or a film goes and, in the `form`, what it is to be like.
    pub fn ask_with(&mut self, purpose: Purpose, form: CaptureForm) {
        self.asked = None;
        self.type_path(purpose, "");
        if let Some(typed) = &mut self.typed {
            typed.form = form;
        }
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
        let Some(typed) = &mut self.typed else {
            return;
        };
        match typed_ui(ctx, typed, !self.is_always_typed && dialogs_are_there()) {
            Some(FieldAnswer::Request(request)) => {
                out.push(request);
                self.typed = None;
            }
            Some(FieldAnswer::Choose) => self.choose(),
            Some(FieldAnswer::Nothing) => (self.typed, self.asked) = (None, None),
            None => {}
        }
    }

    /// Lets the system's dialog fill the field.
    fn choose(&mut self) {
        if let Some(typed) = &mut self.typed
            && self.asked.is_none()
        {
            let purpose = typed.purpose;
            let answer = IoTaskPool::get().spawn(ask_system(purpose));
            self.asked = Some(SystemDialog { purpose, answer });
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
        let is_gone = answer.after < SHORTEST_CHOICE;
        let Some(typed) = &mut self.typed else {
            match answer.file {
                Some(file) => out.extend(purpose.request(file.path())),
                None if is_gone => self.type_path(purpose, NO_DIALOG),
                None => {}
            }
            return;
        };
        match answer.file {
            Some(file) => typed.text = file.path().display().to_string(),
            None if is_gone => typed.reason = NO_DIALOG,
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
        Purpose::Picture => {
            let dialog = dialog.add_filter("Pictures", &["png"]);
            dialog.set_file_name("grainfall.png").save_file().await
        }
        Purpose::Plot => {
            let dialog = dialog.add_filter("Plots and their samples", &["svg", "png", "csv"]);
            dialog.set_file_name("plot.svg").save_file().await
        }
        Purpose::Film => {
            let dialog = dialog.add_filter("Films", &["gif", "mp4", "webm", "mov"]);
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
    Request(Request),
    /// Let the system's dialog appear.
    Choose,
    Nothing,
}

/// Draws the field, and the way to the system's dialog where that `has_system`.
fn typed_ui(ctx: &egui::Context, typed: &mut TypedPath, has_system: bool) -> Option<FieldAnswer> {
    let (answer, is_left) = dialog_ui(ctx, "path", 560.0, |ui| {
        ui.heading(typed.purpose.title());
        if !typed.reason.is_empty() {
            ui.weak(typed.reason);
        }
        let entered = path_ui(ui, typed) | typed.form.ui(ui);
        let path = PathBuf::from(typed.text.trim());
        let outcome = outlook_ui(ui, typed, &path);
        ui.add_space(4.0);
        answers_ui(ui, typed, outcome, [entered, has_system])
    });
    answer.or(is_left.then_some(FieldAnswer::Nothing))
}

/// The field for the path; whether somebody has pressed Enter in it.
fn path_ui(ui: &mut egui::Ui, typed: &mut TypedPath) -> bool {
    let label = ui.label(typed.purpose.field());
    let field = egui::TextEdit::singleline(&mut typed.text).desired_width(f32::INFINITY);
    let mut drawn = field.show(ui);
    let is_new = std::mem::take(&mut typed.fresh);
    begin_to_type(ui, &mut drawn, &typed.text, is_new);
    is_entered(&drawn.response.response.labelled_by(label.id))
}

/// Says what will be done; returns what is asked for then, or why that cannot be.
fn outlook_ui(ui: &mut egui::Ui, typed: &TypedPath, path: &Path) -> Result<Request, String> {
    let purpose = typed.purpose;
    let order = typed.form.order(&purpose.file(path));
    let told = purpose.outlook(path).and_then(|text| Ok((text, order?)));
    let (text, order) = match told {
        Ok(told) => told,
        Err(reason) => {
            ui.colored_label(Palette::of(ui.visuals()).warning, &reason);
            return Err(reason);
        }
    };
    ui.weak(text);
    if path.as_os_str().is_empty() {
        return Err("There is no path yet.".to_owned());
    }
    let Some((order, words)) = order else {
        let request = purpose.request(path);
        return request.ok_or_else(|| "It is not said what it is to be like.".to_owned());
    };
    if !words.is_empty() {
        ui.weak(words);
    }
    Ok(Request::Screenshot(order))
}

/// The buttons.
fn answers_ui(
    ui: &mut egui::Ui,
    typed: &TypedPath,
    outcome: Result<Request, String>,
    [entered, has_system]: [bool; 2],
) -> Option<FieldAnswer> {
    ui.horizontal(|ui| {
        let verb = match typed.purpose {
            Purpose::Open => "Open",
            Purpose::Session | Purpose::Picture | Purpose::Changes | Purpose::Plot => "Save",
            Purpose::Film => "Record",
            Purpose::SweepFolder => "Choose",
        };
        let why_not = outcome.as_ref().err().map(String::as_str);
        let done = button_unless_ui(ui, why_not, egui::Button::new(verb)).clicked();
        let left = ui.button("Cancel").clicked();
        let has_form = !matches!(typed.form, CaptureForm::Nothing);
        let chooses = has_form && has_system && ui.button("Choose a file…").clicked();
        match outcome {
            Ok(request) if done || entered => Some(FieldAnswer::Request(request)),
            _ if left => Some(FieldAnswer::Nothing),
            _ => chooses.then_some(FieldAnswer::Choose),
        }
    })
    .inner
}

/// `grainfall-1.png` in the working folder, or the next number that is free.
fn free_name(name: &str, extension: &str) -> String {
    let numbered = |number| format!("{name}-{number}.{extension}");
    let free = (1..1000)
        .map(numbered)
        .find(|name| !Path::new(name).exists());
    free.unwrap_or_else(|| numbered(1000))
}
