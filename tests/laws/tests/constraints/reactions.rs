//! Reactions: against Newton's law, closed forms, and the multipliers of Lagrange and d'Alembert by a method of Runge and
//! Kutta.

use clebsch::{Clebsch, Declared, Error, F64x4, Method, Reacting, Scalar, Space};
use clebsch_tests::fixtures::{
    chaplygin_sleigh::ChaplyginSleigh, rattleback::Rattleback, rolling_ball::RollingBall, snakeboard::Snakeboard,
};
use nalgebra::{Matrix3, Matrix4, Quaternion, SVector, Vector1, Vector2, Vector3, Vector4, Vector5, Vector6};

use crate::order::{integrated, integrated_in, suslov};
use crate::places::{bodies, rods::Bob, tilted};
use crate::variants::{Compensated, Fine, Fourth, Pushed, Suslov, Turned};

mod declared {
    use clebsch::{Clebsch, Scalar};
    use nalgebra::*;

    /// A bead on a rod that turns once in 2π seconds.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: Translation<2>, x: Vector2| x + a,
        lagrangian = |v| self.mass * v.norm_squared() / 2,
        constraint = |t, x| [x.y * t.cos() == x.x * t.sin()],
        method Fourth = (order = 4),
    )]
    pub struct Bead<T: Scalar> {
        pub mass: T,
    }

    /// Compositions of five steps.
    pub struct Fourth;

    /// A mass on a rod, slowed by an input.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: Translation<2>, x: Vector2| x + a,
        lagrangian = |v| self.mass * v.norm_squared() / 2,
        force      = |v, drag: Vector1| -drag.x * v,
        constraint = |x, v| [v.y == self.slope * v.x],
    )]
    pub struct OnRod {
        pub mass: f64,
        pub slope: f64,
    }

    /// The same on a line, without a rod.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: Translation<1>, x: Vector1| x + a,
        lagrangian = |v| self.mass * v.norm_squared() / 2,
        force      = |v, drag: Vector1| -drag.x * v,
    )]
    pub struct OnLine {
        pub mass: f64,
    }

    /// Spatial momenta: the group acts from the left. A linear term in the velocity and a potential act too.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: SO<3>, R: SO<3>| F * R,
        lagrangian = |R, w| w.dot(&(self.inertia * w)) / 2 + self.spin * w.dot(&(R * self.axis)),
        potential  = |R| self.weight * (R * self.axis).z,
        constraint = |R, w| [w.dot(&(R * self.blade)) == 0],
    )]
    pub struct Spatial {
        #[clebsch(symmetric)]
        pub inertia: Matrix3<f64>,
        pub spin: f64,
        pub axis: Vector3<f64>,
        pub blade: Vector3<f64>,
        pub weight: f64,
    }
}

use declared::{Bead, Spatial};

/// φ = |x|² − l² gives the force 2λx. From x·x″ + |v|² = 0 follows 2λl² = m (g z − |v|²).
fn multiplier_of_rod(bob: &Bob, x: Vector3<f64>, v: Vector3<f64>) -> f64 {
    bob.mass * (bob.gravity * x.z - v.norm_squared()) / (2.0 * bob.length.powi(2))
}

#[test]
fn a_rod_pulls_as_the_closed_form_says() -> Result<(), Error> {
    let bob = Bob { mass: 0.7, gravity: 9.81, length: 1.3 };
    let stepper = bob.stepper(0.01)?;
    let mut state = stepper.state_moving(Vector3::new(0.5, 1.2, 0.0), Vector3::new(1.2, -0.5, 0.8))?;
    for _ in 0..1000 {
        state = stepper.step(&state)?;
        let expected = multiplier_of_rod(&bob, *state.configuration(), state.momentum() / bob.mass);
        let off = (stepper.reactions(&state)?.x - expected).abs();
        assert!(off < 1e-13, "{off:e}");
    }
    Ok(())
}

