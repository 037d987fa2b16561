//! One way to integrate a scene: a method with its dial.

use clebsch::{Clebsch, Error, Method, State, Stepper, Time};
use nalgebra::SVector;
use std::hint::black_box;
use std::marker::PhantomData;
use std::time::Instant;

/// Times at which the error is taken: the multiples of duration/SAMPLES.
pub const SAMPLES: u64 = 10;
/// Observations of a walk with fixed steps, at most, about.
const OBSERVATIONS: u64 = 5120;
/// A reading of the clock takes at least so long, nanoseconds: then the cost of reading does not show.
pub const READING: u128 = 1_500_000;
/// Steps, or parts of a motion, between the first two looks at the clock; each time twice as many.
const FIRST_LOOK: u64 = 1;

/// The dial that a person turns to trade time for accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Dial {
    /// Steps of equal length, in each of [`SAMPLES`] parts of the duration.
    Steps(u64),
    /// The error that each step may make.
    Tolerance(f64),
}

/// Who made the method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// A declaration of this project: symplectic, on the group.
    Geometric,
    /// A method for any differential equation.
    Classical,
}

/// A method, its attitude's form included, and the order that it declares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Name {
    /// Discretization, or the name of the classical method.
    pub method: &'static str,
    /// Declared, or the order of the classical method.
    pub order: u32,
    /// Whose it is.
    pub family: Family,
    /// The part of a step that it leaves out, where that was declared: errors end there, and energies may drift.
    pub tolerance: Option<f64>,
}

impl Name {
    /// Whether each step conserves momenta and the orbit. Steps of order 16 do so only where sweeps go on until they
    /// settle.
    pub fn is_settled(&self) -> bool {
        self.tolerance.is_none() || self.order < 16
    }
}

impl std::fmt::Display for Name {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(&match (self.family, self.tolerance) {
            (Family::Geometric, None) => format!("{}, order {}", self.method, self.order),
            (Family::Geometric, Some(tolerance)) => format!("{} to {tolerance:e}, order {}", self.method, self.order),
            (Family::Classical, _) => self.method.to_owned(),
        })
    }
}

/// A method for a scene whose motions are N numbers.
pub trait Setting<const N: usize> {
    /// Its name.
    fn name(&self) -> Name;

    /// Whether its dial is a tolerance.
    fn is_adaptive(&self) -> bool {
        false
    }

    /// Integrates over `duration`, shows times and motions, those of [`SAMPLES`] among them, and returns the number of steps.
    ///
    /// # Errors
    /// The errors of a step, such as that it is too long.
    fn walk(&self, dial: Dial, duration: f64, observe: &mut Observe<'_, N>) -> Result<u64, Error>;

    /// Nanoseconds of computing for one unit of simulated time; nothing is observed.
    fn clock(&self, dial: Dial, duration: f64) -> f64;
}

/// Takes a time and the motion then.
pub type Observe<'a, const N: usize> = dyn FnMut(f64, &SVector<f64, N>) + 'a;

/// Writes a state as the numbers of the scene.
pub type Flat<S, const N: usize> = fn(&<S as Clebsch>::Configuration, &<S as Clebsch>::Momentum) -> SVector<f64, N>;

/// The same motion at a time, in axes that move.
pub type Frame<const N: usize> = fn(f64, &SVector<f64, N>) -> SVector<f64, N>;

/// A declared system from its start, by the method M.
pub struct Declared<S: Clebsch, M: Method<S>, const N: usize> {
    by: PhantomData<M>,
    method: &'static str,
    system: S,
    start: (S::Configuration, S::Momentum),
    flat: Flat<S, N>,
    /// Whether momenta are read half a kick earlier, at the time of their configuration: steps of order 1 are of second order then.
    is_synchronized: bool,
    tolerance: Option<f64>,
    frame: Option<Frame<N>>,
}

/// A stepper and its start.
type Begun<S, M> = (Stepper<S, M>, State<S, M>);

/// A declared system as a setting, by one of its methods.
pub fn declared<S: Clebsch, M: Method<S>, const N: usize>(
    _: M,
    method: &'static str,
    system: S,
    start: (S::Configuration, S::Momentum),
    flat: Flat<S, N>,
) -> Box<Declared<S, M, N>> {
    Box::new(Declared {
        by: PhantomData,
        method,
        system,
        start,
        flat,
        is_synchronized: false,
        tolerance: None,
        frame: None,
    })
}

impl<S: Clebsch<Scalar = f64> + Clone, M: Method<S>, const N: usize> Declared<S, M, N> {
    /// The same, read as [`Stepper::synchronized`] says.
    pub fn synchronized(self) -> Box<Self> {
        Box::new(Self { is_synchronized: true, ..self })
    }

    /// The same, whose declaration has this tolerance.
    pub fn to(self, tolerance: f64) -> Box<Self> {
        Box::new(Self { tolerance: Some(tolerance), ..self })
    }

    /// The same, compared in these axes.
    pub fn seen_from(self, frame: Frame<N>) -> Box<Self> {
        Box::new(Self { frame: Some(frame), ..self })
    }

    fn prepare(&self, h: f64) -> Result<Begun<S, M>, Error> {
        let stepper = self.system.clone().into_stepper_by(h)?;
        let start = match self.is_synchronized {
            true => stepper.staggered_state(self.start.0, self.start.1)?,
            false => stepper.state(self.start.0, self.start.1)?,
        };
        Ok((stepper, start))
    }

