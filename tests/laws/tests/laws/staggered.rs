//! Steps of first order are staggered: read half a kick earlier they are those of second order.
//!
//! Orders are slopes of the largest error over the run against exact motions, at step sizes that halve.

use clebsch::{Clebsch, Error, State, Stepper};
use clebsch_tests::fixtures::first_order_top::FirstOrderTop;
use clebsch_tests::fixtures::free_rigid_body::FreeRigidBody;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::paper_pendulum::PaperPendulum;
use clebsch_tests::oracle::body;
use clebsch_tests::oracle::motion::{motion, order};
use clebsch_tests::oracle::near::{assert_near, distance};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::hat;
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector3};

/// How long motions are followed; steps of the exact motion in this time, and of the coarsest one.
const DURATION: f64 = 1.5;
const FINE: usize = 8 * COARSE;
const COARSE: usize = 100;

/// A pendulum whose gravity is driven, by drift, then kick.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |t, q| (3 + 2 * (4 * t).cos()) * q.z + self.wind * q.x,
    order     = 1,
)]
pub struct FirstOrderDriven {
    pub wind: f64,
}

/// The same by half kicks.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |t, q| (3 + 2 * (4 * t).cos()) * q.z + self.wind * q.x,
)]
pub struct Driven {
    pub wind: f64,
}

/// The mirror: the cost holds a potential at the start, so that a step kicks, then drifts; another potential acts at the end.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, q, F| (F - I).norm_squared() / (4 * h) - h * self.gravity * q.z,
    potential = |q| self.wind * q.x,
    order     = 1,
)]
pub struct FirstOrderMirror {
    pub gravity: f64,
    pub wind: f64,
}

/// The pendulum of both potentials by half kicks.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q.z + self.wind * q.x,
)]
pub struct WindyPendulum {
    pub gravity: f64,
    pub wind: f64,
}

/// A pendulum that friction slows down, by steps of first order.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, q: Unit<Vector3>| F * q,
    lagrangian = |omega| omega.norm_squared() / 2,
    potential  = |q| self.gravity * q.z,
    force      = |omega| -self.friction * omega,
    order      = 1,
)]
pub struct FirstOrderDamped {
    pub gravity: f64,
    pub friction: f64,
}

/// A cost that is not time-symmetric, with a potential.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SL<2>, q: SL<2>| q * F,
    cost      = |h, F| (F - I).dot(&self.weight.component_mul(&(F - I))) / (2 * h),
    potential = |q| q.norm_squared() / 2,
    order     = 1,
)]
pub struct FirstOrderSl2 {
    pub weight: Matrix2<f64>,
}

/// The largest errors over the run: of (q, π), of (q, N), and of the energies of both, where it is conserved.
fn errors<S: Clebsch<Scalar = f64, Momentum = Vector3<f64>>, const N: usize>(
    stepper: &Stepper<S>,
    start: State<S>,
    steps: usize,
    exact: &[SVector<f64, N>],
    flat: &impl Fn(&S::Configuration, &Vector3<f64>) -> SVector<f64, N>,
) -> [f64; 4] {
    let energy = stepper.synchronized_energy(&start);
    let mut largest = [0.0_f64; 4];
    for (k, state) in stepper.trajectory(start).take(steps + 1).enumerate() {
        let state = state.expect("a solvable step");
        let exact = &exact[k * FINE / steps];
        let q = state.configuration();
        let found = [
            distance(&flat(q, &stepper.synchronized(&state)), exact),
            distance(&flat(q, &state.momentum()), exact),
            (stepper.synchronized_energy(&state) - energy).abs(),
            (stepper.energy(&state) - energy).abs(),
        ];
        largest.iter_mut().zip(found).for_each(|(largest, found)| *largest = largest.max(found));
    }
    largest
}

/// The exact motion at every fine step.
fn exact_motion<const N: usize>(
    velocity: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    start: SVector<f64, N>,
) -> Vec<SVector<f64, N>> {
    let mut states = vec![start];
    for k in 0..FINE {
        states.push(motion(&velocity, states[k], DURATION / FINE as f64, 1));
    }
    states
}

