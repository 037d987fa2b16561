//! Declarations, each with a const generic and with a number.

use clebsch::Clebsch;
use clebsch_tests::oracle::random::Random;
use nalgebra::*;

use crate::checks;

/// One declaration twice: `$power` for any number of sites, `$fixed` for 4.
macro_rules! twice {
    ($check:ident, $declare:ident, $start:expr) => {
        mod $check {
            use super::*;
            $declare!(Looped, [<const N: usize>], N);
            $declare!(Unrolled, [], 4);

            #[test]
            fn looped_and_unrolled_code_agree() {
                for seed in 0..5 {
                    let random = &mut Random::new(seed);
                    let (looped, unrolled, q, mu) = $start(random);
                    checks::agree(&looped, &unrolled, q, mu, random);
                }
            }

            #[test]
            fn storage_does_not_matter() {
                let (looped, _, q, mu) = $start(&mut Random::new(7));
                checks::storage_does_not_matter(&looped, q, mu);
            }
        }
    };
}

macro_rules! ring {
    ($name:ident, [$($generics:tt)*], $n:tt) => {
        /// A ring of spins in a field.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action    = |F: [SO<3>; $n], q: [Unit<Vector3>; $n]| (0..$n).map(|i| F[i] * q[i]),
            cost      = |h, F| (0..$n).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
            potential = |q| (0..$n).map(|i| -self.exchange * q[i].dot(&q[(i + 1) % $n]) - self.field.dot(&q[i])).sum(),
        )]
        pub struct $name $($generics)* {
            pub exchange: f64,
            pub field: Vector3<f64>,
        }
    };
}
twice!(ring_of_spins, ring, |random: &mut Random| {
    let (exchange, field) = (random.number(), random.vector());
    let (q, mu) = spins(random);
    (Looped::<4> { exchange, field }, Unrolled { exchange, field }, q, mu)
});

/// Points of S² with momenta across.
fn spins(random: &mut Random) -> ([Vector3<f64>; 4], [Vector3<f64>; 4]) {
    let q: [Vector3<f64>; 4] = std::array::from_fn(|_| random.unit());
    (q, q.map(|q| q.cross(&random.vector())))
}

macro_rules! chain {
    ($name:ident, [$($generics:tt)*], $n:tt) => {
        /// An open chain with ends of their own, a next neighbour and one beyond. Each site has its own field, in the
        /// steps of first order.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action    = |F: [SO<3>; $n], q: [Unit<Vector3>; $n]| (0..$n).map(|k| F[k] * q[k]),
            cost      = |h, F| self.mass * (0..$n).map(|i| (F[i] - I).norm_squared()).sum() / (4 * h),
            potential = |t, q| {
                let next = (0..$n - 1).map(|i| (q[i + 1] - q[i]).norm_squared() / 2).sum();
                let beyond = (2..$n).map(|i| q[i].dot(&q[i - 2])).sum() * self.second;
                let own = (0..$n).map(|i| self.field[i].dot(&q[i]) * (i + 1) * t.cos()).sum();
                next * self.first - beyond + own / 2 + self.pinned.dot(&q[0]) - q[$n - 1].x * q[0].y
            },
            order     = 1,
        )]
        pub struct $name $($generics)* {
            pub mass: f64,
            pub first: f64,
            pub second: f64,
            pub field: [Vector3<f64>; $n],
            #[clebsch(unit)]
            pub pinned: Vector3<f64>,
        }
    };
}
twice!(open_chain, chain, |random: &mut Random| {
    let (mass, first, second) = (random.between(0.5, 2.0), random.number(), random.number());
    let (field, pinned): ([Vector3<f64>; 4], _) = (std::array::from_fn(|_| random.vector()), random.unit());
    let (q, mu) = spins(random);
    (Looped::<4> { mass, first, second, field, pinned }, Unrolled { mass, first, second, field, pinned }, q, mu)
});

