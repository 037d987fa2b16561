//! The coefficients of x_i d_i and of τ²/4 ℘(τ/2), and how far each number of them reaches.
//!
//! d = f(X) is a function of X = J⁻¹. Sums and products of such functions are formed from their values on one principal
//! axis, or from the coefficients of c₀ + c₁X + c₂X². The coefficients use X³ = e₁X² − e₂X + e₃, and need no axes. Axes
//! have no derivatives where two moments are equal.

use crate::space::larger;
use crate::{Real, Scalar};
use nalgebra::{SVector, Vector1};

/// The degree up to which the series are known.
const DEGREE: usize = 14;
/// One for each monomial of degree 1 to [`DEGREE`], and one for 1.
pub(super) const MONOMIALS: usize = (DEGREE + 1) * (DEGREE + 2) / 2;
/// The degrees of polynomials that are evaluated: as many terms as α asks for.
const DEGREES: [usize; 9] = [2, 3, 4, 5, 6, 8, 10, 12, 14];

/// The coefficients of α^i ε^j, at [`place`]: in the x_i d_i of three axes, or in c₀, c₁ and c₂ of X d. The last number
/// is that of τ²/4 ℘(τ/2).
pub(super) type Coefficients<T> = [[T; 4]; MONOMIALS];

/// A function of X: its value on one axis, or its three coefficients.
type Function<T, const N: usize> = SVector<T, N>;

/// A homogeneous polynomial in α and ε: entry j belongs to ε^j.
type Polynomial<T, const N: usize> = [Function<T, N>; DEGREE + 1];

/// One of each degree.
type Series<T, const N: usize> = [Polynomial<T, N>; DEGREE + 1];

/// The place of the coefficient of α^i ε^j, those of one j after the other.
const fn place(i: usize, j: usize) -> usize {
    // Σ_{k<j} (DEGREE + 1 − k)
    j * (2 * DEGREE + 3 - j) / 2 + i
}

/// The coefficients of α^i ε^j; there are some for all that are asked for, without a panic where the optimiser cannot see that.
#[inline(always)]
pub(super) fn coefficient<T: Scalar>(series: &Coefficients<T>, i: usize, j: usize) -> [T; 4] {
    series.get(place(i, j)).copied().unwrap_or([T::zero(); 4])
}

/// The coefficients of α^i ε^j up to the degree K, for each i.
#[inline(always)]
pub(super) fn in_alpha<T: Scalar, const K: usize>(series: &Coefficients<T>, j: usize) -> &[[T; 4]] {
    let start = place(0, j);
    series.get(start..start + (K + 1 - j)).unwrap_or_default()
}

/// The coefficients of x_i d_i for the reciprocal moments x. Scales are such that h M/2 is m.
#[cold]
pub(super) fn on_axes<T: Scalar>(x: &SVector<T, 3>) -> Coefficients<T> {
    let [[x0, x1, x2]] = x.data.0;
    let others = [(x1, x2), (x2, x0), (x0, x1)];
    // e_i, less their mean: coefficients of α and of ε
    let pairs = others.map(|(y, z)| y * z);
    let third = T::from_ratio(1, 3);
    let mean = |[a, b, c]: [T; 3]| third * (a + b + c);
    let means = [mean(pairs), mean([x0, x1, x2])];
    let [a, b, g] = pairs.map(|pair| pair - means[0]);
    let [p, q, r] = [x0, x1, x2].map(|x| x - means[1]);
    let squares = [a * a + b * b + g * g, T::from_f64(2.0) * (a * p + b * q + g * r), p * p + q * q + r * r];
    let products = [a * b * g, p * b * g + a * q * g + a * b * r, p * q * g + p * b * r + a * q * r, p * q * r];
    let elliptic = elliptic(&squares, &products);
    // values on an axis are multiplied as they are
    let nothing = SVector::from_element(T::zero());
    let mut all = [[T::zero(); 4]; MONOMIALS];
    each_coefficient(&elliptic, &mut all, |entry, value| entry[3] = value.x);
    let roots = [[a, p], [b, q], [g, r]];
    for (i, ((&x, (y, z)), roots)) in x.iter().zip(others).zip(roots).enumerate() {
        let [x, reciprocal, differences] = [x, x.recip(), (x - y) * (x - z)].map(Vector1::new);
        let series = of_function(&nothing, x, reciprocal, differences, roots.map(Vector1::new), &elliptic);
        // one of the first three
        each_coefficient(&series, &mut all, |entry, value| entry[i % 4] = value.x);
    }
    all
}

