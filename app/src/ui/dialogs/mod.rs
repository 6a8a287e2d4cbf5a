//! Windows over the rest: each must be answered or closed before anything else.

pub mod capture_form;
mod dialog;
pub mod path_dialog;
pub mod scene_gallery;
pub mod sheets;
pub mod shown;
pub mod typed_line;
