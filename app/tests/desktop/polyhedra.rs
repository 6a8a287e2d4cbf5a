//! Claims about pictures of polyhedra: each covers the pixels that its body covers, coloured and
//! cut as asked.

use crate::view::{Photograph, SIZE, cosine, photograph, studio, world};
use bevy::math::{Vec2, Vec3};
use glam::{DQuat, DVec3};
use grainfall::world::{Polyhedra, Polyhedron, Shape, SpeciesId, Surface, World};
use grainfall_app::view::{CoordinateAxis, Cut, ProjectionKind, StandardView, species_colour};
use std::sync::Arc;

/// Half an edge of a cube's core [m].
const HALF: f64 = 4e-3;
/// Its rounding radius [m].
const ROUNDING: f64 = 5e-4;

/// A cube; its mass belongs to the cube that its faces make.
fn cube() -> Polyhedron {
    let vertices = (0..8_u8).map(|i| {
        let sign = |bit: u8| if i >> bit & 1 == 0 { -HALF } else { HALF };
        DVec3::new(sign(0), sign(1), sign(2))
    });
    let faces: Vec<Vec<u16>> = vec![
        vec![0, 4, 6, 2],
        vec![1, 3, 7, 5],
        vec![0, 1, 5, 4],
        vec![2, 6, 7, 3],
        vec![0, 2, 3, 1],
        vec![4, 5, 7, 6],
    ];
    let edges = faces.iter().flat_map(|face| {
        (0..4).filter_map(|i| {
            let (a, b) = (face[i], face[(i + 1) % 4]);
            (a < b).then_some([a, b])
        })
    });
    let edge = 2.0 * (HALF + ROUNDING);
    Polyhedron {
        vertices: vertices.collect(),
        edges: edges.collect(),
        rounding: ROUNDING,
        volume: edge.powi(3),
        gyration: DVec3::splat(edge * edge / 6.0),
        faces,
    }
}

/// Grains without walls: place, orientation, species; the sphere is as large as the ball inside the
/// cube.
fn bodies(list: &[(DVec3, DQuat, u16)], shape: Polyhedron) -> World {
    let mut world = world(Shape::Planes, Vec::new());
    let radius = shape.bounding_radius();
    for (position, _, species) in list {
        (world.grains).push_sphere(*position, radius, 2500.0, SpeciesId(*species));
    }
    let bodies: Vec<_> = list.iter().map(|(_, turn, _)| (0, *turn)).collect();
    let polyhedra = Polyhedra::of_grains(&world.grains, [shape], &bodies);
    world.polyhedra = Some(Box::new(polyhedra));
    world
}

/// Two cubes, apart, the second one turned.
fn two_cubes() -> Vec<(DVec3, DQuat, u16)> {
    let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.48, 0.64), 0.9);
    vec![
        (DVec3::new(-0.011, 0.001, 0.0), DQuat::IDENTITY, 0),
        (DVec3::new(0.011, -0.001, 0.004), turn, 1),
    ]
}

/// Distance of `point` from the convex hull of `points`, negative inside.
fn distance_from_hull(points: &[Vec2], point: Vec2) -> f32 {
    let mut farthest_inside = f32::MAX;
    let mut nearest = f32::MAX;
    let mut outside = false;
    for a in points {
        for b in points {
            let along = (*b - *a).normalize_or_zero();
            let side = |x: Vec2| along.perp_dot(x - *a);
            // An edge of the hull has every point on its left.
            if along == Vec2::ZERO || points.iter().any(|p| side(*p) < -1e-3) {
                continue;
            }
            let distance = -side(point);
            outside |= distance > 0.0;
            farthest_inside = farthest_inside.min(-distance);
            let t = along.dot(point - *a).clamp(0.0, (*b - *a).length());
            nearest = nearest.min((*a + t * along - point).length());
        }
    }
    if outside { nearest } else { -farthest_inside }
}

/// Where the vertices of the core of a body land in the picture, and how many pixels a metre is at
/// its centre.
fn projected(photograph: &Photograph, at: DVec3, turn: DQuat) -> (Vec<Vec2>, f32) {
    let place = |x: DVec3| photograph.camera.project(x.as_vec3()).unwrap();
    let vertices = cube().vertices;
    let points = vertices.iter().map(|v| place(at + turn * *v).0);
    (points.collect(), place(at).1)
}

