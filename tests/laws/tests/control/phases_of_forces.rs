//! Forces that read references: parts of the input of a stepper that a plan does not choose.

use super::{derivatives, long, place};
use clebsch::{Clebsch, Controlled, Error, Limits, Referring, Target};
use clebsch_tests::fixtures::gripping_disc::GrippingDisc;
use clebsch_tests::oracle::random::Random;
use derivatives::Chart;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Quaternion, Vector1, Vector2, Vector3, vector};

/// A body with wheels in a frame that is given, in wind.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |t, R| self.weight * (1 + t) * R[(2, 2)],
    force      = |R, omega, torque: Vector3, (grip, frame): (Vector1, Matrix3), wind, turn: Quaternion| {
        grip.x * frame * torque - self.drag * turn.w * (omega - R.transpose() * wind)
    },
    effort     = |h, R, omega, torque, wanted: Matrix3, wind: Vector3, grip| {
        h * (torque.norm_squared() + (1 + grip.x) * (omega - wind).norm_squared() + (R - wanted).norm_squared()) / 2
    },
    bounds     = |omega, torque, wind| [torque.x <= self.top + wind.x.powi(2), omega.norm_squared() <= 9],
    endpoint   = |R, omega, wanted| ((R - wanted).norm_squared() + omega.norm_squared()) / 2,
    method Fourth = (order = 4),
)]
struct Wheeled {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    weight: f64,
    drag: f64,
    top: f64,
}

/// Compositions of five steps.
struct Fourth;

/// The same with fields.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |t, R| self.weight * (1 + t) * R[(2, 2)],
    force      = |R, omega, torque: Vector3| {
        self.grip * self.frame * torque - self.drag * (omega - R.transpose() * self.wind)
    },
    effort     = |h, R, omega, torque| {
        h * (torque.norm_squared() + (1 + self.grip) * (omega - self.wind).norm_squared() + (R - self.wanted).norm_squared()) / 2
    },
    bounds     = |omega, torque| [torque.x <= self.top + self.wind.x.powi(2), omega.norm_squared() <= 9],
    endpoint   = |R, omega| ((R - self.wanted).norm_squared() + omega.norm_squared()) / 2,
)]
struct WheeledByFields {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    weight: f64,
    drag: f64,
    top: f64,
    grip: f64,
    frame: Matrix3<f64>,
    wind: Vector3<f64>,
    wanted: Matrix3<f64>,
}

/// A mass on a spring that is hardened, with a price in soft bounds, and one reference in all.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |a: Translation<2>, x: Vector2| x + a,
    cost     = |h, a| self.mass * a.norm_squared() / (2 * h),
    force    = |v, push: Vector2, spring| push - spring.x * v,
    force_on = |x, v, spring| -spring.x * (1 + x.norm_squared()) * x - v.norm_squared() * v,
    effort   = |h, x, push, spring: Vector1| h * (push.norm_squared() / 2 + spring.x.powi(2) * x.x.abs()),
)]
struct Sprung {
    mass: f64,
}

/// A mass that thrusters push, whose directions and strengths are given.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, x: Vector2| x + a,
    lagrangian = |v| self.mass * v.norm_squared() / 2,
    force      = |push: Vector2, thrusters: Matrix2| thrusters * push,
    effort     = |h, push| h * push.norm_squared() / 2,
)]
struct Thrown {
    mass: f64,
}

const H: f64 = 0.1;
const N: usize = 16;

/// States of a vector and its momentum.
fn chart() -> Chart<(Vector2<f64>, Vector2<f64>), 4> {
    Chart {
        moved: |(x, n), delta| (x + delta.fixed_rows::<2>(0), n + delta.fixed_rows::<2>(2)),
        coordinates: |(x, n), (y, m)| {
            let (x, n) = (y - x, m - n);
            vector![x.x, x.y, n.x, n.y]
        },
    }
}

fn quaternion(random: &mut Random) -> Quaternion<f64> {
    Quaternion::from(random.vector::<4>())
}

fn body() -> Wheeled {
    Wheeled { inertia: Matrix3::from_diagonal(&vector![1.0, 1.5, 2.0]), weight: 0.4, drag: 0.3, top: 0.5 }
}

fn disc() -> GrippingDisc {
    GrippingDisc { mass: 1.4, friction: 0.8, price: 0.5, strongest: 3.0, fastest: 2.0 }
}

