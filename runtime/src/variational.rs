//! The part of a discrete Lagrangian that the calculus of variations needs: its Legendre transforms with their
//! derivatives.

use crate::parts::Varied;
use crate::scheme::edges::{AtFixedElement, ByQuantities, Drift, Edges, FirstDerivatives, SecondDerivatives};
use crate::scheme::{At, Constants};
use crate::steered::no_endpoint;
use crate::{Clebsch, EndpointExpansion, Error, Method};
use nalgebra::{SMatrix, SVector};

/// A system whose discrete Lagrangian has been differentiated twice, by `#[derive(Clebsch)]` with `emit = [tangent]` or `emit = [boundary]`.
///
/// A *path* is a sequence of configurations q_{k+1} = Φ_{F_k}(q_k) with *edges* k, [`EDGES`](Self::EDGES) in a step.
/// Its vertices are varied along the orbits, q_k ↦ Φ_{exp η_k}(q_k) with η_k in 𝔤, and F_k follows. For a left action
/// F_k ↦ exp(η_{k+1}) F_k exp(−η_k), for a right one F_k ↦ exp(−η_k) F_k exp(η_{k+1}). An edge is given by the
/// increment D = F − I (for translations F itself), which small steps do not cancel.
///
/// With a constraint an edge is that of ℓd alone, without the force of the constraint; derivatives of steps have it.
///
/// Components of η are those of 𝔤 in the basis that [`group`](crate::group) documents, M of them.
///
/// ```
/// # use clebsch::{Clebsch, Variational};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [tangent],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// let spring = Spring { mass: 2.0, stiffness: 8.0 };
/// assert_eq!(Spring::EDGES, 1);
/// assert_eq!(spring.advance(&Vector1::new(0.5), &Vector1::new(0.25)).x, 0.75);
/// assert_eq!(spring.orbit_metric(&Vector1::new(0.5)).x, 1.0);
/// ```
#[diagnostic::on_unimplemented(
    message = "the discrete Lagrangian of `{Self}` has no second derivatives",
    note = "write `emit = [tangent]` in the declaration for derivatives of steps, `emit = [boundary]` for fixed endpoints"
)]
pub trait Variational<const M: usize>:
    Clebsch<Momentum = SVector<<Self as Clebsch>::Scalar, M>, Scheme: Edges<Self, M>>
{
    /// The number of edges in a step: 2 if a discrete Lagrangian is composed with its adjoint, else 1. A composed step
    /// has the edges of all its steps.
    const EDGES: usize = <Self::Scheme as Edges<Self, M>>::EDGES;
    /// Whether a constraint acts in steps.
    #[doc(hidden)]
    const IS_CONSTRAINED: bool = false;

    /// The increments of τ(η) and τ(−η), which share most terms: τ(0) = I, dτ = id there, and τ(−η) = τ(η)⁻¹ for Cayley's map and the exponential.
    fn retractions(&self, eta: &Self::Momentum) -> [Self::Element; 2];

    /// The increment of τ(η).
    #[inline]
    fn retraction(&self, eta: &Self::Momentum) -> Self::Element {
        let [ahead, _] = self.retractions(eta);
        ahead
    }

    /// The increment of the motion by `d` and after it by `second`, of both as increments.
    fn compose(&self, d: &Self::Element, second: &Self::Element) -> Self::Element;

    /// The configuration Φ_F(q) that F = I + D moves q to.
    fn advance(&self, q: &Self::Configuration, d: &Self::Element) -> Self::Configuration;

    /// The increment D of the group element with F⁻ℓd(q, F) = μ on an edge: its implicit solve.
    ///
    /// # Errors
    /// Those of [`Stepper::inverse_legendre`](crate::Stepper::inverse_legendre).
    #[inline]
    fn drift(
        &self,
        constants: &Constants<Self>,
        edge: usize,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
        u: &Self::Input,
    ) -> Result<Self::Element, Error> {
        Self::Scheme::visit(At::new(self, constants, t), edge, Drift(q, mu, u))
    }

    /// The edge k < [`EDGES`](Self::EDGES) of a step that starts at the time `t`, from q to q⁺ = Φ_F(q) while the input of forces is u.
    #[inline]
    fn edge(&self, c: &Constants<Self>, k: usize, t: Self::Scalar, ends: Ends<'_, Self>) -> Edge<Self::Scalar, M> {
        Self::Scheme::visit(At::new(self, c, t), k, SecondDerivatives(ends))
    }

    /// [`edge`](Self::edge) without derivatives of the momenta.
    #[inline]
    fn momenta(
        &self,
        c: &Constants<Self>,
        k: usize,
        t: Self::Scalar,
        ends: Ends<'_, Self>,
    ) -> Momenta<Self::Scalar, M> {
        Self::Scheme::visit(At::new(self, c, t), k, FirstDerivatives(ends))
    }

    /// The derivatives of the same edge along motions of q that leave F as it is, and of q⁺ alone. Nothing of the size
    /// of inertia/h cancels.
    #[inline]
    fn carried(
        &self,
        c: &Constants<Self>,
        k: usize,
        t: Self::Scalar,
        ends: Ends<'_, Self>,
    ) -> Carried<Self::Scalar, M> {
        Self::Scheme::visit(At::new(self, c, t), k, AtFixedElement(ends))
    }

    /// φ(t, q), the price of the end, with its derivatives along motions of q; 0 where no `endpoint` is declared.
    #[inline]
    fn endpoint(&self, _t: Self::Scalar, _q: &Self::Configuration) -> EndpointExpansion<Self::Scalar, M> {
        no_endpoint()
    }

    /// ξ_Q(q), the velocity of q that moves along exp(sξ), at s = 0.
    fn infinitesimal_motion(&self, q: &Self::Configuration, xi: &Self::Momentum) -> Self::Configuration;

    /// GᵀG of the infinitesimal motion G: ξ ↦ ξ_Q(q): the metric that the space around Q induces on 𝔤. Its kernel is 𝔤_q.
    fn orbit_metric(&self, q: &Self::Configuration) -> SMatrix<Self::Scalar, M, M>;

    /// Gᵀ(target − q) = J(q, target − q), which vanishes where no motion of q along its orbit comes nearer to `target` to first order.
    fn approach(&self, q: &Self::Configuration, target: &Self::Configuration) -> Self::Momentum;
}

