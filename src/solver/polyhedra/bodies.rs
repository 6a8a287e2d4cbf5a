//! The bodies: what moves of each grain, and where its vertices and faces are.
//!
//! In: a world of polyhedra. Out: a row set for each body, the tables of all features, kicks and
//! drifts. Vertices are turned anew from the body frame in every step, so that shapes never drift.
//!
//! The tables stand body by body, one after the other, and [`Place`] says where each begins: a
//! feature has a number in its body (in [`crate::world::Feature`], in lists) and one in the world's
//! tables (in jobs). Angular momentum is what is integrated, as torque changes it alone; the spin
//! follows from it and the orientation.
//!
//! Not here: what forces there are ([`super::forces`]), how springs and dashpots that are taken
//! implicitly change velocities ([`super::joint`]).

use super::super::row::{Row, length_squared, row, vector};
use super::nearest::Places;
use crate::lanes::{Lanes, Quad, Work, prefetch};
use crate::world::{Polyhedron, World};
use glam::{DQuat, DVec3};
use std::ops::Range;

/// What the pair loop reads of a body, and what moves it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct Body {
    /// Centroid [m]; inverse mass [1/kg].
    pub position: Row,
    /// Velocity half a step ago [m/s]; largest speed of any of its points that is not absurd [m/s].
    pub velocity: Row,
    /// Spin that the angular momentum of half a step ago is at the present orientation [rad/s];
    /// distance of the farthest point of the surface from the centroid [m].
    pub spin: Row,
    /// Angular momentum half a step ago [kg m²/s]; sphero-radius [m].
    pub angular_momentum: Row,
    /// Rotation from body axes to world axes: x, y, z, w of a unit quaternion.
    pub orientation: Row,
    /// Inverse principal moments of inertia [1/(kg m²)].
    pub inverse_inertia: Row,
}

/// What acts on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Contact forces at the last evaluation [N]; number of touching partners.
    pub force: Row,
    /// Their torque [N m].
    pub torque: Row,
    /// Energy exchanged since the start [J].
    pub exchanged: Row,
}

/// Where each body's features begin in the tables of [`Shapes`], after the last body the ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// First vertex.
    pub vertex: u32,
    /// First edge.
    pub edge: u32,
    /// First face.
    pub face: u32,
    /// First entry of the faces' outlines.
    pub corner: u32,
}

impl Load {
    /// What acts on grain `i` of `world`.
    pub fn of(world: &World, i: usize) -> Self {
        let grains = &world.grains;
        Self {
            force: row(grains.force[i], f64::from(grains.contact_count[i])),
            torque: row(grains.torque[i], 0.0),
            exchanged: grains.exchanged[i],
        }
    }

    /// Number of touching partners.
    pub fn contact_count(&self) -> f64 {
        self.force[3]
    }

    /// It and what springs and dashpots do that are taken implicitly.
    #[inline(always)]
    #[must_use]
    pub fn with(&self, resistance: &Self) -> Self {
        let mut load = *self;
        for axis in 0..3 {
            load.force[axis] += resistance.force[axis];
            load.torque[axis] += resistance.torque[axis];
        }
        load
    }
}

/// The shapes of all bodies, feature by feature.
#[derive(Default)]
pub struct Shapes {
    /// Where each body's features begin.
    pub places: Vec<Place>,
    /// Vertices along the body axes [m].
    pub body_vertices: Vec<[f64; 3]>,
    /// Outward normals along the body axes; the face's first vertex, by its number in the body.
    pub body_normals: Vec<(DVec3, u16)>,
    /// Ends of the edges, by their numbers in the body.
    pub edges: Vec<[u16; 2]>,
    /// Where in `loops` each face's vertices begin.
    pub loop_starts: Vec<u32>,
    /// Vertices of the faces, by their numbers in the body.
    pub loops: Vec<u16>,
    /// How far a vertex of each body is from the plane of one of its faces, at most [m].
    pub uneven: Vec<f64>,
}

