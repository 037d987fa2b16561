//! How far the inputs move the end: the Gramian Γ = Σ_k Q_uνᵀ Q_uu⁻¹ Q_uν of all inputs of a plan, and the multipliers of the target that it
//! answers for.

use crate::Real;
use crate::newton::Equilibrated;
use nalgebra::SMatrix;

/// R in units of |Γ⁻¹|.
const STIFFNESS: f64 = 4.0;
/// Eigenvalues below so many units in the last place of the largest are those of directions that no input reaches.
const UNITS: f64 = 256.0;

/// Of a Gramian.
impl<T: Real, const D: usize> Equilibrated<T, D> {
    /// Γ⁺, 0 in directions that no input reaches.
    pub fn inverse(&self) -> SMatrix<T, D, D> {
        let least = T::from_f64(UNITS) * T::EPSILON * self.spectrum.largest();
        // Written so that NaN stays NaN.
        self.map(|value| if value.abs() <= least { T::zero() } else { value.recip() })
    }

    /// R for the next sweep, where this is the Gramian with R: a multiple of |Γ⁻¹| of the Gramian without, Γ_R⁻¹ = Γ⁻¹ + R.
    ///
    /// Where no change of the inputs that keeps the target makes the price smaller, that makes all Q_uu positive (Finsler's lemma).
    pub fn weight(&self, gramian: &SMatrix<T, D, D>, weight: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        let inverse = self.inverse();
        let reached = gramian * inverse;
        let Self { spectrum, scale } = Self::of(&(inverse - reached.tr_mul(&(weight * reached))));
        let absolute = spectrum.map(|value| value.abs() * T::from_f64(STIFFNESS));
        let length = |i: usize| if scale[i] > T::zero() { scale[i].recip() } else { T::zero() };
        SMatrix::from_fn(|i, j| length(i) * absolute[(i, j)] * length(j))
    }

    /// The number of directions that inputs reach, where all Q_uu are positive.
    pub fn rank(&self) -> usize {
        self.count_above(T::from_f64(UNITS) * T::EPSILON)
    }

    /// The number of negative eigenvalues of the Hessian on plans that keep the target, by Sylvester's law of inertia: those of all Q_uu and
    /// of −Γ, less the number of conditions. Directions in which the curvature of the price vanishes on plans that arrive, as those of a
    /// symmetry do, count for none.
    pub fn index(&self, negative: usize, rank: usize) -> usize {
        (negative + self.count_above(T::EPSILON.powf(T::from_ratio(1, 3)))).saturating_sub(rank)
    }
}
