//! The surface of a rounded polyhedron as triangles.
//!
//! In: a shape. Out: corners with normals, triangles, and the planes of its faces, all in the body
//! frame. Every corner lies on the surface of the body: each face of the core is moved outward by
//! the rounding radius as it is, a strip joins two faces along their edge and a cap closes each
//! vertex. So faces are exact, and a strip runs at most `R (1 − cos ½θ)` inside the cylinder that
//! it stands for, θ the angle between the faces' normals; its corners have the normals of the
//! faces, so that it is lit as if it were round.

use bevy::math::{Vec3, Vec4};
use glam::DVec3;
use grainfall::world::Polyhedron;

/// The surface of a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Facets {
    /// Places [m] and unit normals, one corner for each corner of each face.
    pub corners: Vec<(Vec3, Vec3)>,
    /// Three corners each, anticlockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Outward normal and distance from the origin [m] of each face of the body.
    pub planes: Vec<Vec4>,
}

impl Facets {
    /// The surface of `shape`, empty for a sphere.
    pub(super) fn of(shape: &Polyhedron) -> Self {
        let mut facets = Self::default();
        let half_edges = HalfEdges::of(shape);
        for face in &shape.faces {
            facets.face(shape, face);
        }
        if shape.rounding > 0.0 {
            facets.strips(shape, &half_edges);
            facets.caps(shape, &half_edges);
        }
        facets
    }

    fn face(&mut self, shape: &Polyhedron, face: &[u16]) {
        let normal = normal(shape, face);
        let first = self.corners.len() as u32;
        let mut farthest = f64::NEG_INFINITY;
        for vertex in face {
            let place = shape.vertices[usize::from(*vertex)] + shape.rounding * normal;
            farthest = farthest.max(place.dot(normal));
            self.corners.push((place.as_vec3(), normal.as_vec3()));
        }
        let fan = (2..face.len() as u32).map(|i| [first, first + i - 1, first + i]);
        self.triangles.extend(fan);
        self.planes.push(normal.as_vec3().extend(farthest as f32));
    }

    /// A strip along each edge.
    fn strips(&mut self, shape: &Polyhedron, half_edges: &HalfEdges) {
        for &[a, b] in &shape.edges {
            let (Some(left), Some(right)) = (half_edges.from(a, b), half_edges.from(b, a)) else {
                continue;
            };
            let [left_a, left_b] = [left.start, left.end];
            let [right_b, right_a] = [right.start, right.end];
            self.triangles.push([left_a, right_a, right_b]);
            self.triangles.push([left_a, right_b, left_b]);
        }
    }

    /// A cap round each vertex.
    fn caps(&mut self, shape: &Polyhedron, half_edges: &HalfEdges) {
        let mut ring = Vec::new();
        for vertex in 0..shape.vertices.len() as u16 {
            half_edges.round(vertex, &mut ring);
            let fan = (2..ring.len()).map(|i| [ring[0], ring[i - 1], ring[i]]);
            self.triangles.extend(fan);
        }
    }
}

/// Unit normal of a face by Newell's sum, which no short edge spoils.
fn normal(shape: &Polyhedron, face: &[u16]) -> DVec3 {
    let vertex = |i: usize| shape.vertices[usize::from(face[i % face.len()])];
    let sum = (0..face.len()).fold(DVec3::ZERO, |sum, i| sum + vertex(i).cross(vertex(i + 1)));
    sum.normalize_or_zero()
}

/// An edge as one of its two faces runs along it.
#[derive(Clone, Copy)]
struct HalfEdge {
    /// The face's corners at its two ends.
    start: u32,
    end: u32,
    /// Where the face came from when it reached the first end.
    before: u16,
}

/// The faces' edges by the vertices at their two ends.
struct HalfEdges {
    vertices: usize,
    from_to: Vec<Option<HalfEdge>>,
    /// Any edge that leaves each vertex.
    any: Vec<Option<u16>>,
}

impl HalfEdges {
    fn of(shape: &Polyhedron) -> Self {
        let vertices = shape.vertices.len();
        let mut half_edges = Self {
            vertices,
            from_to: vec![None; vertices * vertices],
            any: vec![None; vertices],
        };
        let mut first = 0;
        for face in &shape.faces {
            let count = face.len();
            for i in 0..count {
                let next = (i + 1) % count;
                let place = usize::from(face[i]) * vertices + usize::from(face[next]);
                half_edges.from_to[place] = Some(HalfEdge {
                    start: first + i as u32,
                    end: first + next as u32,
                    before: face[(i + count - 1) % count],
                });
                half_edges.any[usize::from(face[i])] = Some(face[next]);
            }
            first += count as u32;
        }
        half_edges
    }

    fn from(&self, a: u16, b: u16) -> Option<HalfEdge> {
        self.from_to[usize::from(a) * self.vertices + usize::from(b)]
    }

