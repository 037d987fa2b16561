//! One substep: kick, solve, move, update, kick.

use super::sequence::{Carry, LeftBy, parted};
use super::{At, Pair};
use crate::parts::{Mu, Parts, Q, Substep};
use crate::sums::{Rests, Sums};
use crate::{Clebsch, Error, Method, Scalar, Space};

/// The rounding errors of q and N of a system so far.
pub(super) type RestsOf<S, M> = Rests<<S as Parts<M>>::Sums, <S as Clebsch>::Scalar, Q<S>, Mu<S>>;

/// (q, N) while it moves, with the rounding errors.
pub(super) struct Moving<S: Parts<M>, M: Method<S>> {
    pub q: Q<S>,
    pub mu: Mu<S>,
    pub rests: RestsOf<S, M>,
}

impl<S: Parts<M>, M: Method<S>> Moving<S, M> {
    /// From a state, with the impulse that its last step has left.
    #[inline(always)]
    pub fn start<'a, C: Carry<S, M>>(q: &Q<S>, mu: &Mu<S>, left: &'a LeftBy<S, M, C>) -> (Self, &'a C::Impulse) {
        let (impulse, rests) = parted::<S, M, C>(left);
        (Self { q: *q, mu: *mu, rests }, impulse)
    }

    /// The state, with an impulse for its next step.
    #[inline(always)]
    pub fn end<C: Carry<S, M>>(self, impulse: C::Impulse) -> (Q<S>, Mu<S>, LeftBy<S, M, C>) {
        (self.q, self.mu, S::Sums::joined(impulse, self.rests))
    }

    /// q, brought back to its space.
    #[inline(always)]
    pub fn on_space(&mut self) {
        (self.q, self.rests.0) = S::on_space(self.q, self.rests.0);
    }

    /// N, and a kick.
    #[inline(always)]
    pub fn push(&mut self, kick: Option<Mu<S>>) {
        if let Some(kick) = kick {
            self.mu = S::Sums::sum(&self.mu, &mut self.rests.1, &kick);
        }
    }

    /// (q⁺, M⁺), from M or from the q before the move.
    #[inline(always)]
    pub fn drift<const K: usize>(&mut self, at: At<'_, S, M>, x: &S::Coordinates)
    where
        S: Substep<K, M>,
    {
        let motion = at.system.motion(x, || at.system.increment(x));
        // copies: a reference to a part of the state would put all of it in memory
        let from = self.q;
        let mu = self.mu;
        self.q = S::Sums::made(&from, &mut self.rests.0, at.system.advance(&from, &motion));
        if let Some(updated) = at.system.update(at.constants, at.t, &from, &mu, &motion) {
            self.mu = S::Sums::made(&mu, &mut self.rests.1, updated);
        }
    }
}

/// One substep, from its first kick to the one before its last. `pushed` is told the push of the constraint. Values that
/// do not change stay in place, without a copy.
#[inline(always)]
pub(super) fn substep<S: Substep<K, M>, M: Method<S>, const K: usize>(
    at: At<'_, S, M>,
    (q, mu): (&Q<S>, &Mu<S>),
    mut rests: RestsOf<S, M>,
    kick: Option<Mu<S>>,
    u: &S::Input,
    mut pushed: impl FnMut(&Mu<S>),
) -> Result<Moving<S, M>, Error> {
    let At { system, constants, t, .. } = at;
    let add = |mu: &Mu<S>, kick: &Mu<S>, rest: &mut _| S::Sums::sum(mu, rest, kick);
    let mut kicked = None;
    let mut forced = None;
    let mut at_rest = None;
    let mut moving = None;
    let mut held_back = None;
    let mu = with(mu, kick, &mut kicked, |mu, kick| add(mu, kick, &mut rests.1));
    let force = system.start_force(constants, t, q, u);
    let mu = with(mu, force, &mut forced, |mu, kick| add(mu, kick, &mut rests.1));
    let target = with(mu, rest_apart::<S, M, K>(at, q), &mut at_rest, |mu, rest| plus(*mu, Some(*rest)));
    let x = system.solve(constants, t, q, target, u)?;
    let motion = system.motion(&x, || system.increment(&x));
    let reaction = system.reaction(constants, t, q, target, &x, u);
    reaction.iter().for_each(&mut pushed);
    let mu = with(mu, reaction, &mut held_back, |mu, push| add(mu, push, &mut rests.1));
    let force = system.moving_force(constants, t, q, &x, u);
    let mu = with(mu, force, &mut moving, |mu, kick| add(mu, kick, &mut rests.1));
    let next = S::Sums::made(q, &mut rests.0, system.advance(q, &motion));
    let mu = match system.update(constants, t, q, mu, &motion) {
        Some(updated) => S::Sums::made(mu, &mut rests.1, updated),
        None => *mu,
    };
    let mut state = Moving { q: next, mu, rests };
    state.push(system.end_force(constants, t, &next, &x, u));
    Ok(state)
}

