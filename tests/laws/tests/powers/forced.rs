//! Forces and composed steps of a power of 1 to 5 sites, next to the same declaration with the number, in `f64` and `f32`.
//!
//! Without the feature `heavy` these are 1 and 3 sites in steps of up to order 4, and `f32` at one order alone.

use clebsch::{Clebsch, Scalar};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, SVector, Vector1, Vector3};

/// A number as its bits, in `f64`.
trait Bits: Scalar + nalgebra::Scalar {
    fn wide(self) -> f64;
}
impl Bits for f64 {
    fn wide(self) -> f64 {
        self
    }
}
impl Bits for f32 {
    fn wide(self) -> f64 {
        f64::from(self)
    }
}

/// Bodies that turn under torques of their own, in a wind that changes, with friction that differs. The attitudes of neighbours are coupled.
macro_rules! tied {
    ($name:ident, [$($generics:tt)*], $n:tt, $order:tt) => {
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action     = |F: [SO<3>; $n], R: [SO<3>; $n]| (0..$n).map(|i| R[i] * F[i]),
            lagrangian = |omega| (0..$n).map(|i| omega[i].dot(&(self.inertia * omega[i])) / 2).sum(),
            potential  = |R| -(0..$n).map(|i| (R[i].transpose() * R[(i + 1) % $n] * self.coupling).trace()).sum(),
            force      = |t, R, omega, torque: [Vector3; $n]| (0..$n).map(|i| {
                torque[i] + R[i].transpose() * self.wind * t.cos() - self.friction[i] * omega[i]
            }),
            order      = $order,
        )]
        pub struct $name<$($generics)*> {
            #[clebsch(symmetric)]
            pub inertia: Matrix3<T>,
            pub coupling: Matrix3<T>,
            pub wind: Vector3<T>,
            pub friction: [T; $n],
        }
    };
}

/// The declaration for any number of sites, and that with each number.
macro_rules! counted {
    ($module:ident, $declare:ident, $order:tt) => {
        mod $module {
            use super::*;
            $declare!(Looped, [T, const N: usize], N, $order);
            counted!(@ $declare, $order, one: One 1, three: Three 3);
            #[cfg(feature = "heavy")]
            counted!(@ $declare, $order, two: Two 2, four: Four 4, five: Five 5);
        }
    };
    (@ $declare:ident, $order:tt, $($test:ident: $name:ident $n:tt),*) => { $(
        $declare!($name, [T], $n, $order);

        /// The largest difference after 20 steps, as a part of the largest number.
        pub fn $test<T: Bits>(seed: u64) -> f64 {
            let mut random = Random::new(seed);
            let number = |x: f64| T::from_f64(x);
            let inertia = random.inertia::<3>().map(number);
            let (coupling, wind) = (random.matrix::<3, 3>().map(number), random.vector::<3>().map(number));
            let friction = std::array::from_fn(|_| number(random.between(0.0, 0.5)));
            let looped = Looped::<T, $n> { inertia, coupling, wind, friction };
            let unrolled = $name::<T> { inertia, coupling, wind, friction };
            let q: [Matrix3<T>; $n] = std::array::from_fn(|_| random.attitude::<3>().map(number));
            let mu: [Vector3<T>; $n] = std::array::from_fn(|_| random.vector::<3>().map(number));
            let torques: [Vector3<T>; $n] = std::array::from_fn(|_| random.vector::<3>().map(number));
            let h = number(0.05);
            let (a, b) = (looped.into_stepper(h).unwrap(), unrolled.into_stepper(h).unwrap());
            let joined = SVector::<T, { 3 * $n }>::from_fn(|k, _| mu[k / 3][k % 3]);
            let (mut x, mut y) = (a.state(q, mu).unwrap(), b.state(q, joined).unwrap());
            for _ in 0..20 {
                x = a.step_with(&x, &torques).unwrap();
                y = b.step_with(&y, &torques).unwrap();
            }
            let (mine, theirs) = (x.momentum(), y.momentum());
            let mine = x.configuration().iter().flatten().chain(mine.iter().flatten()).map(|x| x.wide());
            let theirs = y.configuration().iter().flatten().chain(&theirs).map(|x| x.wide());
            assert!((x.configuration()[0] - q[0]).iter().any(|x| x.wide().abs() > 1e-2), "it moves");
            mine.zip(theirs).map(|(a, b)| (a - b).abs() / (1.0 + a.abs())).fold(0.0, f64::max)
        }
    )* };
}

counted!(first_order, tied, 1);
counted!(second_order, tied, 2);
counted!(fourth_order, tied, 4);
#[cfg(feature = "heavy")]
counted!(sixth_order, tied, 6);

/// The largest of the differences for numbers of sites, of five random systems each.
macro_rules! largest {
    ($scalar:ty, [$($module:ident)*] $sites:tt) => { 0.0_f64$(.max(largest!(@ $scalar, $module $sites)))* };
    (@ $scalar:ty, $module:ident [$($sites:ident)*]) => {
        (0..5_u64).flat_map(|seed| [$($module::$sites::<$scalar>(seed)),*]).fold(0.0, f64::max)
    };
}

