//! The trait of systems whose inputs are chosen, which `#[derive(Clebsch)]` implements: one step, its price, its
//! bounds, and their derivatives.

use crate::{Control, Error, Known, Real, Referenced, Scalar, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::Zero;

/// A system whose inputs are chosen. The step is x⁺ = f(t, h, x, u) at the price ℓ(t, h, x, u). The bounds are a(t, h,
/// x, u) ≤ 0, or = 0 for the first ones, and the end has the price φ(t, x).
///
/// D is the dimension of places x, U that of inputs u, C the number of bounds. `#[derive(Clebsch)]` implements it for a
/// struct with `controls` or `dynamics`, where x is the configuration. With `effort`, x is a state (q, N) and f the
/// forced step. Price and bounds may then take the velocity ξ(F)/h of the step, and the price of the end that of the
/// momentum there, Σ⁻¹N.
///
/// # Coordinates
/// Small changes of a place are written as δ of D components. For a configuration, δ is the motion η of the group that
/// moves q to Φ_{exp η}(q). For a group that acts on itself this is q exp η or (exp η) q. For a state it is (η, ν),
/// with N + ν. Second derivatives are those along s ↦ Φ_{exp sη}(q).
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
/// let cart = Cart { strongest: 8.0, price: 0.0 };
/// assert_eq!(Cart::BOUNDS, ["u.x <= self.strongest"]);
/// let constants = cart.prepare(0.1)?;
/// assert_eq!(cart.bounds(&constants, 0.0, &Vector2::zeros(), &Vector1::new(9.0))?.x, 1.0); // violated by 1
/// let control = cart.control(0.1)?;
/// assert_eq!(control.follow(&Vector2::new(1.0, 2.0), &Vector1::new(5.0))?, Vector2::new(1.2, 2.5));
/// # Ok::<(), clebsch::Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no inputs to choose",
    note = "write `effort = |h, u| h * u.norm_squared() / 2` in a declaration with a force that has an input, or declare `controls` or `dynamics` with a `cost`"
)]
pub trait Controlled<const D: usize, const U: usize, const C: usize>: Sized {
    /// The scalar.
    type Scalar: Scalar;
    /// The place that inputs steer.
    type Place: Space<Self::Scalar>;
    /// The constants, which no step changes, and the references of motions, prices and bounds.
    type Constants: Referenced<Self::Scalar>;

    /// The name of the struct.
    const NAME: &'static str;
    /// The bounds as they were written.
    const BOUNDS: [&'static str; C];
    /// The number of equations among the bounds, the first ones: these ask for a = 0.
    const EQUAL_BOUNDS: usize = 0;
    /// The number of components, the first ones, that move the configuration; the others, if any, change the momentum.
    const MOTIONS: usize;
    /// The conditions that `target` declares for the end, as they were written: equations, and inequalities after them. There are at most D.
    const TARGET: &'static [&'static str] = &[];
    /// The number of equations among them.
    const EQUATIONS: usize = 0;

    /// Checks the parameters and computes the constants.
    ///
    /// # Errors
    /// As [`Clebsch::constants`](crate::Clebsch::constants).
    fn prepare(&self, h: Self::Scalar) -> Result<Self::Constants, Error>;

    /// Whether a place is finite and where places are.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OffOrbit`], [`Error::OutsideMomentumSpace`].
    fn check_place(&self, x: &Self::Place) -> Result<(), Error>;

    /// Whether steps read references; if they do not, [`follow`](Self::follow) is called with any.
    #[doc(hidden)]
    const REFERS_IN_STEPS: bool = true;
    /// Whether a constraint acts in steps.
    #[doc(hidden)]
    const IS_CONSTRAINED: bool = false;

    /// Whether a place obeys the constraint at the time t, with its momentum or without; every place as provided.
    ///
    /// # Errors
    /// [`Error::OffConstraint`], [`Error::ConstraintViolated`], [`Error::DependentConstraints`].
    #[doc(hidden)]
    fn check_constraint(
        &self,
        _constants: &Self::Constants,
        _t: Self::Scalar,
        _x: &Self::Place,
        _moves: bool,
    ) -> Result<(), Error> {
        Ok(())
    }

