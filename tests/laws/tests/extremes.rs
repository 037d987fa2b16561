//! Bad inputs give typed errors that name them, steps that are too long say by how much, and small cases are exact.

use clebsch::{Clebsch, Error};
use clebsch_tests::fixtures::bounded_top::BoundedTop;
use clebsch_tests::fixtures::first_order_top::FirstOrderTop;
use clebsch_tests::fixtures::free_rigid_body::FreeRigidBody;
use clebsch_tests::fixtures::generic_body::GenericBody;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::neumann::Neumann;
use clebsch_tests::fixtures::principal_body4::PrincipalBody4;
use clebsch_tests::fixtures::quaternion_top::QuaternionTop;
use clebsch_tests::fixtures::rigid_body4::RigidBody4;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::fixtures::two_bodies::TwoBodies;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use nalgebra::*;

fn top() -> HeavyTop {
    HeavyTop { mass_matrix: Random::new(91).inertia(), weight: 1.3, center: Vector3::new(0.1, -0.2, 0.7) }
}

fn pendulum() -> SphericalPendulum {
    SphericalPendulum { mass: 0.7, length: 1.3, gravity: 9.81 }
}

fn principal(x: f64, y: f64, z: f64) -> FreeRigidBody {
    FreeRigidBody { inertia: Matrix3::from_diagonal(&Vector3::new(x, y, z)) }
}

#[test]
fn inputs_that_are_not_finite_are_named() {
    let not_finite = |name| Some(Error::NotFinite { name });
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(HeavyTop { weight: bad, ..top() }.stepper(0.1).err(), not_finite("weight"));
        assert_eq!(HeavyTop { center: Vector3::x() * bad, ..top() }.stepper(0.1).err(), not_finite("center"));
        let mut broken = top();
        broken.mass_matrix[(1, 2)] = bad;
        assert_eq!(broken.stepper(0.1).err(), not_finite("mass_matrix"));
        assert_eq!(TwoBodies { mass: [1.0, bad], gravitation: 1.0 }.stepper(0.1).err(), not_finite("mass"));
        assert!(matches!(top().stepper(bad), Err(Error::StepSize { .. })));

        let stepper = top().stepper(0.1).expect("a top");
        let (r, pi) = (Matrix3::identity(), Vector3::z());
        assert_eq!(stepper.state(r * bad, pi).err(), not_finite("the configuration"));
        assert_eq!(stepper.state(r, pi * bad).err(), not_finite("the momentum"));
        assert_eq!(stepper.cotangent_state(r, r * bad).err(), not_finite("the covector"));
        assert_eq!(stepper.inverse_legendre(&r, &(pi * bad)).err(), not_finite("the momentum"));
    }
    assert_eq!(top().stepper(0.0).err(), Some(Error::StepSize { value: 0.0 }));
    let collision = TwoBodies { mass: [1.0, 1.0], gravitation: 1.0 }.stepper(0.1).expect("bodies");
    let name = "the gradient of the potential at the configuration";
    assert_eq!(collision.state([Vector3::x(); 2], Vector6::zeros()).err(), not_finite(name));
}

#[test]
fn parameters_that_break_a_promise_or_the_kinetic_energy() {
    let mut inertia = Matrix3::identity();
    inertia[(0, 2)] = 0.1;
    assert!(
        matches!(FreeRigidBody { inertia }.stepper(0.1), Err(Error::NotSymmetric { field: "inertia", defect, .. }) if defect == 0.1)
    );
    assert!(matches!(principal(1.0, 1.0, 0.0).stepper(0.1), Err(Error::SingularKineticEnergy { .. })));
    let massless = SphericalPendulum { mass: 0.0, ..pendulum() };
    assert!(matches!(massless.stepper(0.1), Err(Error::SingularKineticEnergy { .. })));
}

