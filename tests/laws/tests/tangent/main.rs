//! Tangent maps of steps: equal to dual numbers put through the generated code, equal to differences of the step, symplectic.
//!
//! Derivatives are exact up to round-off, of numbers of order one: 1e-12 allowed.

mod constrained;
mod constrained_systems;
mod systems;

use clebsch::{Clebsch, Scalar, Sensitive, Sensitivity, Space, Tangent, Variation, Variational};
use clebsch_tests::oracle::dual::Dual;
use clebsch_tests::oracle::near::{assert_near, distance};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::hat;
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix3, Matrix6, Quaternion, SMatrix, SVector, Vector2, Vector3};
use std::cell::RefCell;

const H: f64 = 0.1;
const NEAR: f64 = 1e-12;
/// The directions of a dual number: few, as each is a copy of all operations, and all directions are gone through in turns.
const K: usize = 3;

/// All scalars of a space, in one order.
fn entries<T: Scalar>(space: &impl Space<T>) -> Vec<T> {
    let found = RefCell::new(Vec::new());
    space.all(|entry| {
        found.borrow_mut().push(entry);
        true
    });
    found.into_inner()
}

/// A bilinear form that is linear in a momentum.
type Bracket<const M: usize> = fn(&SVector<f64, M>) -> SMatrix<f64, M, M>;

/// A system as numbers and as dual numbers, at a state.
struct Case<S: Clebsch, D: Clebsch, const M: usize> {
    plain: fn(&[f64]) -> S,
    dual: fn(&[D::Scalar]) -> D,
    /// The quantities, but for step size and time.
    numbers: Vec<f64>,
    q: S::Configuration,
    lift: fn(&S::Configuration) -> D::Configuration,
    mu: SVector<f64, M>,
    /// N·[E_i, E_j] in the symplectic form, with its sign; `None` where forces act.
    bracket: Option<Bracket<M>>,
    /// The numbers of the input.
    input: Vec<f64>,
    plain_input: fn(&[f64]) -> S::Input,
    dual_input: fn(&[D::Scalar]) -> D::Input,
}

/// Columns of motions and of momenta, for all variations and quantities.
fn columns<const M: usize, const P: usize>(
    tangent: &Tangent<f64, M>,
    sensitivity: &Sensitivity<f64, M, P>,
) -> Vec<(SVector<f64, M>, SVector<f64, M>)> {
    let pairs = |a: Vec<SVector<f64, M>>, b: Vec<SVector<f64, M>>| a.into_iter().zip(b);
    let square = |a: &SMatrix<f64, M, M>| a.column_iter().map(Into::into).collect::<Vec<_>>();
    let wide = |a: &SMatrix<f64, M, P>| a.column_iter().map(Into::into).collect::<Vec<_>>();
    pairs(square(&tangent.motion_by_motion), square(&tangent.momentum_by_motion))
        .chain(pairs(square(&tangent.motion_by_momentum), square(&tangent.momentum_by_momentum)))
        .chain(pairs(wide(&sensitivity.motion), wide(&sensitivity.momentum)))
        .collect()
}

/// Against dual numbers, and DᵀΩD = Ω.
fn check<S, D, const M: usize, const P: usize>(case: &Case<S, D, M>)
where
    S: Sensitive<M, P> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>> + Clone,
    D: Variational<M> + Clebsch<Scalar = Dual<K>, Momentum = SVector<Dual<K>, M>>,
{
    check_on::<S, D, M, P>(case, &SMatrix::identity());
}

