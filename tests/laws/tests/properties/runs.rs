//! Runs: events, and states at given times, against closed forms and independent motions.

use crate::arbitrary::{attitude, cases, vector};
use crate::bodies::{H, satellites, staggered_tops, tops};
use crate::runner::proptest;
use clebsch::{Clebsch, Crossing, Drive, Error, Event, Inputs, NoInputs, State, Stepper};
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::fixtures::watched_top::WatchedTop;
use clebsch_tests::oracle::motion::{motion, order};
use clebsch_tests::oracle::near::assert_near;
use nalgebra::{SVector, Vector2, Vector3};
use proptest::prelude::*;
use std::ops::ControlFlow;

/// A ball that falls, with a thruster, as steps of second order compute it exactly.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, x: Vector2| x + a,
    lagrangian = |v| self.mass * v.norm_squared() / 2,
    potential  = |x| self.mass * self.gravity * x.y,
    force      = |v, thrust: Vector2| thrust,
)]
pub struct Ball {
    /// Mass, kg.
    pub mass: f64,
    /// Gravity, m/s².
    pub gravity: f64,
}

/// A body of unit mass about a centre of unit attraction.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<2>, x: Vector2| x + a,
    lagrangian = |v| v.norm_squared() / 2,
    potential  = |x| -x.norm().recip(),
    method Fine = (order = 8),
    scalar     = f64,
)]
pub struct Orbit;

/// Steps of order 8.
pub struct Fine;

/// The period of an orbit with the half axis 1.
const PERIOD: f64 = 2.0 * std::f64::consts::PI;

/// (q, p) on the orbit of half axis 1, a time after the pericentre, by Kepler's equation.
fn kepler(e: f64, time: f64) -> (Vector2<f64>, Vector2<f64>) {
    let mut angle = time;
    for _ in 0..60 {
        angle -= (angle - e * angle.sin() - time) / (1.0 - e * angle.cos());
    }
    let (sine, cosine) = angle.sin_cos();
    let (b, rate) = ((1.0 - e * e).sqrt(), (1.0 - e * cosine).recip());
    (Vector2::new(cosine - e, b * sine), Vector2::new(-sine, b * cosine) * rate)
}

/// The floor from above, and the walls at x = 0 and x = `width` from inside.
fn room(state: &State<Ball>, width: f64) -> [Crossing<f64>; 3] {
    let x = state.configuration();
    [Crossing::Falling(x.y), Crossing::Falling(x.x), Crossing::Rising(x.x - width)]
}

/// The motion after the event at which the ball returns `part` of its velocity.
fn bounced(stepper: &Stepper<Ball>, event: &Event<Ball>, part: f64) -> Result<State<Ball>, Error> {
    let back = event.state.momentum() * -(1.0 + part);
    stepper.kick(&event.state, if event.number == 0 { Vector2::new(0.0, back.y) } else { Vector2::new(back.x, 0.0) })
}

/// The time at which an independent motion from (q, μ) reaches a plane: by secants.
fn reaches(pendulum: &SphericalPendulum, start: SVector<f64, 6>, plane: f64) -> f64 {
    let inertia = pendulum.mass * pendulum.length.powi(2);
    let weight = pendulum.mass * pendulum.gravity * pendulum.length;
    let velocity = |y: &SVector<f64, 6>| {
        let (q, mu) = (Vector3::new(y[0], y[1], y[2]), Vector3::new(y[3], y[4], y[5]));
        let (v, torque) = (mu.cross(&q) / inertia, -weight * q.cross(&Vector3::z()));
        SVector::from_column_slice(&[v.x, v.y, v.z, torque.x, torque.y, torque.z])
    };
    let beyond = |time: f64| motion(velocity, start, time, 200)[0] - plane;
    let (mut before, mut time) = (0.3, 0.4);
    for _ in 0..12 {
        let (a, b) = (beyond(before), beyond(time));
        if a == b {
            break;
        }
        (before, time) = (time, time - b * (time - before) / (b - a));
    }
    time
}

