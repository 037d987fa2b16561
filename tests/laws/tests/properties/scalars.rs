//! Numbers, masks, spaces and times: the types that generated code computes with.

use crate::arbitrary::{cases, vector};
use crate::runner::proptest;
use clebsch::__private as private;
use clebsch::{Clock, Conserved, F64x8, Mask, Scalar, Space, Time};
use nalgebra::{Matrix2, Quaternion, SMatrix, Vector2};
use num_traits::{One, Zero};
use proptest::prelude::*;

/// A space with every kind of part: a vector, a quaternion, and two pairs of a number and a matrix.
type Nested<T> = (Vector2<T>, Quaternion<T>, [(T, Matrix2<T>); 2]);

fn nested<T: Scalar>(x: &[T]) -> Nested<T> {
    let pair = |i: usize| (x[i], Matrix2::new(x[i + 1], x[i + 2], x[i + 3], x[i + 4]));
    (Vector2::new(x[0], x[1]), Quaternion::new(x[2], x[3], x[4], x[5]), [pair(6), pair(11)])
}

/// 16 numbers, ordinary and not.
fn entries() -> BoxedStrategy<Vec<f64>> {
    prop::collection::vec(-2.0_f64..2.0, 16).boxed()
}

/// Eight lanes of a list: that of number i is multiplied by i + 1 and turned about.
fn lanes(x: &[f64]) -> Vec<F64x8> {
    (0..x.len()).map(|i| F64x8::from_lanes(|lane| x[(i + lane) % x.len()] * (lane + 1) as f64)).collect()
}

fn one_lane(x: &[F64x8], lane: usize) -> Vec<f64> {
    x.iter().map(|x| x.lane(lane)).collect()
}

/// The elementary functions of a scalar with those of `std` in `f64`: where they agree to `units` of rounding.
fn are_elementary<T: Scalar>(x: f64, y: f64, units: f64) {
    let of = T::from_f64;
    let (a, b) = (of(x), of(y));
    // the numbers that are computed with
    let (x, y) = (a.to_f64(), b.to_f64());
    let (part, size) = (x / 8.0, x.abs());
    let (a_part, a_size) = (of(part), a.abs());
    let part = a_part.to_f64();
    let found: [(&str, T, f64); 19] = [
        ("abs", a.abs(), x.abs()),
        ("sqrt", a_size.sqrt(), size.sqrt()),
        ("recip", a.recip(), 1.0 / x),
        ("sin", a.sin(), x.sin()),
        ("cos", a.cos(), x.cos()),
        ("tan", a.tan(), x.tan()),
        ("asin", a_part.asin(), part.asin()),
        ("acos", a_part.acos(), part.acos()),
        ("atan", a.atan(), x.atan()),
        ("sinh", a.sinh(), x.sinh()),
        ("cosh", a.cosh(), x.cosh()),
        ("tanh", a.tanh(), x.tanh()),
        ("exp", a.exp(), x.exp()),
        ("ln", a_size.ln(), size.ln()),
        ("powf", a_size.powf(b), size.powf(y)),
        ("a + b", a + b, x + y),
        ("a − b", a - b, x - y),
        ("a b", a * b, x * y),
        ("a / b", a / b, x / y),
    ];
    for (name, found, exact) in found {
        let error = (found.to_f64() - exact).abs();
        assert!(error <= units * T::EPSILON.to_f64() * exact.abs(), "{name} of {x}, {y}: {found} for {exact}");
    }
}

