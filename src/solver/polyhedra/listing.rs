//! Which features of a pair may touch before long: a list that is good until the bodies have moved
//! by its skin.
//!
//! In: two bodies. Out: every pair of their features nearer than the sum of the sphero-radii and
//! the skin, in order of [`Feature`], or none and how far apart the bodies are at least. Two convex
//! cores that a plane separates can only touch near that plane: the best of the face normals, or
//! the direction found last time, is that plane's, and only features within reach of it are tried
//! one by one. The list is a cache: whatever it holds beyond the touching features adds nothing to
//! any result.

use super::super::row::{sub, vector};
use super::bodies::{Geometry, Place, Shapes};
use super::nearest::{EdgeJob, FaceJob, Jobs, Nearest, OutlineJob, Places};
use crate::lanes::{Lanes, Row, dot, side_by_side};
use crate::world::Feature;

/// Two features that may touch before long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Listed {
    /// Which.
    pub feature: Feature,
    /// Of two edges their ends, by their numbers in the bodies; of a vertex and a face the edges of
    /// its outline that matter, bit by bit in two halves: none where the vertex is over the inside.
    marks: [u16; 4],
}

impl Listed {
    /// A vertex and a face, with those edges of its outline that matter.
    pub fn face(feature: Feature, sides: u32) -> Self {
        let marks = [sides as u16, (sides >> 16) as u16, 0, 0];
        Self { feature, marks }
    }

    /// Two features of bodies 0 and 1 wherever they are: of a face the whole outline matters.
    pub fn of(shapes: &Shapes, feature: Feature) -> Self {
        match feature {
            Feature::VertexFace(..) | Feature::FaceVertex(..) => Self::face(feature, u32::MAX),
            Feature::VertexVertex => Self::edges(feature, [0; 2], [0; 2]),
            Feature::EdgeEdge(first, second) => {
                let [along, across] = [0, 1].map(|body| shapes.edges_of(body));
                let (along, across) = (along[usize::from(first)], across[usize::from(second)]);
                Self::edges(feature, along, across)
            }
        }
    }

    /// Two edges and their ends.
    fn edges(feature: Feature, [p, q]: [u16; 2], [r, s]: [u16; 2]) -> Self {
        let marks = [p, q, r, s];
        Self { feature, marks }
    }

    /// Whether it is a vertex and a face: these come before edges.
    #[inline(always)]
    pub fn is_face(&self) -> bool {
        matches!(
            self.feature,
            Feature::VertexFace(..) | Feature::FaceVertex(..)
        )
    }

    /// Edges of the outline that matter, bit by bit.
    #[inline(always)]
    fn sides(&self) -> u32 {
        u32::from(self.marks[0]) | u32::from(self.marks[1]) << 16
    }
}

/// What a search needs again and again.
#[derive(Default)]
pub struct Search {
    /// Pairs of features that may be near each other.
    candidates: Vec<Listed>,
    /// Nearest points to compute.
    jobs: Jobs,
    /// The nearest points.
    results: Vec<Nearest>,
    /// Features of either body within reach of the separating plane.
    near: [NearFeatures; 2],
    /// Which vertices of a body are.
    marks: Vec<bool>,
}

/// Features of a body within reach of the separating plane, by their indices in the shape.
#[derive(Default)]
struct NearFeatures {
    /// Vertices.
    vertices: Vec<u16>,
    /// Edges of which an end is.
    edges: Vec<u16>,
    /// Faces of which a corner is.
    faces: Vec<u16>,
}

/// A direction from the first body to the second, and how far apart they are along it.
#[derive(Clone, Copy, Debug)]
struct Axis {
    /// Unit vector.
    direction: [f64; 3],
    /// Largest coordinate of the first body's core along it, and smallest of the second's [m].
    ends: [f64; 2],
}

impl Axis {
    /// How far apart they are along `direction`.
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
    /// The axis that separated them best last time, or about that; zero at the first time.
    pub axis: [f64; 3],
    /// Distance of the farthest point of the first from its centroid [m].
    pub reach: f64,
    /// Distance of cores at which they touch [m].
    pub touch: f64,
    /// How far the list reaches beyond [m].
    pub skin: f64,
}

impl Wanted {
    /// Distance of cores within which features are listed [m].
    fn cutoff(&self) -> f64 {
        self.touch + self.skin
    }

    /// How far the foot of a vertex near a face may move along that face while distances change by
    /// the skin [m]: a body that turns moves what is beyond its surface by more than any point of
    /// its own.
    fn leeway(&self) -> f64 {
        self.skin * (1.0 + (self.cutoff() + self.skin) / self.reach)
    }
}

