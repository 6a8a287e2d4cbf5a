//! From a scene to the world it starts with: grains placed without overlap, nothing settled yet.
//!
//! In: a checked scene. Out: its world at time zero. A filling of spheres is put on the scene's
//! lattice from below: which size stands where, how far each grain is off its site and which
//! species it is of come from the seed. Voronoi cells come from [`Packing`]; only their species are
//! chosen here. The walls come from `walls`.

use super::mixture::{assign_species, labelled, random};
use super::walls::{container, material_id};
use super::{
    Clock, Grains, Ledger, Packing, PlacedPolyhedron, Polyhedra, Polyhedron, Rounded, Species,
    SpeciesId, World,
};
use crate::physics::{Material, Materials, PairProperties};
use crate::scene::{
    Lattice, Scene, SceneCells, SceneGrain, SceneGrains, SceneMaterial, SceneShape, SceneSpecies,
    SizeClass, size_classes, species_counts,
};
use glam::{DQuat, DVec3};
use rand::RngExt;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use std::collections::HashMap;

/// How far a grain may be off its site, in parts of the free width round it; below one half
/// neighbours cannot touch.
const JITTER: f64 = 0.45;
/// Random stream of the places of the grains.
const PLACES: u64 = 1;

/// The world that `scene` asks for at time zero, with steps of `time_step` [s]. The scene is one
/// that was parsed, or that [`Scene::check`] passed; of any other, what does not fit is left out.
///
/// ```
/// use grainfall::{scene::Scene, solver, world};
///
/// let scene = Scene::open("bouncing-grain")?;
/// let advice = solver::advise(&scene);
/// let world = world::build(&scene, advice.time_step);
/// assert_eq!((world.grains.len(), world.time()), (scene.grain_count(), 0.0));
/// # Ok::<(), grainfall::scene::SceneError>(())
/// ```
pub fn build(scene: &Scene, time_step: f64) -> World {
    let cells = Packing::new(scene).map_or_else(|| stored_cells(scene), Packing::finish);
    build_packed(scene, time_step, cells)
}

/// The grains that come from a file.
fn stored_cells(scene: &Scene) -> Vec<Rounded> {
    let stored = scene.stored_cells();
    stored.map_or(Vec::new(), |cells| cells.grains().to_vec())
}

/// As [`build`], with the grains `cells` that a [`Packing`] of the scene made where its grains are
/// Voronoi cells.
pub fn build_packed(scene: &Scene, time_step: f64, cells: Vec<Rounded>) -> World {
    let (grains, polyhedra) = match &scene.grains {
        SceneGrains::Fill { count, species, .. } => (fill(scene, *count, species), None),
        SceneGrains::Voronoi(wanted) => packed(scene, wanted, cells),
        SceneGrains::List(list) => listed(scene, list),
    };
    let mut world = World {
        grains,
        polyhedra: polyhedra.map(|polyhedra| {
            Box::new(Polyhedra {
                integrator: scene.integrator,
                ..polyhedra
            })
        }),
        ..build_without_grains(scene, time_step)
    };
    world.spread_liquid();
    if let SceneGrains::List(list) = &scene.grains {
        for (film, grain) in world.grains.film.iter_mut().zip(list) {
            *film = grain.film.unwrap_or(*film);
        }
    }
    world.ledger = Ledger::starting_at(world.kinetic_energy(), world.potential_energy());
    world
}

/// The same with room for grains and none in it: what is around them.
pub fn build_without_grains(scene: &Scene, time_step: f64) -> World {
    let polyhedra = Polyhedra {
        integrator: scene.integrator,
        ..Polyhedra::default()
    };
    World {
        clock: Clock::new(time_step),
        grains: Grains::default(),
        species: species(scene),
        materials: materials(scene),
        container: container(scene),
        gravity: scene.gravity,
        liquid: scene.liquid,
        law: scene.law,
        contacts: Vec::new(),
        polyhedra: scene.is_polyhedral().then(|| Box::new(polyhedra)),
        ledger: Ledger::default(),
    }
}

/// What kinds of grain there are: of a list one for each material that a grain is made of, in the
/// order of the materials.
fn species(scene: &Scene) -> Vec<Species> {
    let kind = |name: &str, material: &str| Species {
        name: name.to_owned(),
        material: material_id(scene, material),
    };
    match &scene.grains {
        SceneGrains::Fill { species, .. } => {
            let species = species.iter();
            species.map(|own| kind(&own.name, &own.material)).collect()
        }
        SceneGrains::Voronoi(wanted) => {
            let species = wanted.species.iter();
            species.map(|own| kind(&own.name, &own.material)).collect()
        }
        SceneGrains::List(list) => {
            let used = |name: &str| list.iter().any(|grain| grain.material == name);
            let materials = scene.materials.iter().filter(|m| used(&m.name));
            materials.map(|own| kind(&own.name, &own.name)).collect()
        }
    }
}

