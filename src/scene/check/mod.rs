//! Which values make sense, each alone and all together.
//!
//! In: a [`Scene`] as a file or a program states it. Out: nothing, or the first mistake with the
//! path of its key. A scene that passes can be built: its grains fit, its names exist, its numbers
//! are finite and within what the solver can bear.
//!
//! | file | checks |
//! |---|---|
//! | `material_values` | materials and pairs of them |
//! | `container_values` | the container |
//! | `filling` | a filling of spheres |
//! | `voronoi_cells` | Voronoi cells, and what suits polyhedra |
//! | `listed_grains`, `overlaps` | grains that are listed; which of them overlap |
//! | `clearance` | how far a point is from the walls |
//! | `values` | single numbers, vectors and names |

mod clearance;
mod container_values;
mod filling;
mod listed_grains;
mod material_values;
mod overlaps;
mod values;
mod voronoi_cells;

pub(super) use container_values::check_container;
pub(super) use values::{fraction, within};

use super::container::SceneContainer;
use super::description::{Scene, TimeStep, Until};
use super::error::Problem;
use super::grains::SceneGrains;
use crate::physics::limits;
use crate::physics::{ContactLaw, Liquid};
use material_values::{check_materials, check_pairs};
use values::{Checked, vector};

/// States a run may write.
const MOST_OUTPUTS: f64 = 1e6;

impl Scene {
    /// Whether every value is in range and all of them fit together.
    pub(crate) fn problem(&self) -> Checked {
        check_title(&self.title)?;
        check_materials(&self.materials)?;
        check_pairs(&self.pairs, self)?;
        check_container(&self.container)?;
        self.check_container_materials()?;
        match &self.grains {
            SceneGrains::Fill { count, species, .. } => self.check_filling(*count, species)?,
            SceneGrains::Voronoi(cells) => self.check_cells(cells)?,
            SceneGrains::List(grains) => self.check_list(grains)?,
        }
        if self.is_polyhedral() {
            self.check_suits_polyhedra()?;
        }
        self.liquid.as_ref().map_or(Ok(()), check_liquid)?;
        vector(self.gravity, limits::GRAVITY.most, "m/s²", || {
            "gravity".to_owned()
        })?;
        check_law(self.law)?;
        self.check_times()
    }

    fn check_times(&self) -> Checked {
        within(&limits::DURATION, self.duration, || "duration".to_owned())?;
        if self.until == Until::Rest && !matches!(self.container, SceneContainer::Column { .. }) {
            return Err(Problem::value(
                "until",
                "Rest",
                "`Duration`: only in a `Column` is it known what is at rest",
            ));
        }
        within(&limits::DURATION, self.output_interval, || {
            "output_interval".to_owned()
        })?;
        if self.duration / self.output_interval > MOST_OUTPUTS {
            return Err(Problem::value(
                "output_interval",
                format!("{} s", self.output_interval),
                format!(
                    "at least {} s, so that a run writes at most a million states",
                    self.duration / MOST_OUTPUTS
                ),
            ));
        }
        if let Some(interval) = self.sample_interval {
            within(&limits::DURATION, interval, || "sample_interval".to_owned())?;
            if self.duration / interval > MOST_OUTPUTS {
                return Err(Problem::value(
                    "sample_interval",
                    format!("{interval} s"),
                    format!(
                        "at least {} s, so that a run takes at most a million samples",
                        self.duration / MOST_OUTPUTS
                    ),
                ));
            }
        }
        let TimeStep::Given(step) = self.time_step else {
            return Ok(());
        };
        within(&limits::TIME_STEP, step, || "time_step".to_owned())?;
        if step > self.output_interval {
            return Err(Problem::value(
                "time_step",
                format!("{step} s"),
                format!("at most the output interval of {} s", self.output_interval),
            ));
        }
        Ok(())
    }
}

fn check_title(title: &str) -> Checked {
    let length = title.trim().chars().count();
    if (1..=200).contains(&length) && !title.contains('\n') {
        return Ok(());
    }
    Err(Problem::value(
        "title",
        format!("{length} characters long"),
        "one line of 1 to 200 characters",
    ))
}

fn check_liquid(liquid: &Liquid) -> Checked {
    within(&limits::SURFACE_TENSION, liquid.surface_tension, || {
        "liquid.surface_tension".to_owned()
    })?;
    within(&limits::CONTACT_ANGLE, liquid.contact_angle, || {
        "liquid.contact_angle".to_owned()
    })?;
    within(&limits::VISCOSITY, liquid.viscosity, || {
        "liquid.viscosity".to_owned()
    })?;
    within(&limits::LIQUID_VOLUME, liquid.volume, || {
        "liquid.volume".to_owned()
    })?;
    within(
        &limits::SMALLEST_GAP,
        liquid.law.viscous_gap.share(),
        || "liquid.law.viscous_gap".to_owned(),
    )
}

fn check_law(law: ContactLaw) -> Checked {
    law.told(|law| law.mistake()).map_or(Ok(()), |mistake| {
        Err(Problem::value(
            format!("law.{}", mistake.key),
            format!("{:?}", mistake.value),
            mistake.expected,
        ))
    })
}
