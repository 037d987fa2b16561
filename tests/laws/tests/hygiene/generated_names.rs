//! Structs and generics that have the names of generated items.

use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector3};

/// A method with the name of a generated type.
pub struct Mu;

/// A method with the name of the scalar.
pub struct T;

macro_rules! bodies {
    ($($name:ident)*) => {$(
        /// A body with a name that the expansion uses too.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action     = |F: SO<3>, R: SO<3>| R * F,
            lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
            discretization = moser_veselov,
            method Mu = (order = 1, discretization = cayley),
            method T = (discretization = exact),
        )]
        pub struct $name {
            /// In kg·m².
            #[clebsch(symmetric)]
            pub inertia: Matrix3<f64>,
        }
    )*};
}
bodies!(Step Constants Equation1);

/// Equal sites, generic in a number with the name of a generated type, with names that the expansion uses too.
macro_rules! sites {
    ($($name:ident)*) => {$(
        /// A ring with a name that the expansion uses too.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action     = |F: [SO<3>; Equation1], R: [SO<3>; Equation1]| (0..Equation1).map(|i| R[i] * F[i]),
            lagrangian = |omega| (0..Equation1).map(|i| omega[i].dot(&(self.inertia * omega[i])) / 2).sum(),
            potential  = |R| (0..Equation1).map(|i| (R[i].transpose() * R[(i + 1) % Equation1]).trace()).sum(),
            discretization = moser_veselov,
        )]
        pub struct $name<const Equation1: usize> {
            /// In kg·m².
            #[clebsch(symmetric)]
            pub inertia: Matrix3<f64>,
        }
    )*};
}
#[allow(non_upper_case_globals, reason = "the name of a generated type")]
mod rings {
    use clebsch::Clebsch;
    use nalgebra::Matrix3;
    sites!(Step Constants StepSite);
}

/// Generics with the names of generated items.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| self.mass * (F - I).norm_squared() / (4 * h),
    potential = |q| self.mass * q.z,
)]
pub struct Generics<'clebsch, Step: clebsch::Scalar, Constants, const N: usize> {
    /// In kg.
    pub mass: Step,
    /// Not read.
    pub name: &'clebsch str,
    /// Not read.
    pub other: [Constants; N],
}

#[test]
fn they_step() {
    let inertia = Matrix3::identity();
    crate::steps(&Step { inertia }, Matrix3::identity(), Vector3::zeros());
    crate::steps(&Constants { inertia }, Matrix3::identity(), Vector3::zeros());
    crate::steps(&Equation1 { inertia }, Matrix3::identity(), Vector3::zeros());
    let at_rest = ([Matrix3::identity(); 2], [Vector3::zeros(); 2]);
    crate::steps(&rings::Step { inertia }, at_rest.0, at_rest.1);
    crate::steps(&rings::Constants { inertia }, at_rest.0, at_rest.1);
    crate::steps(&rings::StepSite { inertia }, at_rest.0, at_rest.1);
    let generics = Generics { mass: 1.0, name: "bob", other: ["", ""] };
    crate::steps(&generics, Vector3::z(), Vector3::zeros());
    assert_eq!((generics.name, generics.other), ("bob", ["", ""]));
}
