//! The systems of these tests, with plain and with compensated sums, over any scalar.

/// The same systems with the sums that are asked for.
#[rustfmt::skip]
macro_rules! systems {
    ($name:ident $(, $summation:ident)?) => {
        pub mod $name {
            use clebsch::{Clebsch, Scalar};
            use nalgebra::Vector3;

            /// A body that nothing acts on: a right action, whose momenta Ad* carries.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, R: SO<3>| R * F,
                lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
                discretization = moser_veselov,
                $(summation    = $summation,)?
            )]
            pub struct Body<T: Scalar> {
                pub moments: Vector3<T>,
            }

            /// A point on a sphere: explicit, and moved without the matrix of F.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action    = |F: SO<3>, q: Unit<Vector3>| F * q,
                cost      = |h, F| (F - I).norm_squared() / (4 * h),
                potential = |q| self.gravity * q.z,
                $(summation = $summation,)?
            )]
            pub struct Pendulum<T: Scalar> {
                pub gravity: T,
            }

            /// The same with drift before kick.
            #[cfg(feature = "heavy")]
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action    = |F: SO<3>, q: Unit<Vector3>| F * q,
                cost      = |h, F| (F - I).norm_squared() / (4 * h),
                potential = |q| self.gravity * q.z,
                order     = 1,
                $(summation = $summation,)?
            )]
            pub struct First<T: Scalar> {
                pub gravity: T,
            }

            /// A top whose attitude is a unit quaternion.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action    = |F: SU<2>, Q: SU<2>| Q * F,
                cost      = |h, F| 2 * F.imag().component_mul(&F.imag()).dot(&self.moments) / h,
                potential = |Q| self.weight * (Q * Vector3::z()).z,
                $(summation = $summation,)?
            )]
            pub struct Quaternions<T: Scalar> {
                pub moments: Vector3<T>,
                pub weight: T,
            }

            /// A top by steps of order 4, composed.
            #[cfg(feature = "heavy")]
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, R: SO<3>| R * F,
                lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
                potential      = |R| self.weight * R[(2, 2)],
                discretization = moser_veselov,
                order          = 4,
                $(summation    = $summation,)?
            )]
            pub struct Composed<T: Scalar> {
                pub moments: Vector3<T>,
                pub weight: T,
            }

            /// A top by a splitting with exact drifts.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, R: SO<3>| R * F,
                lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
                potential      = |R| self.weight * R[(2, 2)],
                discretization = exact,
                order          = 4,
                $(summation    = $summation,)?
            )]
            pub struct Split<T: Scalar> {
                pub moments: Vector3<T>,
                pub weight: T,
            }

            /// The free motion itself.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, R: SO<3>| R * F,
                lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
                discretization = exact,
                $(summation    = $summation,)?
            )]
            pub struct Exact<T: Scalar> {
                pub moments: Vector3<T>,
            }

            /// A particle that is driven: the time matters.
            #[cfg(feature = "heavy")]
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action    = |a: Translation<2>, x: Vector2| x + a,
                cost      = |h, a| a.norm_squared() / (2 * h),
                potential = |t, x| x.norm_squared().powi(2) / 4 - x.x * (self.rate * t).cos(),
                $(summation = $summation,)?
            )]
            pub struct Driven<T: Scalar> {
                pub rate: T,
            }

            /// The potential at the start of a step alone: half steps are composed with their adjoints.
            #[cfg(feature = "heavy")]
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action = |a: Translation<2>, x: Vector2| x + a,
                cost   = |h, x, a| a.norm_squared() / (2 * h) - h * self.stiffness * x.norm_squared().powi(2) / 4,
                $(summation = $summation,)?
            )]
            pub struct Lopsided<T: Scalar> {
                pub stiffness: T,
            }

            /// A body in a medium with a torque.
            #[cfg(feature = "heavy")]
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |F: SO<3>, R: SO<3>| R * F,
                lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
                force      = |omega, torque: Vector3| torque - self.damping * omega,
                $(summation = $summation,)?
            )]
            pub struct Damped<T: Scalar> {
                pub moments: Vector3<T>,
                pub damping: T,
            }

            /// Two factors, one of them a rigid motion; a term that is linear in the velocity gives momenta at rest.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |(F, a): (SE<3>, Translation<2>), (q, x): (SE<3>, Vector2)| (q * F, x + a),
                lagrangian = |(v, w)| {
                    (v.xyz().component_mul(&v.xyz()).dot(&self.moments) + v.norm_squared()) / 2
                        + w.norm_squared() / 2 + self.moments.dot(&v.xyz()) / 8
                },
                potential  = |(q, x)| (q.translation() - self.moments).norm_squared() / 2 + x.norm_squared() / 2,
                $(summation = $summation,)?
            )]
            pub struct Flying<T: Scalar> {
                pub moments: Vector3<T>,
            }

            /// A body to which an inertia about the vertical is attached: the cost couples.
            #[cfg(feature = "heavy")]
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |F: SO<3>, R: SO<3>| R * F,
                lagrangian = |R, omega| (omega.component_mul(&omega).dot(&self.moments) + (R * omega).z.powi(2)) / 2,
                potential  = |R| R[(2, 2)],
                $(summation = $summation,)?
            )]
            pub struct Attached<T: Scalar> {
                pub moments: Vector3<T>,
            }

            /// A group whose inverses are no transposes.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action = |F: SL<2>, q: SL<2>| q * F,
                cost   = |h, F| self.stiffness * (F - I).norm_squared() / (2 * h),
                $(summation = $summation,)?
            )]
            pub struct Shape<T: Scalar> {
                pub stiffness: T,
            }

            /// The momentum alone.
            #[cfg(feature = "heavy")]
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, R: SO<3>| R * F,
                lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
                discretization = moser_veselov,
                emit           = [momentum],
                $(summation    = $summation,)?
            )]
            pub struct Alone<T: Scalar> {
                pub moments: Vector3<T>,
            }
        }
    };
}

systems!(plain);
systems!(compensated, compensated);
