//! What a scene becomes for an engine: a script, meshes, and what is different there.
//!
//! In: a scene and its world at time zero. Out: what both engines' scripts have in common: the box
//! round the grains, the steps, what is refused for either. Lengths, masses and times are in SI
//! units.

use super::atoms_file::DomainBox;
use super::wall_mesh::WallMesh;
use crate::scene::{Scene, TimeStep};
use crate::world::{Clock, MeshWall, Shape, Surface, Wall, World};
use glam::DVec3;
use std::fmt::Write as _;

/// The data file's name.
pub const GRAINS: &str = "grains.data";
/// The folder that the engine writes its dumps to.
pub const DUMPS: &str = "dumps";

/// What is handed over: a scene and the state that it begins with.
#[derive(Clone, Copy)]
pub struct Handed<'a> {
    /// What it is called, for the first line of files.
    pub title: &'a str,
    /// The scene.
    pub scene: &'a Scene,
    /// Its world at time zero.
    pub world: &'a World,
    /// Whether the grains of a filling have come to rest in it.
    pub is_settled: bool,
}

/// What an engine takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Deck {
    /// The script.
    pub script: String,
    /// Meshes of walls.
    pub meshes: Vec<WallMesh>,
    /// The box round it all.
    pub domain: DomainBox,
    /// Types that the engine's coefficients are stated for.
    pub types: usize,
    /// What is different in the engine, in sentences.
    pub deviations: Vec<String>,
}

/// How a run is divided into steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Steps {
    /// Steps of the whole run, a whole number of outputs.
    pub run: u64,
    /// Steps between two dumps.
    pub output: u64,
}

impl Steps {
    /// Those of `scene` by this `clock`.
    pub fn of(scene: &Scene, clock: &Clock) -> Self {
        let output = clock.step_at(scene.output_interval).max(1);
        let run = clock.step_at(scene.duration).max(1);
        Self {
            run: run.div_ceil(output).saturating_mul(output),
            output,
        }
    }
}

/// The end of a script: the step, gravity, dumps of the grains, written as `format` says, and the
/// run.
pub fn run_lines(handed: Handed, format: &str) -> String {
    let world = handed.world;
    let steps = Steps::of(handed.scene, &world.clock);
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
    let Steps { run, output } = steps;
    text + &format!(
        "dump grains all custom {output} {DUMPS}/grains_*.dump id type x y z vx vy vz omegax omegay omegaz radius fx fy fz\n\
         dump_modify grains sort id pad 12 {format}\n\
         thermo_style custom step atoms ke cpu\nthermo_modify norm no lost error\n\
         thermo {output}\nrun {run}\n"
    )
}

/// What engines of spheres cannot take of `handed`, in sentences.
pub fn refused(handed: Handed) -> Vec<String> {
    let mut refused = refused_by_all(handed);
    if handed.world.polyhedra.is_some() {
        let reason = "its grains are polyhedra: this engine computes spheres; `--to exadem` computes polyhedra";
        refused.insert(0, reason.to_owned());
    }
    refused
}

/// What no engine can take of `handed`, in sentences.
pub fn refused_by_all(handed: Handed) -> Vec<String> {
    let Handed { scene, world, .. } = handed;
    let mut refused = Vec::new();
    if scene.time_step == TimeStep::Following {
        refused.push(
            "its time step follows its limit: the engine's is fixed; `--time-step automatic` or a time fixes it"
                .to_owned(),
        );
    }
    for wall in &world.container.walls {
        if let Surface::Tube { .. } = wall.surface {
            refused.push(format!(
                "the wall `{}` is a rising tube, which the engine does not have",
                wall.name
            ));
        }
        if let Surface::Plane { normal, .. } = wall.surface
            && wall.motion.velocity.dot(normal).abs() > 1e-12 * wall.motion.velocity.length()
        {
            refused.push(format!(
                "the wall `{}` moves along its normal, which is not handed over",
                wall.name
            ));
        }
    }
    refused
}

