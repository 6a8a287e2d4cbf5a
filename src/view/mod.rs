//! A world as pixels.
//!
//! ```text
//! Simulation ──▶ Shown ──▶ grains, container ──▶ WorldCamera ──▶ the free part of the window
//!                             ▲                      ▲
//!                       ViewSettings            OrbitCamera ◀── viewport_ui (pointer, overlay)
//! ```
//! In: the newest world that the simulation has published, the settings, the pointer over the picture. Out: the picture.
//! The view only reads a world; it never steps or changes one.
//!
//! | module | holds |
//! |---|---|
//! | `settings` | what a person chose to see |
//! | `colour` | every colour, the legend |
//! | `grains` | place, colour and shadow of all grains in one buffer |
//! | `spheres` | spheres as one draw, exact |
//! | `quads` | what spheres and links are drawn on |
//! | `polyhedra` | polyhedra as a few draws of triangles |
//! | `facets` | the surface of a rounded polyhedron |
//! | `occlusion` | the soft shadow in the gaps between grains |
//! | `container` | drum, box and planes as one-sided panes |
//! | `links` | force chains, liquid bridges, velocity arrows |
//! | `pick` | which grain a point of the picture shows |
//! | `trail` | the ways of chosen grains |
//! | `camera` | the orbiting eye, without Bevy's entities |
//! | `rig` | Bevy's camera entity that follows it |
//! | `overlay` | scale bar, clock, legend in the picture |
//! | `png`, `film` | pictures and films as files |

mod camera;
mod colour;
mod container;
mod facets;
mod film;
mod grains;
mod links;
mod occlusion;
mod overlay;
mod pick;
mod png;
mod polyhedra;
mod quads;
mod rig;
mod settings;
mod spheres;
mod trail;

pub use camera::{OrbitCamera, apply_response};
pub(crate) use colour::round_up;
pub use colour::species_colour;
pub use film::{FILM_RATE, Film, FilmKind};
pub use grains::GrainBuffer;
use overlay::parts;
pub use overlay::{Caption, ScaleBar, trail_colour, viewport_ui};
pub use png::{save_drawing, save_png};
pub use polyhedra::Meshing;
pub use rig::WorldCamera;
pub use settings::{
    Axis, Background, CameraRequest, ColourBy, ColourMap, ColourRange, Cut, Legend, LinkScales,
    ProjectionKind, SAVED_VIEWS, Side, ViewSettings,
};
pub use trail::Trail;

use crate::simulation::{Half, Simulation};
use crate::world::World;
use bevy::asset::{load_internal_asset, uuid_handle};
use bevy::camera::CameraUpdateSystems;
use bevy::camera::visibility::RenderLayers;
use bevy::prelude::*;
use bevy::tasks::AsyncComputeTaskPool;
use bevy_egui::EguiPostUpdateSet;
use std::sync::Arc;

const LIGHT: Handle<Shader> = uuid_handle!("0b7c4df4-9d2e-4b0d-93b4-0e3f5a1c7a10");

/// Draws the world of [`Shown`] as [`ViewSettings`] and [`OrbitCamera`] say.
pub struct ViewPlugin;

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

impl Plugin for ViewPlugin {
    fn build(&self, app: &mut App) {
        load_internal_asset!(
            app,
            LIGHT,
            "../../assets/shaders/light.wgsl",
            Shader::from_wgsl
        );
        app.init_resource::<ViewSettings>()
            .init_resource::<OrbitCamera>()
            .init_resource::<Shown>()
            .configure_sets(
                Update,
                (ViewSystems::Take, ViewSystems::Fill, ViewSystems::Draw).chain(),
            )
            .add_plugins((
                grains::plugin,
                spheres::plugin,
                polyhedra::plugin,
                container::plugin,
                links::plugin,
            ))
            .add_systems(Startup, rig::spawn)
            .add_systems(
                Update,
                (take_newest, trail::follow)
                    .chain()
                    .in_set(ViewSystems::Take),
            )
            .add_systems(
                PostUpdate,
                (rig::steer, rig::follow)
                    .chain()
                    .after(EguiPostUpdateSet::EndPass)
                    .before(CameraUpdateSystems)
                    .before(TransformSystems::Propagate),
            );
    }
}

/// Part of a scene's duration in which grains in the open stay in the picture: what happens to them happens before.
const WATCHED: f64 = 0.5;

/// The world in the picture, or the two worlds in its halves.
#[derive(Resource, Default)]
pub struct Shown {
    halves: [Option<Arc<World>>; 2],
    /// How long grains that fly in the open are followed [s].
    watched: f64,
}

impl Shown {
    /// Shows this world from now on, alone.
    pub fn show(&mut self, world: Option<Arc<World>>) {
        self.replace([world, None]);
    }

    /// Shows these two from now on, side by side.
    pub fn show_twins(&mut self, left: Arc<World>, right: Arc<World>) {
        self.replace([Some(left), Some(right)]);
    }

    /// What was shown is freed beside the frame: a large world takes milliseconds.
    fn replace(&mut self, halves: [Option<Arc<World>>; 2]) {
        let before = std::mem::replace(&mut self.halves, halves);
        match AsyncComputeTaskPool::try_get() {
            Some(pool) => pool.spawn(async move { drop(before) }).detach(),
            None => drop(before),
        }
    }

    /// The world in the picture; of two the left one.
    pub fn world(&self) -> Option<&World> {
        self.half(Half::Left)
    }

    /// The world in this half of the picture.
    pub fn half(&self, half: Half) -> Option<&World> {
        self.halves[half.index()].as_deref()
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

/// What the camera of this half of the picture sees.
fn layers(half: Half) -> RenderLayers {
    RenderLayers::layer(half.index())
}

/// Shows the newest states that the simulation and its twin have published. Two states are never at the same address while
/// one of them is shown.
fn take_newest(simulation: Option<Res<Simulation>>, mut shown: ResMut<Shown>) {
    let Some(simulation) = simulation else { return };
    let right = simulation.twin().and_then(|twin| twin.run().world());
    let newest = [simulation.world(), right];
    let is_shown = |half: Half| match (newest[half.index()], &shown.halves[half.index()]) {
        (Some(newest), Some(shown)) => Arc::ptr_eq(newest, shown),
        (None, None) => true,
        _ => false,
    };
    if !Half::ALL.into_iter().all(is_shown) {
        shown.watched = WATCHED * simulation.scene().duration;
        shown.replace(newest.map(Option::<&Arc<World>>::cloned));
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;
    use crate::world::{World, build};

    /// A world of `count` equal grains, far apart.
    pub(super) fn grains_in_a_row(count: usize) -> World {
        let mut world = build(&Scene::open("bouncing-grain").unwrap(), 1e-5);
        let (species, position) = (world.grains.species[0], world.grains.position[0]);
        for i in world.grains.len()..count {
            let x = position + 1e-2 * i as f64;
            world.grains.push_sphere(x, 1e-3, 2500.0, species);
        }
        world
    }
}
