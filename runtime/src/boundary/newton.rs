//! Newton's method on a path, and what is done where it does not contract.

use super::Node;
use super::end::PathEnd;
use super::sweep::Endpoints;
use super::vertex::PathSummary;
use crate::newton::{Curvature, Share, adapted};
use crate::{Error, Real, Scalar, Variational};
use num_traits::{One, Zero};

/// Backward sweeps of which one solution may make use.
const SWEEPS: u32 = 200;
/// Halvings of a step that makes the action larger.
const HALVINGS: usize = 6;
/// Damping beyond which no step goes downhill but for round-off.
const DAMPING_LIMIT: f64 = 1e12;

/// A path on which the action is critical.
pub(super) struct CriticalPath<S: Variational<M, Scalar: Real>, const M: usize> {
    pub summary: PathSummary<S::Scalar, M>,
    pub end: S::Configuration,
    pub sweeps: u32,
}

/// What the sweep before told.
struct Progress<T> {
    size: T,
    action: T,
    decrement: T,
}

impl<T: Real> Progress<T> {
    /// Whether the correction takes so little from the action, √ε of it, that the action tells no more how good it was.
    fn is_near(&self) -> bool {
        self.size * self.size <= T::EPSILON.sqrt()
    }

    /// Whether the correction is so small beside the path that an extremal near it was to be expected.
    fn is_small(&self) -> bool {
        self.size <= T::from_ratio(1, 8)
    }

    /// Whether the next correction is half of this one at most. Written so that NaN is none.
    fn is_halved_by(&self, size: T) -> bool {
        size <= T::from_ratio(1, 2) * self.size
    }

    /// Whether the correction was small and the next one is not smaller: it has gone where the action does not bend, or is round-off.
    fn is_astray(&self, size: T) -> bool {
        self.is_near() && !self.is_halved_by(size)
    }
}

impl<S: Variational<M, Scalar: Real>, const M: usize> Endpoints<'_, S, M> {
    /// The critical point of the action near the path, which ends at `end`; where `any_index` is false, a minimum is looked for.
    ///
    /// Full Newton steps are made as long as each at least halves the correction or makes the action smaller. Otherwise the last one is
    /// taken back and the gap is closed. Near an extremal such steps go on from there with a steadied Hessian: where extremals are a family,
    /// as between opposite points of a sphere, it is singular along the family, and how far a step goes there is left to round-off. Else, or
    /// where that fails too, the action is made smaller, with its Hessian made definite, steps halved (Armijo's rule) and, where that happens
    /// often, the Hessian damped.
    ///
    /// Corrections are measured in the norm of the Hessian relative to the action, which no choice of units changes.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::Unreachable`], [`Error::NoExtremal`].
    #[inline]
    pub fn newton(
        &self,
        path: &mut [Node<S, M>],
        end: S::Configuration,
        any_index: bool,
    ) -> Result<CriticalPath<S, M>, Error> {
        let (mut end, mut any_index) = (end, any_index);
        let mut before: Option<Progress<S::Scalar>> = None;
        let mut curvature = Curvature::kept();
        let mut size = S::Scalar::zero();
        for sweeps in 1..=SWEEPS {
            let gap = self.end(&end, path.len());
            let summary = self.eliminate(path, &end, &gap, curvature);
            size = summary.size();
            if !summary.action.is_finite() && (sweeps == 1 || curvature.is_mirrored()) {
                return Err(Error::NotFinite { name: "the action of the path" });
            }
            let damped = curvature.added().0 > S::Scalar::zero();
            if !damped && has_converged(&summary, before.as_ref(), gap.is_closed() || gap.is_orthogonal(), curvature) {
                return if gap.is_reached() {
                    Ok(CriticalPath { summary, end, sweeps })
                } else {
                    Err(unreachable(&gap))
                };
            }
            let at_saddle = !damped && summary.negative > 0 && size <= S::Scalar::EPSILON.sqrt();
            if curvature.is_mirrored() && at_saddle {
                // By symmetry no gradient leads away from here, and the action has no digits left to go by.
                (curvature, any_index, before) = (Curvature::kept(), true, None);
                continue;
            }
            let is_astray = before.as_ref().is_some_and(|before| before.is_astray(size));
            if let Curvature::Mirrored { damping, .. } = &mut curvature
                && !is_astray
            {
                match self.descend(path, &summary) {
                    Some((q, fraction)) => {
                        end = q;
                        *damping = damping_after(*damping, fraction);
                    }
                    None if *damping > S::Scalar::from_f64(DAMPING_LIMIT) => {
                        return Err(Error::NoExtremal { correction: size.to_f64(), iterations: sweeps });
                    }
                    None => {
                        (*damping, before) = (damping_after(*damping, S::Scalar::zero()), None);
                        continue;
                    }
                }
            } else if self.is_progress(&summary, before.as_ref(), any_index, curvature) {
                end = self.correct(path, S::Scalar::one());
                if is_last(&summary, before.as_ref())
                    && let Some(summary) = self.found(path, &end, &summary)
                {
                    return Ok(CriticalPath { summary, end, sweeps });
                }
            } else {
                let is_near_any = any_index && before.as_ref().is_some_and(Progress::is_small);
                if before.is_some() {
                    end = self.take_back(path);
                }
                end = self.close(path, end, S::Scalar::zero());
                (before, curvature) = (None, after_failure(curvature, is_near_any || is_astray));
                continue;
            }
            before = Some(Progress { size, action: summary.action, decrement: summary.decrement });
        }
        Err(Error::NoExtremal { correction: size.to_f64(), iterations: SWEEPS })
    }

    /// What is known of a path after its last correction, if that is what it was: if the gap is closed and the residual is round-off.
    #[inline]
    fn found(
        &self,
        path: &mut [Node<S, M>],
        end: &S::Configuration,
        before: &PathSummary<S::Scalar, M>,
    ) -> Option<PathSummary<S::Scalar, M>> {
        let gap = self.end(end, path.len());
        let summary = self.measure(path, end, &gap, before);
        let unit = S::Scalar::from_f64(4.0) * S::Scalar::EPSILON * summary.edges.sqrt();
        (gap.along <= unit * gap.scale && gap.is_reached() && summary.is_stationary(S::Scalar::from_f64(16.0)))
            .then_some(summary)
    }

    /// Whether a full step is made next. Comparisons are written so that NaN is none.
    #[inline]
    fn is_progress(
        &self,
        summary: &PathSummary<S::Scalar, M>,
        before: Option<&Progress<S::Scalar>>,
        any_index: bool,
        curvature: Curvature<S::Scalar>,
    ) -> bool {
        if summary.negative > 0 && !any_index {
            return false;
        }
        let size = summary.size();
        match before {
            // One that is larger than the path leads to another extremal than that near the guess.
            None if any_index && curvature == Curvature::kept() => size <= S::Scalar::one(),
            None => size.is_finite(),
            Some(before) => {
                let is_lower = || summary.negative == 0 && self.is_lower(summary.action, before, S::Scalar::one());
                before.is_halved_by(size) || (!before.is_near() && is_lower())
            }
        }
    }

    /// Armijo's rule: a step of this fraction took at least a hundredth of what the slope promises.
    fn is_lower(&self, action: S::Scalar, before: &Progress<S::Scalar>, fraction: S::Scalar) -> bool {
        let promised = before.decrement * fraction * S::Scalar::from_ratio(1, 100);
        (action - before.action) * self.sign <= -(promised * self.sign)
    }

    /// A step that makes the action smaller, or a full one where the action has no digits left to tell. Returns q_N and the fraction of
    /// Newton's correction that was made; `None` where that would be too small.
    #[cold]
    fn descend(
        &self,
        path: &mut [Node<S, M>],
        summary: &PathSummary<S::Scalar, M>,
    ) -> Option<(S::Configuration, S::Scalar)> {
        let size = summary.size();
        let before = Progress { size, action: summary.action, decrement: summary.decrement };
        let mut fraction = S::Scalar::one();
        if before.is_near() && summary.negative == 0 {
            return Some((self.correct(path, fraction), fraction));
        }
        for _ in 0..HALVINGS {
            if self.is_lower(self.action_after(path, fraction), &before, fraction) {
                return Some((self.correct(path, fraction), fraction));
            }
            fraction *= S::Scalar::from_ratio(1, 2);
        }
        None
    }
}

