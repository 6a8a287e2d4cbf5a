//! The badge that says at any time whether the run can be trusted, and why.
//!
//! In: the simulation. Out: one mark, told by its shape and a word as well as by its colour, with
//! one line why; a click shows every number that was looked at, its limits and what to do, and
//! where a step is too long a button that shortens it.

use crate::simulation::Simulation;
use crate::ui::playback::allows;
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::words::number;
use bevy_egui::egui::{self, Color32, Popup, PopupCloseBehavior, RichText, WidgetInfo, WidgetType};
use grainfall::lab::{Half, RunView, Status};
use grainfall::measure::{Measure, Sample};
use grainfall::recording::RecordingFacts;
use grainfall::run::{Command, Parameter};
use grainfall::solver::{Fault, TimeStepAdvice};
use grainfall::world::{StateHash, World};
use std::borrow::Cow;

/// Largest overlap over the smaller radius up to which contacts are small deformations, and above
/// which forces no longer mean what the contact laws say.
const OVERLAPS: [f64; 2] = [0.02, 0.05];
/// The same for polyhedra, over the smaller rounding radius: an eighth and half of the way to where
/// the cores of two grains meet. A rounding radius is a small part of a grain, and their law is
/// linear all the way.
const OVERLAPS_OF_ROUNDING: [f64; 2] = [0.25, 1.0];
/// Energy that the ledger leaves unexplained, as a share of its largest term: what users of
/// explicit codes commonly allow.
const RESIDUALS: [f64; 2] = [0.05, 0.10];
/// Time step over the smallest of its limits.
const STEPS: [f64; 2] = [1.0, 2.0];
/// Least energy that has been turned over before a residual means anything, in lifts of all grains
/// by their radius.
const LIFTS: f64 = 1.0;
/// Width of what a click shows, in points.
const WIDTH: f32 = 430.0;

/// How something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// As it should be.
    Good,
    /// Worth a look.
    Doubtful,
    /// Results mean nothing.
    Bad,
}

/// One thing that was looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// What it is.
    pub name: Cow<'static, str>,
    /// How it is.
    pub level: Level,
    /// The number with its limits.
    pub value: String,
    /// What to do where it is not good.
    pub remedy: &'static str,
}

impl Level {
    /// Where `value` lies between two limits; what is no number is worth a look.
    fn of(value: f64, [good, doubtful]: [f64; 2]) -> Self {
        if value <= good {
            Self::Good
        } else if value > doubtful {
            Self::Bad
        } else {
            Self::Doubtful
        }
    }

    fn word(self) -> &'static str {
        match self {
            Self::Good => "Sound",
            Self::Doubtful => "Doubtful",
            Self::Bad => "Not to be trusted",
        }
    }

    fn mark(self) -> &'static str {
        match self {
            Self::Good => "✔",
            Self::Doubtful => "⚠",
            Self::Bad => "✖",
        }
    }

    fn colour(self, palette: Palette) -> Color32 {
        match self {
            Self::Good => palette.minimum,
            Self::Doubtful => palette.warning,
            Self::Bad => palette.error,
        }
    }
}

/// The badge.
#[derive(Default)]
pub struct Badge {
    checks: Vec<Check>,
    hash: Option<StateHash>,
    /// Generation of the state that both were made of.
    generation: u64,
}

