//! The run that the window opens with: the dry drum, about a second before its first avalanche.
//!
//! In: nothing. Out: a session that is shipped with the program, saved by a run that began at time
//! zero of a built-in scene, so that its time, its curves and `grainfall verify` are those of any
//! session. `grainfall opening --out FILE` makes it; one of another version or method is none.

use super::bed::BedStore;
use super::method::method;
use super::preparation::{Preparation, Prepared};
use super::session::Session;
use super::timeline::Timeline;
use crate::scene::{Scene, SceneError};
use crate::solver::{Fault, advise};

/// Name of the scene.
pub const OPENING_SCENE: &str = "dry-r3";
/// The moment that is shown [s].
const MOMENT: f64 = 9.0;

static SHIPPED: &[u8] = include_bytes!("../../assets/opening.grainfall");

/// Why there is no opening.
#[derive(Debug, thiserror::Error)]
pub enum OpeningError {
    /// There is no such scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The run met an absurd state.
    #[error("the run stopped: {0}")]
    Fault(#[from] Fault),
}

/// The session that the window opens with; none where it was made by another version. In the place
/// of a look it states the method that computed it: a test tells when it has to be made anew.
pub fn opening() -> Option<Session> {
    Session::of_bytes(SHIPPED).ok()
}

/// The same session, computed anew on so many `threads`.
///
/// # Errors
/// An [`OpeningError`] where the scene cannot be read or run.
pub fn make_opening(threads: usize) -> Result<Session, OpeningError> {
    let scene = Scene::open(OPENING_SCENE)?;
    let step = advise(&scene).time_step;
    let mut preparation = Preparation::new(scene.into(), step, threads, BedStore::shipped());
    let mut run = loop {
        if let Prepared::Ready(run) = preparation.advance()? {
            break *run;
        }
    };
    run.follow_orientations();
    let end = run.world().clock.step_at(MOMENT);
    run.advance_to(end)?;
    let session = Session::of(OPENING_SCENE, &Timeline::new(run, 0));
    Ok(session.looking(format!("method {}", method())))
}
