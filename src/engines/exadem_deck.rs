//! A scene of polyhedra as input of exaDEM.
//!
//! In: a scene and its world at time zero. Out: the script (`.msp`, YAML), or why there can be none.
//! Shapes and bodies are files of their own ([`super::rockable_files`]). All is in kg, mm and s, so
//! that stiffnesses keep their numbers, forces are in mN and energies in µJ; in metres that program
//! takes edges of grains of millimetres for parallel ones (`|E₁|²|E₂|² − (E₁·E₂)² < 10⁻¹²`) and
//! drops their contacts without a word.

use super::atom_types::AtomTypes;
use super::deck::{DUMPS, Handed, Steps, refused_by_all, uneven_dumps};
use super::mpi_engine::PER_METRE;
use super::rockable_files::BODIES;
use crate::physics::law::{FeatureRule, Pairing};
use crate::physics::{ContactLaw, Integrator, MaterialId, PairProperties};
use crate::scene::{Scene, TimeStep};
use crate::solver::advise;
use crate::world::{Clock, Surface, World};
use glam::DVec3;
use std::fmt::Write as _;

/// What exaDEM takes beside shapes and bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct ExademDeck {
    /// The script.
    pub script: String,
    /// Its clock at time zero.
    pub clock: Clock,
    /// What is different in the engine, in sentences.
    pub deviations: Vec<String>,
}

/// Shapes that it tells apart as it is built by default, in eight bits.
const SHAPES: usize = 256;
/// Slack of its neighbour lists, in the largest radius.
const SLACK: f64 = 0.1;

/// The deck for `handed`, whose species are `types`.
///
/// # Errors
/// All that it does not have, in sentences.
pub fn exadem_deck(handed: Handed, types: &AtomTypes) -> Result<ExademDeck, Vec<String>> {
    let faults = refused(handed);
    if !faults.is_empty() {
        return Err(faults);
    }
    let clock = clock(handed);
    let script = [
        head(handed),
        input(handed.world, types),
        walls(handed.world),
        run(handed, &clock),
    ]
    .concat();
    Ok(ExademDeck {
        script,
        clock,
        deviations: deviations(handed, &clock),
    })
}

/// Its species and what they are made of.
///
/// # Errors
/// When there are too many.
pub fn types(world: &World) -> Result<AtomTypes, String> {
    AtomTypes::of(world, false)
}

/// What it does not have of `handed`.
fn refused(handed: Handed) -> Vec<String> {
    let world = handed.world;
    let mut refused = refused_by_all(handed);
    let mut refuse = |is_so: bool, reason: &str| {
        if is_so {
            refused.push(reason.to_owned());
        }
    };
    let spheres = "spheres are among its grains: exaDEM is handed polyhedra alone; `--to liggghts` and `--to lammps` \
                   compute spheres";
    let polyhedra = world.polyhedra.as_ref();
    let has_sphere = polyhedra.is_none_or(|all| all.shapes.iter().any(|s| s.faces.is_empty()));
    refuse(has_sphere, spheres);
    match world.law {
        ContactLaw::Hooke { features, .. } => refuse(
            features == FeatureRule::Shared,
            "the features of a pair share its stiffness: exaDEM gives each the whole one; `features: Full` does so too",
        ),
        _ => refuse(true, "its law is not `Hooke`, the one that exaDEM has"),
    }
    refuse(
        world.liquid.is_some(),
        "it has liquid, which exaDEM has none of",
    );
    refuse(
        world.clock.step > 0,
        "it is no state at time zero: exaDEM reads no springs of contacts",
    );
    for wall in &world.container.walls {
        let is_plane = matches!(wall.surface, Surface::Plane { .. });
        let moves = wall.motion.velocity != DVec3::ZERO || wall.motion.spin != DVec3::ZERO;
        // Tubes are refused for all engines.
        if !is_plane && !matches!(wall.surface, Surface::Tube { .. }) || is_plane && moves {
            refused.push(format!(
                "the wall `{}` is no plane at rest: columns, boxes and planes at rest are handed to exaDEM (`--to liggghts` \
                 takes meshes)",
                wall.name
            ));
        }
    }
    refused
}

/// What an integrator takes implicitly, as the beginning of a sentence.
fn what_is_implicit(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::Explicit => "All forces are",
        Integrator::Implicit => "Springs and dashpots are",
    }
}

