//! Spaces on which a group acts transitively, with kinetic energies of the velocity of the point alone.

use clebsch::{Clebsch, Conserved, Conserves, Error};
use clebsch_tests::fixtures::covariance_geodesic::CovarianceGeodesic;
use clebsch_tests::oracle::motion::{assert_second_order, errors_of_halved_steps as errors, motion};
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix2, SMatrix, SVector, Vector2, Vector4};

/// Conserved momenta change by rounding over 1000 steps, and so does the vertical momentum.
fn assert_conserves<S, const K: usize>(system: &S, (q, mu): (S::Configuration, S::Momentum), h: f64)
where
    S: Clebsch<Scalar = f64, Time = ()> + Conserves<Conserved = Conserved<f64, K>> + Clone,
{
    let stepper = system.stepper(h).expect("a regular system");
    let start = stepper.state(q, mu).expect("a state");
    let end = stepper.advance(&start, 1000).expect("steps");
    let (before, after) = (stepper.conserved(&start), stepper.conserved(&end));
    let size = before.values().iter().fold(1.0_f64, |size, value| size.max(value.abs()));
    for (name, (before, after)) in before.names().iter().zip(before.values().iter().zip(after.values())) {
        assert!((before - after).abs() < 1e-12 * size, "{} {name}: {before} to {after}", S::NAME);
    }
    let off = system.isotropy_defect(end.configuration(), &end.momentum());
    println!("{}: {:?}, along the isotropy {off:.1e}", S::NAME, before.names());
    assert!(off < 1e-11 * size, "{}: {off:e} along the isotropy", S::NAME);
}

fn symmetric<const N: usize>(random: &mut Random) -> SMatrix<f64, N, N> {
    let any = random.matrix::<N, N>();
    (any + any.transpose()) * 0.5
}

/// A symmetric positive definite matrix.
fn positive<const N: usize>(random: &mut Random) -> SMatrix<f64, N, N> {
    exponential(&symmetric(random))
}

fn exponential<const N: usize>(a: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let result = Matrix::from(a).exponential();
    SMatrix::from_fn(|i, j| result[(i, j)])
}

fn inverse<const N: usize>(p: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let result = Matrix::from(p).inverse();
    SMatrix::from_fn(|i, j| result[(i, j)])
}

/// P^½ exp(P^−½ Ṗ P^−½) P^½ = exp(Ṗ P⁻¹) P, where the geodesic of the affine-invariant metric is at t = 1.
fn geodesic<const N: usize>(p: &SMatrix<f64, N, N>, velocity: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    exponential(&(velocity * inverse(p))) * p
}

/// The momentum of ½ tr(P⁻¹ Ṗ P⁻¹ Ṗ): the covector is P⁻¹ Ṗ P⁻¹.
fn covector<const N: usize>(p: &SMatrix<f64, N, N>, velocity: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    inverse(p) * velocity * inverse(p)
}

/// The same in the exponential chart, in which steps of an invariant Lagrangian are exact.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: GL<2>, P: Symmetric<Matrix2>| F * P * F.transpose(),
    lagrangian     = |P, xi| {
        let velocity = xi.matrix() * P + P * xi.matrix().transpose();
        (P.inverse() * velocity * P.inverse() * velocity).trace() / 2
    },
    discretization = exponential,
    scalar         = f64,
)]
struct ExactGeodesic;

/// The same by a divergence of P and P⁺, with a potential.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: GL<3>, P: Symmetric<Matrix3>| F * P * F.transpose(),
    cost      = |h, P, F| {
        let next = F * P * F.transpose();
        ((P.inverse() * next).trace() + (next.inverse() * P).trace() - 6) / (2 * h)
    },
    potential = |P| self.pull * P.trace(),
)]
struct Divergence {
    pull: f64,
}

#[test]
fn covariances_move_along_geodesics() {
    let random = &mut Random::new(51);
    let (p, velocity) = (positive::<2>(random), symmetric::<2>(random));
    let exact = geodesic(&p, &velocity);
    let start = (p, CovarianceGeodesic.momentum_map(&p, &covector(&p, &velocity)));
    let distance = |end: &Matrix2<f64>| (end - exact).norm();
    assert_second_order("SPD(2)", &errors(&CovarianceGeodesic, start, distance));
    for error in errors(&ExactGeodesic, start, distance) {
        assert!(error < 1e-12, "{error:e}");
    }
    assert_conserves(&CovarianceGeodesic, start, 2e-3);
    assert_conserves(&ExactGeodesic, start, 2e-3);
}

