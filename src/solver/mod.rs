//! How the state advances.
//!
//! In: a [`World`]. Out: the same world some steps later, or a [`Fault`] and the world as it was. The solver keeps only
//! caches of its own (neighbour lists, lane buffers), so a world that was restored or changed from outside simply goes on,
//! and neither the number of threads, nor the skins, nor how many steps a call takes show in a single bit of it.
//!
//! One step, in order: kick (half a step of velocity), drift (a step of position), refresh the lists if some grain has
//! moved far, forces pair by pair, sum per grain, kick. [`Solver::march`] is that table of contents; the last kick of a
//! step and the first of the next share one pass over the grains.
//!
//! What is not here: damping other than the contact laws', grains that are no spheres, periodic boundaries.

mod bridges;
mod contacts;
mod fault;
mod grid;
mod integrate;
mod neighbours;
mod order;
mod polyhedra;
mod portion;
mod profile;
mod row;
mod spring;
mod state;
mod team;
mod terms;
mod time_step;

pub use crate::lanes::Processor;
pub use fault::{Fault, FaultKind};
pub use profile::{Profile, Stage};
pub use terms::{ForceTerms, NormalLaw, force_terms};
pub use time_step::{Extremes, Limit, TimeStepAdvice, advise};

use crate::physics::law::{Law, LawUser};
use crate::world::World;
use crate::{lanes, physics::law};
use state::State;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};
use team::{Barrier, Team};

/// Advances worlds.
pub struct Solver {
    team: Team,
    processor: Processor,
    state: State,
    polyhedra: polyhedra::State,
    profile: Profile,
}

/// The profile reads the clock in one step out of this many: reading it costs as much as a hundred grains.
const STEPS_PER_TIMING: u64 = 16;

impl Solver {
    /// A solver that works on `threads` threads (at least one).
    pub fn new(threads: usize) -> Self {
        Self {
            team: Team::new(threads),
            processor: Processor::detect(),
            state: State::default(),
            polyhedra: polyhedra::State::default(),
            profile: Profile::default(),
        }
    }

    /// A solver that uses only what `processor` says, with the same results to the bit; [`Processor::Scalar`] makes it the
    /// plain twin of [`Solver::new`].
    pub fn on(processor: Processor, threads: usize) -> Self {
        Self {
            processor,
            ..Self::new(threads)
        }
    }

    /// Takes `steps` steps.
    ///
    /// # Errors
    /// A [`Fault`] when a grain's state becomes absurd; `world` is then as it was before the call.
    pub fn advance(&mut self, world: &mut World, steps: u64) -> Result<(), Fault> {
        if steps == 0 || world.grains.is_empty() {
            world.clock.step += steps;
            return Ok(());
        }
        // Later positions are finite as long as speeds are.
        if let Some(grain) = world.grains.position.iter().position(|x| !x.is_finite()) {
            return Err(Fault {
                grain,
                kind: FaultKind::NotFinite("position"),
                time: world.time(),
                good_time: world.time(),
            });
        }
        let begin = Instant::now();
        let result = if world.polyhedra.is_some() {
            self.advance_polyhedra(world, steps)
        } else {
            self.advance_spheres(world, steps)
        };
        self.profile.steps += steps;
        self.profile.grains = world.grains.len();
        self.profile.total += begin.elapsed();
        result
    }

    fn advance_spheres(&mut self, world: &mut World, steps: u64) -> Result<(), Fault> {
        self.exchange(|solver| solver.state.load(world));
        let march = March {
            solver: self,
            world,
            steps,
        };
        (world.law.choose(march)).map_err(|steps| self.state.diagnose(world, steps))?;
        self.exchange(|solver| solver.state.store(world, steps));
        self.profile.listed = self.state.listed();
        Ok(())
    }

    fn advance_polyhedra(&mut self, world: &mut World, steps: u64) -> Result<(), Fault> {
        self.exchange(|solver| solver.polyhedra.load(solver.processor, world));
        let Self {
            team,
            processor,
            polyhedra,
            profile,
            ..
        } = self;
        polyhedra
            .march(team, *processor, profile, world, steps)
            .map_err(|steps| polyhedra.diagnose(world, steps))?;
        self.exchange(|solver| solver.polyhedra.store(world, steps));
        self.profile.listed = self.polyhedra.listed();
        Ok(())
    }