    /// The corners round `vertex`, anticlockwise seen from outside; none where the faces do not
    /// close round it.
    fn round(&self, vertex: u16, ring: &mut Vec<u32>) {
        ring.clear();
        let Some(first) = self.any[usize::from(vertex)] else {
            return;
        };
        let mut to = first;
        // As many faces as vertices meet at most: a bound for shapes whose faces do not close.
        for _ in 0..self.vertices {
            let Some(edge) = self.from(vertex, to) else {
                ring.clear();
                return;
            };
            ring.push(edge.start);
            // The face to the left of the edge that this face came along.
            to = edge.before;
            if to == first {
                return;
            }
        }
        ring.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::PI;

    /// A cube of half edge `a` with rounding `r`.
    pub(in crate::view) fn cube(a: f64, r: f64) -> Polyhedron {
        let vertices = (0..8_u8)
            .map(|i| {
                let sign = |bit: u8| if i >> bit & 1 == 0 { -a } else { a };
                DVec3::new(sign(0), sign(1), sign(2))
            })
            .collect();
        let faces: Vec<Vec<u16>> = vec![
            vec![0, 4, 6, 2],
            vec![1, 3, 7, 5],
            vec![0, 1, 5, 4],
            vec![2, 6, 7, 3],
            vec![0, 2, 3, 1],
            vec![4, 5, 7, 6],
        ];
        let mut edges = Vec::new();
        for face in &faces {
            for i in 0..4 {
                let (a, b) = (face[i], face[(i + 1) % 4]);
                if a < b {
                    edges.push([a, b]);
                }
            }
        }
        Polyhedron {
            vertices,
            edges,
            faces,
            rounding: r,
            volume: 8.0 * a * a * a,
            gyration: DVec3::splat(2.0 / 3.0 * a * a),
        }
    }

    /// Volume inside the triangles, by the divergence theorem.
    fn volume(facets: &Facets) -> f32 {
        let corner = |i: u32| facets.corners[i as usize].0;
        let of = |t: &[u32; 3]| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6.0;
        facets.triangles.iter().map(of).sum()
    }

    #[test]
    fn surface_of_a_rounded_cube_is_closed_and_turned_outwards() {
        let (a, r) = (1.0, 0.25);
        let facets = Facets::of(&cube(a, r));
        assert_eq!((facets.corners.len(), facets.planes.len()), (24, 6));
        // Each face 2, each edge 2, each vertex 1.
        assert_eq!(facets.triangles.len(), 12 + 24 + 8);
        let mut half_edges: Vec<_> = (facets.triangles.iter())
            .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
            .collect();
        half_edges.sort_unstable();
        for [a, b] in &half_edges {
            let back = half_edges.binary_search(&[*b, *a]);
            assert!(back.is_ok(), "the edge from {a} to {b} has one side only");
        }
        // Core, a slab on each face, half a square column along each edge, a sixth of a cube at
        // each vertex.
        let (a, r) = (a as f32, r as f32);
        let expected = (2.0 * a).powi(3)
            + 6.0 * (2.0 * a).powi(2) * r
            + 12.0 * 2.0 * a * r * r / 2.0
            + 8.0 * r.powi(3) / 6.0;
        // A hundred-thousandth: single precision.
        assert!((volume(&facets) / expected - 1.0).abs() < 1e-5);
    }

    #[test]
    fn corners_lie_on_the_surface_of_the_body() {
        let (a, r) = (1.0_f32, 0.25_f32);
        for (place, normal) in Facets::of(&cube(a.into(), r.into())).corners {
            let core = place.clamp(Vec3::splat(-a), Vec3::splat(a));
            // A millionth: single precision.
            assert!(((place - core).length() - r).abs() < 1e-6, "{place}");
            assert!((place - core - r * normal).length() < 1e-6, "{place}");
        }
    }

    #[test]
    fn prism_with_many_sides_has_the_volume_of_its_strips() {
        // A core of n-gons whose vertices have three faces each, no rounding: the volume is exact.
        let sides = 7_u16;
        let ring = |y: f64| {
            (0..sides).map(move |i| {
                let turn = 2.0 * std::f64::consts::PI * f64::from(i) / f64::from(sides);
                DVec3::new(turn.sin(), y, turn.cos())
            })
        };
        let mut faces = vec![(sides..2 * sides).collect(), (0..sides).rev().collect()];
        let mut edges = Vec::new();
        for i in 0..sides {
            let next = (i + 1) % sides;
            faces.push(vec![i, next, sides + next, sides + i]);
            edges.extend([[i, next], [sides + i, sides + next], [i, sides + i]]);
        }
        let shape = Polyhedron {
            vertices: ring(-0.5).chain(ring(0.5)).collect(),
            edges,
            faces,
            rounding: 0.0,
            volume: 1.0,
            gyration: DVec3::ONE,
        };
        let exact = f32::from(sides) / 2.0 * (2.0 * PI / f32::from(sides)).sin();
        // A hundred-thousandth: single precision.
        assert!((volume(&Facets::of(&shape)) / exact - 1.0).abs() < 1e-5);
        let rounded = Facets::of(&Polyhedron {
            rounding: 0.1,
            ..shape
        });
        // Two ends and seven sides, a strip along each edge, a triangle at each vertex.
        assert_eq!(rounded.triangles.len(), 2 * 5 + 7 * 2 + 21 * 2 + 14);
    }

    #[test]
    fn spheres_have_no_facets() {
        assert_eq!(Facets::of(&Polyhedron::sphere(1e-3)), Facets::default());
    }
}