/// The order of the reactions of four steps of a second, from so many steps and from twice as many. `mean` is their exact
/// value between two times.
fn order_of_reactions<S, M>(
    system: &S,
    (q, mu): (S::Configuration, S::Momentum),
    steps: usize,
    mean: impl Fn(f64, f64) -> S::Reactions,
) -> Result<f64, Error>
where
    S: Reacting<M, Scalar = f64> + Clone,
    M: Method<S>,
{
    let error = |steps: usize| -> Result<f64, Error> {
        let h = 1.0 / steps as f64;
        let stepper = system.stepper_by::<M>(h)?;
        let start = stepper.state(q, mu)?;
        (1..=4).try_fold(0.0_f64, |worst, quarter| {
            let number = steps * quarter / 4 - 1;
            let before = stepper.advance(&start, number)?;
            let (after, reactions) = stepper.step_with_reactions(&before)?;
            assert_eq!(after, stepper.step(&before)?);
            let expected = mean(h * number as f64, h * (number + 1) as f64);
            Ok(worst.max(reactions.distance_squared(&expected).sqrt()))
        })
    };
    let (coarse, fine) = (error(steps)?, error(2 * steps)?);
    assert!(fine > 1e-12, "{fine:e} is too near to rounding");
    Ok((coarse / fine).log2())
}

/// The mean of a function of the solution between two times: an integral that is a further unknown.
fn mean<const N: usize>(
    slope: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    start: SVector<f64, N>,
    (from, to): (f64, f64),
) -> f64 {
    // a second and an eighth of one at most: the errors are below those that are measured
    let (long, short) = if cfg!(feature = "heavy") { (4_000, 500) } else { (1_000, 125) };
    let before = integrated_in(long, &slope, start, from);
    (integrated_in(short, &slope, before, to - from)[N - 1] - before[N - 1]) / (to - from)
}

#[test]
fn reactions_of_steps_are_means_over_steps_to_the_order_of_the_method() -> Result<(), Error> {
    // Suslov's body: (J ω′ + ω × J ω)₃ = λ with ω₃ = 0
    let inertia = Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9);
    let slope = |y: &Vector6<f64>| {
        let change = suslov(inertia)(&y.fixed_rows::<5>(0).into_owned());
        let omega = Vector3::new(y[0], y[1], 0.0);
        let lambda = (inertia * Vector3::new(change[0], change[1], 0.0) + omega.cross(&(inertia * omega))).z;
        Vector6::new(change[0], change[1], change[2], change[3], change[4], lambda)
    };
    let start = Vector6::new(0.9, -0.7, 0.0, 0.0, 1.0, 0.0);
    let exact = |from, to| Vector1::new(mean(slope, start, (from, to)));
    let momentum = inertia * Vector3::new(0.9, -0.7, 0.0);
    let (body, place) = (Suslov { inertia }, Matrix3::identity());
    let second = order_of_reactions::<_, Declared>(&body, (place, momentum), 40, exact)?;
    assert!((second - 2.0).abs() < 0.05, "order {second}");
    let fourth = order_of_reactions::<_, Fourth>(&body, (place, momentum), 8, exact)?;
    assert!((fourth - 4.0).abs() < 0.25, "order {fourth}");
    let (turned, identity) = (Turned { inertia }, Quaternion::new(1.0, 0.0, 0.0, 0.0));
    let sixth = order_of_reactions::<_, Fine>(&turned, (identity, momentum), 8, exact)?;
    assert!((sixth - 6.0).abs() < 0.5, "order {sixth}");

    // a bead on a turning rod: r = cosh t, and 2 m r′ across the rod
    let bead = Bead { mass: 1.7 };
    let exact = |from: f64, to: f64| Vector1::new(2.0 * bead.mass * (to.cosh() - from.cosh()) / (to - from));
    let start = (Vector2::x(), Vector2::y() * bead.mass);
    let second = order_of_reactions::<_, Declared>(&bead, start, 40, exact)?;
    assert!((second - 2.0).abs() < 0.05, "order {second}");
    let fourth = order_of_reactions::<_, declared::Fourth>(&bead, start, 8, exact)?;
    assert!((fourth - 4.0).abs() < 0.25, "order {fourth}");
    Ok(())
}

