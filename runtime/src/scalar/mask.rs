//! What comparisons answer.

use core::fmt::Debug;
use core::ops::{BitAnd, BitOr, BitXor, Not};

/// One truth value for each lane: `bool` for a single number.
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self>
{
    /// True in the lanes whose bit is set, of which lane 0 has the lowest.
    fn from_bits(bits: u16) -> Self;
    /// One bit for each lane, that of lane 0 the lowest.
    fn bits(self) -> u16;
    /// Whether some lane is true.
    fn any(self) -> bool;
    /// Whether all lanes are true.
    fn all(self) -> bool;

    /// Whether there is a lane `lane`, and it is true.
    #[inline]
    fn lane(self, lane: usize) -> bool {
        lane < 16 && self.bits() >> lane & 1 == 1
    }

    /// True in all lanes.
    #[inline]
    fn everywhere() -> Self {
        Self::from_bits(u16::MAX)
    }

    /// True in no lane.
    #[inline]
    fn nowhere() -> Self {
        Self::from_bits(0)
    }
}

impl Mask for bool {
    #[inline]
    fn from_bits(bits: u16) -> Self {
        bits & 1 == 1
    }
    #[inline]
    fn bits(self) -> u16 {
        self.into()
    }
    #[inline]
    fn any(self) -> bool {
        self
    }
    #[inline]
    fn all(self) -> bool {
        self
    }
}
