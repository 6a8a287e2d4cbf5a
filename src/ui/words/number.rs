//! Numbers as people read them: a few digits, a unit, powers of ten in superscript.

use crate::measure::{Measure, Quantity};
use crate::simulation::DisplayUnit;

/// What stands where there is no number.
const NOTHING: &str = "–";

/// `value` with about four digits; small and large ones as `1.23·10⁻⁹`, and a dash for what is no
/// number.
pub fn short(value: f64) -> String {
    if !value.is_finite() {
        return if value.is_nan() {
            NOTHING.into()
        } else {
            "∞".into()
        };
    }
    let magnitude = value.abs();
    if magnitude == 0.0 {
        return "0".into();
    }
    if (1e-3..1e5).contains(&magnitude) {
        let decimals = (3 - magnitude.log10().floor() as i32).clamp(0, 5);
        return signed(format!("{value:.*}", decimals as usize));
    }
    let exponent = magnitude.log10().floor() as i32;
    let mantissa = value / 10_f64.powi(exponent);
    format!(
        "{}·{}",
        signed(format!("{mantissa:.2}")),
        power_of_ten(exponent)
    )
}

/// The same without zeros at its end: `0.4`, `1.41`.
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

/// `value` with `decimals` digits after the point, and a dash for what is no number.
pub fn fixed(value: f64, decimals: usize) -> String {
    if value.is_finite() {
        signed(format!("{value:.decimals$}"))
    } else {
        NOTHING.into()
    }
}

/// `10⁻⁹` for −9.
pub fn power_of_ten(exponent: i32) -> String {
    let superscript = |digit: char| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => char::from_u32('⁰' as u32 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
    };
    let digits = exponent
        .to_string()
        .chars()
        .map(superscript)
        .collect::<String>();
    format!("10{digits}")
}

/// A time step or another short time [s]: `12.3 µs`.
pub fn short_time(seconds: f64) -> String {
    with_prefix(seconds, "s")
}

/// `value` with the prefix of its unit that leaves one to three digits before the point: `12.3 mJ`.
pub fn with_prefix(value: f64, unit: &str) -> String {
    let (prefix, factor) = prefix_for(value.abs());
    format!("{} {prefix}{unit}", short(value * factor))
}

/// The prefix in which `magnitude` has one to three digits before the point, and the factor that
/// goes with it.
pub fn prefix_for(magnitude: f64) -> (&'static str, f64) {
    const PREFIXES: [(&str, f64); 7] = [
        ("p", 1e12),
        ("n", 1e9),
        ("µ", 1e6),
        ("m", 1e3),
        ("", 1.0),
        ("k", 1e-3),
        ("M", 1e-6),
    ];
    if magnitude == 0.0 || !magnitude.is_finite() {
        return ("", 1.0);
    }
    let fits = |(_, factor): &&(&str, f64)| magnitude * factor >= 1.0;
    PREFIXES
        .iter()
        .rev()
        .find(fits)
        .copied()
        .unwrap_or(PREFIXES[0])
}

/// The unit in which panels show a quantity that is kept in `unit`: degrees for radians, nothing
/// for a pure number.
pub fn display_unit(unit: &'static str) -> DisplayUnit {
    let degrees = 180.0 / std::f64::consts::PI;
    match unit {
        "rad" => DisplayUnit {
            name: "°",
            factor: degrees,
        },
        "rad/s" => DisplayUnit {
            name: "°/s",
            factor: degrees,
        },
        "1" => DisplayUnit {
            name: "",
            factor: 1.0,
        },
        name => DisplayUnit { name, factor: 1.0 },
    }
}

/// `value`, in the SI unit `unit`, with the unit that panels show it in: `24.31 °`.
pub fn with_unit(value: f64, unit: &'static str) -> String {
    let shown = display_unit(unit);
    let number = short(value * shown.factor);
    if shown.name.is_empty() || number == NOTHING {
        number
    } else {
        format!("{number} {}", shown.name)
    }
}

/// Name and symbol of a measure with a capital: `Surface angle θ`.
pub fn title(measure: Measure) -> String {
    let Quantity { name, symbol, .. } = measure.quantity();
    format!("{} {symbol}", capitalised(name))
}

/// `text` with a capital first letter.
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

/// `text` with a true minus sign.
fn signed(text: String) -> String {
    text.replacen('-', "−", 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_about_four_digits_and_powers_of_ten_stand_high() {
        assert_eq!(short(24.305_1), "24.31");
        assert_eq!(short(-0.05), "−0.05000");
        assert_eq!(short(2.0e-9), "2.00·10⁻⁹");
        assert_eq!(short(f64::NAN), "–");
        assert_eq!(short(f64::INFINITY), "∞");
        assert_eq!(trimmed(0.4), "0.4");
        let speeds = [0.0042, 0.25, 3.08, 12.0, 120.4].map(rough);
        assert_eq!(speeds, ["0.0042", "0.25", "3.1", "12", "120"]);
        assert_eq!(trimmed(1410.0), "1410");
        assert_eq!(trimmed(2.0e-9), "2.00·10⁻⁹");
    }

    #[test]
    fn a_prefix_leaves_one_to_three_digits_before_the_point() {
        assert_eq!(short_time(1.25e-5), "12.50 µs");
        assert_eq!(with_prefix(0.0651, "J"), "65.10 mJ");
        assert_eq!(with_prefix(0.0, "J"), "0 J");
    }

    #[test]
    fn angles_are_shown_in_degrees() {
        assert_eq!(with_unit(std::f64::consts::FRAC_PI_6, "rad"), "30.00 °");
        assert_eq!(with_unit(0.61, "1"), "0.6100");
        assert_eq!(with_unit(f64::NAN, "rad"), "–");
    }
}
