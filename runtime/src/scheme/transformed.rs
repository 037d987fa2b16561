//! Steps whose size follows a function of the configuration, the monitor g: dt = g(q) ds, in steps of one size h of s.
//!
//! ```text
//! drift of a    t⁺ = t + a h/W,    (q, N) moves freely for that time
//! kick of b     N⁺ = N − b h g J(q, ∂V),    W⁺ = W − b h ġ/g,    ġ by the mean of the velocities before and after
//! ```
//! W stands for 1/g(q), which is its value at the start. A drift does not change W, and a kick does not change q: both
//! conserve group and momenta. Drift of ½, kick of 1, drift of ½ is symmetric. Its compositions have the orders 4, 6
//! and 8. Drifts that meet are one if they are exact. If not, steps are kick of ½, drift of 1, kick of ½, as kicks are
//! exact always.
//!
//! Steps are reversible. For g = c/(V₀ − V) and exact drifts W is (T + B)/c with a constant B, which is V₀ − E at the
//! start. They are those of the logarithmic Hamiltonian then, symplectic in (q, t; N, B). In Kepler's problem with
//! g = |q| places lie on the exact orbit, and all of the error is in the time.
//!
//! Sources: S. Mikkola and S. Aarseth, *A time-transformed leapfrog scheme*, Celest. Mech. Dyn. Astron. 84 (2002).
//! S. Mikkola and K. Tanikawa, *Explicit symplectic algorithms for time-transformed Hamiltonians*, Celest. Mech. Dyn.
//! Astron. 74 (1999). M. Preto and S. Tremaine, *A class of symplectic integrators with adaptive time step for separable
//! Hamiltonian systems*, Astron. J. 118 (1999).

use super::composed::Sizes;
use super::sequence::{Carry, From, InSequence, Sequence, To, parted};
use super::substep::Moving;
use super::{At, Pair, is_due, look};
use crate::parts::{Mu, Q, T, TimeTransformed, U};
use crate::stepper::GRADIENT;
use crate::{Clock, Error, Mask, Method, Scalar, Space, Time};
use core::marker::PhantomData;
use nalgebra::Vector3;
use num_traits::{One, Zero};

/// Steps of transformed time, composed of those of the sizes Z.
pub type Transformed<Z, const K: usize> = InSequence<Order<Z, K>>;

/// The order of a [`Transformed`] step.
pub struct Order<Z, const K: usize>(PhantomData<Z>);

/// One step of second order.
pub struct OfOrderTwo;

impl Sizes<1> for OfOrderTwo {
    const SIZES: [f64; 1] = [1.0];
}

/// W, and the time with its rounding error: (W, t, rest).
pub struct Density;

impl<S: TimeTransformed<M>, M: Method<S>> Carry<S, M> for Density {
    type Impulse = Vector3<T<S>>;

    #[inline]
    fn first(at: At<'_, S, M>, q: &Q<S>, _: &Mu<S>) -> Vector3<T<S>> {
        Vector3::new(T::<S>::one() / at.system.monitor(at.constants, q), at.t, T::<S>::zero())
    }

    fn after(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>, carried: &Vector3<T<S>>) -> Vector3<T<S>> {
        <Self as Carry<S, M>>::resumed(at, q, mu, carried)
    }

    /// W is not 1/g after the first step, but near it. One that is a tenth off is made anew, as the difference stays.
    fn resumed(at: At<'_, S, M>, q: &Q<S>, mu: &Mu<S>, carried: &Vector3<T<S>>) -> Vector3<T<S>> {
        let anew = <Self as Carry<S, M>>::first(at, q, mu);
        let is_near = (carried.x / anew.x - T::<S>::one()).abs().at_most(T::<S>::from_ratio(1, 10));
        let is_same = carried.y.equals(at.t) & carried.z.abs().at_most(T::<S>::EPSILON * at.t.abs());
        let density = T::<S>::select(is_near, carried.x, anew.x);
        Vector3::new(density, at.t, T::<S>::select(is_same, carried.z, anew.z))
    }

    #[inline(always)]
    fn now(carried: &Vector3<T<S>>) -> Option<T<S>> {
        Some(carried.y)
    }

    fn check_monitor(at: At<'_, S, M>, q: &Q<S>) -> Result<(), Error> {
        let monitor = at.system.monitor(at.constants, q);
        let accepted = positive(monitor) & positive(monitor.recip());
        let refused = (0..T::<S>::LANES).find(|&lane| !accepted.lane(lane));
        if let Some(lane) = refused {
            return Err(refusal(Space::lane(&monitor, lane).to_f64(), NAME));
        }
        let kick = at.system.monitored_kick(at.constants, at.t, q);
        if kick.all_finite() { Ok(()) } else { Err(Error::NotFinite { name: GRADIENT }) }
    }
}

/// The name of the monitor where it is not finite.
const NAME: &str = "the function of `step` at the configuration";

/// The error of a monitor that is not positive, or not finite: it has this name then.
#[cold]
fn refusal(value: f64, name: &'static str) -> Error {
    if value.is_finite() { Error::Monitor { value } } else { Error::NotFinite { name } }
}

