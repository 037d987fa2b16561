//! Sites that are joined: the moves of all of them, with multipliers, between kicks.

use super::sites::{AtSite, BothKicks, InStorage, NoKick, SiteKicks, SitesInTurn, Stored};
use super::{At, AtOf, Before, Pair, Push, Scheme, Stepped, is_due, look};
use crate::joints::{Joined, Joint, JointOf, Joints, least_of_steps};
use crate::parts::{F, Mu, Q, T, U};
use crate::space::plus;
use crate::{Clock, Declared, Error, Space, Time};
use core::array::from_fn;
use core::marker::PhantomData;

/// Half a kick, the moves, half a kick.
pub type JoinedSitesOfSecondOrder<const N: usize, const R: usize, const M: usize> = JoinedSites<BothKicks, N, R, M>;
/// The moves alone: no potential ties the sites together.
pub type FreeJoinedSites<const N: usize, const R: usize, const M: usize> = JoinedSites<NoKick, N, R, M>;

/// N sites with at most R rows of joints each, along motions of M components, kicked as K says.
///
/// ```text
/// N + kick,    φ(t + h, q⁺) = 0 with the free steps of N_i + (Aᵀλ)_i,    kick,    N⁺ + Aᵀμ
/// ```
pub struct JoinedSites<K, const N: usize, const R: usize, const M: usize>(PhantomData<K>);

impl<S: Joined<N, R, M>, K: SiteKicks<S, N>, const N: usize, const R: usize, const M: usize> InStorage<S, N>
    for JoinedSites<K, N, R, M>
{
    type Room = JointOf<S, N, R, M>;

    fn start(At { system, constants, t, .. }: At<'_, S>, Stored { q, mu, kick, gradient }: Stored<'_, S>) {
        system.kick_into(t, q, constants.part(K::START), gradient, kick, mu);
    }

    #[inline]
    fn step_in_place<'a>(
        at: At<'_, S>,
        u: Option<&U<S>>,
        state: Stored<'a, S>,
        room: &mut [Self::Room],
    ) -> Result<(Stored<'a, S>, T<S>), AtSite> {
        Self::step_telling(at, u, state, room, |_| {})
    }

    fn check(at: AtOf<'_, S, Self>, (q, mu): (&Q<S>, &Mu<S>), room: &mut [Self::Room]) -> Result<(), AtSite> {
        let found = room.len();
        let Ok(room) = room.try_into() else { return Err((0, Error::NumberOfSites { found, sites: N })) };
        Joints::<S, N, R, M>::check(at.system, at.t, q)?;
        let (violation, site) = Joints::new(at.system, at.constants, room)?.defect(at.t, q, mu)?;
        violation.check().map_err(|error| (site, error))
    }
}

