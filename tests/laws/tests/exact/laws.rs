//! The invariants of every step, and the relations between steps.

use crate::systems::{eighth, fourth, sixth};
use clebsch::{Clebsch, Conserved, Conserves, Error, Stepper};
use clebsch_tests::fixtures::exact_body::ExactBody;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::hat;
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix3, Matrix6, UnitQuaternion, Vector3, Vector6};

const MOMENTS: Vector3<f64> = Vector3::new(1.1, 2.0, 2.6);

fn start() -> (Matrix3<f64>, Vector3<f64>) {
    (Random::new(51).attitude::<3>(), Vector3::new(1.0, -1.5, 2.0))
}

macro_rules! top {
    ($order:ident) => {
        $order::Top { inertia: Matrix3::from_diagonal(&MOMENTS), weight: 3.0, center: Vector3::new(0.2, -0.1, 0.6) }
    };
}

/// D of a step along R ↦ R exp(x^) and π, by central differences with one extrapolation: ten digits.
fn derivative<S: Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Momentum = Vector3<f64>>>(
    stepper: &Stepper<S>,
) -> (Matrix6<f64>, Vector3<f64>, Vector3<f64>) {
    let (r, pi) = start();
    let stepped = |y: Vector6<f64>| {
        let turn = nalgebra::Rotation3::new(y.fixed_rows::<3>(0).into_owned()).into_inner();
        let state = stepper.state(r * turn, pi + y.fixed_rows::<3>(3)).expect("a state");
        let next = stepper.step(&state).expect("a step");
        (*next.configuration(), next.momentum())
    };
    let (r_next, pi_next) = stepped(Vector6::zeros());
    let along = |i: usize, size: f64| {
        let at = |sign: f64| {
            let (r, pi) = stepped(Vector6::ith(i, sign * size));
            let turn = r_next.transpose() * r;
            let x = Vector3::new(turn[(2, 1)] - turn[(1, 2)], turn[(0, 2)] - turn[(2, 0)], turn[(1, 0)] - turn[(0, 1)])
                / 2.0;
            Vector6::from_iterator(x.iter().chain((pi - pi_next).iter()).copied())
        };
        (at(1.0) - at(-1.0)) / (2.0 * size)
    };
    let column = |i: usize| (along(i, 1e-3) * 4.0 - along(i, 2e-3)) / 3.0;
    (Matrix6::from_columns(&[0, 1, 2, 3, 4, 5].map(column)), pi, pi_next)
}

/// The symplectic form of T*SO(3) in these coordinates: W(π) = (−π^ I; −I 0).
fn form(pi: &Vector3<f64>) -> Matrix6<f64> {
    let mut w = Matrix6::zeros();
    w.fixed_view_mut::<3, 3>(0, 0).copy_from(&-hat(pi));
    w.fixed_view_mut::<3, 3>(0, 3).copy_from(&Matrix3::identity());
    w.fixed_view_mut::<3, 3>(3, 0).copy_from(&-Matrix3::identity());
    w
}

#[test]
fn steps_are_symplectic() {
    fn check<S: Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Momentum = Vector3<f64>>>(stepper: &Stepper<S>) {
        let (d, pi, next) = derivative(stepper);
        let defect = (d.transpose() * form(&next) * d - form(&pi)).abs().max();
        assert!(defect < 1e-9, "{}: {defect:e}", S::NAME);
    }
    check(&ExactBody { moments: MOMENTS }.stepper(0.3).expect("regular"));
    check(&top!(fourth).stepper(0.3).expect("regular"));
    check(&top!(sixth).stepper(0.3).expect("regular"));
    check(&top!(eighth).stepper(0.3).expect("regular"));
}

/// Ten thousand steps: the momentum about the vertical at round-off, the energy in a band that does not move.
#[test]
fn momenta_stay_and_energy_swings() {
    fn check<S>(system: &S, h: f64, band: f64)
    where
        S: Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Momentum = Vector3<f64>>,
        S: Conserves<Conserved = Conserved<f64, 1>> + Clone,
    {
        let stepper = system.stepper(h).expect("regular");
        let (r, pi) = start();
        let begin = stepper.state(r, pi).expect("a state");
        let [vertical] = *stepper.conserved(&begin).values();
        let energy = stepper.energy(&begin);
        let (mut state, mut halves) = (begin, [0.0_f64; 2]);
        for half in &mut halves {
            for _ in 0..5000 {
                state = stepper.step(&state).expect("a step");
                *half = half.max((stepper.energy(&state) - energy).abs());
            }
        }
        let [now] = *stepper.conserved(&state).values();
        let defect = (state.configuration().transpose() * state.configuration() - Matrix3::identity()).abs().max();
        assert!((now - vertical).abs() < 1e-12, "{}: {:e}", S::NAME, now - vertical);
        assert!(defect < 1e-12, "{}: off the group by {defect:e}", S::NAME);
        assert!(halves[0] < band && halves[1] < 1.2 * halves[0], "{}: energy errors {halves:?}", S::NAME);
    }
    check(&top!(fourth), 0.1, 1e-3);
    check(&top!(sixth), 0.1, 1e-4);
}

