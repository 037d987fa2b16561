//! An edge of a step with a constraint. Its derivatives join those of ℓd, and the step is differentiated as one without.
//!
//! A step solves F⁻ℓd = N + A(q)ᵀλ with ψ(q, F) = 0. With S = A Σ⁻¹Aᵀ and P = AᵀS⁻¹ both say that
//!
//! ```text
//! Q (F⁻ℓd − Aᵀλ − N) + P ψ = 0,    Q = I − P A Σ⁻¹
//! ```
//! for fixed λ, as A Σ⁻¹Q = 0 and A Σ⁻¹P = I. The left side takes the place of F⁻ℓd − N. After the move
//! N⁺ = F⁺ℓd + Aᵀμ with A Σ⁻¹N⁺ = b at q⁺, whose derivative is
//!
//! ```text
//! δN⁺ = Q δ(F⁺ℓd + Aᵀμ) − P δ(A Σ⁻¹N⁺ − b)
//! ```
//! with fixed μ, and with fixed N⁺ in the last term.

use super::{Constrained, Reacting};
use crate::linear::divided;
use crate::parts::{Mu, Q, Substep, T, VariedSubstep};
use crate::tangent::times;
use crate::{Carried, Clebsch, Declared, Ends, Method, Momenta, Scalar};
use nalgebra::{SMatrix, SVector};

/// The constraint at the start of an edge, with its derivatives along the motions η of q that leave F as it is.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintAtStart<T, const M: usize, const R: usize> {
    /// A
    pub rows: SMatrix<T, R, M>,
    /// A Σ⁻¹
    pub by_inertia: SMatrix<T, R, M>,
    /// ∂(Aᵀλ)/∂η with fixed λ.
    pub push: SMatrix<T, M, M>,
    /// ∂ψ/∂η
    pub between: SMatrix<T, R, M>,
    /// ∂ψ/∂η′, along motions of q⁺ alone.
    pub between_by_end: SMatrix<T, R, M>,
}

/// The constraint at the end of an edge, with its derivatives along motions η′ of q⁺.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintAtEnd<T, const M: usize, const R: usize> {
    /// A
    pub rows: SMatrix<T, R, M>,
    /// A Σ⁻¹
    pub by_inertia: SMatrix<T, R, M>,
    /// ∂(Aᵀμ)/∂η′ with fixed μ.
    pub push: SMatrix<T, M, M>,
    /// ∂(A Σ⁻¹N⁺ − b)/∂η′ with fixed N⁺.
    pub velocity: SMatrix<T, R, M>,
}

/// The derivatives of a push Aᵀκ and of the equations of a constraint, one column for each quantity.
pub type ConstraintSlopes<T, const M: usize, const R: usize, const P: usize> = (SMatrix<T, M, P>, SMatrix<T, R, P>);

/// Substep K with R equations of a constraint, differentiated along M motions and by P quantities.
pub trait ConstrainedSubstep<const K: usize, const M: usize, const R: usize, const P: usize, B: Method<Self> = Declared>:
    VariedSubstep<K, M, B> + Reacting<B> + Constrained<Reactions = SVector<T<Self>, R>, Momentum = SVector<T<Self>, M>>
{
    /// The time at the end of a step that starts at t.
    fn end(c: &B::Constants, t: T<Self>) -> T<Self>;

    /// The constraint at the start, with the multipliers λ.
    fn at_start(
        &self,
        c: &B::Constants,
        t: T<Self>,
        ends: Ends<'_, Self>,
        kappa: &SVector<T<Self>, R>,
    ) -> ConstraintAtStart<T<Self>, M, R>;

    /// The constraint at the end, with the momentum N⁺ and the multipliers μ.
    fn at_end(
        &self,
        c: &B::Constants,
        t: T<Self>,
        next: &Q<Self>,
        mu: &Mu<Self>,
        kappa: &SVector<T<Self>, R>,
    ) -> ConstraintAtEnd<T<Self>, M, R>;

    /// The derivatives of Aᵀλ and of ψ by the quantities; of none as provided.
    fn slopes_at_start(
        &self,
        _c: &B::Constants,
        _t: T<Self>,
        _ends: Ends<'_, Self>,
        _kappa: &SVector<T<Self>, R>,
    ) -> ConstraintSlopes<T<Self>, M, R, P> {
        const { assert!(P == 0, "there are quantities") }
        (SMatrix::zeros(), SMatrix::zeros())
    }

    /// The derivatives of Aᵀμ and of A Σ⁻¹N⁺ − b by the quantities; of none as provided.
    fn slopes_at_end(
        &self,
        _c: &B::Constants,
        _t: T<Self>,
        _next: &Q<Self>,
        _mu: &Mu<Self>,
        _kappa: &SVector<T<Self>, R>,
    ) -> ConstraintSlopes<T<Self>, M, R, P> {
        const { assert!(P == 0, "there are quantities") }
        (SMatrix::zeros(), SMatrix::zeros())
    }
}

/// An edge as a step passes it.
#[derive(Clone, Copy, Debug)]
pub struct PassedEdge<T, const M: usize> {
    /// The momentum N⁺ and the derivatives.
    pub edge: Carried<T, M>,
    /// Q, which takes from a change of N the part that the force of the constraint balances; `None` without a constraint.
    pub balance: Option<SMatrix<T, M, M>>,
}

/// P = AᵀS⁻¹ with A Σ⁻¹.
pub(super) struct Balance<T, const M: usize, const R: usize> {
    pub lift: SMatrix<T, M, R>,
    by_inertia: SMatrix<T, R, M>,
}

