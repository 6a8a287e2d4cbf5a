//! The column that collapses: what it was at the start, what it is made of, and the paper's laws
//! for what becomes of it.
//!
//! In: a world on whose floor a column stood ([`Shape::Column`]). Out: the numbers that the paper
//! plots against, and the laws drawn through its plots. What lies on the floor now is measured by
//! [`super::Deposit`].

use crate::physics::MaterialId;
use crate::world::{Shape, Species, Surface, World};
use std::f64::consts::PI;

/// Weight β of the friction among grains against that on the floor (Man et al. 2023, after Eq.
/// 1.1).
const PARTICLE_WEIGHT: f64 = 2.0;

/// Effective aspect ratio at which the laws break.
pub const CRITICAL_ASPECT_RATIO: f64 = 3.5;

/// Lower bound of `T_max / √α_eff`.
pub const PEAK_TIME_LAW: f64 = 0.92;
/// `T_f / √α_eff` below [`CRITICAL_ASPECT_RATIO`].
pub const REST_TIME_LAW: f64 = 4.5;
/// `T_f / √α_eff` of tall columns, from [`TALL_ASPECT_RATIO`] on, and of loosely packed ones.
pub const TALL_REST_TIME_LAW: f64 = 3.0;
/// Effective aspect ratio from which a column counts as tall.
pub const TALL_ASPECT_RATIO: f64 = 13.0;

/// A column as it stood at the start, of the grains as they are labelled now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialColumn {
    /// Radius at the start, `R_i` [m].
    pub radius: f64,
    /// Height at the start, `H_i` [m].
    pub height: f64,
    /// Friction among the grains, `μ_p`.
    pub particle_friction: f64,
    /// Friction of the grains on the floor, `μ_w`.
    pub floor_friction: f64,
    /// Share by number of the second species, `P_2`.
    pub second_share: f64,
    /// Volume of the grains over that of the column, `φ_i`.
    pub solid_fraction: f64,
    /// Gravitational acceleration [m/s²].
    pub gravity: f64,
}

impl InitialColumn {
    /// The column of `world`; none where there was none, or no grains.
    ///
    /// `μ_p = Σ P_a P_b μ_ab` over the shares by number of the species, which for two of them is
    /// Eqs. 4.1 and 4.2; `μ_w` is the mean over the grains. Both are those of dry grains.
    pub fn of(world: &World) -> Option<Self> {
        let Shape::Column { radius, height } = world.container.shape else {
            return None;
        };
        if world.grains.is_empty() {
            return None;
        }
        let shares = shares(world);
        let friction = |a, b| world.materials.pair(a, b).friction;
        let among = |&(a, share): &(MaterialId, f64)| -> f64 {
            let with = shares.iter().map(|&(b, other)| other * friction(a, b));
            share * with.sum::<f64>()
        };
        let on_floor = |floor| {
            shares
                .iter()
                .map(move |&(a, share)| share * friction(a, floor))
        };
        Some(Self {
            radius,
            height,
            particle_friction: shares.iter().map(among).sum(),
            floor_friction: floor(world).map_or(0.0, |floor| on_floor(floor).sum()),
            second_share: shares.get(1).map_or(0.0, |&(_, share)| share),
            solid_fraction: grain_volume(world) / (PI * radius * radius * height),
            gravity: world.gravity.length(),
        })
    }

    /// `α = H_i/R_i`.
    pub fn aspect_ratio(&self) -> f64 {
        self.height / self.radius
    }

    /// `α_eff = α √(1/(μ_w + β μ_p))` with β = 2 (Eq. 1.1).
    pub fn effective_aspect_ratio(&self) -> f64 {
        let friction = self.floor_friction + PARTICLE_WEIGHT * self.particle_friction;
        self.aspect_ratio() * (1.0 / friction).sqrt()
    }

    /// `φ_i^0.5 α_eff`, over which columns of different solid fractions fall together (Eq. 4.6).
    pub fn packed_aspect_ratio(&self) -> f64 {
        self.solid_fraction.sqrt() * self.effective_aspect_ratio()
    }

    /// Relative run-out `ℛ = (R − R_i)/R_i` of a front at the radius `R` [m].
    pub fn run_out(&self, front: f64) -> f64 {
        (front - self.radius) / self.radius
    }

    /// `V_cone/V_init` of a deposit of this base radius and height [m] (Eq. 4.3).
    pub fn cone_volume_ratio(&self, front: f64, height: f64) -> f64 {
        cone_volume(front, height) / (PI * self.radius * self.radius * self.height)
    }

    /// `√(R_i/g)`, the unit of the dimensionless times `T_max` and `T_f` (Eq. 4.5) [s].
    pub fn time_unit(&self) -> f64 {
        (self.radius / self.gravity).sqrt()
    }
}

/// `V_cone = (π/3) R² H` of a deposit of this base radius and height [m³] (Eq. 4.3).
pub fn cone_volume(front: f64, height: f64) -> f64 {
    PI / 3.0 * front * front * height
}

/// Relative run-out ℛ over the effective aspect ratio: `1.0 α_eff^1.35`, and `α_eff^0.5` from 3.5
/// on. The exponents are the paper's; the factor is read from its plots (± 20 %).
pub fn run_out_law(effective: f64) -> f64 {
    const EXPONENT: f64 = 1.35;
    if effective <= CRITICAL_ASPECT_RATIO {
        effective.powf(EXPONENT)
    } else {
        CRITICAL_ASPECT_RATIO.powf(EXPONENT) * (effective / CRITICAL_ASPECT_RATIO).sqrt()
    }
}

/// `V_cone/V_init` over the effective aspect ratio: `1.2 α_eff^0.9`, and `7.5 α_eff^−0.6` above 3.5
/// (Eq. 4.4).
pub fn cone_volume_law(effective: f64) -> f64 {
    if effective <= CRITICAL_ASPECT_RATIO {
        1.2 * effective.powf(0.9)
    } else {
        7.5 * effective.powf(-0.6)
    }
}

/// Shares of pairs of two species by chance, `P11, P12, P22`, where the second one's share by
/// number is `second` (Eq. 4.1).
pub fn contact_shares_law(second: f64) -> [f64; 3] {
    let first = 1.0 - second;
    [first * first, 2.0 * first * second, second * second]
}

/// Materials of the species with their shares by number.
fn shares(world: &World) -> Vec<(MaterialId, f64)> {
    let mut counts = vec![0_u32; world.species.len()];
    for species in &world.grains.species {
        counts[usize::from(species.0)] += 1;
    }
    let all = world.grains.len() as f64;
    let share = |(kind, count): (&Species, u32)| (kind.material, f64::from(count) / all);
    let kinds = world.species.iter().zip(counts);
    kinds.map(share).collect()
}

/// What the floor is made of.
fn floor(world: &World) -> Option<MaterialId> {
    let mut walls = world.container.walls.iter();
    let floor = walls.find(|wall| matches!(wall.surface, Surface::Plane { .. }));
    floor.map(|wall| wall.material)
}

/// Volume of all grains: of polyhedra, that of the solids which their masses belong to [m³].
fn grain_volume(world: &World) -> f64 {
    (0..world.grains.len()).map(|i| volume(world, i)).sum()
}

/// Volume of grain `i` [m³].
pub(super) fn volume(world: &World, i: usize) -> f64 {
    let material = world.species[usize::from(world.grains.species[i].0)].material;
    world.grains.mass[i] / world.materials.get(material).density
}
