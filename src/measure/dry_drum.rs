//! Dry drums to compare wet ones with.
//!
//! In: a radius of grains. Out: what the dry drum of Kasper et al. 2021 with such grains gave in
//! this program, averaged over the last 30 s of 50 s (`grainfall dry-r3 --no-render` and so on)
//! with a smallest drop of 1°. It is what live plots divide by.

use super::estimate::Estimate;

/// Results of a dry drum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DryDrum {
    /// Radius of its grains [m].
    pub radius: f64,
    /// Mean drop ⟨Δθ⟩ [rad] with its standard error.
    pub drop: Estimate,
}

/// A mean over so many `avalanches`. Its error is by how much two equal runs of 50 s came to differ
/// (`docs/validation.md`, *Scatter*), where there are such.
const fn drop(mean: f64, error: Option<f64>, avalanches: usize) -> Estimate {
    Estimate {
        mean,
        error,
        samples: avalanches,
        freedom: avalanches - 1,
    }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The drums that were run.
const DRUMS: [DryDrum; 3] = [
    DryDrum {
        radius: 3e-3,
        drop: drop(0.1466, Some(0.7 * DEGREE), 9),
    },
    DryDrum {
        radius: 2e-3,
        drop: drop(0.0968, Some(0.5 * DEGREE), 11),
    },
    // From 15.8 to 39.4 s.
    DryDrum {
        radius: 1.25e-3,
        drop: drop(0.0661, None, 9),
    },
];

/// The dry drum of the paper with grains of this radius [m]; none for other radii.
pub fn dry_drum(radius: f64) -> Option<DryDrum> {
    let close = |drum: &DryDrum| (drum.radius / radius - 1.0).abs() < 1e-6;
    DRUMS.into_iter().find(close)
}

#[cfg(test)]
mod tests {
    use super::dry_drum;

    #[test]
    fn stored_drums_are_found_by_their_radius() {
        assert!((dry_drum(3e-3).unwrap().drop.mean.to_degrees() - 8.4).abs() < 0.01);
        assert!(dry_drum(2e-3).is_some());
        assert!(dry_drum(2.5e-3).is_none());
    }
}
