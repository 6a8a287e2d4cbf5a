//! The liquid side of the pair loop: bridges that form, pull, drag and break, as many side by side
//! as there are lanes.
//!
//! In: gaps and relative motion of pairs of grains, their bridges. Out: the bridges' forces, what
//! they lose, what their liquid does when they break. A bridge forms where grains touch, breaks at
//! its rupture gap, and walls have none.
//!
//! A bridge takes its volume from the films of both grains when it forms and keeps it; a film
//! counts its part all the while. When the bridge breaks, each side takes half of it home: what one
//! film gains the other loses. Capillary attraction and drag are those of [`crate::physics::law`]
//! (Kasper et al. 2021, Eqs. 11–17) at the gap, which is held within the bounds that the liquid's
//! choices set. What a bridge loses is the mean of its old and its new force times the way between,
//! booked apart for viscosity and for capillary forces, as the latter give back on the way together
//! what they take on the way apart.
//!
//! Not here: what the bridges' forces depend on, how far lists must reach for them
//! ([`super::neighbours`]).

use super::super::row::{row, vector};
use super::rows::{GROUP, SpherePair};
use crate::lanes::{Lanes, Quad, Row, WIDEST, dot, plus, times};
use crate::physics::Liquid;
use crate::physics::law::{
    BridgeConstants, BridgeKinds, FilmConstants, attraction, contributions, drag,
};
use crate::world::Bridge;

/// What the solver keeps of a bridge; all zero where there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BridgeRow {
    /// Volume [m³], transfer on rupture [m³], capillary attraction and viscous normal force at the
    /// last step [N].
    pub state: Row,
    /// Viscous force on the grain across the normal at the last step [N].
    pub drag: Row,
    /// What the attraction depends on: see [`BridgeConstants`].
    pub constants: Row,
}

/// The bridges of a group of pairs, column by column.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub struct BridgeColumns {
    state: [[f64; GROUP]; 4],
    drag: [[f64; GROUP]; 3],
    constants: [[f64; GROUP]; 4],
}

/// The bridges of a list of pairs, in whole groups.
#[derive(Default)]
pub struct Bridges {
    /// The groups.
    pub groups: Vec<BridgeColumns>,
}

/// What a bridge does beside its force: energy lost to viscosity and to capillary forces during the
/// step [J], 1 where it holds grains that do not touch, volume that the grain's film gains from its
/// partner's [m³].
pub type BridgeEffect = Row;

/// What bridges depend on.
#[derive(Clone, Copy)]
pub struct Wetting<'a> {
    /// The liquid.
    pub liquid: &'a Liquid,
    /// Volume of the film on every grain; the padding body has none [m³].
    pub films: &'a [f64],
    /// Constants of every kind of pair.
    pub constants: &'a [FilmConstants],
}

/// As many pairs as there are lanes, with their bridges and what those do.
pub struct BridgeGroup<'a> {
    /// What they depend on.
    pub wetting: Wetting<'a>,
    /// The pairs.
    pub pairs: &'a [SpherePair],
    /// The group that holds their bridges.
    pub columns: &'a mut BridgeColumns,
    /// Where in it the first of them stands.
    pub first: usize,
    /// What those do.
    pub effects: &'a mut [BridgeEffect],
}

/// How the grains of each pair stand and move to each other.
#[derive(Clone, Copy)]
pub struct Encounter<N: Lanes> {
    /// Overlap, negative at a gap [m].
    pub depth: N,
    /// Where it is positive.
    pub touching: N::Mask,
    /// Speed of approach [m/s].
    pub approach: N,
    /// Velocity of the grain's surface over its partner's [m/s].
    pub slip: [N; 3],
    /// Step and partners over moment of inertia, summed over both [1/(N m s)].
    pub compliance: N,
}

