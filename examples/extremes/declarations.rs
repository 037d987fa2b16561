//! Four scenes, each declared with several dials, over any scalar.

use crate::motion::{Moving, Scene};
use crate::probe::{Dial, LongRun, dial, long_run};
use crate::setup::Setup;
use clebsch::{Clebsch, Declared, DoubleDouble, Error, Method, Real, State, Stepper};
use clebsch_examples::counted::Counted;
use nalgebra::{Matrix3, Vector3, Vector6};

fn matrix<T: Real>(entries: &Matrix3<f64>) -> Matrix3<T> {
    entries.map(T::from_f64)
}

fn vector<T: Real>(entries: &Vector3<f64>) -> Vector3<T> {
    entries.map(T::from_f64)
}

fn diagonal<T: Real>(moments: &[f64; 3]) -> Matrix3<T> {
    Matrix3::from_diagonal(&Vector3::from(*moments).map(T::from_f64))
}

/// The state of a body with the attitude and the momentum of the setup.
fn at_attitude<T: Real, S, M: Method<S>>(setup: &Setup, stepper: &Stepper<S, M>) -> Result<State<S, M>, Error>
where
    S: Clebsch<Scalar = T, Configuration = Matrix3<T>, Momentum = Vector3<T>>,
{
    stepper.state(matrix(&setup.attitude), vector(&setup.momentum))
}

/// R row by row, then π.
fn numbers_of_body<T: Real>(r: &Matrix3<T>, pi: &Vector3<T>) -> Vec<f64> {
    r.transpose().iter().chain(pi.iter()).map(|x| x.to_f64()).collect()
}

pub struct BodyMoserVeselov;
pub struct BodyCayley;
pub struct BodyExponential;
pub struct BodyProjection;
pub struct BodyExact;
pub struct BodyCollocated;
pub struct BodyCompensated;
pub struct SolvedByNewton;
pub struct SolvedByFixedPoint;
pub struct SolvedToTolerance;
pub struct SolvedInFour;
pub struct SolvedInExponentials;

/// A body that nothing acts on; only its own rotation is known.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    method BodyMoserVeselov = (discretization = moser_veselov),
    method BodyCayley       = (discretization = cayley),
    method BodyExponential  = (discretization = exponential),
    method BodyProjection   = (discretization = projection),
    method BodyExact        = (discretization = exact),
    method BodyCollocated   = (order = 16),
    method BodyCompensated  = (discretization = moser_veselov, summation = compensated),
    method SolvedByNewton       = (discretization = cayley, solver = newton),
    method SolvedByFixedPoint   = (discretization = cayley, solver = fixed_point),
    method SolvedToTolerance    = (discretization = cayley, tolerance = 1e-6),
    method SolvedInFour         = (discretization = cayley, iterations = 4),
    method SolvedInExponentials = (discretization = moser_veselov, chart = exponential),
)]
pub struct Body<T: clebsch::Scalar> {
    /// Inertia tensor about the centre of mass, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
}

impl<T: Real> Scene for Body<T> {
    fn of(setup: &Setup) -> Self {
        Self { inertia: diagonal(&setup.moments) }
    }
    fn start<M: Method<Self>>(setup: &Setup, stepper: &Stepper<Self, M>) -> Result<State<Self, M>, Error> {
        at_attitude(setup, stepper)
    }
    fn numbers<M: Method<Self>>(state: &State<Self, M>) -> Vec<f64> {
        numbers_of_body(state.configuration(), &state.momentum())
    }
    fn conserved<M: Method<Self>>(stepper: &Stepper<Self, M>, state: &State<Self, M>) -> [f64; 3] {
        stepper.conserved(state).values().map(|value| value.to_f64())
    }
}

/// The free body.
pub fn bodies() -> Vec<Dial> {
    vec![
        dial!("moser_veselov", "free body", Body, BodyMoserVeselov),
        dial!("cayley", "free body", Body, BodyCayley),
        dial!("exponential", "free body", Body, BodyExponential),
        dial!("projection", "free body", Body, BodyProjection),
        dial!("exact", "free body", Body, BodyExact),
        dial!("order = 16", "free body", Body, BodyCollocated),
        dial!("compensated", "free body", Body, BodyCompensated),
    ]
}

/// The free body by Cayley's map, with the dials of how its equation is solved.
pub fn solves() -> Vec<Dial> {
    vec![
        dial!("newton", "free body", Body, SolvedByNewton),
        dial!("fixed_point", "free body", Body, SolvedByFixedPoint),
        dial!("tolerance = 1e-6", "free body", Body, SolvedToTolerance),
        dial!("iterations = 4", "free body", Body, SolvedInFour),
        dial!("chart = exponential", "free body", Body, SolvedInExponentials),
    ]
}

