//! Systems that have one form alone, for they are too large to be written out: their steps keep what theory says that they keep.

use clebsch::{Clebsch, Conserves};
use clebsch_tests::oracle::random::Random;
use nalgebra::{SMatrix, SVector};

const H: f64 = 0.02;

/// Linear optics of four planes.
#[derive(Clebsch, Clone)]
#[clebsch(action = |F: Sp<8>, q: Sp<8>| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h), scalar = f64)]
struct Optics;

/// Dirichlet's fluid ellipsoid in six dimensions; a cost that couples configuration and group element.
#[derive(Clebsch, Clone)]
#[clebsch(action = |F: SL<6>, q: SL<6>| F * q, cost = |h, q, F| self.mass * (F * q - q).norm_squared() / (2 * h))]
struct Ellipsoid {
    mass: f64,
}

/// A body in ten dimensions.
#[derive(Clebsch, Clone)]
#[clebsch(
    action = |F: SO<10>, R: SO<10>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
)]
struct Body {
    #[clebsch(symmetric)]
    j_d: SMatrix<f64, 10, 10>,
}

/// A point on S¹⁰⁰ in a field along its last axis.
#[derive(Clebsch, Clone)]
#[clebsch(
    action    = |F: SO<101>, q: Unit<SVector<101>>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q[100],
)]
struct Pendulum {
    gravity: f64,
}

/// What is conserved stays to round-off over so many steps from the identity.
fn conserves<S, const N: usize, const M: usize, const K: usize>(system: S, size: f64)
where
    S: Conserves<
            Scalar = f64,
            Configuration = SMatrix<f64, N, N>,
            Element = SMatrix<f64, N, N>,
            Momentum = SVector<f64, M>,
            Conserved = clebsch::Conserved<f64, K>,
            Input = (),
            Time = (),
        > + Clone,
{
    let (q, mu) = (SMatrix::identity(), Random::new(3).vector::<M>() * size);
    let constants = system.constants(H).expect("constants");
    let f = system.inverse_legendre(&constants, 0.0, &q, &mu).expect("a motion");
    assert!((system.legendre(H, 0.0, &q, &f) - mu).amax() < 1e-12, "F⁻ℓd inverted");
    let stepper = system.stepper(H).expect("a regular system");
    let mut state = stepper.state(q, mu).expect("a state");
    let (before, energy) = (stepper.conserved(&state), stepper.energy(&state));
    for _ in 0..50 {
        state = stepper.step(&state).expect("a step");
    }
    assert!((state.configuration() - q).amax() > 0.1, "it moves");
    let after = stepper.conserved(&state);
    let drift = before.values().iter().zip(after.values()).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(K > 0 && drift < 1e-12, "{} conserved momenta drift by {drift:e}", K);
    assert!((stepper.energy(&state) / energy - 1.0).abs() < 1e-2, "the energy oscillates");
}

#[test]
fn momenta_of_linear_optics_stay() {
    conserves(Optics, 0.3);
}

#[test]
fn momentum_and_circulation_of_an_ellipsoid_stay() {
    conserves(Ellipsoid { mass: 1.3 }, 0.2);
}

#[test]
fn the_spatial_momentum_of_a_body_stays() {
    let j_d = SMatrix::from_fn(|i, j| if i == j { 0.5 + 0.1 * i as f64 } else { 0.02 });
    conserves(Body { j_d }, 2.0);
}

/// With a field along one axis the motion stays in the plane of the start: that of the pendulum in three dimensions, from the same
/// two-step formula of the theory, in its own numbers.
#[test]
fn a_pendulum_of_a_hundred_dimensions_is_one_of_three() {
    // states of 40 kB are copied through the calls of code that is not optimised: more than the 2 MB of a thread of tests
    let thread = std::thread::Builder::new().stack_size(8 << 20).spawn(pendulums_agree).expect("a thread");
    thread.join().expect("what holds of pendulums");
}

fn pendulums_agree() {
    let pendulum = Pendulum { gravity: 2.0 };
    let place = |x: f64, y: f64, z: f64| {
        SVector::<f64, 101>::from_fn(|i, _| match i {
            17 => x,
            60 => y,
            100 => z,
            _ => 0.0,
        })
    };
    let (q, w) = (place(0.6, 0.0, 0.8), place(0.4, 0.5, -0.3));
    let mu = pendulum.momentum_map(&q, &w);
    let stepper = pendulum.clone().into_stepper(H).expect("a pendulum");
    let mut state = stepper.state(q, mu).expect("a state");
    let (mut x, mut v) = ([0.6, 0.0, 0.8], [0.4, 0.5, -0.3]);
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let kick = |x: &[f64; 3], v: &mut [f64; 3]| {
        v[2] -= H / 2.0 * 2.0;
        let along = dot(x, v);
        (0..3).for_each(|i| v[i] -= along * x[i]);
    };
    for _ in 0..200 {
        state = stepper.step(&state).expect("a step");
        kick(&x, &mut v);
        let (square, before) = (dot(&v, &v), x);
        let cosine = (1.0 - H * H * square).sqrt();
        (0..3).for_each(|i| x[i] = cosine * x[i] + H * v[i]);
        (0..3).for_each(|i| v[i] = cosine * v[i] - H * square * before[i]);
        kick(&x, &mut v);
    }
    assert!((state.configuration() - place(x[0], x[1], x[2])).amax() < 1e-12);
    let expected = pendulum.momentum_map(state.configuration(), &place(v[0], v[1], v[2]));
    assert!((state.momentum() - expected).amax() < 1e-12);
    let start = stepper.state(q, mu).expect("a state");
    let together = stepper.advance(&start, 200).expect("steps");
    assert!((together.configuration() - state.configuration()).amax() < 1e-12, "all at once");
    // rotations that leave the axis alone: all but those of the last column
    assert_eq!(stepper.conserved(&start).values().len(), 100 * 99 / 2);
    assert!(stepper.conserved(&start).names()[0] == "in the plane of e1 and e2, spatial");
    // only what is perpendicular to q is a momentum of the point
    let outside = SVector::<f64, 5050>::from_fn(|k, _| if k == 3 { 1.0 } else { 0.0 });
    assert!(stepper.state(q, outside).is_err());
    assert!(stepper.state(q, stepper.project(&q, &outside).expect("a projection")).is_ok());
    let error = stepper.step(&stepper.state(q, mu * 100.0).expect("a state")).expect_err("too long a step");
    assert!(matches!(error, clebsch::Error::Unsolvable { .. }), "{error}");
}
