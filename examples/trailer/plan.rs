//! Plans of least effort, and how well they obey hitch and wheels.

use super::declaration::{Place, Stage, Steering, TractorTrailer};
use super::rig::{fold, hitch_error, position, rotation, turn, velocity};
use clebsch::{Clebsch, Controlled, Error, Target};
use clebsch_examples::claims::largest;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector2};
use std::f64::consts::PI;

/// The task.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The rig.
    pub rig: TractorTrailer,
    /// Where it stands.
    pub start: Place,
    /// Where it is to stand.
    pub goal: Place,
    /// h, s.
    pub h: f64,
    /// The number of steps.
    pub steps: u64,
}

/// A thrust to begin with, a cosine, without torque.
#[derive(Clone, Copy, Debug)]
pub struct Guess {
    /// Where the rig drives.
    pub name: &'static str,
    /// The amplitude as a part of the largest thrust.
    part: f64,
    /// Half periods in the time of the plan: one drives one way, two drive there and back.
    halves: f64,
}

/// No inputs.
pub const NONE: Guess = Guess { name: "none", part: 0.0, halves: 1.0 };

/// The guesses.
pub const GUESSES: [Guess; 5] = [
    Guess { name: "ahead, then back", part: 0.25, halves: 2.0 },
    Guess { name: "back, then ahead", part: -0.25, halves: 2.0 },
    Guess { name: "ahead", part: 0.25, halves: 1.0 },
    Guess { name: "back", part: -0.25, halves: 1.0 },
    NONE,
];

/// A plan of least effort.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Where the search began.
    pub guess: Guess,
    /// h, s.
    pub h: f64,
    /// Its steps.
    pub stages: Vec<Stage>,
    /// Where it ends.
    pub end: Place,
    /// The distance to the goal, of all entries.
    pub gap: f64,
    /// ½ ∫ (f² + (τ/a)²) dt of the thrust f and the torque τ, N² s.
    pub price: f64,
    /// Linearisations.
    pub iterations: u32,
    /// Whether no small change of the inputs lowers the price.
    pub is_minimum: bool,
}

impl Problem {
    /// The plan from a guess.
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn solve(&self, guess: Guess) -> Result<Plan, Error> {
        let phase = |step: u64| PI * guess.halves * (step as f64 + 0.5) / self.steps as f64;
        let thrust = |step| guess.part * self.rig.top_thrust * phase(step).cos();
        let control: Steering = self.rig.clone().control(self.h)?;
        let stage = |step| control.stage(&self.start).with_input(Vector2::new(thrust(step), 0.0));
        let mut stages: Vec<_> = (0..self.steps).map(stage).collect();
        let found = control.solve(&self.start, Target::Place(self.goal), &mut stages)?;
        let (end, gap, price) = (*found.end(), found.gap(), found.price());
        let (iterations, is_minimum) = (found.iterations(), found.is_minimum());
        Ok(Plan { guess, h: self.h, stages, end, gap, price, iterations, is_minimum })
    }

    /// The same in steps that are `part` times shorter.
    pub fn finer(&self, part: u64) -> Self {
        Self { h: self.h / part as f64, steps: self.steps * part, ..self.clone() }
    }

    /// The end of the motion from the goal by the inputs of a plan in reverse order.
    /// The rig drives ahead where it drove back.
    ///
    /// # Errors
    /// Those of a step.
    pub fn driven_back(&self, plan: &Plan) -> Result<Place, Failure> {
        let stepper = self.rig.stepper(self.h)?;
        let mut state = stepper.state(self.goal.0, self.goal.1)?;
        for (step, stage) in (1..).zip(plan.stages.iter().rev()) {
            let next = stepper.step_with(&state, stage.input());
            state = next.map_err(|error| Failure::Step { step, error })?;
        }
        Ok((*state.configuration(), state.momentum()))
    }

    /// The places of the motion that the stepper makes of the inputs of a plan, with `part` steps for each of the plan.
    ///
    /// # Errors
    /// Those of a step.
    pub fn driven(&self, plan: &Plan, part: u64) -> Result<Vec<Place>, Failure> {
        let stepper = self.rig.stepper(self.h / part as f64)?;
        let mut state = stepper.state(self.start.0, self.start.1)?;
        let mut places = vec![self.start];
        for (step, stage) in (1..).zip(&plan.stages) {
            for _ in 0..part {
                let next = stepper.step_with(&state, stage.input());
                state = next.map_err(|error| Failure::Step { step, error })?;
            }
            places.push((*state.configuration(), state.momentum()));
        }
        Ok(places)
    }
}

impl Plan {
    /// Places of all steps, and the end.
    pub fn places(&self) -> impl Iterator<Item = &Place> {
        self.stages.iter().map(Stage::place).chain([&self.end])
    }

    /// The inputs of all steps.
    pub fn inputs(&self) -> impl Iterator<Item = &Vector2<f64>> {
        self.stages.iter().map(Stage::input)
    }

    /// The largest distance of both points of the hitch, m.
    pub fn hitch_error(&self, rig: &TractorTrailer) -> f64 {
        largest(self.places().map(|(poses, _)| hitch_error(rig, poses)))
    }

    /// The largest speed across the wheels of both bodies, m/s.
    pub fn slip(&self, rig: &TractorTrailer) -> f64 {
        largest(self.places().flat_map(|place| [0, 1].map(|body| velocity(rig, place, body).z.abs())))
    }

    /// How far a step of either body is from an arc along its wheels, m. The chord of such an arc halves its turn.
    pub fn bend(&self) -> f64 {
        let steps = self.places().zip(self.places().skip(1));
        largest(steps.flat_map(|((from, _), (to, _))| [0, 1].map(|body| off_arc(&from[body], &to[body]))))
    }

    /// The largest angle between both bodies, rad.
    pub fn fold(&self) -> f64 {
        largest(self.places().map(|(poses, _)| fold(poses).abs()))
    }

    /// The largest thrust, N, and torque, N m.
    pub fn most(&self) -> Vector2<f64> {
        let part = |i: usize| largest(self.inputs().map(|input| input[i].abs()));
        Vector2::new(part(0), part(1))
    }

    /// The length of the way of the tractor, m.
    pub fn way(&self, rig: &TractorTrailer) -> f64 {
        self.stages.iter().map(|stage| velocity(rig, stage.place(), 0).y.abs() * self.h).sum()
    }

    /// How often the tractor changes between driving ahead and back.
    pub fn cusps(&self, rig: &TractorTrailer) -> usize {
        let ahead: Vec<_> = self.stages.iter().skip(1).map(|stage| velocity(rig, stage.place(), 0).y > 0.0).collect();
        ahead.windows(2).filter(|pair| pair[0] != pair[1]).count()
    }
}

fn off_arc(from: &Matrix3<f64>, to: &Matrix3<f64>) -> f64 {
    let way = rotation(from).transpose() * (position(to) - position(from));
    let half = turn(from, to) / 2.0;
    (way.y * half.cos() - way.x * half.sin()).abs()
}

/// The distance of two places, of headings, rad, positions, m, and velocities, rad/s and m/s.
pub fn apart(rig: &TractorTrailer, a: &Place, b: &Place) -> f64 {
    let body = |i: usize| {
        let way = (position(&a.0[i]) - position(&b.0[i])).norm();
        largest([turn(&a.0[i], &b.0[i]).abs(), way, (velocity(rig, a, i) - velocity(rig, b, i)).norm()])
    };
    largest([body(0), body(1)])
}
