//! How much of the sky neighbouring grains hide from each grain's surface, as a soft shadow in the gaps of a packing.
//!
//! In: centres and radii. Out: per grain a function of the surface normal, `c + b·n + n·Q n` with a traceless symmetric
//! `Q`: the first three orders of spherical harmonics of what the neighbours hide. It is a picture's shadow, smooth in
//! the positions so that nothing flickers; it is no measure. Walls hide nothing.

use bevy::math::Vec3;

/// Share of the sky hidden as a function of the surface normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Occlusion {
    /// The mean `c`.
    pub mean: f32,
    /// The gradient `b`.
    pub gradient: Vec3,
    /// `Q` as xx, yy, xy, yz, zx; zz is −xx − yy.
    pub quadrupole: [f32; 5],
}

/// First three Legendre coefficients of the share of the sky that a touching sphere of the same size hides, over the
/// cosine between normal and direction: of `(2μ − 1)/s³`, `s² = 5 − 4μ`, for μ > 1/2.
const TOUCHING: [f32; 3] = [0.0670, 0.1764, 0.2252];
/// Gap beyond which a neighbour hides nothing, in its radii.
const RANGE: f32 = 1.0;

impl Occlusion {
    /// Adds a neighbour in the direction `towards` (a unit vector) that hides `strength` times what a touching one does.
    fn add(&mut self, towards: Vec3, strength: f32) {
        let [mean, gradient, quadrupole] = TOUCHING.map(|c| c * strength);
        let Vec3 { x, y, z } = towards;
        self.mean += mean;
        self.gradient += gradient * towards;
        let third = 1.0 / 3.0;
        let parts = [x * x - third, y * y - third, x * y, y * z, z * x];
        for (sum, part) in self.quadrupole.iter_mut().zip(parts) {
            *sum += 1.5 * quadrupole * part;
        }
    }

    /// Share hidden where the normal is `n`; the shader does the same.
    #[cfg(test)]
    fn at(&self, n: Vec3) -> f32 {
        let [xx, yy, xy, yz, zx] = self.quadrupole;
        let squares = xx * n.x * n.x + yy * n.y * n.y - (xx + yy) * n.z * n.z;
        let products = xy * n.x * n.y + yz * n.y * n.z + zx * n.z * n.x;
        self.mean + self.gradient.dot(n) + squares + 2.0 * products
    }
}

/// What hides the sky from each sphere (centre, radius); spheres for which `absent` holds hide nothing.
pub(super) fn occlusions(spheres: &[(Vec3, f32)], absent: impl Fn(Vec3) -> bool) -> Vec<Occlusion> {
    let mut occlusions = vec![Occlusion::default(); spheres.len()];
    let largest = spheres.iter().fold(0.0, |most: f32, s| most.max(s.1));
    if largest <= 0.0 {
        return occlusions;
    }
    let present: Vec<bool> = spheres.iter().map(|s| !absent(s.0)).collect();
    for_each_pair(spheres, (2.0 + RANGE) * largest, |i, j| {
        let (from_i, distance) = (spheres[j].0 - spheres[i].0).normalize_and_length();
        let gap = distance - spheres[i].1 - spheres[j].1;
        if present[j] {
            occlusions[i].add(from_i, strength(gap, spheres[i].1, spheres[j].1));
        }
        if present[i] {
            occlusions[j].add(-from_i, strength(gap, spheres[j].1, spheres[i].1));
        }
    });
    occlusions
}

/// What a sphere of radius `other` at a `gap` hides from one of radius `own`, in what a touching equal one does.
fn strength(gap: f32, own: f32, other: f32) -> f32 {
    let fade = (1.0 - gap.max(0.0) / (RANGE * other)).max(0.0);
    // Seen from the surface, a sphere covers a share of the sky that goes with the square of radius over distance.
    let size = (2.0 * other / (own + other)).min(1.5);
    fade * fade * size * size
}

