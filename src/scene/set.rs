//! Values of a scene that a command line can replace before anything is built.
//!
//! In: a key and the text of its value (`--set duration=10s`). Out: the scene with that value, checked again. What can
//! change while a run goes on is a [`crate::simulation::Parameter`] instead.

use super::error::{Problem, SceneError, suggestion};
use super::file::count_of;
use super::{PairOverride, Scene, SceneCells, SceneContainer, SceneGrains, TimeStep};
use crate::physics::{BridgeLaw, ContactLaw, FeatureRule, Liquid, LiquidCase};

/// One value that can be replaced.
struct Setting {
    key: &'static str,
    /// What it takes.
    expected: &'static str,
    /// Puts the value in place; `None` where the text is not such a value.
    apply: fn(&mut Scene, &str) -> Option<()>,
}

const SETTINGS: &[Setting] = &[
    Setting {
        key: "seed",
        expected: "a whole number of at least 0",
        apply: |scene, text| {
            scene.seed = text.parse().ok()?;
            Some(())
        },
    },
    Setting {
        key: "duration",
        expected: "a time such as `10s`, `250ms` or `2min`",
        apply: |scene, text| {
            scene.duration = seconds(text)?;
            Some(())
        },
    },
    Setting {
        key: "output-interval",
        expected: "a time such as `0.1s` or `20ms`",
        apply: |scene, text| {
            scene.output_interval = seconds(text)?;
            Some(())
        },
    },
    Setting {
        key: "time-step",
        expected: "`automatic`, or a time such as `1e-5s` or `10us`",
        apply: |scene, text| {
            scene.time_step = match text {
                "automatic" => TimeStep::Following,
                time => TimeStep::Given(seconds(time)?),
            };
            Some(())
        },
    },
    Setting {
        key: "count",
        expected: "a whole number of grains, in a scene that fills its container",
        apply: |scene, text| match &mut scene.grains {
            SceneGrains::Fill {
                count,
                solid_volume,
                ..
            } => {
                *count = text.parse().ok()?;
                *solid_volume = None;
                Some(())
            }
            SceneGrains::Voronoi(_) | SceneGrains::List(_) => None,
        },
    },
    Setting {
        key: "radius",
        expected: "a length such as `2mm`: of the column, or in a scene that fills its container with grains of one radius, of those",
        apply: |scene, text| set_radius(scene, metres(text)?),
    },
    Setting {
        key: "height",
        expected: "a length such as `5cm`, in a scene of a column",
        apply: |scene, text| {
            let SceneContainer::Column { height, .. } = &mut scene.container else {
                return None;
            };
            *height = metres(text)?;
            Some(())
        },
    },
    Setting {
        key: "cell",
        expected: "a length such as `2mm`, in a scene that cuts Voronoi cells",
        apply: |scene, text| {
            cut_cells(scene)?.cell = metres(text)?;
            Some(())
        },
    },
    Setting {
        key: "rounding",
        expected: "a length such as `0.1mm`, in a scene that cuts Voronoi cells",
        apply: |scene, text| {
            cut_cells(scene)?.rounding = metres(text)?;
            Some(())
        },
    },
    Setting {
        key: "solid-fraction",
        expected: "a fraction such as `0.8`, in a scene that cuts Voronoi cells",
        apply: |scene, text| {
            cut_cells(scene)?.solid_fraction = number(text)?;
            Some(())
        },
    },
    Setting {
        key: "mix",
        expected: "the share of the second species such as `0.3`, in a scene of Voronoi cells of two species",
        apply: |scene, text| {
            let [first, second] = cells(scene)?.species.as_mut_slice() else {
                return None;
            };
            second.share = number(text)?;
            first.share = 1.0 - second.share;
            Some(())
        },
    },
    Setting {
        key: "mu11",
        expected: "the friction of two grains of the first species, such as `0.1`",
        apply: |scene, text| set_friction(scene, 0, number(text)?),
    },
    Setting {
        key: "mu22",
        expected: "the friction of two grains of the second species, such as `0.4`",
        apply: |scene, text| set_friction(scene, 1, number(text)?),
    },
    Setting {
        key: "mu-wall",
        expected: "the friction between all species and the container, such as `0.4`, where it is of another material",
        apply: |scene, text| set_wall_friction(scene, number(text)?),
    },
    Setting {
        key: "normal-stiffness",
        expected: "a stiffness in N/m such as `4000`, in a scene with the law `Hooke`; the tangential one stays in proportion",
        apply: |scene, text| set_stiffness(scene, number(text)?),
    },
    Setting {
        key: "features",
        expected: "`full` or `shared`, in a scene of polyhedra",
        apply: |scene, text| {
            let polyhedral = scene.is_polyhedral();
            let ContactLaw::Hooke { features, .. } = &mut scene.law else {
                return None;
            };
            *features = match text {
                "full" => FeatureRule::Full,
                "shared" => FeatureRule::Shared,
                _ => return None,
            };
            polyhedral.then_some(())
        },
    },
    Setting {
        key: "liquid",
        expected: "`dry` or 0, or a liquid of the paper's Table 1, 1 (water) to 7 (glycerol)",
        apply: set_liquid,
    },
    Setting {
        key: "bridge-law",
        expected: "`as-printed` or `as-coded`, in a scene with a liquid",
        apply: |scene, text| {
            scene.liquid.as_mut()?.law = match text {
                "as-printed" => BridgeLaw::AS_PRINTED,
                "as-coded" => BridgeLaw::AS_CODED,
                _ => return None,
            };
            Some(())
        },
    },
];

