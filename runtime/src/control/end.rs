//! The end of a plan: its difference from the target, the changes that the target fixes, and the effect of the inputs
//! on it.

use super::start::Start;
use super::sweep::{Plan, PlanSummary, Problem, Settings};
use super::{Stage, Target};
use crate::newton::{Equilibrated, Spectrum, arc_per_chord, is_reached};
use crate::space::larger;
use crate::{Arrival, Columns, Controlled, Real, Scalar, Space, TargetExpansion};
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// R in units of |Γ⁻¹|.
const STIFFNESS: f64 = 4.0;
/// Eigenvalues below so many units in the last place of the largest are those of directions that no input reaches.
const UNITS: f64 = 256.0;
/// The length of a momentum is the way that it moves the system in so many times of a plan. Of 40 random plans of a trailer, all are found with
/// 3 to 30 times. With 0.3 times 29 are found, with 1 time 37, and with 100 times 35.
const LONGER: f64 = 4.0;
/// Inequalities that are violated or not satisfied by more than this part of their size are next to equations.
const NEXT: (i64, i64) = (1, 100);

/// The data at the end of a plan. A change δ arrives where E δ = e.
#[derive(Clone, Copy)]
pub(super) struct PlanEnd<T, const D: usize> {
    /// e, as lengths
    pub lack: SVector<T, D>,
    /// E: the lengths of δ, projected to those that the target fixes.
    pub slope: SMatrix<T, D, D>,
    /// The slopes of conditions along all changes, those that a constraint forbids too: the force of ν on the end has its part there. Else E.
    pub all_slopes: SMatrix<T, D, D>,
    /// A basis of conditions that are independent, the columns S B, and its dual, S⁻¹ B. The columns of B are orthonormal, and S has the
    /// reciprocal sizes of conditions. `None` where changes are the conditions.
    ///
    /// An equation that follows from others may have slopes that vanish by and by, as that of a unit vector along an axis. By itself it would
    /// count as much as the others do.
    pub basis: Option<[SMatrix<T, D, D>; 2]>,
    /// The smallest change that closes the gap, to first order.
    pub motion: SVector<T, D>,
    /// Half the gradient of the squared distance, reversed, and half its Hessian but for the bend of the space.
    pub pull: SVector<T, D>,
    pub metric: SMatrix<T, D, D>,
    /// The squared distance of configurations, and of momenta as lengths.
    pub squares: [T; 2],
    /// The distance from the end to the target, with momenta as lengths.
    pub distance: T,
    /// The distance of all entries as they are.
    pub gap: T,
    /// The numbers that the distance is compared with: the largest entry of end, target and places before. Of several conditions the most
    /// distant one counts, in units of its size.
    pub scale: T,
}

/// The lengths |∂x/∂δ_i| of small changes at the target, 1 where there is none.
pub(super) fn lengths<S, const D: usize, const U: usize, const C: usize>(
    system: &S,
    target: &Target<S::Place>,
) -> SVector<S::Scalar, D>
where
    S: Controlled<D, U, C, Scalar: Real>,
{
    let slope = target.place().map_or(SMatrix::zeros(), |goal| system.arrival(goal, goal).slope);
    // Written so that NaN gives 1.
    slope.diagonal().map(|x| if x.abs().sqrt() > S::Scalar::zero() { x.abs().sqrt() } else { S::Scalar::one() })
}

/// The largest entry of a place, with momenta as lengths.
fn size<S, const D: usize, const U: usize, const C: usize>(x: &S::Place, lengths: &SVector<S::Scalar, D>) -> S::Scalar
where
    S: Controlled<D, U, C, Scalar: Real>,
{
    if S::MOTIONS == D {
        return x.max_abs();
    }
    let [width, momenta] = widths::<S, D, U, C>();
    (0..width).fold(S::Scalar::zero(), |largest, k| {
        let entry = x.entry(k).map_or(S::Scalar::zero(), |entry| entry.abs());
        let length = k.checked_sub(momenta).and_then(|i| lengths.get(S::MOTIONS + i));
        larger(largest, length.map_or(entry, |length| entry * *length))
    })
}

