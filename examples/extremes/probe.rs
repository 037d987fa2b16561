//! One cell of the map: a scene with a dial, from one start, in one number type.

use crate::random::Random;
use clebsch::{Clebsch, DoubleDouble, Error, Method, Real, Scalar, Space, State, Stepper};
use clebsch_examples::counted::iterations;
use nalgebra::{Matrix3, Vector3};

/// Parameters and start of any of the scenes.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Principal moments of inertia, kg·m²; the first is m·l² of a pendulum.
    pub moments: [f64; 3],
    /// m·g, N.
    pub weight: f64,
    /// From the pivot to the centre of mass in the body frame, m; its length is that of a pendulum.
    pub arm: Vector3<f64>,
    /// Step size, s.
    pub h: f64,
    /// R; a pendulum points along its third column.
    pub attitude: Matrix3<f64>,
    /// π in the body frame; spatial for a pendulum, projected.
    pub momentum: Vector3<f64>,
}

impl Setup {
    /// A tumbling body, a fast top, or a pendulum that is level, of the order of one in all units.
    pub fn ordinary() -> Self {
        Self {
            moments: [1.0, 1.5, 2.0],
            weight: 1.0,
            arm: Vector3::new(0.45, 0.0, 0.6),
            h: 0.0625,
            // right to the last digit of every type
            attitude: Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0),
            momentum: Vector3::new(0.5, 1.25, 1.0),
        }
    }

    /// J⁻¹π
    pub fn velocity(&self) -> Vector3<f64> {
        self.momentum.component_div(&Vector3::from(self.moments))
    }

    /// The same with the momentum that gives this velocity.
    pub fn with_velocity(mut self, velocity: Vector3<f64>) -> Self {
        self.momentum = velocity.component_mul(&Vector3::from(self.moments));
        self
    }

    /// The same with each number rounded to T, so that runs of different types start alike.
    fn rounded<T: Real>(&self) -> Self {
        let to = |x: f64| T::from_f64(x).to_f64();
        Self {
            moments: self.moments.map(to),
            weight: to(self.weight),
            arm: self.arm.map(to),
            h: to(self.h),
            attitude: self.attitude.map(to),
            momentum: self.momentum.map(to),
        }
    }
}

/// A declaration that can be set up.
pub trait Scene: Clebsch<Scalar: Real, Time = (), Input = ()> + Clone {
    /// The system.
    fn of(setup: &Setup) -> Self;

    /// Where it starts.
    ///
    /// # Errors
    /// Those of [`Stepper::state`].
    fn start<M: Method<Self>>(setup: &Setup, stepper: &Stepper<Self, M>) -> Result<State<Self, M>, Error>;

    /// Configuration and momentum.
    fn numbers<M: Method<Self>>(state: &State<Self, M>) -> Vec<f64>;

    /// The momenta that no step changes, zeros for those that it has not.
    fn conserved<M: Method<Self>>(stepper: &Stepper<Self, M>, state: &State<Self, M>) -> [f64; 3];
}

/// What became of a run.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Whether it came to its end, and why not.
    pub outcome: Result<(), Error>,
    /// Steps that were made.
    pub steps: u64,
    /// The most iterations of one step.
    pub iterations: u32,
    /// The largest |F⁻ℓd(q, F) − N|, over momenta, by how much the equation of a step is missed; NaN where steps are composed or collocated, and have none.
    pub residual: f64,
    /// Largest relative change of the energy.
    pub energy: f64,
    /// Largest change of conserved momenta over |N|.
    pub momentum: f64,
    /// Largest defect of the configuration.
    pub constraint: f64,
    /// Largest difference from the same steps in 31 digits, relative to configuration and momentum; NaN where there are none.
    pub precise: f64,
    /// Configuration and momentum in the end.
    pub last: Vec<f64>,
}

impl Cell {
    /// What is not measured, of a run that ended like this.
    pub fn of(outcome: Result<(), Error>, steps: u64) -> Self {
        Self { steps, ..Self::new(outcome, f64::NAN) }
    }

