//! The principal logarithm of a matrix: square roots until it is near the identity, then the series of 2 artanh.
//!
//! Source: Higham, *Functions of Matrices*, 2008, chapters 6 (equation 6.29, the product form of the iteration of Denman and
//! Beavers) and 11 (equation 11.31).

use crate::linear::{eliminate, multiple_of_identity, norm, product, rows, shifted, undefined};
use crate::space::by_lane;
use crate::{Real, Scalar, Space};
use core::array::from_fn;
use nalgebra::SMatrix;

type Square<T, const N: usize> = [[T; N]; N];

/// Square roots that bring every matrix of finite `f64` near the identity whose entries off the diagonal are not much larger
/// than those on it.
const ROOTS: u32 = 64;

/// Terms of the series: 3⁻⁸⁰ is 10⁻³⁸.
const TERMS: i64 = 40;

/// The principal logarithm, whose eigenvalues have imaginary parts between −π and π.
///
/// NaN where there is none: where A is not finite, is singular or has an eigenvalue on the negative real axis; and where its
/// square roots have lost half of the digits, as for eigenvalues that only round-off keeps from that axis. For an angle θ near π
/// the error grows like ε/(π − θ), for so ill-conditioned is the logarithm there.
pub fn logarithm<T: Scalar, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    by_lane(a, logarithm_of_one)
}

fn logarithm_of_one<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    if !a.is_finite() {
        return undefined();
    }
    match scaled_logarithm(rows(a)) {
        Some(logarithm) => SMatrix::from_fn(|i, j| logarithm[i][j]),
        None => undefined(),
    }
}

fn scaled_logarithm<T: Real, const N: usize>(a: Square<T, N>) -> Option<Square<T, N>> {
    let (mut root, mut factor) = (a, T::from_f64(2.0));
    let mut roots = 0;
    while !is_near_identity(&root) {
        if roots == ROOTS {
            return None;
        }
        root = square_root(&root)?;
        factor += factor;
        roots += 1;
    }
    let half_logarithm = inverse_hyperbolic_tangent(&root)?;
    Some(half_logarithm.map(|row| row.map(|x| x * factor)))
}

/// Whether |X − I| ≤ ½, or at least its powers N and N + 1 are as small: then the series converges like 9⁻ᵏ.
///
/// These powers vanish for a unipotent X, whose series is finite however large its entries are.
fn is_near_identity<T: Real, const N: usize>(x: &Square<T, N>) -> bool {
    let difference = shifted(x, -T::one());
    let half = T::from_ratio(1, 2);
    let (mut power, mut bound) = (difference, half);
    if norm(&power) <= half {
        return true;
    }
    for _ in 1..N {
        power = product(&power, &difference);
        bound *= half;
    }
    norm(&power) <= bound && norm(&product(&power, &difference)) <= bound * half
}

/// ½ log X = Y + Y³/3 + Y⁵/5 + …, Y = (X + I)⁻¹(X − I).
fn inverse_hyperbolic_tangent<T: Real, const N: usize>(x: &Square<T, N>) -> Option<Square<T, N>> {
    let mut y = shifted(x, -T::one());
    eliminate(shifted(x, T::one()), &mut y)?;
    let square = product(&y, &y);
    let (mut power, mut sum) = (y, y);
    let first = norm(&y);
    let mut derivatives = T::DERIVATIVES;
    for k in 1..=TERMS {
        power = product(&power, &square);
        let factor = T::from_ratio(1, 2 * k + 1);
        sum = from_fn(|i| from_fn(|j| sum[i][j] + power[i][j] * factor));
        if norm(&power) <= T::EPSILON * T::from_ratio(1, 8) * first {
            if derivatives == 0 {
                break;
            }
            derivatives -= 1;
        }
    }
    Some(sum)
}

/// Iterations for one square root: scaled, five to ten are enough; for an eigenvalue on the negative axis none are.
const ITERATIONS: u32 = 40;

