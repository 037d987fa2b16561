//! Section 2.6: a potential that no expression holds.

use clebsch::Clebsch;
use clebsch_tests::fixtures::harmonics::Harmonics;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::stepping::Stepping;
use nalgebra::Vector3;

use crate::{H, NEAR, assert_reversible, assert_says};

/// The same potential as an expression, for the coefficients that are not zero below.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<3>, x: Vector3| x + a,
    cost      = |h, a| self.mass * a.norm_squared() / (2 * h),
    potential = |x| {
        let s = x.norm_squared();
        self.linear * x.z + self.quadratic * s + self.cubic * s * x.z + self.quartic * s.powi(2)
    },
)]
pub struct Polynomial {
    pub mass: f64,
    pub linear: f64,
    pub quadratic: f64,
    pub cubic: f64,
    pub quartic: f64,
}

#[test]
fn opaque_potential() {
    let random = &mut Random::new(241);
    assert_says::<Harmonics>(&["solved explicitly", "half kick, drift, half kick"]);
    let polynomial = Polynomial { mass: 0.9, linear: 0.4, quadratic: 0.7, cubic: -0.2, quartic: 0.1 };
    let mut coefficients = [[0.0; 4]; 4];
    (coefficients[0][1], coefficients[1][0], coefficients[1][1], coefficients[2][0]) = (0.4, 0.7, -0.2, 0.1);
    let harmonics = Harmonics { mass: 0.9, coefficients };
    let (x, p) = (random.vector::<3>(), random.vector::<3>());
    let gradient = harmonics.geopotential_gradient(&x);
    let slope = |i: usize| {
        let at = |e: f64| harmonics.geopotential(&(x + Vector3::ith(i, e)));
        (8.0 * (at(1e-3) - at(-1e-3)) - (at(2e-3) - at(-2e-3))) / 12e-3
    };
    assert_near(&gradient, &Vector3::new(slope(0), slope(1), slope(2)), 1e-10, "value and gradient belong together");
    let kick = harmonics.impulse(&harmonics.step_constants(H).expect("a satellite"), 0.0, &x, &nalgebra::zero());
    assert_near(&kick, &(-gradient * (H / 2.0)), NEAR, "−h/2 ∇V");
    let (one, other) = (harmonics.stepper(H).expect("a satellite"), polynomial.stepper(H).expect("a satellite"));
    let (mut a, mut b) = (one.state(x, p).expect("a state"), other.state(x, p).expect("a state"));
    for _ in 0..200 {
        (a, b) = (one.step(&a).expect("a step"), other.step(&b).expect("a step"));
        assert_near(a.configuration(), b.configuration(), NEAR, "x");
        assert_near(&a.momentum(), &b.momentum(), NEAR, "p");
        assert!((one.energy(&a) - other.energy(&b)).abs() < NEAR, "the energy");
    }
    assert_reversible(&harmonics, x, p);
    let start = one.cotangent_state(x, p).expect("a state");
    let up = one.step_symmetric(&start).expect("a step");
    let state = one.step(&one.state(x, p).expect("a state")).expect("a step");
    assert_near(up.covector(), &state.momentum(), NEAR, "the symmetric representation");
}
