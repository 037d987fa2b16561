//! The step size that a wished error asks for.

use crate::space::larger;
use crate::{Clebsch, Error, Method, Real, Scalar, Space, State, Stepper};
use num_traits::{One, Zero};

/// Steps of the stepper's own size that the probing run goes over.
const PROBE: i64 = 64;
/// Steps of a probing run, at least and at most.
pub(crate) const STEPS: [i64; 2] = [4, 1 << 20];
/// Probing runs, at most.
const RUNS: usize = 12;
/// Ratio of two step sizes between which the error is a power of h.
const NEAR: i64 = 2;
/// Ratio of the step sizes of two probing runs, at most.
const FAR: i64 = 8;
/// A difference of the two runs of no more than so many ε √steps may be rounding.
const ROUNDINGS: i64 = 64;

impl<S: Clebsch<Scalar: Real> + Clone, M: Method<S>> Stepper<S, M> {
    /// A step size with which the motion from `start` is wrong by about `error` after `duration`.
    ///
    /// A probing run over t = 64 h, with h this stepper's own step size, is made with steps of h and of h/2. Their
    /// difference d gives the error with h, by the declared order p. Errors grow like the time, so that
    /// ```text
    /// E(t) = d / (1 − 2⁻ᵖ)        E(T) = E(t) T/t        h* = h (error / E(T))^(1/p).
    /// ```
    /// Another power of h may count if h* is not near h. The run is then repeated with h*, unless it would take more
    /// than a million steps.
    ///
    /// * The error is the larger of |Δq|, the root of the sum of squares of all entries, in the unit of the configuration, and |Δμ|/|μ|.
    /// * **Linear growth is assumed.** It holds for symmetric or symplectic steps of motions that are integrable or nearly so, also on
    ///   average over their periods. Errors of chaotic motions grow like exponentials: over their Lyapunov time and longer the answer is
    ///   too long a step. A friction that damps errors makes it too short.
    /// * At order 1 a part of the error, of h, does not grow: the answer errs to the short side.
    /// * Choose this stepper's h so that 64 steps go over a period or more: the estimate knows only the motion of its
    ///   run.
    /// * Forces have no input during the run, and an explicit time starts as in `start`.
    /// * The answer has the sign of this stepper's h and is not above t/4. The steps of the run were solvable with it or with a step near it.
    /// * Rounding is not in E: over n steps it is about ε √n.
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # use nalgebra::Vector3;
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    ///     cost      = |h, F| (F - I).norm_squared() / (4 * h),
    ///     potential = |q| q.z,
    ///     order     = 6,
    /// )]
    /// struct Pendulum;
    ///
    /// let probing = Pendulum.stepper(0.25)?; // 64 of its steps are some three periods
    /// let start = probing.state(Vector3::y(), Vector3::new(1.0, 0.0, 0.5))?;
    /// let h = probing.suggest_step_size(&start, 1e-6, 100.0)?;
    /// let stepper = Pendulum.stepper(h)?; // 0.13: the state after 100 s is wrong by 6e-7
    /// # assert!((0.1..0.16).contains(&h));
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// Source: Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, §II.4 (step size by
    /// Richardson's extrapolation). Hairer, Lubich and Wanner, *Geometric Numerical Integration*, theorem X.3.1 (linear
    /// growth).
    ///
    /// # Errors
    /// [`Error::BelowRounding`] if the error is not above that of rounding over the duration, [`Error::NotFinite`] for
    /// the duration. If no step size served, the error is that of its steps.
    pub fn suggest_step_size(
        &self,
        start: &State<S, M>,
        error: S::Scalar,
        duration: S::Scalar,
    ) -> Result<S::Scalar, Error> {
        let asked = Asked { h: self.h, error, duration, longest: S::Scalar::from_f64(f64::INFINITY), order: M::ORDER };
        asked.suggestion(|h, time| self.probe(start, h, time))
    }

    /// How fast the error with steps of h grows, by steps of h and of h/2 side by side; `None` where rounding hides it.
    fn probe(&self, start: &State<S, M>, h: S::Scalar, time: S::Scalar) -> Result<Option<S::Scalar>, Error> {
        let signed = if self.h < S::Scalar::zero() { -h } else { h };
        let (whole, half) = (self.system.stepper_by::<M>(signed)?, self.system.stepper_by::<M>(signed / number(2))?);
        let (mut a, mut b) = (*start, *start);
        let (mut steps, mut difference, mut size) = (0, S::Scalar::zero(), start.held.max_abs());
        while steps < STEPS[1] && number::<S::Scalar>(steps) * h < time {
            a = whole.step(&a)?;
            b = half.step(&half.step(&b)?)?;
            steps += 1;
            size = larger(size, b.held.max_abs());
            difference = larger(difference, apart(&a, &b, size));
        }
        let size = S::Scalar::one() + start.configuration.max_abs();
        Ok(growth(difference, (steps, h), size, M::ORDER))
    }
}

