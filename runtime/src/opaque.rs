//! Opaque potentials: whether a gradient method belongs to a value method.

use crate::space::larger;
use crate::{Error, Scalar};
use num_traits::One;

/// Checks one entry of a gradient against differences of the value along it.
///
/// The difference is Richardson's, (8(f₊ − f₋) − (f₊₊ − f₋₋))/12δ, δ = ε^{1/5} max(1, |x|), of the error ε^{4/5}; ε^{2/5} of the terms is accepted.
///
/// # Errors
/// [`Error::WrongGradient`]; [`Error::NotFinite`] where the value or the gradient is not.
pub fn check_slope<T: Scalar>(value: impl Fn(T) -> T, x: T, slope: T, entry: usize) -> Result<(), Error> {
    (0..T::LANES).try_for_each(|lane| {
        let value = |x| value(T::from_lanes(|_| x)).lane(lane);
        let (x, slope) = (x.lane(lane), slope.lane(lane));
        let size = larger(T::Lane::one(), x.abs());
        let delta = T::Lane::EPSILON.powf(T::Lane::from_ratio(1, 5)) * size;
        let near = value(x + delta) - value(x - delta);
        let far = value(x + delta + delta) - value(x - delta - delta);
        let difference = (T::Lane::from_f64(8.0) * near - far) / (T::Lane::from_f64(12.0) * delta);
        if !(difference.is_finite() && slope.is_finite()) {
            return Err(Error::NotFinite { name: "the potential or its gradient" });
        }
        let scale = slope.abs() + difference.abs() + value(x).abs() / size;
        if (slope - difference).abs() <= T::Lane::EPSILON.powf(T::Lane::from_ratio(2, 5)) * scale {
            return Ok(());
        }
        Err(Error::WrongGradient { entry, gradient: slope.to_f64(), difference: difference.to_f64() })
    })
}

#[cfg(test)]
mod tests;
