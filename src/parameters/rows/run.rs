//! How a run goes: its steps, its length, its chances.

use crate::parameters::Value;
use crate::parameters::parameter_row::{InScene, InWorld, Kind, PanelSection, ParameterRow};
use crate::parameters::value::Choice;
use crate::physics::{Integrator, limits, units};
use crate::scene::{SceneContainer, TimeStep, Until};
use crate::solver::advise;

/// How far below the step in effect its slider goes, as a factor.
const REACH: f64 = 10.0;
/// Largest seed a field offers.
const LARGEST_SEED: f64 = 1e6;

/// Leaves the step to the program: at any time, or at the start.
static AUTOMATIC: [Choice; 4] = [
    Choice {
        key: "automatic",
        name: "automatic",
        number: 0.0,
    },
    Choice {
        key: "automatic-at-start",
        name: "automatic at the start",
        number: -1.0,
    },
    Choice {
        key: "reference",
        name: "reference, a quarter of it",
        number: -2.0,
    },
    Choice {
        key: "fast",
        name: "fast, half as much again",
        number: -3.0,
    },
];

/// What a scene says of its step for each of these, in their order.
const CHOSEN: [TimeStep; 4] = [
    TimeStep::Following,
    TimeStep::Automatic,
    TimeStep::Reference,
    TimeStep::Fast,
];

pub static TIME_STEP: ParameterRow = ParameterRow {
    key: "time-step",
    name: |_| "time step",
    symbol: "Δt",
    kind: Kind::NumberOr(&units::SHORT_TIME, &AUTOMATIC),
    expected: "`automatic`, `reference`, `fast`, or a time such as `1e-5s` or `10us`",
    limits: Some(&limits::TIME_STEP),
    slider: |step, _, _| step / REACH..=step * 2.0,
    equation: |_| "x(t + Δt) from x(t): velocity Verlet",
    description: "Simulated time of one step. The scene's own is as long as the stiffest contact allows; a longer one is not \
                  to be trusted.",
    in_scene: Some(InScene {
        read: |scene, _| match scene.time_step {
            TimeStep::Given(step) => Some(Value::Number(step)),
            chosen => {
                let place = CHOSEN.iter().position(|one| *one == chosen)?;
                Some(Value::Choice(&AUTOMATIC[place]))
            }
        },
        write: |scene, _, value| {
            scene.time_step = match value {
                Value::Choice(choice) => {
                    let place = AUTOMATIC.iter().position(|one| one == choice)?;
                    CHOSEN[place]
                }
                Value::Number(step) => TimeStep::Given(step),
                Value::Count(_) => return None,
            };
            Some(())
        },
    }),
    in_effect: Some(|scene| advise(scene).time_step.into()),
    in_world: Some(InWorld {
        read: |world, _| Some(world.clock.time_step.into()),
        write: |world, _, _, value| world.clock.set_time_step(value.number()),
    }),
    ..super::AT_START
};

static INTEGRATORS: [Choice; 2] = [
    Choice {
        key: "explicit",
        name: "explicit",
        number: 0.0,
    },
    Choice {
        key: "implicit",
        name: "springs and dashpots implicit",
        number: 1.0,
    },
];

pub static INTEGRATOR: ParameterRow = ParameterRow {
    key: "integrator",
    name: |_| "integrator",
    kind: Kind::Choice(&INTEGRATORS),
    expected: "`explicit` or `implicit`, in a scene of polyhedra",
    description: "How polyhedra are moved: where springs and dashpots are implicit, they do not limit the time step, which may be \
                  eighteen times as long.",
    in_scene: Some(InScene {
        read: |scene, _| {
            let integrators = scene.is_polyhedral().then_some(&INTEGRATORS)?;
            integrators
                .get(scene.integrator as usize)
                .map(Value::Choice)
        },
        write: |scene, _, value| {
            scene.integrator = match value {
                Value::Choice(choice) if choice.key == "explicit" => Integrator::Explicit,
                Value::Choice(choice) if choice.key == "implicit" => Integrator::Implicit,
                _ => return None,
            };
            scene.is_polyhedral().then_some(())
        },
    }),
    ..super::AT_START
};

