//! Double-double numbers, dual numbers over them, and functions of matrices.

use clebsch_tests::oracle::precise::double_double::DoubleDouble;
use clebsch_tests::oracle::precise::dual::Dual;
use clebsch_tests::oracle::precise::group::{se, sl, so};
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::real::Real;
use clebsch_tests::oracle::random::Random;

const ROUNDING: f64 = 1e-30;

#[track_caller]
fn assert_digits(ours: DoubleDouble, digits: &str) {
    let exact: DoubleDouble = digits.parse().unwrap();
    assert!((ours - exact).size() <= ROUNDING * exact.size(), "{ours:?} and {exact:?}");
}

/// Digits of a computation with 60 digits.
#[test]
fn functions_have_thirty_digits() {
    let x = DoubleDouble::of;
    assert_digits(x(2.0).sqrt(), "1.4142135623730950488016887242096980785697");
    assert_digits(x(1.0).exp(), "2.7182818284590452353602874713526624977572");
    assert_digits(x(-20.0).exp(), "2.0611536224385578279659403801558209763759e-9");
    assert_digits(x(10.0).ln(), "2.3025850929940456840179914546843642076011");
    assert_digits(x(1.0).sin(), "0.8414709848078965066525023216302989996226");
    assert_digits(x(1.0).cos(), "0.5403023058681397174009366074429766037323");
    assert_digits(x(-10.0).sin(), "0.5440211108893698134047476618513772816836");
    assert_digits(x(10.0).cos(), "-0.8390715290764524522588639478240648345199");
    assert_digits(x(1.0) / x(3.0), "0.3333333333333333333333333333333333333333");
    assert_digits(DoubleDouble::ratio(-1, 10), "-1e-1");
    assert_eq!(x(0.0).sqrt(), x(0.0));
}

/// Associativity and division, on numbers of very different size: laws that 53 bits miss by far.
#[test]
fn arithmetic_has_thirty_digits() {
    let mut random = Random::new(1);
    let mut number = || DoubleDouble::of(random.number()) + DoubleDouble::of(random.number() * 1e-17);
    for _ in 0..1000 {
        let (a, b, c) = (number(), number(), number());
        assert!(((a + b) - a - b).size() < ROUNDING);
        assert!((a * (b + c) - (a * b + a * c)).size() < ROUNDING);
        assert!((a / b * b - a).size() < ROUNDING * a.size().max(1e-2));
        assert!(((a * a).sqrt() - if a.to_f64() < 0.0 { -a } else { a }).size() < ROUNDING);
        assert!((a.exp().ln() - a).size() < ROUNDING);
    }
}

/// f' and f'' of sin(x²)eˣ/√x − ln x + cos(x²) at 2, against a computation with 60 digits.
#[test]
fn nested_dual_numbers_differentiate_twice() {
    let f = |x: Dual<Dual<DoubleDouble>>| (x * x).sin() * x.exp() / x.sqrt() - x.ln() + (x * x).cos();
    let one = DoubleDouble::one();
    let x = Dual { value: Dual { value: one * 2.0, slope: one }, slope: Dual::constant(one) };
    let value = f(x);
    assert_digits(value.value.value, "-5.300971586012650830119121702163289413515");
    assert_digits(value.value.slope, "-14.09918947420290411312945281752232764777");
    assert_digits(value.slope.slope, "45.44876845446854915166145422472215766869");
}

/// exp(A)exp(−A) = I, ln exp(A) = A, A⁻¹A = I, and exp of a rotation by 2π.
#[test]
fn functions_of_matrices() {
    let mut random = Random::new(2);
    for group in [so(3), so(4), se(3), sl(3)] {
        let x: Vec<_> = group.basis.iter().map(|_| DoubleDouble::of(random.number() / 2.0)).collect();
        let a: Matrix<DoubleDouble> = group.combination(&x);
        let f = a.exponential();
        let identity = Matrix::identity(group.size());
        assert!((&f * (-&a).exponential() - &identity).size() < ROUNDING);
        assert!((f.inverse() * &f - &identity).size() < ROUNDING);
        assert!((f.logarithm() - &a).size() < ROUNDING);
    }
    let turn: DoubleDouble = "6.2831853071795864769252867665590057683943".parse().unwrap();
    let whole = so(3).combination(&[DoubleDouble::zero(), turn, DoubleDouble::zero()]).exponential();
    assert!((whole - Matrix::identity(3)).size() < 10.0 * ROUNDING);
}
