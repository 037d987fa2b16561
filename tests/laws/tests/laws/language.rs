//! A closure means the same to the compiler and to Rust: one expression as a declared potential and as a plain
//! function.
//!
//! Values agree to round-off, forces with central differences of fourth order to 1e-9 of their size.

use clebsch::Clebsch;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix3, Vector3};

/// The potential of a particle, once derived and once as it stands.
macro_rules! potentials {
    (|$a:ident, $b:ident, $s:ident, $x:ident|; $($module:ident: $body:expr;)*) => {$(
        mod $module {
            use super::*;

            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action    = |a: Translation<3>, $x: Vector3| $x + a,
                cost      = |h, a| self.mass * a.norm_squared() / (2 * h),
                potential = |$x| {
                    let $a = self.matrix;
                    let $b = self.vector;
                    let $s = self.scalar;
                    $body
                },
            )]
            pub struct Particle {
                pub mass: f64,
                pub matrix: Matrix3<f64>,
                pub vector: Vector3<f64>,
                pub scalar: f64,
            }

            #[test]
            fn derived_and_plain() {
                #[allow(unused_variables, reason = "few formulas read every parameter")]
                let plain = |particle: &Particle, $x: Vector3<f64>| -> f64 {
                    let ($a, $b, $s) = (particle.matrix, particle.vector, particle.scalar);
                    $body
                };
                let mut random = Random::new(110);
                for _ in 0..20 {
                    let particle = Particle {
                        mass: 1.0,
                        matrix: Matrix3::identity() * 2.0 + random.matrix::<3, 3>() * 0.5,
                        vector: random.vector(),
                        scalar: random.between(0.5, 1.5),
                    };
                    // away from zero, for roots, logarithms and reciprocals
                    let x = Vector3::repeat(0.8) + random.vector() * 0.3;
                    let (derived, expected) = (particle.potential(0.0, &x), plain(&particle, x));
                    assert!((derived - expected).abs() <= 1e-13 * (1.0 + expected.abs()), "{derived} and {expected}");
                    let h = 2.0;
                    let constants = particle.step_constants(h).expect("a regular particle");
                    // J(x, −h/2 ∂V) = −∂V
                    let kick = particle.impulse(&constants, 0.0, &x, &nalgebra::zero());
                    for i in 0..3 {
                        let at = |e: f64| plain(&particle, x + Vector3::ith(i, e));
                        let slope = (8.0 * (at(1e-3) - at(-1e-3)) - (at(2e-3) - at(-2e-3))) / 12e-3;
                        let scale = 1.0 + expected.abs() + slope.abs();
                        assert!((kick[i] + slope).abs() <= 1e-9 * scale, "{i}: {} and {}", kick[i], -slope);
                    }
                }
            }
        }
    )*};
}

potentials! {
    |a, b, s, x|;
    products_and_quotients: s * x.x * x.y / (x.z * (s + x.x)) - x.y / x.z / s;
    quotient_of_quotients: 1.0 / (x.x / (x.y * x.z)) + (x.x / s) / (x.y / x.z);
    negations: -(x.x - -x.y) * -(x.z - s) - (x.x - (x.y - x.z));
    integer_powers: x.x.powi(3) * x.y.powi(-2) + (x.z + s).powi(4) - x.x.powi(0) + x.y.powi(1);
    real_powers: x.x.powf(1.5) * x.y.powf(-2.5) + x.norm_squared().powf(-0.5) + (x.z * x.y).powf(0.25);
    roots: x.x.sqrt() / (x.y * x.z).sqrt() + 1.0 / (x.norm_squared() + s).sqrt();
    distances: s / (x - b * 4.0).norm().powi(3) - x.norm() * (x + b * 3.0).norm();
    trigonometry: (x.x * s).sin() * x.y.cos() + (x.z / 2.0).tan();
    inverse_trigonometry: (x.x / 4.0).asin() + (x.y / 4.0).acos() * (x.z * s).atan();
    hyperbolas: (x.x * s).sinh() - x.y.cosh() * x.z.tanh();
    exponentials: (-x.norm_squared() / s).exp() + (x.x * x.y).ln() / x.z.exp();
    reciprocals: (x.x * x.y).recip() + 2.0 / (s * x.z) * x.x;
    quadratic_forms: x.dot(&(a * x)) / 2.0 + b.dot(&x) * x.dot(&(a.transpose() * b));
    cross_products: x.cross(&b).norm_squared() + b.cross(&(a * x)).dot(&x);
    normalised: x.normalize().dot(&b) + (a * x).normalize().z;
    components_and_sums: x.component_mul(&b).dot(&x) + x[0] * x[1] * x[(2, 0)] + x.xy().norm_squared();
    traces: (a * x * x.transpose()).trace() + (x * b.transpose() * a).trace() * (a * a).trace();
    determinants: (a + x * b.transpose()).determinant() + (a * x.x).trace();
    made_matrices: (Matrix3::from_diagonal(&x) * a * Matrix3::from_diagonal(&x)).trace() + x.cross_matrix().norm_squared();
    made_vectors: Vector3::new(x.y, x.z * x.x, s).dot(&Vector3::new(x.x, 1.0, x.y)) + Vector3::z().dot(&x);
    columns: a.column(1).dot(&x) * (a * x)[2];
}

const COUNT: usize = 3;
const G: f64 = 9.81;

/// A potential of constants of several types, of one letter, of the struct, and of its generics.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<3>, x: Vector3| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| COUNT * x.x + self::G * x.y + Self::LEGS * x.z + (D - SIZE) * x.norm_squared(),
)]
struct Constants<const D: usize, const SIZE: i16>;

impl<const D: usize, const SIZE: i16> Constants<D, SIZE> {
    const LEGS: i64 = -4;
}

#[test]
fn constants_are_numbers_of_any_type() {
    let x = Vector3::new(0.5, 0.25, 2.0);
    let plain = 3.0 * 0.5 + 9.81 * 0.25 - 4.0 * 2.0 + (7.0 + 2.0) * x.norm_squared();
    assert_eq!(Constants::<7, -2>.potential(0.0, &x), plain);
}
