//! Films as files: an animated GIF, a folder of PNG pictures, an MP4 where ffmpeg is on the search
//! path.
//!
//! In: pictures one after another. Out: the file, whole or not at all. All work is done on a thread
//! of its own.

use crate::view::png::save_png;
use bevy::image::Image;
use bevy::math::URect;
use grainfall::files::{make_whole_file, make_whole_folder, write_whole};
use grainfall::run::Provenance;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{Builder, JoinHandle};

/// Pictures a second.
pub const FILM_RATE: u32 = 25;
/// Pictures that may wait for the thread.
const MOST_WAITING: usize = 4;
/// How thoroughly the colours of a GIF are chosen: 1 best, 30 fastest.
const GIF_SPEED: i32 = 10;

/// What a film is written as.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FilmKind {
    /// An animated GIF, 256 colours a picture.
    Gif,
    /// A folder of numbered PNG files.
    Pictures,
    /// An MP4 by this program, which takes ffmpeg's arguments.
    Video(PathBuf),
}

impl FilmKind {
    /// The kind that the name of `path` asks for: `.gif`, `.mp4`, or none for a folder.
    ///
    /// # Errors
    /// In words, where its ending is another, or there is no program for it.
    pub fn of(path: &Path) -> Result<Self, String> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            None => Ok(Self::Pictures),
            Some("gif") => Ok(Self::Gif),
            Some("mp4") => on_path("ffmpeg").map(Self::Video).ok_or_else(|| {
                "an MP4 needs the program ffmpeg on the search path; a name that ends in .gif, or a folder, does without".to_owned()
            }),
            Some(other) => Err(format!(
                "a film ends in .gif or .mp4, or is a folder of pictures, but not .{other}"
            )),
        }
    }
}

/// Where the search path has the program `name`.
fn on_path(name: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    let candidates = std::env::split_paths(&folders).map(|folder| folder.join(name));
    candidates.into_iter().find(|path| path.is_file())
}

/// A part of a picture.
struct Shot {
    image: Image,
    area: URect,
}

/// A film that is being written.
pub struct FilmWriter {
    shots: Option<Sender<Shot>>,
    waiting: Arc<AtomicUsize>,
    cancelled: Arc<AtomicBool>,
    writer: Option<JoinHandle<io::Result<()>>>,
}

