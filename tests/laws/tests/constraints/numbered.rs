//! Chains, trees and rings whose number of sites is a number: against those of a const generic, and against unrolled code.

use clebsch::{Clebsch, Error};
use nalgebra::{Matrix3, Matrix4, Rotation3, SVector, Vector2, Vector3, Vector6};

mod declared {
    use clebsch::Clebsch;

    /// Bodies that hang from each other.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: [SE<3>; N], q: [SE<3>; N]| (0..N).map(|i| q[i] * F[i]),
        cost       = |h, F| (0..N).map(|i| ((F[i] - I) * self.mass_matrix * (F[i] - I).transpose()).trace() / (2 * h)).sum(),
        potential  = |q| (0..N).map(|i| self.weight[i] * q[i].translation().z).sum(),
        constraint = |q| [
            q[0].rotation() * self.near + q[0].translation() == Vector3::zeros(),
            (1..N).map(|i| q[i].rotation() * self.near + q[i].translation() == q[i - 1].rotation() * self.far + q[i - 1].translation()),
        ],
    )]
    pub struct Links<const N: usize> {
        #[clebsch(symmetric)]
        pub mass_matrix: nalgebra::Matrix4<f64>,
        pub weight: [f64; N],
        pub near: nalgebra::Vector3<f64>,
        pub far: nalgebra::Vector3<f64>,
    }

    /// The same by a number, with an array for the action and an equation for each joint.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: [SE<3>; 4], q: [SE<3>; 4]| [q[0] * F[0], q[1] * F[1], q[2] * F[2], q[3] * F[3]],
        cost       = |h, F| (0..4).map(|i| ((F[i] - I) * self.mass_matrix * (F[i] - I).transpose()).trace() / (2 * h)).sum(),
        potential  = |q| (0..4).map(|i| self.weight[i] * q[i].translation().z).sum(),
        constraint = |q| [
            q[0].rotation() * self.near + q[0].translation() == Vector3::zeros(),
            q[1].rotation() * self.near + q[1].translation() == q[0].rotation() * self.far + q[0].translation(),
            q[2].rotation() * self.near + q[2].translation() == q[1].rotation() * self.far + q[1].translation(),
            q[3].rotation() * self.near + q[3].translation() == q[2].rotation() * self.far + q[2].translation(),
        ],
    )]
    pub struct FourLinks {
        #[clebsch(symmetric)]
        pub mass_matrix: nalgebra::Matrix4<f64>,
        pub weight: [f64; 4],
        pub near: nalgebra::Vector3<f64>,
        pub far: nalgebra::Vector3<f64>,
    }

    /// Twenty of them, with ranges.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: [SE<3>; 20], q: [SE<3>; 20]| (0..20).map(|i| q[i] * F[i]),
        cost       = |h, F| (0..20).map(|i| ((F[i] - I) * self.mass_matrix * (F[i] - I).transpose()).trace() / (2 * h)).sum(),
        potential  = |q| (0..20).map(|i| self.weight[i] * q[i].translation().z).sum(),
        constraint = |q| [
            q[0].rotation() * self.near + q[0].translation() == Vector3::zeros(),
            (1..20).map(|i| q[i].rotation() * self.near + q[i].translation() == q[i - 1].rotation() * self.far + q[i - 1].translation()),
        ],
    )]
    pub struct TwentyLinks {
        #[clebsch(symmetric)]
        pub mass_matrix: nalgebra::Matrix4<f64>,
        pub weight: [f64; 20],
        pub near: nalgebra::Vector3<f64>,
        pub far: nalgebra::Vector3<f64>,
    }

    macro_rules! both {
        ($($(#[$doc:meta])* $site_by_site:ident $unrolled:ident ($($declaration:tt)*) { $($field:ident: $ty:ty,)* })*) => { $(
            $(#[$doc])*
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch($($declaration)*)]
            pub struct $site_by_site { $(pub $field: $ty,)* }

            $(#[$doc])*
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch($($declaration)*, code = unrolled)]
            pub struct $unrolled { $(pub $field: $ty,)* }
        )* };
    }

    both! {
        /// Four bars in the plane: a chain whose first pin moves, with friction and a motor at each bar. Components of a vector are
        /// added by a range too.
        Bars UnrolledBars (
            action     = |F: [SE<2>; 4], q: [SE<2>; 4]| (0..4).map(|i| q[i] * F[i]),
            lagrangian = |xi| (0..4).map(|i| (self.inertia[i] * xi[i].x.powi(2) + (1..3).map(|k| self.mass * xi[i][k].powi(2)).sum()) / 2).sum(),
            potential  = |q| q[3].translation().x / 5 + (0..4).map(|i| self.mass * q[i].translation().y).sum(),
            constraint = |t, q| [
                q[0].rotation() * self.near + q[0].translation() == Vector2::new(self.speed * t, 0),
                (0..3).map(|i| q[i + 1].rotation() * self.near + q[i + 1].translation() == q[i].rotation() * self.far + q[i].translation()),
            ],
            force      = |xi, u: [Vector1; 4]| (0..4).map(|i| vector![u[i].x - self.drag * xi[i].x, 0, 0])
        ) {
            inertia: [f64; 4],
            mass: f64,
            speed: f64,
            drag: f64,
            near: nalgebra::Vector2<f64>,
            far: nalgebra::Vector2<f64>,
        }

        /// Beads that all hang from the first one, but for the last, which hangs from another.
        Mobile UnrolledMobile (
            action     = |a: [Translation<2>; 5], x: [Vector2; 5]| (0..5).map(|i| x[i] + a[i]),
            lagrangian = |v| (0..5).map(|i| self.mass[i] * v[i].norm_squared() / 2).sum(),
            potential  = |x| (0..5).map(|i| self.mass[i] * x[i].y).sum(),
            constraint = |x| [
                x[0] == Vector2::zeros(),
                (1..4).map(|i| (x[i] - x[0]).norm_squared() == 1),
                (x[4] - x[2]).norm_squared() == 1,
            ]
        ) { mass: [f64; 5], }

        /// A star: the last bead hangs from the first one too.
        Star UnrolledStar (
            action     = |a: [Translation<2>; 4], x: [Vector2; 4]| (0..4).map(|i| x[i] + a[i]),
            lagrangian = |v| (0..4).map(|i| self.mass[i] * v[i].norm_squared() / 2).sum(),
            potential  = |x| (0..4).map(|i| self.mass[i] * x[i].y).sum(),
            constraint = |x| [
                x[0] == Vector2::zeros(),
                (x[1] - x[0]).norm_squared() == 1,
                (x[2] - x[1]).norm_squared() == 1,
                (x[3] - x[0]).norm_squared() == 1,
            ]
        ) { mass: [f64; 4], }

        /// A ring of rods, closed by the numbers of its ends.
        Ring UnrolledRing (
            action     = |a: [Translation<3>; 5], x: [Vector3; 5]| (0..5).map(|i| x[i] + a[i]),
            lagrangian = |v| (0..5).map(|i| self.mass[i] * v[i].norm_squared() / 2).sum(),
            potential  = |x| (0..5).map(|i| x[i].norm_squared().powi(2)).sum(),
            constraint = |x| [
                (1..5).map(|i| (x[i] - x[i - 1]).norm_squared() == 1),
                (x[4] - x[0]).norm_squared() == 1,
            ]
        ) { mass: [f64; 5], }

        /// The same ring by a remainder.
        WrappedRing UnrolledWrappedRing (
            action     = |a: [Translation<3>; 5], x: [Vector3; 5]| (0..5).map(|i| x[i] + a[i]),
            lagrangian = |v| (0..5).map(|i| self.mass[i] * v[i].norm_squared() / 2).sum(),
            potential  = |x| (0..5).map(|i| x[i].norm_squared().powi(2)).sum(),
            constraint = |x| [(0..5).map(|i| (x[(i + 1) % 5] - x[i]).norm_squared() == 1)]
        ) { mass: [f64; 5], }
    }
}

