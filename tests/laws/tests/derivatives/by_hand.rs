//! Derivatives of declared closures by central differences, for one rotation group acting on vectors or matrices.

use clebsch_tests::oracle::rotation::{cayley, skew};
use nalgebra::{SMatrix, SVector};

use crate::H;

/// f′(0) by central differences of fourth order.
pub fn slope(f: impl Fn(f64) -> f64) -> f64 {
    let e = 1e-3;
    (8.0 * (f(e) - f(-e)) - (f(2.0 * e) - f(-2.0 * e))) / (12.0 * e)
}

/// exp(ε E_i) up to ε³: the Cayley transform of ε E_i/2, whose error of third order does not show in a derivative.
fn turn<const N: usize, const M: usize>(i: usize, epsilon: f64) -> SMatrix<f64, N, N> {
    cayley(&(skew::<N, M>(&SVector::from_fn(|k, _| if k == i { epsilon } else { 0.0 })) / 2.0))
}

/// Φ_F(q) of F and q.
pub type Action<'a, const N: usize, const C: usize> =
    &'a dyn Fn(&SMatrix<f64, N, N>, &SMatrix<f64, N, C>) -> SMatrix<f64, N, C>;

/// Momentum map, both Legendre transforms and kicks of a rotation group, from the closures alone.
pub struct ByHand<'a, const N: usize, const C: usize> {
    pub right: bool,
    pub act: Action<'a, N, C>,
    pub cost: &'a dyn Fn(&SMatrix<f64, N, N>) -> f64,
    pub potential: &'a dyn Fn(&SMatrix<f64, N, C>) -> f64,
}

impl<const N: usize, const C: usize> ByHand<'_, N, C> {
    pub fn momentum_map<const M: usize>(&self, q: &SMatrix<f64, N, C>, p: &SMatrix<f64, N, C>) -> Vec<f64> {
        (0..M).map(|i| slope(|e| p.dot(&(self.act)(&turn::<N, M>(i, e), q)))).collect()
    }

    /// J(q, −h/2 ∂V)
    pub fn kick<const M: usize>(&self, q: &SMatrix<f64, N, C>) -> Vec<f64> {
        (0..M).map(|i| slope(|e| -H / 2.0 * (self.potential)(&(self.act)(&turn::<N, M>(i, e), q)))).collect()
    }

    /// ⟨T* ∂_F K, E_i⟩ with the perturbation inside (before the step) or outside (after it) of F.
    fn translated<const M: usize>(&self, f: &SMatrix<f64, N, N>, after: bool) -> Vec<f64> {
        let perturbed = |i, e| if self.right != after { turn::<N, M>(i, e) * f } else { f * turn::<N, M>(i, e) };
        (0..M).map(|i| slope(|e| (self.cost)(&perturbed(i, e)))).collect()
    }

    pub fn legendre<const M: usize>(&self, q: &SMatrix<f64, N, C>, f: &SMatrix<f64, N, N>) -> Vec<f64> {
        self.translated::<M>(f, false).iter().zip(self.kick::<M>(q)).map(|(k, kick)| k - kick).collect()
    }

    pub fn legendre_next<const M: usize>(&self, q: &SMatrix<f64, N, C>, f: &SMatrix<f64, N, N>) -> Vec<f64> {
        let kick = self.kick::<M>(&(self.act)(f, q));
        self.translated::<M>(f, true).iter().zip(kick).map(|(k, kick)| k + kick).collect()
    }
}