/// The engine's clock: its step is the scene's, or shorter where that is one for implicit springs
/// and dashpots.
fn clock(handed: Handed) -> Clock {
    let stated = handed.world.clock.time_step;
    if handed.world.integrator().is_explicit() {
        return Clock::new(stated);
    }
    let explicit = Scene {
        integrator: Integrator::Explicit,
        time_step: TimeStep::Automatic,
        ..handed.scene.clone()
    };
    Clock::new(stated.min(advise(&explicit).time_step))
}

fn head(handed: Handed) -> String {
    format!(
        "# {}\n# exaDEM, later than 1.2.2 (with groups); kg, mm, s: forces in mN, energies in µJ. `sh run.sh 4` runs it \
         on 4 processes.\ngrid_flavor: grid_flavor_dem\n\nincludes:\n  - config_polyhedra.msp\n\n",
        handed.title
    )
}

/// Bodies, and how species meet each other and the walls: every pair stands there.
fn input(world: &World, types: &AtomTypes) -> String {
    let largest = largest_radius(world);
    let mut text = format!(
        "input_data:\n  - read_conf_rockable:\n     filename: {BODIES}\n     enlarge_bounds: {:e}\n",
        2.0 * largest
    );
    let groups: Vec<MaterialId> = types.grains.iter().map(|kind| kind.material).collect();
    let pairs: Vec<[usize; 2]> = (0..groups.len())
        .flat_map(|a| (a..groups.len()).map(move |b| [a, b]))
        .collect();
    let among = pairs.iter().map(|[a, b]| (groups[*a], groups[*b]));
    text += "  - multimat_contact_params:\n";
    text += &list("group1", pairs.iter().map(|[a, _]| a));
    text += &list("group2", pairs.iter().map(|[_, b]| b));
    text += &contact_lists(world, among);
    let at_walls: Vec<[usize; 2]> = (0..groups.len())
        .flat_map(|a| (0..world.container.walls.len()).map(move |wall| [a, wall]))
        .collect();
    if at_walls.is_empty() {
        return text + "\n";
    }
    let with_walls = at_walls
        .iter()
        .map(|[a, wall]| (groups[*a], world.container.walls[*wall].material));
    text += "  - drivers_contact_params:\n";
    text += &list("group", at_walls.iter().map(|[a, _]| a));
    text += &list("driver_id", at_walls.iter().map(|[_, wall]| wall));
    text += &contact_lists(world, with_walls);
    text + "\n"
}

/// The laws of contacts between these materials.
fn contact_lists(world: &World, between: impl Iterator<Item = (MaterialId, MaterialId)>) -> String {
    let mut columns: [Vec<f64>; 4] = Default::default();
    for materials in between {
        // Of a unit mass, which is what the share of the critical dashpot does not depend on.
        let pairing = Pairing {
            effective_radius: 1.0,
            effective_mass: 1.0,
            radii: (1.0, 0.0),
            materials,
        };
        let constants = pairing.constants(world.law, &world.materials, false);
        let [stiffness, damping, tangential, _] = constants.coefficients;
        let PairProperties { friction, .. } = world.materials.pair(materials.0, materials.1);
        let row = [
            stiffness,
            tangential,
            friction,
            damping / (2.0 * stiffness.sqrt()),
        ];
        for (column, value) in columns.iter_mut().zip(row) {
            column.push(value);
        }
    }
    let [normal, tangential, friction, damping] = &columns;
    let number =
        |column: &[f64]| -> Vec<String> { column.iter().map(|x| format!("{x:e}")).collect() };
    [
        list("kn", number(normal)),
        list("kt", number(tangential)),
        list("kr", normal.iter().map(|_| "0.0")),
        list("mu", number(friction)),
        list("damprate", number(damping)),
    ]
    .concat()
}

/// A key and its values.
fn list<T: ToString>(key: &str, values: impl IntoIterator<Item = T>) -> String {
    let words: Vec<String> = values.into_iter().map(|value| value.to_string()).collect();
    format!("     {key}: [{}]\n", words.join(", "))
}

