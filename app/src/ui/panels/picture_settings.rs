//! How the picture is drawn: what colours mean, a cut, the container, the side it is seen from.
//!
//! In: the view's settings. Out: the same settings changed, and requests to the camera.

use crate::simulation::Simulation;
use crate::ui::panel::{Panel, has_bed};
use crate::ui::request::Request;
use crate::ui::widgets::combo::combo_ui;
use crate::ui::widgets::field::{Field, slip_ui};
use crate::view::{
    Background, CameraRequest, ColourBy, ColourMap, ColourRange, CoordinateAxis, Cut,
    ProjectionKind, SAVED_VIEWS, StandardView, ViewSettings,
};
use bevy_egui::egui::{self, WidgetInfo, WidgetType};
use glam::DVec3;
use grainfall::world::{Shape, World};
use std::ops::RangeInclusive;

/// Millimetres per metre: positions of cuts are shown in millimetres.
const MILLIMETRES: f64 = 1e3;

/// What is drawn as measured.
pub const MEASURED_HINT: &str = "The line whose slope is the surface angle θ; the front R and the height H of a heap. Each is \
                                 drawn where it is measured, with the number that goes into the plot.";

/// What is drawn of the flowing layer.
const FLOW_HINT: &str = "The mean velocity over the depth below the middle of the surface, and the depth at which it changes its \
                         sign, averaged over the samples in which the bed flows";
/// What the veil shows.
const VEIL_HINT: &str = "Tg of the grains in each cell of the cross-section, in the drum's frame: where grains move past each \
                         other now";

/// The panel of the picture's settings.
#[derive(Default)]
pub struct PictureSettings;

impl PictureSettings {
    /// What stands over it.
    pub const TITLE: &'static str = "Picture";
}

impl Panel for PictureSettings {
    fn title(&self) -> &'static str {
        Self::TITLE
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        let world = simulation.world().map(AsRef::as_ref);
        colour_ui(ui, view, world);
        cut_ui(ui, view, world);
        turning_ui(ui, view, world);
        between_ui(ui, view, world.is_some_and(|world| world.liquid.is_some()));
        ui.horizontal(|ui| {
            ui.checkbox(&mut view.show_container, "Container");
            let opacity =
                egui::Slider::new(&mut view.container_opacity, 0.0..=1.0).show_value(false);
            let response = ui.add_enabled(view.show_container, opacity);
            let value = f64::from(view.container_opacity);
            response.widget_info(|| {
                WidgetInfo::slider(view.show_container, value, "Container opacity")
            });
            response.on_hover_text("How strongly the drum or box is drawn");
        });
        ui.checkbox(&mut view.show_overlay, "Scale bar, clock and legend");
        ui.checkbox(&mut view.show_measured, "What is measured")
            .on_hover_text(MEASURED_HINT);
        if has_bed(simulation) {
            ui.checkbox(&mut view.show_flow, "Flowing layer")
                .on_hover_text(FLOW_HINT);
            ui.checkbox(&mut view.show_temperature, "Granular temperature as a veil")
                .on_hover_text(VEIL_HINT);
        }
        ui.checkbox(&mut view.show_axes, "Axes");
        choices_ui(
            ui,
            "Background",
            &mut view.background,
            &[(Background::Dark, "Dark"), (Background::Light, "Light")],
        );
        choices_ui(
            ui,
            "Depth",
            &mut view.projection,
            &[
                (ProjectionKind::Perspective, "Perspective"),
                (ProjectionKind::Orthographic, "Parallel"),
            ],
        );
        camera_ui(ui, out);
    }
}

