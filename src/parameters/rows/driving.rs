//! What moves the grains and what they are a mixture of: drum, gravity, shares.

use crate::measure::elastic_energy;
use crate::parameters::parameter_row::{ANY, InWorld, Kind, PanelSection, ParameterRow, preset};
use crate::parameters::relabel;
use crate::physics::limits;
use crate::physics::units::{self, TURNING};
use crate::scene::{Scene, SceneContainer};
use crate::world::World;
use glam::DVec3;

/// Fastest drum a slider offers [rad/s], 10 rpm.
const FASTEST_DRUM: f64 = 10.0 / TURNING.shown.factor;
/// Strongest gravity a slider offers [m/s²].
const STRONGEST_GRAVITY: f64 = 20.0;

pub static DRUM_SPEED: ParameterRow = ParameterRow {
    key: "drum-speed",
    name: |_| "drum speed",
    symbol: "Ω",
    kind: Kind::Number(&TURNING),
    limits: Some(&limits::DRUM_SPEED),
    slider: |speed, _, _| {
        let fastest = FASTEST_DRUM.max(2.0 * speed.abs());
        -fastest..=fastest
    },
    presets: &[
        preset("still", 0.0),
        preset("the paper's", 0.5 / TURNING.shown.factor),
        preset("ten times", 5.0 / TURNING.shown.factor),
    ],
    description: "How fast the drum turns; positive is anticlockwise as you see it.",
    equation: |_| "v = Ω × r on rim and end plates",
    section: PanelSection::Drum,
    is_basic: |_, _| true,
    exists: |scene, _| scene.container.turns(),
    in_world: Some(InWorld {
        read: |world, _| Some(world.container.turning_speed().into()),
        write: |world, _, _, value| world.container.set_drum_speed(value.number()),
    }),
    ..ANY
};

pub static GRAVITY: ParameterRow = ParameterRow {
    key: "gravity",
    name: |_| "gravity",
    symbol: "g",
    kind: Kind::Number(&units::ACCELERATION),
    limits: Some(&limits::GRAVITY),
    slider: |magnitude, _, _| 0.0..=STRONGEST_GRAVITY.max(2.0 * magnitude),
    presets: &[
        preset("none", 0.0),
        preset("Moon", 1.62),
        preset("Mars", 3.71),
        preset("Earth", 9.81),
    ],
    description: "Strength of gravity; its direction stays.",
    equation: |_| "F = m g",
    section: PanelSection::Gravity,
    is_basic: |scene, _| !matches!(scene.container, SceneContainer::Drum { .. }),
    in_world: Some(InWorld {
        read: |world, _| Some(world.gravity.length().into()),
        write: |world, scene, _, value| world.set_gravity(value.number() * down(scene)),
    }),
    ..ANY
};

pub static SHARE: ParameterRow = ParameterRow {
    key: "share",
    name: |_| "share",
    symbol: "P",
    kind: Kind::Number(&units::SHARE),
    limits: Some(&limits::SHARE),
    slider: |_, scene, [species, _]| {
        let members = partners(scene, species);
        0.0..=members.iter().map(|member| scene.share(*member)).sum()
    },
    presets: &[preset("none", 0.0), preset("half", 0.5), preset("all", 1.0)],
    description: "Share of the grains by number; the next species of the same size gives or takes the difference.",
    equation: |_| "P_a = N_a / N; μ_p = Σ P_a P_b μ_ab, Eqs. 4.1 and 4.2 of Man et al. 2023",
    section: PanelSection::Mixture,
    is_basic: |scene, [species, _]| scene.species().last().is_some_and(|last| last.0 == species),
    rank: 1,
    exists: |scene, [species, _]| partners(scene, species).len() > 1,
    in_world: Some(InWorld {
        read: |world, [species, _]| relabel::share(world, species).map(Into::into),
        write: |world, scene, [species, _], value| {
            booked(world, |world| {
                relabel::set_share(scene, world, species, value.number());
            });
        },
    }),
    ..ANY
};

/// Direction of gravity, downwards where the scene has none.
fn down(scene: &Scene) -> DVec3 {
    scene.gravity.try_normalize().unwrap_or(DVec3::NEG_Y)
}

/// Indices of the species whose grains can change places with those of `species`, itself included.
fn partners(scene: &Scene, species: &str) -> Vec<usize> {
    let index = scene.species().iter().position(|own| own.0 == species);
    index.map_or_else(Vec::new, |index| scene.interchangeable_species(index))
}

/// Makes a change of masses or stiffnesses and books the energy it puts in as the command's work.
fn booked(world: &mut World, change: impl FnOnce(&mut World)) {
    let stored = |world: &World| world.kinetic_energy() + elastic_energy(world);
    let (energy, potential) = (stored(world), world.potential_energy());
    change(world);
    world.ledger.command_work += stored(world) - energy;
    let changed = world.potential_energy();
    world.ledger.close_gravity_segment(potential, changed);
}
