//! Numbers as people read them: a few digits, a prefix, powers of ten in superscript.
//!
//! In: a number. Out: text. Which unit and which digits a measured quantity has is not decided here
//! but in its row of the registry ([`super::Quantity`]).

/// The unit that stands close to its number.
const DEGREE: &str = "°";

/// What stands where there is no number.
pub const NOTHING: &str = "–";

/// `value` with about four digits, small and large ones as `1.23·10⁻⁹`; a dash for what is no
/// number.
pub fn short(value: f64) -> String {
    written(value, significant)
}

/// `value` with `decimals` digits after the point; a dash for what is not finite.
pub fn fixed(value: f64, decimals: usize) -> String {
    if value.is_finite() {
        typeset(&format!("{value:.decimals$}"))
    } else {
        NOTHING.into()
    }
}

/// `value` as [`short`] has it without zeros at its end: `0.4`, `1.41`.
pub fn trimmed(value: f64) -> String {
    without_idle_zeros(short(value))
}

/// `value` with at most so many `digits`, zeros at its end left out, never as a power of ten:
/// `12.5`, `0.0042`, `1500`.
pub fn rounded(value: f64, digits: i32) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let decimals = (digits - 1 - value.abs().log10().floor() as i32).clamp(0, 6);
    without_idle_zeros(fixed(value, decimals as usize))
}

fn without_idle_zeros(text: String) -> String {
    if text.contains('.') && !text.contains('·') {
        let kept = text.trim_end_matches('0').trim_end_matches('.');
        kept.to_owned()
    } else {
        text
    }
}

/// `value` with the prefix of its unit that leaves one to three digits before the point: `12.3 mJ`.
pub fn with_prefix(value: f64, unit: &str) -> String {
    let (prefix, factor) = prefix_for(value.abs());
    format!("{} {prefix}{unit}", short(value * factor))
}

/// A moment or a time of a run [s]: `12.34 s`, below a second with a prefix, `2.000 ms`.
pub fn moment(seconds: f64) -> String {
    // What would be rounded to a second is one.
    if seconds == 0.0 || !seconds.is_finite() || seconds.abs() >= 0.9995 {
        format!("{} s", fixed(seconds, 2))
    } else {
        with_prefix(seconds, "s")
    }
}

/// How often a process goes as fast as its own time, `1.25×`, with two digits where it is slower.
pub fn times(factor: f64) -> String {
    if factor >= 0.995 || !factor.is_finite() {
        format!("{}×", fixed(factor, 2))
    } else {
        format!("{}×", small_share(factor))
    }
}

/// Two digits of a number below one, however small it is.
fn small_share(value: f64) -> String {
    if value == 0.0 || value >= 1e-4 {
        rounded(value, 2)
    } else {
        let exponent = value.log10().floor();
        let digits = fixed(value * 10_f64.powf(-exponent), 1);
        format!("{digits}·{}", power_of_ten(exponent as i32))
    }
}

/// `value ± error` with as many digits as the error allows: two of the error where it begins with a
/// one, one otherwise. Small and large ones stand as `(3.2 ± 0.4)·10⁻⁵`; the `unit` stands behind
/// the whole, a degree behind each: `28.3° ± 0.4°`, `(12.3 ± 0.4) mJ`.
pub(super) fn with_error(value: f64, error: f64, unit: &str) -> String {
    let exponent = value.abs().max(error).log10().floor();
    let is_plain = !exponent.is_finite() || (-3.0..5.0).contains(&exponent);
    let (power, factor) = if is_plain {
        (String::new(), 1.0)
    } else {
        (
            format!("·{}", power_of_ten(exponent as i32)),
            10_f64.powf(-exponent),
        )
    };
    let [value, error] = [value, error].map(|number| number * factor);
    let decimals = decimals_of_error(error);
    let [value, error] = if error == 0.0 {
        [rounded(value, 4), "0".to_owned()]
    } else {
        [value, error].map(|number| fixed(number, decimals))
    };
    if unit == DEGREE && is_plain {
        return format!("{value}{DEGREE} ± {error}{DEGREE}");
    }
    match (power.as_str(), unit) {
        ("", "") => format!("{value} ± {error}"),
        (power, "") => format!("({value} ± {error}){power}"),
        (power, unit) => format!("({value} ± {error}){power} {unit}"),
    }
}

/// Digits after the point with which an `error` is written.
fn decimals_of_error(error: f64) -> usize {
    let exponent = error.log10().floor();
    let begins_with_one = error / 10_f64.powf(exponent) < 1.95;
    let digits = if begins_with_one { 2.0 } else { 1.0 };
    (digits - 1.0 - exponent).clamp(0.0, 6.0) as usize
}

/// `number` with its `unit`, as people write it: a degree stands close, all else after a space.
pub fn beside_unit(number: &str, unit: &str) -> String {
    let space = if unit.is_empty() || unit == DEGREE {
        ""
    } else {
        " "
    };
    format!("{number}{space}{unit}")
}

/// The prefix in which `magnitude` has one to three digits before the point, and the factor that
/// goes with it.
pub fn prefix_for(magnitude: f64) -> (&'static str, f64) {
    prefix_from(magnitude, 1.0)
}

/// The largest prefix in which `magnitude` is at least `least`, and the factor that goes with it.
pub fn prefix_from(magnitude: f64, least: f64) -> (&'static str, f64) {
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
    let fits = |(_, factor): &&(&str, f64)| magnitude * factor >= least;
    PREFIXES
        .iter()
        .rev()
        .find(fits)
        .copied()
        .unwrap_or(PREFIXES[0])
}

