//! Forces: the discrete Lagrange–d'Alembert equations as they are written, orders against an independent solver, decay
//! and conservation.

mod systems;

use clebsch::{Clebsch, Conserves, Error, Stepper};
use clebsch_tests::oracle::motion::{motion, order};
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::{hat, vee};
use nalgebra::{Matrix3, Matrix4, Rotation3, SMatrix, SVector, Vector1, Vector3};
use systems::{
    Bob, Composed, Damped, DampedByLogarithm, DampedLate, Hill, Pivoted, Rocket, RunAway, Satellite, Sloshing, Vehicle,
    Windy,
};

const NEAR: f64 = 1e-13;
const MOMENTS: Vector3<f64> = Vector3::new(1.0, 1.4, 1.9);
const MASS: Vector3<f64> = Vector3::new(1.0, 1.2, 0.9);
const TORQUE: Vector3<f64> = Vector3::new(0.3, -0.2, 0.5);

/// 2(F − I)(F + I)⁻¹/h
fn cayley_velocity(f: &Matrix3<f64>, h: f64) -> Vector3<f64> {
    let inverse = (f + Matrix3::identity()).try_inverse().expect("a turn by less than π");
    vee(&((f - Matrix3::identity()) * inverse)) * (2.0 / h)
}

/// F⁻ℓd − h⁻f(t, q, ξ) = N and F⁺ℓd + h⁺f(t + h, q⁺, ξ) = N⁺, of a body that acts on itself. The weights of the force
/// are h⁻ and h⁺.
fn lagrange_d_alembert<S>(
    system: S,
    u: &S::Input,
    velocity: impl Fn(&Matrix3<f64>, f64) -> Vector3<f64>,
    force: impl Fn(f64, &Matrix3<f64>, &Vector3<f64>) -> Vector3<f64>,
    at_start: f64,
) where
    S: Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Element = Matrix3<f64>, Momentum = Vector3<f64>>,
{
    let (h, random) = (0.1, &mut Random::new(61));
    let stepper = system.into_stepper(h).expect("a regular body");
    for _ in 0..5 {
        let (r, mu): (Matrix3<f64>, Vector3<f64>) = (random.attitude(), random.vector());
        let next = stepper.step_with(&stepper.state(r, mu).expect("a state"), u).expect("a solvable step");
        let f = r.transpose() * next.configuration();
        let xi = velocity(&f, h);
        let before = stepper.legendre_at(0.0, &r, &f) - force(0.0, &r, &xi) * (h * at_start);
        let after =
            stepper.legendre_next_at(0.0, &r, &f) + force(h, next.configuration(), &xi) * (h * (1.0 - at_start));
        assert_near(&before, &mu, NEAR, S::NAME);
        assert_near(&after, &next.momentum(), NEAR, S::NAME);
        assert!((f - Matrix3::identity()).amax() > 1e-3, "{}: the step moves", S::NAME);
    }
}

#[test]
fn the_equations_of_lagrange_and_d_alembert() {
    let damped = |_: f64, _: &Matrix3<f64>, omega: &Vector3<f64>| TORQUE - omega * 0.7;
    let system = Damped { moments: MOMENTS, damping: 0.7 };
    lagrange_d_alembert(system, &TORQUE, cayley_velocity, damped, 0.5);
    let system = DampedLate { moments: MOMENTS, damping: 0.7 };
    lagrange_d_alembert(system, &TORQUE, cayley_velocity, damped, 0.0);
    let logarithm = |f: &Matrix3<f64>, h: f64| Rotation3::from_matrix_unchecked(*f).scaled_axis() / h;
    let system = DampedByLogarithm { moments: MOMENTS, damping: 0.7 };
    lagrange_d_alembert(system, &TORQUE, logarithm, damped, 0.5);
    let windy = |t: f64, r: &Matrix3<f64>, omega: &Vector3<f64>| {
        r.transpose() * Vector3::new(t.cos(), t.sin(), 0.0) - omega * (0.4 * omega.norm_squared())
    };
    lagrange_d_alembert(Windy { mass: MASS, weight: 0.8, drag: 0.4 }, &(), cayley_velocity, windy, 0.5);
}

