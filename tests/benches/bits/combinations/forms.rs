//! The same small systems with many sets of dials.

/// A top, a pendulum and a body in four dimensions.
#[rustfmt::skip]
macro_rules! systems {
    ($name:ident, $($dials:tt)*) => {
        pub mod $name {
            use clebsch::{Clebsch, Scalar};
            use nalgebra::{Matrix3, Matrix4, Vector3};

            /// Implicit, with kicks.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |F: SO<3>, R: SO<3>| R * F,
                lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
                potential  = |R| self.weight * (R * self.center).z,
                $($dials)*
            )]
            pub struct Top<T: Scalar> {
                #[clebsch(symmetric)]
                pub inertia: Matrix3<T>,
                pub weight: T,
                pub center: Vector3<T>,
            }

            /// Explicit.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |F: SO<3>, q: Unit<Vector3>| F * q,
                lagrangian = |omega| omega.norm_squared() / 2,
                potential  = |q| self.gravity * q.z,
                $($dials)*
            )]
            pub struct Pendulum<T: Scalar> {
                pub gravity: T,
            }

            /// Six unknowns, free.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |F: SO<4>, R: SO<4>| R * F,
                lagrangian = |omega| (self.j_d * omega.matrix() * omega.matrix().transpose()).trace(),
                $($dials)*
            )]
            pub struct Body4<T: Scalar> {
                #[clebsch(symmetric)]
                pub j_d: Matrix4<T>,
            }
        }
    };
}

systems!(unrolled, code = unrolled,);
systems!(matrices, code = matrices,);
systems!(unrolled_compensated, code = unrolled, summation = compensated,);
systems!(matrices_compensated, code = matrices, summation = compensated,);
systems!(matrices_first, code = matrices, order = 1,);
systems!(matrices_fourth, code = matrices, order = 4,);
systems!(matrices_fourth_compensated, code = matrices, order = 4, summation = compensated,);
systems!(unrolled_sixteenth, code = unrolled, order = 16,);
systems!(sixteenth_compensated, order = 16, summation = compensated,);
systems!(loose_sixteenth, order = 16, tolerance = 1e-6,);
systems!(exponential, discretization = exponential,);
systems!(tolerant, tolerance = 1e-6, summation = compensated,);
systems!(fixed_point, solver = fixed_point,);
systems!(iterated, iterations = 3,);
