//! How a liquid bridge acts, choice by choice: what Kasper et al. 2021 leave open, or state twice.
//!
//! The two laws that have a name, *as printed* and *as coded*, are a value for each of these; any
//! other set of values is a law of one's own.

use super::liquid_and_bridges::OF_LIQUID;
use crate::parameters::Value;
use crate::parameters::parameter_row::{InScene, InWorld, Kind, ParameterRow};
use crate::parameters::value::Choice;
use crate::physics::{
    BridgeLaw, BridgeVolume, CapillaryGap, CoulombBound, PairAngle, Rupture, SmallestGap,
};

/// Makes the row of one field of a bridge law, from its values with their words, and what else a
/// row says.
macro_rules! choice_of_law {
    (
        $row:ident, $field:ident: $(($number:literal, $key:literal, $name:literal, $value:expr)),+;
        $($rest:tt)*
    ) => {
        pub static $row: ParameterRow = {
            static CHOICES: &[Choice] = &[$(Choice {
                key: $key,
                name: $name,
                number: $number,
            }),+];
            fn of(law: &BridgeLaw) -> Option<Value> {
                let values = [$($value),+];
                let index = values.iter().position(|value| *value == law.$field)?;
                CHOICES.get(index).map(Value::Choice)
            }
            fn choose(law: &mut BridgeLaw, value: &Value) -> Option<()> {
                let values = [$($value),+];
                let index = CHOICES.iter().position(|own| own.number == value.number())?;
                law.$field = values[index];
                Some(())
            }
            ParameterRow {
                kind: Kind::Choice(CHOICES),
                in_scene: Some(InScene {
                    read: |scene, _| of(&scene.liquid?.law),
                    write: |scene, _, value| choose(&mut scene.liquid.as_mut()?.law, &value),
                }),
                in_world: Some(InWorld {
                    read: |world, _| of(&world.liquid?.law),
                    write: |world, _, _, value| {
                        if let Some(liquid) = &mut world.liquid {
                            let _ = choose(&mut liquid.law, &value);
                        }
                    },
                }),
                $($rest)*
                ..OF_LIQUID
            }
        };
    };
}

choice_of_law! {
    BRIDGE_VOLUME, volume:
        (0.0, "film-share", "5 % of both films", BridgeVolume::FilmShare),
        (1.0, "shaded-cap", "shaded caps", BridgeVolume::ShadedCap);
    key: "bridge-volume",
    name: |_| "bridge volume",
    description: "What of both grains' films a bridge holds that forms. Shaded caps: the part of each film that the other grain \
                  shades, 6.7 % of both between equal grains, as LIGGGHTS 3.8 computes it.",
    equation: |_| "V = 0.05 (Vf_i + Vf_j), Eq. 11 of Kasper et al. 2021",
}

choice_of_law! {
    PAIR_ANGLE, angle:
        (0.0, "mean", "mean", PairAngle::Mean),
        (1.0, "half-product", "half the product", PairAngle::HalfProduct);
    key: "pair-angle",
    name: |_| "contact angle of a pair",
    short_name: "Angle of a pair",
    description: "Which contact angle two grains have together. Half the product, in rad², is what LIGGGHTS 3.8 computes: 40° act \
                  as 14°.",
    equation: |_| "α in Eqs. 11 and 14 of Kasper et al. 2021",
}

choice_of_law! {
    VISCOUS_GAP, viscous_gap:
        (0.0, "printed", "0.01 (r_i + r_j)", SmallestGap::OfRadii(0.01)),
        (1.0, "coded", "1.01 r*", SmallestGap::OfEffectiveRadius(1.01));
    key: "viscous-gap",
    name: |_| "smallest gap of the viscous forces",
    short_name: "Smallest viscous gap",
    description: "Below this gap viscous forces grow no more. 1.01 r* is what LIGGGHTS' manual recommends: between equal grains the \
                  normal force is 25 times weaker with it.",
    equation: |_| "D in Eqs. 16 and 17, bounded by Eq. 15 of Kasper et al. 2021",
}

choice_of_law! {
    CAPILLARY_GAP, capillary_gap:
        (0.0, "clamped", "at least 0.01 (r_i + r_j)", CapillaryGap::Clamped),
        (1.0, "open", "as it is", CapillaryGap::Open);
    key: "capillary-gap",
    name: |_| "gap of the capillary force",
    short_name: "Capillary gap",
    description: "Which gap the capillary force of grains that touch or nearly do is taken at.",
    equation: |_| "D in Eq. 13, bounded by Eq. 15 of Kasper et al. 2021",
}

choice_of_law! {
    RUPTURE, rupture:
        (0.0, "capped", "at d0, at 0.1 (r_i + r_j) at most", Rupture::Capped),
        (1.0, "at-d0", "at d0", Rupture::AtRuptureGap);
    key: "rupture",
    name: |_| "rupture",
    description: "At which gap a bridge breaks.",
    equation: |_| "d0 = (1 + (α_i + α_j)/4) V^(1/3), Eqs. 11 and 15 of Kasper et al. 2021",
}

choice_of_law! {
    COULOMB, coulomb:
        (0.0, "contact", "of the contact", CoulombBound::Contact),
        (1.0, "total", "of contact and bridge", CoulombBound::Total);
    key: "coulomb",
    name: |_| "normal force that bounds friction",
    short_name: "Friction is bounded by the normal force",
    description: "Which normal force the bound of friction is a share of: a bridge that pulls two grains together presses their \
                  contact, but not the two as a whole.",
    equation: |_| "|F_t| ≤ μ |F_n|, Eq. 20 of Kasper et al. 2021",
}
