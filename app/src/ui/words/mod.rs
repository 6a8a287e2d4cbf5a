//! What the panels say, as text.

pub mod number;
pub mod run_names;
pub mod symbol;
