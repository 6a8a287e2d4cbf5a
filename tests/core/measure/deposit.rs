//! Heaps of known front, height and shape.

use super::*;
use glam::DQuat;
use grainfall::measure::{Deposit, DepositOutline, DepositShape, InitialColumn};
use grainfall::world::{Polyhedra, Polyhedron};
use std::f64::consts::{FRAC_PI_4, TAU};

const SECTORS: i32 = 72;

/// A point at this distance from the axis, in the middle of a sector.
fn in_sector(sector: i32, distance: f64, height: f64) -> DVec3 {
    let azimuth = (f64::from(sector) + 0.5) / f64::from(SECTORS) * TAU;
    DVec3::new(distance * azimuth.cos(), height, distance * azimuth.sin())
}

/// A ring of one sphere of 1 mm per sector, at the distances that `distance` gives.
fn ring(distance: impl Fn(i32) -> f64) -> World {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    for sector in 0..SECTORS {
        put(
            &mut world,
            in_sector(sector, distance(sector), 1e-3),
            1e-3,
            0,
        );
    }
    world
}

/// Spheres of 1 mm on a cubic lattice, wherever `inside` says so of a place's distance from the
/// axis and its height.
fn heap(inside: impl Fn(f64, f64) -> bool) -> World {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    for (i, j, k) in
        (-60..60).flat_map(|i| (0..60).flat_map(move |j| (-60..60).map(move |k| (i, j, k))))
    {
        let place =
            DVec3::new(f64::from(i), f64::from(j), f64::from(k)) * 0.002 + DVec3::splat(0.001);
        if inside(place.x.hypot(place.z), place.y) {
            put(&mut world, place, 1e-3, 0);
        }
    }
    world
}

#[test]
fn front_of_a_ring_is_its_outer_edge() {
    let world = ring(|_| 0.08);
    let deposit = Deposit::of(&world).unwrap();
    assert_close(deposit.front_radius(), 0.081, 1e-15);
    assert_close(deposit.radius_of_share(0.95), 0.08, 1e-15);
}

#[test]
fn front_is_the_mean_over_the_sectors_of_their_farthest_grains() {
    let mut world = ring(|sector| if sector % 2 == 0 { 0.06 } else { 0.1 });
    for sector in 0..SECTORS {
        put(&mut world, in_sector(sector, 0.03, 1e-3), 1e-3, 1);
    }
    assert_close(Deposit::of(&world).unwrap().front_radius(), 0.081, 1e-15);
}

#[test]
fn the_outline_in_the_picture_has_the_front_and_the_height_of_the_samples() {
    let cone = heap(|distance, height| height < 0.05 - distance);
    let spheres = [ring(|sector| 0.06 + 0.001 * f64::from(sector)), cone];
    let mut cubes = spheres[1].clone();
    let shape = cube_shape(0.9e-3 / 3.0_f64.sqrt());
    let turned = |i: usize| (0, DQuat::from_rotation_z(i as f64));
    let bodies: Vec<_> = (0..cubes.grains.len()).map(turned).collect();
    let polyhedra = Polyhedra::of_grains(&cubes.grains, [shape], &bodies);
    cubes.polyhedra = Some(Box::new(polyhedra));
    for world in spheres.iter().chain([&cubes]) {
        let (deposit, outline) = (Deposit::of(world), DepositOutline::of(world));
        let (deposit, outline) = (deposit.unwrap(), outline.unwrap());
        assert_close(outline.front, deposit.front_radius(), 1e-15);
        assert_close(outline.height, deposit.height(), 1e-15);
    }
    let outline = DepositOutline::of(&spheres[0]).unwrap();
    // The third of those that begin opposite to x is the 39th of those that begin there.
    assert_close(outline.sectors[3], 0.06 + 0.039 + 1e-3, 1e-15);
    let mut hole = spheres[0].clone();
    hole.grains = grainfall::world::Grains::default();
    assert_eq!(DepositOutline::of(&hole), None);
}

#[test]
fn one_grain_that_rolled_far_moves_the_front_by_a_sector_and_the_cluster_not_at_all() {
    let mut world = ring(|_| 0.08);
    for sector in 1..SECTORS as u32 {
        touch(&mut world, sector - 1, Partner::Grain(sector), DVec3::ZERO);
    }
    put(&mut world, in_sector(7, 0.8, 1e-3), 1e-3, 0);
    touch(&mut world, SECTORS as u32, Partner::Wall(0), DVec3::ZERO);
    let deposit = Deposit::of(&world).unwrap();
    assert_close(deposit.front_radius(), 0.081 + 0.72 / 72.0, 1e-15);
    assert_close(deposit.cluster_radius(&world), 0.081, 1e-15);
    // An open pair holds nothing together: the ring falls into 30 and 42 grains.
    world.contacts[29].touching = false;
    let distance = |i: usize| world.grains.position[i].x.hypot(world.grains.position[i].z);
    assert_close(distance(30), 0.08, 1e-15);
    world.grains.position[30] *= DVec3::new(2.0, 1.0, 2.0);
    // Of the 42 sectors that the larger part holds, one reaches 0.161 m.
    let cluster = Deposit::of(&world).unwrap().cluster_radius(&world);
    assert_close(cluster, 0.081 + 0.08 / 42.0, 1e-15);
}

