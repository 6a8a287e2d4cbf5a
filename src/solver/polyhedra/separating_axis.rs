//! The direction that separates two convex cores best.
//!
//! In: the vertices and face planes of two bodies, the direction found last time. Out: a unit
//! vector, and where both end along it. Where the cores do not overlap, some plane separates them;
//! its normal is a face's of either or a cross product of two edges (the separating axis theorem).
//! Here only face normals and the known direction are tried, so that the gap found is a lower bound
//! of the distance: good enough to say which features are out of reach.

use crate::lanes::{Lanes, Row, dot, side_by_side};

/// A direction from the first body to the second, and how far apart they are along it.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// Unit vector.
    pub direction: [f64; 3],
    /// Largest coordinate of the first body's core along it, and smallest of the second's [m].
    pub ends: [f64; 2],
}

impl Axis {
    /// How far apart they are along `direction`, a unit vector: each end is an exact extremum over
    /// the vertices, so that the gap is a lower bound of the cores' distance, whatever the
    /// direction.
    pub fn between(vertices: [&[Row]; 2], direction: [f64; 3]) -> Self {
        let [first, second] = vertices;
        Self {
            direction,
            ends: [extent(first, direction)[1], extent(second, direction)[0]],
        }
    }

    /// The direction that separates the two bodies best among the normals of their faces and
    /// `known`, that of last time.
    #[inline(always)]
    pub fn separating<N: Lanes>(
        processor: N::Processor,
        vertices: [&[Row]; 2],
        planes: [&[Row]; 2],
        known: [f64; 3],
    ) -> Self {
        let of_first = best_face::<N>(processor, planes[0], vertices[1]);
        let of_second = best_face::<N>(processor, planes[1], vertices[0]);
        let face = match (of_first, of_second) {
            (Some((face, gap)), other) if other.is_none_or(|(_, known)| gap >= known) => {
                let [x, y, z, _] = planes[0][face];
                Some([x, y, z])
            }
            (_, Some((face, _))) => {
                let [x, y, z, _] = planes[1][face];
                Some([-x, -y, -z])
            }
            _ => None,
        };
        let [x, y, z] = known;
        let length = (x * x + y * y + z * z).sqrt();
        let known = (length > 0.0).then(|| known.map(|x| x / length));
        // Two spheres at the first time: along the line of their centres.
        let centres = || {
            let (p, q) = (vertices[0][0], vertices[1][0]);
            let d = [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
            let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
            d.map(|x| if length > 0.0 { x / length } else { 0.0 })
        };
        let first = Self::between(vertices, face.or(known).unwrap_or_else(centres));
        match known.map(|direction| Self::between(vertices, direction)) {
            Some(last) if last.gap() > first.gap() => last,
            _ => first,
        }
    }

    /// Width of the gap between the two along it [m]; negative where they overlap.
    pub fn gap(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }
}

/// Smallest and largest coordinate of some vertices along a direction.
#[inline(always)]
fn extent(vertices: &[Row], direction: [f64; 3]) -> [f64; 2] {
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    for v in vertices {
        let place = along(*v, direction);
        ends[0] = if place < ends[0] { place } else { ends[0] };
        ends[1] = if place > ends[1] { place } else { ends[1] };
    }
    ends
}

/// Coordinate of a point along a direction.
#[inline(always)]
pub fn along(v: Row, direction: [f64; 3]) -> f64 {
    v[0] * direction[0] + v[1] * direction[1] + v[2] * direction[2]
}

/// The face among `planes` (outward unit normal, distance from the origin [m]) from which
/// `vertices` keep the largest distance, the first of several, and that distance [m]; none of a
/// sphere, which has no face. Negative where every face has a vertex behind it.
#[inline(always)]
fn best_face<N: Lanes>(
    processor: N::Processor,
    planes: &[Row],
    vertices: &[Row],
) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    for (first, group) in planes.chunks(N::COUNT).enumerate() {
        let last = group.len() - 1;
        let rows = side_by_side::<N, _>(|k| &group[k.min(last)]);
        let [nx, ny, nz, offset] = N::gather(processor, rows);
        let mut lowest = N::splat(processor, f64::INFINITY);
        for v in vertices {
            let v = [
                N::splat(processor, v[0]),
                N::splat(processor, v[1]),
                N::splat(processor, v[2]),
            ];
            let place = dot([nx, ny, nz], v);
            lowest = N::choose(lowest.exceeds(place), place, lowest);
        }
        let gaps = (lowest - offset).numbers();
        for (k, &gap) in gaps.iter().take(group.len()).enumerate() {
            if best.is_none_or(|(_, known)| gap > known) {
                best = Some((first * N::COUNT + k, gap));
            }
        }
    }
    best
}