#[test]
fn inputs_and_forces_in_parts() {
    let (h, random) = (0.1, &mut Random::new(62));
    let drag = 0.4;
    let system = Vehicle { inertia: MOMENTS, mass: Vector3::new(1.0, 1.5, 2.0), drag };
    let stepper = system.into_stepper(h).expect("a regular vehicle");
    let input = (TORQUE, Vector1::new(0.9));
    for _ in 0..5 {
        let mut q: Matrix4<f64> = random.rotation::<3>(1.0).to_homogeneous();
        q.fixed_view_mut::<3, 1>(0, 3).copy_from(&random.vector::<3>());
        let mu: SVector<f64, 6> = random.vector();
        let next = stepper.step_with(&stepper.state(q, mu).expect("a state"), &input).expect("a solvable step");
        let f = q.try_inverse().expect("a motion") * next.configuration();
        let one = Matrix4::identity();
        let velocity = (f - one) * (f + one).try_inverse().expect("no half turn") * (2.0 / h);
        let omega = vee(&velocity.fixed_view::<3, 3>(0, 0).into_owned());
        let v: Vector3<f64> = velocity.fixed_view::<3, 1>(0, 3).into_owned();
        let mut force = SVector::<f64, 6>::zeros();
        force.fixed_rows_mut::<3>(0).copy_from(&(input.0 - omega * drag));
        force.fixed_rows_mut::<3>(3).copy_from(&(Vector3::x() * input.1.x - v * drag));
        assert_near(&(stepper.legendre(&q, &f) - force * (h / 2.0)), &mu, NEAR, "before");
        assert_near(&(stepper.legendre_next(&q, &f) + force * (h / 2.0)), &next.momentum(), NEAR, "after");
    }
}

/// Without rotation the rocket is a particle with linear drag and thrust: m(v⁺ − v) = h(thrust − drag (v + v⁺)/2) with a/h between.
#[test]
fn linear_drag_and_thrust_on_a_product() {
    let (h, mass, drag) = (0.1, 2.0, 0.6);
    let stepper = Rocket { mass, moment: MASS, drag }.into_stepper(h).expect("a regular rocket");
    let (x, p) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(0.4, -0.2, 0.9));
    let mu = SVector::<f64, 6>::from_fn(|i, _| if i < 3 { p[i] } else { 0.0 });
    let thrust = Vector3::new(0.5, 1.0, -0.7);
    let next = stepper.step_with(&stepper.state((x, Matrix3::identity()), mu).expect("a state"), &thrust);
    let next = next.expect("a solvable step");
    let v = (p + thrust * (h / 2.0)) / (mass + drag * h / 2.0);
    assert_near(&next.configuration().0, &(x + v * h), NEAR, "x⁺");
    let after = v * mass + (thrust - v * drag) * (h / 2.0);
    assert_near(&next.momentum().fixed_rows::<3>(0).into_owned(), &after, NEAR, "p⁺");
    assert_near(&next.configuration().1, &Matrix3::identity(), NEAR, "R⁺");
}

/// The matrix of an attitude whose columns are stacked first in a state.
fn attitude<const N: usize>(y: &SVector<f64, N>) -> Matrix3<f64> {
    Matrix3::from_column_slice(&y.as_slice()[..9])
}

/// (R, π)′ = (R ω^, π × ω + torque(t, R, ω)); the time is the last entry.
fn euler(
    moments: Vector3<f64>,
    torque: impl Fn(f64, &Matrix3<f64>, &Vector3<f64>) -> Vector3<f64>,
) -> impl Fn(&SVector<f64, 13>) -> SVector<f64, 13> {
    move |y| {
        let (r, pi, t) = (attitude(y), Vector3::new(y[9], y[10], y[11]), y[12]);
        let omega = pi.component_div(&moments);
        let (turning, change) = (r * hat(&omega), pi.cross(&omega) + torque(t, &r, &omega));
        SVector::from_fn(|i, _| match i {
            0..9 => turning.as_slice()[i],
            9..12 => change[i - 9],
            _ => 1.0,
        })
    }
}

