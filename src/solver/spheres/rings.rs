//! What pairs do, for as long as grains still ask for it.
//!
//! In: forces, pair by pair. Out: the same by the number of the pair, until a later pair takes its
//! place. Pairs are computed in the order of their lower slots, and grains moved right behind the
//! last of their pairs ([`super::pass`]): what a pair does is asked for within a slice of the bed.
//! So a few rows, which stay in the processor's cache, do for a bed of any size.
//!
//! A ring is a power of two of rows; a pair's row is its number modulo that. How many it takes is
//! told by [`super::plan`].

use super::bridges::BridgeEffect;
use super::places::{Place, ROWS_OF_WALL, row_at_wall};
use super::plan::Plan;
use super::rows::{ContactForce, GROUP, WallId};

/// Where pairs write what they do, from a first one on.
pub struct Target<'a> {
    /// Rows of forces, a power of two, or as many as there are pairs.
    pub forces: &'a mut [ContactForce],
    /// Rows of what bridges do; empty where nothing is wet.
    pub bridge_effects: &'a mut [BridgeEffect],
    /// Number of the first pair.
    pub first: usize,
    /// Number of rows less one.
    pub mask: usize,
}

/// What the pairs of one worker do.
#[derive(Default)]
pub struct Rings {
    /// Of pairs of grains, a power of two; then of pairs with walls, wall by wall.
    forces: Vec<ContactForce>,
    /// Of pairs of grains, and one that does nothing: walls hold no bridges.
    bridge_effects: Vec<BridgeEffect>,
    /// Rows of pairs of grains less one.
    mask: usize,
    /// Of other workers' pairs that are computed here too, one after the other, until they take
    /// their places.
    foreign_forces: Vec<ContactForce>,
    foreign_effects: Vec<BridgeEffect>,
}

impl Rings {
    /// Makes room for what `plan` asks for, with so many walls; `wet` where there are bridges.
    pub fn fit(&mut self, plan: &Plan, walls: usize, wet: bool) {
        let count = plan.span.next_power_of_two().max(GROUP);
        let foreign = plan.foreign.len().next_multiple_of(GROUP);
        self.mask = count - 1;
        self.forces
            .resize(count + walls * ROWS_OF_WALL, ContactForce::default());
        self.foreign_forces.resize(foreign, ContactForce::default());
        let [own, foreign] = if wet { [count + 1, foreign] } else { [0; 2] };
        self.bridge_effects.clear();
        self.bridge_effects.resize(own, BridgeEffect::default());
        self.foreign_effects
            .resize(foreign, BridgeEffect::default());
    }

    /// Where the worker's own pairs from number `first` on write.
    #[inline(always)]
    pub fn own(&mut self, first: usize) -> Target<'_> {
        Target {
            forces: &mut self.forces,
            bridge_effects: &mut self.bridge_effects,
            first,
            mask: self.mask,
        }
    }

    /// Where those of other workers write.
    #[inline(always)]
    pub fn foreign(&mut self) -> Target<'_> {
        Target {
            forces: &mut self.foreign_forces,
            bridge_effects: &mut self.foreign_effects,
            first: 0,
            mask: usize::MAX,
        }
    }

    /// Gives what other workers' pairs of these numbers do their places.
    #[inline(always)]
    pub fn place_foreign(&mut self, numbers: &[u32]) {
        for (k, number) in numbers.iter().enumerate() {
            let place = *number as usize & self.mask;
            self.forces[place] = self.foreign_forces[k];
            if let Some(effect) = self.foreign_effects.get(k) {
                self.bridge_effects[place] = *effect;
            }
        }
    }

    /// Where the group of pairs with a wall that begins with number `first` writes.
    #[inline(always)]
    pub fn at_wall(&mut self, wall: WallId, first: usize) -> &mut [ContactForce] {
        &mut self.forces[self.mask + 1 + row_at_wall(wall, first)..]
    }

    /// What the pair of grains of this number does.
    #[inline(always)]
    pub fn force(&self, number: usize) -> &ContactForce {
        &self.forces[number & self.mask]
    }

    /// What its bridge does.
    #[inline(always)]
    pub fn bridge_effect(&self, number: usize) -> &BridgeEffect {
        &self.bridge_effects[number & self.mask]
    }

    /// What a pair of grains or with a wall does.
    #[inline(always)]
    pub fn force_at(&self, place: Place) -> &ContactForce {
        let number = place.number();
        // No branch: it would be taken by chance.
        let row = if place.is_at_wall() {
            self.mask + 1 + number
        } else {
            number & self.mask
        };
        &self.forces[row]
    }

    /// What its bridge does; that of a wall does nothing.
    #[inline(always)]
    pub fn bridge_effect_at(&self, place: Place) -> &BridgeEffect {
        let row = if place.is_at_wall() {
            self.mask + 1
        } else {
            place.number() & self.mask
        };
        &self.bridge_effects[row]
    }

    /// What the pair of this number with a wall does.
    pub fn force_at_wall(&self, wall: WallId, number: usize) -> &ContactForce {
        &self.forces[self.mask + 1 + row_at_wall(wall, number)]
    }
}
