//! The world in the picture, or the two worlds in its halves.
//!
//! In: the newest states that the simulation has published. Out: what the rest of the view draws.

use crate::simulation::Simulation;
use bevy::camera::visibility::RenderLayers;
use bevy::prelude::*;
use bevy::tasks::AsyncComputeTaskPool;
use grainfall::lab::Half;
use grainfall::run::Turned;
use grainfall::world::World;
use std::sync::Arc;

/// When the view works in an update.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub enum ViewSystems {
    /// Takes the newest world.
    Take,
    /// Writes its grains into their buffer.
    Fill,
    /// Turns it into meshes.
    Draw,
}

/// Grains of a world that takes longer to free than to wake a thread for it.
const LARGE: usize = 4096;
/// Part of a scene's duration in which grains in the open stay in the picture: what happens to them
/// happens before.
const WATCHED: f64 = 0.5;

/// The world in the picture, or the two worlds in its halves.
#[derive(Resource, Default)]
pub struct ShownWorlds {
    halves: [Option<Arc<World>>; 2],
    /// How far their spheres have turned, where that is known.
    turned: [Option<Turned>; 2],
    /// The states with which their runs began, where those are known.
    starts: [Option<Arc<World>>; 2],
    /// Those that are shown no longer.
    before: Vec<Arc<World>>,
    /// How long grains that fly in the open are followed [s].
    pub(super) watched: f64,
}

impl ShownWorlds {
    /// Shows this world from now on, alone.
    pub fn show(&mut self, world: Option<Arc<World>>) {
        self.replace([world, None]);
    }

    /// Shows this world from now on, alone, its spheres turned as `turned` says.
    pub fn show_turned(&mut self, world: Arc<World>, turned: Turned) {
        self.replace([Some(world), None]);
        self.turned[Half::Left.index()] = Some(turned);
    }

    /// Shows this world from now on, alone, of a run that began with `start`.
    pub fn show_since(&mut self, start: Arc<World>, world: Arc<World>) {
        self.replace([Some(world), None]);
        self.starts[Half::Left.index()] = Some(start);
    }

    /// Shows these two from now on, side by side.
    pub fn show_pair(&mut self, left: Arc<World>, right: Arc<World>) {
        self.replace([Some(left), Some(right)]);
    }

    fn replace(&mut self, halves: [Option<Arc<World>>; 2]) {
        let before = std::mem::replace(&mut self.halves, halves);
        self.before.extend(before.into_iter().flatten());
        self.turned = [None, None];
        self.starts = [None, None];
    }

    /// The world in the picture; of two the left one.
    pub fn world(&self) -> Option<&World> {
        self.half(Half::Left)
    }

    /// The world in this half of the picture.
    pub fn half(&self, half: Half) -> Option<&World> {
        self.halves[half.index()].as_deref()
    }

    /// How far the spheres of that world have turned since time zero, where that is known.
    pub fn turned(&self, half: Half) -> Option<&[Quat]> {
        self.turned[half.index()].as_deref()
    }

    /// The state with which the run of that world began; none where nothing is known of it, or where
    /// it has another number of grains.
    pub fn start(&self, half: Half) -> Option<&World> {
        let (start, world) = (self.starts[half.index()].as_deref()?, self.half(half)?);
        (start.grains.len() == world.grains.len()).then_some(start)
    }

    /// All worlds in the picture.
    pub fn worlds(&self) -> impl Iterator<Item = &World> {
        self.halves.iter().flatten().map(AsRef::as_ref)
    }

    /// Whether two worlds are shown.
    pub fn is_pair(&self) -> bool {
        self.halves[Half::Right.index()].is_some()
    }
}

/// Frees what was shown, behind the frame; a large world, which takes milliseconds, beside the next one.
pub(super) fn free(mut shown: ResMut<ShownWorlds>) {
    if shown.before.is_empty() {
        return;
    }
    let before = std::mem::take(&mut shown.bypass_change_detection().before);
    if before.iter().any(|world| world.grains.len() > LARGE) {
        let pool = AsyncComputeTaskPool::get();
        pool.spawn(async move { drop(before) }).detach();
    }
}

/// What the camera of this half of the picture sees.
pub(super) fn layers(half: Half) -> RenderLayers {
    RenderLayers::layer(half.index())
}

/// Shows the newest states of the simulation's runs, or its bed while that settles. They are told
/// apart by their addresses: while a state is shown, no other is at its address.
pub(super) fn take_newest(simulation: Option<Res<Simulation>>, mut shown: ResMut<ShownWorlds>) {
    let Some(simulation) = simulation else { return };
    let right = (simulation.comparison()).and_then(|comparison| comparison.right.world());
    let newest = [simulation.world().or(simulation.settling()), right];
    let is_shown = |half: Half| match (newest[half.index()], &shown.halves[half.index()]) {
        (Some(newest), Some(shown)) => Arc::ptr_eq(newest, shown),
        (None, None) => true,
        _ => false,
    };
    if !Half::ALL.into_iter().all(is_shown) {
        shown.watched = WATCHED * simulation.scene().duration;
        shown.replace(newest.map(Option::<&Arc<World>>::cloned));
        let right = (simulation.comparison()).and_then(|comparison| comparison.right.start());
        shown.starts = [simulation.start(), right].map(Option::<&Arc<World>>::cloned);
        let right =
            (simulation.comparison()).and_then(|comparison| comparison.right.orientations());
        shown.turned = [simulation.orientations(), right].map(Option::<&Turned>::cloned);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainfall::lab::{DriverKind, Options, Status};
    use grainfall::run::BedStore;
    use grainfall::scene::Scene;
    use std::time::Duration;

    #[test]
    fn a_bed_is_in_the_picture_while_it_settles() {
        let mut scene = Scene::open("dry-r1.25").unwrap();
        scene.seed += 1;
        let count = scene.grain_count();
        let options = Options {
            driver: DriverKind::Inline,
            threads: 1,
            beds: BedStore::none(),
            ..Options::window()
        };
        let mut app = App::new();
        app.insert_resource(Simulation::open(scene, options))
            .init_resource::<ShownWorlds>()
            .add_systems(Update, take_newest);
        loop {
            let mut simulation = app.world_mut().resource_mut::<Simulation>();
            simulation.tick(Duration::from_millis(16));
            let is_preparing = matches!(simulation.status(), Status::Preparing { .. });
            assert!(is_preparing, "at rest before it was seen");
            app.update();
            if let Some(world) = app.world().resource::<ShownWorlds>().world() {
                assert_eq!(world.grains.len(), count);
                return;
            }
        }
    }
}