impl Shapes {
    /// The shapes of these `grains` of `world`, body by body.
    pub fn of(world: &World, grains: impl IntoIterator<Item = usize>) -> Self {
        let mut shapes = Self::default();
        if let Some(polyhedra) = &world.polyhedra {
            (grains.into_iter()).for_each(|i| shapes.push(polyhedra.shape_of(i)));
        }
        shapes.places.push(shapes.end());
        shapes.loop_starts.push(shapes.loops.len() as u32);
        shapes
    }

    /// The ends of the tables.
    fn end(&self) -> Place {
        Place {
            vertex: self.body_vertices.len() as u32,
            edge: self.edges.len() as u32,
            face: self.body_normals.len() as u32,
            corner: self.loops.len() as u32,
        }
    }

    /// Adds a body of this shape to tables that are open.
    fn push(&mut self, shape: &Polyhedron) {
        self.places.push(self.end());
        self.body_vertices
            .extend(shape.vertices.iter().map(DVec3::to_array));
        self.edges.extend_from_slice(&shape.edges);
        let mut uneven: f64 = 0.0;
        for face in &shape.faces {
            self.loop_starts.push(self.loops.len() as u32);
            self.loops.extend_from_slice(face);
            let first = face.first().copied().unwrap_or(0);
            let normal = outward_normal(shape, face);
            self.body_normals.push((normal, first));
            for corner in face {
                let [corner, first] = [*corner, first].map(|k| shape.vertices[usize::from(k)]);
                uneven = uneven.max((corner - first).dot(normal).abs());
            }
        }
        self.uneven.push(uneven);
        if shape.vertices.len() == 1 {
            // Two spheres meet as two edges of no length.
            self.edges.push([0; 2]);
        }
    }

    /// Whether body `i` is a sphere: a core of one vertex.
    pub fn is_sphere(&self, i: usize) -> bool {
        self.places[i + 1].vertex - self.places[i].vertex == 1
    }

    /// Puts the vertices and planes of body `i` where `body` is.
    #[inline(always)]
    pub fn place<Q: Quad>(
        &self,
        processor: Q::Processor,
        i: usize,
        body: &Body,
        vertices: &mut [Row],
        planes: &mut [Row],
    ) {
        let (from, to) = (self.places[i], self.places[i + 1]);
        let [cx, cy, cz, _] = body.position;
        let centre = Q::load(processor, &[cx, cy, cz, 0.0]);
        let [x, y, z] = axes(body.orientation).map(|[x, y, z]| Q::load(processor, &[x, y, z, 0.0]));
        let turned = |v: [f64; 3]| {
            let along = v.map(|x| Q::repeat(processor, x));
            x * along[0] + y * along[1] + z * along[2]
        };
        let own = &self.body_vertices[from.vertex as usize..to.vertex as usize];
        for (vertex, own) in vertices.iter_mut().zip(own) {
            *vertex = (centre + turned(*own)).row();
        }
        let own = &self.body_normals[from.face as usize..to.face as usize];
        for (plane, (normal, corner)) in planes.iter_mut().zip(own) {
            let n = turned(normal.to_array()).row();
            let v = vertices[usize::from(*corner)];
            *plane = [n[0], n[1], n[2], n[0] * v[0] + n[1] * v[1] + n[2] * v[2]];
        }
    }

    /// Ranges of the features of body `i` in the tables: vertices, edges, faces.
    #[inline(always)]
    pub fn features_of(&self, i: usize) -> [Range<usize>; 3] {
        let (from, to) = (self.places[i], self.places[i + 1]);
        [
            from.vertex as usize..to.vertex as usize,
            from.edge as usize..to.edge as usize,
            from.face as usize..to.face as usize,
        ]
    }

    /// Ends of the edges of body `i`, by their numbers in the body.
    #[inline(always)]
    pub fn edges_of(&self, i: usize) -> &[[u16; 2]] {
        let [_, edges, _] = self.features_of(i);
        &self.edges[edges]
    }

    /// Vertices of a face of the tables, by their numbers in the body.
    #[inline(always)]
    pub fn outline(&self, face: usize) -> &[u16] {
        &self.loops[self.loop_starts[face] as usize..self.loop_starts[face + 1] as usize]
    }
}

