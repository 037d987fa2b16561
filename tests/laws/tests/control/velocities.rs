//! Prices and bounds of the velocity of a step, and prices of the velocity at the end.

use super::derivatives::{Chart, chart_of_bodies, check};
use super::long;
use clebsch::{Clebsch, Control, Controlled, Target};
use clebsch_tests::fixtures::rate_limited_body::RateLimitedBody;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, SVector, Vector1, Vector2, Vector3, vector};

/// A body with the exponential, where bounds alone take the velocity, under a name of their own.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = exponential,
    force          = |torque: Vector3| torque,
    effort         = |h, torque| h * torque.norm_squared() / 2,
    bounds         = |R, w, torque| [(R * w).x <= self.top, torque.y <= self.top],
)]
struct Wheeled {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    top: f64,
}

/// Two masses in curved coordinates: the inertia moves, a magnetic term shifts the momentum.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |d: Translation<2>, x: Vector2| x + d,
    lagrangian = |x, v| (2 + x.y.cos()) * v.x * v.x / 2 + self.coupling * x.x.sin() * v.x * v.y + v.y * v.y / 2 + self.charge * x.y * v.x,
    force      = |v, u: Vector1| vector![u.x - v.x / 4, 0],
    effort     = |h, x, v, u| h * (u.x * u.x + x.x * v.y * v.y * v.y) / 2,
    endpoint   = |x, v| (v - x).norm_squared() / 2 + v.x * v.y * x.y,
)]
struct Curved {
    coupling: f64,
    charge: f64,
}

/// A spherical pendulum that is turned: momenta are those of motions that leave q as it is, too.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost     = |h, q, F| self.mass * (F * q - q).norm_squared() / (2 * h),
    potential = |q| self.mass * q.z,
    force    = |w, u: Vector3| u - w / 10,
    effort   = |h, w, u| h * (u.norm_squared() + w.norm_squared() * w.x) / 2,
    endpoint = |q, w| q.z * w.norm_squared(),
)]
struct Turned {
    mass: f64,
}

fn satellite(random: &mut Random) -> RateLimitedBody {
    let inertia = random.inertia::<3>();
    let wanted = Vector3::new(0.1, -0.2, 0.3);
    RateLimitedBody { inertia, damping: 0.4, pull: 0.3, rate_price: 0.8, wanted, top: 0.7, power: 0.2, miss_price: 2.0 }
}

#[test]
fn derivatives_of_a_body_are_differences() {
    let random = &mut Random::new(504);
    for _ in 0..long(4) {
        let x = (random.attitude::<3>(), random.vector::<3>());
        check::<_, 6, 3, 2>(&satellite(random), &chart_of_bodies(), &x, random);
        let wheeled = Wheeled { inertia: random.inertia::<3>(), top: 0.7 };
        check::<_, 6, 3, 2>(&wheeled, &chart_of_bodies(), &x, random);
    }
}

#[test]
fn derivatives_with_a_moving_inertia_are_differences() {
    let random = &mut Random::new(505);
    let chart = Chart::<(Vector2<f64>, Vector2<f64>), 4> {
        moved: |(q, n), delta| (q + delta.fixed_rows::<2>(0), n + delta.fixed_rows::<2>(2)),
        coordinates: |(q, n), (p, m)| SVector::from_iterator((p - q).iter().chain((m - n).iter()).copied()),
    };
    for _ in 0..4 {
        let system = Curved { coupling: 0.3, charge: 0.7 };
        check::<_, 4, 1, 0>(&system, &chart, &(random.vector::<2>(), random.vector::<2>()), random);
    }
}

