//! One vertex in the backward sweep: its block of the Hessian, its elimination, and the sums over all of them.

use super::end::PathEnd;
use super::pivot::{Feedback, Solution, solve};
use crate::linear::rows;
use crate::newton::Curvature;
use crate::space::larger;
use crate::{Edge, Momenta, Real};
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

/// What a backward sweep tells of the path.
#[derive(Clone, Copy)]
pub(super) struct PathSummary<T, const M: usize> {
    /// Σ ℓd
    pub action: T,
    /// Twice what Newton's correction would take from the action.
    pub decrement: T,
    /// The largest |E_k|².
    pub residual_squared: T,
    /// The momentum at the end.
    pub after: SVector<T, M>,
    /// The Morse index.
    pub negative: usize,
    /// Σ|ℓd|
    magnitude: T,
    /// Σ|N_k|²
    momenta: T,
    /// Σ|tr ∂F⁺ℓd/∂η′|
    stiffness: T,
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
    /// The size of Newton's correction relative to the path, in the norm of the Hessian.
    ///
    /// It is compared with the action itself and, as parts of that may cancel, with |N|²/tr H: the kinetic part.
    pub fn size(&self) -> T {
        if self.decrement == T::zero() {
            return T::zero();
        }
        let kinetic = if self.stiffness > T::zero() { self.momenta * self.edges / self.stiffness } else { T::zero() };
        (self.decrement.abs() / (self.magnitude + kinetic)).sqrt()
    }

    /// Whether the residual is at most so many units in the last place of the momentum, as the root of its mean square.
    pub fn is_stationary(&self, units: T) -> bool {
        let unit = units * T::EPSILON;
        self.residual_squared * self.edges <= unit * unit * self.momenta
    }

    /// The sums before the first edge.
    pub fn of_nothing(edges: usize) -> Self {
        let zero = T::zero();
        Self {
            action: zero,
            decrement: zero,
            residual_squared: zero,
            after: SVector::from_element(zero),
            negative: 0,
            magnitude: zero,
            momenta: zero,
            stiffness: zero,
            edges: T::from_f64(edges as f64),
        }
    }

    /// Action, momenta and residual of another path near this one, from its last edge to its first.
    #[inline]
    pub fn measured(&self, edges: impl Iterator<Item = Momenta<T, M>>, end: &PathEnd<T, M>) -> Self {
        let mut summary = Self { action: T::zero(), momenta: T::zero(), residual_squared: T::zero(), ..*self };
        let mut later: Option<SVector<T, M>> = None;
        for Momenta { lagrangian, before, after } in edges {
            let residual = match (later, &end.kernel) {
                (Some(later), _) => after - later,
                (None, Some(kernel)) => kernel * (after + end.slope),
                (None, None) => SVector::from_element(T::zero()),
            };
            if later.is_none() {
                summary.after = after;
            }
            summary.action += lagrangian;
            summary.momenta += before.dot(&before);
            summary.residual_squared = larger(summary.residual_squared, residual.dot(&residual));
            later = Some(before);
        }
        summary.action += end.price;
        summary
    }

    /// Adds up what scales the correction.
    #[inline]
    pub fn count(&mut self, edge: &Edge<T, M>) {
        self.action += edge.lagrangian;
        self.magnitude += edge.lagrangian.abs();
        self.momenta += edge.before.dot(&edge.before);
        self.stiffness += edge.after_by_end.trace().abs();
    }

    #[inline]
    fn count_vertex(&mut self, residual: &SVector<T, M>, solution: &Solution<T, M>) {
        self.residual_squared = larger(self.residual_squared, residual.dot(residual));
        self.decrement += solution.decrement;
        self.negative += solution.negative;
    }

