//! Newton's method on a path, and the fallback if it does not contract.

use super::guess::Guess;
use super::sweep::Search;
use super::vertex::PathSummary;
use crate::newton::{Curvature, adapted};
use crate::space::larger;
use crate::{Differentiated, Error, Real, Space, Variational};

/// The most backward sweeps of one solution.
const SWEEPS: u32 = 200;
/// Halvings of a step that makes the action larger.
const HALVINGS: usize = 6;
/// Units in the last place that rounding leaves of a residual, but for large terms that cancel.
const ROUNDING: f64 = 1024.0;
/// Damping beyond which no step goes downhill but for round-off.
const DAMPING_LIMIT: f64 = 1e12;

impl<T: Real, const M: usize> PathSummary<T, M> {
    /// Whether the correction takes so little from the action, √ε of it, that the action tells no more how good it was.
    fn is_near(&self) -> bool {
        self.size * self.size <= T::EPSILON.sqrt()
    }

    /// Whether the next correction is half of this one at most. Written so that NaN is none.
    fn is_halved_by(&self, next: &Self) -> bool {
        next.size <= T::from_ratio(1, 2) * self.size
    }

    /// Whether no correction is left. It is round-off, and so is the residual, or the last correction made it no smaller.
    /// Or it is below √ε, and the residual is round-off. The residual counts where extremals are not isolated, as
    /// between opposite points of a sphere: there corrections go astray. A large action hides residuals, as from an
    /// offset of the potential. Rounding of large terms that cancel may leave more of a residual. Then corrections
    /// shrink no more although steadied.
    #[inline]
    fn has_converged(&self, before: Option<&Self>, is_closed: bool, curvature: Curvature<T>) -> bool {
        let seen = T::EPSILON.sqrt();
        let is_stationary = |units| is_closed && self.is_stationary(units);
        let is_steadied = curvature == Curvature::exact(seen);
        let is_settled = || before.is_some_and(|before| !before.is_halved_by(self));
        self.size <= self.round_off() && (self.is_stationary(ROUNDING) || self.size == T::zero() || is_settled())
            || self.size <= seen
                && match before.filter(|before| is_steadied && before.size <= seen) {
                    Some(before) => !before.is_halved_by(self) || is_stationary(ROUNDING),
                    None => is_stationary(16.0),
                }
    }

    /// Whether the next correction is expected to be round-off. This is so below √ε, if each correction is as the
    /// square of the one before.
    #[inline]
    fn is_last(&self, before: Option<&Self>) -> bool {
        let contraction = |before: &Self| self.size / before.size;
        self.size <= T::EPSILON.sqrt()
            && before.is_some_and(|before| self.size * contraction(before) * contraction(before) <= T::EPSILON)
    }

    /// The error where momenta do not agree at a vertex.
    #[cold]
    fn jump(&self) -> Error {
        let momentum = (self.momenta / self.edges).sqrt();
        Error::NotStationary { residual: self.residual_squared.sqrt().to_f64(), momentum: momentum.to_f64() }
    }

    /// Whether a full step is made next. Comparisons are written so that NaN is none.
    #[inline]
    fn is_progress(&self, before: Option<&Self>, any_index: bool, curvature: Curvature<T>) -> bool {
        if self.negative > 0 && !any_index {
            return false;
        }
        match before {
            // One that is larger than the path leads to another extremal than that near the guess.
            None if any_index && curvature == Curvature::exact(T::zero()) => self.size <= T::one(),
            None => self.size.is_finite(),
            Some(before) => {
                let is_lower = || self.negative == 0 && before.is_lower(self.action, T::one());
                before.is_halved_by(self) || (!before.is_near() && is_lower())
            }
        }
    }

    /// Armijo's rule for the action after a step of this fraction: it fell by at least a hundredth of the amount that
    /// the slope promises.
    fn is_lower(&self, action: T, fraction: T) -> bool {
        let promised = self.decrement * fraction * T::from_ratio(1, 100);
        (action - self.action) * self.sign <= -(promised * self.sign)
    }
}

