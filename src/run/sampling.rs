//! When a run is measured: every 20 ms, and more often while something happens that is shorter.
//!
//! In: the states of a run. Out: the step after which the next sample is taken, a function of these
//! states alone. Nothing is measured here.
//!
//! A bed is measured on the grid alone, after the first step at or after each multiple of an
//! interval, so that averages count all times alike; so is every scene that states an interval. In
//! two kinds of scene samples follow what happens:
//!
//! - A column falls at once: samples are as far apart as a twelfth of the time since its start,
//!   and at first as a part of the time of its fall.
//! - Few grains meet and part: the states before and after that are sampled, each of the first
//!   steps of a contact, then a quarter of its length so far apart; and a flight at every quarter,
//!   its highest point included.
//!
//! No two samples are farther apart than on the grid. A run has at most [`FINE_ALLOWANCE`] more
//! than twice those of the grid.

use crate::measure::InitialColumn;
use crate::scene::{SAMPLE_INTERVAL, Scene};
use crate::world::{Clock, Shape, World};
use serde::{Deserialize, Serialize};

/// Most grains of a scene in which single contacts are followed.
const FEW_GRAINS: usize = 16;
/// Steps of a contact that are all sampled.
const FIRST_STEPS: u64 = 20;
/// Samples of a contact while its length grows by a factor of e.
const OF_CONTACT: u64 = 4;
/// Samples of the rise of a grain that is thrown up, that of its highest point included.
const OF_RISE: f64 = 2.0;
/// Samples of a column while the time since its start grows by a factor of e.
const OF_FALL: f64 = 12.0;
/// First samples of a column, in the time in which a grain falls from its top.
const FIRST_OF_FALL: f64 = 32.0;
/// Samples beside the grid that a run may have, before there are as many as on it.
const FINE_ALLOWANCE: u64 = 1000;

/// How often a run is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Time between two samples of the grid [s].
    interval: f64,
    follows: Followed,
}

/// What is followed beside the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Followed {
    Nothing,
    /// A column that falls; its first samples are so far apart [s].
    Fall(f64),
    Contacts,
}

impl Pace {
    /// That of a run of `scene` from `bed`.
    pub fn of(scene: &Scene, bed: &World) -> Self {
        let follows = match (scene.sample_interval, InitialColumn::of(bed)) {
            (Some(_), _) => Followed::Nothing,
            (None, Some(column)) => Followed::Fall(fall_time(&column) / FIRST_OF_FALL),
            (None, None) => of_few(bed),
        };
        Self {
            interval: scene.sample_interval.unwrap_or(SAMPLE_INTERVAL),
            follows,
        }
    }

    /// Whether every single step has to be looked at.
    pub fn follows_contacts(&self) -> bool {
        self.follows == Followed::Contacts
    }
}

/// The time in which a grain falls from the top of `column` [s].
fn fall_time(column: &InitialColumn) -> f64 {
    (2.0 * column.height / column.gravity).sqrt()
}

fn of_few(bed: &World) -> Followed {
    let is_drum = matches!(bed.container.shape, Shape::Drum { .. });
    if bed.grains.len() <= FEW_GRAINS && !is_drum {
        Followed::Contacts
    } else {
        Followed::Nothing
    }
}

/// Which samples of a run were taken and what the next one depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sampling {
    /// Index of the next sample of the grid.
    grid: u64,
    /// Step of the last sample.
    last: u64,
    /// Samples that were taken beside the grid.
    fine: u64,
    /// Step at which the last contact began.
    begun: Option<u64>,
    /// Step at which the last contact ended, and steps between two samples since then, while all
    /// grains are in flight.
    flight: Option<(u64, u64)>,
}

impl Sampling {
    /// Nothing known but the `grid`'s next sample.
    pub fn on_grid(grid: u64) -> Self {
        Self {
            grid,
            ..Self::default()
        }
    }

    /// Index of the next sample of the grid.
    pub fn grid(&self) -> u64 {
        self.grid
    }

    /// The step after which the next sample is taken.
    pub fn due(&self, pace: &Pace, clock: &Clock) -> u64 {
        let grid = grid_step(pace, clock, self.grid);
        if !self.has_room() {
            return grid;
        }
        let apart = match pace.follows {
            Followed::Nothing => None,
            Followed::Fall(first) => {
                let apart = first.max(self.last as f64 * clock.time_step / OF_FALL);
                Some((apart / clock.time_step) as u64)
            }
            Followed::Contacts => self.apart(),
        };
        apart.map_or(grid, |steps| {
            grid.min(self.last.saturating_add(steps.max(1)))
        })
    }

    /// Whether there may be more samples beside the grid.
    fn has_room(&self) -> bool {
        self.fine <= FINE_ALLOWANCE.saturating_add(self.grid)
    }

