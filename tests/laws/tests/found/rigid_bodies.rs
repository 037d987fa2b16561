//! Section 2.1: bodies on SO(3) and on unit quaternions.

use clebsch::{Clebsch, Error};
use clebsch_tests::fixtures::free_rigid_body::FreeRigidBody;
use clebsch_tests::fixtures::gravity_gradient::GravityGradient;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::heavy_top_reduced::HeavyTopReduced;
use clebsch_tests::fixtures::midpoint_top::MidpointTop;
use clebsch_tests::fixtures::principal_body::PrincipalBody;
use clebsch_tests::fixtures::quaternion_top::QuaternionTop;
use clebsch_tests::oracle::body::{gravity_torque, inertia, mass_matrix};
use clebsch_tests::oracle::flat::far;
use clebsch_tests::oracle::motion::order;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::vee;
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use crate::{H, NEAR, assert_conserved, assert_reversible, assert_says, assert_says_nowhere};

const SPATIAL: [&str; 3] = ["about e1, spatial", "about e2, spatial", "about e3, spatial"];

#[test]
fn free_rigid_body_and_principal_body() {
    let random = &mut Random::new(201);
    for sentence in ["from the right", "time-symmetric", "no potential", "one scalar unknown"] {
        assert_says::<FreeRigidBody>(&[sentence]);
        assert_says::<PrincipalBody>(&[sentence]);
    }
    let moments = Vector3::new(1.0, 1.7, 2.4);
    let free = FreeRigidBody { inertia: Matrix3::from_diagonal(&moments) };
    let principal = PrincipalBody { moments };
    let (r, f, pi) = (random.attitude::<3>(), random.attitude::<3>(), random.vector::<3>());
    let second_moment = mass_matrix(&free.inertia);
    let expected = vee(&(f * second_moment - second_moment * f.transpose())) / H;
    assert_near(&free.legendre(H, 0.0, &r, &f), &expected, NEAR, "h π^ = F𝒥 − 𝒥Fᵀ");
    assert_near(&principal.legendre(H, 0.0, &r, &f), &expected, NEAR, "h π^ = F𝒥 − 𝒥Fᵀ");
    assert_near(&free.legendre_next(H, 0.0, &r, &f), &(f.transpose() * expected), NEAR, "N⁺ = Fᵀπ");

    let (one, other) = (free.stepper(H).expect("a body"), principal.stepper(H).expect("a body"));
    let (mut a, mut b) = (one.state(r, pi).expect("a state"), other.state(r, pi).expect("a state"));
    for _ in 0..200 {
        (a, b) = (one.step(&a).expect("a step"), other.step(&b).expect("a step"));
        assert_near(a.configuration(), b.configuration(), 1e-13, "one and the same step");
        assert_near(&a.momentum(), &b.momentum(), 1e-13, "one and the same step");
        assert!((a.momentum().norm() - pi.norm()).abs() < NEAR, "the Casimir |π|");
    }
    assert_conserved(free.clone(), r, pi, SPATIAL);
    assert_conserved(principal, r, pi, SPATIAL);
    let conserved = one.conserved(&one.state(r, pi).expect("a state"));
    assert_near(&Vector3::from(*conserved.values()), &(r * pi), NEAR, "R π");
    assert_reversible(&free, r, pi);
}

/// Only the symmetric part of a matrix enters, so the step is time-symmetric without the promise.
#[test]
fn a_mass_matrix_need_not_be_promised_symmetric() {
    let random = &mut Random::new(202);
    let top =
        HeavyTop { mass_matrix: random.inertia::<3>() + random.matrix() * 0.3, weight: 1.3, center: random.vector() };
    assert_reversible(&top, random.attitude(), random.vector());
    let symmetric = HeavyTop { mass_matrix: (top.mass_matrix + top.mass_matrix.transpose()) / 2.0, ..top.clone() };
    let (r, f) = (random.attitude(), random.attitude());
    assert_near(&top.legendre(H, 0.0, &r, &f), &symmetric.legendre(H, 0.0, &r, &f), NEAR, "π");
}

