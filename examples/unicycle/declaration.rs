//! The unicycle, as the macro is given it: with free inputs, and with bounds.

use clebsch::{Clebsch, Controlled};
use nalgebra::{Matrix3, Vector2};

/// Declares the unicycle with more keys and fields, so that all of them are the same one.
#[rustfmt::skip]
macro_rules! unicycle {
    ($(#[$note:meta])* $name:ident, {$($key:ident = $value:expr)?}, {$($(#[$field_note:meta])* $field:ident: $type:ty)?}) => {
        $(#[$note])*
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action         = |F: SE<2>, q: SE<2>| q * F,
            controls       = |u: Vector2| vector![u.x, u.y, 0],
            cost           = |h, u| h * (self.turn_price * u.x.powi(2) + u.y.powi(2)) / 2,
            endpoint       = |t, q| self.time_price * t + self.miss_price * (q.translation() - self.goal).norm_squared() / 2,
            discretization = exponential,
            $($key = $value,)?
        )]
        pub struct $name {
            /// Price of turning against driving, m².
            pub turn_price: f64,
            /// Price of the final time, m²/s².
            pub time_price: f64,
            /// Price of missing the goal, 1/s.
            pub miss_price: f64,
            /// Goal of those who may miss it, m.
            pub goal: Vector2<f64>,
            $($(#[$field_note])* pub $field: $type,)?
        }

        impl Wheel<{ $name::COUNT }> for $name {
            fn with(car: &Car) -> Self {
                let Car { turn_price, time_price, miss_price, goal, .. } = *car;
                Self { turn_price, time_price, miss_price, goal, $($field: car.$field)? }
            }
        }
    };
}

unicycle!(
    /// A unicycle that turns and drives at any rate.
    Free,
    {},
    {}
);
unicycle!(
    /// A unicycle without reverse gear that turns no faster than it can.
    Forward,
    { bounds = |u| [-self.top_turn <= u.x, u.x <= self.top_turn, 0 <= u.y] },
    {
        /// Bound on the turning rate, rad/s.
        top_turn: f64
    }
);

impl Free {
    const COUNT: usize = 0;
}

impl Forward {
    const COUNT: usize = 3;
}

/// The parameters of both.
#[derive(Clone, Copy, Debug)]
pub struct Car {
    /// Price of turning against driving, m².
    pub turn_price: f64,
    /// Bound on the turning rate, rad/s.
    pub top_turn: f64,
    /// Price of the final time, m²/s².
    pub time_price: f64,
    /// Price of missing the goal, 1/s.
    pub miss_price: f64,
    /// Goal of those who may miss it, m.
    pub goal: Vector2<f64>,
}

impl Car {
    /// That has to arrive in the time that it is given.
    pub fn new(turn_price: f64, top_turn: f64) -> Self {
        Self { turn_price, top_turn, time_price: 0.0, miss_price: 0.0, goal: Vector2::zeros() }
    }
}

/// A unicycle with C bounds.
pub trait Wheel<const C: usize>: Controlled<3, 2, C, Scalar = f64, Place = Matrix3<f64>> {
    /// With these parameters; those that it does not have are left out.
    fn with(car: &Car) -> Self;
}
