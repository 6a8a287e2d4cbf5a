//! Materials and pairs of them: their values, their names.

use super::values::{Checked, MOST_KINDS, check_name, check_number, twice, within};
use crate::physics::limits;
use crate::scene::Scene;
use crate::scene::error::Problem;
use crate::scene::materials::{PairOverride, SceneMaterial};

impl Scene {
    pub(super) fn check_material(&self, name: &str, path: impl FnOnce() -> String) -> Checked {
        if self.materials.iter().any(|m| m.name == name) {
            return Ok(());
        }
        let known = self.materials.iter().map(|m| m.name.as_str());
        Err(Problem::unknown_name(path(), "a material", name, known))
    }
}

pub(super) fn check_materials(materials: &[SceneMaterial]) -> Checked {
    check_number("materials", "materials", materials.len())?;
    for (index, material) in materials.iter().enumerate() {
        let name = &material.name;
        let path = |key: &str| format!("materials.{name}.{key}");
        check_name(name, || format!("materials.{name}"))?;
        if materials[..index].iter().any(|other| other.name == *name) {
            return Err(twice(format!("materials.{name}"), "a material", name));
        }
        within(&limits::YOUNGS_MODULUS, material.youngs_modulus, || {
            path("youngs_modulus")
        })?;
        within(&limits::POISSON_RATIO, material.poisson_ratio, || {
            path("poisson_ratio")
        })?;
        within(&limits::DENSITY, material.density, || path("density"))?;
        within(&limits::RESTITUTION, material.restitution, || {
            path("restitution")
        })?;
        within(&limits::FRICTION, material.friction, || path("friction"))?;
        if let Some(friction) = material.wet_friction {
            within(&limits::FRICTION, friction, || path("wet_friction"))?;
        }
        within(&limits::FRICTION, material.rolling_friction, || {
            path("rolling_friction")
        })?;
    }
    Ok(())
}

pub(super) fn check_pairs(pairs: &[PairOverride], scene: &Scene) -> Checked {
    if pairs.len() > MOST_KINDS {
        return check_number("pairs", "pairs", pairs.len());
    }
    for (index, pair) in pairs.iter().enumerate() {
        let path = |key: &str| format!("pairs[{index}].{key}");
        let (a, b) = &pair.between;
        scene.check_material(a, || path("between"))?;
        scene.check_material(b, || path("between"))?;
        if a == b {
            return Err(Problem::new(
                path("between"),
                format!("names `{a}` twice"),
                "two different materials",
            )
            .advise(format!(
                "How two bodies of `{a}` meet stands in `materials.{a}`"
            )));
        }
        if pairs[..index].iter().any(|other| other.is_between(a, b)) {
            return Err(Problem::new(
                path("between"),
                format!("gives `{a}` and `{b}` a second time"),
                "each pair once",
            ));
        }
        check_pair_values(pair, path)?;
    }
    Ok(())
}

fn check_pair_values(pair: &PairOverride, path: impl Fn(&str) -> String) -> Checked {
    if let Some(restitution) = pair.restitution {
        within(&limits::RESTITUTION, restitution, || path("restitution"))?;
    }
    if let Some(friction) = pair.friction {
        within(&limits::FRICTION, friction, || path("friction"))?;
    }
    if let Some(friction) = pair.wet_friction {
        within(&limits::FRICTION, friction, || path("wet_friction"))?;
    }
    if let Some(rolling_friction) = pair.rolling_friction {
        within(&limits::FRICTION, rolling_friction, || {
            path("rolling_friction")
        })?;
    }
    Ok(())
}
