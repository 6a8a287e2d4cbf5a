//! Numbers read from a world, and from the series of samples that a run leaves.
//!
//! In: a [`World`](crate::world::World), or a [`Series`] of samples taken from one. Out: numbers,
//! each under a key of the registry that names its unit and what it is. Every measure is a pure
//! function that sums in a fixed order, so the same world gives the same bits; NaN or `None` stands
//! where a measure has no meaning (no surface, no grains). Nothing here changes a world or knows
//! what made it.
//!
//! | file | what it measures |
//! |---|---|
//! | **of one instant** | |
//! | `sample` | all [`Measure`]s of a world at once: [`Sample`] |
//! | `surface` | the free surface as a straight line: angle θ, roughness h, curvature κ |
//! | `temperature` | granular temperature, in the laboratory's and in the drum's frame |
//! | `temperature_map` | the latter on a grid over the cross-section |
//! | `packing_fraction` | grain volume per volume of the bed |
//! | `contact_network` | coordination number, shares of the pairs of species, largest overlap |
//! | `energy_ledger` | elastic energy, and what came in and was lost since the start |
//! | `wet_bed` | liquid bridges, capillary and Galilei number, the law of the drops |
//! | `mixing` | how well the kinds of grains are mixed |
//! | `drum_torque` | the torque with which a drum turns its grains |
//! | `velocity_kernel`, `velocity_map` | mean velocities near a point, and on a grid |
//! | `deposit` | the heap of a column: front, height, profile, shape |
//! | `floor` | what the floor under a column bears |
//! | `grain_quantity` | numbers of each grain, to colour a picture by |
//! | `histogram` | how often values occur: [`Histogram`] |
//! | **of a run** | |
//! | `series` | samples in columns: [`Series`] |
//! | `avalanches` | the extrema of θ(t) |
//! | `flow`, `flowing_layer` | the flowing layer: profile over depth, speed and depth, map at the fastest moment |
//! | `column` | a column at its start: `α_eff`, `μ_p`; the laws of Man et al. 2023 |
//! | `collapse` | when a column was fastest, when it came to rest, what it left |
//! | `estimate` | a mean with its standard error: [`Estimate`]; the means of events and of runs |
//! | `slow_waves` | the standard error of a time average, from its slowest changes |
//! | `difference` | whether two means differ by more than their scatter: [`Difference`] |
//! | `verdict` | what becomes of a statement, and by which rules: [`Verdict`] |
//! | `rigid_rotation` | where rotation alone looks like flow |
//! | `regime` | avalanching, transitional or continuous |
//! | `dry_drum` | dry drums to compare wet ones with |
//! | `run_summary`, `column_summary` | the results of a run: [`results`] |
//! | **the registry** | |
//! | `quantity` | a row: key, label, symbol, unit, digits, description; how values are written |
//! | `sampled_quantity` | the rows of the samples: [`Measure`] |
//! | `run_quantity` | the rows of whole runs: [`RunQuantity`] |
//! | `result_key`, `summary` | results by their keys: [`ResultKey`], [`Summary`] |
//! | `compact_summary` | the same in little room, for files of many runs: [`CompactSummary`] |
//! | `numeral` | numbers as text |
//!
//! `near_pairs` finds the pairs of grains that are near each other, `window` averages over samples.

mod avalanches;
mod collapse;
mod column;
mod column_summary;
mod compact_summary;
mod contact_network;
mod deposit;
mod difference;
mod drum_torque;
mod dry_drum;
mod energy_ledger;
mod estimate;
mod floor;
mod flow;
mod flowing_layer;
mod grain_quantity;
mod histogram;
mod mixing;
mod near_pairs;
pub mod numeral;
mod packing_fraction;
mod quantity;
mod regime;
mod result_key;
mod rigid_rotation;
mod run_quantity;
mod run_summary;
mod sample;
mod sample_column;
mod sampled_quantity;
mod series;
mod slow_waves;
mod summary;
mod surface;
mod temperature;
mod temperature_map;
mod velocity_kernel;
mod velocity_map;
mod verdict;
mod wet_bed;
mod window;

pub use avalanches::{Avalanche, SMALLEST_DROP, SMOOTHING_TIME, avalanches};
pub use collapse::Collapse;
pub use column::{
    CRITICAL_ASPECT_RATIO, InitialColumn, PEAK_TIME_LAW, REST_TIME_LAW, TALL_ASPECT_RATIO,
    TALL_REST_TIME_LAW, cone_volume, cone_volume_law, contact_shares_law, run_out_law,
};
pub use compact_summary::CompactSummary;
pub use contact_network::{
    contact_shares, coordination_number, coordinations, largest_overlap, walls_touched,
};
pub use deposit::{Deposit, DepositOutline, DepositShape, HeightProfile};
pub use difference::{Difference, difference_in_words};
pub use drum_torque::drum_torque;
pub use dry_drum::{DryDrum, beyond_kasper, dry_drum};
pub use energy_ledger::{EnergyLedger, elastic_energy};
pub use estimate::Estimate;
pub use floor::{floor_force, floor_pressure, weight};
pub use flow::{FlowDepth, FlowHistory, FlowProfile, MeanFlow, NON_RIGID_TEMPERATURE};
pub use flowing_layer::FlowingLayer;
pub use grain_quantity::GrainQuantity;
pub use histogram::Histogram;
pub use mixing::mixing_index;
pub use packing_fraction::packing_fraction;
pub use quantity::{Format, MeasuredValue, Quantity, Scope};
pub use regime::Regime;
pub use result_key::{DropThreshold, ResultKey};
pub use rigid_rotation::rotation_note;
pub use run_quantity::RunQuantity;
pub use run_summary::{LEFT_OUT, results, summarise};
pub use sample::{Sample, mean_speed, sample, sample_and_surface};
pub use sampled_quantity::Measure;
pub use series::Series;
pub use slow_waves::time_average;
pub use summary::{Summary, SummaryEntry};
pub use surface::{MIDDLE_SHARE, SurfaceLine, surface_line};
pub use temperature::{Temperatures, granular_temperatures, rotation_temperature};
pub use temperature_map::{TemperatureMap, temperature_map};
pub use velocity_kernel::{kernel_reach, mean_velocity};
pub use velocity_map::{VelocityMap, velocity_map};
pub use verdict::Verdict;
pub use wet_bed::{bridges, capillary_number, drop_ratio_law, galilei_number};
pub(crate) use window::Window;
