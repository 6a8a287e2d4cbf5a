//! How the picture is drawn: what colours mean, a cut, the container, the side it is seen from.
//!
//! In: the view's settings. Out: the same settings changed, and requests to the camera.

use super::{Panel, Request};
use crate::simulation::Simulation;
use crate::view::{
    Axis, Background, CameraRequest, ColourBy, ColourMap, ColourRange, Cut, ProjectionKind, Side,
    ViewSettings,
};
use crate::world::{Shape, World};
use bevy_egui::egui::{self, WidgetInfo, WidgetType};
use glam::DVec3;
use std::ops::RangeInclusive;

/// Millimetres per metre: positions of cuts are shown in millimetres.
const MILLIMETRES: f64 = 1e3;

/// The panel of the picture's settings.
#[derive(Default)]
pub struct Picture;

impl Panel for Picture {
    fn title(&self) -> &'static str {
        "Picture"
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        colour_ui(ui, view);
        cut_ui(ui, view, simulation.world().map(AsRef::as_ref));
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

fn colour_ui(ui: &mut egui::Ui, view: &mut ViewSettings) {
    let by = ColourBy::ALL.map(|choice| (choice, choice.label()));
    combo_ui(ui, "Colour by", &mut view.colour_by, &by);
    if view.colour_by == ColourBy::Species {
        return;
    }
    let maps = ColourMap::ALL.map(|choice| (choice, choice.label()));
    combo_ui(ui, "Colour map", &mut view.colour_map, &maps);
    gradient_ui(ui, view.colour_map);
    range_ui(ui, view);
}

fn range_ui(ui: &mut egui::Ui, view: &mut ViewSettings) {
    let shown = view
        .legend
        .as_ref()
        .map_or((0.0, 1.0), |legend| (legend.min, legend.max));
    ui.horizontal(|ui| {
        ui.label("Range");
        let automatic = view.range == ColourRange::Automatic;
        if ui.selectable_label(automatic, "Automatic").clicked() {
            view.range = ColourRange::Automatic;
        }
        if ui.selectable_label(!automatic, "Fixed").clicked() && automatic {
            view.range = ColourRange::Fixed(shown.0, shown.1);
        }
    });
    let ColourRange::Fixed(mut low, mut high) = view.range else {
        return;
    };
    let unit = view.colour_by.unit();
    let (least, most) = (0.0..=high, low..=f64::INFINITY);
    ui.horizontal(|ui| {
        let speed = 0.005 * (high - low).abs().max(1e-6);
        for (name, value, range) in [("from", &mut low, least), ("to", &mut high, most)] {
            let label = ui.label(name);
            let field = egui::DragValue::new(value)
                .range(range)
                .speed(speed)
                .suffix(format!(" {unit}"));
            ui.add(field).labelled_by(label.id);
        }
    });
    view.range = ColourRange::Fixed(low, high);
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
            axis: Axis::Z,
            position: 0.0,
        }),
    };
    let (x, z) = world.map_or((0.0, 0.0), middle);
    choices_ui(
        ui,
        "Cut away",
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
    let axes = Axis::ALL.map(|axis| (axis, axis.label()));
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
        Shape::Box { min, max } => {
            let middle = 0.5 * (min + max);
            (middle.x, middle.z)
        }
        Shape::Drum { .. } | Shape::Column { .. } | Shape::Planes => (0.0, 0.0),
    }
}

/// Where along `axis` there is something to cut [m]: the container, or where it is unbounded the grains.
fn extent(world: &World, axis: Axis) -> RangeInclusive<f64> {
    let (low, high) = match world.container.shape {
        Shape::Drum { radius, width } => {
            let half = DVec3::new(radius, radius, 0.5 * width);
            (-half, half)
        }
        Shape::Box { min, max } => (min, max),
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

fn camera_ui(ui: &mut egui::Ui, out: &mut Vec<Request>) {
    ui.label("Look from");
    ui.horizontal_wrapped(|ui| {
        for side in Side::ALL {
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
}

fn combo_ui<T: Copy + PartialEq>(
    ui: &mut egui::Ui,
    label: &str,
    value: &mut T,
    choices: &[(T, &str)],
) {
    let present = choices.iter().find(|choice| choice.0 == *value);
    ui.horizontal(|ui| {
        ui.label(label);
        let response = egui::ComboBox::from_id_salt(label)
            .selected_text(present.map_or("", |choice| choice.1))
            .width(ui.available_width() - 8.0)
            .show_ui(ui, |ui| {
                for (choice, name) in choices {
                    ui.selectable_value(value, *choice, *name);
                }
            })
            .response;
        response.widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, true, label));
    });
}

fn choices_ui<T: Copy + PartialEq>(
    ui: &mut egui::Ui,
    label: &str,
    value: &mut T,
    choices: &[(T, &str)],
) {
    ui.horizontal(|ui| {
        ui.label(label);
        for (choice, name) in choices {
            ui.selectable_value(value, *choice, *name);
        }
    });
}
