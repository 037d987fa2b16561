//! Kirchhoff's equations as the literature writes them: nothing here is derived by the macro.
//!
//! Sources: Lamb, *Hydrodynamics*, §124; Leonard, *Stability of a bottom-heavy underwater vehicle*, Automatica 33 (1997) 331–346.

use crate::vehicle::{Vehicle, halves};
use clebsch_examples::energy_band::Terms;
use clebsch_examples::reference::{Solution, solve};
use nalgebra::{Matrix3, Matrix4, Matrix6, SVector, Vector3, Vector6};

/// A vehicle with the data of its equations.
#[derive(Clone, Copy, Debug)]
pub struct Kirchhoff {
    inverse_inertia: Matrix6<f64>,
    /// Weight times the centre of mass, body frame, N·m.
    moment: Vector3<f64>,
}

impl Kirchhoff {
    /// None where the kinetic energy is not positive.
    pub fn new(vehicle: &Vehicle) -> Option<Self> {
        Some(Self { inverse_inertia: vehicle.inverse_inertia()?, moment: vehicle.center() * vehicle.weight() })
    }

    /// (ω, v) of the momentum (Π, P).
    pub fn velocity(&self, momentum: &Vector6<f64>) -> Vector6<f64> {
        self.inverse_inertia * momentum
    }

    /// The rate of the momentum without gravity: (Π×ω + P×v, P×ω).
    fn free_rate(&self, momentum: &Vector6<f64>) -> Vector6<f64> {
        let ((angular, linear), (omega, v)) = (halves(momentum), halves(&self.velocity(momentum)));
        stack(&(angular.cross(&omega) + linear.cross(&v)), &linear.cross(&omega))
    }

    /// The torque of weight and buoyancy, Γ×(m g r) with Γ = Rᵀe₃ the direction upwards.
    fn torque(&self, upwards: &Vector3<f64>) -> Vector6<f64> {
        stack(&upwards.cross(&self.moment), &Vector3::zeros())
    }

    /// ẏ for y = (Π, P, R by columns, x): with Ṙ = R ω̂ and ẋ = R v.
    fn field(&self, y: &SVector<f64, 18>) -> SVector<f64, 18> {
        let momentum: Vector6<f64> = y.fixed_rows::<6>(0).into();
        let rotation = Matrix3::from_column_slice(&y.as_slice()[6..15]);
        let (omega, v) = halves(&self.velocity(&momentum));
        let upwards: Vector3<f64> = rotation.row(2).transpose();
        let turning = rotation * omega.cross_matrix();
        let mut rate = SVector::<f64, 18>::zeros();
        rate.fixed_rows_mut::<6>(0).copy_from(&(self.free_rate(&momentum) + self.torque(&upwards)));
        rate.as_mut_slice()[6..15].copy_from_slice(turning.as_slice());
        rate.fixed_rows_mut::<3>(15).copy_from(&(rotation * v));
        rate
    }

    /// The motion from a pose and a momentum, by extrapolation.
    pub fn motion(&self, pose: &Matrix4<f64>, momentum: &Vector6<f64>, duration: f64, rate: f64) -> Solution<18> {
        solve(|y| self.field(y), state(pose, momentum), duration, rate)
    }

    /// The terms of the modified energy, with V = Γ·m g r.
    ///
    /// With the body velocity η of the exact motion, F = exp(hη) and 2(F − I)(F + I)⁻¹ = hη − h³η³/12 + …. The action
    /// of the exact motion is h ℓ(η) − h³ f·𝕀⁻¹f/24, as η turns by f along a step. Here f is the free rate of the
    /// momentum. So the drift is the free motion of T + h² D with D = ⟨μ, η³⟩/12 − f·𝕀⁻¹f/24, and η³ = (−|ω|²ω,
    /// ω×(ω×v)).
    pub fn terms(&self, pose: &Matrix4<f64>, momentum: &Vector6<f64>) -> Terms {
        let upwards: Vector3<f64> = pose.fixed_view::<1, 3>(2, 0).transpose();
        let (angular, linear) = halves(momentum);
        let (omega, v) = halves(&self.velocity(momentum));
        let (free, torque) = (self.free_rate(momentum), self.torque(&upwards));
        let turning = upwards.cross(&omega);
        let spin_rate = halves(&self.velocity(&free)).0;
        let cube = linear.dot(&omega.cross(&omega.cross(&v))) - omega.norm_squared() * angular.dot(&omega);
        let stiffest = self.inverse_inertia.fixed_view::<3, 3>(0, 0).trace();
        Terms {
            drift: cube / 12.0 - free.dot(&self.velocity(&free)) / 24.0,
            power: turning.dot(&self.moment),
            power_rate: (turning.cross(&omega) + upwards.cross(&spin_rate)).dot(&self.moment),
            kick: torque.dot(&self.velocity(&torque)),
            rate: omega
                .norm()
                .max((self.moment.norm() * stiffest).sqrt())
                .max((linear.norm() * v.norm() * stiffest).sqrt()),
        }
    }
}

/// (Π, P, R by columns, x)
pub fn state(pose: &Matrix4<f64>, momentum: &Vector6<f64>) -> SVector<f64, 18> {
    let mut y = SVector::<f64, 18>::zeros();
    y.fixed_rows_mut::<6>(0).copy_from(momentum);
    for column in 0..4 {
        y.fixed_rows_mut::<3>(6 + 3 * column).copy_from(&pose.fixed_view::<3, 1>(0, column));
    }
    y
}

fn stack(angular: &Vector3<f64>, linear: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(angular.x, angular.y, angular.z, linear.x, linear.y, linear.z)
}
