//! The flowing layer: mean velocity in the cross-section, its profile over depth, its map where the bed flows fastest.
//!
//! Velocities are averaged over the grains with a Gaussian of their distance in the x–y plane, whatever their place along
//! the axis, and over the samples in which the bed flows ([`NON_RIGID_TEMPERATURE`]). The kernel reaches as far as that of
//! Kasper et al. 2021: 8 mm, and 11 mm for grains of 3 mm; here that is where the Gaussian is cut off, at two standard
//! deviations.

use super::surface::{SurfaceLine, mean_radius};
use super::{Measure, NON_RIGID_TEMPERATURE, Sample, VelocityMap, velocity_map};
use crate::world::World;
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// Depths at which the profile is taken.
const DEPTHS: usize = 48;
/// The deepest of them [m].
const DEEPEST: f64 = 0.06;
/// Reach of the kernel in mean radii, within [`REACH`].
const REACH_IN_RADII: f64 = 11.0 / 3.0;
/// Reach of the kernel [m].
const REACH: std::ops::RangeInclusive<f64> = 0.008..=0.011;
/// Standard deviations at which the kernel is cut off.
const CUT_OFF: f64 = 2.0;

/// Profiles of every second of a run, so that any later part of it can be averaged, and maps of its fastest moments.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FlowHistory {
    seconds: Vec<FlowProfile>,
    /// The hottest sample of all, then the hottest after that second, and so on.
    fastest: Vec<FastMoment>,
}

/// A sample with its map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct FastMoment {
    temperature: f64,
    map: VelocityMap,
}

impl FlowHistory {
    /// Adds the state `world` with its `sample` and surface, where the bed flows.
    pub fn add(&mut self, world: &World, sample: &Sample, line: &SurfaceLine) {
        let temperature = sample.value(Measure::GranularTemperature);
        // A NaN does not flow.
        if temperature.is_nan() || temperature < NON_RIGID_TEMPERATURE {
            return;
        }
        let second = sample.time.max(0.0) as usize;
        if self.seconds.len() <= second {
            self.seconds.resize_with(second + 1, FlowProfile::default);
        }
        self.seconds[second].add(world, line);
        self.keep_if_fast(world, temperature, second);
    }

    /// Keeps the map of `world` where none of its second and none after it was hotter.
    fn keep_if_fast(&mut self, world: &World, temperature: f64, second: usize) {
        let colder = |moment: &mut FastMoment| moment.temperature <= temperature;
        while self.fastest.pop_if(colder).is_some() {}
        let hotter = self.fastest.last();
        if hotter.is_some_and(|moment| moment.map.time.max(0.0) as usize == second) {
            return;
        }
        if let Some(map) = velocity_map(world, 0.0) {
            self.fastest.push(FastMoment { temperature, map });
        }
    }

    /// The velocities in the laboratory frame at the sample with the highest granular temperature from the first whole
    /// second at or after `time` [s] on; none where the bed never flowed.
    pub fn fastest_since(&self, time: f64) -> Option<&VelocityMap> {
        let maps = self.fastest.iter().map(|moment| &moment.map);
        maps.into_iter()
            .find(|map| map.time >= time.max(0.0).ceil())
    }

    /// Memory that it takes [bytes].
    pub fn memory(&self) -> usize {
        let second = |profile: &FlowProfile| {
            size_of::<FlowProfile>()
                + profile.depth.len() * (2 * size_of::<f64>() + size_of::<u32>())
        };
        let moment =
            |moment: &FastMoment| size_of::<FastMoment>() + size_of_val(&moment.map.velocity[..]);
        let seconds: usize = self.seconds.iter().map(second).sum();
        seconds + self.fastest.iter().map(moment).sum::<usize>()
    }

    /// The profile averaged from the first whole second at or after `time` [s] on.
    pub fn since(&self, time: f64) -> FlowProfile {
        let first = time.max(0.0).ceil() as usize;
        let mut profile = FlowProfile::default();
        self.seconds
            .iter()
            .skip(first)
            .for_each(|second| profile.merge(second));
        profile
    }
}

/// Profile of the velocity along the surface over the depth below its middle, averaged over time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FlowProfile {
    /// Depths below the surface line, along its inward normal [m].
    pub depth: Vec<f64>,
    /// Samples that were averaged at each depth.
    pub samples: Vec<u32>,
    sums: Vec<f64>,
}

impl FlowProfile {
    fn merge(&mut self, other: &Self) {
        if self.depth.is_empty() {
            self.clone_from(other);
            return;
        }
        for (own, other) in self.sums.iter_mut().zip(&other.sums) {
            *own += other;
        }
        for (own, other) in self.samples.iter_mut().zip(&other.samples) {
            *own += other;
        }
    }

    fn add(&mut self, world: &World, line: &SurfaceLine) {
        if self.depth.is_empty() {
            let spacing = DEEPEST / (DEPTHS - 1) as f64;
            self.depth = (0..DEPTHS).map(|k| k as f64 * spacing).collect();
            self.samples = vec![0; DEPTHS];
            self.sums = vec![0.0; DEPTHS];
        }
        for k in 0..DEPTHS {
            let point = line.midpoint - line.normal() * self.depth[k];
            if let Some(velocity) = mean_velocity(world, point, kernel_reach(world)) {
                self.samples[k] += 1;
                self.sums[k] += velocity.dot(line.direction);
            }
        }
    }

    /// Mean velocity along the surface, positive uphill to the right, at each depth [m/s]; NaN where nothing was averaged.
    pub fn velocity(&self) -> Vec<f64> {
        let mean = |(sum, count): (&f64, &u32)| sum / f64::from(*count);
        self.sums.iter().zip(&self.samples).map(mean).collect()
    }
}

/// Reach of the kernel that suits the grains of `world` [m].
pub fn kernel_reach(world: &World) -> f64 {
    let reach = REACH_IN_RADII * mean_radius(&world.grains);
    reach.clamp(*REACH.start(), *REACH.end())
}

/// Mean velocity of the grains near `point` of the cross-section, each weighed by a Gaussian of its distance that is cut
/// off at `reach` [m]; none where there is no grain.
pub fn mean_velocity(world: &World, point: DVec2, reach: f64) -> Option<DVec2> {
    let (mut weights, mut sum) = (0.0, DVec2::ZERO);
    for (position, velocity) in world.grains.position.iter().zip(&world.grains.velocity) {
        let weight = weight((position.truncate() - point).length_squared(), reach);
        weights += weight;
        sum += weight * velocity.truncate();
    }
    (weights > 0.0).then(|| sum / weights)
}

/// Weight of a grain at this squared distance [m²] in a mean whose kernel is cut off at `reach` [m].
pub(super) fn weight(squared: f64, reach: f64) -> f64 {
    let width = reach / CUT_OFF;
    if squared < reach * reach {
        (-0.5 * squared / (width * width)).exp()
    } else {
        0.0
    }
}
