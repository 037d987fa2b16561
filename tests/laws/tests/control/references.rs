//! References: prices and bounds that read data of each step, against the same prices as functions of the time, and against linear algebra.

use super::{derivatives, long, place};
use clebsch::{Clebsch, Control, Controlled, Error, Limits, Referring, Stage, Target};
use clebsch_tests::fixtures::follower::Follower;
use clebsch_tests::oracle::random::Random;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Quaternion, SVector, Vector2, Vector3, Vector4, vector};

/// The car of the fixture, with its track and the place of the obstacle as functions of the time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |F: SE<2>, q: SE<2>| q * F,
    controls = |u: Vector2| vector![u.x, u.y, 0],
    cost     = |t, h, q, u| {
        let track = vector![2 * t.sin(), t];
        h * ((q.translation() - track).norm_squared() + self.price * u.norm_squared()) / 2
    },
    bounds   = |t, q| [self.clearance.powi(2) <= (q.translation() - vector![2 * t.sin() + 0.5, t]).norm_squared()],
    endpoint = |t, q| self.miss_price * (q.translation() - vector![2 * t.sin(), t]).norm_squared() / 2,
)]
struct Timed {
    price: f64,
    clearance: f64,
    miss_price: f64,
}

/// A body that turns after an attitude, at a rate.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, R, omega, torque, (wanted, rate): (Matrix3, Vector3)| {
        h * (torque.norm_squared() + (R - wanted).norm_squared() + self.rate_price * (omega - rate).norm_squared()) / 2
    },
    bounds     = |omega, torque, rate, top: Vector1| [torque.x <= top.x, (omega - rate).norm_squared() <= 4],
    endpoint   = |R, omega, wanted| ((R - wanted).norm_squared() + omega.norm_squared()) / 2,
)]
struct Turning {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    rate_price: f64,
}

/// The same with functions of the time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |t, h, R, omega, torque| {
        let wanted = matrix![t.cos(), -t.sin(), 0; t.sin(), t.cos(), 0; 0, 0, 1];
        let rate = vector![0, t / 3, 1];
        h * (torque.norm_squared() + (R - wanted).norm_squared() + self.rate_price * (omega - rate).norm_squared()) / 2
    },
    bounds     = |t, omega, torque| [torque.x <= 0.02 + t / 10, (omega - vector![0, t / 3, 1]).norm_squared() <= 4],
    endpoint   = |t, R, omega| {
        let wanted = matrix![t.cos(), -t.sin(), 0; t.sin(), t.cos(), 0; 0, 0, 1];
        ((R - wanted).norm_squared() + omega.norm_squared()) / 2
    },
)]
struct TurningInTime {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    rate_price: f64,
}

/// A mass between a reference and a price.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
    cost     = |h, x, u, track: Vector2| h * ((x - track).norm_squared() + self.price * u.norm_squared()) / 2,
    endpoint = |x, goal: Vector2| 3 * (x - goal).norm_squared() / 2,
)]
struct Mass {
    price: f64,
}

/// A body by quaternions in single precision, that turns after one, with limits in an array.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SU<2>, q: SU<2>| q * F,
    lagrangian = |omega| self.moment * omega.norm_squared() / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, q, torque, wanted: Quaternion| h * (torque.norm_squared() + 10 * (q - wanted).norm_squared()) / 2,
    bounds     = |torque, tops: [Vector1; 2]| [torque.x <= tops[0].x, torque.z <= tops[1].x],
    endpoint   = |q, omega, wanted| 10 * ((q - wanted).norm_squared() + omega.norm_squared()),
    scalar     = f32,
)]
struct Spinning {
    moment: f32,
}

/// The same with fields.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SU<2>, q: SU<2>| q * F,
    lagrangian = |omega| self.moment * omega.norm_squared() / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, q, torque| h * (torque.norm_squared() + 10 * (q - Quaternion::new(self.wanted.w, self.wanted.x, self.wanted.y, self.wanted.z)).norm_squared()) / 2,
    bounds     = |torque| [torque.x <= self.tops.x, torque.z <= self.tops.y],
    endpoint   = |q, omega| 10 * ((q - Quaternion::new(self.wanted.w, self.wanted.x, self.wanted.y, self.wanted.z)).norm_squared() + omega.norm_squared()),
)]
struct SpinningByFields {
    moment: f32,
    wanted: Vector4<f32>,
    tops: Vector2<f32>,
}

