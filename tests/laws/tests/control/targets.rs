//! Targets that are conditions of the end: against least norms, quadratic programs, and searches over places that satisfy them.

use super::derivatives::{self, chart_of_bodies};
use clebsch::{Clebsch, Control, Controlled, Ended, Error, Limits, Referring, Target};
use clebsch_tests::fixtures::telescope::Telescope;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3, vector};

const H: f64 = 0.1;
const N: usize = 20;

/// A mass that is pushed to a place, with any velocity.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
    cost     = |h, u| h * u.norm_squared() / 2,
    target   = |x| [x.x == self.place],
)]
struct Pushed {
    place: f64,
}

/// A mass that is pushed into a corner of places and velocities.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
    cost     = |h, u| h * u.norm_squared() / 2,
    target   = |x| [self.place <= x.x, x.y <= self.fastest],
)]
struct Cornered {
    place: f64,
    fastest: f64,
}

/// A mass in the plane that is pushed to a circle.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector4, u: Vector2| x + h * vector![x.z, x.w, u.x, u.y],
    cost     = |h, u| h * u.norm_squared() / 2,
    target   = |x, circle: Vector3| [(x.x - circle.x).powi(2) + (x.y - circle.y).powi(2) == circle.z.powi(2)],
)]
struct Orbiting;

/// A mass that meets another one which moves, at the price of time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
    cost     = |h, u| h * (self.hurry + u.norm_squared()) / 2,
    target   = |t, x| [x == vector![1 + self.speed * t, self.speed]],
)]
struct Meeting {
    hurry: f64,
    speed: f64,
}

/// A unicycle that is to be somewhere, with any heading.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |F: SE<2>, q: SE<2>| q * F,
    controls = |u: Vector2| vector![u.x, u.y, 0],
    cost     = |h, u| h * (self.turning * u.x.powi(2) + u.y.powi(2)) / 2,
    bounds   = |u| [-self.fastest <= u.x, u.x <= self.fastest],
    target   = |q, goal: Vector2| [q.translation() == goal],
)]
pub(super) struct Unicycle {
    pub(super) turning: f64,
    pub(super) fastest: f64,
}

/// The effect of the inputs of a mass on its end.
fn reach() -> SMatrix<f64, 2, N> {
    let step = Matrix2::new(1.0, H, 0.0, 1.0);
    SMatrix::from_fn(|i, j| (step.pow((N - 1 - j) as u32) * vector![0.0, H])[i])
}

/// The end of a mass without inputs.
fn coasted(start: &Vector2<f64>) -> Vector2<f64> {
    vector![start.x + start.y * H * N as f64, start.y]
}

#[test]
fn a_place_with_any_velocity_is_reached_by_the_least_norm() -> Result<(), Error> {
    let random = &mut Random::new(3301);
    for _ in 0..10 {
        let (start, place) = (random.vector::<2>(), 3.0 * random.number());
        let row = reach().row(0).into_owned();
        let expected = row.transpose() * ((place - coasted(&start).x) / row.norm_squared());
        let control = Pushed { place }.control(H)?;
        let mut plan = [control.stage(&start); N];
        let optimum = control.solve(&start, Target::Conditions, &mut plan)?;
        assert!(optimum.is_minimum() && optimum.gap() < 1e-13 && optimum.iterations() <= 3, "{optimum:?}");
        let apart = plan.iter().zip(expected.iter()).map(|(stage, u)| (stage.input().x - u).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-11);
    }
    Ok(())
}

/// The least |u|² with these rows of the end.
fn least_norm<const R: usize>(rows: &SMatrix<f64, R, N>, wanted: &SVector<f64, R>) -> (f64, SVector<f64, R>) {
    let inverse = (rows * rows.transpose()).try_inverse().expect("independent rows");
    let forces = inverse * wanted;
    (wanted.dot(&forces) * H / 2.0, forces)
}

