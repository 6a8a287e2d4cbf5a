//! The free part of the window, where the picture is: the pointer there moves the camera and
//! chooses grains.
//!
//! In: what the panels left free, the pointer. Out: the camera moved, a grain selected or traced,
//! and the overlay drawn.

use crate::view::bed_marks::{draw_flow, draw_veil};
use crate::view::camera::{OrbitCamera, apply_response};
use crate::view::halves::{beside, parts, seen_part};
use crate::view::ink::Ink;
use crate::view::measured_marks;
use crate::view::overlay::{Caption, PicturePart, legend, legend_height, legend_margin, overlay};
use crate::view::pick::pick;
use crate::view::ruler_marks::ruler_ui;
use crate::view::sheet::{MarkKind, Sheet, under};
use crate::view::view_settings::ViewSettings;
use bevy::math::Vec2;
use bevy_egui::egui::{Id, Rect, Response, Sense, Ui, WidgetInfo, WidgetType};
use grainfall::lab::Half;
use grainfall::world::World;

/// The legend takes no more of the picture's width than this share.
const LARGEST_MARGIN: f32 = 0.3;

/// The free part of the window: call it after all panels with what they left. The pointer moves the
/// camera there, the picture is fitted into it, and the overlay is drawn; twice, side by side,
/// where there are two `captions`.
pub fn viewport_ui(
    ui: &mut Ui,
    captions: &[Caption],
    settings: &mut ViewSettings,
    camera: &mut OrbitCamera,
) {
    let free = ui.available_rect_before_wrap();
    settings.free_rect = Some(free);
    settings.pixels_per_point = ui.ctx().pixels_per_point();
    settings.lit_by_picture = None;
    let worlds = || captions.iter().filter_map(|caption| caption.world);
    settings.margin = legend_margin(settings, worlds()).min(LARGEST_MARGIN * free.width());
    let beside_legend = captions.last().and_then(|caption| caption.world);
    settings.margin_is_free = settings.margin > 0.0
        && beside_legend
            .is_some_and(|world| !is_behind_legend(world, camera, legend_height(settings, world)));
    let halves = Half::ALL.into_iter().zip(captions);
    let picture = beside(free, settings.margin);
    for (rect, (half, caption)) in parts(picture, captions.len()).zip(halves) {
        let is_last = half.index() + 1 == captions.len();
        let seen = seen_part(rect, is_last, settings.free_margin());
        let response = ui.interact(rect, Id::new(("picture", half)), Sense::click_and_drag());
        response.widget_info(|| {
            let title = caption
                .title
                .as_ref()
                .map_or_else(String::new, |title| format!(": {title}"));
            WidgetInfo::labeled(WidgetType::Image, true, format!("Picture{title}"))
        });
        apply_response(&response, camera);
        click(&response, half, caption, settings, camera);
        measured(&response, seen, (half, caption), settings, camera);
        if let Some(world) = caption.world {
            ruler_ui(&response, world, settings, camera);
        }
        if settings.show_overlay {
            let part = PicturePart {
                half,
                is_first: half == Half::Left,
                is_last,
            };
            overlay(&ui.painter_at(seen), rect, caption, part, settings, camera);
        }
    }
    if settings.show_overlay {
        legend(&ui.painter_at(free), free, settings, worlds().next());
    }
}

/// Whether a grain of `world` is right of the picture, in part at least, and no more than `height`
/// above its lower edge [points], where the legend stands.
fn is_behind_legend(world: &World, camera: &OrbitCamera, height: f32) -> bool {
    let (normal, edge) = camera.right_edge();
    let (normal, edge) = (normal.as_dvec3(), f64::from(edge));
    let top = camera.viewport.y - height;
    let mut grains = world.grains.position.iter().zip(&world.grains.radius);
    grains.any(|(x, radius)| {
        let is_beyond = x.dot(normal) + radius > edge;
        let place = is_beyond.then(|| camera.project(x.as_vec3())).flatten();
        place.is_some_and(|(place, scale)| place.y + *radius as f32 * scale > top)
    })
}

/// Draws what is measured where it is measured, where it is `seen`; the pointer there is told how.
fn measured(
    response: &Response,
    seen: Rect,
    (half, caption): (Half, &Caption),
    settings: &mut ViewSettings,
    camera: &OrbitCamera,
) {
    let Some(world) = caption.world else {
        return;
    };
    let rect = response.rect;
    let painter = response
        .ctx
        .layer_painter(response.layer_id)
        .with_clip_rect(seen);
    let ink = Ink::new(&painter, settings.background);
    let shown = &settings.measured[half.index()];
    let mut sheet = Sheet {
        ink: &ink,
        rect,
        camera,
        lit: settings.lit_by_plot,
        marks: Vec::new(),
        labels: Vec::new(),
    };
    if let (Some(map), Some(legend)) = (&shown.temperature, &settings.veil) {
        draw_veil(&sheet, world, map, legend);
    }
    if settings.show_flow
        && let (Some(surface), Some(flow)) = (&shown.surface, &shown.flow)
    {
        draw_flow(&mut sheet, world, surface, flow);
    }
    if settings.show_measured {
        measured_marks::draw(&mut sheet, world, shown);
    }
    let pointer = response.hover_pos().filter(|_| !response.dragged());
    if let Some(kind) = pointer.and_then(|pointer| under(&sheet.marks, pointer)) {
        if let MarkKind::Measure(measure) = kind {
            settings.lit_by_picture = Some(measure);
        }
        response.clone().on_hover_text_at_pointer(kind.in_words());
    }
}

/// Puts the grain that is clicked on under the microscope; with Shift, traces it.
fn click(
    response: &Response,
    half: Half,
    caption: &Caption,
    settings: &mut ViewSettings,
    camera: &OrbitCamera,
) {
    let (Some(world), Some(at)) = (caption.world, response.interact_pointer_pos()) else {
        return;
    };
    if !response.clicked() || settings.ruler.is_out {
        return;
    }
    settings.focus = half;
    let at = at - response.rect.min;
    let picked = pick(world, camera, settings, Vec2::new(at.x, at.y));
    if response.ctx.input(|input| input.modifiers.shift) {
        if let Some(grain) = picked {
            settings.trace(grain);
        }
    } else if picked != settings.selected {
        (settings.selected, settings.beside) = (picked, None);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::test_worlds::grains_in_a_row;
    use crate::view::view_settings::ProjectionKind;
    use bevy::math::Vec3;
    use glam::DVec3;

    #[test]
    fn a_grain_right_of_the_picture_is_behind_the_legend_where_that_stands() {
        for projection in [ProjectionKind::Perspective, ProjectionKind::Orthographic] {
            // A metre is 1000 points at the focus, and the picture 0.8 m wide and 0.6 m high.
            let mut camera = OrbitCamera::default();
            (camera.focus, camera.yaw, camera.pitch) = (Vec3::ZERO, 0.0, 0.0);
            (camera.height, camera.viewport) = (0.6, Vec2::new(800.0, 600.0));
            camera.projection = projection;
            let mut world = grains_in_a_row(1);
            world.grains.radius[0] = 0.01;
            let mut is_behind = |x: f64, y: f64| {
                world.grains.position[0] = DVec3::new(x, y, 0.0);
                is_behind_legend(&world, &camera, 200.0)
            };
            assert!(is_behind(0.45, -0.2), "{projection:?}: beside, low");
            assert!(is_behind(0.395, -0.11), "{projection:?}: at the edge");
            assert!(!is_behind(0.45, 0.0), "{projection:?}: above the legend");
            assert!(!is_behind(0.3, -0.2), "{projection:?}: in the picture");
        }
    }
}
