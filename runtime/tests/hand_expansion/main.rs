//! Two systems expanded by hand in the shape of the derive macro's output, and the promises of every stepper, tested on
//! them. They are a heavy top (implicit, on a group) and a driven pendulum (in closed form, with time, on a sphere).

mod boundary;
mod boundary_sphere;
mod driven_pendulum;
mod edges;
mod heavy_top;
mod time;

use clebsch::{Clebsch, Error, State, Stepper};
use heavy_top::HeavyTop;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Whether loops are long: where the variable `PROPTEST_CASES` asks for 256 cases or more.
fn is_long() -> bool {
    std::env::var("PROPTEST_CASES").is_ok_and(|cases| cases.parse().is_ok_and(|cases: u32| cases >= 256))
}

/// Steps of a run in which errors would add up; Miri, which interprets, takes few.
const MANY: usize = if cfg!(miri) { 10 } else { 10_000 };

fn top() -> HeavyTop {
    HeavyTop {
        mass_matrix: Matrix3::new(0.7, 0.02, 0.01, 0.02, 0.6, -0.03, 0.01, -0.03, 0.4),
        weight: 9.81,
        center: Vector3::new(0.02, -0.01, 0.3),
    }
}

/// A top without weight.
fn body() -> HeavyTop {
    HeavyTop { weight: 0.0, ..top() }
}

fn attitude() -> Matrix3<f64> {
    *Rotation3::from_scaled_axis(Vector3::new(0.9, 0.1, -0.4)).matrix()
}

fn momentum() -> Vector3<f64> {
    Vector3::new(0.4, -0.7, 1.3)
}

fn last<S: Clebsch>(stepper: &Stepper<S>, start: State<S>, steps: usize) -> Result<State<S>, Error> {
    stepper.trajectory(start).nth(steps).expect("a trajectory is endless until an error")
}

/// |a − b| in the largest entry.
macro_rules! assert_near {
    ($a:expr, $b:expr, $tolerance:expr) => {{
        let (a, b) = ($a, $b);
        let error = (a - b).amax();
        assert!(error <= $tolerance, "{a} and {b} differ by {error:e}");
    }};
}
pub(crate) use assert_near;

#[test]
fn legendre_transforms_are_inverted() -> Result<(), Error> {
    let stepper = top().stepper(0.05)?;
    let (q, mu) = (attitude(), momentum());
    let f = stepper.inverse_legendre(&q, &mu)?;
    assert_near!(stepper.legendre(&q, &f), mu, 1e-14);
    let next = stepper.step(&stepper.state(q, mu)?)?;
    assert_near!(stepper.legendre_next(&q, &f), next.momentum(), 1e-14);
    assert_near!(stepper.act(&f, &q), *next.configuration(), 1e-15);

    let stepper = body().stepper(0.05)?;
    let f = stepper.inverse_legendre(&q, &mu)?;
    assert_near!(stepper.legendre_next(&q, &f), stepper.coadjoint(&f, &mu), 1e-14);
    Ok(())
}

#[test]
fn both_representations_agree() -> Result<(), Error> {
    let stepper = top().stepper(0.05)?;
    // Any covector whose momentum is mu: P = R μ^/2.
    let (q, mu) = (attitude(), momentum());
    let p = q * stepper.momentum_matrix(&mu);
    let mut state = stepper.state(q, mu)?;
    let mut cotangent = stepper.cotangent_state(q, p)?;
    for _ in 0..MANY.min(100) {
        state = stepper.step(&state)?;
        cotangent = stepper.step_symmetric(&cotangent)?;
    }
    assert_near!(*state.configuration(), *cotangent.configuration(), 1e-12);
    assert_near!(state.momentum(), stepper.momentum_map(cotangent.configuration(), cotangent.covector()), 1e-12);
    Ok(())
}

#[test]
fn a_free_body_keeps_spatial_momentum_and_energy() -> Result<(), Error> {
    let stepper = body().stepper(0.1)?;
    let start = stepper.state(attitude(), momentum())?;
    let end = last(&stepper, start, MANY)?;
    let spatial = |state: &State<HeavyTop>| state.configuration() * state.momentum();
    assert_near!(spatial(&end), spatial(&start), 1e-12);
    assert!((stepper.energy(&end) / stepper.energy(&start) - 1.0).abs() < 1e-12);
    assert!(stepper.system().orbit_defect(end.configuration()) < 1e-12);
    Ok(())
}

#[test]
fn a_top_keeps_its_vertical_momentum_and_bounds_its_energy() -> Result<(), Error> {
    let stepper = top().stepper(0.01)?;
    let start = stepper.state(attitude(), momentum())?;
    let (vertical, energy) = (stepper.conserved(&start), stepper.energy(&start));
    assert_eq!(vertical.names(), &["about e3, spatial"]);
    for state in stepper.trajectory(start).take(MANY) {
        let state = state?;
        assert!((stepper.conserved(&state)[0] - vertical[0]).abs() < 1e-12);
        assert!((stepper.energy(&state) - energy).abs() < 2e-3);
    }
    Ok(())
}

#[test]
fn steps_are_reversed_by_the_opposite_step_size() -> Result<(), Error> {
    let (forward, backward) = (top().stepper(0.1)?, top().stepper(-0.1)?);
    let start = forward.state(attitude(), momentum())?;
    let (q, mu) = last(&forward, start, MANY.min(50))?.into_parts();
    let end = last(&backward, backward.state(q, mu)?, MANY.min(50))?;
    assert_near!(*end.configuration(), *start.configuration(), 1e-11);
    assert_near!(end.momentum(), start.momentum(), 1e-11);
    Ok(())
}

