//! What the panels say, as text.

pub mod events;
pub mod names;
pub mod number;
pub mod run_names;
pub mod symbol;
