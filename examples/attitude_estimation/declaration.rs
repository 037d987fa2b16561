//! The satellite, as the macro is given it.

use clebsch::Clebsch;

/// A satellite with a gyro that drifts and a magnetometer. Its place is the attitude R and the bias b of the gyro, and its inputs are the rate ω and the drift ḃ.
///
/// The price is −ln of the probability density of all that is measured. References are the gyro, and the field of the Earth
/// as it is known in space and as it is measured by the satellite.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |(F, s): (SO<3>, Translation<3>), (R, b): (SO<3>, Vector3)| (R * F, b + s),
    controls       = |u: Vector6| (u.fixed_rows::<3>(0), u.fixed_rows::<3>(3)),
    discretization = exponential,
    cost           = |R, b, u, (gyro, known, measured): (Vector3, Vector3, Vector3)| {
        let rate = u.fixed_rows::<3>(0);
        let drift = u.fixed_rows::<3>(3);
        ((rate + b - gyro).norm_squared() / self.gyro_variance
            + drift.norm_squared() / self.drift_variance
            + (R.transpose() * known - measured).norm_squared() / self.field_variance) / 2
    },
    endpoint       = |R, b, (last, seen): (Vector3, Vector3)| (R.transpose() * last - seen).norm_squared() / self.field_variance / 2,
)]
pub struct Satellite {
    /// Of the mean of the gyro over a step, rad²/s².
    pub gyro_variance: f64,
    /// Of the drift of its bias, rad²/s⁴.
    pub drift_variance: f64,
    /// Of each component of the magnetometer, μT².
    pub field_variance: f64,
}