/// The materials of `scene` in its order, and how each pair of them meets.
pub fn materials(scene: &Scene) -> Materials {
    let list = scene.materials.iter().map(material).collect();
    Materials::new(list, |a, b| {
        let [a, b] = [a, b].map(|id| &scene.materials[usize::from(id.0)]);
        pair_properties(scene, a, b)
    })
}

fn material(material: &SceneMaterial) -> Material {
    Material {
        name: material.name.clone(),
        youngs_modulus: material.youngs_modulus,
        poisson_ratio: material.poisson_ratio,
        density: material.density,
    }
}

/// How `a` and `b` meet: as the scene says for this pair, else by the mixing rule.
fn pair_properties(scene: &Scene, a: &SceneMaterial, b: &SceneMaterial) -> PairProperties {
    let mixed = PairProperties::mixed(&among_itself(a), &among_itself(b));
    let mut pairs = scene.pairs.iter();
    let Some(given) = pairs.find(|pair| pair.is_between(&a.name, &b.name)) else {
        return mixed;
    };
    PairProperties {
        restitution: given.restitution.unwrap_or(mixed.restitution),
        friction: given.friction.unwrap_or(mixed.friction),
        wet_friction: given
            .wet_friction
            .or(given.friction)
            .unwrap_or(mixed.wet_friction),
        rolling_friction: given.rolling_friction.unwrap_or(mixed.rolling_friction),
    }
}

/// How bodies of one material meet.
fn among_itself(material: &SceneMaterial) -> PairProperties {
    PairProperties {
        restitution: material.restitution,
        friction: material.friction,
        wet_friction: material.wet_friction.unwrap_or(material.friction),
        rolling_friction: material.rolling_friction,
    }
}

/// The grains of a list.
fn listed(scene: &Scene, list: &[SceneGrain]) -> (Grains, Option<Polyhedra>) {
    let species = species(scene);
    let label = |grain: &SceneGrain| {
        let made_of = |kind: &Species| kind.name == grain.material;
        SpeciesId(species.iter().position(made_of).unwrap_or(0) as u16)
    };
    if scene.is_polyhedral() {
        let (grains, polyhedra) = listed_polyhedra(scene, list, label);
        (grains, Some(polyhedra))
    } else {
        (listed_spheres(scene, list, label), None)
    }
}

fn listed_spheres(
    scene: &Scene,
    list: &[SceneGrain],
    label: impl Fn(&SceneGrain) -> SpeciesId,
) -> Grains {
    let mut grains = Grains::default();
    for grain in list {
        let place = grains.len();
        let density = density(scene, &grain.material);
        grains.push_sphere(grain.position, grain.radius, density, label(grain));
        grains.velocity[place] = grain.velocity;
        grains.spin[place] = grain.spin;
    }
    grains
}

/// The grains of a list in which some are polyhedra; equal grains share a shape.
fn listed_polyhedra(
    scene: &Scene,
    list: &[SceneGrain],
    label: impl Fn(&SceneGrain) -> SpeciesId,
) -> (Grains, Polyhedra) {
    let mut known: HashMap<Vec<u8>, u32> = HashMap::new();
    let mut shapes: Vec<(Polyhedron, DQuat)> = Vec::new();
    let mut bodies = Vec::new();
    for grain in list {
        let mut next = || {
            shapes.push(shape_of(grain));
            (shapes.len() - 1) as u32
        };
        let shape = match postcard::to_stdvec(&(&grain.shape, grain.radius)) {
            Ok(key) => *known.entry(key).or_insert_with(next),
            // What has no key is alike to none.
            Err(_) => next(),
        };
        bodies.push(PlacedPolyhedron {
            shape,
            position: grain.position,
            orientation: (grain.orientation * shapes[shape as usize].1).normalize(),
            velocity: grain.velocity,
            spin: grain.spin,
            density: density(scene, &grain.material),
            species: label(grain),
        });
    }
    let shapes: Vec<Polyhedron> = shapes.into_iter().map(|(shape, _)| shape).collect();
    placed(shapes, &bodies)
}

/// The shape of a listed grain, and the rotation from its body axes to the axes that the scene gave
/// it in.
fn shape_of(grain: &SceneGrain) -> (Polyhedron, DQuat) {
    let rounding = grain.shape.rounding().unwrap_or(0.0);
    if let SceneShape::Core {
        volume, gyration, ..
    } = grain.shape
        && let Some(core) = grain.shape.core()
    {
        let shape = Polyhedron::of_core(core, rounding, volume, gyration);
        return (shape, DQuat::IDENTITY);
    }
    let rounded = grain
        .shape
        .solid()
        .and_then(|solid| Polyhedron::rounded(&solid, rounding).ok());
    rounded.map_or_else(
        || (Polyhedron::sphere(grain.radius), DQuat::IDENTITY),
        |rounded| (rounded.shape, rounded.orientation),
    )
}

