//! Claims about ghosts: grains that are drawn smaller are seen at full size round what lies between
//! them, the same in whatever order they are drawn.

use crate::view::{Photograph, photograph, studio, world};
use bevy::math::Vec2;
use glam::DVec3;
use grainfall::measure::GrainQuantity;
use grainfall::world::{Shape, SpeciesId, World};
use grainfall_app::view::{Background, ColourBy, ColourRange, ProjectionKind, ViewSettings};

const RADIUS: f64 = 6e-3;

/// Grains one behind the other and beside each other, in this order.
fn grains(order: [usize; 4]) -> World {
    let mut world = world(Shape::Planes, Vec::new());
    let places = [
        (-0.012, 0.0, 0.0, 0.1),
        (-0.008, 0.002, -0.02, 0.9),
        (0.012, 0.0, 0.0, 0.6),
        (0.016, -0.003, 0.02, 0.3),
    ];
    for (x, y, z, speed) in order.map(|i| places[i]) {
        let place = DVec3::new(x, y, z);
        world
            .grains
            .push_sphere(place, RADIUS, 2500.0, SpeciesId(0));
        *world.grains.velocity.last_mut().unwrap() = DVec3::new(speed, 0.0, 0.0);
    }
    world
}

fn picture(name: &str, order: [usize; 4], set: impl Fn(&mut ViewSettings)) -> Photograph {
    photograph(name, grains(order), |settings, camera| {
        camera.yaw = 0.0;
        camera.pitch = 0.0;
        settings.projection = ProjectionKind::Orthographic;
        // Grains of a kind differ a little by their number.
        settings.colour_by = ColourBy::Quantity(GrainQuantity::Speed);
        settings.range = ColourRange::Fixed(0.0, 1.0);
        settings.grain_size = 0.4;
        settings.show_forces = true;
        set(settings);
    })
}

/// Sum of the differences of the three channels.
fn apart(a: [u8; 3], b: [u8; 3]) -> u32 {
    (0..3).map(|i| u32::from(a[i].abs_diff(b[i]))).sum()
}

#[test]
fn ghosts_reach_as_far_as_the_grains_do_on_any_background() {
    let Some(_studio) = studio() else {
        return;
    };
    for background in [Background::Dark, Background::Light] {
        let of = |name: &str, ghosts: Option<bool>| {
            picture(
                &format!("{name}-{background:?}"),
                [0, 1, 2, 3],
                |settings| {
                    settings.show_ghosts = ghosts;
                    settings.background = background;
                },
            )
        };
        let (with, without) = (of("ghosts", None), of("no-ghosts", Some(false)));
        let (centre, per_metre) = with
            .camera
            .project(grains([0, 1, 2, 3]).grains.position[0].as_vec3())
            .unwrap();
        let radius = RADIUS as f32 * per_metre;
        let differ = |share: f32| {
            let place = centre - Vec2::new(share * radius, 0.0);
            apart(with.at(place), without.at(place))
        };
        assert!(differ(0.97) > 30, "{background:?}: {}", differ(0.97));
        assert!(
            (1..90).contains(&differ(0.6)),
            "{background:?}: {}",
            differ(0.6)
        );
        assert_eq!(differ(1.05), 0, "{background:?}");
        // The small grain itself stays in sight.
        assert!(apart(with.at(centre), without.at(centre)) < 40);
    }
}

#[test]
fn ghosts_look_the_same_in_whatever_order_they_are_drawn() {
    let Some(_studio) = studio() else {
        return;
    };
    let [one, other] = [[0, 1, 2, 3], [3, 1, 0, 2]].map(|order| {
        let name = format!("ghosts-in-order-{}", order[0]);
        picture(&name, order, |_| {})
    });
    let size = crate::view::SIZE;
    let mut sum = 0;
    for y in 0..size.y {
        for x in 0..size.x {
            let place = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
            let difference = apart(one.at(place), other.at(place));
            // Where ghosts hid each other it would be that of a rim, some 150.
            assert!(difference < 30, "{place}: {difference}");
            sum += difference;
        }
    }
    // Each of the sums may round otherwise.
    assert!(sum < size.x * size.y / 20, "{sum}");
}
