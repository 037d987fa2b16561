//! Motions that read references: phases with different dynamics, against linear algebra, a Kalman filter, and declarations of one phase.

use super::{derivatives, long, place};
use clebsch::{Clebsch, Control, Controlled, Error, Limits, Prior, Referring, Stage, Target};
use clebsch_tests::fixtures::hopper::Hopper;
use clebsch_tests::oracle::random::Random;
use derivatives::Chart;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Matrix3x2, SVector, Vector1, Vector2, Vector3, vector};

/// A linear system with other matrices in each step.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |h, x: Vector3, u: Vector2, (carry, enter): (Matrix3, Matrix3x2)| carry * x + h * enter * u,
    cost     = |h, x, u, carry| h * (u.norm_squared() + self.price * (carry * x).norm_squared()) / 2,
)]
struct Switched {
    price: f64,
}

/// A linear system that noise w moves, with other matrices in each step. One number of it is seen at each step and at the end.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = |x: Vector3, w: Vector2, carry, enter| carry * x + enter * w,
    cost     = |x, w, (carry, enter): (Matrix3, Matrix3x2), seen: Vector1| (w.norm_squared() + (x.x - seen.x).powi(2) / self.error) / 2,
    endpoint = |x, seen| (x.x - seen.x).powi(2) / self.error / 2,
)]
struct Seen {
    error: f64,
}

/// A mass on a spring, in wind.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    dynamics = rk4(|t, x: Vector2, u: Vector1, stiffness: Vector1, wind: Vector1| {
        vector![x.y, u.x - stiffness.x * x.x.sin() + wind.x * (1 + x.y.powi(2)).sqrt() * (2 * t).cos()]
    }),
    cost     = |h, x, u, wind| h * (u.norm_squared() + (wind.x - x.y).powi(2)) / 2,
    bounds   = |x, u, wind| [u.x <= 2 + wind.x.powi(2), -2 <= x.y],
)]
struct Swing {}

/// A car on ice, that drifts. Grip and drift change from step to step.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |F: SE<2>, q: SE<2>| q * F,
    controls = |q, u: Vector2, grip: Vector1, drift: Vector2| {
        let aside = q.rotation().transpose() * drift;
        vector![grip.x * u.x, u.y + aside.x, aside.y]
    },
    cost     = |h, q, u, drift| h * (u.norm_squared() + (q.translation() - drift).norm_squared()) / 2,
    bounds   = |q, u| [u.y <= self.fastest, (q.translation() - self.pole).norm_squared() >= self.clearance],
    endpoint = |q| self.miss_price * q.translation().norm_squared() / 2,
)]
struct Sliding {
    fastest: f64,
    pole: Vector2<f64>,
    clearance: f64,
    miss_price: f64,
}

/// The same with functions of the time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |F: SE<2>, q: SE<2>| q * F,
    controls = |t, q, u: Vector2| {
        let aside = q.rotation().transpose() * vector![t.sin(), t / 3];
        vector![(1 + t.powi(2)) * u.x, u.y + aside.x, aside.y]
    },
    cost     = |t, h, q, u| h * (u.norm_squared() + (q.translation() - vector![t.sin(), t / 3]).norm_squared()) / 2,
    bounds   = |q, u| [u.y <= self.fastest, (q.translation() - self.pole).norm_squared() >= self.clearance],
    endpoint = |q| self.miss_price * q.translation().norm_squared() / 2,
)]
struct SlidingInTime {
    fastest: f64,
    pole: Vector2<f64>,
    clearance: f64,
    miss_price: f64,
}

/// A body that turns in a frame that is given, in single precision.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    controls       = |R, u: Vector3, frame: Matrix3, gains: [Vector1; 2]| gains[0].x * u + gains[1].x * R.transpose() * frame * Vector3::z(),
    cost           = |h, u| h * u.norm_squared() / 2,
    scalar         = f32,
    discretization = exponential,
)]
struct Turning {}

const H: f64 = 0.1;
const N: usize = 20;

fn grip(t: f64) -> Vector1<f64> {
    vector![1.0 + t * t]
}

