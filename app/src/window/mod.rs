//! The window: Bevy's app with simulation, view and panels.
//!
//! In: a scene and how to run it. Out: the laboratory, until somebody closes it, or a picture of it
//! at a given simulated time, with a window or without a display. What is missing for either is
//! said before anything opens.
//!
//! | file | holds |
//! |---|---|
//! | `headless_film` | a film of a run or of a recording, without a window |
//! | `film_studio` | takes its pictures |
//! | `app` | Bevy's app, built and run |
//! | `screenshot_job`, `screenshot_subject` | takes pictures and films; what they are of |
//! | `film_reel` | the pictures of a film in the window |
//! | `seen` | how pictures are seen in the window |
//! | `second_set` | the image and the cameras of a picture off screen |
//! | `opening_comparison` | the second run that a window opens with |
//! | `window_job` | what to open and how; why there may be no window |
//! | `canvas` | an image to draw into where there is no display |
//! | `pipelines` | what the renderer draws with, and has still to make |
//! | `environment` | what a window needs of the machine |
//! | `memory_log` | where its memory goes, in the log |
//! | `one_by_one` | systems of a frame one after the other |

mod app;
pub mod canvas;
pub mod environment;
mod film_reel;
mod film_studio;
mod headless_film;
mod memory_log;
pub mod one_by_one;
mod opening_comparison;
pub mod pipelines;
mod screenshot_job;
mod screenshot_subject;
mod second_set;
mod seen;
mod window_job;

pub use app::run;
pub use headless_film::{film_recording, film_run};
pub use screenshot_job::ScreenshotPlugin;
pub use window_job::{FilmJob, Opened, PictureJob, WindowError, WindowJob};
