//! Solids: integrals against closed forms, cutting, hulls, erosion.

use glam::{DMat3, DQuat, DVec3};
use grainfall::geometry::{Flaw, HalfSpace, Solid};
use grainfall::world::Polyhedron;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A rotation that no symmetry of the solids here knows, from a quaternion of whole numbers: 1 + 4
/// + 9 + 16 = 30.
fn askew() -> DQuat {
    DQuat::from_xyzw(1.0, -2.0, 3.0, 4.0).normalize()
}

/// The corners of `solid` turned and moved, and their hull.
fn displaced(solid: &Solid, by: DVec3) -> Solid {
    let corners = solid.vertices.iter().map(|x| askew() * *x + by);
    Solid::hull(&corners.collect::<Vec<_>>()).unwrap()
}

fn tetrahedron(edge: f64) -> Solid {
    let half = edge / 8.0_f64.sqrt();
    let corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]];
    let corners = corners.map(|c| half * DVec3::from_array(c.map(f64::from)));
    Solid::hull(&corners).unwrap()
}

/// An upright prism over a right triangle with legs `a` along x and `b` along z.
fn wedge(a: f64, b: f64, height: f64) -> Solid {
    let base = [DVec3::ZERO, a * DVec3::X, b * DVec3::Z];
    let top = base.map(|x| x + height * DVec3::Y);
    Solid::hull(&[base, top].concat()).unwrap()
}

/// Largest difference of two matrices in parts of the largest element of the second.
fn difference(a: DMat3, b: DMat3) -> f64 {
    let (a, b) = (a.to_cols_array(), b.to_cols_array());
    let largest = |values: [f64; 9]| values.into_iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut off = a;
    off.iter_mut().zip(b).for_each(|(x, y)| *x -= y);
    largest(off) / largest(b)
}

#[test]
fn moments_of_a_box_a_tetrahedron_and_a_prism_are_those_of_the_closed_forms() {
    let shift = DVec3::new(0.3, -0.2, 0.7);
    let diagonal = |x: f64, y: f64, z: f64| DMat3::from_diagonal(DVec3::new(x, y, z));
    let (a, b, c): (f64, f64, f64) = (2.0, 0.5, 1.25);
    // Box: V a²/12 along each axis. Tetrahedron: V edge²/40 along every one. Wedge: V a²/18 along a leg, V h²/12 along the
    // height, −V a b/36 between the legs; its centroid lies a third of the way along either leg.
    let box_second = diagonal(a * a, b * b, c * c) * (a * b * c / 12.0);
    let tetra_volume = a * a * a / 72.0_f64.sqrt();
    let mut wedge_second = diagonal(a * a / 18.0, b * b / 12.0, c * c / 18.0);
    wedge_second.x_axis.z = -a * c / 36.0;
    wedge_second.z_axis.x = -a * c / 36.0;
    let wedge_volume = 0.5 * a * b * c;
    let cases = [
        (
            Solid::cuboid(DVec3::ZERO, DVec3::new(a, b, c)),
            a * b * c,
            0.5 * DVec3::new(a, b, c),
            box_second,
        ),
        (
            tetrahedron(a),
            tetra_volume,
            DVec3::ZERO,
            DMat3::IDENTITY * (tetra_volume * a * a / 40.0),
        ),
        (
            wedge(a, c, b),
            wedge_volume,
            DVec3::new(a / 3.0, b / 2.0, c / 3.0),
            wedge_second * wedge_volume,
        ),
    ];
    for (solid, volume, centroid, second) in cases {
        solid.check().unwrap();
        let turn = DMat3::from_quat(askew());
        for (solid, centroid, second) in [
            (solid.clone(), centroid, second),
            (
                displaced(&solid, shift),
                askew() * centroid + shift,
                turn * second * turn.transpose(),
            ),
        ] {
            let moments = solid.moments();
            // A few dozen roundings of numbers of the solid's size.
            assert!((moments.volume / volume - 1.0).abs() < 1e-12);
            assert!((moments.centroid - centroid).length() < 1e-12);
            assert!(difference(moments.second, second) < 1e-12);
        }
    }
}

#[test]
fn principal_axes_are_right_handed_and_leave_no_products() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for _ in 0..200 {
        let points: Vec<DVec3> = (0..8)
            .map(|_| DVec3::from_array([(); 3].map(|()| rng.random_range(-1.0..1.0))))
            .collect();
        let solid = Solid::hull(&points).unwrap();
        solid.check().unwrap();
        let moments = solid.moments();
        let (turn, second) = moments.principal_axes();
        let axes = DMat3::from_quat(turn);
        assert!((axes.determinant() - 1.0).abs() < 1e-12);
        let back = axes * DMat3::from_diagonal(second) * axes.transpose();
        assert!(difference(back, moments.second) < 1e-12);
    }
}

#[test]
fn a_box_keeps_its_own_axes() {
    let solid = Solid::cuboid(DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 3.0, 4.0));
    assert_eq!(solid.moments().principal_axes().0, DQuat::IDENTITY);
}

#[test]
fn both_sides_of_a_cut_make_up_the_whole() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    for round in 0..500 {
        let mut whole = Solid::cuboid(DVec3::splat(-1.0), DVec3::splat(1.0));
        for _ in 0..10 {
            let normal = DVec3::from_array([(); 3].map(|()| rng.random_range(-1.0..1.0)));
            let offset = rng.random_range(0.0..1.2);
            // Every other cut goes through a corner, where cutting is hardest.
            let offset = if round % 2 == 0 {
                offset
            } else {
                whole.vertices[0].dot(normal.normalize())
            };
            let half = HalfSpace {
                normal: normal.normalize(),
                offset,
            };
            let other = HalfSpace {
                normal: -half.normal,
                offset: -offset,
            };
            let (mut inside, mut outside) = (whole.clone(), whole.clone());
            inside.clip(half);
            outside.clip(other);
            let volume = |solid: &Solid| solid.moments().volume;
            let sum = volume(&inside) + volume(&outside);
            assert!((sum - volume(&whole)).abs() < 1e-11, "{sum}");
            if inside.check().is_err() {
                assert!(volume(&inside) < 1e-9, "{:?}", inside.check());
                break;
            }
            whole = inside;
        }
    }
}

