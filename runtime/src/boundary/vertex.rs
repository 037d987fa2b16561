//! One vertex in the backward sweep: its block of the Hessian, its elimination, and the sums over all of them.

use super::end::PathEnd;
use super::pivot::{Feedback, Pivot, Solution, lower_triangle};
use crate::linear::rows;
use crate::newton::Curvature;
use crate::space::larger;
use crate::{Edge, Real};
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

/// The results of a backward sweep for the path.
#[derive(Clone, Copy)]
pub(super) struct PathSummary<T, const M: usize> {
    /// Σ ℓd
    pub action: T,
    /// Twice the decrease of the action by Newton's correction.
    pub decrement: T,
    /// The size of Newton's correction relative to the path, in the norm of the Hessian.
    pub size: T,
    /// The largest |E_k|².
    pub residual_squared: T,
    /// The momentum at the end.
    pub after: SVector<T, M>,
    /// The Morse index.
    pub negative: usize,
    /// Σ|ℓd|
    pub magnitude: T,
    /// Σ|N_k|²
    pub momenta: T,
    /// Σ|tr ∂F⁺ℓd/∂η′|
    pub stiffness: T,
    /// The number of edges.
    pub edges: T,
    /// The sign of the step size: that of the Hessian at a minimum.
    pub sign: T,
}

impl<T: Real, const M: usize> PathSummary<T, M> {
    /// Whether the residual is at most so many units in the last place of the momentum, as the root of its mean square.
    pub fn is_stationary(&self, units: f64) -> bool {
        let unit = T::from_f64(units) * T::EPSILON;
        self.residual_squared * self.edges <= unit * unit * self.momenta
    }

    /// The size of a correction of vertices that is round-off.
    pub fn round_off(&self) -> T {
        T::from_f64(4.0) * T::EPSILON * self.edges.sqrt()
    }

    /// Adds to the sums that scale the correction.
    #[inline]
    pub fn count(&mut self, edge: &Edge<T, M>) {
        self.action += edge.lagrangian;
        self.magnitude += edge.lagrangian.abs();
        self.momenta += edge.before.dot(&edge.before);
        self.stiffness += edge.after_by_end.trace().abs();
    }

    /// The interior vertex where `edge` ends, after the elimination of the next one. The momentum before the next one
    /// is `later`.
    #[inline(always)]
    pub fn eliminate(
        &mut self,
        edge: &Edge<T, M>,
        next: &Solution<T, M>,
        later: &SVector<T, M>,
        curvature: Curvature<T>,
        feedback: &mut Feedback<T, M>,
    ) -> Solution<T, M> {
        let mut d = lower_half(&edge.after_by_end);
        for (row, next) in d.iter_mut().zip(&next.hessian) {
            row.iter_mut().zip(next).for_each(|(entry, next)| *entry -= *next);
        }
        // H_{k+1,k} = −(∂F⁻ℓd/∂η′)ᵀ
        let c = from_fn(|i| from_fn(|j| -edge.before_by_end[(j, i)]));
        let pivot = Pivot { d, c, g: edge.after - next.gradient, sign: self.sign };
        self.solve(pivot, edge, &(edge.after - later), curvature, feedback).before(edge)
    }

    /// The last vertex. Only motions in the kernel of the orbit's metric are free; the others close the gap. With the
    /// projector Π to the kernel, the pivot is Π H Π + c(I − Π), so that one elimination serves all dimensions.
    #[inline(never)]
    pub fn eliminate_end(
        &mut self,
        edge: &Edge<T, M>,
        end: &PathEnd<T, M>,
        curvature: Curvature<T>,
        feedback: &mut Feedback<T, M>,
    ) -> Solution<T, M> {
        self.after = edge.after;
        self.action += end.price;
        self.magnitude += end.price.abs();
        self.decrement += end.closing.dot(&(edge.after_by_end * end.closing)).abs();
        let closing = edge.before_by_end * end.closing;
        let Some(kernel) = &end.kernel else {
            *feedback = Feedback { gain: SMatrix::from_element(T::zero()), shift: -end.closing };
            let hessian = [[T::zero(); M]; M];
            return Solution { hessian, gradient: closing, decrement: T::zero(), negative: 0 }.before(edge);
        };
        let size = edge.after_by_end.trace().abs() * self.sign;
        let hessian = end.curvature.map_or(edge.after_by_end, |curvature| edge.after_by_end + curvature);
        let d = kernel * hessian * kernel + (SMatrix::identity() - kernel) * size;
        let c = -kernel * edge.before_by_end.transpose();
        let g = kernel * (edge.after + end.slope + edge.after_by_end * end.closing);
        let pivot = Pivot { d: lower_half(&d), c: rows(&c), g, sign: self.sign };
        let residual = kernel * (edge.after + end.slope);
        let solution = self.solve(pivot, edge, &residual, curvature, feedback);
        feedback.gain = kernel * feedback.gain;
        feedback.shift = kernel * feedback.shift - end.closing;
        Solution { gradient: solution.gradient + closing, ..solution }.before(edge)
    }

    /// Eliminates the vertex where `edge` ends from its damped equations.
    #[inline(always)]
    fn solve(
        &mut self,
        mut pivot: Pivot<T, M>,
        edge: &Edge<T, M>,
        residual: &SVector<T, M>,
        curvature: Curvature<T>,
        feedback: &mut Feedback<T, M>,
    ) -> Solution<T, M> {
        let added = curvature.damping + curvature.steadiness;
        if added > T::zero() {
            damp(&mut pivot.d, edge, self.edges, added * pivot.sign);
        }
        let solution = pivot.solve(curvature, feedback);
        self.residual_squared = larger(self.residual_squared, residual.dot(residual));
        self.decrement += solution.decrement;
        self.negative += solution.negative;
        solution
    }
}

impl<T: Real, const M: usize> Solution<T, M> {
    /// Adds the part of `edge` to Hessian and gradient of the vertex where it starts. The vertex at its end was
    /// eliminated.
    #[inline]
    fn before(mut self, edge: &Edge<T, M>) -> Self {
        for (row, own) in self.hessian.iter_mut().zip(lower_half(&edge.before_by_start)) {
            row.iter_mut().zip(own).for_each(|(entry, own)| *entry = own + *entry);
        }
        self.gradient = edge.before + self.gradient;
        self
    }
}

/// Adds a multiple of a stiffness to the diagonal of a pivot. The stiffness is that of the slowest variation of a path
/// of N edges: π²/N² of the mean of the diagonal of ∂F⁺ℓd/∂η′. So a finer path of the same motion is damped as much.
#[cold]
fn damp<T: Real, const M: usize>(pivot: &mut [[T; M]; M], edge: &Edge<T, M>, edges: T, damping: T) {
    let slowest = T::from_f64(10.0) / (edges * edges);
    for (i, row) in pivot.iter_mut().enumerate() {
        row[i] += damping * slowest * edge.after_by_end[(i, i)].abs();
    }
}

/// The lower triangle of the symmetric part of A by rows, with 0 above.
#[inline]
fn lower_half<T: Real, const M: usize>(a: &SMatrix<T, M, M>) -> [[T; M]; M] {
    let half = T::from_ratio(1, 2);
    lower_triangle(|i, j| if i == j { a[(i, i)] } else { (a[(i, j)] + a[(j, i)]) * half })
}