#[test]
fn a_free_body_keeps_energy_and_momentum_at_any_step() {
    for h in [0.01, 0.5, 3.0] {
        let stepper = ExactBody { moments: MOMENTS }.stepper(h).expect("regular");
        let (r, pi) = start();
        let begin = stepper.state(r, pi).expect("a state");
        let end = stepper.advance(&begin, 100_000).expect("steps");
        let spatial = end.configuration() * end.momentum() - r * pi;
        assert!((stepper.energy(&end) / stepper.energy(&begin) - 1.0).abs() < 3e-12, "h = {h}");
        assert!(spatial.norm() < 3e-11, "h = {h}: {:e}", spatial.norm());
    }
}

/// Both representations make the same step: π = J(R, p).
#[test]
fn both_representations_agree() {
    let system = top!(sixth);
    let stepper = system.stepper(0.2).expect("regular");
    let (r, pi) = start();
    // J(R, p) = components of Rᵀp: p = R π^/2
    let p = r * hat(&pi) / 2.0;
    let state = stepper.state(r, pi).expect("a state");
    let lifted = stepper.cotangent_state(r, p).expect("a state");
    let (next, lifted) = (stepper.step(&state).expect("a step"), stepper.step_symmetric(&lifted).expect("a step"));
    let momentum = system.momentum_map(lifted.configuration(), lifted.covector());
    assert!((next.configuration() - lifted.configuration()).norm() < 1e-14);
    assert!((next.momentum() - momentum).norm() < 1e-13);
}

/// Quaternions and matrices make the same steps, by drifts of many turns too: F − I of the quaternion with w ≥ 0.
#[test]
fn quaternions_are_matrices() {
    let random = &mut Random::new(53);
    let moment = Vector3::new(0.6, -0.3, 1.8);
    for h in [0.05, 0.3, 1.0, 2.5, 7.0] {
        let matrices = fourth::Top { inertia: Matrix3::from_diagonal(&MOMENTS), weight: 1.0, center: moment };
        let quaternions = fourth::QuaternionTop { moments: MOMENTS, moment };
        let (matrices, quaternions) = (matrices.stepper(h).expect("regular"), quaternions.stepper(h).expect("regular"));
        for _ in 0..32 {
            let (r, pi) = (random.attitude::<3>(), random.vector::<3>() * 4.0);
            let q = UnitQuaternion::from_matrix(&r).into_inner();
            let by_matrix = matrices.step(&matrices.state(r, pi).expect("a state")).expect("a step");
            let by_quaternion = quaternions.step(&quaternions.state(q, pi).expect("a state")).expect("a step");
            let turned = UnitQuaternion::new_unchecked(*by_quaternion.configuration()).to_rotation_matrix();
            // the turn of a long drift is right to some units of its last digit, and kicks are as long as h³
            let error = 1e-13 * (1.0 + h).powi(5);
            assert!((turned.matrix() - by_matrix.configuration()).norm() < error, "{h}: {turned}");
            assert!((by_matrix.momentum() - by_quaternion.momentum()).norm() < 8.0 * error, "{h}");
        }
    }
}

