//! Numbers of each grain, to colour a picture by: one row of the registry for each.
//!
//! In: a world. Out: one value per grain, in the unit that people read.

use super::contact_network::coordinations;
use super::quantity::{Format, Scope, quantities};
use super::temperature::fluctuations;
use crate::geometry::sphere_volume;
use crate::physics::{Unit, units};
use crate::world::{Partner, Shape, World};
use glam::DVec3;

quantities! {
    /// A number that each grain of a world has.
    GrainQuantity {
        Speed {
            key: "speed",
            description: "Speed of the centre in the laboratory frame.",
            short_label: "Speed",
            unit: Unit::same("m/s"),
            format: Format::Prefixed,
        }
        Spin {
            key: "spin",
            description: "Magnitude of the angular velocity.",
            short_label: "Spin",
            unit: Unit::same("rad/s"),
            format: Format::Prefixed,
        }
        Coordination {
            key: "coordination number",
            description: "Other grains that it touches; walls do not count.",
            short_label: "Coordination number",
            format: Format::Count,
        }
        KineticEnergy {
            key: "kinetic energy",
            description: "Kinetic energy of translation and rotation.",
            short_label: "Kinetic energy",
            unit: units::ENERGY,
            format: Format::Prefixed,
        }
        LargestForce {
            key: "largest contact force",
            description: "Largest of the forces at its contacts.",
            short_label: "Largest contact force",
            unit: Unit::same("N"),
            format: Format::Prefixed,
        }
        Pressure {
            key: "pressure",
            description: "Mean normal stress, positive where the grain is pressed: −tr σ/3 of the \
                          virial of its forces over its volume, half of a pair's to each of the \
                          two.",
            short_label: "Pressure",
            unit: Unit::same("Pa"),
            format: Format::Prefixed,
            source: "Christoffersen et al. 1981",
        }
        Liquid {
            key: "liquid",
            description: "Liquid on it, its part in bridges included.",
            short_label: "Liquid",
            unit: units::FILM_VOLUME,
            format: Format::Prefixed,
            scope: Scope::Liquids,
        }
        Radius {
            key: "radius",
            description: "Radius; of a polyhedron that of the sphere round it.",
            short_label: "Radius",
            unit: Unit::same("m"),
            format: Format::Prefixed,
        }
        Number {
            key: "number",
            description: "Its number, in the order in which the grains were placed.",
            short_label: "Number",
            format: Format::Count,
        }
        LargestOverlap {
            key: "largest overlap of grain",
            description: "Largest overlap with another sphere, in units of its radius.",
            short_label: "Largest overlap",
            format: Format::Scientific,
        }
        Fluctuation {
            key: "fluctuation",
            description: "Mean square, per direction, of its velocity relative to the mean of its \
                          neighbours within 7r/3, in the drum's frame: its part of the granular \
                          temperature.",
            short_label: "Granular temperature",
            unit: Unit::same("m²/s²"),
            format: Format::Scientific,
            source: "Eqs. 21 and 22 of Kasper et al. 2021",
        }
        VelocityX {
            key: "velocity x",
            description: "Velocity of the centre to the right.",
            short_label: "Velocity along x",
            unit: Unit::same("m/s"),
            format: Format::Prefixed,
        }
        VelocityY {
            key: "velocity y",
            description: "Velocity of the centre upwards.",
            short_label: "Velocity along y",
            unit: Unit::same("m/s"),
            format: Format::Prefixed,
        }
        VelocityZ {
            key: "velocity z",
            description: "Velocity of the centre towards the front.",
            short_label: "Velocity along z",
            unit: Unit::same("m/s"),
            format: Format::Prefixed,
        }
        PositionX {
            key: "position x",
            description: "Where the centre is to the right of the origin.",
            short_label: "Position along x",
            unit: Unit::same("m"),
            format: Format::Prefixed,
        }
        PositionY {
            key: "position y",
            description: "Where the centre is above the origin.",
            short_label: "Position along y",
            unit: Unit::same("m"),
            format: Format::Prefixed,
        }
        AxisDistance {
            key: "distance from the axis",
            description: "Distance of the centre from the axis of its drum, or of its column.",
            short_label: "Distance from the axis",
            unit: Unit::same("m"),
            format: Format::Prefixed,
        }
    }
}

