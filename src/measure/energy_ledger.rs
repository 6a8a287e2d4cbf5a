//! The energy balance: what is stored, what came in, what was lost, and what remains unexplained.
//!
//! In: a world. Out: energies [J], none of which is changed here.
//!
//! Stored energy is read from the world as it is, by the contact laws' own formulas
//! ([`crate::physics::law`]); work and losses are read from the world's own books
//! ([`crate::world::Ledger`], [`crate::world::Grains::exchanged`]), which the solver and the
//! commands keep.

use super::contact_network::overlap;
use crate::physics::ContactLaw;
use crate::physics::law::FeatureSprings;
use crate::world::{Contact, FeatureContact, World};
use serde::Serialize;

/// All terms of the balance
///
/// ```text
/// kinetic + elastic − initial = gravity + walls + commands
///     − dashpots − sliding − rolling − viscous − capillary + residual
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EnergyLedger {
    /// Kinetic and elastic energy at the start [J].
    pub initial: f64,
    /// Kinetic energy now [J].
    pub kinetic: f64,
    /// Elastic energy now [J].
    pub elastic: f64,
    /// Work of gravity since the start [J].
    pub gravity_work: f64,
    /// Work of the moving walls since the start [J].
    pub wall_work: f64,
    /// Energy put in by commands that changed masses or stiffnesses [J].
    pub command_work: f64,
    /// Lost in dashpots since the start [J].
    pub dashpot_loss: f64,
    /// Lost by tangential springs since the start [J]: in sliding and, with Hertz–Mindlin contacts,
    /// as their stiffness follows the overlap, which no force does work against.
    pub sliding_loss: f64,
    /// Lost in rolling since the start [J].
    pub rolling_loss: f64,
    /// Lost to the viscosity of the liquid since the start [J].
    pub viscous_loss: f64,
    /// Taken by capillary forces since the start [J]: what bridges that broke have cost, and what
    /// those that hold would give back if their grains came together.
    pub capillary_loss: f64,
}

impl EnergyLedger {
    /// The balance of `world` now.
    pub fn of(world: &World) -> Self {
        let [dashpot_loss, sliding_loss, rolling_loss, wall_work] = sums(&world.grains.exchanged);
        let [viscous_loss, capillary_loss] = sums(&world.grains.liquid_loss);
        let ledger = &world.ledger;
        Self {
            initial: ledger.initial_energy,
            kinetic: world.kinetic_energy(),
            elastic: elastic_energy(world),
            gravity_work: ledger.gravity_work + ledger.potential_reference
                - world.potential_energy(),
            wall_work,
            command_work: ledger.command_work,
            dashpot_loss,
            sliding_loss,
            rolling_loss,
            viscous_loss,
            capillary_loss,
        }
    }

    /// What work and losses do not explain of the change of stored energy [J].
    pub fn residual(&self) -> f64 {
        let stored = self.kinetic + self.elastic - self.initial;
        let supplied = self.gravity_work + self.wall_work + self.command_work;
        let in_contacts = self.dashpot_loss + self.sliding_loss + self.rolling_loss;
        let lost = in_contacts + self.viscous_loss + self.capillary_loss;
        stored - supplied + lost
    }

    /// The residual relative to the largest term of the balance; zero where every term is.
    pub fn relative_residual(&self) -> f64 {
        let turnover = [
            self.initial,
            self.kinetic,
            self.elastic,
            self.gravity_work,
            self.wall_work,
            self.command_work,
            self.dashpot_loss,
            self.sliding_loss,
            self.rolling_loss,
            self.viscous_loss,
            self.capillary_loss,
        ]
        .into_iter()
        .map(f64::abs)
        .fold(0.0, f64::max);
        if turnover > 0.0 {
            self.residual() / turnover
        } else {
            0.0
        }
    }
}

/// Energy stored in the normal and tangential springs of all contacts [J], of polyhedra in those of
/// all features that touch; a contact that has opened stores none.
pub fn elastic_energy(world: &World) -> f64 {
    if let Some(polyhedra) = &world.polyhedra {
        return feature_energy(&polyhedra.features, world.law);
    }
    let stored = |contact: &Contact| {
        world
            .pairing(contact.grain as usize, contact.partner)
            .elastic_energy(
                world.law,
                &world.materials,
                overlap(world, contact),
                contact.spring.length(),
            )
    };
    world
        .contacts
        .iter()
        .filter(|contact| overlap(world, contact) > 0.0)
        .map(stored)
        .sum()
}

/// Energy stored in the springs of polyhedra [J]: `½ K_n δ² + ½ k_t ξ²` of every pair of features.
/// Where the features of two bodies share one contact, each has the part `Σδ²/(Σδ)²` of `K_n`;
/// their `k_t` is kept with them.
fn feature_energy(features: &[FeatureContact], law: ContactLaw) -> f64 {
    let Some(springs) = law.feature_springs() else {
        return f64::NAN;
    };
    let FeatureSprings {
        normal_stiffness,
        rule,
    } = springs;
    let of_pair = |pair: &[FeatureContact]| {
        let (mut sum, mut squares, mut tangential) = (0.0, 0.0, 0.0);
        for feature in pair.iter().filter(|feature| feature.overlap > 0.0) {
            sum += feature.overlap;
            squares += feature.overlap * feature.overlap;
            tangential += feature.stiffness * feature.spring.length_squared();
        }
        let part = rule.part(sum, squares);
        0.5 * (part * normal_stiffness * squares + tangential)
    };
    let of_one_pair =
        |a: &FeatureContact, b: &FeatureContact| (a.grain, a.partner) == (b.grain, b.partner);
    features.chunk_by(of_one_pair).map(of_pair).sum()
}

/// Sums over the grains of each of their energies [J].
fn sums<const N: usize>(columns: &[[f64; N]]) -> [f64; N] {
    let mut sums = [0.0; N];
    for terms in columns {
        for (sum, term) in sums.iter_mut().zip(terms) {
            *sum += term;
        }
    }
    sums
}