proptest! {
    #![proptest_config(cases(256))]

    /// Each function is right to its last two places in both precisions; that of `std` may be as far off.
    #[test]
    fn elementary_functions_are_those_of_the_standard_library(x in -8.0_f64..8.0, y in -8.0_f64..8.0) {
        prop_assume!(x.abs() > 1e-3 && y.abs() > 1e-3);
        are_elementary::<f64>(x, y, 3.0);
        are_elementary::<f32>(x, y, 3.0);
    }

    /// An expansion may take both for one angle where another takes one of them: bits must not depend on that.
    #[test]
    fn both_functions_of_an_angle_are_those_taken_apart(angle in prop_oneof![-20.0_f64..20.0, any::<f64>()]) {
        let (sine, cosine) = Scalar::sin_cos(angle);
        prop_assert_eq!([sine.to_bits(), cosine.to_bits()], [Scalar::sin(angle).to_bits(), Scalar::cos(angle).to_bits()]);
        let angle = angle as f32;
        let (sine, cosine) = Scalar::sin_cos(angle);
        prop_assert_eq!([sine.to_bits(), cosine.to_bits()], [Scalar::sin(angle).to_bits(), Scalar::cos(angle).to_bits()]);
    }

    /// By repeated multiplication: n roundings at most, and one of the reciprocal for each.
    #[test]
    fn powers_are_products(x in 0.5_f64..2.0, n in -40_i32..40) {
        let mut product = 1.0;
        (0..n.abs()).for_each(|_| product *= x);
        let expected = if n < 0 { 1.0 / product } else { product };
        let found = Scalar::powi(x, n);
        prop_assert!((found / expected - 1.0).abs() <= 4.0 * f64::from(n.abs() + 1) * f64::EPSILON);
        let single = f64::from(Scalar::powi(x as f32, n));
        let expected = f64::from(x as f32).powi(n);
        prop_assert!((single / expected - 1.0).abs() <= 4.0 * f64::from(n.abs() + 1) * f64::from(f32::EPSILON));
    }

    #[test]
    fn conversions_round_once(numerator in any::<i32>(), denominator in 1..i32::MAX, x in any::<f64>()) {
        let (n, d) = (i64::from(numerator), i64::from(denominator));
        prop_assert_eq!(<f64 as Scalar>::from_ratio(n, d), n as f64 / d as f64);
        prop_assert_eq!(<f64 as Scalar>::from_f64(x).to_bits(), x.to_bits());
        prop_assert_eq!(<f32 as Scalar>::from_f64(x).to_bits(), (x as f32).to_bits());
        prop_assert_eq!(Scalar::to_f64(x).to_bits(), x.to_bits());
        prop_assert_eq!(Scalar::is_finite(x), x.is_finite());
        prop_assert_eq!(Scalar::finite(x), x.is_finite());
        prop_assert_eq!(F64x8::from_f64(x).to_array().map(f64::to_bits), [x.to_bits(); 8]);
        prop_assert_eq!(F64x8::splat(x).to_f64().to_bits(), x.to_bits());
    }

    /// A constant has the value of its number, which `to_f64` gives, rounded once to the scalar.
    #[test]
    fn constants_are_rounded_once(x in any::<f64>(), n in any::<i32>(), size in any::<usize>(), long in -1_i64 << 53..=1 << 53) {
        let single = x as f32;
        prop_assert_eq!(private::constant::<f64>(x).to_bits(), x.to_bits());
        prop_assert_eq!(private::constant::<f32>(x).to_bits(), single.to_bits());
        prop_assert_eq!(private::constant::<f32>(single).to_bits(), single.to_bits());
        prop_assert_eq!(private::constant::<f64>(single).to_bits(), f64::from(single).to_bits());
        prop_assert_eq!(private::Constant::to_f64(single).to_bits(), f64::from(single).to_bits());
        prop_assert_eq!(private::constant::<F64x8>(x).to_array().map(f64::to_bits), [x.to_bits(); 8]);
        // integers of less than 54 bits are numbers of `f64`
        prop_assert_eq!(private::constant::<f64>(n), f64::from(n));
        prop_assert_eq!(private::Constant::to_f64(long) as i64, long);
        let distance = (private::constant::<f64>(size) as u128).abs_diff(size as u128);
        prop_assert!(2 * distance <= (size >> 52) as u128, "{size} is {distance} away");
    }

    /// Comparisons, choices and finiteness lane by lane; `one_number` for a single number.
    #[test]
    fn comparisons_are_made_in_each_lane(
        x in prop::array::uniform8(-2_i32..2), y in prop::array::uniform8(-2_i32..2), broken in prop::array::uniform8(any::<bool>()),
    ) {
        let x = std::array::from_fn::<f64, 8, _>(|i| if broken[i] { f64::NAN } else { f64::from(x[i]) });
        let y = y.map(f64::from);
        let (a, b) = (F64x8::from(x), F64x8::from_lanes(|lane| y[lane]));
        let chosen = F64x8::select(a.below(b), a, b);
        for lane in 0..8 {
            prop_assert_eq!(a.below(b).lane(lane), x[lane] < y[lane]);
            prop_assert_eq!(a.at_most(b).lane(lane), x[lane] <= y[lane]);
            prop_assert_eq!(a.equals(b).lane(lane), x[lane] == y[lane]);
            prop_assert_eq!(Scalar::finite(a).lane(lane), x[lane].is_finite());
            prop_assert_eq!(Scalar::lane(chosen, lane), if x[lane] < y[lane] { x[lane] } else { y[lane] });
            prop_assert_eq!(Scalar::below(x[lane], y[lane]), x[lane] < y[lane]);
            prop_assert_eq!(Scalar::at_most(x[lane], y[lane]), x[lane] <= y[lane]);
            prop_assert_eq!(Scalar::equals(x[lane], y[lane]), x[lane] == y[lane]);
            prop_assert_eq!(f64::from_lanes(|_| y[lane]), y[lane]);
        }
        prop_assert_eq!(Scalar::is_finite(a), !broken.contains(&true));
        // counted by those who count, and nothing else
        F64x8::iterated();
        prop_assert_eq!(b.to_array(), y);
    }

    /// Masks are sets of lanes.
    #[test]
    fn masks_are_sets_of_lanes(x in any::<u8>(), y in any::<u8>()) {
        type Lanes = <F64x8 as Scalar>::Mask;
        let of = |bits: u8| Lanes::from_bits(u16::from(bits));
        let (a, b) = (of(x), of(y));
        prop_assert_eq!((a & b).bits(), u16::from(x & y));
        prop_assert_eq!((a | b).bits(), u16::from(x | y));
        prop_assert_eq!((a ^ b).bits(), u16::from(x ^ y));
        prop_assert_eq!((!a).bits(), u16::from(!x));
        prop_assert_eq!((a.any(), a.all()), (x != 0, x == u8::MAX));
        prop_assert!((0..20).all(|lane| a.lane(lane) == (lane < 8 && x >> lane & 1 == 1)));
        prop_assert!(Lanes::everywhere().all() && !Lanes::nowhere().any());
        let one = bool::from_bits(u16::from(x));
        prop_assert_eq!((one, one.bits(), one.any(), one.all(), one.lane(0)), (x & 1 == 1, u16::from(x & 1), one, one, one));
        prop_assert!(bool::everywhere() && !bool::nowhere());
    }

    /// A space is its list of scalars, in every lane.
    #[test]
    fn spaces_are_lists_of_scalars(x in entries(), y in entries()) {
        let (a, b) = (nested(&x), nested(&y));
        prop_assert_eq!(Space::<f64>::reduce(&a, 0, |_| 1, |a, b| a + b), 16);
        let mapped: Vec<f64> = x.iter().zip(&y).map(|(x, y)| 2.0 * x - y).collect();
        prop_assert_eq!(Space::<f64>::zip_map(&a, &b, |x, y| 2.0 * x - y), nested(&mapped));
        prop_assert_eq!(Space::<f64>::max_abs(&a), x.iter().fold(0.0, |max, x| f64::max(max, x.abs())));
        let squares: f64 = x.iter().zip(&y).map(|(x, y)| (x - y) * (x - y)).sum();
        // sixteen terms in another order
        prop_assert!((Space::<f64>::distance_squared(&a, &b) - squares).abs() <= 16.0 * f64::EPSILON * squares);
        prop_assert!((Space::<f64>::sum(&a) - x.iter().sum::<f64>()).abs() <= 32.0 * 16.0 * f64::EPSILON);
        prop_assert!(Space::<f64>::all(&a, |x| x.abs() <= 2.0) && !Space::<f64>::all(&a, |found| found != x[7]));
        prop_assert_eq!(<Nested<f64> as Space<f64>>::filled(x[0]), nested(&[x[0]; 16]));
        prop_assert_eq!(<Nested<f64> as Space<f64>>::origin(), nested(&[0.0; 16]));
        prop_assert!(Space::<f64>::all_finite(&a) && Space::<f64>::finite(&a));
        let broken = nested(&[&x[..15], &[f64::NAN]].concat());
        prop_assert!(!Space::<f64>::all_finite(&broken) && !Space::<f64>::finite(&broken));
        prop_assert_eq!(Space::<f64>::max_abs(&broken), x[..15].iter().fold(0.0, |max, x| f64::max(max, x.abs())));
    }

    /// A value that is put into a lane is there, and nowhere else.
    #[test]
    fn spaces_have_lanes(x in entries(), y in entries(), lane in 0_usize..8) {
        let wide = lanes(&x);
        let a = nested(&wide);
        for lane in 0..8 {
            prop_assert_eq!(Space::<F64x8>::lane(&a, lane), nested(&one_lane(&wide, lane)));
        }
        let again = <Nested<F64x8> as Space<F64x8>>::side_by_side(|lane| nested(&one_lane(&wide, lane)));
        prop_assert_eq!(again, a);
        let mut changed = a;
        Space::<F64x8>::set_lane(&mut changed, lane, &nested(&y));
        for other in 0..8 {
            let expected = if other == lane { y.clone() } else { one_lane(&wide, other) };
            prop_assert_eq!(Space::<F64x8>::lane(&changed, other), nested(&expected));
        }
        Space::<F64x8>::set_lane(&mut changed, lane, &nested(&[f64::INFINITY; 16]));
        prop_assert!(Space::<F64x8>::finite(&changed).bits() == 0xff ^ 1 << lane && !Space::<F64x8>::all_finite(&changed));
    }

    /// t₀ + kh to the last place, however many additions it took; lanes have their own times.
    #[test]
    fn clocks_do_not_drift(start in -1e3_f64..1e3, h in 1e-6_f64..1.0, steps in 0_i32..2000, lane in 0_usize..8) {
        let clock = (0..steps).fold(Clock::at(start), |clock, _| clock.after_step(h));
        // the product is rounded once
        let exact = f64::from(steps) * h + start;
        let size = start.abs() + f64::from(steps) * h;
        prop_assert!((clock.now() - exact).abs() <= f64::EPSILON * size, "{} is not {exact}", clock.now());
        prop_assert_eq!(Time::<f64>::now(&<() as Time<f64>>::at(start)), 0.0);
        let mut all = Clock::at(F64x8::splat(start));
        let later = all.after_step(F64x8::splat(h));
        all.take_lane(lane, &later);
        for other in 0..8 {
            prop_assert_eq!(Scalar::lane(all.now(), other), if other == lane { start + h } else { start });
        }
    }

    /// Values by their place and by their name.
    #[test]
    fn conserved_values_have_names(values in prop::array::uniform3(-1.0_f64..1.0), lane in 0_usize..8) {
        let names = ["first", "second", "third"];
        let all = Conserved::new(names, values);
        prop_assert_eq!((all.names(), all.values()), (&names, &values));
        for (i, (name, value)) in all.iter().enumerate() {
            prop_assert_eq!((name, value, all[i], all.get(name)), (names[i], values[i], values[i], Some(values[i])));
        }
        prop_assert_eq!(all.get("fourth"), None);
        let wide = Conserved::new(names, values.map(|value| F64x8::from_lanes(|lane| value + lane as f64)));
        prop_assert_eq!(wide.lane(lane), Conserved::new(names, values.map(|value| value + lane as f64)));
    }

    /// The same in all lanes: arithmetic with a single number gives its bits.
    #[test]
    fn lanes_hold_single_numbers(x in vector::<2>(8.0)) {
        let (a, b) = (F64x8::splat(x[0]), F64x8::from(x[1]));
        prop_assert_eq!((a + b).to_array(), [x[0] + x[1]; 8]);
        prop_assert_eq!((a * b - a / b).to_array(), [x[0] * x[1] - x[0] / x[1]; 8]);
        prop_assert_eq!((F64x8::zero().to_array(), F64x8::one().to_array()), ([0.0; 8], [1.0; 8]));
        prop_assert_eq!(SMatrix::<F64x8, 1, 1>::new(a).map(|x| x.lane(3)), SMatrix::<f64, 1, 1>::new(x[0]));
    }
}
