//! Lanes against single numbers, bit for bit.

use super::{F32x8, F64x4, F64x8};
use crate::linear::{eliminate, solve_symmetric};
use crate::orientation::Orientation;
use crate::runner::proptest;
use crate::{Mask, Scalar};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use std::vec::Vec;

/// Numbers of every kind: ordinary, tiny, huge, zeros of both signs, infinities, NaN.
fn numbers() -> BoxedStrategy<[f64; 8]> {
    let number = prop_oneof![4 => -2.0_f64..2.0, 1 => prop::num::f64::ANY, 1 => Just(0.0), 1 => Just(-0.0)];
    // boxed: trees of matrices of them would fill the stack of a test
    prop::array::uniform8(number).boxed()
}

/// The sign of a single number in all lanes.
fn in_all_lanes(sign: Orientation) -> Orientation {
    let everywhere = <F64x8 as Scalar>::Mask::everywhere();
    Orientation::new(everywhere, if sign == Orientation::NEGATIVE { everywhere } else { !everywhere })
}

/// NaN have no sign and no payload that matters. The comparison reads numbers from memory. Where the optimiser (rustc
/// 1.95) sees a square root, it has been seen to take NaN for a number.
fn bits(x: f64) -> u64 {
    let x = core::hint::black_box(x);
    if x.is_nan() { u64::MAX } else { x.to_bits() }
}

/// f in all lanes, and in a single number of each.
fn agree<L: Scalar<Lane = f64>>(
    name: &str,
    lanes: &dyn Fn(L, L) -> L,
    single: &dyn Fn(f64, f64) -> f64,
    x: [f64; 8],
    y: [f64; 8],
) {
    let found = lanes(L::from_lanes(|i| x[i]), L::from_lanes(|i| y[i]));
    for i in 0..L::LANES {
        let (found, expected) = (found.lane(i), single(x[i], y[i]));
        assert_eq!(bits(found), bits(expected), "{name}({}, {}) = {expected}, in a lane {found}", x[i], y[i]);
    }
}

/// One line for each operation: in lanes, and for single numbers by the same method.
fn all_agree<L: Scalar<Lane = f64>>(x: [f64; 8], y: [f64; 8]) {
    macro_rules! operations {
        ($($name:literal |$a:ident, $b:ident| $body:expr;)*) => {$(
            agree::<L>($name, &|$a, $b| $body, &|$a, $b| $body, x, y);
        )*};
    }
    operations! {
        "+" |a, b| a + b;
        "-" |a, b| a - b;
        "*" |a, b| a * b;
        "/" |a, b| a / b;
        "neg" |a, _b| -a;
        "abs" |a, _b| Scalar::abs(a);
        "sqrt" |a, _b| Scalar::sqrt(a);
        "recip" |a, _b| Scalar::recip(a);
        "sin" |a, _b| Scalar::sin(a);
        "cos" |a, _b| Scalar::cos(a);
        "sine of both" |a, _b| Scalar::sin_cos(a).0;
        "cosine of both" |a, _b| Scalar::sin_cos(a).1;
        "tan" |a, _b| Scalar::tan(a);
        "asin" |a, _b| Scalar::asin(a);
        "acos" |a, _b| Scalar::acos(a);
        "atan" |a, _b| Scalar::atan(a);
        "sinh" |a, _b| Scalar::sinh(a);
        "cosh" |a, _b| Scalar::cosh(a);
        "tanh" |a, _b| Scalar::tanh(a);
        "exp" |a, _b| Scalar::exp(a);
        "ln" |a, _b| Scalar::ln(a);
        "powi" |a, _b| Scalar::powi(a, 7) + Scalar::powi(a, -3);
        "powf" |a, b| Scalar::powf(Scalar::abs(a), b);
        "select" |a, b| Scalar::select(a.below(b), a + b, a - b);
    }
    let (a, b) = (L::from_lanes(|i| x[i]), L::from_lanes(|i| y[i]));
    for i in 0..L::LANES {
        let found = [a.below(b), a.at_most(b), a.equals(b), Scalar::finite(a)].map(|mask| mask.lane(i));
        assert_eq!(found, [x[i] < y[i], x[i] <= y[i], x[i] == y[i], x[i].is_finite()], "{} {}", x[i], y[i]);
    }
}

