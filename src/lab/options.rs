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
    /// For a window: a thread of its own that leaves one core to the picture, in real time. (Of two
    /// cores the second gains nothing where a driver draws on it, see `benches/README.md`.)
    pub fn window() -> Self {
        Self {
            driver: DriverKind::Thread,
            threads: available_threads().saturating_sub(1).max(1),
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
