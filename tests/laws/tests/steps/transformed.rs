//! Steps whose time follows a monitor: Kepler's problem has a closed form, and the logarithmic Hamiltonian a step that is
//! written by hand. Other motions are those of steps of one size.

use clebsch::{Clebsch, Crossing, Error, F64x4, Scalar};
use clebsch_tests::oracle::near::assert_near;
use nalgebra::{Matrix3, Vector2, Vector3};
use num_traits::One;
use std::f64::consts::{PI, TAU};

struct Second;
struct Fourth;
struct Eighth;
struct Compensated;

/// A planet about a star.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, q: Vector2| q + a,
    lagrangian = |v| self.mass * v.norm_squared() / 2,
    potential  = |q| -self.strength / q.norm(),
    symmetry   = |S: SO<2>, q, a| (S * q, S * a),
    step       = |q| q.norm(),
    order      = 6,
    method Second      = (order = 2),
    method Fourth      = (order = 4),
    method Eighth      = (order = 8),
    method Compensated = (order = 8, summation = compensated),
)]
struct Planet<T: Scalar> {
    mass: T,
    strength: T,
}

const PLANET: Planet<f64> = Planet { mass: 2.0, strength: 2.0 };

/// The place at the time t on the ellipse with the great half axis 1, from its nearest point.
/// Kepler's equation is solved by bisection and Newton's method.
fn on_ellipse(eccentricity: f64, t: f64) -> Vector2<f64> {
    let anomaly = (t + PI).rem_euclid(TAU) - PI;
    let residual = |u: f64| u - eccentricity * u.sin() - anomaly;
    let (mut low, mut high) = (-PI, PI);
    for _ in 0..30 {
        let middle = f64::midpoint(low, high);
        if residual(middle) < 0.0 { low = middle } else { high = middle }
    }
    let mut u = f64::midpoint(low, high);
    for _ in 0..3 {
        u -= residual(u) / (1.0 - eccentricity * u.cos());
    }
    Vector2::new(u.cos() - eccentricity, (1.0 - eccentricity.powi(2)).sqrt() * u.sin())
}

/// (q, N) at the nearest point.
fn nearest(eccentricity: f64) -> (Vector2<f64>, Vector2<f64>) {
    let speed = ((1.0 + eccentricity) / (1.0 - eccentricity)).sqrt();
    (Vector2::new(1.0 - eccentricity, 0.0), Vector2::new(0.0, 2.0 * speed))
}

/// The largest error of places in an orbit of so many steps.
fn error_of_orbit<M: clebsch::Method<Planet<f64>>>(eccentricity: f64, steps: u32) -> f64
where
    Planet<f64>:
        Clebsch<Scalar = f64, Configuration = Vector2<f64>, Momentum = Vector2<f64>, Time = clebsch::Clock<f64>>,
{
    // an orbit takes 2π of s for the great half axis 1 and the frequency 1
    let stepper = PLANET.into_stepper_by::<M>(TAU / f64::from(steps)).expect("a stepper");
    let (q, mu) = nearest(eccentricity);
    let start = stepper.state(q, mu).expect("a state");
    let states = stepper.trajectory(start).take(steps as usize + 1).map(|state| state.expect("a step"));
    states.map(|state| (state.configuration() - on_ellipse(eccentricity, state.time())).norm()).fold(0.0, f64::max)
}

/// The errors of two sizes of steps, the second half of the first, show the order.
fn check_order<M: clebsch::Method<Planet<f64>>>(steps: u32, order: f64, eccentricities: &[f64]) {
    for &eccentricity in eccentricities {
        let [one, half] = [steps, 2 * steps].map(|steps| error_of_orbit::<M>(eccentricity, steps));
        let found = (one / half).log2();
        assert!((found - order).abs() < 0.1, "e = {eccentricity}: {found:.3} for {order}, {one:.1e} and {half:.1e}");
    }
}

#[test]
fn orders_are_those_that_are_declared() {
    check_order::<Second>(256, 2.0, &[0.5, 0.9, 0.99]);
    check_order::<Fourth>(64, 4.0, &[0.5, 0.9, 0.99]);
    check_order::<clebsch::Declared>(32, 6.0, &[0.5, 0.9, 0.99]);
    // nearer ones are not at the order yet where rounding begins
    check_order::<Eighth>(16, 8.0, &[0.5, 0.9]);
}

