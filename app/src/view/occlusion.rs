//! How much of the sky neighbouring grains hide from each grain's surface, as a soft shadow in the
//! gaps of a packing.
//!
//! In: centres and radii. Out: per grain a function of the surface normal, `c + b·n + n·Q n` with a
//! traceless symmetric `Q`: the first three orders of spherical harmonics of what the neighbours
//! hide. It is a picture's shadow, smooth in the positions so that nothing flickers; it is no
//! measure. Walls hide nothing.

use bevy::math::{USizeVec3, Vec3};
use bevy::tasks::futures::check_ready;
use bevy::tasks::{AsyncComputeTaskPool, Task};
use bytemuck::{Pod, Zeroable};

/// Share of the sky hidden as a function of the surface normal, as the shaders read it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Occlusion {
    /// The mean `c`.
    pub mean: f32,
    /// The gradient `b`.
    pub gradient: Vec3,
    /// `Q` as xx, yy, xy, yz, zx; zz is −xx − yy.
    pub quadrupole: [f32; 5],
}

/// First three Legendre coefficients of the share of the sky that a touching sphere of the same
/// size hides, over the cosine between normal and direction: of `(2μ − 1)/s³`, `s² = 5 − 4μ`, for μ
/// > 1/2.
const TOUCHING: [f32; 3] = [0.0670, 0.1764, 0.2252];
/// Gap beyond which a neighbour hides nothing, in its radii.
const RANGE: f32 = 1.0;

impl Occlusion {
    /// Adds a neighbour in the direction `towards` (a unit vector) that hides `strength` times what
    /// a touching one does.
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

/// The shadows of all spheres, which follow them round by round beside the frames, so that no frame
/// waits for them.
#[derive(Default)]
pub(super) struct Shadows {
    /// Whether the spheres have changed since the last round began.
    is_stale: bool,
    under_way: Option<Task<Round>>,
    /// What the last round leaves for the next one.
    done: Round,
}

impl Shadows {
    /// Whether all are up to date.
    pub(super) fn are_whole(&self) -> bool {
        !self.is_stale && self.under_way.is_none()
    }

    /// From now on the spheres or what is cut away have changed.
    pub(super) fn outdate(&mut self) {
        self.is_stale = true;
    }

    /// What a finished round found, an [`Occlusion`] for each of `count` spheres, as bytes; none while
    /// it is under way, nor where it was one of another scene.
    pub(super) fn take(&mut self, count: usize) -> Option<Vec<u8>> {
        let mut round = self.under_way.as_mut().and_then(check_ready)?;
        self.under_way = None;
        let bytes = std::mem::take(&mut round.bytes);
        let has_all = round.spheres.len() == count;
        self.done = round;
        has_all.then_some(bytes)
    }

