//! The two sweeps of Newton's method on a path: backward to linearise and eliminate, forward to move the vertices.
//!
//! The motions of the vertices are η_k, with η_0 = 0. The action has the gradient E_k = F⁺ℓd(edge k−1) − F⁻ℓd(edge k)
//! and a symmetric block tridiagonal Hessian. H_kk is ∂F⁺ℓd/∂η′ of the edge before less ∂F⁻ℓd/∂η of the edge after, and
//! H_{k+1,k} = −(∂F⁻ℓd/∂η′)ᵀ. Diagonal blocks are made symmetric: their antisymmetric part, ½ ad*E, vanishes on an
//! extremal. Elimination from the end,
//! ```text
//! D_k = H_kk − H_{k,k+1} D_{k+1}⁻¹ H_{k+1,k},    K_k = D_k⁻¹ H_{k,k−1},    s_k = D_k⁻¹ (E_k − H_{k,k+1} s_{k+1}),    η_k = −s_k − K_k η_{k−1}
//! ```
//! is Riccati's recursion. The numbers of negative eigenvalues of all D_k add up to the Morse index (Sylvester's law of inertia).
//!
//! Sources: Rao, Wright and Rawlings, *Application of interior-point methods to model predictive control* (1998), for
//! the elimination. Marsden, Pekarsky and Shkoller, *Discrete Euler–Poincaré and Lie–Poisson equations* (1999), for
//! actions on groups.

use super::Node;
use super::end::PathEnd;
use super::pivot::Solution;
use super::vertex::PathSummary;
use crate::newton::Curvature;
use crate::scheme::edges::{Edges, FirstDerivatives, SecondDerivatives};
use crate::scheme::{At, Constants};
use crate::space::larger;
use crate::{Clebsch, Declared, Differentiated, Edge, Momenta, Real, Scalar, Space, Variational};
use nalgebra::SVector;

/// Fixed endpoints for a system and a step size.
pub(super) struct Endpoints<'a, S: Variational<M, Scalar: Real>, const M: usize, B: Differentiated<S, M> = Declared> {
    pub system: &'a S,
    pub h: S::Scalar,
    pub constants: &'a Constants<S, B>,
    /// The time of the start.
    pub time: S::Scalar,
    pub start: &'a S::Configuration,
    /// The last configuration; `None` where it is free, at the price of the end.
    pub target: Option<&'a S::Configuration>,
}

/// A path from the start, on the way from a guess to an extremal.
pub(super) struct Search<'a, S: Variational<M, Scalar: Real>, const M: usize, B: Differentiated<S, M> = Declared> {
    pub problem: Endpoints<'a, S, M, B>,
    pub path: &'a mut [Node<S, M>],
    /// q_N
    pub last: S::Configuration,
}

impl<T: Real, S: Variational<M, Scalar = T>, B: Differentiated<S, M>, const M: usize> Endpoints<'_, S, M, B> {
    pub fn time_of_end(&self, edges: usize) -> T {
        // the price of the end may depend on the time where nothing else does
        self.time + T::from_f64((edges / B::EDGES.max(1)) as f64) * self.h
    }

    #[inline(always)]
    pub fn edge(&self, index: usize, node: &Node<S, M>, next: &S::Configuration) -> Edge<T, M> {
        let (t, edge) = self.place(index);
        let (q, d) = (&node.configuration, &node.increment);
        let u = S::Input::origin();
        B::Scheme::visit(At::new(self.system, self.constants, t), edge, SecondDerivatives((q, d, next, &u)))
    }

    #[inline]
    pub fn momenta(&self, k: usize, q: &S::Configuration, d: &S::Element, next: &S::Configuration) -> Momenta<T, M> {
        let (t, edge) = self.place(k);
        let u = S::Input::origin();
        B::Scheme::visit(At::new(self.system, self.constants, t), edge, FirstDerivatives((q, d, next, &u)))
    }

    /// The time at which the step of an edge starts, and the number of the edge in it.
    #[inline]
    fn place(&self, index: usize) -> (T, usize) {
        let per_step = B::EDGES.max(1);
        (time_after::<S>(self.time, self.h, index / per_step), index % per_step)
    }

    /// The last edge and the vertex where it ends, apart from the loop over the others.
    #[inline(never)]
    fn eliminate_end(
        &self,
        (index, node): (usize, &mut Node<S, M>),
        next: &S::Configuration,
        end: &PathEnd<T, M>,
        curvature: Curvature<T>,
        summary: &mut PathSummary<T, M>,
    ) -> Solution<T, M> {
        let edge = self.edge(index, node, next);
        summary.count(&edge);
        node.momentum = edge.before;
        summary.eliminate_end(&edge, end, curvature, &mut node.feedback)
    }
}