impl FilmWriter {
    /// Begins the film at `path`, which says where it came `from`.
    ///
    /// # Errors
    /// Where a folder of pictures exists already or the system gives no thread.
    pub fn begin(path: PathBuf, kind: FilmKind, from: Provenance) -> io::Result<Self> {
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
            size: None,
        };
        let write = move || match kind {
            FilmKind::Gif => write_gif(&path, reel),
            FilmKind::Pictures => write_pictures(&path, reel),
            FilmKind::Video(program) => write_video(&path, &program, reel),
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

    /// Adds the part `area` [pixels] of a picture.
    pub fn add(&self, image: Image, area: URect) {
        if let Some(shots) = &self.shots {
            self.waiting.fetch_add(1, Ordering::Relaxed);
            // Where the thread has given up, its reason is told at the end.
            let _ = shots.send(Shot { image, area });
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

/// The pictures as they come, all of the first one's size.
struct Reel {
    shots: Receiver<Shot>,
    waiting: Arc<AtomicUsize>,
    cancelled: Arc<AtomicBool>,
    from: Provenance,
    size: Option<[u32; 2]>,
}

/// A picture: width, height, red, green, blue by rows.
struct FilmPicture {
    size: [u32; 2],
    rgb: Vec<u8>,
}

impl Reel {
    /// The next picture; none after the last.
    fn next(&mut self) -> io::Result<Option<FilmPicture>> {
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
        let picture = shot.develop(self.size)?;
        self.size = Some(picture.size);
        Ok(Some(picture))
    }

    /// Says that a picture is written.
    fn done(&self) {
        self.waiting.fetch_sub(1, Ordering::Relaxed);
    }

    /// The first picture.
    fn first(&mut self) -> io::Result<FilmPicture> {
        self.next()?
            .ok_or_else(|| io::Error::other("it has no picture"))
    }
}

impl Shot {
    /// The part asked for, in `size` where that is given: cut or filled with black where a window
    /// has changed.
    fn develop(self, size: Option<[u32; 2]>) -> io::Result<FilmPicture> {
        let dynamic = self.image.try_into_dynamic().map_err(io::Error::other)?;
        let all = dynamic.into_rgb8();
        let (width, height) = all.dimensions();
        let from = self.area.min;
        // Even: MP4 halves the colours' resolution.
        let even = |from: u32, to: u32, end: u32| (to.min(end).saturating_sub(from)) & !1;
        let own = [
            even(from.x, self.area.max.x, width),
            even(from.y, self.area.max.y, height),
        ];
        let size = size.unwrap_or(own);
        if size.contains(&0) {
            return Err(io::Error::other("the picture has no size"));
        }
        let mut rgb = vec![0; 3 * (size[0] * size[1]) as usize];
        let columns = 3 * own[0].min(size[0]) as usize;
        for y in 0..own[1].min(size[1]) {
            let start = 3 * ((from.y + y) * width + from.x) as usize;
            let to = 3 * (y * size[0]) as usize;
            rgb[to..to + columns].copy_from_slice(&all.as_raw()[start..start + columns]);
        }
        Ok(FilmPicture { size, rgb })
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
            let mut frame = gif::Frame::from_rgb_speed(width, height, &picture.rgb, GIF_SPEED);
            frame.delay = (100 / FILM_RATE) as u16;
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
        while let Some(FilmPicture { size, rgb }) = next {
            let picture = image_of(size, rgb)?;
            let file = folder.join(format!("{number:05}.png"));
            save_png(&picture, Some(&reel.from), &file)?;
            reel.done();
            number += 1;
            next = reel.next()?;
        }
        Ok(())
    })
}

/// A picture as Bevy has them.
fn image_of([width, height]: [u32; 2], rgb: Vec<u8>) -> io::Result<Image> {
    use bevy::asset::RenderAssetUsages;
    use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
    let rgba = rgb.chunks_exact(3).flat_map(|p| [p[0], p[1], p[2], 255]);
    let data: Vec<u8> = rgba.collect();
    if data.len() != 4 * (width * height) as usize {
        return Err(io::Error::other("the picture has another size"));
    }
    let size = Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    let (flat, format) = (TextureDimension::D2, TextureFormat::Rgba8UnormSrgb);
    Ok(Image::new(
        size,
        flat,
        data,
        format,
        RenderAssetUsages::MAIN_WORLD,
    ))
}

fn write_video(path: &Path, program: &Path, reel: Reel) -> io::Result<()> {
    make_whole_file(path, |file| make_video(file, program, reel))
}

/// Has the `program` make the video of the `reel` at `file`.
fn make_video(file: &Path, program: &Path, mut reel: Reel) -> io::Result<()> {
    let first = reel.first()?;
    let [width, height] = first.size;
    let size = format!("{width}x{height}");
    let rate = FILM_RATE.to_string();
    let origin = format!("comment={}", reel.from);
    let mut child = Command::new(program)
        .args([
            "-loglevel",
            "error",
            "-f",
            "rawvideo",
            "-pix_fmt",
            "rgb24",
            "-s",
            &size,
            "-r",
            &rate,
        ])
        .args([
            "-i", "-", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "18", "-y",
        ])
        .args(["-metadata", &origin])
        .arg(file)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()?;
    let fed = feed(&mut child, first, &mut reel);
    if fed.is_err() {
        // It has ended by itself, or its film is not wanted.
        let _ = child.kill();
    }
    let status = child.wait()?;
    fed?;
    if !status.success() {
        return Err(io::Error::other(format!("ffmpeg ended with {status}")));
    }
    Ok(())
}

fn feed(child: &mut std::process::Child, first: FilmPicture, reel: &mut Reel) -> io::Result<()> {
    let mut input = child.stdin.take();
    let mut next = Some(first);
    while let (Some(input), Some(picture)) = (&mut input, next) {
        input.write_all(&picture.rgb)?;
        reel.done();
        next = reel.next()?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::UVec2;
    use std::fs;

    /// A picture of one colour, 10 × 8.
    fn plain(shade: u8) -> Image {
        image_of([10, 8], vec![shade; 240]).unwrap()
    }

    fn origin() -> Provenance {
        Provenance::of_scene(&grainfall::scene::Scene::open("small-drum").unwrap())
    }

    fn film(path: &Path, kind: FilmKind, shots: u8) -> io::Result<()> {
        let mut film = FilmWriter::begin(path.to_owned(), kind, origin())?;
        for shot in 0..shots {
            film.add(plain(40 * shot), URect::new(1, 1, 8, 7));
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
        // Seven by six, made even.
        assert_eq!((decoder.width(), decoder.height()), (6, 6));
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
            let mut film = FilmWriter::begin(path.clone(), kind.clone(), origin()).unwrap();
            film.add(plain(1), URect::new(0, 0, 10, 8));
            film.cancel();
            assert!(film.outcome().is_err());
            assert!(self::film(&path, kind, 0).is_err(), "it has no picture");
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        }
    }

    #[test]
    fn pictures_of_another_size_are_cut_to_the_first() {
        let first = Shot {
            image: plain(200),
            area: URect::new(0, 0, 4, 4),
        };
        let size = first.develop(None).unwrap().size;
        let second = Shot {
            image: plain(200),
            area: URect::from_corners(UVec2::new(8, 6), UVec2::new(20, 20)),
        };
        let picture = second.develop(Some(size)).unwrap();
        assert_eq!((picture.size, picture.rgb.len()), ([4, 4], 48));
        // Two by two of it are there, the rest is black.
        let bright: u32 = picture.rgb.iter().map(|x| u32::from(*x)).sum();
        assert_eq!(bright, 12 * 200);
    }

    #[test]
    fn endings_choose_the_kind() {
        assert_eq!(FilmKind::of(Path::new("a.GIF")), Ok(FilmKind::Gif));
        assert_eq!(FilmKind::of(Path::new("folder")), Ok(FilmKind::Pictures));
        let refused = FilmKind::of(Path::new("a.avi")).unwrap_err();
        assert!(refused.contains(".gif"), "{refused}");
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
        film(&path, FilmKind::Video(program.clone()), 3).unwrap();
        assert_eq!(fs::read(&path).unwrap().len(), 3 * 3 * 36);
        fs::write(&program, "#!/bin/sh\ncat > /dev/null\nexit 1\n").unwrap();
        let other = folder.path().join("other.mp4");
        assert!(film(&other, FilmKind::Video(program), 3).is_err());
        assert!(!other.exists());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