/// The velocity of the step is that which moves it, and the price is that of this velocity.
#[test]
fn the_velocity_is_that_of_the_step() -> Result<(), clebsch::Error> {
    let random = &mut Random::new(506);
    let (h, t) = (0.1, 0.3);
    for _ in 0..5 {
        let system = satellite(random);
        let constants = system.prepare(h)?;
        let (x, u) = ((random.attitude::<3>(), random.vector::<3>()), random.vector::<3>());
        let (next, momentum) = system.follow(&constants, t, &x, &u)?;
        let turn = x.0.transpose() * next;
        // 2 tan(θ/2)/h about the axis
        let omega = Vector3::new(turn[(2, 1)] - turn[(1, 2)], turn[(0, 2)] - turn[(2, 0)], turn[(1, 0)] - turn[(0, 1)])
            * (2.0 / (h * (1.0 + turn.trace())));
        let price = h * (u.norm_squared() + system.rate_price * (x.0 * omega - system.wanted).norm_squared()) / 2.0;
        assert!((system.price(&constants, t, &x, &u)? - price).abs() < 1e-13);
        let bounds = system.bounds(&constants, t, &x, &u)?;
        let expected = vector![omega.norm_squared() - 0.49, u.dot(&omega) - 0.2 * (1.0 + t)];
        assert!((bounds - expected).amax() < 1e-13, "{bounds} is not {expected}");
        // at the end that of the momentum
        let end = (next - Matrix3::identity()).norm_squared() + t * momentum.norm_squared(); // Jω = N
        assert!((system.endpoint(&constants, t, &(next, momentum)) - system.miss_price * end / 2.0).abs() < 1e-13);
    }
    Ok(())
}

/// Σℓ + φ and Σ z·a of a plan from given inputs, rolled out step by step.
fn lagrangian(
    control: &Control<RateLimitedBody, 6, 3, 2>,
    start: &State,
    inputs: &[(Vector3<f64>, Vector2<f64>)],
) -> f64 {
    let (system, h) = (control.system(), control.step_size());
    let constants = system.prepare(h).expect("regular");
    let (mut x, mut sum) = (*start, 0.0);
    for (k, (u, z)) in inputs.iter().enumerate() {
        let t = h * k as f64;
        sum += system.price(&constants, t, &x, u).expect("a step");
        sum += z.dot(&system.bounds(&constants, t, &x, u).expect("a step"));
        x = system.follow(&constants, t, &x, u).expect("a step");
    }
    sum + system.endpoint(&constants, h * inputs.len() as f64, &x)
}

type State = (Matrix3<f64>, Vector3<f64>);

/// At a solution no input changes Σℓ + φ + Σ z·a, and of z and a one is zero. These conditions of Karush, Kuhn and
/// Tucker are checked by differences of roll-outs.
#[test]
fn a_slew_with_limited_rates_is_optimal() -> Result<(), clebsch::Error> {
    let random = &mut Random::new(507);
    let mut limited = 0;
    for _ in 0..4 {
        // ten steps are enough without the feature `heavy`
        if limited > 10 && !cfg!(feature = "heavy") {
            break;
        }
        let control = satellite(random).control(0.15)?;
        let start = (random.attitude::<3>(), Vector3::zeros());
        let mut plan = [control.stage(&start); 20];
        let found = control.solve(&start, Target::Free, &mut plan)?;
        assert!(found.is_minimum(), "{found:?}");
        let inputs: Vec<_> = found.stages().iter().map(|stage| (*stage.input(), *stage.multipliers())).collect();
        let constants = control.system().prepare(0.15)?;
        for (k, stage) in found.stages().iter().enumerate() {
            let bounds = control.system().bounds(&constants, 0.15 * k as f64, stage.place(), stage.input())?;
            assert!(bounds.max() < 1e-12, "step {k}: {bounds}");
            assert!(bounds.component_mul(stage.multipliers()).amax() < 1e-9, "step {k}: {bounds}");
            limited += usize::from(stage.multipliers().x > 1e-6);
        }
        for k in 0..inputs.len() {
            for i in 0..3 {
                let at = |change: f64| {
                    let mut inputs = inputs.clone();
                    inputs[k].0[i] += change;
                    lagrangian(&control, &start, &inputs)
                };
                let slope = (at(1e-4) - at(-1e-4)) / 2e-4;
                assert!(slope.abs() < 1e-6, "input {i} of step {k}: {slope:e}");
            }
        }
    }
    assert!(limited > 10, "the rate is limited in {limited} steps");
    Ok(())
}

