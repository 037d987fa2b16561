//! Bounds of any size: plans satisfy them all, a large one changes no other, and an infinite one is none.

use super::few;
use clebsch::{Clebsch, Controlled, Error, Optimum, Space, Target};
use clebsch_tests::fixtures::steered_body::SteeredBody;
use clebsch_tests::fixtures::unicycle::Unicycle;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, SVector, Vector1, Vector2, Vector3};
use std::f64::consts::PI;

/// The unicycle that may turn as fast as it likes.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SE<2>, q: SE<2>| q * F,
    controls       = |u: Vector2| vector![u.x, u.y, 0],
    cost           = |h, u| h * (self.turn_price * u.x.powi(2) + u.y.powi(2)) / 2,
    bounds         = |u| [0 <= u.y],
    endpoint       = |t, q| self.time_price * t + self.miss_price * (q.translation() - self.goal).norm_squared() / 2,
    discretization = exponential,
)]
struct Turning {
    turn_price: f64,
    time_price: f64,
    miss_price: f64,
    goal: Vector2<f64>,
}

/// The body with reaction wheels of any torque.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |omega, torque: Vector3| torque - self.damping * omega,
    effort     = |h, torque| h * torque.norm_squared() / 2,
)]
struct Strong {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    damping: f64,
}

/// A cart whose thrust has bounds of its own to either side, as has its speed.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y + h * u.x / 2, u.x],
    cost     = |h, u| h * u.norm_squared() / 2,
    bounds   = |x, u| [self.low <= u.x, u.x <= self.high, x.y.powi(2) <= self.fast.powi(2)],
)]
struct Cart {
    low: f64,
    high: f64,
    fast: f64,
}

fn unicycle(top_turn: f64) -> Unicycle {
    Unicycle { turn_price: 1.0, top_turn, time_price: 0.0, miss_price: 0.0, goal: Vector2::zeros() }
}

/// Poses all around.
fn goals(count: usize) -> impl Iterator<Item = Matrix3<f64>> {
    let mut random = Random::new(704);
    (0..count).map(move |_| {
        let (sine, cosine) = random.between(-PI, PI).sin_cos();
        let (x, y) = (random.between(-1.5, 1.5), random.between(-1.5, 1.5));
        Matrix3::new(cosine, -sine, x, sine, cosine, y, 0.0, 0.0, 1.0)
    })
}

/// Every bound holds up to round-off of its own terms: ε of |∂a/∂x| |x| and |∂a/∂u| |u|.
fn holds_bounds<S, const D: usize, const U: usize, const C: usize>(
    system: &S,
    optimum: &Optimum<'_, S, D, U, C>,
) -> Result<(), String>
where
    S: Controlled<D, U, C, Scalar = f64>,
{
    let constants = system.prepare(optimum.step_size()).map_err(|error| error.to_string())?;
    for (k, stage) in optimum.stages().iter().enumerate() {
        let (t, x, u) = (optimum.step_size() * k as f64, stage.place(), stage.input());
        let bounds = system.bounds_expanded(&constants, t, x, u, stage.multipliers());
        let bounds = bounds.map_err(|error| error.to_string())?;
        for i in 0..C {
            let of_input = bounds.by_input.row(i).iter().zip(u.iter()).map(|(slope, u)| (slope * u).abs()).sum::<f64>();
            let terms = of_input + bounds.by_place.row(i).abs().sum() * x.max_abs();
            let holds = bounds.values[i] <= 32.0 * f64::EPSILON * terms;
            if !holds {
                return Err(format!("`{}` is violated by {:e} in step {k}", S::BOUNDS[i], bounds.values[i]));
            }
        }
    }
    Ok(())
}

/// The work and the price of a plan from this guess; an error, but for one that says that none was found.
fn solved<S, const D: usize, const U: usize, const C: usize, const N: usize>(
    system: S,
    h: f64,
    (start, goal): (&S::Place, S::Place),
    guess: SVector<f64, U>,
) -> Result<Option<(u32, f64)>, String>
where
    S: Controlled<D, U, C, Scalar = f64>,
{
    let control = system.control(h).map_err(|error| error.to_string())?;
    let mut plan = [control.stage(start).with_input(guess); N];
    match control.solve(start, Target::Place(goal), &mut plan) {
        Ok(found) => holds_bounds(control.system(), &found).map(|()| Some((found.iterations(), found.price()))),
        Err(Error::TargetMissed { .. } | Error::Infeasible { .. } | Error::NoExtremal { .. }) => Ok(None),
        Err(error) => Err(error.to_string()),
    }
}