/// Unrolled code shares terms among sites, and multiplies gradients with h at once. It differs by rounding, 20 steps of at most 11 stages.
#[test]
fn tied_sites_differ_by_rounding() {
    let in_double = largest!(f64, [first_order second_order fourth_order] [one three]);
    let in_single = largest!(f32, [fourth_order] [one three]);
    #[cfg(feature = "heavy")]
    let in_double = in_double
        .max(largest!(f64, [sixth_order] [one three]))
        .max(largest!(f64, [first_order second_order fourth_order sixth_order] [two four five]));
    #[cfg(feature = "heavy")]
    let in_single = in_single
        .max(largest!(f32, [first_order second_order sixth_order] [one two three four five]))
        .max(largest!(f32, [fourth_order] [two four five]));
    assert!(in_double < 200.0 * f64::EPSILON, "{in_double:e}");
    assert!(in_single < 200.0 * f64::from(f32::EPSILON), "{in_single:e}");
}

/// Beads that are pulled to the origin, and by a current.
macro_rules! beads {
    ($name:ident, [$($generics:tt)*], $n:tt, $order:tt) => {
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action     = |a: [Translation<1>; $n], x: [Vector1; $n]| (0..$n).map(|i| x[i] + a[i]),
            lagrangian = |v| (0..$n).map(|i| v[i].norm_squared()).sum() / 2,
            force_on   = |x, v, current: [Vector1; $n]| (0..$n).map(|i| current[i] - self.friction * v[i] - self.stiffness * x[i]),
            order      = $order,
        )]
        pub struct $name<$($generics)*> {
            pub stiffness: T,
            pub friction: T,
        }
    };
}

/// The numbers after 50 steps by the power and by the declaration with each number.
macro_rules! beads_of_order {
    ($module:ident, $order:tt) => {
        mod $module {
            use super::*;
            beads!(Looped, [T, const N: usize], N, $order);
            beads_of_order!(@ $order, one: One 1, three: Three 3);
            #[cfg(feature = "heavy")]
            beads_of_order!(@ $order, two: Two 2, four: Four 4, five: Five 5);
        }
    };
    (@ $order:tt, $($test:ident: $name:ident $n:tt),*) => { $(
        beads!($name, [T], $n, $order);

        pub fn $test<T: Bits>() {
            let number = |x: f64| T::from_f64(x);
            let [stiffness, friction, h] = [1.3, 0.4, 0.07].map(number);
            let (a, b) = (Looped::<T, $n> { stiffness, friction }, $name::<T> { stiffness, friction });
            let (a, b) = (a.into_stepper(h).unwrap(), b.into_stepper(h).unwrap());
            let q: [Vector1<T>; $n] = std::array::from_fn(|i| Vector1::new(number((i as f64 + 0.4).sin())));
            let mu: [Vector1<T>; $n] = std::array::from_fn(|i| Vector1::new(number((i as f64 + 0.4).cos())));
            let joined = SVector::<T, $n>::from_fn(|k, _| mu[k].x);
            let (mut x, mut y) = (a.state(q, mu).unwrap(), b.state(q, joined).unwrap());
            let current = std::array::from_fn(|i| Vector1::new(number(0.3 - 0.1 * i as f64)));
            for step in 0..50 {
                x = a.step_with(&x, &current).unwrap();
                y = b.step_with(&y, &current).unwrap();
                assert_eq!(x.configuration(), y.configuration(), "{} sites, step {step}", $n);
                assert_eq!(x.momentum().map(|mu| mu.x)[..], y.momentum().as_slice()[..], "{} sites, step {step}", $n);
            }
        }
    )* };
}

beads_of_order!(beads_of_order_1, 1);
beads_of_order!(beads_of_order_2, 2);
beads_of_order!(beads_of_order_4, 4);
#[cfg(feature = "heavy")]
beads_of_order!(beads_of_order_8, 8);

/// Where there is one way to write a site, power and unrolled code have the same bits.
#[test]
fn beads_have_the_same_bits() {
    macro_rules! all {
        ($scalar:ty, [$($module:ident)*] $sites:tt) => { $(all!(@ $scalar, $module $sites);)* };
        (@ $scalar:ty, $module:ident [$($sites:ident)*]) => { $($module::$sites::<$scalar>();)* };
    }
    all!(f64, [beads_of_order_1 beads_of_order_2 beads_of_order_4] [one three]);
    all!(f32, [beads_of_order_2] [one three]);
    #[cfg(feature = "heavy")]
    {
        all!(f64, [beads_of_order_8] [one three]);
        all!(f64, [beads_of_order_1 beads_of_order_2 beads_of_order_4 beads_of_order_8] [two four five]);
        all!(f32, [beads_of_order_1 beads_of_order_4 beads_of_order_8] [one two three four five]);
        all!(f32, [beads_of_order_2] [two four five]);
    }
}
