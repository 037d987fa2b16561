//! The answer to a problem with fixed endpoints, and the storage that the caller provides.

use super::pivot::Feedback;
use super::sweep::time_after;
use crate::fields::{copied, debug, getters};
use crate::scheme::{At, Scheme};
use crate::{Clebsch, Declared, Differentiated, Real, Space, State, Stepper, Time, Variational};
use core::iter::FusedIterator;
use nalgebra::{SMatrix, SVector};

/// One edge of a path with the vertex where it starts. [`Boundary::rest`](crate::Boundary::rest) makes it, and a solution fills it.
///
/// ```
/// # use clebsch::Clebsch;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [boundary],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// # let stepper = Spring { mass: 1.0, stiffness: 1.0 }.into_stepper(0.1)?;
/// let node = stepper.boundary().rest(&Vector1::new(0.5));
/// assert_eq!(node.configuration().x, 0.5);
/// assert_eq!(node.increment().x, 0.0);
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Node<S: Clebsch, const M: usize> {
    pub(super) configuration: S::Configuration,
    pub(super) increment: S::Element,
    pub(super) momentum: SVector<S::Scalar, M>,
    /// K and s of the vertex where the edge ends: its motion is η_{k+1} = −s − K η_k.
    pub(super) feedback: Feedback<S::Scalar, M>,
    /// The last motion of the vertex where the edge ends, to take it back.
    pub(super) motion: SVector<S::Scalar, M>,
}

impl<S: Variational<M, Scalar: Real>, const M: usize> Node<S, M> {
    /// The edge that stays at `q`.
    pub(super) fn rest(system: &S, q: &S::Configuration) -> Self {
        let zero = Space::origin();
        let feedback = Feedback { gain: Space::origin(), shift: zero };
        Self { configuration: *q, increment: system.retraction(&zero), momentum: zero, feedback, motion: zero }
    }

    /// Newton's correction of the vertex where the edge ends, after that of the vertex where it starts.
    #[inline]
    pub(super) fn correction(&self, motion: &SVector<S::Scalar, M>) -> SVector<S::Scalar, M> {
        -self.feedback.shift - self.feedback.gain * motion
    }

    getters! {
        /// The configuration q_k where the edge starts.
        ref configuration: S::Configuration;
        /// The increment F_k − I of the group element that moves q_k to q_{k+1}; for translations F_k itself.
        ref increment: S::Element;
        /// The momentum N_k = F⁻ℓd at q_k, before the kick of the step that follows.
        ref momentum: SVector<S::Scalar, M>;
    }

    /// The matrix K of optimal feedback: from Φ_{exp η}(q_k) the extremal to the target passes Φ_{exp η′}(q_{k+1}) with η′ = −Kη + O(η²).
    ///
    /// It is of the last linearisation, from which the path may have moved by √ε of its size: K is known to as much.
    ///
    /// Shape M×M. For the last edge η′ has only motions that fix the target: K = 0 where the action is free.
    #[inline]
    pub fn gain(&self) -> &SMatrix<S::Scalar, M, M> {
        &self.feedback.gain
    }
}

copied!(Node<S, M> where [S: Variational<M, Scalar: Real>, const M: usize]: configuration, increment, momentum, gain);

/// A critical path between fixed endpoints, solved to round-off by [`Boundary::solve`](crate::Boundary::solve): its nodes are the path itself.
///
/// ```
/// # use clebsch::{Clebsch, Guess};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [boundary],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// # let stepper = Spring { mass: 1.0, stiffness: 1.0 }.into_stepper(0.1)?;
/// # let boundary = stepper.boundary();
/// let mut path = [boundary.rest(&Vector1::zeros()); 10];
/// let extremal = boundary.solve(&Vector1::zeros(), &Vector1::new(1.0), Guess::Geodesic, &mut path)?;
/// assert!(extremal.gap() < 1e-12);
/// assert_eq!(extremal.negative(), 0); // a minimum of the action
/// let arrived = stepper.advance(&stepper.state(Vector1::zeros(), *extremal.momentum())?, 10)?;
/// assert!((arrived.configuration().x - 1.0).abs() < 1e-12);
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Extremal<'a, S: Variational<M, Scalar: Real>, const M: usize, B: Differentiated<S, M> = Declared> {
    pub(super) stepper: &'a Stepper<S, B>,
    pub(super) nodes: &'a [Node<S, M>],
    pub(super) time: S::Scalar,
    pub(super) action: S::Scalar,
    pub(super) residual: S::Scalar,
    pub(super) gap: S::Scalar,
    pub(super) negative: usize,
    pub(super) iterations: u32,
    pub(super) end: S::Configuration,
    pub(super) final_momentum: SVector<S::Scalar, M>,
}

