//! The edges of a step, one for each substep: what the calculus of variations looks at.

use super::composed::Sizes;
use super::substep::{Carry, solve_before_kick};
use super::{AdjointPair, AlongFreeMotion, Composed, FreeGreatCircle, GreatCircle, KickDriftKick, Scheme};
use crate::parts::{Substep, Varied, VariedSubstep};
use crate::{Carried, Clebsch, Declared, Edge, Error, Momenta};
use nalgebra::SMatrix;

/// A scheme whose steps have edges.
pub trait Edges<S: Clebsch + ?Sized, const M: usize>: Scheme<S> {
    /// How many.
    const EDGES: usize;

    /// What is asked for at an edge of the step that starts at the time t.
    fn visit<V: Visit<S, M>>(system: &S, constants: &Self::Constants, edge: usize, t: S::Scalar, visit: V)
    -> V::Output;

    /// The slopes of an edge along h and t of the whole step, in the columns that are told.
    #[inline(always)]
    fn slopes_of_step<const P: usize>(
        constants: &Self::Constants,
        edge: usize,
        slopes: SMatrix<S::Scalar, M, P>,
        columns: (Option<usize>, Option<usize>),
    ) -> SMatrix<S::Scalar, M, P> {
        let _ = (constants, edge, columns);
        slopes
    }
}

/// What is asked for at an edge.
pub trait Visit<S: Clebsch + ?Sized, const M: usize> {
    /// The answer.
    type Output;

    /// The answer at substep K.
    fn at<const K: usize>(self, system: &S, constants: &S::Constants, t: S::Scalar) -> Self::Output
    where
        S: VariedSubstep<K, M>;
}

/// The ends of an edge, and the input of its forces.
pub struct Ends<'a, S: Clebsch + ?Sized> {
    /// q
    pub q: &'a S::Configuration,
    /// F − I
    pub d: &'a S::Element,
    /// q⁺
    pub next: &'a S::Configuration,
    /// u
    pub u: &'a S::Input,
}

/// The increment of the group element with the momentum μ at q.
pub struct Drift<'a, S: Clebsch + ?Sized> {
    /// q
    pub q: &'a S::Configuration,
    /// μ
    pub mu: &'a S::Momentum,
    /// u
    pub u: &'a S::Input,
}

impl<S: Clebsch + ?Sized, const M: usize> Visit<S, M> for Drift<'_, S> {
    type Output = Result<S::Element, Error>;

    #[inline(always)]
    fn at<const K: usize>(self, system: &S, constants: &S::Constants, t: S::Scalar) -> Self::Output
    where
        S: VariedSubstep<K, M>,
    {
        let x = solve_before_kick::<S, Declared, K>(system, constants, t, self.q, self.mu, self.u)?;
        Ok(system.increment(&x))
    }
}

/// What a method of [`VariedSubstep`] gives, at the ends of an edge.
macro_rules! asked {
    ($($doc:literal $name:ident $method:ident -> $output:ty;)*) => { $(
        #[doc = $doc]
        pub struct $name<'a, S: Clebsch + ?Sized>(pub Ends<'a, S>);

        impl<S: Clebsch + ?Sized, const M: usize> Visit<S, M> for $name<'_, S> {
            type Output = $output;

            #[inline(always)]
            fn at<const K: usize>(self, system: &S, constants: &S::Constants, t: S::Scalar) -> Self::Output
            where
                S: VariedSubstep<K, M>,
            {
                let Ends { q, d, next, u } = self.0;
                system.$method(constants, t, q, d, next, u)
            }
        }
    )* };
}

asked! {
    "An edge with its second derivatives." SecondDerivatives edge -> Edge<S::Scalar, M>;
    "An edge with its first derivatives." FirstDerivatives momenta -> Momenta<S::Scalar, M>;
    "The derivatives of an edge along motions that leave F as it is." AtFixedElement carried -> Carried<S::Scalar, M>;
}

/// The derivatives of an edge with respect to what is fixed during a step.
pub struct ByQuantities<'a, S: Clebsch + ?Sized>(pub Ends<'a, S>);

impl<S: Varied<M>, const M: usize> Visit<S, M> for ByQuantities<'_, S> {
    type Output = S::Slopes;

    #[inline(always)]
    fn at<const K: usize>(self, system: &S, constants: &S::Constants, t: S::Scalar) -> S::Slopes
    where
        S: VariedSubstep<K, M>,
    {
        let Ends { q, d, next, u } = self.0;
        system.slopes(constants, t, q, d, next, u)
    }
}

/// Schemes with one edge.
macro_rules! one_edge {
    ($([$($generics:tt)*] $scheme:ty;)*) => { $(
        impl<S: VariedSubstep<0, M>, $($generics)* const M: usize> Edges<S, M> for $scheme
        where
            Self: Scheme<S, Constants = S::Constants>,
        {
            const EDGES: usize = 1;

            #[inline(always)]
            fn visit<V: Visit<S, M>>(system: &S, constants: &S::Constants, _: usize, t: S::Scalar, visit: V) -> V::Output {
                visit.at::<0>(system, constants, t)
            }
        }
    )* };
}

one_edge! {
    [C, const W: usize,] KickDriftKick<C, W>;
    [C,] GreatCircle<C>;
    [] FreeGreatCircle;
    [] AlongFreeMotion;
}

impl<S: VariedSubstep<0, M> + VariedSubstep<1, M> + Substep<2>, C: Carry<S>, const M: usize> Edges<S, M>
    for AdjointPair<C>
{
    const EDGES: usize = 2;

    #[inline(always)]
    fn visit<V: Visit<S, M>>(system: &S, constants: &S::Constants, edge: usize, t: S::Scalar, visit: V) -> V::Output {
        if edge == 0 { visit.at::<0>(system, constants, t) } else { visit.at::<1>(system, constants, t) }
    }
}

impl<S: Clebsch, I: Edges<S, M>, Z: Sizes<K>, const K: usize, const M: usize> Edges<S, M> for Composed<I, Z, K> {
    const EDGES: usize = (2 * K - 1) * I::EDGES;

    #[inline(always)]
    fn visit<V: Visit<S, M>>(
        system: &S,
        constants: &Self::Constants,
        edge: usize,
        t: S::Scalar,
        visit: V,
    ) -> V::Output {
        let stage = constants.stage(edge / I::EDGES);
        I::visit(system, stage.constants, edge % I::EDGES, t + stage.start, visit)
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
