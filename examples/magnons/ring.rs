//! The declaration: a ring of spins.

use clebsch::{Clebsch, Field, FieldStepper, Grid};
use nalgebra::Vector3;

/// Spins with inertia 1, tied to their neighbours. They turn about themselves, too.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action   = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost     = |h, F| (F - I).norm_squared() / (4 * h),
    space    = |dx, q, next| self.exchange * (next - q).norm_squared() / (2 * dx.powi(2)),
    isotropy = free,
)]
pub struct Magnet {
    /// J.
    pub exchange: f64,
}

/// Steps of a ring.
pub type Steps = FieldStepper<Magnet, Grid<f64, 1>>;

impl Magnet {
    /// Steps of a ring of so many spins, with the spacing 1.
    ///
    /// # Errors
    /// Those of a stepper.
    pub fn ring(&self, sites: usize, h: f64) -> Result<Steps, clebsch::Error> {
        self.grid([sites]).periodic().stepper(h)
    }
}

/// The first two components, and the angle from one such pair to another.
pub fn turned(from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
    from.xy().perp(&to.xy()).atan2(from.xy().dot(&to.xy()))
}
