//! Where configurations and momenta lie: defects of rotations and directions, and sums that every system needs.

use crate::linear::Orientation;
use crate::{Error, Scalar, Space};
use nalgebra::{SMatrix, SVector};

/// The largest entry of |RᵀR − I|; +∞ for a reflection, whose determinant is negative.
pub fn orthogonality_defect<T: Scalar, const N: usize>(r: &SMatrix<T, N, N>) -> T {
    let mut defect = T::zero();
    for i in 0..N {
        for j in 0..N {
            let product = (0..N).fold(T::zero(), |sum, k| sum + r[(k, i)] * r[(k, j)]);
            let expected = if i == j { T::one() } else { T::zero() };
            defect = crate::space::larger(defect, (product - expected).abs());
        }
    }
    let rows = core::array::from_fn(|i| core::array::from_fn(|j| r[(i, j)]));
    match Orientation::of::<T, N>(rows) {
        Some(Orientation::Negative) => T::one() / T::zero(),
        _ => defect,
    }
}

/// ||q|² − 1|.
pub fn length_defect<T: Scalar, const N: usize>(q: &SVector<T, N>) -> T {
    (q.iter().fold(T::zero(), |sum, &x| sum + x * x) - T::one()).abs()
}

/// The largest of some numbers that are not negative; 0 for none.
pub fn largest<T: Scalar, const K: usize>(values: [T; K]) -> T {
    values.max_abs()
}

/// ½ μ·Σ⁻¹μ.
pub fn kinetic_energy<T: Scalar, const M: usize>(inverse: &SMatrix<T, M, M>, mu: &SVector<T, M>) -> T {
    let mut energy = T::zero();
    for i in 0..M {
        let velocity = (0..M).fold(T::zero(), |sum, j| sum + inverse[(i, j)] * mu[j]);
        energy += mu[i] * velocity;
    }
    energy * T::from_ratio(1, 2)
}

/// I + D.
pub fn from_increment<T: Scalar, const N: usize>(d: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    let mut element = *d;
    for i in 0..N {
        element[(i, i)] += T::one();
    }
    element
}

/// Whether a step whose angle θ has this sin²θ exists: below one, it does.
///
/// # Errors
/// [`Error::Unsolvable`] with 1/|sin θ|, the fraction of the momentum for which it would; [`Error::NotFinite`].
#[inline]
pub fn check_sine_squared<T: Scalar>(sine_squared: T) -> Result<(), Error> {
    if sine_squared < T::one() {
        return Ok(());
    }
    if !sine_squared.is_finite() {
        return Err(Error::NotFinite { name: "momentum" });
    }
    Err(Error::Unsolvable { solvable_fraction: sine_squared.sqrt().recip().to_f64(), step_size: None })
}

#[cfg(test)]
mod tests {
    use super::{check_sine_squared, kinetic_energy, length_defect, orthogonality_defect};
    use crate::Error;
    use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

    #[test]
    fn rotations_have_no_defect_and_reflections_an_infinite_one() {
        let rotation = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        assert_eq!(orthogonality_defect(&rotation), 0.0);
        assert_eq!(orthogonality_defect(&-rotation), f64::INFINITY);
        assert_eq!(orthogonality_defect(&(rotation * 2.0)), 3.0);
    }

    #[test]
    fn steps_beyond_a_quarter_turn_say_by_how_much() {
        assert_eq!(check_sine_squared(0.99), Ok(()));
        assert_eq!(check_sine_squared(4.0), Err(Error::Unsolvable { solvable_fraction: 0.5, step_size: None }));
        assert_eq!(check_sine_squared(f64::NAN), Err(Error::NotFinite { name: "momentum" }));
    }

    #[test]
    fn lengths_and_energies() {
        assert_eq!(length_defect(&Vector3::new(0.0, 3.0, 0.0)), 8.0);
        assert_eq!(kinetic_energy(&Matrix2::new(1.0, 0.5, 0.5, 2.0), &Vector2::new(2.0, 4.0)), 22.0);
    }
}
