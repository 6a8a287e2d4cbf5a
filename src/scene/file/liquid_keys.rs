//! How a file spells the liquid: a case of Table 1 of Kasper et al. 2021, or values of its own.

use super::keys::either;
use crate::physics::{BridgeLaw, Liquid, LiquidCase, PAPER_VOLUME};
use crate::scene::error::Problem;
use serde::Deserialize;

/// A liquid: a case of the paper's Table 1, whose values others may replace, or all of them.
#[derive(Deserialize)]
#[serde(rename = "Liquid", deny_unknown_fields)]
pub(super) struct LiquidFile {
    case: Option<u8>,
    surface_tension: Option<f64>,
    contact_angle: Option<f64>,
    contact_angle_deg: Option<f64>,
    viscosity: Option<f64>,
    viscosity_mpas: Option<f64>,
    volume: Option<f64>,
    volume_ml: Option<f64>,
    #[serde(default)]
    law: BridgeLawFile,
}

#[derive(Default, Deserialize)]
#[serde(rename = "BridgeLaw")]
enum BridgeLawFile {
    #[default]
    AsPrinted,
    AsCoded,
    Choices(BridgeLaw),
}

impl LiquidFile {
    pub(super) fn into_liquid(self) -> Result<Liquid, Problem> {
        let base = self.case.map(liquid_case).transpose()?;
        let missing = |key: &str| {
            Problem::new(
                "liquid",
                format!("has neither `case` nor `{key}`"),
                "a `case` of the paper's Table 1, 1 to 7, or `viscosity`, `surface_tension` and `contact_angle`",
            )
        };
        let of_case = |value: fn(&Liquid) -> f64| base.as_ref().map(value);
        let angle = self.contact_angle_deg.map(f64::to_radians);
        let angle = either("liquid.contact_angle", self.contact_angle, "_deg", angle)?;
        let viscosity = self.viscosity_mpas.map(|mpas| mpas / 1000.0);
        let viscosity = either("liquid.viscosity", self.viscosity, "_mpas", viscosity)?;
        let volume = self.volume_ml.map(|ml| ml * 1e-6);
        let volume = either("liquid.volume", self.volume, "_ml", volume)?;
        Ok(Liquid {
            surface_tension: self
                .surface_tension
                .or(of_case(|l| l.surface_tension))
                .ok_or_else(|| missing("surface_tension"))?,
            contact_angle: angle
                .or(of_case(|l| l.contact_angle))
                .ok_or_else(|| missing("contact_angle"))?,
            viscosity: viscosity
                .or(of_case(|l| l.viscosity))
                .ok_or_else(|| missing("viscosity"))?,
            volume: volume.unwrap_or(PAPER_VOLUME),
            law: match self.law {
                BridgeLawFile::AsPrinted => BridgeLaw::AS_PRINTED,
                BridgeLawFile::AsCoded => BridgeLaw::AS_CODED,
                BridgeLawFile::Choices(law) => law,
            },
        })
    }
}

fn liquid_case(number: u8) -> Result<Liquid, Problem> {
    LiquidCase::of(number).map(LiquidCase::liquid).ok_or_else(|| {
        Problem::value(
            "liquid.case",
            number.to_string(),
            "a liquid of the paper's Table 1, 1 (water) to 7 (glycerol); a dry scene has no `liquid`",
        )
    })
}
