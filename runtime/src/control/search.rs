//! How much of a correction is made: as much as makes an augmented Lagrangian smaller, or comes nearer to the target than ever. And the way
//! down from a saddle, where no gradient leads: along a direction in which the price curves down.
//!
//! The correction makes J − μ Σ ln s + ν⁺·g + ½ g·Rg + z⁺·(a + s) smallest in its quadratic model, g = −e the gap. The multipliers ν⁺ and
//! z⁺ are those that come next, the Hessian that of the backward sweep. So its slope is known, and near a solution full steps pass.
//!
//! Let a Q_uu, counted with all curvature as it is, have a negative eigenvalue. The Hessian L Δ Lᵀ of the augmented
//! Lagrangian then has it too. Its column of L⁻ᵀ changes the input of that stage along the eigenvector, and the later
//! ones by their gains.
//!
//! Source: Moré and Sorensen, *On the use of directions of negative curvature in a modified Newton method* (1979), for saddles.

use super::Target;
use super::end::PlanEnd;
use super::iterate::Iterate;
use super::slacks::Proposed;
use super::start::Start;
use super::sweep::{Plan, PlanSummary, Problem, Settings};
use crate::parameters::check_finite;
use crate::space::larger;
use crate::{Controlled, Error, Real, Space};
use nalgebra::{SMatrix, SVector};

/// Roll-outs of one correction.
const TRIALS: usize = 12;
/// A correction that gains this part of the gain by its model is not made shorter.
const GOOD: (i64, i64) = (4, 5);
/// The distance to the target at which a plan is near it, as a part of the scale of the end.
const NEAR: (i64, i64) = (1, 100);
/// Halvings of the first change away from a saddle, which would take a hundredth of the price: the minimum next to the saddle is wanted.
const HALVINGS: usize = 30;

/// The plan that a correction starts from.
pub(super) struct Descent<'a, T, const D: usize, const U: usize> {
    pub summary: &'a PlanSummary<T, D, U>,
    pub end: &'a PlanEnd<T, D>,
    pub settings: Settings<T, D>,
    /// Γ⁺
    pub inverse: SMatrix<T, D, D>,
}

/// Where a proposed plan leads.
struct Rolled<X, T> {
    last: X,
    /// The distance to the target.
    distance: T,
    /// By how much the augmented Lagrangian is larger.
    difference: T,
    /// The fraction of the correction that slacks allow, where it is smaller than the one that was made.
    allowed: Option<T>,
}

