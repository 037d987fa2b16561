//! Newton's method on a plan, and what is done where it does not contract.

use super::Stage;
use super::attempt::Approach;
use super::barrier::Barrier;
use super::end::PlanEnd;
use super::iterate::{Iterate, ROUNDS, Use, Verdict, index};
use super::search::{Descent, Evidence};
use super::sweep::{PlanSummary, Problem, Settings};
use crate::newton::{Curvature, Equilibrated};
use crate::space::larger;
use crate::{Controlled, Error, Real, Scalar, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// Backward sweeps of which one attempt may make use.
const SWEEPS: u32 = 400;
/// Damping beyond which no step goes downhill but for round-off.
const DAMPING_LIMIT: f64 = 1e9;
/// Patterns that are added to inputs where no first derivative leads to the target.
const STIRS: u32 = 3;
/// Steps in a row that may be next to nothing.
const STALLS: u32 = 8;

/// A plan on which the price is critical.
pub(super) struct CriticalPlan<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> {
    pub summary: PlanSummary<S::Scalar, D, U>,
    pub last: S::Place,
    pub end: PlanEnd<S::Scalar, D>,
    pub negative: usize,
    pub sweeps: u32,
}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Problem<'_, S, D, U, C> {
    /// The critical plan near the guess, a minimum where one is found, after at most [`SWEEPS`] more sweeps.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::Uncontrollable`], [`Error::Infeasible`], [`Error::TargetMissed`], [`Error::NoExtremal`].
    pub fn newton(
        &self,
        plan: &mut [Stage<S, D, U, C>],
        approach: Approach,
        sweeps: &mut u32,
    ) -> Result<CriticalPlan<S, D, U, C>, Error> {
        let (zero, one) = (S::Scalar::zero(), S::Scalar::one());
        let bounds = S::Scalar::from_f64((plan.len() * C) as f64);
        let unit = unit(plan.len(), C);
        let mut now = self.start_from(plan)?;
        now.is_open |= approach == Approach::Price;
        let (mut size, mut stirs) = (zero, 0);
        for _ in 0..SWEEPS {
            *sweeps += 1;
            let end = self.end(plan, &now.last);
            let summary = self.eliminate(plan, &now.last, &end, &now.settings)?;
            let gramian = Equilibrated::of(&summary.gramian);
            let descent = Descent::of(&summary, &end, &gramian, &now.settings);
            let (change, decrement) = descent.correction(one);
            if !summary.price.is_finite() {
                return Err(Error::NotFinite { name: "the price of the plan" });
            }
            let stiffer = gramian.weight(&summary.gramian, &now.settings.weight);
            let made_of_it = now.judge(&summary, &gramian, &stiffer);
            if made_of_it == Use::Nothing {
                continue;
            }
            if !decrement.is_finite() {
                return Err(self.failure(plan, &end, size, *sweeps));
            }
            let magnitude = now.magnitude(&summary, decrement);
            if made_of_it == Use::Escape {
                now.leave_saddle(self.escape(plan, &descent, &summary, magnitude));
                continue;
            }
            if now.is_open {
                let price = larger(summary.magnitude + decrement, summary.repair());
                self.open(plan, &mut now, approach, &stiffer, price);
                continue;
            }
            size = if decrement == zero { zero } else { (decrement.abs() / magnitude).sqrt() };
            match now.verdict(&end, size, unit, Barrier::last(bounds, magnitude).weight) {
                Verdict::Done | Verdict::Tighten if now.may_be_at_saddle(summary.negative, size) => continue,
                // Nothing pushes, but bounds are not kept yet.
                Verdict::Done if self.is_violated(plan, now.relaxation) => {}
                Verdict::Done => {
                    self.settle(plan, &change, now.settings.barrier)?;
                    // Where inputs need no correction, the multipliers may.
                    now.settings.multipliers += change;
                    return self.finish(plan, now, *sweeps);
                }
                Verdict::Tighten => {
                    now.tighten(bounds, magnitude);
                    continue;
                }
                Verdict::Price if self.is_relaxed(plan) => {}
                Verdict::Price if end.distance <= S::Scalar::from_ratio(1, 100) * end.scale => {
                    let slope = self.system.endpoint_expanded(self.time_after(plan.len()), &now.last).slope;
                    let force = self.goal.multipliers(&end, &(summary.costate - slope));
                    now.close_gap(force, &end, S::MOTIONS);
                    continue;
                }
                Verdict::Price if now.rounds < ROUNDS => {
                    now.raise_price();
                    continue;
                }
                Verdict::Price => return Err(self.failure(plan, &end, size, *sweeps)),
                Verdict::Stir if stirs == STIRS => {
                    return Err(Error::Uncontrollable { distance: end.distance.to_f64() });
                }
                Verdict::Stir => {
                    stirs += 1;
                    self.stir(plan, &summary, end.lack.max_abs(), stirs);
                    now = self.start_from(plan)?;
                    continue;
                }
                Verdict::Correct => {}
            }
            let is_trusted = now.is_exact() && size * size <= S::Scalar::EPSILON.sqrt();
            let evidence = Evidence { magnitude, is_trusted, nearest: now.nearest, is_relaxed: self.is_relaxed(plan) };
            let made = self.descend(plan, &descent, &evidence);
            let is_whole = made.as_ref().is_some_and(|made| made.fraction >= S::Scalar::from_ratio(9, 10));
            now.advance(made, size, summary.negative, stiffer, end.distance);
            if now.stalls == STALLS || now.damping > S::Scalar::from_f64(DAMPING_LIMIT) {
                return Err(self.failure(plan, &end, size, *sweeps));
            }
            let is_central = decrement <= S::Scalar::from_f64(10.0) * now.settings.barrier.weight * bounds;
            if C > 0 && is_whole && is_central && !now.is_priced() {
                now.tighten(bounds, magnitude);
            }
        }
        let end = self.end(plan, &now.last);
        Err(self.failure(plan, &end, size, *sweeps))
    }

    /// Begins with bounds, or with a price of the gap, after the first sweep, which was made without and told the size of prices.
    fn open(
        &self,
        plan: &mut [Stage<S, D, U, C>],
        now: &mut Iterate<S::Place, S::Scalar, D>,
        approach: Approach,
        stiffer: &SMatrix<S::Scalar, D, D>,
        price: S::Scalar,
    ) {
        now.is_open = false;
        now.settings.weight = *stiffer;
        if C > 0 {
            // Where neither plans nor what keeps bounds have a price, any is as good.
            let is_free = price <= S::Scalar::zero() && self.is_violated(plan, now.relaxation);
            let price = if is_free { S::Scalar::one() } else { price };
            now.expect(price);
            now.settings.barrier = Barrier::first(S::Scalar::from_f64((plan.len() * C) as f64), price);
            self.begin(plan, now.settings.barrier);
        }
        if approach == Approach::Price {
            now.price_gap(stiffer, S::MOTIONS);
        }
    }

    /// The plan that the inputs make, with the multipliers that the stages hold.
    fn start_from(&self, plan: &mut [Stage<S, D, U, C>]) -> Result<Iterate<S::Place, S::Scalar, D>, Error> {
        let last = self.follow(plan)?;
        let end = self.end(plan, &last);
        let slope = self.system.endpoint_expanded(self.time_after(plan.len()), &last).slope;
        let multipliers = match plan.last().map(|stage| stage.next_costate) {
            Some(costate) if costate.is_finite() && costate.max_abs() > S::Scalar::zero() => {
                self.goal.multipliers(&end, &(costate - slope))
            }
            _ => SVector::from_element(S::Scalar::zero()),
        };
        let barrier = if C > 0 { self.resume(plan) } else { Some(Barrier::none()) };
        if barrier.is_none() {
            self.relax(plan);
            self.begin(plan, Barrier::none());
        }
        Ok(Iterate::new(last, multipliers, barrier, end.distance))
    }

    /// The end of a plan; round-off of its gap is relative to the largest place.
    fn end(&self, plan: &[Stage<S, D, U, C>], last: &S::Place) -> PlanEnd<S::Scalar, D> {
        let end = self.goal.end(self.system, last);
        PlanEnd { scale: plan.iter().fold(end.scale, |max, stage| larger(max, stage.place.max_abs())), ..end }
    }

    /// The last sweep: exact second derivatives as they are, for gains and the index.
    fn finish(
        &self,
        plan: &mut [Stage<S, D, U, C>],
        now: Iterate<S::Place, S::Scalar, D>,
        sweeps: u32,
    ) -> Result<CriticalPlan<S, D, U, C>, Error> {
        let end = self.end(plan, &now.last);
        let settings = Settings { curvature: Curvature::exact(S::Scalar::zero()), is_last: true, ..now.settings };
        // The weight of the target belongs to the search: costates are those of the multipliers alone.
        let closed = PlanEnd { lack: SVector::from_element(S::Scalar::zero()), ..end };
        let summary = self.eliminate(plan, &now.last, &closed, &settings)?;
        let negative = index(summary.negative, now.rank, &Equilibrated::of(&summary.gramian));
        Ok(CriticalPlan { summary, last: now.last, end, negative, sweeps })
    }

    /// Why nothing was found.
    #[cold]
    fn failure(&self, plan: &[Stage<S, D, U, C>], end: &PlanEnd<S::Scalar, D>, size: S::Scalar, sweeps: u32) -> Error {
        match self.worst_bound(plan) {
            Some((stage, bound, violation)) => {
                Error::Infeasible { bound: S::BOUNDS[bound], stage, violation: violation.to_f64() }
            }
            None if !end.is_reached() => Error::TargetMissed { distance: end.distance.to_f64(), iterations: sweeps },
            None => Error::NoExtremal { correction: size.to_f64(), iterations: sweeps },
        }
    }
}

/// The size of a correction that is round-off. Slacks of active bounds have few digits.
fn unit<T: Real>(steps: usize, bounds: usize) -> T {
    if bounds > 0 {
        T::EPSILON.powf(T::from_ratio(3, 5))
    } else {
        T::from_f64(4.0) * T::EPSILON * T::from_f64(steps as f64).sqrt()
    }
}