/// The same for c₀, c₁ and c₂ of X d = c₀ + c₁X + c₂X². Here e = (e₁, e₂, e₃) are the sum of the x_i, that of x_jx_k,
/// and their product.
#[cold]
pub(super) fn in_powers<T: Scalar>(e: &SVector<T, 3>) -> Coefficients<T> {
    let [[first, second, third]] = e.data.0;
    let (zero, one, two) = (T::zero(), T::one(), T::from_f64(2.0));
    let part = T::from_ratio(1, 3);
    // x_jx_k = X² − e₁X + e₂, and X, less their means
    let roots = [[second - part * second, -first, one], [-part * first, one, zero]].map(SVector::from);
    let trace = |f| trace(&f, e);
    let [a, b] = roots;
    let squares = [product(&a, &a, e), product(&a, &b, e), product(&b, &b, e)];
    let (aa, ab, bb) = (trace(squares[0]), trace(squares[1]), trace(squares[2]));
    // e₁e₂e₃ = ⅓ tr of the cube, as the trace of the roots vanishes
    let cubes = [
        part * trace(product(&squares[0], &a, e)),
        trace(product(&squares[0], &b, e)),
        trace(product(&squares[2], &a, e)),
        part * trace(product(&squares[2], &b, e)),
    ];
    let elliptic = elliptic(&[aa, two * ab, bb], &cubes);
    let x = SVector::from([zero, one, zero]);
    let inverse = third.recip();
    let reciprocal = SVector::from([inverse * second, -inverse * first, inverse]);
    let differences = SVector::from([second, -two * first, T::from_f64(3.0)]);
    let series = of_function(e, x, reciprocal, differences, roots, &elliptic);
    let mut all = [[zero; 4]; MONOMIALS];
    each_coefficient(&series, &mut all, |entry, value| *entry = [value.x, value.y, value.z, zero]);
    each_coefficient(&elliptic, &mut all, |entry, value| entry[3] = value.x);
    all
}

fn each_coefficient<T: Scalar, const N: usize>(
    series: &Series<T, N>,
    all: &mut Coefficients<T>,
    mut put: impl FnMut(&mut [T; 4], Function<T, N>),
) {
    for (n, row) in series.iter().enumerate() {
        for (j, value) in row.iter().enumerate().take(n + 1) {
            if let Some(entry) = all.get_mut(place(n - j, j)) {
                put(entry, *value);
            }
        }
    }
}

/// The series of x d. Its arguments are the function X and 1/X, and (x − x_j)(x − x_k) on each axis. The last two are
/// the coefficients of α and ε in the roots, and those of τ²/4 ℘(τ/2).
fn of_function<T: Scalar, const N: usize>(
    e: &SVector<T, 3>,
    x: Function<T, N>,
    reciprocal: Function<T, N>,
    differences: Function<T, N>,
    roots: [Function<T, N>; 2],
    elliptic: &Series<T, 1>,
) -> Series<T, N> {
    // p = 1 + α P − e + …
    let mut p = elliptic.map(|row| row.map(|value| unity() * value.x));
    p[1][0] = differences - roots[0];
    p[1][1] = -roots[1];
    let inverse = inverse(&p, e);
    let mut rate = zero();
    rate[0][0] = x;
    // (ε − x α) P times the polynomial of one degree less
    let mut factor = [SVector::from_element(T::zero()); DEGREE + 1];
    (factor[0], factor[1]) = (-product(&differences, &x, e), differences);
    for (n, row) in rate.iter_mut().enumerate().skip(1) {
        add_product(row, (&factor, 1), term(&inverse, n - 1), e);
    }
    riccati(reciprocal, x, &rate, e).map(|row| row.map(|value| product(&x, &value, e)))
}

