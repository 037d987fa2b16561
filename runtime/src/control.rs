//! Optimal control: the inputs that lead from one place to another, or to none in particular, at the least price and within bounds.
//!
//! ```text
//! minimise Σ ℓ(t_k, h, x_k, u_k) + φ(t_N, x_N)   subject to   x_{k+1} = f(t_k, h, x_k, u_k),   a(t_k, x_k, u_k) ≤ 0 or = 0,   x_N = target
//! ```
//! The unknowns are the inputs, and the start where that is unknown. Newton's method is a Riccati sweep backward, with exact second derivatives on the manifold, and a roll-out forward.

mod arrival;
mod attempt;
mod barrier;
mod end;
mod iterate;
mod lift;
mod newton;
mod optimum;
mod quadratic;
mod reference;
mod search;
mod slacks;
mod start;
mod sweep;

pub use optimum::{Ended, Optimum, Stage};
pub use reference::{Referenced, Referring};
pub use start::{Known, Prior, Start};

use crate::fields::getters;
use crate::newton::{Bracket, Trial};
use crate::parameters::check_finite;
use crate::{Controlled, Error, Real, Scalar, Space};
use core::ops::RangeInclusive;
use nalgebra::SVector;
use sweep::{Plan, Problem};

/// A system whose inputs are chosen, with its step size. Made by [`Controlled::control`].
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
/// let control = Cart { strongest: 8.0, price: 0.0 }.control(0.02)?;
/// let start = Vector2::zeros();
/// let mut plan = [control.stage(&start); 50];
/// // a metre in a second, from rest to rest
/// let optimum = control.solve(&start, Target::Place(Vector2::x()), &mut plan)?;
/// assert!(optimum.is_minimum());
/// assert!((optimum.price() - 6.0).abs() < 0.1); // 6 m²/s³ for the continuous cart
/// # Ok::<(), clebsch::Error>(())
/// ```
///
/// Plans start at a [`Known`] place, or near a [`Prior`]: [`with_prior`](Self::with_prior).
#[derive(Clone, Debug)]
pub struct Control<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize, B = Known> {
    pub(crate) system: S,
    pub(crate) step_size: S::Scalar,
    pub(crate) constants: S::Constants,
    pub(crate) time: S::Scalar,
    pub(crate) beginning: B,
}

/// A control whose plans have an unknown start. Made by [`Control::with_prior`].
///
/// ```
/// use clebsch::{Estimator, Prior};
/// # use clebsch::{Clebsch, Controlled};
/// # use nalgebra::{Vector1, Vector2};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
/// #     cost     = |h, u| h * u.norm_squared() / 2,
/// # )]
/// # struct Cart {}
/// /// Where a cart is, from measurements.
/// struct Tracker {
///     estimator: Estimator<Cart, 2, 1, 0>,
/// }
///
/// let estimator = Cart {}.control(0.1)?.with_prior(Prior::unknown(Vector2::zeros()))?;
/// let tracker = Tracker { estimator };
/// assert_eq!(tracker.estimator.prior().place(), &Vector2::zeros());
/// # Ok::<(), clebsch::Error>(())
/// ```
pub type Estimator<S, const D: usize, const U: usize, const C: usize> =
    Control<S, D, U, C, Prior<<S as Controlled<D, U, C>>::Place, <S as Controlled<D, U, C>>::Scalar, D>>;

/// Where a plan is to end.
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
/// let control = Cart { strongest: 8.0, price: 10.0 }.control(0.1)?;
/// let mut plan = [control.stage(&Vector2::x()); 10];
/// // anywhere: the price of the end, 10 |x|²/2, decides
/// let optimum = control.solve(&Vector2::x(), Target::Free, &mut plan)?;
/// assert!(optimum.price() < 5.0); // less than to stay at 1 m
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target<X> {
    /// At this place.
    Place(X),
    /// At the configuration of this place, with any momentum.
    Configuration(X),
    /// Where the conditions hold that the key `target` declares, as `target = |x| [x.x == self.place]`. They may leave a part of the place free.
    Conditions,
    /// Anywhere: the price of the end decides.
    Free,
}

