//! What the process ends with.

use crate::output::Ending;

/// All was done.
pub const DONE: u8 = 0;
/// Files could not be written.
pub const NOT_WRITTEN: u8 = 1;
/// The input asks for something that cannot be.
pub const BAD_INPUT: u8 = 2;
/// The solver met an absurd state.
pub const FAULT: u8 = 3;
/// A run came to another state than a file states.
pub const OTHER_STATE: u8 = 4;
/// Another program writes to the output folder.
pub const IN_USE: u8 = 5;
/// Somebody stopped it.
pub const INTERRUPTED: u8 = 130;

impl Ending {
    /// What the process ends with: 0, 130 or 3.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Done => DONE,
            Self::Interrupted => INTERRUPTED,
            Self::Faulted(_) => FAULT,
        }
    }
}
