//! Inputs of systems with a constraint: derivatives of their steps against differences, and plans against closed forms and other descriptions.

use super::derivatives::{Chart, H, check, check_with, exponential, logarithm};
use super::long;
use clebsch::{Clebsch, Controlled, Error, Referring, Target};
use clebsch_tests::fixtures::driven_sleigh::DrivenSleigh;
use clebsch_tests::oracle::random::Random;
use nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector1, Vector2, Vector3};

/// A ball that rolls on a turning table, and is turned by torques.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |(a, W): (Translation<2>, SO<3>), (x, R): (Vector2, SO<3>)| (x + a, R * W),
    cost           = |h, (a, W)| self.mass * a.norm_squared() / (2 * h) + self.inertia * (W - I).norm_squared() / (4 * h),
    constraint     = |t, x, (v, w)| [
        v.x - self.radius * w.y == -self.table_rate * (1 + t) * x.y,
        v.y + self.radius * w.x == self.table_rate * x.x,
    ],
    discretization = projection,
    force          = |t, x, (v, w), u: Vector2| (-self.drag * t * v, vector![u.x, u.y, x.x * w.x * w.y]),
    effort         = |h, x, (v, w), u| h * (u.norm_squared() + x.norm_squared() * w.z.powi(2) + v.x.powi(3)) / 2,
)]
struct Ball {
    mass: f64,
    inertia: f64,
    radius: f64,
    table_rate: f64,
    drag: f64,
}

/// A board whose rows depend on the angle of its wheels; rotor and wheels are driven.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |(F, a): (SE<2>, Translation<2>), (q, r): (SE<2>, Vector2)| (q * F, r + a),
    lagrangian = |(xi, w)| (self.mass * (xi.x.powi(2) + xi.y.powi(2) + xi.z.powi(2)) + self.rotor * (w.x.powi(2) + 2 * w.x * xi.x)) / 2 + self.wheel * w.y.powi(2),
    constraint = |r, (xi, w)| [xi.z == 0, r.y.cos() * xi.x + r.y.sin() * xi.y == 0],
    force      = |u: Vector2| (Vector3::zeros(), u),
    effort     = |h, u| h * u.norm_squared() / 2,
    endpoint   = |(q, r), (xi, w)| q[(0, 2)] * xi.y.powi(2) + w.x * r.x,
)]
struct Board {
    mass: f64,
    rotor: f64,
    wheel: f64,
}

/// A mass on a sphere that grows and moves, in a magnetic field.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |x, v| self.mass * v.norm_squared() / 2 + self.charge * (x.x * (1 + x.z) * v.y - x.z * v.x),
    constraint = |t, x| [(x - self.pivot * t).norm_squared() == (self.length + self.growth * t).powi(2)],
    force      = |x, v, u: Vector2| vector![u.x, u.y, x.x * u.x] - self.drag * v.norm_squared() * v,
    effort     = |h, v, u| h * (u.norm_squared() + v.z.powi(2)) / 2,
    bounds     = |x, v, u| [u.x * v.y <= 1, x.z <= 9],
)]
struct Charge {
    mass: f64,
    charge: f64,
    pivot: Vector3<f64>,
    length: f64,
    growth: f64,
    drag: f64,
}

/// A mechanism with a wheel, and an inertia that changes with place and time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |t, x, v| (1 + x.x.powi(2) + self.growth * t) * v.x.powi(2) / 2 + (2 + x.y.sin()) * v.y.powi(2) / 2 + self.coupling * v.x * v.y + v.z.powi(2) / 2,
    potential  = |x| x.x.sin() + x.z * x.y,
    force      = |v, u: Vector1| vector![0, u.x, 0] - self.drag * v,
    constraint = |t, x, v| [v.x == x.y * v.y + self.growth * t * x.z],
    effort     = |h, x, u| h * (u.x.powi(2) + x.x.powi(2)) / 2,
    endpoint   = |x, v| v.norm_squared() / 2,
)]
struct Mechanism {
    growth: f64,
    coupling: f64,
    drag: f64,
}

