//! Which sheets, questions and errors lie over the panels, and what each is about.
//!
//! In: what is to be shown or asked. Out: each drawn until it is answered or closed; the requests
//! that answers are. Choosing a file is [`super::path_dialog`]'s business.

use crate::simulation::Simulation;
use crate::ui::dialogs::scene_gallery::Gallery;
use crate::ui::dialogs::sheets::{doubt_ui, left_ui, open_error_ui, sheet_ui, unsaved_ui};
use crate::ui::dialogs::typed_line::TypedLine;
use crate::ui::request::{Request, Sheet};
use crate::ui::user_memory::UserMemory;
use bevy_egui::egui;
use std::path::PathBuf;

/// What lies over the panels.
#[derive(Default)]
pub struct ShownDialogs {
    gallery: Gallery,
    /// Whether the scenes that come with the program are shown.
    pub shows_scenes: bool,
    /// A line that is asked for.
    pub line: Option<TypedLine>,
    /// A sheet to read.
    pub sheet: Option<Sheet>,
    /// Why a file could not be opened.
    pub open_error: Option<String>,
    /// What is asked whether it is meant, and why.
    pub doubted: Option<(String, Request)>,
    /// Sessions that earlier windows left, which are offered one by one.
    pub left_behind: Vec<PathBuf>,
    /// The request that would lose unsaved work, while the person is asked about it.
    pub leaving: Option<Request>,
}

impl ShownDialogs {
    /// Whether any of them is open.
    pub fn are_open(&self) -> bool {
        self.shows_scenes
            || self.line.is_some()
            || self.sheet.is_some()
            || self.open_error.is_some()
            || self.leaving.is_some()
            || self.doubted.is_some()
            || !self.left_behind.is_empty()
    }

    /// Draws those that are open. The gallery tells what `memory` knows of scenes.
    pub fn ui(
        &mut self,
        ctx: &egui::Context,
        simulation: Option<&Simulation>,
        memory: &UserMemory,
        out: &mut Vec<Request>,
    ) {
        self.line.take_if(|line| !line.ui(ctx, simulation, out));
        self.shows_scenes = self.shows_scenes && self.gallery.ui(ctx, memory, out);
        self.sheet = self.sheet.filter(|sheet| sheet_ui(ctx, *sheet));
        let open = |reason: &String| open_error_ui(ctx, reason);
        self.open_error = self.open_error.take().filter(open);
        if let Some(path) = self.left_behind.first()
            && !left_ui(ctx, path, out)
        {
            self.left_behind.remove(0);
        }
        self.doubted =
            (self.doubted.take()).filter(|(reason, request)| doubt_ui(ctx, reason, request, out));
        let asked = |next: &Request| unsaved_ui(ctx, next, out);
        self.leaving = self.leaving.take().filter(asked);
    }
}