macro_rules! glass {
    ($name:ident, [$($generics:tt)*], $n:tt) => {
        /// A ring whose couplings differ, to the second neighbour, each stronger than that before; the entry of the field is that of another site.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action    = |F: [SO<3>; $n], q: [Unit<Vector3>; $n]| (0..$n).map(|i| F[i] * q[i]),
            cost      = |h, F| (0..$n).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
            potential = |q| (0..$n).map(|i| (i + 1) * self.coupling[(i + 1) % $n] * q[i].dot(&q[(i + 2) % $n]).powi(2)).sum()
                - (0..$n).map(|i| self.field.dot(&q[i])).sum(),
        )]
        pub struct $name $($generics)* {
            pub coupling: [f64; $n],
            pub field: Vector3<f64>,
        }
    };
}
twice!(spin_glass, glass, |random: &mut Random| {
    let (coupling, field): ([f64; 4], _) = (std::array::from_fn(|_| random.number()), random.vector());
    let (q, mu) = spins(random);
    (Looped::<4> { coupling, field }, Unrolled { coupling, field }, q, mu)
});

macro_rules! bodies {
    ($name:ident, [$($generics:tt)*], $n:tt) => {
        /// Bodies that attract each other, each with its own mass: a sum over all pairs.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action    = |a: [Translation<3>; $n], x: [Vector3; $n]| (0..$n).map(|i| x[i] + a[i]),
            cost      = |h, a| (0..$n).map(|i| self.mass[i] * a[i].norm_squared()).sum() / (2 * h),
            potential = |x| (0..$n).map(|i| (i + 1..$n).map(|j| {
                -self.gravitation * self.mass[i] * self.mass[j] / (x[i] - x[j]).norm()
            }).sum()).sum(),
        )]
        pub struct $name $($generics)* {
            pub mass: [f64; $n],
            pub gravitation: f64,
        }
    };
}
twice!(attracting_bodies, bodies, |random: &mut Random| {
    let mass: [f64; 4] = std::array::from_fn(|_| random.between(0.5, 2.0));
    let q: [Vector3<f64>; 4] = std::array::from_fn(|i| random.vector() + Vector3::ith(i % 3, 3.0 * (i as f64 - 1.0)));
    let mu = std::array::from_fn(|_| random.vector());
    (Looped::<4> { mass, gravitation: 0.7 }, Unrolled { mass, gravitation: 0.7 }, q, mu)
});

macro_rules! rotors {
    ($name:ident, [$($generics:tt)*], $n:tt) => {
        /// Bodies whose attitudes are coupled: the momentum equation of each is implicit.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action     = |F: [SO<3>; $n], R: [SO<3>; $n]| (0..$n).map(|i| R[i] * F[i]),
            lagrangian = |omega| (0..$n).map(|i| omega[i].dot(&(self.inertia * omega[i])) / 2).sum(),
            potential  = |R| -(0..$n).map(|i| (R[i].transpose() * R[(i + 1) % $n] * self.coupling).trace()).sum(),
            tolerance  = 1e-13,
        )]
        pub struct $name $($generics)* {
            #[clebsch(symmetric)]
            pub inertia: Matrix3<f64>,
            pub coupling: Matrix3<f64>,
        }
    };
}
twice!(coupled_rotors, rotors, |random: &mut Random| {
    let (inertia, coupling) = (random.inertia(), random.matrix());
    let q: [Matrix3<f64>; 4] = std::array::from_fn(|_| random.rotation(1.0));
    let mu: [Vector3<f64>; 4] = std::array::from_fn(|_| random.vector());
    (Looped::<4> { inertia, coupling }, Unrolled { inertia, coupling }, q, mu)
});

