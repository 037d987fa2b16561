//! Poses, and where the quadrotor is in terms of position and velocity.

use super::declaration::Place;
use nalgebra::{Matrix3, Matrix4, Rotation3, Vector3, Vector6};

/// Hovering at a position, m, turned about the vertical, rad.
pub fn hovering(position: &Vector3<f64>, yaw: f64) -> Place {
    (pose(Rotation3::from_axis_angle(&Vector3::z_axis(), yaw).matrix(), position), Vector6::zeros())
}

/// A pose of attitude and position.
pub fn pose(attitude: &Matrix3<f64>, position: &Vector3<f64>) -> Matrix4<f64> {
    let mut pose = Matrix4::identity();
    pose.fixed_view_mut::<3, 3>(0, 0).copy_from(attitude);
    pose.fixed_view_mut::<3, 1>(0, 3).copy_from(position);
    pose
}

/// R, body to space.
pub fn attitude(place: &Place) -> Matrix3<f64> {
    place.0.fixed_view::<3, 3>(0, 0).into()
}

/// m, space.
pub fn position(place: &Place) -> Vector3<f64> {
    place.0.fixed_view::<3, 1>(0, 3).into()
}

/// m/s, space.
pub fn velocity(place: &Place, mass: f64) -> Vector3<f64> {
    attitude(place) * place.1.fixed_rows::<3>(3) / mass
}

/// N·m·s, body frame.
pub fn spin(place: &Place) -> Vector3<f64> {
    place.1.fixed_rows::<3>(0).into()
}

/// Axis times sine of the angle from one attitude to another nearby, body frame.
pub fn turned(from: &Matrix3<f64>, to: &Matrix3<f64>) -> Vector3<f64> {
    let between = from.transpose() * to;
    let skew = (between - between.transpose()) / 2.0;
    Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)])
}

/// How far the body's third axis leans from the vertical, rad.
pub fn tilt(place: &Place) -> f64 {
    attitude(place)[(2, 2)].clamp(-1.0, 1.0).acos()
}
