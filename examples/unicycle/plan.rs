//! Plans of the unicycle, solved.

use crate::declaration::{Car, Wheel};
use crate::geodesic::Moment;
use clebsch::{Error, Optimum, Target};
use clebsch_examples::claims::largest;
use nalgebra::{Matrix3, Vector2};

/// The task.
#[derive(Clone, Copy, Debug)]
pub struct Problem {
    /// Parameters.
    pub car: Car,
    /// Where to end; from the origin.
    pub target: Target<Matrix3<f64>>,
    /// T, s.
    pub duration: f64,
}

/// A plan of least price.
#[derive(Clone, Debug)]
pub struct Plan {
    /// h, s.
    pub h: f64,
    /// Places, costates λ and inputs of N steps, then the end with the inputs of the last step.
    pub path: Vec<Moment>,
    /// For each step the bounds that hold the inputs back.
    pub active: Vec<Vec<bool>>,
    /// Σ ℓ + φ, m²/s.
    pub price: f64,
    /// The number of directions in which the price falls.
    pub index: usize,
    /// Linearisations.
    pub iterations: u32,
    /// The remaining way to the target.
    pub gap: f64,
}

impl Problem {
    /// The plan of N steps near the inputs `guess`(t), t in the middle of a step.
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn solve<S: Wheel<C>, const C: usize>(
        &self,
        steps: u64,
        guess: impl Fn(f64) -> Vector2<f64>,
    ) -> Result<Plan, Error> {
        let control = S::with(&self.car).control(self.duration / steps as f64)?;
        let start = Matrix3::identity();
        let stage = |k: u64| control.stage(&start).with_input(guess((k as f64 + 0.5) * control.step_size()));
        let mut plan: Vec<_> = (0..steps).map(stage).collect();
        control.solve(&start, self.target, &mut plan).map(|optimum| Plan::of(&optimum))
    }

    /// The same with the step size at which the price is least, within a factor of a thousand of that of `solve`.
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn solve_free_time<S: Wheel<C>, const C: usize>(
        &self,
        steps: u64,
        guess: impl Fn(f64) -> Vector2<f64>,
    ) -> Result<Plan, Error> {
        let control = S::with(&self.car).control(self.duration / steps as f64)?;
        let (h, start) = (control.step_size(), Matrix3::identity());
        let stage = |k: u64| control.stage(&start).with_input(guess((k as f64 + 0.5) * h));
        let mut plan: Vec<_> = (0..steps).map(stage).collect();
        let found = control.solve_free_time(&start, self.target, h / 1e3..=1e3 * h, &mut plan)?;
        Ok(Plan::of(&found))
    }

    /// Plans with N, 2N and 4N steps: each is the guess of the next, so that they are the same plan.
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn refine<S: Wheel<C>, const C: usize>(
        &self,
        steps: u64,
        guess: impl Fn(f64) -> Vector2<f64>,
    ) -> Result<[Plan; 3], Error> {
        let coarse = self.solve::<S, C>(steps, guess)?;
        let middle = self.solve::<S, C>(2 * steps, |t| coarse.input(t))?;
        let fine = self.solve::<S, C>(4 * steps, |t| middle.input(t))?;
        Ok([coarse, middle, fine])
    }
}

impl Plan {
    /// The result.
    pub fn of<S: Wheel<C>, const C: usize>(optimum: &Optimum<'_, S, 3, 2, C>) -> Self {
        let moment = |place, costate, input| Moment { place, costate, input };
        let stages = optimum.stages();
        let last = stages.last().map_or(Vector2::zeros(), |stage| *stage.input());
        let steps = stages.iter().map(|stage| moment(*stage.place(), -stage.costate(), *stage.input()));
        Self {
            h: optimum.step_size(),
            path: steps.chain([moment(*optimum.end(), -optimum.final_costate(), last)]).collect(),
            active: stages.iter().map(|stage| stage.active().to_vec()).collect(),
            price: optimum.price(),
            index: optimum.negative(),
            iterations: optimum.iterations(),
            gap: optimum.gap(),
        }
    }

    /// The number of steps.
    pub fn steps(&self) -> usize {
        self.active.len()
    }

    /// The time of the end, s.
    pub fn duration(&self) -> f64 {
        self.h * self.steps() as f64
    }

    /// The inputs at a time.
    pub fn input(&self, t: f64) -> Vector2<f64> {
        self.path[((t / self.h) as usize).min(self.steps() - 1)].input
    }

    /// The end.
    pub fn end(&self) -> &Moment {
        &self.path[self.steps()]
    }

    /// By how much (λ_x, λ_y), turned into space, moves; and its length.
    pub fn costate_moves(&self) -> (f64, f64) {
        let in_space = |moment: &Moment| moment.place.fixed_view::<2, 2>(0, 0) * moment.costate.fixed_rows::<2>(1);
        let first = in_space(&self.path[0]);
        (largest(self.path.iter().map(|moment| (in_space(moment) - first).norm())), first.norm())
    }
}
