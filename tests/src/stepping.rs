//! How a system is stepped, without a stepper.

use clebsch::__private::{At, Scheme};
use clebsch::{Clebsch, Error};

type Of<S> = <S as Clebsch>::Scheme;
type Constants<S> = <Of<S> as Scheme<S>>::Constants;
type Held<S> = <Of<S> as Scheme<S>>::Held;
type Left<S> = <Of<S> as Scheme<S>>::Left;
type Q<S> = <S as Clebsch>::Configuration;

/// The methods of a system's scheme as methods of the system.
#[allow(
    clippy::missing_errors_doc,
    clippy::too_many_arguments,
    clippy::type_complexity,
    reason = "as those of the scheme"
)]
pub trait Stepping: Clebsch {
    fn step_constants(&self, h: Self::Scalar) -> Result<Constants<Self>, Error> {
        Self::Scheme::constants(self, h)
    }

    fn held(q: &Q<Self>, mu: &Self::Momentum) -> Held<Self> {
        Self::Scheme::held(q, mu)
    }

    fn momentum_held(q: &Q<Self>, held: &Held<Self>) -> Self::Momentum {
        Self::Scheme::momentum(q, held)
    }

    fn impulse(&self, constants: &Constants<Self>, t: Self::Scalar, q: &Q<Self>, mu: &Self::Momentum) -> Left<Self> {
        Self::Scheme::left(At::new(self, constants, t), q, mu)
    }

    fn step(
        &self,
        constants: &Constants<Self>,
        t: Self::Scalar,
        q: &Q<Self>,
        held: &Held<Self>,
        left: &Left<Self>,
        u: &Self::Input,
    ) -> Result<(Q<Self>, Held<Self>, Left<Self>), Error> {
        Self::Scheme::step(At::new(self, constants, t), (q, held, left), u)
    }

    fn step_symmetric(
        &self,
        constants: &Constants<Self>,
        t: Self::Scalar,
        q: &Q<Self>,
        p: &Q<Self>,
    ) -> Result<(Q<Self>, Q<Self>), Error> {
        Self::Scheme::step_symmetric(At::new(self, constants, t), q, p)
    }

    fn inverse_legendre(
        &self,
        constants: &Constants<Self>,
        t: Self::Scalar,
        q: &Q<Self>,
        mu: &Self::Momentum,
    ) -> Result<Self::Element, Error> {
        Self::Scheme::inverse_legendre(At::new(self, constants, t), q, mu)
    }
}

impl<S: Clebsch> Stepping for S {}
