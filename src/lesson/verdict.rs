//! What a prediction and a measurement come to: the rules, and their words.
//!
//! In: a question, what was predicted, what was measured (with errors). Out: a [`Judged`]. The rules
//! are the project's own:
//!
//! | prediction | it was right | it was wrong |
//! |---|---|---|
//! | a number | the 95 % interval of what was measured lies within the tolerance of it | that interval lies wholly outside |
//! | *the same* | the 95 % interval of the difference lies within `same_within` | the difference is larger, by more than scatter |
//! | *higher*, *lower* | the difference is that, by more than scatter, and not the same | the same, or the other direction |
//!
//! Whatever these leave open is *not decided*, and so is all of which an error is not known.

use super::description::{Change, Prediction, Question, QuestionKind};
use crate::measure::{Difference, Estimate, Quantity, Verdict, numeral};

/// What becomes of a prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// Whether it was right.
    pub verdict: Verdict,
    /// What was measured, beside what was said, in words.
    pub text: String,
    /// Whether it is not what the lesson's author found: something else was changed, or the
    /// author is wrong.
    pub is_unexpected: bool,
}

/// What becomes of `prediction`, an answer to `question`, where the run `measured` this; `earlier`
/// is what was measured in the step that the question compares with.
pub fn judge(
    question: &Question,
    prediction: Prediction,
    measured: Estimate,
    earlier: Option<Estimate>,
) -> Judged {
    let quantity = question.measurement.quantity.quantity();
    if measured.mean.is_nan() {
        return Judged {
            verdict: Verdict::NotDecided,
            text: "There was nothing to measure in this run.".to_owned(),
            is_unexpected: true,
        };
    }
    match (&question.kind, prediction) {
        (
            QuestionKind::Number {
                tolerance,
                expected,
            },
            Prediction::Number(said),
        ) => Judged {
            is_unexpected: expected.is_some_and(|(low, high)| {
                Verdict::of_between(measured, low..high) == Verdict::DoesNot
            }),
            ..judge_number(quantity, said, *tolerance, measured)
        },
        (
            QuestionKind::Change {
                same_within,
                expected,
                ..
            },
            Prediction::Change(said),
        ) => {
            let change =
                earlier.and_then(|earlier| measured_change(measured, earlier, *same_within));
            Judged {
                is_unexpected: expected
                    .zip(change)
                    .is_some_and(|(own, found)| own != found),
                ..judge_change(
                    quantity,
                    said,
                    *same_within,
                    [measured, earlier.unwrap_or(NOTHING)],
                )
            }
        }
        // A session of somebody else's may hold an answer of the other kind.
        _ => Judged {
            verdict: Verdict::NotDecided,
            text: "This is no answer to the question.".to_owned(),
            is_unexpected: false,
        },
    }
}

const NOTHING: Estimate = Estimate {
    mean: f64::NAN,
    error: None,
    samples: 0,
    freedom: 0,
};

fn judge_number(quantity: &Quantity, said: f64, tolerance: f64, measured: Estimate) -> Judged {
    let verdict = Verdict::of_between(measured, said - tolerance..said + tolerance);
    let [said_text, tolerance_text] = [said, tolerance].map(|value| predicted(quantity, value));
    let off = rough(quantity, (said - measured.mean).abs());
    let side = if said > measured.mean { "high" } else { "low" };
    let end = match verdict {
        Verdict::Holds => format!("Within {tolerance_text}: well predicted."),
        Verdict::DoesNot => format!("Your prediction was {off} too {side}."),
        _ if measured.error.is_none() => {
            "The run was too short to say how sure that is.".to_owned()
        }
        _ => format!(
            "That is about {tolerance_text} away, and the measurement is not sure enough to say on which side."
        ),
    };
    Judged {
        verdict,
        text: format!(
            "You said {said_text}. Measured: {}. {end}",
            quantity.text(measured)
        ),
        is_unexpected: false,
    }
}

