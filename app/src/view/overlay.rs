//! What is written into the picture: scale bar, simulated time, speed relative to real time, and
//! what the colours mean.
//!
//! In: the free part of the window, camera, settings and what is shown. Out: egui shapes. Nothing
//! here reacts to the pointer.

use crate::view::bed_marks::veil_map;
use crate::view::camera::OrbitCamera;
use crate::view::colour::{SELECTED, Scheme, species_colour, stride, trail_colour};
use crate::view::framing::ring_distance;
use crate::view::grain_buffer::CutPlanes;
use crate::view::halves::BETWEEN;
use crate::view::ink::{Ink, rgb, srgb};
use crate::view::links::{FORCE_MAP, LinkKind, force_legend};
use crate::view::scale::{Prefixed, ScaleBar, length, short_number, with_unit};
use crate::view::view_settings::{ColourMap, CoordinateAxis, Legend, ViewSettings};
use bevy::math::{Vec2, Vec3};
use bevy_egui::egui::{
    Align2, Color32, CornerRadius, FontId, Mesh, Painter, Pos2, Rect, Shape, Stroke, StrokeKind,
    pos2, vec2,
};
use grainfall::lab::Half;
use grainfall::measure::numeral;
use grainfall::world::{self, World};

/// Distance of everything from the edge of the picture, in points.
const INSET: f32 = 18.0;
/// Length that the scale bar does not exceed, in points.
const LONGEST_BAR: f32 = 180.0;

/// Room for the bar of colours, and for the names of species, at the right of a picture [points].
const LEGEND_MARGIN: f32 = 128.0;
const SPECIES_MARGIN: f32 = 96.0;
/// Height of a bar of colours with its title and the room above it [points].
const LEGEND_HEIGHT: f32 = 216.0;
/// From one name of a species to the next [points].
const SPECIES_HEIGHT: f32 = 20.0;

/// What the overlay of one half of the picture, or of all of it, says beside what the settings
/// know.
#[derive(Clone, Debug)]
pub struct Caption<'a> {
    /// The world shown.
    pub world: Option<&'a World>,
    /// Simulated seconds per second on the wall, while running.
    pub real_time_factor: Option<f64>,
    /// What tells this half from the other.
    pub title: Option<String>,
    /// Whether the moment shown is written into the picture, and how fast it passes.
    pub has_clock: bool,
    /// Whether that, and what is measured, is to be read from the last row of a lecture hall.
    pub is_for_afar: bool,
}

/// Where something is written: which half of the picture, and whether it has the left or the right
/// edge of all of it.
#[derive(Clone, Copy)]
pub(super) struct PicturePart {
    /// Which half.
    pub(super) half: Half,
    /// Whether it has the left edge of the whole picture.
    pub(super) is_first: bool,
    /// Whether it has the right edge of the whole picture.
    pub(super) is_last: bool,
}

