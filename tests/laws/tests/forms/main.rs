//! Unrolled code and matrix code agree. On systems of sizes at which both are there, all derived values agree to
//! round-off.

mod checks;
mod large;

use checks::{agree, agree_forced, agree_varied};
use clebsch::Clebsch;
use nalgebra::{Matrix2, Matrix3, Matrix4, SMatrix, SVector, Vector3, Vector4};

/// A declaration in both forms, and a test that they agree on motions that start at `$rest`.
macro_rules! both {
    ($test:ident, $rest:expr, $value:expr, $(#[$attribute:meta])* struct $name:ident { $($field:tt)* }) => {
        both!(agree: $test, $rest, $value, $(#[$attribute])* struct $name { $($field)* });
    };
    ($agree:ident: $test:ident, $rest:expr, $value:expr, $(#[$attribute:meta])* struct $name:ident { $($field:tt)* }) => {
        mod $test {
            use super::*;

            pub mod unrolled {
                use super::*;
                #[derive(Clebsch, Clone)]
                $(#[$attribute])*
                #[clebsch(code = unrolled)]
                pub struct $name { $($field)* }

                pub fn system() -> $name {
                    $value
                }
            }

            pub mod matrices {
                use super::*;
                #[derive(Clebsch, Clone)]
                $(#[$attribute])*
                #[clebsch(code = matrices)]
                pub struct $name { $($field)* }

                pub fn system() -> $name {
                    $value
                }
            }

            #[test]
            fn both_forms_agree() {
                $agree(&unrolled::system(), &matrices::system(), $rest, 11);
            }
        }
    };
}

/// A symmetric matrix with eigenvalues between about 0.5 and 1.5.
fn mass<const N: usize>() -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| if i == j { 0.7 + 0.6 * i as f64 / N as f64 } else { 0.05 / (1 + i + j) as f64 })
}

fn pole<const N: usize>() -> SVector<f64, N> {
    SVector::from_fn(|i, _| if i == 0 { 1.0 } else { 0.0 })
}

both!(
    free_body_4,
    Matrix4::identity(),
    Body { j_d: mass() },
    #[clebsch(
        action = |F: SO<4>, R: SO<4>| R * F,
        cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub j_d: Matrix4<f64>,
    }
);

// a rotation leaves the identity unchanged, and no formula projects a momentum
both!(
    covariances_2,
    Matrix2::identity(),
    Covariance { weight: 0.7 },
    #[clebsch(
        action     = |F: GL<2>, P: Matrix2| F * P * F.transpose(),
        lagrangian = |P, xi| (xi.matrix() * P * xi.matrix().transpose() * P.inverse()).trace(),
        potential  = |P| self.weight * P.trace(),
    )]
    struct Covariance {
        pub weight: f64,
    }
);

#[cfg(feature = "heavy")]
both!(
    body_5,
    SMatrix::identity(),
    Body { j_d: mass(), weight: 0.4, center: SVector::from_fn(|i, _| 0.3 - 0.1 * i as f64) },
    #[clebsch(
        action    = |F: SO<5>, R: SO<5>| R * F,
        cost      = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
        potential = |R| self.weight * (R * self.center)[4],
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub j_d: SMatrix<f64, 5, 5>,
        pub weight: f64,
        pub center: SVector<f64, 5>,
    }
);

both!(
    neumann_3,
    pole(),
    Neumann { stiffness: mass() },
    #[clebsch(
        action    = |F: SO<4>, q: Unit<Vector4>| F * q,
        cost      = |h, F| (F - I).norm_squared() / (4 * h),
        potential = |q| q.dot(&(self.stiffness * q)) / 2,
    )]
    struct Neumann {
        #[clebsch(symmetric)]
        pub stiffness: Matrix4<f64>,
    }
);

