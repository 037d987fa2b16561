//! The promises of a stepper where the time matters, and where not all momenta are those of motions.

use crate::driven_pendulum::DrivenPendulum;
use crate::heavy_top::HeavyTop;
use crate::{MANY, assert_near, last};
use clebsch::{Clebsch, Error, State};
use nalgebra::{Matrix3, Vector3};

fn pendulum() -> DrivenPendulum {
    DrivenPendulum { mass: 0.7, length: 1.3, gravity: 9.81, shake: 40.0, rate: 7.0 }
}

fn bob() -> Vector3<f64> {
    Vector3::new(0.48, 0.6, -0.64)
}

/// Of a motion: orthogonal to the bob.
fn momentum() -> Vector3<f64> {
    bob().cross(&Vector3::new(0.3, -0.8, 1.1))
}

/// The bob from t to `end` by the classical Runge–Kutta method for q′ = ω × q, ω = N/(ml²), N′ = −q × ∇V(t, q).
fn reference(t: f64, end: f64, steps: u32) -> Vector3<f64> {
    let p = pendulum();
    let slope = |t: f64, [q, n]: [Vector3<f64>; 2]| {
        let weight = p.mass * p.length * (p.gravity + p.shake * (p.rate * t).cos());
        [n.cross(&q) / (p.mass * p.length * p.length), Vector3::z().cross(&q) * weight]
    };
    let along = |[q, n]: [Vector3<f64>; 2], [dq, dn]: [Vector3<f64>; 2], h: f64| [q + dq * h, n + dn * h];
    let h = (end - t) / f64::from(steps);
    let mut state = [bob(), momentum()];
    for step in 0..steps {
        let t = t + f64::from(step) * h;
        let k1 = slope(t, state);
        let k2 = slope(t + h / 2.0, along(state, k1, h / 2.0));
        let k3 = slope(t + h / 2.0, along(state, k2, h / 2.0));
        let k4 = slope(t + h, along(state, k3, h));
        for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            state = along(state, k, weight * h / 6.0);
        }
    }
    state[0]
}

#[test]
fn states_carry_the_time() -> Result<(), Error> {
    let stepper = pendulum().stepper(0.1)?;
    assert_eq!(stepper.state(bob(), momentum())?.time(), 0.0);
    assert_eq!(stepper.cotangent_state(bob(), momentum())?.time(), 0.0);
    let (start, p) = (stepper.state_at(2.5, bob(), momentum())?, Vector3::new(0.1, 0.0, 0.2));
    assert_eq!(last(&stepper, start, 7)?.time(), 2.5 + 7.0 * 0.1);
    assert_eq!(stepper.step_symmetric(&stepper.cotangent_state_at(2.5, bob(), p)?)?.time(), 2.6);
    assert_ne!(start, stepper.state_at(2.0, bob(), momentum())?);
    assert!(format!("{start:?}").starts_with("State { time: 2.5, "));
    let broken = stepper.state_at(f64::NAN, bob(), momentum());
    assert_eq!(broken, Err(Error::NotFinite { name: "the time" }));
    Ok(())
}

/// q, N, the impulse and the step size that it is for.
#[test]
fn states_without_time_have_no_room_for_it() {
    assert_eq!(size_of::<State<HeavyTop>>(), size_of::<(Matrix3<f64>, Vector3<f64>, Vector3<f64>, f64)>());
}

/// Against an independent method, from a time that is not 0.
#[test]
fn the_order_is_two_where_the_time_matters() -> Result<(), Error> {
    let (time, fine_steps) = if cfg!(miri) { (0.05, 50) } else { (1.0, 20_000) };
    let exact = reference(0.3, 0.3 + time, fine_steps);
    let error = |steps: usize| -> Result<f64, Error> {
        let steps = if cfg!(miri) { steps / 20 } else { steps };
        let stepper = pendulum().into_stepper(time / steps as f64)?;
        let end = last(&stepper, stepper.state_at(0.3, bob(), momentum())?, steps)?;
        Ok((end.configuration() - exact).amax())
    };
    let (coarse, fine) = (error(200)?, error(400)?);
    assert!(fine < 1e-3 && ((coarse / fine).log2() - 2.0).abs() < 0.05, "{coarse} {fine}");
    Ok(())
}

