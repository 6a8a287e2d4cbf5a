//! A scene as an input script of LAMMPS with its package GRANULAR.
//!
//! In: a scene and its world at time zero. Out: a [`Deck`], or why there can be none. Coefficients
//! are stated pair by pair of types, as the solver computes them; walls are regions, which may
//! turn and move along themselves. There are no liquid bridges.

use super::atom_types::AtomTypes;
use super::deck::{
    Deck, GRAINS, Handed, common_deviations, domain, refused, run_lines, wall_name, words,
};
use crate::physics::ContactLaw;
use crate::physics::law::{Pairing, natural_log};
use crate::world::{Shape, Surface, Wall, World};
use glam::DVec3;
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Skin of its neighbour lists, in radii of the smallest grain.
const SKIN: f64 = 0.3;
/// The square of the phase that the spring of rolling friction goes through in a step, with
/// [`CONTACTS`] contacts on a grain.
const ROLLING_PHASE: f64 = 0.04;
/// Contacts of a grain.
const CONTACTS: f64 = 6.0;

/// The types of `world` as this engine needs them.
///
/// # Errors
/// When there are too many.
pub fn types(world: &World) -> Result<AtomTypes, String> {
    AtomTypes::of(world, true)
}

/// The script for `handed`.
///
/// # Errors
/// All that it does not have, in sentences.
pub fn lammps_deck(handed: Handed, types: &AtomTypes) -> Result<Deck, Vec<String>> {
    let world = handed.world;
    let mut faults = refused(handed);
    if world.wetting().is_some() {
        faults.push(
            "its grains are wet: LAMMPS has no liquid bridges of this kind; `--to liggghts` with `--set \
             bridge-law=as-coded`, or `--set liquid-volume=0`"
                .to_owned(),
        );
    }
    faults.extend(refused_restitution(world));
    if matches!(world.container.shape, Shape::Mesh { .. }) {
        faults.push(
            "its walls are a mesh: walls of LAMMPS are regions of plain shapes; `--to liggghts` takes meshes, or state the \
             walls as a `Drum`, a `Box` or `Planes`"
                .to_owned(),
        );
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let (domain, boundary) = domain(world);
    let mut script = head(handed, boundary);
    for a in 0..types.grains.len() {
        for b in a..types.grains.len() {
            let pairing = types.pairing(world, a, b);
            let model = contact_model(world, &pairing, pairing.effective_radius);
            let _ = writeln!(script, "pair_coeff {} {} {model}", a + 1, b + 1);
        }
    }
    script += &walls(world, types);
    script += &run_lines(handed, "time yes units yes format float %.15e");
    Ok(Deck {
        script,
        meshes: Vec::new(),
        domain,
        // A wall's coefficients stand with the wall.
        types: types.grains.len(),
        deviations: deviations(handed),
    })
}

fn head(handed: Handed, boundary: &str) -> String {
    let world = handed.world;
    let smallest = (world.grains.radius.iter().copied()).fold(f64::INFINITY, f64::min);
    let mut text = format!(
        "# {}\n# LAMMPS with GRANULAR; SI units. `sh run.sh 4` runs it on 4 processes.\n",
        handed.title
    );
    text += "units si\natom_style sphere\natom_modify map array\n";
    let _ = writeln!(text, "boundary {boundary}\nnewton off");
    text += "comm_modify mode single vel yes\n";
    if world.container.drum_speed() != 0.0 {
        text += "processors * * 1\n";
    }
    let _ = writeln!(text, "read_data {GRAINS}");
    let _ = writeln!(
        text,
        "neighbor {:e} bin\nneigh_modify delay 0",
        SKIN * smallest
    );
    text += "pair_style granular\n";
    text
}

/// The words of a contact's model. The engine takes `effective_radius` [m] for the pair's own: its
/// coefficients are scaled so that forces come out as with the pair's.
fn contact_model(world: &World, pairing: &Pairing, effective_radius: f64) -> String {
    let row = pairing.constants(world.law, &world.materials, false);
    let [normal, damping, tangential, across] = row.coefficients;
    let pair = (world.materials).pair(pairing.materials.0, pairing.materials.1);
    // Over the normal dashpot; neither is there where a contact gives all of its speed back.
    let ratio = if damping == 0.0 {
        0.0
    } else {
        across / damping
    };
    let friction = row.contact[0];
    let (model, dashpot) = match world.law {
        ContactLaw::HertzMindlin => {
            let root = effective_radius.sqrt();
            let argument = tsuji_argument(pair.restitution);
            let dashpot = if argument.is_some() {
                "tsuji"
            } else {
                "velocity"
            };
            let words = format!(
                "hertz {:e} {:e} tangential mindlin {:e} {ratio:e} {friction:e}",
                normal / root,
                argument.unwrap_or(0.0),
                tangential / root
            );
            (words, dashpot)
        }
        ContactLaw::Hooke { .. } | ContactLaw::SpringDashpot { .. } => (
            format!(
                "hooke {normal:e} {damping:e} tangential linear_history {tangential:e} {ratio:e} {friction:e}"
            ),
            "velocity",
        ),
    };
    let rolling = rolling(world, pairing, pair.rolling_friction, effective_radius);
    let limit = match world.law {
        ContactLaw::Hooke { .. } => " limit_damping",
        ContactLaw::HertzMindlin | ContactLaw::SpringDashpot { .. } => "",
    };
    format!("{model}{rolling} damping {dashpot}{limit}")
}

/// Rolling friction as a spring that slides: as stiff as a step bears, so that its bound acts as
/// soon as ours does.
fn rolling(world: &World, pairing: &Pairing, coefficient: f64, effective_radius: f64) -> String {
    if coefficient == 0.0 {
        return String::new();
    }
    let inertia = |radius: f64, mass: f64| 0.4 * mass * radius * radius;
    let (a, b) = pairing.radii;
    // Masses of both from m* and the radii, of one density or not: the lighter one decides.
    let mass = pairing.effective_mass;
    let resistance = if b == 0.0 {
        inertia(a, mass)
    } else {
        0.5 * inertia(a.min(b), 2.0 * mass)
    };
    let rolling_mass = resistance / (effective_radius * effective_radius);
    let step = world.clock.time_step;
    let stiffness = ROLLING_PHASE * rolling_mass / (CONTACTS * step * step);
    let dashpot = (stiffness * rolling_mass).sqrt();
    let bound = coefficient * pairing.effective_radius / effective_radius;
    format!(" rolling sds {stiffness:e} {dashpot:e} {bound:e}")
}

/// What the polynomial of `damping tsuji` takes to give `√5 |β|`, with `β = ln e/√(ln² e + π²)`:
/// the dashpot of Eqs. 5–9 of Kasper et al. 2021, of which that polynomial of e is a fit. None for
/// a restitution of 1, which takes no dashpot.
fn tsuji_argument(restitution: f64) -> Option<f64> {
    let wanted = dashpot_factor(restitution);
    if wanted == 0.0 {
        return None;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if tsuji(middle) > wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

/// The polynomial of `damping tsuji`, falling from 1.27 at 0 to 0.0003 at 1.
fn tsuji(x: f64) -> f64 {
    const COEFFICIENTS: [f64; 7] = [1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218];
    COEFFICIENTS.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

fn dashpot_factor(restitution: f64) -> f64 {
    let log = natural_log(restitution);
    -5_f64.sqrt() * log / (log * log + PI * PI).sqrt()
}

/// Restitutions whose dashpot is stronger than the engine's.
fn refused_restitution(world: &World) -> Vec<String> {
    if world.law != ContactLaw::HertzMindlin {
        return Vec::new();
    }
    let smallest = world.materials.pairs().map(|pair| pair.restitution);
    let smallest = smallest.fold(f64::INFINITY, f64::min);
    let reason = format!(
        "a restitution of {smallest} takes a stronger dashpot than `damping tsuji` of LAMMPS has: 0.12 is about its least"
    );
    (dashpot_factor(smallest) > tsuji(0.0))
        .then_some(reason)
        .into_iter()
        .collect()
}

/// Walls: a region each, and what it does to each type of grain.
fn walls(world: &World, types: &AtomTypes) -> String {
    let mut text = String::new();
    for kind in 1..=types.grains.len() {
        let _ = writeln!(text, "group type{kind} type {kind}");
    }
    for (index, wall) in world.container.walls.iter().enumerate() {
        let name = wall_name(wall, index);
        text += &motion_variables(wall, &name);
        let _ = writeln!(
            text,
            "region {name} {}{}",
            region(wall),
            motion(wall, &name)
        );
        for kind in 0..types.grains.len() {
            let of_wall = types.of_wall(wall.material) - 1;
            let pairing = types.pairing(world, kind, of_wall);
            let radius = engine_radius(wall, pairing.effective_radius);
            let _ = writeln!(
                text,
                "fix {name}_{0} type{0} wall/gran/region granular {1} region {name}",
                kind + 1,
                contact_model(world, &pairing, radius)
            );
        }
    }
    text
}

/// The effective radius that the engine computes for a grain of this `radius` at the wall [m]: it
/// takes the curvature of a rim into account.
fn engine_radius(wall: &Wall, radius: f64) -> f64 {
    match wall.surface {
        Surface::Cylinder { radius: rim } => radius * 2.0 * rim / (2.0 * rim - radius),
        Surface::Plane { .. } | Surface::Tube { .. } | Surface::Mesh(_) => radius,
    }
}

fn region(wall: &Wall) -> String {
    match wall.surface {
        // It and a rising tube are refused before.
        Surface::Mesh(_) => String::new(),
        Surface::Plane { point, normal } => {
            format!("plane {} {} side in units box", words(point), words(normal))
        }
        Surface::Cylinder { radius } | Surface::Tube { radius, .. } => {
            format!("cylinder z 0 0 {radius:e} -10 10 side in units box open 1 open 2")
        }
    }
}

fn motion_variables(wall: &Wall, name: &str) -> String {
    let mut text = String::new();
    let spin = wall.motion.spin;
    if spin != DVec3::ZERO {
        let _ = writeln!(
            text,
            "variable {name}_angle equal {:e}*step*dt",
            spin.length()
        );
    }
    let velocity = wall.motion.velocity;
    if velocity != DVec3::ZERO {
        for (axis, speed) in ["x", "y", "z"].iter().zip(velocity.to_array()) {
            let _ = writeln!(text, "variable {name}_{axis} equal {speed:e}*step*dt");
        }
    }
    text
}

fn motion(wall: &Wall, name: &str) -> String {
    let mut text = String::new();
    if let Some(axis) = wall.motion.spin.try_normalize() {
        let _ = write!(text, " rotate v_{name}_angle 0 0 0 {}", words(axis));
    }
    if wall.motion.velocity != DVec3::ZERO {
        let _ = write!(text, " move v_{name}_x v_{name}_y v_{name}_z");
    }
    text
}

fn deviations(handed: Handed) -> Vec<String> {
    let world = handed.world;
    let mut found = common_deviations(handed);
    if world.materials.pairs().any(|p| p.rolling_friction > 0.0) {
        found.push(
            "Rolling friction is a spring with a dashpot that slides at the bound μ_R |F_n| r* (`rolling sds`), as stiff \
             as the step bears; here the torque that holds a contact is found within a step, and its bound is of the \
             normal spring alone."
                .to_owned(),
        );
    }
    if world.law != ContactLaw::HertzMindlin {
        found.push(
            "Friction is bounded by spring and dashpot of the normal force together; here by the spring alone."
                .to_owned(),
        );
    }
    found.push(
        "A contact's tangential dashpot counts within Coulomb's bound, and one that slides keeps it; here a contact that \
         slides has none."
            .to_owned(),
    );
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashpot_is_that_of_the_restitution() {
        for e in [0.13, 0.3, 0.72, 0.95, 0.999] {
            let found = tsuji(tsuji_argument(e).unwrap());
            let wanted = dashpot_factor(e);
            assert!(
                (found - wanted).abs() < 1e-9 + 4e-4 * f64::from(e > 0.99),
                "{e}: {found} {wanted}"
            );
        }
        assert_eq!(tsuji_argument(1.0), None);
    }
}
