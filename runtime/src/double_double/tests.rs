//! Against values of 60 digits (mpmath), and exact identities.

use super::DoubleDouble;
use crate::Scalar;
use crate::runner::proptest;
use num_traits::Zero;
use proptest::prelude::*;

type Function = fn(DoubleDouble) -> DoubleDouble;

/// Name, function, argument, and the two numbers of its value.
#[rustfmt::skip]
const EXACT: [(&str, Function, f64, f64, f64); 39] = [
    ("sin", Scalar::sin, 0.001, 0.0009999998333333417, 5.670638989736153e-21),
    ("sin", Scalar::sin, 0.7, 0.644217687237691, 2.8740567927338755e-18),
    ("sin", Scalar::sin, 2.5, 0.5984721441039565, -5.521403334082375e-17),
    ("sin", Scalar::sin, 100.0, -0.5063656411097588, -3.050947053792115e-18),
    ("sin", Scalar::sin, -10000.0, 0.30561438888825215, -1.1737169553511932e-17),
    ("cos", Scalar::cos, 0.001, 0.9999995000000417, -7.831485455398128e-18),
    ("cos", Scalar::cos, 0.7, 0.7648421872844885, -4.013780434022238e-17),
    ("cos", Scalar::cos, 2.5, -0.8011436155469337, -1.8674742705085553e-17),
    ("cos", Scalar::cos, 100.0, 0.8623188722876839, 4.334809858136501e-17),
    ("tan", Scalar::tan, 0.3, 0.30933624960962325, -2.7475966183811927e-17),
    ("tan", Scalar::tan, 2.5, -0.7470222972386603, 3.6166133011893774e-17),
    ("asin", Scalar::asin, 0.001, 0.0010000001666667416, 6.098029193169449e-20),
    ("asin", Scalar::asin, -0.6, -0.6435011087932844, 1.1920790564184627e-17),
    ("asin", Scalar::asin, 0.99, 1.4292568534704693, 6.909416818000846e-17),
    ("acos", Scalar::acos, 0.001, 1.56979632662823, -1.1013258358727374e-16),
    ("acos", Scalar::acos, -0.6, 2.214297435588181, 1.6033385185569867e-16),
    ("acos", Scalar::acos, 0.99, 0.1415394733244273, -7.861828222640801e-18),
    ("atan", Scalar::atan, 0.001, 0.0009999996666668668, -1.0247543344088032e-19),
    ("atan", Scalar::atan, -2.0, -1.1071487177940904, -9.40447137356638e-17),
    ("atan", Scalar::atan, 10000000000.0, 1.5707963266948965, 6.950637705727703e-17),
    ("sinh", Scalar::sinh, 0.001, 0.001000000166666675, -3.571742859983052e-20),
    ("sinh", Scalar::sinh, -0.7, -0.7585837018395335, 4.9693841630321686e-17),
    ("sinh", Scalar::sinh, 3.0, 10.017874927409903, -6.97789774734877e-16),
    ("sinh", Scalar::sinh, 20.0, 242582597.70489514, -7.865629467297586e-10),
    ("cosh", Scalar::cosh, 0.001, 1.0000005000000416, 7.443797190204747e-17),
    ("cosh", Scalar::cosh, 3.0, 10.067661995777765, 5.150335194797485e-16),
    ("cosh", Scalar::cosh, 20.0, 242582597.70489514, 1.2745906757087991e-09),
    ("tanh", Scalar::tanh, 0.001, 0.0009999996666668, 1.7800613799166557e-20),
    ("tanh", Scalar::tanh, -0.7, -0.6043677771171635, 2.7916180015425346e-17),
    ("tanh", Scalar::tanh, 3.0, 0.9950547536867305, -1.2991892863562624e-17),
    ("exp", Scalar::exp, 0.001, 1.0010005001667084, -4.290842058948394e-17),
    ("exp", Scalar::exp, -0.7, 0.4965853037914095, 9.827550225511106e-18),
    ("exp", Scalar::exp, 1.25, 3.4903429574618414, -4.604261945372796e-17),
    ("exp", Scalar::exp, 20.0, 485165195.4097903, 4.880277289790406e-10),
    ("exp", Scalar::exp, -50.0, 1.9287498479639178e-22, -3.7546101071240096e-39),
    ("log", Scalar::ln, 0.001, -6.907755278982137, -2.1613487097372872e-16),
    ("log", Scalar::ln, 0.7, -0.35667494393873245, 4.82556379937662e-18),
    ("log", Scalar::ln, 9.0, 2.1972245773362196, -1.814259447000306e-16),
    ("log", Scalar::ln, 1e+30, 69.07755278982137, 2.38940015169316e-15),
];

