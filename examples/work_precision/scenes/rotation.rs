//! Bodies that turn in space, as matrices and as quaternions.

use nalgebra::{Matrix3, Quaternion, Rotation3, SVector, UnitQuaternion, Vector3};

/// Attitude by columns and body momentum, as the scenes compare them.
pub type Body = SVector<f64, 12>;
/// Quaternion (i, j, k, w) and body momentum: fewer numbers, for the classical methods.
pub type Compact = SVector<f64, 7>;

/// A matrix and a momentum in one vector.
pub fn pack(attitude: &Matrix3<f64>, momentum: &Vector3<f64>) -> Body {
    Body::from_iterator(attitude.iter().chain(momentum.iter()).copied())
}

/// A quaternion and a momentum, as a matrix and a momentum.
pub fn pack_quaternion(attitude: &Quaternion<f64>, momentum: &Vector3<f64>) -> Body {
    pack(&matrix(attitude), momentum)
}

/// The same of a compact motion.
pub fn unpack_compact(y: &Compact) -> Body {
    let (attitude, momentum) = split_compact(y);
    pack_quaternion(&attitude, &momentum)
}

/// A quaternion and a momentum in one vector.
pub fn compact(attitude: &Quaternion<f64>, momentum: &Vector3<f64>) -> Compact {
    Compact::from([attitude.i, attitude.j, attitude.k, attitude.w, momentum.x, momentum.y, momentum.z])
}

/// Attitude and body momentum.
pub fn split(y: &Body) -> (Matrix3<f64>, Vector3<f64>) {
    (Matrix3::from_column_slice(&y.as_slice()[..9]), y.fixed_rows::<3>(9).into())
}

/// Quaternion and body momentum.
pub fn split_compact(y: &Compact) -> (Quaternion<f64>, Vector3<f64>) {
    (Quaternion::new(y[3], y[0], y[1], y[2]), Vector3::new(y[4], y[5], y[6]))
}

/// Ṙ = R ω^ and π̇.
pub fn rates(attitude: &Matrix3<f64>, omega: &Vector3<f64>, torque: &Vector3<f64>) -> Body {
    pack(&(attitude * omega.cross_matrix()), torque)
}

/// Q̇ = Q ω/2 and π̇.
pub fn compact_rates(attitude: &Quaternion<f64>, omega: &Vector3<f64>, torque: &Vector3<f64>) -> Compact {
    compact(&(attitude * Quaternion::from_imag(omega / 2.0)), torque)
}

/// Turned about the first axis by this angle, rad.
pub fn tilted(angle: f64) -> Matrix3<f64> {
    *Rotation3::from_axis_angle(&Vector3::x_axis(), angle).matrix()
}

/// The same as a quaternion.
pub fn tilted_quaternion(angle: f64) -> Quaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle).into_inner()
}

/// The last row of the rotation.
#[inline(always)]
pub fn last_row(q: &Quaternion<f64>) -> Vector3<f64> {
    let (i, j, k, w) = (q.i, q.j, q.k, q.w);
    Vector3::new(2.0 * (i * k - w * j), 2.0 * (j * k + w * i), w * w - i * i - j * j + k * k)
}

/// The rotation of a quaternion that is near a unit one.
pub fn matrix(attitude: &Quaternion<f64>) -> Matrix3<f64> {
    *UnitQuaternion::new_unchecked(*attitude).to_rotation_matrix().matrix()
}

/// The largest entry of RᵀR − I.
pub fn defect(y: &Body) -> f64 {
    let attitude = split(y).0;
    (attitude.transpose() * attitude - Matrix3::identity()).amax()
}
