//! The trait that the derive macro implements.

use crate::constraint::Violation;
use crate::scheme::Scheme;
use crate::{Error, Method, Names, Scalar, Space, Stepper, Time};
use core::fmt::Debug;
use num_traits::Zero;

/// A mechanical or control system with everything that is derived from its declaration.
///
/// Implemented by `#[derive(Clebsch)]`; each generated method documents its formula as derived. Notation: configuration
/// q in Q, group element F in G, action Φ, momentum μ in the dual of the Lie algebra 𝔤. The step size is h, the time t,
/// and the discrete Lagrangian ℓd(t, h, q, F). Momenta are components m_i = ⟨M, E_i⟩ = tr(MᵀE_i) in the basis E_i of 𝔤
/// that [`group`](crate::group) documents, all factors of a product one after the other.
///
/// The time of a step, in [`legendre`](Self::legendre) and wherever h matters, is that of its start; elsewhere that of the configuration.
///
/// A [`Stepper`] holds h and the [`Constants`](Self::Constants). Items that depend on the dials are those of the
/// declared dials; see [`Method`] for others.
///
/// ```
/// use clebsch::Clebsch;
/// use nalgebra::Vector1;
///
/// /// A body on a spring.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action     = |a: Translation<1>, x: Vector1| x + a,
///     lagrangian = |v| self.mass * v.norm_squared() / 2,
///     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// )]
/// struct Spring {
///     /// Kilograms.
///     mass: f64,
///     /// Newtons per metre.
///     stiffness: f64,
/// }
///
/// let spring = Spring { mass: 2.0, stiffness: 8.0 };
/// let x = Vector1::new(0.5);
/// assert_eq!(spring.act(&Vector1::new(0.25), &x).x, 0.75);
/// assert_eq!(spring.potential(0.0, &x), 1.0);
/// assert!(Spring::DERIVATION.contains("discrete Lagrangian"));
/// ```
///
/// Source: Nordkvist, Crouch and Bloch, *Discrete Clebsch Optimal Control*, theorems 1 and 2.
#[allow(unused_variables, reason = "provided methods take what others need")]
pub trait Clebsch: Sized {
    /// The number type.
    type Scalar: Scalar;
    /// q, nested as in the declared action; `()` where the momentum is stepped alone, by `emit = [momentum]`.
    type Configuration: Space<Self::Scalar>;
    /// F, nested as in the declared action.
    type Element: Space<Self::Scalar>;
    /// μ: all components in one vector; of a power an array of those of each site.
    type Momentum: Space<Self::Scalar>;
    /// The representing matrices M = Σ G^{ij} m_j E_i, nested as `Element`; G_ij = tr(E_iᵀE_j).
    type MomentumMatrix: Space<Self::Scalar>;
    /// The input of forces during a step, `()` if they take none; the `u` of `force`.
    type Input: Space<Self::Scalar>;
    /// The constants of all steps of one size by the declared dials, computed once per stepper.
    type Constants: Clone + Debug;
    /// How it is stepped by the declared dials.
    #[doc(hidden)]
    type Scheme: Scheme<Self>;
    /// The time of a state: `()` for an autonomous system, else [`Clock`](crate::Clock).
    type Time: Time<Self::Scalar>;

    /// The name of the struct.
    const NAME: &'static str;
    /// The names of the configuration, as the declared action has them; `q` as provided.
    const CONFIGURATION_NAMES: Names = Names::One("q");
    /// Order of accuracy of a step. 4, 6 and 8 are composed of steps of second order; 16 collocates Hamilton's
    /// equations. Then [`legendre`](Self::legendre) and [`legendre_next`](Self::legendre_next) are the transforms of
    /// the declared step of second order.
    const ORDER: u32;
    /// Whether a step is the free motion itself, without an error in h: its longest step is then known without trying. `false` as provided.
    const IS_FREE_MOTION: bool = false;
    /// Whether rounding may move a configuration off its orbit in one step, as it may on groups that are not compact.
    /// Then every step checks [`orbit_defect`](Self::orbit_defect). `false` as provided.
    const MAY_LEAVE_ORBIT: bool = false;
    /// Whether the struct declares a site of a field, which is stepped on a lattice. `false` as provided.
    #[doc(hidden)]
    const IS_FIELD: bool = false;
    /// The derivation in words and formulas, with operation counts. With `emit = [latex]` there is a constant `DERIVATION_LATEX` too, for a paper.
    const DERIVATION: &'static str;

