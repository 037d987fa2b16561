//! The equations of first order of the steps, derived by hand: shooting with them is compared with the solution.
//!
//! Within a step of constant inputs the costate obeys the continuous equations, which it solves in closed form. The
//! price does not change to first order if the inputs are the means of λ_θ/a² and λ_x over the step. An input beyond
//! its bound is at the bound.

use crate::geodesic::Moment;
use crate::place::{self, at};
use crate::plan::Plan;
use clebsch_examples::claims::largest;
use nalgebra::{Matrix3, Vector2, Vector3};

/// Sweeps for the inputs of a step; each divides the error by some 1/h.
const SWEEPS: usize = 200;
/// Relative change of a costate, to see how it grows.
const CHANGE: f64 = 1e-6;
/// Rates below this, rad/s and m/s, are rest.
const REST: f64 = 1e-9;

/// A unicycle with steps of h.
#[derive(Clone, Copy, Debug)]
pub struct Steps {
    /// h, s.
    pub h: f64,
    /// a², m².
    pub turn_price: f64,
    /// (ω, v) at least.
    pub least: Vector2<f64>,
    /// (ω, v) at most.
    pub most: Vector2<f64>,
}

impl Steps {
    /// With any inputs.
    pub fn without_bounds(h: f64, turn_price: f64) -> Self {
        Self { h, turn_price, least: Vector2::repeat(f64::NEG_INFINITY), most: Vector2::repeat(f64::INFINITY) }
    }

    /// How far a plan is from shooting with its costate at the start, as in [`apart`]. The second number is the growth
    /// of a relative change of that costate.
    pub fn off(&self, plan: &Plan) -> Option<(f64, f64)> {
        let Moment { place, costate, .. } = plan.path[0];
        let path = self.shoot(&place, &costate, plan.steps())?;
        let mut growth = 1.0_f64;
        for direction in 0..3 {
            let mut changed = costate;
            changed[direction] += CHANGE * costate.norm();
            growth = growth.max(apart(&path, &self.shoot(&place, &changed, plan.steps())?) / CHANGE);
        }
        Some((apart(&path, &plan.path), growth))
    }

    /// The places, costates and inputs of N steps from `start`; the last has the inputs of the last step.
    ///
    /// `None` where the sweeps do not end: too long a step.
    pub fn shoot(&self, start: &Matrix3<f64>, costate: &Vector3<f64>, steps: usize) -> Option<Vec<Moment>> {
        let mut moment = Moment { place: *start, costate: *costate, input: self.wanted(costate, &Vector2::zeros()) };
        let mut path = Vec::with_capacity(steps + 1);
        for _ in 0..steps {
            moment.input = self.input(&moment.costate, &moment.input)?;
            path.push(moment);
            moment = self.follow(&moment);
        }
        path.push(moment);
        Some(path)
    }

    /// The inputs that are the means of their own results.
    fn input(&self, costate: &Vector3<f64>, guess: &Vector2<f64>) -> Option<Vector2<f64>> {
        let (mut input, mut last) = (*guess, f64::INFINITY);
        for _ in 0..SWEEPS {
            let next = self.wanted(costate, &input);
            let change = (next - input).amax();
            input = next;
            if change <= 4.0 * f64::EPSILON * input.amax() || change >= last && change < 1e-13 * input.amax() {
                return Some(input);
            }
            last = change;
        }
        None
    }

    /// The means of λ_θ/a² and λ_x over a step with this input, or the bounds.
    fn wanted(&self, costate: &Vector3<f64>, input: &Vector2<f64>) -> Vector2<f64> {
        let (angle, way) = (input.x * self.h, input.y * self.h);
        let Arc { sine, versine, rest } = Arc::of(angle);
        let ahead = costate.y * sine + costate.z * angle * versine;
        let turn = costate.x - way * (costate.z * versine - costate.y * angle * rest);
        let wanted = Vector2::new(turn / self.turn_price, ahead);
        wanted.sup(&self.least).inf(&self.most)
    }

    /// Turned by ωh about where the wheels' axes meet; the costate with it.
    fn follow(&self, moment: &Moment) -> Moment {
        let (angle, way) = (moment.input.x * self.h, moment.input.y * self.h);
        let Arc { sine, versine, .. } = Arc::of(angle);
        let motion = at(way * sine, way * angle * versine, angle);
        let (sin, cos) = angle.sin_cos();
        let [turn, ahead, left] = moment.costate.into();
        let costate = Vector3::new(
            turn - way * (left * sine - ahead * angle * versine),
            ahead * cos + left * sin,
            left * cos - ahead * sin,
        );
        Moment { place: moment.place * motion, costate, input: moment.input }
    }
}

/// The largest distance of two paths: places in rad and m, inputs relative to the largest.
fn apart(a: &[Moment], b: &[Moment]) -> f64 {
    let fastest = largest(a.iter().map(|moment| moment.input.norm())).max(REST);
    let distance =
        |(a, b): (&Moment, &Moment)| [place::apart(&a.place, &b.place).norm(), (a.input - b.input).norm() / fastest];
    largest(a.iter().zip(b).flat_map(distance))
}

/// sin α/α, (1 − cos α)/α² and (α − sin α)/α³.
#[derive(Clone, Copy, Debug)]
struct Arc {
    sine: f64,
    versine: f64,
    rest: f64,
}

impl Arc {
    fn of(angle: f64) -> Self {
        let half = if angle == 0.0 { 1.0 } else { (angle / 2.0).sin() / (angle / 2.0) };
        if angle.abs() > 0.5 {
            let sine = angle.sin() / angle;
            return Self { sine, versine: half * half / 2.0, rest: (1.0 - sine) / (angle * angle) };
        }
        let term = |sum: f64, n: i32| 1.0 - angle * angle / f64::from((2 * n + 2) * (2 * n + 3)) * sum;
        let rest = (1..=8).rev().fold(1.0, term) / 6.0;
        Self { sine: 1.0 - rest * angle * angle, versine: half * half / 2.0, rest }
    }
}