/// A mass on a rail, from rest to rest at a limited speed.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |d: Translation<1>, x: Vector1| x + d,
    lagrangian = |v| v.norm_squared() / 2,
    force      = |u: Vector1| u,
    effort     = |h, u| h * (self.time_price + u.norm_squared() / 2),
    bounds     = |v, u| [v.x + self.lead * u.x <= self.top],
)]
struct Wagon {
    top: f64,
    lead: f64,
    time_price: f64,
}

/// The wagon speeds up by u = 2 v/τ (1 − s/τ) until τ = 3/2 (v T − d)/v. It goes on at the speed v, and stops the same
/// way.
/// The price is 4 v²/(3 τ) of the continuous wagon. That of N steps comes near as 1/N².
#[test]
fn a_limited_speed_has_its_price() -> Result<(), clebsch::Error> {
    let (top, distance, time): (f64, f64, f64) = (1.25, 1.0, 1.0);
    let tau = 1.5 * (top * time - distance) / top;
    let expected = 4.0 * top * top / (3.0 * tau);
    let error = |steps: usize| -> Result<f64, clebsch::Error> {
        let control = Wagon { top, lead: 0.0, time_price: 0.0 }.control(time / steps as f64)?;
        let start = (Vector1::zeros(), Vector1::zeros());
        let mut plan = vec![control.stage(&start); steps];
        let found = control.solve(&start, Target::Place((Vector1::new(distance), Vector1::zeros())), &mut plan)?;
        assert!(found.is_minimum());
        let speeds =
            found.stages().windows(2).map(|pair| (pair[1].place().0.x - pair[0].place().0.x) / control.step_size());
        let (fastest, limited) =
            speeds.fold((0.0_f64, 0), |(most, count), v| (most.max(v), count + usize::from(v > top - 1e-7)));
        assert!(fastest < top + 1e-12 && limited * 4 > steps, "{fastest}, {limited} of {steps}");
        Ok((found.price() - expected).abs() / expected)
    };
    let (coarse, fine) = (error(40)?, error(160)?);
    assert!(fine < 2e-3 && fine < coarse / 8.0, "{coarse:e}, {fine:e}");
    Ok(())
}

/// The best step size, where a bound depends on it: shorter and longer steps have the same least price, to first
/// order.
#[test]
fn the_best_duration_with_a_limited_speed() -> Result<(), clebsch::Error> {
    const STEPS: usize = 30;
    let wagon = Wagon { top: 0.7, lead: 0.2, time_price: 2.0 };
    let start = (Vector1::zeros(), Vector1::zeros());
    let target = Target::Place((Vector1::new(1.0), Vector1::zeros()));
    let control = wagon.clone().control(0.04)?;
    let mut plan = [control.stage(&start); STEPS];
    let best = control.solve_free_time(&start, target, 0.02..=0.2, &mut plan)?;
    let (h, limited) = (best.step_size(), best.stages().iter().filter(|stage| stage.multipliers().x > 1e-3).count());
    assert!(h > 0.03 && h < 0.15 && limited > 3, "{h}, {limited}");
    let price = |h: f64| -> Result<f64, clebsch::Error> {
        let control = wagon.clone().control(h)?;
        let mut plan = [control.stage(&start); STEPS];
        Ok(control.solve(&start, target, &mut plan)?.price())
    };
    let slope = (price(h * 1.001)? - price(h * 0.999)?) / (0.002 * h);
    assert!(slope.abs() < 1e-5 * STEPS as f64 * wagon.time_price, "{slope:e} at {h}");
    Ok(())
}

