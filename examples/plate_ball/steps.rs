//! The equations of first order of the steps, derived by hand: shooting with them is compared with the solution.
//!
//! In a step of constant input the ball rolls straight, and the costate m turns with it. The price does not change to
//! first order if u = λ + (m̄₂, −m̄₁)/r, with the mean m̄ of m over the step.

use crate::attitude::rolled;
use crate::plan::Moment;
use nalgebra::{Vector2, Vector3};

/// Sweeps for the input of a step; each divides the error by some 1/h.
const SWEEPS: usize = 200;

/// The places, costates and inputs of N steps; `None` where the sweeps do not end: too long a step.
pub fn shoot(start: &Moment, radius: f64, h: f64, steps: usize) -> Option<Vec<Moment>> {
    let mut moment = *start;
    let mut path = Vec::with_capacity(steps + 1);
    for _ in 0..steps {
        moment.input = solve(&moment, radius, h)?;
        path.push(moment);
        let way = moment.input * h;
        let turn = rolled(&way, radius);
        moment = Moment {
            position: moment.position + way,
            attitude: turn * moment.attitude,
            momentum: turn * moment.momentum,
            ..moment
        };
    }
    path.push(moment);
    Some(path)
}

fn solve(moment: &Moment, radius: f64, h: f64) -> Option<Vector2<f64>> {
    let (mut input, mut last) = (moment.input, f64::INFINITY);
    for _ in 0..SWEEPS {
        let mean = mean(&moment.momentum, &(input * h / radius));
        let next = moment.costate + Vector2::new(mean.y, -mean.x) / radius;
        let change = (next - input).amax();
        input = next;
        if change <= 4.0 * f64::EPSILON * input.amax() || change >= last && change < 1e-13 * input.amax() {
            return Some(input);
        }
        last = change;
    }
    None
}

/// The mean of a vector while the ball rolls a way, in radii.
fn mean(momentum: &Vector3<f64>, way: &Vector2<f64>) -> Vector3<f64> {
    let angle = way.norm();
    if angle == 0.0 {
        return *momentum;
    }
    let axis = Vector3::new(-way.y, way.x, 0.0) / angle;
    let along = axis * axis.dot(momentum);
    let half = (angle / 2.0).sin();
    along + (momentum - along) * (angle.sin() / angle) + axis.cross(momentum) * (2.0 * half * half / angle)
}
