//! Units: what a quantity is kept in, what people read it in, and how its values stand in text.
//!
//! In: text such as `10us`, `2 mm`, `0.5 rpm`. Out: the number in SI units, which is what state,
//! files and output hold.

/// How a value is shown to people: `shown = factor × SI`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayUnit {
    /// Name of the unit, empty for a pure number.
    pub name: &'static str,
    /// Shown value per SI value.
    pub factor: f64,
}

/// The units of a quantity.
#[derive(Debug, PartialEq)]
pub struct Unit {
    /// The SI unit, `1` for a pure number.
    pub si: &'static str,
    /// The unit that people read it in.
    pub shown: DisplayUnit,
    /// Other units that text may name.
    others: &'static [(&'static str, Scale)],
}

/// How a number in some unit becomes one in the SI unit.
#[derive(Debug, PartialEq)]
enum Scale {
    /// The SI unit holds this many of it.
    Over(f64),
    /// It holds this many of the SI unit.
    Times(f64),
}

impl Scale {
    fn in_si(&self, number: f64) -> f64 {
        match self {
            Self::Over(factor) => number / factor,
            Self::Times(factor) => number * factor,
        }
    }
}

const fn unit(si: &'static str, name: &'static str, factor: f64) -> Unit {
    Unit {
        si,
        shown: DisplayUnit { name, factor },
        others: &[],
    }
}

const DEGREES_PER_RADIAN: f64 = 180.0 / std::f64::consts::PI;

/// A pure number.
pub const PURE: Unit = unit("1", "", 1.0);
/// A share of a whole.
pub const SHARE: Unit = unit("1", "%", 100.0);
/// Angles.
pub const ANGLE: Unit = unit("rad", "°", DEGREES_PER_RADIAN);
/// Speeds of drums.
pub const TURNING: Unit = unit("rad/s", "rpm", 30.0 / std::f64::consts::PI);
/// Accelerations.
pub const ACCELERATION: Unit = unit("m/s²", "m/s²", 1.0);
/// Viscosities.
pub const VISCOSITY: Unit = unit("Pa s", "mPa s", 1e3);
/// Surface tensions.
pub const SURFACE_TENSION: Unit = unit("N/m", "mN/m", 1e3);
/// Volumes of liquid.
pub const LIQUID_VOLUME: Unit = unit("m³", "ml", 1e6);
/// Stiffnesses of springs.
pub const STIFFNESS: Unit = unit("N/m", "N/m", 1.0);
/// Elastic moduli.
pub const MODULUS: Unit = unit("Pa", "MPa", 1e-6);
/// Mass per volume.
pub const DENSITY: Unit = unit("kg/m³", "kg/m³", 1.0);
/// Lengths.
pub const LENGTH: Unit = Unit {
    others: &[
        ("um", Scale::Over(1e6)),
        ("µm", Scale::Over(1e6)),
        ("cm", Scale::Over(1e2)),
    ],
    ..unit("m", "mm", 1e3)
};
/// Times of runs.
pub const TIME: Unit = Unit {
    others: TIMES,
    ..unit("s", "s", 1.0)
};
/// Times of steps.
pub const SHORT_TIME: Unit = Unit {
    others: TIMES,
    ..unit("s", "µs", 1e6)
};
const TIMES: &[(&str, Scale)] = &[
    ("us", Scale::Over(1e6)),
    ("µs", Scale::Over(1e6)),
    ("ms", Scale::Over(1e3)),
    ("min", Scale::Times(60.0)),
    ("h", Scale::Times(3600.0)),
];

impl Unit {
    /// The finite value [SI unit] that `text` states: a number alone is one in the SI unit, one
    /// with a unit is one in that. `None` where it states no such value.
    pub fn parse(&self, text: &str) -> Option<f64> {
        let text = text.trim();
        let shown = (self.shown.name, &Scale::Over(self.shown.factor));
        let others = self.others.iter().map(|(name, scale)| (*name, scale));
        let named = [shown, (self.si, &Scale::Over(1.0))].into_iter();
        let with_unit = |(name, scale): (&str, &Scale)| {
            let number = text.strip_suffix(name)?.trim_end();
            Some(scale.in_si(finite(number)?))
        };
        finite(text)
            .or_else(|| named.chain(others).find_map(with_unit))
            .filter(|value| value.is_finite())
    }
}

/// The time that `text` states, a number of seconds or one with the unit `us`, `ms`, `s`, `min` or
/// `h` [s].
pub fn seconds(text: &str) -> Option<f64> {
    TIME.parse(text)
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_carry_their_unit() {
        let times = [
            ("10s", 10.0),
            ("250 ms", 0.25),
            ("2min", 120.0),
            ("1e-5", 1e-5),
            ("10us", 1e-5),
            ("1e1s", 10.0),
        ];
        for (text, time) in times {
            assert_eq!(seconds(text), Some(time), "{text}");
        }
        for text in ["", "s", "ten", "10 parsecs", "NaN", "inf", "1e999"] {
            assert_eq!(seconds(text), None, "{text}");
        }
    }

    #[test]
    fn values_stand_in_the_unit_that_people_read_or_in_the_si_unit() {
        assert_eq!(LENGTH.parse("2mm"), Some(2e-3));
        assert_eq!(LENGTH.parse("2 cm"), Some(2e-2));
        assert_eq!(LENGTH.parse("3m"), Some(3.0));
        assert_eq!(VISCOSITY.parse("250 mPa s"), Some(0.25));
        assert_eq!(VISCOSITY.parse("0.25 Pa s"), Some(0.25));
        assert_eq!(SHARE.parse("30 %"), Some(0.3));
        assert_eq!(PURE.parse("0.31"), Some(0.31));
        assert_eq!(PURE.parse("0.4 rpm"), None);
        let rpm = 1.0 / (30.0 / std::f64::consts::PI);
        assert_eq!(TURNING.parse("1rpm"), Some(rpm));
    }
}
