//! Points on large spheres in (q, w), where the momentum is M = wqᵀ − qwᵀ: n numbers in place of n(n − 1)/2.

use super::substep::{Apart, Shared, inverse_legendre};
use super::{Parted, Scheme};
use crate::parts::GreatCircles;
use crate::sphere::{momentum_of_tangent, push, tangent, turn_freely, turn_great_circle, turned_in_plane};
use crate::{Clebsch, Error, Method, Scalar, Space};
use core::marker::PhantomData;
use nalgebra::SVector;
use num_traits::One;

/// (q, w) ↦ (q⁺, w⁺): w + ∂U₀, q⁺ = cq + aw and w⁺ = cw − a|w|²q with a = h/κ and c² = 1 − a²|w|², w + ∂U₁. What is not perpendicular to q is taken off w in
/// each step, which rounding makes necessary.
#[derive(Clone, Copy, Debug)]
pub struct GreatCircle<C>(PhantomData<C>);

/// q ↦ q⁺ of a point that nothing pushes, with N = vuᵀ − uvᵀ, which stays: q⁺ = cq + aw with w = Nq, a = h/κ and c² = 1 − a²|w|². A state holds u and v.
#[derive(Clone, Copy, Debug)]
pub struct FreeGreatCircle;

/// A point in n dimensions.
type Point<S, const N: usize> = SVector<<S as Clebsch>::Scalar, N>;

/// How the gradients of a step and the next are told.
pub trait CarryGradient<S: GreatCircles<M>, M: Method<S>, const N: usize> {
    /// What one step leaves to the next.
    type Gradient: Space<S::Scalar>;

    /// The gradient at q.
    fn gradient(system: &S, constants: &M::Constants, t: S::Scalar, q: &Point<S, N>) -> Self::Gradient;

    /// That of a step that is `ratio` times as long.
    fn scaled(gradient: Self::Gradient, ratio: S::Scalar) -> Self::Gradient;

    /// As many steps, in place.
    ///
    /// # Errors
    /// Those of [`turn_great_circle`].
    fn turn(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        steps: usize,
        state: (&mut Point<S, N>, &mut Point<S, N>, &mut Self::Gradient),
    ) -> Result<(), Error>;
}

impl<S, M: Method<S>, const N: usize> CarryGradient<S, M, N> for Shared
where
    S: GreatCircles<M, Configuration = SVector<<S as Clebsch>::Scalar, N>>,
{
    type Gradient = Point<S, N>;

    #[inline(always)]
    fn gradient(system: &S, constants: &M::Constants, t: S::Scalar, q: &Point<S, N>) -> Point<S, N> {
        match system.start_gradient(constants, t, q) {
            Some(gradient) => gradient,
            None => Space::origin(),
        }
    }

    #[inline(always)]
    fn scaled(gradient: Point<S, N>, ratio: S::Scalar) -> Point<S, N> {
        gradient * ratio
    }

    #[inline(always)]
    fn turn(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        steps: usize,
        (q, w, gradient): (&mut Point<S, N>, &mut Point<S, N>, &mut Point<S, N>),
    ) -> Result<(), Error> {
        if steps == 0 {
            return Ok(());
        }
        let (a, one, two) = (S::turn(constants), S::Scalar::from_f64(1.0), S::Scalar::from_f64(2.0));
        push(q, w, gradient, one);
        for _ in 1..steps {
            turn_great_circle(a, q, w)?;
            *gradient = <Self as CarryGradient<S, M, N>>::gradient(system, constants, t, q);
            // between two steps both kicks are one
            push(q, w, gradient, two);
        }
        turn_great_circle(a, q, w)?;
        *gradient = <Self as CarryGradient<S, M, N>>::gradient(system, constants, t, q);
        push(q, w, gradient, one);
        Ok(())
    }
}

impl<S, M: Method<S>, const N: usize> CarryGradient<S, M, N> for Apart
where
    S: GreatCircles<M, Configuration = SVector<<S as Clebsch>::Scalar, N>>,
{
    type Gradient = ();

    #[inline(always)]
    fn gradient(_: &S, _: &M::Constants, _: S::Scalar, _: &Point<S, N>) {}

    #[inline(always)]
    fn scaled((): (), _: S::Scalar) {}

    #[inline(always)]
    fn turn(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        steps: usize,
        (q, w, ()): (&mut Point<S, N>, &mut Point<S, N>, &mut ()),
    ) -> Result<(), Error> {
        let a = S::turn(constants);
        for _ in 0..steps {
            if let Some(gradient) = system.start_gradient(constants, t, q) {
                push(q, w, &gradient, One::one());
            }
            turn_great_circle(a, q, w)?;
            if let Some(gradient) = system.end_gradient(constants, t, q) {
                push(q, w, &gradient, One::one());
            }
        }
        Ok(())
    }
}

