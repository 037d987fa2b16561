//! The comparison of a derived integrator with the oracle: its declaration once more as a [`Problem`], and a trajectory
//! from the same start.

use clebsch::Clebsch;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::sided_pair::SidedPair;
use clebsch_tests::oracle::precise::double_double::DoubleDouble;
use clebsch_tests::oracle::precise::group::so;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::{Factor, Problem, left, right};
use clebsch_tests::oracle::precise::real::Real;
use clebsch_tests::oracle::precise::step::{State, deviation, trajectory};
use clebsch_tests::oracle::random::Random;
use nalgebra::Vector6;

const H: f64 = 0.05;
const STEPS: usize = 100;

/// Rounding errors of numbers near one over a hundred steps; a wrong sign or factor is above 1e-3.
const NEAR: f64 = 1e-12;

/// The parameters are the fields of the fixture: numbers in `f64` that the oracle takes exactly.
struct PreciseTop(HeavyTop);

impl Problem for PreciseTop {
    fn factors(&self) -> Vec<Factor> {
        vec![right(so(3))]
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        vec![&q[0] * &f[0]]
    }
    fn cost<R: Real>(&self, _t: R, h: R, _q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        let change = &f[0] - Matrix::identity(3);
        (Matrix::from(&self.0.mass_matrix).lift() * &change * change.transpose()).trace() / (h * 2.0)
    }
    fn potential<R: Real>(&self, _t: R, q: &[Matrix<R>]) -> R {
        (&q[0] * Matrix::from(&self.0.center).lift())[(2, 0)] * self.0.weight
    }
}

#[test]
fn a_derived_trajectory_of_one_body() {
    let mut random = Random::new(1);
    let top = HeavyTop { mass_matrix: random.inertia(), weight: 1.3, center: random.vector() };
    let stepper = top.clone().stepper(H).expect("a top");
    let start = stepper.state(random.attitude(), random.vector()).expect("an attitude");
    let derived: Vec<_> = std::iter::successors(Some(start), |state| stepper.step(state).ok())
        .take(STEPS + 1)
        .map(|state| State { q: vec![Matrix::from(state.configuration())], n: state.momentum().as_slice().to_vec() })
        .collect();
    let oracle = trajectory(&PreciseTop(top), DoubleDouble::of(H), &derived[0].lift(), STEPS).unwrap();
    let distance = deviation(&oracle, &derived);
    assert!(distance < NEAR, "{distance:e}");
    assert!(deviation(&oracle[1..], &derived[..STEPS]) > 1e-3, "a step later is elsewhere");
}

/// One factor acts from the right and one from the left.
struct PrecisePair;

impl Problem for PrecisePair {
    fn factors(&self) -> Vec<Factor> {
        vec![right(so(3)), left(so(3))]
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        vec![&q[0] * &f[0], &f[1] * &q[1]]
    }
    fn cost<R: Real>(&self, _t: R, h: R, _q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        let identity = Matrix::identity(3);
        ((&f[0] - &identity).norm_squared() + (&f[1] - &identity).norm_squared()) / (h * 4.0)
    }
}

#[test]
fn a_derived_trajectory_of_two_sides() {
    let mut random = Random::new(2);
    let stepper = SidedPair.stepper(H).expect("a pair");
    let (r, q) = (random.attitude(), nalgebra::Vector3::z());
    let start = stepper.state((r, q), Vector6::new(0.5, -0.3, 0.8, 0.7, -0.2, 0.0)).expect("a momentum in 𝔤_q^⊥");
    let derived: Vec<_> = std::iter::successors(Some(start), |state| stepper.step(state).ok())
        .take(STEPS + 1)
        .map(|state| {
            let (r, q) = state.configuration();
            State { q: vec![Matrix::from(r), Matrix::from(q)], n: state.momentum().as_slice().to_vec() }
        })
        .collect();
    let oracle = trajectory(&PrecisePair, DoubleDouble::of(H), &derived[0].lift(), STEPS).unwrap();
    let distance = deviation(&oracle, &derived);
    assert!(distance < NEAR, "{distance:e}");
}

/// Neither a missing state nor a number that is none passes for agreement.
#[test]
fn deviation_is_infinite_where_something_is_missing() {
    let state = |x: f64| State { q: vec![Matrix::vector(&[x])], n: vec![1.0] };
    let oracle = [state(1.0).lift::<DoubleDouble>(), state(2.0).lift()];
    assert_eq!(deviation(&oracle, &[state(1.0), state(2.5)]), 0.5);
    assert_eq!(deviation(&oracle, &[state(1.0)]), f64::INFINITY);
    assert_eq!(deviation(&oracle, &[state(1.0), state(f64::NAN)]), f64::INFINITY);
    let short = State { q: vec![], n: vec![1.0] };
    assert_eq!(deviation(&oracle, &[state(1.0), short]), f64::INFINITY);
}