use declared::*;

/// Their places and their joints.
type Hanging<const N: usize> = ([Matrix4<f64>; N], [Vector3<f64>; 2]);

fn hanging<const N: usize>() -> Hanging<N> {
    let (near, far) = (Vector3::new(0.05, 0.0, 0.2), Vector3::new(0.0, 0.05, -0.2));
    let mut joint = Vector3::zeros();
    let places = std::array::from_fn(|i| {
        let turn = Rotation3::new(Vector3::new(0.3 * (i as f64).sin(), 0.7 - 0.1 * i as f64, 0.2));
        let center = joint - turn * near;
        joint = center + turn * far;
        let mut place = turn.to_homogeneous();
        place.fixed_view_mut::<3, 1>(0, 3).copy_from(&center);
        place
    });
    (places, [near, far])
}

fn weights<const N: usize>() -> ([f64; N], Matrix4<f64>) {
    let mass_matrix = Matrix4::from_diagonal(&nalgebra::Vector4::new(0.02, 0.03, 0.01, 0.5));
    (std::array::from_fn(|i| 4.9 + 0.3 * i as f64), mass_matrix)
}

/// Both step to the same numbers, and push alike.
macro_rules! step_alike {
    ($one:expr, $other:expr, $places:expr, $momenta:expr, $steps:expr, $tolerance:expr) => {{
        let (one, other) = ($one.into_stepper(0.01)?, $other.into_stepper(0.01)?);
        let (mut one_state, mut other_state) = (one.project($places, $momenta)?, other.project($places, $momenta)?);
        for step in 0..$steps {
            let (next, pushes) = one.step_with_reactions(&one_state)?;
            let (other_next, other_pushes) = other.step_with_reactions(&other_state)?;
            (one_state, other_state) = (next, other_next);
            let apart = |far: f64, size: f64| assert!(far <= $tolerance * size, "step {step}: {far:e}");
            for i in 0..pushes.len() {
                let (q, p) = (one_state.configuration()[i], one_state.momentum()[i]);
                apart((q - other_state.configuration()[i]).norm(), q.norm());
                apart((p - other_state.momentum()[i]).norm(), 1.0 + p.norm());
                apart((pushes[i] - other_pushes[i]).norm(), 100.0);
            }
        }
        assert!(one.state(*one_state.configuration(), one_state.momentum()).is_ok());
    }};
}

