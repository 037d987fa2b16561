//! The groups of the language, but SU(3), which `clebsch-tests --test unitary` takes: its steps are long without optimisation.

use clebsch::Clebsch;
use clebsch_tests::oracle::precise::group;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::on_itself::{Kind, Kinetic, OnItself};
use clebsch_tests::oracle::random::Random;
use nalgebra::SMatrix;

use crate::checks;

// U(1) is SO(2), so SO(n) begins at 3.
// each family in its least size, and where the Cayley map leaves the group, its projection makes long formulas: `projection` stands for it on Sim(n)
groups! {
    so3:         [SO<3>],         3, 3,  cayley,     group::so(3);
    so12:        [SO<1, 2>],      3, 3,  cayley,     group::pseudo_so(1, 2);
    se2:         [SE<2>],         3, 3,  cayley,     group::se(2);
    sim2:        [Sim<2>],        3, 4,  projection, group::sim(2);
    gl2:         [GL<2>],         2, 4,  cayley,     group::gl(2);
    aff1:        [Aff<1>],        2, 2,  cayley,     group::aff(1);
    sl2:         [SL<2>],         2, 3,  cayley,     group::sl(2);
    sp2:         [Sp<2>],         2, 3,  cayley,     group::sp(2);
    u1:          [U<1>],          2, 1,  cayley,     group::u(1);
    heisenberg1: [Heisenberg<1>], 3, 3,  cayley,     group::heisenberg(1);
}

// others of the same families
#[cfg(feature = "heavy")]
groups! {
    so2:         [SO<2>],         2, 1,  cayley,     group::so(2);
    so4:         [SO<4>],         4, 6,  cayley,     group::so(4);
    so5:         [SO<5>],         5, 10, cayley,     group::so(5);
    so13:        [SO<1, 3>],      4, 6,  cayley,     group::pseudo_so(1, 3);
    se3:         [SE<3>],         4, 6,  cayley,     group::se(3);
    sim3:        [Sim<3>],        4, 7,  projection, group::sim(3);
    gl3:         [GL<3>],         3, 9,  cayley,     group::gl(3);
    aff2:        [Aff<2>],        3, 6,  cayley,     group::aff(2);
    sl3:         [SL<3>],         3, 8,  cayley,     group::sl(3);
    sp4:         [Sp<4>],         4, 10, cayley,     group::sp(4);
    u2:          [U<2>],          4, 4,  cayley,     group::u(2);
    heisenberg2: [Heisenberg<2>], 4, 5,  cayley,     group::heisenberg(2);
}

/// Translations, whose elements are vectors.
mod translation3 {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    macro_rules! shifts {
        ($name:ident, $($kinetic:tt)*) => {
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action    = |a: Translation<3>, x: Vector3| x + a,
                potential = |x| self.linear.dot(&x) + self.cubic.dot(&x).powi(3) / 3,
                $($kinetic)*
            )]
            pub struct $name {
                pub mass: Matrix3<f64>,
                pub linear: Vector3<f64>,
                pub cubic: Vector3<f64>,
            }
        };
    }
    shifts!(Right, cost = |h, a| a.dot(&(self.mass * a)) / (2 * h));
    shifts!(Continuous, lagrangian = |v| v.dot(&(self.mass * v)) / 2);
    shifts!(Exponential, lagrangian = |v| v.dot(&(self.mass * v)) / 2, discretization = exponential);

    /// x ↦ x − a is an action too, and the left one of −a.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action    = |a: Translation<3>, x: Vector3| x + a,
        cost      = |h, a| (-a).dot(&(self.mass * (-a))) / (2 * h),
        potential = |x| self.linear.dot(&(-x)) + self.cubic.dot(&(-x)).powi(3) / 3,
    )]
    pub struct Left {
        pub mass: Matrix3<f64>,
        pub linear: Vector3<f64>,
        pub cubic: Vector3<f64>,
    }

    macro_rules! made {
        ($function:ident, $name:ident, $kinetic:expr) => {
            fn $function(random: &mut Random, size: f64) -> ($name, OnItself) {
                let (mass, linear, cubic) = (random.inertia::<3>(), random.vector::<3>() * size, random.vector::<3>());
                let problem = OnItself {
                    group: group::translation(3),
                    kind: Kind::Vector,
                    kinetic: $kinetic(Matrix::from(&mass)),
                    linear: Matrix::from(&linear),
                    cubic: Matrix::from(&(cubic * size)),
                };
                ($name { mass, linear, cubic: cubic * size }, problem)
            }
        };
    }
    made!(right, Right, Kinetic::Chord);
    made!(continuous, Continuous, Kinetic::Cayley);
    made!(exponential, Exponential, Kinetic::Exponential);
    checked!(|right: &Right| Left { mass: right.mass, linear: right.linear, cubic: right.cubic });
}

/// SU(2), whose elements are quaternions.
mod su2 {
    use super::*;
    use nalgebra::{Matrix3, Vector4};

    macro_rules! turns {
        ($name:ident, $($kinetic:tt)*) => {
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action    = |F: SU<2>, Q: SU<2>| Q * F,
                potential = |Q| {
                    let along = self.cubic.xyz().dot(&Q.imag()) + self.cubic.w * Q.scalar();
                    self.linear.xyz().dot(&Q.imag()) + self.linear.w * Q.scalar() + along.powi(3) / 3
                },
                $($kinetic)*
            )]
            pub struct $name {
                pub inertia: Matrix3<f64>,
                pub linear: Vector4<f64>,
                pub cubic: Vector4<f64>,
            }
        };
    }
    turns!(Right, cost = |h, F| 2 * F.imag().dot(&(self.inertia * F.imag())) / h);
    turns!(Continuous, lagrangian = |xi| xi.dot(&(self.inertia * xi)) / 2);
    turns!(Exponential, lagrangian = |xi| xi.dot(&(self.inertia * xi)) / 2, discretization = exponential);

    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action    = |F: SU<2>, Q: SU<2>| F * Q,
        cost      = |h, F| 2 * F.imag().dot(&(self.inertia * F.imag())) / h,
        potential = |Q| {
            let back = Q.conjugate();
            let along = self.cubic.xyz().dot(&back.imag()) + self.cubic.w * back.scalar();
            self.linear.xyz().dot(&back.imag()) + self.linear.w * back.scalar() + along.powi(3) / 3
        },
    )]
    pub struct Left {
        pub inertia: Matrix3<f64>,
        pub linear: Vector4<f64>,
        pub cubic: Vector4<f64>,
    }

    macro_rules! made {
        ($function:ident, $name:ident, $kinetic:expr) => {
            fn $function(random: &mut Random, size: f64) -> ($name, OnItself) {
                let (inertia, linear, cubic) =
                    (random.inertia::<3>(), random.vector::<4>() * size, random.vector::<4>());
                let problem = OnItself {
                    group: group::unit_quaternions(),
                    kind: Kind::Quaternion,
                    kinetic: $kinetic(Matrix::from(&inertia)),
                    linear: Matrix::from(&linear),
                    cubic: Matrix::from(&(cubic * size)),
                };
                ($name { inertia, linear, cubic: cubic * size }, problem)
            }
        };
    }
    made!(right, Right, Kinetic::Chord);
    made!(continuous, Continuous, Kinetic::Cayley);
    made!(exponential, Exponential, Kinetic::Exponential);
    checked!(|right: &Right| Left { inertia: right.inertia, linear: right.linear, cubic: right.cubic });
}