#[cfg(feature = "heavy")]
both!(
    neumann_5_first_order,
    pole(),
    Neumann { stiffness: mass() },
    #[clebsch(
        action    = |F: SO<6>, q: Unit<SVector<6>>| F * q,
        cost      = |h, F| (F - I).norm_squared() / (4 * h),
        potential = |q| q.dot(&(self.stiffness * q)) / 2,
        order     = 1,
    )]
    struct Neumann {
        #[clebsch(symmetric)]
        pub stiffness: SMatrix<f64, 6, 6>,
    }
);

both!(
    compensated_body,
    Matrix4::identity(),
    Body { j_d: mass(), weight: 0.4, center: Vector4::from_fn(|i, _| 0.3 - 0.1 * i as f64) },
    #[clebsch(
        action    = |F: SO<4>, R: SO<4>| R * F,
        cost      = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
        potential = |R| self.weight * (R * self.center)[3],
        summation = compensated,
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub j_d: Matrix4<f64>,
        pub weight: f64,
        pub center: Vector4<f64>,
    }
);

#[cfg(feature = "heavy")]
both!(
    compensated_point,
    pole(),
    Neumann { stiffness: mass() },
    #[clebsch(
        action    = |F: SO<6>, q: Unit<SVector<6>>| F * q,
        cost      = |h, F| (F - I).norm_squared() / (4 * h),
        potential = |q| q.dot(&(self.stiffness * q)) / 2,
        summation = compensated,
    )]
    struct Neumann {
        #[clebsch(symmetric)]
        pub stiffness: SMatrix<f64, 6, 6>,
    }
);

both!(
    compensated_products,
    (SVector::zeros(), Matrix4::identity()),
    Body { mass_matrix: mass(), gravity: 0.8 },
    #[clebsch(
        action    = |(a, F): (Translation<4>, SO<4>), (x, R): (SVector<4>, SO<4>)| (x + a, R * F),
        cost      = |h, (a, F)| (a.dot(&a) + ((F - I) * self.mass_matrix * (F - I).transpose()).trace()) / (2 * h),
        potential = |(x, R)| self.gravity * (R * x)[2] + x.dot(&x) / 2,
        summation = compensated,
        order     = 4,
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub mass_matrix: Matrix4<f64>,
        pub gravity: f64,
    }
);

#[cfg(feature = "heavy")]
both!(
    agree_forced: driven_body_5,
    SMatrix::identity(),
    Body { j_d: mass(), weight: 0.4, drag: 0.3 },
    #[clebsch(
        action    = |F: SO<5>, R: SO<5>| R * F,
        cost      = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
        potential = |R| self.weight * R[(0, 4)],
        force     = |R, xi, torque: SVector<10>| torque - self.drag * xi,
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub j_d: SMatrix<f64, 5, 5>,
        pub weight: f64,
        pub drag: f64,
    }
);

both!(
    agree_forced: turbulent_body,
    Matrix4::identity(),
    Body { j_d: mass(), drag: 0.3 },
    #[clebsch(
        action    = |F: SO<4>, R: SO<4>| R * F,
        cost      = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
        force     = |R, xi, torque: SVector<6>| torque * R[(0, 0)] - self.drag * xi.norm_squared() * xi,
        order     = 4,
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub j_d: Matrix4<f64>,
        pub drag: f64,
    }
);

#[cfg(feature = "heavy")]
both!(
    agree_forced: pushed_body_5,
    SMatrix::identity(),
    Body { j_d: mass(), drag: 0.3 },
    #[clebsch(
        action    = |F: SO<5>, R: SO<5>| R * F,
        cost      = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
        force_on  = |R, xi, push: SVector<5>| push * R.row(1) * R - self.drag * R,
        summation = compensated,
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub j_d: SMatrix<f64, 5, 5>,
        pub drag: f64,
    }
);

both!(
    agree_forced: dragged_point,
    pole(),
    Point { stiffness: mass(), drag: 0.2 },
    #[clebsch(
        action    = |F: SO<6>, q: Unit<SVector<6>>| F * q,
        cost      = |h, F| (F - I).norm_squared() / (4 * h),
        potential = |q| q.dot(&(self.stiffness * q)) / 2,
        force_on  = |q, xi, wind: SVector<6>| wind - self.drag * q,
    )]
    struct Point {
        #[clebsch(symmetric)]
        pub stiffness: SMatrix<f64, 6, 6>,
        pub drag: f64,
    }
);

