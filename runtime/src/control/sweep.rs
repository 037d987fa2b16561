//! The backward sweep: the exact second derivatives of the price of a plan, eliminated from the end.
//!
//! Let V(δ, δν) be the least price of all later steps, with the multipliers ν of the target. A step then has this model.
//! ```text
//! Q(δ, δu) = ℓ + z·a + V(Aδ + Bδu) + ½ (δ, δu)·∂²(ℓ + z·a + p·f)(δ, δu),    δu = k + Kδ + Gδν = −Q_uu⁻¹ (Q_u + Q_ux δ + Q_uν δν)
//! P = Q_xx + Q_xu K,    p = Q_x + Q_xu k,    Ψ = Q_xν + Kᵀ Q_uν,    Γ = Σ Q_uνᵀ Q_uu⁻¹ Q_uν
//! ```
//! The equation Γ δν = V_ν closes the gap. The inertia of the problem is that of all Q_uu less that of Γ.
//!
//! Sources:
//! * Jacobson and Mayne, *Differential Dynamic Programming* (1970);
//! * for the multipliers of the target Bryson and Ho, *Applied Optimal Control* (1975), section 6.3;
//! * for the bounds Rao, Wright and Rawlings, *Application of interior-point methods to model predictive control* (1998).

use super::attempt::Amplitudes;
use super::end::{Gramian, PlanEnd, without_kinks};
use super::iterate::Iterate;
use super::lift::Gap;
use super::quadratic::{Bounded, Fall, Policy, Value};
use super::slacks::Strictness;
use super::start::Start;
use super::{Referenced, Stage, Target};
use crate::newton::{Curvature, Spectrum};
use crate::space::larger;
use crate::{BoundsExpansion, Controlled, Error, Expansion, Real, Scalar, Space};
use nalgebra::{SMatrix, SVector};

/// A problem of optimal control.
pub(super) struct Problem<'a, S: Controlled<D, U, C, Scalar: Real>, B, const D: usize, const U: usize, const C: usize> {
    pub system: &'a S,
    pub constants: &'a S::Constants,
    pub h: S::Scalar,
    /// The time of the start, and the number of steps.
    pub time: S::Scalar,
    pub steps: usize,
    /// The start, or its guess where it is unknown.
    pub start: &'a S::Place,
    pub beginning: &'a B,
    pub target: &'a Target<S::Place>,
    /// The lengths of changes of a place. A momentum is as long as the way that it moves the system in a few times
    /// of the plan. Where conditions are the target, it is as long as its number.
    pub lengths: SVector<S::Scalar, D>,
}

/// Whether a search ends where the first correction whose model reaches the target leads astray.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Way {
    /// It goes on.
    Kept,
    /// It will end there.
    Open,
    /// It has ended there, for multiple shooting to go on from inputs that vary by these amplitudes.
    Given(Amplitudes),
}

/// A plan, on the way from a guess to one of least price.
pub(super) struct Plan<
    'a,
    S: Controlled<D, U, C, Scalar: Real>,
    B: Start<S, D, U, C>,
    const D: usize,
    const U: usize,
    const C: usize,
> {
    pub problem: Problem<'a, S, B, D, U, C>,
    pub stages: &'a mut [Stage<S, D, U, C>],
    /// The correction of the start.
    pub correction: B::Correction,
    /// x_N
    pub last: S::Place,
    /// The number of inequalities of all stages, without those that are none, and whether there are equations.
    pub bounds: S::Scalar,
    pub has_equations: bool,
    /// The inequalities of the end that have a multiplier.
    pub pushing: [bool; D],
    /// The backward sweeps that were made, and the most that may be.
    pub sweeps: u32,
    pub most: u32,
    pub way: Way,
    /// Whether places are unknowns too, with gaps between steps.
    pub is_lifted: bool,
    /// Where gaps have just been closed: the number of directions that inputs move the end in.
    pub landed_rank: Option<usize>,
}

/// A backward sweep, with the end that it began from.
pub(super) struct Swept<T, const D: usize, const U: usize> {
    pub summary: PlanSummary<T, D, U>,
    pub end: PlanEnd<T, D>,
    pub gramian: Gramian<T, D>,
}