/// The same, with the form on the motions that are images of the matrix `admissible`.
fn check_on<S, D, const M: usize, const P: usize>(case: &Case<S, D, M>, admissible: &SMatrix<f64, M, M>)
where
    S: Sensitive<M, P> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>> + Clone,
    D: Variational<M> + Clebsch<Scalar = Dual<K>, Momentum = SVector<Dual<K>, M>>,
{
    let place = |name: &str| S::QUANTITIES.iter().position(|quantity| *quantity == name);
    assert_eq!(place("h"), Some(case.numbers.len()), "{:?}", S::QUANTITIES);
    let stepper = (case.plain)(&case.numbers).into_stepper(H).expect("a regular system");
    let state = stepper.state(case.q, case.mu).expect("a state");
    let u = (case.plain_input)(&case.input);
    let (next, tangent, sensitivity) = stepper.step_sensitivity_with::<P>(&state, &u).expect("a solvable step");
    assert_eq!(stepper.step_tangent_with(&state, &u).expect("a solvable step"), (next, tangent));
    let stepped = stepper.step_with(&state, &u).expect("a solvable step");
    assert_near(&stepped.momentum(), &next.momentum(), NEAR, S::NAME);

    let mut worst = 0.0_f64;
    for (turn, columns) in columns(&tangent, &sensitivity).chunks(K).enumerate() {
        let (q, mu) = dual_step(case, place("t").is_some(), turn * K);
        for (k, (motion, momentum)) in columns.iter().enumerate() {
            let moved = entries::<f64>(&stepper.infinitesimal_motion(next.configuration(), motion));
            let expected = entries::<Dual<K>>(&q);
            assert_eq!(moved.len(), expected.len());
            let of_q = moved.iter().zip(&expected).map(|(moved, dual)| (moved - dual.derivatives[k]).abs());
            let of_mu = momentum.iter().zip(mu.iter()).map(|(slope, dual)| (slope - dual.derivatives[k]).abs());
            let error = of_q.chain(of_mu).fold(0.0, |max: f64, e| if e.is_nan() { f64::INFINITY } else { max.max(e) });
            assert!(error < NEAR, "{}: column {} is {error:.1e} off", S::NAME, turn * K + k);
            worst = worst.max(error);
        }
    }
    println!("{}: {worst:.1e} from dual numbers", S::NAME);
    if let Some(bracket) = case.bracket {
        let kept = keeps_the_form(bracket, &tangent, admissible, [&case.mu, &next.momentum()]);
        println!("    DᵀΩD − Ω {kept:.1e}");
        assert!(kept < NEAR, "{}: DᵀΩD − Ω {kept:.1e}", S::NAME);
    }
    transposes(&tangent);
}

/// The step with dual numbers in the directions `first`, … of η, ν, the quantities of the fields, step size, time and input.
fn dual_step<S, D, const M: usize>(
    case: &Case<S, D, M>,
    is_timed: bool,
    first: usize,
) -> (D::Configuration, SVector<Dual<K>, M>)
where
    S: Clebsch<Scalar = f64>,
    D: Variational<M> + Clebsch<Scalar = Dual<K>, Momentum = SVector<Dual<K>, M>>,
{
    let variable = |k: usize, value: f64| match k.checked_sub(first) {
        Some(k) if k < K => Dual::<K>::variable(value, k),
        _ => Dual::constant(value),
    };
    let fields = case.numbers.len();
    let numbers: Vec<Dual<K>> = (0..fields).map(|k| variable(2 * M + k, case.numbers[k])).collect();
    let h = variable(2 * M + fields, H);
    let t = if is_timed { variable(2 * M + fields + 1, 0.0) } else { Dual::constant(0.0) };
    let first_input = 2 * M + fields + 1 + usize::from(is_timed);
    let input: Vec<Dual<K>> = (0..case.input.len()).map(|k| variable(first_input + k, case.input[k])).collect();
    let (system, input) = ((case.dual)(&numbers), (case.dual_input)(&input));
    let eta = SVector::from_fn(|i, _| variable(i, 0.0));
    let q = system.advance(&(case.lift)(&case.q), &system.retraction(&eta));
    let mu = SVector::from_fn(|i, _| variable(M + i, case.mu[i]));
    let constants = system.step_constants(h).expect("a regular system");
    let impulse = system.impulse(&constants, t, &q, &mu);
    let held = D::held(&q, &mu);
    let (q, held, _) = system.step(&constants, t, &q, &held, &impulse, &input).expect("a solvable step");
    (q, D::momentum_held(&q, &held))
}

/// By how much DᵀΩ⁺D differs from Ω, block by block: Ω = (B(N), I; −I, 0) on (η, ν). η is in the image of a matrix.
fn keeps_the_form<const M: usize>(
    bracket: Bracket<M>,
    tangent: &Tangent<f64, M>,
    admissible: &SMatrix<f64, M, M>,
    [mu, next]: [&SVector<f64, M>; 2],
) -> f64 {
    let Tangent { motion_by_momentum: b, momentum_by_momentum: d, .. } = tangent;
    let (a, c) = (&(tangent.motion_by_motion * admissible), &(tangent.momentum_by_motion * admissible));
    let form = |a: &SMatrix<f64, M, M>, c: &SMatrix<f64, M, M>, b: &SMatrix<f64, M, M>, d: &SMatrix<f64, M, M>| {
        a.transpose() * bracket(next) * b + a.transpose() * d - c.transpose() * b
    };
    let motions = admissible.transpose();
    distance(&form(a, c, a, c), &(motions * bracket(mu) * admissible))
        .max(distance(&form(a, c, b, d), &motions))
        .max(distance(&form(b, d, b, d), &SMatrix::zeros()))
}

