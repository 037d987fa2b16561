//! The invariants of every step, to 25 digits: the symplectic form, momenta of symmetries, time symmetry, order.

use clebsch_tests::oracle::motion::order;
use clebsch_tests::oracle::precise::double_double::DoubleDouble;
use clebsch_tests::oracle::precise::dual::Dual;
use clebsch_tests::oracle::precise::equation::Equation;
use clebsch_tests::oracle::precise::group::so;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::{Adjoint, Problem};
use clebsch_tests::oracle::precise::real::Real;
use clebsch_tests::oracle::precise::step::{
    CotangentState, State, composed_trajectory, step, symmetric_step, trajectory,
};

use super::systems::{FluidEllipsoid, HeavyTop, MidpointTop, PaperPendulum, Placement, WeightedSl2, height};

const DIGITS_25: f64 = 1e-25;

fn top() -> State<DoubleDouble> {
    let attitude = so(3).combination(&[0.3, 0.2, -0.1].map(DoubleDouble::of)).exponential();
    State { q: vec![attitude], n: [0.5, -0.3, 0.8].map(DoubleDouble::of).to_vec() }
}

fn tenth() -> DoubleDouble {
    DoubleDouble::ratio(1, 10)
}

/// ω((x₁, m₁), (x₂, m₂)) = m₂·x₁ − m₁·x₂ + π·(x₁ × x₂) for δR = R x^, δπ = m.
fn symplectic_matrix(momentum: &[DoubleDouble]) -> Matrix<DoubleDouble> {
    let hat = so(3).combination(momentum);
    Matrix::from_fn(6, 6, |i, j| match (i < 3, j < 3) {
        (true, true) => -hat[(i, j)],
        (false, false) => DoubleDouble::zero(),
        (true, false) => {
            if i + 3 == j {
                DoubleDouble::one()
            } else {
                DoubleDouble::zero()
            }
        }
        (false, true) => {
            if i == j + 3 {
                -DoubleDouble::one()
            } else {
                DoubleDouble::zero()
            }
        }
    })
}

/// D of the step in these coordinates, by dual numbers through the solved equation.
fn derivative(problem: &impl Problem, state: &State<DoubleDouble>) -> Matrix<DoubleDouble> {
    let h = Dual::constant(tenth());
    let column = |k: usize| {
        let x: Vec<_> = (0..3).map(|i| DoubleDouble::of(if i == k { 1.0 } else { 0.0 })).collect();
        let tangent = &state.q[0] * so(3).combination(&x);
        let q = Matrix::from_fn(3, 3, |i, j| Dual { value: state.q[0][(i, j)], slope: tangent[(i, j)] });
        let n = (0..3)
            .map(|i| Dual { value: state.n[i], slope: DoubleDouble::of(if i + 3 == k { 1.0 } else { 0.0 }) })
            .collect();
        let next = step(problem, h, Dual::zero(), &State { q: vec![q], n }).unwrap();
        let turn = next.q[0].map(|entry| entry.value).transpose() * next.q[0].map(|entry| entry.slope);
        [turn[(2, 1)], turn[(0, 2)], turn[(1, 0)], next.n[0].slope, next.n[1].slope, next.n[2].slope]
    };
    let columns: Vec<_> = (0..6).map(column).collect();
    Matrix::from_fn(6, 6, |i, j| columns[j][i])
}

/// DᵀW(π⁺)D = W(π).
#[track_caller]
fn assert_symplectic(problem: &impl Problem) {
    let start = top();
    let next = step(problem, tenth(), DoubleDouble::zero(), &start).unwrap();
    let d = derivative(problem, &start);
    let defect = d.transpose() * symplectic_matrix(&next.n) * &d - symplectic_matrix(&start.n);
    assert!(defect.size() < DIGITS_25, "{:e}", defect.size());
}

#[test]
fn a_separable_step_is_symplectic() {
    assert_symplectic(&HeavyTop(Placement::Both));
}

#[test]
fn a_coupled_step_is_symplectic() {
    assert_symplectic(&MidpointTop);
}

/// Turning about e_z on the other side is a symmetry of the tops: (R π)_z.
#[test]
fn the_vertical_momentum_of_tops_is_conserved() {
    let vertical = |state: &State<DoubleDouble>| (&state.q[0] * Matrix::vector(&state.n))[(2, 0)];
    for states in [
        trajectory(&MidpointTop, tenth(), &top(), 100).unwrap(),
        composed_trajectory(&HeavyTop(Placement::End), tenth(), &top(), 100).unwrap(),
    ] {
        assert!((vertical(&states[100]) - vertical(&states[0])).size() < DIGITS_25);
        assert!((height(&states[100].q[0]) - height(&states[0].q[0])).size() > 0.01, "the top moves");
    }
}

/// ⟨N, X⟩ for the basis of sl(3): E11 − E22, E22 − E33, then the entries off the diagonal by rows.
fn pairing(n: &[DoubleDouble], x: &Matrix<DoubleDouble>) -> DoubleDouble {
    let diagonal = [x[(0, 0)], x[(0, 0)] + x[(1, 1)]];
    let others = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)].map(|place| x[place]);
    n.iter().zip(diagonal.iter().chain(&others)).fold(DoubleDouble::zero(), |sum, (&n, &x)| sum + n * x)
}

