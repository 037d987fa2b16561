//! A scene: its equations of motion, its conserved quantities, and the ways to integrate it.

use crate::setting::Setting;
use clebsch_examples::claims::largest;
use nalgebra::{SVector, Vector3, Vector6};

/// ẏ of y.
pub type Field<const N: usize> = Box<dyn Fn(&SVector<f64, N>) -> SVector<f64, N>>;
/// A number that belongs to y.
pub type Observable<const N: usize> = Box<dyn Fn(&SVector<f64, N>) -> f64>;

/// Three components of the momentum at a time.
pub type ClosedForm = fn(f64) -> Option<Vector3<f64>>;

/// A motion at a time, and its rounding error.
pub type Known<const N: usize> = Box<dyn Fn(f64) -> (SVector<f64, N>, f64)>;

/// A motion of N numbers: the configuration, then the momentum.
pub struct Scene<const N: usize> {
    /// For flags and files.
    pub name: &'static str,
    /// For people.
    pub title: &'static str,
    /// Units of time.
    pub duration: f64,
    /// The motion at the start.
    pub start: SVector<f64, N>,
    /// ẏ = f(y)
    pub field: Field<N>,
    /// Kinetic plus potential.
    pub energy: Observable<N>,
    /// Momenta that the motion keeps; 0 where there are fewer than six.
    pub momenta: fn(&SVector<f64, N>) -> Vector6<f64>,
    /// By how much the configuration is off its space.
    pub constraint: fn(&SVector<f64, N>) -> f64,
    /// The first number of the momentum.
    pub split: usize,
    /// Size of the momentum, over which its errors are taken; configurations are of size 1.
    pub momentum_size: f64,
    /// The momentum of the exact motion at a time, where it is known in functions.
    pub closed_form: Option<ClosedForm>,
    /// The motion at a time with its rounding error, where it is known in functions. Nothing else is a reference then.
    pub known: Option<Known<N>>,
    /// Steps of the reference in each tenth of the duration; half as many tell its error.
    pub reference_steps: u64,
    /// The energy is followed for so many durations: for many of the slowest periods.
    pub longer: u64,
    /// Rounding shows in errors below this.
    pub least_error: f64,
    /// Whether errors of order 16 show it: its steps are as long as the motion, and other powers of h may be as large.
    pub shows_sixteen: bool,
    /// The settings that are compared.
    pub settings: Vec<Box<dyn Setting<N>>>,
}

impl<const N: usize> Scene<N> {
    /// The largest error of a motion, relative.
    pub fn distance(&self, y: &SVector<f64, N>, exact: &SVector<f64, N>) -> f64 {
        let size = |entry: usize| if entry < self.split { 1.0 } else { self.momentum_size };
        let error = |entry: usize| (y[entry] - exact[entry]).abs() / size(entry);
        largest((0..N).map(error))
    }
}
