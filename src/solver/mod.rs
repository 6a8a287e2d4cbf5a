//! How the state advances.
//!
//! In: a [`World`]. Out: the same world some steps later, or a [`Fault`] and the world as it was. The solver keeps only
//! caches of its own (neighbour list, lane buffers), so a world that was restored or changed from outside simply goes on.

mod fault;
mod profile;
mod time_step;

pub use fault::{Fault, FaultKind};
pub use profile::{Profile, Stage};
pub use time_step::{Limit, TimeStepAdvice, advise};

use crate::world::World;

/// Advances worlds.
pub struct Solver {
    profile: Profile,
}

impl Solver {
    /// A solver that works on `threads` threads (at least one).
    pub fn new(_threads: usize) -> Self {
        Self {
            profile: Profile::default(),
        }
    }

    /// Takes `steps` steps.
    ///
    /// # Errors
    /// A [`Fault`] when a grain's state becomes absurd; `world` is then as it was before the call.
    pub fn advance(&mut self, _world: &mut World, _steps: u64) -> Result<(), Fault> {
        unimplemented!("solver")
    }

    /// Where the time went since the last call of [`Solver::take_profile`].
    pub fn take_profile(&mut self) -> Profile {
        std::mem::take(&mut self.profile)
    }
}
