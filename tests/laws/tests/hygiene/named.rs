//! Structs, fields and arguments that have the names of generated code.

use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector3};

macro_rules! bodies {
    ($($name:ident)*) => {$(
        /// A body with a name that the expansion uses too.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action     = |F: SO<3>, R: SO<3>| R * F,
            lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
            discretization = moser_veselov,
        )]
        pub struct $name {
            /// In kg·m².
            #[clebsch(symmetric)]
            pub inertia: Matrix3<f64>,
        }
    )*};
}
bodies!(Error Result Scalar Space);

/// Fields with the names of generated variables.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.t0 * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.h * (R * self.inertia_inverse).z + self.self_ * self.terms * self.k0,
)]
pub struct Fields {
    /// In kg·m².
    pub t0: Matrix3<f64>,
    /// In N.
    pub h: f64,
    /// In m.
    pub inertia_inverse: Vector3<f64>,
    /// In J.
    pub self_: f64,
    /// A number.
    pub terms: f64,
    /// A number.
    pub k0: f64,
}

/// A raw identifier, and arguments with the names of the formulas.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |mu: SO<3>, d: Unit<Vector3>| mu * d,
    cost      = |h, mu| self.r#type * (mu - I).norm_squared() / (4 * h),
    potential = |d| { let x = d.z; let q = self.r#type * x; q * x },
)]
pub struct Arguments {
    /// In kg·m².
    pub r#type: f64,
}

#[test]
fn they_step() {
    let inertia = Matrix3::identity();
    crate::steps(&Error { inertia }, Matrix3::identity(), Vector3::zeros());
    crate::steps(&Result { inertia }, Matrix3::identity(), Vector3::zeros());
    crate::steps(&Scalar { inertia }, Matrix3::identity(), Vector3::zeros());
    crate::steps(&Space { inertia }, Matrix3::identity(), Vector3::zeros());
    crate::steps(&Arguments { r#type: 1.0 }, Vector3::z(), Vector3::zeros());
    let fields = Fields { t0: inertia, h: 1.0, inertia_inverse: Vector3::z(), self_: 0.0, terms: 0.0, k0: 0.0 };
    crate::steps(&fields, Matrix3::identity(), Vector3::zeros());
}
