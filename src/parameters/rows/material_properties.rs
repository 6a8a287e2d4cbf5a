//! What bodies are made of, and springs between them, from the start on.

use crate::parameters::Value;
use crate::parameters::parameter_row::{InScene, Kind, PanelSection, ParameterRow};
use crate::parameters::value::Choice;
use crate::physics::{ContactLaw, FeatureRule, limits, units};
use crate::scene::{PairOverride, Scene, SceneContainer, SceneMaterial};

/// How far from the scene's value sliders of materials go, as a factor.
const REACH: f64 = 10.0;

pub static DENSITY: ParameterRow = ParameterRow {
    key: "density",
    name: |_| "density",
    symbol: "ρ",
    kind: Kind::Number(&units::DENSITY),
    expected: "a density in kg/m³ such as `2500`, of a material of grains",
    limits: Some(&limits::DENSITY),
    slider: |density, _, _| density / REACH..=density * REACH,
    description: "Mass per volume of a grain.",
    in_scene: Some(InScene {
        read: |scene, [name, _]| {
            let own = material(scene, name).filter(|_| scene.has_grains_of(name));
            Some(own?.density.into())
        },
        write: |scene, [name, _], value| {
            material_mut(scene, name)?.density = value.number();
            Some(())
        },
    }),
    ..super::AT_START
};

pub static YOUNGS_MODULUS: ParameterRow = ParameterRow {
    key: "youngs-modulus",
    name: |_| "Young's modulus",
    symbol: "E",
    kind: Kind::Number(&units::MODULUS),
    expected: "a modulus such as `63e6` or `63MPa`, of a material in a scene with the law `HertzMindlin`",
    limits: Some(&limits::YOUNGS_MODULUS),
    slider: |modulus, _, _| modulus / REACH..=modulus * REACH,
    description: "How stiff the material is. A softer one allows a longer time step and lets grains overlap more.",
    acts: is_touched,
    in_scene: Some(InScene {
        read: |scene, [name, _]| Some(hertzian(scene, name)?.youngs_modulus.into()),
        write: |scene, [name, _], value| {
            material_mut(scene, name)?.youngs_modulus = value.number();
            Some(())
        },
    }),
    ..super::AT_START
};

pub static POISSON_RATIO: ParameterRow = ParameterRow {
    key: "poisson-ratio",
    name: |_| "Poisson's ratio",
    symbol: "ν",
    expected: "a ratio such as `0.21`, of a material in a scene with the law `HertzMindlin`",
    limits: Some(&limits::POISSON_RATIO),
    slider: |_, _, _| 0.0..=0.49,
    description: "How much the material bulges sideways when it is pressed.",
    acts: is_touched,
    in_scene: Some(InScene {
        read: |scene, [name, _]| Some(hertzian(scene, name)?.poisson_ratio.into()),
        write: |scene, [name, _], value| {
            material_mut(scene, name)?.poisson_ratio = value.number();
            Some(())
        },
    }),
    ..super::AT_START
};

pub static FIRST_FRICTION: ParameterRow = ParameterRow {
    key: "mu11",
    name: |_| "friction of the first species",
    symbol: "μ_11",
    expected: "the friction of two grains of the first species, such as `0.1`",
    limits: Some(&limits::FRICTION),
    slider: |_, _, _| 0.0..=1.0,
    description: "Friction of two grains of the first species, from the start on.",
    section: PanelSection::Nowhere,
    in_scene: Some(InScene {
        read: |scene, _| own_friction(scene, 0),
        write: |scene, _, value| set_friction(scene, 0, value.number()),
    }),
    ..super::AT_START
};

pub static SECOND_FRICTION: ParameterRow = ParameterRow {
    key: "mu22",
    name: |_| "friction of the second species",
    symbol: "μ_22",
    expected: "the friction of two grains of the second species, such as `0.4`",
    limits: Some(&limits::FRICTION),
    slider: |_, _, _| 0.0..=1.0,
    description: "Friction of two grains of the second species, from the start on.",
    section: PanelSection::Nowhere,
    in_scene: Some(InScene {
        read: |scene, _| own_friction(scene, 1),
        write: |scene, _, value| set_friction(scene, 1, value.number()),
    }),
    ..super::AT_START
};

pub static WALL_FRICTION: ParameterRow = ParameterRow {
    key: "mu-wall",
    name: |_| "friction on the container",
    symbol: "μ",
    expected: "the friction between all species and the container, such as `0.4`, where it is of another material",
    limits: Some(&limits::FRICTION),
    slider: |_, _, _| 0.0..=1.0,
    description: "Friction of grains of every species on the container, from the start on.",
    section: PanelSection::Nowhere,
    in_scene: Some(InScene {
        read: wall_friction,
        write: |scene, _, value| set_wall_friction(scene, value.number()),
    }),
    ..super::AT_START
};

pub static NORMAL_STIFFNESS: ParameterRow = ParameterRow {
    key: "normal-stiffness",
    name: |_| "normal stiffness",
    symbol: "K_n",
    kind: Kind::Number(&units::STIFFNESS),
    expected: "a stiffness in N/m such as `4000`, in a scene with the law `Hooke`; the tangential one stays in proportion",
    limits: Some(&limits::STIFFNESS),
    slider: |stiffness, _, _| stiffness / REACH..=stiffness * REACH,
    description: "Force per overlap of a contact; the tangential one stays in proportion.",
    in_scene: Some(InScene {
        read: |scene, _| Some(scene.law.feature_springs()?.normal_stiffness.into()),
        write: |scene, _, value| set_stiffness(scene, value.number()),
    }),
    ..super::AT_START
};

