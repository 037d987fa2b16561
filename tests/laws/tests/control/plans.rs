//! Plans of declared systems: Riccati's gains, the conditions of first order of random problems, evaluated by themselves, and many targets.

use super::few;
use clebsch::{Clebsch, Controlled, Error, Optimum, Space, Target};
use clebsch_tests::fixtures::regulator::Regulator;
use clebsch_tests::fixtures::steered_body::SteeredBody;
use clebsch_tests::fixtures::unicycle::Unicycle;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3, Vector4};
use std::f64::consts::PI;

/// The Riccati recursion P = Q + Aᵀ(P − PB(R + BᵀPB)⁻¹BᵀP)A, by hand.
#[test]
fn a_regulator_has_the_gains_of_riccati() {
    let (h, system) = (0.1, Regulator { mass: 1.3, stiffness: 2.0, price: 0.5 });
    let a = Matrix2::new(1.0, h, -h * system.stiffness / system.mass, 1.0);
    let b = Vector2::new(0.0, h / system.mass);
    let (q, r) = (Matrix2::identity() * h, h * system.price);
    let start = Vector2::new(1.0, -0.4);
    let control = system.control(h).expect("regular");
    let mut plan = [control.stage(&start); 50];
    let optimum = control.solve(&start, Target::Free, &mut plan).expect("a plan");
    let mut p = Matrix2::zeros();
    for stage in optimum.stages().iter().rev() {
        let gain = -(b.transpose() * p * a) / (r + (b.transpose() * p * b)[0]);
        assert!((stage.gain() - gain).amax() < 1e-13, "{} is not {gain}", stage.gain());
        p = q + a.transpose() * p * (a + b * gain);
        assert!((stage.costate() - p * stage.place()).amax() < 1e-13);
    }
    assert!((optimum.price() - (start.transpose() * p * start)[0] / 2.0).abs() < 1e-13);
    assert!(optimum.is_minimum() && optimum.iterations() <= 2);
}

/// p_k = ∂ℓ/∂x + Aᵀp_{k+1} + ∂a/∂xᵀz, 0 = ∂ℓ/∂u + Bᵀp_{k+1} + ∂a/∂uᵀz, a ≤ 0 ≤ z, z·a = 0, and the inputs lead to the target.
fn first_order<S, const D: usize, const U: usize, const C: usize>(
    system: &S,
    h: f64,
    start: &S::Place,
    target: &S::Place,
    optimum: &Optimum<'_, S, D, U, C>,
    tolerance: f64,
) -> Result<(), Error>
where
    S: Controlled<D, U, C, Scalar = f64>,
{
    let constants = system.prepare(h)?;
    let mut x = *start;
    let mut price = 0.0;
    let stages = optimum.stages();
    let scale = 1.0 + stages.iter().map(|stage| stage.costate().amax()).fold(0.0, f64::max);
    for (k, stage) in stages.iter().enumerate() {
        let t = h * k as f64;
        assert!(x.distance_squared(stage.place()).sqrt() < 1e-12, "the place {k}");
        let next = stages.get(k + 1).map_or(optimum.final_costate(), |next| next.costate());
        let expansion = system.expand(&constants, t, &x, stage.input(), next)?;
        let z = stage.multipliers();
        let bounds = system.bounds_expanded(&constants, t, &x, stage.input(), z)?;
        let costate =
            expansion.price_by_place + expansion.by_place.transpose() * next + bounds.by_place.transpose() * z;
        let off = (costate - stage.costate()).amax();
        assert!(off < tolerance * scale, "{}: the costate {k} is {off:.1e} off", S::NAME);
        let slope = expansion.price_by_input + expansion.by_input.transpose() * next + bounds.by_input.transpose() * z;
        assert!(slope.amax() < tolerance * scale, "{}: slope {:.1e} at {k}", S::NAME, slope.amax());
        for i in 0..C {
            assert!(bounds.values[i] < 1e-9 && z[i] >= 0.0, "{}: bound {i} at {k}", S::NAME);
            assert!((z[i] * bounds.values[i]).abs() < 1e-9 * scale, "{}: both of {i} at {k}", S::NAME);
            assert_eq!(stage.active()[i], z[i] > -bounds.values[i]);
        }
        price += expansion.price;
        x = expansion.next;
    }
    assert!(x.distance_squared(target).sqrt() < 1e-11, "{}: the target", S::NAME);
    assert!((price - optimum.price()).abs() < 1e-12 * (1.0 + price.abs()));
    assert!(optimum.is_minimum());
    Ok(())
}