    /// A place that obeys the constraint at the time t, next to a place; x itself as provided, and where there is none nearby.
    #[doc(hidden)]
    fn constrained_place(&self, _constants: &Self::Constants, _t: Self::Scalar, x: &Self::Place) -> Self::Place {
        *x
    }

    /// The projector to the changes of a place that a constraint allows at the time t; `None` as provided, where all are allowed.
    #[doc(hidden)]
    fn tangent_projector(
        &self,
        _constants: &Self::Constants,
        _t: Self::Scalar,
        _x: &Self::Place,
    ) -> Option<SMatrix<Self::Scalar, D, D>> {
        None
    }

    /// The projector to independent changes of a place under a constraint at the time t, as many as it allows. Each change is in units of
    /// one by its length. `None` as provided, where all changes are independent.
    #[doc(hidden)]
    fn independent(
        &self,
        _constants: &Self::Constants,
        _t: Self::Scalar,
        _x: &Self::Place,
        _lengths: &SVector<Self::Scalar, D>,
    ) -> Option<SMatrix<Self::Scalar, D, D>> {
        None
    }

    /// The system with the step size `h`, checked, to solve problems of optimal control with.
    ///
    /// ```text
    /// let control = system.control(0.1)?;
    /// let mut plan = [control.stage(&start); 50];
    /// let optimum = control.solve(&start, Target::Place(goal), &mut plan)?;
    /// ```
    ///
    /// # Errors
    /// [`Error::StepSize`], and those of [`prepare`](Self::prepare).
    fn control(self, h: Self::Scalar) -> Result<Control<Self, D, U, C>, Error>
    where
        Self::Scalar: Real,
    {
        if !h.is_finite() || h == Self::Scalar::zero() {
            return Err(Error::StepSize { value: h.to_f64() });
        }
        let constants = self.prepare(h)?;
        Ok(Control { system: self, step_size: h, constants, time: Self::Scalar::zero(), beginning: Known })
    }

    /// x⁺ = f(t, h, x, u)
    ///
    /// # Errors
    /// Those of a step.
    fn follow(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        x: &Self::Place,
        u: &SVector<Self::Scalar, U>,
    ) -> Result<Self::Place, Error>;

    /// ℓ(t, h, x, u), smooth: without the kinks that [`bound_prices`](Self::bound_prices) tells.
    ///
    /// # Errors
    /// Those of a step, where the price takes its velocity.
    fn price(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        x: &Self::Place,
        u: &SVector<Self::Scalar, U>,
    ) -> Result<Self::Scalar, Error>;

    /// The step with its derivatives, and the second derivatives of ℓ + λ·f, λ the costate at x⁺.
    ///
    /// # Errors
    /// Those of a step.
    fn expand(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        x: &Self::Place,
        u: &SVector<Self::Scalar, U>,
        costate: &SVector<Self::Scalar, D>,
    ) -> Result<Expansion<Self::Place, Self::Scalar, D, U>, Error>;

    /// d/dh (ℓ + λ·f) for a step that starts at the time t = t₀ + kh, which moves with h.
    ///
    /// # Errors
    /// Those of a step.
    fn price_of_time(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        k: Self::Scalar,
        x: &Self::Place,
        u: &SVector<Self::Scalar, U>,
        costate: &SVector<Self::Scalar, D>,
    ) -> Result<Self::Scalar, Error>;

    /// a(t, h, x, u). No entry is positive if the bounds are satisfied, and those of equations vanish.
    ///
    /// # Errors
    /// Those of a step, where bounds take its velocity.
    fn bounds(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        x: &Self::Place,
        u: &SVector<Self::Scalar, U>,
    ) -> Result<SVector<Self::Scalar, C>, Error>;

