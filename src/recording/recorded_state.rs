//! A state out of the files of one instant.
//!
//! In: a world without grains, `grains_….vtp` and, where there is one, `contacts_….vtp`. Out: the
//! world with them, which has passed the same check as states from any other file. Forces of
//! contacts are whole; their terms, springs and torques are not in the files, and are NaN.

use super::RecordingError;
use super::vtk_arrays::VtkArrays;
use crate::physics::limits;
use crate::world::{
    Bridge, Contact, Grains, Partner, PlacedPolyhedron, Polyhedra, Polyhedron, SpeciesId, World,
};
use glam::{DMat3, DQuat, DVec3};
use std::sync::Arc;

/// Arrays of the grains' file.
pub const OF_GRAINS: [&str; 9] = [
    "Points",
    "id",
    "shapetype",
    "radius",
    "v",
    "omega",
    "f",
    "film",
    "tensor",
];
/// Arrays of the contacts' file.
pub const OF_CONTACTS: [&str; 6] = [
    "id1",
    "id2",
    "force_normal",
    "force_tangential",
    "overlap",
    "bridge_volume",
];
const POINT: &str = "PointData";
const CELL: &str = "CellData";

/// The state of `grains` and `contacts` in `course`, a world without any; polyhedra look like
/// `shapes`.
///
/// # Errors
/// When the files do not fit together, or hold a state to which no run comes.
pub fn recorded_state(
    course: World,
    grains: &VtkArrays,
    contacts: Option<&VtkArrays>,
    shapes: Option<&Arc<[Polyhedron]>>,
) -> Result<World, RecordingError> {
    let mut world = course;
    let polyhedral = world.polyhedra.is_some();
    match shapes.filter(|_| polyhedral) {
        Some(shapes) => place_polyhedra(&mut world, grains, shapes)?,
        None if polyhedral => {
            return Err(grains.refuse("is of polyhedra, and their shapes are missing"));
        }
        None => place_spheres(&mut world, grains)?,
    }
    let count = world.grains.len();
    if world.wetting().is_some() && grains.has(POINT, "film") {
        let films = grains.numbers(POINT, "film", 1, Some(count))?;
        world.grains.film.set(films.to_vec());
    }
    let lines = contacts.map_or_else(|| Ok(Vec::new()), lines)?;
    let refuse = |error: crate::world::Unsound| grains.refuse(error.to_string());
    world.contacts = lines.iter().map(|line| line.contact.clone()).collect();
    world.check().map_err(refuse)?;
    set_forces(&mut world, grains, &lines)?;
    Ok(world)
}

/// What the file says of the grains: their number, places and kinds.
struct Placed<'a> {
    places: Vec<DVec3>,
    species: &'a [f64],
}

impl<'a> Placed<'a> {
    fn of(file: &'a VtkArrays) -> Result<Self, RecordingError> {
        let count = file.count("NumberOfPoints")?;
        if !limits::GRAINS.accept(count as f64) {
            let expected = limits::GRAINS.expected;
            return Err(file.refuse(format!("has {count} grains; expected {expected}")));
        }
        let ids = file.numbers(POINT, "id", 1, Some(count))?;
        if ids
            .iter()
            .enumerate()
            .any(|(index, id)| *id != index as f64)
        {
            return Err(file.refuse("does not have its grains in the order of their numbers"));
        }
        Ok(Self {
            places: file.vectors("Points", "Points", count)?,
            species: file.numbers(POINT, "shapetype", 1, Some(count))?,
        })
    }

    /// The species of each grain and its density [kg/m³].
    fn kinds(
        &self,
        world: &World,
        file: &VtkArrays,
    ) -> Result<Vec<(SpeciesId, f64)>, RecordingError> {
        let kind = |(grain, number): (usize, &f64)| {
            let species = world
                .species
                .get(*number as usize)
                .filter(|_| *number >= 0.0);
            let species = species.ok_or_else(|| {
                let count = world.species.len();
                file.refuse(format!(
                    "has grain {grain} of species {number}, of {count} in the scene"
                ))
            })?;
            let density = world.materials.get(species.material).density;
            Ok((SpeciesId(*number as u16), density))
        };
        self.species.iter().enumerate().map(kind).collect()
    }
}

fn place_spheres(world: &mut World, file: &VtkArrays) -> Result<(), RecordingError> {
    let placed = Placed::of(file)?;
    let count = placed.places.len();
    let radii = file.numbers(POINT, "radius", 1, Some(count))?;
    let kinds = placed.kinds(world, file)?;
    let grains = &mut world.grains;
    for ((place, radius), (species, density)) in placed.places.iter().zip(radii).zip(kinds) {
        grains.push_sphere(*place, *radius, density, species);
    }
    grains.velocity.set(file.vectors(POINT, "v", count)?);
    grains.spin.set(file.vectors(POINT, "omega", count)?);
    Ok(())
}

