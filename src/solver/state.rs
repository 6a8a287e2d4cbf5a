//! The solver's working copy of a world: rows, lists and the constants of each kind of pair.
//!
//! [`State::load`] takes a world in, [`State::store`] puts it back; both are exact. Between them only [`Phase`] moves it.

use super::bridges::{BridgeColumns, BridgeRow, Bridges, LiquidAction, Wetting};
use super::contacts::{Action, Body, Forces, GROUP, Pair, PairRows, Surroundings, WallBody};
use super::integrate::{BridgeLoad, Finish, Incidence, Load, Motion, Outcome, Start};
use super::lanes::Processor;
use super::law::{BridgeKinds, FilmConstants, Law, PairConstants, contributions, rupture_gap};
use super::neighbours::{Neighbours, PairList, Parts, grain_key, wall_key};
use super::order::Order;
use super::portion::Portion;
use super::row::{Row, length_squared, row, vector};
use super::team::Shared;
use super::{Fault, FaultKind};
use crate::physics::Liquid;
use crate::world::{Contact, Partner, Surface, World};
use std::collections::HashMap;
use std::ops::Range;

/// A grain that moves by more than this share of its radius in one step is lost.
const LARGEST_MOVE: f64 = 0.1;

/// The working copy. Rows of grains stand in the places that the order gives them, and pairs name places.
#[derive(Default)]
pub struct State {
    order: Order,
    bodies: Vec<Body>,
    loads: Vec<Load>,
    walls: Vec<WallBody>,
    neighbours: Neighbours,
    kinds: Kinds,
    motion: Motion,
    /// The liquid, where there is any.
    liquid: Option<Liquid>,
    /// Volume of the film on every grain and, of none, on the ghost; empty where nothing is wet [m³].
    films: Vec<f64>,
    /// What the bridges of every grain have done; empty where nothing is wet.
    bridge_loads: Vec<BridgeLoad>,
    /// Bridges that broke since the world was taken in.
    ruptures: u64,
}

/// Kinds of pairs: grains of one class (radius, mass, material) are alike to every law.
#[derive(Default)]
struct Kinds {
    class_of: Vec<u32>,
    wall_materials: Vec<u16>,
    index: HashMap<(u32, Side), u32>,
    /// A pair of each kind, to compute its constants from.
    examples: Vec<(usize, Partner)>,
    constants: Vec<PairConstants>,
    /// What bridges depend on, for each kind; empty where nothing is wet.
    films: Vec<FilmConstants>,
}

/// The second side of a kind of pair.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Side {
    Class(u32),
    Wall(u32),
}

impl Kinds {
    /// Sorts the grains into classes; false when they are not those known before.
    fn classify(&mut self, world: &World) -> bool {
        let grains = &world.grains;
        let mut classes = HashMap::new();
        let class_of: Vec<u32> = (0..grains.len())
            .map(|i| {
                let material = world.species[usize::from(grains.species[i].0)].material;
                let key = (
                    grains.radius[i].to_bits(),
                    grains.mass[i].to_bits(),
                    material,
                );
                let next = classes.len() as u32;
                *classes.entry(key).or_insert(next)
            })
            .collect();
        let wall_materials: Vec<u16> = world
            .container
            .walls
            .iter()
            .map(|wall| wall.material.0)
            .collect();
        let known = self.class_of == class_of && self.wall_materials == wall_materials;
        if !known {
            *self = Self {
                class_of,
                wall_materials,
                ..Self::default()
            };
        }
        known
    }

    /// Computes the constants of every kind from the world's present materials.
    fn compute(&mut self, world: &World) {
        self.constants.clear();
        self.films.clear();
        let liquid = world.wetting();
        for (grain, partner) in &self.examples {
            let pairing = world.pairing(*grain, *partner);
            let constants = pairing.constants(world.law, &world.materials, liquid.is_some());
            self.constants.push(constants);
            self.films
                .extend(liquid.map(|liquid| FilmConstants::of(&pairing, liquid)));
        }
    }

