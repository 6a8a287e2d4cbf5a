//! Nearest points of two features: an edge and an edge, a vertex and a face.
//!
//! In: jobs that name vertices and faces by their indices in the world's tables. Out: for each the
//! unit vector from the first body to the second, the distance, and the point in the middle. Each
//! is computed in lanes, every lane for itself.
//!
//! | job | nearest points | where |
//! |---|---|---|
//! | [`FaceJob`] | vertex, its foot on the plane | the foot is known to lie inside the outline |
//! | [`OutlineJob`] | vertex, its foot on the plane or on an edge of the face | anywhere near the outline |
//! | [`EdgeJob`] | points on either edge | a sphere is an edge of no length |
//!
//! Distances are those of cores: features touch where theirs is less than the sum of the
//! sphero-radii. Lengths are in metres, positions in the frame of the world.
//!
//! Not here: which features are worth a job ([`super::listing`]), overlaps ([`super::forces`]).

use crate::lanes::{Lanes, Quad, Row, Rows, WIDEST, cross, dot, minus, plus, side_by_side, times};

/// Nearest points of two features.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nearest {
    /// Unit vector from the point of the first body to that of the second; their distance [m],
    /// infinite for a vertex behind a face.
    pub normal: Row,
    /// The point halfway [m]; how much nearer the features may be elsewhere, or the margin where that
    /// was asked for, later the overlap [m].
    pub middle: Row,
}

impl Nearest {
    /// How far the two points are apart [m]; infinite for a vertex behind a face.
    #[inline(always)]
    pub fn distance(&self) -> f64 {
        self.normal[3]
    }

    /// How far they are apart at least, wherever that is [m]: edges that count as parallel are
    /// measured in the middle of what they have beside each other, and as soon as they no longer
    /// count so at the end that is nearest.
    #[inline(always)]
    pub fn least_distance(&self) -> f64 {
        self.normal[3] - self.middle[3]
    }

    /// How far the vertex lies inside the face's outline [m], negative outside, where that was
    /// asked for.
    #[inline(always)]
    pub fn margin(&self) -> f64 {
        self.middle[3]
    }

    /// By how much the features overlap, once that is known [m].
    #[inline(always)]
    pub fn overlap(&self) -> f64 {
        self.middle[3]
    }

    /// Takes note of it, in the place of the margin.
    #[inline(always)]
    pub fn set_overlap(&mut self, overlap: f64) {
        self.middle[3] = overlap;
    }
}

/// Two edges.
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeJob {
    /// Where the ends of the first body's edge are, then those of the second's.
    pub ends: [u32; 4],
    /// Number of the result.
    pub out: u32,
}

/// A vertex of one body and a face of the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct FaceJob {
    /// Where the vertex is.
    pub vertex: u32,
    /// Where the face is.
    pub face: u32,
    /// 0 where the vertex is the first body's, 1 where it is the second's.
    pub side: u32,
    /// Number of the result.
    pub out: u32,
}

/// A vertex and a face near whose outline it stands.
#[derive(Clone, Copy, Debug, Default)]
pub struct OutlineJob {
    /// Vertex and face.
    pub face: FaceJob,
    /// The edges of the face that matter, bit by bit, at least one; of more than 32 all do.
    pub sides: u32,
    /// Where the face's vertices begin in [`Places::corners`], anticlockwise seen from outside.
    pub corner: u32,
    /// How many they are.
    pub count: u32,
    /// Where the vertices of the face's body begin.
    pub start: u32,
}

impl OutlineJob {
    /// How many edges matter.
    #[inline(always)]
    fn side_count(&self) -> u32 {
        if self.count > u32::BITS {
            self.count
        } else {
            self.sides.count_ones()
        }
    }

    /// The first edge that matters from `side` on; the last one again after the last one.
    #[inline(always)]
    fn side_from(&self, side: u32) -> u32 {
        if self.count > u32::BITS {
            return side.min(self.count - 1);
        }
        let rest = self.sides & u32::MAX.checked_shl(side).unwrap_or(0);
        if rest == 0 {
            u32::BITS - 1 - self.sides.leading_zeros()
        } else {
            rest.trailing_zeros()
        }
    }

    /// Where the ends of `side` are.
    #[inline(always)]
    pub fn ends(&self, corners: &[u16], side: u32) -> [u32; 2] {
        let next = if side + 1 < self.count { side + 1 } else { 0 };
        [side, next].map(|k| self.start + u32::from(corners[(self.corner + k) as usize]))
    }
}

/// Features to compute the nearest points of.
#[derive(Clone, Debug, Default)]
pub struct Jobs {
    /// Vertices over the inside of faces.
    pub above: Vec<FaceJob>,
    /// Vertices near the outlines of faces.
    pub outlines: Vec<OutlineJob>,
    /// Pairs of edges.
    pub edges: Vec<EdgeJob>,
}

