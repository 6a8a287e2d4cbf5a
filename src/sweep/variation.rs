//! What a sweep varies: a key, and the values that it takes.
//!
//! In: the text of `--vary`. Out: one list of values, or several that go value by value. Values stay
//! text, as `--set` takes them; a range is written out in decimal digits, so that no rounding shows.

use crate::runner::RunnerError;

/// The varied key whose values repeat one experiment.
pub const SEED: &str = "seed";
/// The varied key whose values are names of readings, each for several settings.
pub const READING: &str = "reading";
/// Cases a sweep may have.
pub const MOST_CASES: usize = 10_000;

/// A key and the values it takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variation {
    /// A key of `--set`.
    pub key: String,
    /// Its values as text.
    pub values: Vec<String>,
    /// All that each value sets, as `--set` has it: those that it is a name for, or itself and what
    /// goes with it. None where it sets itself alone.
    pub settings: Vec<Vec<String>>,
    /// Whether it goes value by value with the one before it, instead of being combined with that.
    pub is_tied: bool,
}

impl Variation {
    /// Reads one list: `key=a,b,c`, of which each is a value, a range of whole numbers `0..7` or one
    /// with a step, `0.1..0.5:0.1`, `1mm..3mm:0.5mm`.
    ///
    /// # Errors
    /// When the text has no such form.
    pub fn parse(text: &str) -> Result<Self, RunnerError> {
        let refuse = |reason: &str| RunnerError::Input(format!("--vary {text}: expected {reason}"));
        let form = || {
            refuse(
                "KEY=VALUES, such as liquid=0..7, radius=3mm,2mm,1.25mm or \
                 drum-speed=1rpm..5rpm:0.5rpm",
            )
        };
        let (key, list) = text.split_once('=').ok_or_else(form)?;
        let mut values = Vec::new();
        for part in list.split(',').map(str::trim) {
            if part.contains("..") {
                let range = Range::parse(part).ok_or_else(form)?;
                let count = range.count();
                if count < 1 {
                    return Err(form());
                }
                if count > MOST_CASES as i128 {
                    return Err(refuse(&format!(
                        "KEY=VALUES with at most {MOST_CASES} values, not {count}"
                    )));
                }
                values.extend(range.values());
            } else {
                values.push(part.to_owned());
            }
        }
        if key.trim().is_empty() || values.iter().any(String::is_empty) {
            return Err(form());
        }
        Ok(Self {
            key: key.trim().to_owned(),
            values,
            settings: Vec::new(),
            is_tied: false,
        })
    }

    /// What is set where it has this `value`, as `--set` has it.
    pub fn settings_of(&self, value: &str) -> Vec<String> {
        if self.settings.is_empty() {
            return vec![format!("{}={value}", self.key)];
        }
        let index = self.values.iter().position(|own| own == value);
        let named = index.and_then(|index| self.settings.get(index));
        named.cloned().unwrap_or_default()
    }

    /// So many seeds from `first` on: the same experiment, repeated.
    pub fn of_seeds(first: u64, count: u16) -> Self {
        let seeds = (0..u64::from(count)).map(|k| first.wrapping_add(k).to_string());
        Self {
            key: SEED.to_owned(),
            values: seeds.collect(),
            settings: Vec::new(),
            is_tied: false,
        }
    }

    /// Reads one `--vary`: a list, or several with `;` between them, which go value by value.
    ///
    /// # Errors
    /// When a list has not its form, or they are not equally long.
    pub fn parse_tied(text: &str) -> Result<Vec<Self>, RunnerError> {
        let mut lists: Vec<Self> = text.split(';').map(Self::parse).collect::<Result<_, _>>()?;
        for list in &mut lists[1..] {
            list.is_tied = true;
        }
        check_lengths(&lists)?;
        Ok(lists)
    }
}

/// Refuses lists that go value by value and are not equally long.
///
/// # Errors
/// With both of the first two that differ.
pub fn check_lengths(tied: &[Variation]) -> Result<(), RunnerError> {
    let pairs = tied.windows(2);
    let mut unlike = pairs.filter(|pair| pair[0].values.len() != pair[1].values.len());
    match unlike.next() {
        None => Ok(()),
        Some(pair) => Err(RunnerError::Input(format!(
            "--vary: lists that go value by value have one length, but {} has {} values and {} has {}",
            pair[0].key,
            pair[0].values.len(),
            pair[1].key,
            pair[1].values.len()
        ))),
    }
}

/// Numbers at equal distances, in one unit.
struct Range<'a> {
    first: i128,
    last: i128,
    step: i128,
    /// Digits of each behind the point.
    places: u32,
    unit: &'a str,
}