    fn of(&mut self, grain: u32, partner: Partner) -> u32 {
        let class = self.class_of[grain as usize];
        let side = match partner {
            Partner::Grain(j) => Side::Class(self.class_of[j as usize]),
            Partner::Wall(w) => Side::Wall(w),
        };
        let next = self.examples.len() as u32;
        *self.index.entry((class, side)).or_insert_with(|| {
            self.examples.push((grain as usize, partner));
            next
        })
    }
}

impl State {
    /// Counts bridges that broke.
    pub fn count_ruptures(&mut self, ruptures: u64) {
        self.ruptures += ruptures;
    }

    /// Takes `world` in.
    pub fn load(&mut self, world: &World) {
        let (grains, dt) = (&world.grains, world.clock.time_step);
        if !self.kinds.classify(world) {
            self.neighbours.forget();
        }
        if self.order.is_stale(grains, self.neighbours.rebuilds) {
            self.order.choose(grains, self.neighbours.rebuilds);
            self.neighbours.forget();
        }
        self.kinds.compute(world);
        self.walls.clear();
        self.walls
            .extend(world.container.walls.iter().map(|wall| WallBody {
                surface: wall.surface,
                motion: wall.motion,
            }));
        self.motion = Motion {
            dt,
            gravity: row(world.gravity, 0.0),
            slack_squared: 0.0,
        };
        self.bodies.clear();
        self.loads.clear();
        for i in self.order.grains().iter().map(|grain| *grain as usize) {
            let radius = grains.radius[i];
            self.bodies.push(Body {
                position: row(grains.position[i], 1.0 / grains.mass[i]),
                velocity: row(grains.velocity[i], 1.0 / grains.inertia[i]),
                spin: row(grains.spin[i], radius),
                free_spin: [0.0; 4],
            });
            let speed_limit = LARGEST_MOVE * radius / dt;
            self.loads.push(Load {
                force: row(grains.force[i], 0.0),
                torque: row(grains.torque[i], 0.0),
                rolling: row(grains.rolling_torque[i], f64::from(grains.contact_count[i])),
                exchanged: grains.exchanged[i],
                compliance: dt / grains.inertia[i],
                speed_limit_squared: speed_limit * speed_limit,
            });
        }
        // The ghost that fills groups of pairs up.
        self.bodies.push(Body::default());
        self.load_liquid(world);
        self.refresh_lists(world);
        self.load_springs(&world.contacts);
    }

    fn load_liquid(&mut self, world: &World) {
        self.liquid = world.wetting().copied();
        self.films.clear();
        self.bridge_loads.clear();
        self.ruptures = 0;
        let Some(liquid) = self.liquid else {
            self.neighbours.set_reach(None);
            return;
        };
        let grains = &world.grains;
        for i in self.order.grains().iter().map(|grain| *grain as usize) {
            let [viscous, capillary] = grains.liquid_loss[i];
            let open = f64::from(grains.open_bridges[i]);
            self.bridge_loads.push([viscous, capillary, open]);
            self.films.push(grains.film[i]);
        }
        self.films.push(0.0);
        self.neighbours
            .set_reach(Some(largest_reach(world, &liquid)));
        self.adopt_bridges(world, &liquid);
    }

    /// Makes the pairs of `world` the listed ones, so that the next refresh keeps all that bridges hold.
    fn adopt_bridges(&mut self, world: &World, liquid: &Liquid) {
        let mut kinds = BridgeKinds::of(liquid);
        let mut rows = Vec::new();
        for contact in &world.contacts {
            let Partner::Grain(partner) = contact.partner else {
                continue;
            };
            let radius = &world.grains.radius;
            let radii = (radius[contact.grain as usize], radius[partner as usize]);
            let bridge = contact.bridge.as_ref();
            let bridge = bridge.map_or(BridgeRow::default(), |bridge| {
                BridgeRow::of(bridge, &mut kinds, radii)
            });
            rows.push((self.pair(contact), spring(contact), bridge));
        }
        rows.sort_unstable_by_key(|(pair, ..)| grain_key(pair));
        let mut list = PairList {
            bridges: Bridges::none(rows.len()),
            ..PairList::default()
        };
        for (k, (pair, spring, bridge)) in rows.into_iter().enumerate() {
            list.pairs.push(pair);
            list.springs.push(spring);
            list.bridges.set(k, &bridge);
        }
        self.neighbours.adopt(list);
    }

