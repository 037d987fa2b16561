//! The laws of problems with a constraint.
//!
//! A step is that of the oracle, whose multipliers are unknowns. It obeys the constraint, returns when it is run back, and
//! approaches the motion of Lagrange and d'Alembert with the square of the step. The multipliers of a state are those of
//! differences along the motion. A refusal names a replacement, which is applied and accepted.

use std::cell::OnceCell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use clebsch_compiler::Graph;
use clebsch_compiler::lower::MechanicsProgram;
use clebsch_tests::oracle::precise::constrained::{
    Constrained, Inertia, change_in_time, constrained_step, kinetic_energy_of_cost, motion, projected, reactions, rows,
};
use clebsch_tests::oracle::precise::double_double::DoubleDouble;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::{Factor, Problem};
use clebsch_tests::oracle::precise::real::Real;
use clebsch_tests::oracle::precise::step::State;
use clebsch_tests::oracle::random::Random;
use proc_macro2::TokenStream;

use crate::checks::{distance, mechanics, rounded, seen, unseen};
use crate::formula::Formula;
use crate::generator;
use crate::problem::{Declared, Discretization, Kinetic, velocity};
use crate::stepping::{Seen, Stepper};

/// The step.
const H: f64 = 0.05;
/// The steps that are compared with the oracle.
const STEPS: usize = 2;
/// Rows that make larger multipliers of momenta of size one depend on each other, or nearly.
const STIFFEST: f64 = 30.0;
/// Steps of the oracle and of the program differ by rounding.
const ROUNDING: f64 = 1e-12;

/// The results of a problem that passed.
#[derive(Clone, Debug, Default)]
#[allow(dead_code, reason = "some of it is only shown")]
pub struct Tied {
    /// Whether it was stepped. Others have no equation left, are too large, are matrix code, or have dependent rows at the start.
    pub stepped: bool,
    pub is_large: bool,
    /// The first lines of refusals whose replacements were applied.
    pub refused: Vec<String>,
    pub of_velocity: bool,
    pub of_places: bool,
    /// Whether A or b depends on time or configuration, and whether a pole is among them.
    pub is_bent: bool,
    pub has_poles: bool,
    pub is_affine: bool,
    pub of_each: bool,
    pub has_moving_inertia: bool,
    pub conserved: usize,
    pub deviation: f64,
    pub reaction: f64,
    /// The ratio of the errors of two step sizes, where it was measured.
    pub ratio: Option<f64>,
}

/// A problem with the velocity that its steps take.
struct Of<'a> {
    declared: &'a Declared,
    of_step: Discretization,
    /// Whether ψ is the mean of both ends.
    is_mean_of_ends: bool,
    /// Whether the inertia depends on time or configuration; else it is computed once.
    is_moving: bool,
    constant: OnceCell<Inertia>,
}

impl Of<'_> {
    fn values<R: Real>(&self, formulas: &[Formula], t: R, q: &[Matrix<R>], xi: &[R]) -> Vec<R> {
        let (mut seen, fields) = (self.declared.seen(q, &[]), self.declared.values());
        seen.xi = if xi.is_empty() { Vec::new() } else { self.parted(xi) };
        let place = self.declared.place(&seen, t, R::zero(), &fields);
        formulas.iter().flat_map(|formula| formula.value(&place).entries().to_vec()).collect()
    }

    fn parted<R: Real>(&self, mut xi: &[R]) -> Vec<Matrix<R>> {
        let mut part = |count| {
            let (part, rest) = xi.split_at(count);
            xi = rest;
            Matrix::vector(part)
        };
        self.declared.factors.iter().map(|factor| part(factor.group.group.basis.len())).collect()
    }

    fn places<R: Real>(&self, t: R, q: &[Matrix<R>]) -> Vec<R> {
        self.values(&self.declared.differences(false), t, q, &[])
    }

    fn of_velocity<R: Real>(&self, t: R, q: &[Matrix<R>], xi: &[R]) -> Vec<R> {
        self.values(&self.declared.differences(true), t, q, xi)
    }

    /// Whether the inertia depends on time or configuration.
    fn has_moving_inertia(&self) -> bool {
        let moves = |part: &Formula| matches!(part, Formula::Time | Formula::Point(_));
        match &self.declared.kinetic {
            Kinetic::Cost(kinetic) | Kinetic::Lagrangian(kinetic, _) | Kinetic::MoserVeselov(kinetic, _) => {
                kinetic.mentions(&moves)
            }
        }
    }
}

