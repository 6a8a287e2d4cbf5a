//! The energy balance: what is stored, what came in, what was lost, and what remains unexplained.
//!
//! Stored energy is read from the world as it is; work and losses are read from the world's own books
//! ([`crate::world::Ledger`], [`crate::world::Grains::exchanged`]), which the solver and the commands keep.

use super::contacts::overlap;
use crate::scene::ContactLaw;
use crate::world::{Contact, Material, Partner, World};
use serde::Serialize;

/// All terms of `kinetic + elastic − initial = gravity + walls + commands − dashpots − sliding − rolling + residual`.
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
    /// Lost in sliding since the start [J].
    pub sliding_loss: f64,
    /// Lost in rolling since the start [J].
    pub rolling_loss: f64,
}

impl EnergyLedger {
    /// The balance of `world` now.
    pub fn of(world: &World) -> Self {
        let [dashpot_loss, sliding_loss, rolling_loss, wall_work] = exchanged(world);
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
        }
    }

    /// What work and losses do not explain of the change of stored energy [J].
    pub fn residual(&self) -> f64 {
        let stored = self.kinetic + self.elastic - self.initial;
        let supplied = self.gravity_work + self.wall_work + self.command_work;
        let lost = self.dashpot_loss + self.sliding_loss + self.rolling_loss;
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

/// Energy stored in the normal and tangential springs of all contacts [J].
///
/// Hertz–Mindlin: `2/5 · 4/3 E* √r* δ^(5/2) + 1/2 k_t ξ²` with `k_t = 8 G* √(r* δ)` (Eqs. 6 and 8 of Kasper et al. 2021).
/// Hooke: `1/2 K_n δ² + 1/2 K_t ξ²` (Eqs. 3.3 and 3.5 of Man et al. 2023).
pub fn elastic_energy(world: &World) -> f64 {
    world
        .contacts
        .iter()
        .map(|contact| pair_elastic(world, contact))
        .sum()
}

/// Energy stored in the springs of one contact [J]; zero where it has opened.
fn pair_elastic(world: &World, contact: &Contact) -> f64 {
    let delta = overlap(world, contact).max(0.0);
    let xi_squared = contact.spring.length_squared();
    match world.law {
        ContactLaw::HertzMindlin => {
            let (a, b) = pair_materials(world, contact);
            let root = (effective_radius(world, contact) * delta).sqrt();
            let normal_stiffness = 4.0 / 3.0 * effective_youngs_modulus(a, b) * root;
            let tangential_stiffness = 8.0 * effective_shear_modulus(a, b) * root;
            0.4 * normal_stiffness * delta * delta + 0.5 * tangential_stiffness * xi_squared
        }
        ContactLaw::Hooke {
            normal_stiffness,
            tangential_stiffness,
        } => 0.5 * normal_stiffness * delta * delta + 0.5 * tangential_stiffness * xi_squared,
    }
}

fn pair_materials<'w>(world: &'w World, contact: &Contact) -> (&'w Material, &'w Material) {
    let of_grain = |i: u32| {
        let species = world.grains.species[i as usize];
        world.species[usize::from(species.0)].material
    };
    let partner = match contact.partner {
        Partner::Grain(j) => of_grain(j),
        Partner::Wall(w) => world.container.walls[w as usize].material,
    };
    let materials = &world.materials;
    (
        materials.get(of_grain(contact.grain)),
        materials.get(partner),
    )
}

/// `r*`, for a wall the grain's own radius [m].
fn effective_radius(world: &World, contact: &Contact) -> f64 {
    let radius = &world.grains.radius;
    let r_i = radius[contact.grain as usize];
    match contact.partner {
        Partner::Grain(j) => {
            let r_j = radius[j as usize];
            r_i * r_j / (r_i + r_j)
        }
        Partner::Wall(_) => r_i,
    }
}

fn effective_youngs_modulus(a: &Material, b: &Material) -> f64 {
    let compliance = |m: &Material| (1.0 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus;
    1.0 / (compliance(a) + compliance(b))
}

fn effective_shear_modulus(a: &Material, b: &Material) -> f64 {
    let compliance = |m: &Material| (2.0 - m.poisson_ratio) / m.shear_modulus();
    1.0 / (compliance(a) + compliance(b))
}

/// Sums of the grains' columns of exchanged energy [J].
fn exchanged(world: &World) -> [f64; 4] {
    let mut sums = [0.0; 4];
    for terms in &world.grains.exchanged {
        for (sum, term) in sums.iter_mut().zip(terms) {
            *sum += term;
        }
    }
    sums
}