#[cfg(feature = "heavy")]
both!(
    agree_forced: damped_point,
    pole(),
    Point { stiffness: mass(), drag: 0.2 },
    #[clebsch(
        action    = |F: SO<6>, q: Unit<SVector<6>>| F * q,
        cost      = |h, F| (F - I).norm_squared() / (4 * h),
        potential = |q| q.dot(&(self.stiffness * q)) / 2,
        force     = |q, xi, torque: SVector<15>| torque * q[0] - self.drag * xi,
        isotropy  = free,
    )]
    struct Point {
        #[clebsch(symmetric)]
        pub stiffness: SMatrix<f64, 6, 6>,
        pub drag: f64,
    }
);

both!(
    agree_varied: varied_body,
    Matrix4::identity(),
    Body { j_d: mass(), weight: 0.4, center: Vector4::from_fn(|i, _| 0.3 - 0.1 * i as f64) },
    #[clebsch(
        action    = |F: SO<4>, R: SO<4>| R * F,
        cost      = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
        potential = |R| self.weight * (R * self.center)[3],
        emit      = [tangent, boundary],
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub j_d: Matrix4<f64>,
        pub weight: f64,
        pub center: Vector4<f64>,
    }
);

both!(
    agree_varied: varied_point,
    pole(),
    Neumann { stiffness: mass() },
    #[clebsch(
        action    = |F: SO<4>, q: Unit<Vector4>| F * q,
        cost      = |h, F| (F - I).norm_squared() / (4 * h),
        potential = |q| q.dot(&(self.stiffness * q)) / 2,
        emit      = [tangent, boundary],
    )]
    struct Neumann {
        #[clebsch(symmetric)]
        pub stiffness: Matrix4<f64>,
    }
);

both!(
    agree_varied: varied_two_bodies,
    (Matrix3::identity(), Matrix4::identity()),
    Bodies { first: mass(), second: mass() },
    #[clebsch(
        action = |(F, G): (SO<3>, SO<4>), (R, S): (SO<3>, SO<4>)| (R * F, G * S),
        cost   = |h, (F, G)| (self.first * (F - I) * (F - I).transpose()).trace() / h
            + (self.second * (G - I) * (G - I).transpose()).trace() / h,
        potential = |(R, S)| R[(0, 1)] * S[(2, 3)] / 4,
        emit      = [tangent, boundary],
    )]
    struct Bodies {
        #[clebsch(symmetric)]
        pub first: Matrix3<f64>,
        #[clebsch(symmetric)]
        pub second: Matrix4<f64>,
    }
);

both!(
    agree_varied: varied_by_the_exponential,
    SMatrix::identity(),
    Body { inertia: mass(), drag: 0.3 },
    #[clebsch(
        action         = |F: SO<4>, R: SO<4>| R * F,
        lagrangian     = |xi| xi.dot(&(self.inertia * xi)) / 2,
        discretization = exponential,
        force          = |xi| -self.drag * xi,
        emit           = [tangent],
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub inertia: SMatrix<f64, 6, 6>,
        pub drag: f64,
    }
);

both!(
    agree_varied: varied_dragged_body,
    SMatrix::identity(),
    Body { inertia: mass(), drag: 0.3 },
    #[clebsch(
        action     = |F: SO<4>, R: SO<4>| R * F,
        lagrangian = |xi| xi.dot(&(self.inertia * xi)) / 2,
        potential  = |R| R[(0, 1)] / 3,
        force      = |R, xi| -self.drag * (1 + R[(0, 0)]) * xi.norm_squared() * xi,
        emit       = [tangent],
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub inertia: SMatrix<f64, 6, 6>,
        pub drag: f64,
    }
);

both!(
    agree_varied: varied_ellipsoid,
    Matrix3::identity(),
    Fluid { mass: 1.3 },
    #[clebsch(
        action = |F: SL<3>, q: SL<3>| F * q,
        cost   = |h, q, F| self.mass * (F * q - q).norm_squared() / (2 * h),
        emit   = [tangent, boundary],
    )]
    struct Fluid {
        pub mass: f64,
    }
);