#[test]
fn formulas_take_the_time_of_the_step() -> Result<(), Error> {
    let stepper = pendulum().stepper(0.02)?;
    let (t, q, mu) = (0.3, bob(), momentum());
    let f = stepper.inverse_legendre_at(t, &q, &mu)?;
    let next = stepper.step(&stepper.state_at(t, q, mu)?)?;
    assert_near!(stepper.legendre_at(t, &q, &f), mu, 1e-14);
    assert_near!(stepper.legendre_next_at(t, &q, &f), next.momentum(), 1e-14);
    let energy = stepper.kinetic_energy(&next) + stepper.potential_at(t + 0.02, next.configuration());
    assert!((stepper.energy(&next) - energy).abs() < 1e-14);
    assert!(stepper.potential_at(0.0, &q) < stepper.potential_at(0.5, &q) - 10.0);
    Ok(())
}

#[test]
fn both_representations_agree_in_time() -> Result<(), Error> {
    let stepper = pendulum().stepper(0.01)?;
    let p = momentum().cross(&bob());
    let mut state = stepper.state_at(0.3, bob(), stepper.momentum_map(&bob(), &p))?;
    let mut cotangent = stepper.cotangent_state_at(0.3, bob(), p)?;
    for _ in 0..MANY.min(100) {
        state = stepper.step(&state)?;
        cotangent = stepper.step_symmetric(&cotangent)?;
    }
    assert_near!(*state.configuration(), *cotangent.configuration(), 1e-12);
    assert_eq!(state.time(), cotangent.time());
    Ok(())
}

#[test]
fn time_runs_back() -> Result<(), Error> {
    let (forward, backward) = (pendulum().stepper(0.01)?, pendulum().stepper(-0.01)?);
    let start = forward.state_at(0.3, bob(), momentum())?;
    let turned = last(&forward, start, MANY.min(100))?;
    let turned = backward.state_at(turned.time(), *turned.configuration(), turned.momentum())?;
    let end = last(&backward, turned, MANY.min(100))?;
    assert_near!(*end.configuration(), *start.configuration(), 1e-12);
    assert!((end.time() - 0.3).abs() < 1e-15);
    Ok(())
}

#[test]
fn driving_keeps_the_vertical_momentum() -> Result<(), Error> {
    let stepper = pendulum().stepper(0.01)?;
    let start = stepper.state(bob(), momentum())?;
    let end = last(&stepper, start, MANY)?;
    assert!((stepper.conserved(&end)[0] - stepper.conserved(&start)[0]).abs() < 1e-12);
    assert!((stepper.energy(&end) - stepper.energy(&start)).abs() > 1e-2, "an energy that is driven changes");
    Ok(())
}

#[test]
fn momenta_of_no_motion_are_refused_and_projected() -> Result<(), Error> {
    let stepper = pendulum().stepper(0.01)?;
    let spinning = momentum() + bob() * 0.25;
    let refused = stepper.state(bob(), spinning).expect_err("a spin about the bob");
    let Error::OutsideMomentumSpace { violation, .. } = refused else { panic!("{refused}") };
    assert!((violation - 0.25).abs() < 1e-15);
    let projected = stepper.project(bob(), spinning)?.momentum();
    assert_near!(projected, momentum(), 1e-15);
    stepper.state(bob(), projected)?;
    assert!(matches!(stepper.project(bob(), spinning / 0.0), Err(Error::NotFinite { name: "the momentum" })));
    assert!(matches!(stepper.project(bob() * 2.0, spinning), Err(Error::OffOrbit { .. })));
    Ok(())
}
