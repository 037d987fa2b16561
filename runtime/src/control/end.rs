//! The end of a plan: its difference from the target, the changes that the target fixes, and the effect of the inputs
//! on it.

use super::Target;
use super::sweep::Problem;
use crate::newton::{Equilibrated, Spectrum, arc_per_chord, is_reached};
use crate::space::larger;
use crate::{Arrival, Controlled, Real, Scalar, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// R in units of |Γ⁻¹|.
const STIFFNESS: f64 = 4.0;
/// Eigenvalues below so many units in the last place of the largest are those of directions that no input reaches.
const UNITS: f64 = 256.0;

/// The data at the end of a plan. A change δ arrives where E δ = e.
#[derive(Clone, Copy)]
pub(super) struct PlanEnd<T, const D: usize> {
    /// e, as lengths
    pub lack: SVector<T, D>,
    /// E: the lengths of δ, projected to those that the target fixes.
    pub slope: SMatrix<T, D, D>,
    /// Half the gradient of the squared distance, reversed, and half its Hessian but for the bend of the space.
    pub pull: SVector<T, D>,
    pub metric: SMatrix<T, D, D>,
    /// The squared distance of configurations, and of momenta.
    pub squares: [T; 2],
    /// The distance from the end to the target.
    pub distance: T,
    /// The numbers that the distance is compared with: the largest entry of end and target.
    pub scale: T,
}

impl<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> Problem<'_, S, D, U, C> {
    /// The lengths |∂x/∂δ_i| of small changes at the target, 1 where there is none.
    pub fn lengths(system: &S, target: &Target<S::Place>) -> SVector<S::Scalar, D> {
        let slope = target.place().map_or(SMatrix::zeros(), |goal| system.arrival(goal, goal).slope);
        // Written so that NaN gives 1.
        slope.diagonal().map(|x| if x.abs().sqrt() > S::Scalar::zero() { x.abs().sqrt() } else { S::Scalar::one() })
    }

    /// The end of a plan at `x`. A small motion closes the tangential part of a chord, lengthened to its arc. This is
    /// exact in flat spaces and for rotations about one axis.
    pub fn end(&self, x: &S::Place) -> PlanEnd<S::Scalar, D> {
        let Self { target, lengths, .. } = self;
        let (zero, one) = (S::Scalar::zero(), S::Scalar::one());
        let none = Arrival { residual: SVector::zeros(), slope: SMatrix::zeros() };
        let arrival = target.place().map_or(none, |goal| self.system.arrival(x, goal));
        let goal = target.place().unwrap_or(x);
        let Arrival { residual, slope } = &arrival;
        let asked = if matches!(target, Target::Configuration(_)) { S::MOTIONS } else { D };
        let is_asked = |i: usize| if i < asked { one } else { zero };
        // as lengths: the projector to the changes that the target fixes, and the smallest that closes the gap
        let spectrum = Spectrum::of(&SMatrix::<_, D, D>::from_fn(|i, j| {
            slope[(i, j)] / (lengths[i] * lengths[j]) * is_asked(i) * is_asked(j)
        }));
        let least = S::Scalar::EPSILON.sqrt() * spectrum.largest();
        let projector = spectrum.map(|value| if value <= least { zero } else { one });
        let inverse = spectrum.map(|value| if value <= least { zero } else { value.recip() });
        let mut lack = inverse * SVector::<_, D>::from_fn(|i, _| residual[i] / lengths[i] * is_asked(i));
        let square = |from: usize, to: usize| (from..to).fold(zero, |sum, i| sum + residual[i] * residual[i]);
        let along = (0..S::MOTIONS.min(asked)).fold(zero, |sum, i| sum + lack[i] * residual[i] / lengths[i]);
        let momentum = square(S::MOTIONS, asked);
        let chord = larger(zero, goal.distance_squared(x) - square(S::MOTIONS, D));
        let across = larger(zero, chord - along).sqrt();
        if let Some(factor) = arc_per_chord(larger(zero, along).sqrt(), across) {
            (0..S::MOTIONS).for_each(|i| lack[i] *= factor);
        }
        PlanEnd {
            lack,
            slope: SMatrix::from_fn(|i, j| projector[(i, j)] * lengths[j]),
            pull: SVector::from_fn(|i, _| residual[i] * is_asked(i)),
            metric: SMatrix::from_fn(|i, j| slope[(i, j)] * is_asked(i) * is_asked(j)),
            squares: [chord, momentum],
            distance: (chord + momentum).sqrt(),
            scale: larger(goal.max_abs(), x.max_abs()),
        }
    }
}

impl<T: Real, const D: usize> PlanEnd<T, D> {
    /// Whether the gap is round-off.
    pub fn is_closed(&self) -> bool {
        self.distance <= T::from_f64(256.0) * T::EPSILON * self.scale
    }

    /// Whether the gap is none to a person: below √ε.
    pub fn is_reached(&self) -> bool {
        is_reached(self.distance, self.scale)
    }
}

/// The Gramian Γ = Σ_k Q_uνᵀ Q_uu⁻¹ Q_uν of all inputs of a plan: how far they move the end.
impl<T: Real, const D: usize> Equilibrated<T, D> {
    /// Γ⁺, 0 in directions that no input reaches.
    pub fn inverse(&self) -> SMatrix<T, D, D> {
        let least = T::from_f64(UNITS) * T::EPSILON * self.spectrum.largest();
        // Written so that NaN stays NaN.
        self.map(|value| if value.abs() <= least { T::zero() } else { value.recip() })
    }

    /// R for the next sweep, where this is the Gramian with R: a multiple of |Γ⁻¹| of the Gramian without, Γ_R⁻¹ = Γ⁻¹ + R. Where no change
    /// of the inputs that keeps the target makes the price smaller, that makes all Q_uu positive (Finsler's lemma).
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

    /// The number of negative eigenvalues of the Hessian on plans that keep the target, by Sylvester's law of inertia. It is that of all Q_uu and
    /// of −Γ, less the number of conditions. Directions without curvature on plans that arrive, as those of a symmetry, do not count.
    pub fn index(&self, negative: usize, rank: usize) -> usize {
        (negative + self.count_above(T::EPSILON.powf(T::from_ratio(1, 3)))).saturating_sub(rank)
    }
}