#[test]
fn inequalities_of_the_end_are_those_of_a_quadratic_program() -> Result<(), Error> {
    let random = &mut Random::new(3302);
    let mut met = [0; 4];
    for _ in 0..40 {
        let (start, place, fastest) = (random.vector::<2>(), random.number(), random.number());
        let coasted = coasted(&start);
        // each set of active conditions, with forces that push the right way and others that hold
        let rows = reach();
        let missing = vector![place - coasted.x, fastest - coasted.y];
        let of_row = |i: usize| {
            let row = rows.row(i).into_owned();
            let (price, force) = least_norm(&row, &vector![missing[i]]);
            let other = (rows.row(1 - i) * row.transpose()).x * force.x - missing[1 - i];
            let pushes = if i == 0 { force.x >= 0.0 } else { force.x <= 0.0 };
            let holds = if i == 0 { other <= 0.0 } else { other >= 0.0 };
            (pushes && holds).then_some((i + 1, price))
        };
        let none = (missing.x <= 0.0 && missing.y >= 0.0).then_some((0, 0.0));
        let both = (3, least_norm(&rows, &missing).0);
        let (case, expected) = none.or_else(|| of_row(0)).or_else(|| of_row(1)).unwrap_or(both);
        met[case] += 1;
        let control = Cornered { place, fastest }.control(H)?;
        let mut plan = [control.stage(&start); N];
        let optimum = control.solve(&start, Target::Conditions, &mut plan)?;
        let end = optimum.end();
        assert!(end.x >= place - 1e-12 && end.y <= fastest + 1e-12 && optimum.violation() == 0.0);
        assert!((optimum.price() - expected).abs() < 1e-9 * (1.0 + expected), "{case}: {} {expected}", optimum.price());
    }
    assert!(met.iter().all(|count| *count > 1), "{met:?}");
    Ok(())
}

/// The place on a circle from which the price falls neither way, found among all of them.
#[test]
fn a_circle_is_reached_where_it_is_cheapest() -> Result<(), Error> {
    let random = &mut Random::new(3303);
    let row = reach().row(0).into_owned();
    for _ in 0..20 {
        let (place, velocity) = (random.vector::<2>() * 3.0, random.vector::<2>());
        let circle = vector![random.number(), random.number(), random.between(0.2, 1.0)];
        let coasted = place + velocity * (H * N as f64);
        // both axes alike: the nearest point of the circle to where the mass coasts
        let missing = ((coasted - circle.xy()).norm() - circle.z).abs();
        let expected = missing.powi(2) / row.norm_squared() * H / 2.0;
        let control = Orbiting.control(H)?.with_end_reference(circle)?;
        let start = vector![place.x, place.y, velocity.x, velocity.y];
        let mut plan = [control.stage(&start); N];
        let optimum = control.solve(&start, Target::Conditions, &mut plan)?;
        assert!(optimum.is_minimum(), "{optimum:?}");
        let found = optimum.price();
        assert!((found - expected).abs() < 1e-11 * (1.0 + expected), "{found} {expected} {optimum:?}");
    }
    Ok(())
}

fn telescope(random: &mut Random) -> Telescope {
    Telescope { inertia: random.inertia::<3>(), boresight: random.vector::<3>().normalize(), slow: 0.05 }
}

#[test]
fn derivatives_of_a_target_are_differences() {
    let random = &mut Random::new(3304);
    for _ in 0..4 {
        let star = random.vector::<3>();
        let telescope = telescope(random);
        let prepare = |h| {
            let constants = telescope.prepare(h).expect("regular");
            Referring { end_reference: star, ..constants }
        };
        let x = (random.attitude::<3>(), random.vector::<3>());
        derivatives::check_with::<_, 6, 3, 0>(&telescope, &prepare, &chart_of_bodies(), &x, random);
    }
}

/// A roll about the axis makes all attitudes that look at the star.
#[test]
fn a_telescope_chooses_its_roll() -> Result<(), Error> {
    let random = &mut Random::new(3305);
    for _ in 0..3 {
        let telescope = Telescope { slow: 0.0, ..telescope(random) };
        let star = random.vector::<3>().normalize();
        let start = (Matrix3::identity(), Vector3::zeros());
        // to rest: no rate is allowed but none
        let control = Resting::from(&telescope).control(0.5)?.with_end_reference(star)?;
        let mut plan = [control.stage(&start); N];
        let optimum = control.solve(&start, Target::Conditions, &mut plan)?;
        let (end, momentum) = *optimum.end();
        assert!(optimum.is_minimum() && (end * telescope.boresight - star).norm() < 1e-11 && momentum.norm() < 1e-11);
        let rolled = |angle: f64| {
            let axis = star.cross_matrix();
            let attitude = (Matrix3::identity() + axis * angle.sin() + axis * axis * (1.0 - angle.cos())) * end;
            let mut plan = [control.stage(&start); N];
            control.solve(&start, Target::Place((attitude, Vector3::zeros())), &mut plan).map(|found| found.price())
        };
        let least = rolled(0.0)?;
        assert!((least - optimum.price()).abs() < 1e-9 * least, "{least} {}", optimum.price());
        // a minimum over the roll: no slope, and higher on both sides
        let (a, b) = (rolled(1e-3)?, rolled(-1e-3)?);
        assert!((a - b).abs() < 1e-7 * least && a > least && b > least, "{a} {least} {b}");
    }
    Ok(())
}

