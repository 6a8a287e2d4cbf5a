//! The two sides of panels: which are shown, and how many the window has room for.
//!
//! In: the window's width. Out: whether a side has room, and why not.

/// A window narrower than this has room for one side only [points]: the picture comes first.
pub const ROOM_FOR_BOTH: f32 = 1000.0;
/// A window narrower than this has room for none [points].
pub const ROOM_FOR_ONE: f32 = 680.0;

/// Why the window does not show both sides, where it has no room for them.
pub fn why_not_both(width: f32) -> Option<&'static str> {
    if width >= ROOM_FOR_BOTH {
        None
    } else if width >= ROOM_FOR_ONE {
        Some("The window has room for one of them. Without the controls, the plots are shown.")
    } else {
        Some("The window is too narrow for them.")
    }
}

/// Which of the side panels are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OpenSides {
    /// Controls.
    pub left: bool,
    /// Plots and results.
    pub right: bool,
}
