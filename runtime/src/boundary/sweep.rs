//! The two sweeps of Newton's method on a path: backward to linearise and eliminate, forward to move the vertices.
//!
//! With the motions η_k of the vertices, η_0 = 0, the action has the gradient E_k = F⁺ℓd(edge k−1) − F⁻ℓd(edge k) and a symmetric block
//! tridiagonal Hessian: H_kk of ∂F⁺ℓd/∂η′ of the edge before less ∂F⁻ℓd/∂η of the edge after, H_{k+1,k} = −(∂F⁻ℓd/∂η′)ᵀ. Diagonal blocks are
//! made symmetric: their antisymmetric part, ½ ad*E, vanishes on an extremal. Elimination from the end,
//! ```text
//! D_k = H_kk − H_{k,k+1} D_{k+1}⁻¹ H_{k+1,k},    K_k = D_k⁻¹ H_{k,k−1},    s_k = D_k⁻¹ (E_k − H_{k,k+1} s_{k+1}),    η_k = −s_k − K_k η_{k−1}
//! ```
//! is Riccati's recursion. The numbers of negative eigenvalues of all D_k add up to the Morse index (Sylvester's law of inertia).
//!
//! Source: Bock and Plitt (1984) for the elimination in time; discrete Lagrangians on groups as in Marsden, Pekarsky and Shkoller (1999).

use super::Node;
use super::end::End;
use super::pivot::{Curvature, Solution, solve};
use crate::linear::rows;
use crate::space::larger;
use crate::{Edge, Scalar, Stepper, Variational};
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};
use num_traits::Zero;

/// Fixed endpoints for a stepper.
pub(super) struct Problem<'a, S: Variational<M>, const M: usize> {
    pub stepper: &'a Stepper<S>,
    /// The time of the start.
    pub time: S::Scalar,
    pub start: &'a S::Configuration,
    pub target: &'a S::Configuration,
    /// The sign of the step size: that of the Hessian at a minimum.
    pub sign: S::Scalar,
}

/// What a backward sweep tells of the path.
#[derive(Clone, Copy)]
pub(super) struct Summary<T, const M: usize> {
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
struct Pending<T, const M: usize> {
    /// −∂F⁻ℓd/∂η − H_{k,k+1} K_{k+1}: the lower triangle of its symmetric part
    hessian: [[T; M]; M],
    /// −F⁻ℓd − H_{k,k+1} s_{k+1}
    gradient: SVector<T, M>,
    /// F⁻ℓd
    before: SVector<T, M>,
}

impl<T: Scalar, const M: usize> Summary<T, M> {
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

