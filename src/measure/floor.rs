//! What the floor under a column bears.
//!
//! In: a world on whose floor a column stood. Out: the force on the floor, where on it that acts, and
//! what the grains weigh. At rest both are the same; where a tube still holds the column, it bears the rest.

use super::deposit::HeightProfile;
use crate::world::{Contact, Partner, Shape, Surface, World};
use std::f64::consts::PI;

/// Force with which the grains press on the floor under a column, along its normal, that of all
/// contacts at the last evaluation, dashpots too [N]; zero where nothing lies on it. NaN where no
/// column stood.
pub fn floor_force(world: &World) -> f64 {
    let Shape::Column { .. } = world.container.shape else {
        return f64::NAN;
    };
    let on_floor = world.contacts.iter().filter_map(|c| pressed(world, c));
    on_floor.fold(0.0, |sum, force| sum + force)
}

/// With what a contact presses on a floor along its normal [N]; none where it is not with one.
fn pressed(world: &World, contact: &Contact) -> Option<f64> {
    let Partner::Wall(wall) = contact.partner else {
        return None;
    };
    match world.container.walls[wall as usize].surface {
        Surface::Plane { normal, .. } => Some(contact.force.dot(normal)),
        _ => None,
    }
}

/// What all grains weigh, in the gravity that acts now [N].
pub fn weight(world: &World) -> f64 {
    world.grains.mass.iter().sum::<f64>() * world.gravity.length()
}

/// Mean pressure on the floor in each of the `rings` of a heap's profile [Pa]: the forces of the
/// grains whose centres lie over the ring, by its area. Points of contact are not kept; a ring is two
/// grains wide.
pub fn floor_pressure(world: &World, rings: &HeightProfile) -> Vec<f64> {
    let mut pressure = vec![0.0; rings.radius.len()];
    // Rings are equally wide, and a radius is the middle of one.
    let width = 2.0 * rings.radius.first().copied().unwrap_or(0.0);
    for contact in &world.contacts {
        let place = world.grains.position[contact.grain as usize];
        let ring = (place.x * place.x + place.z * place.z).sqrt() / width;
        let ring = pressure.get_mut(ring as usize);
        if let (Some(ring), Some(force)) = (ring, pressed(world, contact)) {
            *ring += force;
        }
    }
    let areas = (0..).map(|k| PI * width * width * f64::from(2 * k + 1));
    let by_area = pressure.into_iter().zip(areas);
    by_area.map(|(force, area)| force / area).collect()
}
