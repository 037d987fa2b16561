//! The data between two sweeps, and the decisions that it allows.

use super::barrier;
use super::end::{Gramian, PlanEnd};
use super::slacks::Strictness;
use super::sweep::{PlanSummary, Settings};
use crate::Real;
use crate::newton::{Curvature, adapted};
use crate::space::larger;
use nalgebra::{SMatrix, SVector};

/// Corrections without the curvature of steps, after most steps had to go without it.
const STRAIGHT: u32 = 8;
/// Prices of the gap in a row that bring the end no nearer, after which none will.
const IN_VAIN: u32 = 2;
/// Directions that may lack curvature, as those of a symmetry do, while the curvature of steps is counted in full.
const FLAT: usize = 2;
/// Corrections in a row that no one sees, after which a plan is critical whatever they were made with: Newton's method would have needed two.
const CALM: u32 = 5;
/// Prices of the gap that are tried.
const ROUNDS: u32 = 20;
/// Corrections of this size are near enough a solution for the exact curvature and a fixed weight of the target.
const NEAR: (i64, i64) = (1, 100);
/// For corrections of this size the exact model is tried first. From further away it may lead past the minimum next to
/// the guess, as for a unicycle that moves sideways.
const TRIED: (i64, i64) = (1, 8);
/// The way down from a saddle is deeper than so many corrections that are still to be made.
const DEPTH: f64 = 16.0;
/// Damping below which there is none.
const LEAST_DAMPING: f64 = 1e-3;
/// Corrections of this size are near enough a critical plan to raise the price of the gap.
const CRITICAL: (i64, i64) = (1, 20);

/// A plan with its multipliers and with the results of earlier sweeps.
pub(super) struct Iterate<T, const D: usize> {
    pub settings: Settings<T, D>,
    /// Whether the first barrier is still to be chosen.
    pub is_open: bool,
    pub damping: T,
    /// R for the next sweep that has another.
    pub stiffer: SMatrix<T, D, D>,
    /// Whether it is known that more weight of the target makes no curvature positive.
    is_probed: bool,
    /// The number of directions that inputs move the end in.
    pub rank: usize,
    /// The size of the correction before, and how often in a row that was round-off.
    before: Option<T>,
    stagnations: u32,
    /// Sweeps in a row with corrections that no one sees.
    calm: u32,
    /// The largest price.
    pub largest: T,
    /// The part of the gap that the last correction closes by its model.
    pub closes: T,
    /// The smallest distance to the target.
    pub nearest: T,
    /// Steps in a row that were next to nothing.
    pub stalls: u32,
    /// Whether no way down from a saddle was found.
    is_cornered: bool,
    /// How often the price of the gap was raised, and how often in a row in vain.
    pub rounds: u32,
    in_vain: u32,
    /// The distance to the target before the price was raised.
    missed: Option<T>,
    /// Whether the last sweep left out the curvature of steps, and of most of them.
    is_straightened: bool,
    is_mostly_straight: bool,
    /// Whether equations were made less stiff again.
    is_relieved: bool,
    /// The number of corrections that still go without that curvature.
    straight: u32,
}

/// The decision after a sweep.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Verdict {
    /// Its correction leads downhill.
    Correct,
    /// It found a way down from a saddle.
    Escape,
    /// The next one is made otherwise.
    Repeat,
    /// The plan is critical, but no first derivative leads to the target.
    Stir,
    /// The plan is critical for this price of the gap.
    Price,
    /// The plan is critical for this barrier.
    Tighten,
    Done,
}

impl<T: Real, const D: usize> Iterate<T, D> {
    /// Before the first sweep; the strictness of bounds is chosen after it where none is given.
    pub fn new(multipliers: SVector<T, D>, strictness: Option<Strictness<T>>, distance: T) -> Self {
        let zero = T::zero();
        Self {
            settings: Settings {
                multipliers,
                weight: SMatrix::zeros(),
                gap_price: None,
                strictness: strictness.unwrap_or(Strictness::none()),
                curvature: Curvature::mirrored(zero, zero),
                is_straight: false,
                is_last: false,
            },
            is_open: strictness.is_none(),
            damping: zero,
            stiffer: SMatrix::zeros(),
            is_probed: false,
            rank: 0,
            before: None,
            stagnations: 0,
            calm: 0,
            largest: zero,
            closes: zero,
            nearest: distance,
            stalls: 0,
            is_cornered: false,
            rounds: 0,
            in_vain: 0,
            missed: None,
            is_straightened: false,
            is_relieved: false,
            is_mostly_straight: false,
            straight: 0,
        }
    }