impl<T: Scalar, const M: usize, const R: usize> Balance<T, M, R> {
    /// `None` where S is singular.
    pub fn new(rows: &SMatrix<T, R, M>, by_inertia: &SMatrix<T, R, M>) -> Option<Self> {
        let metric = times(by_inertia, &rows.transpose());
        let lift = divided(&metric, rows)?.transpose();
        Some(Self { lift, by_inertia: *by_inertia })
    }

    /// Q a + P b
    pub fn of<const K: usize>(&self, a: &SMatrix<T, M, K>, b: &SMatrix<T, R, K>) -> SMatrix<T, M, K> {
        a + times(&self.lift, &(b - times(&self.by_inertia, a)))
    }

    /// Q
    pub fn projection(&self) -> SMatrix<T, M, M> {
        SMatrix::identity() - times(&self.lift, &self.by_inertia)
    }
}

/// Both ends of an edge with the forces of the constraint.
pub(super) struct Sides<S: Clebsch, const M: usize, const R: usize> {
    /// λ and μ
    pub multipliers: [SVector<T<S>, R>; 2],
    /// N⁺
    pub momentum: Mu<S>,
    pub start: ConstraintAtStart<T<S>, M, R>,
    pub end: ConstraintAtEnd<T<S>, M, R>,
    pub leaving: Balance<T<S>, M, R>,
    pub landing: Balance<T<S>, M, R>,
}

/// The place of an edge: the constants, and the time at which the step starts.
pub(super) type Place<'a, S, B> = (&'a <B as Method<S>>::Constants, T<S>);

/// The derivatives of the momenta before and after an edge, one column for each quantity.
type Slopes<S, const M: usize, const P: usize> = (SMatrix<T<S>, M, P>, SMatrix<T<S>, M, P>);

/// The constraint in a step from the momentum N over an edge. `None` where rows depend on each other.
pub(super) fn sides<S, B, const K: usize, const M: usize, const R: usize, const P: usize>(
    system: &S,
    (c, t): Place<'_, S, B>,
    ends: Ends<'_, S>,
    mu: &Mu<S>,
) -> Option<Sides<S, M, R>>
where
    S: ConstrainedSubstep<K, M, R, P, B>,
    B: Method<S>,
{
    let (q, _, next, _) = ends;
    let Momenta { before, after, .. } = VariedSubstep::<K, M, B>::momenta(system, c, t, ends);
    let start = system.multipliers(c, t, q, &(before - mu));
    let push = Substep::<K, B>::projection(system, c, t, next, &after).unwrap_or_else(SVector::zeros);
    let end = system.multipliers(c, S::end(c, t), next, &push);
    let (multipliers, momentum) = ([start, end], after + push);
    let start = system.at_start(c, t, ends, &multipliers[0]);
    let end = system.at_end(c, t, next, &momentum, &multipliers[1]);
    let leaving = Balance::new(&start.rows, &start.by_inertia)?;
    let landing = Balance::new(&end.rows, &end.by_inertia)?;
    Some(Sides { multipliers, momentum, start, end, leaving, landing })
}

/// An edge with the force of its constraint, in a step from the momentum N. `None` where rows depend on each other.
#[inline]
pub fn with_constraint<S, B, const K: usize, const M: usize, const R: usize, const P: usize>(
    system: &S,
    (c, t): Place<'_, S, B>,
    ends: Ends<'_, S>,
    mu: &Mu<S>,
    edge: &Carried<T<S>, M>,
) -> Option<PassedEdge<T<S>, M>>
where
    S: ConstrainedSubstep<K, M, R, P, B>,
    B: Method<S>,
{
    let sides = sides(system, (c, t), ends, mu)?;
    Some(PassedEdge { edge: sides.joined(edge), balance: Some(sides.leaving.projection()) })
}

impl<S: Clebsch<Momentum = SVector<<S as Clebsch>::Scalar, M>>, const M: usize, const R: usize> Sides<S, M, R> {
    /// The derivatives of an edge with those of its constraint.
    #[inline]
    pub fn joined(&self, edge: &Carried<T<S>, M>) -> Carried<T<S>, M> {
        let Self { momentum, start, end, leaving, landing, .. } = self;
        // the end moves with the start, by Ad
        let push = times(&end.push, &edge.adjoint);
        let velocity = times(&end.velocity, &edge.adjoint);
        Carried {
            momentum: *momentum,
            adjoint: edge.adjoint,
            before: leaving.of(&(edge.before - start.push), &start.between),
            after: landing.of(&(edge.after + push), &-velocity),
            before_by_end: leaving.of(&edge.before_by_end, &start.between_by_end),
            after_by_end: landing.of(&(edge.after_by_end + end.push), &-end.velocity),
        }
    }
}

/// The slopes of the momenta of an edge, with those of its constraint.
#[inline]
pub fn slopes_with_constraint<S, B, const K: usize, const M: usize, const R: usize, const P: usize>(
    system: &S,
    (c, t): Place<'_, S, B>,
    ends: Ends<'_, S>,
    mu: &Mu<S>,
    (before, after): Slopes<S, M, P>,
) -> Option<Slopes<S, M, P>>
where
    S: ConstrainedSubstep<K, M, R, P, B>,
    B: Method<S>,
{
    let Sides { multipliers: [lambda, kappa], momentum, leaving, landing, .. } = sides(system, (c, t), ends, mu)?;
    let (push_before, between) = system.slopes_at_start(c, t, ends, &lambda);
    let (push_after, velocity) = system.slopes_at_end(c, t, ends.2, &momentum, &kappa);
    Some((leaving.of(&(before - push_before), &between), landing.of(&(after + push_after), &-velocity)))
}
