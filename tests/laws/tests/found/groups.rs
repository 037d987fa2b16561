//! Section 2.4: other groups, built in and declared.

use clebsch::Clebsch;
use clebsch_tests::fixtures::fluid_ellipsoid::FluidEllipsoid;
use clebsch_tests::fixtures::heisenberg_geodesic::HeisenbergGeodesic;
use clebsch_tests::fixtures::linear_optics::LinearOptics;
use clebsch_tests::fixtures::lorentz_frame::LorentzFrame;
use clebsch_tests::fixtures::weighted_sl2::WeightedSl2;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::hat;
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix2, Matrix3, Matrix4, SMatrix, SVector, Vector3, Vector4};

use crate::{H, NEAR, assert_conserved, assert_reversible, assert_says, assert_says_nowhere};

/// exp A, by a series of A/2¹⁰.
fn exponential<const N: usize>(a: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let small = a / 1024.0;
    let one = SMatrix::<f64, N, N>::identity();
    let mut power = (1..12).rev().fold(one, |sum, k| one + small * sum / f64::from(k));
    for _ in 0..10 {
        power *= power;
    }
    power
}

/// A matrix near I with determinant 1.
fn unimodular<const N: usize>(random: &mut Random) -> SMatrix<f64, N, N> {
    let a = random.matrix::<N, N>() * 0.4;
    exponential(&(a - SMatrix::identity() * (a.trace() / N as f64)))
}

#[test]
fn fluid_ellipsoid() {
    let random = &mut Random::new(231);
    assert_says::<FluidEllipsoid>(&["from the left", "time-symmetric", "second order", "couples"]);
    assert_says::<FluidEllipsoid>(&["as the Cayley map leaves the group"]);
    assert_says_nowhere::<FluidEllipsoid>(&["half kick"]);
    let fluid = FluidEllipsoid { mass: 0.8 };
    let q = unimodular::<3>(random);
    let stepper = fluid.stepper(H).expect("a fluid");
    // the momentum of a small motion
    let rate = random.matrix::<3, 3>() * 0.5;
    let small = exponential(&((rate - Matrix3::identity() * (rate.trace() / 3.0)) * H));
    let mu = stepper.legendre(&q, &small);
    let start = stepper.state(q, mu).expect("a state");
    let found = stepper.conserved(&start);
    assert_eq!(found.values().len(), 6, "{found}");
    // ⟨N, w⟩ and ⟨N, q w q⁻¹⟩ for w in so(3), up to sign
    let matrix = FluidEllipsoid::momentum_matrix(&mu);
    let inverse = q.try_inverse().expect("a regular matrix");
    for k in 0..3 {
        let w = hat(&Vector3::ith(k, 1.0));
        for expected in [matrix.dot(&w), matrix.dot(&(q * w * inverse))] {
            let near = |value: &f64| (value.abs() - expected.abs()).abs() < NEAR;
            assert!(found.values().iter().any(near), "{expected} in\n{found}");
        }
    }
    let names = *found.names();
    assert_conserved(fluid.clone(), q, mu, names);
    assert_reversible(&fluid, q, mu);
    let mut state = start;
    for _ in 0..200 {
        state = stepper.step(&state).expect("a step");
        assert!((state.configuration().determinant() - 1.0).abs() < NEAR, "the volume stays");
    }
}

#[test]
fn weighted_sl2() {
    let random = &mut Random::new(232);
    assert_says::<WeightedSl2>(&["from the right", "not time-symmetric", "adjoint", "second order"]);
    let system = WeightedSl2 { weight: Matrix2::new(1.0, 0.7, 1.3, 1.6) };
    let q = unimodular::<2>(random);
    let mu = Vector3::new(0.3, 0.4, -0.2);
    let stepper = system.stepper(H).expect("a system");
    let found = stepper.conserved(&stepper.state(q, mu).expect("a state"));
    // Ad*_{q⁻¹} N = qᵀ⁻¹ M qᵀ, in components
    let spatial = q.transpose().try_inverse().expect("regular") * WeightedSl2::momentum_matrix(&mu) * q.transpose();
    assert_near(&Vector3::from(*found.values()), &WeightedSl2::momentum_components(&spatial), NEAR, "Ad*_{q⁻¹} N");
    let names = *found.names();
    assert_conserved(system.clone(), q, mu, names);
    assert_reversible(&system, q, mu);
}

