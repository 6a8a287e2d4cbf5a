//! One grain under the microscope: its numbers, its contacts and bridges with every term of their force, and the force over
//! the gap of a chosen pair with the law's curve under the moving dot.
//!
//! In: the state shown, which grain is selected. Out: which grain and which of its partners is selected, in the view's
//! settings. Terms come from the solver's own law code ([`force_terms`]).

use super::field::{Field, slip_ui};
use super::plots::fitting_plot;
use super::table::{Row, table_ui};
use super::theme::{Palette, dash};
use super::{Panel, Request, number};
use crate::scene::BridgeLaw;
use crate::simulation::Simulation;
use crate::solver::{ForceTerms, NormalLaw, force_terms};
use crate::view::{ViewSettings, trail_colour};
use crate::world::{Contact, Partner, World};
use bevy_egui::egui::{self, RichText, WidgetInfo, WidgetType};
use egui_plot::{HoverPosition, Line, LineStyle, PlotUi, Points, VLine};
use glam::DVec3;

const MILLIMETRES: f64 = 1e3;
const MICROMETRES: f64 = 1e6;
/// Points of a curve.
const CURVE: usize = 240;
/// Points of the way of the dot.
const LONGEST_WAY: usize = 400;
/// Contacts listed at most: a grain has a dozen.
const LONGEST_LIST: usize = 32;

/// The panel of one grain.
#[derive(Default)]
pub struct Microscope {
    /// The pair whose way is kept, the last state added, and the way: gap [µm] and force [mN].
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

    fn summons(&mut self, view: &ViewSettings) -> bool {
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
        let Some(world) = simulation.world().filter(|world| !world.grains.is_empty()) else {
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
        table_ui(ui, numbers(world, grain).into_iter());
        let contacts = contacts_of(world, grain as u32);
        self.contacts_ui(ui, world, grain as u32, &contacts, view);
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
        let terms = force_terms(world, contact);
        table_ui(ui, term_rows(contact, &terms).into_iter());
        self.follow(contact, &terms, simulation.generation());
        self.plot_ui(ui, world, contact, &terms);
    }
}

/// Which grain it is.
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
    }
    trails_ui(ui, view);
}

/// Whose ways are drawn.
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

fn row(name: &str, value: String, hint: &str) -> Row {
    Row {
        name: name.to_owned(),
        value,
        hint: hint.to_owned(),
    }
}

/// A vector's components and its length, in `unit` after a factor.
fn vector(v: DVec3, factor: f64, unit: &str) -> String {
    let [x, y, z] = (v * factor).to_array().map(number::short);
    format!("({x}, {y}, {z}) {unit}")
}

/// The numbers of one grain.
fn numbers(world: &World, i: usize) -> Vec<Row> {
    let grains = &world.grains;
    let species = &world.species[usize::from(grains.species[i].0)];
    let (x, v, spin) = (grains.position[i], grains.velocity[i], grains.spin[i]);
    let mass = grains.mass[i];
    let energy = |joules: f64| number::with_prefix(joules, "J");
    let mut rows = vec![
        row("Species", species.name.clone(), ""),
        row(
            "Position",
            vector(x, MILLIMETRES, "mm"),
            "Centre: x to the right, y up, z towards the viewer",
        ),
        row("Velocity", vector(v, MILLIMETRES, "mm/s"), "Of its centre"),
        row("Speed", number::with_prefix(v.length(), "m/s"), ""),
        row("Spin", vector(spin, 1.0, "rad/s"), "Angular velocity"),
        row(
            "Radius",
            format!("{} mm", number::short(MILLIMETRES * grains.radius[i])),
            "Of a polyhedron: to its farthest point",
        ),
        row("Mass", number::with_prefix(1e3 * mass, "g"), ""),
        row(
            "Coordination",
            grains.contact_count[i].to_string(),
            "Partners that it touches, walls too",
        ),
    ];
    if world.wetting().is_some() {
        rows.push(row(
            "Bridges",
            grains.open_bridges[i].to_string(),
            "To grains that it does not touch",
        ));
        rows.push(row(
            "Film",
            number::with_prefix(1e3 * grains.film[i], "L"),
            "Liquid on it, its part in bridges included",
        ));
    }
    let kinetic = 0.5 * mass * v.length_squared();
    rows.extend([
        row("Kinetic energy", energy(kinetic), "Of translation: ½ m v²"),
        row(
            "Rotational energy",
            energy(world.rotational_energy(i)),
            "½ I ω²",
        ),
        row(
            "Potential energy",
            energy(-mass * world.gravity.dot(x)),
            "−m g·x, from the origin",
        ),
    ]);
    rows
}