macro_rules! molecules {
    ($name:ident, [$($generics:tt)*], $n:tt) => {
        /// Sites that are products: a place and an attitude by a quaternion.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action     = |g: [(Translation<3>, SU<2>); $n], q: [(Vector3, SU<2>); $n]| (0..$n).map(|i| (q[i].0 + g[i].0, q[i].1 * g[i].1)),
            cost       = |h, g| (0..$n).map(|i| {
                let turn = g[i].1.imag();
                (self.mass * g[i].0.norm_squared() + 4 * turn.dot(&(self.inertia * turn))) / (2 * h)
            }).sum(),
            potential  = |q| (0..$n).map(|i| (0..i).map(|j| {
                let (from, to) = (q[i].0 + q[i].1 * self.arm, q[j].0 - q[j].1 * self.arm);
                self.stiffness * (from - to).norm_squared() / 2
            }).sum()).sum(),
        )]
        pub struct $name $($generics)* {
            pub mass: f64,
            #[clebsch(symmetric)]
            pub inertia: Matrix3<f64>,
            pub arm: Vector3<f64>,
            pub stiffness: f64,
        }
    };
}
twice!(molecules_of_arms, molecules, |random: &mut Random| {
    let (mass, inertia, arm, stiffness) = (random.between(0.5, 2.0), random.inertia(), random.vector(), 0.3);
    let turn = |random: &mut Random| Quaternion::from(random.unit::<4>());
    let q: [(Vector3<f64>, Quaternion<f64>); 4] = std::array::from_fn(|_| (random.vector(), turn(random)));
    let mu: [Vector6<f64>; 4] = std::array::from_fn(|_| random.vector());
    (Looped::<4> { mass, inertia, arm, stiffness }, Unrolled { mass, inertia, arm, stiffness }, q, mu)
});

macro_rules! beams {
    ($name:ident, [$($generics:tt)*], $n:tt) => {
        /// A rod of rigid sections: each spring is known from the position and the attitude of a section in the frame of the one before.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action     = |F: [SE<3>; $n], q: [SE<3>; $n]| (0..$n).map(|i| q[i] * F[i]),
            lagrangian = |xi| (0..$n).map(|i| xi[i].dot(&(self.inertia * xi[i])) / 2).sum(),
            potential  = |q| (0..$n - 1).map(|i| {
                let section = q[i].inverse() * q[i + 1];
                self.stretch * (section.translation() - self.length * Vector3::x()).norm_squared() / 2 - self.bend * section.rotation().trace()
            }).sum() + (0..$n).map(|i| self.weight * q[i].translation().z).sum() + self.wall * (q[0].rotation().inverse() * q[0].translation()).x,
        )]
        pub struct $name $($generics)* {
            #[clebsch(symmetric)]
            pub inertia: Matrix6<f64>,
            pub stretch: f64,
            pub bend: f64,
            pub length: f64,
            pub weight: f64,
            pub wall: f64,
        }
    };
}
twice!(rod_of_sections, beams, |random: &mut Random| {
    let (inertia, stretch, bend, length) = (random.inertia(), random.number(), random.number(), random.number());
    let (weight, wall) = (random.number(), random.number());
    let place = |random: &mut Random| {
        let mut place = random.rotation::<3>(1.0).to_homogeneous();
        place.fixed_view_mut::<3, 1>(0, 3).copy_from(&random.vector::<3>());
        place
    };
    let q: [Matrix4<f64>; 4] = std::array::from_fn(|_| place(random));
    let mu: [Vector6<f64>; 4] = std::array::from_fn(|_| random.vector());
    let looped = Looped::<4> { inertia, stretch, bend, length, weight, wall };
    (looped, Unrolled { inertia, stretch, bend, length, weight, wall }, q, mu)
});

/// The compiler reports its choice: rings and chains gather, sums over pairs add up. Each of both stands in a test of
/// this file.
#[test]
fn gradients_are_gathered_where_few_terms_read_a_site() {
    const GATHERED: &str = "the gradient of a site is gathered from the terms that read it";
    const ADDED: &str = "the share of a term is added at each of its sites";
    for (derivation, chosen) in [
        (ring_of_spins::Looped::<4>::DERIVATION, GATHERED),
        (open_chain::Looped::<4>::DERIVATION, GATHERED),
        (spin_glass::Looped::<4>::DERIVATION, GATHERED),
        (attracting_bodies::Looped::<4>::DERIVATION, ADDED),
    ] {
        assert!(derivation.contains(chosen), "{derivation}");
    }
}