    /// The interior vertex where `edge` ends.
    #[inline(always)]
    pub fn eliminate(
        &mut self,
        edge: &Edge<T, M>,
        pending: &Pending<T, M>,
        sign: T,
        curvature: Curvature<T>,
        feedback: Feedback<'_, T, M>,
    ) -> Solution<T, M> {
        let mut pivot = lower_half(&edge.after_by_end);
        for (row, pending) in pivot.iter_mut().zip(&pending.hessian) {
            row.iter_mut().zip(pending).for_each(|(entry, pending)| *entry += *pending);
        }
        let (damping, steadiness) = curvature.added();
        if damping + steadiness > T::zero() {
            damp(&mut pivot, edge, self.edges, (damping + steadiness) * sign);
        }
        let gradient = pending.gradient + edge.after;
        let solution = solve(&pivot, &coupling(edge), &gradient, sign, curvature, feedback);
        self.count_vertex(&(edge.after - pending.before), &solution);
        solution
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
        feedback: Feedback<'_, T, M>,
    ) -> Solution<T, M> {
        let Feedback { gain, shift } = feedback;
        self.after = edge.after;
        self.action += end.price;
        self.magnitude += end.price.abs();
        self.decrement += end.closing.dot(&(edge.after_by_end * end.closing)).abs();
        let Some(kernel) = &end.kernel else {
            (*gain, *shift) = (SMatrix::from_element(T::zero()), -end.closing);
            return Solution {
                hessian: [[T::zero(); M]; M],
                gradient: edge.before_by_end * end.closing,
                decrement: T::zero(),
                negative: 0,
            };
        };
        let gradient = kernel * (edge.after + end.slope + edge.after_by_end * end.closing);
        let size = edge.after_by_end.trace().abs() * sign;
        let pivot = kernel * end.bent(&edge.after_by_end) * kernel + (SMatrix::identity() - kernel) * size;
        let coupling = -kernel * edge.before_by_end.transpose();
        let mut pivot = lower_half(&pivot);
        let (damping, steadiness) = curvature.added();
        if damping + steadiness > T::zero() {
            damp(&mut pivot, edge, self.edges, (damping + steadiness) * sign);
        }
        let feedback = Feedback { gain: &mut *gain, shift: &mut *shift };
        let solution = solve(&pivot, &rows(&coupling), &gradient, sign, curvature, feedback);
        self.count_vertex(&(kernel * (edge.after + end.slope)), &solution);
        (*gain, *shift) = (kernel * *gain, kernel * *shift - end.closing);
        Solution { gradient: solution.gradient + edge.before_by_end * end.closing, ..solution }
    }
}

impl<T: Real, const M: usize> Pending<T, M> {
    /// After the elimination of the vertex where `edge` ends.
    #[inline]
    pub fn behind(edge: &Edge<T, M>, solution: &Solution<T, M>) -> Self {
        let mut hessian = lower_half(&edge.before_by_start);
        for (row, eliminated) in hessian.iter_mut().zip(&solution.hessian) {
            row.iter_mut().zip(eliminated).for_each(|(entry, eliminated)| *entry = -(*entry + *eliminated));
        }
        let gradient = -(edge.before + solution.gradient);
        Self { hessian, gradient, before: edge.before }
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

/// H_{k+1,k} = −(∂F⁻ℓd/∂η′)ᵀ by rows
#[inline]
fn coupling<T: Real, const M: usize>(edge: &Edge<T, M>) -> [[T; M]; M] {
    from_fn(|i| from_fn(|j| -edge.before_by_end[(j, i)]))
}

/// The lower triangle of the symmetric part of A by rows, with 0 above.
#[inline]
fn lower_half<T: Real, const M: usize>(a: &SMatrix<T, M, M>) -> [[T; M]; M] {
    let half = T::from_ratio(1, 2);
    let mut lower = [[T::zero(); M]; M];
    for (i, row) in lower.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().take(i).enumerate() {
            *entry = (a[(i, j)] + a[(j, i)]) * half;
        }
        row[i] = a[(i, i)];
    }
    lower
}
