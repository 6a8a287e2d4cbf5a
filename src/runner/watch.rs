//! Hearing how far work has come.

/// Hears how far a run has come; `()` is nobody.
pub trait Watch {
    /// Before time zero: `share` (0 … 1) of the `stage` is done.
    fn preparing(&mut self, share: f64, stage: &str);

    /// After time zero: `share` (0 … 1) of the run is done; `what` says more, to those who ask.
    fn running(&mut self, share: f64, what: &dyn Fn() -> String);

    /// Of work in several parts: how each of them stands.
    fn parts(&mut self, _parts: &[Part]) {}
}

/// How a part of some work stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// Nothing of it is done.
    Waiting,
    /// It has not come to time zero yet.
    Preparing,
    /// So much of it is done, 0 … 1.
    Running(f64),
    /// It is over, well or not.
    Over,
}

impl Watch for () {
    fn preparing(&mut self, _share: f64, _stage: &str) {}

    fn running(&mut self, _share: f64, _what: &dyn Fn() -> String) {}
}

/// `seconds` of wall-clock time as people say it.
pub fn spoken(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "unknown time".into();
    }
    let whole = seconds.round() as u64;
    match whole {
        0..60 => format!("{whole} s"),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
    }
}