impl<S: TimeTransformed<M>, M: Method<S>, Z: Sizes<K>, const K: usize> Sequence<S, M> for Order<Z, K> {
    type Carry = Density;

    #[inline]
    fn step(at: At<'_, S, M>, state: From<'_, S, M, Density>, _: &U<S>) -> To<S, M, Density> {
        let (state, &carried) = Moving::<S, M>::start::<Density>(state.0, state.1, state.2);
        let mut step = Step { at, state, density: carried.x, clock: Clock::resumed(at.t, [carried.y, carried.z]) };
        let half = T::<S>::from_ratio(1, 2);
        let (mut last, last_number) = (T::<S>::zero(), 2 * K - 2);
        for number in 0..=last_number {
            let size = T::<S>::from_f64(Z::SIZES[number.min(last_number - number)]);
            let both = half * (last + size);
            if S::DRIFTS_ARE_EXACT {
                step.drift(both)?;
                step.kick(size)?;
            } else {
                step.kick(both)?;
                step.drift(size)?;
            }
            last = size;
        }
        let both = half * last;
        if S::DRIFTS_ARE_EXACT {
            step.drift(both)?
        } else {
            step.kick(both)?
        }
        step.end()
    }

    fn steps(at: At<'_, S, M>, _: T<S>, steps: usize, state: From<'_, S, M, Density>, u: &U<S>) -> To<S, M, Density> {
        let mut state = (*state.0, *state.1, *state.2);
        let mut t = at.t;
        for number in 0..steps {
            state = Self::step(At { t, ..at }, (&state.0, &state.1, &state.2), u)?;
            t = parted::<S, M, Density>(&state.2).0.y;
            if is_due(number) {
                let (q, mu, _) = state;
                look(&q, &mu)?;
            }
        }
        Ok(state)
    }

    /// A covector has no W.
    fn step_symmetric(_: At<'_, S, M>, _: &Q<S>, _: &Q<S>) -> Result<Pair<S>, Error> {
        Err(Error::NoCovector)
    }
}

/// A step while it is made.
struct Step<'a, S: TimeTransformed<M>, M: Method<S>> {
    at: At<'a, S, M>,
    state: Moving<S, M>,
    /// W
    density: T<S>,
    clock: Clock<T<S>>,
}

impl<S: TimeTransformed<M>, M: Method<S>> Step<'_, S, M> {
    /// The drift of a. Kinetic energies are quadratic: that of the time τ and the momentum μ is that of the time h and
    /// the momentum μ τ/h.
    #[inline(always)]
    fn drift(&mut self, part: T<S>) -> Result<(), Error> {
        let At { system, constants, .. } = self.at;
        let part = part / self.density;
        self.clock = self.clock.after_step(part * S::step_size(constants));
        let (q, mu) = (self.state.q, self.state.mu);
        let scaled = mu.zip_map(&mu, |mu, _| mu * part);
        let x = system.solve(constants, T::<S>::zero(), &q, &scaled, &S::Input::origin())?;
        self.state.drift(At { t: T::<S>::zero(), ..self.at }, &x);
        Ok(())
    }

    /// The kick of b.
    #[inline(always)]
    fn kick(&mut self, part: T<S>) -> Result<(), Error> {
        let At { system, constants, .. } = self.at;
        let (q, before) = (self.state.q, self.state.mu);
        let kick = system.monitored_kick(constants, self.clock.now(), &q);
        self.state.push(Some(kick.zip_map(&kick, |kick, _| kick * part)));
        let after = self.state.mu;
        // γ does not wait for the kick
        let slope = system.monitor_slope(constants, &q);
        let twice = before.zip_map(&after, |before, after| before + after);
        let terms = slope.zip_map(&twice, |slope, twice| slope * twice);
        let rate = terms.reduce(T::<S>::zero(), |term| term, |sum, term| sum + term);
        self.density -= T::<S>::from_ratio(1, 2) * part * rate;
        let is_open = positive(self.density) & self.density.finite();
        if !is_open.any() {
            let densities = (0..T::<S>::LANES).map(|lane| Space::lane(&self.density, lane).to_f64());
            let density = densities.fold(f64::NAN, |first, density| if first.is_finite() { first } else { density });
            let value = if density.is_finite() { density.recip().clamp(f64::MIN, 0.0) } else { f64::NAN };
            return Err(refusal(value, "the momentum after the kick"));
        }
        if T::<S>::LANES > 1 {
            let failed = T::<S>::from_f64(f64::NAN);
            self.state.mu = after.zip_map(&after, |mu, _| T::<S>::select(is_open, mu, failed));
        }
        self.density = T::<S>::select(is_open, self.density, T::<S>::from_f64(f64::NAN));
        Ok(())
    }

    #[inline(always)]
    fn end(mut self) -> To<S, M, Density> {
        self.state.on_space();
        let [now, rest] = self.clock.parts();
        Ok(self.state.end::<Density>(Vector3::new(self.density, now, rest)))
    }
}

/// The lanes in which x > 0.
#[inline(always)]
fn positive<T: Scalar>(x: T) -> T::Mask {
    T::zero().below(x)
}
