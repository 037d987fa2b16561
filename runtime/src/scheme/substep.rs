//! One substep: kick, solve, move, update, kick.

use crate::parts::{MotionOf, Parts, Substep};
use crate::summation::{Rests, Sums};
use crate::{Clebsch, Error, Method, Scalar, Space};

/// What rounding has taken off q and N of a system.
type RestsOf<S, M> =
    Rests<<S as Parts<M>>::Sums, <S as Clebsch>::Scalar, <S as Clebsch>::Configuration, <S as Clebsch>::Momentum>;

/// What one step leaves to the next: an impulse I and the rests.
pub(super) type LeftOf<S, M, I> = <<S as Parts<M>>::Sums as Sums>::Left<
    <S as Clebsch>::Scalar,
    I,
    <S as Clebsch>::Configuration,
    <S as Clebsch>::Momentum,
>;

/// The state before a step: q, N, and what the last step has left.
pub(super) type Before<'a, S, M, I> =
    (&'a <S as Clebsch>::Configuration, &'a <S as Clebsch>::Momentum, &'a LeftOf<S, M, I>);

/// (q, N) while it moves, with what rounding has taken off.
pub(super) struct Moving<S: Parts<M>, M: Method<S>> {
    pub q: S::Configuration,
    pub mu: S::Momentum,
    pub rests: RestsOf<S, M>,
}

impl<S: Parts<M>, M: Method<S>> Moving<S, M> {
    /// From a state, with the impulse that its last step has left.
    #[inline(always)]
    pub fn start<'a, I: Space<S::Scalar>>(
        q: &S::Configuration,
        mu: &S::Momentum,
        left: &'a LeftOf<S, M, I>,
    ) -> (Self, &'a I) {
        let (impulse, rests) = S::Sums::parted(left);
        (Self { q: *q, mu: *mu, rests }, impulse)
    }

    /// The state, with an impulse for its next step.
    #[inline(always)]
    pub fn end<I: Space<S::Scalar>>(mut self, impulse: I) -> (S::Configuration, S::Momentum, LeftOf<S, M, I>) {
        self.on_space();
        self.finish(impulse)
    }

    /// The same of a state that is on its space.
    #[inline(always)]
    pub fn finish<I: Space<S::Scalar>>(self, impulse: I) -> (S::Configuration, S::Momentum, LeftOf<S, M, I>) {
        (self.q, self.mu, S::Sums::joined(impulse, self.rests))
    }

    /// q, kept on its space.
    #[inline(always)]
    pub fn on_space(&mut self) {
        (self.q, self.rests.0) = S::on_space(self.q, self.rests.0);
    }

    /// N, and a kick.
    #[inline(always)]
    pub fn push(&mut self, kick: Option<S::Momentum>) {
        if let Some(kick) = kick {
            self.mu = S::Sums::sum(&self.mu, &mut self.rests.1, &kick);
        }
    }

    /// q, and what is added to it.
    #[inline(always)]
    pub fn shift(&mut self, added: &S::Configuration) {
        self.q = S::Sums::sum(&self.q, &mut self.rests.0, added);
    }

    /// q⁺
    #[inline(always)]
    pub fn advance(&mut self, system: &S, motion: &MotionOf<S, M>) {
        let moved = system.advance(&self.q, motion);
        self.q = S::Sums::made(&self.q, &mut self.rests.0, moved);
    }

    /// M⁺, where M changes.
    #[inline(always)]
    pub fn update(&mut self, updated: Option<S::Momentum>) {
        if let Some(updated) = updated {
            self.mu = S::Sums::made(&self.mu, &mut self.rests.1, updated);
        }
    }
}

/// One substep, from its first kick to the one before its last.
///
/// What does not change stays where it is, and is not copied.
///
/// # Errors
/// Those of the solve.
#[inline(always)]
pub(super) fn substep<S: Substep<K, M>, M: Method<S>, const K: usize>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    (q, mu): (&S::Configuration, &S::Momentum),
    mut rests: RestsOf<S, M>,
    kick: Option<S::Momentum>,
    u: &S::Input,
) -> Result<Moving<S, M>, Error> {
    let add = |mu: &S::Momentum, kick: &S::Momentum, rest: &mut _| S::Sums::sum(mu, rest, kick);
    let mut kicked = None;
    let mut forced = None;
    let mut at_rest = None;
    let mut moving = None;
    let mu = with(mu, kick, &mut kicked, |mu, kick| add(mu, kick, &mut rests.1));
    let force = system.start_force(constants, t, q, u);
    let mu = with(mu, force, &mut forced, |mu, kick| add(mu, kick, &mut rests.1));
    let rest = rest_apart::<S, M, K>(system, constants, t, q);
    let target = with(mu, rest, &mut at_rest, |mu, rest| plus(*mu, Some(*rest)));
    let x = system.solve(constants, t, q, target, u)?;
    let motion = system.motion(&x, || system.increment(&x));
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

/// −r(I) where it is not in the first kick.
#[inline(always)]
fn rest_apart<S: Substep<K, M>, M: Method<S>, const K: usize>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    q: &S::Configuration,
) -> Option<S::Momentum> {
    if S::Sums::ARE_COMPENSATED { system.rest(constants, t, q) } else { None }
}