fn colour_ui(ui: &mut egui::Ui, view: &mut ViewSettings, world: Option<&World>) {
    let before = view.colour_by;
    let offered = |by: &ColourBy| *by == before || world.is_none_or(|world| by.applies(world));
    let by: Vec<_> = ColourBy::all()
        .filter(offered)
        .map(|choice| (choice, choice.label()))
        .collect();
    choice_ui(ui, "Colour by", &mut view.colour_by, &by);
    if view.colour_by != before && matches!(view.range, ColourRange::Fixed(..)) {
        // The numbers were of another quantity.
        view.range = ColourRange::Automatic;
    }
    if view.colour_by == ColourBy::Species {
        return;
    }
    let maps = ColourMap::ALL.map(|choice| (choice, choice.label()));
    choice_ui(ui, "Colour map", &mut view.colour_map, &maps);
    gradient_ui(ui, view.colour_map);
    ui.checkbox(
        &mut view.log_colours,
        "Equal steps of colour are equal factors",
    )
    .on_hover_text("A logarithmic scale: for what is small in most grains and large in a few");
    range_ui(ui, view);
}

fn range_ui(ui: &mut egui::Ui, view: &mut ViewSettings) {
    let shown = view
        .legend
        .as_ref()
        .map_or((0.0, 1.0), |legend| (legend.min, legend.max));
    ui.horizontal(|ui| {
        ui.label("Range");
        let is_fixed = matches!(view.range, ColourRange::Fixed(..));
        let by_shares = matches!(view.range, ColourRange::Percentiles(..));
        if ui
            .selectable_label(!is_fixed && !by_shares, "Automatic")
            .clicked()
        {
            view.range = ColourRange::Automatic;
        }
        if ui.selectable_label(by_shares, "Percentile").clicked() && !by_shares {
            view.range = ColourRange::Percentiles(0.05, 0.95);
        }
        if ui.selectable_label(is_fixed, "Fixed").clicked() && !is_fixed {
            view.range = ColourRange::Fixed(shown.0, shown.1);
        }
    });
    match view.range {
        ColourRange::Automatic => {}
        ColourRange::Fixed(low, high) => fixed_ui(ui, view, low, high),
        ColourRange::Percentiles(low, high) => percentiles_ui(ui, view, low, high),
    }
}

/// The shares of the grains that stay below the two ends of the map.
fn percentiles_ui(ui: &mut egui::Ui, view: &mut ViewSettings, low: f64, high: f64) {
    let (mut low, mut high) = (100.0 * low, 100.0 * high);
    ends_ui(ui, [&mut low, &mut high], 0.0..=100.0, "%", 0.5);
    ui.weak("of the grains");
    view.range = ColourRange::Percentiles(0.01 * low, 0.01 * high);
}

fn fixed_ui(ui: &mut egui::Ui, view: &mut ViewSettings, mut low: f64, mut high: f64) {
    let speed = 0.005 * (high - low).abs().max(1e-6);
    let unit = view.colour_by.unit();
    let least = match view.colour_by.quantity() {
        Some(quantity) if quantity.is_signed() => f64::NEG_INFINITY,
        _ => 0.0,
    };
    ends_ui(
        ui,
        [&mut low, &mut high],
        least..=f64::INFINITY,
        unit,
        speed,
    );
    view.range = ColourRange::Fixed(low, high);
}

/// The two ends of a range within `limits`, neither beyond the other.
fn ends_ui(
    ui: &mut egui::Ui,
    [low, high]: [&mut f64; 2],
    limits: RangeInclusive<f64>,
    unit: &str,
    speed: f64,
) {
    let (below, above) = (*limits.start()..=*high, *low..=*limits.end());
    let typed = ui.horizontal(|ui| {
        [("from", low, below), ("to", high, above)].map(|(label, value, range)| {
            let field = Field {
                label,
                range,
                unit,
                // A tenth of what a point of a drag changes.
                decimals: 0..=(1.0 - speed.log10()).ceil().clamp(0.0, 12.0) as usize,
                is_whole: false,
                speed,
                size: None,
            };
            ui.label(label);
            field.ui(ui, value)
        })
    });
    for response in &typed.inner {
        slip_ui(ui, response);
    }
}

