//! The flowing layer: mean velocity in the cross-section, its profile over depth, its map where the
//! bed flows fastest.
//!
//! In: a world with its sample and surface, again and again. Out: profiles and maps of any later
//! part of the run. Velocities are the local means of `velocity_kernel`, averaged over the samples
//! in which the bed flows ([`NON_RIGID_TEMPERATURE`]).

use super::estimate::Estimate;
use super::flowing_layer::FlowingLayer;
use super::sample::Sample;
use super::sampled_quantity::Measure;
use super::surface::SurfaceLine;
use super::velocity_kernel::{kernel_reach, mean_velocity};
use super::velocity_map::{VelocityMap, velocity_map};
use crate::world::World;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Granular temperature from which a bed counts as flowing [m²/s²] (Kasper et al. 2021).
pub const NON_RIGID_TEMPERATURE: f64 = 2e-9;

/// Depths at which the profile is taken.
const DEPTHS: usize = 48;
/// The deepest of them [m].
const DEEPEST: f64 = 0.06;

/// Profiles of every second of a run, so that any later part of it can be averaged, and maps of its
/// fastest moments. One that follows from another shares all with it but the last second.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FlowHistory {
    /// Profiles that were forgotten, before the first that is here.
    #[serde(skip)]
    forgotten: usize,
    #[serde(with = "shared")]
    seconds: Vec<Arc<FlowProfile>>,
    /// The hottest sample of all, then the hottest after that second, and so on.
    #[serde(with = "shared")]
    fastest: Vec<Arc<FastMoment>>,
}

/// A sample with its map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct FastMoment {
    temperature: f64,
    map: VelocityMap,
}

/// How a list of shared values stands in a file: as the values themselves.
mod shared {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use std::sync::Arc;

    pub fn serialize<T: Serialize, S: Serializer>(
        list: &[Arc<T>],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(list.iter().map(Arc::as_ref))
    }

    pub fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<Arc<T>>, D::Error> {
        let values = Vec::<T>::deserialize(deserializer)?;
        Ok(values.into_iter().map(Arc::new).collect())
    }
}

impl FlowHistory {
    /// Whether its profiles and maps are of the lengths that they say, as a file may not.
    pub fn is_whole(&self) -> bool {
        self.seconds.iter().all(|second| second.is_whole())
            && self.fastest.iter().all(|moment| moment.map.is_whole())
    }

    /// Adds the state `world` with its `sample` and surface, where the bed flows.
    pub fn add(&mut self, world: &World, sample: &Sample, line: &SurfaceLine) {
        let temperature = sample.value(Measure::GranularTemperature);
        // A NaN does not flow.
        if temperature.is_nan() || temperature < NON_RIGID_TEMPERATURE {
            return;
        }
        let second = sample.time.max(0.0) as usize;
        // The last second is never forgotten, and time goes on.
        let index = second.saturating_sub(self.forgotten);
        if self.seconds.len() <= index {
            self.seconds.resize_with(index + 1, Arc::default);
        }
        Arc::make_mut(&mut self.seconds[index]).add(world, line);
        self.keep_if_fast(world, temperature, second);
    }

    /// Seconds whose profiles nothing is added to any more.
    pub fn done(&self) -> usize {
        self.forgotten + self.seconds.len().saturating_sub(1)
    }

    /// Whether profiles were forgotten.
    pub fn is_part(&self) -> bool {
        self.forgotten > 0
    }

    /// Forgets the profiles of the first `seconds`, as far as nothing is added to them any more.
    pub fn forget(&mut self, seconds: usize) {
        let count = seconds.min(self.done()).saturating_sub(self.forgotten);
        self.seconds.drain(..count);
        self.forgotten += count;
    }

    /// The profiles from this second on, counted from time zero; those that are here.
    pub fn profiles_since(&self, second: usize) -> &[Arc<FlowProfile>] {
        let first = second.saturating_sub(self.forgotten);
        self.seconds.get(first..).unwrap_or_default()
    }

    /// The same without the profiles of the first `seconds`.
    #[must_use]
    pub fn rest(&self, seconds: usize) -> Self {
        Self {
            forgotten: seconds,
            seconds: self.profiles_since(seconds).to_vec(),
            fastest: self.fastest.clone(),
        }
    }

    /// The same, its first profile being that of this `second`: files hold a [`FlowHistory::rest`]
    /// and not from when on.
    #[must_use]
    pub fn counted_from(self, second: usize) -> Self {
        Self {
            forgotten: second,
            ..self
        }
    }

    /// The same with the profiles of the first seconds, which were kept elsewhere: `earlier` ones,
    /// followed by those that are here after them.
    #[must_use]
    pub fn behind(&self, earlier: Vec<FlowProfile>) -> Self {
        let new = self.profiles_since(earlier.len()).iter().cloned();
        Self {
            forgotten: 0,
            seconds: earlier.into_iter().map(Arc::new).chain(new).collect(),
            fastest: self.fastest.clone(),
        }
    }

    /// Keeps the map of `world` where none of its second and none after it was hotter.
    fn keep_if_fast(&mut self, world: &World, temperature: f64, second: usize) {
        let colder = |moment: &mut Arc<FastMoment>| moment.temperature <= temperature;
        while self.fastest.pop_if(colder).is_some() {}
        let hotter = self.fastest.last();
        if hotter.is_some_and(|moment| moment.map.time.max(0.0) as usize == second) {
            return;
        }
        if let Some(map) = velocity_map(world, 0.0) {
            self.fastest.push(FastMoment { temperature, map }.into());
        }
    }

