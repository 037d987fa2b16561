//! Tangent maps of steps with a constraint.

use super::constrained_systems as systems;
#[cfg(feature = "heavy")]
use super::of_motions;
use super::{Case, Dual, K, NEAR, check, check_on, constant, numbers};
use clebsch::{Clebsch, Variational};
use clebsch_tests::oracle::random::Random;
use nalgebra::{DMatrix, Matrix2, Matrix3, Matrix4, SMatrix, SVector, Vector1, Vector2};

const H: f64 = super::H;

/// A state on the constraint, next to a configuration and a momentum.
fn on_constraint<S: Clebsch<Scalar = f64>>(
    system: S,
    q: S::Configuration,
    mu: S::Momentum,
) -> (S::Configuration, S::Momentum) {
    let stepper = system.into_stepper(H).expect("a regular system");
    let state = stepper.project(q, mu).expect("a state nearby");
    (*state.configuration(), state.momentum())
}

/// A system from its numbers.
type Made<S> = fn(&[<S as Clebsch>::Scalar]) -> S;
/// The dual numbers of a configuration.
type Lift<S, D> = fn(&<S as Clebsch>::Configuration) -> <D as Clebsch>::Configuration;

/// The case of a system without input, at a state next to some configuration and momentum.
fn case<S, D, const M: usize>(
    plain: Made<S>,
    dual: Made<D>,
    numbers: Vec<f64>,
    lift: Lift<S, D>,
    (q, mu): (S::Configuration, SVector<f64, M>),
) -> Case<S, D, M>
where
    S: Clebsch<Scalar = f64, Momentum = SVector<f64, M>, Input = ()>,
    D: Clebsch<Scalar = Dual<K>, Input = ()>,
{
    let (q, mu) = on_constraint(plain(&numbers), q, mu);
    Case {
        plain,
        dual,
        numbers,
        q,
        lift,
        mu,
        bracket: None,
        input: Vec::new(),
        plain_input: |_| (),
        dual_input: |_| (),
    }
}

/// A placement in the plane.
fn planar(random: &mut Random) -> Matrix3<f64> {
    let mut q = random.rotation::<2>(3.0).to_homogeneous();
    q.fixed_view_mut::<2, 1>(0, 2).copy_from(&random.vector::<2>());
    q
}

/// A placement in space.
fn spatial(random: &mut Random) -> Matrix4<f64> {
    let mut q = random.attitude::<3>().to_homogeneous();
    q.fixed_view_mut::<3, 1>(0, 3).copy_from(&random.vector::<3>());
    q
}

#[test]
fn a_blade_with_forces_and_an_input() {
    let random = &mut Random::new(301);
    for _ in 0..5 {
        let numbers = vec![1.5, 0.4, 0.6, 0.2, 0.7];
        let (q, mu) = on_constraint(systems::sleigh(&numbers), planar(random), random.vector());
        check::<systems::Sleigh<f64>, systems::Sleigh<Dual<K>>, 3, 7>(&Case {
            plain: systems::sleigh,
            dual: systems::sleigh,
            numbers,
            q,
            lift: constant,
            mu,
            bracket: None,
            input: vec![0.8],
            plain_input: |u| Vector1::new(u[0]),
            dual_input: |u| Vector1::new(u[0]),
        });
    }
}

#[test]
fn suslovs_body_by_the_logarithm() {
    let random = &mut Random::new(302);
    for _ in 0..5 {
        let numbers = numbers::<3>(random, &[0.7, 0.3, -0.2, 1.1]);
        let start = (random.attitude(), random.vector());
        check::<_, _, 3, 11>(&case(systems::suslov, systems::suslov, numbers, constant, start));
    }
}

#[test]
fn a_ball_on_a_turning_table() {
    let random = &mut Random::new(303);
    for _ in 0..5 {
        let (numbers, start) = (vec![1.3, 0.5, 0.8, 0.6], (random.vector(), random.vector()));
        check::<_, _, 5, 5>(&case(systems::ball, systems::ball, numbers, constant, start));
    }
}

#[cfg(feature = "heavy")]
type Board<T> = (Matrix3<T>, Vector1<T>, Vector1<T>);

#[cfg(feature = "heavy")]
#[test]
fn rows_that_turn_with_a_wheel() {
    let random = &mut Random::new(304);
    let lift = |(q, rotor, wheel): &Board<f64>| (constant(q), constant(rotor), constant(wheel));
    for _ in 0..5 {
        let place = (planar(random), random.vector(), random.vector());
        let (numbers, start) = (vec![1.2, 0.9, 0.3, 0.4], (place, random.vector()));
        check::<_, _, 5, 5>(&case(systems::snakeboard, systems::snakeboard, numbers, lift, start));
    }
}