/// A double pendulum of two bodies in a plane with a motor between them: the hinges are constraints.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SE<2>; 2], q: [SE<2>; 2]| [q[0] * F[0], q[1] * F[1]],
    lagrangian = |xi| (0..2).map(|i| self.inertia[i] * xi[i].x.powi(2) + self.mass[i] * (xi[i].y.powi(2) + xi[i].z.powi(2))).sum() / 2,
    potential  = |q| (0..2).map(|i| self.mass[i] * q[i].translation().y).sum(),
    constraint = |q| [
        q[0].rotation() * self.near[0] + q[0].translation() == Vector2::zeros(),
        q[0].rotation() * self.far + q[0].translation() == q[1].rotation() * self.near[1] + q[1].translation(),
    ],
    force      = |motor: Vector1| [vector![-motor.x, 0, 0], vector![motor.x, 0, 0]],
    effort     = |h, motor| h * motor.norm_squared() / 2,
)]
struct Acrobot {
    mass: [f64; 2],
    inertia: [f64; 2],
    near: [Vector2<f64>; 2],
    far: Vector2<f64>,
}

/// The same with two motors, to a target that says more than enough.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SE<2>; 2], q: [SE<2>; 2]| [q[0] * F[0], q[1] * F[1]],
    lagrangian = |xi| (0..2).map(|i| self.inertia[i] * xi[i].x.powi(2) + self.mass[i] * (xi[i].y.powi(2) + xi[i].z.powi(2))).sum() / 2,
    constraint = |q| [
        q[0].rotation() * self.near[0] + q[0].translation() == Vector2::zeros(),
        q[0].rotation() * self.far + q[0].translation() == q[1].rotation() * self.near[1] + q[1].translation(),
    ],
    force      = |motors: Vector2| [vector![motors.x - motors.y, 0, 0], vector![motors.y, 0, 0]],
    effort     = |h, motors| h * motors.norm_squared() / 2,
    target     = |q, xi, goal: [Vector2; 2]| [q[0].translation() == goal[0], q[1].translation() == goal[1], xi[0].x == 0, xi[1] == Vector3::zeros()],
)]
struct Arm {
    mass: [f64; 2],
    inertia: [f64; 2],
    near: [Vector2<f64>; 2],
    far: Vector2<f64>,
}

/// A mass on a sphere, pushed by any force.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |v| self.mass * v.norm_squared() / 2,
    constraint = |x| [x.norm_squared() == self.radius.powi(2)],
    force      = |u: Vector3| u,
    effort     = |h, u| h * u.norm_squared() / 2,
)]
struct OnSphere {
    radius: f64,
    mass: f64,
}

/// The same to a height, at a price of the distance to some place.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |v| v.norm_squared() / 2,
    constraint = |x| [x.norm_squared() == 1],
    force      = |u: Vector3| u,
    effort     = |h, u| h * self.price * u.norm_squared() / 2,
    endpoint   = |x| (x - self.wanted).norm_squared() / 2,
    target     = |x| [x.z == self.height],
)]
struct ToHeight {
    price: f64,
    height: f64,
    wanted: Vector3<f64>,
}

/// A sledge on ground whose friction is known step by step.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<2>, q: SE<2>| q * F,
    lagrangian = |xi| (self.inertia * xi.x.powi(2) + self.mass * (xi.y.powi(2) + xi.z.powi(2))) / 2,
    constraint = |xi| [xi.z == self.slip * xi.x],
    force      = |q, xi, u: Vector2, ground: Vector1| vector![u.x, u.y - ground.x * (1 + q[(0, 2)].powi(2)) * xi.y, 0],
    effort     = |h, xi, u| h * (u.norm_squared() + xi.x.powi(2)) / 2,
)]
struct OnGround {
    mass: f64,
    inertia: f64,
    slip: f64,
}

/// A place of a [`Board`], with its momentum.
type OfBoard = ((Matrix3<f64>, Vector2<f64>), SVector<f64, 5>);

/// An element of the Lie algebra of SE(2).
fn algebra(v: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -v.x, v.y, v.x, 0.0, v.z, 0.0, 0.0, 0.0)
}

fn moved(q: &Matrix3<f64>, eta: &Vector3<f64>) -> Matrix3<f64> {
    q * exponential(&algebra(eta))
}

