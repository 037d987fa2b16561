//! The end of a plan: what separates it from the target, and which of its changes the target fixes.

use super::Target;
use crate::newton::{Spectrum, arc_per_chord, is_reached};
use crate::space::larger;
use crate::{Controlled, Real, Space};
use nalgebra::{SMatrix, SVector};

/// A target with the units of its changes.
pub(super) struct Goal<'a, X, T, const D: usize> {
    pub target: &'a Target<X>,
    /// The lengths |∂x/∂δ_i| of small changes at the target.
    lengths: SVector<T, D>,
}

/// What is known where a plan ends. A change δ arrives where E δ = e.
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
    /// The distance to what is asked of the end.
    pub distance: T,
    /// The numbers that the distance is compared with: the largest entry of end and target.
    pub scale: T,
}

impl<'a, X: Space<T>, T: Real, const D: usize> Goal<'a, X, T, D> {
    pub fn of<S, const U: usize, const C: usize>(system: &S, target: &'a Target<X>) -> Self
    where
        S: Controlled<D, U, C, Scalar = T, Place = X>,
    {
        let slope = target.place().map_or(SMatrix::zeros(), |goal| system.arrival(goal, goal).slope);
        let lengths = SVector::from_fn(|i, _| {
            let length = slope[(i, i)].abs().sqrt();
            // Written so that NaN gives 1.
            if length > T::zero() { length } else { T::one() }
        });
        Self { target, lengths }
    }

    /// The end of a plan at `x`.
    ///
    /// What small motions close of a gap is taken for the tangential part of the chord of a circle and lengthened to its arc: exact in
    /// flat spaces and for the rotations about one axis.
    pub fn end<S, const U: usize, const C: usize>(&self, system: &S, x: &X) -> PlanEnd<T, D>
    where
        S: Controlled<D, U, C, Scalar = T, Place = X>,
    {
        let zero = T::zero();
        let Some(goal) = self.target.place() else {
            return PlanEnd {
                lack: SVector::zeros(),
                slope: SMatrix::zeros(),
                pull: SVector::zeros(),
                metric: SMatrix::zeros(),
                squares: [zero; 2],
                distance: zero,
                scale: x.max_abs(),
            };
        };
        let lengths = &self.lengths;
        let arrival = system.arrival(x, goal);
        let asked = if matches!(self.target, Target::Configuration(_)) { S::MOTIONS } else { D };
        let is_asked = |i: usize| if i < asked { T::one() } else { zero };
        // as lengths: the projector to the changes that the target fixes, and the smallest that closes the gap
        let spectrum = Spectrum::of(&SMatrix::from_fn(|i, j| {
            arrival.slope[(i, j)] / (lengths[i] * lengths[j]) * is_asked(i) * is_asked(j)
        }));
        let least = T::EPSILON.sqrt() * spectrum.largest();
        let projector = spectrum.map(|value| if value <= least { zero } else { T::one() });
        let inverse = spectrum.map(|value| if value <= least { zero } else { value.recip() });
        let mut lack = inverse * SVector::from_fn(|i, _| arrival.residual[i] / lengths[i] * is_asked(i));
        let square =
            |from: usize, to: usize| (from..to).fold(zero, |sum, i| sum + arrival.residual[i] * arrival.residual[i]);
        let along = (0..S::MOTIONS.min(asked)).fold(zero, |sum, i| sum + lack[i] * arrival.residual[i] / lengths[i]);
        let momentum = square(S::MOTIONS, asked);
        let chord = larger(zero, goal.distance_squared(x) - square(S::MOTIONS, D));
        let across = larger(zero, chord - along).sqrt();
        if let Some(factor) = arc_per_chord(larger(zero, along).sqrt(), across) {
            (0..S::MOTIONS).for_each(|i| lack[i] *= factor);
        }
        PlanEnd {
            lack,
            slope: SMatrix::from_fn(|i, j| projector[(i, j)] * lengths[j]),
            pull: SVector::from_fn(|i, _| arrival.residual[i] * is_asked(i)),
            metric: SMatrix::from_fn(|i, j| arrival.slope[(i, j)] * is_asked(i) * is_asked(j)),
            squares: [chord, momentum],
            distance: (chord + momentum).sqrt(),
            scale: larger(goal.max_abs(), x.max_abs()),
        }
    }

    /// The multipliers ν with the covector Eᵀν nearest to this one, for an end where E is given.
    pub fn multipliers(&self, end: &PlanEnd<T, D>, covector: &SVector<T, D>) -> SVector<T, D> {
        let lengths = &self.lengths;
        let scaled = SVector::<T, D>::from_fn(|i, _| covector[i] / lengths[i]);
        SMatrix::<T, D, D>::from_fn(|i, j| end.slope[(i, j)] / lengths[j]) * scaled
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
