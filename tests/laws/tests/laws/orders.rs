//! Measured orders on nonlinear problems: slopes of the error at a fixed time, for steps that halve, against exact motions.
//!
//! Errors lie between 1e-7 and 1e-1: above round-off, and below where the next power of h shows by more than a tenth.

use clebsch::Clebsch;
use clebsch_tests::fixtures::first_order_top::FirstOrderTop;
use clebsch_tests::fixtures::free_rigid_body::FreeRigidBody;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::neumann::Neumann;
use clebsch_tests::fixtures::paper_pendulum::PaperPendulum;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::fixtures::two_bodies::TwoBodies;
use clebsch_tests::fixtures::two_pendulums::TwoPendulums;
use clebsch_tests::oracle::body;
use clebsch_tests::oracle::motion::{motion, order};
use clebsch_tests::oracle::near::distance;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::{components, hat};
use nalgebra::{Matrix3, Matrix4, SVector, Vector3, Vector4, Vector6};

/// Measures the slope of the error at t = 1 and holds it against the order that is declared.
fn assert_order<S: Clebsch<Scalar = f64> + Clone>(
    system: &S,
    (q, mu): (S::Configuration, S::Momentum),
    error: impl Fn(&S::Configuration, &S::Momentum) -> f64,
) {
    let at = |steps: usize| {
        let stepper = system.stepper(1.0 / steps as f64).expect("a regular system");
        let mut state = stepper.state(q, mu).expect("a state");
        for _ in 0..steps {
            state = stepper.step(&state).expect("a solvable step");
        }
        error(state.configuration(), &state.momentum())
    };
    let errors = [64, 128, 256, 512].map(at);
    let measured = order(&errors);
    let list: Vec<String> = errors.iter().map(|error| format!("{error:.1e}")).collect();
    println!("{}: order {measured:.3}, errors {}", S::NAME, list.join(" "));
    assert!((measured - f64::from(S::ORDER)).abs() < 0.1, "{}: {measured:.3}, not {}", S::NAME, S::ORDER);
    assert!(errors[3] > 1e-8 && errors[0] < 0.5, "{}: errors {errors:?} do not show an order", S::NAME);
}

/// The numbers of several vectors and matrices in one vector.
fn flat<const N: usize>(parts: &[&[f64]]) -> SVector<f64, N> {
    SVector::from_iterator(parts.iter().flat_map(|part| part.iter().copied()))
}

fn three<const N: usize>(y: &SVector<f64, N>, at: usize) -> Vector3<f64> {
    Vector3::new(y[at], y[at + 1], y[at + 2])
}

/// R' = R ω^, π' = π × ω + torque.
fn exact_body(
    inertia: Matrix3<f64>,
    torque: impl Fn(&Matrix3<f64>) -> Vector3<f64>,
    (r, pi): (Matrix3<f64>, Vector3<f64>),
) -> SVector<f64, 12> {
    let inverse = inertia.try_inverse().expect("a regular tensor");
    let velocity = |y: &SVector<f64, 12>| {
        let (r, pi) = (Matrix3::from_column_slice(&y.as_slice()[..9]), three(y, 9));
        let omega = inverse * pi;
        flat(&[(r * hat(&omega)).as_slice(), (pi.cross(&omega) + torque(&r)).as_slice()])
    };
    motion(velocity, flat(&[r.as_slice(), pi.as_slice()]), 1.0, 200)
}

#[test]
fn rigid_bodies() {
    let mut random = Random::new(41);
    let (mass_matrix, weight, center) = (random.inertia(), 3.0, random.vector());
    let inertia = body::inertia(&mass_matrix);
    let start = (random.attitude::<3>(), Vector3::new(1.5, -2.0, 3.0));
    let error = |exact: SVector<f64, 12>| {
        move |r: &Matrix3<f64>, pi: &Vector3<f64>| distance(&flat(&[r.as_slice(), pi.as_slice()]), &exact)
    };
    let exact = exact_body(inertia, |r| body::gravity_torque(weight, &center, r), start);
    assert_order(&HeavyTop { mass_matrix, weight, center }, start, error(exact));
    assert_order(&FirstOrderTop { mass_matrix, weight, center }, start, error(exact));
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.8));
    let exact = exact_body(inertia, |_| Vector3::zeros(), start);
    assert_order(&FreeRigidBody { inertia }, start, error(exact));
}

