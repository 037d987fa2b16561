//! The swirling spheroid: a family of motions that two quadratures solve.

use nalgebra::{Matrix3, Vector3};

/// diag(semi-axes) scaled to determinant 1.
pub fn of_unit_volume(semi_axes: &Vector3<f64>) -> Option<Matrix3<f64>> {
    let scaled = semi_axes / semi_axes.max();
    let q = Matrix3::from_diagonal(&(scaled / scaled.product().cbrt()));
    // One more scaling takes the rounding of the root away.
    let q = q / q.determinant().cbrt();
    (q.determinant().is_finite() && q.iter().all(|entry| entry.is_finite())).then_some(q)
}

/// q = a (turn by φ about e₃) ⊕ a⁻², with a²φ̇ = ℓ and ȧ²(1 + 2a⁻⁶) + ℓ²/a² = e constant (per unit mass).
#[derive(Clone, Copy, Debug)]
pub struct Spheroid {
    /// a at the start.
    pub radius: f64,
    /// ȧ at the start, 1/s.
    pub rate: f64,
    /// φ̇ at the start, rad/s.
    pub swirl: f64,
}

impl Spheroid {
    /// ℓ, 1/s.
    fn momentum(&self) -> f64 {
        self.radius.powi(2) * self.swirl
    }

    /// e, 1/s².
    pub fn energy(&self) -> f64 {
        self.rate.powi(2) * (1.0 + 2.0 * self.radius.powi(-6)) + (self.radius * self.swirl).powi(2)
    }

    /// The radius at which swirl turns a contraction back, ℓ/√e; none at rest.
    pub fn least_radius(&self) -> Option<f64> {
        (self.energy() > 0.0).then(|| self.momentum().abs() / self.energy().sqrt())
    }

    /// q and q̇ at the start.
    pub fn start(&self) -> (Matrix3<f64>, Matrix3<f64>) {
        (shape(self.radius, 0.0), self.velocity(self.radius, self.rate, 0.0))
    }

    fn velocity(&self, a: f64, rate: f64, phase: f64) -> Matrix3<f64> {
        let swirl = self.momentum() / (a * a);
        let turn = turn(phase) * a;
        let around = Matrix3::new(0.0, -swirl, 0.0, swirl, 0.0, 0.0, 0.0, 0.0, 0.0);
        let mut velocity = turn * (rate / a) + around * turn;
        velocity.m33 = -2.0 * rate / a.powi(3);
        velocity
    }

    /// q at a time.
    ///
    /// With a² = ℓ²/e + s² the time is t = e^{−1/2} ∫ √(1 + 2a⁻⁶) ds, and φ = ℓ e^{−1/2} ∫ √(1 + 2a⁻⁶) a⁻² ds. Both are
    /// smooth through the turning point s = 0. None at rest, and without swirl while it contracts, where s never
    /// reaches 0.
    pub fn at(&self, time: f64) -> Option<Matrix3<f64>> {
        let (least, root) = (self.least_radius()?, self.energy().sqrt());
        let first = (self.radius.powi(2) - least.powi(2)).max(0.0).sqrt().copysign(self.rate);
        let pace = |s: f64| (1.0 + 2.0 * (least * least + s * s).powi(-3)).sqrt() / root;
        let mut last = first + time / pace(first);
        for _ in 0..60 {
            let step = (simpson(pace, first, last) - time) / pace(last);
            // Newton's method; no step beyond the turning point and back, where the pace changes most.
            last -= step.clamp(-least.max(0.1), least.max(0.1));
            if step.abs() <= 4.0 * f64::EPSILON * last.abs().max(least) {
                break;
            }
        }
        let reached = simpson(pace, first, last);
        let radius = least.hypot(last);
        let phase = self.momentum() * simpson(|s| pace(s) / (least * least + s * s), first, last);
        ((reached - time).abs() <= 1e-12 * time).then(|| shape(radius, phase))
    }
}

fn turn(phase: f64) -> Matrix3<f64> {
    let (sin, cos) = phase.sin_cos();
    Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 0.0)
}

fn shape(radius: f64, phase: f64) -> Matrix3<f64> {
    let mut q = turn(phase) * radius;
    q.m33 = radius.powi(-2);
    q
}

/// Simpson's rule on panels so many that its error is below rounding.
fn simpson(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    const PANELS: u32 = 4000;
    let width = (to - from) / f64::from(PANELS);
    let panel = |index: u32| {
        let left = from + f64::from(index) * width;
        f(left) + 4.0 * f(left + width / 2.0) + f(left + width)
    };
    (0..PANELS).map(panel).sum::<f64>() * width / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodesic;

    /// The quadratures against the equations for q.
    #[test]
    fn the_quadrature_solves_the_equations() {
        for (rate, swirl) in [(-0.5, 0.2), (0.5, 0.2), (-0.1, 1.0), (0.3, 0.0)] {
            let spheroid = Spheroid { radius: 1.5, rate, swirl };
            let (q, velocity) = spheroid.start();
            let exact = geodesic::motion(&q, &velocity, 5.0, 10.0);
            let difference = (spheroid.at(5.0).unwrap() - geodesic::halves(&exact.end).0).amax();
            assert!(difference < 1e-10, "{rate} {swirl}: {difference:.1e}");
        }
    }
}
