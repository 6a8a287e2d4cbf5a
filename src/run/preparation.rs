//! From a scene to a run at time zero: build, then a kept bed or settling.
//!
//! In: a scene, its time step, where beds are kept. Out: a [`Run`]. Voronoi cells are cut to size
//! instead. The work comes in short pieces, so that whoever does it can show progress and stop.

use super::bed::{BedKey, BedStore};
use super::settling::{Settling, needs_settling, settling_step};
use super::{Run, bed};
use crate::measure::elastic_energy;
use crate::scene::Scene;
use crate::solver::{Fault, Solver};
use crate::world::{self, Packing, World};
use std::sync::Arc;

/// A run that is being prepared.
pub struct Preparation {
    scene: Arc<Scene>,
    time_step: f64,
    threads: usize,
    beds: BedStore,
    stage: PreparationStage,
    warnings: Vec<String>,
}

enum PreparationStage {
    Placing,
    Packing(Box<Packing>),
    Settling {
        /// None where the bed cannot be told from others, and is not kept.
        key: Option<BedKey>,
        settling: Box<Settling>,
    },
}

/// What a piece of preparation led to.
pub enum Prepared {
    /// There is more to do.
    NotYet,
    /// The run stands at time zero.
    Ready(Box<Run>),
}

impl Preparation {
    /// Prepares `scene` for steps of `time_step` [s] on `threads` threads.
    pub fn new(scene: Arc<Scene>, time_step: f64, threads: usize, beds: BedStore) -> Self {
        Self {
            scene,
            time_step,
            threads,
            beds,
            stage: PreparationStage::Placing,
            warnings: Vec::new(),
        }
    }

    /// Does the next short piece.
    ///
    /// # Errors
    /// The solver's [`Fault`] while the grains settle.
    pub fn advance(&mut self) -> Result<Prepared, Fault> {
        let done = match &mut self.stage {
            PreparationStage::Placing => return Ok(self.place()),
            PreparationStage::Packing(packing) => packing.advance(),
            PreparationStage::Settling { settling, .. } => settling.advance()?,
        };
        Ok(if done {
            self.finish()
        } else {
            Prepared::NotYet
        })
    }

    /// What is being done, for people.
    pub fn name(&self) -> &'static str {
        match self.stage {
            PreparationStage::Placing => "placing the grains",
            PreparationStage::Packing(_) => "cutting the grains",
            PreparationStage::Settling { .. } => "settling the bed",
        }
    }

    /// How far it has come, 0 … 1.
    pub fn progress(&self) -> f32 {
        match &self.stage {
            PreparationStage::Placing => 0.0,
            PreparationStage::Packing(packing) => packing.progress(),
            PreparationStage::Settling { settling, .. } => settling.progress(),
        }
    }

    /// The bed on its way to rest, while it settles.
    pub fn settling(&self) -> Option<&World> {
        match &self.stage {
            PreparationStage::Settling { settling, .. } => Some(settling.world()),
            PreparationStage::Placing | PreparationStage::Packing(_) => None,
        }
    }

    /// What people should know, in sentences.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn place(&mut self) -> Prepared {
        if let Some(packing) = Packing::new(&self.scene) {
            self.stage = PreparationStage::Packing(Box::new(packing));
            return Prepared::NotYet;
        }
        let built = world::build(&self.scene, self.time_step);
        if !needs_settling(&self.scene) {
            return self.ready(with_forces(built, self.threads));
        }
        let step = settling_step(&self.scene);
        let key = match BedKey::of(&built, step) {
            Ok(key) => Some(key),
            Err(error) => {
                let warning = format!("the settled bed is neither looked for nor kept: {error}");
                self.warnings.push(warning);
                None
            }
        };
        if let Some(settled) = key.and_then(|key| self.beds.find(key, &built)) {
            return self.ready(settled);
        }
        let settling = Box::new(Settling::new(built, step, self.threads));
        self.stage = PreparationStage::Settling { key, settling };
        Prepared::NotYet
    }

    fn finish(&mut self) -> Prepared {
        match std::mem::replace(&mut self.stage, PreparationStage::Placing) {
            PreparationStage::Placing => Prepared::NotYet,
            PreparationStage::Packing(packing) => {
                let built = world::build_packed(&self.scene, self.time_step, packing.finish());
                self.ready(with_forces(built, self.threads))
            }
            PreparationStage::Settling { key, settling } => {
                let settled = settling.finish();
                let kept = key.map_or(Ok(()), |key| self.beds.keep(key, &settled));
                self.warnings.extend(kept.err());
                self.ready(settled)
            }
        }
    }

    fn ready(&self, bed: World) -> Prepared {
        Prepared::Ready(Box::new(Run::new(self.scene.clone(), bed, self.threads)))
    }
}

/// `world` with the contacts and forces of grains that touch from the start, their elastic energy
/// in the ledger. Where its state is a fault, it stays as it was built: the run's first step meets
/// the fault again and says so.
fn with_forces(mut world: World, threads: usize) -> World {
    if Solver::new(threads).evaluate(&mut world).is_ok() {
        let elastic = elastic_energy(&world);
        world.restart_clock(elastic);
    }
    world
}

/// Why a bed cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum BedError {
    /// The grains met an absurd state on their way to rest.
    #[error("the bed cannot settle: {0}")]
    Unsettled(#[from] Fault),
    /// The bed cannot be written as bytes.
    #[error("the bed cannot be stored: {0}")]
    Unstored(#[from] postcard::Error),
}

/// The file of the settled bed of `scene`, made anew: what `assets/beds` holds.
///
/// # Errors
/// A [`BedError`] that says what kept it from resting or from being stored.
pub fn make_bed(scene: &Scene, threads: usize) -> Result<Vec<u8>, BedError> {
    let step = settling_step(scene);
    let built = world::build(scene, step);
    let key = BedKey::of(&built, step)?;
    let mut settling = Settling::new(built, step, threads);
    while !settling.advance()? {}
    Ok(bed::encode(key, &settling.finish())?)
}