pub struct TopMoserVeselov;
pub struct TopCayley;
pub struct TopExact;
pub struct TopEighth;
pub struct TopCollocated;
pub struct TopCompensated;

/// A body turning about a pivot in uniform gravity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |R| self.weight * (R * self.center).z,
    method TopMoserVeselov = (discretization = moser_veselov),
    method TopCayley       = (discretization = cayley),
    method TopExact        = (discretization = exact, order = 4),
    method TopEighth       = (discretization = moser_veselov, order = 8),
    method TopCollocated   = (order = 16),
    method TopCompensated  = (discretization = moser_veselov, summation = compensated),
)]
pub struct Top<T: clebsch::Scalar> {
    /// Inertia tensor about the pivot, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    /// m·g, N.
    pub weight: T,
    /// Centre of mass in the body frame, m.
    pub center: Vector3<T>,
}

impl<T: Real> Scene for Top<T> {
    fn of(setup: &Setup) -> Self {
        Self { inertia: diagonal(&setup.moments), weight: T::from_f64(setup.weight), center: vector(&setup.arm) }
    }
    fn start<M: Method<Self>>(setup: &Setup, stepper: &Stepper<Self, M>) -> Result<State<Self, M>, Error> {
        at_attitude(setup, stepper)
    }
    fn numbers<M: Method<Self>>(state: &State<Self, M>) -> Vec<f64> {
        numbers_of_body(state.configuration(), &state.momentum())
    }
    fn conserved<M: Method<Self>>(stepper: &Stepper<Self, M>, state: &State<Self, M>) -> [f64; 3] {
        [stepper.conserved(state).values()[0].to_f64(), 0.0, 0.0]
    }
}

/// The heavy top.
pub fn tops() -> Vec<Dial> {
    vec![
        dial!("moser_veselov", "heavy top", Top, TopMoserVeselov),
        dial!("cayley", "heavy top", Top, TopCayley),
        dial!("exact, order 4", "heavy top", Top, TopExact),
        dial!("moser_veselov, order 8", "heavy top", Top, TopEighth),
        dial!("order = 16", "heavy top", Top, TopCollocated),
        dial!("compensated", "heavy top", Top, TopCompensated),
    ]
}

pub struct PendulumCompensated;
pub struct PendulumExponential;
pub struct PendulumCollocated;

/// A bob on a rigid massless rod, by the chord of the rotation of a step.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.inertia * (F - I).norm_squared() / (4 * h),
    potential = |q| self.weight * self.arm * q.z,
    method PendulumCompensated = (summation = compensated),
)]
pub struct Chord<T: clebsch::Scalar> {
    /// m·l², kg·m².
    pub inertia: T,
    /// m·g, N.
    pub weight: T,
    /// Length of the rod, m.
    pub arm: T,
}

/// The same bob by its Lagrangian.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, q: Unit<Vector3>| F * q,
    lagrangian = |omega| self.inertia * omega.dot(&omega) / 2,
    potential  = |q| self.weight * self.arm * q.z,
    method PendulumExponential = (discretization = exponential, order = 4),
    method PendulumCollocated  = (order = 16),
)]
pub struct Pendulum<T: clebsch::Scalar> {
    /// m·l², kg·m².
    pub inertia: T,
    /// m·g, N.
    pub weight: T,
    /// Length of the rod, m.
    pub arm: T,
}

/// The state of a bob that points along the third column of the attitude.
fn level<T: Real, S, M: Method<S>>(setup: &Setup, stepper: &Stepper<S, M>) -> Result<State<S, M>, Error>
where
    S: Clebsch<Scalar = T, Configuration = Vector3<T>, Momentum = Vector3<T>>,
{
    let q = vector(&setup.attitude.column(2).into_owned());
    stepper.project(q, vector(&setup.momentum))
}

fn numbers_of_bob<T: Real>(q: &Vector3<T>, n: &Vector3<T>) -> Vec<f64> {
    q.iter().chain(n.iter()).map(|x| x.to_f64()).collect()
}

impl<T: Real> Scene for Chord<T> {
    fn of(setup: &Setup) -> Self {
        let [inertia, weight, arm] = [setup.moments[0], setup.weight, setup.arm.norm()].map(T::from_f64);
        Self { inertia, weight, arm }
    }
    fn start<M: Method<Self>>(setup: &Setup, stepper: &Stepper<Self, M>) -> Result<State<Self, M>, Error> {
        level(setup, stepper)
    }
    fn numbers<M: Method<Self>>(state: &State<Self, M>) -> Vec<f64> {
        numbers_of_bob(state.configuration(), &state.momentum())
    }
    fn conserved<M: Method<Self>>(stepper: &Stepper<Self, M>, state: &State<Self, M>) -> [f64; 3] {
        [stepper.conserved(state).values()[0].to_f64(), 0.0, 0.0]
    }
}

