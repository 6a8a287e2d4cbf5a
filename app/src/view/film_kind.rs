//! What films are written as, and how they pass.
//!
//! In: the name of a file, frames a second, simulated seconds a second. Out: the kind, what it can
//! hold, the simulated time from frame to frame. Nothing is written here.

use grainfall::measure::numeral;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// Frames a second where nobody asks for another number.
pub const FILM_RATE: f64 = 25.0;
/// Frames a second that a film may have.
pub const FILM_RATES: RangeInclusive<f64> = 1.0..=60.0;
/// Simulated seconds for each second of a film.
pub const FILM_SPEEDS: RangeInclusive<f64> = 1e-6..=1e6;
/// A GIF keeps times in hundredths of a second, and what is shorter than two of them is shown slowly.
const SHORTEST_DELAY: f64 = 2.0;
const VIDEO_PROGRAM: &str = "ffmpeg";

/// What a film is written as.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FilmKind {
    /// An animated GIF, 256 colours a picture.
    Gif,
    /// A folder of numbered PNG files.
    Pictures,
    /// A video by this program, which takes ffmpeg's arguments.
    Video(PathBuf, Codec),
}

/// How a video is encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Codec {
    /// H.264 in an MP4.
    H264,
    /// VP9 in a `WebM`, which can have an alpha channel.
    Vp9,
    /// `ProRes` 4444 in a MOV, which can have an alpha channel.
    ProRes,
}

impl Codec {
    const ALL: [Self; 3] = [Self::H264, Self::Vp9, Self::ProRes];

    fn ending(self) -> &'static str {
        match self {
            Self::H264 => "mp4",
            Self::Vp9 => "webm",
            Self::ProRes => "mov",
        }
    }

    /// What ffmpeg calls it.
    fn encoder(self) -> &'static str {
        match self {
            Self::H264 => "libx264",
            Self::Vp9 => "libvpx-vp9",
            Self::ProRes => "prores_ks",
        }
    }

    /// What ffmpeg is told of it, with an alpha channel or without.
    pub(super) fn arguments(self, has_alpha: bool) -> Vec<&'static str> {
        let pixels = match (self, has_alpha) {
            (Self::H264, _) | (Self::Vp9, false) => "yuv420p",
            (Self::Vp9, true) => "yuva420p",
            (Self::ProRes, false) => "yuv444p10le",
            (Self::ProRes, true) => "yuva444p10le",
        };
        let quality: &[&str] = match self {
            Self::H264 => &["-crf", "18"],
            Self::Vp9 => &["-crf", "24", "-b:v", "0", "-auto-alt-ref", "0"],
            Self::ProRes => &["-profile:v", "4444"],
        };
        [&["-c:v", self.encoder(), "-pix_fmt", pixels], quality].concat()
    }
}

impl FilmKind {
    /// The kind that the name of `path` asks for: `.gif`, a video, or none for a folder.
    ///
    /// # Errors
    /// In words, where its ending is another, or there is no program for it.
    pub fn of(path: &Path) -> Result<Self, String> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let Some(ending) = ending.as_deref() else {
            return Ok(Self::Pictures);
        };
        if ending == "gif" {
            return Ok(Self::Gif);
        }
        let Some(codec) = Codec::ALL
            .into_iter()
            .find(|codec| codec.ending() == ending)
        else {
            return Err(format!(
                "a film ends in .gif, .mp4, .webm or .mov, or is a folder of pictures, but not .{ending}"
            ));
        };
        let Some(program) = on_path(VIDEO_PROGRAM) else {
            return Err(format!(
                "a film that ends in .{ending} needs the program {VIDEO_PROGRAM} on the search path; one that ends in .gif, or a \
                 folder, does without"
            ));
        };
        let encoder = codec.encoder();
        if !encoders(&program).contains(encoder) {
            return Err(format!(
                "{} here has no encoder {encoder}, which .{ending} needs: name a .gif or a folder",
                program.display()
            ));
        }
        Ok(Self::Video(program, codec))
    }

    /// Why it cannot be transparent, where that is so.
    pub fn why_opaque(&self) -> Option<&'static str> {
        match self {
            Self::Gif => Some(
                "A GIF has no half-transparent pixels, which edges and glass need: name a folder, a .webm or a .mov",
            ),
            Self::Video(_, Codec::H264) => {
                Some("An MP4 has no alpha channel: name a folder, a .webm or a .mov")
            }
            Self::Pictures | Self::Video(_, Codec::Vp9 | Codec::ProRes) => None,
        }
    }

    /// Frames a second of a film of this kind where `rate` are asked for: what it can hold that is
    /// next to it.
    pub fn rate(&self, rate: f64) -> f64 {
        match self {
            Self::Gif => 100.0 / f64::from(gif_delay(rate)),
            Self::Pictures | Self::Video(..) => rate,
        }
    }

    /// Whether width and height must be even: some videos halve the colours' resolution.
    pub(super) fn is_even(&self) -> bool {
        matches!(self, Self::Video(..))
    }
}

