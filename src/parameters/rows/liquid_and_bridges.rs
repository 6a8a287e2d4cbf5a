//! The liquid: what it is and how its bridges act.

use crate::parameters::Value;
use crate::parameters::parameter_row::{
    ANY, InScene, InWorld, Kind, PanelSection, ParameterRow, Preset, Scale, preset,
};
use crate::parameters::value::Choice;
use crate::physics::units::{self, ANGLE};
use crate::physics::{BridgeLaw, LIQUID_CASES, Liquid, LiquidCase, PAPER_VOLUME, limits};
use crate::world::World;

/// Most viscous liquid a slider offers [Pa s].
const MOST_VISCOUS: f64 = 1.5;
/// Strongest surface tension a slider offers [N/m].
const STRONGEST_TENSION: f64 = 0.15;
/// Largest contact angle a slider offers [rad], 80°.
const LARGEST_CONTACT_ANGLE: f64 = 80.0 / ANGLE.shown.factor;

pub static VISCOSITY: ParameterRow = ParameterRow {
    key: "viscosity",
    name: |_| "viscosity",
    symbol: "η",
    kind: Kind::Number(&units::VISCOSITY),
    limits: Some(&limits::VISCOSITY),
    slider: |viscosity, _, _| 0.0..=MOST_VISCOUS.max(2.0 * viscosity),
    scale: Scale::PowersOfTen,
    presets: &CASES,
    description: "How strongly bridges resist motion: water 1 mPa s, glycerol 1410 mPa s.",
    equation: |_| "F = 6π η r*² v_n/D across the gap D, Eqs. 15–17 of Kasper et al. 2021",
    is_basic: |_, _| true,
    rank: 0,
    in_world: Some(InWorld {
        read: |world, _| Some(world.liquid?.viscosity.into()),
        write: |world, _, _, value| change(world, |liquid| liquid.viscosity = value.number()),
    }),
    ..OF_LIQUID
};

pub static SURFACE_TENSION: ParameterRow = ParameterRow {
    key: "surface-tension",
    name: |_| "surface tension",
    symbol: "γ",
    kind: Kind::Number(&units::SURFACE_TENSION),
    limits: Some(&limits::SURFACE_TENSION),
    slider: |tension, _, _| 0.0..=STRONGEST_TENSION.max(2.0 * tension),
    presets: &[preset("glycerol", 63.4e-3), preset("water", 72.8e-3)],
    description: "How strongly bridges pull grains together: water 72.8 mN/m.",
    equation: |_| "F = π γ √(r_i r_j) (c + exp(a D/r + b)), Eqs. 13 and 14 of Kasper et al. 2021",
    in_world: Some(InWorld {
        read: |world, _| Some(world.liquid?.surface_tension.into()),
        write: |world, _, _, value| {
            change(world, |liquid| liquid.surface_tension = value.number());
        },
    }),
    ..OF_LIQUID
};

pub static CONTACT_ANGLE: ParameterRow = ParameterRow {
    key: "contact-angle",
    name: |_| "contact angle",
    symbol: "α",
    kind: Kind::Number(&ANGLE),
    limits: Some(&limits::CONTACT_ANGLE),
    slider: |angle, _, _| 0.0..=LARGEST_CONTACT_ANGLE.max(angle),
    description: "Angle at which the liquid meets the grains; the smaller, the better it wets them.",
    equation: |_| "α in b of Eq. 14 and in the rupture gap, Eqs. 11–14 of Kasper et al. 2021",
    in_world: Some(InWorld {
        read: |world, _| Some(world.liquid?.contact_angle.into()),
        write: |world, _, _, value| change(world, |liquid| liquid.contact_angle = value.number()),
    }),
    ..OF_LIQUID
};

pub static VOLUME: ParameterRow = ParameterRow {
    key: "liquid-volume",
    name: |_| "liquid",
    symbol: "V_l",
    kind: Kind::Number(&units::LIQUID_VOLUME),
    limits: Some(&limits::LIQUID_VOLUME),
    slider: |volume, _, _| 0.0..=5.0 * volume.max(1e-9),
    presets: &[preset("as in the paper", PAPER_VOLUME)],
    description: "Volume of all the liquid; none makes the grains dry.",
    equation: |_| "V = 0.05 (Vf_i + Vf_j) of both films, Eq. 11 of Kasper et al. 2021",
    is_basic: |_, _| true,
    in_world: Some(InWorld {
        read: |world, _| Some(world.liquid?.volume.into()),
        write: |world, _, _, value| world.set_liquid_volume(value.number()),
    }),
    ..OF_LIQUID
};

