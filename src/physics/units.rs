//! Units: what a quantity is kept in, what people read it in, and how its values stand in text.
//!
//! In: text such as `10us`, `2 mm`, `0.5 rpm`. Out: the number in SI units, which is what state,
//! files and output hold. Parameters and measured quantities name their units from here.

/// How a value is shown to people: `shown = factor × SI`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayUnit {
    /// Name of the unit, empty for a pure number.
    pub name: &'static str,
    /// Shown value per SI value.
    pub factor: f64,
}

/// The units of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// The SI unit, `1` for a pure number.
    pub si: &'static str,
    /// The unit that people read it in.
    pub shown: DisplayUnit,
    /// Other units that text may name.
    others: &'static [(&'static str, Conversion)],
}

/// How a number in some unit becomes one in the SI unit.
#[derive(Debug, PartialEq)]
enum Conversion {
    /// The SI unit holds this many of it.
    Over(f64),
    /// It holds this many of the SI unit.
    Times(f64),
}

impl Conversion {
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
pub const ACCELERATION: Unit = Unit::same("m/s²");
/// Viscosities.
pub const VISCOSITY: Unit = unit("Pa s", "mPa s", 1e3);
/// Surface tensions.
pub const SURFACE_TENSION: Unit = unit("N/m", "mN/m", 1e3);
/// Volumes of liquid.
pub const LIQUID_VOLUME: Unit = unit("m³", "ml", 1e6);
/// Stiffnesses of springs.
pub const STIFFNESS: Unit = Unit::same("N/m");
/// Elastic moduli.
pub const MODULUS: Unit = unit("Pa", "MPa", 1e-6);
/// Mass per volume.
pub const DENSITY: Unit = Unit::same("kg/m³");
/// Lengths.
pub const LENGTH: Unit = Unit {
    others: &[
        ("um", Conversion::Over(1e6)),
        ("µm", Conversion::Over(1e6)),
        ("cm", Conversion::Over(1e2)),
    ],
    ..unit("m", "mm", 1e3)
};
/// Angular velocities of grains and surfaces; those of drums are [`TURNING`].
pub const ANGULAR_VELOCITY: Unit = unit("rad/s", "°/s", DEGREES_PER_RADIAN);
/// Speeds of beds that flow.
pub const FLOW_SPEED: Unit = unit("m/s", "mm/s", 1e3);
/// Volumes of heaps.
pub const VOLUME: Unit = unit("m³", "cm³", 1e6);
/// Volumes of films and bridges, which people read in litres with a prefix.
pub const FILM_VOLUME: Unit = unit("m³", "L", 1e3);
/// Energies.
pub const ENERGY: Unit = Unit::same("J");
/// Energies in the unit of Man et al. 2023: 1 g cm²/s² is 1e-7 J.
pub const ERG: Unit = unit("J", "g cm²/s²", 1e7);
/// Powers of small drums.
pub const POWER: Unit = unit("W", "mW", 1e3);
/// Times of runs.
pub const TIME: Unit = Unit {
    others: TIMES,
    ..Unit::same("s")
};
/// Times of steps.
pub const SHORT_TIME: Unit = Unit {
    others: TIMES,
    ..unit("s", "µs", 1e6)
};
const TIMES: &[(&str, Conversion)] = &[
    ("us", Conversion::Over(1e6)),
    ("µs", Conversion::Over(1e6)),
    ("ms", Conversion::Over(1e3)),
    ("min", Conversion::Times(60.0)),
    ("h", Conversion::Times(3600.0)),
];

impl Unit {
    /// A unit that people read as it stands in files.
    pub const fn same(si: &'static str) -> Self {
        unit(si, si, 1.0)
    }

    /// `name` with the shown unit in brackets: `θ [°]`; a pure number has none.
    pub fn beside(&self, name: &str) -> String {
        match self.shown.name {
            "" => name.to_owned(),
            unit => format!("{name} [{unit}]"),
        }
    }

    /// The finite value [SI unit] that `text` states: a number alone is one in the SI unit, one
    /// with a unit is one in that. `None` where it states no such value.
    pub fn parse(&self, text: &str) -> Option<f64> {
        let text = text.trim();
        let shown = (self.shown.name, &Conversion::Over(self.shown.factor));
        let others = self.others.iter().map(|(name, scale)| (*name, scale));
        let named = [shown, (self.si, &Conversion::Over(1.0))].into_iter();
        let with_unit = |(name, scale): (&str, &Conversion)| {
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
