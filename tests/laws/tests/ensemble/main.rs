//! Ensembles: each body is stepped as it would be alone, bit for bit, whatever its place, the others, the lanes and the threads.

use clebsch::{Clebsch, Ensemble, Error, F64x4, F64x8, Failure, Scalar, Stepper};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Vector3};

const H: f64 = 0.1;
const STEPS: u64 = 20;

/// A heavy top over any scalar.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
)]
struct Top<T: Scalar> {
    #[clebsch(symmetric)]
    mass_matrix: Matrix3<T>,
    weight: T,
    center: Vector3<T>,
}

/// A point on a sphere whose gravity swings, so that it has a time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |t, q| self.gravity * (1 + t.sin() / 2) * q.z,
)]
struct Pendulum<T: Scalar> {
    gravity: T,
}

type Start = (Matrix3<f64>, Vector3<f64>);

/// Tops that spin slowly, fast, and too fast for the step.
fn starts(count: usize) -> Vec<Start> {
    let mut random = Random::new(5);
    let spin = |random: &mut Random| if random.number() > 0.6 { 25.0 } else { 5.0 };
    (0..count).map(|_| (random.attitude(), random.unit::<3>() * spin(&mut random))).collect()
}

fn top<T: Scalar>(weight: T) -> Top<T> {
    let mass_matrix = Matrix3::new(1.2, 0.1, -0.2, 0.1, 0.8, 0.05, -0.2, 0.05, 0.5).map(T::from_f64);
    Top { mass_matrix, weight, center: Vector3::new(0.1, -0.2, 0.7).map(T::from_f64) }
}

fn stepper<T: Scalar>() -> Stepper<Top<T>> {
    top(T::from_f64(3.0)).stepper(T::from_f64(H)).expect("parameters")
}

/// Where a body ends that is stepped alone, and its failure.
fn alone(stepper: &Stepper<Top<f64>>, body: usize, (q, mu): Start) -> (Start, Option<Failure>) {
    let mut state = stepper.state(q, mu).expect("a state");
    for step in 0..STEPS {
        match stepper.step(&state) {
            Ok(next) => state = next,
            Err(error) => return (state.into_parts(), Some(Failure { body, step, error })),
        }
    }
    (state.into_parts(), None)
}

/// Bodies and failures of an ensemble are those of bodies alone.
macro_rules! assert_alone {
    ($ensemble:expr, $starts:expr, |$body:ident| $stepper:expr) => {{
        let mut failed = 0;
        assert_eq!($ensemble.len(), $starts.len());
        for ($body, &start) in $starts.iter().enumerate() {
            let stepper = $stepper;
            let (end, failure) = alone(&stepper, $body, start);
            assert_eq!($ensemble.body($body), Some(end), "body {}", $body);
            assert_eq!($ensemble.failure($body), failure);
            let state = stepper.state(end.0, end.1).expect("a state");
            assert_eq!($ensemble.energy($body), Some(stepper.energy(&state)));
            assert_eq!($ensemble.conserved($body).map(|found| found[0]), Some(stepper.conserved(&state)[0]));
            failed += usize::from(failure.is_some());
        }
        assert_eq!($ensemble.failures().count(), failed);
        failed
    }};
}

/// Full chunks and ragged ones, fewer bodies than lanes, one, none.
#[test]
fn bodies_are_stepped_as_if_alone() {
    for count in [0, 1, 3, 8, 9, 16, 37, 200] {
        let starts = starts(count);
        let mut eight = stepper::<F64x8>().ensemble(starts.clone()).expect("bodies");
        let mut four = stepper::<F64x4>().ensemble(starts.clone()).expect("bodies");
        let mut one = stepper::<f64>().ensemble(starts.clone()).expect("bodies");
        eight.advance(STEPS);
        four.advance(STEPS);
        one.advance(STEPS);
        let failed = assert_alone!(eight, starts, |_body| stepper::<f64>());
        assert_alone!(four, starts, |_body| stepper::<f64>());
        assert_alone!(one, starts, |_body| stepper::<f64>());
        assert!(count < 200 || (10..190).contains(&failed), "{failed}");
        assert_eq!((eight.steps(), eight.is_empty()), (STEPS, count == 0));
    }
}

/// In the reverse order, among others, and in other portions of steps.
#[test]
fn place_and_portions_do_not_matter() {
    let starts = starts(53);
    let mut forwards = stepper::<F64x8>().ensemble(starts.clone()).expect("bodies");
    let mut backwards = stepper::<F64x8>().ensemble(starts.iter().rev().copied()).expect("bodies");
    forwards.advance(STEPS);
    for portion in [1, 7, 0, 12] {
        backwards.advance(portion);
    }
    let reversed: Vec<_> = backwards.bodies().collect();
    assert!(forwards.bodies().eq(reversed.into_iter().rev()));
    for failure in forwards.failures() {
        assert_eq!(backwards.failure(52 - failure.body), Some(Failure { body: 52 - failure.body, ..failure }));
    }
}