#[test]
fn states_off_their_orbit_and_momenta_that_no_motion_has() {
    let stepper = top().stepper(0.1).expect("a top");
    let stretched = Matrix3::identity() * 1.01;
    assert!(
        matches!(stepper.state(stretched, Vector3::z()), Err(Error::OffOrbit { defect, .. }) if (defect - 0.0201).abs() < 1e-12)
    );
    let mirror = -Matrix3::identity();
    assert!(
        matches!(stepper.state(mirror, Vector3::z()), Err(Error::OffOrbit { defect, .. }) if defect == f64::INFINITY)
    );
    assert!(matches!(stepper.cotangent_state(stretched, mirror), Err(Error::OffOrbit { .. })));

    let stepper = pendulum().stepper(0.01).expect("a pendulum");
    let (q, n) = (Vector3::y(), Vector3::new(1.0, 0.25, 0.5));
    assert!(
        matches!(stepper.state(q, n), Err(Error::OutsideMomentumSpace { violation, .. }) if (violation - 0.25).abs() < 1e-15)
    );
    assert!(matches!(stepper.state(q * 2.0, n), Err(Error::OffOrbit { defect, .. }) if (defect - 3.0).abs() < 1e-15));
    assert!(stepper.state(q, n - q * 0.25).is_ok());
    let stepper = Neumann { stiffness: Matrix4::identity() }.stepper(0.1).expect("a sphere");
    let q = nalgebra::Vector4::x();
    // of the six components (12) (13) (14) (23) (24) (34), the last three turn planes that do not hold q
    assert!(stepper.state(q, Vector6::new(1.0, -2.0, 3.0, 0.0, 0.0, 0.0)).is_ok());
    let outside = stepper.state(q, Vector6::new(1.0, 0.0, 0.0, 0.0, 0.0, -0.5));
    assert!(matches!(outside, Err(Error::OutsideMomentumSpace { violation, .. }) if (violation - 0.5).abs() < 1e-15));
}

/// About a principal axis sin θ = hY/I, so the equation with s times the momentum is solvable up to s = I/(hY).
#[test]
fn steps_that_are_too_long_say_by_how_much() {
    for (axis, moment) in [(Vector3::x(), 1.0), (Vector3::y(), 1.5), (Vector3::z(), 2.2)] {
        for excess in [1.01, 1.5, 4.0] {
            let stepper = principal(1.0, 1.5, 2.2).stepper(0.1).expect("a body");
            let momentum = axis * (excess * moment / 0.1);
            let state = stepper.state(Matrix3::identity(), momentum).expect("a state");
            match stepper.step(&state) {
                Err(Error::Unsolvable { solvable_fraction, step_size: Some(h), .. }) => {
                    let expected = 1.0 / excess;
                    println!("body, {excess} too long: solvable up to {solvable_fraction:.4}, {expected:.4} expected");
                    // the end of the path is bracketed, not solved for
                    assert!((solvable_fraction - expected).abs() < 1e-3, "{solvable_fraction} and not {expected}");
                    assert_eq!(h, 0.1);
                }
                other => panic!("{other:?}"),
            }
            let slower = stepper.state(Matrix3::identity(), momentum * (0.99 / excess)).expect("a state");
            let f = stepper.step(&slower).expect("just solvable").into_parts().0;
            let sine = 0.5 * (f - f.transpose()).norm() / 2.0_f64.sqrt();
            assert!((sine - 0.99).abs() < 1e-12, "sin θ = {sine}");
        }
    }
    // the pendulum without gravity: h|N| ≤ m l², whatever the direction
    let stepper = SphericalPendulum { mass: 2.0, length: 0.5, gravity: 0.0 }.stepper(0.1).expect("a pendulum");
    let state = stepper.state(Vector3::z(), Vector3::new(6.0, 8.0, 0.0)).expect("a state");
    let error = stepper.step(&state).expect_err("h|N| = 1 is twice m l²");
    assert!(
        matches!(error, Error::Unsolvable { solvable_fraction, .. } if (solvable_fraction - 0.5).abs() < 1e-6),
        "{error:?}"
    );
    assert!(error.to_string().contains("reduce the step size to 4.9"), "{error}");
    // an iterator tells the error once and ends
    let mut trajectory = stepper.trajectory(state);
    assert!(
        trajectory.next().is_some_and(|state| state.is_ok()) && trajectory.next().is_some_and(|state| state.is_err())
    );
    assert!(trajectory.next().is_none() && trajectory.next().is_none());
}

