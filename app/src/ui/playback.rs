//! What can be asked of the run now: play, pause, steps and leaps in time, the next avalanche.
//!
//! In: the simulation as it is. Out: a command or a request where it means something now, nothing
//! elsewhere. Buttons, keys and plots ask here, so that all of them follow the same rule.

use crate::simulation::Simulation;
use crate::ui::event_kinds::EventKinds;
use crate::ui::request::Request;
use grainfall::lab::{Half, RunView, Status};
use grainfall::recording::RecordingFacts;
use grainfall::run::{Command, SAMPLE_INTERVAL};

/// Speeds to choose from, in simulated seconds per second.
pub const SPEEDS: [f64; 11] = [
    0.01,
    0.025,
    0.05,
    0.1,
    0.25,
    0.5,
    1.0,
    2.0,
    5.0,
    10.0,
    f64::INFINITY,
];

/// A scene should take at least this long to watch [s]: an impact is shown in slow motion.
const WATCHED: f64 = 5.0;

/// The speed at which a scene of this `duration` [s] is watched at first: real time, or slow motion
/// where it is short.
pub fn first_speed(duration: f64) -> f64 {
    let slow = SPEEDS.into_iter().filter(|speed| *speed <= 1.0);
    let lasting = slow.filter(|speed| duration >= WATCHED * speed);
    lasting.fold(SPEEDS[0], f64::max)
}

/// Whether `command` means anything while the run is in `status`.
pub fn allows(status: &Status, command: &Command) -> bool {
    match status {
        Status::Running | Status::Paused | Status::Seeking { .. } => true,
        Status::Faulted(_) => matches!(
            command,
            Command::Reset | Command::Seek(_) | Command::Undo | Command::Redo | Command::Return(_)
        ),
        Status::Preparing { .. } | Status::Failed(_) => false,
    }
}

/// The command of the Play and Pause button and of the space key: pause while the run goes on, else
/// play where that is possible.
pub fn play_or_pause(status: &Status) -> Option<Command> {
    let command = match status {
        Status::Running | Status::Seeking { .. } => Command::Pause,
        _ => Command::Play,
    };
    allows(status, &command).then_some(command)
}

/// The command that shows the step before the one shown, where there is one.
pub fn step_back(simulation: &Simulation) -> Option<Command> {
    let before = match simulation.recording() {
        Some(recording) => state_from(recording, simulation, Way::Back, 1)?,
        None => Command::Seek(simulation.step().checked_sub(1)?),
    };
    allows(simulation.status(), &before).then_some(before)
}

/// The command that shows the step after the one shown; of a recording the next state that there
/// is.
pub fn step_on(simulation: &Simulation) -> Option<Command> {
    let next = match simulation.recording() {
        Some(recording) => state_from(recording, simulation, Way::On, 1)?,
        None => Command::Step(1),
    };
    allows(simulation.status(), &next).then_some(next)
}

/// The command that shows the state of `recording` that is at least so many `steps` from the one
/// shown, and another one; none beyond its first and its last.
fn state_from(
    recording: &RecordingFacts,
    simulation: &RunView,
    way: Way,
    steps: u64,
) -> Option<Command> {
    let (moments, step) = (&recording.moments, simulation.step());
    let shown = recording.index_at(step);
    let last = moments.len().checked_sub(1)?;
    let index = match way {
        Way::Back => (recording.index_at(step.saturating_sub(steps))).min(shown.checked_sub(1)?),
        Way::On if shown == last => return None,
        Way::On => (recording.index_at(step.saturating_add(steps))).max(shown + 1),
    };
    Some(Command::Seek(moments.get(index)?.step))
}

/// The command that shows the moment one sampling interval before or after the one shown. After the
/// newest moment the run goes on by that interval.
pub fn leap(simulation: &Simulation, way: Way) -> Option<Command> {
    let clock = simulation.world()?.clock;
    let steps = (SAMPLE_INTERVAL / clock.time_step).ceil().max(1.0) as u64;
    go(simulation, way, steps)
}

/// The command that goes so many `steps` from the moment shown; beyond the newest one the run goes
/// on.
pub fn go(simulation: &Simulation, way: Way, steps: u64) -> Option<Command> {
    if let Some(recording) = simulation.recording() {
        return state_from(recording, simulation, way, steps);
    }
    let (step, end) = (simulation.step(), simulation.past().end.step);
    match way {
        Way::Back => (step > 0).then(|| Command::Seek(step.saturating_sub(steps))),
        Way::On if step < end => Some(Command::Seek(step.saturating_add(steps).min(end))),
        Way::On => Some(Command::Step(steps)),
    }
}

/// The command that shows the moment at `time` [s]; beyond the newest one the run goes on to it.
pub fn go_to(simulation: &Simulation, time: f64) -> Option<Command> {
    let step = simulation.step_times()?.step_at(time.max(0.0));
    let end = simulation.past().end.step;
    if step <= end || simulation.looks_back() || simulation.recording().is_some() {
        return Some(Command::Seek(step.min(end)));
    }
    Some(Command::Step(step - end))
}

/// A direction in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Towards the start.
    Back,
    /// Towards the end.
    On,
}

/// The request to show the start of the avalanche before or after the moment shown, where there is
/// one.
pub fn to_avalanche(simulation: &RunView, way: Way) -> Option<Request> {
    let time_step = simulation.world()?.clock.time_step;
    let now = simulation.step_times()?.time_at(simulation.step());
    // A start that is shown already is neither before nor after.
    let mut starts = simulation
        .avalanches()
        .iter()
        .map(|avalanche| avalanche.start);
    let start = match way {
        Way::Back => starts.rfind(|start| *start < now - time_step),
        Way::On => starts.find(|start| *start > now + time_step),
    };
    seek(simulation, start?)
}

/// The request to show the event of the run in this `half` before or after the moment shown, where
/// there is one of these `kinds`; of a recording, one that is nearest to another state.
pub fn to_event(
    simulation: &Simulation,
    half: Half,
    kinds: EventKinds,
    way: Way,
) -> Option<Request> {
    let (times, shown) = (simulation.step_times()?, simulation.step());
    let place = |time: f64| {
        let step = times.step_at(time);
        let recording = simulation.recording();
        recording.map_or(Some(step), |recording| {
            let state = recording.moments.get(recording.nearest(step));
            state.map(|moment| moment.step)
        })
    };
    let events = simulation.half(half).events().iter();
    let events = events.filter(|event| kinds.show(event.kind()));
    let mut steps = events.filter_map(|event| place(event.time));
    let step = match way {
        Way::Back => steps.rfind(|step| *step < shown),
        Way::On => steps.find(|step| *step > shown),
    };
    Some(Request::Command(Command::Seek(step?)))
}

/// The moment shown [s], where it is not the newest.
pub fn moment_shown(simulation: &RunView) -> Option<f64> {
    let times = simulation.step_times()?;
    simulation
        .looks_back()
        .then(|| times.time_at(simulation.step()))
}

/// The request to show the moment at `time` [s].
pub fn seek(simulation: &RunView, time: f64) -> Option<Request> {
    let step = simulation.step_times()?.step_at(time);
    Some(Request::Command(Command::Seek(step)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_over_at_once_is_watched_in_slow_motion() {
        let cases = [
            (50.0, 1.0),
            (2.0, 0.25),
            (0.6, 0.1),
            (0.3, 0.05),
            (1e-6, 0.01),
        ];
        for (duration, speed) in cases {
            assert_eq!(first_speed(duration), speed, "{duration} s");
        }
    }
}
