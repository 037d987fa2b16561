//! One closed form for both: a point on a circle of constant energy goes from one end of a diameter to the other.
//!
//! ```text
//! along = C tanh(c t + δ),    across = ± C sech(c t + δ)
//! ```
//! With along = C sin φ and across = C cos φ this is φ′ = c cos φ. The energy is that of a mass times ½ C².

use crate::{Body, Sleigh};
use nalgebra::{Vector2, Vector3};

/// Where on its circle a system is.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Towards the end where it stays.
    pub along: f64,
    /// Zero at both ends.
    pub across: f64,
}

impl Place {
    /// C
    pub fn size(&self) -> f64 {
        self.along.hypot(self.across)
    }

    /// How far from another place, in parts of C.
    pub fn distance(&self, other: &Self) -> f64 {
        (self.along - other.along).hypot(self.across - other.across) / self.size()
    }
}

/// The motion on the circle.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// C
    pub size: f64,
    /// c, 1/s.
    pub rate: f64,
    /// δ
    pub delay: f64,
    sign: f64,
}

impl Crossing {
    /// From the place at the start. `rate` is c in units of C.
    fn new(start: Place, rate: f64) -> Self {
        let size = start.size();
        Self { size, rate: rate * size, delay: (start.along / size).atanh(), sign: start.across.signum() }
    }

    /// The place after some time.
    pub fn at(&self, time: f64) -> Place {
        let phase = self.rate * time + self.delay;
        Place { along: self.size * phase.tanh(), across: self.sign * self.size / phase.cosh() }
    }

    /// The integral of `across`/C · c from the start: the difference of two Gudermannian functions.
    fn swept(&self, time: f64) -> f64 {
        let gudermannian = |phase: f64| 2.0 * (phase / 2.0).tanh().atan();
        self.sign * (gudermannian(self.rate * time + self.delay) - gudermannian(self.delay))
    }
}

/// v′ = a ω² and (I + m a²) ω′ = −m a v ω, so along is v. Across is β ω with β² = (I + m a²)/m, and c = a C/β².
impl Sleigh {
    /// β, metres.
    pub fn beta(&self) -> f64 {
        (self.inertia / self.mass + self.offset * self.offset).sqrt()
    }

    /// From the turning rate and the speed along the blade.
    pub fn place(&self, omega: f64, speed: f64) -> Place {
        Place { along: speed, across: self.beta() * omega }
    }

    /// From the start.
    pub fn crossing(&self, start: Place) -> Crossing {
        Crossing::new(start, self.offset / self.beta().powi(2))
    }

    /// By which angle it has turned: ω = across/β.
    pub fn turned(&self, crossing: &Crossing, time: f64) -> f64 {
        self.beta() / self.offset * crossing.swept(time)
    }
}

/// P ω′ = (k·ω) e₃ × ω for ω = (ω₁, ω₂), with P the upper left block of J, and k = (J₁₃, J₂₃).
///
/// In u = P^½ ω, on a circle, this is u′ = (k·ω) (det P)^−½ e₃ × u. So across is the part of u along P^−½ k.
impl Body {
    /// |P^−½ k| and (det P)^½
    fn sizes(&self) -> (f64, f64) {
        let block = self.inertia.fixed_view::<2, 2>(0, 0);
        (self.coupling().dot(&self.image()).sqrt(), block.determinant().sqrt())
    }

    fn coupling(&self) -> Vector2<f64> {
        Vector2::new(self.inertia[(0, 2)], self.inertia[(1, 2)])
    }

    /// P⁻¹ k
    fn image(&self) -> Vector2<f64> {
        let [a, b, d] = [self.inertia[(0, 0)], self.inertia[(0, 1)], self.inertia[(1, 1)]];
        let k = self.coupling();
        Vector2::new(d * k.x - b * k.y, a * k.y - b * k.x) / (a * d - b * b)
    }

    /// From the angular velocity.
    pub fn place(&self, omega: &Vector3<f64>) -> Place {
        let ((length, root), omega) = (self.sizes(), omega.xy());
        Place { along: root * self.image().perp(&omega) / length, across: self.coupling().dot(&omega) / length }
    }

    /// From the start.
    pub fn crossing(&self, start: Place) -> Crossing {
        let (length, root) = self.sizes();
        Crossing::new(start, length / root)
    }
}
