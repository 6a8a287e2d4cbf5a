//! The ways of chosen grains through the picture.
//!
//! In: the worlds shown, which grains are traced. Out: their places in order of time, in the view's settings.

use super::{Shown, ViewSettings};
use crate::simulation::Half;
use bevy::prelude::*;
use std::collections::VecDeque;

/// Places kept: at sixty a second, a minute.
const LONGEST: usize = 3600;

/// The way of a grain in one half of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Trail {
    /// Which grain.
    pub grain: usize,
    /// In which half.
    pub half: Half,
    /// Times [s] and places [m], in order of time.
    pub places: VecDeque<(f64, Vec3)>,
}

impl Trail {
    /// Adds where the grain is at `time` [s]. Places after that are forgotten: the run may take another way.
    fn add(&mut self, time: f64, place: Vec3) {
        let kept = self.places.partition_point(|(then, _)| *then < time);
        self.places.truncate(kept);
        if self.places.len() >= LONGEST {
            self.places.pop_front();
        }
        self.places.push_back((time, place));
    }
}

/// Adds the places of the grains that are traced.
pub(super) fn follow(shown: Res<Shown>, mut settings: ResMut<ViewSettings>) {
    let is_traced = |trail: &Trail, traced: &[usize]| {
        shown.half(trail.half).is_some() && traced.contains(&trail.grain)
    };
    let wanted = shown.worlds().count() * settings.traced.len();
    let are_there = settings.trails.len() == wanted
        && (settings.trails.iter()).all(|trail| is_traced(trail, &settings.traced));
    if are_there && (wanted == 0 || !shown.is_changed()) {
        return;
    }
    let ViewSettings { traced, trails, .. } = &mut *settings;
    trails.retain(|trail| is_traced(trail, traced));
    for (half, grain) in Half::ALL
        .into_iter()
        .flat_map(|half| traced.iter().map(move |i| (half, *i)))
    {
        let Some(world) = shown.half(half) else {
            continue;
        };
        let Some(place) = world.grains.position.get(grain) else {
            continue;
        };
        let own = (trails.iter()).position(|trail| (trail.half, trail.grain) == (half, grain));
        let own = own.unwrap_or_else(|| {
            trails.push(Trail {
                grain,
                half,
                places: VecDeque::new(),
            });
            trails.len() - 1
        });
        trails[own].add(world.time(), place.as_vec3());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::tests::grains_in_a_row;
    use bevy::ecs::system::RunSystemOnce;
    use std::sync::Arc;

    fn follow_in(ecs: &mut World, traced: &[usize]) -> Vec<(Half, usize, usize)> {
        ecs.resource_mut::<ViewSettings>().traced = traced.to_vec();
        ecs.run_system_once(follow).unwrap();
        let trails = &ecs.resource::<ViewSettings>().trails;
        let mut found: Vec<_> = (trails.iter())
            .map(|trail| (trail.half, trail.grain, trail.places.len()))
            .collect();
        found.sort_by_key(|(half, grain, _)| (half.index(), *grain));
        found
    }

    #[test]
    fn every_traced_grain_has_a_trail_in_each_half_until_it_is_given_up() {
        let mut ecs = World::new();
        ecs.init_resource::<ViewSettings>();
        ecs.init_resource::<Shown>();
        let left = Arc::new(grains_in_a_row(3));
        ecs.resource_mut::<Shown>().show(Some(left.clone()));
        let one = [(Half::Left, 0, 1), (Half::Left, 2, 1)];
        assert_eq!(follow_in(&mut ecs, &[0, 2]), one);
        // A grain that is not there has none.
        assert_eq!(follow_in(&mut ecs, &[0, 2, 7]), one);
        let mut later = (*left).clone();
        later.clock.step += 10;
        ecs.resource_mut::<Shown>()
            .show_twins(Arc::new(later), left);
        let both = [(Half::Left, 2, 2), (Half::Right, 2, 1)];
        assert_eq!(follow_in(&mut ecs, &[2]), both);
        assert_eq!(follow_in(&mut ecs, &[]), []);
    }

    #[test]
    fn a_trail_forgets_what_comes_after_the_moment_shown_and_what_is_long_ago() {
        let mut trail = Trail {
            grain: 0,
            half: Half::Left,
            places: VecDeque::new(),
        };
        for i in 0..LONGEST + 5 {
            trail.add(i as f64, Vec3::ZERO);
        }
        assert_eq!(trail.places.len(), LONGEST);
        assert_eq!(trail.places[0].0, 5.0);
        trail.add(10.0, Vec3::ONE);
        let times: Vec<f64> = trail.places.iter().map(|(time, _)| *time).collect();
        assert_eq!(times, [5.0, 6.0, 7.0, 8.0, 9.0, 10.0]);
    }
}