/// Puts the vertices and planes of all bodies where those are: once at the start of a call. In the
/// steps each worker does it for its own bodies.
pub struct Placing<'a> {
    /// The shapes.
    pub shapes: &'a Shapes,
    /// Every body.
    pub bodies: &'a [Body],
    /// Where to put their vertices.
    pub vertices: &'a mut [Row],
    /// Where to put their faces' planes.
    pub planes: &'a mut [Row],
}

impl Work for Placing<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) {
        for (i, body) in self.bodies.iter().enumerate() {
            let [vertices, _, faces] = self.shapes.features_of(i);
            let vertices = &mut self.vertices[vertices];
            let planes = &mut self.planes[faces];
            self.shapes
                .place::<N::Quad>(processor, i, body, vertices, planes);
        }
    }
}

/// The shapes of all bodies, and where they are now.
#[derive(Clone, Copy)]
pub struct Geometry<'a> {
    /// The shapes.
    pub shapes: &'a Shapes,
    /// Their features.
    pub places: Places<'a>,
}

impl<'a> Geometry<'a> {
    /// The vertices of body `i` [m].
    #[inline(always)]
    pub fn vertices_of(&self, i: usize) -> &'a [Row] {
        let [vertices, ..] = self.shapes.features_of(i);
        &self.places.vertices[vertices]
    }

    /// Asks for all that the features of body `i` are measured by.
    #[inline(always)]
    pub fn fetch(&self, i: usize) {
        let (shapes, [vertices, _, faces]) = (self.shapes, self.shapes.features_of(i));
        let corners = shapes.places[i].corner as usize..shapes.places[i + 1].corner as usize;
        prefetch::<_, 16>(&self.places.vertices[vertices]);
        prefetch::<_, 8>(&self.places.planes[faces.clone()]);
        prefetch::<_, 2>(&shapes.loop_starts[faces]);
        prefetch::<_, 4>(&shapes.loops[corners]);
    }

    /// The planes of its faces.
    #[inline(always)]
    pub fn planes_of(&self, i: usize) -> &'a [Row] {
        let [_, _, faces] = self.shapes.features_of(i);
        &self.places.planes[faces]
    }
}

/// The unit normal of a loop of vertices, by Newell's sum: exact for any plane polygon.
fn outward_normal(shape: &Polyhedron, face: &[u16]) -> DVec3 {
    let corner = |k: usize| shape.vertices[usize::from(face[k % face.len()])];
    let origin = corner(0);
    let sum: DVec3 = (1..face.len())
        .map(|k| (corner(k) - origin).cross(corner(k + 1) - origin))
        .sum();
    sum.normalize_or_zero()
}

/// The body axes in the world's frame: the columns of the rotation that the quaternion is.
#[inline(always)]
fn axes(orientation: Row) -> [[f64; 3]; 3] {
    let [x, y, z, w] = orientation;
    let (xx, yy, zz) = (2.0 * x * x, 2.0 * y * y, 2.0 * z * z);
    let (xy, xz, yz) = (2.0 * x * y, 2.0 * x * z, 2.0 * y * z);
    let (wx, wy, wz) = (2.0 * w * x, 2.0 * w * y, 2.0 * w * z);
    [
        [1.0 - yy - zz, xy + wz, xz - wy],
        [xy - wz, 1.0 - xx - zz, yz + wx],
        [xz + wy, yz - wx, 1.0 - xx - yy],
    ]
}

/// A vector of the world along the body axes.
#[inline(always)]
fn into_body([x, y, z]: &[[f64; 3]; 3], v: Row) -> [f64; 3] {
    let along = |axis: &[f64; 3]| axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
    [along(x), along(y), along(z)]
}

