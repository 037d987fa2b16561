//! Several numbers side by side, in the lanes of vector registers: one body in each.
//!
//! In each lane, every operation gives the bits that it gives for a single number. Sums, products, quotients and roots
//! are rounded as IEEE 754 says. Nothing is contracted or approximated. Functions without a vector form of that kind
//! are taken lane by lane.

use crate::{Mask, Scalar};
use core::fmt::{self, Display, Formatter};
use core::ops::{Add, AddAssign, BitAnd, BitOr, BitXor, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign};
use num_traits::{One, Zero};
use wide::{f32x8, f64x4, f64x8};

/// Operators of the vector that a type wraps: one of a single number, binary ones, and those that assign.
macro_rules! operators {
    ($type:ident; $unary:ident $unary_method:ident, $($trait:ident $method:ident $($assign:ident $assign_method:ident)?),*) => {
        impl $unary for $type {
            type Output = Self;

            #[inline]
            fn $unary_method(self) -> Self {
                Self($unary::$unary_method(self.0))
            }
        }
        $(
        impl $trait for $type {
            type Output = Self;

            #[inline]
            fn $method(self, other: Self) -> Self {
                Self($trait::$method(self.0, other.0))
            }
        }

        $(impl $assign for $type {
            #[inline]
            fn $assign_method(&mut self, other: Self) {
                self.0 = $trait::$method(self.0, other.0);
            }
        })?
        )*
    };
}

/// Functions of a number, lane by lane.
macro_rules! elementary {
    ($number:ident; $($method:ident),*) => {$(
        #[inline]
        fn $method(self) -> Self {
            Self(self.0.to_array().map(<$number as Scalar>::$method).into())
        }
    )*};
}

