//! Brackets, damping, factors and spectra, each by itself.

use super::gap::{arc_per_chord, regular, singular};
use super::{Bracket, Ldl, Spectrum, adapted};
use crate::runner::proptest;
use nalgebra::{Matrix3, Matrix4, SMatrix, Vector3};
use proptest::prelude::*;

/// The zero of h − 1/h³, and its limits.
#[test]
fn zeros_are_found_within_limits() {
    for (limits, expected) in [(0.1..=10.0, 1.0), (2.0..=3.0, 2.0), (0.1..=0.5, 0.5)] {
        let mut bracket = Bracket::within(&limits).expect("limits in order");
        let (mut h, mut trials) = (bracket.inside(0.3), 0);
        loop {
            let slope: f64 = h - 1.0 / (h * h * h);
            let next = bracket.next(h, slope, h);
            trials += 1;
            if (next - h).abs() < 1e-14 {
                break;
            }
            h = next;
        }
        assert!((h - expected).abs() < 1e-13 && trials < 25, "{h} after {trials}");
    }
}

/// Below 1 there are no values.
#[test]
fn impossible_step_sizes_are_kept_away_from() {
    let mut bracket = Bracket::within(&(0.1..=10.0)).expect("limits in order");
    let mut h: f64 = bracket.inside(8.0);
    for _ in 0..60 {
        h = if h > 1.0 {
            bracket.next(h, h - 1.01, h)
        } else {
            bracket.retreat(h).expect("the first step size is possible")
        };
    }
    assert!((h - 1.01).abs() < 1e-13, "{h}");
}

#[test]
fn damping_comes_and_goes_by_factors_of_eight() {
    let once = adapted(0.0, 0.125, 3);
    let twice = adapted(once, 0.125, 3);
    assert_eq!((once, twice), (1.0, 8.0));
    assert_eq!(adapted(twice, 0.125, 1), 8.0);
    assert_eq!(adapted(once, 0.125, 0), 0.125);
    assert_eq!(adapted(0.125, 0.125, 0), 0.0);
}

#[test]
fn kernels_are_found() {
    let q = Vector3::new(0.6, 0.0, 0.8);
    let metric = Matrix3::identity() - q * q.transpose();
    let b = Vector3::new(0.8, 2.0, -0.6);
    assert_eq!(regular(&metric, &b), None);
    let (closing, kernel) = singular(&metric, &b);
    assert!((closing - b).amax() < 1e-15);
    assert!((kernel.unwrap() - q * q.transpose()).amax() < 1e-15);
    assert_eq!(regular(&(Matrix3::identity() * 2.0), &b), Some(b / 2.0));
}

#[test]
fn arcs_are_no_shorter_than_chords() {
    let angle = 3.1_f64;
    let arc = angle.sin() * arc_per_chord(angle.sin(), 1.0 - angle.cos()).expect("it is longer");
    assert!((arc - angle).abs() < 1e-12, "{arc}");
    assert_eq!(arc_per_chord(1.0, 0.0), None);
    assert_eq!(arc_per_chord(0.0, 0.0), None);
}

const A: [[f64; 4]; 4] = [[4.0, 1.0, 0.5, -1.0], [1.0, 5.0, 0.25, 0.5], [0.5, 0.25, 3.0, 0.75], [-1.0, 0.5, 0.75, 6.0]];

#[test]
fn definite_matrices_are_inverted() {
    let negative = A.map(|row| row.map(|entry| -entry));
    let [positive, other] = [Ldl::definite(&A, 1.0), Ldl::positive(&A)].map(|factors| factors.expect("definite"));
    for (a, factors) in [(A, positive), (A, other), (negative, Ldl::definite(&negative, -1.0).expect("definite"))] {
        let b = [[1.0], [-2.0], [0.5], [3.0]];
        let mut w = b;
        factors.forward(&mut w);
        let mut x = factors.divided(&w);
        factors.backward(&mut x);
        for (row, [b]) in a.iter().zip(b) {
            let product: f64 = row.iter().zip(x).map(|(entry, [x])| entry * x).sum();
            assert!((product - b).abs() < 1e-14, "{product} for {b}");
        }
    }
}

#[test]
fn others_are_refused() {
    let mut indefinite = A;
    indefinite[2][2] = -3.0;
    assert!(Ldl::definite(&indefinite, 1.0).is_none() && Ldl::positive(&indefinite).is_none());
    assert!(Ldl::definite(&A, -1.0).is_none());
    assert!(Ldl::positive(&[[f64::NAN]]).is_none() && Ldl::definite(&[[f64::NAN]], 1.0).is_none());
    assert!(Ldl::positive(&[[1.0, 1.0], [1.0, 1.0 + f64::EPSILON]]).is_none(), "round-off");
}

#[test]
fn a_diagonal_matrix_is_left_alone() {
    let spectrum = Spectrum::of(&SMatrix::<f64, 3, 3>::from_diagonal(&[3.0, -1.0, 0.0].into()));
    assert_eq!(spectrum.values.as_slice(), [3.0, -1.0, 0.0]);
    assert_eq!(spectrum.vectors, Matrix3::identity());
    assert_eq!(spectrum.largest(), 3.0);
}

proptest! {
    #[test]
    fn a_symmetric_matrix_is_composed_of_its_spectrum(a in prop::array::uniform4(prop::array::uniform4(-1.0_f64..1.0))) {
        let a = Matrix4::from(a);
        let a = a + a.transpose();
        let spectrum = Spectrum::of(&a);
        let v = spectrum.vectors;
        prop_assert!((v.transpose() * v - Matrix4::identity()).amax() < 1e-14);
        prop_assert!((spectrum.map(|x| x) - a).amax() < 1e-14);
        prop_assert!((spectrum.map(|x| x * x) - a * a).amax() < 1e-13);
    }
}