impl Scene {
    /// Keys that [`Scene::set`] takes, each with what it expects.
    pub fn settings() -> impl Iterator<Item = (&'static str, &'static str)> {
        SETTINGS
            .iter()
            .map(|setting| (setting.key, setting.expected))
    }

    /// Replaces one value before anything is built: one of [`Scene::settings`].
    ///
    /// # Errors
    /// When there is no such key, the text is no such value, or the scene does not hold together with it; the scene is
    /// then as it was.
    pub fn set(&mut self, key: &str, text: &str) -> Result<(), SceneError> {
        let origin = format!("{key}={text}");
        let refuse = |problem| SceneError::outside_of_files(&origin, problem);
        let setting = SETTINGS
            .iter()
            .find(|setting| setting.key == key)
            .ok_or_else(|| refuse(unknown(key)))?;
        let mut changed = self.clone();
        (setting.apply)(&mut changed, text.trim())
            .ok_or_else(|| refuse(Problem::value(key, format!("`{text}`"), setting.expected)))?;
        changed.problem().map_err(refuse)?;
        *self = changed;
        Ok(())
    }
}

fn cells(scene: &mut Scene) -> Option<&mut SceneCells> {
    match &mut scene.grains {
        SceneGrains::Voronoi(cells) => Some(cells),
        SceneGrains::Fill { .. } | SceneGrains::List(_) => None,
    }
}

/// The cells of a scene that are cut anew, not read from a file.
fn cut_cells(scene: &mut Scene) -> Option<&mut SceneCells> {
    cells(scene).filter(|cells| cells.packing.is_none())
}

