//! Methods: the ways in which one system is stepped.

use crate::constraint::Violation;
use crate::scheme::Scheme;
use crate::{Clebsch, Error, Space};
use core::fmt::Debug;

/// A way to step the system S: an order, a discretization, and how a step is computed.
///
/// Every system has one, [`Declared`], the dials of its declaration. Others have names, unit structs of the user:
///
/// ```
/// use clebsch::{Clebsch, Method};
/// use nalgebra::{Matrix3, Vector3};
///
/// /// Steps of order 6 whose drift is exact.
/// pub struct Fine;
///
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action     = |F: SO<3>, R: SO<3>| R * F,
///     lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
///     potential  = |R| self.weight * (R * self.center).z,
///     method Fine = (order = 6, discretization = exact),
/// )]
/// pub struct HeavyTop {
///     /// Principal moments of inertia, kg·m².
///     pub moments: Vector3<f64>,
///     /// Newtons.
///     pub weight: f64,
///     /// Centre of mass in the body frame, metres.
///     pub center: Vector3<f64>,
/// }
///
/// let top = HeavyTop { moments: Vector3::new(2.0, 2.0, 1.0), weight: 3.0, center: Vector3::z() };
/// let coarse = top.stepper(0.01)?; // order 2, as declared
/// let fine = top.stepper_by::<Fine>(0.01)?;
/// let start = coarse.state(Matrix3::identity(), Vector3::new(0.1, 0.0, 9.0))?;
/// let late = fine.advance(&fine.state_of(&coarse, &start)?, 100)?;
/// assert!((fine.energy(&late) - fine.energy(&fine.state_of(&coarse, &start)?)).abs() < 1e-10);
/// assert_eq!(<Fine as Method<HeavyTop>>::ORDER, 6);
/// # Ok::<(), clebsch::Error>(())
/// ```
///
/// The action, the momentum map, the potential and the conserved momenta are those of the system. The discrete
/// Lagrangian and its Legendre transforms belong to a method. `#[derive(Clebsch)]` implements this trait for the struct
/// of each key `method`, with defaults for the dials that it does not name.
pub trait Method<S: Clebsch>: Sized {
    /// The constants of all steps of one size, computed once per stepper.
    type Constants: Clone + Debug;
    /// How a step is made of its parts.
    #[doc(hidden)]
    type Scheme: Scheme<S, Self>;

    /// Order of accuracy of a step, as [`Clebsch::ORDER`].
    const ORDER: u32;
    /// Whether a step is the free motion itself, as [`Clebsch::IS_FREE_MOTION`].
    const IS_FREE_MOTION: bool = false;
    /// The derivation of the steps, as [`Clebsch::DERIVATION`].
    const DERIVATION: &'static str;

    /// Checks the parameters and computes the constants.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotSymmetric`], [`Error::SingularKineticEnergy`] or [`Error::IndefiniteKineticEnergy`].
    fn constants(system: &S, h: S::Scalar) -> Result<Self::Constants, Error>;

    /// The discrete Legendre transform F⁻ℓd, as [`Clebsch::legendre`].
    fn legendre(system: &S, h: S::Scalar, t: S::Scalar, q: &S::Configuration, f: &S::Element) -> S::Momentum;

    /// The discrete Legendre transform F⁺ℓd, as [`Clebsch::legendre_next`].
    fn legendre_next(system: &S, h: S::Scalar, t: S::Scalar, q: &S::Configuration, f: &S::Element) -> S::Momentum;

    /// By how much the momentum of a state is ahead of that of its configuration, as [`Clebsch::stagger`]. 0 as provided.
    #[allow(unused_variables, reason = "provided methods take what others need")]
    fn stagger(system: &S, h: S::Scalar, t: S::Scalar, q: &S::Configuration) -> S::Momentum {
        S::Momentum::origin()
    }

    /// The configuration on the constraint, as [`Clebsch::placed`].
    #[doc(hidden)]
    #[allow(unused_variables, reason = "provided methods take what others need")]
    fn placed(
        system: &S,
        constants: &Self::Constants,
        t: S::Scalar,
        q: &S::Configuration,
    ) -> Result<S::Configuration, Error> {
        Ok(*q)
    }

    /// The violation of the constraint, as [`Clebsch::constraint_defect`].
    #[doc(hidden)]
    #[allow(unused_variables, reason = "provided methods take what others need")]
    fn constraint_defect(
        system: &S,
        constants: &Self::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> Result<Violation<S::Scalar>, Error> {
        Ok(Violation::none())
    }

    /// The momentum on the constraint, as [`Clebsch::constrained`].
    #[doc(hidden)]
    #[allow(unused_variables, reason = "provided methods take what others need")]
    fn constrained(
        system: &S,
        constants: &Self::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> Result<S::Momentum, Error> {
        Ok(*mu)
    }

    /// The kinetic energy of a momentum, as [`Clebsch::kinetic_energy`].
    fn kinetic_energy(
        system: &S,
        constants: &Self::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> S::Scalar;
}

/// The method of every system: the dials of its declaration.
///
/// ```
/// # use clebsch::{Clebsch, Declared, Stepper};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// let stepper: Stepper<Particle, Declared> = Particle { mass: 2.0 }.into_stepper(0.5)?; // `Stepper<Particle>` for short
/// assert_eq!(stepper.step_size(), 0.5);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Declared;

impl<S: Clebsch> Method<S> for Declared {
    type Constants = S::Constants;
    type Scheme = S::Scheme;

    const ORDER: u32 = S::ORDER;
    const IS_FREE_MOTION: bool = S::IS_FREE_MOTION;
    const DERIVATION: &'static str = S::DERIVATION;

    #[inline]
    fn constants(system: &S, h: S::Scalar) -> Result<S::Constants, Error> {
        system.constants(h)
    }

    #[inline]
    fn legendre(system: &S, h: S::Scalar, t: S::Scalar, q: &S::Configuration, f: &S::Element) -> S::Momentum {
        system.legendre(h, t, q, f)
    }

    #[inline]
    fn legendre_next(system: &S, h: S::Scalar, t: S::Scalar, q: &S::Configuration, f: &S::Element) -> S::Momentum {
        system.legendre_next(h, t, q, f)
    }

    #[inline]
    fn stagger(system: &S, h: S::Scalar, t: S::Scalar, q: &S::Configuration) -> S::Momentum {
        system.stagger(h, t, q)
    }

    #[inline]
    fn placed(
        system: &S,
        constants: &S::Constants,
        t: S::Scalar,
        q: &S::Configuration,
    ) -> Result<S::Configuration, Error> {
        system.placed(constants, t, q)
    }

    #[inline]
    fn constraint_defect(
        system: &S,
        constants: &S::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> Result<Violation<S::Scalar>, Error> {
        system.constraint_defect(constants, t, q, mu)
    }

    #[inline]
    fn constrained(
        system: &S,
        constants: &S::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> Result<S::Momentum, Error> {
        system.constrained(constants, t, q, mu)
    }

    #[inline]
    fn kinetic_energy(
        system: &S,
        constants: &S::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> S::Scalar {
        system.kinetic_energy(constants, t, q, mu)
    }
}
