//! The continuous limit, and costs that depend on the time.

use clebsch_tests::oracle::precise::double_double::DoubleDouble;
use clebsch_tests::oracle::precise::energy::{continuous_lagrangian, energy};
use clebsch_tests::oracle::precise::group::{so, translation};
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::{Factor, Problem, left};
use clebsch_tests::oracle::precise::real::Real;
use clebsch_tests::oracle::precise::step::{State, composed_step, step};

use super::systems::{HeavyTop, Placement, height};

/// ½π·J⁻¹π + 0.8 s with J = (1, 1.4, 0.9).
#[test]
fn energy_of_the_heavy_top() {
    let attitude = so(3).combination(&[0.3, 0.2, -0.1].map(DoubleDouble::of)).exponential();
    let momentum = [0.5, -0.3, 0.8].map(DoubleDouble::of);
    let inertia = [(1, 1), (14, 10), (9, 10)].map(|(a, b)| DoubleDouble::ratio(a, b));
    let kinetic = momentum.iter().zip(inertia).fold(DoubleDouble::zero(), |sum, (&m, j)| sum + m * m / j * 0.5);
    let expected = kinetic + height(&attitude) * DoubleDouble::ratio(8, 10);
    let found = energy(&HeavyTop(Placement::End), DoubleDouble::zero(), &[attitude], &momentum).unwrap();
    assert!((found - expected).size() < 1e-25, "{:e}", (found - expected).size());
}

/// A particle of mass t pulled by V = t x, K = t a²/(2h) with the mass at the start of the step.
struct GrowingParticle;

impl Problem for GrowingParticle {
    fn factors(&self) -> Vec<Factor> {
        vec![left(translation(1))]
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        vec![&q[0] + f[0].translation()]
    }
    fn cost<R: Real>(&self, t: R, h: R, _q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        t * f[0].translation().norm_squared() / (h * 2.0)
    }
    fn potential<R: Real>(&self, t: R, q: &[Matrix<R>]) -> R {
        t * q[0][(0, 0)]
    }
}

fn particle(x: f64, p: f64) -> State<DoubleDouble> {
    State { q: vec![Matrix::vector(&[DoubleDouble::of(x)])], n: vec![DoubleDouble::of(p)] }
}

#[track_caller]
fn assert_particle(state: &State<DoubleDouble>, x: f64, p: f64) {
    assert!((state.q[0][(0, 0)] - DoubleDouble::of(x)).size() < 1e-30, "{state:?}");
    assert!((state.n[0] - DoubleDouble::of(p)).size() < 1e-30, "{state:?}");
}

/// From t = 1 with h = ½: half a kick −h/2·t, the drift h p/t, half a kick −h/2·(t + h).
#[test]
fn the_time_of_costs_is_that_of_the_start_and_of_potentials_that_of_the_configuration() {
    let next = step(&GrowingParticle, DoubleDouble::of(0.5), DoubleDouble::one(), &particle(3.0, 2.0)).unwrap();
    assert_particle(&next, 3.0 + 0.5 * 1.75, 1.75 - 0.25 * 1.5);
}

/// The same followed by its adjoint, which has the mass at its end, t + 2h = 2.
#[test]
fn a_composed_step_halves_the_time() {
    let next = composed_step(&GrowingParticle, DoubleDouble::one(), DoubleDouble::one(), &particle(3.0, 2.0)).unwrap();
    let middle = 1.75 - 2.0 * 0.25 * 1.5;
    assert_particle(&next, 3.0 + 0.5 * 1.75 + 0.5 * middle / 2.0, middle - 0.25 * 2.0);
}

/// ℓ(t, x, v) = t v²/2 − t x.
#[test]
fn continuous_lagrangian_of_the_growing_particle() {
    let (t, x, v) = (DoubleDouble::of(0.5), DoubleDouble::of(3.0), DoubleDouble::of(4.0));
    let found = continuous_lagrangian(&GrowingParticle, t, &[Matrix::vector(&[x])], &[v]);
    assert!((found - DoubleDouble::of(4.0 - 1.5)).size() < 1e-25);
}