#[test]
fn gravity_gradient() {
    let random = &mut Random::new(203);
    assert_says::<GravityGradient>(&["from the right", "half kick, drift, half kick", "one scalar unknown"]);
    assert_says_nowhere::<GravityGradient>(&["Conserved: the momentum"]);
    let system = GravityGradient { inertia: random.inertia(), orbital_rate: 1.4 };
    let constants = system.step_constants(H).expect("a body");
    for _ in 0..10 {
        let (r, f, t) = (random.attitude::<3>(), random.attitude::<3>(), random.between(-3.0, 3.0));
        let torque = |t: f64, r: &Matrix3<f64>| {
            let z = r.transpose() * Vector3::new((1.4 * t).cos(), (1.4 * t).sin(), 0.0);
            z.cross(&(system.inertia * z)) * (3.0 * 1.4 * 1.4)
        };
        assert_near(
            &system.impulse(&constants, t, &r, &nalgebra::zero()),
            &(torque(t, &r) * (H / 2.0)),
            NEAR,
            "τ = 3n² z × Jz",
        );
        let second_moment = mass_matrix(&system.inertia);
        let drift = vee(&(f * second_moment - second_moment * f.transpose())) / H;
        let before = drift - torque(t, &r) * (H / 2.0);
        let after = f.transpose() * drift + torque(t + H, &(r * f)) * (H / 2.0);
        assert_near(&system.legendre(H, t, &r, &f), &before, NEAR, "the first kick at t");
        assert_near(&system.legendre_next(H, t, &r, &f), &after, NEAR, "the last kick at t + h");
    }
    // a step from t and the step back from t + h, by the time that states carry
    let (forward, back) = (system.stepper(H).expect("a body"), system.stepper(-H).expect("a body"));
    let start = forward.state_at(0.7, random.attitude(), random.vector()).expect("a state");
    let mut state = start;
    for _ in 0..50 {
        state = forward.step(&state).expect("a step");
    }
    assert!((state.time() - (0.7 + 50.0 * H)).abs() < 1e-14, "{}", state.time());
    let mut state = back.state_at(state.time(), *state.configuration(), state.momentum()).expect("a state");
    for _ in 0..50 {
        state = back.step(&state).expect("a step");
    }
    assert_near(state.configuration(), start.configuration(), 1e-11, "back at the start");
    assert_near(&state.momentum(), &start.momentum(), 1e-11, "back at the start");
}

#[test]
fn heavy_top() {
    let random = &mut Random::new(204);
    assert_says::<HeavyTop>(&[
        "from the right",
        "half kick, drift, half kick",
        "one scalar unknown",
        "Conserved: the momentum about e3, spatial.",
        "where mass_matrix is axisymmetric about ek and center is along ek",
    ]);
    let top = HeavyTop { mass_matrix: random.inertia(), weight: 1.3, center: random.vector() };
    let (r, pi) = (random.attitude::<3>(), random.vector::<3>());
    let kick = top.impulse(&top.step_constants(H).expect("a top"), 0.0, &r, &nalgebra::zero());
    assert_near(&kick, &(gravity_torque(1.3, &top.center, &r) * (H / 2.0)), NEAR, "τ = weight Γ × center");
    assert_conserved(top.clone(), r, pi, ["about e3, spatial"]);
    assert_reversible(&top, r, pi);
    // the momentum that only an axisymmetric top conserves too
    let lagrange = Matrix3::from_diagonal(&Vector3::new(0.7, 0.7, 0.4));
    for (mass_matrix, changes) in [(lagrange, false), (top.mass_matrix, true)] {
        let top = HeavyTop { mass_matrix, weight: 1.3, center: Vector3::z() };
        let stepper = top.stepper(H).expect("a top");
        let mut state = stepper.state(r, pi).expect("a state");
        for _ in 0..100 {
            state = stepper.step(&state).expect("a step");
        }
        assert_eq!((state.momentum().z - pi.z).abs() > 1e-9, changes, "π_3 of an axisymmetric top");
    }
}

#[test]
fn heavy_tops_of_three_kinds_are_one() {
    let random = &mut Random::new(205);
    assert_says::<HeavyTopReduced>(&["from the right", "time-symmetric", "Conserved: the momentum about Gamma, body."]);
    assert_says::<HeavyTopReduced>(&["Left out, as asked for by `isotropy = free`"]);
    assert_says::<QuaternionTop>(&["from the right", "time-symmetric", "Conserved: the momentum about e3, spatial."]);
    let top = HeavyTop { mass_matrix: random.inertia(), weight: 1.3, center: random.vector() };
    let moment = top.center * top.weight;
    let reduced = HeavyTopReduced { mass_matrix: top.mass_matrix, moment };
    let quaternion = QuaternionTop { inertia: inertia(&top.mass_matrix), moment };
    let (r, pi) = (random.attitude::<3>(), random.vector::<3>());
    let gamma = r.transpose() * Vector3::z();
    let turn = |q: &Quaternion<f64>| UnitQuaternion::new_unchecked(*q).to_rotation_matrix().into_inner();
    let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(r)).into_inner();
    let steppers =
        (top.stepper(H).expect("a top"), reduced.stepper(H).expect("a top"), quaternion.stepper(H).expect("a top"));
    let mut a = steppers.0.state(r, pi).expect("a state");
    let mut b = steppers.1.state(gamma, pi).expect("any momentum, motions that fix Γ are motions");
    let mut c = steppers.2.state(q, pi).expect("a state");
    let conserved = (a.momentum().dot(&gamma), steppers.1.conserved(&b)[0], steppers.2.conserved(&c)[0]);
    assert!((conserved.0 - conserved.1).abs() < NEAR && (conserved.0 - conserved.2).abs() < NEAR, "π·Γ, (Rπ)_z");
    for _ in 0..200 {
        a = steppers.0.step(&a).expect("a step");
        b = steppers.1.step(&b).expect("a step");
        c = steppers.2.step(&c).expect("a step");
        assert_near(b.configuration(), &(a.configuration().transpose() * Vector3::z()), NEAR, "Γ = Rᵀe_z");
        assert_near(&turn(c.configuration()), a.configuration(), NEAR, "R of the quaternion");
        assert_near(&b.momentum(), &a.momentum(), NEAR, "π of the reduced top");
        assert_near(&c.momentum(), &a.momentum(), NEAR, "π of the quaternion top");
    }
    let energies = (steppers.0.energy(&a), steppers.1.energy(&b), steppers.2.energy(&c));
    assert!((energies.0 - energies.1).abs() < NEAR, "the constant −tr 𝒥/h is no energy: {energies:?}");
    assert!((energies.0 - energies.2).abs() < NEAR, "{energies:?}");
    // h/2 π = ρ₀Jρ + ρ×Jρ, without gravity
    let free = QuaternionTop { moment: Vector3::zeros(), ..quaternion };
    let f =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(random.attitude::<3>())).into_inner();
    let (w, rho) = (f.w, f.imag());
    let expected = (free.inertia * rho * w + rho.cross(&(free.inertia * rho))) * (2.0 / H);
    assert_near(&free.legendre(H, 0.0, &q, &f), &expected, NEAR, "h/2 π = ρ₀Jρ + ρ×Jρ");
    assert_conserved(reduced, gamma, pi, ["about Gamma, body"]);
}

