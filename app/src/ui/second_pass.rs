//! What is written into the second picture, off screen, and the panels round it.
//!
//! In: how that picture is to look, the simulation, the dock. Out: shapes of an egui context of its
//! own, which no pointer and no key reaches. Text is as large as in a window of that size.

use crate::simulation::Simulation;
use crate::ui::captions::captions;
use crate::ui::dock::Dock;
use crate::ui::request::Requests;
use crate::ui::{text_size, theme};
use crate::view::{SecondOverlay, SecondPicture, viewport_ui};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_egui::{EguiContext, PrimaryEguiContext, egui};

/// When the second picture is written into.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub struct SecondPicturePass;

/// Draws what belongs into the second picture, while there is one.
pub fn draw_second_picture(
    mut second: ResMut<SecondPicture>,
    mut context: Single<&mut EguiContext, (With<SecondOverlay>, Without<PrimaryEguiContext>)>,
    mut window: Single<&mut EguiContext, With<PrimaryEguiContext>>,
    (mut dock, mut requests): (ResMut<Dock>, ResMut<Requests>),
    simulation: Option<Res<Simulation>>,
    mut installed: Local<bool>,
) {
    let Some(look) = second.look().copied() else {
        return;
    };
    if !look.has_marks && !look.has_panels {
        return;
    }
    let (ctx, window) = (context.get_mut().clone(), window.get_mut().clone());
    if !std::mem::replace(&mut *installed, true) {
        theme::install(&ctx);
    }
    let simulation = simulation.as_deref();
    let size = egui::vec2(look.size.x as f32, look.size.y as f32);
    let scale = (look.pixels_per_point)
        .or_else(|| text_size::chosen(&window))
        .unwrap_or_else(|| text_size::by_window(size));
    if look.has_panels {
        // Which sections are open, how far lists are scrolled.
        let mut memory = window.memory(Clone::clone);
        ctx.memory_mut(|own| {
            memory.options.zoom_factor = own.options.zoom_factor;
            *own = memory;
        });
    }
    ctx.set_zoom_factor(scale);
    let SecondPicture {
        settings, camera, ..
    } = &mut *second;
    theme::show(&ctx, settings.background);
    let builder = egui::UiBuilder::new()
        .layer_id(egui::LayerId::background())
        .max_rect(ctx.viewport_rect());
    let mut root = egui::Ui::new(ctx, "root".into(), builder);
    if look.has_panels {
        dock.second_ui(&mut root, simulation, settings, &mut requests.0);
    }
    let has_clock = !look.has_panels || !dock.shows_time();
    let mut captions = captions(simulation, has_clock, 0.0);
    for caption in &mut captions {
        caption.is_for_afar = look.has_panels && dock.is_presenting;
    }
    viewport_ui(&mut root, &captions, settings, camera);
}