/// K(h, F) = −K(−h, F⁻¹): the step by −h undoes the step by h, to a few units in the last place.
#[test]
fn negative_steps_undo_positive_ones() {
    let random = &mut Random::new(92);
    let (r, pi) = (random.attitude::<3>(), random.vector::<3>());
    let (forward, backward) = (top().stepper(0.1).expect("a top"), top().stepper(-0.1).expect("a top"));
    let (q, mu) = forward.step(&forward.state(r, pi).expect("a state")).expect("a step").into_parts();
    let back = backward.step(&backward.state(q, mu).expect("a state")).expect("a step");
    assert_near(back.configuration(), &r, 1e-14, "R");
    assert_near(&back.momentum(), &pi, 1e-14, "π");

    let (forward, backward) =
        (pendulum().stepper(0.05).expect("a pendulum"), pendulum().stepper(-0.05).expect("a pendulum"));
    let (start, n) = (Vector3::y(), Vector3::new(1.0, 0.0, 0.5));
    let (q, mu) = forward.step(&forward.state(start, n).expect("a state")).expect("a step").into_parts();
    let back = backward.step(&backward.state(q, mu).expect("a state")).expect("a step");
    assert_near(back.configuration(), &start, 1e-14, "q");
    assert_near(&back.momentum(), &n, 1e-14, "N");

    // the papers' step of first order is not its own inverse
    let HeavyTop { mass_matrix, weight, center } = top();
    let first = |h| FirstOrderTop { mass_matrix, weight, center }.stepper(h).expect("a top");
    let (forward, backward) = (first(0.1), first(-0.1));
    let (q, mu) = forward.step(&forward.state(r, pi).expect("a state")).expect("a step").into_parts();
    let back = backward.step(&backward.state(q, mu).expect("a state")).expect("a step");
    assert!((back.momentum() - pi).amax() > 1e-4, "drift and kick do not commute");
}

/// Nothing moves without momentum and potential, and tiny momenta move a body in proportion to their size.
#[test]
fn zero_and_tiny_momenta() {
    let random = &mut Random::new(93);
    let stepper = principal(1.0, 1.5, 2.2).stepper(0.1).expect("a body");
    let r = random.attitude::<3>();
    let rest = stepper.state(r, Vector3::zeros()).expect("a state");
    assert_eq!(stepper.step(&rest).expect("a step"), rest);
    let four = RigidBody4 { j_d: random.inertia() }.stepper(0.1).expect("a body");
    let rest = four.state(random.attitude(), Vector6::zeros()).expect("a state");
    assert_eq!(four.step(&rest).expect("a step"), rest);
    let free = SphericalPendulum { gravity: 0.0, ..pendulum() }.stepper(0.1).expect("a pendulum");
    let rest = free.state(Vector3::z(), Vector3::zeros()).expect("a state");
    assert_eq!(free.step(&rest).expect("a step"), rest);

    for size in [1e-8, 1e-30, 1e-150, 1e-300] {
        let f = stepper.inverse_legendre(&r, &(Vector3::new(1.0, 3.0, -2.2) * size)).expect("a solvable step");
        // F − I = h ω^ + …, where ω = (1, 2, −1) size: of the off-diagonal entries only
        let expected = Vector3::new(1.0, 2.0, -1.0) * (0.1 * size);
        let omega = Vector3::new(f[(2, 1)], f[(0, 2)], f[(1, 0)]);
        assert!((omega - expected).amax() <= 1e-7 * expected.amax(), "{size}: {omega} and not {expected}");
    }
}

/// From steps that hardly turn to such that have no solution, which both refuse.
#[test]
fn both_solvers_step_alike() {
    let mut random = Random::new(97);
    let [mut stepped, mut refused] = [0, 0];
    for size in [1e-300, 1e-9, 1e-3, 0.03, 0.3, 1.0, 3.0, 30.0, 1e9] {
        for _ in 0..40 {
            let j_d = Vector4::from_fn(|_, _| random.between(0.2, 2.0));
            let (r, mu) = (random.attitude::<4>(), random.vector::<6>() * size);
            let fixed = PrincipalBody4 { j_d }.into_stepper(1.0).expect("a body");
            let newton = RigidBody4 { j_d: Matrix4::from_diagonal(&j_d) }.into_stepper(1.0).expect("a body");
            let steps = [
                fixed.step(&fixed.state(r, mu).expect("a state")).map(|next| (*next.configuration(), next.momentum())),
                newton
                    .step(&newton.state(r, mu).expect("a state"))
                    .map(|next| (*next.configuration(), next.momentum())),
            ];
            match steps {
                [Ok((q, m)), Ok((p, n))] => {
                    // near the end of the branch the data determine the step to √ε
                    let near = if size < 0.5 { 1e-14 } else { 1e-6 };
                    assert!((q - p).amax() <= near && (m - n).amax() <= near * mu.amax(), "{size}: {j_d} {mu}");
                    stepped += 1;
                }
                [Err(_), Err(_)] => refused += 1,
                steps => panic!("{size}: {steps:?}"),
            }
        }
    }
    assert!(stepped > 100 && refused > 40, "{stepped} steps, {refused} refused");
}

