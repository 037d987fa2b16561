//! Bounds: the box of an input, against the dual of the problem, and impossible bounds.

use crate::linear::{Linear, bounded_integrator};
use clebsch::{Control, Controlled, Error, Optimum, Stage, Target};
use nalgebra::{Matrix2, SMatrix, Vector2};
use std::vec;
use std::vec::Vec;

pub type Bounded = Linear<2, 1, 2, 1>;

/// Size and number of the steps to the time 4. Miri, which interprets, takes few.
const STEPS: (f64, usize) = if cfg!(miri) { (0.4, 10) } else { (0.1, 40) };

/// From rest at 0 to rest at `distance`.
fn rest_to_rest<R>(
    h: f64,
    steps: usize,
    distance: f64,
    look: impl Fn(&Optimum<'_, Bounded, 2, 1, 2>) -> R,
) -> Result<R, Error> {
    let control: Control<_, 2, 1, 2> = bounded_integrator(h).control(h)?;
    let start = Vector2::zeros();
    let mut plan: Vec<Stage<Bounded, 2, 1, 2>> = vec![control.stage(&start); steps];
    let found = control.solve(&start, Target::Place(Vector2::new(distance, 0.0)), &mut plan)?;
    Ok(look(&found))
}

/// The inputs clamp(b_k·ν/h) that lead to the goal: Newton's method for ν, from the dual of the problem.
fn clamped(h: f64, steps: usize, goal: Vector2<f64>) -> (Vec<f64>, Vec<f64>) {
    let columns: Vec<Vector2<f64>> =
        (0..steps).map(|k| Vector2::new(h * h * (steps as f64 - k as f64 - 0.5), h)).collect();
    let mut multiplier = Vector2::zeros();
    let wanted = |multiplier: &Vector2<f64>| columns.iter().map(|b| b.dot(multiplier) / h).collect::<Vec<f64>>();
    let dual = |multiplier: &Vector2<f64>| {
        let price = |u: &f64| if u.abs() > 1.0 { u.abs() - 0.5 } else { u * u / 2.0 };
        h * wanted(multiplier).iter().map(price).sum::<f64>() - goal.dot(multiplier)
    };
    for _ in 0..200 {
        let inputs = wanted(&multiplier);
        let (mut slope, mut lack) = (Matrix2::zeros(), goal);
        for (u, b) in inputs.iter().zip(&columns) {
            lack -= b * u.clamp(-1.0, 1.0);
            if u.abs() <= 1.0 {
                slope += b * b.transpose() / h;
            }
        }
        let change = (slope + Matrix2::identity() * 1e-14).try_inverse().unwrap() * lack;
        let mut fraction = 1.0;
        while fraction > 1e-6 && dual(&(multiplier + change * fraction)) > dual(&multiplier) + 1e-15 {
            fraction /= 2.0;
        }
        multiplier += change * fraction;
    }
    let inputs = wanted(&multiplier);
    (inputs.iter().map(|u| u.clamp(-1.0, 1.0)).collect(), inputs)
}

#[test]
fn the_box_is_kept_as_in_the_dual_solution() -> Result<(), Error> {
    let (h, steps) = STEPS;
    // under Miri that in which inputs are bound, by clear margins
    for distance in [3.5, 1.0, 2.5, 3.9].into_iter().take(if cfg!(miri) { 1 } else { 4 }) {
        let (expected, wanted) = clamped(h, steps, Vector2::new(distance, 0.0));
        let price = expected.iter().map(|u| h * u * u / 2.0).sum::<f64>();
        rest_to_rest(h, steps, distance, |found| {
            assert!((found.price() - price).abs() < 1e-10 * price, "{found:?} after {price}");
            for ((stage, u), wanted) in found.stages().iter().zip(&expected).zip(&wanted) {
                assert!((stage.input()[0] - u).abs() < 1e-6, "{} after {u}", stage.input()[0]);
                assert_eq!(stage.active(), [*wanted > 1.0, *wanted < -1.0], "{wanted}");
                let multiplier = stage.multipliers()[0] - stage.multipliers()[1];
                assert!((multiplier - h * (wanted - u)).abs() < 1e-6, "{multiplier} after {wanted}");
            }
            assert!(found.is_minimum() && found.gap() < 1e-12 && found.iterations() <= 40, "{found:?}");
        })?;
    }
    Ok(())
}

/// In N steps of h, full thrust there and back goes (Nh)²/4 and no further.
#[test]
fn the_limit_is_full_thrust_there_and_back() -> Result<(), Error> {
    let (h, steps) = STEPS;
    rest_to_rest(h, steps, 4.0 - 1e-6, |found| {
        for (k, stage) in found.stages().iter().enumerate() {
            let side = if k < steps / 2 { 1.0 } else { -1.0 };
            assert!((stage.input()[0] - side).abs() < 2e-4, "{k}: {}", stage.input()[0]);
        }
        // the two inputs between give 10⁻⁶ = h² (1 − u) away
        let between = 1.0 - 1e-6 / (h * h);
        let expected = h * (steps as f64 / 2.0 - 1.0 + between * between);
        assert!((found.price() - expected).abs() < 1e-10, "{found:?} after {expected}");
    })?;
    // the search beyond takes six ways, each of hundreds of sweeps: even in two steps, that takes Miri too long
    if cfg!(miri) {
        return Ok(());
    }
    let error = rest_to_rest(h, steps, 4.0 + 1e-3, |_| ()).unwrap_err();
    assert!(matches!(error, Error::TargetMissed { distance, .. } if distance < 0.1), "{error}");
    let error = rest_to_rest(h, steps, 40.0, |_| ()).unwrap_err();
    assert!(matches!(error, Error::TargetMissed { .. }), "{error}");
    Ok(())
}

/// A guess that violates bounds, and one on them.
#[test]
fn guesses_need_not_keep_bounds() -> Result<(), Error> {
    let (h, steps) = STEPS;
    let expected = rest_to_rest(h, steps, 3.5, |found| found.price())?;
    let control: Control<_, 2, 1, 2> = bounded_integrator(h).control(h)?;
    let (start, goal) = (Vector2::zeros(), Vector2::new(3.5, 0.0));
    for guess in [7.0, 1.0, -1.0, 100.0].into_iter().take(if cfg!(miri) { 2 } else { 4 }) {
        let stage = control.stage(&start).with_input(SMatrix::<f64, 1, 1>::new(guess));
        let mut plan = vec![stage; steps];
        let found = control.solve(&start, Target::Place(goal), &mut plan)?;
        assert!((found.price() - expected).abs() < 1e-10, "{found:?} after {expected}");
        let again = control.solve(&start, Target::Place(goal), &mut plan)?;
        assert!(again.iterations() <= 2 && (again.price() - expected).abs() < 1e-10, "{again:?}");
        let beside = Vector2::new(0.01, -0.02);
        let near = control.solve(&beside, Target::Place(goal), &mut plan)?;
        assert!(near.iterations() <= 20, "{near:?}");
    }
    Ok(())
}

/// Where |v| ≤ ½ in place of the box.
fn bounded_velocity(h: f64) -> Bounded {
    let mut system = bounded_integrator(h);
    system.bound_place = SMatrix::<f64, 2, 2>::new(0.0, 1.0, 0.0, -1.0);
    system.bound_input = SMatrix::<f64, 2, 1>::new(0.0, 0.0);
    system.bound = Vector2::new(0.5, 0.5);
    system
}

/// A bound of the velocity, which is a bound of the place: it is passed at v = ½ for most of the time.
#[test]
fn bounds_of_the_place_are_kept() -> Result<(), Error> {
    let (h, steps) = if cfg!(miri) { (0.6, 10) } else { (0.1, 60) };
    let system = bounded_velocity(h);
    let control: Control<_, 2, 1, 2> = system.control(h)?;
    let start = Vector2::zeros();
    let mut plan = vec![control.stage(&start); steps];
    let found = control.solve(&start, Target::Place(Vector2::new(2.5, 0.0)), &mut plan)?;
    let fastest = found.stages().iter().map(|stage| stage.place()[1]).fold(0.0, f64::max);
    assert!((fastest - 0.5).abs() < 1e-8 && found.is_minimum(), "{fastest}");
    // by symmetry in time, and with the inputs that the bound leaves alone falling linearly
    let inputs: Vec<f64> = found.stages().iter().map(|stage| stage.input()[0]).collect();
    for k in 0..steps / 2 {
        assert!((inputs[k] + inputs[steps - 1 - k]).abs() < 1e-7);
    }
    let error = control.solve(&Vector2::new(0.0, 0.7), Target::Free, &mut plan).unwrap_err();
    let expected = |violation: f64| (violation - 0.2).abs() < 1e-9;
    assert!(
        matches!(error, Error::Infeasible { stage: 0, bound: "the bound", violation } if expected(violation)),
        "{error}"
    );
    Ok(())
}

/// With |v| ≤ ½ inputs fall linearly to 0, u_k = a + c (m − k) for k ≤ m, and rise to their opposites at last. Σ h u_k = ½ gives c, and
/// Σ (N − k) u_k the distance. At a = 0 and at a = c one bound more is reached than pushes.
#[test]
fn bounds_that_are_reached_need_not_push() -> Result<(), Error> {
    let plans = [(0.6, 10, 2), (0.6, 10, 3), (1.0, 7, 2), (0.3, 20, 2), (0.3, 20, 7), (0.1, 60, 5), (0.1, 60, 21)];
    for (h, steps, m) in plans.into_iter().take(if cfg!(miri) { 1 } else { 7 }) {
        for part in [0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.5, 1.0 - 1e-6, 1.0] {
            let (free, last) = (m as f64, steps - 1);
            let fall = 0.5 / (h * (free + 1.0) * (part + free / 2.0));
            let rise = |k: usize| if k <= m { fall * (part + (m - k) as f64) } else { 0.0 };
            let distance = 0.5 * h * last as f64 - (1..=m).map(|k| 2.0 * h * h * k as f64 * rise(k)).sum::<f64>();
            let price = (0..=m).map(|k| h * rise(k) * rise(k)).sum::<f64>();
            let control: Control<_, 2, 1, 2> = bounded_velocity(h).control(h)?;
            let start = Vector2::zeros();
            let mut plan = vec![control.stage(&start); steps];
            let found = control.solve(&start, Target::Place(Vector2::new(distance, 0.0)), &mut plan)?;
            assert!((found.price() - price).abs() < 1e-11 * price, "{found:?} after {price}");
            for (k, stage) in found.stages().iter().enumerate() {
                let expected = rise(k) - rise(last - k);
                assert!((stage.input()[0] - expected).abs() < 1e-6, "{k}: {} after {expected}", stage.input()[0]);
                let pushes = if k > m + 1 && k < last - m { fall } else { 0.0 };
                let is_between = k == m + 1 || k + m == last;
                let error = stage.multipliers()[0] - if is_between { fall * (1.0 - part) } else { pushes };
                assert!(error.abs() < 1e-6, "{k}: {error:e}");
            }
            assert!(found.is_minimum() && found.gap() < 1e-12 && found.iterations() <= 60, "{found:?}");
        }
    }
    Ok(())
}

/// The price of going from (0, 1) to (l, 0) in `steps` steps of x⁺ = x + hv, v⁺ = v + hu, and the furthest place between.
fn braked(h: f64, steps: usize, wall: f64) -> (f64, f64) {
    // columns of the shares of inputs in the end, and the least inputs that close the gap
    let columns: Vec<Vector2<f64>> = (0..steps).map(|k| Vector2::new(h * h * (steps - 1 - k) as f64, h)).collect();
    let gramian: Matrix2<f64> = columns.iter().map(|b| b * b.transpose()).sum();
    let lack = Vector2::new(wall - h * steps as f64, -1.0);
    let multiplier = gramian.try_inverse().unwrap() * lack;
    let (mut x, mut furthest) = (Vector2::new(0.0, 1.0), 0.0);
    for b in &columns {
        x += Vector2::new(h * x[1], h * b.dot(&multiplier));
        furthest = f64::max(furthest, x[0]);
    }
    (h * lack.dot(&multiplier) / 2.0, furthest)
}

/// A car brakes from (0, 1) to rest at a wall that it may not pass before. The bound of a place is one of the input two
/// steps earlier. At 0.15 and 0.2 the wall is reached a step before it pushes.
#[test]
fn a_wall_is_not_passed() -> Result<(), Error> {
    let (plans, walls) = if cfg!(miri) { (1, 1) } else { (3, 25) };
    for (h, steps) in [(0.2, 10), (0.1, 20), (0.05, 30)].into_iter().take(plans) {
        for wall in (1..=walls).map(|centimetres| h + f64::from(centimetres) / 100.0) {
            let mut system = bounded_integrator(h);
            system.b = SMatrix::<f64, 2, 1>::new(0.0, h);
            system.bound_place = SMatrix::<f64, 2, 2>::new(1.0, 0.0, -1.0, 0.0);
            system.bound_input = SMatrix::<f64, 2, 1>::new(0.0, 0.0);
            system.bound = Vector2::new(wall, 9.0);
            let control: Control<_, 2, 1, 2> = system.control(h)?;
            let start = Vector2::new(0.0, 1.0);
            let mut plan = vec![control.stage(&start); steps];
            let found = control.solve(&start, Target::Place(Vector2::new(wall, 0.0)), &mut plan)?;
            // whoever is at rest at the wall stays there
            let ways = (2..=steps).map(|k| braked(h, k, wall)).filter(|(_, furthest)| *furthest <= wall + 1e-12);
            let price = ways.map(|(price, _)| price).fold(f64::MAX, f64::min);
            assert!((found.price() - price).abs() < 1e-11 * price, "{wall}: {found:?} after {price}");
            assert!(found.is_minimum() && found.gap() < 1e-12 && found.iterations() <= 40, "{wall}: {found:?}");
        }
    }
    Ok(())
}
