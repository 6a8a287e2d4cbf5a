//! The liquid between the grains: its properties, the cases of Kasper et al. 2021, the choices of
//! the bridge law.

use serde::{Deserialize, Serialize};

/// A liquid and how much of it there is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Liquid {
    /// Surface tension γ [N/m].
    pub surface_tension: f64,
    /// Contact angle α on the grains [rad].
    pub contact_angle: f64,
    /// Viscosity η [Pa s].
    pub viscosity: f64,
    /// Volume of all the liquid, shared among the grains in proportion to their volume [m³].
    pub volume: f64,
    /// How a bridge acts.
    pub law: BridgeLaw,
}

impl Liquid {
    /// Whether it has the properties of `other`, however much there is of it and however its
    /// bridges act.
    pub fn is_same_substance(&self, other: &Self) -> bool {
        let amended = Self {
            volume: other.volume,
            law: other.law,
            ..*self
        };
        amended == *other
    }
}

/// How a liquid bridge acts: the choices that Kasper et al. 2021 leave open, each with a name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BridgeLaw {
    /// Volume of a bridge that forms.
    pub volume: BridgeVolume,
    /// Contact angle of a pair.
    pub angle: PairAngle,
    /// Smallest gap in the viscous forces.
    pub viscous_gap: SmallestGap,
    /// Gap in the capillary force of grains that touch.
    pub capillary_gap: CapillaryGap,
    /// When a bridge breaks.
    pub rupture: Rupture,
    /// Which normal force bounds friction.
    pub coulomb: CoulombBound,
}

/// Volume of a bridge between grains with the films `Vf` and the radii `r`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BridgeVolume {
    /// `0.05 (Vf_i + Vf_j)`, Eq. 11.
    FilmShare,
    /// `0.5 Vf_i (1 − √(1 − r_j²/(r_i + r_j)²))` and the same for j: the cap of a grain that the
    /// other one shades.
    ShadedCap,
}

/// Contact angle of a pair whose grains have the angles `α_i` and `α_j`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PairAngle {
    /// `(α_i + α_j)/2`.
    Mean,
    /// `α_i α_j/2`, in rad²: a slip of the program, kept because results were made with it.
    HalfProduct,
}

/// Smallest gap in a force that grows without bound as the gap closes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SmallestGap {
    /// In units of `r_i + r_j`.
    OfRadii(f64),
    /// In units of the effective radius `r* = r_i r_j/(r_i + r_j)`.
    OfEffectiveRadius(f64),
}

impl SmallestGap {
    /// It in its own unit.
    pub fn share(self) -> f64 {
        let (Self::OfRadii(share) | Self::OfEffectiveRadius(share)) = self;
        share
    }
}

/// Gap in the capillary force of grains that touch or nearly do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum CapillaryGap {
    /// At least `0.01 (r_i + r_j)`, Eq. 15.
    Clamped,
    /// The gap itself; none in contact.
    Open,
}

/// When a bridge breaks; `d0` is the rupture gap of Eq. 11.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rupture {
    /// At `d0`, or at `0.1 (r_i + r_j)` where that is nearer.
    Capped,
    /// At `d0`; beyond `0.1 (r_i + r_j)` forces are those at that gap.
    AtRuptureGap,
}

/// The normal force whose `μ`-fold bounds friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum CoulombBound {
    /// The contact's own: a bridge presses grains together.
    Contact,
    /// Contact and bridge together, Eq. 20 read literally.
    Total,
}

impl BridgeLaw {
    /// The equations as Kasper et al. 2021 print them.
    pub const AS_PRINTED: Self = Self {
        volume: BridgeVolume::FilmShare,
        angle: PairAngle::Mean,
        viscous_gap: SmallestGap::OfRadii(0.01),
        capillary_gap: CapillaryGap::Clamped,
        rupture: Rupture::Capped,
        coulomb: CoulombBound::Contact,
    };

