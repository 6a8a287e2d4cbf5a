//! Liquid bridges, Eqs. 11–17 of Kasper et al. 2021, built from the named choices of [`BridgeLaw`].
//!
//! In: the liquid, the pair, the bridge's volume, the gap and the relative motion. Out: capillary
//! attraction, viscous forces along and across the normal, the rupture gap. What depends on the
//! volume alone is computed once, when a bridge forms ([`BridgeConstants`]); a step then takes one
//! exponential and one logarithm, both of sums and products alone.
//!
//! The drag of a thin film can exceed what a step of this length can bear. It is bounded so that it
//! never can: with `d` partners of each grain, coefficients `c ≤ 1.6/(Δt Σ d/m)` leave the explicit
//! step stable whatever the viscosity (for any grains that hold together,
//! `Σ c (v_i − v_j)² ≤ Σ c (d_i/m_i + d_j/m_j)(m_i v_i²/d_i + m_j v_j²/d_j) ≤ (1.6/Δt) Σ m v²`).
//! The advised time step is short enough that the bound acts on next to no pair.

use super::{Pairing, SmallestGrain, StepLimit, natural_log};
use crate::lanes::{Lanes, One, Row};
use crate::physics::{BridgeVolume, CapillaryGap, Liquid, PairAngle, Rupture, SmallestGap};
use std::f64::consts::{LN_2, PI};

/// What the forces of any bridge between two kinds of grain depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct FilmConstants {
    /// `6π η r*²` [N s]; `6π η r*` [N s/m]; logarithm of the effective radius r* in metres;
    /// `2/5 r²` of the larger grain [m²].
    pub viscous: Row,
    /// Smallest gap in the capillary and in the viscous forces, largest gap in both [m]; unused.
    pub gaps: Row,
}

/// What the capillary force of one bridge depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BridgeConstants {
    /// Constant part of the attraction [N], its decaying part at no gap [N], rate of the decay
    /// [1/m], rupture gap [m].
    pub row: Row,
}

/// Share of the grain radii's sum at which gaps are cut off, Eq. 15.
const SMALLEST_GAP: f64 = 0.01;
const LARGEST_GAP: f64 = 0.1;
/// Share of both films that makes a bridge, Eq. 11.
const FILM_SHARE: f64 = 0.05;
/// Largest drag coefficient times the step over the mass that partners leave free; 2 is the limit
/// of stability.
pub(super) const LARGEST_DRAG: f64 = 1.6;
/// Neighbours of a grain whose drag the step must bear without bounding it.
const DRAGGING_NEIGHBOURS: f64 = 6.0;
/// How much more freely a sphere's surface moves across the normal than its centre does:
/// `1 + m r²/I`.
const SURFACE_MOBILITY: f64 = 3.5;

impl FilmConstants {
    /// For the grains of `pairing`.
    pub fn of(pairing: &Pairing, liquid: &Liquid) -> Self {
        let radius = pairing.effective_radius;
        let sum = pairing.radii.0 + pairing.radii.1;
        let larger = pairing.radii.0.max(pairing.radii.1);
        let smallest = smallest_viscous_gap(liquid.law.viscous_gap, radius, sum);
        let in_contact = match liquid.law.capillary_gap {
            CapillaryGap::Clamped => SMALLEST_GAP * sum,
            CapillaryGap::Open => 0.0,
        };
        let drag = 6.0 * PI * liquid.viscosity * radius;
        Self {
            viscous: [
                drag * radius,
                drag,
                natural_log(radius),
                0.4 * larger * larger,
            ],
            gaps: [in_contact, smallest, (LARGEST_GAP * sum).max(smallest), 0.0],
        }
    }
}

/// Smallest gap in the viscous forces of grains with this effective radius and sum of radii [m].
fn smallest_viscous_gap(gap: SmallestGap, effective_radius: f64, sum: f64) -> f64 {
    match gap {
        SmallestGap::OfRadii(share) => share * sum,
        SmallestGap::OfEffectiveRadius(share) => share * effective_radius,
    }
}

