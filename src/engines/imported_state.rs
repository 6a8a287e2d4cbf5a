//! A frame as a state of a scene: what can be measured and drawn of what another engine computed.
//!
//! In: the world that the scene begins with, and a frame. Out: a [`World`] at the frame's time that
//! has passed the same checks as states from any other file. Which grains touch follows from where
//! they are; what their contacts remember and the forces in them is not in a frame, and is NaN.

use super::atom_frame::{Atom, AtomFrame};
use super::atom_types::GrainType;
use crate::measure::{Measure, Sample};
use crate::solver::Solver;
use crate::world::{Clock, Grains, Ledger, Polyhedra, World};
use glam::DVec3;

/// What a sample of an imported state has no value of: it takes forces, or what contacts remember.
const UNKNOWN: [Measure; 12] = [
    Measure::Bridges,
    Measure::Ruptures,
    Measure::ViscousLoss,
    Measure::CapillaryLoss,
    Measure::ElasticEnergy,
    Measure::WallWork,
    Measure::DashpotLoss,
    Measure::SlidingLoss,
    Measure::RollingLoss,
    Measure::EnergyResidual,
    Measure::DrumTorque,
    Measure::FloorForce,
];

/// Most that the stated radius of a body may differ from its shape's, relative to it.
const SAME_RADIUS: f64 = 1e-6;

/// Makes states of frames.
pub struct StateBuilder {
    /// The scene's world at time zero: materials, walls, gravity, law.
    template: World,
    /// Types of grain, the first being 1.
    types: Vec<GrainType>,
    solver: Solver,
    /// The energy that work is counted from, that of the first state.
    ledger: Option<Ledger>,
}

impl StateBuilder {
    /// For frames of the scene that begins with `template`, whose grains are of these `types`.
    pub fn new(template: World, types: Vec<GrainType>) -> Self {
        Self {
            template,
            types,
            solver: Solver::new(1),
            ledger: None,
        }
    }

    /// The state that `frame` states, `time` [s] after the start.
    ///
    /// # Errors
    /// Why no run of the scene comes to it, for people.
    pub fn state(&mut self, frame: &AtomFrame, time_step: f64) -> Result<World, String> {
        let mut world = World {
            clock: Clock::new(time_step),
            contacts: Vec::new(),
            ..self.template.clone()
        };
        match &mut world.polyhedra {
            Some(polyhedra) => place_bodies(frame, &mut world.grains, polyhedra)?,
            None => world.grains = self.grains(frame)?,
        }
        if let Some(volume) = world.liquid.map(|liquid| liquid.volume) {
            // From none, it is spread over the grains that there are.
            world.set_liquid_volume(0.0);
            world.set_liquid_volume(volume);
        }
        world.check().map_err(|error| error.to_string())?;
        self.solver
            .evaluate(&mut world)
            .map_err(|fault| fault.to_string())?;
        world.restart_clock(0.0);
        world.ledger = *self.ledger.get_or_insert(world.ledger);
        world.clock.step = frame.step;
        let time = world.time();
        world.container.carry(time);
        forget_forces(&mut world, frame);
        Ok(world)
    }

    fn grains(&self, frame: &AtomFrame) -> Result<Grains, String> {
        let mut grains = Grains::default();
        if frame.atoms.iter().any(|atom| atom.orientation.is_some()) {
            return Err("its grains are polyhedra; the scene's are spheres".to_owned());
        }
        for atom in &frame.atoms {
            let kind = (atom.kind as usize)
                .checked_sub(1)
                .and_then(|index| self.types.get(index));
            let kind = kind.ok_or_else(|| {
                format!(
                    "grain {} is of type {}; the scene's grains have types 1 to {}",
                    atom.id,
                    atom.kind,
                    self.types.len()
                )
            })?;
            let of_material = self.template.materials.get(kind.material).density;
            let density = atom.density.unwrap_or(of_material);
            grains.push_sphere(atom.position, atom.radius, density, kind.species);
        }
        let moving = |value: fn(&Atom) -> DVec3| frame.atoms.iter().map(value).collect();
        grains.velocity.set(moving(|atom| atom.velocity));
        grains.spin.set(moving(|atom| atom.spin));
        Ok(grains)
    }
}

/// Puts the bodies that there are at time zero where `frame` has them.
fn place_bodies(
    frame: &AtomFrame,
    grains: &mut Grains,
    polyhedra: &mut Polyhedra,
) -> Result<(), String> {
    if frame.atoms.len() != grains.len() {
        let (stated, known) = (frame.atoms.len(), grains.len());
        return Err(format!("{stated} bodies; the scene has {known} grains"));
    }
    for (i, atom) in frame.atoms.iter().enumerate() {
        let id = atom.id;
        if id != i as u64 + 1 {
            let last = grains.len() - 1;
            return Err(format!(
                "there is no body {i}; expected each from 0 to {last}"
            ));
        }
        let turn = atom.orientation.ok_or_else(|| {
            format!("grain {id} has no orientation: files of spheres belong to a scene of spheres")
        })?;
        let (stated, known) = (atom.radius, grains.radius[i]);
        if (stated / known - 1.0).abs() > SAME_RADIUS {
            return Err(format!(
                "the farthest point of grain {id} is {stated:e} m from its centroid, in the scene {known:e} m: is it \
                 the scene, and its seed, that was run, by an exaDEM that tells as many shapes apart?"
            ));
        }
        grains.position[i] = atom.position;
        grains.velocity[i] = atom.velocity;
        grains.spin[i] = atom.spin;
        polyhedra.orientation[i] = turn;
        polyhedra.set_spin(i, atom.spin);
    }
    Ok(())
}

/// What the frame does not state is no number: forces of contacts, and those of grains where the
/// engine did not write them. It adds the weight to them.
fn forget_forces(world: &mut World, frame: &AtomFrame) {
    world.contacts.retain(|contact| contact.touching);
    for contact in &mut world.contacts {
        contact.force = DVec3::NAN;
        contact.spring = DVec3::NAN;
        contact.rolling = DVec3::NAN;
        contact.bridge = None;
    }
    for feature in (world.polyhedra.iter_mut()).flat_map(|all| &mut all.features) {
        feature.spring = DVec3::NAN;
        feature.normal_memory = f64::NAN;
    }
    let (gravity, grains) = (world.gravity, &mut world.grains);
    for (i, atom) in frame.atoms.iter().enumerate() {
        let weight = grains.mass[i] * gravity;
        grains.force[i] = atom.force.map_or(DVec3::NAN, |force| force - weight);
    }
    grains.torque.fill(DVec3::NAN);
    grains.rolling_torque.fill(DVec3::NAN);
    grains.open_bridges.fill(0);
}

/// `sample` without what an imported state has no value of.
pub fn without_unknown(mut sample: Sample) -> Sample {
    for measure in UNKNOWN {
        sample.values[measure as usize] = f64::NAN;
    }
    sample
}