impl Problem for Of<'_> {
    fn factors(&self) -> Vec<Factor> {
        self.declared.factors()
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        self.declared.act(f, q)
    }
    fn cost<R: Real>(&self, t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        self.declared.cost(t, h, q, f)
    }
    fn potential<R: Real>(&self, t: R, q: &[Matrix<R>]) -> R {
        self.declared.potential(t, q)
    }
}

impl Constrained for Of<'_> {
    fn continuous<R: Real>(&self, t: R, q: &[Matrix<R>], xi: &[R]) -> R {
        let potential = self.declared.potential(t, q);
        if let Kinetic::Lagrangian(lagrangian, _) | Kinetic::MoserVeselov(lagrangian, _) = &self.declared.kinetic {
            return self.values(std::slice::from_ref(lagrangian), t, q, xi)[0] - potential;
        }
        let identity = |factor: &Factor| Matrix::identity(factor.group.size());
        let one: Vec<Matrix<R>> = self.declared.factors().iter().map(identity).collect();
        // without motion a cost is h times a function of t and q
        let h = R::of(f64::exp2(-60.0));
        kinetic_energy_of_cost(self.declared, t, q, xi) + self.declared.cost(t, h, q, &one) / h - potential
    }

    fn inertia(&self, t: f64, q: &[Matrix<f64>]) -> Inertia {
        match self.is_moving {
            true => Inertia::of(self, t, q),
            false => self.constant.get_or_init(|| Inertia::of(self, t, q)).clone(),
        }
    }

    fn defect<R: Real>(&self, t: R, q: &[Matrix<R>], xi: &[R]) -> Vec<R> {
        let mut all = change_in_time(self, (t, q, xi), |t, q| self.places(t, q));
        all.extend(self.of_velocity(t, q, xi));
        all
    }

    fn between<R: Real>(&self, t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> Vec<R> {
        let next = self.act(f, q);
        let mut all: Vec<R> = self.places(t + h, &next).into_iter().map(|place| place / h).collect();
        let factors = self.declared.factors.iter().zip(f);
        let xi = factors.map(|(factor, f)| velocity(factor, self.of_step, h, f).entries().to_vec());
        let xi: Vec<R> = xi.collect::<Vec<_>>().concat();
        let of_velocity = if self.is_mean_of_ends {
            let (start, end) = (self.of_velocity(t, q, &xi), self.of_velocity(t + h, &next, &xi));
            start.into_iter().zip(end).map(|(a, b)| (a + b) * 0.5).collect()
        } else {
            let mean: Vec<_> = q.iter().zip(&next).map(|(a, b)| (a + b).map(|x| x * 0.5)).collect();
            self.of_velocity(t + h * 0.5, &mean, &xi)
        };
        all.extend(of_velocity);
        all
    }
}

/// Compiles the random problem of a seed after the replacements that refusals name, and checks its steps.
///
/// # Errors
/// The law that fails, in words.
pub fn check_seed(seed: u64, is_thorough: bool) -> Result<Tied, String> {
    check(&generator::constrained(seed, false), seed, is_thorough)
}

/// The same of a problem of this seed.
pub fn check(problem: &Declared, seed: u64, is_thorough: bool) -> Result<Tied, String> {
    let mut problem = problem.clone();
    let run = || accepted(&mut problem, seed).and_then(|found| stepped(&problem, found, (seed, is_thorough)));
    let result = catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        Err(format!("panic: {}", text.or(panic.downcast_ref::<&str>().map(|s| s.to_string())).unwrap_or_default()))
    });
    result.map_err(|error| format!("seed {seed}: {error}\n{}", problem.text()))
}

/// The first line of the refusal of a problem, if it is refused.
fn refusal(problem: &Declared) -> Result<Option<(String, String)>, String> {
    let tokens: TokenStream = problem.text().parse().map_err(|error| format!("no tokens: {error}"))?;
    let errors = match mechanics(&Graph::new(), tokens) {
        Ok(_) => return Ok(None),
        Err(errors) => errors.to_string(),
    };
    Ok(Some((errors.lines().next().unwrap_or_default().to_string(), errors)))
}

/// Applies the replacement of each refusal, until the problem is accepted, has no equation, or is too large. No refusal
/// comes back after its replacement.
fn accepted(problem: &mut Declared, seed: u64) -> Result<Tied, String> {
    let mut found = Tied::default();
    if problem.constraint.is_empty() {
        return Ok(found);
    }
    while let Some((said, whole)) = refusal(problem)? {
        if whole.contains("is too large") {
            return Ok(Tied { is_large: true, ..found });
        }
        if found.refused.last() == Some(&said) || found.refused.len() > 12 {
            return Err(format!("refused again after its replacement:\n{whole}"));
        }
        *problem = replaced(problem, (&said, &whole), seed)?;
        found.refused.push(said);
        if problem.constraint.is_empty() {
            return Ok(found);
        }
    }
    Ok(Tied { stepped: true, ..found })
}

