//! A composition of many steps, which knows the time.

use clebsch::{Clebsch, Scalar};
use nalgebra::Matrix3;

/// Eleven steps in one, each at its own time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
    potential  = |t, R| R[(0, 1)] * (self.rate * t).cos() + R[(2, 2)].powi(2),
    order      = 6,
    emit       = [tangent],
)]
pub struct Sixth<T: Scalar> {
    #[clebsch(symmetric)]
    pub inertia: Matrix3<T>,
    pub rate: T,
}
