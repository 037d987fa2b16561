//! Properties of every step: it is the same forwards and backwards, and obeys its constraint to rounding. With the cost
//! of Moser and Veselov it conserves the energy of constraints that are constant in the body.

use clebsch::{Clebsch, Error, Space, State};
use clebsch_tests::fixtures::{chaplygin_sleigh::ChaplyginSleigh, rolling_ball::RollingBall, suslov::Suslov};
use nalgebra::{Matrix3, Vector2, Vector3, Vector5};

/// The steps of long runs.
const STEPS: usize = if cfg!(feature = "heavy") { 100_000 } else { 5_000 };

fn sleigh() -> ChaplyginSleigh {
    ChaplyginSleigh { mass: 1.5, inertia: 0.4, offset: 0.6 }
}

fn suslov() -> Suslov {
    Suslov { inertia: Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9) }
}

fn ball() -> RollingBall {
    RollingBall { mass: 1.3, inertia: 0.7, radius: 0.5, table_rate: 0.9 }
}

/// How far from the start 50 steps and 50 steps back end.
fn returned<S: Clebsch<Scalar = f64> + Clone>(
    system: &S,
    start: (S::Configuration, S::Momentum),
) -> Result<f64, Error> {
    let (forth, back) = (system.stepper(0.1)?, system.stepper(-0.1)?);
    let start: State<S> = forth.state(start.0, start.1)?;
    let there = forth.advance(&start, 50)?;
    let again = back.advance(&back.state(*there.configuration(), there.momentum())?, 50)?;
    let far = start.configuration().distance_squared(again.configuration());
    Ok((far + start.momentum().distance_squared(&again.momentum())).sqrt())
}

#[test]
fn steps_are_time_symmetric() -> Result<(), Error> {
    let far = returned(&sleigh(), (Matrix3::identity(), Vector3::new(1.034, -1.2, 0.99)))?;
    assert!(far < 2e-13, "the sleigh: {far:e}");
    let far = returned(&suslov(), (Matrix3::identity(), Vector3::new(0.83, -0.89, 0.41)))?;
    assert!(far < 2e-13, "Suslov's body: {far:e}");
    let stepper = ball().into_stepper(0.1)?;
    let momentum = stepper.project(Vector2::new(0.3, -0.2), Vector5::new(0.2, 0.4, 0.1, -0.3, 0.35))?.momentum();
    let far = returned(&ball(), (Vector2::new(0.3, -0.2), momentum))?;
    assert!(far < 2e-13, "the ball: {far:e}");
    Ok(())
}

#[test]
fn constraints_and_energies_stay_for_many_steps() -> Result<(), Error> {
    let system = sleigh();
    let stepper = system.stepper(0.05)?;
    let mut state = stepper.state_moving(Matrix3::identity(), Vector3::new(1.1, -0.8, 0.0))?;
    let energy = stepper.energy(&state);
    let (mut slipped, mut off) = (0.0_f64, 0.0_f64);
    for _ in 0..STEPS / 100 {
        state = stepper.advance(&state, 100)?;
        // N = Σξ: v_y = 0 says that m a ω = N_y, by hand
        let [n_omega, _, n_y] = *state.momentum().as_ref();
        let omega = (n_omega - system.offset * n_y) / system.inertia;
        slipped = slipped.max((n_y - system.mass * system.offset * omega).abs());
        off = off.max((stepper.energy(&state) - energy).abs());
    }
    assert!(slipped < 1e-14, "the blade slips by {slipped:e}");
    assert!(off < 1e-12, "the energy is off by {off:e}");

    let stepper = suslov().into_stepper(0.1)?;
    let inverse = suslov().inertia.try_inverse().unwrap();
    let mut state = stepper.state_moving(Matrix3::identity(), Vector3::new(0.9, -0.7, 0.0))?;
    let energy = stepper.energy(&state);
    let (mut turned, mut off) = (0.0_f64, 0.0_f64);
    for _ in 0..STEPS / 100 {
        state = stepper.advance(&state, 100)?;
        turned = turned.max((inverse * state.momentum()).z.abs());
        off = off.max((stepper.energy(&state) - energy).abs());
    }
    assert!(turned < 1e-15, "it turns about its third axis by {turned:e}");
    assert!(off < 1e-12, "the energy is off by {off:e}");
    Ok(())
}

/// J₁₃ω₁ + J₂₃ω₂ → 0: Suslov's body ends in a steady turn.
#[test]
fn suslovs_body_ends_in_a_steady_turn() -> Result<(), Error> {
    let stepper = suslov().into_stepper(0.1)?;
    let start = stepper.state_moving(Matrix3::identity(), Vector3::new(0.9, -0.7, 0.0))?;
    let end = stepper.advance(&start, 4000)?;
    let omega = suslov().inertia.try_inverse().unwrap() * end.momentum();
    assert!((0.3 * omega.x - 0.2 * omega.y).abs() < 1e-14, "{omega}");
    Ok(())
}

/// The contact point of the ball moves with the table.
#[test]
fn the_ball_rolls_without_slipping() -> Result<(), Error> {
    let system = ball();
    let stepper = system.stepper(0.1)?;
    let mut state = stepper.project(Vector2::new(0.3, -0.2), Vector5::new(0.2, 0.4, 0.1, -0.3, 0.35))?;
    let mut slipped = 0.0_f64;
    for _ in 0..STEPS / 100 {
        state = stepper.advance(&state, 100)?;
        let (x, n) = (state.configuration(), state.momentum());
        let (v, w) = (n.fixed_rows::<2>(0) / system.mass, n.fixed_rows::<3>(2) / system.inertia);
        slipped = slipped.max((v[0] - system.radius * w[1] + system.table_rate * x.y).abs());
        slipped = slipped.max((v[1] + system.radius * w[0] - system.table_rate * x.x).abs());
    }
    assert!(slipped < 1e-14, "{slipped:e}");
    Ok(())
}
