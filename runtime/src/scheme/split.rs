//! Steps of order 4 and 6 where the drift, the motion without the potential, is exact: drifts and kicks in turn.
//!
//! ```text
//! Ψ_h = D(a_1 h) K_1 D(a_2 h) K_2 … K_s D(a_1 h),    the same forwards and backwards
//! ```
//! D is the exact flow of the kinetic energy T = ½ μ·Σ⁻¹μ and K_i the flow of b_i h V − g_i h³ {V, {V, T}}. The force gradient {V, {V, T}} = G·Σ⁻¹G,
//! G = J(q, ∂V), is a function of q too: each K_i is a kick. Every flow, and so the step, conserves group, symplectic form and momenta.
//!
//! Kinetic energy is quadratic. So the exact drift of the time a h and the momentum μ is that of the time h and the
//! momentum a μ.
//!
//! Source: kicks with force gradients are those of S. A. Chin, *Symplectic integrators from composite operator
//! factorizations*, Phys. Lett. A 226 (1997). The nodes here are those of quadrature to high order in V, so the error
//! for a weak potential is small. With four kicks the order is 4, and (8, 4) in (V, V²): the nodes of Gauss and
//! Legendre. With five kicks the order is 6, and (8, 6, 6). Without gradients they are those of S. Blanes and P. C.
//! Moan, *Practical symplectic partitioned Runge–Kutta and Runge–Kutta–Nyström methods*, J. Comput. Appl. Math. 142
//! (2002).

use super::sequence::{Apart, From, InSequence, Sequence, To};
use super::substep::{Moving, moved};
use super::{At, Pair, is_due, look};
use crate::parts::{Mu, Q, Solved, SplitKicks, Substep, T, U};
use crate::{Clock, Error, Method, Scalar, Space, Time};
use core::marker::PhantomData;
use num_traits::Zero;

/// A kick with the drift before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kick {
    /// a_i, the drift before the kick as a part of the step.
    pub drift: f64,
    /// b_i, the weight of V.
    pub weight: f64,
    /// g_i, the weight of the force gradient.
    pub gradient: f64,
}

const fn kick(drift: f64, weight: f64, gradient: f64) -> Kick {
    Kick { drift, weight, gradient }
}

/// The kicks of a splitting, K of them.
pub trait Kicks<const K: usize> {
    /// The kicks, each with the drift before it.
    const KICKS: [Kick; K];
}

/// Splittings, each with its kicks.
macro_rules! splittings {
    ($($doc:literal $name:ident: $count:literal = $kicks:expr;)*) => { $(
        #[doc = $doc]
        pub struct $name;

        impl Kicks<$count> for $name {
            const KICKS: [Kick; $count] = $kicks;
        }
    )* };
}

splittings! {
    "Order 4, four kicks." GradientFour: 4 = [
        kick(0.069_431_844_202_973_71, 0.173_927_422_568_726_92, 0.000_238_038_871_179_946_26),
        kick(0.260_577_634_004_598_16, 0.326_072_577_431_273_05, 0.001_460_348_652_924_354_3),
        kick(0.339_981_043_584_856_26, 0.326_072_577_431_273_05, 0.001_460_348_652_924_354_3),
        kick(0.260_577_634_004_598_16, 0.173_927_422_568_726_92, 0.000_238_038_871_179_946_26),
    ];
    "Order 6, five kicks; the second and the fourth lie outside the step and are weak." GradientSix: 5 = [
        kick(0.132_793_133_546_899_34, 0.293_280_560_323_112_45, 0.002_167_707_618_081_581),
        kick(-0.290_604_120_144_448_3, 0.004_900_351_437_300_99, -0.000_033_260_037_789_472_71),
        kick(0.657_810_986_597_549, 0.403_638_176_479_173_16, 0.001_637_619_689_152_927),
        kick(0.657_810_986_597_549, 0.004_900_351_437_300_99, -0.000_033_260_037_789_472_71),
        kick(-0.290_604_120_144_448_3, 0.293_280_560_323_112_45, 0.002_167_707_618_081_581),
    ];
    "Order 4 without force gradients, six kicks." PlainFour: 6 = [
        kick(0.079_203_696_431_195_7, 0.209_515_106_613_362, 0.0),
        kick(0.353_172_906_049_774, -0.143_851_773_179_818, 0.0),
        kick(-0.042_065_080_357_719_5, 0.434_336_666_566_456, 0.0),
        kick(0.219_376_955_753_499_6, 0.434_336_666_566_456, 0.0),
        kick(-0.042_065_080_357_719_5, -0.143_851_773_179_818, 0.0),
        kick(0.353_172_906_049_774, 0.209_515_106_613_362, 0.0),
    ];
    "Order 6 without force gradients, ten kicks." PlainSix: 10 = [
        kick(0.050_262_764_400_392_2, 0.148_816_447_901_042, 0.0),
        kick(0.413_514_300_428_344, -0.132_385_865_767_784, 0.0),
        kick(0.045_079_889_794_397_7, 0.067_307_604_692_185, 0.0),
        kick(-0.188_054_853_819_569, 0.432_666_402_578_175, 0.0),
        kick(0.541_960_678_450_78, -0.016_404_589_403_618, 0.0),
        kick(-0.725_525_558_508_689_8, -0.016_404_589_403_618, 0.0),
        kick(0.541_960_678_450_78, 0.432_666_402_578_175, 0.0),
        kick(-0.188_054_853_819_569, 0.067_307_604_692_185, 0.0),
        kick(0.045_079_889_794_397_7, -0.132_385_865_767_784, 0.0),
        kick(0.413_514_300_428_344, 0.148_816_447_901_042, 0.0),
    ];
}