    /// The numbers of a state at a time, as it is read.
    fn read(&self, time: f64, stepper: &Stepper<S, M>, state: &State<S, M>) -> SVector<f64, N> {
        let y = match self.is_synchronized {
            true => (self.flat)(state.configuration(), &stepper.synchronized(state)),
            false => (self.flat)(state.configuration(), &state.momentum()),
        };
        self.frame.map_or(y, |frame| frame(time, &y))
    }
}

impl<S: Clebsch<Scalar = f64> + Clone, M: Method<S>, const N: usize> Setting<N> for Declared<S, M, N> {
    fn name(&self) -> Name {
        let order = if self.is_synchronized { 2 } else { M::ORDER };
        Name { method: self.method, order, family: Family::Geometric, tolerance: self.tolerance }
    }

    fn walk(&self, dial: Dial, duration: f64, observe: &mut Observe<'_, N>) -> Result<u64, Error> {
        let (steps, h) = fixed(dial, duration);
        let (stepper, mut state) = self.prepare(h)?;
        for step in 0..=steps {
            if is_observed(step, steps) {
                let time = step as f64 * h;
                observe(time, &self.read(time, &stepper, &state));
            }
            if step < steps {
                state = stepper.step(&state)?;
            }
        }
        Ok(steps)
    }

    fn clock(&self, dial: Dial, duration: f64) -> f64 {
        let (steps, h) = fixed(dial, duration);
        let Ok((stepper, start)) = self.prepare(h) else { return f64::NAN };
        // from one sample to the next at once
        let part = (steps / SAMPLES) as usize;
        clock_steps(SAMPLES, h * part as f64, start, |state| stepper.advance(state, part).unwrap_or(*state))
    }
}

/// A declared system whose steps follow a monitor, by the method M. The step size is that of s, whose mean is that of the time here.
pub struct Paced<S: Clebsch, M: Method<S>, const N: usize>(Declared<S, M, N>);

/// A declared system with `step` as a setting, by one of its methods.
pub fn paced<S: Clebsch<Scalar = f64> + Clone, M: Method<S>, const N: usize>(
    method: M,
    name: &'static str,
    system: S,
    start: (S::Configuration, S::Momentum),
    flat: Flat<S, N>,
) -> Box<Paced<S, M, N>> {
    Box::new(Paced(*declared(method, name, system, start, flat)))
}

impl<S: Clebsch<Scalar = f64> + Clone, M: Method<S>, const N: usize> Paced<S, M, N> {
    /// From the end of one step to the last end before a time, and to the state at that time.
    fn reach(
        stepper: &Stepper<S, M>,
        node: &mut State<S, M>,
        time: f64,
        mut passed: impl FnMut(&State<S, M>),
    ) -> Result<State<S, M>, Error> {
        loop {
            let next = stepper.step(node)?;
            if next.clock().now() > time {
                return stepper.trajectory(*node).at([time]).next().unwrap_or(Ok(next));
            }
            *node = next;
            passed(node);
        }
    }
}

impl<S: Clebsch<Scalar = f64> + Clone, M: Method<S>, const N: usize> Setting<N> for Paced<S, M, N> {
    fn name(&self) -> Name {
        self.0.name()
    }

    fn walk(&self, dial: Dial, duration: f64, observe: &mut Observe<'_, N>) -> Result<u64, Error> {
        let (stepper, mut node) = self.0.prepare(fixed(dial, duration).1)?;
        let mut steps = 0;
        observe(0.0, &self.0.read(0.0, &stepper, &node));
        for sample in 1..=SAMPLES {
            let time = duration * sample as f64 / SAMPLES as f64;
            let state = Self::reach(&stepper, &mut node, time, |state| {
                steps += 1;
                let now = state.clock().now();
                observe(now, &self.0.read(now, &stepper, state));
            })?;
            observe(time, &self.0.read(time, &stepper, &state));
        }
        Ok(steps)
    }

    fn clock(&self, dial: Dial, duration: f64) -> f64 {
        let Ok((stepper, start)) = self.0.prepare(fixed(dial, duration).1) else { return f64::NAN };
        let part = duration / SAMPLES as f64;
        // the last one so that no state at a sample is left out
        let start = (start, 0, start);
        clock_steps(SAMPLES, part, start, |&(mut node, sample, _)| {
            let state = Self::reach(&stepper, &mut node, (sample + 1) as f64 * part, |_| ());
            (node, sample + 1, state.unwrap_or(node))
        })
    }
}

/// The number of steps and their length.
pub fn fixed(dial: Dial, duration: f64) -> (u64, f64) {
    let Dial::Steps(part) = dial else { return (1, f64::NAN) };
    (SAMPLES * part, duration / (SAMPLES * part) as f64)
}

/// Whether a step is shown: all samples are, and others as evenly as may be.
pub fn is_observed(step: u64, steps: u64) -> bool {
    let part = steps / SAMPLES;
    let every = (1..=part).find(|every| part.is_multiple_of(*every) && steps / every <= OBSERVATIONS).unwrap_or(part);
    step.is_multiple_of(every)
}

/// Nanoseconds for one unit of simulated time, from as many steps as make a reading worth it.
pub fn clock_steps<Y: Copy>(steps: u64, h: f64, start: Y, step: impl Fn(&Y) -> Y) -> f64 {
    let (mut y, mut place, mut made, mut look) = (black_box(start), 0, 0, FIRST_LOOK);
    let began = Instant::now();
    while began.elapsed().as_nanos() < READING {
        for _ in 0..look {
            y = step(&y);
            place += 1;
            if place == steps {
                (y, place) = (black_box(start), 0);
            }
        }
        made += look;
        look *= 2;
    }
    black_box(y);
    began.elapsed().as_nanos() as f64 / (made as f64 * h)
}
