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
