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
//! Source: Rao, Wright and Rawlings, *Application of interior-point methods to model predictive control* (1998), for the elimination; Marsden,
//! Pekarsky and Shkoller, *Discrete Euler–Poincaré and Lie–Poisson equations* (1999), for actions on groups.

use super::Node;
use super::end::PathEnd;
use super::pivot::Feedback;
use super::vertex::{PathSummary, Pending};
use crate::newton::Curvature;
use crate::scheme::Constants;
use crate::{Edge, Momenta, Real, Scalar, Space, Variational};
use nalgebra::SVector;
use num_traits::Zero;

/// Fixed endpoints for a system and a step size.
#[derive(Clone, Copy)]
pub(super) struct Endpoints<'a, S: Variational<M, Scalar: Real>, const M: usize> {
    pub system: &'a S,
    pub h: S::Scalar,
    pub constants: &'a Constants<S>,
    /// The time of the start.
    pub time: S::Scalar,
    pub start: &'a S::Configuration,
    /// The last configuration; `None` where it is free, at the price of the end.
    pub target: Option<&'a S::Configuration>,
    /// The sign of the step size: that of the Hessian at a minimum.
    pub sign: S::Scalar,
}

impl<S: Variational<M, Scalar: Real>, const M: usize> Endpoints<'_, S, M> {
    /// What is known of a path of so many edges that ends at `q`.
    #[inline]
    pub fn end(&self, q: &S::Configuration, edges: usize) -> PathEnd<S::Scalar, M> {
        match self.target {
            Some(target) => PathEnd::of(self.system, q, target),
            None => PathEnd::free(&self.system.endpoint(self.time_of_end(edges), q), q.max_abs()),
        }
    }

    pub fn time_of_end(&self, edges: usize) -> S::Scalar {
        // the price of the end may depend on the time where nothing else does
        self.time + S::Scalar::from_f64((edges / S::EDGES.max(1)) as f64) * self.h
    }

    /// Linearises and eliminates a path that ends at `last_vertex`: fills momenta, gains and shifts of the nodes.
    #[inline]
    pub fn eliminate(
        &self,
        path: &mut [Node<S, M>],
        last_vertex: &S::Configuration,
        end: &PathEnd<S::Scalar, M>,
        curvature: Curvature<S::Scalar>,
    ) -> PathSummary<S::Scalar, M> {
        let mut summary = PathSummary::of_nothing(path.len());
        let Some((last, rest)) = path.split_last_mut() else { return summary };
        let mut pending = self.eliminate_end(rest.len(), last, last_vertex, end, curvature, &mut summary);
        let mut next = &last.configuration;
        for (index, node) in rest.iter_mut().enumerate().rev() {
            let edge = self.edge(index, &node.configuration, &node.increment, next);
            summary.count(&edge);
            let feedback = Feedback { gain: &mut node.gain, shift: &mut node.shift };
            let solution = summary.eliminate(&edge, &pending, self.sign, curvature, feedback);
            pending = Pending::behind(&edge, &solution);
            node.momentum = edge.before;
            next = &node.configuration;
        }
        summary
    }

    /// The last edge and the vertex where it ends, apart from the loop over the others.
    #[inline(never)]
    fn eliminate_end(
        &self,
        index: usize,
        last: &mut Node<S, M>,
        last_vertex: &S::Configuration,
        end: &PathEnd<S::Scalar, M>,
        curvature: Curvature<S::Scalar>,
        summary: &mut PathSummary<S::Scalar, M>,
    ) -> Pending<S::Scalar, M> {
        let edge = self.edge(index, &last.configuration, &last.increment, last_vertex);
        summary.count(&edge);
        let feedback = Feedback { gain: &mut last.gain, shift: &mut last.shift };
        let solution = summary.eliminate_end(&edge, end, self.sign, curvature, feedback);
        last.momentum = edge.before;
        Pending::behind(&edge, &solution)
    }

    /// Momenta, action and residual of a path that ends at `last_vertex`, without second derivatives: gains and shifts of the nodes stay
    /// those of the sweep that `before` tells of.
    pub fn measure(
        &self,
        path: &mut [Node<S, M>],
        last_vertex: &S::Configuration,
        end: &PathEnd<S::Scalar, M>,
        before: &PathSummary<S::Scalar, M>,
    ) -> PathSummary<S::Scalar, M> {
        let mut next = last_vertex;
        let edges = path.iter_mut().enumerate().rev().map(|(index, node)| {
            let momenta = self.momenta(index, &node.configuration, &node.increment, next);
            node.momentum = momenta.before;
            next = &node.configuration;
            momenta
        });
        before.measured(edges, end)
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
        let system = self.system;
        let mut q = *self.start;
        let mut back = system.retraction(&SVector::from_element(S::Scalar::zero()));
        for (index, node) in path.iter_mut().enumerate() {
            let next = motion(index, node);
            let behind = system.compose(&back, &node.increment);
            let [ahead, inverse] = system.retractions(&next);
            node.increment = system.compose(&behind, &ahead);
            node.configuration = q;
            node.motion = next;
            q = system.advance(&q, &node.increment);
            back = inverse;
        }
        q
    }

    /// The action after `fraction` of Newton's correction.
    #[cold]
    pub fn action_after(&self, path: &[Node<S, M>], fraction: S::Scalar) -> S::Scalar {
        let system = self.system;
        let zero = SVector::<S::Scalar, M>::from_element(S::Scalar::zero());
        let (mut q, mut motion, mut action) = (*self.start, zero, S::Scalar::zero());
        for (index, node) in path.iter().enumerate() {
            let behind = system.compose(&system.retraction(&(motion * -fraction)), &node.increment);
            motion = -node.shift - node.gain * motion;
            let increment = system.compose(&behind, &system.retraction(&(motion * fraction)));
            let next = system.advance(&q, &increment);
            action += self.momenta(index, &q, &increment, &next).lagrangian;
            q = next;
        }
        match self.target {
            Some(_) => action,
            None => action + self.system.endpoint(self.time_of_end(path.len()), &q).price,
        }
    }

    /// The configurations that the increments lead to. Returns q_N.
    pub fn roll_out(&self, path: &mut [Node<S, M>]) -> S::Configuration {
        path.iter_mut().fold(*self.start, |q, node| {
            node.configuration = q;
            self.system.advance(&q, &node.increment)
        })
    }

    #[inline(always)]
    fn edge(&self, index: usize, q: &S::Configuration, d: &S::Element, next: &S::Configuration) -> Edge<S::Scalar, M> {
        let (t, edge) = self.place(index);
        self.system.edge(self.constants, edge, t, q, d, next, &S::Input::origin())
    }

    #[inline]
    pub fn momenta(
        &self,
        index: usize,
        q: &S::Configuration,
        d: &S::Element,
        next: &S::Configuration,
    ) -> Momenta<S::Scalar, M> {
        let (t, edge) = self.place(index);
        self.system.momenta(self.constants, edge, t, q, d, next, &S::Input::origin())
    }

    /// The time at which the step of an edge starts, and the number of the edge in it.
    #[inline]
    fn place(&self, index: usize) -> (S::Scalar, usize) {
        let per_step = S::EDGES.max(1);
        (time_after::<S, M>(self.time, self.h, index / per_step), index % per_step)
    }
}

/// t₀ + kh; t₀ where the time does not matter.
#[inline]
pub(super) fn time_after<S: Variational<M, Scalar: Real>, const M: usize>(
    start: S::Scalar,
    h: S::Scalar,
    steps: usize,
) -> S::Scalar {
    if size_of::<S::Time>() == 0 { start } else { start + S::Scalar::from_f64(steps as f64) * h }
}
