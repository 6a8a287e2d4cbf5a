//! Fillings of spheres, and the species of any filling: numbers, shares, room.

use super::values::{Checked, check_name, check_number, twice, within};
use crate::geometry::spheres_volume;
use crate::physics::limits;
use crate::scene::Scene;
use crate::scene::container::{SceneContainer, volume};
use crate::scene::error::Problem;
use crate::scene::grains::SceneSpecies;
use crate::scene::lattice::Lattice;
use crate::scene::size_classes::size_classes;

impl Scene {
    pub(super) fn check_filling(&self, count: usize, species: &[SceneSpecies]) -> Checked {
        self.check_species()?;
        for (index, kind) in species.iter().enumerate() {
            within(&limits::RADIUS, kind.radius, || {
                format!("grains.species[{index}].radius")
            })?;
        }
        check_count(count)?;
        self.check_room(count, species)
    }

    /// Names, materials and shares of the species of a filling.
    pub(super) fn check_species(&self) -> Checked {
        let species = self.species();
        check_number("grains.species", "species", species.len())?;
        for (index, (name, material)) in species.iter().enumerate() {
            let path = |key: &str| format!("grains.species[{index}].{key}");
            check_name(name, || path("name"))?;
            if species[..index].iter().any(|other| other.0 == *name) {
                return Err(twice(path("name"), "a species", name)
                    .advise("Species of one material need a `name` each"));
            }
            within(&limits::SHARE, self.share(index), || path("share"))?;
            self.check_material(material, || path("material"))?;
        }
        let sum = (0..species.len()).map(|index| self.share(index)).sum();
        check_shares(sum)
    }

    fn check_room(&self, count: usize, species: &[SceneSpecies]) -> Checked {
        let room = volume(&self.container)?;
        self.check_widths(species)?;
        let classes = size_classes(count, species);
        if Lattice::for_filling(&self.container, &classes).is_some() {
            return Ok(());
        }
        let solid: f64 = classes
            .iter()
            .map(|class| spheres_volume(class.count as f64, class.radius))
            .sum();
        let part = solid / room;
        Err(Problem::new(
            "grains",
            format!("do not fit into the container: {count} grains are {part:.3} of its volume, before they settle"),
            "a filling that leaves the grains room to be placed apart, about 0.4 of the volume or less",
        )
        .advise(match self.container {
            SceneContainer::Mesh { .. } => {
                "Take fewer or smaller grains or a larger mesh; where it is far larger than its grains, or of very many triangles, state \
                 the `room` that they fill"
            }
            _ => "Take fewer or smaller grains or a larger container",
        }))
    }

    fn check_widths(&self, species: &[SceneSpecies]) -> Checked {
        let largest = 0.5 * narrowest(&self.container);
        let wide = species.iter().position(|kind| kind.radius > largest);
        wide.map_or(Ok(()), |index| {
            Err(Problem::value(
                format!("grains.species[{index}].radius"),
                format!("{} m", species[index].radius),
                format!("at most {largest} m, half of the container's narrowest width"),
            ))
        })
    }
}

fn check_shares(sum: f64) -> Checked {
    if (sum - 1.0).abs() <= 1e-6 {
        return Ok(());
    }
    Err(Problem::new(
        "grains.species",
        format!("has shares that add up to {sum}"),
        "shares that add up to 1",
    ))
}

pub(super) fn check_count(count: usize) -> Checked {
    if limits::GRAINS.accept(count as f64) {
        return Ok(());
    }
    Err(Problem::new(
        "grains",
        format!("are {count} in number"),
        limits::GRAINS.expected,
    ))
}

/// Width of the widest grain that the container takes [m].
fn narrowest(container: &SceneContainer) -> f64 {
    match container {
        SceneContainer::Drum { radius, width, .. } => width.min(2.0 * radius),
        SceneContainer::Box { min, max, .. } => (*max - *min).min_element(),
        SceneContainer::Mesh { surface, room, .. } => {
            let (min, max) = room.unwrap_or_else(|| surface.bounds());
            (max - min).min_element()
        }
        SceneContainer::Nothing | SceneContainer::Column { .. } | SceneContainer::Planes(_) => {
            f64::INFINITY
        }
    }
}