/// Without reverse gear, and with a turning rate that is not to be bound: `0 <= u.y` holds to the last bit.
#[test]
fn a_large_bound_switches_no_other_off() {
    let start = Matrix3::identity();
    for top_turn in [1e3, 1e9, 1e15, 1e18, 1e20, 1e150, 1e300, f64::MAX] {
        let mut found = 0;
        for goal in goals(few(30)) {
            let plan = solved::<_, 3, 2, 3, 30>(unicycle(top_turn), 1.0 / 30.0, (&start, goal), Vector2::zeros());
            found += usize::from(plan.unwrap_or_else(|what| panic!("{top_turn:e}, {goal}: {what}")).is_some());
        }
        assert!(30 * found >= 29 * few(30), "{top_turn:e}: {found} of {}", few(30));
    }
}

/// Bounds of random sizes to either side, and guesses that keep them, reach them or are far beyond.
#[test]
fn bounds_of_random_sizes_are_kept() {
    let mut random = Random::new(705);
    let mut found = 0;
    for k in 0..few(400) {
        let mut size = |least: f64| match k % 4 {
            0 => least * random.between(1.0, 2.0),
            _ => least * 10_f64.powf(random.between(-0.3, 1.0) * [1.0, 20.0, 300.0][k % 3]),
        };
        let system = Cart { low: -size(5.0), high: size(5.0), fast: size(1.5) };
        let goal = Vector2::new(random.between(0.3, 1.0), random.between(-0.3, 0.3));
        let guess = match k % 5 {
            0..=2 => 0.0,
            3 => random.number() * 9.0,
            _ => random.number() * 10_f64.powf(random.between(0.0, 12.0)),
        };
        let plan = solved::<_, 2, 1, 3, 20>(system.clone(), 0.05, (&Vector2::zeros(), goal), Vector1::new(guess));
        found += usize::from(plan.unwrap_or_else(|what| panic!("{k}, {system:?} from {guess}: {what}")).is_some());
    }
    println!("{found} of {} found", few(400));
    assert!(2 * found > few(400), "{found} of {}", few(400));
}

/// A guess that is dear by many orders hides no slope of the price. The price is that of the plan from no guess, to 10⁻⁶.
#[test]
fn wild_guesses_are_forgotten() -> Result<(), Error> {
    let mut random = Random::new(707);
    for k in 0..few(100) {
        let goal = Target::Place(Vector2::new(random.between(0.3, 1.0), random.between(-0.3, 0.3)));
        let (start, wild) = (Vector2::zeros(), 10_f64.powi((k % 9) as i32) * random.number());
        let control =
            Cart { low: -random.between(5.0, 9.0), high: random.between(5.0, 9.0), fast: 1.5 }.control(0.05)?;
        let [mut plan, mut other] = [0.0, wild].map(|u| [control.stage(&start).with_input(Vector1::new(u)); 20]);
        let price = control.solve(&start, goal, &mut plan)?.price();
        let found = control.solve(&start, goal, &mut other)?;
        let differs = (found.price() - price).abs() / price;
        assert!(differs < 1e-6, "{k}, {wild}: {found:?} after {price}");
    }
    Ok(())
}