#[test]
fn derivatives_of_forced_steps_read_references() {
    let random = &mut Random::new(9201);
    for _ in 0..4 {
        let body = body();
        let of_force = (random.vector::<1>(), random.rotation::<3>(1.0));
        let reference = (of_force, quaternion(random), random.vector::<3>(), random.rotation::<3>(1.0));
        let end_reference = random.rotation::<3>(1.0);
        let x = (random.rotation::<3>(1.0), random.vector::<3>());
        let constants = |h| Referring { reference, end_reference, ..body.prepare(h).expect("regular parameters") };
        derivatives::check_with(&body, &constants, &derivatives::chart_of_bodies(), &x, random);

        let (disc, reference) = (disc(), (random.vector::<1>(), random.vector::<2>()));
        let x = (random.vector::<2>(), random.vector::<2>());
        let constants = |h| Referring { reference, ..disc.prepare(h).expect("regular parameters") };
        derivatives::check_with(&disc, &constants, &chart(), &x, random);

        let (sprung, reference) = (Sprung { mass: 1.3 }, random.vector::<1>());
        let constants = |h| Referring { reference, ..sprung.prepare(h).expect("regular parameters") };
        derivatives::check_with(&sprung, &constants, &chart(), &x, random);
        let prices = sprung.bound_prices(&constants(H), 0.0);
        // |x| is 2 max(x, 0) − x
        assert!(prices.iter().all(|price| (price - 2.0 * H * reference.x.powi(2)).abs() < 1e-15), "{prices}");
    }
}

#[test]
fn steps_of_plans_are_those_of_the_stepper() -> Result<(), Error> {
    let random = &mut Random::new(9202);
    for _ in 0..10 {
        let (control, stepper) = (disc().control(H)?, disc().into_stepper(H)?);
        let (push, grip, x) = (random.vector::<2>(), random.vector::<1>(), (random.vector(), random.vector()));
        let next = stepper.step_with(&stepper.state(x.0, x.1)?, &(push, grip))?;
        let (place, momentum) = control.follow_with(&x, &push, &(grip, random.vector()))?;
        assert_eq!((place, momentum), (*next.configuration(), next.momentum()));

        let (control, stepper) = (body().control(H)?, body().into_stepper(H)?);
        let of_force = (random.vector::<1>(), random.rotation::<3>(1.0));
        let (torque, turn, wind) = (random.vector::<3>(), quaternion(random), random.vector::<3>());
        let x = (random.rotation::<3>(1.0), random.vector::<3>());
        let next = stepper.step_with(&stepper.state(x.0, x.1)?, &(torque, of_force, turn, wind))?;
        let followed = control.follow_with(&x, &torque, &(of_force, turn, wind, Matrix3::identity()))?;
        assert!((followed.0 - next.configuration()).amax() < 1e-14 && (followed.1 - next.momentum()).amax() < 1e-14);
    }
    Ok(())
}

/// A method takes the references of forces as the declared steps do, and comes nearer to the motion.
#[test]
fn methods_read_the_references_of_forces() -> Result<(), Error> {
    let random = &mut Random::new(9212);
    for _ in 0..5 {
        let of_force = (random.vector::<1>(), random.rotation::<3>(1.0));
        let input = (random.vector::<3>(), of_force, quaternion(random), random.vector::<3>());
        let x = (random.rotation::<3>(1.0), random.vector::<3>());
        let declared = |parts: usize| {
            let stepper = body().into_stepper(H / parts as f64)?;
            let mut state = stepper.state(x.0, x.1)?;
            for _ in 0..parts {
                state = stepper.step_with(&state, &input)?;
            }
            Ok::<_, Error>(state.momentum())
        };
        let stepper = body().into_stepper_by::<Fourth>(H)?;
        let fourth = stepper.step_with(&stepper.state(x.0, x.1)?, &input)?.momentum();
        let motion = declared(256)?;
        let [coarse, fine] = [declared(1)?, fourth].map(|momentum| (momentum - motion).norm());
        assert!(fine < 0.1 * coarse, "{fine:e} of {coarse:e}");
    }
    Ok(())
}

#[test]
fn references_that_stay_the_same_give_the_plans_of_fields() -> Result<(), Error> {
    const N: usize = if cfg!(feature = "heavy") { 16 } else { 8 };
    let random = &mut Random::new(9203);
    for _ in 0..long(4) {
        let Wheeled { inertia, weight, drag, top } = body();
        let (grip, frame) = (random.between(0.5, 1.5), random.rotation::<3>(1.0));
        let (wind, wanted) = (random.vector::<3>() / 3.0, place(random.number(), 0.0, 0.0));
        let turn = quaternion(random);
        let slowed = drag * turn.w;
        let fields = WheeledByFields { inertia, weight, drag: slowed, top, grip, frame, wind, wanted }.control(H)?;
        let control = body().control(H)?.with_end_reference(wanted)?;
        let start = (Matrix3::identity(), random.vector::<3>() / 2.0);
        let target = Target::Configuration((wanted, Vector3::zeros()));
        let mut expected = [fields.stage(&start); N];
        let price = fields.solve(&start, target, &mut expected)?.price();
        let mut plan = [control.stage(&start); N];
        control.refer(&mut plan, |_, _| ((vector![grip], frame), turn, wind, wanted));
        let found = control.solve(&start, target, &mut plan)?.price();
        assert!((price - found).abs() < 1e-10 * price, "{price} {found}");
        assert!(plan.iter().zip(&expected).all(|(a, b)| (a.input() - b.input()).amax() < 1e-6));
        let mut plan = [control.stage(&start); N];
        control.refer(&mut plan, |_, _| ((vector![grip], frame), turn, wind, wanted));
        let found = control.solve_free_time(&start, target, 0.05..=0.2, &mut plan)?.step_size();
        let free = fields.solve_free_time(&start, target, 0.05..=0.2, &mut expected)?.step_size();
        assert!((found - free).abs() < 1e-6 * free, "{found} {free}");
    }
    Ok(())
}