/// The settings of a backward sweep.
#[derive(Clone, Copy)]
pub struct Settings<T, const D: usize> {
    /// ν and R of the target.
    pub multipliers: SVector<T, D>,
    pub weight: SMatrix<T, D, D>,
    /// Where no correction has to close the gap to the target: the price of its square, for each change.
    pub gap_price: Option<SVector<T, D>>,
    /// How strictly bounds are obeyed.
    pub strictness: Strictness<T>,
    pub(super) curvature: Curvature<T>,
    /// Whether the curvature of all steps is left out, which leaves that of price and bounds.
    pub is_straight: bool,
    /// Whether gains are those of plans that reach the target, for the caller, in place of those that the roll-out needs.
    pub is_last: bool,
}

/// Σ |∂²ℓ/∂x_i²| |x_i|²
fn span<T: Real, const M: usize>(curvature: &SMatrix<T, M, M>, sizes: &SVector<T, M>) -> T {
    let curvatures = curvature.diagonal();
    curvatures.iter().zip(sizes.iter()).fold(T::zero(), |sum, (curvature, size)| sum + curvature.abs() * *size * *size)
}

/// A symmetric matrix without its negative eigenvalues, for changes of these lengths.
#[cold]
pub(super) fn positive<T: Real, const M: usize>(
    matrix: &SMatrix<T, M, M>,
    lengths: &SVector<T, M>,
) -> SMatrix<T, M, M> {
    let scaled = SMatrix::<T, M, M>::from_fn(|i, j| matrix[(i, j)] / (lengths[i] * lengths[j]));
    let positive = Spectrum::of(&scaled).map(|value| larger(value, T::zero()));
    SMatrix::from_fn(|i, j| positive[(i, j)] * lengths[i] * lengths[j])
}

/// A step whose price curves up along all changes of place and input. Far from a solution a price of places curves down on a group: a sum of
/// squares Σ r² has the part r r″. Curvature along inputs is turned over where it is negative. That along places is left out where it is
/// negative for the inputs that suit each place best. So a price of the sum of place and input stays one.
#[cold]
pub(super) fn convex<X: Copy, T: Real, const D: usize, const U: usize>(
    step: &Expansion<X, T, D, U>,
    lengths: &SVector<T, D>,
) -> Expansion<X, T, D, U> {
    let spectrum = Spectrum::of(&step.input_curvature);
    let least = T::EPSILON * spectrum.largest();
    let priced = |value: T| value.abs() > least;
    // inputs that have no price by themselves go without one that depends on the place
    let mixed = spectrum.map(|value| if priced(value) { T::one() } else { T::zero() }) * step.mixed_curvature;
    let inverse = spectrum.map(|value| if priced(value) { value.abs().recip() } else { T::zero() });
    let by_inputs = mixed.tr_mul(&(inverse * mixed));
    Expansion {
        place_curvature: positive(&(step.place_curvature - by_inputs), lengths) + by_inputs,
        // an input without any curvature would have no limit
        input_curvature: spectrum.map(|value| value.abs()),
        mixed_curvature: mixed,
        ..*step
    }
}

impl<T: Real, const D: usize> Settings<T, D> {
    /// Whether steps, then bounds, and then prices go without their curvature where that leaves no minimum.
    pub fn is_guarded(&self) -> bool {
        self.curvature.is_mirrored && !self.is_last
    }
}

/// The results of a backward sweep for a plan.
pub struct PlanSummary<T, const D: usize, const U: usize> {
    /// φ₀ + Σℓ + φ
    pub price: T,
    /// |φ₀| + Σ|ℓ| + |φ|
    pub magnitude: T,
    /// No less than [`Plan::span`].
    pub most_span: T,
    /// −Σ Q_u·k
    pub descent: T,
    /// The largest entry of Q_u.
    pub residual: T,
    /// In the last sweep the largest sum of the sizes of the terms of such an entry.
    pub terms: T,
    /// V_ν, the gap that inputs have still to close.
    pub lack: SVector<T, D>,
    /// Γ
    pub gramian: SMatrix<T, D, D>,
    /// The number of negative eigenvalues of all Q_uu.
    pub negative: usize,
    /// The number of steps whose curvature was left out, and whether that is most of them.
    pub straightened: usize,
    pub is_mostly_straight: bool,
    /// Whether a bound depends on places.
    pub bounds_places: bool,
    /// The direction of the most negative one.
    pub(super) fall: Option<Fall<T, U>>,
    /// By how far each input moves the end where it is 1 throughout, at most.
    pub reach: SVector<T, U>,
    /// The costate at the end.
    pub costate: SVector<T, D>,
    /// V = Σ a/s of the bounds that are violated, and g·H⁻¹g with its slope g.
    violation: T,
    pub yielding: T,
}

