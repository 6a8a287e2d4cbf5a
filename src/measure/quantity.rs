//! What a sample holds: one [`Measure`] per column and what people need to know of it.

use crate::world::{Shape, World};

/// What one number is: its key in files, its name and symbol for people, its unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Name in files and on plots: `surface angle`.
    pub name: &'static str,
    /// The paper's symbol: `θ`.
    pub symbol: &'static str,
    /// SI unit, `1` for a pure number: `rad`.
    pub unit: &'static str,
    /// One sentence: what it is and by which method it is taken.
    pub description: &'static str,
}

/// A number that every sample holds, NaN where it has no meaning; `as usize` gives its column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Measure {
    /// Slope of the free surface [rad].
    SurfaceAngle,
    /// Granular temperature in the laboratory frame [m²/s²].
    GranularTemperature,
    /// Granular temperature in the drum's frame [m²/s²].
    CorotatingTemperature,
    /// Grain volume per bed volume.
    PackingFraction,
    /// Touching grains per grain.
    CoordinationNumber,
    /// Kinetic energy [J].
    KineticEnergy,
    /// Largest overlap relative to the smaller radius, of polyhedra to the rounding radius.
    LargestOverlap,
    /// What the energy ledger leaves unexplained [J].
    EnergyResidual,
    /// Energy stored in the contacts [J].
    ElasticEnergy,
    /// Work of gravity since the start [J].
    GravityWork,
    /// Work of the moving walls since the start [J].
    WallWork,
    /// Energy lost in dashpots since the start [J].
    DashpotLoss,
    /// Energy lost in sliding since the start [J].
    SlidingLoss,
    /// Energy lost in rolling since the start [J].
    RollingLoss,
    /// Mean speed of the grains [m/s].
    MeanSpeed,
    /// Mean distance of the surface from a straight line [m].
    SurfaceRoughness,
    /// Curvature of the surface, positive where it is convex [1/m].
    SurfaceCurvature,
    /// Number of liquid bridges.
    Bridges,
    /// Bridges that broke since the start.
    Ruptures,
    /// Torque that turns the drum against its grains [N m].
    DrumTorque,
    /// Energy lost to the viscosity of the liquid since the start [J].
    ViscousLoss,
    /// Energy taken by capillary forces since the start [J].
    CapillaryLoss,
    /// Radius of the front [m].
    FrontRadius,
    /// Radius within which the centres of 99 % of the grains lie [m].
    FrontRadius99,
    /// Radius within which the centres of 95 % of the grains lie [m].
    FrontRadius95,
    /// Radius of the front of the largest cluster [m].
    ClusterRadius,
    /// Height of the highest grain near the axis [m].
    DepositHeight,
    /// Apex of the mean profile of height [m].
    ApexHeight,
    /// Volume of the cone of front and height over that of the column.
    ConeVolumeRatio,
    /// Mean kinetic energy of translation of a grain [J].
    TranslationalEnergy,
    /// Mean kinetic energy of rotation of a grain [J].
    RotationalEnergy,
    /// Share of the touching pairs in which both grains are of the first species.
    FirstPairs,
    /// Share of the touching pairs of one grain of either species.
    MixedPairs,
    /// Share of the touching pairs in which both grains are of the second species.
    SecondPairs,
}

impl Measure {
    /// Number of measures in a sample.
    pub const COUNT: usize = 34;

    /// Every measure in the order of its column.
    pub const ALL: [Self; Self::COUNT] = [
        Self::SurfaceAngle,
        Self::GranularTemperature,
        Self::CorotatingTemperature,
        Self::PackingFraction,
        Self::CoordinationNumber,
        Self::KineticEnergy,
        Self::LargestOverlap,
        Self::EnergyResidual,
        Self::ElasticEnergy,
        Self::GravityWork,
        Self::WallWork,
        Self::DashpotLoss,
        Self::SlidingLoss,
        Self::RollingLoss,
        Self::MeanSpeed,
        Self::SurfaceRoughness,
        Self::SurfaceCurvature,
        Self::Bridges,
        Self::Ruptures,
        Self::DrumTorque,
        Self::ViscousLoss,
        Self::CapillaryLoss,
        Self::FrontRadius,
        Self::FrontRadius99,
        Self::FrontRadius95,
        Self::ClusterRadius,
        Self::DepositHeight,
        Self::ApexHeight,
        Self::ConeVolumeRatio,
        Self::TranslationalEnergy,
        Self::RotationalEnergy,
        Self::FirstPairs,
        Self::MixedPairs,
        Self::SecondPairs,
    ];

