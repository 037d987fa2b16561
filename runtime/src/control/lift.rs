//! Multiple shooting: places are unknowns as inputs are, and steps leave gaps between them.
//!
//! The gap c_k is the small change that moves x_{k+1} to f(x_k, u_k). M_k is the derivative of this change where its end moves. A correction
//! closes all gaps to first order:
//! ```text
//! δ_{k+1} = c_k + M_k (A_k δ_k + B_k δu_k)
//! ```
//! The sweep has the value V(c + M(Aδ + Bδu)) of later steps. A plan that is far from its target bends over
//! all of its length, and a step only over its own. So these corrections lead on where a roll-out goes astray.
//!
//! A correction is made as far as a filter accepts it. The filter compares the sum of all gaps, and price with barriers. Neither needs a
//! weight against the other.
//!
//! Sources: Bock and Plitt, *A multiple shooting algorithm for direct solution of optimal control problems* (1984). Wächter and Biegler, *On
//! the implementation of an interior-point filter line-search algorithm* (2006), for the filter.

use super::attempt::Amplitudes;
use super::iterate::Iterate;
use super::search::Descent;
use super::slacks::{Proposed, Strictness};
use super::start::Start;
use super::sweep::{Plan, Problem, Swept};
use crate::newton::Curvature;
use crate::space::{larger, plus};
use crate::{Controlled, Error, Real};
use nalgebra::{SMatrix, SVector};

/// The most sweeps from one guess.
const SWEEPS: u32 = 60;
/// The first barrier, in units of that of roll-outs: a plan with gaps is further away.
const WIDER: f64 = 10.0;
/// The same for given places: bounds may be anywhere, and narrow slacks would leave next to nothing of corrections.
const WIDEST: f64 = 200.0;
/// The motions that bend a place to the target, one after the other.
const PARTS: usize = 8;
/// Fractions of corrections that are tried.
const TRIALS: usize = 10;
/// Corrections that are shorter than this part lead nowhere, after so many in a row.
const SHORT: (i64, i64) = (1, 20);
const PATIENCE: u32 = 2;
/// The part of gaps, or of price with barriers, that a correction has to gain.
const GAIN: f64 = 1e-5;
/// Gaps that are none, relative to the first correction.
const CLOSED: f64 = 1e-6;
/// The corrections and gaps from which a roll-out goes on.
const NEAR: (f64, f64) = (0.03, 1e-2);
/// Changes of places that are round-off, in units in the last place of their size.
const ROUNDING: f64 = 256.0;
/// Gaps that are wide, as the sum of all in units of the largest change of places.
const WIDE: f64 = 1.0;
/// Corrections and gaps for which the barrier is lowered.
const CENTRAL: (f64, f64) = (2.0, WIDE);

/// The gap between two steps.
pub(super) struct Gap<T, const D: usize> {
    /// c
    pub change: SVector<T, D>,
    /// M
    pub transport: SMatrix<T, D, D>,
}

impl<T: Real, const D: usize> Gap<T, D> {
    /// From a place to the one that the step before has `reached`.
    pub fn of<S, const U: usize, const C: usize>(system: &S, place: &S::Place, reached: &S::Place) -> Self
    where
        S: Controlled<D, U, C, Scalar = T>,
    {
        let mut transport = SMatrix::<T, D, D>::zeros();
        for (i, mut column) in transport.column_iter_mut().enumerate() {
            let unit = SVector::from_fn(|j, _| if i == j { T::one() } else { T::zero() });
            let velocity = system.infinitesimal_motion(reached, &unit);
            column.copy_from(&system.displacement(place, &plus(place, &velocity)));
        }
        Self { change: system.displacement(place, reached), transport }
    }
}

/// A plan that a correction proposes.
#[derive(Clone, Copy)]
struct Proposal<X, T> {
    last: X,
    /// The sum of all gaps, that to the target with them, the part to which bounds are relaxed, and the violations of equations.
    gaps: T,
    /// Σℓ + φ
    price: T,
    /// Σ ln s
    logarithms: T,
    /// The fraction of the correction that slacks allow, where it is smaller than the one that was made.
    allowed: Option<T>,
}

