//! A convex solid with plane faces: cutting, merging, integrals.
//!
//! In: a box, points or half-spaces. Out: corners and faces, volume, centroid and second moments,
//! the solid eroded by a depth. Everything is computed with additions, multiplications, divisions
//! and square roots alone, so that the bits do not depend on the machine.

use glam::{DMat3, DQuat, DVec3};

/// Distance from a plane, in sizes of the solid, below which a corner counts as lying in it.
/// Rounding is a ten-thousandth of it.
const SLACK: f64 = 1e-12;
/// Corners nearer to each other than this, in sizes of the solid, are made one by
/// [`Solid::merged`].
const SAME_CORNER: f64 = 1e-7;
/// Turns after which the Jacobi iteration ends; four or five do.
const MOST_SWEEPS: usize = 20;
/// Products of inertia below this part of the second moments count as zero: the axes of a cube are
/// then its edges.
const NO_PRODUCT: f64 = 1e-14;

/// All points `x` with `normal · x ≤ offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Unit normal, outwards.
    pub normal: DVec3,
    /// Distance of the plane from the origin along the normal [m].
    pub offset: f64,
}

/// A convex solid. An empty one has neither corners nor faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Its corners [m].
    pub vertices: Vec<DVec3>,
    /// Its faces: each a loop of corners, anticlockwise seen from outside.
    pub faces: Vec<Vec<u16>>,
    /// Largest extent of its corners, or of those of the box that it was cut from [m].
    size: f64,
}

/// Integrals over a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Volume [m³].
    pub volume: f64,
    /// Centroid [m].
    pub centroid: DVec3,
    /// Second moments about the centroid, `∫ (x − c)(x − c)ᵀ dV` [m⁵].
    pub second: DMat3,
}

/// What a [`Solid`] is not allowed to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Flaw {
    /// It has no volume.
    #[error("it encloses no volume")]
    Empty,
    /// An edge does not lie in exactly two faces that run along it in opposite directions.
    #[error("an edge does not join two faces")]
    Open,
    /// Corners, edges and faces do not satisfy `V − E + F = 2`.
    #[error("it is not one closed surface")]
    Euler,
    /// A corner lies outside of a face, or a face's loop turns the wrong way.
    #[error("it is not convex")]
    NotConvex,
}

impl Solid {
    /// The solid with these corners [m] and faces, each a loop of corners, anticlockwise seen from
    /// outside.
    pub fn new(vertices: Vec<DVec3>, faces: Vec<Vec<u16>>) -> Self {
        let (min, max) = bounds(&vertices);
        Self {
            vertices,
            faces,
            size: (max - min).max_element(),
        }
    }

    /// The box between two corners.
    pub fn cuboid(min: DVec3, max: DVec3) -> Self {
        let corner = |i: usize| {
            let pick = |bit: usize, low: f64, high: f64| if i & bit == 0 { low } else { high };
            DVec3::new(
                pick(1, min.x, max.x),
                pick(2, min.y, max.y),
                pick(4, min.z, max.z),
            )
        };
        let faces = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        Self {
            vertices: (0..8).map(corner).collect(),
            faces: faces.iter().map(|face| face.to_vec()).collect(),
            size: (max - min).max_element(),
        }
    }

    /// The part of the box between `min` and `max` that lies in all of `half_spaces`.
    pub fn intersection(min: DVec3, max: DVec3, half_spaces: &[HalfSpace]) -> Self {
        let mut solid = Self::cuboid(min, max);
        for half_space in half_spaces {
            solid.clip(*half_space);
        }
        solid
    }

    /// The convex hull of `points`; none where they lie in one plane. Meant for a few dozen points:
    /// the work grows with the third to fourth power of their number.
    pub fn hull(points: &[DVec3]) -> Option<Self> {
        let (min, max) = bounds(points);
        let size = (max - min).max_element();
        let mut solid = Self::cuboid(min - DVec3::splat(size), max + DVec3::splat(size));
        for (i, &a) in points.iter().enumerate() {
            for (j, &b) in points.iter().enumerate().skip(i + 1) {
                for &c in &points[j + 1..] {
                    if let Some(plane) = supporting(points, a, b, c, SLACK * size) {
                        solid.clip(plane);
                    }
                }
            }
        }
        let inside =
            |x: &DVec3| x.cmpge(min - SLACK * size).all() && x.cmple(max + SLACK * size).all();
        let solid = solid.merged();
        let closed = solid.vertices.iter().all(inside) && solid.check().is_ok();
        closed.then_some(solid)
    }