    /// Steps from the last sample to the next of the contact or flight that is followed.
    fn apart(&self) -> Option<u64> {
        let since = self.last.saturating_sub(self.begun?);
        if since < FIRST_STEPS {
            return Some(1);
        }
        let Some((parted, apart)) = self.flight else {
            return Some(since / OF_CONTACT);
        };
        // Counted from the start of the flight: its highest point is sampled.
        let flown = self.last.saturating_sub(parted);
        Some(apart - flown % apart.max(1))
    }

    /// Notes the step from the state `before` to `world`; whether grains met or parted in it and
    /// both states are to be sampled.
    pub fn heed(&mut self, before: &World, world: &World) -> bool {
        let (old, new) = (touching(before), touching(world));
        if old.clone().eq(new.clone()) {
            return false;
        }
        let begins = new
            .clone()
            .any(|pair| !old.clone().any(|other| other == pair));
        if begins {
            self.begun = Some(world.clock.step);
        }
        let flies = new.count() == 0;
        self.flight = flies.then(|| (world.clock.step, flight_steps(world)));
        self.has_room()
    }

    /// Notes that the state at `clock`, before grains met or parted, is to be sampled; whether it
    /// was not yet.
    pub fn note_before(&mut self, clock: &Clock) -> bool {
        let is_new = clock.step > self.last;
        if is_new {
            self.last = clock.step;
            self.fine = self.fine.saturating_add(1);
        }
        is_new
    }

    /// Notes that the state at `clock` was sampled.
    pub fn note(&mut self, pace: &Pace, clock: &Clock) {
        self.last = clock.step;
        let past = (clock.time() / pace.interval) as u64;
        let is_fine = grid_step(pace, clock, self.grid) > clock.step;
        if is_fine {
            self.fine = self.fine.saturating_add(1);
            return;
        }
        self.grid = self.grid.max(past.saturating_sub(1));
        while grid_step(pace, clock, self.grid) <= clock.step {
            self.grid += 1;
        }
    }
}

/// The step after which the sample of this index of the grid is taken.
fn grid_step(pace: &Pace, clock: &Clock, index: u64) -> u64 {
    clock.step_at(index as f64 * pace.interval)
}

/// The pairs that touch.
fn touching(world: &World) -> impl Iterator<Item = (u32, crate::world::Partner)> + Clone {
    let contacts = world.contacts.iter().filter(|contact| contact.touching);
    contacts.map(|contact| (contact.grain, contact.partner))
}

/// Steps between two samples of the flight that begins at `world`, at least one; where no grain
/// rises nothing turns back in it.
fn flight_steps(world: &World) -> u64 {
    let gravity = world.gravity;
    let rises = world.grains.velocity.iter().map(|v| -v.dot(gravity));
    let rise = rises.fold(0.0, f64::max) / gravity.length_squared();
    if rise > 0.0 {
        ((rise / (OF_RISE * world.clock.time_step)).round() as u64).max(1)
    } else {
        u64::MAX
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of the samples of a column that takes `first` [s] between its first ones, until `end`
    /// [s].
    fn sampled(first: f64, end: f64) -> Vec<u64> {
        let pace = Pace {
            interval: SAMPLE_INTERVAL,
            follows: Followed::Fall(first),
        };
        let (mut clock, mut sampling) = (Clock::new(2e-5), Sampling::default());
        let mut steps = Vec::new();
        while clock.time() < end {
            if sampling.due(&pace, &clock) <= clock.step {
                sampling.note(&pace, &clock);
                steps.push(clock.step);
            }
            clock.step += 1;
        }
        steps
    }

    #[test]
    fn a_column_is_sampled_ever_more_seldom_until_it_is_on_the_grid() {
        let steps = sampled(2.2e-3, 0.5);
        assert!((50..70).contains(&steps.len()), "{} samples", steps.len());
        for sample in 0..25 {
            let on_grid = 1000 * sample;
            assert!(steps.contains(&on_grid), "{on_grid} is missing");
        }
        assert_eq!(
            sampled(1.0, 0.5).len(),
            25,
            "a slow one is on the grid alone"
        );
    }

    #[test]
    fn what_no_run_wrote_neither_panics_nor_hangs() {
        let most = Sampling {
            grid: u64::MAX,
            last: u64::MAX,
            fine: u64::MAX,
            begun: Some(u64::MAX),
            flight: Some((u64::MAX, u64::MAX)),
        };
        let mut clock = Clock::new(1e-5);
        clock.step = 1 << 53;
        for follows in [Followed::Nothing, Followed::Fall(1e-3), Followed::Contacts] {
            let pace = Pace {
                interval: SAMPLE_INTERVAL,
                follows,
            };
            for mut sampling in [most, Sampling::default()] {
                sampling.note(&pace, &clock);
                assert!(sampling.due(&pace, &clock) > 0);
            }
        }
    }
}
