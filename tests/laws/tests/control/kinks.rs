//! Prices with kinks, |a| and max(a, b), against the same problems with further inputs that are bounded by them.

use clebsch::{Clebsch, Controlled, Ended, Error, Limits, Target};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Vector2, Vector3};

const H: f64 = 0.1;
const N: usize = 30;

/// A mass whose fuel is |u|, and whose time has a price.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
    cost     = |h, u| h * (self.hurry + self.fuel * u.x.abs() + self.effort * u.norm_squared() / 2),
    bounds   = |u| [-self.strongest <= u.x, u.x <= self.strongest],
)]
struct Fuelled {
    hurry: f64,
    fuel: f64,
    effort: f64,
    strongest: f64,
}

/// The same with thrusters for each direction.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector2| x + h * vector![x.y, u.x - u.y],
    cost     = |h, u| h * (self.hurry + self.fuel * (u.x + u.y) + self.effort * (u.x - u.y).powi(2) / 2),
    bounds   = |u| [0 <= u.x, u.x <= self.strongest, 0 <= u.y, u.y <= self.strongest],
)]
struct Thrusters {
    hurry: f64,
    fuel: f64,
    effort: f64,
    strongest: f64,
}

/// A car on SE(2) that is to be near a line, at a price of the distance, and not to go faster than it should.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |F: SE<2>, q: SE<2>| q * F,
    controls = |u: Vector2| vector![u.x, u.y, 0],
    cost     = |h, q, u| h * (u.norm_squared() / 2 + self.off * q.translation().y.abs() + self.fine * u.y.max(self.limit)),
    endpoint = |q| 5 * (q.translation() - self.goal).norm_squared(),
)]
struct Car {
    off: f64,
    fine: f64,
    limit: f64,
    goal: Vector2<f64>,
}

/// The same with two inputs more, that are not below the distance and the speed.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |F: SE<2>, q: SE<2>| q * F,
    controls = |u: Vector4| vector![u.x, u.y, 0],
    cost     = |h, u| h * ((u.x * u.x + u.y * u.y) / 2 + self.off * u.z + self.fine * u.w),
    bounds   = |q, u| [q.translation().y <= u.z, -q.translation().y <= u.z, u.y <= u.w, self.limit <= u.w],
    endpoint = |q| 5 * (q.translation() - self.goal).norm_squared(),
)]
struct Slack {
    off: f64,
    fine: f64,
    limit: f64,
    goal: Vector2<f64>,
}

/// A body whose torques cost by their sizes, and whose rate is softly limited.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, omega, torque| h * (torque.norm_squared() / 2 + self.fine * (omega.norm_squared() - self.slow.powi(2)).max(0)),
)]
struct Soft {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    slow: f64,
    fine: f64,
}

/// The same with a rate that has to stay below.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, torque| h * torque.norm_squared() / 2,
    bounds     = |omega| [omega.norm_squared() <= self.slow.powi(2)],
)]
struct Hard {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    slow: f64,
}

#[test]
fn fuel_is_that_of_thrusters() -> Result<(), Error> {
    let random = &mut Random::new(4401);
    for k in 0..super::long(20) {
        let (fuel, effort) = (random.between(0.2, 2.0), if k % 2 == 0 { 0.0 } else { random.between(0.01, 1.0) });
        let (start, goal) = (random.vector::<2>(), random.vector::<2>());
        let control = Fuelled { hurry: 0.0, fuel, effort, strongest: 4.0 }.control(H)?;
        let mut plan = [control.stage(&start); N];
        let optimum = control.solve(&start, Target::Place(goal), &mut plan)?;
        let split = Thrusters { hurry: 0.0, fuel, effort, strongest: 4.0 }.control(H)?;
        let mut other = [split.stage(&start); N];
        let expected = split.solve(&start, Target::Place(goal), &mut other)?.price();
        let found = optimum.price();
        assert!((found - expected).abs() < 1e-8 * (1.0 + expected), "{k}: {found} {expected} {optimum:?}");
        let sum: f64 = optimum.stages().iter().map(|stage| stage.input().x.abs()).sum();
        let squares: f64 = optimum.stages().iter().map(|stage| stage.input().norm_squared()).sum();
        assert!(
            (found - H * (fuel * sum + effort * squares / 2.0)).abs() < 1e-12 * (1.0 + found),
            "the price is that of |u|"
        );
    }
    Ok(())
}

#[test]
fn kinks_of_places_and_inputs_are_those_of_further_inputs() -> Result<(), Error> {
    let random = &mut Random::new(4402);
    for _ in 0..super::long(10) {
        let (off, fine, limit) = (random.between(0.1, 2.0), random.between(0.1, 1.0), random.between(0.1, 1.0));
        let goal = Vector2::new(random.between(1.0, 2.0), random.number());
        let start = super::place(random.number(), 0.0, random.number());
        let control = Car { off, fine, limit, goal }.control(H)?;
        let mut plan = [control.stage(&start); N];
        let optimum = control.solve(&start, Target::Free, &mut plan)?;
        let slack = Slack { off, fine, limit, goal }.control(H)?;
        let mut other = optimum
            .stages()
            .iter()
            .map(|stage| {
                let (u, y) = (stage.input(), stage.place()[(1, 2)]);
                slack.stage(&start).with_input([u.x, u.y, y.abs() + 0.1, u.y.max(limit) + 0.1].into())
            })
            .collect::<Vec<_>>();
        let expected = slack.solve(&start, Target::Free, &mut other)?.price();
        let found = optimum.price();
        assert!(
            optimum.is_minimum() && (found - expected).abs() < 1e-8 * (1.0 + expected),
            "{found} {expected} {optimum:?}"
        );
    }
    Ok(())
}