/// `1.6 m/(2 · 6 c)` with the drag `c = 6π η r*²/D` of two equal grains at the smallest gap: up to
/// that step it acts unbounded on grains with six neighbours each.
pub fn lubrication_limit(grain: &SmallestGrain, liquid: &Liquid) -> StepLimit {
    let mass = grain.mass();
    let effective = 0.5 * grain.radius;
    let gap = smallest_viscous_gap(liquid.law.viscous_gap, effective, 2.0 * grain.radius);
    let drag = 6.0 * PI * liquid.viscosity * effective * effective / gap;
    StepLimit {
        name: "lubrication",
        time_step: LARGEST_DRAG * mass / (2.0 * DRAGGING_NEIGHBOURS * drag),
        reason: format!(
            "{LARGEST_DRAG}/12 of the {:.3e} s in which the liquid film stops a grain of {} with r = {:.3e} m that closes \
             the smallest gap",
            mass / drag,
            grain.material.name,
            grain.radius
        ),
    }
}

/// Parts of a new bridge that the films of both grains give, with films of these volumes [m³].
pub fn contributions(liquid: &Liquid, radii: (f64, f64), films: (f64, f64)) -> (f64, f64) {
    match liquid.law.volume {
        BridgeVolume::FilmShare => (FILM_SHARE * films.0, FILM_SHARE * films.1),
        BridgeVolume::ShadedCap => {
            let sum = radii.0 + radii.1;
            let cap = |other: f64| 0.5 * (1.0 - (1.0 - (other / sum) * (other / sum)).sqrt());
            (cap(radii.1) * films.0, cap(radii.0) * films.1)
        }
    }
}

/// Gap at which a bridge of this volume [m³] between grains of these radii breaks [m].
pub fn rupture_gap(liquid: &Liquid, radii: (f64, f64), volume: f64) -> f64 {
    let gap = (1.0 + 0.5 * pair_angle(liquid)) * cube_root(volume);
    match liquid.law.rupture {
        Rupture::Capped => gap.min(LARGEST_GAP * (radii.0 + radii.1)),
        Rupture::AtRuptureGap => gap,
    }
}

/// Constants of bridges that are asked for one after another. As a rule all are the same, and
/// computed once.
pub struct BridgeKinds<'a> {
    liquid: &'a Liquid,
    /// Both radii and the volume that were asked for last, and what came of them.
    last: Option<((f64, f64, f64), BridgeConstants)>,
}

impl<'a> BridgeKinds<'a> {
    /// Of bridges of `liquid`.
    pub fn of(liquid: &'a Liquid) -> Self {
        Self { liquid, last: None }
    }

    /// The constants of a bridge of this volume [m³] between grains of these radii [m].
    pub fn constants(&mut self, radii: (f64, f64), volume: f64) -> BridgeConstants {
        let kind = (radii.0, radii.1, volume);
        if let Some((known, constants)) = self.last
            && known == kind
        {
            return constants;
        }
        let constants = BridgeConstants::of(self.liquid, radii, volume);
        self.last = Some((kind, constants));
        constants
    }
}

impl BridgeConstants {
    /// Eqs. 13 and 14 for a bridge of this volume [m³].
    pub fn of(liquid: &Liquid, radii: (f64, f64), volume: f64) -> Self {
        let larger = radii.0.max(radii.1);
        let log = natural_log(volume / (larger * larger * larger));
        let angles = 2.0 * pair_angle(liquid);
        let a = -1.1 * exponential(-0.53 * log);
        let b = (-0.037 * log - 0.24) * angles * angles - 0.0082 * log + 0.48;
        let c = 0.0018 * log + 0.078;
        let scale = PI * liquid.surface_tension * (radii.0 * radii.1).sqrt();
        Self {
            row: [
                scale * c,
                scale * exponential(b),
                a / larger,
                rupture_gap(liquid, radii, volume),
            ],
        }
    }
}

/// Contact angle of a pair [rad].
fn pair_angle(liquid: &Liquid) -> f64 {
    let angle = liquid.contact_angle;
    match liquid.law.angle {
        PairAngle::Mean => angle,
        PairAngle::HalfProduct => 0.5 * angle * angle,
    }
}