/// With the monitor |q| places lie on the exact ellipse, energy and momenta are at round-off: for long steps and close approaches too.
#[test]
fn orbits_of_keplers_problem_are_exact_but_for_the_time() -> Result<(), Error> {
    for eccentricity in [0.3, 0.9, 0.999] {
        let stepper = PLANET.into_stepper(0.7)?;
        let (q, mu) = nearest(eccentricity);
        let start = stepper.state(q, mu)?;
        let momentum = stepper.conserved(&start);
        let rounding = 1e-12 / (1.0 - eccentricity);
        for state in stepper.trajectory(start).take(2000) {
            let state = state?;
            let q = state.configuration();
            // r = 1 − e² − e x on the ellipse
            let off = q.norm() - (1.0 - eccentricity.powi(2) - eccentricity * q.x);
            assert!(off.abs() < rounding, "{eccentricity}: off the ellipse by {off:.1e} at {}", state.time());
            let energy = stepper.energy(&state) + 1.0;
            assert!(energy.abs() < rounding, "{eccentricity}: the energy is off by {energy:.1e}");
            let moved = stepper.conserved(&state).values()[0] - momentum.values()[0];
            assert!(moved.abs() < 1e-13, "{eccentricity}: the angular momentum has moved by {moved:.1e}");
        }
    }
    Ok(())
}

/// A fixed centre and another, and the monitor of their logarithmic Hamiltonian.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, q: Vector2| q + a,
    lagrangian = |v| self.mass * v.norm_squared() / 2,
    potential  = |q| -1 / (q - self.one).norm() - 1 / (q - self.other).norm(),
    step       = |q| 1 / (1 / (q - self.one).norm() + 1 / (q - self.other).norm()),
)]
struct TwoCentres {
    mass: f64,
    one: Vector2<f64>,
    other: Vector2<f64>,
}

/// With g = −1/V the step is that of ln(T + B) − ln(−V), B = −E at the start.
#[test]
fn a_monitor_of_the_potential_gives_the_logarithmic_hamiltonian() -> Result<(), Error> {
    let (mass, h) = (1.3, 0.1);
    let centres = [Vector2::new(1.0, 0.0), Vector2::new(-1.0, 0.2)];
    let stepper = TwoCentres { mass, one: centres[0], other: centres[1] }.into_stepper(h)?;
    assert!(TwoCentres::DERIVATION.contains("logarithmic Hamiltonian"));
    let (mut q, mut p, mut t) = (Vector2::new(0.3, 0.4), Vector2::new(0.5, -0.9), 0.0);
    let mut state = stepper.state(q, p)?;
    let attraction = |q: &Vector2<f64>| centres.iter().map(|centre| 1.0 / (q - centre).norm()).sum::<f64>();
    let force = |q: &Vector2<f64>| -> Vector2<f64> {
        centres.iter().map(|centre| (centre - q) / (q - centre).norm().powi(3)).sum()
    };
    let kinetic = |p: &Vector2<f64>| p.norm_squared() / (2.0 * mass);
    let b = attraction(&q) - kinetic(&p);
    for _ in 0..100 {
        state = stepper.step(&state)?;
        for is_first in [true, false] {
            let time = h / 2.0 / (kinetic(&p) + b);
            (q, t) = (q + p / mass * time, t + time);
            if is_first {
                p += force(&q) * (h / attraction(&q));
            }
        }
        assert_near(state.configuration(), &q, 1e-11, "the place");
        assert_near(&state.momentum(), &p, 1e-11, "the momentum");
        assert!((state.time() - t).abs() < 1e-11);
    }
    Ok(())
}

/// A body that a magnet near it attracts, and whose time follows the gap. This is no logarithmic Hamiltonian. The time changes the potential.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |t, R| -self.strength * (1 + (self.rate * t).sin() / 4) / (self.magnet - R * self.tip).norm(),
    step       = |R| (self.magnet - R * self.tip).norm_squared(),
    order      = 4,
    method Second = (order = 2, discretization = moser_veselov),
    method Eighth = (order = 8, discretization = exact),
)]
struct Swinging {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    strength: f64,
    rate: f64,
    magnet: Vector3<f64>,
    tip: Vector3<f64>,
}

/// The same in steps of one size.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |t, R| -self.strength * (1 + (self.rate * t).sin() / 4) / (self.magnet - R * self.tip).norm(),
    order      = 16,
)]
struct SwingingEvenly {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
    strength: f64,
    rate: f64,
    magnet: Vector3<f64>,
    tip: Vector3<f64>,
}

const INERTIA: Matrix3<f64> = Matrix3::new(1.1, 0.1, -0.2, 0.1, 1.9, 0.05, -0.2, 0.05, 2.4);

fn swinging() -> Swinging {
    let (magnet, tip) = (Vector3::new(0.0, 0.0, 1.2), Vector3::new(0.0, 0.6, 0.8));
    Swinging { inertia: INERTIA, strength: 1.5, rate: 0.7, magnet, tip }
}