    /// Cuts away all that lies outside of `half_space`.
    pub fn clip(&mut self, half_space: HalfSpace) {
        let slack = SLACK * self.size;
        let height = |x: &DVec3| half_space.normal.dot(*x) - half_space.offset;
        let mut heights: Vec<f64> = self.vertices.iter().map(height).collect();
        if heights.iter().all(|&h| h <= slack) {
            return;
        }
        if heights.iter().all(|&h| h >= -slack) {
            self.vertices.clear();
            self.faces.clear();
            return;
        }
        let mut cuts = Vec::new();
        for face in &mut self.faces {
            if face.iter().any(|&v| heights[usize::from(v)] > slack) {
                *face = cut_face(face, &mut self.vertices, &mut heights, &mut cuts, slack);
            }
        }
        self.faces.retain(|face| face.len() >= 3);
        let in_plane = |v: u16| heights[usize::from(v)].abs() <= slack;
        let cap = cap(&self.faces, in_plane);
        self.faces.extend(cap);
        self.drop_unused();
    }

    /// The solid with every face moved inwards by `depth` [m]; none where nothing is left. Faces
    /// that shrink to nothing vanish, and corners that come together are made one.
    pub fn eroded(&self, depth: f64) -> Option<Self> {
        let (min, max) = bounds(&self.vertices);
        let planes: Vec<HalfSpace> = (0..self.faces.len())
            .map(|face| self.plane(face))
            .map(|plane| HalfSpace {
                offset: plane.offset - depth,
                ..plane
            })
            .collect();
        let core = Self::intersection(min, max, &planes).merged();
        core.check().is_ok().then_some(core)
    }

    /// The solid moved by `shift` [m].
    #[must_use]
    pub fn moved(mut self, shift: DVec3) -> Self {
        self.vertices.iter_mut().for_each(|x| *x += shift);
        self
    }

    /// The solid turned about the origin.
    #[must_use]
    pub fn turned(mut self, turn: DQuat) -> Self {
        self.vertices.iter_mut().for_each(|x| *x = turn * *x);
        self
    }

    /// Whether `x` lies in it.
    pub fn holds(&self, x: DVec3) -> bool {
        (0..self.faces.len())
            .map(|face| self.plane(face))
            .all(|plane| plane.normal.dot(x) <= plane.offset)
    }

    /// The part of it that lies in `other` too.
    #[must_use]
    pub fn common_part(&self, other: &Self) -> Self {
        let mut part = self.clone();
        for face in 0..other.faces.len() {
            part.clip(other.plane(face));
        }
        part
    }

    /// The plane of the face at `face`, normal outwards.
    pub fn plane(&self, face: usize) -> HalfSpace {
        let corners = &self.faces[face];
        let at = |v: u16| self.vertices[usize::from(v)];
        let first = at(corners[0]);
        let fan = corners.windows(2).skip(1);
        let area: DVec3 = fan
            .map(|pair| (at(pair[0]) - first).cross(at(pair[1]) - first))
            .sum();
        let normal = area.normalize_or_zero();
        let offsets = corners.iter().map(|&v| normal.dot(at(v)));
        HalfSpace {
            normal,
            offset: offsets.sum::<f64>() / corners.len() as f64,
        }
    }

    /// Its edges: pairs of corners, the smaller index first, each pair once.
    pub fn edges(&self) -> Vec<[u16; 2]> {
        let mut edges: Vec<[u16; 2]> = self
            .faces
            .iter()
            .flat_map(|face| sides(face))
            .filter(|[a, b]| a < b)
            .collect();
        edges.sort_unstable();
        edges
    }

    /// Volume, centroid and second moments, exact but for rounding: the sum over the tetrahedra
    /// between a point inside and the triangles of the faces.
    pub fn moments(&self) -> Moments {
        let apex = self.vertices.iter().sum::<DVec3>() / self.vertices.len().max(1) as f64;
        let mut volume = 0.0;
        let mut first = DVec3::ZERO;
        let mut second = DMat3::ZERO;
        for face in &self.faces {
            let at = |v: u16| self.vertices[usize::from(v)] - apex;
            let a = at(face[0]);
            for pair in face.windows(2).skip(1) {
                let (b, c) = (at(pair[0]), at(pair[1]));
                let six_volumes = a.dot(b.cross(c));
                let sum = a + b + c;
                volume += six_volumes / 6.0;
                first += six_volumes / 24.0 * sum;
                let squares = outer(a) + outer(b) + outer(c) + outer(sum);
                second += squares * (six_volumes / 120.0);
            }
        }
        let centroid = if volume > 0.0 { first / volume } else { first };
        Moments {
            volume,
            centroid: apex + centroid,
            second: second - outer(centroid) * volume,
        }
    }