    /// Checks the parameters and computes the constants.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotSymmetric`], [`Error::SingularKineticEnergy`] or [`Error::IndefiniteKineticEnergy`].
    fn constants(&self, h: Self::Scalar) -> Result<Self::Constants, Error>;

    /// The action: Φ_F(q).
    fn act(&self, f: &Self::Element, q: &Self::Configuration) -> Self::Configuration;

    /// The momentum map of the cotangent lift: J(q, p)_i = ⟨p, (E_i)_Q(q)⟩.
    fn momentum_map(&self, q: &Self::Configuration, p: &Self::Configuration) -> Self::Momentum;

    /// The coadjoint action Ad*_F μ = (Ad_F)* μ, without an inverse inside.
    fn coadjoint(&self, f: &Self::Element, mu: &Self::Momentum) -> Self::Momentum;

    /// The discrete Legendre transform F⁻ℓd: the momentum N_k before the step that moves q by F.
    ///
    /// F is a rounded matrix, and F − I is known to ε only. So N is known to ε‖∂²ℓd/∂F²‖, at most about ε·inertia/h. That is in
    /// F itself, whatever the formula. Steps take D = F − I, without this loss.
    fn legendre(&self, h: Self::Scalar, t: Self::Scalar, q: &Self::Configuration, f: &Self::Element) -> Self::Momentum;

    /// The discrete Legendre transform F⁺ℓd: the momentum N_{k+1} after the step that moves q by F. It is known as
    /// [`legendre`](Self::legendre) is.
    fn legendre_next(
        &self,
        h: Self::Scalar,
        t: Self::Scalar,
        q: &Self::Configuration,
        f: &Self::Element,
    ) -> Self::Momentum;

    /// By how much the momentum N of a state is ahead of the momentum π at its configuration: N − π = ½ J(q, ∂(U₁ −
    /// U₀)). Here U₀(t, q) and U₁(t, q) are the terms that ℓd adds at the start and at the end of a step.
    ///
    /// −h/2 J(q, ∂V) with `order = 1`, half of the kick; else 0, and N is π. See [`Stepper::synchronized`](crate::Stepper::synchronized).
    fn stagger(&self, h: Self::Scalar, t: Self::Scalar, q: &Self::Configuration) -> Self::Momentum {
        Self::Momentum::origin()
    }

    /// The potential V(t, q), 0 for a free system.
    #[inline]
    fn potential(&self, t: Self::Scalar, q: &Self::Configuration) -> Self::Scalar {
        Zero::zero()
    }

    /// The Legendre–Fenchel transform of ℓ(q, ·): μ·ξ − ℓ(q, ξ) at the ξ with ∂ℓ/∂ξ = μ. Here ℓ(q, ξ) = lim ℓd(t, h, q,
    /// exp hξ)/h less its value at 0.
    ///
    /// ½ μ·Σ⁻¹μ where ℓ is quadratic with the Hessian Σ; +∞ where no velocity has this momentum.
    fn kinetic_energy(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
    ) -> Self::Scalar;

    /// Whether the kinetic energy ½ ξ·Σξ is positive at the configuration q and the time t, where its inertia Σ depends on them.
    ///
    /// The provided method accepts it: [`constants`](Self::constants) checks an inertia that is the same everywhere. With `signature = indefinite` nothing does.
    ///
    /// # Errors
    /// [`Error::IndefiniteKineticEnergy`].
    fn check_kinetic_energy(&self, t: Self::Scalar, q: &Self::Configuration) -> Result<(), Error> {
        Ok(())
    }

    /// The representing matrices of μ.
    fn momentum_matrix(mu: &Self::Momentum) -> Self::MomentumMatrix;

    /// The components of a momentum given by its representing matrices; the inverse of [`momentum_matrix`](Self::momentum_matrix).
    fn momentum_components(m: &Self::MomentumMatrix) -> Self::Momentum;

