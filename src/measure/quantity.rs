//! What is known of a measured quantity beside its value: one row of a registry, and how its values
//! are written for people.
//!
//! In: a value in the SI unit. Out: its text. The rows themselves stand in three tables, because
//! the numbers belong to three different things: [`super::Measure`] to one instant of a world (a
//! column of every series), [`super::RunQuantity`] to a whole run, [`super::GrainQuantity`] to one
//! grain. Each table is made by the macro `quantities!`: one row makes the key, its documentation
//! and its place in the list of all.

use super::estimate::Estimate;
use super::numeral::{self, NOTHING};
use crate::physics::{DisplayUnit, Unit, units};
use serde::{Serialize, Serializer};

/// Row of the registry: all that people and files need to know of one quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Its key in files, which never changes: `surface angle`.
    pub key: &'static str,
    /// What people read beside its value; [`Quantity::label`] where this is empty.
    pub short_label: &'static str,
    /// The paper's symbol, empty where there is none: `θ`.
    pub symbol: &'static str,
    /// Its unit, in files and for people.
    pub unit: Unit,
    /// How its values are written.
    pub format: Format,
    /// Where it has a meaning.
    pub scope: Scope,
    /// One sentence or formula: what it is, how it is taken.
    pub description: &'static str,
    /// The equation it comes from, empty where there is none: `Eq. 1.1 of Man et al. 2023`.
    pub source: &'static str,
    /// That equation in symbols, empty where words tell more: `Tg = Σ |u − ū|² / 3N`.
    pub equation: &'static str,
}

/// How the values of a quantity are written for people.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// With this many digits after the point.
    Fixed(usize),
    /// With about four digits in all.
    Significant,
    /// As a power of ten with two digits after the point.
    Scientific,
    /// With a prefix of its unit: `12.3 mJ`; where no unit can stand, as a power of ten.
    Prefixed,
    /// As a whole number.
    Count,
    /// As one of these words.
    Choice(&'static [&'static str]),
}

/// The worlds in which a quantity has a meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// All.
    Everywhere,
    /// Drums and boxes, whose bed has a surface.
    Beds,
    /// Drums.
    Drums,
    /// Columns that collapse.
    Columns,
    /// Where there are several kinds of grains.
    Mixtures,
    /// Where there is liquid, and beds, into which it can be poured.
    Liquids,
}

/// One value of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeasuredValue {
    /// A number in the SI unit.
    Number(f64),
    /// A mean with its standard error, in the SI unit.
    Mean(Estimate),
    /// A whole number.
    Count(usize),
    /// A word out of those of [`Format::Choice`].
    Choice(&'static str),
}

impl Quantity {
    /// What a row says that does not say otherwise.
    pub(super) const BLANK: Self = Self {
        key: "",
        short_label: "",
        symbol: "",
        unit: units::PURE,
        format: Format::Significant,
        scope: Scope::Everywhere,
        description: "",
        source: "",
        equation: "",
    };

    /// Key and symbol, which some keys hold already: `surface angle θ`.
    pub fn title(&self) -> String {
        match self.key.strip_suffix(self.symbol) {
            Some(name) if name.is_empty() || name.ends_with(' ') || self.symbol.is_empty() => {
                self.key.to_owned()
            }
            _ => format!("{} {}", self.key, self.symbol),
        }
    }

    /// What people read beside its value: `Surface angle θ`.
    pub fn label(&self) -> String {
        match self.short_label {
            "" => numeral::capitalised(&self.title()),
            label => label.to_owned(),
        }
    }

    /// Label of an axis that shows it, with the unit that people read: `surface angle θ [°]`.
    pub fn axis(&self) -> String {
        self.unit.beside(&self.title())
    }

    /// Description and source.
    pub fn explanation(&self) -> String {
        let (text, end) = match self.description.strip_suffix('.') {
            Some(text) => (text, "."),
            None => (self.description, ""),
        };
        match self.source {
            "" => self.description.to_owned(),
            source => format!("{text}, {source}{end}"),
        }
    }

    /// `value` in the shown unit, without it, in plain characters that programs read too: `24.31`,
    /// `2.00e-9`, a word; a dash for what is not finite.
    pub fn number(&self, value: impl Into<MeasuredValue>) -> String {
        self.number_as(value, self.unit, self.format)
    }

    /// The same in another unit or with other digits than the quantity's own.
    pub fn number_as(&self, value: impl Into<MeasuredValue>, unit: Unit, format: Format) -> String {
        let number = match value.into() {
            MeasuredValue::Number(number) => number,
            MeasuredValue::Mean(estimate) => estimate.mean,
            MeasuredValue::Count(count) => return count.to_string(),
            MeasuredValue::Choice(word) => return word.into(),
        };
        if number.is_finite() {
            format.plain(number * unit.shown.factor)
        } else {
            NOTHING.into()
        }
    }

