//! Closed solutions of u_tt − u_xx + sin u = 0.
//!
//! Source: Drazin and Johnson, *Solitons: an Introduction* (1989), for all three.

use std::f64::consts::PI;

/// A solution.
#[derive(Clone, Copy, Debug)]
pub enum Soliton {
    /// A kink of this speed: u = 4 arctan exp γ(x − vt).
    Kink(f64),
    /// A kink and an antikink meet at t = 0: u = 4 arctan(sinh(γvt)/(v cosh γx)).
    Pair(f64),
    /// A breather of this frequency: u = 4 arctan(β sin(ωt)/(ω cosh βx)) with β = √(1 − ω²).
    Breather(f64),
}

impl Soliton {
    /// u and u_t.
    pub fn at(&self, x: f64, t: f64) -> [f64; 2] {
        // u = 4 arctan f
        let (f, rate) = match *self {
            Self::Kink(v) => {
                let gamma = lorentz(v);
                let f = (gamma * (x - v * t)).exp();
                (f, -gamma * v * f)
            }
            Self::Pair(v) => {
                let gamma = lorentz(v);
                let (angle, across) = (gamma * v * t, (gamma * x).cosh());
                (angle.sinh() / (v * across), gamma * angle.cosh() / across)
            }
            Self::Breather(omega) => {
                let beta = (1.0 - omega * omega).sqrt();
                let across = (beta * x).cosh();
                (beta * (omega * t).sin() / (omega * across), beta * (omega * t).cos() / across)
            }
        };
        [4.0 * f.atan(), 4.0 * rate / (1.0 + f * f)]
    }

    /// J.
    pub fn energy(&self) -> f64 {
        match *self {
            Self::Kink(v) => 8.0 * lorentz(v),
            Self::Pair(v) => 16.0 * lorentz(v),
            Self::Breather(omega) => 16.0 * (1.0 - omega * omega).sqrt(),
        }
    }
}

/// 1/√(1 − v²)
pub fn lorentz(v: f64) -> f64 {
    1.0 / (1.0 - v * v).sqrt()
}

/// Where u passes through π upwards, between sites by a straight line; NaN where it does not.
pub fn middle(angles: &[f64], places: impl Iterator<Item = f64>) -> f64 {
    let points: Vec<(f64, f64)> = places.zip(angles.iter().copied()).collect();
    let passes = |pair: &&[(f64, f64)]| pair[0].1 < PI && pair[1].1 >= PI;
    points.windows(2).find(passes).map_or(f64::NAN, |pair| {
        let ((x, u), (next, after)) = (pair[0], pair[1]);
        x + (next - x) * (PI - u) / (after - u)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u_tt − u_xx + sin u = 0 and u_t, by differences.
    #[test]
    fn solitons_solve_the_equation() {
        let d = 1e-3;
        for soliton in [Soliton::Kink(0.4), Soliton::Pair(0.6), Soliton::Breather(0.3)] {
            for (x, t) in [(0.3, -0.7), (-1.2, 2.0), (2.5, 0.1)] {
                let u = |x: f64, t: f64| soliton.at(x, t)[0];
                let second = |a: f64, b: f64| (a + b - 2.0 * u(x, t)) / (d * d);
                let wave = second(u(x, t + d), u(x, t - d)) - second(u(x + d, t), u(x - d, t)) + u(x, t).sin();
                assert!(wave.abs() < 1e-5, "{soliton:?}: {wave}");
                let rate = (u(x, t + d) - u(x, t - d)) / (2.0 * d);
                assert!((rate - soliton.at(x, t)[1]).abs() < 1e-5, "{soliton:?}: {rate}");
            }
        }
        assert_eq!(middle(&[0.0, 3.0, 4.0], [0.0, 1.0, 2.0].into_iter()), 1.0 + (PI - 3.0));
    }
}
