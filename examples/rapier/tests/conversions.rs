//! The conversions of the book between glam, whose types rapier has, and nalgebra.

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};
use rapier3d::glamx::{DMat3, DQuat, DVec3, Quat};
use std::f64::consts::PI;

fn attitudes() -> impl Iterator<Item = DQuat> {
    let axis = DVec3::new(0.6, 0.0, -0.8);
    // a quarter of a turn, and nearly half a turn either way
    [0.0, 1.5, PI - 1e-8, 1e-8 - PI].into_iter().map(move |angle| DQuat::from_axis_angle(axis, angle))
}

/// The same turn takes a vector to the same place.
fn assert_same(quaternion: DQuat, turned: Vector3<f64>, allowed: f64) {
    let expected = quaternion * DVec3::new(0.3, -1.0, 2.0);
    let difference = turned - Vector3::from(expected);
    assert!(difference.norm() < allowed, "{quaternion}: {difference}");
}

#[test]
fn turns_of_glam_and_nalgebra_are_the_same() {
    let vector = Vector3::new(0.3, -1.0, 2.0);
    for theirs in attitudes() {
        let quaternion = Quaternion::from(theirs);
        assert_same(theirs, UnitQuaternion::new_normalize(quaternion) * vector, 1e-14);
        assert_eq!(DQuat::from(quaternion), theirs);
        assert_eq!(Quaternion::from(theirs.to_array()), quaternion, "both have the order x, y, z, w");

        let matrix = Matrix3::from(DMat3::from_quat(theirs));
        assert_same(theirs, matrix * vector, 1e-14);
        assert_eq!(DMat3::from(matrix), DMat3::from_quat(theirs));

        let unit = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
        assert_same(theirs, unit * vector, 1e-14);
        let back = DQuat::from_mat3(&DMat3::from(matrix));
        assert!(back.dot(theirs).abs() > 1.0 - 1e-15, "{back} {theirs}");

        let single: Quat = theirs.as_quat();
        let wide = Quaternion::from(single).cast::<f64>().normalize();
        assert!((wide.norm() - 1.0).abs() < 1e-15);
        assert_same(theirs, UnitQuaternion::new_unchecked(wide) * vector, 1e-6);
        assert!(Quat::from(wide.cast::<f32>()).dot(single) > 1.0 - 1e-6);
    }
}
