//! The systems of these tests, with exact drifts in every order.

#[rustfmt::skip]
macro_rules! systems {
    ($name:ident, $order:literal:
        $(#[$of_top:meta])? top,
        $(#[$of_quaternions:meta])? quaternions,
        $(#[$of_mirrored:meta])? mirrored,
        $(#[$of_satellite:meta])? satellite,
        $(#[$of_flying:meta])? flying,
        $(#[$of_points:meta])? points
    ) => {
        pub mod $name {
            use clebsch::Clebsch;
            use nalgebra::{Matrix3, Vector3};

            /// A heavy top with any inertia tensor.
            $(#[$of_top])?
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
            $(#[$of_quaternions])?
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
            $(#[$of_mirrored])?
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
            $(#[$of_satellite])?
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
            $(#[$of_flying])?
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
            $(#[$of_points])?
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
            $(#[$of_points])?
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

            $(#[$of_points])?
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

#[rustfmt::skip]
systems!(second, 2: top, #[cfg(feature = "heavy")] quaternions, mirrored, #[cfg(feature = "heavy")] satellite, #[cfg(feature = "heavy")] flying, points);
#[rustfmt::skip]
systems!(fourth, 4: top, quaternions, mirrored, #[cfg(feature = "heavy")] satellite, flying, points);
#[rustfmt::skip]
systems!(sixth, 6: top, #[cfg(feature = "heavy")] quaternions, #[cfg(feature = "heavy")] mirrored, satellite, #[cfg(feature = "heavy")] flying, points);
#[rustfmt::skip]
systems!(eighth, 8: top, quaternions, mirrored, #[cfg(feature = "heavy")] satellite, flying, #[cfg(feature = "heavy")] points);
#[rustfmt::skip]
systems!(sixteenth, 16: top, #[cfg(feature = "heavy")] quaternions, #[cfg(feature = "heavy")] mirrored, satellite, #[cfg(feature = "heavy")] flying, points);
