//! Dry drums to compare wet ones with, and which drums those of the paper are.
//!
//! In: a radius of grains. Out: what the dry drums of Kasper et al. 2021 with such grains gave in
//! this program, averaged over the last 30 s of 50 s with a smallest drop of 1° (the table *dry* of
//! `docs/validation.md`). It is what live plots divide by.

use super::estimate::Estimate;
use crate::world::{Shape, World};

/// Results of a dry drum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DryDrum {
    /// Radius of its grains [m].
    pub radius: f64,
    /// Mean drop ⟨Δθ⟩ [rad] with its standard error.
    pub drop: Estimate,
}

/// A mean with its standard error [rad] over so many beds of different seeds, known to so many
/// degrees of freedom.
const fn drop(mean: f64, error: f64, samples: usize, freedom: usize) -> Estimate {
    Estimate {
        mean,
        error: Some(error),
        samples,
        freedom,
    }
}

/// The drums that were run: 16 beds, 4 beds, two beds of 23 avalanches together.
const DRUMS: [DryDrum; 3] = [
    DryDrum {
        radius: 3e-3,
        drop: drop(0.14795, 0.00605, 16, 15),
    },
    DryDrum {
        radius: 2e-3,
        drop: drop(0.11827, 0.00833, 4, 3),
    },
    DryDrum {
        radius: 1.25e-3,
        drop: drop(0.07184, 0.00622, 2, 22),
    },
];

/// The dry drum of the paper with grains of this radius [m]; none for other radii.
pub fn dry_drum(radius: f64) -> Option<DryDrum> {
    let close = |drum: &DryDrum| (drum.radius / radius - 1.0).abs() < 1e-6;
    DRUMS.into_iter().find(close)
}

/// The drum of the paper: radius and width [m], speed [rad/s].
const PAPER_DRUM: [f64; 3] = [60.5e-3, 22e-3, 0.5 * std::f64::consts::TAU / 60.0];

/// What of `world` the laws of Kasper et al. 2021 do not speak of, in words; nothing in the paper's
/// drum at its speed with grains of one size.
pub fn beyond_kasper(world: &World) -> Option<String> {
    let Shape::Drum { radius, width } = world.container.shape else {
        return Some("there is no drum".into());
    };
    let [own_radius, own_width, own_speed] = PAPER_DRUM;
    let is = |value: f64, own: f64| (value / own - 1.0).abs() < 1e-6;
    if !is(radius, own_radius) || !is(width, own_width) {
        return Some("the paper's drum has a radius of 60.5 mm and a width of 22 mm".into());
    }
    let radii = &world.grains.radius;
    if radii.iter().any(|other| !is(*other, radii[0])) {
        return Some("its grains are of several sizes, those of the paper of one".into());
    }
    let speed = world.container.drum_speed();
    (!is(speed.abs(), own_speed)).then(|| "the paper's drum turns at 0.5 rpm".into())
}

#[cfg(test)]
mod tests {
    use super::{beyond_kasper, dry_drum};
    use crate::scene::Scene;
    use crate::solver::advise;
    use crate::world;

    #[test]
    fn the_laws_speak_of_the_papers_drum_alone() {
        let beyond = |name: &str, faster: f64| {
            let scene = Scene::open(name).unwrap();
            let mut world = world::build(&scene, advise(&scene).time_step);
            let speed = world.container.drum_speed();
            world.container.set_drum_speed(faster * speed);
            beyond_kasper(&world)
        };
        assert_eq!(beyond("water-drum", 1.0), None);
        assert!(beyond("water-drum", 2.0).unwrap().contains("0.5 rpm"));
        let mix = beyond("two-sizes-wet-drum", 1.0).unwrap();
        assert!(mix.contains("radius of 60.5 mm"), "{mix}");
    }

    #[test]
    fn stored_drums_are_found_by_their_radius() {
        assert!((dry_drum(3e-3).unwrap().drop.mean.to_degrees() - 8.48).abs() < 0.01);
        assert!(dry_drum(2e-3).is_some());
        assert!(dry_drum(2.5e-3).is_none());
    }
}