/// The number of all entries of a place, and of those before its momenta.
fn widths<S: Controlled<D, U, C>, const D: usize, const U: usize, const C: usize>() -> [usize; 2] {
    let width = const { <S::Place as Columns<S::Scalar>>::FORM.width() };
    [width, width.saturating_sub(D - S::MOTIONS)]
}

/// The squared distance of two configurations.
fn chord<S, const D: usize, const U: usize, const C: usize>(x: &S::Place, y: &S::Place) -> S::Scalar
where
    S: Controlled<D, U, C, Scalar: Real>,
{
    if S::MOTIONS == D {
        return x.distance_squared(y);
    }
    let [_, momenta] = widths::<S, D, U, C>();
    let entry = |place: &S::Place, k: usize| place.entry(k).unwrap_or(S::Scalar::zero());
    let apart = |k: usize| entry(x, k) - entry(y, k);
    (0..momenta).fold(S::Scalar::zero(), |sum, k| sum + apart(k) * apart(k))
}

/// Changes that are as large as a place, of each component, where changes have these lengths.
pub(super) fn sizes<S, const D: usize, const U: usize, const C: usize>(
    x: &S::Place,
    lengths: &SVector<S::Scalar, D>,
) -> SVector<S::Scalar, D>
where
    S: Controlled<D, U, C, Scalar: Real>,
{
    let size = size::<S, D, U, C>(x, lengths);
    SVector::from_fn(|i, _| if i < S::MOTIONS { size } else { size / lengths[i] })
}

