//! Wheels and a joint in one declaration: a tractor with a trailer.

use clebsch::{Clebsch, Error, Space, State};
use clebsch_tests::fixtures::tractor_trailer::TractorTrailer;
use nalgebra::{Matrix3, Matrix4, SVector, Vector2, Vector4, Vector6};

use crate::order::integrated;

fn rig() -> TractorTrailer {
    TractorTrailer {
        mass: [1.5, 0.8],
        inertia: [0.4, 0.25],
        offset: [0.3, -0.2],
        hitch: [Vector2::new(-0.4, 0.0), Vector2::new(0.9, 0.0)],
    }
}

/// The changes of (x, y, θ₀, θ₁, ω₀, v₀), and the force of the tractor on the trailer in the frame of the tractor.
///
/// Newton and Euler for both bodies, about the points between their wheels, with the force f at the hitch:
///
/// ```text
/// m₀(v₀′ − a₀ω₀²) = −f_x,    (I₀ + m₀a₀²) ω₀′ + m₀a₀v₀ω₀ = −c f_y
/// m₁(v₁′ − a₁ω₁²) = g_x,     (I₁ + m₁a₁²) ω₁′ + m₁a₁v₁ω₁ = d g_y,    g = R(θ₀ − θ₁) f
/// v₁ = v₀ cos δ − c ω₀ sin δ,    d ω₁ = v₀ sin δ + c ω₀ cos δ,    δ = θ₀ − θ₁
/// ```
fn motion(rig: &TractorTrailer, y: &Vector6<f64>) -> (Vector6<f64>, Vector2<f64>) {
    let [_, _, first, second, omega, v] = *y.as_ref();
    let ([m, n], [a, b]) = (rig.mass, rig.offset);
    let (c, d) = (rig.hitch[0].x, rig.hitch[1].x);
    let [whole, other] = [0, 1].map(|i| rig.inertia[i] + rig.mass[i] * rig.offset[i].powi(2));
    let (sin, cos) = (first - second).sin_cos();
    let (w, u) = ((v * sin + c * omega * cos) / d, v * cos - c * omega * sin);
    let turning = omega - w;
    // v₁′ and ω₁′ without v₀′ and ω₀′
    let (du, dw) = (-turning * (v * sin + c * omega * cos), turning * (v * cos - c * omega * sin) / d);
    // unknowns v₀′, ω₀′, f_x, f_y
    let matrix = Matrix4::new(
        m,
        0.0,
        1.0,
        0.0,
        0.0,
        whole,
        0.0,
        c,
        n * cos,
        -n * c * sin,
        -cos,
        sin,
        other * sin / d,
        other * c * cos / d,
        -d * sin,
        -d * cos,
    );
    let right =
        Vector4::new(m * a * omega * omega, -m * a * v * omega, n * (b * w * w - du), -n * b * u * w - other * dw);
    let found = matrix.lu().solve(&right).expect("a regular matrix");
    let change = Vector6::new(v * first.cos(), v * first.sin(), omega, w, found[1], found[0]);
    (change, Vector2::new(found[2], found[3]))
}

fn placed(turned: f64, x: f64, y: f64) -> Matrix3<f64> {
    let (sin, cos) = turned.sin_cos();
    Matrix3::new(cos, -sin, x, sin, cos, y, 0.0, 0.0, 1.0)
}

/// Where both bodies stand, with their velocities, from (x, y, θ₀, θ₁, ω₀, v₀).
fn start(rig: &TractorTrailer, y: &Vector6<f64>) -> ([Matrix3<f64>; 2], Vector6<f64>) {
    let [x, height, first, second, omega, v] = *y.as_ref();
    let tractor = placed(first, x, height);
    let (c, d) = (rig.hitch[0].x, rig.hitch[1].x);
    let hitch = tractor.transform_point(&Vector2::new(c, 0.0).into());
    let trailer = placed(second, hitch.x - d * second.cos(), hitch.y - d * second.sin());
    let (sin, cos) = (first - second).sin_cos();
    let (u, w) = (v * cos - c * omega * sin, (v * sin + c * omega * cos) / d);
    ([tractor, trailer], Vector6::new(omega, v, 0.0, w, u, 0.0))
}

const START: [f64; 6] = [0.2, -0.1, 0.3, -0.5, 0.9, 1.4];

