//! Estimates next to the truth, with their uncertainty by the covariance.

use crate::Spacecraft;
use crate::estimator::{Estimator, normal_equations};
use crate::fit::Fit;
use crate::measurement::{Measurements, Schedule};
use crate::unknowns::{COUNT, OF_INERTIA, Slopes, Unknowns};
use clebsch::Differentiated;
use clebsch_examples::claims::Claims;
use clebsch_examples::table::Table;
use nalgebra::{Matrix3, SMatrix};

/// Errors, in standard deviations, that are still taken for chance: 1 in 16 000.
const SIGMAS: f64 = 4.0;
/// √(bᵀJᵀJb) for the step's own error b, no less than b/σ of any number, up to which the noise alone explains the errors.
const LARGEST_BIAS: f64 = 0.5;
/// Standard deviation of a moment over the trace above which the data do not determine it.
const UNDETERMINED: f64 = 0.01;
const ARCSECONDS: f64 = 3600.0 * 180.0 / std::f64::consts::PI;

/// The results of the fit.
pub struct Report {
    fit: Fit,
    truth: Unknowns,
    /// JᵀJ, the residuals being in standard deviations.
    information: SMatrix<f64, COUNT, COUNT>,
    /// (JᵀJ)⁻¹; `None` where that is singular.
    pub covariance: Option<SMatrix<f64, COUNT, COUNT>>,
    /// The fit of exact attitudes, to first order: only the steps' error.
    bias: Unknowns,
    degrees_of_freedom: usize,
    trace: f64,
}

/// A number that is read off the unknowns: its name with unit, and its slopes; linear.
struct Reading {
    name: String,
    slopes: Unknowns,
    offset: f64,
}

impl Report {
    /// Of a fit, with its Jacobian there and at the truth.
    pub fn new<M: Differentiated<Spacecraft, 3>>(
        estimator: &Estimator<M>,
        measurements: &Measurements,
        schedule: &Schedule,
        fit: Fit,
        truth: Unknowns,
    ) -> Option<Self> {
        let blocks = |x: &Unknowns, from: &[Matrix3<f64>]| -> Option<(Vec<Slopes>, Vec<f64>)> {
            let predicted = estimator.predict(x, schedule)?;
            Some((estimator.jacobian(from, &predicted), estimator.residuals(from, &predicted.attitudes)))
        };
        let (there, residuals) = blocks(&fit.unknowns, &measurements.measured)?;
        let information = normal_equations(&there, &residuals).0;
        let covariance = invert(&information);
        let (at_truth, of_steps) = blocks(&truth, &measurements.exact)?;
        let (normal, gradient) = normal_equations(&at_truth, &of_steps);
        let bias = invert(&normal).map_or(Unknowns::repeat(f64::INFINITY), |inverse| -inverse * gradient);
        let degrees_of_freedom = 3 * schedule.count - COUNT;
        Some(Self { fit, truth, information, covariance, bias, degrees_of_freedom, trace: estimator.chart.trace })
    }

    fn readings(&self) -> Vec<Reading> {
        let ratio = |name, slopes: Unknowns, offset| Reading { name, slopes: slopes * self.trace, offset };
        let entry = |name: &str, place| ratio(format!("{name} / kg m²"), Unknowns::ith(place, 1.0), 0.0);
        let third = -Unknowns::ith(0, 1.0) - Unknowns::ith(1, 1.0);
        let mut readings = vec![entry("J11", 0), entry("J22", 1), ratio("J33 / kg m²".into(), third, self.trace)];
        readings.extend([("J12", 2), ("J13", 3), ("J23", 4)].map(|(name, place)| entry(name, place)));
        let scaled = |name, place, unit| Reading { name, slopes: Unknowns::ith(place, unit), offset: 0.0 };
        let spin = |axis: usize| scaled(format!("spin {axis} / °/s"), 7 + axis, 1_f64.to_degrees());
        let turn = |axis: usize| scaled(format!("attitude {axis} / arcsec"), 4 + axis, ARCSECONDS);
        readings.extend((1..=3).map(spin).chain((1..=3).map(turn)));
        readings
    }

    /// √(sᵀCs); infinite where nothing is determined.
    fn deviation(&self, slopes: &Unknowns) -> f64 {
        self.covariance.map_or(f64::INFINITY, |covariance| slopes.dot(&(covariance * slopes)).sqrt())
    }

    /// The largest of f over all readings, where that is a number.
    fn largest(&self, of: impl Fn(&Reading) -> f64) -> f64 {
        self.readings().iter().map(of).fold(0.0, |most: f64, number| most.max(number.abs()))
    }

    fn errors(&self, reading: &Reading) -> f64 {
        reading.slopes.dot(&(self.fit.unknowns - self.truth)) / self.deviation(&reading.slopes)
    }

    fn biases(&self, reading: &Reading) -> f64 {
        reading.slopes.dot(&self.bias) / self.deviation(&reading.slopes)
    }

