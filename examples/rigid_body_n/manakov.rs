//! Manakov's integrals of the free body in n dimensions.
//!
//! Sources: Manakov, *Note on the integration of Euler's equations of the dynamics of an n-dimensional rigid body*
//! (1976). Moser and Veselov, *Discrete versions of some classical integrable systems* (1991), §1.4. That ⌊n²/4⌋ of
//! them are independent: Mishchenko and Fomenko, *Euler equations on finite-dimensional Lie groups* (1978).

use nalgebra::{SMatrix, SVector};

/// Coefficients of a polynomial in s, the constant one first.
type Polynomial<const N: usize> = Vec<SMatrix<f64, N, N>>;

/// One integral: the coefficient of s^(k − degree) in tr(M + sD)^k, D = J_d².
///
/// The step factors I + λ h M − λ² D into (F − λ J_d)(Fᵀ + λ J_d) and multiplies in the other order, a similarity. So
/// every coefficient of tr(λ h M − λ² D)^k in λ is conserved, and with s = −λ/h those of tr(M + sD)^k. Those of odd
/// degree in M vanish, as the trace of a product is that of its transpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Integral {
    /// The power k, from 2 to n: higher ones follow from these by Cayley and Hamilton.
    pub power: usize,
    /// The degree in M, even; where it is k the integral is a Casimir.
    pub degree: usize,
}

/// All ⌊n²/4⌋ of them, by degree.
pub fn all(n: usize) -> Vec<Integral> {
    let of_degree = |degree| (degree..=n).map(move |power| Integral { power, degree });
    (2..=n).step_by(2).flat_map(of_degree).collect()
}

/// Their values at M, in this order.
pub fn values<const N: usize>(integrals: &[Integral], m: &SMatrix<f64, N, N>, d: &SMatrix<f64, N, N>) -> Vec<f64> {
    let powers = powers(m, d, N.div_ceil(2));
    let value = |&Integral { power, degree }: &Integral| {
        let (left, right) = (&powers[power / 2], &powers[power.div_ceil(2)]);
        let at = power - degree;
        let pairs = left.iter().enumerate().filter_map(|(i, left)| Some((left, right.get(at.checked_sub(i)?)?)));
        // tr AB = ⟨Aᵀ, B⟩
        pairs.map(|(left, right)| left.transpose().dot(right)).sum()
    };
    integrals.iter().map(value).collect()
}

/// By how much relative errors of size one in M move them, at most.
///
/// The coefficient is a sum over the words of k letters, `degree` of them M. Each is at most |M|² ‖M‖^(degree − 2)
/// ‖D‖^(k − degree), the first norm of Frobenius. The step keeps the norms of M, as it turns it.
pub fn scales<const N: usize>(integrals: &[Integral], m: &SMatrix<f64, N, N>, d: &SMatrix<f64, N, N>) -> Vec<f64> {
    let (norm, squares) = (spectral_norm(m), m.norm_squared());
    let scale = |&Integral { power, degree }: &Integral| {
        let words: f64 = (0..degree).map(|i| (power - i) as f64 / (i + 1) as f64).product();
        degree as f64 * words * squares * norm.powi(degree as i32 - 2) * d.amax().powi((power - degree) as i32)
    };
    integrals.iter().map(scale).collect()
}

/// ‖M‖ of a skew matrix from above, by 11 % at most up to n = 10. Its singular values σ come in pairs, so that 2σ¹⁶ ≤
/// tr(MᵀM)⁸.
fn spectral_norm<const N: usize>(m: &SMatrix<f64, N, N>) -> f64 {
    let Some(unit) = m.try_normalize(0.0) else { return 0.0 };
    let square = unit.transpose() * unit;
    let eighth = (0..3).fold(square, |power, _| power * power);
    m.norm() * (eighth.trace() / 2.0).powf(1.0 / 16.0)
}

/// How many of the integrals are independent at M: the rank of their gradients, k times the skew parts of (M + sD)^(k − 1).
pub fn independent<const N: usize>(integrals: &[Integral], m: &SMatrix<f64, N, N>, d: &SMatrix<f64, N, N>) -> usize {
    let powers = powers(m, d, N - 1);
    let gradient = |&Integral { power, degree }: &Integral| {
        let coefficient = powers[power - 1][power - degree];
        coefficient - coefficient.transpose()
    };
    rank(integrals.iter().map(gradient).filter_map(|gradient| gradient.try_normalize(0.0)).collect())
}

