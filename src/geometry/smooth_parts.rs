//! A surface of triangles, divided into smooth parts that a grain touches at one place each.
//!
//! In: triangles. Out: [`MeshPart`]s, each of which tells the point of it that is nearest to a
//! point, and whether that is a contact of its own.
//!
//! Where two triangles meet at an edge and the surface turns by no more than [`SMOOTH`], they belong
//! to one part. The nearest point of a part is its contact: whatever number of triangles meet there,
//! it is one, and it goes from triangle to triangle as the grain slides or rolls over them. Where the
//! surface turns more, parts meet: in a corner a grain touches each of them. A point on an edge or at
//! a corner where parts meet is a contact of the first of them alone, and only where the grain stands
//! over none of the others' triangles: else that triangle is nearer, and the contact its. So a grain
//! touches a sharp edge once, and over a face never its edges. (As in Hu et al. 2013, Particuology 11,
//! 306, contacts with faces go before those with edges, and those before corners; there triangles are
//! compared one with another, here parts.) Both sides of a triangle are alike.

use super::surface_mesh::{MOST_TRIANGLES, MeshPart, OPEN, SHUT, Stored, is_thin};
use glam::DVec3;
use std::collections::HashMap;

/// Cosine of the angle by which a smooth surface may turn at an edge: 20°.
const SMOOTH: f64 = 0.939_692_620_785_908_4;
/// Corners nearer to each other than this, in extents of the mesh, are one: files round them.
const SAME_CORNER: f64 = 1e-6;
/// Most parts of a mesh.
pub const MOST_PARTS: usize = 64;

/// Why triangles are no surface for grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshFlaw {
    /// There are none.
    #[error("it has no triangles")]
    Empty,
    /// There are too many.
    #[error(
        "it has {0} triangles; expected at most {MOST_TRIANGLES}: a program for meshes can thin it out"
    )]
    TooMany(usize),
    /// A corner is nowhere.
    #[error("triangle {0} has a corner that is no place: a number is too large, or none")]
    NotFinite(usize),
    /// A triangle has no area.
    #[error("triangle {0} has no area (or next to none): a program for meshes can take it away")]
    Degenerate(usize),
    /// It is no smooth surface.
    #[error(
        "it falls into {0} parts between edges at which it turns by more than 20°; expected at most {MOST_PARTS}"
    )]
    TooManyParts(usize),
}

/// The smooth parts of a surface of `triangles` [m].
///
/// # Errors
/// What is wrong with them.
pub fn smooth_parts(triangles: &[[DVec3; 3]]) -> Result<Vec<MeshPart>, MeshFlaw> {
    let welded = Welded::of(triangles)?;
    let part_of = welded.parts();
    let count = part_of.iter().max().map_or(0, |last| last + 1);
    if count > MOST_PARTS {
        return Err(MeshFlaw::TooManyParts(count));
    }
    let (at_edges, at_corners) = (welded.directions_at_edges(), welded.directions_at_corners());
    let mut parts = vec![Stored::default(); count];
    for (t, part) in part_of.iter().enumerate() {
        let stored = &mut parts[*part];
        let [a, b, c] = welded.triangles[t];
        stored
            .triangles
            .push([a, b, c].map(|corner| welded.places[corner]));
        let edges = [[a, b], [b, c], [c, a]].map(|[a, b]| {
            gate(
                *part,
                &at_edges[&(a.min(b), a.max(b))],
                &part_of,
                &mut stored.gates,
            )
        });
        let corners = [a, b, c].map(|v| gate(*part, &at_corners[v], &part_of, &mut stored.gates));
        stored.edges.push(edges);
        stored.corners.push(corners);
    }
    Ok(parts.into_iter().map(MeshPart::from).collect())
}

/// Edges of a surface of `triangles` [m] at which it ends: those of an odd number of triangles. None
/// of a closed one.
///
/// # Errors
/// What is wrong with them.
pub fn open_edges(triangles: &[[DVec3; 3]]) -> Result<usize, MeshFlaw> {
    let at_edges = Welded::of(triangles)?.directions_at_edges();
    let ends = at_edges.values().filter(|lying| lying.len() % 2 == 1);
    Ok(ends.count())
}

