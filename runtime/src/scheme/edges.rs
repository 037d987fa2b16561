//! The edges of a step, one for each substep: the calculus of variations works on them.

use super::composed::{Composed, Sizes};
use super::great_circle::GreatCircle;
use super::sequence::{CarryKick, InSequence};
use super::substep::solve_before_kick;
use super::{At, AtOf, Scheme, adjoint_pair, free_motion, kick_drift_kick};
use crate::constraint::edge::PassedEdge;
use crate::parts::{F, Mu, Parts, Q, Substep, U, Varied, VariedSubstep};
use crate::{Carried, Clebsch, Declared, Edge, Ends, Error, Method, Momenta};
use nalgebra::SMatrix;

/// A scheme whose steps have edges.
pub trait Edges<S: Clebsch, const M: usize, B: Method<S> = Declared>: Scheme<S, B> {
    /// How many.
    const EDGES: usize;

    /// The answer to a question about an edge of the step.
    fn visit<V: Visit<S, M, B>>(at: AtOf<'_, S, Self, B>, edge: usize, visit: V) -> V::Output;

    /// The slopes of an edge along h and t of the composed step, in the columns that are told.
    #[inline(always)]
    fn slopes_of_step<const P: usize>(
        _constants: &Self::Constants,
        _edge: usize,
        slopes: SMatrix<S::Scalar, M, P>,
        _columns: (Option<usize>, Option<usize>),
    ) -> SMatrix<S::Scalar, M, P> {
        slopes
    }
}

/// A question about an edge.
pub trait Visit<S: Clebsch, const M: usize, B: Method<S> = Declared> {
    /// The answer.
    type Output;

    /// The answer at substep K.
    fn at<const K: usize>(self, at: At<'_, S, B>) -> Self::Output
    where
        S: VariedSubstep<K, M, B>;
}

/// The increment of the group element with the momentum μ at q, of q, μ and u.
pub struct Drift<'a, S: Clebsch>(pub &'a Q<S>, pub &'a Mu<S>, pub &'a U<S>);

impl<S: Clebsch, B: Method<S>, const M: usize> Visit<S, M, B> for Drift<'_, S> {
    type Output = Result<F<S>, Error>;

    #[inline(always)]
    fn at<const K: usize>(self, at: At<'_, S, B>) -> Self::Output
    where
        S: VariedSubstep<K, M, B>,
    {
        let x = solve_before_kick::<S, B, K>(at, self.0, self.1, self.2)?;
        Ok(Parts::<B>::increment(at.system, &x))
    }
}

/// The questions that a method of [`VariedSubstep`] answers at the ends of an edge.
macro_rules! asked {
    ($($doc:literal $name:ident: $bound:ident $(<$m:ident>)?, $method:ident -> $output:ty;)*) => { $(
        #[doc = $doc]
        pub struct $name<'a, S: Clebsch>(pub Ends<'a, S>);

        impl<S: $bound $(<$m>)?, B: Method<S>, const M: usize> Visit<S, M, B> for $name<'_, S> {
            type Output = $output;

            #[inline(always)]
            fn at<const K: usize>(self, at: At<'_, S, B>) -> Self::Output
            where
                S: VariedSubstep<K, M, B>,
            {
                at.system.$method(at.constants, at.t, self.0)
            }
        }
    )* };
}

asked! {
    "An edge with its second derivatives." SecondDerivatives: Clebsch, edge -> Edge<S::Scalar, M>;
    "An edge with its first derivatives." FirstDerivatives: Clebsch, momenta -> Momenta<S::Scalar, M>;
    "The derivatives of an edge along motions that leave F as it is." AtFixedElement: Clebsch, carried -> Carried<S::Scalar, M>;
    "The derivatives of an edge with respect to the quantities that are fixed during a step." ByQuantities: Varied<M>, slopes -> S::Slopes;
}

/// An edge as a step from the momentum N passes it: with its derivatives, and with the force of a constraint.
pub struct Passing<'a, S: Clebsch>(pub Ends<'a, S>, pub &'a Mu<S>);

impl<S: Clebsch, B: Method<S>, const M: usize> Visit<S, M, B> for Passing<'_, S> {
    type Output = Option<PassedEdge<S::Scalar, M>>;

    #[inline(always)]
    fn at<const K: usize>(self, At { system, constants, t, .. }: At<'_, S, B>) -> Self::Output
    where
        S: VariedSubstep<K, M, B>,
    {
        system.passed(constants, t, self.0, self.1, system.carried(constants, t, self.0))
    }
}

/// The slopes of such an edge.
pub struct PassingByQuantities<'a, S: Clebsch>(pub Ends<'a, S>, pub &'a Mu<S>);

impl<S: Varied<M>, B: Method<S>, const M: usize> Visit<S, M, B> for PassingByQuantities<'_, S> {
    type Output = Option<S::Slopes>;

    #[inline(always)]
    fn at<const K: usize>(self, At { system, constants, t, .. }: At<'_, S, B>) -> Self::Output
    where
        S: VariedSubstep<K, M, B>,
    {
        system.slopes_passed(constants, t, self.0, self.1)
    }
}

/// Schemes with one edge.
macro_rules! one_edge {
    ($([$($generics:tt)*] $scheme:ty;)*) => { $(
        impl<S: VariedSubstep<0, M, B>, B: Method<S>, $($generics)* const M: usize> Edges<S, M, B> for $scheme
        where
            Self: Scheme<S, B, Constants = B::Constants>,
        {
            const EDGES: usize = 1;

            #[inline(always)]
            fn visit<V: Visit<S, M, B>>(at: At<'_, S, B>, _: usize, visit: V) -> V::Output {
                visit.at::<0>(at)
            }
        }
    )* };
}

one_edge! {
    [C, const W: usize,] InSequence<kick_drift_kick::Order<C, W>>;
    [] InSequence<free_motion::Order>;
    [C,] GreatCircle<C>;
}

impl<S, B: Method<S>, C: CarryKick<S, B>, const M: usize> Edges<S, M, B> for InSequence<adjoint_pair::Order<C>>
where
    S: VariedSubstep<0, M, B> + VariedSubstep<1, M, B> + Substep<2, B>,
{
    const EDGES: usize = 2;

    #[inline(always)]
    fn visit<V: Visit<S, M, B>>(at: At<'_, S, B>, edge: usize, visit: V) -> V::Output {
        if edge == 0 { visit.at::<0>(at) } else { visit.at::<1>(at) }
    }
}

impl<S: Clebsch, B: Method<S>, I: Edges<S, M, B>, Z: Sizes<K>, const K: usize, const M: usize> Edges<S, M, B>
    for Composed<I, Z, K>
{
    const EDGES: usize = (2 * K - 1) * I::EDGES;

    #[inline(always)]
    fn visit<V: Visit<S, M, B>>(at: AtOf<'_, S, Self, B>, edge: usize, visit: V) -> V::Output {
        let stage = at.constants.stage(edge / I::EDGES);
        I::visit(At::new(at.system, stage.constants, at.t + stage.start), edge % I::EDGES, visit)
    }

    #[inline(always)]
    fn slopes_of_step<const P: usize>(
        constants: &Self::Constants,
        edge: usize,
        slopes: SMatrix<S::Scalar, M, P>,
        (size, time): (Option<usize>, Option<usize>),
    ) -> SMatrix<S::Scalar, M, P> {
        constants.stage(edge / I::EDGES).slopes(slopes, size, time)
    }
}
