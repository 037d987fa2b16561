//! The tasks of this benchmark and of that of `counts`: the work with each system.

use clebsch::{Clebsch, Conserves, Declared, Error, Method, Scalar, Space, State, Stepper};
use clebsch_tests::oracle::bits::Bits;
use std::cell::Cell;

/// The work with each system.
pub trait Task {
    /// Everything about a fixture; `conserved` prints its conserved momenta.
    fn fixture<S>(
        &self,
        name: &str,
        system: S,
        q: S::Configuration,
        h: S::Scalar,
        conserved: impl Fn(&Stepper<S>, &State<S>) -> String,
    ) where
        S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone;

    /// The trajectories of a system that differs from a fixture by its dials or its scalar.
    fn combination<S>(&self, name: &str, system: S, q: S::Configuration, h: S::Scalar)
    where
        S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone,
    {
        self.combination_by::<S, Declared>(name, system, q, h);
    }

    /// The trajectories of a system that is stepped by a method of its own.
    fn combination_by<S, M>(&self, name: &str, system: S, q: S::Configuration, h: S::Scalar)
    where
        S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone,
        M: Method<S>;
}

/// A system and where it starts.
pub struct Start<S: Clebsch, M: Method<S> = Declared> {
    pub stepper: Stepper<S, M>,
    pub q: S::Configuration,
    pub mu: S::Momentum,
}

impl<S: Clebsch<Scalar: Scalar<Lane: Bits>> + Clone, M: Method<S>> Start<S, M> {
    pub fn new(system: S, q: S::Configuration, h: S::Scalar) -> Self {
        let stepper = system.into_stepper_by::<M>(h).expect("parameters");
        let mu = stepper.project(q, uneven(1.0)).expect("a projection").momentum();
        Self { stepper, q, mu }
    }

    pub fn state(&self) -> State<S, M> {
        self.stepper.state(self.q, self.mu).expect("a state")
    }
}

/// Numbers of the size `size` that differ from each other, and from lane to lane.
pub fn uneven<T: Scalar, V: Space<T>>(size: f64) -> V {
    let count = Cell::new(0);
    V::origin().zip_map(&V::origin(), |_, _| {
        let k = count.get();
        count.set(k + 1);
        let number = |lane: usize| size * (0.2 + 0.05 * f64::from((5 * k as u32 + 3 * lane as u32) % 7));
        T::from_lanes(|lane| Scalar::from_f64(number(lane)))
    })
}

/// The last of some steps.
#[inline(never)]
pub fn stepped<S: Clebsch, M: Method<S>>(
    stepper: &Stepper<S, M>,
    mut state: State<S, M>,
    steps: usize,
) -> Result<State<S, M>, Error> {
    for _ in 0..steps {
        state = stepper.step(&state)?;
    }
    Ok(state)
}

/// The conserved momenta of a state, where there are some.
pub struct Momenta<'a, S: Clebsch>(pub &'a Stepper<S>, pub &'a State<S>);

/// Systems with conserved momenta.
pub trait Conserving {
    fn conserved(&self) -> String;
}

impl<S: Conserves> Conserving for Momenta<'_, S> {
    fn conserved(&self) -> String {
        format!("{:?}", self.0.conserved(self.1))
    }
}

/// All others: a method call finds this after the one above, as it takes one more reference.
pub trait NotConserving {
    fn conserved(&self) -> String;
}

impl<S: Clebsch> NotConserving for &Momenta<'_, S> {
    fn conserved(&self) -> String {
        String::new()
    }
}
