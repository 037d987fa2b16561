//! A body that nothing acts on, turning near its middle axis.

use super::rotation::{
    compact, compact_rates, defect, pack, pack_quaternion, rates, split, split_compact, unpack_compact,
};
use crate::classical::Equation;
use crate::motion::Scene;
use crate::setting::{Setting, declared};
use clebsch_examples::jacobi::Jacobi;
use nalgebra::{Matrix3, Quaternion, Vector3, Vector6};
use std::hint::black_box;

const MOMENTS: Vector3<f64> = Vector3::new(1.0, 2.0, 3.0);
const MOMENTUM: Vector3<f64> = Vector3::new(0.3, 2.0, 0.6);

/// The same body in one form after another, in every order; a free body has no kicks, so that order 1 is order 2.
macro_rules! bodies {
    ($($module:ident, $label:literal, $start:ident, $flat:ident, {$($declared:tt)*};)*) => {
        $(bodies!(@orders $module, {$($declared)*}, [second 2, fourth 4, sixth 6, eighth 8]);)*

        fn declarations(inertia: Matrix3<f64>) -> Vec<Box<dyn Setting<12>>> {
            vec![$(
                declared($label, $module::second::Body { inertia }, ($start(), MOMENTUM), $flat),
                declared($label, $module::fourth::Body { inertia }, ($start(), MOMENTUM), $flat),
                declared($label, $module::sixth::Body { inertia }, ($start(), MOMENTUM), $flat),
                declared($label, $module::eighth::Body { inertia }, ($start(), MOMENTUM), $flat),
            )*]
        }
    };
    (@orders $module:ident, $declared:tt, [$($name:ident $order:literal),*]) => {
        mod $module {
            $(bodies!(@one $name, $order, $declared);)*
        }
    };
    (@one $name:ident, $order:literal, {$($declared:tt)*}) => {
        pub mod $name {
            use clebsch::Clebsch;
            use nalgebra::Matrix3;

            /// A free body.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch($($declared)*, order = $order)]
            pub struct Body {
                /// Inertia tensor, kg·m².
                #[clebsch(symmetric)]
                pub inertia: Matrix3<f64>,
            }
        }
    };
}

bodies! {
    moser_veselov, "moser_veselov", unturned, pack, {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        discretization = moser_veselov
    };
    cayley, "cayley", unturned, pack, {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        discretization = cayley
    };
    exponential, "exponential", unturned, pack, {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        discretization = exponential
    };
    projection, "projection", unturned, pack, {
        action = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        discretization = projection
    };
    chord, "quaternion chord", unit, pack_quaternion, {
        action = |F: SU<2>, Q: SU<2>| Q * F,
        cost = |h, F| 2 * F.imag().dot(&(self.inertia * F.imag())) / h
    };
    quaternion, "quaternion cayley", unit, pack_quaternion, {
        action = |F: SU<2>, Q: SU<2>| Q * F,
        lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
        discretization = cayley
    };
}

/// The motion itself, which no order makes better.
mod exact {
    use clebsch::Clebsch;
    use nalgebra::Matrix3;

    /// A free body.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action         = |F: SO<3>, R: SO<3>| R * F,
        lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
        discretization = exact,
    )]
    pub struct Body {
        /// Inertia tensor, kg·m².
        #[clebsch(symmetric)]
        pub inertia: Matrix3<f64>,
    }
}

fn unturned() -> Matrix3<f64> {
    Matrix3::identity()
}

fn unit() -> Quaternion<f64> {
    Quaternion::identity()
}

/// Moments of inertia 1, 2 and 3.
pub fn scene() -> Scene<12> {
    let inertia = Matrix3::from_diagonal(&black_box(MOMENTS));
    let inverse = inertia.map(|entry| if entry == 0.0 { 0.0 } else { 1.0 / entry });
    let field = move |y: &_| {
        let (attitude, momentum) = split(y);
        let omega = inverse * momentum;
        rates(&attitude, &omega, &momentum.cross(&omega))
    };
    let fast = move |y: &_| {
        let (attitude, momentum) = split_compact(y);
        let omega = inverse * momentum;
        compact_rates(&attitude, &omega, &momentum.cross(&omega))
    };
    let mut settings = declarations(inertia);
    settings.push(declared("exact", exact::Body { inertia }, (unturned(), MOMENTUM), pack));
    settings.extend(Equation { field: fast, start: compact(&unit(), &MOMENTUM), flat: unpack_compact }.settings());
    Scene {
        name: "free_body",
        title: "free rigid body",
        duration: 100.0,
        start: pack(&unturned(), &MOMENTUM),
        field: Box::new(field),
        energy: Box::new(move |y| split(y).1.dot(&(inverse * split(y).1)) / 2.0),
        momenta,
        constraint: defect,
        split: 9,
        momentum_size: MOMENTUM.norm(),
        closed_form: Some(closed_form),
        reference_steps: 80_000,
        settings,
    }
}

/// The body momentum at a time, (a cn, b sn, c dn) for a body that turns about its third axis rather than its first, L² > 2E J₂.
///
/// Source: Landau and Lifshitz, *Mechanics*, §37.
fn closed_form(time: f64) -> Option<Vector3<f64>> {
    let [j1, j2, j3] = [MOMENTS.x, MOMENTS.y, MOMENTS.z];
    let (square, double_energy) = (MOMENTUM.norm_squared(), MOMENTUM.dot(&MOMENTUM.component_div(&MOMENTS)));
    let (above, below) = (square - double_energy * j1, double_energy * j3 - square);
    let [a, b, c] =
        [j1 * below / (j3 - j1), j2 * below / (j3 - j2), j3 * above / (j3 - j1)].map(|square: f64| square.sqrt());
    let rate = ((j3 - j2) * above / (j1 * j2 * j3)).sqrt();
    let m = (j2 - j1) * below / ((j3 - j2) * above);
    let functions = Jacobi::new(m, 1.0 - m)?;
    let start = functions.argument((MOMENTUM.y / b).atan2(MOMENTUM.x / a));
    let (phi, _) = functions.amplitude(start + rate * time);
    Some(Vector3::new(a * phi.cos(), b * phi.sin(), c * functions.delta(phi)))
}

/// The spatial momentum Rπ.
fn momenta(y: &super::rotation::Body) -> Vector6<f64> {
    let (attitude, momentum) = split(y);
    (attitude * momentum).push(0.0).push(0.0).push(0.0)
}