/// Errors of the attitude after one second with steps that halve.
fn errors<S>(
    stepper: impl Fn(f64) -> Stepper<S>,
    start: (Matrix3<f64>, Vector3<f64>),
    u: &S::Input,
    exact: &Matrix3<f64>,
) -> Vec<f64>
where
    S: Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Momentum = Vector3<f64>>,
{
    let error = |steps: usize| {
        let stepper = stepper(1.0 / steps as f64);
        let start = stepper.state(start.0, start.1).expect("a state");
        let end = (0..steps).fold(start, |state, _| stepper.step_with(&state, u).expect("a solvable step"));
        (end.configuration() - exact).amax()
    };
    [20, 40, 80, 160].map(error).to_vec()
}

/// Gravity gradient, damping and a commanded torque, against a solver whose own error is below 1e-12.
#[test]
fn a_perturbed_attitude_in_orbit_is_of_second_order() {
    let (rate, damping) = (0.9, 0.3);
    let gravity = |t: f64, r: &Matrix3<f64>| {
        let zenith = r.transpose() * Vector3::new((rate * t).cos(), (rate * t).sin(), 0.0);
        zenith.cross(&MOMENTS.component_mul(&zenith)) * (3.0 * rate * rate)
    };
    let f = euler(MOMENTS, |t, r, omega| gravity(t, r) + TORQUE * (rate * t).cos() - omega * damping);
    let mut start = SVector::<f64, 13>::zeros();
    let (r, pi) = (Random::new(63).attitude::<3>(), Vector3::new(0.5, 1.0, -0.3));
    start.as_mut_slice()[..9].copy_from_slice(r.as_slice());
    start.as_mut_slice()[9..12].copy_from_slice(pi.as_slice());
    let exact = motion(&f, start, 1.0, 200);
    let own = (exact - motion(&f, start, 1.0, 100)).amax();
    assert!(own < 1e-12, "the reference is good to {own:.1e}");
    let system = Satellite { moments: MOMENTS, orbital_rate: rate, damping };
    let stepper = |h: f64| system.stepper(h).expect("a regular satellite");
    let errors = errors(stepper, (r, pi), &TORQUE, &attitude(&exact));
    println!("errors {errors:?}, order {:.3}", order(&errors));
    assert!((order(&errors) - 2.0).abs() < 0.02 && errors[3] < 1e-4, "{errors:?}");
}

#[test]
fn composed_steps_with_forces_are_of_second_order_and_late_forces_of_first() {
    let (damping, skew) = (0.5, 0.02);
    let moments = Vector3::new(MASS.y + MASS.z, MASS.z + MASS.x, MASS.x + MASS.y);
    let f = euler(moments, |_, _, omega| TORQUE - omega * damping);
    let mut start = SVector::<f64, 13>::zeros();
    let (r, pi) = (Matrix3::identity(), Vector3::new(0.5, 1.0, -0.3));
    start.as_mut_slice()[..9].copy_from_slice(r.as_slice());
    start.as_mut_slice()[9..12].copy_from_slice(pi.as_slice());
    let exact = attitude(&motion(&f, start, 1.0, 200));
    let composed = Composed { mass: MASS, skew, damping };
    let second = errors(|h| composed.stepper(h).expect("a regular body"), (r, pi), &TORQUE, &exact);
    let late = DampedLate { moments, damping };
    let first = errors(|h| late.stepper(h).expect("a regular body"), (r, pi), &TORQUE, &exact);
    println!("orders {:.3} and {:.3}", order(&second), order(&first));
    assert!((order(&second) - 2.0).abs() < 0.05, "{second:?}");
    assert!((order(&first) - 1.0).abs() < 0.05, "{first:?}");
}

/// q″ on the sphere with gravity, friction and wind: of N = q × q′, N′ = q × (f − ∇V).
#[test]
fn a_bob_in_the_wind_is_of_second_order() {
    let (gravity, drag, wind) = (3.0, 0.4, Vector3::new(0.7, 0.2, -0.1));
    let f = |y: &SVector<f64, 6>| {
        let (q, n) = (Vector3::new(y[0], y[1], y[2]), Vector3::new(y[3], y[4], y[5]));
        let velocity = n.cross(&q);
        let change = q.cross(&(wind - velocity * drag - Vector3::z() * gravity));
        SVector::<f64, 6>::from_fn(|i, _| if i < 3 { velocity[i] } else { change[i - 3] })
    };
    let q = Vector3::new(0.6, 0.0, -0.8);
    let n = q.cross(&Vector3::new(0.3, 0.9, 0.1));
    let start = SVector::<f64, 6>::from_fn(|i, _| if i < 3 { q[i] } else { n[i - 3] });
    let exact = motion(f, start, 1.0, 200);
    let error = |steps: usize| {
        let stepper = Bob { gravity, drag }.into_stepper(1.0 / steps as f64).expect("a regular bob");
        let start = stepper.state(q, n).expect("a state");
        let end = (0..steps).fold(start, |state, _| stepper.step_with(&state, &wind).expect("a solvable step"));
        assert!((end.configuration().norm() - 1.0).abs() < 1e-13);
        (end.configuration() - exact.fixed_rows::<3>(0)).amax()
    };
    let errors = [20, 40, 80, 160].map(error);
    println!("errors {errors:?}, order {:.3}", order(&errors));
    assert!((order(&errors) - 2.0).abs() < 0.05, "{errors:?}");
}

