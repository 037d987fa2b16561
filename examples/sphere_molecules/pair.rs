//! Two molecules near the distance at which they rest, against the frequency of their small oscillation.

use crate::{Flags, Molecules};
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::Failure;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// How far they are from rest, rad.
const AMPLITUDE: f64 = 1e-6;
/// Steps of a period.
const STEPS: u32 = 1000;

/// Claims that they pass their place of rest after a quarter of the period: ω² = 2V″(r₀) cos²(θ₀/2). Here V″(r₀) = 36
/// ∛4 ε/σ² and r₀ = ⁶√2 σ = 2 sin(θ₀/2), as the angle between them has half the mass of one.
pub fn claim(flags: &Flags, claims: &mut Claims) -> Result<(), Failure> {
    let size = 0.3;
    let half = (2.0_f64.powf(1.0 / 6.0) * size / 2.0).asin();
    let omega = (72.0 * 4.0_f64.cbrt() * flags.depth).sqrt() / size * half.cos();
    let place = |angle: f64| Vector3::new(angle.cos(), angle.sin(), 0.0);
    let start = half + AMPLITUDE / 2.0;
    let stepper = Molecules::<2> { size, depth: flags.depth }.into_stepper(TAU / omega / f64::from(STEPS))?;
    let mut state = stepper.state([place(start), place(-start)], [Vector3::zeros(); 2])?;
    for step in 1..=u64::from(STEPS / 4) {
        state = stepper.step(&state).map_err(|error| Failure::Step { step, error })?;
    }
    let [first, second] = *state.configuration();
    let angle = (first.y.atan2(first.x) - second.y.atan2(second.x)) / 2.0;
    let name = "a pair passes its place of rest after a quarter of its period";
    claims.at_most(
        name,
        (angle - half).abs() / (AMPLITUDE / 2.0),
        1e-4,
        "of the amplitude; what is not harmonic is 3e-5",
    );
    Ok(())
}