fn place_polyhedra(
    world: &mut World,
    file: &VtkArrays,
    shapes: &Arc<[Polyhedron]>,
) -> Result<(), RecordingError> {
    let placed = Placed::of(file)?;
    let count = placed.places.len();
    if count != shapes.len() {
        let shapes = shapes.len();
        return Err(file.refuse(format!("has {count} grains, and there are {shapes} shapes")));
    }
    let kinds = placed.kinds(world, file)?;
    let (velocity, spin) = (
        file.vectors(POINT, "v", count)?,
        file.vectors(POINT, "omega", count)?,
    );
    let (axes, _) = file
        .numbers(POINT, "tensor", 9, Some(count))?
        .as_chunks::<9>();
    let mut grains = Grains::default();
    let mut polyhedra = Polyhedra {
        integrator: world.integrator(),
        ..Polyhedra::new(shapes.clone())
    };
    for (i, (species, density)) in kinds.into_iter().enumerate() {
        let body = PlacedPolyhedron {
            shape: i as u32,
            position: placed.places[i],
            orientation: DQuat::from_mat3(&DMat3::from_cols_array(&axes[i])).normalize(),
            velocity: velocity[i],
            spin: spin[i],
            density,
            species,
        };
        polyhedra.push(&mut grains, &body);
    }
    world.grains = grains;
    world.polyhedra = Some(Box::new(polyhedra));
    Ok(())
}

/// A contact without forces, and its force [N].
struct Line {
    contact: Contact,
    force: DVec3,
}

/// The contacts in `file`.
fn lines(file: &VtkArrays) -> Result<Vec<Line>, RecordingError> {
    let count = file.count("NumberOfLines")?;
    let numbers = |name| file.numbers(CELL, name, 1, Some(count));
    let (first, second, overlaps) = (numbers("id1")?, numbers("id2")?, numbers("overlap")?);
    let (along, across) = (
        file.vectors(CELL, "force_normal", count)?,
        file.vectors(CELL, "force_tangential", count)?,
    );
    let volumes = if file.has(CELL, "bridge_volume") {
        Some(numbers("bridge_volume")?)
    } else {
        None
    };
    let line = |k: usize| {
        let volume = volumes.map_or(0.0, |volumes| volumes[k]);
        let partner = match second[k] {
            grain if grain >= 0.0 => Partner::Grain(grain as u32),
            wall => Partner::Wall((-1.0 - wall) as u32),
        };
        Line {
            contact: Contact {
                grain: first[k] as u32,
                partner,
                spring: DVec3::ZERO,
                stiffness: 0.0,
                rolling: DVec3::ZERO,
                force: DVec3::ZERO,
                // What neither touches nor is held by a bridge is not in the file.
                touching: overlaps[k] > 0.0 || volume <= 0.0,
                bridge: (volume > 0.0).then(|| Box::new(bridge(volume))),
            },
            force: along[k] + across[k],
        }
    };
    Ok((0..count).map(line).collect())
}

fn bridge(volume: f64) -> Bridge {
    Bridge {
        volume,
        transfer: 0.0,
        capillary: 0.0,
        viscous: 0.0,
        drag: DVec3::ZERO,
    }
}

/// Sets what is known of the forces, and the rest to NaN.
fn set_forces(world: &mut World, file: &VtkArrays, lines: &[Line]) -> Result<(), RecordingError> {
    let known = |force: DVec3| if force.is_finite() { force } else { DVec3::NAN };
    for (contact, line) in world.contacts.iter_mut().zip(lines) {
        contact.force = known(line.force);
        (contact.spring, contact.rolling) = (DVec3::NAN, DVec3::NAN);
        contact.stiffness = f64::NAN;
        if let Some(bridge) = &mut contact.bridge {
            (bridge.capillary, bridge.viscous) = (f64::NAN, f64::NAN);
            bridge.drag = DVec3::NAN;
        }
        let grains = [Some(contact.grain), other(contact.partner)];
        for grain in grains.into_iter().flatten() {
            let grain = grain as usize;
            world.grains.contact_count[grain] += u32::from(contact.touching);
            let is_open = !contact.touching && contact.bridge.is_some();
            world.grains.open_bridges[grain] += u32::from(is_open);
        }
    }
    let count = world.grains.len();
    let forces = file.vectors(POINT, "f", count)?;
    world
        .grains
        .force
        .set(forces.into_iter().map(known).collect());
    world.grains.torque.fill(DVec3::NAN);
    world.grains.rolling_torque.fill(DVec3::NAN);
    Ok(())
}

fn other(partner: Partner) -> Option<u32> {
    match partner {
        Partner::Grain(other) => Some(other),
        Partner::Wall(_) => None,
    }
}