fn drift(t: f64) -> Vector2<f64> {
    vector![t.sin(), t / 3.0]
}

fn vectors<const D: usize>() -> Chart<SVector<f64, D>, D> {
    Chart { moved: |x, delta| x + delta, coordinates: |x, y| y - x }
}

fn hopper() -> Hopper {
    Hopper { drag: 0.3, calm: 0.5, gravity: 9.81, price: 2.0, leg: 1.0, strongest: 40.0 }
}

#[test]
fn derivatives_of_motions_read_references() {
    let random = &mut Random::new(9101);
    let end_reference = ();
    for _ in 0..4 {
        let reference = (random.matrix::<3, 3>(), random.matrix::<3, 2>());
        let constants = |constants| Referring { constants, reference, end_reference };
        derivatives::check_with(&Switched { price: 0.7 }, &constants, &vectors(), &random.vector(), random);

        let reference = (random.vector::<1>(), random.vector::<1>());
        let constants = |constants| Referring { constants, reference, end_reference };
        derivatives::check_with(&Swing {}, &constants, &vectors(), &random.vector(), random);

        let reference = (random.vector::<1>(), random.vector::<1>(), random.vector::<1>());
        let constants = |constants| Referring { constants, reference, end_reference };
        derivatives::check_with(&hopper(), &constants, &vectors(), &random.vector(), random);

        let car = Sliding { fastest: 1.0, pole: random.vector(), clearance: 0.1, miss_price: 0.5 };
        let reference = (random.vector::<1>(), random.vector::<2>());
        let constants = |constants| Referring { constants, reference, end_reference };
        let x = place(random.number(), random.number(), random.number());
        derivatives::check_with(&car, &constants, &derivatives::chart_of_plane(), &x, random);
    }
}

type Matrices = (Matrix3<f64>, Matrix3x2<f64>);

/// Matrices of a first phase and of a second one, and others by the way.
fn phases(random: &mut Random) -> [Matrices; N] {
    let mut drawn = || (Matrix3::identity() + 0.2 * random.matrix::<3, 3>(), random.matrix::<3, 2>());
    let (first, second) = (drawn(), drawn());
    std::array::from_fn(|k| match k {
        3 | 11 => drawn(),
        0..8 => first,
        _ => second,
    })
}

/// The inputs of least price, from the linear system of all steps at once: inputs, places, and the multipliers of steps and of the target.
fn by_linear_algebra(price: f64, start: &Vector3<f64>, phases: &[Matrices], goal: &Vector3<f64>) -> Vec<Vector2<f64>> {
    let steps = phases.len();
    let (inputs, unknowns) = (2 * steps, 5 * steps);
    let equations = 3 * steps + 3;
    let mut matrix = DMatrix::<f64>::zeros(unknowns + equations, unknowns + equations);
    let mut right = DVector::<f64>::zeros(unknowns + equations);
    let place_of = |k: usize| inputs + 3 * (k - 1); // of x_k, for k from 1 to N
    matrix.view_mut((0, 0), (inputs, inputs)).fill_diagonal(H);
    for (k, (carry, enter)) in phases.iter().enumerate() {
        let row = unknowns + 3 * k;
        // x_{k+1} − A x_k − h B u_k = 0
        matrix.view_mut((row, place_of(k + 1)), (3, 3)).fill_diagonal(1.0);
        matrix.view_mut((row, 2 * k), (3, 2)).copy_from(&(-H * enter));
        if k == 0 {
            right.rows_mut(row, 3).copy_from(&(carry * start));
        } else {
            matrix.view_mut((row, place_of(k)), (3, 3)).copy_from(&-carry);
            matrix.view_mut((place_of(k), place_of(k)), (3, 3)).copy_from(&(H * price * carry.transpose() * carry));
        }
    }
    let row = unknowns + 3 * steps;
    matrix.view_mut((row, place_of(steps)), (3, 3)).fill_diagonal(1.0);
    right.rows_mut(row, 3).copy_from(goal);
    let below = matrix.view((unknowns, 0), (equations, unknowns)).into_owned();
    matrix.view_mut((0, unknowns), (unknowns, equations)).copy_from(&below.transpose());
    let solved = matrix.full_piv_lu().solve(&right).expect("regular");
    (0..steps).map(|k| vector![solved[2 * k], solved[2 * k + 1]]).collect()
}

