//! Profile of the flowing layer, curvature of the surface, torque of the drum, numbers of the
//! liquid.

use super::*;
use glam::DVec2;
use grainfall::measure::{
    Estimate, FlowDepth, FlowHistory, FlowingLayer, MIDDLE_SHARE, MeanFlow, Measure, RunQuantity,
    Series, capillary_number, drop_ratio_law, drum_torque, galilei_number, mean_velocity, results,
    sample, sample_and_surface, surface_line,
};
use grainfall::physics::LIQUID_CASES;

const RADIUS: f64 = 0.0605;
const WIDTH: f64 = 0.022;
const GRAIN: f64 = 0.002;

/// A closed lattice whose surface is tilted by `angle` and whose top grains lie `bulge(s)` above
/// the plane at distance s from the middle.
fn bed(angle: f64, bulge: impl Fn(f64) -> f64) -> World {
    let mut world = drum(RADIUS, WIDTH, 0.0);
    let along = DVec2::from_angle(angle);
    for x in lattice_in_drum(RADIUS, WIDTH, 2.0 * GRAIN, angle, -0.01) {
        let lift = along.perp() * bulge(x.truncate().dot(along));
        push(&mut world, x + lift.extend(0.0), GRAIN);
    }
    world
}

#[test]
fn curvature_is_that_of_a_parabola_and_none_of_a_plane() {
    for angle in [-0.4, 0.0, 0.5] {
        let flat = surface_line(&bed(angle, |_| 0.0), MIDDLE_SHARE).unwrap();
        assert_close(flat.curvature, 0.0, 1e-6);
        for curvature in [2.0, -1.5] {
            let world = bed(angle, |s| -0.5 * curvature * s * s);
            let line = surface_line(&world, MIDDLE_SHARE).unwrap();
            assert_close(line.curvature, curvature, 0.01);
            assert_close(line.angle, angle, 1e-3);
        }
    }
}

#[test]
fn profile_of_a_sheared_bed_is_its_shear() {
    // Velocity along the surface falls linearly with depth; a Gaussian mean of a line is the line where grains lie all
    // round. Fluctuations make the bed count as flowing.
    let angle = 0.4_f64;
    let (along, up) = (DVec2::from_angle(angle), DVec2::from_angle(angle).perp());
    let mut world = bed(angle, |_| 0.0);
    let line = surface_line(&world, MIDDLE_SHARE).unwrap();
    let mut noise = Noise::new(3);
    for i in 0..world.grains.len() {
        let depth = -(world.grains.position[i].truncate() - line.midpoint).dot(up);
        let jitter = 1e-3 * noise.vector();
        world.grains.velocity[i] = (along * (0.1 - 2.0 * depth)).extend(0.0) + jitter;
    }
    let (sample, line) = sample_and_surface(&world);
    let mut history = FlowHistory::default();
    history.add(&world, &sample, &line.unwrap());
    let profile = history.since(0.0);
    let velocity = history.velocity_since(0.0);
    let mut compared = 0;
    for (depth, velocity) in profile.depth.iter().zip(&velocity) {
        // A kernel's reach away from the surface and from the rim.
        if (0.012..0.028).contains(depth) {
            assert_close(velocity.mean, 0.1 - 2.0 * depth, 1.5e-3);
            compared += 1;
        }
    }
    assert!(compared > 8, "{compared}");
    // One second is one event.
    assert!(velocity[8].error.is_none() && velocity[8].samples == 1);
}

#[test]
fn a_history_that_goes_on_shares_all_but_its_last_second_with_the_one_it_follows() {
    let mut world = bed(0.4, |_| 0.0);
    let mut noise = Noise::new(5);
    let mut history = FlowHistory::default();
    let mut add = |history: &mut FlowHistory, time: f64| {
        let speed = 0.01 / (1.0 + time);
        (world.grains.velocity.iter_mut()).for_each(|v| *v = speed * noise.vector());
        let (mut sample, line) = sample_and_surface(&world);
        sample.time = time;
        history.add(&world, &sample, &line.unwrap());
    };
    (0..20).for_each(|second| add(&mut history, f64::from(second)));
    let places = |history: &FlowHistory| -> Vec<usize> {
        history.shared_parts().map(|(place, _)| place).collect()
    };
    let (before, earlier) = (places(&history), history.clone());
    // Nineteen seconds that are over, and a map of each, as each is stiller than the one before.
    assert_eq!(before.len(), 19 + 20);
    add(&mut history, 19.5);
    assert!(places(&history).starts_with(&before));
    assert_ne!(history, earlier);
    let shared: usize = history.shared_parts().map(|(_, bytes)| bytes).sum();
    assert!(history.own_memory() < shared / 20, "{shared}");
    // What a file holds is what it held when nothing was shared.
    let bytes = postcard::to_stdvec(&history).unwrap();
    let read: FlowHistory = postcard::from_bytes(&bytes).unwrap();
    assert_eq!(read, history);
}

