//! Coarse paths, arcs and pivots, each by itself.

use super::end::PathEnd;
use super::guess::{COARSE, interpolated};
use super::pivot::{Feedback, Pivot};
use crate::linear::rows;
use crate::newton::Curvature;
use nalgebra::{Matrix3, Vector1, Vector3};

#[test]
fn cubics_are_interpolated_exactly() {
    let cubic = |x: f64| Vector1::new(x * (x - 0.3) * (x - 2.0));
    let motions = core::array::from_fn(|k| cubic(k as f64 / COARSE as f64));
    for edges in [33, 50, if cfg!(miri) { 64 } else { 1000 }] {
        for k in 0..=edges {
            let error = interpolated(&motions, edges, k) - cubic(k as f64 / edges as f64);
            assert!(error.amax() < 1e-14, "{k} of {edges}");
        }
    }
}

#[test]
fn chords_become_arcs() {
    for angle in [1e-9_f64, 0.5, 3.1] {
        let radius = 3.0;
        let end = PathEnd {
            closing: Vector3::x(),
            kernel: None,
            distance: 2.0 * radius * (angle / 2.0).sin(),
            along: radius * angle.sin(),
            scale: radius,
            price: 0.0,
            slope: Vector3::zeros(),
            curvature: None,
        };
        assert!((end.arc().x * angle.sin() - angle).abs() < 1e-12, "{angle}");
    }
}

struct Solution {
    gain: Matrix3<f64>,
    shift: Vector3<f64>,
    hessian: [[f64; 3]; 3],
    gradient: Vector3<f64>,
    decrement: f64,
    negative: usize,
}

fn solve(d: &Matrix3<f64>, g: &Vector3<f64>, sign: f64, curvature: Curvature<f64>) -> Solution {
    let mut feedback = Feedback { gain: Matrix3::zeros(), shift: Vector3::zeros() };
    let pivot = Pivot { d: rows(d), c: rows(&C), g: *g, sign };
    let super::pivot::Solution { hessian, gradient, decrement, negative } = pivot.solve(curvature, &mut feedback);
    Solution { gain: feedback.gain, shift: feedback.shift, hessian, gradient, decrement, negative }
}

const C: Matrix3<f64> = Matrix3::new(1.0, 2.0, 0.5, -1.0, 0.3, 0.2, 0.7, 0.1, -2.0);

#[test]
fn definite_and_indefinite_pivots_are_solved_and_counted() {
    let g = Vector3::new(0.3, -0.2, 0.9);
    for (diagonal, negative) in
        [([4.0, 5.0, 6.0], 0), ([4.0, -5.0, 6.0], 1), ([-4.0, -5.0, -6.0], 3), ([0.0, 5.0, 0.0], 1)]
    {
        let d = Matrix3::from_diagonal(&diagonal.into()) + Matrix3::new(0.0, 1.0, 0.2, 1.0, 0.0, -0.5, 0.2, -0.5, 0.0);
        let solution = solve(&d, &g, 1.0, Curvature::exact(0.0));
        assert!((d * solution.gain - C).amax() < 1e-13, "{diagonal:?}");
        assert!((d * solution.shift - g).amax() < 1e-13, "{diagonal:?}");
        assert!((C.tr_mul(&solution.shift) - solution.gradient).amax() < 1e-13, "{diagonal:?}");
        assert!((solution.shift.dot(&g) - solution.decrement).abs() < 1e-13, "{diagonal:?}");
        let hessian = C.tr_mul(&solution.gain);
        assert!((0..3).all(|i| (0..=i).all(|j| (hessian[(i, j)] - solution.hessian[i][j]).abs() < 1e-13)));
        let backward = solve(&-d, &g, -1.0, Curvature::exact(0.0));
        assert_eq!((solution.negative, backward.negative), (negative, negative), "{diagonal:?}");
        assert!((backward.shift + solution.shift).amax() < 1e-13);
        let downhill = solve(&d, &g, 1.0, Curvature::mirrored(0.0, 0.0));
        assert!(downhill.shift.dot(&g) > 0.0);
        assert_eq!(downhill.negative, negative);
    }
}

/// The determinant of a matrix of numbers is beyond their range long before they are.
#[test]
fn pivots_of_any_size_are_solved() {
    let d = Matrix3::new(4.0, 1.0, 0.2, 1.0, 5.0, -0.5, 0.2, -0.5, 6.0);
    for scale in [1e-120, 1e-90, 1e90, 1e120] {
        let solution = solve(&(d * scale), &(Vector3::x() * scale), 1.0, Curvature::exact(0.0));
        assert!((d * solution.gain * scale - C).amax() < 1e-14, "{scale:e}");
        assert!((d * solution.shift - Vector3::x()).amax() < 1e-15, "{scale:e}");
        assert_eq!(solution.negative, 0);
    }
}

#[test]
fn a_singular_pivot_gives_finite_directions() {
    let solution =
        solve(&Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 1.0)), &Vector3::x(), 1.0, Curvature::mirrored(0.0, 0.0));
    assert!(solution.gain.amax() < 1e5 && solution.negative == 0);
}
