//! Steps, trajectories, and their comparison with the results of another integrator.

use super::dual::{Dual, along, constant};
use super::equation::{Equation, NoSolution};
use super::matrix::Matrix;
use super::problem::{Adjoint, Problem};
use super::real::Real;

/// (q, N): N_i = ⟨N, E_i⟩ is the momentum before the kick of the step that starts here.
#[derive(Clone, Debug)]
pub struct State<R> {
    /// The configuration.
    pub q: Vec<Matrix<R>>,
    /// The components of the momentum, factor by factor.
    pub n: Vec<R>,
}

/// (q, p) with p in T*_q Q, of the shapes of q.
#[derive(Clone, Debug)]
pub struct CotangentState<R> {
    /// The configuration.
    pub q: Vec<Matrix<R>>,
    /// The covector.
    pub p: Vec<Matrix<R>>,
}

impl State<f64> {
    /// The same state, exactly.
    pub fn lift<R: Real>(&self) -> State<R> {
        State { q: self.q.iter().map(Matrix::lift).collect(), n: self.n.iter().map(|&n| R::of(n)).collect() }
    }
}

/// The discrete Euler–Poincaré equations: F⁻ℓd(q, F) = N for F, q⁺ = Φ_F q, N⁺ = F⁺ℓd(q, F).
pub fn step<P: Problem, R: Real>(problem: &P, h: R, t: R, state: &State<R>) -> Result<State<R>, NoSolution> {
    let equation = Equation { problem, factors: &problem.factors(), t, h, q: &state.q };
    let f = equation.solve(&state.n)?;
    Ok(State { q: problem.act(&f, &state.q), n: equation.next_momentum(&f) })
}

/// Half a step of ℓd, then half a step of its adjoint: of second order for every ℓd.
pub fn composed_step<P: Problem, R: Real>(problem: &P, h: R, t: R, state: &State<R>) -> Result<State<R>, NoSolution> {
    let half = h * 0.5;
    step(&Adjoint(problem), half, t + half, &step(problem, half, t, state)?)
}

/// The symmetric representation: J(q, p + ∂_qℓd) = T*L_F ∂_Fℓd for F (T*R_F for a right action), q⁺ = Φ_F q and
/// (TΦ_F)* p⁺ = p + ∂_qℓd.
///
/// ∂_qℓd and TΦ_F are those of the ambient space of matrices, where Φ_F must be invertible too.
pub fn symmetric_step<P: Problem, R: Real>(
    problem: &P,
    h: R,
    t: R,
    state: &CotangentState<R>,
) -> Result<CotangentState<R>, NoSolution> {
    let equation = Equation { problem, factors: &problem.factors(), t, h, q: &state.q };
    let f = equation.solve(&equation.momentum_map(&state.p))?;
    let (t, h, moved) = (Dual::constant(t), Dual::constant(h), constant(&f));
    let numbers = flat(&state.q);
    let directions: Vec<_> = (0..numbers.len()).map(|i| shaped(&state.q, &along(&numbers, i))).collect();
    let gradient = directions.iter().map(|q| problem.lagrangian(t, h, q, &moved).slope);
    let kicked: Vec<_> = flat(&state.p).into_iter().zip(gradient).map(|(p, slope)| p + slope).collect();
    let tangents: Vec<_> = directions.iter().map(|q| flat(&problem.act(&moved, q))).collect();
    let transposed = Matrix::from_fn(numbers.len(), numbers.len(), |i, j| tangents[i][j].slope);
    let p = transposed.solve(&Matrix::vector(&kicked));
    Ok(CotangentState { q: problem.act(&f, &state.q), p: shaped(&state.q, p.entries()) })
}

/// q, then the states after one, two, … `steps` steps that start at t = 0.
pub fn trajectory<P: Problem, R: Real>(
    problem: &P,
    h: R,
    start: &State<R>,
    steps: usize,
) -> Result<Vec<State<R>>, NoSolution> {
    repeated(|t, state| step(problem, h, t, state), h, start, steps)
}

/// The same with [`composed_step`].
pub fn composed_trajectory<P: Problem, R: Real>(
    problem: &P,
    h: R,
    start: &State<R>,
    steps: usize,
) -> Result<Vec<State<R>>, NoSolution> {
    repeated(|t, state| composed_step(problem, h, t, state), h, start, steps)
}

fn repeated<R: Real>(
    step: impl Fn(R, &State<R>) -> Result<State<R>, NoSolution>,
    h: R,
    start: &State<R>,
    steps: usize,
) -> Result<Vec<State<R>>, NoSolution> {
    let mut states = vec![start.clone()];
    for k in 0..steps {
        states.push(step(h * k as f64, &states[k])?);
    }
    Ok(states)
}

/// The largest difference of an entry of q or a component of N, over all states.
///
/// It is infinite where something is missing or is no number.
pub fn deviation<R: Real>(oracle: &[State<R>], states: &[State<f64>]) -> f64 {
    if oracle.len() != states.len() {
        return f64::INFINITY;
    }
    let numbers = |state: &State<R>| [flat(&state.q), state.n.clone()].concat();
    let difference = |(exact, state): (&State<R>, &State<f64>)| {
        let (exact, state) = (numbers(exact), numbers(&state.lift()));
        let pairs = exact.iter().zip(&state).map(|(&a, &b)| (a - b).size());
        if exact.len() == state.len() { largest(pairs) } else { f64::INFINITY }
    };
    largest(oracle.iter().zip(states).map(difference))
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |max, value| if value.is_nan() { f64::INFINITY } else { max.max(value) })
}

fn flat<R: Copy>(matrices: &[Matrix<R>]) -> Vec<R> {
    matrices.iter().flat_map(Matrix::entries).copied().collect()
}

/// Matrices of these shapes with these entries.
fn shaped<R, S: Copy>(like: &[Matrix<R>], mut entries: &[S]) -> Vec<Matrix<S>> {
    let mut matrix = |like: &Matrix<R>| {
        let (rows, columns) = like.shape();
        let (block, rest) = entries.split_at(rows * columns);
        entries = rest;
        Matrix::of(rows, columns, block)
    };
    like.iter().map(&mut matrix).collect()
}
