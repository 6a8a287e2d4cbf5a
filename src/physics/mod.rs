//! The physics that everything else speaks of: force laws and their choices, materials and how two
//! of them meet, liquids.
//!
//! In: numbers. Out: constants, stiffnesses, forces. Nothing here knows of scene files, grains or
//! time.
//!
//! | file | holds |
//! |---|---|
//! | `law` | contact laws, rolling friction, liquid bridges: one file each |
//! | `material` | what bodies are made of, how two materials meet |
//! | `liquid` | a liquid, the cases of Kasper et al. 2021, the choices of the bridge law |

pub mod law;
mod liquid;
mod material;

pub use law::{ContactLaw, FeatureRule};
pub use liquid::{
    BridgeLaw, BridgeVolume, CapillaryGap, CoulombBound, LIQUID_CASES, Liquid, LiquidCase,
    PAPER_VOLUME, PairAngle, Rupture, SmallestGap,
};
pub use material::{Material, MaterialId, Materials, PairProperties};
