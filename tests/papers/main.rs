//! The papers' claims on whole runs. They take minutes each, so that they run only when asked for:
//! `cargo test --release --test papers -- --ignored --nocapture`.

mod kasper2021;
