//! Pictures as files.

use crate::files::write_whole;
use bevy::image::{Image, ImageFormat};
use std::io::{self, Cursor};
use std::path::Path;

/// Writes `image` as a PNG file, whole or not at all; missing folders are made.
///
/// # Errors
/// Where it cannot be encoded or written.
pub fn save_png(image: &Image, path: &Path) -> io::Result<()> {
    let pixels = image
        .clone()
        .try_into_dynamic()
        .map_err(io::Error::other)?
        .to_rgb8();
    let png = ImageFormat::Png.as_image_crate_format();
    let png = png.ok_or_else(|| io::Error::other("this build knows no PNG"))?;
    let mut bytes = Cursor::new(Vec::new());
    pixels.write_to(&mut bytes, png).map_err(io::Error::other)?;
    write_whole(path, |file| file.write_all(bytes.get_ref()))
}
