//! One cell of the map: a scene with a dial, from one start, in one number type.

use crate::motion::{Advancing, Motion, Observation, Watched};
use crate::setup::Setup;
use clebsch::Error;
use clebsch_examples::counted::iterations;

/// The outcome of a run.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Whether it came to its end, and why not.
    pub outcome: Result<(), Error>,
    /// Steps that were made.
    pub steps: u64,
    /// The most iterations of one step.
    pub iterations: u32,
    /// The largest |F⁻ℓd(q, F) − N|, over momenta: the error in the equation of a step. NaN where steps are composed or
    /// collocated, and have none.
    pub residual: f64,
    /// Largest relative change of the energy.
    pub energy: f64,
    /// Largest change of conserved momenta over |N|.
    pub momentum: f64,
    /// Largest defect of the configuration.
    pub constraint: f64,
    /// Largest difference from the same steps in 31 digits, relative to configuration and momentum; NaN where there are none.
    pub precise: f64,
    /// Configuration and momentum in the end.
    pub last: Vec<f64>,
}

impl Cell {
    /// The entries that are not measured, of a run that ended like this.
    pub fn of(outcome: Result<(), Error>, steps: u64) -> Self {
        Self { steps, ..Self::new(outcome, f64::NAN) }
    }

    /// Before any step: `measured` stands for the quantities that are measured in steps.
    fn new(outcome: Result<(), Error>, measured: f64) -> Self {
        Self {
            outcome,
            steps: 0,
            iterations: 0,
            residual: measured,
            energy: measured,
            momentum: measured,
            constraint: measured,
            precise: f64::NAN,
            last: Vec::new(),
        }
    }

    /// Whether a number that is not finite was handed out as a result.
    pub fn hides_nan(&self) -> bool {
        self.last.iter().any(|x| !x.is_finite())
    }
}

/// A motion from a start.
type Begin<W> = fn(&Setup) -> Result<Box<W>, Error>;

/// A scene with a dial.
#[derive(Clone, Copy)]
pub struct Dial {
    /// The scene.
    pub scene: &'static str,
    /// The declaration.
    pub name: &'static str,
    /// In `f64` and in `f32`.
    pub begin: [Begin<dyn Watched>; 2],
    /// In 31 digits.
    pub precise: Begin<dyn Motion>,
}

/// A scene with a dial for long runs.
#[derive(Clone, Copy)]
pub struct LongRun {
    /// The scene.
    pub scene: &'static str,
    /// The declaration.
    pub name: &'static str,
    /// In `f64` and in `f32`.
    pub begin: [Begin<dyn Advancing>; 2],
}

/// The dial of a method of a declaration that is generic over its scalar.
macro_rules! dial {
    ($name:literal, $scene:literal, $system:ident, $method:ty) => {
        $crate::probe::Dial {
            scene: $scene,
            name: $name,
            begin: [
                |setup| Ok(Box::new(Moving::<$system<Counted<f64>>, $method>::new(setup)?)),
                |setup| Ok(Box::new(Moving::<$system<Counted<f32>>, $method>::new(setup)?)),
            ],
            precise: |setup| Ok(Box::new(Moving::<$system<DoubleDouble>, $method>::new(setup)?)),
        }
    };
}
pub(crate) use dial;

/// The same for [`LongRun`].
macro_rules! long_run {
    ($name:literal, $scene:literal, $system:ident, $method:ty) => {
        $crate::probe::LongRun {
            scene: $scene,
            name: $name,
            begin: [
                |setup| Ok(Box::new(Moving::<$system<Counted<f64>>, $method>::new(setup)?)),
                |setup| Ok(Box::new(Moving::<$system<Counted<f32>>, $method>::new(setup)?)),
            ],
        }
    };
}
pub(crate) use long_run;

