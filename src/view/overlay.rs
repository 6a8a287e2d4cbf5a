//! What is written into the picture: scale bar, simulated time, speed relative to real time, and what the colours mean.
//!
//! In: the free part of the window, camera, settings and what is shown. Out: egui shapes. Nothing here reacts to the
//! pointer but [`viewport_ui`], which hands it to the camera.

use super::camera::apply_response;
use super::colour::{Scheme, species_colour};
use super::container::ring_distance;
use super::links::{LIQUID, PULL, PUSH, VELOCITY};
use super::pick::pick;
use super::{Axis, ColourMap, Legend, OrbitCamera, ViewSettings};
use crate::world::{self, World};
use bevy::color::{Color, ColorToPacked};
use bevy::math::{Vec2, Vec3};
use bevy_egui::egui::{
    Align2, Color32, CornerRadius, FontId, Id, Mesh, Painter, Pos2, Rect, Sense, Shape, Stroke,
    StrokeKind, Ui, pos2, vec2,
};

/// Distance of everything from the edge of the picture, in points.
const INSET: f32 = 18.0;
/// sRGB colour of what is selected.
const SELECTED: [u8; 3] = [0xFF, 0xE0, 0x66];
/// Length that the scale bar does not exceed, in points.
const LONGEST_BAR: f32 = 180.0;

/// What the overlay says beside what the settings know.
#[derive(Clone, Copy, Debug)]
pub struct Caption<'a> {
    /// The world shown.
    pub world: Option<&'a World>,
    /// Simulated seconds per second on the wall, while running.
    pub real_time_factor: Option<f64>,
}

/// The free part of the window: call it after all panels with what they left. The pointer moves the camera there, the
/// picture is fitted into it, and the overlay is drawn.
pub fn viewport_ui(
    ui: &mut Ui,
    caption: Caption,
    settings: &mut ViewSettings,
    camera: &mut OrbitCamera,
) {
    let rect = ui.available_rect_before_wrap();
    settings.free_rect = Some(rect);
    settings.pixels_per_point = ui.ctx().pixels_per_point();
    let response = ui.interact(rect, Id::new("picture"), Sense::click_and_drag());
    apply_response(&response, camera);
    if let (Some(world), Some(at)) = (caption.world, response.interact_pointer_pos())
        && response.clicked()
    {
        let at = at - rect.min;
        let picked = pick(world, camera, settings, Vec2::new(at.x, at.y));
        if picked != settings.selected {
            (settings.selected, settings.beside) = (picked, None);
        }
    }
    if settings.show_overlay {
        overlay(&ui.painter_at(rect), rect, caption, settings, camera);
    }
}

/// Draws the overlay into `rect`.
pub fn overlay(
    painter: &Painter,
    rect: Rect,
    caption: Caption,
    settings: &ViewSettings,
    camera: &OrbitCamera,
) {
    let scheme = Scheme::of(settings.background);
    let ink = Ink {
        painter,
        text: rgb(scheme.text),
        faint: rgb(scheme.faint_text),
        veil: rgb(srgb(scheme.background)).gamma_multiply(0.75),
    };
    let inner = rect.shrink(INSET);
    if let Some(world) = caption.world {
        if let world::Shape::Column { radius, .. } = world.container.shape
            && settings.show_container
        {
            ring_labels(&ink, rect, camera, world, radius);
        }
        clock(
            &ink,
            inner.left_top(),
            world.time(),
            caption.real_time_factor,
        );
        trail(&ink, rect, camera, settings);
        selection(&ink, rect, camera, world, settings);
        if settings.legend.is_none() && world.species.len() > 1 {
            species(&ink, inner.right_bottom(), world);
        }
    }
    scale_bar(&ink, inner.left_bottom(), camera.metres_per_point());
    links(
        &ink,
        inner.left_bottom() - vec2(0.0, 40.0),
        camera,
        settings,
    );
    if settings.show_axes {
        axes(&ink, inner.right_top() + vec2(-44.0, 44.0), camera);
    }
    if let Some(legend) = &settings.legend {
        colour_bar(&ink, inner.right_bottom(), legend, settings.colour_map);
    }
}

struct Ink<'a> {
    painter: &'a Painter,
    text: Color32,
    faint: Color32,
    veil: Color32,
}

impl Ink<'_> {
    fn write(&self, at: Pos2, anchor: Align2, text: impl ToString, size: f32, colour: Color32) {
        self.painter
            .text(at, anchor, text, FontId::proportional(size), colour);
    }
}