#[test]
fn elementary_functions() {
    for (name, function, x, large, small) in EXACT.into_iter().step_by(if cfg!(miri) { 3 } else { 1 }) {
        let (found, exact) = (function(x.into()), DoubleDouble::new(large, small));
        let error = (found - exact).to_f64().abs();
        // the error of multiples of π/2 grows with the argument
        let scale = large.abs().max(if large.abs() < 0.9 { 0.25 * x.abs().min(1.0) } else { 1.0 }).max(x.abs() * 1e-2);
        assert!(error < 4e-31 * scale, "{name} {x}: {found} is not {exact}, by {error:e}");
    }
}

/// Random pairs, all of whose bits matter: (a/b)b, (√a)², (a + b) − b, and powers.
#[test]
fn arithmetic_to_31_digits() {
    let mut state = 1_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        0.5 + (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..if cfg!(miri) { 10 } else { 20_000 } {
        let [a, b] = [0, 1].map(|_| DoubleDouble::new(number(), (number() - 1.0) * 1e-16));
        let close = |found: DoubleDouble, exact: DoubleDouble| ((found - exact) / exact).to_f64().abs() < 4e-31;
        assert!(close(a / b * b, a) && close(a.sqrt() * a.sqrt(), a) && close(a + b - b, a));
        assert!(close(a * b / a, b) && close(a.recip() * a, DoubleDouble::from(1.0)));
        assert!(close(Scalar::powi(a, 3) / a / a, a) && close(Scalar::powf(a, DoubleDouble::from(0.5)), a.sqrt()));
    }
}

#[test]
fn ratios_are_of_twice_the_precision() {
    let [large, small] = DoubleDouble::from_ratio(-1, 10).parts();
    assert_eq!(large, -0.1);
    // 0.1 as a double is larger than a tenth by this
    assert!((small - 5.551_115_123_125_783e-18).abs() < 1e-33);
    let [large, small] = DoubleDouble::from_ratio(i64::MAX, 1).parts();
    assert_eq!((large, small), (9_223_372_036_854_775_808.0, -1.0));
}

#[test]
fn ends_of_the_range() {
    let (zero, one) = (DoubleDouble::zero(), DoubleDouble::from(1.0));
    assert_eq!((one / zero).to_f64(), f64::INFINITY);
    assert_eq!((one / zero + one).to_f64(), f64::INFINITY);
    assert!(
        (zero / zero).to_f64().is_nan() && Scalar::sqrt(-one).to_f64().is_nan() && Scalar::ln(-one).to_f64().is_nan()
    );
    assert!(!(one / zero).is_finite() && !(zero / zero).is_finite() && one.is_finite());
    assert_eq!(Scalar::sqrt(zero), zero);
    let quarter = DoubleDouble::PI / DoubleDouble::from(2.0);
    assert_eq!(
        [Scalar::asin(one), Scalar::asin(-one), Scalar::acos(zero - one)],
        [quarter, -quarter, quarter + quarter]
    );
    assert!(Scalar::asin(one + one).to_f64().is_nan());
    assert_eq!(Scalar::tanh(DoubleDouble::from(-1e3)), -one);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Sums of whole numbers of up to 100 bits, which the computer knows; the parts do not overlap.
    #[test]
    fn pairs_are_unevaluated_sums(a in any::<i64>(), b in -1_i64 << 52..1 << 52, c in any::<i64>()) {
        let whole = |pair: DoubleDouble| pair.parts().iter().map(|&part| part as i128).sum::<i128>();
        let large = |x: i64| ((x >> 11) as f64) * 2.0_f64.powi(45);
        let (first, second) = (DoubleDouble::new(large(a), b as f64), DoubleDouble::new(b as f64, large(c)));
        let exact = |x: i64| i128::from(x >> 11) << 45;
        prop_assert_eq!(whole(first), exact(a) + i128::from(b));
        prop_assert_eq!(whole(second), exact(c) + i128::from(b));
        prop_assert_eq!(whole(first + second), exact(a) + exact(c) + 2 * i128::from(b));
        prop_assert_eq!(whole(first - second), exact(a) - exact(c));
        let [head, tail] = first.parts();
        prop_assert_eq!((head + tail, first.to_f64()), (head, head));
    }
}
