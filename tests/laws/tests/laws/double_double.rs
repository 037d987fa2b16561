//! Steps in 31 digits: conserved quantities stay to 1e-30, the order shows where `f64` sees nothing, and the error of
//! `f64` is round-off.

use clebsch::{Clebsch, DoubleDouble, Scalar, State, Stepper};
use nalgebra::{Matrix3, Vector3};

/// A heavy top over any scalar.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
)]
struct Top<T: Scalar> {
    #[clebsch(symmetric)]
    mass_matrix: Matrix3<T>,
    weight: T,
    center: Vector3<T>,
}

/// The chart of the exponential, whose series ends later for more digits.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = exponential,
)]
struct Body<T: Scalar> {
    moments: Vector3<T>,
}

/// A number as a fraction, so that it is right to all digits.
fn tenths<T: Scalar>(count: i64) -> T {
    T::from_ratio(count, 10)
}

fn top<T: Scalar>(h: T) -> Stepper<Top<T>> {
    let mass_matrix = Matrix3::new(12, 1, -2, 1, 8, 1, -2, 1, 5).map(tenths);
    let top = Top { mass_matrix, weight: tenths(30), center: Vector3::new(1, -2, 7).map(tenths) };
    top.into_stepper(h).expect("parameters")
}

fn start<T: Scalar>(stepper: &Stepper<Top<T>>) -> State<Top<T>> {
    stepper.state(Matrix3::identity(), Vector3::new(1, -7, 20).map(tenths)).expect("a state")
}

fn after<S: Clebsch>(stepper: &Stepper<S>, mut state: State<S>, steps: u32) -> State<S> {
    for step in 1..=steps {
        state = stepper.step(&state).unwrap_or_else(|error| panic!("step {step}: {error}"));
    }
    state
}

/// The largest entry of |RᵀR − I|, and the change of the spatial momentum, of the vector or along gravity.
#[test]
fn momenta_and_rotations_are_kept_to_thirty_digits() {
    let stepper = top::<DoubleDouble>(tenths(1));
    let first = start(&stepper);
    let last = after(&stepper, first, 1000);
    let vertical = |state: &State<Top<DoubleDouble>>| (state.configuration() * state.momentum()).z;
    let change = (vertical(&last) - vertical(&first)).to_f64();
    assert!(change.abs() < 1e-28, "{change:e}");
    assert!(stepper.system().orbit_defect(last.configuration()).to_f64() < 1e-28);

    let body =
        Body { moments: Vector3::new(10, 20, 25).map(tenths::<DoubleDouble>) }.into_stepper(tenths(1)).expect("a body");
    let first = body.state(Matrix3::identity(), Vector3::new(1, 20, 3).map(tenths)).expect("a state");
    let last = after(&body, first, 1000);
    let change = (last.configuration() * last.momentum() - first.momentum()).map(|x| x.to_f64());
    assert!(change.norm() < 1e-28, "{change}");
    assert!(body.system().orbit_defect(last.configuration()).to_f64() < 1e-28);
}

/// Two steps of h/2 against one of h: the difference is h³ times a constant, down to differences of 1e-20 in numbers of order one.
#[test]
fn the_order_shows_where_doubles_see_nothing() {
    let difference = |h: DoubleDouble| {
        let half = h / DoubleDouble::from(2.0);
        let (whole, halves) = (top(h), top(half));
        let (a, b) = (after(&whole, start(&whole), 1), after(&halves, start(&halves), 2));
        (a.configuration() - b.configuration()).map(|x| x.to_f64()).norm()
    };
    let sizes = [1, 2, 4].map(|divisor| DoubleDouble::from_ratio(1, 1_000_000 * divisor));
    let [coarse, middle, fine] = sizes.map(difference);
    assert!(coarse < 1e-15 && fine > 1e-21, "{coarse:e} {fine:e}");
    for ratio in [coarse / middle, middle / fine] {
        assert!((ratio - 8.0).abs() < 1e-3, "{ratio}");
    }
}

/// The same steps in doubles: their error is rounding, which no more than adds up.
#[test]
fn errors_of_doubles_are_round_off() {
    let (double, pair) = (top::<f64>(0.125), top::<DoubleDouble>(DoubleDouble::from(0.125)));
    // parameters that doubles have exactly
    let exact = |stepper: &Stepper<Top<f64>>| Top {
        mass_matrix: stepper.system().mass_matrix.map(DoubleDouble::from),
        weight: DoubleDouble::from(stepper.system().weight),
        center: stepper.system().center.map(DoubleDouble::from),
    };
    let pair_of_double = exact(&double).into_stepper(pair.step_size()).expect("parameters");
    let (mut a, b) = (start(&double), start(&double));
    let mut b = pair_of_double
        .state(b.configuration().map(DoubleDouble::from), b.momentum().map(DoubleDouble::from))
        .expect("a state");
    let mut worst = 0.0_f64;
    for _ in 0..100 {
        (a, b) = (after(&double, a, 1), after(&pair_of_double, b, 1));
        let difference = a.momentum().map(DoubleDouble::from) - b.momentum();
        worst = worst.max(difference.map(|x| x.to_f64()).norm());
    }
    assert!((1e-17..1e-12).contains(&worst), "{worst:e}");
}

/// A step too long is refused in the same words.
#[test]
fn failures_are_those_of_doubles() {
    let (double, pair) = (top::<f64>(2.0), top::<DoubleDouble>(DoubleDouble::from(2.0)));
    let errors = (double.step(&start(&double)), pair.step(&start(&pair)));
    match errors {
        (
            Err(clebsch::Error::Unsolvable { solvable_fraction: a, .. }),
            Err(clebsch::Error::Unsolvable { solvable_fraction: b, .. }),
        ) => {
            assert!((a - b).abs() < 2e-3 * a, "{a} {b}");
        }
        others => panic!("{others:?}"),
    }
}
