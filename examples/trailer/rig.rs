//! The numbers of the rig, its poses with the hitch closed, and its velocities.

use super::declaration::{Place, Poses, TractorTrailer};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3, Vector6};

/// Half of the width of both bodies, m.
const HALF_WIDTH: f64 = 0.4;
/// The rear and the front of the bodies from their wheels, m.
const ENDS: [[f64; 2]; 2] = [[-0.25, 0.85], [-0.5, 0.7]];

/// A small tractor with a trailer that may fold up to an angle, rad.
pub fn rig(top_thrust: f64, top_torque: f64, fold: f64) -> TractorTrailer {
    TractorTrailer {
        mass: [200.0, 80.0],
        inertia: [30.0, 20.0],
        offset: [0.1, 0.1],
        hitch: [Vector2::new(-0.3, 0.0), Vector2::new(1.2, 0.0)],
        arm: 0.4,
        top_thrust,
        top_torque,
        least_cosine: fold.cos(),
    }
}

/// The rig at rest with the tractor at x, y, m, and this heading. The trailer is turned back by `fold`, rad.
pub fn at_rest(rig: &TractorTrailer, [x, y]: [f64; 2], heading: f64, fold: f64) -> Place {
    let tractor = pose(heading, Vector2::new(x, y));
    let behind = rotation(&pose(heading - fold, Vector2::zeros()));
    let axle = point(&tractor, &rig.hitch[0]) - behind * rig.hitch[1];
    ([tractor, pose(heading - fold, axle)], Vector6::zeros())
}

fn pose(heading: f64, position: Vector2<f64>) -> Matrix3<f64> {
    let (sin, cos) = heading.sin_cos();
    Matrix3::new(cos, -sin, position.x, sin, cos, position.y, 0.0, 0.0, 1.0)
}

/// R
pub fn rotation(pose: &Matrix3<f64>) -> Matrix2<f64> {
    pose.fixed_view::<2, 2>(0, 0).into()
}

/// The middle of the wheels, m.
pub fn position(pose: &Matrix3<f64>) -> Vector2<f64> {
    pose.fixed_view::<2, 1>(0, 2).into()
}

/// A point of a body in space, m.
pub fn point(pose: &Matrix3<f64>, at: &Vector2<f64>) -> Vector2<f64> {
    rotation(pose) * at + position(pose)
}

/// The heading from −π to π.
pub fn heading(pose: &Matrix3<f64>) -> f64 {
    pose[(1, 0)].atan2(pose[(0, 0)])
}

/// The angle from one pose to another, −π to π.
pub fn turn(from: &Matrix3<f64>, to: &Matrix3<f64>) -> f64 {
    let turn = rotation(from).transpose() * rotation(to);
    turn[(1, 0)].atan2(turn[(0, 0)])
}

/// The angle of the hitch, from the trailer to the tractor, −π to π.
pub fn fold([tractor, trailer]: &Poses) -> f64 {
    turn(trailer, tractor)
}

/// The distance of both points of the hitch, m.
pub fn hitch_error(rig: &TractorTrailer, [tractor, trailer]: &Poses) -> f64 {
    (point(tractor, &rig.hitch[0]) - point(trailer, &rig.hitch[1])).norm()
}

/// (ω, v_x, v_y) of a body by its momentum: π = I ω + c p_y and p = m (v_x, v_y + c ω).
pub fn velocity(rig: &TractorTrailer, (_, momentum): &Place, body: usize) -> Vector3<f64> {
    let momentum = momentum.fixed_rows::<3>(3 * body);
    let (mass, offset) = (rig.mass[body], rig.offset[body]);
    let omega = (momentum.x - offset * momentum.z) / rig.inertia[body];
    Vector3::new(omega, momentum.y / mass, momentum.z / mass - offset * omega)
}

/// The outlines of both bodies and of the drawbar, m.
pub fn outline(rig: &TractorTrailer, poses: &Poses, body: usize) -> Vec<(f64, f64)> {
    let [rear, front] = ENDS[body];
    let corners = [(front, 1.0), (rear, 1.0), (rear, -1.0), (front, -1.0), (front, 1.0)];
    let corners = corners.map(|(x, side)| Vector2::new(x, side * HALF_WIDTH));
    // the drawbar joins the body to the hitch
    let end = if body == 0 { rear } else { front };
    let drawbar = [Vector2::new(f64::NAN, 0.0), Vector2::new(end, 0.0), rig.hitch[body]];
    let in_space = |at: Vector2<f64>| {
        let at = point(&poses[body], &at);
        (at.x, at.y)
    };
    corners.into_iter().chain(drawbar).map(in_space).collect()
}
