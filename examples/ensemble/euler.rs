//! The exact body momentum of a free rigid body, by Jacobi's elliptic functions: nothing is shared with the steps.

use clebsch_examples::jacobi::Jacobi;
use nalgebra::Vector3;

/// π(t) of a body with moments A < B < C.
///
/// With E2 = π·J⁻¹π and L² = |π|² ≥ B E2, and with A and C exchanged otherwise,
/// ```text
/// ω₁ = a₁ cn τ,    ω₂ = a₂ sn τ,    ω₃ = a₃ dn τ,    τ = τ₀ + λt
/// a₁² = (C E2 − L²)/(A(C − A)),    a₂² = (C E2 − L²)/(B(C − B)),    a₃² = (L² − A E2)/(C(C − A)),
/// λ² = (C − B)(L² − A E2)/ABC,    k² = (B − A)(C E2 − L²)/((C − B)(L² − A E2)).
/// ```
/// Source: Landau and Lifshitz, *Mechanics*, §37.
#[derive(Clone, Copy, Debug)]
pub struct Euler {
    moments: Vector3<f64>,
    /// a₁, a₂, a₃ with the sign of ω₃ for the first and the last.
    amplitudes: [f64; 3],
    functions: Jacobi,
    /// τ₀
    phase: f64,
    /// λ
    rate: f64,
    /// Whether the first and the third axis are exchanged.
    is_exchanged: bool,
}

impl Euler {
    /// From the start; `None` where the functions have none of their parameter, as at rest and for equal moments.
    pub fn new(moments: &Vector3<f64>, start: &Vector3<f64>) -> Option<Self> {
        let double_energy = start.dot(&start.component_div(moments));
        let square = start.norm_squared();
        let is_exchanged = square < moments.y * double_energy;
        let [a, b, c] = exchanged((*moments).into(), is_exchanged);
        let omega = exchanged(start.component_div(moments).into(), is_exchanged);
        // C E2 − L² and L² − A E2, without their cancellation near the axes
        let inertia = [a, b, c];
        let relative =
            |i: usize| (0..3).map(|j| inertia[j] * (inertia[i] - inertia[j]) * omega[j] * omega[j]).sum::<f64>();
        let (below, above) = (relative(2), -relative(0));
        let amplitudes = [below / (a * (c - a)), below / (b * (c - b)), above / (c * (c - a))].map(f64::sqrt);
        let (small, large) = ((b - a) * below, (c - b) * above);
        // (C − B)(L² − A E2) − (B − A)(C E2 − L²) = (C − A)(L² − B E2)
        let functions = Jacobi::new(small / large, ((c - a) * relative(1) / large).abs())?;
        let sign = omega[2].signum();
        let phase = functions.argument((omega[1] / amplitudes[1]).atan2(sign * omega[0] / amplitudes[0]));
        let amplitudes = [sign * amplitudes[0], amplitudes[1], sign * amplitudes[2]];
        let rate = (large / (a * b * c)).sqrt();
        Some(Self { moments: *moments, amplitudes, functions, phase, rate, is_exchanged })
    }

    /// π(t)
    pub fn momentum(&self, time: f64) -> Vector3<f64> {
        let (amplitude, _) = self.functions.amplitude(self.phase + self.rate * time);
        let [a1, a2, a3] = self.amplitudes;
        let omega = [a1 * amplitude.cos(), a2 * amplitude.sin(), a3 * self.functions.delta(amplitude)];
        Vector3::from(exchanged(omega, self.is_exchanged)).component_mul(&self.moments)
    }
}

fn exchanged([x, y, z]: [f64; 3], is_exchanged: bool) -> [f64; 3] {
    if is_exchanged { [z, y, x] } else { [x, y, z] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both modes and both signs: the start is met, and π̇ = π × J⁻¹π by differences.
    #[test]
    fn solutions_satisfy_eulers_equations() {
        let moments = Vector3::new(1.0, 2.0, 2.5);
        for start in [[0.1, 2.0, 0.05], [0.01, 2.0, 0.3], [-0.2, -1.5, 0.1], [0.02, 1.0, -0.4]].map(Vector3::from) {
            let exact = Euler::new(&moments, &start).expect("a motion");
            assert!((exact.momentum(0.0) - start).amax() < 1e-14, "{start}");
            for time in [0.3, 4.0, 17.0, 33.0] {
                let pi = exact.momentum(time);
                let difference = (exact.momentum(time + 1e-4) - exact.momentum(time - 1e-4)) / 2e-4;
                assert!((difference - pi.cross(&pi.component_div(&moments))).amax() < 1e-7, "{start} {time}");
            }
        }
    }
}