fn apart(q: &Matrix3<f64>, p: &Matrix3<f64>) -> Vector3<f64> {
    let log = logarithm(&(q.try_inverse().expect("a motion") * p - Matrix3::identity()));
    Vector3::new(log[(1, 0)], log[(0, 2)], log[(1, 2)])
}

/// Vectors one after the other.
fn all<const D: usize>(parts: &[&[f64]]) -> SVector<f64, D> {
    SVector::from_iterator(parts.concat())
}

/// A place in the plane.
fn planar(random: &mut Random) -> Matrix3<f64> {
    super::place(3.0 * random.number(), random.number(), random.number())
}

fn chart_of_masses() -> Chart<(Vector3<f64>, Vector3<f64>), 6> {
    Chart {
        moved: |(x, n), delta| (x + delta.fixed_rows::<3>(0), n + delta.fixed_rows::<3>(3)),
        coordinates: |(x, n), (y, m)| all(&[(y - x).as_slice(), (m - n).as_slice()]),
    }
}

fn chart_of_sleighs() -> Chart<(Matrix3<f64>, Vector3<f64>), 6> {
    Chart {
        moved: |(q, n), delta| (moved(q, &delta.fixed_rows::<3>(0).into()), n + delta.fixed_rows::<3>(3)),
        coordinates: |(q, n), (p, m)| all(&[apart(q, p).as_slice(), (m - n).as_slice()]),
    }
}

#[test]
fn derivatives_with_a_constraint_and_a_reference_are_differences() -> Result<(), Error> {
    let random = &mut Random::new(3510);
    let system = OnGround { mass: 1.3, inertia: 0.4, slip: 0.2 };
    for _ in 0..long(8) {
        let reference = random.vector::<1>();
        let constants = |h| Referring { reference, ..system.prepare(h).expect("regular parameters") };
        check_with::<_, 6, 2, 0>(&system, &constants, &chart_of_sleighs(), &(planar(random), random.vector()), random);
    }
    // over ice, and over ground where nothing glides
    let control = system.control(H)?;
    let start = (Matrix3::identity(), Vector3::zeros());
    let goal = (super::place(0.0, 1.0, 0.0), Vector3::zeros());
    let price = |at_first: f64, later: f64| {
        let mut plan = [control.stage(&start); 20];
        control.refer(&mut plan, |k, _| Vector1::new(if k < 10 { at_first } else { later }));
        let optimum = control.solve(&start, Target::Place(goal), &mut plan)?;
        assert!(optimum.is_minimum() && optimum.gap() < 1e-10, "{optimum:?}");
        Ok::<_, Error>(optimum.price())
    };
    // rough ground is dear where the sledge gets going, and brakes it where it stops
    let smooth = price(0.0, 0.0)?;
    assert!(price(2.0, 0.0)? > 1.1 * smooth && price(0.0, 2.0)? < smooth);
    Ok(())
}

#[test]
fn derivatives_of_a_sleigh_are_differences() {
    let random = &mut Random::new(3501);
    let chart = chart_of_sleighs();
    for _ in 0..long(8) {
        let system = DrivenSleigh { mass: 1.3, inertia: 0.4, friction: 0.3, fastest: 1.0 };
        check::<_, 6, 2, 1>(&system, &chart, &(planar(random), random.vector()), random);
    }
}

#[test]
fn derivatives_on_a_turning_table_are_differences() {
    let random = &mut Random::new(3502);
    let chart = Chart::<((Vector2<f64>, Matrix3<f64>), SVector<f64, 5>), 10> {
        moved: |((x, r), n), delta| {
            let turn = exponential(&delta.fixed_rows::<3>(2).into_owned().cross_matrix());
            ((x + delta.fixed_rows::<2>(0), r * turn), n + delta.fixed_rows::<5>(5))
        },
        coordinates: |((x, r), n), ((y, s), m)| {
            let log = logarithm(&(r.transpose() * s - Matrix3::identity()));
            all(&[(y - x).as_slice(), &[log[(2, 1)], log[(0, 2)], log[(1, 0)]], (m - n).as_slice()])
        },
    };
    for _ in 0..long(8) {
        let system = Ball { mass: 1.3, inertia: 0.5, radius: 0.8, table_rate: 0.6, drag: 0.3 };
        let place = (random.vector(), random.attitude());
        check::<_, 10, 2, 0>(&system, &chart, &(place, random.vector()), random);
    }
}