fn clock(ink: &Ink, at: Pos2, time: f64, real_time_factor: Option<f64>) {
    ink.write(at, Align2::LEFT_TOP, format!("{time:.2} s"), 24.0, ink.text);
    if let Some(factor) = real_time_factor {
        let text = format!("{factor:.2} × real time");
        ink.write(
            at + vec2(1.0, 30.0),
            Align2::LEFT_TOP,
            text,
            13.0,
            ink.faint,
        );
    }
}

/// The distance of every fifth ring on the floor from the axis of a column, to the right before it, where no grains lie.
fn ring_labels(ink: &Ink, rect: Rect, camera: &OrbitCamera, world: &World, radius: f64) {
    const LABELS: usize = 8;
    let step = 5.0 * ring_distance(radius);
    let (sin, cos) = (camera.yaw + 0.7).sin_cos();
    let mut beyond = [0; LABELS];
    for x in &world.grains.position {
        let ring = (x.x.hypot(x.z) / step) as usize;
        beyond[ring.min(LABELS - 1)] += 1;
    }
    let mut place_before = Pos2::ZERO;
    for ring in 1..LABELS {
        let outside: usize = beyond[ring..].iter().sum();
        let distance = step * ring as f64;
        let x = distance as f32 * Vec3::new(sin, 0.0, cos);
        let Some((Vec2 { x, y }, _)) = camera.project(x) else {
            return;
        };
        let place = rect.min + vec2(x, y);
        if outside * 100 > world.grains.len() || place.distance(place_before) < 32.0 {
            continue;
        }
        place_before = place;
        let text = length(distance);
        ink.write(place, Align2::CENTER_CENTER, text, 12.0, ink.faint);
    }
}

fn scale_bar(ink: &Ink, at: Pos2, metres_per_point: f32) {
    let bar = ScaleBar::new(f64::from(metres_per_point), f64::from(LONGEST_BAR));
    let stroke = Stroke::new(2.0, ink.text);
    let (left, right) = (at, at + vec2(bar.points as f32, 0.0));
    ink.painter.line_segment([left, right], stroke);
    for end in [left, right] {
        ink.painter
            .line_segment([end - vec2(0.0, 7.0), end], stroke);
    }
    let middle = left + vec2(bar.points as f32 / 2.0, -5.0);
    ink.write(middle, Align2::CENTER_BOTTOM, bar.label(), 13.0, ink.text);
}

fn colour_bar(ink: &Ink, corner: Pos2, legend: &Legend, map: ColourMap) {
    let size = vec2(14.0, 150.0);
    let scale = Prefixed::new(legend.max.abs().max(legend.min.abs()), legend.unit);
    let bar = Rect::from_min_size(corner - size - vec2(44.0, 0.0), size);
    let ground = Rect::from_min_max(bar.min - vec2(50.0, 36.0), corner).expand(8.0);
    ink.painter
        .rect_filled(ground, CornerRadius::same(6), ink.veil);
    ink.painter.add(Shape::mesh(gradient(bar, map)));
    ink.painter.rect_stroke(
        bar,
        CornerRadius::ZERO,
        Stroke::new(1.0, ink.faint),
        StrokeKind::Outside,
    );
    for i in 0..=4 {
        let share = f64::from(i) / 4.0;
        let value = (legend.min + share * (legend.max - legend.min)) * scale.factor;
        let at = pos2(bar.right() + 4.0, bar.bottom() - share as f32 * size.y);
        let stroke = Stroke::new(1.0, ink.faint);
        ink.painter.line_segment([at - vec2(4.0, 0.0), at], stroke);
        let text = short_number(value);
        ink.write(
            at + vec2(3.0, 0.0),
            Align2::LEFT_CENTER,
            text,
            12.0,
            ink.text,
        );
    }
    let title = if scale.unit.is_empty() {
        legend.title.to_owned()
    } else {
        format!("{} [{}]", legend.title, scale.unit)
    };
    let at = pos2(corner.x, bar.top() - 14.0);
    ink.write(at, Align2::RIGHT_BOTTOM, title, 13.0, ink.text);
}