/// Calls `visit` once for each pair of spheres whose centres are closer than `reach`, and for some that are not.
fn for_each_pair(spheres: &[(Vec3, f32)], reach: f32, mut visit: impl FnMut(usize, usize)) {
    let low = spheres.iter().fold(Vec3::INFINITY, |low, s| low.min(s.0));
    let high = (spheres.iter()).fold(Vec3::NEG_INFINITY, |high, s| high.max(s.0));
    if !(high - low).is_finite() {
        return;
    }
    // No more than 128 cells a side, whatever flies away.
    let cell = reach.max((high - low).max_element() / 127.0);
    let size = ((high - low) / cell).floor().as_usizevec3() + 1;
    let place = |x: Vec3| ((x - low) / cell).floor().as_usizevec3().min(size - 1);
    let index = |x: usize, y: usize, z: usize| x + size.x * (y + size.y * z);

    let mut start = vec![0_u32; size.element_product() + 1];
    let cells: Vec<usize> = spheres
        .iter()
        .map(|s| {
            let at = place(s.0);
            index(at.x, at.y, at.z)
        })
        .collect();
    for cell in &cells {
        start[cell + 1] += 1;
    }
    for i in 1..start.len() {
        start[i] += start[i - 1];
    }
    let mut next = start.clone();
    let mut sorted = vec![0_u32; spheres.len()];
    for (i, cell) in cells.iter().enumerate() {
        sorted[next[*cell] as usize] = i as u32;
        next[*cell] += 1;
    }

    for (i, sphere) in spheres.iter().enumerate() {
        let at = place(sphere.0);
        let from = at.saturating_sub(bevy::math::USizeVec3::ONE);
        let to = (at + 1).min(size - 1);
        for z in from.z..=to.z {
            for y in from.y..=to.y {
                // The cells of a row follow each other.
                let row = start[index(from.x, y, z)]..start[index(to.x, y, z) + 1];
                for &j in &sorted[row.start as usize..row.end as usize] {
                    let j = j as usize;
                    if j > i && spheres[j].0.distance_squared(sphere.0) < reach * reach {
                        visit(i, j);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Share of the sky that a touching equal sphere at direction cosine `mu` hides, as the module says.
    fn touching(mu: f32) -> f32 {
        let s2 = 5.0 - 4.0 * mu;
        ((2.0 * mu - 1.0) / (s2 * s2.sqrt())).max(0.0)
    }

    #[test]
    fn coefficients_are_those_of_a_touching_sphere() {
        let steps = 20_000;
        let mut projected = [0.0; 3];
        for i in 0..steps {
            let mu = -1.0 + (i as f32 + 0.5) * 2.0 / steps as f32;
            let legendre = [1.0, mu, 1.5 * mu * mu - 0.5];
            for (l, sum) in projected.iter_mut().enumerate() {
                let weight = (2.0 * l as f32 + 1.0) / steps as f32;
                *sum += weight * legendre[l] * touching(mu);
            }
        }
        for (projected, constant) in projected.into_iter().zip(TOUCHING) {
            // The constants have three digits.
            assert!(
                (projected - constant).abs() < 1e-3,
                "{projected} {constant}"
            );
        }
    }

    #[test]
    fn neighbours_hide_most_on_their_side() {
        let spheres = [(Vec3::ZERO, 1.0), (Vec3::new(2.0, 0.0, 0.0), 1.0)];
        let hidden = occlusions(&spheres, |_| false);
        let [towards, aside, away] = [Vec3::X, Vec3::Y, Vec3::NEG_X].map(|n| hidden[0].at(n));
        assert!(
            towards > 0.4 && aside < 0.1 && away < 0.2,
            "{towards} {aside} {away}"
        );
        // What one does to the other, the other does to it.
        assert_eq!(hidden[1].at(Vec3::NEG_X), towards);
        assert_eq!(occlusions(&spheres, |_| true)[0], Occlusion::default());
    }

    #[test]
    fn shadow_fades_to_nothing_before_a_neighbour_leaves() {
        for gap in [0.0, 0.5, 0.999, 1.5] {
            let spheres = [(Vec3::ZERO, 1.0), (Vec3::new(0.0, 2.0 + gap, 0.0), 1.0)];
            let mean = occlusions(&spheres, |_| false)[0].mean;
            let expected = TOUCHING[0] * (1.0 - gap).max(0.0).powi(2);
            assert!((mean - expected).abs() < 1e-6, "{gap}: {mean}");
        }
    }

    #[test]
    fn pairs_found_by_cells_are_those_found_by_looking_at_all() {
        let spheres: Vec<(Vec3, f32)> = (0..400_u32)
            .map(|i| {
                let scrambled = |k: u32| {
                    let bits = (i * 3 + k).wrapping_mul(2_654_435_761) ^ 0x9E37_79B9;
                    bits.wrapping_mul(0x85EB_CA6B) as f32 / u32::MAX as f32
                };
                (
                    12.0 * Vec3::new(scrambled(0), scrambled(1), scrambled(2)),
                    0.5,
                )
            })
            .collect();
        let mut found = Vec::new();
        for_each_pair(&spheres, 1.5, |i, j| found.push((i, j)));
        found.sort_unstable();
        let mut all = Vec::new();
        for i in 0..spheres.len() {
            for j in i + 1..spheres.len() {
                if spheres[i].0.distance_squared(spheres[j].0) < 2.25 {
                    all.push((i, j));
                }
            }
        }
        assert_eq!(found, all);
        assert!(all.len() > 50);
    }
}