/// When an edge or a corner is a contact of `part`, at which triangles lie in these directions.
fn gate(
    part: usize,
    lying: &[(usize, DVec3)],
    part_of: &[usize],
    gates: &mut Vec<Vec<DVec3>>,
) -> u32 {
    if lying.iter().any(|(triangle, _)| part_of[*triangle] < part) {
        return SHUT;
    }
    let others = lying
        .iter()
        .filter(|(triangle, _)| part_of[*triangle] != part);
    let directions: Vec<DVec3> = others.map(|(_, direction)| *direction).collect();
    if directions.is_empty() {
        return OPEN;
    }
    gates.push(directions);
    gates.len() as u32 - 1
}

/// Triangles whose corners are known by number.
struct Welded {
    places: Vec<DVec3>,
    triangles: Vec<[usize; 3]>,
}

impl Welded {
    fn of(triangles: &[[DVec3; 3]]) -> Result<Self, MeshFlaw> {
        if triangles.is_empty() {
            return Err(MeshFlaw::Empty);
        }
        if triangles.len() > MOST_TRIANGLES {
            return Err(MeshFlaw::TooMany(triangles.len()));
        }
        let is_place = |x: &DVec3| x.is_finite() && x.abs().max_element() < 1e6;
        if let Some(t) = triangles.iter().position(|t| !t.iter().all(is_place)) {
            return Err(MeshFlaw::NotFinite(t + 1));
        }
        let corners = triangles.iter().flatten();
        let (low, high) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), x| {
            (low.min(*x), high.max(*x))
        });
        let same = SAME_CORNER * (high - low).max_element();
        let mut welded = Self {
            places: Vec::new(),
            triangles: Vec::with_capacity(triangles.len()),
        };
        let mut known: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
        for (t, triangle) in triangles.iter().enumerate() {
            if is_thin(triangle) {
                return Err(MeshFlaw::Degenerate(t + 1));
            }
            let numbers = triangle.map(|x| welded.number(x, same, &mut known));
            if numbers[0] == numbers[1] || numbers[1] == numbers[2] || numbers[2] == numbers[0] {
                return Err(MeshFlaw::Degenerate(t + 1));
            }
            welded.triangles.push(numbers);
        }
        Ok(welded)
    }

    /// The number of the corner at `x`: that of one that is the `same`, or a new one.
    fn number(&mut self, x: DVec3, same: f64, known: &mut HashMap<[i64; 3], Vec<usize>>) -> usize {
        let cell = (x / (2.0 * same)).floor().to_array().map(|k| k as i64);
        let near =
            (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [i, j, k])));
        for [i, j, k] in near {
            let at = [cell[0] + i, cell[1] + j, cell[2] + k];
            let found = known.get(&at).into_iter().flatten();
            let found = found
                .copied()
                .find(|n| (self.places[*n] - x).length() <= same);
            if let Some(number) = found {
                return number;
            }
        }
        self.places.push(x);
        let number = self.places.len() - 1;
        known.entry(cell).or_default().push(number);
        number
    }

    /// From each edge the directions in which its triangles lie.
    fn directions_at_edges(&self) -> HashMap<(usize, usize), Vec<(usize, DVec3)>> {
        let mut all: HashMap<_, Vec<(usize, DVec3)>> = HashMap::new();
        for (t, [a, b, c]) in self.triangles.iter().enumerate() {
            for [from, to, third] in [[a, b, c], [b, c, a], [c, a, b]] {
                let along = (self.places[*to] - self.places[*from]).normalize();
                let off = self.places[*third] - self.places[*from];
                let inward = (off - along * along.dot(off)).normalize();
                let edge = (*from.min(to), *from.max(to));
                all.entry(edge).or_default().push((t, inward));
            }
        }
        all
    }

    /// From each corner the directions of its triangles' edges.
    fn directions_at_corners(&self) -> Vec<Vec<(usize, DVec3)>> {
        let mut all = vec![Vec::new(); self.places.len()];
        for (t, [a, b, c]) in self.triangles.iter().enumerate() {
            for [from, to] in [[a, b], [b, c], [c, a], [b, a], [c, b], [a, c]] {
                let along = (self.places[*to] - self.places[*from]).normalize();
                all[*from].push((t, along));
            }
        }
        all
    }

    /// The number of the part that each triangle belongs to, from 0 on, in the triangles' order.
    fn parts(&self) -> Vec<usize> {
        let mut root: Vec<usize> = (0..self.triangles.len()).collect();
        let find = |root: &mut Vec<usize>, mut t: usize| {
            while root[t] != t {
                root[t] = root[root[t]];
                t = root[t];
            }
            t
        };
        for at_edge in self.directions_at_edges().values() {
            if let [(a, from_a), (b, from_b)] = &at_edge[..]
                && -from_a.dot(*from_b) >= SMOOTH
            {
                let (a, b) = (find(&mut root, *a), find(&mut root, *b));
                // The lower is the root, whatever the order of the edges.
                root[a.max(b)] = a.min(b);
            }
        }
        let mut numbers = HashMap::new();
        let mut part_of = Vec::with_capacity(root.len());
        for t in 0..root.len() {
            let top = find(&mut root, t);
            let next = numbers.len();
            part_of.push(*numbers.entry(top).or_insert(next));
        }
        part_of
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::nearest_on_triangle;

    const CORNERS: [[f64; 3]; 4] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 0.0, 1.0],
        [0.0, 0.0, 1.0],
    ];

    fn quad(corners: [[f64; 3]; 4]) -> Vec<[DVec3; 3]> {
        let [a, b, c, d] = corners.map(DVec3::from_array);
        vec![[a, b, c], [a, c, d]]
    }

    /// Contacts of all parts within `radius` of `x`.
    fn contacts(parts: &[MeshPart], x: DVec3, radius: f64) -> Vec<DVec3> {
        let all = parts.iter().filter_map(|part| part.nearest(x));
        let own = all.filter(|found| found.is_own && (found.point - x).length() < radius);
        own.map(|found| found.point).collect()
    }

    #[test]
    fn plane_is_touched_once_wherever_it_is_divided() {
        let parts = smooth_parts(&quad(CORNERS)).unwrap();
        assert_eq!(parts.len(), 1);
        for k in 0..=100 {
            let s = f64::from(k) / 100.0;
            // Along the diagonal, across it and over the outer edges.
            for x in [[s, 0.1, s], [s, 0.1, 1.0 - s], [s, 0.1, 0.0], [1.0, 0.1, s]] {
                let x = DVec3::from_array(x);
                let found = contacts(&parts, x, 0.2);
                assert_eq!(found.len(), 1);
                assert!((found[0] - x * DVec3::new(1.0, 0.0, 1.0)).length() < 1e-15);
            }
        }
    }

    #[test]
    fn corner_is_touched_on_each_wall_and_sharp_edge_once() {
        let mut walls = quad(CORNERS);
        walls.extend(quad([
            [0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 1.0, 1.0],
            [0.0, 0.0, 1.0],
        ]));
        let parts = smooth_parts(&walls).unwrap();
        assert_eq!(parts.len(), 2);
        // In the corner both, over one alone that one; outside, over the edge, the edge alone.
        assert_eq!(contacts(&parts, DVec3::new(0.1, 0.1, 0.5), 0.12).len(), 2);
        assert_eq!(contacts(&parts, DVec3::new(0.3, 0.1, 0.5), 0.12).len(), 1);
        assert_eq!(
            contacts(&parts, DVec3::new(-0.05, -0.05, 0.5), 0.12),
            [DVec3::new(0.0, 0.0, 0.5)]
        );
        // From the other side of the floor, just beside the edge: the face, not the edge.
        let beside = contacts(&parts, DVec3::new(0.02, -0.1, 0.5), 0.12);
        assert_eq!(beside, [DVec3::new(0.02, 0.0, 0.5)]);
        let beside = contacts(&parts, DVec3::new(-0.1, 0.02, 0.5), 0.12);
        assert_eq!(beside, [DVec3::new(0.0, 0.02, 0.5)]);
        // At the end of the edge, outside of both.
        assert_eq!(
            contacts(&parts, DVec3::new(-0.05, -0.05, 1.05), 0.12),
            [DVec3::Z]
        );
    }

    #[test]
    fn wide_corner_loses_no_contact() {
        // A wall that leans back by 60° from the floor: between both, one of them is always touched
        // at a face, and the edge never.
        let (y, x) = (3.0_f64.sqrt() / 2.0, -0.5);
        let mut walls = quad(CORNERS);
        walls.extend(quad([
            [0.0, 0.0, 0.0],
            [x, y, 0.0],
            [x, y, 1.0],
            [0.0, 0.0, 1.0],
        ]));
        let parts = smooth_parts(&walls).unwrap();
        for k in 0..60 {
            let angle = f64::from(k).to_radians() * 2.0;
            let at = 0.1 * DVec3::new(angle.cos(), angle.sin(), 5.0);
            let found = contacts(&parts, at, 0.11);
            let edge = DVec3::new(0.0, 0.0, 0.5);
            assert!(
                !found.is_empty() && !found.contains(&edge),
                "{angle}: {found:?}"
            );
        }
    }

    #[test]
    fn tree_finds_what_a_search_through_all_finds() {
        let facets = 90;
        let at = |k: usize, z: f64| {
            let angle = k as f64 * 2.0 * std::f64::consts::PI / facets as f64;
            DVec3::new(angle.cos(), angle.sin(), z)
        };
        let rim: Vec<[DVec3; 3]> = (0..facets)
            .flat_map(|k| {
                let [a, b, c, d] = [at(k, -1.0), at(k + 1, -1.0), at(k + 1, 1.0), at(k, 1.0)];
                [[a, c, b], [a, d, c]]
            })
            .collect();
        let parts = smooth_parts(&rim).unwrap();
        assert_eq!(
            parts.len(),
            1,
            "4° at each edge are smooth, and the last corner is the first"
        );
        for k in 0..500 {
            let angle = f64::from(k) * 0.7;
            let x = DVec3::new(angle.cos(), angle.sin(), 0.3) * (0.2 + 1e-3 * f64::from(k));
            let found = parts[0].nearest(x).unwrap();
            let least = rim
                .iter()
                .map(|t| (nearest_on_triangle(x, *t).0 - x).length());
            let least = least.fold(f64::INFINITY, f64::min);
            // The last corners are those of angle 0: a rounding from where they were stated.
            assert!(((found.point - x).length() - least).abs() < 1e-15);
        }
    }

    #[test]
    fn flaws_are_named() {
        let mut triangles = quad(CORNERS);
        assert_eq!(smooth_parts(&[]), Err(MeshFlaw::Empty));
        triangles.push([DVec3::ZERO, DVec3::X, DVec3::X * 2.0]);
        assert_eq!(smooth_parts(&triangles), Err(MeshFlaw::Degenerate(3)));
        triangles[2] = [DVec3::ZERO, DVec3::NAN, DVec3::X];
        assert_eq!(smooth_parts(&triangles), Err(MeshFlaw::NotFinite(3)));
        let apart: Vec<[DVec3; 3]> = (0..=MOST_PARTS)
            .map(|k| [DVec3::ZERO, DVec3::X, DVec3::Y].map(|x| x + DVec3::Z * k as f64))
            .collect();
        assert_eq!(
            smooth_parts(&apart),
            Err(MeshFlaw::TooManyParts(MOST_PARTS + 1))
        );
        let many = vec![triangles[0]; MOST_TRIANGLES + 1];
        assert_eq!(
            smooth_parts(&many),
            Err(MeshFlaw::TooMany(MOST_TRIANGLES + 1))
        );
    }
}