#[test]
fn unicycles_park_within_their_bounds() -> Result<(), Error> {
    let random = &mut Random::new(601);
    let mut held = 0;
    for _ in 0..few(20).max(5) {
        let system =
            Unicycle { turn_price: 1.0, top_turn: 3.0, time_price: 0.0, miss_price: 0.0, goal: Vector2::zeros() };
        let control = system.clone().control(0.05)?;
        let start = Matrix3::identity();
        // ahead, within a quarter of a turn
        let angle = random.between(-1.0, 1.0);
        let (sine, cosine) = angle.sin_cos();
        let (x, y) = (random.between(1.0, 2.0), random.between(-1.0, 1.0));
        let target = Matrix3::new(cosine, -sine, x, sine, cosine, y, 0.0, 0.0, 1.0);
        let mut plan = [control.stage(&start); 20];
        let optimum = control.solve(&start, Target::Place(target), &mut plan)?;
        held += optimum.stages().iter().filter(|stage| stage.active().contains(&true)).count();
        first_order(&system, 0.05, &start, &target, &optimum, 1e-10)?;
    }
    assert!(held > 0, "no bound was ever reached");
    Ok(())
}

#[test]
fn bodies_turn_within_their_torque() -> Result<(), Error> {
    let random = &mut Random::new(602);
    let mut held = 0;
    for _ in 0..few(5) {
        let system = SteeredBody { inertia: random.inertia::<3>(), damping: 0.1, top: 4.0 };
        let control = system.clone().control(0.1)?;
        let start = (random.attitude::<3>(), Vector3::zeros());
        let target = (start.0 * random.rotation::<3>(0.3), random.vector::<3>() * 0.1);
        let mut plan = [control.stage(&start); 20];
        let optimum = control.solve(&start, Target::Place(target), &mut plan)?;
        held += optimum.stages().iter().filter(|stage| stage.active().contains(&true)).count();
        first_order(&system, 0.1, &start, &target, &optimum, 1e-10)?;
    }
    println!("{held} stages at a bound");
    Ok(())
}

fn unicycle() -> Unicycle {
    Unicycle { turn_price: 1.0, top_turn: 4.0, time_price: 0.0, miss_price: 0.0, goal: Vector2::zeros() }
}

/// The same without bounds.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SE<2>, q: SE<2>| q * F,
    controls       = |u: Vector2| vector![u.x, u.y, 0],
    cost           = |h, u| h * u.norm_squared() / 2,
    endpoint       = |t, q| self.miss_price * (q.translation() - self.goal).norm_squared() / 2,
    discretization = exponential,
)]
struct FreeUnicycle {
    miss_price: f64,
    goal: Vector2<f64>,
}

fn free_unicycle() -> FreeUnicycle {
    FreeUnicycle { miss_price: 0.0, goal: Vector2::zeros() }
}

/// An element of SE(2).
pub(super) fn place(angle: f64, x: f64, y: f64) -> Matrix3<f64> {
    let (sin, cos) = angle.sin_cos();
    Matrix3::new(cos, -sin, x, sin, cos, y, 0.0, 0.0, 1.0)
}

/// The work of many problems: the sum and the largest number of linearisations.
#[derive(Default, Debug)]
struct Census {
    sum: u32,
    most: u32,
}

impl Census {
    fn count(&mut self, iterations: u32) {
        self.sum += iterations;
        self.most = self.most.max(iterations);
    }
}

