//! Plans near places that are given: the side of an obstacle, and the way around.

use super::targets::Unicycle;
use super::{long, place};
use clebsch::{Clebsch, Control, Controlled, Error, Target};
use clebsch_tests::fixtures::unicycle::Unicycle as Forward;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Rotation3, Vector2, Vector3, vector};

const N: usize = 40;

/// A boat that keeps away from an island.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector2, u: Vector2| x + h * u,
    cost     = |h, u| h * u.norm_squared() / 2,
    bounds   = |x| [x.norm_squared() >= self.radius.powi(2)],
)]
struct Boat {
    radius: f64,
}

/// A body that is turned by torques.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    force      = |torque: Vector3| torque,
    effort     = |h, torque| h * torque.norm_squared() / 2,
)]
struct Body {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
}

/// Two tangents and an arc between them are the shortest way, and an even speed the cheapest.
#[test]
fn boats_pass_on_the_side_of_their_guess() -> Result<(), Error> {
    let random = &mut Random::new(3501);
    for _ in 0..long(20) {
        let radius = 0.8 + 0.3 * random.number();
        let control = Boat { radius }.control(0.05)?;
        let (start, goal) = (vector![-2.0, 0.2 * random.number()], vector![2.0, 0.2 * random.number()]);
        for side in [1.0, -1.0] {
            let mut plan = [control.stage(&start); N];
            let path = |_, t: f64| start + (goal - start) * (t / 2.0) + vector![0.0, 1.3 * side];
            let found = control.solve_along(&start, Target::Place(goal), path, &mut plan)?;
            assert!(found.is_minimum() && found.gap() < 1e-12 && found.violation() == 0.0, "{found:?}");
            let tangent = |x: &Vector2<f64>| (x.norm_squared() - radius * radius).sqrt();
            let bearing = |x: &Vector2<f64>| side * x.y.atan2(x.x.abs());
            let touched = |x: &Vector2<f64>| (radius / x.norm()).acos();
            let arc = std::f64::consts::PI - bearing(&start) - bearing(&goal) - touched(&start) - touched(&goal);
            let length = tangent(&start) + tangent(&goal) + arc * radius;
            // steps cut the arc, by a part h² of it
            let price = length * length / 4.0;
            assert!((found.price() - price).abs() < 1e-2 * price, "{} after {price}", found.price());
            let middle = plan.iter().filter(|stage| stage.place().x.abs() < 0.5 * radius);
            assert!(middle.clone().count() > 2 && middle.into_iter().all(|stage| stage.place().y * side > 0.0));
        }
    }
    Ok(())
}

/// A turn about a principal axis by the longer way costs 6 I²α²/T³ in continuous time, as that of a mass on a line.
#[test]
fn bodies_turn_the_way_of_their_guess() -> Result<(), Error> {
    let random = &mut Random::new(3502);
    for _ in 0..long(8) {
        let moments = random.vector::<3>().map(|part| 2.0 + part);
        let angle = 3.6 + random.number().abs();
        let turned = |part: f64| (Rotation3::new(Vector3::z() * (angle * part)).into_inner(), Vector3::zeros());
        let price = 6.0 * (moments.z * angle).powi(2) / 4.0_f64.powi(3);
        let errors = [20, 40].map(|steps| {
            let control = Body { inertia: Matrix3::from_diagonal(&moments) }.control(4.0 / f64::from(steps))?;
            let start = (Matrix3::identity(), Vector3::zeros());
            let mut plan = vec![control.stage(&start); steps as usize];
            let path = |k, _| turned(k as f64 / f64::from(steps));
            let found = control.solve_along(&start, Target::Place(turned(1.0)), path, &mut plan)?;
            assert!(found.is_minimum(), "{found:?}");
            let error = (found.price() / price - 1.0).abs();
            assert!((plan[steps as usize / 2].place().0 - turned(0.5).0).norm() < 1e-3);
            Ok::<_, Error>(error)
        });
        let [coarse, fine] = errors;
        let (coarse, fine) = (coarse?, fine?);
        assert!(fine < 0.02 && fine < 0.35 * coarse, "{coarse} {fine}");
    }
    Ok(())
}

/// Places that are none are errors, and those that lead nowhere leave the plan of the inputs.
#[test]
fn places_are_checked_and_may_be_far() -> Result<(), Error> {
    let control = Unicycle { turning: 0.5, fastest: 9.0 }.control(0.05)?.with_end_reference(Vector2::zeros())?;
    let (start, goal) = (Matrix3::identity(), super::place(0.3, 1.0, 0.2));
    let solve = |place: Matrix3<f64>| {
        let mut plan = [control.stage(&start); N];
        control.solve_along(&start, Target::Place(goal), |_, _| place, &mut plan).map(|found| found.price())
    };
    assert!(matches!(solve(Matrix3::repeat(f64::NAN)), Err(Error::NotFinite { .. })));
    assert!(matches!(solve(2.0 * Matrix3::identity()), Err(Error::OffOrbit { .. })));
    let mut plan = [control.stage(&start); N];
    let price = control.solve(&start, Target::Place(goal), &mut plan)?.price();
    for place in [start, goal, super::place(-3.0, 20.0, -30.0)] {
        assert!(solve(place)? < 1.5 * price, "{} after {price}", solve(place)?);
    }
    let wide: Control<_, 2, 2, 1> = Boat { radius: 1.0 }.control(0.05)?;
    let mut plan = [wide.stage(&vector![-2.0, 0.0]); N];
    let inside =
        wide.solve_along(&vector![-2.0, 0.0], Target::Place(vector![2.0, 0.1]), |_, _| Vector2::zeros(), &mut plan)?;
    assert!(inside.violation() == 0.0 && inside.gap() < 1e-12, "{inside:?}");
    Ok(())
}

/// A car without reverse gear is planned along interpolated places, which it could not follow. Slacks that are narrow at first leave next to
/// nothing of each correction, and one plan in ten then takes more than 60 linearisations.
#[test]
fn interpolated_places_lead_to_plans_soon() -> Result<(), Error> {
    const STEPS: usize = 50;
    let random = &mut Random::new(3505);
    let system = Forward { turn_price: 1.0, top_turn: 7.0, time_price: 0.0, miss_price: 0.0, goal: Vector2::zeros() };
    let control = system.control(0.02)?;
    let start = Matrix3::identity();
    let mut work = Vec::new();
    for _ in 0..if cfg!(feature = "heavy") { 40 } else { 10 } {
        let (angle, x, y) = (3.0 * random.number(), 1.5 * random.number(), 1.5 * random.number());
        let mut plan = [control.stage(&start).with_input(vector![angle, x.hypot(y)]); STEPS];
        let path = |k: usize, _| {
            let part = k as f64 / STEPS as f64;
            place(part * angle, part * x, part * y)
        };
        let found = control.solve_along(&start, Target::Place(place(angle, x, y)), path, &mut plan)?;
        assert!(found.is_minimum() && found.gap() < 1e-12 && found.violation() == 0.0, "{found:?}");
        work.push(found.iterations());
    }
    work.sort_unstable();
    assert!(work[work.len() * 9 / 10] <= 60, "{work:?}");
    Ok(())
}
