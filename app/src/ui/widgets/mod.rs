//! Controls that several panels use.

pub mod button;
pub mod combo;
pub mod elided;
pub mod field;
pub mod focus;
pub mod row_button;
pub mod touch;
pub mod value_row;
pub mod value_table;
