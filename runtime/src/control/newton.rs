//! Newton's method on a plan, and what is done where it does not contract.

use super::Stage;
use super::barrier::Barrier;
use super::end::End;
use super::gramian::Gramian;
use super::pivot::Curvature;
use super::search::Descent;
use super::sweep::{Problem, Settings, Summary};
use crate::space::larger;
use crate::{Controlled, Error, Scalar, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// Backward sweeps of which one solution may make use.
const SWEEPS: u32 = 500;
/// Damping beyond which no step goes downhill but for round-off.
const DAMPING_LIMIT: f64 = 1e9;
/// Patterns that are added to inputs where no first derivative leads to the target.
const STIRS: u32 = 3;
/// Directions that may lack curvature, as those of a symmetry do, while the curvature of steps is counted in full.
const FLAT: usize = 2;
/// Steps in a row that are next to nothing.
const STALLS: u32 = 12;

/// A plan on which the price is critical.
pub(super) struct Solved<S: Controlled<D, U, C>, const D: usize, const U: usize, const C: usize> {
    pub summary: Summary<S::Scalar, D, U>,
    pub last: S::Place,
    pub end: End<S::Scalar, D>,
    pub negative: usize,
    pub sweeps: u32,
}

/// What is known between sweeps.
struct Iterate<X, T, const D: usize> {
    last: X,
    /// ν and R of the target.
    multipliers: SVector<T, D>,
    weight: SMatrix<T, D, D>,
    barrier: Barrier<T>,
    /// Whether the first barrier is still to be chosen.
    is_open: bool,
    curvature: Curvature<T>,
    bend: T,
    damping: T,
    /// Whether it is known that more weight of the target makes no curvature positive.
    is_probed: bool,
    /// The number of directions that inputs move the end in.
    rank: usize,
    before: Option<T>,
    largest: T,
    nearest: T,
    stirs: u32,
    stalls: u32,
    stagnations: u32,
}

impl<S: Controlled<D, U, C>, const D: usize, const U: usize, const C: usize> Problem<'_, S, D, U, C> {
    fn begin_iterate(&self, plan: &mut [Stage<S, D, U, C>]) -> Result<Iterate<S::Place, S::Scalar, D>, Error> {
        let zero = S::Scalar::zero();
        let last = self.follow(plan)?;
        let end = self.goal.end(self.system, &last);
        let slope = self.system.endpoint_expanded(self.time_after(plan.len()), &last).slope;
        let costate = plan.last().map_or(slope, |stage| stage.next_costate);
        let is_guess = costate.is_finite() && costate.max_abs() > zero;
        let multipliers =
            if is_guess { self.goal.multipliers(&end, &(costate - slope)) } else { SVector::from_element(zero) };
        let resumed = if C > 0 { self.resume(plan) } else { Some(Barrier::none()) };
        if resumed.is_none() {
            self.relax(plan);
            self.begin(plan, Barrier::none());
        }
        Ok(Iterate {
            last,
            multipliers,
            weight: SMatrix::from_element(zero),
            barrier: resumed.unwrap_or(Barrier::none()),
            is_open: resumed.is_none(),
            curvature: Curvature::Mirrored { damping: zero },
            bend: S::Scalar::one(),
            damping: zero,
            is_probed: false,
            rank: D,
            before: None,
            largest: zero,
            nearest: end.distance,
            stirs: 0,
            stalls: 0,
            stagnations: 0,
        })
    }

    /// The critical plan near the guess, a minimum where one is found.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::Uncontrollable`], [`Error::Infeasible`], [`Error::TargetMissed`], [`Error::NoExtremal`].
    pub fn newton(&self, plan: &mut [Stage<S, D, U, C>]) -> Result<Solved<S, D, U, C>, Error> {
        let (zero, one) = (S::Scalar::zero(), S::Scalar::one());
        let bounds = S::Scalar::from_f64((plan.len() * C) as f64);
        let root = S::Scalar::EPSILON.sqrt();
        let unit = S::Scalar::from_f64(4.0) * S::Scalar::EPSILON * S::Scalar::from_f64(plan.len() as f64).sqrt();
        let mut now = self.begin_iterate(plan)?;
        let mut size = zero;
        for sweeps in 1..=SWEEPS {
            let end = self.goal.end(self.system, &now.last);
            let settings = Settings {
                multipliers: &now.multipliers,
                weight: &now.weight,
                barrier: now.barrier,
                curvature: now.curvature,
                bend: now.bend,
                is_last: false,
            };
            let summary = self.eliminate(plan, &now.last, &end, &settings)?;
            let gramian = Gramian::of(&summary.gramian);
            let change = gramian.inverse() * summary.lack;
            let decrement = summary.decrement(&end, &change);
            if !(summary.price.is_finite() && decrement.is_finite()) {
                return Err(Error::NotFinite { name: "the price of the plan" });
            }
            let stiffer = gramian.weight(&summary.gramian, &now.weight);
            let Curvature::Mirrored { damping } = now.curvature else {
                // This sweep told whether positive curvature is only a matter of the weight of the target.
                if index(summary.negative, now.rank, &gramian) == 0 {
                    now.weight = stiffer;
                } else if summary.negative > FLAT {
                    now.bend = less(now.bend);
                }
                (now.curvature, now.is_probed) = (Curvature::Mirrored { damping: now.damping }, true);
                continue;
            };
            now.rank = gramian.rank();
            let size_now = (decrement.abs()
                / (summary.magnitude + root * larger(now.largest, summary.magnitude + decrement.abs())))
            .sqrt();
            if summary.negative > 0 && !now.is_probed && (now.bend >= one || now.bend == zero) {
                now.curvature = Curvature::Kept;
                continue;
            }
            if summary.negative > FLAT && now.bend > zero {
                (now.bend, now.is_probed) = (less(now.bend), false);
                continue;
            }
            now.largest = larger(now.largest, summary.magnitude + decrement.abs());
            if now.is_open {
                // The first sweep, without bounds, told the size of the price.
                now.is_open = false;
                now.barrier = Barrier::first(bounds, now.largest);
                self.begin(plan, now.barrier);
                now.weight = stiffer;
                continue;
            }
            let magnitude = summary.magnitude + root * now.largest;
            size = if decrement == zero { zero } else { size_now };
            let is_exact = damping == zero && now.bend >= one;
            let eighth = S::Scalar::from_ratio(1, 8);
            let stagnates = matches!(now.before, Some(before) if before <= root && size > before * eighth);
            now.stagnations = if stagnates { now.stagnations + 1 } else { 0 };
            let is_closed = end.is_closed() || now.stagnations > 2;
            let converged = is_exact && (size <= unit || size <= root && stagnates) && (is_closed || !end.is_reached());
            if converged && !end.is_reached() {
                if now.stirs == STIRS {
                    return Err(Error::Uncontrollable { distance: end.distance.to_f64() });
                }
                now.stirs += 1;
                self.stir(plan, &summary, end.lack.max_abs(), now.stirs);
                now = Iterate { stirs: now.stirs, ..self.begin_iterate(plan)? };
                continue;
            }
            if converged
                && C > 0
                && now.barrier.weight > S::Scalar::from_f64(2.0) * Barrier::last(bounds, magnitude).weight
            {
                now.barrier = now.barrier.next(bounds, now.largest);
                now.before = None;
                continue;
            }
            if converged {
                return self.finish(plan, now, sweeps);
            }
            let descent = Descent {
                end: &end,
                settings: &settings,
                change,
                price: summary.price,
                decrement,
                magnitude: now.largest,
                is_trusted: is_exact && size * size <= root,
                nearest: now.nearest,
                is_relaxed: self.worst_bound(plan).is_some(),
            };
            let made = self.descend(plan, &descent);
            let fraction = made.as_ref().map_or(zero, |made| made.fraction);
            let refused = made.as_ref().map_or(usize::MAX, |made| made.refused);
            if let Some(made) = made {
                now.last = made.last;
            }
            now.multipliers += change * fraction;
            if size > S::Scalar::from_ratio(1, 100) || now.weight.max_abs() == zero {
                now.weight = stiffer;
            }
            now.damping = adapted(now.damping, refused);
            now.curvature = Curvature::Mirrored { damping: now.damping };
            if refused <= 1 {
                now.bend = if size > S::Scalar::from_ratio(1, 100) { more(now.bend) } else { one };
            }
            now.is_probed &= summary.negative > 0 && now.bend >= one;
            now.nearest = if end.distance < now.nearest { end.distance } else { now.nearest };
            now.before = Some(size);
            now.stalls = if fraction < S::Scalar::from_f64(1e-6) { now.stalls + 1 } else { 0 };
            if now.stalls == STALLS || now.damping > S::Scalar::from_f64(DAMPING_LIMIT) {
                return Err(self.failure(plan, &end, size, sweeps));
            }
            let near = decrement <= S::Scalar::from_f64(10.0) * now.barrier.weight * bounds;
            if C > 0 && near && fraction >= S::Scalar::from_ratio(9, 10) {
                let next = now.barrier.next(bounds, now.largest);
                if next.weight < now.barrier.weight {
                    now.barrier = next;
                    now.before = None;
                }
            }
        }
        let end = self.goal.end(self.system, &now.last);
        Err(self.failure(plan, &end, size, SWEEPS))
    }

    /// The last sweep: exact second derivatives as they are, for gains and the index.
    fn finish(
        &self,
        plan: &mut [Stage<S, D, U, C>],
        now: Iterate<S::Place, S::Scalar, D>,
        sweeps: u32,
    ) -> Result<Solved<S, D, U, C>, Error> {
        let end = self.goal.end(self.system, &now.last);
        let settings = Settings {
            multipliers: &now.multipliers,
            weight: &now.weight,
            barrier: now.barrier,
            curvature: Curvature::Kept,
            bend: S::Scalar::one(),
            is_last: true,
        };
        let summary = self.eliminate(plan, &now.last, &end, &settings)?;
        let negative = index(summary.negative, now.rank, &Gramian::of(&summary.gramian));
        if C > 0 {
            self.begin(plan, now.barrier);
        }
        Ok(Solved { summary, last: now.last, end, negative, sweeps })
    }

    /// Why nothing was found.
    #[cold]
    fn failure(&self, plan: &[Stage<S, D, U, C>], end: &End<S::Scalar, D>, size: S::Scalar, sweeps: u32) -> Error {
        match self.worst_bound(plan) {
            Some((stage, bound, violation)) => {
                Error::Infeasible { bound: S::BOUNDS[bound], stage, violation: violation.to_f64() }
            }
            None if !end.is_reached() => Error::TargetMissed { distance: end.distance.to_f64(), iterations: sweeps },
            None => Error::NoExtremal { correction: size.to_f64(), iterations: sweeps },
        }
    }
}

/// The damping after a step: eight times less after one that was taken at once, eight times more after one that was refused often.
fn adapted<T: Scalar>(damping: T, refused: usize) -> T {
    let (least, factor) = (T::from_f64(1e-3), T::from_f64(8.0));
    if refused == 0 {
        if damping > least { damping / factor } else { T::zero() }
    } else if refused > 2 {
        larger(damping, least) * factor
    } else {
        damping
    }
}

/// The part of the curvature of steps that is counted where more of it is not positive.
fn less<T: Scalar>(bend: T) -> T {
    if bend > T::from_ratio(1, 10) { bend * T::from_ratio(1, 4) } else { T::zero() }
}

/// The part of the curvature of steps that is counted after one that was good.
fn more<T: Scalar>(bend: T) -> T {
    let next = larger(bend * T::from_f64(4.0), T::from_ratio(1, 16));
    if next < T::one() { next } else { T::one() }
}

/// The number of negative eigenvalues of the Hessian on plans that keep the target, by Sylvester's law of inertia: those of all Q_uu and of −Γ,
/// less the number of conditions.
fn index<T: Scalar, const D: usize>(negative: usize, rank: usize, gramian: &Gramian<T, D>) -> usize {
    (negative + gramian.positive()).saturating_sub(rank)
}