    /// The quality of the sweep: whether its correction goes downhill. A sweep with mirrored curvature leaves out the
    /// curvature of steps where that leaves no minimum. If the price alone leaves none either, the exact model is tried,
    /// and then that without the curvature of any step. Near a solution the exact model comes first. Its correction
    /// counts where the model has a minimum among the plans that reach the target, far from a solution too.
    pub fn judge<const U: usize>(&mut self, summary: &PlanSummary<T, D, U>, gramian: &Gramian<T, D>) -> Verdict {
        self.stiffer = gramian.weight(&summary.gramian, &self.settings.weight);
        self.is_straightened = summary.straightened > 0;
        self.is_mostly_straight = summary.is_mostly_straight;
        if self.settings.curvature.is_mirrored {
            // Where curvatures are mirrored, directions that inputs reach are hidden by those that have none.
            let rank = gramian.rank();
            self.rank = if summary.negative == 0 { rank } else { self.rank.max(rank) };
            if summary.negative > 0 && !self.is_probed {
                self.settings.curvature = Curvature::exact(self.steadiness());
            } else if summary.negative > FLAT && !self.settings.is_straight {
                self.straighten();
                self.is_probed = false;
            } else {
                return Verdict::Correct;
            }
            return Verdict::Repeat;
        }
        let is_priced = self.is_priced();
        let index = if is_priced { summary.negative } else { gramian.index(summary.negative, self.rank) };
        let is_near = self.is_exact() && self.before.is_some_and(|before| before <= T::from_ratio(NEAR.0, NEAR.1));
        let depth = summary.fall.map_or(T::zero(), |fall| fall.depth);
        let is_deep = self.before.is_some_and(|before| depth > T::from_f64(DEPTH) * before);
        if is_near && index > 0 && is_deep && !self.is_cornered {
            return Verdict::Escape;
        }
        let is_minimum = index == 0 && !is_priced && !self.settings.is_straight;
        if is_minimum || is_near && (index == 0 || summary.negative <= FLAT) {
            return Verdict::Correct;
        }
        self.settings.curvature = self.mirrored();
        self.is_probed = true;
        if index == 0 && !is_priced && self.stiffer.iter().all(|entry| entry.is_finite()) {
            self.settings.weight = self.stiffer;
        }
        Verdict::Repeat
    }

    /// From now on the gap is only priced, at first as much as closing it costs; its first `motions` entries are those of configurations.
    pub fn price_gap(&mut self, motions: usize) {
        let [by_motion, by_momentum] = [true, false].map(|is_motion| {
            let chosen = (0..D).filter(|i| (*i < motions) == is_motion);
            chosen.fold(T::zero(), |max, i| larger(max, self.stiffer[(i, i)])) * T::from_ratio(1, 8)
        });
        self.settings.gap_price = Some(SVector::from_fn(|i, _| if i < motions { by_motion } else { by_momentum }));
        self.settings.weight = SMatrix::from_element(T::zero());
    }

    /// Whether a higher price of the gap would bring the end no nearer.
    pub fn is_in_vain(&self) -> bool {
        self.rounds >= ROUNDS || self.in_vain >= IN_VAIN
    }

    /// Raises the price of the gap after a plan that is critical for this one, and ends so far from the target.
    pub fn raise_price(&mut self, distance: T) {
        let is_nearer = self.missed.is_none_or(|missed| distance <= missed * T::from_ratio(99, 100));
        self.in_vain = if is_nearer { 0 } else { self.in_vain + 1 };
        self.missed = Some(distance);
        self.settings.gap_price = self.settings.gap_price.map(|price| price * T::from_f64(8.0));
        self.rounds += 1;
        self.begin_again();
    }