proptest! {
    #[test]
    fn operations_are_those_of_single_numbers(x in numbers(), y in numbers()) {
        all_agree::<F64x8>(x, y);
        all_agree::<F64x4>(x, y);
    }

    /// Regular, singular and broken matrices side by side: pivoting and signs are those of each lane.
    #[test]
    fn each_lane_eliminates_by_its_own_pivots(
        // on the heap: trees of values that shrink are too large for the stack of a test
        entries in prop::collection::vec(numbers(), 12),
    ) {
        let a: [[_; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| entries[3 * i + j]));
        let b: [_; 3] = std::array::from_fn(|i| entries[9 + i]);
        let mut found = b.map(|entry| [F64x8::from(entry)]);
        let orientation = eliminate(a.map(|row| row.map(F64x8::from)), &mut found);
        let mut signs = Vec::new();
        for lane in 0..F64x8::LANES {
            let mut expected = b.map(|entry| [entry[lane]]);
            let sign = eliminate(a.map(|row| row.map(|entry| entry[lane])), &mut expected);
            if sign.is_some() {
                for (found, expected) in found.iter().zip(expected) {
                    prop_assert_eq!(bits(found[0].lane(lane)), bits(expected[0]));
                }
            }
            signs.push(sign);
        }
        prop_assert_eq!(orientation.is_some(), signs.iter().any(Option::is_some));
        for (lane, sign) in signs.into_iter().enumerate() {
            let is = |single| orientation.is_some_and(|lanes| lanes.agrees::<F64x8>(in_all_lanes(single)).lane(lane));
            prop_assert_eq!(is(Orientation::POSITIVE), sign == Some(Orientation::POSITIVE));
            prop_assert_eq!(is(Orientation::NEGATIVE), sign == Some(Orientation::NEGATIVE));
        }
    }

    /// Definite, indefinite and singular matrices side by side: some lanes need no pivots, some do, some have no solution.
    #[test]
    fn each_lane_is_definite_by_itself(
        a in prop::array::uniform3(prop::array::uniform3(numbers())),
        shift in prop::array::uniform8(-4.0_f64..4.0),
        b in prop::array::uniform3(numbers()),
    ) {
        let entry = |i: usize, j: usize, lane: usize| {
            a[i.max(j)][i.min(j)][lane] + if i == j { shift[lane] } else { 0.0 }
        };
        let matrix = Matrix3::from_fn(|i, j| F64x8::from_lanes(|lane| entry(i, j, lane)));
        let found = solve_symmetric(&matrix, &Vector3::from_fn(|i, _| F64x8::from(b[i])));
        let right = |lane: usize| Vector3::from_fn(|i, _| b[i][lane]);
        for lane in 0..F64x8::LANES {
            let single = Matrix3::from_fn(|i, j| entry(i, j, lane));
            if let Some((expected, sign)) = solve_symmetric(&single, &right(lane)) {
                let (found, orientation) = found.expect("one lane is regular");
                (0..3).for_each(|i| assert_eq!(bits(found[i].lane(lane)), bits(expected[i])));
                prop_assert!(orientation.agrees::<F64x8>(in_all_lanes(sign)).lane(lane));
            }
        }
    }
}

#[test]
fn masks_have_one_bit_for_each_lane() {
    let mask = <F32x8 as Scalar>::Mask::from_bits(0b1010_0001);
    assert_eq!((mask.bits(), (!mask).bits()), (0b1010_0001, 0b0101_1110));
    assert!(mask.any() && !mask.all() && mask.lane(0) && !mask.lane(1));
    assert!((mask | !mask).all() && !(mask & !mask).any());
    assert_eq!(<F64x4 as Scalar>::Mask::everywhere().bits(), 0b1111);
}

#[test]
fn single_precision_lanes_are_single_numbers() {
    let x = [0.1_f32, -0.3, 7.5, 1e-30, 1e30, 0.0, 2.0, f32::NAN];
    let found = Scalar::sqrt(F32x8::from(x)) * F32x8::from(3.3) / F32x8::from_ratio(1, 3) + Scalar::exp(F32x8::from(x));
    for (lane, x) in x.into_iter().enumerate() {
        let expected = Scalar::sqrt(x) * 3.3 / <f32 as Scalar>::from_ratio(1, 3) + Scalar::exp(x);
        assert!(found.lane(lane).to_bits() == expected.to_bits() || expected.is_nan());
    }
}
