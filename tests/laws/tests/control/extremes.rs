//! NaN, infinities and numbers from the least to the largest in every input of a plan. The plan is finite and satisfies
//! its bounds, or there is an error that says so without such numbers. The guess is given back.

use super::few;
use clebsch::{Controlled, Error, Space, Target};
use clebsch_tests::fixtures::regulator::Regulator;
use clebsch_tests::fixtures::unicycle::Unicycle;
use nalgebra::{Matrix3, SVector, Vector1, Vector2};

const EXTREMES: [f64; 13] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    5e-324,
    -5e-324,
    1e-300,
    1e-150,
    1e150,
    -1e150,
    1e300,
    -1e300,
    f64::MAX,
];

/// A plan and the numbers that make it: parameters, step size, start, target, guessed input.
trait Case<const D: usize, const U: usize, const C: usize>: Controlled<D, U, C, Scalar = f64> {
    fn ordinary() -> Vec<f64>;
    fn of(numbers: &[f64]) -> (Self, f64, Self::Place, Self::Place, SVector<f64, U>);
}

impl Case<2, 1, 0> for Regulator {
    fn ordinary() -> Vec<f64> {
        vec![1.3, 2.0, 0.5, 0.1, 1.0, -0.4, 0.2, 0.1, 0.3]
    }
    fn of(numbers: &[f64]) -> (Self, f64, Vector2<f64>, Vector2<f64>, Vector1<f64>) {
        let &[mass, stiffness, price, h, x, v, to, at, u] = numbers else { panic!("nine numbers") };
        (Regulator { mass, stiffness, price }, h, Vector2::new(x, v), Vector2::new(to, at), Vector1::new(u))
    }
}

impl Case<3, 2, 3> for Unicycle {
    fn ordinary() -> Vec<f64> {
        vec![1.0, 3.0, 0.1, 2.0, 0.5, 0.2, 0.1, 0.0, 0.0, 1.0, 0.3, 0.1, 0.5]
    }
    fn of(numbers: &[f64]) -> (Self, f64, Matrix3<f64>, Matrix3<f64>, Vector2<f64>) {
        let &[turn_price, top_turn, time_price, miss_price, x, y, h, from, start, to, side, turn, drive] = numbers
        else {
            panic!("thirteen numbers")
        };
        let place = |x: f64, y: f64| Matrix3::new(1.0, 0.0, x, 0.0, 1.0, y, 0.0, 0.0, 1.0);
        let system = Unicycle { turn_price, top_turn, time_price, miss_price, goal: Vector2::new(x, y) };
        (system, h, place(from, start), place(to, side), Vector2::new(turn, drive))
    }
}

/// The mistake in the plan of these numbers, if there is one, and whether it was found.
fn judge<S: Case<D, U, C>, const D: usize, const U: usize, const C: usize>(
    numbers: &[f64],
    is_free: bool,
) -> Result<bool, String> {
    let (system, h, start, goal, guess) = S::of(numbers);
    let refused = |error: Error| {
        let text = error.to_string().replace("look for NaN, infinity", "");
        // a step size is told as it was given
        let is_given = text.contains("singular") || matches!(error, Error::StepSize { .. });
        match ["NaN", "inf"].iter().any(|number| text.contains(number)) && !is_given {
            true => Err(format!("the error says {text}")),
            false => Ok(false),
        }
    };
    let control = match system.control(h) {
        Ok(control) => control,
        Err(error) => return refused(error),
    };
    let target = if is_free { Target::Free } else { Target::Place(goal) };
    let mut plan = [control.stage(&start).with_input(guess); 6];
    let found = match control.solve(&start, target, &mut plan) {
        Ok(optimum) => optimum,
        Err(error) => {
            let is_same = |stage: &clebsch::Stage<S, D, U, C>| {
                stage.input().iter().zip(&guess).all(|(a, b)| a.to_bits() == b.to_bits())
            };
            return if plan.iter().all(is_same) { refused(error) } else { Err("the guess is lost".into()) };
        }
    };
    let numbers = [found.price(), found.residual(), found.gap()];
    if !(numbers.iter().all(|number| number.is_finite()) && found.end().all_finite()) {
        return Err(format!("price, residual and gap are {numbers:?}"));
    }
    for (k, stage) in found.stages().iter().enumerate() {
        let is_finite = [
            stage.input().all_finite(),
            stage.costate().all_finite(),
            stage.multipliers().all_finite(),
            stage.gain().all_finite(),
        ];
        if is_finite != [true; 4] {
            return Err(format!("stage {k}: input, costate, multipliers, gain are finite: {is_finite:?}"));
        }
        let constants = control.system().prepare(h).map_err(|error| error.to_string())?;
        let bounds = control.system().bounds(&constants, h * k as f64, stage.place(), stage.input());
        let bounds = bounds.map_err(|error| error.to_string())?;
        // where numbers are lost relative to the bound
        let scale = 1.0 + stage.input().amax();
        if bounds.iter().any(|bound| *bound > 1e-12 * scale) {
            return Err(format!("stage {k}: bounds {bounds:?}"));
        }
    }
    Ok(true)
}

/// All of them, or four of thirteen at even distances and one more.
fn extremes() -> impl Iterator<Item = f64> {
    EXTREMES.into_iter().step_by(EXTREMES.len() / few(EXTREMES.len()).max(4))
}

fn check<S: Case<D, U, C>, const D: usize, const U: usize, const C: usize>() {
    let (ordinary, mut failures, mut found) = (S::ordinary(), Vec::new(), 0);
    for is_free in [false, true] {
        assert_eq!(judge::<S, D, U, C>(&ordinary, is_free), Ok(true), "the ordinary plan");
        for place in 0..ordinary.len() {
            for extreme in extremes() {
                let mut numbers = ordinary.clone();
                numbers[place] = extreme;
                match judge::<S, D, U, C>(&numbers, is_free) {
                    Ok(is_found) => found += usize::from(is_found),
                    Err(what) => failures.push(format!("number {place} is {extreme:e}, free {is_free}: {what}")),
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} failures, {found} found\n{}", failures.len(), failures.join("\n"));
    assert!(found * EXTREMES.len() > 20 * extremes().count(), "{found} found");
}

#[test]
fn a_regulator_of_extreme_numbers() {
    check::<Regulator, 2, 1, 0>();
}

#[test]
fn a_unicycle_of_extreme_numbers() {
    check::<Unicycle, 3, 2, 3>();
}