#[cfg(feature = "heavy")]
both!(
    spatial_body,
    Matrix4::identity(),
    Body { mass_matrix: mass(), gravity: 0.8 },
    #[clebsch(
        action    = |F: SE<3>, q: SE<3>| q * F,
        cost      = |h, F| ((F - I) * self.mass_matrix * (F - I).transpose()).trace() / (2 * h),
        potential = |q| self.gravity * (q * self.mass_matrix)[(2, 3)],
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub mass_matrix: Matrix4<f64>,
        pub gravity: f64,
    }
);

#[cfg(feature = "heavy")]
both!(
    two_bodies,
    (Matrix4::identity(), SMatrix::identity()),
    Bodies { first: mass(), second: mass() },
    #[clebsch(
        action = |(F, G): (SO<4>, SO<5>), (R, S): (SO<4>, SO<5>)| (R * F, G * S),
        cost   = |h, (F, G)| (self.first * (F - I) * (F - I).transpose()).trace() / h
            + (self.second * (G - I) * (G - I).transpose()).trace() / h,
        potential = |(R, S)| R[(0, 1)] * S[(2, 3)] / 4,
    )]
    struct Bodies {
        #[clebsch(symmetric)]
        pub first: Matrix4<f64>,
        #[clebsch(symmetric)]
        pub second: SMatrix<f64, 5, 5>,
    }
);

#[cfg(feature = "heavy")]
both!(
    two_round_bodies,
    (Matrix4::identity(), Matrix4::identity()),
    Bodies { inertia: 1.3 },
    #[clebsch(
        action = |(F, G): (SO<4>, SO<4>), (R, S): (SO<4>, SO<4>)| (R * F, S * G),
        cost   = |h, (F, G)| self.inertia * ((F - I).norm_squared() + (G - I).norm_squared()) / h,
        potential = |(R, S)| R[(0, 1)] * S[(2, 3)] / 4,
    )]
    struct Bodies {
        pub inertia: f64,
    }
);

#[cfg(feature = "heavy")]
both!(
    free_body_by_newton,
    SMatrix::identity(),
    Body { j_d: mass() },
    #[clebsch(
        action = |F: SO<5>, R: SO<5>| R * F,
        cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
        solver = newton,
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub j_d: SMatrix<f64, 5, 5>,
    }
);

both!(
    spatial_body_by_newton,
    Matrix4::identity(),
    Body { mass_matrix: mass(), gravity: 0.8 },
    #[clebsch(
        action    = |F: SE<3>, q: SE<3>| q * F,
        cost      = |h, F| ((F - I) * self.mass_matrix * (F - I).transpose()).trace() / (2 * h),
        potential = |q| self.gravity * (q * self.mass_matrix)[(2, 3)],
        solver    = newton,
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub mass_matrix: Matrix4<f64>,
        pub gravity: f64,
    }
);

both!(
    similarity,
    Matrix4::identity(),
    Shape { inertia: mass() },
    #[clebsch(
        action         = |F: Sim<3>, q: Sim<3>| q * F,
        lagrangian     = |xi| xi.dot(&(self.inertia * xi)) / 2,
    )]
    struct Shape {
        #[clebsch(symmetric)]
        pub inertia: SMatrix<f64, 7, 7>,
    }
);

#[cfg(feature = "heavy")]
both!(
    fluid_ellipsoid,
    Matrix3::identity(),
    Fluid { mass: 1.3 },
    #[clebsch(action = |F: SL<3>, q: SL<3>| q * F, cost = |h, F| self.mass * (F - I).norm_squared() / (2 * h))]
    struct Fluid {
        pub mass: f64,
    }
);

#[cfg(feature = "heavy")]
both!(
    linear_optics,
    Matrix4::identity(),
    Optics { scale: 0.9 },
    #[clebsch(action = |F: Sp<4>, q: Sp<4>| q * F, cost = |h, F| self.scale * (F - I).norm_squared() / (2 * h))]
    struct Optics {
        pub scale: f64,
    }
);