impl Jobs {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.above.clear();
        self.outlines.clear();
        self.edges.clear();
    }

    /// Computes all; without `MARGIN` no companion of a middle counts.
    #[inline(always)]
    pub fn run<N: Lanes, const MARGIN: bool>(
        &self,
        processor: N::Processor,
        places: &Places<'_>,
        results: &mut [Nearest],
    ) {
        above_faces::<N>(processor, places, &self.above, results);
        at_outlines::<N, MARGIN>(processor, places, &self.outlines, results);
        between_edges::<N>(processor, places, &self.edges, results);
    }
}

/// Vertices and faces of all bodies where they are now.
#[derive(Clone, Copy)]
pub struct Places<'a> {
    /// Vertices [m].
    pub vertices: &'a [Row],
    /// Outward unit normals of the faces; distances of their planes from the origin [m].
    pub planes: &'a [Row],
    /// Vertices of the faces, face by face, by their numbers in the body.
    pub corners: &'a [u16],
}

impl<'a> Places<'a> {
    /// A vertex, by its number in the world.
    #[inline(always)]
    fn vertex(&self, index: u32) -> &'a Row {
        &self.vertices[index as usize]
    }

    /// A plane, by the number of its face in the world.
    #[inline(always)]
    fn plane(&self, index: u32) -> &'a Row {
        &self.planes[index as usize]
    }
}

/// As many items as there are lanes; where fewer are left, the last one fills up.
#[inline(always)]
pub fn group<N: Lanes, T>(items: &[T]) -> [&T; WIDEST] {
    let last = items.len() - 1;
    side_by_side::<N, _>(|k| &items[k.min(last)])
}

/// Sines squared below which two edges count as parallel: the middle of their overlap is taken
/// then.
pub const PARALLEL: f64 = 1e-10;
/// What rounding makes of the square of a sine.
const ROUNDING: f64 = 1e-15;

/// `x` between `zero` and `one`.
#[inline(always)]
fn clamp<N: Lanes>(x: N, zero: N, one: N) -> N {
    let x = N::choose(x.exceeds(zero), x, zero);
    N::choose(x.exceeds(one), one, x)
}

/// The smaller of two.
#[inline(always)]
fn smaller<N: Lanes>(a: N, b: N) -> N {
    N::choose(a.exceeds(b), b, a)
}

/// The vector part.
#[inline(always)]
fn vector<N: Lanes>([x, y, z, _]: [N; 4]) -> [N; 3] {
    [x, y, z]
}

/// Nearest points of pairs of edges.
#[inline(always)]
fn between_edges<N: Lanes>(
    processor: N::Processor,
    places: &Places<'_>,
    jobs: &[EdgeJob],
    results: &mut [Nearest],
) {
    for chunk in jobs.chunks(N::COUNT) {
        let all = group::<N, _>(chunk);
        let p0 = side_by_side::<N, _>(|k| places.vertex(all[k].ends[0]));
        let p1 = side_by_side::<N, _>(|k| places.vertex(all[k].ends[1]));
        let q0 = side_by_side::<N, _>(|k| places.vertex(all[k].ends[2]));
        let q1 = side_by_side::<N, _>(|k| places.vertex(all[k].ends[3]));
        let from = vector(N::gather(processor, p0));
        let other = vector(N::gather(processor, q0));
        let along = vector(N::gather_difference(processor, p1, p0));
        let across = vector(N::gather_difference(processor, q1, q0));
        let (s, t, nearer) = on_edges(processor, minus(from, other), along, across);
        let (p, q) = (plus(from, times(along, s)), plus(other, times(across, t)));
        let apart = minus(q, p);
        let distance = dot(apart, apart).sqrt();
        let normal = times(apart, N::splat(processor, 1.0) / distance);
        let middle = times(plus(p, q), N::splat(processor, 0.5));
        let normals = N::rows([normal[0], normal[1], normal[2], distance]);
        let middles = N::rows([middle[0], middle[1], middle[2], nearer]);
        for (k, job) in chunk.iter().enumerate() {
            results[job.out as usize] = Nearest {
                normal: normals[k].row(),
                middle: middles[k].row(),
            };
        }
    }
}

