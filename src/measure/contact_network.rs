//! Measures of the contact network: coordination number, shares of the pairs of species, largest
//! overlap.

use crate::world::{Contact, FeatureContact, Partner, Polyhedra, World};

/// How many other grains each grain touches; walls do not count, and a pair counts once however
/// many of its features touch.
pub fn coordinations(world: &World) -> Vec<u32> {
    let mut counts = vec![0; world.grains.len()];
    for contact in &world.contacts {
        if let Partner::Grain(other) = contact.partner
            && contact.touching
        {
            counts[contact.grain as usize] += 1;
            counts[other as usize] += 1;
        }
    }
    counts
}

/// Mean of the [`coordinations`], `2 N_c / N` over all grains, rattlers and flying grains too. NaN
/// without grains.
pub fn coordination_number(world: &World) -> f64 {
    let all: u32 = coordinations(world).into_iter().sum();
    f64::from(all) / world.grains.len() as f64
}

/// How many walls `grain` touches.
pub fn walls_touched(world: &World, grain: usize) -> usize {
    let own = world.contacts.iter().filter(|contact| {
        let is_wall = matches!(contact.partner, Partner::Wall(_));
        contact.touching && is_wall && contact.grain as usize == grain
    });
    own.count()
}

/// Shares of the touching pairs of grains in which both are of the first species, one of either,
/// both of the second: `P11, P12, P22`. Walls do not count, and a pair counts once however many of
/// its features touch. NaN where nothing touches or there are more than two species.
pub fn contact_shares(world: &World) -> [f64; 3] {
    let species = &world.grains.species;
    let mut counts = [0.0; 3];
    for contact in &world.contacts {
        if let Partner::Grain(other) = contact.partner
            && contact.touching
        {
            let seconds = species[contact.grain as usize].0 + species[other as usize].0;
            counts[usize::from(seconds.min(2))] += 1.0;
        }
    }
    let all = if world.species.len() > 2 {
        f64::NAN
    } else {
        counts.iter().sum()
    };
    counts.map(|count| count / all)
}

/// Largest overlap of all contacts, walls too, relative to the smaller grain's radius, of polyhedra
/// to the smaller rounding radius; zero where nothing touches.
pub fn largest_overlap(world: &World) -> f64 {
    if let Some(polyhedra) = &world.polyhedra {
        let overlaps = polyhedra.features.iter();
        return overlaps
            .map(|feature| feature.overlap / smaller_rounding(polyhedra, feature))
            .fold(0.0, f64::max);
    }
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

fn smaller_rounding(polyhedra: &Polyhedra, contact: &FeatureContact) -> f64 {
    let rounding = |i: u32| polyhedra.shape_of(i as usize).rounding;
    match contact.partner {
        Partner::Grain(j) => rounding(contact.grain).min(rounding(j)),
        Partner::Wall(_) => rounding(contact.grain),
    }
}