/// What is different in both engines.
pub fn common_deviations(handed: Handed) -> Vec<String> {
    let (scene, world) = (handed.scene, handed.world);
    let mut found = Vec::new();
    if !handed.is_settled {
        found.push(
            "The grains begin where the filling places them, apart from each other and at rest: they fall first, while \
             walls move already. Here a bed settles before time zero."
                .to_owned(),
        );
    }
    let touching = world.contacts.iter().filter(|c| c.touching).count();
    if touching > 0 {
        found.push(format!(
            "Contacts begin without tangential springs and rolling torques: neither engine reads them from a file. \
             {touching} contacts have them here; there, grains sink by some micrometres until they have their own."
        ));
    }
    found.push(
        "A contact's tangential spring follows its normal but does not turn about it, and the slip of a step is \
         taken with the normal of its end: a bed that turns as one body works against its own springs there \
         (docs/validation.md)."
            .to_owned(),
    );
    found.extend(uneven_dumps(scene, &world.clock));
    found
}

/// That outputs are no whole number of steps of `clock` apart, where that is so.
pub fn uneven_dumps(scene: &Scene, clock: &Clock) -> Option<String> {
    let steps = Steps::of(scene, clock);
    let output = steps.output as f64 * clock.time_step;
    let is_uneven = (output / scene.output_interval - 1.0).abs() > 1e-9;
    is_uneven.then(|| {
        format!(
            "Dumps are {} steps, {output:e} s, apart, no whole number of steps being {:e} s.",
            steps.output, scene.output_interval
        )
    })
}

/// The box round walls and grains, wide enough for squares and drums that turn, and how it ends:
/// `f` where nothing can leave it, else `m`, which follows the grains.
pub fn domain(world: &World) -> (DomainBox, &'static str) {
    let largest = world.grains.radius.iter().copied().fold(0.0, f64::max);
    let (min, max, boundary) = match world.container.shape {
        Shape::Drum { radius, width } => {
            let corner = DVec3::new(radius, radius, 0.5 * width);
            (-corner, corner, "f f f")
        }
        Shape::Box { min, max } => (min, max, "f f f"),
        Shape::Mesh { .. } => {
            let (min, max) = extent(world);
            (min, max, "f f f")
        }
        Shape::Planes | Shape::Column { .. } => {
            let (min, max) = extent(world);
            (min, max, "m m m")
        }
    };
    let reach = if boundary == "f f f" {
        2.0 * largest
    } else {
        0.5 * (max - min).length() + 4.0 * largest
    };
    let domain = DomainBox {
        min: min - reach,
        max: max + reach,
    };
    (domain, boundary)
}

/// The box round the grains, the points of planes and the corners of meshes [m].
fn extent(world: &World) -> (DVec3, DVec3) {
    let grains = world.grains.position.iter().zip(world.grains.radius.iter());
    let of_grains = grains.flat_map(|(x, r)| [*x - *r, *x + *r]);
    let points = world.container.walls.iter().filter_map(Wall::point);
    let meshes = world.container.walls.iter().filter_map(Wall::mesh);
    let corners = meshes.flat_map(MeshWall::triangles).flatten();
    let mut all = of_grains.chain(points).chain(corners);
    let first = all.next().unwrap_or(DVec3::ZERO);
    all.fold((first, first), |(low, high), x| (low.min(x), high.max(x)))
}

impl Wall {
    /// The point that its plane is given by [m]; none of other walls.
    fn point(&self) -> Option<DVec3> {
        match self.surface {
            Surface::Plane { point, .. } => Some(point),
            Surface::Cylinder { .. } | Surface::Tube { .. } | Surface::Mesh(_) => None,
        }
    }

    /// The part of a mesh that it is; none of other walls.
    pub(super) fn mesh(&self) -> Option<&MeshWall> {
        match &self.surface {
            Surface::Mesh(mesh) => Some(mesh),
            _ => None,
        }
    }
}

/// A name of a wall that an engine's scripts can hold: `front_plate`, and its number where it has
/// no letters.
pub fn wall_name(wall: &Wall, index: usize) -> String {
    let letters = wall.name.chars().map(|c| match c {
        c if c.is_ascii_alphanumeric() => c,
        _ => '_',
    });
    format!("{}_{}", letters.take(24).collect::<String>(), index + 1)
}

/// `x y z` as scripts have them.
pub fn words(vector: DVec3) -> String {
    let [x, y, z] = vector.to_array().map(|x| if x == 0.0 { 0.0 } else { x });
    format!("{x:e} {y:e} {z:e}")
}

/// Numbers as scripts have them, one behind the other.
pub fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    let words: Vec<String> = values.into_iter().map(|x| format!("{x:e}")).collect();
    words.join(" ")
}
