//! The values that a stepper checks and computes from the fields of a struct, once.

use crate::linear::{eliminate, power_of_two_near, rows};
use crate::orientation::Orientation;
use crate::space::larger;
use crate::{Error, Mask, Real, Scalar, Space};
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// An inertia without an inverse.
const SINGULAR: Error = Error::SingularKineticEnergy { condition: f64::INFINITY };

/// A constant of the user's crate that a closure reads.
#[diagnostic::on_unimplemented(
    message = "a constant that a closure reads is a number, not `{Self}`",
    label = "this is none",
    note = "write `const NAME: f64 = …;`, or read a vector or a matrix from a field, as in `self.center`"
)]
pub trait Constant {
    /// The same number; the nearest one for integers beyond 2⁵³.
    fn to_f64(self) -> f64;
}

/// Implements [`Constant`].
macro_rules! constants {
    ($($number:ty)*) => { $(
        impl Constant for $number {
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
        }
    )* };
}

constants!(f32 f64 i8 i16 i32 i64 isize u8 u16 u32 u64 usize);

/// A constant in the precision of a system.
#[inline(always)]
pub fn constant<T: Scalar>(value: impl Constant) -> T {
    T::from_f64(value.to_f64())
}

/// [`Error::NotFinite`] with the name of the field if a number in it is NaN or infinite.
pub fn check_finite<T: Scalar>(name: &'static str, value: &impl Space<T>) -> Result<(), Error> {
    if value.all_finite() { Ok(()) } else { Err(Error::NotFinite { name }) }
}

/// [`Error::NotFinite`] with the name of the field if a number in it is NaN. A field that bounds alone read may be
/// infinite, for no bound.
pub fn check_limit<T: Scalar>(name: &'static str, value: &impl Space<T>) -> Result<(), Error> {
    if value.all(|x| x.equals(x).all()) { Ok(()) } else { Err(Error::NotFinite { name }) }
}

/// [`Error::NotSymmetric`] if `matrix` differs from its transpose by more than the round-off of computing it, 1024 ε of its largest entry.
pub fn check_symmetric<T: Scalar, const N: usize>(name: &'static str, matrix: &SMatrix<T, N, N>) -> Result<(), Error> {
    (0..T::LANES).try_for_each(|lane| {
        let matrix = matrix.lane(lane);
        let defect = (matrix - matrix.transpose()).max_abs();
        let tolerance = T::Lane::from_f64(1024.0) * T::Lane::EPSILON * matrix.max_abs();
        if defect > tolerance {
            // the difference of the largest numbers is beyond them
            let defect = defect.to_f64().min(f64::MAX);
            return Err(Error::NotSymmetric { field: name, defect, tolerance: tolerance.to_f64() });
        }
        Ok(())
    })
}

/// [`Error::NotDiagonal`] if `matrix` has an entry off its diagonal.
pub fn check_diagonal<T: Scalar, const N: usize>(name: &'static str, matrix: &SMatrix<T, N, N>) -> Result<(), Error> {
    let off_diagonal = SMatrix::<T, N, N>::from_fn(|i, j| if i == j { T::zero() } else { matrix[(i, j)] });
    (0..T::LANES).try_for_each(|lane| match off_diagonal.max_abs().lane(lane) {
        defect if defect > T::Lane::zero() => Err(Error::NotDiagonal { field: name, defect: defect.to_f64() }),
        _ => Ok(()),
    })
}

/// [`Error::NotUnit`] if the length of `vector` differs from one by more than round-off, √ε as for the input of configurations.
pub fn check_unit<T: Scalar, const N: usize>(name: &'static str, vector: &SVector<T, N>) -> Result<(), Error> {
    (0..T::LANES).try_for_each(|lane| {
        let entries: [T::Lane; N] = from_fn(|i| vector[i].lane(lane));
        let length = length(&entries);
        if (length - T::Lane::one()).abs() > T::Lane::EPSILON.sqrt() {
            return Err(Error::NotUnit { field: name, length: length.to_f64() });
        }
        Ok(())
    })
}

