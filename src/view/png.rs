//! Pictures as files.

use crate::files::write_whole;
use crate::simulation::Provenance;
use bevy::image::Image;
use bevy::math::{URect, UVec2};
use std::io;
use std::path::Path;

/// Writes `image` as a PNG file, whole or not at all, with where it came from in its text chunks (`iTXt`); missing folders
/// are made.
///
/// # Errors
/// Where it cannot be encoded or written.
pub fn save_png(image: &Image, from: Option<&Provenance>, path: &Path) -> io::Result<()> {
    let whole = URect::from_corners(UVec2::ZERO, image.size());
    save_part(image, whole, from, path)
}

/// Writes the part `area` [pixels] of `image`, as [`save_png`] does the whole of it.
///
/// # Errors
/// Where there is no such part, or it cannot be encoded or written.
pub fn save_part(
    image: &Image,
    area: URect,
    from: Option<&Provenance>,
    path: &Path,
) -> io::Result<()> {
    let area = area.intersect(URect::from_corners(UVec2::ZERO, image.size()));
    if area.is_empty() {
        return Err(io::Error::other("it is not in the picture"));
    }
    let pixels = image.clone().try_into_dynamic();
    let pixels = pixels.map_err(io::Error::other)?;
    let (corner, size) = (area.min, area.size());
    let pixels = (pixels.crop_imm(corner.x, corner.y, size.x, size.y)).into_rgb8();
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
