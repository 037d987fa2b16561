//! Newton's method on a plan, and the fallback if it does not contract.

use super::attempt::Amplitudes;
use super::end::PlanEnd;
use super::iterate::{Iterate, Verdict};
use super::search::Descent;
use super::start::Start;
use super::sweep::{Plan, PlanSummary, Problem, Settings, Swept, Way};
use super::{Ended, Optimum, Target, barrier};
use crate::newton::Curvature;
use crate::parameters::check_finite;
use crate::space::larger;
use crate::{Controlled, Error, Real, Space};
use nalgebra::{SMatrix, SVector};

/// The most backward sweeps of one attempt.
const SWEEPS: u32 = 400;
/// Damping beyond which no step goes downhill but for round-off.
const DAMPING_LIMIT: f64 = 1e9;
/// Patterns that are added to inputs where no first derivative leads to the target.
const STIRS: u32 = 3;
/// How many times dearer than its plan a correction may be, where the model of the guess could not reach the target. Dearer ones do not
/// bend the plan but turn it over and over.
const DEAR: f64 = 1e4;
/// Steps in a row that may be next to nothing.
const STALLS: u32 = 8;
/// Newton decrements that are this part of all barriers, after which they are lowered twice.
const SETTLED: f64 = 0.01;
/// Critical plans that may violate equations, before these contradict each other.
const UNMET: u32 = 8;

