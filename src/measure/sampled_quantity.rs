//! What every sample of a run holds: one row for each number of one instant of a world.
//!
//! In: a world. Out: which of the numbers have a meaning in it, and their rows of the registry. How
//! they are taken stands in the files named after them; [`super::sample()`] takes them all.

use super::quantity::{Format, Scope, quantities};
use crate::physics::{Unit, units};
use crate::world::{Shape, World};

quantities! {
    /// A number that every sample holds, NaN where it has no meaning.
    ///
    /// `as usize` gives its column in a [`super::Series`]; saved sessions keep the columns in this
    /// order, so that a new row stands at the end.
    Measure {
        SurfaceAngle {
            key: "surface angle",
            description: "Slope of a straight line through the top grain of each bin over the \
                          middle 70 % of the free surface, positive where the surface rises to \
                          the right.",
            symbol: "θ",
            unit: units::ANGLE,
            format: Format::Fixed(2),
            scope: Scope::Beds,
            equation: "y = y₀ + x tan θ, with the least Σ (y_k − y₀ − x_k tan θ)²",
        }
        GranularTemperature {
            key: "granular temperature",
            description: "Mean square of the grains' velocity relative to the mean of their \
                          neighbours within 7r/3, per direction, in the laboratory frame.",
            symbol: "Tg",
            unit: Unit::same("m²/s²"),
            format: Format::Scientific,
            scope: Scope::Beds,
            source: "Eqs. 21 and 22 of Kasper et al. 2021",
            equation: "Tg = Σ |u_i − ū_i|² / 3N",
        }
        CorotatingTemperature {
            key: "co-rotating temperature",
            description: "The granular temperature of the velocities relative to the turning \
                          drum.",
            symbol: "Tg′",
            unit: Unit::same("m²/s²"),
            format: Format::Scientific,
            scope: Scope::Beds,
        }
        PackingFraction {
            key: "packing fraction",
            description: "Grain volume per container volume in the part of the bed that lies \
                          deeper than two mean radii below the surface line; layers at the walls \
                          are included.",
            symbol: "φ",
            format: Format::Fixed(3),
            scope: Scope::Beds,
        }
        CoordinationNumber {
            key: "coordination number",
            description: "Mean number of other grains that a grain touches; walls do not count.",
            symbol: "Z",
            format: Format::Fixed(2),
        }
        KineticEnergy {
            key: "kinetic energy",
            description: "Kinetic energy of translation and rotation of all grains.",
            symbol: "E_kin",
            unit: units::ENERGY,
            format: Format::Prefixed,
        }
        LargestOverlap {
            key: "largest overlap",
            description: "Largest overlap of all contacts relative to the smaller grain's radius, \
                          of polyhedra to their rounding radius.",
            symbol: "δ_max/r",
        }
        EnergyResidual {
            key: "energy residual",
            description: "Change of kinetic and elastic energy since the start that work and \
                          losses do not explain.",
            symbol: "ΔE",
            unit: units::ENERGY,
            format: Format::Prefixed,
        }
        ElasticEnergy {
            key: "elastic energy",
            description: "Energy stored in the normal and tangential springs of all contacts.",
            symbol: "E_el",
            unit: units::ENERGY,
            format: Format::Prefixed,
        }
        GravityWork {
            key: "gravity work",
            description: "Work of gravity on the grains since the start.",
            symbol: "W_g",
            unit: units::ENERGY,
            format: Format::Prefixed,
        }
        WallWork {
            key: "wall work",
            description: "Work of the moving walls on the grains since the start.",
            symbol: "W_w",
            unit: units::ENERGY,
            format: Format::Prefixed,
        }
        DashpotLoss {
            key: "dashpot loss",
            description: "Energy lost in the normal and tangential dashpots since the start.",
            symbol: "D_d",
            unit: units::ENERGY,
            format: Format::Prefixed,
        }
        SlidingLoss {
            key: "sliding loss",
            description: "Energy lost in sliding friction since the start.",
            symbol: "D_s",
            unit: units::ENERGY,
            format: Format::Prefixed,
        }
        RollingLoss {
            key: "rolling loss",
            description: "Energy lost in rolling friction since the start.",
            symbol: "D_r",
            unit: units::ENERGY,
            format: Format::Prefixed,
        }
        MeanSpeed {
            key: "mean speed",
            description: "Mean speed of the grains' centres.",
            symbol: "⟨v⟩",
            unit: Unit::same("m/s"),
            format: Format::Prefixed,
        }
        SurfaceRoughness {
            key: "surface roughness",
            description: "Mean distance of the top grains' centres from the straight line through \
                          them.",
            symbol: "h",
            unit: units::LENGTH,
            format: Format::Fixed(3),
            scope: Scope::Beds,
            source: "Eq. 24 of Kasper et al. 2021",
        }
        SurfaceCurvature {
            key: "surface curvature",
            description: "Curvature of the parabola through the top grains' centres, positive \
                          where the surface is convex.",
            symbol: "κ",
            unit: Unit::same("1/m"),
            format: Format::Fixed(2),
            scope: Scope::Beds,
        }
        Bridges {
            key: "bridges",
            description: "Number of liquid bridges between grains.",
            symbol: "N_b",
            format: Format::Count,
            scope: Scope::Liquids,
        }
        Ruptures {
            key: "ruptures",
            description: "Liquid bridges that broke since the start.",
            symbol: "N_r",
            format: Format::Count,
            scope: Scope::Liquids,
        }
        DrumTorque {
            key: "drum torque",
            description: "Torque about its axis with which the drum turns against the grains' \
                          contact forces.",
            symbol: "M",
            unit: Unit::same("N m"),
            format: Format::Prefixed,
            scope: Scope::Drums,
        }
        ViscousLoss {
            key: "viscous loss",
            description: "Energy lost to the viscosity of the liquid since the start.",
            symbol: "D_v",
            unit: units::ENERGY,
            format: Format::Prefixed,
            scope: Scope::Liquids,
        }
        CapillaryLoss {
            key: "capillary loss",
            description: "Energy taken by capillary forces since the start: the cost of broken \
                          bridges, and what those that hold would give back.",
            symbol: "D_c",
            unit: units::ENERGY,
            format: Format::Prefixed,
            scope: Scope::Liquids,
        }
        FrontRadius {
            key: "front radius",
            description: "Distance of the farthest point of a grain from the column's axis in \
                          each of 72 sectors, their mean over the sectors that hold a grain.",
            symbol: "R",
            unit: units::LENGTH,
            format: Format::Fixed(2),
            scope: Scope::Columns,
            equation: "R = Σ R_k / 72",
        }
        FrontRadius99 {
            key: "99 % radius",
            description: "Radius about the column's axis within which the centres of 99 % of the \
                          grains lie.",
            symbol: "R_99",
            unit: units::LENGTH,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        FrontRadius95 {
            key: "95 % radius",
            description: "Radius about the column's axis within which the centres of 95 % of the \
                          grains lie.",
            symbol: "R_95",
            unit: units::LENGTH,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        ClusterRadius {
            key: "cluster radius",
            description: "The front radius of those grains alone that belong to the largest \
                          cluster of touching grains.",
            symbol: "R_c",
            unit: units::LENGTH,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        DepositHeight {
            key: "deposit height",
            description: "Highest point of the grains whose centres lie within half of the \
                          column's initial radius of its axis.",
            symbol: "H",
            unit: units::LENGTH,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        ApexHeight {
            key: "apex height",
            description: "Largest height of the profile over the radius, averaged over the \
                          azimuth in rings two grain sizes wide.",
            symbol: "H_a",
            unit: units::LENGTH,
            format: Format::Fixed(2),
            scope: Scope::Columns,
        }
        ConeVolumeRatio {
            key: "cone volume ratio",
            description: "Volume of the cone with the front radius and the deposit height over \
                          that of the column.",
            symbol: "V_cone/V_init",
            format: Format::Fixed(3),
            scope: Scope::Columns,
            source: "Eq. 4.3 of Man et al. 2023",
        }
        TranslationalEnergy {
            key: "translational energy per grain",
            description: "Kinetic energy of translation, mean over the grains.",
            symbol: "e_t",
            unit: units::ENERGY,
            format: Format::Prefixed,
            scope: Scope::Columns,
        }
        RotationalEnergy {
            key: "rotational energy per grain",
            description: "Kinetic energy of rotation, mean over the grains.",
            symbol: "e_r",
            unit: units::ENERGY,
            format: Format::Prefixed,
            scope: Scope::Columns,
        }
        FirstPairs {
            key: "pairs of first species",
            description: "Share of the touching pairs of grains in which both are of the first \
                          species; the floor does not count.",
            symbol: "P11",
            format: Format::Fixed(3),
            scope: Scope::Columns,
        }
        MixedPairs {
            key: "mixed pairs",
            description: "Share of the touching pairs of grains in which one is of either \
                          species; the floor does not count.",
            symbol: "P12",
            format: Format::Fixed(3),
            scope: Scope::Columns,
        }
        SecondPairs {
            key: "pairs of second species",
            description: "Share of the touching pairs of grains in which both are of the second \
                          species; the floor does not count.",
            symbol: "P22",
            format: Format::Fixed(3),
            scope: Scope::Columns,
        }
        MixingIndex {
            key: "mixing index",
            description: "Share of the pairs of neighbours that are of unlike kinds, over that by \
                          chance: 0 where kinds never meet, 1 where they are mixed at random, \
                          above 1 where they alternate. Neighbours have less than a third of the \
                          mean radius between them.",
            symbol: "I_m",
            format: Format::Fixed(3),
            scope: Scope::Mixtures,
            source: "1 − r of Newman 2003",
            equation: "I_m = (1 − Σ e_aa)/(1 − Σ a_a²)",
        }
        FloorForce {
            key: "floor force",
            description: "Force with which the grains press on the floor, that of all contacts: \
                          their weight at rest, nothing in free fall.",
            symbol: "F_f",
            unit: Unit::same("N"),
            format: Format::Prefixed,
            scope: Scope::Columns,
        }
        Weight {
            key: "weight",
            description: "What all grains weigh.",
            symbol: "W",
            unit: Unit::same("N"),
            format: Format::Prefixed,
            scope: Scope::Columns,
        }
    }
}

impl Measure {
    /// Whether it has a meaning in `world`: only a drum, a box or a mesh holds a bed that has a
    /// surface (of a mesh nobody says how much room is below it), only a drum is turned, only a column has a front, what is mixed has kinds, as many as its
    /// scene names, and without liquid there are no bridges but where it can be poured in.
    pub fn applies_to(self, world: &World) -> bool {
        let shape = &world.container.shape;
        let has_bed = matches!(
            shape,
            Shape::Drum { .. } | Shape::Box { .. } | Shape::Mesh { .. }
        );
        match self.quantity().scope {
            Scope::Beds if matches!(shape, Shape::Mesh { .. }) => self != Self::PackingFraction,
            Scope::Everywhere => true,
            Scope::Beds => has_bed,
            Scope::Drums => matches!(shape, Shape::Drum { .. }),
            Scope::Columns => matches!(shape, Shape::Column { .. }),
            Scope::Mixtures => world.species.len() > 1,
            Scope::Liquids => has_bed || world.liquid.is_some(),
        }
    }

    /// The measures that have a meaning in `world`, in the order of their columns.
    pub fn of(world: &World) -> Vec<Self> {
        let applies = |measure: &Self| measure.applies_to(world);
        Self::ALL.into_iter().filter(applies).collect()
    }
}