#[test]
fn derivatives_of_a_board_are_differences() {
    let random = &mut Random::new(3503);
    let chart = Chart::<((Matrix3<f64>, Vector2<f64>), SVector<f64, 5>), 10> {
        moved: |((q, r), n), delta| {
            ((moved(q, &delta.fixed_rows::<3>(0).into()), r + delta.fixed_rows::<2>(3)), n + delta.fixed_rows::<5>(5))
        },
        coordinates: |((q, r), n), ((p, s), m)| all(&[apart(q, p).as_slice(), (s - r).as_slice(), (m - n).as_slice()]),
    };
    for _ in 0..long(8) {
        let system = Board { mass: 1.3, rotor: 0.4, wheel: 0.3 };
        let place = (planar(random), Vector2::new(random.number(), 0.8 + 0.3 * random.number()));
        check::<_, 10, 2, 0>(&system, &chart, &(place, random.vector()), random);
    }
}

#[test]
fn derivatives_on_a_moving_sphere_are_differences() {
    let random = &mut Random::new(3504);
    let chart = chart_of_masses();
    for _ in 0..long(8) {
        let pivot = random.vector::<3>();
        let system = Charge { mass: 1.3, charge: 0.5, pivot, length: 2.0, growth: 0.3, drag: 0.2 };
        let x = pivot * super::derivatives::T + random.vector::<3>().normalize() * (2.0 + 0.3 * super::derivatives::T);
        check::<_, 6, 2, 2>(&system, &chart, &(x, random.vector()), random);
    }
}

#[test]
fn derivatives_with_a_wheel_and_a_moving_inertia_are_differences() {
    let random = &mut Random::new(3505);
    let chart = chart_of_masses();
    for _ in 0..long(8) {
        let system = Mechanism { growth: 0.3, coupling: 0.4, drag: 0.2 };
        check::<_, 6, 1, 0>(&system, &chart, &(random.vector(), random.vector()), random);
    }
}

#[test]
fn derivatives_with_hinges_are_differences() {
    let random = &mut Random::new(3506);
    let chart = Chart::<([Matrix3<f64>; 2], SVector<f64, 6>), 12> {
        moved: |(q, n), delta| {
            let parts = [delta.fixed_rows::<3>(0).into(), delta.fixed_rows::<3>(3).into()];
            ([moved(&q[0], &parts[0]), moved(&q[1], &parts[1])], n + delta.fixed_rows::<6>(6))
        },
        coordinates: |(q, n), (p, m)| {
            all(&[apart(&q[0], &p[0]).as_slice(), apart(&q[1], &p[1]).as_slice(), (m - n).as_slice()])
        },
    };
    for _ in 0..long(8) {
        let system = acrobot(random);
        let q = hung(&system, [2.0 * random.number(), 2.0 * random.number()]);
        check::<_, 12, 1, 0>(&system, &chart, &(q, random.vector()), random);
    }
}

fn acrobot(random: &mut Random) -> Acrobot {
    let [near, far] = [Vector2::new(0.0, 0.5), Vector2::new(0.0, -0.6)];
    let mass = [1.0 + 0.3 * random.number(), 0.8 + 0.3 * random.number()];
    Acrobot { mass, inertia: [0.2, 0.15], near: [near, near], far }
}

/// Both bodies at these angles.
fn hung(system: &Acrobot, angles: [f64; 2]) -> [Matrix3<f64>; 2] {
    let turn = |angle: f64| nalgebra::Rotation2::new(angle);
    let first = -(turn(angles[0]) * system.near[0]);
    let second = first + turn(angles[0]) * system.far - turn(angles[1]) * system.near[1];
    [super::place(angles[0], first.x, first.y), super::place(angles[1], second.x, second.y)]
}