/// An infinite parameter makes the plans of the declaration without the bound: the same work, the same price, to the last bit.
#[test]
fn an_infinite_bound_is_none() {
    let start = Matrix3::identity();
    for goal in goals(few(60)) {
        let none = Turning { turn_price: 1.0, time_price: 0.0, miss_price: 0.0, goal: Vector2::zeros() };
        let (h, ends) = (1.0 / 30.0, (&start, goal));
        let bound = solved::<_, 3, 2, 3, 30>(unicycle(f64::INFINITY), h, ends, Vector2::zeros());
        assert_eq!(bound, solved::<_, 3, 2, 1, 30>(none, h, ends, Vector2::zeros()), "{goal}");
    }
    let mut random = Random::new(706);
    for _ in 0..few(20) {
        let (inertia, damping, h) = (random.inertia::<3>(), 0.1, 0.1);
        let start = (random.attitude::<3>(), Vector3::zeros());
        let ends = (&start, (start.0 * random.rotation::<3>(1.0), random.vector::<3>() * 0.1));
        let bound = SteeredBody { inertia, damping, top: f64::INFINITY };
        let bound = solved::<_, 6, 3, 2, 20>(bound, h, ends, Vector3::zeros());
        let none = solved::<_, 6, 3, 0, 20>(Strong { inertia, damping }, h, ends, Vector3::zeros());
        assert!(matches!(none, Ok(Some(_))) && bound == none, "{bound:?} and {none:?}");
    }
}

/// A plan with a bound is the guess of one without, and the other way round; the bound holds where it is one.
#[test]
fn bounds_come_and_go_between_plans() -> Result<(), Error> {
    let (start, goal) = (Vector2::zeros(), Target::Place(Vector2::new(0.7, 0.1)));
    let with = Cart { low: -5.0, high: 5.0, fast: 1.0 }.control(0.05)?;
    let without = Cart { low: -5.0, high: f64::INFINITY, fast: f64::INFINITY }.control(0.05)?;
    let mut plan = [with.stage(&start); 20];
    let prices = [&with, &without, &with, &without].map(|control| {
        let found = control.solve(&start, goal, &mut plan).expect("a plan");
        assert_eq!(holds_bounds(control.system(), &found), Ok(()));
        let others = found.stages().iter().map(|stage| stage.multipliers().yz().amax()).fold(0.0, f64::max);
        assert_eq!(others > 0.0, control.system().fast < 2.0);
        found.price()
    });
    let [first, free, again, last] = prices;
    assert!((first - again).abs() < 1e-10 * first && (free - last).abs() < 1e-10 * free && free < first);
    Ok(())
}

/// −∞ above and ∞ below leave no input, and NaN says nothing: errors name the bound or the field.
#[test]
fn bounds_that_leave_nothing_are_refused() -> Result<(), Error> {
    let start = Vector2::zeros();
    let error = |system: Cart| -> Result<Error, Error> {
        let control = system.control(0.05)?;
        let mut plan = [control.stage(&start); 20];
        Ok(control.solve(&start, Target::Place(Vector2::new(0.7, 0.1)), &mut plan).expect_err("no input"))
    };
    let none = f64::INFINITY;
    let above = error(Cart { low: -none, high: -none, fast: none })?;
    assert_eq!(above, Error::NotFinite { name: "u.x <= self.high" });
    let below = error(Cart { low: none, high: none, fast: none })?;
    assert_eq!(below, Error::NotFinite { name: "self.low <= u.x" });
    let nan = Cart { low: -none, high: f64::NAN, fast: 1.0 }.control(0.05).expect_err("NaN");
    assert_eq!(nan, Error::NotFinite { name: "high" });
    Ok(())
}

/// A unicycle that gains nothing by driving stays where it is. All terms of its slopes are small, and the plan is found.
#[test]
fn plans_that_stay_at_rest_are_found() {
    let mut random = Random::new(708);
    let mut refused = Vec::new();
    for k in 0..few(1000) {
        let system = Unicycle {
            turn_price: random.between(0.5, 2.0),
            top_turn: random.between(0.5, 2.0),
            time_price: random.between(0.1, 1.0),
            miss_price: random.between(0.1, 2.0),
            goal: random.vector(),
        };
        let (sine, cosine) = random.between(-1.0, 1.0).sin_cos();
        let start = Matrix3::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0);
        let control = system.clone().control(0.1).expect("a unicycle");
        let mut plan = [control.stage(&start).with_input(Vector2::new(0.0, 0.1)); 8];
        match control.solve(&start, Target::Free, &mut plan) {
            Ok(found) => assert_eq!(holds_bounds(control.system(), &found), Ok(()), "{k}, {system:?}"),
            Err(error) => refused.push(format!("{k}, {system:?}: {error}")),
        }
    }
    assert!(refused.is_empty(), "{} of {} are refused, such as {}", refused.len(), few(1000), refused[0]);
}
