//! The keys of a lesson's file.
//!
//! In: RON. Out: a [`Lesson`] whose names are known ones and whose values are in SI units, but not
//! yet checked. This is the only place that knows how a file spells things. What the keys mean
//! stands in `docs/lessons.md`.

use super::description::{
    Change, Lesson, LessonCut, LessonLook, LessonStep, LessonView, Measurement, Question,
    QuestionKind, RunScatter, Shown, Statistic, Touch,
};
use crate::measure::{GrainQuantity, Measure};
use crate::parameters::{Parameter, Value};
use crate::scene::{FileKind, Problem};
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// What a lesson's file is, in words.
pub(super) const KIND: FileKind = FileKind {
    noun: "lesson",
    begins: "`Lesson(title: …, …)`",
    meaning,
};

/// What may be touched beside parameters, by the words for it.
const CONTROLS: [(&str, Touch); 4] = [
    ("play", Touch::Play),
    ("speed", Touch::Speed),
    ("afresh", Touch::Afresh),
    ("time", Touch::Time),
];

/// A whole file.
#[derive(Deserialize)]
#[serde(rename = "Lesson", deny_unknown_fields)]
pub(super) struct LessonFile {
    title: String,
    about: String,
    #[serde(default)]
    source: String,
    scene: String,
    #[serde(default)]
    settings: Texts,
    #[serde(default)]
    look: LookFile,
    steps: Vec<StepFile>,
}

#[derive(Deserialize)]
#[serde(rename = "Step", deny_unknown_fields)]
struct StepFile {
    title: String,
    text: String,
    #[serde(default)]
    touch: Vec<String>,
    #[serde(default)]
    set: Texts,
    speed: Option<f64>,
    look: Option<LookFile>,
    ask: Option<AskFile>,
    #[serde(default)]
    hints: Vec<String>,
    #[serde(default)]
    why: String,
}

#[derive(Deserialize)]
#[serde(rename = "Ask")]
enum AskFile {
    Number(NumberFile),
    Change(ChangeFile),
}

/// Numbers are in the unit that people read the quantity in.
#[derive(Deserialize)]
#[serde(rename = "Number", deny_unknown_fields)]
struct NumberFile {
    question: String,
    quantity: String,
    #[serde(default)]
    of: Statistic,
    span: (f64, f64),
    scatter: Option<ScatterFile>,
    tolerance: f64,
    expected: Option<(f64, f64)>,
}

#[derive(Deserialize)]
#[serde(rename = "Change", deny_unknown_fields)]
struct ChangeFile {
    question: String,
    quantity: String,
    #[serde(default)]
    of: Statistic,
    span: (f64, f64),
    scatter: Option<ScatterFile>,
    than: String,
    same_within: f64,
    expected: Option<Change>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename = "Scatter", deny_unknown_fields)]
struct ScatterFile {
    deviation: f64,
    runs: usize,
}

#[derive(Default, Deserialize)]
#[serde(rename = "Look", default, deny_unknown_fields)]
struct LookFile {
    colour_by: Option<String>,
    from: Option<LessonView>,
    show: Vec<Shown>,
    cut: Option<LessonCut>,
}

/// A map from keys to texts, in the order of the file.
#[derive(Default)]
struct Texts(Vec<(String, String)>);

impl<'de> Deserialize<'de> for Texts {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(InOrder)
    }
}

struct InOrder;

impl<'de> Visitor<'de> for InOrder {
    type Value = Texts;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map from keys to values in quotes")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut texts = Vec::new();
        while let Some(entry) = map.next_entry()? {
            texts.push(entry);
        }
        Ok(Texts(texts))
    }
}

impl LessonFile {
    /// The lesson it states, called `name`, whose file has this `text`.
    pub(super) fn into_lesson(self, name: &str, text: &str) -> Result<Lesson, Problem> {
        let earlier: Vec<String> = self.steps.iter().map(|step| step.title.clone()).collect();
        let mut steps = Vec::new();
        for (index, step) in self.steps.into_iter().enumerate() {
            steps.push(step.into_step(&format!("steps[{index}]"), &earlier[..index])?);
        }
        Ok(Lesson {
            name: name.to_owned(),
            title: self.title,
            about: self.about,
            source: self.source,
            scene: self.scene,
            settings: self.settings.0,
            look: self.look.into_look("look")?,
            steps,
            text: text.to_owned(),
        })
    }
}

impl StepFile {
    fn into_step(self, path: &str, earlier: &[String]) -> Result<LessonStep, Problem> {
        let touch = self.touch.iter().enumerate();
        let touch = touch.map(|(index, word)| touched(&format!("{path}.touch[{index}]"), word));
        let set = (self.set.0.iter()).map(|(key, text)| live(&format!("{path}.set"), key, text));
        let look = self
            .look
            .map(|look| look.into_look(&format!("{path}.look")));
        let question = self
            .ask
            .map(|ask| ask.into_question(&format!("{path}.ask"), earlier));
        Ok(LessonStep {
            title: self.title,
            text: self.text,
            touch: touch.collect::<Result<_, _>>()?,
            set: set.collect::<Result<_, _>>()?,
            speed: self.speed,
            look: look.transpose()?,
            question: question.transpose()?,
            hints: self.hints,
            why: self.why,
        })
    }
}

