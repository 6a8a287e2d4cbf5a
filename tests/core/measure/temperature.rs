//! Granular temperature of velocities whose spread is known.

use super::*;
use grainfall::measure::{
    FlowHistory, Regime, RunQuantity, Series, granular_temperatures, results, rotation_temperature,
    sample, temperature_map,
};

/// 0.5 rpm.
const SPEED: f64 = 0.052_359_877_559_829_88;

fn turn_rigidly(world: &mut World, speed: f64) {
    let spin = DVec3::new(0.0, 0.0, speed);
    let grains = &mut world.grains;
    for (v, x) in grains.velocity.iter_mut().zip(&grains.position) {
        *v = spin.cross(*x);
    }
}

/// A bed of the paper's drum: a face-centred cubic lattice as thin as a settled bed (φ = 0.6),
/// shaken so that no two grains have the same surroundings.
fn shaken_bed(radius: f64) -> World {
    let mut world = drum(0.0605, 0.022, SPEED);
    let mut noise = Noise::new(1);
    let distance = 2.0 * radius * (0.74 / 0.6_f64).cbrt();
    let step = distance / 2.0_f64.sqrt();
    let turn = glam::DQuat::from_rotation_z(0.5);
    let cells = (0.0605 / step) as i32 + 1;
    for (i, j, k) in (-cells..=cells)
        .flat_map(|i| (-cells..=cells).flat_map(move |j| (-cells..=cells).map(move |k| (i, j, k))))
        .filter(|(i, j, k)| (i + j + k) % 2 == 0)
    {
        let x = turn * (step * DVec3::new(f64::from(i), f64::from(j), f64::from(k)));
        let below_surface = (turn.inverse() * x).y < -0.017 - radius;
        let inside = x.truncate().length() < 0.0605 - radius && x.z.abs() < 0.011 - radius;
        if below_surface && inside {
            push(&mut world, x + 0.1 * radius * noise.vector(), radius);
        }
    }
    world
}

#[test]
fn two_grains_that_turn_have_the_temperature_of_their_distance() {
    let (r, d) = (0.003, 0.0065);
    let mut world = drum(0.0605, 0.022, SPEED);
    push(&mut world, DVec3::new(0.01, -0.03, 0.0), r);
    push(&mut world, DVec3::new(0.01 + d, -0.03, 0.0), r);
    turn_rigidly(&mut world, SPEED);
    let found = granular_temperatures(&world);
    // U = Ω d for both, so Tg = (Ω d)²/3; relative rounding of the difference of two velocities.
    assert_close(found.laboratory / ((SPEED * d).powi(2) / 3.0), 1.0, 1e-12);
    assert!(found.corotating < 1e-30);
}

#[test]
fn rigid_rotation_leaves_the_known_floor_in_the_laboratory_and_none_in_the_drum() {
    // Measured in settled beds; a shaken lattice has other surroundings at walls and surface, hence the factor of two.
    for (radius, floor) in [(0.003, 1.8e-9), (0.002, 6.1e-10)] {
        let mut world = shaken_bed(radius);
        turn_rigidly(&mut world, SPEED);
        let found = granular_temperatures(&world);
        let ratio = found.laboratory / floor;
        assert!(
            (0.5..2.0).contains(&ratio),
            "{} / {floor}",
            found.laboratory
        );
        // Rounding: (1e-16 of 3 mm/s)².
        assert!(found.corotating < 1e-30);
    }
}

#[test]
fn a_bed_at_rest_in_a_fast_drum_flows_for_the_paper_and_not_for_the_drum() {
    // 2 rpm: sixteen times the floor of the paper's speed.
    let mut world = shaken_bed(0.003);
    world.container.set_drum_speed(4.0 * SPEED);
    turn_rigidly(&mut world, 4.0 * SPEED);
    let floor = granular_temperatures(&world).laboratory;
    assert_close(rotation_temperature(&world) / floor, 1.0, 1e-12);
    let mut series = Series::default();
    for step in 0..50 {
        let mut state = sample(&world);
        state.time = 0.02 * f64::from(step);
        series.push(state);
    }
    let found = results(&series, &FlowHistory::default(), &world, 0.0, 0.01);
    assert_eq!(found.value(RunQuantity::NonRigidShare), Some(1.0));
    assert_eq!(found.value(RunQuantity::CorotatingShare), Some(0.0));
    assert_eq!(found.regime(), Some(Regime::Avalanching));
    let note = found.rotation_note().expect("rotation passes the line");
    assert!(
        note.contains("passes the paper's line of 2.00·10⁻⁹ m²/s²"),
        "{note}"
    );
    // A bed of smaller grains at the paper's speed says nothing.
    let mut slow = shaken_bed(0.002);
    turn_rigidly(&mut slow, SPEED);
    assert_eq!(
        results(&series, &FlowHistory::default(), &slow, 0.0, 0.01).rotation_note(),
        None
    );
}