    /// By how much q violates the promise of the declaration, as the largest entry of |RᵀR − I| or ||q|² − 1|.
    ///
    /// Relative to ((1 + |F|²/n)/2)^(d/2) on groups that are not compact, where F is n×n and the equations have the degree d. Terms of
    /// equations grow as this does, and so does round-off.
    ///
    /// 0 for plain vectors and matrices, +∞ on the wrong component of a group (det < 0).
    #[inline]
    fn orbit_defect(&self, q: &Self::Configuration) -> Self::Scalar {
        Zero::zero()
    }

    /// The size of the component of μ outside of 𝔤_q^⊥, the momenta that motions of q can have.
    ///
    /// 0 where the action is free, and where the motions that fix q are declared to be motions (`isotropy = free`).
    #[inline]
    fn isotropy_defect(&self, q: &Self::Configuration, mu: &Self::Momentum) -> Self::Scalar {
        Zero::zero()
    }

    /// The momentum in 𝔤_q^⊥ whose components are nearest to those of μ, in the Euclidean distance.
    ///
    /// μ itself where [`isotropy_defect`](Self::isotropy_defect) is 0 for every momentum.
    #[inline]
    fn project_momentum(&self, q: &Self::Configuration, mu: &Self::Momentum) -> Self::Momentum {
        *mu
    }

    /// Whether q obeys the constraint of the declaration on places; accepted as provided.
    ///
    /// # Errors
    /// [`Error::OffConstraint`].
    #[doc(hidden)]
    fn check_place(&self, t: Self::Scalar, q: &Self::Configuration) -> Result<(), Error> {
        Ok(())
    }

    /// A configuration that obeys the constraint of the declaration on places, next to q; q as provided.
    ///
    /// # Errors
    /// [`Error::FarFromConstraint`], or [`Error::DependentConstraints`] where its rows depend on each other.
    #[doc(hidden)]
    fn placed(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
    ) -> Result<Self::Configuration, Error> {
        Ok(*q)
    }

    /// By how much the velocity of the momentum μ violates the constraint of the declaration: a Σ⁻¹μ − b. None as provided.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`] where its rows depend on each other.
    #[doc(hidden)]
    fn constraint_defect(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
    ) -> Result<Violation<Self::Scalar>, Error> {
        Ok(Violation::none())
    }

    /// The momentum μ + Aᵀκ whose velocity obeys the constraint of the declaration; μ as provided.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`] where its rows depend on each other.
    #[doc(hidden)]
    fn constrained(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
    ) -> Result<Self::Momentum, Error> {
        Ok(*mu)
    }

    /// A stepper of step size `h`, on a copy of this system.
    ///
    /// # Errors
    /// [`Error::StepSize`], and those of [`constants`](Self::constants).
    fn stepper(&self, h: Self::Scalar) -> Result<Stepper<Self>, Error>
    where
        Self: Clone,
    {
        self.clone().into_stepper(h)
    }

    /// A stepper of step size `h` that owns this system.
    ///
    /// # Errors
    /// [`Error::StepSize`], and those of [`constants`](Self::constants).
    fn into_stepper(self, h: Self::Scalar) -> Result<Stepper<Self>, Error> {
        const {
            assert!(
                !Self::IS_FIELD,
                "a field is stepped on a grid: write `field.grid([64]).spacing([0.1]).stepper(h)`, with a size and a spacing for each direction"
            );
        }
        Stepper::new(self, h)
    }

    /// A stepper of step size `h` by the method M, on a copy of this system; [`stepper`](Self::stepper) is that by the declared dials.
    ///
    /// # Errors
    /// [`Error::StepSize`], and those of [`Method::constants`].
    fn stepper_by<M: Method<Self>>(&self, h: Self::Scalar) -> Result<Stepper<Self, M>, Error>
    where
        Self: Clone,
    {
        self.clone().into_stepper_by(h)
    }

    /// A stepper of step size `h` by the method M that owns this system.
    ///
    /// # Errors
    /// [`Error::StepSize`], and those of [`Method::constants`].
    fn into_stepper_by<M: Method<Self>>(self, h: Self::Scalar) -> Result<Stepper<Self, M>, Error> {
        Stepper::new(self, h)
    }
}