/// τ²/4 ℘(τ/2) = 1 + Σ c_k of degree k, for the coefficients of α^i ε^j in Σ e_i² and e₁e₂e₃. c₂ = g₂/20, c₃ = g₃/28, c_k = 3/((2k + 1)(k −
/// 3)) Σ c_m c_{k−m}; g₂ = 2 Σ e_i², g₃ = 4 e₁e₂e₃.
fn elliptic<T: Scalar>(squares: &[T; 3], products: &[T; 4]) -> Series<T, 1> {
    let mut c: Series<T, 1> = zero();
    let (tenth, seventh) = (T::from_ratio(1, 10), T::from_ratio(1, 7));
    c[2].iter_mut().zip(squares).for_each(|(entry, square)| entry.x = tenth * *square);
    c[3].iter_mut().zip(products).for_each(|(entry, product)| entry.x = seventh * *product);
    for k in 4..=DEGREE {
        let mut row = c[0];
        for m in 2..=k - 2 {
            add_product(&mut row, term(&c, m), term(&c, k - m), &SVector::from_element(T::zero()));
        }
        let factor = T::from_ratio(3, ((2 * k + 1) * (k - 3)) as i64);
        c[k] = row.map(|coefficient| coefficient * factor);
    }
    c[0][0] = unity();
    c
}

/// 0 of all degrees.
fn zero<T: Scalar, const N: usize>() -> Series<T, N> {
    [[SVector::from_element(T::zero()); DEGREE + 1]; DEGREE + 1]
}

/// 1
fn unity<T: Scalar, const N: usize>() -> Function<T, N> {
    SVector::from_fn(|k, _| if k == 0 { T::one() } else { T::zero() })
}

/// tr f of f = c₀ + c₁X + c₂X²: 3c₀ + e₁c₁ + (e₁² − 2e₂)c₂.
pub(super) fn trace<T: Scalar>(f: &SVector<T, 3>, e: &SVector<T, 3>) -> T {
    let two = T::one() + T::one();
    T::from_f64(3.0) * f.x + e.x * f.y + (e.x * e.x - two * e.y) * f.z
}

/// The product of two functions: of their values, or of polynomials, the powers from X³ on reduced.
pub(super) fn product<T: Scalar, const N: usize>(
    a: &Function<T, N>,
    b: &Function<T, N>,
    e: &SVector<T, 3>,
) -> Function<T, N> {
    let mut all = [T::zero(); 5];
    for (i, a) in a.iter().enumerate() {
        for (entry, b) in all.iter_mut().skip(i).zip(b.iter()) {
            *entry += *a * *b;
        }
    }
    if N == 3 {
        let [.., fourth] = all;
        all[3] += e[0] * fourth;
        all[2] += e[0] * all[3] - e[1] * fourth;
        all[1] += e[2] * fourth - e[1] * all[3];
        all[0] += e[2] * all[3];
    }
    SVector::from_fn(|k, _| all.get(k).copied().unwrap_or_else(T::zero))
}

/// 1/p for p = 1 + ….
fn inverse<T: Scalar, const N: usize>(p: &Series<T, N>, e: &SVector<T, 3>) -> Series<T, N> {
    let mut inverse = zero();
    inverse[0][0] = unity();
    for n in 1..=DEGREE {
        let mut row = inverse[n];
        for k in 1..=n {
            add_product(&mut row, term(p, k), term(&inverse, n - k), e);
        }
        inverse[n] = row.map(|coefficient| -coefficient);
    }
    inverse
}

