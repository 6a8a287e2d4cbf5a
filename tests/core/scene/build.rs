//! What world a scene becomes.

use glam::DVec3;
use grainfall::physics::MaterialId;
use grainfall::scene::{Scene, built_in};
use grainfall::world::{self, Shape, SpeciesId, Surface, World};

const BOX: &str = "tests/core/scene/good/two-sizes-box.ron";

fn built(name: &str) -> World {
    world::build(&Scene::open(name).unwrap(), 1e-5)
}

/// The smallest gap between two grains, or a grain and a wall [m].
fn smallest_gap(world: &World) -> f64 {
    let grains = &world.grains;
    let mut smallest = f64::INFINITY;
    for i in 0..grains.len() {
        for j in 0..i {
            let distance = grains.position[i].distance(grains.position[j]);
            smallest = smallest.min(distance - grains.radius[i] - grains.radius[j]);
        }
        for wall in &world.container.walls {
            let room = wall.surface.distance(grains.position[i]).0;
            smallest = smallest.min(room - grains.radius[i]);
        }
    }
    smallest
}

fn count_of(world: &World, species: u16) -> usize {
    let labels = &world.grains.species;
    labels.iter().filter(|label| label.0 == species).count()
}

#[test]
fn fillings_have_all_their_grains_and_none_touches() {
    for (name, count) in [
        ("dry-r3", 470),
        ("dry-r2", 1585),
        ("dry-r1.25", 6494),
        ("small-drum", 100),
        ("two-frictions-drum", 470),
        ("two-sizes-drum", 315),
        (BOX, 600),
    ] {
        let world = built(name);
        assert_eq!(world.grains.len(), count, "{name}");
        assert!(
            smallest_gap(&world) > 0.0,
            "{name}: {}",
            smallest_gap(&world)
        );
    }
}

#[test]
fn a_filling_starts_low() {
    let world = built("dry-r3");
    let highest = world
        .grains
        .position
        .iter()
        .map(|x| x.y)
        .fold(f64::MIN, f64::max);
    // Simple cubic sites at a tenth of a radius apart hold 0.45 of the volume, so a bed that is 0.21 solid reaches the axis.
    assert!(highest < 0.01, "{highest}");
}

#[test]
fn grains_near_in_number_are_near_in_space() {
    let world = built("dry-r1.25");
    let steps = world
        .grains
        .position
        .windows(2)
        .map(|p| p[0].distance(p[1]));
    let mean = steps.sum::<f64>() / (world.grains.len() - 1) as f64;
    // In random order two grains of the bed are some 40 mm apart; along a row one pitch, 2.8 mm, and 20 mm at its end.
    assert!(mean < 0.006, "{mean}");
}

#[test]
fn the_same_seed_gives_the_same_world_and_another_seed_another() {
    let mut scene = Scene::open(BOX).unwrap();
    let first = world::build(&scene, 1e-5);
    assert_eq!(first.hash(), world::build(&scene, 1e-5).hash());
    scene.seed += 1;
    assert_ne!(first.hash(), world::build(&scene, 1e-5).hash());
}

#[test]
fn the_drum_turns_as_one_body() {
    let world = built("dry-r3");
    let names: Vec<&str> = world
        .container
        .walls
        .iter()
        .map(|w| w.name.as_str())
        .collect();
    assert_eq!(names, ["rim", "back plate", "front plate"]);
    assert_eq!(
        world.container.shape,
        Shape::Drum {
            radius: 0.0605,
            width: 0.022
        }
    );
    for wall in &world.container.walls {
        assert_eq!(wall.motion.velocity, DVec3::ZERO);
        assert_eq!(wall.motion.spin, DVec3::Z * world.container.drum_speed());
        assert!(wall.surface.distance(DVec3::ZERO).0 > 0.0);
    }
    let Surface::Plane { point, normal } = world.container.walls[1].surface else {
        panic!("the back plate is no plane");
    };
    assert_eq!((point, normal), (DVec3::new(0.0, 0.0, -0.011), DVec3::Z));
}

#[test]
fn a_box_has_six_walls_that_look_inwards() {
    let world = built(BOX);
    assert_eq!(world.container.walls.len(), 6);
    for wall in &world.container.walls {
        assert!(
            wall.surface.distance(DVec3::new(0.0, 0.06, 0.0)).0 > 0.0,
            "{}",
            wall.name
        );
    }
}

#[test]
fn materials_mix_by_the_harmonic_mean_unless_the_scene_says_otherwise() {
    let world = built("two-frictions-drum");
    let [smooth, rough, drum] =
        ["smooth", "rough", "drum"].map(|n| world.materials.find(n).unwrap());
    assert_eq!(
        (smooth, rough, drum),
        (MaterialId(0), MaterialId(1), MaterialId(2))
    );
    let mixed = world.materials.pair(smooth, rough);
    // Eq. 3.7 of Man et al. 2023: 2 · 0.1 · 0.8 / 0.9; three roundings.
    assert!((mixed.friction - 0.16 / 0.9).abs() < 1e-15);
    assert_eq!(mixed.restitution, 0.95);
    let with_drum = world.materials.pair(drum, rough);
    assert_eq!((with_drum.restitution, with_drum.friction), (0.72, 0.30));
}

