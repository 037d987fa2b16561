//! Kinetic energies of momenta: the Legendre–Fenchel transforms of Lagrangians, quadratic in the velocity and others.

use crate::implicit::{Equation, solve};
use crate::linear::solve_linear;
use crate::space::lane_of;
use crate::{Real, Scalar, Space};
use core::marker::PhantomData;
use nalgebra::{SMatrix, SVector};

/// ½ μ·Σ⁻¹μ.
pub fn kinetic_energy<T: Scalar, const M: usize>(inverse: &SMatrix<T, M, M>, mu: &SVector<T, M>) -> T {
    let mut energy = T::zero();
    for i in 0..M {
        let velocity = (0..M).fold(T::zero(), |sum, j| sum + inverse[(i, j)] * mu[j]);
        energy += mu[i] * velocity;
    }
    energy * T::from_ratio(1, 2)
}

/// ½ |μ|²/κ of the inertia κI, given 1/κ.
pub fn kinetic_energy_uniform<T: Scalar, const M: usize>(inverse: &T, mu: &SVector<T, M>) -> T {
    // |μ|² may overflow where the energy does not
    mu.dot(&(mu * *inverse)) * T::from_ratio(1, 2)
}

/// ½ μ·Σ⁻¹μ of an inertia that depends on the configuration; +∞ where Σ is singular, for there μ determines no velocity.
///
/// 0 for μ = 0, whatever Σ is; else NaN where Σ or μ is not finite.
pub fn kinetic_energy_at<T: Scalar, const M: usize>(inertia: &SMatrix<T, M, M>, mu: &SVector<T, M>) -> T {
    T::from_lanes(|lane| kinetic_energy_of_one(&lane_of(inertia, lane), &lane_of(mu, lane)))
}

fn kinetic_energy_of_one<T: Real, const M: usize>(inertia: &SMatrix<T, M, M>, mu: &SVector<T, M>) -> T {
    if mu.iter().all(|x| *x == T::zero()) {
        return T::zero();
    }
    if !(inertia.is_finite() && mu.is_finite()) {
        return T::zero() / T::zero();
    }
    match solve_linear(inertia, mu) {
        Some(velocity) => dot(mu, &velocity) * T::from_ratio(1, 2),
        None => T::one() / T::zero(),
    }
}

/// The equation ∂ℓ/∂ξ(ξ) = μ of a Lagrangian ℓ, at one configuration and time.
pub trait VelocityEquation<T: Scalar, const M: usize> {
    /// ℓ(ξ), its gradient and its Hessian; NaN where ξ is no velocity.
    fn linearize(&self, xi: &SVector<T, M>) -> (T, SVector<T, M>, SMatrix<T, M, M>);
}

/// The Legendre–Fenchel transform of ℓ: μ·ξ − ℓ(ξ) at the velocity ξ with ∂ℓ/∂ξ(ξ) = μ, the largest such value for a convex ℓ.
///
/// Of several velocities the one is taken that is reached from rest as the momentum grows from ∂ℓ/∂ξ(0) to μ; the Newton steps and
/// the bounds on their work are those of [`solve`]. Since ξ is stationary, its error enters the value squared.
///
/// +∞ where no velocity is found, NaN where μ or the Lagrangian at rest is not finite.
pub fn legendre_fenchel<T: Scalar, const M: usize>(equation: &impl VelocityEquation<T, M>, mu: &SVector<T, M>) -> T {
    T::from_lanes(|lane| transform_of_one(&InLane { equation, lane, scalar: PhantomData }, &lane_of(mu, lane)))
}

/// The equation in one lane.
struct InLane<'a, T, E> {
    equation: &'a E,
    lane: usize,
    scalar: PhantomData<T>,
}

impl<T: Scalar, E: VelocityEquation<T, M>, const M: usize> VelocityEquation<T::Lane, M> for InLane<'_, T, E> {
    fn linearize(&self, xi: &SVector<T::Lane, M>) -> (T::Lane, SVector<T::Lane, M>, SMatrix<T::Lane, M, M>) {
        let (value, gradient, hessian) = self.equation.linearize(&xi.map(|x| T::from_lanes(|_| x)));
        (value.lane(self.lane), lane_of(&gradient, self.lane), lane_of(&hessian, self.lane))
    }
}

fn transform_of_one<T: Real, const M: usize>(equation: &impl VelocityEquation<T, M>, mu: &SVector<T, M>) -> T {
    let (_, at_rest, hessian) = equation.linearize(&SVector::from_element(T::zero()));
    if !(mu.is_finite() && at_rest.is_finite() && hessian.is_finite()) {
        return T::zero() / T::zero();
    }
    match solve(&FromRest { equation, at_rest }, &(mu - at_rest)) {
        Ok(xi) => dot(mu, &xi) - equation.linearize(&xi).0,
        Err(_) => T::one() / T::zero(),
    }
}

fn dot<T: Scalar, const M: usize>(a: &SVector<T, M>, b: &SVector<T, M>) -> T {
    a.iter().zip(b).fold(T::zero(), |sum, (&a, &b)| sum + a * b)
}

/// ρ(ξ; μ − ∂ℓ/∂ξ(0)) = ∂ℓ/∂ξ(ξ) − μ
struct FromRest<'a, T: Scalar, E: VelocityEquation<T, M>, const M: usize> {
    equation: &'a E,
    at_rest: SVector<T, M>,
}

impl<T: Scalar, E: VelocityEquation<T, M>, const M: usize> Equation<T, M> for FromRest<'_, T, E, M> {
    type Terms = SVector<T, M>;
    type Jacobian = SMatrix<T, M, M>;

    fn prepare(&self, target: &SVector<T, M>) -> SVector<T, M> {
        *target
    }

    fn linearize(&self, target: &SVector<T, M>, xi: &SVector<T, M>) -> (SVector<T, M>, SMatrix<T, M, M>) {
        let (_, gradient, hessian) = self.equation.linearize(xi);
        (gradient - self.at_rest - target, hessian)
    }
}

