//! The continuous equations as the literature writes them: nothing here is derived by the macro.
//!
//! Source: Hughes, *Spacecraft Attitude Dynamics* (1986), §8.1 and §9.1.

use crate::body::Body;
use crate::orbit::Circle;
use crate::{Momentum, Pose, halves};
use clebsch_examples::energy_band::Terms;
use clebsch_examples::reference::{Solution, solve};
use nalgebra::{Matrix3, SVector, Vector3};

/// A body with the data of its equations.
#[derive(Clone, Copy, Debug)]
pub struct Equations {
    body: Body,
    inverse_inertia: Matrix3<f64>,
}

impl Equations {
    /// Principal moments of a [`Body`] are above zero.
    pub fn new(body: &Body) -> Self {
        let inverse_inertia = body.inertia.try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN));
        Self { body: *body, inverse_inertia }
    }

    /// J/(m r²): how much the attitude matters to the orbit.
    pub fn coupling(&self, radius: f64) -> f64 {
        self.body.moments.z / (self.body.mass * radius * radius)
    }

    /// ω of an angular momentum.
    pub fn angular_velocity(&self, momentum: &Vector3<f64>) -> Vector3<f64> {
        self.inverse_inertia * momentum
    }

    /// ∇V for y = Rᵀx, body frame, and its derivative along `u`, with V = GM (3yᵀJy/2r⁵ − tr J/2r³ − m/r).
    fn gradient(&self, y: &Vector3<f64>, u: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let Body { mass, inertia, gravitation, .. } = self.body;
        let (r, along) = (y.norm(), y.dot(u));
        let (third, fifth, seventh) = (r.powi(-3), r.powi(-5), r.powi(-7));
        let (jy, ju, trace) = (inertia * y, inertia * u, inertia.trace());
        let yjy = y.dot(&jy);
        let gradient = y * (mass * third + 1.5 * trace * fifth - 7.5 * yjy * seventh) + jy * (3.0 * fifth);
        let slope = -3.0 * mass * fifth * along - 7.5 * trace * seventh * along - 15.0 * y.dot(&ju) * seventh
            + 52.5 * yjy * along * seventh / (r * r);
        let change = u * (mass * third + 1.5 * trace * fifth - 7.5 * yjy * seventh)
            + y * slope
            + (ju - jy * (5.0 * along / (r * r))) * (3.0 * fifth);
        (gradient * gravitation, change * gravitation)
    }

    /// 3GM/r⁵ y×Jy, body frame.
    fn torque(&self, y: &Vector3<f64>) -> Vector3<f64> {
        y.cross(&(self.body.inertia * y)) * (3.0 * self.body.gravitation / y.norm().powi(5))
    }

    /// ẏ for y = (x, ẋ, R by columns, π).
    fn field(&self, y: &SVector<f64, 18>) -> SVector<f64, 18> {
        let block = |row: usize| -> Vector3<f64> { y.fixed_rows::<3>(row).into() };
        let (position, velocity, momentum) = (block(0), block(3), block(15));
        let attitude = Matrix3::from_column_slice(&y.as_slice()[6..15]);
        let (omega, seen) = (self.angular_velocity(&momentum), attitude.transpose() * position);
        let acceleration = attitude * self.gradient(&seen, &Vector3::zeros()).0 / -self.body.mass;
        let turning = attitude * omega.cross_matrix();
        let mut rate = SVector::<f64, 18>::zeros();
        rate.fixed_rows_mut::<3>(0).copy_from(&velocity);
        rate.fixed_rows_mut::<3>(3).copy_from(&acceleration);
        rate.as_mut_slice()[6..15].copy_from_slice(turning.as_slice());
        rate.fixed_rows_mut::<3>(15).copy_from(&(momentum.cross(&omega) + self.torque(&seen)));
        rate
    }

    /// ½ω·Jω − n e₃·Rπ + 3n²/2 x̂ᵀRJRᵀx̂: Jacobi's integral of a libration on a circle about e₃, J.
    pub fn jacobi(&self, circle: &Circle, pose: &Pose, momentum: &Momentum) -> f64 {
        let angular = halves(momentum).1;
        let (outwards, n) = (pose.1.transpose() * pose.0.normalize(), circle.rate);
        let gravity = 1.5 * circle.mean_motion.powi(2) * outwards.dot(&(self.body.inertia * outwards));
        angular.dot(&self.angular_velocity(&angular)) / 2.0 - n * (pose.1 * angular).z + gravity
    }

    /// The motion from a state, by extrapolation.
    pub fn motion(&self, (pose, momentum): &(Pose, Momentum), duration: f64, rate: f64) -> Solution<18> {
        let mut y = SVector::<f64, 18>::zeros();
        y.fixed_rows_mut::<3>(0).copy_from(&pose.0);
        y.fixed_rows_mut::<3>(3).copy_from(&(halves(momentum).0 / self.body.mass));
        y.as_mut_slice()[6..15].copy_from_slice(pose.1.as_slice());
        y.fixed_rows_mut::<3>(15).copy_from(&halves(momentum).1);
        solve(|y| self.field(y), y, duration, rate)
    }

    /// The terms of the modified energy. Free motion is a straight line and a free rotation. Its Moser–Veselov steps
    /// are the free motion of T + h² D with D = (e₃C² − e₂CT + e₁T²)/6. Here C = ½|π|², and e_i are the elementary
    /// symmetric functions of the inverse moments (Hairer and Vilmart 2006).
    pub fn terms(&self, (position, attitude): &Pose, momentum: &Momentum) -> Terms {
        let (linear, angular) = halves(momentum);
        let moments = self.body.moments.map(f64::recip);
        let (e1, e3) = (moments.sum(), moments.product());
        let e2 = moments.x * moments.y + moments.y * moments.z + moments.z * moments.x;
        let omega = self.angular_velocity(&angular);
        let (t, c) = (angular.dot(&omega) / 2.0, angular.norm_squared() / 2.0);

        let y = attitude.transpose() * position;
        let flight = attitude.transpose() * linear / self.body.mass;
        let u = y.cross(&omega) + flight;
        let spin_rate = self.angular_velocity(&angular.cross(&omega));
        let bend = u.cross(&omega) + y.cross(&spin_rate) + flight.cross(&omega);
        let ((gradient, change), torque) = (self.gradient(&y, &u), self.torque(&y));
        Terms {
            drift: (e3 * c * c - e2 * c * t + e1 * t * t) / 6.0,
            power: gradient.dot(&u),
            power_rate: change.dot(&u) + gradient.dot(&bend),
            kick: gradient.norm_squared() / self.body.mass + torque.dot(&self.angular_velocity(&torque)),
            rate: omega.norm().max((self.body.gravitation / y.norm().powi(3)).sqrt()),
        }
    }
}