/// A sum in its place, or the number itself where there is nothing to add.
#[inline(always)]
fn with<'a, V>(number: &'a V, part: Option<V>, place: &'a mut Option<V>, add: impl FnOnce(&V, &V) -> V) -> &'a V {
    match part {
        Some(part) => place.insert(add(number, &part)),
        None => number,
    }
}

/// −r(I) where it is not in the first kick: the solve is for M − r(I), the move carries M, and compensated sums tell them apart.
#[inline(always)]
fn rest_apart<S: Substep<K, M>, M: Method<S>, const K: usize>(at: At<'_, S, M>, q: &Q<S>) -> Option<Mu<S>> {
    if S::Sums::ARE_COMPENSATED { at.system.rest(at.constants, at.t, q) } else { None }
}

/// The sum with a part that may not be there.
#[inline(always)]
pub(super) fn plus<T: Scalar, V: Space<T>>(sum: V, part: Option<V>) -> V {
    match part {
        Some(part) => sum.zip_map(&part, |a, b| a + b),
        None => sum,
    }
}

/// The momentum to solve for, from N before the kick and without forces.
#[inline(always)]
fn kicked<S: Substep<K, M>, M: Method<S>, const K: usize>(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>) -> Mu<S> {
    let mu = plus(*mu, at.system.start_kick(at.constants, at.t, q));
    plus(mu, rest_apart::<S, M, K>(at, q))
}

/// The coordinates of the group element with the momentum N before the kick.
#[inline(always)]
pub(super) fn solve_before_kick<S: Substep<K, M>, M: Method<S>, const K: usize>(
    at: At<'_, S, M>,
    q: &Q<S>,
    mu: &Mu<S>,
    u: &S::Input,
) -> Result<S::Coordinates, Error> {
    let mu = plus(kicked::<S, M, K>(at, q, mu), at.system.start_force(at.constants, at.t, q, u));
    at.system.solve(at.constants, at.t, q, &mu, u)
}

/// F with F⁻ℓd(q, F) = N.
#[inline]
pub(super) fn inverse_legendre<S: Substep<K, M>, M: Method<S>, const K: usize>(
    at: At<'_, S, M>,
    q: &Q<S>,
    mu: &Mu<S>,
) -> Result<S::Element, Error> {
    let x = at.system.solve(at.constants, at.t, q, &kicked::<S, M, K>(at, q, mu), &S::Input::origin())?;
    Ok(S::element(&at.system.increment(&x)))
}

/// (q, p) ↦ (q⁺, p⁺), with the momentum J(q, p).
#[inline]
pub(super) fn symmetric<S: Substep<K, M>, M: Method<S>, const K: usize>(
    At { system, constants, t, .. }: At<'_, S, M>,
    (q, p): Pair<S>,
) -> Result<Pair<S>, Error> {
    let p = plus(p, system.start_gradient(constants, t, &q));
    let mu = plus(system.momentum_map(&q, &p), system.rest(constants, t, &q));
    let x = system.solve(constants, t, &q, &mu, &S::Input::origin())?;
    let d = system.increment(&x);
    let p = plus(p, system.coupled_gradient(constants, t, &q, &d));
    let q = moved(system, &q, &x, &d);
    let p = system.lift(&q, &p, &d);
    let p = plus(p, system.end_gradient(constants, t, &q));
    Ok((q, p))
}

/// q⁺ without a look at rounding: the step on T*Q is symplectic in all directions of T*Rⁿ.
#[inline(always)]
pub(super) fn moved<S: Parts<M>, M: Method<S>>(system: &S, q: &Q<S>, x: &S::Coordinates, d: &S::Element) -> Q<S> {
    let moved = system.advance(q, &system.motion(x, || *d));
    if S::Sums::ARE_COMPENSATED { q.zip_map(&moved, |a, b| a + b) } else { moved }
}