/// The measured orders of (q, π), (q, N) and of both energies.
fn orders<S: Clebsch<Scalar = f64, Momentum = Vector3<f64>> + Clone, const N: usize>(
    system: &S,
    (q, pi): (S::Configuration, Vector3<f64>),
    exact: &[SVector<f64, N>],
    flat: impl Fn(&S::Configuration, &Vector3<f64>) -> SVector<f64, N>,
) -> [f64; 4] {
    let runs = [1, 2, 4, 8].map(|finer| {
        let stepper = system.stepper(DURATION / (COARSE * finer) as f64).expect("a regular system");
        let start = stepper.staggered_state(q, pi).expect("a state");
        errors(&stepper, start, COARSE * finer, exact, &flat)
    });
    let orders = [0, 1, 2, 3].map(|which| order(&runs.map(|run| run[which])));
    println!(
        "{}: orders {orders:.3?} of (q, π), (q, N), H(q, π), H(q, N); errors {:?}",
        S::NAME,
        runs[3].map(|error| format!("{error:.1e}"))
    );
    orders
}

#[track_caller]
fn assert_orders(measured: &[f64], expected: &[f64]) {
    let near = measured.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.1);
    assert!(near, "orders {measured:.3?}, not {expected:?}");
}

fn joined<const N: usize>(q: &[f64], pi: &Vector3<f64>) -> SVector<f64, N> {
    SVector::from_iterator(q.iter().chain(pi.iter()).copied())
}

fn flat_pendulum(q: &Vector3<f64>, n: &Vector3<f64>) -> SVector<f64, 6> {
    joined(q.as_slice(), n)
}

fn parts(y: &SVector<f64, 6>) -> (Vector3<f64>, Vector3<f64>) {
    (y.fixed_rows::<3>(0).into(), y.fixed_rows::<3>(3).into())
}

/// A bob of unit mass on a rod of unit length with the gradient of its potential: q' = N × q, N' = −q × g.
fn bob(gradient: impl Fn(&Vector3<f64>) -> Vector3<f64>) -> impl Fn(&SVector<f64, 6>) -> SVector<f64, 6> {
    move |y| {
        let (q, n) = parts(y);
        joined(n.cross(&q).as_slice(), &-q.cross(&gradient(&q)))
    }
}

fn pendulum_start() -> (Vector3<f64>, Vector3<f64>) {
    let q = Vector3::new(0.6, 0.0, 0.8);
    (q, q.cross(&Vector3::new(0.3, 1.0, -0.5)))
}

fn top_start() -> (Matrix3<f64>, Vector3<f64>) {
    (Random::new(71).attitude::<3>(), Vector3::new(1.5, -2.0, 3.0))
}

fn first_order_top() -> FirstOrderTop {
    let mut random = Random::new(72);
    FirstOrderTop { mass_matrix: random.inertia(), weight: 3.0, center: random.vector() }
}

#[test]
fn tops_are_read_to_second_order() {
    let top = first_order_top();
    let FirstOrderTop { mass_matrix, weight, center } = top.clone();
    let inverse = body::inertia(&mass_matrix).try_inverse().expect("a regular tensor");
    let flat = |r: &Matrix3<f64>, pi: &Vector3<f64>| -> SVector<f64, 12> { joined(r.as_slice(), pi) };
    let velocity = |y: &SVector<f64, 12>| {
        let (r, pi) = (Matrix3::from_column_slice(&y.as_slice()[..9]), Vector3::new(y[9], y[10], y[11]));
        let omega = inverse * pi;
        flat(&(r * hat(&omega)), &(pi.cross(&omega) + body::gravity_torque(weight, &center, &r)))
    };
    let (r, pi) = top_start();
    let exact = exact_motion(velocity, flat(&r, &pi));
    assert_orders(&orders(&top, (r, pi), &exact, flat), &[2.0, 1.0, 2.0, 1.0]);
}

