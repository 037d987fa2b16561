//! Bounds by a primal-dual interior point method: a + s = excess with slacks s > 0 that cost −μ ln s each.
//!
//! If a guess violates bounds, they are relaxed by the excess. A step of fraction α shrinks the excess exactly by 1 −
//! α. So slacks are s = excess − a, for bounds of any form. Steps keep a two-hundredth of each slack, or less of
//! one that is reached.
//!
//! Equations among the bounds have an augmented Lagrangian in place of slacks: see `slacks`.
//!
//! A bound a = −∞ is none, as from an infinite parameter. Its slack is infinite, it has no multiplier and does not
//! count.
//!
//! Sources: Wächter and Biegler, *On the implementation of an interior-point filter line-search algorithm* (2006), for
//! multipliers and the sequence of μ. Pavlov, Shames and Manzie, *Interior point differential dynamic programming*
//! (2021), for slacks in roll-outs.

use super::Stage;
use super::iterate::Iterate;
use super::quadratic::Slopes;
use super::slacks::{Condensed, Kind, Strictness, Values, is_none};
use super::start::Start;
use super::sweep::{Plan, Problem, Settings};
use crate::space::larger;
use crate::{BoundsExpansion, Controlled, Error, Expansion, Real, Space};
use nalgebra::{SMatrix, SVector};

/// The first μ, for all bounds together, relative to the price. The price is that of the plan, or the price of
/// satisfying the bounds that it violates if that is larger. A guess that costs nothing would have no barrier by its
/// own price, and nothing would push it back.
pub(super) const FIRST: f64 = 0.1;
/// The last μ: this power of ε.
const LAST: (i64, i64) = (3, 4);

/// If the guess violates or reaches a bound, this part of its size relaxes it.
const PART: (i64, i64) = (1, 100);
/// The same for a bound that is 0 in all stages, as a part of its first change. Corrections without bounds go further
/// than those within.
const PART_OF_CHANGE: (i64, i64) = (1, 10);

/// ρ̂ of equations at first: a violation by their size in all steps costs as much as the plan does, and more. Stiffer ones do not let a car
/// slide sideways on its way to a plan, so that it winds.
const FIRST_RIGID: f64 = 3.0;
/// The growth of ρ̂ with each correction that is made in full.
pub(super) const HARDER: f64 = 30.0;
/// ρ̂ at last: rounding of a, times ρ, is less than √ε of a multiplier. It is 10⁷ in double precision.
const RIGID: (i64, i64) = (9, 20);
/// ρ̂ where multipliers creep: 10¹¹ in double precision.
const MOST_RIGID: (i64, i64) = (7, 10);

/// Units in the last place of the terms of an equation that are round-off of inputs and places.
const EQUAL: f64 = 1024.0;

/// ρ̂ at last, and where multipliers creep.
pub(super) fn rigidities<T: Real>() -> [T; 2] {
    [RIGID, MOST_RIGID].map(|(numerator, denominator)| T::EPSILON.powf(-T::from_ratio(numerator, denominator)))
}

/// The last μ, for so many bounds and a price of this size.
pub(super) fn last<T: Real>(bounds: T, price: T) -> T {
    T::EPSILON.powf(T::from_ratio(LAST.0, LAST.1)) * price / bounds
}