#[test]
fn a_cut_through_edges_and_corners_keeps_to_them() {
    let mut cube = Solid::cuboid(DVec3::ZERO, DVec3::ONE);
    let normal = DVec3::new(1.0, 0.0, 1.0).normalize();
    cube.clip(HalfSpace {
        normal,
        offset: normal.x,
    });
    cube.check().unwrap();
    assert_eq!((cube.vertices.len(), cube.faces.len()), (6, 5));
    let normal = DVec3::ONE.normalize();
    let mut cube = Solid::cuboid(DVec3::ZERO, DVec3::ONE);
    cube.clip(HalfSpace {
        normal,
        offset: 2.0 * normal.x,
    });
    cube.check().unwrap();
    assert_eq!((cube.vertices.len(), cube.faces.len()), (7, 7));
}

#[test]
fn hulls_leave_out_what_lies_inside_and_refuse_what_is_flat() {
    let corners = Solid::cuboid(DVec3::ZERO, DVec3::ONE).vertices;
    let mut points = corners.clone();
    points.extend([
        DVec3::splat(0.5),
        DVec3::new(0.5, 0.5, 1.0),
        DVec3::new(0.5, 0.0, 0.0),
    ]);
    points.extend(corners);
    let hull = Solid::hull(&points).unwrap();
    assert_eq!(
        (hull.vertices.len(), hull.faces.len(), hull.edges().len()),
        (8, 6, 12)
    );
    let flat = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0)];
    assert_eq!(Solid::hull(&flat), None);
    assert_eq!(Solid::hull(&[DVec3::ZERO, DVec3::X]), None);
    assert_eq!(Solid::hull(&[]), None);
}

#[test]
fn erosion_moves_every_face_inwards() {
    let solid = displaced(&wedge(3.0, 4.0, 2.0), DVec3::ONE);
    let core = solid.eroded(0.25).unwrap();
    // The triangle 3, 4, 5 has an inscribed circle of radius 1, so it shrinks by a quarter about that circle's centre.
    let moments = core.moments();
    assert!((moments.volume - 6.0 * 0.75 * 0.75 * 1.5).abs() < 1e-11);
    assert_eq!(core.faces.len(), 5);
    assert_eq!(solid.eroded(1.0), None);
}

#[test]
fn a_rounded_polyhedron_has_the_mass_of_the_whole_and_the_corners_of_the_core() {
    let size = DVec3::new(0.01, 0.02, 0.04);
    let solid = Solid::cuboid(-0.5 * size, 0.5 * size);
    let solid = displaced(&solid, DVec3::new(0.1, 0.2, 0.3));
    let rounded = Polyhedron::rounded(&solid, 1e-3).unwrap();
    let shape = rounded.shape;
    assert!((shape.volume / 8e-6 - 1.0).abs() < 1e-12);
    let squares = size * size;
    let gyration = (DVec3::splat(squares.element_sum()) - squares) / 12.0;
    let mut found = shape.gyration.to_array();
    found.sort_by(|a, b| b.total_cmp(a));
    for (found, wanted) in found.into_iter().zip(gyration.to_array()) {
        assert!((found / wanted - 1.0).abs() < 1e-12);
    }
    let radius = (0.5 * size - DVec3::splat(1e-3)).length() + 1e-3;
    assert!((shape.bounding_radius() / radius - 1.0).abs() < 1e-12);
    assert_eq!((shape.vertices.len(), shape.edges.len()), (8, 12));
    assert!((rounded.position - DVec3::new(0.1, 0.2, 0.3)).length() < 1e-15);
    // Turned back into place, the core's corners lie a rounding radius within the box's planes.
    for (face, inner) in (0..6).map(|face| (face, solid.plane(face))) {
        let place = |x: &DVec3| rounded.orientation * *x + rounded.position;
        let heights = shape.vertices.iter().map(|x| inner.normal.dot(place(x)));
        let highest = heights.fold(f64::NEG_INFINITY, f64::max);
        assert!((inner.offset - 1e-3 - highest).abs() < 1e-15, "face {face}");
    }
}

#[test]
fn the_check_finds_each_flaw() {
    let cube = Solid::cuboid(DVec3::ZERO, DVec3::ONE);
    assert_eq!(cube.check(), Ok(()));
    let spoilt = |spoil: fn(&mut Solid)| {
        let mut cube = cube.clone();
        spoil(&mut cube);
        cube.check()
    };
    assert_eq!(spoilt(|c| c.faces.clear()), Err(Flaw::Empty));
    assert_eq!(spoilt(|c| drop(c.faces.pop())), Err(Flaw::Open));
    assert_eq!(spoilt(|c| c.faces[0].reverse()), Err(Flaw::Open));
    assert_eq!(
        spoilt(|c| c.vertices.push(DVec3::splat(0.5))),
        Err(Flaw::Euler)
    );
    assert_eq!(
        spoilt(|c| c.vertices[0] = DVec3::splat(0.9)),
        Err(Flaw::NotConvex)
    );
    let inside_out = spoilt(|c| c.faces.iter_mut().for_each(|face| face.reverse()));
    assert_eq!(inside_out, Err(Flaw::NotConvex));
}