    /// w: the price of a unit of each bound by which it is violated; infinite for bounds that have to hold. It is ℓ without Σ w max(a, 0) that
    /// [`price`](Self::price) gives.
    fn bound_prices(&self, _constants: &Self::Constants, _t: Self::Scalar) -> SVector<Self::Scalar, C> {
        SVector::from_element(Self::Scalar::from_f64(f64::INFINITY))
    }

    /// a with its derivatives, and the second derivatives of z·a.
    ///
    /// # Errors
    /// Those of a step, where bounds take its velocity.
    fn bounds_expanded(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        x: &Self::Place,
        u: &SVector<Self::Scalar, U>,
        multipliers: &SVector<Self::Scalar, C>,
    ) -> Result<BoundsExpansion<Self::Scalar, D, U, C>, Error>;

    /// φ(t, x), 0 where no `endpoint` is declared.
    fn endpoint(&self, constants: &Self::Constants, t: Self::Scalar, x: &Self::Place) -> Self::Scalar;

    /// φ with its derivatives.
    fn endpoint_expanded(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        x: &Self::Place,
    ) -> EndpointExpansion<Self::Scalar, D>;

    /// The conditions that `target` declares for the end, with their derivatives, and the second derivatives of ν·g.
    fn target_expanded(
        &self,
        _constants: &Self::Constants,
        _t: Self::Scalar,
        _x: &Self::Place,
        _multipliers: &SVector<Self::Scalar, D>,
    ) -> TargetExpansion<Self::Scalar, D> {
        TargetExpansion::none()
    }

    /// The difference between x and a target. With the motions G: η ↦ η_Q(q) it has the residual Gᵀ(q* − q) and the
    /// slope GᵀG; for momenta these are N* − N and I. A small change δ with slope·δ = residual goes there.
    fn arrival(&self, x: &Self::Place, target: &Self::Place) -> Arrival<Self::Scalar, D>;

    /// The small change δ that moves x to y, to first order; the shortest where several do.
    fn displacement(&self, x: &Self::Place, y: &Self::Place) -> SVector<Self::Scalar, D>;

    /// The place that a small change δ moves x to: Φ_{τ(η)}(q), and N + ν. The retraction τ is Cayley's map
    /// where that stays in the group, else the exponential.
    fn moved(&self, x: &Self::Place, delta: &SVector<Self::Scalar, D>) -> Self::Place;

    /// The velocity of x along a small change δ: η_Q(q), and ν.
    fn infinitesimal_motion(&self, x: &Self::Place, delta: &SVector<Self::Scalar, D>) -> Self::Place;
}

/// A step with its derivatives: x⁺ changes by A δ + B δu.
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
/// let cart = Cart { strongest: 8.0, price: 0.0 };
/// let constants = cart.prepare(0.1)?;
/// let step = cart.expand(&constants, 0.0, &Vector2::zeros(), &Vector1::new(3.0), &Vector2::zeros())?;
/// assert_eq!(step.by_place[(0, 1)], 0.1); // x⁺ = x + h v
/// assert_eq!(step.by_input[(1, 0)], 0.1); // v⁺ = v + h u
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expansion<X, T, const D: usize, const U: usize> {
    /// x⁺
    pub next: X,
    /// A
    pub by_place: SMatrix<T, D, D>,
    /// B
    pub by_input: SMatrix<T, D, U>,
    /// ℓ
    pub price: T,
    /// ∂ℓ/∂x
    pub price_by_place: SVector<T, D>,
    /// ∂ℓ/∂u
    pub price_by_input: SVector<T, U>,
    /// ∂²(ℓ + λ·f)/∂x²
    pub place_curvature: SMatrix<T, D, D>,
    /// ∂²(ℓ + λ·f)/∂u∂x
    pub mixed_curvature: SMatrix<T, U, D>,
    /// ∂²(ℓ + λ·f)/∂u²
    pub input_curvature: SMatrix<T, U, U>,
}