/// It never drives back: quarter turns, half turns and any others, in few steps and many.
#[test]
fn a_unicycle_drives_anywhere() {
    let mut random = Random::new(11);
    let mut census = Census::default();
    let start = Matrix3::identity();
    let mut targets = vec![(50, place(core::f64::consts::FRAC_PI_2, 1.0, 1.0))];
    targets.extend((0..few(100)).map(|k| {
        let angle = random.number() * 2.0;
        ([20, 50, 90][k % 3], place(angle, random.between(0.3, 2.0), random.number()))
    }));
    let most = 30 * targets.len() as u32;
    for (k, (steps, target)) in targets.into_iter().enumerate() {
        let control = unicycle().control(1.0 / steps as f64).expect("regular");
        let mut plan = vec![control.stage(&start); steps];
        let found = control.solve(&start, Target::Place(target), &mut plan);
        let found = found.unwrap_or_else(|error| panic!("{k}: {error}"));
        census.count(found.iterations());
        assert!(found.gap() < 1e-11 && found.is_minimum(), "{k}: {found:?}");
        assert!(found.stages().iter().all(|s| s.input()[1] > -1e-12 && s.input()[0].abs() <= 4.0));
    }
    assert!(census.sum < most && census.most < 200, "{census:?}");
}

/// The end of the motion of least price in continuous time that begins with this costate, by Runge and Kutta's method. Inputs are
/// u = (p·e, π) with the heading e, and the angular costate π obeys π̇ = −(p·e)(p·e′).
fn extremal(p: Vector2<f64>, turn: f64) -> Matrix3<f64> {
    const STEPS: usize = 200;
    let h = 1.0 / STEPS as f64;
    let rate = |s: Vector4<f64>| {
        let heading = Vector2::new(s[2].cos(), s[2].sin());
        let speed = p.dot(&heading);
        Vector4::new(speed * heading.x, speed * heading.y, s[3], -speed * (p.y * heading.x - p.x * heading.y))
    };
    let end = (0..STEPS).fold(Vector4::new(0.0, 0.0, 0.0, turn), |s, _| {
        let first = rate(s);
        let second = rate(s + first * (h / 2.0));
        let third = rate(s + second * (h / 2.0));
        let fourth = rate(s + third * h);
        s + (first + second * 2.0 + third * 2.0 + fourth) * (h / 6.0)
    });
    place(end[2], end[0], end[1])
}

/// From standing still, where it drives along its axis and turns, and no first derivative leads to the side. Also from
/// next to there, and turned around. The mirror image of a problem has the same least price.
///
/// Inputs that are constant in each step are inputs in continuous time too, so no plan is cheaper than the best motion there. Costates are
/// those of the cheapest of the motions that reach the target. Newton's method found these motions from 4500 random costates for each target.
#[test]
fn a_unicycle_moves_sideways() {
    let start = Matrix3::identity();
    let solve = |target: Matrix3<f64>| {
        let control = free_unicycle().control(0.02).expect("regular");
        let mut plan = [control.stage(&start); 50];
        let found = control.solve(&start, Target::Place(target), &mut plan);
        let found = found.unwrap_or_else(|error| panic!("{target}: {error}"));
        assert!(found.gap() < 1e-11 && found.is_minimum(), "{found:?}");
        (found.price(), found.iterations())
    };
    let mut census = Census::default();
    // the target, and the costate at the start
    for ((angle, x, y), [px, py, turn]) in [
        ((0.0, 0.0, 1.0), [-2.98772940, 4.98670396, 1.49386470]),
        ((0.0, 0.0, 0.1), [-1.11287768, 6.13260242, 0.05564388]),
        ((0.0, 0.0, 0.01), [0.35427463, 6.26817667, -0.00177137]),
        ((1e-3, 1e-3, 1.0), [-2.98751998, 4.98410783, 1.49127890]),
        ((0.05, 1e-4, 1.5), [-3.24349351, 4.61656629, 2.28200661]),
        ((2e-4, 5e-3, 0.16), [-1.39415522, 6.02082645, 0.11995608]),
        ((PI - 1e-14, 0.0, 1.0), [0.0, 1.91178576, -3.43852940]),
    ]
    .into_iter()
    .take(few(7))
    {
        let target = place(angle, x, y);
        let missed = (extremal(Vector2::new(px, py), turn) - target).amax();
        assert!(missed < 1e-6, "{angle} {x} {y}: the motion ends {missed:.1e} off");
        let least = (px * px + turn * turn) / 2.0;
        let ((price, taken), (mirrored, others)) = (solve(target), solve(place(-angle, x, -y)));
        assert!((price - mirrored).abs() < 1e-9 * price, "{angle} {x} {y}: {price} and {mirrored}");
        assert!(price > least * (1.0 - 1e-6) && price < least * 1.004, "{angle} {x} {y}: {price}, not {least}");
        census.count(taken.max(others));
    }
    assert!(census.most < 700, "{census:?}");
}