/// The heavy top by Newton's method, without a limit.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    solver    = newton,
)]
struct UnboundedTop {
    mass_matrix: Matrix3<f64>,
    weight: f64,
    center: Vector3<f64>,
}

/// A solution of three linearisations has the bits that it has without a limit; other solves are an error with their
/// numbers.
#[test]
fn a_limit_of_iterations_is_kept() {
    let mut random = Random::new(98);
    let [mut same, mut refused] = [0, 0];
    for size in [1e-3, 0.1, 1.0, 3.0, 10.0, 30.0, 100.0] {
        for _ in 0..40 {
            let HeavyTop { mass_matrix, weight, center } =
                HeavyTop { mass_matrix: random.inertia(), weight: 1.3, center: random.vector() };
            let (r, pi) = (random.attitude::<3>(), random.vector::<3>() * size);
            let free = UnboundedTop { mass_matrix, weight, center }.into_stepper(0.05).expect("a top");
            let bounded = BoundedTop { mass_matrix, weight, center }.into_stepper(0.05).expect("a top");
            let expected = free.step(&free.state(r, pi).expect("a state"));
            match bounded.step(&bounded.state(r, pi).expect("a state")) {
                Ok(next) => {
                    let expected = expected.expect("solved in three linearisations").into_parts();
                    assert_eq!(next.into_parts(), expected, "{size}");
                    same += 1;
                }
                Err(error @ Error::NotConverged { residual, iterations }) => {
                    assert!((1..=3).contains(&iterations) && residual > 0.0, "{error}");
                    assert!(error.to_string().contains("allow more by `iterations`"), "{error}");
                    refused += 1;
                }
                Err(other) => panic!("{size}: {other}"),
            }
        }
    }
    println!("{same} solved in three linearisations, {refused} refused");
    assert!(same > 100 && refused > 40, "{same} solved, {refused} refused");
}

/// Orthogonality is nobody's concern: after 300 000 steps in single precision a rotation is one to a few units in the last place. Left alone, rounding
/// makes 3e-5 of it.
#[test]
fn rotations_stay_rotations() {
    let mass_matrix = Matrix3::from_diagonal(&Vector3::new(1.25_f32, 0.75, 0.25));
    let body = GenericBody { mass_matrix, weight: 0.5, center: Vector3::new(0.1, 0.2, 0.5) };
    let stepper = body.into_stepper(0.05).expect("a body");
    let start = stepper.state(Matrix3::identity(), Vector3::new(0.5, 1.25, 1.0)).expect("a state");
    let mut largest = 0.0_f32;
    for state in stepper.trajectory(start).take(if cfg!(feature = "heavy") { 300_000 } else { 30_000 }) {
        largest = largest.max(stepper.system().orbit_defect(state.expect("a step").configuration()));
    }
    println!("RᵀR − I up to {largest:.1e}");
    assert!(largest < 48.0 * f32::EPSILON, "{largest:.1e}");
}

/// A quaternion of another length than one is no rotation.
#[test]
fn quaternions_have_length_one() {
    let (inertia, moment) = (Random::new(99).inertia(), Vector3::z());
    let stepper = QuaternionTop { inertia, moment }.into_stepper(0.05).expect("a top");
    let refused = stepper.state(Quaternion::new(2.0, 0.0, 0.0, 0.0), Vector3::z());
    assert!(matches!(refused, Err(Error::OffOrbit { defect, .. }) if (defect - 3.0).abs() < 1e-15), "{refused:?}");
}