impl Body {
    /// Grain `i` of `world`; steps are `dt` long [s].
    pub fn of(world: &World, i: usize, dt: f64) -> Self {
        let grains = &world.grains;
        let Some(polyhedra) = &world.polyhedra else {
            return Self::default();
        };
        let rounding = polyhedra.shape_of(i).rounding;
        let inverse = polyhedra.inertia[i].recip();
        Self {
            position: row(grains.position[i], 1.0 / grains.mass[i]),
            velocity: row(
                grains.velocity[i],
                polyhedra.integrator.largest_move() * rounding / dt,
            ),
            spin: row(grains.spin[i], grains.radius[i]),
            angular_momentum: row(polyhedra.angular_momentum[i], rounding),
            orientation: polyhedra.orientation[i].to_array(),
            inverse_inertia: row(inverse, 0.0),
        }
    }

    /// Half a step of velocity and angular momentum: `v ← v + ½ Δt (F/m + g)`, `L ← L + ½ Δt T`.
    #[inline(always)]
    pub fn kick(&mut self, load: &Load, half: f64, gravity: Row) {
        let inverse_mass = self.inverse_mass();
        for axis in 0..3 {
            self.velocity[axis] += (load.force[axis] * inverse_mass + gravity[axis]) * half;
            self.angular_momentum[axis] += load.torque[axis] * half;
        }
    }