/// Rayleigh damping takes energy in every step of a free body, whatever the step size.
#[test]
fn damping_takes_energy_in_every_step_of_a_free_body() {
    let random = &mut Random::new(64);
    for h in [1e-3, 0.1, 0.5] {
        let stepper = Damped { moments: MOMENTS, damping: 0.2 }.into_stepper(h).expect("a regular body");
        let mut state = stepper.state(random.attitude(), random.vector()).expect("a state");
        for _ in 0..200 {
            let next = stepper.step(&state).expect("a solvable step");
            let (before, after) = (stepper.energy(&state), stepper.energy(&next));
            assert!(after < before, "h = {h}: {before} to {after}");
            state = next;
        }
    }
}

/// With a potential the energy of a step oscillates by itself; the bob ends at rest where the potential is least.
#[test]
fn a_damped_pendulum_comes_to_rest_at_the_bottom() {
    let stepper = Bob { gravity: 3.0, drag: 1.0 }.into_stepper(0.05).expect("a regular bob");
    let q = Vector3::new(0.6, 0.0, 0.8);
    let mut state = stepper.state(q, q.cross(&Vector3::new(0.3, 0.9, 0.1))).expect("a state");
    for _ in 0..2000 {
        state = stepper.step(&state).expect("a solvable step");
    }
    assert_near(state.configuration(), &-Vector3::z(), 1e-12, "the bottom");
    assert!((stepper.energy(&state) + 3.0).abs() < 1e-12);
}

/// Friction inside keeps the length of the momentum up to the error of the scheme, and turns the body to its major axis.
#[test]
fn internal_dissipation_ends_on_the_major_axis() {
    let moments = Vector3::new(1.0, 2.0, 3.0);
    let stepper = Sloshing { moments, loss: 0.5 }.into_stepper(0.05).expect("a regular body");
    let start = stepper.state(Matrix3::identity(), Vector3::new(1.0, 0.05, 0.05)).expect("a state");
    let mut state = start;
    for _ in 0..20_000 {
        let next = stepper.step(&state).expect("a solvable step");
        assert!(stepper.energy(&next) <= stepper.energy(&state) + 1e-15);
        state = next;
    }
    let pi = state.momentum();
    println!("π = {:.6?}, |π| from {:.6} to {:.6}", pi.as_slice(), start.momentum().norm(), pi.norm());
    assert!(pi.z.abs() / pi.norm() > 1.0 - 1e-12, "{pi}");
    assert!((pi.norm() / start.momentum().norm() - 1.0).abs() < 1e-3);
}

/// The momentum about the vertical is found among those that this force does not change, and stays to round-off.
#[test]
fn momenta_on_which_no_force_acts_are_conserved() -> Result<(), Error> {
    let stepper = Pivoted { mass: MASS, weight: 2.0, friction: 0.3 }.into_stepper(0.05)?;
    let random = &mut Random::new(65);
    let start = stepper.state(random.attitude(), random.vector())?;
    let conserved = stepper.conserved(&start);
    assert_eq!(conserved.names(), &["about e3, spatial"]);
    let mut state = start;
    for _ in 0..2000 {
        state = stepper.step(&state)?;
    }
    assert!((stepper.conserved(&state)[0] - conserved[0]).abs() < 1e-12);
    assert!(stepper.energy(&state) < stepper.energy(&start) - 0.1);
    assert!(Damped::DERIVATION.contains("Conserved: no momentum"), "{}", Damped::DERIVATION);
    fn conserves<S: Conserves>() {}
    conserves::<Pivoted>();
    Ok(())
}