#[test]
fn linear_optics() {
    let random = &mut Random::new(233);
    assert_says::<LinearOptics>(&["from the right", "time-symmetric", "no potential"]);
    let mu: SVector<f64, 10> = random.vector::<10>() * 0.3;
    let q = exponential(&(LinearOptics::momentum_matrix(&(random.vector::<10>() * 0.5))));
    let stepper = LinearOptics.stepper(H).expect("a system");
    let found = stepper.conserved(&stepper.state(q, mu).expect("a state"));
    let spatial = q.transpose().try_inverse().expect("regular") * LinearOptics::momentum_matrix(&mu) * q.transpose();
    for expected in LinearOptics::momentum_components(&spatial).iter() {
        assert!(
            found.values().iter().any(|value| (value - expected).abs() < NEAR),
            "Ad*_{{q⁻¹}} N: {expected} in\n{found}"
        );
    }
    let names = *found.names();
    assert_conserved(LinearOptics, q, mu, names);
    assert_reversible(&LinearOptics, q, mu);
}

#[test]
fn lorentz_frame() {
    let random = &mut Random::new(234);
    assert_says::<LorentzFrame>(&["from the right", "time-symmetric", "half kick, drift, half kick"]);
    let system = LorentzFrame { inertia: 0.9, field: random.vector(), spin: random.vector() };
    // boosts K1 K2 K3, then (23) (24) (34): units in these entries, as the first column comes first
    let basis = |i: usize| LorentzFrame::momentum_matrix(&SVector::<f64, 6>::ith(i, 2.0));
    let places = [(1, 0), (2, 0), (3, 0), (2, 1), (3, 1), (3, 2)];
    for (i, (row, column)) in places.into_iter().enumerate() {
        let sign = if column == 0 { 1.0 } else { -1.0 };
        let mut expected = Matrix4::zeros();
        expected[(row, column)] = 1.0;
        expected[(column, row)] = sign;
        assert_near(&basis(i), &expected, NEAR, "the basis");
    }
    let q = exponential(
        &(random.vector::<6>() * 0.4).iter().enumerate().fold(Matrix4::zeros(), |sum, (i, x)| sum + basis(i) * *x),
    );
    let mu = random.vector::<6>() * 0.3;
    let stepper = system.stepper(H).expect("an indefinite inertia is regular");
    // ½ μ·Σ⁻¹μ with Σ = inertia·diag(−1 −1 −1 1 1 1)
    let energy = stepper.kinetic_energy(&stepper.state(q, mu).expect("a frame"));
    let signs = [-1.0, -1.0, -1.0, 1.0, 1.0, 1.0];
    let expected: f64 = mu.iter().zip(signs).map(|(mu, sign)| sign * mu * mu / (2.0 * 0.9)).sum();
    assert!((energy - expected).abs() < NEAR, "{energy} and {expected}");
    assert_reversible(&system, q, mu);
    let eta = Matrix4::from_diagonal(&Vector4::new(1.0, -1.0, -1.0, -1.0));
    let mut state = stepper.state(q, mu).expect("a frame");
    for _ in 0..100 {
        state = stepper.step(&state).expect("a step");
        let f = state.configuration();
        let size = f.norm_squared();
        assert_near(&(f.transpose() * eta * f / size), &(eta / size), NEAR, "on the Lorentz group");
    }
    // the kick J(q, −h/2 ∂V) = −h/2 ⟨qᵀ field spinᵀ, E_i⟩
    let gradient = q.transpose() * system.field * system.spin.transpose() * (-H / 2.0);
    let expected = SVector::<f64, 6>::from_fn(|i, _| gradient.dot(&basis(i)));
    assert_near(
        &system.impulse(&system.step_constants(H).expect("a frame"), 0.0, &q, &nalgebra::zero()),
        &expected,
        NEAR,
        "the kick",
    );
    assert!(stepper.state(q * 1.01, mu).is_err(), "off the group");
}

#[test]
fn heisenberg_geodesic() {
    let random = &mut Random::new(235);
    assert_says::<HeisenbergGeodesic>(&["from the right", "time-symmetric"]);
    let system = HeisenbergGeodesic { mass: Vector3::new(1.0, 1.4, 0.8) };
    let q = Matrix3::new(1.0, 0.4, -0.3, 0.0, 1.0, 0.6, 0.0, 0.0, 1.0);
    let mu = random.vector::<3>();
    let stepper = system.stepper(H).expect("a particle");
    let found = stepper.conserved(&stepper.state(q, mu).expect("a state"));
    // Ad*_{q⁻¹} N: p_x + y p_z, p_y − x p_z, p_z for q = (1 x z; 0 1 y; 0 0 1)
    for expected in [mu.x + 0.6 * mu.z, mu.y - 0.4 * mu.z, mu.z] {
        let near = |value: &f64| (value - expected).abs() < NEAR;
        assert!(found.values().iter().any(near), "{expected} in\n{found}");
    }
    let names = *found.names();
    assert_conserved(system.clone(), q, mu, names);
    assert_reversible(&system, q, mu);
}