/// The problem as the help of its refusal says.
fn replaced(problem: &Declared, (said, whole): (&str, &str), seed: u64) -> Result<Declared, String> {
    let mut problem = problem.clone();
    let helps = |help: &str| whole.contains(help);
    if said.contains("has order 2, 4, 6 or 8") && helps("write `order = 2`") {
        problem.order = 2;
    } else if helps("declare the full attitude") {
        return Ok(generator::constrained(seed, true));
    } else if helps("write a `lagrangian`") || helps("write a kinetic energy that is a quadratic form") {
        let part = |k| Formula::Velocity(k).method("norm_squared") / Formula::Number(2.0);
        let sum = (0..problem.factors.len()).map(part).reduce(|a, b| a + b).expect("a factor");
        problem.kinetic = Kinetic::Lagrangian(sum, Discretization::LeftOut);
    } else if said.contains("is not the same forwards and backwards") && helps("leave `discretization` out") {
        let Kinetic::Lagrangian(lagrangian, Discretization::Projection) = problem.kinetic else {
            return Err(format!("it has no projection:\n{whole}"));
        };
        problem.kinetic = Kinetic::Lagrangian(lagrangian, Discretization::LeftOut);
    } else if helps("leave it out") || helps("leave out those that follow from others") {
        return without(&problem, said).ok_or_else(|| format!("no equation can be left out:\n{whole}"));
    } else {
        return Err(format!("refused:\n{whole}"));
    }
    Ok(problem)
}

/// The problem without the equation that is to be left out.
fn without(problem: &Declared, said: &str) -> Option<Declared> {
    let places = problem.constraint.iter().enumerate();
    let places: Vec<_> = places.flat_map(|(k, closure)| (0..closure.all.len()).map(move |at| (k, at))).collect();
    let others = places.into_iter().rev().map(|place| {
        let mut other = problem.clone();
        other.without_equation(place);
        other
    });
    let is_mended = |other: &Declared| match refusal(other) {
        Ok(None) => true,
        Ok(Some((first, _))) => first != said,
        Err(_) => false,
    };
    others.into_iter().find(is_mended)
}

/// Whether a velocity of a step is Cayley's: where that map stays in all groups.
fn of_step(problem: &Declared, program: &MechanicsProgram<'_>) -> Discretization {
    let model = &program.formulas.model;
    let is_cayley =
        model.factors.iter().all(|factor| factor.group.is_translation() || factor.group.has_cayley_chart(model.graph));
    match &problem.kinetic {
        Kinetic::Lagrangian(_, chosen @ (Discretization::Exponential | Discretization::Projection)) => *chosen,
        _ if is_cayley => Discretization::Cayley,
        _ => Discretization::Exponential,
    }
}

/// Whether a formula has a quotient by a function of a configuration that lies on a group.
fn has_pole_on_group(problem: &Declared, formula: &Formula) -> bool {
    let is_bent = |part: &Formula| {
        let lies = |k: usize| {
            !["SVector", "SMatrix", "Vector", "Translation"]
                .iter()
                .any(|space| problem.leaves[k].type_name.starts_with(space))
        };
        matches!(part, Formula::Point(k) if lies(*k))
    };
    formula.mentions(&|part| matches!(part, Formula::Operator('/', pair) if pair[1].mentions(&is_bent)))
}

