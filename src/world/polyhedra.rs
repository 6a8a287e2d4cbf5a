//! What grains that are no spheres need beside the columns that all grains have.

use super::grain_column::GrainColumn;
use super::{Grains, Partner, Polyhedron, SpeciesId};
use crate::physics::Integrator;
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Shapes, orientations and contact histories of a world of polyhedra, one entry per grain in every
/// column but the last.
///
/// In such a world every grain is a rounded polyhedron: [`super::Grains::radius`] is the distance
/// of the farthest point of its surface from its centroid, [`super::Grains::inertia`] the mean of
/// its principal moments, and [`super::Grains::spin`] follows from `angular_momentum`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Polyhedra {
    /// Every shape there is, in its body frame: never changed, shared by all snapshots of a world.
    #[serde(with = "shared")]
    pub shapes: Arc<[Polyhedron]>,
    /// Index of each grain's shape.
    pub shape: GrainColumn<u32>,
    /// Rotation from body axes to the axes of the world, a unit quaternion.
    pub orientation: GrainColumn<DQuat>,
    /// Angular momentum about the centroid, along the axes of the world [kg m²/s].
    pub angular_momentum: GrainColumn<DVec3>,
    /// Moments of inertia about the body axes, which are principal axes [kg m²].
    pub inertia: GrainColumn<DVec3>,
    /// Every pair of features in contact, with its history, sorted by grain, partner and feature.
    pub features: Vec<FeatureContact>,
    /// How their equations of motion are integrated.
    pub integrator: Integrator,
}

/// Two features of two bodies in contact: one of the places where they touch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FeatureContact {
    /// The grain that is the pair's first side, as in [`super::Contact::grain`].
    pub grain: u32,
    /// The other side.
    pub partner: Partner,
    /// Which features.
    pub feature: Feature,
    /// Overlap of the rounded features at the last force evaluation [m].
    pub overlap: f64,
    /// What is remembered along the normal beside it: what the dashpot added to the spring's push then
    /// [N]; where both are taken implicitly, the running mean of the speed of approach [m/s], zero where
    /// they have let go.
    pub normal_memory: f64,
    /// Tangential spring ξ [m].
    pub spring: DVec3,
    /// Stiffness `k_t` with which the spring was last stretched [N/m].
    pub stiffness: f64,
}

/// Which features of a pair: their kinds and their indices in the two shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Feature {
    /// A vertex of the first side and a face of the second (or the surface of a wall, as face 0).
    VertexFace(u16, u16),
    /// A face of the first side and a vertex of the second.
    FaceVertex(u16, u16),
    /// An edge of either.
    EdgeEdge(u16, u16),
    /// The only vertex of either: two spheres.
    VertexVertex,
}

/// A polyhedral grain to place: which shape, where, how it moves, and of what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedPolyhedron {
    /// Index of its shape.
    pub shape: u32,
    /// Where its centroid is [m].
    pub position: DVec3,
    /// Rotation from body axes to the axes of the world, a unit quaternion.
    pub orientation: DQuat,
    /// Velocity of the centroid [m/s].
    pub velocity: DVec3,
    /// Angular velocity [rad/s].
    pub spin: DVec3,
    /// Density [kg/m³].
    pub density: f64,
    /// Kind of grain.
    pub species: SpeciesId,
}

impl Polyhedra {
    /// No grains yet, of these shapes.
    pub fn new(shapes: impl Into<Arc<[Polyhedron]>>) -> Self {
        Self {
            shapes: shapes.into(),
            ..Self::default()
        }
    }

    /// `grains` that are there already as bodies at rest, each of one of the `shapes` with a
    /// rotation from body axes to the axes of the world.
    ///
    /// # Panics
    /// When there are not as many of `bodies` as of grains, or when there is no such shape.
    pub fn of_grains(
        grains: &Grains,
        shapes: impl Into<Arc<[Polyhedron]>>,
        bodies: &[(u32, DQuat)],
    ) -> Self {
        assert_eq!(bodies.len(), grains.len(), "one body per grain");
        let shapes = shapes.into();
        let inertia =
            |((shape, _), mass): (&(u32, DQuat), &f64)| *mass * shapes[*shape as usize].gyration;
        Self {
            shape: GrainColumn::of(bodies.iter().map(|(shape, _)| *shape).collect()),
            orientation: GrainColumn::of(bodies.iter().map(|(_, turn)| *turn).collect()),
            angular_momentum: GrainColumn::of(vec![DVec3::ZERO; bodies.len()]),
            inertia: GrainColumn::of(bodies.iter().zip(&grains.mass).map(inertia).collect()),
            features: Vec::new(),
            integrator: Integrator::default(),
            shapes,
        }
    }

    /// Adds `body` to these columns and to those of `grains`.
    pub fn push(&mut self, grains: &mut Grains, body: &PlacedPolyhedron) {
        let shape = &self.shapes[body.shape as usize];
        let mass = shape.volume * body.density;
        grains.push(
            body.position,
            shape.bounding_radius(),
            mass,
            mass * shape.mean_gyration(),
            body.species,
        );
        let place = grains.len() - 1;
        grains.velocity[place] = body.velocity;
        grains.spin[place] = body.spin;
        self.shape.push(body.shape);
        self.orientation.push(body.orientation);
        self.angular_momentum.push(DVec3::ZERO);
        self.inertia.push(mass * shape.gyration);
        self.set_spin(place, body.spin);
    }

    /// The shape of grain `i`.
    pub fn shape_of(&self, i: usize) -> &Polyhedron {
        &self.shapes[self.shape[i] as usize]
    }

    /// Angular velocity that the angular momentum of grain `i` is [rad/s].
    pub fn spin_of(&self, i: usize) -> DVec3 {
        let turn = self.orientation[i];
        turn * ((turn.conjugate() * self.angular_momentum[i]) / self.inertia[i])
    }

    /// Gives grain `i` the angular velocity `spin` [rad/s]; [`super::Grains::spin`] is for the
    /// caller to set.
    pub fn set_spin(&mut self, i: usize, spin: DVec3) {
        let turn = self.orientation[i];
        self.angular_momentum[i] = turn * ((turn.conjugate() * spin) * self.inertia[i]);
    }
}

/// Shared shapes in a file: written once, read into one piece of memory.
mod shared {
    use super::{Arc, Polyhedron};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(
        shapes: &Arc<[Polyhedron]>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        shapes.as_ref().serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Arc<[Polyhedron]>, D::Error> {
        Vec::deserialize(deserializer).map(Arc::from)
    }
}
