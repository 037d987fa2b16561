//! How far a run moves its energy and its conserved momenta, next to the law of rounding.

use crate::PlotError;
use crate::figure::{Area, Curve, Decades, Drawn, RGBColor};
use crate::picture::{Page, colour, picture, short};
use crate::rows::read;
use clebsch::{Clebsch, Columns, Method, Quantities, Real, Sample, Scalar, Table};

/// The change of the energy and of other numbers that a motion conserves, against the number of steps. See [`Drift`].
///
/// # Errors
/// [`PlotError::Step`] where a state was not reached, [`PlotError::NotFinite`] with the column, and [`PlotError::Nothing`] without a state.
pub fn drift<S, M, L, A>(
    table: Table<'_, S, M, L>,
    samples: impl IntoIterator<Item = Result<A, clebsch::Error>>,
) -> Result<Drift, PlotError>
where
    S: Clebsch<Scalar: Real>,
    M: Method<S>,
    L: Quantities<S, M>,
    A: Sample<S, M>,
{
    let stepper = table.stepper();
    let (mut kinetic, mut potential) = (0.0_f64, 0.0_f64);
    let columns = read(&table, samples, |sample| {
        let state = sample.state();
        let height = stepper.potential_at(sample.time(), state.configuration()).to_f64();
        potential = potential.max(height.abs());
        kinetic = kinetic.max(stepper.kinetic_energy(state).to_f64().abs());
    })?;
    let width = <S::Configuration as Columns<S::Scalar>>::FORM.width();
    let count = <S::Momentum as Columns<S::Scalar>>::FORM.width();
    let step = stepper.step_size().to_f64();
    let steps: Vec<f64> = columns[0].changes.iter().map(|time| time / step).collect();
    let momenta: Vec<&Vec<f64>> = columns[1 + width..][..count].iter().map(|column| &column.numbers).collect();
    let largest_momentum = largest((0..steps.len()).map(|state| {
        let numbers = momenta.iter().map(|numbers| numbers[state]);
        numbers.fold(0.0, f64::hypot)
    }));
    let curves = columns[1 + width + count..].iter().map(|column| {
        let of_column = largest(column.numbers.iter().copied());
        let scale = if column.value == "energy" { kinetic + potential } else { largest_momentum };
        Changing { name: column.name.clone(), changes: column.changes.clone(), scale: of_column.max(scale) }
    });
    let curves = curves.collect();
    let page = Page::new("Largest change since the start", (860, 480));
    Ok(Drift { page, steps, curves, epsilon: S::Scalar::EPSILON.to_f64() })
}

/// The largest of some numbers without their signs.
fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |largest: f64, number| largest.max(number.abs()))
}

/// How far a run moves its energy and its conserved momenta, with the law of rounding next to them.
///
/// Shown are the columns of the table behind configuration and momentum: `energy()`, `conserved()`, and `with(…)` of your own.
/// Each curve is the largest change so far, against the number of steps, both in powers of ten:
///
/// ```text
/// max |x(t) − x(0)| / scale
/// ```
///
/// The scale of an energy is the largest kinetic energy of the run plus the largest |V|. That of a momentum is the largest |N|.
/// A value that is larger than its scale is its own scale. [`scale`](Self::scale) gives another one.
///
/// The grey line is ε √n: how far n roundings of random sign carry a number of the size of the scale.
/// The momenta of a symplectic step follow it. Its energy stays in a band that is constant in time, and shrinks with the step size.
///
/// ```
/// use clebsch::Clebsch;
/// use clebsch_plot::drift;
/// use nalgebra::Vector3;
///
/// /// A pendulum of length one and mass one.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action    = |F: SO<3>, q: Unit<Vector3>| F * q,
///     cost      = |h, F| (F - I).norm_squared() / (4 * h),
///     potential = |q| self.gravity * q.z,
/// )]
/// struct Bob {
///     /// g, m/s².
///     gravity: f64,
/// }
///
/// let stepper = Bob { gravity: 9.81 }.into_stepper(0.01)?;
/// let start = stepper.state(Vector3::x(), Vector3::new(0.0, 0.3, 0.5))?;
/// let picture = drift(stepper.table().energy().conserved(), stepper.trajectory(start).every(0.01).with_times().take(3000))?;
/// let svg = picture.svg()?; // or .save("drift.svg")
/// assert!(svg.contains("about e3, spatial") && svg.contains("rounding, ε √n"));
/// assert!(picture.largest("about e3, spatial") < Some(1e-13));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Drift {
    page: Page,
    /// The number of steps to each state.
    steps: Vec<f64>,
    curves: Vec<Changing>,
    epsilon: f64,
}