#[cfg(feature = "heavy")]
#[test]
fn a_moving_axis_by_steps_of_fourth_order() {
    let random = &mut Random::new(305);
    for _ in 0..5 {
        let (numbers, start) = (vec![1.2, 0.9, 0.6], (random.attitude(), random.vector()));
        check::<_, _, 3, 5>(&case(systems::veselova, systems::veselova, numbers, constant, start));
    }
}

#[test]
fn rows_that_are_no_polynomial() {
    let random = &mut Random::new(306);
    for _ in 0..3 {
        let numbers = numbers::<3>(random, &[1.1, 0.9, 0.6, 0.4, 0.1]);
        let start = (spatial(random), random.vector());
        check::<_, _, 6, 12>(&case(systems::rattleback, systems::rattleback, numbers, constant, start));
    }
}

#[test]
fn wheels_and_a_joint() {
    let random = &mut Random::new(307);
    let lift = |q: &[Matrix3<f64>; 2]| q.map(|q| constant(&q));
    for _ in 0..3 {
        let start = ([planar(random), planar(random)], random.vector());
        let numbers = vec![3.0, 1.0, 0.5, 0.2, -0.4, 0.1, 0.9, -0.1];
        check::<_, _, 6, 9>(&case(systems::rig, systems::rig, numbers, lift, start));
    }
}

#[test]
fn places_with_forces_by_steps_of_sixth_order() {
    let random = &mut Random::new(308);
    let lift = |x: &[Vector2<f64>; 2]| x.map(|x| constant(&x));
    for _ in 0..5 {
        let numbers = numbers::<2>(random, &[0.8, 0.3, 1.0, 0.7]);
        let arm: Vector2<f64> = random.unit();
        let x = [arm, arm + 0.7 * random.unit::<2>()];
        let (q, mu) = on_constraint(systems::double(&numbers), x, random.vector());
        check::<systems::Double<f64>, systems::Double<Dual<K>>, 4, 9>(&Case {
            plain: systems::double,
            dual: systems::double,
            numbers,
            q,
            lift,
            mu,
            bracket: None,
            input: vec![0.4],
            plain_input: |u| Vector1::new(u[0]),
            dual_input: |u| Vector1::new(u[0]),
        });
    }
}

/// φ(t, q) as a function of the numbers of a system.
type Places<D> = fn(&D, <D as Clebsch>::Scalar, &<D as Clebsch>::Configuration) -> Vec<<D as Clebsch>::Scalar>;

/// The projection of motions to those along which φ does not change, by dual numbers.
fn admissible<D, const M: usize>(system: &D, places: Places<D>, t: f64, q: &D::Configuration) -> SMatrix<f64, M, M>
where
    D: Variational<M> + Clebsch<Scalar = Dual<K>, Momentum = SVector<Dual<K>, M>>,
{
    let count = places(system, Dual::constant(t), q).len();
    let mut rows = DMatrix::zeros(count, M);
    for first in (0..M).step_by(K) {
        let eta = SVector::from_fn(|i, _| match i.checked_sub(first) {
            Some(k) if k < K => Dual::<K>::variable(0.0, k),
            _ => Dual::constant(0.0),
        });
        let moved = system.advance(q, &system.retraction(&eta));
        for (i, place) in places(system, Dual::constant(t), &moved).iter().enumerate() {
            (first..M.min(first + K)).for_each(|j| rows[(i, j)] = place.derivatives[j - first]);
        }
    }
    let metric = (&rows * rows.transpose()).try_inverse().expect("independent rows");
    let across = rows.transpose() * metric * rows;
    SMatrix::identity() - SMatrix::from_fn(|i, j| across[(i, j)])
}

/// A step of an unforced system with places: as [`check`], with the form on the motions that obey the constraint. All
/// images obey it.
fn check_places<S, D, const M: usize, const P: usize>(case: &Case<S, D, M>, places: Places<D>)
where
    S: clebsch::Sensitive<M, P> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>, Input = ()> + Clone,
    D: Variational<M> + Clebsch<Scalar = Dual<K>, Momentum = SVector<Dual<K>, M>>,
{
    let numbers: Vec<Dual<K>> = case.numbers.iter().map(|&number| Dual::constant(number)).collect();
    let dual = (case.dual)(&numbers);
    let motions = admissible(&dual, places, 0.0, &(case.lift)(&case.q));
    check_on::<S, D, M, P>(case, &motions);
    let stepper = (case.plain)(&case.numbers).into_stepper(H).expect("a regular system");
    let (next, tangent) = stepper.step_tangent(&stepper.state(case.q, case.mu).expect("a state")).expect("a step");
    let kept = admissible(&dual, places, H, &(case.lift)(next.configuration()));
    for image in [tangent.motion_by_motion, tangent.motion_by_momentum] {
        let across = (image - kept * image).amax();
        assert!(across < NEAR, "{}: motions leave the constraint by {across:.1e}", S::NAME);
    }
}

