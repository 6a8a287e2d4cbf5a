//! A lesson as plain data, in SI units, and how a question is measured.
//!
//! In: nothing. Out: the types that a file is read into. How files spell them stands in `file`.

use crate::measure::{Estimate, GrainQuantity, Measure, Series, Window};
use crate::parameters::{Parameter, Value};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A checked lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct Lesson {
    /// What it is called: a file, or a built-in lesson's name.
    pub name: String,
    /// Title, one line.
    pub title: String,
    /// What it is about, a sentence or two.
    pub about: String,
    /// Where its numbers come from.
    pub source: String,
    /// Its scene: the name of a built-in one, or a file in the lesson's own folder.
    pub scene: String,
    /// Values that replace the scene's, as keys and texts.
    pub settings: Vec<(String, String)>,
    /// How its picture looks at first.
    pub look: LessonLook,
    /// Its steps, at least one.
    pub steps: Vec<LessonStep>,
    /// The file's text, by which a session keeps it.
    pub text: String,
}

/// A step: one idea.
#[derive(Clone, Debug, PartialEq)]
pub struct LessonStep {
    /// Its title, unlike that of any other step.
    pub title: String,
    /// What the student reads.
    pub text: String,
    /// What the student is to touch.
    pub touch: Vec<Touch>,
    /// Values of live parameters with which its experiment is played; all others are the scene's.
    pub set: Vec<(Parameter, Value)>,
    /// Simulated seconds per second with which it is played; as it is where there is none.
    pub speed: Option<f64>,
    /// How the picture looks from this step on, where that changes.
    pub look: Option<LessonLook>,
    /// What is to be predicted, if anything.
    pub question: Option<Question>,
    /// Hints, the most helpful last.
    pub hints: Vec<String>,
    /// What explains the answer, once it is measured.
    pub why: String,
}

/// Something that a student is to touch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Touch {
    /// A live parameter.
    Parameter(Parameter),
    /// The button that plays and pauses.
    Play,
    /// The choice of the speed.
    Speed,
    /// The button that starts afresh.
    Afresh,
    /// The timeline.
    Time,
}

impl Touch {
    /// Whether it is the same as `other`, in whichever order they name two materials.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Parameter(one), Self::Parameter(other)) => is_same_parameter(one, other),
            _ => self == other,
        }
    }
}

/// Whether both are the same parameter, in whichever order they name two materials.
pub(super) fn is_same_parameter(one: &Parameter, other: &Parameter) -> bool {
    let [a, b] = other.names();
    let is_swapped = one.names() == [b, a] && one.pair().is_some();
    one == other || (is_swapped && one.row().key == other.row().key)
}

/// What a student predicts.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// The question in words.
    pub text: String,
    /// What answers it.
    pub measurement: Measurement,
    /// What kind of answer it has.
    pub kind: QuestionKind,
}

/// What kind of answer a question has. Numbers are in the quantity's SI unit.
#[derive(Clone, Debug, PartialEq)]
pub enum QuestionKind {
    /// A number.
    Number {
        /// How far a good prediction is from what is measured at most.
        tolerance: f64,
        /// Where the author found the answer.
        expected: Option<(f64, f64)>,
    },
    /// Whether it is higher, lower or the same as in an earlier step.
    Change {
        /// That step's index.
        than: usize,
        /// Differences up to this one count as the same.
        same_within: f64,
        /// What the author found.
        expected: Option<Change>,
    },
}

/// A direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Change {
    /// More.
    Higher,
    /// Less.
    Lower,
    /// Neither.
    Same,
}

impl Change {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Higher, Self::Lower, Self::Same];

    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Higher => "higher",
            Self::Lower => "lower",
            Self::Same => "the same",
        }
    }
}

/// What a student said. A number is in the quantity's SI unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Prediction {
    /// A number.
    Number(f64),
    /// A direction.
    Change(Change),
}

/// Which number of a run answers a question.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// The measured quantity.
    pub quantity: Measure,
    /// What is taken of it over the span.
    pub of: Statistic,
    /// From when to when, in simulated seconds since the run began [s].
    pub span: Range<f64>,
    /// How much runs with other seeds differ, where the author has found out: it takes the place of
    /// the error that one run tells of itself.
    pub scatter: Option<RunScatter>,
}

/// What is taken of a quantity over a span.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Statistic {
    /// Its mean over time.
    #[default]
    Mean,
    /// Its largest value.
    Largest,
    /// Its value at the end.
    Last,
}

/// How much equal runs with other seeds differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunScatter {
    /// Standard deviation from run to run [SI unit of the quantity].
    pub deviation: f64,
    /// Of how many runs.
    pub runs: usize,
}

impl Measurement {
    /// What `series`, samples from the start of a run on, comes to; none before the span is over.
    /// Where no sample of the span has a value the mean is NaN.
    pub fn of(&self, series: &Series) -> Option<Estimate> {
        let newest = *series.time().last()?;
        if newest < self.span.end {
            return None;
        }
        let window = Window::between(series, self.span.start, self.span.end);
        let one = |value: f64| Estimate::too_short(value, 1);
        let own = match self.of {
            Statistic::Mean => window.mean(self.quantity),
            Statistic::Largest => one(window.largest(self.quantity)),
            Statistic::Last => one(window.at_end(self.quantity)),
        };
        Some(match self.scatter {
            Some(scatter) => Estimate {
                error: Some(scatter.deviation),
                freedom: scatter.runs - 1,
                ..own
            },
            None => own,
        })
    }
}

/// How the picture of a lesson looks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LessonLook {
    /// What gives the grains' colours; their species where there is none.
    pub colour_by: Option<GrainQuantity>,
    /// From where it is seen; as it is where there is none.
    pub from: Option<LessonView>,
    /// What is drawn beside the grains.
    pub show: Vec<Shown>,
    /// What is cut away; nothing where there is none.
    pub cut: Option<LessonCut>,
}

/// What of a lesson's picture is cut away.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum LessonCut {
    /// What lies in front of the plane z = 0.
    Across,
    /// The quarter with x > 0 and z > 0.
    Quarter,
}

/// From where a lesson's picture is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum LessonView {
    /// As scenes open.
    Home,
    /// From the front.
    Front,
    /// From the right.
    Right,
    /// From above.
    Above,
}

/// What is drawn beside the grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Shown {
    /// Contact forces.
    Forces,
    /// Liquid bridges.
    Bridges,
    /// Velocities.
    Velocities,
    /// How grains have turned.
    Turning,
    /// The flowing layer of a drum.
    Flow,
    /// The granular temperature, as a veil.
    Temperature,
}