#[test]
fn four_bodies_by_number_are_those_of_a_const_generic() -> Result<(), Error> {
    let (places, [near, far]) = hanging::<4>();
    let (weight, mass_matrix) = weights();
    let chain = Links { mass_matrix, weight, near, far };
    let by_number = FourLinks { mass_matrix, weight, near, far };
    step_alike!(by_number, chain, places, [Vector6::new(0.01, 0.02, -0.01, 0.1, 0.0, 0.1); 4], crate::long(300), 1e-13);
    Ok(())
}

#[test]
fn twenty_bodies_by_number_are_those_of_a_const_generic_to_the_bit() -> Result<(), Error> {
    let (places, [near, far]) = hanging::<20>();
    let (weight, mass_matrix) = weights();
    let chain = Links { mass_matrix, weight, near, far };
    let by_number = TwentyLinks { mass_matrix, weight, near, far };
    step_alike!(by_number, chain, places, [Vector6::new(0.01, 0.02, -0.01, 0.1, 0.0, 0.1); 20], crate::long(200), 0.0);
    Ok(())
}

/// Sites by a number step as unrolled code does, whose momentum is one vector.
macro_rules! as_unrolled {
    ($one:expr, $other:expr, $count:literal * $dimension:literal, $start:expr, $u:expr) => {{
        let (one, other) = ($one.into_stepper(0.01)?, $other.into_stepper(0.01)?);
        let (places, momenta) = $start;
        let mut one_state = one.project(places, momenta)?;
        let stacked = |parts: [SVector<f64, $dimension>; $count]| {
            SVector::<f64, { $dimension * $count }>::from_fn(|i, _| parts[i / $dimension][i % $dimension])
        };
        let mut other_state = other.state(*one_state.configuration(), stacked(one_state.momentum()))?;
        for step in 0..crate::long(300) {
            let (next, pushes) = one.step_with_reactions_under(&one_state, &$u)?;
            let (other_next, other_pushes) = other.step_with_reactions_under(&other_state, &$u)?;
            (one_state, other_state) = (next, other_next);
            let far = (0..$count).map(|i| (one_state.configuration()[i] - other_state.configuration()[i]).norm());
            let far = far.fold(0.0, f64::max);
            assert!(far < 1e-12, "step {step}: {far:e}");
            let far = (stacked(one_state.momentum()) - other_state.momentum()).norm();
            assert!(far < 1e-12, "step {step}: {far:e}");
            // the rows of a site have room for the most of any site, and unrolled ones are in the order of the list
            let (sum, other_sum) =
                (pushes.iter().map(|push| push.norm_squared()).sum::<f64>(), other_pushes.norm_squared());
            assert!((sum - other_sum).abs() < 1e-10 * (1.0 + sum), "step {step}: {sum} {other_sum}");
            let energies = [one.energy(&one_state), other.energy(&other_state)];
            assert!((energies[0] - energies[1]).abs() < 1e-12, "step {step}: {energies:?}");
        }
    }};
}

