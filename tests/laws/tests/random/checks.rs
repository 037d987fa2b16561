//! The laws of every problem that compiles.

use std::panic::{AssertUnwindSafe, catch_unwind};

use clebsch_compiler::derive::{self, Solution, Structure};
use clebsch_compiler::diagnostic::Diagnostics;
use clebsch_compiler::lower::{MechanicsProgram, Program, Solve};
use clebsch_compiler::{Graph, compile};
use clebsch_symbolic::Chart;
use clebsch_tests::oracle::precise::double_double::DoubleDouble;
use clebsch_tests::oracle::precise::energy::energy;
use clebsch_tests::oracle::precise::equation::Equation;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::{Adjoint, Problem};
use clebsch_tests::oracle::precise::real::Real;
use clebsch_tests::oracle::precise::step::{State, composed_trajectory, step, trajectory};
use clebsch_tests::oracle::random::Random;
use proc_macro2::TokenStream;

use crate::powers::{Power, Sites, kicked};
use crate::problem::{Declared, Discretization, Kind, Kinetic, Leaf};
use crate::stepping::{Seen, Stepper};

/// The step.
const H: f64 = 0.05;
/// The number of steps.
const STEPS: usize = 5;

/// The results of a problem that passed.
#[derive(Copy, Clone, Debug, Default)]
#[allow(dead_code, reason = "some of it is only shown")]
pub struct Found {
    /// Whether it was stepped: other problems have no known vertical term, are too large, or are matrix code.
    pub stepped: bool,
    /// Whether it is refused as too large, without a reason that is known.
    pub is_large: bool,
    pub composed: bool,
    pub conserved: usize,
    pub couples: bool,
    pub iterates: bool,
    pub compensated: bool,
    pub collocated: bool,
    pub specialised: bool,
    pub deviation: f64,
    pub energy: f64,
    pub drift: f64,
}

/// Compiles the declaration, steps it, and holds it against the oracle.
///
/// # Errors
/// The law that fails, in words.
pub fn check(problem: &Declared, seed: u64) -> Result<Found, String> {
    let text = problem.text();
    let has_projector = problem.leaves.iter().any(|leaf| leaf.type_name.starts_with("Projector"));
    // known shortfall: costs of FPFᵀ with weights, or in the exponential chart, are longer than unrolled code may be
    let is_too_large = |errors: &Diagnostics| errors.to_string().contains("is too large");
    let run = || -> Result<Found, String> {
        let tokens: TokenStream = text.parse().map_err(|error| format!("no tokens: {error}"))?;
        let graph = Graph::new();
        let program = match mechanics(&graph, tokens) {
            Ok(program) => program,
            Err(errors) if errors.to_string().contains("no vertical term is known") => return Ok(Found::default()),
            Err(errors) if is_too_large(&errors) => return Ok(Found { is_large: !has_projector, ..Found::default() }),
            Err(errors) => return Err(format!("refused:\n{errors}")),
        };
        // Matrix code stands in for unrolled code that is too long. `forms` compares the two.
        if program.form.is_beyond {
            return Ok(Found::default());
        }
        let found = compiled(problem, &program, &mut Random::new(seed ^ 0x5eed))?;
        let collocated = collocated(problem, seed)?;
        match (seed / 2).is_multiple_of(2) {
            true => Ok(Found { compensated: compensated(problem, seed)?, collocated, ..found }),
            false => Ok(Found { collocated, ..found }),
        }
    };
    let result = catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        Err(format!("panic: {}", text.or(panic.downcast_ref::<&str>().map(|s| s.to_string())).unwrap_or_default()))
    });
    result.map_err(|error| format!("seed {seed}: {error}\n{text}"))
}

/// The first four stages.
pub fn mechanics<'g>(graph: &'g Graph, tokens: TokenStream) -> Result<MechanicsProgram<'g>, Diagnostics> {
    match compile(graph, tokens)? {
        Program::Mechanics(program) => Ok(*program),
        Program::Steered(_) => panic!("inputs move it"),
    }
}

/// Whether something was known of the Jacobian of an equation.
fn is_specialised(solve: &Solve) -> bool {
    solve.solution == Solution::Linear || !solve.given.is_empty() || solve.structure != Structure::Dense
}

