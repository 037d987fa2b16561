//! Attitudes of the ball: rotations by an angle about an axis.

use clebsch_examples::flags::finite_list;
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

/// The rotation of an axis of any length and an angle in degrees.
///
/// # Errors
/// An axis without a direction.
pub fn parse(text: &str) -> Result<Matrix3<f64>, String> {
    let [x, y, z, degrees] = finite_list::<4>(text)?;
    let axis = Unit::try_new(Vector3::new(x, y, z), 0.0).filter(|axis| axis.iter().all(|entry| entry.is_finite()));
    let axis = axis.ok_or_else(|| "an axis needs a direction: three numbers that are not all zero".to_owned())?;
    Ok(*Rotation3::from_axis_angle(&axis, degrees.to_radians()).matrix())
}

/// The vector of the quaternion of a rotation, with a scalar part above zero: zero only where there is no rotation, and smooth there.
pub fn turned(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let skew = rotation - rotation.transpose();
    let twice_sine = Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)]) / 2.0;
    // |sin θ| and cos θ; 2 sin(θ/2) = sin θ / cos(θ/2)
    let half = ((1.0 + rotation.trace()).max(0.0) / 4.0).sqrt();
    twice_sine / half.max(1e-3)
}

/// The rotation by which a ball of this radius rolls a way on the table. Its axis is horizontal and to the left of the
/// way, and its angle is |way|/radius.
pub fn rolled(way: &nalgebra::Vector2<f64>, radius: f64) -> Matrix3<f64> {
    *Rotation3::from_scaled_axis(Vector3::new(-way.y, way.x, 0.0) / radius).matrix()
}