/// V of (2n − 1) V_n = −((α + V²) b)_n with V₀ = 1/b₀, which is the differential equation for d = V.
fn riccati<T: Scalar, const N: usize>(
    start: Function<T, N>,
    x: Function<T, N>,
    rate: &Series<T, N>,
    e: &SVector<T, 3>,
) -> Series<T, N> {
    let mut v = zero();
    let mut square = v;
    v[0][0] = start;
    square[0][0] = product(&start, &start, e);
    for n in 1..=DEGREE {
        let mut row = v[n];
        // both halves of the square are the same
        for k in 1..n.div_ceil(2) {
            add_product(&mut row, term(&v, k), term(&v, n - k), e);
        }
        row = row.map(|coefficient| coefficient + coefficient);
        if n % 2 == 0 {
            add_product(&mut row, term(&v, n / 2), term(&v, n / 2), e);
        }
        if n == 1 {
            row[0] += unity();
        }
        let mut right = row.map(|coefficient| product(&coefficient, &x, e));
        for k in 1..=n {
            add_product(&mut right, term(&square, n - k), term(rate, k), e);
        }
        let factor = -T::from_ratio(1, (2 * n + 1) as i64);
        v[n] = right.map(|coefficient| coefficient * factor);
        let twice = start * T::from_f64(2.0);
        square[n] = row;
        square[n].iter_mut().zip(&v[n]).for_each(|(entry, value)| *entry += product(&twice, value, e));
    }
    v
}

/// The terms of a degree, with it. Degrees are at most [`DEGREE`], and no panic is left where the optimiser does not see that.
#[inline(always)]
fn term<T, const N: usize>(series: &Series<T, N>, degree: usize) -> (&Polynomial<T, N>, usize) {
    let [.., last] = series;
    (series.get(degree).unwrap_or(last), degree)
}

/// Adds the product of two homogeneous polynomials, given with their degrees.
fn add_product<T: Scalar, const N: usize>(
    sum: &mut Polynomial<T, N>,
    one: (&Polynomial<T, N>, usize),
    other: (&Polynomial<T, N>, usize),
    e: &SVector<T, 3>,
) {
    for (i, a) in one.0.iter().enumerate().take(one.1 + 1) {
        for (entry, b) in sum.iter_mut().skip(i).zip(other.0.iter().take(other.1 + 1)) {
            *entry += product(a, b, e);
        }
    }
}

/// Up to which α the polynomial of each degree is enough, whatever ε is: it lies between the least and the largest x times α. Then the first
/// terms that are left, those of one degree more and of the next, are below `tolerance` or cannot be seen.
#[cold]
pub(super) fn reach<T: Real>(x: &SVector<T, 3>, series: &Coefficients<T>, tolerance: f64) -> [T; 9] {
    let negligible = larger(T::from_f64(tolerance), T::from_ratio(1, 8) * T::EPSILON);
    let sizes = sizes(x, series);
    let root = |size: T, n: usize| {
        if size > T::zero() { (negligible / size).powf(T::from_ratio(1, n as i64)) } else { T::one() }
    };
    let size = |n: usize| sizes.get(n).copied().unwrap_or(T::one());
    // beyond the last degree terms grow on as they did; that they shrink is not counted on
    let (last, before) = (size(DEGREE), size(DEGREE - 1));
    let grown = if before > T::zero() { last * (last / before) } else { last };
    let beyond = if grown > last { grown } else { last };
    DEGREES.map(|degree| {
        let of_degree = |n: usize| root(if n <= DEGREE { size(n) } else { beyond }, n);
        let (reach, other) = (of_degree(degree + 1), of_degree(degree + 2));
        let reach = if other < reach { other } else { reach };
        if reach.is_finite() { reach } else { T::zero() }
    })
}

/// The largest sum of the terms of each degree where α = 1.
fn sizes<T: Real>(x: &SVector<T, 3>, series: &Coefficients<T>) -> [T; DEGREE + 1] {
    const SAMPLES: i64 = 16;
    let low = x.iter().fold(x[0], |low, &other| if other < low { other } else { low });
    let high = x.iter().fold(x[0], |high, &other| larger(high, other));
    let mut sizes = [T::zero(); DEGREE + 1];
    for sample in 0..=SAMPLES {
        let epsilon = low + (high - low) * T::from_ratio(sample, SAMPLES);
        for (n, size) in sizes.iter_mut().enumerate() {
            let terms = (0..=n).rev().fold([T::zero(); 4], |sum, j| {
                let coefficients = coefficient(series, n - j, j);
                core::array::from_fn(|k| sum[k] * epsilon + coefficients[k])
            });
            let sum = terms.iter().fold(T::zero(), |sum, term| sum + term.abs());
            *size = larger(*size, sum);
        }
    }
    sizes
}