    /// Begins a round where the spheres have changed since the last one: `place` lists them (centre,
    /// radius). Those for which `absent` holds hide nothing.
    pub(super) fn begin(
        &mut self,
        place: impl FnOnce(&mut Vec<(Vec3, f32)>),
        absent: impl Fn(Vec3) -> bool + Send + 'static,
    ) {
        if self.is_stale && self.under_way.is_none() {
            self.is_stale = false;
            let mut round = std::mem::take(&mut self.done);
            round.spheres.clear();
            place(&mut round.spheres);
            self.under_way = Some(AsyncComputeTaskPool::get().spawn(async move {
                round.look(absent);
                round.bytes = bytemuck::cast_slice(&round.hidden).to_vec();
                round
            }));
        }
    }
}

/// One look at all spheres, with the room that it needs.
#[derive(Default)]
struct Round {
    spheres: Vec<(Vec3, f32)>,
    cells: ShadowCells,
    hidden: Vec<Occlusion>,
    /// What is hidden, for a buffer.
    bytes: Vec<u8>,
}

impl Round {
    fn look(&mut self, absent: impl Fn(Vec3) -> bool) {
        self.hidden.clear();
        self.hidden.resize(self.spheres.len(), Occlusion::default());
        if !self.cells.sort(&self.spheres, absent) {
            return;
        }
        for place in 0..self.spheres.len() {
            let (sphere, occlusion) = self.cells.occlusion(place);
            self.hidden[sphere] = occlusion;
        }
    }
}

/// Share of the sky that a sphere of radius `other` at a `gap` hides from one of radius `own`, over
/// that of a touching equal one.
fn strength(gap: f32, own: f32, other: f32) -> f32 {
    let fade = (1.0 - gap.max(0.0) / (RANGE * other)).max(0.0);
    // Seen from the surface, a sphere covers a share of the sky that goes with the square of radius
    // over distance.
    let size = (2.0 * other / (own + other)).min(1.5);
    fade * fade * size * size
}

/// Spheres in the order of the cubic cells that their centres are in.
#[derive(Default)]
struct ShadowCells {
    low: Vec3,
    cell: f32,
    size: USizeVec3,
    /// Where in `sorted` each cell begins.
    start: Vec<u32>,
    sorted: Vec<Sorted>,
    /// The cell of each sphere, as given.
    cell_of: Vec<u32>,
}

/// A sphere in its cell.
#[derive(Clone, Copy, Default)]
struct Sorted {
    centre: Vec3,
    radius: f32,
    /// Its radius, or zero where it hides nothing.
    hiding: f32,
    /// Its place among those given.
    sphere: u32,
}

impl ShadowCells {
    /// Sorts `spheres`; false where their places are no numbers or none has a size.
    fn sort(&mut self, spheres: &[(Vec3, f32)], absent: impl Fn(Vec3) -> bool) -> bool {
        let (mut low, mut high, mut largest) = (Vec3::INFINITY, Vec3::NEG_INFINITY, 0.0_f32);
        for (centre, radius) in spheres {
            (low, high, largest) = (low.min(*centre), high.max(*centre), largest.max(*radius));
        }
        if !(high - low).is_finite() || largest <= 0.0 {
            return false;
        }
        // No more than 128 cells a side, whatever flies away.
        self.cell = ((2.0 + RANGE) * largest).max((high - low).max_element() / 127.0);
        self.low = low;
        self.size = self.cell_at(high) + 1;
        self.start.clear();
        self.start.resize(self.size.element_product() + 2, 0);
        self.cell_of.clear();
        for (centre, _) in spheres {
            let USizeVec3 { x, y, z } = self.cell_at(*centre);
            let cell = self.index(x, y, z);
            self.cell_of.push(cell as u32);
            self.start[cell + 2] += 1;
        }
        for i in 2..self.start.len() {
            self.start[i] += self.start[i - 1];
        }
        self.sorted.resize(spheres.len(), Sorted::default());
        for (sphere, ((centre, radius), cell)) in spheres.iter().zip(&self.cell_of).enumerate() {
            // What begins one cell further on moves back to where this cell ends.
            let place = &mut self.start[*cell as usize + 1];
            self.sorted[*place as usize] = Sorted {
                centre: *centre,
                radius: *radius,
                hiding: if absent(*centre) { 0.0 } else { *radius },
                sphere: sphere as u32,
            };
            *place += 1;
        }
        true
    }

    fn cell_at(&self, x: Vec3) -> USizeVec3 {
        // Truncated: nothing lies below the lowest.
        ((x - self.low) / self.cell).as_usizevec3()
    }

    fn index(&self, x: usize, y: usize, z: usize) -> usize {
        x + self.size.x * (y + self.size.y * z)
    }

    /// Calls `visit` with all spheres near the one at `place` in the order of cells, and with some
    /// that are not.
    fn for_near(&self, place: usize, mut visit: impl FnMut(&Sorted)) {
        let at = self.cell_at(self.sorted[place].centre);
        let from = at.saturating_sub(USizeVec3::ONE);
        let to = (at + 1).min(self.size - 1);
        for z in from.z..=to.z {
            for y in from.y..=to.y {
                // The cells of a row follow each other.
                let row = self.start[self.index(from.x, y, z)] as usize
                    ..self.start[self.index(to.x, y, z) + 1] as usize;
                self.sorted[row].iter().for_each(&mut visit);
            }
        }
    }

