//! Systems that have one form alone, for they are too large to be unrolled: their steps conserve the invariants of the
//! theory.

use clebsch::{Clebsch, Conserves, Error, F64x4, Space};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::stepping::Stepping;
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

/// The same, solved by Newton's method with Sylvester's equation for each correction.
#[derive(Clebsch, Clone)]
#[clebsch(
    action = |F: SO<10>, R: SO<10>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
    solver = newton,
)]
struct BodyByNewton {
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

/// Conserved momenta stay to round-off over so many steps from the identity.
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
    let constants = system.step_constants(H).expect("constants");
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

/// A body in five dimensions, of any numbers.
#[derive(Clebsch, Clone)]
#[clebsch(
    action = |F: SO<5>, R: SO<5>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
    code   = matrices,
)]
struct WideBody<T> {
    #[clebsch(symmetric)]
    j_d: SMatrix<T, 5, 5>,
}

/// A point on S⁵ in a field along an axis, of any numbers.
#[derive(Clebsch, Clone)]
#[clebsch(
    action    = |F: SO<6>, q: Unit<SVector<6>>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q[5],
    code      = matrices,
)]
struct WidePendulum<T> {
    gravity: T,
}

/// Lanes have the bits of single numbers, and single precision is near double precision.
#[test]
fn all_kinds_of_numbers_are_stepped() {
    let mut random = Random::new(5);
    let j_d = SMatrix::<f64, 5, 5>::from_fn(|i, j| if i == j { 0.5 + 0.1 * i as f64 } else { 0.02 });
    let momenta: [SVector<f64, 10>; 4] = std::array::from_fn(|_| random.vector());
    let alone = WideBody { j_d }.into_stepper(H).expect("a body");
    let lanes = WideBody { j_d: j_d.map(F64x4::splat) }.into_stepper(F64x4::splat(H)).expect("bodies");
    let single = WideBody { j_d: j_d.cast::<f32>() }.into_stepper(H as f32).expect("a body");
    let mu = SVector::<F64x4, 10>::side_by_side(|lane| momenta[lane]);
    let mut wide = lanes.state(SMatrix::from_diagonal_element(F64x4::splat(1.0)), mu).expect("states");
    (0..20).for_each(|_| wide = lanes.step(&wide).expect("steps"));
    for (lane, mu) in momenta.iter().enumerate() {
        let mut state = alone.state(SMatrix::identity(), *mu).expect("a state");
        let mut rough = single.state(SMatrix::identity(), mu.cast()).expect("a state");
        for _ in 0..20 {
            state = alone.step(&state).expect("a step");
            rough = single.step(&rough).expect("a step");
        }
        assert_eq!(wide.lane(lane), (*state.configuration(), state.momentum()));
        assert!((rough.configuration().cast::<f64>() - state.configuration()).amax() < 1e-5);
    }

    let start = |k: usize| SVector::<f64, 6>::from_fn(|i, _| if i == k { 1.0 } else { 0.0 });
    let alone = WidePendulum { gravity: 2.0 }.into_stepper(H).expect("a pendulum");
    let lanes = WidePendulum { gravity: F64x4::splat(2.0) }.into_stepper(F64x4::splat(H)).expect("pendulums");
    let momentum = |lane: usize| alone.system().momentum_map(&start(lane), &(start(5) * 0.3 + start(4) * 0.7));
    let q = SVector::<F64x4, 6>::side_by_side(start);
    let mu = SVector::<F64x4, 15>::side_by_side(momentum);
    let wide = lanes.advance(&lanes.state(q, mu).expect("states"), 20).expect("steps");
    for lane in 0..4 {
        let state = alone.state(start(lane), momentum(lane)).expect("a state");
        let state = alone.advance(&state, 20).expect("steps");
        assert_eq!(wide.lane(lane), (*state.configuration(), state.momentum()));
    }
}

/// With a field along one axis the motion stays in the plane of the start. It is that of the pendulum in three
/// dimensions, from the same two-step formula of the theory, in its own numbers.
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
    // only vectors perpendicular to q are momenta of the point
    let outside = SVector::<f64, 5050>::from_fn(|k, _| if k == 3 { 1.0 } else { 0.0 });
    assert!(stepper.state(q, outside).is_err());
    assert!(stepper.project(q, outside).is_ok());
    let error = stepper.step(&stepper.state(q, mu * 100.0).expect("a state")).expect_err("too long a step");
    assert!(matches!(error, clebsch::Error::Unsolvable { .. }), "{error}");
}