/// Draws the overlay of one `part` into `rect`.
pub(super) fn overlay(
    painter: &Painter,
    rect: Rect,
    caption: &Caption,
    part: PicturePart,
    settings: &ViewSettings,
    camera: &OrbitCamera,
) {
    let ink = Ink::new(painter, settings.background);
    let mut inner = rect.shrink(INSET);
    if let Some(title) = &caption.title {
        let is_described = part.half == settings.focus;
        inner.min.y = heading(&ink, rect, title, is_described).bottom() + 10.0;
        if !part.is_last {
            let edge = rect.x_range().max + 0.5 * BETWEEN;
            let stroke = Stroke::new(BETWEEN, ink.faint);
            painter
                .with_clip_rect(rect.expand(BETWEEN))
                .vline(edge, rect.y_range(), stroke);
        }
    }
    if let Some(world) = caption.world {
        if shows_nothing(world, camera) {
            let at = rect.center();
            ink.write(at, Align2::CENTER_CENTER, NOTHING_SHOWN, 16.0, ink.text);
        }
        if let world::Shape::Column { radius, .. } = world.container.shape
            && settings.show_container
        {
            ring_labels(&ink, rect, camera, world, radius);
        }
        if caption.is_for_afar {
            let time = part
                .is_first
                .then(|| (numeral::moment(world.time()), ink.text));
            let measured = settings.measured[part.half.index()].in_words();
            let measured = measured.map(|words| (words, ink.measured));
            let lines = measured.into_iter().chain(time);
            from_afar(&ink, inner.left_top(), rect.size(), lines);
        } else if part.is_first && caption.has_clock {
            let at = inner.left_top();
            clock(&ink, at, world.time(), caption.real_time_factor);
        }
        trails(&ink, rect, camera, part.half, settings);
        selection(&ink, rect, camera, world, settings);
    }
    if part.is_first {
        let corner = inner.left_bottom();
        scale_bar(&ink, corner, camera.metres_per_point());
        links(&ink, corner - vec2(0.0, 40.0), camera, settings);
    }
    if part.is_last && settings.show_axes {
        axes(&ink, inner.right_top() + vec2(-44.0, 44.0), camera);
    }
}

/// Room beside the pictures of `worlds` for what their colours mean [points].
pub(super) fn legend_margin<'a>(
    settings: &ViewSettings,
    mut worlds: impl Iterator<Item = &'a World>,
) -> f32 {
    let has_bar = settings.legend.is_some() || settings.veil.is_some();
    match has_bar || settings.link_scales.force.is_some() {
        _ if !settings.show_overlay => 0.0,
        true => LEGEND_MARGIN,
        false if worlds.any(|world| world.species.len() > 1) => SPECIES_MARGIN,
        false => 0.0,
    }
}

/// How far up from the lower edge of the picture that shows `world` the legend stands [points].
pub(super) fn legend_height(settings: &ViewSettings, world: &World) -> f32 {
    let bars = [
        settings.veil.is_some(),
        settings.link_scales.force.is_some(),
    ];
    let bars = bars.into_iter().filter(|is_there| *is_there).count();
    let lowest = if settings.legend.is_some() || bars > 0 {
        LEGEND_HEIGHT
    } else {
        SPECIES_HEIGHT * world.species.len() as f32
    };
    INSET + lowest + bars as f32 * LEGEND_HEIGHT
}

/// Writes what the colours mean into the margin of `rect`, where no grain is behind it; on a ground
/// like the picture's, unless the picture goes on there.
pub(super) fn legend(
    painter: &Painter,
    rect: Rect,
    settings: &ViewSettings,
    world: Option<&World>,
) {
    let ink = Ink::new(painter, settings.background);
    if !settings.margin_is_free {
        let margin = rect.with_min_x(rect.right() - settings.margin);
        let ground = rgb(srgb(Scheme::of(settings.background).background));
        painter.rect_filled(margin, CornerRadius::ZERO, ground);
    }
    let corner = rect.right_bottom() - vec2(INSET, INSET);
    let forces = force_legend(&settings.link_scales);
    let others = [
        (settings.veil.as_ref(), veil_map()),
        (forces.as_ref(), FORCE_MAP),
    ];
    let others = others
        .into_iter()
        .filter_map(|(own, map)| Some((own?, map)));
    for (place, (own, map)) in (1_u8..).zip(others) {
        let above = corner - vec2(0.0, f32::from(place) * LEGEND_HEIGHT);
        colour_bar(&ink, above, own, map);
    }
    match (&settings.legend, world) {
        (Some(legend), _) => colour_bar(&ink, corner, legend, settings.colour_map),
        (None, Some(world)) if world.species.len() > 1 => species(&ink, corner, world),
        (None, _) => {}
    }
}

/// What a picture without grains says.
const NOTHING_SHOWN: &str = "All grains are outside the picture. F or a double click shows them.";

