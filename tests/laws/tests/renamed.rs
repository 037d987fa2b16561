//! The runtime under another name, as `clebsch_renamed = { package = "clebsch", … }` gives it. The name `clebsch` means
//! something else here, so nothing can fall back to it. (A package cannot have both names in its `Cargo.toml`.)

#![deny(warnings)]

extern crate clebsch as clebsch_renamed;
extern crate std as clebsch;

use clebsch_renamed::Clebsch;
use nalgebra::{Matrix3, Vector3};

/// A heavy top.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    emit      = [generated],
    crate     = ::clebsch_renamed,
)]
pub struct Top {
    /// In kg·m².
    pub mass_matrix: Matrix3<f64>,
    /// In N.
    pub weight: f64,
    /// In m.
    pub center: Vector3<f64>,
}

/// A spherical pendulum over any scalar.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q.z,
    crate     = ::clebsch_renamed,
)]
pub struct Pendulum<T: clebsch_renamed::Scalar> {
    /// In m/s².
    pub gravity: T,
}

#[test]
fn renamed_systems_step() -> Result<(), clebsch_renamed::Error> {
    let top = Top { mass_matrix: Matrix3::identity(), weight: 1.0, center: Vector3::z() }.into_stepper(0.01)?;
    top.step(&top.state(Matrix3::identity(), Vector3::x())?)?;
    let pendulum = Pendulum { gravity: 9.81_f32 }.into_stepper(0.01)?;
    pendulum.step(&pendulum.state(Vector3::z(), Vector3::x())?)?;
    assert!(!Top::GENERATED.contains("::clebsch::"));
    Ok(())
}