/// Forces of bridges.
#[derive(Clone, Copy)]
pub struct LiquidForce<N> {
    /// Along the normal, positive where it pushes apart [N].
    pub repulsion: N,
    /// On the grain across the normal [N].
    pub drag: [N; 3],
    /// Bridges that broke.
    pub ruptures: u32,
}

impl BridgeRow {
    /// The solver's copy of `bridge` between grains of these radii [m], one of several of these
    /// `kinds`.
    pub fn of(bridge: &Bridge, kinds: &mut BridgeKinds, radii: (f64, f64)) -> Self {
        Self {
            state: [
                bridge.volume,
                bridge.transfer,
                bridge.capillary,
                bridge.viscous,
            ],
            drag: row(bridge.drag, 0.0),
            constants: kinds.constants(radii, bridge.volume).row,
        }
    }

    /// A bridge that forms between grains with these radii [m] and films [m³]; none where both are
    /// dry.
    fn new(liquid: &Liquid, radii: (f64, f64), films: (f64, f64)) -> Self {
        let (first, second) = contributions(liquid, radii, films);
        let volume = first + second;
        if volume > 0.0 {
            Self {
                state: [volume, 0.5 * (second - first), 0.0, 0.0],
                drag: [0.0; 4],
                constants: BridgeConstants::of(liquid, radii, volume).row,
            }
        } else {
            Self::default()
        }
    }

    /// Whether there is a bridge.
    pub fn exists(&self) -> bool {
        self.state[0] > 0.0
    }

    /// The bridge, if there is one.
    pub fn bridge(&self) -> Option<Box<Bridge>> {
        let [volume, transfer, capillary, viscous] = self.state;
        self.exists().then(|| {
            Box::new(Bridge {
                volume,
                transfer,
                capillary,
                viscous,
                drag: vector(self.drag),
            })
        })
    }
}

impl Bridges {
    /// Room for `count` pairs, without bridges.
    pub fn none(count: usize) -> Self {
        Self {
            groups: vec![BridgeColumns::default(); count.div_ceil(GROUP)],
        }
    }

    /// The bridge of the `k`-th pair; an empty row where the list is dry.
    pub fn get(&self, k: usize) -> BridgeRow {
        let group = self.groups.get(k / GROUP);
        group.map_or(BridgeRow::default(), |columns| columns.row(k % GROUP))
    }

    /// Sets it.
    pub fn set(&mut self, k: usize, row: &BridgeRow) {
        self.groups[k / GROUP].set(k % GROUP, row);
    }
}

impl BridgeColumns {
    /// The bridge of the `k`-th pair of the group.
    fn row(&self, k: usize) -> BridgeRow {
        let [x, y, z] = self.drag.map(|column| column[k]);
        BridgeRow {
            state: self.state.map(|column| column[k]),
            drag: [x, y, z, 0.0],
            constants: self.constants.map(|column| column[k]),
        }
    }

    /// Sets it.
    pub fn set(&mut self, k: usize, row: &BridgeRow) {
        let columns = self.state.iter_mut().chain(&mut self.drag);
        let columns = columns.chain(&mut self.constants);
        let numbers = row.state.iter().chain(&row.drag[..3]);
        for (column, number) in columns.zip(numbers.chain(&row.constants)) {
            column[k] = *number;
        }
    }
}

/// Columns side by side, from the `first` number of each on.
#[inline(always)]
fn load<N: Lanes, const COUNT: usize>(
    processor: N::Processor,
    columns: &[[f64; GROUP]; COUNT],
    first: usize,
) -> [N; COUNT] {
    let mut numbers = [N::splat(processor, 0.0); COUNT];
    // No closure: it would not be compiled for the lanes.
    for k in 0..COUNT {
        numbers[k] = N::load(processor, &columns[k][first..]);
    }
    numbers
}

/// Puts them back.
#[inline(always)]
fn store<N: Lanes, const COUNT: usize>(
    numbers: [N; COUNT],
    columns: &mut [[f64; GROUP]; COUNT],
    first: usize,
) {
    for k in 0..COUNT {
        numbers[k].store(&mut columns[k][first..]);
    }
}