    /// What the public LIGGGHTS 3.8, the paper's program, computes with the settings its manual
    /// recommends.
    pub const AS_CODED: Self = Self {
        volume: BridgeVolume::ShadedCap,
        angle: PairAngle::HalfProduct,
        viscous_gap: SmallestGap::OfEffectiveRadius(1.01),
        capillary_gap: CapillaryGap::Open,
        rupture: Rupture::Capped,
        coulomb: CoulombBound::Contact,
    };
}

impl Default for BridgeLaw {
    fn default() -> Self {
        Self::AS_PRINTED
    }
}

/// A liquid of Kasper et al. 2021, Table 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiquidCase {
    /// Its number n in the table.
    pub number: u8,
    /// What it is: `85 % glycerol`.
    pub name: &'static str,
    /// Mass of glycerol over that of the liquid.
    pub glycerol: f64,
    /// Viscosity η [Pa s].
    pub viscosity: f64,
}

/// Volume of liquid in the paper's drum [m³].
pub const PAPER_VOLUME: f64 = 4e-6;

/// The liquids of Table 1, n = 1 … 7; n = 0 is the dry drum.
pub const LIQUID_CASES: [LiquidCase; 7] = [
    case(1, "water", 0.0, 1.01e-3),
    case(2, "85 % glycerol", 0.85, 0.109),
    case(3, "91 % glycerol", 0.91, 0.219),
    case(4, "93 % glycerol", 0.93, 0.367),
    case(5, "95 % glycerol", 0.95, 0.523),
    case(6, "98 % glycerol", 0.98, 0.939),
    case(7, "glycerol", 1.0, 1.41),
];

const fn case(number: u8, name: &'static str, glycerol: f64, viscosity: f64) -> LiquidCase {
    LiquidCase {
        number,
        name,
        glycerol,
        viscosity,
    }
}

impl LiquidCase {
    /// Case `number` of the table, 1 … 7.
    pub fn of(number: u8) -> Option<&'static Self> {
        LIQUID_CASES.iter().find(|case| case.number == number)
    }

    /// The case whose properties `liquid` has, however much there is of it.
    pub fn of_liquid(liquid: &Liquid) -> Option<&'static Self> {
        LIQUID_CASES
            .iter()
            .find(|case| case.liquid().is_same_substance(liquid))
    }

    /// Surface tension γ [N/m]. The paper does not print it: water's own, and
    /// `63.4 + 9.4 (1 − glycerol)` mN/m for the mixtures, which gives back the capillary numbers of
    /// Table 1.
    pub fn surface_tension(&self) -> f64 {
        if self.glycerol == 0.0 {
            72.8e-3
        } else {
            (63.4 + 9.4 * (1.0 - self.glycerol)) * 1e-3
        }
    }

    /// Contact angle α [rad], not printed either: 20° for water, 39.5° for the mixtures.
    pub fn contact_angle(&self) -> f64 {
        let degrees: f64 = if self.glycerol == 0.0 { 20.0 } else { 39.5 };
        degrees.to_radians()
    }

    /// As much of it as the paper has, with bridges as printed.
    pub fn liquid(&self) -> Liquid {
        Liquid {
            surface_tension: self.surface_tension(),
            contact_angle: self.contact_angle(),
            viscosity: self.viscosity,
            volume: PAPER_VOLUME,
            law: BridgeLaw::AS_PRINTED,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn capillary_numbers_are_those_of_table_1() {
        // Row 2 of the table reads 0.41 where its own numbers give 0.48.
        let printed = [0.003, 0.48, 0.97, 1.64, 2.34, 4.23, 6.39];
        let speed = (4.0 * 9.81 * 1.25e-3_f64).sqrt();
        for (case, printed) in LIQUID_CASES.iter().zip(printed) {
            let (gamma, angle) = (case.surface_tension(), case.contact_angle());
            let number = case.viscosity * speed / (gamma * angle.cos());
            let error: f64 = number / printed - 1.0;
            assert!(
                error.abs() < if case.number == 1 { 0.1 } else { 0.015 },
                "{}: {number}",
                case.name
            );
        }
    }
}
