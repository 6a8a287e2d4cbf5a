//! A scene as an input script of LIGGGHTS 3.8.
//!
//! In: a scene and its world at time zero. Out: a [`Deck`], or why there can be none. Walls at rest
//! along the axes are primitive walls, those that turn or move are meshes. Of bridges there is what
//! that program computes, [`BridgeLaw::AS_CODED`] with its free settings; other choices are
//! refused.

use super::atom_types::AtomTypes;
use super::deck::{
    DUMPS, Deck, GRAINS, Handed, Steps, common_deviations, domain, numbers, refused, wall_name,
    words,
};
use super::wall_mesh::WallMesh;
use crate::physics::law::Pairing;
use crate::physics::{
    BridgeLaw, BridgeVolume, CapillaryGap, ContactLaw, CoulombBound, Liquid, MaterialId, PairAngle,
    PairProperties, Rupture, SmallestGap,
};
use crate::world::{Surface, Wall, World};
use glam::DVec3;
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Flat facets of a rim that turns.
const FACETS: usize = 360;
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
    script += &tail(handed);
    Ok(Deck {
        deviations: deviations(handed, &walls),
        // Squares and rims that turn stay inside.
        domain: super::atoms_file::DomainBox {
            min: domain.min.min(-walls.reach),
            max: domain.max.max(walls.reach),
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

/// The words of a contact's model.
struct ContactModel {
    /// Which models.
    models: String,
    /// Their settings, which stand behind everything else.
    settings: String,
}

impl ContactModel {
    /// Of grains, where there may be bridges, or with walls, which hold none.
    fn of(world: &World, of_grains: bool) -> Self {
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

/// The walls of a script.
struct Walls {
    script: String,
    meshes: Vec<WallMesh>,
    /// How far meshes reach from the origin [m].
    reach: DVec3,
    has_rim: bool,
    squares: Vec<(String, f64)>,
}

impl Walls {
    fn of(world: &World, types: &AtomTypes, half_edge: f64) -> Self {
        let ContactModel { models, settings } = ContactModel::of(world, false);
        let mut walls = Self {
            script: String::new(),
            meshes: Vec::new(),
            reach: DVec3::ZERO,
            has_rim: false,
            squares: Vec::new(),
        };
        let mut meshes = Vec::new();
        for (index, wall) in world.container.walls.iter().enumerate() {
            let name = wall_name(wall, index);
            let kind = types.of_wall(wall.material);
            if let Some(primitive) = primitive(wall) {
                let _ = writeln!(
                    walls.script,
                    "fix {name} all wall/gran {models} primitive type {kind} {primitive}{settings}"
                );
            } else if let Some(mesh) = walls.mesh(world, wall, &name, half_edge) {
                let belt = belt(wall);
                let _ = writeln!(
                    walls.script,
                    "fix {name} all mesh/surface file {name}.stl type {kind} curvature 2{belt}"
                );
                walls.turn(wall, &name);
                walls.meshes.push(mesh);
                meshes.push(name);
            }
        }
        if !meshes.is_empty() {
            let _ = writeln!(
                walls.script,
                "fix walls all wall/gran {models} mesh n_meshes {} meshes {}{settings}",
                meshes.len(),
                meshes.join(" ")
            );
        }
        walls
    }

    /// The mesh of a wall.
    fn mesh(&mut self, world: &World, wall: &Wall, name: &str, half_edge: f64) -> Option<WallMesh> {
        let mesh = match wall.surface {
            Surface::Cylinder { radius } => {
                let half_width = half_width(world) * 1.001;
                self.has_rim = true;
                WallMesh::rim(name, radius, half_width, FACETS)
            }
            Surface::Plane { point, normal } if wall.motion.spin != DVec3::ZERO => {
                // A plate that turns with a rim: a square round it.
                let radius = rim_radius(world).unwrap_or(half_edge);
                WallMesh::square(name, point, normal, 1.01 * radius)
            }
            Surface::Plane { point, normal } => {
                self.squares.push((wall.name.clone(), 2.0 * half_edge));
                WallMesh::square(name, point, normal, half_edge)
            }
            Surface::Tube { .. } => return None,
        };
        let turns = wall.motion.spin != DVec3::ZERO;
        for corner in mesh.triangles().iter().flatten() {
            let mut far = corner.abs();
            if turns {
                let from_axis = far.x.hypot(far.y);
                (far.x, far.y) = (from_axis, from_axis);
            }
            self.reach = self.reach.max(1.01 * far);
        }
        Some(mesh)
    }

    /// Lets the mesh of `wall` turn.
    fn turn(&mut self, wall: &Wall, name: &str) {
        let spin = wall.motion.spin;
        if spin == DVec3::ZERO {
            return;
        }
        let _ = writeln!(
            self.script,
            "fix turn_{name} all move/mesh mesh {name} rotate origin 0 0 0 axis {} period {:e}",
            words(spin.normalize()),
            2.0 * PI / spin.length()
        );
    }
}

/// A wall at rest along the axes, as scripts have it.
fn primitive(wall: &Wall) -> Option<String> {
    if wall.motion.spin != DVec3::ZERO || wall.motion.velocity != DVec3::ZERO {
        return None;
    }
    match wall.surface {
        Surface::Cylinder { radius } => Some(format!("zcylinder {radius:e} 0 0")),
        Surface::Plane { point, normal } => {
            let axes = [
                ("xplane", DVec3::X),
                ("yplane", DVec3::Y),
                ("zplane", DVec3::Z),
            ];
            let found = axes.into_iter().find(|(_, axis)| normal.abs() == *axis);
            found.map(|(word, axis)| format!("{word} {:e}", point.dot(axis)))
        }
        Surface::Tube { .. } => None,
    }
}

/// The words for a surface that moves along itself, as a belt does.
fn belt(wall: &Wall) -> String {
    if wall.motion.velocity == DVec3::ZERO {
        return String::new();
    }
    format!(" surface_vel {}", words(wall.motion.velocity))
}

fn rim_radius(world: &World) -> Option<f64> {
    let mut walls = world.container.walls.iter();
    walls.find_map(|wall| match wall.surface {
        Surface::Cylinder { radius } => Some(radius),
        _ => None,
    })
}

fn half_width(world: &World) -> f64 {
    match world.container.shape {
        crate::world::Shape::Drum { width, .. } => 0.5 * width,
        _ => 1.0,
    }
}

fn tail(handed: Handed) -> String {
    let world = handed.world;
    let steps = Steps::of(handed);
    let mut text = format!(
        "timestep {:e}\nfix motion all nve/sphere\n",
        world.clock.time_step
    );
    if let Some(down) = world.gravity.try_normalize() {
        let _ = writeln!(
            text,
            "fix weight all gravity {:e} vector {}",
            world.gravity.length(),
            words(down)
        );
    }
    let _ = writeln!(
        text,
        "dump grains all custom {} {DUMPS}/grains_*.dump id type x y z vx vy vz omegax omegay omegaz radius fx fy fz",
        steps.output
    );
    let _ = writeln!(
        text,
        "dump_modify grains sort id pad 12 format \"%d %d{}\"",
        " %.15e".repeat(13)
    );
    text += "thermo_style custom step atoms ke cpu\nthermo_modify norm no lost error\n";
    let _ = writeln!(text, "thermo {}\nrun {}", steps.output, steps.run);
    text
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