#[test]
fn phases_of_linear_dynamics_are_those_of_linear_algebra() -> Result<(), Error> {
    let random = &mut Random::new(9102);
    for case in 0..8 {
        let price = if case < 4 { 0.0 } else { random.between(0.1, 1.0) };
        let (start, goal, phases) = (random.vector(), random.vector(), phases(random));
        let control = Switched { price }.control(H)?;
        let mut plan = [control.stage(&start); N];
        control.refer(&mut plan, |k, _| phases[k]);
        let optimum = control.solve(&start, Target::Place(goal), &mut plan)?;
        assert!(optimum.is_minimum() && optimum.iterations() <= 3, "{optimum:?}");
        assert!((optimum.end() - goal).amax() < 1e-9);
        for (stage, u) in plan.iter().zip(by_linear_algebra(price, &start, &phases, &goal)) {
            assert!((stage.input() - u).amax() < 1e-8 * (1.0 + u.amax()), "{} {u}", stage.input());
        }
        // each step follows its own matrices
        let mut x = start;
        for (stage, (carry, enter)) in plan.iter().zip(&phases) {
            assert!((stage.place() - x).amax() < 1e-12);
            let next = control.follow_with(&x, stage.input(), stage.reference())?;
            x = carry * x + H * enter * stage.input();
            assert!((next - x).amax() < 1e-14 * (1.0 + x.amax()));
        }
    }
    Ok(())
}

#[test]
fn estimates_are_those_of_a_kalman_filter_with_the_matrices_of_each_step() -> Result<(), Error> {
    let random = &mut Random::new(9103);
    for steps in [1, 2, 3] {
        let error = random.between(0.01, 0.1);
        let matrices: Vec<Matrices> = (0..31).map(|_| phases(random)[0]).collect();
        let seen: Vec<f64> = (0..31).map(|_| 2.0 * random.number()).collect();
        let look = |(mean, covariance): (Vector3<f64>, Matrix3<f64>), seen: f64| {
            let along = covariance * Vector3::x();
            let gain = along / (along.x + error);
            (mean + gain * (seen - mean.x), covariance - gain * along.transpose())
        };
        let carried = |(mean, covariance): (Vector3<f64>, Matrix3<f64>), (carry, enter): Matrices| {
            (carry * mean, carry * covariance * carry.transpose() + enter * enter.transpose())
        };
        let mut filter = (random.vector(), Matrix3::identity() * 0.5);
        let prior = Prior::new(filter.0, Matrix3::identity() * 2.0);
        let mut control = Seen { error }.control(H)?.with_prior(prior)?;
        let mut plan = [control.stage(&filter.0); 4];
        (0..4).for_each(|k| filter = carried(look(filter, seen[k]), matrices[k]));
        let mut first = 0;
        while first + 4 + steps <= 30 {
            control.refer(&mut plan, |k, _| (matrices[first + k], Vector1::new(seen[first + k])));
            let at_end = control.clone().with_end_reference(Vector1::new(seen[first + 4]))?;
            let guess = *control.prior().place();
            let end = *at_end.solve(&guess, Target::Free, &mut plan)?.end();
            let known = at_end.end_information(&plan)?.try_inverse().expect("regular");
            let expected = look(filter, seen[first + 4]);
            assert!((end - expected.0).norm() < 1e-8 * (1.0 + end.norm()), "{first}: {end} {}", expected.0);
            assert!((known - expected.1).norm() < 1e-8 * expected.1.norm(), "{first}: {known} {}", expected.1);
            (first + 4..first + 4 + steps).for_each(|k| filter = carried(look(filter, seen[k]), matrices[k]));
            control.slide(&mut plan, steps)?;
            first += steps;
        }
        assert!(first > 20, "{first}");
    }
    Ok(())
}