/// Whether a decrease of the price by so much is round-off of places and inputs, for the span of a price that is round-off itself.
fn is_below_round_off<T: Real>(decrement: T, span: T) -> bool {
    let part = T::from_f64(64.0) * T::EPSILON;
    span > T::zero() && decrement.abs() <= part * part * span
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, B: Start<S, D, U, C>, const D: usize, const U: usize, const C: usize>
    Plan<'_, S, B, D, U, C>
{
    /// The critical plan near the guess, a minimum where one is found, after at most [`SWEEPS`] more sweeps; its stages are not in it yet.
    /// Corrections close the gap to the target; where `is_priced`, it is priced, and closed where little of it is left.
    pub fn newton<'p>(&mut self, is_priced: bool) -> Result<Optimum<'p, S, D, U, C>, Error> {
        let zero = T::zero();
        let steps = T::from_f64(self.stages.len() as f64);
        // The size of a correction that is round-off. Slacks of active bounds have few digits.
        let exact = T::from_f64(4.0) * T::EPSILON * steps.sqrt();
        let mut now = self.start(is_priced)?;
        let (mut size, mut stirs, mut unmet, mut has_corrected) = (zero, 0, 0, false);
        for _ in 0..SWEEPS {
            if self.sweeps >= self.most && (has_corrected || self.most == 0) {
                return self.interrupted(&now, Ended::AtLimit);
            }
            let Some(Swept { summary, end, gramian }) = self.sweep(&mut now)? else { continue };
            let descent = Descent { summary: &summary, end: &end, settings: now.settings, inverse: gramian.inverse() };
            let (change, decrement) = descent.correction(T::one());
            check_finite("the price of the plan", &summary.price)?;
            let verdict = now.judge(&summary, &gramian);
            if verdict == Verdict::Repeat {
                continue;
            }
            if !decrement.is_finite() {
                return Err(self.failure(&end, size));
            }
            now.largest = larger(now.largest, summary.magnitude + decrement.abs());
            // the size of prices, for a price that vanishes at the solution a small part of the largest
            let magnitude = summary.magnitude + T::EPSILON.sqrt() * now.largest;
            // That of barriers, whose last one is a part of the price. A guess may have made the largest one dear by many orders.
            let size_of_price = summary.magnitude + T::EPSILON * now.largest;
            if verdict == Verdict::Escape {
                now.leave_saddle(self.escape(&descent, magnitude));
                has_corrected = true;
                continue;
            }
            if now.is_open {
                if self.way == Way::Open && self.is_bounded() && descent.reaches() {
                    // where a motion without bounds goes astray, one within them seldom leads on
                    let is_astray = |end: PlanEnd<T, D>| self.is_astray(&end, &descent, T::one());
                    if self.end_without_bounds(&change).map_or(true, is_astray) {
                        self.way = Way::Given(Amplitudes::FAR);
                        return Err(self.failure(&end, size));
                    }
                }
                let price = larger(summary.magnitude + decrement, summary.repair());
                self.open(&mut now, is_priced, price, &change)?;
                continue;
            }
            let bounds = self.bounds;
            let unit = if self.is_bounded() { T::EPSILON.powf(T::from_ratio(3, 5)) } else { exact };
            let span = self.span(&summary)?;
            let has_vanished = is_below_round_off(decrement, span);
            size = if decrement == zero || has_vanished { zero } else { (decrement.abs() / magnitude).sqrt() };
            if now.leaps(size) {
                continue;
            }
            match now.verdict(&end, (size, unit, has_vanished), barrier::last(bounds, size_of_price)) {
                Verdict::Done | Verdict::Tighten
                    if now.may_be_at_saddle(summary.negative + summary.straightened, size) =>
                {
                    continue;
                }
                Verdict::Done if now.relieve() => continue,
                // Nothing pushes, but bounds are still violated.
                Verdict::Done if self.is_violated() => {
                    unmet += 1;
                    if self.has_equations && unmet > UNMET {
                        return Err(self.infeasible(Some(zero)).unwrap_or(self.failure(&end, size)));
                    }
                }
                Verdict::Done => {
                    self.settle(&change, now.settings.strictness)?;
                    // Where inputs need no correction, the multipliers may.
                    now.settings.multipliers += change;
                    let found = self.finish(&now);
                    let is_lenient = T::EPSILON.sqrt() * now.largest > summary.magnitude;
                    if is_lenient && matches!(found, Err(Error::NotStationary { .. })) {
                        // a price that the guess had made so large that corrections seemed to be round-off
                        now.forget_prices();
                        self.begin(now.settings.strictness.barrier);
                        continue;
                    }
                    return found;
                }
                Verdict::Tighten => {
                    now.tighten(bounds, size_of_price);
                    continue;
                }
                Verdict::Price if self.is_relaxed() => {}
                Verdict::Price if end.distance <= T::from_ratio(1, 100) * end.scale => {
                    now.close_gap(self.multipliers(&end, &summary.costate), &end);
                    self.push(&mut now.settings.multipliers);
                    continue;
                }
                Verdict::Price if !now.is_in_vain() => {
                    now.raise_price(end.distance);
                    continue;
                }
                Verdict::Price => return Err(self.failure(&end, size)),
                Verdict::Stir if stirs == STIRS => {
                    return Err(Error::Uncontrollable { distance: end.gap.to_f64() });
                }
                Verdict::Stir => {
                    stirs += 1;
                    self.way = Way::Kept;
                    self.stir(&summary, end.lack.max_abs(), stirs, &Amplitudes::NEAR);
                    if self.has_equations {
                        // soft again, for another motion
                        self.stages.iter_mut().for_each(|stage| stage.limits.forget());
                    }
                    now = self.start(false)?;
                    continue;
                }
                Verdict::Correct | Verdict::Escape | Verdict::Repeat => {}
            }
            let is_trusted = (now.is_exact() || span > zero) && size * size <= T::EPSILON.sqrt();
            let made = self.descend(&mut now, &descent, magnitude, is_trusted);
            if self.way == Way::Open && descent.reaches() {
                // after the first correction the guess could not reach the target: only its new motion can
                let is_dear = has_corrected && !end.is_reached() && decrement > summary.magnitude * T::from_f64(DEAR);
                if is_dear || self.is_astray(&self.end(), &descent, now.closes) {
                    self.way = Way::Given(if has_corrected { Amplitudes::NEAR } else { Amplitudes::FAR });
                    return Err(self.failure(&end, size));
                }
                self.way = Way::Kept;
            }
            has_corrected = true;
            let is_whole = made.is_some_and(|(fraction, _)| fraction >= T::from_ratio(9, 10));
            if is_whole && self.has_equations {
                now.harden(size_of_price / steps, size);
            }
            now.advance(made, size, summary.negative, end.distance);
            if now.stalls == STALLS || now.damping > T::from_f64(DAMPING_LIMIT) {
                return Err(self.failure(&end, size));
            }
            // A bound of places curves with the motion: away from its central path, slacks allow next to nothing of a correction.
            let part = if summary.bounds_places { T::from_ratio(1, 10) } else { T::from_f64(10.0) };
            let is_central = decrement <= part * now.settings.strictness.barrier * bounds;
            if bounds > zero && is_whole && is_central && !now.is_priced() {
                // next to it the barrier is lowered twice, but where bounds curve
                let is_next_to_it = !summary.bounds_places
                    && decrement <= T::from_f64(SETTLED) * now.settings.strictness.barrier * bounds;
                (0..=usize::from(is_next_to_it)).for_each(|_| now.tighten(bounds, size_of_price));
            }
        }
        let end = self.end();
        Err(self.failure(&end, size))
    }

    /// The plan that the inputs make, with the multipliers that the stages hold.
    pub fn start(&mut self, is_priced: bool) -> Result<Iterate<T, D>, Error> {
        let (landed_rank, pushing) = (self.landed_rank.take(), self.pushing);
        self.follow()?;
        let costate = self.stages.last().map(|stage| stage.next_costate);
        let costate = costate.filter(|costate| costate.all_finite() && costate.max_abs() > T::zero());
        if costate.is_some() {
            self.push_near();
        }
        let mut multipliers = costate.map_or(SVector::zeros(), |costate| self.multipliers(&self.end(), &costate));
        self.push(&mut multipliers);
        let strictness = self.resume_or_relax()?;
        let distance = self.end().distance;
        check_finite("the target at the end of the guessed plan", &distance)?;
        let mut now = Iterate::new(multipliers, strictness, distance);
        now.is_open |= is_priced;
        if let Some(rank) = landed_rank.filter(|_| self.pushing == pushing) {
            now.go_on(rank);
        }
        Ok(now)
    }

    /// Begins with bounds, or with a price of the gap, after the first sweep, which was made without and told the size of prices.
    fn open(
        &mut self,
        now: &mut Iterate<T, D>,
        is_priced: bool,
        price: T,
        change: &SVector<T, D>,
    ) -> Result<(), Error> {
        now.is_open = false;
        now.settings.weight = now.stiffer;
        if self.is_bounded() {
            let price = if self.has_kinks() { larger(price, self.price_of_kinks(change)?) } else { price };
            self.size(change)?;
            // If neither plans nor the inputs that satisfy bounds have a price, any is as good.
            let is_free = price <= T::zero() && self.is_violated();
            let price = if is_free { T::one() } else { price };
            now.largest = larger(now.largest, price);
            self.begin_bounds(now, price, 1.0);
        }
        if is_priced {
            // equations have one price, those of places one for motions and one for momenta
            now.settings.multipliers.fill(T::zero());
            self.push(&mut now.settings.multipliers);
            now.price_gap(if matches!(self.problem.target, Target::Conditions) { D } else { S::MOTIONS });
        }
        Ok(())
    }

    /// The multipliers ν of the target, for an end with E. Eᵀν is nearest to this costate less the price of the end.
    pub fn multipliers(&self, end: &PlanEnd<T, D>, costate: &SVector<T, D>) -> SVector<T, D> {
        let Problem { system, lengths, .. } = &self.problem;
        let slope = system.endpoint_expanded(self.problem.constants, self.problem.end_time(), &self.last).slope;
        let covector: SVector<T, D> = costate - slope;
        if matches!(self.problem.target, Target::Conditions) {
            let metric = end.slope * end.slope.transpose();
            return end.gramian(&metric).inverse() * (end.slope * covector);
        }
        SMatrix::<T, D, D>::from_fn(|i, j| end.slope[(i, j)] / lengths[j]) * covector.component_div(lengths)
    }

    /// The end of a plan; round-off of its gap is relative to the largest place.
    pub fn end(&self) -> PlanEnd<T, D> {
        let largest = self.stages.iter().fold(T::zero(), |max, stage| larger(max, self.problem.size(&stage.place)));
        self.problem.end(&self.last, largest, &self.pushing)
    }

    /// The critical plan, after a last sweep that proves it.
    fn finish<'p>(&mut self, now: &Iterate<T, D>) -> Result<Optimum<'p, S, D, U, C>, Error> {
        let summary = self.last_sweep(now)?;
        // Near a singularity curvatures are so large that no residual needs a correction. Written so that NaN is an error.
        let unit = T::EPSILON.sqrt();
        let inputs = self.stages.iter().fold(T::zero(), |largest, stage| larger(largest, stage.input.max_abs()));
        // All terms are small where a plan stays at rest. There the slope may change the price by a small part, over
        // inputs of their own size.
        let is_slight = inputs > T::zero() && summary.residual * inputs <= unit * summary.magnitude;
        let is_stationary = summary.residual.is_finite() && (summary.residual <= unit * summary.terms || is_slight);
        // Without a price only the barrier is left in a slope, and that is round-off.
        let is_free = summary.magnitude == T::zero();
        if !is_stationary && !is_free && !is_below_round_off(self.decrement(&summary), self.span(&summary)?) {
            let (residual, momentum) = (summary.residual.to_f64(), summary.terms.to_f64());
            return Err(Error::NotStationary { residual, momentum });
        }
        Ok(self.reached(now, &summary, Ended::Converged))
    }

    /// Twice the decrease of the model by a correction, after a last sweep.
    #[cold]
    fn decrement(&self, summary: &PlanSummary<T, D, U>) -> T {
        let change = self.end().gramian(&summary.gramian).inverse() * summary.lack;
        summary.descent + change.dot(&summary.lack)
    }

    /// The plan as it is where a search ends before, with the gains of a last sweep.
    #[cold]
    pub fn interrupted<'p>(&mut self, now: &Iterate<T, D>, ended: Ended) -> Result<Optimum<'p, S, D, U, C>, Error> {
        let summary = self.last_sweep(now)?;
        check_finite("the price of the plan", &summary.price)?;
        Ok(self.reached(now, &summary, ended))
    }

    /// The last sweep: exact second derivatives as they are, for gains and the index.
    fn last_sweep(&mut self, now: &Iterate<T, D>) -> Result<PlanSummary<T, D, U>, Error> {
        let settings =
            Settings { curvature: Curvature::exact(T::zero()), is_straight: false, is_last: true, ..now.settings };
        // The weight of the target belongs to the search: costates are those of the multipliers alone.
        let closed = PlanEnd { lack: SVector::zeros(), ..self.end() };
        self.eliminate(&closed, &settings)
    }

    fn reached<'p>(
        &self,
        now: &Iterate<T, D>,
        summary: &PlanSummary<T, D, U>,
        ended: Ended,
    ) -> Optimum<'p, S, D, U, C> {
        let end = self.end();
        Optimum {
            stages: &[],
            ended,
            step_size: self.problem.h,
            price: summary.price + self.price_of_violations(),
            residual: summary.residual,
            gap: end.gap,
            violation: self.violation(),
            negative: end.gramian(&summary.gramian).index(summary.negative, now.rank),
            iterations: self.sweeps,
            end: self.last,
            final_costate: summary.costate,
        }
    }

    /// Whether an end is still more than half as far from the target as before the correction, and not where the model leads. The correction
    /// closes this part of the gap by its model. Where bounds alone have made it short, the end is where the model leads.
    fn is_astray(&self, end: &PlanEnd<T, D>, descent: &Descent<'_, T, D, U>, closes: T) -> bool {
        let before = descent.end;
        let missed: SVector<T, D> = end.lack - before.lack * (T::one() - closes);
        // conditions leave a part of the place free, and a roll-out finds that part by and by
        let is_declared = matches!(self.problem.target, Target::Conditions);
        let part = if is_declared { T::from_ratio(9, 10) } else { T::from_ratio(1, 2) };
        let is_nearer = end.distance <= before.distance * part;
        let is_as_modelled = missed.max_abs() <= before.lack.max_abs() * T::from_ratio(1, 100);
        !before.is_reached() && !is_nearer && !is_as_modelled
    }

    /// The bound that no plan satisfies. Equations count that are violated by more than this part of their size.
    #[cold]
    fn infeasible(&self, least: Option<T>) -> Option<Error> {
        let (stage, bound, violation) = self.worst_bound(least)?;
        Some(Error::Infeasible { bound, stage, violation: violation.to_f64() })
    }

    /// Why nothing was found.
    #[cold]
    fn failure(&self, end: &PlanEnd<T, D>, size: T) -> Error {
        let iterations = self.sweeps;
        // where the target is reached, equations may have stopped the search
        match self.infeasible(end.is_reached().then_some(T::EPSILON.sqrt())) {
            Some(error) => error,
            None if !end.is_reached() => Error::TargetMissed { distance: end.gap.to_f64(), iterations },
            None => Error::NoExtremal { correction: size.to_f64(), iterations },
        }
    }
}
