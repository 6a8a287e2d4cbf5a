//! Which features of a pair may touch before long: a list that is good until the bodies have moved by its skin.
//!
//! In: two bodies. Out: every pair of their features nearer than the sum of the rounding radii and the skin, in order of
//! [`Feature`], or none and how far apart the bodies are at least. Two convex cores that a plane parts can only touch near
//! that plane: the best of the face normals, or the direction found last time, is that plane's, and only features
//! within reach of it are tried one by one. The list is a cache: whatever it holds beyond the touching features adds
//! nothing to any result.

use super::super::lanes::{Lanes, Row, dot, side_by_side};
use super::super::row::{sub, vector};
use super::bodies::{Geometry, Shapes};
use super::nearest::{EdgeJob, FaceJob, Jobs, Nearest, OutlineJob, Places};
use crate::world::Feature;

/// The features of a pair that may touch, in order.
#[derive(Clone, Debug, Default)]
pub struct List {
    /// Which.
    pub features: Vec<Feature>,
    /// What to compute for them, numbered in that order.
    pub jobs: Jobs,
}

/// What a search needs again and again.
#[derive(Default)]
pub struct Search {
    candidates: List,
    results: Vec<Nearest>,
    near: [NearFeatures; 2],
    marks: Vec<bool>,
}