/// Where on the edges `along` and `across`, the first beginning at `offset` from the second, the
/// nearest points lie (0 at the beginning, 1 at the end).
///
/// With the edges `u` and `v` and the way `w` from the beginning of the second to that of the
/// first, the squared distance `|w + s u − t v|²` is least at `s = (b f − c e)/(a e − b²)` and
/// `t = (b s + f)/e`, where `a = u·u`, `e = v·v`, `b = u·v`, `c = u·w` and `f = v·w`. Where `t`
/// falls beyond an end it is put there, and `s` is where the first edge is nearest to that end.
/// Edges that are parallel meet all along what they have beside each other: its middle is taken, and
/// elsewhere they may be nearer by the sine of their angle times the length of the first, which is
/// told, too [m].
#[inline(always)]
fn on_edges<N: Lanes>(
    processor: N::Processor,
    offset: [N; 3],
    along: [N; 3],
    across: [N; 3],
) -> (N, N, N) {
    let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
    let (a, e, b) = (dot(along, along), dot(across, across), dot(along, across));
    let (c, f) = (dot(along, offset), dot(across, offset));
    let square = a * e;
    let sine = square - b * b;
    let skew = sine.exceeds(N::splat(processor, PARALLEL) * square);
    let crossing = (b * f - c * e) / sine;
    // What of the first edge lies beside the ends of the second.
    let at_begin = clamp(-c / a, zero, one);
    let at_end = clamp((b - c) / a, zero, one);
    let beside = N::splat(processor, 0.5) * (at_begin + at_end);
    let s = N::choose(skew, clamp(crossing, zero, one), beside);
    let free = (b * s + f) / e;
    let t = clamp(free, zero, one);
    // Beyond an end of the second edge that end is nearest.
    let s = N::choose(zero.exceeds(free), at_begin, s);
    let s = N::choose(free.exceeds(one), at_end, s);
    let rise = N::choose(sine.exceeds(zero), sine, zero) + N::splat(processor, ROUNDING) * square;
    let rise = (rise / e).sqrt();
    // An edge of no length is nowhere nearer.
    let is_nearer = N::choose(skew, zero, rise);
    (s, t, N::choose(is_nearer.exceeds(zero), rise, zero))
}

/// Signs of the vector and its companion that turn "from the vertex to the face" into "from the
/// first to the second".
const TURN: [Row; 2] = [[1.0, 1.0, 1.0, 1.0], [-1.0, -1.0, -1.0, 1.0]];

/// Nearest points of vertices and faces on which they stand: those whose foot is known to lie
/// inside the outline.
#[inline(always)]
fn above_faces<N: Lanes>(
    processor: N::Processor,
    places: &Places<'_>,
    jobs: &[FaceJob],
    results: &mut [Nearest],
) {
    for chunk in jobs.chunks(N::COUNT) {
        let all = group::<N, _>(chunk);
        let vertex = side_by_side::<N, _>(|k| places.vertex(all[k].vertex));
        let plane = side_by_side::<N, _>(|k| places.plane(all[k].face));
        let point = vector(N::gather(processor, vertex));
        let [nx, ny, nz, offset] = N::gather(processor, plane);
        let outward = [nx, ny, nz];
        let height = dot(outward, point) - offset;
        let (normal, distance, middle) = on_plane(processor, point, outward, height);
        let normals = N::rows([normal[0], normal[1], normal[2], distance]);
        let middles = N::rows([middle[0], middle[1], middle[2], N::splat(processor, 0.0)]);
        for (k, job) in chunk.iter().enumerate() {
            let turn = N::Quad::load(processor, &TURN[job.side as usize]);
            results[job.out as usize] = Nearest {
                normal: (normals[k] * turn).row(),
                middle: middles[k].row(),
            };
        }
    }
}

/// A point at a signed `height` above a face, over its inside: behind it nothing is near.
#[inline(always)]
fn on_plane<N: Lanes>(
    processor: N::Processor,
    point: [N; 3],
    outward: [N; 3],
    height: N,
) -> ([N; 3], N, [N; 3]) {
    let above = height.exceeds(N::splat(processor, 0.0));
    let distance = N::choose(above, height, N::splat(processor, f64::INFINITY));
    let half = N::splat(processor, 0.5) * height;
    (
        [-outward[0], -outward[1], -outward[2]],
        distance,
        minus(point, times(outward, half)),
    )
}

/// The outlines of faces as vertices side by side see them.
struct Outlines<N> {
    /// Vectors from the vertices to the nearest points of the edges that were looked at [m].
    to_edge: [N; 3],
    /// Squares of their lengths [m²].
    square: N,
    /// How far inside these edges the feet of the vertices lie, times the length of an edge unless
    /// the margin itself was asked for; negative outside.
    inside: N,
}