impl<T: Real, S: Variational<M, Scalar = T>, B: Differentiated<S, M>, const M: usize> Search<'_, S, M, B> {
    /// The data at the end of the path.
    #[inline]
    pub fn end(&self) -> PathEnd<T, M> {
        self.problem.end(&self.last, self.path.len())
    }

    /// Linearises and eliminates: fills momenta, gains and shifts of the nodes.
    #[inline]
    pub fn eliminate(&mut self, end: &PathEnd<T, M>, curvature: Curvature<T>) -> PathSummary<T, M> {
        let problem = &self.problem;
        let zero = T::zero();
        let mut summary = PathSummary {
            action: zero,
            decrement: zero,
            size: zero,
            residual_squared: zero,
            after: SVector::zeros(),
            negative: 0,
            magnitude: zero,
            momenta: zero,
            stiffness: zero,
            edges: T::from_f64(self.path.len() as f64),
            sign: if problem.h < zero { -T::one() } else { T::one() },
        };
        let Some((last, others)) = self.path.split_last_mut() else { return summary };
        let mut next = problem.eliminate_end((others.len(), last), &self.last, end, curvature, &mut summary);
        let mut later = &*last;
        for (index, node) in others.iter_mut().enumerate().rev() {
            let edge = problem.edge(index, node, &later.configuration);
            summary.count(&edge);
            next = summary.eliminate(&edge, &next, &later.momentum, curvature, &mut node.feedback);
            node.momentum = edge.before;
            later = node;
        }
        if summary.decrement != zero {
            // Compared with the action itself and, as terms of that may cancel, with |N|²/tr H: the kinetic part.
            let is_stiff = summary.stiffness > zero;
            let kinetic = if is_stiff { summary.momenta * summary.edges / summary.stiffness } else { zero };
            summary.size = (summary.decrement.abs() / (summary.magnitude + kinetic)).sqrt();
        }
        summary
    }

    /// Momenta, action and residual, without second derivatives: gains and shifts of the nodes stay those of the sweep that `before` tells of.
    pub fn measure(&mut self, end: &PathEnd<T, M>, before: &PathSummary<T, M>) -> PathSummary<T, M> {
        let zero = T::zero();
        let mut summary = PathSummary { action: zero, momenta: zero, residual_squared: zero, ..*before };
        let mut next = &self.last;
        let mut later: Option<SVector<T, M>> = None;
        for (index, node) in self.path.iter_mut().enumerate().rev() {
            let Momenta { lagrangian, before, after } =
                self.problem.momenta(index, &node.configuration, &node.increment, next);
            let residual = match (later, &end.kernel) {
                (Some(later), _) => after - later,
                (None, Some(kernel)) => kernel * (after + end.slope),
                (None, None) => SVector::from_element(zero),
            };
            if later.is_none() {
                summary.after = after;
            }
            summary.action += lagrangian;
            summary.momenta += before.dot(&before);
            summary.residual_squared = larger(summary.residual_squared, residual.dot(&residual));
            node.momentum = before;
            next = &node.configuration;
            later = Some(before);
        }
        summary.action += end.price;
        summary
    }

    /// Moves the vertices by `fraction` of Newton's correction.
    #[inline]
    pub fn correct(&mut self, fraction: T) {
        let mut motion = SVector::from_element(T::zero());
        self.displace(|_, node| {
            motion = node.correction(&motion);
            motion * fraction
        });
    }

    /// Takes the last displacement back, up to round-off.
    #[cold]
    pub fn take_back(&mut self) {
        self.displace(|_, node| -node.motion);
    }

    /// Moves the vertex where the edge number `index` ends by `motion(index, node)`, for all edges in order: F_k ↦ τ(η_k)⁻¹ F_k τ(η_{k+1}).
    #[inline]
    pub fn displace(&mut self, mut motion: impl FnMut(usize, &Node<S, M>) -> SVector<T, M>) {
        let system = self.problem.system;
        let mut q = *self.problem.start;
        let mut back = system.retraction(&SVector::from_element(T::zero()));
        for (index, node) in self.path.iter_mut().enumerate() {
            let next = motion(index, node);
            let behind = system.compose(&back, &node.increment);
            let [ahead, inverse] = system.retractions(&next);
            node.increment = system.compose(&behind, &ahead);
            node.configuration = q;
            node.motion = next;
            q = system.advance(&q, &node.increment);
            back = inverse;
        }
        self.last = q;
    }

    /// The action after `fraction` of Newton's correction.
    #[cold]
    pub fn action_after(&self, fraction: T) -> T {
        let system = self.problem.system;
        let mut q = *self.problem.start;
        let mut motion = SVector::<T, M>::from_element(T::zero());
        let mut action = T::zero();
        for (index, node) in self.path.iter().enumerate() {
            let behind = system.compose(&system.retraction(&(motion * -fraction)), &node.increment);
            motion = node.correction(&motion);
            let increment = system.compose(&behind, &system.retraction(&(motion * fraction)));
            let next = system.advance(&q, &increment);
            action += self.problem.momenta(index, &q, &increment, &next).lagrangian;
            q = next;
        }
        match self.problem.target {
            Some(_) => action,
            None => action + system.endpoint(self.problem.time_of_end(self.path.len()), &q).price,
        }
    }

    /// The configurations that the increments lead to.
    pub fn roll_out(&mut self) {
        let system = self.problem.system;
        self.last = self.path.iter_mut().fold(*self.problem.start, |q, node| {
            node.configuration = q;
            system.advance(&q, &node.increment)
        });
    }
}

/// t₀ + kh; t₀ where the time does not matter.
#[inline]
pub(super) fn time_after<S: Clebsch>(start: S::Scalar, h: S::Scalar, steps: usize) -> S::Scalar {
    if size_of::<S::Time>() == 0 { start } else { start + S::Scalar::from_f64(steps as f64) * h }
}
