//! The free rigid body in four dimensions.

use crate::classical::{Equation, VectorField};
use crate::motion::Scene;
use crate::setting::{Setting, declared};
use clebsch::{Clebsch, Declared};
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

struct MoserVeselovSecond;
struct MoserVeselovFourth;
struct MoserVeselovSixth;
struct MoserVeselovEighth;
struct CayleySecond;
struct CayleyFourth;
struct CayleySixth;
struct CayleyEighth;
struct ExponentialSecond;
struct ExponentialFourth;
struct ExponentialSixth;
struct ExponentialEighth;

/// A free body, by the cost of Moser and Veselov.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action = |F: SO<4>, R: SO<4>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
    method MoserVeselovSecond = (order = 2),
    method MoserVeselovFourth = (order = 4),
    method MoserVeselovSixth  = (order = 6),
    method MoserVeselovEighth = (order = 8),
)]
struct Discrete {
    /// Half the second moments of mass, kg·m².
    j_d: Matrix4<f64>,
}

/// The same body by its Lagrangian, in one form after another.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action     = |F: SO<4>, R: SO<4>| R * F,
    lagrangian = |xi| xi.dot(&self.inertia.component_mul(&xi)),
    method CayleySecond      = (order = 2, discretization = cayley),
    method CayleyFourth      = (order = 4, discretization = cayley),
    method CayleySixth       = (order = 6, discretization = cayley),
    method CayleyEighth      = (order = 8, discretization = cayley),
    method ExponentialSecond = (order = 2, discretization = exponential),
    method ExponentialFourth = (order = 4, discretization = exponential),
    method ExponentialSixth  = (order = 6, discretization = exponential),
    method ExponentialEighth = (order = 8, discretization = exponential),
)]
struct Principal {
    /// Inertia in each plane, kg·m².
    inertia: Vector6<f64>,
}

/// The motion itself, which no order makes better.
#[derive(Clebsch, Clone, Copy, Debug)]
#[clebsch(
    action         = |F: SO<4>, R: SO<4>| R * F,
    lagrangian     = |xi| (self.j_d * xi.matrix() * xi.matrix().transpose()).trace(),
    discretization = exact,
)]
struct Exact {
    /// Half the second moments of mass, kg·m².
    #[clebsch(symmetric)]
    j_d: Matrix4<f64>,
}

/// Every form in every order.
fn declarations() -> Vec<Box<dyn Setting<22>>> {
    // components of a momentum in the basis of SO(4) are twice the entries below the diagonal
    let start = (Matrix4::identity(), MOMENTUM * -2.0);
    let flat = |attitude: &Matrix4<f64>, momentum: &Vector6<f64>| pack(attitude, &(momentum * -0.5));
    let discrete = Discrete { j_d: j_d() };
    let principal = Principal { inertia: inertia() };
    vec![
        declared(MoserVeselovSecond, "moser_veselov", discrete, start, flat),
        declared(MoserVeselovFourth, "moser_veselov", discrete, start, flat),
        declared(MoserVeselovSixth, "moser_veselov", discrete, start, flat),
        declared(MoserVeselovEighth, "moser_veselov", discrete, start, flat),
        declared(CayleySecond, "cayley", principal, start, flat),
        declared(CayleyFourth, "cayley", principal, start, flat),
        declared(CayleySixth, "cayley", principal, start, flat),
        declared(CayleyEighth, "cayley", principal, start, flat),
        declared(ExponentialSecond, "exponential", principal, start, flat),
        declared(ExponentialFourth, "exponential", principal, start, flat),
        declared(ExponentialSixth, "exponential", principal, start, flat),
        declared(ExponentialEighth, "exponential", principal, start, flat),
        declared(Declared, "exact", Exact { j_d: j_d() }, start, flat),
    ]
}

/// Euler's equations.
#[derive(Clone)]
struct Turning {
    /// Of the moments of inertia in each plane.
    inverse: Vector6<f64>,
}

impl VectorField<22> for Turning {
    #[inline(never)]
    fn rates(&self, y: &Body) -> Body {
        let (attitude, momentum) = split(y);
        let omega = momentum.component_mul(&self.inverse);
        pack(&turning(&attitude, &omega), &bracket(&momentum, &omega))
    }
}

/// J_d = diag(1, 1.5, 2, 2.5).
pub fn scene() -> Scene<22> {
    let inertia = inertia();
    let field = Turning { inverse: inertia.map(f64::recip) };
    let mut settings = declarations();
    let start = pack(&Matrix4::identity(), &MOMENTUM);
    settings.extend(Equation { field: field.clone(), start, flat: |y| *y }.settings());
    Scene {
        name: "body4",
        title: "free body on SO(4)",
        duration: 100.0,
        start,
        field: Box::new(move |y| field.rates(y)),
        energy: Box::new(move |y| split(y).1.component_div(&inertia).dot(&split(y).1)),
        momenta,
        constraint,
        split: 16,
        momentum_size: MOMENTUM.norm(),
        closed_form: None,
        known: None,
        reference_steps: 40_000,
        longer: 10,
        least_error: 0.0,
        shows_sixteen: true,
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
    let mut y = Body::zeros();
    y.fixed_rows_mut::<16>(0).copy_from_slice(attitude.as_slice());
    y.fixed_rows_mut::<6>(16).copy_from(momentum);
    y
}

fn split(y: &Body) -> (Matrix4<f64>, Vector6<f64>) {
    (Matrix4::from_column_slice(&y.as_slice()[..16]), y.fixed_rows::<6>(16).into())
}

/// R Ω by columns, without the zeros on the diagonal of Ω.
#[inline]
fn turning(r: &Matrix4<f64>, omega: &Vector6<f64>) -> Matrix4<f64> {
    let [a, b, c, d, e, f] = omega.data.0[0];
    let [r1, r2, r3, r4] = [0, 1, 2, 3].map(|column| Vector4::from(r.column(column)));
    let columns =
        [r2 * -a - r3 * b - r4 * c, r1 * a - r3 * d - r4 * e, r1 * b + r2 * d - r4 * f, r1 * c + r2 * e + r3 * f];
    Matrix4::from_columns(&columns)
}

/// M Ω − Ω M above the diagonal.
#[inline]
fn bracket(m: &Vector6<f64>, omega: &Vector6<f64>) -> Vector6<f64> {
    let ([a, b, c, d, e, f], [u, v, w, x, y, z]) = (m.data.0[0], omega.data.0[0]);
    Vector6::new(
        d * v - b * x + e * w - c * y,
        a * x - d * u + f * w - c * z,
        a * y - e * u + b * z - f * v,
        b * u - a * v + f * y - e * z,
        c * u - a * w + d * z - f * x,
        c * v - b * w + e * x - d * y,
    )
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
