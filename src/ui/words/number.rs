//! Numbers in the panels: those of the registry's own writing
//! ([`numeral`](crate::measure::numeral)), and shorter ones for hints and ranges.

pub use crate::measure::numeral::{
    capitalised, fixed, power_of_ten, prefix_for, short, with_prefix,
};

use crate::measure::Measure;

/// `value` as [`short`] has it without zeros at its end: `0.4`, `1.41`.
pub fn trimmed(value: f64) -> String {
    without_idle_zeros(short(value))
}

fn without_idle_zeros(text: String) -> String {
    if text.contains('.') && !text.contains('·') {
        let kept = text.trim_end_matches('0').trim_end_matches('.');
        kept.to_owned()
    } else {
        text
    }
}

/// `value` with two digits or so: `0.0042`, `0.25`, `3.1`, `120`.
pub fn rough(value: f64) -> String {
    let digits = 1 - value.abs().max(1e-4).log10().floor() as i32;
    without_idle_zeros(fixed(value, digits.clamp(0, 5) as usize))
}

/// A time step or another short time [s]: `12.3 µs`.
pub fn short_time(seconds: f64) -> String {
    with_prefix(seconds, "s")
}

/// Name and symbol of a measure with a capital: `Surface angle θ`.
pub fn title(measure: Measure) -> String {
    measure.quantity().label()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_numbers_have_no_idle_zeros() {
        assert_eq!(trimmed(0.4), "0.4");
        let speeds = [0.0042, 0.25, 3.08, 12.0, 120.4].map(rough);
        assert_eq!(speeds, ["0.0042", "0.25", "3.1", "12", "120"]);
        assert_eq!(trimmed(1410.0), "1410");
        assert_eq!(trimmed(2.0e-9), "2.00·10⁻⁹");
        assert_eq!(short_time(1.25e-5), "12.50 µs");
    }
}