#[test]
fn listed_grains_are_as_listed() {
    let scene = Scene::load("tests/core/scene/good/touching-list.ron").unwrap();
    let world = world::build(&scene, 1e-5);
    let names: Vec<&str> = world.species.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["a", "b"]);
    assert_eq!(
        *world.grains.species,
        [SpeciesId(1), SpeciesId(0), SpeciesId(0)]
    );
    assert_eq!(world.grains.velocity[1], DVec3::new(-0.05, 0.0, 0.0));
    assert_eq!(world.grains.spin[1], DVec3::Z);
    assert_eq!(*world.grains.radius, [0.003, 0.003, 0.5]);
    // A sphere's mass, 4/3 π r³ ρ; a few roundings.
    let mass = 4.0 / 3.0 * std::f64::consts::PI * 2.7e-8 * 7800.0;
    assert!((world.grains.mass[0] / mass - 1.0).abs() < 1e-14);
    assert_eq!(world.container.walls[0].name, "plane-1");
    assert_eq!(world.container.walls[1].motion.velocity, DVec3::Y);
}

#[test]
fn shares_are_exact_in_number() {
    let world = built("two-frictions-drum");
    assert_eq!((count_of(&world, 0), count_of(&world, 1)), (329, 141));
    let world = built(BOX);
    assert_eq!((count_of(&world, 0), count_of(&world, 1)), (120, 480));
}

#[test]
fn a_larger_share_only_adds_and_going_back_takes_the_same_away() {
    let scene = Scene::open("two-frictions-drum").unwrap();
    let start = world::build(&scene, 1e-5);
    let mut world = start.clone();
    let rough = |world: &World| -> Vec<usize> {
        let labels = world.grains.species.iter().enumerate();
        labels
            .filter(|(_, label)| label.0 == 1)
            .map(|(i, _)| i)
            .collect()
    };
    let mut before: Vec<usize> = Vec::new();
    for share in [0.0, 0.1, 0.3, 0.301, 1.0] {
        world::set_share(&mut world, &scene, SpeciesId(1), share);
        let now = rough(&world);
        assert_eq!(now.len(), (470.0 * share).round() as usize);
        assert!(before.iter().all(|grain| now.contains(grain)));
        before = now;
    }
    world::set_share(&mut world, &scene, SpeciesId(1), 0.3);
    assert_eq!(world.grains, start.grains);
    // The other species' slider is the same slider seen from its other end.
    world::set_share(&mut world, &scene, SpeciesId(0), 0.9);
    assert_eq!(rough(&world).len(), 47);
}

#[test]
fn shares_given_one_after_another_reach_any_mixture() {
    let text = built_in()[0].text.replace(
        r#"[(radius_mm: 3, material: "glass")]"#,
        r#"[
            (name: "a", radius_mm: 3, material: "glass", share: 0.5),
            (name: "b", radius_mm: 3, material: "glass", share: 0.3),
            (name: "c", radius_mm: 3, material: "glass", share: 0.2),
        ]"#,
    );
    let scene = Scene::parse("three", &text).unwrap();
    let mut world = world::build(&scene, 1e-5);
    let counts = |world: &World| [0, 1, 2].map(|species| count_of(world, species));
    assert_eq!(counts(&world), [235, 141, 94]);
    world::set_share(&mut world, &scene, SpeciesId(0), 0.1);
    world::set_share(&mut world, &scene, SpeciesId(1), 0.2);
    assert_eq!(counts(&world), [47, 94, 329]);
    world::set_share(&mut world, &scene, SpeciesId(2), 1.5);
    assert_eq!(counts(&world), [0, 0, 470]);
    world::set_share(&mut world, &scene, SpeciesId(2), f64::NAN);
    assert_eq!(counts(&world), [470, 0, 0]);
}

#[test]
fn a_share_cannot_change_where_radii_differ() {
    let scene = Scene::open(BOX).unwrap();
    let start = world::build(&scene, 1e-5);
    let mut world = start.clone();
    world::set_share(&mut world, &scene, SpeciesId(0), 0.9);
    assert_eq!(world.grains, start.grains);
    assert_eq!(scene.interchangeable_species(0), [0]);
}

#[test]
fn the_label_order_is_a_permutation_that_the_seed_fixes() {
    let order = world::label_order(3, 1000);
    assert_eq!(order, world::label_order(3, 1000));
    assert_ne!(order, world::label_order(4, 1000));
    let mut sorted = order;
    sorted.sort_unstable();
    assert!(sorted.into_iter().eq(0..1000));
}

#[test]
fn labels_are_well_mixed() {
    let world = built("two-frictions-drum");
    let half = world.grains.len() / 2;
    let low = world.grains.species[..half]
        .iter()
        .filter(|s| s.0 == 1)
        .count() as f64;
    // Of 235 low grains 70.5 are rough on average, with a standard deviation of 5 (hypergeometric); four of them.
    assert!((low - 70.5).abs() < 20.0, "{low}");
}
