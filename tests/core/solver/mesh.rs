//! Walls of triangles: what a grain feels of seams, corners and edges, and a meshed drum beside ours.

use super::*;
use crate::meshes::{drum, key, quad};
use glam::{DQuat, DVec3};
use grainfall::engines::scene_from;
use grainfall::solver::Processor;

const STEP: f64 = 1e-5;

/// Grains of 1 mm in `container`, one for each of these keys.
fn grains_in(container: &str, grains: &[&str], gravity: &str) -> World {
    let grains = grains
        .iter()
        .map(|keys| format!("({keys}, radius_mm: 1, material: \"m\")"));
    let grains: Vec<String> = grains.collect();
    world(
        &format!(
            "(title: \"Walls\", materials: {{\"m\": (friction: 0.3, restitution: 0.6)}}, container: {container}, gravity: \
             {gravity}, grains: List([{}]))",
            grains.join(", ")
        ),
        STEP,
    )
}

fn mesh(triangles: &[[DVec3; 3]], more: &str) -> String {
    format!("Mesh({}, material: \"m\"{more})", key(triangles))
}

/// A floor at y = 0, from −2 cm to 2 cm, of uneven triangles.
fn uneven_floor() -> Vec<[DVec3; 3]> {
    let place = |i: i32, j: i32| {
        let inside = (1..=9).contains(&i) && (1..=9).contains(&j);
        let off = |a: i32, b: i32| {
            1.3e-3 * f64::from(u8::from(inside)) * f64::from((7 * a + 5 * b) % 5 - 2) / 2.0
        };
        let x = 4e-3 * f64::from(i - 5) + off(i, j);
        DVec3::new(x, 0.0, 4e-3 * f64::from(j - 5) + off(j, i + 3))
    };
    let cells = (0..10).flat_map(|i| (0..10).map(move |j| (i, j)));
    let squares = cells.map(|(i, j)| [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]);
    squares
        .flat_map(|corners| quad(corners.map(|(i, j)| place(i, j))))
        .collect()
}

#[test]
fn tessellated_floor_moves_a_grain_as_the_plane_does_and_seams_do_not_show() {
    let grain =
        "position: (-0.011, 0.0009992, -0.006), velocity: (0.3, 0, 0.17), spin: (0, 9, -20)";
    let gravity = "(4, -98.1, 1)";
    let floor = r#"Planes([(point: (0, 0, 0), normal: (0, 1, 0), material: "m")])"#;
    let mut plane = grains_in(floor, &[grain], gravity);
    let mut meshed = grains_in(&mesh(&uneven_floor(), ""), &[grain], gravity);
    assert_eq!(meshed.container.walls.len(), 1, "one smooth part");
    let mut solvers = [Solver::new(1), Solver::new(1)];
    let (mut farthest, mut touching): (f64, u32) = (0.0, 0);
    for _ in 0..6000 {
        solvers[0].advance(&mut plane, 1).unwrap();
        solvers[1].advance(&mut meshed, 1).unwrap();
        let grains = [&plane.grains, &meshed.grains];
        let off = |column: fn(&grainfall::world::Grains) -> DVec3| {
            let [a, b] = grains.map(column);
            (a - b).length() / a.length().max(1e-6)
        };
        farthest = farthest
            .max(off(|grains| grains.position[0]))
            .max(off(|grains| grains.velocity[0]))
            .max(off(|grains| grains.force[0]))
            .max(off(|grains| grains.spin[0]));
        touching += meshed.grains.contact_count[0];
    }
    assert!(touching > 3000, "{touching} steps in contact");
    let way = (plane.grains.position[0] - DVec3::new(-0.011, 0.000_999_2, -0.006)).length();
    assert!(way > 0.012, "over several seams: {way} m");
    // Forces to rounding too, tangential ones among them: a history that were lost or doubled at a
    // seam would show as a jump of their size.
    assert_below("largest relative difference", farthest, 1e-9);
}

#[test]
fn grain_in_a_corner_touches_both_walls_as_it_does_two_planes() {
    let x = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * 0.01;
    let mut walls = quad([
        x(0.0, 0.0, -1.0),
        x(1.0, 0.0, -1.0),
        x(1.0, 0.0, 1.0),
        x(0.0, 0.0, 1.0),
    ]);
    walls.extend(quad([
        x(0.0, 0.0, -1.0),
        x(0.0, 0.0, 1.0),
        x(0.0, 1.0, 1.0),
        x(0.0, 1.0, -1.0),
    ]));
    let planes = r#"Planes([(point: (0, 0, 0), normal: (0, 1, 0), material: "m"),
        (point: (0, 0, 0), normal: (1, 0, 0), material: "m")])"#;
    let grain = "position: (0.00099, 0.00098, 0), velocity: (0.01, -0.02, 0.1)";
    let [mut of_planes, mut meshed] = [planes, &mesh(&walls, "")]
        .map(|container| grains_in(container, &[grain], "(-1, -9.81, 0)"));
    for _ in 0..200 {
        run(&mut of_planes, STEP);
        run(&mut meshed, STEP);
        assert_eq!(meshed.contacts.len(), of_planes.contacts.len());
    }
    let [a, b] =
        [&of_planes, &meshed].map(|world| (world.grains.position[0], world.grains.spin[0]));
    assert!(
        (a.0 - b.0).length() < 1e-15 && (a.1 - b.1).length() < 1e-9,
        "{a:?} {b:?}"
    );
}

