//! Shortest ways on groups that are driven in two of three directions.

use crate::assert_near;
use crate::group::{Group, attitude, heisenberg, unicycle};
use clebsch::{Control, Controlled, Error, Optimum, Stage, Target};
use core::f64::consts::PI;
use nalgebra::{Matrix3, SVector, Vector2, Vector3};
use std::vec;
use std::vec::Vec;

type Plan = Vec<Stage<Group<2>, 3, 2, 0>>;

/// From rest at the identity to exp(goal) in the time 1.
fn shortest<R>(
    system: &Group<2>,
    goal: [f64; 3],
    steps: usize,
    guess: impl Fn(usize) -> Vector2<f64>,
    look: impl Fn(&Optimum<'_, Group<2>, 3, 2, 0>) -> R,
) -> Result<R, Error> {
    let goal = system.exp(&goal);
    let control: Control<_, 3, 2, 0> = system.clone().control(1.0 / steps as f64)?;
    let start = Matrix3::identity();
    let mut plan: Plan = (0..steps).map(|k| control.stage(&start).with_input(guess(k))).collect();
    let found = control.solve(&start, Target::Place(goal), &mut plan)?;
    assert_near!(found.end(), goal, 1e-12);
    assert_critical(system, found.stages(), &goal);
    Ok(look(&found))
}

/// The gradient h u of the price is normal to all changes of the inputs that keep the end, by differences of roll-outs.
fn assert_critical(system: &Group<2>, stages: &[Stage<Group<2>, 3, 2, 0>], goal: &Matrix3<f64>) {
    let h = 1.0 / stages.len() as f64;
    let inputs: Vec<Vector2<f64>> = stages.iter().map(|stage| *stage.input()).collect();
    let back = goal.try_inverse().unwrap();
    let end = |changed: usize, change: Vector2<f64>| {
        let mut x = Matrix3::identity();
        for (k, input) in inputs.iter().enumerate() {
            let input = if k == changed { input + change } else { *input };
            x *= system.exp((input * h).as_slice());
        }
        let off = back * x - Matrix3::identity();
        system.coordinates(&(off - off * off / 2.0))
    };
    let step = 1e-5;
    let slopes: Vec<[Vector3<f64>; 2]> = (0..inputs.len())
        .map(|k| [0, 1].map(|j| (end(k, Vector2::ith(j, step)) - end(k, Vector2::ith(j, -step))) / (2.0 * step)))
        .collect();
    let gram: Matrix3<f64> = slopes.iter().flatten().map(|row| row * row.transpose()).sum();
    let product: Vector3<f64> =
        slopes.iter().zip(&inputs).map(|(row, u)| row[0] * (u.x * h) + row[1] * (u.y * h)).sum();
    let multiplier = gram.try_inverse().unwrap() * product;
    for (row, input) in slopes.iter().zip(&inputs) {
        for j in 0..2 {
            let rest = input[j] * h - row[j].dot(&multiplier);
            assert!(rest.abs() < 1e-9 * (1.0 + input.norm()), "{rest:e}");
        }
    }
}

fn rest(_: usize) -> SVector<f64, 2> {
    Vector2::zeros()
}

/// From standing still: by symmetry no first derivative leads sideways. No other guess does better.
#[test]
#[cfg_attr(miri, ignore = "too long to interpret: exponentials of jets, by series")]
fn a_car_parks_sideways() -> Result<(), Error> {
    let (car, goal) = (unicycle(), [0.0, 0.0, 1.0]);
    let (price, iterations) = shortest(&car, goal, 40, rest, |found| {
        assert!(found.is_minimum(), "{found:?}");
        (found.price(), found.iterations())
    })?;
    assert!(iterations <= 40, "{iterations}");
    for trial in 1..8 {
        let guess = |k: usize| {
            let phase = f64::from(trial) * 1.7 + k as f64 * (0.05 + 0.04 * f64::from(trial));
            Vector2::new(phase.sin() * 2.0, (phase * 1.3).cos() * 3.0)
        };
        let other = shortest(&car, goal, 40, guess, |found| found.price())?;
        assert!(other > price - 1e-9, "{other} after {price}");
    }
    Ok(())
}

/// The last corrections shrink by their square, and a solution is known for one.
#[test]
#[cfg_attr(miri, ignore = "too long to interpret: exponentials of jets, by series")]
fn a_car_goes_and_goes_again() -> Result<(), Error> {
    let car = unicycle();
    let iterations = shortest(&car, [1.0, 0.7, 0.3], 40, rest, |found| found.iterations())?;
    assert!(iterations <= 8, "{iterations}");
    let control: Control<_, 3, 2, 0> = car.clone().control(0.025)?;
    let (start, goal) = (Matrix3::identity(), car.exp(&[1.0, 0.7, 0.3]));
    let mut plan = vec![control.stage(&start); 40];
    let price = control.solve(&start, Target::Place(goal), &mut plan)?.price();
    let again = control.solve(&start, Target::Place(goal), &mut plan)?;
    assert!(again.iterations() <= 2 && (again.price() - price).abs() < 1e-14, "{again:?}");
    let beside = car.exp(&[1e-3, -2e-3, 1e-3]);
    let near = control.solve(&beside, Target::Place(goal), &mut plan)?;
    assert!(near.iterations() <= 5, "{near:?}");
    Ok(())
}

/// The regular polygon: with the area z in N steps the price is 2 N z tan(π/N), which is 2πz, a circle, in the limit.
#[test]
fn the_heisenberg_geodesic_is_a_polygon() -> Result<(), Error> {
    let polygons = [(3, 1.0), (5, -0.3), (40, 1.0), (100, 20.0)];
    for (steps, area) in polygons.into_iter().take(if cfg!(miri) { 1 } else { 4 }) {
        let n = steps as f64;
        let expected = 2.0 * n * f64::abs(area) * (PI / n).tan();
        shortest(&heisenberg(), [0.0, 0.0, area], steps, rest, |found| {
            assert!((found.price() - expected).abs() < 1e-12 * expected, "{found:?} after {expected}");
            // turned polygons are as good: the index is 0, not the pivot
            assert!(found.is_minimum() && found.iterations() <= 40, "{found:?}");
        })?;
    }
    Ok(())
}

/// A turn by θ about the axis that is not driven costs θ(4π − θ)/2 in the limit, approached to second order.
#[test]
#[cfg_attr(miri, ignore = "too long to interpret: exponentials of jets, by series")]
fn attitudes_turn_about_the_axis_that_is_not_driven() -> Result<(), Error> {
    let angle = 2.5;
    let limit = angle * (4.0 * PI - angle) / 2.0;
    let excess = |steps| shortest(&attitude(), [0.0, 0.0, angle], steps, rest, |found| found.price() - limit);
    let (coarse, fine) = (excess(20)?, excess(40)?);
    let order = (coarse / fine).log2();
    assert!((order - 2.0).abs() < 0.05, "{order} from {coarse} and {fine}");
    shortest(&attitude(), [0.2, 0.5, 1.0], 40, rest, |found| assert!(found.is_minimum(), "{found:?}"))
}

/// p_k = Aᵀp_{k+1} and hu + Bᵀp_{k+1} = 0, also where the guess was the solution without its costates.
#[test]
#[cfg_attr(miri, ignore = "too long to interpret: exponentials of jets, by series")]
fn costates_are_those_of_the_plan() -> Result<(), Error> {
    let (car, steps) = (unicycle(), 400);
    let h = 1.0 / steps as f64;
    let control: Control<_, 3, 2, 0> = car.clone().control(h)?;
    let (start, goal) = (Matrix3::identity(), car.exp(&[0.4, 1.1, 0.8]));
    let mut plan = vec![control.stage(&start); steps];
    let price = control.solve(&start, Target::Place(goal), &mut plan)?.price();
    let mut again: Plan = plan.iter().map(|stage| control.stage(&start).with_input(*stage.input())).collect();
    let again = control.solve(&start, Target::Place(goal), &mut again)?;
    assert!((again.price() - price).abs() < 1e-13 && again.iterations() <= 3, "{again:?}");
    let size = again.final_costate().norm();
    assert!(size > 1.0);
    let mut next = *again.final_costate();
    for stage in again.stages().iter().rev() {
        let step = car.expand(&h, 0.0, stage.place(), stage.input(), &next)?;
        assert_near!(stage.input() * h + step.by_input.transpose() * next, Vector2::zeros(), 1e-13 * size);
        assert_near!(*stage.costate(), step.by_place.transpose() * next, 1e-14 * size);
        next = *stage.costate();
    }
    Ok(())
}

/// Many steps do not keep a car from parking.
#[test]
#[cfg_attr(miri, ignore = "too long to interpret: exponentials of jets, by series")]
fn a_car_parks_in_many_steps() -> Result<(), Error> {
    for steps in [100, 200, 400] {
        let (price, iterations) =
            shortest(&unicycle(), [0.0, 0.0, 1.0], steps, rest, |found| (found.price(), found.iterations()))?;
        assert!(iterations <= 60 && price > 5.579, "{iterations}");
    }
    Ok(())
}
