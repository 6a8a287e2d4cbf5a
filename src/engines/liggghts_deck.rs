//! A scene as an input script of LIGGGHTS 3.8.
//!
//! In: a scene and its world at time zero. Out: a [`Deck`], or why there can be none. Walls at rest
//! along the axes are primitive walls, those that turn or move are meshes. Of bridges there is what
//! that program computes, [`BridgeLaw::AS_CODED`] with its free settings; other choices are
//! refused.

use super::atom_types::AtomTypes;
use super::deck::{Deck, GRAINS, Handed, common_deviations, domain, numbers, refused, run_lines};
use super::liggghts_model::ContactModel;
use super::liggghts_walls::{FACETS, MESH, Walls, rim_radius};
use crate::physics::law::Pairing;
use crate::physics::{
    BridgeLaw, BridgeVolume, CapillaryGap, ContactLaw, Liquid, MaterialId, PairAngle,
    PairProperties, Rupture, SmallestGap,
};
use crate::world::World;
use glam::DVec3;
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Young's moduli that it takes without being told that grains are soft or hard [Pa].
const MODULI: std::ops::RangeInclusive<f64> = 5e6..=10e9;
/// Smallest restitution that it takes.
const LEAST_RESTITUTION: f64 = 0.05;
/// Skin of its neighbour lists, in radii of the smallest grain.
const SKIN: f64 = 0.3;

/// The types of `world` as this engine needs them.
///
/// # Errors
/// When there are too many.
pub fn types(world: &World) -> Result<AtomTypes, String> {
    AtomTypes::of(world, world.law != ContactLaw::HertzMindlin)
}

