//! Steps in lanes are, bit for bit, those of single numbers. Neither the number of iterations in each lane nor the
//! outcome in the others matters.

mod lift;
mod side_by_side;
mod systems;

use clebsch::{Clebsch, Error, F32x8, F64x4, F64x8, Scalar, State};
use clebsch_tests::oracle::random::Random;
use lift::Lift;
#[cfg(feature = "heavy")]
use nalgebra::Matrix4;
use nalgebra::{Matrix3, SVector, Vector3};
use side_by_side::{Count, same};
use systems::{
    Body, CollocatedTop, CompensatedBody, ExactBody, Flyer, Pendulum, Satellite, SplitTop, TolerantBody, Top,
};
#[cfg(feature = "heavy")]
use systems::{Body4, ExactBody4, FixedBody, SixthTop};

const H: f64 = 0.1;
/// States of each system, and the steps of each.
const STATES: usize = if cfg!(feature = "heavy") { 1000 } else { 24 };
const STEPS: usize = 6;

/// A momentum whose size is anything from one that makes a step of one iteration to one that has none.
fn momentum<const M: usize>(random: &mut Random, longest: f64) -> SVector<f64, M> {
    random.unit::<M>() * longest * 10_f64.powf(random.between(-6.0, 0.2))
}

/// Steps `STATES` of a system, eight by eight, all with the same parameters.
macro_rules! compare {
    ($lanes:ty, $system:ident { $($field:ident: $value:expr),* $(,)? }, $h:expr, |$random:ident| $start:expr) => {{
        let mut $random = Random::new(7);
        let number = |x: f64| <$lanes as Scalar>::from_f64(x);
        let single = |x: f64| <<$lanes as Scalar>::Lane as Scalar>::from_f64(x);
        let lanes = $system { $($field: Lift::lift($value, number)),* }.stepper(number($h)).expect("parameters");
        let one = $system { $($field: Lift::lift($value, single)),* }.stepper(single($h)).expect("parameters");
        let singles = vec![one; <$lanes as Scalar>::LANES];
        let mut count = Count::default();
        for _ in 0..STATES / <$lanes as Scalar>::LANES {
            let starts: Vec<_> = singles
                .iter()
                .map(|_| {
                    let (q, mu) = $start;
                    (Lift::lift(q, single), Lift::lift(mu, single))
                })
                .collect();
            count.add(same(&lanes, &singles, &starts, STEPS));
        }
        println!("{}: {count:?}", stringify!($system));
        count
    }};
}

fn moments() -> Vector3<f64> {
    Vector3::new(1.0, 2.0, 2.5)
}

fn mass_matrix() -> Matrix3<f64> {
    Matrix3::new(1.2, 0.1, -0.2, 0.1, 0.8, 0.05, -0.2, 0.05, 0.5)
}

fn center() -> Vector3<f64> {
    Vector3::new(0.1, -0.2, 0.7)
}

/// If all of a thousand states are stepped, no claim about failures has been tested.
fn assert_mixed(count: Count) {
    assert!(
        count.stepped > STATES * STEPS / 2 && count.failed > STATES / 20 && count.spared > STATES / 20,
        "{count:?}"
    );
}

#[test]
fn free_bodies() {
    let longest = 2.0 / H;
    assert_mixed(compare!(F64x8, Body { moments: moments() }, H, |random| {
        (random.attitude::<3>(), momentum::<3>(&mut random, longest))
    }));
    assert_mixed(compare!(F64x4, Body { moments: moments() }, H, |random| {
        (random.attitude::<3>(), momentum::<3>(&mut random, longest))
    }));
}

#[test]
fn free_bodies_in_single_precision() {
    assert_mixed(compare!(F32x8, Body { moments: moments() }, H, |random| {
        (random.attitude::<3>(), momentum::<3>(&mut random, 2.0 / H))
    }));
}