    /// Before any step: `measured` stands for what is measured in steps.
    fn new(outcome: Result<(), Error>, measured: f64) -> Self {
        Self {
            outcome,
            steps: 0,
            iterations: 0,
            residual: measured,
            energy: measured,
            momentum: measured,
            constraint: measured,
            precise: f64::NAN,
            last: Vec::new(),
        }
    }

    /// Whether a number that is not finite was handed out as a result.
    pub fn hides_nan(&self) -> bool {
        self.last.iter().any(|x| !x.is_finite())
    }
}

/// [`one_step`] of a declaration.
type OneStep = fn(&Setup) -> Result<u32, Error>;
/// [`drift`] of a declaration.
type LongRun = fn(&Setup, &[u64]) -> Result<Vec<Drift>, Error>;

/// A scene with a dial.
#[derive(Clone, Copy)]
pub struct Dial {
    /// The scene.
    pub scene: &'static str,
    /// What is declared.
    pub name: &'static str,
    /// Runs in `f64` and in `f32`: setup, steps, whether beside 31 digits.
    pub run: [fn(&Setup, u64, bool) -> Cell; 2],
    /// One step in `f64`: the number of iterations, or the error.
    pub step: OneStep,
    /// Errors between marks of a long run.
    pub drift: [LongRun; 2],
    /// One step from each of so many random states of a body, with a seed.
    pub sample: [fn(&Setup, u64, u64, &mut Sample); 2],
}

/// Root mean squares of relative errors up to a number of steps, from the mark before.
#[derive(Clone, Copy, Debug)]
pub struct Drift {
    /// The number of steps.
    pub steps: u64,
    /// Of the energy.
    pub energy: f64,
    /// Of conserved momenta.
    pub momentum: f64,
    /// The defect of the configuration.
    pub constraint: f64,
}

/// What many steps took.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    /// Steps that were made.
    pub done: u64,
    /// How many of them took so many iterations, up to 63.
    pub iterations: Vec<u64>,
    /// The most iterations of one that was made.
    pub most: u32,
    /// Steps that have no solution.
    pub too_long: u64,
    /// The most iterations of one that was not made.
    pub most_refused: u32,
    /// Steps that were given up.
    pub not_converged: u64,
    /// Steps with another error, and states that were refused.
    pub others: u64,
    /// Numbers that are not finite, handed out as results.
    pub hidden: u64,
    /// The largest |F⁻ℓd(q, F) − N|, over momenta, of one in a hundred steps with h|ω| below one.
    pub missed: f64,
}

/// The dial of a method of a declaration that is generic over its scalar, run [`beside`] 31 digits.
macro_rules! dial {
    ($name:literal, $scene:literal, $system:ident, $method:ty) => {
        $crate::probe::Dial {
            scene: $scene,
            name: $name,
            run: [
                $crate::probe::beside::<$system<Counted<f64>>, $system<DoubleDouble>, $method>,
                $crate::probe::beside::<$system<Counted<f32>>, $system<DoubleDouble>, $method>,
            ],
            step: $crate::probe::one_step::<$system<Counted<f64>>, $method>,
            drift: [
                $crate::probe::drift::<$system<Counted<f64>>, $method>,
                $crate::probe::drift::<$system<Counted<f32>>, $method>,
            ],
            sample: [
                $crate::probe::sample::<$system<Counted<f64>>, $method>,
                $crate::probe::sample::<$system<Counted<f32>>, $method>,
            ],
        }
    };
}
pub(crate) use dial;

/// One step: how many iterations it takes.
///
/// # Errors
/// Whatever it is refused for.
pub fn one_step<S: Scene, M: Method<S>>(setup: &Setup) -> Result<u32, Error> {
    let stepper = S::of(setup).into_stepper_by::<M>(S::Scalar::from_f64(setup.h))?;
    let start = S::start(setup, &stepper)?;
    let (next, iterations) = iterations(|| stepper.step(&start));
    next.map(|_| iterations)
}

