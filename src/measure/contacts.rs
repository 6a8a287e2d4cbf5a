//! Measures of the contact network: coordination number and largest overlap.

use crate::world::{Contact, Partner, World};

/// Mean number of other grains that a grain touches, `2 N_c / N` over all grains (rattlers and flying grains too); walls
/// do not count. NaN without grains.
pub fn coordination_number(world: &World) -> f64 {
    let between_grains = world
        .contacts
        .iter()
        .filter(|contact| contact.touching && matches!(contact.partner, Partner::Grain(_)))
        .count();
    2.0 * between_grains as f64 / world.grains.len() as f64
}

/// Largest overlap of all contacts, walls too, relative to the smaller grain's radius; zero where nothing touches.
pub fn largest_overlap(world: &World) -> f64 {
    world
        .contacts
        .iter()
        .map(|contact| overlap(world, contact) / smaller_radius(world, contact))
        .fold(0.0, f64::max)
}

/// Overlap of a contact at the present positions [m]; negative where it has opened.
pub(super) fn overlap(world: &World, contact: &Contact) -> f64 {
    let grains = &world.grains;
    let i = contact.grain as usize;
    match contact.partner {
        Partner::Grain(j) => {
            let j = j as usize;
            grains.radius[i] + grains.radius[j] - grains.position[i].distance(grains.position[j])
        }
        Partner::Wall(w) => {
            let (distance, _) = world.container.walls[w as usize]
                .surface
                .distance(grains.position[i]);
            grains.radius[i] - distance
        }
    }
}

fn smaller_radius(world: &World, contact: &Contact) -> f64 {
    let radius = &world.grains.radius;
    let own = radius[contact.grain as usize];
    match contact.partner {
        Partner::Grain(j) => own.min(radius[j as usize]),
        Partner::Wall(_) => own,
    }
}