/// F⁻ℓd is the inverse of the solve, and F⁺ℓd the momentum that it ends with.
#[test]
fn legendre_transforms_belong_to_the_step() {
    let system = crate::systems::second::Top {
        inertia: Matrix3::from_diagonal(&MOMENTS),
        weight: 3.0,
        center: Vector3::new(0.2, -0.1, 0.6),
    };
    let h = 0.3;
    let stepper = system.stepper(h).expect("regular");
    let (r, pi) = start();
    let constants = system.step_constants(h).expect("regular");
    let f = system.inverse_legendre(&constants, 0.0, &r, &pi).expect("solved");
    let state = stepper.step(&stepper.state(r, pi).expect("a state")).expect("a step");
    assert!((system.act(&f, &r) - state.configuration()).norm() < 1e-14);
    assert!((system.legendre(h, 0.0, &r, &f) - pi).norm() < 1e-13);
    assert!((system.legendre_next(h, 0.0, &r, &f) - state.momentum()).norm() < 1e-13);
    // and of a motion from the left
    let mirrored = crate::systems::second::MirroredTop { moments: MOMENTS, moment: Vector3::new(0.6, -0.3, 1.8) };
    let constants = mirrored.step_constants(h).expect("regular");
    let f = mirrored.inverse_legendre(&constants, 0.0, &r, &pi).expect("solved");
    assert!((mirrored.legendre(h, 0.0, &r, &f) - pi).norm() < 1e-13);
}

/// Powers of two in the units of mass change no bit, near the ends of the exponent range too.
#[test]
fn units_do_not_matter() {
    let (r, pi) = start();
    let stepped = |scale: f64| {
        let stepper = ExactBody { moments: MOMENTS * scale }.stepper(0.7).expect("regular");
        let end = stepper.advance(&stepper.state(r, pi * scale).expect("a state"), 20).expect("steps");
        (*end.configuration(), end.momentum() / scale)
    };
    let plain = stepped(1.0);
    for exponent in [-900, -400, -1, 400, 900] {
        assert_eq!(stepped(2.0_f64.powi(exponent)), plain, "2^{exponent}");
    }
}

/// So with the units of mass and time of a top, by matrices and by quaternions, and of a pendulum.
/// Squares of forces, ∝ T⁻⁴, would overflow.
#[test]
fn units_of_tops_do_not_matter() {
    let (r, pi) = start();
    let turn = UnitQuaternion::from_matrix(&r).into_inner();
    macro_rules! check {
        ($top:expr, $place:expr) => {
            let stepped = |mass: f64, time: f64| {
                let stepper = $top(mass, 3.0 * mass / time / time).stepper(0.1 * time).expect("regular");
                let start = stepper.state($place, pi * (mass / time)).expect("a state");
                let end = stepper.advance(&start, 20).expect("steps");
                (*end.configuration(), end.momentum() / (mass / time))
            };
            let plain = stepped(1.0, 1.0);
            for exponent in [-480, -300, -1, 300, 480] {
                assert_eq!(stepped(2.0_f64.powi(exponent), 1.0), plain, "mass, 2^{exponent}");
                assert_eq!(stepped(1.0, 2.0_f64.powi(exponent)), plain, "time, 2^{exponent}");
            }
        };
    }
    let (inertia, center) = (Matrix3::from_diagonal(&MOMENTS), Vector3::new(0.2, -0.1, 0.6));
    check!(|mass, weight| fourth::Top { inertia: inertia * mass, weight, center }, r);
    check!(|mass, weight| sixth::Top { inertia: inertia * mass, weight, center }, r);
    check!(|mass, weight| fourth::QuaternionTop { moments: MOMENTS * mass, moment: center * weight }, turn);
    let swung = |time: f64| {
        let unit = 1.0 / time / time;
        let pendulum = fourth::Pendulum { gravity: 9.81 * unit, waves: 0.5 * unit };
        let stepper = pendulum.stepper(0.1 * time).expect("regular");
        let start = stepper.state(Vector3::x(), Vector3::new(0.0, 0.4, -0.7) / time).expect("a state");
        let end = stepper.advance(&start, 20).expect("steps");
        (*end.configuration(), end.momentum() * time)
    };
    // h³ is a constant of its kick
    for exponent in [-300, -1, 300] {
        assert_eq!(swung(2.0_f64.powi(exponent)), swung(1.0), "time, 2^{exponent}");
    }
}