/// Of a drop of fluid, by its symmetries q ↦ gq and q ↦ qg: ⟨N, w⟩ and ⟨N, q w q⁻¹⟩ for w in so(3).
#[test]
fn angular_momentum_and_circulation_of_a_fluid_are_conserved() {
    let n = [0.3, -0.2, 0.5, 0.1, -0.4, 0.2, 0.6, -0.3].map(DoubleDouble::of);
    let start = State { q: vec![Matrix::identity(3)], n: n.to_vec() };
    let end = trajectory(&FluidEllipsoid, tenth(), &start, 30).unwrap().pop().unwrap();
    assert!((&end.q[0] - &start.q[0]).size() > 0.5, "it flows");
    for w in so(3).basis {
        let momenta = |state: &State<_>| {
            [pairing(&state.n, &w.lift()), pairing(&state.n, &(&state.q[0] * w.lift() * state.q[0].inverse()))]
        };
        let (before, after) = (momenta(&start), momenta(&end));
        assert!((before[0] - after[0]).size() < DIGITS_25, "angular momentum");
        assert!((before[1] - after[1]).size() < DIGITS_25, "circulation");
    }
}

/// The adjoint's step is the inverse of the step back.
#[test]
fn the_adjoint_undoes_the_step_back() {
    let problem = WeightedSl2(17);
    let start = State { q: vec![Matrix::identity(2)], n: [0.4, 0.7, -0.5].map(DoubleDouble::of).to_vec() };
    let there = step(&Adjoint(&problem), tenth(), DoubleDouble::zero(), &start).unwrap();
    let back = step(&problem, -tenth(), tenth(), &there).unwrap();
    assert!((&back.q[0] - &start.q[0]).size() < DIGITS_25);
    assert!((Matrix::vector(&back.n) - Matrix::vector(&start.n)).size() < DIGITS_25);
    let forth = step(&problem, tenth(), DoubleDouble::zero(), &start).unwrap();
    assert!((&forth.q[0] - &there.q[0]).size() > 1e-6, "this cost is not time-symmetric");
}

/// The error of the end point at time one, against a hundredth of the largest step, for steps that halve.
fn measured_order(run: impl Fn(DoubleDouble, usize) -> State<DoubleDouble>) -> f64 {
    let end = |steps: u32| run(DoubleDouble::one() / DoubleDouble::of(f64::from(steps)), steps as usize);
    let exact = end(1000);
    order(&[10, 20, 40].map(|steps| (&end(steps).q[0] - &exact.q[0]).size()))
}

fn sl2_start() -> State<DoubleDouble> {
    State { q: vec![Matrix::identity(2)], n: [0.4, 0.7, -0.5].map(DoubleDouble::of).to_vec() }
}

fn last(states: Vec<State<DoubleDouble>>) -> State<DoubleDouble> {
    states.last().unwrap().clone()
}

#[test]
fn a_plain_step_is_of_order_one() {
    let order = measured_order(|h, steps| last(trajectory(&WeightedSl2(17), h, &sl2_start(), steps).unwrap()));
    assert!((order - 1.0).abs() < 0.1, "{order}");
}

#[test]
fn a_composed_step_is_of_order_two() {
    let order = measured_order(|h, steps| last(composed_trajectory(&WeightedSl2(17), h, &sl2_start(), steps).unwrap()));
    assert!((order - 2.0).abs() < 0.05, "{order}");
}

#[test]
fn a_symmetric_step_is_of_order_two() {
    let order = measured_order(|h, steps| last(trajectory(&MidpointTop, h, &top(), steps).unwrap()));
    assert!((order - 2.0).abs() < 0.05, "{order}");
}

/// J of the symmetric representation is the momentum of the Euler–Poincaré representation, for left and right actions.
#[test]
fn both_representations_agree() {
    let q = Matrix::vector(&[0.0, 0.6, 0.8].map(DoubleDouble::of));
    let p = Matrix::vector(&[0.5, 0.8, -0.6].map(DoubleDouble::of));
    assert_representations_agree(&PaperPendulum, CotangentState { q: vec![q], p: vec![p] });
    let p = &top().q[0] * so(3).combination(&top().n) * DoubleDouble::of(0.5);
    assert_representations_agree(&MidpointTop, CotangentState { q: top().q, p: vec![p] });
}

#[track_caller]
fn assert_representations_agree(problem: &impl Problem, start: CotangentState<DoubleDouble>) {
    let factors = problem.factors();
    let (t, h) = (DoubleDouble::zero(), tenth());
    let momentum =
        |state: &CotangentState<_>| Equation { problem, factors: &factors, t, h, q: &state.q }.momentum_map(&state.p);
    let mut reduced = State { q: start.q.clone(), n: momentum(&start) };
    let mut full = start;
    for _ in 0..10 {
        full = symmetric_step(problem, h, t, &full).unwrap();
        reduced = step(problem, h, t, &reduced).unwrap();
        assert!((&full.q[0] - &reduced.q[0]).size() < DIGITS_25);
        assert!((Matrix::vector(&momentum(&full)) - Matrix::vector(&reduced.n)).size() < DIGITS_25);
    }
}
