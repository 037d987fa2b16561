//! The rotation by (p, r) with D r − m × r = p m.

use crate::Scalar;
use crate::space::larger;
use nalgebra::{SMatrix, SVector};

/// A multiple of a quaternion: its scalar part and its vector part.
pub(super) type Turn<T> = (T, SVector<T, 3>);

/// (p, r), a multiple of the quaternion with d r − m × r = p m.
#[inline]
pub(super) fn turn<T: Scalar>(d: &SVector<T, 3>, m: &SVector<T, 3>) -> Turn<T> {
    let ([[a, b, c]], [[x, y, z]]) = (d.data.0, m.data.0);
    let (xx, yy, zz) = (x * x, y * y, z * z);
    let square = xx + yy + zz;
    let p = a * (b * c + xx) + (b * yy + c * zz);
    let r = [
        (b * c + square) * x + (b - c) * (y * z),
        (c * a + square) * y + (c - a) * (z * x),
        (a * b + square) * z + (a - b) * (x * y),
    ];
    (p, r.into())
}

/// The same for a symmetric matrix D: p = det D + m·Dm, r = (adj D + |m|²) m + (Dm) × m.
pub(super) fn turn_of_tensor<T: Scalar>(d: &SMatrix<T, 3, 3>, m: &SVector<T, 3>) -> Turn<T> {
    let (minors, image) = (minors(d), d * m);
    let r = minors.transpose() * m + m * m.dot(m) + image.cross(m);
    (d.column(0).dot(&minors.column(0)) + m.dot(&image), r)
}

/// The cross products of two columns each: the transposed adjugate.
pub(super) fn minors<T: Scalar>(a: &SMatrix<T, 3, 3>) -> SMatrix<T, 3, 3> {
    SMatrix::from_columns(&[(1, 2), (2, 0), (0, 1)].map(|(i, j)| a.column(i).cross(&a.column(j))))
}

/// The same multiple of a quaternion with a largest entry of 1.
pub(super) fn balanced<T: Scalar>((p, r): Turn<T>) -> Turn<T> {
    let size = r.iter().fold(p.abs(), |size, entry| larger(size, entry.abs())).recip();
    (p * size, r * size)
}

/// The same rotation with w ≥ 0.
#[inline(always)]
pub(super) fn shorter<T: Scalar>((w, x): Turn<T>) -> Turn<T> {
    let sign = T::select(w.below(T::zero()), -T::one(), T::one());
    (w * sign, x * sign)
}

/// x/w; at half a turn, where w vanishes, that of an angle which differs by a unit in the last place.
#[inline]
pub(super) fn ratio<T: Scalar>((w, x): Turn<T>) -> SVector<T, 3> {
    let least = T::EPSILON * (x[0].abs() + x[1].abs() + x[2].abs());
    x * T::select(w.abs().below(least), least, w).recip()
}
