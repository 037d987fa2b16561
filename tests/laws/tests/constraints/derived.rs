//! Derivatives of steps with a constraint: by several methods, in lanes, of runs, and fits that need them.

use crate::order::integrated;
use clebsch::{Clebsch, Differentiated, Error, F64x4, Method, Scalar, Sensitive, Sensitivity, State};
use clebsch_tests::fixtures::shaken_pendulum::ShakenPendulum;
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Matrix3x2, Rotation3, SMatrix, SVector, Vector1, Vector2, Vector3};

/// Suslov's body under gravity, with steps of several methods.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential      = |R| self.weight * R[(2, 0)],
    constraint     = |omega| [omega.z == 0],
    discretization = moser_veselov,
    method Cayley      = (discretization = cayley),
    method Exponential = (discretization = exponential),
    method Projection  = (discretization = projection),
    method Fourth      = (discretization = moser_veselov, order = 4),
    method Eighth      = (discretization = cayley, order = 8),
    method Compensated = (discretization = moser_veselov, summation = compensated),
    emit           = [tangent],
)]
pub struct Suslov<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    pub weight: T,
}

pub struct Cayley;
pub struct Exponential;
pub struct Projection;
pub struct Fourth;
pub struct Eighth;
pub struct Compensated;

fn suslov() -> Suslov<f64> {
    Suslov { inertia: Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9), weight: 0.8 }
}

/// The size of a central difference, and the error of a second derivative of order one.
const DIFFERENCE: f64 = 1e-5;
const NEAR: f64 = 1e-8;

/// A step by a method against differences of such steps from turned starts, with other velocities and weights.
fn follows_differences<M>(name: &str) -> Result<(), Error>
where
    M: Method<Suslov<f64>> + Differentiated<Suslov<f64>, 3>,
{
    let place = *Rotation3::new(Vector3::new(0.4, -0.3, 0.9)).matrix();
    let velocity = Vector3::new(0.9, -0.7, 0.0);
    let step = |turn: Vector3<f64>, change: Vector3<f64>, weight: f64| -> Result<_, Error> {
        let system = Suslov { weight, ..suslov() };
        let stepper = system.stepper_by::<M>(0.1)?;
        let turned = place * Rotation3::new(turn).matrix();
        let next = stepper.step(&stepper.state_moving(turned, velocity + change)?)?;
        Ok((*next.configuration(), next.momentum()))
    };
    let system = suslov();
    let stepper = system.stepper_by::<M>(0.1)?;
    let start = stepper.state_moving(place, velocity)?;
    let (next, tangent, sensitivity) = stepper.step_sensitivity::<8>(&start)?;
    assert_eq!(next.momentum(), stepper.step_tangent(&start)?.0.momentum());
    assert!((next.momentum() - stepper.step(&start)?.momentum()).norm() < 1e-14, "{name}");
    let check =
        |what: &str, plus: (Matrix3<f64>, Vector3<f64>), minus: (Matrix3<f64>, Vector3<f64>), motion, momentum| {
            let moved =
                (plus.0 - minus.0) / (2.0 * DIFFERENCE) - stepper.infinitesimal_motion(next.configuration(), &motion);
            let changed: Vector3<f64> = (plus.1 - minus.1) / (2.0 * DIFFERENCE) - momentum;
            assert!(
                moved.norm() < NEAR && changed.norm() < NEAR,
                "{name}, {what}: {:e} {:e}",
                moved.norm(),
                changed.norm()
            );
        };
    let (zero, weight) = (Vector3::zeros(), system.weight);
    for k in 0..3 {
        let eta = Vector3::ith(k, DIFFERENCE);
        let (motion, momentum) = (tangent.motion_by_motion.column(k), tangent.momentum_by_motion.column(k));
        check("a turn", step(eta, zero, weight)?, step(-eta, zero, weight)?, motion.into(), momentum.into());
    }
    for k in 0..2 {
        let change = Vector3::ith(k, DIFFERENCE);
        let nu = system.inertia * Vector3::ith(k, 1.0);
        let (motion, momentum) = (tangent.motion_by_momentum * nu, tangent.momentum_by_momentum * nu);
        check("a velocity", step(zero, change, weight)?, step(zero, -change, weight)?, motion, momentum);
    }
    let (motion, momentum) = (sensitivity.motion.column(6), sensitivity.momentum.column(6));
    let weights = (step(zero, zero, weight + DIFFERENCE)?, step(zero, zero, weight - DIFFERENCE)?);
    check("a weight", weights.0, weights.1, motion.into(), momentum.into());
    Ok(())
}

