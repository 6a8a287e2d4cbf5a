//! Voronoi cells: their sizes and number, the part of the container they fill, grains kept in a
//! file, and what a scene of polyhedra cannot have.

use super::clearance::{DEEPEST_ROUNDING, clearance, is_beside_column};
use super::values::{Checked, fraction, within};
use crate::physics::limits::{self, MOST_POLYHEDRA};
use crate::scene::Scene;
use crate::scene::container::{SceneContainer, volume};
use crate::scene::error::Problem;
use crate::scene::grains::SceneCells;
use crate::scene::stored_cells::StoredCells;

/// Voronoi cells that are made to choose the grains from, in numbers of [`MOST_POLYHEDRA`].
const CELLS_PER_GRAIN: usize = 2;
/// Points that are scattered over the box round the container, one in each cell of its lattice.
const MOST_POINTS: f64 = 2e6;
/// Volume of the box round a cylinder over the cylinder's, and room for whole numbers of cells.
const ROUND_BOX: f64 = 1.5;

impl Scene {
    pub(super) fn check_cells(&self, cells: &SceneCells) -> Checked {
        self.check_species()?;
        if let Some(packing) = &cells.packing {
            return self.check_packing(packing);
        }
        within(&limits::CELL, cells.cell, || "grains.cell".to_owned())?;
        within(&limits::ROUNDING, cells.rounding, || {
            "grains.rounding".to_owned()
        })?;
        if !(1e-3..=0.2).contains(&(cells.rounding / cells.cell)) {
            return Err(Problem::value(
                "grains.rounding",
                format!("{} m", cells.rounding),
                format!(
                    "between a thousandth and a fifth of the cell of {} m",
                    cells.cell
                ),
            ));
        }
        fraction("grains.solid_fraction", cells.solid_fraction)?;
        fraction("grains.bulk_fraction", cells.bulk_fraction)?;
        self.check_bed(cells)
    }

    /// The grains of a file stand in the container.
    fn check_packing(&self, packing: &StoredCells) -> Checked {
        let grains = packing.grains();
        let outside = grains.iter().filter(|grain| {
            let room = grain.corners().map(|x| clearance(&self.container, x));
            let least = (1.0 - DEEPEST_ROUNDING) * grain.shape.rounding;
            room.fold(f64::INFINITY, f64::min) < least
                || is_beside_column(&self.container, grain.position)
        });
        let outside = outside.count();
        if outside == 0 && grains.len() <= MOST_POLYHEDRA {
            return Ok(());
        }
        Err(Problem::new(
            "grains.packing",
            format!(
                "holds {} grains, {outside} of them not inside of the container",
                grains.len()
            ),
            format!("at most {MOST_POLYHEDRA} grains that stand clear of every wall, within the column where there is one"),
        )
        .advise("Take the container that the grains were packed in"))
    }

    fn check_bed(&self, cells: &SceneCells) -> Checked {
        let column = matches!(self.container, SceneContainer::Column { .. });
        if column && cells.bulk_fraction < 1.0 {
            return Err(Problem::new(
                "grains.bulk_fraction",
                "is given for a column, which is as high as its `height` says",
                "the `height` of the container alone",
            ));
        }
        if !column && volume(&self.container).is_err() {
            return Err(Problem::new(
                "grains",
                "are Voronoi cells, but the container is open",
                "a `Column`, a `Box` or a `Drum` to fill, or the grains as a `List`",
            ));
        }
        let (all, grains) = (
            cells.cell_count(&self.container),
            cells.grain_count(&self.container),
        );
        // A lattice has one cell along each edge at least: in a thin box far more than its volume
        // holds, and what is not taken away of them becomes grains.
        let points = cells.lattice_size(&self.container);
        let all = all.max((points * cells.bulk_fraction / ROUND_BOX) as usize);
        let are_few = (1..=MOST_POLYHEDRA).contains(&grains);
        if are_few && all <= CELLS_PER_GRAIN * MOST_POLYHEDRA {
            return check_lattice(points);
        }
        Err(Problem::new(
            "grains",
            format!("are {grains} of {all} Voronoi cells"),
            format!(
                "between 1 and {MOST_POLYHEDRA} polyhedra, up to 20 kB of memory each, of {} cells at most",
                CELLS_PER_GRAIN * MOST_POLYHEDRA
            ),
        )
        .advise("Take larger cells or a smaller container"))
    }

    /// What only spheres can have.
    pub(super) fn check_suits_polyhedra(&self) -> Checked {
        if self.law.feature_springs().is_none() {
            return Err(Problem::new(
                "law",
                "is the one of spheres, but the scene has polyhedra",
                "`Hooke(normal_stiffness: …, tangential_stiffness: …)`, or no `law` for the springs of Man et al. 2023",
            ));
        }
        if matches!(self.container, SceneContainer::Mesh { .. }) {
            return Err(Problem::new(
                "container",
                "is a `Mesh`, whose walls spheres touch, but the scene has polyhedra",
                "a `Drum`, a `Box`, a `Column` or `Planes`, or spheres",
            ));
        }
        if self.liquid.is_some() {
            return Err(Problem::new(
                "liquid",
                "makes bridges between spheres, but the scene has polyhedra",
                "no `liquid`",
            ));
        }
        for material in &self.materials {
            if material.rolling_friction != 0.0 {
                let path = format!("materials.{}.rolling_friction", material.name);
                return Err(no_rolling(path, material.rolling_friction));
            }
        }
        for (index, pair) in self.pairs.iter().enumerate() {
            if let Some(value) = pair.rolling_friction.filter(|&value| value != 0.0) {
                return Err(no_rolling(
                    format!("pairs[{index}].rolling_friction"),
                    value,
                ));
            }
        }
        Ok(())
    }
}

fn no_rolling(path: String, value: f64) -> Problem {
    Problem::value(
        path,
        value,
        "0, or nothing: polyhedra do not roll as spheres do and have no rolling friction",
    )
}

/// Refuses a lattice of so many cells that scattering a point in each fills the memory, however
/// few of them the bed takes.
fn check_lattice(points: f64) -> Checked {
    if points <= MOST_POINTS {
        return Ok(());
    }
    Err(Problem::new(
        "grains",
        format!("are Voronoi cells of a lattice of {points:.0} cells"),
        format!("at most {MOST_POINTS:.0} cells in the box round the container"),
    )
    .advise("Take larger cells or a smaller container"))
}