/// How much work [`Control::solve_within`] may do.
///
/// ```
/// # use clebsch::{Clebsch, Controlled, Limits, Target};
/// # use nalgebra::{Vector1, Vector2};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
/// #     cost     = |h, u| h * u.norm_squared() / 2,
/// #     bounds   = |u| [u.x <= self.strongest],
/// #     endpoint = |x| self.price * x.norm_squared() / 2,
/// # )]
/// # struct Cart { strongest: f64, price: f64 }
/// let control = Cart { strongest: 8.0, price: 10.0 }.control(0.1)?;
/// let mut plan = [control.stage(&Vector2::x()); 10];
/// let reached = control.solve_within(&Vector2::x(), Target::Free, Limits { sweeps: 4 }, &mut plan)?;
/// assert!(reached.iterations() <= 4);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most linearisations, as [`Optimum::iterations`] counts them, but that one correction is always made, if this is not 0.
    /// It takes one linearisation, or up to three where the price does not curve upward. The sizes of bounds that the guess
    /// violates take some more. Another linearisation is made for gains.
    pub sweeps: u32,
}

impl<X> Target<X> {
    fn place(&self) -> Option<&X> {
        match self {
            Self::Place(x) | Self::Configuration(x) => Some(x),
            Self::Conditions | Self::Free => None,
        }
    }
}