/// A run of S, and of P in 31 digits beside it.
pub fn beside<S: Scene, P: Scene<Scalar = DoubleDouble>, M: Method<S> + Method<P>>(
    setup: &Setup,
    steps: u64,
    is_compared: bool,
) -> Cell {
    let mut cell = run::<S, M>(setup, steps);
    if is_compared && cell.outcome.is_ok() {
        let precise = run::<P, M>(&setup.rounded::<S::Scalar>(), steps);
        if precise.outcome.is_ok() {
            cell.precise = distance(&cell.last, &precise.last);
        }
    }
    cell
}

/// `steps` steps, watched.
fn run<S: Scene, M: Method<S>>(setup: &Setup, steps: u64) -> Cell {
    let begin = || {
        let stepper = S::of(setup).into_stepper_by::<M>(S::Scalar::from_f64(setup.h))?;
        let start = S::start(setup, &stepper)?;
        Ok((stepper, start))
    };
    let (stepper, start) = match begin() {
        Ok(begun) => begun,
        Err(error) => return Cell::new(Err(error), f64::NAN),
    };
    let mut watch = Watch::new(&stepper, &start);
    let mut state = start;
    for step in 0..steps {
        let (next, iterations) = iterations(|| stepper.step(&state));
        watch.cell.iterations = watch.cell.iterations.max(iterations);
        match next {
            Ok(next) => state = next,
            Err(error) => {
                watch.cell.outcome = Err(error);
                break;
            }
        }
        watch.cell.steps = step + 1;
        watch.observe(&stepper, &state);
    }
    watch.cell.last = S::numbers(&state);
    watch.cell
}

/// What is followed during a run.
struct Watch {
    cell: Cell,
    energy: f64,
    conserved: [f64; 3],
    /// The largest |N| so far, or 1.
    size: f64,
}

impl Watch {
    fn new<S: Scene, M: Method<S>>(stepper: &Stepper<S, M>, start: &State<S, M>) -> Self {
        let mut cell = Cell::new(Ok(()), 0.0);
        cell.residual = if has_equation::<S, M>() { 0.0 } else { f64::NAN };
        let size = start.momentum().max_abs().to_f64();
        let energy = stepper.energy(start).to_f64();
        Self { cell, energy, conserved: S::conserved(stepper, start), size: if size > 0.0 { size } else { 1.0 } }
    }

    fn observe<S: Scene, M: Method<S>>(&mut self, stepper: &Stepper<S, M>, state: &State<S, M>) {
        let raise = |largest: &mut f64, value: f64| {
            // NaN is kept
            if value > *largest || value.is_nan() {
                *largest = value;
            }
        };
        let change = (stepper.energy(state).to_f64() - self.energy).abs();
        let scale = if self.energy == 0.0 { 1.0 } else { self.energy.abs() };
        raise(&mut self.cell.energy, change / scale);
        raise(&mut self.size, state.momentum().max_abs().to_f64());
        for (now, then) in S::conserved(stepper, state).into_iter().zip(self.conserved) {
            raise(&mut self.cell.momentum, (now - then).abs() / self.size);
        }
        raise(&mut self.cell.constraint, stepper.system().orbit_defect(state.configuration()).to_f64());
        if has_equation::<S, M>()
            && let Some(missed) = residual(stepper, state)
        {
            raise(&mut self.cell.residual, missed);
        }
    }
}

/// Whether a step is that of one equation F⁻ℓd(q, F) = N.
fn has_equation<S: Scene, M: Method<S>>() -> bool {
    M::ORDER == 2
}

/// |F⁻ℓd(q, F) − N| for the F that the next step finds, over the larger one of |N| and |F⁺ℓd(q, F)|; `None` where it finds none.
fn residual<S: Scene, M: Method<S>>(stepper: &Stepper<S, M>, state: &State<S, M>) -> Option<f64> {
    let (q, n) = (state.configuration(), state.momentum());
    let f = stepper.inverse_legendre(q, &n).ok()?;
    let found = stepper.legendre(q, &f);
    let size = n.max_abs().to_f64().max(stepper.legendre_next(q, &f).max_abs().to_f64());
    Some(if size == 0.0 { 0.0 } else { found.zip_map(&n, |found, n| found - n).max_abs().to_f64() / size })
}

