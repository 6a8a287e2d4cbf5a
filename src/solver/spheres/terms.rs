//! The force of a contact of spheres, term by term.
//!
//! In: a world as a solver left it and one of its contacts. Out: what each term gives. The two
//! sides are put before the functions of the pair loop ([`super::contacts`]) as its rows, with the
//! velocities of half a step ago: so nothing of a force is derived twice.

use super::super::row::row;
use super::super::terms::{AT_THE_BOUND, ForceTerms};
use super::super::walls::WallBody;
use super::contacts::{PairState, common_constants, half_step};
use super::integrate::{Moving, SphereAccount, SphereLoad, StepConstants, Total};
use super::partners::{GrainAndWall, Partners, TwoGrains};
use super::rows::Sphere;
use crate::lanes::{Elementwise, One, WIDEST};
use crate::physics::CoulombBound;
use crate::physics::law::{Law, LawUser, PairConstants};
use crate::world::{Contact, Partner, World};
use glam::DVec3;

/// The terms of `contact`.
pub fn force_terms(world: &World, contact: &Contact) -> ForceTerms {
    let pairing = world.pairing(contact.grain as usize, contact.partner);
    let wet = world.wetting().is_some();
    world.law.choose(Explanation {
        constants: pairing.constants(world.law, &world.materials, wet),
        world,
        contact,
    })
}

/// A contact that is to be explained.
struct Explanation<'a> {
    constants: PairConstants,
    world: &'a World,
    contact: &'a Contact,
}

/// The law is chosen once, as for the pair loop.
impl LawUser for Explanation<'_> {
    type Output = ForceTerms;

    fn with<L: Law>(self, law: L) -> ForceTerms {
        let first = half_a_step_ago(self.world, self.contact.grain as usize);
        match self.contact.partner {
            Partner::Grain(j) => {
                let second = half_a_step_ago(self.world, j as usize);
                let partners = TwoGrains {
                    first: [&first; WIDEST],
                    second: [&second; WIDEST],
                };
                self.terms(law, partners, &first)
            }
            Partner::Wall(w) => {
                let wall = &self.world.container.walls[w as usize];
                let wall = WallBody {
                    surface: wall.surface.clone(),
                    motion: wall.motion,
                };
                let half_step = half_step::<One, L>((), self.world.clock.time_step);
                let partners = GrainAndWall::<One>::new((), [&first; WIDEST], &wall, half_step);
                self.terms(law, partners, &first)
            }
        }
    }
}

impl Explanation<'_> {
    /// The terms by `law` between these partners, of whom `first` is the contact's grain. What the
    /// bridge does is read where the loop left it, as it depends on films that may be gone.
    fn terms<L: Law, P: Partners<One>>(&self, law: L, partners: P, first: &Sphere) -> ForceTerms {
        let (contact, constants) = (self.contact, common_constants((), &self.constants));
        let half_step = half_step::<One, L>((), self.world.clock.time_step);
        let state = PairState::of((), law, partners, &constants, half_step);
        let (elastic, repulsion) = (state.along.elastic.get(), state.along.repulsion.get());
        let (pull, resistance) = (contact.bridge.as_ref())
            .map_or((0.0, 0.0), |bridge| (bridge.capillary, bridge.viscous));
        let wetting = self.world.wetting().map(|liquid| liquid.law.coulomb);
        let bounding = match (contact.partner, wetting) {
            (Partner::Grain(_), Some(CoulombBound::Total)) => {
                (repulsion + (resistance - pull)).abs()
            }
            _ => state.along.bounding.get(),
        };
        let [friction, ..] = self.constants.contact;
        let coulomb_bound = friction * bounding;
        let touching = state.touching;
        let spring = if touching {
            -contact.spring * contact.stiffness
        } else {
            DVec3::ZERO
        };
        let slides = touching && spring.length() >= coulomb_bound * (1.0 - AT_THE_BOUND);
        let damping = if touching && !slides {
            state.along.coefficients.tangential_damping.get()
        } else {
            0.0
        };
        let (normal, slip) = (vector(state.normal), vector(state.slip));
        ForceTerms {
            feature: None,
            normal,
            point: super::super::row::vector(first.position) + normal * state.arms[0].get(),
            overlap: state.depth.get(),
            approach: state.approach.get(),
            slip,
            slides,
            coulomb_bound,
            normal_spring: -normal * elastic,
            normal_dashpot: -normal * (repulsion - elastic),
            tangential_spring: spring,
            tangential_dashpot: -slip * damping,
            capillary: normal * pull,
            viscous_normal: -normal * resistance,
            viscous_tangential: contact.bridge.as_ref().map_or(DVec3::ZERO, |b| b.drag),
            rolling: contact.rolling,
        }
    }
}

/// One lane's vector.
fn vector(lanes: [One; 3]) -> DVec3 {
    DVec3::from_array(lanes.map(One::get))
}

/// The row of grain `i` as the pair loop saw it: where it is now, with the velocities of half a
/// step ago.
pub fn half_a_step_ago(world: &World, i: usize) -> Sphere {
    let (grains, dt) = (&world.grains, world.clock.time_step);
    let mut sphere = Sphere::of(grains, i);
    let load = SphereLoad::of(grains, i);
    let total = Total::<Elementwise>::load((), &load, f64::from(grains.open_bridges[i]));
    let back = StepConstants {
        dt: -dt,
        gravity: row(world.gravity, 0.0),
        ..StepConstants::default()
    };
    let mut moving = Moving::of((), &sphere);
    moving.kick((), &total, &back);
    moving.put(&mut sphere);
    let compliance = SphereAccount::of(grains, i, dt).compliance;
    sphere.free_spin = moving.free_spin((), compliance, &total, dt);
    sphere
}
