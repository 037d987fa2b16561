//! Random vectors, rotations and bodies, and how many of them.

use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, Vector3};
use proptest::prelude::*;

/// Half as many cases, two at least, and four times as many with the feature `heavy`, unless `PROPTEST_CASES` says otherwise. Nothing is written where one fails: its numbers are printed.
pub fn cases(number: u32) -> ProptestConfig {
    let asked = ProptestConfig { failure_persistence: None, ..ProptestConfig::default() };
    let is_asked = std::env::var_os("PROPTEST_CASES").is_some();
    let number = if cfg!(feature = "heavy") { 4 * number } else { (number / 2).max(2) };
    ProptestConfig { cases: if is_asked { asked.cases } else { number }, max_global_rejects: 100_000, ..asked }
}

/// A matrix with entries between −`size` and `size`.
pub fn matrix<const R: usize, const C: usize>(size: f64) -> BoxedStrategy<SMatrix<f64, R, C>> {
    prop::collection::vec(-size..size, R * C).prop_map(|entries| SMatrix::from_row_slice(&entries)).boxed()
}

/// A vector with entries between −`size` and `size`.
pub fn vector<const N: usize>(size: f64) -> BoxedStrategy<SVector<f64, N>> {
    matrix(size)
}

/// A rotation by an angle of at most √3 `size`.
pub fn rotation(size: f64) -> BoxedStrategy<Matrix3<f64>> {
    vector::<3>(size).prop_map(|vector| Rotation3::from_scaled_axis(vector).into_inner()).boxed()
}

/// Any rotation.
pub fn attitude() -> BoxedStrategy<Matrix3<f64>> {
    rotation(3.2)
}

/// A point of the sphere.
pub fn unit() -> BoxedStrategy<Vector3<f64>> {
    attitude().prop_map(|r| r.column(2).into_owned()).boxed()
}

/// A symmetric matrix with eigenvalues between ½ and 3/2.
pub fn definite<const N: usize>() -> BoxedStrategy<SMatrix<f64, N, N>> {
    let near_one = |a: SMatrix<f64, N, N>| SMatrix::identity() + (a + a.transpose()) * (0.25 / N as f64);
    matrix(1.0).prop_map(near_one).boxed()
}
