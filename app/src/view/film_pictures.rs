//! The pictures of a film on their way to the thread that writes them.
//!
//! In: what was drawn. Out: pixels, all pictures in the size of the first.

use crate::view::cut_out::cut_out;
use crate::view::png::rgb;
use bevy::image::Image;
use grainfall::run::Provenance;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::Receiver;

/// What was drawn for one picture.
#[expect(
    clippy::large_enum_variant,
    reason = "one at a time, beside pictures of megabytes"
)]
pub enum Drawn {
    /// On its ground.
    Whole(Image),
    /// On black and on white, for a picture without a ground.
    CutOut([Image; 2]),
}

/// One picture, and the state that it shows.
pub(super) struct Shot {
    pub(super) drawn: Drawn,
    pub(super) from: Option<Provenance>,
}

/// A picture: width, height, channels by rows.
pub(super) struct FilmPicture {
    pub(super) size: [u32; 2],
    pub(super) pixels: Vec<u8>,
    pub(super) has_alpha: bool,
    /// The state that it shows.
    pub(super) from: Option<Provenance>,
}

/// The pictures as they come, all of the first one's size.
pub(super) struct Reel {
    pub(super) shots: Receiver<Shot>,
    pub(super) waiting: Arc<AtomicUsize>,
    pub(super) cancelled: Arc<AtomicBool>,
    pub(super) from: Provenance,
    /// Frames a second.
    pub(super) rate: f64,
    /// Whether width and height must be even.
    pub(super) is_even: bool,
    pub(super) size: Option<[u32; 2]>,
}

impl Reel {
    /// The next picture; none after the last.
    pub(super) fn next(&mut self) -> io::Result<Option<FilmPicture>> {
        let shot = self.shots.recv();
        if self.cancelled.load(Ordering::Relaxed) {
            return Err(io::Error::new(
                io::ErrorKind::Interrupted,
                "it was cancelled",
            ));
        }
        let Ok(shot) = shot else {
            return Ok(None);
        };
        let picture = shot.develop(self.is_even)?;
        if picture.size != *self.size.get_or_insert(picture.size) {
            return Err(io::Error::other(
                "a picture has another size than the first",
            ));
        }
        Ok(Some(picture))
    }

    /// Says that a picture is written.
    pub(super) fn done(&self) {
        self.waiting.fetch_sub(1, Ordering::Relaxed);
    }

    /// The first picture.
    pub(super) fn first(&mut self) -> io::Result<FilmPicture> {
        self.next()?
            .ok_or_else(|| io::Error::other("it has no picture"))
    }
}

impl Shot {
    /// Its pixels; without the last row and column where sides must be even and are not.
    pub(super) fn develop(self, is_even: bool) -> io::Result<FilmPicture> {
        let (size, pixels, has_alpha) = match &self.drawn {
            Drawn::Whole(image) => {
                let (size, pixels) = rgb(image)?;
                (size, pixels, false)
            }
            Drawn::CutOut(grounds) => {
                let [black, white] = grounds.each_ref().map(rgb);
                let ((size, black), (other, white)) = (black?, white?);
                if size != other {
                    return Err(io::Error::other(
                        "its pictures on black and white differ in size",
                    ));
                }
                (size, cut_out(&black, &white), true)
            }
        };
        let whole = size.to_array();
        let kept = if is_even {
            whole.map(|side| side & !1)
        } else {
            whole
        };
        if kept.contains(&0) {
            return Err(io::Error::other("the picture has no size"));
        }
        let channels = if has_alpha { 4 } else { 3 };
        let rows = pixels.chunks_exact((channels * whole[0]) as usize);
        let rows = rows.take(kept[1] as usize);
        Ok(FilmPicture {
            size: kept,
            pixels: rows
                .flat_map(|row| &row[..(channels * kept[0]) as usize])
                .copied()
                .collect(),
            has_alpha,
            from: self.from,
        })
    }
}
