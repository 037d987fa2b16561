//! What stands where a declaration has an error.

use super::{Parted, Scheme};
use crate::{Clebsch, Error, Method};

/// No scheme: of a declaration with an error, so that nothing else is reported. It is never called.
#[derive(Clone, Copy, Debug)]
pub struct Unstepped;

/// What it would say.
const UNSTEPPED: Error = Error::NoCovector;

impl<S: Clebsch, M: Method<S, Constants = ()>> Scheme<S, M> for Unstepped {
    type Held = S::Momentum;
    type Left = ();
    type Constants = ();

    fn constants(system: &S, h: S::Scalar) -> Result<(), Error> {
        M::constants(system, h)
    }

    fn whole(constants: &()) -> &() {
        constants
    }

    fn held(_: &S::Configuration, mu: &S::Momentum) -> S::Momentum {
        *mu
    }

    fn momentum(_: &S::Configuration, held: &S::Momentum) -> S::Momentum {
        *held
    }

    fn left(_: &S, (): &(), _: S::Scalar, _: &S::Configuration, _: &S::Momentum) {}

    fn step(
        _: &S,
        (): &(),
        _: S::Scalar,
        _: (&S::Configuration, &S::Momentum, &()),
        _: &S::Input,
    ) -> Result<Parted<S, Self, M>, Error> {
        Err(UNSTEPPED)
    }

    fn step_symmetric(
        _: &S,
        (): &(),
        _: S::Scalar,
        _: &S::Configuration,
        _: &S::Configuration,
    ) -> Result<(S::Configuration, S::Configuration), Error> {
        Err(UNSTEPPED)
    }

    fn inverse_legendre(
        _: &S,
        (): &(),
        _: S::Scalar,
        _: &S::Configuration,
        _: &S::Momentum,
    ) -> Result<S::Element, Error> {
        Err(UNSTEPPED)
    }
}
