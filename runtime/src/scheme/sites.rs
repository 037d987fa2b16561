//! Equal sites, moved one after the other between kicks of all of them.

use super::{At, AtOf, Before, Pair, Scheme, Stepped, is_due, look};
use crate::parts::{F, Mu, Q, T, U};
use crate::power::{Power, SiteScheme};
use crate::space::plus;
use crate::{Clebsch, Clock, Declared, Error, Space, Time};
use core::array::from_fn;
use core::fmt::Debug;
use core::marker::PhantomData;

/// Half a kick, the moves, half a kick.
pub type SitesOfSecondOrder<const N: usize> = SitesInTurn<BothKicks, N>;
/// The moves, and a full kick.
pub type SitesOfFirstOrder<const N: usize> = SitesInTurn<EndKick, N>;
/// The moves alone: nothing ties the sites together.
pub type FreeSites<const N: usize> = SitesInTurn<NoKick, N>;

/// N sites, kicked as K says.
pub struct SitesInTurn<K, const N: usize>(PhantomData<K>);

/// When N sites are kicked.
pub trait SiteKicks<S: Power<N>, const N: usize> {
    /// The weight of the kick at the start, as a part of a step.
    const START: f64;
    /// That of the kick at the end.
    const END: f64;
    /// The data that one step passes to the next: a kick, or nothing.
    type Left: Space<S::Scalar>;

    /// The data of this kick.
    fn left(kick: impl FnOnce() -> Mu<S>) -> Self::Left;
    /// The kick, if it is left.
    fn kick(left: &Self::Left) -> Option<&Mu<S>>;
    /// Where to put the next one: `room` where it is not left.
    fn place<'a>(left: &'a mut Self::Left, room: &'a mut Mu<S>) -> &'a mut Mu<S>;
}

/// One type for each line: both weights, the data that one step passes to the next, and its three functions.
macro_rules! kicks {
    ($($doc:literal $name:ident: $start:literal, $end:literal, $left:ty,
       |$kick:pat_param| $made:expr, |$one:pat_param| $given:expr, |$next:pat_param, $room:pat_param| $place:expr;)*) => { $(
        #[doc = $doc]
        pub struct $name;

        impl<S: Power<N>, const N: usize> SiteKicks<S, N> for $name {
            const START: f64 = $start;
            const END: f64 = $end;
            type Left = $left;

            #[inline(always)]
            fn left($kick: impl FnOnce() -> Mu<S>) -> $left {
                $made
            }

            #[inline(always)]
            fn kick($one: &$left) -> Option<&Mu<S>> {
                $given
            }

            #[inline(always)]
            fn place<'a>($next: &'a mut $left, $room: &'a mut Mu<S>) -> &'a mut Mu<S> {
                $place
            }
        }
    )* };
}

kicks! {
    "Half a kick before the moves, and half of one after them." BothKicks: -0.5, -0.5, S::Momentum,
        |kick| kick(), |left| Some(left), |left, _| left;
    "A kick after the moves." EndKick: 0.0, -1.0, (), |_| (), |()| None, |(), room| room;
    "No kick." NoKick: 0.0, 0.0, (), |_| (), |()| None, |(), room| room;
}

/// The state of N sites in storage of others, with room for the gradient of the potential.
pub struct Stored<'a, S: Clebsch> {
    /// q
    pub q: &'a mut Q<S>,
    /// N
    pub mu: &'a mut Mu<S>,
    /// The kick that the end of one step and the start of the next share, where they share one.
    pub kick: &'a mut Mu<S>,
    /// Room for ∂V/∂q.
    pub gradient: &'a mut Q<S>,
    /// The time at which the room of the joints has the factors of their matrix at q; `None` where it has not.
    pub factored: &'a mut Option<T<S>>,
}

/// An error at the site with this index.
pub type AtSite = (usize, Error);

/// Steps of N sites in storage of others: nothing as large as a state is on the stack.
pub trait InStorage<S: Power<N>, const N: usize>: Scheme<S> {
    /// The room that a step needs for each site.
    type Room: Clone + Debug + Default;

    /// Makes the kick that the first step from q takes. The momenta of `state` are room.
    fn start(at: AtOf<'_, S, Self>, state: Stored<'_, S>);

    /// One step in place, with the input u of the forces, `None` where it is 0. Gives the sum of all numbers of the new state too: if it is finite, all of them are.
    fn step_in_place<'a>(
        at: AtOf<'_, S, Self>,
        u: Option<&U<S>>,
        state: Stored<'a, S>,
        room: &mut [Self::Room],
    ) -> Result<(Stored<'a, S>, T<S>), AtSite>;

    /// Whether q and N obey the joints of all sites; accepted as provided.
    #[inline]
    fn check(_at: AtOf<'_, S, Self>, _state: (&Q<S>, &Mu<S>), _room: &mut [Self::Room]) -> Result<(), AtSite> {
        Ok(())
    }

    /// One step from q, N and a kick to the place of another state. After an error that state is unspecified.
    #[inline]
    fn step_from(
        at: AtOf<'_, S, Self>,
        (q, mu, kick): (&Q<S>, &Mu<S>, &Mu<S>),
        u: Option<&U<S>>,
        state: Stored<'_, S>,
        room: &mut [Self::Room],
    ) -> Result<T<S>, AtSite> {
        state.q.copy_from_slice(q);
        state.mu.copy_from_slice(mu);
        state.kick.copy_from_slice(kick);
        Self::step_in_place(at, u, state, room).map(|(_, sum)| sum)
    }
}

impl<S: Power<N>, K: SiteKicks<S, N>, const N: usize> InStorage<S, N> for SitesInTurn<K, N> {
    type Room = ();