#[test]
fn a_place_that_moves() {
    let random = &mut Random::new(309);
    for _ in 0..5 {
        let numbers = vec![1.4, 0.6, 1.1, 0.2, -0.1, 0.3, 1.2, 0.25];
        let start = (1.2 * random.unit(), random.vector());
        let case = case(systems::charge, systems::charge, numbers, constant, start);
        let case = Case { bracket: Some(|_| Matrix3::zeros()), ..case };
        check_places::<systems::Charge<f64>, systems::Charge<Dual<K>>, 3, 10>(&case, systems::place_of_charge);
    }
}

/// The bracket of two bodies.
#[cfg(feature = "heavy")]
fn of_two(n: &SVector<f64, 12>) -> SMatrix<f64, 12, 12> {
    let mut form = SMatrix::<f64, 12, 12>::zeros();
    for i in [0, 6] {
        form.fixed_view_mut::<6, 6>(i, i).copy_from(&of_motions(&n.fixed_rows::<6>(i).into_owned()));
    }
    form
}

#[cfg(feature = "heavy")]
#[test]
fn two_bodies_on_joints() {
    let random = &mut Random::new(310);
    let lift = |q: &[Matrix4<f64>; 2]| q.map(|q| constant(&q));
    for _ in 0..2 {
        let mut all = numbers::<3>(random, &[]);
        all.extend(numbers::<3>(random, &[1.3, 0.8, 1.7, 0.1, -0.2, 0.6, -0.1, 0.3, 0.5, 0.2, 0.1, -0.7]));
        let start = ([spatial(random), spatial(random)], random.vector());
        let case = case(systems::bodies, systems::bodies, all, lift, start);
        let case = Case { bracket: Some(of_two), ..case };
        check_places::<systems::Bodies<f64>, systems::Bodies<Dual<K>>, 12, 25>(&case, systems::places_of_bodies);
    }
}

#[test]
fn inertias_that_change() {
    let random = &mut Random::new(311);
    for _ in 0..5 {
        let numbers = vec![1.3, 0.9, 0.8, 0.2];
        let start = (Vector2::new(0.5, 0.4) + random.vector() / 5.0, random.vector());
        let case = case(systems::wire, systems::wire, numbers, constant, start);
        let case = Case { bracket: Some(|_| Matrix2::zeros()), ..case };
        check_places::<systems::Wire<f64>, systems::Wire<Dual<K>>, 2, 6>(&case, systems::place_of_wire);
        let (numbers, start) = (vec![0.3, 0.4, 0.2], (random.vector(), random.vector()));
        check::<_, _, 3, 5>(&self::case(systems::mechanism, systems::mechanism, numbers, constant, start));
    }
}

/// The numbers that a tangent map keeps of its 2M: a step forgets changes of N along the rows, and of q across places.
#[test]
fn steps_forget_what_the_constraint_balances() {
    let random = &mut Random::new(312);
    let stepper = systems::rig(&[3.0, 1.0, 0.5, 0.2, -0.4, 0.1, 0.9, -0.1]).into_stepper(H).expect("a regular rig");
    let start = stepper.project([planar(random), planar(random)], random.vector()).expect("a state nearby");
    let (_, tangent) = stepper.step_tangent(&start).expect("a step");
    let mut map = DMatrix::zeros(12, 12);
    for (i, j, block) in [
        (0, 0, tangent.motion_by_motion),
        (0, 6, tangent.motion_by_momentum),
        (6, 0, tangent.momentum_by_motion),
        (6, 6, tangent.momentum_by_momentum),
    ] {
        map.view_mut((i, j), (6, 6)).copy_from(&block);
    }
    // two equations of places take two each, two of velocities one each
    let mut sizes: Vec<f64> = map.singular_values().iter().copied().collect();
    sizes.sort_by(f64::total_cmp);
    assert!(sizes[5] < NEAR && sizes[6] > 1e-6, "{sizes:?}");
}