fn number(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// Gives two grains of the species at `index` this friction.
fn set_friction(scene: &mut Scene, index: usize, friction: f64) -> Option<()> {
    let name = scene.species().get(index)?.1.to_owned();
    let (index, _) = scene.material(&name)?;
    scene.materials[index].friction = friction;
    Some(())
}

/// Gives grains of every species this friction on the container.
fn set_wall_friction(scene: &mut Scene, friction: f64) -> Option<()> {
    let wall = match &scene.container {
        SceneContainer::Column { material, .. }
        | SceneContainer::Drum { material, .. }
        | SceneContainer::Box { material, .. } => material.clone(),
        SceneContainer::Nothing | SceneContainer::Planes(_) => return None,
    };
    let mut grains: Vec<String> = scene.species().iter().map(|s| s.1.to_owned()).collect();
    grains.sort();
    grains.dedup();
    if grains.is_empty() || grains.contains(&wall) {
        return None;
    }
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

/// Gives contacts the normal stiffness `wanted` [N/m] and a tangential one in the proportion it had.
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

/// Gives a column the radius `wanted` [m], or all grains of a filling: the bed keeps its volume, so their number changes.
fn set_radius(scene: &mut Scene, wanted: f64) -> Option<()> {
    if let SceneContainer::Column { radius, .. } = &mut scene.container {
        *radius = wanted;
        return (wanted > 0.0).then_some(());
    }
    let SceneGrains::Fill {
        count,
        solid_volume,
        species,
    } = &mut scene.grains
    else {
        return None;
    };
    let old = species.first()?.radius;
    if species.iter().any(|kind| kind.radius != old) || wanted <= 0.0 {
        return None;
    }
    let volume = solid_volume
        .unwrap_or_else(|| *count as f64 * 4.0 / 3.0 * std::f64::consts::PI * old.powi(3));
    for kind in species.iter_mut() {
        kind.radius = wanted;
    }
    *count = count_of(volume, species);
    *solid_volume = Some(volume);
    Some(())
}

/// Puts in another liquid; how much there is and its bridge law stay where the scene had one before.
fn set_liquid(scene: &mut Scene, text: &str) -> Option<()> {
    let case = match text {
        "dry" => 0,
        number => number.parse().ok()?,
    };
    scene.liquid = if case == 0 {
        None
    } else {
        let liquid = LiquidCase::of(case)?.liquid();
        Some(match scene.liquid.take() {
            Some(old) => Liquid {
                volume: old.volume,
                law: old.law,
                ..liquid
            },
            None => liquid,
        })
    };
    Some(())
}

/// The length that `text` states, a number of metres or one with the unit `um`, `mm`, `cm` or `m` [m].
pub fn metres(text: &str) -> Option<f64> {
    let text = text.trim();
    let (number, unit) = text
        .find(|c: char| c.is_alphabetic() && c != 'e' && c != 'E')
        .map_or((text, "m"), |at| text.split_at(at));
    let number: f64 = number.trim().parse().ok()?;
    let length = match unit {
        "um" | "µm" => number / 1e6,
        "mm" => number / 1e3,
        "cm" => number / 1e2,
        "m" => number,
        _ => return None,
    };
    length.is_finite().then_some(length)
}

fn unknown(key: &str) -> Problem {
    let known: Vec<&str> = SETTINGS.iter().map(|setting| setting.key).collect();
    let mut problem = Problem::new(
        key,
        "cannot be set before a run",
        super::error::one_of(&known),
    );
    problem.advice = suggestion(key, &known);
    problem
}

/// The time that `text` states, a number of seconds or one with the unit `us`, `ms`, `s`, `min` or `h` [s].
pub fn seconds(text: &str) -> Option<f64> {
    let text = text.trim();
    let (number, unit) = text
        .find(|c: char| c.is_alphabetic() && c != 'e' && c != 'E')
        .map_or((text, "s"), |at| text.split_at(at));
    let number: f64 = number.trim().parse().ok()?;
    let time = match unit {
        "us" | "µs" => number / 1e6,
        "ms" => number / 1e3,
        "s" => number,
        "min" => number * 60.0,
        "h" => number * 3600.0,
        _ => return None,
    };
    time.is_finite().then_some(time)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_carry_their_unit() {
        let times = [
            ("10s", 10.0),
            ("250 ms", 0.25),
            ("2min", 120.0),
            ("1e-5", 1e-5),
            ("10us", 1e-5),
            ("1e1s", 10.0),
        ];
        for (text, time) in times {
            assert_eq!(seconds(text), Some(time), "{text}");
        }
        for text in ["", "s", "ten", "10 parsecs", "NaN", "inf", "1e999"] {
            assert_eq!(seconds(text), None, "{text}");
        }
    }
}