    /// Velocity and spin half a step ahead under `load`, at the present orientation.
    #[inline(always)]
    pub fn half_a_step_ahead(&self, load: &Load, dt: f64, gravity: Row) -> [Row; 2] {
        let [xx, xy, xz, yy, yz, zz] = self.inverse_inertia();
        let (inverse_mass, turn) = (
            self.inverse_mass(),
            [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]],
        );
        let (mut velocity, mut spin) = ([0.0; 4], [0.0; 4]);
        let [tx, ty, tz, _] = load.torque;
        for axis in 0..3 {
            let [x, y, z] = turn[axis];
            let acceleration = load.force[axis] * inverse_mass + gravity[axis];
            velocity[axis] = self.velocity[axis] + dt * acceleration;
            spin[axis] = self.spin[axis] + dt * (x * tx + y * ty + z * tz);
        }
        [velocity, spin]
    }

    /// A full step of position and orientation; the spin follows.
    #[inline(always)]
    pub fn drift(&mut self, dt: f64) {
        for axis in 0..3 {
            self.position[axis] += self.velocity[axis] * dt;
        }
        self.turn(dt);
        self.update_spin();
    }

    /// The spin that the angular momentum is at the present orientation, `ω = R I⁻¹ Rᵀ L` with the
    /// rotation `R` from body axes to the world's and the principal moments `I`.
    #[inline(always)]
    pub fn update_spin(&mut self) {
        let axes = axes(self.orientation);
        let momentum = into_body(&axes, self.angular_momentum);
        let spin = [0, 1, 2].map(|k| momentum[k] * self.inverse_inertia[k]);
        for axis in 0..3 {
            self.spin[axis] =
                axes[0][axis] * spin[0] + axes[1][axis] * spin[1] + axes[2][axis] * spin[2];
        }
    }

    /// The inverse of its inertia along the axes of the world, `R I⁻¹ Rᵀ` [1/(kg m²)]: xx, xy, xz,
    /// yy, yz, zz.
    #[inline(always)]
    pub fn inverse_inertia(&self) -> [f64; 6] {
        let [x, y, z, _] = self.inverse_inertia;
        self.along_world([x, y, z])
    }

    /// Its inertia along the axes of the world, `R I Rᵀ` [kg m²], likewise.
    #[inline(always)]
    pub fn inertia(&self) -> [f64; 6] {
        let [x, y, z, _] = self.inverse_inertia;
        self.along_world([1.0 / x, 1.0 / y, 1.0 / z])
    }

    /// The symmetric matrix along the axes of the world that has these `principal` values along the
    /// body's.
    #[inline(always)]
    fn along_world(&self, principal: [f64; 3]) -> [f64; 6] {
        let axes = axes(self.orientation);
        let entry = |i: usize, j: usize| {
            axes[0][i] * axes[0][j] * principal[0]
                + axes[1][i] * axes[1][j] * principal[1]
                + axes[2][i] * axes[2][j] * principal[2]
        };
        [
            entry(0, 0),
            entry(0, 1),
            entry(0, 2),
            entry(1, 1),
            entry(1, 2),
            entry(2, 2),
        ]
    }

    /// Turns the free body for `dt` [s]: its angular momentum stays, its orientation follows by
    /// rotations about one body axis after the other, forwards and back (the symmetric splitting of
    /// Dullweber, Leimkuhler and `McLachlan` 1997). Each is symplectic, so the energy of a free
    /// body does not drift.
    #[inline(always)]
    fn turn(&mut self, dt: f64) {
        let mut momentum = into_body(&axes(self.orientation), self.angular_momentum);
        let mut q = self.orientation;
        let half = 0.5 * dt;
        let inverse = self.inverse_inertia;
        about::<0>(&mut momentum, &mut q, half * inverse[0]);
        about::<1>(&mut momentum, &mut q, half * inverse[1]);
        about::<2>(&mut momentum, &mut q, dt * inverse[2]);
        about::<1>(&mut momentum, &mut q, half * inverse[1]);
        about::<0>(&mut momentum, &mut q, half * inverse[0]);
        let norm = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
        self.orientation = q.map(|x| x / norm);
    }

    /// Whether no point of it is absurdly fast. Written so that a NaN is not sane.
    #[inline(always)]
    pub fn is_sane(&self) -> bool {
        self.fastest() <= self.speed_limit()
    }

    /// A speed that no point of the body exceeds [m/s].
    #[inline(always)]
    pub fn fastest(&self) -> f64 {
        length_squared(self.velocity).sqrt() + length_squared(self.spin).sqrt() * self.reach()
    }

    /// Orientation as a quaternion.
    pub fn quaternion(&self) -> DQuat {
        DQuat::from_array(self.orientation)
    }

    /// Inverse mass [1/kg].
    #[inline(always)]
    pub fn inverse_mass(&self) -> f64 {
        self.position[3]
    }

    /// Largest speed of any of its points that is not absurd [m/s].
    #[inline(always)]
    fn speed_limit(&self) -> f64 {
        self.velocity[3]
    }

    /// The square of how far it is from where it was `before`, or will be at its pace in the time
    /// `ahead` [s], in m².
    #[inline(always)]
    pub fn moved_from(&self, before: &Row, ahead: f64) -> f64 {
        let way = |k: usize| self.position[k] + ahead * self.velocity[k] - before[k];
        length_squared([way(0), way(1), way(2), 0.0])
    }

    /// Distance of the farthest point of its surface from its centroid [m].
    #[inline(always)]
    pub fn reach(&self) -> f64 {
        self.spin[3]
    }

    /// Sphero-radius: by how much its core is rounded [m].
    #[inline(always)]
    pub fn sphero_radius(&self) -> f64 {
        self.angular_momentum[3]
    }

    /// The centroid [m].
    pub fn centre(&self) -> DVec3 {
        vector(self.position)
    }
}

/// A rotation about body axis `K` by the angle whose half has the tangent `momentum[K] rate / 2`:
/// that of the axis' own free rotation to third order, and symplectic as any function of that
/// momentum alone.
#[inline(always)]
fn about<const K: usize>(momentum: &mut [f64; 3], q: &mut Row, rate: f64) {
    let (u, v) = ((K + 1) % 3, (K + 2) % 3);
    let tangent = 0.5 * momentum[K] * rate;
    let square = tangent * tangent;
    let inverse = 1.0 / (1.0 + square);
    let (cosine, sine) = ((1.0 - square) * inverse, 2.0 * tangent * inverse);
    let (a, b) = (momentum[u], momentum[v]);
    momentum[u] = cosine * a + sine * b;
    momentum[v] = cosine * b - sine * a;
    // q (1, tangent along axis K); the length is put right at the end of the step.
    let old = *q;
    q[3] = old[3] - tangent * old[K];
    q[K] = old[K] + tangent * old[3];
    q[u] = old[u] + tangent * old[v];
    q[v] = old[v] - tangent * old[u];
}