/// The telescope with an equation for its rate.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, torque| h * torque.norm_squared() / 2,
    target     = |R, omega, star: Vector3| [R * self.boresight == star, omega == Vector3::zeros()],
)]
struct Resting {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    boresight: Vector3<f64>,
}

impl From<&Telescope> for Resting {
    fn from(Telescope { inertia, boresight, .. }: &Telescope) -> Self {
        Resting { inertia: *inertia, boresight: *boresight }
    }
}

/// Two unit vectors are equal along one of their axes: its equation follows from the others, and its slope vanishes at the end.
#[test]
fn equations_that_follow_from_others_are_no_obstacle() -> Result<(), Error> {
    let start = (Matrix3::identity(), Vector3::zeros());
    let (inertia, boresight) = (Matrix3::from_diagonal(&Vector3::new(4.0, 3.0, 2.0)), Vector3::x());
    for star in [Vector3::y(), Vector3::z(), -Vector3::y(), vector![1e-9, 1.0, 0.0]] {
        let control = Resting { inertia, boresight }.control(0.5)?.with_end_reference(star)?;
        let mut plan = [control.stage(&start); N];
        let optimum = control.solve(&start, Target::Conditions, &mut plan)?;
        assert!(optimum.gap() < 1e-12 && optimum.iterations() <= 20, "{star}: {optimum:?}");
    }
    Ok(())
}

/// |ω| has no slope at rest, where plans without a guess begin.
#[test]
fn a_norm_is_no_obstacle_at_rest() -> Result<(), Error> {
    let start = (Matrix3::identity(), Vector3::zeros());
    let control = Slowed { inertia: Matrix3::from_diagonal(&Vector3::new(4.0, 3.0, 2.0)), slow: 0.02 }.control(0.5)?;
    let mut plan = [control.stage(&start); N];
    let optimum = control.solve(&start, Target::Conditions, &mut plan)?;
    assert!(optimum.is_minimum() && (optimum.end().1.z / 2.0 - 0.02).abs() < 1e-12, "{optimum:?}");
    let undefined = Undefined.control(H)?;
    let mut plan = [undefined.stage(&Vector2::zeros()); N];
    let error = undefined.solve(&Vector2::zeros(), Target::Conditions, &mut plan).map(|found| found.price());
    assert_eq!(error, Err(Error::NotFinite { name: "the target at the end of the guessed plan" }));
    Ok(())
}

/// A body that looks to the left, with a small rate.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, torque| h * torque.norm_squared() / 2,
    target     = |R, omega| [R * Vector3::x() == Vector3::y(), omega.norm() <= self.slow],
)]
struct Slowed {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    slow: f64,
}

/// A condition that is no number at the guess.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
    cost     = |h, u| h * u.norm_squared() / 2,
    target   = |x| [(x.x - 1).sqrt() == 2],
)]
struct Undefined;

/// An allowance for the rate at the end makes slews cheaper, until none is felt.
#[test]
fn a_slower_end_is_dearer() -> Result<(), Error> {
    let random = &mut Random::new(3306);
    let telescope = telescope(random);
    let star = random.vector::<3>().normalize();
    let start = (Matrix3::identity(), Vector3::zeros());
    let resting = Resting::from(&telescope).control(0.5)?.with_end_reference(star)?;
    let mut plan = [resting.stage(&start); N];
    let mut dearer = resting.solve(&start, Target::Conditions, &mut plan)?.price();
    for slow in [0.001, 0.003, 0.01] {
        let control = Telescope { slow, ..telescope.clone() }.control(0.5)?.with_end_reference(star)?;
        let mut plan = [control.stage(&start); N];
        let optimum = control.solve(&start, Target::Conditions, &mut plan)?;
        let rate = telescope.inertia.try_inverse().expect("regular") * optimum.end().1;
        let most = slow * (1.0 + 0.5 * N as f64).sqrt();
        assert!(rate.norm() < most + 1e-11 && optimum.price() < dearer, "{slow}: {optimum:?}");
        dearer = optimum.price();
    }
    Ok(())
}