/// Exact drifts with the K kicks Z between them.
pub type Split<Z, const K: usize> = InSequence<Order<Z, K>>;

/// The order of a [`Split`] step.
pub struct Order<Z, const K: usize>(PhantomData<Z>);

impl<S: Substep<0, M> + SplitKicks<M>, M: Method<S>, Z: Kicks<K>, const K: usize> Sequence<S, M> for Order<Z, K> {
    type Carry = Apart;

    #[inline]
    fn step(at: At<'_, S, M>, state: From<'_, S, M, Apart>, u: &S::Input) -> To<S, M, Apart> {
        Self::steps(at, S::step_size(at.constants), 1, state, u)
    }

    fn steps(at: At<'_, S, M>, _: T<S>, steps: usize, state: From<'_, S, M, Apart>, _: &U<S>) -> To<S, M, Apart> {
        let (start, ()) = Moving::<S, M>::start::<Apart>(state.0, state.1, state.2);
        let kicked = |t, weight, gradient, mut state: Moving<S, M>| {
            state.push(Some(at.system.kick(at.constants, t, &state.q, weight, gradient)));
            state
        };
        let drifted = |part, mut state: Moving<S, M>| {
            let x = solve(at, part, &state.q, &state.mu)?;
            state.drift(At { t: Zero::zero(), ..at }, &x);
            Ok(state)
        };
        let settled = |mut state: Moving<S, M>| {
            state.on_space();
            state
        };
        let looked = |state: &Moving<S, M>| {
            let (q, mu) = (state.q, state.mu);
            look(&q, &mu)
        };
        let size = (at.t, S::step_size(at.constants), steps);
        Ok(split(&Z::KICKS, size, start, drifted, kicked, settled, looked)?.end::<Apart>(()))
    }

    fn step_symmetric(at: At<'_, S, M>, q: &Q<S>, p: &Q<S>) -> Result<Pair<S>, Error> {
        let kicked = |t, weight, gradient, (q, p): Pair<S>| {
            let kick = at.system.kick_gradient(at.constants, t, &q, weight, gradient);
            (q, p.zip_map(&kick, |a, b| a + b))
        };
        let drifted = |part, (q, p): Pair<S>| {
            let x = solve(at, part, &q, &at.system.momentum_map(&q, &p))?;
            let d = at.system.increment(&x);
            let q = moved(at.system, &q, &x, &d);
            Ok((q, at.system.lift(&q, &p, &d)))
        };
        let size = (at.t, S::step_size(at.constants), 1);
        split(&Z::KICKS, size, (*q, *p), drifted, kicked, |pair| pair, |_| Ok(()))
    }
}

/// The coordinates of the drift of a part of the step. It is the drift of the step with this part of the momentum, at
/// any time.
#[inline(always)]
fn solve<S: Substep<0, M>, M: Method<S>>(at: At<'_, S, M>, part: T<S>, q: &Q<S>, mu: &Mu<S>) -> Solved<S::Coordinates> {
    let mu = mu.zip_map(mu, |mu, _| mu * part);
    at.system.solve(at.constants, Zero::zero(), q, &mu, &S::Input::origin())
}

/// The state after `steps` steps of size `h` from the time `t`. Where one step ends and the next starts, their drifts are one. `drift` takes
/// a part of the step and the state, `kick` a time, b_i, g_i and the state. `settle` takes rounding off once a step, and `look` ends a long
/// run of NaN.
#[inline]
pub fn split<T: Scalar, S, const K: usize>(
    kicks: &[Kick; K],
    (t, h, steps): (T, T, usize),
    start: S,
    drift: impl Fn(T, S) -> Result<S, Error>,
    kick: impl Fn(T, T, T, S) -> S,
    settle: impl Fn(S) -> S,
    look: impl Fn(&S) -> Result<(), Error>,
) -> Result<S, Error> {
    let Some(first) = kicks.first().filter(|_| steps > 0) else { return Ok(start) };
    // the same forwards and backwards: the last drift is as long as the first
    let end = T::from_f64(first.drift);
    let (mut state, mut begun, mut left) = (start, Clock::at(t), steps);
    let (mut parts, mut size, mut passed) = (kicks.iter(), end, end);
    // drift and kick are called in one place each, so that both stand in the loop and no state goes through memory
    loop {
        state = drift(size, state)?;
        let Some(part) = parts.next().filter(|_| left > 0) else { return Ok(settle(state)) };
        let (weight, gradient) = (T::from_f64(part.weight), T::from_f64(part.gradient));
        state = kick(begun.now() + passed * h, weight, gradient, state);
        match parts.as_slice().first() {
            Some(next) => {
                size = T::from_f64(next.drift);
                passed += size;
            }
            None => {
                left -= 1;
                // the last step is settled behind its last drift
                if left > 0 {
                    state = settle(state);
                }
                if is_due(left) {
                    look(&state)?;
                }
                (begun, parts) = (begun.after_step(h), kicks.iter());
                (size, passed) = (if left == 0 { end } else { end + end }, end);
            }
        }
    }
}

#[cfg(test)]
mod tests;