impl GrainQuantity {
    /// What people call it.
    pub fn name(self) -> &'static str {
        self.quantity().short_label
    }

    /// The unit that people read, to which prefixes may be added; empty for a count.
    pub fn unit(self) -> &'static str {
        self.quantity().unit.shown.name
    }

    /// Whether grains of `world` have it. What another program computed may come without forces.
    pub fn applies_to(self, world: &World) -> bool {
        match self {
            Self::Liquid => world.wetting().is_some(),
            Self::LargestForce | Self::Pressure => {
                (world.contacts.first()).is_none_or(|contact| contact.force.is_finite())
            }
            Self::LargestOverlap => world.polyhedra.is_none(),
            Self::AxisDistance => {
                let shape = world.container.shape;
                matches!(shape, Shape::Drum { .. } | Shape::Column { .. })
            }
            _ => true,
        }
    }

    /// Whether it has a sign.
    pub fn is_signed(self) -> bool {
        let velocities = [Self::VelocityX, Self::VelocityY, Self::VelocityZ];
        let signed = [Self::PositionX, Self::PositionY];
        velocities.contains(&self) || signed.contains(&self)
    }

    /// That of each grain of `world` in the shown unit, appended to `values`.
    pub fn append(self, world: &World, values: &mut Vec<f64>) {
        let litres = units::FILM_VOLUME.shown.factor;
        let grains = &world.grains;
        match self {
            Self::Speed => values.extend(grains.velocity.iter().map(|v| v.length())),
            Self::Spin => values.extend(grains.spin.iter().map(|spin| spin.length())),
            Self::Coordination => {
                values.extend(coordinations(world).into_iter().map(f64::from));
            }
            Self::KineticEnergy => {
                values.extend((0..grains.len()).map(|i| world.kinetic_energy_of(i)));
            }
            Self::LargestForce => append_largest_forces(world, values),
            Self::Pressure => append_pressures(world, values),
            Self::Liquid => values.extend(grains.film.iter().map(|film| litres * film)),
            Self::Radius => values.extend(grains.radius.iter()),
            Self::Number => values.extend((0..grains.len()).map(|i| i as f64)),
            Self::LargestOverlap => append_largest_overlaps(world, values),
            Self::Fluctuation => values.extend(fluctuations(world)),
            Self::VelocityX => values.extend(grains.velocity.iter().map(|v| v.x)),
            Self::VelocityY => values.extend(grains.velocity.iter().map(|v| v.y)),
            Self::VelocityZ => values.extend(grains.velocity.iter().map(|v| v.z)),
            Self::PositionX => values.extend(grains.position.iter().map(|x| x.x)),
            Self::PositionY => values.extend(grains.position.iter().map(|x| x.y)),
            Self::AxisDistance => append_axis_distances(world, values),
        }
    }
}

/// From the upright axis of a column, from the level one along z of anything else.
fn append_axis_distances(world: &World, values: &mut Vec<f64>) {
    let is_upright = matches!(world.container.shape, Shape::Column { .. });
    let distance = |x: &DVec3| x.x.hypot(if is_upright { x.z } else { x.y });
    values.extend(world.grains.position.iter().map(distance));
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

fn append_largest_overlaps(world: &World, values: &mut Vec<f64>) {
    let first = values.len();
    let grains = &world.grains;
    values.resize(first + grains.len(), 0.0);
    let largest = &mut values[first..];
    for contact in world.contacts.iter().filter(|contact| contact.touching) {
        if let Partner::Grain(other) = contact.partner {
            let pair = [contact.grain as usize, other as usize];
            let [a, b] = pair.map(|i| (grains.position[i], grains.radius[i]));
            let overlap = a.1 + b.1 - a.0.distance(b.0);
            for i in pair {
                largest[i] = largest[i].max(overlap / grains.radius[i]);
            }
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