impl<S: Controlled<D, U, C, Scalar: Real>, B: Start<S, D, U, C>, const D: usize, const U: usize, const C: usize>
    Problem<'_, S, B, D, U, C>
{
    /// The largest entry of a place, with momenta as lengths.
    pub fn size(&self, x: &S::Place) -> S::Scalar {
        size::<S, D, U, C>(x, &self.lengths)
    }

    /// Changes that are as large as a place, of each component.
    pub fn sizes(&self, x: &S::Place) -> SVector<S::Scalar, D> {
        sizes::<S, D, U, C>(x, &self.lengths)
    }

    /// Finds the lengths of momenta by the first step. Where conditions are the target, momenta are as long as their numbers.
    pub fn find_lengths(&mut self, stage: &Stage<S, D, U, C>) {
        if S::MOTIONS == D || matches!(self.target, Target::Conditions) {
            return;
        }
        let Ok(step) = self.expand(stage, self.time, &SVector::zeros()) else { return };
        let steps = S::Scalar::from_f64(LONGER * self.steps as f64);
        for j in S::MOTIONS..D {
            let moved = (0..S::MOTIONS).map(|i| step.by_place[(i, j)] * self.lengths[i] * steps);
            let length = moved.fold(S::Scalar::zero(), |sum, entry| sum + entry * entry).sqrt();
            self.lengths[j] = if length > S::Scalar::zero() && length.is_finite() { length } else { S::Scalar::one() };
        }
    }

    /// The conditions of the end at `x` that `target` declares, where they are the target, with the curvature of ν·g.
    pub fn conditions(
        &self,
        x: &S::Place,
        multipliers: &SVector<S::Scalar, D>,
    ) -> Option<TargetExpansion<S::Scalar, D>> {
        let is_declared = matches!(self.target, Target::Conditions);
        is_declared.then(|| {
            let mut conditions = self.system.target_expanded(self.constants, self.end_time(), x, multipliers);
            without_kinks(&mut conditions.slope);
            if !conditions.curvature.all_finite() {
                conditions.curvature = SMatrix::zeros();
            }
            conditions
        })
    }

    /// The end of a plan where conditions are the target. An inequality counts as an equation where it pushes or is violated, and else as none.
    fn end_of(
        &self,
        x: &S::Place,
        conditions: &TargetExpansion<S::Scalar, D>,
        largest: S::Scalar,
        pushing: &[bool; D],
    ) -> PlanEnd<S::Scalar, D> {
        let (zero, one) = (S::Scalar::zero(), S::Scalar::one());
        let sizes = conditions.sizes_for(largest);
        // Written so that NaN counts.
        let is_satisfied = |i: usize| conditions.values[i] <= round_off::<S::Scalar>() * sizes[i];
        let counts = |i: usize| i < S::EQUATIONS || pushing[i] || !is_satisfied(i);
        let lack = SVector::<S::Scalar, D>::from_fn(|i, _| if counts(i) { -conditions.values[i] } else { zero });
        let all_slopes =
            SMatrix::<S::Scalar, D, D>::from_fn(|i, j| if counts(i) { conditions.slope[(i, j)] } else { zero });
        let tangent = self.system.tangent_projector(self.constants, self.end_time(), x);
        let slope = tangent.map_or(all_slopes, |tangent| all_slopes * tangent);
        let gap = |i: usize| if lack[i] == zero { zero } else { lack[i].abs() / sizes[i] };
        let relative = (0..D).fold(zero, |most, i| larger(most, gap(i)));
        let distance_squared = lack.dot(&lack);
        let distance = distance_squared.sqrt();
        let unit = |i: usize| if counts(i) && sizes[i] > zero { sizes[i].recip() } else { zero };
        let metric = slope * slope.transpose();
        let spectrum = Spectrum::of(&SMatrix::<_, D, D>::from_fn(|i, j| unit(i) * metric[(i, j)] * unit(j)));
        let least = S::Scalar::from_f64(UNITS) * S::Scalar::EPSILON * spectrum.largest();
        let column = |i: usize, k: usize| if spectrum.values[k] <= least { zero } else { spectrum.vectors[(i, k)] };
        let basis = SMatrix::from_fn(|i, k| unit(i) * column(i, k));
        let dual = SMatrix::from_fn(|i, k| if counts(i) { sizes[i] * column(i, k) } else { zero });
        let inverse = spectrum.map(|value| if value <= least { zero } else { value.recip() });
        let inverse = SMatrix::<_, D, D>::from_fn(|i, j| unit(i) * inverse[(i, j)] * unit(j));
        let motion = slope.tr_mul(&(inverse * lack));
        PlanEnd {
            pull: all_slopes.tr_mul(&lack),
            // without the part that no change closes: equations may follow from others, as those of unit vectors do
            lack: slope * motion,
            motion,
            metric: slope.tr_mul(&slope),
            squares: [distance_squared, zero],
            distance,
            gap: distance,
            scale: if relative > zero { distance / relative } else { one },
            slope,
            all_slopes,
            basis: Some([basis, dual]),
        }
    }

    /// The end of a plan at `x`, with places as large as `largest`. A small motion closes the tangential part of a chord, lengthened to its arc. This is
    /// exact in flat spaces and for rotations about one axis.
    pub fn end(&self, x: &S::Place, largest: S::Scalar, pushing: &[bool; D]) -> PlanEnd<S::Scalar, D> {
        if let Some(conditions) = self.conditions(x, &SVector::zeros()) {
            return self.end_of(x, &conditions, larger(largest, x.max_abs()), pushing);
        }
        let Self { target, lengths, .. } = self;
        let (zero, one) = (S::Scalar::zero(), S::Scalar::one());
        let none = Arrival { residual: SVector::zeros(), slope: SMatrix::zeros() };
        let mut arrival = target.place().map_or(none, |goal| self.system.arrival(x, goal));
        let entries = square(&arrival.residual, S::MOTIONS, D);
        for i in S::MOTIONS..D {
            let length = lengths[i];
            arrival.residual[i] *= length * length;
            arrival.slope.row_mut(i).iter_mut().for_each(|entry| *entry *= length);
            arrival.slope.column_mut(i).iter_mut().for_each(|entry| *entry *= length);
        }
        let goal = target.place().unwrap_or(x);
        let Arrival { residual, slope } = &arrival;
        let independent = self.system.independent(self.constants, self.end_time(), x, lengths);
        let asked = if matches!(target, Target::Configuration(_)) { S::MOTIONS } else { D };
        let is_asked = |i: usize| if i < asked { one } else { zero };
        // as lengths: the projector to the changes that the target fixes, and the smallest that closes the gap
        let mut scaled =
            SMatrix::<_, D, D>::from_fn(|i, j| slope[(i, j)] / (lengths[i] * lengths[j]) * is_asked(i) * is_asked(j));
        let mut lack = SVector::<_, D>::from_fn(|i, _| residual[i] / lengths[i] * is_asked(i));
        if let Some(independent) = &independent {
            (scaled, lack) = (independent * scaled * independent, independent * lack);
        }
        let spectrum = Spectrum::of(&scaled);
        let least = S::Scalar::EPSILON.sqrt() * spectrum.largest();
        let projector = spectrum.map(|value| if value <= least { zero } else { one });
        // conditions that a constraint makes dependent
        let column = |k: usize| if spectrum.values[k] <= least { zero } else { one };
        let basis = independent.map(|_| SMatrix::<_, D, D>::from_fn(|i, k| column(k) * spectrum.vectors[(i, k)]));
        let inverse = spectrum.map(|value| if value <= least { zero } else { value.recip() });
        let mut lack: SVector<_, D> = inverse * lack;
        let moving = lack.iter().zip(residual.iter()).zip(lengths.iter()).take(S::MOTIONS.min(asked));
        let along = moving.fold(zero, |sum, ((lack, residual), length)| sum + *lack * *residual / *length);
        let momentum = square(&residual.component_div(lengths), S::MOTIONS, asked);
        let chord = chord::<S, D, U, C>(goal, x);
        let across = larger(zero, chord - along).sqrt();
        if let Some(factor) = arc_per_chord(larger(zero, along).sqrt(), across) {
            lack.iter_mut().take(S::MOTIONS).for_each(|lack| *lack *= factor);
        }
        let slope_of_target = SMatrix::from_fn(|i, j| projector[(i, j)] * lengths[j]);
        PlanEnd {
            lack,
            motion: lack.component_div(lengths),
            basis: basis.map(|basis| [basis, basis]),
            slope: slope_of_target,
            all_slopes: slope_of_target,
            pull: SVector::from_fn(|i, _| residual[i] * is_asked(i)),
            metric: SMatrix::from_fn(|i, j| slope[(i, j)] * is_asked(i) * is_asked(j)),
            squares: [chord, momentum],
            distance: (chord + momentum).sqrt(),
            gap: (chord + if asked > S::MOTIONS { entries } else { zero }).sqrt(),
            scale: larger(larger(self.size(goal), self.size(x)), largest),
        }
    }
}

