//! Dumps of LIGGGHTS and LAMMPS in text, as `dump custom` writes them.
//!
//! In: a file with one or several instants. Out: an [`AtomFrame`] for each, one at a time. Needed are
//! the columns `id x y z vx vy vz` and `radius` or `diameter`; positions may be unwrapped (`xu`) or in
//! parts of the box (`xs`, `xsu`), see [`super::dump_box`]; `type`, `omegax omegay omegaz`,
//! `fx fy fz` and `density` are read where they are there, others passed over. Values are in SI
//! units; a file that says otherwise is refused.

use super::atom_frame::{Atom, AtomFrame, FrameError};
use super::dump_box::{DumpBox, PositionColumns};
use super::lines::{Lines, shortened};
use crate::physics::limits;
use crate::world::MOST_STEPS;
use glam::DVec3;

/// Rows for which room is made before they are read.
const ROOM: usize = 1 << 16;

/// Where each number of a grain stands in a row.
struct Columns {
    count: usize,
    id: usize,
    kind: Option<usize>,
    position: PositionColumns,
    velocity: [usize; 3],
    spin: Option<[usize; 3]>,
    force: Option<[usize; 3]>,
    /// With what it is multiplied with to be a radius.
    radius: (usize, f64),
    density: Option<usize>,
}

impl Columns {
    /// Those of the words after `ITEM: ATOMS`.
    fn of(words: &[&str]) -> Result<Self, String> {
        let place = |word: &str| words.iter().position(|known| *known == word);
        let three = |names: [&str; 3]| -> Option<[usize; 3]> {
            Some([place(names[0])?, place(names[1])?, place(names[2])?])
        };
        let needed = |names: [&str; 3]| {
            three(names).ok_or_else(|| {
                format!(
                    "the columns are `{}`; expected {} among them",
                    shortened(&words.join(" ")),
                    names.join(", ")
                )
            })
        };
        let radius = place("radius").map(|at| (at, 1.0));
        let radius = radius.or_else(|| place("diameter").map(|at| (at, 0.5)));
        let position = match PositionColumns::of(words) {
            Some(known) => known,
            None => PositionColumns {
                at: needed(["x", "y", "z"])?,
                is_scaled: false,
            },
        };
        Ok(Self {
            count: words.len(),
            id: place("id").ok_or("there is no column `id`")?,
            kind: place("type"),
            position,
            velocity: needed(["vx", "vy", "vz"])?,
            spin: three(["omegax", "omegay", "omegaz"]),
            force: three(["fx", "fy", "fz"]),
            radius: radius.ok_or("there is neither a column `radius` nor `diameter`")?,
            density: place("density"),
        })
    }

    /// The grain of a row.
    fn atom(&self, words: &[&str]) -> Result<Atom, String> {
        if words.len() != self.count {
            return Err(format!(
                "{} values; expected {}, as many as there are columns",
                words.len(),
                self.count
            ));
        }
        let number = |at: usize| -> Result<f64, String> {
            let word = words[at];
            let wrong = || format!("`{}` is no number", shortened(word));
            word.parse().map_err(|_| wrong())
        };
        let whole = |at: usize| -> Result<u64, String> {
            let word = words[at];
            let wrong = || format!("`{}` is no whole number", shortened(word));
            word.parse().map_err(|_| wrong())
        };
        let vector = |at: [usize; 3]| -> Result<DVec3, String> {
            Ok(DVec3::new(number(at[0])?, number(at[1])?, number(at[2])?))
        };
        let kind = self.kind.map_or(Ok(1), whole)?;
        Ok(Atom {
            id: whole(self.id)?,
            kind: u32::try_from(kind).map_err(|_| format!("a type is {kind}"))?,
            position: vector(self.position.at)?,
            velocity: vector(self.velocity)?,
            spin: self.spin.map_or(Ok(DVec3::ZERO), vector)?,
            radius: number(self.radius.0)? * self.radius.1,
            orientation: None,
            density: self.density.map(number).transpose()?,
            force: self.force.map(vector).transpose()?,
        })
    }
}

