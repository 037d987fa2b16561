//! Signs of determinants, lane by lane.

use crate::{Mask, Scalar};
use core::ops::Mul;

/// The sign of the determinant of a matrix, in each lane in which the matrix is regular.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    /// The lanes with det > 0, one bit for each.
    positive: u16,
    /// The lanes with det < 0.
    negative: u16,
}

impl Mul for Orientation {
    type Output = Self;

    /// The sign of the product of two determinants.
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self {
            positive: self.positive & other.positive | self.negative & other.negative,
            negative: self.positive & other.negative | self.negative & other.positive,
        }
    }
}

impl Orientation {
    /// det > 0 of a single number.
    pub const POSITIVE: Self = Self { positive: 1, negative: 0 };
    /// det < 0 of a single number.
    pub const NEGATIVE: Self = Self { positive: 0, negative: 1 };

    /// From the lanes in which the matrix is regular, and those in which an odd number of signs was negative.
    #[inline]
    pub(crate) fn new<M: Mask>(regular: M, negative: M) -> Self {
        Self { positive: (regular & !negative).bits(), negative: (regular & negative).bits() }
    }

    /// The lanes in which the matrix is regular.
    #[inline]
    pub(crate) fn lanes<T: Scalar>(self) -> T::Mask {
        T::Mask::from_bits(self.positive | self.negative)
    }

    /// The sign in one lane.
    #[inline]
    pub(crate) fn lane(self, lane: usize) -> Self {
        Self { positive: self.positive >> lane & 1, negative: self.negative >> lane & 1 }
    }

    /// The lanes in which the sign is that of `other`.
    #[inline]
    pub(crate) fn agrees<T: Scalar>(self, other: Self) -> T::Mask {
        T::Mask::from_bits(self.positive & other.positive | self.negative & other.negative)
    }

    /// The sign here in the lanes of `mask`, that of `other` elsewhere.
    #[inline]
    pub(crate) fn or(self, mask: u16, other: Option<Self>) -> Self {
        let merge = |own, other| own & mask | other & !mask;
        let other = other.unwrap_or(Self { positive: 0, negative: 0 });
        Self { positive: merge(self.positive, other.positive), negative: merge(self.negative, other.negative) }
    }
}
