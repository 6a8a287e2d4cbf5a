//! Panels by their accessible labels, without Bevy's app and without a GPU: what a click or a typed
//! value asks for.

mod bars;
mod capture;
mod dialogs;
mod keys;
mod lesson;
mod microscope;
mod parameters;
mod picture;
mod plots;
mod remembered;
mod results;
mod room;
mod solver;
mod start_values;
