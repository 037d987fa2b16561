//! Hamilton's equations, collocated at eight nodes.

use super::substep::{LeftOf, Moving, inverse_legendre, moved};
use super::{Parted, Scheme};
use crate::collocation::{GAUSS_16, collocate};
use crate::parts::{HamiltonEquations, Substep};
use crate::summation::Sums;
use crate::{Error, Method, Scalar, Space};

/// Steps of order 16 by collocation of (q, p), N numbers.
#[derive(Clone, Copy, Debug)]
pub struct Collocated<const N: usize>;

impl<S: Substep<0, M> + HamiltonEquations<N, M>, M: Method<S>, const N: usize> Scheme<S, M> for Collocated<N> {
    type Left = LeftOf<S, M, ()>;

    momentum_is_held!(M);

    #[inline]
    fn left(_: &S, _: &M::Constants, _: S::Scalar, _: &S::Configuration, _: &S::Momentum) -> Self::Left {
        S::Sums::joined((), (Space::origin(), Space::origin()))
    }

    #[inline]
    fn left_after(
        _: &S,
        _: &M::Constants,
        _: S::Scalar,
        _: &S::Configuration,
        _: &S::Momentum,
        left: &Self::Left,
    ) -> Self::Left {
        *left
    }

    /// N⁺ − N = J(q⁺, p⁺) − J(q, p) is made of the changes of q and p at the middle of the step: J is linear in p and affine in q.
    #[inline]
    fn step(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        (q, mu, left): (&S::Configuration, &S::Momentum, &Self::Left),
        _: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error> {
        let (mut state, _) = Moving::<S, M>::start::<()>(q, mu, left);
        let p = completed(system, constants, q, mu);
        let (dq, dp) = change(system, constants, t, q, &p, mu)?;
        let half = S::Scalar::from_ratio(1, 2);
        let middle_q = q.zip_map(&dq, |q, dq| q + half * dq);
        let middle_p = p.zip_map(&dp, |p, dp| p + half * dp);
        let by_q = system.momentum(&dq, &middle_p);
        let by_q =
            if S::IS_AFFINE { minus(by_q, &system.momentum(&S::Configuration::origin(), &middle_p)) } else { by_q };
        let added = plus(by_q, &system.momentum(&middle_q, &dp));
        state.shift(&dq);
        state.on_space();
        state.push(Some(added));
        Ok(state.finish(()))
    }

    fn step_symmetric(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        p: &S::Configuration,
    ) -> Result<(S::Configuration, S::Configuration), Error> {
        if !S::HAS_COVECTORS {
            return Err(Error::NoCovector);
        }
        let (dq, dp) = change(system, constants, t, q, p, &system.momentum(q, p))?;
        Ok((plus(*q, &dq), plus(*p, &dp)))
    }

    #[inline]
    fn inverse_legendre(
        system: &S,
        constants: &M::Constants,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> Result<S::Element, Error> {
        inverse_legendre::<S, M, 0>(system, constants, t, q, mu)
    }
}

#[inline(always)]
fn plus<T: Scalar, V: Space<T>>(a: V, b: &V) -> V {
    a.zip_map(b, |a, b| a + b)
}

#[inline(always)]
fn minus<T: Scalar, V: Space<T>>(a: V, b: &V) -> V {
    a.zip_map(b, |a, b| a - b)
}

/// A covector with J(q, p) = μ.
///
/// Where rounding has moved q off its orbit, J(q, p) misses μ by as much: added up, N would drift like the square of the steps. So what is missing is
/// added once.
#[inline(always)]
fn completed<S: HamiltonEquations<N, M>, M: Method<S>, const N: usize>(
    system: &S,
    constants: &M::Constants,
    q: &S::Configuration,
    mu: &S::Momentum,
) -> S::Configuration {
    let p = system.covector(constants, q, mu);
    let missing = system.covector(constants, q, &minus(*mu, &system.momentum(q, &p)));
    plus(p, &missing)
}

/// (q⁺ − q, p⁺ − p), by collocation at eight nodes.
///
/// # Errors
/// Those of [`collocate`].
#[inline]
fn change<S: HamiltonEquations<N, M>, M: Method<S>, const N: usize>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    q: &S::Configuration,
    p: &S::Configuration,
    mu: &S::Momentum,
) -> Result<(S::Configuration, S::Configuration), Error> {
    let x = system.guess(constants, t, q, mu);
    let change = collocate::<S::Scalar, N, 8, 4>(
        &GAUSS_16,
        (t, S::step_size(constants)),
        &S::joined(q, p),
        S::TOLERANCE,
        S::SWEEPS,
        |part| along(system, &S::part(&x, part), q, p),
        |t, y| system.slope(constants, t, y),
    )?;
    Ok(S::parted(&change))
}

/// (q, p) after a part of the step, moved along by the velocity of its start: on the orbit of q.
#[inline(always)]
fn along<S: HamiltonEquations<N, M>, M: Method<S>, const N: usize>(
    system: &S,
    x: &S::Coordinates,
    q: &S::Configuration,
    p: &S::Configuration,
) -> [S::Scalar; N] {
    let d = system.increment(x);
    let q = moved(system, q, x, &d);
    let p = system.lift(&q, p, &d);
    S::joined(&q, &p)
}
