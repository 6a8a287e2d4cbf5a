//! The force of a contact, term by term: what there is to tell.
//!
//! In: what the kernels' own functions make of one contact ([`super::spheres`],
//! [`super::polyhedra`]). Out: its terms, of which the sum is the force that the solver applied, to
//! rounding. The loops saw velocities half a step ago; they follow from those of now and the sum of
//! the forces. Until the next step, a parameter that was just changed shows in the terms but not in
//! the force applied.
//!
//! Forces are those on the contact's first grain; those on its partner are opposite. A term that a
//! law or a pair does not have is zero.

use crate::world::Feature;
use glam::DVec3;

/// A force within this share of the Coulomb bound is taken to slide: the loop makes it equal to the
/// bound, to rounding.
pub(super) const AT_THE_BOUND: f64 = 1e-9;

/// What makes up the force on a contact's grain. All forces are those on [`Contact::grain`] [N].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForceTerms {
    /// Which features touch, of polyhedra.
    pub feature: Option<Feature>,
    /// Unit vector from the grain to its partner.
    pub normal: DVec3,
    /// Where the force acts [m].
    pub point: DVec3,
    /// Overlap, negative at a gap [m].
    pub overlap: f64,
    /// Speed at which the two approach each other along the normal [m/s].
    pub approach: f64,
    /// Velocity of the grain's surface over its partner's [m/s].
    pub slip: DVec3,
    /// Whether the contact slides: the tangential spring is at the Coulomb bound.
    pub slides: bool,
    /// What the tangential force of a contact cannot exceed [N].
    pub coulomb_bound: f64,
    /// The normal spring's.
    pub normal_spring: DVec3,
    /// The normal dashpot's.
    pub normal_dashpot: DVec3,
    /// The tangential spring's.
    pub tangential_spring: DVec3,
    /// The tangential dashpot's.
    pub tangential_dashpot: DVec3,
    /// The liquid bridge's pull.
    pub capillary: DVec3,
    /// The liquid's along the normal.
    pub viscous_normal: DVec3,
    /// The liquid's across the normal.
    pub viscous_tangential: DVec3,
    /// Torque of rolling friction on the grain [N m].
    pub rolling: DVec3,
}

impl ForceTerms {
    /// The sum of all forces [N].
    pub fn force(&self) -> DVec3 {
        self.normal_spring
            + self.normal_dashpot
            + self.tangential_spring
            + self.tangential_dashpot
            + self.capillary
            + self.viscous_normal
            + self.viscous_tangential
    }
}
