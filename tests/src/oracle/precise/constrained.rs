//! Motions and steps with a constraint: the principle of Lagrange and d'Alembert, with multipliers as unknowns.
//!
//! A constraint is a defect A ξ − b, affine in the velocity. That of places φ(t, q) = 0 is the change of φ in time. The
//! multipliers of a motion come from differences of the defect along the motion without a constraint.

use super::dual::{Dual, constant, moving};
use super::equation::{Equation, start_tangent};
use super::matrix::Matrix;
use super::problem::{Factor, Problem, Side, elements, identity};
use super::real::Real;
use super::step::State;

/// A problem with a constraint, and with a Lagrangian ½ ξ·Σξ + A·ξ − V.
pub trait Constrained: Problem + Sized {
    /// ℓ(t, q, ξ) of the continuous system.
    fn continuous<R: Real>(&self, t: R, q: &[Matrix<R>], xi: &[R]) -> R;

    /// A(t, q) ξ − b(t, q).
    fn defect<R: Real>(&self, t: R, q: &[Matrix<R>], xi: &[R]) -> Vec<R>;

    /// ψ(t, h, q, F) of a step, with the scale of a velocity.
    fn between<R: Real>(&self, t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> Vec<R>;

    /// Σ and A at one time and place.
    fn inertia(&self, t: f64, q: &[Matrix<f64>]) -> Inertia {
        Inertia::of(self, t, q)
    }
}

/// The quadratic part of a cost in F = exp(ξ), times h. It is the kinetic energy if the kinetic part is a function of q and
/// F, divided by h.
pub fn kinetic_energy_of_cost<P: Problem, R: Real>(problem: &P, t: R, q: &[Matrix<R>], xi: &[R]) -> R {
    let twice = |x: R| Dual::constant(Dual::constant(x));
    let mut from = 0;
    let element = |factor: &Factor| {
        let x = factor.group.combination(&xi[from..from + factor.group.basis.len()]);
        from += factor.group.basis.len();
        let (square, n) = (&x * &x, factor.group.size());
        let one = Matrix::<R>::identity(n);
        Matrix::from_fn(n, n, |i, j| {
            let value = Dual { value: one[(i, j)], slope: x[(i, j)] };
            Dual { value, slope: Dual { value: x[(i, j)], slope: square[(i, j)] } }
        })
    };
    let f: Vec<_> = problem.factors().iter().map(element).collect();
    let q: Vec<_> = q.iter().map(|leaf| leaf.map(twice)).collect();
    // other powers of h vanish in rounding
    let h = twice(R::of(f64::exp2(-60.0)));
    (problem.cost(twice(t), h, &q, &f) * h).slope.slope * 0.5
}

/// Σ and A of a kinetic energy.
#[derive(Clone, Debug)]
pub struct Inertia {
    /// Σ
    pub matrix: Matrix<f64>,
    /// A
    pub slope: Vec<f64>,
}

impl Inertia {
    /// By the values of ℓ at single velocities and at pairs of them.
    pub fn of<P: Constrained>(problem: &P, t: f64, q: &[Matrix<f64>]) -> Inertia {
        let count: usize = problem.factors().iter().map(|factor| factor.group.basis.len()).sum();
        let at = |parts: &[(usize, f64)]| {
            let mut xi = vec![0.0; count];
            parts.iter().for_each(|&(i, x)| xi[i] += x);
            problem.continuous(t, q, &xi)
        };
        let origin = at(&[]);
        let single: Vec<f64> = (0..count).map(|i| at(&[(i, 1.0)]) - origin).collect();
        let pair = |i: usize, j: usize| at(&[(i, 1.0), (j, 1.0)]) - origin - single[i] - single[j];
        let upper: Vec<Vec<f64>> = (0..count).map(|i| (i..count).map(|j| pair(i, j)).collect()).collect();
        let matrix = Matrix::from_fn(count, count, |i, j| upper[i.min(j)][i.max(j) - i.min(j)]);
        let slope = (0..count).map(|i| (single[i] - (at(&[(i, -1.0)]) - origin)) / 2.0).collect();
        Inertia { matrix, slope }
    }