fn compiled(problem: &Declared, program: &MechanicsProgram<'_>, random: &mut Random) -> Result<Found, String> {
    let start = start(problem, random);
    let fields: Vec<Vec<f64>> = problem.fields.iter().map(|field| field.value.entries().to_vec()).collect();
    let mut stepper = Stepper::new(program, &fields, H);
    let h = DoubleDouble::of(H);
    let composed = program.formulas.stepped == 2;
    let first = start.lift::<DoubleDouble>();
    let oracle = match composed {
        true => composed_trajectory(problem, h, &first, STEPS),
        false => trajectory(problem, h, &first, STEPS),
    };
    let oracle = oracle.map_err(|lost| format!("the oracle has no step: {lost:?}"))?;
    let solves = || program.steps.iter().flat_map(|step| &step.solves);
    let mut found = Found {
        stepped: true,
        composed,
        conserved: program.formulas.symmetries.conserved.len(),
        couples: program.formulas.lagrangian.couples,
        iterates: solves().any(|solve| solve.solution == Solution::Newton),
        specialised: solves().any(is_specialised),
        ..Found::default()
    };
    let mut state = seen(problem, &start);
    for (k, exact) in oracle.iter().enumerate().skip(1) {
        state = stepper.step((k - 1) as f64 * H, &state)?;
        let distance = distance(problem, exact, &state);
        if distance.is_nan() || distance > 1e-12 {
            return Err(format!("step {k} is {distance:.1e} from the oracle"));
        }
        found.deviation = found.deviation.max(distance);
    }
    moves(&oracle)?;
    found.drift = drift(problem, &mut stepper, &oracle)?;
    found.energy = energies(problem, &mut stepper, &start)?;
    if problem.order == 2 {
        time_symmetry(problem, &first, composed)?;
    }
    Ok(found)
}

/// The same problem with compensated sums: the same steps, and increments that are right to their own last digits, however short a step is.
fn compensated(problem: &Declared, seed: u64) -> Result<bool, String> {
    let mut problem = problem.clone();
    problem.dials.push("summation = compensated");
    let tokens: TokenStream = problem.text().parse().map_err(|error| format!("no tokens: {error}"))?;
    let graph = Graph::new();
    let program = match mechanics(&graph, tokens) {
        Ok(program) => program,
        Err(errors) if errors.to_string().contains("there is no sum to compensate") => return Ok(false),
        Err(errors) => return Err(format!("refused with compensated sums:\n{errors}")),
    };
    compiled(&problem, &program, &mut Random::new(seed ^ 0x5eed)).map_err(|error| format!("compensated: {error}"))?;
    increments(problem, &mut Random::new(seed ^ 0x5eed))?;
    Ok(true)
}

/// The same problem in steps of order 16, where there are such. The slopes that they collocate are those of a short
/// step of the oracle.
fn collocated(problem: &Declared, seed: u64) -> Result<bool, String> {
    if problem.order != 2 {
        return Ok(false);
    }
    let mut problem = problem.clone();
    problem.dials.push("order = 16");
    let tokens: TokenStream = problem.text().parse().map_err(|error| format!("no tokens: {error}"))?;
    let graph = Graph::new();
    let program = match mechanics(&graph, tokens) {
        Ok(program) => program,
        Err(errors) if errors.to_string().contains("`order = 16`") => return Ok(false),
        Err(errors) => return Err(format!("refused in steps of order 16:\n{errors}")),
    };
    // A rounded momentum of a projector is off the range of J. The short step divides that by h.
    let is_rounded = problem.leaves.iter().any(|leaf| leaf.type_name.starts_with("Projector"));
    let h = 2.0_f64.powi(if is_rounded { -24 } else { -30 });
    let state = start(&problem, &mut Random::new(seed ^ 0x5eed));
    let fields: Vec<Vec<f64>> = problem.fields.iter().map(|field| field.value.entries().to_vec()).collect();
    let Some((found, missed)) = Stepper::new(&program, &fields, h).slopes(0.0, &seen(&problem, &state)) else {
        return Ok(false);
    };
    let (size, first) = (DoubleDouble::of(h), state.lift::<DoubleDouble>());
    let last = match program.formulas.stepped == 2 {
        true => composed_trajectory(&problem, size, &first, 1),
        false => trajectory(&problem, size, &first, 1),
    };
    let last = last.map_err(|lost| format!("the oracle has no short step: {lost:?}"))?.remove(1);
    let per_time = DoubleDouble::of(1.0 / h);
    let slope = State {
        q: last.q.iter().zip(&first.q).map(|(last, first)| (last - first).map(|x| x * per_time)).collect(),
        n: last.n.iter().zip(&first.n).map(|(&last, &first)| (last - first) * per_time).collect(),
    };
    let exact = seen(&problem, &rounded(&slope));
    let (a, b) = ([found.q.concat(), found.mu].concat(), [exact.q.concat(), exact.mu].concat());
    let scale = b.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
    let off = a
        .iter()
        .zip(&b)
        .fold(0.0, |most: f64, (a, b)| if (a - b).is_nan() { f64::NAN } else { most.max((a - b).abs()) });
    match missed < 1e-13 && off < 1e-7 * scale {
        true => Ok(true),
        false => Err(format!(
            "slopes are {off:.1e} from those of the oracle, and the covector's momentum {missed:.1e} from N"
        )),
    }
}