/// What a search found.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// How far the two may move relative to each other before the list must be made anew [m].
    pub slack: f64,
    /// The axis that separates them best.
    pub axis: [f64; 3],
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
        list: &mut Vec<Listed>,
    ) -> Found {
        list.clear();
        let vertices = wanted.bodies.map(|body| geometry.vertices_of(body));
        let planes = wanted.bodies.map(|body| geometry.planes_of(body));
        let axis = separating_axis::<N>(processor, vertices, planes, wanted.axis);
        let mut found = Found {
            slack: wanted.skin,
            axis: axis.direction,
        };
        let cutoff = wanted.cutoff();
        if axis.gap() > cutoff {
            found.slack = axis.gap() - wanted.touch;
            return found;
        }
        self.collect_near(geometry, wanted, &axis, cutoff);
        self.collect_candidates(geometry.shapes, wanted);
        self.results.clear();
        self.results
            .resize(self.candidates.len(), Nearest::default());
        self.jobs
            .run::<N, true>(processor, &geometry.places, &mut self.results);
        let mut nearest = f64::INFINITY;
        for result in &self.results {
            let [nx, ny, nz, distance] = result.normal;
            if distance < nearest {
                nearest = distance;
                found.axis = [nx, ny, nz];
            }
        }
        self.keep_near(&geometry.places, wanted, list);
        if list.is_empty() {
            // The nearest features tell a better direction, which may separate the two by more.
            let gap = Axis::between(vertices, found.axis).gap();
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
        let [near_a, near_b] = &self.near;
        let candidates = &mut self.candidates;
        candidates.clear();
        let whole = |feature| Listed::face(feature, u32::MAX);
        for &vertex in &near_a.vertices {
            let meets = |&face: &u16| whole(Feature::VertexFace(vertex, face));
            candidates.extend(near_b.faces.iter().map(meets));
        }
        for &face in &near_a.faces {
            let meets = |&vertex: &u16| whole(Feature::FaceVertex(face, vertex));
            candidates.extend(near_b.vertices.iter().map(meets));
        }
        let spheres = wanted.bodies.map(|body| shapes.is_sphere(body));
        if spheres == [true; 2] {
            candidates.push(Listed::edges(Feature::VertexVertex, [0; 2], [0; 2]));
        } else if spheres == [false; 2] {
            // A sphere has a vertex, which meets faces, and no edge.
            let [edges_a, edges_b] = wanted.bodies.map(|body| shapes.edges_of(body));
            for &first in &near_a.edges {
                let along = edges_a[usize::from(first)];
                candidates.extend(near_b.edges.iter().map(|&second| {
                    let across = edges_b[usize::from(second)];
                    Listed::edges(Feature::EdgeEdge(first, second), along, across)
                }));
            }
        }
        self.jobs.clear();
        let starts = wanted.bodies.map(|body| shapes.places[body]);
        self.jobs.extend_sorted(shapes, &starts, candidates, 0);
    }

    /// Keeps the candidates nearer than the cutoff, each with what matters while the bodies move by
    /// the skin. A vertex behind a face is near nothing, but it may come round an edge of it.
    fn keep_near(&self, places: &Places<'_>, wanted: &Wanted, list: &mut Vec<Listed>) {
        let (cutoff, leeway) = (wanted.cutoff(), wanted.leeway());
        for (number, (listed, result)) in self.candidates.iter().zip(&self.results).enumerate() {
            let distance = result.normal[3];
            // Vertices and faces come before edges: their numbers are those of the outlines.
            let Some(job) = self.jobs.outlines.get(number) else {
                if distance < cutoff {
                    list.push(*listed);
                }
                continue;
            };
            let near_outline = result.middle[3] <= leeway;
            if distance < cutoff && !near_outline {
                list.push(Listed::face(listed.feature, 0));
            } else if near_outline && (distance < cutoff || distance == f64::INFINITY) {
                let sides = Sides::near(places, job, wanted.skin, leeway);
                if distance < cutoff || sides.nearest < cutoff {
                    list.push(Listed::face(listed.feature, sides.marks));
                }
            }
        }
    }
}

/// The edges of a face as a vertex sees them.
struct Sides {
    /// Those that matter, bit by bit.
    marks: u32,
    /// Distance of the nearest [m].
    nearest: f64,
}

impl Sides {
    /// Which edges of a face matter to a vertex while distances change by `skin` and its foot moves
    /// by `leeway` [m].
    fn near(places: &Places<'_>, job: &OutlineJob, skin: f64, leeway: f64) -> Self {
        let ends = |side: u32| job.ends(places.corners, side);
        let beside = || (0..job.count).map(|side| along_side(places, &job.face, ends(side)));
        let nearest = beside().fold(f64::INFINITY, |least, (_, distance)| least.min(distance));
        let matters = |(margin, distance): (f64, f64)| {
            margin <= 1.01 * leeway || distance <= nearest + 2.02 * skin
        };
        // Where there are more edges than bits, all matter.
        let marked = (0..).zip(beside()).filter(|(_, place)| matters(*place));
        let marks = marked.fold(0, |marks, (side, _)| marks | 1 << (side % u32::BITS));
        Self { marks, nearest }
    }
}