/// Of a sleigh that glides straight ahead the steps are linear: x⁺ = x + h(p + hu/2)/m, p⁺ = p + hu. So the least price is that of least norm.
#[test]
fn a_sleigh_glides_straight_at_the_least_norm() -> Result<(), Error> {
    const N: usize = 20;
    let (random, h) = (&mut Random::new(3507), H);
    for _ in 0..long(8) {
        let (mass, length) = (1.0 + random.number().abs(), 1.0 + random.number());
        let system = DrivenSleigh { mass, inertia: 0.4, friction: 0.0, fastest: 9.0 };
        let control = system.control(h)?;
        let start = (Matrix3::identity(), Vector3::zeros());
        let mut plan = [control.stage(&start); N];
        let goal = (super::place(0.0, length, 0.0), Vector3::zeros());
        let optimum = control.solve(&start, Target::Place(goal), &mut plan)?;
        let after = |k: usize| f64::from((N - 1 - k) as u32) + 0.5;
        let rows = DMatrix::from_fn(2, N, |i, k| if i == 0 { h * h / mass * after(k) } else { h });
        let wanted = DVector::from_vec(vec![length, 0.0]);
        let inputs = rows.transpose() * (&rows * rows.transpose()).lu().solve(&wanted).expect("independent rows");
        let price = h * inputs.norm_squared() / 2.0;
        assert!(optimum.is_minimum() && (optimum.price() - price).abs() < 1e-10 * price, "{optimum:?} is not {price}");
        for (stage, expected) in plan.iter().zip(inputs.iter()) {
            assert!((stage.input() - Vector2::new(0.0, *expected)).norm() < 1e-8 * inputs.amax());
        }
    }
    Ok(())
}

/// A mass on a sphere turns by the angle θ in a time T, from rest to rest, at the price 6θ²/T³. Steps come near it to second order.
#[test]
fn a_mass_on_a_sphere_turns_at_the_price_of_a_cubic() -> Result<(), Error> {
    let (angle, time) = (1.9_f64, 2.0_f64);
    let expected = 6.0 * angle.powi(2) / time.powi(3);
    let start = (Vector3::x(), Vector3::zeros());
    let goal = (Vector3::new(angle.cos(), angle.sin(), 0.0), Vector3::zeros());
    let mut errors = Vec::new();
    for steps in [10, 20, 40] {
        let control = OnSphere { radius: 1.0, mass: 1.0 }.control(time / steps as f64)?;
        let mut plan = vec![control.stage(&start); steps];
        let optimum = control.solve(&start, Target::Place(goal), &mut plan)?;
        assert!(optimum.is_minimum() && optimum.gap() < 1e-11, "{optimum:?}");
        // no force is spent across the sphere
        for stage in optimum.stages() {
            let ((x, n), u) = (stage.place(), stage.input());
            assert!((x.norm() - 1.0).abs() < 1e-12 && x.dot(n).abs() < 1e-11 && u.z.abs() < 1e-7, "{stage:?}");
        }
        errors.push(optimum.price() - expected);
    }
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.2, "order {order}: {errors:?}");
    }
    Ok(())
}

/// The end of a board after these inputs, rolled out by the stepper, which knows nothing of plans.
fn rolled_out(board: &Board, start: &OfBoard, inputs: &DVector<f64>) -> Result<OfBoard, Error> {
    let stepper = board.clone().into_stepper(H)?;
    let mut state = stepper.state(start.0, start.1)?;
    for u in inputs.as_slice().chunks(2) {
        state = stepper.step_with(&state, &Vector2::from_column_slice(u))?;
    }
    Ok((*state.configuration(), state.momentum()))
}

/// The numbers of a place.
fn numbers(((q, r), n): &OfBoard) -> DVector<f64> {
    DVector::from_iterator(16, q.iter().chain(r).chain(n).copied())
}

