//! How a lab is opened: who computes, on how many threads, how fast, with how much memory.

use crate::run::{BedStore, ScriptedCommand, available_threads};

/// Memory for keyframes in a window [bytes].
const WINDOW_MEMORY: usize = 1 << 30;

/// How a lab is opened.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Who computes.
    pub driver: DriverKind,
    /// Threads the solver works on; two runs share them.
    pub threads: usize,
    /// Whether the run starts by itself.
    pub autoplay: bool,
    /// Simulated seconds per wall-clock second to aim for; infinity for as fast as the machine can.
    pub speed: f64,
    /// Where settled beds are looked for and kept.
    pub beds: BedStore,
    /// Whether a bed that has to settle is shown meanwhile.
    pub shows_settling: bool,
    /// Commands carried out by themselves when their time comes.
    pub script: Vec<ScriptedCommand>,
    /// Memory for keyframes [bytes]; without any, an earlier moment is computed again from time
    /// zero.
    pub memory: usize,
}

/// Who computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriverKind {
    /// The caller of [`super::Lab::tick`], within the call.
    Inline,
    /// A thread of its own; no call ever waits for it.
    Thread,
}

impl Options {
    /// For a window whose picture software may draw: a thread of its own, in real time.
    pub fn window() -> Self {
        Self {
            driver: DriverKind::Thread,
            threads: window_threads(true),
            autoplay: true,
            speed: 1.0,
            beds: BedStore::user(),
            shows_settling: true,
            script: Vec::new(),
            memory: WINDOW_MEMORY,
        }
    }

    /// Without a window: inline, all cores, as fast as the machine can; nobody goes back.
    pub fn headless() -> Self {
        Self {
            driver: DriverKind::Inline,
            threads: available_threads(),
            speed: f64::INFINITY,
            shows_settling: false,
            memory: 0,
            ..Self::window()
        }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::window()
    }
}

/// Threads of the solver beside a window. One core is left to the picture; of two both serve the
/// solver, unless software draws: a second thread gains more than a picture takes that a graphics
/// device draws.
pub fn window_threads(software: bool) -> usize {
    beside_picture(available_threads(), software)
}

fn beside_picture(cores: usize, software: bool) -> usize {
    match cores {
        2 if !software => 2,
        cores => cores.saturating_sub(1).max(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_has_a_core_but_where_the_solver_would_be_left_one_and_a_graphics_device_draws() {
        let threads = |cores| [false, true].map(|software| beside_picture(cores, software));
        assert_eq!(threads(1), [1, 1]);
        assert_eq!(threads(2), [2, 1]);
        assert_eq!(threads(3), [2, 2]);
        assert_eq!(threads(8), [7, 7]);
    }
}
