//! Videos: another program encodes them.
//!
//! In: the pictures of a film. Out: the file that ffmpeg makes of them, whole or not at all.

use crate::view::film_kind::Codec;
use crate::view::film_pictures::{FilmPicture, Reel};
use grainfall::files::make_whole_file;
use std::io::{self, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Stdio};

/// Has the `program` make the video of the `reel` at `path`.
pub(super) fn write_video(path: &Path, program: &Path, codec: Codec, reel: Reel) -> io::Result<()> {
    make_whole_file(path, |file| make_video(file, program, codec, reel))
}

fn make_video(file: &Path, program: &Path, codec: Codec, mut reel: Reel) -> io::Result<()> {
    let first = reel.first()?;
    let [width, height] = first.size;
    let pixels = if first.has_alpha { "rgba" } else { "rgb24" };
    let mut child = Command::new(program)
        .args(["-loglevel", "error", "-f", "rawvideo", "-pix_fmt", pixels])
        .args(["-s", &format!("{width}x{height}")])
        .args(["-r", &reel.rate.to_string(), "-i", "-"])
        .args(codec.arguments(first.has_alpha))
        .args(["-y", "-metadata", &format!("comment={}", reel.from)])
        .arg(file)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()?;
    let said = child.stderr.take().map(heard);
    let fed = feed(&mut child, first, &mut reel);
    let is_cancelled = matches!(&fed, Err(error) if error.kind() == io::ErrorKind::Interrupted);
    if fed.is_err() {
        // It has ended by itself, or its film is not wanted.
        let _ = child.kill();
    }
    let status = child.wait()?;
    let said = said.map_or_else(String::new, |said| said.join().unwrap_or_default());
    if is_cancelled || status.success() {
        return fed;
    }
    let last = said.lines().next_back().unwrap_or_default();
    let program = program.display();
    Err(io::Error::other(match last {
        "" => format!("{program} ended with {status}"),
        last => format!("{program} ended with {status}: {last}"),
    }))
}

/// What a program says, read while it works: else it would wait for its reader.
fn heard(mut said: ChildStderr) -> std::thread::JoinHandle<String> {
    std::thread::spawn(move || {
        let mut text = Vec::new();
        // What was read before an error is all that it said.
        let _ = said.read_to_end(&mut text);
        String::from_utf8_lossy(&text).into_owned()
    })
}

fn feed(child: &mut Child, first: FilmPicture, reel: &mut Reel) -> io::Result<()> {
    let mut input = child.stdin.take();
    let mut next = Some(first);
    while let (Some(input), Some(picture)) = (&mut input, next) {
        input.write_all(&picture.pixels)?;
        reel.done();
        next = reel.next()?;
    }
    Ok(())
}
