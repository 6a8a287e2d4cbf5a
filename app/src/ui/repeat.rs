//! A part of a run that is played again and again, and the time between its ends.
//!
//! In: the moments that a person marks. Out: requests to go back to the first of them whenever the
//! second is passed. What lies between them was computed: it comes to the same states each time.

use crate::simulation::Simulation;
use crate::ui::request::Request;
use grainfall::lab::Status;
use grainfall::run::Command;

/// The part from A to B.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Repeat {
    /// Time of A [s].
    from: Option<f64>,
    /// Time of B, later than A [s].
    to: Option<f64>,
    /// Whether the run went on in the last frame.
    was_running: bool,
}

impl Repeat {
    /// Marks A at the moment shown, then B; then none.
    pub fn mark(&mut self, simulation: &Simulation) {
        let Some(times) = simulation.step_times() else {
            return;
        };
        let now = times.time_at(simulation.step());
        *self = match (self.from, self.to) {
            (None, _) => Self {
                from: Some(now),
                ..*self
            },
            (Some(from), None) if from != now => Self {
                from: Some(from.min(now)),
                to: Some(from.max(now)),
                ..*self
            },
            _ => Self::default(),
        };
    }

    /// The times of A and B, as far as they are marked [s].
    pub fn ends(&self) -> impl Iterator<Item = f64> {
        self.from.into_iter().chain(self.to)
    }

    /// The time from A to B [s], once both are marked.
    pub fn duration(&self) -> Option<f64> {
        Some(self.to? - self.from?)
    }

    /// Goes back to A where the run has come to B by playing.
    pub fn follow(&mut self, simulation: &Simulation, out: &mut Vec<Request>) {
        let is_running = *simulation.status() == Status::Running;
        // A recording holds at its last state by itself.
        let is_over = simulation.recording().is_some() && !simulation.looks_back();
        let plays = is_running || (self.was_running && is_over);
        self.was_running = is_running;
        let (Some(from), Some(to), Some(times)) = (self.from, self.to, simulation.step_times())
        else {
            return;
        };
        let end = simulation.past().end.step;
        let Some(world) = simulation.world() else {
            return;
        };
        // The step that was asked for, where that is still on its way.
        let is_there = simulation.step() == world.clock.step;
        let now = if is_there {
            simulation.reached()
        } else {
            simulation.step()
        };
        if plays && now >= times.step_at(to).min(end) && times.step_at(from) < end {
            let back = Command::Seek(times.step_at(from));
            out.extend([back, Command::Play].map(Request::Command));
            self.was_running = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainfall::lab::{DriverKind, Options};
    use grainfall::run::BedStore;
    use grainfall::scene::Scene;
    use std::time::Duration;

    fn tick(simulation: &mut Simulation) {
        simulation.tick(Duration::from_millis(16));
    }

    /// Lets `simulation` do `command`, until it holds.
    fn carry_out(simulation: &mut Simulation, command: Command) {
        simulation.send(command);
        for _ in 0..10_000 {
            tick(simulation);
            if simulation.has_answered() && *simulation.status() == Status::Paused {
                return;
            }
        }
        panic!("still {:?}", simulation.status());
    }

    #[test]
    fn what_lies_between_two_marks_is_played_again_and_again() {
        let options = Options {
            driver: DriverKind::Inline,
            threads: 1,
            autoplay: false,
            beds: BedStore::none(),
            ..Options::window()
        };
        let scene = Scene::open("bouncing-grain").unwrap();
        let mut simulation = Simulation::open(scene, options);
        while matches!(simulation.status(), Status::Preparing { .. }) {
            tick(&mut simulation);
        }
        carry_out(&mut simulation, Command::Step(4000));
        let hash = simulation.world().unwrap().hash();
        let mut repeat = Repeat::default();
        carry_out(&mut simulation, Command::Seek(3000));
        repeat.mark(&simulation);
        assert_eq!((repeat.ends().count(), repeat.duration()), (1, None));
        // The mark that is earlier is the start, whichever was made first.
        carry_out(&mut simulation, Command::Seek(2000));
        repeat.mark(&simulation);
        let step = simulation.world().unwrap().clock.time_step;
        let lasts = repeat.duration().unwrap();
        assert!((lasts - 1000.0 * step).abs() < 1e-12, "{lasts}");

        simulation.send(Command::Speed(0.2));
        simulation.send(Command::Play);
        let (mut turns, mut last, mut latest) = (0, 2000, 0);
        for _ in 0..4000 {
            tick(&mut simulation);
            let mut asked = Vec::new();
            repeat.follow(&simulation, &mut asked);
            for request in asked {
                let Request::Command(command) = request else {
                    panic!("{request:?}");
                };
                simulation.send(command);
            }
            let now = simulation.world().unwrap().clock.step;
            turns += u32::from(now < last);
            (last, latest) = (now, latest.max(now));
            if turns == 3 {
                break;
            }
        }
        assert_eq!(turns, 3, "at step {last}");
        // A picture may come a sixtieth of a second late.
        assert!((3000..4000).contains(&latest), "{latest}");
        assert_eq!(simulation.past().end.step, 4000, "nothing new is computed");

        repeat.mark(&simulation);
        assert_eq!(
            repeat,
            Repeat {
                was_running: repeat.was_running,
                ..Repeat::default()
            }
        );
        carry_out(&mut simulation, Command::Pause);
        carry_out(&mut simulation, Command::Seek(4000));
        assert_eq!(simulation.world().unwrap().hash(), hash);
    }
}
