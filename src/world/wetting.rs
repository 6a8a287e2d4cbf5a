//! The liquid between the grains: films on them, bridges between them.

use super::World;
use crate::physics::Liquid;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What a bridge remembers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bridge {
    /// Its volume V, fixed when it formed [m³].
    pub volume: f64,
    /// What the film of the contact's grain gains, and its partner's loses, when the bridge breaks
    /// and its volume is shared evenly [m³].
    pub transfer: f64,
    /// Capillary attraction at the last force evaluation [N].
    pub capillary: f64,
    /// Viscous force along the normal then, positive where it pushes the grains apart [N].
    pub viscous: f64,
    /// Viscous force on the grain across the normal then [N].
    pub drag: DVec3,
}

impl World {
    /// The liquid, where there is any.
    pub fn wetting(&self) -> Option<&Liquid> {
        self.liquid.as_ref().filter(|liquid| liquid.volume > 0.0)
    }

    /// Changes the volume of all the liquid [m³]; films and bridges keep their shares of it.
    /// Without a liquid nothing happens.
    pub fn set_liquid_volume(&mut self, volume: f64) {
        let Some(liquid) = &mut self.liquid else {
            return;
        };
        let old = std::mem::replace(&mut liquid.volume, volume);
        if old > 0.0 && volume > 0.0 {
            let factor = volume / old;
            self.grains.film.iter_mut().for_each(|film| *film *= factor);
            for bridge in self.contacts.iter_mut().filter_map(|c| c.bridge.as_mut()) {
                bridge.volume *= factor;
                bridge.transfer *= factor;
            }
        } else {
            self.spread_liquid();
            self.contacts.iter_mut().for_each(|c| c.bridge = None);
        }
        if volume == 0.0 {
            self.drop_open_bridges();
        }
    }

    /// Spreads all the liquid over the grains, each with a film in proportion to its own volume.
    pub(super) fn spread_liquid(&mut self) {
        let volume = self.liquid.map_or(0.0, |liquid| liquid.volume);
        let solid = |r: &f64| r * r * r;
        let all: f64 = self.grains.radius.iter().map(solid).sum();
        let films = self.grains.radius.iter().map(|r| volume * solid(r) / all);
        let films = films.collect();
        self.grains.film.set(films);
    }

    /// Forgets the pairs that only a bridge held together.
    fn drop_open_bridges(&mut self) {
        self.grains.open_bridges.fill(0);
        self.contacts.retain(|contact| contact.touching);
    }
}