    /// Whether it is a closed convex surface: every edge in exactly two faces, Euler's formula, no
    /// corner outside of any face, every loop anticlockwise seen from outside.
    ///
    /// # Errors
    /// The first [`Flaw`] there is.
    pub fn check(&self) -> Result<(), Flaw> {
        if self.faces.len() < 4 {
            return Err(Flaw::Empty);
        }
        self.check_closed()?;
        // Merged corners are off their planes by up to what was merged.
        let slack = 4.0 * SAME_CORNER * self.size;
        let convex = (0..self.faces.len()).all(|face| {
            let plane = self.plane(face);
            let below = |x: &DVec3| plane.normal.dot(*x) - plane.offset <= slack;
            plane.normal != DVec3::ZERO && self.vertices.iter().all(below)
        });
        if !convex {
            return Err(Flaw::NotConvex);
        }
        if self.moments().volume <= 0.0 {
            return Err(Flaw::Empty);
        }
        Ok(())
    }

    /// Whether its surface is closed: every edge in exactly two faces, there and back, and Euler's
    /// formula; and whether it encloses a volume.
    pub fn is_closed(&self) -> bool {
        self.check_closed().is_ok() && self.moments().volume > 0.0
    }

    fn check_closed(&self) -> Result<(), Flaw> {
        let mut directed: Vec<[u16; 2]> = self.faces.iter().flat_map(|face| sides(face)).collect();
        directed.sort_unstable();
        let twice = directed.windows(2).any(|pair| pair[0] == pair[1]);
        let matched = |[a, b]: &[u16; 2]| directed.binary_search(&[*b, *a]).is_ok();
        if twice || !directed.iter().all(matched) {
            return Err(Flaw::Open);
        }
        if self.vertices.len() + self.faces.len() != directed.len() / 2 + 2 {
            return Err(Flaw::Euler);
        }
        Ok(())
    }

    /// The solid with corners that nearly coincide made one; faces that lose their area so vanish.
    #[must_use]
    pub fn merged(mut self) -> Self {
        let same = SAME_CORNER * self.size;
        let same = same * same;
        let mut kept: Vec<u16> = Vec::new();
        let mut stands_for: Vec<u16> = Vec::new();
        for (v, x) in self.vertices.iter().enumerate() {
            let near = |&&u: &&u16| self.vertices[usize::from(u)].distance_squared(*x) <= same;
            let first = kept.iter().find(near).copied();
            stands_for.push(first.unwrap_or(v as u16));
            if first.is_none() {
                kept.push(v as u16);
            }
        }
        if kept.len() == self.vertices.len() {
            return self;
        }
        for face in &mut self.faces {
            for v in face.iter_mut() {
                *v = stands_for[usize::from(*v)];
            }
            face.dedup();
            while face.len() > 1 && face.first() == face.last() {
                face.pop();
            }
        }
        self.faces.retain(|face| face.len() >= 3);
        self.drop_unused();
        self
    }

    fn drop_unused(&mut self) {
        let mut renamed = vec![u16::MAX; self.vertices.len()];
        for &v in self.faces.iter().flatten() {
            renamed[usize::from(v)] = 0;
        }
        let used = renamed.iter_mut().filter(|name| **name == 0);
        used.zip(0..).for_each(|(name, next)| *name = next);
        let mut old = 0;
        self.vertices.retain(|_| {
            old += 1;
            renamed[old - 1] != u16::MAX
        });
        for v in self.faces.iter_mut().flatten() {
            *v = renamed[usize::from(*v)];
        }
    }
}

impl Moments {
    /// The principal axes as a rotation from them to the present axes, and the second moments along
    /// them [m⁵].
    ///
    /// Jacobi's iteration: of all possible choices the one nearest to the present axes,
    /// right-handed.
    pub fn principal_axes(&self) -> (DQuat, DVec3) {
        let mut moments = self.second.to_cols_array_2d();
        let mut axes = DMat3::IDENTITY.to_cols_array_2d();
        let least = NO_PRODUCT * (moments[0][0] + moments[1][1] + moments[2][2]);
        for _ in 0..MOST_SWEEPS {
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                if moments[p][q].abs() > least {
                    turn(&mut moments, &mut axes, p, q);
                }
            }
        }
        let axes = DMat3::from_cols_array_2d(&axes);
        let second = DVec3::new(moments[0][0], moments[1][1], moments[2][2]);
        (DQuat::from_mat3(&axes).normalize(), second)
    }
}