const H: f64 = 0.1;
const N: usize = 25;

fn track(t: f64) -> Vector2<f64> {
    vector![2.0 * t.sin(), t]
}

/// A turn about the vertical, in space and in the plane.
fn rotation(t: f64) -> Matrix3<f64> {
    place(t, 0.0, 0.0)
}

fn inputs<S, const D: usize, const U: usize, const C: usize>(plan: &[Stage<S, D, U, C>]) -> Vec<SVector<f64, U>>
where
    S: Controlled<D, U, C, Scalar = f64>,
{
    plan.iter().map(|stage| *stage.input()).collect()
}

/// Unturned, at a point.
fn at(point: &Vector2<f64>) -> Matrix3<f64> {
    place(0.0, point.x, point.y)
}

/// The largest difference of two lists of inputs.
fn apart<const U: usize>(a: &[SVector<f64, U>], b: &[SVector<f64, U>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max)
}

#[test]
fn references_that_are_functions_of_the_time_give_the_plans_of_these_functions() -> Result<(), Error> {
    let random = &mut Random::new(877);
    for _ in 0..long(20) {
        let (price, clearance, miss_price) =
            (random.between(0.01, 0.05), random.between(0.2, 0.3), random.between(0.0, 2.0));
        let begin = random.between(0.0, 2.0);
        let start = at(&(track(begin) - vector![0.5, 0.0] + random.vector::<2>() / 5.0));
        let guess = [(); N].map(|()| random.vector::<2>() / 5.0);
        let timed = Timed { price, clearance, miss_price }.control(H)?.starting_at(begin)?;
        let mut plan = guess.map(|u| timed.stage(&start).with_input(u));
        let optimum = timed.solve(&start, Target::Free, &mut plan)?;
        let (expected, sweeps) = (optimum.price(), optimum.iterations());
        let referring = Follower { price, clearance, miss_price }.control(H)?.starting_at(begin)?;
        let referring = referring.with_end_reference(track(begin + H * N as f64))?;
        let mut referred = guess.map(|u| referring.stage(&start).with_input(u));
        referring.refer(&mut referred, |_, t| (track(t), track(t) + vector![0.5, 0.0]));
        let found = referring.solve(&start, Target::Free, &mut referred)?.price();
        // a price of places curves down far from its track, and still each correction goes down
        assert!(sweeps <= 80, "{sweeps}");
        assert!((expected - found).abs() < 1e-10 * (1.0 + expected));
        assert!(apart(&inputs(&plan), &inputs(&referred)) < 1e-6);
    }
    Ok(())
}

#[test]
fn later_attempts_read_the_same_references() -> Result<(), Error> {
    let random = &mut Random::new(877);
    let (price, clearance, miss_price) = (1.0, 0.05, 0.0);
    let timed = Timed { price, clearance, miss_price }.control(H)?;
    let referring = Follower { price, clearance, miss_price }.control(H)?.with_end_reference(track(H * N as f64))?;
    for _ in 0..long(8) {
        // from a guess that leads elsewhere
        let (start, input) = (rotation(random.number()), random.vector::<2>() * 3.0);
        let target = Target::Place(at(&(random.vector::<2>() * 2.0)) * rotation(random.number() * 3.0));
        let expected = timed.solve(&start, target, &mut [timed.stage(&start).with_input(input); N])?.price();
        let mut plan = [referring.stage(&start).with_input(input); N];
        referring.refer(&mut plan, |_, t| (track(t), track(t) + vector![0.5, 0.0]));
        let found = referring.solve(&start, target, &mut plan)?.price();
        assert!((expected - found).abs() < 1e-10 * (1.0 + expected));
    }
    Ok(())
}

