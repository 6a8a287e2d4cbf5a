//! Pictures as files.

use crate::files::write_whole;
use crate::simulation::Provenance;
use bevy::image::Image;
use std::io;
use std::path::Path;

/// Writes `image` as a PNG file, whole or not at all, with where it came from in its text chunks (`iTXt`); missing folders
/// are made.
///
/// # Errors
/// Where it cannot be encoded or written.
pub fn save_png(image: &Image, from: Option<&Provenance>, path: &Path) -> io::Result<()> {
    let pixels = image.clone().try_into_dynamic();
    let pixels = pixels.map_err(io::Error::other)?.to_rgb8();
    write_whole(path, |file| {
        let mut encoder = png::Encoder::new(file, pixels.width(), pixels.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        for (name, value) in from.map_or_else(Vec::new, Provenance::entries) {
            encoder.add_itxt_chunk(name.to_owned(), value)?;
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&pixels)?;
        writer.finish()?;
        Ok(())
    })
}