impl<S, M: Method<S>, C, const N: usize, const D: usize> Scheme<S, M> for GreatCircle<C>
where
    S: GreatCircles<
            M,
            Configuration = SVector<<S as Clebsch>::Scalar, N>,
            Momentum = SVector<<S as Clebsch>::Scalar, D>,
        >,
    C: CarryGradient<S, M, N>,
{
    type Held = Point<S, N>;
    type Left = C::Gradient;
    type Constants = M::Constants;

    fn constants(system: &S, h: S::Scalar) -> Result<M::Constants, Error> {
        M::constants(system, h)
    }

    #[inline(always)]
    fn whole(constants: &M::Constants) -> &M::Constants {
        constants
    }

    #[inline]
    fn held(q: &Point<S, N>, mu: &S::Momentum) -> Point<S, N> {
        tangent(q, mu)
    }

    #[inline]
    fn momentum(q: &Point<S, N>, held: &Point<S, N>) -> S::Momentum {
        momentum_of_tangent(q, held)
    }

    #[inline]
    fn left(system: &S, constants: &M::Constants, t: S::Scalar, q: &Point<S, N>, _: &S::Momentum) -> C::Gradient {
        C::gradient(system, constants, t, q)
    }

    #[inline(always)]
    fn scaled(left: C::Gradient, ratio: S::Scalar) -> C::Gradient {
        C::scaled(left, ratio)
    }

    #[inline]
    fn step(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        (q, held, left): (&Point<S, N>, &Point<S, N>, &C::Gradient),
        _: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error> {
        let (mut q, mut held, mut left) = (*q, *held, *left);
        C::turn(system, constants, t, 1, (&mut q, &mut held, &mut left))?;
        Ok((q, held, left))
    }

    #[inline]
    fn step_into(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        state: (&Point<S, N>, &Point<S, N>, &C::Gradient),
        _: &S::Input,
        (q, held, left): (&mut Point<S, N>, &mut Point<S, N>, &mut C::Gradient),
    ) -> Result<(), Error> {
        (*q, *held, *left) = (*state.0, *state.1, *state.2);
        C::turn(system, constants, t, 1, (q, held, left))
    }

    fn steps(
        system: &S,
        constants: &M::Constants,
        (t, _): (S::Scalar, S::Scalar),
        steps: usize,
        (q, held, left): (&Point<S, N>, &Point<S, N>, &C::Gradient),
        _: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error> {
        let (mut q, mut held, mut left) = (*q, *held, *left);
        C::turn(system, constants, t, steps, (&mut q, &mut held, &mut left))?;
        Ok((q, held, left))
    }

    fn step_symmetric(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        q: &Point<S, N>,
        p: &Point<S, N>,
    ) -> Result<(Point<S, N>, Point<S, N>), Error> {
        symmetric(system, constants, t, q, p)
    }

    #[inline]
    fn inverse_legendre(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        q: &Point<S, N>,
        mu: &S::Momentum,
    ) -> Result<S::Element, Error> {
        inverse_legendre::<S, M, 0>(system, constants, t, q, mu)
    }
}

impl<S, M: Method<S>, const N: usize, const D: usize> Scheme<S, M> for FreeGreatCircle
where
    S: GreatCircles<
            M,
            Configuration = SVector<<S as Clebsch>::Scalar, N>,
            Momentum = SVector<<S as Clebsch>::Scalar, D>,
        >,
{
    type Held = (Point<S, N>, Point<S, N>);
    type Left = ();
    type Constants = M::Constants;

    fn constants(system: &S, h: S::Scalar) -> Result<M::Constants, Error> {
        M::constants(system, h)
    }

    #[inline(always)]
    fn whole(constants: &M::Constants) -> &M::Constants {
        constants
    }

    #[inline]
    fn held(q: &Point<S, N>, mu: &S::Momentum) -> Self::Held {
        (*q, tangent(q, mu))
    }

    #[inline]
    fn momentum(_: &Point<S, N>, held: &Self::Held) -> S::Momentum {
        momentum_of_tangent(&held.0, &held.1)
    }

    #[inline(always)]
    fn left(_: &S, _: &M::Constants, _: S::Scalar, _: &Point<S, N>, _: &S::Momentum) {}

    #[inline]
    fn step(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        (q, held, left): (&Point<S, N>, &Self::Held, &()),
        u: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error> {
        let (mut next, mut moved) = (*q, *held);
        Self::step_into(system, constants, t, (q, held, left), u, (&mut next, &mut moved, &mut ()))?;
        Ok((next, moved, ()))
    }

    #[inline]
    fn step_into(
        _: &S,
        constants: &M::Constants,
        _: S::Scalar,
        state: (&Point<S, N>, &Self::Held, &()),
        _: &S::Input,
        (q, held, ()): (&mut Point<S, N>, &mut Self::Held, &mut ()),
    ) -> Result<(), Error> {
        (*q, *held) = (*state.0, *state.1);
        turn_freely(S::turn(constants), held, q)
    }

    fn steps(
        _: &S,
        constants: &M::Constants,
        _: (S::Scalar, S::Scalar),
        steps: usize,
        (q, held, ()): (&Point<S, N>, &Self::Held, &()),
        _: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error> {
        let (mut q, a) = (*q, S::turn(constants));
        for _ in 0..steps {
            turn_freely(a, held, &mut q)?;
        }
        Ok((q, *held, ()))
    }

    fn step_symmetric(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        q: &Point<S, N>,
        p: &Point<S, N>,
    ) -> Result<(Point<S, N>, Point<S, N>), Error> {
        symmetric(system, constants, t, q, p)
    }

    #[inline]
    fn inverse_legendre(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        q: &Point<S, N>,
        mu: &S::Momentum,
    ) -> Result<S::Element, Error> {
        inverse_legendre::<S, M, 0>(system, constants, t, q, mu)
    }
}

/// (q, p) ↦ (q⁺, p⁺) on T*Rⁿ, with what p has along q: both are turned in their plane.
///
/// # Errors
/// Those of [`turned_in_plane`].
fn symmetric<S, M: Method<S>, const N: usize>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    q: &Point<S, N>,
    p: &Point<S, N>,
) -> Result<(Point<S, N>, Point<S, N>), Error>
where
    S: GreatCircles<M, Configuration = SVector<<S as Clebsch>::Scalar, N>>,
{
    let plus = |p: Point<S, N>, gradient: Option<Point<S, N>>| gradient.map_or(p, |gradient| p + gradient);
    let p = plus(*p, system.start_gradient(constants, t, q));
    let (q, p) = turned_in_plane(S::turn(constants), q, &p)?;
    Ok((q, plus(p, system.end_gradient(constants, t, &q))))
}