/// Whether there are grains and the picture shows none of them.
fn shows_nothing(world: &World, camera: &OrbitCamera) -> bool {
    let grains = &world.grains;
    let mut all = grains.position.iter().zip(&grains.radius);
    // A grain whose centre is outside may still be seen; one that fills the picture is not far.
    let is_seen = |x: &glam::DVec3, radius: f64| {
        let near = [
            glam::DVec3::ZERO,
            glam::DVec3::X,
            glam::DVec3::Y,
            glam::DVec3::Z,
        ];
        let mut near = near.into_iter().flat_map(|axis| [axis, -axis]);
        near.any(|way| camera.sees((*x + radius * way).as_vec3()))
    };
    !grains.is_empty() && !all.any(|(x, radius)| is_seen(x, *radius))
}

/// What tells a half from the other, above it; framed where the panels describe it. Returns where
/// it stands.
fn heading(ink: &Ink, rect: Rect, title: &str, is_described: bool) -> Rect {
    let font = FontId::proportional(16.0);
    let room = (rect.width() - 24.0).max(1.0);
    let text = (ink.painter).layout(title.to_owned(), font, ink.text, room);
    let middle = pos2(rect.center().x, rect.top() + 10.0 + 0.5 * text.size().y);
    let place = Rect::from_center_size(middle, text.size());
    let ground = place.expand2(vec2(8.0, 3.0));
    ink.painter
        .rect_filled(ground, CornerRadius::same(5), ink.veil);
    if is_described {
        let stroke = Stroke::new(1.5, ink.text);
        ink.painter
            .rect_stroke(ground, CornerRadius::same(5), stroke, StrokeKind::Inside);
    }
    ink.painter.galley(place.min, text, ink.text);
    ground
}

fn clock(ink: &Ink, at: Pos2, time: f64, real_time_factor: Option<f64>) {
    ink.write(at, Align2::LEFT_TOP, numeral::moment(time), 24.0, ink.text);
    if let Some(factor) = real_time_factor {
        let text = format!("{} real time", numeral::times(factor));
        ink.write(
            at + vec2(1.0, 30.0),
            Align2::LEFT_TOP,
            text,
            13.0,
            ink.faint,
        );
    }
}

/// Writes `lines` one below the other, a twelfth of the height of a picture of this `size`: from
/// fourteen times that height away they span twenty minutes of arc, four times what an eye just
/// reads.
fn from_afar(
    ink: &Ink,
    corner: Pos2,
    size: bevy_egui::egui::Vec2,
    lines: impl Iterator<Item = (String, Color32)>,
) {
    let font = FontId::proportional(size_from_afar(size));
    let mut at = corner;
    for (text, colour) in lines {
        let place = ink.grounded(at, Align2::LEFT_TOP, &text, font.clone(), colour, ink.veil);
        at.y = place.bottom();
    }
}

/// The size of letters that are read from afar, in a picture of this `size` [points]. It takes steps:
/// every size of every letter is drawn once and kept, and a picture can be dragged to any size.
fn size_from_afar(size: bevy_egui::egui::Vec2) -> f32 {
    const STEP: f32 = 4.0;
    let fitting = (size.y / 12.0).min(size.x / 8.0);
    STEP * (fitting / STEP).floor().max(1.0)
}

/// The distance of every fifth ring on the floor from the axis of a column, to the right before it,
/// where neither grains lie nor the legend stands.
fn ring_labels(ink: &Ink, rect: Rect, camera: &OrbitCamera, world: &World, radius: f64) {
    const LABELS: usize = 8;
    let step = 5.0 * ring_distance(radius);
    let (sin, cos) = (camera.yaw + 0.7).sin_cos();
    let mut beyond = [0; LABELS];
    let places = &world.grains.position;
    let looked_at = places.iter().step_by(stride(places.len()));
    for x in looked_at.clone() {
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
        let is_free = place.x < rect.right() && place.distance(place_before) >= 32.0;
        if outside * 100 > looked_at.len() || !is_free {
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
        let value = legend.value(share) * scale.factor;
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
            let is_cut = CutPlanes::of(settings.cut).take_away(centre);
            let text = format!("grain {grain}{}", if is_cut { ", cut away" } else { "" });
            ink.outlined(at - vec2(0.0, radius + 4.0), &text, rgb(SELECTED));
        }
    }
}