/// How the gradient of a power is computed.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Gradient {
    /// Site by site.
    Gathered,
    /// Term by term.
    Added,
    /// The site is refused, as it needs matrix code, which powers do not have.
    TooLarge,
}

/// Compiles a power, steps its sites, and compares them with the problem of the oracle.
///
/// # Errors
/// The difference, in words.
pub fn check_power(power: &Power, seed: u64) -> Result<Gradient, String> {
    let text = power.text();
    let run = || -> Result<Gradient, String> {
        let tokens: TokenStream = text.parse().map_err(|error| format!("no tokens: {error}"))?;
        let graph = Graph::new();
        let program = match mechanics(&graph, tokens) {
            Ok(program) => program,
            Err(errors) if errors.to_string().contains("a power has no matrix code") => return Ok(Gradient::TooLarge),
            Err(errors) => return Err(format!("refused:\n{errors}")),
        };
        let unrolled = power.unrolled();
        let start = start(&unrolled, &mut Random::new(seed ^ 0x5eed));
        let (h, first) = (DoubleDouble::of(H), start.lift::<DoubleDouble>());
        let oracle = match program.formulas.stepped == 2 {
            true => kicked(&unrolled, h, &first, 2),
            false => trajectory(&unrolled, h, &first, 2),
        };
        let oracle = oracle.map_err(|lost| format!("the oracle has no step: {lost:?}"))?;
        let (mut sites, mut state) = (Sites::new(power, &program, H), seen(&unrolled, &start));
        let potential = unrolled.potential(0.0, &start.q);
        let found = sites.potential(0.0, &state);
        let off = (found - potential).abs();
        if off.is_nan() || off > 1e-12 * potential.abs().max(1.0) {
            return Err(format!("the potential is {found}, that of the oracle {potential}"));
        }
        for (k, exact) in oracle.iter().enumerate().skip(1) {
            state = sites.step((k - 1) as f64 * H, &state)?;
            let distance = distance(&unrolled, exact, &state);
            if distance.is_nan() || distance > 1e-12 {
                return Err(format!("step {k} of sites is {distance:.1e} from the oracle"));
            }
        }
        moves(&oracle)?;
        Ok(if program.gathered.is_some() { Gradient::Gathered } else { Gradient::Added })
    };
    run().map_err(|error| format!("seed {seed}: {error}\n{text}"))
}

