//! The colours of the picture, all of them.
//!
//! In: a world and what to colour by. Out: one linear colour per grain and the legend that explains
//! it.

use crate::view::view_settings::{Background, ColourBy, ColourMap, ColourRange, Legend};
use bevy::color::{Color, ColorToComponents, LinearRgba};
use grainfall::measure::{GrainQuantity, TemperatureMap};
use grainfall::world::SpeciesId;

/// The colours of species in order of their index, readable side by side on a projector and by
/// people with any kind of colour vision: they differ in lightness too.
const SPECIES: [[u8; 3]; 6] = [
    [0xE9, 0xA8, 0x3F],
    [0x2F, 0x8F, 0xC4],
    [0xF3, 0xE6, 0xC4],
    [0xC4, 0x4E, 0x35],
    [0x46, 0xB3, 0x93],
    [0x7A, 0x5C, 0xA8],
];

/// The sRGB colour of a species.
pub fn species_colour(species: usize) -> [u8; 3] {
    SPECIES[species % SPECIES.len()]
}

/// sRGB colour of the surface angle and of the front, in the picture as on the plot.
pub(crate) const MEASURED_ON_DARK: [u8; 3] = [0x6C, 0xB8, 0xF6];
/// The same on a light ground.
pub(crate) const MEASURED_ON_LIGHT: [u8; 3] = [0x0B, 0x6B, 0xB8];

/// The colours of everything that is no grain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Behind everything.
    pub background: Color,
    /// Surfaces of the container.
    pub surface: Color,
    /// Lines on them.
    pub line: Color,
    /// The mark that shows how far a drum has turned.
    pub mark: Color,
    /// The hoops of a drum, the edges of a box.
    pub frame: Color,
    /// What is measured, as its curve on the plot, sRGB.
    pub measured: [u8; 3],
    /// Text and scale bar, sRGB.
    pub text: [u8; 3],
    /// Text of less weight, sRGB.
    pub faint_text: [u8; 3],
}

impl Scheme {
    /// The colours that go with a background.
    pub fn of(background: Background) -> Self {
        match background {
            Background::Dark => Self {
                background: Color::srgb_u8(0x15, 0x19, 0x20),
                surface: Color::srgb_u8(0x5C, 0x6B, 0x80),
                line: Color::srgb_u8(0x9F, 0xB0, 0xC6),
                mark: Color::srgb_u8(0xF2, 0x7D, 0x52),
                frame: Color::srgb_u8(0x7C, 0x8B, 0x9F),
                measured: MEASURED_ON_DARK,
                text: [0xEC, 0xEF, 0xF4],
                faint_text: [0x9A, 0xA5, 0xB4],
            },
            Background::Light => Self {
                background: Color::srgb_u8(0xF7, 0xF7, 0xF4),
                surface: Color::srgb_u8(0x9D, 0xAF, 0xC4),
                line: Color::srgb_u8(0x3F, 0x50, 0x66),
                mark: Color::srgb_u8(0xB8, 0x40, 0x18),
                frame: Color::srgb_u8(0x7C, 0x8C, 0xA0),
                measured: MEASURED_ON_LIGHT,
                text: [0x1E, 0x24, 0x2C],
                faint_text: [0x5D, 0x67, 0x74],
            },
        }
    }
}

/// What the colours of grains mean that show these numbers, lists of which there is one for each
/// world, the same in all of them; `None` for species.
/// An automatic range stays as it was in `before` while it suits, so that colours do not jump from
/// frame to frame.
pub fn legend(
    values: &[&[f64]],
    colour_by: ColourBy,
    (range, is_log): (ColourRange, bool),
    before: Option<&Legend>,
) -> Option<Legend> {
    let quantity = colour_by.quantity()?;
    let title = colour_by.label();
    let automatic = |before: &&Legend| before.min <= 0.0 || before.is_log;
    let before = before.filter(|before| before.title == title && automatic(before));
    let (min, max) = match range {
        ColourRange::Fixed(min, max) => (min, max),
        ColourRange::Percentiles(low, high) => percentiles(values, low, high),
        // It stays as it is, wherever the middle.
        ColourRange::Automatic if matches!(colour_by, ColourBy::Start(_)) => {
            percentiles(values, 0.0, 1.0)
        }
        ColourRange::Automatic => {
            let max = automatic_maximum(values, quantity, before);
            (if quantity.is_signed() { -max } else { 0.0 }, max)
        }
    };
    // What has a sign has no logarithm.
    let is_log = is_log && max > 0.0 && !quantity.is_signed();
    Some(Legend {
        title,
        min: if is_log && min <= 0.0 {
            max / DECADES
        } else {
            min
        },
        max,
        unit: quantity.unit(),
        is_log,
    })
}

