//! One grain under the microscope: its numbers, its contacts and bridges with every term of their
//! force, and the force over the gap of a chosen pair with the law's curve under the moving dot.
//!
//! In: the state shown, which grain is selected. Out: which grain and which of its partners is
//! selected, in the view's settings. Terms come from the solver's own law code ([`force_terms`]).
//!
//! | file | holds |
//! |---|---|
//! | `grain_rows` | the numbers of the grain |
//! | `term_rows` | every term of the force of a contact |
//! | `law_curves` | the curves of its law over the gap |

mod grain_rows;
mod law_curves;
mod term_rows;

use crate::simulation::Simulation;
use crate::ui::panel::Panel;
use crate::ui::plots::axes::fitting_plot;
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::widgets::field::{Field, slip_ui};
use crate::ui::widgets::value_table::table_ui;
use crate::ui::words::number;
use crate::view::{ViewSettings, trail_colour};
use bevy_egui::egui::{self, RichText, WidgetInfo, WidgetType};
use egui_plot::{HoverPosition, Line, Points, VLine};
use grain_rows::numbers;
use grainfall::solver::{ForceTerms, force_terms};
use grainfall::world::{Contact, Partner, World};
use law_curves::{curves, dot};
use term_rows::{recorded_rows, term_rows};

/// Points kept of the dot's path.
const LONGEST_WAY: usize = 400;
/// Contacts listed at most: a grain has a dozen.
const LONGEST_LIST: usize = 32;

/// The panel of one grain.
#[derive(Default)]
pub struct Microscope {
    /// The pair whose path is kept, the generation of the last state in it, and the path: gap [µm]
    /// and force [mN].
    pair: Option<(u32, Partner)>,
    generation: u64,
    way: Vec<[f64; 2]>,
    /// The partner chosen, where it is a wall.
    wall: Option<u32>,
    /// What was selected in the last frame.
    last: Option<usize>,
}

impl Panel for Microscope {
    fn title(&self) -> &'static str {
        "Microscope"
    }

    fn describes_one_run(&self) -> bool {
        true
    }

    fn wants_open(&mut self, view: &ViewSettings) -> bool {
        let selected = view.selected;
        let other = std::mem::replace(&mut self.last, selected);
        selected.is_some() && selected != other
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        _out: &mut Vec<Request>,
    ) {
        let run = simulation.half(view.focus);
        let Some(world) = run.world().filter(|world| !world.grains.is_empty()) else {
            ui.weak("There are no grains yet.");
            return;
        };
        let before = view.selected;
        choice_ui(ui, world, view);
        if view.selected != before {
            (view.beside, self.wall) = (None, None);
        }
        let Some(grain) = view.selected.filter(|grain| *grain < world.grains.len()) else {
            return;
        };
        let contacts = world.contacts_of(grain);
        table_ui(ui, numbers(world, grain, &contacts).into_iter());
        let contacts = &contacts[..contacts.len().min(LONGEST_LIST)];
        self.contacts_ui(ui, world, grain as u32, contacts, view);
        let chosen = contacts
            .iter()
            .find(|contact| match other_side(contact, grain as u32) {
                Partner::Grain(j) => view.beside == Some(j as usize),
                Partner::Wall(w) => self.wall == Some(w),
            });
        let Some(contact) = chosen else {
            if !contacts.is_empty() {
                ui.weak("Choose a contact to see its forces.");
            }
            return;
        };
        if simulation.recording().is_some() {
            table_ui(ui, recorded_rows(world, contact).into_iter());
            ui.weak("A recording holds the force of a contact as a whole, where it holds forces, and not its terms.");
            return;
        }
        let terms = force_terms(world, contact);
        table_ui(ui, term_rows(contact, &terms).into_iter());
        self.follow(contact, &terms, run.generation());
        self.plot_ui(ui, world, contact, &terms);
    }
}

/// The choice of the grain.
fn choice_ui(ui: &mut egui::Ui, world: &World, view: &mut ViewSettings) {
    let count = world.grains.len();
    let typed = ui.horizontal(|ui| {
        let Some(grain) = &mut view.selected else {
            ui.label("Click a grain in the picture, or");
            if ui.button("choose by number").clicked() {
                view.selected = Some(0);
            }
            return None;
        };
        ui.label("Grain");
        let field = Field {
            label: "Grain",
            range: 0.0..=(count - 1) as f64,
            unit: "",
            decimals: 0..=0,
            is_whole: true,
            speed: 0.2,
            size: None,
        };
        let mut chosen = *grain as f64;
        let response = field.ui(ui, &mut chosen);
        *grain = chosen as usize;
        ui.weak(format!("of {count}, counted from 0"));
        let close = ui.button("×").on_hover_text("Look at no grain");
        close.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "Look at no grain"));
        if close.clicked() {
            view.selected = None;
        }
        Some(response)
    });
    if let Some(field) = typed.inner {
        slip_ui(ui, &field);
        ui.checkbox(&mut view.follows_selected, "Follow it")
            .on_hover_text("Keep it in the middle of the picture. F shows everything again.");
    }
    trails_ui(ui, view);
}

