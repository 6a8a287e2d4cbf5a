//! Which features of a pair may touch before long: a list that is good until the bodies have moved
//! by its skin.
//!
//! In: two bodies. Out: every pair of their features nearer than the sum of the sphero-radii and
//! the skin, in order of [`Feature`], or none and how far apart the bodies are at least. Two convex
//! cores that a plane separates can only touch near that plane ([`super::separating_axis`]): only
//! features within reach of it are tried one by one. The list is a cache: whatever it holds beyond
//! the touching features adds nothing to any result.
//!
//! Not here: nearest points ([`super::nearest`]), when a list is made ([`super::workspace`]).

use super::super::row::{sub, vector};
use super::bodies::{Geometry, Shapes};
use super::listed::Listed;
use super::nearest::{FaceJob, Jobs, Nearest, OutlineJob, Places};
use super::separating_axis::{Axis, along};
use crate::lanes::Lanes;
use crate::world::Feature;

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
        let axis = Axis::separating::<N>(processor, vertices, planes, wanted.axis);
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
            let distance = result.distance();
            // Vertices and faces come before edges: their numbers are those of the outlines.
            let Some(job) = self.jobs.outlines.get(number) else {
                if result.least_distance() < cutoff {
                    list.push(*listed);
                }
                continue;
            };
            let near_outline = result.margin() <= leeway;
            if distance < cutoff && !near_outline {
                list.push(Listed::face(listed.feature, 0));
            } else if near_outline && (distance < cutoff || distance == f64::INFINITY) {
                let edges = OutlineEdges::near(places, job, wanted.skin, leeway);
                if distance < cutoff || edges.nearest < cutoff {
                    list.push(Listed::face(listed.feature, edges.marks));
                }
            }
        }
    }
}

/// The edges of a face as a vertex sees them.
struct OutlineEdges {
    /// Those that matter, bit by bit.
    marks: u32,
    /// Distance of the nearest [m].
    nearest: f64,
}

impl OutlineEdges {
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

/// Those of `near` that are nearer than `cutoff` by `results` [m], and vertices behind faces, which
/// may come round an edge at any time; returns the distance of the nearest of the others [m].
pub fn choose(near: &[Listed], results: &[Nearest], cutoff: f64, chosen: &mut Vec<Listed>) -> f64 {
    chosen.clear();
    let mut nearest = f64::INFINITY;
    for (listed, result) in near.iter().zip(results) {
        let distance = result.least_distance();
        if distance < cutoff || distance == f64::INFINITY {
            chosen.push(*listed);
        } else {
            nearest = nearest.min(distance);
        }
    }
    nearest
}
