//! States that are written and read back, with the feature `serde`.

use crate::fields::copy;
use crate::parameters::check_finite;
use crate::scheme::{Held, Left, Scheme};
use crate::stepper::check_violation;
use crate::{Clebsch, Declared, Error, Mask, Method, Scalar, State, Stepper, Time};
use core::fmt::{self, Debug, Formatter};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The saved data of a state: time, q, and the stored form of N. The next step takes data from the last one; these and
/// their step size are saved too.
#[derive(Serialize, Deserialize)]
#[serde(rename = "State")]
struct Record<Time, Configuration, Momentum, Impulse, Scalar> {
    time: Time,
    configuration: Configuration,
    momentum: Momentum,
    impulse: Impulse,
    step_size: Scalar,
}

impl<S: Clebsch, M: Method<S>> Serialize for State<S, M>
where
    S::Time: Serialize,
    S::Configuration: Serialize,
    Held<S, M>: Serialize,
    Left<S, M>: Serialize,
    S::Scalar: Serialize,
{
    fn serialize<W: Serializer>(&self, writer: W) -> Result<W::Ok, W::Error> {
        let Self { time, configuration, held: momentum, left: impulse, h } = self;
        Record { time, configuration, momentum, impulse, step_size: h }.serialize(writer)
    }
}

/// A state as it was read, which no stepper has seen yet: [`Stepper::resume`] makes it a [`State`].
///
/// ```
/// # use clebsch::{Clebsch, SavedState};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let state = stepper.state(Vector1::new(0.1), Vector1::new(6.0))?;
/// let text = serde_json::to_string(&state)?;
/// let saved: SavedState<Particle> = serde_json::from_str(&text)?;
/// assert_eq!(stepper.resume(saved)?, state);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct SavedState<S: Clebsch, M: Method<S> = Declared>(State<S, M>);

impl<'de, S: Clebsch, M: Method<S>> Deserialize<'de> for SavedState<S, M>
where
    S::Time: Deserialize<'de>,
    S::Configuration: Deserialize<'de>,
    Held<S, M>: Deserialize<'de>,
    Left<S, M>: Deserialize<'de>,
    S::Scalar: Deserialize<'de>,
{
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        let Record { time, configuration, momentum, impulse, step_size: h } = Record::deserialize(reader)?;
        Ok(Self(State { time, configuration, held: momentum, left: impulse, h }))
    }
}

copy!(SavedState<S, M> where [S: Clebsch, M: Method<S>]);

impl<S: Clebsch, M: Method<S>> Debug for SavedState<S, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_tuple("SavedState").field(&self.0).finish()
    }
}

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// The state that was written, after the checks of [`state`](Self::state): the next steps have the bits that they would have had.
    ///
    /// All data that a step takes from the last one are written and read back. These are the impulse at q, the
    /// constants of a free motion, and the rounding errors of compensated sums. `resume` checks that they follow from
    /// the time, q and N, up to √ε. If they do not, it makes them anew, as [`state`](Self::state) does. A damaged file,
    /// another system and another step size are such cases. With `step`, W follows the monitor up to a tenth. Formats have to give back every bit of a number:
    /// `serde_json` does with its feature `float_roundtrip`, and binary ones do.
    ///
    /// ```
    /// # use clebsch::{Clebsch, SavedState};
    /// # use nalgebra::Vector3;
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    ///     cost      = |h, F| (F - I).norm_squared() / (4 * h),
    ///     potential = |q| q.z,
    /// )]
    /// struct Pendulum;
    ///
    /// let stepper = Pendulum.stepper(0.01)?;
    /// let state = stepper.step(&stepper.state(Vector3::x(), Vector3::new(0.0, 0.6, 0.2))?)?;
    /// let text = serde_json::to_string(&state).expect("numbers");
    /// let saved: SavedState<Pendulum> = serde_json::from_str(&text).expect("the same numbers");
    /// assert_eq!(stepper.step(&stepper.resume(saved)?)?, stepper.step(&state)?);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`state`](Self::state); [`Error::NotFinite`] for the data of the last step, and for the time.
    pub fn resume(&self, saved: SavedState<S, M>) -> Result<State<S, M>, Error> {
        let SavedState(mut state) = saved;
        let mu = state.momentum();
        self.check_state(state.time.now(), &state.configuration, &mu)?;
        check_violation(M::Scheme::held_defect(&state.configuration, &state.held), &mu)?;
        check_finite("the time", &state.time.now())?;
        check_finite("the data of the last step", &(state.left, state.h))?;
        let now = state.time.now();
        state.time = resumed_time(&state.time);
        state.left = M::Scheme::resumed(self.at(now), &state.configuration, &mu, &state.left);
        // that of a step of another size is not known before
        (state.left, state.h) = (self.left_of(&state), self.h);
        self.check_left(now, &state.configuration, &state.left)?;
        Ok(state)
    }
}

/// A time as it was read. A rounding error that is not below its last place is dropped.
pub(crate) fn resumed_time<T: Scalar, C: Time<T>>(time: &C) -> C {
    // a rounding error below the last place does not show
    let is_same = time.after_step(T::zero()).now().equals(time.now());
    let mut resumed = *time;
    (0..T::LANES).filter(|&lane| !is_same.lane(lane)).for_each(|lane| resumed.take_lane(lane, &C::at(time.now())));
    resumed
}
