//! Dρ(ξ) as the solvers take it: a matrix, or a linear map that is inverted by its structure.

use crate::linear::{Solution, eliminated, rows, solve_dense};
use crate::orientation::Orientation;
use crate::{Real, Scalar, Space};
use nalgebra::{SMatrix, SVector};

/// The Jacobian of an implicit equation for M unknowns.
///
/// ```
/// use clebsch::implicit::Jacobian;
/// use nalgebra::{Matrix2, Vector2};
///
/// let slope = Matrix2::new(2.0, 0.0, 0.0, 4.0);
/// let (correction, _) = Jacobian::solve(&slope, &Vector2::new(2.0, 2.0)).unwrap();
/// assert_eq!(correction, Vector2::new(1.0, 0.5));
/// ```
pub trait Jacobian<T: Scalar, const M: usize>: Copy {
    /// The same of single numbers.
    type Lane: Jacobian<T::Lane, M>;

    /// Its value in one lane.
    fn lane(&self, lane: usize) -> Self::Lane;

    /// Δ with Dρ Δ = `residual` and the sign of det Dρ; `None` where it is singular in all lanes.
    fn solve(&self, residual: &SVector<T, M>) -> Solution<T, M>;

    /// The sign of det Dρ; `None` where it is singular or not finite in some lane.
    fn orientation(&self) -> Option<Orientation>;

    /// The same as [`solve`](Self::solve) with another column j in place of its own; by elimination where this is a matrix.
    fn solve_exchanged(&self, exchanged: Option<(usize, &SVector<T, M>)>, right: &SVector<T, M>) -> Solution<T, M>
    where
        T: Real;

    /// Column j: the derivative with respect to unknown j.
    fn column(&self, j: usize) -> SVector<T, M>;

    /// Σ |Dρ_ij| |x_j|, the size of the terms of Dρ x, or somewhat more.
    fn size_of_terms(&self, x: &SVector<T, M>) -> T;

    /// The largest |Dρ_ij|, or somewhat more.
    fn largest_entry(&self) -> T;

    /// Whether all of it is finite.
    fn all_finite(&self) -> bool;

    /// (1 − s) Dρ + s Dρ′.
    fn between(&self, other: &Self, s: T) -> Self;
}

impl<T: Scalar, const M: usize> Jacobian<T, M> for SMatrix<T, M, M> {
    type Lane = SMatrix<T::Lane, M, M>;

    #[inline]
    fn lane(&self, lane: usize) -> Self::Lane {
        Space::lane(self, lane)
    }

    #[inline(always)]
    fn solve(&self, residual: &SVector<T, M>) -> Solution<T, M> {
        solve_dense(self, residual)
    }

    #[inline]
    fn orientation(&self) -> Option<Orientation> {
        Orientation::of(rows(self))
    }

    fn solve_exchanged(&self, exchanged: Option<(usize, &SVector<T, M>)>, right: &SVector<T, M>) -> Solution<T, M>
    where
        T: Real,
    {
        let mut matrix = rows(self);
        if let Some((j, column)) = exchanged {
            let entries = matrix.iter_mut().filter_map(|row| row.get_mut(j));
            entries.zip(column).for_each(|(entry, &other)| *entry = other);
        }
        eliminated(matrix, right)
    }

    #[inline]
    fn column(&self, j: usize) -> SVector<T, M> {
        SVector::from_fn(|i, _| self.get((i, j)).copied().unwrap_or_else(T::zero))
    }

    fn size_of_terms(&self, x: &SVector<T, M>) -> T {
        let length = |column: &[T; M]| column.iter().fold(T::zero(), |sum, entry| sum + entry.abs());
        let columns = self.data.0.iter().zip(x.iter());
        columns.fold(T::zero(), |sum, (column, x)| sum + length(column) * x.abs())
    }

    #[inline]
    fn largest_entry(&self) -> T {
        Space::max_abs(self)
    }

    #[inline]
    fn all_finite(&self) -> bool {
        Space::<T>::all_finite(self)
    }

    #[inline]
    fn between(&self, other: &Self, s: T) -> Self {
        self + (other - self) * s
    }
}