/// The principal square root X by X ← (X + Y⁻¹)/2, Y ← (Y + X⁻¹)/2 from A and I, Y being X A⁻¹; `None` where it does not converge
/// to one.
///
/// The product form of the iteration, which needs one inverse less, loses the square of the digits for angles near π.
fn square_root<T: Real, const N: usize>(a: &Square<T, N>) -> Option<Square<T, N>> {
    let (mut x, mut y) = (*a, multiple_of_identity(T::one()));
    let (half, hundredth) = (T::from_ratio(1, 2), T::from_ratio(1, 100));
    let mut before = T::one() / T::zero();
    for _ in 0..ITERATIONS {
        let (mut x_inverse, mut y_inverse) = (multiple_of_identity(T::one()), multiple_of_identity(T::one()));
        eliminate(x, &mut x_inverse)?;
        eliminate(y, &mut y_inverse)?;
        // Far off, a scaling makes eigenvalues and their inverses alike large.
        let scale = if before > hundredth {
            ((norm(&x_inverse) * norm(&y_inverse)).sqrt() / (norm(&x) * norm(&y)).sqrt()).sqrt()
        } else {
            T::one()
        };
        let mean = |x: &Square<T, N>, inverse: &Square<T, N>| -> Square<T, N> {
            from_fn(|i| from_fn(|j| (x[i][j] * scale + inverse[i][j] / scale) * half))
        };
        let (next, next_y) = (mean(&x, &y_inverse), mean(&y, &x_inverse));
        let change: Square<T, N> = from_fn(|i| from_fn(|j| next[i][j] - x[i][j]));
        let distance = norm(&change) / norm(&next);
        (x, y) = (next, next_y);
        // The iteration after the last one that helps is made, for derivatives are behind by one.
        if distance <= T::EPSILON || before < hundredth && distance > before * half {
            return is_root(&x, a).then_some(x);
        }
        before = distance;
    }
    None
}

/// Whether X² is A to half of the digits at least.
fn is_root<T: Real, const N: usize>(root: &Square<T, N>, a: &Square<T, N>) -> bool {
    let square = product(root, root);
    let difference: Square<T, N> = from_fn(|i| from_fn(|j| square[i][j] - a[i][j]));
    norm(&difference) <= T::EPSILON.sqrt() * norm(a)
}

#[cfg(test)]
mod tests {
    use super::logarithm;
    use crate::exponential::exponential;
    use nalgebra::{Matrix2, Matrix3, Matrix4, Rotation3, Vector3};
    use proptest::prelude::*;

    /// By rows, from the series and square roots in 60 digits (mpmath).
    #[rustfmt::skip]
    const EXACT: [f64; 9] = [
        1.5365385070677517, -0.642026298162378, 0.30299445486448906,
        0.40928370288501764, 1.727129986592835, 0.06016980996897717,
        -0.05620148766970299, 0.23274259527736033, 1.0930403330290053,
    ];

    /// The second one in 60 digits too.
    #[test]
    fn generic_and_ill_scaled_matrices() {
        let generic = Matrix3::new(4.0, -3.0, 1.0, 2.0, 5.0, 0.5, 0.0, 1.0, 3.0);
        let exact = Matrix3::from_row_slice(&EXACT);
        assert!((logarithm(&generic) - exact).amax() < 4e-15);
        let stretched = Matrix2::new(2.0_f64.powi(-30), 1.0, 0.0, 2.0_f64.powi(30));
        let exact = Matrix2::new(-20.79441541679836, 3.873261700719289e-8, 0.0, 20.79441541679836);
        assert!((logarithm(&stretched) - exact).amax() < 1e-13, "{}", logarithm(&stretched));
    }