/// Where the traced grains have been in this `half`, with their numbers.
fn trails(ink: &Ink, rect: Rect, camera: &OrbitCamera, half: Half, settings: &ViewSettings) {
    for trail in settings.trails.iter().filter(|trail| trail.half == half) {
        let index = settings
            .traced
            .iter()
            .position(|grain| *grain == trail.grain);
        let colour = rgb(trail_colour(index.unwrap_or(0)));
        let points = trail.places.iter().filter_map(|(_, x)| {
            let (place, _) = camera.project(*x)?;
            Some(rect.min + vec2(place.x, place.y))
        });
        let points: Vec<Pos2> = points.collect();
        let Some(head) = points.last().copied() else {
            continue;
        };
        ink.painter
            .add(Shape::line(points, Stroke::new(2.0, colour)));
        if settings.selected != Some(trail.grain) {
            ink.outlined(head - vec2(0.0, 6.0), &trail.grain.to_string(), colour);
        }
    }
}

/// The directions of the axes.
fn axes(ink: &Ink, at: Pos2, camera: &OrbitCamera) {
    const LENGTH: f32 = 30.0;
    let back = camera.rotation().inverse();
    for axis in CoordinateAxis::ALL {
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
    let mut line = |kind: LinkKind, size: bevy_egui::egui::Vec2, text: String| {
        let swatch = Rect::from_min_size(at - vec2(0.0, 0.5 * size.y), size);
        ink.painter
            .rect_filled(swatch, CornerRadius::same(2), rgb(kind.colour()));
        let text_at = at + vec2(size.x + 8.0, 0.0);
        ink.write(text_at, Align2::LEFT_CENTER, text, 13.0, ink.text);
        at.y -= (size.y + 8.0).max(22.0);
    };
    if let Some(speed) = scales.speed {
        let text = with_unit(speed, "m/s");
        line(LinkKind::Velocity, vec2(points(scales.length), 3.0), text);
    }
    if scales.liquid {
        line(
            LinkKind::Liquid,
            vec2(26.0, 10.0),
            "liquid bridges, to scale".to_owned(),
        );
    }
    if let Some(force) = scales.force {
        let thickness = points(scales.thickness).max(1.0);
        line(
            LinkKind::Pull,
            vec2(26.0, 4.0),
            "pulls (with a waist)".to_owned(),
        );
        line(
            LinkKind::Push,
            vec2(26.0, thickness),
            format!("pushes with {}", with_unit(force, "N")),
        );
    }
}

fn species(ink: &Ink, corner: Pos2, world: &World) {
    for (i, species) in world.species.iter().rev().enumerate() {
        let at = corner - vec2(8.0, 8.0 + SPECIES_HEIGHT * i as f32);
        let index = world.species.len() - 1 - i;
        ink.painter
            .circle_filled(at, 6.0, rgb(species_colour(index)));
        let text_at = at - vec2(13.0, 0.0);
        let font = FontId::proportional(13.0);
        let anchor = Align2::RIGHT_CENTER;
        ink.grounded(text_at, anchor, &species.name, font, ink.text, ink.veil);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_read_from_afar_have_few_sizes() {
        let mut sizes = Vec::new();
        for height in 200..2161_u16 {
            let height = f32::from(height);
            let size = size_from_afar(vec2(1.6 * height, height));
            assert!(
                size <= height / 12.0 && size > 0.7 * height / 12.0,
                "{size} of {height}"
            );
            sizes.push(size);
        }
        sizes.dedup();
        assert_eq!(sizes.len(), 42);
        assert!(size_from_afar(vec2(1.0, 1.0)) > 0.0);
    }
}