#[test]
fn rest_is_not_averaged_and_time_before_the_window_neither() {
    let mut world = bed(0.3, |_| 0.0);
    let mut history = FlowHistory::default();
    let (still, line) = sample_and_surface(&world);
    history.add(&world, &still, &line.unwrap());
    assert!(
        history.since(0.0).depth.is_empty(),
        "a bed at rest does not flow"
    );
    let mut noise = Noise::new(1);
    for velocity in &mut world.grains.velocity {
        *velocity = noise.vector() * 1e-2;
    }
    let (moving, line) = sample_and_surface(&world);
    history.add(&world, &moving, &line.unwrap());
    assert_eq!(history.since(0.0).samples[0], 1);
    assert!(history.since(0.5).depth.is_empty(), "it all came before");
}

#[test]
fn mean_velocity_weighs_near_grains_more() {
    let mut world = drum(RADIUS, WIDTH, 0.0);
    push(&mut world, DVec3::ZERO, GRAIN);
    push(&mut world, DVec3::X * 0.004, GRAIN);
    push(&mut world, DVec3::X * 0.02, GRAIN);
    let velocities = vec![DVec3::X, DVec3::Y, DVec3::ONE * 100.0];
    world.grains.velocity.set(velocities);
    let found = mean_velocity(&world, DVec2::ZERO, 0.008).unwrap();
    // One standard deviation away weighs e^-1/2; beyond two nothing does.
    let weight = (-0.5_f64).exp();
    assert_close(found.x, 1.0 / (1.0 + weight), 1e-12);
    assert_close(found.y, weight / (1.0 + weight), 1e-12);
    assert!(mean_velocity(&world, DVec2::Y * 0.05, 0.008).is_none());
}

#[test]
fn torque_of_the_drum_holds_the_weight_of_its_grains() {
    // A grain at rest on the rim at 30°, carried by a normal force and friction: the torque is m g x.
    let mut world = drum(RADIUS, WIDTH, 0.0);
    let place = DVec2::from_angle(-60_f64.to_radians()) * (RADIUS - GRAIN);
    push(&mut world, place.extend(0.0), GRAIN);
    let weight = world.grains.mass[0] * 9.81;
    touch(&mut world, 0, Partner::Wall(0), DVec3::ZERO);
    world.contacts[0].force = DVec3::Y * weight;
    let rim = place.length() + GRAIN;
    let arm = rim * 60_f64.to_radians().cos();
    assert_close(drum_torque(&world), weight * arm, 1e-12 * weight);
}

#[test]
fn numbers_of_the_liquid_are_the_papers() {
    let mut world = drum(RADIUS, WIDTH, 0.0);
    push(&mut world, DVec3::ZERO, 1.25e-3);
    assert_eq!(galilei_number(&world), None, "dry");
    assert!(sample(&world).value(Measure::Bridges) == 0.0);
    let inverse_roots = [0.0029, 0.315, 0.633, 1.061, 1.511, 2.713, 4.075];
    for (case, expected) in LIQUID_CASES.iter().zip(inverse_roots) {
        world.liquid = Some(case.liquid());
        let found = galilei_number(&world).unwrap().powf(-0.5);
        assert_close(found, expected, 1e-3 * expected + 6e-5);
    }
    assert_close(capillary_number(&world).unwrap(), 6.39, 0.06);
    // Eq. 23 at n = 1 … 7.
    let law = [0.868, 0.725, 0.624, 0.536, 0.480, 0.420, 0.404];
    for (case, expected) in LIQUID_CASES.iter().zip(law) {
        assert_close(drop_ratio_law(case.viscosity), expected, 1e-3);
    }
}

#[test]
fn the_flowing_layer_ends_where_grains_go_up_with_the_drum() {
    let of = |velocities: &[f64]| {
        let depths = velocities
            .iter()
            .enumerate()
            .map(|(k, velocity)| FlowDepth {
                depth: 0.002 * k as f64,
                velocity: *velocity,
                error: None,
                samples: u32::from(velocity.is_finite()),
            });
        let depths = depths.collect();
        MeanFlow { depths }.layer_depth()
    };
    // 9 mm/s down in 4 mm, 3 mm/s up in 6 mm: three quarters of the way.
    let depth = of(&[-0.1, -0.05, -0.009, 0.003, 0.004]).unwrap();
    assert_close(depth, 0.0055, 1e-15);
    // A layer that flows to the other side; depths without samples are left out.
    assert_close(of(&[0.1, f64::NAN, -0.1]).unwrap(), 0.002, 1e-15);
    assert_eq!(of(&[-0.1, -0.05, -0.01]), None, "it flows all the way down");
    assert_eq!(of(&[]), None);
}

