//! Kinds of pairs: what a pair's constants depend on.
//!
//! In: a world. Out: an index for every pair of grains and every grain at a wall, and the constants
//! of each such kind. Grains of one class (radius, mass, material) are alike to every law, so that
//! a bed of a thousand pairs has a handful of kinds.

use crate::physics::law::{FilmConstants, PairConstants};
use crate::world::{Partner, World};
use std::collections::HashMap;

/// The kinds of pairs that have been met so far.
#[derive(Default)]
pub struct Kinds {
    class_of: Vec<u32>,
    wall_materials: Vec<u16>,
    index: HashMap<(u32, Side), u32>,
    /// A pair of each kind, to compute its constants from.
    examples: Vec<(usize, Partner)>,
    /// What the contact law needs of each kind.
    pub constants: Vec<PairConstants>,
    /// What bridges depend on, for each kind; empty where nothing is wet.
    pub films: Vec<FilmConstants>,
}

/// The second side of a kind of pair.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Side {
    Class(u32),
    Wall(u32),
}

impl Kinds {
    /// Sorts the grains into classes; false when they are not those known before.
    pub fn classify(&mut self, world: &World) -> bool {
        let grains = &world.grains;
        let mut classes = HashMap::new();
        let class_of: Vec<u32> = (0..grains.len())
            .map(|i| {
                let material = world.species[usize::from(grains.species[i].0)].material;
                let key = (
                    grains.radius[i].to_bits(),
                    grains.mass[i].to_bits(),
                    material,
                );
                let next = classes.len() as u32;
                *classes.entry(key).or_insert(next)
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
    pub fn compute(&mut self, world: &World) {
        self.constants.clear();
        self.films.clear();
        let liquid = world.wetting();
        for (grain, partner) in &self.examples {
            let pairing = world.pairing(*grain, *partner);
            let constants = pairing.constants(world.law, &world.materials, liquid.is_some());
            self.constants.push(constants);
            self.films
                .extend(liquid.map(|liquid| FilmConstants::of(&pairing, liquid)));
        }
    }

    /// Computes the constants of kinds that have been met since they were last computed.
    pub fn complete(&mut self, world: &World) {
        if self.constants.len() < self.examples.len() {
            self.compute(world);
        }
    }

    /// The kind of `grain` and its `partner`.
    pub fn of(&mut self, grain: u32, partner: Partner) -> u32 {
        let class = self.class_of[grain as usize];
        let side = match partner {
            Partner::Grain(j) => Side::Class(self.class_of[j as usize]),
            Partner::Wall(w) => Side::Wall(w),
        };
        let next = self.examples.len() as u32;
        *self.index.entry((class, side)).or_insert_with(|| {
            self.examples.push((grain as usize, partner));
            next
        })
    }
}
