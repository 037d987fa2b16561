//! A spherical pendulum of unit mass and length.

use crate::classical::Equation;
use crate::motion::Scene;
use crate::setting::{Setting, declared};
use nalgebra::{SVector, Vector3, Vector6};
use std::hint::black_box;

const POSITION: Vector3<f64> = Vector3::new(0.0, 1.0, 0.0);
const MOMENTUM: Vector3<f64> = Vector3::new(1.0, 0.0, 0.5);

/// Position and angular momentum q × q̇.
type Bob = SVector<f64, 6>;

/// The same pendulum in one form after another, in every order.
macro_rules! pendulums {
    ($($module:ident, $label:literal, {$($declared:tt)*};)*) => {
        $(pendulums!(@orders $module, {$($declared)*}, [first 1, second 2, fourth 4, sixth 6, eighth 8]);)*

        fn declarations(gravity: f64) -> Vec<Box<dyn Setting<6>>> {
            let start = (POSITION, MOMENTUM);
            vec![$(
                declared($label, $module::first::Pendulum { mass: 1.0, gravity }, start, pack),
                declared($label, $module::second::Pendulum { mass: 1.0, gravity }, start, pack),
                declared($label, $module::fourth::Pendulum { mass: 1.0, gravity }, start, pack),
                declared($label, $module::sixth::Pendulum { mass: 1.0, gravity }, start, pack),
                declared($label, $module::eighth::Pendulum { mass: 1.0, gravity }, start, pack),
            )*]
        }
    };
    (@orders $module:ident, $declared:tt, [$($name:ident $order:literal),*]) => {
        mod $module {
            $(pendulums!(@one $name, $order, $declared);)*
        }
    };
    (@one $name:ident, $order:literal, {$($declared:tt)*}) => {
        pub mod $name {
            use clebsch::Clebsch;

            /// A point on the unit sphere.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch($($declared)*, order = $order)]
            pub struct Pendulum {
                /// Mass of the bob, kg.
                pub mass: f64,
                /// g, m/s².
                pub gravity: f64,
            }
        }
    };
}

pendulums! {
    chord, "chord", {
        action = |F: SO<3>, q: Unit<Vector3>| F * q,
        cost = |h, F| self.mass * (F - I).norm_squared() / (4 * h),
        potential = |q| self.mass * self.gravity * q.z
    };
    cayley, "cayley", {
        action = |F: SO<3>, q: Unit<Vector3>| F * q,
        lagrangian = |omega| self.mass * omega.norm_squared() / 2,
        potential = |q| self.mass * self.gravity * q.z,
        discretization = cayley
    };
    exponential, "exponential", {
        action = |F: SO<3>, q: Unit<Vector3>| F * q,
        lagrangian = |omega| self.mass * omega.norm_squared() / 2,
        potential = |q| self.mass * self.gravity * q.z,
        discretization = exponential
    };
}

#[rustfmt::skip]
mod collocated {
    pendulums!(@one sixteenth, 16, {
        action = |F: SO<3>, q: Unit<Vector3>| F * q,
        lagrangian = |omega| self.mass * omega.norm_squared() / 2,
        potential = |q| self.mass * self.gravity * q.z
    });
}

/// g = 1.
pub fn scene() -> Scene<6> {
    let gravity = black_box(1.0);
    let field = move |y: &Bob| {
        let (q, n) = split(y);
        pack(&n.cross(&q), &(Vector3::new(-q.y, q.x, 0.0) * gravity))
    };
    let mut settings = declarations(gravity);
    let collocated = collocated::sixteenth::Pendulum { mass: 1.0, gravity };
    settings.push(declared("collocation", collocated, (POSITION, MOMENTUM), pack));
    let first = exponential::first::Pendulum { mass: 1.0, gravity };
    settings.push(declared("exponential synchronized", first, (POSITION, MOMENTUM), pack).synchronized());
    settings.extend(Equation { field, start: pack(&POSITION, &MOMENTUM), flat: |y| *y }.settings());
    Scene {
        name: "pendulum",
        title: "spherical pendulum",
        duration: 100.0,
        start: pack(&POSITION, &MOMENTUM),
        field: Box::new(field),
        energy: Box::new(move |y| split(y).1.norm_squared() / 2.0 + gravity * y[2]),
        momenta: |y| Vector6::new(y[5], 0.0, 0.0, 0.0, 0.0, 0.0),
        constraint: |y| (split(y).0.norm_squared() - 1.0).abs(),
        split: 3,
        momentum_size: MOMENTUM.norm(),
        closed_form: None,
        reference_steps: 100_000,
        settings,
    }
}

fn pack(q: &Vector3<f64>, n: &Vector3<f64>) -> Bob {
    Bob::from_iterator(q.iter().chain(n.iter()).copied())
}

fn split(y: &Bob) -> (Vector3<f64>, Vector3<f64>) {
    (y.fixed_rows::<3>(0).into(), y.fixed_rows::<3>(3).into())
}