/// Voronoi cells as grains, each with a species of its own choice but exact in number.
fn packed(scene: &Scene, wanted: &SceneCells, cells: Vec<Rounded>) -> (Grains, Option<Polyhedra>) {
    let shares: Vec<f64> = wanted.species.iter().map(|kind| kind.share).collect();
    let everyone: Vec<usize> = (0..cells.len()).collect();
    let counts = species_counts(cells.len(), &shares);
    let mut labels = vec![SpeciesId(0); cells.len()];
    for (grain, label) in labelled(scene.seed, &everyone, &counts) {
        labels[grain] = label;
    }
    let densities: Vec<f64> = wanted
        .species
        .iter()
        .map(|kind| density(scene, &kind.material))
        .collect();
    let bodies: Vec<PlacedPolyhedron> = cells
        .iter()
        .zip(labels)
        .enumerate()
        .map(|(index, (cell, species))| PlacedPolyhedron {
            shape: index as u32,
            position: cell.position,
            orientation: cell.orientation,
            velocity: DVec3::ZERO,
            spin: DVec3::ZERO,
            density: densities[usize::from(species.0)],
            species,
        })
        .collect();
    let shapes: Vec<Polyhedron> = cells.into_iter().map(|cell| cell.shape).collect();
    let (grains, polyhedra) = placed(shapes, &bodies);
    (grains, Some(polyhedra))
}

fn placed(shapes: Vec<Polyhedron>, bodies: &[PlacedPolyhedron]) -> (Grains, Polyhedra) {
    let mut grains = Grains::default();
    let mut polyhedra = Polyhedra::new(shapes);
    for body in bodies {
        polyhedra.push(&mut grains, body);
    }
    (grains, polyhedra)
}

/// Density of the material called `name` [kg/m³].
fn density(scene: &Scene, name: &str) -> f64 {
    scene.material(name).map_or(0.0, |m| m.1.density)
}

/// The container filled from below.
fn fill(scene: &Scene, count: usize, kinds: &[SceneSpecies]) -> Grains {
    let classes = size_classes(count, kinds);
    let places = places(scene, &classes);
    let class_of: Vec<usize> = places.iter().map(|place| place.class).collect();
    let labels = assign_species(scene.seed, &classes, &class_of);
    let mut grains = Grains::default();
    for (place, label) in places.iter().zip(labels) {
        let kind = &kinds[usize::from(label.0)];
        let density = density(scene, &kind.material);
        grains.push_sphere(place.position, kind.radius, density, label);
    }
    grains
}

/// Where a grain of a filling begins.
struct FillingSite {
    position: DVec3,
    class: usize,
}

/// Places for all grains of `classes`, cell by cell from below, so that grains near in number are
/// near in space.
fn places(scene: &Scene, classes: &[SizeClass]) -> Vec<FillingSite> {
    let Some(lattice) = Lattice::for_filling(&scene.container, classes) else {
        return Vec::new();
    };
    let mut rng = random(scene.seed, PLACES);
    let mut left: Vec<usize> = classes.iter().map(|class| class.count).collect();
    let mut places = Vec::new();
    for (cell, class) in lattice
        .cells()
        .zip(shuffled_blocks(&lattice, classes, &mut rng))
    {
        let size = lattice.cell / lattice.divisions[class] as f64;
        let room = size - DVec3::splat(2.0 * classes[class].radius);
        let take = lattice.block(class).min(left[class]);
        left[class] -= take;
        for site in block(lattice.divisions[class]).take(take) {
            let corner = cell - 0.5 * lattice.cell;
            let position = corner + (site + DVec3::splat(0.5)) * size + jitter(&mut rng, room);
            places.push(FillingSite { position, class });
        }
    }
    places
}

/// The class of each cell's grains, in random order.
fn shuffled_blocks(lattice: &Lattice, classes: &[SizeClass], rng: &mut ChaCha8Rng) -> Vec<usize> {
    let mut blocks: Vec<usize> = classes
        .iter()
        .enumerate()
        .flat_map(|(index, class)| std::iter::repeat_n(index, lattice.cells_for(index, class)))
        .collect();
    blocks.shuffle(rng);
    blocks
}

/// Sites of a cubic block of `edge`³ grains in units of the site's size, lowest first.
fn block(edge: usize) -> impl Iterator<Item = DVec3> {
    (0..edge).flat_map(move |y| {
        (0..edge)
            .flat_map(move |x| (0..edge).map(move |z| DVec3::new(x as f64, y as f64, z as f64)))
    })
}

fn jitter(rng: &mut ChaCha8Rng, room: DVec3) -> DVec3 {
    let [x, y, z] = [(); 3].map(|()| rng.random_range(-JITTER..=JITTER));
    room * DVec3::new(x, y, z)
}