/// Lanes that wrap a vector of `count` numbers, and their mask.
macro_rules! lanes {
    ($lanes:ident, $mask:ident, $vector:ident, $number:ident, $bits:ident, $count:literal) => {
        #[doc = concat!(stringify!($count), " numbers of type `", stringify!($number), "` side by side: the scalar of ", stringify!($count), " bodies that are stepped at once.")]
        ///
        /// Each lane has the bits of a single number. Registers are those of the target: `RUSTFLAGS="-C target-cpu=native"` for the machine's own.
        ///
        /// ```
        #[doc = concat!("use clebsch::{", stringify!($lanes), ", Scalar};")]
        ///
        #[doc = concat!("let numbers = ", stringify!($lanes), "::from_lanes(|lane| lane as ", stringify!($number), ");")]
        /// assert_eq!((numbers * numbers).sqrt(), numbers);
        /// assert_eq!(numbers.to_array()[3], 3.0);
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $lanes($vector);

        impl $lanes {
            /// The same number in all lanes.
            #[inline]
            pub const fn splat(value: $number) -> Self {
                Self($vector::new([value; $count]))
            }

            /// The numbers, that of lane 0 first.
            #[inline]
            pub fn to_array(self) -> [$number; $count] {
                self.0.to_array()
            }
        }

        impl From<[$number; $count]> for $lanes {
            #[inline]
            fn from(numbers: [$number; $count]) -> Self {
                Self($vector::new(numbers))
            }
        }

        /// As an array of its numbers.
        #[cfg(feature = "serde")]
        impl serde::Serialize for $lanes {
            fn serialize<W: serde::Serializer>(&self, writer: W) -> Result<W::Ok, W::Error> {
                self.to_array().serialize(writer)
            }
        }

        #[cfg(feature = "serde")]
        impl<'de> serde::Deserialize<'de> for $lanes {
            fn deserialize<R: serde::Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
                Ok(<[$number; $count]>::deserialize(reader)?.into())
            }
        }

        impl From<$number> for $lanes {
            #[inline]
            fn from(value: $number) -> Self {
                Self::splat(value)
            }
        }

        impl Display for $lanes {
            fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
                Display::fmt(&self.0, f)
            }
        }

        operators!($lanes; Neg neg, Add add AddAssign add_assign, Sub sub SubAssign sub_assign,
                   Mul mul MulAssign mul_assign, Div div DivAssign div_assign);

        impl Zero for $lanes {
            #[inline]
            fn zero() -> Self {
                Self::splat(0.0)
            }
            #[inline]
            fn is_zero(&self) -> bool {
                *self == Self::zero()
            }
        }

        impl One for $lanes {
            #[inline]
            fn one() -> Self {
                Self::splat(1.0)
            }
        }

        #[doc = concat!("A truth value for each lane of [`", stringify!($lanes), "`].")]
        ///
        /// ```
        #[doc = concat!("use clebsch::{", stringify!($lanes), ", Mask, Scalar};")]
        ///
        #[doc = concat!("let numbers = ", stringify!($lanes), "::from_lanes(|lane| lane as ", stringify!($number), ");")]
        #[doc = concat!("let small = numbers.below(", stringify!($lanes), "::splat(2.0));")]
        /// assert_eq!(small.bits(), 0b11); // lanes 0 and 1
        /// ```
        #[derive(Clone, Copy, Debug)]
        pub struct $mask($vector);

        operators!($mask; Not not, BitAnd bitand, BitOr bitor, BitXor bitxor);

        impl Mask for $mask {
            #[inline]
            fn from_bits(bits: u16) -> Self {
                let lane = |lane| if bits >> lane & 1 == 1 { $bits::MAX } else { 0 };
                Self($vector::new(core::array::from_fn(|i| $number::from_bits(lane(i)))))
            }
            #[inline]
            fn bits(self) -> u16 {
                self.0.to_bitmask() as u16
            }
            #[inline]
            fn any(self) -> bool {
                self.0.any()
            }
            #[inline]
            fn all(self) -> bool {
                self.0.all()
            }
        }

        impl Scalar for $lanes {
            type Lane = $number;
            type Mask = $mask;
            const LANES: usize = $count;
            const EPSILON: Self = Self::splat($number::EPSILON);
            const PI: Self = Self::splat(core::$number::consts::PI);

            #[inline]
            fn from_ratio(numerator: i64, denominator: i64) -> Self {
                Self::splat(<$number as Scalar>::from_ratio(numerator, denominator))
            }
            #[inline]
            fn from_f64(value: f64) -> Self {
                Self::splat(<$number as Scalar>::from_f64(value))
            }
            #[inline]
            fn to_f64(self) -> f64 {
                Scalar::lane(self, 0).into()
            }
            #[inline]
            fn is_finite(self) -> bool {
                self.finite().all()
            }

            #[inline]
            fn lane(self, lane: usize) -> $number {
                self.0.as_array().get(lane).copied().unwrap_or($number::NAN)
            }
            #[inline]
            fn from_lanes(value: impl FnMut(usize) -> $number) -> Self {
                Self($vector::new(core::array::from_fn(value)))
            }
            #[inline]
            fn below(self, other: Self) -> $mask {
                $mask(self.0.simd_lt(other.0))
            }
            #[inline]
            fn at_most(self, other: Self) -> $mask {
                $mask(self.0.simd_le(other.0))
            }
            #[inline]
            fn equals(self, other: Self) -> $mask {
                $mask(self.0.simd_eq(other.0))
            }
            #[inline]
            fn select(mask: $mask, yes: Self, no: Self) -> Self {
                Self(mask.0.select(yes.0, no.0))
            }
            #[inline]
            fn finite(self) -> $mask {
                (self - self).equals(Self::zero())
            }

            #[inline]
            fn abs(self) -> Self {
                Self(self.0.abs())
            }
            #[inline]
            fn sqrt(self) -> Self {
                Self(self.0.sqrt())
            }
            #[inline]
            fn powf(self, exponent: Self) -> Self {
                Self::from_lanes(|i| Scalar::powf(Scalar::lane(self, i), Scalar::lane(exponent, i)))
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                let both = self.0.to_array().map(<$number as Scalar>::sin_cos);
                (Self(both.map(|(sine, _)| sine).into()), Self(both.map(|(_, cosine)| cosine).into()))
            }
            elementary!($number; sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, ln);
        }
    };
}

lanes!(F64x4, F64x4Mask, f64x4, f64, u64, 4);
lanes!(F64x8, F64x8Mask, f64x8, f64, u64, 8);
lanes!(F32x8, F32x8Mask, f32x8, f32, u32, 8);

#[cfg(test)]
mod tests;
