//! What the caller keeps for each edge of a path.

use crate::{Clebsch, Real, Variational};
use core::fmt::{self, Debug, Formatter};
use nalgebra::{SMatrix, SVector};

/// One edge of a path with the vertex where it starts. Made by [`Boundary::rest`](crate::Boundary::rest), filled by
/// [`Boundary::solve`](crate::Boundary::solve).
pub struct Node<S: Clebsch, const M: usize> {
    pub(super) configuration: S::Configuration,
    pub(super) increment: S::Element,
    pub(super) momentum: SVector<S::Scalar, M>,
    /// K and s of the vertex where the edge ends: its motion is η_{k+1} = −s − K η_k.
    pub(super) gain: SMatrix<S::Scalar, M, M>,
    pub(super) shift: SVector<S::Scalar, M>,
    /// The last motion of the vertex where the edge ends, to take it back.
    pub(super) motion: SVector<S::Scalar, M>,
}

impl<S: Variational<M, Scalar: Real>, const M: usize> Node<S, M> {
    /// The edge that stays at `q`.
    pub(super) fn rest(system: &S, q: &S::Configuration) -> Self {
        let zero = SVector::from_element(num_traits::Zero::zero());
        Self {
            configuration: *q,
            increment: system.retraction(&zero),
            momentum: zero,
            gain: SMatrix::from_element(num_traits::Zero::zero()),
            shift: zero,
            motion: zero,
        }
    }
}

impl<S: Clebsch, const M: usize> Node<S, M> {
    /// The configuration q_k where the edge starts.
    #[inline]
    pub fn configuration(&self) -> &S::Configuration {
        &self.configuration
    }

    /// The increment F_k − I of the group element that moves q_k to q_{k+1}; for translations F_k itself.
    #[inline]
    pub fn increment(&self) -> &S::Element {
        &self.increment
    }

    /// The momentum N_k = F⁻ℓd at q_k, before the kick of the step that follows.
    #[inline]
    pub fn momentum(&self) -> &SVector<S::Scalar, M> {
        &self.momentum
    }

    /// The matrix K of optimal feedback: where q_k is found at Φ_{exp η}(q_k), the extremal from there to the target passes
    /// Φ_{exp η′}(q_{k+1}) with η′ = −Kη + O(η²).
    ///
    /// It is of the last linearisation, from which the path may have moved by √ε of its size: K is known to as much.
    ///
    /// Shape M×M. For the last edge η′ has only motions that fix the target: K = 0 where the action is free.
    #[inline]
    pub fn gain(&self) -> &SMatrix<S::Scalar, M, M> {
        &self.gain
    }
}

impl<S: Clebsch, const M: usize> Copy for Node<S, M> {}

impl<S: Clebsch, const M: usize> Clone for Node<S, M> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Clebsch, const M: usize> Debug for Node<S, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Node")
            .field("configuration", &self.configuration)
            .field("increment", &self.increment)
            .field("momentum", &self.momentum)
            .field("gain", &self.gain)
            .finish_non_exhaustive()
    }
}
