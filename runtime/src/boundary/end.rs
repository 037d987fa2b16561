//! The last vertex: what separates it from the target and which of its motions are free.

use crate::newton::{arc_per_chord, is_reached, shortest_with_kernel};
use crate::space::larger;
use crate::{EndpointExpansion, Real, Space, Variational};
use nalgebra::{SMatrix, SVector};

/// What is known where a path ends.
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

impl<T: Real, const M: usize> PathEnd<T, M> {
    /// The end of a path at `q`.
    ///
    /// The kernel is of eigenvalues below √ε of the largest.
    #[inline]
    pub fn of<S: Variational<M, Scalar = T>>(system: &S, q: &S::Configuration, target: &S::Configuration) -> Self {
        let metric = system.orbit_metric(q);
        let approach = system.approach(q, target);
        let (closing, kernel) = shortest_with_kernel(&metric, &approach);
        // Rounding makes the square of 0 negative.
        let along = larger(T::zero(), closing.dot(&approach)).sqrt();
        let scale = larger(target.max_abs(), q.max_abs());
        let distance = q.distance_squared(target).sqrt();
        let (price, slope) = (T::zero(), SVector::from_element(T::zero()));
        let mut end = Self { closing, kernel, distance, along, scale, price, slope, curvature: None };
        if along <= T::from_f64(4.0) * T::EPSILON * scale {
            end.closing = SVector::from_element(T::zero());
        }
        end
    }

    /// The end of a path that may end anywhere: all motions are free, and there is no gap.
    pub fn free(endpoint: &EndpointExpansion<T, M>, scale: T) -> Self {
        let zero = T::zero();
        Self {
            closing: SVector::from_element(zero),
            kernel: Some(SMatrix::from_fn(|i, j| if i == j { T::one() } else { zero })),
            distance: zero,
            along: zero,
            scale,
            price: endpoint.price,
            slope: endpoint.slope,
            curvature: Some(endpoint.curvature),
        }
    }

    /// The derivative of the momentum at the end, with that of the price.
    pub fn bent(&self, momentum: &SMatrix<T, M, M>) -> SMatrix<T, M, M> {
        match &self.curvature {
            Some(curvature) => SMatrix::from_fn(|i, j| momentum[(i, j)] + curvature[(i, j)]),
            None => *momentum,
        }
    }

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

    /// The closing motion with the length of the arc over the gap.
    pub fn arc(&self) -> SVector<T, M> {
        let square = self.distance * self.distance - self.along * self.along;
        let across = larger(T::zero(), square).sqrt();
        arc_per_chord(self.along, across).map_or(self.closing, |factor| self.closing * factor)
    }
}

#[cfg(test)]
mod tests {
    use super::PathEnd;
    use nalgebra::Vector3;

    #[test]
    fn chords_become_arcs() {
        for angle in [1e-9_f64, 0.5, 3.1] {
            let radius = 3.0;
            let end = PathEnd {
                closing: Vector3::x(),
                kernel: None,
                distance: 2.0 * radius * (angle / 2.0).sin(),
                along: radius * angle.sin(),
                scale: radius,
                price: 0.0,
                slope: Vector3::zeros(),
                curvature: None,
            };
            assert!((end.arc().x * angle.sin() - angle).abs() < 1e-12, "{angle}");
        }
    }
}