#[test]
fn a_tractor_with_a_trailer_is_of_second_order() -> Result<(), Error> {
    let rig = rig();
    let y = Vector6::from(START);
    let expected = integrated(|y| motion(&rig, y).0, y, 2.0);
    let middle = |h: f64| motion(&rig, &integrated(|y| motion(&rig, y).0, y, 2.0 - h / 2.0));
    let error = |steps: usize| -> Result<[f64; 2], Error> {
        let h = 2.0 / steps as f64;
        let stepper = rig.stepper(h)?;
        let (q, velocity) = start(&rig, &y);
        let before = stepper.advance(&stepper.state_moving(q, velocity)?, steps - 1)?;
        let (after, reactions) = stepper.step_with_reactions(&before)?;
        let [tractor, trailer] = after.configuration();
        let found = SVector::from([tractor[(0, 2)], tractor[(1, 2)], tractor[(1, 0)], trailer[(1, 0)]]);
        let exact = SVector::from([expected[0], expected[1], expected[2].sin(), expected[3].sin()]);
        // the rows of the joint come first: tractor less trailer, so that λ pushes the tractor
        let (sin, cos) = integrated(|y| motion(&rig, y).0, y, 2.0 - h / 2.0)[2].sin_cos();
        let force = middle(h).1;
        let force = Vector2::new(cos * force.x - sin * force.y, sin * force.x + cos * force.y);
        Ok([(found - exact).norm(), (reactions.fixed_rows::<2>(0) + force).norm()])
    };
    let ([a, b], [c, d]) = (error(80)?, error(160)?);
    for (name, coarse, fine) in [("places", a, c), ("the force of the hitch", b, d)] {
        let order = (coarse / fine).log2();
        assert!(coarse < 1e-2 && (order - 2.0).abs() < 0.05, "{name}: {coarse:e}, order {order}");
    }
    Ok(())
}

#[test]
fn steps_of_both_kinds_are_time_symmetric() -> Result<(), Error> {
    let (rig, y) = (rig(), Vector6::from(START));
    let (forth, back) = (rig.stepper(0.05)?, rig.stepper(-0.05)?);
    let (q, velocity) = start(&rig, &y);
    let start = forth.state_moving(q, velocity)?;
    let there = forth.advance(&start, 50)?;
    let again = back.advance(&back.state(*there.configuration(), there.momentum())?, 50)?;
    let far = start.configuration().distance_squared(again.configuration());
    let far = (far + start.momentum().distance_squared(&again.momentum())).sqrt();
    assert!(far < 1e-12, "{far:e}");
    Ok(())
}

/// How far the hitch is open, and how fast wheels slip and the hitch opens, by hand.
fn violations(rig: &TractorTrailer, state: &State<TractorTrailer>) -> [f64; 3] {
    let q = state.configuration();
    let at = |i: usize| q[i].transform_point(&rig.hitch[i].into());
    let velocity = |i: usize| {
        let [spin, along, across] = [0, 1, 2].map(|k| state.momentum()[3 * i + k]);
        let omega = (spin - rig.offset[i] * across) / rig.inertia[i];
        [omega, along / rig.mass[i], across / rig.mass[i] - rig.offset[i] * omega]
    };
    let speed = |i: usize| {
        let ([omega, v, slip], hitch) = (velocity(i), rig.hitch[i]);
        q[i].fixed_view::<2, 2>(0, 0) * Vector2::new(v - omega * hitch.y, slip + omega * hitch.x)
    };
    let slips = velocity(0)[2].abs().max(velocity(1)[2].abs());
    [(at(0) - at(1)).norm(), slips, (speed(0) - speed(1)).norm()]
}

/// 2000 steps, with the feature `heavy` 100 000. With the cost of Moser and Veselov the band of the energy does not grow.
#[test]
fn wheels_and_hitch_stay_for_many_steps() -> Result<(), Error> {
    let (rig, y) = (rig(), Vector6::from(START));
    let stepper = rig.stepper(0.02)?;
    let (q, velocity) = start(&rig, &y);
    let mut state = stepper.state_moving(q, velocity)?;
    let energy = stepper.energy(&state);
    let mut worst = [0.0_f64; 3];
    let mut off = 0.0_f64;
    for _ in 0..if cfg!(feature = "heavy") { 1000 } else { 20 } {
        state = stepper.advance(&state, 100)?;
        worst = std::array::from_fn(|i| worst[i].max(violations(&rig, &state)[i]));
        off = off.max((stepper.energy(&state) - energy).abs());
    }
    let size = state.configuration()[0].amax();
    assert!(worst[0] < 1e-15 * size.max(10.0) && worst[1] < 1e-14 && worst[2] < 1e-13, "{worst:?} at {size}");
    Ok(())
}

/// Both kinds are checked, each with its error, and both are repaired.
#[test]
fn states_obey_both_kinds() -> Result<(), Error> {
    let (rig, y) = (rig(), Vector6::from(START));
    let stepper = rig.stepper(0.05)?;
    let (q, velocity) = start(&rig, &y);
    let slipping = velocity + Vector6::new(0.0, 0.0, 0.1, 0.0, 0.0, 0.0);
    assert!(matches!(stepper.state_moving(q, slipping), Err(Error::ConstraintViolated { .. })));
    let opening = velocity + Vector6::new(0.0, 0.1, 0.0, 0.0, 0.0, 0.0);
    assert!(matches!(stepper.state_moving(q, opening), Err(Error::ConstraintViolated { .. })));
    let apart = [q[0], placed(-0.4, 0.0, 0.3)];
    assert!(matches!(stepper.state_moving(apart, velocity), Err(Error::OffConstraint { .. })));
    let repaired = stepper.project(apart, Vector6::new(0.3, -0.2, 0.5, 0.1, 0.7, -0.4))?;
    let left = violations(&rig, &repaired);
    assert!(left.iter().all(|left| *left < 1e-14), "{left:?}");
    Ok(())
}