impl Dial {
    /// `steps` steps in a type, watched. If they are to be compared, as many steps in 31 digits run with them.
    pub fn run(&self, scalar: usize, setup: &Setup, steps: u64, is_compared: bool) -> Cell {
        let mut cell = match (self.begin[scalar])(setup) {
            Ok(motion) => watch(motion, steps),
            Err(error) => return Cell::new(Err(error), f64::NAN),
        };
        if is_compared && cell.outcome.is_ok() {
            let setup = if scalar == 0 { setup.clone() } else { setup.rounded() };
            if let Ok(precise) = (self.precise)(&setup).and_then(|motion| end(motion, steps)) {
                cell.precise = distance(&cell.last, &precise);
            }
        }
        cell
    }

    /// One step in `f64`.
    ///
    /// # Errors
    /// Whatever it is refused for.
    pub fn step(&self, setup: &Setup) -> Result<(), Error> {
        (self.begin[0])(setup)?.step()
    }

    /// Configuration and momentum after one step in `f64`: those of the start where it is refused, none where that is.
    pub fn place(&self, setup: &Setup) -> Vec<f64> {
        let Ok(mut motion) = (self.begin[0])(setup) else { return Vec::new() };
        let _ = motion.step();
        motion.numbers()
    }
}

/// Steps, watched.
fn watch(mut motion: Box<dyn Watched>, steps: u64) -> Cell {
    let mut watch = Watch::new(motion.as_ref());
    for step in 0..steps {
        let (stepped, iterations) = iterations(|| motion.step());
        watch.cell.iterations = watch.cell.iterations.max(iterations);
        if let Err(error) = stepped {
            watch.cell.outcome = Err(error);
            break;
        }
        watch.cell.steps = step + 1;
        watch.observe(motion.as_ref());
    }
    watch.cell.last = motion.numbers();
    watch.cell
}

/// Configuration and momentum after so many steps.
fn end(mut motion: Box<dyn Motion>, steps: u64) -> Result<Vec<f64>, Error> {
    for _ in 0..steps {
        motion.step()?;
    }
    Ok(motion.numbers())
}

/// The quantities that are followed during a run.
#[derive(Clone)]
pub struct Watch {
    /// The results so far.
    pub cell: Cell,
    energy: f64,
    conserved: [f64; 3],
    /// The largest |N| so far, or 1.
    size: f64,
}

impl Watch {
    /// At the start.
    pub fn new(start: &dyn Watched) -> Self {
        let mut cell = Cell::new(Ok(()), 0.0);
        cell.residual = if start.has_equation() { 0.0 } else { f64::NAN };
        let Observation { energy, size, conserved, .. } = start.observe();
        Self { cell, energy, conserved, size: if size > 0.0 { size } else { 1.0 } }
    }

    /// Takes the next state.
    pub fn observe(&mut self, motion: &dyn Watched) {
        let raise = |largest: &mut f64, value: f64| {
            // NaN stays
            if value > *largest || value.is_nan() {
                *largest = value;
            }
        };
        let Observation { energy, size, conserved, constraint } = motion.observe();
        let change = (energy - self.energy).abs();
        let scale = if self.energy == 0.0 { 1.0 } else { self.energy.abs() };
        raise(&mut self.cell.energy, change / scale);
        raise(&mut self.size, size);
        for (now, then) in conserved.into_iter().zip(self.conserved) {
            raise(&mut self.cell.momentum, (now - then).abs() / self.size);
        }
        raise(&mut self.cell.constraint, constraint);
        if motion.has_equation()
            && let Some(missed) = motion.residual()
        {
            raise(&mut self.cell.residual, missed);
        }
    }
}

/// The largest difference, of configurations (of the order of one), and of the momentum over its size.
fn distance(one: &[f64], other: &[f64]) -> f64 {
    let place = one.len() - 3;
    let size = other[place..].iter().fold(f64::MIN_POSITIVE, |max, x| max.max(x.abs()));
    let differences = one.iter().zip(other).enumerate();
    differences.fold(0.0, |max, (i, (a, b))| f64::max(max, (a - b).abs() / if i < place { 1.0 } else { size }))
}