    /// Whether it has a meaning in `world`: only a drum or a box holds a bed that has a surface, only a drum is turned, only
    /// a column has a front, and without liquid there are no bridges but where it can be poured in.
    pub fn concerns(self, world: &World) -> bool {
        let shape = &world.container.shape;
        let is_column = matches!(shape, Shape::Column { .. });
        let has_bed = matches!(shape, Shape::Drum { .. } | Shape::Box { .. });
        match self {
            Self::SurfaceAngle
            | Self::GranularTemperature
            | Self::CorotatingTemperature
            | Self::PackingFraction
            | Self::SurfaceRoughness
            | Self::SurfaceCurvature => has_bed,
            Self::DrumTorque => matches!(shape, Shape::Drum { .. }),
            Self::Bridges | Self::Ruptures | Self::ViscousLoss | Self::CapillaryLoss => {
                has_bed || world.liquid.is_some()
            }
            Self::FrontRadius
            | Self::FrontRadius99
            | Self::FrontRadius95
            | Self::ClusterRadius
            | Self::DepositHeight
            | Self::ApexHeight
            | Self::ConeVolumeRatio
            | Self::TranslationalEnergy
            | Self::RotationalEnergy
            | Self::FirstPairs
            | Self::MixedPairs
            | Self::SecondPairs => is_column,
            _ => true,
        }
    }

    /// The measures that have a meaning in `world`, in the order of their columns.
    pub fn of(world: &World) -> Vec<Self> {
        let concerns = |measure: &Self| measure.concerns(world);
        Self::ALL.into_iter().filter(concerns).collect()
    }

    /// Name, symbol, unit and method.
    pub fn quantity(self) -> &'static Quantity {
        &QUANTITIES[self as usize]
    }
}