#[test]
fn share_of_the_grains_lies_within_its_radius() {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    for i in 1..=200 {
        put(
            &mut world,
            in_sector(i % SECTORS, 1e-3 * f64::from(i), 1e-3),
            1e-3,
            0,
        );
    }
    let deposit = Deposit::of(&world).unwrap();
    for (share, expected) in [(0.99, 0.198), (0.95, 0.190), (1.0, 0.2), (0.0, 0.001)] {
        assert_close(deposit.radius_of_share(share), expected, 1e-15);
    }
}

#[test]
fn cone_of_grains_has_its_front_apex_slope_and_shape() {
    // A cone of 80 mm radius and 48 mm height: slope 0.6.
    let world = heap(|distance, height| height < 0.048 - 0.6 * distance);
    let deposit = Deposit::of(&world).unwrap();
    // The floor's layer has its centres at 1 mm, inside up to 78.3 mm; a lattice of 2 mm leaves a sector up to 2 mm short.
    let front = deposit.front_radius();
    assert!((0.0773..=0.0794).contains(&front), "{front}");
    // The top layer ends within a layer (2 mm) of the apex and half a layer above its centres.
    assert_close(deposit.height(), 0.048, 2e-3);
    let profile = deposit.height_profile();
    // The ring at the axis is a cell of 3.2 mm across, the mean cone over it lies 1 mm below the apex.
    assert_close(profile.apex(), 0.047, 2e-3);
    for (radius, height) in profile.radius.iter().zip(&profile.height) {
        if (0.01..0.07).contains(radius) {
            // Whole layers of 2 mm, of which the highest of each cell counts: between the cone and one layer above it.
            let cone = 0.048 - 0.6 * radius;
            assert!(
                (-1e-3..=3e-3).contains(&(height - cone)),
                "{height} at {radius}"
            );
        }
    }
    // That of a cone is a tenth of its base; a ring is 3.2 mm wide.
    assert_close(profile.flat_radius(), 0.008, 3.3e-3);
    assert_eq!(profile.shape(front), DepositShape::Cone);
    // The cone's own volume over that of the column, within a layer of height and half a grain of radius.
    let column = InitialColumn::of(&world).unwrap();
    let ratio = column.cone_volume_ratio(front, deposit.height());
    let expected = 0.08 * 0.08 * 0.048 / 3.0 / (0.025 * 0.025 * 0.05);
    assert_close(ratio / expected, 1.0, 0.08);
}

#[test]
fn standing_column_and_truncated_cone_are_frustums() {
    let standing = heap(|distance, height| distance < 0.025 && height < 0.05);
    let deposit = Deposit::of(&standing).unwrap();
    assert_close(deposit.height(), 0.05, 1e-12);
    assert_close(deposit.front_radius(), 0.025, 1e-3);
    let profile = deposit.height_profile();
    assert_close(profile.apex(), 0.05, 1e-12);
    assert_eq!(profile.shape(0.025), DepositShape::Frustum);
    // Flat up to 30 mm, then down with slope 0.6 to 80 mm.
    let cut = heap(|distance, height| height < 0.03 && height < 0.048 - 0.6 * distance);
    let profile = Deposit::of(&cut).unwrap().height_profile();
    // Nine tenths of 30 mm are at 35 mm on the flank.
    assert_close(profile.flat_radius(), 0.035, 3.3e-3);
    assert_eq!(profile.shape(0.08), DepositShape::Frustum);
}

/// A cube of edge 2a with a rounding of 0.1 mm.
fn cube_shape(half: f64) -> Polyhedron {
    let corner = |k: i32| {
        let side = |bit: i32| if k & bit == 0 { -half } else { half };
        DVec3::new(side(1), side(2), side(4))
    };
    Polyhedron {
        vertices: (0..8).map(corner).collect(),
        edges: Vec::new(),
        faces: Vec::new(),
        rounding: 1e-4,
        volume: 8.0 * half.powi(3),
        gyration: DVec3::splat(2.0 / 3.0 * half * half),
    }
}

/// Such a cube, turned by `turn`.
fn cube(half: f64, turn: DQuat, position: DVec3) -> World {
    let shape = cube_shape(half);
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    put(&mut world, position, shape.bounding_radius(), 0);
    let polyhedra = Polyhedra::of_grains(&world.grains, [shape], &[(0, turn)]);
    world.polyhedra = Some(Box::new(polyhedra));
    world
}

#[test]
fn polyhedron_reaches_as_far_and_high_as_its_rounded_corners() {
    let (a, place) = (1e-3, DVec3::new(0.01, 5e-3, 0.0));
    let flat = Deposit::of(&cube(a, DQuat::IDENTITY, place)).unwrap();
    assert_close(flat.front_radius(), 0.011_f64.hypot(a) + 1e-4, 1e-15);
    assert_close(flat.height(), 6.1e-3, 1e-15);
    // On an edge: half the diagonal of a face upwards and outwards.
    let tipped = Deposit::of(&cube(a, DQuat::from_rotation_z(FRAC_PI_4), place)).unwrap();
    let diagonal = 2.0_f64.sqrt() * a;
    assert_close(tipped.height(), 5.1e-3 + diagonal, 1e-15);
    assert_close(
        tipped.front_radius(),
        (0.01 + diagonal).hypot(a) + 1e-4,
        1e-15,
    );
}

#[test]
fn nothing_on_the_floor_is_no_deposit() {
    assert!(Deposit::of(&column(0.025, 0.05, [0.1, 0.4])).is_none());
    let mut bare = on_floor();
    push(&mut bare, DVec3::Y, 1e-3);
    assert!(Deposit::of(&bare).is_none());
    // Nothing near the axis: no height there.
    assert_eq!(Deposit::of(&ring(|_| 0.08)).unwrap().height(), 0.0);
}