#[test]
fn velocities_have_references_too() -> Result<(), Error> {
    let random = &mut Random::new(878);
    for _ in 0..long(4) {
        let inertia = Matrix3::from_diagonal(&vector![1.0, 1.5, 2.0]);
        let rate_price = random.between(0.0, 1.0);
        let (begin, start) = (random.between(0.0, 1.0), (rotation(random.between(0.0, 1.0)), random.vector::<3>()));
        let timed = TurningInTime { inertia, rate_price }.control(H)?.starting_at(begin)?;
        let referring = Turning { inertia, rate_price }.control(H)?.starting_at(begin)?;
        let referring = referring.with_end_reference((rotation(begin + H * N as f64), Vector3::zeros()))?;
        let mut plan = [timed.stage(&start); N];
        let mut referred = [referring.stage(&start); N];
        referring.refer(&mut referred, |k, t| {
            assert!((t - begin - H * k as f64).abs() < 1e-15);
            ((rotation(t), vector![0.0, t / 3.0, 1.0]), vector![0.02 + t / 10.0])
        });
        let expected = timed.solve(&start, Target::Free, &mut plan)?.price();
        let found = referring.solve(&start, Target::Free, &mut referred)?.price();
        assert!((expected - found).abs() < 1e-11 * expected, "{expected} {found}");
        assert!(apart(&inputs(&plan), &inputs(&referred)) < 1e-7);
    }
    Ok(())
}

#[test]
fn quaternions_and_arrays_are_references() -> Result<(), Error> {
    let wanted = Quaternion::new(0.6, 0.0, 0.0, 0.8);
    let start = (Quaternion::new(1.0, 0.0, 0.0, 0.0), Vector3::new(0.3, 0.0, 0.0));
    let by_fields =
        SpinningByFields { moment: 1.2, wanted: vector![0.0, 0.0, 0.8, 0.6], tops: vector![0.5, 0.7] }.control(0.1)?;
    let mut plan = [by_fields.stage(&start); 20];
    let expected = by_fields.solve(&start, Target::Free, &mut plan)?.price();
    assert!(plan[0].active()[1], "a limit of the array matters");
    let control = Spinning { moment: 1.2 }.control(0.1)?.with_end_reference(wanted)?;
    let mut plan = [control.stage(&start); 20];
    control.refer(&mut plan, |_, _| (wanted, [vector![0.5], vector![0.7]]));
    let found = control.solve(&start, Target::Free, &mut plan)?.price();
    assert!((expected - found).abs() < 1e-5 * expected, "{expected} {found}");
    Ok(())
}

/// The inputs of least price, from the normal equations of all steps at once.
fn by_linear_algebra(price: f64, start: &Vector2<f64>, tracks: &[Vector2<f64>], goal: &Vector2<f64>) -> DVector<f64> {
    let step = Matrix2::new(1.0, H, 0.0, 1.0);
    let steps = tracks.len();
    let mut matrix = DMatrix::<f64>::identity(steps, steps) * (H * price);
    let mut right = DVector::zeros(steps);
    // x_k = x + rows · u, that of step j being A^{k−1−j} (0, h)
    let mut free = *start;
    let ends = tracks.iter().map(|track| (H, track)).chain([(3.0, goal)]);
    for (k, (weight, wanted)) in ends.enumerate() {
        let rows = DMatrix::from_fn(2, steps, |i, j| match k.checked_sub(1 + j) {
            Some(later) => (step.pow(later as u32) * vector![0.0, H])[i],
            None => 0.0,
        });
        matrix += weight * rows.transpose() * &rows;
        right += weight * rows.transpose() * DVector::from_column_slice((wanted - free).as_slice());
        free = step * free;
    }
    matrix.lu().solve(&right).expect("regular")
}

#[test]
fn a_track_is_followed_as_linear_algebra_says() -> Result<(), Error> {
    let random = &mut Random::new(879);
    for _ in 0..10 {
        let price = 0.01 + random.between(0.0, 1.0);
        let (start, goal) = (random.vector::<2>(), random.vector::<2>());
        let tracks = [(); N].map(|()| random.vector::<2>());
        let control = Mass { price }.control(H)?.with_end_reference(goal)?;
        let mut plan = [control.stage(&start); N];
        control.refer(&mut plan, |k, _| tracks[k]);
        assert!(control.solve(&start, Target::Free, &mut plan)?.is_minimum());
        let expected = by_linear_algebra(price, &start, &tracks, &goal);
        plan.iter().zip(&expected).for_each(|(stage, u)| assert!((stage.input().x - u).abs() < 1e-11));
    }
    Ok(())
}