/// How fast the error with steps of h grows, from the difference to steps of h/2 after so many; `None` where rounding hides it.
pub(crate) fn growth<T: Real>(difference: T, (steps, h): (i64, T), size: T, order: u32) -> Option<T> {
    if difference <= number::<T>(ROUNDINGS) * T::EPSILON * number::<T>(steps).sqrt() * size {
        return None;
    }
    let part = T::one() - number::<T>(2).powi(-(order as i32));
    Some(difference / (part * number::<T>(steps) * h))
}

/// The error that is asked for after a duration, and how it is looked for.
pub(crate) struct Asked<T> {
    /// The step size of the first probing run.
    pub h: T,
    pub error: T,
    pub duration: T,
    /// No step size above it is tried.
    pub longest: T,
    /// The order p of the steps.
    pub order: u32,
}

impl<T: Real> Asked<T> {
    /// The step size whose error is that one. `probe(h, t)` tells how fast it grows with steps of h during t.
    pub fn suggestion<E: From<Error>>(&self, probe: impl Fn(T, T) -> Result<Option<T>, E>) -> Result<T, E> {
        let (h, duration) = (self.h.abs(), self.duration.abs());
        if !(duration.is_finite() && duration > T::zero()) {
            return Err(Error::NotFinite { name: "the duration, or its inverse," }.into());
        }
        let time = least(h * number(PROBE), duration);
        let found = if self.error > T::zero() { self.search((self.error / duration, time), probe)? } else { time };
        let rounding = T::EPSILON * (duration / found).sqrt();
        if self.error > rounding {
            return Ok(if self.h < T::zero() { -found } else { found });
        }
        Err(Error::BelowRounding { error: self.error.to_f64(), rounding: rounding.to_f64() }.into())
    }

    /// The step size whose error grows at this rate, by probing runs over this time.
    fn search<E: From<Error>>(
        &self,
        (rate, time): (T, T),
        probe: impl Fn(T, T) -> Result<Option<T>, E>,
    ) -> Result<T, E> {
        let power = number::<T>(i64::from(self.order)).recip();
        let mut longest = least(time / number(STEPS[0]), self.longest);
        let (mut h, mut answer, mut refused) =
            (least(self.h.abs(), longest), None, Error::StepSize { value: 0.0 }.into());
        for _ in 0..RUNS {
            match probe(h, time) {
                Ok(Some(found)) => {
                    let next = least(h * (rate / found).powf(power), longest);
                    if is_near(next, h) || time > next * number(STEPS[1]) {
                        return Ok(next);
                    }
                    answer = Some(next);
                    h = least(larger(next, h / number(FAR)), h * number(FAR));
                }
                // the error would show with longer steps: where there are none, or some have told it, that is the answer
                Ok(None) if answer.is_some() || h >= longest => return Ok(answer.unwrap_or(longest)),
                Ok(None) => h = least(h * number(FAR), longest),
                Err(failure) => {
                    refused = failure;
                    longest = h / number(NEAR);
                    answer = answer.map(|answer| least(answer, longest));
                    h = longest;
                }
            }
        }
        answer.ok_or(refused)
    }
}

/// The larger one of |Δq| and |Δμ| over the size of momenta.
fn apart<S: Clebsch<Scalar: Real>, M: Method<S>>(a: &State<S, M>, b: &State<S, M>, size: S::Scalar) -> S::Scalar {
    let turned = a.configuration.distance_squared(&b.configuration).sqrt();
    let pushed = a.held.distance_squared(&b.held).sqrt();
    larger(turned, if size > S::Scalar::zero() { pushed / size } else { pushed })
}

/// Whether the error is the same power of both step sizes.
fn is_near<T: Real>(a: T, b: T) -> bool {
    a <= b * number(NEAR) && b <= a * number(NEAR)
}

fn number<T: Real>(value: i64) -> T {
    T::from_ratio(value, 1)
}

/// The smaller one; `b` where either is NaN.
pub(crate) fn least<T: Real>(a: T, b: T) -> T {
    if a < b { a } else { b }
}
