//! Equations of steps: against least norms, against the same system with fewer inputs, and in single precision. Several of them may say the same,
//! or contradict each other.

use super::targets::Unicycle;
use super::{long, place};
use clebsch::{Clebsch, Control, Controlled, Ended, Error, Limits, Target};
use clebsch_tests::fixtures::wheeled_car::WheeledCar;
use clebsch_tests::oracle::random::Random;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix4, Vector1, Vector2, Vector3, Vector4, vector};

const H: f64 = 0.1;
const N: usize = 12;

/// A mass in the plane with two forces that have to balance a load and a spring.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector4, u: Vector2| x + h * vector![x.z, x.w, u.x, u.y],
    cost     = |h, u| h * (self.hurry + u.norm_squared()) / 2,
    bounds   = |x, u| [u.x + self.lever * u.y + self.spring * x.x == self.load],
)]
struct Balanced {
    lever: f64,
    spring: f64,
    load: f64,
    hurry: f64,
}

/// A mass whose place is given twice.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y + h * u.x, u.x],
    cost     = |h, u| h * u.norm_squared() / 2,
    bounds   = |x| [x == vector![self.place, x.y], x.x == self.other],
)]
struct Placed {
    place: f64,
    other: f64,
}

/// A mass in the plane that stays on a line, in single precision.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector4, u: Vector2| x + h * vector![x.z + h * u.x, x.w + h * u.y, u.x, u.y],
    cost     = |h, u| h * (u.x.powi(2) + 2 * u.y.powi(2)) / 2,
    bounds   = |x| [x.x + x.y == self.lean],
)]
struct Leaning {
    lean: f32,
}

/// A body that turns about a line of sight, which its torque keeps on a star: three equations, and two of them are independent.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, torque| h * torque.norm_squared() / 2,
    bounds     = |R| [R * Vector3::z() == self.star],
)]
struct Pointed {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    star: Vector3<f64>,
}

/// The least price h|u|²/2 of inputs that satisfy these equations, with the inputs and the multipliers, from Rᵀ = QT.
fn least_norm(rows: &DMatrix<f64>, wanted: &DVector<f64>) -> (f64, DVector<f64>, DVector<f64>) {
    let factors = rows.transpose().qr();
    let triangle = factors.r();
    let parts = triangle.tr_solve_upper_triangular(wanted).expect("independent rows");
    let multipliers = triangle.solve_upper_triangular(&parts).expect("independent rows") * -H;
    (H * parts.norm_squared() / 2.0, factors.q() * parts, multipliers)
}

/// The equations of all steps, and of the end, for all inputs of a balanced mass from a place.
fn equations(system: &Balanced, start: &Vector4<f64>, goal: &Vector4<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let Balanced { lever, spring, load, .. } = *system;
    let step = Matrix4::identity() + H * Matrix4::from_fn(|i, j| f64::from(u8::from(j == i + 2)));
    let (mut rows, mut wanted) = (DMatrix::zeros(N + 4, 2 * N), DVector::zeros(N + 4));
    // the place before a step, as a function of all inputs
    let (mut moved, mut coasted) = (DMatrix::zeros(4, 2 * N), *start);
    for k in 0..N {
        rows.row_mut(k).copy_from(&(moved.row(0) * spring));
        (rows[(k, 2 * k)], rows[(k, 2 * k + 1)]) = (1.0, lever);
        wanted[k] = load - spring * coasted.x;
        moved = DMatrix::from_fn(4, 2 * N, |i, j| (step.row(i) * moved.column(j))[0]);
        (moved[(2, 2 * k)], moved[(3, 2 * k + 1)]) = (H, H);
        coasted = step * coasted;
    }
    rows.rows_mut(N, 4).copy_from(&moved);
    wanted.rows_mut(N, 4).copy_from(&(goal - coasted));
    (rows, wanted)
}

#[test]
fn linear_equations_are_satisfied_by_the_least_norm() -> Result<(), Error> {
    let random = &mut Random::new(3401);
    for _ in 0..20 {
        let [spring, load, hurry] = [random.number(), random.number(), random.number().abs()];
        let system = Balanced { lever: 0.5 + random.number().abs(), spring, load, hurry };
        let (start, goal) = (random.vector(), random.vector());
        let (rows, wanted) = equations(&system, &start, &goal);
        let (price, inputs, multipliers) = least_norm(&rows, &wanted);
        let hurry = system.hurry * H * N as f64 / 2.0;
        let control = system.control(H)?;
        let mut plan = [control.stage(&start); N];
        let optimum = control.solve(&start, Target::Place(goal), &mut plan)?;
        assert!(optimum.is_minimum() && optimum.iterations() <= 10 && optimum.violation() == 0.0, "{optimum:?}");
        assert!(
            (optimum.price() - hurry - price).abs() < 1e-9 * (price + hurry),
            "{} after {price}",
            optimum.price() - hurry
        );
        for (k, stage) in plan.iter().enumerate() {
            let expected = vector![inputs[2 * k], inputs[2 * k + 1]];
            assert!((stage.input() - expected).norm() < 1e-8 * inputs.amax(), "{} after {expected}", stage.input());
            let z = stage.multipliers().x;
            assert!((z - multipliers[k]).abs() < 1e-7 * multipliers.amax(), "{z} after {}", multipliers[k]);
            assert!(stage.active()[0]);
        }
    }
    Ok(())
}