both!(
    two_factors,
    (Matrix4::identity(), pole()),
    Pair { j_d: mass(), pull: 0.3 },
    #[clebsch(
        action    = |(F, W): (SO<4>, SO<4>), (R, q): (SO<4>, Unit<Vector4>)| (R * F, W * q),
        cost      = |h, (F, W)| (self.j_d * (F - I) * (F - I).transpose()).trace() / h + (W - I).norm_squared() / (4 * h),
        potential = |(R, q)| self.pull * (R * q)[2],
    )]
    struct Pair {
        #[clebsch(symmetric)]
        pub j_d: Matrix4<f64>,
        pub pull: f64,
    }
);

both!(
    lorentz_frame,
    Matrix4::identity(),
    Frame { inertia: 1.1, field: Vector4::new(0.1, 0.2, -0.1, 0.3), spin: Vector4::new(0.2, 0.1, 0.4, 0.1) },
    #[clebsch(
        group Lorentz = |F: Matrix4| {
            let eta = Matrix4::from_diagonal(&vector![1, -1, -1, -1]);
            F.transpose() * eta * F == eta
        },
        action    = |F: Lorentz, q: Lorentz| q * F,
        cost      = |h, F| self.inertia * (4 - F.trace()) / (2 * h),
        potential = |q| self.field.dot(&(q * self.spin)),
        signature = indefinite,
    )]
    struct Frame {
        pub inertia: f64,
        pub field: Vector4<f64>,
        pub spin: Vector4<f64>,
    }
);

both!(
    matrices_with_weights,
    Matrix3::identity(),
    Flow { weight: Matrix3::new(1.0, 0.9, 1.1, 1.2, 0.8, 1.0, 0.7, 1.1, 1.3) },
    #[clebsch(
        action = |F: GL<3>, q: GL<3>| F * q,
        cost   = |h, F| (F - I).dot(&self.weight.component_mul(&(F - I))) / (2 * h),
    )]
    struct Flow {
        pub weight: Matrix3<f64>,
    }
);

both!(
    by_the_exponential,
    SMatrix::identity(),
    Body { inertia: mass() },
    #[clebsch(
        action         = |F: SO<4>, R: SO<4>| R * F,
        lagrangian     = |xi| xi.dot(&(self.inertia * xi)) / 2,
        discretization = exponential,
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub inertia: SMatrix<f64, 6, 6>,
    }
);

both!(
    driven_body_of_fourth_order,
    Matrix3::identity(),
    Body { mass_matrix: mass(), weight: 0.8, center: Vector3::new(0.1, 0.2, 0.3) },
    #[clebsch(
        action    = |F: SO<3>, R: SO<3>| F * R,
        cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
        potential = |t, R| self.weight * t.cos() * (R * self.center).z,
        order     = 4,
    )]
    struct Body {
        #[clebsch(symmetric)]
        pub mass_matrix: Matrix3<f64>,
        pub weight: f64,
        pub center: Vector3<f64>,
    }
);

#[test]
fn what_is_conserved_is_the_same() {
    let q = Matrix4::identity();
    checks::conserve_alike(&free_body_4::unrolled::system(), &free_body_4::matrices::system(), &q);
}

// matrix code stands in for the unrolled code of larger ones
both!(
    coupled_costs_of_two_groups,
    Matrix2::new(1.0, 0.2, -0.1, 1.3),
    Two { weight: mass() },
    #[clebsch(
        action = |(F, G): (GL<2>, SO<2>), q: Matrix2| G * q * F,
        cost = |h, q, (F, G)| {
            let moved = G * q * F - q;
            (moved.dot(&(self.weight * moved)) + (F - I).norm_squared() + (G - I).norm_squared()) / (2 * h)
        },
        potential = |q| q[(1, 0)] * q[(0, 0)] / 3,
    )]
    struct Two {
        weight: Matrix2<f64>,
    }
);