fn judge_change(
    quantity: &Quantity,
    said: Change,
    same_within: f64,
    [measured, earlier]: [Estimate; 2],
) -> Judged {
    let found = measured_change(measured, earlier, same_within);
    let verdict = match found {
        None => Verdict::NotDecided,
        Some(found) if found == said => Verdict::Holds,
        Some(_) => Verdict::DoesNot,
    };
    let difference = Difference::between(measured, earlier).map_or_else(
        || "no difference can be told".to_owned(),
        |difference| {
            let text = quantity.text_with_error(difference.value, difference.error);
            format!("the difference is {text}")
        },
    );
    let end = match (found, verdict) {
        (None, _) => "Scatter is too large to tell a direction.".to_owned(),
        (Some(found), Verdict::Holds) => format!("It is {}: well predicted.", found.word()),
        (Some(found), _) => format!("It is {}.", found.word()),
    };
    let [now, before] = [measured, earlier].map(|mean| quantity.text(mean));
    Judged {
        verdict,
        text: format!(
            "You said {}. Measured: {now}, and {before} before; {difference}. {end}",
            said.word()
        ),
        is_unexpected: false,
    }
}

/// Whether `measured` is higher or lower than `earlier`, or the same to within `same_within`; none
/// where scatter does not let tell.
pub fn measured_change(measured: Estimate, earlier: Estimate, same_within: f64) -> Option<Change> {
    let difference = Difference::between(measured, earlier)?;
    let (low, high) = difference.interval();
    if low >= -same_within && high <= same_within {
        Some(Change::Same)
    } else if !difference.is_significant() {
        None
    } else if difference.value > 0.0 {
        Some(Change::Higher)
    } else {
        Some(Change::Lower)
    }
}

/// A number that a person said, with the unit that people read and no more digits than they gave.
fn predicted(quantity: &Quantity, value: f64) -> String {
    let shown = quantity.unit.shown;
    numeral::beside_unit(&numeral::trimmed(value * shown.factor), shown.name)
}

