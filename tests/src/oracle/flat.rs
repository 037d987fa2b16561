//! The numbers of configurations, momenta and elements of any shape, in one list.

use nalgebra::{Quaternion, SMatrix};

/// Values that are made of numbers.
pub trait Flat {
    /// Its numbers: vectors from their first entry on, matrices row by row, quaternions as (i, j, k, w).
    fn numbers(&self) -> Vec<f64>;
}

impl<const R: usize, const C: usize> Flat for SMatrix<f64, R, C> {
    fn numbers(&self) -> Vec<f64> {
        self.transpose().as_slice().to_vec()
    }
}
impl Flat for Quaternion<f64> {
    fn numbers(&self) -> Vec<f64> {
        self.coords.as_slice().to_vec()
    }
}
impl<A: Flat, B: Flat> Flat for (A, B) {
    fn numbers(&self) -> Vec<f64> {
        [self.0.numbers(), self.1.numbers()].concat()
    }
}
impl<A: Flat, const N: usize> Flat for [A; N] {
    fn numbers(&self) -> Vec<f64> {
        self.iter().flat_map(Flat::numbers).collect()
    }
}

/// The largest difference of two numbers; infinite where there is one less, or none.
pub fn far(a: &impl Flat, b: &impl Flat) -> f64 {
    let (a, b) = (a.numbers(), b.numbers());
    let differences = a.iter().zip(&b).map(|(x, y)| (x - y).abs());
    let largest = differences.fold(0.0, |max, d| if d.is_nan() { f64::INFINITY } else { f64::max(max, d) });
    if a.len() == b.len() { largest } else { f64::INFINITY }
}
