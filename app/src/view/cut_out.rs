//! A picture without its ground: what is in it with how much of it covers what is behind.
//!
//! In: the same picture on black and on white. Out: one with an alpha channel. Whoever lays it on
//! black or on white, blending as browsers do (the numbers of sRGB as they are), gets the two pictures
//! back to a few parts in 255, at edges and through glass too; on other grounds what lies between.

use bevy::prelude::Color;

/// What is behind the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ground {
    /// The colour that a person chose.
    #[default]
    Chosen,
    /// Black.
    Black,
    /// White.
    White,
}

impl Ground {
    /// Its colour, where `chosen` is the one that a person chose.
    pub(super) fn colour(self, chosen: Color) -> Color {
        match self {
            Self::Chosen => chosen,
            Self::Black => Color::BLACK,
            Self::White => Color::WHITE,
        }
    }
}

/// Red, green, blue and alpha of each pixel of a picture whose red, green and blue are these
/// `on_black` and these `on_white`.
pub fn cut_out(on_black: &[u8], on_white: &[u8]) -> Vec<u8> {
    let pixels = on_black.chunks_exact(3).zip(on_white.chunks_exact(3));
    pixels
        .flat_map(|(black, white)| pixel(black, white))
        .collect()
}

fn pixel(black: &[u8], white: &[u8]) -> [u8; 4] {
    let lighter = |(black, white): (&u8, &u8)| f64::from(white.saturating_sub(*black));
    let through: f64 = black.iter().zip(white).map(lighter).sum::<f64>() / 3.0;
    let alpha = 1.0 - through / 255.0;
    let colour = |channel: usize| match black[channel] {
        0 => 0,
        own => (f64::from(own) / alpha).round().min(255.0) as u8,
    };
    let alpha_of_255 = (255.0 * alpha).round() as u8;
    [colour(0), colour(1), colour(2), alpha_of_255]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `colour` laid on `ground` with this alpha, as browsers do.
    fn laid(colour: [u8; 3], alpha: f64, ground: u8) -> [u8; 3] {
        colour.map(|own| (alpha * f64::from(own) + (1.0 - alpha) * f64::from(ground)).round() as u8)
    }

    #[test]
    fn what_covers_a_part_of_its_ground_comes_back_with_its_colour_and_that_part() {
        for colour in [[230, 120, 30], [0, 0, 0], [255, 255, 255], [12, 200, 90]] {
            for alpha in [1.0, 0.75, 0.5, 0.2] {
                let found = cut_out(&laid(colour, alpha, 0), &laid(colour, alpha, 255));
                assert!(
                    (f64::from(found[3]) / 255.0 - alpha).abs() < 0.005,
                    "{found:?}"
                );
                // Half of one in 255, by a part of 0.2.
                for (own, known) in found.iter().zip(colour) {
                    assert!(
                        own.abs_diff(known) <= 3,
                        "{found:?} of {colour:?} at {alpha}"
                    );
                }
            }
        }
        assert_eq!(cut_out(&[0; 3], &[255; 3]), [0; 4]);
    }
}