/// A short step without the potential, its increments next to those of the oracle.
fn increments(mut free: Declared, random: &mut Random) -> Result<(), String> {
    free.potential = None;
    let tokens: TokenStream = free.text().parse().map_err(|error| format!("no tokens: {error}"))?;
    let graph = Graph::new();
    let program = mechanics(&graph, tokens).map_err(|errors| format!("refused without a potential:\n{errors}"))?;
    // where the equation has inverses or exponentials of matrices, its residual is a difference, and x not right to its own last digits
    let formulas = &program.formulas;
    let is_difference = |equation: &derive::MomentumEquation<'_>| {
        let has = |chart| equation.factors.iter().any(|&k| formulas.symbols.charts[k] == chart);
        let by_logarithm = matches!(free.kinetic, Kinetic::Lagrangian(_, Discretization::Exponential));
        let is_cost = matches!(free.kinetic, Kinetic::Cost(_));
        let iterates = equation.solution == Solution::Newton;
        // a shift that is put in, where it shares inertia with the turn
        let shift_from_turn = has(Chart::Product) && !iterates && is_cost;
        iterates && (has(Chart::Cayley) && !equation.form.cleared || has(Chart::Exponential) && !by_logarithm)
            || shift_from_turn
    };
    // a cost may have a potential in it
    let is_free = formulas.stepped == 1 && formulas.potential_energy.is_zero();
    if !is_free || formulas.substeps.iter().flat_map(|substep| &substep.equations).any(is_difference) {
        return Ok(());
    }
    let (state, h) = (start(&free, random), 2.0_f64.powi(-30));
    let fields: Vec<Vec<f64>> = free.fields.iter().map(|field| field.value.entries().to_vec()).collect();
    let found = Stepper::new(&program, &fields, h).increments(0.0, &seen(&free, &state))?;
    let first = state.lift::<DoubleDouble>();
    let lost = |lost| format!("the oracle has no short step: {lost:?}");
    let last = step(&free, DoubleDouble::of(h), DoubleDouble::zero(), &first).map_err(lost)?;
    let moved = State {
        q: last.q.iter().zip(&first.q).map(|(last, first)| last - first).collect(),
        n: last.n.iter().zip(&first.n).map(|(&last, &first)| last - first).collect(),
    };
    let exact = seen(&free, &rounded(&moved));
    let size = |numbers: &[f64]| numbers.iter().fold(0.0, |most, x: &f64| x.abs().max(most));
    let apart = |a: &[f64], b: &[f64]| size(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>());
    let (q, exact_q) = (found.q.concat(), exact.q.concat());
    // a momentum that changes at the second order in h alone has increments of the size of h². A momentum may stay as
    // it is, or nearly
    let changed = size(&exact.mu).max(1e-3 * h * size(&state.n));
    let off = (apart(&q, &exact_q) / size(&exact_q)).max(apart(&found.mu, &exact.mu) / changed);
    // NaN is none of these
    if off < 1e-9 { Ok(()) } else { Err(format!("increments of a step of {h:.0e} are off by {off:.1e} of themselves")) }
}

/// A configuration and a momentum that its motions can have.
fn start(problem: &Declared, random: &mut Random) -> State<f64> {
    let q: Vec<Matrix<f64>> = problem.leaves.iter().map(|leaf| leaf.start.clone()).collect();
    let factors = problem.factors();
    let equation = Equation { problem, factors: &factors, t: 0.0, h: H, q: &q };
    let covector = |leaf: &Matrix<f64>| Matrix::from_fn(leaf.shape().0, leaf.shape().1, |_, _| random.number());
    let p: Vec<Matrix<f64>> = q.iter().map(covector).collect();
    let mut n = equation.momentum_map(&p);
    if problem.dials.contains(&"isotropy = free") {
        n.iter_mut().for_each(|n| *n = random.number());
    }
    // momenta of size ½: the step turns by angles of a few hundredths
    let size = n.iter().fold(0.25, |max, n| f64::max(max, n.abs()));
    n.iter_mut().for_each(|n| *n *= 0.5 / size);
    State { q, n }
}

/// The part of a matrix of the oracle that the program sees.
fn shown<R: Copy>(kind: Kind, matrix: &Matrix<R>) -> Vec<R> {
    match kind {
        Kind::Quaternion => matrix.block(0..4, 3..4).entries().to_vec(),
        _ => matrix.entries().to_vec(),
    }
}

/// The leaf of the oracle from the part that the program sees.
pub fn unseen(leaf: &Leaf, entries: &[f64]) -> Matrix<f64> {
    if leaf.kind != Kind::Quaternion {
        let (rows, columns) = leaf.start.shape();
        return Matrix::of(rows, columns, entries);
    }
    let [x, y, z, w] = entries else { panic!("a quaternion has four entries") };
    Matrix::of(4, 4, &[*w, -z, *y, *x, *z, *w, -x, *y, -y, *x, *w, *z, -x, -y, -z, *w])
}

/// The numbers of a state that the program sees.
pub fn seen(problem: &Declared, state: &State<f64>) -> Seen {
    let q = problem.leaves.iter().zip(&state.q).map(|(leaf, q)| shown(leaf.kind, q)).collect();
    Seen { q, mu: state.n.clone() }
}

