//! Films as files: an animated GIF, a folder of PNG pictures, a video where ffmpeg is on the search
//! path.
//!
//! In: pictures one after another. Out: the file, whole or not at all. All work is done on a thread
//! of its own.

use crate::view::film_kind::{FilmKind, gif_delay};
use crate::view::film_pictures::{Drawn, Reel, Shot};
use crate::view::png::save_pixels;
use crate::view::video::write_video;
use bevy::math::UVec2;
use grainfall::files::{make_whole_folder, write_whole};
use grainfall::run::Provenance;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread::{Builder, JoinHandle};

/// Pictures that may wait for the thread.
const MOST_WAITING: usize = 4;
/// How thoroughly the colours of a GIF are chosen: 1 best, 30 fastest.
const GIF_SPEED: i32 = 10;

/// A film that is being written.
pub struct FilmWriter {
    shots: Option<Sender<Shot>>,
    waiting: Arc<AtomicUsize>,
    cancelled: Arc<AtomicBool>,
    writer: Option<JoinHandle<io::Result<()>>>,
}

impl FilmWriter {
    /// Begins the film at `path` with `rate` frames a second, which says where it came `from`.
    ///
    /// # Errors
    /// Where a folder of pictures exists already or the system gives no thread.
    pub fn begin(path: PathBuf, kind: FilmKind, rate: f64, from: Provenance) -> io::Result<Self> {
        if kind == FilmKind::Pictures && path.exists() {
            return Err(io::Error::other("it exists already"));
        }
        let (shots, receiver) = channel();
        let (waiting, cancelled) = (Arc::default(), Arc::default());
        let reel = Reel {
            shots: receiver,
            waiting: Arc::clone(&waiting),
            cancelled: Arc::clone(&cancelled),
            from,
            rate,
            is_even: kind.is_even(),
            size: None,
        };
        let write = move || match kind {
            FilmKind::Gif => write_gif(&path, reel),
            FilmKind::Pictures => write_pictures(&path, reel),
            FilmKind::Video(program, codec) => write_video(&path, &program, codec, reel),
        };
        let writer = Builder::new().name("film".to_owned()).spawn(write)?;
        Ok(Self {
            shots: Some(shots),
            waiting,
            cancelled,
            writer: Some(writer),
        })
    }

    /// Whether another picture may come: the thread keeps up.
    pub fn has_room(&self) -> bool {
        self.waiting() < MOST_WAITING
    }

    /// Pictures that are not written yet.
    pub fn waiting(&self) -> usize {
        self.waiting.load(Ordering::Relaxed)
    }

    /// Adds a picture; `from` is the state that it shows.
    pub fn add(&self, drawn: Drawn, from: Option<Provenance>) {
        if let Some(shots) = &self.shots {
            self.waiting.fetch_add(1, Ordering::Relaxed);
            // Where the thread has given up, its reason is told at the end.
            let _ = shots.send(Shot { drawn, from });
        }
    }

    /// There is no further picture.
    pub fn finish(&mut self) {
        self.shots = None;
    }

    /// Leaves nothing behind.
    pub fn cancel(&mut self) {
        self.cancelled.store(true, Ordering::Relaxed);
        self.shots = None;
    }

