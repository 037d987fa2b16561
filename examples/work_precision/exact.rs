//! The motion to compare with: in functions where it is known, else equations of motion in matrices by the classical Runge–Kutta method with tiny steps.

use crate::classical::runge_kutta;
use crate::motion::Scene;
use crate::setting::SAMPLES;
use clebsch_examples::claims::largest;
use nalgebra::SVector;

/// The motion at the samples, the start first.
pub struct Exact<const N: usize> {
    /// At the multiples of duration/[`SAMPLES`].
    pub samples: Vec<SVector<f64, N>>,
    /// By how much half as many steps differ: 16 times the error of the method, or its rounding. That of functions where they tell the motion.
    pub error: f64,
}

/// Integrates twice, where the motion is not known in functions.
pub fn exact<const N: usize>(scene: &Scene<N>) -> Exact<N> {
    if let Some(known) = &scene.known {
        let times = (0..=SAMPLES).map(|sample| scene.duration * sample as f64 / SAMPLES as f64);
        let (samples, errors): (Vec<_>, Vec<_>) = times.map(known).unzip();
        return Exact { samples, error: largest(errors) };
    }
    let samples = integrate(scene, scene.reference_steps);
    let coarse = integrate(scene, scene.reference_steps / 2);
    let differences = samples.iter().zip(&coarse).map(|(fine, coarse)| scene.distance(coarse, fine));
    let error = largest(differences);
    Exact { samples, error }
}

/// With compensated summation, so that rounding does not add up over many steps.
fn integrate<const N: usize>(scene: &Scene<N>, steps: u64) -> Vec<SVector<f64, N>> {
    let h = scene.duration / (SAMPLES * steps) as f64;
    let (mut y, mut carry) = (scene.start, SVector::zeros());
    let mut samples = vec![y];
    for _ in 0..SAMPLES {
        for _ in 0..steps {
            let change = runge_kutta(&scene.field, &y, h) - carry;
            let next = y + change;
            carry = (next - y) - change;
            y = next;
        }
        samples.push(y);
    }
    samples
}