/// Below this length the remainder of a unit vector is rounding: some 10³ roundings of the powers, magnified by the
/// vectors before.
const ROUNDING: f64 = 1e-10;

/// Gram and Schmidt, the longest first; twice is enough.
fn rank<const N: usize>(mut vectors: Vec<SMatrix<f64, N, N>>) -> usize {
    let mut rank = 0;
    let longest = |vectors: &[SMatrix<f64, N, N>]| {
        (0..vectors.len()).max_by(|&i, &j| vectors[i].norm_squared().total_cmp(&vectors[j].norm_squared()))
    };
    while let Some(index) = longest(&vectors) {
        let vector = vectors.swap_remove(index);
        let Some(unit) = vector.try_normalize(ROUNDING) else { break };
        for other in &mut vectors {
            *other -= unit * unit.dot(other);
            *other -= unit * unit.dot(other);
        }
        rank += 1;
    }
    rank
}

/// (M + sD)^k for k = 0, …, `last`.
fn powers<const N: usize>(m: &SMatrix<f64, N, N>, d: &SMatrix<f64, N, N>, last: usize) -> Vec<Polynomial<N>> {
    let mut powers = vec![vec![SMatrix::identity()]];
    for k in 0..last {
        let mut next = vec![SMatrix::zeros(); k + 2];
        for (i, coefficient) in powers[k].iter().enumerate() {
            next[i] += coefficient * m;
            next[i + 1] += coefficient * d;
        }
        powers.push(next);
    }
    powers
}

/// The squares of J_d as a matrix.
pub fn squares<const N: usize>(j_d: &SVector<f64, N>) -> SMatrix<f64, N, N> {
    SMatrix::from_diagonal(&j_d.component_mul(j_d))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Matrix5, Vector3, Vector5};

    fn momentum<const N: usize>() -> SMatrix<f64, N, N> {
        let any = SMatrix::<f64, N, N>::from_fn(|i, j| ((3 * i + 5 * j) as f64).sin());
        any - any.transpose()
    }

    /// tr M² and 3 tr M²D in three dimensions; in five, the traces of powers at some s, term by term.
    #[test]
    fn values_are_coefficients_of_traces_of_powers() {
        let (m, d) = (momentum::<3>(), squares(&Vector3::new(1.0, 1.5, 2.0)));
        let [casimir, other] = values(&all(3), &m, &d)[..] else { panic!("two integrals") };
        assert!((casimir - (m * m).trace()).abs() < 1e-13 && (other - 3.0 * (m * m * d).trace()).abs() < 1e-13);

        let (m, d) = (momentum::<5>(), squares(&Vector5::new(1.0, 1.5, 2.0, 2.5, 3.0)));
        let (integrals, s) = (all(5), 0.3);
        let found = values(&integrals, &m, &d);
        for power in 2..=5 {
            let shifted = |a: &Matrix5<f64>| (1..power).fold(*a, |product, _| product * a).trace();
            let terms = integrals.iter().zip(&found).filter(|(integral, _)| integral.power == power);
            let sum: f64 = terms.map(|(integral, value)| value * f64::powi(s, (power - integral.degree) as i32)).sum();
            let expected = shifted(&(m + d * s)) - shifted(&(d * s));
            assert!((sum - expected).abs() < 1e-11 * expected.abs(), "{power}: {sum} and {expected}");
        }
    }

    #[test]
    fn no_value_is_beyond_its_scale() {
        let (m, d) = (momentum::<5>(), squares(&Vector5::new(1.0, 1.5, 2.0, 2.5, 3.0)));
        let norm = m.svd(false, false).singular_values.max();
        assert!((norm..1.1 * norm).contains(&spectral_norm(&m)));
        let scales = scales(&all(5), &m, &d);
        for ((integral, value), scale) in all(5).into_iter().zip(values(&all(5), &m, &d)).zip(scales) {
            // tr M² is as large as it can be
            assert!(value.abs() <= (1.0 + 1e-14) * scale / integral.degree as f64, "{integral:?}");
        }
    }

    /// A body whose J_d is a number has the Casimirs alone.
    #[test]
    fn as_many_are_independent_as_theory_says() {
        let d = squares(&Vector5::new(1.0, 1.5, 2.0, 2.5, 3.0));
        assert_eq!((all(5).len(), independent(&all(5), &momentum(), &d)), (6, 6));
        assert_eq!(independent(&all(5), &momentum(), &Matrix5::identity()), 2);
        assert_eq!(independent(&all(3), &Matrix3::zeros(), &squares(&Vector3::new(1.0, 2.0, 3.0))), 0);
    }
}
