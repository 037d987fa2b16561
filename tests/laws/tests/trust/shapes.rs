//! The elements and configurations of derived systems as matrices of the oracle, and back.

use clebsch_tests::oracle::flat::Flat;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::on_itself::{Kind, shown};
use nalgebra::{Quaternion, SMatrix};

/// A configuration that is an element of the group too.
pub trait Element: Flat + Copy + std::fmt::Debug {
    /// Its kind for the oracle.
    const KIND: Kind;

    /// The one with these numbers, in the order of [`Flat::numbers`].
    fn from_numbers(numbers: &[f64]) -> Self;

    /// The matrix of the oracle.
    fn lift(&self) -> Matrix<f64>;

    /// The element that a matrix of the oracle stands for.
    fn lower(matrix: &Matrix<f64>) -> Self {
        Self::from_numbers(shown(Self::KIND, matrix).entries())
    }

    /// The inverse element.
    fn inverted(&self) -> Self {
        Self::lower(&self.lift().inverse())
    }
}

impl<const R: usize, const C: usize> Element for SMatrix<f64, R, C> {
    const KIND: Kind = if C == 1 { Kind::Vector } else { Kind::Matrix };

    fn from_numbers(numbers: &[f64]) -> Self {
        SMatrix::from_row_slice(numbers)
    }
    fn lift(&self) -> Matrix<f64> {
        match Self::KIND {
            Kind::Matrix => Matrix::from(self),
            _ => Matrix::from_fn(R + 1, R + 1, |i, j| match (i == j, j == R) {
                (true, _) => 1.0,
                (_, true) => self[(i, 0)],
                _ => 0.0,
            }),
        }
    }
}

impl Element for Quaternion<f64> {
    const KIND: Kind = Kind::Quaternion;

    fn from_numbers(numbers: &[f64]) -> Self {
        Quaternion::new(numbers[3], numbers[0], numbers[1], numbers[2])
    }
    fn lift(&self) -> Matrix<f64> {
        let unit = |k: usize| Quaternion::from_numbers(&[0, 1, 2, 3].map(|i| f64::from(u8::from(i == k))));
        let columns = [0, 1, 2, 3].map(|k| (self * unit(k)).numbers());
        Matrix::from_fn(4, 4, |i, j| columns[j][i])
    }
}
