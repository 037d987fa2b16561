//! A stepper with one state.

use super::Drive;
use crate::fields::getters;
use crate::{Clebsch, Declared, Error, Method, Space, State, Stepper};
use core::fmt::{self, Debug, Formatter};

/// A [`Stepper`] with a state and room for the next one. It is for states so large that passing them by value takes
/// longer than the step itself.
///
/// Its steps are those of [`Stepper::step`], to the last bit. If a step fails, the state is unchanged. A `Stepper`
/// suits small states, which it hands on in registers.
///
/// An integrator is where it is put: on the stack, in a struct of yours, or on the heap, by `Box::new(stepper.integrator(state))`, which allocates once.
///
/// ```
/// use clebsch::Clebsch;
/// use nalgebra::SVector;
///
/// /// A point on S¹⁰⁰ in a field along its last axis.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action    = |F: SO<101>, q: Unit<SVector<101>>| F * q,
///     cost      = |h, F| (F - I).norm_squared() / (4 * h),
///     potential = |q| self.gravity * q[100],
/// )]
/// struct Pendulum {
///     /// Gravity, 1/s².
///     gravity: f64,
/// }
///
/// let stepper = Pendulum { gravity: 1.0 }.into_stepper(0.01)?;
/// let start = SVector::<f64, 101>::from_fn(|i, _| if i == 0 { 1.0 } else { 0.0 });
/// let momentum = stepper.momentum_map(&start, &SVector::zeros());
/// let state = stepper.state(start, momentum)?;
/// let mut pendulum = stepper.integrator(state);
/// for _ in 0..100 {
///     pendulum.step()?;
/// }
/// assert!(pendulum.state().configuration()[100] < -0.4, "it falls");
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Integrator<S: Clebsch, M: Method<S> = Declared> {
    stepper: Stepper<S, M>,
    states: [State<S, M>; 2],
    /// Which of the states is the present one.
    is_second: bool,
    steps: u64,
}

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// This stepper with a state that it, or one of the same system, has made: stepped in place.
    pub fn integrator(self, start: State<S, M>) -> Integrator<S, M> {
        Integrator { stepper: self, states: [start, start], is_second: false, steps: 0 }
    }
}

impl<S: Clebsch, M: Method<S>> Integrator<S, M> {
    /// The state.
    #[inline]
    pub fn state(&self) -> &State<S, M> {
        let [first, second] = &self.states;
        if self.is_second { second } else { first }
    }

    /// Goes on from another state.
    pub fn set_state(&mut self, state: State<S, M>) {
        let [first, second] = &mut self.states;
        *(if self.is_second { second } else { first }) = state;
    }

    /// Adds an impulse Δμ to the momentum, as [`Stepper::kick`] does.
    ///
    /// # Errors
    /// Those of [`Stepper::kick`]. After an error the state is unchanged.
    pub fn kick(&mut self, impulse: S::Momentum) -> Result<(), Error> {
        self.set_state(self.stepper.kick(self.state(), impulse)?);
        Ok(())
    }

    /// One step of the size `duration`, as [`Stepper::step_for`] makes it.
    ///
    /// # Errors
    /// Those of [`Stepper::step_for`]. After an error the state is unchanged.
    pub fn step_for(&mut self, duration: S::Scalar) -> Result<(), Error> {
        self.set_state(self.stepper.step_for(self.state(), duration)?);
        self.steps = self.steps.saturating_add(1);
        Ok(())
    }

    getters! {
        /// The system with its step size.
        ref stepper: Stepper<S, M>;
        /// The number of steps that it has made, at most 2⁶⁴ − 1.
        copy steps: u64;
    }

    /// One step, as [`Stepper::step`] makes it.
    ///
    /// # Errors
    /// Those of [`Stepper::step`]. After an error the state is unchanged.
    #[inline]
    pub fn step(&mut self) -> Result<(), Error> {
        self.step_with(&S::Input::origin())
    }

    /// One step during which the input of the forces is `u`, as [`Stepper::step_with`] makes it.
    ///
    /// # Errors
    /// Those of [`Stepper::step_with`]. After an error the state is unchanged.
    #[inline]
    pub fn step_with(&mut self, u: &S::Input) -> Result<(), Error> {
        let [first, second] = &mut self.states;
        let (state, next) = if self.is_second { (&*second, first) } else { (&*first, second) };
        self.stepper.step_into(state, u, next)?;
        self.is_second = !self.is_second;
        self.steps = self.steps.saturating_add(1);
        Ok(())
    }

    /// So many steps, as [`Stepper::advance`] makes them.
    ///
    /// # Errors
    /// Those of [`step`](Self::step); the state is the one before the step that failed.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        let mut rest = steps;
        while rest > 0 {
            let count = usize::try_from(rest).unwrap_or(usize::MAX);
            match self.stepper.advance(self.state(), count) {
                Ok(state) => {
                    self.set_state(state);
                    self.steps = self.steps.saturating_add(count as u64);
                }
                Err(_) => (0..count).try_for_each(|_| self.step())?,
            }
            rest = rest.saturating_sub(count as u64);
        }
        Ok(())
    }
}

impl<S: Clebsch, M: Method<S>> Drive for Integrator<S, M> {
    type State<'a>
        = &'a State<S, M>
    where
        Self: 'a;
    type Error = Error;

    #[inline]
    fn step(&mut self) -> Result<(), Error> {
        Self::step(self)
    }

    fn advance(&mut self, steps: u64) -> Result<(), Error> {
        Self::advance(self, steps)
    }

    fn state(&self) -> &State<S, M> {
        Self::state(self)
    }

    fn steps(&self) -> u64 {
        Self::steps(self)
    }
}

impl<S: Clebsch + Clone, M: Method<S>> Clone for Integrator<S, M> {
    fn clone(&self) -> Self {
        let Self { stepper, states, is_second, steps } = self;
        Self { stepper: stepper.clone(), states: *states, is_second: *is_second, steps: *steps }
    }
}

impl<S: Clebsch + Debug, M: Method<S>> Debug for Integrator<S, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { stepper, steps, .. } = self;
        f.debug_struct("Integrator")
            .field("stepper", stepper)
            .field("state", self.state())
            .field("steps", steps)
            .finish()
    }
}