    /// The pair of a contact, by places.
    fn pair(&self, contact: &Contact) -> Pair {
        Pair {
            grain: self.order.place(contact.grain),
            partner: match contact.partner {
                Partner::Grain(j) => self.order.place(j),
                Partner::Wall(w) => w,
            },
            kind: 0,
        }
    }

    /// Makes the lists fit the positions that were just loaded.
    fn refresh_lists(&mut self, world: &World) {
        if self.liquid.is_some() || !self.neighbours.active_covers(&self.bodies, &self.walls) {
            self.refresh();
        }
        self.kinds.compute(world);
        self.motion.slack_squared = self.neighbours.slack().powi(2);
    }

    fn load_springs(&mut self, contacts: &[Contact]) {
        let rows = contacts.iter().map(|contact| (self.pair(contact), contact));
        let (mut of_grains, mut of_walls): (Vec<_>, Vec<_>) =
            rows.partition(|(_, contact)| matches!(contact.partner, Partner::Grain(_)));
        let Neighbours { grains, walls, .. } = &mut self.neighbours;
        for (list, rows, key) in [
            (grains, &mut of_grains, grain_key as fn(&Pair) -> _),
            (walls, &mut of_walls, wall_key),
        ] {
            rows.sort_unstable_by_key(|(pair, _)| key(pair));
            let rows = rows.iter().map(|(pair, contact)| (*pair, spring(contact)));
            let (pairs, springs): (Vec<_>, Vec<_>) = rows.unzip();
            list.load_springs(&pairs, &springs, key);
        }
    }

    /// Puts the state, `steps` steps on, back into `world`.
    pub fn store(&self, world: &mut World, steps: u64) {
        let grains = &mut world.grains;
        let places = self.order.grains().iter().map(|grain| *grain as usize);
        for (i, (body, load)) in places.clone().zip(self.bodies.iter().zip(&self.loads)) {
            grains.position[i] = vector(body.position);
            grains.velocity[i] = vector(body.velocity);
            grains.spin[i] = vector(body.spin);
            grains.force[i] = vector(load.force);
            grains.torque[i] = vector(load.torque);
            grains.rolling_torque[i] = vector(load.rolling);
            grains.contact_count[i] = load.rolling[3] as u32;
            grains.exchanged[i] = load.exchanged;
        }
        let wet = self.bridge_loads.iter().zip(&self.films);
        for (i, ([viscous, capillary, open], film)) in places.zip(wet) {
            grains.film[i] = *film;
            grains.open_bridges[i] = *open as u32;
            grains.liquid_loss[i] = [*viscous, *capillary];
        }
        world.ledger.ruptures += self.ruptures;
        world.clock.step += steps;
        let container = &mut world.container;
        let turn = container.drum_speed() * self.motion.dt;
        // Added step by step, so that the angle does not depend on how many steps a call takes.
        (0..steps).for_each(|_| container.angle += turn);
        for (wall, body) in container.walls.iter_mut().zip(&self.walls) {
            wall.surface = body.surface;
        }
        world.contacts.clear();
        self.collect_contacts(&mut world.contacts);
    }

    fn collect_contacts(&self, contacts: &mut Vec<Contact>) {
        let grains = self.order.grains();
        for i in 0..self.loads.len() as u32 {
            let parts = self.neighbours.parts.of(self.order.place(i) as usize);
            let own = parts
                .iter()
                .filter_map(|part| self.neighbours.contact(*part));
            contacts.extend(own.map(|contact| Contact {
                grain: i,
                partner: match contact.partner {
                    Partner::Grain(place) => Partner::Grain(grains[place as usize]),
                    wall @ Partner::Wall(_) => wall,
                },
                ..contact
            }));
        }
    }

    /// Number of active pairs.
    pub fn listed(&self) -> usize {
        self.neighbours.grains.pairs.len() + self.neighbours.walls.pairs.len()
    }

    /// Starts the first step of a call; true when the active list must be refreshed before forces.
    pub fn start(&mut self, processor: Processor) -> bool {
        self.move_walls();
        let Self {
            bodies,
            loads,
            neighbours,
            motion,
            bridge_loads,
            ..
        } = self;
        let count = loads.len();
        let references = &neighbours.reference;
        processor
            .run(Start {
                motion,
                bodies: &mut bodies[..count],
                loads,
                bridge_loads,
                references,
            })
            .refresh
    }