/// The places that gaps are between at first.
#[derive(Clone, Copy)]
enum Places {
    /// Those of a motion, bent to the target.
    Bent,
    /// Those of the caller.
    Given,
}

/// The measure of gaps.
struct Measure<T, const D: usize> {
    /// One by the largest change from the start to any place, for each component, 0 where nothing moves.
    units: SVector<T, D>,
    /// The part by which bounds are still relaxed: 1 at first, where they are.
    relaxed: T,
}

impl<T: Real, const D: usize> Measure<T, D> {
    /// The sum of the components of a gap, in units.
    fn of(&self, change: SVector<T, D>) -> T {
        change.component_mul(&self.units).iter().fold(T::zero(), |sum, part| sum + part.abs())
    }
}

/// The measure of gaps, and the plan that is gone on from.
type Begun<X, T, const D: usize> = (Measure<T, D>, Proposal<X, T>);

impl<X, T: Real> Proposal<X, T> {
    /// The gaps, and the price with barriers.
    fn measures(&self, barrier: T) -> (T, T) {
        (self.gaps, self.price - barrier * self.logarithms)
    }
}

/// The plans that later ones have to improve on, in gaps or in price.
struct Filter<T> {
    entries: [(T, T); 16],
    count: usize,
    /// The size of prices.
    magnitude: T,
}

impl<T: Real> Filter<T> {
    const fn new(zero: T) -> Self {
        Self { entries: [(zero, zero); 16], count: 0, magnitude: zero }
    }

    fn accepts(&self, gaps: T, price: T, now: (T, T)) -> bool {
        let gain = T::from_f64(GAIN);
        let improves = |&(before, dearer): &(T, T)| {
            gaps <= before * (T::one() - gain) || price <= dearer - gain * before * self.magnitude
        };
        improves(&now) && self.entries.iter().take(self.count).all(improves)
    }

