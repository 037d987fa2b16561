//! The continuous problem by Pontryagin's conditions: nothing here is derived by the macro.
//!
//! Ṙ = R ω̂ and π̇ = π × ω + u with ω = J⁻¹π. Costates p of the attitude and ν of the momentum obey ṗ = p × ω and ν̇ =
//! ν × ω − J⁻¹(p + ν × π). The Hamiltonian ½ |u|² + p·ω + ν·π̇ is least for u = −ν, cut off at the bounds. Units:
//! duration and mean principal moment are 1.

use super::problem::Problem;
use crate::attitude::turn;
use clebsch_examples::extremal::{self, Pontryagin, Shot};
use nalgebra::{Matrix3, SVector, Vector3, Vector6};

/// Extremals from one attitude at rest.
#[derive(Clone, Copy, Debug)]
pub struct Extremals {
    inverse_inertia: Matrix3<f64>,
    start: Matrix3<f64>,
    top: f64,
    /// kg·m²/s in a unit of momentum.
    pub momentum_unit: f64,
    /// N²·m²·s in a unit of effort.
    pub effort_unit: f64,
}

/// R, π, p, ν and the effort so far.
type Packed = SVector<f64, 19>;
/// Where an extremal is.
pub type Motion = extremal::Motion<19, 3>;

/// R, from the body to space.
pub fn attitude(motion: &Motion) -> Matrix3<f64> {
    Matrix3::from_column_slice(&motion.y.as_slice()[..9])
}

/// π, body frame.
pub fn momentum(motion: &Motion) -> Vector3<f64> {
    motion.y.fixed_rows::<3>(9).into()
}

/// ∫ ½ |u|² dt up to here.
pub fn effort(motion: &Motion) -> f64 {
    motion.y[18]
}

impl Extremals {
    /// Of a problem.
    pub fn new(problem: &Problem) -> Self {
        let (unit, duration) = (problem.body.moments.mean(), problem.duration);
        let torque_unit = unit / duration.powi(2);
        Self {
            inverse_inertia: (problem.body.inertia / unit).try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN)),
            start: problem.from,
            top: problem.top / torque_unit,
            momentum_unit: unit / duration,
            effort_unit: torque_unit.powi(2) * duration,
        }
    }

    /// The extremal that ends at an attitude at rest, near these costates of a plan; `None` where corrections do not end.
    pub fn aim(&self, to: &Matrix3<f64>, near: &Vector6<f64>) -> Option<Shot<6>> {
        let (p, nu) = (near.fixed_rows::<3>(0) / self.effort_unit, near.fixed_rows::<3>(3));
        let nu = nu * (self.momentum_unit / self.effort_unit);
        let guess = Vector6::new(p.x, p.y, p.z, nu.x, nu.y, nu.z);
        Shot::aim(&guess, &Vector6::repeat(1.0), |costates| {
            let end = self.after(&self.start(costates), 1.0);
            let (angle, momentum) = (turn(to, &attitude(&end)), momentum(&end));
            (Vector6::new(angle.x, angle.y, angle.z, momentum.x, momentum.y, momentum.z), end.error)
        })
    }

    /// At rest, with these costates (p, ν).
    pub fn start(&self, costates: &Vector6<f64>) -> Motion {
        let mut y = Packed::zeros();
        y.as_mut_slice()[..9].copy_from_slice(self.start.as_slice());
        y.fixed_rows_mut::<6>(12).copy_from(costates);
        self.begin(y)
    }
}

impl Pontryagin<19, 3> for Extremals {
    fn field(&self, y: &Packed, held: [i8; 3]) -> Packed {
        let part = |row: usize| -> Vector3<f64> { y.fixed_rows::<3>(row).into() };
        let (momentum, p, nu) = (part(9), part(12), part(15));
        let omega = self.inverse_inertia * momentum;
        let torque = Vector3::from_fn(|axis, _| match held[axis] {
            0 => -nu[axis],
            side => self.top * f64::from(side),
        });
        let mut rate = Packed::zeros();
        let turning = Matrix3::from_column_slice(&y.as_slice()[..9]) * omega.cross_matrix();
        rate.as_mut_slice()[..9].copy_from_slice(turning.as_slice());
        rate.fixed_rows_mut::<3>(9).copy_from(&(momentum.cross(&omega) + torque));
        rate.fixed_rows_mut::<3>(12).copy_from(&p.cross(&omega));
        let nu_rate = nu.cross(&omega) - self.inverse_inertia * (p + nu.cross(&momentum));
        rate.fixed_rows_mut::<3>(15).copy_from(&nu_rate);
        rate[18] = torque.norm_squared() / 2.0;
        rate
    }

    fn wanted(&self, y: &Packed) -> [i8; 3] {
        std::array::from_fn(|axis| match y[15 + axis] {
            nu if nu.abs() <= self.top => 0,
            nu if nu > 0.0 => -1,
            _ => 1,
        })
    }
}
