//! Rotations near each other: exponential, logarithm, and their derivatives.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// Below this angle, radians, the series are exact to round-off.
const SMALL: f64 = 1e-4;

/// exp(v̂), by the angle |v| about v.
pub fn exponential(v: &Vector3<f64>) -> Matrix3<f64> {
    Rotation3::from_scaled_axis(*v).into_inner()
}

/// The rotation vector of a rotation, its length from 0 to π, radians; discontinuous at π.
///
/// By way of the quaternion, which loses no digits of small angles, as the arc cosine of the trace does.
pub fn logarithm(rotation: &Matrix3<f64>) -> Vector3<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*rotation)).scaled_axis()
}

/// J(v) with exp((v + δ)^) = exp(v̂) exp((J δ)^) to first order: I − (1 − cos θ)/θ² v̂ + (θ − sin θ)/θ³ v̂², θ = |v|.
///
/// Source: Chirikjian, *Stochastic Models, Information Theory, and Lie Groups* 2 (2012), chapter 10.
pub fn right_jacobian(v: &Vector3<f64>) -> Matrix3<f64> {
    let (angle, hat) = (v.norm(), v.cross_matrix());
    let (first, second) = if angle < SMALL {
        (0.5 - angle * angle / 24.0, 1.0 / 6.0 - angle * angle / 120.0)
    } else {
        (((angle / 2.0).sin() / angle).powi(2) * 2.0, (angle - angle.sin()) / angle.powi(3))
    };
    Matrix3::identity() - hat * first + hat * hat * second
}

/// J(v)⁻¹ = I + ½v̂ + (1 − θ/2 cot(θ/2))/θ² v̂²: how the logarithm v of a rotation moves with a motion of the body; singular at 2π.
pub fn inverse_right_jacobian(v: &Vector3<f64>) -> Matrix3<f64> {
    let (angle, hat) = (v.norm(), v.cross_matrix());
    let second = if angle < SMALL {
        1.0 / 12.0 + angle * angle / 720.0
    } else {
        (1.0 - angle / 2.0 / (angle / 2.0).tan()) / (angle * angle)
    };
    Matrix3::identity() + hat / 2.0 + hat * hat * second
}

#[cfg(test)]
mod tests {
    use super::*;

    const VECTORS: [Vector3<f64>; 3] =
        [Vector3::new(0.3, -1.0, 2.0), Vector3::new(1e-3, 2e-3, -3e-3), Vector3::new(1e-6, 2e-6, -3e-5)];

    #[test]
    fn the_logarithm_is_that_of_the_exponential() {
        for v in VECTORS {
            assert!((logarithm(&exponential(&v)) - v).norm() < 1e-15 + 1e-15 * v.norm());
        }
    }

    #[test]
    fn jacobians_are_those_of_the_logarithm_and_inverse_to_each_other() {
        for v in VECTORS {
            let product = right_jacobian(&v) * inverse_right_jacobian(&v);
            assert!((product - Matrix3::identity()).amax() < 1e-8, "{product}");
            let motion = Vector3::new(1.0, -2.0, 0.5);
            let moved = |s: f64| logarithm(&(exponential(&v) * exponential(&(motion * s))));
            let slope = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            assert!((slope - inverse_right_jacobian(&v) * motion).amax() < 1e-8);
        }
    }
}