    /// From now on corrections close the gap: its price becomes a weight, and multipliers keep its force on the end, Eᵀ(ν − Re).
    pub fn close_gap(&mut self, force: SVector<T, D>, end: &PlanEnd<T, D>) {
        self.settings.weight = SMatrix::from_diagonal(&self.settings.gap_price.take().unwrap_or(SVector::zeros()));
        self.settings.multipliers = force + self.settings.weight * end.lack;
        self.begin_again();
    }

    /// Goes on with prices as they are now.
    #[cold]
    pub fn forget_prices(&mut self) {
        self.largest = T::zero();
        self.begin_again();
    }

    /// Goes on from a plan near a critical one, whose inputs move the end in so many directions. The exact model is tried first.
    pub fn go_on(&mut self, rank: usize) {
        self.rank = rank;
        self.settings.curvature = Curvature::exact(self.steadiness());
    }

    /// Nothing is known any more of the corrections before.
    fn begin_again(&mut self) {
        (self.before, self.calm, self.is_cornered, self.is_probed) = (None, 0, false, false);
        self.settings.curvature = self.mirrored();
    }

    /// Goes on from below a saddle, or stays at it.
    pub fn leave_saddle(&mut self, is_below: bool) {
        self.is_cornered = !is_below;
        if is_below {
            self.settings.curvature = self.mirrored();
            (self.before, self.calm, self.is_probed) = (None, 0, false);
        }
    }

    /// Whether a critical plan may be a saddle that can be left; the next sweep tells.
    pub fn may_be_at_saddle(&mut self, negative: usize, size: T) -> bool {
        let may_be = negative > 0 && !self.is_cornered && self.settings.curvature.is_mirrored;
        if may_be {
            self.settings.is_straight = false;
            self.damping = T::zero();
            self.before = Some(size);
            self.settings.curvature = Curvature::exact(self.steadiness());
        }
        may_be
    }

    /// Whether the exact model, tried after a small correction, promises more than all of the price: it is next to having no minimum.
    /// Its correction may lead to plans that are far dearer, so the next sweep goes without.
    pub fn leaps(&mut self, size: T) -> bool {
        let is_tried = self.before.is_some_and(|before| before <= T::from_ratio(TRIED.0, TRIED.1));
        let leaps = is_tried && !self.settings.curvature.is_mirrored && size > T::one();
        if leaps {
            self.settings.curvature = self.mirrored();
            self.is_probed = true;
        }
        leaps
    }

    /// Near a solution √ε, as a part of the price's curvature: else corrections go far where round-off alone bends the price, as along a symmetry.
    fn steadiness(&self) -> T {
        let seen = T::EPSILON.sqrt();
        self.before.filter(|before| *before * *before <= seen).map_or(T::zero(), |_| seen)
    }

    /// The curvature of the next sweep, so that it goes down.
    fn mirrored(&self) -> Curvature<T> {
        Curvature::mirrored(self.damping, self.steadiness())
    }

    /// From now on the curvature of steps is left out.
    fn straighten(&mut self) {
        self.settings.is_straight = true;
        self.straight = STRAIGHT;
    }

    /// Whether the gap is only priced.
    pub fn is_priced(&self) -> bool {
        self.settings.gap_price.is_some()
    }

    /// Whether the model is that of Newton's method.
    pub fn is_exact(&self) -> bool {
        self.damping == T::zero() && !self.settings.is_straight && !self.is_straightened
    }

    /// The decision after a sweep with a correction of this size; `unit` of it is round-off, and all of it where it has vanished.
    pub fn verdict(
        &mut self,
        end: &PlanEnd<T, D>,
        (size, unit, has_vanished): (T, T, bool),
        last_barrier: T,
    ) -> Verdict {
        let seen = T::EPSILON.sqrt();
        let stagnates = self.before.is_some_and(|before| before <= seen && size > before * T::from_ratio(1, 8));
        self.stagnations = if stagnates { self.stagnations + 1 } else { 0 };
        self.calm = if size <= seen && self.damping <= T::one() { self.calm + 1 } else { 0 };
        let is_decided = end.is_closed() || self.stagnations > 2 || !end.is_reached();
        let is_flat =
            size <= unit && (self.damping == T::zero() || has_vanished) || size <= seen && stagnates && self.is_exact();
        // Where not all of the curvature is counted, corrections shrink by and by.
        let patience = if self.is_exact() { CALM } else { 10 * CALM };
        let is_critical = is_flat && is_decided || self.calm > patience;
        if self.is_priced() {
            let is_low = size <= T::from_ratio(CRITICAL.0, CRITICAL.1);
            if is_critical || is_low { Verdict::Price } else { Verdict::Correct }
        } else if !is_critical {
            Verdict::Correct
        } else if !end.is_reached() {
            Verdict::Stir
        } else if self.settings.strictness.barrier > last_barrier + last_barrier {
            Verdict::Tighten
        } else {
            Verdict::Done
        }
    }

