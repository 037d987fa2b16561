//! The answer to a problem of optimal control, and the storage that the caller provides.

use super::Referenced;
use super::reference::ungiven;
use super::slacks::Barriers;
use crate::fields::{copied, debug, getters};
use crate::{Controlled, Error, Real, Space};
use nalgebra::{SMatrix, SVector};

/// The reference of a step of `S`; `()` where motion, price and bounds read none.
pub(super) type Reference<S, const D: usize, const U: usize, const C: usize> =
    <<S as Controlled<D, U, C>>::Constants as Referenced<<S as Controlled<D, U, C>>::Scalar>>::Reference;

/// One step of a plan. Made by [`Control::stage`](crate::Control::stage), filled by [`Control::solve`](crate::Control::solve).
///
/// ```
/// # use clebsch::{Clebsch, Controlled};
/// # use nalgebra::{Vector1, Vector2};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
/// #     cost     = |h, u| h * u.norm_squared() / 2,
/// #     bounds   = |u| [u.x <= self.strongest],
/// #     endpoint = |x| self.price * x.norm_squared() / 2,
/// # )]
/// # struct Cart { strongest: f64, price: f64 }
/// let control = Cart { strongest: 8.0, price: 0.0 }.control(0.1)?;
/// let stage = control.stage(&Vector2::x()).with_input(Vector1::new(2.0)); // a guess
/// assert_eq!((stage.place().x, stage.input().x), (1.0, 2.0));
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Stage<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> {
    pub(super) place: S::Place,
    pub(super) input: SVector<S::Scalar, U>,
    /// The costates p_k and p_{k+1}.
    pub(super) costate: SVector<S::Scalar, D>,
    pub(super) next_costate: SVector<S::Scalar, D>,
    pub(super) gain: SMatrix<S::Scalar, U, D>,
    pub(super) reference: Reference<S, D, U, C>,
    pub(super) limits: Barriers<S::Scalar, C>,
    /// k and G: the change of the input is k + G δν + K δ.
    pub(super) shift: SVector<S::Scalar, U>,
    pub(super) by_multiplier: SMatrix<S::Scalar, U, D>,
    /// The change δ_k of the place by a correction, where places are unknowns.
    pub(super) motion: SVector<S::Scalar, D>,
    /// The proposal of a roll-out.
    pub(super) next_place: S::Place,
    pub(super) next_input: SVector<S::Scalar, U>,
    /// The input before the solution began, given back after an error.
    pub(super) guess: SVector<S::Scalar, U>,
}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Stage<S, D, U, C> {
    /// The step from `x` without input.
    pub(super) fn rest(x: &S::Place) -> Self {
        Self {
            place: *x,
            input: Space::origin(),
            costate: Space::origin(),
            next_costate: Space::origin(),
            gain: Space::origin(),
            reference: ungiven(),
            limits: Barriers::none(),
            shift: Space::origin(),
            by_multiplier: Space::origin(),
            motion: Space::origin(),
            next_place: *x,
            next_input: Space::origin(),
            guess: Space::origin(),
        }
    }

    /// The same with this input, as a guess.
    #[inline]
    #[must_use]
    pub fn with_input(self, input: SVector<S::Scalar, U>) -> Self {
        Self { input, ..self }
    }

    /// The same with this reference r_k, for the motion, the price and the bounds of its step.
    #[inline]
    #[must_use]
    pub fn with_reference(self, reference: Reference<S, D, U, C>) -> Self {
        Self { reference, ..self }
    }

    /// Goes back to the input of the guess, without multipliers.
    pub(super) fn forget(&mut self) {
        *self = Self { input: self.guess, guess: self.guess, reference: self.reference, ..Self::rest(&self.place) };
    }

    /// Begins the next search without multipliers.
    pub(super) fn forget_multipliers(&mut self) {
        self.next_costate = Space::origin();
        self.limits.forget();
    }

    getters! {
        /// The place x_k where the step starts.
        ref place: S::Place;
        /// The input u_k of the step from x_k to x_{k+1}.
        ref input: SVector<S::Scalar, U>;
        /// The reference r_k of motion, price and bounds: NaN until it is given, `()` where they read none.
        ref reference: Reference<S, D, U, C>;
        /// The costate p_k = ∂V/∂x at x_k, V the least price from there on: a covector of the small changes of x_k.
        ref costate: SVector<S::Scalar, D>;
        /// The matrix K of optimal feedback, of shape U×D. If x_k is changed by δ, the optimal plan from there to the
        /// same target begins with u_k + Kδ + O(δ²). Near the end, inputs may no longer reach all of the target. The
        /// plan then reaches the part that it can.
        ref gain: SMatrix<S::Scalar, U, D>;
    }

    /// The multipliers z ≥ 0 of the bounds a ≤ 0: by how much the least price falls where a bound is relaxed by one unit.
    /// Equations a = 0 have multipliers of any sign: the least price of a = ε is less by zε + O(ε²).
    #[inline]
    pub fn multipliers(&self) -> &SVector<S::Scalar, C> {
        &self.limits.multipliers
    }

    /// The bounds that limit the inputs: their multiplier is larger than the distance to them. Equations always do.
    #[inline]
    pub fn active(&self) -> [bool; C] {
        core::array::from_fn(|i| self.limits.is_active(i))
    }
}

