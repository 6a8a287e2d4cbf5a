//! Claims about scene files: what is read, what is refused and in which words, and what world a
//! scene becomes.

mod build;
mod files;
mod gallery;
mod mesh;