impl<T: Real, const D: usize, const U: usize> PlanSummary<T, D, U> {
    /// The least cost of satisfying the bounds that are violated: in the quadratic model, removing V costs at least ½
    /// V²/(g·H⁻¹g). It does not vanish with the price of the plan, and units of bounds cancel. That the target makes it
    /// dearer is left aside.
    pub fn repair(&self) -> T {
        let price = self.violation / self.yielding * self.violation * T::from_ratio(1, 2);
        if price > T::zero() && price.is_finite() { price } else { T::zero() }
    }

    #[inline]
    fn count(&mut self, index: usize, price: T, policy: &Policy<T, D, U>) {
        let Policy { shift, by_multiplier, gradient: (_, by_input), input_multiplier, .. } = policy;
        self.price += price;
        self.magnitude += price.abs();
        self.descent -= by_input.dot(shift);
        self.residual = larger(self.residual, by_input.max_abs());
        self.lack += input_multiplier.tr_mul(shift);
        self.gramian -= input_multiplier.tr_mul(by_multiplier);
        self.negative += policy.negative;
        self.yielding += policy.yielding;
        if let Some(fall) = policy.fall
            && self.fall.is_none_or(|deepest| fall.curvature < deepest.curvature)
        {
            self.fall = Some(Fall { stage: index, ..fall });
        }
        for j in 0..U {
            self.reach[j] += input_multiplier.row(j).iter().fold(T::zero(), |max, x| larger(max, x.abs()));
        }
    }
}

impl<S: Controlled<D, U, C, Scalar: Real>, B: Start<S, D, U, C>, const D: usize, const U: usize, const C: usize>
    Problem<'_, S, B, D, U, C>
{
    /// The time t₀ + kh.
    #[inline]
    pub fn time_after(&self, steps: usize) -> S::Scalar {
        self.time + S::Scalar::from_f64(steps as f64) * self.h
    }

    /// The time t₀ + Nh of the end.
    pub fn end_time(&self) -> S::Scalar {
        self.time_after(self.steps)
    }

    /// The place that a small change moves `x` to, where the constraint holds at the time t.
    #[inline]
    pub fn moved(&self, t: S::Scalar, x: &S::Place, change: &SVector<S::Scalar, D>) -> S::Place {
        self.system.constrained_place(self.constants, t, &self.system.moved(x, change))
    }

    /// f with the reference of a stage, at the time t.
    #[inline]
    pub fn follow(
        &self,
        stage: &Stage<S, D, U, C>,
        t: S::Scalar,
        x: &S::Place,
        u: &SVector<S::Scalar, U>,
    ) -> Result<S::Place, Error> {
        if S::REFERS_IN_STEPS {
            self.constants.at(&stage.reference, |constants| self.system.follow(constants, t, x, u))
        } else {
            self.system.follow(self.constants, t, x, u)
        }
    }

    /// ℓ with the reference of a stage, at the time t.
    #[inline]
    pub fn price(
        &self,
        stage: &Stage<S, D, U, C>,
        t: S::Scalar,
        x: &S::Place,
        u: &SVector<S::Scalar, U>,
    ) -> Result<S::Scalar, Error> {
        self.constants.at(&stage.reference, |constants| self.system.price(constants, t, x, u))
    }

    /// a with the reference of a stage, at the time t.
    #[inline]
    pub fn bounds(
        &self,
        stage: &Stage<S, D, U, C>,
        t: S::Scalar,
        x: &S::Place,
        u: &SVector<S::Scalar, U>,
    ) -> Result<SVector<S::Scalar, C>, Error> {
        self.constants.at(&stage.reference, |constants| self.system.bounds(constants, t, x, u))
    }

    /// w with the reference of a stage, at the time t.
    pub fn bound_prices(&self, stage: &Stage<S, D, U, C>, t: S::Scalar) -> SVector<S::Scalar, C> {
        self.constants.at(&stage.reference, |constants| self.system.bound_prices(constants, t))
    }

    /// The step of a stage with its derivatives, at the time t.
    #[inline]
    pub fn expand(
        &self,
        stage: &Stage<S, D, U, C>,
        t: S::Scalar,
        costate: &SVector<S::Scalar, D>,
    ) -> Result<Expansion<S::Place, S::Scalar, D, U>, Error> {
        let (x, u) = (&stage.place, &stage.input);
        self.constants.at(&stage.reference, |constants| self.system.expand(constants, t, x, u, costate))
    }

    /// The bounds of a stage with their derivatives, at the time t.
    #[inline]
    pub fn bounds_expanded(
        &self,
        stage: &Stage<S, D, U, C>,
        t: S::Scalar,
        multipliers: &SVector<S::Scalar, C>,
    ) -> Result<BoundsExpansion<S::Scalar, D, U, C>, Error> {
        let (x, u) = (&stage.place, &stage.input);
        let expanded = |constants: &S::Constants| self.system.bounds_expanded(constants, t, x, u, multipliers);
        let mut bounds = self.constants.at(&stage.reference, expanded)?;
        without_kinks(&mut bounds.by_place);
        without_kinks(&mut bounds.by_input);
        let BoundsExpansion { place_curvature, mixed_curvature, input_curvature, .. } = &bounds;
        if place_curvature.all_finite() && mixed_curvature.all_finite() && input_curvature.all_finite() {
            return Ok(bounds);
        }
        Ok(BoundsExpansion {
            place_curvature: SMatrix::zeros(),
            mixed_curvature: SMatrix::zeros(),
            input_curvature: SMatrix::zeros(),
            ..bounds
        })
    }
}