/// The damping after a step of this fraction.
fn damping_after<T: Real>(damping: T, fraction: T) -> T {
    let made = if fraction >= T::one() {
        Share::Whole
    } else if fraction < T::from_ratio(1, 4) {
        Share::Little
    } else {
        Share::Part
    };
    adapted(damping, T::from_ratio(1, 8), made)
}

/// What is tried where this curvature failed; `near` where the extremal that is looked for is that near the path.
fn after_failure<T: Real>(curvature: Curvature<T>, near: bool) -> Curvature<T> {
    let may_be_steadied = near && curvature == Curvature::kept();
    if curvature.is_mirrored() || may_be_steadied { Curvature::steadied() } else { Curvature::mirrored(T::zero()) }
}

/// Whether no correction is left: it is round-off; or it is below √ε, and the residual is round-off.
///
/// The residual counts where extremals are not isolated, as between opposite points of a sphere: there corrections go astray. Rounding of
/// large terms that cancel may leave more of a residual; then corrections shrink no more although steadied.
#[inline]
fn has_converged<T: Real, const M: usize>(
    summary: &PathSummary<T, M>,
    before: Option<&Progress<T>>,
    closed: bool,
    curvature: Curvature<T>,
) -> bool {
    let (size, seen) = (summary.size(), T::EPSILON.sqrt());
    let is_stationary = |units| closed && summary.is_stationary(T::from_f64(units));
    if size <= T::from_f64(4.0) * T::EPSILON * summary.edges.sqrt() {
        return true;
    }
    let last = before.filter(|before| curvature == Curvature::steadied() && before.size <= seen);
    size <= seen
        && match last {
            Some(before) => !before.is_halved_by(size) || is_stationary(1024.0),
            None => is_stationary(16.0),
        }
}

/// Whether the next correction is expected to be round-off: below √ε, corrections of which each is as the square of the one before.
#[inline]
fn is_last<T: Real, const M: usize>(summary: &PathSummary<T, M>, before: Option<&Progress<T>>) -> bool {
    let size = summary.size();
    let contraction = |before: &Progress<T>| size / before.size;
    size <= T::EPSILON.sqrt()
        && before.is_some_and(|before| size * contraction(before) * contraction(before) <= T::EPSILON)
}

/// The gap that is left where none of it can be closed.
pub(super) fn unreachable<T: Real, const M: usize>(end: &PathEnd<T, M>) -> Error {
    Error::Unreachable { distance: end.distance.to_f64() }
}