/// The sum of squares of some entries.
fn square<T: Real, const D: usize>(entries: &SVector<T, D>, from: usize, to: usize) -> T {
    entries.iter().take(to).skip(from).fold(T::zero(), |sum, entry| sum + *entry * *entry)
}

/// Leaves out slopes that are no numbers, as that of |x| where x is 0. The next correction leads away from there.
pub(super) fn without_kinks<T: Real, const M: usize, const N: usize>(slope: &mut SMatrix<T, M, N>) {
    for i in 0..M {
        if !slope.row(i).iter().all(|entry| entry.is_finite()) {
            slope.row_mut(i).fill(T::zero());
        }
    }
}

/// The part of the size of a gap that is round-off.
fn round_off<T: Real>() -> T {
    T::from_f64(256.0) * T::EPSILON
}

impl<T: Real, const D: usize> TargetExpansion<T, D> {
    /// The sizes of terms, for places as large as this.
    fn sizes_for(&self, largest: T) -> SVector<T, D> {
        // of a place at the origin the unit is that of its entries
        let largest = if largest > T::zero() { largest } else { T::one() };
        SVector::from_fn(|i, _| self.slope.row(i).iter().fold(self.sizes[i], |sum, slope| sum + slope.abs() * largest))
    }
}

/// Inequalities of the end, by the strategy of active sets. They push where their multipliers are positive.
///
/// Source: Hintermüller, Ito and Kunisch, *The primal-dual active set strategy as a semismooth Newton method* (2003).
impl<T: Real, S: Controlled<D, U, C, Scalar = T>, B: Start<S, D, U, C>, const D: usize, const U: usize, const C: usize>
    Plan<'_, S, B, D, U, C>
{
    /// Whether a condition of the end is an inequality.
    fn is_inequality(&self, i: usize) -> bool {
        matches!(self.problem.target, Target::Conditions) && i >= S::EQUATIONS && i < S::TARGET.len()
    }

    /// From now on those inequalities push that have a multiplier. None is negative. Returns whether others push.
    pub fn push(&mut self, multipliers: &mut SVector<T, D>) -> bool {
        let before = self.pushing;
        for i in 0..D {
            if self.is_inequality(i) {
                // Written so that NaN does not push.
                self.pushing[i] = multipliers[i] > T::zero();
                multipliers[i] = if self.pushing[i] { multipliers[i] } else { T::zero() };
            }
        }
        before != self.pushing
    }

    /// Those inequalities push that are next to equations.
    pub fn push_near(&mut self) {
        let Some(conditions) = self.problem.conditions(&self.last, &SVector::zeros()) else { return };
        let sizes = conditions.sizes_for(self.last.max_abs());
        for i in 0..D {
            if self.is_inequality(i) {
                self.pushing[i] = conditions.values[i] >= -sizes[i] * T::from_ratio(NEXT.0, NEXT.1);
            }
        }
    }

    /// Leaves inequalities out of a correction that would make their multipliers negative, the most negative first. `true` where one has a
    /// multiplier, which is now 0: the sweep has to be made again.
    pub fn release(
        &mut self,
        summary: &mut PlanSummary<T, D, U>,
        end: &mut PlanEnd<T, D>,
        settings: &mut Settings<T, D>,
    ) -> bool {
        let zero = T::zero();
        if settings.gap_price.is_some() {
            return false;
        }
        for _ in 0..D {
            let change = end.gramian(&summary.gramian).inverse() * summary.lack;
            let (mut least, mut pulls) = (zero, D);
            for i in 0..D {
                let next = settings.multipliers[i] + change[i];
                if self.is_inequality(i) && next < least {
                    (least, pulls) = (next, i);
                }
            }
            if pulls >= D {
                break;
            }
            if settings.multipliers[pulls] > zero {
                settings.multipliers[pulls] = zero;
                self.push(&mut settings.multipliers);
                return true;
            }
            summary.gramian.row_mut(pulls).fill(zero);
            summary.gramian.column_mut(pulls).fill(zero);
            (summary.lack[pulls], end.lack[pulls]) = (zero, zero);
        }
        false
    }
}

