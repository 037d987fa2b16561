//! Numbers, vectors and matrices in another scalar.

use clebsch::Scalar;
use nalgebra::{Quaternion, SMatrix};

/// Values that can be written in another scalar.
pub trait Lift {
    type In<T: Scalar>;
    fn lift<T: Scalar>(self, number: impl Fn(f64) -> T + Copy) -> Self::In<T>;
}

impl Lift for f64 {
    type In<T: Scalar> = T;
    fn lift<T: Scalar>(self, number: impl Fn(f64) -> T + Copy) -> T {
        number(self)
    }
}

impl<const R: usize, const C: usize> Lift for SMatrix<f64, R, C> {
    type In<T: Scalar> = SMatrix<T, R, C>;
    fn lift<T: Scalar>(self, number: impl Fn(f64) -> T + Copy) -> SMatrix<T, R, C> {
        self.map(number)
    }
}

impl Lift for Quaternion<f64> {
    type In<T: Scalar> = Quaternion<T>;
    fn lift<T: Scalar>(self, number: impl Fn(f64) -> T + Copy) -> Quaternion<T> {
        Quaternion { coords: self.coords.map(number) }
    }
}

impl<A: Lift, B: Lift> Lift for (A, B) {
    type In<T: Scalar> = (A::In<T>, B::In<T>);
    fn lift<T: Scalar>(self, number: impl Fn(f64) -> T + Copy) -> Self::In<T> {
        (self.0.lift(number), self.1.lift(number))
    }
}
