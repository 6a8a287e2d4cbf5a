//! Benchmarks 1 to 3 of Chung and Ooi 2011, Granular Matter 13, 643–656, doi
//! 10.1007/s10035-011-0277-0.
//!
//! Each tolerance is half of the last printed digit. A rigid plane is one whose E* is that of the
//! sphere alone: sphere and plane each get twice the sphere's modulus.

use super::impact::Shot;
use super::*;

fn material(modulus: f64, ratio: f64, density: f64, restitution: f64) -> String {
    format!(
        "youngs_modulus: {modulus:e}, poisson_ratio: {ratio}, density: {density}, restitution: {restitution}, friction: 0.35"
    )
}

#[test]
fn benchmark_1_two_elastic_spheres() {
    for (modulus, ratio, density, force, overlap, time) in [
        (48e9, 0.20, 2800.0, 10_697.0, 274.1e-6, 40.3e-6),
        (20e9, 0.25, 2500.0, 7108.0, 368.3e-6, 54.2e-6),
    ] {
        let shot = Shot {
            material: material(modulus, ratio, density, 1.0),
            law: "HertzMindlin",
            radius: 0.01,
            speed: 20.0,
            at_wall: false,
        };
        let impact = shot.fired(time / 10_000.0);
        assert_relative("peak force", impact.force, force, 0.5 / force);
        assert_relative("overlap", impact.overlap, overlap, 0.05e-6 / overlap);
        assert_relative("contact time", impact.time, time, 0.05e-6 / time + 2e-4);
    }
}

#[test]
fn benchmark_2_elastic_sphere_on_a_rigid_plane() {
    for (modulus, ratio, density, force, overlap, time) in [
        (70e9, 0.30, 2699.0, 11_370.0, 49.72e-6, 0.732e-3),
        (40e9, 0.35, 1800.0, 7233.0, 52.12e-6, 0.767e-3),
    ] {
        let shot = Shot {
            material: material(2.0 * modulus, ratio, density, 1.0),
            law: "HertzMindlin",
            radius: 0.1,
            speed: 0.2,
            at_wall: true,
        };
        let impact = shot.fired(time / 10_000.0);
        assert_relative("peak force", impact.force, force, 0.5 / force);
        assert_relative("overlap", impact.overlap, overlap, 0.005e-6 / overlap);
        assert_relative("contact time", impact.time, time, 0.5e-6 / time + 2e-4);
    }
}

#[test]
fn benchmark_3_damped_sphere_on_a_rigid_plane() {
    for (modulus, ratio, density, force) in
        [(380e9, 0.23, 4000.0, 615.4), (100e9, 0.25, 7000.0, 506.8)]
    {
        // A restitution of nothing is no impact: scenes refuse it.
        for restitution in [0.01, 0.2, 0.4, 0.6, 0.8, 1.0] {
            let shot = Shot {
                material: material(2.0 * modulus, ratio, density, restitution),
                law: "HertzMindlin",
                radius: 2.5e-3,
                speed: 3.9,
                at_wall: true,
            };
            let impact = shot.fired(1e-9);
            let rebound = impact.after.grains.velocity[0].x / 3.9;
            // About 6000 steps per contact, an error of first order in the step.
            assert_relative("rebound", rebound, restitution, 5e-4 / restitution);
            if restitution == 1.0 {
                assert_relative("peak force", impact.force, force, 0.05 / force);
            }
        }
    }
}