/// Largest over smallest number of an automatic range whose steps are factors.
const DECADES: f64 = 1e4;
/// Least temperature at the end of the veil's colours [m²/s²]: below, a bed is rigid, and noise is not
/// shown as heat.
const COOL: f64 = 1e-7;

/// What the colours of the veil mean, the same over all `maps`; it stays as it was `before` while it
/// suits. None of no temperature above zero.
pub(super) fn veil_legend(maps: &[&TemperatureMap], before: Option<&Legend>) -> Option<Legend> {
    let cells = maps.iter().flat_map(|map| map.cells());
    let hottest = cells.fold(0.0_f64, |most, (_, temperature)| most.max(temperature));
    if hottest <= 0.0 {
        return None;
    }
    let suits = |before: &&Legend| (0.2 * before.max..=before.max).contains(&hottest);
    let hottest = hottest.max(COOL);
    let max = before
        .filter(suits)
        .map_or_else(|| round_up(hottest), |before| before.max);
    Some(Legend {
        title: "Tg",
        min: max / DECADES,
        max,
        unit: "m²/s²",
        is_log: true,
    })
}

/// Calls `paint` with the linear colour of each grain in turn: what `legend` makes of its number, or
/// that of its species where there is none.
pub fn colours(
    species: &[SpeciesId],
    values: &[f64],
    map: ColourMap,
    legend: Option<&Legend>,
    mut paint: impl FnMut([f32; 3]),
) {
    let Some(legend) = legend else {
        let palette = SPECIES.map(linear);
        for (i, species) in species.iter().enumerate() {
            let colour = palette[usize::from(species.0) % palette.len()];
            paint(colour.map(|c| c * individual_lightness(i)));
        }
        return;
    };
    let table: [[f32; 3]; 256] = std::array::from_fn(|t| linear(map.colour(t as f64 / 255.0)));
    for value in values {
        let place = 255.0 * legend.share(*value).min(1.0);
        // To the nearest: `round` is a call on older processors.
        paint(table[(place + 0.5) as usize]);
    }
}

/// A range is taken from about this many grains or contacts, evenly spaced among all.
const SAMPLED: usize = 4096;

/// The step from one sampled grain or contact to the next, where there are `count` of them.
pub(super) fn stride(count: usize) -> usize {
    count.div_ceil(SAMPLED).max(1)
}

/// The quantile of `numbers` at this share; none of an empty list. Reorders them.
pub(super) fn quantile(numbers: &mut [f64], share: f64) -> Option<f64> {
    let last = numbers.len().checked_sub(1)?;
    let rank = (share.clamp(0.0, 1.0) * last as f64) as usize;
    Some(*numbers.select_nth_unstable_by(rank, f64::total_cmp).1)
}

/// The numbers that these shares of the grains stay below.
fn percentiles(values: &[&[f64]], low: f64, high: f64) -> (f64, f64) {
    let mut values = sampled(values);
    let mut at = |share, of_none| quantile(&mut values, share).unwrap_or(of_none);
    (at(low, 0.0), at(high, 1.0))
}

/// A sample of all these numbers, evenly spaced; only finite ones.
fn sampled(values: &[&[f64]]) -> Vec<f64> {
    let count = values.iter().map(|values| values.len()).sum();
    let all = values.iter().copied().flatten().copied();
    let sampled = all.step_by(stride(count));
    sampled.filter(|value| value.is_finite()).collect()
}

/// A round number that all but a fiftieth of the grains stay below; for counts a multiple of four,
/// at least 8.
fn automatic_maximum(values: &[&[f64]], quantity: GrainQuantity, before: Option<&Legend>) -> f64 {
    let mut values = sampled(values);
    if quantity.is_signed() {
        for value in &mut values {
            *value = value.abs();
        }
    }
    if quantity == GrainQuantity::Number {
        return values.into_iter().fold(1.0, f64::max);
    }
    let Some(most) = quantile(&mut values, 0.98) else {
        return 1.0;
    };
    if let Some(before) = before
        && (0.45 * before.max..=before.max).contains(&most)
    {
        return before.max;
    }
    if quantity == GrainQuantity::Coordination {
        (most / 4.0).ceil().max(2.0) * 4.0
    } else {
        // Quarters of these are round too.
        round_up_to(most, &[1.0, 2.0, 4.0, 8.0])
    }
}

