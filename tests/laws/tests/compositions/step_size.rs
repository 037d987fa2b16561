//! `Stepper::suggest_step_size`: the step size that it gives makes the wished error, within a factor of 4, over several times the probing run.
//!
//! Errors are the largest at ten times, against equations of motion in matrices.

#[cfg(feature = "heavy")]
mod bodies;

use crate::flat;
#[cfg(feature = "heavy")]
use crate::systems::sixth;
use crate::systems::{eighth, first, fourth, second};
use clebsch::{Clebsch, Error};
use clebsch_tests::oracle::motion::motion;
use nalgebra::{Matrix3, SVector, Vector3};

/// Times at which errors are taken.
const SAMPLES: usize = 10;
/// How far the error may be from the wished one, as a ratio.
const RATIO: f64 = 4.0;

/// Configurations and momenta of the exact motion at the samples, in the numbers of the error.
type Exact<const N: usize> = [SVector<f64, N>; SAMPLES];

/// The exact motion with so many small steps a sample, from the numbers `start`.
fn exact<const N: usize>(
    field: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    start: SVector<f64, N>,
    duration: f64,
    steps: usize,
) -> Exact<N> {
    let mut y = start;
    std::array::from_fn(|_| {
        y = motion(&field, y, duration / SAMPLES as f64, steps);
        y
    })
}

/// Asks for the errors and makes the motions with the answers; `h` is the step of the probing run.
fn assert_error<S: Clebsch<Scalar = f64, Input = ()> + Clone, const N: usize>(
    system: &S,
    start: (S::Configuration, S::Momentum),
    (duration, h): (f64, f64),
    exact: &Exact<N>,
    flat: impl Fn(&S::Configuration, &S::Momentum) -> SVector<f64, N>,
) {
    for wished in [1e-3, 1e-6, 1e-9] {
        if wished < 1e-6 && S::ORDER == 2 {
            continue; // some 10⁷ steps
        }
        let stepper = system.stepper(h).expect("a regular system");
        let begin = stepper.state(start.0, start.1).expect("a state");
        let suggested = stepper.suggest_step_size(&begin, wished, duration).expect("a step size");
        let steps = (duration / SAMPLES as f64 / suggested).round().max(1.0);
        let h = duration / SAMPLES as f64 / steps;
        let stepper = system.stepper(h).expect("a regular system");
        // a whole number of steps goes to a sample: long steps change by an eighth, and their error by half of it
        let expected = wished * (h / suggested).powi(S::ORDER as i32);
        let (mut state, mut error) = (stepper.state(start.0, start.1).expect("a state"), 0.0_f64);
        for exact in exact {
            for _ in 0..steps as u64 {
                state = stepper.step(&state).expect("a solvable step");
            }
            error = error.max((flat(state.configuration(), &state.momentum()) - exact).amax());
        }
        println!("{} of order {}: wished {wished:.0e}, h = {suggested:.2e}, error {error:.1e}", S::NAME, S::ORDER);
        assert!(error < RATIO * expected && error > expected / RATIO, "{} of order {}: {error:.1e}", S::NAME, S::ORDER);
    }
}

/// q̇ = N × q, Ṅ = −q × e₃ gravity over 100 s; momenta are in units of the first.
fn swinging((q, n): (Vector3<f64>, Vector3<f64>), gravity: f64) -> Exact<6> {
    let size = n.norm();
    let field = |y: &SVector<f64, 6>| {
        let (q, n): (Vector3<f64>, Vector3<f64>) =
            (Vector3::new(y[0], y[1], y[2]), Vector3::new(y[3], y[4], y[5]) * size);
        flat(&[n.cross(&q).as_slice(), (-q.cross(&Vector3::z()) * (gravity / size)).as_slice()])
    };
    exact(field, flat(&[q.as_slice(), (n / size).as_slice()]), 100.0, 1000)
}

#[test]
fn a_pendulum() {
    let (start, gravity) = ((Vector3::y(), Vector3::new(1.0, 0.0, 0.5)), 1.0);
    let (size, exact) = (start.1.norm(), swinging(start, gravity));
    let flat = |q: &Vector3<f64>, n: &Vector3<f64>| flat(&[q.as_slice(), (n / size).as_slice()]);
    assert_error(&second::Pendulum { gravity }, start, (100.0, 0.25), &exact, flat);
    assert_error(&fourth::Pendulum { gravity }, start, (100.0, 0.25), &exact, flat);
    #[cfg(feature = "heavy")]
    assert_error(&sixth::Pendulum { gravity }, start, (100.0, 0.25), &exact, flat);
    assert_error(&eighth::Pendulum { gravity }, start, (100.0, 0.25), &exact, flat);
}