#[test]
fn speed_and_depth_of_the_layer_carry_the_errors_of_the_velocities() {
    let known = |mean: f64, error: f64, freedom| Estimate {
        mean,
        error: Some(error),
        samples: freedom + 1,
        freedom,
    };
    // 9 ± 1 mm/s down in 4 mm, 3 ± 0.5 up in 6: ± 0.625 mm/s in 5.5 mm, where velocity changes by
    // 6 mm/s a millimetre.
    let profile = [
        (0.0, known(-0.05, 2e-3, 20)),
        (0.004, known(-0.009, 1e-3, 20)),
        (0.006, known(0.003, 5e-4, 12)),
        (0.008, known(0.004, 1e-4, 9)),
    ];
    let layer = FlowingLayer::of(&profile).unwrap();
    assert_eq!(layer.speed, known(0.05, 2e-3, 20));
    let depth = layer.depth.unwrap();
    assert_close(depth.mean, 0.0055, 1e-15);
    assert_close(depth.error.unwrap(), 0.625e-3 / 6.0, 1e-15);
    assert_eq!((depth.samples, depth.freedom), (13, 12));
    assert_eq!(FlowingLayer::of(&profile[..2]).unwrap().depth, None);
    assert_eq!(FlowingLayer::of(&[]), None);
    // Without the error of one there is none.
    let single = [profile[1], (0.006, Estimate::too_short(0.003, 3))];
    let depth = FlowingLayer::of(&single).unwrap().depth.unwrap();
    assert_eq!((depth.error, depth.samples), (None, 3));
}

#[test]
fn results_tell_speed_and_depth_of_the_part_that_counts() {
    // Below the surface velocity falls by 4 mm/s a millimetre from a speed that is another in each
    // second: the layer ends where it is zero.
    let angle = 0.4_f64;
    let (along, up) = (DVec2::from_angle(angle), DVec2::from_angle(angle).perp());
    let mut world = bed(angle, |_| 0.0);
    let line = surface_line(&world, MIDDLE_SHARE).unwrap();
    let (mut history, mut series) = (FlowHistory::default(), Series::default());
    let mut noise = Noise::new(3);
    for second in 0..30 {
        for i in 0..world.grains.len() {
            let depth = -(world.grains.position[i].truncate() - line.midpoint).dot(up);
            let speed = 0.06 + 0.002 * f64::from(second % 3) - 4.0 * depth;
            let jitter = 1e-3 * noise.vector();
            world.grains.velocity[i] = (-along * speed).extend(0.0) + jitter;
        }
        let (mut sample, line) = sample_and_surface(&world);
        (sample.step, sample.time) = (second as u64, f64::from(second));
        history.add(&world, &sample, &line.unwrap());
        series.push(sample);
    }
    let depth_and_error = |from: f64| {
        let found = results(&series, &history, &world, from, 0.01);
        let depth = found.estimate(RunQuantity::FlowDepth).unwrap();
        let speed = found.estimate(RunQuantity::FlowSpeed).unwrap();
        // Near the surface a kernel sees no grains above: the mean is that of grains further down.
        assert!((0.02..0.06).contains(&speed.mean), "{speed:?}");
        (depth.mean, depth.error)
    };
    // 62 mm/s on the mean over 4 mm/s a millimetre: 15.5 mm. Speeds of 60, 62 and 64 mm/s, ten of
    // each, scatter by 1.66: 0.3 mm/s of the mean, 0.076 mm of the depth.
    let (mean, error) = depth_and_error(0.0);
    assert_close(mean, 0.0155, 3e-4);
    assert_close(error.unwrap(), 7.6e-5, 1.5e-5);
    // Of the last second alone, of 64 mm/s, nothing is known of the scatter.
    let (mean, error) = depth_and_error(29.0);
    assert_close(mean, 0.016, 3e-4);
    assert_eq!(error, None);
    // Of a bed that did not flow there is neither.
    let still = results(&series, &FlowHistory::default(), &world, 0.0, 0.01);
    assert_eq!(still.get(RunQuantity::FlowDepth), None);
}
