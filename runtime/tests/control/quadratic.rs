//! Quadratic prices of linear systems: Gramians, Riccati's recursion, dense solutions.

use crate::assert_near;
use crate::linear::{Linear, double_integrator};
use clebsch::{Control, Controlled, Error, Target};
use nalgebra::{Matrix2, Matrix4x2, SMatrix, Vector1, Vector2, Vector4};
use proptest::prelude::*;
use std::vec;
use std::vec::Vec;

/// u_k = B·(Aᵀ)^(N−1−k) W⁻¹ (goal − A^N x) / h with the Gramian W.
#[test]
fn the_least_energy_is_that_of_the_gramian() -> Result<(), Error> {
    let (h, steps) = (0.1, 30);
    let system = double_integrator::<0>(h);
    let (start, goal) = (Vector2::new(1.0, -0.5), Vector2::new(3.0, 0.25));
    let mut columns: Vec<Vector2<f64>> =
        core::iter::successors(Some(system.b), |column| Some(system.a * column)).take(steps).collect();
    columns.reverse();
    let gramian: Matrix2<f64> = columns.iter().map(|b| b * b.transpose() / h).sum();
    let drift = core::iter::successors(Some(start), |x| Some(system.a * x)).nth(steps).unwrap();
    let multiplier = gramian.try_inverse().unwrap() * (goal - drift);
    let control = system.clone().control(h)?;
    let mut plan = vec![control.stage(&start); steps];
    let found = control.solve(&start, Target::Place(goal), &mut plan)?;
    for (stage, b) in found.stages().iter().zip(&columns) {
        assert!((stage.input()[0] - b.dot(&multiplier) / h).abs() < 1e-13);
    }
    assert!((found.price() - multiplier.dot(&(goal - drift)) / 2.0).abs() < 1e-13);
    assert_near!(found.final_costate(), -multiplier, 1e-12);
    assert_near!(found.end(), goal, 1e-13);
    assert!(found.iterations() <= 3 && found.is_minimum() && found.residual() < 1e-13, "{found:?}");
    Ok(())
}

/// Only the position is asked for: the end is passed at any velocity, with no costate of it.
#[test]
fn a_configuration_is_reached_with_any_momentum() -> Result<(), Error> {
    let (h, steps) = (0.1, 20);
    let control = double_integrator::<0>(h).control(h)?;
    let start = Vector2::new(0.0, 1.0);
    let mut plan = vec![control.stage(&start); steps];
    let found = control.solve(&start, Target::Configuration(Vector2::new(5.0, 77.0)), &mut plan)?;
    assert!((found.end()[0] - 5.0).abs() < 1e-13 && found.final_costate()[1].abs() < 1e-13, "{found:?}");
    // u_k = λ b_k / h with b_k = h²(N − k − ½)
    let reach: Vec<f64> = (0..steps).map(|k| h * h * (steps as f64 - k as f64 - 0.5)).collect();
    let multiplier = (5.0 - 2.0) * h / reach.iter().map(|b| b * b).sum::<f64>();
    for (stage, b) in found.stages().iter().zip(&reach) {
        assert!((stage.input()[0] - multiplier * b / h).abs() < 1e-12);
    }
    Ok(())
}

/// Four places, two inputs, an unstable mode.
fn unstable() -> Linear<4, 2, 0, 4> {
    Linear {
        a: SMatrix::<f64, 4, 4>::from_row_slice(&[
            1.1, 0.2, 0.0, 0.1, -0.1, 0.9, 0.3, 0.0, 0.0, 0.1, 1.3, 0.2, 0.2, 0.0, -0.4, 0.8,
        ]),
        b: Matrix4x2::new(0.0, 0.1, 1.0, 0.0, 0.2, 0.5, 0.0, 1.0),
        place_price: SMatrix::identity() * 0.3,
        input_price: SMatrix::<f64, 2, 2>::new(2.0, 0.3, 0.3, 1.0),
        end_price: SMatrix::identity() * 5.0,
        bound_place: SMatrix::zeros(),
        bound_input: SMatrix::zeros(),
        bound: SMatrix::zeros(),
    }
}

