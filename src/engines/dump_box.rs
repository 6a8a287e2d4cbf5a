//! The box of a dump, and where grains stand in it.
//!
//! In: the three lines of `ITEM: BOX BOUNDS`. Out: positions from the coordinates that a dump
//! states: as they are (`x`, unwrapped `xu`), or in parts of the box (`xs`, unwrapped `xsu`),
//! `x = x_low + x_s (x_high − x_low)`. In a tilted box the bounds are those of the box round it, and
//! parts are those of its edges: there they are refused.

use super::atom_frame::FrameError;
use super::lines::{Lines, shortened};
use glam::DVec3;

/// The box of an instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DumpBox {
    /// What follows `BOX BOUNDS`.
    kind: String,
    /// Low and high bound of each axis [m], and what stands behind them.
    rows: Vec<Vec<f64>>,
}

/// Where grains stand in a row, and what is stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PositionColumns {
    /// Places in a row.
    pub at: [usize; 3],
    /// Whether they are parts of the box.
    pub is_scaled: bool,
}

impl PositionColumns {
    /// Those among the columns called `words`: whole before parts, unwrapped before wrapped.
    pub fn of(words: &[&str]) -> Option<Self> {
        let known = [
            (["xu", "yu", "zu"], false),
            (["x", "y", "z"], false),
            (["xsu", "ysu", "zsu"], true),
            (["xs", "ys", "zs"], true),
        ];
        let place = |word: &str| words.iter().position(|known| *known == word);
        known.into_iter().find_map(|([x, y, z], is_scaled)| {
            let at = [place(x)?, place(y)?, place(z)?];
            Some(Self { at, is_scaled })
        })
    }
}

impl DumpBox {
    /// The box whose bounds are the next three lines; `kind` is what follows `BOX BOUNDS`.
    ///
    /// # Errors
    /// When the file ends before.
    pub fn read(lines: &mut Lines, kind: &str) -> Result<Self, FrameError> {
        let mut rows = Vec::with_capacity(3);
        for _ in 0..3 {
            let line = lines.line("the bounds of the box")?;
            // What is no number is told of where the bounds are needed.
            let numbers = line.split_whitespace().map(str::parse::<f64>);
            rows.push(numbers.map(|number| number.unwrap_or(f64::NAN)).collect());
        }
        let kind = kind.to_owned();
        Ok(Self { kind, rows })
    }

    /// Low corner and edges [m] of a box along the axes.
    ///
    /// # Errors
    /// Why parts of it are no places, in words.
    pub fn scale(&self) -> Result<(DVec3, DVec3), String> {
        let instead = "dump `x y z` in the place of parts of the box";
        if self.kind.starts_with("abc") {
            return Err(format!("the box is a general parallelepiped: {instead}"));
        }
        let mut corners = [[0.0; 2]; 3];
        for (corner, row) in corners.iter_mut().zip(&self.rows) {
            let [low, high, tilt] = match row[..] {
                [low, high] => [low, high, 0.0],
                [low, high, tilt] => [low, high, tilt],
                _ => {
                    return Err(format!(
                        "a bound of the box has {} numbers; expected 2",
                        row.len()
                    ));
                }
            };
            if !(high - low).is_finite() || high <= low {
                return Err(format!(
                    "the box is from {low:?} to {high:?}; expected a low and a high bound"
                ));
            }
            if tilt != 0.0 {
                return Err(format!(
                    "the box is tilted (`{}`): {instead}",
                    shortened(&self.kind)
                ));
            }
            *corner = [low, high];
        }
        if self.rows.len() < 3 {
            return Err(format!("there is no `ITEM: BOX BOUNDS` before: {instead}"));
        }
        let [low, high] = [0, 1].map(|k| DVec3::from_array(corners.map(|corner| corner[k])));
        Ok((low, high - low))
    }
}
