//! The rotation by (p, r) with D r − m × r = p m, alone and in equal parts.

use crate::Scalar;
use nalgebra::{SMatrix, SVector};

/// (p, r), a multiple of the quaternion with d r − m × r = p m.
#[inline]
pub(super) fn turn<T: Scalar>(d: &[T; 3], m: &[T; 3]) -> (T, [T; 3]) {
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
pub(super) fn turn_of_tensor<T: Scalar>(d: &SMatrix<T, 3, 3>, m: &[T; 3]) -> (T, [T; 3]) {
    let m = SVector::from(*m);
    let columns: [SVector<T, 3>; 3] = core::array::from_fn(|i| d.column(i).into_owned());
    let adjugate = SMatrix::from_fn(|i, j| columns[(i + 1) % 3].cross(&columns[(i + 2) % 3])[j]);
    let (image, determinant) = (d * m, columns[0].dot(&columns[1].cross(&columns[2])));
    let r = adjugate * m + m * m.dot(&m) + image.cross(&m);
    (determinant + m.dot(&image), r.into())
}

/// The quaternion of the turns of equal parts of the time, one after the other; `turned` gives a multiple for the momentum m of a part.
pub(super) fn turn_in_parts<T: Scalar>(turned: impl Fn(&[T; 3]) -> (T, [T; 3]), m: &[T; 3], parts: u32) -> (T, [T; 3]) {
    let size = T::from_ratio(1, i64::from(parts));
    let mut part = m.map(|component| component * size);
    let mut whole = (T::one(), [T::zero(); 3]);
    for _ in 0..parts {
        let (p, r) = unit(turned(&part));
        whole = product(whole, (p, r));
        part = carried(&part, p, &r);
    }
    whole
}

/// x/w; at half a turn, where w vanishes, that of an angle which differs by a unit in the last place.
#[inline]
pub(super) fn ratio<T: Scalar>((w, x): (T, SVector<T, 3>)) -> SVector<T, 3> {
    let least = T::EPSILON * (x[0].abs() + x[1].abs() + x[2].abs());
    x * T::select(w.abs().below(least), least, w).recip()
}

/// The unit quaternion of a multiple.
fn unit<T: Scalar>((p, r): (T, [T; 3])) -> (T, [T; 3]) {
    let [x, y, z] = r;
    let inverse = (p * p + x * x + y * y + z * z).sqrt().recip();
    (p * inverse, r.map(|component| component * inverse))
}

/// The product of two quaternions.
fn product<T: Scalar>((p, [x, y, z]): (T, [T; 3]), (s, [a, b, c]): (T, [T; 3])) -> (T, [T; 3]) {
    let scalar = p * s - x * a - y * b - z * c;
    let vector = [p * a + s * x + y * c - z * b, p * b + s * y + z * a - x * c, p * c + s * z + x * b - y * a];
    (scalar, vector)
}

/// Fᵀm of the rotation by a unit quaternion: m − 2ρ₀ ρ × m + 2 ρ × (ρ × m).
fn carried<T: Scalar>(m: &[T; 3], p: T, r: &[T; 3]) -> [T; 3] {
    let cross = |[a, b, c]: [T; 3], [x, y, z]: [T; 3]| [b * z - c * y, c * x - a * z, a * y - b * x];
    let once = cross(*r, *m);
    let twice = cross(*r, once);
    let two = T::one() + T::one();
    core::array::from_fn(|i| m[i] + two * (twice[i] - p * once[i]))
}