    /// Whether the thread has ended, with or without a film.
    pub fn has_ended(&self) -> bool {
        self.writer.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// What became of it; waits for the thread.
    ///
    /// # Errors
    /// Why there is no film.
    pub fn outcome(&mut self) -> io::Result<()> {
        self.finish();
        let ended = self.writer.take().map(JoinHandle::join);
        match ended {
            Some(Ok(outcome)) => outcome,
            Some(Err(_)) => Err(io::Error::other("its thread ended by mistake")),
            None => Ok(()),
        }
    }
}

impl Drop for FilmWriter {
    fn drop(&mut self) {
        self.cancel();
        // What is half written goes away with its thread.
        let _ = self.outcome();
    }
}

fn write_gif(path: &Path, mut reel: Reel) -> io::Result<()> {
    write_whole(path, |file| {
        let mut picture = reel.first()?;
        let [width, height] = picture.size.map(|length| length as u16);
        let mut gif = gif::Encoder::new(file, width, height, &[]).map_err(io::Error::other)?;
        gif.set_repeat(gif::Repeat::Infinite)
            .map_err(io::Error::other)?;
        let origin = reel.from.to_string();
        // A block holds no more than that.
        let blocks: Vec<&[u8]> = origin.as_bytes().chunks(255).collect();
        gif.write_raw_extension(gif::Extension::Comment.into(), &blocks)
            .map_err(io::Error::other)?;
        loop {
            let mut frame = gif::Frame::from_rgb_speed(width, height, &picture.pixels, GIF_SPEED);
            frame.delay = gif_delay(reel.rate);
            gif.write_frame(&frame).map_err(io::Error::other)?;
            reel.done();
            match reel.next()? {
                Some(next) => picture = next,
                None => return Ok(()),
            }
        }
    })
}

fn write_pictures(path: &Path, mut reel: Reel) -> io::Result<()> {
    make_whole_folder(path, |folder| {
        let mut next = Some(reel.first()?);
        let mut number = 0;
        while let Some(picture) = next {
            let channels = if picture.has_alpha {
                png::ColorType::Rgba
            } else {
                png::ColorType::Rgb
            };
            let from = picture.from.as_ref().unwrap_or(&reel.from);
            let file = folder.join(format!("{number:05}.png"));
            let pixels = (&*picture.pixels, channels);
            save_pixels(UVec2::from(picture.size), pixels, Some(from), &file)?;
            reel.done();
            number += 1;
            next = reel.next()?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::film_kind::Codec;
    use bevy::asset::RenderAssetUsages;
    use bevy::image::Image;
    use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
    use std::fs;

    /// A picture of one colour, 7 × 6.
    fn plain(shade: u8) -> Image {
        let size = Extent3d {
            width: 7,
            height: 6,
            depth_or_array_layers: 1,
        };
        let pixel = [shade, shade, shade, 255];
        let (format, usages) = (TextureFormat::Rgba8UnormSrgb, RenderAssetUsages::MAIN_WORLD);
        Image::new_fill(size, TextureDimension::D2, &pixel, format, usages)
    }

    fn origin() -> Provenance {
        Provenance::of_scene(&grainfall::scene::Scene::open("small-drum").unwrap())
    }

    fn film(path: &Path, kind: FilmKind, shots: u8) -> io::Result<()> {
        let mut film = FilmWriter::begin(path.to_owned(), kind, 25.0, origin())?;
        for shot in 0..shots {
            film.add(Drawn::Whole(plain(40 * shot)), None);
        }
        film.outcome()
    }

    #[test]
    fn gif_holds_every_picture_at_its_rate() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.gif");
        film(&path, FilmKind::of(&path).unwrap(), 4).unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(fs::File::open(&path).unwrap()).unwrap();
        assert_eq!((decoder.width(), decoder.height()), (7, 6));
        let mut shades = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            assert_eq!(frame.delay, 4);
            shades.push(frame.buffer[0]);
        }
        assert_eq!(shades, [0, 40, 80, 120]);
        let bytes = fs::read(&path).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        assert!(text.contains("Grainfall") && text.contains("seed"));
    }

    #[test]
    fn folder_holds_every_picture() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pictures");
        film(&path, FilmKind::of(&path).unwrap(), 3).unwrap();
        let mut names: Vec<_> = fs::read_dir(&path)
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        names.sort();
        assert_eq!(names, ["00000.png", "00001.png", "00002.png"]);
        let error = film(&path, FilmKind::Pictures, 1).unwrap_err();
        assert!(error.to_string().contains("exists"), "{error}");
    }

    #[test]
    fn cancelled_or_empty_films_leave_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        for kind in [FilmKind::Gif, FilmKind::Pictures] {
            let path = folder.path().join("film");
            let mut film = FilmWriter::begin(path.clone(), kind.clone(), 25.0, origin()).unwrap();
            film.add(Drawn::Whole(plain(1)), None);
            film.cancel();
            assert!(film.outcome().is_err());
            assert!(self::film(&path, kind, 0).is_err(), "it has no picture");
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        }
    }

    #[test]
    fn a_folder_holds_pictures_without_a_ground() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pictures");
        let mut film = FilmWriter::begin(path.clone(), FilmKind::Pictures, 25.0, origin()).unwrap();
        film.add(Drawn::CutOut([plain(0), plain(255)]), None);
        film.add(Drawn::CutOut([plain(80), plain(80)]), None);
        film.outcome().unwrap();
        let alpha = |name: &str| image::open(path.join(name)).unwrap().to_rgba8()[(3, 3)][3];
        assert_eq!((alpha("00000.png"), alpha("00001.png")), (0, 255));
    }

    #[cfg(unix)]
    #[test]
    fn video_is_what_the_program_makes_of_the_pictures() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("ffmpeg");
        // Writes its input to its last argument.
        let script = "#!/bin/sh\nfor last; do :; done\ncat > \"$last\"\n";
        fs::write(&program, script).unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        let path = folder.path().join("film.mp4");
        film(&path, FilmKind::Video(program.clone(), Codec::H264), 3).unwrap();
        // Seven by six, made even.
        assert_eq!(fs::read(&path).unwrap().len(), 3 * 3 * 36);
        fs::write(
            &program,
            "#!/bin/sh\ncat > /dev/null\necho no encoder >&2\nexit 1\n",
        )
        .unwrap();
        let other = folder.path().join("other.mp4");
        let refused = film(&other, FilmKind::Video(program, Codec::H264), 3).unwrap_err();
        assert!(refused.to_string().contains("no encoder"), "{refused}");
        assert!(!other.exists());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