/// What `word` names to touch: a control, or a parameter by its key.
fn touched(path: &str, word: &str) -> Result<Touch, Problem> {
    let control = CONTROLS.iter().find(|(known, _)| *known == word);
    if let Some((_, control)) = control {
        return Ok(control.clone());
    }
    let known = Parameter::try_from(word.to_owned());
    known.map(Touch::Parameter).map_err(|_| {
        let controls: Vec<&str> = CONTROLS.iter().map(|(word, _)| *word).collect();
        let mut problem = Problem::unknown_name(path, "a control", word, controls);
        problem.expected += ", or the key of a parameter that acts at once, such as `drum-speed`";
        problem
    })
}

/// The live parameter called `key` with the value that `text` states.
fn live(path: &str, key: &str, text: &str) -> Result<(Parameter, Value), Problem> {
    let path = format!("{path}.{key}");
    let parameter = Parameter::try_from(key.to_owned())
        .map_err(|reason| Problem::new(&path, "is no parameter that acts at once", reason))?;
    let row = parameter.row();
    let value = (row.parse(text)).ok_or_else(|| {
        Problem::value(&path, format!("\"{}\"", text.trim()), row.kind.expected())
    })?;
    Ok((parameter, value))
}

impl AskFile {
    fn into_question(self, path: &str, earlier: &[String]) -> Result<Question, Problem> {
        match self {
            Self::Number(file) => {
                let quantity = quantity_called(path, &file.quantity)?;
                let si = |value: f64| value / quantity.quantity().unit.shown.factor;
                Ok(Question {
                    text: file.question,
                    measurement: measurement(quantity, file.of, file.span, file.scatter),
                    kind: QuestionKind::Number {
                        tolerance: si(file.tolerance),
                        expected: file.expected.map(|(low, high)| (si(low), si(high))),
                    },
                })
            }
            Self::Change(file) => {
                let quantity = quantity_called(path, &file.quantity)?;
                let than = earlier.iter().position(|title| *title == file.than);
                let than = than.ok_or_else(|| {
                    let known = earlier.iter().map(String::as_str);
                    let than = format!("{path}.than");
                    Problem::unknown_name(than, "an earlier step", &file.than, known)
                })?;
                Ok(Question {
                    text: file.question,
                    measurement: measurement(quantity, file.of, file.span, file.scatter),
                    kind: QuestionKind::Change {
                        than,
                        same_within: file.same_within / quantity.quantity().unit.shown.factor,
                        expected: file.expected,
                    },
                })
            }
        }
    }
}

fn measurement(
    quantity: Measure,
    of: Statistic,
    span: (f64, f64),
    scatter: Option<ScatterFile>,
) -> Measurement {
    Measurement {
        quantity,
        of,
        span: span.0..span.1,
        scatter: scatter.map(|scatter| scatter.of(quantity)),
    }
}

impl ScatterFile {
    fn of(self, quantity: Measure) -> RunScatter {
        RunScatter {
            deviation: self.deviation / quantity.quantity().unit.shown.factor,
            runs: self.runs,
        }
    }
}

fn quantity_called(path: &str, key: &str) -> Result<Measure, Problem> {
    let known = || Measure::ALL.iter().map(|measure| measure.quantity().key);
    let index = known().position(|known| known == key);
    index.map(|index| Measure::ALL[index]).ok_or_else(|| {
        Problem::unknown_name(format!("{path}.quantity"), "a quantity", key, known())
    })
}

impl LookFile {
    fn into_look(self, path: &str) -> Result<LessonLook, Problem> {
        let known = || GrainQuantity::ALL.iter().map(|own| own.quantity().key);
        let quantity = |key: String| {
            let index = known().position(|known| known == key);
            index.map(|index| GrainQuantity::ALL[index]).ok_or_else(|| {
                Problem::unknown_name(format!("{path}.colour_by"), "a quantity", &key, known())
            })
        };
        Ok(LessonLook {
            colour_by: self.colour_by.map(quantity).transpose()?,
            from: self.from,
            show: self.show,
            cut: self.cut,
        })
    }
}

/// What a key holds, for those who left it out or gave something else.
fn meaning(key: &str) -> &'static str {
    match key {
        "title" => "one line, unlike every other title of the lesson",
        "about" => "a sentence or two for those who choose a lesson",
        "scene" => "the name of a built-in scene, or a file in the lesson's own folder",
        "settings" | "set" => "values by their keys, `{\"drum-speed\": \"1rpm\"}`",
        "steps" => "the steps, `[(title: …, text: …), …]`",
        "text" => "what the student reads",
        "touch" => "what the student is to touch, `[\"play\", \"drum-speed\"]`",
        "speed" => "simulated seconds per second",
        "ask" => "`Number(…)` or `Change(…)`",
        "question" => "the question in words",
        "quantity" => "the key of a measured quantity, such as `\"surface angle\"`",
        "of" => "`Mean`, `Largest` or `Last`",
        "span" => "from when to when, `(2, 10)` in simulated seconds since the run began",
        "tolerance" | "same_within" => "a number above 0 in the quantity's unit",
        "than" => "the title of an earlier step that measures the same",
        "scatter" => "`(deviation: …, runs: …)`",
        "hints" => "hints in quotes, `[\"…\", \"…\"]`",
        _ => "",
    }
}
