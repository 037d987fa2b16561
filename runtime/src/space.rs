//! The spaces that configurations, group elements and momenta live in: arrays of scalars, nested as declared.

use crate::{Columns, Error, Mask, Scalar};
use core::fmt::Debug;
use nalgebra::{Quaternion, SMatrix};

/// A value made of scalars `T`. It is a scalar, vector, matrix or quaternion, a tuple of up to eight spaces, an array of
/// a space, or `()`.
///
/// Implementations only have to say how their scalars are visited.
///
/// ```
/// use clebsch::Space;
/// use nalgebra::{Matrix2, Vector3};
///
/// let place = (Vector3::new(1.0, -3.0, 2.0), [Matrix2::<f64>::identity(); 2]);
/// assert_eq!(place.max_abs(), 3.0);
/// assert!(place.all_finite());
/// assert_eq!(place.distance_squared(&Space::<f64>::origin()), 18.0);
/// ```
pub trait Space<T: Scalar>: Columns<T> + Copy + Debug + PartialEq {
    /// One lane of it; the space itself if scalars are single numbers.
    type Lane: Space<T::Lane>;

    /// The value of the next numbers, in the order of its [`Columns`]; `None` if there are too few.
    ///
    /// ```
    /// use clebsch::Space;
    /// use nalgebra::{Matrix2, Vector2};
    ///
    /// let mut numbers = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].into_iter();
    /// let pair = <(Matrix2<f64>, Vector2<f64>)>::from_columns(&mut numbers);
    /// assert_eq!(pair, Some((Matrix2::new(1.0, 2.0, 3.0, 4.0), Vector2::new(5.0, 6.0))));
    /// ```
    fn from_columns(numbers: &mut impl Iterator<Item = T>) -> Option<Self>;

    /// Joins `visit(x)` of all scalars x, `unit` where there are none: from left to right, those of each component before components are joined.
    fn reduce<V: Copy>(&self, unit: V, visit: impl Fn(T) -> V + Copy, join: impl Fn(V, V) -> V + Copy) -> V;

    /// Where all scalars are `value`.
    fn filled(value: T) -> Self;

    /// f(a, b) of all scalars a of it and b of another, in their places.
    fn zip_map(&self, other: &Self, f: impl Fn(T, T) -> T + Copy) -> Self;

    /// The value in lane `lane` of all scalars; the value itself where they are single numbers.
    fn lane(&self, lane: usize) -> Self::Lane;

    /// Puts `value` into lane `lane` of all scalars.
    fn set_lane(&mut self, lane: usize, value: &Self::Lane);

    /// Combines `visit(x)` of all scalars x by `and`, without leaving early: on small arrays branches cost more than comparisons.
    #[inline]
    fn all(&self, visit: impl Fn(T) -> bool + Copy) -> bool {
        self.reduce(true, visit, |a, b| a & b)
    }

    /// The largest |x| of all scalars x, 0 for `()`. NaN are passed over.
    #[inline]
    fn max_abs(&self) -> T {
        larger(T::zero(), self.reduce(T::zero(), |x| x.abs(), larger))
    }

    /// Where all scalars are 0.
    #[inline]
    fn origin() -> Self {
        Self::filled(T::zero())
    }

    /// |self − other|², the sum over all scalars, 0 for `()`.
    #[inline]
    fn distance_squared(&self, other: &Self) -> T {
        self.zip_map(other, |a, b| (a - b) * (a - b)).sum()
    }

    /// The sum of all scalars, 0 for `()`: where it is finite, all of them are.
    #[inline]
    fn sum(&self) -> T {
        self.reduce(T::zero(), |x| x, |a, b| a + b)
    }

    /// The value with `value(i)` in lane i.
    #[inline]
    fn side_by_side(mut value: impl FnMut(usize) -> Self::Lane) -> Self {
        let mut all = Self::origin();
        (0..T::LANES).for_each(|lane| all.set_lane(lane, &value(lane)));
        all
    }

    /// The lanes in which no scalar is NaN or infinite.
    #[inline]
    fn finite(&self) -> T::Mask {
        self.reduce(T::Mask::everywhere(), |x| x.finite(), |a, b| a & b)
    }

