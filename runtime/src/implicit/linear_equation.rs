//! Implicit equations that are affine in the unknowns: one elimination solves them.

use super::{Equation, lane};
use crate::linear::{Solution, solve_dense};
use crate::orientation::Orientation;
use crate::{Error, Mask, Scalar, Space};
use nalgebra::{SMatrix, SVector};

/// An implicit equation ρ(ξ; μ) = A(μ) ξ − b(μ) = 0 for M unknowns ξ, given N components of momentum, the target μ.
///
/// A and b are affine in μ, or det A does not depend on μ; and b(0) = 0. Wanted is the solution on the branch of ξ = 0, which ends where det A changes its sign.
///
/// ```
/// use clebsch::implicit::{LinearEquation, solve_linear_equation};
/// use nalgebra::{Matrix1, Vector1};
///
/// /// (2 + μ) ξ = μ
/// struct Affine;
///
/// impl LinearEquation<f64, 1> for Affine {
///     fn system(&self, target: &Vector1<f64>) -> (Matrix1<f64>, Vector1<f64>) {
///         (Matrix1::new(2.0 + target.x), *target)
///     }
/// }
///
/// assert_eq!(solve_linear_equation(&Affine, &Vector1::new(2.0))?.x, 0.5);
/// # Ok::<(), clebsch::Error>(())
/// ```
pub trait LinearEquation<T: Scalar, const M: usize, const N: usize = M> {
    /// A and b for the target μ.
    fn system(&self, target: &SVector<T, N>) -> (SMatrix<T, M, M>, SVector<T, M>);

    /// ξ with A ξ = b, and the sign of det A; `None` where it is singular in all lanes. See [`Equation::correct`].
    #[inline]
    fn correct(a: &SMatrix<T, M, M>, b: &SVector<T, M>) -> Solution<T, M> {
        solve_dense(a, b)
    }

    /// The sign of det A on the branch, that for μ = 0; `None` where it is singular. See [`Equation::orientation`].
    #[inline]
    fn orientation(&self) -> Option<Orientation> {
        let (a, b) = self.system(&SVector::from_element(T::zero()));
        Self::correct(&a, &b).map(|(_, orientation)| orientation)
    }
}

/// The solution ξ of A(μ) ξ = b(μ) that is connected to ξ = 0 for μ = 0. Lanes without a solution are NaN.
///
/// Work: one elimination, and where it does not decide at most [`LINEARIZATIONS`](super::LINEARIZATIONS) more.
///
/// # Errors
/// Those of [`solve`](super::solve).
#[inline]
pub fn solve_linear_equation<T: Scalar, E: LinearEquation<T, M, N>, const M: usize, const N: usize>(
    equation: &E,
    target: &SVector<T, N>,
) -> Result<SVector<T, M>, Error> {
    let (a, b) = equation.system(target);
    let (xi, solved) = match (E::correct(&a, &b), equation.orientation()) {
        (Some((xi, orientation)), Some(branch)) => (xi, orientation.agrees::<T>(branch) & xi.finite()),
        _ => (b, T::Mask::nowhere()),
    };
    if solved.all() {
        return Ok(xi);
    }
    // a copy on the cold path only
    let reached = xi;
    lane::follow(&Iterated(equation), target, &reached, solved, 1)
}

/// The same equation for the solver that follows the path from the identity.
struct Iterated<'a, E>(&'a E);

impl<T: Scalar, E: LinearEquation<T, M, N>, const M: usize, const N: usize> Equation<T, M, N> for Iterated<'_, E> {
    type Terms = (SMatrix<T, M, M>, SVector<T, M>);
    type Jacobian = SMatrix<T, M, M>;

    fn prepare(&self, target: &SVector<T, N>) -> Self::Terms {
        self.0.system(target)
    }

    fn linearize(&self, (a, b): &Self::Terms, xi: &SVector<T, M>) -> (SVector<T, M>, SMatrix<T, M, M>) {
        (a * xi - b, *a)
    }

    fn orientation(&self) -> Option<Orientation> {
        self.0.orientation()
    }
}

#[cfg(test)]
mod tests;