impl<'a> Range<'a> {
    /// `0..7`, `0.1..0.5:0.1`, `1mm..3mm:0.5mm`; where only some have a unit, all have it.
    fn parse(text: &'a str) -> Option<Self> {
        let (first, rest) = text.split_once("..")?;
        let (last, step) = match rest.split_once(':') {
            Some((last, step)) => (last, Some(step)),
            None => (rest, None),
        };
        let numbers = [first, last, step.unwrap_or("1")].map(Decimal::parse);
        let [first, last, by] = [numbers[0]?, numbers[1]?, numbers[2]?];
        let all = [first, last, by];
        let mut units = all
            .iter()
            .map(|number| number.unit)
            .filter(|u| !u.is_empty());
        let unit = units.next().unwrap_or("");
        let places = all.iter().map(|number| number.places).max()?;
        if units.any(|other| other != unit) || (step.is_none() && places > 0) {
            return None;
        }
        let [first, last, step] = all.map(|number| number.with(places));
        let range = Self {
            first: first?,
            last: last?,
            step: step?,
            places,
            unit,
        };
        (range.step != 0).then_some(range)
    }

    /// How many values there are; none or less where the step leads away.
    fn count(&self) -> i128 {
        let span = (self.last - self.first) * self.step.signum();
        span.div_euclid(self.step.abs()) + 1
    }

    fn values(&self) -> impl Iterator<Item = String> {
        (0..self.count()).map(|k| {
            let number = self.first + k * self.step;
            let scale = 10_i128.pow(self.places);
            let sign = if number < 0 { "-" } else { "" };
            let (whole, rest) = (number.abs() / scale, number.abs() % scale);
            let places = self.places as usize;
            let fraction = format!("{rest:0places$}");
            let text = match fraction.trim_end_matches('0') {
                "" => format!("{sign}{whole}"),
                digits => format!("{sign}{whole}.{digits}"),
            };
            text + self.unit
        })
    }
}

/// A number as its digits: `digits / 10^places`.
#[derive(Clone, Copy)]
struct Decimal<'a> {
    digits: i128,
    places: u32,
    unit: &'a str,
}

/// Most digits of a number in a range.
const MOST_DIGITS: usize = 19;

impl<'a> Decimal<'a> {
    fn parse(text: &'a str) -> Option<Self> {
        let text = text.trim();
        let is_number = |c: char| c.is_ascii_digit() || matches!(c, '-' | '+' | '.');
        let end = text.find(|c| !is_number(c)).unwrap_or(text.len());
        let (number, unit) = text.split_at(end);
        let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
        let unit = unit.trim();
        let is_power = unit.contains(|c: char| c.is_ascii_digit());
        if is_power || fraction.contains(['-', '+']) || number.len() > MOST_DIGITS + 2 {
            return None;
        }
        Some(Self {
            digits: format!("{whole}{fraction}").parse().ok()?,
            places: fraction.len() as u32,
            unit,
        })
    }

    /// Its digits with so many behind the point.
    fn with(self, places: u32) -> Option<i128> {
        self.digits.checked_mul(10_i128.pow(places - self.places))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        Variation::parse(text).unwrap().values
    }

    #[test]
    fn ranges_are_written_out_in_decimal_digits() {
        assert_eq!(values("liquid=0..3"), ["0", "1", "2", "3"]);
        let tenths = ["0.1", "0.2", "0.3", "0.4", "0.5"];
        assert_eq!(values("mix=0.1..0.5:0.1"), tenths);
        assert_eq!(values("radius=1mm..2mm:0.5mm"), ["1mm", "1.5mm", "2mm"]);
        assert_eq!(values("radius=1..2:0.25mm"), values("radius=1mm..2mm:0.25"));
        assert_eq!(values("g=3..-1:-1.5"), ["3", "1.5", "0"]);
        assert_eq!(values("g=0..1:0.3"), ["0", "0.3", "0.6", "0.9"]);
        assert_eq!(
            values("seed=7,1..2, 40..60:10"),
            ["7", "1", "2", "40", "50", "60"]
        );
        assert_eq!(values("g=-0.05..0.05:0.05"), ["-0.05", "0", "0.05"]);
    }

    #[test]
    fn ranges_that_lead_nowhere_or_are_none_are_refused() {
        for text in [
            "g=0..1:0",
            "g=0..1:-1",
            "g=0.5..1",
            "g=1mm..2cm:1mm",
            "g=1e3..2e3:100",
            "g=..3",
            "g=0..1:",
            "g=0..1:0.00000001",
            "g=1-2..3",
            "g=1..2..3",
        ] {
            let message = Variation::parse(text).unwrap_err().to_string();
            assert!(message.contains("expected KEY=VALUES"), "{text}: {message}");
        }
    }

    #[test]
    fn lists_with_a_semicolon_between_them_are_tied_and_equally_long() {
        let tied = Variation::parse_tied("radius=3mm,2mm; count=470,1600").unwrap();
        assert_eq!([tied[0].is_tied, tied[1].is_tied], [false, true]);
        assert_eq!(tied[1].key, "count");
        let message = Variation::parse_tied("radius=3mm,2mm;count=470").unwrap_err();
        let message = message.to_string();
        assert!(
            message.contains("radius has 2 values and count has 1"),
            "{message}"
        );
    }
}
