//! Which features of a pair may touch before long: a list that is good until the bodies have moved by its skin.
//!
//! In: two bodies. Out: every pair of their features nearer than the sum of the rounding radii and the skin, in order of
//! [`Feature`], or none and how far apart the bodies are at least. Two convex cores that a plane parts can only touch near
//! that plane: the best of the face normals, or the direction found last time, is that plane's, and only features
//! within reach of it are tried one by one. The list is a cache: whatever it holds beyond the touching features adds
//! nothing to any result.

use super::super::lanes::{Lanes, Row, dot, side_by_side};
use super::bodies::{Place, Shapes};
use super::nearest::{EdgeJob, FaceJob, Geometry, Nearest, at_faces, between_edges};
use crate::world::Feature;
use std::ops::Range;

/// Two features that may touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Which.
    pub feature: Feature,
    /// Whether it is a vertex that stays over the inside of the face while the list is good.
    pub inside: bool,
}

/// What a search needs again and again.
#[derive(Default)]
pub struct Search {
    edges: Vec<EdgeJob>,
    faces: Vec<FaceJob>,
    features: Vec<Feature>,
    results: Vec<Nearest>,
    near: [NearFeatures; 2],
    marks: Vec<bool>,
}

/// Features of a body within reach of the parting plane, by their indices in the shape.
#[derive(Default)]
struct NearFeatures {
    vertices: Vec<u32>,
    edges: Vec<u32>,
    faces: Vec<u32>,
}

/// A direction from the first body to the second, and what it parts.
#[derive(Clone, Copy, Debug)]
struct Axis {
    direction: [f64; 3],
    /// Largest coordinate of the first body's core along it, and smallest of the second's [m].
    ends: [f64; 2],
}

impl Axis {
    /// What `direction` parts.
    fn between(
        shapes: &Shapes,
        geometry: &Geometry<'_>,
        bodies: [usize; 2],
        direction: [f64; 3],
    ) -> Self {
        let [a, b] = bodies.map(|body| features_of(shapes, body)[0].clone());
        Self {
            direction,
            ends: [
                extent(&geometry.vertices[a], direction)[1],
                extent(&geometry.vertices[b], direction)[0],
            ],
        }
    }

    /// Width of the gap between the two along it [m]; negative where they overlap.
    fn gap(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }
}

/// What a search is to find.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// The two bodies.
    pub bodies: [usize; 2],
    /// The direction that parted them best last time; zero at the first time.
    pub axis: Row,
    /// Distance of cores at which they touch [m].
    pub touch: f64,
    /// How far the list reaches beyond [m].
    pub skin: f64,
}

/// What a search found.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// How far the two may move relative to each other before the list must be made anew [m].
    pub slack: f64,
    /// The direction that parts them best.
    pub axis: Row,
}