    /// The name of the unit, and shown value per SI value, of an axis on which magnitudes up to
    /// `largest` [SI unit] stand: with the prefix with which [`Self::text`] writes that.
    pub fn unit_up_to(&self, largest: f64) -> (String, f64) {
        let DisplayUnit { name, factor } = self.unit.shown;
        match self.format {
            Format::Prefixed => {
                let (prefix, prefixed) = numeral::prefix_for(largest * factor);
                (format!("{prefix}{name}"), factor * prefixed)
            }
            _ => (name.to_owned(), factor),
        }
    }

    /// `value` with the shown unit, as people read it: `24.31°`, `12.30 mJ`, `2.00·10⁻⁹ m²/s²`, a
    /// word; a mean with its error, `24.3° ± 0.4°`, which is a question mark where too little was
    /// seen for one; a dash where there is no value.
    pub fn text(&self, value: impl Into<MeasuredValue>) -> String {
        let value = match value.into() {
            MeasuredValue::Number(value) => value * self.unit.shown.factor,
            MeasuredValue::Mean(estimate) => match estimate.error {
                Some(error) => return self.text_with_error(estimate.mean, error),
                None if estimate.mean.is_nan() => f64::NAN,
                None => return format!("{} ± ?", self.text(estimate.mean)),
            },
            MeasuredValue::Count(count) => return count.to_string(),
            MeasuredValue::Choice(word) => return word.into(),
        };
        if self.format == Format::Prefixed && value.is_finite() {
            return numeral::with_prefix(value, self.unit.shown.name);
        }
        let number = numeral::written(value, |value| self.format.plain(value));
        if value.is_nan() {
            number
        } else {
            numeral::beside_unit(&number, self.unit.shown.name)
        }
    }

    /// A mean in another unit than the quantity's own, without that unit: `24.3 ± 0.4`.
    pub fn number_with_error_as(&self, mean: Estimate, unit: Unit, format: Format) -> String {
        let number = self.number_as(mean, unit, format);
        let factor = unit.shown.factor;
        match mean.error {
            _ if !mean.mean.is_finite() => number,
            Some(error) => numeral::with_error(mean.mean * factor, error * factor, ""),
            None => format!("{number} ± ?"),
        }
    }

    /// `value ± error`, both in the SI unit, with the shown unit and the digits that the error
    /// allows.
    pub fn text_with_error(&self, value: f64, error: f64) -> String {
        let (factor, unit) = (self.unit.shown.factor, self.unit.shown.name);
        let [value, error] = [value * factor, error * factor];
        if self.format == Format::Prefixed {
            let (prefix, factor) = numeral::prefix_for(value.abs().max(error));
            return numeral::with_error(value * factor, error * factor, &format!("{prefix}{unit}"));
        }
        numeral::with_error(value, error, unit)
    }
}

impl Format {
    /// A finite `value` in plain characters.
    fn plain(self, value: f64) -> String {
        match self {
            Self::Fixed(digits) => format!("{value:.digits$}"),
            Self::Significant => numeral::significant(value),
            Self::Scientific | Self::Prefixed => format!("{value:.2e}"),
            Self::Count | Self::Choice(_) => format!("{value:.0}"),
        }
    }
}

impl MeasuredValue {
    /// It as a number; none for a word.
    pub fn as_number(self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(value),
            Self::Mean(estimate) => Some(estimate.mean),
            Self::Count(count) => Some(count as f64),
            Self::Choice(_) => None,
        }
    }

    /// What is known of its error, where it is a mean.
    pub fn as_estimate(self) -> Option<Estimate> {
        match self {
            Self::Mean(estimate) => Some(estimate),
            Self::Number(_) | Self::Count(_) | Self::Choice(_) => None,
        }
    }
}

impl From<f64> for MeasuredValue {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<Estimate> for MeasuredValue {
    fn from(estimate: Estimate) -> Self {
        Self::Mean(estimate)
    }
}

/// In files a count is written as a number is, and so is a mean, whose error stands beside it.
impl Serialize for MeasuredValue {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match *self {
            Self::Number(value) => serializer.serialize_f64(value),
            Self::Mean(estimate) => serializer.serialize_f64(estimate.mean),
            Self::Count(count) => serializer.serialize_f64(count as f64),
            Self::Choice(word) => serializer.serialize_str(word),
        }
    }
}