/// Capillary attraction [N] across the gap, clamped as the law says [m].
#[inline(always)]
pub fn attraction<N: Lanes>(processor: N::Processor, constants: [N; 4], gap: N) -> N {
    let [constant, decaying, rate, _] = constants;
    constant + decaying * decay(processor, rate * gap)
}

/// Coefficients of the drag along and across the normal [N s/m] at the gap, clamped as the law says
/// [m].
///
/// `mobility` is the step over the mass that partners leave free, summed over both sides [s/kg].
#[inline(always)]
pub fn drag<N: Lanes>(processor: N::Processor, film: [N; 4], gap: N, mobility: N) -> [N; 2] {
    let [normal, across, log_radius, _] = film;
    let zero = N::splat(processor, 0.0);
    let (inverse, log) = inverse_and_logarithm(processor, gap);
    let bracket =
        N::splat(processor, 8.0 / 15.0) * (log_radius - log) + N::splat(processor, 0.9588);
    let bracket = N::choose(bracket.exceeds(zero), bracket, zero);
    let (normal, across) = (normal * inverse, across * bracket);
    let bound = N::splat(processor, LARGEST_DRAG) / mobility;
    let bound_across = N::splat(processor, 1.0 / SURFACE_MOBILITY) * bound;
    [
        N::choose(normal.exceeds(bound), bound, normal),
        N::choose(across.exceeds(bound_across), bound_across, across),
    ]
}

/// `eˣ` for `x ≤ 0`, to 1e-14 of itself down to e⁻⁸, and next to nothing below e⁻³².
///
/// `eˣ = (e^(x/64))⁶⁴`, the inner one by its series.
#[inline(always)]
fn decay<N: Lanes>(processor: N::Processor, x: N) -> N {
    let lowest = N::splat(processor, -32.0);
    let x = N::choose(x.exceeds(lowest), x, lowest);
    let y = x * N::splat(processor, 1.0 / 64.0);
    // Terms by twos and fours, so that short chains of operations run side by side.
    let square = y * y;
    let fourth = square * square;
    let first = four_terms(processor, 0, y, square);
    let second = four_terms(processor, 4, y, square);
    let third = four_terms(processor, 8, y, square);
    let mut power = first + fourth * (second + fourth * third);
    for _ in 0..6 {
        power = power * power;
    }
    power
}

/// Four terms of the exponential series from the `n`-th on, over the power of y in the first.
#[inline(always)]
fn four_terms<N: Lanes>(processor: N::Processor, n: usize, y: N, square: N) -> N {
    let [a, b, c, d] = [n, n + 1, n + 2, n + 3].map(|n| INVERSE_FACTORIALS[n]);
    let low = N::splat(processor, a) + N::splat(processor, b) * y;
    let high = N::splat(processor, c) + N::splat(processor, d) * y;
    low + high * square
}

/// `1/n!`.
const INVERSE_FACTORIALS: [f64; 12] = {
    let mut inverse = [1.0; 12];
    let (mut n, mut factorial) = (1, 1.0);
    while n < inverse.len() {
        factorial *= n as f64;
        inverse[n] = 1.0 / factorial;
        n += 1;
    }
    inverse
};

/// `1/x` and `ln x`, the latter as [`natural_log`] but side by side, for positive x far from the
/// ends of what a number holds.
#[inline(always)]
fn inverse_and_logarithm<N: Lanes>(processor: N::Processor, x: N) -> (N, N) {
    let one = N::splat(processor, 1.0);
    let (m, k) = x.split();
    let inverse = one / x;
    let s = (m - one) / (m + one);
    let square = s * s;
    // Every other term apart, so that two short chains of operations run side by side.
    let squared = square * square;
    let mut even = N::splat(processor, 1.0 / 17.0);
    let mut odd = N::splat(processor, 1.0 / 19.0);
    for n in [13.0, 9.0, 5.0, 1.0] {
        even = even * squared + N::splat(processor, 1.0 / n);
        odd = odd * squared + N::splat(processor, 1.0 / (n + 2.0));
    }
    let series = even + square * odd;
    let log = k * N::splat(processor, LN_2) + N::splat(processor, 2.0) * s * series;
    (inverse, log)
}

