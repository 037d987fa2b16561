//! The fit: Levenberg's and Marquardt's method on arcs that grow.

use crate::Spacecraft;
use crate::estimator::{Estimator, PRIOR};
use crate::measurement::Schedule;
use crate::unknowns::{COUNT, OF_INERTIA, Unknowns};
use clebsch::Differentiated;
use clebsch_examples::table::Table;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::Matrix3;
use optimiser_nalgebra::storage::Owned;
use optimiser_nalgebra::{Dyn, OMatrix, OVector};
use std::cell::Cell;
use std::f64::consts::PI;

/// Measurements of the first arc.
const FIRST_ARC: usize = 8;
/// Relative reduction of χ², and change of the unknowns, at which an arc is done: far below the uncertainty by noise.
const TOLERANCE: f64 = 1e-10;

/// Where the fit ended.
pub struct Fit {
    /// Of the last arc.
    pub unknowns: Unknowns,
    /// Σr² of the last arc.
    pub chi_square: f64,
    /// Whether the last arc converged.
    pub has_converged: bool,
    /// Linearisations of all arcs.
    pub linearisations: u32,
    /// A line for each arc.
    pub table: Table<5>,
}

/// Fits the first measurements, then twice as many from there, and so on.
///
/// A wrong inertia turns the predicted body away from the measured one as time goes by, and residuals know angles only
/// up to full turns. So the length of an arc is limited by the quality of the estimate. Each arc makes it better for
/// the next.
pub fn fit<M: Differentiated<Spacecraft, 3>>(
    estimator: &Estimator<M>,
    measured: &[Matrix3<f64>],
    schedule: &Schedule,
    start: Unknowns,
) -> Fit {
    let table = Table::new(["arc / s", "attitudes", "linearisations", "evaluations", "χ² / degree of freedom"]);
    let mut fit = Fit { unknowns: start, chi_square: f64::NAN, has_converged: false, linearisations: 0, table };
    let mut count = FIRST_ARC;
    loop {
        let arc = schedule.first(count);
        let problem = Arc {
            estimator,
            measured: &measured[..arc.count],
            schedule: arc,
            x: fit.unknowns,
            linearisations: Cell::new(0),
        };
        let method = LevenbergMarquardt::new().with_ftol(TOLERANCE).with_xtol(TOLERANCE).with_gtol(0.0);
        let (problem, report) = method.minimize(problem);
        let linearisations = problem.linearisations.get();
        fit.unknowns = problem.x;
        fit.chi_square =
            2.0 * report.objective_function - estimator.departure(&fit.unknowns).iter().map(|r| r * r).sum::<f64>();
        // a fit that cannot be improved by more than rounding has converged too
        fit.has_converged = report.termination.was_successful()
            || matches!(report.termination, TerminationReason::NoImprovementPossible(_));
        fit.linearisations += linearisations;
        fit.table.row([
            format!("{:.1}", (arc.count - 1) as f64 * arc.interval()),
            arc.count.to_string(),
            linearisations.to_string(),
            report.number_of_evaluations.to_string(),
            format!("{:.4}", fit.chi_square / (3 * arc.count - COUNT) as f64),
        ]);
        if arc.count == schedule.count {
            return fit;
        }
        count *= 2;
    }
}

/// The least squares of one arc, as the optimiser asks for them.
struct Arc<'a, M> {
    estimator: &'a Estimator<M>,
    measured: &'a [Matrix3<f64>],
    schedule: Schedule,
    x: Unknowns,
    linearisations: Cell<u32>,
}

impl<M: Differentiated<Spacecraft, 3>> LeastSquaresProblem<f64, Dyn, Dyn> for Arc<'_, M> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, x: &OVector<f64, Dyn>) {
        self.x = Unknowns::from_column_slice(x.as_slice());
    }

    fn params(&self) -> OVector<f64, Dyn> {
        OVector::<f64, Dyn>::from_column_slice(self.x.as_slice())
    }

    /// Of the attitudes, then of the first guess. Where there is no motion, as far off as an attitude can be: the optimiser steps
    /// back and tries a shorter step.
    fn residuals(&self) -> Option<OVector<f64, Dyn>> {
        let mut residuals = match self.estimator.attitudes(&self.x, &self.schedule) {
            Some(attitudes) => self.estimator.residuals(self.measured, &attitudes),
            None => vec![PI / self.estimator.sigma; 3 * self.schedule.count],
        };
        residuals.extend(self.estimator.departure(&self.x));
        Some(OVector::<f64, Dyn>::from_vec(residuals))
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, Dyn>> {
        self.linearisations.set(self.linearisations.get() + 1);
        let predicted = self.estimator.predict(&self.x, &self.schedule)?;
        let blocks = self.estimator.jacobian(self.measured, &predicted);
        let entry = |row: usize, column: usize| match blocks.get(row / 3) {
            Some(block) => block[(row % 3, column)],
            None if row - 3 * blocks.len() == column => 1.0 / PRIOR,
            None => 0.0,
        };
        Some(OMatrix::<f64, Dyn, Dyn>::from_fn(3 * blocks.len() + OF_INERTIA, COUNT, entry))
    }
}
