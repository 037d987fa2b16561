//! The benchmark of many bodies: `RUSTFLAGS="-C target-cpu=native" cargo bench -p clebsch-tests --bench ensemble`.
//!
//! 1024 bodies: nanoseconds for each body and step, stepped one after the other and in lanes, in turn in the same run. *Blocks* advance a
//! few bodies by 100 steps before the next, *sweeps* all bodies by one. Without the flag above the registers are those of the oldest
//! processor of the architecture.

#[path = "../steps/timing.rs"]
mod timing;

use clebsch::{Body, Clebsch, F64x4, F64x8, Scalar, Space, State, Stepper};
use nalgebra::{Matrix3, Quaternion, Vector3};
use std::cell::RefCell;
use timing::{Run, interleaved};

/// Bodies of each ensemble.
const BODIES: usize = 1024;
/// Steps of a block.
const BLOCK: u64 = 100;
/// The step size, s.
const H: f64 = 0.01;

/// A rigid body that turns freely.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = moser_veselov,
)]
pub struct FreeBody<T: Scalar> {
    /// Principal moments of inertia, kg·m².
    pub moments: Vector3<T>,
}

/// The same body with its attitude as a unit quaternion.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SU<2>, q: SU<2>| q * F,
    cost   = |h, F| 2 * F.imag().dot(&(self.inertia * F.imag())) / h,
)]
pub struct FreeQuaternion<T: Scalar> {
    /// Inertia tensor, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
}

/// A point on a sphere in uniform gravity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.mass * self.length.powi(2) * (F - I).norm_squared() / (4 * h),
    potential = |q| self.mass * self.gravity * self.length * q.z,
)]
pub struct Pendulum<T: Scalar> {
    /// Mass of the bob, kg.
    pub mass: T,
    /// Length of the rod, m.
    pub length: T,
    /// g, m/s².
    pub gravity: T,
}

/// Numbers in all lanes.
fn number<T: Scalar>(value: f64) -> T {
    T::from_f64(value)
}

fn body<T: Scalar>() -> Stepper<FreeBody<T>> {
    FreeBody { moments: Vector3::new(1.0, 2.0, 3.0).map(number) }.into_stepper(number(H)).expect("a body")
}

fn quaternion<T: Scalar>() -> Stepper<FreeQuaternion<T>> {
    FreeQuaternion { inertia: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)).map(number) }
        .into_stepper(number(H))
        .expect("a body")
}

fn pendulum<T: Scalar>() -> Stepper<Pendulum<T>> {
    Pendulum { mass: number(1.0), length: number(1.0), gravity: number(1.0) }
        .into_stepper(number(H))
        .expect("a pendulum")
}

fn main() {
    println!("Time of a step of one of {BODIES} bodies, ns; ratio to one after the other\n");
    println!("{:22} {:20} {:>8} {:>8} {:>6}", "", "", "least", "median", "ratio");
    let momentum = |i: usize| Vector3::new(0.3, 2.0, 0.6 + i as f64 * 1e-4);
    compare("free body", body(), body(), body(), &|i| (Matrix3::identity(), momentum(i)));
    let unit = Quaternion::new(1.0, 0.0, 0.0, 0.0);
    compare("free body, quaternion", quaternion(), quaternion(), quaternion(), &|i| (unit, momentum(i) * 2.0));
    let start = |i: usize| (Vector3::y(), Vector3::new(1.0, 0.0, 0.5 + i as f64 * 1e-4));
    compare("spherical pendulum", pendulum(), pendulum(), pendulum(), &start);
}

/// Times all ways to step the same bodies.
fn compare<One, Four, Eight>(
    name: &str,
    one: Stepper<One>,
    four: Stepper<Four>,
    eight: Stepper<Eight>,
    start: &dyn Fn(usize) -> Body<One>,
) where
    One: Clebsch<Scalar = f64, Configuration: Space<f64, Lane = One::Configuration>> + Clone,
    One: Clebsch<Momentum: Space<f64, Lane = One::Momentum>>,
    Four: Clebsch<Scalar = F64x4, Configuration: Space<F64x4, Lane = One::Configuration>> + Clone,
    Four: Clebsch<Momentum: Space<F64x4, Lane = One::Momentum>>,
    Eight: Clebsch<Scalar = F64x8, Configuration: Space<F64x8, Lane = One::Configuration>> + Clone,
    Eight: Clebsch<Momentum: Space<F64x8, Lane = One::Momentum>>,
{
    let starts: Vec<_> = (0..BODIES).map(start).collect();
    let one = one_by_one(one, &starts);
    let four = RefCell::new(four.ensemble(starts.clone()).expect("bodies"));
    let eight = RefCell::new(eight.ensemble(starts.clone()).expect("bodies"));
    for (setting, together) in [("blocks", BLOCK), ("sweeps", 1)] {
        let contestants: Vec<Run<'_>> = vec![
            Box::new(|rounds| one(rounds, together)),
            Box::new(|rounds| (0..rounds).for_each(|_| four.borrow_mut().advance(together))),
            Box::new(|rounds| (0..rounds).for_each(|_| eight.borrow_mut().advance(together))),
        ];
        let times = interleaved(&contestants);
        for (how, time) in ["one by one", "lanes of 4", "lanes of 8"].into_iter().zip(&times) {
            let [least, median] = [time.least, time.median].map(|time| time / (BODIES as u64 * together) as f64);
            let ratio = time.least / times[0].least;
            println!("{name:22} {:20} {least:8.2} {median:8.2} {ratio:6.2}", format!("{how}, {setting}"));
        }
    }
    assert_eq!(eight.borrow().failures().count(), 0);
}

/// Rounds through all bodies, so many steps of each before the next.
fn one_by_one<S: Clebsch<Scalar = f64>>(
    stepper: Stepper<S>,
    starts: &[(S::Configuration, S::Momentum)],
) -> impl Fn(u64, u64) {
    let states = starts.iter().map(|&(q, mu)| stepper.state(q, mu).expect("a state"));
    let states: RefCell<Vec<State<S>>> = RefCell::new(states.collect());
    move |rounds, together| {
        for _ in 0..rounds {
            for state in states.borrow_mut().iter_mut() {
                for _ in 0..together {
                    *state = stepper.step(state).expect("a step");
                }
            }
        }
    }
}
