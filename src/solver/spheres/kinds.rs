//! Kinds of pairs: what a pair's constants depend on.
//!
//! In: a world. Out: an index for every pair of grains and every grain at a wall, and the constants
//! of each such kind. Grains of one class (radius, mass, material) are alike to every law, so that
//! a bed of a thousand pairs has a handful of kinds.
//!
//! A kind is met when a search first finds a pair of it, and stays: numbers of kinds stand in the
//! lists. Constants are computed anew when a world is loaded, as materials and law may have been
//! changed meanwhile; classes only when other grains come. Where all pairs of a list are of one
//! kind, as in a bed of equal grains, the pair loop reads constants once instead of pair by pair.

use super::rows::PairKind;
use crate::physics::law::{FilmConstants, Law, LawSource, LawUser, PairConstants, Pairing};
use crate::world::{Partner, World};
use std::collections::HashMap;

/// The kinds of pairs that have been met so far.
#[derive(Default)]
pub struct Kinds {
    class_of: Vec<u32>,
    wall_materials: Vec<u16>,
    index: HashMap<(u32, PartnerClass), PairKind>,
    /// A pair of each kind, to compute its constants from.
    examples: Vec<(usize, Partner)>,
    /// What the contact law needs of each kind.
    pub constants: Vec<PairConstants>,
    /// What bridges depend on, for each kind; empty where nothing is wet.
    pub films: Vec<FilmConstants>,
}

/// The second side of a kind of pair: walls are told apart by their number, as each has its own
/// material and motion.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum PartnerClass {
    Class(u32),
    Wall(u32),
}

impl Kinds {
    /// Sorts the grains into classes; false when they are not those known before.
    pub fn classify(&mut self, world: &World) -> bool {
        let grains = &world.grains;
        let mut classes = HashMap::new();
        let mut last = None;
        let class_of: Vec<u32> = (0..grains.len())
            .map(|i| {
                let material = world.species[usize::from(grains.species[i].0)].material;
                let key = (
                    grains.radius[i].to_bits(),
                    grains.mass[i].to_bits(),
                    material,
                );
                // Grains that are alike follow each other, as a rule.
                if let Some((known, class)) = last
                    && known == key
                {
                    return class;
                }
                let next = classes.len() as u32;
                let class = *classes.entry(key).or_insert(next);
                last = Some((key, class));
                class
            })
            .collect();
        let wall_materials: Vec<u16> = world
            .container
            .walls
            .iter()
            .map(|wall| wall.material.0)
            .collect();
        let known = self.class_of == class_of && self.wall_materials == wall_materials;
        if !known {
            *self = Self {
                class_of,
                wall_materials,
                ..Self::default()
            };
        }
        known
    }

    /// Computes the constants of every kind from the world's present materials.
    pub fn compute(&mut self, law: impl LawSource, world: &World) {
        self.constants.clear();
        self.films.clear();
        let liquid = world.wetting();
        for (grain, partner) in &self.examples {
            let pairing = world.pairing(*grain, *partner);
            let constants = ConstantsOf {
                pairing: &pairing,
                world,
            };
            self.constants.push(law.choose(world.law, constants));
            self.films
                .extend(liquid.map(|liquid| FilmConstants::of(&pairing, liquid)));
        }
    }

    /// Computes the constants of kinds that have been met since they were last computed.
    pub fn complete(&mut self, law: impl LawSource, world: &World) {
        if self.constants.len() < self.examples.len() {
            self.compute(law, world);
        }
    }

    /// The kind of `grain` and its `partner`.
    pub fn of(&mut self, grain: u32, partner: Partner) -> PairKind {
        let next = PairKind(self.examples.len() as u32);
        *self
            .index
            .entry(self.classes(grain, partner))
            .or_insert_with(|| {
                self.examples.push((grain as usize, partner));
                next
            })
    }

    /// Finds kinds that have been met.
    pub fn finder(&self) -> KindFinder<'_> {
        KindFinder {
            kinds: self,
            last: None,
        }
    }

    /// What tells the kind of a pair.
    fn classes(&self, grain: u32, partner: Partner) -> Classes {
        let side = match partner {
            Partner::Grain(j) => PartnerClass::Class(self.class_of[j as usize]),
            Partner::Wall(w) => PartnerClass::Wall(w),
        };
        (self.class_of[grain as usize], side)
    }
}

/// A grain's class and that of its partner.
type Classes = (u32, PartnerClass);

/// Finds kinds of pairs that have been met: quickly where pairs of one kind follow each other.
pub struct KindFinder<'a> {
    kinds: &'a Kinds,
    last: Option<(Classes, PairKind)>,
}

impl KindFinder<'_> {
    /// The kind of `grain` and its `partner`; none where no pair of it has been met yet.
    pub fn find(&mut self, grain: u32, partner: Partner) -> Option<PairKind> {
        let classes = self.kinds.classes(grain, partner);
        if let Some((known, kind)) = self.last
            && known == classes
        {
            return Some(kind);
        }
        let kind = *self.kinds.index.get(&classes)?;
        self.last = Some((classes, kind));
        Some(kind)
    }
}

/// The constants of a pair by whatever law acts.
struct ConstantsOf<'a> {
    pairing: &'a Pairing,
    world: &'a World,
}

impl LawUser for ConstantsOf<'_> {
    type Output = PairConstants;

    fn with<L: Law>(self, law: L) -> PairConstants {
        let wet = self.world.wetting().is_some();
        (self.pairing).constants_by(&law, &self.world.materials, wet)
    }
}
