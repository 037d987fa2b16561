//! The systems of these tests, in every order.

/// A system that steps of order 1 take too.
#[rustfmt::skip]
macro_rules! pendulum {
    ($order:literal) => {
        /// A point on a sphere: explicit.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action    = |F: SO<3>, q: Unit<Vector3>| F * q,
            cost      = |h, F| (F - I).norm_squared() / (4 * h),
            potential = |q| self.gravity * q.z,
            order     = $order,
        )]
        pub struct Pendulum {
            pub gravity: f64,
        }
    };
}

/// Systems of the orders that have a step size for a wished error.
#[rustfmt::skip]
macro_rules! bodies {
    ($order:literal) => {
        /// A body about a pivot, free where it has no weight: implicit, and solvable for short steps only.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action         = |F: SO<3>, R: SO<3>| R * F,
            lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
            potential      = |R| self.weight * (R * self.center).z,
            discretization = moser_veselov,
            order          = $order,
        )]
        pub struct Top {
            #[clebsch(symmetric)]
            pub inertia: Matrix3<f64>,
            pub weight: f64,
            pub center: Vector3<f64>,
        }

        /// A free body in four dimensions.
        #[cfg(feature = "heavy")]
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action = |F: SO<4>, R: SO<4>| R * F,
            cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
            order  = $order,
        )]
        pub struct Body4 {
            #[clebsch(symmetric)]
            pub j_d: Matrix4<f64>,
        }
    };
}

/// Systems whose orders are measured alone.
#[rustfmt::skip]
macro_rules! measured {
    ($order:literal) => {
        /// A particle that is driven: the time matters, also within a step.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action    = |a: Translation<2>, x: Vector2| x + a,
            cost      = |h, a| a.norm_squared() / (2 * h),
            potential = |t, x| x.norm_squared().powi(2) / 4 - x.x * (self.rate * t).cos(),
            order     = $order,
        )]
        pub struct Driven {
            pub rate: f64,
        }

        /// The potential at the start of a step alone: half steps are composed with their adjoints before.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action = |a: Translation<2>, x: Vector2| x + a,
            cost   = |h, x, a| a.norm_squared() / (2 * h) - h * self.stiffness * x.norm_squared().powi(2) / 4,
            order  = $order,
        )]
        pub struct Lopsided {
            pub stiffness: f64,
        }

        /// A body in a medium, with a torque from outside: implicit, by Cayley's map.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action     = |F: SO<3>, R: SO<3>| R * F,
            lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
            force      = |omega, torque: Vector3| torque - self.damping * omega,
            order      = $order,
        )]
        pub struct Damped {
            #[clebsch(symmetric)]
            pub inertia: Matrix3<f64>,
            pub damping: f64,
        }
    };
}

/// A module for an order with these systems. The benchmark `bits` has all of them.
macro_rules! systems {
    ($name:ident, $order:literal: $($declare:ident)*) => {
        pub mod $name {
            use clebsch::Clebsch;
            #[allow(unused_imports, reason = "pendulums have none")]
            use nalgebra::{Matrix3, Matrix4, Vector3};

            $($declare!($order);)*
        }
    };
}

#[cfg(not(feature = "heavy"))]
systems!(first, 1: pendulum);
#[cfg(not(feature = "heavy"))]
systems!(second, 2: pendulum);
#[cfg(feature = "heavy")]
systems!(first, 1: pendulum bodies measured);
#[cfg(feature = "heavy")]
systems!(second, 2: pendulum bodies measured);
systems!(fourth, 4: pendulum bodies measured);
#[cfg(feature = "heavy")]
systems!(sixth, 6: pendulum bodies measured);
systems!(eighth, 8: pendulum bodies measured);
