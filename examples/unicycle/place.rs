//! Places of the unicycle: its position and its heading.

use clebsch_examples::flags::finite_list;
use nalgebra::{Matrix3, Vector3};

/// The matrix [R x; 0 1] of a position, m, and a heading, rad.
pub fn at(x: f64, y: f64, heading: f64) -> Matrix3<f64> {
    let (sin, cos) = heading.sin_cos();
    Matrix3::new(cos, -sin, x, sin, cos, y, 0.0, 0.0, 1.0)
}

/// Written as x, y in metres and the heading in degrees.
///
/// # Errors
/// A text that is not three numbers.
pub fn parse(text: &str) -> Result<Matrix3<f64>, String> {
    let [x, y, degrees] = finite_list::<3>(text)?;
    // quarters of a turn are exact
    let quarters = degrees / 90.0;
    let rounded = at(x, y, degrees.to_radians());
    Ok(if quarters.fract() == 0.0 {
        rounded.map(|entry| if entry.abs() < 1e-9 { 0.0 } else { entry })
    } else {
        rounded
    })
}

/// x, y, and the heading from −π to π.
pub fn coordinates(place: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(place[(0, 2)], place[(1, 2)], place[(1, 0)].atan2(place[(0, 0)]))
}

/// How far `to` is from `from`, in coordinates that vanish only where both are equal.
pub fn apart(from: &Matrix3<f64>, to: &Matrix3<f64>) -> Vector3<f64> {
    coordinates(&(inverse(from) * to))
}

fn inverse(place: &Matrix3<f64>) -> Matrix3<f64> {
    let rotation = place.fixed_view::<2, 2>(0, 0).transpose();
    let position = -(rotation * place.fixed_view::<2, 1>(0, 2));
    let mut inverse = Matrix3::identity();
    inverse.fixed_view_mut::<2, 2>(0, 0).copy_from(&rotation);
    inverse.fixed_view_mut::<2, 1>(0, 2).copy_from(&position);
    inverse
}