impl<T: Real, const D: usize> PlanEnd<T, D> {
    /// Γ, or another matrix of conditions, ready to be inverted.
    pub fn gramian(&self, gramian: &SMatrix<T, D, D>) -> Gramian<T, D> {
        let inner = self.basis.map_or(*gramian, |[basis, _]| basis.tr_mul(&(gramian * basis)));
        Gramian { inner: Equilibrated::of(&inner), basis: self.basis }
    }

    /// Whether the gap is round-off.
    pub fn is_closed(&self) -> bool {
        self.distance <= round_off::<T>() * self.scale
    }

    /// Whether the gap is none to a person: below √ε.
    pub fn is_reached(&self) -> bool {
        is_reached(self.distance, self.scale)
    }
}

/// The Gramian Γ in a basis of conditions that are independent.
pub(super) struct Gramian<T, const D: usize> {
    inner: Equilibrated<T, D>,
    basis: Option<[SMatrix<T, D, D>; 2]>,
}

impl<T: Real, const D: usize> Gramian<T, D> {
    /// Γ⁺
    pub fn inverse(&self) -> SMatrix<T, D, D> {
        let inverse = self.inner.inverse();
        self.basis.map_or(inverse, |[basis, _]| basis * inverse * basis.transpose())
    }

    /// R for the next sweep, from Γ with R.
    pub fn weight(&self, gramian: &SMatrix<T, D, D>, weight: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        let Some([basis, dual]) = self.basis else { return self.inner.weight(gramian, weight) };
        let [gramian, weight] = [basis.tr_mul(&(gramian * basis)), dual.tr_mul(&(weight * dual))];
        basis * self.inner.weight(&gramian, &weight) * basis.transpose()
    }

    /// The number of directions that inputs reach, where all Q_uu are positive.
    pub fn rank(&self) -> usize {
        self.inner.rank()
    }

    /// The number of negative eigenvalues of the Hessian on plans that keep the target.
    pub fn index(&self, negative: usize, rank: usize) -> usize {
        self.inner.index(negative, rank)
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