    /// The oldest one is forgotten where there are too many.
    fn add(&mut self, plan: (T, T)) {
        let mut moved = plan;
        self.entries.iter_mut().for_each(|entry| core::mem::swap(entry, &mut moved));
        self.count = (self.count + 1).min(self.entries.len());
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, B: Start<S, D, U, C>, const D: usize, const U: usize, const C: usize>
    Plan<'_, S, B, D, U, C>
{
    /// Goes from the inputs that the stages hold, or a variation of them, to near a critical plan, with its multipliers. `false` where that
    /// fails. The stages then hold the inputs of the guess.
    pub fn lift(&mut self, variation: u32, amplitudes: &Amplitudes) -> bool {
        let lifted = self.vary(variation, amplitudes).and_then(|()| {
            self.follow()?;
            self.reach();
            self.close_and_land(Places::Bent)
        });
        let is_near = matches!(lifted, Ok(true));
        if !is_near {
            self.forget();
        }
        is_near
    }

    /// The same from the places that `path` gives, from x_1 to x_N, with the inputs that the stages hold. `false` where a step has an error.
    /// Where corrections get stuck, the plan goes on from there: it is where the caller wants it to be.
    pub fn lift_along(&mut self, mut path: impl FnMut(usize, T) -> S::Place) -> Result<bool, Error> {
        let Problem { system, .. } = self.problem;
        for index in 1..=self.stages.len() {
            let t = self.problem.time_after(index);
            let place = path(index, t);
            system.check_place(&place)?;
            let place = system.constrained_place(self.problem.constants, t, &place);
            match self.stages.get_mut(index) {
                Some(stage) => stage.place = place,
                None => self.last = place,
            }
        }
        let lifted = self.close_and_land(Places::Given);
        if lifted.is_err() {
            self.forget();
        }
        Ok(lifted.is_ok())
    }

    /// Closes the gaps between places, and rolls out. Returns whether corrections came near a critical plan.
    fn close_and_land(&mut self, places: Places) -> Result<bool, Error> {
        self.is_lifted = true;
        let closed = self.close(places);
        self.is_lifted = false;
        let is_near = closed?;
        self.landed_rank = self.landed_rank.filter(|_| is_near);
        self.land().map(|()| is_near)
    }

    /// Bends the places of a plan so that its end reaches the target, by and by.
    fn reach(&mut self) {
        let motion = self.end().motion;
        let steps = T::from_f64((PARTS * self.stages.len()) as f64);
        // small motions, one after the other: a large retraction need not go as far as the exponential
        let bent = |place: &S::Place, index: usize| {
            let part = motion * (T::from_f64(index as f64) / steps);
            let t = self.problem.time_after(index);
            // a given start is where it is
            let parts = if index == 0 { 0 } else { PARTS };
            (0..parts).fold(*place, |place, _| self.problem.moved(t, &place, &part))
        };
        for (index, stage) in self.stages.iter_mut().enumerate() {
            stage.place = bent(&stage.place, index);
        }
        self.last = bent(&self.last, self.stages.len());
    }

    /// Rolls out the inputs with the feedback of the last sweep, which keeps the plan near its places.
    fn land(&mut self) -> Result<(), Error> {
        let problem = &self.problem;
        let mut x = self.origin();
        for (index, stage) in self.stages.iter_mut().enumerate() {
            stage.input += stage.gain * problem.system.displacement(&stage.place, &x);
            stage.place = x;
            x = problem.follow(stage, problem.time_after(index), &x, &stage.input)?;
        }
        self.last = x;
        Ok(())
    }

    /// Closes gaps until a roll-out can go on; `false` where corrections get stuck far from a solution.
    fn close(&mut self, places: Places) -> Result<bool, Error> {
        let (zero, one) = (T::zero(), T::one());
        let end = self.end();
        let strictness = self.resume_or_relax()?;
        let mut now = Iterate::new(SVector::zeros(), strictness, end.distance);
        let (mut filter, mut at, mut measure, mut stuck) =
            (Filter::new(zero), None, Measure { units: SVector::zeros(), relaxed: zero }, 0);
        for _ in 0..SWEEPS {
            let Some(Swept { summary, end, gramian }) = self.sweep(&mut now)? else { continue };
            let descent = Descent { summary: &summary, end: &end, settings: now.settings, inverse: gramian.inverse() };
            let (change, decrement) = descent.correction(one);
            if now.settings.curvature.is_mirrored {
                now.rank = now.rank.max(gramian.rank());
            } else if !decrement.is_finite() || gramian.index(summary.negative, now.rank) > 0 {
                now.settings.curvature = Curvature::mirrored(zero, zero);
                continue;
            }
            if !decrement.is_finite() {
                return Ok(false);
            }
            let last_motion = self.make_linear(&change)?;
            let Some(before) = at else {
                // the first sweep is made without bounds, and tells the sizes of changes and of prices
                now.settings.weight = gramian.weight(&summary.gramian, &now.settings.weight);
                filter.magnitude = summary.magnitude + decrement.abs();
                let begun;
                (measure, begun) = match places {
                    Places::Bent => self.begin_lifted(&mut now, &last_motion, summary.repair())?,
                    Places::Given => {
                        let price = larger(summary.magnitude + decrement, summary.repair());
                        self.begin_where_it_is(&mut now, &last_motion, &change, price)?
                    }
                };
                at = Some(begun);
                continue;
            };
            now.largest = larger(now.largest, summary.magnitude);
            let magnitude = summary.magnitude + T::EPSILON.sqrt() * now.largest;
            let size = (decrement.abs() / magnitude).sqrt();
            let measures = before.measures(now.settings.strictness.barrier);
            let Some((fraction, proposal)) = self.try_parts(&last_motion, &filter, measures, (&now, &measure)) else {
                return Ok(false);
            };
            filter.add(measures);
            self.equate(&change, fraction, now.settings.strictness)?;
            self.accept(fraction, now.settings.strictness.barrier, proposal.last);
            measure.relaxed *= one - fraction;
            let is_another_end = self.add_multipliers(&mut now, &(change * fraction));
            self.landed_rank = if is_another_end { None } else { Some(now.rank) };
            at = Some(proposal);
            stuck = if fraction < T::from_ratio(SHORT.0, SHORT.1) { stuck + 1 } else { 0 };
            let is_below =
                |(of_size, of_gaps): (f64, f64)| size <= T::from_f64(of_size) && proposal.gaps <= T::from_f64(of_gaps);
            if stuck > PATIENCE {
                return Ok(is_below(NEAR));
            }
            if fraction >= one && is_below(NEAR) {
                return Ok(true);
            }
            if fraction >= T::from_ratio(9, 10) && is_below(CENTRAL) {
                if self.has_equations {
                    now.harden(magnitude / self.steps(), size);
                }
                // a bound of places curves with the motion: away from its central path, slacks allow next to nothing of a correction
                let barrier = now.settings.strictness.barrier;
                let most = T::from_ratio(1, 10) * barrier * self.bounds;
                if !summary.bounds_places || decrement <= most {
                    now.tighten(self.bounds, magnitude);
                }
                if now.settings.strictness.barrier < barrier {
                    filter.count = 0;
                }
            }
            now.settings.curvature = if size <= one { Curvature::exact(zero) } else { Curvature::mirrored(zero, zero) };
        }
        Ok(false)
    }

    /// Makes all of the first correction. Bounds are relaxed after it, as far as it violates them. The first barrier has the size of its
    /// price, as the guess may be far dearer. Returns the measure of gaps, and the plan.
    fn begin_lifted(
        &mut self,
        now: &mut Iterate<T, D>,
        last_motion: &SVector<T, D>,
        repair: T,
    ) -> Result<Begun<S::Place, T, D>, Error> {
        let zero = T::zero();
        let unmeasured = Measure { units: SVector::zeros(), relaxed: zero };
        let proposal = self.propose(T::one(), last_motion, &unmeasured)?;
        self.arrive_at(proposal.last);
        self.resume_or_relax()?;
        let price = larger(proposal.price.abs(), repair);
        now.largest = price;
        if self.is_bounded() {
            self.size_by_others();
            self.begin_bounds(now, if price > zero { price } else { T::one() }, WIDER);
        }
        let measure = self.measure();
        let begun = self.propose(zero, last_motion, &measure)?;
        Ok((measure, begun))
    }

    /// Begins with the first correction not made: it might lead through an obstacle that the given places avoid. Returns the measure of gaps,
    /// and the plan.
    fn begin_where_it_is(
        &mut self,
        now: &mut Iterate<T, D>,
        last_motion: &SVector<T, D>,
        change: &SVector<T, D>,
        price: T,
    ) -> Result<Begun<S::Place, T, D>, Error> {
        let zero = T::zero();
        let price = if price > zero { price } else { T::one() };
        now.largest = price;
        if self.is_bounded() {
            self.size(change)?;
            self.begin_bounds(now, price, WIDEST);
        }
        let measure = self.measure();
        let begun = self.propose(zero, last_motion, &measure)?;
        Ok((measure, begun))
    }

    /// The first fraction of the correction that the filter accepts, with its plan.
    fn try_parts(
        &mut self,
        last_motion: &SVector<T, D>,
        filter: &Filter<T>,
        measures: (T, T),
        (now, measure): (&Iterate<T, D>, &Measure<T, D>),
    ) -> Option<(T, Proposal<S::Place, T>)> {
        let mut fraction = T::one();
        for _ in 0..TRIALS {
            if let Ok(proposal) = self.propose(fraction, last_motion, measure) {
                if let Some(allowed) = proposal.allowed {
                    fraction = larger(allowed * T::from_ratio(99, 100), fraction * T::from_f64(1e-3));
                    continue;
                }
                let (gaps, price) = proposal.measures(now.settings.strictness.barrier);
                // wide gaps may not grow, whatever the price: it takes many corrections to close them again
                let is_wider = gaps > larger(measures.0, T::from_f64(WIDE));
                let is_closed = gaps <= T::from_f64(CLOSED);
                let is_better = is_closed || !is_wider && filter.accepts(gaps, price, measures);
                if gaps.is_finite() && price.is_finite() && is_better {
                    return Some((fraction, proposal));
                }
            }
            fraction *= T::from_ratio(1, 2);
        }
        None
    }

    /// The correction to first order: the motions δ_k and the changes δu_k of the stages. Returns δ_N.
    ///
    /// The effect of both on the next place is a difference quotient. A step costs less than its derivatives, and a correction is judged by
    /// its plan, so that its last digits do not matter.
    fn make_linear(&mut self, change: &SVector<T, D>) -> Result<SVector<T, D>, Error> {
        let problem = &self.problem;
        let system = problem.system;
        let part = T::EPSILON.sqrt();
        let mut motion = B::change(&self.correction, change).unwrap_or(SVector::from_element(T::zero()));
        let mut stages = self.stages.iter_mut().enumerate().peekable();
        while let Some((index, stage)) = stages.next() {
            let t = problem.time_after(index);
            let input = stage.shift + stage.by_multiplier * change + stage.gain * motion;
            (stage.motion, stage.shift) = (motion, input);
            let following = stages.peek().map_or(self.last, |(_, next)| next.place);
            let reached = problem.follow(stage, t, &stage.place, &stage.input)?;
            let x = system.moved(&stage.place, &(motion * part));
            let moved = problem.follow(stage, t, &x, &(stage.input + input * part))?;
            let gap: SVector<T, D> = system.displacement(&following, &reached);
            motion = gap + (system.displacement(&following, &moved) - gap) / part;
        }
        Ok(motion)
    }

    /// The measure of gaps between the places of this plan.
    fn measure(&self) -> Measure<T, D> {
        let Problem { system, .. } = self.problem;
        let start = self.origin();
        let places = self.stages.iter().map(|stage| &stage.place).chain([&self.last]);
        let largest = places.fold(SVector::<T, D>::zeros(), |largest, place| {
            let change = system.displacement(&start, place);
            SVector::from_fn(|i, _| larger(largest[i], change[i].abs()))
        });
        let (zero, one) = (T::zero(), T::one());
        // forbidden changes are round-off, and one by that would outweigh all others
        let size_of = |x: &S::Place| self.problem.size(x);
        let size = self.stages.iter().fold(size_of(&self.last), |size, stage| larger(size, size_of(&stage.place)));
        let least = if S::IS_CONSTRAINED { T::from_f64(ROUNDING) * T::EPSILON * size } else { zero };
        let is_change = |i: usize| largest[i] * self.problem.lengths[i] > least && largest[i].is_finite();
        let units = SVector::from_fn(|i, _| if is_change(i) { largest[i].recip() } else { zero });
        Measure { units, relaxed: if self.is_relaxed() { one } else { zero } }
    }

    /// The plan after a part of the correction.
    fn propose(
        &mut self,
        fraction: T,
        last_motion: &SVector<T, D>,
        measure: &Measure<T, D>,
    ) -> Result<Proposal<S::Place, T>, Error> {
        let problem = &self.problem;
        let Problem { system, constants, .. } = *problem;
        let zero = T::zero();
        let (mut price, mut logarithms, mut gaps, mut slacks) = (zero, zero, zero, Proposed::none());
        let free = Strictness::none();
        let mut reached: Option<S::Place> = None;
        for (index, stage) in self.stages.iter_mut().enumerate() {
            let t = self.problem.time_after(index);
            let change = stage.motion * fraction;
            let x = match index {
                0 => system.moved(&stage.place, &change),
                _ => problem.moved(t, &stage.place, &change),
            };
            let input = stage.input + stage.shift * fraction;
            if let Some(reached) = &reached {
                gaps += measure.of(system.displacement(&x, reached));
            }
            if C > 0 {
                let bounds = problem.bounds(stage, t, &x, &input)?;
                stage.limits.propose(&bounds, (fraction, free, false), |i| S::BOUNDS[i], &mut slacks)?;
                logarithms += stage.limits.logarithms();
            }
            if index == 0 {
                price += problem.beginning.price(system, &x);
            }
            price += problem.price(stage, t, &x, &input)?;
            reached = Some(problem.follow(stage, t, &x, &input)?);
            (stage.next_place, stage.next_input) = (x, input);
        }
        let last = problem.moved(problem.end_time(), &self.last, &(last_motion * fraction));
        if let Some(reached) = &reached {
            gaps += measure.of(system.displacement(&last, reached));
        }
        gaps += measure.of(self.problem.end(&last, zero, &self.pushing).motion);
        price += system.endpoint(constants, problem.end_time(), &last);
        Ok(Proposal {
            last,
            gaps: gaps + measure.relaxed * (T::one() - fraction) + slacks.unequal,
            price: price + slacks.soft,
            logarithms,
            allowed: slacks.allowed,
        })
    }
}