/// The next of … 1, 2, 5, 10, 20, 50 … at or above `x`; 1 for zero.
pub fn round_up(x: f64) -> f64 {
    round_up_to(x, &[1.0, 2.0, 5.0])
}

/// The next number at or above `x` that is one of `digits` times a power of ten; 1 for zero.
fn round_up_to(x: f64, digits: &[f64]) -> f64 {
    if x <= 0.0 || !x.is_finite() {
        return 1.0;
    }
    let decade = 10_f64.powf(x.log10().floor());
    // A billionth above a round number is that number: rounding of the logarithm.
    let digit = digits
        .iter()
        .find(|digit| *digit * decade >= x * (1.0 - 1e-9));
    digit.unwrap_or(&10.0) * decade
}

/// sRGB to linear light.
pub fn linear([r, g, b]: [u8; 3]) -> [f32; 3] {
    let colour = LinearRgba::from(Color::srgb_u8(r, g, b));
    colour.to_f32_array_no_alpha()
}

/// A little lighter or darker, so that the eye can follow single grains of one species.
fn individual_lightness(i: usize) -> f32 {
    let scrambled = (i as u32).wrapping_mul(2_654_435_761) >> 16;
    0.92 + 0.16 * (scrambled as f32 / 65_535.0)
}

/// sRGB colour of what is selected.
pub(super) const SELECTED: [u8; 3] = [0xFF, 0xE0, 0x66];
/// sRGB colours of trails, light ones: they lie over grains of every colour.
const TRAILS: [[u8; 3]; 6] = [
    SELECTED,
    [0x7F, 0xD8, 0xFF],
    [0xFF, 0x9A, 0xD5],
    [0xA6, 0xE8, 0x8C],
    [0xFF, 0xFF, 0xFF],
    [0xFF, 0xA8, 0x5C],
];

/// The sRGB colour of the trail of this index.
pub fn trail_colour(index: usize) -> [u8; 3] {
    TRAILS[index % TRAILS.len()]
}

