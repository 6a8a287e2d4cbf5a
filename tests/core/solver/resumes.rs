//! Every scene that is shipped, resumed at random steps: a solver that knows nothing of a world
//! goes on to the same bits as the one that brought it there.
//!
//! `GRAINFALL_RESUMES=5000` resumes each scene that often; in a test it is [`AS_A_TEST`] times.
//! `GRAINFALL_RESUMES_OF=small-column,column` resumes these scenes alone.

use super::*;
use grainfall::scene::{BuiltIn, built_in};
use grainfall::solver::advise;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// How often a scene is resumed in a test.
const AS_A_TEST: u64 = 12;
/// The most grains of a scene that is resumed in a test.
const FEW: usize = 600;
/// So many resumes of a long series follow upon every step, as a beginning tries caches hardest.
const ONE_BY_ONE: u64 = 300;
/// Most steps from one resume to the next, later.
const GAP: u64 = 100;
/// Most steps that a resumed run takes.
const STEPS: u64 = 12;
/// Most grains times resumes of one scene in a long series.
const GRAINS: u64 = 8_000_000;

/// What became of the resumes of a scene.
#[derive(Default)]
struct Tally {
    resumes: u64,
    /// Contacts at the resumes, in all.
    contacts: usize,
    /// Steps after which a resumed run differed.
    strays: Vec<u64>,
}

impl Tally {
    /// Resumes `world` after `steps`, and lets `solver` take it there too.
    fn resume(&mut self, solver: &mut Solver, threads: usize, world: &mut World, steps: u64) {
        let begin = world.clock.step;
        let mut resumed = world.clone();
        let fresh = Solver::new(threads).advance(&mut resumed, steps);
        let uninterrupted = solver.advance(world, steps);
        if fresh != uninterrupted || resumed.hash() != world.hash() {
            self.strays.push(begin);
        }
        self.resumes += 1;
        let features = world.polyhedra.as_ref().map_or(0, |all| all.features.len());
        self.contacts += world.contacts.len() + features;
    }
}

/// Resumes a scene's `world` so often, from its beginning on, each time by another number of
/// threads; a `series` begins with a resume after every step.
fn resumes(mut world: World, wanted: u64, series: bool) -> Tally {
    let mut rng = ChaCha8Rng::seed_from_u64(world.grains.len() as u64);
    let mut solver = Solver::new(2);
    let mut tally = Tally::default();
    while tally.resumes < wanted {
        let one_by_one = series && tally.resumes < ONE_BY_ONE;
        let threads = rng.random_range(1..=3);
        let steps = if one_by_one {
            1
        } else {
            rng.random_range(1..=STEPS)
        };
        tally.resume(&mut solver, threads, &mut world, steps);
        let gap = if one_by_one {
            0
        } else {
            rng.random_range(0..GAP)
        };
        if solver.advance(&mut world, gap).is_err() {
            break;
        }
    }
    tally
}

#[test]
fn scenes_that_are_shipped_go_on_to_the_same_bits_wherever_they_are_resumed() {
    let series: Option<u64> = std::env::var("GRAINFALL_RESUMES")
        .ok()
        .map(|text| text.parse().expect("GRAINFALL_RESUMES is a whole number"));
    let mut scenes: Vec<_> = wanted_scenes().into_iter().map(beginning).collect();
    // The quickest first: a long series that is stopped has seen most scenes.
    scenes.sort_by_key(|(_, world)| (world.polyhedra.is_some(), world.grains.len()));
    let (mut touched, mut resumed) = (0, 0);
    for (name, world) in scenes {
        let grains = world.grains.len();
        if series.is_none() && grains > FEW {
            continue;
        }
        let wanted = series.unwrap_or(AS_A_TEST).min(GRAINS / grains as u64);
        let tally = resumes(world, wanted, series.is_some());
        resumed += tally.resumes;
        println!(
            "{name}: {grains} grains, {} resumes, {} contacts at each; {resumed} resumes so far",
            tally.resumes,
            tally.contacts as u64 / tally.resumes.max(1)
        );
        assert_eq!(tally.strays, Vec::<u64>::new(), "{name}");
        touched += tally.contacts;
    }
    assert!(touched > 0, "grains touch");
}

/// The scenes that `GRAINFALL_RESUMES_OF` names, or all.
fn wanted_scenes() -> Vec<&'static BuiltIn> {
    let Ok(names) = std::env::var("GRAINFALL_RESUMES_OF") else {
        return built_in().iter().collect();
    };
    let named = |name: &str| built_in().iter().find(|scene| scene.name == name);
    let scenes = names
        .split(',')
        .map(|name| named(name).unwrap_or_else(|| panic!("{name} is no scene")));
    scenes.collect()
}

/// A scene's name and its world as placed.
fn beginning(scene: &BuiltIn) -> (&'static str, World) {
    let known = Scene::open(scene.name).unwrap();
    (scene.name, build(&known, advise(&known).time_step))
}

/// A step of the paper's column before one at which two edges, along which neighbouring cells were
/// cut apart, no longer count as parallel and are nearest at their ends, which touch.
const OUT_OF_PARALLEL: u64 = 288;

#[test]
fn papers_column_goes_on_to_the_same_bits_where_edges_come_out_of_parallel() {
    let scene = built_in().iter().find(|scene| scene.name == "column");
    let (_, mut world) = beginning(scene.expect("a built-in scene"));
    let mut solver = Solver::new(2);
    solver.advance(&mut world, OUT_OF_PARALLEL).unwrap();
    let mut tally = Tally::default();
    for _ in 0..4 {
        tally.resume(&mut solver, 2, &mut world, 1);
    }
    assert!(tally.contacts > 400_000, "{}", tally.contacts);
    assert_eq!(tally.strays, Vec::<u64>::new());
}
