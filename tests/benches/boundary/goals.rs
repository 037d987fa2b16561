//! Random goals: how many a unicycle reaches within its bounds from standing still, without a guess.

use clebsch::{Controlled, Error, Target};
use clebsch_tests::fixtures::unicycle::Unicycle;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Vector2};
use std::f64::consts::PI;

/// Goals all around, in one second and 50 steps, with this largest turning rate.
pub struct Line {
    pub top_turn: f64,
    pub goals: usize,
    pub solved: usize,
    /// Linearisations of those that were solved, in order.
    pub iterations: Vec<u32>,
    /// Those that ended otherwise than by the error that no way was found.
    pub otherwise: usize,
}

/// Turning to the goal, driving there and turning again is possible for all, as half a turn each takes less than a second.
pub fn lines(goals: usize) -> Vec<Line> {
    [7.0, 10.0, 20.0].into_iter().map(|top_turn| line(top_turn, goals)).collect()
}

fn line(top_turn: f64, goals: usize) -> Line {
    let system = Unicycle { turn_price: 1.0, top_turn, time_price: 0.0, miss_price: 0.0, goal: Vector2::zeros() };
    let control = system.control(0.02).expect("regular");
    let start = Matrix3::identity();
    let mut random = Random::new(704);
    let mut line = Line { top_turn, goals, solved: 0, iterations: Vec::new(), otherwise: 0 };
    for _ in 0..goals {
        let (sine, cosine) = random.between(-PI, PI).sin_cos();
        let (x, y) = (random.between(-1.5, 1.5), random.between(-1.5, 1.5));
        let goal = Matrix3::new(cosine, -sine, x, sine, cosine, y, 0.0, 0.0, 1.0);
        let mut plan = [control.stage(&start); 50];
        match control.solve(&start, Target::Place(goal), &mut plan) {
            Ok(found) if found.gap() < 1e-12 && found.is_minimum() => {
                line.solved += 1;
                line.iterations.push(found.iterations());
            }
            Err(Error::TargetMissed { .. } | Error::Infeasible { .. }) => {}
            _ => line.otherwise += 1,
        }
    }
    line.iterations.sort_unstable();
    line
}
