//! The torque with which a drum turns its grains.

use crate::world::{Contact, Partner, Shape, World};

/// Torque about its axis that turns a drum against its grains [N m]: that of the contact forces,
/// without rolling friction. NaN where there is no drum, or polyhedra, whose points of contact are
/// not kept.
pub fn drum_torque(world: &World) -> f64 {
    let is_drum = matches!(world.container.shape, Shape::Drum { .. });
    if !is_drum || world.polyhedra.is_some() {
        return f64::NAN;
    }
    let of_contact = |contact: &Contact| {
        let Partner::Wall(wall) = contact.partner else {
            return 0.0;
        };
        let grain = contact.grain as usize;
        let position = world.grains.position[grain];
        let (distance, normal) = world.container.walls[wall as usize]
            .surface
            .distance(position);
        let arm = 0.5 * (world.grains.radius[grain] + distance);
        let point = position + arm * normal;
        point.cross(contact.force).z
    };
    world.contacts.iter().map(of_contact).sum()
}
