//! The contacts at one instant as a VTK file of lines (`.vtp`); `collection_file` lists them.
//!
//! In: a world as a solver left it. Out: a file with a line for each pair that touches or is held
//! by a liquid bridge, from the centre of the first to that of the second, or to the place where it
//! touches a wall. Forces come term by term from the solver's own code
//! ([`crate::solver::force_terms`]). Values are in SI units, in 32 bits; arrays have the names by
//! which OVITO knows a contact network:
//!
//! | array | what it is |
//! |---|---|
//! | `id1`, `id2` | the two grains, as `grains_file` has them; of a wall −1 less its number |
//! | `point` | where they touch, of polyhedra the middle of all places by their force \[m\] |
//! | `normal` | unit vector from the first to the second; of polyhedra that of all places |
//! | `force_normal` | force on the first along the normal, the bridge's too \[N\] |
//! | `force_tangential` | force on the first across the normal, the bridge's too \[N\] |
//! | `overlap` | of polyhedra the largest; negative where there is a gap \[m\] |
//! | `bridge_volume` | where there is liquid: that of the bridge, 0 where there is none \[m³\] |

use super::vtk::{Array, DataSet};
use crate::run::Provenance;
use crate::solver::{ForceTerms, force_terms};
use crate::world::{Contact, Partner, World};
use glam::DVec3;
use std::io::{self, Write};

/// Writes the contacts of `world`, which come `from` there, to `file`.
///
/// # Errors
/// When the file cannot be written.
pub fn write_contacts(world: &World, from: &Provenance, file: &mut dyn Write) -> io::Result<()> {
    let lines: Vec<Line> = (world.contacts.iter())
        .filter_map(|contact| Line::of(world, contact))
        .collect();
    let (lines, count) = (&lines[..], lines.len());
    let points = i32::try_from(2 * count).map_err(io::Error::other)?;
    let ends = move || lines.iter().flat_map(|line| line.ends);
    let network = DataSet {
        kind: "PolyData",
        counts: vec![
            ("NumberOfPoints", 2 * count),
            ("NumberOfVerts", 0),
            ("NumberOfLines", count),
            ("NumberOfStrips", 0),
            ("NumberOfPolys", 0),
        ],
        elements: vec![
            ("CellData", data(lines, world.wetting().is_some())),
            ("Points", vec![Array::vectors("Points", 2 * count, ends)]),
            (
                "Lines",
                vec![
                    Array::integers("connectivity", 2 * count, move || 0..points),
                    Array::integers("offsets", count, move || (2..=points).step_by(2)),
                ],
            ),
        ],
    };
    network.write(from, file)
}

/// What each of the `lines` has beside its ends.
fn data(lines: &[Line], is_wet: bool) -> Vec<Array<'_>> {
    let count = lines.len();
    let vectors =
        |name, of: fn(&Line) -> DVec3| Array::vectors(name, count, move || lines.iter().map(of));
    let scalars =
        |name, of: fn(&Line) -> f64| Array::scalars(name, count, move || lines.iter().map(of));
    let mut data = vec![
        Array::integers("id1", count, || lines.iter().map(|line| line.pair[0])),
        Array::integers("id2", count, || lines.iter().map(|line| line.pair[1])),
        vectors("point", |line| line.point),
        vectors("normal", |line| line.normal),
        vectors("force_normal", |line| line.along),
        vectors("force_tangential", |line| line.across),
        scalars("overlap", |line| line.overlap),
    ];
    if is_wet {
        data.push(scalars("bridge_volume", |line| line.bridge));
    }
    data
}

/// A contact as the file shows it.
struct Line {
    pair: [i32; 2],
    /// Its two ends [m].
    ends: [DVec3; 2],
    /// Where the forces act [m].
    point: DVec3,
    normal: DVec3,
    /// Force on the first along the normal [N].
    along: DVec3,
    /// Force on the first across it [N].
    across: DVec3,
    overlap: f64,
    /// Volume of the bridge [m³].
    bridge: f64,
}

impl Line {
    /// That of `contact`; none where nothing acts, as where a bridge's gap is beyond its rupture.
    fn of(world: &World, contact: &Contact) -> Option<Self> {
        let terms = force_terms(world, contact);
        let largest = terms.iter().map(|term| term.overlap).reduce(f64::max)?;
        let weights: Vec<f64> = (terms.iter())
            .map(|term| along_normal(term).length())
            .collect();
        let total: f64 = weights.iter().sum();
        // Places that press by nothing count alike.
        let weight = |k: usize| {
            if total > 0.0 {
                weights[k] / total
            } else {
                1.0 / terms.len() as f64
            }
        };
        let mean = |of: fn(&ForceTerms) -> DVec3| -> DVec3 {
            terms
                .iter()
                .enumerate()
                .map(|(k, term)| weight(k) * of(term))
                .sum()
        };
        let point = mean(|term| term.point);
        let first = contact.grain as usize;
        let (second, end) = match contact.partner {
            Partner::Grain(j) => (j.cast_signed(), world.grains.position[j as usize]),
            Partner::Wall(w) => (-1 - w.cast_signed(), point),
        };
        Some(Self {
            pair: [contact.grain.cast_signed(), second],
            ends: [world.grains.position[first], end],
            point,
            normal: mean(|term| term.normal).normalize_or_zero(),
            along: terms.iter().map(along_normal).sum(),
            across: terms.iter().map(across_normal).sum(),
            overlap: largest,
            bridge: contact.bridge.as_ref().map_or(0.0, |bridge| bridge.volume),
        })
    }
}

/// All that acts along the normal of one place [N].
fn along_normal(term: &ForceTerms) -> DVec3 {
    term.normal_spring + term.normal_dashpot + term.capillary + term.viscous_normal
}

/// All that acts across it [N].
fn across_normal(term: &ForceTerms) -> DVec3 {
    term.tangential_spring + term.tangential_dashpot + term.viscous_tangential
}