/// A soft end in place and velocity: the price of N forced steps is a quadratic form of the inputs, minimised by hand.
#[test]
fn a_soft_end_is_a_linear_problem() -> Result<(), clebsch::Error> {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |d: Translation<1>, x: Vector1| x + d,
        lagrangian = |v| self.mass * v.norm_squared() / 2,
        force      = |u: Vector1| u,
        effort     = |h, v, u| h * (u.norm_squared() + self.tracking * (v.x - 1) * (v.x - 1)) / 2,
        endpoint   = |x, v| (self.place_price * (x.x - 2) * (x.x - 2) + self.speed_price * v.x * v.x) / 2,
    )]
    struct Cart {
        mass: f64,
        tracking: f64,
        place_price: f64,
        speed_price: f64,
    }
    const N: usize = 10;
    let cart = Cart { mass: 1.5, tracking: 0.6, place_price: 3.0, speed_price: 5.0 };
    let (h, m) = (0.2, cart.mass);
    // x, v and the velocities of all steps are affine in the inputs: half of h u acts at each end
    let of = |inputs: &SVector<f64, N>| {
        let (mut x, mut p, mut price) = (0.3, 0.2, 0.0);
        for u in inputs.iter() {
            let v = (p + h * u / 2.0) / m;
            price += h * (u * u + cart.tracking * (v - 1.0) * (v - 1.0)) / 2.0;
            (x, p) = (x + h * v, p + h * u);
        }
        let (off, v) = (x - 2.0, p / m);
        price + (cart.place_price * off * off + cart.speed_price * v * v) / 2.0
    };
    // exact differences of a quadratic form
    let unit = |i: usize| SVector::<f64, N>::ith(i, 1.0);
    let hessian = nalgebra::SMatrix::<f64, N, N>::from_fn(|i, j| {
        of(&(unit(i) + unit(j))) - of(&unit(i)) - of(&unit(j)) + of(&SVector::zeros())
    });
    let slope = SVector::<f64, N>::from_fn(|i, _| of(&unit(i)) - of(&SVector::zeros()) - hessian[(i, i)] / 2.0);
    let best = -hessian.cholesky().expect("convex").solve(&slope);
    let control = cart.clone().control(h)?;
    let start = (Vector1::new(0.3), Vector1::new(0.2));
    let mut plan = [control.stage(&start); N];
    let found = control.solve(&start, Target::Free, &mut plan)?;
    assert!((found.price() - of(&best)).abs() < 1e-12, "{} is not {}", found.price(), of(&best));
    for (stage, u) in found.stages().iter().zip(best.iter()) {
        assert!((stage.input().x - u).abs() < 1e-10, "{} is not {u}", stage.input().x);
    }
    assert!(found.iterations() <= 3, "{found:?}");
    Ok(())
}

/// A sphere is moved by more turns than it has directions; its chart is that of the momenta of such.
#[test]
fn a_sphere_has_the_velocity_of_the_turn() -> Result<(), clebsch::Error> {
    let system = Turned { mass: 2.0 };
    let h = 0.1;
    let constants = system.prepare(h)?;
    let q = Vector3::new(0.6, 0.0, 0.8);
    let n = q.cross(&Vector3::new(0.3, 0.9, -0.2));
    // no part along q, where nothing moves
    let u = q.cross(&Vector3::new(0.5, -0.25, 1.0));
    let next = system.follow(&constants, 0.0, &(q, n), &u)?;
    let price = system.price(&constants, 0.0, &(q, n), &u)?;
    let speed = (next.0 - q).norm() / h;
    // |ω| of a turn without a part about q: the chord is 2 sin(θ/2), and |ω| h = 2 tan(θ/2)
    let half = (speed * h / 2.0).asin();
    let omega = q.cross(&next.0).normalize() * (2.0 * half.tan() / h);
    let expected = h * (u.norm_squared() + omega.norm_squared() * omega.x) / 2.0;
    assert!((price - expected).abs() < 1e-12, "{price} is not {expected}");
    Ok(())
}
