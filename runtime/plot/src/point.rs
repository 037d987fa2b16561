//! Points in space from vectors of any kind.

use clebsch::Real;
use nalgebra::{Const, Matrix, RawStorage, Unit};

/// A point in space, or a direction: a vector, a unit vector, a column of a matrix, or an array of three numbers.
///
/// A vector of two numbers is a point of the plane: its third number is 0. One of one number lies on the first axis.
///
/// ```
/// use clebsch_plot::Point;
/// use nalgebra::{Matrix3, Unit, Vector2, Vector3};
///
/// assert_eq!(Matrix3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0).column(2).coordinates(), [3.0, 6.0, 9.0]);
/// assert_eq!(Unit::new_normalize(Vector3::new(0.0_f32, 4.0, 3.0)).coordinates()[1..], [0.8_f32, 0.6].map(f64::from));
/// assert_eq!(Vector2::new(0.5, -1.0).coordinates(), [0.5, -1.0, 0.0]);
/// ```
pub trait Point {
    /// Its three coordinates.
    fn coordinates(&self) -> [f64; 3];
}

impl<T: Real, S: RawStorage<T, Const<3>>> Point for Matrix<T, Const<3>, Const<1>, S> {
    fn coordinates(&self) -> [f64; 3] {
        [self[0], self[1], self[2]].map(T::to_f64)
    }
}

impl<T: Real, S: RawStorage<T, Const<2>>> Point for Matrix<T, Const<2>, Const<1>, S> {
    fn coordinates(&self) -> [f64; 3] {
        [self[0].to_f64(), self[1].to_f64(), 0.0]
    }
}

impl<T: Real, S: RawStorage<T, Const<1>>> Point for Matrix<T, Const<1>, Const<1>, S> {
    fn coordinates(&self) -> [f64; 3] {
        [self[0].to_f64(), 0.0, 0.0]
    }
}

impl<P: Point> Point for Unit<P> {
    fn coordinates(&self) -> [f64; 3] {
        self.as_ref().coordinates()
    }
}

impl<P: Point + ?Sized> Point for &P {
    fn coordinates(&self) -> [f64; 3] {
        (**self).coordinates()
    }
}

impl<T: Real> Point for [T; 3] {
    fn coordinates(&self) -> [f64; 3] {
        self.map(T::to_f64)
    }
}