    /// Copies state in or out, on the clock.
    fn exchange(&mut self, copy: impl FnOnce(&mut Self)) {
        let begin = Instant::now();
        copy(self);
        self.profile.stages[Stage::Exchange as usize] += begin.elapsed();
    }

    /// Where the time went since the last call.
    pub fn take_profile(&mut self) -> Profile {
        std::mem::take(&mut self.profile)
    }

    /// Takes `steps` steps; on a fault, says after how many.
    fn march(&mut self, law: impl Law, world: &World, steps: u64) -> Result<(), u64> {
        let mut done = 0;
        let mut refresh = self.state.start(self.processor);
        while done < steps {
            if refresh {
                let begin = Instant::now();
                self.profile.rebuilds += self.state.refresh();
                self.state.compute_constants(world);
                self.profile.stages[Stage::Neighbours as usize] += begin.elapsed();
            }
            let stretch = self.stretch(law, steps - done);
            done += stretch.steps;
            if stretch.fault {
                return Err(done);
            }
            // The end of a call cuts a list's life short: it says nothing of how long the list would have lived.
            if done < steps {
                self.state.adapt(stretch.steps);
                refresh = true;
            }
        }
        Ok(())
    }

    /// Takes up to `remaining` steps on the lists as they are; the team stays in step from beginning to end.
    #[expect(
        unsafe_code,
        reason = "the barriers here are what the phases' contracts ask for"
    )]
    fn stretch(&mut self, law: impl Law, remaining: u64) -> Stretch {
        let size = self.team.size();
        let barrier = Barrier::new(size);
        let (refresh, fault) = (AtomicBool::new(false), AtomicBool::new(false));
        let limit = remaining.min(self.state.steps_within_slack());
        let result = Mutex::new((0, [Duration::ZERO; 2]));
        let ruptures = AtomicU64::new(0);
        let phase = self.state.phase(size);
        let processor = self.processor;
        self.team.run(|member| {
            let mut timings = [Duration::ZERO; 2];
            let mut walls = phase.walls().to_vec();
            let mut steps = 0;
            while steps < limit
                && !refresh.load(Ordering::Relaxed)
                && !fault.load(Ordering::Relaxed)
            {
                let begin = (member == 0 && steps % STEPS_PER_TIMING == 0).then(Instant::now);
                // SAFETY: all members are between the same two barriers, each under its own number.
                let broken = unsafe { phase.forces(processor, law, &walls, member) };
                if broken > 0 {
                    ruptures.fetch_add(broken, Ordering::Relaxed);
                }
                barrier.wait(member);
                let middle = begin.map(|begin| (begin.elapsed(), Instant::now()));
                steps += 1;
                let last = steps == remaining;
                // SAFETY: likewise, one barrier further.
                let outcome = unsafe { phase.finish(processor, member, last) };
                raise(&refresh, outcome.refresh);
                raise(&fault, outcome.fault);
                if !last {
                    phase.step_walls(&mut walls);
                }
                barrier.wait(member);
                if let Some((forces, middle)) = middle {
                    timings[0] += forces;
                    timings[1] += middle.elapsed();
                }
            }
            if member == 0
                && let Ok(mut result) = result.lock()
            {
                *result = (steps, timings);
            }
        });
        self.state.count_ruptures(ruptures.into_inner());
        let (steps, timings) = result.into_inner().unwrap_or_default();
        let moves = if steps == remaining { steps - 1 } else { steps };
        (0..moves).for_each(|_| self.state.move_walls());
        let scale = STEPS_PER_TIMING.min(steps.max(1)) as u32;
        self.profile.stages[Stage::Contacts as usize] += timings[0] * scale;
        self.profile.stages[Stage::Integration as usize] += timings[1] * scale;
        Stretch {
            steps,
            fault: fault.into_inner(),
        }
    }
}

/// Steps of spheres under a law that is chosen once for all of them.
struct March<'a> {
    solver: &'a mut Solver,
    world: &'a World,
    steps: u64,
}

impl LawUser for March<'_> {
    type Output = Result<(), u64>;

    fn with<L: Law>(self, law: L) -> Self::Output {
        self.solver.march(law, self.world, self.steps)
    }
}

/// Sets `flag` where `raised`; writing it at every step would take its cache line from the other members.
fn raise(flag: &AtomicBool, raised: bool) {
    if raised {
        flag.store(true, Ordering::Relaxed);
    }
}

/// What a stretch of steps came to.
struct Stretch {
    steps: u64,
    fault: bool,
}
