//! The normal force of a pair of spheres over the gap between them: a curve to draw.
//!
//! In: a world and one of its contacts, a choice of the bridge's law. Out: the force at any gap and
//! speed of approach, from the functions that the pair loop calls.
//!
//! A bridge is drawn as it would be at the volume it has, or, of another choice of the law, at the
//! volume that choice would give it. Its drag is bounded by the mobility of the grains as they are
//! now. Not here: friction, rolling, the force across the normal.

use super::terms::half_a_step_ago;
use crate::lanes::{Lanes, One, Row};
use crate::physics::law::{
    BridgeConstants, FilmConstants, Law, LawUser, NormalContact, PairConstants, Pairing,
    attraction, contributions, drag, normal_contact,
};
use crate::physics::{BridgeLaw, ContactLaw, Liquid};
use crate::world::{Contact, Partner, World};

/// A number in the one lane that there is.
fn one(x: f64) -> One {
    One::splat((), x)
}

/// A row's numbers, each in that lane.
fn ones(row: &Row) -> [One; 4] {
    One::spread((), row)
}

/// A pair with the constants of its law.
struct PairLaw {
    pairing: Pairing,
    constants: PairConstants,
}

impl PairLaw {
    /// The pair of `contact` under the world's law.
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
    pair: &'a PairLaw,
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
    pair: PairLaw,
    film: Option<BridgeCurve>,
}

/// What the bridge of a pair does.
struct BridgeCurve {
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
        let pair = PairLaw::of(world, contact);
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
                (volume > 0.0)
                    .then(|| BridgeCurve::of(world, contact, &pair.pairing, &liquid, volume))
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

impl BridgeCurve {
    /// A bridge of this volume [m³] of the `liquid` between the sides of `contact`.
    fn of(
        world: &World,
        contact: &Contact,
        pairing: &Pairing,
        liquid: &Liquid,
        volume: f64,
    ) -> Self {
        let compliance = |i: u32| half_a_step_ago(world, i as usize).compliance();
        let partner = match contact.partner {
            Partner::Grain(j) => compliance(j),
            Partner::Wall(_) => 0.0,
        };
        let constants = FilmConstants::of(pairing, liquid);
        Self {
            bridge: BridgeConstants::of(liquid, pairing.radii, volume),
            mobility: (compliance(contact.grain) + partner) * constants.viscous[3],
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
