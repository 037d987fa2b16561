//! Values from the numbers that C gives.

use clebsch::{Clebsch, Clock, Error, Method, Scalar, Space, State, Stepper};
use nalgebra::{Quaternion, SMatrix};

/// The number types that C has too.
///
/// ```
/// use clebsch_c::Real;
///
/// assert_eq!((f64::NAME, f32::NAME), ("double", "float"));
/// ```
pub trait Real: clebsch::Real {
    /// The name of the type in C.
    const NAME: &'static str;
}

impl Real for f64 {
    const NAME: &'static str = "double";
}

impl Real for f32 {
    const NAME: &'static str = "float";
}

/// Values that are made of numbers in the order of their [`Columns`](clebsch::Columns).
///
/// ```
/// use clebsch_c::Plain;
/// use nalgebra::{Matrix2, Vector2};
///
/// let numbers = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
/// let pair = <(Matrix2<f64>, Vector2<f64>)>::read(&mut numbers.into_iter());
/// assert_eq!(pair, Some((Matrix2::new(1.0, 2.0, 3.0, 4.0), Vector2::new(5.0, 6.0))));
/// ```
pub trait Plain<T: Scalar>: Space<T> {
    /// The value of the next numbers; `None` if there are too few.
    fn read(numbers: &mut impl Iterator<Item = T>) -> Option<Self>;
}

impl Plain<f64> for f64 {
    fn read(numbers: &mut impl Iterator<Item = f64>) -> Option<Self> {
        numbers.next()
    }
}

impl Plain<f32> for f32 {
    fn read(numbers: &mut impl Iterator<Item = f32>) -> Option<Self> {
        numbers.next()
    }
}

impl<T: Real, const R: usize, const C: usize> Plain<T> for SMatrix<T, R, C> {
    fn read(numbers: &mut impl Iterator<Item = T>) -> Option<Self> {
        let mut matrix = Self::origin();
        for row in 0..R {
            for column in 0..C {
                *matrix.get_mut((row, column))? = numbers.next()?;
            }
        }
        Some(matrix)
    }
}

impl<T: Real> Plain<T> for Quaternion<T> {
    fn read(numbers: &mut impl Iterator<Item = T>) -> Option<Self> {
        let [w, i, j, k] = <[SMatrix<T, 1, 1>; 4]>::read(numbers)?.map(|number| number.x);
        Some(Quaternion::from(SMatrix::<T, 4, 1>::from([i, j, k, w])))
    }
}

impl<T: Scalar, V: Plain<T>, const N: usize> Plain<T> for [V; N] {
    fn read(numbers: &mut impl Iterator<Item = T>) -> Option<Self> {
        let mut all = Self::origin();
        for value in &mut all {
            *value = V::read(numbers)?;
        }
        Some(all)
    }
}

macro_rules! tuple {
    ($($name:ident),*) => {
        impl<T: Scalar, $($name: Plain<T>),*> Plain<T> for ($($name,)*) {
            #[allow(unused_variables, reason = "the tuple without parts")]
            fn read(numbers: &mut impl Iterator<Item = T>) -> Option<Self> {
                Some(($($name::read(numbers)?,)*))
            }
        }
    };
}

tuple!();
tuple!(A);
tuple!(A, B);
tuple!(A, B, C);
tuple!(A, B, C, D);
tuple!(A, B, C, D, E);
tuple!(A, B, C, D, E, F);
tuple!(A, B, C, D, E, F, G);
tuple!(A, B, C, D, E, F, G, H);

/// The two kinds of times, as the numbers of a state have them: none, or one in front.
pub trait AtTime<S: Clebsch> {
    /// Whether a state has a time.
    const IS_TIMED: bool;

    /// The state at a time.
    ///
    /// # Errors
    /// Those of [`Stepper::state`].
    fn state<M: Method<S>>(
        stepper: &Stepper<S, M>,
        t: S::Scalar,
        q: S::Configuration,
        mu: S::Momentum,
    ) -> Result<State<S, M>, Error>;

    /// The time of a state, if it has one.
    fn time<M: Method<S>>(state: &State<S, M>) -> Option<S::Scalar>;
}

impl<S: Clebsch<Time = ()>> AtTime<S> for () {
    const IS_TIMED: bool = false;

    fn state<M: Method<S>>(
        stepper: &Stepper<S, M>,
        _: S::Scalar,
        q: S::Configuration,
        mu: S::Momentum,
    ) -> Result<State<S, M>, Error> {
        stepper.state(q, mu)
    }

    fn time<M: Method<S>>(_: &State<S, M>) -> Option<S::Scalar> {
        None
    }
}

impl<T: Real, S: Clebsch<Scalar = T, Time = Clock<T>>> AtTime<S> for Clock<T> {
    const IS_TIMED: bool = true;

    fn state<M: Method<S>>(
        stepper: &Stepper<S, M>,
        t: T,
        q: S::Configuration,
        mu: S::Momentum,
    ) -> Result<State<S, M>, Error> {
        stepper.state_at(t, q, mu)
    }

    fn time<M: Method<S>>(state: &State<S, M>) -> Option<T> {
        Some(state.time())
    }
}
