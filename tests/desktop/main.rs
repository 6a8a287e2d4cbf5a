//! Claims about the window: panels by their accessible labels, pictures through any Vulkan driver.

mod lesson;
mod panels;
mod polyhedra;
mod recording;
mod session;
mod timeline;
mod twin;
mod view;
mod window;