/// Walls as surfaces at rest, numbered as they are here.
fn walls(world: &World) -> String {
    let planes = world
        .container
        .walls
        .iter()
        .filter_map(|wall| match wall.surface {
            Surface::Plane { point, normal } => Some((point.dot(normal), normal)),
            Surface::Cylinder { .. } | Surface::Tube { .. } | Surface::Mesh(_) => None,
        });
    let mut text = String::new();
    for (id, (offset, normal)) in planes.enumerate() {
        let _ = write!(
            text,
            "  - register_surface:\n     id: {id}\n     state: {{offset: {:e}, normal: {}}}\n     params: {{ motion_type: \
             STATIONARY }}\n",
            zeroed(PER_METRE * offset),
            vector(normal)
        );
    }
    if text.is_empty() {
        return text;
    }
    format!("setup_drivers:\n{text}\n")
}

/// Forces, dumps and steps.
fn run(handed: Handed, clock: &Clock) -> String {
    let largest = largest_radius(handed.world);
    let Steps { run, output } = Steps::of(handed.scene, clock);
    format!(
        "compute_force:\n  - gravity_force:\n     gravity: {}\n  - contact_multimat_polyhedron:\n     symetric: true\n\n\
         domain:\n  cell_size: {:e}\n  periodic: [false, false, false]\n  expandable: true\n\n\
         dump_data_xyz:\n  - timestep_file: \"{DUMPS}/grains_%012d.xyz\"\n  - write_xyz:\n     fields: [ velocity, id, \
         radius, orient, vrot ]\n\n\
         iteration_dump_writer:\n  - dump_data_xyz\n\nfinal_dump: nop\n\n\
         global:\n  simulation_dump_frequency: {output}\n  simulation_end_iteration: {run}\n  simulation_log_frequency: \
         {output}\n  simulation_paraview_frequency: -1\n  dt: {:e} s\n  rcut_inc: {:e}\n",
        vector(PER_METRE * handed.world.gravity),
        (2.0 + 2.0 * SLACK) * largest,
        clock.time_step,
        SLACK * largest,
    )
}

/// Largest distance of a grain's surface from its centroid [mm].
fn largest_radius(world: &World) -> f64 {
    PER_METRE * world.grains.radius.iter().copied().fold(0.0, f64::max)
}

fn vector(vector: DVec3) -> String {
    let [x, y, z] = vector.to_array().map(zeroed);
    format!("[{x:e}, {y:e}, {z:e}]")
}

/// `-0` as 0.
fn zeroed(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x }
}

fn deviations(handed: Handed, clock: &Clock) -> Vec<String> {
    let world = handed.world;
    let mut found: Vec<String> = [
        "Lengths are in mm, masses in kg, times in s, there and in its output: forces in mN, energies in µJ. In metres \
         its test for parallel edges would drop contacts between edges without a word; edges that are nearly parallel \
         are dropped in mm too, where |E₁|²|E₂|² − (E₁·E₂)² is below 10⁻¹² mm⁴.",
        "Features that can touch are vertex and vertex, vertex and edge, edge and edge, vertex and face, each only where \
         the nearest points lie inside of edges and faces; here vertex and face, edge and edge, with nearest points that \
         may lie on an outline or an end. Where features pass each other's ends, a pair gains and loses springs at other \
         places.",
        "A contact's tangential spring stays as it is when the normal turns: it is neither turned with it nor projected. \
         Here it turns with the grains.",
        "Walls act on both sides: a vertex whose rounding has gone through whole is pushed on, not back.",
        "Orientations are turned by steps of first order and normalised; here the angular momentum is kept to second \
         order.",
        "In the first step forces stand in the place of accelerations, so that grains begin to fall half a step late.",
        "Its output states eleven digits and no contacts, the first of it after one interval.",
    ]
    .map(str::to_owned)
    .into();
    if !world.integrator().is_explicit() {
        found.push(format!(
            "{} explicit, here implicit (`integrator: {:?}`): its step is {:e} s, here {:e} s.",
            what_is_implicit(world.integrator()),
            world.integrator(),
            clock.time_step,
            world.clock.time_step
        ));
    }
    let shapes = world.polyhedra.as_ref().map_or(0, |all| all.shapes.len());
    if shapes > SHAPES {
        found.push(format!(
            "As it is built by default it tells {SHAPES} shapes apart, and takes the others of these {shapes} for the first \
             ones without a word: exaNBody is to be built with -DXNB_PARTICLE_TYPE_INT=uint32_t. An import finds it out."
        ));
    }
    found.extend(uneven_dumps(handed.scene, clock));
    found
}