/// Rings round the selected grain and the one beside it, over whatever hides them.
fn selection(ink: &Ink, rect: Rect, camera: &OrbitCamera, world: &World, settings: &ViewSettings) {
    let rings = [
        (settings.selected, 2.5, true),
        (settings.beside, 1.5, false),
    ];
    for (grain, width, named) in rings {
        let Some(grain) = grain.filter(|grain| *grain < world.grains.len()) else {
            return;
        };
        let centre = world.grains.position[grain].as_vec3();
        let Some((place, per_metre)) = camera.project(centre) else {
            continue;
        };
        let at = rect.min + vec2(place.x, place.y);
        let own = settings.grain_size * world.grains.radius[grain] as f32;
        let radius = (own * per_metre + 2.0).max(6.0);
        // Dark round light: one of them stands out from any grain.
        let outside = Stroke::new(width + 2.5, Color32::from_black_alpha(170));
        ink.painter.circle_stroke(at, radius, outside);
        ink.painter
            .circle_stroke(at, radius, Stroke::new(width, rgb(SELECTED)));
        if named {
            let text_at = at - vec2(0.0, radius + 4.0);
            let shadow = text_at + vec2(1.0, 1.0);
            let text = format!("grain {grain}");
            for (at, colour) in [(shadow, Color32::BLACK), (text_at, rgb(SELECTED))] {
                ink.write(at, Align2::CENTER_BOTTOM, &text, 13.0, colour);
            }
        }
    }
}

/// Where the selected grain has been.
fn trail(ink: &Ink, rect: Rect, camera: &OrbitCamera, settings: &ViewSettings) {
    if !settings.show_trail {
        return;
    }
    let points = settings.trail.iter().filter_map(|(_, x)| {
        let (place, _) = camera.project(*x)?;
        Some(rect.min + vec2(place.x, place.y))
    });
    let points: Vec<Pos2> = points.collect();
    if points.len() > 1 {
        let stroke = Stroke::new(2.0, rgb(SELECTED).gamma_multiply(0.8));
        ink.painter.add(Shape::line(points, stroke));
    }
}

/// The directions of the axes.
fn axes(ink: &Ink, at: Pos2, camera: &OrbitCamera) {
    const LENGTH: f32 = 30.0;
    let back = camera.rotation().inverse();
    for axis in Axis::ALL {
        let seen = back * axis.unit().as_vec3();
        let tip = vec2(seen.x, -seen.y) * LENGTH;
        ink.painter.arrow(at, tip, Stroke::new(1.8, ink.text));
        let label = at + tip * 1.35;
        ink.write(label, Align2::CENTER_CENTER, axis.label(), 13.0, ink.text);
    }
}

/// What thickness and length of bars and arrows mean, above the scale bar.
fn links(ink: &Ink, corner: Pos2, camera: &OrbitCamera, settings: &ViewSettings) {
    let scales = &settings.link_scales;
    let points = |metres: f64| (metres / f64::from(camera.metres_per_point())) as f32;
    let mut at = corner;
    let mut line = |colour: [u8; 3], size: bevy_egui::egui::Vec2, text: String| {
        let swatch = Rect::from_min_size(at - vec2(0.0, 0.5 * size.y), size);
        ink.painter
            .rect_filled(swatch, CornerRadius::same(2), rgb(colour));
        let text_at = at + vec2(size.x + 8.0, 0.0);
        ink.write(text_at, Align2::LEFT_CENTER, text, 13.0, ink.text);
        at.y -= (size.y + 8.0).max(22.0);
    };
    if let Some(speed) = scales.speed {
        let scale = Prefixed::new(speed, "m/s");
        let text = format!("{} {}", short_number(speed * scale.factor), scale.unit);
        line(VELOCITY, vec2(points(scales.length), 3.0), text);
    }
    if scales.liquid {
        line(
            LIQUID,
            vec2(26.0, 10.0),
            "liquid bridges, to scale".to_owned(),
        );
    }
    if let Some(force) = scales.force {
        let thickness = points(scales.thickness).max(1.0);
        line(PULL, vec2(26.0, 4.0), "pulls (with a waist)".to_owned());
        line(
            PUSH,
            vec2(26.0, thickness),
            format!("pushes with {}", newtons(force)),
        );
    }
}

/// A force [N] with a unit.
fn newtons(force: f64) -> String {
    let (factor, unit) = match force {
        f if f < 0.9e-3 => (1e6, "µN"),
        f if f < 0.9 => (1e3, "mN"),
        _ => (1.0, "N"),
    };
    format!("{} {unit}", short_number(force * factor))
}

fn species(ink: &Ink, corner: Pos2, world: &World) {
    for (i, species) in world.species.iter().rev().enumerate() {
        let at = corner - vec2(8.0, 8.0 + 20.0 * i as f32);
        let index = world.species.len() - 1 - i;
        ink.painter
            .circle_filled(at, 6.0, rgb(species_colour(index)));
        let text_at = at - vec2(13.0, 0.0);
        ink.write(text_at, Align2::RIGHT_CENTER, &species.name, 13.0, ink.text);
    }
}