impl<T: Real> Scene for Pendulum<T> {
    fn of(setup: &Setup) -> Self {
        let [inertia, weight, arm] = [setup.moments[0], setup.weight, setup.arm.norm()].map(T::from_f64);
        Self { inertia, weight, arm }
    }
    fn start<M: Method<Self>>(setup: &Setup, stepper: &Stepper<Self, M>) -> Result<State<Self, M>, Error> {
        level(setup, stepper)
    }
    fn numbers<M: Method<Self>>(state: &State<Self, M>) -> Vec<f64> {
        numbers_of_bob(state.configuration(), &state.momentum())
    }
    fn conserved<M: Method<Self>>(stepper: &Stepper<Self, M>, state: &State<Self, M>) -> [f64; 3] {
        [stepper.conserved(state).values()[0].to_f64(), 0.0, 0.0]
    }
}

/// The spherical pendulum.
pub fn pendulums() -> Vec<Dial> {
    vec![
        dial!("chord", "spherical pendulum", Chord, Declared),
        dial!("exponential, order 4", "spherical pendulum", Pendulum, PendulumExponential),
        dial!("order = 16", "spherical pendulum", Pendulum, PendulumCollocated),
        dial!("compensated", "spherical pendulum", Chord, PendulumCompensated),
    ]
}

pub struct SeriesCompensated;

/// Two bobs in series on rods of one length: the cost couples configuration and group element.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |(F, G): (SO<3>, SO<3>), (p, q): (Unit<Vector3>, Unit<Vector3>)| (F * p, G * q),
    cost      = |h, (p, q), (F, G)| {
        let separate = (F - I).norm_squared() + (G - I).norm_squared() / 2;
        self.inertia * (separate + 2 * (F * p - p).dot(&(G * q - q))) / (2 * h)
    },
    potential = |(p, q)| self.weight * self.arm * (2 * p.z + q.z),
    method SeriesCompensated = (summation = compensated),
)]
pub struct Series<T: clebsch::Scalar> {
    /// m·l² of each bob, kg·m².
    pub inertia: T,
    /// m·g of each bob, N.
    pub weight: T,
    /// Length of each rod, m.
    pub arm: T,
}

impl<T: Real> Scene for Series<T> {
    fn of(setup: &Setup) -> Self {
        let [inertia, weight, arm] = [setup.moments[0], setup.weight, setup.arm.norm()].map(T::from_f64);
        Self { inertia, weight, arm }
    }
    fn start<M: Method<Self>>(setup: &Setup, stepper: &Stepper<Self, M>) -> Result<State<Self, M>, Error> {
        let q = [2, 0].map(|column| vector(&setup.attitude.column(column).into_owned()));
        let n = vector(&setup.momentum);
        stepper.project(q.into(), Vector6::from_iterator(n.iter().chain(&n).copied()))
    }
    fn numbers<M: Method<Self>>(state: &State<Self, M>) -> Vec<f64> {
        let (p, q) = state.configuration();
        p.iter().chain(q).chain(&state.momentum()).map(|x| x.to_f64()).collect()
    }
    fn conserved<M: Method<Self>>(stepper: &Stepper<Self, M>, state: &State<Self, M>) -> [f64; 3] {
        [stepper.conserved(state).values()[0].to_f64(), 0.0, 0.0]
    }
}

/// The double pendulum.
pub fn series() -> Vec<Dial> {
    vec![
        dial!("chords", "double pendulum", Series, Declared),
        dial!("compensated", "double pendulum", Series, SeriesCompensated),
    ]
}

/// The scenes that run for long, in order.
pub fn long_runs() -> Vec<LongRun> {
    vec![
        long_run!("moser_veselov", "free body", Body, BodyMoserVeselov),
        long_run!("exact", "free body", Body, BodyExact),
        long_run!("compensated", "free body", Body, BodyCompensated),
        long_run!("moser_veselov", "heavy top", Top, TopMoserVeselov),
        long_run!("exact, order 4", "heavy top", Top, TopExact),
        long_run!("compensated", "heavy top", Top, TopCompensated),
        long_run!("chord", "spherical pendulum", Chord, Declared),
        long_run!("exponential, order 4", "spherical pendulum", Pendulum, PendulumExponential),
        long_run!("compensated", "spherical pendulum", Chord, PendulumCompensated),
    ]
}
