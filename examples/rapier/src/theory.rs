//! Motions of a free body that use neither clebsch nor rapier.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Moments of the body that turns over, kg·m².
pub const MOMENTS: [f64; 3] = [1.0, 2.0, 3.0];
/// Its angular velocity about these axes, rad/s.
pub const RATE: [f64; 3] = [0.05, 30.0, 0.02];
/// The usual step, s.
pub const STEP: f64 = 1.0 / 60.0;

/// How often a free body turns over in each second: how often the rate about its middle axis changes its sign.
///
/// `moments` rise, and `rate` is the angular velocity about the principal axes. With L and T from these,
///
/// ```text
/// ω₂ ∝ sn(λt + …, k),  λ² = (J₃ − J₂)(L² − 2T J₁) / J₁J₂J₃,  k² = (J₂ − J₁)(2T J₃ − L²) / (J₃ − J₂)(L² − 2T J₁)
/// ```
///
/// and sn changes its sign after each 2K(k). J₁ and J₃ change places where L² < 2T J₂.
/// Source: Landau and Lifshitz, Mechanics, §37. K by the arithmetic–geometric mean, DLMF 19.8.5.
pub fn turns_per_second(moments: [f64; 3], rate: [f64; 3]) -> f64 {
    let [mut first, middle, mut third] = moments;
    let momentum: f64 = (0..3).map(|i| (moments[i] * rate[i]).powi(2)).sum();
    let energy: f64 = (0..3).map(|i| moments[i] * rate[i].powi(2)).sum();
    if momentum < energy * middle {
        (first, third) = (third, first);
    }
    let lambda = ((third - middle) * (momentum - energy * first) / (first * middle * third)).sqrt();
    let modulus = (middle - first) * (energy * third - momentum) / ((third - middle) * (momentum - energy * first));
    let (mut a, mut g) = (1.0, (1.0 - modulus).sqrt());
    for _ in 0..32 {
        (a, g) = ((a + g) / 2.0, (a * g).sqrt());
    }
    lambda / (std::f64::consts::PI / a)
}

/// The attitude after `time`, by Euler's equations and the classical method of fourth order. In each of its steps the body turns by 10⁻³ rad.
///
/// `rate` is the angular velocity about the principal axes, and the attitude is that of these axes.
pub fn attitude(
    moments: Vector3<f64>,
    start: UnitQuaternion<f64>,
    rate: Vector3<f64>,
    time: f64,
) -> UnitQuaternion<f64> {
    let steps = (time * rate.norm() / 1e-3).ceil().max(1.0);
    let h = time / steps;
    let slope = |q: &Quaternion<f64>, w: &Vector3<f64>| {
        let torque = moments.component_mul(w).cross(w);
        (q * Quaternion::from_imag(*w) * 0.5, torque.component_div(&moments))
    };
    let (mut q, mut w) = (start.into_inner(), rate);
    for _ in 0..steps as u64 {
        let (q1, w1) = slope(&q, &w);
        let (q2, w2) = slope(&(q + q1 * (h / 2.0)), &(w + w1 * (h / 2.0)));
        let (q3, w3) = slope(&(q + q2 * (h / 2.0)), &(w + w2 * (h / 2.0)));
        let (q4, w4) = slope(&(q + q3 * h), &(w + w3 * h));
        q += (q1 + q2 * 2.0 + q3 * 2.0 + q4) * (h / 6.0);
        w += (w1 + w2 * 2.0 + w3 * 2.0 + w4) * (h / 6.0);
    }
    UnitQuaternion::new_normalize(q)
}