/// The error of order 1 is h, which does not grow, and h² t: the answer errs to the short side.
#[test]
fn steps_of_order_1_are_short_enough() {
    let (start, gravity) = ((Vector3::y(), Vector3::new(1.0, 0.0, 0.5)), 1.0);
    let (stepper, wished) = (first::Pendulum { gravity }.into_stepper(0.1).expect("a regular system"), 1e-2);
    let begin = stepper.state(start.0, start.1).expect("a state");
    let h = stepper.suggest_step_size(&begin, wished, 100.0).expect("a step size");
    let end = |h: f64| {
        let stepper = first::Pendulum { gravity }.into_stepper(h).expect("a regular system");
        let state = stepper.state(start.0, start.1).expect("a state");
        let last = stepper.trajectory(state).nth((100.0 / h).round() as usize).expect("an endless trajectory");
        *last.expect("a solvable step").configuration()
    };
    let h = 100.0 / (100.0 / h).round();
    let [.., last] = swinging(start, gravity);
    let error = (end(h) - last.fixed_rows::<3>(0)).norm();
    println!("order 1: wished {wished:.0e}, h = {h:.2e}, error {error:.1e}");
    assert!(error < wished && error > wished / 30.0, "{error:.1e}");
}

#[test]
fn what_cannot_be_had_is_refused() -> Result<(), Error> {
    let stepper = second::Pendulum { gravity: 1.0 }.into_stepper(0.1)?;
    let start = stepper.state(Vector3::y(), Vector3::new(1.0, 0.0, 0.5))?;
    for error in [0.0, -1.0, 1e-17, f64::NAN] {
        let refused = stepper.suggest_step_size(&start, error, 100.0);
        assert!(matches!(refused, Err(Error::BelowRounding { .. })), "{error}: {refused:?}");
    }
    for duration in [0.0, f64::NAN, f64::INFINITY] {
        let refused = stepper.suggest_step_size(&start, 1e-3, duration);
        assert!(matches!(refused, Err(Error::NotFinite { .. })), "{duration}: {refused:?}");
    }
    Ok(())
}

#[test]
fn motions_without_an_error_take_the_longest_step_and_back_in_time_the_sign_stays() -> Result<(), Error> {
    // a great circle: the direction is exact, but not the speed along it, so that only rest has no error
    let still = second::Pendulum { gravity: 0.0 }.into_stepper(0.1)?;
    let rest = still.state(Vector3::y(), Vector3::zeros())?;
    assert!((still.suggest_step_size(&rest, 1e-6, 100.0)? - 1.6).abs() < 1e-12, "a quarter of 64 steps");

    let (forward, back) =
        (second::Pendulum { gravity: 1.0 }.into_stepper(0.25)?, second::Pendulum { gravity: 1.0 }.into_stepper(-0.25)?);
    let state = |stepper: &clebsch::Stepper<second::Pendulum>| stepper.state(Vector3::y(), Vector3::new(1.0, 0.0, 0.5));
    let there = forward.suggest_step_size(&state(&forward)?, 1e-6, 100.0)?;
    let and_back = back.suggest_step_size(&state(&back)?, 1e-6, 100.0)?;
    assert!(and_back < 0.0 && -and_back / there < 10.0 && -there / and_back < 10.0, "{there} {and_back}");
    Ok(())
}

#[test]
fn a_probing_run_that_is_too_coarse_to_be_solved_is_made_finer() -> Result<(), Error> {
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 1.5, 2.0));
    let top = fourth::Top { inertia, weight: 1.0, center: Vector3::z() };
    let coarse = top.stepper(1.0)?;
    let start = coarse.state(Matrix3::identity(), Vector3::new(0.1, 0.3, 10.0))?;
    assert!(coarse.step(&start).is_err(), "five radians in a step");
    let h = coarse.suggest_step_size(&start, 1e-6, 50.0)?;
    assert!(top.stepper(h)?.step(&start).is_ok() && h < 0.1, "{h}");
    Ok(())
}