#[test]
fn threads_do_not_matter() {
    let starts = starts(if cfg!(feature = "heavy") { 1000 } else { 200 });
    let mut one = stepper::<F64x8>().ensemble(starts.clone()).expect("bodies");
    let mut many = stepper::<F64x8>().ensemble(starts).expect("bodies");
    one.advance(STEPS);
    many.par_advance(STEPS / 2);
    many.par_advance(STEPS - STEPS / 2);
    assert!(one.bodies().eq(many.bodies()));
    assert!(one.failures().eq(many.failures()) && one.failures().count() > 0);
    assert_eq!(many.steps(), STEPS);
}

/// Each body has a weight of its own.
#[test]
fn parameters_of_each_body() {
    let starts = starts(45);
    let weight = |body: usize| 0.1 * body as f64;
    let make = |bodies: &[usize]| top(F64x8::from_lanes(|lane| weight(bodies[lane]))).stepper(F64x8::splat(H));
    let mut tops = Ensemble::with_parameters(starts.clone(), make).expect("bodies");
    let mut again = Ensemble::with_parameters(starts.clone(), make).expect("bodies");
    tops.advance(STEPS);
    again.par_advance(STEPS);
    assert_alone!(tops, starts, |body| top(weight(body)).stepper(H).expect("parameters"));
    assert!(tops.bodies().eq(again.bodies()));
}

/// A body is moved, also one that has failed, and goes on from there.
#[test]
fn bodies_can_be_put_elsewhere() {
    let starts = starts(20);
    let mut tops = stepper::<F64x8>().ensemble(starts.clone()).expect("bodies");
    tops.advance(STEPS);
    let failed = tops.failures().next().expect("some spin too fast").body;
    let sound = (0..20).find(|&body| tops.failure(body).is_none()).expect("some do not");
    let others: Vec<_> = tops.bodies().collect();
    let slow = (Matrix3::identity(), Vector3::new(0.1, 0.2, 0.3));
    for body in [failed, sound] {
        assert_eq!(tops.set_body(body, slow), Ok(()));
        assert_eq!((tops.body(body), tops.failure(body)), (Some(slow), None));
    }
    assert!((0..20).all(|body| [failed, sound].contains(&body) || tops.body(body) == Some(others[body])));
    tops.advance(STEPS);
    let (end, _) = alone(&stepper(), failed, slow);
    assert_eq!((tops.body(failed), tops.body(sound)), (Some(end), Some(end)));
    let reflected = (-Matrix3::identity(), slow.1);
    assert!(matches!(tops.set_body(sound, reflected), Err(Error::OffOrbit { .. })));
    assert_eq!(tops.body(sound), Some(end));
    assert_eq!(tops.set_body(20, slow), Err(Error::NoBody { body: 20, bodies: 20 }));
    assert_eq!((tops.body(20), tops.energy(20)), (None, None));
}

#[test]
fn bodies_that_are_refused_are_named() {
    let mut wrong = starts(30);
    wrong[21].0 *= 1.1;
    let refused = stepper::<F64x8>().ensemble(wrong.clone()).expect_err("no rotation");
    assert!(matches!(refused, Failure { body: 21, step: 0, error: Error::OffOrbit { .. } }), "{refused}");
    assert!(refused.to_string().starts_with("body 21 after step 0: the configuration is off its space"), "{refused}");
    wrong[21].0 = Matrix3::identity();
    let heavy = Ensemble::with_parameters(wrong, |bodies| {
        top(F64x8::splat(if bodies[0] == 16 { f64::NAN } else { 1.0 })).stepper(F64x8::splat(H))
    });
    let refused = heavy.expect_err("a weight that is no number");
    assert_eq!(refused, Failure { body: 16, step: 0, error: Error::NotFinite { name: "weight" } });
}

/// The time goes on for all, and stays where a body does.
#[test]
fn bodies_have_their_times() {
    let bob = |speed: f64| (Vector3::y(), Vector3::new(speed, 0.0, 0.5));
    let stepper = Pendulum { gravity: F64x8::splat(9.81) }.stepper(F64x8::splat(H)).expect("parameters");
    let mut bobs = stepper.ensemble([bob(1.0), bob(9.9), bob(0.5)]).expect("bodies");
    bobs.advance(STEPS);
    let failure = bobs.failure(1).expect("too fast");
    assert!(failure.step < STEPS);
    assert_eq!(bobs.time(1), Some(failure.step as f64 * H));
    assert_eq!((bobs.time(0), bobs.time(2), bobs.time(3)), (Some(2.0), Some(2.0), None));
    let single = Pendulum { gravity: 9.81 }.stepper(H).expect("parameters");
    let (q, mu) = bob(0.5);
    let ends =
        single.trajectory(single.state(q, mu).expect("state")).nth(STEPS as usize).expect("states").expect("steps");
    assert_eq!(bobs.body(2), Some(ends.into_parts()));
    assert_eq!(bobs.set_body(1, bob(1.0)), Ok(()));
    assert_eq!(bobs.time(1), Some(2.0));
}

/// An ensemble of none makes its steps at once, and counts as far as it can.
#[test]
fn steps_are_counted_up_to_the_largest_number() {
    let mut none = stepper::<F64x4>().ensemble([]).expect("no bodies");
    none.advance(u64::MAX);
    none.advance(2);
    none.par_advance(3);
    assert_eq!((none.steps(), none.len()), (u64::MAX, 0));
}