#[test]
fn pendulums_are_read_to_second_order() {
    let (q, n) = pendulum_start();
    // twice the Lagrangian: momenta are 2N
    let flat = |q: &Vector3<f64>, mu: &Vector3<f64>| flat_pendulum(q, &(mu / 2.0));
    let exact = exact_motion(bob(|_| Vector3::z() * 9.81), flat_pendulum(&q, &n));
    assert_orders(&orders(&PaperPendulum { gravity: 9.81 }, (q, n * 2.0), &exact, flat), &[2.0, 1.0, 2.0, 1.0]);
    let exact = exact_motion(bob(|_| Vector3::new(1.5, 0.0, 4.0)), flat_pendulum(&q, &n));
    let mirror = FirstOrderMirror { gravity: 4.0, wind: 1.5 };
    assert_orders(&orders(&mirror, (q, n), &exact, flat_pendulum), &[2.0, 1.0, 2.0, 1.0]);
}

/// The kick is that of the time of the configuration. A driven pendulum has no conserved energy.
#[test]
fn driven_pendulums_are_read_to_second_order() {
    let (q, n) = pendulum_start();
    let velocity = |y: &SVector<f64, 7>| {
        let (q, n) = parts(&y.fixed_rows::<6>(0).into());
        let gradient = Vector3::new(0.7, 0.0, 3.0 + 2.0 * (4.0 * y[6]).cos());
        let of_bob = bob(|_| gradient)(&joined(q.as_slice(), &n));
        SVector::<f64, 7>::from_iterator(of_bob.iter().copied().chain([1.0]))
    };
    let start = SVector::from_iterator(flat_pendulum(&q, &n).iter().copied().chain([0.0]));
    let exact: Vec<SVector<f64, 6>> =
        exact_motion(velocity, start).iter().map(|y| y.fixed_rows::<6>(0).into()).collect();
    let measured = orders(&FirstOrderDriven { wind: 0.7 }, (q, n), &exact, flat_pendulum);
    assert_orders(&measured[..2], &[2.0, 1.0]);
}

/// A force is taken at the velocity of the drift before it: the reading stays of first order, and `DERIVATION` says so.
#[test]
fn forced_motions_stay_of_first_order() {
    let (q, n) = pendulum_start();
    let velocity = |y: &SVector<f64, 6>| {
        let (q, n) = parts(y);
        joined(n.cross(&q).as_slice(), &(-q.cross(&Vector3::z()) * 4.0 - n * 0.8))
    };
    let exact = exact_motion(velocity, flat_pendulum(&q, &n));
    let damped = FirstOrderDamped { gravity: 4.0, friction: 0.8 };
    assert_orders(&orders(&damped, (q, n), &exact, flat_pendulum)[..2], &[1.0, 1.0]);
    assert!(FirstOrderDamped::DERIVATION.contains("stays of first order, as the force acts"));
    assert!(FirstOrderSl2::DERIVATION.contains("stays of first order, as the cost is not time-symmetric"));
    for of_second in [FirstOrderTop::DERIVATION, FirstOrderDriven::DERIVATION, FirstOrderMirror::DERIVATION] {
        assert!(!of_second.contains("stays of first order") && of_second.contains("`synchronized` reads π"));
    }
}

/// Both steps make the same configurations and momenta, whatever h is.
#[track_caller]
fn assert_same_motion<S, P, const R: usize, const C: usize>(
    first: &Stepper<S>,
    second: &Stepper<P>,
    starts: Starts<S, P>,
) where
    S: Clebsch<Scalar = f64, Momentum = Vector3<f64>, Configuration = SMatrix<f64, R, C>>,
    P: Clebsch<Scalar = f64, Momentum = Vector3<f64>, Configuration = SMatrix<f64, R, C>>,
{
    let (mut staggered, mut state) = starts;
    assert_near(&first.synchronized(&staggered), &state.momentum(), 1e-15, "the start");
    for _ in 0..200 {
        (staggered, state) = (first.step(&staggered).expect("a step"), second.step(&state).expect("a step"));
        assert_near(staggered.configuration(), state.configuration(), 1e-12, S::NAME);
        assert_near(&first.synchronized(&staggered), &state.momentum(), 1e-12, S::NAME);
        assert!(
            distance(&staggered.momentum(), &state.momentum()) > 1e-4,
            "a momentum that is not ahead shows nothing"
        );
        let energies = first.synchronized_energy(&staggered) - second.energy(&state);
        assert!(energies.abs() < 1e-11, "{}: energies {energies:.1e} apart", S::NAME);
    }
}

