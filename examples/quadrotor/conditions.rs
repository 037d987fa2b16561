//! First-order conditions of the plan by differences of complete flights: no derivative of the macro, no costate.
//!
//! The slope g of the effort is taken along thrusts that no bound limits. A plan is critical where g is a combination
//! −Aᵀλ of the slopes A of the end. At a bound g + Aᵀλ is against leaving it, and its size is the multiplier of the
//! bound.

use super::declaration::{Place, Steering};
use super::place::{attitude, position, turned};
use super::plan::Plan;
use super::problem::Problem;
use clebsch_examples::scene::Failure;
use nalgebra::{SMatrix, SVector};

/// Differences of thrusts, in units of the thrust at hover.
const DIFFERENCE: f64 = 1e-4;

/// The results.
#[derive(Clone, Copy, Debug)]
pub struct Conditions {
    /// The largest entry of g + Aᵀλ where no bound is active, in units of the largest of g.
    pub residual: f64,
    /// The largest difference of a multiplier from the plan's, in units of the largest.
    pub multipliers: f64,
    /// The largest of all, against a negative one.
    pub negative: f64,
}

impl Conditions {
    /// Flies the plan with each thrust varied.
    ///
    /// # Errors
    /// Those of a step.
    pub fn new(problem: &Problem, plan: &Plan) -> Result<Self, Failure> {
        let (steering, hover) = (problem.steering(1)?, problem.vehicle.hover());
        let mut slopes: Vec<[SVector<f64, 12>; 4]> = Vec::with_capacity(plan.stages.len());
        for from in 0..plan.stages.len() {
            let mut columns = [SVector::zeros(); 4];
            for (rotor, column) in columns.iter_mut().enumerate() {
                let ends = [1.0, -1.0].map(|side| end(&steering, plan, from, rotor, side * DIFFERENCE * hover));
                let [ahead, behind] = ends;
                *column = (off(plan, &ahead?) - off(plan, &behind?)) / (2.0 * DIFFERENCE * hover);
            }
            slopes.push(columns);
        }
        let gradient =
            |step: usize, rotor: usize| plan.h * (plan.stages[step].input()[rotor] - hover) / (hover * hover);
        let held: Vec<[i8; 4]> = plan.held().collect();
        let all = || (0..held.len()).flat_map(|step| (0..4).map(move |rotor| (step, rotor)));
        let scale = all().fold(SVector::<f64, 12>::zeros(), |max, (k, i)| max.sup(&slopes[k][i].abs()));
        let (mut normal, mut side) = (SMatrix::<f64, 12, 12>::zeros(), SVector::<f64, 12>::zeros());
        for (step, rotor) in all().filter(|&(step, rotor)| held[step][rotor] == 0) {
            let slope = slopes[step][rotor].component_div(&scale);
            normal += slope * slope.transpose();
            side -= slope * gradient(step, rotor);
        }
        let lambda = normal.lu().solve(&side).unwrap_or_else(|| SVector::repeat(f64::NAN));
        let left =
            |step: usize, rotor: usize| gradient(step, rotor) + slopes[step][rotor].component_div(&scale).dot(&lambda);
        let largest = all().map(|(step, rotor)| gradient(step, rotor).abs()).fold(0.0, f64::max);
        let (mut found, mut most) = (Self { residual: 0.0, multipliers: 0.0, negative: 0.0 }, 0.0_f64);
        for (step, rotor) in all() {
            let (left, side) = (left(step, rotor), held[step][rotor]);
            if side == 0 {
                found.residual = found.residual.max(left.abs() / largest);
                continue;
            }
            let multiplier = -left * f64::from(side);
            let planned = plan.stages[step].multipliers()[2 * rotor + usize::from(side > 0)];
            found.multipliers = found.multipliers.max((multiplier - planned).abs());
            found.negative = found.negative.max(-multiplier);
            most = most.max(multiplier);
        }
        if most > 0.0 {
            found.multipliers /= most;
            found.negative /= most;
        }
        Ok(found)
    }
}

/// Where the plan ends with one thrust of one step changed.
fn end(steering: &Steering, plan: &Plan, from: usize, rotor: usize, by: f64) -> Result<Place, Failure> {
    let mut place = *plan.stages[from].place();
    for (step, stage) in (0..).zip(&plan.stages).skip(from) {
        let mut thrusts = *stage.input();
        thrusts[rotor] += if step == from { by } else { 0.0 };
        place = steering.follow(&place, &thrusts).map_err(|error| Failure::Step { step: step as u64 + 1, error })?;
    }
    Ok(place)
}

/// The difference of an end from that of the plan.
fn off(plan: &Plan, end: &Place) -> SVector<f64, 12> {
    let (turned, moved) = (turned(&attitude(&plan.end), &attitude(end)), position(end) - position(&plan.end));
    let mut off = SVector::<f64, 12>::zeros();
    off.fixed_rows_mut::<3>(0).copy_from(&turned);
    off.fixed_rows_mut::<3>(3).copy_from(&moved);
    off.fixed_rows_mut::<6>(6).copy_from(&(end.1 - plan.end.1));
    off
}
