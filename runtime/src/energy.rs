//! Kinetic energies of momenta: the Legendre–Fenchel transforms of Lagrangians, quadratic in the velocity and others.

use crate::implicit::{Equation, solve};
use crate::linear::solve_linear;
use crate::{Scalar, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// ½ μ·Σ⁻¹μ.
pub fn kinetic_energy<T: Scalar, const M: usize>(inverse: &SMatrix<T, M, M>, mu: &SVector<T, M>) -> T {
    let velocity = |i: usize| (0..M).fold(T::zero(), |sum, j| sum + inverse[(i, j)] * mu[j]);
    (0..M).fold(T::zero(), |energy, i| energy + mu[i] * velocity(i)) * T::from_ratio(1, 2)
}

/// ½ |μ|²/κ of the inertia κI, given 1/κ.
pub fn kinetic_energy_uniform<T: Scalar, const M: usize>(inverse: &T, mu: &SVector<T, M>) -> T {
    // |μ|² may overflow where the energy does not
    mu.dot(&(mu * *inverse)) * T::from_ratio(1, 2)
}

/// ½ μ·Σ⁻¹μ of an inertia that depends on the configuration; +∞ where Σ is singular, for there μ determines no velocity. 0 for μ = 0,
/// whatever Σ is; else NaN where Σ or μ is not finite.
pub fn kinetic_energy_at<T: Scalar, const M: usize>(inertia: &SMatrix<T, M, M>, mu: &SVector<T, M>) -> T {
    T::from_lanes(|lane| {
        let (inertia, mu) = (inertia.lane(lane), mu.lane(lane));
        let (zero, one) = (T::Lane::zero(), T::Lane::one());
        if mu.iter().all(|x| *x == zero) {
            return zero;
        }
        if !(inertia.all_finite() && mu.all_finite()) {
            return T::Lane::zero() / T::Lane::zero();
        }
        solve_linear(&inertia, &mu).map_or(one / zero, |velocity| dot(&mu, &velocity) * T::Lane::from_ratio(1, 2))
    })
}

/// The equation ∂ℓ/∂ξ(ξ) = μ of a Lagrangian ℓ, at one configuration and time.
pub trait VelocityEquation<T: Scalar, const M: usize> {
    /// ℓ(ξ), its gradient and its Hessian; NaN where ξ is no velocity.
    fn linearize(&self, xi: &SVector<T, M>) -> (T, SVector<T, M>, SMatrix<T, M, M>);
}

/// The Legendre–Fenchel transform of ℓ: μ·ξ − ℓ(ξ) at the velocity ξ with ∂ℓ/∂ξ(ξ) = μ, the largest such value for a convex ℓ. Of several
/// velocities the one is taken that is reached from rest as the momentum grows from ∂ℓ/∂ξ(0) to μ. Newton steps and the bounds on their
/// work are those of [`solve`]. Since ξ is stationary, its error enters the value squared. +∞ where no velocity is found, NaN where μ or the
/// Lagrangian at rest is not finite.
pub fn legendre_fenchel<T: Scalar, const M: usize>(equation: &impl VelocityEquation<T, M>, mu: &SVector<T, M>) -> T {
    T::from_lanes(|lane| {
        let linearize = |xi: &SVector<T::Lane, M>| {
            let (value, gradient, hessian) = equation.linearize(&xi.map(|x| T::from_lanes(|_| x)));
            (value.lane(lane), gradient.lane(lane), hessian.lane(lane))
        };
        let (zero, one) = (T::Lane::zero(), T::Lane::one());
        let mu = mu.lane(lane);
        let (_, at_rest, hessian) = linearize(&SVector::from_element(zero));
        if !(mu.all_finite() && at_rest.all_finite() && hessian.all_finite()) {
            return T::Lane::zero() / T::Lane::zero();
        }
        match solve(&FromRest { linearize: &linearize, at_rest }, &(mu - at_rest)) {
            Ok(xi) => dot(&mu, &xi) - linearize(&xi).0,
            Err(_) => one / zero,
        }
    })
}

fn dot<T: Scalar, const M: usize>(a: &SVector<T, M>, b: &SVector<T, M>) -> T {
    a.iter().zip(b).fold(T::zero(), |sum, (&a, &b)| sum + a * b)
}

/// ρ(ξ; μ − ∂ℓ/∂ξ(0)) = ∂ℓ/∂ξ(ξ) − μ
struct FromRest<'a, T, L, const M: usize> {
    linearize: &'a L,
    at_rest: SVector<T, M>,
}

impl<T: Scalar, L: Fn(&SVector<T, M>) -> (T, SVector<T, M>, SMatrix<T, M, M>), const M: usize> Equation<T, M>
    for FromRest<'_, T, L, M>
{
    type Terms = SVector<T, M>;
    type Jacobian = SMatrix<T, M, M>;

    fn prepare(&self, target: &SVector<T, M>) -> SVector<T, M> {
        *target
    }

    fn linearize(&self, target: &SVector<T, M>, xi: &SVector<T, M>) -> (SVector<T, M>, SMatrix<T, M, M>) {
        let (_, gradient, hessian) = (self.linearize)(xi);
        (gradient - self.at_rest - target, hessian)
    }
}

#[cfg(test)]
mod tests;