    /// The velocities in the laboratory frame at the sample with the highest granular temperature
    /// from the first whole second at or after `time` [s] on; none where the bed never flowed.
    pub fn fastest_since(&self, time: f64) -> Option<&VelocityMap> {
        let maps = self.fastest.iter().map(|moment| &moment.map);
        maps.into_iter()
            .find(|map| map.time >= time.max(0.0).ceil())
    }

    /// Memory of its lists and of its last profile [bytes]: what it takes beside one that it follows
    /// from.
    pub fn own_memory(&self) -> usize {
        let lists = size_of_val(&self.seconds[..]) + size_of_val(&self.fastest[..]);
        lists + self.seconds.last().map_or(0, |second| second.memory())
    }

    /// Its profiles but for the last one, and its maps, which others may share: where each lies,
    /// and the memory that it takes [bytes].
    pub fn shared_parts(&self) -> impl Iterator<Item = (usize, usize)> {
        let done = self.seconds.split_last().map_or(&[][..], |(_, done)| done);
        let seconds = done
            .iter()
            .map(|second| (Arc::as_ptr(second).addr(), second.memory()));
        let maps = self.fastest.iter().map(|moment| {
            let bytes = size_of::<FastMoment>() + size_of_val(&moment.map.velocity[..]);
            (Arc::as_ptr(moment).addr(), bytes)
        });
        seconds.chain(maps)
    }

    /// Velocity along the surface, positive uphill to the right, at each depth of that profile
    /// [m/s]: a mean with its standard error, for which every second in which the bed flows is one
    /// event; NaN where nothing was averaged.
    pub fn velocity_since(&self, time: f64) -> Vec<Estimate> {
        mean_velocities(self.seconds_between(time, f64::INFINITY))
    }

    /// The flowing layer on the mean, from the first whole second at or after `from` [s] to the second
    /// of `until` [s]; none where the bed did not flow.
    pub fn layer_between(&self, from: f64, until: f64) -> Option<FlowingLayer> {
        let seconds = self.seconds_between(from, until);
        let depths = &seconds
            .iter()
            .find(|second| !second.depth.is_empty())?
            .depth;
        let velocities = depths.iter().copied().zip(mean_velocities(seconds));
        let known: Vec<_> = velocities.filter(|(_, own)| own.mean.is_finite()).collect();
        FlowingLayer::of(&known)
    }

    /// The profiles from the first whole second at or after `from` [s] to the second of `until` [s].
    fn seconds_between(&self, from: f64, until: f64) -> &[Arc<FlowProfile>] {
        let end = self
            .seconds
            .len()
            .min((until.max(0.0) as usize).saturating_add(1));
        let first = (from.max(0.0).ceil() as usize).min(end);
        &self.seconds[first..end]
    }

    /// The mean flow from the first whole second at or after `time` [s] on.
    pub fn mean_since(&self, time: f64) -> MeanFlow {
        let profile = self.since(time);
        let rows = profile.depth.iter().zip(profile.samples);
        let rows = rows.zip(self.velocity_since(time));
        let depths = rows.map(|((depth, samples), velocity)| FlowDepth {
            depth: *depth,
            velocity: velocity.mean,
            error: velocity.error,
            samples,
        });
        MeanFlow {
            depths: depths.collect(),
        }
    }

    /// The profile averaged from the first whole second at or after `time` [s] on.
    pub fn since(&self, time: f64) -> FlowProfile {
        let mut profile = FlowProfile::default();
        let seconds = self.seconds_between(time, f64::INFINITY).iter();
        seconds.for_each(|second| profile.merge(second));
        profile
    }
}

/// Mean velocity along the surface at each depth over these `seconds` [m/s].
fn mean_velocities(seconds: &[Arc<FlowProfile>]) -> Vec<Estimate> {
    let depths = seconds.iter().map(|second| second.depth.len()).max();
    let at = |k: usize| {
        let sums = seconds.iter().filter_map(|second| {
            let count = second.samples.get(k).filter(|count| **count > 0)?;
            Some((second.sums[k], f64::from(*count)))
        });
        Estimate::of_bursts(&sums.collect::<Vec<_>>())
    };
    (0..depths.unwrap_or(0)).map(at).collect()
}

/// Velocity along the surface over the depth below its middle, averaged over the samples of a part of
/// a run in which the bed flows. Empty where it never did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeanFlow {
    /// One for each depth, from the surface down.
    pub depths: Vec<FlowDepth>,
}

impl MeanFlow {
    /// Depth of the flowing layer [m]; none where the velocity never changes its sign.
    pub fn layer_depth(&self) -> Option<f64> {
        let known = self.depths.iter().filter(|depth| depth.samples > 0);
        let velocity = |own: &FlowDepth| Estimate::too_short(own.velocity, 0);
        let known: Vec<_> = known.map(|own| (own.depth, velocity(own))).collect();
        Some(FlowingLayer::of(&known)?.depth?.mean)
    }
}

/// The mean velocity at one depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowDepth {
    /// Below the middle of the surface, along its inward normal [m].
    pub depth: f64,
    /// Along the surface, positive uphill to the right [m/s]; NaN of no sample.
    pub velocity: f64,
    /// Its standard error [m/s]; none where too few seconds flowed to say.
    pub error: Option<f64>,
    /// Samples that were averaged.
    pub samples: u32,
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
    fn memory(&self) -> usize {
        size_of::<Self>() + self.depth.len() * (2 * size_of::<f64>() + size_of::<u32>())
    }

    fn is_whole(&self) -> bool {
        let depths = self.depth.len();
        (depths == 0 || depths == DEPTHS)
            && self.samples.len() == depths
            && self.sums.len() == depths
            // Averages add them up: as many as an hour has at most.
            && self.samples.iter().all(|count| *count < 1 << 18)
    }

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
}
