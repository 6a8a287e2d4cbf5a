//! The liquid side of the pair loop: bridges that form, pull, drag and break, as many side by side as there are lanes.
//!
//! In: gaps and relative motion of pairs of grains, their bridges. Out: the bridges' forces, what they lose, what their
//! liquid does when they break. A bridge forms where grains touch, breaks at its rupture gap, and walls have none.

use super::contacts::Pair;
use super::lanes::{Lanes, Quad, Row, dot, plus, side_by_side, times};
use super::law::{BridgeConstants, BridgeKinds, FilmConstants, attraction, contributions, drag};
use super::row::{row, vector};
use crate::world::{Bridge, Liquid};

/// What the solver keeps of a bridge; all zero where there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct BridgeRow {
    /// Volume [m³], transfer on rupture [m³], capillary attraction and viscous normal force at the last step [N].
    pub state: Row,
    /// Viscous force on the grain across the normal at the last step [N].
    pub drag: Row,
    /// What the attraction depends on: see [`BridgeConstants`].
    pub constants: Row,
}

/// What a bridge does beside its force: energy lost to viscosity and to capillary forces during the step [J], 1 where it
/// holds grains that do not touch, volume that the grain's film gains from its partner's [m³].
pub type LiquidAction = Row;

/// What bridges depend on.
#[derive(Clone, Copy)]
pub struct Wetting<'a> {
    /// The liquid.
    pub liquid: &'a Liquid,
    /// Volume of the film on every grain; the ghost has none [m³].
    pub films: &'a [f64],
    /// Constants of every kind of pair.
    pub constants: &'a [FilmConstants],
}

/// As many pairs as there are lanes, with their bridges and what those do.
pub struct BridgeGroup<'a> {
    /// What they depend on.
    pub wetting: Wetting<'a>,
    /// The pairs.
    pub pairs: &'a [Pair],
    /// Their bridges.
    pub rows: &'a mut [BridgeRow],
    /// What those do.
    pub actions: &'a mut [LiquidAction],
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
    /// The solver's copy of `bridge` between grains of these radii [m], one of several of these `kinds`.
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

    /// A bridge that forms between grains with these radii [m] and films [m³]; none where both are dry.
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

impl BridgeGroup<'_> {
    /// Lets bridges form where grains of these radii [m] touch.
    #[inline(always)]
    fn form<N: Lanes>(&mut self, depth: N, radii: [N; 2]) {
        let depths = depth.numbers();
        let films = self.wetting.films;
        for (k, (row, pair)) in self.rows.iter_mut().zip(self.pairs).enumerate() {
            if depths[k] > 0.0 && !row.exists() {
                let films = (films[pair.grain as usize], films[pair.partner as usize]);
                let radii = (radii[0].numbers()[k], radii[1].numbers()[k]);
                *row = BridgeRow::new(self.wetting.liquid, radii, films);
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
        let Encounter {
            depth,
            touching,
            approach,
            slip,
            compliance,
        } = *encounter;
        self.form(depth, radii);
        let rows = &self.rows;
        let [volume, transfer, old_attraction, old_viscous] =
            N::gather(processor, side_by_side::<N, _>(|k| &rows[k].state));
        let [x, y, z, _] = N::gather(processor, side_by_side::<N, _>(|k| &rows[k].drag));
        let old_drag = [x, y, z];
        let constants = N::gather(processor, side_by_side::<N, _>(|k| &rows[k].constants));

        let gap = -depth;
        let kept = N::choose(gap.exceeds(constants[3]), zero, volume);
        let held = kept.exceeds(zero);
        let [in_contact, smallest, largest, _] = film.1;
        let pull = attraction(processor, constants, within(gap, in_contact, largest));
        let pull = N::choose(held, pull, zero);
        let mobility = compliance * film.0[3];
        let [normal, across] = drag(processor, film.0, within(gap, smallest, largest), mobility);
        let viscous = N::choose(held, normal * approach, zero);
        let across = N::choose(held, across, zero);
        let drag = times(slip, -across);

        // Mean of the old and the new force, times the way between: losses close to second order in the step.
        let half = N::splat(processor, 0.5) * dt;
        let resisted = (old_viscous + viscous) * approach;
        let dragged = dot(plus(old_drag, drag), slip);
        let viscous_loss = half * (resisted - dragged);
        let capillary_loss = -(half * ((old_attraction + pull) * approach));
        let open = N::choose(touching, zero, N::choose(held, one, zero));
        let shared = N::choose(held, zero, transfer);

        let states = N::rows([kept, transfer - shared, pull, viscous]);
        let drags = N::rows([drag[0], drag[1], drag[2], zero]);
        let actions = N::rows([viscous_loss, capillary_loss, open, shared]);
        for k in 0..N::COUNT {
            self.rows[k].state = states[k].row();
            self.rows[k].drag = drags[k].row();
            self.actions[k] = actions[k].row();
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
