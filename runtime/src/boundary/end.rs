//! The last vertex: its difference from the target, and its motions that are free.

use super::sweep::Endpoints;
use crate::newton::{arc_per_chord, is_reached, shortest};
use crate::space::larger;
use crate::{Differentiated, Error, Real, Space, Variational};
use nalgebra::{SMatrix, SVector};

/// The data at the end of a path.
#[derive(Clone, Copy)]
pub(super) struct PathEnd<T, const M: usize> {
    /// The smallest η that solves GᵀG η = Gᵀ(target − q_N); 0 where that is round-off.
    pub closing: SVector<T, M>,
    /// The orthogonal projector to the kernel of GᵀG, the motions that fix q_N; `None` where there are none.
    pub kernel: Option<SMatrix<T, M, M>>,
    /// |target − q_N|
    pub distance: T,
    /// |Gη|: the part of the gap along the orbit.
    pub along: T,
    /// The numbers that the gap is compared with: the largest entry of both configurations.
    pub scale: T,
    /// φ, the price of a free end.
    pub price: T,
    /// ∂φ/∂η
    pub slope: SVector<T, M>,
    /// ∂²φ/∂η²; `None` where the end is not free.
    pub curvature: Option<SMatrix<T, M, M>>,
}

impl<T: Real, S: Variational<M, Scalar = T>, B: Differentiated<S, M>, const M: usize> Endpoints<'_, S, M, B> {
    /// The end of a path of so many edges at `q`. Where it may end anywhere, all motions are free, and there is no gap. The kernel is of
    /// eigenvalues below √ε of the largest.
    #[inline]
    pub fn end(&self, q: &S::Configuration, edges: usize) -> PathEnd<T, M> {
        let Some(target) = self.target else {
            let endpoint = self.system.endpoint(self.time_of_end(edges), q);
            return PathEnd {
                closing: SVector::zeros(),
                kernel: Some(SMatrix::identity()),
                distance: T::zero(),
                along: T::zero(),
                scale: q.max_abs(),
                price: endpoint.price,
                slope: endpoint.slope,
                curvature: Some(endpoint.curvature),
            };
        };
        let approach = self.system.approach(q, target);
        let (closing, kernel) = shortest(&self.system.orbit_metric(q), &approach);
        // Rounding makes the square of 0 negative.
        let along = larger(T::zero(), closing.dot(&approach)).sqrt();
        let scale = larger(target.max_abs(), q.max_abs());
        let is_round_off = along <= T::from_f64(4.0) * T::EPSILON * scale;
        PathEnd {
            closing: if is_round_off { SVector::zeros() } else { closing },
            kernel,
            distance: q.distance_squared(target).sqrt(),
            along,
            scale,
            price: T::zero(),
            slope: SVector::zeros(),
            curvature: None,
        }
    }
}

impl<T: Real, const M: usize> PathEnd<T, M> {
    /// Whether nothing is left that motions along the orbit can close.
    #[inline]
    pub fn is_closed(&self) -> bool {
        self.closing.iter().all(|x| *x == T::zero())
    }

    /// Whether the gap is closed or below `enough` of the size of the configuration.
    #[inline]
    pub fn is_near(&self, enough: T) -> bool {
        self.is_closed() || self.distance <= enough * self.scale
    }

    /// Whether the gap is none to a person: below √ε.
    pub fn is_reached(&self) -> bool {
        is_reached(self.distance, self.scale)
    }

    /// Whether the gap stands at a right angle to the orbit, so that no small motion of q_N closes it.
    pub fn is_orthogonal(&self) -> bool {
        !self.is_reached() && self.along <= T::EPSILON.sqrt() * self.distance
    }

    /// The error where none of the gap can be closed.
    pub fn unreachable(&self) -> Error {
        Error::Unreachable { distance: self.distance.to_f64() }
    }

    /// The closing motion with the length of the arc over the gap.
    pub fn arc(&self) -> SVector<T, M> {
        let square = self.distance * self.distance - self.along * self.along;
        let across = larger(T::zero(), square).sqrt();
        arc_per_chord(self.along, across).map_or(self.closing, |factor| self.closing * factor)
    }
}
