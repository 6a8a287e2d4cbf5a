//! What makes the solver stop.

use serde::Serialize;

/// A state that no physics explains: the step was too long, or the input absurd.
#[derive(Clone, Debug, PartialEq, Serialize, thiserror::Error)]
#[error(
    "grain {grain} at t = {time:.6} s: {kind}; the last good state, t = {good_time:.6} s, is kept. Try a smaller time step"
)]
pub struct Fault {
    /// Which grain.
    pub grain: usize,
    /// When [s].
    pub time: f64,
    /// Simulated time of the state that is kept [s].
    pub good_time: f64,
    /// What is wrong.
    pub kind: FaultKind,
}

/// What is wrong with a grain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, thiserror::Error)]
pub enum FaultKind {
    /// Some number is infinite or not a number.
    #[error("its {0} is not finite")]
    NotFinite(&'static str),
    /// It moves further in one step than a tenth of its radius.
    #[error("its speed of {0:.4e} m/s moves it by more than a tenth of its radius in one step")]
    TooFast(f64),
    /// Its centre went through a wall.
    #[error("its centre is {0:.4e} m behind a wall")]
    BehindWall(f64),
    /// A polyhedron moves further in one step than a quarter of its rounding radius.
    #[error(
        "a speed of {0:.4e} m/s at its surface moves it by more than a quarter of its rounding radius in one step"
    )]
    TooFastForRounding(f64),
    /// Two rounded polyhedra are pressed so deep that their cores nearly touch.
    #[error(
        "it overlaps its partner by {} % of the sum of their rounding radii, so that their cores nearly touch; a stiffer \
         contact or a larger rounding radius helps", (100.0 * .0).round()
    )]
    TooDeep(f64),
}