#[test]
fn the_order_is_two() -> Result<(), Error> {
    let end = |steps: usize| -> Result<Matrix3<f64>, Error> {
        let stepper = top().into_stepper(1.0 / steps as f64)?;
        let steps = if cfg!(miri) { steps / 10 } else { steps };
        Ok(*last(&stepper, stepper.state(attitude(), momentum())?, steps)?.configuration())
    };
    let (coarse, middle, fine) = (end(50)?, end(100)?, end(200)?);
    let order = ((coarse - middle).amax() / (middle - fine).amax()).log2();
    assert!((order - 2.0).abs() < 0.1, "measured order {order}");
    Ok(())
}

#[test]
fn kinetic_energy_is_the_limit_of_the_discrete_one() -> Result<(), Error> {
    let stepper = top().stepper(1e-3)?;
    let state = stepper.state(attitude(), momentum())?;
    let top = stepper.system();
    let inertia = Matrix3::identity() * top.mass_matrix.trace() - top.mass_matrix;
    let omega = inertia.lu().solve(&state.momentum()).expect("the inertia is regular");
    assert!((stepper.kinetic_energy(&state) - omega.dot(&(inertia * omega)) / 2.0).abs() < 1e-15);
    assert!((stepper.energy(&state) - stepper.kinetic_energy(&state) - stepper.potential(&attitude())).abs() < 1e-15);
    Ok(())
}

#[test]
fn parameters_are_checked() {
    assert!(matches!(top().stepper(0.0), Err(Error::StepSize { .. })));
    assert!(matches!(top().stepper(f64::NAN), Err(Error::StepSize { .. })));
    let mut broken = top();
    broken.center.y = f64::INFINITY;
    assert!(matches!(broken.stepper(0.1), Err(Error::NotFinite { name: "center" })));
    let mut skewed = top();
    skewed.mass_matrix[(0, 1)] += 1e-3;
    assert!(matches!(skewed.stepper(0.1), Err(Error::NotSymmetric { field: "mass_matrix", .. })));
    let point = HeavyTop { mass_matrix: Matrix3::zeros(), ..top() };
    assert!(matches!(point.stepper(0.1), Err(Error::SingularKineticEnergy { .. })));
}

#[test]
fn states_are_checked() -> Result<(), Error> {
    let stepper = top().stepper(0.1)?;
    let mirrored = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0));
    assert!(matches!(stepper.state(mirrored, momentum()), Err(Error::OffOrbit { defect: f64::INFINITY, .. })));
    assert!(matches!(stepper.project(mirrored, momentum()), Err(Error::OffOrbit { .. })));
    assert!(matches!(stepper.state(attitude() * 1.001, momentum()), Err(Error::OffOrbit { .. })));
    assert!(matches!(stepper.state(attitude() * f64::NAN, momentum()), Err(Error::NotFinite { .. })));
    assert!(matches!(stepper.state(attitude(), momentum() * f64::NAN), Err(Error::NotFinite { name: "the momentum" })));
    assert!(matches!(stepper.cotangent_state(attitude(), attitude() / 0.0), Err(Error::NotFinite { .. })));
    Ok(())
}

#[test]
fn a_step_that_is_too_long_says_how_much() -> Result<(), Error> {
    let mass_matrix = Matrix3::from_diagonal(&Vector3::new(2.5, 1.5, 0.5));
    let stepper = HeavyTop { mass_matrix, ..body() }.into_stepper(0.5)?;
    // About the second axis, of moment 3, the equation is sin θ = h π / I = 1.25.
    let start = stepper.state(attitude(), Vector3::new(0.0, 7.5, 0.0))?;
    let error = stepper.step(&start).expect_err("sin θ cannot be 1.25");
    let Error::Unsolvable { solvable_fraction, step_size, solvable_step: Some(longest) } = error else {
        panic!("{error}")
    };
    assert!((solvable_fraction - 0.8).abs() < 1e-3, "{solvable_fraction}");
    assert_eq!(step_size, Some(0.5));
    let (text, longest_told) = (error.to_string(), format!("reduce the step size to {:.3e} or less", 0.9995 * longest));
    assert!(text.contains("the step of 5.000e-1 is too long for this momentum"), "{text}");
    assert!(text.contains("a solution up to 0.800 times it") && text.contains(&longest_told), "{text}");
    let stepped = |h: f64| stepper.system().stepper(h)?.step(&start);
    assert!(stepped(longest).is_ok() && stepped(1.05 * longest).is_err(), "{longest} is not the longest");
    let items: Vec<_> = stepper.trajectory(start).take(5).collect();
    assert_eq!(items, [Ok(start), Err(error)]);
    Ok(())
}

#[test]
fn a_body_at_rest_stays() -> Result<(), Error> {
    let stepper = body().stepper(0.1)?;
    let start = stepper.state(attitude(), Vector3::zeros())?;
    assert_eq!(stepper.step(&start)?, start);
    Ok(())
}

/// The impulse that a state brings along is for the step size of its maker. A stepper of −h has to lead back all the
/// same.
#[test]
fn a_state_goes_on_with_another_step_size() -> Result<(), Error> {
    let (forth, back) = (top().into_stepper(0.01)?, top().into_stepper(-0.01)?);
    let start = forth.state(attitude(), momentum())?;
    let there = last(&forth, start, MANY.min(50))?;
    let again = last(&back, there, MANY.min(50))?;
    assert!((again.configuration() - start.configuration()).amax() < 1e-12);
    assert!((again.momentum() - start.momentum()).amax() < 1e-12);
    Ok(())
}