/// The colour map as a bar.
fn gradient_ui(ui: &mut egui::Ui, map: ColourMap) {
    let size = egui::vec2(ui.available_width(), 10.0);
    let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let steps = (rect.width() / 3.0).ceil().max(1.0) as usize;
    let mut mesh = egui::Mesh::default();
    for step in 0..=steps {
        let t = step as f32 / steps as f32;
        let [r, g, b] = map.colour(f64::from(t));
        let colour = egui::Color32::from_rgb(r, g, b);
        let x = egui::lerp(rect.x_range(), t);
        mesh.colored_vertex(egui::pos2(x, rect.top()), colour);
        mesh.colored_vertex(egui::pos2(x, rect.bottom()), colour);
        if step > 0 {
            let last = 2 * step as u32;
            mesh.add_triangle(last - 2, last - 1, last);
            mesh.add_triangle(last - 1, last, last + 1);
        }
    }
    ui.painter().add(mesh);
}

fn cut_ui(ui: &mut egui::Ui, view: &mut ViewSettings, world: Option<&World>) {
    let across = match view.cut {
        Some(Cut::Beyond { .. }) => view.cut,
        _ => Some(Cut::Beyond {
            axis: CoordinateAxis::Z,
            position: 0.0,
        }),
    };
    let (x, z) = world.map_or((0.0, 0.0), middle);
    choices_ui(
        ui,
        "Cut",
        &mut view.cut,
        &[
            (None, "Nothing"),
            (across, "Across"),
            (Some(Cut::Quarter { x, z }), "Quarter"),
        ],
    );
    let Some(Cut::Beyond { axis, position }) = &mut view.cut else {
        return;
    };
    let axes = CoordinateAxis::ALL.map(|axis| (axis, axis.label()));
    choices_ui(ui, "Beyond along", axis, &axes);
    let extent = world.map_or(-1.0..=1.0, |world| extent(world, *axis));
    let mut shown = *position * MILLIMETRES;
    let range = extent.start() * MILLIMETRES..=extent.end() * MILLIMETRES;
    let slider = egui::Slider::new(&mut shown, range)
        .suffix(" mm")
        .fixed_decimals(1);
    let response = ui.add(slider);
    response.widget_info(|| WidgetInfo::slider(true, shown, "Cut position"));
    if response.changed() {
        *position = shown / MILLIMETRES;
    }
}

/// The upright line, by x and z [m], round which a quarter is cut out.
fn middle(world: &World) -> (f64, f64) {
    match world.container.shape {
        Shape::Box { min, max } | Shape::Mesh { min, max } => {
            let middle = 0.5 * (min + max);
            (middle.x, middle.z)
        }
        Shape::Drum { .. } | Shape::Column { .. } | Shape::Planes => (0.0, 0.0),
    }
}

/// Where along `axis` there is something to cut [m]: the container, or where it is unbounded the
/// grains.
fn extent(world: &World, axis: CoordinateAxis) -> RangeInclusive<f64> {
    let (low, high) = match world.container.shape {
        Shape::Drum { radius, width } => {
            let half = DVec3::new(radius, radius, 0.5 * width);
            (-half, half)
        }
        Shape::Box { min, max } | Shape::Mesh { min, max } => (min, max),
        Shape::Planes | Shape::Column { .. } => {
            let grains = world.grains.position.iter().zip(&world.grains.radius);
            grains.fold(
                (DVec3::INFINITY, DVec3::NEG_INFINITY),
                |(low, high), (x, r)| (low.min(*x - *r), high.max(*x + *r)),
            )
        }
    };
    let (low, high) = (low.dot(axis.unit()), high.dot(axis.unit()));
    if low < high { low..=high } else { -1.0..=1.0 }
}

/// Whether spheres have a pattern; polyhedra show by themselves how they lie.
fn turning_ui(ui: &mut egui::Ui, view: &mut ViewSettings, world: Option<&World>) {
    let Some(world) = world.filter(|world| world.polyhedra.is_none()) else {
        return;
    };
    let mut shows = view.shows_turning(world);
    let hint = "A dark half and a band on each grain, by which one sees it turn";
    if ui
        .checkbox(&mut shows, "Pattern on grains")
        .on_hover_text(hint)
        .changed()
    {
        view.show_turning = Some(shows);
    }
}