    #[test]
    fn small_logarithms_have_all_their_digits() {
        let turned = Matrix2::new(1.0, 2.0_f64.powi(-40), -2.0_f64.powi(-41), 1.0);
        let exact =
            Matrix2::new(2.0679515313825692e-25, 9.094947017729282e-13, -4.547473508864641e-13, 2.0679515313825692e-25);
        assert!(logarithm(&turned).component_div(&exact).add_scalar(-1.0).amax() < 1e-15);
        assert_eq!(logarithm(&Matrix2::<f64>::identity()), Matrix2::zeros());
        let shear = Matrix3::new(1.0, 1e9, 1e18, 0.0, 1.0, 1e9, 0.0, 0.0, 1.0);
        assert_eq!(logarithm(&shear), Matrix3::new(0.0, 1e9, 5e17, 0.0, 0.0, 1e9, 0.0, 0.0, 0.0));
    }

    /// Rotations by angles up to π less 10⁻⁶, where the logarithm is as ill-conditioned as is written there.
    #[test]
    fn rotations_by_nearly_half_a_turn_are_undone() {
        let axis = Vector3::new(2.0, -1.0, 2.0) / 3.0;
        for rest in [3.0, 1.0, 0.1, 1e-3, 1e-6] {
            let vector = axis * (core::f64::consts::PI - rest);
            let found = logarithm(Rotation3::from_scaled_axis(vector).matrix());
            let error = (found - vector.cross_matrix()).amax();
            assert!(error < 1e-14 / f64::min(rest, 1.0), "π − {rest}: {error:e}");
        }
    }

    /// A displacement of SE(3): turned by 2 about e3 and shifted so that (v, 2e3) with v = (10⁷, 0, 10⁷) is the logarithm.
    #[test]
    fn large_shifts_leave_the_rotation_its_digits() {
        let (far, sine, cosine) = (1e7, f64::sin(2.0), f64::cos(2.0));
        let (x, y) = (far * sine / 2.0, far * (1.0 - cosine) / 2.0);
        let (a, b) = ([cosine, -sine, 0.0, x], [sine, cosine, 0.0, y]);
        let motion = Matrix4::from_row_slice(&[a, b, [0.0, 0.0, 1.0, far], [0.0, 0.0, 0.0, 1.0]].concat());
        let (mut generator, mut error) = (Matrix4::zeros(), logarithm(&motion));
        (generator[(1, 0)], generator[(0, 1)], generator[(0, 3)], generator[(2, 3)]) = (2.0, -2.0, far, far);
        error -= generator;
        assert!(error.fixed_view::<4, 3>(0, 0).amax() < 4e-14 && error.amax() < 1e-14 * far, "{error}");
        assert!((exponential(&generator) - motion).amax() < 1e-15 * far);
    }

    #[test]
    fn where_there_is_no_logarithm_there_is_nan() {
        let half_turn = Matrix3::from_diagonal(&Vector3::new(-1.0, -1.0, 1.0));
        let tilted = Rotation3::from_scaled_axis(Vector3::new(0.6, 0.0, 0.8) * core::f64::consts::PI);
        let conditions = [half_turn, -Matrix3::identity(), Matrix3::zeros(), half_turn * f64::NAN, half_turn / 0.0];
        for matrix in conditions {
            assert!(logarithm(&matrix).iter().all(|x| x.is_nan()), "{matrix}");
        }
        // Half a turn but for rounding: one of the two logarithms, or none.
        let found = logarithm(tilted.matrix());
        assert!(found[(0, 0)].is_nan() || (exponential(&found) - tilted.matrix()).amax() < 1e-6, "{found}");
        assert!(logarithm(&Matrix2::new(-1.0_f64, 3.0, 0.0, 2.0))[(0, 0)].is_nan());
    }

    #[test]
    fn single_precision_is_exact_to_single_precision() {
        let found = logarithm(&Matrix2::new(0.0_f32, -1.0, 1.0, 0.0));
        assert!((found - Matrix2::new(0.0, -1.0, 1.0, 0.0) * core::f32::consts::FRAC_PI_2).amax() < 4e-7);
    }

    proptest! {
        #[test]
        fn logarithms_undo_exponentials(entries in prop::array::uniform9(-0.9_f64..0.9)) {
            let matrix = Matrix3::from_row_slice(&entries);
            prop_assert!((logarithm(&exponential(&matrix)) - matrix).amax() < 4e-14);
        }
    }
}
