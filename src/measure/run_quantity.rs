//! What a whole run came to: one row for each number that no single sample holds.
//!
//! In: nothing. Out: the rows of the registry for what [`super::results`] reports beside the
//! measures of the samples. How the numbers are taken stands in `run_summary` and `column_summary`.

use super::deposit::DepositShape;
use super::quantity::{Format, Scope, quantities};
use super::regime::Regime;
use crate::physics::{Unit, units};

quantities! {
    /// A number of a run as a whole, or of a window of it.
    RunQuantity {
        RupturesPerSecond {
            key: "ruptures per second",
            description: "liquid bridges that broke over the window, per second",
            unit: Unit::same("1/s"),
            format: Format::Fixed(1),
            scope: Scope::Beds,
        }
        DrumPower {
            key: "drum power",
            description: "work of the moving walls over the window, per second",
            unit: units::POWER,
            format: Format::Fixed(3),
            scope: Scope::Beds,
        }
        NonRigidShare {
            key: "non-rigid share ta/ts",
            description: "share of the samples whose granular temperature in the laboratory frame, \
                          the paper's, is at least 2e-9 m²/s²",
            short_label: "Flowing share ta/ts, the paper's",
            symbol: "ta/ts",
            format: Format::Fixed(3),
            scope: Scope::Beds,
        }
        CorotatingShare {
            key: "co-rotating non-rigid share ta/ts′",
            description: "share of the samples whose granular temperature relative to the turning \
                          drum is at least 2e-9 m²/s²; rigid rotation, which has some in the \
                          laboratory frame, has none there",
            short_label: "Flowing share ta/ts′, in the drum",
            symbol: "ta/ts′",
            format: Format::Fixed(3),
            scope: Scope::Beds,
        }
        RotationTemperature {
            key: "granular temperature of rigid rotation",
            description: "granular temperature in the laboratory frame that the last bed has by \
                          turning with the drum as one rigid body",
            short_label: "Tg of rigid rotation alone",
            unit: Unit::same("m²/s²"),
            format: Format::Scientific,
            scope: Scope::Drums,
        }
        TemperatureInAvalanches {
            key: "granular temperature in avalanches",
            description: "mean over the samples in which the surface angle falls",
            unit: Unit::same("m²/s²"),
            format: Format::Scientific,
            scope: Scope::Beds,
        }
        TemperatureBetweenAvalanches {
            key: "granular temperature between avalanches",
            description: "median of the other samples",
            unit: Unit::same("m²/s²"),
            format: Format::Scientific,
            scope: Scope::Beds,
        }
        RiseRate {
            key: "rise rate",
            description: "median slope of the surface angle over 0.2 s between avalanches; the \
                          drum speed where the bed turns rigidly",
            unit: units::ANGULAR_VELOCITY,
            format: Format::Fixed(2),
            scope: Scope::Beds,
        }
        FlowSpeed {
            key: "flow speed at the surface",
            description: "mean speed along the middle of the surface over the samples in which the \
                          granular temperature is at least 2e-9 m²/s²",
            short_label: "Flow speed at the surface",
            symbol: "u_0",
            unit: units::FLOW_SPEED,
            format: Format::Fixed(2),
            scope: Scope::Beds,
        }
        FlowDepth {
            key: "depth of the flowing layer",
            description: "depth below the middle of the surface at which the mean velocity along it \
                          over the same samples is zero: above grains go down the slope, below up \
                          with the drum",
            symbol: "d_f",
            unit: units::LENGTH,
            format: Format::Fixed(2),
            scope: Scope::Beds,
        }
        Avalanches {
            key: "avalanches",
            description: "number of complete avalanches in the window",
            format: Format::Count,
            scope: Scope::Beds,
        }
        MaximumAngle {
            key: "maximum angle θ_m",
            description: "mean over the avalanches, surface angle smoothed over 0.1 s",
            symbol: "θ_m",
            unit: units::ANGLE,
            format: Format::Fixed(2),
            scope: Scope::Beds,
        }
        ReposeAngle {
            key: "repose angle θ_r",
            description: "mean over the avalanches, surface angle smoothed over 0.1 s",
            symbol: "θ_r",
            unit: units::ANGLE,
            format: Format::Fixed(2),
            scope: Scope::Beds,
        }
        Period {
            key: "avalanche period",
            description: "mean time from the start of an avalanche to the start of the next",
            short_label: "Time between avalanches",
            symbol: "T_a",
            unit: units::TIME,
            format: Format::Fixed(2),
            scope: Scope::Beds,
        }
        Drop {
            key: "drop Δθ",
            description: "mean over the avalanches, surface angle smoothed over 0.1 s",
            short_label: "Drop ⟨Δθ⟩",
            symbol: "Δθ",
            unit: units::ANGLE,
            format: Format::Fixed(2),
            scope: Scope::Beds,
        }
        RelativeEnergyResidual {
            key: "relative energy residual",
            description: "energy residual at the end relative to the largest term of the balance",
            format: Format::Scientific,
        }
        CapillaryNumber {
            key: "capillary number Ca",
            description: "η √(4 g r)/(γ cos α)",
            symbol: "Ca",
            format: Format::Fixed(3),
            scope: Scope::Beds,
            source: "Eq. 1 of Kasper et al. 2021",
        }
        GalileiNumber {
            key: "Galilei number Ga",
            description: "ρ² g r³/η²",
            symbol: "Ga",
            scope: Scope::Beds,
            source: "Eq. 25 of Kasper et al. 2021",
        }
        InverseRootGalilei {
            key: "√(1/Ga)",
            description: "inverse root of the Galilei number; summaries leave it out, since it \
                          follows from Ga",
            symbol: "√(1/Ga)",
            format: Format::Fixed(4),
            scope: Scope::Beds,
            source: "Fig. 7 of Kasper et al. 2021",
        }
        Regime {
            key: "regime",
            description: "avalanching: ta/ts′ below 0.9; continuous: ta/ts′ at least 0.99 and \
                          drops below 2.5°; transitional between",
            format: Format::Choice(&Regime::WORDS),
            scope: Scope::Beds,
        }
        AspectRatio {
            key: "aspect ratio α",
            description: "H_i/R_i",
            symbol: "α",
            format: Format::Fixed(3),
            scope: Scope::Columns,
        }
        EffectiveAspectRatio {
            key: "effective aspect ratio α_eff",
            description: "α √(1/(μ_w + 2 μ_p))",
            symbol: "α_eff",
            format: Format::Fixed(3),
            scope: Scope::Columns,
            source: "Eq. 1.1 of Man et al. 2023",
        }
        ParticleFriction {
            key: "particle friction μ_p",
            description: "Σ P_a P_b μ_ab over the shares by number of the species",
            symbol: "μ_p",
            format: Format::Fixed(3),
            scope: Scope::Columns,
            source: "Eqs. 4.1 and 4.2 of Man et al. 2023",
        }
        SecondShare {
            key: "second share P_2",
            description: "share by number of the second species",
            symbol: "P_2",
            format: Format::Fixed(3),
            scope: Scope::Columns,
        }
        SolidFraction {
            key: "solid fraction φ_i",
            description: "volume of the grains over that of the column at the start",
            symbol: "φ_i",
            format: Format::Fixed(3),
            scope: Scope::Columns,
        }
        PackedAspectRatio {
            key: "φ_i^0.5 α_eff",
            description: "columns of different solid fractions fall together over it",
            symbol: "φ_i^0.5 α_eff",
            format: Format::Fixed(3),
            scope: Scope::Columns,
            source: "Eq. 4.6 of Man et al. 2023",
        }
        PeakEnergy {
            key: "peak energy",
            description: "largest kinetic energy per grain of the samples, translation and \
                          rotation",
            short_label: "Peak energy per grain",
            unit: units::ENERGY,
            format: Format::Prefixed,
            scope: Scope::Columns,
        }
        PeakTime {
            key: "peak time t_max",
            description: "time of the sample with the largest kinetic energy",
            symbol: "t_max",
            unit: units::TIME,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        RestTime {
            key: "rest time t_f",
            description: "first sample after the peak with a kinetic energy per grain below 1 % \
                          of the peak and the front within 1 % of R_∞",
            symbol: "t_f",
            unit: units::TIME,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        EnergyRestTime {
            key: "rest time of the energy",
            description: "first sample after the peak with a kinetic energy per grain below 1 % \
                          of the peak, wherever the front is",
            unit: units::TIME,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        FrontRestTime {
            key: "rest time of the front",
            description: "first sample after the peak with the front within 1 % of R_∞, however \
                          fast grains are",
            unit: units::TIME,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        DimensionlessPeakTime {
            key: "T_max",
            description: "over √(R_i/g)",
            symbol: "T_max",
            format: Format::Fixed(2),
            scope: Scope::Columns,
            source: "Eq. 4.5 of Man et al. 2023",
        }
        DimensionlessRestTime {
            key: "T_f",
            description: "over √(R_i/g)",
            symbol: "T_f",
            format: Format::Fixed(2),
            scope: Scope::Columns,
            source: "Eq. 4.5 of Man et al. 2023",
        }
        FinalFront {
            key: "front radius R_∞",
            description: "the front radius of the last sample",
            symbol: "R_∞",
            unit: units::LENGTH,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        RunOut {
            key: "run-out ℛ",
            description: "(R_∞ − R_i)/R_i",
            short_label: "Run-out",
            symbol: "ℛ",
            format: Format::Fixed(3),
            scope: Scope::Columns,
        }
        FinalHeight {
            key: "height H_∞",
            description: "the deposit height of the last sample",
            symbol: "H_∞",
            unit: units::LENGTH,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        RelativeHeight {
            key: "H_∞/R_i",
            description: "height over the initial radius",
            short_label: "Height H_∞/R_i",
            symbol: "H_∞/R_i",
            format: Format::Fixed(3),
            scope: Scope::Columns,
        }
        ConeVolume {
            key: "V_cone",
            description: "(π/3) R_∞² H_∞",
            symbol: "V_cone",
            unit: units::VOLUME,
            scope: Scope::Columns,
            source: "Eq. 4.3 of Man et al. 2023",
        }
        RelativeConeVolume {
            key: "V_cone/V_init",
            description: "volume of the cone over that of the column, π R_i² H_i",
            short_label: "Cone volume V_cone/V_init",
            symbol: "V_cone/V_init",
            format: Format::Fixed(3),
            scope: Scope::Columns,
        }
        FlatRadius {
            key: "flat radius",
            description: "where the mean profile of height falls below nine tenths of its apex",
            short_label: "Flat radius of the top",
            unit: units::LENGTH,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        Shape {
            key: "deposit shape",
            description: "frustum: the flat radius is larger than a quarter of R_∞; cone: it is \
                          not",
            format: Format::Choice(&DepositShape::WORDS),
            scope: Scope::Columns,
        }
    }
}
