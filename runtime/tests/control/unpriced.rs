//! Guesses that cost nothing and violate bounds: neither their price nor its unit tells the cost of satisfying a bound.

use crate::bounded::Bounded;
use crate::linear::bounded_integrator;
use crate::quadratic::dense;
use clebsch::{Control, Controlled, Error, Target};
use nalgebra::{SMatrix, Vector2};
use std::vec;
use std::vec::Vec;

/// The least inputs that these rows map to the lacks, and their multipliers.
fn least(h: f64, steps: usize, rows: &[Vec<f64>], lacks: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / h;
    let gramian = rows.iter().map(|a| rows.iter().map(|b| product(a, b)).collect()).collect();
    let multipliers = dense(gramian, lacks.to_vec());
    let input = |k: usize| rows.iter().zip(&multipliers).map(|(row, multiplier)| row[k] * multiplier).sum::<f64>() / h;
    ((0..steps).map(input).collect(), multipliers)
}

/// The share of the inputs of double integrators in x_k.
fn row_of_place(h: f64, steps: usize, k: usize) -> Vec<f64> {
    (0..steps).map(|j| if j < k { h * h * (k as f64 - j as f64 - 0.5) } else { 0.0 }).collect()
}

/// The inputs from (0, 1) on that satisfy x_k ≤ wall at least price. That one or two bounds push is found by trying.
/// The conditions of Karush, Kuhn and Tucker prove it, as the problem is convex.
fn stopped(h: f64, steps: usize, wall: f64) -> Option<Vec<f64>> {
    let rows: Vec<Vec<f64>> = (0..steps).map(|k| row_of_place(h, steps, k)).collect();
    let place = |k: usize, inputs: &[f64]| h * k as f64 + rows[k].iter().zip(inputs).map(|(b, u)| b * u).sum::<f64>();
    let pairs = (1..steps).flat_map(|i| (i..steps).map(move |j| if i == j { vec![i] } else { vec![i, j] }));
    pairs.into_iter().find_map(|pushing| {
        let chosen: Vec<Vec<f64>> = pushing.iter().map(|&k| rows[k].clone()).collect();
        let lacks: Vec<f64> = pushing.iter().map(|&k| wall - h * k as f64).collect();
        let (inputs, multipliers) = least(h, steps, &chosen, &lacks);
        let is_kept = (0..steps).all(|k| place(k, &inputs) <= wall + 1e-12);
        (is_kept && multipliers.iter().all(|multiplier| *multiplier < 0.0)).then_some(inputs)
    })
}

/// (x, v) under x ≤ wall, at the price scale · h u²/2.
fn walled(h: f64, scale: f64, wall: f64) -> Bounded {
    let mut system = bounded_integrator(h);
    system.input_price *= scale;
    system.bound_place = SMatrix::<f64, 2, 2>::new(1.0, 0.0, -1.0, 0.0);
    system.bound_input = SMatrix::<f64, 2, 1>::new(0.0, 0.0);
    system.bound = Vector2::new(wall, 9.0);
    system
}

/// Solves from guesses u whose price is this part of the least one, in many units of it, and compares with its inputs.
fn is_found_from_nothing(
    h: f64,
    expected: &[f64],
    target: Target<Vector2<f64>>,
    system: impl Fn(f64) -> Bounded,
) -> Result<(), Error> {
    let price = expected.iter().map(|u| h * u * u / 2.0).sum::<f64>();
    let units = [1.0, 1e-6, 1e6, 1e-3, 1e3, 1e-100, 1e100];
    let parts = [0.0, 1e-9, 1e-300, 1e-12, 1e-3];
    let (units, parts) = if cfg!(miri) { (&units[..1], &parts[..1]) } else { (&units[..], &parts[..]) };
    for scale in units {
        for part in parts {
            for sign in [1.0, -1.0] {
                let guess = sign * (2.0 * part * price / (h * expected.len() as f64)).sqrt();
                let control: Control<_, 2, 1, 2> = system(*scale).control(h)?;
                let start = Vector2::new(0.0, 1.0);
                let stage = control.stage(&start).with_input(SMatrix::<f64, 1, 1>::new(guess));
                let mut plan = vec![stage; expected.len()];
                let found = control.solve(&start, target, &mut plan)?;
                let error = found.price() / scale - price;
                assert!(error.abs() < 1e-11 * price, "{scale:e}, {part:e}: {found:?} after {price}");
                for (stage, u) in found.stages().iter().zip(expected) {
                    assert!((stage.input()[0] - u).abs() < 1e-6, "{} after {u}", stage.input()[0]);
                }
                assert!(found.is_minimum() && found.iterations() <= 40, "{scale:e}, {part:e}: {found:?}");
            }
        }
    }
    Ok(())
}

