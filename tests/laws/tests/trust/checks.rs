//! The laws of every system of the table.

use clebsch::Clebsch;
use clebsch_tests::oracle::flat::{Flat, far};
use clebsch_tests::oracle::motion::order;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::on_itself::OnItself;
use clebsch_tests::oracle::precise::step::{State, deviation};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::stepping::Stepping;

use crate::shapes::Element;

pub const H: f64 = 0.05;

/// A system whose group acts on itself.
pub trait System:
    Clebsch<Scalar = f64, Time = (), Configuration = Self::Q, Element = Self::Q, Momentum = Self::Mu> + Clone
{
    type Q: Element;
    type Mu: Flat + Copy + std::fmt::Debug;
    fn momentum(components: &[f64]) -> Self::Mu;
}

impl<S, Q, const M: usize> System for S
where
    S: Clebsch<Scalar = f64, Time = (), Configuration = Q, Element = Q, Momentum = nalgebra::SVector<f64, M>> + Clone,
    Q: Element,
{
    type Q = Q;
    type Mu = nalgebra::SVector<f64, M>;
    fn momentum(components: &[f64]) -> Self::Mu {
        nalgebra::SVector::from_column_slice(components)
    }
}

/// exp of an algebra element whose components are at most `size`.
pub fn element(problem: &OnItself, random: &mut Random, size: f64) -> Matrix<f64> {
    let components: Vec<f64> = problem.group.basis.iter().map(|_| size * random.number()).collect();
    problem.element(&components)
}

pub fn start<S: System>(problem: &OnItself, random: &mut Random) -> (S::Q, S::Mu) {
    let components: Vec<f64> = problem.group.basis.iter().map(|_| 0.4 * random.number()).collect();
    (S::Q::lower(&element(problem, random, 0.3)), S::momentum(&components))
}

fn run<S: System>(system: &S, h: f64, (q, mu): (S::Q, S::Mu), steps: usize) -> Vec<(S::Q, S::Mu)> {
    let stepper = system.stepper(h).expect("a regular system");
    let mut state = stepper.state(q, mu).expect("a state");
    let mut states = vec![(q, mu)];
    for _ in 0..steps {
        state = stepper.step(&state).expect("a solvable step");
        states.push((*state.configuration(), state.momentum()));
    }
    states
}

/// 20 steps and those of the oracle, in 30 digits.
pub fn agrees_with_the_oracle<S: System>(system: &S, problem: &OnItself, random: &mut Random) {
    let start = start::<S>(problem, random);
    let derived = run(system, H, start, 20);
    let states: Vec<_> = derived.iter().map(|(q, mu)| State { q: vec![q.lift()], n: mu.numbers() }).collect();
    let composed = S::DERIVATION.contains("composed with");
    // a lifted start is the start itself, to the last digit
    let oracle = problem.trajectory(composed, H, &states[0], 20).expect("a solvable step");
    let distance = deviation(&oracle, &states);
    assert!(distance < 1e-11, "{}: {distance:.1e} from the oracle", S::NAME);
    assert!(deviation(&oracle[1..], &states[..20]) > 1e-3, "{}: it moves", S::NAME);
}

/// The end of a motion for steps that halve.
pub fn is_of_second_order<S: System>(system: &S, problem: &OnItself, random: &mut Random) {
    let start = start::<S>(problem, random);
    let end = |steps: usize| run(system, 0.8 / steps as f64, start, steps)[steps];
    let ends = [16, 32, 64, 128, 256].map(end);
    let errors: Vec<f64> =
        ends.windows(2).map(|pair| far(&pair[0].0, &pair[1].0).max(far(&pair[0].1, &pair[1].1))).collect();
    let measured = order(&errors);
    assert!(errors[3] > 1e-9, "{}: errors {errors:?} show no order", S::NAME);
    assert!((measured - 2.0).abs() < 0.15, "{}: order {measured:.2} of {errors:?}", S::NAME);
}

/// F⁻ℓd, F⁺ℓd and J against the exact derivatives of the closures along the basis.
pub fn derivatives_are_those_of_the_closures<S: System>(system: &S, problem: &OnItself, random: &mut Random) {
    for _ in 0..5 {
        let (q, f) = (element(problem, random, 0.5), element(problem, random, 0.3));
        let [before, after] = problem.legendre(H, &q, &f);
        let (q, f) = (S::Q::lower(&q), S::Q::lower(&f));
        let near = |found: S::Mu, expected: &[f64], what: &str| {
            let size = expected.iter().fold(1.0, |max, x| f64::max(max, x.abs()));
            let distance = far(&found, &S::momentum(expected)) / size;
            assert!(distance < 1e-12, "{}: {what}, {distance:.1e} apart\n{found:?}\n{expected:?}", S::NAME);
        };
        near(system.legendre(H, 0.0, &q, &f), &before, "F⁻ℓd");
        near(system.legendre_next(H, 0.0, &q, &f), &after, "F⁺ℓd");
    }
}