impl<T: Real, S: Variational<M, Scalar = T>, B: Differentiated<S, M>, const M: usize> Search<'_, S, M, B> {
    /// The critical point of the action near the guess, and the number of sweeps. Full Newton steps are made as long as
    /// each at least halves the correction or makes the action smaller. Otherwise the last one is taken back and the
    /// gap is closed. Near an extremal such steps go on from there with a steadied Hessian. Where extremals are a
    /// family, as between opposite points of a sphere, the Hessian is singular along the family. Elsewhere, or where
    /// that fails too, the action is made smaller. The Hessian is then definite, and steps are halved (Armijo's rule).
    /// If that happens often, the Hessian is damped. Corrections are measured in the norm of the Hessian relative to
    /// the action, which no choice of units changes.
    ///
    /// Near a singularity of the potential the Hessian is so large that no residual needs a correction. So the residual
    /// of the answer is compared with its own round-off.
    #[inline]
    pub fn newton(&mut self, guess: &Guess<T, M>) -> Result<(PathSummary<T, M>, u32), Error> {
        let (found, sweeps) = self.converge(guess)?;
        let half = T::EPSILON.sqrt().recip().to_f64();
        let is_stationary = found.residual_squared.is_finite() && found.is_stationary(half);
        if is_stationary || self.is_at_rest(&found) { Ok((found, sweeps)) } else { Err(found.jump()) }
    }

    /// The same without a look at the residual.
    #[inline]
    fn converge(&mut self, guess: &Guess<T, M>) -> Result<(PathSummary<T, M>, u32), Error> {
        self.prepare(guess)?;
        // A minimum is looked for where this is false.
        let mut any_index = *guess != Guess::Geodesic;
        let zero = T::zero();
        let seen = T::EPSILON.sqrt();
        let exact = Curvature::exact(zero);
        let mut before: Option<PathSummary<T, M>> = None;
        let mut curvature = exact;
        let mut size = zero;
        for sweeps in 1..=SWEEPS {
            let gap = self.end();
            let summary = self.eliminate(&gap, curvature);
            size = summary.size;
            if !summary.action.is_finite() && (sweeps == 1 || curvature.is_mirrored) {
                return Err(Error::NotFinite { name: "the action of the path" });
            }
            let is_damped = curvature.damping > zero;
            let is_closed = gap.is_closed() || gap.is_orthogonal();
            if !is_damped && summary.has_converged(before.as_ref(), is_closed, curvature) {
                return if gap.is_reached() { Ok((summary, sweeps)) } else { Err(gap.unreachable()) };
            }
            if curvature.is_mirrored && !is_damped && summary.negative > 0 && size <= seen {
                // By symmetry no gradient leads away from this saddle, and the action has no digits left to go by.
                (curvature, any_index, before) = (exact, true, None);
                continue;
            }
            // A small correction that the next one does not halve has gone where the action does not bend, or is round-off.
            let is_astray = before.is_some_and(|before| before.is_near() && !before.is_halved_by(&summary));
            if curvature.is_mirrored && !is_astray {
                let halvings = self.descend(&summary);
                if halvings.is_none() && curvature.damping > T::from_f64(DAMPING_LIMIT) {
                    return Err(Error::NoExtremal { correction: size.to_f64(), iterations: sweeps });
                }
                curvature.damping = adapted(curvature.damping, T::from_ratio(1, 8), halvings.unwrap_or(HALVINGS));
                before = halvings.map(|_| summary);
            } else if summary.is_progress(before.as_ref(), any_index, curvature) {
                self.correct(T::one());
                if summary.is_last(before.as_ref()) {
                    let gap = self.end();
                    let found = self.measure(&gap, &summary);
                    let is_closed = gap.along <= found.round_off() * gap.scale && gap.is_reached();
                    if is_closed && found.is_stationary(16.0) {
                        return Ok((found, sweeps));
                    }
                }
                before = Some(summary);
            } else {
                // A correction that is small relative to the path was to lead to an extremal near it.
                let is_small = before.is_some_and(|before| before.size <= T::from_ratio(1, 8));
                if before.take().is_some() {
                    self.take_back();
                }
                self.close(zero);
                let is_near_any = curvature == exact && (any_index && is_small || is_astray);
                let steadied = curvature.is_mirrored || is_near_any;
                curvature = if steadied { Curvature::exact(seen) } else { Curvature::mirrored(zero, zero) };
            }
        }
        Err(Error::NoExtremal { correction: size.to_f64(), iterations: SWEEPS })
    }

    /// Whether round-off of configurations explains the residual, as for a path at rest. That is ε of the largest entry
    /// times the least stiffness of an edge. The stiffness near a singularity does not count.
    #[cold]
    #[inline(never)]
    fn is_at_rest(&self, found: &PathSummary<T, M>) -> bool {
        let mut next = &self.last;
        let (mut least, mut scale) = (None, next.max_abs());
        for (index, node) in self.path.iter().enumerate().rev() {
            let stiffness = self.problem.edge(index, node, next).after_by_end.trace().abs();
            least = least.filter(|least| *least <= stiffness).or(Some(stiffness));
            next = &node.configuration;
            scale = larger(scale, next.max_abs());
        }
        let unit = T::from_f64(ROUNDING) * T::EPSILON * scale * least.unwrap_or(T::zero());
        found.residual_squared <= unit * unit && found.residual_squared.is_finite()
    }

    /// Makes a step that makes the action smaller, or a full one where the action has no digits left. Returns how often it was halved, if it was made.
    #[cold]
    fn descend(&mut self, summary: &PathSummary<T, M>) -> Option<usize> {
        let is_trusted = summary.is_near() && summary.negative == 0;
        let mut fraction = T::one();
        for halvings in 0..HALVINGS {
            if is_trusted || summary.is_lower(self.action_after(fraction), fraction) {
                self.correct(fraction);
                return Some(halvings);
            }
            fraction *= T::from_ratio(1, 2);
        }
        None
    }
}
