//! Runs as panels, views and scripts see them: one, or two side by side, moved on by a driver.
//!
//! In: a scene, then commands and ticks of wall-clock time. Out: the newest state, the samples so far, what the run is
//! doing. How the work is cut into pieces, and on which thread it is done, does not show in a trajectory.
//!
//! | file | holds |
//! |---|---|
//! | `engine`, `driver` | who moves a run on, in short pieces, inline or on a thread |
//! | `twin` | a second run beside the first, in step with it |
//! | `front` | what the outside sees |

mod driver;
mod engine;
mod front;
mod twin;

pub use engine::SavedFile;
pub use front::{DriverKind, Options, SMALLEST_DROP, Simulation, Status};
pub use twin::{Half, Twin};
