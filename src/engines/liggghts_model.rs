//! A contact law in the words of LIGGGHTS 3.8.
//!
//! In: a world. Out: the words of `pair_style gran` and `fix wall/gran`. Not here: constants of
//! materials ([`super::liggghts_deck`]).

use crate::physics::{ContactLaw, CoulombBound};
use crate::world::World;

/// The words of a contact's model.
pub struct ContactModel {
    /// Which models.
    pub models: String,
    /// Their settings, which stand behind everything else.
    pub settings: String,
}

impl ContactModel {
    /// Of grains, where there may be bridges, or with walls, which hold none.
    pub fn of(world: &World, of_grains: bool) -> Self {
        let rolls = world.materials.pairs().any(|p| p.rolling_friction > 0.0);
        let (normal, mut settings) = match world.law {
            ContactLaw::HertzMindlin => ("hertz", String::new()),
            ContactLaw::SpringDashpot { .. } => ("hooke/stiffness", String::new()),
            ContactLaw::Hooke { .. } => (
                "hooke/stiffness",
                " limitForce on tangential_damping off".to_owned(),
            ),
        };
        let wet = world.wetting().filter(|_| of_grains);
        let cohesion = wet.map_or("", |_| " cohesion easo/capillary/viscous");
        let rolling = if rolls { " rolling_friction cdt" } else { "" };
        settings += match wet.map(|liquid| liquid.law.coulomb) {
            Some(CoulombBound::Total) => " tangential_reduce on",
            Some(CoulombBound::Contact) => " tangential_reduce off",
            None => "",
        };
        Self {
            models: format!("model {normal} tangential history{cohesion}{rolling}"),
            settings,
        }
    }
}