    fn of_nothing(edges: usize) -> Self {
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

    #[inline]
    fn count(&mut self, edge: &Edge<T, M>) {
        self.action += edge.lagrangian;
        self.magnitude += edge.lagrangian.abs();
        self.momenta += edge.before.dot(&edge.before);
        self.stiffness += edge.after_by_end.trace().abs();
    }

    #[inline]
    fn count_vertex(&mut self, residual: &SVector<T, M>, gradient: &SVector<T, M>, solution: &Solution<T, M>) {
        self.residual_squared = larger(self.residual_squared, residual.dot(residual));
        self.decrement += solution.shift.dot(gradient);
        self.negative += solution.negative;
    }

    /// The interior vertex where `edge` ends.
    #[inline]
    fn eliminate(
        &mut self,
        edge: &Edge<T, M>,
        pending: &Pending<T, M>,
        sign: T,
        curvature: Curvature<T>,
    ) -> Solution<T, M> {
        let mut pivot = lower_half(&edge.after_by_end);
        for (row, pending) in pivot.iter_mut().zip(&pending.hessian) {
            row.iter_mut().zip(pending).for_each(|(entry, pending)| *entry += *pending);
        }
        if let Curvature::Mirrored { damping } = curvature {
            damp(&mut pivot, edge, damping * sign);
        }
        let gradient = pending.gradient + edge.after;
        let solution = solve(&pivot, &coupling(edge), &gradient, sign, curvature);
        self.count_vertex(&(edge.after - pending.before), &gradient, &solution);
        solution
    }

    /// The last vertex, of which only motions in the kernel of the orbit's metric are free; the gap is closed by the others.
    ///
    /// With the projector Π to the kernel, the pivot is Π H Π + c(I − Π), so that one elimination serves all dimensions.
    #[inline(never)]
    fn eliminate_end(
        &mut self,
        edge: &Edge<T, M>,
        end: &End<T, M>,
        sign: T,
        curvature: Curvature<T>,
    ) -> Solution<T, M> {
        self.after = edge.after;
        self.decrement += end.closing.dot(&(edge.after_by_end * end.closing)).abs();
        let Some(kernel) = &end.kernel else {
            return Solution {
                gain: SMatrix::from_element(T::zero()),
                shift: -end.closing,
                hessian: [[T::zero(); M]; M],
                gradient: edge.before_by_end * end.closing,
                negative: 0,
            };
        };
        let gradient = kernel * (edge.after + edge.after_by_end * end.closing);
        let size = edge.after_by_end.trace().abs() * sign;
        let pivot = kernel * edge.after_by_end * kernel + (SMatrix::identity() - kernel) * size;
        let coupling = -kernel * edge.before_by_end.transpose();
        let mut pivot = lower_half(&pivot);
        if let Curvature::Mirrored { damping } = curvature {
            damp(&mut pivot, edge, damping * sign);
        }
        let solution = solve(&pivot, &rows(&coupling), &gradient, sign, curvature);
        self.count_vertex(&(kernel * edge.after), &gradient, &solution);
        Solution {
            gain: kernel * solution.gain,
            shift: kernel * solution.shift - end.closing,
            gradient: solution.gradient + edge.before_by_end * end.closing,
            ..solution
        }
    }
}

impl<S: Variational<M>, const M: usize> Problem<'_, S, M> {
    /// Linearises and eliminates: fills momenta, gains and shifts of the nodes.
    #[inline]
    pub fn eliminate(
        &self,
        path: &mut [Node<S, M>],
        end: &End<S::Scalar, M>,
        curvature: Curvature<S::Scalar>,
    ) -> Summary<S::Scalar, M> {
        let mut summary = Summary::of_nothing(path.len());
        let Some((last, rest)) = path.split_last_mut() else { return summary };
        let edge = self.edge(rest.len(), &last.configuration, &last.increment);
        summary.count(&edge);
        let solution = summary.eliminate_end(&edge, end, self.sign, curvature);
        let mut pending = Pending::behind(&edge, &solution);
        (last.momentum, last.gain, last.shift) = (edge.before, solution.gain, solution.shift);
        for (index, node) in rest.iter_mut().enumerate().rev() {
            let edge = self.edge(index, &node.configuration, &node.increment);
            summary.count(&edge);
            let solution = summary.eliminate(&edge, &pending, self.sign, curvature);
            pending = Pending::behind(&edge, &solution);
            (node.momentum, node.gain, node.shift) = (edge.before, solution.gain, solution.shift);
        }
        summary
    }

    /// Moves the vertices by `fraction` of Newton's correction. Returns q_N.
    #[inline]
    pub fn correct(&self, path: &mut [Node<S, M>], fraction: S::Scalar) -> S::Configuration {
        let mut motion = SVector::from_element(S::Scalar::zero());
        self.displace(path, |_, node| {
            motion = -node.shift - node.gain * motion;
            motion * fraction
        })
    }

    /// Takes the last displacement back, up to round-off. Returns q_N.
    #[cold]
    pub fn take_back(&self, path: &mut [Node<S, M>]) -> S::Configuration {
        self.displace(path, |_, node| -node.motion)
    }

    /// Moves the vertex where the edge number `index` ends by `motion(index, node)`, for all edges in order: F_k ↦ τ(η_k)⁻¹ F_k τ(η_{k+1}).
    /// Returns q_N.
    #[inline]
    pub fn displace(
        &self,
        path: &mut [Node<S, M>],
        mut motion: impl FnMut(usize, &Node<S, M>) -> SVector<S::Scalar, M>,
    ) -> S::Configuration {
        let system = &self.stepper.system;
        let (mut q, mut back) = (*self.start, SVector::from_element(S::Scalar::zero()));
        for (index, node) in path.iter_mut().enumerate() {
            let next = motion(index, node);
            let behind = system.compose(&system.retraction(&back), &node.increment);
            node.increment = system.compose(&behind, &system.retraction(&next));
            node.configuration = q;
            node.motion = next;
            q = system.advance(&q, &node.increment);
            back = -next;
        }
        q
    }

