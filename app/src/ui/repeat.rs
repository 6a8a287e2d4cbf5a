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
