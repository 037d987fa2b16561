//! The free rigid body in four dimensions.

use crate::classical::Equation;
use crate::motion::Scene;
use crate::setting::{Setting, declared};
use nalgebra::{Matrix4, SVector, Vector4, Vector6};
use std::hint::black_box;

/// The diagonal of J_d, half the second moments of mass.
const SECOND_MOMENTS: Vector4<f64> = Vector4::new(1.0, 1.5, 2.0, 2.5);
/// Entries M_12, M_13, M_14, M_23, M_24, M_34.
const MOMENTUM: Vector6<f64> = Vector6::new(0.3, -0.5, 0.2, 0.6, -0.1, 0.5);
/// Rows and columns of these entries.
const PLANES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// R by columns, then the six entries of M.
type Body = SVector<f64, 22>;

/// The same body in one form after another, in every order.
macro_rules! bodies {
    ($($module:ident, $label:literal, $type:ident, $field:ident, {$($declared:tt)*};)*) => {
        $(bodies!(@orders $module, $type, $field, {$($declared)*}, [second 2, fourth 4, sixth 6, eighth 8]);)*

        fn declarations() -> Vec<Box<dyn Setting<22>>> {
            // components of a momentum in the basis of SO(4) are twice the entries below the diagonal
            let start = (Matrix4::identity(), MOMENTUM * -2.0);
            let flat = |attitude: &Matrix4<f64>, momentum: &Vector6<f64>| pack(attitude, &(momentum * -0.5));
            vec![$(
                declared($label, $module::second::Body { $field: $field() }, start, flat),
                declared($label, $module::fourth::Body { $field: $field() }, start, flat),
                declared($label, $module::sixth::Body { $field: $field() }, start, flat),
                declared($label, $module::eighth::Body { $field: $field() }, start, flat),
            )*]
        }
    };
    (@orders $module:ident, $type:ident, $field:ident, $declared:tt, [$($name:ident $order:literal),*]) => {
        mod $module {
            $(bodies!(@one $name, $order, $type, $field, $declared);)*
        }
    };
    (@one $name:ident, $order:literal, $type:ident, $field:ident, {$($declared:tt)*}) => {
        pub mod $name {
            use clebsch::Clebsch;
            use nalgebra::$type;

            /// A free body.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch($($declared)*, order = $order)]
            pub struct Body {
                /// Its mass and how it is spread, kg·m².
                pub $field: $type<f64>,
            }
        }
    };
}

bodies! {
    moser_veselov, "moser_veselov", Matrix4, j_d, {
        action = |F: SO<4>, R: SO<4>| R * F,
        cost = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h
    };
    cayley, "cayley", Vector6, inertia, {
        action = |F: SO<4>, R: SO<4>| R * F,
        lagrangian = |xi| xi.dot(&self.inertia.component_mul(&xi)),
        discretization = cayley
    };
    exponential, "exponential", Vector6, inertia, {
        action = |F: SO<4>, R: SO<4>| R * F,
        lagrangian = |xi| xi.dot(&self.inertia.component_mul(&xi)),
        discretization = exponential
    };
}

/// The motion itself, which no order makes better.
mod exact {
    use clebsch::Clebsch;
    use nalgebra::Matrix4;

    /// A free body.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action         = |F: SO<4>, R: SO<4>| R * F,
        lagrangian     = |xi| (self.j_d * xi.matrix() * xi.matrix().transpose()).trace(),
        discretization = exact,
    )]
    pub struct Body {
        /// Half the second moments of mass, kg·m².
        #[clebsch(symmetric)]
        pub j_d: Matrix4<f64>,
    }
}

/// J_d = diag(1, 1.5, 2, 2.5).
pub fn scene() -> Scene<22> {
    let inertia = inertia();
    let field = move |y: &Body| {
        let (attitude, momentum) = split(y);
        let (omega, m) = (skew(&momentum.component_div(&inertia)), skew(&momentum));
        let product = m * omega;
        // MΩ − ΩM, and ΩM = (MΩ)ᵀ
        pack(&(attitude * omega), &above(&(product - product.transpose())))
    };
    let mut settings = declarations();
    // components of a momentum in the basis of SO(4) are twice the entries below the diagonal
    let exact_start = (Matrix4::identity(), MOMENTUM * -2.0);
    settings.push(declared(
        "exact",
        exact::Body { j_d: j_d() },
        exact_start,
        |attitude: &Matrix4<f64>, momentum: &Vector6<f64>| pack(attitude, &(momentum * -0.5)),
    ));
    let start = pack(&Matrix4::identity(), &MOMENTUM);
    settings.extend(Equation { field, start, flat: |y| *y }.settings());
    Scene {
        name: "body4",
        title: "free body on SO(4)",
        duration: 100.0,
        start,
        field: Box::new(field),
        energy: Box::new(move |y| split(y).1.component_div(&inertia).dot(&split(y).1)),
        momenta,
        constraint,
        split: 16,
        momentum_size: MOMENTUM.norm(),
        closed_form: None,
        reference_steps: 40_000,
        settings,
    }
}

/// J_d as a matrix.
fn j_d() -> Matrix4<f64> {
    Matrix4::from_diagonal(&black_box(SECOND_MOMENTS))
}

/// The sums d_i + d_j of every two entries of J_d.
fn inertia() -> Vector6<f64> {
    let d = black_box(SECOND_MOMENTS);
    Vector6::from_fn(|plane, _| d[PLANES[plane].0] + d[PLANES[plane].1])
}

/// The spatial momentum R M Rᵀ.
fn momenta(y: &Body) -> Vector6<f64> {
    let (attitude, momentum) = split(y);
    above(&(attitude * skew(&momentum) * attitude.transpose()))
}

/// The largest entry of RᵀR − I.
fn constraint(y: &Body) -> f64 {
    let attitude = split(y).0;
    (attitude.transpose() * attitude - Matrix4::identity()).amax()
}

fn pack(attitude: &Matrix4<f64>, momentum: &Vector6<f64>) -> Body {
    Body::from_iterator(attitude.iter().chain(momentum.iter()).copied())
}

fn split(y: &Body) -> (Matrix4<f64>, Vector6<f64>) {
    (Matrix4::from_column_slice(&y.as_slice()[..16]), y.fixed_rows::<6>(16).into())
}

/// The skew matrix with these entries above the diagonal.
#[inline]
fn skew(m: &Vector6<f64>) -> Matrix4<f64> {
    Matrix4::new(0.0, m[0], m[1], m[2], -m[0], 0.0, m[3], m[4], -m[1], -m[3], 0.0, m[5], -m[2], -m[4], -m[5], 0.0)
}

/// The entries above the diagonal.
#[inline]
fn above(matrix: &Matrix4<f64>) -> Vector6<f64> {
    Vector6::from_fn(|plane, _| matrix[PLANES[plane]])
}