/// How long a frame of a GIF with so many frames a second is shown [hundredths of a second].
pub(super) fn gif_delay(rate: f64) -> u16 {
    (100.0 / rate).round().max(SHORTEST_DELAY) as u16
}

/// How a film passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Frames a second.
    pub rate: f64,
    /// Simulated seconds for each second of the film.
    pub speed: f64,
}

impl Pace {
    /// Simulated time from frame to frame [s].
    pub fn interval(self) -> f64 {
        self.speed / self.rate
    }

    /// Frames from the simulated time `from` to `to` [s], both included.
    pub fn frames(self, from: f64, to: f64) -> usize {
        // A frame that is due at the end but for rounding is one.
        let intervals = (to - from).max(0.0) / self.interval();
        (intervals * (1.0 + 1e-9)).floor() as usize + 1
    }

    /// `25 frames a second, 20.00 ms of simulated time from frame to frame: slow motion, 2 times
    /// slower than real time`.
    pub fn in_words(self) -> String {
        let speed = if self.speed == 1.0 {
            "real time".to_owned()
        } else if self.speed < 1.0 {
            let times = numeral::rounded(1.0 / self.speed, 3);
            format!("slow motion, {times} times slower than real time")
        } else {
            let times = numeral::rounded(self.speed, 3);
            format!("time lapse, {times} times faster than real time")
        };
        format!(
            "{} frames a second, {} of simulated time from frame to frame: {speed}",
            numeral::rounded(self.rate, 3),
            numeral::with_prefix(self.interval(), "s")
        )
    }
}

/// Where the search path has the program `name`.
fn on_path(name: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    let candidates = std::env::split_paths(&folders).map(|folder| folder.join(name));
    candidates.into_iter().find(|path| path.is_file())
}

/// What the `program` says that it can encode; asked once.
fn encoders(program: &Path) -> &'static str {
    static SAID: OnceLock<String> = OnceLock::new();
    SAID.get_or_init(|| {
        let mut asked = Command::new(program);
        asked
            .args(["-hide_banner", "-encoders"])
            .stdin(Stdio::null());
        let said = asked.output().map(|output| output.stdout);
        // A program that does not answer encodes nothing.
        String::from_utf8_lossy(&said.unwrap_or_default()).into_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_choose_the_kind() {
        assert_eq!(FilmKind::of(Path::new("a.GIF")), Ok(FilmKind::Gif));
        assert_eq!(FilmKind::of(Path::new("folder")), Ok(FilmKind::Pictures));
        let refused = FilmKind::of(Path::new("a.avi")).unwrap_err();
        assert!(refused.contains(".gif"), "{refused}");
    }

    #[test]
    fn kinds_say_whether_they_can_be_transparent() {
        let video = |codec| FilmKind::Video(PathBuf::from("ffmpeg"), codec);
        for kind in [FilmKind::Gif, video(Codec::H264)] {
            assert!(kind.why_opaque().is_some_and(|why| why.contains(".webm")));
        }
        for kind in [FilmKind::Pictures, video(Codec::Vp9), video(Codec::ProRes)] {
            assert_eq!(kind.why_opaque(), None);
        }
    }

    #[test]
    fn a_gif_has_the_rate_that_its_hundredths_allow() {
        for (asked, had) in [(25.0, 25.0), (30.0, 100.0 / 3.0), (60.0, 50.0), (1.0, 1.0)] {
            assert_eq!(FilmKind::Gif.rate(asked), had);
            assert_eq!(FilmKind::Pictures.rate(asked), asked);
        }
    }

    #[test]
    fn a_pace_tells_simulated_time_and_frames() {
        let pace = Pace {
            rate: 25.0,
            speed: 0.5,
        };
        assert_eq!(pace.interval(), 0.02);
        assert_eq!((pace.frames(0.0, 0.1), pace.frames(3.0, 3.0)), (6, 1));
        assert_eq!(pace.frames(0.0, 0.119), 6);
        let words = pace.in_words();
        assert!(
            words.contains("20.00 ms") && words.contains("2 times slower"),
            "{words}"
        );
    }
}
