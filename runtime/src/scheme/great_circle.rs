//! Points on large spheres in (q, w), where the momentum is M = wqᵀ − qwᵀ: n numbers in place of n(n − 1)/2.

use super::sequence::{Apart, Shared};
use super::substep::{inverse_legendre, plus};
use super::{At, Before, Pair, Scheme, Stepped, is_due, look};
use crate::matrices::skew_outer;
use crate::orbit::length_defect;
use crate::parts::{GreatCircles, T, U};
use crate::space::larger;
use crate::sphere::{push, tangent, turn_freely, turn_great_circle, turned_in_plane};
use crate::{Clebsch, Error, Method, Scalar, Space};
use core::marker::PhantomData;
use nalgebra::SVector;
use num_traits::One;

/// (q, w) ↦ (q⁺, w⁺): w + ∂U₀, q⁺ = cq + aw and w⁺ = cw − a|w|²q with a = h/κ and c² = 1 − a²|w|², w + ∂U₁. Each step
/// removes the component of w along q, which comes from rounding. C says how the gradients of a step and the next are
/// told.
pub struct GreatCircle<C>(PhantomData<C>);

/// q ↦ q⁺ of a point that nothing pushes, with constant N = vuᵀ − uvᵀ. The step is q⁺ = cq + aw with w = Nq, a = h/κ
/// and c² = 1 − a²|w|². A state holds u and v.
pub type FreeGreatCircle = GreatCircle<Unpushed>;

/// There are no gradients.
pub struct Unpushed;

/// A point in n dimensions.
type Point<S, const N: usize> = SVector<<S as Clebsch>::Scalar, N>;

/// The stored form of the momentum M = wqᵀ − qwᵀ.
pub trait Plane<T: Scalar, const N: usize>: Space<T> {
    /// Of D components of M.
    fn of<const D: usize>(q: &SVector<T, N>, mu: &SVector<T, D>) -> Self;

    /// The components of M.
    fn momentum<const D: usize>(&self, q: &SVector<T, N>) -> SVector<T, D>;

    /// The distance to the values that [`of`](Self::of) returns, in the units of M.
    fn defect(&self, q: &SVector<T, N>) -> T;
}

/// w
impl<T: Scalar, const N: usize> Plane<T, N> for SVector<T, N> {
    #[inline]
    fn of<const D: usize>(q: &SVector<T, N>, mu: &SVector<T, D>) -> Self {
        tangent(q, mu)
    }

    #[inline]
    fn momentum<const D: usize>(&self, q: &SVector<T, N>) -> SVector<T, D> {
        skew_outer(self, q)
    }

    /// |q·w|
    fn defect(&self, q: &SVector<T, N>) -> T {
        q.dot(self).abs()
    }
}

/// A point of the motion, and w there.
impl<T: Scalar, const N: usize> Plane<T, N> for (SVector<T, N>, SVector<T, N>) {
    #[inline]
    fn of<const D: usize>(q: &SVector<T, N>, mu: &SVector<T, D>) -> Self {
        (*q, tangent(q, mu))
    }

    #[inline]
    fn momentum<const D: usize>(&self, _: &SVector<T, N>) -> SVector<T, D> {
        skew_outer(&self.1, &self.0)
    }

    /// The larger one of |u·v| and ||u|² − 1| |v|.
    fn defect(&self, _: &SVector<T, N>) -> T {
        let (u, v) = self;
        larger(u.dot(v).abs(), length_defect(u) * v.max_abs())
    }
}

/// How points are pushed between their turns.
pub trait Turns<S: GreatCircles<M>, M: Method<S>, const N: usize>: Sized {
    /// The stored form of the momentum.
    type Plane: Plane<S::Scalar, N>;
    /// The data that one step passes to the next.
    type Gradient: Space<S::Scalar>;

