//! A contact law of one's own: two grains collide by it, and bounce as its closed form says.
//!
//! The law is that of a blunt cone pressed into a plane (Sneddon 1965): the force grows with the
//! square of the overlap, `F = K δ²`. It is compiled into the solver's pair loop like the built-in
//! laws are. A law that proves itself becomes a built-in one by moving its file to
//! `src/physics/law/`, with a line in the list there and a key in `src/scene/file/`.
//!
//! ```sh
//! cargo run -p grainfall-core --example own_force_law
//! ```

use grainfall::lanes::{Lanes, Row};
use grainfall::physics::law::{
    Circumstances, Coefficients, Law, LawFacts, LawWords, Pairing, SmallestGrain, StepLimit,
};
use grainfall::physics::{Integrator, Materials};
use grainfall::scene::Scene;
use grainfall::solver::Solver;
use grainfall::world;
use std::error::Error;

/// `F = K δ²` along the normal, a linear spring with Coulomb's bound across it, no dashpots.
#[derive(Clone, Copy, Debug)]
struct BluntCone {
    /// `K` [N/m²].
    normal: f64,
    /// `K_t` [N/m].
    tangential: f64,
}

/// What the pair loop computes, for as many pairs side by side as the processor has lanes. Nothing
/// but + − × ÷ √ may appear here: so the law has the same bits on any machine.
impl Law for BluntCone {
    /// Stiffness is force over overlap: `k_n = K δ`.
    #[inline(always)]
    fn coefficients<N: Lanes>(self, constants: [N; 4], overlap: N) -> Coefficients<N> {
        let [
            normal,
            normal_damping,
            tangential_stiffness,
            tangential_damping,
        ] = constants;
        Coefficients {
            normal_stiffness: normal * overlap,
            normal_damping,
            tangential_stiffness,
            tangential_damping,
        }
    }

    /// The normal force from its elastic part and the dashpot's, which is none here.
    #[inline(always)]
    fn normal_force<N: Lanes>(self, elastic: N, damping: N, _zero: N) -> N {
        elastic + damping
    }

    /// What bounds friction: the elastic part.
    #[inline(always)]
    fn coulomb_force<N: Lanes>(self, elastic: N, _normal: N, _zero: N) -> N {
        elastic
    }
}

/// What the law says of itself outside of the pair loop.
impl LawFacts for BluntCone {
    /// The constants of a pair in the order of [`Coefficients`]: computed once per kind of pair.
    fn constants(&self, _pairing: &Pairing, _materials: &Materials) -> Row {
        [self.normal, 0.0, self.tangential, 0.0]
    }

    /// `∫ K δ² dδ = ⅓ k_n δ²`.
    fn stored_share(&self) -> f64 {
        1.0 / 3.0
    }

    /// An impact at speed `v` reaches `δ = (3 m* v²/(2K))^⅓` and lasts about three times `δ/v`.
    fn step_limits(&self, grain: &SmallestGrain, at: &Circumstances) -> Vec<StepLimit> {
        let depth = self.deepest(0.5 * grain.mass(), at.impact_speed);
        let time = 3.0 * depth / at.impact_speed;
        vec![StepLimit {
            name: "blunt cone",
            time_step: time / 200.0,
            reason: format!("1/200 of the {time:.2e} s that an impact lasts"),
        }]
    }

    fn words(&self) -> LawWords {
        LawWords {
            name: "blunt cone",
            friction: "|F_t| ≤ μ K δ²",
            restitution: "no dashpots: e = 1",
        }
    }

    fn uses_elastic_constants(&self) -> bool {
        false
    }
}

impl BluntCone {
    /// Overlap at which a reduced mass [kg] that comes at this speed [m/s] turns round [m]:
    /// `½ m* v² = ⅓ K δ³`.
    fn deepest(&self, reduced_mass: f64, speed: f64) -> f64 {
        libm::cbrt(1.5 * reduced_mass * speed * speed / self.normal)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let law = BluntCone {
        normal: 3e8,
        tangential: 1e4,
    };
    // Two grains of radius 3 mm, the first on its way to the second: here head-on.
    let scene = Scene::open("two-grains")?;
    let mut world = world::build(&scene, 1e-6);
    for position in &mut world.grains.position {
        position.y = 0.0;
    }
    let (speed, mass) = (world.grains.velocity[0].x, world.grains.mass[0]);

    let grain = SmallestGrain {
        material: &world.materials.list()[0],
        radius: world.grains.radius[0],
        restitution: 1.0,
    };
    let at = Circumstances {
        impact_speed: speed,
        are_polyhedra: false,
        integrator: Integrator::Explicit,
        // Spheres that only hit each other.
        rounding: f64::INFINITY,
        fastest: speed,
    };
    let limits = law.step_limits(&grain, &at);
    let largest = limits[0].time_step;
    println!("step at most {largest:.2e} s: {}", limits[0].reason);
    world.clock.set_time_step(largest);

    let mut solver = Solver::with_law(law, 1);
    let mut deepest: f64 = 0.0;
    while world.time() < 0.2 {
        solver.advance(&mut world, 1)?;
        let apart = (world.grains.position[1] - world.grains.position[0]).length();
        deepest = deepest.max(world.grains.radius[0] + world.grains.radius[1] - apart);
    }

    let expected = law.deepest(0.5 * mass, speed);
    println!("deepest overlap {deepest:.4e} m, closed form {expected:.4e} m");
    let [first, second] = [0, 1].map(|i| world.grains.velocity[i].x);
    println!("speeds {speed} and 0 m/s before, {first:.4} and {second:.4} m/s after");
    assert!((deepest / expected - 1.0).abs() < 1e-3);
    // Equal grains without dashpots change their speeds over.
    assert!(first.abs() < 1e-3 * speed && (second / speed - 1.0).abs() < 1e-3);
    Ok(())
}