    fn start(At { system, constants, t, .. }: At<'_, S>, Stored { q, mu, kick, gradient, .. }: Stored<'_, S>) {
        system.kick_into(t, q, constants.part(K::START), gradient, kick, mu);
    }

    #[inline]
    fn step_in_place<'a>(
        At { system, constants, t, .. }: At<'_, S>,
        u: Option<&U<S>>,
        state: Stored<'a, S>,
        _: &mut [()],
    ) -> Result<(Stored<'a, S>, T<S>), AtSite> {
        let kick = (K::START != 0.0).then_some(&*state.kick);
        system.drift_in_place(constants, t, state.q, state.mu, kick, u)?;
        let Stored { q, mu, kick, gradient, factored } = state;
        let sum = system.kick_into(t + constants.h, q, constants.part(K::END), gradient, kick, mu);
        Ok((Stored { q, mu, kick, gradient, factored }, sum))
    }

    #[inline]
    fn step_from(
        At { system, constants, t, .. }: At<'_, S>,
        (q, mu, kick): (&Q<S>, &Mu<S>, &Mu<S>),
        u: Option<&U<S>>,
        next: Stored<'_, S>,
        _: &mut [()],
    ) -> Result<T<S>, AtSite> {
        let kick = (K::START != 0.0).then_some(kick);
        system.drift_into(constants, t, (q, mu), kick, u, (next.q, next.mu))?;
        Ok(system.kick_into(t + constants.h, next.q, constants.part(K::END), next.gradient, next.kick, next.mu))
    }
}

impl<S: Power<N>, K: SiteKicks<S, N>, const N: usize> Scheme<S> for SitesInTurn<K, N> {
    type Left = K::Left;

    momentum_is_held!(Declared);

    #[inline]
    fn left(at: At<'_, S>, q: &Q<S>, _: &Mu<S>) -> K::Left {
        K::left(|| at.system.power_kick(at.t, q, at.constants.part(K::START)))
    }

    // kicks are linear in the step size
    #[inline(always)]
    fn scaled(left: K::Left, ratio: S::Scalar) -> K::Left {
        left.zip_map(&left, |kick, _| kick * ratio)
    }

    #[inline]
    fn step(at: At<'_, S>, state: Before<'_, S, Self>, u: &U<S>) -> Stepped<S, Self> {
        Self::steps(at, at.constants.h, 1, state, u)
    }

    #[inline]
    fn step_into(
        At { system, constants, t, .. }: At<'_, S>,
        (q, mu, left): Before<'_, S, Self>,
        u: &U<S>,
        (next, moved, next_left): (&mut Q<S>, &mut Mu<S>, &mut K::Left),
    ) -> Result<(), Error> {
        let drifted = system.drift_into(constants, t, (q, mu), K::kick(left), Some(u), (next, moved));
        drifted.map_err(|(_, error)| error)?;
        if K::END != 0.0 {
            let mut gradient = [Space::origin(); N];
            let mut room = [Space::origin(); N];
            let kick = K::place(next_left, &mut room);
            system.kick_into(t + constants.h, next, constants.part(K::END), &mut gradient, kick, moved);
        }
        Ok(())
    }

    #[inline]
    fn steps(
        At { system, constants, t, .. }: At<'_, S>,
        _: S::Scalar,
        steps: usize,
        (q, mu, left): Before<'_, S, Self>,
        u: &U<S>,
    ) -> Stepped<S, Self> {
        let (mut q, mut mu, mut left) = (*q, *mu, *left);
        let mut gradient = [Space::origin(); N];
        let mut room = [Space::origin(); N];
        let mut clock = Clock::at(t);
        for number in 0..steps {
            let drifted = system.drift_in_place(constants, clock.now(), &mut q, &mut mu, K::kick(&left), Some(u));
            drifted.map_err(|(_, error)| error)?;
            clock = clock.after_step(constants.h);
            if K::END != 0.0 {
                let kick = K::place(&mut left, &mut room);
                system.kick_into(clock.now(), &q, constants.part(K::END), &mut gradient, kick, &mut mu);
            }
            if is_due(number) {
                look(&q, &mu)?;
            }
        }
        Ok((q, mu, left))
    }

    fn step_symmetric(At { system, constants, t, .. }: At<'_, S>, q: &Q<S>, p: &Q<S>) -> Result<Pair<S>, Error> {
        let kicked = |p: &Q<S>, t, q: &Q<S>, part: f64| -> Q<S> {
            let (gradient, weight) = (system.slope(t, q), constants.part(part));
            from_fn(|i| p[i].zip_map(&gradient[i], |p, slope| p + weight * slope))
        };
        let (mut next, mut moved) = (*q, kicked(p, t, q, K::START));
        for (i, (q, p)) in next.iter_mut().zip(&mut moved).enumerate() {
            let moved = |site: &_, c: &_| SiteScheme::<S, N>::step_symmetric(At::new(site, c, t), q, p);
            (*q, *p) = system.at_site(constants, i, moved)?;
        }
        let p = kicked(&moved, t + constants.h, &next, K::END);
        Ok((next, p))
    }

    fn inverse_legendre(At { system, constants, t, .. }: At<'_, S>, q: &Q<S>, mu: &Mu<S>) -> Result<F<S>, Error> {
        let kick = system.power_kick(t, q, constants.part(K::START));
        let mut elements = [Space::origin(); N];
        for (i, element) in elements.iter_mut().enumerate() {
            let n = plus(&mu[i], &kick[i]);
            let found = |site: &_, c: &_| SiteScheme::<S, N>::inverse_legendre(At::new(site, c, t), &q[i], &n);
            *element = system.at_site(constants, i, found)?;
        }
        Ok(elements)
    }
}
