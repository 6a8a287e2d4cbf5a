//! Which lessons make sense, alone and with their scene.
//!
//! In: a [`Lesson`] as a file states it. Out: nothing, or the first mistake with the path of its
//! key. A lesson that passes can be played to its end: its quantities are measured in its scene, its
//! parameters are there and act at once, its questions can be answered.

use super::description::{
    Lesson, LessonStep, Measurement, Question, QuestionKind, Statistic, Touch,
};
use crate::measure::Measure;
use crate::parameters::{Parameter, ParameterInfo, Value, live_parameters};
use crate::run::{Command, accept};
use crate::scene::{Problem, Scene};
use crate::solver::advise;
use crate::world::{World, build};

/// Steps of a lesson, hints of a step: what a student bears.
const MOST_STEPS: usize = 100;
/// Values that a lesson gives, things it lets touch at once.
const MOST_VALUES: usize = 50;
/// Longest span that a class waits for [simulated seconds].
const LONGEST_SPAN: f64 = 600.0;
/// Slowest and fastest play [simulated seconds per second].
const SPEEDS: (f64, f64) = (0.001, 100.0);
/// Grains of a lesson's scene: it opens while a class looks on.
pub(super) const MOST_GRAINS: usize = 20_000;

/// Nothing, or the first mistake.
type Checked = Result<(), Problem>;

impl Lesson {
    /// Whether its values make sense, whatever its scene.
    pub(super) fn problem(&self) -> Checked {
        line("title", &self.title)?;
        some_text("about", &self.about)?;
        number("settings", "values", self.settings.len(), 0, MOST_VALUES)?;
        number("steps", "steps", self.steps.len(), 1, MOST_STEPS)?;
        for (index, step) in self.steps.iter().enumerate() {
            let path = format!("steps[{index}]");
            let own = |key: &str| format!("{path}.{key}");
            line(&own("title"), &step.title)?;
            if self.steps[..index]
                .iter()
                .any(|other| other.title == step.title)
            {
                let expected = "another title for each step";
                return Err(Problem::new(
                    own("title"),
                    "is that of an earlier step",
                    expected,
                ));
            }
            step.problem(&path)?;
            if let Some(question) = &step.question {
                self.check_question(question, &own("ask"))?;
            }
        }
        Ok(())
    }

    fn check_question(&self, question: &Question, path: &str) -> Checked {
        some_text(&format!("{path}.question"), &question.text)?;
        question.measurement.problem(path)?;
        let unit = question.measurement.quantity.quantity().unit.shown;
        let shown = |value: f64| value * unit.factor;
        let above_zero = |key: &str, value: f64| {
            if value > 0.0 && value.is_finite() {
                return Ok(());
            }
            let expected = format!("a number above 0 {}", unit.name);
            let path = format!("{path}.{key}");
            Err(Problem::value(path, shown(value), expected.trim_end()))
        };
        match &question.kind {
            QuestionKind::Number {
                tolerance,
                expected,
            } => {
                above_zero("tolerance", *tolerance)?;
                let Some((low, high)) = expected else {
                    return Ok(());
                };
                if low < high && low.is_finite() && high.is_finite() {
                    return Ok(());
                }
                let value = format!("({}, {})", shown(*low), shown(*high));
                let expected = "two numbers, the smaller one first: no answer lies between these";
                Err(Problem::value(format!("{path}.expected"), value, expected))
            }
            QuestionKind::Change {
                than, same_within, ..
            } => {
                above_zero("same_within", *same_within)?;
                self.check_compared(*than, &question.measurement, &format!("{path}.than"))
            }
        }
    }

    /// Whether the step at `than` measures what `own` is to be compared with.
    fn check_compared(&self, than: usize, own: &Measurement, path: &str) -> Checked {
        let question = self.steps.get(than).and_then(|step| step.question.as_ref());
        let is_alike = question.is_some_and(|question| {
            let other = &question.measurement;
            other.quantity == own.quantity && other.of == own.of
        });
        if is_alike {
            return Ok(());
        }
        let quantity = own.quantity.quantity().key;
        Err(Problem::new(
            path,
            "names a step that measures something else, or nothing",
            format!("an earlier step that asks for the same of `{quantity}`"),
        ))
    }

    /// Whether it can be played in `scene`, its own with its settings.
    pub(super) fn problem_in(&self, scene: &Scene) -> Checked {
        let grains = scene.grain_count();
        if grains > MOST_GRAINS {
            return Err(Problem::new(
                "scene",
                format!("has {grains} grains"),
                format!("at most {MOST_GRAINS}, so that it opens while a class looks on"),
            ));
        }
        let world = build(scene, advise(scene).time_step);
        let parameters = live_parameters(scene, &world);
        for (index, step) in self.steps.iter().enumerate() {
            step.problem_in(&format!("steps[{index}]"), &parameters, &world)?;
        }
        Ok(())
    }
}

