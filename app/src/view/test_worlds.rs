//! Worlds for the tests of the view.

use grainfall::scene::Scene;
use grainfall::world::{World, build};

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
