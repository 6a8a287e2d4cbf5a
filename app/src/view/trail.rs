//! The ways of chosen grains through the picture.
//!
//! In: the worlds shown, which grains are traced. Out: their places in order of time, in the view's
//! settings.

use bevy::prelude::*;
use grainfall::lab::Half;
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
    /// Adds the grain's place at `time` [s]. Later places are dropped: the run may have been taken
    /// back and go on differently.
    pub(super) fn add(&mut self, time: f64, place: Vec3) {
        let kept = self.places.partition_point(|(then, _)| *then < time);
        self.places.truncate(kept);
        if self.places.len() >= LONGEST {
            self.places.pop_front();
        }
        self.places.push_back((time, place));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
