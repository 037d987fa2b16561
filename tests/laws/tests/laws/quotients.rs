//! Kinetic energies of displacements alone: functions of q and q⁺, which leave open how the group moves q.
//!
//! The declared steps are compared with an integrator that knows no vertical term. It solves F⁻ℓd(q, F) = N with the
//! declared cost, whose Jacobian is singular, for any of the F that move q alike.

use clebsch::Clebsch;
use clebsch_tests::fixtures::double_pendulum::DoublePendulum;
use clebsch_tests::fixtures::natural_pendulum::NaturalPendulum;
use clebsch_tests::oracle::motion::{motion, order};
use clebsch_tests::oracle::precise::double_double::DoubleDouble;
use clebsch_tests::oracle::precise::group::so;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::{Factor, Problem, left};
use clebsch_tests::oracle::precise::real::Real;
use clebsch_tests::oracle::precise::step::{State, deviation, trajectory};
use clebsch_tests::oracle::random::Random;
use nalgebra::{SMatrix, SVector, Vector3, Vector6};

const H: f64 = 0.05;
const STEPS: usize = 40;

/// Rounding errors of numbers near ten over forty steps.
const NEAR: f64 = 2e-12;

/// Points on spheres Sⁿ⁻¹ with the kinetic energy ½ Σ_ij m_ij q̇_i·q̇_j and the potential Σ g_i·q_i.
struct Spheres {
    n: usize,
    mass: Vec<Vec<f64>>,
    weight: Vec<Vec<f64>>,
}

impl Problem for Spheres {
    fn factors(&self) -> Vec<Factor> {
        self.mass.iter().map(|_| left(so(self.n))).collect()
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        f.iter().zip(q).map(|(f, q)| f * q).collect()
    }
    fn cost<R: Real>(&self, _t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        let moved: Vec<_> = self.act(f, q).iter().zip(q).map(|(next, q)| next - q).collect();
        let mut sum = R::zero();
        for (i, row) in self.mass.iter().enumerate() {
            for (j, mass) in row.iter().enumerate() {
                sum = sum + moved[i].dot(&moved[j]) * *mass;
            }
        }
        sum / (h * 2.0)
    }
    fn potential<R: Real>(&self, _t: R, q: &[Matrix<R>]) -> R {
        let terms = q.iter().zip(&self.weight).map(|(q, weight)| q.dot(&Matrix::vector(weight).lift()));
        terms.fold(R::zero(), |sum, term| sum + term)
    }
}

/// Steps of a declaration, as the integrator without a vertical term makes them.
fn assert_agrees<S: Clebsch<Scalar = f64> + Clone>(
    system: &S,
    problem: &Spheres,
    (q, mu): (S::Configuration, S::Momentum),
    flat: impl Fn(&S::Configuration) -> Vec<Matrix<f64>>,
    components: impl Fn(&S::Momentum) -> Vec<f64>,
) {
    let stepper = system.stepper(H).expect("a regular system");
    let start = stepper.state(q, mu).expect("a momentum in 𝔤_q^⊥");
    let derived: Vec<_> = std::iter::successors(Some(start), |state| stepper.step(state).ok())
        .take(STEPS + 1)
        .map(|state| State { q: flat(state.configuration()), n: components(&state.momentum()) })
        .collect();
    let oracle = trajectory(problem, DoubleDouble::of(H), &derived[0].lift(), STEPS).expect("a step");
    let distance = deviation(&oracle, &derived);
    println!("{}: {distance:.1e}", S::NAME);
    assert!(distance < NEAR, "{}: {distance:e}", S::NAME);
    assert!(deviation(&oracle[1..], &derived[..STEPS]) > 1e-3, "a step later is elsewhere");
}

fn columns<const N: usize, const K: usize>(q: &[SVector<f64, N>; K]) -> Vec<Matrix<f64>> {
    q.iter().map(Matrix::from).collect()
}

