//! Everything that is drawn round the picture: panels, what stands above, below and over them.
//!
//! In: the simulation and the view's settings. Out: requests, and what is left free for the
//! picture. Needs no Bevy app. Which panels there are is [`super::register`]'s.

use crate::simulation::Simulation;
use crate::ui::arrangement::{Arrangement, Rearrangement};
use crate::ui::bars::badge::Badge;
use crate::ui::bars::menu::{Shown, menu_ui};
use crate::ui::bars::transport::Transport;
use crate::ui::detail::Detail;
use crate::ui::dialogs::path_dialog::PathDialog;
use crate::ui::dialogs::shown::ShownDialogs;
use crate::ui::notice::{Notice, StaleTooltips};
use crate::ui::panels::compare::Compare;
use crate::ui::panels::lesson::LessonDesk;
use crate::ui::panels::parameter_sweep::ParameterSweep;
use crate::ui::plot_export::Export;
use crate::ui::register::register;
use crate::ui::request::Request;
use crate::ui::sides::Sides;
use crate::ui::sweep_desk::SweepDesk;
use crate::ui::theme::Palette;
use crate::ui::user_memory::{Look, UserMemory};
use crate::ui::widgets::focus::{FocusBelow, focus_ui};
use crate::ui::words::names::title_in_words;
use crate::ui::{shortcuts, text_size, theme};
use crate::view::ViewSettings;
use bevy::prelude::Resource;
use bevy_egui::egui::{self, Align2, FontId, Key, Margin, Modifiers, RichText};
use grainfall::lab::Status;
use grainfall::lesson::Lesson;
use grainfall::run::Parameter;
use grainfall::scene::built_in;
use std::path::PathBuf;
use std::time::Duration;

/// Computing time over which the speed of a scene is worth knowing.
const WORTH_MEASURING: Duration = Duration::from_millis(200);
/// What is said when the panels go away.
const HOW_BACK: &str = "P or Esc brings the panels back";

/// All that surrounds the picture.
#[derive(Resource)]
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub struct Dock {
    /// The panels on both sides.
    pub(super) sides: Sides,
    /// The parameter sweep that runs in the background.
    pub sweeps: SweepDesk,
    /// The lesson that is followed.
    pub lesson: LessonDesk,
    pub(super) transport: Transport,
    badge: Badge,
    /// The plot that a file is being chosen for.
    pub export: Option<Box<Export>>,
    pub(super) dialogs: ShownDialogs,
    pub(super) memory: UserMemory,
    /// The built-in scene that is open, unless it was changed.
    scene: Option<&'static str>,
    /// Choosing a file.
    pub path_dialog: PathDialog,
    /// The file of the session, where it has one.
    pub session: Option<PathBuf>,
    /// A session that an earlier window left, which was opened and is not yet kept as this window's
    /// work.
    pub taken_up: Option<PathBuf>,
    /// What to do when the session has been saved.
    pub after_saving: Option<Request>,
    notice: Notice,
    /// Whether a button of the pointer or a key is held: what is changed meanwhile is one change.
    pub is_holding: bool,
    /// Whether such a change is under way.
    pub is_changing: bool,
    /// Whether a picture of the window is being taken, in which no tooltip belongs.
    pub is_photographed: bool,
    stale_tooltips: StaleTooltips,
    /// What gets the keyboard's focus back.
    focus: FocusBelow,
    /// Where the menu bar is.
    menu_bar: egui::Rect,
    /// Whether the keyboard's focus is wanted in the menu bar.
    pub wants_menus: bool,
    /// Whether a file hovers over the window.
    pub file_hovers: bool,
    /// Whether the dock is hidden and the picture fills the window.
    pub is_hidden: bool,
    /// Whether panels are away and the picture has numbers that are read from afar.
    pub is_presenting: bool,
    /// Whether the window is to fill the screen.
    pub is_full_screen: bool,
    /// Size of the window [logical pixels], which decides how large text is; where it is not known,
    /// text has its usual size.
    pub window: Option<egui::Vec2>,
}