    /// Brings the lists up to date with the positions; returns how often the near list was built.
    pub fn refresh(&mut self) -> u64 {
        let Self {
            bodies,
            walls,
            neighbours,
            kinds,
            order,
            ..
        } = self;
        let before = neighbours.rebuilds;
        let kinds = std::cell::RefCell::new(kinds);
        let grains = order.grains();
        neighbours.refresh(
            bodies,
            walls,
            grains,
            |i, j| kinds.borrow_mut().of(i, Partner::Grain(j)),
            |i, w| kinds.borrow_mut().of(i, Partner::Wall(w)),
        );
        self.motion.slack_squared = self.neighbours.slack().powi(2);
        self.neighbours.rebuilds - before
    }

    /// Makes the active skin suit lists that live for `steps` steps.
    pub fn adapt(&mut self, steps: u64) {
        self.neighbours.adapt(steps);
    }

    /// Constants for kinds of pairs that a refresh has met for the first time.
    pub fn compute_constants(&mut self, world: &World) {
        if self.kinds.constants.len() < self.kinds.examples.len() {
            self.kinds.compute(world);
        }
    }

    /// Steps after which a moving plane may have used up its half of the active skin.
    pub fn steps_within_slack(&self) -> u64 {
        let speed = self.walls.iter().map(WallBody::speed).fold(0.0, f64::max);
        if speed > 0.0 {
            (self.neighbours.slack() / (speed * self.motion.dt)).max(1.0) as u64
        } else {
            u64::MAX
        }
    }

    /// Moves the walls by one step.
    pub fn move_walls(&mut self) {
        move_walls(&mut self.walls, self.motion.dt);
    }

    /// Lends the state to a team of `size` members.
    pub fn phase(&mut self, size: usize) -> Phase<'_> {
        let portions = Portion::all(&self.neighbours, size);
        let Self {
            bodies,
            loads,
            walls,
            neighbours,
            kinds,
            motion,
            liquid,
            films,
            bridge_loads,
            ..
        } = self;
        let Neighbours {
            grains,
            walls: at_walls,
            actions,
            liquid_actions,
            parts,
            reference,
            ..
        } = neighbours;
        Phase {
            bodies: Shared::new(bodies),
            loads: Shared::new(loads),
            grain_springs: Shared::new(&mut grains.springs),
            wall_springs: Shared::new(&mut at_walls.springs),
            actions: Shared::new(actions),
            bridges: Shared::new(&mut grains.bridges.groups),
            liquid_actions: Shared::new(liquid_actions),
            films: Shared::new(films),
            bridge_loads: Shared::new(bridge_loads),
            liquid: liquid.as_ref(),
            film_constants: &kinds.films,
            grain_pairs: &grains.pairs,
            grain_kind: grains.kind,
            wall_pairs: &at_walls.pairs,
            parts,
            reference,
            constants: &kinds.constants,
            walls,
            motion: *motion,
            portions,
        }
    }

    /// What went wrong with which grain, `steps` steps after `world`.
    pub fn diagnose(&self, world: &World, steps: u64) -> Fault {
        let rows = self.bodies.iter().zip(&self.loads);
        let found = self.order.grains().iter().zip(rows);
        let (grain, kind) = found
            .filter_map(|(grain, (body, load))| Some((*grain, self.judge(body, load)?)))
            .min_by_key(|(grain, _)| *grain)
            .unwrap_or((0, FaultKind::NotFinite("state")));
        Fault {
            grain: grain as usize,
            kind,
            time: world.clock.time_at(world.clock.step + steps),
            good_time: world.time(),
        }
    }

    fn judge(&self, body: &Body, load: &Load) -> Option<FaultKind> {
        let position = vector(body.position);
        let behind = self
            .walls
            .iter()
            .map(|wall| -wall.surface.distance(position).0)
            .fold(f64::NEG_INFINITY, f64::max);
        let speed_squared = length_squared(body.velocity);
        if !position.is_finite() {
            Some(FaultKind::NotFinite("position"))
        } else if behind >= 0.0 {
            Some(FaultKind::BehindWall(behind))
        } else if !speed_squared.is_finite() {
            Some(FaultKind::NotFinite("velocity"))
        } else if !length_squared(body.spin).is_finite() {
            Some(FaultKind::NotFinite("spin"))
        } else if speed_squared > load.speed_limit_squared {
            Some(FaultKind::TooFast(speed_squared.sqrt()))
        } else {
            None
        }
    }
}