/// States at given times are those of the motion, of the order that is declared, whatever sets the times of steps.
#[test]
fn any_monitor_gives_the_same_motion() -> Result<(), Error> {
    let Swinging { inertia, strength, rate, magnet, tip } = swinging();
    let evenly = SwingingEvenly { inertia, strength, rate, magnet, tip }.into_stepper(0.01)?;
    let mu = Vector3::new(0.4, -0.3, 0.6);
    let times = [0.7, 1.234, 1.235, 3.0];
    let expected: Vec<_> =
        evenly.trajectory(evenly.state(Matrix3::identity(), mu)?).at(times).collect::<Result<_, _>>()?;
    fn errors<M: clebsch::Method<Swinging>>(
        h: f64,
        mu: Vector3<f64>,
        times: &[f64],
        expected: &[clebsch::State<SwingingEvenly>],
    ) -> Result<f64, Error> {
        let stepper = swinging().into_stepper_by::<M>(h)?;
        let start = stepper.state(Matrix3::identity(), mu)?;
        let mut largest: f64 = 0.0;
        for ((time, state), expected) in times.iter().zip(stepper.trajectory(start).at(times)).zip(expected) {
            let state = state?;
            assert!((state.time() - time).abs() < 1e-14, "the time is {} for {time}", state.time());
            largest = largest.max((state.configuration() - expected.configuration()).norm());
            largest = largest.max((state.momentum() - expected.momentum()).norm());
        }
        Ok(largest)
    }
    let found = |order: f64, [one, half]: [f64; 2]| {
        let found = (one / half).log2();
        assert!((found - order).abs() < 0.25, "{found:.2} for {order}: {one:.1e} and {half:.1e}");
    };
    found(2.0, [errors::<Second>(0.02, mu, &times, &expected)?, errors::<Second>(0.01, mu, &times, &expected)?]);
    let fourth = |h| errors::<clebsch::Declared>(h, mu, &times, &expected);
    found(4.0, [fourth(0.08)?, fourth(0.04)?]);
    let eighth = errors::<Eighth>(0.05, mu, &times, &expected)?;
    assert!(eighth < 1e-9, "{eighth:.1e}");
    Ok(())
}

/// Steps take the time h g at the mean of both ends, and go on doing so: W follows 1/g on a group.
#[test]
fn times_of_steps_follow_the_monitor() -> Result<(), Error> {
    let system = swinging();
    let gap = |state: &clebsch::State<Swinging>| (system.magnet - state.configuration() * system.tip).norm_squared();
    let stepper = swinging().into_stepper(0.01)?;
    let mut state = stepper.state(Matrix3::identity(), Vector3::new(0.4, -0.3, 0.6))?;
    let [mut least, mut largest] = [f64::INFINITY, 0.0_f64];
    for _ in 0..2000 {
        let next = stepper.step(&state)?;
        let mean = (gap(&state) + gap(&next)) / 2.0;
        let took = (next.time() - state.time()) / 0.01;
        assert!((took / mean - 1.0).abs() < 2e-3, "{took} for {mean} at {}", state.time());
        (least, largest) = (least.min(mean), largest.max(mean));
        state = next;
    }
    assert!(largest > 4.0 * least, "from {least} to {largest}");
    Ok(())
}

/// A state that is set elsewhere has the W of its place.
#[test]
fn places_that_are_set_begin_anew() -> Result<(), Error> {
    let stepper = PLANET.into_stepper_by::<Fourth>(0.05)?;
    let (q, mu) = nearest(0.99);
    let moved = stepper.with_configuration(&stepper.state(q, mu)?, q * 0.51)?;
    let fresh = stepper.state(q * 0.51, mu)?;
    assert_eq!(stepper.advance(&moved, 200)?, stepper.advance(&fresh, 200)?);
    let refused = Negative { offset: 1.0 }.into_stepper(0.1)?;
    let state = refused.state([0.5].into(), [0.0].into())?;
    assert_eq!(
        refused.with_configuration(&state, [-1.2].into()).err().map(|error| matches!(error, Error::Monitor { .. })),
        Some(true)
    );
    Ok(())
}

