//! Jacobi's elliptic functions by the arithmetic–geometric mean, and the integral that inverts them by duplication.

use std::f64::consts::{FRAC_PI_2, PI};

/// Steps of the mean at most: the gap of the means squares itself each time, so that a dozen serve any modulus.
const STEPS: usize = 32;

/// The functions for one parameter m = k², 0 ≤ m ≤ 1.
#[derive(Clone, Copy, Debug)]
pub struct Jacobi {
    /// 1 − m
    complement: f64,
    /// a_n and g_n, and c_n for n ≥ 1.
    means: [[f64; 3]; STEPS],
    last: usize,
    /// E(m)/K(m)
    ratio: f64,
}

impl Jacobi {
    /// For m, given with 1 − m so that nothing is lost near m = 1; `None` outside of 0 ≤ m ≤ 1.
    ///
    /// Source: DLMF, §22.20(ii) and equation 19.8.6.
    pub fn new(m: f64, complement: f64) -> Option<Self> {
        if !((0.0..=1.0).contains(&m) && (0.0..=1.0).contains(&complement)) {
            return None;
        }
        let (mut a, mut g) = (1.0, complement.sqrt());
        let mut functions = Self { complement, means: [[a, g, 0.0]; STEPS], last: 0, ratio: 1.0 - m / 2.0 };
        let mut power = 1.0;
        while functions.last + 1 < STEPS && complement > 0.0 {
            let c = (a - g) / 2.0;
            (a, g) = ((a + g) / 2.0, (a * g).sqrt());
            functions.last += 1;
            functions.means[functions.last] = [a, g, c];
            functions.ratio -= power * c * c;
            power *= 2.0;
            if c <= f64::EPSILON * a {
                break;
            }
        }
        Some(functions)
    }

    /// K(m), the quarter of a period.
    pub fn quarter(&self) -> f64 {
        if self.complement > 0.0 { FRAC_PI_2 / self.means[self.last][0] } else { f64::INFINITY }
    }

    /// The amplitude am(u), and ε(u) = ∫₀ᵘ dn² du.
    ///
    /// sn = sin am, cn = cos am. Source: DLMF, equations 22.20.3 to 22.20.5 and §22.16(ii).
    pub fn amplitude(&self, u: f64) -> (f64, f64) {
        if self.complement == 0.0 {
            return (u.tanh().asin(), u.tanh());
        }
        let mut phi = 2_f64.powi(self.last as i32) * self.means[self.last][0] * u;
        let mut epsilon = self.ratio * u;
        for &[a, g, c] in self.means[1..=self.last].iter().rev() {
            let (sin, cos) = phi.sin_cos();
            epsilon += c * sin;
            // asin(c/a sin φ) with a² = c² + g², which has all digits where m is near 1
            phi = (phi + (c * sin).atan2((a * cos).hypot(g * sin))) / 2.0;
        }
        (phi, epsilon)
    }

    /// dn = √(1 − m sin²φ) at the amplitude φ.
    pub fn delta(&self, phi: f64) -> f64 {
        phi.cos().hypot(self.complement.sqrt() * phi.sin())
    }

    /// F(φ, m) = ∫₀^φ dφ/√(1 − m sin²φ), the u whose amplitude is φ. Infinite at π/2 and beyond where m = 1.
    ///
    /// Source: DLMF, equations 19.25.5 and 19.2.10.
    pub fn argument(&self, phi: f64) -> f64 {
        let turns = (phi / PI).round();
        let (sin, cos) = (phi - turns * PI).sin_cos();
        if self.complement == 0.0 {
            return if turns == 0.0 { sin.atanh() } else { f64::INFINITY.copysign(phi) };
        }
        let delta = self.delta(phi);
        2.0 * turns * self.quarter() + sin * carlson_f(cos * cos, delta * delta, 1.0)
    }
}

/// R_F(x, y, z) = ½ ∫₀^∞ dt/√((t + x)(t + y)(t + z)), no more than one argument zero.
///
/// Each duplication divides the differences of the arguments by 4. Source: DLMF, §19.36(i).
fn carlson_f(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    for _ in 0..30 {
        let lambda = (x * y).sqrt() + (x * z).sqrt() + (y * z).sqrt();
        (x, y, z) = ((x + lambda) / 4.0, (y + lambda) / 4.0, (z + lambda) / 4.0);
    }
    ((x + y + z) / 3.0).sqrt().recip()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elliptic::complete;
    use crate::reference::solve;
    use nalgebra::Vector4;

    /// sn, cn, dn and ε are integrated: (cn dn, −sn dn, −m sn cn, dn²) are their derivatives.
    #[test]
    fn amplitudes_solve_their_equations() {
        for (m, u) in
            [(0.0, 2.0), (0.3, 1.7), (0.9, -4.0), (0.999_999, 4.0), (1.0 - 1e-15, 3.0), (1.0, 3.0), (0.5, 20.0)]
        {
            let functions = Jacobi::new(m, 1.0 - m).expect("a parameter");
            let (phi, epsilon) = functions.amplitude(u);
            let field = |y: &Vector4<f64>| Vector4::new(y.y * y.z, -y.x * y.z, -m * y.x * y.y, y.z * y.z);
            let expected = solve(field, Vector4::new(0.0, 1.0, 1.0, 0.0), u, 2.0).end;
            let found = Vector4::new(phi.sin(), phi.cos(), functions.delta(phi), epsilon);
            assert!((found - expected).amax() < 3e-12, "{m} {u}: {found} after {expected}");
        }
    }

    #[test]
    fn arguments_invert_amplitudes() {
        for m in [0.0, 0.4, 0.97, 1.0] {
            let functions = Jacobi::new(m, 1.0 - m).expect("a parameter");
            for u in [-9.0, -1.0, 0.0, 0.3, 2.0, 6.0] {
                let back = functions.argument(functions.amplitude(u).0);
                // where m = 1 the amplitude is within e^(−u) of π/2
                assert!((back - u).abs() < 1e-13 * f64::exp(u.abs()), "{m}: {back} after {u}");
            }
        }
        let functions = Jacobi::new(0.4, 0.6).expect("a parameter");
        assert!((functions.quarter() - complete(0.0, 0.4).expect("a parameter").first).abs() < 1e-15);
        assert!(Jacobi::new(1.5, -0.5).is_none() && Jacobi::new(f64::NAN, 0.0).is_none());
    }
}