/// ⟨D v, w⟩ = ⟨v, Dᵀw⟩.
fn transposes<const M: usize>(tangent: &Tangent<f64, M>) {
    let random = &mut Random::new(7);
    let mut variation = || Variation { motion: random.vector::<M>(), momentum: random.vector::<M>() };
    let (v, w) = (variation(), variation());
    let pairing = |a: &Variation<f64, M>, b: &Variation<f64, M>| a.motion.dot(&b.motion) + a.momentum.dot(&b.momentum);
    let (forward, back) = (pairing(&tangent.apply(&v), &w), pairing(&v, &tangent.apply_transposed(&w)));
    assert!((forward - back).abs() < 1e-13 * (1.0 + forward.abs()), "{forward} is not {back}");
}

fn constant<const R: usize, const C: usize>(a: &SMatrix<f64, R, C>) -> SMatrix<Dual<K>, R, C> {
    a.map(Dual::constant)
}

/// N·(x × y), of body momenta.
fn of_body(n: &Vector3<f64>) -> Matrix3<f64> {
    -hat(n)
}

/// The same of spatial momenta.
fn of_space(n: &Vector3<f64>) -> Matrix3<f64> {
    hat(n)
}

/// The upper triangle of a random inertia, and further numbers.
fn numbers<const N: usize>(random: &mut Random, further: &[f64]) -> Vec<f64> {
    let inertia = random.inertia::<N>();
    let upper = (0..N).flat_map(|i| (i..N).map(move |j| (i, j))).map(|place| inertia[place]);
    upper.chain(further.iter().copied()).collect()
}

#[test]
fn an_implicit_step_from_the_right() {
    let random = &mut Random::new(81);
    for _ in 0..5 {
        check::<systems::Top<f64>, systems::Top<Dual<K>>, 3, 11>(&Case {
            plain: systems::top,
            dual: systems::top,
            numbers: numbers::<3>(random, &[1.3, 0.4, -0.2, 0.7]),
            q: random.attitude(),
            lift: constant,
            mu: random.vector(),
            bracket: Some(of_body),
            input: Vec::new(),
            plain_input: |_| (),
            dual_input: |_| (),
        });
    }
}

#[test]
fn a_closed_form_from_the_left_with_isotropy() {
    let random = &mut Random::new(82);
    for _ in 0..5 {
        check::<systems::Pendulum<f64>, systems::Pendulum<Dual<K>>, 3, 3>(&Case {
            plain: systems::pendulum,
            dual: systems::pendulum,
            numbers: vec![0.8, 3.0],
            q: random.unit(),
            lift: constant,
            mu: random.vector(),
            bracket: Some(of_space),
            input: Vec::new(),
            plain_input: |_| (),
            dual_input: |_| (),
        });
    }
}

#[test]
fn a_step_of_two_edges() {
    let random = &mut Random::new(83);
    for _ in 0..5 {
        check::<systems::Composed<f64>, systems::Composed<Dual<K>>, 3, 12>(&Case {
            plain: systems::composed,
            dual: systems::composed,
            numbers: numbers::<3>(random, &[1.3, 0.4, -0.2, 0.7, 0.1]),
            q: random.attitude(),
            lift: constant,
            mu: random.vector(),
            bracket: Some(of_body),
            input: Vec::new(),
            plain_input: |_| (),
            dual_input: |_| (),
        });
    }
}

/// Body momenta of SE(3): (l, p)·[(ω, v), (ω′, v′)] = l·(ω × ω′) + p·(ω × v′ − ω′ × v).
fn of_motions(n: &SVector<f64, 6>) -> Matrix6<f64> {
    let (l, p) = (n.fixed_rows::<3>(0).into_owned(), n.fixed_rows::<3>(3).into_owned());
    let mut form = Matrix6::zeros();
    form.fixed_view_mut::<3, 3>(0, 0).copy_from(&of_body(&l));
    form.fixed_view_mut::<3, 3>(0, 3).copy_from(&of_body(&p));
    form.fixed_view_mut::<3, 3>(3, 0).copy_from(&of_body(&p));
    form
}