impl Badge {
    /// Draws it; a click shows the numbers.
    pub fn ui(&mut self, ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
        if self.generation != simulation.generation() || self.checks.is_empty() {
            self.generation = simulation.generation();
            self.checks = checks(simulation);
            self.hash = None;
        }
        let Some(worst) = self.checks.iter().max_by_key(|check| check.level) else {
            return;
        };
        let level = worst.level;
        let colour = level.colour(Palette::of(ui.visuals()));
        let is_recorded = simulation.recording().is_some();
        let text = match level {
            Level::Good if is_recorded => format!("{} Recorded", level.mark()),
            Level::Good => format!("{} {}", level.mark(), level.word()),
            _ => format!("{} {}: {}", level.mark(), level.word(), worst.name),
        };
        let why = match level {
            Level::Good if is_recorded => {
                "A recording whose files, as far as they were read, are as they were written"
                    .to_owned()
            }
            Level::Good => {
                "Time step, overlaps, energy and grains are as they should be".to_owned()
            }
            _ => format!("{}: {}", number::capitalised(&worst.name), worst.value),
        };
        let response = ui
            .button(RichText::new(text).color(colour))
            .on_hover_text(&why);
        let name = format!("Trust: {}. {why}", level.word());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &name));
        Popup::from_toggle_button_response(&response)
            .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
            .width(WIDTH)
            .show(|ui| self.details_ui(ui, simulation, out));
    }

    fn details_ui(&mut self, ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
        ui.set_width(WIDTH);
        let palette = Palette::of(ui.visuals());
        for check in &self.checks {
            ui.horizontal_wrapped(|ui| {
                let mark = RichText::new(check.level.mark()).color(check.level.colour(palette));
                ui.label(mark);
                ui.label(RichText::new(number::capitalised(&check.name)).strong());
                ui.label(&check.value);
            });
            if check.level != Level::Good {
                ui.weak(check.remedy);
            }
        }
        stable_step_ui(ui, simulation, out);
        ui.separator();
        ui.label(pace(simulation));
        if *simulation.status() == Status::Running {
            ui.weak("State hash: pause to see it");
        } else if simulation.recording().is_some() {
            ui.weak("State hash: none, as the files hold 32 bits of each number");
        } else if let Some(world) = simulation.world() {
            let hash = self.hash.get_or_insert_with(|| world.hash());
            ui.label(format!("State hash at step {}:", world.clock.step));
            ui.monospace(hash.to_string());
        }
    }
}

/// The button that goes on with the largest stable step, where the present one is longer.
fn stable_step_ui(ui: &mut egui::Ui, simulation: &Simulation, out: &mut Vec<Request>) {
    let Some(command) = stable_step(simulation).filter(|_| simulation.recording().is_none()) else {
        return;
    };
    let Command::Set { value, .. } = command else {
        return;
    };
    let text = format!("Go on with steps of {}", number::short_time(value.number()));
    let enabled = allows(simulation.status(), &command);
    let button = ui.add_enabled(enabled, egui::Button::new(text));
    let hint = "From this moment on; recorded as any other change, and taken back by an undo";
    if button.on_hover_text(hint).clicked() {
        out.push(Request::Command(command));
    }
}

/// The change that makes a step that exceeds its limit the largest stable one; of two runs side by
/// side, which have one step, that of both.
pub fn stable_step(simulation: &Simulation) -> Option<Command> {
    let advices = Half::ALL.map(|half| simulation.half(half).advice());
    let exceeded = advices.iter().any(|advice| advice.excess().is_some());
    let largest = advices.map(TimeStepAdvice::largest);
    exceeded.then_some(Command::Set {
        parameter: Parameter::TimeStep,
        value: largest.into_iter().fold(f64::INFINITY, f64::min).into(),
    })
}

/// How fast the run goes, in words.
fn pace(simulation: &Simulation) -> String {
    let factor = simulation.real_time_factor();
    if factor > 0.0 {
        format!(
            "{} simulated seconds per second; nothing is ever skipped",
            number::short(factor)
        )
    } else {
        "The run holds".into()
    }
}

/// All that is looked at, for the state shown of each run; nothing before there is one.
pub fn checks(simulation: &Simulation) -> Vec<Check> {
    let mut checks = checks_of(simulation);
    if let Some(facts) = simulation.recording() {
        checks.insert(0, recording(facts, simulation.warnings()));
    }
    if let Some(comparison) = simulation.comparison() {
        let right = checks_of(comparison.right).into_iter().map(|check| Check {
            name: format!("{}, right", check.name).into(),
            ..check
        });
        checks.extend(right);
    }
    checks
}

