//! A run: a stepper, its state, and the largest errors so far.

use crate::refusal::Refusal;
use clebsch::{Clebsch, Declared, Error, Method, State, Stepper};
use nalgebra::Vector3;

/// The parts of a scene that its declaration does not say.
pub trait Scene: Clebsch<Scalar = f64> {
    /// The momenta that the motion conserves, kg·m²/s. A component that has no use is zero.
    fn conserved(q: &Self::Configuration, momentum: &Self::Momentum) -> Vector3<f64>;

    /// The numbers that the page draws: the entries of the configuration, a matrix row by row.
    fn drawn(q: &Self::Configuration) -> impl Iterator<Item = f64>;
}

/// A run of any scene, as the exported functions see it.
pub trait Shown {
    /// Makes steps. Where one fails, the run is at the state before it.
    ///
    /// # Errors
    /// The reason for which a step failed.
    fn advance(&mut self, steps: u32) -> Result<(), Refusal>;

    /// One number of the run:
    ///
    /// | place | number |
    /// |---|---|
    /// | 0 | time, s |
    /// | 1 | steps |
    /// | 2 | energy, J |
    /// | 3 | energy less the energy at the start, J |
    /// | 4 | largest size of place 3 so far, J |
    /// | 5 | largest change of the conserved momenta so far, kg·m²/s |
    /// | 6 | longest step that has a solution, s; NaN unless a step was too long and one was found |
    /// | 7 to 9 | the conserved momenta, kg·m²/s |
    /// | 10 and up | the entries of the configuration |
    fn number(&self, place: u32) -> Option<f64>;
}

/// A stepper, its state, and the largest errors so far.
pub struct Run<S: Scene, M: Method<S> = Declared> {
    stepper: Stepper<S, M>,
    state: State<S, M>,
    steps: u64,
    /// At the start.
    energy: f64,
    /// At the start.
    conserved: Vector3<f64>,
    energy_error: f64,
    momentum_error: f64,
    longest_step: f64,
}

impl<S: Scene, M: Method<S>> Run<S, M> {
    /// Begins at a configuration and a momentum.
    ///
    /// # Errors
    /// The start is not finite, or is no state of the system.
    pub fn new(stepper: Stepper<S, M>, q: S::Configuration, momentum: S::Momentum) -> Result<Self, Refusal>
    where
        S: Clebsch<Time = ()>,
    {
        let state = stepper.state(q, momentum)?;
        let energy = stepper.energy(&state);
        let conserved = S::conserved(&q, &momentum);
        Ok(Self {
            stepper,
            state,
            steps: 0,
            energy,
            conserved,
            energy_error: 0.0,
            momentum_error: 0.0,
            longest_step: f64::NAN,
        })
    }

    /// Energy less the energy at the start, J.
    fn energy_change(&self) -> f64 {
        self.stepper.energy(&self.state) - self.energy
    }

    /// The conserved momenta of the present state, kg·m²/s.
    fn conserved_now(&self) -> Vector3<f64> {
        S::conserved(self.state.configuration(), &self.state.momentum())
    }

    fn step(&mut self) -> Result<(), Error> {
        self.state = self.stepper.step(&self.state)?;
        self.steps += 1;
        self.energy_error = self.energy_error.max(self.energy_change().abs());
        self.momentum_error = self.momentum_error.max((self.conserved_now() - self.conserved).norm());
        Ok(())
    }
}

impl<S: Scene, M: Method<S>> Shown for Run<S, M> {
    fn advance(&mut self, steps: u32) -> Result<(), Refusal> {
        for _ in 0..steps {
            if let Err(error) = self.step() {
                if let Error::Unsolvable { solvable_step: Some(longest), .. } = error {
                    self.longest_step = longest;
                }
                return Err(error.into());
            }
        }
        Ok(())
    }

    fn number(&self, place: u32) -> Option<f64> {
        let steps = self.steps as f64;
        let [conserved] = self.conserved_now().data.0;
        let numbers = [
            steps * self.stepper.step_size(),
            steps,
            self.stepper.energy(&self.state),
            self.energy_change(),
            self.energy_error,
            self.momentum_error,
            self.longest_step,
        ];
        numbers
            .into_iter()
            .chain(conserved)
            .chain(S::drawn(self.state.configuration()))
            .nth(usize::try_from(place).ok()?)
    }
}
