//! A path of many edges is begun with few, which cost little.

use super::Node;
use super::sweep::Endpoints;
use crate::newton::Curvature;
use crate::scheme::Scheme;
use crate::{Real, Scalar, Space, Variational};
use nalgebra::SVector;
use num_traits::{One, Zero};

/// The edges of a coarse path, an even number: a step has at most two.
const COARSE: usize = 8;
/// Edges from which on a coarse path is made.
const MANY: usize = 4 * COARSE;
/// Corrections of the coarse path.
const CORRECTIONS: usize = 3;

/// The motions of the vertices of a coarse path, q_0 first.
pub(super) type Motions<S, const M: usize> = [SVector<<S as crate::Clebsch>::Scalar, M>; COARSE + 1];

impl<S: Variational<M, Scalar: Real>, const M: usize> Endpoints<'_, S, M> {
    /// How the vertices of a coarse path move from where all its edges are alike to near where its action is least.
    ///
    /// The path has as many steps as it takes in the same time, and its first nodes are made use of. `None` for a path of few edges, and where
    /// corrections are no small motions towards a minimum: steps may be too long then for what happens in them.
    pub fn coarse(&self, path: &mut [Node<S, M>], eta: &SVector<S::Scalar, M>) -> Option<Motions<S, M>> {
        let ratio = S::Scalar::from_f64(path.len() as f64) / S::Scalar::from_f64(COARSE as f64);
        let few = path.get_mut(..COARSE).filter(|_| ratio >= S::Scalar::from_f64((MANY / COARSE) as f64))?;
        let h = self.h * ratio;
        let constants = S::Scheme::constants(self.system, h).ok()?;
        let endpoints = Endpoints { h, constants: &constants, ..*self };
        endpoints.fill(few, eta * ratio);
        let mut end = endpoints.roll_out(few);
        let mut motions = [SVector::from_element(S::Scalar::zero()); COARSE + 1];
        let mut bound = S::Scalar::one();
        for _ in 0..CORRECTIONS {
            let gap = endpoints.end(&end, few.len());
            let summary = endpoints.eliminate(few, &end, &gap, Curvature::kept());
            let size = summary.size();
            // Written so that NaN is no progress.
            if !(summary.negative == 0 && size <= bound) {
                return None;
            }
            end = endpoints.correct(few, S::Scalar::one());
            motions.iter_mut().skip(1).zip(few.iter()).for_each(|(sum, node)| *sum += node.motion);
            // The next correction would be less than what few edges differ by from many.
            if size <= S::Scalar::from_ratio(1, 8) {
                return motions.iter().all(Space::is_finite).then_some(motions);
            }
            bound = size * S::Scalar::from_ratio(1, 2);
        }
        None
    }
}

/// The motions of the vertices of a path of so many edges after the first, one after the other: cubics through those of the four coarse
/// vertices about each.
pub(super) fn interpolated<T: Real, const M: usize>(
    motions: &[SVector<T, M>; COARSE + 1],
    edges: usize,
) -> impl FnMut(usize) -> SVector<T, M> {
    let (half, sixth) = (T::from_ratio(1, 2), T::from_ratio(1, 6));
    let spacing = T::from_f64(COARSE as f64) / T::from_f64(edges as f64);
    let mut first = 0;
    move |k| {
        while first < COARSE - 3 && k * COARSE >= (first + 2) * edges {
            first += 1;
        }
        let x = T::from_f64(k as f64) * spacing - T::from_f64(first as f64);
        let (a, b, c) = (x - T::one(), x - T::from_f64(2.0), x - T::from_f64(3.0));
        let (early, late) = (b * c, x * a);
        let weights = [-a * early * sixth, x * early * half, -late * c * half, late * b * sixth];
        let nearest = motions.iter().skip(first).zip(weights);
        nearest.fold(SVector::from_element(T::zero()), |sum, (motion, weight)| sum + motion * weight)
    }
}

#[cfg(test)]
mod tests {
    use super::{COARSE, interpolated};
    use nalgebra::Vector1;

    #[test]
    fn cubics_are_interpolated_exactly() {
        let cubic = |x: f64| Vector1::new(x * (x - 0.3) * (x - 2.0));
        let motions = core::array::from_fn(|k| cubic(k as f64 / COARSE as f64));
        for edges in [33, 50, if cfg!(miri) { 64 } else { 1000 }] {
            let mut motion = interpolated(&motions, edges);
            for k in 0..=edges {
                let error = motion(k) - cubic(k as f64 / edges as f64);
                assert!(error.amax() < 1e-14, "{k} of {edges}");
            }
        }
    }
}