/// Whoever does nothing pays nothing, and passes the wall.
#[test]
fn guesses_without_a_price_keep_bounds_of_the_place() -> Result<(), Error> {
    let plans = [(0.1, 20), (0.2, 8), (0.05, 40)];
    for (h, steps) in plans.into_iter().skip(usize::from(cfg!(miri))).take(if cfg!(miri) { 1 } else { 3 }) {
        for wall in [0.3, 0.25, 0.77] {
            let expected = stopped(h, steps, wall).unwrap();
            is_found_from_nothing(h, &expected, Target::Free, |scale| walled(h, scale, wall))?;
        }
    }
    Ok(())
}

#[test]
fn guesses_without_a_price_keep_bounds_of_the_input() -> Result<(), Error> {
    for side in [1.0, -1.0] {
        let expected = vec![0.5 * side; if cfg!(miri) { 4 } else { 20 }];
        is_found_from_nothing(0.1, &expected, Target::Free, |scale| {
            let mut system = bounded_integrator(0.1);
            system.input_price *= scale;
            system.bound = if side > 0.0 { Vector2::new(2.0, -0.5) } else { Vector2::new(-0.5, 2.0) };
            system
        })?;
    }
    Ok(())
}

/// To (Nh, 1), where one drifts to, but with the last place between 0.05 nearer than on that way.
#[test]
fn guesses_without_a_price_lead_to_targets_within_bounds() -> Result<(), Error> {
    let (h, steps) = (0.1, 20);
    let end = h * steps as f64;
    let rows = [row_of_place(h, steps, steps - 1), row_of_place(h, steps, steps), vec![h; steps]];
    let (expected, multipliers) = least(h, steps, &rows, &[-0.05, 0.0, 0.0]);
    assert!(multipliers[0] < 0.0, "the wall pushes");
    let goal = Vector2::new(end, 1.0);
    is_found_from_nothing(h, &expected, Target::Place(goal), |scale| walled(h, scale, end - h - 0.05))
}

/// A place that no input moves is passed at no price, and not allowed; one that is on a bound is.
#[test]
fn plans_without_a_price_are_refused_for_their_bounds() -> Result<(), Error> {
    let h = 0.1;
    for (wall, guess) in [(0.05, 0.0), (0.05, 1e-9), (0.1 - 1e-6, 0.0)] {
        let mut system = walled(h, 1.0, wall);
        system.b[0] = 0.0;
        let control: Control<_, 2, 1, 2> = system.control(h)?;
        let start = Vector2::new(0.0, 1.0);
        let mut plan = [control.stage(&start).with_input(SMatrix::<f64, 1, 1>::new(guess)); 10];
        let error = control.solve(&start, Target::Free, &mut plan).unwrap_err();
        let expected = |violation: f64| (violation - (h - wall)).abs() < 1e-12;
        assert!(
            matches!(error, Error::Infeasible { stage: 1, bound: "the bound", violation } if expected(violation)),
            "{error}"
        );
    }
    let control: Control<_, 2, 1, 2> = walled(h, 1.0, 0.3).control(h)?;
    let start = Vector2::new(0.3, 0.0);
    let mut plan = [control.stage(&start); 10];
    let found = control.solve(&start, Target::Free, &mut plan)?;
    assert!(found.price() == 0.0 && found.iterations() <= 2 && found.end() == &start, "{found:?}");
    Ok(())
}

/// Where nothing has a price, any plan within bounds is as good.
#[test]
fn bounds_are_kept_where_nothing_has_a_price() -> Result<(), Error> {
    let h = 0.1;
    let control: Control<_, 2, 1, 2> = walled(h, 0.0, 0.3).control(h)?;
    let start = Vector2::new(0.0, 1.0);
    let mut plan = [control.stage(&start); 20];
    let found = control.solve(&start, Target::Free, &mut plan)?;
    assert!(found.price() == 0.0 && found.stages().iter().all(|stage| stage.place()[0] <= 0.3), "{found:?}");
    Ok(())
}
