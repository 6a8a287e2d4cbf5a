//! The two places that runs have side by side: left and right, in the picture as in the panels.

/// One of two runs side by side, and its half of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Half {
    /// The first run; all of the picture where there is one run only.
    #[default]
    Left,
    /// The second run of a comparison.
    Right,
}

impl Half {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];

    /// Its place among both.
    pub fn index(self) -> usize {
        self as usize
    }

    /// What people call it.
    pub fn label(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}