/// One Jacobi rotation in the plane of the axes `p` and `q`: afterwards their product is zero.
fn turn(moments: &mut [[f64; 3]; 3], axes: &mut [[f64; 3]; 3], p: usize, q: usize) {
    let cotangent = (moments[q][q] - moments[p][p]) / (2.0 * moments[p][q]);
    let tangent = cotangent.signum() / (cotangent.abs() + (cotangent * cotangent + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    let third = 3 - p - q;
    let product = moments[p][q];
    moments[p][p] -= tangent * product;
    moments[q][q] += tangent * product;
    moments[p][q] = 0.0;
    moments[q][p] = 0.0;
    let (a, b) = (moments[third][p], moments[third][q]);
    let (a, b) = (cosine * a - sine * b, sine * a + cosine * b);
    (moments[third][p], moments[p][third]) = (a, a);
    (moments[third][q], moments[q][third]) = (b, b);
    for k in 0..3 {
        let (a, b) = (axes[p][k], axes[q][k]);
        axes[p][k] = cosine * a - sine * b;
        axes[q][k] = sine * a + cosine * b;
    }
}

/// `x xᵀ`.
fn outer(x: DVec3) -> DMat3 {
    DMat3::from_cols(x * x.x, x * x.y, x * x.z)
}

/// Corners of the box round `points`.
fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    let all = |pick: fn(DVec3, DVec3) -> DVec3, start: f64| {
        points.iter().copied().fold(DVec3::splat(start), pick)
    };
    (
        all(DVec3::min, f64::INFINITY),
        all(DVec3::max, f64::NEG_INFINITY),
    )
}

/// The directed sides of a loop.
fn sides(face: &[u16]) -> impl Iterator<Item = [u16; 2]> + '_ {
    let next = face.iter().cycle().skip(1);
    face.iter().zip(next).map(|(&a, &b)| [a, b])
}

/// The half-space through `a`, `b` and `c` that holds all of `points`, if there is one.
fn supporting(points: &[DVec3], a: DVec3, b: DVec3, c: DVec3, slack: f64) -> Option<HalfSpace> {
    let across = (b - a).cross(c - a);
    let normal = across.try_normalize()?;
    // Three points nearly in a line say nothing about a plane.
    if across.length_squared() <= slack * (b - a).length_squared() * (c - a).length() {
        return None;
    }
    let height = |x: &DVec3| normal.dot(*x - a);
    let sign = if points.iter().all(|x| height(x) <= slack) {
        1.0
    } else if points.iter().all(|x| height(x) >= -slack) {
        -1.0
    } else {
        return None;
    };
    Some(HalfSpace {
        normal: sign * normal,
        offset: sign * normal.dot(a),
    })
}

/// What is left of a face when the corners with heights above `slack` are cut off. New corners are
/// added to `vertices` at height zero; `cuts` remembers them by the edge they cut, as two faces
/// share each.
fn cut_face(
    face: &[u16],
    vertices: &mut Vec<DVec3>,
    heights: &mut Vec<f64>,
    cuts: &mut Vec<([u16; 2], u16)>,
    slack: f64,
) -> Vec<u16> {
    let mut left = Vec::with_capacity(face.len() + 1);
    for [a, b] in sides(face) {
        let (from, to) = (heights[usize::from(a)], heights[usize::from(b)]);
        if from <= slack {
            left.push(a);
        }
        let crosses = (from > slack && to < -slack) || (from < -slack && to > slack);
        if crosses {
            let edge = [a.min(b), a.max(b)];
            let known = cuts.iter().find(|cut| cut.0 == edge).map(|cut| cut.1);
            left.push(known.unwrap_or_else(|| {
                let [u, v] = edge.map(usize::from);
                let part = heights[u] / (heights[u] - heights[v]);
                vertices.push(vertices[u] + part * (vertices[v] - vertices[u]));
                heights.push(0.0);
                let new = (vertices.len() - 1) as u16;
                cuts.push((edge, new));
                new
            }));
        }
    }
    left
}

/// The face that closes `faces` where they were cut: the loop of those sides in the plane that no
/// other face shares.
fn cap(faces: &[Vec<u16>], in_plane: impl Fn(u16) -> bool) -> Option<Vec<u16>> {
    let open: Vec<[u16; 2]> = faces
        .iter()
        .flat_map(|face| sides(face))
        .filter(|&[a, b]| in_plane(a) && in_plane(b))
        .collect();
    let unmatched = |&&[a, b]: &&[u16; 2]| !open.contains(&[b, a]);
    let mut rim = open.iter().filter(unmatched);
    let &[end, start] = rim.next()?;
    let rest: Vec<[u16; 2]> = rim.copied().collect();
    let mut cap = vec![start];
    let mut last = end;
    while last != start && cap.len() <= rest.len() {
        cap.push(last);
        last = rest.iter().find(|side| side[1] == last)?[0];
    }
    (cap.len() >= 3).then_some(cap)
}
