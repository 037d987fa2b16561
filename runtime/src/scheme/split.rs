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
//! Legendre. With seven kicks the order is 6, and (8, 6, 6).
//!
//! Without gradients seven kicks have order 4 and ten order 6. S. Blanes and P. C. Moan, *Practical symplectic partitioned
//! Runge–Kutta and Runge–Kutta–Nyström methods*, J. Comput. Appl. Math. 142 (2002), have such for T that is quadratic in
//! the momenta too, with other numbers.
//!
//! But for the nodes of Gauss and Legendre, the conditions of order leave three or four numbers free. A random search
//! found these, for few kicks in a unit of time at an error that its terms of order up to 9 give. The mean is geometric:
//! over errors of 10⁻³ and 10⁻⁵ at order 4, of 10⁻⁶ and 10⁻⁹ at order 6. It is over three sizes of V too: T/25, 0.3 T
//! and T. Those for seven kicks of order 4 are T/10, T/2 and 2 T.

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
    "Order 6, seven kicks; the middle one and the drifts about it have negative weights." GradientSix: 7 = [
        kick(0.046_967_663_565_765_046, 0.118_250_711_130_744_84, 0.000_087_913_256_962_208_44),
        kick(0.181_174_075_798_053_28, 0.232_277_881_783_518_74, 0.000_449_286_186_915_822_5),
        kick(0.301_199_950_204_886_1, 0.267_326_403_780_724_36, 0.003_635_898_469_324_983_6),
        kick(-0.029_341_689_568_704_407, -0.235_709_993_389_975_9, -0.005_546_222_874_839_022),
        kick(-0.029_341_689_568_704_407, 0.267_326_403_780_724_36, 0.003_635_898_469_324_983_6),
        kick(0.301_199_950_204_886_1, 0.232_277_881_783_518_74, 0.000_449_286_186_915_822_5),
        kick(0.181_174_075_798_053_28, 0.118_250_711_130_744_84, 0.000_087_913_256_962_208_44),
    ];
    "Order 4 without force gradients, seven kicks." PlainFour: 7 = [
        kick(0.060_634_119_033_030_134, 0.151_818_560_833_871_77, 0.0),
        kick(0.194_437_715_187_219_03, 0.426_585_930_365_103_67, 0.0),
        kick(-0.022_021_303_665_517_99, -0.185_674_736_102_886_37, 0.0),
        kick(0.266_949_469_445_268_8, 0.214_540_489_807_821_8, 0.0),
        kick(0.266_949_469_445_268_8, -0.185_674_736_102_886_37, 0.0),
        kick(-0.022_021_303_665_517_99, 0.426_585_930_365_103_67, 0.0),
        kick(0.194_437_715_187_219_03, 0.151_818_560_833_871_77, 0.0),
    ];
    "Order 6 without force gradients, ten kicks." PlainSix: 10 = [
        kick(0.059_042_315_482_706_824, 0.175_280_705_061_374_28, 0.0),
        kick(0.324_850_808_748_176_96, -0.058_839_699_625_822_64, 0.0),
        kick(-0.127_880_033_532_485_56, 0.092_596_910_010_161_24, 0.0),
        kick(-0.241_044_031_963_101_87, -0.014_956_041_455_533_775, 0.0),
        kick(0.340_573_626_873_188_93, 0.305_918_126_009_820_9, 0.0),
        kick(0.288_914_628_783_029_37, 0.305_918_126_009_820_9, 0.0),
        kick(0.340_573_626_873_188_93, -0.014_956_041_455_533_775, 0.0),
        kick(-0.241_044_031_963_101_87, 0.092_596_910_010_161_24, 0.0),
        kick(-0.127_880_033_532_485_56, -0.058_839_699_625_822_64, 0.0),
        kick(0.324_850_808_748_176_96, 0.175_280_705_061_374_28, 0.0),
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
mod quadratic;
#[cfg(test)]
mod tests;
