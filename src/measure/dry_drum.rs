//! Dry drums to compare wet ones with.
//!
//! In: a radius of grains. Out: what the dry drum of Kasper et al. 2021 with such grains gave in
//! this program, averaged over the last 30 s of 50 s (`grainfall dry-r3 --no-render` and so on)
//! with a smallest drop of 1°. It is what live plots divide by.

/// Results of a dry drum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DryDrum {
    /// Radius of its grains [m].
    pub radius: f64,
    /// Mean drop ⟨Δθ⟩ [rad].
    pub drop: f64,
}

/// The drums that were run.
const DRUMS: [DryDrum; 3] = [
    DryDrum {
        radius: 3e-3,
        drop: 0.1466,
    },
    DryDrum {
        radius: 2e-3,
        drop: 0.0968,
    },
    // From 15.8 to 39.4 s.
    DryDrum {
        radius: 1.25e-3,
        drop: 0.0661,
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
        assert!((dry_drum(3e-3).unwrap().drop.to_degrees() - 8.4).abs() < 0.01);
        assert!(dry_drum(2e-3).is_some());
        assert!(dry_drum(2.5e-3).is_none());
    }
}