/// Times are found in steps of any length and unit, and a time that is never reached is an error.
#[test]
fn times_are_found_in_steps_of_any_unit() -> Result<(), Error> {
    for eccentricity in [0.9, 0.999, 0.99999] {
        let stepper = PLANET.into_stepper_by::<Eighth>(0.7)?;
        let (q, mu) = nearest(eccentricity);
        let start = stepper.state(q, mu)?;
        for (number, state) in stepper.trajectory(start).every(0.01).take(700).enumerate() {
            let (state, time) = (state?, 0.01 * number as f64);
            assert!((state.time() - time).abs() < 1e-13, "{eccentricity}: {} for {time}", state.time());
        }
    }
    // an atom in SI units: h is far larger than any time
    let (radius, mass, strength) = (5.3e-11_f64, 9.1e-31_f64, 2.3e-28_f64);
    let period = TAU * (mass * radius.powi(3) / strength).sqrt();
    let stepper = Atom { mass, strength }.into_stepper(271.0)?;
    let start = stepper.state(Vector2::new(radius, 0.0), Vector2::new(0.0, (mass * strength / radius).sqrt()))?;
    let quarters = [0.25, 0.5, 0.75, 1.0];
    for (part, state) in quarters.iter().zip(stepper.trajectory(start).at(quarters.map(|part| part * period))) {
        let angle = TAU * part;
        let expected = Vector2::new(angle.cos(), angle.sin());
        assert_near(&(state?.configuration() / radius), &expected, 1e-3, "the place");
    }
    let stepper = Negative { offset: 1.0 }.into_stepper(0.1)?;
    let late = stepper.trajectory(stepper.state([0.5].into(), [-3.0].into())?).at([2.0]).next();
    assert_eq!(late.map(|late| late.err()), Some(Some(Error::Monitor { value: 0.0 })));
    Ok(())
}

/// An electron about a nucleus, in steps that follow the square of the distance.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, q: Vector2| q + a,
    lagrangian = |v| self.mass * v.norm_squared() / 2,
    potential  = |q| -self.strength / q.norm(),
    step       = |q| q.norm_squared(),
    order      = 4,
)]
struct Atom {
    mass: f64,
    strength: f64,
}

/// A body of an ensemble that fails can be set anew, at the time at which it failed.
#[test]
fn bodies_that_fail_can_be_set_anew() -> Result<(), Error> {
    let stepper = Negative { offset: F64x4::one() }.into_stepper(F64x4::from(1.0))?;
    let start = |x: f64, v: f64| ([x].into(), [v].into());
    let bodies = [start(0.5, 0.1), start(-0.9, 3.0), start(0.2, 0.0), start(0.1, 0.0)];
    let mut ensemble = stepper.ensemble(bodies).expect("four bodies");
    ensemble.advance(3);
    let failures: Vec<_> = ensemble.failures().collect();
    let [failure] = failures.as_slice() else { panic!("body 1 alone fails: {failures:?}") };
    assert!(failure.body == 1 && matches!(failure.error, Error::Monitor { .. }), "{failure:?}");
    assert_eq!(ensemble.time(1), Some(0.0), "it fails in its first step");
    ensemble.set_body(1, start(0.4, 0.0))?;
    ensemble.advance(3);
    assert_eq!(ensemble.failures().count(), 0);
    assert!((0..4).all(|body| ensemble.time(body).is_some_and(f64::is_finite)));
    Ok(())
}

/// Steps back lead to the start, through close approaches.
#[test]
fn steps_are_reversible() -> Result<(), Error> {
    let there = swinging().into_stepper(0.05)?;
    let start = there.state_at(0.3, Matrix3::identity(), Vector3::new(0.4, -0.3, 0.6))?;
    let end = there.advance(&start, 200)?;
    let back = there.with_step_size(-0.05)?.advance(&end, 200)?;
    assert_near(back.configuration(), start.configuration(), 1e-11, "the attitude");
    assert_near(&back.momentum(), &start.momentum(), 1e-11, "the momentum");
    assert!((back.time() - 0.3).abs() < 1e-11, "{}", back.time());
    Ok(())
}

/// `advance` is step after step, to the last bit, and so are states that are read back. A W that a file has wrong is made anew.
#[test]
fn many_steps_are_steps() -> Result<(), Error> {
    let stepper = swinging().into_stepper(0.05)?;
    let start = stepper.state(Matrix3::identity(), Vector3::new(0.4, -0.3, 0.6))?;
    let mut state = start;
    for _ in 0..37 {
        state = stepper.step(&state)?;
    }
    let advanced = stepper.advance(&start, 37)?;
    assert_eq!((advanced, advanced.time()), (state, state.time()));
    let next = stepper.step(&state)?;
    assert_eq!(stepper.step(&advanced)?, next);
    let mut written = serde_json::to_value(state).expect("numbers");
    let resumed = |written| stepper.resume(serde_json::from_value(written).expect("numbers"));
    let after = stepper.step(&resumed(written.clone())?)?;
    assert_eq!((after, after.time()), (next, next.time()));
    written["impulse"][0] = serde_json::json!(written["impulse"][0].as_f64().expect("W") * 1.2);
    let anew = stepper.state_at(state.time(), *state.configuration(), state.momentum())?;
    // but for the rounding of the time so far; a W that is a fifth off changes the time of the step by as much
    let apart = stepper.step(&resumed(written)?)?.time() - stepper.step(&anew)?.time();
    assert!(apart.abs() <= f64::EPSILON, "{apart:.1e}");
    Ok(())
}