fn sliding(random: &mut Random) -> (Sliding, SlidingInTime) {
    let (fastest, pole) = (random.between(0.5, 1.5), random.vector::<2>());
    let (clearance, miss_price) = (random.between(0.0, 0.05), random.between(0.0, 2.0));
    (Sliding { fastest, pole, clearance, miss_price }, SlidingInTime { fastest, pole, clearance, miss_price })
}

/// The plans of the references, and those of the functions of the time.
type Plans = ([Stage<Sliding, 3, 2, 2>; N], [Stage<SlidingInTime, 3, 2, 2>; N]);

fn same(found: &Plans, prices: (f64, f64)) {
    let (referred, timed) = found;
    assert!((prices.0 - prices.1).abs() < 1e-9 * (1.0 + prices.1.abs()), "{prices:?}");
    for (a, b) in referred.iter().zip(timed) {
        assert!((a.input() - b.input()).amax() < 1e-6 && (a.place() - b.place()).amax() < 1e-6);
    }
}

#[test]
fn motions_that_are_functions_of_the_time_give_the_plans_of_these_functions() -> Result<(), Error> {
    let random = &mut Random::new(9104);
    let mut solved = 0;
    for case in 0..long(24) {
        let (referring, timed) = sliding(random);
        let begin = random.between(0.0, 1.0);
        let referring = referring.control(H)?.starting_at(begin)?;
        let timed = timed.control(H)?.starting_at(begin)?;
        let start = place(random.number(), 2.0 + random.number(), random.number());
        // far goals take multiple shooting and several attempts
        let target = match case % 3 {
            0 => Target::Free,
            1 => Target::Place(place(3.0 * random.number(), 2.0 + random.number(), random.number())),
            _ => Target::Place(place(random.number(), random.number(), 2.0 + random.number())),
        };
        let guess = random.vector::<2>();
        let mut plans = ([referring.stage(&start).with_input(guess); N], [timed.stage(&start).with_input(guess); N]);
        referring.refer(&mut plans.0, |_, t| (grip(t), drift(t)));
        let found = referring.solve(&start, target, &mut plans.0).map(|optimum| optimum.price());
        let expected = timed.solve(&start, target, &mut plans.1).map(|optimum| optimum.price());
        match (found, expected) {
            (Ok(found), Ok(expected)) => {
                solved += 1;
                same(&plans, (found, expected));
            }
            (found, expected) => assert_eq!(found.is_err(), expected.is_err(), "{found:?} {expected:?}"),
        }
    }
    assert!(solved * 3 >= 2 * long(24), "{solved}");
    Ok(())
}

#[test]
fn paths_of_places_read_the_references_of_motions() -> Result<(), Error> {
    let random = &mut Random::new(9106);
    for _ in 0..long(12) {
        let (referring, timed) = sliding(random);
        let (referring, timed) = (referring.control(H)?, timed.control(H)?);
        let (turn, ahead) = (random.number(), random.between(1.0, 2.0));
        let start = place(0.0, 2.5, 0.2);
        let target = Target::Place(start * place(turn, ahead, 0.3));
        let path = |k: usize, _| {
            let part = k as f64 / N as f64;
            start * place(turn * part, ahead * part, 0.3 * part)
        };
        let mut plans = ([referring.stage(&start); N], [timed.stage(&start); N]);
        referring.refer(&mut plans.0, |_, t| (grip(t), drift(t)));
        let found = referring.solve_along(&start, target, path, &mut plans.0)?.price();
        let expected = timed.solve_along(&start, target, path, &mut plans.1)?.price();
        same(&plans, (found, expected));
    }
    Ok(())
}

