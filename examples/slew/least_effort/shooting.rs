//! The costates at the start whose extremal ends at the target at rest, by Newton's method.

use super::pontryagin::{Motion, Pontryagin};
use crate::attitude::turn;
use nalgebra::{Matrix3, Matrix6, Vector6};

/// Newton corrections at most.
const CORRECTIONS: usize = 40;
/// Differences of costates, relative: the square of it and rounding over it are what derivatives are wrong by.
const DIFFERENCE: f64 = 1e-5;

/// An extremal that ends at the target.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// (p, ν) at the start.
    pub costates: Vector6<f64>,
    /// How far places on the way may be off, as numbers in units of [`Pontryagin`].
    pub error: f64,
    /// Where it ends.
    pub end: Motion,
}

impl Shot {
    /// The extremal near these costates; `None` where corrections do not end.
    pub fn aim(problem: &Pontryagin, to: &Matrix3<f64>, guess: &Vector6<f64>) -> Option<Self> {
        let mut costates = *guess;
        let mut last = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            let end = problem.after(&problem.start(&costates), 1.0);
            let jacobian = jacobian(problem, to, &costates);
            let correction = jacobian.lu().solve(&missed(&end, to))?;
            let size = correction.norm() / costates.norm();
            if size >= last && last < 1e-9 {
                let error = end.error + jacobian.norm() * last * costates.norm();
                return Some(Self { costates, error, end });
            }
            last = size;
            costates -= correction * (0.3 / size).min(1.0);
        }
        None
    }

    /// The extremal at so many equal parts of the time, the start and the end among them.
    pub fn path(&self, problem: &Pontryagin, parts: u64) -> Vec<Motion> {
        let start = problem.start(&self.costates);
        let later = |motion: &Motion| Some(problem.after(motion, 1.0 / parts as f64));
        std::iter::successors(Some(start), later).take(parts as usize + 1).collect()
    }
}

/// What separates an end from the target.
fn missed(end: &Motion, to: &Matrix3<f64>) -> Vector6<f64> {
    let (angle, momentum) = (turn(to, &end.attitude()), end.momentum());
    Vector6::new(angle.x, angle.y, angle.z, momentum.x, momentum.y, momentum.z)
}

/// The derivative of [`missed`] by the costates, by central differences.
fn jacobian(problem: &Pontryagin, to: &Matrix3<f64>, costates: &Vector6<f64>) -> Matrix6<f64> {
    let difference = DIFFERENCE * costates.norm();
    let at = |axis: usize, by: f64| {
        let moved = costates + Vector6::ith(axis, by);
        missed(&problem.after(&problem.start(&moved), 1.0), to)
    };
    let column = |axis: usize| (at(axis, difference) - at(axis, -difference)) / (2.0 * difference);
    Matrix6::from_columns(&[column(0), column(1), column(2), column(3), column(4), column(5)])
}