impl<
    'a,
    T: Real,
    S: Controlled<D, U, C, Scalar = T>,
    B: Start<S, D, U, C>,
    const D: usize,
    const U: usize,
    const C: usize,
> Plan<'a, S, B, D, U, C>
{
    /// The guess that the stages hold.
    pub fn new(mut problem: Problem<'a, S, B, D, U, C>, stages: &'a mut [Stage<S, D, U, C>]) -> Self {
        let last = *problem.start;
        let (bounds, pushing) = (T::zero(), [false; D]);
        for stage in stages.iter_mut().take(1) {
            stage.place = last;
            problem.find_lengths(stage);
        }
        Self {
            problem,
            stages,
            correction: B::none(),
            last,
            bounds,
            has_equations: false,
            pushing,
            sweeps: 0,
            most: u32::MAX,
            way: Way::Kept,
            is_lifted: false,
            landed_rank: None,
        }
    }

    /// Whether anything is bounded.
    pub fn is_bounded(&self) -> bool {
        self.bounds > T::zero() || self.has_equations
    }

    /// x_0
    pub fn origin(&self) -> S::Place {
        self.stages.first().map_or(*self.problem.start, |stage| stage.place)
    }

    /// Goes back to the guess, without multipliers.
    pub fn forget(&mut self) {
        self.landed_rank = None;
        self.stages.iter_mut().for_each(Stage::forget);
        self.stages.iter_mut().take(1).for_each(|stage| stage.place = *self.problem.start);
    }

    /// Sweeps from the end. `None` where the sweep has to be made again, as without an inequality of the end.
    pub fn sweep(&mut self, now: &mut Iterate<T, D>) -> Result<Option<Swept<T, D, U>>, Error> {
        self.sweeps += 1;
        let mut end = self.end();
        let mut summary = self.eliminate(&end, &now.settings)?;
        if self.release(&mut summary, &mut end, &mut now.settings) {
            now.rank = 0;
            return Ok(None);
        }
        let gramian = end.gramian(&summary.gramian);
        Ok(Some(Swept { summary, end, gramian }))
    }

    /// Adds the correction of the multipliers ν. Returns whether other inequalities of the end push than before.
    pub fn add_multipliers(&mut self, now: &mut Iterate<T, D>, change: &SVector<T, D>) -> bool {
        now.settings.multipliers += change;
        let is_another = self.push(&mut now.settings.multipliers);
        if is_another {
            now.rank = 0;
        }
        is_another
    }

    /// Adds the curvature of ν·g of the conditions of the end to its value. Where the end then curves the price down, it goes without that
    /// curvature, and then without its negative part. Returns whether it does.
    fn arrive(&self, value: &mut Value<T, D>, end: &PlanEnd<T, D>, settings: &Settings<T, D>) -> bool {
        let force = match settings.gap_price {
            Some(_) => SVector::zeros(),
            None => settings.multipliers - settings.weight * end.lack,
        };
        let is_wrong = |value: &Value<T, D>| settings.is_guarded() && !value.is_convex(&self.problem.lengths);
        let mut is_bent = false;
        let problem = &self.problem;
        let tangent = problem.system.tangent_projector(problem.constants, problem.end_time(), &self.last);
        if let Some(tangent) = &tangent {
            value.restrict(tangent);
        }
        if let Some(conditions) = self.problem.conditions(&self.last, &force).filter(|_| !settings.is_straight) {
            let straight = value.hessian;
            value.hessian += conditions.curvature;
            if let Some(tangent) = &tangent {
                value.restrict(tangent);
            }
            if is_wrong(value) {
                (value.hessian, is_bent) = (straight, true);
            }
        }
        if is_wrong(value) {
            (value.hessian, is_bent) = (positive(&value.hessian, &self.problem.lengths), true);
        }
        is_bent
    }

    /// Σ |∂²ℓ/∂x²| |x|² + |∂²ℓ/∂u²| |u|² of diagonals, where that makes the price round-off, else 0. It is the price if places and inputs were
    /// as far from their best ones as they are large. Data without noise have a price that vanishes next to it. No roll-out then tells
    /// which plan has the least.
    #[inline]
    pub fn span(&self, summary: &PlanSummary<T, D, U>) -> Result<T, Error> {
        let is_vanishing = |span: T| summary.magnitude <= T::from_f64(16.0) * T::EPSILON * span;
        let span = if is_vanishing(summary.most_span) { self.exact_span()? } else { T::zero() };
        Ok(if is_vanishing(span) { span } else { T::zero() })
    }

    /// The same, whatever the price is.
    #[cold]
    #[inline(never)]
    fn exact_span(&self) -> Result<T, Error> {
        let zero = T::zero();
        let Problem { system, constants, .. } = self.problem;
        // how far a motion of each kind is from one by the entries that it moves
        let sizes = |x: &S::Place| {
            let mut sizes = SVector::<T, D>::from_element(zero);
            for (i, size) in sizes.iter_mut().enumerate() {
                let unit = SVector::from_fn(|j, _| if i == j { T::one() } else { zero });
                let velocity = system.infinitesimal_motion(x, &unit);
                let length = velocity.max_abs();
                if length > zero {
                    *size = x.zip_map(&velocity, |a, b| a * b).max_abs() / (length * length);
                }
            }
            sizes
        };
        let end = system.endpoint_expanded(constants, self.problem.end_time(), &self.last);
        let mut all = span(&end.curvature, &sizes(&self.last));
        for (index, stage) in self.stages.iter().enumerate() {
            let step = self.problem.expand(stage, self.problem.time_after(index), &SVector::zeros())?;
            all += span(&step.place_curvature, &sizes(&stage.place)) + span(&step.input_curvature, &stage.input);
        }
        Ok(all)
    }

    /// Linearises and eliminates: fills costates, gains and shifts of the stages.
    pub fn eliminate(&mut self, end: &PlanEnd<T, D>, settings: &Settings<T, D>) -> Result<PlanSummary<T, D, U>, Error> {
        let problem = &self.problem;
        let Problem { system, constants, .. } = *problem;
        let steps = self.stages.len();
        let endpoint = system.endpoint_expanded(constants, problem.end_time(), &self.last);
        let mut value = Value::of_end(&endpoint, end, settings);
        let zero = T::zero();
        let is_bent = self.arrive(&mut value, end, settings);
        let mut summary = PlanSummary {
            price: endpoint.price,
            magnitude: endpoint.price.abs(),
            most_span: span(&endpoint.curvature, &problem.sizes(&self.last)),
            descent: zero,
            residual: zero,
            terms: zero,
            lack: -end.lack,
            gramian: SMatrix::zeros(),
            negative: 0,
            straightened: usize::from(is_bent),
            is_mostly_straight: false,
            bounds_places: false,
            fall: None,
            reach: SVector::zeros(),
            costate: value.costate,
            violation: zero,
            yielding: zero,
        };
        let (mut following, mut bounds_places, is_bounded) = (self.last, false, self.is_bounded());
        for (index, stage) in self.stages.iter_mut().enumerate().rev() {
            let t = self.problem.time_after(index);
            // the step, with its curvature or without
            let expand = |value: &Value<T, D>, is_straight: bool| {
                let costate = if is_straight { SVector::zeros() } else { value.costate };
                problem.expand(stage, t, &costate)
            };
            let tangent = system.tangent_projector(problem.constants, t, &stage.place);
            // its model, with the curvature of its bounds or without
            let mut model = |value: &Value<T, D>, step: &Expansion<S::Place, T, D, U>, is_straight: bool| {
                let mut step = *step;
                let mut bounded = None;
                if is_bounded {
                    let natural = step.input_curvature.diagonal();
                    let multipliers = if is_straight { SVector::zeros() } else { stage.limits.multipliers };
                    let mut bounds = problem.bounds_expanded(stage, t, &multipliers)?;
                    let (violated, slopes) = stage.add_bounds(&mut step, &mut bounds, settings);
                    bounded = Some(Bounded { natural, slopes, violated });
                    bounds_places |= bounds.by_place.iter().any(|slope| *slope != zero);
                }
                let violated = bounded.as_ref().map_or(zero, |bounded| bounded.violated);
                let (policy, mut before) = Policy::of(&step, bounded, value, settings.curvature);
                if let Some(tangent) = &tangent {
                    before.restrict(tangent);
                }
                Ok::<_, Error>((policy, before, violated))
            };
            let mut step = expand(&value, settings.is_straight)?;
            summary.most_span += span(&step.place_curvature, &problem.sizes(&stage.place));
            summary.most_span += span(&step.input_curvature, &stage.input);
            if self.is_lifted {
                summary.lack += value.cross(&Gap::of(system, &following, &step.next));
                following = stage.place;
            }
            if settings.is_last {
                let expanded = || problem.bounds_expanded(stage, t, &stage.limits.multipliers);
                let forces = is_bounded.then(expanded).transpose()?.map(|bounds| stage.limits.forces(&bounds.by_input));
                summary.terms = larger(
                    summary.terms,
                    stage.terms(&step, &value.costate, &problem.sizes(&stage.place), forces).max_abs(),
                );
            }
            let (mut policy, mut before, violated) = model(&value, &step, false)?;
            summary.violation += violated;
            if settings.is_guarded() {
                let is_wrong = |policy: &Policy<T, D, U>, before: &Value<T, D>| {
                    policy.negative > 0 || !before.is_convex(&problem.lengths)
                };
                if !settings.is_straight && is_wrong(&policy, &before) {
                    step = expand(&value, true)?;
                    (policy, before, _) = model(&value, &step, false)?;
                    summary.straightened += 1;
                }
                if is_bounded && is_wrong(&policy, &before) {
                    (policy, before, _) = model(&value, &step, true)?;
                }
                if is_wrong(&policy, &before) {
                    step = convex(&step, &problem.lengths);
                    (policy, before, _) = model(&value, &step, true)?;
                    summary.straightened += usize::from(settings.is_straight);
                }
            }
            summary.count(index, step.price, &policy);
            if is_bounded {
                summary.magnitude += stage.limits.price_of_violations();
            }
            if settings.is_last {
                // the costate of the plan as it is, without the correction that is round-off
                before.costate = policy.gradient.0;
            }
            (stage.next_costate, stage.costate) = (value.costate, before.costate);
            (stage.shift, stage.gain, stage.by_multiplier) = (policy.shift, policy.gain, policy.by_multiplier);
            if settings.is_last {
                let inverse = end.gramian(&summary.gramian).inverse();
                stage.gain += policy.by_multiplier * (inverse * before.by_multiplier.transpose());
            }
            value = before;
        }
        let first = self.origin();
        self.correction = problem.beginning.eliminate(system, &problem.lengths, &first, &value, settings, &mut summary);
        summary.bounds_places = bounds_places;
        summary.is_mostly_straight = 2 * summary.straightened > steps;
        if let Some(fall) = &mut summary.fall {
            fall.depth /= T::from_f64(steps as f64);
        }
        Ok(summary)
    }
}
