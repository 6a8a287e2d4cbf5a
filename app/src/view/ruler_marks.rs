//! The ruler in the picture: where the pointer lays its ends, the line between them and what it
//! shows.
//!
//! In: the ruler, the world shown, the camera, the pointer. Out: an end laid; egui shapes. What is
//! clicked on beside all grains lies in the plane through the camera's focus that faces the viewer.

use crate::view::camera::OrbitCamera;
use crate::view::ink::Ink;
use crate::view::pick::{pick, point_in_focus};
use crate::view::ruler::{Reading, RulerEnd};
use crate::view::view_settings::ViewSettings;
use bevy::math::Vec2;
use bevy_egui::egui::{Align2, CursorIcon, FontId, Pos2, Response, vec2};
use glam::DVec3;
use grainfall::measure::Measure;
use grainfall::measure::numeral;
use grainfall::world::World;

/// Half the length of the strokes that cross at an end, in points.
const CROSS: f32 = 6.0;
/// What to do while no end is laid.
const HINT: &str = "Ruler: click two grains or places. M puts it away";

/// Lays an end where the picture of `world` was clicked on, and draws the ruler; the pointer is the
/// second end until that is laid.
pub(super) fn ruler_ui(
    response: &Response,
    world: &World,
    settings: &mut ViewSettings,
    camera: &OrbitCamera,
) {
    if !settings.ruler.is_out {
        return;
    }
    response.clone().on_hover_cursor(CursorIcon::Crosshair);
    let under = |at: Pos2, settings: &ViewSettings| {
        let at = at - response.rect.min;
        let at = Vec2::new(at.x, at.y);
        match pick(world, camera, settings, at) {
            Some(grain) => RulerEnd::Grain(grain),
            None => RulerEnd::Place(point_in_focus(camera, at)),
        }
    };
    if let Some(at) = response
        .interact_pointer_pos()
        .filter(|_| response.clicked())
    {
        let end = under(at, settings);
        settings.ruler.lay(end);
    }
    let mut shown = settings.ruler.clone();
    let is_half = shown.places(world).len() == 1;
    if let Some(at) = response
        .hover_pos()
        .filter(|_| is_half && !response.dragged())
    {
        shown.lay(under(at, settings));
    }
    draw(response, &shown.places(world), settings, camera);
}

/// Draws the ruler between `places` [m].
fn draw(response: &Response, places: &[DVec3], settings: &ViewSettings, camera: &OrbitCamera) {
    let painter = (response.ctx).layer_painter(response.layer_id);
    let painter = painter.with_clip_rect(response.rect);
    let ink = Ink::new(&painter, settings.background);
    let place = |x: &DVec3| {
        let (at, _) = camera.project(x.as_vec3())?;
        Some(response.rect.min + vec2(at.x, at.y))
    };
    let ends: Vec<Pos2> = places.iter().filter_map(place).collect();
    for end in &ends {
        for way in [(CROSS, 0.0), (0.0, CROSS)] {
            let way = vec2(way.0, way.1);
            ink.bold_line(vec![*end - way, *end + way], 1.5, ink.text);
        }
    }
    let font = FontId::proportional(15.0);
    if let (&[from, to], &[a, b]) = (ends.as_slice(), places) {
        ink.bold_line(vec![from, to], 2.0, ink.text);
        let (text, middle) = (in_words(Reading::between([a, b])), from.lerp(to, 0.5));
        ink.grounded(
            middle,
            Align2::CENTER_BOTTOM,
            &text,
            font,
            ink.text,
            ink.veil,
        );
    } else {
        let at = response.rect.center_top() + vec2(0.0, 10.0);
        ink.grounded(at, Align2::CENTER_TOP, HINT, font, ink.text, ink.veil);
    }
}

/// `23.41 mm, 31.20° to the horizontal`.
fn in_words(reading: Reading) -> String {
    let distance = numeral::with_prefix(reading.distance, "m");
    let angle = Measure::SurfaceAngle.quantity().text(reading.inclination);
    format!("{distance}, {angle} to the horizontal")
}