impl Default for Dock {
    fn default() -> Self {
        let sweeps = SweepDesk::default();
        Self {
            sides: Sides::new(register(&sweeps)),
            sweeps,
            lesson: LessonDesk::default(),
            transport: Transport::default(),
            badge: Badge::default(),
            export: None,
            dialogs: ShownDialogs::default(),
            memory: UserMemory::default(),
            scene: None,
            path_dialog: PathDialog::default(),
            session: None,
            taken_up: None,
            after_saving: None,
            notice: Notice::default(),
            is_holding: false,
            is_changing: false,
            is_photographed: false,
            stale_tooltips: StaleTooltips::default(),
            focus: FocusBelow::default(),
            menu_bar: egui::Rect::NOTHING,
            wants_menus: false,
            file_hovers: false,
            is_hidden: false,
            is_presenting: false,
            is_full_screen: false,
            window: None,
        }
    }
}

impl Dock {
    /// Draws everything into `root`, which spans the window and keeps what is free for the picture,
    /// and reads the keyboard.
    pub fn ui(
        &mut self,
        root: &mut egui::Ui,
        simulation: Option<&Simulation>,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        view.lit_by_plot = None;
        self.remember_look(root.ctx(), view);
        theme::show(root.ctx(), view.background);
        self.remember_ui(root.ctx(), simulation);
        if self.covers(root.ctx()) > 0 {
            self.focus.lead(root.ctx());
        }
        self.is_holding =
            (root.ctx()).input(|input| input.pointer.any_down() || !input.keys_down.is_empty());
        let is_lesson = |asked: &Request| matches!(asked, Request::Lesson(_));
        let pressed = shortcuts::pressed(root.ctx(), simulation).into_iter();
        let follows = self.lesson.under_way().is_some();
        out.extend(pressed.filter(|asked| follows || !is_lesson(asked)));
        if self.is_presenting {
            self.presented_ui(root, simulation, out);
        } else {
            self.panels_ui(root, simulation, view, out);
        }
        self.windows_ui(root.ctx(), simulation, out);
        let covers = self.covers(root.ctx());
        self.focus.follow(root.ctx(), covers, self.menu_bar);
        focus_ui(root.ctx(), Palette::of(root.visuals()));
        let (has_dialog, is_photographed) = (self.has_dialog(), self.is_photographed);
        (self.stale_tooltips).hide(root.ctx(), has_dialog, is_photographed);
    }

    /// How many of a dialog, a menu and a list lie over the panels.
    fn covers(&self, ctx: &egui::Context) -> usize {
        usize::from(self.has_dialog()) + usize::from(egui::Popup::is_any_open(ctx))
    }

    /// Draws the same into a second picture, but what lies over it: nobody works it there.
    pub(super) fn second_ui(
        &mut self,
        root: &mut egui::Ui,
        simulation: Option<&Simulation>,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        if self.is_presenting {
            self.presented_ui(root, simulation, out);
        } else {
            self.panels_ui(root, simulation, view, out);
        }
    }

    /// Menu bar, both sides and the bar below.
    fn panels_ui(
        &mut self,
        root: &mut egui::Ui,
        simulation: Option<&Simulation>,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        self.menu_bar_ui(root, simulation, view, out);
        let Some(simulation) = simulation else {
            return;
        };
        let lesson = &mut self.lesson;
        lesson.follow(simulation, out);
        (self.sides).ui(root, simulation, view, out, |ui, out| {
            lesson.ui(ui, simulation, out);
        });
        let bar = egui::Panel::bottom("transport").frame(bar_frame(root));
        bar.show(root, |ui| self.transport.ui(ui, simulation, out));
    }