    /// The action after `fraction` of Newton's correction.
    #[cold]
    pub fn action_after(&self, path: &[Node<S, M>], fraction: S::Scalar) -> S::Scalar {
        let system = &self.stepper.system;
        let zero = SVector::<S::Scalar, M>::from_element(S::Scalar::zero());
        let (mut q, mut motion, mut action) = (*self.start, zero, S::Scalar::zero());
        for (index, node) in path.iter().enumerate() {
            let behind = system.compose(&system.retraction(&(motion * -fraction)), &node.increment);
            motion = -node.shift - node.gain * motion;
            let increment = system.compose(&behind, &system.retraction(&(motion * fraction)));
            action += self.edge(index, &q, &increment).lagrangian;
            q = system.advance(&q, &increment);
        }
        action
    }

    /// The configurations that the increments lead to. Returns q_N.
    pub fn roll_out(&self, path: &mut [Node<S, M>]) -> S::Configuration {
        path.iter_mut().fold(*self.start, |q, node| {
            node.configuration = q;
            self.stepper.system.advance(&q, &node.increment)
        })
    }

    /// Not inlined: the elimination beside it needs the registers.
    #[inline(never)]
    fn edge(&self, index: usize, q: &S::Configuration, d: &S::Element) -> Edge<S::Scalar, M> {
        let per_step = S::EDGES.max(1);
        let t = time_after::<S, M>(self.time, self.stepper.h, index / per_step);
        self.stepper.system.edge(&self.stepper.constants, index % per_step, t, q, d)
    }
}

/// t₀ + kh; t₀ where the time does not matter.
#[inline]
pub(super) fn time_after<S: Variational<M>, const M: usize>(start: S::Scalar, h: S::Scalar, steps: usize) -> S::Scalar {
    if size_of::<S::Time>() == 0 { start } else { start + S::Scalar::from_f64(steps as f64) * h }
}

impl<T: Scalar, const M: usize> Pending<T, M> {
    /// After the elimination of the vertex where `edge` ends.
    #[inline]
    fn behind(edge: &Edge<T, M>, solution: &Solution<T, M>) -> Self {
        let mut hessian = lower_half(&edge.before_by_start);
        for (row, eliminated) in hessian.iter_mut().zip(&solution.hessian) {
            row.iter_mut().zip(eliminated).for_each(|(entry, eliminated)| *entry = -(*entry + *eliminated));
        }
        let gradient = -(edge.before + solution.gradient);
        Self { hessian, gradient, before: edge.before }
    }
}

/// Adds a multiple of the mean of the diagonal of ∂F⁺ℓd/∂η′ to that of a pivot.
#[cold]
fn damp<T: Scalar, const M: usize>(pivot: &mut [[T; M]; M], edge: &Edge<T, M>, damping: T) {
    let mean = edge.after_by_end.trace().abs() / T::from_f64(M as f64);
    for (i, row) in pivot.iter_mut().enumerate() {
        row[i] += damping * mean;
    }
}

/// H_{k+1,k} = −(∂F⁻ℓd/∂η′)ᵀ by rows
#[inline]
fn coupling<T: Scalar, const M: usize>(edge: &Edge<T, M>) -> [[T; M]; M] {
    from_fn(|i| from_fn(|j| -edge.before_by_end[(j, i)]))
}

/// The lower triangle of the symmetric part of A by rows, with 0 above.
#[inline]
fn lower_half<T: Scalar, const M: usize>(a: &SMatrix<T, M, M>) -> [[T; M]; M] {
    let half = T::from_ratio(1, 2);
    let mut lower = [[T::zero(); M]; M];
    for (i, row) in lower.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().take(i + 1).enumerate() {
            *entry = (a[(i, j)] + a[(j, i)]) * half;
        }
    }
    lower
}
