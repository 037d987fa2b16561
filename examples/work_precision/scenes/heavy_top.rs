//! A fast top with three moments of inertia.

use super::rotation::{
    compact, compact_rates, defect, pack, pack_quaternion, rates, split, split_compact, unpack_compact,
};
use crate::classical::Equation;
use crate::motion::Scene;
use crate::setting::{Setting, declared};
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3, Vector6};
use std::hint::black_box;

const MOMENTS: Vector3<f64> = Vector3::new(1.0, 1.5, 2.0);
const CENTER: Vector3<f64> = Vector3::new(0.0, 0.0, 1.0);
const VELOCITY: Vector3<f64> = Vector3::new(0.1, 0.2, 5.0);
const TILT: f64 = 0.5;

/// The same top in one form after another, in its orders.
macro_rules! tops {
    ($($module:ident, $label:literal, $start:ident, $flat:ident, [$($name:ident $order:literal),*], $declared:tt;)*) => {
        $(tops!(@orders $module, $declared, [$($name $order),*]);)*

        fn declarations(inertia: Matrix3<f64>, weight: f64, center: Vector3<f64>) -> Vec<Box<dyn Setting<12>>> {
            let momentum = inertia * VELOCITY;
            vec![$($(
                declared($label, $module::$name::Top { inertia, weight, center }, ($start(), momentum), $flat),
            )*)*]
        }
    };
    (@orders $module:ident, $declared:tt, [$($name:ident $order:literal),*]) => {
        mod $module {
            $(tops!(@one $name, $order, $declared);)*
        }
    };
    (@one $name:ident, $order:literal, {$($declared:tt)*}) => {
        pub mod $name {
            use clebsch::Clebsch;
            use nalgebra::{Matrix3, Vector3};

            /// A body about a pivot.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch($($declared)*, order = $order)]
            pub struct Top {
                /// Inertia tensor about the pivot, kg·m².
                #[clebsch(symmetric)]
                pub inertia: Matrix3<f64>,
                /// m·g, N.
                pub weight: f64,
                /// Centre of mass in the body frame, m.
                pub center: Vector3<f64>,
            }
        }
    };
}

tops! {
    exact, "exact", tilted, pack, [first 1, second 2, fourth 4, sixth 6], {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        potential = |R| self.weight * (R * self.center).z,
        discretization = exact
    };
    compensated, "exact compensated", tilted, pack, [sixth 6], {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        potential = |R| self.weight * (R * self.center).z,
        discretization = exact,
        summation = compensated
    };
    quaternion_exact, "quaternion exact", tilted_quaternion, pack_quaternion, [first 1, second 2, fourth 4, sixth 6], {
        action = |F: SU<2>, Q: SU<2>| Q * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        potential = |Q| self.weight * (Q * self.center).z,
        discretization = exact
    };
    moser_veselov, "moser_veselov", tilted, pack, [first 1, second 2, fourth 4, sixth 6, eighth 8], {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        potential = |R| self.weight * (R * self.center).z,
        discretization = moser_veselov
    };
    cayley, "cayley", tilted, pack, [first 1, second 2, fourth 4, sixth 6, eighth 8], {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        potential = |R| self.weight * (R * self.center).z,
        discretization = cayley
    };
    exponential, "exponential", tilted, pack, [first 1, second 2, fourth 4, sixth 6, eighth 8], {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        potential = |R| self.weight * (R * self.center).z,
        discretization = exponential
    };
    projection, "projection", tilted, pack, [first 1, second 2, fourth 4, sixth 6, eighth 8], {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        potential = |R| self.weight * (R * self.center).z,
        discretization = projection
    };
    chord, "quaternion chord", tilted_quaternion, pack_quaternion, [first 1, second 2, fourth 4, sixth 6, eighth 8], {
        action = |F: SU<2>, Q: SU<2>| Q * F,
        cost = |h, F| 2 * F.imag().dot(&(self.inertia * F.imag())) / h,
        potential = |Q| self.weight * (Q * self.center).z
    };
    collocated, "collocation", tilted, pack, [sixteenth 16], {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        potential = |R| self.weight * (R * self.center).z
    };
    quaternion_collocated, "quaternion collocation", tilted_quaternion, pack_quaternion, [sixteenth 16], {
        action = |F: SU<2>, Q: SU<2>| Q * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        potential = |Q| self.weight * (Q * self.center).z
    };
    quaternion, "quaternion cayley", tilted_quaternion, pack_quaternion, [first 1, second 2, fourth 4, sixth 6, eighth 8], {
        action = |F: SU<2>, Q: SU<2>| Q * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        potential = |Q| self.weight * (Q * self.center).z,
        discretization = cayley
    };
}