/// q_i × p_i of random covectors.
fn spins<const K: usize>(random: &mut Random, q: &[Vector3<f64>; K]) -> Vec<f64> {
    q.iter().flat_map(|q| q.cross(&random.vector::<3>()).as_slice().to_vec()).collect()
}

#[test]
fn a_natural_pendulum_is_that_of_the_chord() {
    let random = &mut Random::new(41);
    let (system, q) = (NaturalPendulum { mass: 0.7, weight: 1.3 }, random.unit::<3>());
    let problem = Spheres { n: 3, mass: vec![vec![0.7]], weight: vec![vec![0.0, 0.0, 1.3]] };
    let mu = q.cross(&random.vector::<3>());
    assert_agrees(&system, &problem, (q, mu), |q| vec![Matrix::from(q)], |mu| mu.as_slice().to_vec());
}

/// Three bobs in series, by the positions of the bobs.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: [SO<3>; 3], q: [Unit<Vector3>; 3]| [F[0] * q[0], F[1] * q[1], F[2] * q[2]],
    cost      = |h, q, F| {
        let first = F[0] * q[0] - q[0];
        let second = first + self.length * (F[1] * q[1] - q[1]);
        let third = second + F[2] * q[2] - q[2];
        (first.norm_squared() + self.mass * second.norm_squared() + third.norm_squared()) / (2 * h)
    },
    potential = |q| (2 + self.mass) * q[0].z + (1 + self.mass) * self.length * q[1].z + q[2].z,
)]
struct TriplePendulum {
    mass: f64,
    length: f64,
}

#[test]
fn chains_of_pendulums() {
    let random = &mut Random::new(42);
    let q = [random.unit::<3>(), random.unit::<3>()];
    let (mass, length, gravity) = ([1.0, 0.7], [1.0, 0.8], 9.81);
    let (both, cross) = (mass[0] + mass[1], mass[1] * length[0] * length[1]);
    let problem = Spheres {
        n: 3,
        mass: vec![vec![both * length[0] * length[0], cross], vec![cross, mass[1] * length[1] * length[1]]],
        weight: vec![vec![0.0, 0.0, gravity * both * length[0]], vec![0.0, 0.0, gravity * mass[1] * length[1]]],
    };
    let mu = Vector6::from_column_slice(&spins(random, &q));
    assert_agrees(&DoublePendulum { mass, length, gravity }, &problem, (q, mu), columns, |mu| mu.as_slice().to_vec());

    let (m, l) = (0.6, 1.3);
    let problem = Spheres {
        n: 3,
        mass: vec![vec![2.0 + m, (1.0 + m) * l, 1.0], vec![(1.0 + m) * l, (1.0 + m) * l * l, l], vec![1.0, l, 1.0]],
        weight: vec![vec![0.0, 0.0, 2.0 + m], vec![0.0, 0.0, (1.0 + m) * l], vec![0.0, 0.0, 1.0]],
    };
    let q = [random.unit::<3>(), random.unit::<3>(), random.unit::<3>()];
    let mu = SVector::<f64, 9>::from_column_slice(&spins(random, &q));
    assert_agrees(&TriplePendulum { mass: m, length: l }, &problem, (q, mu), columns, |mu| mu.as_slice().to_vec());
}

/// A point on S⁴, with a kinetic energy whose mass matrix is no multiple of the identity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<5>, q: Unit<SVector<5>>| F * q,
    cost      = |h, q, F| ((F * q - q).norm_squared() + (self.pull.dot(&(F * q - q))).powi(2)) / (2 * h),
    potential = |q| self.pull.dot(&q),
)]
struct Anisotropic {
    pull: SVector<f64, 5>,
}