#[test]
fn a_moving_target_is_met_in_the_best_time() -> Result<(), Error> {
    let (start, hurry, speed) = (Vector2::zeros(), 0.5, 0.3);
    let control = Meeting { hurry, speed }.control(0.1)?;
    let mut plan = [control.stage(&start); N];
    let optimum = control.solve_free_time(&start, Target::Conditions, 0.02..=1.0, &mut plan)?;
    let best = optimum.step_size();
    let price = |h: f64| -> Result<f64, Error> {
        let control = Meeting { hurry, speed }.control(h)?;
        let optimum = control.solve(&start, Target::Conditions, &mut [control.stage(&start); N])?.price();
        Ok(optimum)
    };
    let apart = 1e-4 * best;
    let (less, least, more) = (price(best - apart)?, price(best)?, price(best + apart)?);
    assert!(least < less && least < more && (less - more).abs() < 1e-9 * least, "{less} {least} {more}");
    Ok(())
}

/// A search over the headings of full targets finds nothing cheaper than the best plan by more than its resolution.
#[test]
fn a_unicycle_chooses_its_heading() -> Result<(), Error> {
    let random = &mut Random::new(3307);
    let at = super::place;
    for _ in 0..6 {
        let goal = random.vector::<2>() * 2.0;
        let control = Unicycle { turning: 0.3, fastest: 3.0 }.control(0.05)?.with_end_reference(goal)?;
        let start = Matrix3::identity();
        let mut plan = [control.stage(&start); N];
        let optimum = control.solve(&start, Target::Conditions, &mut plan)?;
        assert!(optimum.is_minimum() && optimum.gap() < 1e-11, "{optimum:?}");
        let (end, found) = (*optimum.end(), optimum.price());
        let heading = end[(1, 0)].atan2(end[(0, 0)]);
        let price = |heading: f64| -> Result<f64, Error> {
            let target = Target::Place(at(heading, goal.x, goal.y));
            let mut plan = plan.map(|stage| control.stage(&start).with_input(*stage.input()));
            Ok(control.solve(&start, target, &mut plan)?.price())
        };
        assert!((price(heading)? - found).abs() < 1e-9 * found);
        assert!(price(heading + 0.01)? > found && price(heading - 0.01)? > found);
    }
    Ok(())
}

#[test]
fn bounded_work_goes_on_from_where_it_stopped() -> Result<(), Error> {
    let control = Cornered { place: 1.0, fastest: 0.1 }.control(H)?;
    let start = Vector2::zeros();
    let mut plan = [control.stage(&start); N];
    let expected = control.solve(&start, Target::Conditions, &mut plan)?.price();
    let mut plan = [control.stage(&start); N];
    let mut reached = Ended::AtLimit;
    let mut calls = 0;
    while reached != Ended::Converged && calls < 40 {
        let optimum = control.solve_within(&start, Target::Conditions, Limits { sweeps: 2 }, &mut plan)?;
        (reached, calls) = (optimum.ended(), calls + 1);
        assert!(reached != Ended::Converged || (optimum.price() - expected).abs() < 1e-9 * expected);
    }
    assert!(reached == Ended::Converged, "{calls}");
    Ok(())
}

#[test]
fn targets_that_cannot_be_are_told() -> Result<(), Error> {
    let start = Vector2::zeros();
    let control = Cornered { place: 1.0, fastest: -40.0 }.control(H)?;
    let mut plan = [control.stage(&start); N];
    control.solve(&start, Target::Conditions, &mut plan)?; // far, and yet possible
    let parallel: Control<_, 2, 1, 0> = Contradicting.control(H)?;
    let mut plan = [parallel.stage(&start); N];
    let error = parallel.solve(&start, Target::Conditions, &mut plan).map(|found| found.price());
    assert!(matches!(error, Err(Error::TargetMissed { .. } | Error::Uncontrollable { .. })), "{error:?}");
    let still = Unmoved.control(H)?;
    let mut plan = [still.stage(&start); N];
    let error = still.solve(&start, Target::Conditions, &mut plan).map(|found| found.price());
    assert!(matches!(error, Err(Error::Uncontrollable { distance: 1.0 })), "{error:?}");
    let without = Vectorless.control(H)?;
    let error = without.solve(&start, Target::Conditions, &mut [without.stage(&start); N]).map(|found| found.price());
    assert_eq!(error, Err(Error::NoTarget));
    Ok(())
}

/// Ends that are in two places.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
    cost     = |h, u| h * u.norm_squared() / 2,
    target   = |x| [1 <= x.x, x.x <= 0.9],
)]
struct Contradicting;

/// An end that no input moves.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |x: Vector2, u: Vector1| vector![x.x, x.y + u.x],
    cost     = |h, u| h * u.norm_squared() / 2,
    target   = |x| [x.x == 1],
)]
struct Unmoved;

/// A system without a declared target.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x],
    cost     = |h, u| h * u.norm_squared() / 2,
)]
struct Vectorless;