impl<K, const N: usize, const R: usize, const M: usize> JoinedSites<K, N, R, M> {
    /// One step in place, which tells each push of the joints to `pushed`.
    #[inline(always)]
    fn step_telling<'a, S: Joined<N, R, M>>(
        At { system, constants, t, .. }: At<'_, S>,
        u: Option<&U<S>>,
        Stored { q, mu, kick, gradient }: Stored<'a, S>,
        room: &mut [JointOf<S, N, R, M>],
        mut pushed: impl FnMut(Told<'_, '_, S, N, R, M>),
    ) -> Result<(Stored<'a, S>, T<S>), AtSite>
    where
        K: SiteKicks<S, N>,
    {
        let found = room.len();
        let Ok(room) = room.try_into() else { return Err((0, Error::NumberOfSites { found, sites: N })) };
        let mut joints = Joints::new(system, constants, room)?;
        if K::START != 0.0 {
            mu.iter_mut().zip(&*kick).for_each(|(mu, kick)| *mu = plus(mu, kick));
        }
        // the gradient and the kick are made after the move: their places are free
        joints.moved(t, (q, mu), u, (gradient, kick))?;
        pushed(Told { joints: &joints, place: q, is_after: false });
        q.copy_from_slice(gradient);
        mu.copy_from_slice(kick);
        let sum = system.kick_into(t + constants.h, q, constants.part(K::END), gradient, kick, mu);
        let added = joints.projected(t + constants.h, q, mu, least_of_steps())?;
        pushed(Told { joints: &joints, place: q, is_after: true });
        Ok((Stored { q, mu, kick, gradient }, sum + added))
    }

    /// Steps, whose pushes are told.
    #[inline(always)]
    fn steps_telling<S: Joined<N, R, M>>(
        At { system, constants, t, .. }: At<'_, S>,
        steps: usize,
        (q, mu, left): Before<'_, S, Self>,
        u: &U<S>,
        mut pushed: impl FnMut(Told<'_, '_, S, N, R, M>),
    ) -> Stepped<S, Self>
    where
        K: SiteKicks<S, N>,
    {
        let (mut q, mut mu, mut left) = (*q, *mu, *left);
        let mut gradient = [Space::origin(); N];
        let mut room = [Space::origin(); N];
        let mut joints: [_; N] = from_fn(|_| Joint::default());
        let mut clock = Clock::at(t);
        for number in 0..steps {
            let kick = K::place(&mut left, &mut room);
            let stored = Stored { q: &mut q, mu: &mut mu, kick, gradient: &mut gradient };
            let at = At::new(system, constants, clock.now());
            Self::step_telling(at, Some(u), stored, &mut joints, &mut pushed).map_err(|(_, error)| error)?;
            clock = clock.after_step(constants.h);
            if is_due(number) {
                look(&q, &mu)?;
            }
        }
        Ok((q, mu, left))
    }
}

/// A push of the joints in a step, at the configuration `place` at the start or at the end.
struct Told<'j, 'a, S: Joined<N, R, M>, const N: usize, const R: usize, const M: usize> {
    joints: &'j Joints<'a, S, N, R, M>,
    place: &'j Q<S>,
    is_after: bool,
}

impl<S: Joined<N, R, M>, K: SiteKicks<S, N>, const N: usize, const R: usize, const M: usize> Scheme<S>
    for JoinedSites<K, N, R, M>
{
    type Left = K::Left;

    momentum_is_held!(Declared);

    #[inline]
    fn left(at: At<'_, S>, q: &Q<S>, mu: &Mu<S>) -> K::Left {
        SitesInTurn::<K, N>::left(at, q, mu)
    }

    #[inline(always)]
    fn scaled(left: K::Left, ratio: S::Scalar) -> K::Left {
        SitesInTurn::<K, N>::scaled(left, ratio)
    }

    #[inline]
    fn step(at: At<'_, S>, state: Before<'_, S, Self>, u: &U<S>) -> Stepped<S, Self> {
        Self::steps_telling(at, 1, state, u, |_| {})
    }

    #[inline]
    fn step_pushed(
        at: At<'_, S>,
        state: Before<'_, S, Self>,
        u: &U<S>,
        mut pushed: impl FnMut(Push<'_, S>),
    ) -> Stepped<S, Self> {
        Self::steps_telling(at, 1, state, u, |Told { joints, place, is_after }| {
            pushed(Push { at, place, momentum: &joints.pushes(is_after), is_after });
        })
    }

    #[inline]
    fn steps(at: At<'_, S>, _: S::Scalar, steps: usize, state: Before<'_, S, Self>, u: &U<S>) -> Stepped<S, Self> {
        Self::steps_telling(at, steps, state, u, |_| {})
    }

    fn step_symmetric(_: At<'_, S>, _: &Q<S>, _: &Q<S>) -> Result<Pair<S>, Error> {
        Err(Error::NoCovector)
    }

    fn inverse_legendre(at: At<'_, S>, q: &Q<S>, mu: &Mu<S>) -> Result<F<S>, Error> {
        SitesInTurn::<K, N>::inverse_legendre(at, q, mu)
    }
}