/// Rounding errors travel with their lanes: the bits show them, after a step.
#[test]
fn bodies_with_compensated_sums() {
    assert_mixed(compare!(F64x8, CompensatedBody { moments: moments() }, H, |random| {
        (random.attitude::<3>(), momentum::<3>(&mut random, 2.0 / H))
    }));
    #[cfg(feature = "heavy")]
    assert_mixed(compare!(F32x8, CompensatedBody { moments: moments() }, H, |random| {
        (random.attitude::<3>(), momentum::<3>(&mut random, 2.0 / H))
    }));
}

#[test]
fn bodies_to_a_tolerance() {
    let longest = 2.0 / H;
    assert_mixed(compare!(F64x8, TolerantBody { moments: moments() }, H, |random| {
        (random.attitude::<3>(), momentum::<3>(&mut random, longest))
    }));
    #[cfg(feature = "heavy")]
    assert_mixed(compare!(F64x8, FixedBody { moments: moments() }, H, |random| {
        (random.attitude::<3>(), momentum::<3>(&mut random, longest))
    }));
    #[cfg(feature = "heavy")]
    assert_mixed(compare!(F32x8, TolerantBody { moments: moments() }, H, |random| {
        (random.attitude::<3>(), momentum::<3>(&mut random, longest))
    }));
}

#[test]
fn heavy_tops() {
    assert_mixed(compare!(F64x8, Top { mass_matrix: mass_matrix(), weight: 3.0, center: center() }, H, |random| (
        random.attitude::<3>(),
        momentum::<3>(&mut random, 2.0 / H)
    )));
}

#[cfg(feature = "heavy")]
#[test]
fn heavy_tops_of_sixth_order() {
    assert_mixed(compare!(
        F64x8,
        SixthTop { mass_matrix: mass_matrix(), weight: 3.0, center: center() },
        H,
        |random| (random.attitude::<3>(), momentum::<3>(&mut random, 1.5 / H))
    ));
}

/// Series of as many terms as each lane asks for, and parts where they are not enough: ten million radians of a step fail.
#[test]
fn exact_drifts() {
    let inertia = Matrix3::new(1.2, 0.1, -0.2, 0.1, 0.8, 0.05, -0.2, 0.05, 0.5);
    let count = compare!(F64x8, SplitTop { inertia: inertia, weight: 3.0, center: center() }, H, |random| (
        random.attitude::<3>(),
        momentum::<3>(&mut random, 1e8 / H)
    ));
    assert!(count.stepped > STATES && count.failed > 0, "{count:?}");
}

/// Some lanes need more sweeps than others, and some never settle.
#[test]
fn stages_of_sixteenth_order() {
    let top = |random: &mut Random| {
        let q = random.unit::<4>();
        (nalgebra::Quaternion::new(q[3], q[0], q[1], q[2]), momentum::<3>(random, 1e2 / H))
    };
    assert_mixed(compare!(F64x8, CollocatedTop { moments: moments(), weight: 3.0 }, H, |random| top(&mut random)));
    #[cfg(feature = "heavy")]
    assert_mixed(compare!(F32x8, CollocatedTop { moments: moments(), weight: 3.0 }, H, |random| top(&mut random)));
}

/// Motions that each lane knows, with as many parts as each needs.
#[test]
fn exact_motions() {
    let inertia = Matrix3::new(1.2, 0.1, -0.2, 0.1, 0.8, 0.05, -0.2, 0.05, 0.5);
    assert_mixed(compare!(F64x8, ExactBody { inertia: inertia }, H, |random| {
        (random.attitude::<3>(), momentum::<3>(&mut random, 1e8 / H))
    }));
}