#[test]
fn six_coupled_unknowns() {
    let random = &mut Random::new(84);
    for _ in 0..2 {
        let mut q = random.rotation::<3>(1.0).to_homogeneous();
        q.fixed_view_mut::<3, 1>(0, 3).copy_from(&random.vector::<3>());
        check::<systems::Vehicle<f64>, systems::Vehicle<Dual<K>>, 6, 26>(&Case {
            plain: systems::vehicle,
            dual: systems::vehicle,
            numbers: numbers::<6>(random, &[1.3, 0.4, -0.2, 0.7]),
            q,
            lift: constant,
            mu: random.vector(),
            bracket: Some(of_motions),
            input: Vec::new(),
            plain_input: |_| (),
            dual_input: |_| (),
        });
    }
}

#[test]
fn the_logarithm_and_the_time() {
    let random = &mut Random::new(85);
    for _ in 0..5 {
        check::<systems::Satellite<f64>, systems::Satellite<Dual<K>>, 3, 9>(&Case {
            plain: systems::satellite,
            dual: systems::satellite,
            numbers: numbers::<3>(random, &[1.1]),
            q: random.attitude(),
            lift: constant,
            mu: random.vector(),
            bracket: Some(of_body),
            input: Vec::new(),
            plain_input: |_| (),
            dual_input: |_| (),
        });
    }
}

#[test]
fn a_coupled_cost_that_changes_with_the_time() {
    let random = &mut Random::new(86);
    for _ in 0..5 {
        check::<systems::Growing<f64>, systems::Growing<Dual<K>>, 3, 5>(&Case {
            plain: systems::growing,
            dual: systems::growing,
            numbers: vec![0.3, 1.4, 0.8],
            q: random.attitude(),
            lift: constant,
            mu: random.vector(),
            bracket: Some(of_space),
            input: Vec::new(),
            plain_input: |_| (),
            dual_input: |_| (),
        });
    }
}

/// Translations commute; quaternions have the bracket of rotations.
fn of_flyer(n: &SVector<f64, 6>) -> Matrix6<f64> {
    let mut form = Matrix6::zeros();
    form.fixed_view_mut::<3, 3>(3, 3).copy_from(&of_body(&n.fixed_rows::<3>(3).into_owned()));
    form
}

type Place<T> = (Vector3<T>, Quaternion<T>);

#[test]
fn a_product_with_quaternions() {
    let random = &mut Random::new(87);
    let lift = |(x, q): &Place<f64>| (constant(x), Quaternion::from_vector(constant(&q.coords)));
    for _ in 0..5 {
        check::<systems::Flyer<f64>, systems::Flyer<Dual<K>>, 6, 5>(&Case {
            plain: systems::flyer,
            dual: systems::flyer,
            numbers: vec![1.7, 1.0, 1.4, 1.9],
            q: (random.vector(), Quaternion::from_vector(random.unit())),
            lift,
            mu: random.vector(),
            bracket: Some(of_flyer),
            input: Vec::new(),
            plain_input: |_| (),
            dual_input: |_| (),
        });
    }
}

/// [X, Y] = Z: body momenta, p_z (x y′ − y x′).
fn of_heisenberg(n: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, n.z, 0.0, -n.z, 0.0, 0.0, 0.0, 0.0, 0.0)
}

#[test]
fn a_unipotent_group() {
    let random = &mut Random::new(88);
    for _ in 0..5 {
        let (x, y, z) = (random.number(), random.number(), random.number());
        check::<systems::Nil<f64>, systems::Nil<Dual<K>>, 3, 7>(&Case {
            plain: systems::nil,
            dual: systems::nil,
            numbers: numbers::<3>(random, &[]),
            q: Matrix3::new(1.0, x, z, 0.0, 1.0, y, 0.0, 0.0, 1.0),
            lift: constant,
            mu: random.vector(),
            bracket: Some(of_heisenberg),
            input: Vec::new(),
            plain_input: |_| (),
            dual_input: |_| (),
        });
    }
}

