//! Numbers read from a world. Every measure is a pure function of `&World` or of a recorded series.

/// What one number is: its key in files, its name and symbol for people, its unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Name in files and on plots: `surface angle`.
    pub name: &'static str,
    /// The paper's symbol: `θ`.
    pub symbol: &'static str,
    /// SI unit, `1` for a pure number: `rad`.
    pub unit: &'static str,
    /// One sentence: what it is and by which method it is taken.
    pub description: &'static str,
}