#[test]
fn spherical_pendulums() {
    let (q, n) = (Vector3::y(), Vector3::new(1.0, 0.0, 0.5));
    // unit mass, length 1/2 and g = 4: q' = N × q/I, N' = −m g l q × e_z with I = 1/4
    let pendulum = SphericalPendulum { mass: 1.0, length: 0.5, gravity: 4.0 };
    let velocity = |inertia: f64, weight: f64| {
        move |y: &SVector<f64, 6>| {
            let (q, n) = (three(y, 0), three(y, 3));
            flat(&[(n.cross(&q) / inertia).as_slice(), (-q.cross(&Vector3::z()) * weight).as_slice()])
        }
    };
    let error = |exact: SVector<f64, 6>, scale: f64| {
        move |q: &Vector3<f64>, n: &Vector3<f64>| distance(&flat(&[q.as_slice(), (n / scale).as_slice()]), &exact)
    };
    let n_of_half = n * 0.25;
    let exact = motion(velocity(0.25, 2.0), flat(&[q.as_slice(), n_of_half.as_slice()]), 1.0, 200);
    assert_order(&pendulum, (q, n_of_half), error(exact, 1.0));
    let exact = motion(velocity(1.0, 9.81), flat(&[q.as_slice(), n.as_slice()]), 1.0, 200);
    assert_order(&PaperPendulum { gravity: 9.81 }, (q, n * 2.0), error(exact, 2.0));
}

/// Covariance matrices with the affine-invariant metric, in which ξP is symmetric for a momentum of a motion.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: GL<3>, P: Matrix3| F * P * F.transpose(),
    lagrangian = |P, xi| (xi.matrix() * P * xi.matrix().transpose() * P.inverse()).trace(),
    scalar     = f64,
)]
struct Covariance;

/// The geodesic with P(0) = P and P'(0) = V is P^½ exp(t P^-½ V P^-½) P^½.
#[test]
fn geodesics_of_covariances() {
    let mut random = Random::new(43);
    let start: Matrix3<f64> = random.inertia();
    let slope: Matrix3<f64> = random.matrix();
    let slope = slope + slope.transpose();
    let of = |matrix: Matrix3<f64>, function: fn(f64) -> f64| {
        let eigen = matrix.symmetric_eigen();
        eigen.eigenvectors * Matrix3::from_diagonal(&eigen.eigenvalues.map(function)) * eigen.eigenvectors.transpose()
    };
    let (root, inverse) = (of(start, f64::sqrt), of(start, |x| 1.0 / x.sqrt()));
    let end = root * of(inverse * slope * inverse, f64::exp) * root;
    // P' = ξP + Pξᵀ with a constant ξ, and μ = 2 P⁻¹ξP entry by entry
    let xi = slope * inverse * inverse / 2.0;
    let momentum = |p: &Matrix3<f64>| {
        let matrix = of(*p, |x| 1.0 / x) * xi * p * 2.0;
        SVector::<f64, 9>::from_column_slice(matrix.transpose().as_slice())
    };
    let error = |p: &Matrix3<f64>, mu: &SVector<f64, 9>| distance(p, &end).max(distance(mu, &momentum(&end)));
    assert_order(&Covariance, (start, momentum(&start)), error);
}

/// `Neumann` by the papers' step.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<4>, q: Unit<Vector4>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| q.dot(&(self.stiffness * q)) / 2,
    order     = 1,
)]
pub struct FirstOrderNeumann {
    #[clebsch(symmetric)]
    pub stiffness: Matrix4<f64>,
}

#[test]
fn neumann() {
    let mut random = Random::new(42);
    let stiffness = Matrix4::from_diagonal(&Vector4::new(1.0, 3.0, 6.0, 10.0)) + random.inertia::<4>();
    let q = random.unit::<4>();
    let w = random.vector::<4>() * 2.0;
    let w = w - q * q.dot(&w);
    let velocity = |y: &SVector<f64, 8>| {
        let (q, w): (Vector4<f64>, Vector4<f64>) = (y.fixed_rows::<4>(0).into(), y.fixed_rows::<4>(4).into());
        let g = stiffness * q;
        let acceleration = -q * w.norm_squared() - (g - q * q.dot(&g));
        flat(&[w.as_slice(), acceleration.as_slice()])
    };
    let exact = motion(velocity, flat(&[q.as_slice(), w.as_slice()]), 1.0, 200);
    let momentum = |q: Vector4<f64>, w: Vector4<f64>| -> Vector6<f64> {
        components(&((w * q.transpose() - q * w.transpose()) / 2.0))
    };
    let end: (Vector4<f64>, Vector4<f64>) = (exact.fixed_rows::<4>(0).into(), exact.fixed_rows::<4>(4).into());
    let error = |q: &Vector4<f64>, mu: &Vector6<f64>| distance(q, &end.0).max(distance(mu, &momentum(end.0, end.1)));
    assert_order(&Neumann { stiffness }, (q, momentum(q, w)), error);
    #[cfg(feature = "heavy")]
    assert_order(&FirstOrderNeumann { stiffness }, (q, momentum(q, w)), error);
}