/// The side force on the blade is m (v ω + a ω′) = I m v ω/(I + m a²). v and ω are Chaplygin's hyperbolic functions.
#[test]
fn a_blade_pushes_as_the_closed_form_says() -> Result<(), Error> {
    let sleigh = ChaplyginSleigh { mass: 1.5, inertia: 0.4, offset: 0.6 };
    let (m, a) = (sleigh.mass, sleigh.offset);
    let beta = ((sleigh.inertia + m * a * a) / m).sqrt();
    let (omega, v) = (1.1_f64, -0.8_f64);
    let c = v.hypot(beta * omega);
    let delta = (v / c).atanh();
    let force = |t: f64| {
        let turn = a * c * t / (beta * beta) + delta;
        sleigh.inertia * (c * turn.tanh()) * (c / beta / turn.cosh()) / (beta * beta)
    };
    let error = |steps: usize| -> Result<[f64; 2], Error> {
        let h = 2.0 / steps as f64;
        let stepper = sleigh.stepper(h)?;
        let mut state = stepper.state_moving(Matrix3::identity(), Vector3::new(omega, v, 0.0))?;
        let (mut at_states, mut at_middles) = (0.0_f64, 0.0_f64);
        for step in 0..steps {
            let t = h * step as f64;
            at_states = at_states.max((stepper.reactions(&state)?.x - force(t)).abs());
            let (next, reactions) = stepper.step_with_reactions(&state)?;
            at_middles = at_middles.max((reactions.x - force(t + h / 2.0)).abs());
            state = next;
        }
        Ok([at_states, at_middles])
    };
    let ([a, b], [c, d]) = (error(80)?, error(160)?);
    for (name, coarse, fine) in [("states", a, c), ("middles", b, d)] {
        let order = (coarse / fine).log2();
        assert!(coarse < 1e-3 && (order - 2.0).abs() < 0.05, "at {name}: {coarse:e}, order {order}");
    }
    Ok(())
}

/// The friction at the contact is m x″ = m κ (−y′, x′).
#[test]
fn the_table_pushes_its_ball_round() -> Result<(), Error> {
    let ball = RollingBall { mass: 1.3, inertia: 0.7, radius: 0.5, table_rate: 0.9 };
    let kappa = ball.inertia * ball.table_rate / (ball.inertia + ball.mass * ball.radius * ball.radius);
    let stepper = ball.stepper(0.1)?;
    let mut state = stepper.project(Vector2::new(0.3, -0.2), Vector5::new(0.2, 0.4, 0.1, -0.3, 0.35))?;
    for _ in 0..100 {
        let n = state.momentum();
        let off = (stepper.reactions(&state)? - Vector2::new(-n[1], n[0]) * kappa).norm();
        assert!(off < 1e-15, "{off:e}");
        let (next, reactions) = stepper.step_with_reactions(&state)?;
        // m times the change of velocity over the step
        let change = (next.momentum() - n).fixed_rows::<2>(0) / 0.1;
        assert!((reactions - change).norm() < 1e-14, "{}", (reactions - change).norm());
        state = next;
    }
    Ok(())
}

/// m (v′ + …) across the blade, with friction, a potential and an input along it.
#[test]
fn reactions_know_forces_and_inputs() -> Result<(), Error> {
    let sleigh = Pushed { mass: 1.5, inertia: 0.4, offset: 0.6, friction: 0.2, weight: 0.7 };
    let (m, a, c, w) = (sleigh.mass, sleigh.offset, sleigh.friction, sleigh.weight);
    let whole = sleigh.inertia + m * a * a;
    let force =
        |turned: f64, omega: f64, v: f64| m * (omega * v - a * (m * a * v + c) * omega / whole) + w * turned.cos();
    let slope = |y: &Vector5<f64>| {
        let [_, turned, omega, v, push] = *y.as_ref();
        let along = a * omega * omega + (push - c * v - w * turned.sin()) / m;
        Vector5::new(force(turned, omega, v), omega, -(m * a * v + c) * omega / whole, along, 0.0)
    };
    let start = Vector5::new(0.0, 0.0, 1.1, -0.8, 0.8);
    let error = |steps: usize| -> Result<f64, Error> {
        let h = 1.0 / steps as f64;
        let stepper = sleigh.stepper(h)?;
        let mut state = stepper.state_moving(Matrix3::identity(), Vector3::new(1.1, -0.8, 0.0))?;
        let mut reactions = Vector1::zeros();
        for _ in 0..steps {
            (state, reactions) = stepper.step_with_reactions_under(&state, &Vector1::new(0.8))?;
        }
        let middle = integrated(slope, start, 1.0 - h / 2.0);
        Ok((reactions.x - force(middle[1], middle[2], middle[3])).abs())
    };
    let order = (error(80)? / error(160)?).log2();
    assert!((order - 2.0).abs() < 0.1, "order {order}");

    // a push across the blade is taken by the blade
    let stepper = sleigh.stepper(0.01)?;
    let state = stepper.state_moving(Matrix3::identity(), Vector3::new(1.1, -0.8, 0.0))?;
    for push in [0.0, 0.8] {
        let found = stepper.reactions_under(&state, &Vector1::new(push))?.x;
        assert!((found - force(0.0, 1.1, -0.8)).abs() < 1e-15, "{found}");
    }
    let refused = stepper.reactions_under(&state, &Vector1::new(f64::NAN));
    assert_eq!(refused, Err(Error::NotFinite { name: "the input" }));
    Ok(())
}