#[test]
fn bars_by_number_are_the_same_unrolled() -> Result<(), Error> {
    let (inertia, mass, speed, drag) = ([0.02, 0.03, 0.01, 0.02], 0.5, 0.3, 0.01);
    let (near, far) = (Vector2::new(-0.25, 0.0), Vector2::new(0.25, 0.02));
    let one = Bars { inertia, mass, speed, drag, near, far };
    let other = UnrolledBars { inertia, mass, speed, drag, near, far };
    let mut joint = Vector2::zeros();
    let places = std::array::from_fn(|i| {
        let turn = *nalgebra::Rotation2::new(0.2 - 0.5 * i as f64).matrix();
        let center = joint - turn * near;
        joint = center + turn * far;
        let mut place = Matrix3::identity();
        place.fixed_view_mut::<2, 2>(0, 0).copy_from(&turn);
        place.fixed_view_mut::<2, 1>(0, 2).copy_from(&center);
        place
    });
    let u = [0.1, -0.05, 0.02, 0.03].map(nalgebra::Vector1::new);
    as_unrolled!(one, other, 4 * 3, (places, [Vector3::new(0.01, 0.1, 0.0); 4]), u);
    Ok(())
}

fn polar(from: Vector2<f64>, angle: f64) -> Vector2<f64> {
    from + Vector2::new(angle.sin(), -angle.cos())
}

#[test]
fn a_tree_by_number_is_the_same_unrolled() -> Result<(), Error> {
    let (mass, top) = ([0.5, 0.4, 0.7, 0.3, 0.6], Vector2::zeros());
    let hub = polar(top, 0.4);
    let places = [top, polar(top, -0.7), hub, polar(top, 1.3), polar(hub, 0.9)];
    as_unrolled!(Mobile { mass }, UnrolledMobile { mass }, 5 * 2, (places, [Vector2::new(0.1, 0.05); 5]), ());
    Ok(())
}

#[test]
fn a_last_site_that_hangs_from_the_first_makes_a_tree() -> Result<(), Error> {
    let (mass, top) = ([0.5, 0.4, 0.7, 0.3], Vector2::zeros());
    let first = polar(top, 0.4);
    let places = [top, first, polar(first, -0.7), polar(top, 1.3)];
    as_unrolled!(Star { mass }, UnrolledStar { mass }, 4 * 2, (places, [Vector2::new(0.1, 0.05); 4]), ());
    Ok(())
}

#[test]
fn a_ring_by_number_is_the_same_unrolled() -> Result<(), Error> {
    let mass = [0.5, 0.4, 0.7, 0.3, 0.6];
    let radius = 0.5 / (std::f64::consts::PI / 5.0).sin();
    let places = std::array::from_fn(|i| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / 5.0).sin_cos();
        Vector3::new(radius * cos, radius * sin, 0.1 * i as f64 * (4.0 - i as f64) / 4.0)
    });
    let start = (places, [Vector3::new(0.1, 0.05, 0.2); 5]);
    as_unrolled!(Ring { mass }, UnrolledRing { mass }, 5 * 3, start, ());
    as_unrolled!(WrappedRing { mass }, UnrolledWrappedRing { mass }, 5 * 3, start, ());
    Ok(())
}