#[cfg(test)]
mod tests {
    use super::{VelocityEquation, kinetic_energy, kinetic_energy_at, legendre_fenchel};
    use crate::Scalar;
    use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

    #[test]
    fn quadratic_energies() {
        assert_eq!(kinetic_energy(&Matrix2::new(1.0, 0.5, 0.5, 2.0), &Vector2::new(2.0, 4.0)), 22.0);
    }

    /// The inertia is that of a disc seen from its centre, then of a rod, which has no momentum about itself.
    #[test]
    fn momenta_that_an_inertia_lacks_have_infinite_energy() {
        let momentum = Vector3::new(2.0, 0.0, 4.0);
        assert_eq!(kinetic_energy_at(&Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 2.0)), &momentum), 6.0);
        let rod = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0));
        assert_eq!(kinetic_energy_at(&rod, &momentum), f64::INFINITY);
        assert_eq!(kinetic_energy_at(&rod, &Vector3::zeros()), 0.0);
        assert!(kinetic_energy_at(&rod, &Vector3::new(f64::NAN, 0.0, 0.0)).is_nan());
        assert!(kinetic_energy_at(&(rod * f64::NAN), &momentum).is_nan());
    }

    /// ℓ = f(|ξ|²/2) + b·ξ, from f, f′, f″.
    struct Isotropic<F: Fn(f64) -> [f64; 3]>(F, Vector2<f64>);

    impl<F: Fn(f64) -> [f64; 3]> VelocityEquation<f64, 2> for Isotropic<F> {
        fn linearize(&self, xi: &Vector2<f64>) -> (f64, Vector2<f64>, Matrix2<f64>) {
            let [value, first, second] = (self.0)(xi.norm_squared() / 2.0);
            (value + self.1.dot(xi), xi * first + self.1, Matrix2::identity() * first + xi * xi.transpose() * second)
        }
    }

    fn energy(lagrangian: impl Fn(f64) -> [f64; 3], mu: Vector2<f64>) -> f64 {
        legendre_fenchel(&Isotropic(lagrangian, Vector2::zeros()), &mu)
    }

    /// ℓ = 1 − √(1 − |v|²) has the energy √(1 + |p|²) − 1, from rest to a Lorentz factor of a million.
    #[test]
    fn relativistic_particles_have_their_energy() {
        let lagrangian = |t: f64| {
            let root = Scalar::sqrt(1.0 - 2.0 * t);
            [2.0 * t / (1.0 + root), 1.0 / root, 1.0 / (root * root * root)]
        };
        for size in (-40..=if cfg!(miri) { 10 } else { 60 })
            .step_by(if cfg!(miri) { 50 } else { 1 })
            .map(|tenths| Scalar::powf(10.0, f64::from(tenths) / 10.0))
        {
            let momentum = Vector2::new(0.6, -0.8) * size;
            let exact = size * size / (1.0 + Scalar::sqrt(1.0 + size * size));
            let found = energy(lagrangian, momentum);
            assert!((found - exact).abs() <= 1e-13 * (size + exact), "{size}: {found} is not {exact}");
        }
    }

    /// ℓ = |ξ|²/2 + |ξ|⁴/4, |μ| = r + r³, and a term b·ξ that shifts the momentum and no energy.
    #[test]
    fn stiffening_lagrangians_and_those_linear_in_part() {
        let lagrangian = |t: f64| [t + t * t, 1.0 + 2.0 * t, 2.0];
        for r in [1e-8, 0.1, 1.0, 30.0, 1e5].into_iter().take(if cfg!(miri) { 3 } else { 5 }) {
            let mu = Vector2::new(0.28, 0.96) * (r + r * r * r);
            let exact = r * r / 2.0 + 0.75 * r * r * r * r;
            let shift = Vector2::new(0.5, -0.25);
            let shifted = legendre_fenchel(&Isotropic(lagrangian, shift), &(mu + shift));
            assert!((energy(lagrangian, mu) / exact - 1.0).abs() < 1e-14);
            assert!((shifted - exact).abs() < 1e-14 * (1.0 + exact));
        }
    }

    /// √(1 + |ξ|²) has no momentum beyond 1, and |ξ|²/2 − |ξ|⁴/4 none beyond 2/√27, where the momentum turns back.
    #[test]
    fn momenta_without_a_velocity_have_infinite_energy() {
        let saturating = |t: f64| {
            let root = Scalar::sqrt(1.0 + 2.0 * t);
            [root - 1.0, 1.0 / root, -1.0 / (root * root * root)]
        };
        assert!((energy(saturating, Vector2::new(0.6, 0.0)) - 0.2).abs() < 1e-15);
        assert_eq!(energy(saturating, Vector2::new(1.2, 0.0)), f64::INFINITY);
        let softening = |t: f64| [t - t * t, 1.0 - 2.0 * t, -2.0];
        assert!((energy(softening, Vector2::new(0.0, 0.375)) - 0.078_125).abs() < 1e-15);
        assert_eq!(energy(softening, Vector2::new(0.0, 0.4)), f64::INFINITY);
    }

    #[test]
    fn what_is_not_finite_stays_so() {
        let lagrangian = |t: f64| [t, 1.0, 0.0];
        assert!(energy(lagrangian, Vector2::new(f64::NAN, 0.0)).is_nan());
        assert!(energy(|_| [f64::NAN; 3], Vector2::new(1.0, 0.0)).is_nan());
    }
}
