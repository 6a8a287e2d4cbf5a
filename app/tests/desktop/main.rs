//! Claims about the window: panels by their accessible labels, pictures through any Vulkan driver.

#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may be computed with the platform's own functions"
)]

mod by_keys;
mod capture;
mod comparison;
mod events;
mod ghosts;
mod headless_film;
mod lesson;
mod measured;
mod panels;
mod played;
mod polyhedra;
mod recording;
mod rescue;
mod run_names;
mod seen;
mod session;
mod sweep;
mod timeline;
mod turning;
mod view;
mod window;
mod window_of_panels;
mod windowless;
