//! The panels on both sides of the picture: one file, one struct, one function `ui` each. None of
//! them knows another; what two of them share stands in a file of its own (`averages`,
//! `beside_paper`, `run_list`, `start_values`) or in a lower folder.

pub mod about_scene;
pub mod avalanche_plots;
pub mod averages;
pub mod beside_paper;
pub mod changes;
pub mod collapse_plots;
pub mod column_beside_paper;
pub mod compare;
pub mod energy_stack;
pub mod events;
pub mod explorer;
pub mod flow_over_depth;
pub mod grains;
pub mod lesson;
pub mod mean_velocities;
pub mod microscope;
pub mod parameter_sweep;
pub mod parameters;
pub mod picture_settings;
pub mod results;
pub mod run_list;
pub mod solver_profile;
pub mod start_values;