/// A mass on a slanted rod, which an input slows down, moves as one on a line does. The force of the rod knows the input.
#[test]
fn an_input_may_slow_a_guided_mass() -> Result<(), Error> {
    let (mass, slope, drag) = (1.3, 0.75_f64, Vector1::new(0.8));
    let length = slope.hypot(1.0);
    let (rod, line) =
        (declared::OnRod { mass, slope }.into_stepper(0.1)?, declared::OnLine { mass }.into_stepper(0.1)?);
    let mut guided = rod.state_moving(Vector2::zeros(), Vector2::new(1.0, slope))?;
    let mut free = line.state(Vector1::zeros(), Vector1::new(mass * length))?;
    for _ in 0..20 {
        (guided, free) = (rod.step_with(&guided, &drag)?, line.step_with(&free, &drag)?);
        let along = guided.configuration().norm();
        assert!((along - free.configuration().x).abs() < 1e-13, "{along} is not {}", free.configuration().x);
        assert!((guided.momentum().norm() - free.momentum().x).abs() < 1e-13);
    }
    Ok(())
}

/// Newton's law for both centres of mass, with accelerations from three places of a trajectory.
#[test]
fn joints_accelerate_the_centres_of_mass() -> Result<(), Error> {
    let bodies = bodies();
    let h = 1e-4;
    let stepper = bodies.stepper(h)?;
    let start = stepper.project(tilted(&bodies), SVector::from_fn(|i, _| 0.01 * (i as f64 - 5.0)))?;
    let before = stepper.advance(&start, 1000)?;
    let state = stepper.step(&before)?;
    let after = stepper.step(&state)?;
    let forces = [0, 1].map(|i| {
        let at = |q: &[Matrix4<f64>; 2]| Vector3::new(q[i][(0, 3)], q[i][(1, 3)], q[i][(2, 3)]);
        let [a, b, c] = [&before, &state, &after].map(|state| at(state.configuration()));
        ((a - b * 2.0 + c) / (h * h) + Vector3::z() * bodies.gravity) * bodies.mass[i]
    });
    let found = stepper.reactions(&state)?;
    let (upper, lower) = (found.fixed_rows::<3>(0), found.fixed_rows::<3>(3));
    let off = (upper - lower - forces[0]).norm().max((lower - forces[1]).norm());
    assert!(off < 1e-5 && lower.norm() > 1.0, "{off:e} of {lower}");
    Ok(())
}

/// How far the reactions at a state are from the mean of those of a step and of a step back, relative to them.
fn apart<S>(system: &S, h: f64, q: S::Configuration, mu: S::Momentum) -> Result<f64, Error>
where
    S: Reacting<Declared, Scalar = f64> + Clone,
{
    let (forth, back) = (system.stepper(h)?, system.stepper(-h)?);
    let start = forth.project(q, mu)?;
    let found = forth.reactions(&start)?;
    let (_, there) = forth.step_with_reactions(&start)?;
    let (_, again) = back.step_with_reactions(&back.state(*start.configuration(), start.momentum())?)?;
    let mean = there.zip_map(&again, |a, b| (a + b) / 2.0);
    Ok(found.distance_squared(&mean).sqrt() / found.max_abs())
}