    /// Σ⁻¹(N − A).
    pub fn velocity<R: Real>(&self, n: &[R]) -> Vec<R> {
        let moving: Vec<R> = n.iter().zip(&self.slope).map(|(&n, &slope)| n - R::of(slope)).collect();
        self.matrix.lift().solve(&Matrix::vector(&moving)).entries().to_vec()
    }

    /// Σξ + A.
    pub fn momentum(&self, xi: &[f64]) -> Vec<f64> {
        let moving = &self.matrix * &Matrix::vector(xi);
        moving.entries().iter().zip(&self.slope).map(|(n, slope)| n + slope).collect()
    }
}

/// A, row by row.
pub fn rows<P: Constrained, R: Real>(problem: &P, t: R, q: &[Matrix<R>], count: usize) -> Matrix<R> {
    let at = |xi: &[R]| problem.defect(t, q, xi);
    let origin = at(&vec![R::zero(); count]);
    let unit = |j: usize| (0..count).map(|i| if i == j { R::one() } else { R::zero() }).collect::<Vec<R>>();
    let columns: Vec<Vec<R>> = (0..count).map(|j| at(&unit(j))).collect();
    Matrix::from_fn(origin.len(), count, |i, j| columns[j][i] - origin[i])
}

/// N + Aᵀκ with A ξ = b, and κ.
pub fn projected<P: Constrained, R: Real>(
    problem: &P,
    inertia: &Inertia,
    (t, q, n): (R, &[Matrix<R>], &[R]),
) -> (Vec<R>, Vec<R>) {
    let rows = rows(problem, t, q, n.len());
    let missing: Vec<R> = problem.defect(t, q, &inertia.velocity(n)).into_iter().map(|defect| -defect).collect();
    let metric = &rows * &inertia.matrix.lift().solve(&rows.transpose());
    let kappa = metric.solve(&Matrix::vector(&missing));
    let push = rows.transpose() * &kappa;
    (n.iter().zip(push.entries()).map(|(&n, &push)| n + push).collect(), kappa.entries().to_vec())
}

/// A step with the impulses λ at its start and μ at its end.
#[derive(Clone, Debug)]
pub struct Pushed<R> {
    /// The state after the step.
    pub state: State<R>,
    /// λ and μ.
    pub impulses: [Vec<R>; 2],
}

/// r(F) = N + Aᵀλ with ψ(q, F) = 0, then q⁺ = Φ_F q and N⁺ = F⁺ℓd + Aᵀμ with A ξ = b there. Newton's method starts at
/// F = I. Its Jacobian is rounded to `f64`. `None` without convergence.
pub fn constrained_step<P: Constrained, R: Real>(problem: &P, (h, t): (R, R), state: &State<R>) -> Option<Pushed<R>> {
    let factors = problem.factors();
    let equation = Equation { problem, factors: &factors, t, h, q: &state.q };
    let count = state.n.len();
    let rows = rows(problem, t, &state.q, count);
    let near = rows.map(R::to_f64);
    let number = rows.shape().0;
    let mut f = identity(&factors);
    let mut lambda = vec![R::zero(); number];
    let mut previous = f64::INFINITY;
    for _ in 0..60 {
        let push = rows.transpose() * &Matrix::vector(&lambda);
        let residual = equation.residual(&f);
        let missing = (0..count).map(|i| state.n[i] + push.entries()[i] - residual[i]);
        let missing: Vec<R> = missing.chain(problem.between(t, h, &state.q, &f).into_iter().map(|psi| -psi)).collect();
        let (slope, bent) = (equation.jacobian(&f), slope_between(problem, (t, h), &factors, (&state.q, &f)));
        let bordered = Matrix::from_fn(count + number, count + number, |i, j| match (i < count, j < count) {
            (true, true) => slope[(i, j)],
            (true, false) => -near[(j - count, i)],
            (false, true) => bent[(i - count, j)],
            (false, false) => 0.0,
        });
        let change = bordered.lift().solve(&Matrix::vector(&missing));
        let (x, more) = change.entries().split_at(count);
        let size = Matrix::vector(x).size();
        if size.is_nan() || size > previous && previous < 1e4 * R::LAST_CORRECTION {
            break;
        }
        let changes = elements(&factors, x);
        f = (0..f.len()).map(|k| start_tangent(factors[k].side, &f[k], &changes[k])).collect();
        lambda.iter_mut().zip(more).for_each(|(lambda, &more)| *lambda = *lambda + more);
        previous = size;
        if size < R::LAST_CORRECTION {
            break;
        }
    }
    if previous > 1e4 * R::LAST_CORRECTION || previous.is_nan() {
        return None;
    }
    let q = problem.act(&f, &state.q);
    let nearest: Vec<_> = q.iter().map(|leaf| leaf.map(R::to_f64)).collect();
    let inertia = problem.inertia((t + h).to_f64(), &nearest);
    let (n, mu) = projected(problem, &inertia, (t + h, &q, &equation.next_momentum(&f)));
    Some(Pushed { state: State { q, n }, impulses: [lambda, mu] })
}

/// ∂ψ/∂x along the updates of F.
fn slope_between<P: Constrained, R: Real>(
    problem: &P,
    (t, h): (R, R),
    factors: &[Factor],
    (q, f): (&[Matrix<R>], &[Matrix<R>]),
) -> Matrix<f64> {
    let nearest = |matrix: &Matrix<R>| matrix.map(R::to_f64);
    let (f, q): (Vec<_>, Vec<_>) = (f.iter().map(nearest).collect(), q.iter().map(nearest).collect());
    let (t, h) = (Dual::of(t.to_f64()), Dual::of(h.to_f64()));
    let basis = factors.iter().enumerate().flat_map(|(k, factor)| factor.group.basis.iter().map(move |e| (k, e)));
    let column = |(k, e): (usize, &Matrix<f64>)| {
        problem.between(t, h, &constant(&q), &moving(&f, k, &start_tangent(factors[k].side, &f[k], e)))
    };
    let columns: Vec<_> = basis.map(column).collect();
    Matrix::from_fn(columns[0].len(), columns.len(), |i, j| columns[j][i].slope)
}

/// The change of φ(t, q) in time where q moves with the velocity ξ.
pub fn change_in_time<P: Problem, R: Real>(
    problem: &P,
    (t, q, xi): (R, &[Matrix<R>], &[R]),
    places: impl Fn(Dual<R>, &[Matrix<Dual<R>>]) -> Vec<Dual<R>>,
) -> Vec<R> {
    let (t, q) = (Dual { value: t, slope: R::one() }, moved(problem, q, xi));
    places(t, &q).into_iter().map(|place| place.slope).collect()
}

/// q with its change by ξ.
fn moved<P: Problem, R: Real>(problem: &P, q: &[Matrix<R>], xi: &[R]) -> Vec<Matrix<Dual<R>>> {
    let factors = problem.factors();
    let mut from = 0;
    let tangent = |factor: &Factor| {
        let slope = factor.group.combination(&xi[from..from + factor.group.basis.len()]);
        from += factor.group.basis.len();
        let one = Matrix::<R>::identity(factor.group.size());
        let (rows, columns) = slope.shape();
        Matrix::from_fn(rows, columns, |i, j| Dual { value: one[(i, j)], slope: slope[(i, j)] })
    };
    let near_one: Vec<_> = factors.iter().map(tangent).collect();
    problem.act(&near_one, &constant(q))
}

/// The velocity and N′ of the motion without a constraint: N′ = ± ad*_ξ N + J(q, ∂ℓ/∂q).
fn free<P: Constrained>(problem: &P, t: f64, q: &[Matrix<f64>], n: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let xi = problem.inertia(t, q).velocity(n);
    let mut change = Vec::new();
    let constants: Vec<Dual<f64>> = xi.iter().map(|&x| Dual::constant(x)).collect();
    for factor in &problem.factors() {
        let (from, basis) = (change.len(), &factor.group.basis);
        let velocity = factor.group.combination(&xi[from..from + basis.len()]);
        let gram = Matrix::from_fn(basis.len(), basis.len(), |i, j| basis[i].dot(&basis[j]));
        for (j, e) in basis.iter().enumerate() {
            let bracket = &velocity * e - e * &velocity;
            let inner: Vec<f64> = basis.iter().map(|e| e.dot(&bracket)).collect();
            let carried = gram.solve(&Matrix::vector(&inner)).dot(&Matrix::vector(&n[from..from + basis.len()]));
            let unit: Vec<f64> = (0..n.len()).map(|i| f64::from(u8::from(i == from + j))).collect();
            let pushed = problem.continuous(Dual::constant(t), &moved(problem, q, &unit), &constants).slope;
            change.push(pushed + if factor.side == Side::Left { -carried } else { carried });
        }
    }
    (xi, change)
}

/// ε of the differences in time.
const DIFFERENCE: f64 = 1e-3;

/// λ of the motion N′ = N′_free + Aᵀλ: −S⁻¹ d/dt (A ξ − b), by differences along the motion without a constraint.
pub fn reactions<P: Constrained>(problem: &P, (t, q, n): (f64, &[Matrix<f64>], &[f64])) -> Vec<f64> {
    let (xi, change) = free(problem, t, q, n);
    let factors = problem.factors();
    let at = |s: f64| {
        let path: Vec<f64> = xi.iter().map(|x| x * s).collect();
        let q = problem.act(&elements(&factors, &path), q);
        let n: Vec<f64> = n.iter().zip(&change).map(|(n, change)| n + s * change).collect();
        problem.defect(t + s, &q, &problem.inertia(t + s, &q).velocity(&n))
    };
    let [a, b, c, d] = [1.0, -1.0, 2.0, -2.0].map(|k| at(k * DIFFERENCE));
    let slope = |i: usize| (8.0 * (a[i] - b[i]) - (c[i] - d[i])) / (12.0 * DIFFERENCE);
    let missing: Vec<f64> = (0..a.len()).map(|i| -slope(i)).collect();
    let rows = rows(problem, t, q, n.len());
    let metric = &rows * &problem.inertia(t, q).matrix.solve(&rows.transpose());
    metric.solve(&Matrix::vector(&missing)).entries().to_vec()
}

/// The motion with the constraint, by the classical method of order 4 in so many steps.
pub fn motion<P: Constrained>(problem: &P, start: &State<f64>, (time, steps): (f64, usize)) -> State<f64> {
    let slope = |t: f64, at: &State<f64>| {
        let lambda = reactions(problem, (t, &at.q, &at.n));
        let (xi, change) = free(problem, t, &at.q, &at.n);
        let push = rows(problem, t, &at.q, at.n.len()).transpose() * &Matrix::vector(&lambda);
        let q = moved(problem, &at.q, &xi).iter().map(|leaf| leaf.map(|entry| entry.slope)).collect();
        State { q, n: change.iter().zip(push.entries()).map(|(change, push)| change + push).collect() }
    };
    let sum = |at: &State<f64>, slope: &State<f64>, s: f64| State {
        q: at.q.iter().zip(&slope.q).map(|(q, slope)| q + slope * s).collect(),
        n: at.n.iter().zip(&slope.n).map(|(n, slope)| n + slope * s).collect(),
    };
    let h = time / steps as f64;
    (0..steps).fold(start.clone(), |state, k| {
        let t = k as f64 * h;
        let a = slope(t, &state);
        let b = slope(t + h / 2.0, &sum(&state, &a, h / 2.0));
        let c = slope(t + h / 2.0, &sum(&state, &b, h / 2.0));
        let d = slope(t + h, &sum(&state, &c, h));
        let parts = [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)];
        parts.iter().fold(state, |state, (slope, weight)| sum(&state, slope, weight * h / 6.0))
    })
}