    /// The picture alone, but for the bar below while nothing can be played.
    fn presented_ui(
        &mut self,
        root: &mut egui::Ui,
        simulation: Option<&Simulation>,
        out: &mut Vec<Request>,
    ) {
        let escape = |input: &mut egui::InputState| input.consume_key(Modifiers::NONE, Key::Escape);
        if !self.has_dialog() && root.ctx().input_mut(escape) {
            out.push(Request::Present);
        }
        let Some(simulation) = simulation else {
            return;
        };
        self.lesson.follow(simulation, out);
        if !matches!(simulation.status(), Status::Running | Status::Paused) {
            let bar = egui::Panel::bottom("transport").frame(bar_frame(root));
            bar.show(root, |ui| self.transport.ui(ui, simulation, out));
        }
    }

    /// Panels away over the whole screen, or back.
    pub fn present(&mut self) {
        self.is_presenting ^= true;
        self.is_full_screen = self.is_presenting;
        if self.is_presenting {
            self.notify(HOW_BACK);
        }
    }

    /// Does what was `asked` of the places of panels, and remembers it.
    pub fn rearrange(&mut self, asked: Rearrangement, simulation: Option<&Simulation>) {
        self.sides.rearrange(asked, simulation);
        if let Rearrangement::Show(title) = asked {
            self.show_panel(title);
        }
        self.memory.keep_panels(match asked {
            Rearrangement::AsAtFirst => Arrangement::default(),
            _ => self.sides.arrangement(),
        });
    }

    /// Where the panels stand.
    pub fn arrangement(&self) -> Arrangement {
        self.sides.arrangement()
    }

    /// The panels as they are at first, where this person wants them.
    fn renew_panels(&mut self) {
        let panels = register(&self.sweeps);
        self.sides = self.sides.renewed(panels, self.memory.panels());
        self.transport = Transport::default();
    }

    /// Remembers in `memory` from now on.
    pub fn remember(&mut self, memory: UserMemory) {
        self.sides.arrange(memory.panels());
        self.memory = memory;
    }

    /// Opens the panel called `title`, on whichever side it stands.
    pub fn show_panel(&mut self, title: &str) {
        self.sides.show_panel(title);
    }

    /// Opens the panel where two values are compared: of `parameter`, where one is given.
    pub fn compare(&mut self, parameter: Option<&Parameter>) {
        self.take_up(Compare::TITLE, parameter);
    }

    /// Opens the panel of parameter sweeps: about `parameter`, where one is given.
    pub fn ask_sweep(&mut self, parameter: Option<&Parameter>) {
        self.take_up(ParameterSweep::TITLE, parameter);
    }

    /// Opens the panel called `title`: about `parameter`, where one is given.
    fn take_up(&mut self, title: &str, parameter: Option<&Parameter>) {
        self.show_panel(title);
        if let Some(parameter) = parameter {
            self.sides.take_up(title, parameter);
        }
    }

    /// Opens every panel on both sides.
    pub fn show_all_panels(&mut self) {
        self.sides.open_all();
    }

    /// Restores the look of the last session, then keeps the present one.
    fn remember_look(&mut self, ctx: &egui::Context, view: &mut ViewSettings) {
        if let Some(look) = self.memory.last_look() {
            text_size::choose(ctx, look.scale);
            view.background = look.background;
        } else {
            self.memory.keep_look(Look {
                scale: text_size::chosen(ctx),
                background: view.background,
            });
        }
        text_size::follow(ctx, self.window);
    }

    /// Restores how much the controls showed the last time, then keeps that and how fast the scene
    /// runs.
    fn remember_ui(&mut self, ctx: &egui::Context, simulation: Option<&Simulation>) {
        let chosen = Detail::chosen(ctx);
        match chosen {
            Some(detail) => self.memory.show(detail),
            None => self.memory.detail().choose(ctx),
        }
        let running = simulation.filter(|simulation| *simulation.status() == Status::Running);
        if let (Some(name), Some(simulation)) = (self.scene, running)
            && let Some(world) = simulation.world()
        {
            let profile = simulation.profile();
            let computed = profile.steps as f64 * world.clock.time_step;
            if profile.total > WORTH_MEASURING {
                self.memory
                    .ran(name, computed / profile.total.as_secs_f64());
            }
        }
    }

