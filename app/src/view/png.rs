//! Pictures as files.
//!
//! In: what the view drew, or the text of an SVG drawing. Out: a PNG file with where it came from
//! in its text chunks (`iTXt`), whole or not at all; missing folders are made.

use crate::view::cut_out::cut_out;
use bevy::image::Image;
use bevy::math::UVec2;
use bevy_egui::egui::FontDefinitions;
use grainfall::files::write_whole;
use grainfall::run::Provenance;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg;
use resvg::usvg::fontdb;
use std::io;
use std::path::Path;
use std::sync::Arc;

/// Pixels of a drawing for each of its units: sharp on paper and on a large screen.
const DRAWING_SCALE: u32 = 3;

/// Writes `image` to the file at `path`.
///
/// # Errors
/// Where it cannot be encoded or written.
pub fn save_png(image: &Image, from: Option<&Provenance>, path: &Path) -> io::Result<()> {
    let (size, pixels) = rgb(image)?;
    save_pixels(size, (&pixels, png::ColorType::Rgb), from, path)
}

/// Writes what is in the picture of which `grounds` are the ones on black and on white, without a
/// ground, to the file at `path`.
///
/// # Errors
/// Where the two are not of one size, or cannot be encoded or written.
pub fn save_cut_out(
    grounds: [&Image; 2],
    from: Option<&Provenance>,
    path: &Path,
) -> io::Result<()> {
    let [black, white] = grounds.map(rgb);
    let ((size, black), (other, white)) = (black?, white?);
    if size != other {
        return Err(io::Error::other(
            "the window has changed its size meanwhile",
        ));
    }
    let pixels = cut_out(&black, &white);
    save_pixels(size, (&pixels, png::ColorType::Rgba), from, path)
}

/// The size of `image`, and red, green and blue of its pixels.
pub(super) fn rgb(image: &Image) -> io::Result<(UVec2, Vec<u8>)> {
    let pixels = image.clone().try_into_dynamic();
    let pixels = pixels.map_err(io::Error::other)?.into_rgb8();
    Ok((UVec2::from(pixels.dimensions()), pixels.into_raw()))
}

/// Writes the drawing `svg`, which covers all of its ground, to the file at `path`.
///
/// # Errors
/// Where it is no drawing, or cannot be encoded or written.
pub fn save_drawing(svg: &str, from: &Provenance, path: &Path) -> io::Result<()> {
    let drawing = drawing(svg).map_err(io::Error::other)?;
    let size = drawing.size().to_int_size();
    let size = DRAWING_SCALE * UVec2::new(size.width(), size.height());
    let mut picture =
        Pixmap::new(size.x, size.y).ok_or_else(|| io::Error::other("it is too large"))?;
    let scale = Transform::from_scale(DRAWING_SCALE as f32, DRAWING_SCALE as f32);
    resvg::render(&drawing, scale, &mut picture.as_mut());
    let pixels: Vec<u8> = picture
        .pixels()
        .iter()
        .flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()])
        .collect();
    save_pixels(size, (&pixels, png::ColorType::Rgb), Some(from), path)
}

/// The drawing that `svg` states, its text in the fonts of the window.
fn drawing(svg: &str) -> Result<usvg::Tree, usvg::Error> {
    let mut fonts = fontdb::Database::new();
    for data in FontDefinitions::default().font_data.values() {
        fonts.load_font_data(data.font.to_vec());
    }
    fonts.set_sans_serif_family("Ubuntu");
    let options = usvg::Options {
        fontdb: Arc::new(fonts),
        ..usvg::Options::default()
    };
    usvg::Tree::from_str(svg, &options)
}

/// Writes a picture of this size, whose pixels have these channels, to the file at `path`.
///
/// # Errors
/// Where it cannot be encoded or written.
pub(super) fn save_pixels(
    size: UVec2,
    (pixels, channels): (&[u8], png::ColorType),
    from: Option<&Provenance>,
    path: &Path,
) -> io::Result<()> {
    write_whole(path, |file| {
        let mut encoder = png::Encoder::new(file, size.x, size.y);
        encoder.set_color(channels);
        encoder.set_depth(png::BitDepth::Eight);
        for (name, value) in from.map_or_else(Vec::new, Provenance::entries) {
            encoder.add_itxt_chunk(name.to_owned(), value)?;
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(pixels)?;
        writer.finish()?;
        Ok(())
    })
}
