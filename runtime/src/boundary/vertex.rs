//! One vertex in the backward sweep: its block of the Hessian, its elimination, and the sums over all of them.

use super::end::PathEnd;
use super::pivot::{Feedback, Pivot, Solution, lower_triangle};
use crate::linear::rows;
use crate::newton::Curvature;
use crate::space::larger;
use crate::{Edge, Real};
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

/// What a backward sweep tells of the path.
#[derive(Clone, Copy)]
pub(super) struct PathSummary<T, const M: usize> {
    /// Σ ℓd
    pub action: T,
    /// Twice what Newton's correction would take from the action.
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
}

/// What the vertex at the start of the edges that are done needs of them.
pub(super) struct Pending<T, const M: usize> {
    /// −∂F⁻ℓd/∂η − H_{k,k+1} K_{k+1}: the lower triangle of its symmetric part
    hessian: [[T; M]; M],
    /// −F⁻ℓd − H_{k,k+1} s_{k+1}
    gradient: SVector<T, M>,
    /// F⁻ℓd
    before: SVector<T, M>,
}

impl<T: Real, const M: usize> PathSummary<T, M> {
    /// The sums before the first edge.
    pub fn of_nothing(edges: usize) -> Self {
        let zero = T::zero();
        Self {
            action: zero,
            decrement: zero,
            size: zero,
            residual_squared: zero,
            after: SVector::from_element(zero),
            negative: 0,
            magnitude: zero,
            momenta: zero,
            stiffness: zero,
            edges: T::from_f64(edges as f64),
        }
    }

    /// After the last vertex: measures Newton's correction.
    ///
    /// It is compared with the action itself and, as parts of that may cancel, with |N|²/tr H: the kinetic part.
    #[inline]
    pub fn finish(&mut self) {
        if self.decrement != T::zero() {
            let is_stiff = self.stiffness > T::zero();
            let kinetic = if is_stiff { self.momenta * self.edges / self.stiffness } else { T::zero() };
            self.size = (self.decrement.abs() / (self.magnitude + kinetic)).sqrt();
        }
    }

    /// Whether the residual is at most so many units in the last place of the momentum, as the root of its mean square.
    pub fn is_stationary(&self, units: f64) -> bool {
        let unit = T::from_f64(units) * T::EPSILON;
        self.residual_squared * self.edges <= unit * unit * self.momenta
    }

    /// The size of a correction of vertices that is round-off.
    pub fn round_off(&self) -> T {
        T::from_f64(4.0) * T::EPSILON * self.edges.sqrt()
    }

    /// Adds up what scales the correction.
    #[inline]
    pub fn count(&mut self, edge: &Edge<T, M>) {
        self.action += edge.lagrangian;
        self.magnitude += edge.lagrangian.abs();
        self.momenta += edge.before.dot(&edge.before);
        self.stiffness += edge.after_by_end.trace().abs();
    }

    /// The interior vertex where `edge` ends.
    #[inline(always)]
    pub fn eliminate(
        &mut self,
        edge: &Edge<T, M>,
        pending: &Pending<T, M>,
        sign: T,
        curvature: Curvature<T>,
        feedback: &mut Feedback<T, M>,
    ) -> Pending<T, M> {
        let mut d = lower_half(&edge.after_by_end);
        for (row, pending) in d.iter_mut().zip(&pending.hessian) {
            row.iter_mut().zip(pending).for_each(|(entry, pending)| *entry += *pending);
        }
        // H_{k+1,k} = −(∂F⁻ℓd/∂η′)ᵀ
        let c = from_fn(|i| from_fn(|j| -edge.before_by_end[(j, i)]));
        let pivot = Pivot { d, c, g: pending.gradient + edge.after, sign };
        let solution = self.solve(pivot, edge, &(edge.after - pending.before), curvature, feedback);
        Pending::behind(edge, &solution)
    }

    /// The last vertex, of which only motions in the kernel of the orbit's metric are free; the gap is closed by the others.
    ///
    /// With the projector Π to the kernel, the pivot is Π H Π + c(I − Π), so that one elimination serves all dimensions.
    #[inline(never)]
    pub fn eliminate_end(
        &mut self,
        edge: &Edge<T, M>,
        end: &PathEnd<T, M>,
        sign: T,
        curvature: Curvature<T>,
        feedback: &mut Feedback<T, M>,
    ) -> Pending<T, M> {
        self.after = edge.after;
        self.action += end.price;
        self.magnitude += end.price.abs();
        self.decrement += end.closing.dot(&(edge.after_by_end * end.closing)).abs();
        let closing = edge.before_by_end * end.closing;
        let Some(kernel) = &end.kernel else {
            *feedback = Feedback { gain: SMatrix::from_element(T::zero()), shift: -end.closing };
            let hessian = [[T::zero(); M]; M];
            return Pending::behind(edge, &Solution { hessian, gradient: closing, decrement: T::zero(), negative: 0 });
        };
        let size = edge.after_by_end.trace().abs() * sign;
        let d = kernel * end.bent(&edge.after_by_end) * kernel + (SMatrix::identity() - kernel) * size;
        let c = -kernel * edge.before_by_end.transpose();
        let g = kernel * (edge.after + end.slope + edge.after_by_end * end.closing);
        let pivot = Pivot { d: lower_half(&d), c: rows(&c), g, sign };
        let residual = kernel * (edge.after + end.slope);
        let solution = self.solve(pivot, edge, &residual, curvature, feedback);
        feedback.gain = kernel * feedback.gain;
        feedback.shift = kernel * feedback.shift - end.closing;
        Pending::behind(edge, &Solution { gradient: solution.gradient + closing, ..solution })
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

impl<T: Real, const M: usize> Pending<T, M> {
    /// After the elimination of the vertex where `edge` ends.
    #[inline]
    fn behind(edge: &Edge<T, M>, solution: &Solution<T, M>) -> Self {
        let mut hessian = lower_half(&edge.before_by_start);
        for (row, eliminated) in hessian.iter_mut().zip(&solution.hessian) {
            row.iter_mut().zip(eliminated).for_each(|(entry, eliminated)| *entry = -(*entry + *eliminated));
        }
        Self { hessian, gradient: -(edge.before + solution.gradient), before: edge.before }
    }
}

/// Adds a multiple of the stiffness of the slowest variation of a path of N edges, π²/N² of the mean of the diagonal of ∂F⁺ℓd/∂η′, to
/// the diagonal of a pivot: a finer path of the same motion is damped as much.
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
