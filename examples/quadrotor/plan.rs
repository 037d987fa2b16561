//! Plans: thrusts of least effort, step by step.

use super::declaration::{Place, Stage, Thrusts};
use super::place::{attitude, position};
use super::problem::Problem;
use clebsch::Target;
use clebsch_examples::scene::Failure;

/// A plan that was solved for.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Its steps.
    pub stages: Vec<Stage>,
    /// Where it ends.
    pub end: Place,
    /// The distance to the goal, of all entries.
    pub gap: f64,
    /// ½ ∫ Σ (u/u₀ − 1)² dt with the thrust u₀ at hover, s.
    pub effort: f64,
    /// Linearisations.
    pub iterations: u32,
    /// The residual of first-order conditions, s/N.
    pub residual: f64,
    /// Morse index.
    pub index: usize,
    /// s
    pub h: f64,
}

impl Plan {
    /// The plan near hovering, of N · `finer` steps.
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn solve(problem: &Problem, finer: u64) -> Result<Self, Failure> {
        let steering = problem.steering(finer)?;
        let hover = Thrusts::repeat(problem.vehicle.hover());
        let mut stages = vec![steering.stage(&problem.start).with_input(hover); (problem.steps * finer) as usize];
        let optimum = steering.solve(&problem.start, Target::Place(problem.goal), &mut stages)?;
        let (end, gap, effort) = (*optimum.end(), optimum.gap(), optimum.price());
        let (iterations, residual, index) = (optimum.iterations(), optimum.residual(), optimum.negative());
        let h = optimum.step_size();
        Ok(Self { stages, end, gap, effort, iterations, residual, index, h })
    }

    /// All places, the end among them.
    pub fn places(&self) -> impl Iterator<Item = Place> + '_ {
        self.stages.iter().map(|stage| *stage.place()).chain([self.end])
    }

    /// The smallest and the largest thrust of a rotor, N.
    pub fn thrusts(&self) -> (f64, f64) {
        let fold =
            |(low, high): (f64, f64), stage: &Stage| (low.min(stage.input().min()), high.max(stage.input().max()));
        self.stages.iter().fold((f64::INFINITY, f64::NEG_INFINITY), fold)
    }

    /// For each step and rotor −1 or 1 where the lower or the upper bound holds back.
    pub fn held(&self) -> impl Iterator<Item = [i8; 4]> + '_ {
        self.stages.iter().map(|stage| {
            let active = stage.active();
            std::array::from_fn(|rotor| i8::from(active[2 * rotor + 1]) - i8::from(active[2 * rotor]))
        })
    }

    /// How many thrusts, one for each rotor and step, are at a bound.
    pub fn held_back(&self) -> usize {
        self.held().flatten().filter(|&side| side != 0).count()
    }

    /// The least multiplier of a bound.
    pub fn least_multiplier(&self) -> f64 {
        self.stages.iter().map(|stage| stage.multipliers().min()).fold(f64::INFINITY, f64::min)
    }

    /// By how much two costates move that no step changes, and the largest of both. The reason is that prices do not
    /// change where all places are shifted alike or turned about the vertical. They are R p of the position, and the
    /// third entry of R p of the attitude + x × that.
    pub fn symmetry(&self) -> ([f64; 2], [f64; 2]) {
        let seen = |stage: &Stage| {
            let (attitude, p) = (attitude(stage.place()), stage.costate());
            let linear = attitude * p.fixed_rows::<3>(3);
            let (turning, moving) = (attitude * p.fixed_rows::<3>(0), position(stage.place()).cross(&linear));
            (linear, turning.z + moving.z, turning.norm() + moving.norm())
        };
        let (mut moved, mut largest, mut first) = ([0.0_f64; 2], [0.0_f64; 2], None);
        for (linear, about, size) in self.stages.iter().map(seen) {
            let (linear_first, about_first) = *first.get_or_insert((linear, about));
            moved = [moved[0].max((linear - linear_first).norm()), moved[1].max((about - about_first).abs())];
            largest = [largest[0].max(linear.norm()), largest[1].max(size)];
        }
        (moved, largest)
    }
}