#[test]
fn inputs_are_checked_and_no_input_is_zero() -> Result<(), Error> {
    let stepper = Damped { moments: MOMENTS, damping: 0.2 }.into_stepper(0.1)?;
    let state = stepper.state(Matrix3::identity(), Vector3::new(0.3, 0.2, 0.1))?;
    assert_eq!(stepper.step(&state)?, stepper.step_with(&state, &Vector3::zeros())?);
    let broken = stepper.step_with(&state, &Vector3::new(0.0, f64::NAN, 0.0));
    assert_eq!(broken.map(|_| ()), Err(Error::NotFinite { name: "the input" }));
    let cotangent = stepper.cotangent_state(Matrix3::identity(), SMatrix::zeros())?;
    assert_eq!(stepper.step_symmetric(&cotangent).map(|_| ()), Err(Error::NoCovector));
    Ok(())
}

/// Whether a step of h is made, and is `expected`. Otherwise it is refused, with a longest step that is `bound` but for
/// the two per cent of the bracket.
fn assert_bounded<S>(stepper: &Stepper<S>, x: f64, momentum: f64, (expected, bound): (f64, f64))
where
    S: Clebsch<Scalar = f64, Configuration = Vector1<f64>, Momentum = Vector1<f64>> + Clone,
{
    let h = stepper.step_size();
    let state = stepper.state(Vector1::new(x), Vector1::new(momentum)).expect("a state");
    match stepper.step(&state) {
        Ok(next) => {
            assert!(h / bound < 1.0, "{h} is beyond {bound}");
            assert_near(&next.momentum(), &Vector1::new(expected), 1e-12 * expected.abs(), "the step");
        }
        Err(
            Error::Unsolvable { solvable_step: Some(longest), .. }
            | Error::StepTooLong { solvable_step: Some(longest), .. },
        ) => {
            assert!(h / bound > 1.0, "{h} is within {bound}");
            let part = longest / bound;
            assert!((0.97..=1.0).contains(&part), "{longest} for {bound}");
        }
        Err(other) => panic!("{other}"),
    }
}

/// m a/h = N + (h/2) g (a/h − v₀) has one solution at every step size but hg = 2m. Beyond, it is not that of short
/// steps, which has gone to infinity and come back from the other side. A drive that pushes forward would throw the
/// trolley back. With damping the same happens back in time.
#[test]
fn solutions_that_have_come_back_from_infinity_are_refused() -> Result<(), Error> {
    for (gain, mass, sign) in [(2.5, 1.0, 1.0), (0.4, 3.0, 1.0), (-2.5, 1.0, -1.0)] {
        let bound = sign * 2.0 * mass / f64::abs(gain);
        for part in [0.05, 0.5, 0.99, 1.01, 1.5, 4.0] {
            let h: f64 = part * bound;
            let (speed, momentum) = (0.7, 1.3);
            let velocity = (momentum - h / 2.0 * gain * speed) / (mass - h / 2.0 * gain);
            let expected = mass * velocity + h / 2.0 * gain * (velocity - speed);
            let stepper = RunAway { mass, gain, speed }.into_stepper(h)?;
            assert_bounded(&stepper, 0.0, momentum, (expected, bound));
        }
    }
    Ok(())
}

/// The same for a potential in the cost. N = m a/h − (h/2) k (x + a/2), N⁺ = m a/h + (h/2) k (x + a/2), up to h = 2
/// √(m/k).
#[test]
fn a_hill_at_the_midpoint_bounds_the_step() -> Result<(), Error> {
    let (mass, slope, x, momentum): (f64, f64, f64, f64) = (1.3, 2.9, 0.4, -1.1);
    let bound = 2.0 * (mass / slope).sqrt();
    for part in [0.05, 0.5, 0.99, 1.01, 1.5, 4.0] {
        let h = part * bound;
        let a = (momentum + h / 2.0 * slope * x) / (mass / h - h / 4.0 * slope);
        let expected = mass * a / h + h / 2.0 * slope * (x + a / 2.0);
        assert_bounded(&Hill { mass, slope }.into_stepper(h)?, x, momentum, (expected, bound));
    }
    Ok(())
}
