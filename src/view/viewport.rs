//! The free part of the window, where the picture is: the pointer there moves the camera and
//! chooses grains.
//!
//! In: what the panels left free, the pointer. Out: the camera moved, a grain selected or traced,
//! and the overlay drawn.

use crate::simulation::Half;
use crate::view::camera::{OrbitCamera, apply_response};
use crate::view::halves::parts;
use crate::view::overlay::{Caption, PicturePart, overlay};
use crate::view::pick::pick;
use crate::view::view_settings::ViewSettings;
use bevy::math::Vec2;
use bevy_egui::egui::{Id, Response, Sense, Ui, WidgetInfo, WidgetType};

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
    let halves = Half::ALL.into_iter().zip(captions);
    for (rect, (half, caption)) in parts(free, captions.len()).zip(halves) {
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
        if settings.show_overlay {
            let part = PicturePart {
                half,
                is_first: half == Half::Left,
                is_last: half.index() + 1 == captions.len(),
            };
            overlay(&ui.painter_at(rect), rect, caption, part, settings, camera);
        }
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
    if !response.clicked() {
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
