//! Numbers in the panels: those of the registry's own writing
//! ([`numeral`](grainfall::measure::numeral)), and what the panels say with them.

pub use grainfall::measure::numeral::{
    capitalised, fixed, moment, power_of_ten, prefix_for, rounded, short, times, trimmed,
    with_prefix,
};

use grainfall::measure::Measure;

/// `value` with two digits or so: `0.0042`, `0.25`, `3.1`, `120`.
pub fn rough(value: f64) -> String {
    rounded(value, 2)
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
    fn short_times_have_a_prefix() {
        assert_eq!(short_time(1.25e-5), "12.50 µs");
    }
}