#[test]
fn a_shifted_plan_moves_its_references() -> Result<(), Error> {
    let control = Mass { price: 0.1 }.control(H)?.with_end_reference(Vector2::zeros())?;
    let mut plan = [control.stage(&Vector2::x()); 4];
    control.refer(&mut plan, |k, _| Vector2::new(k as f64, 0.0));
    control.solve(&Vector2::x(), Target::Free, &mut plan)?;
    assert_eq!(plan.map(|stage| stage.reference().x), [0.0, 1.0, 2.0, 3.0]);
    control.shift(&mut plan, 2);
    assert_eq!(plan.map(|stage| stage.reference().x), [2.0, 3.0, 3.0, 3.0]);
    assert_eq!(plan[0].with_reference(Vector2::y()).reference(), &Vector2::y());
    Ok(())
}

#[test]
fn references_that_are_not_given_are_told() -> Result<(), Error> {
    let control = Mass { price: 0.1 }.control(H)?;
    let start = Vector2::x();
    let mut plan = [control.stage(&start); 4];
    let missing = |step| Err(Error::NoReference { step, steps: 4 });
    let solved = |plan: &mut _, control: &Control<_, 2, 1, 0>| {
        let within = control.solve_within(&start, Target::Free, Limits { sweeps: 1 }, plan).map(|_| ());
        let solved = control.solve(&start, Target::Free, plan).map(|_| ());
        assert_eq!(within, solved);
        let in_time = control.solve_free_time(&start, Target::Free, 0.05..=0.2, plan).map(|_| ());
        assert_eq!(in_time, solved);
        solved
    };
    assert_eq!(solved(&mut plan, &control), missing(0));
    control.refer(&mut plan, |k, _| if k == 2 { Vector2::new(0.0, f64::INFINITY) } else { Vector2::zeros() });
    assert_eq!(solved(&mut plan, &control), missing(2));
    control.refer(&mut plan, |_, _| Vector2::zeros());
    assert_eq!(solved(&mut plan, &control), missing(4));
    let name = "the reference of the end";
    let not_finite = control.clone().with_end_reference(Vector2::new(f64::NAN, 0.0)).map(|_| ());
    assert_eq!(not_finite, Err(Error::NotFinite { name }));
    let control = control.with_end_reference(Vector2::zeros())?;
    control.solve(&start, Target::Free, &mut plan)?;
    // the time of each plan is another, and its references are the same
    let mut plan = [control.stage(&start); 4];
    control.refer(&mut plan, |_, _| Vector2::zeros());
    assert!(control.solve_free_time(&start, Target::Free, 0.05..=0.2, &mut plan).is_ok());
    Ok(())
}

#[test]
fn derivatives_of_prices_and_bounds_read_references() {
    let random = &mut Random::new(880);
    for _ in 0..4 {
        let (car, end_reference) = (Follower { price: 0.3, clearance: 0.4, miss_price: 0.7 }, random.vector::<2>());
        let reference = (random.vector::<2>(), random.vector::<2>());
        let x = at(&random.vector::<2>()) * rotation(random.number());
        let constants = |constants| Referring { constants, reference, end_reference };
        derivatives::check_with(&car, &constants, &derivatives::chart_of_plane(), &x, random);

        let body = Turning { inertia: Matrix3::from_diagonal(&vector![1.0, 1.5, 2.0]), rate_price: 0.8 };
        let reference = ((random.rotation::<3>(1.0), random.vector::<3>()), random.vector::<1>());
        let end_reference = (random.rotation::<3>(1.0), random.vector::<3>());
        let x = (random.rotation::<3>(1.0), random.vector::<3>());
        let constants = |h| Referring { reference, end_reference, ..body.prepare(h).expect("regular parameters") };
        derivatives::check_with(&body, &constants, &derivatives::chart_of_bodies(), &x, random);
    }
}