/// The slope of the price by all inputs is a combination of those of the end.
#[test]
fn plans_of_boards_are_critical_among_those_to_the_same_end() -> Result<(), Error> {
    const N: usize = 12;
    let random = &mut Random::new(3508);
    for _ in 0..long(8) {
        let board = Board { mass: 1.3, rotor: 0.4, wheel: 0.3 };
        let control = board.clone().control(H)?;
        let constants = board.prepare(H)?;
        let start = ((super::place(0.2, 0.1, -0.3), Vector2::new(0.1, 0.7)), SVector::zeros());
        // a target that inputs are known to reach
        let goal = rolled_out(&board, &start, &DVector::from_fn(2 * N, |_, _| random.number()))?;
        let mut plan = [control.stage(&start); N];
        let optimum = control.solve(&start, Target::Place(goal), &mut plan)?;
        assert!(optimum.is_minimum() && optimum.gap() < 1e-10, "{optimum:?}");
        let price_of_plan = optimum.price();
        let inputs = DVector::from_iterator(2 * N, plan.iter().flat_map(|stage| stage.input().iter().copied()));
        let end = rolled_out(&board, &start, &inputs)?;
        let price = |inputs: &DVector<f64>, end: &OfBoard| {
            H * inputs.norm_squared() / 2.0 + board.endpoint(&constants, H * N as f64, end)
        };
        assert!((numbers(&end) - numbers(&goal)).amax() < 1e-9);
        assert!((price(&inputs, &end) - price_of_plan).abs() < 1e-10 * price_of_plan.abs());
        let step = 1e-5;
        let (mut slopes, mut slope) = (DMatrix::zeros(2 * N, 16), DVector::zeros(2 * N));
        for i in 0..2 * N {
            let moved = |by: f64| {
                let mut inputs = inputs.clone();
                inputs[i] += by;
                let end = rolled_out(&board, &start, &inputs)?;
                Ok::<_, Error>((price(&inputs, &end), numbers(&end)))
            };
            let ((dearer, later), (cheaper, before)) = (moved(step)?, moved(-step)?);
            slopes.row_mut(i).copy_from(&((later - before).transpose() / (2.0 * step)));
            slope[i] = (dearer - cheaper) / (2.0 * step);
        }
        let multipliers = slopes.clone().svd(true, true).solve(&slope, 1e-7).expect("both sides");
        let left = &slope - &slopes * multipliers;
        assert!(left.amax() < 1e-6 * slope.amax(), "{left} is left of {slope}");
    }
    Ok(())
}

/// Starts and targets that are off the constraint are told by how much; only a target with its momentum has to move as it allows.
#[test]
fn places_off_the_constraint_are_refused() -> Result<(), Error> {
    let control = OnSphere { radius: 1.0, mass: 1.0 }.control(0.1)?;
    let (start, across) = ((Vector3::x(), Vector3::zeros()), (Vector3::y(), Vector3::y()));
    let mut plan = [control.stage(&start); 10];
    let mut solve = |start, target| control.solve(&start, target, &mut plan).map(|optimum| optimum.gap());
    let far = (Vector3::x() * 1.1, Vector3::zeros());
    assert!(matches!(solve(far, Target::Free), Err(Error::OffConstraint { .. })));
    assert!(matches!(solve(start, Target::Place(far)), Err(Error::OffConstraint { .. })));
    assert!(matches!(solve(start, Target::Configuration(far)), Err(Error::OffConstraint { .. })));
    assert!(matches!(solve((Vector3::x(), Vector3::x()), Target::Free), Err(Error::ConstraintViolated { .. })));
    assert!(matches!(solve(start, Target::Place(across)), Err(Error::ConstraintViolated { .. })));
    // at rest there is no velocity to compare round-off with
    assert!(solve((Vector3::x(), Vector3::x() * 1e-10), Target::Free)? < 1e-10);
    assert!(solve(start, Target::Configuration(across))? < 1e-10);
    Ok(())
}

