//! Equal sites, moved one after the other between kicks of all of them.

use super::{Parted, Scheme};
use crate::power::{Constants, Motion, Point, Power, SiteMomentum};
use crate::{Clebsch, Declared, Error, Space};

/// Half a kick, the moves, half a kick.
#[derive(Clone, Copy, Debug)]
pub struct SitesOfSecondOrder<const N: usize>;

/// The moves, and a whole kick.
#[derive(Clone, Copy, Debug)]
pub struct SitesOfFirstOrder<const N: usize>;

/// The moves alone: nothing ties the sites together.
#[derive(Clone, Copy, Debug)]
pub struct FreeSites<const N: usize>;

/// What the schemes of sites have in common: constants, and states that hold their momenta.
macro_rules! of_sites {
    ($start:expr, $end:expr) => {
        momentum_is_held!(Declared);

        #[inline]
        fn step(
            system: &S,
            constants: &S::Constants,
            t: S::Scalar,
            state: (&S::Configuration, &S::Momentum, &Self::Left),
            u: &S::Input,
        ) -> Result<Parted<S, Self>, Error> {
            Self::steps(system, constants, (t, constants.part(1.0)), 1, state, u)
        }

        fn step_symmetric(
            system: &S,
            constants: &S::Constants,
            t: S::Scalar,
            q: &S::Configuration,
            p: &S::Configuration,
        ) -> Result<(S::Configuration, S::Configuration), Error> {
            system.power_step_symmetric(constants, t, q, p, $start, $end)
        }

        fn inverse_legendre(
            system: &S,
            constants: &S::Constants,
            t: S::Scalar,
            q: &S::Configuration,
            mu: &S::Momentum,
        ) -> Result<S::Element, Error> {
            system.power_inverse_legendre(constants, t, q, mu, $start)
        }
    };
}

impl<S, const N: usize> Scheme<S> for SitesOfSecondOrder<N>
where
    S: Power<N>
        + Clebsch<
            Configuration = [Point<S, N>; N],
            Element = [Motion<S, N>; N],
            Momentum = [SiteMomentum<S, N>; N],
            Constants = Constants<S, N>,
            Input = (),
        >,
{
    type Left = [SiteMomentum<S, N>; N];

    of_sites!(-0.5, -0.5);

    #[inline]
    fn left(system: &S, constants: &S::Constants, t: S::Scalar, q: &S::Configuration, _: &S::Momentum) -> Self::Left {
        system.power_kick(t, q, constants.part(-0.5))
    }

    fn steps(
        system: &S,
        constants: &S::Constants,
        (t, _): (S::Scalar, S::Scalar),
        steps: usize,
        (q, mu, kick): (&S::Configuration, &S::Momentum, &Self::Left),
        (): &(),
    ) -> Result<Parted<S, Self>, Error> {
        system.power_steps_of_second_order(constants, t, steps, q, mu, kick)
    }

    #[inline]
    fn step_into(
        system: &S,
        constants: &S::Constants,
        t: S::Scalar,
        (q, mu, kick): (&S::Configuration, &S::Momentum, &Self::Left),
        (): &(),
        (next, moved, left): (&mut S::Configuration, &mut S::Momentum, &mut Self::Left),
    ) -> Result<(), Error> {
        system.power_step_into(constants, t, (q, mu, Some(kick)), -0.5, (next, moved), left)
    }
}

impl<S, const N: usize> Scheme<S> for SitesOfFirstOrder<N>
where
    S: Power<N>
        + Clebsch<
            Configuration = [Point<S, N>; N],
            Element = [Motion<S, N>; N],
            Momentum = [SiteMomentum<S, N>; N],
            Constants = Constants<S, N>,
            Input = (),
        >,
{
    type Left = ();

    of_sites!(0.0, -1.0);

    #[inline(always)]
    fn left(_: &S, _: &S::Constants, _: S::Scalar, _: &S::Configuration, _: &S::Momentum) {}

    fn steps(
        system: &S,
        constants: &S::Constants,
        (t, _): (S::Scalar, S::Scalar),
        steps: usize,
        (q, mu, ()): (&S::Configuration, &S::Momentum, &()),
        (): &(),
    ) -> Result<Parted<S, Self>, Error> {
        system.power_steps_of_first_order(constants, t, steps, q, mu)
    }

    #[inline]
    fn step_into(
        system: &S,
        constants: &S::Constants,
        t: S::Scalar,
        (q, mu, ()): (&S::Configuration, &S::Momentum, &()),
        (): &(),
        (next, moved, ()): (&mut S::Configuration, &mut S::Momentum, &mut ()),
    ) -> Result<(), Error> {
        let mut kick = [Space::origin(); N];
        system.power_step_into(constants, t, (q, mu, None), -1.0, (next, moved), &mut kick)
    }
}

impl<S, const N: usize> Scheme<S> for FreeSites<N>
where
    S: Power<N>
        + Clebsch<
            Configuration = [Point<S, N>; N],
            Element = [Motion<S, N>; N],
            Momentum = [SiteMomentum<S, N>; N],
            Constants = Constants<S, N>,
            Input = (),
        >,
{
    type Left = ();

    of_sites!(0.0, 0.0);

    #[inline(always)]
    fn left(_: &S, _: &S::Constants, _: S::Scalar, _: &S::Configuration, _: &S::Momentum) {}

    fn steps(
        system: &S,
        constants: &S::Constants,
        (t, _): (S::Scalar, S::Scalar),
        steps: usize,
        (q, mu, ()): (&S::Configuration, &S::Momentum, &()),
        (): &(),
    ) -> Result<Parted<S, Self>, Error> {
        system.power_drift(constants, t, steps, q, mu).map(|(q, mu)| (q, mu, ()))
    }
}
