//! Attitudes: rotations by an angle about an axis.

use clebsch_examples::flags::finite_list;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

/// Turns that are less than this, rad, are none.
const NOTICEABLE: f64 = 1e-6;

/// The rotation from the body to space, written as an axis of any length and an angle in degrees.
///
/// # Errors
/// An axis without a direction.
pub fn parse(text: &str) -> Result<Matrix3<f64>, String> {
    let [x, y, z, degrees] = finite_list::<4>(text)?;
    let axis = Unit::try_new(Vector3::new(x, y, z), 0.0).filter(|axis| axis.iter().all(|entry| entry.is_finite()));
    let axis = axis.ok_or_else(|| "an axis needs a direction: three numbers that are not all zero".to_owned())?;
    Ok(*Rotation3::from_axis_angle(&axis, degrees.to_radians()).matrix())
}

/// The axis in the body times the angle, rad, up to π, of the rotation that turns one attitude to another.
pub fn turn(from: &Matrix3<f64>, to: &Matrix3<f64>) -> Vector3<f64> {
    let between = from.transpose() * to;
    let skew = (between - between.transpose()) / 2.0;
    let sine = Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)]);
    let angle = sine.norm().atan2((between.trace() - 1.0) / 2.0);
    if sine.norm() > 1e-8 {
        return sine * (angle / sine.norm());
    }
    if angle < 1.0 {
        return sine;
    }
    // Half a turn: (R + I)/2 is the projector on the axis.
    let projector = (between + Matrix3::identity()) / 2.0;
    let longest = (0..3).max_by(|&i, &j| projector[(i, i)].total_cmp(&projector[(j, j)])).unwrap_or(0);
    projector.column(longest).normalize() * angle
}

/// The [`turn`] between different attitudes.
///
/// # Errors
/// [`Failure::Flags`] where the attitudes are equal.
pub fn noticeable_turn(from: &Matrix3<f64>, to: &Matrix3<f64>) -> Result<Vector3<f64>, Failure> {
    let turn = turn(from, to);
    if turn.norm() < NOTICEABLE {
        return Err(Failure::Flags("--from and --to: two different attitudes are needed".to_owned()));
    }
    Ok(turn)
}