#[test]
fn cubes_cover_the_pixels_of_their_bodies() {
    let Some(_studio) = studio() else {
        return;
    };
    for projection in [ProjectionKind::Orthographic, ProjectionKind::Perspective] {
        let cubes = two_cubes();
        let name = format!("cubes-{projection:?}");
        let photograph = photograph(&name, bodies(&cubes, cube()), |settings, _| {
            settings.projection = projection;
        });
        let outlines: Vec<_> = (cubes.iter())
            .map(|(at, turn, _)| projected(&photograph, *at, *turn))
            .collect();
        let mut covered = 0;
        for y in 0..SIZE.y {
            for x in 0..SIZE.x {
                let point = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let seen = photograph.covered(point);
                covered += u32::from(seen);
                // The body reaches a rounding radius beyond its core; strips and caps stay inside
                // it by up to R (1 − 1/√3). The nearer corners of a perspective are a tenth larger.
                // A pixel for the raster.
                let from_core = outlines.iter().map(|(points, pixels_per_metre)| {
                    let rounding = ROUNDING as f32 * pixels_per_metre;
                    let distance = distance_from_hull(points, point);
                    (distance - 0.57 * rounding, distance - 1.1 * rounding)
                });
                let (inner, outer) = from_core.fold((f32::MAX, f32::MAX), |least, next| {
                    (least.0.min(next.0), least.1.min(next.1))
                });
                if inner < -1.0 {
                    assert!(seen, "{projection:?}: {point} lies {inner} inside");
                }
                if outer > 1.0 {
                    assert!(!seen, "{projection:?}: {point} lies {outer} outside");
                }
            }
        }
        assert!(covered > 5000, "{covered} pixels");
    }
}

#[test]
fn cubes_have_the_colours_of_their_species() {
    let Some(_studio) = studio() else {
        return;
    };
    let cubes = two_cubes();
    let photograph = photograph("cube-species", bodies(&cubes, cube()), |_, camera| {
        camera.look_from(StandardView::Front);
    });
    for (at, _, species) in cubes {
        let seen = photograph.at(photograph.camera.project(at.as_vec3()).unwrap().0);
        let hues = [0, 1].map(|i| cosine(seen.map(f32::from), species_colour(i).map(f32::from)));
        let (own, other) = (hues[usize::from(species)], hues[1 - usize::from(species)]);
        assert!(own > 0.95 && own > other, "{at}: {seen:?}");
    }
}

#[test]
fn faces_of_a_cube_are_flat_and_differ_in_light() {
    let Some(_studio) = studio() else {
        return;
    };
    let list = [(DVec3::ZERO, DQuat::IDENTITY, 0)];
    let photograph = photograph("cube-faces", bodies(&list, cube()), |settings, camera| {
        settings.projection = ProjectionKind::Orthographic;
        (camera.yaw, camera.pitch) = (0.7, 0.5);
    });
    let face = HALF as f32 + ROUNDING as f32;
    let lights = [Vec3::X, Vec3::Y, Vec3::Z].map(|normal| {
        let (u, v) = normal.any_orthonormal_pair();
        let at = |a: f32, b: f32| {
            let x = face * normal + 0.8 * HALF as f32 * (a * u + b * v);
            photograph.at(photograph.camera.project(x).unwrap().0)
        };
        let middle = at(0.0, 0.0);
        for (a, b) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
            let off = (0..3).map(|i| at(a, b)[i].abs_diff(middle[i])).max();
            // One step of 255: rounding.
            assert!(off <= Some(1), "{normal}: {:?} {middle:?}", at(a, b));
        }
        i16::from(middle[0])
    });
    let [right, top, front] = lights;
    assert!(
        (right - front).abs() > 10 && (top - front).abs() > 10,
        "{lights:?}"
    );
}

#[test]
fn cubes_and_spheres_hide_each_other() {
    let Some(_studio) = studio() else {
        return;
    };
    // A sphere before a cube, seen along z; from the back the other way round.
    let list = [
        (DVec3::new(0.0, 0.0, 0.008), DQuat::IDENTITY, 0),
        (DVec3::new(0.0, 0.0, -0.008), DQuat::IDENTITY, 1),
    ];
    let mut world = bodies(&list, cube());
    let polyhedra = world.polyhedra.as_mut().unwrap();
    polyhedra.shapes = Arc::new([cube(), Polyhedron::sphere(HALF)]);
    polyhedra.shape[0] = 1;
    world.grains.radius[0] = HALF;
    for (side, front) in [(StandardView::Front, 0), (StandardView::Back, 1)] {
        let photograph = photograph("cube-sphere", world.clone(), |settings, camera| {
            camera.look_from(side);
            settings.projection = ProjectionKind::Orthographic;
        });
        let (middle, per_metre) = photograph.camera.project(Vec3::ZERO).unwrap();
        let seen = photograph.at(middle).map(f32::from);
        let hues = [0, 1].map(|i| cosine(seen, species_colour(i).map(f32::from)));
        assert!(hues[front] > hues[1 - front], "{side:?}: {seen:?}");
        // The cube's corner shows beside the sphere, which is not drawn as a cube.
        let corner = Vec2::splat((HALF as f32) * per_metre);
        let seen = photograph.at(middle + corner).map(f32::from);
        assert!(
            cosine(seen, species_colour(1).map(f32::from)) > 0.95,
            "{seen:?}"
        );
    }
}

