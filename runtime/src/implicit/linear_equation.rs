//! Implicit equations that are affine in the unknowns: one elimination solves them.

use super::{Equation, lane};
use crate::linear::solve_dense;
use crate::orientation::Orientation;
use crate::{Error, Mask, Scalar, Space};
use nalgebra::{SMatrix, SVector};

/// An implicit equation ρ(ξ; μ) = A(μ) ξ − b(μ) = 0 for M unknowns ξ, given N components of momentum, the target μ.
///
/// A and b are affine in μ, or det A does not depend on μ; and b(0) = 0. Wanted is the solution that is connected to ξ = 0 for μ = 0, which ends where det A
/// changes its sign.
pub trait LinearEquation<T: Scalar, const M: usize, const N: usize = M> {
    /// A and b for the target μ.
    fn system(&self, target: &SVector<T, N>) -> (SMatrix<T, M, M>, SVector<T, M>);

    /// ξ with A ξ = b, and the sign of det A; `None` where it is singular in all lanes. See [`Equation::correct`].
    #[inline]
    fn correct(a: &SMatrix<T, M, M>, b: &SVector<T, M>) -> Option<(SVector<T, M>, Orientation)> {
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
mod tests {
    use super::{LinearEquation, solve_linear_equation};
    use crate::Error;
    use nalgebra::{Matrix1, Matrix2, Vector1, Vector2, Vector3};

    /// (1 − μ) ξ = μ
    struct Growing;

    impl LinearEquation<f64, 1> for Growing {
        fn system(&self, target: &Vector1<f64>) -> (Matrix1<f64>, Vector1<f64>) {
            (Matrix1::new(1.0 - target.x), *target)
        }
    }

    /// A charge in the plane: m ξ + μ₃ Jξ = (μ₁, μ₂), solvable for every μ.
    struct Turning(f64);

    impl LinearEquation<f64, 2, 3> for Turning {
        fn system(&self, target: &Vector3<f64>) -> (Matrix2<f64>, Vector2<f64>) {
            (Matrix2::new(self.0, target.z, -target.z, self.0), target.xy())
        }
    }

    #[test]
    fn one_elimination_solves() {
        assert_eq!(solve_linear_equation(&Growing, &Vector1::new(0.75)), Ok(Vector1::new(3.0)));
        let target = Vector3::new(1.0, -3.0, 2.0);
        // (m ξ₁ + 2ξ₂, m ξ₂ − 2ξ₁) = (1, −3) with m = 4, by Cramer's rule
        assert_eq!(solve_linear_equation(&Turning(4.0), &target), Ok(Vector2::new(10.0 / 20.0, -10.0 / 20.0)));
    }

    /// For μ > 1 there is a solution, but it has come from infinity.
    #[test]
    fn solutions_beyond_infinity_are_none() {
        let Err(Error::Unsolvable { solvable_fraction, .. }) = solve_linear_equation(&Growing, &Vector1::new(4.0))
        else {
            panic!("the branch ends at μ = 1");
        };
        assert!((solvable_fraction - 0.25).abs() < 1e-3, "{solvable_fraction}");
    }

    #[test]
    fn what_is_broken_is_named() {
        let broken = solve_linear_equation(&Growing, &Vector1::new(f64::NAN));
        assert_eq!(broken, Err(Error::NotFinite { name: "the momentum" }));
        assert!(solve_linear_equation(&Turning(0.0), &Vector3::new(1.0, 1.0, 1.0)).is_err());
    }
}
