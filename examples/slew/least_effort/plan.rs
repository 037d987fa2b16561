//! Plans: torques of least effort, step by step.

use super::declaration::{Place, Stage};
use super::problem::Problem;
use clebsch::Target;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector3};

/// A plan that was solved for.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Its steps.
    pub stages: Vec<Stage>,
    /// Where it ends.
    pub end: Place,
    /// ∫ ½ |u|² dt, N²·m²·s.
    pub effort: f64,
    /// Linearisations.
    pub iterations: u32,
    /// The residual of first-order conditions, N·m·s, in the unit of torques times the step size.
    pub residual: f64,
    /// Morse index.
    pub index: usize,
    /// s
    pub h: f64,
}

impl Plan {
    /// The plan near no torque at all, of N · `finer` steps.
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn solve(problem: &Problem, finer: u64) -> Result<Self, Failure> {
        let steering = problem.steering(finer)?;
        let (start, goal) = (problem.start(), problem.goal());
        let mut stages = vec![steering.stage(&start); (problem.steps * finer) as usize];
        let optimum = steering.solve(&start, Target::Place(goal), &mut stages)?;
        let (end, effort, iterations) = (*optimum.end(), optimum.price(), optimum.iterations());
        let (residual, index, h) = (optimum.residual(), optimum.negative(), optimum.step_size());
        Ok(Self { stages, end, effort, iterations, residual, index, h })
    }

    /// Attitudes and momenta, the end among them.
    pub fn places(&self) -> impl Iterator<Item = Place> + '_ {
        self.stages.iter().map(|stage| *stage.place()).chain([self.end])
    }

    /// The largest torque about an axis, N·m.
    pub fn largest_torque(&self) -> f64 {
        self.stages.iter().map(|stage| stage.input().amax()).fold(0.0, f64::max)
    }

    /// How many torques, one for each axis and step, are at a bound.
    pub fn held_back(&self) -> usize {
        self.stages.iter().map(|stage| stage.active().iter().filter(|&&active| active).count()).sum()
    }

    /// The least multiplier of a bound.
    pub fn least_multiplier(&self) -> f64 {
        self.stages.iter().map(|stage| stage.multipliers().min()).fold(f64::INFINITY, f64::min)
    }

    /// By how much R p, the costate of the attitude seen in space, moves: turning all attitudes alike changes no price.
    pub fn costate_moves(&self) -> (f64, f64) {
        let seen = |stage: &Stage| stage.place().0 * stage.costate().fixed_rows::<3>(0);
        let first = self.stages.first().map_or_else(Vector3::zeros, seen);
        let moved = self.stages.iter().map(|stage| (seen(stage) - first).norm()).fold(0.0, f64::max);
        (moved, first.norm())
    }

    /// The largest difference of the momentum in space from the sum of the torques' impulses, ½ h (R u + R⁺ u) a step.
    /// The second number is its largest length.
    pub fn momentum_book(&self) -> (f64, f64) {
        let places: Vec<Place> = self.places().collect();
        let (mut book, mut off, mut largest) = (Vector3::zeros(), 0.0_f64, 0.0_f64);
        for (stage, ends) in self.stages.iter().zip(places.windows(2)) {
            book += (ends[0].0 + ends[1].0) * stage.input() * (self.h / 2.0);
            let momentum = ends[1].0 * ends[1].1;
            off = off.max((momentum - book).norm());
            largest = largest.max(momentum.norm());
        }
        (off, largest)
    }

    /// The work of the torques minus the kinetic energy, at most on the way, J, and the largest kinetic energy.
    pub fn energy_book(&self, inverse_inertia: &Matrix3<f64>) -> (f64, f64) {
        let places: Vec<Place> = self.places().collect();
        let (mut work, mut off, mut largest) = (0.0, 0.0_f64, 0.0_f64);
        for (stage, ends) in self.stages.iter().zip(places.windows(2)) {
            let mean = inverse_inertia * (ends[0].1 + ends[1].1) / 2.0;
            work += stage.input().dot(&mean) * self.h;
            let energy = ends[1].1.dot(&(inverse_inertia * ends[1].1)) / 2.0;
            off = off.max((work - energy).abs());
            largest = largest.max(energy);
        }
        (off, largest)
    }
}