#[test]
fn clouds_that_drift_apart_have_the_temperature_of_their_spread() {
    let (r, spread) = (0.001, 0.02);
    let mut world = on_floor();
    let mut noise = Noise::new(2);
    let (side, mut expected) = (16, 0.0);
    for (cloud, drift) in [(0.0, DVec3::X), (1.0, -3.0 * DVec3::Y)] {
        for i in 0..side * side * side {
            let at = [i % side, i / side % side, i / (side * side)];
            let x = DVec3::from(at.map(|k| f64::from(k) * 2.0 * r)) + cloud * DVec3::Z;
            push(&mut world, x, r);
            let n = world.grains.len() - 1;
            let fluctuation = DVec3::new(noise.normal(), noise.normal(), noise.normal());
            world.grains.velocity[n] = drift + spread * fluctuation;
            // Six neighbours at 2 r inside, one less for each face the grain lies on; the next are at 2.8 r.
            let faces = at.iter().filter(|k| **k == 0 || **k == side - 1).count();
            expected += spread * spread * (1.0 + 1.0 / (6.0 - faces as f64));
        }
    }
    expected /= world.grains.len() as f64;
    let found = granular_temperatures(&world).laboratory;
    // 8192 grains with three components each, neighbours correlated: standard error near 1.1 %; four of them.
    assert_close(found / expected, 1.0, 0.045);
}

#[test]
fn cell_grid_finds_the_neighbours_that_trying_all_pairs_finds() {
    let mut world = drum(0.05, 0.05, 0.7);
    let mut noise = Noise::new(3);
    for _ in 0..600 {
        push(
            &mut world,
            0.02 * noise.vector(),
            0.001 + 0.001 * noise.unit(),
        );
        let n = world.grains.len() - 1;
        world.grains.velocity[n] = noise.vector();
    }
    let (laboratory, corotating) = by_all_pairs(&world);
    let found = granular_temperatures(&world);
    // The same terms summed in another order: rounding of some 600 additions.
    assert_close(found.laboratory / laboratory, 1.0, 1e-12);
    assert_close(found.corotating / corotating, 1.0, 1e-12);
}

fn by_all_pairs(world: &World) -> (f64, f64) {
    let grains = &world.grains;
    let spin = DVec3::new(0.0, 0.0, world.container.drum_speed());
    let temperature = |velocity: &dyn Fn(usize) -> DVec3| {
        let (mut sum, mut count) = (0.0, 0);
        for i in 0..grains.len() {
            let near = |j: &usize| {
                let reach = 7.0 / 6.0 * (grains.radius[i] + grains.radius[*j]);
                *j != i && grains.position[i].distance(grains.position[*j]) < reach
            };
            let neighbours: Vec<usize> = (0..grains.len()).filter(near).collect();
            if !neighbours.is_empty() {
                let mean = neighbours.iter().map(|j| velocity(*j)).sum::<DVec3>();
                sum += (velocity(i) - mean / neighbours.len() as f64).length_squared();
                count += 1;
            }
        }
        sum / f64::from(3 * count)
    };
    (
        temperature(&|i| grains.velocity[i]),
        temperature(&|i| grains.velocity[i] - spin.cross(grains.position[i])),
    )
}

#[test]
fn grain_without_neighbours_does_not_count() {
    let mut world = drum(0.0605, 0.022, 0.0);
    push(&mut world, DVec3::ZERO, 0.001);
    assert!(granular_temperatures(&world).laboratory.is_nan());

    push(&mut world, DVec3::X * 0.002, 0.001);
    push(&mut world, DVec3::X * 0.05, 0.001);
    world.grains.velocity[1] = DVec3::Y * 0.3;
    world.grains.velocity[2] = DVec3::Y * 100.0;
    // U = 0.3 m/s for the first two; the third is left out.
    assert_close(granular_temperatures(&world).laboratory, 0.03, 1e-15);
}

#[test]
fn a_cell_has_the_temperature_of_the_grains_in_it() {
    let (r, d, v) = (0.003, 0.0065, 0.02);
    let mut world = drum(0.0605, 0.022, SPEED);
    // Three in a row along the axis, in one cell of 12 mm; the same elsewhere; and two only.
    for (x, count) in [(0.003, 3), (-0.021, 3), (0.027, 2)] {
        for k in 0..count {
            let z = d * (f64::from(k) - 1.0);
            push(&mut world, DVec3::new(x, -0.03, z), r);
        }
    }
    turn_rigidly(&mut world, SPEED);
    world.grains.velocity[0] += v * DVec3::Z;
    let map = temperature_map(&world).unwrap();
    assert!((map.spacing / (4.0 * r) - 1.0).abs() < 1e-15);
    let [(left, still), (right, moved)] = map.cells().collect::<Vec<_>>()[..] else {
        panic!("two cells of three grains: {map:?}");
    };
    assert!(left.x <= -0.021 && -0.021 < left.x + map.spacing, "{left}");
    assert!(right.x <= 0.003 && 0.003 < right.x + map.spacing, "{right}");
    assert!(still < 1e-30, "rotation is none: {still}");
    // U is v of the first, −v/2 of the middle one, 0 of the third: Σ|U|²/3 = 5 v²/12, over three.
    assert_close(moved / (5.0 * v * v / 36.0), 1.0, 1e-12);
    assert_eq!(temperature_map(&drum(0.0605, 0.022, SPEED)), None);
}
