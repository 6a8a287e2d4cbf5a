//! Values of one parameter between two ends, evenly or by powers of ten.
//!
//! In: a parameter as a scene has it. Out: the ends that are proposed round its present value, and
//! the values between two ends as text that `--vary` takes too: in the unit that people read, with
//! few digits.

use super::variation::Variation;
use crate::parameters::{Kind, Parameter, ParameterInfo};

/// Values that are proposed.
const PROPOSED: usize = 8;
/// Of those at even distances this one, from 0 on, is the present value.
const PRESENT: f64 = 3.0;
/// Distance of two proposed values over the present one, about.
const STEP: f64 = 0.25;
/// The first proposed value by powers of ten is so many times smaller than the present one, and the
/// last so many times larger.
const FACTOR: f64 = 8.0;
/// Digits of a value.
const DIGITS: i32 = 4;

/// So many values between two ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// The first [SI unit].
    pub from: f64,
    /// The last [SI unit].
    pub to: f64,
    /// How many.
    pub count: usize,
    /// Whether each is the one before times a factor, instead of plus a distance.
    pub by_powers: bool,
}

impl ValueRange {
    /// Eight values round the `present` one [SI unit] within what the parameter takes.
    pub fn around(info: &ParameterInfo, present: f64) -> Self {
        let (row, range) = (info.row(), info.range());
        let factor = row.kind.unit().shown.factor;
        let (low, high) = (range.start() * factor, range.end() * factor);
        let present = present * factor;
        let by_powers = row.is_logarithmic(&range) && present > 0.0;
        let (from, to) = if by_powers {
            let end = |value: f64| rounded(value, 2).clamp(low, high);
            (end(present / FACTOR), end(present * FACTOR))
        } else {
            let whole = row.kind == Kind::Count;
            even_ends(present, low..=high, if whole { 1.0 } else { 0.0 })
        };
        Self {
            from: from / factor,
            to: to / factor,
            count: PROPOSED,
            by_powers,
        }
    }

    /// The values of `parameter`: those that are the same in the digits that are kept stand once.
    pub fn of(&self, parameter: &Parameter) -> Variation {
        let last = self.count.saturating_sub(1).max(1) as f64;
        let at = |k: usize| {
            let share = k as f64 / last;
            if self.by_powers {
                self.from * (self.to / self.from).powf(share)
            } else {
                self.from + (self.to - self.from) * share
            }
        };
        let mut values: Vec<String> = (0..self.count)
            .map(|k| text(parameter, at(k), [self.from, self.to]))
            .collect();
        values.dedup();
        Variation {
            key: parameter.to_string(),
            values,
            settings: Vec::new(),
            is_tied: false,
        }
    }
}

/// The ends of proposed values at round distances, at least `least` apart, round the `present` one
/// and within `range`.
fn even_ends(present: f64, range: std::ops::RangeInclusive<f64>, least: f64) -> (f64, f64) {
    let (low, high) = range.into_inner();
    let steps = (PROPOSED - 1) as f64;
    let room = (high - low) / steps;
    let wanted = if present == 0.0 {
        room
    } else {
        STEP * present.abs()
    };
    let step = round_down(wanted.min(room)).max(least);
    let from = (present - PRESENT * step).min(high - steps * step).max(low);
    (
        rounded(from, DIGITS),
        rounded((from + steps * step).min(high), DIGITS),
    )
}

/// The largest of 1, 2, 5 times a power of ten that is at most `value`; 1 of what is none.
fn round_down(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let power = 10_f64.powf(value.log10().floor());
    let fits = |factor: &f64| factor * power <= value * (1.0 + 1e-9);
    let fitting = [5.0, 2.0, 1.0].into_iter().find(fits);
    fitting.unwrap_or(1.0) * power
}

/// `value` with so many digits in all.
fn rounded(value: f64, digits: i32) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let places = digits - 1 - value.abs().log10().floor() as i32;
    // Through text, so that the digits are those that people read.
    let scale = 10_f64.powi(places.abs());
    let text = if places >= 0 {
        format!("{value:.*}", places as usize)
    } else {
        format!("{}", (value / scale).round() * scale)
    };
    text.parse().unwrap_or(value)
}