    /// Whether no scalar is NaN or infinite in any lane.
    #[inline]
    fn all_finite(&self) -> bool {
        self.all(|x| x.is_finite())
    }
}

/// The larger one; `a` where either is NaN.
#[inline]
pub(crate) fn larger<T: Scalar>(a: T, b: T) -> T {
    T::select(a.below(b), b, a)
}

/// a + b
#[inline(always)]
pub(crate) fn plus<T: Scalar, V: Space<T>>(a: &V, b: &V) -> V {
    a.zip_map(b, |a, b| a + b)
}

/// a − b
#[inline(always)]
pub(crate) fn minus<T: Scalar, V: Space<T>>(a: &V, b: &V) -> V {
    a.zip_map(b, |a, b| a - b)
}

/// `value` with `number` in lane `lane`.
#[inline]
fn with_lane<T: Scalar>(value: T, lane: usize, number: T::Lane) -> T {
    T::from_lanes(|i| if i == lane { number } else { value.lane(i) })
}

impl<T: Scalar> Space<T> for T {
    type Lane = T::Lane;

    #[inline]
    fn from_columns(numbers: &mut impl Iterator<Item = T>) -> Option<Self> {
        numbers.next()
    }
    #[inline]
    fn reduce<V: Copy>(&self, _: V, visit: impl Fn(T) -> V + Copy, _: impl Fn(V, V) -> V + Copy) -> V {
        visit(*self)
    }
    #[inline]
    fn filled(value: T) -> Self {
        value
    }
    #[inline]
    fn zip_map(&self, other: &Self, f: impl Fn(T, T) -> T + Copy) -> Self {
        f(*self, *other)
    }
    #[inline]
    fn lane(&self, lane: usize) -> T::Lane {
        Scalar::lane(*self, lane)
    }
    #[inline]
    fn set_lane(&mut self, lane: usize, value: &T::Lane) {
        *self = with_lane(*self, lane, *value);
    }
}

impl<T: Scalar, const R: usize, const C: usize> Space<T> for SMatrix<T, R, C> {
    type Lane = SMatrix<T::Lane, R, C>;

    #[inline]
    fn from_columns(numbers: &mut impl Iterator<Item = T>) -> Option<Self> {
        let mut matrix = Self::origin();
        for row in 0..R {
            for column in 0..C {
                *matrix.get_mut((row, column))? = numbers.next()?;
            }
        }
        Some(matrix)
    }
    #[inline]
    fn reduce<V: Copy>(&self, unit: V, visit: impl Fn(T) -> V + Copy, join: impl Fn(V, V) -> V + Copy) -> V {
        // a slice, for the compiler does not see that the entries of a matrix stand side by side
        self.as_slice().iter().fold(unit, |all, &x| join(all, visit(x)))
    }
    #[inline]
    fn filled(value: T) -> Self {
        SMatrix::from_element(value)
    }
    #[inline]
    fn zip_map(&self, other: &Self, f: impl Fn(T, T) -> T + Copy) -> Self {
        SMatrix::zip_map(self, other, f)
    }
    #[inline]
    fn lane(&self, lane: usize) -> Self::Lane {
        self.map(|x| Scalar::lane(x, lane))
    }
    #[inline]
    fn set_lane(&mut self, lane: usize, value: &Self::Lane) {
        self.zip_apply(value, |x, number| *x = with_lane(*x, lane, number));
    }
}

impl<T: Scalar> Space<T> for Quaternion<T> {
    type Lane = Quaternion<T::Lane>;

    #[inline]
    fn from_columns(numbers: &mut impl Iterator<Item = T>) -> Option<Self> {
        let [w, i, j, k] = <[T; 4]>::from_columns(numbers)?;
        Some(Quaternion { coords: SMatrix::from([i, j, k, w]) })
    }
    #[inline]
    fn reduce<V: Copy>(&self, unit: V, visit: impl Fn(T) -> V + Copy, join: impl Fn(V, V) -> V + Copy) -> V {
        self.coords.reduce(unit, visit, join)
    }
    #[inline]
    fn filled(value: T) -> Self {
        Quaternion { coords: SMatrix::filled(value) }
    }
    #[inline]
    fn zip_map(&self, other: &Self, f: impl Fn(T, T) -> T + Copy) -> Self {
        Quaternion { coords: Space::zip_map(&self.coords, &other.coords, f) }
    }
    #[inline]
    fn lane(&self, lane: usize) -> Self::Lane {
        Quaternion { coords: self.coords.lane(lane) }
    }
    #[inline]
    fn set_lane(&mut self, lane: usize, value: &Self::Lane) {
        self.coords.set_lane(lane, &value.coords);
    }
}

