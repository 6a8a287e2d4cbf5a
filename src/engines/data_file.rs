//! Data files of LIGGGHTS and LAMMPS: what `read_data` reads and `write_data` writes.
//!
//! In: a file of spheres. Out: an [`AtomFrame`] at step zero. Atoms are rows of
//! `id type diameter density x y z`, of which more columns behind (images) are passed over;
//! velocities rows of `id vx vy vz ωx ωy ωz`. Other sections are passed over.

use super::atom_frame::{Atom, AtomFrame, FrameError};
use super::lines::{Lines, shortened};
use crate::physics::limits;
use glam::DVec3;
use std::collections::HashMap;

/// Rows for which room is made before they are read.
const ROOM: usize = 1 << 16;

/// The grains of the file.
///
/// # Errors
/// What is wrong with it, and where.
pub fn read_data_file(lines: &mut Lines) -> Result<AtomFrame, FrameError> {
    // The first line is a title, whatever stands in it.
    lines.line("a title")?;
    let mut count = None;
    let mut atoms: Option<Vec<Atom>> = None;
    while let Some(line) = lines.next_line()? {
        let line = line.split('#').next().unwrap_or_default().trim().to_owned();
        let words: Vec<&str> = line.split_whitespace().collect();
        match (words.as_slice(), &mut atoms) {
            ([number, "atoms"], _) => count = Some(atom_count(lines, number)?),
            (["Atoms"], None) => {
                let count = count.ok_or_else(|| lines.wrong("expected `N atoms` before"))?;
                let rows = rows::<7>(lines, count)?;
                atoms = Some(rows.iter().map(atom).collect());
            }
            (["Velocities"], Some(atoms)) => {
                let rows = rows::<7>(lines, atoms.len())?;
                move_atoms(atoms, &rows).map_err(|reason| lines.wrong(reason))?;
            }
            _ => {}
        }
    }
    let Some(atoms) = atoms else {
        return Err(FrameError::of_file(
            lines.path(),
            "is neither a dump nor a data file: expected `ITEM: TIMESTEP` first, or a section `Atoms`",
        ));
    };
    let frame = AtomFrame {
        step: 0,
        time: None,
        atoms,
    };
    frame
        .ordered()
        .map_err(|reason| FrameError::of_file(lines.path(), reason))
}

fn atom_count(lines: &Lines, word: &str) -> Result<usize, FrameError> {
    let count = word.parse::<u64>().ok();
    let count = count.filter(|count| limits::GRAINS.accept(*count as f64));
    count.map(|count| count as usize).ok_or_else(|| {
        lines.wrong(format!(
            "`{} atoms`; expected {}",
            shortened(word),
            limits::GRAINS.expected
        ))
    })
}

/// So many rows of at least `N` numbers, behind an empty line.
fn rows<const N: usize>(lines: &mut Lines, count: usize) -> Result<Vec<[f64; N]>, FrameError> {
    let mut rows = Vec::with_capacity(count.min(ROOM));
    while rows.len() < count {
        let line = lines.line("a grain")?;
        if line.is_empty() {
            continue;
        }
        let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        let row = numbers.ok().and_then(|row| row.get(..N)?.try_into().ok());
        let line = shortened(line);
        let wrong = || lines.wrong(format!("`{line}`; expected {N} numbers"));
        rows.push(row.ok_or_else(wrong)?);
    }
    Ok(rows)
}

fn atom([id, kind, diameter, density, x, y, z]: &[f64; 7]) -> Atom {
    Atom {
        id: *id as u64,
        kind: *kind as u32,
        position: DVec3::new(*x, *y, *z),
        velocity: DVec3::ZERO,
        spin: DVec3::ZERO,
        radius: 0.5 * diameter,
        orientation: None,
        density: Some(*density),
        force: None,
    }
}

/// Gives the grains their velocities.
fn move_atoms(atoms: &mut [Atom], rows: &[[f64; 7]]) -> Result<(), String> {
    let places: HashMap<u64, usize> = (atoms.iter().enumerate())
        .map(|(place, atom)| (atom.id, place))
        .collect();
    for [id, vx, vy, vz, wx, wy, wz] in rows {
        let place = places.get(&(*id as u64));
        let place = place.ok_or_else(|| format!("a velocity of grain {id}, which is none"))?;
        atoms[*place].velocity = DVec3::new(*vx, *vy, *vz);
        atoms[*place].spin = DVec3::new(*wx, *wy, *wz);
    }
    Ok(())
}