#[test]
fn section_of_a_cut_cube_is_a_flat_square() {
    let Some(_studio) = studio() else {
        return;
    };
    let list = [(DVec3::ZERO, DQuat::IDENTITY, 0)];
    let photograph = photograph("cube-section", bodies(&list, cube()), |settings, camera| {
        camera.look_from(StandardView::Front);
        settings.cut = Some(Cut::Beyond {
            axis: CoordinateAxis::Z,
            position: 0.002,
        });
    });
    let at = |x: f64, y: f64| {
        let x = DVec3::new(x, y, 0.002).as_vec3();
        photograph.camera.project(x).unwrap().0
    };
    let edge = HALF + ROUNDING;
    let colour = photograph.at(at(0.0, 0.0));
    for (x, y) in [
        (1.0, 1.0),
        (-1.0, 1.0),
        (-1.0, -1.0),
        (1.0, -1.0),
        (1.0, 0.0),
    ] {
        assert_eq!(photograph.at(at(0.8 * edge * x, 0.8 * edge * y)), colour);
        assert!(!photograph.covered(at(1.05 * edge * x, 1.05 * edge * y)));
    }
    // The species' colour as the legend has it.
    let hue = cosine(colour.map(f32::from), species_colour(0).map(f32::from));
    assert!(hue > 0.9999, "{colour:?}");
}

#[test]
fn a_quarter_is_cut_out_of_cubes_and_spheres() {
    let Some(_studio) = studio() else {
        return;
    };
    for shape in [cube(), Polyhedron::sphere(HALF + ROUNDING)] {
        let list = [(DVec3::ZERO, DQuat::IDENTITY, 0)];
        let name = format!("quarter-{}", shape.faces.len());
        let photograph = photograph(&name, bodies(&list, shape), |settings, camera| {
            (camera.yaw, camera.pitch) = (0.5, 0.3);
            settings.projection = ProjectionKind::Orthographic;
            settings.cut = Some(Cut::Quarter { x: 0.0, z: 0.0 });
            // So near that the dark edge is several pixels broad.
            (camera.height, camera.fits) = (0.014, false);
            camera.focus = Vec3::ZERO;
        });
        let at = |x: f64, y: f64, z: f64| {
            let x = HALF * DVec3::new(x, y, z);
            photograph.at(photograph.camera.project(x.as_vec3()).unwrap().0)
        };
        // Both faces of the cut are seen whole, in the colour of the legend, which no light changes.
        let sections = [at(0.4, 0.0, 0.0), at(0.0, 0.0, 0.4)];
        for (x, y, z, section) in [
            (0.7, 0.0, 0.0, sections[0]),
            (0.4, 0.4, 0.0, sections[0]),
            (0.0, 0.4, 0.4, sections[1]),
            (0.0, -0.4, 0.4, sections[1]),
        ] {
            assert_eq!(at(x, y, z), section, "{name}");
        }
        assert_eq!(sections[0], sections[1], "{name}");
        let hue = cosine(sections[0].map(f32::from), species_colour(0).map(f32::from));
        assert!(hue > 0.9999, "{name}: {sections:?}");
        // The edge between them keeps 35 % of the light, which rises smoothly to all of it over 3.5 % of
        // the radius on either side, four pixels: of three pixels beside each other one has its middle
        // within half a pixel of the edge, where it is 42 % at most.
        let on_edge = Vec3::Y * 0.2 * HALF as f32;
        let (edge, pixel) = photograph.camera.project(on_edge).unwrap();
        let breadth = 0.035 * (HALF + ROUNDING) as f32 * pixel;
        assert!(breadth > 4.0, "{breadth} pixels");
        for channel in 0..3 {
            let own = |place| linear(photograph.at(place)[channel]);
            let around = [-1.0, 0.0, 1.0].map(|x| own(edge + x * Vec2::X));
            let kept = around.into_iter().fold(1.0, f64::min) / linear(sections[0][channel]);
            assert!(
                (0.34..0.42).contains(&kept),
                "{name}: {kept} of channel {channel}"
            );
        }
        // The skin left of the cut has another lightness.
        let skin = at(-0.5, 0.0, 0.9);
        assert!(!sections.contains(&skin), "{name}");
    }
}

