//! The moments at which scenes open in a window: shortly before what they promise.
//!
//! In: a scene's name. Out: a session that is shipped with the program, saved by a run that began
//! at time zero of a built-in scene, so that its time, its curves and `grainfall verify` are those
//! of any session. `grainfall opening --out assets/openings` makes them; one of another version,
//! method or scene is none, and the scene opens at time zero. Runs without a window, sweeps and
//! lessons begin at time zero always.

use super::bed::BedStore;
use super::method::method;
use super::preparation::{Preparation, Prepared};
use super::session::{SESSION_EXTENSION, Session};
use super::timeline::Timeline;
use crate::scene::{Scene, SceneError, built_in_called};
use crate::solver::{Fault, advise};
use std::path::Path;

/// A moment at which a built-in scene opens.
#[derive(Debug)]
pub struct Opening {
    /// The scene's name.
    pub scene: &'static str,
    /// The moment that is shown [s].
    pub moment: f64,
    /// The session's file.
    file: &'static [u8],
}

macro_rules! openings {
    ($($moment:literal of $scene:literal),+ $(,)?) => {
        &[$(Opening {
            scene: $scene,
            moment: $moment,
            file: include_bytes!(concat!("../../assets/openings/", $scene, ".grainfall")),
        }),+]
    };
}

/// All of them, that which takes longest to compute first. A new one begins as an empty file.
static OPENINGS: &[Opening] = openings![
    10.6 of "dry-r2",
    12.5 of "wet",
    11.0 of "honey-drum",
    9.4 of "two-frictions-drum",
    9.0 of "dry-r3",
    7.8 of "water-drum",
    2.6 of "two-sizes-wet-drum",
    2.6 of "two-sizes-drum",
];

/// Why an opening cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum OpeningError {
    /// There is no such scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The run met an absurd state.
    #[error("the run stopped: {0}")]
    Fault(#[from] Fault),
}

/// Every moment that is shipped, that which takes longest to compute first.
pub fn openings() -> &'static [Opening] {
    OPENINGS
}

/// The session with which the scene that a person calls `name` opens in a window; none where it
/// begins at time zero.
pub fn opening(name: &str) -> Option<Session> {
    let scene = built_in_called(name)?;
    let opening = openings().iter().find(|own| own.scene == scene.name)?;
    opening.session()
}

impl Opening {
    /// The session that is shipped, where this program would compute the same.
    pub fn session(&self) -> Option<Session> {
        let session = Session::of_bytes(self.file).ok()?;
        self.is_up_to_date(&session).then_some(session)
    }

    /// Whether `session` is what this program makes.
    fn is_up_to_date(&self, session: &Session) -> bool {
        let scene = Scene::open(self.scene);
        session.look() == made_by(&session.record().scene)
            && session.record().name == self.scene
            && (session.record().time - self.moment).abs() < 1e-3
            && scene.is_ok_and(|scene| session.record().scene == scene)
    }

    /// Whether the file in `folder` is what this program makes.
    pub fn is_made_in(&self, folder: &Path) -> bool {
        let session = Session::read(&folder.join(self.file_name()));
        session.is_ok_and(|session| self.is_up_to_date(&session))
    }

    /// Name of its file.
    pub fn file_name(&self) -> String {
        format!("{}.{SESSION_EXTENSION}", self.scene)
    }

    /// The session, computed anew on so many `threads`.
    ///
    /// # Errors
    /// An [`OpeningError`] where the scene cannot be read or run.
    pub fn make(&self, threads: usize) -> Result<Session, OpeningError> {
        let scene = Scene::open(self.scene)?;
        let step = advise(&scene).time_step;
        let beds = BedStore::shipped();
        let mut preparation = Preparation::new(scene.into(), step, threads, beds);
        let mut run = loop {
            if let Prepared::Ready(run) = preparation.advance()? {
                break *run;
            }
        };
        run.follow_orientations();
        let end = run.world().clock.step_at(self.moment);
        run.advance_to(end)?;
        let session = Session::of(self.scene, &Timeline::new(run, 0));
        let made_by = made_by(&session.record().scene);
        Ok(session.looking(made_by))
    }
}

/// What stands in the place of a look: the method that computed it, by which it is known to be
/// that of this program.
fn made_by(scene: &Scene) -> String {
    format!("method {}", method(scene))
}
