//! Dry drums to compare wet ones with.

use serde::Deserialize;

/// Results of a dry drum of Kasper et al. 2021.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DryDrum {
    /// Radius of its grains [m].
    pub radius: f64,
    /// Mean drop ⟨Δθ⟩ [rad].
    pub drop: f64,
}

/// The dry drum of the paper with grains of this radius [m], from stored runs of this program; none for other radii.
pub fn dry_drum(radius: f64) -> Option<DryDrum> {
    let text = include_str!("../../assets/references/kasper2021-dry.ron");
    let stored: Vec<DryDrum> = ron::from_str(text).unwrap_or_default();
    let close = |drum: &DryDrum| (drum.radius / radius - 1.0).abs() < 1e-6;
    stored.into_iter().find(close)
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