/// The script for `handed`.
///
/// # Errors
/// All that it does not have, in sentences.
pub fn liggghts_deck(handed: Handed, types: &AtomTypes) -> Result<Deck, Vec<String>> {
    let world = handed.world;
    let mut faults = refused(handed);
    faults.extend(refused_pairs(world));
    let film = world.wetting().map(|liquid| film_share(world, liquid));
    if let Some(Err(reasons)) = &film {
        faults.extend(reasons.iter().cloned());
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let film = film.and_then(Result::ok);
    let (domain, boundary) = domain(world);
    let half_edge = 0.5 * (domain.max - domain.min).length();
    let walls = Walls::of(world, types, half_edge);
    let mut script = head(handed, boundary);
    script += &materials(world, types);
    if let (Some(liquid), Some(film)) = (world.wetting(), film) {
        script += &liquid_properties(liquid, film, types.count());
    }
    let ContactModel { models, settings } = ContactModel::of(world, true);
    let _ = writeln!(script, "pair_style gran {models}{settings}\npair_coeff * *");
    script += &walls.script;
    let format = format!("format \"%d %d{}\"", " %.15e".repeat(13));
    script += &run_lines(handed, &format);
    let way = walls.way * handed.scene.duration;
    Ok(Deck {
        deviations: deviations(handed, &walls),
        // Squares and rims that turn stay inside, and meshes that move straight on.
        domain: super::atoms_file::DomainBox {
            min: domain.min.min(-walls.reach) + way.min(DVec3::ZERO),
            max: domain.max.max(walls.reach) + way.max(DVec3::ZERO),
        },
        types: types.count(),
        script,
        meshes: walls.meshes,
    })
}

fn head(handed: Handed, boundary: &str) -> String {
    let world = handed.world;
    let smallest = (world.grains.radius.iter().copied()).fold(f64::INFINITY, f64::min);
    let moduli = || world.materials.list().iter().map(|m| m.youngs_modulus);
    let mut text = format!(
        "# {}\n# LIGGGHTS 3.8; SI units. `sh run.sh 4` runs it on 4 processes.\n",
        handed.title
    );
    text += "atom_style granular\natom_modify map array\n";
    let _ = writeln!(text, "boundary {boundary}\nnewton off");
    text += "communicate single vel yes\nunits si\n";
    if moduli().any(|modulus| modulus < *MODULI.start()) {
        text += "soft_particles yes\n";
    }
    if moduli().any(|modulus| modulus > *MODULI.end()) {
        text += "hard_particles yes\n";
    }
    if world.container.drum_speed() != 0.0 {
        text += "processors * * 1\n";
    }
    let _ = writeln!(text, "read_data {GRAINS}");
    let _ = writeln!(text, "neighbor {:e} bin", SKIN * smallest);
    // Without, a spring outlives a gap (docs/validation.md). Bridges set a contact distance themselves.
    text += if world.wetting().is_some() {
        "neigh_modify delay 0\n"
    } else {
        "neigh_modify delay 0 contact_distance_factor 1.1\n"
    };
    text
}

/// Restitutions that are too small for it.
fn refused_pairs(world: &World) -> Vec<String> {
    let smallest = world.materials.pairs().map(|pair| pair.restitution);
    let smallest = smallest.fold(f64::INFINITY, f64::min);
    let reason = format!(
        "a restitution of {smallest} is below {LEAST_RESTITUTION}, the least that LIGGGHTS takes"
    );
    (smallest < LEAST_RESTITUTION)
        .then_some(reason)
        .into_iter()
        .collect()
}

/// Materials and how they meet, type by type.
fn materials(world: &World, types: &AtomTypes) -> String {
    let count = types.count();
    let of_types: Vec<MaterialId> = types.materials().collect();
    let wet = world.wetting().is_some();
    let single = |name: &str, key: &str, value: &dyn Fn(MaterialId) -> f64| {
        let values = numbers(of_types.iter().map(|id| value(*id)));
        format!("fix {name} all property/global {key} peratomtype {values}\n")
    };
    let pairs = |name: &str, key: &str, value: &dyn Fn(usize, usize) -> f64| {
        let all = (0..count).flat_map(|a| (0..count).map(move |b| (a, b)));
        let values = numbers(all.map(|(a, b)| value(a, b)));
        format!("fix {name} all property/global {key} peratomtypepair {count} {values}\n")
    };
    let meeting = |a: usize, b: usize| world.materials.pair(of_types[a], of_types[b]);
    let of_pair = |value: fn(&PairProperties) -> f64| move |a, b| value(&meeting(a, b));
    let mut text = single("elastic", "youngsModulus", &|id| {
        world.materials.get(id).youngs_modulus
    });
    text += &single("poisson", "poissonsRatio", &|id| {
        world.materials.get(id).poisson_ratio
    });
    text += &pairs(
        "rebound",
        "coefficientRestitution",
        &of_pair(|p| p.restitution),
    );
    let friction = if wet {
        |p: &PairProperties| p.wet_friction
    } else {
        |p: &PairProperties| p.friction
    };
    text += &pairs("slide", "coefficientFriction", &of_pair(friction));
    text += &pairs(
        "roll",
        "coefficientRollingFriction",
        &of_pair(|p| p.rolling_friction),
    );
    if world.law != ContactLaw::HertzMindlin {
        let row = |a, b| -> (Pairing, [f64; 4]) {
            let pairing = types.pairing(world, a, b);
            let constants = pairing.constants(world.law, &world.materials, wet);
            (pairing, constants.coefficients)
        };
        text += &pairs("kn", "kn", &|a, b| row(a, b).1[0]);
        text += &pairs("kt", "kt", &|a, b| row(a, b).1[2]);
        // That program multiplies dashpots by the effective mass.
        let damping = |k: usize| {
            move |a, b| {
                let (pairing, constants) = row(a, b);
                constants[k] / pairing.effective_mass
            }
        };
        text += &pairs("gamman", "gamman", &damping(1));
        text += &pairs("gammat", "gammat", &damping(3));
    }
    text
}

/// Volume of the film on a grain over the grain's own.
///
/// # Errors
/// What of the liquid it does not have, in sentences.
fn film_share(world: &World, liquid: &Liquid) -> Result<f64, Vec<String>> {
    let mut faults = Vec::new();
    let law = &liquid.law;
    let mut need = |has: bool, key: &str, what: &str| {
        if !has {
            faults.push(format!(
                "the bridges' `{key}` is not what LIGGGHTS computes ({what}); `--set bridge-law=as-coded` sets what it does"
            ));
        }
    };
    need(law.volume == BridgeVolume::ShadedCap, "volume", "ShadedCap");
    need(
        matches!(law.viscous_gap, SmallestGap::OfEffectiveRadius(_)),
        "viscous_gap",
        "OfEffectiveRadius",
    );
    need(
        law.capillary_gap == CapillaryGap::Open,
        "capillary_gap",
        "Open",
    );
    need(law.rupture == Rupture::Capped, "rupture", "Capped");
    let grains = &world.grains;
    let shares = (0..grains.len())
        .map(|i| grains.film[i] / crate::geometry::sphere_volume(grains.radius[i]));
    let (low, high) = shares.fold((f64::INFINITY, 0.0_f64), |(low, high), share| {
        (low.min(share), high.max(share))
    });
    if high - low > 1e-9 * high {
        faults.push(format!(
            "films are {low:.4} to {high:.4} of their grains' volume: LIGGGHTS begins with one share for all"
        ));
    }
    if faults.is_empty() {
        Ok(high)
    } else {
        Err(faults)
    }
}

fn liquid_properties(liquid: &Liquid, film: f64, types: usize) -> String {
    // It takes half the product of both angles, in rad²; a mean is had by the angle whose half
    // square it is.
    let angle = match liquid.law.angle {
        PairAngle::HalfProduct => liquid.contact_angle,
        PairAngle::Mean => (2.0 * liquid.contact_angle).sqrt(),
    };
    let scalar = |name: &str, key: &str, value: f64| {
        format!("fix {name} all property/global {key} scalar {value:e}\n")
    };
    let angles = numbers(std::iter::repeat_n(angle.to_degrees(), types));
    [
        scalar(
            "nearest",
            "minSeparationDistanceRatio",
            liquid.law.viscous_gap.share(),
        ),
        scalar("farthest", "maxSeparationDistanceRatio", 1.1),
        scalar("film", "surfaceLiquidContentInitial", film),
        scalar("tension", "surfaceTension", liquid.surface_tension),
        scalar("viscosity", "fluidViscosity", liquid.viscosity),
        format!("fix angle all property/global contactAngle peratomtype {angles}\n"),
    ]
    .concat()
}

fn deviations(handed: Handed, walls: &Walls) -> Vec<String> {
    let world = handed.world;
    let mut found = common_deviations(handed);
    if walls.has_rim {
        found.push(format!(
            "The rim that turns is a mesh of {FACETS} flat facets with the rim's mean radius; a grain rides over them \
             within {:.1e} m.",
            rim_radius(world).unwrap_or(0.0) * (PI / FACETS as f64).powi(2) / 2.0
        ));
    }
    if walls.meshes.iter().any(|mesh| mesh.name == MESH) {
        found.push(
            "A grain that touches a mesh at several triangles is told from one that touches it once by the program's own \
             rule (`curvature 20`); here it touches each smooth part of the mesh at one place."
                .to_owned(),
        );
    }
    for (name, edge) in &walls.squares {
        found.push(format!(
            "The wall `{name}` is a square of {edge:.3} m: planes that move or lie across the axes are meshes there, and end."
        ));
    }
    if world.materials.pairs().any(|p| p.rolling_friction > 0.0) {
        found.push(
            "Rolling friction (`cdt`) has its full torque at rest too and turns it round at each step, so that grains \
             at rest tremble; here a contact remembers its torque. With a wall that turns, the grain's whole spin \
             counts there, here its spin relative to the wall's."
                .to_owned(),
        );
    }
    if world.law != ContactLaw::HertzMindlin {
        found.push(
            "Friction is bounded by spring and dashpot of the normal force together (`hooke/stiffness`); here by the \
             spring alone."
                .to_owned(),
        );
    }
    if let Some(liquid) = world.wetting() {
        found.extend(liquid_deviations(liquid));
    }
    found
}

fn liquid_deviations(liquid: &Liquid) -> Vec<String> {
    let mut found = vec![
        "A bridge that breaks shares its liquid by the grains' volumes, and their other bridges follow the new films at \
         once; here it is shared evenly, and a bridge keeps its volume. Equal grains show neither."
            .to_owned(),
        "The drag of a bridge has no bound; here it is bounded where a step could not bear it (at the advised step, \
         next to nowhere)."
            .to_owned(),
    ];
    if liquid.law.angle == PairAngle::Mean {
        found.push(format!(
            "The contact angle is stated as {:.3}°, of which LIGGGHTS 3.8 makes the mean that is asked for \
             (it takes half the product of both, in rad²). Builds after July 2021 take the mean itself: state {:.3}° there.",
            (2.0 * liquid.contact_angle).sqrt().to_degrees(),
            liquid.contact_angle.to_degrees()
        ));
    }
    if liquid.law.coulomb != BridgeLaw::AS_CODED.coulomb {
        found.push(
            "Friction is bounded by contact and bridge together (`tangential_reduce on`)."
                .to_owned(),
        );
    }
    found
}
