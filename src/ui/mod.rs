//! The egui panels.