/// A vertical strip of the colour map, its low end below.
fn gradient(rect: Rect, map: ColourMap) -> Mesh {
    const STEPS: u32 = 48;
    let mut mesh = Mesh::default();
    for i in 0..=STEPS {
        let share = i as f32 / STEPS as f32;
        let colour = rgb(map.colour(f64::from(share)));
        let y = rect.bottom() - share * rect.height();
        mesh.colored_vertex(pos2(rect.left(), y), colour);
        mesh.colored_vertex(pos2(rect.right(), y), colour);
    }
    for i in 0..STEPS {
        mesh.add_triangle(2 * i, 2 * i + 1, 2 * i + 2);
        mesh.add_triangle(2 * i + 1, 2 * i + 3, 2 * i + 2);
    }
    mesh
}

fn srgb(colour: Color) -> [u8; 3] {
    let [r, g, b, _] = colour.to_srgba().to_u8_array();
    [r, g, b]
}

fn rgb([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}

/// A bar of a round length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleBar {
    /// The length it stands for [m].
    pub metres: f64,
    /// How long it is drawn, in points.
    pub points: f64,
}

impl ScaleBar {
    /// The longest bar of 1, 2 or 5 times a power of ten metres that is at most `longest` points.
    pub fn new(metres_per_point: f64, longest: f64) -> Self {
        let room = metres_per_point * longest;
        let decade = 10_f64.powf(room.log10().floor());
        let digit = [5.0, 2.0].into_iter().find(|digit| digit * decade <= room);
        let metres = digit.unwrap_or(1.0) * decade;
        Self {
            metres,
            points: metres / metres_per_point,
        }
    }

    /// Its length with a unit: `20 mm`.
    pub fn label(&self) -> String {
        length(self.metres)
    }
}

/// A round length [m] with a unit.
fn length(metres: f64) -> String {
    let (factor, unit) = match metres {
        // The limits stand between round lengths, so that rounding decides nothing.
        m if m < 0.9e-3 => (1e6, "µm"),
        m if m < 0.09 => (1e3, "mm"),
        m if m < 0.9 => (1e2, "cm"),
        m if m < 900.0 => (1.0, "m"),
        _ => (1e-3, "km"),
    };
    format!("{} {unit}", short_number(metres * factor))
}

/// A unit whose numbers are of handy size.
struct Prefixed {
    factor: f64,
    unit: String,
}

impl Prefixed {
    /// For numbers up to `largest`: metres per second become mm/s or µm/s where that reads better.
    fn new(largest: f64, unit: &str) -> Self {
        let (factor, prefix) = match largest {
            x if !unit.starts_with('m') || x > 0.15 => (1.0, ""),
            x if x > 0.15e-3 => (1e3, "m"),
            _ => (1e6, "µ"),
        };
        Self {
            factor,
            unit: format!("{prefix}{unit}"),
        }
    }
}

/// At most three digits, no trailing zeros.
fn short_number(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let decimals = (2 - x.abs().log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_bar_is_round_and_as_long_as_it_says() {
        for (metres_per_point, label) in [
            (2.0e-4, "20 mm"),
            (1.0e-3, "10 cm"),
            (2.8e-5, "5 mm"),
            (1.2e-6, "200 µm"),
            (0.1, "10 m"),
        ] {
            let bar = ScaleBar::new(metres_per_point, 180.0);
            assert_eq!(bar.label(), label);
            assert!(bar.points <= 180.0 && bar.points > 180.0 / 2.6, "{bar:?}");
            // A billionth: rounding.
            assert!((bar.points * metres_per_point / bar.metres - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn numbers_are_short() {
        for (x, text) in [
            (0.0, "0"),
            (12.5, "12.5"),
            (0.025, "0.025"),
            (1500.0, "1500"),
            (2.0, "2"),
        ] {
            assert_eq!(short_number(x), text);
        }
    }

    #[test]
    fn legend_units_take_a_prefix_where_it_reads_better() {
        assert_eq!(Prefixed::new(0.05, "m/s").unit, "mm/s");
        assert_eq!(Prefixed::new(0.5, "m/s").unit, "m/s");
        assert_eq!(Prefixed::new(0.05, "rad/s").unit, "rad/s");
        assert_eq!(Prefixed::new(8.0, "").unit, "");
    }
}