    /// Paints notes over the picture, which fills the free part of `root`. The pointer stays the
    /// picture's.
    pub fn over_picture_ui(&self, root: &egui::Ui, simulation: Option<&Simulation>) {
        let free = root.available_rect_before_wrap();
        let painter = root.painter_at(free);
        let visuals = root.visuals();
        let write = |text: &str, size, colour| {
            let font = FontId::proportional(size);
            painter.text(free.center(), Align2::CENTER_CENTER, text, font, colour);
        };
        if simulation.is_none() {
            let text = "Open a scene, a lesson, a session or a recording: File menu, Ctrl+O, or drop a file here";
            write(text, 18.0, visuals.text_color());
        }
        if self.file_hovers {
            painter.rect_filled(free, 0.0, Palette::of(visuals).veil);
            write("Drop to open", 24.0, visuals.strong_text_color());
        }
    }

    /// Whether the panels say which moment is shown: then the picture need not.
    pub fn shows_time(&self) -> bool {
        !self.is_hidden && !self.is_presenting && self.transport.shows_time()
    }

    /// Says `text` for a few seconds.
    pub fn notify(&mut self, text: impl Into<String>) {
        self.notice.say(text.into());
    }

    /// What is told now, if anything.
    pub fn notice(&self) -> Option<&str> {
        self.notice.text()
    }

    /// Puts the scene called `name` first among the recent ones and resets the panels for it.
    pub fn scene_opened(&mut self, name: &str) {
        self.memory.opened(name);
        self.scene = built_in()
            .iter()
            .map(|scene| scene.name)
            .find(|known| *known == name);
        self.session = None;
        self.focus.let_go();
        self.lesson = LessonDesk::default();
        self.renew_panels();
    }

    /// Does the same for the scene of `lesson`, which begins.
    pub fn lesson_opened(&mut self, name: &str, lesson: Lesson) {
        self.scene_opened(name);
        self.lesson.begin(lesson);
        self.sides.shown.left = true;
    }

    /// Resets the panels for a scene made from the present one.
    pub fn scene_changed(&mut self) {
        self.session = None;
        self.scene = None;
        self.renew_panels();
    }

    /// Does the same for the session in the file called `name`, where it will be saved again.
    pub fn session_opened(&mut self, name: &str) {
        self.scene_opened(name);
        self.session = Some(name.into());
    }

    fn menu_bar_ui(
        &mut self,
        root: &mut egui::Ui,
        simulation: Option<&Simulation>,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        let badge = &mut self.badge;
        let panels = self.sides.titles(simulation);
        let mut shown = Shown {
            recent: self.memory.recent(),
            sides: &mut self.sides.shown,
            panels,
            takes_focus: std::mem::take(&mut self.wants_menus),
        };
        let mut of_badge = Vec::new();
        let bar = egui::Panel::top("menu").show(root, |ui| {
            menu_ui(ui, simulation, &mut shown, view, out, |ui| {
                if let Some(simulation) = simulation {
                    badge.ui(ui, simulation, &mut of_badge);
                    let title = RichText::new(title_in_words(simulation)).weak();
                    ui.add(egui::Label::new(title).truncate());
                }
            });
        });
        self.menu_bar = bar.response.rect;
        out.extend(of_badge);
    }

    fn windows_ui(
        &mut self,
        ctx: &egui::Context,
        simulation: Option<&Simulation>,
        out: &mut Vec<Request>,
    ) {
        self.path_dialog.ui(ctx, out);
        self.dialogs.ui(ctx, simulation, &self.memory, out);
        let waiting = "Waiting for the system's file dialog; ask again to type a path";
        let otherwise = self.path_dialog.is_waiting().then_some(waiting);
        self.notice.ui(ctx, otherwise);
    }
}

fn bar_frame(ui: &egui::Ui) -> egui::Frame {
    egui::Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(10, 8))
}