/// A number of steps that a run can come to.
fn step_number(lines: &mut Lines) -> Result<u64, FrameError> {
    let step = lines.number("a number of steps")?;
    if step <= MOST_STEPS {
        return Ok(step);
    }
    Err(lines.wrong(format!(
        "step {step}; expected at most {MOST_STEPS}, as no run has more"
    )))
}

/// The next instant in `lines`; none at the end.
///
/// # Errors
/// What is wrong with the file, and where.
pub fn next_frame(lines: &mut Lines) -> Result<Option<AtomFrame>, FrameError> {
    let (mut step, mut time, mut count) = (None, None, None);
    let mut domain = DumpBox::default();
    loop {
        let Some(line) = lines.next_line()? else {
            return match step {
                None => Ok(None),
                Some(_) => Err(lines.wrong("the file ends; expected `ITEM: ATOMS`")),
            };
        };
        let line = line.trim().to_owned();
        let Some(item) = line.strip_prefix("ITEM:").map(str::trim) else {
            if line.is_empty() {
                continue;
            }
            return Err(lines.wrong(format!("`{}`; expected `ITEM: …`", shortened(&line))));
        };
        match item.split_whitespace().next().unwrap_or_default() {
            "TIMESTEP" => step = Some(step_number(lines)?),
            "TIME" => time = Some(lines.number("a time")?),
            "UNITS" => expect_si(lines)?,
            "NUMBER" => count = Some(atom_count(lines)?),
            "BOX" => {
                let kind = item.trim_start_matches("BOX").trim_start();
                let kind = kind.trim_start_matches("BOUNDS").trim();
                domain = DumpBox::read(lines, kind)?;
            }
            "ATOMS" => {
                let words: Vec<&str> = item.split_whitespace().skip(1).collect();
                let columns = Columns::of(&words).map_err(|reason| lines.wrong(reason))?;
                let (Some(step), Some(count)) = (step, count) else {
                    return Err(lines.wrong("expected TIMESTEP and NUMBER OF ATOMS before"));
                };
                let scale = columns.position.is_scaled.then(|| domain.scale());
                let scale = scale.transpose().map_err(|reason| lines.wrong(reason))?;
                let mut atoms = rows(lines, &columns, count)?;
                if let Some((corner, edges)) = scale {
                    for atom in &mut atoms {
                        atom.position = corner + edges * atom.position;
                    }
                }
                let frame = AtomFrame { step, time, atoms };
                return frame.ordered().map(Some).map_err(|r| lines.wrong(r));
            }
            _ => {
                return Err(lines.wrong(format!(
                    "`{}`; expected TIMESTEP, NUMBER OF ATOMS, BOX BOUNDS, UNITS, TIME or ATOMS",
                    shortened(item)
                )));
            }
        }
    }
}

fn expect_si(lines: &mut Lines) -> Result<(), FrameError> {
    let units = lines.line("the units")?.to_owned();
    if units == "si" {
        return Ok(());
    }
    Err(lines.wrong(format!("units `{}`; expected `si`", shortened(&units))))
}

fn atom_count(lines: &mut Lines) -> Result<usize, FrameError> {
    let count: u64 = lines.number("a number of grains")?;
    if limits::GRAINS.accept(count as f64) {
        return Ok(count as usize);
    }
    Err(lines.wrong(format!(
        "{count} grains; expected {}",
        limits::GRAINS.expected
    )))
}

fn rows(lines: &mut Lines, columns: &Columns, count: usize) -> Result<Vec<Atom>, FrameError> {
    let mut atoms = Vec::with_capacity(count.min(ROOM));
    for _ in 0..count {
        let line = lines.line("a grain")?;
        let words: Vec<&str> = line.split_whitespace().collect();
        let atom = columns.atom(&words);
        atoms.push(atom.map_err(|reason| lines.wrong(reason))?);
    }
    Ok(atoms)
}
