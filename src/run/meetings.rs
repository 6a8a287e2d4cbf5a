//! Who met whom: each contact and each liquid bridge of few grains, to the step.
//!
//! In: the states before and after a step. Out: what began and ended in it, as [`Meeting`]s. They
//! are looked for where single contacts are followed (see [`super::sampling`]): among many grains
//! there are thousands a second, and what counts is how many there are.

use crate::solver::force_terms;
use crate::world::{Contact, MOST_STEPS, Partner, World};
use serde::{Deserialize, Serialize};

/// Most of them that are kept of a run, the first ones: grains that tremble in a corner would fill
/// the memory.
pub const MOST_MEETINGS: usize = 10_000;

/// A contact or a liquid bridge that begins or ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Meeting {
    /// The first step after which it is so.
    pub step: u64,
    /// Simulated time then [s].
    pub time: f64,
    /// One grain, by index; of two the one with the smaller.
    pub grain: u32,
    /// The other side.
    pub partner: Partner,
    /// What became of the two.
    pub kind: MeetingKind,
}

/// What becomes of two that meet or part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MeetingKind {
    /// They touch, having approached each other along the normal at this `speed` [m/s].
    Touch {
        /// Positive: they came nearer.
        speed: f64,
    },
    /// They touch no longer.
    Part,
    /// A liquid bridge forms between them.
    BridgeForms,
    /// It ruptures.
    BridgeRuptures,
}

impl Meeting {
    /// Whether two of a run can have met so in a world of so many `grains` and `walls`.
    pub(crate) fn is_sound(&self, grains: usize, walls: usize) -> bool {
        let has_partner = match self.partner {
            Partner::Grain(other) => (other as usize) < grains,
            Partner::Wall(wall) => (wall as usize) < walls,
        };
        let has_speed = match self.kind {
            MeetingKind::Touch { speed } => speed.is_finite(),
            _ => true,
        };
        let has_time = self.time.is_finite() && self.time >= 0.0 && self.step <= MOST_STEPS;
        (self.grain as usize) < grains && has_partner && has_speed && has_time
    }
}

/// What began and ended in the step from the state `before` to `world`.
pub(super) fn meetings(before: &World, world: &World) -> Vec<Meeting> {
    let begun = world.contacts.iter().flat_map(|contact| {
        let old = same_pair(before, contact);
        let touches = contact.touching && !old.is_some_and(|old| old.touching);
        let has_bridge = |contact: &Contact| contact.bridge.is_some();
        let bridges = has_bridge(contact) && !old.is_some_and(has_bridge);
        let touch = touches.then(|| MeetingKind::Touch {
            speed: approach(world, contact),
        });
        let bridge = bridges.then_some(MeetingKind::BridgeForms);
        [touch, bridge]
            .into_iter()
            .flatten()
            .map(move |kind| (contact, kind))
    });
    let ended = before.contacts.iter().flat_map(|contact| {
        let now = same_pair(world, contact);
        let parts = contact.touching && !now.is_some_and(|now| now.touching);
        let ruptures = contact.bridge.is_some() && now.is_none_or(|now| now.bridge.is_none());
        let part = parts.then_some(MeetingKind::Part);
        let rupture = ruptures.then_some(MeetingKind::BridgeRuptures);
        [part, rupture]
            .into_iter()
            .flatten()
            .map(move |kind| (contact, kind))
    });
    begun
        .chain(ended)
        .map(|(contact, kind)| Meeting {
            step: world.clock.step,
            time: world.time(),
            grain: contact.grain,
            partner: contact.partner,
            kind,
        })
        .collect()
}

/// The entry of `world` for the two sides of `contact`: its contacts are sorted by them.
fn same_pair<'a>(world: &'a World, contact: &Contact) -> Option<&'a Contact> {
    let sides = |contact: &Contact| (contact.grain, contact.partner);
    let index = world.contacts.binary_search_by_key(&sides(contact), sides);
    world.contacts.get(index.ok()?)
}

/// The speed at which the two sides of a `contact` that has just begun approached each other [m/s],
/// that before its force acted; of polyhedra the largest of all features that touch.
fn approach(world: &World, contact: &Contact) -> f64 {
    let terms = force_terms(world, contact).into_iter();
    let speed = terms.map(|terms| terms.approach).reduce(f64::max);
    speed.unwrap_or(0.0)
}
