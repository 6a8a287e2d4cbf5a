//! Hard limits: which values of a quantity make physical sense and the solver can bear.
//!
//! In: a number in SI units. Out: whether it can be used, and words for what can. Scene files are
//! checked against these rows, and parameters take their ranges from them. What sliders offer is
//! narrower and stands with the parameters.

/// The values that a quantity can have.
#[derive(Debug, PartialEq)]
pub struct Limits {
    /// The smallest one [SI unit].
    pub least: f64,
    /// The largest one [SI unit].
    pub most: f64,
    /// An end that is itself no such value.
    open: Open,
    /// All of that in words.
    pub expected: &'static str,
}

#[derive(Debug, PartialEq)]
enum Open {
    Neither,
    Least,
    Most,
}

impl Limits {
    /// Whether `value` [SI unit] is within them; a value that is no number is not.
    pub fn accept(&self, value: f64) -> bool {
        let excluded = match self.open {
            Open::Neither => false,
            Open::Least => value == self.least,
            Open::Most => value == self.most,
        };
        (self.least..=self.most).contains(&value) && !excluded
    }
}

const fn between(least: f64, most: f64, expected: &'static str) -> Limits {
    Limits {
        least,
        most,
        open: Open::Neither,
        expected,
    }
}

const fn above(least: f64, most: f64, expected: &'static str) -> Limits {
    Limits {
        open: Open::Least,
        ..between(least, most, expected)
    }
}

const fn below(least: f64, most: f64, expected: &'static str) -> Limits {
    Limits {
        open: Open::Most,
        ..between(least, most, expected)
    }
}

/// Sizes of containers and of listed bodies [m].
pub const LENGTH: Limits = between(1e-6, 1000.0, "a length between 1e-6 m and 1000 m");
/// Radii of spheres [m].
pub const RADIUS: Limits = between(1e-6, 10.0, "a grain's radius between 1e-6 m and 10 m");
/// Sizes of lattice cells [m].
pub const CELL: Limits = between(
    1e-5,
    10.0,
    "the size of a lattice cell between 1e-5 m and 10 m",
);
/// Rounding radii [m].
pub const ROUNDING: Limits = between(1e-7, 1.0, "a rounding radius between 1e-7 m and 1 m");
/// Angular speeds of drums [rad/s].
pub const DRUM_SPEED: Limits = between(-1000.0, 1000.0, "a speed between -1000 and 1000 rad/s");
/// Units of length of files of triangles [m].
pub const MESH_SCALE: Limits = between(1e-9, 1e6, "a length between 1e-9 m and 1e6 m");
/// Speeds of tubes upwards [m/s].
pub const TUBE_SPEED: Limits = between(0.0, 100.0, "a speed upwards between 0 and 100 m/s");
/// Components of the gravitational acceleration, and its magnitude in a run [m/s²].
pub const GRAVITY: Limits = between(-1000.0, 1000.0, "a number between -1000 and 1000 m/s²");
/// Young's moduli [Pa].
pub const YOUNGS_MODULUS: Limits = between(1e3, 1e13, "a modulus between 1e3 Pa and 1e13 Pa");
/// Poisson's ratios.
pub const POISSON_RATIO: Limits = below(0.0, 0.5, "a number of at least 0 and below 0.5");
/// Densities [kg/m³].
pub const DENSITY: Limits = between(0.1, 1e6, "a density between 0.1 and 1e6 kg/m³");
/// Coefficients of restitution.
pub const RESTITUTION: Limits = above(0.0, 1.0, "a number above 0 and at most 1");
/// Coefficients of sliding and rolling friction.
pub const FRICTION: Limits = between(0.0, 10.0, "a number between 0 and 10");
/// Parts of a whole that cannot be nothing.
pub const FRACTION: Limits = above(0.0, 1.0, "a fraction above 0 and at most 1");
/// Shares of species.
pub const SHARE: Limits = between(0.0, 1.0, "a share between 0 and 1");
/// Surface tensions [N/m].
pub const SURFACE_TENSION: Limits = between(0.0, 10.0, "a surface tension between 0 and 10 N/m");
/// Contact angles [rad].
pub const CONTACT_ANGLE: Limits =
    between(0.0, 1.6, "an angle between 0 and 1.6 rad, about 90 degrees");
/// Viscosities [Pa s].
pub const VISCOSITY: Limits = between(0.0, 1e4, "a viscosity between 0 and 1e4 Pa s");
/// Volumes of liquid [m³].
pub const LIQUID_VOLUME: Limits = between(0.0, 1e3, "a volume between 0 and 1e3 m³");
/// Smallest gaps of viscous forces, in radii.
pub const SMALLEST_GAP: Limits = between(1e-6, 10.0, "a gap between 1e-6 and 10 radii");
/// Stiffnesses of linear springs [N/m].
pub const STIFFNESS: Limits = between(1e-3, 1e12, "a stiffness between 1e-3 N/m and 1e12 N/m");
/// Times of runs and between states [s].
pub const DURATION: Limits = above(0.0, 1e6, "a time above 0 s and at most 1e6 s");
/// Time steps [s].
pub const TIME_STEP: Limits = between(
    1e-12,
    1.0,
    "`Automatic`, or `Given(…)` with a step between 1e-12 s and 1 s",
);
/// Numbers of grains: about 2 kB each in memory.
pub const GRAINS: Limits = between(
    1.0,
    1e6,
    "between 1 and 1000000 grains, which take about 2 kB of memory each",
);

/// Polyhedra that a scene may have: up to 20 kB each in memory.
pub const MOST_POLYHEDRA: usize = 200_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_open_end_is_no_value_and_neither_is_what_is_no_number() {
        assert!(FRICTION.accept(0.0) && FRICTION.accept(10.0) && !FRICTION.accept(10.1));
        assert!(!RESTITUTION.accept(0.0) && RESTITUTION.accept(1.0));
        assert!(POISSON_RATIO.accept(0.0) && !POISSON_RATIO.accept(0.5));
        assert!(!DURATION.accept(f64::NAN) && !DURATION.accept(f64::INFINITY));
    }
}
