//! The rotation by (p, r) with D r − m × r = p m.

use crate::Scalar;
use crate::space::larger;
use nalgebra::{SMatrix, SVector};

/// A multiple of a quaternion: its scalar part and its vector part.
pub(super) type Turn<T> = (T, [T; 3]);

/// (p, r), a multiple of the quaternion with d r − m × r = p m.
#[inline]
pub(super) fn turn<T: Scalar>(d: &[T; 3], m: &[T; 3]) -> Turn<T> {
    let ([a, b, c], [x, y, z]) = (*d, *m);
    let (xx, yy, zz) = (x * x, y * y, z * z);
    let square = xx + yy + zz;
    let p = a * (b * c + xx) + (b * yy + c * zz);
    let r = [
        (b * c + square) * x + (b - c) * (y * z),
        (c * a + square) * y + (c - a) * (z * x),
        (a * b + square) * z + (a - b) * (x * y),
    ];
    (p, r)
}

/// The same for a symmetric matrix D: p = det D + m·Dm, r = (adj D + |m|²) m + (Dm) × m.
pub(super) fn turn_of_tensor<T: Scalar>(d: &SMatrix<T, 3, 3>, m: &[T; 3]) -> Turn<T> {
    let m = SVector::from(*m);
    let columns: [SVector<T, 3>; 3] = core::array::from_fn(|i| d.column(i).into_owned());
    let adjugate = SMatrix::from_fn(|i, j| columns[(i + 1) % 3].cross(&columns[(i + 2) % 3])[j]);
    let (image, determinant) = (d * m, columns[0].dot(&columns[1].cross(&columns[2])));
    let r = adjugate * m + m * m.dot(&m) + image.cross(&m);
    (determinant + m.dot(&image), r.into())
}

/// The same multiple of a quaternion with a largest entry of 1.
pub(super) fn balanced<T: Scalar>((p, r): Turn<T>) -> Turn<T> {
    let size = r.iter().fold(p.abs(), |size, entry| larger(size, entry.abs())).recip();
    (p * size, r.map(|entry| entry * size))
}

/// x/w; at half a turn, where w vanishes, that of an angle which differs by a unit in the last place.
#[inline]
pub(super) fn ratio<T: Scalar>((w, x): (T, SVector<T, 3>)) -> SVector<T, 3> {
    let least = T::EPSILON * (x[0].abs() + x[1].abs() + x[2].abs());
    x * T::select(w.abs().below(least), least, w).recip()
}