static FEATURE_RULES: [Choice; 2] = [
    Choice {
        key: "full",
        name: "each a contact of its own",
        number: 0.0,
    },
    Choice {
        key: "shared",
        name: "all together one contact",
        number: 1.0,
    },
];

pub static FEATURES: ParameterRow = ParameterRow {
    key: "features",
    name: |_| "contacts of two polyhedra",
    kind: Kind::Choice(&FEATURE_RULES),
    expected: "`full` or `shared`, in a scene of polyhedra",
    description: "How two polyhedra that touch in several places meet: each pair of features by itself, or all together.",
    section: PanelSection::Nowhere,
    in_scene: Some(InScene {
        read: |scene, _| match scene.law {
            ContactLaw::Hooke { features, .. } if scene.is_polyhedral() => {
                FEATURE_RULES.get(features as usize).map(Value::Choice)
            }
            _ => None,
        },
        write: |scene, _, value| {
            let polyhedral = scene.is_polyhedral();
            let ContactLaw::Hooke { features, .. } = &mut scene.law else {
                return None;
            };
            *features = match value {
                Value::Choice(choice) if choice.key == "full" => FeatureRule::Full,
                Value::Choice(choice) if choice.key == "shared" => FeatureRule::Shared,
                _ => return None,
            };
            polyhedral.then_some(())
        },
    }),
    ..super::AT_START
};

fn material<'a>(scene: &'a Scene, name: &str) -> Option<&'a SceneMaterial> {
    scene.material(name).map(|(_, material)| material)
}

fn material_mut<'a>(scene: &'a mut Scene, name: &str) -> Option<&'a mut SceneMaterial> {
    scene.materials.iter_mut().find(|own| own.name == name)
}

/// A material whose elasticity acts.
fn hertzian<'a>(scene: &'a Scene, name: &str) -> Option<&'a SceneMaterial> {
    material(scene, name).filter(|_| scene.law.told(|law| law.uses_elastic_constants()))
}

/// Whether any body is made of it.
fn is_touched(scene: &Scene, [name, _]: crate::parameters::Names) -> bool {
    scene.has_grains_of(name) || scene.has_walls_of(name)
}

/// Friction of two grains of the species at `index`.
fn own_friction(scene: &Scene, index: usize) -> Option<Value> {
    let name = scene.species().get(index)?.1.to_owned();
    Some(material(scene, &name)?.friction.into())
}

/// Gives two grains of the species at `index` this friction.
fn set_friction(scene: &mut Scene, index: usize, friction: f64) -> Option<()> {
    let name = scene.species().get(index)?.1.to_owned();
    material_mut(scene, &name)?.friction = friction;
    Some(())
}

/// The material of the container, and those of the grains, where they are others.
fn wall_and_grains(scene: &Scene) -> Option<(String, Vec<String>)> {
    let wall = match &scene.container {
        SceneContainer::Column { material, .. }
        | SceneContainer::Drum { material, .. }
        | SceneContainer::Mesh { material, .. }
        | SceneContainer::Box { material, .. } => material.clone(),
        SceneContainer::Nothing | SceneContainer::Planes(_) => return None,
    };
    let mut grains: Vec<String> = scene.species().iter().map(|s| s.1.to_owned()).collect();
    grains.sort();
    grains.dedup();
    let fits = !grains.is_empty() && !grains.contains(&wall);
    fits.then_some((wall, grains))
}

/// The friction of all grains on the container, where the scene gives one.
fn wall_friction(scene: &Scene, _: crate::parameters::Names) -> Option<Value> {
    let (wall, grains) = wall_and_grains(scene)?;
    let given = |grain: &String| {
        let mut pairs = scene.pairs.iter();
        pairs.find(|pair| pair.is_between(grain, &wall))?.friction
    };
    let first = given(grains.first()?)?;
    let is_one = grains.iter().all(|grain| given(grain) == Some(first));
    is_one.then_some(Value::Number(first))
}

/// Gives grains of every species this friction on the container.
fn set_wall_friction(scene: &mut Scene, friction: f64) -> Option<()> {
    let (wall, grains) = wall_and_grains(scene)?;
    for grain in grains {
        pair(scene, grain, &wall).friction = Some(friction);
    }
    Some(())
}

/// What the scene says of the pair of materials `a` and `b`, which is added where it says nothing.
fn pair<'a>(scene: &'a mut Scene, a: String, b: &str) -> &'a mut PairOverride {
    let known = scene.pairs.iter().position(|pair| pair.is_between(&a, b));
    let index = known.unwrap_or_else(|| {
        scene.pairs.push(PairOverride {
            between: (a, b.to_owned()),
            restitution: None,
            friction: None,
            wet_friction: None,
            rolling_friction: None,
        });
        scene.pairs.len() - 1
    });
    &mut scene.pairs[index]
}

/// Gives contacts the normal stiffness `wanted` [N/m] and a tangential one in the proportion it
/// had.
fn set_stiffness(scene: &mut Scene, wanted: f64) -> Option<()> {
    let ContactLaw::Hooke {
        normal_stiffness,
        tangential_stiffness,
        ..
    } = &mut scene.law
    else {
        return None;
    };
    *tangential_stiffness *= wanted / *normal_stiffness;
    *normal_stiffness = wanted;
    Some(())
}
