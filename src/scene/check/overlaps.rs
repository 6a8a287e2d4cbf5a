//! Which listed grains overlap by more than a contact does.

use super::clearance::LARGEST_OVERLAP;
use super::values::Checked;
use crate::scene::error::Problem;
use crate::scene::grains::SceneGrain;
use crate::scene::shape::SceneBody;
use glam::DVec3;
use std::collections::{BTreeMap, HashMap};

/// No two listed grains overlap by more than a contact does.
///
/// Grains lie in grids of cells, one grid for each power of two of the diameter, so that a few
/// large grains among many small ones cost no more than equal ones.
pub(super) fn check_overlaps(grains: &[SceneGrain], bodies: &[SceneBody]) -> Checked {
    let mut grids: BTreeMap<i32, HashMap<[i64; 3], Vec<usize>>> = BTreeMap::new();
    for (index, grain) in grains.iter().enumerate() {
        let level = level_of(grain.radius);
        let cell = cell_of(grain.position, level);
        let grid = grids.entry(level).or_default();
        grid.entry(cell).or_default().push(index);
    }
    for (index, grain) in grains.iter().enumerate() {
        for (&level, grid) in grids.range(level_of(grain.radius)..) {
            let near = neighbourhood(cell_of(grain.position, level))
                .filter_map(|cell| grid.get(&cell))
                .flatten();
            for &other in near.filter(|&&other| other != index) {
                check_pair_overlap(grains, bodies, index.min(other), index.max(other))?;
            }
        }
    }
    Ok(())
}

fn check_pair_overlap(
    grains: &[SceneGrain],
    bodies: &[SceneBody],
    first: usize,
    second: usize,
) -> Checked {
    let (a, b) = (&grains[first], &grains[second]);
    let overlap = a.radius + b.radius - a.position.distance(b.position);
    if overlap <= 0.0 {
        return Ok(());
    }
    let cores_meet = match (&bodies[first], &bodies[second]) {
        (SceneBody::Sphere, SceneBody::Sphere) => None,
        (SceneBody::Polyhedron { core, .. }, SceneBody::Sphere) => Some(core.holds(b.position)),
        (SceneBody::Sphere, SceneBody::Polyhedron { core, .. }) => Some(core.holds(a.position)),
        (SceneBody::Polyhedron { core: a, .. }, SceneBody::Polyhedron { core: b, .. }) => {
            Some(!a.common_part(b).faces.is_empty())
        }
    };
    if let Some(meet) = cores_meet {
        return if meet {
            Err(Problem::new(
                format!("grains[{second}].position"),
                format!(
                    "makes it overlap the grain `grains[{first}]` with more than its rounded edges"
                ),
                "a place of its own: only roundings may overlap",
            ))
        } else {
            Ok(())
        };
    }
    let most = LARGEST_OVERLAP * a.radius.min(b.radius);
    if overlap <= most {
        return Ok(());
    }
    Err(Problem::new(
        format!("grains[{second}].position"),
        format!("makes it overlap the grain `grains[{first}]` by {overlap:.4e} m"),
        format!("at most {most:.4e} m, a tenth of the smaller radius"),
    ))
}

/// The power of two that is just not below the diameter.
#[expect(
    clippy::disallowed_methods,
    reason = "any size of cells that holds a grain finds the same overlaps"
)]
fn level_of(radius: f64) -> i32 {
    (2.0 * radius).log2().ceil() as i32
}

#[expect(
    clippy::disallowed_methods,
    reason = "a power of two to a whole exponent is exact"
)]
fn cell_of(position: DVec3, level: i32) -> [i64; 3] {
    let size = f64::from(level).exp2();
    position.to_array().map(|x| (x / size).floor() as i64)
}

fn neighbourhood(cell: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    let around = |x: i64| [x - 1, x, x + 1];
    around(cell[0]).into_iter().flat_map(move |x| {
        around(cell[1])
            .into_iter()
            .flat_map(move |y| around(cell[2]).into_iter().map(move |z| [x, y, z]))
    })
}