/// The grains whose trails are drawn.
fn trails_ui(ui: &mut egui::Ui, view: &mut ViewSettings) {
    ui.horizontal_wrapped(|ui| {
        if let Some(grain) = view.selected {
            let mut is_traced = view.traced.contains(&grain);
            let hint = "Draw where the grain has been (T). Shift and a click in the picture does so for any grain.";
            if ui.checkbox(&mut is_traced, "Trail").on_hover_text(hint).changed() {
                view.trace(grain);
            }
        }
        if view.traced.is_empty() {
            return;
        }
        ui.weak("Trails of");
        let mut given_up = None;
        for (index, grain) in view.traced.iter().enumerate() {
            let [r, g, b] = trail_colour(index);
            let (rect, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), egui::Sense::hover());
            let colour = egui::Color32::from_rgb(r, g, b);
            ui.painter().rect_filled(rect, 3.0, colour);
            let button = ui
                .small_button(format!("{grain} ×"))
                .on_hover_text("Draw it no longer");
            let name = format!("No trail of grain {grain}");
            button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &name));
            if button.clicked() {
                given_up = Some(*grain);
            }
        }
        if ui.small_button("No trails").on_hover_text("Shift+T").clicked() {
            view.traced.clear();
        } else if let Some(grain) = given_up {
            view.trace(grain);
        }
    });
}

/// The partner of `grain` in `contact`.
fn other_side(contact: &Contact, grain: u32) -> Partner {
    match contact.partner {
        Partner::Grain(j) if j == grain => Partner::Grain(contact.grain),
        partner => partner,
    }
}

/// A contact in the list: partner, kind, force.
pub fn name(world: &World, contact: &Contact, grain: u32) -> String {
    let side = match other_side(contact, grain) {
        Partner::Grain(j) => format!("Grain {j}"),
        Partner::Wall(w) => world.container.walls[w as usize].name.clone(),
    };
    // Another program's files may hold none.
    let force = match contact.force.length() {
        force if force.is_nan() => String::new(),
        force => format!(" · {}", number::with_prefix(force, "N")),
    };
    let kind = match (contact.touching, contact.bridge.is_some()) {
        (true, false) => "touches",
        (true, true) => "touches, wet",
        (false, _) => "bridge",
    };
    format!("{} · {kind}{force}", number::capitalised(&side))
}

impl Microscope {
    fn contacts_ui(
        &mut self,
        ui: &mut egui::Ui,
        world: &World,
        grain: u32,
        contacts: &[&Contact],
        view: &mut ViewSettings,
    ) {
        ui.add_space(4.0);
        if contacts.is_empty() {
            ui.weak("It touches nothing.");
        }
        for contact in contacts {
            let side = other_side(contact, grain);
            let chosen = match side {
                Partner::Grain(j) => view.beside == Some(j as usize),
                Partner::Wall(w) => self.wall == Some(w),
            };
            if ui
                .selectable_label(chosen, name(world, contact, grain))
                .clicked()
            {
                (view.beside, self.wall) = match side {
                    Partner::Grain(j) => (Some(j as usize), None),
                    Partner::Wall(w) => (None, Some(w)),
                };
            }
        }
    }

    /// Adds the state of `generation` to the dot's path.
    fn follow(&mut self, contact: &Contact, terms: &[ForceTerms], generation: u64) {
        let pair = Some((contact.grain, contact.partner));
        if self.pair != pair {
            (self.pair, self.way) = (pair, Vec::new());
        } else if self.generation == generation {
            return;
        }
        self.generation = generation;
        if self.way.len() >= LONGEST_WAY {
            self.way.remove(0);
        }
        self.way.extend(terms.iter().map(dot).take(1));
    }

    fn plot_ui(&self, ui: &mut egui::Ui, world: &World, contact: &Contact, terms: &[ForceTerms]) {
        let Some(first) = terms.first() else {
            return;
        };
        let palette = Palette::of(ui.visuals());
        let curves = curves(world, contact, first);
        ui.add_space(4.0);
        ui.label(RichText::new("Normal force [mN] over gap [µm]").strong());
        let moves = curves.iter().any(|curve| curve.moving);
        ui.label(RichText::new(caption(first, moves)).small().weak());
        let dots: Vec<[f64; 2]> = terms.iter().map(dot).collect();
        let way = self.way.clone();
        let response = fitting_plot(ui, "force over gap")
            .label_formatter(|hover| Some(hover_text(hover)))
            .legend(egui_plot::Legend::default().position(egui_plot::Corner::RightTop))
            .show(ui, |plot| {
                plot.vline(
                    VLine::new("", 0.0)
                        .color(palette.threshold)
                        .allow_hover(false),
                );
                for (index, curve) in curves.into_iter().enumerate() {
                    curve.ui(plot, index, palette);
                }
                plot.line(Line::new("way", way).color(palette.kept).width(1.0));
                plot.points(Points::new("now", dots).radius(5.0).color(palette.warning));
            })
            .response;
        let [gap, force] = dot(first);
        response.widget_info(|| {
            let text = format!(
                "Force over gap: {} mN at {} µm",
                number::short(force),
                number::short(gap)
            );
            WidgetInfo::labeled(WidgetType::Image, true, text)
        });
    }
}

fn caption(terms: &ForceTerms, moves: bool) -> String {
    let speed = number::with_prefix(terms.approach.abs(), "m/s");
    let direction = if terms.approach > 0.0 {
        "coming together"
    } else {
        "parting"
    };
    if moves {
        format!("The law while {direction} at {speed}; dotted: at rest. Positive pushes apart.")
    } else {
        "The spring of the law. Positive pushes apart.".to_owned()
    }
}

fn hover_text(hover: &HoverPosition) -> String {
    let at = match hover {
        HoverPosition::NearDataPoint { position, .. } | HoverPosition::Elsewhere { position } => {
            position
        }
    };
    format!("{} µm\n{} mN", number::short(at.x), number::short(at.y))
}
