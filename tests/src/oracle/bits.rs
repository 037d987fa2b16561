//! Numbers bit for bit.

use clebsch::Scalar;

/// A number bit for bit.
pub trait Bits: Scalar {
    /// Its bits.
    fn bits(self) -> u64;
}

impl Bits for f64 {
    fn bits(self) -> u64 {
        self.to_bits()
    }
}

impl Bits for f32 {
    fn bits(self) -> u64 {
        self.to_bits().into()
    }
}
