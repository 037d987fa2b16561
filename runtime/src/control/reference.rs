//! References: data of a plan that its motions, prices and bounds read, given step by step.

use crate::{Scalar, Space};
use core::fmt::Debug;

/// The constants of a [`Controlled`](crate::Controlled) system, and the references that its motions, prices and bounds read.
///
/// A scalar, `()` and the pair of constants and a step size have none. [`Referring`] has them. `#[derive(Clebsch)]` chooses among these.
///
/// ```
/// use clebsch::{Referenced, Referring};
/// use nalgebra::Vector2;
///
/// let constants: Referring<f64, Vector2<f64>, ()> = Referring::new(0.1);
/// let read = constants.at(&Vector2::x(), |constants| constants.constants * constants.reference.x);
/// assert_eq!(read, 0.1);
/// // a step size alone refers to nothing
/// assert_eq!(0.1.at(&(), |h: &f64| 2.0 * h), 0.2);
/// ```
pub trait Referenced<T: Scalar>: Clone + Debug {
    /// The reference of a step.
    type Reference: Space<T>;
    /// The reference of the end.
    type EndReference: Space<T>;

    /// Calls `read` with these constants and the reference of a step. [`Referring`] is cloned for it.
    fn at<V>(&self, reference: &Self::Reference, read: impl FnOnce(&Self) -> V) -> V;

    /// These constants with the reference of the end.
    #[must_use]
    fn with_end_reference(self, reference: Self::EndReference) -> Self;

    /// The reference of the end.
    fn end_reference(&self) -> Self::EndReference;
}

/// Implements [`Referenced`] for constants without references.
macro_rules! unreferenced {
    ($($constants:ty: [$($generics:tt)*]),*) => { $(
        impl<T: Scalar, $($generics)*> Referenced<T> for $constants {
            type Reference = ();
            type EndReference = ();

            #[inline(always)]
            fn at<V>(&self, (): &(), read: impl FnOnce(&Self) -> V) -> V {
                read(self)
            }
            #[inline(always)]
            fn with_end_reference(self, (): ()) -> Self {
                self
            }
            #[inline(always)]
            fn end_reference(&self) {}
        }
    )* };
}

unreferenced!(T: [], (): [], (C, T): [C: Clone + Debug]);

/// Constants with the reference of a step and that of the end.
///
/// ```
/// use clebsch::{Referenced, Referring};
///
/// let constants: Referring<f64, (), f64> = Referring::new(0.1).with_end_reference(2.0);
/// assert_eq!((constants.constants, constants.end_reference()), (0.1, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Referring<K, R, E> {
    /// The constants that no step changes.
    pub constants: K,
    /// The reference r_k of a step.
    pub reference: R,
    /// The reference r_N of the end.
    pub end_reference: E,
}

impl<K, R, E> Referring<K, R, E> {
    /// The constants with references that are not given yet: all their numbers are NaN.
    pub fn new<T: Scalar>(constants: K) -> Self
    where
        R: Space<T>,
        E: Space<T>,
    {
        Self { constants, reference: ungiven(), end_reference: ungiven() }
    }
}

impl<T: Scalar, K: Clone + Debug, R: Space<T>, E: Space<T>> Referenced<T> for Referring<K, R, E> {
    type Reference = R;
    type EndReference = E;

    #[inline]
    fn at<V>(&self, reference: &R, read: impl FnOnce(&Self) -> V) -> V {
        read(&Self { reference: *reference, ..self.clone() })
    }
    fn with_end_reference(self, end_reference: E) -> Self {
        Self { end_reference, ..self }
    }
    #[inline]
    fn end_reference(&self) -> E {
        self.end_reference
    }
}

/// A reference that is not given yet.
pub(super) fn ungiven<T: Scalar, R: Space<T>>() -> R {
    R::filled(T::from_f64(f64::NAN))
}
