//! Lengths and other numbers in the picture: round, short, with a unit of handy size.
//!
//! In: a number in its SI unit. Out: text, and how long the scale bar is drawn. Digits and prefixes
//! are those of [`numeral`].

use grainfall::measure::numeral;

/// A bar of a round length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleBar {
    /// The length it stands for [m].
    pub metres: f64,
    /// How long it is drawn, in points.
    pub points: f64,
}

impl ScaleBar {
    /// The longest bar of 1, 2 or 5 times a power of ten metres that is at most `longest` points.
    pub fn new(metres_per_point: f64, longest: f64) -> Self {
        let room = metres_per_point * longest;
        let decade = 10_f64.powf(room.log10().floor());
        let digit = [5.0, 2.0].into_iter().find(|digit| digit * decade <= room);
        let metres = digit.unwrap_or(1.0) * decade;
        Self {
            metres,
            points: metres / metres_per_point,
        }
    }

    /// Its length with a unit: `20 mm`.
    pub fn label(&self) -> String {
        length(self.metres)
    }
}

/// A round length [m] with a unit.
pub(super) fn length(metres: f64) -> String {
    let (factor, unit) = match metres {
        // The limits stand between round lengths, so that rounding decides nothing.
        m if m < 0.9e-3 => (1e6, "µm"),
        m if m < 0.09 => (1e3, "mm"),
        m if m < 0.9 => (1e2, "cm"),
        m if m < 900.0 => (1.0, "m"),
        _ => (1e-3, "km"),
    };
    format!("{} {unit}", short_number(metres * factor))
}

/// Numbers below this take a smaller prefix.
const LEAST: f64 = 0.15;

/// Numbers below this are written as powers of ten.
const SMALL: f64 = 1e-3;

/// A unit whose numbers are of handy size.
pub(super) struct Prefixed {
    pub(super) factor: f64,
    pub(super) unit: String,
}

impl Prefixed {
    /// For numbers up to `largest`: metres per second become mm/s, pascal kPa, joule nJ where that
    /// reads better.
    pub(super) fn new(largest: f64, unit: &str) -> Self {
        // Of a power a prefix would count as often: 1 µm²/s² is no millionth of 1 m²/s².
        let is_power = unit.starts_with('m') && unit.contains(['²', '³']);
        let takes_one = !unit.is_empty() && !unit.starts_with("rad") && !is_power;
        let (prefix, factor) = if takes_one {
            numeral::prefix_from(largest, LEAST)
        } else {
            ("", 1.0)
        };
        Self {
            factor,
            unit: format!("{prefix}{unit}"),
        }
    }
}

/// At most three digits, no trailing zeros; what is very small as a power of ten.
pub(super) fn short_number(x: f64) -> String {
    if x == 0.0 || x.abs() >= SMALL {
        return numeral::rounded(x, 3);
    }
    let exponent = (x.abs() * (1.0 + 1e-9)).log10().floor() as i32;
    let power = numeral::power_of_ten(exponent);
    match numeral::rounded(x / 10_f64.powi(exponent), 2).as_str() {
        "1" => power,
        mantissa => format!("{mantissa}·{power}"),
    }
}

/// A number with its unit, which takes a prefix where that reads better.
pub(super) fn with_unit(x: f64, unit: &str) -> String {
    let scale = Prefixed::new(x.abs(), unit);
    format!("{} {}", short_number(x * scale.factor), scale.unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_bar_is_round_and_as_long_as_it_says() {
        for (metres_per_point, label) in [
            (2.0e-4, "20 mm"),
            (1.0e-3, "10 cm"),
            (2.8e-5, "5 mm"),
            (1.2e-6, "200 µm"),
            (0.1, "10 m"),
        ] {
            let bar = ScaleBar::new(metres_per_point, 180.0);
            assert_eq!(bar.label(), label);
            assert!(bar.points <= 180.0 && bar.points > 180.0 / 2.6, "{bar:?}");
            // A billionth: rounding.
            assert!((bar.points * metres_per_point / bar.metres - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn legend_units_take_a_prefix_where_it_reads_better() {
        assert_eq!(Prefixed::new(0.05, "m/s").unit, "mm/s");
        assert_eq!(Prefixed::new(0.5, "m/s").unit, "m/s");
        assert_eq!(Prefixed::new(0.05, "rad/s").unit, "rad/s");
        assert_eq!(Prefixed::new(8.0, "").unit, "");
        assert_eq!(Prefixed::new(4e4, "Pa").unit, "kPa");
        assert_eq!(Prefixed::new(2e-8, "J").unit, "nJ");
        assert_eq!(Prefixed::new(0.0, "N").unit, "N");
        // A millionth of a square metre is a square millimetre.
        let squares = Prefixed::new(1e-6, "m²/s²");
        assert_eq!((squares.factor, squares.unit.as_str()), (1.0, "m²/s²"));
        let numbers = [1e-6, 2e-8, 0.0, 0.25].map(short_number);
        assert_eq!(numbers, ["10⁻⁶", "2·10⁻⁸", "0", "0.25"]);
    }
}
