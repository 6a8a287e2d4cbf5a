//! What a sweep varies, as numbers.
//!
//! In: a key and the text of a value. Out: the value, the number that people read, and the axis of
//! a plot over it, by the registry of parameters.

use super::chart::ChartAxis;
use super::variation::{SEED, Variation};
use crate::parameters::{Parameter, Value};

/// The parameter that goes by `key`.
pub fn parameter(key: &str) -> Option<Parameter> {
    Parameter::of_key(key).into_iter().next()
}

/// What `text` says of the parameter `key`, in the SI unit.
pub fn value(key: &str, text: &str) -> Option<Value> {
    parameter(key)?.row().parse(text)
}

/// The number that `text` says of the parameter `key`, in the unit that people read it in; none of
/// a word.
pub fn shown(key: &str, text: &str) -> Option<f64> {
    let parameter = parameter(key)?;
    match parameter.row().parse(text)? {
        Value::Choice(_) => None,
        number => Some(number.number() * parameter.row().kind.unit().shown.factor),
    }
}

/// What a sweep with these `variations` varies beside the seed, where that is one number.
pub fn only_number(variations: &[Variation]) -> Option<&Variation> {
    let mut others = variations.iter().filter(|own| own.key != SEED);
    let only = others.next()?;
    let is_number = |own: &Variation| {
        own.values
            .iter()
            .all(|text| shown(&own.key, text).is_some())
    };
    (others.next().is_none() && is_number(only)).then_some(only)
}

/// The axis of a plot over what is varied: by powers of ten where the values span more than a
/// factor of twenty.
pub fn axis(variation: &Variation) -> ChartAxis {
    let unit = parameter(&variation.key).map(|parameter| parameter.row().kind.unit());
    let label = unit.map_or(variation.key.clone(), |unit| unit.beside(&variation.key));
    let values = variation.values.iter();
    let numbers = values.filter_map(|text| shown(&variation.key, text));
    let (low, high) = numbers.fold((f64::INFINITY, 0.0_f64), |(low, high), number| {
        (low.min(number), high.max(number))
    });
    if low > 0.0 && high > 20.0 * low && low.is_finite() {
        ChartAxis::logarithmic(&label)
    } else {
        ChartAxis::linear(&label)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variation(text: &str) -> Variation {
        Variation::parse(text).unwrap()
    }

    #[test]
    fn numbers_are_in_the_unit_that_people_read() {
        let close = |key: &str, text: &str, number: f64| {
            let own = shown(key, text).unwrap();
            assert!((own / number - 1.0).abs() < 1e-12, "{key}={text}: {own}");
        };
        close("viscosity", "1e-3", 1.0);
        close("drum-speed", "5rpm", 5.0);
        close("radius", "2.5mm", 2.5);
        assert_eq!(shown("bridge-law", "as-coded"), None);
        assert_eq!(shown("no-such-key", "1"), None);
    }

    #[test]
    fn an_axis_goes_by_powers_of_ten_where_values_are_far_apart() {
        let axis = |text: &str| axis(&variation(text));
        let (near, far) = (axis("viscosity=0.1,0.5"), axis("viscosity=0.001,1"));
        assert_eq!(
            (near.label(), near.is_logarithmic()),
            ("viscosity [mPa s]", false)
        );
        assert!(far.is_logarithmic());
        assert!(!axis("drum-speed=0,5rpm").is_logarithmic());
    }

    #[test]
    fn one_number_beside_the_seed_makes_a_curve() {
        let only = |texts: &[&str]| {
            let list: Vec<Variation> = texts.iter().map(|text| variation(text)).collect();
            only_number(&list).map(|own| own.key.clone())
        };
        assert_eq!(
            only(&["viscosity=0.1,1", "seed=1..3"]).unwrap(),
            "viscosity"
        );
        assert_eq!(only(&["seed=1..3"]), None);
        assert_eq!(only(&["viscosity=0.1,1", "gravity=1,2"]), None);
        assert_eq!(only(&["bridge-law=as-coded,as-printed"]), None);
    }
}