/// `eˣ`, by sums and products alone.
fn exponential(x: f64) -> f64 {
    let power = decay::<One>((), One::splat((), -x.abs())).get();
    if x > 0.0 { 1.0 / power } else { power }
}

/// Cube root of a volume.
fn cube_root(volume: f64) -> f64 {
    if volume <= 0.0 {
        return 0.0;
    }
    // Two steps of Newton's rule end in the last bits.
    let guess = large_exponential(natural_log(volume) / 3.0);
    (0..2).fold(guess, |root, _| {
        root - (root - volume / (root * root)) / 3.0
    })
}

/// `eˣ` for any x, halved into the range of [`exponential`].
fn large_exponential(x: f64) -> f64 {
    let (mut x, mut doublings) = (x, 0);
    while x.abs() > 4.0 {
        (x, doublings) = (0.5 * x, doublings + 1);
    }
    (0..doublings).fold(exponential(x), |power, _| power * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_and_logarithms_are_those_of_the_platform() {
        for x in [0.0, -1e-9, -0.01, -0.5, -1.0, -3.0, -7.9] {
            let found = decay::<One>((), One::splat((), x)).get();
            assert!(
                (found / f64::exp(x) - 1.0).abs() < 2e-14,
                "e^{x}: {found:e}"
            );
        }
        assert!(decay::<One>((), One::splat((), -1e6)).get() < 1e-13);
        for x in [
            1e-200, 2.5e-4, 0.01, 0.5, 0.7, 0.7072, 1.0, 1.414, 1.5, 2.0, 3.999, 25.0, 4000.0,
            1e200,
        ] {
            let (inverse, log) = inverse_and_logarithm::<One>((), One::splat((), x));
            let (inverse, log) = (inverse.get(), log.get());
            assert!((inverse * x - 1.0).abs() < 1e-15, "1/{x}: {inverse}");
            let error = (log - f64::ln(x)).abs();
            assert!(error < 4e-15 * (1.0 + f64::ln(x).abs()), "ln {x}: {log}");
        }
        for x in [1e-30, 6.2e-11, 1e-6, 0.5, 27.0] {
            assert!((cube_root(x) / f64::cbrt(x) - 1.0).abs() < 1e-14, "{x}");
        }
    }

    /// Attraction over `π γ r` of equal grains of radius 1 mm with bridges of `Ṽ` and a contact
    /// angle in degrees.
    fn soulie(volume: f64, degrees: f64, gap: f64) -> f64 {
        let liquid = Liquid {
            surface_tension: 0.07,
            contact_angle: f64::to_radians(degrees),
            viscosity: 0.0,
            volume: 1.0,
            law: crate::physics::BridgeLaw::AS_PRINTED,
        };
        let constants = BridgeConstants::of(&liquid, (1e-3, 1e-3), volume * 1e-9);
        let row = constants.row.map(|x| One::splat((), x));
        let force = attraction((), row, One::splat((), gap * 1e-3)).get();
        force / (PI * 0.07 * 1e-3)
    }

    #[test]
    fn capillary_attraction_is_that_of_soulie() {
        let gaps = [0.0, 0.02, 0.1, 0.2];
        let table = [
            (0.001, 0.0, [1.77582, 0.79226, 0.08925, 0.06589]),
            (0.01, 20.0, [1.69200, 1.32988, 0.52851, 0.19947]),
            (0.0315, 40.0, [1.40805, 1.23638, 0.74368, 0.40962]),
        ];
        for (volume, angle, expected) in table {
            for (gap, expected) in gaps.into_iter().zip(expected) {
                let found = soulie(volume, angle, gap);
                assert!(
                    (found - expected).abs() < 1e-5,
                    "{volume} {angle} {gap}: {found}"
                );
            }
        }
    }
}