/// Vertices, edges and faces of a body.
fn features_of(shapes: &Shapes, body: usize) -> [Range<usize>; 3] {
    let (from, to): (Place, Place) = (shapes.places[body], shapes.places[body + 1]);
    [
        from.vertex as usize..to.vertex as usize,
        from.edge as usize..to.edge as usize,
        from.face as usize..to.face as usize,
    ]
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

#[inline(always)]
fn along(v: Row, direction: [f64; 3]) -> f64 {
    v[0] * direction[0] + v[1] * direction[1] + v[2] * direction[2]
}

/// The face among `planes` from which `vertices` keep the largest distance, and that distance [m].
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

impl Search {
    /// Makes `list` the list that is `wanted`.
    #[inline(always)]
    pub fn run<N: Lanes>(
        &mut self,
        processor: N::Processor,
        shapes: &Shapes,
        geometry: &Geometry<'_>,
        wanted: &Wanted,
        list: &mut Vec<Entry>,
    ) -> Found {
        list.clear();
        let axis = parting_axis::<N>(processor, shapes, geometry, wanted);
        let [x, y, z] = axis.direction;
        let mut found = Found {
            slack: wanted.skin,
            axis: [x, y, z, 0.0],
        };
        let cutoff = wanted.touch + wanted.skin;
        if axis.gap() > cutoff {
            found.slack = axis.gap() - wanted.touch;
            return found;
        }
        self.collect_near(shapes, geometry, wanted, &axis, cutoff);
        self.collect_jobs(shapes, wanted);
        self.results.clear();
        self.results.resize(self.features.len(), Nearest::default());
        at_faces::<N, true>(processor, geometry, &self.faces, &mut self.results);
        between_edges::<N>(processor, geometry, &self.edges, &mut self.results);
        let mut nearest = f64::INFINITY;
        for (feature, result) in self.features.iter().zip(&self.results) {
            let [nx, ny, nz, distance] = result.normal;
            if distance < cutoff {
                let over_face = !matches!(feature, Feature::EdgeEdge(..) | Feature::VertexVertex);
                list.push(Entry {
                    feature: *feature,
                    inside: over_face && result.middle[3] > wanted.skin,
                });
            }
            if distance < nearest {
                nearest = distance;
                found.axis = [nx, ny, nz, 0.0];
            }
        }
        if list.is_empty() {
            // The nearest features tell a better direction, which may part the two by more.
            let [x, y, z, _] = found.axis;
            let gap = Axis::between(shapes, geometry, wanted.bodies, [x, y, z]).gap();
            found.slack = found.slack.max(gap - wanted.touch);
        }
        found
    }

    /// Features of both bodies that lie within `cutoff` of the other body along the axis.
    fn collect_near(
        &mut self,
        shapes: &Shapes,
        geometry: &Geometry<'_>,
        wanted: &Wanted,
        axis: &Axis,
        cutoff: f64,
    ) {
        for side in 0..2 {
            let [vertices, edges, faces] = features_of(shapes, wanted.bodies[side]);
            let near = &mut self.near[side];
            let first = vertices.start as u32;
            self.marks.clear();
            self.marks
                .extend(geometry.vertices[vertices].iter().map(|v| {
                    let place = along(*v, axis.direction);
                    if side == 0 {
                        place >= axis.ends[1] - cutoff
                    } else {
                        place <= axis.ends[0] + cutoff
                    }
                }));
            let marks = &self.marks;
            let marked = |v: &u32| marks[(v - first) as usize];
            near.vertices.clear();
            near.vertices
                .extend((0..marks.len() as u32).filter(|v| marks[*v as usize]));
            near.edges.clear();
            let begin = edges.start;
            near.edges.extend(
                edges
                    .filter(|&edge| shapes.edges[edge].iter().any(marked))
                    .map(|edge| (edge - begin) as u32),
            );
            near.faces.clear();
            let begin = faces.start;
            near.faces.extend(
                faces
                    .filter(|&face| geometry.outline(face as u32).iter().any(marked))
                    .map(|face| (face - begin) as u32),
            );
        }
    }

    /// Every pair of near features, in order.
    fn collect_jobs(&mut self, shapes: &Shapes, wanted: &Wanted) {
        let [a, b] = wanted.bodies.map(|body| shapes.places[body]);
        let [near_a, near_b] = &self.near;
        self.features.clear();
        self.faces.clear();
        self.edges.clear();
        for &vertex in &near_a.vertices {
            for &face in &near_b.faces {
                self.faces.push(FaceJob {
                    vertex: a.vertex + vertex,
                    face: b.face + face,
                    side: 0,
                    out: self.features.len() as u32,
                });
                self.features
                    .push(Feature::VertexFace(vertex as u16, face as u16));
            }
        }
        for &face in &near_a.faces {
            for &vertex in &near_b.vertices {
                self.faces.push(FaceJob {
                    vertex: b.vertex + vertex,
                    face: a.face + face,
                    side: 1,
                    out: self.features.len() as u32,
                });
                self.features
                    .push(Feature::FaceVertex(face as u16, vertex as u16));
            }
        }
        let spheres = wanted.bodies.map(|body| is_sphere(shapes, body));
        if spheres[0] != spheres[1] {
            // A sphere has a vertex, which meets faces, and no edge.
            return;
        }
        for &first in &near_a.edges {
            for &second in &near_b.edges {
                self.edges.push(edge_job(
                    shapes,
                    [a.edge + first, b.edge + second],
                    self.features.len() as u32,
                ));
                self.features.push(if spheres[0] {
                    Feature::VertexVertex
                } else {
                    Feature::EdgeEdge(first as u16, second as u16)
                });
            }
        }
    }
}

fn is_sphere(shapes: &Shapes, body: usize) -> bool {
    shapes.places[body + 1].vertex - shapes.places[body].vertex == 1
}

/// The job of two edges of the tables.
pub fn edge_job(shapes: &Shapes, [first, second]: [u32; 2], out: u32) -> EdgeJob {
    let ([a, b], [c, d]) = (shapes.edges[first as usize], shapes.edges[second as usize]);
    EdgeJob {
        ends: [a, b, c, d],
        out,
    }
}

/// The direction that parts the two bodies best among the normals of their faces and that of last time.
#[inline(always)]
fn parting_axis<N: Lanes>(
    processor: N::Processor,
    shapes: &Shapes,
    geometry: &Geometry<'_>,
    wanted: &Wanted,
) -> Axis {
    let [a, b] = wanted.bodies.map(|body| features_of(shapes, body));
    let vertices = [
        &geometry.vertices[a[0].clone()],
        &geometry.vertices[b[0].clone()],
    ];
    let planes = [
        &geometry.planes[a[2].clone()],
        &geometry.planes[b[2].clone()],
    ];
    let measured = |direction| Axis::between(shapes, geometry, wanted.bodies, direction);
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
    let [x, y, z, _] = wanted.axis;
    let known = (x * x + y * y + z * z > 0.0).then_some([x, y, z]);
    // Two spheres at the first time: along the line of their centres.
    let centres = || {
        let (p, q) = (vertices[0][0], vertices[1][0]);
        let d = [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        d.map(|x| if length > 0.0 { x / length } else { 0.0 })
    };
    let first = measured(face.or(known).unwrap_or_else(centres));
    match known.map(measured) {
        Some(last) if last.gap() > first.gap() => last,
        _ => first,
    }
}