#[test]
fn gains_costates_and_price_are_those_of_riccati() -> Result<(), Error> {
    let system = unstable();
    let control = system.clone().control(1.0)?;
    let start = Vector4::new(1.0, -2.0, 0.5, 3.0);
    let mut plan = [control.stage(&start); 40];
    let found = control.solve(&start, Target::Free, &mut plan)?;
    let mut value = system.end_price;
    assert_near!(found.final_costate(), value * found.end(), 1e-12);
    for stage in found.stages().iter().rev() {
        let input = system.input_price + system.b.transpose() * value * system.b;
        let gain = -input.try_inverse().unwrap() * system.b.transpose() * value * system.a;
        value = system.place_price + system.a.transpose() * value * (system.a + system.b * gain);
        assert_near!(stage.gain(), gain, 1e-12);
        assert_near!(stage.input(), gain * stage.place(), 1e-11);
        assert_near!(stage.costate(), value * stage.place(), 1e-11);
        let beside = stage.place() + Vector4::new(0.1, 0.2, -0.3, 0.4);
        assert_near!(control.feedback(stage, &beside), gain * beside, 1e-11);
    }
    assert!((found.price() - start.dot(&(value * start)) / 2.0).abs() < 1e-11);
    assert!(found.iterations() <= 3 && found.is_minimum() && found.gap() == 0.0, "{found:?}");
    Ok(())
}

/// The gain of each stage predicts the input of the solution from a neighbouring start to the same target.
#[test]
fn gains_lead_to_the_target() -> Result<(), Error> {
    let control = unstable().control(1.0)?;
    let (start, goal) = (Vector4::new(1.0, -2.0, 0.5, 3.0), Vector4::new(0.0, 1.0, 0.0, -1.0));
    let mut plan = [control.stage(&start); 9];
    let found = control.solve(&start, Target::Place(goal), &mut plan)?;
    for (k, stage) in found.stages().iter().enumerate().take(7) {
        let beside = stage.place() + Vector4::new(0.1, 0.2, -0.3, 0.4);
        let mut rest = vec![control.stage(&start); 9 - k];
        let again = control.solve(&beside, Target::Place(goal), &mut rest)?;
        assert_near!(control.feedback(stage, &beside), again.stages()[0].input(), 1e-9);
    }
    Ok(())
}

/// x of A x = b by elimination with pivoting.
pub fn dense(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs())).unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            let pivot = a[k].clone();
            a[i].iter_mut().zip(&pivot).for_each(|(entry, above)| *entry -= factor * above);
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        for j in k + 1..n {
            b[k] -= a[k][j] * b[j];
        }
        b[k] /= a[k][k];
    }
    b
}

/// Inputs, places 1..=N and multipliers from the equations of Karush, Kuhn and Tucker, all at once.
fn karush_kuhn_tucker(system: &Linear<3, 2, 0, 3>, start: &[f64; 3], goal: &[f64; 3], steps: usize) -> Vec<f64> {
    let (inputs, places) = (2 * steps, 3 * steps);
    let rows = places + 3;
    let size = inputs + places + rows;
    let (mut matrix, mut right) = (vec![vec![0.0; size]; size], vec![0.0; size]);
    for k in 0..steps {
        for i in 0..2 {
            for j in 0..2 {
                matrix[2 * k + i][2 * k + j] = system.input_price[(i, j)];
            }
        }
        for i in 0..3 {
            for j in 0..3 {
                let price = if k + 1 == steps { system.end_price } else { system.place_price };
                matrix[inputs + 3 * k + i][inputs + 3 * k + j] = price[(i, j)];
            }
        }
    }
    let mut couple = |row: usize, column: usize, value: f64| {
        matrix[inputs + places + row][column] = value;
        matrix[column][inputs + places + row] = value;
    };
    for k in 0..steps {
        for i in 0..3 {
            couple(3 * k + i, inputs + 3 * k + i, -1.0);
            (0..2).for_each(|j| couple(3 * k + i, 2 * k + j, system.b[(i, j)]));
            if k > 0 {
                (0..3).for_each(|j| couple(3 * k + i, inputs + 3 * (k - 1) + j, system.a[(i, j)]));
            } else {
                right[inputs + places + i] = -(0..3).map(|j| system.a[(i, j)] * start[j]).sum::<f64>();
            }
        }
    }
    for i in 0..3 {
        couple(places + i, inputs + 3 * (steps - 1) + i, 1.0);
        right[inputs + places + places + i] = goal[i];
    }
    dense(matrix, right)
}