/// The light of a channel of a pixel, 0 … 1.
fn linear(shown: u8) -> f64 {
    let shown = f64::from(shown) / 255.0;
    if shown <= 0.04045 {
        shown / 12.92
    } else {
        ((shown + 0.055) / 1.055).powf(2.4)
    }
}

/// A column of cubes on a floor, with a tube whose lower rim is at `rim` [m].
fn column(rim: f64) -> World {
    let (radius, height) = (0.025, 0.04);
    let edge = 2.0 * (HALF + ROUNDING);
    let mut list = Vec::new();
    for i in -2..=2 {
        for j in -2..=2 {
            for k in 0..4 {
                let turn = DQuat::from_rotation_y(f64::from(i * 7 + j * 3 + k));
                let x = 1.02 * edge * DVec3::new(f64::from(i), f64::from(k) + 0.5, f64::from(j));
                if x.x.hypot(x.z) < radius - edge / 2.0 {
                    list.push((x, turn, u16::from((i + j + k) % 3 == 0)));
                }
            }
        }
    }
    let floor = Surface::Plane {
        point: DVec3::ZERO,
        normal: DVec3::Y,
    };
    let mut world = bodies(&list, cube());
    let walls = vec![floor, Surface::Tube { radius, rim }];
    world.container = crate::view::world(Shape::Column { radius, height }, walls).container;
    world
}

#[test]
fn floor_marks_where_a_column_stood_and_there_is_room_for_it_to_spread() {
    let Some(_studio) = studio() else {
        return;
    };
    let mut world = column(0.0);
    world.container.walls.truncate(1);
    let photograph = photograph("column", world, |_, _| {});
    let place = |x: f32, y: f32, z: f32| {
        let place = photograph.camera.project(Vec3::new(x, y, z)).unwrap().0;
        assert!(place.cmpgt(Vec2::ZERO).all() && place.cmplt(SIZE.as_vec2()).all());
        place
    };
    // Red exceeds blue only at the mark, all round the side that faces the viewer.
    for turn in [0.0, 0.4, 0.8, 1.2] {
        let (sin, cos) = (turn as f32).sin_cos();
        let warmth = |radius: f32| {
            // The circle is about a pixel wide.
            let seen = |off: f32| {
                let [red, _, blue] = photograph.at(place(radius * sin, 0.0, radius * cos) + off);
                i16::from(red) - i16::from(blue)
            };
            [-1.0, 0.0, 1.0].map(seen).into_iter().max().unwrap()
        };
        assert!(warmth(0.025) > 10, "{turn}: {}", warmth(0.025));
        assert!(warmth(0.0275) < 0, "{turn}: {}", warmth(0.0275));
    }
    // A height of 1.6 radii runs out by 1.6^1.35 = 1.9 of them.
    for (x, z) in [(0.07, 0.0), (-0.07, 0.0), (0.0, 0.07), (0.0, -0.07)] {
        place(x, 0.0, z);
    }
    place(0.0, 0.04, 0.0);
}

#[test]
fn tube_rises_and_shows_what_is_inside() {
    let Some(_studio) = studio() else {
        return;
    };
    for rim in [0.0_f32, 0.03] {
        let world = column(f64::from(rim));
        let photograph = photograph(&format!("tube-{rim}"), world, |settings, camera| {
            camera.look_from(StandardView::Front);
            settings.projection = ProjectionKind::Orthographic;
        });
        let at = |x: f32, y: f32| {
            let x = Vec3::new(x, y, 0.025);
            photograph
                .at(photograph.camera.project(x).unwrap().0)
                .map(f32::from)
        };
        // The hoop at its lower end is a bluish grey, unlike the species' amber and blue.
        let is_hoop =
            |[red, green, blue]: [f32; 3]| green > 80.0 && (15.0..60.0).contains(&(blue - red));
        let heights = (0..300).map(|i| 2e-4 * i as f32);
        let lowest = heights.clone().find(|y| is_hoop(at(0.0, *y)));
        // Two pixels: the hoop is no taller than three.
        assert!(
            lowest.is_some_and(|y| (y - rim).abs() < 5e-4),
            "{rim}: {lowest:?}"
        );
        // Between its hoops one looks through the near side.
        let seen = at(0.0, 0.034);
        let hue = [0, 1].map(|i| cosine(seen, species_colour(i).map(f32::from)));
        assert!(
            hue[0].max(hue[1]) > 0.9,
            "a grain in the tube looks {seen:?}"
        );
    }
}