/// Bounds a ≤ 0, or a = 0, with their derivatives.
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
/// # let cart = Cart { strongest: 8.0, price: 0.0 };
/// let constants = cart.prepare(0.1)?;
/// let bounds = cart.bounds_expanded(&constants, 0.0, &Vector2::zeros(), &Vector1::new(3.0), &Vector1::new(1.0))?;
/// assert_eq!((bounds.values.x, bounds.by_input.x), (-5.0, 1.0));
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundsExpansion<T, const D: usize, const U: usize, const C: usize> {
    /// a
    pub values: SVector<T, C>,
    /// ∂a/∂x
    pub by_place: SMatrix<T, C, D>,
    /// ∂a/∂u
    pub by_input: SMatrix<T, C, U>,
    /// ∂²(z·a)/∂x²
    pub place_curvature: SMatrix<T, D, D>,
    /// ∂²(z·a)/∂u∂x
    pub mixed_curvature: SMatrix<T, U, D>,
    /// ∂²(z·a)/∂u²
    pub input_curvature: SMatrix<T, U, U>,
}

/// The price of the end with its derivatives.
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
/// let cart = Cart { strongest: 8.0, price: 10.0 };
/// let end = cart.endpoint_expanded(&cart.prepare(0.1)?, 0.0, &Vector2::new(1.0, 2.0));
/// assert_eq!((end.price, end.slope), (25.0, Vector2::new(10.0, 20.0)));
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndpointExpansion<T, const D: usize> {
    /// φ
    pub price: T,
    /// ∂φ/∂t
    pub by_time: T,
    /// ∂φ/∂x
    pub slope: SVector<T, D>,
    /// ∂²φ/∂x²
    pub curvature: SMatrix<T, D, D>,
}

/// The conditions g = a − b of the end with their derivatives: equations g = 0, and inequalities g ≤ 0 after them. Entries beyond them are 0.
///
/// ```
/// # use clebsch::{Clebsch, Controlled};
/// # use nalgebra::Vector2;
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
///     cost     = |h, u| h * u.norm_squared() / 2,
///     target   = |x| [x.x == self.place, x.y <= self.fastest],
/// )]
/// struct Cart { place: f64, fastest: f64 }
///
/// let cart = Cart { place: 1.0, fastest: 0.5 };
/// assert_eq!(Cart::TARGET, ["x.x == self.place", "x.y <= self.fastest"]);
/// let end = cart.target_expanded(&cart.prepare(0.1)?, 0.0, &Vector2::new(3.0, 2.0), &Vector2::zeros());
/// assert_eq!(end.values, Vector2::new(2.0, 1.5));
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetExpansion<T, const D: usize> {
    /// g
    pub values: SVector<T, D>,
    /// |a| + |b|
    pub sizes: SVector<T, D>,
    /// ∂g/∂t
    pub by_time: SVector<T, D>,
    /// ∂g/∂x, a row for each condition.
    pub slope: SMatrix<T, D, D>,
    /// ∂²(ν·g)/∂x²
    pub curvature: SMatrix<T, D, D>,
}

impl<T: Scalar, const D: usize> TargetExpansion<T, D> {
    /// No conditions.
    pub fn none() -> Self {
        let (zero, zeros) = (SVector::zeros(), SMatrix::zeros());
        Self { values: zero, sizes: zero, by_time: zero, slope: zeros, curvature: zeros }
    }
}

/// The difference between a place and a target.
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
/// # let cart = Cart { strongest: 8.0, price: 10.0 };
/// let arrival = cart.arrival(&Vector2::zeros(), &Vector2::new(1.0, 2.0));
/// let change = arrival.slope.try_inverse().unwrap() * arrival.residual;
/// assert_eq!(change, Vector2::new(1.0, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival<T, const D: usize> {
    /// Gᵀ(q* − q), N* − N
    pub residual: SVector<T, D>,
    /// GᵀG, I
    pub slope: SMatrix<T, D, D>,
}