/// The reduced top where only points of S² are configurations.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |W: SO<3>, Gamma: Unit<Vector3>| W.transpose() * Gamma,
    cost      = |h, W| -(self.mass_matrix * W).trace() / h,
    potential = |Gamma| Gamma.dot(&self.moment),
)]
pub struct PointOfTheTop {
    #[clebsch(symmetric)]
    pub mass_matrix: Matrix3<f64>,
    pub moment: Vector3<f64>,
}

#[test]
fn fixed_isotropy_demands_momenta_of_points() {
    let random = &mut Random::new(206);
    assert_says::<PointOfTheTop>(&["state() demands"]);
    let stepper = PointOfTheTop { mass_matrix: random.inertia(), moment: random.vector() }.stepper(H).expect("a top");
    let (gamma, pi) = (random.unit::<3>(), random.vector::<3>());
    match stepper.state(gamma, pi) {
        Err(Error::OutsideMomentumSpace { violation, .. }) => assert!((violation - pi.dot(&gamma).abs()).abs() < NEAR),
        other => panic!("{other:?}"),
    }
    let projected = stepper.project(gamma, pi).expect("a projection").momentum();
    assert_near(&projected, &(pi - gamma * pi.dot(&gamma)), NEAR, "the nearest momentum with π·Γ = 0");
    assert!(stepper.state(gamma, projected).is_ok());
}

#[test]
fn midpoint_top() {
    let random = &mut Random::new(207);
    assert_says::<MidpointTop>(&[
        "from the right",
        "couples",
        "second order",
        "Conserved: the momentum about e3, spatial.",
    ]);
    assert_says_nowhere::<MidpointTop>(&["half kick"]);
    let top = MidpointTop { mass_matrix: random.inertia(), weight: 1.3, stiffness: 0.8, center: random.vector() };
    let (r, f, pi) = (random.attitude::<3>(), random.rotation::<3>(0.5), random.vector::<3>());
    // ∂ of the potential at the chord's midpoint with respect to R and to F
    let height = ((r + r * f) / 2.0 * top.center).z;
    let force = top.weight + 2.0 * top.stiffness * height;
    let weight = |r: &Matrix3<f64>| r.transpose() * Vector3::z();
    let drift = vee(&(f * top.mass_matrix - top.mass_matrix * f.transpose())) / H;
    // r(F) = T*R ∂_F K − J(∂_R K): the part with (R F) of both cancels
    let before = drift - weight(&r).cross(&top.center) * (H / 2.0 * force);
    let after = f.transpose() * drift + weight(&(r * f)).cross(&top.center) * (H / 2.0 * force);
    assert_near(&top.legendre(H, 0.0, &r, &f), &before, NEAR, "r(F) = T*R ∂_F K − J(∂_R K)");
    assert_near(&top.legendre_next(H, 0.0, &r, &f), &after, NEAR, "N⁺ = T*L ∂_F K");
    assert_conserved(top.clone(), r, pi, ["about e3, spatial"]);
    assert_reversible(&top, r, pi);
    let end = |steps: usize| {
        let stepper = top.stepper(1.0 / steps as f64).expect("a top");
        let start = stepper.state(r, pi * 2.0).expect("a state");
        (0..steps).fold(start, |state, _| stepper.step(&state).expect("a step"))
    };
    let ends = [32, 64, 128, 256, 512].map(end);
    let errors: Vec<f64> = ends.windows(2).map(|pair| far(pair[0].configuration(), pair[1].configuration())).collect();
    assert!((order(&errors) - 2.0).abs() < 0.1, "{errors:?}");
}