/// Looks at the edges of the outlines that the jobs name. With `MARGIN` it is told how far inside
/// them the feet of the vertices lie [m].
#[inline(always)]
fn look_at_outlines<N: Lanes, const MARGIN: bool>(
    processor: N::Processor,
    places: &Places<'_>,
    jobs: &[OutlineJob],
    vertex: Rows<'_>,
    outward: [N; 3],
) -> Outlines<N> {
    let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
    let all = group::<N, _>(jobs);
    let mut to_nearest = [zero; 3];
    let mut square = N::splat(processor, f64::INFINITY);
    let mut inside = N::splat(processor, f64::INFINITY);
    let mut count = 0;
    for job in jobs {
        count = count.max(job.side_count());
    }
    let mut next = [0; WIDEST];
    for _ in 0..count {
        let ends = side_by_side::<N, _>(|k| {
            let side = all[k].side_from(next[k]);
            (side, all[k].ends(places.corners, side))
        });
        next = ends.map(|(side, _)| side + 1);
        let begin = side_by_side::<N, _>(|k| places.vertex(ends[k].1[0]));
        let end = side_by_side::<N, _>(|k| places.vertex(ends[k].1[1]));
        let edge = vector(N::gather_difference(processor, end, begin));
        let away = vector(N::gather_difference(processor, vertex, begin));
        let length = dot(edge, edge);
        let foot = clamp(dot(away, edge) / length, zero, one);
        let to_edge = minus(times(edge, foot), away);
        let to_edge_square = dot(to_edge, to_edge);
        let closer = square.exceeds(to_edge_square);
        for axis in 0..3 {
            to_nearest[axis] = N::choose(closer, to_edge[axis], to_nearest[axis]);
        }
        square = N::choose(closer, to_edge_square, square);
        let mut within = dot(cross(outward, edge), away);
        if MARGIN {
            within = within / length.sqrt();
        }
        inside = smaller(inside, within);
    }
    Outlines {
        to_edge: to_nearest,
        square,
        inside,
    }
}

/// Nearest points of vertices and faces, wherever the vertices are: of the outlines only the edges
/// named matter. With `MARGIN` the companion of the middle tells how far inside these edges the
/// foot of the vertex lies [m], negative outside.
#[inline(always)]
fn at_outlines<N: Lanes, const MARGIN: bool>(
    processor: N::Processor,
    places: &Places<'_>,
    jobs: &[OutlineJob],
    results: &mut [Nearest],
) {
    let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
    for chunk in jobs.chunks(N::COUNT) {
        let all = group::<N, _>(chunk);
        let vertex = side_by_side::<N, _>(|k| places.vertex(all[k].face.vertex));
        let plane = side_by_side::<N, _>(|k| places.plane(all[k].face.face));
        let point = vector(N::gather(processor, vertex));
        let [nx, ny, nz, offset] = N::gather(processor, plane);
        let outward = [nx, ny, nz];
        let height = dot(outward, point) - offset;
        let seen = look_at_outlines::<N, MARGIN>(processor, places, chunk, vertex, outward);

        let (below, at_height, foot_middle) = on_plane(processor, point, outward, height);
        let distance = seen.square.sqrt();
        let over = seen.inside.exceeds(zero);
        let inverse = one / distance;
        let half = N::splat(processor, 0.5);
        let mut normal = [zero; 3];
        let mut middle = [zero; 3];
        for axis in 0..3 {
            let to_edge = seen.to_edge[axis];
            normal[axis] = N::choose(over, below[axis], to_edge * inverse);
            middle[axis] = N::choose(over, foot_middle[axis], point[axis] + half * to_edge);
        }
        let distance = N::choose(over, at_height, distance);
        let normals = N::rows([normal[0], normal[1], normal[2], distance]);
        let margin = if MARGIN { seen.inside } else { zero };
        let middles = N::rows([middle[0], middle[1], middle[2], margin]);
        for (k, job) in chunk.iter().enumerate() {
            let turn = N::Quad::load(processor, &TURN[job.face.side as usize]);
            results[job.face.out as usize] = Nearest {
                normal: (normals[k] * turn).row(),
                middle: middles[k].row(),
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The edges that are looked at, in order.
    fn looked_at(sides: u32, count: u32) -> Vec<u32> {
        let job = OutlineJob {
            sides,
            count,
            ..OutlineJob::default()
        };
        let mut next = 0;
        let mut step = |_| {
            let side = job.side_from(next);
            next = side + 1;
            side
        };
        (0..job.side_count())
            .map(&mut step)
            .chain([99, 99].map(|_| job.side_from(count)))
            .collect()
    }

    #[test]
    fn marked_sides_are_looked_at_one_by_one_and_the_last_again() {
        assert_eq!(looked_at(0b1011, 5), [0, 1, 3, 3, 3]);
        assert_eq!(looked_at(1 << 31 | 1, 32), [0, 31, 31, 31]);
        assert_eq!(looked_at(1, 3), [0, 0, 0]);
        assert_eq!(looked_at(1, 34).len(), 36);
        assert_eq!(looked_at(1, 34)[33..], [33, 33, 33]);
    }
}
