//! Section 2.4: other groups, built in and declared.

use clebsch::{Clebsch, Error};
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

/// Runs on each group that is not compact.
const CASES: usize = if cfg!(feature = "heavy") { 3000 } else { 16 };

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

/// Geodesics of SL(2) in a potential that grows with q.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SL<2>, q: SL<2>| q * F,
    cost      = |h, F| (F - I).norm_squared() / (2 * h),
    potential = |q| self.stiffness * q.norm_squared(),
)]
struct Shear {
    stiffness: f64,
}

/// Geodesics of SO(2, 1), whose group is built in.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(action = |F: SO<2, 1>, q: SO<2, 1>| F * q, cost = |h, F| (F - I).norm_squared() / (2 * h))]
struct Boosts;

/// A number of any size.
fn hostile(random: &mut Random) -> f64 {
    match (random.between(0.0, 10.0)) as u32 {
        0 => 0.0,
        1 => -0.0,
        2 => random.number() * 10_f64.powf(random.number() * 300.0),
        3..=5 => random.number() * 10_f64.powf(random.number() * 8.0),
        _ => random.number() * 10_f64.powf(random.number() * 3.0),
    }
}

/// Steps with numbers of any size. The state after each is on its group, relative to the size of its terms, and `state`
/// takes it as a start. Gives the number of steps, and of those that are refused as off their group.
fn stay_on_their_group<S, const N: usize, const M: usize>(
    make: impl Fn(&mut Random) -> S,
    relative: impl Fn(&SMatrix<f64, N, N>) -> f64,
) -> [usize; 2]
where
    S: Clebsch<Scalar = f64, Configuration = SMatrix<f64, N, N>, Momentum = SVector<f64, M>>,
{
    let random = &mut Random::new(261);
    let [mut made, mut refused] = [0; 2];
    for case in 0..CASES {
        let h = if case % 2 == 0 { 0.05 } else { hostile(random) };
        let Ok(stepper) = make(random).into_stepper(h) else { continue };
        let mu = SVector::from_fn(|_, _| hostile(random));
        let Ok(start) = stepper.state(SMatrix::identity(), mu) else { continue };
        for state in stepper.trajectory(start).take(7) {
            match state {
                Ok(state) => {
                    let off = relative(state.configuration());
                    assert!(off < 1e-7, "{}, case {case}: {off:e} off, {state:?}", S::NAME);
                    let again = stepper.state(*state.configuration(), state.momentum());
                    assert!(again.is_ok(), "{}, case {case}: {again:?}", S::NAME);
                    made += 1;
                }
                Err(Error::OffOrbit { defect, tolerance }) => {
                    assert!(defect > tolerance && defect.is_finite(), "{defect} and {tolerance}");
                    refused += 1;
                }
                Err(_) => {}
            }
        }
    }
    println!("{}: {made} states, {refused} steps refused as off their group", S::NAME);
    assert!(made > CASES, "{}: {made} states", S::NAME);
    [made, refused]
}

/// |FᵀηF − η| relative to |F|².
fn off_form<const N: usize>(eta: &SMatrix<f64, N, N>, f: &SMatrix<f64, N, N>) -> f64 {
    let defect = f.transpose() * eta * f - eta;
    defect.amax() / f.amax().max(1.0).powi(2)
}

/// On groups that are not compact, rounding grows with the elements that a run passes through. In steps that are far too
/// long, formulas of charts cancel. No step is `Ok` off its group.
#[test]
fn no_step_leaves_its_group_in_silence() {
    let minkowski = Matrix4::from_diagonal(&Vector4::new(1.0, -1.0, -1.0, -1.0));
    let frame = |random: &mut Random| LorentzFrame {
        inertia: 1.2,
        field: Vector4::new(random.number(), 0.2, 0.3, hostile(random)),
        spin: random.vector(),
    };
    let [_, refused] = stay_on_their_group::<_, 4, 6>(frame, |f| off_form(&minkowski, f));
    assert!(refused > 0, "no frame was far off");
}

/// The same for groups of other forms, and of a determinant.
#[test]
fn no_step_leaves_another_group_in_silence() {
    let symplectic = Matrix4::from_fn(|i, j| {
        if j == i + 2 {
            1.0
        } else if i == j + 2 {
            -1.0
        } else {
            0.0
        }
    });
    stay_on_their_group::<_, 4, 10>(|_| LinearOptics, |f| off_form(&symplectic, f));
    let signs = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0));
    stay_on_their_group::<_, 3, 3>(|_| Boosts, |f| off_form(&signs, f));
    let shear = |random: &mut Random| Shear { stiffness: hostile(random) };
    stay_on_their_group::<_, 2, 3>(shear, |f| (f.determinant() - 1.0).abs() / f.amax().max(1.0).powi(2));
}

/// A matrix of another determinant is no element of SL(n), however large its entries are.
#[test]
fn volumes_are_checked() {
    let stepper = Shear { stiffness: 1.0 }.into_stepper(H).expect("a shear");
    let start = |scale: f64, size: f64| stepper.state(Matrix2::new(size, 0.0, 0.0, scale / size), Vector3::zeros());
    for size in [1.0, 1e-3, 1e4, 1e7] {
        assert!(start(1.0, size).is_ok(), "{size}");
    }
    for scale in [2.0, 0.5, -1.0, 0.0, 1.001] {
        assert!(matches!(start(scale, 1.0), Err(Error::OffOrbit { .. })), "{scale}");
    }
    assert!(matches!(stepper.state(Matrix2::identity() * 1e7, Vector3::zeros()), Err(Error::OffOrbit { .. })));
    let fluid = FluidEllipsoid { mass: 0.8 }.into_stepper(H).expect("a fluid");
    let stretched = fluid.state(Matrix3::identity() * 1.1, SVector::zeros());
    assert!(matches!(stretched, Err(Error::OffOrbit { .. })), "{stretched:?}");
}