/// Makes an enum of quantities out of one row for each: the key with its description as
/// documentation, `ALL` and `COUNT`, and `quantity()` for the row. What a row leaves out is as in
/// [`Quantity::BLANK`].
macro_rules! quantities {
    (
        $(#[$attribute:meta])*
        $name:ident {
            $($variant:ident {
                key: $key:literal,
                description: $description:literal,
                $($field:ident: $value:expr),* $(,)?
            })*
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $name {
            $(#[doc = concat!($key, ": ", $description)] $variant,)*
        }

        impl $name {
            /// Every key, in the order of the rows.
            pub const ALL: [Self; Self::COUNT] = [$(Self::$variant,)*];

            /// Number of keys.
            pub const COUNT: usize = [$(stringify!($variant),)*].len();

            const ROWS: &'static [$crate::measure::Quantity; Self::COUNT] = &[$(
                $crate::measure::Quantity {
                    key: $key,
                    description: $description,
                    $($field: $value,)*
                    ..$crate::measure::Quantity::BLANK
                },
            )*];

            /// Its row of the registry.
            pub const fn quantity(self) -> &'static $crate::measure::Quantity {
                &Self::ROWS[self as usize]
            }
        }
    };
}

pub(super) use quantities;

#[cfg(test)]
mod tests {
    use super::*;

    const ANGLE: Quantity = Quantity {
        key: "drop",
        symbol: "Δθ",
        unit: units::ANGLE,
        format: Format::Fixed(2),
        description: "A fall",
        source: "Eq. 3",
        ..Quantity::BLANK
    };

    #[test]
    fn a_value_is_written_with_the_unit_and_the_digits_of_its_quantity() {
        assert_eq!(ANGLE.text(std::f64::consts::FRAC_PI_6), "30.00°");
        assert_eq!(ANGLE.text(-0.001), "−0.06°");
        assert_eq!(ANGLE.number(-0.001), "-0.06");
        assert_eq!(ANGLE.text(f64::NAN), "–");
        assert_eq!(ANGLE.number(f64::NAN), "–");
        let with = |unit, format| Quantity {
            unit,
            format,
            ..Quantity::BLANK
        };
        assert_eq!(with(units::PURE, Format::Significant).text(0.61), "0.6100");
        let heat = with(Unit::same("m²/s²"), Format::Scientific);
        assert_eq!(heat.text(2.3e-9), "2.30·10⁻⁹ m²/s²");
        assert_eq!(heat.number(2.3e-9), "2.30e-9");
        let energy = with(units::ENERGY, Format::Prefixed);
        assert_eq!(energy.text(0.0123), "12.30 mJ");
        assert_eq!(energy.number(0.0123), "1.23e-2");
        assert_eq!(with(units::LENGTH, Format::Fixed(1)).text(0.05), "50.0 mm");
    }

    #[test]
    fn a_mean_is_written_with_its_error() {
        let mean = |mean: f64, error| Estimate {
            mean,
            error,
            samples: 45,
            freedom: 9,
        };
        let degree = std::f64::consts::PI / 180.0;
        let angle = mean(28.312 * degree, Some(0.41 * degree));
        assert_eq!(ANGLE.text(angle), "28.3° ± 0.4°");
        assert_eq!(ANGLE.number(angle), "28.31");
        assert_eq!(ANGLE.text(mean(28.312 * degree, None)), "28.31° ± ?");
        assert_eq!(ANGLE.text(mean(f64::NAN, None)), "–");
        let energy = Quantity {
            unit: units::ENERGY,
            format: Format::Prefixed,
            ..Quantity::BLANK
        };
        assert_eq!(energy.text(mean(0.0123, Some(0.0004))), "(12.3 ± 0.4) mJ");
        let json = serde_json::to_string(&MeasuredValue::from(mean(0.5, Some(0.1)))).unwrap();
        assert_eq!(json, "0.5");
    }

    #[test]
    fn counts_are_whole_and_choices_are_words() {
        let count = Quantity {
            format: Format::Count,
            ..Quantity::BLANK
        };
        assert_eq!(count.text(MeasuredValue::Count(7)), "7");
        assert_eq!(count.text(6.6), "7");
        let choice = MeasuredValue::Choice("cone");
        assert_eq!(count.text(choice), "cone");
        assert_eq!(choice.as_number(), None);
        let json = |value: MeasuredValue| serde_json::to_string(&value).unwrap();
        assert_eq!(json(MeasuredValue::Count(7)), "7.0");
        assert_eq!(json(choice), r#""cone""#);
    }

    #[test]
    fn names_hold_key_symbol_unit_and_source() {
        assert_eq!(ANGLE.title(), "drop Δθ");
        assert_eq!(ANGLE.label(), "Drop Δθ");
        assert_eq!(ANGLE.axis(), "drop Δθ [°]");
        assert_eq!(ANGLE.explanation(), "A fall, Eq. 3");
        let with_symbol = Quantity {
            key: "drop Δθ",
            description: "A fall.",
            ..ANGLE
        };
        assert_eq!(with_symbol.title(), "drop Δθ");
        let roughness = Quantity {
            key: "depth",
            symbol: "h",
            ..ANGLE
        };
        assert_eq!(roughness.title(), "depth h");
        assert_eq!(with_symbol.explanation(), "A fall, Eq. 3.");
    }
}
