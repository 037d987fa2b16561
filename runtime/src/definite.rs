//! Whether a kinetic energy ½ ξ·Σξ is positive: the signs of the eigenvalues of an inertia.

use crate::linear::{matrix, rows};
use crate::newton::{Ldl, Spectrum, UNITS};
use crate::{Error, Mask, Real, Scalar, Space};
use nalgebra::SMatrix;

/// Whether an inertia Σ, symmetric and regular, is positive definite.
///
/// The units of its rows do not matter. Let S be the square roots of its diagonal, and Σ = S H S. An eigenvalue of H down to
/// −16 N ε is a rounding error. An inertia that is not finite passes: other checks name the number.
///
/// Source: Higham, *Accuracy and Stability of Numerical Algorithms*, theorem 10.7.
///
/// # Errors
/// [`Error::IndefiniteKineticEnergy`].
// a function of its own: its matrices take no stack of the set-up
#[inline(never)]
pub fn check_definite<T: Scalar, const N: usize>(inertia: &SMatrix<T, N, N>) -> Result<(), Error> {
    (0..T::LANES).try_for_each(|lane| {
        let inertia = inertia.lane(lane);
        if is_definite(&inertia) || !Space::<T::Lane>::all_finite(&inertia) {
            Ok(())
        } else {
            Err(indefinite(&inertia))
        }
    })
}

/// The same of the inertia κI.
///
/// # Errors
/// [`Error::IndefiniteKineticEnergy`].
#[inline]
pub fn check_definite_uniform<T: Scalar>(kappa: &T) -> Result<(), Error> {
    // Written so that NaN passes.
    if kappa.below(T::zero()).any() { check_definite(&matrix([[*kappa]])) } else { Ok(()) }
}

/// The same of an inertia at one configuration and time. It may be singular there: the rounding error of its largest entry counts as 0.
///
/// # Errors
/// [`Error::IndefiniteKineticEnergy`].
pub fn check_definite_at<T: Scalar, const N: usize>(inertia: &SMatrix<T, N, N>) -> Result<(), Error> {
    let largest = inertia.max_abs();
    let least = rounding::<T, N>() * T::select(largest.equals(T::zero()), T::one(), largest);
    check_definite(&matrix(with_diagonal(inertia, |entry| entry + least)))
}

/// The rounding error of an eigenvalue of a matrix whose diagonal is one.
fn rounding<T: Scalar, const N: usize>() -> T {
    T::from_f64(UNITS * N as f64) * T::EPSILON
}

/// Whether all pivots of LDLᵀ are positive. The diagonal is longer by its rounding error.
fn is_definite<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> bool {
    let longer = T::one() + rounding::<T, N>();
    Ldl::definite(&with_diagonal(a, |entry| entry * longer), T::one()).is_some()
}

/// The rows of a matrix with other entries in the diagonal.
fn with_diagonal<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>, entry: impl Fn(T) -> T) -> [[T; N]; N] {
    let mut rows = rows(a);
    rows.iter_mut().enumerate().filter_map(|(i, row)| row.get_mut(i)).for_each(|x| *x = entry(*x));
    rows
}

/// The error with the eigenvalues of Σ.
#[cold]
#[inline(never)]
fn indefinite<T: Real, const N: usize>(inertia: &SMatrix<T, N, N>) -> Error {
    let values = Spectrum::of(inertia).values;
    let first = values.iter().next().map_or(T::zero(), |value| *value);
    let least = values.iter().fold(first, |least, value| if *value < least { *value } else { least });
    let largest = values.iter().fold(first, |largest, value| if *value > largest { *value } else { largest });
    // an eigenvalue of the largest numbers may be beyond them
    let known = |value: T| value.to_f64().clamp(-f64::MAX, f64::MAX);
    let (least_eigenvalue, largest_eigenvalue) = (known(least), known(largest));
    Error::IndefiniteKineticEnergy { least_eigenvalue, largest_eigenvalue }
}

#[cfg(test)]
mod tests;
