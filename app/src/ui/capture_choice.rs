//! What somebody chose of pictures and films, remembered for the next ones.
//!
//! In: orders. Out: plain data, sound whatever a file held.

use crate::picture_size;
use crate::ui::screenshot_orders::{PictureOf, ScreenshotOrder};
use crate::view::{FILM_RATE, FILM_RATES};
use bevy::math::UVec2;
use serde::{Deserialize, Serialize};

/// What somebody chose the last time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct CaptureChoice {
    /// Width and height of pictures [pixels]; as the window's where none are given.
    picture_size: Option<[u32; 2]>,
    /// The same of films.
    film_size: Option<[u32; 2]>,
    /// What films show.
    film_of: PictureOf,
    /// Frames a second.
    film_rate: f64,
}

impl Default for CaptureChoice {
    fn default() -> Self {
        Self {
            picture_size: None,
            film_size: None,
            film_of: PictureOf::Picture,
            film_rate: FILM_RATE,
        }
    }
}

impl CaptureChoice {
    /// Width and height of pictures [pixels]; as the window's where none are given.
    pub fn picture_size(&self) -> Option<UVec2> {
        sound(self.picture_size)
    }

    /// The same of films.
    pub fn film_size(&self) -> Option<UVec2> {
        sound(self.film_size)
    }

    /// What films show.
    pub fn film_of(&self) -> PictureOf {
        self.film_of
    }

    /// Frames a second.
    pub fn film_rate(&self) -> f64 {
        Some(self.film_rate)
            .filter(|rate| FILM_RATES.contains(rate))
            .unwrap_or(FILM_RATE)
    }

    /// What is chosen once this was ordered.
    #[must_use]
    pub fn after(mut self, order: &ScreenshotOrder) -> Self {
        match order {
            ScreenshotOrder::Picture(order) => {
                self.picture_size = order.size.map(|size| size.to_array());
            }
            ScreenshotOrder::Film(order) => {
                self.film_size = order.size.map(|size| size.to_array());
                self.film_of = order.of;
                self.film_rate = order.pace.rate;
            }
            ScreenshotOrder::EndFilm | ScreenshotOrder::CancelFilm => {}
        }
        self
    }
}

/// A size that can be, out of a file.
fn sound(size: Option<[u32; 2]>) -> Option<UVec2> {
    let text = picture_size::in_words(size?.into());
    picture_size::read(&text).ok()
}