/// Theorem 1 on (q, p) and Theorem 2 on (q, N): the same q, and N = J(q, p) all the way.
pub fn representations_agree<S: System>(system: &S, problem: &OnItself, random: &mut Random) {
    let stepper = system.stepper(H).expect("a regular system");
    let (q, _) = start::<S>(problem, random);
    let p = S::Q::from_numbers(&q.numbers().iter().map(|_| 0.3 * random.number()).collect::<Vec<_>>());
    let mut upstairs = stepper.cotangent_state(q, p).expect("a state on T*Q");
    let mut state = stepper.state(q, stepper.momentum_map(&q, &p)).expect("a state");
    for _ in 0..20 {
        upstairs = stepper.step_symmetric(&upstairs).expect("a solvable step");
        state = stepper.step(&state).expect("a solvable step");
        let momentum = stepper.momentum_map(upstairs.configuration(), upstairs.covector());
        let distance = far(upstairs.configuration(), state.configuration()).max(far(&momentum, &state.momentum()));
        assert!(distance < 1e-11, "{}: representations {distance:.1e} apart", S::NAME);
    }
}

/// DᵀΩD = Ω for the step on T*Q in the ambient space of matrices, D by differences of sixth order.
pub fn is_symplectic<S: System>(system: &S, problem: &OnItself, random: &mut Random) {
    let constants = system.step_constants(H).expect("a regular system");
    let (q, _) = start::<S>(problem, random);
    let n = q.numbers().len();
    let mut at: Vec<f64> = q.numbers();
    at.extend((0..n).map(|_| 0.3 * random.number()));
    let step = |y: &[f64]| -> Vec<f64> {
        let (q, p) = (S::Q::from_numbers(&y[..n]), S::Q::from_numbers(&y[n..]));
        let (q, p) = system.step_symmetric(&constants, 0.0, &q, &p).expect("a solvable step");
        [q.numbers(), p.numbers()].concat()
    };
    let columns: Vec<Vec<f64>> = (0..2 * n)
        .map(|k| {
            let pair = |e: f64| {
                let moved = |e: f64| {
                    let mut y = at.clone();
                    y[k] += e;
                    step(&y)
                };
                let (forth, back) = (moved(e), moved(-e));
                forth.iter().zip(back).map(|(a, b)| a - b).collect::<Vec<f64>>()
            };
            let [a, b, c] = [1.0, 2.0, 3.0].map(|k| pair(k * 4e-3));
            (0..2 * n).map(|i| (45.0 * a[i] - 9.0 * b[i] + c[i]) / (60.0 * 4e-3)).collect()
        })
        .collect();
    let d = Matrix::from_fn(2 * n, 2 * n, |i, j| columns[j][i]);
    let omega = Matrix::from_fn(2 * n, 2 * n, |i, j| match (i + n == j, j + n == i) {
        (true, _) => 1.0,
        (_, true) => -1.0,
        _ => 0.0,
    });
    let defect = (d.transpose() * &omega * &d - &omega).size();
    assert!(defect < 1e-9, "{}: DᵀΩD − Ω is {defect:.1e}", S::NAME);
    assert!((d - Matrix::identity(2 * n)).size() > 1e-3, "{}: the step moves something", S::NAME);
}

/// Without potential the spatial momentum Ad*_{q⁻¹} N stays.
pub fn conserves_the_momentum_of_the_group<S: System>(free: &S, problem: &OnItself, random: &mut Random) {
    let start = start::<S>(problem, random);
    let spatial = |(q, mu): &(S::Q, S::Mu)| free.coadjoint(&q.inverted(), mu);
    let expected = spatial(&start);
    for state in run(free, H, start, 100) {
        let distance = far(&spatial(&state), &expected);
        assert!(distance < 1e-11, "{}: the momentum has changed by {distance:.1e}", S::NAME);
    }
}

/// The left action on q⁻¹ by F⁻¹ is the same motion, with the opposite momentum.
pub fn mirrors<R: System, L: System<Q = R::Q, Mu = R::Mu>>(
    right: &R,
    left: &L,
    problem: &OnItself,
    random: &mut Random,
) {
    let (q, mu) = start::<R>(problem, random);
    let opposite = |mu: &R::Mu| R::momentum(&mu.numbers().iter().map(|x| -x).collect::<Vec<_>>());
    let mirrored = run(left, H, (q.inverted(), opposite(&mu)), 20);
    for ((q, mu), (inverse, minus)) in run(right, H, (q, mu), 20).iter().zip(&mirrored) {
        let distance = far(&q.inverted(), inverse).max(far(&opposite(mu), minus));
        assert!(distance < 1e-11, "{}: left and right {distance:.1e} apart", R::NAME);
    }
}