/// How far inside a `side` of a face the foot of a vertex lies, and how far the vertex is from that
/// edge [m].
fn along_side(places: &Places<'_>, job: &FaceJob, side: [u32; 2]) -> (f64, f64) {
    let [begin, end] = side.map(|corner| places.vertices[corner as usize]);
    let point = places.vertices[job.vertex as usize];
    let outward = vector(places.planes[job.face as usize]);
    let (edge, away) = (vector(sub(end, begin)), vector(sub(point, begin)));
    let margin = outward.cross(edge).dot(away) / edge.length();
    let foot = (away.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
    (margin, (foot * edge - away).length())
}

impl Jobs {
    /// Adds what there is to compute for features of the bodies whose features begin at `starts`:
    /// vertices with faces, then edges with edges. The results begin at `out`.
    #[inline(always)]
    pub fn extend(
        &mut self,
        shapes: &Shapes,
        starts: &[Place; 2],
        [faces, edges]: [impl ExactSizeIterator<Item = Listed>; 2],
        out: u32,
    ) {
        let edge_out = out + faces.len() as u32;
        // Either kind is written to the end of both queues and stays in its own: a branch would be
        // foretold wrongly half of the time.
        let (mut above, mut outlines) = (self.above.len(), self.outlines.len());
        self.above.resize(above + faces.len(), FaceJob::default());
        self.outlines
            .resize(outlines + faces.len(), OutlineJob::default());
        for (listed, out) in faces.zip(out..) {
            let (side, vertex, face) = match listed.feature {
                Feature::VertexFace(vertex, face) => (0, vertex, face),
                Feature::FaceVertex(face, vertex) => (1, vertex, face),
                Feature::EdgeEdge(..) | Feature::VertexVertex => (0, 0, 0),
            };
            let (of_vertex, of_face) = (&starts[side as usize], &starts[1 - side as usize]);
            let job = FaceJob {
                vertex: of_vertex.vertex + u32::from(vertex),
                face: of_face.face + u32::from(face),
                side,
                out,
            };
            let [corner, end] = [0, 1].map(|k| shapes.loop_starts[job.face as usize + k]);
            let bits = (end - corner).min(u32::BITS);
            let sides = listed.sides() & (u32::MAX >> (u32::BITS - bits));
            self.above[above] = job;
            self.outlines[outlines] = OutlineJob {
                face: job,
                sides,
                corner,
                count: end - corner,
                start: of_face.vertex,
            };
            above += usize::from(sides == 0);
            outlines += usize::from(sides != 0);
        }
        self.above.truncate(above);
        self.outlines.truncate(outlines);
        let starts = starts.map(|start| start.vertex);
        self.edges
            .extend(edges.zip(edge_out..).map(|(listed, out)| {
                let [p, q, r, s] = listed.marks.map(u32::from);
                let ends = [starts[0] + p, starts[0] + q, starts[1] + r, starts[1] + s];
                EdgeJob { ends, out }
            }));
    }

    /// Likewise, for features in their order.
    pub fn extend_sorted(
        &mut self,
        shapes: &Shapes,
        starts: &[Place; 2],
        listed: &[Listed],
        out: u32,
    ) {
        let (faces, edges) = listed.split_at(listed.partition_point(Listed::is_face));
        let kinds = [faces, edges].map(|kind| kind.iter().copied());
        self.extend(shapes, starts, kinds, out);
    }
}

/// Those of `near` that are nearer than `cutoff` by `results` [m], and vertices behind faces, which
/// may come round an edge at any time; returns the distance of the nearest of the others [m].
pub fn choose(near: &[Listed], results: &[Nearest], cutoff: f64, chosen: &mut Vec<Listed>) -> f64 {
    chosen.clear();
    let mut nearest = f64::INFINITY;
    for (listed, result) in near.iter().zip(results) {
        let distance = result.normal[3];
        if distance < cutoff || distance == f64::INFINITY {
            chosen.push(*listed);
        } else {
            nearest = nearest.min(distance);
        }
    }
    nearest
}

/// The direction that separates the two bodies best among the normals of their faces and `known`,
/// that of last time.
#[inline(always)]
fn separating_axis<N: Lanes>(
    processor: N::Processor,
    vertices: [&[Row]; 2],
    planes: [&[Row]; 2],
    known: [f64; 3],
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
    let first = Axis::between(vertices, face.or(known).unwrap_or_else(centres));
    match known.map(|direction| Axis::between(vertices, direction)) {
        Some(last) if last.gap() > first.gap() => last,
        _ => first,
    }
}