/// Two solvers that have nothing in common but the residual find the same motion, at three speeds.
#[test]
fn newtons_method_finds_the_steps_of_the_fixed_point() {
    let random = &mut Random::new(8);
    let spread: SMatrix<f64, 10, 10> = random.matrix();
    let j_d = SMatrix::identity() + spread * spread.transpose() * 0.2;
    for size in [1.0, 5.0, 20.0] {
        let (q, mu) = (SMatrix::identity(), random.vector::<45>() * size);
        let first = Body { j_d }.stepper(H).expect("a regular body");
        let second = BodyByNewton { j_d }.stepper(H).expect("a regular body");
        let (mut one, mut other) = (first.state(q, mu).expect("a state"), second.state(q, mu).expect("a state"));
        for _ in 0..20 {
            one = first.step(&one).expect("a step");
            other = second.step(&other).expect("a step");
        }
        let apart = (one.configuration() - other.configuration()).amax();
        assert!(apart < 1e-13, "{apart:e} at {size}");
        assert!((one.momentum() - other.momentum()).amax() < 1e-13 * size);
    }
}

/// A body in seven dimensions with drag, by Newton's method with Sylvester's equation.
#[derive(Clebsch, Clone)]
#[clebsch(
    action = |F: SO<7>, R: SO<7>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
    force  = |xi| -self.drag * xi,
    solver = newton,
)]
struct DraggedBody {
    #[clebsch(symmetric)]
    j_d: SMatrix<f64, 7, 7>,
    drag: f64,
}

/// In the plane of two axes half of h·f acts at each end, at the velocity 2 tan(θ/2)/h. So m = 2(j₁ + j₂) sin θ/h +
/// drag tan(θ/2), and m⁺ is that with the other sign.
#[test]
fn drag_slows_down_a_permanent_rotation() {
    let (drag, h) = (0.7, 0.3);
    let j_d = SMatrix::<f64, 7, 7>::from_diagonal(&SVector::from_fn(|i, _| 1.0 + 0.5 * i as f64));
    let stepper = DraggedBody { j_d, drag }.stepper(h).expect("a regular body");
    let mut m = 3.0;
    let mu = SVector::<f64, 21>::from_fn(|k, _| if k == 0 { m } else { 0.0 });
    let mut state = stepper.state(SMatrix::identity(), mu).expect("a state");
    let mut turned = 0.0_f64;
    for _ in 0..40 {
        // x = tan(θ/2) has sin θ = 2x/(1 + x²)
        let (inertial, drags) = (|x: f64| 10.0 / h * x / (1.0 + x * x), |x: f64| drag * x);
        let (mut below, mut above) = (0.0_f64, 1.0_f64);
        for _ in 0..60 {
            let middle = 0.5 * (below + above);
            if inertial(middle) + drags(middle) < m { below = middle } else { above = middle }
        }
        m = inertial(below) - drags(below);
        turned += 2.0 * below.atan();
        state = stepper.step(&state).expect("a step");
        let momentum = state.momentum();
        assert!((momentum[0] - m).abs() < 1e-13 && momentum.rows(1, 20).amax() < 1e-14, "{} is not {m}", momentum[0]);
    }
    assert!(m < 1.0 && (state.configuration()[(0, 0)] - turned.cos()).abs() < 1e-12, "{m}, {turned}");
}

/// Permanent rotations in the plane of two axes: the angle has the sine hm/2(j₁ + j₂), and beyond a right angle there is none.
#[test]
fn permanent_rotations_end_at_a_right_angle() {
    let j_d = SMatrix::<f64, 10, 10>::from_diagonal(&SVector::from_fn(|i, _| 1.0 + 0.5 * i as f64));
    // the component of the first plane
    let most = 2.0 * (1.0 + 1.5) / H;
    let stepper = Body { j_d }.stepper(H).expect("a regular body");
    let angle = |part: f64| {
        let momentum = SVector::from_fn(|i, _| if i == 0 { part * most } else { 0.0 });
        let state = stepper.state(SMatrix::identity(), momentum).expect("a state");
        stepper.step(&state).map(|next| next.configuration()[(1, 0)])
    };
    // a root at the end: rounding is magnified by its slope
    for (part, tolerance) in [(0.1, 1e-15), (0.9, 1e-14), (0.999, 1e-13), (1.0 - 1e-9, 1e-9)] {
        let sine = angle(part).expect("a rotation by less than a right angle");
        assert!((sine.abs() - part).abs() < tolerance, "{part}: {sine}");
    }
    for part in [1.001, 1.5, 30.0] {
        match angle(part) {
            Err(Error::Unsolvable { solvable_fraction, .. }) => {
                assert!((solvable_fraction * part - 1.0).abs() < 1e-3, "{part}: {solvable_fraction}");
            }
            other => panic!("{part}: {other:?}"),
        }
    }
}