/// What the spring of a contact holds, as a row.
fn spring(contact: &Contact) -> Row {
    row(contact.spring, contact.stiffness)
}

/// Largest gap that a bridge of `world` can hold [m], for the largest grains and the thickest films.
fn largest_reach(world: &World, liquid: &Liquid) -> f64 {
    let largest = |column: &[f64]| column.iter().copied().fold(0.0, f64::max);
    let (radius, film) = (largest(&world.grains.radius), largest(&world.grains.film));
    let (first, second) = contributions(liquid, (radius, radius), (film, film));
    let held = world.contacts.iter().filter_map(|c| c.bridge.as_ref());
    let volume = held
        .map(|bridge| bridge.volume)
        .fold(first + second, f64::max);
    rupture_gap(liquid, (radius, radius), volume)
}

/// Moves walls that have a velocity by one step.
pub(super) fn move_walls(walls: &mut [WallBody], dt: f64) {
    for wall in walls {
        match &mut wall.surface {
            Surface::Plane { point, .. } => *point += wall.motion.velocity * dt,
            Surface::Tube { rim, .. } => *rim += wall.motion.velocity.y * dt,
            Surface::Cylinder { .. } => {}
        }
    }
}

impl WallBody {
    /// How far the surface is from where it was [m]; without bound where it is another surface.
    pub fn moved_from(&self, old: &Surface) -> f64 {
        match (self.surface, *old) {
            (
                Surface::Plane { point, normal },
                Surface::Plane {
                    point: before,
                    normal: same,
                },
            ) if normal == same => (point - before).dot(normal).abs(),
            (
                Surface::Tube { radius, rim },
                Surface::Tube {
                    radius: same,
                    rim: before,
                },
            ) if radius == same => (rim - before).abs(),
            (Surface::Cylinder { radius }, Surface::Cylinder { radius: same })
                if radius == same =>
            {
                0.0
            }
            _ => f64::INFINITY,
        }
    }

    /// Speed at which the surface moves along its normal [m/s].
    pub fn speed(&self) -> f64 {
        match self.surface {
            Surface::Plane { normal, .. } => self.motion.velocity.dot(normal).abs(),
            Surface::Tube { .. } => self.motion.velocity.y.abs(),
            Surface::Cylinder { .. } => 0.0,
        }
    }
}

/// The state on loan to a team for a stretch of steps: each member forces and moves its own share.
pub struct Phase<'a> {
    bodies: Shared<'a, Body>,
    loads: Shared<'a, Load>,
    grain_springs: Shared<'a, Row>,
    wall_springs: Shared<'a, Row>,
    actions: Shared<'a, Action>,
    bridges: Shared<'a, BridgeColumns>,
    liquid_actions: Shared<'a, LiquidAction>,
    films: Shared<'a, f64>,
    bridge_loads: Shared<'a, BridgeLoad>,
    liquid: Option<&'a Liquid>,
    film_constants: &'a [FilmConstants],
    grain_pairs: &'a [Pair],
    grain_kind: Option<u32>,
    wall_pairs: &'a [Pair],
    parts: &'a Parts,
    reference: &'a [Row],
    constants: &'a [PairConstants],
    walls: &'a [WallBody],
    motion: Motion,
    /// What each member works on.
    portions: Vec<Portion>,
}

