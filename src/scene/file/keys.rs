//! Keys that come in two units: `radius` in metres, `radius_mm` in millimetres.
//!
//! In: what a file gives under each. Out: one value in SI units, or what is wrong with them.

use crate::scene::error::Problem;
use std::f64::consts::PI;

pub fn metres(millimetres: f64) -> f64 {
    millimetres / 1000.0
}

/// [rad/s]
pub fn per_second(turns_per_minute: f64) -> f64 {
    turns_per_minute * 2.0 * PI / 60.0
}

/// The value that one of two keys gives, in SI units.
pub fn either(
    path: &str,
    si: Option<f64>,
    suffix: &str,
    converted: Option<f64>,
) -> Result<Option<f64>, Problem> {
    if si.is_some() && converted.is_some() {
        let key = path.rsplit('.').next().unwrap_or(path);
        return Err(Problem::new(
            path,
            format!("is given twice, as `{key}` and as `{key}{suffix}`"),
            "one of the two",
        ));
    }
    Ok(si.or(converted))
}

pub fn missing_length(holder: &str, key: &str) -> Problem {
    Problem::new(
        holder,
        format!("has no `{key}`"),
        format!("a length in m, or in mm as `{key}_mm`"),
    )
}