/// A number that should stay.
#[derive(Clone, Debug)]
struct Changing {
    name: String,
    changes: Vec<f64>,
    scale: f64,
}

picture!(Drift);

/// The line of rounding.
const LAW: RGBColor = RGBColor(150, 156, 166);

/// Points of a curve in a power of ten.
const POINTS: f64 = 10.0;

impl Drift {
    /// The same with another scale for the changes of one column, in the unit of the column.
    ///
    /// # Errors
    /// [`PlotError::UnknownName`], and [`PlotError::Range`] for a scale that is not above zero and finite.
    pub fn scale(mut self, name: &str, scale: f64) -> Result<Self, PlotError> {
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(PlotError::Range { name: "scale", value: scale });
        }
        let known = || self.curves.iter().map(|curve| curve.name.clone()).collect();
        let error = PlotError::UnknownName { name: name.to_owned(), known: known() };
        let curve = self.curves.iter_mut().find(|curve| curve.name == name);
        curve.ok_or(error)?.scale = scale;
        Ok(self)
    }

    /// The largest change of a column since the start, over its scale; `None` for a name that the table does not have.
    pub fn largest(&self, name: &str) -> Option<f64> {
        let curve = self.curves.iter().find(|curve| curve.name == name)?;
        Some(curve.changes().fold(0.0, f64::max))
    }

    /// The picture as the text of an SVG file.
    ///
    /// # Errors
    /// [`PlotError::Nothing`] where the table has no column behind configuration and momentum, and [`PlotError::Drawing`].
    pub fn svg(&self) -> Result<String, PlotError> {
        if self.curves.is_empty() {
            return Err(PlotError::Nothing);
        }
        self.page.untitled(|area| self.paint(area))
    }

    fn paint(&self, area: &Area<'_>) -> Drawn {
        let last = self.steps.last().copied().unwrap_or(1.0).abs().max(1.0);
        let law = [1.0, last].map(|steps| (steps, self.epsilon * steps.sqrt())).to_vec();
        let names: Vec<String> = self.curves.iter().map(|curve| curve.label()).collect();
        let mut curves =
            vec![Curve { label: "rounding, ε √n", colour: LAW, width: 2.0, points: law, ringed: Vec::new() }];
        curves.extend(self.curves.iter().zip(&names).enumerate().map(|(index, (curve, label))| Curve {
            label,
            colour: colour(index),
            width: 1.4,
            points: self.envelope(curve),
            ringed: Vec::new(),
        }));
        Decades { title: &self.page.title, x_label: "steps", y_label: "change over its scale", curves: &curves }
            .draw(area)
    }

    /// The largest change so far at a few places of each power of ten, and at the end.
    fn envelope(&self, curve: &Changing) -> Vec<(f64, f64)> {
        let mut points = Vec::new();
        let mut largest: f64 = 0.0;
        let mut passed = f64::NEG_INFINITY;
        let end = self.steps.len().saturating_sub(1);
        for (index, (steps, change)) in self.steps.iter().zip(curve.changes()).enumerate() {
            largest = largest.max(change);
            let place = (steps.abs().log10() * POINTS + 1e-9).floor();
            if place > passed || index == end {
                passed = place.max(passed);
                points.push((steps.abs(), largest));
            }
        }
        points
    }
}

impl Changing {
    fn changes(&self) -> impl Iterator<Item = f64> + '_ {
        // a scale of zero is that of numbers that are all zero
        let scale = if self.scale > 0.0 { self.scale } else { 1.0 };
        self.changes.iter().map(move |change| (change / scale).abs())
    }

    fn label(&self) -> String {
        let moves = self.changes().any(|change| change > 0.0);
        if moves { short(&self.name, 28) } else { format!("{}: no change", short(&self.name, 18)) }
    }
}