/// The same in four dimensions.
#[cfg(feature = "heavy")]
#[test]
fn exact_motions_in_four_dimensions() {
    let turn = Random::new(12).attitude::<4>();
    let mass = turn * Matrix4::from_diagonal(&nalgebra::Vector4::new(0.4, 0.7, 1.0, 1.3)) * turn.transpose();
    assert_mixed(compare!(F64x8, ExactBody4 { mass: mass }, H, |random| {
        (random.attitude::<4>(), momentum::<6>(&mut random, 1e4 / H))
    }));
}

#[test]
fn spherical_pendulums() {
    assert_mixed(compare!(F64x8, Pendulum { mass: 1.5, length: 0.8, gravity: 9.81 }, H, |random| {
        let q: Vector3<f64> = random.unit();
        (q, q.cross(&momentum::<3>(&mut random, 1.2 / H)))
    }));
}

#[cfg(feature = "heavy")]
#[test]
fn bodies_in_four_dimensions() {
    let j_d = Matrix4::from_diagonal(&nalgebra::Vector4::new(0.4, 0.7, 1.0, 1.3));
    assert_mixed(compare!(F64x8, Body4 { j_d: j_d }, H, |random| {
        (random.attitude::<4>(), momentum::<6>(&mut random, 3.0 / H))
    }));
}

#[test]
fn exponential_charts_and_functions_of_the_time() {
    let inertia = Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.4, -0.1, 0.0, -0.1, 0.9);
    let count = compare!(F64x8, Satellite { inertia: inertia, weight: 0.7 }, H, |random| {
        (random.attitude::<3>(), momentum::<3>(&mut random, 8.0 / H))
    });
    assert!(count.stepped > STATES, "{count:?}");
}

/// Each lane has a body of its own, and a step size of its own.
#[test]
fn parameters_of_each_lane() {
    let mut random = Random::new(11);
    let mut count = Count::default();
    for _ in 0..STATES.div_ceil(8).max(6) {
        let bodies: [Top<f64>; 8] = std::array::from_fn(|_| Top {
            mass_matrix: random.inertia::<3>(),
            weight: random.between(0.0, 5.0),
            center: random.vector(),
        });
        let sizes: [f64; 8] = std::array::from_fn(|_| random.between(-0.2, 0.2));
        let lanes = Top {
            mass_matrix: Matrix3::from_fn(|i, j| F64x8::from_lanes(|lane| bodies[lane].mass_matrix[(i, j)])),
            weight: F64x8::from_lanes(|lane| bodies[lane].weight),
            center: Vector3::from_fn(|i, _| F64x8::from_lanes(|lane| bodies[lane].center[i])),
        };
        let singles: Vec<_> = bodies.iter().zip(sizes).map(|(body, h)| body.stepper(h).expect("parameters")).collect();
        let starts: Vec<_> =
            singles.iter().map(|_| (random.attitude::<3>(), momentum::<3>(&mut random, 15.0))).collect();
        count.add(same(&lanes.stepper(sizes.into()).expect("parameters"), &singles, &starts, STEPS));
    }
    assert_mixed(count);
}

/// Steps whose last ended with another size in some lanes: the impulse is computed anew there, and stays in the others.
#[test]
fn impulses_are_those_of_each_lane() {
    let top = |h: F64x8| {
        let number = F64x8::splat;
        let system = Top { mass_matrix: mass_matrix().map(number), weight: number(3.0), center: center().map(number) };
        system.stepper(h).expect("parameters")
    };
    let single =
        |h: f64| Top { mass_matrix: mass_matrix(), weight: 3.0, center: center() }.stepper(h).expect("parameters");
    let others: [f64; 8] = std::array::from_fn(|lane| if lane % 2 == 0 { H } else { 0.03 });
    let (q, mu) = (Matrix3::identity(), Vector3::new(0.1, 0.2, -0.3));
    let start = top(H.into()).state(q.map(F64x8::splat), mu.map(F64x8::splat)).expect("state");
    let end = top(others.into()).step(&top(H.into()).step(&start).expect("step")).expect("step");
    for (lane, h) in others.into_iter().enumerate() {
        let before = single(H).step(&single(H).state(q, mu).expect("state")).expect("step");
        let after: State<Top<f64>> = single(h).step(&before).expect("step");
        assert_eq!(end.lane(lane), (*after.configuration(), after.momentum()));
    }
}

