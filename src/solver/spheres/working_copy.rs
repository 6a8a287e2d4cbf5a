//! What the solver keeps of a world of spheres between loading and storing it.

use super::super::walls::Walls;
use super::integrate::{BridgeLoad, SphereAccount, SphereLoad, StepConstants};
use super::kinds::Kinds;
use super::neighbours::Neighbours;
use super::plan::Plan;
use super::rings::Rings;
use super::rows::Sphere;
use super::slots::Slots;
use crate::physics::law::StatedLaw;
use crate::physics::{ContactLaw, Liquid};

/// The working copy of a world of spheres, which press each other by the law of `S`.
pub struct SphereKernel<S = StatedLaw> {
    /// Where the contact law comes from.
    pub(super) source: S,
    /// In which slot each grain's rows stand.
    pub(super) slots: Slots,
    /// What the pair loop reads of every grain, and the padding body behind them.
    pub(super) bodies: Vec<Sphere>,
    /// The other copy of them: a step reads one and writes the other.
    pub(super) next_bodies: Vec<Sphere>,
    /// What acts on every grain at the end of a call.
    pub(super) loads: Vec<SphereLoad>,
    /// What else the integration reads or writes of every grain.
    pub(super) accounts: Vec<SphereAccount>,
    /// The walls at the time of the positions.
    pub(super) walls: Walls,
    /// Who may touch whom, with the histories of their contacts.
    pub(super) neighbours: Neighbours,
    /// Constants of each kind of pair.
    pub(super) kinds: Kinds,
    /// Step, gravity and the slack of the lists.
    pub(super) motion: StepConstants,
    /// The contact law that the world states.
    pub(super) law: ContactLaw,
    /// The liquid, where there is any.
    pub(super) liquid: Option<Liquid>,
    /// Volume of the film on every grain and, of none, on the padding body; empty where nothing is
    /// wet [m³].
    pub(super) films: Vec<f64>,
    /// The other copy of them.
    pub(super) next_films: Vec<f64>,
    /// What the bridges of every grain have done; empty where nothing is wet.
    pub(super) bridge_loads: Vec<BridgeLoad>,
    /// What each worker does in a step, for the lists of that generation.
    pub(super) plans: Vec<Plan>,
    pub(super) planned: u64,
    /// Where the pairs of each worker write.
    pub(super) rings: Vec<Rings>,
    /// Bridges that broke since the world was taken in.
    pub(super) ruptures: u64,
}

impl<S> SphereKernel<S> {
    /// A working copy of no world yet.
    pub fn new(source: S) -> Self {
        Self {
            source,
            slots: Slots::default(),
            bodies: Vec::new(),
            next_bodies: Vec::new(),
            loads: Vec::new(),
            accounts: Vec::new(),
            walls: Walls::default(),
            neighbours: Neighbours::default(),
            kinds: Kinds::default(),
            motion: StepConstants::default(),
            law: ContactLaw::default(),
            liquid: None,
            films: Vec::new(),
            next_films: Vec::new(),
            bridge_loads: Vec::new(),
            plans: Vec::new(),
            planned: 0,
            rings: Vec::new(),
            ruptures: 0,
        }
    }
}
