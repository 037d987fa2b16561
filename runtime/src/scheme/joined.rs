//! Sites that are joined: the moves of all of them, with multipliers, between kicks.

use super::sites::{AtSite, BothKicks, InStorage, NoKick, SiteKicks, SitesInTurn, Stored};
use super::{At, AtOf, Before, Pair, Push, Scheme, Stepped, is_due, look};
use crate::joints::{Border, BorderOf, Joined, Joint, JointOf, Joints, Mobile, least_of_steps};
use crate::parts::{F, Mu, Q, T, U};
use crate::power::Power;
use crate::space::plus;
use crate::{Clock, Declared, Error, Scalar, Space, Time};
use core::array::from_fn;
use core::marker::PhantomData;
use nalgebra::SVector;

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

    fn start(At { system, constants, t, .. }: At<'_, S>, Stored { q, mu, kick, gradient, .. }: Stored<'_, S>) {
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
        Joints::<S, N, R, M>::check(at.system, at.t, q)?;
        let (violation, site) = Joints::new(at.system, at.constants, of_all(room)?)?.defect(at.t, q, mu)?;
        violation.check().map_err(|error| (site, error))
    }
}

/// Joined sites in storage: starts and forces that need joints.
pub trait JoinedInStorage<S: Power<N>, const N: usize>: InStorage<S, N> {
    /// The multipliers of the joints of one site.
    type Multipliers: Space<S::Scalar>;
    /// Those of the equations that close loops.
    type OfLoops: Space<S::Scalar>;

    /// The momenta of velocities, in their place.
    fn momenta_of_velocities(at: AtOf<'_, S, Self>, q: &Q<S>, velocities: &mut Mu<S>);

    /// Moves q to φ = 0, and N to a momentum whose velocity obeys the joints.
    fn to_joints(at: AtOf<'_, S, Self>, state: (&mut Q<S>, &mut Mu<S>), room: &mut [Self::Room]) -> Result<(), AtSite>;

    /// One step in place, as `step_in_place`. Adds the impulses λ + μ of the joints to those that are given.
    fn step_with_reactions<'a>(
        at: AtOf<'_, S, Self>,
        u: Option<&U<S>>,
        state: Stored<'a, S>,
        room: &mut [Self::Room],
        impulses: (&mut [Self::Multipliers], &mut Self::OfLoops),
    ) -> Result<(Stored<'a, S>, T<S>), AtSite>;

    /// The multipliers of the motion through (q, N) with the input u. The content of `free` does not matter.
    fn reactions(
        at: AtOf<'_, S, Self>,
        state: (&Q<S>, &Mu<S>),
        u: &U<S>,
        room: &mut [Self::Room],
        free: (&mut Q<S>, &mut Mu<S>, &mut Mu<S>),
        multipliers: &mut [Self::Multipliers],
    ) -> Result<Self::OfLoops, AtSite>;
}

impl<S: Joined<N, R, M>, K: SiteKicks<S, N>, const N: usize, const R: usize, const M: usize> JoinedInStorage<S, N>
    for JoinedSites<K, N, R, M>
{
    type Multipliers = SVector<T<S>, R>;
    type OfLoops = <BorderOf<S, N, R, M> as Border<T<S>, M>>::Values;

    fn momenta_of_velocities(At { system, t, .. }: At<'_, S>, q: &Q<S>, velocities: &mut Mu<S>) {
        for (i, (q, velocity)) in q.iter().zip(velocities).enumerate() {
            *velocity = system.site(i).momentum_of_velocity(t, q, velocity);
        }
    }

    fn to_joints(
        At { system, constants, t, .. }: At<'_, S>,
        (q, mu): (&mut Q<S>, &mut Mu<S>),
        room: &mut [Self::Room],
    ) -> Result<(), AtSite> {
        let mut joints = Joints::new(system, constants, of_all(room)?)?;
        joints.placed(t, q)?;
        joints.projected(t, q, mu, T::<S>::EPSILON.sqrt()).map(|_| ())
    }

    #[inline]
    fn step_with_reactions<'a>(
        at: At<'_, S>,
        u: Option<&U<S>>,
        state: Stored<'a, S>,
        room: &mut [Self::Room],
        (impulses, of_loops): (&mut [Self::Multipliers], &mut Self::OfLoops),
    ) -> Result<(Stored<'a, S>, T<S>), AtSite> {
        Self::step_telling(at, u, state, room, |Told { joints, is_after, .. }| {
            let both = impulses.iter_mut().zip(joints.impulses(is_after));
            both.for_each(|(sum, impulse)| *sum += impulse);
            let of_border = joints.border.impulses(is_after);
            *of_loops = plus(of_loops, &of_border);
        })
    }

    fn reactions(
        At { system, constants, t, .. }: At<'_, S>,
        state: (&Q<S>, &Mu<S>),
        u: &U<S>,
        room: &mut [Self::Room],
        free: (&mut Q<S>, &mut Mu<S>, &mut Mu<S>),
        multipliers: &mut [Self::Multipliers],
    ) -> Result<Self::OfLoops, AtSite> {
        let mut joints = Joints::new(system, constants, of_all(room)?)?;
        joints.reactions(t, state, u, free)?;
        joints.solutions().zip(multipliers).for_each(|(found, place)| *place = *found);
        Ok(joints.border.solution())
    }
}

/// The room of all sites.
fn of_all<R, const N: usize>(room: &mut [R]) -> Result<&mut [R; N], AtSite> {
    let found = room.len();
    room.try_into().map_err(|_| (0, Error::NumberOfSites { found, sites: N }))
}

impl<K, const N: usize, const R: usize, const M: usize> JoinedSites<K, N, R, M> {
    /// One step in place, which tells each push of the joints to `pushed`.
    #[inline(always)]
    fn step_telling<'a, S: Joined<N, R, M>>(
        At { system, constants, t, .. }: At<'_, S>,
        u: Option<&U<S>>,
        Stored { q, mu, kick, gradient, factored }: Stored<'a, S>,
        room: &mut [JointOf<S, N, R, M>],
        mut pushed: impl FnMut(Told<'_, '_, S, N, R, M>),
    ) -> Result<(Stored<'a, S>, T<S>), AtSite>
    where
        K: SiteKicks<S, N>,
    {
        let mut joints = Joints::new(system, constants, of_all(room)?)?;
        if K::START != 0.0 {
            mu.iter_mut().zip(&*kick).for_each(|(mu, kick)| *mu = plus(mu, kick));
        }
        // the gradient and the kick are made after the move: their places are free
        // a system that no time changes has no clock
        let has_clock = size_of::<S::Time>() > 0;
        let is_factored = factored.take().is_some_and(|then| !has_clock || then == t);
        joints.moved(t, (q, mu), u, (gradient, kick), is_factored)?;
        pushed(Told { joints: &joints, place: q, is_after: false });
        q.copy_from_slice(gradient);
        mu.copy_from_slice(kick);
        let end = t + constants.h;
        let sum = system.kick_into(end, q, constants.part(K::END), gradient, kick, mu);
        let added = joints.projected(end, q, mu, least_of_steps())?;
        pushed(Told { joints: &joints, place: q, is_after: true });
        // the next step starts there
        *factored = Some(end);
        Ok((Stored { q, mu, kick, gradient, factored }, sum + added))
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
        let (mut clock, mut factored) = (Clock::at(t), None);
        for number in 0..steps {
            let kick = K::place(&mut left, &mut room);
            let factored = &mut factored;
            let stored = Stored { q: &mut q, mu: &mut mu, kick, gradient: &mut gradient, factored };
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
