//! A lesson while somebody follows it: the present step, what was predicted and measured in each,
//! which hints are shown.
//!
//! In: a lesson, what a person does, what is seen of the run. Out: what is to be shown, commands for
//! the run. A session keeps it as a text, the lesson's own text included, so that it goes on where
//! its file is not at hand; what is read back passes the same checks as a file does.

use super::description::{Lesson, LessonLook, LessonStep, Prediction, QuestionKind};
use super::experiment::{Course, Experiment, Seen, commands_of};
use super::verdict::{Judged, judge};
use crate::measure::{Estimate, Verdict};
use crate::parameters::{Parameter, ParameterInfo, Value};
use crate::run::Command;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A lesson that somebody follows.
#[derive(Clone, Debug, PartialEq)]
pub struct LessonUnderWay {
    lesson: Arc<Lesson>,
    step: usize,
    answers: Vec<Answer>,
    experiment: Option<Experiment>,
    /// Why the last experiment gave no answer.
    spoilt: Option<&'static str>,
}

/// What was done in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// What was predicted.
    pub prediction: Option<Prediction>,
    /// What was measured.
    pub measured: Option<Estimate>,
    /// How many hints are shown.
    pub hints: usize,
}

/// How far the present step has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stage {
    /// There is nothing to answer.
    Reading,
    /// The step that it compares with, of this index, has to be played first.
    Waiting(usize),
    /// A prediction is asked for.
    Asking,
    /// It is made, and the experiment is to be played.
    Predicted,
    /// The experiment goes on; so much of it is over, 0 … 1.
    Playing(f64),
    /// It has answered.
    Answered,
}

/// A lesson as a session keeps it.
#[derive(Serialize, Deserialize)]
struct Kept {
    name: String,
    text: String,
    step: usize,
    answers: Vec<KeptAnswer>,
}

#[derive(Serialize, Deserialize)]
struct KeptAnswer {
    prediction: Option<Prediction>,
    measured: Option<KeptEstimate>,
    hints: usize,
}

#[derive(Serialize, Deserialize)]
struct KeptEstimate {
    /// None where there was nothing to measure.
    mean: Option<f64>,
    error: Option<f64>,
    samples: usize,
    freedom: usize,
}

impl LessonUnderWay {
    /// `lesson` at its first step.
    pub fn new(lesson: Lesson) -> Self {
        Self {
            answers: vec![Answer::default(); lesson.steps.len()],
            lesson: Arc::new(lesson),
            step: 0,
            experiment: None,
            spoilt: None,
        }
    }

    /// The lesson.
    pub fn lesson(&self) -> &Lesson {
        &self.lesson
    }

    /// The present step's index.
    pub fn index(&self) -> usize {
        self.step
    }

    /// The present step.
    pub fn step(&self) -> &LessonStep {
        &self.lesson.steps[self.step]
    }

    /// What was done in the present step.
    pub fn answer(&self) -> &Answer {
        &self.answers[self.step]
    }

    /// How far the present step has come.
    pub fn stage(&self) -> Stage {
        let Some(question) = &self.step().question else {
            return Stage::Reading;
        };
        if let Some(experiment) = &self.experiment {
            return Stage::Playing(experiment.progress);
        }
        let answer = self.answer();
        match question.kind {
            QuestionKind::Change { than, .. } if self.answers[than].measured.is_none() => {
                Stage::Waiting(than)
            }
            _ if answer.measured.is_some() => Stage::Answered,
            _ if answer.prediction.is_some() => Stage::Predicted,
            _ => Stage::Asking,
        }
    }