/// The farthest point is reached half a period after the nearest, whatever the steps.
#[test]
fn events_have_the_time_of_their_states() -> Result<(), Error> {
    let stepper = PLANET.into_stepper_by::<Eighth>(0.2)?;
    let (q, mu) = nearest(0.9);
    let start = stepper.state(q, mu)?;
    let approach =
        |state: &clebsch::State<Planet<f64>, Eighth>| [Crossing::Either(state.configuration().dot(&state.momentum()))];
    let times: Vec<f64> = stepper
        .trajectory(stepper.step(&start)?)
        .events(60, approach)
        .map(|event| {
            event.map(|event| {
                assert_eq!(event.time, event.state.time());
                event.time
            })
        })
        .collect::<Result<_, _>>()?;
    for (number, time) in times.iter().enumerate() {
        assert!((time - PI * (number + 1) as f64).abs() < 1e-8, "{time} for {}π", number + 1);
    }
    assert!(times.len() >= 3);
    Ok(())
}

/// A body in a lane has the bits that it has alone; each has a time of its own.
#[test]
fn lanes_have_their_own_times() -> Result<(), Error> {
    let strengths = [2.0, 1.0, 3.0, 0.5];
    let lanes =
        Planet { mass: F64x4::one() + F64x4::one(), strength: strengths.into() }.into_stepper(F64x4::from(0.1))?;
    let (q, mu) = nearest(0.8);
    let start = lanes.state(q.map(F64x4::from), mu.map(F64x4::from))?;
    let end = lanes.advance(&start, 50)?;
    for (lane, strength) in strengths.into_iter().enumerate() {
        let alone = Planet { mass: 2.0, strength }.into_stepper(0.1)?;
        let expected = alone.advance(&alone.state(q, mu)?, 50)?;
        assert_eq!(end.lane(lane), (*expected.configuration(), expected.momentum()));
        assert_eq!(end.time().lane(lane), expected.time());
    }
    Ok(())
}

/// Compensated sums keep the ellipse ten times nearer.
#[test]
fn sums_may_be_compensated() -> Result<(), Error> {
    fn energy_error<M: clebsch::Method<Planet<f64>>>() -> Result<f64, Error> {
        let stepper = PLANET.into_stepper_by::<M>(0.3)?;
        let (q, mu) = nearest(0.9);
        let end = stepper.advance(&stepper.state(q, mu)?, 20_000)?;
        Ok((stepper.energy(&end) + 1.0).abs())
    }
    let [plain, compensated] = [energy_error::<Eighth>()?, energy_error::<Compensated>()?];
    assert!(compensated < 1e-13 && compensated < plain, "{plain:.1e}, {compensated:.1e}");
    Ok(())
}

/// A monitor that may be negative.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<1>, x: Vector1| x + a,
    lagrangian = |v| v.norm_squared() / 2,
    potential  = |x| x.x * x.x / 2,
    step       = |x| self.offset + x.x,
)]
struct Negative<T: Scalar> {
    offset: T,
}

#[test]
fn a_monitor_that_is_not_positive_is_an_error() -> Result<(), Error> {
    let stepper = Negative { offset: 1.0 }.into_stepper(0.1)?;
    let at = |x: f64, v: f64| stepper.state([x].into(), [v].into());
    assert_eq!(at(-1.5, 0.0).err(), Some(Error::Monitor { value: -0.5 }));
    assert_eq!(at(-1.0, 0.0).err(), Some(Error::Monitor { value: 0.0 }));
    // it moves towards the place where the monitor is zero, which takes for ever
    let mut state = at(0.5, -3.0)?;
    for _ in 0..1000 {
        state = stepper.step(&state)?;
    }
    assert!(state.configuration().x > -1.0 && state.time() < 1.0);
    // W = 10, g = ¼ after the first half, and ġ = 3.1
    let long = stepper.with_step_size(1.0)?;
    let failed = long.step(&long.state([-0.9].into(), [3.0].into())?);
    assert!(matches!(failed, Err(Error::Monitor { value }) if value < 0.0), "{failed:?}");
    Ok(())
}