impl BridgeGroup<'_> {
    /// Lets bridges form where grains with these radii [m] touch, that is, overlap [m], and have
    /// none.
    #[cold]
    fn form(&mut self, depths: [f64; WIDEST], radii: [[f64; WIDEST]; 2]) {
        let films = self.wetting.films;
        for (k, pair) in self.pairs.iter().enumerate() {
            let lane = self.first + k;
            if depths[k] > 0.0 && !self.columns.row(lane).exists() {
                let films = (films[pair.grain.index()], films[pair.partner.index()]);
                let radii = (radii[0][k], radii[1][k]);
                let row = BridgeRow::new(self.wetting.liquid, radii, films);
                self.columns.set(lane, &row);
            }
        }
    }

    /// Forms, moves and breaks the bridges, and says what they do.
    #[inline(always)]
    pub fn act<N: Lanes>(
        mut self,
        processor: N::Processor,
        dt: N,
        radii: [N; 2],
        film: &([N; 4], [N; 4]),
        encounter: &Encounter<N>,
    ) -> LiquidForce<N> {
        let (zero, one) = (N::splat(processor, 0.0), N::splat(processor, 1.0));
        let (depth, touching) = (encounter.depth, encounter.touching);
        let (approach, slip) = (encounter.approach, encounter.slip);
        let mut states = load::<N, 4>(processor, &self.columns.state, self.first);
        let wanting = N::choose(states[0].exceeds(zero), zero, depth);
        if N::count(wanting.exceeds(zero)) > 0 {
            self.form(depth.numbers(), radii.map(N::numbers));
            states = load(processor, &self.columns.state, self.first);
        }
        let [volume, transfer, old_attraction, old_viscous] = states;
        let old_drag = load::<N, 3>(processor, &self.columns.drag, self.first);
        let constants = load::<N, 4>(processor, &self.columns.constants, self.first);

        let gap = -depth;
        let kept = N::choose(gap.exceeds(constants[3]), zero, volume);
        let held = kept.exceeds(zero);
        let [in_contact, smallest, largest, _] = film.1;
        let pull = attraction(processor, constants, within(gap, in_contact, largest));
        let pull = N::choose(held, pull, zero);
        let mobility = encounter.compliance * film.0[3];
        let [normal, across] = drag(processor, film.0, within(gap, smallest, largest), mobility);
        let viscous = N::choose(held, normal * approach, zero);
        let across = N::choose(held, across, zero);
        let drag = times(slip, -across);

        // Mean of the old and the new force, times the way between: losses close to second order in
        // the step.
        let half = N::splat(processor, 0.5) * dt;
        let resisted = (old_viscous + viscous) * approach;
        let dragged = dot(plus(old_drag, drag), slip);
        let viscous_loss = half * (resisted - dragged);
        let capillary_loss = -(half * ((old_attraction + pull) * approach));
        let open = N::choose(touching, zero, N::choose(held, one, zero));
        let shared = N::choose(held, zero, transfer);

        let states = [kept, transfer - shared, pull, viscous];
        store(states, &mut self.columns.state, self.first);
        store(drag, &mut self.columns.drag, self.first);
        let effects = N::rows([viscous_loss, capillary_loss, open, shared]);
        for (effect, new) in self.effects.iter_mut().zip(effects) {
            *effect = new.row();
        }
        LiquidForce {
            repulsion: viscous - pull,
            drag,
            ruptures: N::count((volume - kept).exceeds(zero)),
        }
    }
}

/// `x`, no less than `low` and no more than `high`.
#[inline(always)]
fn within<N: Lanes>(x: N, low: N, high: N) -> N {
    let x = N::choose(x.exceeds(low), x, low);
    N::choose(x.exceeds(high), high, x)
}