impl<'a, S: Variational<M, Scalar: Real>, B: Differentiated<S, M>, const M: usize> Extremal<'a, S, M, B> {
    getters! {
        /// The action Σ ℓd, in the unit of ℓd: J·s.
        copy action: S::Scalar;
        /// The number of linearisations of the path that were made, without those of a path of few edges that it was begun with.
        copy iterations: u32;
        /// The largest |F⁺ℓd(edge k−1) − F⁻ℓd(edge k)| that round-off has left, in the unit of the momentum.
        copy residual: S::Scalar;
        /// The distance |target − q_N| that round-off has left, as the root of the sum of squares of all entries.
        copy gap: S::Scalar;
        /// The Morse index, the number of independent variations that make the action smaller. It is 0 on a strict
        /// local minimum, where no vertex is conjugate to the target. Counted in the last linearisation, within √ε of
        /// the path. For a negative step size, those that make it larger.
        copy negative: usize;
        /// The momentum N_N at the target, before the kick of a step from there.
        ref final_momentum: SVector<S::Scalar, M>;
        /// The configuration q_N: the target up to the [`gap`](Self::gap).
        ref end: S::Configuration;
        /// The edges in order, with configuration, increment, momentum and gain.
        copy nodes: &'a [Node<S, M>];
    }

    /// The momentum N_0 at the start: [`Stepper::step`] leads from there to the target.
    pub fn momentum(&self) -> &SVector<S::Scalar, M> {
        // by construction: a path has at least one node, so that the other answer is never given
        self.nodes.first().map_or(&self.final_momentum, Node::momentum)
    }

    /// The states (q, N) at the starts of all steps and at the end, N + 1 of them; a stepper can go on from each.
    pub fn states(&self) -> States<'_, 'a, S, M, B> {
        States { extremal: self, next: 0 }
    }

    /// The state after so many steps.
    fn state(&self, steps: usize) -> Option<State<S, B>> {
        let edges = steps.checked_mul(B::EDGES.max(1))?;
        let end = (edges == self.nodes.len()).then_some((self.end, self.final_momentum));
        let node = self.nodes.get(edges).map(|node| (node.configuration, node.momentum));
        let (configuration, momentum) = node.or(end)?;
        let Stepper { system, h, constants } = self.stepper;
        let t = time_after::<S>(self.time, *h, steps);
        let left = B::Scheme::left(At::new(system, constants, t), &configuration, &momentum);
        let held = B::Scheme::held(&configuration, &momentum);
        Some(State { time: S::Time::at(t), configuration, held, left, h: *h })
    }
}

// without the path, which is long
debug!(Extremal<'_, S, M, B> where [S: Variational<M, Scalar: Real>, B: Differentiated<S, M>, const M: usize]:
    action, iterations, residual, gap, negative);

/// The states of an [`Extremal`].
///
/// ```
/// # use clebsch::{Clebsch, Guess};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [boundary],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// # let stepper = Spring { mass: 1.0, stiffness: 1.0 }.into_stepper(0.1)?;
/// # let boundary = stepper.boundary();
/// # let mut path = [boundary.rest(&Vector1::zeros()); 10];
/// let extremal = boundary.solve(&Vector1::zeros(), &Vector1::new(1.0), Guess::Geodesic, &mut path)?;
/// let places: Vec<f64> = extremal.states().map(|state| state.configuration().x).collect();
/// assert_eq!(places.len(), 11); // one for each step, and the end
/// assert!(places.is_sorted());
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Debug)]
pub struct States<'e, 'a, S: Variational<M, Scalar: Real>, const M: usize, B: Differentiated<S, M> = Declared> {
    extremal: &'e Extremal<'a, S, M, B>,
    next: usize,
}

impl<S: Variational<M, Scalar: Real>, B: Differentiated<S, M>, const M: usize> Iterator for States<'_, '_, S, M, B> {
    type Item = State<S, B>;

    fn next(&mut self) -> Option<State<S, B>> {
        let state = self.extremal.state(self.next)?;
        self.next += 1;
        Some(state)
    }
}

impl<S: Variational<M, Scalar: Real>, B: Differentiated<S, M>, const M: usize> FusedIterator
    for States<'_, '_, S, M, B>
{
}
