//! What the solver keeps of a world of polyhedra between loading and storing it.

use super::super::row::Row;
use super::super::walls::Walls;
use super::bodies::{Body, Load, Shapes};
use super::extents::Extents;
use super::joint::SharedColumns;
use super::neighbours::{PairList, PairsOfBodies};
use super::pairs::PairForce;
use super::workspace::Workspace;
use crate::physics::{ContactLaw, FeatureRule, Integrator, Materials};
use crate::world::{Polyhedron, SpeciesId, Surface};
use std::sync::Arc;

/// The working copy of a world of polyhedra.
#[derive(Default)]
pub struct PolyhedronKernel {
    /// What moves of every grain.
    pub(super) bodies: Vec<Body>,
    /// What acts on every grain.
    pub(super) loads: Vec<Load>,
    /// Vertices, edges and faces along the body axes.
    pub(super) shapes: Shapes,
    /// Every vertex where it is now [m].
    pub(super) vertices: Vec<Row>,
    /// The plane of every face: outward unit normal, distance from the origin [m].
    pub(super) planes: Vec<Row>,
    /// The walls at the time of the positions.
    pub(super) walls: Walls,
    /// Pairs of bodies near each other.
    pub(super) pairs: PairList,
    /// The contact force of every pair; of those that do not act, any.
    pub(super) forces: Vec<PairForce>,
    /// Which pairs act.
    pub(super) acting: Vec<bool>,
    /// What springs and dashpots of every pair do that are taken implicitly, beyond its contact
    /// force; of those that do not resist, anything.
    pub(super) resistances: Vec<PairForce>,
    /// Which pairs have such.
    pub(super) resisting: Vec<bool>,
    /// The sum of the normal springs on each body over its mass, where they are [1/s²].
    pub(super) stiffnesses: Vec<f64>,
    /// What all workers share of the joint solution of springs and dashpots.
    pub(super) implicit: SharedColumns,
    /// Which pairs are whose.
    pub(super) pairs_of: PairsOfBodies,
    /// Where the bodies were when the pairs were found.
    pub(super) reference: Vec<Row>,
    /// Where the walls were then.
    pub(super) reference_surfaces: Vec<Surface>,
    /// Width of the skin in which pairs are kept [m].
    pub(super) skin: f64,
    /// Sizes that bound how far two bodies move in a step.
    pub(super) extents: Extents,
    /// What the pairs' constants were computed from.
    pub(super) known: Known,
    /// The shapes that the tables were made from.
    pub(super) known_shapes: Option<Arc<[Polyhedron]>>,
    /// Room to work in, one for each worker.
    pub(super) workspaces: Vec<Workspace>,
    /// Length of a step [s].
    pub(super) dt: f64,
    /// How the equations of motion are integrated.
    pub(super) integrator: Integrator,
    /// Gravity [m/s²].
    pub(super) gravity: Row,
    /// Whether the features of a pair share its stiffness.
    pub(super) rule: FeatureRule,
}

/// What the pairs' constants depend on.
#[derive(Default, PartialEq)]
pub(super) struct Known {
    pub(super) law: ContactLaw,
    pub(super) materials: Materials,
    pub(super) species: Vec<SpeciesId>,
    pub(super) masses: Vec<f64>,
}