    /// eᵀC⁻¹e, the square of the error of the worst combination of all numbers, in standard deviations.
    fn joint(&self, error: &Unknowns) -> f64 {
        error.dot(&(self.information * error))
    }

    /// Truth, estimate, standard deviation, error; and the error that is the step's, without the noise.
    pub fn table(&self) -> Table<6> {
        let mut table = Table::new(["", "true", "estimate", "σ", "error / σ", "of the step / σ"]);
        for reading in self.readings() {
            let deviation = self.deviation(&reading.slopes);
            let digits =
                if deviation.is_normal() { (1.0 - deviation.log10().floor()).clamp(0.0, 12.0) as usize } else { 3 };
            let value = |x: &Unknowns| format!("{:.digits$}", reading.slopes.dot(x) + reading.offset);
            table.row([
                reading.name.clone(),
                value(&self.truth),
                value(&self.fit.unknowns),
                format!("{deviation:.digits$}"),
                format!("{:+.2}", self.errors(&reading)),
                format!("{:+.3}", self.biases(&reading)),
            ]);
        }
        table
    }

    /// The course of the fit and χ² in one line.
    pub fn summary(&self) -> String {
        let (fit, freedom) = (&self.fit, self.degrees_of_freedom);
        let per_degree = fit.chi_square / freedom as f64;
        let bias = self.joint(&self.bias).sqrt();
        format!(
            "{} linearisations in all; χ² = {:.1}, {per_degree:.4} per degree of freedom ({freedom})\n\
             of exact attitudes the worst combination would be off by {bias:.2} σ, which is the error of the steps",
            fit.linearisations, fit.chi_square
        )
    }

    /// Why nothing can be claimed of the estimates, if so.
    fn reservation(&self) -> Option<String> {
        let moments = (0..OF_INERTIA).map(|place| self.deviation(&Unknowns::ith(place, 1.0)));
        let (worst, bias) = (moments.fold(0.0, f64::max), self.joint(&self.bias).sqrt());
        if worst > UNDETERMINED || worst.is_nan() {
            Some(format!("the data do not determine the inertia: σ is {worst:.1e} of its trace; take a longer arc"))
        } else if bias > LARGEST_BIAS || bias.is_nan() {
            Some(format!("the step's own error moves the estimate by {bias:.1} σ: take shorter steps"))
        } else {
            None
        }
    }

    /// Claims convergence, the sum of the squares, and each estimate.
    pub fn claim(&self, claims: &mut Claims) {
        let names = [
            "the fit has converged",
            "χ² of the residuals is that of noise",
            "every estimate is within 4 σ",
            "the errors of all estimates fit their covariance",
        ];
        if let Some(reason) = self.reservation() {
            names.iter().for_each(|name| claims.skip(name, &reason));
            return;
        }
        let per_degree = |chi_square: f64, freedom: usize| chi_square / freedom as f64;
        let band = |freedom| quantile(freedom, -SIGMAS)..=quantile(freedom, SIGMAS);
        let freedom = self.degrees_of_freedom;
        claims.holds(names[0], self.fit.has_converged, "Levenberg–Marquardt, the last arc");
        claims.within(
            names[1],
            per_degree(self.fit.chi_square, freedom),
            band(freedom),
            4,
            "per degree of freedom, at 4 σ",
        );
        claims.at_most(
            names[2],
            self.largest(|reading| self.errors(reading)),
            SIGMAS,
            "σ, from the covariance (JᵀJ)⁻¹",
        );
        let joint = self.joint(&(self.fit.unknowns - self.truth));
        claims.within(names[3], per_degree(joint, COUNT), band(COUNT), 4, "eᵀC⁻¹e per unknown, at 4 σ");
    }
}

/// The quantile of χ² per degree of freedom that is as likely as that of a normal number, in standard deviations.
///
/// Source: Wilson and Hilferty, *The distribution of chi-square*, PNAS 17 (1931) 684–688.
fn quantile(degrees_of_freedom: usize, sigmas: f64) -> f64 {
    let variance = 2.0 / (9.0 * degrees_of_freedom as f64);
    (1.0 - variance + sigmas * variance.sqrt()).max(0.0).powi(3)
}

/// The inverse of a symmetric positive matrix whose rows have different units: they are scaled to a diagonal of ones.
fn invert(matrix: &SMatrix<f64, COUNT, COUNT>) -> Option<SMatrix<f64, COUNT, COUNT>> {
    let scales = Unknowns::from_fn(|place, _| matrix[(place, place)].sqrt().recip());
    let scaled = SMatrix::<f64, COUNT, COUNT>::from_fn(|i, j| matrix[(i, j)] * scales[i] * scales[j]);
    let inverse = scaled.cholesky()?.inverse();
    Some(SMatrix::from_fn(|i, j| inverse[(i, j)] * scales[i] * scales[j]))
}
