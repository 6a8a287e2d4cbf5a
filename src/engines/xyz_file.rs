//! Extended XYZ as exaDEM writes it by the scripts that are handed to it.
//!
//! In: a file of one instant, in mm and s. Out: an [`AtomFrame`] in SI units. The first line is the
//! number of bodies, the second states columns (`Properties=…`) and `Time=`; needed are `pos`,
//! `velocity`, `id` (from 0 on), `radius`, `orient` (w x y z) and `vrot`. The number of steps is the
//! last number in the file's name.

use super::atom_frame::{Atom, AtomFrame, FrameError};
use super::lines::{Lines, shortened};
use super::mpi_engine::PER_METRE;
use crate::physics::limits;
use glam::{DQuat, DVec3};
use std::path::Path;

/// Rows for which room is made before they are read.
const ROOM: usize = 1 << 16;

/// Where the columns of a body begin in a row.
struct Columns {
    count: usize,
    position: usize,
    velocity: usize,
    id: usize,
    radius: usize,
    orientation: usize,
    spin: usize,
}

impl Columns {
    /// Those of `name:kind:width:name:kind:width:…`.
    fn of(properties: &str) -> Result<Self, String> {
        let words: Vec<&str> = properties.split(':').collect();
        let mut known: Vec<(&str, usize, usize)> = Vec::new();
        let mut count = 0_usize;
        for property in words.chunks(3) {
            let width = property
                .get(2)
                .and_then(|width| width.parse::<usize>().ok());
            let width = width
                .filter(|width| (1..=9).contains(width))
                .ok_or_else(|| {
                    let property = shortened(&property.join(":"));
                    format!("`{property}` among the properties; expected `name:kind:width`")
                })?;
            known.push((property[0], count, width));
            count += width;
        }
        let place = |names: [&str; 2], width: usize| {
            let found = known
                .iter()
                .find(|(name, _, of)| names.contains(name) && *of == width);
            found.map(|(_, at, _)| *at).ok_or_else(|| {
                format!(
                    "the properties are `{}`; expected {} of width {width} among them",
                    shortened(properties),
                    names[0]
                )
            })
        };
        Ok(Self {
            count,
            position: place(["pos", "position"], 3)?,
            velocity: place(["vel", "velocity"], 3)?,
            id: place(["id", "id"], 1)?,
            radius: place(["radius", "radius"], 1)?,
            orientation: place(["orient", "orient"], 4)?,
            spin: place(["vrot", "vrot"], 3)?,
        })
    }

    /// The body of a row.
    fn body(&self, words: &[&str]) -> Result<Atom, String> {
        if words.len() != self.count {
            return Err(format!(
                "{} values; expected {}, as many as there are columns",
                words.len(),
                self.count
            ));
        }
        let number = |at: usize| -> Result<f64, String> {
            let wrong = |_| format!("`{}` is no number", shortened(words[at]));
            words[at].parse().map_err(wrong)
        };
        let vector = |at: usize| -> Result<DVec3, String> {
            Ok(DVec3::new(number(at)?, number(at + 1)?, number(at + 2)?))
        };
        let id: u32 = (words[self.id].parse())
            .map_err(|_| format!("`{}` is no whole number", shortened(words[self.id])))?;
        let (w, xyz) = (number(self.orientation)?, vector(self.orientation + 1)?);
        let turn = DQuat::from_xyzw(xyz.x, xyz.y, xyz.z, w);
        // Eleven digits of each part are stated.
        if (turn.length() - 1.0).abs() > 1e-6 || !turn.is_finite() {
            return Err(format!(
                "the orientation of body {id} is no rotation: {turn}"
            ));
        }
        Ok(Atom {
            id: u64::from(id) + 1,
            kind: 1,
            position: vector(self.position)? / PER_METRE,
            velocity: vector(self.velocity)? / PER_METRE,
            spin: vector(self.spin)?,
            radius: number(self.radius)? / PER_METRE,
            orientation: Some(turn.normalize()),
            density: None,
            force: None,
        })
    }
}

/// The bodies of the file.
///
/// # Errors
/// What is wrong with it, and where.
pub fn read_xyz_file(lines: &mut Lines) -> Result<AtomFrame, FrameError> {
    let count: u64 = lines.number("a number of bodies")?;
    if !limits::GRAINS.accept(count as f64) {
        let expected = limits::GRAINS.expected;
        return Err(lines.wrong(format!("{count} bodies; expected {expected}")));
    }
    let head = lines.line("`Properties=…`")?.to_owned();
    let columns = value(&head, "Properties=").ok_or("there are no `Properties=`".to_owned());
    let columns = columns
        .and_then(Columns::of)
        .map_err(|reason| lines.wrong(reason))?;
    let time = value(&head, "Time=").map(str::parse::<f64>).transpose();
    let time = time.map_err(|_| lines.wrong("`Time=` is no number"))?;
    let step = step_in_name(lines.path()).ok_or_else(|| {
        FrameError::of_file(
            lines.path(),
            "has no number in its name; expected that of the step, as in grains_000000000100.xyz",
        )
    })?;
    let mut atoms = Vec::with_capacity((count as usize).min(ROOM));
    for _ in 0..count {
        let words: Vec<&str> = lines.line("a body")?.split_whitespace().collect();
        let body = columns.body(&words);
        atoms.push(body.map_err(|reason| lines.wrong(reason))?);
    }
    if lines
        .next_line()?
        .is_some_and(|rest| !rest.trim().is_empty())
    {
        return Err(lines.wrong(format!("expected the end after {count} bodies")));
    }
    let frame = AtomFrame { step, time, atoms };
    (frame.ordered()).map_err(|reason| FrameError::of_file(lines.path(), reason))
}

/// What follows `key` in a line of such.
fn value<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    let (_, rest) = line.split_once(key)?;
    rest.split_whitespace().next()
}

/// The last number in a file's name.
fn step_in_name(path: &Path) -> Option<u64> {
    let name = path.file_stem()?.to_str()?;
    let digits = name.rsplit(|c: char| !c.is_ascii_digit());
    digits
        .into_iter()
        .find(|word| !word.is_empty())?
        .parse()
        .ok()
}