/// The next μ: μ̂ ↦ min(μ̂/5, μ̂^(3/2)) relative to the price.
pub(super) fn next<T: Real>(barrier: T, bounds: T, price: T) -> T {
    let relative = barrier * bounds / price;
    let fifth = relative * T::from_ratio(1, 5);
    let power = relative * relative.sqrt();
    larger((if power < fifth { power } else { fifth }) * price / bounds, last(bounds, price))
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize> Stage<S, D, U, C> {
    /// Adds ζ·a + ½ Σ (aδ)² with the curvature of z·a to the model of the step; in the last sweep z·a. Returns Σ a/s of violated bounds, and its slopes.
    #[inline]
    pub(super) fn add_bounds(
        &self,
        step: &mut Expansion<S::Place, T, D, U>,
        bounds: &mut BoundsExpansion<T, D, U, C>,
        settings: &Settings<T, D>,
    ) -> (T, Slopes<T, D, U>) {
        let limits = &self.limits;
        limits.clear_absent(&mut bounds.by_place);
        limits.clear_absent(&mut bounds.by_input);
        let Condensed { force, stiffness } = limits.condensed(settings.strictness);
        let force = if settings.is_last { limits.multipliers } else { force };
        let by_place = SMatrix::<T, C, D>::from_fn(|i, j| stiffness[i] * bounds.by_place[(i, j)]);
        let by_input = SMatrix::<T, C, U>::from_fn(|i, j| stiffness[i] * bounds.by_input[(i, j)]);
        step.price_by_place += bounds.by_place.tr_mul(&force);
        step.price_by_input += bounds.by_input.tr_mul(&force);
        step.place_curvature += bounds.place_curvature + bounds.by_place.tr_mul(&by_place);
        step.mixed_curvature += bounds.mixed_curvature + bounds.by_input.tr_mul(&by_place);
        step.input_curvature += bounds.input_curvature + bounds.by_input.tr_mul(&by_input);
        let (sum, weights) = limits.violated();
        (sum, (bounds.by_place.tr_mul(&weights), bounds.by_input.tr_mul(&weights)))
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, B: Start<S, D, U, C>, const D: usize, const U: usize, const C: usize>
    Plan<'_, S, B, D, U, C>
{
    /// The barrier of a plan that has multipliers and satisfies its bounds: the mean of z·s. Its equations are as stiff as they get.
    /// Otherwise `None`, and bounds are relaxed.
    ///
    /// The least slack is a hundredth of the size of the bound, the largest |a|. A bound that is 0 in all stages has no
    /// size yet. [`size`](Self::size) finds it.
    pub fn resume_or_relax(&mut self) -> Result<Option<Strictness<T>>, Error> {
        let zero = T::zero();
        let mut bounds: usize = 0;
        for (index, stage) in self.stages.iter_mut().enumerate() {
            let t = self.problem.time_after(index);
            let values = self.problem.bounds(stage, t, &stage.place, &stage.input)?;
            let prices = self.problem.bound_prices(stage, t);
            let (names, equations) = (S::BOUNDS, S::EQUAL_BOUNDS);
            bounds += stage.limits.take_values(Values { values, prices, names, equations })?;
        }
        self.bounds = T::from_f64(bounds as f64);
        self.has_equations = S::EQUAL_BOUNDS > 0;
        self.except_start()?;
        if !self.is_bounded() {
            return Ok(Some(Strictness::none()));
        }
        let sum = self.stages.iter().fold(zero, |sum, stage| sum + stage.limits.complementarity());
        // none is left where all kinks are reached
        let is_inside = bounds == 0 || sum > zero;
        if is_inside && self.stages.iter().all(|stage| stage.limits.is_warm()) {
            let barrier = if bounds == 0 { zero } else { sum / self.bounds };
            let [rigid, _] = rigidities::<T>();
            let rigidity = if self.has_equations { rigid } else { zero };
            return Ok(Some(Strictness { barrier, rigidity, price: self.price_of_step()? }));
        }
        let sizes = self.sizes();
        self.relax(|i| Some(if sizes[i] > zero { sizes[i] * T::from_ratio(PART.0, PART.1) } else { T::one() }));
        self.stages.iter_mut().for_each(|stage| stage.limits.size_equations(|i| sizes[i]));
        self.begin(zero);
        Ok(None)
    }

    /// Equations of a given start that no input moves are none: it is where it is.
    fn except_start(&mut self) -> Result<(), Error> {
        let is_given = B::change(&B::none(), &SVector::from_element(T::zero())).is_none();
        let Some(stage) = self.stages.first_mut().filter(|_| self.has_equations && is_given) else { return Ok(()) };
        let zeros = SVector::from_element(T::zero());
        let bounds = self.problem.bounds_expanded(stage, self.problem.time_after(0), &zeros)?;
        for i in 0..C {
            if bounds.by_input.row(i).iter().all(|slope| *slope == T::zero()) {
                stage.limits.except(i);
            }
        }
        Ok(())
    }

    /// (|φ₀| + Σ|ℓ| + |φ|)/N where equations need it, or 1 where a plan has no price.
    fn price_of_step(&self) -> Result<T, Error> {
        if !self.has_equations {
            return Ok(T::one());
        }
        let Problem { system, constants, beginning, .. } = &self.problem;
        let end = system.endpoint(constants, self.problem.end_time(), &self.last);
        let mut price = end.abs() + beginning.price(system, &self.origin()).abs();
        for (index, stage) in self.stages.iter().enumerate() {
            price += self.problem.price(stage, self.problem.time_after(index), &stage.place, &stage.input)?.abs();
        }
        Ok(if price > T::zero() { price / self.steps() } else { T::one() })
    }

    /// The number of steps.
    pub fn steps(&self) -> T {
        T::from_f64(self.stages.len() as f64)
    }

    /// The first barrier and the first stiffness of equations, for a plan of this price, with multipliers. The barrier is wider by a factor.
    pub fn begin_bounds(&mut self, now: &mut Iterate<T, D>, price: T, wider: f64) {
        if self.bounds > T::zero() {
            now.settings.strictness.barrier = T::from_f64(wider * FIRST) * price / self.bounds;
        }
        if self.has_equations {
            let strictness = &mut now.settings.strictness;
            (strictness.rigidity, strictness.price) = (T::from_f64(FIRST_RIGID), price / self.steps());
        }
        self.begin(now.settings.strictness.barrier);
    }

    /// The largest |a| of each bound, in all stages.
    fn sizes(&self) -> SVector<T, C> {
        let size = |size: T, value: T| if value.is_finite() { larger(size, value.abs()) } else { size };
        let of_stage = |sizes: SVector<T, C>, stage: &Stage<S, D, U, C>| sizes.zip_map(&stage.limits.values(), size);
        self.stages.iter().fold(SVector::from_element(T::zero()), of_stage)
    }

    /// Relaxes bounds that have a least slack to it, each in all stages.
    fn relax(&mut self, least: impl Fn(usize) -> Option<T>) {
        self.stages.iter_mut().for_each(|stage| stage.limits.relax(&least));
    }

    /// Relaxes the bounds that are 0 in all stages, each by a part of its first change, by a correction without bounds. If nothing changes
    /// it, the smallest size of the others takes the place of that. Too small a slack shortens steps, and too large a slack switches the
    /// bound off.
    ///
    /// The size of an equation is the largest |a|, or its first change where that is larger.
    #[cold]
    pub fn size(&mut self, change: &SVector<T, D>) -> Result<(), Error> {
        let zero = T::zero();
        let sizes = self.sizes();
        if !self.has_equations && sizes.iter().all(|size| *size > zero) {
            return Ok(());
        }
        let mut moved = SVector::<T, C>::from_element(zero);
        self.follow_correction(change, |stage, by, most| {
            moved = SVector::from_fn(|i, _| {
                let by = stage.limits.size_of_motion(i, by[i], most[i]);
                if by.is_finite() && !is_none(stage.limits.slack[i]) { larger(moved[i], by) } else { moved[i] }
            });
        })?;
        self.size_by(&sizes, &moved);
        Ok(())
    }

    /// The same without a first change.
    #[cold]
    pub fn size_by_others(&mut self) {
        self.size_by(&self.sizes(), &SVector::zeros());
    }

    fn size_by(&mut self, sizes: &SVector<T, C>, moved: &SVector<T, C>) {
        let zero = T::zero();
        let known = sizes.iter().chain(moved.iter()).copied().filter(|size| *size > zero);
        let least = known.reduce(|least, size| if size < least { size } else { least });
        let part = |size: T, (numerator, denominator)| size * T::from_ratio(numerator, denominator);
        self.relax(|i| match (sizes[i] > zero, moved[i] > zero) {
            (true, _) => None,
            (_, true) => Some(part(moved[i], PART_OF_CHANGE)),
            _ => least.map(|least| part(least, PART)),
        });
        let size = |i: usize| larger(sizes[i], moved[i]);
        let known = |size: T| if size > zero { size } else { least.unwrap_or(T::one()) };
        self.stages.iter_mut().for_each(|stage| stage.limits.size_equations(|i| known(size(i))));
    }

    /// Multipliers μ/s for the slacks.
    pub fn begin(&mut self, barrier: T) {
        self.stages.iter_mut().for_each(|stage| stage.limits.begin(barrier));
    }

    /// Takes the plan that a roll-out with this fraction of the correction proposes, which leads to `last`. Multipliers stay positive, near μ/s.
    pub fn accept(&mut self, fraction: T, barrier: T, last: S::Place) {
        self.stages.iter_mut().for_each(|stage| stage.limits.accept(fraction, barrier));
        self.arrive_at(last);
    }

    /// Takes places and inputs of a proposed plan that leads to `last`, with the multipliers that the stages hold.
    pub fn arrive_at(&mut self, last: S::Place) {
        for stage in self.stages.iter_mut() {
            (stage.place, stage.input) = (stage.next_place, stage.next_input);
        }
        self.last = last;
    }

    /// Multipliers of the bounds from the next correction.
    pub fn settle(&mut self, change: &SVector<T, D>, strictness: Strictness<T>) -> Result<(), Error> {
        self.follow_correction(change, |stage, moved, _| stage.limits.settle(&moved, strictness))
    }

    /// Multipliers of the equations after a fraction of the correction, from the plan before it.
    #[inline]
    pub fn equate(&mut self, change: &SVector<T, D>, fraction: T, strictness: Strictness<T>) -> Result<(), Error> {
        if !self.has_equations {
            return Ok(());
        }
        self.follow_correction(change, |stage, moved, _| stage.limits.equate(&moved, fraction, strictness))
    }

    /// Visits each stage with how far a full correction moves its bounds, to first order. With it comes how far a motion of that size moves
    /// them at most.
    fn follow_correction(
        &mut self,
        change: &SVector<T, D>,
        mut visit: impl FnMut(&mut Stage<S, D, U, C>, SVector<T, C>, SVector<T, C>),
    ) -> Result<(), Error> {
        let problem = &self.problem;
        let mut displacement = B::change(&self.correction, change).unwrap_or(SVector::from_element(T::zero()));
        for (index, stage) in self.stages.iter_mut().enumerate().filter(|_| C > 0) {
            let t = self.problem.time_after(index);
            let bounds = problem.bounds_expanded(stage, t, &stage.limits.multipliers)?;
            // places that are unknowns have their corrections
            let (displaced, input) = match self.is_lifted {
                true => (stage.motion, stage.shift),
                false => (displacement, stage.shift + stage.by_multiplier * change + stage.gain * displacement),
            };
            let (far, wide) = (displaced.component_mul(&problem.lengths).max_abs(), input.max_abs());
            let most = SVector::from_fn(|i, _| {
                let by_place = bounds.by_place.row(i).transpose().component_div(&problem.lengths);
                by_place.max_abs() * far + bounds.by_input.row(i).into_owned().max_abs() * wide
            });
            visit(stage, bounds.by_place * displaced + bounds.by_input * input, most);
            if !self.is_lifted {
                let step = problem.expand(stage, t, &stage.next_costate)?;
                displacement = step.by_place * displacement + step.by_input * input;
            }
        }
        Ok(())
    }

    /// The price that soft bounds come to by a correction without barriers.
    #[cold]
    pub fn price_of_kinks(&mut self, change: &SVector<T, D>) -> Result<T, Error> {
        let mut sum = T::zero();
        self.follow_correction(change, |stage, moved, _| sum += stage.limits.price_of_motion(&moved))?;
        Ok(sum)
    }

    /// Whether any bound is soft.
    pub fn has_kinks(&self) -> bool {
        self.stages.iter().any(|stage| stage.limits.has_kinks())
    }

    /// Σ w max(a, 0) of all stages.
    pub fn price_of_violations(&self) -> T {
        self.stages.iter().fold(T::zero(), |sum, stage| sum + stage.limits.price_of_violations())
    }

    /// Whether bounds are relaxed.
    pub fn is_relaxed(&self) -> bool {
        self.stages.iter().any(|stage| stage.limits.is_relaxed())
    }

    /// Whether a relaxed bound or an equation is violated by more than round-off of its own terms. These are |∂a/∂x| |x| and
    /// |∂a/∂u| |u| of the present plan, and for an equation the size of a.
    pub fn is_violated(&self) -> bool {
        let zero = T::zero();
        let [round_off, equal] = [16.0, EQUAL].map(|units| T::from_f64(units) * T::EPSILON);
        self.stages.iter().enumerate().any(|(index, stage)| {
            if !stage.limits.is_relaxed() && !stage.limits.has_equations() {
                return false;
            }
            let (t, x, u) = (self.problem.time_after(index), &stage.place, &stage.input);
            // bounds of a step that cannot be made are not satisfied
            let Ok(bounds) = self.problem.bounds_expanded(stage, t, &stage.limits.multipliers) else { return true };
            let sizes = self.problem.sizes(x);
            // Written so that NaN is a violation.
            !(0..C).all(|i| {
                let by_place = (0..D).fold(zero, |sum, j| sum + bounds.by_place[(i, j)].abs() * sizes[j]);
                let terms = (0..U).fold(by_place, |sum, j| sum + (bounds.by_input[(i, j)] * u[j]).abs());
                match stage.limits.kinds[i] {
                    Kind::Soft(_) => true,
                    Kind::Inequality => bounds.values[i] <= larger(zero, round_off * terms),
                    Kind::Equation(size) => bounds.values[i].abs() <= equal * larger(terms, size),
                }
            })
        })
    }

    /// The largest a of all bounds, 0 where none is violated by more than round-off.
    pub fn violation(&self) -> T {
        if !self.is_violated() {
            return T::zero();
        }
        self.stages.iter().enumerate().fold(T::zero(), |largest, (index, stage)| {
            let t = self.problem.time_after(index);
            let values = self.problem.bounds(stage, t, &stage.place, &stage.input);
            let hard = |values: SVector<T, C>| {
                (0..C).fold(largest, |largest, i| larger(largest, stage.limits.violation(i, values[i])))
            };
            values.map_or(largest, hard)
        })
    }

    /// The bound that keeps all from being relaxed less, with its stage, its name and its violation. Equations count that are violated by more than
    /// this part of their size.
    pub fn worst_bound(&self, least: Option<T>) -> Option<(usize, &'static str, T)> {
        let (mut most, mut worst) = (T::zero(), None);
        for (index, stage) in self.stages.iter().enumerate() {
            let t = self.problem.time_after(index);
            let Ok(values) = self.problem.bounds(stage, t, &stage.place, &stage.input) else { continue };
            for i in 0..C {
                let part = stage.limits.relative_violation(i, values[i], least);
                if part > most {
                    (most, worst) = (part, Some((index, S::BOUNDS[i], stage.limits.violation(i, values[i]))));
                }
            }
        }
        worst
    }
}