impl LessonStep {
    fn problem(&self, path: &str) -> Checked {
        let own = |key: &str| format!("{path}.{key}");
        some_text(&own("text"), &self.text)?;
        number(
            &own("touch"),
            "things to touch",
            self.touch.len(),
            0,
            MOST_VALUES,
        )?;
        number(&own("set"), "values", self.set.len(), 0, MOST_VALUES)?;
        number(&own("hints"), "hints", self.hints.len(), 0, MOST_STEPS)?;
        if !self.set.is_empty() && self.question.is_none() {
            return Err(Problem::new(
                own("set"),
                "gives values to a step that asks nothing",
                "`set` beside `ask`: the values are given when the answer is played",
            ));
        }
        let (slowest, fastest) = SPEEDS;
        match self.speed {
            Some(speed) if !(slowest..=fastest).contains(&speed) => Err(Problem::value(
                own("speed"),
                speed,
                format!("between {slowest} and {fastest} simulated seconds per second"),
            )),
            _ => Ok(()),
        }
    }

    fn problem_in(&self, path: &str, parameters: &[ParameterInfo], world: &World) -> Checked {
        for (index, touch) in self.touch.iter().enumerate() {
            if let Touch::Parameter(parameter) = touch {
                known(
                    &format!("{path}.touch[{index}]"),
                    parameter,
                    parameters,
                    world,
                )?;
            }
        }
        for (parameter, value) in &self.set {
            let path = format!("{path}.set.{parameter}");
            known(&path, parameter, parameters, world)?;
            settable(path, (parameter, *value), parameters, world)?;
        }
        let Some(question) = &self.question else {
            return Ok(());
        };
        let quantity = question.measurement.quantity;
        if quantity.applies_to(world) {
            return Ok(());
        }
        let known = Measure::of(world).into_iter().map(|own| own.quantity().key);
        let path = format!("{path}.ask.quantity");
        let what = "a quantity without a meaning in this scene,";
        Err(Problem::unknown_name(
            path,
            what,
            quantity.quantity().key,
            known,
        ))
    }
}

impl Measurement {
    fn problem(&self, path: &str) -> Checked {
        let (from, to) = (self.span.start, self.span.end);
        if !(from >= 0.0 && from < to && to <= LONGEST_SPAN) {
            return Err(Problem::value(
                format!("{path}.span"),
                format!("({from}, {to})"),
                format!("two times in s, the earlier one first, at most {LONGEST_SPAN} s"),
            ));
        }
        let scatter = format!("{path}.scatter");
        match self.scatter {
            None if self.of == Statistic::Mean => Ok(()),
            None => Err(Problem::new(
                scatter,
                "is missing",
                "`(deviation: …, runs: …)`: one value of one run has no error of its own",
            )),
            Some(own) if !(own.deviation > 0.0 && own.deviation.is_finite()) => {
                Err(Problem::value(
                    format!("{scatter}.deviation"),
                    own.deviation,
                    "a number above 0",
                ))
            }
            Some(own) => number(&format!("{scatter}.runs"), "runs", own.runs, 2, 1_000_000),
        }
    }
}

/// Whether the world has `parameter`, and it does something there.
fn known(
    path: &str,
    parameter: &Parameter,
    parameters: &[ParameterInfo],
    world: &World,
) -> Checked {
    let own = parameter.canonical(&world.materials);
    let known = || parameters.iter().filter(|info| info.acts);
    if known().any(|info| info.parameter == own) {
        return Ok(());
    }
    let names: Vec<String> = known().map(|info| info.parameter.to_string()).collect();
    let names = names.iter().map(String::as_str);
    let (what, name) = ("a parameter that acts at once,", parameter.to_string());
    Err(Problem::unknown_name(path, what, &name, names))
}

/// Whether a run of the world takes the value.
fn settable(
    path: String,
    (parameter, value): (&Parameter, Value),
    parameters: &[ParameterInfo],
    world: &World,
) -> Checked {
    let parameter = parameter.clone();
    let command = Command::Set { parameter, value };
    let accepted = accept(parameters, world, &command);
    accepted.map(drop).map_err(|refusal| {
        let refusal = refusal.to_string();
        let expected = refusal
            .split_once("; expected ")
            .map_or("another value", |(_, end)| end);
        Problem::value(path, value, expected)
    })
}

fn line(path: &str, text: &str) -> Checked {
    let length = text.trim().chars().count();
    if (1..=200).contains(&length) && !text.contains('\n') {
        return Ok(());
    }
    let value = format!("{length} characters long");
    Err(Problem::value(
        path,
        value,
        "one line of 1 to 200 characters",
    ))
}

fn some_text(path: &str, text: &str) -> Checked {
    if text.trim().is_empty() {
        return Err(Problem::new(path, "is empty", "a sentence or two"));
    }
    Ok(())
}

fn number(path: &str, what: &str, number: usize, least: usize, most: usize) -> Checked {
    if (least..=most).contains(&number) {
        return Ok(());
    }
    let expected = format!("between {least} and {most}");
    Err(Problem::new(path, format!("has {number} {what}"), expected))
}
