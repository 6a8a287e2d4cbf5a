//! What the dock asks and tells over everything else: one function for each dialog.
//!
//! In: what is asked or told. Out: the dialog, from the next frame on.

use crate::simulation::Simulation;
use crate::ui::dialogs::path_dialog::Purpose;
use crate::ui::dialogs::typed_line::TypedLine;
use crate::ui::dock::Dock;
use crate::ui::plot_export::Export;
use crate::ui::request::{Request, Sheet};
use grainfall::lab::Half;
use std::path::PathBuf;

impl Dock {
    /// Whether a dialog or a sheet lies over the panels.
    pub(super) fn has_dialog(&self) -> bool {
        self.path_dialog.is_open() || self.dialogs.are_open()
    }

    /// Lets the person type the moment of `simulation` to go to.
    pub fn ask_moment(&mut self, simulation: &Simulation) {
        self.dialogs.line = Some(TypedLine::moment(simulation));
    }

    /// Lets the person name the run that is shown in `half`.
    pub fn ask_name(&mut self, simulation: &Simulation, half: Half) {
        self.dialogs.line = Some(TypedLine::name(simulation, half));
    }

    /// Lets the person choose where the plot `export` goes.
    pub fn export_plot(&mut self, export: Box<Export>) {
        self.export = Some(export);
        self.path_dialog.ask(Purpose::Plot);
    }

    /// Shows the scenes that come with the program.
    pub fn show_scenes(&mut self) {
        self.dialogs.shows_scenes = true;
    }

    /// Shows a sheet.
    pub fn show_sheet(&mut self, sheet: Sheet) {
        self.dialogs.sheet = Some(sheet);
    }

    /// Shows why a file could not be opened.
    pub fn show_open_error(&mut self, reason: String) {
        self.dialogs.open_error = Some(reason);
    }

    /// Asks whether `request`, against which `reason` speaks, is meant.
    pub fn doubt(&mut self, reason: String, request: Request) {
        self.dialogs.doubted = Some((reason, request));
    }

    /// Offers the sessions that earlier windows `left`, one by one.
    pub fn offer_left(&mut self, left: Vec<PathBuf>) {
        self.dialogs.left_behind = left;
    }

    /// Why a file could not be opened, while that is shown.
    pub fn open_error(&self) -> Option<&str> {
        self.dialogs.open_error.as_deref()
    }

    /// Asks whether to save before `next`, which leaves the session.
    pub fn ask_to_save(&mut self, next: Request) {
        self.dialogs.leaving = Some(next);
    }
}
