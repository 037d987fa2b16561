//! The functions behind the exported ones, the same for every system and every method.

use crate::{Message, Status};
use clebsch::{Clebsch, Columns, Error, Method, Scalar, Space, State, Stepper, Time};
use core::fmt::Write;
use core::mem::{MaybeUninit, needs_drop};

/// Whether a state has a time, in front of its numbers.
pub(crate) const fn is_timed<S: Clebsch>() -> bool {
    size_of::<S::Time>() > 0
}

/// The count of the numbers of a state.
pub const fn width<S: Clebsch>() -> usize {
    is_timed::<S>() as usize
        + <S::Configuration as Columns<S::Scalar>>::FORM.width()
        + <S::Momentum as Columns<S::Scalar>>::FORM.width()
}

/// A result as a status.
fn status(result: Result<(), Status>) -> Status {
    result.err().unwrap_or(Status::Ok)
}

/// A pointer that is not null.
fn given<P>(pointer: Option<P>) -> Result<P, Status> {
    pointer.ok_or(Status::Null)
}

/// A place in the memory of C that is large enough.
fn place<V>(place: Option<&mut MaybeUninit<V>>, size: usize) -> Result<&mut MaybeUninit<V>, Status> {
    const {
        assert!(!needs_drop::<V>(), "C does not drop values: the system may not own memory");
        assert!(align_of::<V>() <= 8, "values in C are aligned to eight bytes: the system may not have lanes");
    }
    let place = given(place)?;
    if size == size_of::<V>().next_multiple_of(8) { Ok(place) } else { Err(Status::Size) }
}

/// `NAME_make`
pub fn make<S: Clebsch, M: Method<S>>(
    to: Option<&mut MaybeUninit<Stepper<S, M>>>,
    size: usize,
    system: Option<S>,
    step_size: S::Scalar,
) -> Status {
    status((|| {
        let to = place(to, size)?;
        to.write(given(system)?.into_stepper_by(step_size)?);
        Ok(())
    })())
}

/// The state with these numbers.
fn state_of<S: Clebsch, M: Method<S>>(stepper: &Stepper<S, M>, numbers: &[S::Scalar]) -> Result<State<S, M>, Status> {
    state_or_error(stepper, numbers).ok_or(Status::Null)?.map_err(Status::from)
}

/// The same; `None` if there are too few numbers.
fn state_or_error<S: Clebsch, M: Method<S>>(
    stepper: &Stepper<S, M>,
    numbers: &[S::Scalar],
) -> Option<Result<State<S, M>, Error>> {
    let numbers = numbers.iter().copied();
    // a row has a time in any case
    let no_time = if is_timed::<S>() { None } else { Some(S::Scalar::from_f64(0.0)) };
    stepper.table().state(no_time.into_iter().chain(numbers))
}

/// `NAME_start`
pub fn start<S: Clebsch, M: Method<S>>(
    stepper: Option<&Stepper<S, M>>,
    to: Option<&mut MaybeUninit<State<S, M>>>,
    size: usize,
    numbers: Option<&[S::Scalar]>,
) -> Status {
    status((|| {
        let to = place(to, size)?;
        to.write(state_of(given(stepper)?, given(numbers)?)?);
        Ok(())
    })())
}

/// `NAME_step`
pub fn step<S: Clebsch, M: Method<S>>(stepper: Option<&Stepper<S, M>>, state: Option<&mut State<S, M>>) -> Status {
    status((|| {
        let state = given(state)?;
        *state = given(stepper)?.step(state)?;
        Ok(())
    })())
}

/// `NAME_step_with`
pub fn step_with<S: Clebsch, M: Method<S>>(
    stepper: Option<&Stepper<S, M>>,
    state: Option<&mut State<S, M>>,
    input: Option<&[S::Scalar]>,
) -> Status {
    status((|| {
        let (stepper, state) = (given(stepper)?, given(state)?);
        let input = given(S::Input::from_columns(&mut given(input)?.iter().copied()))?;
        *state = stepper.step_with(state, &input)?;
        Ok(())
    })())
}

/// `NAME_advance`
pub fn advance<S: Clebsch, M: Method<S>>(
    stepper: Option<&Stepper<S, M>>,
    state: Option<&mut State<S, M>>,
    steps: usize,
) -> Status {
    status((|| {
        let state = given(state)?;
        *state = given(stepper)?.advance(state, steps)?;
        Ok(())
    })())
}

/// `NAME_kick`
pub fn kick<S: Clebsch, M: Method<S>>(
    stepper: Option<&Stepper<S, M>>,
    state: Option<&mut State<S, M>>,
    impulse: Option<&[S::Scalar]>,
) -> Status {
    status((|| {
        let (stepper, state) = (given(stepper)?, given(state)?);
        let impulse = given(S::Momentum::from_columns(&mut given(impulse)?.iter().copied()))?;
        *state = stepper.kick(state, impulse)?;
        Ok(())
    })())
}

/// `NAME_read`
pub fn read<S: Clebsch, M: Method<S>>(state: Option<&State<S, M>>, numbers: Option<&mut [S::Scalar]>) -> Status {
    status((|| {
        let (state, numbers) = (given(state)?, given(numbers)?);
        let (q, mu) = (state.configuration(), state.momentum());
        let time = is_timed::<S>().then(|| state.clock().now());
        let of_q = (0..).map_while(|k| q.entry(k));
        let of_mu = (0..).map_while(|k| mu.entry(k));
        let all = time.into_iter().chain(of_q).chain(of_mu);
        numbers.iter_mut().zip(all).for_each(|(number, value)| *number = value);
        Ok(())
    })())
}

/// `NAME_energy`
pub fn energy<S: Clebsch, M: Method<S>>(
    stepper: Option<&Stepper<S, M>>,
    state: Option<&State<S, M>>,
    energy: Option<&mut S::Scalar>,
) -> Status {
    status((|| {
        *given(energy)? = given(stepper)?.energy(given(state)?);
        Ok(())
    })())
}

/// `NAME_explain`
pub fn explain<S: Clebsch, M: Method<S>>(
    system: Option<S>,
    step_size: S::Scalar,
    numbers: Option<&[S::Scalar]>,
    input: Option<&[S::Scalar]>,
    message: Option<&mut Message>,
) -> Status {
    let attempt = |system: S| {
        let stepper = system.into_stepper_by::<M>(step_size)?;
        let Some(state) = numbers.and_then(|numbers| state_or_error(&stepper, numbers)) else { return Ok(()) };
        match input.and_then(|input| S::Input::from_columns(&mut input.iter().copied())) {
            Some(input) => stepper.step_with(&state?, &input)?,
            None => stepper.step(&state?)?,
        };
        Ok(())
    };
    let (Some(system), Some(message)) = (system, message) else { return Status::Null };
    *message = Message::default();
    let found: Result<(), Error> = attempt(system);
    let Err(error) = found else { return Status::Ok };
    // a message cuts a text that is too long, and does not fail
    let _ = write!(message, "{error}");
    error.into()
}