pub static SEED: ParameterRow = ParameterRow {
    key: "seed",
    name: |_| "seed",
    kind: Kind::Count,
    slider: |seed, _, _| 0.0..=LARGEST_SEED.max(seed),
    description: "Another number makes another arrangement of the same grains.",
    in_scene: Some(InScene {
        read: |scene, _| Some(scene.seed.into()),
        write: |scene, _, value| match value {
            Value::Count(seed) => {
                scene.seed = seed;
                Some(())
            }
            Value::Number(_) | Value::Choice(_) => None,
        },
    }),
    ..super::AT_START
};

pub static DURATION: ParameterRow = ParameterRow {
    key: "duration",
    name: |_| "duration",
    symbol: "t",
    kind: Kind::Number(&units::TIME),
    expected: "a time such as `10s`, `250ms` or `2min`",
    limits: Some(&limits::DURATION),
    description: "Simulated time of a run without a window.",
    slider: |_, _, _| limits::DURATION.least..=limits::DURATION.most,
    section: PanelSection::Nowhere,
    in_scene: Some(InScene {
        read: |scene, _| Some(scene.duration.into()),
        write: |scene, _, value| {
            scene.duration = value.number();
            Some(())
        },
    }),
    ..super::AT_START
};

static ENDS: [Choice; 2] = [
    Choice {
        key: "duration",
        name: "the duration",
        number: 0.0,
    },
    Choice {
        key: "rest",
        name: "rest",
        number: 1.0,
    },
];

pub static UNTIL: ParameterRow = ParameterRow {
    key: "until",
    name: |_| "until",
    kind: Kind::Choice(&ENDS),
    expected: "`duration` or `rest`, in a scene of a column",
    description: "What ends a run without a window: its duration, or that its column has been at rest for a quarter of the time \
                  that it took to come to it.",
    section: PanelSection::Nowhere,
    in_scene: Some(InScene {
        read: |scene, _| {
            let is_column = matches!(scene.container, SceneContainer::Column { .. });
            let ends = is_column.then_some(&ENDS)?;
            ends.get(scene.until as usize).map(Value::Choice)
        },
        write: |scene, _, value| {
            scene.until = match value {
                Value::Choice(choice) if choice.key == "duration" => Until::Duration,
                Value::Choice(choice) if choice.key == "rest" => Until::Rest,
                _ => return None,
            };
            matches!(scene.container, SceneContainer::Column { .. }).then_some(())
        },
    }),
    ..super::AT_START
};

pub static OUTPUT_INTERVAL: ParameterRow = ParameterRow {
    key: "output-interval",
    name: |_| "output interval",
    kind: Kind::Number(&units::TIME),
    expected: "a time such as `0.1s` or `20ms`",
    limits: Some(&limits::DURATION),
    description: "Simulated time between two states that a run without a window writes.",
    slider: |_, _, _| limits::DURATION.least..=limits::DURATION.most,
    section: PanelSection::Nowhere,
    in_scene: Some(InScene {
        read: |scene, _| Some(scene.output_interval.into()),
        write: |scene, _, value| {
            scene.output_interval = value.number();
            Some(())
        },
    }),
    ..super::AT_START
};

/// Leaves the samples to what happens.
static FOLLOWING: [Choice; 1] = [Choice {
    key: "automatic",
    name: "automatic",
    number: 0.0,
}];

pub static SAMPLE_INTERVAL: ParameterRow = ParameterRow {
    key: "sample-interval",
    name: |_| "sample interval",
    kind: Kind::NumberOr(&units::TIME, &FOLLOWING),
    expected: "`automatic`, or a time such as `20ms` or `10us`",
    limits: Some(&limits::DURATION),
    description: "Simulated time between two samples; by itself 20 ms and less while a column falls or few grains meet.",
    slider: |_, _, _| limits::DURATION.least..=limits::DURATION.most,
    section: PanelSection::Nowhere,
    in_scene: Some(InScene {
        read: |scene, _| {
            let stated = scene.sample_interval.map(Value::Number);
            Some(stated.unwrap_or(Value::Choice(&FOLLOWING[0])))
        },
        write: |scene, _, value| {
            scene.sample_interval = match value {
                Value::Number(interval) => Some(interval),
                Value::Choice(_) => None,
                Value::Count(_) => return None,
            };
            Some(())
        },
    }),
    ..super::AT_START
};