/// Ratio of the lighter to the darker of two sRGB colours as the Web Content Accessibility
/// Guidelines count it, 1 … 21; text is read at 4.5.
#[cfg(test)]
pub(crate) fn contrast(one: [u8; 3], other: [u8; 3]) -> f32 {
    let luminance = |colour| {
        let [r, g, b] = linear(colour);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let (a, b) = (luminance(one), luminance(other));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::ink::srgb;
    use grainfall::world::World;

    #[test]
    fn words_in_the_picture_stand_out_from_its_background() {
        assert!((contrast([0; 3], [255; 3]) - 21.0).abs() < 1e-4);
        for background in [Background::Dark, Background::Light] {
            let scheme = Scheme::of(background);
            let (ground, mark) = (srgb(scheme.background), srgb(scheme.mark));
            for ink in [scheme.text, scheme.faint_text, scheme.measured, mark] {
                let contrast = contrast(ink, ground);
                assert!(contrast >= 4.5, "{background:?} {ink:?}: {contrast}");
            }
        }
    }

    /// The legend of grains coloured by `quantity` in all `worlds`.
    fn legend_of(
        worlds: &[&World],
        quantity: GrainQuantity,
        range: (ColourRange, bool),
        before: Option<&Legend>,
    ) -> Option<Legend> {
        let values = |world: &&World| {
            let mut values = Vec::new();
            quantity.append(world, &mut values);
            values
        };
        let values: Vec<Vec<f64>> = worlds.iter().map(values).collect();
        let values: Vec<&[f64]> = values.iter().map(Vec::as_slice).collect();
        legend(&values, ColourBy::Quantity(quantity), range, before)
    }

    #[test]
    fn range_ends_at_round_numbers() {
        for (x, round) in [
            (0.0, 1.0),
            (0.0031, 0.005),
            (1.0, 1.0),
            (1.2, 2.0),
            (6.0, 10.0),
            (0.2, 0.2),
            (900.0, 1000.0),
        ] {
            // A relative billionth: rounding of the power of ten.
            assert!((round_up(x) / round - 1.0).abs() < 1e-9, "{x}");
        }
    }

    #[test]
    fn colour_maps_grow_lighter_all_the_way() {
        for map in ColourMap::ALL {
            let lightness = |t: f64| {
                let [r, g, b] = linear(map.colour(t));
                0.2126 * r + 0.7152 * g + 0.0722 * b
            };
            for i in 0..20 {
                let t = f64::from(i) / 20.0;
                assert!(lightness(t + 0.05) > lightness(t), "{map:?} at {t}");
            }
        }
    }

    #[test]
    fn automatic_range_is_round_and_keeps_still_while_it_suits() {
        let mut world = crate::view::test_worlds::grains_in_a_row(100);
        let mut shown = None;
        // The largest speed of all but two grains, and the range that is shown then.
        for (speed, max) in [
            (0.3, 0.4),
            (0.39, 0.4),
            (0.2, 0.4),
            (0.17, 0.2),
            (0.21, 0.4),
            (5.0, 8.0),
        ] {
            for velocity in &mut world.grains.velocity {
                velocity.x = speed;
            }
            world.grains.velocity[0].x = 100.0;
            shown = legend_of(
                &[&world],
                GrainQuantity::Speed,
                (ColourRange::Automatic, false),
                shown.as_ref(),
            );
            assert_eq!(
                shown.as_ref().map(|legend| legend.max),
                Some(max),
                "{speed}"
            );
        }
        let fixed = ColourRange::Fixed(0.1, 0.7);
        let shown = legend_of(
            &[&world],
            GrainQuantity::Speed,
            (fixed, false),
            shown.as_ref(),
        )
        .unwrap();
        assert_eq!((shown.min, shown.max), (0.1, 0.7));
        assert_eq!(
            legend(&[&[1.0]], ColourBy::Species, (fixed, false), None),
            None
        );
    }

    #[test]
    fn two_worlds_share_the_range_that_holds_the_grains_of_both() {
        let [mut slow, mut fast] = [(); 2].map(|()| crate::view::test_worlds::grains_in_a_row(100));
        for (world, speed) in [(&mut slow, 0.01), (&mut fast, 0.3)] {
            world.grains.velocity.iter_mut().for_each(|v| v.x = speed);
        }
        let range = |range, worlds: &[&World]| {
            let legend = legend_of(worlds, GrainQuantity::Speed, (range, false), None).unwrap();
            (legend.min, legend.max)
        };
        let all = ColourRange::Percentiles(0.0, 1.0);
        assert_eq!(range(all, &[&slow, &fast]), (0.01, 0.3));
        assert_eq!(range(ColourRange::Automatic, &[&slow, &fast]), (0.0, 0.4));
        assert_eq!(range(ColourRange::Automatic, &[&slow]).1, 0.01);
    }

    #[test]
    fn a_factor_is_a_step_and_a_sign_has_its_zero_in_the_middle() {
        let mut world = crate::view::test_worlds::grains_in_a_row(5);
        for (i, velocity) in (0..).zip(&mut world.grains.velocity) {
            velocity.x = -(10.0_f64.powi(i - 4));
        }
        let of = |quantity, range, is_log| {
            legend_of(&[&world], quantity, (range, is_log), None).unwrap()
        };
        let fixed = ColourRange::Fixed(1e-4, 1.0);
        let log = of(GrainQuantity::Speed, fixed, true);
        for i in 0..5 {
            let share = log.share(10.0_f64.powi(i - 4));
            assert!((share - 0.25 * f64::from(i)).abs() < 1e-12, "{share}");
            assert!((log.value(share) / 10.0_f64.powi(i - 4) - 1.0).abs() < 1e-9);
        }
        assert_eq!(log.share(0.0), 0.0);
        let automatic = of(GrainQuantity::Speed, ColourRange::Automatic, true);
        assert!(automatic.is_log && automatic.min > 0.0, "{automatic:?}");
        let signed = of(GrainQuantity::VelocityX, ColourRange::Automatic, true);
        assert_eq!((signed.min, signed.is_log), (-signed.max, false));
        assert_eq!(signed.share(0.0), 0.5);
    }
}