#[test]
fn all_methods_have_them() -> Result<(), Error> {
    assert_eq!(Suslov::<f64>::QUANTITIES[6..], ["weight", "h"]);
    follows_differences::<clebsch::Declared>("Moser and Veselov")?;
    follows_differences::<Cayley>("Cayley")?;
    follows_differences::<Exponential>("exponential")?;
    follows_differences::<Projection>("projection")?;
    follows_differences::<Fourth>("order 4")?;
    follows_differences::<Eighth>("order 8")?;
    follows_differences::<Compensated>("compensated sums")
}

#[test]
fn lanes_and_single_precision_have_them() -> Result<(), Error> {
    let place = *Rotation3::new(Vector3::new(0.4, -0.3, 0.9)).matrix();
    let velocities = [0.9, 0.5, -0.3, 0.0].map(|x| Vector3::new(x, -0.7, 0.0));
    let Suslov { inertia, weight } = suslov();
    let wide = Suslov { inertia: inertia.map(F64x4::splat), weight: F64x4::splat(weight) };
    let wide = wide.into_stepper(F64x4::splat(0.1))?;
    let velocity = Vector3::from_fn(|i, _| F64x4::from_lanes(|lane| velocities[lane][i]));
    let (_, all, slopes) = wide.step_sensitivity::<8>(&wide.state_moving(place.map(F64x4::splat), velocity)?)?;
    let single = Suslov { inertia: inertia.cast::<f32>(), weight: weight as f32 }.into_stepper(0.1)?;
    for (lane, velocity) in velocities.into_iter().enumerate() {
        let one = suslov().into_stepper(0.1)?;
        let (_, alone, alone_slopes) = one.step_sensitivity::<8>(&one.state_moving(place, velocity)?)?;
        let in_lane = |part: SMatrix<F64x4, 3, 3>| part.map(|entry| Scalar::lane(entry, lane));
        let start = single.state_moving(place.cast::<f32>(), velocity.cast::<f32>())?;
        let (_, short) = single.step_tangent(&start)?;
        for (wide, short, alone) in [
            (all.motion_by_motion, short.motion_by_motion, alone.motion_by_motion),
            (all.motion_by_momentum, short.motion_by_momentum, alone.motion_by_momentum),
            (all.momentum_by_motion, short.momentum_by_motion, alone.momentum_by_motion),
            (all.momentum_by_momentum, short.momentum_by_momentum, alone.momentum_by_momentum),
        ] {
            assert!((in_lane(wide) - alone).amax() < 1e-14, "lane {lane}");
            assert!((short.cast::<f64>() - alone).amax() < 2e-6, "{:e}", (short.cast::<f64>() - alone).amax());
        }
        let slopes = slopes.momentum.map(|entry| Scalar::lane(entry, lane));
        assert!((slopes - alone_slopes.momentum).amax() < 1e-14, "lane {lane}");
    }
    Ok(())
}

