//! Follows the grains that are traced, and what is measured.
//!
//! In: the worlds shown, which grains are traced. Out: their trails and what is measured of the
//! worlds, in the view's settings.

use crate::simulation::Simulation;
use crate::view::colour::veil_legend;
use crate::view::measured::Measured;
use crate::view::shown_worlds::ShownWorlds;
use crate::view::trail::Trail;
use crate::view::view_settings::ViewSettings;
use bevy::prelude::*;
use grainfall::lab::Half;
use std::collections::VecDeque;

/// Adds the places of the grains that are traced.
pub(super) fn follow(shown: Res<ShownWorlds>, mut settings: ResMut<ViewSettings>) {
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

/// Measures the worlds that are shown, as far as that is to be seen, where they or what is to be
/// seen have changed.
pub(super) fn measure(
    shown: Res<ShownWorlds>,
    simulation: Option<Res<Simulation>>,
    mut settings: ResMut<ViewSettings>,
    mut was: Local<[bool; 3]>,
) {
    let switches = [
        settings.show_measured,
        settings.show_flow,
        settings.show_temperature,
    ];
    if *was == switches && !shown.is_changed() {
        return;
    }
    *was = switches;
    let [_, has_flow, has_temperature] = switches;
    let of = |half: Half| {
        let Some(world) = shown.half(half).filter(|_| switches.contains(&true)) else {
            return Measured::NOTHING;
        };
        let run = simulation.as_ref().filter(|_| has_flow);
        let flow = run.map(|simulation| simulation.half(half).mean_flow());
        let measured = Measured::of(world).with_flow(flow);
        if has_temperature {
            measured.with_temperature(world)
        } else {
            measured
        }
    };
    let measured = Half::ALL.map(of);
    let maps = measured.iter().filter_map(|own| own.temperature.as_ref());
    settings.veil = veil_legend(&maps.collect::<Vec<_>>(), settings.veil.as_ref());
    settings.measured = measured;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::test_worlds::grains_in_a_row;
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
        ecs.init_resource::<ShownWorlds>();
        let left = Arc::new(grains_in_a_row(3));
        ecs.resource_mut::<ShownWorlds>().show(Some(left.clone()));
        let one = [(Half::Left, 0, 1), (Half::Left, 2, 1)];
        assert_eq!(follow_in(&mut ecs, &[0, 2]), one);
        // A grain that is not there has none.
        assert_eq!(follow_in(&mut ecs, &[0, 2, 7]), one);
        let mut later = (*left).clone();
        later.clock.step += 10;
        ecs.resource_mut::<ShownWorlds>()
            .show_pair(Arc::new(later), left);
        let both = [(Half::Left, 2, 2), (Half::Right, 2, 1)];
        assert_eq!(follow_in(&mut ecs, &[2]), both);
        assert_eq!(follow_in(&mut ecs, &[]), []);
    }
}
