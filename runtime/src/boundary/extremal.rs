//! What a problem with fixed endpoints is answered with.

use super::Node;
use super::sweep::time_after;
use crate::scheme::Scheme;
use crate::{Real, State, Stepper, Time, Variational};
use core::fmt::{self, Debug, Formatter};
use core::iter::FusedIterator;
use nalgebra::SVector;

/// A path between fixed endpoints on which the action is critical, solved to round-off by
/// [`Boundary::solve`](crate::Boundary::solve). The nodes that it was solved in hold the path itself.
pub struct Extremal<'a, S: Variational<M, Scalar: Real>, const M: usize> {
    pub(super) stepper: &'a Stepper<S>,
    pub(super) path: &'a [Node<S, M>],
    pub(super) time: S::Scalar,
    pub(super) action: S::Scalar,
    pub(super) residual: S::Scalar,
    pub(super) gap: S::Scalar,
    pub(super) negative: usize,
    pub(super) iterations: u32,
    pub(super) end: S::Configuration,
    pub(super) after: SVector<S::Scalar, M>,
}

impl<'a, S: Variational<M, Scalar: Real>, const M: usize> Extremal<'a, S, M> {
    /// The action Σ ℓd, in the unit of ℓd: J·s.
    pub fn action(&self) -> S::Scalar {
        self.action
    }

    /// The number of linearisations of the path that were made, without those of a path of few edges that it was begun with.
    pub fn iterations(&self) -> u32 {
        self.iterations
    }

    /// The largest |F⁺ℓd(edge k−1) − F⁻ℓd(edge k)| that round-off has left, in the unit of the momentum.
    pub fn residual(&self) -> S::Scalar {
        self.residual
    }

    /// The distance |target − q_N| that round-off has left, as the root of the sum of squares of all entries.
    pub fn gap(&self) -> S::Scalar {
        self.gap
    }

    /// The Morse index, the number of independent variations that make the action smaller: 0 on a strict local minimum, where no
    /// vertex is conjugate to the target. Counted in the last linearisation, within √ε of the path. For a negative step size, those that make it larger.
    pub fn negative(&self) -> usize {
        self.negative
    }

    /// The momentum N_0 at the start: [`Stepper::step`] leads from there to the target.
    pub fn momentum(&self) -> &SVector<S::Scalar, M> {
        // by construction: a path has at least one node, so that the other answer is never given
        self.path.first().map_or(&self.after, Node::momentum)
    }

    /// The momentum N_N at the target, before the kick of a step from there.
    pub fn final_momentum(&self) -> &SVector<S::Scalar, M> {
        &self.after
    }

    /// The configuration q_N: the target up to the [`gap`](Self::gap).
    pub fn end(&self) -> &S::Configuration {
        &self.end
    }

    /// The edges in order, with configuration, increment, momentum and gain.
    pub fn nodes(&self) -> &'a [Node<S, M>] {
        self.path
    }

    /// The states (q, N) at the starts of all steps and at the end, N + 1 of them; a stepper can go on from each.
    pub fn states(&self) -> States<'_, 'a, S, M> {
        States { extremal: self, next: 0 }
    }

    /// The state after so many steps.
    fn state(&self, steps: usize) -> Option<State<S>> {
        let edges = steps.checked_mul(S::EDGES.max(1))?;
        let (configuration, momentum) = match self.path.get(edges) {
            Some(node) => (node.configuration, node.momentum),
            None if edges == self.path.len() => (self.end, self.after),
            None => return None,
        };
        let Stepper { system, h, constants } = self.stepper;
        let t = time_after::<S, M>(self.time, *h, steps);
        let left = S::Scheme::left(system, constants, t, &configuration, &momentum);
        let held = S::Scheme::held(&configuration, &momentum);
        Some(State { time: S::Time::at(t), configuration, held, left, h: *h })
    }
}

/// Without the path, which is long.
impl<S: Variational<M, Scalar: Real>, const M: usize> Debug for Extremal<'_, S, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Extremal")
            .field("action", &self.action)
            .field("iterations", &self.iterations)
            .field("residual", &self.residual)
            .field("gap", &self.gap)
            .field("negative", &self.negative)
            .finish_non_exhaustive()
    }
}

/// The states of an [`Extremal`].
#[derive(Debug)]
pub struct States<'e, 'a, S: Variational<M, Scalar: Real>, const M: usize> {
    extremal: &'e Extremal<'a, S, M>,
    next: usize,
}

impl<S: Variational<M, Scalar: Real>, const M: usize> Iterator for States<'_, '_, S, M> {
    type Item = State<S>;

    fn next(&mut self) -> Option<State<S>> {
        let state = self.extremal.state(self.next)?;
        self.next += 1;
        Some(state)
    }
}

impl<S: Variational<M, Scalar: Real>, const M: usize> FusedIterator for States<'_, '_, S, M> {}