/// An arm that turns its hand up. All conditions follow from three of them, because the hinges tie the places of both bodies.
#[test]
fn conditions_may_follow_from_others_and_the_constraint() -> Result<(), Error> {
    let random = &mut Random::new(3509);
    for _ in 0..long(8) {
        let links = acrobot(random);
        let start = (hung(&links, [0.1, -0.2]), SVector::zeros());
        let goal = hung(&links, [0.9 + 0.3 * random.number(), 1.3 + 0.3 * random.number()]);
        let Acrobot { mass, inertia, near, far } = links;
        let system = Arm { mass, inertia, near, far };
        let control = system
            .control(0.05)?
            .with_end_reference([goal[0].fixed_view::<2, 1>(0, 2).into(), goal[1].fixed_view::<2, 1>(0, 2).into()])?;
        let mut plan = [control.stage(&start); 20];
        let optimum = control.solve(&start, Target::Conditions, &mut plan)?;
        assert!(optimum.is_minimum() && optimum.gap() < 1e-10, "{optimum:?}");
        let (q, n) = optimum.end();
        for (q, goal) in q.iter().zip(&goal) {
            assert!((q - goal).amax() < 1e-9, "{q} is not {goal}");
        }
        assert!(n.amax() < 1e-9);
    }
    Ok(())
}

/// To a height on the sphere. The price of the end outweighs that of the force, so the end is the nearest place at that height. The
/// farthest place is critical too, and is no minimum.
#[test]
fn an_end_at_a_height_is_the_nearest_one() -> Result<(), Error> {
    let random = &mut Random::new(3511);
    for _ in 0..long(20) {
        let height = 0.9 * random.number();
        let (away, azimuth) = (0.5 + random.number().abs(), 3.0 * random.number());
        let wanted = Vector3::new(away * azimuth.cos(), away * azimuth.sin(), random.number());
        let radius = (1.0 - height * height).sqrt();
        let nearest = Vector3::new(radius * azimuth.cos(), radius * azimuth.sin(), height);
        let system = ToHeight { price: 1e-5, height, wanted };
        let control = system.clone().control(H)?;
        let start = (Vector3::x(), Vector3::zeros());
        let mut plan = [control.stage(&start); 20];
        let optimum = control.solve(&start, Target::Conditions, &mut plan)?;
        let (end, _) = *optimum.end();
        assert!(optimum.is_minimum() && optimum.gap() < 1e-10, "{optimum:?}");
        assert!((end - nearest).norm() < 0.02, "{end} is not {nearest}");
    }
    // from the farthest place nothing moves. The plan that rests there has a direction in which the price falls, and says so
    let system = ToHeight { price: 1e-5, height: 0.0, wanted: Vector3::new(-1.0, 0.0, 0.5) };
    let control = system.control(H)?;
    let start = (Vector3::x(), Vector3::zeros());
    let mut plan = [control.stage(&start); 20];
    let optimum = control.solve(&start, Target::Conditions, &mut plan)?;
    let (end, _) = *optimum.end();
    assert_eq!(optimum.is_minimum(), (end + Vector3::x()).norm() < 0.02, "{end}, {optimum:?}");
    Ok(())
}

/// Plans are the same in other units of mass: the places are, and forces are as many times larger.
#[test]
fn heavy_masses_are_planned_as_light_ones() -> Result<(), Error> {
    let random = &mut Random::new(3512);
    for _ in 0..long(8) {
        let [from, to] = [random.vector::<3>().normalize(), random.vector::<3>().normalize()];
        let across = |x: &Vector3<f64>, v: Vector3<f64>| v - x * x.dot(&v);
        let [leaving, landing] = [across(&from, random.vector()), across(&to, random.vector())];
        for of_configuration in [false, true] {
            let mut found = Vec::new();
            for mass in [1.0, 2.0_f64.powi(20)] {
                let control = OnSphere { radius: 1.0, mass }.control(H)?;
                let start = (from, leaving * mass);
                let goal = (to, landing * mass);
                let target = if of_configuration { Target::Configuration(goal) } else { Target::Place(goal) };
                let mut plan = [control.stage(&start); 20];
                let optimum = control.solve(&start, target, &mut plan)?;
                assert!(optimum.is_minimum() && optimum.gap() < 1e-9 * mass, "{mass}: {optimum:?}");
                found.push((optimum.price() / mass.powi(2), plan.map(|stage| stage.place().0)));
            }
            let [(light, places), (heavy, others)] = [&found[0], &found[1]];
            assert!((light - heavy).abs() < 1e-7 * light, "{light} is not {heavy}");
            assert!(places.iter().zip(others).all(|(x, y)| (x - y).norm() < 1e-6));
        }
    }
    Ok(())
}