    /// The sphere at `place` in the order of cells, and what hides the sky from it.
    fn occlusion(&self, place: usize) -> (usize, Occlusion) {
        let own = self.sorted[place];
        let mut occlusion = Occlusion::default();
        self.for_near(place, |other| {
            let towards = other.centre - own.centre;
            let reach = own.radius + (1.0 + RANGE) * other.hiding;
            let square = towards.length_squared();
            if square < reach * reach && square > 0.0 && other.hiding > 0.0 {
                let distance = square.sqrt();
                let gap = distance - own.radius - other.hiding;
                occlusion.add(towards / distance, strength(gap, own.radius, other.hiding));
            }
        });
        (own.sphere as usize, occlusion)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Share of the sky that a touching equal sphere at direction cosine `mu` hides, as the module
    /// says.
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

    fn occlusions(spheres: &[(Vec3, f32)], absent: bool) -> Vec<Occlusion> {
        let mut round = Round {
            spheres: spheres.to_vec(),
            ..Round::default()
        };
        round.look(|_| absent);
        round.hidden
    }

    #[test]
    fn neighbours_hide_most_on_their_side() {
        let spheres = [(Vec3::ZERO, 1.0), (Vec3::new(2.0, 0.0, 0.0), 1.0)];
        let hidden = occlusions(&spheres, false);
        let [towards, aside, away] = [Vec3::X, Vec3::Y, Vec3::NEG_X].map(|n| hidden[0].at(n));
        assert!(
            towards > 0.4 && aside < 0.1 && away < 0.2,
            "{towards} {aside} {away}"
        );
        // What one does to the other, the other does to it.
        assert_eq!(hidden[1].at(Vec3::NEG_X), towards);
        assert_eq!(occlusions(&spheres, true)[0], Occlusion::default());
    }

    #[test]
    fn shadow_fades_to_nothing_before_a_neighbour_leaves() {
        for gap in [0.0, 0.5, 0.999, 1.5] {
            let spheres = [(Vec3::ZERO, 1.0), (Vec3::new(0.0, 2.0 + gap, 0.0), 1.0)];
            let mean = occlusions(&spheres, false)[0].mean;
            let expected = TOUCHING[0] * (1.0 - gap).max(0.0).powi(2);
            assert!((mean - expected).abs() < 1e-6, "{gap}: {mean}");
        }
    }

    fn scattered() -> Vec<(Vec3, f32)> {
        let scrambled = |i: u32, k: u32| {
            let bits = (i * 3 + k).wrapping_mul(2_654_435_761) ^ 0x9E37_79B9;
            bits.wrapping_mul(0x85EB_CA6B) as f32 / u32::MAX as f32
        };
        let place = |i| Vec3::new(scrambled(i, 0), scrambled(i, 1), scrambled(i, 2));
        (0..400).map(|i| (12.0 * place(i), 0.5)).collect()
    }

    #[test]
    fn pairs_found_by_cells_are_those_found_by_looking_at_all() {
        let spheres = scattered();
        let near = |a: Vec3, b: Vec3| a.distance_squared(b) < 2.25;
        let mut cells = ShadowCells::default();
        assert!(cells.sort(&spheres, |_| false));
        let mut pairs = 0;
        for place in 0..spheres.len() {
            let own = cells.sorted[place];
            let mut found = Vec::new();
            cells.for_near(place, |other| {
                if near(own.centre, other.centre) {
                    found.push(other.sphere as usize);
                }
            });
            found.sort_unstable();
            let own = own.centre;
            let all: Vec<usize> = (0..400).filter(|i| near(own, spheres[*i].0)).collect();
            assert_eq!(found, all);
            pairs += all.len() - 1;
        }
        assert!(pairs > 100);
    }

    #[test]
    fn shadows_follow_spheres_that_move_during_a_round() {
        AsyncComputeTaskPool::get_or_init(Default::default);
        let mut spheres = scattered();
        let expected = occlusions(&spheres, false);
        let mut shadows = Shadows::default();
        let begin = |shadows: &mut Shadows, spheres: &[(Vec3, f32)]| {
            shadows.begin(|placed| placed.extend_from_slice(spheres), |_| false);
        };
        // Elsewhere at first: a round is under way when they all move.
        spheres.reverse();
        shadows.outdate();
        assert_eq!(shadows.take(spheres.len()), None, "none has begun yet");
        begin(&mut shadows, &spheres);
        spheres.reverse();
        shadows.outdate();
        let mut rounds = Vec::new();
        while !shadows.are_whole() {
            rounds.extend(shadows.take(spheres.len()));
            begin(&mut shadows, &spheres);
            std::thread::yield_now();
        }
        assert_eq!(rounds.len(), 2);
        assert_eq!(rounds[1], bytemuck::cast_slice::<_, u8>(&expected));
    }

    #[test]
    fn shadows_of_other_spheres_are_not_taken() {
        AsyncComputeTaskPool::get_or_init(Default::default);
        let spheres = scattered();
        let mut shadows = Shadows::default();
        shadows.outdate();
        shadows.begin(|placed| placed.extend_from_slice(&spheres), |_| false);
        while !shadows.are_whole() {
            assert_eq!(shadows.take(spheres.len() - 1), None);
            std::thread::yield_now();
        }
    }

    #[test]
    fn places_that_are_no_numbers_have_no_shadows() {
        let spheres = [(Vec3::NAN, 1.0), (Vec3::ZERO, 1.0)];
        assert_eq!(occlusions(&spheres, false), [Occlusion::default(); 2]);
        assert_eq!(occlusions(&[], false), []);
    }
}