proptest! {
    #![proptest_config(cases(16))]

    /// A ball that bounces on a floor: every time is known, and so is that at which it comes to rest.
    #[test]
    fn bounces_have_their_times(mass in 0.5_f64..2.0, gravity in 5.0_f64..12.0, height in 0.5_f64..2.0, speed in -2.0_f64..2.0, part in 0.3_f64..0.8) {
        let stepper = Ball { mass, gravity }.into_stepper(0.013)?;
        let start = stepper.state(Vector2::new(0.0, height), Vector2::new(0.0, mass * speed))?;
        let mut bounces = stepper.trajectory(start).events(2000, |state| [Crossing::Falling(state.configuration().y)]);
        let impact = (speed * speed + 2.0 * gravity * height).sqrt();
        let (mut expected, mut flight, mut count) = ((speed + impact) / gravity, 2.0 * part * impact / gravity, 0);
        let rest = expected + flight / (1.0 - part);
        let error = loop {
            match bounces.next() {
                Some(Ok(event)) => {
                    count += 1;
                    prop_assert_eq!(event.number, 0);
                    prop_assert!((event.time - expected).abs() < 1e-12 * (1.0 + f64::from(count)), "{} for {expected}", event.time);
                    prop_assert!((0.0..1e-12).contains(&event.state.configuration().y), "above the floor");
                    prop_assert_eq!((bounces.time(), *bounces.state()), (event.time, event.state));
                    expected += flight;
                    flight *= part;
                    bounces.go_on_from(bounced(&stepper, &event, part)?);
                }
                Some(Err(error)) => break error,
                None => return Err(TestCaseError::fail("it bounces for ever")),
            }
        };
        prop_assert_eq!(error, Error::EventStays { event: 0 });
        prop_assert!((bounces.time() - rest).abs() < 1e-5, "{} at rest, not {rest}", bounces.time());
        prop_assert!(bounces.next().is_none());
        // after the error it goes on from another state, far up
        bounces.go_on_from(stepper.state(Vector2::new(0.0, 1e9), Vector2::zeros())?);
        prop_assert!(bounces.next().is_none());
        prop_assert_eq!(bounces.steps_left(), 0);
    }

    /// In a room without gravity the motion is a folded straight line, with an event at each fold. It may run into corners.
    #[test]
    fn walls_fold_straight_lines(x in 0.1_f64..1.9, y in 0.1_f64..2.0, v in vector::<2>(1.0), is_diagonal in any::<bool>()) {
        prop_assume!(v.amin() > 0.05);
        // into the corner at the origin
        let v = if is_diagonal { Vector2::new(-x, -y) } else { v };
        let stepper = Ball { mass: 1.0, gravity: 0.0 }.into_stepper(0.07)?;
        let mut events = stepper.trajectory(stepper.state(Vector2::new(x, y), v)?).events(100, |state| room(state, 2.0));
        let mut number_of_bounces = 0;
        while let Some(event) = events.next().transpose()? {
            number_of_bounces += 1;
            prop_assert!(number_of_bounces < 40);
            events.go_on_from(bounced(&stepper, &event, 1.0)?);
        }
        // each bounce takes a part of a step
        let line = Vector2::new(x, y) + v * events.time();
        let folded = (line.x.rem_euclid(4.0) - 2.0).abs();
        let expected = Vector2::new(2.0 - folded, line.y.abs());
        assert_near(events.state().configuration(), &expected, 1e-12, "the folded line");
    }

    /// Pericentres of a Kepler orbit, and crossings of its axis in both directions.
    #[test]
    fn orbits_have_their_apsides(e in 0.1_f64..0.4) {
        let stepper = Orbit.into_stepper_by::<Fine>(PERIOD / 211.3)?;
        let (q, p) = kepler(e, PERIOD / 2.0);
        let start = stepper.state(q, p)?;
        let events = stepper.trajectory(start).events(650, |state| {
            let (q, p) = (state.configuration(), state.momentum());
            [Crossing::Rising(q.dot(&p)), Crossing::Either(q.x)]
        });
        let times: Vec<_> = events.clone().map(|event| event.map(|event| (event.number, event.time))).collect::<Result<_, _>>()?;
        // x = 0 at cos E = e
        let aside = e.acos() - e * e.acos().sin();
        let in_turn = |k: i32| [(1, -aside), (0, 0.0), (1, aside)].map(|(number, time)| (number, time + PERIOD * (f64::from(k) + 0.5)));
        let expected: Vec<(usize, f64)> = (0..3).flat_map(in_turn).collect();
        prop_assert_eq!(times.len(), 9);
        for ((number, time), (kind, exact)) in times.iter().zip(expected) {
            prop_assert!(*number == kind && (time - exact).abs() < 1e-9, "{number} at {time}, not {kind} at {exact}");
        }
        // the steps are those without events, and each event conserves the momenta
        let mut events = events;
        let area = q.perp(&p);
        for event in events.by_ref() {
            let state = event?.state;
            prop_assert!((state.configuration().perp(&state.momentum()) - area).abs() < 1e-12);
        }
        prop_assert_eq!(Some(Ok(*events.state())), stepper.trajectory(start).nth(650));
    }

    /// A thrust that changes with each step: parabola after parabola, at any time and at the floor. The pilot is asked once for each step.
    #[test]
    fn inputs_stay_during_their_step(mass in 0.5_f64..2.0, gravity in 5.0_f64..12.0, thrust in vector::<2>(3.0), parts in vector::<3>(1.0)) {
        let h = 0.125;
        let stepper = Ball { mass, gravity }.into_stepper(h)?;
        let start = stepper.state(Vector2::new(0.0, 2.0), Vector2::new(mass, 0.0))?;
        prop_assert_eq!(NoInputs.input(&start), Vector2::zeros());
        let pull = |step: u32| Vector2::new(0.0, -gravity) + thrust * f64::from(step) / (8.0 * mass);
        let exact = |time: f64| {
            let (mut x, mut v, last) = (Vector2::new(0.0, 2.0), Vector2::new(1.0, 0.0), (time / h).floor() as u32);
            for step in 0..=last {
                let part = if step < last { h } else { time - h * f64::from(last) };
                x += part * v + part * part / 2.0 * pull(step);
                v += part * pull(step);
            }
            (x, v * mass)
        };
        let near = |state: &State<Ball>, time: f64| {
            let (x, momentum) = exact(time);
            assert_near(state.configuration(), &x, 1e-13, "the place");
            assert_near(&state.momentum(), &momentum, 1e-13, "the momentum");
        };
        let asked = std::cell::Cell::new(0_u32);
        let pilot = |_: &State<Ball>| {
            asked.set(asked.get() + 1);
            thrust * f64::from(asked.get() - 1) / 8.0
        };
        for (step, state) in stepper.trajectory(start).forced_by(pilot).take(5).enumerate() {
            near(&state?, h * step as f64);
        }
        prop_assert_eq!(asked.replace(0), 4);
        // three times in the second step, and one in the last
        let mut times: Vec<f64> = parts.iter().map(|part| h * (1.5 + 0.45 * part)).collect();
        times.sort_by(f64::total_cmp);
        times.push(4.5 * h);
        for (time, state) in times.iter().zip(stepper.trajectory(start).forced_by(pilot).at(&times)) {
            near(&state?, *time);
        }
        prop_assert_eq!(asked.replace(0), 5);
        let height = |state: &State<Ball>| [Crossing::Falling(state.configuration().y)];
        let mut falls = stepper.trajectory(start).forced_by(pilot).events(100, height);
        let Some(landed) = falls.next().transpose()? else { return Err(TestCaseError::fail("it falls")) };
        near(&landed.state, landed.time);
        prop_assert!(exact(landed.time).0.y.abs() < 1e-13);
        prop_assert_eq!(asked.get(), (landed.time / h).ceil() as u32);
    }

    /// Burns at pericentres: a larger orbit, whose period is known, and a smaller one. The event goes on through zero.
    #[test]
    fn burns_change_orbits(e in 0.1_f64..0.4, part in 0.02_f64..0.1) {
        let stepper = Orbit.into_stepper_by::<Fine>(PERIOD / 211.3)?;
        let (q, p) = kepler(e, PERIOD / 2.0);
        let mut burns = stepper.trajectory(stepper.state(q, p)?).events(2000, |state| {
            [Crossing::Rising(state.configuration().dot(&state.momentum()))]
        });
        let mut expected = PERIOD / 2.0;
        for change in [part, -part / 2.0, part] {
            let Event { time, state, .. } = burns.next().transpose()?.expect("a pericentre");
            prop_assert!((time - expected).abs() < 1e-8, "{time}, not {expected}");
            let state = stepper.kick(&state, state.momentum() * change)?;
            // a = −1/2E
            expected = time + PERIOD * (-0.5 / stepper.energy(&state)).powf(1.5);
            burns.go_on_from(state);
        }
    }

    /// Two crossings in one step, a touch, and none; and functions that are not finite.
    #[test]
    fn grazing_is_told(depth in 1e-3_f64..0.02, number in 3_u32..8) {
        let stepper = Ball { mass: 1.0, gravity: 10.0 }.into_stepper(0.1)?;
        // up for a time that is no multiple of h, to a height of 5 t²
        let time = f64::from(number) * 0.1 + 0.04;
        let apex = 5.0 * time * time;
        let start = stepper.state(Vector2::zeros(), Vector2::new(0.0, 10.0 * time))?;
        let above = |bar: f64| stepper.trajectory(start).events(20, move |state| [Crossing::Either(bar - state.configuration().y)]);
        let found: Vec<f64> = above(apex - depth / 10.0).map(|event| event.map(|event| event.time)).collect::<Result<_, _>>()?;
        let half = (depth / 50.0).sqrt();
        prop_assert_eq!(found.len(), 2);
        prop_assert!((found[0] - time + half).abs() < 1e-12 && (found[1] - time - half).abs() < 1e-12, "{found:?}");
        prop_assert_eq!(above(apex + depth / 10.0).next(), None);
        let touch = above(apex).next();
        let is_told = matches!(touch, Some(Err(Error::EventGrazes { event: 0, least })) if least.abs() < 1e-13);
        prop_assert!(is_told, "{touch:?}");
        let mut undefined = stepper.trajectory(start).events(20, |state| [Crossing::Either(1.0), Crossing::Rising((0.5 - state.configuration().y).sqrt())]);
        prop_assert_eq!(undefined.next(), Some(Err(Error::EventNotFinite { event: 1 })));
        prop_assert_eq!(undefined.next(), None);
        // resting on it is no event
        let resting = Ball { mass: 1.0, gravity: 0.0 }.into_stepper(0.1)?;
        let mut rest = resting.trajectory(resting.state(Vector2::zeros(), Vector2::x())?).events(50, |state| [Crossing::Either(state.configuration().y)]);
        prop_assert_eq!((rest.next(), rest.steps_left()), (None, 0));
    }

    /// A run is looked at after each part, ends where it is told to, and goes on. A step that fails leaves the last good state.
    #[test]
    fn long_runs_are_watched(top in tops(), r in attitude(), mu in vector::<3>(1.0), steps in 0_u64..40, each in 0_u64..7, end in 1_u64..9) {
        let stepper = top.stepper(H)?;
        let start = stepper.state(r, mu)?;
        let mut run = stepper.clone().integrator(start);
        let mut seen = Vec::new();
        let ended = run.advance_watched(steps, each, |run| {
            seen.push(run.steps());
            if seen.len() as u64 == end { ControlFlow::Break(run.steps()) } else { ControlFlow::Continue(()) }
        })?;
        let part = each.max(1);
        let expected: Vec<u64> = (1..=steps.div_ceil(part)).map(|k| (k * part).min(steps)).take(end as usize).collect();
        let made = expected.last().copied().unwrap_or(0);
        let is_cancelled = expected.len() as u64 == end;
        prop_assert_eq!(&seen, &expected);
        prop_assert_eq!(ended, if is_cancelled { ControlFlow::Break(made) } else { ControlFlow::Continue(()) });
        prop_assert_eq!((run.steps(), *run.state()), (made, stepper.advance(&start, made as usize)?));
        let never = run.advance_watched(steps - made, 3, |_| ControlFlow::<()>::Continue(()))?;
        prop_assert_eq!(never, ControlFlow::Continue(()));
        prop_assert_eq!(*run.state(), stepper.advance(&start, steps as usize)?);
        prop_assert_eq!(stepper.advance_or_stop(&start, steps as usize), Ok(stepper.advance(&start, steps as usize)?));
        // a fall for ever: its place overflows at a step that is known
        let ball = Ball { mass: 1.0, gravity: 0.0 }.into_stepper(1e300)?;
        let falling = ball.state(Vector2::zeros(), Vector2::new(0.0, 1.5e7))?;
        let stopped = ball.advance_or_stop(&falling, 30).expect_err("beyond 1.8e308");
        prop_assert_eq!(stopped.steps, 11);
        prop_assert!((stopped.state.configuration().y / 1.65e308 - 1.0).abs() < 1e-14);
        prop_assert_eq!(Error::from(stopped), ball.advance(&falling, 30).expect_err("the same"));
    }

    /// States at given times are steps of a part of h from the step before, whatever the method.
    #[test]
    fn times_are_reached_from_the_step_before(top in tops(), staggered in staggered_tops(), satellite in satellites(), r in attitude(), mu in vector::<3>(1.0), part in 0.1_f64..0.9) {
        let stepper = top.stepper(H)?;
        let start = stepper.state(r, mu)?;
        let nodes: Vec<_> = stepper.trajectory(start).take(5).collect::<Result<_, _>>()?;
        let times = [0.0, part * H, H, H, 2.0 * H, 3.0 * H, (3.0 + part) * H];
        let states: Vec<_> = stepper.trajectory(start).at(&times).collect::<Result<_, _>>()?;
        prop_assert_eq!(states.len(), times.len());
        prop_assert_eq!([states[0], states[2], states[3], states[4], states[5]], [nodes[0], nodes[1], nodes[1], nodes[2], nodes[3]]);
        let vertical = |state: &State<WatchedTop>| (state.configuration() * state.momentum()).z;
        for (state, node) in [(&states[1], &nodes[0]), (&states[6], &nodes[3])] {
            let reached = stepper.step_for(node, part * H)?;
            assert_near(state.configuration(), reached.configuration(), 1e-14, "the attitude");
            prop_assert!((vertical(state) - vertical(&start)).abs() < 1e-14, "the conserved momentum");
        }
        let every: Vec<_> = stepper.trajectory(start).every(H).take(5).collect::<Result<_, _>>()?;
        prop_assert_eq!(every, nodes);
        // backwards
        let back = top.stepper(-H)?;
        let mut timed = back.trajectory(stepper.step(&start)?).at(vec![-H]);
        assert_near(timed.next().expect("one time")?.configuration(), &r, 1e-12, "where it came from");
        prop_assert_eq!(timed.next(), None);
        // with order 1 the readings are those of order 2, and clocks show the times that were asked for
        let first = staggered.stepper(H)?;
        let state = first.trajectory(first.staggered_state(r, mu)?).at([2.5 * H]).next().expect("one time")?;
        let node = first.trajectory(first.staggered_state(r, mu)?).nth(2).expect("endless")?;
        prop_assert_eq!(first.synchronized(&state), first.synchronized(&first.step_for(&node, 2.5 * H - 2.0 * H)?));
        let timed = satellite.stepper(H)?;
        let asked = [1.0 + part * H, 1.2, 1.3];
        for (state, time) in timed.trajectory(timed.state_at(1.0, r, mu)?).at(asked.iter()).zip(asked) {
            prop_assert!((state?.time() - time).abs() <= 2.0 * f64::EPSILON);
        }
        let mut refused = stepper.trajectory(start).at([0.3, 0.2, 0.4]);
        prop_assert!(refused.next().is_some_and(|state| state.is_ok()));
        let before = refused.next();
        prop_assert_eq!(before, Some(Err(Error::TimeOrder { time: 0.2, before: 0.3 })));
        prop_assert_eq!(refused.next(), None);
        prop_assert_eq!(Some(Ok(*refused.state())), stepper.trajectory(start).nth(6)); // 6 × 0.05
        prop_assert_eq!(stepper.trajectory(start).at([f64::NAN]).next(), Some(Err(Error::NotFinite { name: "the time" })));
        prop_assert_eq!(stepper.trajectory(start).every(-1.0).nth(1), Some(Err(Error::TimeOrder { time: -1.0, before: 0.0 })));
    }
}