/// A method of a [`Variational`] system: all methods of a declaration with `emit = [tangent]` or `emit = [boundary]`.
///
/// ```
/// # use clebsch::{Clebsch, Declared, Differentiated};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [tangent],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// assert_eq!(<Declared as Differentiated<Spring, 1>>::EDGES, 1);
/// ```
#[diagnostic::on_unimplemented(
    message = "the steps by the method `{Self}` have no derivatives",
    note = "write `emit = [boundary]` or `emit = [tangent]` in the declaration; methods of order 16 and splittings have no derivatives"
)]
pub trait Differentiated<S: Clebsch, const M: usize>: Method<S, Scheme: Edges<S, M, Self>> {
    /// The number of edges in a step, as [`Variational::EDGES`].
    const EDGES: usize = <Self::Scheme as Edges<S, M, Self>>::EDGES;
}

#[diagnostic::do_not_recommend]
impl<S: Clebsch, B: Method<S, Scheme: Edges<S, M, B>>, const M: usize> Differentiated<S, M> for B {}

/// q, F − I, q⁺ and u: the ends of an edge, the increment between them, and the input of its forces.
///
/// ```
/// # use clebsch::{Clebsch, Ends};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [tangent],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// let (q, d, next) = (Vector1::new(0.0), Vector1::new(1.0), Vector1::new(1.0));
/// let ends: Ends<'_, Spring> = (&q, &d, &next, &());
/// assert_eq!(ends.0 + ends.1, *ends.2);
/// ```
pub type Ends<'a, S> = (
    &'a <S as Clebsch>::Configuration,
    &'a <S as Clebsch>::Element,
    &'a <S as Clebsch>::Configuration,
    &'a <S as Clebsch>::Input,
);

/// The discrete Lagrangian ℓd of an edge with its first two derivatives along the motions η of its start and η′ of its end.
///
/// dℓd = F⁺ℓd·η′ − F⁻ℓd·η, kicks included, with F⁻ℓd = N_k and F⁺ℓd = N_{k+1}. On an extremal F⁺ℓd of each edge is F⁻ℓd of the next.
///
/// ```
/// # use clebsch::{Clebsch, Variational};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [tangent],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// # let spring = Spring { mass: 2.0, stiffness: 8.0 };
/// # let h = 0.5;
/// let (q, d, next) = (Vector1::new(0.0), Vector1::new(1.0), Vector1::new(1.0));
/// let edge = spring.edge(&spring.constants(h)?, 0, 0.0, (&q, &d, &next, &()));
/// assert_eq!(edge.before.x, 4.0); // m d/h, without a kick at q = 0
/// assert_eq!(edge.after.x, 2.0); // m d/h − h k q⁺/2
/// assert_eq!(edge.before_by_end.x, 4.0); // m/h
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge<T, const M: usize> {
    /// ℓd(t, h, q, F)
    pub lagrangian: T,
    /// F⁻ℓd, the momentum at the start.
    pub before: SVector<T, M>,
    /// F⁺ℓd, the momentum at the end.
    pub after: SVector<T, M>,
    /// ∂F⁻ℓd/∂η, column j its derivative along E_j. Not symmetric where there is momentum: Φ_{exp η} is no second derivative.
    pub before_by_start: SMatrix<T, M, M>,
    /// ∂F⁻ℓd/∂η′
    pub before_by_end: SMatrix<T, M, M>,
    /// ∂F⁺ℓd/∂η = −(∂F⁻ℓd/∂η′)ᵀ, for motions of different vertices commute.
    pub after_by_start: SMatrix<T, M, M>,
    /// ∂F⁺ℓd/∂η′
    pub after_by_end: SMatrix<T, M, M>,
}

