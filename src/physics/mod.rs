//! The physics that everything else speaks of: force laws and their choices, materials and how two
//! of them meet, liquids, units and limits.
//!
//! In: numbers. Out: constants, stiffnesses, forces. Nothing here knows of scene files, grains or
//! time.
//!
//! | file | holds |
//! |---|---|
//! | `integrator` | which ways of integrating there are |
//! | `law` | contact laws, rolling friction, liquid bridges: one file each |
//! | `material` | what bodies are made of, how two materials meet |
//! | `liquid` | a liquid, the cases of Kasper et al. 2021, the choices of the bridge law |
//! | `limits` | which values of a quantity can be used at all |
//! | `units` | what quantities are kept in and read in, and how text states them |

mod integrator;
pub mod law;
pub mod limits;
mod liquid;
mod material;
pub mod units;

pub use integrator::Integrator;
pub use law::{ContactLaw, FeatureRule};
pub use liquid::{
    BridgeLaw, BridgeVolume, CapillaryGap, CoulombBound, LIQUID_CASES, Liquid, LiquidCase,
    PAPER_VOLUME, PairAngle, Rupture, SmallestGap,
};
pub use material::{Material, MaterialId, Materials, PairProperties};
pub use units::{DisplayUnit, Unit};