/// The same for one run.
fn checks_of(simulation: &RunView) -> Vec<Check> {
    let Some(world) = simulation.world() else {
        return Vec::new();
    };
    let sample = simulation.sample();
    let of_sample =
        |check: fn(&Sample, &World) -> Check| sample.map(|sample| check(&sample, world));
    [
        simulation.fault().map(fault),
        Some(time_step(simulation)),
        of_sample(overlap),
        of_sample(residual),
        Some(lost(world)),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// What is shown was computed before, by whom, and whether its files are as they were written.
fn recording(facts: &RecordingFacts, warnings: &[String]) -> Check {
    let by = if facts.is_imported {
        "an import of another program's run"
    } else {
        "a run"
    };
    let found = warnings.first().map_or_else(
        || "the files read so far are as they were written".to_owned(),
        |first| number::capitalised(first),
    );
    Check {
        name: "recording".into(),
        level: if warnings.is_empty() {
            Level::Good
        } else {
            Level::Doubtful
        },
        value: format!(
            "of {by} by Grainfall {}, in {}. {found}",
            facts.version,
            facts.folder.display()
        ),
        remedy: "The ⚠ under the picture tells all of it. `grainfall verify` computes the run again and compares every file.",
    }
}

fn fault(fault: &Fault) -> Check {
    Check {
        name: "a fault".into(),
        level: Level::Bad,
        value: fault.to_string(),
        remedy: "Undo the last change, or give the scene a smaller time step.",
    }
}

fn time_step(simulation: &RunView) -> Check {
    let advice = simulation.advice();
    let shown = |time| number::short_time(time);
    let (level, value) = match advice.limits.first() {
        Some(limit) => (
            // The last bit of a step that is its own limit does not count.
            Level::of(advice.time_step / limit.time_step * (1.0 - 1e-12), STEPS),
            format!(
                "{}, limit {} ({}){}",
                shown(advice.time_step),
                shown(limit.time_step),
                limit.name,
                advice.excess().map_or_else(String::new, |excess| {
                    format!(", {:.0} % over", 100.0 * excess)
                })
            ),
        ),
        None => (
            Level::Doubtful,
            format!("{}, no limit is known", shown(advice.time_step)),
        ),
    };
    Check {
        name: "time step".into(),
        level,
        value,
        remedy: "Go on with a step within the limit, or give the scene `time_step: Following`: its step then follows \
                 whatever is changed.",
    }
}

fn overlap(sample: &Sample, world: &World) -> Check {
    let overlap = sample.value(Measure::LargestOverlap);
    let (limits, radius) = match world.polyhedra {
        Some(_) => (OVERLAPS_OF_ROUNDING, "rounding radius"),
        None => (OVERLAPS, "radius"),
    };
    Check {
        name: "largest overlap".into(),
        level: Level::of(overlap, limits),
        value: format!(
            "{} % of the {radius}, good up to {} %",
            number::short(100.0 * overlap),
            100.0 * limits[0]
        ),
        remedy: "Use stiffer materials (a larger Young's modulus or stiffness), or let grains meet more slowly.",
    }
}

fn residual(sample: &Sample, world: &World) -> Check {
    const TERMS: [Measure; 9] = [
        Measure::GravityWork,
        Measure::WallWork,
        Measure::KineticEnergy,
        Measure::ElasticEnergy,
        Measure::DashpotLoss,
        Measure::SlidingLoss,
        Measure::RollingLoss,
        Measure::ViscousLoss,
        Measure::CapillaryLoss,
    ];
    let largest = TERMS
        .map(|term| sample.value(term).abs())
        .into_iter()
        .fold(0.0, f64::max);
    let grains = &world.grains;
    let weight = world.gravity.length();
    let lifts = grains
        .mass
        .iter()
        .zip(&grains.radius)
        .map(|(m, r)| m * weight * r);
    let share =
        sample.value(Measure::EnergyResidual).abs() / largest.max(LIFTS * lifts.sum::<f64>());
    let share = if share.is_nan() { 0.0 } else { share };
    Check {
        name: "energy residual".into(),
        level: Level::of(share, RESIDUALS),
        value: format!(
            "{} % of what was turned over, good up to {} %",
            number::short(100.0 * share),
            100.0 * RESIDUALS[0]
        ),
        remedy: "Halve the time step: what the ledger leaves unexplained is the step's error.",
    }
}

/// Grains that are not where grains can be: not finite, or with their centres behind a wall.
fn lost(world: &World) -> Check {
    let walls = &world.container.walls;
    let outside = |x: &&glam::DVec3| {
        !x.is_finite() || walls.iter().any(|wall| wall.surface.distance(**x).0 < 0.0)
    };
    let lost = world.grains.position.iter().filter(outside).count();
    Check {
        name: "grains lost".into(),
        level: if lost == 0 { Level::Good } else { Level::Bad },
        value: format!("{lost} of {}, must be 0", world.grains.len()),
        remedy: "Undo the last change, or give the scene a smaller time step.",
    }
}
