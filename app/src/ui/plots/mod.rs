//! Curves of samples, as several panels draw them.

pub mod axes;
pub mod chart_plot;
pub mod decimate;
pub mod labels;
pub mod run_curves;
pub mod time_plot;
pub mod time_window;