fn stepped(problem: &Declared, mut found: Tied, (seed, is_thorough): (u64, bool)) -> Result<Tied, String> {
    if !found.stepped {
        return Ok(found);
    }
    let graph = Graph::new();
    let tokens: TokenStream = problem.text().parse().map_err(|error| format!("no tokens: {error}"))?;
    let program = mechanics(&graph, tokens).map_err(|errors| format!("refused:\n{errors}"))?;
    // matrix code stands in for unrolled code that is too long
    if program.form.is_beyond {
        return Ok(Tied { stepped: false, ..found });
    }
    let of_velocity = problem.differences(true);
    let has = |which: &dyn Fn(&Formula) -> bool| of_velocity.iter().any(|formula| formula.mentions(which));
    let mut of = Of {
        declared: problem,
        of_step: of_step(problem, &program),
        is_mean_of_ends: of_velocity.iter().any(|formula| has_pole_on_group(problem, formula)),
        is_moving: false,
        constant: OnceCell::new(),
    };
    of.is_moving = of.has_moving_inertia();
    found.has_moving_inertia = of.is_moving;
    found.of_velocity = !of_velocity.is_empty();
    found.of_places = problem.constraint.iter().any(|closure| !closure.of_velocity);
    found.is_bent = has(&|part| matches!(part, Formula::Point(_) | Formula::Time));
    found.has_poles = of.is_mean_of_ends;
    found.of_each = problem.constraint.iter().any(|closure| closure.all.iter().any(|equation| equation.each));
    found.conserved = program.formulas.symmetries.conserved.len();

    let Some((start, xi)) = start(&of, seed) else { return Ok(Tied { stepped: false, ..found }) };
    let zero = vec![0.0; xi.len()];
    found.is_affine = of.defect(0.0, &start.q, &zero).iter().any(|value| value.abs() > 1e-6);
    let fields: Vec<Vec<f64>> = problem.fields.iter().map(|field| field.value.entries().to_vec()).collect();
    let mut stepper = Stepper::new(&program, &fields, H);
    let first = seen(problem, &start);
    near("the momentum of a velocity", &stepper.momentum_of(0.0, &first, &xi), &start.n, ROUNDING)?;

    // steps, and their impulses
    let (mut exact, mut state) = (start.lift::<DoubleDouble>(), first.clone());
    let conserved = stepper.conserved(0.0, &first);
    for k in 0..STEPS {
        let t = k as f64 * H;
        let stiffness = stiffness(&of, t, &seen_by_oracle(problem, &state));
        let pushed = constrained_step(&of, (DoubleDouble::of(H), DoubleDouble::of(t)), &exact);
        let own = stepper.step(t, &state);
        let (pushed, next) = match (pushed, own) {
            (Some(pushed), Ok(next)) => (pushed, next),
            (None, Err(_)) => return Ok(Tied { stepped: false, ..found }),
            // next to places where rows depend on each other, steps may be too long for one of both
            (pushed, own) => {
                let short = H / 8.0;
                let oracle = constrained_step(&of, (DoubleDouble::of(short), DoubleDouble::of(t)), &exact);
                return match (oracle, Stepper::new(&program, &fields, short).step(t, &state)) {
                    (Some(_), Ok(_)) => Ok(Tied { stepped: false, ..found }),
                    _ => Err(format!("the oracle has a step: {}, {own:?}", pushed.is_some())),
                };
            }
        };
        let back = state.clone();
        state = next;
        exact = pushed.state;
        let off = distance(problem, &exact, &state);
        if off.is_nan() || off > ROUNDING {
            return Err(format!("step {} is {off:.1e} from the oracle", k + 1));
        }
        found.deviation = found.deviation.max(off);
        for (at, exact) in pushed.impulses.iter().enumerate() {
            let exact: Vec<f64> = exact.iter().map(|impulse| impulse.to_f64()).collect();
            near(["λ of a step", "μ of a step"][at], &stepper.impulses[at], &exact, 1e-13 / H * stiffness)?;
        }
        obeys(&of, &mut stepper, (t + H, &state))?;
        let mut backwards = Stepper::new(&program, &fields, -H);
        let returned = backwards.step(t + H, &state)?;
        let flat = |state: &Seen| [state.q.concat(), state.mu.clone()].concat();
        near("a step there and back", &flat(&returned), &flat(&back), ROUNDING)?;
        near("conserved momenta", &stepper.conserved(t + H, &state), &conserved, ROUNDING)?;
    }

    // the multipliers of states
    for (t, place) in [(0.0, &start), (STEPS as f64 * H, &rounded(&exact))] {
        let expected = reactions(&of, (t, &place.q, &place.n));
        let lambda = stepper.reactions(t, &seen(problem, place));
        near("λ of a state", &lambda, &expected, 1e-10 * stiffness(&of, t, &place.q))?;
        let size = expected.iter().fold(1.0, |most: f64, lambda| most.max(lambda.abs()));
        let off = lambda.iter().zip(&expected).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        found.reaction = found.reaction.max(off / size);
    }
    // an inertia that moves is found anew in every evaluation
    if is_thorough && (!of.is_moving || xi.len() <= 3) {
        found.ratio = order(&of, &program, (&fields, &start))?;
    }
    Ok(found)
}

