//! The force of a contact, term by term.
//!
//! In: a world as a solver left it and one of its contacts. Out: what each term of the contact law
//! and of a bridge gives, from the functions that the pair loop calls, so that the sum is the force
//! the solver applied, to rounding. The loop saw velocities half a step ago; they follow from those
//! of now and the sum of the forces. Until the next step, a parameter that was just changed shows
//! in the terms but not in the force applied.

use super::lanes::{Lanes, One, Row};
use super::law::{
    BridgeConstants, FilmConstants, Law, LawUser, NormalContact, PairConstants, Pairing,
    attraction, contributions, drag, normal_contact,
};
use crate::physics::{BridgeLaw, ContactLaw, CoulombBound, Liquid};
use crate::world::{Contact, Feature, Partner, World};
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

/// The terms of a `contact` of spheres.
pub(super) fn terms_of_spheres(world: &World, contact: &Contact) -> ForceTerms {
    let meeting = Meeting::of(world, contact);
    world.law.choose(Terms {
        meeting: &meeting,
        world,
        contact,
    })
}

/// The terms of a contact of spheres.
struct Terms<'a> {
    meeting: &'a Meeting,
    world: &'a World,
    contact: &'a Contact,
}

impl LawUser for Terms<'_> {
    type Output = ForceTerms;

    fn with<L: Law>(self, law: L) -> ForceTerms {
        self.meeting.terms(law, self.world, self.contact)
    }
}

/// Velocity [m/s] and spin [rad/s] of grain `i`, a sphere, half a step ago.
fn half_a_step_ago(world: &World, i: usize) -> (DVec3, DVec3) {
    let grains = &world.grains;
    let half = 0.5 * world.clock.time_step;
    let turning = (grains.torque[i] + grains.rolling_torque[i]) / grains.inertia[i];
    (
        velocity_half_a_step_ago(world, i),
        grains.spin[i] - turning * half,
    )
}

/// Velocity of the centre of grain `i` half a step ago [m/s].
pub(super) fn velocity_half_a_step_ago(world: &World, i: usize) -> DVec3 {
    let grains = &world.grains;
    let acceleration = grains.force[i] / grains.mass[i] + world.gravity;
    grains.velocity[i] - acceleration * (0.5 * world.clock.time_step)
}

/// How the two sides of a contact of a sphere stand and move to each other.
struct Meeting {
    normal: DVec3,
    point: DVec3,
    overlap: f64,
    approach: f64,
    slip: DVec3,
}

impl Meeting {
    fn of(world: &World, contact: &Contact) -> Self {
        let grains = &world.grains;
        let i = contact.grain as usize;
        let (x, radius) = (grains.position[i], grains.radius[i]);
        let (velocity, spin) = half_a_step_ago(world, i);
        match contact.partner {
            Partner::Grain(j) => {
                let j = j as usize;
                let apart = grains.position[j] - x;
                let normal = apart / apart.length();
                let overlap = radius + grains.radius[j] - apart.length();
                let half = 0.5 * overlap.max(0.0);
                let (partner_velocity, partner_spin) = half_a_step_ago(world, j);
                let turning = spin * (radius - half) + partner_spin * (grains.radius[j] - half);
                Self::new(
                    (normal, x + normal * (radius - half), overlap),
                    velocity - partner_velocity,
                    turning,
                )
            }
            Partner::Wall(w) => {
                let wall = &world.container.walls[w as usize];
                let (gap, normal) = wall.surface.distance(x);
                let point = x + normal * (0.5 * (radius + gap));
                let overlap = radius - gap;
                let arm = radius - 0.5 * overlap.max(0.0);
                Self::new(
                    (normal, point, overlap),
                    velocity - wall.motion.velocity_at(point),
                    spin * arm,
                )
            }
        }
    }

    fn new((normal, point, overlap): (DVec3, DVec3, f64), velocity: DVec3, turning: DVec3) -> Self {
        let approach = velocity.dot(normal);
        Self {
            normal,
            point,
            overlap,
            approach,
            slip: velocity - normal * approach + turning.cross(normal),
        }
    }

    fn terms(&self, law: impl Law, world: &World, contact: &Contact) -> ForceTerms {
        let pair = Side::of(world, contact);
        let normal = self.normal;
        let touching = self.overlap > 0.0;
        let along = pair.along(law, self.overlap, self.approach);
        let (elastic, repulsion) = (along.elastic.get(), along.repulsion.get());
        let (pull, resistance) = (contact.bridge.as_ref())
            .map_or((0.0, 0.0), |bridge| (bridge.capillary, bridge.viscous));
        let bounding = match (contact.partner, world.wetting().map(|l| l.law.coulomb)) {
            (Partner::Grain(_), Some(CoulombBound::Total)) => (repulsion + resistance - pull).abs(),
            _ => along.bounding.get(),
        };
        let coulomb_bound = pair.constants.contact[0] * bounding;
        let spring = if touching {
            -contact.spring * contact.stiffness
        } else {
            DVec3::ZERO
        };
        let slides = touching && spring.length() >= coulomb_bound * (1.0 - AT_THE_BOUND);
        let damping = if touching && !slides {
            along.coefficients.tangential_damping.get()
        } else {
            0.0
        };
        ForceTerms {
            feature: None,
            normal,
            point: self.point,
            overlap: self.overlap,
            approach: self.approach,
            slip: self.slip,
            slides,
            coulomb_bound,
            normal_spring: -normal * elastic,
            normal_dashpot: -normal * (repulsion - elastic),
            tangential_spring: spring,
            tangential_dashpot: -self.slip * damping,
            capillary: normal * pull,
            viscous_normal: -normal * resistance,
            viscous_tangential: contact.bridge.as_ref().map_or(DVec3::ZERO, |b| b.drag),
            rolling: contact.rolling,
        }
    }
}