/// The same of a difference, to two digits.
fn rough(quantity: &Quantity, value: f64) -> String {
    let shown = quantity.unit.shown;
    numeral::beside_unit(&numeral::rounded(value * shown.factor, 2), shown.name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lesson::{Measurement, RunScatter, Statistic};
    use crate::measure::{Measure, Sample, Series};

    const DEGREE: f64 = std::f64::consts::PI / 180.0;

    fn question(kind: QuestionKind) -> Question {
        Question {
            text: "How steep?".into(),
            measurement: Measurement {
                quantity: Measure::SurfaceAngle,
                of: Statistic::Mean,
                span: 1.0..9.0,
                scatter: None,
            },
            kind,
        }
    }

    /// A mean of ten runs [°].
    fn mean(mean: f64, error: f64) -> Estimate {
        Estimate {
            mean: mean * DEGREE,
            error: Some(error * DEGREE),
            samples: 10,
            freedom: 9,
        }
    }

    fn number(said: f64, measured: Estimate) -> Judged {
        let question = question(QuestionKind::Number {
            tolerance: 5.0 * DEGREE,
            expected: Some((20.0 * DEGREE, 30.0 * DEGREE)),
        });
        judge(&question, Prediction::Number(said * DEGREE), measured, None)
    }

    #[test]
    fn a_number_is_right_where_the_whole_interval_lies_within_the_tolerance() {
        // 95 % of ten runs are 2.26 errors: 0.9°.
        let judged = number(28.0, mean(25.0, 0.4));
        assert_eq!(judged.verdict, Verdict::Holds);
        assert_eq!(
            judged.text,
            "You said 28°. Measured: 25.0° ± 0.4°. Within 5°: well predicted."
        );
        assert!(!judged.is_unexpected);
        let judged = number(45.0, mean(25.0, 0.4));
        assert_eq!(judged.verdict, Verdict::DoesNot);
        assert!(
            judged.text.ends_with("Your prediction was 20° too high."),
            "{}",
            judged.text
        );
        assert!(number(10.0, mean(25.0, 0.4)).text.ends_with("15° too low."));
        assert_eq!(number(29.5, mean(25.0, 0.4)).verdict, Verdict::NotDecided);
        assert!(number(40.0, mean(40.0, 0.4)).is_unexpected);
        let short = Estimate::too_short(25.0 * DEGREE, 3);
        let judged = number(25.0, short);
        assert_eq!(judged.verdict, Verdict::NotDecided);
        assert!(judged.text.contains("± ?"), "{}", judged.text);
        assert!(
            number(25.0, Estimate::too_short(f64::NAN, 0))
                .text
                .contains("nothing to measure")
        );
    }

    #[test]
    fn a_direction_is_told_by_the_test_of_two_means() {
        let change = |now, before| measured_change(now, before, 3.0 * DEGREE);
        assert_eq!(
            change(mean(25.0, 0.4), mean(18.0, 0.4)),
            Some(Change::Higher)
        );
        assert_eq!(
            change(mean(18.0, 0.4), mean(25.0, 0.4)),
            Some(Change::Lower)
        );
        assert_eq!(change(mean(25.0, 0.4), mean(24.0, 0.4)), Some(Change::Same));
        // By more than scatter, yet by less than matters.
        assert_eq!(change(mean(25.0, 0.1), mean(24.0, 0.1)), Some(Change::Same));
        assert_eq!(change(mean(25.0, 2.0), mean(22.0, 2.0)), None);
        assert_eq!(change(mean(25.0, 0.4), Estimate::too_short(0.3, 2)), None);
    }

    #[test]
    fn a_direction_is_judged_in_words() {
        let question = question(QuestionKind::Change {
            than: 0,
            same_within: 3.0 * DEGREE,
            expected: Some(Change::Lower),
        });
        let say = |said, now, before| judge(&question, Prediction::Change(said), now, Some(before));
        let right = say(Change::Lower, mean(18.0, 0.3), mean(25.0, 0.4));
        assert_eq!(right.verdict, Verdict::Holds);
        assert_eq!(
            right.text,
            "You said lower. Measured: 18.0° ± 0.3°, and 25.0° ± 0.4° before; the difference is −7.0° ± 0.5°. It is \
             lower: well predicted."
        );
        let wrong = say(Change::Same, mean(18.0, 0.3), mean(25.0, 0.4));
        assert_eq!(
            (wrong.verdict, wrong.is_unexpected),
            (Verdict::DoesNot, false)
        );
        assert!(say(Change::Higher, mean(25.0, 0.3), mean(18.0, 0.3)).is_unexpected);
        let open = say(Change::Lower, mean(23.0, 2.0), mean(25.0, 2.0));
        assert_eq!(open.verdict, Verdict::NotDecided);
        let number = judge(&question, Prediction::Number(1.0), mean(18.0, 0.3), None);
        assert_eq!(number.verdict, Verdict::NotDecided);
    }

    /// θ of a sawtooth between 20° and 30°, every 20 ms: its mean is 25°.
    fn sawtooth() -> Series {
        let mut series = Series::default();
        for index in 0..600_u32 {
            let mut values = [f64::NAN; Measure::COUNT];
            let phase = f64::from(index % 25) / 24.0;
            values[Measure::SurfaceAngle as usize] = (20.0 + 10.0 * phase) * DEGREE;
            series.push(Sample {
                step: u64::from(index),
                time: f64::from(index) * 0.02,
                values,
            });
        }
        series
    }

    #[test]
    fn a_measurement_waits_for_its_span_and_knows_its_error() {
        let series = sawtooth();
        let mut measurement = question(QuestionKind::Number {
            tolerance: 1.0,
            expected: None,
        })
        .measurement;
        let measured = measurement.of(&series).unwrap();
        assert!((measured.mean / DEGREE - 25.0).abs() < 0.2, "{measured:?}");
        assert!(measured.error.is_some_and(|error| error < DEGREE));
        measurement.of = Statistic::Largest;
        let largest = measurement.of(&series).unwrap();
        assert!((largest.mean / DEGREE - 30.0).abs() < 1e-9 && largest.error.is_none());
        measurement.of = Statistic::Last;
        measurement.scatter = Some(RunScatter {
            deviation: 0.5 * DEGREE,
            runs: 8,
        });
        let last = measurement.of(&series).unwrap();
        // The sample at 9 s is the 450th: a tooth begins there.
        assert!((last.mean / DEGREE - 20.0).abs() < 1e-9, "{last:?}");
        assert_eq!((last.error, last.freedom), (Some(0.5 * DEGREE), 7));
        measurement.span = 1.0..13.0;
        assert_eq!(measurement.of(&series), None);
        assert_eq!(measurement.of(&Series::default()), None);
    }
}