/// From a plan that is solved nothing is left to do, and one correction follows a start that moves.
#[test]
fn plans_with_equations_are_resumed() -> Result<(), Error> {
    let random = &mut Random::new(3402);
    let system = Balanced { lever: 0.7, spring: 0.4, load: 0.3, hurry: 0.0 };
    let control = system.clone().control(H)?;
    let (start, goal) = (random.vector(), random.vector());
    let mut plan = [control.stage(&start); N];
    control.solve(&start, Target::Place(goal), &mut plan)?;
    let before = plan.map(|stage| *stage.input());
    let again = control.solve(&start, Target::Place(goal), &mut plan)?;
    assert!(again.iterations() <= 2, "{again:?}");
    assert!(plan.iter().zip(&before).all(|(stage, u)| (stage.input() - u).norm() < 1e-9 * (1.0 + u.norm())));
    for _ in 0..10 {
        let start = start + 0.1 * random.vector::<4>();
        let (rows, wanted) = equations(&system, &start, &goal);
        let (_, inputs, _) = least_norm(&rows, &wanted);
        let reached = control.solve_within(&start, Target::Place(goal), Limits { sweeps: 1 }, &mut plan)?;
        assert_eq!((reached.ended(), reached.violation() < 1e-6), (Ended::AtLimit, true), "{reached:?}");
        for (k, stage) in plan.iter().enumerate() {
            let expected = vector![inputs[2 * k], inputs[2 * k + 1]];
            assert!((stage.input() - expected).norm() < 1e-5 * inputs.amax(), "{} after {expected}", stage.input());
        }
    }
    Ok(())
}

/// The sum of all z is the slope of the least price along the load, with its sign turned. Equations count for the best step size.
#[test]
fn multipliers_of_equations_are_slopes_of_the_price() -> Result<(), Error> {
    let (start, goal) = (vector![0.3, -0.2, 0.5, 0.1], vector![1.0, 0.4, -0.3, 0.2]);
    let solved = |load: f64, h: f64| {
        let control = Balanced { lever: 0.7, spring: 0.4, load, hurry: 4.0 }.control(h)?;
        let mut plan = [control.stage(&start); N];
        let price = control.solve(&start, Target::Place(goal), &mut plan)?.price();
        Ok::<_, Error>((price, plan.iter().map(|stage| stage.multipliers().x).sum::<f64>()))
    };
    let (step, (_, sum)) = (1e-4, solved(0.3, H)?);
    let slope = (solved(0.3 + step, H)?.0 - solved(0.3 - step, H)?.0) / (2.0 * step);
    assert!((slope + sum).abs() < 1e-6 * sum.abs(), "{slope} after {}", -sum);
    let control = Balanced { lever: 0.7, spring: 0.4, load: 0.3, hurry: 4.0 }.control(H)?;
    let mut plan = [control.stage(&start); N];
    let found = control.solve_free_time(&start, Target::Place(goal), 0.01..=1.0, &mut plan)?;
    let (h, price) = (found.step_size(), found.price());
    for near in [h * 0.999, h * 1.001] {
        assert!(solved(0.3, near)?.0 > price, "{} at {near}, {price} at {h}", solved(0.3, near)?.0);
    }
    Ok(())
}