#[test]
fn a_receding_horizon_follows_the_reference_of_each_tick() -> Result<(), Error> {
    let random = &mut Random::new(9105);
    let (referring, timed) = sliding(random);
    let (mut referring, mut timed) = (referring.control(H)?, timed.control(H)?);
    let start = place(0.3, 2.5, 0.2);
    let mut places = (start, start);
    let mut plans = ([referring.stage(&start); N], [timed.stage(&start); N]);
    for tick in 0..12 {
        let now = H * f64::from(tick);
        (referring, timed) = (referring.starting_at(now)?, timed.starting_at(now)?);
        referring.refer(&mut plans.0, |_, t| (grip(t), drift(t)));
        let limits = Limits { sweeps: 2 };
        let price = referring.solve_within(&places.0, Target::Free, limits, &mut plans.0)?.price();
        let expected = timed.solve_within(&places.1, Target::Free, limits, &mut plans.1)?.price();
        assert!((price - expected).abs() < 1e-9 * (1.0 + expected), "{tick}: {price} {expected}");
        let input = *plans.0[0].input();
        let next = referring.follow_with(&places.0, &input, plans.0[0].reference())?;
        places = (next, timed.follow(&places.1, plans.1[0].input())?);
        assert!((places.0 - places.1).amax() < 1e-8, "{tick}");
        // the next stage of the plan starts where this step leads
        assert!((plans.0[1].place() - next).amax() < 1e-12);
        let feedback = referring.feedback(&plans.0[1], &next);
        assert!((feedback - plans.0[1].input()).amax() < 1e-10);
        referring.shift(&mut plans.0, 1);
        timed.shift(&mut plans.1, 1);
    }
    Ok(())
}

#[test]
fn free_times_read_the_references_of_motions() -> Result<(), Error> {
    // a cart whose engine is twice as strong in the second half, to a place at a price of time
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        dynamics = midpoint(|x: Vector2, u: Vector1, gain: Vector1| vector![x.y, gain.x * u.x]),
        cost     = |h, u| h * (1 + u.norm_squared()) / 2,
    )]
    struct Cart {}
    let control = Cart {}.control(0.1)?;
    let mut plan = [control.stage(&Vector2::zeros()); 10];
    let gain = |k: usize| if k < 5 { 1.0 } else { 2.0 };
    control.refer(&mut plan, |k, _| vector![gain(k)]);
    let optimum = control.solve_free_time(&Vector2::zeros(), Target::Place(Vector2::x()), 0.02..=2.0, &mut plan)?;
    let (h, price) = (optimum.step_size(), optimum.price());
    // x = h² Σ g_k (N − k − ½) u_k and v = h Σ g_k u_k: the least Σ u² is bᵀ(C Cᵀ)⁻¹b, with rows C
    let least = |h: f64| {
        let mut gramian = Matrix2::zeros();
        for k in 0..10 {
            let column = vector![h * h * gain(k) * (9.5 - k as f64), h * gain(k)];
            gramian += column * column.transpose();
        }
        let goal = Vector2::x();
        h * (10.0 + goal.dot(&(gramian.try_inverse().expect("regular") * goal))) / 2.0
    };
    assert!((price - least(h)).abs() < 1e-10 * price, "{price} {}", least(h));
    let slope = (least(h * 1.0001) - least(h * 0.9999)) / (0.0002 * h);
    assert!(slope.abs() < 1e-5 * price / h, "{slope}");
    Ok(())
}

#[test]
fn a_hopper_stands_and_flies_as_two_declarations_say() -> Result<(), Error> {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        dynamics = midpoint(|x: Vector2, push: Vector1| vector![x.y, push.x - self.gravity - self.drag * (x.y.powi(2) + self.calm.powi(2)).sqrt() * x.y]),
        cost     = |h, push| h * push.norm_squared() / 2,
    )]
    struct Standing {
        drag: f64,
        calm: f64,
        gravity: f64,
    }
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        dynamics = midpoint(|x: Vector2, push: Vector1| vector![x.y, -self.gravity - self.drag * (x.y.powi(2) + self.calm.powi(2)).sqrt() * x.y]),
        cost     = |h, push| h * push.norm_squared() / 2,
    )]
    struct Flying {
        drag: f64,
        calm: f64,
        gravity: f64,
    }
    let Hopper { drag, calm, gravity, .. } = hopper();
    let (standing, flying) =
        (Standing { drag, calm, gravity }.control(0.02)?, Flying { drag, calm, gravity }.control(0.02)?);
    let control = hopper().control(0.02)?;
    // it stands for 15 steps, pushes off, and is to be 1.2 m high after 30 steps
    let stands = |k: usize| k < 15;
    let start = vector![0.7, 0.0];
    let mut plan = [control.stage(&start); 30];
    control.refer(&mut plan, |k, _| (vector![f64::from(u8::from(stands(k)))], vector![0.0], vector![1.2]));
    let optimum = control.solve(&start, Target::Place(vector![1.2, -0.5]), &mut plan)?;
    assert!(optimum.is_minimum() && (optimum.end() - vector![1.2, -0.5]).amax() < 1e-11);
    let mut x = start;
    for (k, stage) in plan.iter().enumerate() {
        assert!((stage.place() - x).amax() < 1e-11);
        assert!(!stands(k) || x.x <= 1.0 + 1e-9, "the leg is longer than it is at {k}");
        assert!(stands(k) || stage.input().x.abs() < 1e-9, "nothing is paid for in flight");
        x = if stands(k) { standing.follow(&x, stage.input())? } else { flying.follow(&x, stage.input())? };
    }
    Ok(())
}

