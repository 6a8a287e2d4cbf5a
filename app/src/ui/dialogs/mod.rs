//! Windows over the rest: each must be answered or closed before anything else.

pub mod path_dialog;
pub mod scene_gallery;
pub mod sheets;
