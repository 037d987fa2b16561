//! Elliptic integrals: the complete ones by the arithmetic–geometric mean, a symmetric one by duplication.

use std::f64::consts::FRAC_PI_2;

/// K(m) and Π(n, m), parameter m = k².
#[derive(Clone, Copy, Debug)]
pub struct Complete {
    /// K(m) = ∫₀^{π/2} dφ / √(1 − m sin²φ).
    pub first: f64,
    /// Π(n, m) / K(m): the mean of 1/(1 − n sn²) over a period.
    pub third_over_first: f64,
}

/// The integrals for 0 ≤ m < 1 and n < 1; `None` elsewhere.
///
/// Converges quadratically, to a few units in the last place. Source: DLMF, §19.8(i), equations 19.8.5 to 19.8.7.
pub fn complete(n: f64, m: f64) -> Option<Complete> {
    if !(0.0..1.0).contains(&m) || !n.is_finite() || n >= 1.0 {
        return None;
    }
    let (mut a, mut g) = (1.0, (1.0 - m).sqrt());
    let (mut p, mut q, mut sum) = ((1.0 - n).sqrt(), 1.0, 1.0);
    // The gap of the means squares itself each time; q falls at least by a half.
    for _ in 0..64 {
        let ratio = (p * p - a * g) / (p * p + a * g);
        p = (p * p + a * g) / (2.0 * p);
        q *= ratio / 2.0;
        sum += q;
        (a, g) = ((a + g) / 2.0, (a * g).sqrt());
        if q.abs() <= f64::EPSILON * sum.abs() && a - g <= 4.0 * f64::EPSILON * a {
            break;
        }
    }
    Some(Complete { first: FRAC_PI_2 / a, third_over_first: 1.0 + n / (2.0 * (1.0 - n)) * sum })
}

/// R_D(x, y, z) = 3/2 ∫₀^∞ dt / ((t + z) √((t + x)(t + y)(t + z))) for positive arguments; NaN elsewhere.
///
/// Each duplication divides the differences of the arguments by 4. Source: DLMF, §19.36(i) and equation 19.36.2; Carlson (1995).
pub fn carlson_d(x: f64, y: f64, z: f64) -> f64 {
    if !(x > 0.0 && y > 0.0 && z > 0.0) {
        return f64::NAN;
    }
    let (mut x, mut y, mut z, mut sum, mut factor) = (x, y, z, 0.0, 1.0);
    // 4⁻¹⁶ of any relative difference, to the sixth power, is below ε.
    for _ in 0..16 {
        let lambda = (x * y).sqrt() + (x * z).sqrt() + (y * z).sqrt();
        sum += factor / (z.sqrt() * (z + lambda));
        factor /= 4.0;
        (x, y, z) = ((x + lambda) / 4.0, (y + lambda) / 4.0, (z + lambda) / 4.0);
    }
    3.0 * sum + factor * ((x + y + 3.0 * z) / 5.0).powf(-1.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The defining integrals by the trapezoidal rule, which converges geometrically for periodic integrands.
    fn by_quadrature(n: f64, m: f64) -> (f64, f64) {
        let points = 4000;
        let sum = |f: &dyn Fn(f64) -> f64| {
            let total: f64 =
                (0..points).map(|i| f((f64::from(i) / f64::from(points) * 4.0 * FRAC_PI_2).sin().powi(2))).sum();
            total * FRAC_PI_2 / f64::from(points)
        };
        let first = sum(&|s| 1.0 / (1.0 - m * s).sqrt());
        (first, sum(&|s| 1.0 / ((1.0 - n * s) * (1.0 - m * s).sqrt())) / first)
    }

    #[test]
    fn agree_with_the_integrals() {
        for (n, m) in [(0.0, 0.0), (0.3, 0.5), (-0.7, 0.2), (-40.0, 0.9), (0.9, 0.03), (-0.01, 0.99)] {
            let value = complete(n, m).unwrap();
            let (first, ratio) = by_quadrature(n, m);
            assert!((value.first / first - 1.0).abs() < 1e-13, "K({m}) = {} against {first}", value.first);
            assert!((value.third_over_first / ratio - 1.0).abs() < 1e-13, "Π({n}, {m})/K");
        }
    }

    /// Equal arguments give x^(−3/2); R_D(x, y, z) summed over the three places of z is 3/√(xyz) (DLMF, 19.21.9).
    #[test]
    fn carlsons_integral_has_its_sum() {
        assert!((carlson_d(4.0, 4.0, 4.0) - 0.125).abs() < 1e-16);
        for (x, y, z) in [(1.0, 2.0, 3.0), (1e-3, 1.0, 50.0), (0.16, 0.16, 1.44)] {
            let sum = carlson_d(x, y, z) + carlson_d(y, z, x) + carlson_d(z, x, y);
            assert!((sum * (x * y * z).sqrt() / 3.0 - 1.0).abs() < 1e-14, "{x} {y} {z}");
        }
        assert!(carlson_d(0.0, 1.0, 1.0).is_nan());
    }

    #[test]
    fn outside_of_their_range_there_is_none() {
        assert!(complete(0.0, 1.0).is_none() && complete(1.0, 0.5).is_none() && complete(0.0, f64::NAN).is_none());
    }
}
