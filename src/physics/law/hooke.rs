//! Linear springs and dashpots, Eqs. 3.3–3.5 of Man et al. 2023.
//!
//! `F_n = K_n δ − m_e γ_n v_n` with `γ_n = 2 √(ln² e (K_n/m_e) / (π² + ln² e))` (Eq. 3.4 solved for it) and
//! `m_e = m_1 m_2/(m_1 + m_2)`; the paper's printed `0.5 (1/m_1 + 1/m_2)` is not a mass. A net attraction is cut to
//! zero, the Coulomb bound uses the elastic part `K_n δ`, and there is no tangential dashpot, as in the paper's program.

use super::{Coefficients, Law, Pairing, natural_log};
use crate::lanes::{Lanes, Row};
use std::f64::consts::PI;

/// The law of Eqs. 3.3–3.5.
#[derive(Clone, Copy, Debug)]
pub struct Hooke;

impl Hooke {
    /// `K_n`, `m_e γ_n`, `K_t`, 0 of a pair.
    pub fn constants(
        pairing: &Pairing,
        normal_stiffness: f64,
        tangential_stiffness: f64,
        restitution: f64,
    ) -> Row {
        let log_squared = natural_log(restitution).powi(2);
        let mass = pairing.effective_mass;
        let rate = 2.0 * (log_squared * (normal_stiffness / mass) / (PI * PI + log_squared)).sqrt();
        [normal_stiffness, mass * rate, tangential_stiffness, 0.0]
    }
}

impl Law for Hooke {
    #[inline(always)]
    fn coefficients<N: Lanes>(self, constants: [N; 4], _overlap: N) -> Coefficients<N> {
        Coefficients {
            normal_stiffness: constants[0],
            normal_damping: constants[1],
            tangential_stiffness: constants[2],
            tangential_damping: constants[3],
        }
    }

    #[inline(always)]
    fn normal_force<N: Lanes>(self, elastic: N, damping: N, zero: N) -> N {
        let force = elastic + damping;
        N::choose(force.exceeds(zero), force, zero)
    }

    #[inline(always)]
    fn coulomb_force<N: Lanes>(self, elastic: N, _normal: N, _zero: N) -> N {
        elastic
    }
}
