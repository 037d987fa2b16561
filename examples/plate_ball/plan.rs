//! Plans of the ball, solved.

use crate::attitude::rolled;
use crate::{Ball, Problem, steps};
use clebsch::{Controlled, Error, Optimum, Target};
use clebsch_examples::claims::largest;
use nalgebra::{Matrix3, Vector2, Vector3};

/// Relative change of a costate, to see how it grows.
const CHANGE: f64 = 1e-6;

/// Where the ball is, with its costates and its input.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// x, m.
    pub position: Vector2<f64>,
    /// R, from the ball to space.
    pub attitude: Matrix3<f64>,
    /// λ, m/s.
    pub costate: Vector2<f64>,
    /// m, in space, m²/s.
    pub momentum: Vector3<f64>,
    /// u, m/s.
    pub input: Vector2<f64>,
}

/// A plan of least price.
#[derive(Clone, Debug)]
pub struct Plan {
    /// h, s.
    pub h: f64,
    /// r, m.
    radius: f64,
    /// N steps, then the end with the input of the last step.
    pub path: Vec<Moment>,
    /// m²/s
    pub price: f64,
    /// The number of directions in which the price falls.
    pub index: usize,
    /// Linearisations.
    pub iterations: u32,
    /// The remaining way to the goal.
    pub gap: f64,
}

/// The exact properties of a plan, and how far it is off; all relative.
#[derive(Clone, Copy, Debug)]
pub struct Defects {
    /// Rolling without slipping or spinning, rad.
    pub slip: f64,
    /// λ
    pub costate: f64,
    /// Rᵀm
    pub momentum: f64,
    /// m₃ + x × λ
    pub elastica: f64,
}

impl Problem {
    /// The plan of N steps near the inputs `guess`(t/T), t in the middle of a step.
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn solve(&self, steps: u64, guess: impl Fn(f64) -> Vector2<f64>) -> Result<Plan, Error> {
        let control = Ball { radius: self.radius }.control(self.duration / steps as f64)?;
        let stage = |k: u64| control.stage(&self.start).with_input(guess((k as f64 + 0.5) / steps as f64));
        let mut plan: Vec<_> = (0..steps).map(stage).collect();
        let found = control.solve(&self.start, Target::Place(self.goal), &mut plan)?;
        Ok(Plan::of(&found, self.radius))
    }
}

impl Plan {
    fn of(optimum: &Optimum<'_, Ball, 5, 2, 0>, radius: f64) -> Self {
        let moment = |place: &(Vector2<f64>, Matrix3<f64>), costate: &nalgebra::SVector<f64, 5>, input| Moment {
            position: place.0,
            attitude: place.1,
            costate: -costate.fixed_rows::<2>(0),
            momentum: -costate.fixed_rows::<3>(2),
            input,
        };
        let stages = optimum.stages();
        let last = stages.last().map_or(Vector2::zeros(), |stage| *stage.input());
        let path = stages.iter().map(|stage| moment(stage.place(), stage.costate(), *stage.input()));
        Self {
            h: optimum.step_size(),
            radius,
            path: path.chain([moment(optimum.end(), optimum.final_costate(), last)]).collect(),
            price: optimum.price(),
            index: optimum.negative(),
            iterations: optimum.iterations(),
            gap: optimum.gap(),
        }
    }

    /// The number of steps.
    pub fn steps(&self) -> usize {
        self.path.len() - 1
    }

    /// The input at a part of the time.
    pub fn input(&self, part: f64) -> Vector2<f64> {
        self.path[((part * self.steps() as f64) as usize).min(self.steps() - 1)].input
    }

    /// The length of the path of the contact point, m.
    pub fn length(&self) -> f64 {
        self.path[..self.steps()].iter().map(|moment| moment.input.norm() * self.h).sum()
    }

    /// The exact properties.
    pub fn defects(&self) -> Defects {
        let first = self.path[0];
        let size = first.costate.norm() + first.momentum.norm() / self.radius;
        let in_ball = |moment: &Moment| moment.attitude.transpose() * moment.momentum / self.radius;
        let elastic = |moment: &Moment| (moment.momentum.z + moment.position.perp(&first.costate)) / self.radius;
        let slip = |pair: &[Moment]| {
            let turn = pair[1].attitude * pair[0].attitude.transpose();
            (turn - rolled(&(pair[1].position - pair[0].position), self.radius)).norm()
        };
        let moved = |defect: &dyn Fn(&Moment) -> f64| largest(self.path.iter().map(defect)) / size;
        Defects {
            slip: largest(self.path.windows(2).map(slip)),
            costate: moved(&|moment| (moment.costate - first.costate).norm()),
            momentum: moved(&|moment| (in_ball(moment) - in_ball(&first)).norm()),
            elastica: moved(&|moment| (elastic(moment) - elastic(&first)).abs()),
        }
    }

    /// How far the turning of u at each vertex is from the elastica's law h m₃/r², as a part of its largest turning.
    pub fn bending(&self) -> f64 {
        let law = |moment: &Moment| -moment.momentum.z / (self.radius * self.radius);
        let off = |pair: &[Moment]| {
            let (before, after) = (pair[0].input, pair[1].input);
            (before.perp(&after).atan2(before.dot(&after)) / self.h - law(&pair[1])).abs()
        };
        let steps = &self.path[..self.steps()];
        largest(steps.windows(2).map(off)) / largest(steps.iter().map(|moment| law(moment).abs()))
    }

    /// How far the plan is from shooting with its costates at the start, as in [`apart`]. The second number is the
    /// growth of a relative change of these.
    pub fn off_shooting(&self) -> Option<(f64, f64)> {
        let first = self.path[0];
        let shoot = |start: &Moment| steps::shoot(start, self.radius, self.h, self.steps());
        let path = shoot(&first)?;
        let size = CHANGE * (first.costate.norm() + first.momentum.norm() / self.radius);
        let mut growth = 1.0_f64;
        for direction in 0..3 {
            let mut changed = first;
            changed.momentum[direction] += size * self.radius;
            growth = growth.max(apart(&path, &shoot(&changed)?, self.radius) / CHANGE);
        }
        Some((apart(&path, &self.path, self.radius), growth))
    }
}

/// The largest distance of two paths: in radii, rad and relative.
fn apart(a: &[Moment], b: &[Moment], radius: f64) -> f64 {
    let speed = largest(a.iter().map(|moment| moment.input.norm())).max(f64::MIN_POSITIVE);
    let distance = |(a, b): (&Moment, &Moment)| {
        let (way, turn) = (a.position - b.position, a.attitude - b.attitude);
        [way.norm() / radius, turn.norm(), (a.input - b.input).norm() / speed]
    };
    largest(a.iter().zip(b).flat_map(distance))
}
