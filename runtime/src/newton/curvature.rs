//! What is made of a Hessian that is not definite.

use super::Spectrum;
use crate::Real;
use crate::space::larger;

/// How a sweep takes the Hessian, and what it adds to its diagonal: multiples of a stiffness that path or plan have by themselves.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Curvature<T> {
    /// As it is: the critical point of the quadratic model. A small steadiness keeps directions without curvature from being left to round-off.
    Kept { steadiness: T },
    /// With eigenvalues of the wrong sign turned over, so that steps go downhill.
    Mirrored { damping: T, steadiness: T },
}

impl<T: Real> Curvature<T> {
    /// As it is, with nothing added.
    pub fn kept() -> Self {
        Self::Kept { steadiness: T::zero() }
    }

    /// As it is, but for √ε of the natural stiffness.
    pub fn steadied() -> Self {
        Self::Kept { steadiness: T::EPSILON.sqrt() }
    }

    /// Downhill, with this damping.
    pub fn mirrored(damping: T) -> Self {
        Self::Mirrored { damping, steadiness: T::zero() }
    }

    /// Whether steps go downhill.
    pub fn is_mirrored(self) -> bool {
        matches!(self, Self::Mirrored { .. })
    }

    /// Damping and steadiness.
    #[inline]
    pub fn added(self) -> (T, T) {
        match self {
            Self::Kept { steadiness } => (T::zero(), steadiness),
            Self::Mirrored { damping, steadiness } => (damping, steadiness),
        }
    }
}

/// What a mirrored eigenvalue is at least, relative to the largest: steps along a direction without curvature end somewhere.
const MIRRORED: f64 = 1e-4;

/// The size of an eigenvalue of the wrong sign once it is turned over.
pub(crate) fn turned_over<T: Real, const M: usize>(value: T, spectrum: &Spectrum<T, M>) -> T {
    larger(value.abs(), T::from_f64(MIRRORED) * spectrum.largest())
}

/// How much of a correction was made.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Share {
    /// All of it, at once.
    Whole,
    /// A part.
    Part,
    /// Next to nothing.
    Little,
}

/// The damping after a correction: eight times less after a whole one, eight times more after one of which little was made. Below `least` it is
/// none.
pub(crate) fn adapted<T: Real>(damping: T, least: T, made: Share) -> T {
    let factor = T::from_f64(8.0);
    match made {
        Share::Whole if damping > least => damping / factor,
        Share::Whole => T::zero(),
        Share::Part => damping,
        Share::Little => larger(damping, least) * factor,
    }
}

#[cfg(test)]
mod tests {
    use super::{Share, adapted};

    #[test]
    fn damping_comes_and_goes_by_factors_of_eight() {
        let once = adapted(0.0, 0.125, Share::Little);
        let twice = adapted(once, 0.125, Share::Little);
        assert_eq!((once, twice), (1.0, 8.0));
        assert_eq!(adapted(twice, 0.125, Share::Part), 8.0);
        assert_eq!(adapted(once, 0.125, Share::Whole), 0.125);
        assert_eq!(adapted(0.125, 0.125, Share::Whole), 0.0);
    }
}
