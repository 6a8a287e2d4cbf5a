//! What the renderer draws with, and has still to make: shaders come from files of the program in
//! their own time, and what waits for one is left out of a picture without a word.

use bevy::prelude::*;
use bevy::render::render_resource::PipelineCache;
use bevy::render::{Render, RenderApp, RenderSystems};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The pipelines of the renderer, as of the last frame.
#[derive(Resource, Clone, Default)]
pub struct Pipelines(Arc<Counts>);

#[derive(Default)]
struct Counts {
    waiting: AtomicUsize,
    all: AtomicUsize,
}

impl Pipelines {
    /// Whether all that is drawn with is made.
    pub fn are_made(&self) -> bool {
        self.0.waiting.load(Ordering::Relaxed) == 0
    }

    /// How many there are. They stay: one for each kind of drawing that there was so far.
    pub fn count(&self) -> usize {
        self.0.all.load(Ordering::Relaxed)
    }

    /// Counts them in `app` from now on, if it draws.
    pub(super) fn count_in(app: &mut App) {
        if app.world().contains_resource::<Self>() {
            return;
        }
        let counts = Self::default();
        app.insert_resource(counts.clone());
        if let Some(renderer) = app.get_sub_app_mut(RenderApp) {
            renderer.insert_resource(counts);
            renderer.add_systems(Render, count.in_set(RenderSystems::Cleanup));
        }
    }
}

fn count(cache: Option<Res<PipelineCache>>, counts: Res<Pipelines>) {
    let of = |cache: &PipelineCache| [cache.waiting_pipelines().count(), cache.pipelines().count()];
    let [waiting, all] = cache.as_deref().map_or([0; 2], of);
    counts.0.waiting.store(waiting, Ordering::Relaxed);
    counts.0.all.store(all, Ordering::Relaxed);
}