/// The same in R⁵ without the group: ½ q̇·Mq̇ with M = I + ppᵀ.
#[test]
fn four_dimensional_spheres() {
    let random = &mut Random::new(43);
    let (pull, q) = (random.vector::<5>(), random.unit::<5>());
    let p = random.vector::<5>();
    let p = p - q * q.dot(&p);
    let system = Anisotropic { pull };
    let mu = system.momentum_map(&q, &p);
    let mass = SMatrix::<f64, 5, 5>::identity() + pull * pull.transpose();
    let inverse = mass.try_inverse().expect("a regular mass");
    // Mq̈ = −p − λq with |q| = 1
    let field = move |y: &SVector<f64, 10>| {
        let (q, v) = (y.fixed_rows::<5>(0).into_owned(), y.fixed_rows::<5>(5).into_owned());
        let lambda = (v.norm_squared() - q.dot(&(inverse * pull))) / q.dot(&(inverse * q));
        let mut slope = SVector::<f64, 10>::zeros();
        slope.fixed_rows_mut::<5>(0).copy_from(&v);
        slope.fixed_rows_mut::<5>(5).copy_from(&(inverse * (-pull - q * lambda)));
        slope
    };
    // p is Mv up to a multiple of q
    let along = q.dot(&(inverse * p)) / q.dot(&(inverse * q));
    let mut start = SVector::<f64, 10>::zeros();
    start.fixed_rows_mut::<5>(0).copy_from(&q);
    start.fixed_rows_mut::<5>(5).copy_from(&(inverse * (p - q * along)));
    let exact = motion(field, start, 1.0, 200);
    let errors = [32, 64, 128].map(|steps: usize| {
        let stepper = system.stepper(1.0 / steps as f64).expect("a regular system");
        let end = stepper.advance(&stepper.state(q, mu).expect("a state"), steps).expect("steps");
        (end.configuration() - exact.fixed_rows::<5>(0)).norm()
    });
    let measured = order(&errors);
    println!("S⁴: order {measured:.3}, errors {errors:?}");
    assert!((measured - 2.0).abs() < 0.1, "{measured}");
}

/// The normal modes of two equal bobs on equal rods: ω² = (2 ∓ √2) g/l.
#[test]
fn small_oscillations_have_the_periods_of_theory() {
    let system = DoublePendulum { mass: [1.0, 1.0], length: [1.0, 1.0], gravity: 9.81 };
    let stepper = system.stepper(1e-3).expect("a regular system");
    for (ratio, sign) in [(2.0_f64.sqrt(), -1.0), (-2.0_f64.sqrt(), 1.0)] {
        let at = |angle: f64| Vector3::new(angle.sin(), 0.0, -angle.cos());
        let mut state = stepper.state([at(1e-4), at(1e-4 * ratio)], Vector6::zeros()).expect("a state at rest");
        let (mut steps, mut last) = (0.0, state.configuration()[0].x);
        let quarter = loop {
            state = stepper.step(&state).expect("a step");
            steps += 1.0;
            let x = state.configuration()[0].x;
            if x <= 0.0 {
                break (steps - x / (x - last)) * 1e-3;
            }
            last = x;
        };
        let period = std::f64::consts::TAU / (9.81 * (2.0 + sign * 2.0_f64.sqrt())).sqrt();
        println!("period {}, theory {period}", 4.0 * quarter);
        assert!((4.0 * quarter - period).abs() < 1e-5, "{} s, not {period} s", 4.0 * quarter);
    }
}

/// Foucault's pendulum in a frame that turns, by its Lagrangian in the velocity of the bob alone.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, q: Unit<Vector3>| F * q,
    lagrangian = |q, w| self.mass * (w.cross(&q) + self.rate.cross(&q)).norm_squared() / 2,
    potential  = |q| self.mass * 9.81 * q.z,
    order      = 2,
)]
struct Foucault {
    mass: f64,
    rate: Vector3<f64>,
}

/// The same in steps of fourth order.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, q: Unit<Vector3>| F * q,
    lagrangian = |q, w| self.mass * (w.cross(&q) + self.rate.cross(&q)).norm_squared() / 2,
    potential  = |q| self.mass * 9.81 * q.z,
    order      = 4,
)]
struct FineFoucault {
    mass: f64,
    rate: Vector3<f64>,
}