/// Angle, rate and length of a pendulum on a pivot that shakes.
fn late(angle: f64, rate: f64, length: f64) -> Result<(State<ShakenPendulum>, [Sensitivity<f64, 2, 3>; 2]), Error> {
    const STEPS: usize = 100;
    let system = ShakenPendulum { mass: 1.2, gravity: 9.81, drag: 0.1, shaking: 0.1, rate: 3.0, length };
    let stepper = system.clone().into_stepper(0.02)?;
    let (sin, cos) = angle.sin_cos();
    let (along, across) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
    let moving = Vector2::new(0.0, system.shaking * system.rate);
    let start = stepper.state_moving(along * length, moving + across * (length * rate))?;
    // by the angle, by the rate, and by the length
    let of_start = Sensitivity {
        motion: Matrix2x3::from_columns(&[across * length, Vector2::zeros(), along]),
        momentum: Matrix2x3::from_columns(&[-along * (length * rate), across * length, across * rate]) * system.mass,
    };
    let mut state = start;
    let mut of_run = of_start;
    let column = ShakenPendulum::QUANTITIES.iter().position(|name| *name == "length").expect("a quantity");
    for _ in 0..STEPS {
        let (next, tangent, of_step) = stepper.step_sensitivity_with::<9>(&state, &Vector1::new(0.4))?;
        let mut of_length = Sensitivity::<f64, 2, 3>::zero();
        of_length.motion.set_column(2, &of_step.motion.column(column));
        of_length.momentum.set_column(2, &of_step.momentum.column(column));
        of_run = of_run.after(&tangent, &of_length);
        state = next;
    }
    Ok((state, [of_start, of_run]))
}

/// A run of steps on a place that moves, by its start and by the length of the rod, against differences of runs.
#[test]
fn runs_follow_their_starts_and_the_constraint() -> Result<(), Error> {
    let (end, [_, slopes]) = late(0.3, 0.8, 0.7)?;
    let epsilon = 1e-4;
    for k in 0..3 {
        let run = |part: f64| -> Result<(Vector2<f64>, Vector2<f64>), Error> {
            let step = |j: usize| if j == k { part * epsilon } else { 0.0 };
            let (end, _) = late(0.3 + step(0), 0.8 + step(1), 0.7 + step(2))?;
            Ok((*end.configuration(), end.momentum()))
        };
        // of fourth order
        let [a, b, c, d] = [run(1.0)?, run(-1.0)?, run(2.0)?, run(-2.0)?];
        let slope = |a: Vector2<f64>, b: Vector2<f64>, c: Vector2<f64>, d: Vector2<f64>| {
            ((a - b) * 8.0 - (c - d)) / (12.0 * epsilon)
        };
        let (place, momentum) = (slope(a.0, b.0, c.0, d.0), slope(a.1, b.1, c.1, d.1));
        let error = (place - slopes.motion.column(k)).norm() + (momentum - slopes.momentum.column(k)).norm();
        assert!(error < 1e-9, "quantity {k}: {error:e} of {:e}", place.norm());
    }
    // where the rod moves: across it, but for its length
    let pivot = Vector2::new(0.0, 0.1 * (3.0 * end.time()).sin());
    let rod = (end.configuration() - pivot) / 0.7;
    let along = slopes.motion.transpose() * rod;
    assert!((along - Vector3::z()).norm() < 1e-12, "{along}");
    Ok(())
}

/// A sleigh that is to be identified.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SE<2>, q: SE<2>| q * F,
    lagrangian     = |xi| (self.inertia * xi.x.powi(2) + self.mass * (xi.y.powi(2) + (xi.z + self.offset * xi.x).powi(2))) / 2,
    discretization = moser_veselov,
    constraint     = |xi| [xi.z == 0],
    order          = 4,
    emit           = [tangent],
)]
pub struct Sleigh {
    pub mass: f64,
    pub inertia: f64,
    pub offset: f64,
}

const TURN: f64 = 1.1;
const SPEED: f64 = -0.8;
/// Samples, and the steps from one to the next.
const SAMPLES: usize = 10;
const STEPS: usize = 10;

/// x, y and the sine of the heading.
fn seen(q: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(q[(0, 2)], q[(1, 2)], q[(1, 0)])
}

/// Some numbers, with their derivatives by inertia and offset.
type Sample = (Vector3<f64>, Matrix3x2<f64>);

