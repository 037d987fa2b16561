//! The extended Kalman filter that satellites fly, by hand. Its error is a small rotation of the body and a change of the bias.
//!
//! Source: Lefferts, Markley and Shuster, *Kalman filtering for spacecraft attitude estimation* (1982).

use crate::orbit::{Orbit, turned};
use crate::{Estimate, Start};
use nalgebra::{Matrix3, Matrix3x6, Matrix6, Vector3, Vector6};

/// The matrix of w ↦ v × w.
fn cross(v: &Vector3<f64>) -> Matrix3<f64> {
    v.cross_matrix()
}

/// The estimates at all places.
pub fn filter(orbit: &Orbit, start: &Start) -> Vec<Estimate> {
    let (h, satellite) = (orbit.h, &orbit.satellite);
    let (mut attitude, mut bias) = start.place;
    let mut covariance = start.covariance();
    let mut estimates = Vec::new();
    for (k, (known, measured)) in orbit.field.iter().enumerate() {
        let expected = attitude.transpose() * known;
        let mut slope = Matrix3x6::zeros();
        slope.fixed_columns_mut::<3>(0).copy_from(&cross(&expected));
        let error = Matrix3::identity() * satellite.field_variance;
        let inverse = (slope * covariance * slope.transpose() + error).try_inverse().unwrap_or_default();
        let gain = covariance * slope.transpose() * inverse;
        let change: Vector6<f64> = gain * (measured - expected);
        let kept = Matrix6::identity() - gain * slope;
        covariance = kept * covariance * kept.transpose() + gain * error * gain.transpose();
        attitude *= turned(&change.fixed_rows::<3>(0).into());
        bias += change.fixed_rows::<3>(3);
        estimates.push(Estimate { k, place: (attitude, bias), information: covariance.try_inverse() });
        let Some(gyro) = orbit.gyro.get(k) else { break };
        let rate = gyro - bias;
        let turn = turned(&(rate * h));
        let mut carry = Matrix6::identity();
        carry.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn.transpose());
        carry.fixed_view_mut::<3, 3>(0, 3).copy_from(&(cross(&rate) * (h * h / 2.0) - Matrix3::identity() * h));
        let (white, walk) = (satellite.gyro_variance * h * h, satellite.drift_variance * h * h);
        let mut noise = Matrix6::zeros();
        noise.fixed_view_mut::<3, 3>(0, 0).copy_from(&(Matrix3::identity() * white));
        noise.fixed_view_mut::<3, 3>(3, 3).copy_from(&(Matrix3::identity() * walk));
        covariance = carry * covariance * carry.transpose() + noise;
        attitude *= turn;
    }
    estimates
}