/// Moments that differ by the last place, or by a factor of a million, and steps from nothing to two hundred turns.
#[test]
fn any_body_and_any_step() {
    let pi = Vector3::new(1.0, -1.5, 2.0);
    for moments in [[1.0, 1.0 + f64::EPSILON, 1.0], [1.0, 1.0, 2.0], [1.0, 2.0, 3.0], [1e-3, 1.0, 1.0], [1e6, 1.0, 1e6]]
    {
        let moments = Vector3::from(moments);
        let velocity = pi.component_div(&moments).norm();
        for turn in [1e-15, 1e-8, 1e-3, 1.0, std::f64::consts::PI, 6.3, 100.0] {
            let stepper = ExactBody { moments }.stepper(turn / velocity).expect("regular");
            let begin = stepper.state(Matrix3::identity(), pi).expect("a state");
            match stepper.step(&begin) {
                Ok(end) => {
                    let spatial = (end.configuration() * end.momentum() - pi).norm();
                    let energy = stepper.energy(&end) / stepper.energy(&begin) - 1.0;
                    assert!(spatial < 1e-12 && energy.abs() < 1e-12, "{moments:?}, {turn}: {spatial:e}, {energy:e}");
                }
                Err(Error::Unsolvable { solvable_fraction, .. }) => assert!(turn == 100.0 && solvable_fraction < 1.0),
                Err(other) => panic!("{moments:?}, {turn}: {other}"),
            }
        }
    }
}

/// A step that has no error serves for every error above rounding.
#[test]
fn any_step_size_is_suggested() {
    let (r, pi) = start();
    for wished in [1e-3, 1e-12] {
        let probing = ExactBody { moments: MOMENTS }.stepper(0.1).expect("regular");
        let h = probing.suggest_step_size(&probing.state(r, pi).expect("a state"), wished, 100.0).expect("a step size");
        assert!(h > 1.0, "{h}");
    }
    let probing = ExactBody { moments: MOMENTS }.stepper(0.1).expect("regular");
    let refused = probing.suggest_step_size(&probing.state(r, pi).expect("a state"), 1e-17, 100.0);
    assert!(matches!(refused, Err(Error::BelowRounding { .. })), "{refused:?}");
}

#[test]
fn what_cannot_be_stepped_is_said() {
    let stepper = ExactBody { moments: MOMENTS }.stepper(1.0).expect("regular");
    let state = stepper.state(Matrix3::identity(), Vector3::new(1e10, 0.0, 0.0)).expect("a state");
    assert!(matches!(stepper.step(&state), Err(Error::Unsolvable { .. })));
    assert!(matches!(
        ExactBody { moments: Vector3::new(1.0, 0.0, 2.0) }.stepper(0.1),
        Err(Error::SingularKineticEnergy { .. })
    ));
}

/// A bob on a sphere whose inertia is one number, and the same with a tensor.
mod bobs {
    use clebsch::Clebsch;
    use nalgebra::Matrix3;

    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action         = |F: SO<3>, q: Unit<Vector3>| F * q,
        lagrangian     = |w| self.moment * w.norm_squared() / 2,
        potential      = |q| self.weight * q.z,
        discretization = exact,
        order          = 4,
    )]
    pub struct OfOneMoment {
        pub moment: f64,
        pub weight: f64,
    }

    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action         = |F: SO<3>, q: Unit<Vector3>| F * q,
        lagrangian     = |w| w.dot(&(self.inertia * w)) / 2,
        potential      = |q| self.weight * q.z,
        discretization = exact,
        order          = 4,
    )]
    pub struct OfATensor {
        #[clebsch(symmetric)]
        pub inertia: Matrix3<f64>,
        pub weight: f64,
    }
}

/// An inertia that is one number is the tensor with it on the diagonal: in steps, and in the Legendre transforms.
#[test]
fn one_moment_is_a_tensor() -> Result<(), clebsch::Error> {
    use clebsch::Clebsch;
    use nalgebra::{Matrix3, Rotation3, Vector3};
    let one = bobs::OfOneMoment { moment: 1.7, weight: 2.3 };
    let tensor = bobs::OfATensor { inertia: Matrix3::from_diagonal_element(1.7), weight: 2.3 };
    let (q, mu) = (Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.4, 0.9, -0.3));
    let turn = *Rotation3::from_euler_angles(0.1, -0.2, 0.3).matrix();
    let difference = one.legendre(0.1, 0.0, &q, &turn) - tensor.legendre(0.1, 0.0, &q, &turn);
    assert!(difference.norm() < 1e-13, "{difference}");
    let (one, tensor) = (one.into_stepper(0.1)?, tensor.into_stepper(0.1)?);
    let ends = (one.advance(&one.state(q, mu)?, 100)?, tensor.advance(&tensor.state(q, mu)?, 100)?);
    assert!((ends.0.configuration() - ends.1.configuration()).norm() < 1e-12);
    assert!((ends.0.momentum() - ends.1.momentum()).norm() < 1e-12);
    Ok(())
}