/// `TwoPendulums` by the papers' step.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(F, G): (SO<3>, SO<3>), (p, q): (Unit<Vector3>, Unit<Vector3>)| (F * p, G * q),
    cost      = |h, (F, G)| (self.mass[0] * (F - I).norm_squared() + self.mass[1] * (G - I).norm_squared()) / (4 * h),
    potential = |(p, q)| self.gravity * (self.mass[0] * p.z + self.mass[1] * q.z) + p.dot(&self.coupling.component_mul(&q)),
    order     = 1,
)]
pub struct FirstOrderPendulums {
    pub mass: [f64; 2],
    pub gravity: f64,
    pub coupling: Vector3<f64>,
}

#[test]
fn two_pendulums() {
    let mut random = Random::new(43);
    let (mass, gravity, coupling) = ([1.0, 0.6], 5.0, Vector3::new(1.0, -2.0, 1.5));
    let q = [random.unit::<3>(), random.unit::<3>()];
    let n = q.map(|q| q.cross(&random.vector()) * 2.0);
    let velocity = |y: &SVector<f64, 12>| {
        let (q, n) = ([three(y, 0), three(y, 3)], [three(y, 6), three(y, 9)]);
        let gradient = |i: usize| Vector3::z() * (gravity * mass[i]) + coupling.component_mul(&q[1 - i]);
        let (v, f) = ([0, 1].map(|i| n[i].cross(&q[i]) / mass[i]), [0, 1].map(|i| -q[i].cross(&gradient(i))));
        flat(&[v[0].as_slice(), v[1].as_slice(), f[0].as_slice(), f[1].as_slice()])
    };
    let start = flat(&[q[0].as_slice(), q[1].as_slice(), n[0].as_slice(), n[1].as_slice()]);
    let exact = motion(velocity, start, 1.0, 200);
    let error = |q: &(Vector3<f64>, Vector3<f64>), mu: &Vector6<f64>| {
        distance(&flat(&[q.0.as_slice(), q.1.as_slice(), mu.as_slice()]), &exact)
    };
    let start = ((q[0], q[1]), flat(&[n[0].as_slice(), n[1].as_slice()]));
    assert_order(&TwoPendulums { mass, gravity, coupling }, start, error);
    #[cfg(feature = "heavy")]
    assert_order(&FirstOrderPendulums { mass, gravity, coupling }, start, error);
}

/// `TwoBodies` by the papers' step.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: [Translation<3>; 2], x: [Vector3; 2]| [x[0] + a[0], x[1] + a[1]],
    cost      = |h, a| (self.mass[0] * a[0].norm_squared() + self.mass[1] * a[1].norm_squared()) / (2 * h),
    potential = |x| -self.gravitation * self.mass[0] * self.mass[1] / (x[1] - x[0]).norm(),
    order     = 1,
)]
pub struct FirstOrderBodies {
    pub mass: [f64; 2],
    pub gravitation: f64,
}

#[test]
fn two_bodies() {
    let (mass, gravitation) = ([3.0, 0.5], 1.1);
    let x = [Vector3::zeros(), Vector3::new(1.0, 0.0, 0.3)];
    let p = [Vector3::new(0.0, -0.6, 0.0), Vector3::new(0.1, 0.8, 0.0)];
    let velocity = |y: &SVector<f64, 12>| {
        let between = three(y, 3) - three(y, 0);
        let pull = between * (gravitation * mass[0] * mass[1] / between.norm().powi(3));
        let (v, w) = (three(y, 6) / mass[0], three(y, 9) / mass[1]);
        flat(&[v.as_slice(), w.as_slice(), pull.as_slice(), (-pull).as_slice()])
    };
    let start = flat(&[x[0].as_slice(), x[1].as_slice(), p[0].as_slice(), p[1].as_slice()]);
    let exact = motion(velocity, start, 1.0, 200);
    let error = |x: &[Vector3<f64>; 2], mu: &Vector6<f64>| {
        distance(&flat(&[x[0].as_slice(), x[1].as_slice(), mu.as_slice()]), &exact)
    };
    let start = (x, flat(&[p[0].as_slice(), p[1].as_slice()]));
    assert_order(&TwoBodies { mass, gravitation }, start, error);
    #[cfg(feature = "heavy")]
    assert_order(&FirstOrderBodies { mass, gravitation }, start, error);
}