/// A state of the oracle in `f64`.
pub fn rounded(state: &State<DoubleDouble>) -> State<f64> {
    State { q: state.q.iter().map(|q| q.map(Real::to_f64)).collect(), n: state.n.iter().map(|n| n.to_f64()).collect() }
}

/// The largest difference, relative to the largest number of the state where that is above one.
pub fn distance(problem: &Declared, exact: &State<DoubleDouble>, state: &Seen) -> f64 {
    let exact = seen(problem, &rounded(exact));
    let (a, b) = ([exact.q.concat(), exact.mu].concat(), [state.q.concat(), state.mu.clone()].concat());
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let size = a.iter().fold(1.0, |max, x| f64::max(max, x.abs()));
    a.iter().zip(b).fold(0.0, |max: f64, (a, b)| if (a - b).is_nan() { f64::NAN } else { max.max((a - b).abs()) })
        / size
}

fn moves(oracle: &[State<DoubleDouble>]) -> Result<(), String> {
    let (first, last) = (rounded(&oracle[0]), rounded(&oracle[oracle.len() - 1]));
    let moved = first.q.iter().zip(&last.q).any(|(a, b)| (a - b).size() > 1e-6);
    if moved { Ok(()) } else { Err("nothing moves".into()) }
}

/// The largest change of a momentum that the program calls conserved, along the oracle's trajectory.
fn drift(problem: &Declared, stepper: &mut Stepper<'_, '_>, oracle: &[State<DoubleDouble>]) -> Result<f64, String> {
    let at =
        |stepper: &mut Stepper<'_, '_>, k: usize| stepper.conserved(k as f64 * H, &seen(problem, &rounded(&oracle[k])));
    let expected = at(stepper, 0);
    let size = expected.iter().fold(1.0, |max, x| f64::max(max, x.abs()));
    let mut largest = 0.0;
    for k in 1..oracle.len() {
        let now = at(stepper, k);
        let change = now.iter().zip(&expected).fold(0.0, |max, (a, b)| f64::max(max, (a - b).abs())) / size;
        if change > 1e-13 {
            return Err(format!("conserved momenta change by {change:.1e}: {expected:?} to {now:?} in step {k}"));
        }
        largest = f64::max(largest, change);
    }
    Ok(largest)
}

/// The derived energy against ⟨N, ξ⟩ − ℓ of the oracle's continuous Lagrangian.
fn energies(problem: &Declared, stepper: &mut Stepper<'_, '_>, start: &State<f64>) -> Result<f64, String> {
    let Some(derived) = stepper.energy(0.0, &seen(problem, start)) else { return Err("no velocity is found".into()) };
    let Some(exact) = energy(problem, 0.0, &start.q, &start.n) else {
        return Err("the oracle finds no velocity".into());
    };
    let difference = (derived - exact).abs() / exact.abs().max(1.0);
    match difference < 1e-8 {
        true => Ok(difference),
        false => Err(format!("the energy is {derived}, that of the oracle {exact}")),
    }
}

/// A step is composed exactly where the adjoint is another one.
fn time_symmetry(problem: &Declared, start: &State<DoubleDouble>, composed: bool) -> Result<(), String> {
    let h = DoubleDouble::of(H);
    let lost = |lost| format!("the adjoint has no step: {lost:?}");
    let forward = step(problem, h, DoubleDouble::zero(), start).map_err(lost)?;
    let adjoint = step(&Adjoint(problem), h, DoubleDouble::zero(), start).map_err(lost)?;
    let numbers = |state: &State<DoubleDouble>| {
        let q: Vec<DoubleDouble> = state.q.iter().flat_map(Matrix::entries).copied().collect();
        [q, state.n.clone()].concat()
    };
    let gap = numbers(&forward).iter().zip(numbers(&adjoint)).fold(0.0, |max, (&a, b)| f64::max(max, (a - b).size()));
    match (composed, gap > 1e-24) {
        (false, true) => Err(format!("called time-symmetric, but the adjoint is {gap:.1e} away")),
        (true, false) => Err(format!("composed, though the adjoint is {gap:.1e} away")),
        _ => Ok(()),
    }
}
