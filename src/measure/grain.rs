//! Numbers of each grain, to colour a picture by.

use crate::geometry::sphere_volume;
use crate::world::{Partner, World};

/// Litres per cubic metre.
const LITRES: f64 = 1e3;

/// A number that each grain of a world has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GrainQuantity {
    /// Speed of the centre in the laboratory frame [m/s].
    Speed,
    /// Magnitude of the angular velocity [rad/s].
    Spin,
    /// Touching partners, walls too.
    Coordination,
    /// Kinetic energy of translation and rotation [J].
    KineticEnergy,
    /// Largest of the forces at its contacts [N].
    LargestForce,
    /// Mean normal stress, positive where the grain is pressed [Pa]: `−tr σ/3` of the virial of its forces over its
    /// volume, half of a pair's to each of the two (Christoffersen et al. 1981).
    Pressure,
    /// Liquid on it, its part in bridges included [L].
    Liquid,
}

impl GrainQuantity {
    /// All of them, in the order of a menu.
    pub const ALL: [Self; 7] = [
        Self::Speed,
        Self::Spin,
        Self::Coordination,
        Self::KineticEnergy,
        Self::LargestForce,
        Self::Pressure,
        Self::Liquid,
    ];

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Speed => "Speed",
            Self::Spin => "Spin",
            Self::Coordination => "Coordination number",
            Self::KineticEnergy => "Kinetic energy",
            Self::LargestForce => "Largest contact force",
            Self::Pressure => "Pressure",
            Self::Liquid => "Liquid",
        }
    }

    /// Unit, to which prefixes may be added; empty for a count.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Coordination => "",
            Self::Speed => "m/s",
            Self::Spin => "rad/s",
            Self::KineticEnergy => "J",
            Self::LargestForce => "N",
            Self::Pressure => "Pa",
            Self::Liquid => "L",
        }
    }

    /// Whether grains of `world` have it.
    pub fn applies(self, world: &World) -> bool {
        self != Self::Liquid || world.wetting().is_some()
    }

    /// That of each grain of `world`, appended to `values`.
    pub fn append(self, world: &World, values: &mut Vec<f64>) {
        let grains = &world.grains;
        match self {
            Self::Speed => values.extend(grains.velocity.iter().map(|v| v.length())),
            Self::Spin => values.extend(grains.spin.iter().map(|spin| spin.length())),
            Self::Coordination => {
                values.extend(grains.contact_count.iter().map(|&count| f64::from(count)));
            }
            Self::KineticEnergy => {
                let energy = |i: usize| {
                    0.5 * grains.mass[i] * grains.velocity[i].length_squared()
                        + world.rotational_energy(i)
                };
                values.extend((0..grains.len()).map(energy));
            }
            Self::LargestForce => append_largest_forces(world, values),
            Self::Pressure => append_pressures(world, values),
            Self::Liquid => values.extend(grains.film.iter().map(|film| LITRES * film)),
        }
    }
}

fn append_largest_forces(world: &World, values: &mut Vec<f64>) {
    let first = values.len();
    values.resize(first + world.grains.len(), 0.0);
    let largest = &mut values[first..];
    for contact in &world.contacts {
        let force = contact.force.length();
        let mut meet = |grain: u32| {
            let largest = &mut largest[grain as usize];
            *largest = largest.max(force);
        };
        meet(contact.grain);
        if let Partner::Grain(other) = contact.partner {
            meet(other);
        }
    }
}

fn append_pressures(world: &World, values: &mut Vec<f64>) {
    let first = values.len();
    values.resize(first + world.grains.len(), 0.0);
    let pressure = &mut values[first..];
    let position = &world.grains.position;
    for contact in &world.contacts {
        let (grain, force) = (contact.grain as usize, contact.force);
        match contact.partner {
            Partner::Grain(other) => {
                let half = 0.5 * force.dot(position[grain] - position[other as usize]);
                pressure[grain] += half;
                pressure[other as usize] += half;
            }
            Partner::Wall(wall) => {
                let surface = &world.container.walls[wall as usize].surface;
                let (distance, towards) = surface.distance(position[grain]);
                pressure[grain] -= force.dot(distance * towards);
            }
        }
    }
    for (i, pressure) in pressure.iter_mut().enumerate() {
        *pressure /= 3.0 * volume(world, i);
    }
}

/// Volume of grain `i` [m³].
fn volume(world: &World, i: usize) -> f64 {
    match world.polyhedra.as_deref() {
        Some(polyhedra) => polyhedra.shape_of(i).volume,
        None => sphere_volume(world.grains.radius[i]),
    }
}