/// A soft bound whose price is above the multiplier of the hard one is that bound, and one below is not.
#[test]
fn a_dear_soft_bound_is_a_hard_one() -> Result<(), Error> {
    let random = &mut Random::new(4403);
    let mut limited = 0;
    let enough = if cfg!(feature = "heavy") { 2 } else { 1 };
    for _ in 0..6 {
        // one of them is enough without the feature `heavy`
        if limited >= enough && !cfg!(feature = "heavy") {
            break;
        }
        let (inertia, slow) = (random.inertia::<3>(), 1.2);
        let start = (Matrix3::identity(), Vector3::zeros());
        let goal = (random.attitude::<3>(), Vector3::zeros());
        let hard = Hard { inertia, slow }.control(H)?;
        let mut plan = [hard.stage(&start); N];
        let hard = hard.solve(&start, Target::Place(goal), &mut plan)?;
        let dearest = hard.stages().iter().map(|stage| stage.multipliers().x).fold(0.0, f64::max);
        let expected = hard.price();
        if dearest < 1e-3 {
            continue;
        }
        limited += 1;
        for part in [1.5, 0.5] {
            let soft = Soft { inertia, slow, fine: part * dearest / H }.control(H)?;
            let mut plan = [soft.stage(&start); N];
            let found = soft.solve(&start, Target::Place(goal), &mut plan)?.price();
            if part > 1.0 {
                assert!((found - expected).abs() < 1e-8 * expected, "{found} {expected}");
            } else {
                assert!(found < expected * (1.0 - 1e-6), "{found} {expected}");
            }
        }
    }
    assert!(limited >= enough, "{limited}");
    Ok(())
}

#[test]
fn a_warm_start_with_kinks_goes_on() -> Result<(), Error> {
    let control = Fuelled { hurry: 0.0, fuel: 1.0, effort: 0.1, strongest: 4.0 }.control(H)?;
    let (start, goal) = (Vector2::zeros(), Target::Place(Vector2::x()));
    let mut plan = [control.stage(&start); N];
    let expected = control.solve(&start, goal, &mut plan)?.price();
    let again = control.solve(&start, goal, &mut plan)?;
    assert!(again.iterations() <= 4 && (again.price() - expected).abs() < 1e-9 * expected, "{again:?}");
    // at rest, where all inputs are at their kinks
    let mut still = [control.stage(&start); N];
    for _ in 0..2 {
        let rest = control.solve(&start, Target::Place(start), &mut still)?;
        assert!(rest.price().abs() < 1e-9 && rest.is_minimum(), "{rest:?}");
    }
    let mut plan = [control.stage(&start); N];
    let (mut calls, mut ended) = (0, Ended::AtLimit);
    while ended != Ended::Converged && calls < 40 {
        let reached = control.solve_within(&start, goal, Limits { sweeps: 2 }, &mut plan)?;
        (ended, calls) = (reached.ended(), calls + 1);
        assert!(ended != Ended::Converged || (reached.price() - expected).abs() < 1e-9 * expected);
    }
    assert_eq!(ended, Ended::Converged);
    Ok(())
}

#[test]
fn a_kink_with_a_negative_price_is_refused() -> Result<(), Error> {
    let control = Fuelled { hurry: 0.0, fuel: -1.0, effort: 1.0, strongest: 4.0 }.control(H)?;
    let start = Vector2::zeros();
    let error = control.solve(&start, Target::Free, &mut [control.stage(&start); 3]).map(|found| found.price());
    assert_eq!(error, Err(Error::NegativePrice { term: "u.x.abs()", price: -2.0 * H }));
    // without a price there is no kink
    let control = Fuelled { hurry: 0.0, fuel: 0.0, effort: 1.0, strongest: 4.0 }.control(H)?;
    let optimum =
        control.solve(&start, Target::Place(Vector2::x()), &mut [control.stage(&start); N]).map(|found| found.price());
    let split = Thrusters { hurry: 0.0, fuel: 0.0, effort: 1.0, strongest: 4.0 }.control(H)?;
    let expected =
        split.solve(&start, Target::Place(Vector2::x()), &mut [split.stage(&start); N]).map(|found| found.price());
    assert!((optimum? - expected?).abs() < 1e-6);
    Ok(())
}

/// The price h w of a kink changes with the step. The steps of either declaration are those of least price, and the price is the same.
#[test]
fn the_best_time_counts_fuel() -> Result<(), Error> {
    let random = &mut Random::new(4407);
    for _ in 0..if cfg!(feature = "heavy") { 4 } else { 2 } {
        let (hurry, fuel) = (random.between(0.5, 2.0), random.between(0.2, 2.0));
        let goal = Target::Place(Vector2::new(random.between(0.5, 2.0), 0.0));
        let start = Vector2::zeros();
        let control = Fuelled { hurry, fuel, effort: 0.3, strongest: 4.0 }.control(H)?;
        let mut plan = [control.stage(&start); N];
        let found = control.solve_free_time(&start, goal, 0.01..=1.0, &mut plan)?;
        let (step, price) = (found.step_size(), found.price());
        let split = Thrusters { hurry, fuel, effort: 0.3, strongest: 4.0 }.control(H)?;
        let mut other = [split.stage(&start); N];
        let expected = split.solve_free_time(&start, goal, 0.01..=1.0, &mut other)?;
        assert!(step > 0.011 && step < 0.99, "{step}");
        assert!((step - expected.step_size()).abs() < 1e-5 * step, "{step} {}", expected.step_size());
        assert!((price - expected.price()).abs() < 1e-8 * price, "{price} {}", expected.price());
    }
    Ok(())
}
