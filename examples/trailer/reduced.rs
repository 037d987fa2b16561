//! The motion by two equations for the speed v and the turning rate ω of the tractor. They have no constraint and no multiplier.
//!
//! Tractor and trailer have s₀ = (ω, v) and s₁ = J s₀. The hitch is a behind the wheels of the tractor, and b ahead of those of the trailer.
//! The angle δ leads from the trailer to the tractor. The velocity of the hitch gives J:
//! ```text
//! ω₁ = (v sin δ − a ω cos δ)/b,    v₁ = v cos δ + a ω sin δ
//! ```
//! A body with its centre of mass c ahead of its wheels is a sleigh.
//! Its torque and its force along the wheels are D s′ + g(s):
//! ```text
//! (I + m c²) ω′ + m c v ω,    m v′ − m c ω²
//! ```
//! The trailer pushes the tractor by Jᵀ. So (D₀ + Jᵀ D₁ J) s₀′ = u − g₀ − Jᵀ (D₁ J′ s₀ + g₁).

use super::declaration::{Place, TractorTrailer};
use super::plan::{Plan, Problem};
use super::rig::{heading, position, velocity};
use clebsch_examples::claims::largest;
use clebsch_examples::reference::{Solution, solve};
use nalgebra::{Matrix2, SVector, Vector2};

/// The fastest rate of the motion, 1/s: that of the trailer on its drawbar, with room.
const RATE: f64 = 5.0;

/// Position x, y of the tractor, headings of tractor and trailer, ω and v.
pub type Reduced = SVector<f64, 6>;

/// The motion by the inputs of a plan at its times, and the error of integration from above.
pub fn driven(problem: &Problem, plan: &Plan) -> (Vec<Reduced>, f64) {
    let mut path = vec![of(&problem.rig, &problem.start)];
    let mut error = 0.0;
    for input in plan.inputs() {
        let last = path[path.len() - 1];
        let Solution { end, error: made } = solve(|y| rate(&problem.rig, y, input), last, problem.h, RATE);
        path.push(end);
        error += made;
    }
    (path, error)
}

/// The largest distance of two motions, in m, rad, m/s and rad/s.
pub fn off(rig: &TractorTrailer, path: &[Reduced], places: &[Place]) -> f64 {
    let distance = |(exact, place): (&Reduced, &Place)| {
        let difference = exact - of(rig, place);
        // headings are the same after full turns
        largest(difference.iter().enumerate().map(|(i, d)| if i == 2 || i == 3 { d.sin().abs() } else { d.abs() }))
    };
    largest(path.iter().zip(places).map(distance))
}

fn of(rig: &TractorTrailer, place: &Place) -> Reduced {
    let [tractor, trailer] = &place.0;
    let (at, velocity) = (position(tractor), velocity(rig, place, 0));
    Reduced::from([at.x, at.y, heading(tractor), heading(trailer), velocity.x, velocity.y])
}

fn rate(rig: &TractorTrailer, y: &Reduced, input: &Vector2<f64>) -> Reduced {
    let (s, fold) = (Vector2::new(y[4], y[5]), y[2] - y[3]);
    let (sin, cos) = fold.sin_cos();
    let (a, b) = (-rig.hitch[0].x, rig.hitch[1].x);
    let j = Matrix2::new(-a * cos / b, sin / b, a * sin, cos);
    let trailer = j * s;
    let j_rate = Matrix2::new(a * sin / b, cos / b, a * cos, -sin) * (s.x - trailer.x);
    let [d, d_trailer] = [0, 1].map(|i| {
        let about_wheels = rig.inertia[i] + rig.mass[i] * rig.offset[i] * rig.offset[i];
        Matrix2::from_diagonal(&Vector2::new(about_wheels, rig.mass[i]))
    });
    let g = |i: usize, s: &Vector2<f64>| rig.mass[i] * rig.offset[i] * Vector2::new(s.y * s.x, -s.x * s.x);
    let pushed = Vector2::new(input.y, input.x) - g(0, &s);
    let pulled = j.transpose() * (d_trailer * j_rate * s + g(1, &trailer));
    // D₀ is positive, so the sum has an inverse
    let change = (d + j.transpose() * d_trailer * j).try_inverse().unwrap_or_default() * (pushed - pulled);
    let (sin, cos) = y[2].sin_cos();
    Reduced::from([s.y * cos, s.y * sin, s.x, trailer.x, change.x, change.y])
}