/// The discrete Lagrangian ℓd of an edge with its Legendre transforms.
///
/// ```
/// # use clebsch::{Clebsch, Variational};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [tangent],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// # let spring = Spring { mass: 2.0, stiffness: 8.0 };
/// # let h = 0.5;
/// let (q, d, next) = (Vector1::new(0.0), Vector1::new(1.0), Vector1::new(1.0));
/// let momenta = spring.momenta(&spring.constants(h)?, 0, 0.0, (&q, &d, &next, &()));
/// assert_eq!((momenta.before.x, momenta.after.x), (4.0, 2.0));
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momenta<T, const M: usize> {
    /// ℓd(t, h, q, F)
    pub lagrangian: T,
    /// F⁻ℓd, the momentum at the start.
    pub before: SVector<T, M>,
    /// F⁺ℓd, the momentum at the end.
    pub after: SVector<T, M>,
}

/// An edge with the derivatives of its momenta along the motions of its start that carry its end along.
///
/// ```
/// # use clebsch::{Clebsch, Variational};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [tangent],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// # let spring = Spring { mass: 2.0, stiffness: 8.0 };
/// # let h = 0.5;
/// let (q, d, next) = (Vector1::new(0.0), Vector1::new(1.0), Vector1::new(1.0));
/// let carried = spring.carried(&spring.constants(h)?, 0, 0.0, (&q, &d, &next, &()));
/// assert_eq!(carried.adjoint.x, 1.0); // translations commute
/// assert_eq!(carried.momentum.x, 2.0);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried<T, const M: usize> {
    /// F⁺ℓd, the momentum at the end.
    pub momentum: SVector<T, M>,
    /// η ↦ η′: Ad_F for a left action, Ad_{F⁻¹} for a right one.
    pub adjoint: SMatrix<T, M, M>,
    /// ∂F⁻ℓd/∂η at fixed F: of potentials, forces and costs that couple; else 0.
    pub before: SMatrix<T, M, M>,
    /// ∂F⁺ℓd/∂η at fixed F.
    pub after: SMatrix<T, M, M>,
    /// ∂F⁻ℓd/∂η′
    pub before_by_end: SMatrix<T, M, M>,
    /// ∂F⁺ℓd/∂η′
    pub after_by_end: SMatrix<T, M, M>,
}

/// The derivatives of F⁻ℓd and of F⁺ℓd, one column for each quantity.
type BothSlopes<T, const M: usize, const P: usize> = (SMatrix<T, M, P>, SMatrix<T, M, P>);

/// A system whose steps have been differentiated by P quantities, all that a step fixes. Implemented by `#[derive(Clebsch)]` with `emit = [tangent]`.
///
/// ```
/// # use clebsch::{Clebsch, Sensitive};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [tangent],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// assert_eq!(Spring::QUANTITIES, ["mass", "stiffness", "h"]);
/// ```
#[diagnostic::on_unimplemented(
    message = "the steps of `{Self}` have no derivatives by their parameters",
    note = "write `emit = [tangent]` in the declaration"
)]
pub trait Sensitive<const M: usize, const P: usize>:
    Variational<M> + Varied<M, Slopes = BothSlopes<<Self as Clebsch>::Scalar, M, P>>
{
    /// The quantities as a declaration writes them, without `self.`. The entries of the fields that closures read come
    /// first, in their order and row by row. Then follow `h`, `t` if the time matters, and the entries of the input.
    /// The two entries of a symmetric matrix are one quantity.
    const QUANTITIES: [&'static str; P];
    /// The column of h.
    #[doc(hidden)]
    const STEP_SIZE: Option<usize> = None;
    /// The column of t.
    #[doc(hidden)]
    const TIME: Option<usize> = None;

    /// The derivatives of F⁻ℓd and of F⁺ℓd of an edge, at fixed q, F and q⁺; one column for each quantity.
    #[inline]
    fn edge_slopes(
        &self,
        c: &Constants<Self>,
        k: usize,
        t: Self::Scalar,
        ends: Ends<'_, Self>,
    ) -> BothSlopes<Self::Scalar, M, P> {
        let slopes = Self::Scheme::visit(At::new(self, c, t), k, ByQuantities(ends));
        let of_step = |slopes| Self::Scheme::slopes_of_step(c, k, slopes, (Self::STEP_SIZE, Self::TIME));
        (of_step(slopes.0), of_step(slopes.1))
    }
}