/// `value` [SI unit] of `parameter` as `--set` takes it, with few digits where it stays between the
/// `ends` with them, else with all.
fn text(parameter: &Parameter, value: f64, ends: [f64; 2]) -> String {
    let row = parameter.row();
    if row.kind == Kind::Count {
        return row.value(value).to_string();
    }
    let unit = row.kind.unit();
    // A name that no folder can have in its own is written in SI units.
    let is_plain = |letter: char| letter.is_ascii_alphabetic() || matches!(letter, '%' | '°' | 'µ');
    let (factor, name) = if unit.shown.name.chars().all(is_plain) {
        (unit.shown.factor, unit.shown.name)
    } else {
        (1.0, "")
    };
    let few = format!("{}{name}", rounded(value * factor, DIGITS));
    let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
    let is_within =
        |read: f64| (low..=high).contains(&read) || (read - value).abs() < 1e-12 * high.abs();
    match row.parse(&few) {
        Some(read) if is_within(read.number()) => few,
        _ => row.value(value).to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{Value, stated_parameters};
    use crate::scene::Scene;

    fn friction() -> Parameter {
        Parameter::Friction("glass".into(), "glass".into())
    }

    fn values(range: ValueRange, parameter: &Parameter) -> Vec<String> {
        range.of(parameter).values
    }

    fn range(from: f64, to: f64, count: usize, by_powers: bool) -> ValueRange {
        ValueRange {
            from,
            to,
            count,
            by_powers,
        }
    }

    #[test]
    fn values_lie_evenly_or_by_powers_of_ten_in_the_unit_that_people_read() {
        let even = values(range(0.1, 0.8, 8, false), &friction());
        assert_eq!(
            even,
            ["0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8"]
        );
        let powers = values(range(1e-3, 1.0, 4, true), &Parameter::Viscosity);
        assert_eq!(powers, ["0.001", "0.01", "0.1", "1"]);
        let rpm = std::f64::consts::TAU / 60.0;
        let speeds = values(range(rpm, 3.0 * rpm, 3, false), &Parameter::DrumSpeed);
        assert_eq!(speeds, ["1rpm", "2rpm", "3rpm"]);
    }

    #[test]
    fn counts_are_whole_and_none_stands_twice() {
        let counts = values(range(3.0, 5.0, 8, false), &Parameter::GrainCount);
        assert_eq!(counts, ["3", "4", "5"]);
        let same = values(range(0.3, 0.3, 4, false), &friction());
        assert_eq!(same, ["0.3"]);
    }

    #[test]
    fn every_value_reads_back_within_the_ends() {
        for (from, to) in [
            (0.123_456_7, 0.987_654_3),
            (1.0 / 3.0, 2.0 / 3.0),
            (0.0, 1e-7),
        ] {
            for text in values(range(from, to, 7, false), &friction()) {
                let Some(Value::Number(read)) = friction().row().parse(&text) else {
                    panic!("{text} is no number");
                };
                assert!(read >= from && read <= to, "{text} of {from} to {to}");
            }
        }
    }

    #[test]
    fn proposals_are_round_and_within_what_the_parameter_takes() {
        let info = |default: f64, least: f64, most: f64| ParameterInfo {
            parameter: friction(),
            label: "friction".into(),
            values: crate::parameters::Values::Range(least..=most),
            default: default.into(),
            acts: true,
        };
        let ends = |present: f64, least: f64, most: f64| {
            let own = ValueRange::around(&info(present, least, most), present);
            (own.from, own.to)
        };
        let close = |own: (f64, f64), from: f64, to: f64| {
            assert!(
                (own.0 - from).abs() < 1e-12 && (own.1 - to).abs() < 1e-12,
                "{own:?}"
            );
        };
        close(ends(0.4, 0.0, 1.0), 0.1, 0.8);
        close(ends(0.95, 0.0, 1.0), 0.3, 1.0);
        close(ends(0.0, 0.0, 1.0), 0.0, 0.7);
        // Nowhere a value that a scene refuses.
        for scene in ["small-drum", "wet", "column", "bouncing-grain"] {
            for info in stated_parameters(&Scene::open(scene).unwrap()) {
                if !matches!(info.values, crate::parameters::Values::Range(_)) {
                    continue;
                }
                let own = ValueRange::around(&info, info.default.number());
                let (least, most) = info.range().into_inner();
                let slack = 1e-9 * own.to.abs();
                assert!(
                    own.from >= least - slack && own.to <= most + slack && own.from <= own.to,
                    "{scene}, {}: {own:?} of {least} to {most}",
                    info.label
                );
            }
        }
    }
}