impl<T: Real, const D: usize, const U: usize> Descent<'_, T, D, U> {
    /// δν of the correction that closes a part of the gap, and twice the decrease of the model by it. It solves
    /// Γ δν = V_ν + (1 − part) e.
    pub fn correction(&self, part: T) -> (SVector<T, D>, T) {
        let PlanSummary { lack, descent, .. } = self.summary;
        if self.settings.gap_price.is_some() {
            return (SVector::from_element(T::zero()), *descent);
        }
        let wanted = lack + self.end.lack * (T::one() - part);
        let change = self.inverse * wanted;
        let gain = change.dot(&wanted) - (change.dot(lack) + change.dot(&self.end.lack)) * T::from_f64(2.0);
        (change, *descent + gain)
    }

    /// Whether the model of inputs reaches the target. Where it does not, no first derivative leads there.
    pub fn reaches(&self) -> bool {
        let lack = &self.summary.lack;
        let left: SVector<T, D> = self.summary.gramian * (self.inverse * lack) - lack;
        left.max_abs() <= T::from_ratio(1, 100) * lack.max_abs()
    }

    /// ν⁺·g + ½ g·Rg, or ½ w d²
    fn penalty(&self, change: &SVector<T, D>, end: &PlanEnd<T, D>) -> T {
        let half = T::from_ratio(1, 2);
        if let Some(price) = self.settings.gap_price {
            // the first changes are those of configurations, the last those of momenta
            return (price[0] * end.squares[0] + price[D - 1] * end.squares[1]) * half;
        }
        let weighted: SVector<T, D> = self.settings.weight * end.lack;
        weighted.dot(&end.lack) * half - (self.settings.multipliers + change).dot(&end.lack)
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, B: Start<S, D, U, C>, const D: usize, const U: usize, const C: usize>
    Plan<'_, S, B, D, U, C>
{
    /// Makes a part of the correction. Returns its fraction and how many roll-outs were refused, other than by slacks;
    /// `None` where no part that is large enough helps. Prices have the size `magnitude`, and a part ε of it is
    /// round-off. A full step that is trusted needs no proof. Where slacks allow only a part, as much of the gap is
    /// left to later corrections, before the correction is made shorter. If the model is poor, shorter corrections are tried as long as
    /// they gain more.
    pub fn descend(
        &mut self,
        now: &mut Iterate<T, D>,
        descent: &Descent<'_, T, D, U>,
        magnitude: T,
        is_trusted: bool,
    ) -> Option<(T, usize)> {
        let one = T::one();
        let half = T::from_ratio(1, 2);
        let (mut fraction, mut part, mut refused) = (one, one, 0);
        let is_closed = descent.settings.gap_price.is_none();
        // a shorter correction leaves a part of the gap
        let is_aimed = is_closed && !matches!(self.problem.target, Target::Free);
        let is_relaxed = self.is_relaxed();
        // the best fraction so far, with its part of the gap and its gain
        let mut best: Option<(T, T, T)> = None;
        for _ in 0..TRIALS {
            let (change, decrement) = descent.correction(part);
            if let Ok(rolled) = self.roll_out(descent, fraction, &change) {
                if let Some(allowed) = rolled.allowed {
                    // Bounds that curve allow less than they did from afar.
                    let allowed = larger(allowed * T::from_ratio(99, 100), fraction * T::from_f64(1e-3));
                    let is_far = is_closed && descent.end.distance > T::zero() && !is_relaxed;
                    if part >= one && allowed < half && is_far {
                        part = allowed * T::from_ratio(4, 5);
                    } else {
                        fraction = allowed;
                    }
                    continue;
                }
                let promised = fraction * decrement * T::from_f64(1e-4);
                let round_off = T::from_f64(16.0) * T::EPSILON * magnitude;
                let is_lower = rolled.difference <= round_off - promised;
                let is_nearer = is_closed && rolled.distance < now.nearest * T::from_ratio(9, 10);
                let is_feasible = is_relaxed && fraction >= T::from_ratio(1, 10);
                let is_enough = is_lower || is_nearer || is_feasible || is_trusted && fraction >= one;
                if rolled.difference.is_finite() && is_enough {
                    if best.is_some_and(|(_, _, difference)| difference <= rolled.difference) {
                        break;
                    }
                    let by_model = decrement * fraction * (one - fraction * half);
                    let is_good = rolled.difference <= -by_model * T::from_ratio(GOOD.0, GOOD.1);
                    if is_good || !is_lower || is_relaxed || is_trusted || is_aimed {
                        return Some((self.take(now, descent, (fraction, part, &change), rolled.last)?, refused));
                    }
                    best = Some((fraction, part, rolled.difference));
                }
            }
            refused += usize::from(best.is_none());
            fraction *= half;
        }
        let (fraction, part, _) = best?;
        let (change, _) = descent.correction(part);
        let rolled = self.roll_out(descent, fraction, &change).ok()?;
        Some((self.take(now, descent, (fraction, part, &change), rolled.last)?, refused))
    }

    /// Takes the plan of a roll-out, and gives its fraction; `None` where equations of the plan before cannot be expanded.
    fn take(
        &mut self,
        now: &mut Iterate<T, D>,
        descent: &Descent<'_, T, D, U>,
        (fraction, part, change): (T, T, &SVector<T, D>),
        last: S::Place,
    ) -> Option<T> {
        self.equate(change, fraction, descent.settings.strictness).ok()?;
        self.accept(fraction, descent.settings.strictness.barrier, last);
        self.add_multipliers(now, &(change * fraction));
        now.closes = fraction * part;
        Some(fraction)
    }

    /// Goes down from where a sweep with all curvature as it is found a direction to do so. `false` where nothing gets smaller.
    #[cold]
    pub fn escape(&mut self, descent: &Descent<'_, T, D, U>, magnitude: T) -> bool {
        let one = T::one();
        let Some(fall) = descent.summary.fall else { return false };
        let mut size = (magnitude * T::from_ratio(1, 1_000) / fall.curvature.abs()).sqrt();
        self.correction = B::none();
        self.stages.iter_mut().for_each(|stage| stage.shift = SVector::zeros());
        for _ in 0..HALVINGS {
            for part in [size, -size] {
                if let Some(stage) = self.stages.get_mut(fall.stage) {
                    stage.shift = fall.direction * part;
                }
                let promised = size * size * fall.curvature.abs() * T::from_ratio(1, 8);
                if let Ok(rolled) = self.roll_out(descent, one, &SVector::zeros())
                    && rolled.allowed.is_none()
                    && rolled.difference <= -promised
                {
                    self.accept(one, descent.settings.strictness.barrier, rolled.last);
                    return true;
                }
            }
            size *= T::from_ratio(1, 2);
        }
        false
    }

    /// The places that the inputs lead to.
    pub fn follow(&mut self) -> Result<(), Error> {
        let mut x = self.origin();
        for (index, stage) in self.stages.iter_mut().enumerate() {
            stage.place = x;
            x = self.problem.follow(stage, self.problem.time_after(index), &x, &stage.input)?;
        }
        self.last = x;
        check_finite("the end of the guessed plan", &x)
    }

    /// The end after the correction with the change δν of the multipliers of the target, whatever bounds allow.
    pub fn end_without_bounds(&self, change: &SVector<T, D>) -> Result<PlanEnd<T, D>, Error> {
        let problem = &self.problem;
        let system = problem.system;
        let start_change = B::change(&self.correction, change);
        let mut x = start_change.map_or(self.origin(), |by| system.moved(&self.origin(), &by));
        for (index, stage) in self.stages.iter().enumerate() {
            let displaced = system.displacement(&stage.place, &x);
            let input = stage.input + stage.shift + stage.by_multiplier * change + stage.gain * displaced;
            x = problem.follow(stage, problem.time_after(index), &x, &input)?;
        }
        let end = problem.end(&x, T::zero(), &self.pushing);
        check_finite("the target at the end of the plan", &end.distance)?;
        Ok(end)
    }

    /// Proposes the plan after `fraction` of the correction with the change δν of the multipliers of the target.
    fn roll_out(
        &mut self,
        descent: &Descent<'_, T, D, U>,
        fraction: T,
        change: &SVector<T, D>,
    ) -> Result<Rolled<S::Place, T>, Error> {
        let problem = &self.problem;
        let Problem { system, constants, .. } = *problem;
        let near = T::from_ratio(NEAR.0, NEAR.1);
        let (strictness, is_near) = (descent.settings.strictness, descent.end.distance <= near * descent.end.scale);
        // φ₀ + Σℓ + φ
        let mut slacks = Proposed::none();
        let start_change = B::change(&self.correction, change);
        let mut x = start_change.map_or(self.origin(), |by| system.moved(&self.origin(), &(by * fraction)));
        let mut price = problem.beginning.price(system, &x);
        for (index, stage) in self.stages.iter_mut().enumerate() {
            let t = self.problem.time_after(index);
            let mut input = stage.input + (stage.shift + stage.by_multiplier * change) * fraction;
            if index > 0 || start_change.is_some() {
                input += stage.gain * system.displacement(&stage.place, &x);
            }
            if C > 0 {
                let bounds = problem.bounds(stage, t, &x, &input)?;
                stage.limits.propose(&bounds, (fraction, strictness, is_near), |i| S::BOUNDS[i], &mut slacks)?;
            }
            price += problem.price(stage, t, &x, &input)?;
            (stage.next_place, stage.next_input) = (x, input);
            x = problem.follow(stage, t, &x, &input)?;
        }
        price += system.endpoint(constants, problem.end_time(), &x);
        let end = problem.end(&x, T::zero(), &self.pushing);
        let penalties = descent.penalty(change, &end) - descent.penalty(change, descent.end);
        let barriers = strictness.barrier * slacks.logarithms + fraction * slacks.excess_price;
        let difference = price - descent.summary.price - barriers + penalties + slacks.dearer;
        Ok(Rolled { last: x, distance: end.distance, difference, allowed: slacks.allowed })
    }
}
