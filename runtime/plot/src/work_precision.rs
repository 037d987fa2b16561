//! The price of accuracy: errors of the methods of a declaration against the time of computing.

use crate::PlotError;
use crate::figure::{Area, Curve, Decades, Drawn};
use crate::picture::{Page, colour, picture, short};
use clebsch::{Clebsch, Columns, Error, Method, Real, Scalar};
use std::time::{Duration, Instant};

/// The errors of methods over a duration, against the time of computing. See [`WorkPrecision`].
///
/// # Errors
/// [`PlotError::Range`] for a duration that is not above zero and finite.
pub fn work_precision<S: Clebsch<Scalar: Real> + Clone>(
    system: &S,
    (configuration, momentum): (S::Configuration, S::Momentum),
    duration: S::Scalar,
) -> Result<Study<S>, PlotError> {
    let value = duration.to_f64();
    if !(value > 0.0 && value.is_finite()) {
        return Err(PlotError::Range { name: "duration", value });
    }
    let steps = (4..15).map(|power| 1 << power).collect();
    let picture = WorkPrecision {
        page: Page::new("Work and precision", (860, 560)),
        methods: Vec::new(),
        reference: None,
        reference_error: 0.0,
    };
    Ok(Study { system: system.clone(), start: (configuration, momentum), duration, steps, picture })
}

/// A study that takes up one method after the other, made by [`work_precision`].
///
/// Each method makes runs over the same time, with more and more steps. [`reference`](Self::reference) ends the study.
///
/// ```
/// use clebsch::{Clebsch, Declared};
/// use clebsch_plot::work_precision;
/// use nalgebra::Vector1;
///
/// /// A pendulum of length one and mass one, by its angle.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action    = |a: Translation<1>, x: Vector1| x + a,
///     cost      = |h, a| a.norm_squared() / (2 * h),
///     potential = |x| -self.gravity * x.x.cos(),
///     method Fine = (order = 6),
/// )]
/// struct Pendulum {
///     /// g, m/s².
///     gravity: f64,
/// }
/// struct Fine;
///
/// let start = (Vector1::new(2.0), Vector1::zeros());
/// let study = work_precision(&Pendulum { gravity: 9.81 }, start, 1.0)?.steps(&[20, 40, 80]);
/// let study = study.method::<Declared>("order 2")?.method::<Fine>("order 6")?.reference::<Fine>(1000)?;
/// study.svg()?; // or .save("work_precision.svg")
/// let [long, half, quarter] = study.errors("order 2")[..] else { panic!("three runs") };
/// assert!((long / half).log2() > 1.9 && (half / quarter).log2() > 1.9); // order 2
/// # Ok::<(), clebsch_plot::PlotError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Study<S: Clebsch> {
    system: S,
    start: (S::Configuration, S::Momentum),
    duration: S::Scalar,
    steps: Vec<usize>,
    picture: WorkPrecision,
}

/// Errors of methods against the time of computing, both in powers of ten, made by [`Study::reference`].
///
/// The error is the distance of the last configuration from that of the reference. It is the root of the sum of all squared
/// differences of their numbers. Grey is the error of the reference itself, estimated by a run of half as many steps.
/// Errors that are not above it say nothing.
///
/// Times depend on the machine: build with `--release`, and take ratios.
///
/// ```
/// # use clebsch::{Clebsch, Declared};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action    = |a: Translation<1>, x: Vector1| x + a,
/// #     cost      = |h, a| a.norm_squared() / (2 * h),
/// #     potential = |x| -self.gravity * x.x.cos(),
/// #     method Fine = (order = 6),
/// # )]
/// # struct Pendulum { gravity: f64 }
/// # struct Fine;
/// # let pendulum = Pendulum { gravity: 9.81 };
/// use clebsch_plot::{WorkPrecision, work_precision};
///
/// let study = work_precision(&pendulum, (Vector1::new(2.0), Vector1::zeros()), 1.0)?.steps(&[10, 20]);
/// let picture: WorkPrecision = study.method::<Declared>("order 2")?.reference::<Fine>(500)?;
/// assert_eq!(picture.errors("order 2").len(), 2);
/// assert!(picture.reference_error() < 1e-9);
/// # Ok::<(), clebsch_plot::PlotError>(())
/// ```
#[derive(Clone, Debug)]
pub struct WorkPrecision {
    page: Page,
    methods: Vec<Measured>,
    /// The numbers of the configuration at the end.
    reference: Option<Vec<f64>>,
    reference_error: f64,
}

/// The runs of a method.
#[derive(Clone, Debug)]
struct Measured {
    label: String,
    runs: Vec<Run>,
}

/// Its time, and the numbers of the configuration at its end.
#[derive(Clone, Debug)]
struct Run {
    time: Duration,
    end: Vec<f64>,
}

picture!(WorkPrecision);

impl<S: Clebsch<Scalar: Real> + Clone> Study<S> {
    /// The same with runs of so many steps, in place of 16, 32, … 16 384.
    #[must_use]
    pub fn steps(mut self, steps: &[usize]) -> Self {
        self.steps = steps.to_vec();
        self
    }

