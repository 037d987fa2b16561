//! The equation of a step, F⁻ℓd(q, F) = N, and its solution.

use super::dual::{Dual, constant, moving};
use super::matrix::Matrix;
use super::problem::{Factor, Problem, Side, elements, identity};
use super::real::Real;

/// Pivots below this multiple of the largest entry are rounding errors.
const SINGULAR: f64 = 1e-11;

/// Why there is no step: the branch of solutions that starts at F = I ends, or is lost, on the way from r(I) to N.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct NoSolution {
    /// The fraction of the way for which there is a solution.
    pub reached: f64,
}

/// ℓd at one time and configuration, as a function of F.
pub struct Equation<'a, P, R> {
    /// Whose equation it is.
    pub problem: &'a P,
    /// The factors of the group.
    pub factors: &'a [Factor],
    /// The time at the start of the step.
    pub t: R,
    /// The step.
    pub h: R,
    /// The configuration at the start of the step.
    pub q: &'a [Matrix<R>],
}

impl<P: Problem, R: Real> Equation<'_, P, R> {
    /// F⁻ℓd: r(F)_i = ⟨T*L_F ∂_Fℓd, E_i⟩ − ⟨J(q, ∂_qℓd), E_i⟩ for a left action, T*R_F for a right one.
    ///
    /// That is the derivative of ℓd along q ↦ Φ_exp(−sE_i) q and F ↦ F exp(sE_i) or exp(sE_i) F, which leave Φ_F q
    /// where it is.
    pub fn residual(&self, f: &[Matrix<R>]) -> Vec<R> {
        let (one, q) = (identity(self.factors), constant(self.q));
        self.along_basis(|k, e| {
            let moved = self.problem.act(&moving(&one, k, &-e), &q);
            self.slope(&moved, &moving(f, k, &start_tangent(self.factors[k].side, &f[k], e)))
        })
    }

    /// F⁺ℓd: N⁺_i = ⟨T*R_F ∂_Fℓd, E_i⟩ for a left action, T*L_F for a right one.
    pub fn next_momentum(&self, f: &[Matrix<R>]) -> Vec<R> {
        let q = constant(self.q);
        self.along_basis(|k, e| self.slope(&q, &moving(f, k, &end_tangent(self.factors[k].side, &f[k], e))))
    }

    /// J(q, p)_i = ⟨p, (E_i)_Q(q)⟩.
    pub fn momentum_map(&self, p: &[Matrix<R>]) -> Vec<R> {
        let (one, q) = (identity(self.factors), constant(self.q));
        self.along_basis(|k, e| {
            let generator = self.problem.act(&moving(&one, k, e), &q);
            p.iter().zip(&generator).fold(R::zero(), |sum, (p, g)| sum + p.dot(&g.map(|entry| entry.slope)))
        })
    }

    /// F with r(F) = N by Newton's method from F = I.
    ///
    /// Where that fails, it follows the solutions of r(F) = r(I) + s (N − r(I)) for s from 0 to 1.
    pub fn solve(&self, n: &[R]) -> Result<Vec<Matrix<R>>, NoSolution> {
        let mut f = identity(self.factors);
        let origin = self.residual(&f);
        let (mut reached, mut stride) = (0.0, 1.0);
        while reached < 1.0 {
            let s = reached + stride;
            let goal: Vec<_> = origin.iter().zip(n).map(|(&r, &n)| r * (1.0 - s) + n * s).collect();
            match self.newton(&goal, &f) {
                Some(solution) => (f, reached, stride) = (solution, s, (2.0 * stride).min(1.0 - s)),
                None if stride > 1e-3 => stride /= 2.0,
                None => return Err(NoSolution { reached }),
            }
        }
        Ok(f)
    }

    /// F ← F exp(x) (left) or exp(x) F (right) with Dr x = N − r(F), as long as corrections at least halve.
    ///
    /// A cost that depends on Φ_F(q) alone leaves F open: Dr is singular, r(F) lies in its range, and any F will do.
    ///
    /// Dr is rounded to `f64`: corrections shrink quadratically, then by fifteen digits each, to the rounding error of r.
    fn newton(&self, n: &[R], start: &[Matrix<R>]) -> Option<Vec<Matrix<R>>> {
        let mut f = start.to_vec();
        let mut previous = f64::INFINITY;
        loop {
            let defect: Vec<_> = n.iter().zip(self.residual(&f)).map(|(&n, r)| n - r).collect();
            let x = self.jacobian(&f).lift().solve_in_range(&Matrix::vector(&defect), SINGULAR);
            let size = x.size() / f.iter().map(Matrix::size).fold(1.0, f64::max);
            if size > previous / 2.0 || size.is_nan() {
                return (previous < 1e4 * R::LAST_CORRECTION).then_some(f);
            }
            let changes = elements(self.factors, x.entries());
            f = (0..f.len()).map(|k| start_tangent(self.factors[k].side, &f[k], &changes[k])).collect();
            if size < R::LAST_CORRECTION {
                return Some(f);
            }
            previous = size;
        }
    }

    /// ∂r_i/∂x_j along the updates of Newton's method, by dual numbers over `f64` through those of r.
    pub(super) fn jacobian(&self, f: &[Matrix<R>]) -> Matrix<f64> {
        let nearest = |matrix: &Matrix<R>| matrix.map(R::to_f64);
        let (f, q): (Vec<_>, Vec<_>) = (f.iter().map(nearest).collect(), self.q.iter().map(nearest).collect());
        let (t, h) = (Dual::of(self.t.to_f64()), Dual::of(self.h.to_f64()));
        let Equation { problem, factors, .. } = *self;
        let dual = Equation { problem, factors, t, h, q: &constant(&q) };
        let near = Equation { problem, factors, t: t.value, h: h.value, q: &q };
        let columns = near.along_basis(|k, e| dual.residual(&moving(&f, k, &start_tangent(factors[k].side, &f[k], e))));
        Matrix::from_fn(columns.len(), columns.len(), |i, j| columns[j][i].slope)
    }

    /// Something for each E_i of each factor k.
    fn along_basis<T>(&self, component: impl Fn(usize, &Matrix<R>) -> T) -> Vec<T> {
        let numbered = self.factors.iter().enumerate();
        let basis = numbered.flat_map(|(k, factor)| factor.group.basis.iter().map(move |e| (k, e)));
        basis.map(|(k, e)| component(k, &e.lift())).collect()
    }

    fn slope(&self, q: &[Matrix<Dual<R>>], f: &[Matrix<Dual<R>>]) -> R {
        self.problem.lagrangian(Dual::constant(self.t), Dual::constant(self.h), q, f).slope
    }
}

/// FE for a left action, EF for a right one: Φ_{F exp(sE)} = Φ_F Φ_exp(sE), so the start moves before F acts.
pub(super) fn start_tangent<R: Real>(side: Side, f: &Matrix<R>, e: &Matrix<R>) -> Matrix<R> {
    match side {
        Side::Left => f * e,
        Side::Right => e * f,
    }
}

/// EF for a left action, FE for a right one: the end moves after F has acted.
fn end_tangent<R: Real>(side: Side, f: &Matrix<R>, e: &Matrix<R>) -> Matrix<R> {
    match side {
        Side::Left => e * f,
        Side::Right => f * e,
    }
}
