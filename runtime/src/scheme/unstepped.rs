//! The scheme of a declaration that has an error.

use super::{At, Before, Pair, Scheme, Stepped};
use crate::parts::{Mu, Q};
use crate::{Clebsch, Error, Method};

/// No scheme: of a declaration with an error, so that nothing else is reported. It is never called.
pub struct Unstepped;

impl<S: Clebsch, M: Method<S>> Scheme<S, M> for Unstepped {
    type Left = ();

    momentum_is_held!(M);

    fn left(_: At<'_, S, M>, _: &Q<S>, _: &Mu<S>) {}

    fn step(_: At<'_, S, M>, _: Before<'_, S, Self, M>, _: &S::Input) -> Stepped<S, Self, M> {
        Err(Error::NoCovector)
    }

    fn step_symmetric(_: At<'_, S, M>, _: &Q<S>, _: &Q<S>) -> Result<Pair<S>, Error> {
        Err(Error::NoCovector)
    }

    fn inverse_legendre(_: At<'_, S, M>, _: &Q<S>, _: &Mu<S>) -> Result<S::Element, Error> {
        Err(Error::NoCovector)
    }
}