#[test]
fn matrices_and_arrays_turn_a_body_in_single_precision() -> Result<(), Error> {
    let control = Turning {}.control(0.1)?;
    let (start, frame) = (Matrix3::<f32>::identity(), Matrix3::<f32>::identity());
    // a turn about the vertical is given, and inputs are twice as strong
    let turned = control.follow_with(&start, &vector![0.0, 0.0, 0.5], &(frame, [vector![2.0], vector![3.0]]))?;
    let expected = Matrix3::new(0.4_f32.cos(), -0.4_f32.sin(), 0.0, 0.4_f32.sin(), 0.4_f32.cos(), 0.0, 0.0, 0.0, 1.0);
    assert!((turned - expected).amax() < 1e-6, "{turned}");
    let mut plan = [control.stage(&start); 10];
    control.refer(&mut plan, |_, _| (frame, [vector![2.0], vector![3.0]]));
    let optimum = control.solve(&start, Target::Place(start), &mut plan)?;
    assert!(optimum.is_minimum());
    assert!(plan.iter().all(|stage| (stage.input() - vector![0.0, 0.0, -1.5]).amax() < 1e-5));
    Ok(())
}

#[test]
fn motions_without_their_references_are_told() -> Result<(), Error> {
    let control = Swing {}.control(H)?;
    let (start, input) = (Vector2::x(), vector![0.3]);
    let given = (vector![1.0], vector![0.2]);
    let mut plan = [control.stage(&start); 4];
    let solved = |plan: &mut _, control: &Control<_, 2, 1, 2>| {
        let within = control.solve_within(&start, Target::Free, Limits { sweeps: 1 }, plan).map(|_| ());
        let solved = control.solve(&start, Target::Free, plan).map(|_| ());
        let along = control.solve_along(&start, Target::Free, |_, _| start, plan).map(|_| ());
        let in_time = control.solve_free_time(&start, Target::Free, 0.05..=0.2, plan).map(|_| ());
        assert!(within == solved && along == solved && in_time == solved);
        solved
    };
    assert_eq!(solved(&mut plan, &control), Err(Error::NoReference { step: 0, steps: 4 }));
    control.refer(&mut plan, |k, _| if k == 2 { (vector![1.0], vector![f64::NAN]) } else { given });
    assert_eq!(solved(&mut plan, &control), Err(Error::NoReference { step: 2, steps: 4 }));
    plan[2] = plan[2].with_reference(given);
    control.solve(&start, Target::Free, &mut plan)?;
    // single steps
    let one = Error::NoReference { step: 0, steps: 1 };
    assert_eq!(control.follow(&start, &input), Err(one));
    assert_eq!(control.follow_with(&start, &input, &(vector![f64::INFINITY], vector![0.0])), Err(one));
    assert!(control.follow_with(&start, &input, &given)?.x.is_finite());
    let (system, constants) = (Swing {}, Swing {}.prepare(H)?);
    assert_eq!(system.follow(&constants, 0.0, &start, &input), Err(one));
    assert_eq!(system.expand(&constants, 0.0, &start, &input, &Vector2::zeros()).map(|_| ()), Err(one));
    assert_eq!(system.price_of_time(&constants, 0.0, 1.0, &start, &input, &Vector2::zeros()), Err(one));
    Ok(())
}