impl<T: Scalar, S: Space<T>, const N: usize> Space<T> for [S; N] {
    type Lane = [S::Lane; N];

    #[inline]
    fn from_columns(numbers: &mut impl Iterator<Item = T>) -> Option<Self> {
        let mut parts = Self::origin();
        for part in &mut parts {
            *part = S::from_columns(numbers)?;
        }
        Some(parts)
    }
    #[inline]
    fn reduce<V: Copy>(&self, unit: V, visit: impl Fn(T) -> V + Copy, join: impl Fn(V, V) -> V + Copy) -> V {
        self.iter().fold(unit, |all, part| join(all, part.reduce(unit, visit, join)))
    }
    #[inline]
    fn filled(value: T) -> Self {
        [S::filled(value); N]
    }
    #[inline]
    fn zip_map(&self, other: &Self, f: impl Fn(T, T) -> T + Copy) -> Self {
        // in place: an index of `from_fn` is checked where the parts are large
        let mut parts = *self;
        parts.iter_mut().zip(other).for_each(|(part, other)| *part = part.zip_map(other, f));
        parts
    }
    #[inline]
    fn lane(&self, lane: usize) -> Self::Lane {
        self.map(|part| part.lane(lane))
    }
    #[inline]
    fn set_lane(&mut self, lane: usize, value: &Self::Lane) {
        self.iter_mut().zip(value).for_each(|(part, value)| part.set_lane(lane, value));
    }
}

macro_rules! tuple {
    ($($name:ident . $index:tt),*) => {
        #[allow(clippy::unused_unit, unused_variables, reason = "the tuple without parts")]
        impl<T: Scalar, $($name: Space<T>),*> Space<T> for ($($name,)*) {
            type Lane = ($($name::Lane,)*);

            #[inline]
            fn from_columns(numbers: &mut impl Iterator<Item = T>) -> Option<Self> {
                Some(($($name::from_columns(numbers)?,)*))
            }
            #[inline]
            fn reduce<V: Copy>(&self, unit: V, visit: impl Fn(T) -> V + Copy, join: impl Fn(V, V) -> V + Copy) -> V {
                let all = unit;
                $(let all = join(all, self.$index.reduce(unit, visit, join));)*
                all
            }
            #[inline]
            fn filled(value: T) -> Self {
                ($($name::filled(value),)*)
            }
            #[inline]
            fn zip_map(&self, other: &Self, f: impl Fn(T, T) -> T + Copy) -> Self {
                ($(self.$index.zip_map(&other.$index, f),)*)
            }
            #[inline]
            fn lane(&self, lane: usize) -> Self::Lane {
                ($(self.$index.lane(lane),)*)
            }
            #[inline]
            fn set_lane(&mut self, lane: usize, value: &Self::Lane) {
                $(self.$index.set_lane(lane, &value.$index);)*
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

/// Lanes, at most.
pub(crate) const MOST_LANES: usize = 16;

/// The result of a function in each lane; `nothing` if it fails there. If all fail, the error is that of the first that
/// is not merely NaN.
#[inline]
pub(crate) fn each_lane<T: Scalar, V: Copy>(
    nothing: V,
    mut value: impl FnMut(usize) -> Result<V, Error>,
) -> Result<[V; MOST_LANES], Error> {
    let (mut all, mut first, mut some) = ([nothing; MOST_LANES], None, false);
    for (lane, place) in all.iter_mut().enumerate().take(T::LANES) {
        match value(lane) {
            Ok(found) => (*place, some) = (found, true),
            // lanes that have failed before are NaN, and say nothing new
            Err(Error::NotFinite { .. }) if first.is_some() => {}
            Err(error) if matches!(first, None | Some(Error::NotFinite { .. })) => first = Some(error),
            Err(_) => {}
        }
    }
    match first {
        Some(error) if !some => Err(error),
        _ => Ok(all),
    }
}

#[cfg(test)]
mod tests;