/// To a free end that is priced, straight ahead is a saddle where the goal is to the side: it is left for the minimum.
#[test]
fn a_saddle_is_left() -> Result<(), Error> {
    let start = Matrix3::identity();
    let control = FreeUnicycle { miss_price: 20.0, goal: Vector2::new(0.0, 1.0) }.control(0.02)?;
    let mut plan = [control.stage(&start); 50];
    let found = control.solve(&start, Target::Free, &mut plan)?;
    // standing still, the saddle, costs 20·1²/2
    assert!(found.is_minimum() && found.price() < 10.0 / 2.0, "{found:?}");
    // where the miss is cheap, standing still is the minimum: turning towards the goal pays only once it saves more than it costs
    let control = FreeUnicycle { miss_price: 2.0, goal: Vector2::new(0.0, 0.1) }.control(0.02)?;
    let mut plan = [control.stage(&start); 50];
    let found = control.solve(&start, Target::Free, &mut plan)?;
    assert!(found.is_minimum() && (found.price() - 0.01).abs() < 1e-15, "{found:?}");
    Ok(())
}

/// Behind and to the side, without reverse gear and from standing still: closing the gap at once would be to drive back.
#[test]
fn a_unicycle_turns_back_without_reverse_gear() -> Result<(), Error> {
    let start = Matrix3::identity();
    let system = Unicycle { top_turn: 7.0, ..unicycle() };
    let mut census = Census::default();
    let targets = [place(PI, -1.0, 0.5), place(-2.05, -0.85, -1.15), place(3.0, -0.01, -0.6), place(0.99, -1.5, 0.65)];
    for target in targets.into_iter().take(few(4)) {
        let control = system.clone().control(0.02)?;
        let mut plan = [control.stage(&start); 50];
        let found = control.solve(&start, Target::Place(target), &mut plan)?;
        assert!(found.gap() < 1e-11 && found.is_minimum(), "{found:?}");
        first_order(&system, 0.02, &start, &target, &found, 1e-10)?;
        census.count(found.iterations());
    }
    assert!(census.most < 400, "{census:?}");
    Ok(())
}

/// From rest to rest, at any attitude.
#[test]
fn a_body_is_steered_to_any_attitude() {
    let mut random = Random::new(12);
    let mut census = Census::default();
    let system = SteeredBody { inertia: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)), damping: 0.0, top: 20.0 };
    let control = system.control(0.02).expect("regular");
    let start = (Matrix3::identity(), Vector3::zeros());
    for k in 0..few(60) {
        let turn = if k == 0 { Vector3::new(0.6, 1.3, 2.0) } else { random.unit::<3>() * random.between(0.1, 2.9) };
        let target = (*nalgebra::Rotation3::from_scaled_axis(turn).matrix(), Vector3::zeros());
        let mut plan = vec![control.stage(&start); 50];
        let found = control.solve(&start, Target::Place(target), &mut plan);
        let found = found.unwrap_or_else(|error| panic!("{k}: {error}"));
        census.count(found.iterations());
        assert!(found.gap() < 1e-11 && found.is_minimum(), "{k}: {found:?}");
    }
    assert!(census.sum < 20 * few(60) as u32 && census.most < 50, "{census:?}");
}