/// The momentum to solve for. What is solved for is M − r(I), and what the move carries is M; compensated sums keep both apart.
#[inline(always)]
fn at_rest<S: Substep<K, M>, M: Method<S>, const K: usize>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    q: &S::Configuration,
    mu: S::Momentum,
) -> S::Momentum {
    plus(mu, rest_apart::<S, M, K>(system, constants, t, q))
}

/// The sum with a part that may not be there.
#[inline(always)]
pub(super) fn plus<T: Scalar, V: Space<T>>(sum: V, part: Option<V>) -> V {
    match part {
        Some(part) => sum.zip_map(&part, |a, b| a + b),
        None => sum,
    }
}

/// The coordinates of the group element with the momentum N before the kick.
///
/// # Errors
/// Those of the solve.
#[inline(always)]
pub(super) fn solve_before_kick<S: Substep<K, M>, M: Method<S>, const K: usize>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    q: &S::Configuration,
    mu: &S::Momentum,
    u: &S::Input,
) -> Result<S::Coordinates, Error> {
    let mu = plus(*mu, system.start_kick(constants, t, q));
    let mu = at_rest::<S, M, K>(system, constants, t, q, mu);
    let mu = plus(mu, system.start_force(constants, t, q, u));
    system.solve(constants, t, q, &mu, u)
}

/// F with F⁻ℓd(q, F) = N.
///
/// # Errors
/// Those of the solve.
#[inline]
pub(super) fn inverse_legendre<S: Substep<K, M>, M: Method<S>, const K: usize>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    q: &S::Configuration,
    mu: &S::Momentum,
) -> Result<S::Element, Error> {
    let mu = plus(*mu, system.start_kick(constants, t, q));
    let mu = at_rest::<S, M, K>(system, constants, t, q, mu);
    let x = system.solve(constants, t, q, &mu, &S::Input::origin())?;
    Ok(S::element(&system.increment(&x)))
}

/// (q, p) ↦ (q⁺, p⁺), with the momentum J(q, p).
///
/// # Errors
/// Those of the solve.
#[inline]
pub(super) fn symmetric<S: Substep<K, M>, M: Method<S>, const K: usize>(
    system: &S,
    constants: &M::Constants,
    t: S::Scalar,
    (q, p): (S::Configuration, S::Configuration),
) -> Result<(S::Configuration, S::Configuration), Error> {
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
pub(super) fn moved<S: Parts<M>, M: Method<S>>(
    system: &S,
    q: &S::Configuration,
    x: &S::Coordinates,
    d: &S::Element,
) -> S::Configuration {
    let moved = system.advance(q, &system.motion(x, || *d));
    S::Sums::made_plainly(q, moved)
}

/// What the end of one step and the start of the next have in common.
pub trait Carry<S: Clebsch> {
    /// What one step leaves to the next.
    type Impulse: Space<S::Scalar>;

    /// The impulse of this kick.
    fn impulse(kick: Option<S::Momentum>) -> Self::Impulse;

    /// The kick at the start of a step, where the last one has left this impulse.
    fn kick(impulse: &Self::Impulse, anew: impl FnOnce() -> Option<S::Momentum>) -> Option<S::Momentum>;

    /// The impulse of a step that is `ratio` times as long: kicks are linear in the step size.
    fn scaled(impulse: Self::Impulse, ratio: S::Scalar) -> Self::Impulse;
}

/// The kick at the end of one step is that at the start of the next.
#[derive(Clone, Copy, Debug)]
pub struct Shared;

impl<S: Clebsch> Carry<S> for Shared {
    type Impulse = S::Momentum;

    #[inline(always)]
    fn impulse(kick: Option<S::Momentum>) -> S::Momentum {
        match kick {
            Some(kick) => kick,
            None => S::Momentum::origin(),
        }
    }

    #[inline(always)]
    fn kick(impulse: &S::Momentum, _: impl FnOnce() -> Option<S::Momentum>) -> Option<S::Momentum> {
        Some(*impulse)
    }

    #[inline(always)]
    fn scaled(impulse: S::Momentum, ratio: S::Scalar) -> S::Momentum {
        impulse.zip_map(&impulse, |kick, _| kick * ratio)
    }
}

/// Each step makes its own kicks.
#[derive(Clone, Copy, Debug)]
pub struct Apart;

impl<S: Clebsch> Carry<S> for Apart {
    type Impulse = ();

    #[inline(always)]
    fn impulse(_: Option<S::Momentum>) {}

    #[inline(always)]
    fn kick((): &(), anew: impl FnOnce() -> Option<S::Momentum>) -> Option<S::Momentum> {
        anew()
    }

    #[inline(always)]
    fn scaled((): (), _: S::Scalar) {}
}
