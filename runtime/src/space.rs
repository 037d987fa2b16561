//! The spaces that configurations, group elements and momenta live in: arrays of scalars, nested as declared.

use crate::Scalar;
use core::fmt::Debug;
use nalgebra::{Quaternion, SMatrix};

/// A value made of scalars `T`: a scalar, a vector or matrix, a quaternion, a tuple of up to eight spaces, an array of a space,
/// or `()`.
///
/// Implementations only have to say how their scalars are visited.
pub trait Space<T: Scalar>: Copy + Debug + PartialEq {
    /// Combines `visit(x)` of all scalars x by `and`, without leaving early: on small arrays branches cost more than comparisons.
    fn all(&self, visit: impl Fn(T) -> bool + Copy) -> bool;

    /// The largest |x| of all scalars x, 0 for `()`. NaN are passed over.
    fn max_abs(&self) -> T;

    /// Where all scalars are 0.
    fn origin() -> Self;

    /// |self − other|², the sum over all scalars, 0 for `()`.
    fn distance_squared(&self, other: &Self) -> T;

    /// Whether no scalar is NaN or infinite.
    #[inline]
    fn is_finite(&self) -> bool {
        self.all(|x| x.is_finite())
    }
}

/// The larger one; `a` where either is NaN.
#[inline]
pub(crate) fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if b > a { b } else { a }
}

impl<T: Scalar> Space<T> for T {
    #[inline]
    fn all(&self, visit: impl Fn(T) -> bool + Copy) -> bool {
        visit(*self)
    }
    #[inline]
    fn max_abs(&self) -> T {
        larger(T::zero(), self.abs())
    }
    #[inline]
    fn origin() -> Self {
        T::zero()
    }
    #[inline]
    fn distance_squared(&self, other: &Self) -> T {
        (*self - *other) * (*self - *other)
    }
}

impl<T: Scalar, const R: usize, const C: usize> Space<T> for SMatrix<T, R, C> {
    #[inline]
    fn all(&self, visit: impl Fn(T) -> bool + Copy) -> bool {
        self.iter().fold(true, |all, &x| all & visit(x))
    }
    #[inline]
    fn max_abs(&self) -> T {
        self.iter().fold(T::zero(), |max, x| larger(max, x.abs()))
    }
    #[inline]
    fn origin() -> Self {
        SMatrix::from_element(T::zero())
    }
    #[inline]
    fn distance_squared(&self, other: &Self) -> T {
        self.iter().zip(other.iter()).fold(T::zero(), |sum, (x, y)| sum + (*x - *y) * (*x - *y))
    }
}

impl<T: Scalar> Space<T> for Quaternion<T> {
    #[inline]
    fn all(&self, visit: impl Fn(T) -> bool + Copy) -> bool {
        self.coords.all(visit)
    }
    #[inline]
    fn max_abs(&self) -> T {
        self.coords.max_abs()
    }
    #[inline]
    fn origin() -> Self {
        Quaternion { coords: SMatrix::origin() }
    }
    #[inline]
    fn distance_squared(&self, other: &Self) -> T {
        self.coords.distance_squared(&other.coords)
    }
}

impl<T: Scalar, S: Space<T>, const N: usize> Space<T> for [S; N] {
    #[inline]
    fn all(&self, visit: impl Fn(T) -> bool + Copy) -> bool {
        self.iter().fold(true, |all, part| all & part.all(visit))
    }
    #[inline]
    fn max_abs(&self) -> T {
        self.iter().fold(T::zero(), |max, part| larger(max, part.max_abs()))
    }
    #[inline]
    fn origin() -> Self {
        [S::origin(); N]
    }
    #[inline]
    fn distance_squared(&self, other: &Self) -> T {
        self.iter().zip(other).fold(T::zero(), |sum, (part, other)| sum + part.distance_squared(other))
    }
}

/// A tuple is as finite and as large as its parts.
macro_rules! tuple {
    ($($name:ident . $index:tt),*) => {
        impl<T: Scalar, $($name: Space<T>),*> Space<T> for ($($name,)*) {
            #[inline]
            fn all(&self, _visit: impl Fn(T) -> bool + Copy) -> bool {
                true $(& self.$index.all(_visit))*
            }
            #[inline]
            fn max_abs(&self) -> T {
                let max = T::zero();
                $(let max = larger(max, self.$index.max_abs());)*
                max
            }
            #[inline]
            #[allow(clippy::unused_unit)] // of the tuple without parts
            fn origin() -> Self {
                ($($name::origin(),)*)
            }
            #[inline]
            fn distance_squared(&self, _other: &Self) -> T {
                T::zero() $(+ self.$index.distance_squared(&_other.$index))*
            }
        }
    };
}

tuple!();
tuple!(A.0);
tuple!(A.0, B.1);
tuple!(A.0, B.1, C.2);
tuple!(A.0, B.1, C.2, D.3);
tuple!(A.0, B.1, C.2, D.3, E.4);
tuple!(A.0, B.1, C.2, D.3, E.4, F.5);
tuple!(A.0, B.1, C.2, D.3, E.4, F.5, G.6);
tuple!(A.0, B.1, C.2, D.3, E.4, F.5, G.6, H.7);

#[cfg(test)]
mod tests {
    use super::Space;
    use nalgebra::{Matrix3, Quaternion, Vector2};

    #[test]
    fn nested_spaces_are_visited_completely() {
        let nested =
            ([(1.0, Vector2::new(-7.0, 2.0)); 2], Matrix3::<f64>::identity(), (), Quaternion::new(-8.0, 0.0, 0.0, 0.0));
        assert!(nested.is_finite());
        assert_eq!(Space::<f64>::max_abs(&nested), 8.0);
        let mut broken = nested;
        (broken.0[1].1.y, broken.3.coords.w) = (5.0, -4.0);
        assert_eq!(Space::<f64>::distance_squared(&nested, &broken), 25.0);
        broken.0[1].1.y = f64::NAN;
        assert!(!broken.is_finite());
        broken.0[1].1.y = f64::NEG_INFINITY;
        assert!(!broken.is_finite());
    }
}
