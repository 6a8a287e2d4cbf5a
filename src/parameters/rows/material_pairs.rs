//! How two materials meet.

use crate::parameters::Names;
use crate::parameters::parameter_row::{ANY, InWorld, PanelSection, ParameterRow, preset};
use crate::physics::{PairProperties, limits};
use crate::scene::{Scene, SceneContainer, SceneGrain, SceneGrains, ScenePlane};
use crate::world::World;

pub static WET_FRICTION: ParameterRow = ParameterRow {
    key: "wet-friction",
    name: |_| "wet friction",
    symbol: "μ_w",
    limits: Some(&limits::FRICTION),
    slider: |friction, _, _| 0.0..=friction.max(1.0),
    presets: &[
        preset("none", 0.0),
        preset("wet glass", 0.1),
        preset("dry glass", 0.4),
    ],
    description: "Friction where there is liquid: sliding starts when the tangential force reaches this share of the contact's \
                  normal force.",
    equation: coulomb,
    is_basic: is_of_note,
    rank: 2,
    is_of_liquid: true,
    exists: |scene, _| scene.liquid.is_some(),
    in_world: Some(InWorld {
        read: |world, names| Some(pair(world, names)?.wet_friction.into()),
        write: |world, _, names, value| {
            change(world, names, |pair| pair.wet_friction = value.number());
        },
    }),
    ..PAIR
};

pub static FRICTION: ParameterRow = ParameterRow {
    key: "friction",
    name: |scene| {
        if scene.liquid.is_some() {
            "dry friction"
        } else {
            "friction"
        }
    },
    symbol: "μ",
    limits: Some(&limits::FRICTION),
    slider: |friction, _, _| 0.0..=friction.max(1.0),
    presets: &[
        preset("none", 0.0),
        preset("smooth", 0.1),
        preset("dry glass", 0.4),
        preset("rough", 0.8),
    ],
    description: "Sliding starts when the tangential force reaches this share of the normal force.",
    equation: coulomb,
    is_basic: |scene, names| {
        scene.liquid.is_none() && is_of_note(scene, names) && !bounces_straight(scene)
    },
    rank: 2,
    in_world: Some(InWorld {
        read: |world, names| Some(pair(world, names)?.friction.into()),
        write: |world, _, names, value| {
            change(world, names, |pair| pair.friction = value.number());
        },
    }),
    ..PAIR
};

pub static ROLLING_FRICTION: ParameterRow = ParameterRow {
    key: "rolling-friction",
    name: |_| "rolling friction",
    symbol: "μ_R",
    limits: Some(&limits::FRICTION),
    slider: |friction, _, _| 0.0..=friction.max(0.2),
    presets: &[preset("none", 0.0), preset("glass", 0.01)],
    description: "Rolling is opposed by a torque of this share of the normal force times the effective radius.",
    equation: |_| "q = −μ_R k_n δ r* ω/|ω|, Eq. 10 of Kasper et al. 2021",
    exists: |scene, _| !scene.is_polyhedral(),
    in_world: Some(InWorld {
        read: |world, names| Some(pair(world, names)?.rolling_friction.into()),
        write: |world, _, names, value| {
            change(world, names, |pair| pair.rolling_friction = value.number());
        },
    }),
    ..PAIR
};

pub static RESTITUTION: ParameterRow = ParameterRow {
    key: "restitution",
    name: |_| "restitution",
    symbol: "e",
    limits: Some(&limits::RESTITUTION),
    slider: |restitution, _, _| restitution.min(0.05)..=1.0,
    presets: &[
        preset("dull", 0.1),
        preset("glass on the drum", 0.72),
        preset("glass", 0.95),
        preset("no loss", 1.0),
    ],
    description: "Rebound speed over impact speed of a head-on impact.",
    equation: |scene| scene.law.words().restitution,
    is_basic: |scene, _| is_listed(scene) && !rests(scene),
    in_world: Some(InWorld {
        read: |world, names| Some(pair(world, names)?.restitution.into()),
        write: |world, _, names, value| {
            change(world, names, |pair| pair.restitution = value.number());
        },
    }),
    ..PAIR
};

/// What these rows have in common.
const PAIR: ParameterRow = ParameterRow {
    section: PanelSection::Contact,
    acts: |scene, [a, b]| can_meet(scene, a, b),
    ..ANY
};

fn coulomb(scene: &Scene) -> &'static str {
    scene.law.words().friction
}

fn is_listed(scene: &Scene) -> bool {
    matches!(scene.grains, SceneGrains::List(_))
}

/// The only grain and the only plane of `scene`, where there is nothing else.
fn alone_on_a_plane(scene: &Scene) -> Option<(&SceneGrain, &ScenePlane)> {
    let (SceneGrains::List(list), SceneContainer::Planes(planes)) =
        (&scene.grains, &scene.container)
    else {
        return None;
    };
    match (list.as_slice(), planes.as_slice()) {
        ([grain], [plane]) => Some((grain, plane)),
        _ => None,
    }
}

/// Whether a lone grain meets its plane head-on and without spin: nothing slides there.
fn bounces_straight(scene: &Scene) -> bool {
    alone_on_a_plane(scene).is_some_and(|(grain, plane)| {
        let across = [grain.velocity, scene.gravity].map(|way| way.cross(plane.normal).length());
        let slides = across.into_iter().chain([grain.spin.length()]);
        slides.fold(0.0, f64::max) < 1e-12
    })
}

/// Whether a lone grain lies on its plane from the start: nothing bounces there.
fn rests(scene: &Scene) -> bool {
    alone_on_a_plane(scene).is_some_and(|(grain, plane)| {
        let gap = (grain.position - plane.point).dot(plane.normal) - grain.radius;
        gap.abs() < 1e-3 * grain.radius
    })
}

/// Grains of one kind among each other; a few listed grains also on what they fall or roll on.
fn is_of_note(scene: &Scene, [a, b]: Names) -> bool {
    is_listed(scene) || (a == b && scene.has_grains_of(a))
}

/// Whether a grain of one material can touch a wall or another grain of the other one.
fn can_meet(scene: &Scene, a: &str, b: &str) -> bool {
    let on_wall = |grain, wall| scene.has_grains_of(grain) && scene.has_walls_of(wall);
    if on_wall(a, b) || on_wall(b, a) {
        return true;
    }
    // Species of a filling give grains to each other, so that any two of its grains may be of
    // these.
    let grains = match &scene.grains {
        SceneGrains::List(list) if a == b => {
            list.iter().filter(|grain| grain.material == a).count()
        }
        _ => scene.grain_count(),
    };
    grains > 1
}

fn pair(world: &World, [a, b]: Names) -> Option<PairProperties> {
    let materials = &world.materials;
    Some(materials.pair(materials.find(a)?, materials.find(b)?))
}

fn change(world: &mut World, [a, b]: Names, change: impl FnOnce(&mut PairProperties)) {
    let materials = &mut world.materials;
    if let (Some(a), Some(b)) = (materials.find(a), materials.find(b)) {
        change(materials.pair_mut(a, b));
    }
}