    /// Why the last experiment gave no answer, where it did not.
    pub fn spoilt(&self) -> Option<&'static str> {
        self.spoilt
    }

    /// How the picture is to look in the present step.
    pub fn look(&self) -> &LessonLook {
        let steps = self.lesson.steps[..=self.step].iter().rev();
        let mut own = steps.filter_map(|step| step.look.as_ref());
        own.next().unwrap_or(&self.lesson.look)
    }

    /// Whether there is a step after the present one.
    pub fn has_next(&self) -> bool {
        self.step + 1 < self.lesson.steps.len()
    }

    /// Shows the next step, where there is one.
    pub fn go_on(&mut self) {
        if self.has_next() {
            self.show(self.step + 1);
        }
    }

    /// Shows the step before, where there is one.
    pub fn go_back(&mut self) {
        if let Some(before) = self.step.checked_sub(1) {
            self.show(before);
        }
    }

    /// Shows the step at `index`; what is played there is given up.
    pub fn show(&mut self, index: usize) {
        if index != self.step && index < self.lesson.steps.len() {
            self.step = index;
            self.experiment = None;
            self.spoilt = None;
        }
    }

    /// Takes a prediction, while one is asked for or not yet played.
    pub fn predict(&mut self, prediction: Prediction) {
        let question = self.step().question.as_ref();
        let fits = question.is_some_and(|question| match prediction {
            Prediction::Number(said) => {
                matches!(question.kind, QuestionKind::Number { .. }) && said.is_finite()
            }
            Prediction::Change(_) => matches!(question.kind, QuestionKind::Change { .. }),
        });
        if fits && matches!(self.stage(), Stage::Asking | Stage::Predicted) {
            self.answers[self.step].prediction = Some(prediction);
        }
    }

    /// Shows one hint more, where there is one.
    pub fn hint(&mut self) {
        let most = self.step().hints.len();
        let shown = &mut self.answers[self.step].hints;
        *shown = (*shown + 1).min(most);
    }

    /// The hints that are shown.
    pub fn hints(&self) -> &[String] {
        let hints = &self.step().hints;
        &hints[..self.answer().hints.min(hints.len())]
    }

    /// Forgets what was predicted and measured in the present step, so that it can be tried again.
    pub fn try_again(&mut self) {
        self.experiment = None;
        let hints = self.answer().hints;
        self.answers[self.step] = Answer {
            hints,
            ..Answer::default()
        };
    }

    /// The commands that play the present step's experiment, where a prediction is made: in a run
    /// with these `parameters`, of which `value` tells the present value, which shows the `branch`.
    pub fn play(
        &mut self,
        branch: u32,
        parameters: &[ParameterInfo],
        value: impl Fn(&Parameter) -> Option<Value>,
    ) -> Vec<Command> {
        if self.stage() != Stage::Predicted {
            return Vec::new();
        }
        self.spoilt = None;
        self.experiment = Some(Experiment::from(branch));
        commands_of(self.step(), parameters, value)
    }

    /// Follows the run as far as it is `seen`; the command that holds it once it has answered.
    pub fn follow(&mut self, seen: &Seen) -> Option<Command> {
        let (lesson, step) = (self.lesson.clone(), self.step);
        let question = lesson.steps[step].question.as_ref()?;
        let experiment = self.experiment.as_mut()?;
        match experiment.follow(&question.measurement, seen) {
            Course::On => return None,
            Course::Spoilt(reason) => self.spoilt = Some(reason),
            Course::Measured(measured) => self.answers[step].measured = Some(measured),
        }
        self.experiment = None;
        let is_wrong = |judged: Judged| judged.verdict == Verdict::DoesNot;
        if self.answer().hints == 0 && self.judged().is_some_and(is_wrong) {
            self.hint();
        }
        self.spoilt.is_none().then_some(Command::Pause)
    }

    /// What became of the prediction in the present step, once it is measured.
    pub fn judged(&self) -> Option<Judged> {
        let question = self.step().question.as_ref()?;
        let answer = self.answer();
        let earlier = match question.kind {
            QuestionKind::Change { than, .. } => self.answers[than].measured,
            QuestionKind::Number { .. } => None,
        };
        Some(judge(
            question,
            answer.prediction?,
            answer.measured?,
            earlier,
        ))
    }

    /// It as a session keeps it.
    pub fn in_words(&self) -> String {
        let kept = Kept {
            name: self.lesson.name.clone(),
            text: self.lesson.text.clone(),
            step: self.step,
            answers: self.answers.iter().map(KeptAnswer::of).collect(),
        };
        // Plain data, of which every value has a form in JSON.
        serde_json::to_string(&kept).unwrap_or_default()
    }

    /// What a session kept of a lesson in `scene`; none where it is not known, or the lesson does
    /// not pass the checks that its file passes.
    pub fn read(words: &str, scene: &Scene) -> Option<Self> {
        let kept: Kept = serde_json::from_str(words).ok()?;
        let lesson = Lesson::parse(&kept.name, &kept.text).ok()?;
        lesson.check_in(scene).ok()?;
        let mut under_way = Self::new(lesson);
        under_way.step = kept.step.min(under_way.answers.len() - 1);
        for (answer, kept) in under_way.answers.iter_mut().zip(kept.answers) {
            *answer = kept.answer();
        }
        Some(under_way)
    }
}

impl KeptAnswer {
    fn of(answer: &Answer) -> Self {
        let estimate = |own: Estimate| KeptEstimate {
            mean: own.mean.is_finite().then_some(own.mean),
            error: own.error.filter(|error| error.is_finite()),
            samples: own.samples,
            freedom: own.freedom,
        };
        Self {
            prediction: answer.prediction,
            measured: answer.measured.map(estimate),
            hints: answer.hints,
        }
    }

    fn answer(&self) -> Answer {
        let estimate = |own: &KeptEstimate| Estimate {
            mean: own.mean.unwrap_or(f64::NAN),
            error: own.error,
            samples: own.samples,
            freedom: own.freedom,
        };
        Answer {
            prediction: self.prediction,
            measured: self.measured.as_ref().map(estimate),
            hints: self.hints,
        }
    }
}
