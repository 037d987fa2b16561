//! The claims about the sensitivities: they are differences, and they know the direction that no data can tell.

use crate::Spacecraft;
use crate::estimator::{Estimator, Predicted};
use crate::measurement::{Measurements, Schedule};
use crate::unknowns::{OF_INERTIA, Unknowns};
use clebsch::{Differentiated, Error};
use clebsch_examples::claims::Claims;
use clebsch_examples::table::Table;
use std::hint::black_box;
use std::time::Instant;

/// By how much a difference moves the attitudes, radians.
const SHIFT: f64 = 2e-3;
/// The largest change of an unknown in a difference.
const LARGEST_STEP: f64 = 1e-4;
/// Steps that are timed.
const TIMED: u64 = 20_000;

/// Claims the columns of the inertia, and that its scale is in none of them; both at the true values.
pub fn claim<M: Differentiated<Spacecraft, 3>>(
    estimator: &Estimator<M>,
    measurements: &Measurements,
    schedule: &Schedule,
    truth: &Unknowns,
    claims: &mut Claims,
) -> Option<()> {
    let predicted = estimator.predict(truth, schedule)?;
    let jacobian = estimator.jacobian(&measurements.measured, &predicted);
    let mut worst = 0.0_f64;
    for column in 0..OF_INERTIA {
        let exact: Vec<f64> =
            jacobian.iter().flat_map(|block| block.column(column).iter().copied().collect::<Vec<_>>()).collect();
        let largest = exact.iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
        let step = (SHIFT / (estimator.sigma * largest)).min(LARGEST_STEP);
        let slopes = differences(estimator, measurements, schedule, truth, column, step)?;
        let defect = exact.iter().zip(&slopes).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        worst = worst.max(defect / largest);
    }
    let reason = "columns of the inertia, relative to their largest entry; five-point differences of whole runs";
    claims.at_most("the Jacobian is that of differences", worst, 1e-6, reason);
    claim_scale(&predicted, schedule, claims);
    Some(())
}

/// (f(x − 2s) − 8f(x − s) + 8f(x + s) − f(x + 2s))/12s, for s along one unknown.
fn differences<M: Differentiated<Spacecraft, 3>>(
    estimator: &Estimator<M>,
    measurements: &Measurements,
    schedule: &Schedule,
    x: &Unknowns,
    column: usize,
    step: f64,
) -> Option<Vec<f64>> {
    let mut slopes = vec![0.0; 3 * schedule.count];
    for (place, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
        let attitudes = estimator.attitudes(&(x + Unknowns::ith(column, place * step)), schedule)?;
        let residuals = estimator.residuals(&measurements.measured, &attitudes);
        slopes.iter_mut().zip(residuals).for_each(|(slope, residual)| *slope += weight * residual / (12.0 * step));
    }
    Some(slopes)
}

/// (J, π) ↦ (1 + s)(J, π) moves nothing: the momentum cancels the effect of the inertia on the attitudes.
fn claim_scale(predicted: &Predicted, schedule: &Schedule, claims: &mut Claims) {
    let scaling = &predicted.scaling;
    let moved = scaling.iter().map(|scaling| scaling.moved.norm()).fold(0.0, f64::max);
    let parts = scaling.iter().map(|scaling| scaling.parts).fold(0.0, f64::max);
    claims.round_off("the scale of the inertia moves no attitude", moved, schedule.steps(), parts);
}

/// Nanoseconds of a step, alone and with its derivatives.
///
/// # Errors
/// The errors of a step.
pub fn cost<M: Differentiated<Spacecraft, 3>>(
    estimator: &Estimator<M>,
    truth: &Unknowns,
    step_size: f64,
) -> Result<Table<3>, Error> {
    let (stepper, start) = estimator.start(truth, step_size)?;
    let mut table = Table::new(["a step", "ns", "of a plain one"]);
    let mut plain = f64::NAN;
    let mut row = |name: &str, time: f64| {
        plain = if plain.is_nan() { time } else { plain };
        table.row([name.to_owned(), format!("{time:.0}"), format!("{:.2}", time / plain)]);
    };
    row("plain", nanoseconds(start, |state| stepper.step(state))?);
    row("with its tangent map", nanoseconds(start, |state| Ok(black_box(stepper.step_tangent(state)?).0))?);
    row(
        "with its sensitivity to 9 quantities too",
        nanoseconds(start, |state| Ok(black_box(stepper.step_sensitivity(state)?).0))?,
    );
    Ok(table)
}

/// The least of three runs, per step.
fn nanoseconds<T: Copy>(start: T, step: impl Fn(&T) -> Result<T, Error>) -> Result<f64, Error> {
    let mut least = f64::INFINITY;
    for _ in 0..3 {
        let (mut state, began) = (start, Instant::now());
        for _ in 0..TIMED {
            state = step(&state)?;
        }
        black_box(state);
        least = least.min(began.elapsed().as_nanos() as f64 / TIMED as f64);
    }
    Ok(least)
}
