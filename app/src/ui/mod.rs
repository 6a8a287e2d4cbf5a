//! The egui panels round the picture.
//!
//! In: the [`Simulation`](crate::simulation::Simulation), read only, and the
//! [`ViewSettings`](crate::view::ViewSettings). Out: [`Request`]s, fulfilled in one place
//! (`dispatch`), and what is left free for the picture. A panel is one file, one struct and one
//! function `ui`; it needs neither Bevy nor a GPU, and every control has an accessible label.
//!
//! Each row of the table uses only rows below it; a test holds the files to that.
//!
//! | file or folder | holds |
//! |---|---|
//! | `plugin` | when panels are drawn, as systems of Bevy |
//! | `second_pass` | panels and marks of a second picture, off screen |
//! | `captions` | what stands in the picture |
//! | `rescue` | work that is in no file, kept for the case that the program ends unasked |
//! | `dispatch` | what each request does |
//! | `opener` | scenes, lessons, sessions and recordings in the place of what is shown |
//! | `session_look` | how a window looked, as a session keeps it |
//! | `dock_dialogs` | what the dock asks and tells over everything else |
//! | `dock` | what stands round the picture and lies over it |
//! | `register` | every panel in its place |
//! | `sides`, `sections` | both sides of panels; one side of them |
//! | `notice` | what is told for a few seconds |
//! | `dialogs` | windows over the rest: scenes with their pictures, a path to choose, sheets of text |
//! | `bars` | menu bar, the bar under the picture with its time slider, the film's bar, the badge of trust |
//! | `shortcuts`, `keyboard`, `pointer` | what each key does; what was held with it; where the pointer lets go |
//! | `user_memory` | what is remembered from start to start |
//! | `panels` | the panels on both sides, one in each file |
//! | `panel` | what a panel is |
//! | `sweep_desk` | the parameter sweep that runs in the background |
//! | `plots` | curves of samples: axes, the part of the run in view, all runs on one plot |
//! | `playback` | what can be asked of the run now: play, steps, leaps, the next avalanche |
//! | `repeat` | the part of a run that is played again and again |
//! | `capture_choice` | what somebody chose of pictures and films the last time |
//! | `request`, `screenshot_orders` | what panels ask for; pictures and films that are asked for |
//! | `plot_export` | a plot on its way to a file |
//! | `arrangement` | where panels stand, by their titles; how wide sides may be |
//! | `detail`, `event_kinds` | how many parameters are shown, which kinds of events |
//! | `text_size` | how large text is |
//! | `widgets` | a number to type, the row of a parameter, tables, choices, buttons, the focus |
//! | `words` | numbers, symbols, parameters and runs in text |
//! | `theme` | every colour, size and font |

mod arrangement;
mod bars;
mod captions;
mod capture_choice;
mod detail;
mod dialogs;
mod dispatch;
mod dock;
mod dock_dialogs;
mod event_kinds;
mod keyboard;
mod notice;
mod opener;
mod panel;
mod panels;
mod playback;
mod plot_export;
mod plots;
mod plugin;
mod pointer;
mod register;
mod repeat;
mod request;
mod rescue;
mod screenshot_orders;
mod second_pass;
mod sections;
mod session_look;
mod shortcuts;
mod sides;
mod sweep_desk;
mod text_size;
pub mod theme;
mod user_memory;
mod widgets;
mod words;

pub use arrangement::{Arrangement, Rearrangement};
pub use bars::badge::{Check, Level, checks, stable_step};
pub use bars::film_bar::film_bar_ui;
pub use bars::transport::{Transport, status_ui};
pub use capture_choice::CaptureChoice;
pub use detail::Detail;
pub use dialogs::capture_form::CaptureForm;
pub use dialogs::path_dialog::{PathDialog, Purpose};
pub use dialogs::sheets::{open_error_ui, sheet_ui, unsaved_ui};
pub(crate) use dispatch::said;
pub use dock::Dock;
pub use panel::Panel;
pub use panels::avalanche_plots::AvalanchePlots;
pub use panels::collapse_plots::CollapsePlots;
pub use panels::column_beside_paper::ColumnBesidePaper;
pub use panels::compare::Compare;
pub use panels::energy_stack::EnergyStack;
pub use panels::events::Events;
pub use panels::explorer::Explorer;
pub use panels::flow_over_depth::FlowOverDepth;
pub use panels::lesson::LessonDesk;
pub(crate) use panels::lesson::show_look;
pub use panels::mean_velocities::MeanVelocities;
pub use panels::microscope::Microscope;
pub use panels::parameter_sweep::ParameterSweep;
pub use panels::parameters::{Parameters, parameter_ui};
pub use panels::picture_settings::PictureSettings;
pub use panels::results::Results;
pub(crate) use playback::first_speed;
pub use plot_export::Export;
pub use plots::run_curves::Curves;
pub use plugin::{DockPlugin, UiPlugin};
pub use repeat::Repeat;
pub use request::{LessonAct, Request, Requests, Sheet, SweepAct};
pub use rescue::RescuePlugin;
pub use screenshot_orders::{
    FilmOrder, FilmSpan, FilmState, PictureOf, PictureOrder, ScreenshotOrder, ScreenshotOrders,
};
pub use second_pass::SecondPicturePass;
pub use session_look::SessionLook;
pub use sweep_desk::{SweepDesk, SweepSeen};
pub use user_memory::{Look, UserMemory};
pub(crate) use words::names::title_in_words;
pub use words::run_names::{KeptRun, RunNames};