#[test]
fn phases_of_thrusters_are_those_of_linear_algebra() -> Result<(), Error> {
    let random = &mut Random::new(9204);
    for _ in 0..8 {
        let mass = random.between(0.5, 2.0);
        let (first, second) = (random.matrix::<2, 2>(), random.matrix::<2, 2>());
        // one thruster fails by the way
        let thrusters = |k: usize| match k {
            5 => Matrix2::zeros(),
            0..9 => first,
            _ => second,
        };
        let (start, goal) =
            ((random.vector::<2>(), random.vector::<2>()), (random.vector::<2>(), random.vector::<2>()));
        let control = Thrown { mass }.control(H)?;
        let mut plan = [control.stage(&start); N];
        control.refer(&mut plan, |k, _| thrusters(k));
        let optimum = control.solve(&start, Target::Place(goal), &mut plan)?;
        assert!(optimum.is_minimum() && optimum.iterations() <= 4, "{optimum:?}");
        // Half of the impulse h f acts at each end of a step.
        // So x_N = x + (h/m) (N p + Σ (N − k − ½) h f_k) and p_N = p + Σ h f_k
        let mut reach = DMatrix::<f64>::zeros(4, 2 * N);
        for k in 0..N {
            let impulse = H * thrusters(k);
            reach.view_mut((0, 2 * k), (2, 2)).copy_from(&(impulse * (H / mass * ((N - k) as f64 - 0.5))));
            reach.view_mut((2, 2 * k), (2, 2)).copy_from(&impulse);
        }
        let drift = goal.0 - start.0 - start.1 * (H * N as f64 / mass);
        let change = goal.1 - start.1;
        let right = DVector::from_column_slice(&[drift.x, drift.y, change.x, change.y]);
        let least = reach.svd(true, true).solve(&right, 1e-12).expect("both factors");
        for (k, stage) in plan.iter().enumerate() {
            let expected = vector![least[2 * k], least[2 * k + 1]];
            assert!(
                (stage.input() - expected).amax() < 1e-8 * (1.0 + least.amax()),
                "{k}: {} {expected}",
                stage.input()
            );
        }
    }
    Ok(())
}

#[test]
fn a_disc_pushes_where_it_grips() -> Result<(), Error> {
    let control = disc().control(H)?;
    let start = (Vector2::zeros(), Vector2::zeros());
    let grips = |k: usize| k % 8 < 5;
    let mut plan = [control.stage(&start); N];
    control.refer(&mut plan, |k, _| (vector![if grips(k) { 1.0 } else { 0.0 }], Vector2::zeros()));
    let optimum = control.solve(&start, Target::Configuration((vector![1.0, 0.5], Vector2::zeros())), &mut plan)?;
    assert!(optimum.is_minimum() && (optimum.end().0 - vector![1.0, 0.5]).amax() < 1e-10);
    let mut x = start;
    for (k, stage) in plan.iter().enumerate() {
        assert!((stage.place().0 - x.0).amax() < 1e-11 && (stage.place().1 - x.1).amax() < 1e-11);
        assert!(grips(k) || stage.input().amax() < 1e-6, "{k}: {}", stage.input());
        assert!(stage.input().x <= 3.0 * stage.reference().0.x + 1e-9);
        x = control.follow_with(&x, stage.input(), stage.reference())?;
    }
    Ok(())
}

#[test]
fn forces_without_their_references_are_told() -> Result<(), Error> {
    let control = disc().control(H)?;
    let (start, push) = ((Vector2::zeros(), Vector2::x()), Vector2::x());
    let given = (Vector1::new(1.0), Vector2::zeros());
    let mut plan = [control.stage(&start); 4];
    control.refer(&mut plan, |k, _| if k == 2 { (Vector1::new(f64::NAN), Vector2::zeros()) } else { given });
    let missing = Err(Error::NoReference { step: 2, steps: 4 });
    assert_eq!(control.solve(&start, Target::Free, &mut plan).map(|_| ()), missing);
    assert_eq!(control.solve_within(&start, Target::Free, Limits { sweeps: 1 }, &mut plan).map(|_| ()), missing);
    plan[2] = plan[2].with_reference(given);
    control.solve(&start, Target::Free, &mut plan)?;
    let one = Error::NoReference { step: 0, steps: 1 };
    assert_eq!(control.follow(&start, &push), Err(one));
    assert_eq!(control.follow_with(&start, &push, &(Vector1::new(f64::NAN), Vector2::zeros())), Err(one));
    assert!(control.follow_with(&start, &push, &given).is_ok());
    let constants = disc().prepare(H)?;
    let zeros = vector![0.0, 0.0, 0.0, 0.0];
    assert_eq!(disc().expand(&constants, 0.0, &start, &push, &zeros).map(|_| ()), Err(one));
    assert_eq!(disc().price_of_time(&constants, 0.0, 1.0, &start, &push, &zeros), Err(one));
    Ok(())
}