/// What a sample holds, in the order of [`Measure::ALL`].
pub const QUANTITIES: &[Quantity] = &[
    Quantity {
        name: "surface angle",
        symbol: "θ",
        unit: "rad",
        description: "Slope of a straight line through the top grain of each bin over the middle 70 % of the free \
                      surface, positive where the surface rises to the right.",
    },
    Quantity {
        name: "granular temperature",
        symbol: "Tg",
        unit: "m²/s²",
        description: "Mean square of the grains' velocity relative to the mean of their neighbours within 7r/3, per \
                      direction, in the laboratory frame (Eqs. 21 and 22 of Kasper et al. 2021).",
    },
    Quantity {
        name: "co-rotating temperature",
        symbol: "Tg′",
        unit: "m²/s²",
        description: "The granular temperature of the velocities relative to the turning drum.",
    },
    Quantity {
        name: "packing fraction",
        symbol: "φ",
        unit: "1",
        description: "Grain volume per container volume in the part of the bed that lies deeper than two mean radii \
                      below the surface line; layers at the walls are included.",
    },
    Quantity {
        name: "coordination number",
        symbol: "Z",
        unit: "1",
        description: "Mean number of other grains that a grain touches; walls do not count.",
    },
    Quantity {
        name: "kinetic energy",
        symbol: "E_kin",
        unit: "J",
        description: "Kinetic energy of translation and rotation of all grains.",
    },
    Quantity {
        name: "largest overlap",
        symbol: "δ_max/r",
        unit: "1",
        description: "Largest overlap of all contacts relative to the smaller grain's radius, of polyhedra to their rounding \
                      radius.",
    },
    Quantity {
        name: "energy residual",
        symbol: "ΔE",
        unit: "J",
        description: "Change of kinetic and elastic energy since the start that work and losses do not explain.",
    },
    Quantity {
        name: "elastic energy",
        symbol: "E_el",
        unit: "J",
        description: "Energy stored in the normal and tangential springs of all contacts.",
    },
    Quantity {
        name: "gravity work",
        symbol: "W_g",
        unit: "J",
        description: "Work of gravity on the grains since the start.",
    },
    Quantity {
        name: "wall work",
        symbol: "W_w",
        unit: "J",
        description: "Work of the moving walls on the grains since the start.",
    },
    Quantity {
        name: "dashpot loss",
        symbol: "D_d",
        unit: "J",
        description: "Energy lost in the normal and tangential dashpots since the start.",
    },
    Quantity {
        name: "sliding loss",
        symbol: "D_s",
        unit: "J",
        description: "Energy lost in sliding friction since the start.",
    },
    Quantity {
        name: "rolling loss",
        symbol: "D_r",
        unit: "J",
        description: "Energy lost in rolling friction since the start.",
    },
    Quantity {
        name: "mean speed",
        symbol: "⟨v⟩",
        unit: "m/s",
        description: "Mean speed of the grains' centres.",
    },
    Quantity {
        name: "surface roughness",
        symbol: "h",
        unit: "m",
        description: "Mean distance of the top grains' centres from the straight line through them (Eq. 24 of Kasper et \
                      al. 2021).",
    },
    Quantity {
        name: "surface curvature",
        symbol: "κ",
        unit: "1/m",
        description: "Curvature of the parabola through the top grains' centres, positive where the surface is convex.",
    },
    Quantity {
        name: "bridges",
        symbol: "N_b",
        unit: "1",
        description: "Number of liquid bridges between grains.",
    },
    Quantity {
        name: "ruptures",
        symbol: "N_r",
        unit: "1",
        description: "Liquid bridges that broke since the start.",
    },
    Quantity {
        name: "drum torque",
        symbol: "M",
        unit: "N m",
        description: "Torque about its axis with which the drum turns against the grains' contact forces.",
    },
    Quantity {
        name: "viscous loss",
        symbol: "D_v",
        unit: "J",
        description: "Energy lost to the viscosity of the liquid since the start.",
    },
    Quantity {
        name: "capillary loss",
        symbol: "D_c",
        unit: "J",
        description: "Energy taken by capillary forces since the start: the cost of broken bridges, and what those that \
                      hold would give back.",
    },
    Quantity {
        name: "front radius",
        symbol: "R",
        unit: "m",
        description: "Distance of the farthest point of a grain from the column's axis in each of 72 sectors, their mean over the sectors that hold a grain.",
    },
    Quantity {
        name: "99 % radius",
        symbol: "R_99",
        unit: "m",
        description: "Radius about the column's axis within which the centres of 99 % of the grains lie.",
    },
    Quantity {
        name: "95 % radius",
        symbol: "R_95",
        unit: "m",
        description: "Radius about the column's axis within which the centres of 95 % of the grains lie.",
    },
    Quantity {
        name: "cluster radius",
        symbol: "R_c",
        unit: "m",
        description: "The front radius of those grains alone that belong to the largest cluster of touching grains.",
    },
    Quantity {
        name: "deposit height",
        symbol: "H",
        unit: "m",
        description: "Highest point of the grains whose centres lie within half of the column's initial radius of its axis.",
    },
    Quantity {
        name: "apex height",
        symbol: "H_a",
        unit: "m",
        description: "Largest height of the profile over the radius, averaged over the azimuth in rings two grain sizes wide.",
    },
    Quantity {
        name: "cone volume ratio",
        symbol: "V_cone/V_init",
        unit: "1",
        description: "Volume of the cone with the front radius and the deposit height over that of the column (Eq. 4.3 of Man et al. 2023).",
    },
    Quantity {
        name: "translational energy per grain",
        symbol: "e_t",
        unit: "J",
        description: "Kinetic energy of translation, mean over the grains.",
    },
    Quantity {
        name: "rotational energy per grain",
        symbol: "e_r",
        unit: "J",
        description: "Kinetic energy of rotation, mean over the grains.",
    },
    Quantity {
        name: "pairs of first species",
        symbol: "P11",
        unit: "1",
        description: "Share of the touching pairs of grains in which both are of the first species; the floor does not count.",
    },
    Quantity {
        name: "mixed pairs",
        symbol: "P12",
        unit: "1",
        description: "Share of the touching pairs of grains in which one is of either species; the floor does not count.",
    },
    Quantity {
        name: "pairs of second species",
        symbol: "P22",
        unit: "1",
        description: "Share of the touching pairs of grains in which both are of the second species; the floor does not count.",
    },
];