/// q̈ + 2Ω × q̇ + Ω × (Ω × q) = −g e_z − λq.
fn foucault(rate: Vector3<f64>) -> impl Fn(&Vector6<f64>) -> Vector6<f64> {
    move |y| {
        let (q, v) = (y.fixed_rows::<3>(0).into_owned(), y.fixed_rows::<3>(3).into_owned());
        let free = -Vector3::z() * 9.81 - rate.cross(&v) * 2.0 - rate.cross(&rate.cross(&q));
        let slope = free - q * (q.dot(&free) + v.norm_squared());
        Vector6::new(v.x, v.y, v.z, slope.x, slope.y, slope.z)
    }
}

#[test]
fn lagrangians_of_the_velocity_of_a_point_have_their_orders() {
    let rate = Vector3::new(0.3, 0.0, 0.4);
    let (q, mass) = (Vector3::new(0.36, 0.48, -0.8), 0.7);
    let v = q.cross(&Vector3::new(0.5, -0.2, 0.1)).cross(&q);
    let exact = motion(foucault(rate), Vector6::new(q.x, q.y, q.z, v.x, v.y, v.z), 1.0, 200);
    let mu = q.cross(&(v + rate.cross(&q))) * mass;
    let error = |end: &Vector3<f64>| (end - exact.fixed_rows::<3>(0)).norm();
    let coarse = Foucault { mass, rate };
    let errors = [32, 64, 128, 256].map(|steps: usize| {
        let stepper = coarse.stepper(1.0 / steps as f64).expect("a regular system");
        error(stepper.advance(&stepper.state(q, mu).expect("a state"), steps).expect("steps").configuration())
    });
    let fine = FineFoucault { mass, rate };
    let fine_errors = [8, 16, 32, 64].map(|steps: usize| {
        let stepper = fine.stepper(1.0 / steps as f64).expect("a regular system");
        error(stepper.advance(&stepper.state(q, mu).expect("a state"), steps).expect("steps").configuration())
    });
    println!("Foucault: {errors:?}, {fine_errors:?}");
    assert!((order(&errors) - 2.0).abs() < 0.1, "{errors:?}");
    assert!((order(&fine_errors) - 4.0).abs() < 0.25, "{fine_errors:?}");
}

/// Momenta stay in 𝔤_q^⊥, and energy and vertical momentum do not drift.
#[test]
fn what_is_conserved_is_conserved() {
    let random = &mut Random::new(44);
    let system = DoublePendulum { mass: [1.0, 0.7], length: [1.0, 0.8], gravity: 9.81 };
    let stepper = system.stepper(2e-3).expect("a regular system");
    let q = [random.unit::<3>(), random.unit::<3>()];
    let mut state = stepper.state(q, Vector6::from_column_slice(&spins(random, &q))).expect("a state");
    let at = |state: &clebsch::State<DoublePendulum>| (stepper.energy(state), stepper.conserved(state).values()[0]);
    let (energy, vertical) = at(&state);
    for _ in 0..5000 {
        state = stepper.step(&state).expect("a step");
    }
    let (later, still) = at(&state);
    let off = stepper.system().isotropy_defect(state.configuration(), &state.momentum());
    println!("energy {energy} {later}, momentum {vertical} {still}, along q {off:.1e}");
    assert!((later - energy).abs() < 1e-3 * energy.abs().max(1.0), "{energy} to {later}");
    assert!((still - vertical).abs() < 1e-11, "{vertical} to {still}");
    assert!(off < 1e-11, "{off:e} along q");
}

/// The term is said, and derived for those factors alone that need it.
#[test]
fn derivations_say_what_was_added() {
    for text in [NaturalPendulum::DERIVATION, DoublePendulum::DERIVATION, Foucault::DERIVATION, Anisotropic::DERIVATION]
    {
        assert!(text.contains("vertical term"), "{text}");
    }
    let regular = clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum::DERIVATION;
    assert!(!regular.contains("vertical term"));
}