/// The inverse of an inertia, such as the Hessian Σ of the kinetic energy.
///
/// [`Error::SingularKineticEnergy`] where Skeel's condition number ‖|Σ⁻¹||Σ|‖_∞ reaches 1/(N ε): the inverse would have no correct digit.
/// That number does not see the scaling of the rows, and is 1 for every diagonal matrix.
pub fn invert<T: Scalar, const N: usize>(matrix: &SMatrix<T, N, N>) -> Result<SMatrix<T, N, N>, Error> {
    let mut inverse = *matrix;
    for lane in 0..T::LANES {
        inverse.set_lane(lane, &invert_one(&matrix.lane(lane))?);
    }
    Ok(inverse)
}

/// Σ⁻¹, and its diagonal where it has nothing else.
#[derive(Clone, Debug)]
pub struct InertiaInverse<T: Scalar, const N: usize> {
    matrix: SMatrix<T, N, N>,
    diagonal: Option<SVector<T, N>>,
}

impl<T: Scalar, const N: usize> InertiaInverse<T, N> {
    /// The inverse of Σ.
    pub fn new(inertia: &SMatrix<T, N, N>) -> Result<Self, Error> {
        let matrix = invert(inertia)?;
        let is_zero = |(k, entry): (usize, &T)| k % (N + 1) == 0 || entry.equals(T::zero()).all();
        let is_diagonal = matrix.iter().enumerate().all(is_zero);
        Ok(Self { matrix, diagonal: is_diagonal.then(|| matrix.diagonal()) })
    }

    /// Σ⁻¹μ.
    #[inline]
    pub fn times(&self, mu: &SVector<T, N>) -> SVector<T, N> {
        self.diagonal.map_or_else(|| self.matrix * mu, |diagonal| diagonal.component_mul(mu))
    }

    /// Σ⁻¹ itself.
    #[inline]
    pub fn matrix(&self) -> &SMatrix<T, N, N> {
        &self.matrix
    }

    /// ½ μ·Σ⁻¹μ.
    pub fn energy(&self, mu: &SVector<T, N>) -> T {
        mu.dot(&self.times(mu)) * T::from_ratio(1, 2)
    }
}

/// 1/κ of the inertia κI.
pub fn invert_uniform<T: Scalar>(kappa: &T) -> Result<T, Error> {
    let inverse = T::one() / *kappa;
    (0..T::LANES).try_for_each(|lane| if inverse.lane(lane).is_finite() { Ok(()) } else { Err(SINGULAR) })?;
    Ok(inverse)
}

/// The sign of det Σ/h.
pub fn orientation_of_inertia<T: Scalar, const N: usize>(sigma: &SMatrix<T, N, N>, h: T) -> Result<Orientation, Error> {
    Orientation::of(rows(&sigma.map(|entry| entry / h))).ok_or(SINGULAR)
}

/// The sign of κⁿ.
pub fn orientation_of_uniform<T: Scalar>(kappa: T, n: usize) -> Result<Orientation, Error> {
    let kappa = if n.is_multiple_of(2) { kappa * kappa } else { kappa };
    Orientation::of([[kappa]]).ok_or(SINGULAR)
}

/// A linear projection of μ, made in units in which the largest component is of ordinary size.
pub fn projection<T: Scalar, const M: usize>(
    mu: &SVector<T, M>,
    project: impl Fn(&SVector<T, M>) -> SVector<T, M>,
) -> SVector<T, M> {
    let unit = power_of_two_near(mu.max_abs());
    project(&mu.map(|entry| entry * unit)).map(|entry| entry / unit)
}

/// The Euclidean distance of μ from its projection.
pub fn distance_of_projection<T: Scalar, const M: usize>(
    mu: &SVector<T, M>,
    project: impl Fn(&SVector<T, M>) -> SVector<T, M>,
) -> T {
    let unit = power_of_two_near(mu.max_abs());
    let scaled = mu.map(|entry| entry * unit);
    let difference = scaled - project(&scaled);
    T::from_lanes(|lane| length(&difference.lane(lane).into())) / unit
}