/// Forces of all kinds and an input: no symplectic form is conserved, but derivatives are those of the step.
#[test]
fn forces_and_inputs() {
    let random = &mut Random::new(90);
    for _ in 0..5 {
        check::<systems::Steered<f64>, systems::Steered<Dual<K>>, 3, 11>(&Case {
            plain: systems::steered,
            dual: systems::steered,
            numbers: numbers::<3>(random, &[0.4]),
            q: random.attitude(),
            lift: constant,
            mu: random.vector(),
            bracket: None,
            input: vec![0.4, -0.7],
            plain_input: |u| Vector2::new(u[0], u[1]),
            dual_input: |u| Vector2::new(u[0], u[1]),
        });
    }
}

/// Steps that are composed of others, at times of their own: with half kicks between them, and of two edges each with forces.
#[test]
fn composed_steps() {
    let random = &mut Random::new(91);
    for _ in 0..5 {
        #[cfg(feature = "heavy")]
        check::<systems::Sixth<f64>, systems::Sixth<Dual<K>>, 3, 9>(&Case {
            plain: systems::sixth,
            dual: systems::sixth,
            numbers: numbers::<3>(random, &[1.7]),
            q: random.attitude(),
            lift: constant,
            mu: random.vector(),
            bracket: Some(of_body),
            input: Vec::new(),
            plain_input: |_| (),
            dual_input: |_| (),
        });
        check::<systems::Fourth<f64>, systems::Fourth<Dual<K>>, 3, 6>(&Case {
            plain: systems::fourth,
            dual: systems::fourth,
            numbers: vec![1.6, 0.3],
            q: random.vector(),
            lift: constant,
            mu: random.vector(),
            bracket: None,
            input: vec![0.4, -0.7],
            plain_input: |u| Vector2::new(u[0], u[1]),
            dual_input: |u| Vector2::new(u[0], u[1]),
        });
    }
}

/// The tangent map of many steps is the product of theirs, and its columns are central differences of the last momentum.
#[test]
fn long_runs_against_differences() {
    let random = &mut Random::new(89);
    let system = systems::top::<f64>(&numbers::<3>(random, &[1.3, 0.4, -0.2, 0.7]));
    let stepper = system.clone().into_stepper(H).expect("a regular top");
    let (q, mu) = (random.attitude::<3>(), random.vector::<3>());
    let mut state = stepper.state(q, mu).expect("a state");
    let mut whole = Tangent::identity();
    for _ in 0..50 {
        let (next, tangent) = stepper.step_tangent(&state).expect("a solvable step");
        (state, whole) = (next, whole.then(&tangent));
    }
    let end = |eta: Vector3<f64>, nu: Vector3<f64>| {
        let q = system.advance(&q, &system.retraction(&eta));
        let start = stepper.state(q, mu + nu).expect("a state");
        stepper.trajectory(start).nth(50).expect("endless").expect("solvable").momentum()
    };
    let (epsilon, zero) = (1e-5, Vector3::zeros());
    for k in 0..3 {
        let step = Vector3::ith(k, epsilon);
        let by_motion = (end(step, zero) - end(-step, zero)) / (2.0 * epsilon);
        let by_momentum = (end(zero, step) - end(zero, -step)) / (2.0 * epsilon);
        assert_near(&by_motion, &whole.momentum_by_motion.column(k).into_owned(), 1e-7, "∂π/∂η after 50 steps");
        assert_near(&by_momentum, &whole.momentum_by_momentum.column(k).into_owned(), 1e-7, "∂π/∂π after 50 steps");
    }
}

/// Where nothing acts, turning the start turns the run and changes no body momentum. Nothing of the size of inertia/h
/// is cancelled, so products of many tangent maps do not drift.
#[test]
fn a_free_body_does_not_care_where_it_starts() {
    let random = &mut Random::new(91);
    let stepper = systems::top::<f64>(&numbers::<3>(random, &[0.0, 0.4, -0.2, 0.7])).into_stepper(1e-3);
    let stepper = stepper.expect("a regular top");
    let start = random.attitude::<3>();
    let mut state = stepper.state(start, random.vector()).expect("a state");
    let mut whole = Tangent::identity();
    for _ in 0..10_000 {
        let (next, tangent) = stepper.step_tangent(&state).expect("a solvable step");
        (state, whole) = (next, whole.then(&tangent));
    }
    assert_eq!(whole.momentum_by_motion, Matrix3::zeros());
    // R → exp(ζ)R, ζ spatial, is η = Rᵀζ at the start and at the end
    let expected = state.configuration().transpose() * start;
    assert_near(&whole.motion_by_motion, &expected, 1e-12, "η′ = (R₀ᵀR)ᵀη");
}