impl<S: Controlled<D, U, C, Scalar: Real>, B: Start<S, D, U, C>, const D: usize, const U: usize, const C: usize>
    Control<S, D, U, C, B>
{
    /// The same with plans that start at the time `t` instead of 0.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn starting_at(self, t: S::Scalar) -> Result<Self, Error> {
        check_finite("the time", &t)?;
        Ok(Self { time: t, ..self })
    }

    getters! {
        /// The system.
        ref system: S;
        /// The step size h.
        copy step_size: S::Scalar;
    }

    /// The step from `x` without input, as storage: a plan of N steps has N of them.
    pub fn stage(&self, x: &S::Place) -> Stage<S, D, U, C> {
        Stage::rest(x)
    }

    /// Gives the reference r_k = `reference(k, t_k)` to each step of a plan, for its motion, price and bounds.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Controlled, Target};
    /// # use nalgebra::{Vector1, Vector2};
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
    ///     cost     = |h, x, u, track: Vector2| h * ((x - track).norm_squared() + self.price * u.norm_squared()) / 2,
    ///     endpoint = |x, last: Vector2| (x - last).norm_squared() / 2,
    /// )]
    /// struct Cart { price: f64 }
    ///
    /// // a cart follows a swing
    /// let track = |t: f64| Vector2::new(t.sin(), t.cos());
    /// let control = Cart { price: 1e-4 }.control(0.1)?.with_end_reference(track(2.0))?;
    /// let start = track(0.0);
    /// let mut plan = [control.stage(&start); 20];
    /// control.refer(&mut plan, |_, t| track(t));
    /// let optimum = control.solve(&start, Target::Free, &mut plan)?;
    /// assert!((optimum.end() - track(2.0)).norm() < 0.1);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    pub fn refer(
        &self,
        plan: &mut [Stage<S, D, U, C>],
        mut reference: impl FnMut(usize, S::Scalar) -> <S::Constants as Referenced<S::Scalar>>::Reference,
    ) {
        for (k, stage) in plan.iter_mut().enumerate() {
            let t = self.time + S::Scalar::from_f64(k as f64) * self.step_size;
            stage.reference = reference(k, t);
        }
    }

    /// The same with this reference r_N of the end, for the price that `endpoint` declares.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Controlled, Target};
    /// # use nalgebra::{Vector1, Vector2};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
    /// #     cost     = |h, u| h * self.price * u.norm_squared() / 2,
    /// #     endpoint = |x, goal: Vector2| (x - goal).norm_squared() / 2,
    /// # )]
    /// # struct Cart { price: f64 }
    /// // with endpoint = |x, goal: Vector2| (x - goal).norm_squared() / 2
    /// let control = Cart { price: 1e-6 }.control(0.1)?.with_end_reference(Vector2::x())?;
    /// let mut plan = [control.stage(&Vector2::zeros()); 20];
    /// let optimum = control.solve(&Vector2::zeros(), Target::Free, &mut plan)?;
    /// assert!((optimum.end() - Vector2::x()).norm() < 1e-4);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn with_end_reference(
        self,
        reference: <S::Constants as Referenced<S::Scalar>>::EndReference,
    ) -> Result<Self, Error> {
        check_finite("the reference of the end", &reference)?;
        Ok(Self { constants: self.constants.with_end_reference(reference), ..self })
    }

    /// The same with plans that start near a prior place, at the price φ₀ of their start. [`solve`](Self::solve) then takes a guess of the
    /// start, and finds it together with the inputs. The plan has it in its first [`stage`](Stage::place).
    ///
    /// A system with a constraint has none yet, since its starts have to obey it: a build then fails.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotSymmetric`], [`Error::NegativeInformation`], and those of a place.
    pub fn with_prior(self, prior: Prior<S::Place, S::Scalar, D>) -> Result<Estimator<S, D, U, C>, Error> {
        const {
            assert!(
                !S::IS_CONSTRAINED,
                "the start of a system with a constraint cannot be found yet: leave out `with_prior`, and give the start"
            );
        }
        self.system.check_place(prior.place())?;
        prior.check()?;
        let Self { system, step_size, constants, time, .. } = self;
        Ok(Control { system, step_size, constants, time, beginning: prior })
    }

    /// One step at the start time: f(t₀, h, x, u).
    ///
    /// # Errors
    /// Those of a step, and [`Error::NoReference`] where the motion reads a reference: see [`follow_with`](Self::follow_with).
    pub fn follow(&self, x: &S::Place, u: &SVector<S::Scalar, U>) -> Result<S::Place, Error> {
        self.system.follow(&self.constants, self.time, x, u)
    }

    /// The same with the reference of the step: f(t₀, h, x, u, r).
    ///
    /// ```
    /// # use clebsch::{Clebsch, Controlled};
    /// # use nalgebra::{Vector1, Vector2};
    /// /// A sledge with a brake, on ground that changes.
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     dynamics = |h, x: Vector2, u: Vector1, friction: Vector1| x + h * Vector2::new(x.y, u.x - friction.x * x.y),
    ///     cost     = |h, u| h * u.norm_squared() / 2,
    /// )]
    /// struct Sledge {}
    ///
    /// let control = Sledge {}.control(0.1)?;
    /// let (moving, none) = (Vector2::new(0.0, 2.0), Vector1::zeros());
    /// assert_eq!(control.follow_with(&moving, &none, &Vector1::new(5.0))?.y, 1.0);
    /// assert_eq!(control.follow_with(&moving, &none, &Vector1::new(0.0))?.y, 2.0); // on ice
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of a step, and [`Error::NoReference`] where a number of the reference is NaN or infinite and the motion reads one.
    pub fn follow_with(
        &self,
        x: &S::Place,
        u: &SVector<S::Scalar, U>,
        reference: &<S::Constants as Referenced<S::Scalar>>::Reference,
    ) -> Result<S::Place, Error> {
        self.constants.at(reference, |constants| self.system.follow(constants, self.time, x, u))
    }

    /// The input u_k + K δ for a place `x` near x_k.
    pub fn feedback(&self, stage: &Stage<S, D, U, C>, x: &S::Place) -> SVector<S::Scalar, U> {
        stage.input + stage.gain * self.system.displacement(&stage.place, x)
    }

    /// The plan of least price from `start` to `target`, as near to the guess as Newton's method finds it. With a [`Prior`] `start` is a guess too.
    ///
    /// The number of steps is that of `plan`. The inputs, costates and multipliers that its stages hold are the guess: none of
    /// [`stage`](Self::stage), an earlier solution, or inputs from elsewhere. They need neither lead to the target nor keep the bounds.
    ///
    /// Work: two or three linearisations where the system is linear and its price quadratic, four to eight from a good
    /// guess. With bounds, or from standing still, some tens, and hundreds where several attempts are needed; at most
    /// 400 in each of up to seven attempts. Each is linear in the number of stages. Where the first correction does not come near the
    /// target, multiple shooting goes on, with places as unknowns. Where that fails, the gap is priced and inputs are varied. The result
    /// is then a local minimum, and need not be the best one.
    ///
    /// Every bound holds up to round-off of its own terms, whatever the sizes of the others. One with a = −∞, from an infinite parameter, is none.
    ///
    /// # Errors
    /// * [`Error::PathLength`], [`Error::NotFinite`], [`Error::OffOrbit`], [`Error::OutsideMomentumSpace`], [`Error::OffConstraint`],
    ///   [`Error::ConstraintViolated`], [`Error::DependentConstraints`], [`Error::NoReference`], [`Error::NoTarget`] for the arguments;
    /// * [`Error::Uncontrollable`] where inputs do not move the end towards the target;
    /// * [`Error::Infeasible`] and [`Error::TargetMissed`] where bounds cannot be satisfied, or leave no way to the target;
    /// * [`Error::NoExtremal`] where the work was not enough;
    /// * [`Error::NotStationary`] where slopes of the price do not cancel but for round-off, as near a singularity;
    /// * those of a step.
    ///
    /// After an error the stages hold the inputs of the guess.
    pub fn solve<'p>(
        &self,
        start: &S::Place,
        target: Target<S::Place>,
        plan: &'p mut [Stage<S, D, U, C>],
    ) -> Result<Optimum<'p, S, D, U, C>, Error> {
        self.check(start, &target, plan)?;
        self.check_goal(&target, plan.len())?;
        let solved = Plan::new(self.problem(start, &target, plan.len()), plan).attempt()?;
        Ok(Optimum { stages: plan, ..solved })
    }

    /// As [`solve`](Self::solve), near places that are known roughly: those of a planner, of an interpolation, of a side of an obstacle.
    ///
    /// `path(k, t_k)` is a guess of the place x_k, for k from 1 to N. It need not be a motion of the system, nor end at the target. Momenta of
    /// states may be zero. Multiple shooting begins there, with the inputs that the stages hold and without multipliers. Where it leads nowhere,
    /// the plan is that of [`solve`](Self::solve).
    ///
    /// ```
    /// # use clebsch::{Clebsch, Controlled, Target};
    /// # use nalgebra::Vector2;
    /// /// A boat that keeps away from an island.
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     dynamics = |h, x: Vector2, u: Vector2| x + h * u,
    ///     cost     = |h, u| h * u.norm_squared() / 2,
    ///     bounds   = |x| [x.norm_squared() >= self.radius.powi(2)],
    /// )]
    /// struct Boat { radius: f64 }
    ///
    /// let control = Boat { radius: 1.0 }.control(0.1)?;
    /// let (start, goal) = (Vector2::new(-2.0, 0.0), Vector2::new(2.0, 0.0));
    /// for side in [1.0, -1.0] {
    ///     let mut plan = [control.stage(&start); 20];
    ///     let path = |_, t: f64| Vector2::new(2.0 * t - 2.0, 1.5 * side);
    ///     let optimum = control.solve_along(&start, Target::Place(goal), path, &mut plan)?;
    ///     assert!(optimum.is_minimum());
    ///     assert!(plan[10].place().y * side >= 1.0); // it passes on the side of the guess
    /// }
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`solve`](Self::solve), and those of places that are none, as [`Error::NotFinite`] and [`Error::OffOrbit`].
    pub fn solve_along<'p>(
        &self,
        start: &S::Place,
        target: Target<S::Place>,
        path: impl FnMut(usize, S::Scalar) -> S::Place,
        plan: &'p mut [Stage<S, D, U, C>],
    ) -> Result<Optimum<'p, S, D, U, C>, Error> {
        self.check(start, &target, plan)?;
        self.check_goal(&target, plan.len())?;
        let solved = Plan::new(self.problem(start, &target, plan.len()), plan).attempt_along(path)?;
        Ok(Optimum { stages: plan, ..solved })
    }

    /// As [`solve`](Self::solve) with bounded work, for plans that are made anew while the system moves.
    ///
    /// One search goes from the guess, with its multipliers. At the limit it ends with the plan that it has reached, and
    /// [`Optimum::ended`] says so. The plan is a motion of the system from `start`, with gains for [`feedback`](Self::feedback).
    /// Its end may have a [`gap`](Optimum::gap) to the target. Bounds that the guess violates may have a
    /// [`violation`](Optimum::violation). The stages are the guess of the next call, which goes on from there.
    ///
    /// Each call makes a correction at least, so that `Limits { sweeps: 1 }` is the real-time iteration. The source is Diehl, Bock and
    /// Schlöder, *A real-time iteration scheme for nonlinear optimization in optimal feedback control* (2005).
    ///
    /// ```
    /// # use clebsch::{Clebsch, Controlled, Limits, Target};
    /// # use nalgebra::{Vector1, Vector2};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
    /// #     cost     = |h, u| h * u.norm_squared() / 2,
    /// #     bounds   = |u| [u.x <= self.strongest],
    /// #     endpoint = |x| self.price * x.norm_squared() / 2,
    /// # )]
    /// # struct Cart { strongest: f64, price: f64 }
    /// // a cart is brought back to its place, and is pushed all the time
    /// let control = Cart { strongest: 8.0, price: 1000.0 }.control(0.05)?;
    /// let mut place = Vector2::x();
    /// let mut plan = [control.stage(&place); 20];
    /// for tick in 0..100 {
    ///     control.solve_within(&place, Target::Free, Limits { sweeps: 1 }, &mut plan)?;
    ///     place = control.follow(&place, plan[0].input())?;
    ///     place.y += 0.02 * (tick as f64).sin(); // gusts
    ///     control.shift(&mut plan, 1);
    /// }
    /// assert!(place.norm() < 0.1);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`solve`](Self::solve) for the arguments, and those of a step. The stages then hold the inputs of the guess.
    pub fn solve_within<'p>(
        &self,
        start: &S::Place,
        target: Target<S::Place>,
        limits: Limits,
        plan: &'p mut [Stage<S, D, U, C>],
    ) -> Result<Optimum<'p, S, D, U, C>, Error> {
        self.check(start, &target, plan)?;
        self.check_goal(&target, plan.len())?;
        let problem = self.problem(start, &target, plan.len());
        let reached = Plan { most: limits.sweeps, ..Plan::new(problem, plan) }.attempt_once()?;
        Ok(Optimum { stages: plan, ..reached })
    }

    /// The plan from its stage `steps` on, with the last input repeated at its end. It is the guess of the plan that is made
    /// so many steps later. Multipliers and references move along.
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
    /// # let control = Cart { strongest: 8.0, price: 0.0 }.control(0.1)?;
    /// let mut plan = [1.0, 2.0, 3.0].map(|u| control.stage(&Vector2::x()).with_input(Vector1::new(u)));
    /// control.shift(&mut plan, 1);
    /// assert_eq!(plan.map(|stage| stage.input().x), [2.0, 3.0, 3.0]);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    pub fn shift(&self, plan: &mut [Stage<S, D, U, C>], steps: usize) {
        for k in 0..plan.len() {
            if let Some(later) = plan.get(k.saturating_add(steps)).or(plan.last()).copied() {
                plan.get_mut(k).into_iter().for_each(|stage| *stage = later);
            }
        }
    }

    /// As [`solve`](Self::solve), with the step size in `steps` at which the least price is least, found from that of this control on:
    /// [`Optimum::step_size`]. At a limit the price may fall beyond it.
    ///
    /// By the envelope theorem the least price V of N steps changes with the step size as the Lagrangian does. The slope
    /// is that at the solution, with fixed multipliers.
    /// ```text
    /// dV/dh = Σ d/dh (ℓ + p·f + z·a) + N ∂φ/∂t
    /// ```
    /// Its zero is bracketed and found by the secant method, with halvings if that does not contract. The source is
    /// Brent, *Algorithms for Minimization without Derivatives*, 1973, chapter 4. Each plan is the guess of the next.
    ///
    /// # Errors
    /// [`Error::StepSize`] for limits that are not positive numbers in order, [`Error::NoExtremal`], and those of [`solve`](Self::solve).
    pub fn solve_free_time<'p>(
        &self,
        start: &S::Place,
        target: Target<S::Place>,
        steps: RangeInclusive<S::Scalar>,
        plan: &'p mut [Stage<S, D, U, C>],
    ) -> Result<Optimum<'p, S, D, U, C>, Error> {
        let bracket = Bracket::within(&steps)?;
        self.check(start, &target, plan)?;
        let accuracy = S::Scalar::from_f64(64.0) * S::Scalar::EPSILON;
        let system = &self.system;
        let lengths = self.problem(start, &target, 0).lengths;
        let steps = plan.len();
        let trial = |h| {
            let constants = system.prepare(h)?.with_end_reference(self.constants.end_reference());
            let problem = Problem { constants: &constants, h, lengths, ..self.problem(start, &target, steps) };
            let mut plan = Plan::new(problem, plan);
            let answer = plan.attempt()?;
            let (slope, size) = plan.slope()?;
            Ok(Trial { sweeps: answer.iterations, answer, slope, size })
        };
        let (solved, iterations) = bracket.critical(self.step_size, accuracy, true, trial)?;
        Ok(Optimum { stages: plan, iterations, ..solved })
    }

    fn problem<'a>(
        &'a self,
        start: &'a S::Place,
        target: &'a Target<S::Place>,
        steps: usize,
    ) -> Problem<'a, S, B, D, U, C> {
        let Self { system, step_size: h, constants, time, beginning } = self;
        let lengths = end::lengths(system, target);
        Problem { system, constants, h: *h, time: *time, steps, start, beginning, target, lengths }
    }

    /// The target obeys the constraint at the end of so many steps.
    fn check_goal(&self, target: &Target<S::Place>, steps: usize) -> Result<(), Error> {
        let Some(goal) = target.place() else { return Ok(()) };
        let end = self.time + self.step_size * S::Scalar::from_f64(steps as f64);
        self.system.check_constraint(&self.constants, end, goal, matches!(target, Target::Place(_)))
    }

    /// Start, target and guess are finite and where places are.
    fn check(&self, start: &S::Place, target: &Target<S::Place>, plan: &[Stage<S, D, U, C>]) -> Result<(), Error> {
        if plan.is_empty() {
            return Err(Error::PathLength { nodes: 0, per_step: 1 });
        }
        self.system.check_place(start)?;
        self.system.check_constraint(&self.constants, self.time, start, true)?;
        target.place().map_or(Ok(()), |goal| self.system.check_place(goal))?;
        if matches!(target, Target::Conditions) && S::TARGET.is_empty() {
            return Err(Error::NoTarget);
        }
        plan.iter().try_for_each(|stage| check_finite("the guessed inputs", &stage.input))?;
        let steps = plan.len();
        let missing = plan.iter().position(|stage| !stage.reference.all_finite());
        let of_end = || (!self.constants.end_reference().all_finite()).then_some(steps);
        missing.or_else(of_end).map_or(Ok(()), |step| Err(Error::NoReference { step, steps }))
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, B: Start<S, D, U, C>, const D: usize, const U: usize, const C: usize>
    Plan<'_, S, B, D, U, C>
{
    /// dV/dh of a solution, and the sum of the sizes of its terms.
    fn slope(&self) -> Result<(T, T), Error> {
        let problem = &self.problem;
        let Problem { system, constants, h, .. } = *problem;
        let steps = self.stages.len();
        let endpoint = system.endpoint_expanded(constants, self.problem.time_after(steps), &self.last);
        let mut slope = endpoint.by_time * T::from_f64(steps as f64);
        let mut size = slope.abs();
        // a(t₀ + kh, h, x, u) by h, by central differences. Few bounds depend on the time or on the step, and the zero of
        // dV/dh needs few digits.
        let third = T::EPSILON.powf(T::from_ratio(1, 3));
        let apart = third * h.abs();
        if let Some(conditions) = problem.conditions(&self.last, &SVector::zeros()) {
            let costate = self.stages.last().map_or(SVector::zeros(), |stage| stage.next_costate);
            for part in self.multipliers(&self.end(), &costate).component_mul(&conditions.by_time).iter() {
                slope += *part * T::from_f64(steps as f64);
                size += part.abs() * T::from_f64(steps as f64);
            }
        }
        let pushed = self.stages.iter().any(|stage| (0..C).any(|i| stage.limits.pushes(i)));
        let prepared = if pushed { Some((system.prepare(h + apart)?, system.prepare(h - apart)?)) } else { None };
        for (index, stage) in self.stages.iter().enumerate() {
            let t = self.problem.time_after(index);
            let k = T::from_f64(index as f64);
            let (x, u, z) = (&stage.place, &stage.input, &stage.limits.multipliers);
            let by_time = |constants: &_| system.price_of_time(constants, t, k, x, u, &stage.next_costate);
            let mut part = constants.at(&stage.reference, by_time)?;
            if let Some((longer, shorter)) = &prepared {
                let later = third * (t.abs() + h);
                let bounds = |constants: &S::Constants, t: T| {
                    constants.at(&stage.reference, |constants| system.bounds(constants, t, x, u))
                };
                let prices = |constants: &S::Constants, t: T| {
                    constants.at(&stage.reference, |constants| system.bound_prices(constants, t))
                };
                let by_time = (bounds(constants, t + later)? - bounds(constants, t - later)?) / (later + later);
                let by_step = (bounds(longer, t)? - bounds(shorter, t)?) / (apart + apart);
                // the price w of soft bounds may change too, by dw each unit by which they are violated
                let dearer_by_time = (prices(constants, t + later) - prices(constants, t - later)) / (later + later);
                let dearer_by_step = (prices(longer, t) - prices(shorter, t)) / (apart + apart);
                for i in (0..C).filter(|i| stage.limits.pushes(*i)) {
                    let violated = stage.limits.excess_of_soft(i);
                    part += z[i] * (k * by_time[i] + by_step[i]);
                    if violated > T::zero() {
                        part += violated * (k * dearer_by_time[i] + dearer_by_step[i]);
                    }
                }
            }
            slope += part;
            size += part.abs();
        }
        Ok((slope, size))
    }
}
