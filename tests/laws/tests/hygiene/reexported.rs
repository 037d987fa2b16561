//! The runtime under another path, and an expansion inside of a function.

/// As a library that builds on `clebsch` shows it to its users.
mod library {
    pub mod inner {
        pub use clebsch as runtime;
    }
}

use library::inner::runtime::Clebsch;
use nalgebra::Matrix3;

pub use crate::no_prelude::{Body, Composed, Fine, Lopsided, Pair, Pendulum, Sites};

/// By the path of its re-export.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| R * F,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * (R * self.center).z,
    emit      = [generated, latex],
    crate     = crate::reexported::library::inner::runtime,
)]
pub struct Top {
    /// In kg·m².
    pub mass_matrix: Matrix3<f64>,
    /// In N.
    pub weight: f64,
    /// In m.
    pub center: nalgebra::Vector3<f64>,
}

#[test]
fn inside_of_a_function() {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| a.norm_squared() / (2 * h), scalar = f64)]
    struct Particle;

    crate::steps(&Particle, nalgebra::Vector1::zeros(), nalgebra::Vector1::zeros());
}