    /// The next barrier, if it is another.
    pub fn tighten(&mut self, bounds: T, price: T) {
        let barrier = &mut self.settings.strictness.barrier;
        let next = barrier::next(*barrier, bounds, price);
        if next < *barrier * T::from_ratio(9, 10) {
            *barrier = next;
            (self.before, self.calm, self.is_cornered) = (None, 0, false);
        }
    }

    /// Makes equations stiffer after a full correction of this size, for steps of this price. Where corrections hardly shrink, some multipliers
    /// move hardly anything, and creep. Equations are then stiffer than they may be at the end, for rounding of a is multiplied by ρ.
    pub fn harden(&mut self, price: T, size: T) {
        let is_near = |before: T| before <= T::from_ratio(NEAR.0, NEAR.1) && size > before * T::from_ratio(1, 8);
        let creeps = self.before.is_some_and(is_near) && !self.is_relieved;
        let Strictness { rigidity, price: of_step, .. } = &mut self.settings.strictness;
        let [rigid, most] = barrier::rigidities::<T>();
        let (harder, limit) = (*rigidity * T::from_f64(barrier::HARDER), if creeps { most } else { rigid });
        // a guess may have been dear, and is forgotten by and by
        *of_step = larger(*of_step * T::from_ratio(1, 8), price);
        if creeps && *rigidity >= most {
            // only rounding changes it now
            self.relieve();
        } else {
            *rigidity = larger(*rigidity, if harder < limit { harder } else { limit });
        }
    }

    /// Makes equations less stiff for the last digits of their multipliers; `false` where they are not too stiff for that.
    pub fn relieve(&mut self) -> bool {
        let [rigid, _] = barrier::rigidities::<T>();
        let is_stiffer = self.settings.strictness.rigidity > rigid;
        if is_stiffer {
            self.settings.strictness.rigidity = rigid;
            (self.is_relieved, self.before, self.calm, self.stagnations) = (true, None, 0, 0);
        }
        is_stiffer
    }

    /// Goes on after a sweep with so many pivots that are not positive. A fraction of its correction was made after
    /// some refusals, or none of it.
    pub fn advance(&mut self, made: Option<(T, usize)>, size: T, negative: usize, distance: T) {
        let is_far = size > T::from_ratio(NEAR.0, NEAR.1);
        let (fraction, refused) = made.unwrap_or((T::zero(), usize::MAX));
        // the weight of a priced gap is raised between critical plans
        if !self.is_priced() && (is_far || self.settings.weight.iter().all(|entry| *entry == T::zero())) {
            self.settings.weight = self.stiffer;
        }
        self.damping = adapted(self.damping, T::from_f64(LEAST_DAMPING), refused);
        self.before = Some(size);
        self.settings.curvature = self.mirrored();
        if size <= T::from_ratio(TRIED.0, TRIED.1) && refused <= 2 && !self.is_priced() {
            // the exact model may have its minimum here
            self.settings.curvature = Curvature::exact(self.steadiness());
            self.settings.is_straight = false;
        } else if self.is_mostly_straight {
            self.straighten();
        } else if self.settings.is_straight {
            self.straight = self.straight.saturating_sub(1);
            self.settings.is_straight = self.straight > 0;
        }
        let is_kept = self.is_priced() || self.rank == 0;
        self.is_probed &= is_far && is_kept || negative > 0 && !self.settings.is_straight;
        self.nearest = if distance < self.nearest { distance } else { self.nearest };
        self.stalls = if fraction < T::from_f64(1e-3) { self.stalls + 1 } else { 0 };
    }
}