type Starts<S, P> = (State<S>, State<P>);

#[test]
fn both_orders_make_the_same_motion() -> Result<(), Error> {
    let top = first_order_top();
    let FirstOrderTop { mass_matrix, weight, center } = top.clone();
    let (first, second) = (top.stepper(0.02)?, HeavyTop { mass_matrix, weight, center }.stepper(0.02)?);
    let (r, pi) = top_start();
    assert_same_motion(&first, &second, (first.staggered_state(r, pi)?, second.state(r, pi)?));

    let (q, n) = pendulum_start();
    let (gravity, wind) = (4.0, 1.5);
    for h in [0.03, -0.03] {
        let (first, second) =
            (FirstOrderMirror { gravity, wind }.stepper(h)?, WindyPendulum { gravity, wind }.stepper(h)?);
        assert_same_motion(&first, &second, (first.staggered_state(q, n)?, second.state(q, n)?));
        // the clock of a state that starts later is that of its kicks
        let (first, second) = (FirstOrderDriven { wind }.stepper(h)?, Driven { wind }.stepper(h)?);
        assert_same_motion(&first, &second, (first.staggered_state_at(0.4, q, n)?, second.state_at(0.4, q, n)?));
    }
    Ok(())
}

/// Where the momentum is not ahead, all of it is as it is without.
#[test]
fn other_orders_are_synchronized() -> Result<(), Error> {
    fn assert_synchronized<S: Clebsch<Scalar = f64>>(stepper: &Stepper<S>, (q, mu): (S::Configuration, S::Momentum)) {
        let state = stepper.staggered_state(q, mu).and_then(|state| stepper.step(&state)).expect("a step");
        assert_eq!(Ok(state), stepper.state(q, mu).and_then(|state| stepper.step(&state)));
        assert_eq!(stepper.synchronized(&state), state.momentum());
        assert_eq!(stepper.synchronized_energy(&state), stepper.energy(&state));
    }
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.8));
    assert_synchronized(&FreeRigidBody { inertia }.stepper(0.01)?, top_start());
    let FirstOrderTop { mass_matrix, weight, center } = first_order_top();
    assert_synchronized(&HeavyTop { mass_matrix, weight, center }.stepper(0.01)?, top_start());
    assert_synchronized(&Driven { wind: 1.0 }.stepper(0.01)?, pendulum_start());
    Ok(())
}

/// Refusals are those of `state`.
#[test]
fn starts_are_checked() -> Result<(), Error> {
    let (q, n) = pendulum_start();
    let stepper = FirstOrderDriven { wind: 1.0 }.stepper(0.01)?;
    let named = |error: Result<State<FirstOrderDriven>, Error>| error.expect_err("a refusal");
    assert!(matches!(named(stepper.staggered_state(q * 2.0, n)), Error::OffOrbit { .. }));
    assert!(matches!(named(stepper.staggered_state(q, n + q)), Error::OutsideMomentumSpace { .. }));
    let time = named(stepper.staggered_state_at(f64::NAN, q, n));
    assert_eq!(time, Error::NotFinite { name: "the time" });
    let top = FirstOrderTop { weight: f64::MAX, center: Vector3::new(4.0, 4.0, 4.0), ..first_order_top() };
    let (r, pi) = top_start();
    let gradient = top.stepper(1.0)?.staggered_state(r, pi).expect_err("a refusal");
    assert_eq!(gradient, Error::NotFinite { name: "the gradient of the potential at the configuration" });
    Ok(())
}