/// The contacts and bridges of a grain.
fn contacts_of(world: &World, grain: u32) -> Vec<&Contact> {
    let concerns =
        |contact: &&Contact| contact.grain == grain || contact.partner == Partner::Grain(grain);
    let contacts = world.contacts.iter().filter(concerns);
    contacts.take(LONGEST_LIST).collect()
}

/// What is on the other side of `contact` from `grain`.
fn other_side(contact: &Contact, grain: u32) -> Partner {
    match contact.partner {
        Partner::Grain(j) if j == grain => Partner::Grain(contact.grain),
        partner => partner,
    }
}

/// What the list says of a contact.
fn name(world: &World, contact: &Contact, grain: u32) -> String {
    let side = match other_side(contact, grain) {
        Partner::Grain(j) => format!("Grain {j}"),
        Partner::Wall(w) => world.container.walls[w as usize].name.clone(),
    };
    let force = number::with_prefix(contact.force.length(), "N");
    let kind = match (contact.touching, contact.bridge.is_some()) {
        (true, false) => "touches",
        (true, true) => "touches, wet",
        (false, _) => "bridge",
    };
    format!("{} · {kind} · {force}", number::capitalised(&side))
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

    /// Adds the state of `generation` to the way of the dot.
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

/// Where a contact stands: gap [µm] and force that pushes apart [mN].
fn dot(terms: &ForceTerms) -> [f64; 2] {
    let of_bodies = terms.feature.is_some();
    let force = if of_bodies {
        terms.normal_spring
    } else {
        terms.force()
    };
    [-MICROMETRES * terms.overlap, -1e3 * force.dot(terms.normal)]
}

/// A curve of the law.
struct LawCurve {
    name: &'static str,
    /// Whether it is the law of this run.
    own: bool,
    /// Whether it counts the speed of approach.
    moving: bool,
    points: Vec<[f64; 2]>,
}

impl LawCurve {
    fn ui(self, plot: &mut PlotUi, index: usize, palette: Palette) {
        let colour = if self.own {
            palette.angle
        } else {
            palette.temperature
        };
        let line = Line::new(self.name, self.points)
            .color(colour)
            .width(if self.own && self.moving { 2.2 } else { 1.4 });
        plot.line(if self.moving {
            line.style(if self.own {
                LineStyle::Solid
            } else {
                LineStyle::Dashed {
                    length: dash(index),
                }
            })
        } else {
            line.style(LineStyle::dotted_dense())
        });
    }
}

/// The curves under the dot of `contact`.
fn curves(world: &World, contact: &Contact, terms: &ForceTerms) -> Vec<LawCurve> {
    if terms.feature.is_some() {
        return vec![spring_of_features(terms)];
    }
    let own = world
        .wetting()
        .map_or(BridgeLaw::AS_PRINTED, |liquid| liquid.law);
    let wet = world.wetting().is_some() && matches!(contact.partner, Partner::Grain(_));
    let mut laws = vec![
        ("as printed", BridgeLaw::AS_PRINTED),
        ("as coded", BridgeLaw::AS_CODED),
    ];
    if !wet {
        laws = vec![("law", own)];
    } else if !laws.iter().any(|(_, law)| *law == own) {
        laws.push(("this scene", own));
    }
    let reach = reach(world, contact, terms, &laws);
    let mut curves = Vec::new();
    for (name, choice) in laws {
        let law = NormalLaw::of(world, contact, choice);
        let is_own = choice == own;
        let curve = |name, approach: f64, moving| LawCurve {
            name,
            own: is_own,
            moving,
            points: sample(reach, law.rupture_gap(), |gap| law.force(gap, approach)),
        };
        curves.push(curve(name, terms.approach, true));
        if is_own {
            curves.push(curve("at rest", 0.0, false));
        }
    }
    curves
}

/// The gaps to draw [m]: as deep as the contact is or a little more; of grains that do not touch, as far as a bridge reaches.
fn reach(
    world: &World,
    contact: &Contact,
    terms: &ForceTerms,
    laws: &[(&str, BridgeLaw)],
) -> (f64, f64) {
    let radius = world.grains.radius[contact.grain as usize];
    let deepest = (1.6 * terms.overlap).max(1e-4 * radius);
    let rupture = (laws.iter())
        .filter_map(|(_, law)| NormalLaw::of(world, contact, *law).rupture_gap())
        .fold(0.0, f64::max);
    if terms.overlap > 0.0 {
        // Bridges reach a hundred times as far as grains overlap: drawn whole they would hide the contact.
        (-deepest, 3.0 * deepest)
    } else {
        (-deepest, (1.1 * rupture).max(0.8 * deepest))
    }
}

/// The points of a curve; close together near the moment of touching and on either side of a rupture.
fn sample(
    (from, to): (f64, f64),
    rupture: Option<f64>,
    force: impl Fn(f64) -> f64,
) -> Vec<[f64; 2]> {
    let half = CURVE / 2;
    let share = |k: usize| k as f64 / half as f64;
    let mut gaps: Vec<f64> = (0..half).map(|k| from * (1.0 - share(k)).powi(2)).collect();
    gaps.extend((0..=half).map(|k| to * share(k).powi(2)));
    gaps.extend(
        rupture
            .into_iter()
            .flat_map(|gap| [gap, gap * (1.0 + 1e-9)]),
    );
    gaps.sort_by(f64::total_cmp);
    let point = |gap: f64| [MICROMETRES * gap, 1e3 * force(gap)];
    gaps.into_iter().map(point).collect()
}

/// The normal spring of a pair of features, which share the pair's stiffness.
fn spring_of_features(terms: &ForceTerms) -> LawCurve {
    let stiffness = terms.normal_spring.length() / terms.overlap;
    let deepest = 1.6 * terms.overlap;
    LawCurve {
        name: "law",
        own: true,
        moving: false,
        points: sample((-deepest, 0.8 * deepest), None, |gap| {
            stiffness * (-gap).max(0.0)
        }),
    }
}

/// How the two sides of `contact` stand and move, every term of its force, and the sum.
fn term_rows(contact: &Contact, terms: &[ForceTerms]) -> Vec<Row> {
    let mut rows = motion_rows(terms);
    rows.extend(normal_rows(contact, terms));
    rows.extend(tangential_rows(contact, terms));
    let sum: DVec3 = terms.iter().map(ForceTerms::force).sum();
    rows.extend([
        row(
            "Sum of the terms",
            newtons(sum.length()),
            "Of all forces above",
        ),
        row(
            "Applied",
            newtons(contact.force.length()),
            "What the solver applied in the last step",
        ),
    ]);
    rows
}

fn newtons(force: f64) -> String {
    number::with_prefix(force, "N")
}

fn deepest(terms: &[ForceTerms]) -> f64 {
    (terms.iter().map(|t| t.overlap)).fold(f64::NEG_INFINITY, f64::max)
}

fn motion_rows(terms: &[ForceTerms]) -> Vec<Row> {
    let (approach, slip) = (terms.first()).map_or((0.0, 0.0), |t| (t.approach, t.slip.length()));
    let (place, length) = match deepest(terms) {
        overlap if overlap > 0.0 => ("Overlap δ", overlap),
        gap => ("Gap D", -gap),
    };
    let speed = |v: f64| number::with_prefix(v, "m/s");
    let mut rows = vec![
        row(
            place,
            number::with_prefix(length, "m"),
            "At the deepest place where the two touch",
        ),
        row(
            "Approach",
            speed(approach),
            "Along the normal, half a step ago; negative while parting",
        ),
        row("Slip", speed(slip), "Of one surface over the other"),
    ];
    if terms.iter().any(|t| t.feature.is_some()) {
        let places = terms.len().to_string();
        rows.push(row("Places", places, "Pairs of features that touch"));
    }
    rows
}

fn normal_rows(contact: &Contact, terms: &[ForceTerms]) -> Vec<Row> {
    let along =
        |of: fn(&ForceTerms) -> DVec3| newtons(terms.iter().map(|t| -of(t).dot(t.normal)).sum());
    let mut rows = vec![
        row(
            "Normal spring",
            along(|t| t.normal_spring),
            "k_n δ, positive where it pushes apart",
        ),
        row(
            "Normal dashpot",
            along(|t| t.normal_dashpot),
            "η_n times the speed of approach",
        ),
    ];
    if contact.bridge.is_some() {
        rows.push(row(
            "Capillary",
            along(|t| t.capillary),
            "Eq. 13 of Kasper et al. 2021; negative where it pulls together",
        ));
        rows.push(row(
            "Viscous, normal",
            along(|t| t.viscous_normal),
            "Eq. 16 of Kasper et al. 2021",
        ));
    }
    rows
}

fn tangential_rows(contact: &Contact, terms: &[ForceTerms]) -> Vec<Row> {
    let across = |of: fn(&ForceTerms) -> DVec3| {
        let sum: DVec3 = terms.iter().map(of).sum();
        newtons(sum.length())
    };
    let mut rows = vec![
        row(
            "Tangential spring",
            across(|t| t.tangential_spring),
            "k_t times the elastic slip ξ",
        ),
        row(
            "Tangential dashpot",
            across(|t| t.tangential_dashpot),
            "η_t times the slip velocity; none while it slides",
        ),
    ];
    if contact.bridge.is_some() {
        rows.push(row(
            "Viscous, tangential",
            across(|t| t.viscous_tangential),
            "Eq. 17 of Kasper et al. 2021",
        ));
    }
    if deepest(terms) > 0.0 {
        rows.push(row(
            "Coulomb bound",
            bound(terms),
            "μ times the normal force: what the tangential force cannot exceed",
        ));
    }
    let rolling: DVec3 = terms.iter().map(|t| t.rolling).sum();
    rows.push(row(
        "Rolling torque",
        number::with_prefix(rolling.length(), "N m"),
        "Eq. 10 of Kasper et al. 2021, from the torque of now",
    ));
    rows
}

/// The Coulomb bound and how much of it is used.
fn bound(terms: &[ForceTerms]) -> String {
    let bound: f64 = terms.iter().map(|t| t.coulomb_bound).sum();
    let used: f64 = terms.iter().map(|t| t.tangential_spring.length()).sum();
    let state = if terms.iter().all(|t| t.slides) {
        "slides".to_owned()
    } else {
        format!("{} % used", number::fixed(100.0 * used / bound, 0))
    };
    format!("{} · {state}", number::with_prefix(bound, "N"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curve_holds_both_sides_of_the_rupture_and_the_moment_of_touching() {
        let points = sample((-1e-6, 1e-4), Some(5e-5), |gap| f64::from(gap <= 5e-5));
        assert!(points.is_sorted_by(|a, b| a[0] <= b[0]));
        assert!(points.iter().any(|p| p[0] == 0.0));
        let fall = points.windows(2).find(|w| w[0][1] > w[1][1]).unwrap();
        assert!(fall[1][0] - fall[0][0] < 1e-6, "{fall:?}");
    }
}
