//! Group elements against series of more terms, and exact identities.

use super::{below_right_angle, below_right_angle_from, inverse, per_one_plus_cosine, quaternion_from_increment};
use crate::Error;
use nalgebra::{Matrix3, Matrix4, Quaternion, Vector1, Vector2};

#[test]
fn steps_beyond_a_quarter_turn_say_by_how_much() {
    let check = |sine_squared: f64| below_right_angle(Vector1::new(1.0), sine_squared);
    assert_eq!(check(0.99), Ok(Vector1::new(1.0)));
    assert_eq!(check(4.0), Err(Error::Unsolvable { solvable_fraction: 0.5, step_size: None, solvable_step: None }));
    assert_eq!(check(f64::NAN), Err(Error::NotFinite { name: "the momentum" }));
}

/// |d + s (a − d)| = 1 at the fraction s, with the sine d where there is no momentum.
#[test]
fn constrained_steps_beyond_a_quarter_turn_say_by_how_much() {
    let check = |rest: [f64; 2], all: [f64; 2]| {
        let (rest, all) = (Vector2::from(rest), Vector2::from(all));
        below_right_angle_from(all, |a| a.norm_squared(), |_: &Vector1<f64>| rest)
    };
    let fraction = |rest, all| match check(rest, all) {
        Err(Error::Unsolvable { solvable_fraction, .. }) => solvable_fraction,
        other => panic!("{other:?}"),
    };
    assert_eq!(check([2.0, 0.0], [0.0, 0.5]), Ok(Vector2::new(0.0, 0.5)));
    assert!((fraction([0.0; 2], [0.0, 4.0]) - 0.25).abs() < 1e-15);
    assert!((fraction([0.5, 0.0], [2.5, 0.0]) - 0.25).abs() < 1e-15);
    // back through 0
    assert!((fraction([0.5, 0.0], [-2.5, 0.0]) - 0.5).abs() < 1e-15);
    assert!((fraction([0.6, 0.0], [0.6, 1.6]) - 0.5).abs() < 1e-15);
    // none
    assert_eq!(fraction([2.0, 0.0], [3.0, 0.0]), 0.0);
    assert_eq!(fraction([2.0, 0.0], [2.0, 3.0]), 0.0);
    assert_eq!(check([0.0; 2], [f64::NAN, 0.0]), Err(Error::NotFinite { name: "the momentum" }));
}

/// Against the series to many more terms, on both sides of where it ends, and in single precision against the quotient in double.
#[test]
fn the_cosine_is_that_of_its_angle() {
    // 1 − √(1 − t) = t/2 + t²/8 + …: the ratio of two terms is (2k − 1)/(2k + 2)
    let series = |t: f64| {
        let (mut term, mut terms) = (0.5, std::vec::Vec::new());
        for k in 1..60 {
            terms.push(term);
            term *= t * f64::from(2 * k - 1) / f64::from(2 * k + 2);
        }
        terms.iter().rev().sum::<f64>()
    };
    let count = if cfg!(miri) { 50 } else { 20_000 };
    for i in 0..count {
        let t = 0.25 * (f64::from(i) / f64::from(count)).powi(3);
        let (found, exact) = (per_one_plus_cosine(t), series(t));
        assert!((found / exact - 1.0).abs() <= 1.5 * f64::EPSILON, "{t}: {found} for {exact}");
        let single = per_one_plus_cosine(t as f32);
        assert!((f64::from(single) / series(f64::from(t as f32)) - 1.0).abs() <= 1.5 * f64::from(f32::EPSILON));
    }
    for i in 0..=count {
        let t = i as f32 / count as f32;
        let exact = 1.0 / (1.0 + (1.0 - f64::from(t)).sqrt());
        let single = f64::from(per_one_plus_cosine(t));
        assert!((single / exact - 1.0).abs() <= 1.5 * f64::from(f32::EPSILON), "{t}: {single} for {exact}");
    }
    assert_eq!(per_one_plus_cosine(1.0), 1.0);
    assert_eq!(per_one_plus_cosine(0.0), 0.5);
    assert!(per_one_plus_cosine(f64::NAN).is_nan() && per_one_plus_cosine(2.0_f64).is_nan());
}

#[test]
fn an_inverse_needs_its_pivots() {
    let permutation = Matrix4::new(0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0);
    assert_eq!(permutation * inverse(&permutation), Matrix4::identity());
    assert!(inverse(&Matrix3::<f64>::zeros())[(0, 0)].is_nan());
}

#[test]
fn a_quaternion_starts_at_one() {
    let increment = Quaternion::new(0.0, 1.0, 2.0, 3.0);
    assert_eq!(quaternion_from_increment(&increment), Quaternion::new(1.0, 1.0, 2.0, 3.0));
}