proptest! {
    #![proptest_config(cases(2))]

    /// Errors between steps fall as those at their ends: of second order against Kepler's equation.
    #[test]
    fn times_and_events_have_the_order(e in 0.2_f64..0.4) {
        let (q, p) = kepler(e, 0.3);
        let times: Vec<f64> = (1..40).map(|k| f64::from(k) * 0.1234).collect();
        let errors = |steps: u32| -> Result<[f64; 2], Error> {
            let stepper = Orbit.into_stepper(PERIOD / f64::from(steps))?;
            let start = stepper.state(q, p)?;
            let mut worst: f64 = 0.0;
            for (time, state) in times.iter().zip(stepper.trajectory(start).at(&times)) {
                let state = state?;
                let (q, p) = kepler(e, 0.3 + time);
                worst = worst.max((state.configuration() - q).norm()).max((state.momentum() - p).norm());
            }
            let mut apsides = stepper.trajectory(start).events(2000, |state| [Crossing::Falling(state.configuration().dot(&state.momentum()))]);
            let apocentre = apsides.next().transpose()?.expect("an apocentre").time;
            Ok([worst, (apocentre - (PERIOD / 2.0 - 0.3)).abs()])
        };
        let measured = [200, 400, 800, 1600].map(errors);
        let measured: Vec<[f64; 2]> = measured.into_iter().collect::<Result<_, _>>()?;
        for (kind, name) in ["states", "events"].iter().enumerate() {
            let errors: Vec<f64> = measured.iter().map(|errors| errors[kind]).collect();
            let order = order(&errors);
            prop_assert!((order - 2.0).abs() < 0.1, "{name}: order {order:.3}, errors {errors:?}");
        }
    }

    /// A bob reaches a wall when an independent motion does.
    #[test]
    fn bobs_hit_walls(speed in 1.0_f64..2.0) {
        let pendulum = SphericalPendulum { mass: 1.3, length: 0.7, gravity: 9.8 };
        let (q, mu) = (Vector3::new(-0.6, 0.0, -0.8), Vector3::new(0.3, -speed, -0.225));
        let wall = 0.2;
        let exact = reaches(&pendulum, SVector::from_column_slice(&[q.x, q.y, q.z, mu.x, mu.y, mu.z]), wall);
        let error = |steps: u32| -> Result<f64, Error> {
            let stepper = pendulum.stepper(0.4 / f64::from(steps))?;
            let mut events = stepper.trajectory(stepper.state(q, mu)?).events(10_000, |state| [Crossing::Rising(state.configuration().x - wall)]);
            Ok((events.next().transpose()?.expect("it hits the wall").time - exact).abs())
        };
        let errors: Vec<f64> = [50, 100, 200, 400].map(error).into_iter().collect::<Result<_, _>>()?;
        let order = order(&errors);
        prop_assert!((order - 2.0).abs() < 0.1 && errors[3] < 1e-5, "order {order:.3}, errors {errors:?}");
    }
}