/// Features of a body within reach of the parting plane, by their indices in the shape.
#[derive(Default)]
struct NearFeatures {
    vertices: Vec<u16>,
    edges: Vec<u16>,
    faces: Vec<u16>,
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
    fn between(vertices: [&[Row]; 2], direction: [f64; 3]) -> Self {
        let [first, second] = vertices;
        Self {
            direction,
            ends: [extent(first, direction)[1], extent(second, direction)[0]],
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
        geometry: &Geometry<'_>,
        wanted: &Wanted,
        list: &mut List,
    ) -> Found {
        list.clear();
        let vertices = wanted.bodies.map(|body| geometry.vertices_of(body));
        let planes = wanted.bodies.map(|body| geometry.planes_of(body));
        let axis = parting_axis::<N>(processor, vertices, planes, wanted.axis);
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
        self.collect_near(geometry, wanted, &axis, cutoff);
        self.collect_candidates(geometry.shapes, wanted);
        self.results.clear();
        self.results
            .resize(self.candidates.features.len(), Nearest::default());
        let jobs = &self.candidates.jobs;
        jobs.run::<N, true>(processor, &geometry.places, &mut self.results);
        let mut nearest = f64::INFINITY;
        for result in &self.results {
            let [nx, ny, nz, distance] = result.normal;
            if distance < nearest {
                nearest = distance;
                found.axis = [nx, ny, nz, 0.0];
            }
        }
        self.keep_near(&geometry.places, cutoff, wanted.skin, list);
        if list.features.is_empty() {
            // The nearest features tell a better direction, which may part the two by more.
            let [x, y, z, _] = found.axis;
            let gap = Axis::between(vertices, [x, y, z]).gap();
            found.slack = found.slack.max(gap - wanted.touch);
        }
        found
    }

    /// Features of both bodies that lie within `cutoff` of the other body along the axis.
    fn collect_near(&mut self, geometry: &Geometry<'_>, wanted: &Wanted, axis: &Axis, cutoff: f64) {
        for side in 0..2 {
            let shapes = geometry.shapes;
            let body = wanted.bodies[side];
            let [_, edges, faces] = shapes.features_of(body);
            let near = &mut self.near[side];
            self.marks.clear();
            self.marks
                .extend(geometry.vertices_of(body).iter().map(|v| {
                    let place = along(*v, axis.direction);
                    if side == 0 {
                        place >= axis.ends[1] - cutoff
                    } else {
                        place <= axis.ends[0] + cutoff
                    }
                }));
            let marks = &self.marks;
            let marked = |v: &u16| marks[usize::from(*v)];
            near.vertices.clear();
            near.vertices
                .extend((0..marks.len() as u16).filter(|v| marked(v)));
            near.edges.clear();
            let ends = shapes.edges[edges].iter().zip(0..);
            near.edges.extend(
                ends.filter(|(ends, _)| ends.iter().any(marked))
                    .map(|(_, edge)| edge),
            );
            near.faces.clear();
            let outlines = faces.map(|face| shapes.outline(face)).zip(0..);
            near.faces.extend(
                outlines
                    .filter(|(outline, _)| outline.iter().any(marked))
                    .map(|(_, face)| face),
            );
        }
    }

    /// Every pair of near features, in order.
    fn collect_candidates(&mut self, shapes: &Shapes, wanted: &Wanted) {
        let [a, b] = wanted.bodies.map(|body| shapes.features_of(body));
        let [near_a, near_b] = &self.near;
        let list = &mut self.candidates;
        list.clear();
        let [starts_a, starts_b] = [&a, &b].map(|of| [0, 1, 2].map(|kind| of[kind].start as u32));
        for &vertex in &near_a.vertices {
            for &face in &near_b.faces {
                let job = FaceJob {
                    vertex: starts_a[0] + u32::from(vertex),
                    face: starts_b[2] + u32::from(face),
                    side: 0,
                    out: 0,
                };
                list.push_outline(shapes, Feature::VertexFace(vertex, face), job, starts_b[0]);
            }
        }
        for &face in &near_a.faces {
            for &vertex in &near_b.vertices {
                let job = FaceJob {
                    vertex: starts_b[0] + u32::from(vertex),
                    face: starts_a[2] + u32::from(face),
                    side: 1,
                    out: 0,
                };
                list.push_outline(shapes, Feature::FaceVertex(face, vertex), job, starts_a[0]);
            }
        }
        let spheres = [&a[0], &b[0]].map(|vertices| vertices.len() == 1);
        if spheres[0] != spheres[1] {
            // A sphere has a vertex, which meets faces, and no edge.
            return;
        }
        for &first in &near_a.edges {
            for &second in &near_b.edges {
                let [p, q] = shapes.edges[a[1].start + usize::from(first)];
                let [r, s] = shapes.edges[b[1].start + usize::from(second)];
                let [p, q] = [p, q].map(|vertex| starts_a[0] + u32::from(vertex));
                let [r, s] = [r, s].map(|vertex| starts_b[0] + u32::from(vertex));
                list.jobs.edges.push(EdgeJob {
                    ends: [p, q, r, s],
                    out: list.features.len() as u32,
                });
                list.features.push(if spheres[0] {
                    Feature::VertexVertex
                } else {
                    Feature::EdgeEdge(first, second)
                });
            }
        }
    }

    /// Keeps the candidates nearer than `cutoff`, each with what matters while the bodies move by `skin`.
    fn keep_near(&self, places: &Places<'_>, cutoff: f64, skin: f64, list: &mut List) {
        let Jobs {
            outlines,
            sides,
            edges,
            ..
        } = &self.candidates.jobs;
        for job in outlines {
            let candidate = job.face.out as usize;
            let result = &self.results[candidate];
            if result.normal[3] >= cutoff {
                continue;
            }
            let face = FaceJob {
                out: list.features.len() as u32,
                ..job.face
            };
            list.features.push(self.candidates.features[candidate]);
            if result.middle[3] > skin {
                list.jobs.above.push(face);
                continue;
            }
            let first = list.jobs.sides.len() as u32;
            let all = &sides[job.first as usize..(job.first + job.count) as usize];
            let beside = || all.iter().map(|side| along_side(places, &face, *side));
            let nearest = beside().fold(f64::INFINITY, |least, (_, distance)| least.min(distance));
            // Every distance changes by the skin at most.
            let matters = |(margin, distance): (f64, f64)| {
                margin <= 1.01 * skin || distance <= nearest + 2.02 * skin
            };
            let kept = all
                .iter()
                .zip(beside())
                .filter(|(_, place)| matters(*place));
            list.jobs.sides.extend(kept.map(|(side, _)| *side));
            let count = list.jobs.sides.len() as u32 - first;
            list.jobs.outlines.push(OutlineJob { face, first, count });
        }
        for job in edges {
            let candidate = job.out as usize;
            if self.results[candidate].normal[3] < cutoff {
                list.jobs.edges.push(EdgeJob {
                    out: list.features.len() as u32,
                    ..*job
                });
                list.features.push(self.candidates.features[candidate]);
            }
        }
    }
}

/// How far inside a `side` of a face the foot of a vertex lies, and how far the vertex is from that edge [m].
fn along_side(places: &Places<'_>, job: &FaceJob, side: [u32; 2]) -> (f64, f64) {
    let [begin, end] = side.map(|corner| places.vertices[corner as usize]);
    let point = places.vertices[job.vertex as usize];
    let outward = vector(places.planes[job.face as usize]);
    let (edge, away) = (vector(sub(end, begin)), vector(sub(point, begin)));
    let margin = outward.cross(edge).dot(away) / edge.length();
    let foot = (away.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
    (margin, (foot * edge - away).length())
}

impl List {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.features.clear();
        self.jobs.clear();
    }

    /// Becomes a copy of `other`, in no more memory than that takes: there are a few of these for every grain.
    pub fn copy(&mut self, other: &Self) {
        self.features.clone_from(&other.features);
        self.jobs.above.clone_from(&other.jobs.above);
        self.jobs.outlines.clone_from(&other.jobs.outlines);
        self.jobs.sides.clone_from(&other.jobs.sides);
        self.jobs.edges.clone_from(&other.jobs.edges);
    }

    /// Becomes the part of `all` that is nearer than `cutoff` [m] by `results`, of which its own move to the front. Returns the
    /// distance of the nearest of the others [m]. `numbers` is room to work in.
    pub fn choose(
        &mut self,
        all: &Self,
        results: &mut [Nearest],
        cutoff: f64,
        numbers: &mut Vec<u32>,
    ) -> f64 {
        const GONE: u32 = u32::MAX;
        self.clear();
        numbers.clear();
        let mut nearest = f64::INFINITY;
        for (slot, feature) in all.features.iter().enumerate() {
            let distance = results[slot].normal[3];
            if distance < cutoff {
                let number = self.features.len();
                numbers.push(number as u32);
                self.features.push(*feature);
                results[number] = results[slot];
            } else {
                numbers.push(GONE);
                nearest = nearest.min(distance);
            }
        }
        let moved = |job: &FaceJob| {
            let out = numbers[job.out as usize];
            (out != GONE).then_some(FaceJob { out, ..*job })
        };
        let jobs = &mut self.jobs;
        jobs.above.extend(all.jobs.above.iter().filter_map(moved));
        for job in &all.jobs.outlines {
            let Some(face) = moved(&job.face) else {
                continue;
            };
            let first = jobs.sides.len() as u32;
            let sides = &all.jobs.sides[job.first as usize..];
            jobs.sides.extend_from_slice(&sides[..job.count as usize]);
            jobs.outlines.push(OutlineJob {
                face,
                first,
                ..*job
            });
        }
        jobs.edges.extend(all.jobs.edges.iter().filter_map(|job| {
            let out = numbers[job.out as usize];
            (out != GONE).then_some(EdgeJob { out, ..*job })
        }));
        nearest
    }

    /// A vertex and a face with all its edges; the vertices of the face's body begin at `start`.
    fn push_outline(&mut self, shapes: &Shapes, feature: Feature, job: FaceJob, start: u32) {
        let outline = shapes.outline(job.face as usize);
        let first = self.jobs.sides.len() as u32;
        let next = outline.iter().skip(1).chain(outline.first());
        let sides = outline.iter().zip(next);
        let placed = |(a, b): (&u16, &u16)| [*a, *b].map(|corner| start + u32::from(corner));
        self.jobs.sides.extend(sides.map(placed));
        self.jobs.outlines.push(OutlineJob {
            face: FaceJob {
                out: self.features.len() as u32,
                ..job
            },
            first,
            count: outline.len() as u32,
        });
        self.features.push(feature);
    }
}

/// The direction that parts the two bodies best among the normals of their faces and `known`, that of last time.
#[inline(always)]
fn parting_axis<N: Lanes>(
    processor: N::Processor,
    vertices: [&[Row]; 2],
    planes: [&[Row]; 2],
    known: Row,
) -> Axis {
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
    let [x, y, z, _] = known;
    let known = (x * x + y * y + z * z > 0.0).then_some([x, y, z]);
    // Two spheres at the first time: along the line of their centres.
    let centres = || {
        let (p, q) = (vertices[0][0], vertices[1][0]);
        let d = [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        d.map(|x| if length > 0.0 { x / length } else { 0.0 })
    };
    let first = Axis::between(vertices, face.or(known).unwrap_or_else(centres));
    match known.map(|direction| Axis::between(vertices, direction)) {
        Some(last) if last.gap() > first.gap() => last,
        _ => first,
    }
}
