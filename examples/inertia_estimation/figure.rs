//! The error of the attitude before and after the fit.

use crate::measurement::{Measurements, Schedule};
use crate::rotation::logarithm;
use crate::unknowns::{COUNT, Slopes};
use crate::{Flags, SCENE};
use clebsch_examples::figure::{self, BLUE, GREEN, INK, ORANGE, PURPLE, Panel, RED, RGBColor, Series};
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, SMatrix, Vector3};

const ARCSECONDS: f64 = 3600.0 * 180.0 / std::f64::consts::PI;

/// The contents of the figure.
pub struct Drawing<'a> {
    /// When.
    pub schedule: &'a Schedule,
    /// As they are and as measured.
    pub measurements: &'a Measurements,
    /// Attitudes of the first guess; empty where it has no motion.
    pub guessed: &'a [Matrix3<f64>],
    /// Attitudes of the estimate.
    pub estimated: &'a [Matrix3<f64>],
    /// Their derivatives with respect to the unknowns.
    pub slopes: &'a [Slopes],
    /// Of the unknowns.
    pub covariance: Option<SMatrix<f64, COUNT, COUNT>>,
}

/// From above: guess against truth, estimate against measurements, estimate against truth.
pub fn draw(flags: &Flags, drawing: &Drawing<'_>) -> Result<(), Failure> {
    figure::draw(&flags.run, SCENE.name, (1000, 640), |area| {
        let area = figure::caption(area, "The inertia of a tumbling spacecraft, estimated from its attitudes")?;
        let (first, rest) = figure::rows(&area, 180.0);
        let (second, third) = figure::rows(&rest, 215.0);
        drawing.before().draw(&first)?;
        drawing.residuals().draw(&second)?;
        drawing.after().draw(&third)
    })
}

impl Drawing<'_> {
    fn curve<'a>(&self, label: &'a str, colour: RGBColor, values: impl Iterator<Item = f64>) -> Series<'a> {
        let points = values.enumerate().map(|(index, value)| (index as f64 * self.schedule.interval(), value));
        Series { label, colour, points: points.collect() }
    }

    /// Rotation vectors from the one to the other, body frame.
    fn angles(from: &[Matrix3<f64>], to: &[Matrix3<f64>]) -> Vec<Vector3<f64>> {
        from.iter().zip(to).map(|(from, to)| logarithm(&(from.transpose() * to))).collect()
    }

    fn before(&self) -> Panel<'_> {
        let angles = Self::angles(&self.measurements.exact, self.guessed);
        let series = vec![self.curve("", RED, angles.iter().map(|angle| angle.norm().to_degrees()))];
        Panel { title: "Before: angle between the body as guessed and as it is", unit: "degrees", x_label: "", series }
    }

    fn residuals(&self) -> Panel<'_> {
        let angles = Self::angles(&self.measurements.measured, self.estimated);
        let component = |axis: usize| angles.iter().map(move |angle| angle[axis] * ARCSECONDS);
        let band = self.measurements.sigma * ARCSECONDS;
        let level = |height: f64| angles.iter().map(move |_| height * band);
        let series = vec![
            self.curve("about 1", BLUE, component(0)),
            self.curve("2", ORANGE, component(1)),
            self.curve("3", GREEN, component(2)),
            self.curve("±3 σ of the noise", INK, level(3.0)),
            self.curve("", INK, level(-3.0)),
        ];
        Panel { title: "After: estimated against measured attitude", unit: "arcsec", x_label: "", series }
    }

    fn after(&self) -> Panel<'_> {
        let angles = Self::angles(&self.measurements.exact, self.estimated);
        let error = angles.iter().map(|angle| angle.norm() * ARCSECONDS);
        let mut series = vec![self.curve("error", BLUE, error)];
        if let Some(covariance) = self.covariance {
            let spread = |slopes: &Slopes| (slopes * covariance * slopes.transpose()).trace().sqrt() * ARCSECONDS;
            series.push(self.curve("expected, root mean square", PURPLE, self.slopes.iter().map(spread)));
        }
        let x_label = "time (seconds)";
        Panel { title: "After: angle between the estimated and the true attitude", unit: "arcsec", x_label, series }
    }
}