copied!(Stage<S, D, U, C> where [S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize]:
    place, input, costate, gain, multipliers);

/// How a search for a plan of least price ended: [`Optimum::ended`].
///
/// ```
/// # use clebsch::{Clebsch, Controlled, Ended, Limits, Target};
/// # use nalgebra::{Vector1, Vector2};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
/// #     cost     = |h, u| h * u.norm_squared() / 2,
/// #     bounds   = |u| [u.x <= self.strongest],
/// #     endpoint = |x| self.price * x.norm_squared() / 2,
/// # )]
/// # struct Cart { strongest: f64, price: f64 }
/// let control = Cart { strongest: 5.0, price: 0.0 }.control(0.02)?;
/// # let start = Vector2::zeros();
/// let mut plan = [control.stage(&start); 50];
/// let begun = control.solve_within(&start, Target::Place(Vector2::x()), Limits { sweeps: 2 }, &mut plan)?;
/// assert_eq!(begun.ended(), Ended::AtLimit);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ended {
    /// At a critical plan, to round-off. [`Control::solve`](crate::Control::solve) gives no other.
    Converged,
    /// At the limits, before that.
    AtLimit,
    /// By this error: from this guess the search comes no further. [`Control::solve`](crate::Control::solve) tries others.
    Failed(Error),
}

/// A plan on which the price is critical, solved to round-off by [`Control::solve`](crate::Control::solve), or the one that
/// [`Control::solve_within`](crate::Control::solve_within) has reached. Its stages are the plan itself.
///
/// ```
/// # use clebsch::{Clebsch, Controlled, Target};
/// # use nalgebra::{Vector1, Vector2};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
/// #     cost     = |h, u| h * u.norm_squared() / 2,
/// #     bounds   = |u| [u.x <= self.strongest],
/// #     endpoint = |x| self.price * x.norm_squared() / 2,
/// # )]
/// # struct Cart { strongest: f64, price: f64 }
/// let control = Cart { strongest: 5.0, price: 0.0 }.control(0.02)?;
/// # let start = Vector2::zeros();
/// let mut plan = [control.stage(&start); 50];
/// let optimum = control.solve(&start, Target::Place(Vector2::x()), &mut plan)?;
/// assert!(optimum.gap() < 1e-10);
/// // the bound of 5 m/s² holds the cart back at first
/// assert_eq!(optimum.stages()[0].active(), [true]);
/// assert_eq!(optimum.stages()[25].active(), [false]);
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Optimum<'p, S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> {
    pub(super) stages: &'p [Stage<S, D, U, C>],
    pub(super) ended: Ended,
    pub(super) step_size: S::Scalar,
    pub(super) price: S::Scalar,
    pub(super) residual: S::Scalar,
    pub(super) gap: S::Scalar,
    pub(super) violation: S::Scalar,
    pub(super) negative: usize,
    pub(super) iterations: u32,
    pub(super) end: S::Place,
    pub(super) final_costate: SVector<S::Scalar, D>,
}

impl<'p, S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Optimum<'p, S, D, U, C> {
    getters! {
        /// The price Σ ℓ + φ, with φ₀ of a [`Prior`](crate::Prior).
        copy price: S::Scalar;
        /// The step size h.
        copy step_size: S::Scalar;
        /// The number of linearisations that were made, but for the last, which is for gains and the index.
        copy iterations: u32;
        /// The largest entry of ∂ℓ/∂u + Bᵀp + ∂a/∂uᵀz that round-off has left, and of ∂φ₀/∂x + p₀ where the start is unknown.
        copy residual: S::Scalar;
        /// The distance from the end to the target, as the root of the sum of squares of all entries; 0 for
        /// [`Target::Free`](crate::Target). For [`Target::Conditions`](crate::Target) entries are a − b of equations, and of inequalities that push or are violated.
        copy gap: S::Scalar;
        /// How the search ended.
        copy ended: Ended;
        /// The largest a of bounds a ≤ 0, and |a| of equations, that are violated by more than round-off; 0 where the search has converged.
        copy violation: S::Scalar;
        /// The Morse index: the number of independent changes of the inputs that keep target and active bounds and lower the price. 0 on a local minimum.
        copy negative: usize;
        /// The place x_N: the target up to the [`gap`](Self::gap).
        ref end: S::Place;
        /// The costate p_N at the end: ∂φ/∂x and the multipliers of the target.
        ref final_costate: SVector<S::Scalar, D>;
        /// The steps in order, with place, input, costate, gain and multipliers.
        copy stages: &'p [Stage<S, D, U, C>];
    }

    /// Whether no small change of the inputs, to second order, makes the price smaller. It is only known of a plan that has
    /// converged.
    pub fn is_minimum(&self) -> bool {
        self.negative == 0 && self.ended == Ended::Converged
    }
}

// without the plan, which is long
debug!(Optimum<'_, S, D, U, C> where [S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize]:
    ended, price, iterations, residual, gap, violation, negative);