fn invert_one<T: Real, const N: usize>(matrix: &SMatrix<T, N, N>) -> Result<SMatrix<T, N, N>, Error> {
    let mut inverse = rows(&SMatrix::<T, N, N>::identity());
    let rows = rows(matrix);
    eliminate(rows, &mut inverse).ok_or(SINGULAR)?;
    let mut condition = T::zero();
    for row in &inverse {
        let terms = row.iter().zip(&rows).flat_map(|(&factor, entries)| entries.map(|entry| (factor * entry).abs()));
        let sum = terms.fold(T::zero(), |sum, term| sum + term);
        // Written so that NaN is infinite.
        condition = larger(condition, if sum.is_finite() { sum } else { T::one() / T::zero() });
    }
    if condition * T::EPSILON * T::from_f64(N as f64) >= T::one() {
        return Err(Error::SingularKineticEnergy { condition: condition.to_f64() });
    }
    Ok(SMatrix::from_fn(|i, j| inverse[i][j]))
}

/// The distance of `mu` from the span of `rows`, the momenta that motions of a configuration can have.
pub fn annihilator_defect<T: Scalar, const M: usize, const D: usize>(rows: &[[T; M]; D], mu: &SVector<T, M>) -> T {
    T::from_lanes(|lane| length(&rest(&orthonormal(rows.lane(lane)), &mu.lane(lane))))
}

/// The vector of the span of `rows` that is nearest to `mu`; `mu` itself, to the bit, where it lies there exactly. The
/// projection is made twice: the first leaves round-off of `mu`, not of the result.
pub fn annihilator_projection<T: Scalar, const M: usize, const D: usize>(
    rows: &[[T; M]; D],
    mu: &SVector<T, M>,
) -> SVector<T, M> {
    Space::side_by_side(|lane| {
        let basis = orthonormal(rows.lane(lane));
        let once = |mu: SVector<T::Lane, M>| mu - SVector::from(rest(&basis, &mu));
        once(once(mu.lane(lane)))
    })
}

/// An orthonormal basis of the span of `rows`, zeros for the rows that depend on those before them. Modified
/// Gram–Schmidt, each row made orthogonal twice. A row counts as dependent if less than √ε of it remains.
fn orthonormal<T: Real, const M: usize, const D: usize>(mut basis: [[T; M]; D]) -> [[T; M]; D] {
    for k in 0..D {
        let (before, others) = basis.split_at_mut(k);
        let Some(row) = others.first_mut() else { break };
        let given = length(row);
        before.iter().chain(before.iter()).for_each(|unit| remove(row, unit));
        let left = length(row);
        if left > T::EPSILON.sqrt() * given {
            row.iter_mut().for_each(|entry| *entry /= left);
        } else {
            *row = [T::zero(); M];
        }
    }
    basis
}

/// `mu` without its components along `basis`.
fn rest<T: Real, const M: usize>(basis: &[[T; M]], mu: &SVector<T, M>) -> [T; M] {
    let mut rest: [T; M] = from_fn(|i| mu[i]);
    basis.iter().for_each(|unit| remove(&mut rest, unit));
    rest
}

/// `vector` −= its component along `unit`.
fn remove<T: Real, const M: usize>(vector: &mut [T; M], unit: &[T; M]) {
    let component = vector.iter().zip(unit).fold(T::zero(), |sum, (&a, &b)| sum + a * b);
    vector.iter_mut().zip(unit).for_each(|(a, &b)| *a -= component * b);
}

/// The Euclidean length, scaled so that squares neither overflow nor vanish.
fn length<T: Real, const M: usize>(vector: &[T; M]) -> T {
    let scale = vector.iter().fold(T::zero(), |max, x| larger(max, x.abs()));
    if scale == T::zero() || !scale.is_finite() {
        return scale;
    }
    scale * vector.iter().fold(T::zero(), |sum, &x| sum + (x / scale) * (x / scale)).sqrt()
}

#[cfg(test)]
mod tests;