#[test]
fn edge_is_one_contact_along_the_line_from_it() {
    // A roof of two slopes that meet along z, and a grain over its ridge, off the middle.
    let x = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * 0.01;
    let ridge = [x(0.0, 0.0, -1.0), x(0.0, 0.0, 1.0)];
    let mut roof = quad([ridge[0], ridge[1], x(1.0, -1.0, 1.0), x(1.0, -1.0, -1.0)]);
    roof.extend(quad([
        ridge[1],
        ridge[0],
        x(-1.0, -1.0, -1.0),
        x(-1.0, -1.0, 1.0),
    ]));
    let floor = r#"Planes([(point: (0, 0, 0), normal: (0, 1, 0), material: "m")])"#;
    let towards = DVec3::new(0.3, 1.0, 0.0).normalize();
    let at = 0.00098 * towards;
    let above = format!("position: ({:?}, {:?}, 0.001)", at.x, at.y);
    let mut on_ridge = grains_in(&mesh(&roof, ""), &[&above], "(0, 0, 0)");
    let mut on_floor = grains_in(floor, &["position: (0, 0.00098, 0)"], "(0, 0, 0)");
    Solver::new(1).evaluate(&mut on_ridge).unwrap();
    Solver::new(1).evaluate(&mut on_floor).unwrap();
    assert_eq!(on_ridge.container.walls.len(), 2);
    assert_eq!(on_ridge.contacts.len(), 1);
    let (force, pushed) = (on_ridge.grains.force[0], on_floor.grains.force[0].length());
    assert!(
        (force / pushed - towards).length() < 1e-9,
        "{force} {pushed}"
    );
}

#[test]
fn mesh_that_moves_meets_a_grain_as_one_at_rest_meets_a_grain_that_moves() {
    let x = |y: f64, z: f64| DVec3::new(0.0, y, z) * 0.01;
    let wall = quad([x(-1.0, -1.0), x(1.0, -1.0), x(1.0, 1.0), x(-1.0, 1.0)]);
    // It is met between two steps: a dashpot that goes with the fourth root of the overlap magnifies
    // the rounding of an overlap of nothing.
    let moving = mesh(&wall, ", motion: Moving(velocity: (0.1, 0, 0))");
    let mut moving = grains_in(&moving, &["position: (0.0015004, 0, 0)"], "(0, 0, 0)");
    let thrown = "position: (0.0015004, 0, 0), velocity: (-0.1, 0, 0)";
    let mut resting = grains_in(&mesh(&wall, ""), &[thrown], "(0, 0, 0)");
    run(&mut moving, 0.05);
    run(&mut resting, 0.05);
    // Galilei: 0.1 m/s, and 5 mm, are between the two frames.
    let [a, b] = [&moving, &resting].map(|world| world.grains.velocity[0].x);
    assert!(b > 0.055, "it came back: {b} m/s");
    assert!((a - (b + 0.1)).abs() < 1e-10, "{a} {b}");
    let [a, b] = [&moving, &resting].map(|world| world.grains.position[0].x);
    assert!((a - (b + 0.005)).abs() < 1e-11, "{a} {b}");
    let surface = &moving.container.walls[0].surface;
    assert!((surface.distance(DVec3::ZERO).0 - 0.005).abs() < 1e-15);
}

const RADIUS: f64 = 0.03;
const WIDTH: f64 = 0.012;

/// A bed of the small drum, by its rim and plates or as a mesh of 360 facets, with the same grains.
fn drums() -> [World; 2] {
    let head = r#"title: "A small drum", materials: {"glass": (), "drum": (friction: 0.5)}"#;
    let container =
        format!("Drum(radius: {RADIUS}, width: {WIDTH}, speed_rpm: 4, material: \"drum\")");
    let fill = "Fill(count: 90, species: [(radius_mm: 2, material: \"glass\")])";
    let scene = Scene::parse(
        "drum",
        &format!("({head}, container: {container}, grains: {fill})"),
    )
    .unwrap();
    let mut bed = build(&scene, STEP);
    run(&mut bed, 0.25);
    bed.grains.velocity.fill(DVec3::ZERO);
    bed.grains.spin.fill(DVec3::ZERO);
    let listed = scene_from(&scene, &bed);
    let mut meshed = listed.clone();
    let turning = ", motion: Turning(axis: (0, 0, 2), speed_rpm: 4)";
    let text = mesh(&drum(RADIUS, WIDTH, 360), turning).replace("\"m\"", "\"drum\"");
    let parsed = Scene::parse(
        "mesh",
        &format!(
            "({head}, container: {text}, grains: List([(position: (0, 0, 0), radius_mm: 1, material: \"glass\")]))"
        ),
    );
    meshed.container = parsed.unwrap().container;
    meshed.check().unwrap();
    [build(&listed, STEP), build(&meshed, STEP)]
}