/// A car that could move sideways, and does not, is one with fewer inputs.
#[test]
fn an_input_that_vanishes_is_none() -> Result<(), Error> {
    let random = &mut Random::new(3403);
    for _ in 0..long(40) {
        let (turning, fastest) = (0.3 + random.number().abs(), 1.5 + random.number().abs());
        let goal = place(2.0 * random.number(), random.number(), random.number());
        let start = Matrix3::identity();
        let car = WheeledCar { turning, fastest }.control(0.04)?;
        let mut plan = [car.stage(&start); 30];
        let found = car.solve(&start, Target::Place(goal), &mut plan)?;
        assert!(found.is_minimum() && found.violation() == 0.0, "{found:?}");
        let price = found.price();
        // its plan is one of the car with two inputs, and of least price there
        let other = Unicycle { turning, fastest }.control(0.04)?.with_end_reference(Vector2::zeros())?;
        let mut same = plan.map(|stage| other.stage(&start).with_input(stage.input().xy()));
        let found = other.solve(&start, Target::Place(goal), &mut same)?;
        assert!((found.price() - price).abs() < 1e-7 * price, "{} after {price}", found.price());
        for (stage, other) in plan.iter().zip(&same) {
            assert!((stage.input().xy() - other.input()).norm() < 1e-5 && stage.input().z.abs() < 1e-12);
        }
    }
    Ok(())
}

#[test]
fn a_line_of_sight_stays_on_its_star() -> Result<(), Error> {
    let random = &mut Random::new(3404);
    for _ in 0..long(12) {
        let start = (random.attitude::<3>(), Vector3::zeros());
        let inertia = random.inertia::<3>();
        let star = start.0 * Vector3::z();
        let angle = 2.0 * random.number();
        let turn = place(angle, 0.0, 0.0);
        let control = Pointed { inertia, star }.control(H)?;
        let mut plan = [control.stage(&start); N];
        let found = control.solve(&start, Target::Place((start.0 * turn, Vector3::zeros())), &mut plan)?;
        assert!(found.is_minimum() && found.violation() == 0.0, "{found:?}");
        assert!(plan.iter().all(|stage| (stage.place().0 * Vector3::z() - star).norm() < 1e-12));
        // all turns are about the line of sight
        let turned = plan.map(|stage| start.0.transpose() * stage.place().0);
        assert!(turned.iter().all(|turn| (turn[(2, 2)] - 1.0).abs() < 1e-12));
    }
    Ok(())
}

/// Equations that say the same are satisfied, and those that contradict each other, or the start, are told.
#[test]
fn equations_agree_or_are_told() -> Result<(), Error> {
    let start = Vector2::new(0.5, 0.0);
    let solve = |place: f64, other: f64| {
        let control: Control<_, 2, 1, 2> = Placed { place, other }.control(H)?;
        let mut plan = [control.stage(&start).with_input(Vector1::new(0.3)); 5];
        let found = control.solve(&start, Target::Free, &mut plan).map(|found| found.price());
        found.map(|price| (price, plan.map(|stage| stage.place().x)))
    };
    let (price, places) = solve(0.5, 0.5)?;
    assert!(price < 1e-20 && places.iter().all(|x| (x - 0.5).abs() < 1e-13), "{price} {places:?}");
    // the start is where it is, and the first step leads to the place
    let (price, places) = solve(0.6, 0.6)?;
    assert!(price > 0.1 && places[1..].iter().all(|x| (x - 0.6).abs() < 1e-13), "{price} {places:?}");
    let error = solve(0.5, 0.6).expect_err("no plan satisfies them");
    let Error::Infeasible { stage, violation, bound } = error else { panic!("{error}") };
    assert!(
        (1..5).contains(&stage) && ["x.x == self.other", "x == vector![self.place, x.y]"].contains(&bound),
        "{error}"
    );
    // a part of the 0.1 that they differ by
    assert!(violation > 0.01 && violation < 0.11, "{error}");
    Ok(())
}

/// In single precision too, equations of places hold to rounding. Both forces are opposite, so that a step costs three times the price of one.
#[test]
fn equations_hold_in_single_precision() -> Result<(), Error> {
    let random = &mut Random::new(3405);
    let rows = DMatrix::from_fn(2, N, |i, k| if i == 0 { H * H * (N - k) as f64 } else { H });
    let (price, ..) = least_norm(&rows, &DVector::from_vec(vec![-1.2, 0.0]));
    for _ in 0..long(20) {
        let lean = random.number() as f32;
        let control = Leaning { lean }.control(0.1)?;
        let start = Vector4::new(0.5 + lean, -0.5, 0.0, 0.0);
        let goal = Vector4::new(lean - 0.7, 0.7, 0.0, 0.0);
        let mut plan = [control.stage(&start); N];
        let found = control.solve(&start, Target::Place(goal), &mut plan)?;
        assert!(found.is_minimum() && found.iterations() <= 30, "{found:?}");
        let relative = f64::from(found.price()) / (3.0 * price) - 1.0;
        assert!(relative.abs() < 1e-5, "{} after {}", found.price(), 3.0 * price);
        assert!(plan.iter().all(|stage| (stage.place().x + stage.place().y - lean).abs() < 1e-5));
    }
    Ok(())
}