/// The samples of a sleigh.
fn track(sleigh: &Sleigh) -> Result<Vec<Sample>, Error> {
    let stepper = sleigh.stepper(0.02)?;
    let mut state = stepper.state_moving(Matrix3::identity(), Vector3::new(TURN, SPEED, 0.0))?;
    // quantities: mass, inertia, offset, h. The momentum of the start is ((I + m a²) ω, m v, m a ω)
    let mut of_run = Sensitivity::<f64, 3, 4>::zero();
    of_run.momentum.set_column(1, &Vector3::new(TURN, 0.0, 0.0));
    let by_offset = sleigh.mass * Vector3::new(2.0 * sleigh.offset * TURN, 0.0, TURN);
    of_run.momentum.set_column(2, &by_offset);
    let mut samples = Vec::new();
    for number in 1..=SAMPLES * STEPS {
        let (next, tangent, of_step) = stepper.step_sensitivity(&state)?;
        (state, of_run) = (next, of_run.after(&tangent, &of_step));
        if number % STEPS == 0 {
            let q = state.configuration();
            let slope = |k: usize| seen(&stepper.infinitesimal_motion(q, &of_run.motion.column(k).into_owned()));
            samples.push((seen(q), Matrix3x2::from_columns(&[slope(1), slope(2)])));
        }
    }
    Ok(samples)
}

/// Inertia and offset of a sleigh from its track, by Gauss and Newton. The track is an integration of the equations of motion by
/// another method.
#[test]
fn a_sleigh_is_identified_from_its_track() -> Result<(), Error> {
    assert_eq!(Sleigh::QUANTITIES, ["mass", "inertia", "offset", "h"]);
    let (mass, inertia, offset) = (1.5, 0.4, 0.6);
    // m v′ = m a ω², (I + m a²) ω′ = −m a v ω
    let slope = |y: &SVector<f64, 5>| {
        let [_, _, heading, turn, speed] = *y.as_ref();
        let slower = -mass * offset * speed * turn / (inertia + mass * offset * offset);
        SVector::from([speed * heading.cos(), speed * heading.sin(), turn, slower, offset * turn * turn])
    };
    let measured = (1..=SAMPLES).map(|number| {
        let time = 0.02 * (number * STEPS) as f64;
        let y = integrated(slope, SVector::from([0.0, 0.0, 0.0, TURN, SPEED]), time);
        Vector3::new(y[0], y[1], y[2].sin())
    });
    let measured: Vec<Vector3<f64>> = measured.collect();
    let mut found = Vector2::new(0.5, 0.45);
    for _ in 0..12 {
        let samples = track(&Sleigh { mass, inertia: found.x, offset: found.y })?;
        let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
        for ((place, slopes), measured) in samples.iter().zip(&measured) {
            normal += slopes.transpose() * slopes;
            right += slopes.transpose() * (measured - place);
        }
        found += normal.try_inverse().expect("both numbers show") * right;
    }
    let error = (found - Vector2::new(inertia, offset)).amax();
    println!("inertia and offset to {error:e}");
    assert!(error < 1e-6, "{found}");
    Ok(())
}

#[test]
fn steps_without_a_solution_have_none() -> Result<(), Error> {
    let system = ShakenPendulum { mass: 1.2, gravity: 9.81, drag: 0.1, shaking: 0.1, rate: 3.0, length: 0.8 };
    let stepper = system.into_stepper(0.02)?;
    let start = stepper.state_moving(Vector2::new(0.0, -0.8), Vector2::new(0.0, 0.3))?;
    assert!(matches!(stepper.step_tangent_with(&start, &Vector1::new(f64::NAN)), Err(Error::NotFinite { .. })));
    let pushed = stepper.step_with(&start, &Vector1::new(1e5));
    assert!(pushed.is_err() && stepper.step_tangent_with(&start, &Vector1::new(1e5)).err() == pushed.err());
    Ok(())
}
