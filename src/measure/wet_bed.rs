//! What the liquid does in a bed: bridges, dimensionless numbers, the paper's law for the drops.
//!
//! In: a world. Out: numbers, none where there is no liquid. Forces of bridges are not here but in
//! the solver.

use super::surface::mean_radius;
use crate::geometry::sphere_volume;
use crate::world::{Contact, World};

/// Number of liquid bridges.
pub fn bridges(world: &World) -> usize {
    let bridged = |contact: &&Contact| contact.bridge.is_some();
    world.contacts.iter().filter(bridged).count()
}

/// Capillary number `Ca = η v_c/(γ cos α)` with `v_c = √(4 g r)` (Eq. 1 of Kasper et al. 2021), r
/// the mean radius; none without liquid.
pub fn capillary_number(world: &World) -> Option<f64> {
    let liquid = world.wetting()?;
    let speed = (4.0 * world.gravity.length() * mean_radius(&world.grains)).sqrt();
    Some(liquid.viscosity * speed / (liquid.surface_tension * liquid.contact_angle.cos()))
}

/// Galilei number `Ga = ρ² g r³/η²` (Eq. 25) with the mean density and radius of the grains; none
/// without viscosity.
pub fn galilei_number(world: &World) -> Option<f64> {
    let viscosity = world.wetting()?.viscosity;
    let grains = &world.grains;
    let volume: f64 = grains.radius.iter().copied().map(sphere_volume).sum();
    let density = grains.mass.iter().sum::<f64>() / volume;
    let radius = mean_radius(grains);
    (viscosity > 0.0).then(|| {
        density * density * world.gravity.length() * radius.powi(3) / (viscosity * viscosity)
    })
}

/// The paper's law for wet over dry drops, `0.4 + 0.47 exp(−η/295 mPa s)` (Eq. 23), at the
/// viscosity η [Pa s].
pub fn drop_ratio_law(viscosity: f64) -> f64 {
    0.4 + 0.47 * (-viscosity / 0.295).exp()
}