/// The largest entry of S⁻¹A Σ⁻¹, which makes multipliers of momenta, and one at least.
fn stiffness(of: &Of<'_>, t: f64, q: &[Matrix<f64>]) -> f64 {
    let inertia = of.inertia(t, q);
    let rows = rows(of, t, q, inertia.slope.len());
    let by_inertia = inertia.matrix.transpose().solve(&rows.transpose()).transpose();
    let metric = &by_inertia * &rows.transpose();
    metric.solve(&by_inertia).size().max(1.0)
}

/// The configuration of a state as the oracle has it.
fn seen_by_oracle(problem: &Declared, state: &Seen) -> Vec<Matrix<f64>> {
    problem.leaves.iter().zip(&state.q).map(|(leaf, entries)| unseen(leaf, entries)).collect()
}

/// A configuration with φ = 0, a velocity that obeys the constraint, and its momentum. `None` where rows are dependent,
/// or nearly so.
fn start(of: &Of<'_>, seed: u64) -> Option<(State<f64>, Vec<f64>)> {
    let random = &mut Random::new(seed ^ 0x71ed);
    let q: Vec<Matrix<f64>> = of.declared.leaves.iter().map(|leaf| leaf.start.clone()).collect();
    let inertia = of.inertia(0.0, &q);
    let xi: Vec<f64> = inertia.slope.iter().map(|_| random.number() * 0.5).collect();
    let mut n = inertia.momentum(&xi);
    for _ in 0..3 {
        n = projected(of, &inertia, (0.0, &q, &n)).0;
    }
    let xi = inertia.velocity(&n);
    let is_slow = xi.iter().all(|xi| xi.abs() < 2.0);
    let defect =
        of.defect(0.0, &q, &xi).iter().fold(0.0, |most: f64, x| if x.is_nan() { x.abs() } else { most.max(x.abs()) });
    (is_slow && defect < 1e-14 && stiffness(of, 0.0, &q) < STIFFEST).then_some((State { q, n }, xi))
}

/// The constraint at a state, by the program and by the declared equations.
fn obeys(of: &Of<'_>, stepper: &mut Stepper<'_, '_>, (t, state): (f64, &Seen)) -> Result<(), String> {
    let own = stepper.defects(t, state).concat();
    let q = seen_by_oracle(of.declared, state);
    let xi = of.inertia(t, &q).velocity(&state.mu);
    let declared = [of.places(t, &q), of.defect(t, &q, &xi)].concat();
    near("the constraint after a step", &declared, &vec![0.0; declared.len()], 1e-13)?;
    near("A, b and φ at a state", &own, &declared, 1e-13)
}

/// The ratio of the errors of four and of eight steps, against the continuous motion.
fn order(
    of: &Of<'_>,
    program: &MechanicsProgram<'_>,
    (fields, start): (&[Vec<f64>], &State<f64>),
) -> Result<Option<f64>, String> {
    const TIME: f64 = 0.2;
    const FASTER: f64 = 4.0;
    let exact = motion(of, start, (TIME, 20));
    // where rows come to depend on each other, the motion ends with large velocities
    let size =
        |n: &[f64]| n.iter().fold(1.0, |most: f64, n| if n.is_nan() { f64::INFINITY } else { most.max(n.abs()) });
    if size(&exact.n) > FASTER * size(&start.n) {
        return Ok(None);
    }
    let exact = seen(of.declared, &exact);
    let error = |steps: usize| -> Result<f64, String> {
        let h = TIME / steps as f64;
        let mut stepper = Stepper::new(program, fields, h);
        let mut state = seen(of.declared, start);
        for k in 0..steps {
            state = stepper.step(k as f64 * h, &state)?;
        }
        let flat = |state: &Seen| [state.q.concat(), state.mu.clone()].concat();
        Ok(flat(&state).iter().zip(flat(&exact)).fold(0.0, |sum: f64, (a, b)| sum + (a - b).powi(2)).sqrt())
    };
    let (coarse, fine) = (error(4)?, error(8)?);
    // steps that are exact to the reference
    if fine < 1e-8 {
        return Ok(None);
    }
    let ratio = coarse / fine;
    if ratio > 3.0 { Ok(Some(ratio)) } else { Err(format!("errors of {coarse:.2e} and {fine:.2e} for half the step")) }
}

/// Numbers that agree, relative to the largest above one.
fn near(name: &str, found: &[f64], expected: &[f64], most: f64) -> Result<(), String> {
    let size = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
    let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= most * size;
    match found.len() == expected.len() && found.iter().zip(expected).all(is_near) {
        true => Ok(()),
        false => Err(format!("{name}: {found:?}, not {expected:?}")),
    }
}
