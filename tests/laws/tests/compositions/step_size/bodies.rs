//! Bodies and tops.

use super::{Exact, assert_error, exact};
use crate::flat;
use crate::systems::{eighth, fourth, second, sixth};
use clebsch::Clebsch;
use clebsch_tests::oracle::rotation::hat;
use nalgebra::{Matrix3, Matrix4, Rotation3, SVector, Vector3, Vector4, Vector6};

/// Ṙ = R ω^, π̇ = π × ω − weight center × Rᵀe₃; momenta are in units of the first.
fn turning(
    moments: Vector3<f64>,
    (weight, center): (f64, Vector3<f64>),
    (r, pi): (Matrix3<f64>, Vector3<f64>),
    (duration, steps): (f64, usize),
) -> Exact<12> {
    let size = pi.norm();
    let field = move |y: &SVector<f64, 12>| {
        let (r, pi) = (Matrix3::from_column_slice(&y.as_slice()[..9]), Vector3::new(y[9], y[10], y[11]) * size);
        let omega = pi.component_div(&moments);
        let torque = pi.cross(&omega) - weight * center.cross(&r.row(2).transpose());
        flat(&[(r * hat(&omega)).as_slice(), (torque / size).as_slice()])
    };
    exact(field, flat(&[r.as_slice(), (pi / size).as_slice()]), duration, steps)
}

macro_rules! tops {
    ($moments:expr, $weight:expr, $start:expr, $duration:expr, $h:expr, $steps:expr) => {{
        let (moments, weight, center, start) = ($moments, $weight, Vector3::z(), $start);
        let inertia = Matrix3::from_diagonal(&moments);
        let exact = turning(moments, (weight, center), start, ($duration, $steps));
        let size = start.1.norm();
        let flat = |r: &Matrix3<f64>, pi: &Vector3<f64>| flat(&[r.as_slice(), (pi / size).as_slice()]);
        assert_error(&second::Top { inertia, weight, center }, start, ($duration, $h), &exact, flat);
        assert_error(&fourth::Top { inertia, weight, center }, start, ($duration, $h), &exact, flat);
        assert_error(&sixth::Top { inertia, weight, center }, start, ($duration, $h), &exact, flat);
        assert_error(&eighth::Top { inertia, weight, center }, start, ($duration, $h), &exact, flat);
    }};
}

#[test]
fn a_free_body() {
    tops!(Vector3::new(1.0, 2.0, 3.0), 0.0, (Matrix3::identity(), Vector3::new(0.3, 2.0, 0.6)), 100.0, 0.25, 1000);
}

#[test]
fn a_heavy_top() {
    let attitude = *Rotation3::from_axis_angle(&Vector3::x_axis(), 0.5).matrix();
    tops!(Vector3::new(1.0, 1.5, 2.0), 1.0, (attitude, Vector3::new(0.1, 0.3, 10.0)), 50.0, 0.1, 2000);
}

#[test]
fn a_free_body_in_four_dimensions() {
    let d = Vector4::new(1.0, 1.5, 2.0, 2.5);
    let j_d = Matrix4::from_diagonal(&d);
    // the components of a momentum are twice the entries of M below its diagonal
    let m = Vector6::new(0.3, -0.5, 0.2, 0.6, -0.1, 0.5);
    let size: f64 = 2.0 * m.norm();
    let start = (Matrix4::identity(), m * -2.0);
    let field = |y: &SVector<f64, 22>| {
        let (r, m) = (
            Matrix4::from_column_slice(&y.as_slice()[..16]),
            second::Body4::momentum_matrix(&(y.fixed_rows::<6>(16) * size)),
        );
        let omega = Matrix4::from_fn(|i, j| if i == j { 0.0 } else { m[(i, j)] / (d[i] + d[j]) });
        let rate: Vector6<f64> = second::Body4::momentum_components(&(m * omega - omega * m));
        flat(&[(r * omega).as_slice(), (rate / size).as_slice()])
    };
    let flat = |r: &Matrix4<f64>, m: &Vector6<f64>| flat(&[r.as_slice(), (m / size).as_slice()]);
    let exact = exact(field, flat(&start.0, &start.1), 100.0, 1000);
    assert_error(&second::Body4 { j_d }, start, (100.0, 0.5), &exact, flat);
    assert_error(&fourth::Body4 { j_d }, start, (100.0, 0.5), &exact, flat);
    assert_error(&sixth::Body4 { j_d }, start, (100.0, 0.5), &exact, flat);
    assert_error(&eighth::Body4 { j_d }, start, (100.0, 0.5), &exact, flat);
}