    /// The gradient at q.
    fn gradient(at: At<'_, S, M>, q: &Point<S, N>) -> Self::Gradient;

    /// That of a step that is `ratio` times as long.
    #[inline(always)]
    fn scaled(gradient: Self::Gradient, _ratio: S::Scalar) -> Self::Gradient {
        gradient
    }

    /// As many steps, in place.
    fn turn(
        at: At<'_, S, M>,
        steps: usize,
        q: &mut Point<S, N>,
        plane: &mut Self::Plane,
        gradient: &mut Self::Gradient,
    ) -> Result<(), Error>;
}

/// The places of q, of the stored momentum and of the gradient. A turn reads them there and writes the next ones.
type Places<'a, S, C, M, const N: usize> =
    (&'a mut Point<S, N>, &'a mut <C as Turns<S, M, N>>::Plane, &'a mut <C as Turns<S, M, N>>::Gradient);

impl<S: GreatCircles<M, Configuration = Point<S, N>>, M: Method<S>, const N: usize> Turns<S, M, N> for Shared {
    type Plane = Point<S, N>;
    type Gradient = Point<S, N>;

    #[inline(always)]
    fn gradient(at: At<'_, S, M>, q: &Point<S, N>) -> Point<S, N> {
        at.system.start_gradient(at.constants, at.t, q).unwrap_or_else(Space::origin)
    }

    #[inline(always)]
    fn scaled(gradient: Point<S, N>, ratio: S::Scalar) -> Point<S, N> {
        gradient * ratio
    }

    #[inline]
    fn turn(
        at: At<'_, S, M>,
        steps: usize,
        q: &mut Point<S, N>,
        w: &mut Point<S, N>,
        gradient: &mut Point<S, N>,
    ) -> Result<(), Error> {
        if steps == 0 {
            return Ok(());
        }
        let a = S::turn(at.constants);
        let one = S::Scalar::from_f64(1.0);
        let two = S::Scalar::from_f64(2.0);
        push(q, w, gradient, one);
        for left in (0..steps).rev() {
            turn_great_circle(a, q, w)?;
            *gradient = <Self as Turns<S, M, N>>::gradient(at, q);
            // between two steps both kicks are one
            push(q, w, gradient, if left > 0 { two } else { one });
            if is_due(left) {
                look(q, w)?;
            }
        }
        Ok(())
    }
}

impl<S: GreatCircles<M, Configuration = Point<S, N>>, M: Method<S>, const N: usize> Turns<S, M, N> for Apart {
    type Plane = Point<S, N>;
    type Gradient = ();

    #[inline(always)]
    fn gradient(_: At<'_, S, M>, _: &Point<S, N>) {}

    #[inline]
    fn turn(
        at: At<'_, S, M>,
        steps: usize,
        q: &mut Point<S, N>,
        w: &mut Point<S, N>,
        (): &mut (),
    ) -> Result<(), Error> {
        let At { system, constants, t, .. } = at;
        let a = S::turn(constants);
        for number in 0..steps {
            if let Some(gradient) = system.start_gradient(constants, t, q) {
                push(q, w, &gradient, One::one());
            }
            turn_great_circle(a, q, w)?;
            if let Some(gradient) = system.end_gradient(constants, t, q) {
                push(q, w, &gradient, One::one());
            }
            if is_due(number) {
                look(q, w)?;
            }
        }
        Ok(())
    }
}

impl<S: GreatCircles<M>, M: Method<S>, const N: usize> Turns<S, M, N> for Unpushed {
    type Plane = (Point<S, N>, Point<S, N>);
    type Gradient = ();

    #[inline(always)]
    fn gradient(_: At<'_, S, M>, _: &Point<S, N>) {}

    #[inline]
    fn turn(
        at: At<'_, S, M>,
        steps: usize,
        q: &mut Point<S, N>,
        plane: &mut Self::Plane,
        (): &mut (),
    ) -> Result<(), Error> {
        let a = S::turn(at.constants);
        (0..steps).try_for_each(|number| {
            turn_freely(a, plane, q)?;
            if is_due(number) { look(q, plane) } else { Ok(()) }
        })
    }
}

impl<S, M: Method<S>, C: Turns<S, M, N>, const N: usize, const D: usize> Scheme<S, M> for GreatCircle<C>
where
    S: GreatCircles<M, Configuration = Point<S, N>, Momentum = Point<S, D>>,
{
    type Held = C::Plane;
    type Left = C::Gradient;

    constants_of_method!(M);

    #[inline]
    fn held(q: &Point<S, N>, mu: &S::Momentum) -> C::Plane {
        C::Plane::of(q, mu)
    }

    #[inline]
    fn momentum(q: &Point<S, N>, held: &C::Plane) -> S::Momentum {
        held.momentum(q)
    }

    #[inline]
    fn left(at: At<'_, S, M>, q: &Point<S, N>, _: &S::Momentum) -> C::Gradient {
        C::gradient(at, q)
    }

    fn held_defect(q: &Point<S, N>, held: &C::Plane) -> S::Scalar {
        held.defect(q)
    }

    #[inline(always)]
    fn scaled(left: C::Gradient, ratio: S::Scalar) -> C::Gradient {
        C::scaled(left, ratio)
    }

    #[inline]
    fn step(at: At<'_, S, M>, state: Before<'_, S, Self, M>, _: &S::Input) -> Stepped<S, Self, M> {
        let (mut q, mut held, mut left) = (*state.0, *state.1, *state.2);
        C::turn(at, 1, &mut q, &mut held, &mut left)?;
        Ok((q, held, left))
    }

    #[inline]
    fn step_into(
        at: At<'_, S, M>,
        state: Before<'_, S, Self, M>,
        _: &S::Input,
        (q, held, left): Places<'_, S, C, M, N>,
    ) -> Result<(), Error> {
        (*q, *held, *left) = (*state.0, *state.1, *state.2);
        C::turn(at, 1, q, held, left)
    }

    fn steps(at: At<'_, S, M>, _: T<S>, steps: usize, state: Before<'_, S, Self, M>, _: &U<S>) -> Stepped<S, Self, M> {
        let (mut q, mut held, mut left) = (*state.0, *state.1, *state.2);
        C::turn(at, steps, &mut q, &mut held, &mut left)?;
        Ok((q, held, left))
    }

    /// On T*Rⁿ: p may have a component along q, and both are turned in their plane.
    fn step_symmetric(at: At<'_, S, M>, q: &Point<S, N>, p: &Point<S, N>) -> Result<Pair<S>, Error> {
        let p = plus(*p, at.system.start_gradient(at.constants, at.t, q));
        let (q, p) = turned_in_plane(S::turn(at.constants), q, &p)?;
        Ok((q, plus(p, at.system.end_gradient(at.constants, at.t, &q))))
    }

    #[inline]
    fn inverse_legendre(at: At<'_, S, M>, q: &Point<S, N>, mu: &S::Momentum) -> Result<S::Element, Error> {
        inverse_legendre::<S, M, 0>(at, q, mu)
    }
}