/// Steps of order 16 whose sweeps end early.
#[rustfmt::skip]
mod loose {
    tops!(@one sixteenth, 16, {
        action = |F: SU<2>, Q: SU<2>| Q * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        potential = |Q| self.weight * (Q * self.center).z,
        tolerance = 1e-10
    });
}

/// Exact drifts whose series end early.
macro_rules! tolerant {
    ($($name:ident $order:literal $tolerance:literal;)*) => {
        mod tolerant {
            $(tops!(@one $name, $order, {
                action = |F: SO<3>, R: SO<3>| R * F,
                lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
                potential = |R| self.weight * (R * self.center).z,
                discretization = exact,
                tolerance = $tolerance
            });)*
        }

        fn tolerant(inertia: Matrix3<f64>, weight: f64, center: Vector3<f64>) -> Vec<Box<dyn Setting<12>>> {
            let momentum = inertia * VELOCITY;
            vec![$(
                declared("exact", tolerant::$name::Top { inertia, weight, center }, (tilted(), momentum), pack)
                    .to($tolerance),
            )*]
        }
    };
}
tolerant! {
    rough 4 1e-4;
    fourth 4 1e-7;
    sixth 6 1e-10;
}

fn tilted() -> Matrix3<f64> {
    *Rotation3::from_axis_angle(&Vector3::x_axis(), TILT).matrix()
}

fn tilted_quaternion() -> Quaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::x_axis(), TILT).into_inner()
}

/// m·g = 1, the centre of mass one metre up the third axis.
pub fn scene() -> Scene<12> {
    let (inertia, weight, center) = (Matrix3::from_diagonal(&black_box(MOMENTS)), black_box(1.0), black_box(CENTER));
    let inverse = inertia.map(|entry| if entry == 0.0 { 0.0 } else { 1.0 / entry });
    let momentum = inertia * VELOCITY;
    let torque = move |up: &Vector3<f64>| -weight * center.cross(up);
    let field = move |y: &_| {
        let (attitude, momentum) = split(y);
        let omega = inverse * momentum;
        rates(&attitude, &omega, &(momentum.cross(&omega) + torque(&attitude.row(2).transpose())))
    };
    let fast = move |y: &_| {
        let (attitude, momentum) = split_compact(y);
        let omega = inverse * momentum;
        compact_rates(&attitude, &omega, &(momentum.cross(&omega) + torque(&vertical(&attitude))))
    };
    let energy = move |y: &_| {
        let (attitude, momentum) = split(y);
        momentum.dot(&(inverse * momentum)) / 2.0 + weight * (attitude * center).z
    };
    let mut settings = declarations(inertia, weight, center);
    settings.extend(tolerant(inertia, weight, center));
    let loose = loose::sixteenth::Top { inertia, weight, center };
    settings
        .push(declared("quaternion collocation", loose, (tilted_quaternion(), momentum), pack_quaternion).to(1e-10));
    let first = exact::first::Top { inertia, weight, center };
    settings.push(declared("exact synchronized", first, (tilted(), momentum), pack).synchronized());
    let start = compact(&tilted_quaternion(), &momentum);
    settings.extend(Equation { field: fast, start, flat: unpack_compact }.settings());
    Scene {
        name: "heavy_top",
        title: "heavy top",
        duration: 50.0,
        start: pack(&tilted(), &momentum),
        field: Box::new(field),
        energy: Box::new(energy),
        momenta,
        constraint: defect,
        split: 9,
        momentum_size: momentum.norm(),
        closed_form: None,
        reference_steps: 200_000,
        settings,
    }
}

/// The last row of the rotation.
#[inline]
fn vertical(q: &Quaternion<f64>) -> Vector3<f64> {
    let (i, j, k, w) = (q.i, q.j, q.k, q.w);
    Vector3::new(2.0 * (i * k - w * j), 2.0 * (j * k + w * i), w * w - i * i - j * j + k * k)
}

/// The spatial momentum about the vertical.
fn momenta(y: &super::rotation::Body) -> Vector6<f64> {
    let (attitude, momentum) = split(y);
    Vector6::new((attitude * momentum).z, 0.0, 0.0, 0.0, 0.0, 0.0)
}
