//! The systems of these tests, with exact drifts in every order.

#[rustfmt::skip]
macro_rules! systems {
    ($name:ident, $order:literal) => {
        #[cfg_attr(not(feature = "heavy"), allow(dead_code, reason = "some are for the feature `heavy` alone"))]
        pub mod $name {
            use clebsch::Clebsch;
            use nalgebra::{Matrix3, Vector3};

            /// A heavy top with any inertia tensor.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, R: SO<3>| R * F,
                lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
                potential      = |R| self.weight * (R * self.center).z,
                discretization = exact,
                order          = $order,
            )]
            pub struct Top {
                #[clebsch(symmetric)]
                pub inertia: Matrix3<f64>,
                pub weight: f64,
                pub center: Vector3<f64>,
            }

            /// The same with principal axes, by quaternions.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SU<2>, Q: SU<2>| Q * F,
                lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
                potential      = |Q| (Q * self.moment).z,
                discretization = exact,
                order          = $order,
            )]
            pub struct QuaternionTop {
                pub moments: Vector3<f64>,
                pub moment: Vector3<f64>,
            }

            /// The same seen from the other side: the inverse attitude, moved from the left.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, S: SO<3>| F * S,
                lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
                potential      = |S| (S.transpose() * self.moment).z,
                discretization = exact,
                order          = $order,
            )]
            pub struct MirroredTop {
                pub moments: Vector3<f64>,
                pub moment: Vector3<f64>,
            }

            /// A satellite on a circular orbit: the time matters within a step.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, R: SO<3>| R * F,
                lagrangian     = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
                discretization = exact,
                potential      = |t, R| {
                    let phase = self.orbital_rate * t;
                    let zenith = R.transpose() * Vector3::new(phase.cos(), phase.sin(), 0);
                    3 * self.orbital_rate.powi(2) / 2 * zenith.dot(&(Matrix3::from_diagonal(&self.moments) * zenith))
                },
                order          = $order,
            )]
            pub struct Satellite {
                pub moments: Vector3<f64>,
                pub orbital_rate: f64,
            }

            /// A body in space, tied to the origin away from its centre: two factors that the potential couples.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |(a, F): (Translation<3>, SO<3>), (x, R): (Vector3, SO<3>)| (x + a, R * F),
                lagrangian     = |(v, omega)| {
                    (self.mass * v.norm_squared() + omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega))) / 2
                },
                potential      = |(x, R)| self.stiffness * (x + R * self.hook).norm_squared() / 2,
                discretization = exact,
                order          = $order,
            )]
            pub struct Flying {
                pub mass: f64,
                pub moments: Vector3<f64>,
                pub hook: Vector3<f64>,
                pub stiffness: f64,
            }

            /// A point on a sphere, whose drift along great circles is exact by the exponential.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, q: Unit<Vector3>| F * q,
                lagrangian     = |omega| omega.norm_squared() / 2,
                potential      = |q| self.gravity * q.z + self.waves * (q.x * q.y),
                discretization = exponential,
                order          = $order,
            )]
            pub struct Pendulum {
                pub gravity: f64,
                pub waves: f64,
            }

            /// The same with the potential behind methods, which are differentiated once.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action         = |F: SO<3>, q: Unit<Vector3>| F * q,
                lagrangian     = |omega| omega.norm_squared() / 2,
                potential      = opaque(Self::energy, Self::slope),
                discretization = exponential,
                order          = $order,
            )]
            pub struct OpaquePendulum {
                pub gravity: f64,
                pub waves: f64,
            }

            impl OpaquePendulum {
                pub fn energy(&self, q: &Vector3<f64>) -> f64 {
                    self.gravity * q.z + self.waves * q.x * q.y
                }
                pub fn slope(&self, q: &Vector3<f64>) -> Vector3<f64> {
                    Vector3::new(self.waves * q.y, self.waves * q.x, self.gravity)
                }
            }
        }
    };
}

systems!(second, 2);
systems!(fourth, 4);
systems!(sixth, 6);
systems!(eighth, 8);
systems!(sixteenth, 16);