#[test]
fn meshed_drum_moves_grains_as_the_drum_does() {
    let [mut ours, mut meshed] = drums();
    assert_eq!(meshed.container.walls.len(), 3, "a rim and two plates");
    let start = ours.grains.position.to_vec();
    run(&mut ours, 0.1);
    run(&mut meshed, 0.1);
    let median = |mut lengths: Vec<f64>| {
        lengths.sort_by(f64::total_cmp);
        lengths[lengths.len() / 2]
    };
    let apart =
        |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| (*a - *b).length()).collect();
    let off = median(apart(&ours.grains.position, &meshed.grains.position));
    let way = median(apart(&start, &ours.grains.position));
    println!(
        "a median {:.2} µm apart where grains moved {:.0} µm",
        1e6 * off,
        1e6 * way
    );
    assert!(way > 1e-4, "{way}");
    assert_below("median distance", off, 1e-5);
    assert_eq!(meshed.container.angle, ours.container.angle);
    // θ is that of the drum.
    let angle = |world: &World| {
        grainfall::measure::surface_line(world, 0.7)
            .unwrap()
            .angle
            .to_degrees()
    };
    let [a, b] = [angle(&ours), angle(&meshed)];
    println!("θ = {a:.3}° and {b:.3}°");
    assert!((a - b).abs() < 0.5, "{a} {b}");
}

#[test]
fn turning_mesh_gives_the_same_bits_for_any_threads_lanes_slices_and_restores() {
    let [_, start] = drums();
    let after = |mut solver: Solver, slices: &[u64]| {
        let mut world = start.clone();
        for steps in slices {
            solver.advance(&mut world, *steps).unwrap();
        }
        world.hash()
    };
    let whole = after(Solver::new(1), &[1500]);
    for threads in [2, 3] {
        assert_eq!(after(Solver::new(threads), &[1500]), whole);
    }
    for processor in Processor::all() {
        assert_eq!(after(Solver::on(processor, 1), &[1500]), whole);
    }
    assert_eq!(after(Solver::new(1), &[1, 499, 3, 997]), whole);
    // From its stored form by a solver that knows nothing of it.
    let mut world = start.clone();
    Solver::new(1).advance(&mut world, 700).unwrap();
    let stored = postcard::to_stdvec(&world).unwrap();
    let mut restored: World = postcard::from_bytes(&stored).unwrap();
    restored.check().unwrap();
    assert_eq!(restored, world);
    Solver::new(2).advance(&mut restored, 800).unwrap();
    assert_eq!(restored.hash(), whole);
}

#[test]
fn mesh_turns_about_an_axis_of_its_own_as_one_about_the_origin_does() {
    let turn = DQuat::from_mat3(&glam::DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y));
    let shift = DVec3::new(0.02, 0.05, -0.01);
    let place = |x: DVec3| turn * x + shift;
    let triangles = drum(RADIUS, WIDTH, 60);
    let moved: Vec<_> = triangles.iter().map(|t| t.map(place)).collect();
    let grain = |x: DVec3| format!("position: ({:?}, {:?}, {:?})", x.x, x.y, x.z);
    let at = DVec3::new(0.02, -0.019, 0.0);
    let down = turn * DVec3::new(0.0, -9.81, 0.0);
    let mut first = grains_in(
        &mesh(&triangles, ", motion: Turning(axis: (0, 0, 1), speed: 3)"),
        &[&grain(at)],
        "(0, -9.81, 0)",
    );
    let axis = turn * DVec3::Z;
    let about = format!(
        ", motion: Turning(through: ({}, {}, {}), axis: ({}, {}, {}), speed: 3)",
        shift.x, shift.y, shift.z, axis.x, axis.y, axis.z
    );
    let gravity = format!("({}, {}, {})", down.x, down.y, down.z);
    let mut second = grains_in(&mesh(&moved, &about), &[&grain(place(at))], &gravity);
    run(&mut first, 0.1);
    run(&mut second, 0.1);
    let there = place(first.grains.position[0]);
    assert!(first.container.angle == 3.0 * 0.1 || (first.container.angle - 0.3).abs() < 1e-12);
    let off = (there - second.grains.position[0]).length();
    assert_below("distance", off, 1e-9);
    assert!((there - place(at)).length() > 1e-3, "it moved");
}