proptest! {
    /// Indefinite prices too, as long as they are convex on plans that arrive.
    #[test]
    fn random_plans_are_those_of_a_dense_solution(
        a in prop::array::uniform9(-1.0_f64..1.0),
        b in prop::array::uniform6(-1.0_f64..1.0),
        prices in prop::array::uniform9(-1.0_f64..1.0),
        start in prop::array::uniform3(-1.0_f64..1.0),
        goal in prop::array::uniform3(-1.0_f64..1.0),
        steps in 3_usize..9,
    ) {
        let square = |offset: f64| {
            let root = SMatrix::<f64, 3, 3>::from_row_slice(&prices);
            root * root.transpose() * 0.5 + SMatrix::identity() * offset
        };
        let system = Linear::<3, 2, 0, 3> {
            a: SMatrix::from_row_slice(&a),
            b: SMatrix::from_row_slice(&b),
            place_price: square(0.0),
            input_price: SMatrix::<f64, 2, 2>::new(1.0 + prices[0], 0.2 * prices[1], 0.2 * prices[1], 1.5),
            // the end is fixed: its price may be anything
            end_price: square(-3.0),
            bound_place: SMatrix::zeros(),
            bound_input: SMatrix::zeros(),
            bound: SMatrix::zeros(),
        };
        prop_assume!(prices[0] > -0.8);
        let expected = karush_kuhn_tucker(&system, &start, &goal, steps);
        let size = expected.iter().fold(1.0_f64, |max, x| max.max(x.abs()));
        prop_assume!(expected.iter().all(|x| x.is_finite()) && size < 1e3);
        let control: Control<_, 3, 2, 0> = system.control(1.0).unwrap();
        let mut plan = vec![control.stage(&start.into()); steps];
        let found = control.solve(&start.into(), Target::Place(goal.into()), &mut plan).unwrap();
        for (k, stage) in found.stages().iter().enumerate() {
            for j in 0..2 {
                let error = (stage.input()[j] - expected[2 * k + j]).abs();
                prop_assert!(error < 1e-9 * size, "{error:e} of {size:e} in {found:?}");
            }
        }
        prop_assert!(found.is_minimum() && found.iterations() <= 8, "{found:?}");
    }
}

#[test]
fn one_step_reaches_what_it_can() -> Result<(), Error> {
    let control = double_integrator::<0>(1.0).control(1.0)?;
    let start = Vector2::zeros();
    let mut plan = [control.stage(&start)];
    let found = control.solve(&start, Target::Configuration(Vector2::new(1.0, 0.0)), &mut plan)?;
    assert_near!(found.stages()[0].input(), Vector1::new(2.0), 1e-15);
    // in one step, position and velocity are one: (½, 1) can be reached, (1, 1) cannot
    let found = control.solve(&start, Target::Place(Vector2::new(0.5, 1.0)), &mut plan)?;
    assert_near!(found.stages()[0].input(), Vector1::new(1.0), 1e-15);
    let error = control.solve(&start, Target::Place(Vector2::new(1.0, 1.0)), &mut plan).unwrap_err();
    assert!(matches!(error, Error::Uncontrollable { distance } if distance < 1.0), "{error}");
    Ok(())
}

/// Round-off of a gap is relative to the places that are passed, not to a target that is the origin.
#[test]
fn the_origin_is_reached() -> Result<(), Error> {
    let control = double_integrator::<0>(0.1).control(0.1)?;
    for start in [Vector2::new(1.3, -0.7), Vector2::new(1e6, 0.3), Vector2::new(-1e-6, 0.0), Vector2::zeros()] {
        let mut plan = vec![control.stage(&start); 25];
        let found = control.solve(&start, Target::Place(Vector2::zeros()), &mut plan)?;
        assert!(found.gap() <= 1e-13 * start.amax() && found.iterations() <= 3, "{found:?}");
    }
    Ok(())
}
