//! What the renderer has still to make before it draws everything: shaders come from files of the
//! program in their own time, and what waits for one is left out of a picture without a word.

use bevy::prelude::*;
use bevy::render::render_resource::PipelineCache;
use bevy::render::{Render, RenderApp, RenderSystems};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How many pipelines the renderer has still to make.
#[derive(Resource, Clone, Default)]
pub struct PipelinesWaiting(Arc<AtomicUsize>);

impl PipelinesWaiting {
    /// Whether it has all that it draws with, as of the last frame.
    pub fn is_none(&self) -> bool {
        self.0.load(Ordering::Relaxed) == 0
    }

    /// Counts them in `app` from now on, if it draws.
    pub(super) fn count_in(app: &mut App) {
        if app.world().contains_resource::<Self>() {
            return;
        }
        let waiting = Self::default();
        app.insert_resource(waiting.clone());
        if let Some(renderer) = app.get_sub_app_mut(RenderApp) {
            renderer.insert_resource(waiting);
            renderer.add_systems(Render, count.in_set(RenderSystems::Cleanup));
        }
    }
}

fn count(cache: Option<Res<PipelineCache>>, waiting: Res<PipelinesWaiting>) {
    let count = cache.map_or(0, |cache| cache.waiting_pipelines().count());
    waiting.0.store(count, Ordering::Relaxed);
}