/// `10⁻⁹` for −9.
pub fn power_of_ten(exponent: i32) -> String {
    format!("10{}", raised(&exponent.to_string()))
}

/// `text` with a capital first letter.
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

/// `value` as `plain` has it, in the signs of print; `–` for NaN, `∞` for what is infinite.
pub(super) fn written(value: f64, plain: impl Fn(f64) -> String) -> String {
    if value.is_nan() {
        NOTHING.into()
    } else if value.is_infinite() {
        "∞".into()
    } else {
        typeset(&plain(value))
    }
}

/// A finite `value` with about four digits in plain characters: `24.31`, `2.00e-9`.
pub(super) fn significant(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 {
        "0".into()
    } else if (1e-3..1e5).contains(&magnitude) {
        let decimals = (3 - magnitude.log10().floor() as i32).clamp(0, 5);
        format!("{value:.*}", decimals as usize)
    } else {
        format!("{value:.2e}")
    }
}

/// A number in plain characters in those of print: a true minus sign, none before what is rounded to
/// nought, `2.00·10⁻⁹` for `2.00e-9`.
fn typeset(plain: &str) -> String {
    let (mantissa, exponent) = match plain.split_once('e') {
        Some((mantissa, exponent)) => (mantissa, format!("·10{}", raised(exponent))),
        None => (plain, String::new()),
    };
    let is_nought = !mantissa.contains(|digit| ('1'..='9').contains(&digit));
    let sign = if is_nought { "" } else { "−" };
    format!("{}{exponent}", mantissa.replacen('-', sign, 1))
}

/// A whole number in superscript.
fn raised(exponent: &str) -> String {
    let superscript = |digit: char| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => digit
            .to_digit(10)
            .and_then(|value| char::from_u32('⁰' as u32 + value))
            .unwrap_or(digit),
    };
    exponent.chars().map(superscript).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_moments_and_slow_paces_say_something() {
        let moments = [
            (0.0, "0.00 s"),
            (12.345, "12.35 s"),
            (0.9999, "1.00 s"),
            (0.35, "350.0 ms"),
            (2e-3, "2.000 ms"),
            (2e-5, "20.00 µs"),
        ];
        for (time, text) in moments {
            assert_eq!(moment(time), text);
        }
        let paces = [
            (2.0, "2.00×"),
            (0.25, "0.25×"),
            (0.0042, "0.0042×"),
            (2e-5, "2.0·10⁻⁵×"),
        ];
        for (factor, text) in paces {
            assert_eq!(times(factor), text);
        }
    }

    #[test]
    fn numbers_keep_about_four_digits_and_powers_of_ten_stand_high() {
        assert_eq!(short(24.305_1), "24.31");
        assert_eq!(short(-0.05), "−0.05000");
        assert_eq!(short(2.0e-9), "2.00·10⁻⁹");
        assert_eq!(short(-9.999e-10), "−1.00·10⁻⁹");
        assert_eq!(short(0.0), "0");
        assert_eq!(short(f64::NAN), "–");
        assert_eq!(short(f64::INFINITY), "∞");
        assert_eq!(power_of_ten(-40), "10⁻⁴⁰");
        assert_eq!(fixed(-0.25, 1), "−0.2");
        assert_eq!(fixed(-0.04, 1), "0.0");
    }

    #[test]
    fn zeros_at_the_end_are_left_out() {
        assert_eq!(trimmed(0.4), "0.4");
        assert_eq!(trimmed(1410.0), "1410");
        assert_eq!(trimmed(2.0e-9), "2.00·10⁻⁹");
        let three = [0.0, 12.5, 0.025, 1500.0, 2.0, -0.05, 0.1234].map(|x| rounded(x, 3));
        assert_eq!(three, ["0", "12.5", "0.025", "1500", "2", "−0.05", "0.123"]);
        let two = [0.0042, 0.25, 3.08, 12.0, 120.4].map(|x| rounded(x, 2));
        assert_eq!(two, ["0.0042", "0.25", "3.1", "12", "120"]);
    }

    #[test]
    fn an_error_decides_the_digits_of_its_value() {
        assert_eq!(with_error(28.312, 0.41, "°"), "28.3° ± 0.4°");
        assert_eq!(with_error(28.312, 0.14, "°"), "28.31° ± 0.14°");
        assert_eq!(with_error(0.548_31, 0.002_3, ""), "0.548 ± 0.002");
        assert_eq!(
            with_error(3.21e-5, 4.4e-6, "m²/s²"),
            "(3.2 ± 0.4)·10⁻⁵ m²/s²"
        );
        assert_eq!(with_error(845.2, 23.0, ""), "845 ± 23");
        assert_eq!(with_error(-12.34, 0.4, "mJ"), "(−12.3 ± 0.4) mJ");
        assert_eq!(with_error(-0.03, 0.2, "1/m"), "(0.0 ± 0.2) 1/m");
        assert_eq!(with_error(1.0, 0.0, ""), "1 ± 0");
        assert_eq!(with_error(0.0, 0.0, "mm"), "(0 ± 0) mm");
        // The larger of the two decides the power of ten.
        assert_eq!(with_error(1e-8, 3.2e-7, ""), "(0 ± 3)·10⁻⁷");
        assert_eq!(beside_unit("28.31", "°"), "28.31°");
        assert_eq!(beside_unit("3", "mm"), "3 mm");
    }

    #[test]
    fn a_prefix_leaves_one_to_three_digits_before_the_point() {
        assert_eq!(with_prefix(1.25e-5, "s"), "12.50 µs");
        assert_eq!(with_prefix(0.0651, "J"), "65.10 mJ");
        assert_eq!(with_prefix(0.0, "J"), "0 J");
    }
}