/// P̈ = Ṗ P⁻¹ Ṗ − k P².
#[test]
fn covariances_of_three_variables_move_in_a_potential() {
    let random = &mut Random::new(52);
    let (p, velocity) = (positive::<3>(random), symmetric::<3>(random));
    let pull = 0.7;
    let field = move |y: &SVector<f64, 18>| {
        let part = |from: usize| SMatrix::<f64, 3, 3>::from_fn(|i, j| y[from + 3 * i + j]);
        let (p, v) = (part(0), part(9));
        let slope = v * inverse(&p) * v - p * p * pull;
        SVector::from_fn(|k, _| if k < 9 { v[(k / 3, k % 3)] } else { slope[(k % 9 / 3, k % 3)] })
    };
    let start = SVector::from_fn(|k, _| if k < 9 { p[(k / 3, k % 3)] } else { velocity[(k % 9 / 3, k % 3)] });
    let end = motion(field, start, 1.0, 200);
    let exact = SMatrix::<f64, 3, 3>::from_fn(|i, j| end[3 * i + j]);
    let system = Divergence { pull };
    let start = (p, system.momentum_map(&p, &covector(&p, &velocity)));
    assert_second_order("SPD(3)", &errors(&system, start, |end| (end - exact).norm()));
    assert_conserves(&system, start, 1e-3);
}

/// A matrix that is not symmetric is no point of the space, whatever its size.
#[test]
fn states_are_symmetric() {
    let stepper = CovarianceGeodesic.stepper(0.1).expect("a regular system");
    for scale in [1e-100, 1.0, 1e100] {
        let off = Matrix2::new(2.0, 0.5, 0.5 + 1e-6, 1.0) * scale;
        let error = stepper.state(off, Vector4::zeros()).expect_err("not symmetric");
        assert!(matches!(error, Error::OffOrbit { .. }), "{error}");
        let near = Matrix2::new(2.0, 0.5, 0.5 + 1e-12, 1.0) * scale;
        let state = stepper.step(&stepper.state(near, Vector4::zeros()).expect("symmetric")).expect("a step");
        assert_eq!(state.configuration().transpose(), *state.configuration());
    }
}

/// The plane without its origin, as the orbit of a vector under matrices of determinant 1. The isotropy is not compact.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SL<2>, q: Vector2| F * q,
    cost      = |h, q, F| self.mass * (F * q - q).norm_squared() / (2 * h),
    potential = |q| self.stiffness * q.norm_squared() / 2,
)]
struct Plane {
    mass: f64,
    stiffness: f64,
}

/// The same under all regular matrices: the isotropy of a vector has two dimensions.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: GL<2>, q: Vector2| F * q,
    cost      = |h, q, F| self.mass * (F * q - q).norm_squared() / (2 * h),
    potential = |q| self.stiffness * q.norm_squared() / 2,
)]
struct LinearPlane {
    mass: f64,
    stiffness: f64,
}

/// The motion of the plane does not know the group that moves it: q⁺ − 2q + q⁻ = −h² k q/m.
#[test]
fn oscillators_do_not_know_their_group() {
    let (mass, stiffness, h) = (0.8, 1.7, 0.05);
    let (q, v) = (Vector2::new(0.6, 0.8), Vector2::new(-0.9, 0.4));
    let mut expected = [q, q + (v - q * (h * stiffness / (2.0 * mass))) * h];
    for _ in 0..40 {
        let [before, now] = expected;
        expected = [now, now * 2.0 - before - now * (h * h * stiffness / mass)];
    }
    let special = Plane { mass, stiffness };
    let general = LinearPlane { mass, stiffness };
    let stepper = special.stepper(h).expect("a regular system");
    let start = (q, special.momentum_map(&q, &(v * mass)));
    let end = stepper.advance(&stepper.state(start.0, start.1).expect("a state"), 41).expect("steps");
    assert!((end.configuration() - expected[1]).norm() < 1e-12, "{} not {}", end.configuration(), expected[1]);
    assert_conserves(&special, start, h);
    let stepper = general.stepper(h).expect("a regular system");
    let start = (q, general.momentum_map(&q, &(v * mass)));
    let end = stepper.advance(&stepper.state(start.0, start.1).expect("a state"), 41).expect("steps");
    assert!((end.configuration() - expected[1]).norm() < 1e-12, "{} not {}", end.configuration(), expected[1]);
    assert_conserves(&general, start, h);
}

#[test]
fn derivations_say_what_was_added() {
    for text in [CovarianceGeodesic::DERIVATION, Divergence::DERIVATION, Plane::DERIVATION, LinearPlane::DERIVATION] {
        assert!(text.contains("vertical term"), "{text}");
    }
}