/// A step and a step back have their middles on both sides of a state: their mean is of second order there.
#[test]
fn reactions_at_states_are_those_of_short_steps() -> Result<(), Error> {
    let inertia = Matrix3::new(1.6e-3, -2e-4, 0.0, -2e-4, 2e-3, 0.0, 0.0, 0.0, 2.2e-3);
    let stone = Rattleback { inertia, mass: 1.0, gravity: 9.81, axes: Vector3::new(0.2, 0.03, 0.02), height: 0.0 };
    let mut place = Matrix4::identity();
    place[(2, 3)] = stone.axes.z;
    let spin = Vector6::new(1e-3, 2e-3, -1e-2, 0.0, 0.0, 0.0);

    let board = Snakeboard { mass: 1.2, length: 0.8, rotor: 0.3, wheel: 0.15 };
    let at = (Matrix3::identity(), Vector1::new(0.0), Vector1::new(0.6));
    let moving = Vector5::new(0.3, -0.4, 0.1, 0.5, 0.2);

    let inertia = Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9);
    let (axis, blade) = (Vector3::new(0.3, -0.2, 0.9), Vector3::new(0.1, 0.8, 0.4));
    let spatial = Spatial { inertia, spin: 0.6, axis, blade, weight: 1.3 };
    let turned = *nalgebra::Rotation3::new(Vector3::new(0.4, -0.9, 0.2)).matrix();
    let momentum = Vector3::new(0.7, -0.4, 0.5);
    for (name, measured) in [
        ("rattleback", [1e-3, 5e-4].map(|h| apart(&stone, h, place, spin))),
        ("snakeboard", [1e-2, 5e-3].map(|h| apart(&board, h, at, moving))),
        ("spatial momenta", [1e-2, 5e-3].map(|h| apart(&spatial, h, turned, momentum))),
        ("joints", [1e-3, 5e-4].map(|h| apart(&bodies(), h, tilted(&bodies()), SVector::from_element(0.02)))),
    ] {
        let [coarse, fine] = measured;
        let (coarse, order) = (coarse?, (coarse? / fine?).log2());
        assert!(coarse < 1e-2 && (order - 2.0).abs() < 0.1, "{name}: {coarse:e}, order {order}");
    }
    Ok(())
}

#[test]
fn sums_lanes_and_short_numbers_give_the_same_reactions() -> Result<(), Error> {
    let inertia = Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9);
    let (body, place, omega) = (Suslov { inertia }, Matrix3::identity(), Vector3::new(0.9, -0.7, 0.0));
    let plain = body.stepper(0.1)?;
    let start = plain.state_moving(place, omega)?;
    let (_, expected) = plain.step_with_reactions(&start)?;
    assert!(expected.x.abs() > 0.01);

    let compensated = body.stepper_by::<Compensated>(0.1)?;
    let (_, found) = compensated.step_with_reactions(&compensated.state_moving(place, omega)?)?;
    assert!((found - expected).norm() < 1e-14, "compensated: {found}");

    let short = Suslov { inertia: inertia.map(|entry| entry as f32) }.into_stepper(0.1)?;
    let (_, found) =
        short.step_with_reactions(&short.state_moving(place.map(|x| x as f32), omega.map(|x| x as f32))?)?;
    assert!((f64::from(found.x) - expected.x).abs() < 1e-5, "f32: {found}");

    let wide = Bead { mass: F64x4::from_lanes(|lane| 1.0 + lane as f64) }.into_stepper(F64x4::splat(0.1))?;
    let speeds = Vector4::new(0.4, -0.3, 1.1, 0.9);
    let at = Vector2::x().map(F64x4::splat);
    let v = Vector2::new(F64x4::from_lanes(|lane| speeds[lane]), F64x4::splat(1.0));
    let start = wide.state_moving(at, v)?;
    let now = wide.reactions(&start)?;
    let (next, reactions) = wide.step_with_reactions(&start)?;
    let (_, later) = wide.step_with_reactions(&next)?;
    for lane in 0..4 {
        let mass = 1.0 + lane as f64;
        let one = Bead { mass }.into_stepper(0.1)?;
        let start = one.state_moving(Vector2::x(), Vector2::new(speeds[lane], 1.0))?;
        let (after, expected) = one.step_with_reactions(&start)?;
        let (_, expected_later) = one.step_with_reactions(&after)?;
        // 2 m r′
        assert!((Scalar::lane(now.x, lane) - 2.0 * mass * speeds[lane]).abs() < 1e-14, "lane {lane}");
        assert!((Scalar::lane(reactions.x, lane) - expected.x).abs() < 1e-13, "lane {lane}");
        assert!((Scalar::lane(later.x, lane) - expected_later.x).abs() < 1e-13, "lane {lane}");
    }
    Ok(())
}