/// The two bridge laws that have a name, and any other, which is set choice by choice.
pub static BRIDGE_LAWS: [Choice; 3] = [
    Choice {
        key: "as-printed",
        name: "as printed",
        number: 0.0,
    },
    Choice {
        key: "as-coded",
        name: "as coded",
        number: 1.0,
    },
    Choice {
        key: "own",
        name: "own choices",
        number: 2.0,
    },
];

pub static BRIDGE_LAW: ParameterRow = ParameterRow {
    key: "bridge-law",
    name: |_| "bridge law",
    short_name: "Bridges",
    kind: Kind::Choice(&BRIDGE_LAWS),
    expected: "`as-printed` or `as-coded`, in a scene with a liquid",
    description: "As printed: the paper's equations. As coded: what the public LIGGGHTS 3.8 computes, with far weaker viscous \
                  forces. Own choices: any others, each set by itself.",
    equation: |_| "Eqs. 11–17 of Kasper et al. 2021",
    in_scene: Some(InScene {
        read: |scene, _| Some(law_choice(scene.liquid?.law)),
        write: |scene, _, value| {
            scene.liquid.as_mut()?.law = chosen_law(value)?;
            Some(())
        },
    }),
    in_world: Some(InWorld {
        read: |world, _| Some(law_choice(world.liquid?.law)),
        write: |world, _, _, value| {
            if let Some(law) = chosen_law(value) {
                change(world, |liquid| liquid.law = law);
            }
        },
    }),
    ..OF_LIQUID
};

/// None, and the liquids of Table 1 by their numbers.
static LIQUIDS: [Choice; 8] = {
    const fn case(key: &'static str, number: usize) -> Choice {
        Choice {
            key,
            name: LIQUID_CASES[number - 1].name,
            number: number as f64,
        }
    }
    let dry = Choice {
        key: "dry",
        name: "dry",
        number: 0.0,
    };
    [
        dry,
        case("1", 1),
        case("2", 2),
        case("3", 3),
        case("4", 4),
        case("5", 5),
        case("6", 6),
        case("7", 7),
    ]
};

pub static CASE: ParameterRow = ParameterRow {
    key: "liquid",
    name: |_| "liquid of Table 1",
    kind: Kind::Choice(&LIQUIDS),
    expected: "`dry` or 0, or a liquid of the paper's Table 1, 1 (water) to 7 (glycerol)",
    description: "Another liquid, or none; how much there is and how its bridges act stay as they were.",
    equation: |_| "Table 1 of Kasper et al. 2021",
    in_scene: Some(InScene {
        read: |scene, _| {
            let Some(liquid) = &scene.liquid else {
                return LIQUIDS.first().map(Value::Choice);
            };
            let case = LiquidCase::of_liquid(liquid)?;
            LIQUIDS.get(usize::from(case.number)).map(Value::Choice)
        },
        write: |scene, _, value| {
            let number = value.number() as u8;
            scene.liquid = if number == 0 {
                None
            } else {
                let case = LiquidCase::of(number)?;
                let old = scene.liquid;
                Some(old.map_or_else(|| case.liquid(), |old| with_amount_of(&old, case)))
            };
            Some(())
        },
    }),
    ..ANY
};

/// The viscosities of Table 1.
static CASES: [Preset<'static>; 7] = {
    const fn of(index: usize) -> Preset<'static> {
        preset(LIQUID_CASES[index].name, LIQUID_CASES[index].viscosity)
    }
    [of(0), of(1), of(2), of(3), of(4), of(5), of(6)]
};

/// What these rows have in common.
pub(super) const OF_LIQUID: ParameterRow = ParameterRow {
    section: PanelSection::Liquid,
    is_of_liquid: true,
    exists: |scene, _| scene.liquid.is_some(),
    ..ANY
};

/// The liquid of `case`, as much of it as of `old`, and with its bridge law.
fn with_amount_of(old: &Liquid, case: &LiquidCase) -> Liquid {
    Liquid {
        volume: old.volume,
        law: old.law,
        ..case.liquid()
    }
}

fn law_choice(law: BridgeLaw) -> Value {
    let named = [BridgeLaw::AS_PRINTED, BridgeLaw::AS_CODED];
    let index = named.iter().position(|own| *own == law);
    Value::Choice(&BRIDGE_LAWS[index.unwrap_or(named.len())])
}

/// The law that a choice names; none where that leaves the law as it is.
fn chosen_law(value: Value) -> Option<BridgeLaw> {
    match value {
        Value::Choice(choice) if *choice == BRIDGE_LAWS[0] => Some(BridgeLaw::AS_PRINTED),
        Value::Choice(choice) if *choice == BRIDGE_LAWS[1] => Some(BridgeLaw::AS_CODED),
        _ => None,
    }
}

fn change(world: &mut World, change: impl FnOnce(&mut Liquid)) {
    if let Some(liquid) = &mut world.liquid {
        change(liquid);
    }
}
