//! The grains' columns.

use super::grain_column::GrainColumn;
use crate::geometry::sphere_volume;
use crate::physics::MaterialId;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Index of a [`Species`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SpeciesId(pub u16);

/// A kind of grain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Species {
    /// What people call it.
    pub name: String,
    /// What it is made of.
    pub material: MaterialId,
}

/// What there is of every grain: one entry per grain in every column.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Grains {
    /// Centre [m].
    pub position: GrainColumn<DVec3>,
    /// Velocity of the centre [m/s].
    pub velocity: GrainColumn<DVec3>,
    /// Angular velocity [rad/s].
    pub spin: GrainColumn<DVec3>,
    /// Radius [m].
    pub radius: GrainColumn<f64>,
    /// Mass [kg].
    pub mass: GrainColumn<f64>,
    /// Moment of inertia about the centre, `2/5 m r²` of a sphere [kg m²].
    pub inertia: GrainColumn<f64>,
    /// Kind of grain.
    pub species: GrainColumn<SpeciesId>,
    /// Sum of the contact forces, without weight, at the last force evaluation [N].
    pub force: GrainColumn<DVec3>,
    /// Torque of the contact forces, without rolling friction, at the last evaluation [N m].
    pub torque: GrainColumn<DVec3>,
    /// Torque of rolling friction at the last evaluation [N m].
    pub rolling_torque: GrainColumn<DVec3>,
    /// Touching partners, walls too, at the last evaluation.
    pub contact_count: GrainColumn<u32>,
    /// Energy exchanged at the contacts of which the grain is the first partner, since the start
    /// [J]: [`Grains::IN_DASHPOTS`], [`Grains::IN_SLIDING`], [`Grains::IN_ROLLING`],
    /// [`Grains::BY_WALLS`].
    pub exchanged: GrainColumn<[f64; 4]>,
    /// Volume of the liquid film on each, its part in bridges included [m³].
    pub film: GrainColumn<f64>,
    /// Bridges to grains that it did not touch at the last evaluation.
    pub open_bridges: GrainColumn<u32>,
    /// Energy lost in bridges of which the grain is the first partner, since the start [J]: to
    /// viscosity, and to capillary forces, which give back on the way together what they take on
    /// the way apart until the bridge breaks.
    pub liquid_loss: GrainColumn<[f64; 2]>,
}

impl Grains {
    /// Where in [`Grains::exchanged`] the energy lost in dashpots stands.
    pub const IN_DASHPOTS: usize = 0;
    /// Energy lost in sliding, with what tangential springs lose as their stiffness changes.
    pub const IN_SLIDING: usize = 1;
    /// Energy lost in rolling.
    pub const IN_ROLLING: usize = 2;
    /// Work done by walls.
    pub const BY_WALLS: usize = 3;

    /// Number of grains.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Adds a sphere at rest in equilibrium (no force) of the given density [kg/m³].
    pub fn push_sphere(&mut self, position: DVec3, radius: f64, density: f64, species: SpeciesId) {
        let mass = sphere_volume(radius) * density;
        self.push(
            position,
            radius,
            mass,
            0.4 * mass * radius * radius,
            species,
        );
    }

    /// Adds a grain at rest in equilibrium (no force) of this radius [m], mass [kg] and moment of
    /// inertia [kg m²].
    pub(super) fn push(
        &mut self,
        position: DVec3,
        radius: f64,
        mass: f64,
        inertia: f64,
        species: SpeciesId,
    ) {
        self.position.push(position);
        self.velocity.push(DVec3::ZERO);
        self.spin.push(DVec3::ZERO);
        self.radius.push(radius);
        self.mass.push(mass);
        self.inertia.push(inertia);
        self.species.push(species);
        self.force.push(DVec3::ZERO);
        self.torque.push(DVec3::ZERO);
        self.rolling_torque.push(DVec3::ZERO);
        self.contact_count.push(0);
        self.exchanged.push([0.0; 4]);
        self.film.push(0.0);
        self.open_bridges.push(0);
        self.liquid_loss.push([0.0; 2]);
    }
}