#[expect(
    unsafe_code,
    reason = "phases end at barriers: what one writes in shares the other reads whole"
)]
impl Phase<'_> {
    /// Computes `member`'s portion of the pairs. `walls` are the walls at the time of the positions. Returns how many
    /// bridges broke.
    ///
    /// # Safety
    /// Every member calls it between the same two barriers, each with its own number, and nothing else.
    pub unsafe fn forces<L: Law>(
        &self,
        processor: Processor,
        law: L,
        walls: &[WallBody],
        member: usize,
    ) -> u64 {
        let Portion {
            pairs, at_walls, ..
        } = &self.portions[member];
        // SAFETY: in this phase bodies and films are only read; springs, bridges and actions only written, each member its
        // own portion.
        let (bodies, films) = unsafe { (self.bodies.all(), self.films.all()) };
        // SAFETY: likewise.
        let of_grains = unsafe { self.rows_of_grains(pairs) };
        // SAFETY: likewise.
        let of_walls = at_walls
            .iter()
            .map(|own| unsafe { self.rows_at_walls(own) });
        processor.run(Forces {
            surroundings: Surroundings {
                law,
                dt: self.motion.dt,
                bodies,
                walls,
                constants: self.constants,
                wetting: self.liquid.map(|liquid| Wetting {
                    liquid,
                    films,
                    constants: self.film_constants,
                }),
            },
            of_grains,
            of_walls,
        })
    }

    /// The rows of these pairs of grains.
    ///
    /// # Safety
    /// As for [`Phase::forces`], by whom the pairs belong to.
    unsafe fn rows_of_grains(&self, pairs: &Range<usize>) -> PairRows<'_> {
        let wet = match self.liquid {
            Some(_) => pairs.clone(),
            None => 0..0,
        };
        // SAFETY: the caller's promise.
        unsafe {
            PairRows {
                pairs: &self.grain_pairs[pairs.clone()],
                kind: self.grain_kind,
                springs: self.grain_springs.range_mut(pairs.clone()),
                actions: self.actions.range_mut(pairs.clone()),
                bridges: (self.bridges).range_mut(wet.start / GROUP..wet.end / GROUP),
                liquid_actions: self.liquid_actions.range_mut(wet),
            }
        }
    }

    /// The rows of these pairs with walls, whose actions stand behind those of the grains.
    ///
    /// # Safety
    /// As for [`Phase::forces`], by whom the pairs belong to.
    unsafe fn rows_at_walls(&self, pairs: &Range<usize>) -> PairRows<'_> {
        let offset = self.grain_pairs.len();
        // SAFETY: the caller's promise.
        unsafe {
            PairRows {
                pairs: &self.wall_pairs[pairs.clone()],
                kind: None,
                springs: self.wall_springs.range_mut(pairs.clone()),
                actions: (self.actions).range_mut(pairs.start + offset..pairs.end + offset),
                bridges: &mut [],
                liquid_actions: &mut [],
            }
        }
    }

    /// Sums the forces on `member`'s portion of the grains and moves them.
    ///
    /// # Safety
    /// As for [`Phase::forces`].
    pub unsafe fn finish(&self, processor: Processor, member: usize, last: bool) -> Outcome {
        let own = self.portions[member].grains.clone();
        let own_films = match self.liquid {
            Some(_) => own.clone(),
            None => 0..0,
        };
        // SAFETY: in this phase actions are only read, bodies, loads and films only written, each member its own share.
        let (bodies, loads, films, bridge_loads, actions, liquid_actions) = unsafe {
            (
                self.bodies.range_mut(own.clone()),
                self.loads.range_mut(own.clone()),
                self.films.range_mut(own_films.clone()),
                self.bridge_loads.range_mut(own_films),
                self.actions.all(),
                self.liquid_actions.all(),
            )
        };
        let pairs = Incidence {
            actions,
            liquid_actions,
            parts: self.parts,
        };
        let (motion, begin, references) = (&self.motion, own.start, &self.reference[own]);
        macro_rules! finish {
            ($wet:literal) => {
                processor.run(Finish::<$wet> {
                    motion,
                    pairs,
                    begin,
                    bodies,
                    loads,
                    films,
                    bridge_loads,
                    references,
                    last,
                })
            };
        }
        if self.liquid.is_some() {
            finish!(true)
        } else {
            finish!(false)
        }
    }

    /// The walls at the beginning of the stretch.
    pub fn walls(&self) -> &[WallBody] {
        self.walls
    }

    /// Moves a member's own copy of the walls by one step.
    pub fn step_walls(&self, walls: &mut [WallBody]) {
        move_walls(walls, self.motion.dt);
    }
}