/// What is drawn between the grains, and how much of them is in its way.
fn between_ui(ui: &mut egui::Ui, view: &mut ViewSettings, wet: bool) {
    let mut forces = view.show_forces;
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut forces, "Forces").on_hover_text(
            "A bar from grain to grain, as thick as the force; one that pulls has a waist",
        );
        if wet {
            ui.checkbox(&mut view.show_bridges, "Bridges")
                .on_hover_text("The liquid between two grains, as wide as its volume makes it");
        }
        ui.checkbox(&mut view.show_velocities, "Velocities")
            .on_hover_text("An arrow from each centre, as long as the grain is fast");
    });
    view.draw_forces(forces);
    ui.horizontal(|ui| {
        ui.label("Grain size");
        let mut size = 100.0 * view.grain_size;
        let slider = egui::Slider::new(&mut size, 10.0..=100.0)
            .suffix(" %")
            .fixed_decimals(0);
        let response = ui.add(slider);
        let value = f64::from(size);
        response.widget_info(|| WidgetInfo::slider(true, value, "Grain size"));
        if response.changed() {
            view.grain_size = 0.01 * size;
        }
    });
    if view.grain_size < 1.0 {
        let mut shows = view.shows_ghosts();
        let hint = "What smaller grains are at full size, as thin as glass";
        if ui
            .checkbox(&mut shows, "Ghosts at full size")
            .on_hover_text(hint)
            .changed()
        {
            view.show_ghosts = Some(shows);
        }
    }
}

fn camera_ui(ui: &mut egui::Ui, out: &mut Vec<Request>) {
    ui.label("Look from");
    ui.horizontal_wrapped(|ui| {
        for side in StandardView::ALL {
            let name = side.label();
            let short = name.split(' ').next().unwrap_or(name);
            let response = ui.button(short).on_hover_text(format!("Look from {name}"));
            response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, name));
            if response.clicked() {
                out.push(Request::Camera(CameraRequest::From(side)));
            }
        }
        if ui
            .button("Fit")
            .on_hover_text("Everything in view (F)")
            .clicked()
        {
            out.push(Request::Camera(CameraRequest::Fit));
        }
        if ui
            .button("Home")
            .on_hover_text("As the scene opened (Home)")
            .clicked()
        {
            out.push(Request::Camera(CameraRequest::Home));
        }
    });
    kept_views_ui(ui, out);
}

/// Views that are kept and shown again, by their numbers.
fn kept_views_ui(ui: &mut egui::Ui, out: &mut Vec<Request>) {
    type Row = (
        &'static str,
        &'static str,
        &'static str,
        fn(usize) -> CameraRequest,
    );
    let rows: [Row; 2] = [
        ("Keep", "Keep this view", "Shift+F", CameraRequest::Save),
        (
            "Show",
            "Back to the view that was kept",
            "F",
            CameraRequest::Recall,
        ),
    ];
    egui::Grid::new("kept views").num_columns(2).show(ui, |ui| {
        for (verb, hint, key, request) in rows {
            ui.label(format!("{verb} view"));
            ui.horizontal(|ui| {
                for number in 0..SAVED_VIEWS {
                    let shown = number + 1;
                    let hint = format!("{hint} ({key}{})", 5 + number);
                    let response = ui.button(shown.to_string()).on_hover_text(hint);
                    let name = format!("{verb} {shown}");
                    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &name));
                    if response.clicked() {
                        out.push(Request::Camera(request(number)));
                    }
                }
            });
            ui.end_row();
        }
    });
}

/// A list of `choices` of which one is the `value`.
fn choice_ui<T: Copy + PartialEq>(
    ui: &mut egui::Ui,
    label: &str,
    value: &mut T,
    choices: &[(T, &str)],
) {
    let present = choices.iter().find(|choice| choice.0 == *value);
    combo_ui(ui, label, present.map_or("", |choice| choice.1), |ui| {
        for (choice, name) in choices {
            ui.selectable_value(value, *choice, *name);
        }
    });
}

fn choices_ui<T: Copy + PartialEq>(
    ui: &mut egui::Ui,
    label: &str,
    value: &mut T,
    choices: &[(T, &str)],
) {
    ui.horizontal_wrapped(|ui| {
        ui.label(label);
        for (choice, name) in choices {
            ui.selectable_value(value, *choice, *name);
        }
    });
}
