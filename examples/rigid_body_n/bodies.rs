//! The free rigid body in five to ten dimensions: one declaration, six sizes.

use clebsch::Clebsch;
use nalgebra::SMatrix;

/// In five dimensions: 10 components of the momentum.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<5>, R: SO<5>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
)]
pub struct RigidBody5 {
    /// J_d of Moser and Veselov: half of ∫ρρᵀdm, kg·m².
    #[clebsch(symmetric)]
    pub j_d: SMatrix<f64, 5, 5>,
}

/// In six dimensions: 15 components of the momentum.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<6>, R: SO<6>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
)]
pub struct RigidBody6 {
    /// J_d of Moser and Veselov: half of ∫ρρᵀdm, kg·m².
    #[clebsch(symmetric)]
    pub j_d: SMatrix<f64, 6, 6>,
}

/// In seven dimensions: 21 components of the momentum.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<7>, R: SO<7>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
)]
pub struct RigidBody7 {
    /// J_d of Moser and Veselov: half of ∫ρρᵀdm, kg·m².
    #[clebsch(symmetric)]
    pub j_d: SMatrix<f64, 7, 7>,
}

/// In eight dimensions: 28 components of the momentum.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<8>, R: SO<8>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
)]
pub struct RigidBody8 {
    /// J_d of Moser and Veselov: half of ∫ρρᵀdm, kg·m².
    #[clebsch(symmetric)]
    pub j_d: SMatrix<f64, 8, 8>,
}

/// In nine dimensions: 36 components of the momentum.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<9>, R: SO<9>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
)]
pub struct RigidBody9 {
    /// J_d of Moser and Veselov: half of ∫ρρᵀdm, kg·m².
    #[clebsch(symmetric)]
    pub j_d: SMatrix<f64, 9, 9>,
}

/// In ten dimensions: 45 components of the momentum.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<10>, R: SO<10>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
)]
pub struct RigidBody10 {
    /// J_d of Moser and Veselov: half of ∫ρρᵀdm, kg·m².
    #[clebsch(symmetric)]
    pub j_d: SMatrix<f64, 10, 10>,
}