/// The largest difference, of configurations (of the order of one), and of the momentum over its size.
fn distance(one: &[f64], other: &[f64]) -> f64 {
    let place = one.len() - 3;
    let size = other[place..].iter().fold(f64::MIN_POSITIVE, |max, x| max.max(x.abs()));
    let differences = one.iter().zip(other).enumerate();
    differences.fold(0.0, |max, (i, (a, b))| f64::max(max, (a - b).abs() / if i < place { 1.0 } else { size }))
}

/// Observations between two marks.
const OBSERVATIONS: u64 = 100;

/// A long run.
///
/// # Errors
/// That of the step which was refused.
pub fn drift<S: Scene, M: Method<S>>(setup: &Setup, marks: &[u64]) -> Result<Vec<Drift>, Error> {
    let stepper = S::of(setup).into_stepper_by::<M>(S::Scalar::from_f64(setup.h))?;
    let mut state = S::start(setup, &stepper)?;
    let first = Watch::new(&stepper, &state);
    let (mut drifts, mut steps) = (Vec::new(), 0);
    for &mark in marks {
        let (mut sums, begin) = ([0.0; 3], steps);
        for part in 1..=OBSERVATIONS {
            let goal = begin + (mark - begin) * part / OBSERVATIONS;
            state = stepper.advance(&state, (goal - steps) as usize)?;
            steps = goal;
            let mut watch = Watch { cell: first.cell.clone(), ..first };
            watch.observe(&stepper, &state);
            let Cell { energy, momentum, constraint, .. } = watch.cell;
            for (sum, x) in sums.iter_mut().zip([energy, momentum, constraint]) {
                *sum += x * x;
            }
        }
        let [energy, momentum, constraint] = sums.map(|sum| (sum / OBSERVATIONS as f64).sqrt());
        drifts.push(Drift { steps: mark, energy, momentum, constraint });
    }
    Ok(drifts)
}

/// One step from each of `states` random states of a body: its attitude, any direction, and h|ω| of any size from 1e-8 to ten.
pub fn sample<S: Scene, M: Method<S>>(setup: &Setup, states: u64, seed: u64, sample: &mut Sample) {
    sample.iterations.resize(64, 0);
    let Ok(stepper) = S::of(setup).into_stepper_by::<M>(S::Scalar::from_f64(setup.h)) else {
        sample.others += states;
        return;
    };
    let (mut random, size) = (Random::new(seed), setup.momentum.norm());
    for number in 0..states {
        let part = 10.0_f64.powf(random.between(-8.0, 1.0));
        let setup = Setup { momentum: random.direction() * (size * part), ..setup.clone() };
        let Ok(start) = S::start(&setup, &stepper) else {
            sample.others += 1;
            continue;
        };
        let (next, count) = iterations(|| stepper.step(&start));
        match next {
            Ok(next) => {
                sample.done += 1;
                sample.iterations[count.min(63) as usize] += 1;
                sample.most = sample.most.max(count);
                sample.hidden += u64::from(!is_finite(&next));
                if number % 100 == 0 && has_equation::<S, M>() && setup.h * setup.velocity().norm() < 1.0 {
                    sample.missed = sample.missed.max(residual(&stepper, &start).unwrap_or(0.0));
                }
                continue;
            }
            Err(Error::Unsolvable { .. }) => sample.too_long += 1,
            Err(Error::NotConverged { .. }) => sample.not_converged += 1,
            Err(_) => sample.others += 1,
        }
        sample.most_refused = sample.most_refused.max(count);
    }
}

fn is_finite<S: Scene, M: Method<S>>(state: &State<S, M>) -> bool {
    state.configuration().is_finite() && state.momentum().is_finite()
}