/// Time step and number of partners over the moment of inertia of grain `i` [1/(N m s)].
fn compliance(world: &World, i: u32) -> f64 {
    let (grains, i) = (&world.grains, i as usize);
    let partners = grains.contact_count[i] + grains.open_bridges[i];
    world.clock.time_step / grains.inertia[i] * f64::from(partners.max(1))
}

fn one(x: f64) -> One {
    One::splat((), x)
}

fn ones(row: &Row) -> [One; 4] {
    One::spread((), row)
}

/// A pair with the constants of its law.
struct Side {
    pairing: Pairing,
    constants: PairConstants,
}

impl Side {
    fn of(world: &World, contact: &Contact) -> Self {
        let pairing = world.pairing(contact.grain as usize, contact.partner);
        // Walls carry no liquid, but what lies on them is as slippery.
        let wet = world.wetting().is_some();
        Self {
            constants: pairing.constants(world.law, &world.materials, wet),
            pairing,
        }
    }

    /// What the law makes of the two along their normal, as the pair loop has it.
    fn along(&self, law: impl Law, overlap: f64, approach: f64) -> NormalContact<One> {
        let (depth, zero) = (one(overlap), one(0.0));
        let touching = depth.exceeds(zero);
        let overlap = One::choose(touching, depth, zero);
        let constants = ones(&self.constants.coefficients);
        normal_contact(law, constants, (touching, overlap), one(approach), zero)
    }
}

/// The repulsion of two spheres [N].
struct Repulsion<'a> {
    pair: &'a Side,
    overlap: f64,
    approach: f64,
}

impl LawUser for Repulsion<'_> {
    type Output = f64;

    fn with<L: Law>(self, law: L) -> f64 {
        (self.pair.along(law, self.overlap, self.approach))
            .repulsion
            .get()
    }
}

/// The normal force of a pair of spheres over the gap between them.
pub struct NormalLaw {
    law: ContactLaw,
    pair: Side,
    film: Option<Film>,
}

/// What the bridge of a pair does.
struct Film {
    constants: FilmConstants,
    bridge: BridgeConstants,
    /// Step over the mass that partners leave free, summed over both sides [s/kg].
    mobility: f64,
}

impl NormalLaw {
    /// The law between the grain and the partner of `contact`; of a wet pair of grains with the
    /// bridge that `choice` makes between them, or the one that is there where that is the world's
    /// own choice.
    pub fn of(world: &World, contact: &Contact, choice: BridgeLaw) -> Self {
        let pair = Side::of(world, contact);
        let film = match (contact.partner, world.wetting()) {
            (Partner::Grain(j), Some(liquid)) => {
                let liquid = Liquid {
                    law: choice,
                    ..*liquid
                };
                let own = contact.bridge.as_ref().map(|bridge| bridge.volume);
                let same = world.wetting().is_some_and(|own| own.law == choice);
                let volume = own.filter(|_| same).unwrap_or_else(|| {
                    let films = &world.grains.film;
                    let films = (films[contact.grain as usize], films[j as usize]);
                    let (first, second) = contributions(&liquid, pair.pairing.radii, films);
                    first + second
                });
                (volume > 0.0).then(|| Film::of(world, contact, &pair.pairing, &liquid, volume))
            }
            _ => None,
        };
        Self {
            law: world.law,
            pair,
            film,
        }
    }

    /// Force that pushes the two apart (positive) or pulls them together [N] at this `gap`,
    /// negative for an overlap [m], while they approach each other at this speed [m/s].
    pub fn force(&self, gap: f64, approach: f64) -> f64 {
        let repulsion = self.law.choose(Repulsion {
            pair: &self.pair,
            overlap: -gap,
            approach,
        });
        repulsion + (self.film.as_ref()).map_or(0.0, |film| film.force(gap, approach))
    }

    /// Gap at which the bridge breaks [m]; none where there is none.
    pub fn rupture_gap(&self) -> Option<f64> {
        self.film.as_ref().map(|film| film.bridge.row[3])
    }
}

impl Film {
    fn of(
        world: &World,
        contact: &Contact,
        pairing: &Pairing,
        liquid: &Liquid,
        volume: f64,
    ) -> Self {
        let partner = match contact.partner {
            Partner::Grain(j) => compliance(world, j),
            Partner::Wall(_) => 0.0,
        };
        let constants = FilmConstants::of(pairing, liquid);
        Self {
            bridge: BridgeConstants::of(liquid, pairing.radii, volume),
            mobility: (compliance(world, contact.grain) + partner) * constants.viscous[3],
            constants,
        }
    }

    fn force(&self, gap: f64, approach: f64) -> f64 {
        if gap > self.bridge.row[3] {
            return 0.0;
        }
        let [in_contact, smallest, largest, _] = self.constants.gaps;
        let pull = attraction(
            (),
            ones(&self.bridge.row),
            one(gap.clamp(in_contact, largest)),
        );
        let viscous = ones(&self.constants.viscous);
        let [normal, _] = drag(
            (),
            viscous,
            one(gap.clamp(smallest, largest)),
            one(self.mobility),
        );
        normal.get() * approach - pull.get()
    }
}
