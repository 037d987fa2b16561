//! Hamilton's equations, collocated at eight nodes.

use super::sequence::{Apart, From, InSequence, Sequence, To};
use super::substep::{Moving, moved};
use super::{At, Pair};
use crate::collocation::{GAUSS_16, collocate};
use crate::parts::{HamiltonEquations, Mu, Q, Substep};
use crate::space::{minus, plus};
use crate::sums::Sums;
use crate::{Error, Method, Scalar, Space};

/// Steps of order 16 by collocation of (q, p), N numbers, whose slopes take K numbers of the time alone.
pub type Collocated<const N: usize, const K: usize = 0> = InSequence<Order<N, K>>;

/// The order of a [`Collocated`] step.
pub struct Order<const N: usize, const K: usize>;

impl<S: Substep<0, M> + HamiltonEquations<N, K, M>, M: Method<S>, const N: usize, const K: usize> Sequence<S, M>
    for Order<N, K>
{
    type Carry = Apart;

    /// N⁺ − N = J(q⁺, p⁺) − J(q, p) is computed from the changes of q and p at the middle of the step. This is exact,
    /// since J is linear in p and affine in q.
    #[inline]
    fn step(at: At<'_, S, M>, (q, mu, left): From<'_, S, M, Apart>, _: &S::Input) -> To<S, M, Apart> {
        let (mut state, ()) = Moving::<S, M>::start::<Apart>(q, mu, left);
        let system = at.system;
        // If rounding has moved q off its orbit, J(q, p) of a covector of μ misses μ by as much. The covector of the
        // difference is added, or N would drift.
        let p = system.covector(at.constants, q, mu);
        let p = plus(&p, &system.covector(at.constants, q, &minus(mu, &system.momentum(q, &p))));
        let (dq, dp) = change(at, q, &p, mu)?;
        let half = S::Scalar::from_ratio(1, 2);
        let middle_q = q.zip_map(&dq, |q, dq| q + half * dq);
        let middle_p = p.zip_map(&dp, |p, dp| p + half * dp);
        let by_q = system.momentum(&dq, &middle_p);
        let by_q = if S::IS_AFFINE { minus(&by_q, &system.momentum(&Q::<S>::origin(), &middle_p)) } else { by_q };
        let added = plus(&by_q, &system.momentum(&middle_q, &dp));
        state.q = S::Sums::sum(&state.q, &mut state.rests.0, &dq);
        state.on_space();
        state.push(Some(added));
        Ok(state.end::<Apart>(()))
    }

    fn step_symmetric(at: At<'_, S, M>, q: &Q<S>, p: &Q<S>) -> Result<Pair<S>, Error> {
        let (dq, dp) = change(at, q, p, &at.system.momentum(q, p))?;
        Ok((plus(q, &dq), plus(p, &dp)))
    }
}

/// (q⁺ − q, p⁺ − p), by collocation at eight nodes.
#[inline]
fn change<S: HamiltonEquations<N, K, M>, M: Method<S>, const N: usize, const K: usize>(
    At { system, constants, t, .. }: At<'_, S, M>,
    q: &Q<S>,
    p: &Q<S>,
    mu: &Mu<S>,
) -> Result<Pair<S>, Error> {
    let x = system.guess(constants, t, q, mu);
    // moved along by the velocity of the start, on the orbit of q
    let along = |part| {
        let x = S::part(&x, part);
        let d = system.increment(&x);
        let q_there = moved(system, q, &x, &d);
        S::joined(&q_there, &system.lift(&q_there, p, &d))
    };
    let change = collocate::<S::Scalar, N, K, 8, 4>(
        &GAUSS_16,
        (t, S::step_size(constants)),
        &S::joined(q, p),
        (S::TOLERANCE, S::SWEEPS),
        along,
        |t| system.terms_of_time(constants, t),
        |t, terms, y| system.slope(constants, t, terms, y),
    )?;
    Ok(S::parted(&change))
}