/// Checks of parameters and states name the mistake in any lane, with its numbers.
#[test]
fn what_is_wrong_in_one_lane_is_refused() {
    let one = F64x8::splat(1.0);
    let mut zero = [1.0; 8];
    zero[5] = 0.0;
    let body = |moments: F64x8| Body { moments: Vector3::new(one, one, moments) };
    assert!(matches!(body(zero.into()).stepper(one), Err(Error::SingularKineticEnergy { .. })));
    assert_eq!(body(one).stepper(zero.into()).err(), Some(Error::StepSize { value: 0.0 }));
    let stepper = body(one).stepper(F64x8::splat(0.1)).expect("parameters");
    let mut attitude = Matrix3::<F64x8>::identity();
    let momentum = Vector3::repeat(one);
    assert!(stepper.state(attitude, momentum).is_ok());
    zero[5] = -1.0;
    attitude[(2, 2)] = zero.into();
    assert!(matches!(stepper.state(attitude, momentum), Err(Error::OffOrbit { defect: f64::INFINITY, .. })));
    zero[5] = 1.25;
    attitude[(2, 2)] = zero.into();
    assert!(matches!(stepper.state(attitude, momentum), Err(Error::OffOrbit { defect: 0.5625, .. })));
}

/// The energy, conserved momenta and the symmetric representation are those of each lane.
#[test]
fn what_else_a_stepper_tells() {
    let number = F64x8::splat;
    let lanes = Top { mass_matrix: mass_matrix().map(number), weight: number(3.0), center: center().map(number) };
    let lanes = lanes.stepper(number(H)).expect("parameters");
    let single = Top { mass_matrix: mass_matrix(), weight: 3.0, center: center() }.stepper(H).expect("parameters");
    let mut random = Random::new(3);
    let starts: [(Matrix3<f64>, Vector3<f64>, Matrix3<f64>); 8] =
        std::array::from_fn(|_| (random.attitude(), random.vector(), random.matrix()));
    let q = Matrix3::from_fn(|i, j| F64x8::from_lanes(|lane| starts[lane].0[(i, j)]));
    let mu = Vector3::from_fn(|i, _| F64x8::from_lanes(|lane| starts[lane].1[i]));
    let p = Matrix3::from_fn(|i, j| F64x8::from_lanes(|lane| starts[lane].2[(i, j)]));
    let state = lanes.state(q, mu).expect("states");
    let symmetric = lanes.step_symmetric(&lanes.cotangent_state(q, p).expect("states")).expect("steps");
    for (lane, (q, mu, p)) in starts.into_iter().enumerate() {
        let own = single.state(q, mu).expect("state");
        assert_eq!(lanes.energy(&state).to_array()[lane], single.energy(&own));
        assert_eq!(lanes.conserved(&state)[0].to_array()[lane], single.conserved(&own)[0]);
        let own = single.step_symmetric(&single.cotangent_state(q, p).expect("state")).expect("step");
        assert_eq!(symmetric.configuration().map(|x| x.to_array()[lane]), *own.configuration());
        assert_eq!(symmetric.covector().map(|x| x.to_array()[lane]), *own.covector());
    }
}

/// Positions beyond any bound overflow: such lanes fail by the quantity that is not finite.
#[test]
fn products_some_of_which_overflow() {
    let count = compare!(F64x8, Flyer { mass: 2.0, inertia: mass_matrix(), arm: center() }, H, |random| {
        let far = if random.number() > 0.8 { 1e100 } else { 1.0 };
        ((far * random.vector::<3>(), random.attitude::<3>()), momentum::<6>(&mut random, 0.7 / H))
    });
    assert_mixed(count);
}