    /// And the runs of a method: [`Declared`](clebsch::Declared), or one that the declaration names.
    ///
    /// A number of steps that the method refuses, because they are too long for it, gives no point.
    ///
    /// # Errors
    /// [`PlotError::NoRun`] where every step size was refused, and [`PlotError::Nothing`] without one.
    pub fn method<M: Method<S>>(mut self, label: &str) -> Result<Self, PlotError> {
        let mut runs = Vec::new();
        let mut refused = None;
        for &steps in &self.steps {
            match self.run::<M>(steps) {
                Ok(run) => runs.push(run),
                Err(error) => refused = Some(error),
            }
        }
        match refused.filter(|_| runs.is_empty()) {
            Some(error) => return Err(PlotError::NoRun { label: label.to_owned(), error }),
            None if runs.is_empty() => return Err(PlotError::Nothing),
            None => {}
        }
        self.picture.methods.push(Measured { label: label.to_owned(), runs });
        Ok(self)
    }

    /// Measures all errors against a run of a method in so many steps.
    ///
    /// # Errors
    /// [`PlotError::NoRun`] where the method refuses these steps or half as many, [`PlotError::Range`] for less than two, and
    /// [`PlotError::Nothing`] without a method.
    pub fn reference<M: Method<S>>(mut self, steps: usize) -> Result<WorkPrecision, PlotError> {
        if steps < 2 {
            return Err(PlotError::Range {
                name: "number of steps of the reference, less one,",
                value: steps as f64 - 1.0,
            });
        }
        if self.picture.methods.is_empty() {
            return Err(PlotError::Nothing);
        }
        let refused = |error| PlotError::NoRun { label: "the reference".to_owned(), error };
        let reference = self.run::<M>(steps).map_err(refused)?.end;
        let half = self.run::<M>(steps / 2).map_err(refused)?.end;
        self.picture.reference_error = distance(&reference, &half);
        self.picture.reference = Some(reference);
        Ok(self.picture)
    }

    /// The shortest of a few runs.
    fn run<M: Method<S>>(&self, steps: usize) -> Result<Run, Error> {
        /// Runs are repeated for so long.
        const PATIENCE: Duration = Duration::from_millis(20);
        let step = self.duration / S::Scalar::from_f64(steps as f64);
        let stepper = self.system.clone().into_stepper_by::<M>(step)?;
        let start = stepper.state(self.start.0, self.start.1)?;
        let begin = Instant::now();
        let mut least = Duration::MAX;
        loop {
            let before = Instant::now();
            let state = stepper.advance(&start, steps)?;
            least = least.min(before.elapsed());
            if begin.elapsed() >= PATIENCE {
                let end = state.configuration();
                let numbers = (0..).map_while(|k| end.entry(k)).map(S::Scalar::to_f64);
                return Ok(Run { time: least, end: numbers.collect() });
            }
        }
    }
}

/// The root of the sum of the squares of all differences.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a - b).fold(0.0, f64::hypot)
}

impl WorkPrecision {
    /// The errors of the method with this label, of its runs in their order. Empty for a label that was not given.
    pub fn errors(&self, label: &str) -> Vec<f64> {
        let Some(method) = self.methods.iter().find(|method| method.label == label) else { return Vec::new() };
        method.runs.iter().map(|run| self.error(run)).collect()
    }

    /// The error of the reference, estimated by half as many steps. The reference itself is more exact.
    pub fn reference_error(&self) -> f64 {
        self.reference_error
    }

    fn error(&self, run: &Run) -> f64 {
        self.reference.as_ref().map_or(f64::NAN, |reference| distance(&run.end, reference))
    }

    /// The picture as the text of an SVG file.
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    pub fn svg(&self) -> Result<String, PlotError> {
        self.page.untitled(|area| self.paint(area))
    }

    fn paint(&self, area: &Area<'_>) -> Drawn {
        let times = || self.methods.iter().flat_map(|method| &method.runs).map(|run| run.time.as_secs_f64());
        let (low, high) = times().fold((f64::INFINITY, 0.0_f64), |(low, high), time| (low.min(time), high.max(time)));
        let reference = vec![(self.reference_error, low), (self.reference_error, high)];
        let names: Vec<String> = self.methods.iter().map(|method| short(&method.label, 28)).collect();
        let grey = crate::figure::RGBColor(150, 156, 166);
        let mut curves = vec![Curve {
            label: "error of the reference",
            colour: grey,
            width: 2.0,
            points: reference,
            ringed: Vec::new(),
        }];
        curves.extend(self.methods.iter().zip(&names).enumerate().map(|(index, (method, label))| Curve {
            label,
            colour: colour(index),
            width: 1.4,
            points: method.runs.iter().map(|run| (self.error(run), run.time.as_secs_f64())).collect(),
            ringed: Vec::new(),
        }));
        let x_label = "error of the configuration at the end";
        Decades { title: &self.page.title, x_label, y_label: "time of computing (s)", curves: &curves }.draw(area)
    }
}
