//! How far the energy of a symplectic step strays: it conserves a modified energy that is near.
//!
//! For kicks of the potential V around a drift of the kinetic energy T, the Baker–Campbell–Hausdorff series gives the
//! conserved energy of the step.
//! ```text
//! order 2 (half kicks)        T + V + h² (D + V̈/12 − K/24) + O(h⁴)
//! order 1 (drift, then kick)  T + V + h V̇/2 + h² (D + V̈/12 + K/12) + O(h³)
//! ```
//! V̇ and V̈ are time derivatives along the free motion, and K = τ·Σ⁻¹τ belongs to the force τ. The drift adds h² D to
//! T where it is no exact free motion. Source: Hairer, Lubich and Wanner, *Geometric Numerical Integration*, §IX.3 and
//! §IX.4.

use crate::claims::Claims;
use crate::flags::{Order, Run};
use crate::round_off;

/// h times the fastest rate above which the leading terms of the series say nothing reliable.
const LONGEST_STEP: f64 = 0.5;

/// The terms of the modified energy at one state.
#[derive(Clone, Copy, Debug)]
pub struct Terms {
    /// D: the kinetic energy whose free motion the drift is, less T, over h².
    pub drift: f64,
    /// V̇ along the free motion.
    pub power: f64,
    /// V̈ along the free motion.
    pub power_rate: f64,
    /// K = τ·Σ⁻¹τ.
    pub kick: f64,
    /// The fastest rate of the motion, 1/time.
    pub rate: f64,
}

/// Follows the energy of a run and the modified energy.
#[derive(Clone, Copy, Debug)]
pub struct EnergyBand {
    order: Order,
    h: f64,
    steps: u64,
    energy: Range,
    modification: Range,
    modified: Range,
    /// Largest sum of the sizes of the terms.
    terms: f64,
    rate: f64,
    /// Largest |T| + |V|.
    scale: f64,
}

impl EnergyBand {
    /// Nothing observed yet.
    pub fn new(run: &Run) -> Self {
        let (h, order, steps, none) = (run.step_size, run.order, run.steps, Range::default());
        Self { order, h, steps, energy: none, modification: none, modified: none, terms: 0.0, rate: 0.0, scale: 0.0 }
    }

    /// Takes the energy of a state, its potential part and the terms there.
    pub fn observe(&mut self, energy: f64, potential: f64, terms: Terms) {
        let (h, square) = (self.h, self.h * self.h);
        let [power, drift, power_rate, kick] = match self.order {
            Order::First => [
                h * terms.power / 2.0,
                square * terms.drift,
                square * terms.power_rate / 12.0,
                square * terms.kick / 12.0,
            ],
            Order::Second => [0.0, square * terms.drift, square * terms.power_rate / 12.0, -square * terms.kick / 24.0],
        };
        let modification = power + drift + power_rate + kick;
        self.energy.observe(energy);
        self.modification.observe(modification);
        self.modified.observe(energy + modification);
        self.terms = self.terms.max(power.abs() + drift.abs() + power_rate.abs() + kick.abs());
        self.rate = self.rate.max(terms.rate);
        self.scale = self.scale.max((energy - potential).abs() + potential.abs());
    }

    /// Says that rounding acts on the energy as on a number of this size, where that is more than its own.
    pub fn rounds_like(&mut self, scale: f64) {
        self.scale = self.scale.max(scale);
    }

    /// The lowest and the highest energy.
    pub fn range(&self) -> (f64, f64) {
        (self.energy.low, self.energy.high)
    }

    /// Claims that the modified energy is constant and that the energy stays in the band which follows.
    ///
    /// The neglected terms are smaller than the others by (hΩ)² at order 2, by hΩ at order 1, Ω the fastest rate.
    pub fn claim(&self, claims: &mut Claims) {
        let names = ["the energy stays in its band", "the modified energy is constant"];
        let angle = self.h * self.rate;
        if angle > LONGEST_STEP {
            let reason = format!("hΩ = {angle:.2} is above {LONGEST_STEP}: a step too long for the series in h");
            return names.into_iter().for_each(|name| claims.skip(name, &reason));
        }
        let (left_out, power) = match self.order {
            Order::First => (2.0 * angle * self.terms, "hΩ"),
            Order::Second => (2.0 * angle * angle * self.terms, "(hΩ)²"),
        };
        let accuracy = left_out + round_off::worst_case(self.steps, self.scale);
        let band = self.modification.excursion() + accuracy;
        claims.at_most(
            names[0],
            self.energy.excursion(),
            band,
            "as far as the modification goes, and what is left out",
        );
        let reason = format!("terms left out: {power} times those kept, at both ends; and rounding");
        claims.at_most(names[1], self.modified.excursion(), accuracy, &reason);
    }
}

/// The first, the least and the greatest of some values.
#[derive(Clone, Copy, Debug)]
struct Range {
    first: Option<f64>,
    low: f64,
    high: f64,
}

impl Default for Range {
    fn default() -> Self {
        Self { first: None, low: f64::INFINITY, high: f64::NEG_INFINITY }
    }
}

impl Range {
    fn observe(&mut self, value: f64) {
        self.first.get_or_insert(value);
        self.low = self.low.min(value);
        self.high = self.high.max(value);
    }

    /// The largest distance from the first value.
    fn excursion(&self) -> f64 {
        let first = self.first.unwrap_or(f64::NAN);
        (self.high - first).max(first - self.low)
    }
}
